// One recording of the page: its file, what was found in it, and how a person edited that.

import { labelTrack, marksOf } from "./marks.js";

let lastKey = 0;

export class PageRecording {
  #asked = 0;

  constructor(file, isMicrophone = false) {
    lastKey += 1;
    this.key = lastKey;
    this.file = file;
    this.isMicrophone = isMicrophone;
    // What the library said: the report, and beside it pictures and texts; or why it could not.
    this.report = null;
    this.answer = null;
    this.problem = null;
    // The impacts of each drop, and those before each edit.
    this.marks = [];
    this.past = [];
    this.isEdited = false;
  }

  // Asks the library; false where a later question overtook this one.
  async measure(engine, wanted) {
    this.#asked += 1;
    const asked = this.#asked;
    const labels = this.isEdited ? labelTrack(this.marks) : null;
    try {
      const answer = await engine.ask("measure", { key: this.key, file: this.file, asked: wanted, labels });
      if (asked !== this.#asked) return false;
      this.answer = answer;
      this.report = JSON.parse(answer.document);
      this.problem = null;
      if (!this.isEdited) this.marks = marksOf(this.report);
    } catch (error) {
      if (asked !== this.#asked) return false;
      this.problem = error;
    }
    return true;
  }

  // Takes other impacts for one drop; `isStep` makes a step that can be undone.
  edit(drop, marks, isStep = true) {
    if (isStep) this.past.push({ marks: this.marks, isEdited: this.isEdited });
    this.marks = this.marks.length === 0 ? [marks] : this.marks.map((one, i) => (i === drop ? marks : one));
    this.isEdited = true;
  }

  undo() {
    Object.assign(this, this.past.pop());
  }

  reset() {
    this.past = [];
    this.isEdited = false;
  }
}
