// Files in, answers out: those of the command.

import assert from "node:assert/strict";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { after, before, beforeEach, afterEach, test } from "node:test";
import { FIXTURES, analyzed, answer, choose, command, document, opened, saved, stage, synthesized } from "./page.mjs";

const SAME = 1e-9;
// What the last digits of times show in first: evidence, a difference of sums of some hundred nats, and the ball behind the times,
// which goes by the square of a contact time that is known to a tenth.
const SAME_DERIVED = 1e-7;
const isDerived = (path) => path.endsWith("_nats") || path.includes("/ball/");
let site, chromium, context, page, requests, problems, place, wav, leave;

before(async () => ({ place, wav, site, chromium, leave } = await stage("pingpong")));
after(() => leave?.());
beforeEach(async () => {
  context = await chromium.newContext();
  ({ page, requests, problems } = await opened(context, site.origin));
});
afterEach(async () => {
  const elsewhere = requests.filter((url) => !url.startsWith(site.origin) && !url.startsWith(`blob:${site.origin}`));
  await context.close();
  assert.deepEqual(elsewhere, [], "every request goes to the page's own origin");
  assert.deepEqual(problems, []);
});

// Every number of one document against that of the other.
function assertSame(ours, theirs, path = "") {
  if (typeof theirs === "number") {
    const off = Math.abs(ours - theirs);
    const same = isDerived(path) ? SAME_DERIVED : SAME;
    assert.ok(off <= same * Math.max(1, Math.abs(theirs)), `${path}: ${ours} and ${theirs}`);
  } else if (theirs !== null && typeof theirs === "object") {
    assert.deepEqual(Object.keys(ours), Object.keys(theirs), path);
    for (const key of Object.keys(theirs)) assertSame(ours[key], theirs[key], `${path}/${key}`);
  } else assert.equal(ours, theirs, path);
}

// e, its error and the times: what an answer is made of.
function essence({ drops, candidate }) {
  return {
    drops: drops.map(({ restitution, impacts, bounces, model }) => ({
      restitution, bounces, model: model.selected, times: impacts.map(({ time_s: timeS }) => timeS),
    })),
    candidate: candidate?.impacts.length ?? null,
  };
}

test("a WAV gives the answer of the command, first of all", async () => {
  await choose(page, wav);
  const said = await answer(page, /^e = /);
  const theirs = analyzed(wav);
  const [drop] = theirs.drops;
  assert.equal(drop.bounces, 67);
  assert.match(said, /^e = 0\.929\d+ ± 0\.000\d+, 67 bounces in 5\.8 s$/u);
  const ours = await document(page);
  assertSame({ ...ours, file: "" }, { ...theirs, file: "" });
  assert.equal(await page.locator("#rows tr").count(), 67);
  assert.ok(await page.locator("#rows tr").first().textContent());
});

test("the picture is that of the command, to the byte", async () => {
  await choose(page, wav);
  await answer(page, /^e = /);
  const { name, content } = await saved(page, "#save-svg");
  assert.equal(name, "drop.svg");
  const theirs = join(place.path, "theirs.svg");
  command("analyze", wav, "--plot", theirs);
  // The command names the file as it was given.
  const own = (text) => text.toString().replace(/<text[^>]*>\s*[^<]*drop\.wav: /u, "");
  assert.equal(own(content), own(readFileSync(theirs)));
  const width = await page.evaluate(() => document.getElementById("sheet").decode().then(() => document.getElementById("sheet").naturalWidth));
  assert.equal(width, 1400);
});

test("every fixture that can be read gives the e of the command", async () => {
  const compressed = readdirSync(join(FIXTURES, "compressed")).filter((name) => /^drop.*\.(m4a|mp4|mp3|aac|flac|ogg|aiff|caf|mov)$/u.test(name) && !name.includes("opus"));
  assert.ok(compressed.length >= 13);
  for (const name of compressed) {
    const path = join(FIXTURES, "compressed", name);
    await choose(page, path);
    await page.waitForFunction((n) => document.getElementById("result-file").textContent === n && !document.getElementById("status").textContent, name);
    const ours = await document(page);
    assert.equal(ours.file, name);
    assert.ok(ours.drops.length > 0, name);
    assertSame(essence(ours), essence(analyzed(path)), name);
  }
});

test("variants of WAV are read or refused as by the command", async () => {
  const variants = readdirSync(join(FIXTURES, "wav-variants")).filter((name) => name.endsWith(".wav"));
  assert.ok(variants.length > 40);
  await choose(page, variants.map((name) => join(FIXTURES, "wav-variants", name)));
  await page.waitForFunction((count) => document.querySelectorAll("#class-rows tr").length >= count
    && !document.getElementById("status").textContent, variants.length, { timeout: 60_000 });
  for (const name of variants) {
    const row = page.locator("#class-rows tr", { has: page.getByRole("button", { name, exact: true }) }).first();
    const shown = await row.textContent();
    let theirs;
    try {
      const { drops } = analyzed(join(FIXTURES, "wav-variants", name));
      theirs = drops.length > 0 ? "drop" : "none";
    } catch {
      theirs = "refused";
    }
    const ours = /not a readable/u.test(shown) ? "refused" : /no drop/u.test(shown) ? "none" : "drop";
    assert.equal(ours, theirs, `${name}: ${shown}`);
  }
});

