// The level picture in which impacts are moved, added and removed.

import { element } from "./dom.js";
import { decibels, footOf, peakBetween, ticks } from "./level.js";
import { fixed } from "./format.js";

const SVG = "http://www.w3.org/2000/svg";
const HEIGHT = 208;
const FOOT = 22;
const HEAD = 12;
const CLOSEST_S = 0.01;
const STEP_S = 1e-3;
const FINE_STEP_S = 1e-4;

function drawn(tag, attributes, text = "") {
  const one = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
  one.textContent = text;
  return one;
}

export class Editor {
  #edit;
  #sound = null;
  #marks = [];
  #view = { fromS: 0, toS: 1 };
  #chosen = null;
  #dragged = false;

  // What is to be done: `move(id, timeS, done)`, `add(timeS)`, `remove(id)`, `toggle(id)`; `chose(id)` tells of a choice.
  constructor(edit) {
    this.#edit = edit;
    const box = element("editor");
    box.addEventListener("dblclick", (event) => this.#edit.add(this.#timeAt(event)));
    box.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    new ResizeObserver(() => this.draw()).observe(box);
  }

  get chosen() {
    return this.#chosen;
  }

  get dragging() {
    return this.#dragged;
  }

  get middleS() {
    return (this.#view.fromS + this.#view.toS) / 2;
  }

  // Another recording or drop: all of it is seen.
  open(sound, marks) {
    this.#sound = { ...sound, foot: footOf(sound) };
    this.#marks = marks;
    this.#chosen = null;
    const endS = sound.peaks.length * sound.cellS;
    const [first, last] = marks.length > 1 ? [marks[0].timeS, marks.at(-1).timeS] : [0, endS];
    const beside = 0.05 + 0.05 * (last - first);
    this.#look(first - beside, last + beside);
  }

  // Other impacts of the same drop.
  set(marks) {
    this.#marks = marks;
    if (!marks.some((one) => one.id === this.#chosen)) this.choose(null);
    this.draw();
  }

  choose(id) {
    this.#chosen = id;
    for (const one of element("editor").querySelectorAll(".impact")) {
      one.classList.toggle("chosen", Number(one.dataset.id) === id);
    }
    this.#edit.chose(id);
  }

  zoom(factor, aboutS = this.#aboutS()) {
    const { fromS, toS } = this.#view;
    this.#look(aboutS + (fromS - aboutS) * factor, aboutS + (toS - aboutS) * factor);
  }

  pan(share) {
    const { fromS, toS } = this.#view;
    const by = share * (toS - fromS);
    this.#look(fromS + by, toS + by);
  }

  #aboutS() {
    return this.#marks.find((one) => one.id === this.#chosen)?.timeS ?? this.middleS;
  }

  #look(fromS, toS) {
    const endS = Math.max(CLOSEST_S, this.#sound.peaks.length * this.#sound.cellS);
    const lengthS = Math.min(endS, Math.max(CLOSEST_S, toS - fromS));
    const begin = Math.min(Math.max(0, fromS), endS - lengthS);
    this.#view = { fromS: begin, toS: begin + lengthS };
    this.draw();
  }

  #wheel(event) {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    this.zoom(event.deltaY > 0 ? 1.25 : 0.8, this.#timeAt(event));
  }

  get #width() {
    return Math.max(200, element("editor").clientWidth);
  }

  #x(timeS) {
    const { fromS, toS } = this.#view;
    return ((timeS - fromS) / (toS - fromS)) * this.#width;
  }

  #y(db) {
    return HEAD + (db / this.#sound.foot) * (HEIGHT - FOOT - HEAD);
  }

