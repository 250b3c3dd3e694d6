// The worker with the library: asked here, and started anew where it failed.

import { packed } from "./packed.js";

// The library failed on what it was given; it is whole again.
export class Trapped extends Error {}

async function libraryModule() {
  const inside = await packed("LIBRARY");
  if (inside) return WebAssembly.compile(inside);
  const response = await fetch("library.wasm");
  if (!response.ok) throw new Error(`library.wasm: ${response.statusText}`);
  // Whatever type the server gives it.
  return WebAssembly.compile(await response.arrayBuffer());
}

async function workerAddress() {
  const inside = await packed("WORKER");
  return inside ? URL.createObjectURL(new Blob([inside], { type: "text/javascript" })) : "worker.js";
}

export class Engine {
  #asked = new Map();
  #next = 0;
  #worker = null;
  #ready;

  constructor() {
    this.#ready = Promise.all([libraryModule(), workerAddress()]);
  }

  // Gives the answer to a request; several are answered in their order.
  async ask(kind, request = {}) {
    const [library, address] = await this.#ready;
    if (this.#worker === null) this.#start(library, address);
    return this.#send({ kind, ...request });
  }

  #send(request) {
    return new Promise((resolve, reject) => {
      const id = this.#next++;
      this.#asked.set(id, { request, resolve, reject });
      this.#worker.postMessage({ id, ...request });
    });
  }

  #start(library, address) {
    const worker = new Worker(address);
    this.#worker = worker;
    worker.onmessage = ({ data }) => this.#answered(data);
    // Without a message of its own it failed at what was asked first.
    worker.onerror = (event) => {
      event.preventDefault();
      const [id] = this.#asked.keys();
      this.#answered({ id, problem: event.message, trapped: true });
    };
    this.#send({ kind: "start", library }).catch(() => {});
  }

  #answered({ id, value, problem, trapped }) {
    const asked = this.#asked.get(id);
    if (asked === undefined) return;
    this.#asked.delete(id);
    if (trapped) this.#restart();
    if (problem === undefined) asked.resolve(value);
    else asked.reject(trapped ? new Trapped(problem) : new Error(problem));
  }

  // What failed is in an unknown state: it is ended, and what waited behind it is asked of another.
  #restart() {
    this.#worker.terminate();
    this.#worker = null;
    const waiting = [...this.#asked.values()].filter(({ request }) => request.kind !== "start");
    this.#asked.clear();
    for (const { request, resolve, reject } of waiting) {
      const { kind, ...rest } = request;
      this.ask(kind, rest).then(resolve, reject);
    }
  }
}
