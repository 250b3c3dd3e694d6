// What was measured before, kept in this browser.

import { element, row } from "./dom.js";
import { fixed, valueAndError } from "./format.js";

const PLACE = "bounce-audio history";
const MOST = 200;

function kept() {
  try {
    const list = JSON.parse(localStorage.getItem(PLACE) ?? "[]");
    return Array.isArray(list) ? list : [];
  } catch {
    // A browser may keep nothing for a page, and what another program wrote is no list.
    return [];
  }
}

function keep(list) {
  try {
    localStorage.setItem(PLACE, JSON.stringify(list));
  } catch {
    // Without a store there is no history, and all else works.
  }
}

function shownRow({ when, file, e, std, bounces, seconds }) {
  const [value, error] = e === null ? ["–", "–"] : valueAndError(e, std);
  return row([new Date(when).toLocaleString([], { dateStyle: "short", timeStyle: "short" }), file, value, error, String(bounces), `${fixed(seconds, 1)} s`]);
}

export function showHistory() {
  const list = kept();
  element("history").hidden = list.length === 0;
  element("history-rows").replaceChildren(...list.map(shownRow));
}

export function remember(file, report) {
  const when = new Date().toISOString();
  const lines = report.drops.map((drop) => ({
    when,
    file,
    e: drop.restitution?.value ?? null,
    std: drop.restitution?.std_error ?? null,
    bounces: drop.bounces,
    seconds: drop.observed_time_s,
  }));
  keep([...lines, ...kept()].slice(0, MOST));
  showHistory();
}

export function watchHistory() {
  element("clear").addEventListener("click", () => {
    keep([]);
    showHistory();
    element("choose").focus();
  });
  showHistory();
}
