// Answers the page's requests with the library, away from the thread that draws.

// Recordings that stay decoded: another setting is answered without reading again.
const MOST_OPEN = 3;
const opened = new Map();
let live = null;

function sliceReader(file) {
  const reader = new FileReaderSync();
  return (from, to) => new Uint8Array(reader.readAsArrayBuffer(file.slice(from, to)));
}

function recordingOf({ key, file }) {
  const known = opened.get(key);
  const recording = known ?? new wasm_bindgen.Recorded(file.name, file.size, sliceReader(file));
  // What was asked last is forgotten last.
  opened.delete(key);
  opened.set(key, recording);
  for (const [oldest, other] of opened) {
    if (opened.size <= MOST_OPEN) break;
    opened.delete(oldest);
    other.free();
  }
  return recording;
}

function measured(request) {
  const begin = performance.now();
  const recording = recordingOf(request);
  const document = request.labels === null
    ? recording.analyze(request.asked)
    : recording.fit(request.labels, request.asked);
  return {
    document,
    sheets: recording.sheets(),
    peaks: recording.peaks(),
    cellS: recording.cell_s(),
    csv: recording.csv(),
    labels: recording.labels(),
    text: recording.text(),
    verdicts: recording.verdicts(),
    tookMs: performance.now() - begin,
  };
}

const answers = {
  start: async ({ library }) => {
    await wasm_bindgen({ module_or_path: library });
  },
  rules: () => JSON.parse(wasm_bindgen.rules()),
  measure: measured,
  close: ({ key }) => {
    opened.get(key)?.free();
    opened.delete(key);
  },
  listen: ({ rate, asked }) => {
    live?.free();
    live = new wasm_bindgen.Live(rate, asked);
  },
  hear: ({ samples }) => (live ? { told: JSON.parse(live.hear(samples)), hears: live.hears_something() } : { told: [], hears: false }),
  wav: ({ samples, rate }) => wasm_bindgen.wav(samples, rate),
};

self.onmessage = async ({ data }) => {
  try {
    const value = await answers[data.kind](data);
    self.postMessage({ id: data.id, value });
  } catch (error) {
    const trapped = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    self.postMessage({ id: data.id, problem: error.message ?? String(error), trapped });
  }
};
