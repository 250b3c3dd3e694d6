// What is asked of a recording: rule, model and channel, each answered as by the command.

import assert from "node:assert/strict";
import { join } from "node:path";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { analyzed, answer, choose, command, document, opened, saved, stage } from "./page.mjs";

let site, chromium, context, page, problems, place, wav, leave;

before(async () => ({ place, wav, site, chromium, leave } = await stage("pingpong")));
after(() => leave?.());
beforeEach(async () => {
  context = await chromium.newContext();
  ({ page, problems } = await opened(context, site.origin));
});
afterEach(async () => {
  await context.close();
  assert.deepEqual(problems, []);
});

// Waits until the page's document meets a condition, which is a function of it; gives it.
async function documentWhere(met) {
  for (let i = 0; i < 50; i += 1) {
    const ours = await document(page);
    if (met(ours)) return ours;
    await page.waitForTimeout(100);
  }
  return assert.fail(`never ${met}`);
}

// What the command says with a rule: it ends with the verdict.
function judged(...args) {
  try {
    return command(...args);
  } catch (error) {
    if ([3, 4].includes(error.status)) return error.stdout;
    throw error;
  }
}

const isNear = (a, b) => Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(b));

async function assertVerdict(...rule) {
  const theirs = JSON.parse(judged("analyze", wav, "--format", "json", ...rule)).rule;
  const ours = (await documentWhere(({ rule: one }) => one !== null && isNear(one.allowed_m[0], theirs.allowed_m[0]))).rule;
  assert.equal(ours.name, theirs.name);
  assert.equal(ours.drops[0].outcome, theirs.drops[0].outcome);
  assert.ok(isNear(ours.drops[0].rebound_m.value, theirs.drops[0].rebound_m.value));
  assert.ok(isNear(ours.mass_kg, theirs.mass_kg));
  const said = await page.textContent("#verdict li");
  assert.ok(said.startsWith(`${theirs.name}: ${theirs.drops[0].outcome}; from `), said);
  const report = judged("analyze", wav, ...rule).replaceAll(/\s+/gu, " ");
  for (const line of await page.locator("#verdict li").allTextContents()) assert.ok(report.includes(line), line);
}

test("every rule of the command can be chosen, and says what it asks for", async () => {
  const help = command("analyze", "--help");
  // The library names them once it is loaded.
  await page.waitForFunction(() => document.querySelectorAll("#rule-books option").length > 0);
  const offered = await page.locator("#rule-books option").evaluateAll((all) => all.map(({ value }) => value));
  assert.ok(offered.length >= 10);
  const [, rules] = /--rule <RULE>[\s\S]*?Possible values:\n([\s\S]*?)\n\s*\n/u.exec(help);
  const known = [...rules.matchAll(/^ +- ([a-z0-9-]+):/gmu)].map(([, name]) => name);
  assert.deepEqual(offered, known);
  await page.selectOption("#rule", "itf-tennis");
  assert.match(await page.textContent("#rule-words"), /from 2540 mm/u);
});

test("a rule judges the drop that is shown, as the command does", async () => {
  await choose(page, wav);
  await answer(page, /67 bounces/);
  assert.equal(await page.locator("#verdict li").count(), 0);
  await page.selectOption("#rule", "ittf-ball");
  await assertVerdict("--rule", "ittf-ball");
  await page.selectOption("#rule", "");
  await page.waitForFunction(() => document.querySelectorAll("#verdict li").length === 0);
  assert.equal((await document(page)).rule, null);
});

test("limits of one's own need the ball, and judge by e or by the rebound", async () => {
  await choose(page, wav);
  await answer(page, /67 bounces/);
  await page.selectOption("#rule", "e");
  await page.fill("#least", "0,9");
  await page.fill("#most", "0.95");
  await page.waitForFunction(() => /need the height/u.test(document.getElementById("settings-error").textContent));
  await page.fill("#height", "30.5");
  await page.fill("#mass", "2.7");
  await page.fill("#diameter", "40");
  const known = ["--height", "30.5cm", "--mass", "2.7g", "--diameter", "40mm"];
  await assertVerdict("--rule", "e=0.9..0.95@30.5cm,2.7g,40mm", ...known);
  assert.ok(await page.isHidden("#settings-error"));
  await page.selectOption("#rule", "rebound");
  await page.fill("#least", "20");
  await page.fill("#most", "21");
  await assertVerdict("--rule", "rebound=20..21cm@30.5cm,2.7g,40mm", ...known);
  await page.fill("#most", "40");
  await page.waitForFunction(() => /height of release at most/u.test(document.getElementById("settings-error").textContent));
  assert.equal(await page.getAttribute("#most", "aria-invalid"), "true");
});