test("without a drop the page says why and shows the level", async () => {
  const noise = synthesized(join(place.path, "noise.wav"), "noise");
  await choose(page, noise);
  await answer(page, /^No drop found$/);
  const [warning] = analyzed(noise).warnings;
  const said = await page.textContent("#warnings li");
  assert.equal(said.slice(1, 40), warning.message.slice(1, 40));
  assert.ok(await page.isVisible("#sheet"));
});

test("a broken file is named with the reason, and the next one is read", async () => {
  const broken = join(place.path, "broken.wav");
  writeFileSync(broken, "this is no recording at all, only some text that goes on for a while");
  await choose(page, broken);
  await answer(page, /could not be measured/);
  assert.match(await page.textContent("#warnings"), /not a readable recording/iu);
  assert.equal(await page.textContent("#result-file"), "broken.wav");
  await choose(page, join(FIXTURES, "compressed", "refused-six-channels.opus"));
  await page.waitForFunction(() => /Opus/u.test(document.getElementById("warnings").textContent));
  // Opus is left to the command: its decoder is an eighth of the page.
  await choose(page, join(FIXTURES, "compressed", "drop.opus"));
  await page.waitForFunction(() => document.getElementById("result-file").textContent === "drop.opus"
    && /it is Opus, which is not read; ffmpeg -i IN\.opus OUT\.wav/u.test(document.getElementById("warnings").textContent));
  await choose(page, wav);
  await answer(page, /67 bounces/);
});

test("several files are a class with mean and spread", async () => {
  const files = [1, 2, 3, 4, 5].map((seed) => synthesized(join(place.path, `ball-${seed}.wav`), "pingpong", seed));
  await choose(page, files);
  await page.waitForFunction(() => /5 drops/u.test(document.getElementById("class-mean").textContent), null, { timeout: 30_000 });
  const values = files.map((file) => analyzed(file).drops[0].restitution.value);
  const mean = values.reduce((a, b) => a + b) / 5;
  const spread = Math.sqrt(values.reduce((sum, e) => sum + (e - mean) ** 2, 0) / 4);
  const said = await page.textContent("#class-mean");
  const [, ours, error, scatter] = /mean e = ([\d.]+) ± ([\d.]+), spread ([\d.]+)/u.exec(said).map(Number);
  assert.ok(Math.abs(ours - mean) < 1e-4 && Math.abs(error - spread / Math.sqrt(5)) < 1e-4 && Math.abs(scatter - spread) < 1e-4, said);
  assert.equal(await page.locator("#class-rows tr").count(), 5);
  await page.click(`#class-rows button:text-is("ball-4.wav")`);
  assert.equal(await page.textContent("#result-file"), basename(files[3]));
  await page.click(`[aria-label="Remove ball-4.wav"]`);
  assert.match(await page.textContent("#class-mean"), /4 drops/u);
});

test("a setting re-fits at once, as the command does", async () => {
  await choose(page, wav);
  await answer(page, /67 bounces/);
  await page.fill("#height", "30,5");
  await page.fill("#mass", "2.7");
  await page.fill("#diameter", "40");
  await page.waitForFunction(() => /release to rest.*N\/mm/u.test(document.getElementById("model").textContent));
  const theirs = analyzed(wav, "--height", "30.5cm", "--mass", "2.7g", "--diameter", "40mm");
  const ours = await document(page);
  assertSame({ ...ours, file: "" }, { ...theirs, file: "" });
  await page.fill("#mass", "two");
  await page.waitForSelector("#settings-error:not([hidden])");
  assert.equal(await page.getAttribute("#mass", "aria-invalid"), "true");
});

test("what was measured stays in the list until it is cleared", async () => {
  await choose(page, wav);
  await answer(page, /67 bounces/);
  await page.reload();
  assert.match(await page.textContent("#history-rows"), /drop\.wav.*0\.929/u);
  await page.click("#clear");
  assert.ok(await page.isHidden("#history"));
  await page.reload();
  assert.ok(await page.isHidden("#history"));
});

test("what is saved is what the command writes", async () => {
  await choose(page, wav);
  await answer(page, /67 bounces/);
  const csv = (await saved(page, "#save-csv")).content.toString();
  const labels = (await saved(page, "#save-labels")).content.toString();
  const text = (await saved(page, "#save-text")).content.toString();
  const theirs = command("analyze", wav, "--format", "csv").replaceAll(wav, "drop.wav");
  assert.equal(csv.split("\n").length, 69);
  const cells = (table) => table.trim().split("\n").slice(1).map((line) => Object.fromEntries(line.split(",").map((cell, i) =>
    [i, cell !== "" && Number.isFinite(Number(cell)) ? Number(cell) : cell])));
  assertSame(cells(csv), cells(theirs));
  assert.equal(labels.trim().split("\n").length, 67);
  const first = (said) => said.replaceAll(wav, "drop.wav").split("\n")[0];
  assert.match(text, /\(67 bounces in /u);
  assert.equal(first(text), first(command("analyze", wav)));
});

test("a recording that makes the decoder fail is named, and the next one is read", async () => {
  const crash = join(FIXTURES, "crashes/compressed/mp4-overflow-90194350993");
  await choose(page, [crash, wav]);
  await page.waitForFunction(() => document.querySelectorAll("#class-rows tr").length === 2 && !document.getElementById("status").textContent);
  const [first, second] = await page.locator("#class-rows tr").allTextContents();
  assert.match(first, /decoder failed on mp4-overflow/u);
  assert.match(second, /drop\.wav.*0\.929/u);
});
