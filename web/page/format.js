// Numbers as the command writes them.

// Decimals of two digits of an error.
function decimalsOf(std) {
  if (!(std > 0) || !Number.isFinite(std)) return 4;
  return Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(std))));
}

export function fixed(value, decimals) {
  return value === null || value === undefined ? "–" : value.toFixed(decimals).replace("-", "−");
}

// Value and error, both with as many decimals as the error's two digits need.
export function valueAndError(value, std) {
  const decimals = decimalsOf(std);
  return [fixed(value, decimals), fixed(std, decimals)];
}

export function plusMinus(value, std) {
  return valueAndError(value, std).join(" ± ");
}

export function significant(value, digits = 2) {
  return value === null || value === undefined ? "–" : String(Number(value.toPrecision(digits))).replace("-", "−");
}

export function counted(count, one, many = `${one}s`) {
  return `${count} ${count === 1 ? one : many}`;
}

export function answerOf(drop) {
  const estimate = drop.restitution;
  const e = estimate ? `e = ${plusMinus(estimate.value, estimate.std_error)}` : "e not determined";
  return `${e}, ${counted(drop.bounces, "bounce")} in ${fixed(drop.observed_time_s, 1)} s`;
}
