// The microphone: as it is, without what makes speech clearer and hides a bounce.

import { packed } from "./packed.js";

const FILTERS = { echoCancellation: "echo cancellation", noiseSuppression: "noise suppression", autoGainControl: "automatic gain" };

// The worklet's script; from a disk only an address with the text itself is taken.
async function recorderAddress() {
  const inside = await packed("RECORDER");
  return inside ? `data:text/javascript,${encodeURIComponent(new TextDecoder().decode(inside))}` : "recorder.js";
}

// The filters that the browser left on, in words.
export function filtersOn(track) {
  const settings = track.getSettings();
  return Object.keys(FILTERS).filter((name) => settings[name] === true).map((name) => FILTERS[name]);
}

export class Microphone {
  // Begins; `heard` gets each block of samples, and `ended` is told where the microphone is taken away.
  static async open(heard, ended) {
    const off = Object.fromEntries(Object.keys(FILTERS).map((name) => [name, false]));
    const stream = await navigator.mediaDevices.getUserMedia({ audio: off });
    const [track] = stream.getAudioTracks();
    // Without a rate it has that of the device: nothing is resampled.
    const context = new AudioContext();
    try {
      await context.audioWorklet.addModule(await recorderAddress());
      await context.resume();
    } catch (error) {
      track.stop();
      throw error;
    }
    const recorder = new AudioWorkletNode(context, "recorder");
    recorder.port.onmessage = ({ data }) => heard(data);
    context.createMediaStreamSource(stream).connect(recorder);
    // It is heard only where it leads somewhere; what it plays is silence.
    recorder.connect(context.destination);
    track.onended = ended;
    return new Microphone(track, context);
  }

  constructor(track, context) {
    this.track = track;
    this.context = context;
    this.rate = context.sampleRate;
    this.filters = filtersOn(track);
  }

  async close() {
    this.track.onended = null;
    this.track.stop();
    await this.context.close();
  }
}

export function sentenceOfRefusal(error) {
  const known = {
    NotAllowedError: "The browser may not use the microphone: allow it for this page, then try again.",
    NotFoundError: "There is no microphone.",
    NotReadableError: "Another program holds the microphone.",
  };
  return known[error.name] ?? `The microphone cannot be used: ${error.message}`;
}
