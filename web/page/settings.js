// What is known of the ball and asked of the recording, typed in and chosen.

import { element, made } from "./dom.js";

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

// What limits of one's own are of: its unit in SI, that unit's name, and what they go up to, in words.
const OWN = {
  e: { unit: 1, name: "", most: "1" },
  rebound: { unit: 1e-2, name: "cm", most: "the height of release" },
};
let about = new Map();

// Limits of one's own as the command takes them: of a ball whose height, mass and diameter are given.
function limitsTyped({ height_m: height, mass_kg: mass, diameter_m: diameter }, kind) {
  const { unit, most: inWords } = OWN[kind];
  const [least, most] = ["least", "most"].map((id) => numberIn({ id, unit }));
  const greatest = kind === "e" ? 1 : height;
  const areWrong = !(least !== null && least >= 0 && least < most && most <= greatest);
  for (const id of ["least", "most"]) element(id).setAttribute("aria-invalid", String(areWrong));
  if ([height, mass, diameter].includes(undefined)) return { missing: "Limits of your own need the height, mass and diameter of the ball." };
  if (areWrong) return { missing: `Limits of your own go from less to more, from 0 to ${inWords} at most.` };
  return { rule: `${kind}=${least}..${most}@${height}m,${mass}kg,${diameter}m` };
}

function ruleTyped(settings) {
  const name = element("rule").value;
  if (name in OWN) return limitsTyped(settings, name);
  return name === "" ? {} : { rule: name };
}

function ballTyped() {
  const settings = {};
  const wrong = [];
  for (const input of INPUTS) {
    const value = numberIn(input);
    const is = isWrong(input, value);
    element(input.id).setAttribute("aria-invalid", String(is));
    if (is) wrong.push(input.word);
    else if (value !== null) settings[input.name] = value;
  }
  return { settings, wrong };
}

// What is asked as JSON, or null where an input is wrong, which is said.
export function asked() {
  const { settings, wrong } = ballTyped();
  const model = element("model-choice").value;
  const channel = element("channel").value;
  const { rule, missing } = ruleTyped(settings);
  const problem = wrong.length > 0 ? `Not a number above 0 that a ${wrong.join(" or ")} can have.` : missing ?? "";
  element("settings-error").hidden = problem === "";
  element("settings-error").textContent = problem;
  if (problem !== "") return null;
  return JSON.stringify({
    settings: model === "" ? settings : { ...settings, model },
    ...(channel === "" ? {} : { channel: Number(channel) }),
    ...(rule === undefined ? {} : { rule }),
  });
}

// Shows what the chosen rule says, and where its limits are typed in if they are one's own.
function showRule() {
  const name = element("rule").value;
  const words = about.get(name) ?? "";
  element("rule-words").textContent = words;
  element("rule-words").hidden = words === "";
  element("limits").hidden = !(name in OWN);
  for (const unit of document.querySelectorAll(".of-limits")) unit.textContent = OWN[name]?.name ?? "";
}

// Offers the rules that the library knows.
export function offerRules(rules) {
  about = new Map(rules.map(({ name, words }) => [name, words]));
  const options = rules.map(({ name, about: text }) => made("option", { value: name, textContent: text }));
  element("rule-books").replaceChildren(...options);
  showRule();
}

// Offers the channels of what is open, if there is more than one; `isNew` takes back what was chosen of something else.
export function offerChannels(count, isNew) {
  const chosen = isNew ? "" : element("channel").value;
  const numbers = Array.from({ length: count }, (_, i) => made("option", { value: `${i + 1}`, textContent: `${i + 1}` }));
  element("channel").replaceChildren(made("option", { value: "", textContent: "the clearest" }), ...numbers);
  element("channel").value = chosen;
  element("channel-label").hidden = count < 2;
}

// Tells of what is asked anew once typing pauses.
export function watchSettings(changedTo) {
  let timer = 0;
  const form = element("settings");
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", () => {
    showRule();
    clearTimeout(timer);
    timer = setTimeout(() => {
      const now = asked();
      if (now !== null) changedTo(now);
    }, WAIT_MS);
  });
}
