// Files for the reader.

import { made } from "./dom.js";

const KEPT_MS = 10_000;

export function save(name, content, type) {
  const address = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  made("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), KEPT_MS);
}

// The name without its ending.
export function stem(name) {
  return name.replace(/\.[^.]+$/, "");
}
