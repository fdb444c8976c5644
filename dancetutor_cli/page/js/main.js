// Begins everything: unpacks the data, makes the page's elements, and draws as long as it is open.

import { alongPanel } from "./along.js";
import { App } from "./app.js";
import { authorPanel } from "./author.js";
import { fromBase64, unpack } from "./blob.js";
import { actionsOf, listenToKeys, makeBar } from "./controls.js";
import { el } from "./dom.js";
import { Highway } from "./highway.js";
import { findingsPanel, passagesPanel, settingsPanel } from "./panels.js";
import { CAMERAS, Picture, decodeSkins } from "./picture.js";
import { Timeline } from "./timeline.js";

/** @param {string} id */
const text = (id) => document.getElementById(id)?.textContent ?? "";

/** @param {import("./app.js").App} app @param {import("./controls.js").Action[]} actions */
function helpSheet(app, actions) {
  const { t } = app;
  const rows = actions.map((action) => el("tr", {}, el("th", { scope: "row" }, ...action.keys.flatMap((key) => [el("kbd", {}, keyText(app, key)), " "])),
    el("td", {}, t(action.name))));
  const dialog = el("dialog", { class: "sheet", "aria-label": t("helpSheet") },
    el("button", { type: "button", onclick: () => dialog.close() }, t("close")), el("h2", {}, t("helpSheet")),
    el("p", {}, t("helpIntro")), el("table", {}, el("tbody", {}, ...rows)), el("p", {}, t("helpMouse")));
  dialog.addEventListener("keydown", (event) => { if (event.key === "?") dialog.close(); });
  document.body.append(dialog);
  return dialog;
}

