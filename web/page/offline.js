"use strict";

// The page after its first visit, without a network. A new version is another store.
const STORE = "bounce-audio VERSION";
const FILES = ["./", "index.html", "style.css", "app.js", "worker.js", "recorder.js", "library.wasm", "manifest.webmanifest",
  "icon.svg"];

async function store() {
  const cache = await caches.open(STORE);
  await cache.addAll(FILES);
  await self.skipWaiting();
}

async function forgetOthers() {
  const names = await caches.keys();
  const others = names.filter((name) => name.startsWith("bounce-audio ") && name !== STORE);
  await Promise.all(others.map((name) => caches.delete(name)));
  await self.clients.claim();
}

async function answer(request) {
  const cache = await caches.open(STORE);
  return (await cache.match(request, { ignoreSearch: true })) ?? fetch(request);
}

self.addEventListener("install", (event) => event.waitUntil(store()));
self.addEventListener("activate", (event) => event.waitUntil(forgetOthers()));
self.addEventListener("fetch", (event) => event.respondWith(answer(event.request)));
