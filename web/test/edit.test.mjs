// Impacts moved, added, removed and switched off: the fit follows, and is that of the command for the same labels.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { analyzed, answer, choose, document, opened, saved, stage } from "./page.mjs";

let site, chromium, context, page, problems, place, wav, leave;

before(async () => ({ place, wav, site, chromium, leave } = await stage("steel")));
after(() => leave?.());
beforeEach(async () => {
  context = await chromium.newContext({ viewport: { width: 1000, height: 900 } });
  ({ page, problems } = await opened(context, site.origin));
  await choose(page, wav);
  await answer(page, /^e = /);
});
afterEach(async () => {
  await context.close();
  assert.deepEqual(problems, []);
});

// Waits until the answer differs; gives the document.
async function followed(said) {
  await page.waitForFunction((before) => document.getElementById("answer").textContent !== before, said);
  return document(page);
}

const fixed6 = (seconds) => seconds.toFixed(6);
const marks = () => page.locator("#editor .impact");

// The fit of the page is that of the command for the labels that the page saves.
async function assertFitIsTheCommands(ours) {
  const labels = join(place.path, "labels.txt");
  writeFileSync(labels, (await saved(page, "#save-labels")).content);
  const theirs = analyzed(wav, "--impacts", labels);
  const [a, b] = [ours, theirs].map(({ drops: [drop] }) => drop.restitution.value);
  assert.ok(Math.abs(a - b) <= 1e-9, `${a} and ${b}`);
  assert.ok(ours.drops[0].warnings.some(({ code }) => code === "impacts_given"));
}

test("an impact is removed by its key, and comes back by Undo", async () => {
  const before = await document(page);
  const said = await page.textContent("#answer");
  const count = before.drops[0].impacts.length;
  assert.equal(await marks().count(), count);
  await marks().last().focus();
  await page.keyboard.press("Delete");
  const after = await followed(said);
  assert.equal(after.drops[0].impacts.length, count - 1);
  await assertFitIsTheCommands(after);
  await page.click("#undo");
  await answer(page, new RegExp(`^${said}$`, "u"));
  assert.deepEqual((await document(page)).drops[0].restitution, before.drops[0].restitution);
  assert.ok(await page.isDisabled("#undo"));
});

test("an impact is dragged, and the fit follows with the error of a hand", async () => {
  const [first] = (await document(page)).drops[0].impacts;
  const said = await page.textContent("#answer");
  const box = await marks().first().locator("rect").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + 100];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 12, y, { steps: 4 });
  await page.mouse.up();
  const ours = await followed(said);
  const [moved] = ours.drops[0].impacts;
  assert.ok(moved.time_s - first.time_s > 0.005, `${first.time_s} to ${moved.time_s}`);
  assert.equal(moved.time_std_s, 1e-3);
  assert.ok(await page.isVisible("#editor .impact.hand"));
  await page.click("#reset");
  await answer(page, new RegExp(`^${said}$`, "u"));
});

test("the keyboard moves an impact by a millisecond", async () => {
  const [, second] = (await document(page)).drops[0].impacts;
  await marks().nth(1).focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.querySelectorAll("#editor .impact.hand").length === 1
    && /impacts edited/u.test(document.getElementById("result-file").textContent));
  const focused = await page.evaluate(() => document.activeElement.getAttribute("aria-label"));
  assert.equal(focused, "Impact 2");
  const there = fixed6(second.time_s + 2e-3);
  await page.waitForFunction((time) => document.querySelectorAll("#rows tr")[1].cells[1].textContent === time, there);
  assert.equal((await document(page)).drops[0].impacts[1].time_std_s, 1e-3);
});

test("an impact is added where the picture is clicked twice, and switched off", async () => {
  const count = await marks().count();
  const said = await page.textContent("#answer");
  const box = await page.locator("#editor").boundingBox();
  await page.mouse.dblclick(box.x + box.width - 4, box.y + 150);
  const more = await followed(said);
  assert.equal(more.drops[0].impacts.length, count + 1);
  const now = await page.textContent("#answer");
  await marks().last().focus();
  await page.keyboard.press(" ");
  const off = await followed(now);
  assert.equal(off.drops[0].impacts.at(-1).status, "inferred");
  assert.equal(off.drops[0].bounces, count);
});

test("a setting keeps the edited impacts", async () => {
  const said = await page.textContent("#answer");
  await marks().last().focus();
  await page.keyboard.press("Delete");
  const edited = await followed(said);
  await page.fill("#height", "50");
  await page.waitForFunction(() => /height makes it/u.test(document.getElementById("warnings").textContent));
  const ours = await document(page);
  assert.equal(ours.settings.height_m, 0.5);
  assert.equal(ours.drops[0].impacts.length, edited.drops[0].impacts.length);
});

test("closer and wider keep what is chosen in sight", async () => {
  await marks().nth(3).focus();
  const name = await page.evaluate(() => document.activeElement.dataset.id);
  for (let i = 0; i < 6; i += 1) await page.click("#zoom-in");
  assert.ok(await page.isVisible(`#editor [data-id="${name}"]`));
  const few = await marks().count();
  for (let i = 0; i < 8; i += 1) await page.click("#zoom-out");
  assert.ok((await marks().count()) > few);
});