  #timeAt(event) {
    const box = element("editor").getBoundingClientRect();
    const { fromS, toS } = this.#view;
    return fromS + ((event.clientX - box.left) / box.width) * (toS - fromS);
  }

  draw() {
    if (this.#sound === null) return;
    const focused = document.activeElement?.dataset?.id;
    const svg = drawn("svg", { viewBox: `0 0 ${this.#width} ${HEIGHT}`, preserveAspectRatio: "none" });
    svg.append(...this.#axis(), this.#wave(), ...this.#marks.filter((one) => this.#seen(one)).map((one) => this.#impact(one)));
    element("editor").replaceChildren(svg);
    if (focused !== undefined) svg.querySelector(`[data-id="${focused}"]`)?.focus();
  }

  #seen({ timeS }) {
    return timeS >= this.#view.fromS && timeS <= this.#view.toS;
  }

  #axis() {
    const { fromS, toS } = this.#view;
    const foot = HEIGHT - FOOT;
    const times = ticks(fromS, toS, this.#width / 90).flatMap(({ timeS, text }) => {
      const x = this.#x(timeS);
      return [
        drawn("line", { class: "tick", x1: x, x2: x, y1: HEAD, y2: foot }),
        drawn("text", { class: "axis", x, y: HEIGHT - 6, "text-anchor": "middle" }, `${text} s`),
      ];
    });
    const levels = [];
    for (let db = 0; db > this.#sound.foot; db -= 20) {
      const y = this.#y(db);
      levels.push(drawn("line", { class: "tick", x1: 0, x2: this.#width, y1: y, y2: y }));
      levels.push(drawn("text", { class: "axis", x: 3, y: y + 12 }, `${fixed(db, 0)} dB`));
    }
    return [...times, ...levels];
  }

  #wave() {
    const { fromS, toS } = this.#view;
    const stepS = (toS - fromS) / this.#width;
    const foot = HEIGHT - FOOT;
    const points = [`M0 ${foot}`];
    for (let x = 0; x < this.#width; x += 1) {
      const peak = peakBetween(this.#sound, fromS + x * stepS, fromS + (x + 1) * stepS);
      points.push(`L${x} ${Math.min(foot, this.#y(decibels(peak))).toFixed(1)}`);
    }
    return drawn("path", { class: "wave", d: `${points.join("")}L${this.#width} ${foot}Z` });
  }

  #impact(one) {
    const number = this.#marks.indexOf(one) + 1;
    const peak = peakBetween(this.#sound, one.timeS, one.timeS + 4e-3);
    const classes = ["impact", one.status === "inferred" && "off", one.hand && "hand", one.id === this.#chosen && "chosen"];
    const group = drawn("g", {
      class: classes.filter(Boolean).join(" "),
      "data-id": one.id,
      tabindex: 0,
      role: "slider",
      "aria-label": `Impact ${number}`,
      "aria-valuenow": one.timeS,
      "aria-valuemin": 0,
      "aria-valuemax": this.#sound.peaks.length * this.#sound.cellS,
      "aria-valuetext": `${fixed(one.timeS, 4)} s, ${one.status === "inferred" ? "not counted" : "counted"}`,
      transform: `translate(${this.#x(one.timeS)} 0)`,
    });
    group.append(
      drawn("rect", { x: -7, y: 0, width: 14, height: HEIGHT - FOOT }),
      drawn("line", { y1: HEAD, y2: HEIGHT - FOOT }),
      drawn("circle", { cy: Math.min(HEIGHT - FOOT, this.#y(decibels(peak))), r: 5 }),
      drawn("title", {}, `Impact ${number} at ${fixed(one.timeS, 4)} s`),
    );
    group.addEventListener("focus", () => this.choose(one.id));
    group.addEventListener("keydown", (event) => this.#key(event, one));
    group.addEventListener("pointerdown", (event) => this.#drag(event, group, one));
    return group;
  }

  #drag(event, group, one) {
    if (event.button !== 0) return;
    event.preventDefault();
    group.focus();
    group.setPointerCapture(event.pointerId);
    const grabbedS = this.#timeAt(event) - one.timeS;
    let timeS = one.timeS;
    group.onpointermove = (move) => {
      timeS = this.#timeAt(move) - grabbedS;
      this.#dragged = true;
      group.setAttribute("transform", `translate(${this.#x(timeS)} 0)`);
      this.#edit.move(one.id, timeS, false);
    };
    group.onpointerup = group.onpointercancel = () => {
      group.onpointermove = group.onpointerup = group.onpointercancel = null;
      if (!this.#dragged) return;
      this.#dragged = false;
      this.#edit.move(one.id, timeS, true);
    };
  }

  #key(event, one) {
    const step = event.shiftKey ? FINE_STEP_S : STEP_S;
    const does = {
      ArrowLeft: () => this.#edit.move(one.id, one.timeS - step, true),
      ArrowRight: () => this.#edit.move(one.id, one.timeS + step, true),
      Delete: () => this.#edit.remove(one.id),
      Backspace: () => this.#edit.remove(one.id),
      " ": () => this.#edit.toggle(one.id),
    }[event.key];
    if (does === undefined) return;
    event.preventDefault();
    does();
  }
}