/** @param {import("./app.js").App} app @param {string} key */
function keyText(app, key) {
  const names = { " ": app.t("space"), ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓" };
  return key.split(/(?<=Shift)\+/).map((part) => names[/** @type {keyof typeof names} */ (part)] ?? part).join(" ").replace("Shift", "⇧");
}

/** Tabs of the panels. @param {import("./app.js").App} app @param {[string, HTMLElement][]} panels */
function makeTabs(app, panels) {
  const tabs = panels.map(([name], k) => el("button", {
    type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}`, "aria-selected": k === 0, tabindex: k === 0 ? 0 : -1,
    onclick: () => choose(name),
  }, app.t(`tab-${name}`)));
  const bodies = panels.map(([name, body], k) => el("div", { role: "tabpanel", id: `panel-${name}`, "aria-labelledby": `tab-${name}`, hidden: k !== 0, class: "panel", tabindex: 0 }, body));
  /** @param {string} name */
  function choose(name) {
    panels.forEach(([other], k) => {
      tabs[k].setAttribute("aria-selected", String(other === name));
      tabs[k].tabIndex = other === name ? 0 : -1;
      bodies[k].hidden = other !== name;
    });
  }
  const row = el("div", { role: "tablist", class: "tabs", "aria-label": app.t("panels") }, ...tabs);
  row.addEventListener("keydown", (event) => {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (!by) return;
    const k = (tabs.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement)) + by + tabs.length) % tabs.length;
    choose(panels[k][0]);
    tabs[k].focus();
  });
  return { side: el("aside", { class: "side" }, row, ...bodies), choose };
}

/** Buttons of the cameras over the picture. @param {import("./app.js").App} app */
function cameraButtons(app) {
  const { t, settings } = app;
  const buttons = CAMERAS.map((name) => el("button", { type: "button", class: "toggle", title: t(`camera-${name}-long`), onclick: () => app.setCamera(name) }, t(`camera-${name}`)));
  const both = app.motions.length > 1
    ? el("button", { type: "button", class: "toggle", title: app.besideText(), onclick: () => { app.both = !app.both; app.tell("settings"); } }, t("both")) : null;
  const show = () => {
    buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(CAMERAS[k] === settings.camera)));
    document.querySelector(".picture")?.classList.toggle("free", settings.camera === "free");
    both?.setAttribute("aria-pressed", String(app.both));
  };
  app.listeners.add((what) => { if (what === "settings") show(); });
  show();
  return el("div", { class: "cameras", role: "group", "aria-label": t("camera") }, ...buttons, both);
}

async function main() {
  const { doc, arrays } = await unpack(text("data"));
  performance.mark("unpacked");
  const skins = decodeSkins(doc, arrays); // goes on while the page is laid out
  const app = new App(doc, arrays);
  const { t } = app;
  document.documentElement.lang = app.language;
  const stage = el("section", { class: "picture", "aria-label": t("picture") });
  const lanes = el("canvas", { class: "lanes", role: "img", "aria-label": t("notes") });
  const strip = el("canvas", {
    class: "strip", role: "slider", tabindex: 0, "aria-label": t("timeline"), "aria-valuemin": app.start.toFixed(1),
    "aria-valuemax": app.end.toFixed(1), "aria-valuenow": "0",
  });
  /** @type {HTMLDialogElement} */
  let sheet;
  const tabs = makeTabs(app, [["passages", passagesPanel(app)], ["along", alongPanel(app)], ["findings", findingsPanel(app)],
    ["author", authorPanel(app)], ["settings", settingsPanel(app, loadFile)]]);
  const ui = { help: () => sheet.showModal(), tab: tabs.choose };
  const actions = actionsOf(app, ui);
  sheet = helpSheet(app, actions);
  const { words } = doc;
  const badge = el("span", { class: "badge" }, words.badge);
  badge.style.borderColor = doc.style.difficulty[words.difficulty] ?? "#b9bdc9";
  const said = el("p", { class: "said", role: "status" });
  const root = /** @type {HTMLElement} */ (document.getElementById("app"));
  root.replaceChildren(
    el("header", {}, el("h1", {}, words.title), badge,
      el("p", {}, [words.artist, words.steps, `${words.bpm} BPM`, words.credit && t("stepsBy", { name: words.credit })].filter(Boolean).join(" · "))),
    el("main", { class: app.chart.columns > 5 ? "wide" : "" }, stage, el("section", { class: "notes", "aria-label": t("notes") }, lanes), tabs.side),
    el("footer", {}, strip, makeBar(app, ui)));
  stage.append(cameraButtons(app), said);
  app.highway = new Highway(lanes, doc, app.chart);
  app.picture = new Picture(stage, doc, app.chart, app.motions, app.settings);
  app.picture.amend = (second, pose) => app.redance.amend(second, pose);
  app.picture.onTurn = () => app.save();
  performance.mark("laid out");
  app.picture.start(arrays, await skins);
  performance.mark("picture");
  const timeline = new Timeline(strip, doc, app.chart, {
    start: app.start, end: app.end, seek: (second) => app.seek(second), loop: (a, b) => app.setLoop(a, b),
  });
  lanes.addEventListener("pointerdown", (event) => { // a lane is a panel for whoever plays along by touch
    const column = app.highway?.columnAt(event.clientX - lanes.getBoundingClientRect().left, app.mirrored) ?? -1;
    if (!app.along || column < 0) return;
    event.preventDefault();
    app.input.press(column, "touch", event.timeStamp);
    lanes.addEventListener("pointerup", () => app.input.release(column), { once: true });
  });
  lanes.addEventListener("click", (event) => {
    if (app.along) return;
    const box = lanes.getBoundingClientRect();
    app.chosen = app.highway?.noteAt(event.clientX - box.left, event.clientY - box.top, app.highwayScene(app.second())) ?? -1;
    if (app.chosen >= 0) { app.transport.pause(); tabs.choose("author"); }
    app.tell("feet");
  });
  listenToKeys(app, actions);
  takeDrops();
  app.listeners.add((what) => { // beside each other or below: a loop that begins is seen
    if (what === "loop" && app.passage >= 0 && stage.getBoundingClientRect().top < 0) root.scrollIntoView();
  });
  app.listeners.add((what) => { if (what === "frame") said.textContent = app.said(); });
  window.addEventListener("resize", () => { app.fresh = true; });
  window.addEventListener("hashchange", () => app.readLink(location.hash));
  if (location.hash) app.readLink(location.hash);
  else app.seek(Math.max(app.start, app.chart.first - 2));
  app.tell("settings");
  const frame = () => {
    app.frame(timeline);
    requestAnimationFrame(frame);
  };
  frame();
  document.documentElement.dataset.ready = performance.now().toFixed(0);
  if (text("music").length > 0) await loadMusic(/** @type {ArrayBuffer} */ (fromBase64(text("music")).buffer));

  /** @param {ArrayBuffer} data */
  async function loadMusic(data) {
    try {
      await app.sound.load(data);
    } catch {
      app.message = t("musicBad");
      return app.tell("music");
    }
    app.message = "";
    app.tell("music");
    app.tell("settings");
    if (app.transport.playing) app.seek(app.transport.second());
  }

  /** @param {File} file */
  async function loadFile(file) {
    await loadMusic(await file.arrayBuffer());
  }

  function takeDrops() {
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file) void loadFile(file);
    });
  }
}

void main();
