// Listening to the microphone: meter, drops as they end, and the recording in the end.

import { element, made, say } from "./dom.js";
import { counted, fixed, plusMinus } from "./format.js";
import { Microphone, sentenceOfRefusal } from "./microphone.js";
import { asked } from "./settings.js";

// What is recorded stays in memory until it is stopped: ten minutes, 115 MB at 48 kHz.
const MOST_S = 600;
const FALL_DB = 2;
const FULL = 0.999;

function lineOf({ restitution, bounces, observed_time_s: observed }) {
  const e = restitution ? `e = ${plusMinus(restitution.value, restitution.std_error)}` : "e not determined";
  return `${e}, ${counted(bounces, "bounce")} in ${fixed(observed, 1)} s`;
}

function joined(blocks) {
  const samples = new Float32Array(blocks.reduce((sum, block) => sum + block.length, 0));
  let at = 0;
  for (const block of blocks) {
    samples.set(block, at);
    at += block.length;
  }
  return samples;
}

export class LivePanel {
  #engine;
  #recorded;
  #microphone = null;
  #blocks = [];
  #handed = 0;
  #isHanding = false;
  #seconds = 0;
  #shownDb = -72;
  #clipped = 0;
  #lines = new Map();

  // `recorded` gets the file of what was heard.
  constructor(engine, recorded) {
    this.#engine = engine;
    this.#recorded = recorded;
    element("microphone").addEventListener("click", () => this.#start());
    element("stop").addEventListener("click", () => this.#stop());
  }

  async #start() {
    if (this.#microphone) return;
    say("");
    Object.assign(element("live-drops"), { textContent: "" });
    this.#blocks = [];
    this.#handed = 0;
    this.#seconds = 0;
    this.#clipped = 0;
    this.#lines.clear();
    try {
      this.#microphone = await Microphone.open((block) => this.#hear(block), () => this.#stop());
      await this.#engine.ask("listen", { rate: this.#microphone.rate, asked: asked() ?? "{}" });
    } catch (error) {
      await this.#microphone?.close();
      this.#microphone = null;
      say(sentenceOfRefusal(error));
      return;
    }
    this.#show(true);
    const { filters } = this.#microphone;
    const warning = element("live-filters");
    warning.hidden = filters.length === 0;
    warning.textContent = `This browser left ${filters.join(" and ")} on, which changes or swallows faint bounces: `
      + "record with another program and open the file.";
    element("stop").focus();
  }

  #show(isOn) {
    element("live").hidden = !isOn;
    element("drop-zone").hidden = isOn;
  }

  async #hear(block) {
    if (!this.#microphone) return;
    this.#blocks.push(block);
    this.#seconds += block.length / this.#microphone.rate;
    this.#meter(block);
    if (this.#seconds >= MOST_S) {
      await this.#stop();
      return;
    }
    await this.#handOver();
  }

  // Hands over what was not heard yet; while the worker is at it, more comes together.
  async #handOver() {
    if (this.#isHanding) return;
    this.#isHanding = true;
    try {
      while (this.#microphone && this.#handed < this.#blocks.length) {
        const samples = joined(this.#blocks.slice(this.#handed));
        this.#handed = this.#blocks.length;
        const { told, hears } = await this.#engine.ask("hear", { samples });
        element("live-state").textContent = hears ? "Hearing something…" : "Listening…";
        for (const one of told) this.#tell(one);
      }
    } catch {
      // The recording is kept here whatever happens to the worker; it is measured in the end.
    }
    this.#isHanding = false;
  }

  #meter(block) {
    const peak = block.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    if (peak >= FULL) this.#clipped += 1;
    const db = Math.max(-72, 20 * Math.log10(peak));
    // It rises at once and falls slowly, so that a bounce is seen.
    this.#shownDb = Math.max(db, this.#shownDb - FALL_DB);
    element("level").value = this.#shownDb;
    element("level-text").textContent = this.#clipped > 0 ? "too loud: move away" : `${fixed(this.#shownDb, 0)} dB`;
    element("live-time").textContent = `${fixed(this.#seconds, 0)} s`;
  }

  #tell({ number, drop }) {
    const line = this.#lines.get(number) ?? made("li");
    line.textContent = lineOf(drop);
    this.#lines.set(number, line);
    element("live-drops").append(line);
  }

  async #stop() {
    const microphone = this.#microphone;
    if (!microphone) return;
    this.#microphone = null;
    await microphone.close();
    this.#show(false);
    const samples = joined(this.#blocks);
    this.#blocks = [];
    if (samples.length === 0) {
      say("Nothing came from the microphone.");
      return;
    }
    const wav = await this.#engine.ask("wav", { samples, rate: microphone.rate });
    const when = new Date().toISOString().slice(0, 19).replaceAll(":", "-");
    this.#recorded(new File([wav], `microphone ${when}.wav`, { type: "audio/wav" }));
  }
}
