// The microphone, which here plays a file.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { analyzed, answer, browser, document, folder, opened, saved, served, synthesized } from "./page.mjs";

let site, place, wav;

before(async () => {
  place = folder();
  wav = synthesized(join(place.path, "drop.wav"), "steel");
  site = await served();
});
after(async () => {
  await site?.close();
  place.remove();
});

function withMicrophone(file) {
  return browser(["--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream",
    `--use-file-for-fake-audio-capture=${file}%noloop`]);
}

test("a drop is told while the microphone listens, and measured as the command measures the WAV", async () => {
  const chromium = await withMicrophone(wav);
  try {
    const context = await chromium.newContext({ permissions: ["microphone"] });
    const { page, problems } = await opened(context, site.origin);
    await page.click("#microphone");
    await page.waitForSelector("#live:not([hidden])");
    assert.ok(await page.isHidden("#live-filters"), "the filters are off");
    await page.waitForFunction(() => document.getElementById("level").value > -40, null, { timeout: 10_000 });
    await page.waitForSelector("#live-drops li", { timeout: 15_000 });
    const told = await page.textContent("#live-drops li");
    assert.match(told, /^e = 0\.\d+ ± 0\.\d+, \d+ bounces in/u);
    await page.click("#stop");
    await answer(page, /^e = /);
    assert.equal(await page.locator("#live-drops li").count(), 1, "each drop is told once");
    const ours = await document(page);
    const { content } = await saved(page, "#save-wav");
    const heard = join(place.path, "heard.wav");
    writeFileSync(heard, content);
    const [mine, command, played] = [ours, analyzed(heard), analyzed(wav)].map(({ drops: [drop] }) => drop.restitution);
    assert.ok(Math.abs(mine.value - command.value) <= 1e-9, `${mine.value} and ${command.value}`);
    assert.ok(Math.abs(mine.value - played.value) <= 3 * played.std_error + 3 * mine.std_error, `${mine.value}, played ${played.value}`);
    const live = Number(/e = ([\d.]+)/u.exec(told)[1]);
    assert.ok(Math.abs(live - mine.value) <= 2 * mine.std_error, `${live} and ${mine.value}`);
    assert.deepEqual(problems, []);
  } finally {
    await chromium.close();
  }
});

test("a filter that stayed on is told", async () => {
  const chromium = await withMicrophone(wav);
  try {
    const context = await chromium.newContext({ permissions: ["microphone"] });
    await context.addInitScript(() => {
      const settings = MediaStreamTrack.prototype.getSettings;
      MediaStreamTrack.prototype.getSettings = function stubborn() {
        return { ...settings.call(this), noiseSuppression: true };
      };
    });
    const { page } = await opened(context, site.origin);
    await page.click("#microphone");
    await page.waitForSelector("#live-filters:not([hidden])");
    assert.match(await page.textContent("#live-filters"), /noise suppression on/u);
  } finally {
    await chromium.close();
  }
});

test("a microphone that is refused is a sentence", async () => {
  const chromium = await browser(["--use-fake-device-for-media-stream", "--deny-permission-prompts"]);
  try {
    const { page } = await opened(await chromium.newContext(), site.origin);
    await page.click("#microphone");
    await page.waitForFunction(() => /allow it for this page|no microphone/u.test(document.getElementById("status").textContent));
    assert.ok(await page.isVisible("#drop-zone"));
  } finally {
    await chromium.close();
  }
});
