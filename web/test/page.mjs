// The page in a browser, served from web/dist or opened from the disk.

import { execFileSync } from "node:child_process";
import { createServer } from "node:http";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join, resolve } from "node:path";
import { chromium } from "playwright-core";

export const DIST = resolve(import.meta.dirname, "../dist");
export const FIXTURES = resolve(import.meta.dirname, "../../fixtures");
const COMMAND = process.env.BOUNCE_AUDIO;
const BROWSER = process.env.CHROMIUM ?? "/usr/bin/chromium";
const QUIET = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];
const TYPES = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".wasm": "application/wasm",
  ".svg": "image/svg+xml", ".webmanifest": "application/manifest+json" };

// A server of the built page, and how it is asked.
export async function served() {
  const server = createServer((request, response) => {
    const path = new URL(request.url, "http://localhost").pathname;
    const name = path === "/" ? "/index.html" : path;
    try {
      const content = readFileSync(join(DIST, name));
      response.writeHead(200, { "content-type": TYPES[extname(name)] ?? "application/octet-stream" }).end(content);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((ready) => server.listen(0, "localhost", ready));
  const origin = `http://localhost:${server.address().port}`;
  return { origin, close: () => new Promise((closed) => server.close(closed) && server.closeAllConnections()) };
}

// A browser of its own store; `more` are arguments of its start.
export function browser(more = []) {
  return chromium.launch({ executablePath: BROWSER, headless: true, args: [...QUIET, ...more] });
}

// A page that was opened, with all that it asked for and all that went wrong in it.
export async function opened(context, address) {
  const page = await context.newPage();
  const [requests, problems] = [[], []];
  page.on("request", (request) => requests.push(request.url()));
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  await page.goto(address);
  await page.waitForFunction(() => !document.getElementById("choose").disabled);
  return { page, requests, problems };
}

export async function choose(page, files) {
  await page.setInputFiles("#files", files);
}

// Waits for an answer that matches.
export async function answer(page, pattern) {
  await page.waitForFunction(
    (source) => new RegExp(source, "u").test(document.getElementById("answer").textContent),
    pattern.source,
    { timeout: 20_000 },
  );
  return page.textContent("#answer");
}

// What the page saves by one of its buttons.
export async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(button)]);
  return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
}

export async function document(page) {
  return JSON.parse((await saved(page, "#save-json")).content);
}

// A folder that is gone after the tests.
export function folder() {
  const path = mkdtempSync(join(tmpdir(), "bounce-audio-page-"));
  return { path, remove: () => rmSync(path, { recursive: true }) };
}

// What tests need before they open a page: a folder with a recording of a preset, the page's server and a browser.
export async function stage(preset) {
  const place = folder();
  const wav = synthesized(join(place.path, "drop.wav"), preset);
  const site = await served();
  const chromium = await browser();
  const leave = async () => {
    await chromium.close();
    await site.close();
    place.remove();
  };
  return { place, wav, site, chromium, leave };
}

export function command(...args) {
  return execFileSync(COMMAND, args, { encoding: "utf8" });
}

export function synthesized(path, preset, seed = 1) {
  command("synth", "--preset", preset, "--seed", String(seed), "-o", path);
  return path;
}

// What the command says of a file, without drop as well.
export function analyzed(path, ...more) {
  try {
    return JSON.parse(command("analyze", path, "--format", "json", ...more));
  } catch (error) {
    if (error.status === 1) return JSON.parse(error.stdout);
    throw error;
  }
}
