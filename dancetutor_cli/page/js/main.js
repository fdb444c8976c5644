// Begins everything: unpacks the data, makes the page's elements, and draws as long as it is open.

import { App } from "./app.js";
import { fromBase64, unpack } from "./blob.js";
import { actionsOf, listenToKeys } from "./controls.js";
import { el } from "./dom.js";
import { showStartError } from "./start_error.js";
import { meshData } from "./gl.js";
import { Highway } from "./highway.js";
import { layOut } from "./layout.js";
import { readLink } from "./places.js";
import { Picture, decodeSkins } from "./picture.js";
import { musicText } from "./status_text.js";
import { Timeline } from "./timeline.js";

/** @param {string} id */
const text = (id) => document.getElementById(id)?.textContent ?? "";

async function main() {
  const { doc, arrays } = await unpack(text("data"));
  const skins = decodeSkins(doc, arrays); // goes on wherever this gives way
  await pause();
  const app = new App(doc, arrays);
  app.musicLoading = text("music").length > 0;
  const stage = el("section", { class: "picture" });
  const lanes = el("canvas", { class: "lanes", role: "application", tabindex: 0 });
  const strip = el("canvas", {
    class: "strip",
    role: "slider",
    tabindex: 0,
    "aria-valuemin": app.start.toFixed(1),
    "aria-valuemax": app.end.toFixed(1),
    "aria-valuenow": "0",
  });
  const ui = {
    zoom: (/** @type {number} */ _by) => {},
    help: () => {},
    tab: (/** @type {string} */ _name) => {},
    fewer: () => false,
    fold: () => {},
  };
  const actions = actionsOf(app, ui);
  const show = () => layOut(app, { stage, lanes, strip }, ui, { actions, load: loadFile });
  app.onLanguage = () => {
    show();
    document.getElementById("language")?.focus(); // where whoever changed it was
  };
  show();
  await pause();
  app.highway = new Highway(lanes, doc, app.chart, app.t);
  const timeline = new Timeline(strip, doc, app.chart, {
    start: app.start,
    end: app.end,
    seek: (second) => app.seek(second),
    loop: (a, b) => app.setLoop(a, b),
    changed: () => {
      app.fresh = true;
    },
  });
  ui.zoom = (by) => timeline.zoom(by);
  listenToLanes(app, lanes, ui);
  listenToKeys(app, actions);
  takeDrops(loadFile);
  for (const name of ["gamepadconnected", "gamepaddisconnected"]) window.addEventListener(name, () => app.tell("pads"));
  window.addEventListener("resize", () => { app.fresh = true; });
  window.addEventListener("pagehide", () => app.practice.recordOutcomes());
  window.addEventListener("hashchange", () => readLink(app, location.hash));
  if (location.hash) readLink(app, location.hash);
  else app.rewind();
  app.tell("settings");
  const picture = new Picture(stage, doc, app.chart, app.motions, app.settings);
  picture.amend = (second, pose) => app.redance.amend(second, pose);
  picture.onTurn = () => app.save();
  const mesh = meshData(doc.body, arrays);
  picture.start(mesh, await skins);
  app.picture = picture;
  app.fresh = true;
  const frame = () => {
    app.frame(timeline);
    requestAnimationFrame(frame);
  };
  frame();
  app.input.watch();
  document.documentElement.dataset.ready = performance.now().toFixed(0);
  if (app.musicLoading) await loadMusic(/** @type {ArrayBuffer} */ (fromBase64(text("music")).buffer));

  /** @param {ArrayBuffer} data @param {string} [name] the file's */
  async function loadMusic(data, name = "") {
    try {
      await app.sound.load(data);
    } catch {
      app.musicLoading = false;
      app.musicBad = name || doc.words.music;
      app.notice = musicText(app);
      return app.tell("music");
    }
    app.musicName = name;
    app.musicBad = "";
    app.musicLoading = false;
    app.notice = "";
    app.tell("music");
    app.tell("settings");
    if (app.transport.playing) app.transport.seek(app.transport.second()); // it is heard from here; whoever plays goes on
  }

  /** @param {File} file */
  async function loadFile(file) {
    await loadMusic(await file.arrayBuffer(), file.name);
  }
}

/** Let the browser do what waits for this thread: it paints the page, and hands the textures on. */
const pause = () => new Promise((done) => setTimeout(done));

/**
 * A lane is a panel for whoever plays along by touch; else a click chooses the note, and arrow keys go from note to note.
 * @param {App} app @param {HTMLCanvasElement} lanes @param {import("./layout.js").Ui} ui
 */
function listenToLanes(app, lanes, ui) {
  /** @type {Map<number, number>} the lane that each finger is on */
  const fingers = new Map();
  lanes.addEventListener("pointerdown", (event) => {
    if (!app.practice.along || !app.highway) return;
    const column = app.highway.columnAt(event.clientX - lanes.getBoundingClientRect().left, app.mirrored);
    event.preventDefault();
    fingers.set(event.pointerId, column);
    lanes.setPointerCapture(event.pointerId); // wherever it is lifted, it is told here
    app.input.press(column, "touch", event.timeStamp);
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
    lanes.addEventListener(name, (event) => {
      const column = fingers.get(event.pointerId);
      if (column === undefined) return;
      fingers.delete(event.pointerId);
      if (![...fingers.values()].includes(column)) app.input.release(column);
    });
  }
  lanes.addEventListener("click", (event) => {
    if (app.practice.along) return;
    const finger = app.transport.playing && /** @type {PointerEvent} */ (event).pointerType === "touch";
    // Means to play, not to choose a note.
    if (finger || document.querySelector("#tab-along[aria-selected=true]")) return app.practice.idle();
    const box = lanes.getBoundingClientRect();
    const note = app.highway?.noteAt(event.clientX - box.left, event.clientY - box.top, app.highwayScene(app.second())) ?? -1;
    if (note >= 0) {
      app.transport.pause();
      ui.tab("author");
    }
    app.choose(note);
  });
  const notes = app.chart.rows.flatMap((row) => row.steps.map((step) => step.note)).filter((note) => note >= 0);
  lanes.addEventListener("keydown", (event) => {
    if (app.practice.along || !notes.length || event.shiftKey || event.ctrlKey || event.metaKey || event.altKey) return;
    const last = notes.length - 1;
    const meant = app.meant();
    const at = notes.indexOf(meant);
    const stands = meant === app.chosen; // else the first arrow only chooses the note of the row that is seen
    const to = /** @type {Record<string, number>} */ ({
      ArrowRight: stands ? at + 1 : Math.max(at, 0),
      ArrowLeft: stands ? at - 1 : at,
      Home: 0,
      End: last,
    })[event.key];
    if (event.key === "Enter" && app.chosen >= 0) ui.tab("author");
    else if (to !== undefined) app.goTo(notes[Math.min(Math.max(to, 0), last)]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
}

/** Music dropped anywhere on the page. @param {(file: File) => Promise<void>} load */
function takeDrops(load) {
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) void load(file);
  });
}

main().catch((error) => {
  if (!document.documentElement.dataset.ready) showStartError(error);
  console.error(error);
});