test("every model of the command can be chosen, and is fitted at once", async () => {
  await choose(page, wav);
  await answer(page, /67 bounces/);
  const offered = await page.locator("#model-choice option").evaluateAll((all) => all.map(({ value }) => value || "auto"));
  const [, known] = /--model <MODEL>[\s\S]*?Possible values:\n([\s\S]*?)\n\s*\n/u.exec(command("analyze", "--help"));
  assert.deepEqual([...offered].sort(), [...known.matchAll(/- ([a-z]+):/gu)].map(([, name]) => name).sort());
  for (const model of offered.filter((name) => name !== "auto")) {
    await page.selectOption("#model-choice", model);
    const ours = await documentWhere(({ settings }) => settings.model === model);
    const [a, b] = [ours, analyzed(wav, "--model", model)].map(({ drops: [drop] }) => drop);
    assert.equal(a.model.selected, b.model.selected);
    assert.ok(isNear(a.restitution.value, b.restitution.value), model);
  }
});

test("a rule judges each drop of a class", async () => {
  const files = [3, 4].map((seed) => join(place.path, `judged-${seed}.wav`));
  files.forEach((file, i) => command("synth", "--preset", "pingpong", "--seed", `${3 + i}`, "-o", file));
  const silent = join(place.path, "silent.wav");
  command("synth", "--preset", "silence", "-o", silent);
  await choose(page, [...files, silent]);
  await page.waitForFunction(() => /2 drops/u.test(document.getElementById("class-mean").textContent));
  assert.ok(await page.isHidden("#class-rule"));
  await page.selectOption("#rule", "ittf-ball");
  const outcomes = files.map((file) => JSON.parse(judged("analyze", file, "--format", "json", "--rule", "ittf-ball")).rule.drops[0].outcome);
  const everyRowHas = (count) => page.waitForFunction((cells) => [1, 2].every((i) =>
    document.querySelectorAll(`#class-rows tr:nth-child(${i}) td`).length === cells), count);
  await everyRowHas(8);
  assert.ok(await page.isVisible("#class-rule"));
  const cells = (i) => page.locator(`#class-rows tr:nth-child(${i + 1}) td`).allTextContents();
  for (const [i, outcome] of outcomes.entries()) assert.equal((await cells(i))[6], outcome);
  assert.equal((await cells(2))[1], "no drop found");
  assert.equal(await page.locator("#class-rows tr:nth-child(3) td").nth(1).getAttribute("colspan"), "6");
  await page.selectOption("#rule", "");
  await everyRowHas(7);
  await page.waitForFunction(() => document.querySelector("#class-rule[hidden]"));
});

test("a rule and a model hold for edited impacts too", async () => {
  await choose(page, wav);
  await answer(page, /67 bounces/);
  await page.locator("#editor .impact").last().focus();
  await page.keyboard.press("Delete");
  await answer(page, /66 bounces/);
  await page.selectOption("#rule", "ittf-ball");
  await page.selectOption("#model-choice", "drag");
  await documentWhere(({ rule, settings, drops }) => rule?.name === "ittf-ball" && settings.model === "drag" && drops[0].bounces === 66);
});

test("a channel is chosen where there are several, and forgotten with the next file", async () => {
  const stereo = join(place.path, "stereo.wav");
  command("synth", "--preset", "stereo", "--seed", "2", "-o", stereo);
  await choose(page, stereo);
  await answer(page, /^e = /);
  assert.deepEqual(await page.locator("#channel option").allTextContents(), ["the clearest", "1", "2"]);
  for (const channel of ["1", "2"]) {
    await page.selectOption("#channel", channel);
    const ours = await documentWhere(({ recording }) => recording.channel === Number(channel));
    const theirs = analyzed(stereo, "--channel", channel);
    assert.ok(isNear(ours.drops[0].restitution.value, theirs.drops[0].restitution.value));
  }
  await choose(page, wav);
  await answer(page, /67 bounces/);
  assert.ok(await page.isHidden("#channel-label"));
  assert.equal((await document(page)).recording.channel, 1);
});

const choice = (name, includeHidden = false) => page.getByRole("combobox", { name, exact: true, includeHidden });

test("with the keyboard alone, and named, at the width of a phone", async () => {
  await page.setViewportSize({ width: 360, height: 740 });
  await choose(page, wav);
  await answer(page, /67 bounces/);
  await choice("Rule").focus();
  await page.keyboard.press("ArrowDown");
  await page.waitForFunction(() => document.querySelectorAll("#verdict li").length > 0);
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.id), "model-choice");
  assert.equal(await choice("Model").getAttribute("id"), "model-choice");
  assert.equal(await choice("Channel", true).getAttribute("id"), "channel");
  await choice("Rule").selectOption("rebound");
  for (const name of ["rule", "least", "most", "model-choice"]) {
    const { x, width } = await page.locator(`#${name}`).boundingBox();
    assert.ok(x >= 0 && x + width <= 360, `${name} from ${x}, ${width} wide`);
  }
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
});
