// What was found in one recording, the answer first.

import { element, made, row } from "./dom.js";
import { answerOf, fixed, plusMinus, significant, valueAndError } from "./format.js";

const MODELS = { constant: "constant e", contact: "time in contact", linear: "linear ball with weight", drag: "drag of the air" };

let picture = null;

function headline(recording, drop) {
  if (recording.problem) return "This recording could not be measured";
  return drop ? answerOf(drop) : "No drop found";
}

function ballOf(ball) {
  const parts = [];
  const stiffness = ball?.stiffness_n_per_m;
  if (stiffness) parts.push(`stiffness ${plusMinus(stiffness / 1e3, ball.stiffness_std_n_per_m / 1e3)} N/mm`);
  if (ball?.damping_n_s_per_m) parts.push(`damping ${plusMinus(ball.damping_n_s_per_m, ball.damping_std_n_s_per_m)} N·s/m`);
  return parts;
}

function modelLine(drop) {
  if (!drop) return "";
  const name = drop.model.selected.split("+").map((word) => MODELS[word] ?? word).join(" and ");
  const total = drop.total_time_s === null ? [] : [`${fixed(drop.total_time_s, 4)} s from release to rest`];
  return [`Model: ${name}`, ...total, ...ballOf(drop.ball)].join("; ");
}

// What the rule says of the drop; the first line is the verdict.
function showVerdict(recording, place) {
  const text = recording.problem ? undefined : recording.answer.verdicts[place];
  const lines = (text ?? "").split("\n").filter((line) => line !== "");
  element("verdict").replaceChildren(...lines.map((line) => made("li", { textContent: line })));
  element("verdict").dataset.outcome = text ? recording.report.rule.drops[place].outcome : "";
}

function warningsOf(recording, drop) {
  if (recording.problem) return [recording.problem.message];
  return [...(drop?.warnings ?? []), ...recording.report.warnings].map(({ message }) => message);
}

function sentence(text) {
  const capital = text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?]$/.test(capital) ? capital : `${capital}.`;
}

function showPicture(recording, place) {
  if (picture) URL.revokeObjectURL(picture);
  const sheet = recording.problem ? undefined : recording.answer.sheets[place];
  picture = sheet ? URL.createObjectURL(new Blob([sheet], { type: "image/svg+xml" })) : null;
  const image = element("sheet");
  image.parentElement.hidden = picture === null;
  if (picture) image.src = picture;
  else image.removeAttribute("src");
  image.alt = `Level, onsets, flights, e and heights of ${recording.file.name}; the numbers are in the table`;
}

function impactRow(impact, i) {
  const e = impact.restitution;
  const [value, error] = e === null ? ["–", "–"] : valueAndError(e, impact.restitution_std);
  const thousand = (x, factor) => (x === null ? null : x * factor);
  return row([
    `${i + 1}`,
    fixed(impact.time_s, 6),
    significant(thousand(impact.time_std_s, 1e6)),
    fixed(impact.level_db, 1),
    fixed(thousand(impact.interval_s, 1e3), 3),
    value,
    error,
    fixed(thousand(impact.rebound_height_m, 1e3), 2),
    impact.status,
  ]);
}

function showChoice(drops, place, choose) {
  const buttons = drops.length < 2 ? [] : drops.map((_, i) => {
    const button = made("button", { type: "button", textContent: `Drop ${i + 1}`, ariaPressed: String(i === place) });
    button.addEventListener("click", () => choose(i));
    return button;
  });
  element("which").replaceChildren(...buttons);
}

export function showResult(recording, place, choose) {
  const drops = recording.problem ? [] : recording.report.drops;
  const drop = drops[place];
  element("result").hidden = false;
  element("result-file").textContent = recording.isEdited ? `${recording.file.name}, impacts edited` : recording.file.name;
  element("answer").textContent = headline(recording, drop);
  element("model").textContent = modelLine(drop);
  showVerdict(recording, place);
  const warnings = warningsOf(recording, drop).map((text) => made("li", { textContent: sentence(text) }));
  element("warnings").replaceChildren(...warnings);
  showChoice(drops, place, choose);
  showPicture(recording, place);
  element("rows").replaceChildren(...(drop?.impacts ?? []).map(impactRow));
  element("table-box").hidden = !drop;
  element("editor-box").hidden = recording.report === null;
  for (const name of ["json", "csv", "labels", "svg", "text"]) element(`save-${name}`).hidden = recording.problem !== null;
  element("save-wav").hidden = !recording.isMicrophone;
  element("saving").hidden = recording.problem !== null && !recording.isMicrophone;
}
