// A long recording: it is read in slices, and memory stays bounded.

import assert from "node:assert/strict";
import { closeSync, ftruncateSync, openSync, readFileSync, writeSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { analyzed, browser, choose, document, folder, opened, served, synthesized } from "./page.mjs";

const BYTES = 200_000_000;
const MOST_MEMORY = 256 << 20;
const HEAD = 44;

// The same recording with silence behind it, up to this size: a WAV of 16 bits and one channel.
function lengthened(path, from) {
  const content = readFileSync(from);
  assert.equal(content.toString("latin1", 36, 40), "data");
  content.writeUInt32LE(BYTES - 8, 4);
  content.writeUInt32LE(BYTES - HEAD, 40);
  const file = openSync(path, "w");
  writeSync(file, content);
  ftruncateSync(file, BYTES);
  closeSync(file);
}

test("200 MB of WAV are measured in bounded memory", { timeout: 180_000 }, async () => {
  const place = folder();
  const site = await served();
  const chromium = await browser();
  try {
    const [short, long] = ["short.wav", "long.wav"].map((name) => join(place.path, name));
    synthesized(short, "steel");
    lengthened(long, short);
    const { page, problems } = await opened(await chromium.newContext(), site.origin);
    await choose(page, long);
    await page.waitForFunction(() => document.getElementById("answer").textContent.startsWith("e ="), null, { timeout: 150_000 });
    const [ours, theirs] = [await document(page), analyzed(long)].map(({ drops: [drop] }) => drop.restitution.value);
    assert.ok(Math.abs(ours - theirs) <= 1e-9);
    const bytes = await page.workers()[0].evaluate(async () => (await wasm_bindgen()).memory.buffer.byteLength);
    console.log(`${Math.round(bytes / 1e6)} MB of memory`);
    assert.ok(bytes > 1e6 && bytes <= MOST_MEMORY, `${bytes} bytes`);
    assert.deepEqual(problems, []);
  } finally {
    await chromium.close();
    await site.close();
    place.remove();
  }
});
