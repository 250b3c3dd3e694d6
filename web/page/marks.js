// The impacts of each drop as a person edits them, and as the labels that the command reads.

let lastMark = 0;

function mark(impact, hand) {
  lastMark += 1;
  return { id: lastMark, timeS: impact.time_s, stdS: impact.time_std_s, status: impact.status, hand };
}

// What was heard; where that is no drop, what comes nearest to one.
export function marksOf(report) {
  const drops = report.drops.length > 0 ? report.drops : [report.candidate].filter(Boolean);
  return drops.map((drop) => drop.impacts.map((impact) => mark(impact, false)));
}

export function setByHand(timeS) {
  return mark({ time_s: timeS, time_std_s: null, status: "heard" }, true);
}

export function inOrder(marks) {
  return marks.toSorted((a, b) => a.timeS - b.timeS);
}

export function changed(marks, id, change) {
  return inOrder(marks.map((one) => (one.id === id ? { ...one, ...change } : one)));
}

export function moved(marks, id, timeS) {
  return changed(marks, id, { timeS: Math.max(0, timeS), hand: true });
}

// An impact that is not counted bounds no flight; one that counts again has the error of a hand, if it had none.
export function toggled(marks, id) {
  const { status, stdS } = marks.find((one) => one.id === id);
  if (status !== "inferred") return changed(marks, id, { status: "inferred" });
  return changed(marks, id, stdS === null ? { status: "heard", hand: true } : { status: "heard" });
}

function said(one, drop, number) {
  if (one.hand) return `${drop}: ${one.status}`;
  const error = one.status === "inferred" || one.stdS === null ? "" : ` ±${one.stdS}`;
  return `${drop}:${number} ${one.status} at ${one.timeS}${error} s`;
}

// A label track of Audacity.
export function labelTrack(drops) {
  const lines = drops.flatMap((marks, drop) => marks.map((one, i) => {
    const time = one.timeS.toFixed(6);
    return `${time}\t${time}\t${said(one, drop + 1, i + 1)}\n`;
  }));
  return lines.join("");
}
