// The page: recordings come in, are measured, shown, and edited.

import { showClass } from "./class.js";
import { element, say } from "./dom.js";
import { Editor } from "./editor.js";
import { Engine, Trapped } from "./engine.js";
import { remember, watchHistory } from "./history.js";
import { LivePanel } from "./live.js";
import { inOrder, moved, setByHand, toggled } from "./marks.js";
import { PageRecording } from "./recording.js";
import { showResult } from "./result.js";
import { save, stem } from "./save.js";
import { asked, offerChannels, offerRules, watchSettings } from "./settings.js";

const engine = new Engine();
const recordings = [];
let shown = null;
let place = 0;
let wanted = "{}";

function nameProblem(recording) {
  const { problem, file } = recording;
  if (problem instanceof Trapped) {
    recording.problem = new Error(`The decoder failed on ${file.name}, which may be damaged. Others can be opened`);
  }
}

function showTable() {
  showClass(recordings, shown, { show, remove: removeRecording });
}

// The channels that can be chosen are those of the recording that has most.
function showChannels(isNew) {
  offerChannels(Math.max(0, ...recordings.map((one) => one.report?.recording.channels ?? 0)), isNew);
  wanted = asked() ?? wanted;
}

function showButtons() {
  const isChosen = editor.chosen !== null;
  element("remove").disabled = element("toggle").disabled = !isChosen;
  element("undo").disabled = shown.past.length === 0;
  element("reset").disabled = !shown.isEdited;
}

function showAnswer() {
  showTable();
  showResult(shown, place, (drop) => show(shown, drop));
  showButtons();
}

function show(recording, drop) {
  shown = recording;
  place = drop;
  if (!recording.report && !recording.problem) return;
  showAnswer();
  if (recording.answer) editor.open(recording.answer, recording.marks[place] ?? []);
}

async function measure(recording) {
  const isLast = await recording.measure(engine, wanted);
  nameProblem(recording);
  return isLast;
}

// Shows what is shown once more, after it was measured again: there may be fewer drops.
function showAgain() {
  place = Math.min(place, Math.max(0, (shown.report?.drops.length ?? 1) - 1));
  if (!editor.dragging && shown.answer) editor.set(shown.marks[place] ?? []);
  showAnswer();
}

let isFollowing = false;
let isBehind = false;

// Measures again what is shown, after an edit; of edits that come meanwhile only the last is measured.
async function follow() {
  isBehind = true;
  if (isFollowing) return;
  isFollowing = true;
  while (isBehind) {
    isBehind = false;
    const recording = shown;
    if ((await measure(recording)) && recording === shown) showAgain();
  }
  isFollowing = false;
}

function edit(marks, isStep = true) {
  shown.edit(place, marks, isStep);
  if (!editor.dragging) editor.set(shown.marks[place]);
  showButtons();
  follow();
}

const ours = () => shown.marks[place] ?? [];
let isMoving = false;

const editor = new Editor({
  move: (id, timeS, isDone) => {
    edit(moved(ours(), id, timeS), !isMoving);
    isMoving = !isDone;
  },
  add: (timeS) => {
    const one = setByHand(timeS);
    edit(inOrder([...ours(), one]));
    editor.choose(one.id);
  },
  remove: (id) => edit(ours().filter((one) => one.id !== id)),
  toggle: (id) => edit(toggled(ours(), id)),
  chose: () => showButtons(),
});

function stepBack(back) {
  back();
  follow();
}

function watchEditor() {
  const buttons = {
    "zoom-in": () => editor.zoom(0.5),
    "zoom-out": () => editor.zoom(2),
    earlier: () => editor.pan(-0.4),
    later: () => editor.pan(0.4),
    add: () => {
      const one = setByHand(editor.middleS);
      edit(inOrder([...ours(), one]));
      document.querySelector(`[data-id="${one.id}"]`)?.focus();
    },
    toggle: () => edit(toggled(ours(), editor.chosen)),
    remove: () => edit(ours().filter((one) => one.id !== editor.chosen)),
    undo: () => stepBack(() => shown.undo()),
    reset: () => stepBack(() => shown.reset()),
  };
  for (const [id, act] of Object.entries(buttons)) element(id).addEventListener("click", act);
}

function watchSaving() {
  const name = (ending) => `${stem(shown.file.name)}${ending}`;
  const files = {
    json: () => save(name(".json"), shown.answer.document, "application/json"),
    csv: () => save(name(".csv"), shown.answer.csv, "text/csv"),
    labels: () => save(name(".txt"), shown.answer.labels, "text/plain"),
    svg: () => save(name(".svg"), shown.answer.sheets[place], "image/svg+xml"),
    text: () => save(name(".report.txt"), shown.answer.text, "text/plain"),
    wav: () => save(shown.file.name, shown.file),
  };
  for (const [kind, act] of Object.entries(files)) element(`save-${kind}`).addEventListener("click", act);
}

function removeRecording(recording) {
  recordings.splice(recordings.indexOf(recording), 1);
  engine.ask("close", { key: recording.key });
  if (recording === shown) show(recordings[0], 0);
  else showTable();
}

// Files are one group: those of before give way.
async function open(files, isMicrophone = false) {
  if (files.length === 0) return;
  element("how").open = false;
  if (!isMicrophone) recordings.splice(0);
  const added = files.map((file) => new PageRecording(file, isMicrophone));
  recordings.push(...added);
  showChannels(true);
  shown = added[0];
  place = 0;
  for (const [i, recording] of added.entries()) {
    say(`Measuring ${recording.file.name}${added.length > 1 ? ` (${i + 1} of ${added.length})` : ""}…`);
    await measure(recording);
    if (!recordings.includes(recording)) continue;
    if (recording.report) remember(recording.file.name, recording.report);
    showChannels(false);
    if (recording === shown) {
      show(recording, place);
      element("result").focus({ preventScroll: true });
      element("result").scrollIntoView({ block: "start", behavior: "instant" });
    } else showTable();
  }
  say("");
}

async function followSettings(typed) {
  wanted = typed;
  for (const recording of [...recordings]) {
    if ((await measure(recording)) && recordings.includes(recording)) {
      if (recording === shown) showAgain();
      else showTable();
    }
  }
}

function watchFiles() {
  const input = element("files");
  element("choose").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    open([...input.files]);
    input.value = "";
  });
  const zone = element("drop-zone");
  const over = (isOver) => zone.classList.toggle("over", isOver);
  addEventListener("dragover", (event) => {
    event.preventDefault();
    over(true);
  });
  addEventListener("dragleave", (event) => event.relatedTarget === null && over(false));
  addEventListener("drop", (event) => {
    event.preventDefault();
    over(false);
    open([...event.dataTransfer.files]);
  });
}

function keepForOffline() {
  if (location.protocol.startsWith("http")) navigator.serviceWorker?.register("offline.js");
}

async function begin() {
  showChannels(true);
  watchFiles();
  watchEditor();
  watchSaving();
  watchSettings(followSettings);
  watchHistory();
  new LivePanel(engine, (file) => open([file], true));
  element("choose").disabled = element("microphone").disabled = false;
  keepForOffline();
  // The library is there before it is needed, and knows the rules.
  offerRules(await engine.ask("rules"));
}

begin().catch((error) => say(`The page cannot start: ${error.message}`));
