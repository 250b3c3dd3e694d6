// The level of a recording over time, as lines to draw.

const LEAST_DB = -96;
const RANGE_DB = 30;

export function decibels(peak) {
  return Math.max(LEAST_DB, 20 * Math.log10(peak));
}

// The greatest peak of cells within some seconds.
export function peakBetween({ peaks, cellS }, fromS, toS) {
  const first = Math.max(0, Math.floor(fromS / cellS));
  const end = Math.min(peaks.length, Math.max(first + 1, Math.ceil(toS / cellS)));
  let peak = 0;
  for (let i = first; i < end; i += 1) peak = Math.max(peak, peaks[i]);
  return peak;
}

// The foot of the picture: below the ordinary level.
export function footOf({ peaks }) {
  const step = Math.max(1, Math.floor(peaks.length / 2000));
  const some = peaks.filter((_, i) => i % step === 0).sort();
  const ordinary = decibels(some[Math.floor(some.length / 10)] ?? 0);
  return Math.min(-RANGE_DB, Math.max(LEAST_DB, 10 * Math.floor((ordinary - 6) / 10)));
}

// Round times for an axis: at most so many.
export function ticks(fromS, toS, most) {
  const rough = (toS - fromS) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= rough);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const first = Math.ceil(fromS / step);
  const count = Math.floor(toS / step) - first + 1;
  return Array.from({ length: count }, (_, i) => {
    const timeS = (first + i) * step;
    return { timeS, text: timeS.toFixed(decimals) };
  });
}
