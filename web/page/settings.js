// What is known of the ball, typed in.

import { element } from "./dom.js";

// Each input, its name in the document, its unit in SI, and what it may be, in its own unit.
const INPUTS = [
  { id: "height", name: "height_m", unit: 1e-2, least: 1e-4, most: 1e6, word: "height" },
  { id: "mass", name: "mass_kg", unit: 1e-3, least: 1e-6, most: 1e9, word: "mass" },
  { id: "diameter", name: "diameter_m", unit: 1e-3, least: 1e-3, most: 1e6, word: "diameter" },
];
const WAIT_MS = 200;

// The number in an input, in SI: null where it is empty, NaN where it is none. 30.5 cm is 0.305 m to the last digit.
function numberIn({ id, unit }) {
  const text = element(id).value.trim().replace(",", ".");
  if (text === "") return null;
  return Number(text) / Math.round(1 / unit);
}

function isWrong({ unit, least, most }, value) {
  return value !== null && !(value >= least * unit && value <= most * unit);
}

// The settings as JSON, or null where an input is wrong, which is said.
export function settingsTyped() {
  const settings = {};
  const wrong = [];
  for (const input of INPUTS) {
    const value = numberIn(input);
    const is = isWrong(input, value);
    element(input.id).setAttribute("aria-invalid", String(is));
    if (is) wrong.push(input.word);
    else if (value !== null) settings[input.name] = value;
  }
  const said = element("settings-error");
  said.hidden = wrong.length === 0;
  said.textContent = wrong.length === 0 ? "" : `Not a number above 0 that a ${wrong.join(" or ")} can have.`;
  return wrong.length === 0 ? JSON.stringify(settings) : null;
}

// Tells of new settings once typing pauses.
export function watchSettings(changedTo) {
  let timer = 0;
  const form = element("settings");
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", () => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      const settings = settingsTyped();
      if (settings !== null) changedTo(settings);
    }, WAIT_MS);
  });
}
