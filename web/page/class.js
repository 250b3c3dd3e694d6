// Several recordings as balls of one kind: a table, the mean and the spread.

import { element, made, row } from "./dom.js";
import { counted, fixed, plusMinus, valueAndError } from "./format.js";

// Mean, standard deviation from one to the next, and standard error of the mean.
export function meanOf(values) {
  const mean = values.reduce((sum, x) => sum + x, 0) / values.length;
  const squares = values.reduce((sum, x) => sum + (x - mean) ** 2, 0);
  const spread = Math.sqrt(squares / (values.length - 1));
  return { mean, spread, error: spread / Math.sqrt(values.length) };
}

export function sentenceOfMean(recordings) {
  const drops = recordings.flatMap((one) => (one.problem ? [] : one.report?.drops ?? []));
  const values = drops.map((drop) => drop.restitution?.value).filter((e) => e !== undefined);
  if (values.length < 2) return "";
  const { mean, spread, error } = meanOf(values);
  return `mean e = ${plusMinus(mean, error)}, spread ${valueAndError(spread, spread)[0]} (${counted(values.length, "drop")})`;
}

function nameCell(recording, show) {
  const button = made("button", { type: "button", textContent: recording.file.name });
  button.addEventListener("click", show);
  return made("td", { className: "name" }, [button]);
}

function removeCell(recording, remove) {
  const button = made("button", { type: "button", textContent: "×", ariaLabel: `Remove ${recording.file.name}` });
  button.addEventListener("click", remove);
  return made("td", {}, [button]);
}

// Of each drop, what the rule says of it, once one is chosen.
function outcomeCells(recording, place) {
  const rule = recording.report.rule;
  return rule ? [made("td", { textContent: rule.drops[place].outcome })] : [];
}

const isJudged = (recordings) => recordings.some((one) => !one.problem && one.report?.rule);

function rowsOf(recording, { shown, columns }, { show, remove }) {
  const className = recording === shown ? "shown" : "";
  const name = (drop) => nameCell(recording, () => show(recording, drop));
  const last = () => removeCell(recording, () => remove(recording));
  const why = recording.problem?.message ?? (recording.report ? null : "…");
  const drops = recording.report?.drops ?? [];
  if (why !== null || drops.length === 0) {
    const text = why ?? "no drop found";
    const cell = made("td", { className: "why", colSpan: columns, textContent: text });
    return [row([name(0), cell, last()], { className })];
  }
  return drops.map((drop, i) => {
    const e = drop.restitution;
    const [value, error] = e ? valueAndError(e.value, e.std_error) : ["–", "–"];
    const time = `${fixed(drop.observed_time_s, 2)} s`;
    return row([name(i), `${i + 1}`, value, error, `${drop.bounces}`, time, ...outcomeCells(recording, i), last()], { className });
  });
}

export function showClass(recordings, shown, actions) {
  const drops = recordings.reduce((sum, one) => sum + (one.report?.drops.length ?? 0), 0);
  element("class").hidden = recordings.length < 2 && drops < 2;
  element("class-mean").textContent = sentenceOfMean(recordings);
  const judged = isJudged(recordings);
  element("class-rule").hidden = !judged;
  // What a table says instead of e, bounces and the like takes all columns between the names and the buttons.
  const table = { shown, columns: judged ? 6 : 5 };
  element("class-rows").replaceChildren(...recordings.flatMap((one) => rowsOf(one, table, actions)));
}
