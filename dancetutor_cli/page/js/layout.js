// The page's elements: header, tabs of the panels, camera buttons, help sheet. All that holds words is made here.

import { alongPanel } from "./along.js";
import { authorPanel, noteText } from "./author.js";
import { makeBar, makeZoom } from "./controls.js";
import { el } from "./dom.js";
import { findingsPanel, passagesPanel, settingsPanel } from "./panels.js";
import { resultsPanel } from "./results.js";
import { CAMERAS, FIRST_VIEW } from "./settings.js";
import { chips, resultCard, slimStanding, standing } from "./scores.js";
import { secondCaption, secondText, countOf, musicText, passedOf, quiet, statusText } from "./status_text.js";

/**
 * @typedef {object} Canvases what is drawn on; it stays when the words change
 * @property {HTMLElement} stage
 * @property {HTMLCanvasElement} lanes
 * @property {HTMLCanvasElement} strip
 */

/**
 * @typedef {object} Ui what the parts of the page ask of each other
 * @property {(by: number) => void} zoom the strip, nearer or farther
 * @property {() => void} help opens the help sheet
 * @property {(name: string) => void} tab opens a tab
 * @property {() => boolean} fewer closes "more controls", which on a phone lie over the panels; whether they were open
 * @property {() => void} fold folds the panels of a phone away: who plays looks at the notes
 */

/**
 * Make the page, or make it anew in another language.
 * @param {import("./app.js").App} app @param {Canvases} canvases @param {Ui} ui what keys do here; is filled in
 * @param {{actions: import("./controls.js").Action[], load: (file: File) => Promise<void>}} about
 */
export function layOut(app, { stage, lanes, strip }, ui, { actions, load }) {
  const { t, doc: { words, style } } = app;
  const open = document.querySelector("[role=tab][aria-selected=true]")?.id.slice(4);
  app.listeners.clear();
  document.documentElement.lang = app.language;
  for (const old of document.querySelectorAll("dialog")) old.remove();
  for (const [element, name] of /** @type {[HTMLElement, string][]} */ ([[stage, "picture"], [lanes, "notesKeys"], [strip, "timeline"]])) {
    element.setAttribute("aria-label", t(name));
  }
  const tabs = makeTabs(app, ui, [
    ["passages", passagesPanel(app)],
    ["along", alongPanel(app)],
    ["results", resultsPanel(app)],
    ...(app.doc.findings.length ? [/** @type {[string, HTMLElement]} */ (["findings", findingsPanel(app)])] : []),
    ["author", authorPanel(app)],
    ["settings", settingsPanel(app, load)],
  ]);
  const sheet = helpSheet(app, actions);
  ui.help = () => sheet.showModal();
  ui.tab = tabs.choose;
  ui.fold = tabs.fold;
  let [played, along] = [app.transport.playing, app.practice.along];
  const badge = el("span", { class: "badge" }, words.badge);
  badge.style.borderColor = style.difficulty[words.difficulty] ?? "#b9bdc9";
  const about = [words.artist, words.steps, `${words.bpm} BPM`, words.credit && t("stepsBy", { name: words.credit })];
  const message = el("p", { class: "message", role: "status" });
  const pick = el("button", { type: "button", class: "pick", onclick: () => document.getElementById("music-file")?.click() },
    "♪ ", el("span", {}, t("pickMusic", { name: words.music || t("pickFile") })));
  pick.setAttribute("aria-label", pick.textContent ?? "");
  const captions = [[t("theseFeet"), ""], secondCaption(app)].map(([who, rows], k) =>
    el("p", { class: `caption ${k ? "right" : "left"}` }, who, el("span", {}, rows && ` (${rows})`)));
  const count = el("p", { class: "count", "aria-hidden": "true" }); // it is heard too
  const passed = el("p", { class: "passed unseen", role: "status" }); // it is drawn above the receptors
  for (const old of stage.querySelectorAll(":scope > :not(canvas)")) old.remove();
  stage.append(cameraButtons(app), count, ...captions, el("div", { class: "scores" }, standing(app)), passed, resultCard(app));
  const flat = el("p", { class: "flat", hidden: true }, t("noWebgl"));
  stage.append(flat);
  const note = el("p", { class: "unseen", role: "status" });
  app.listeners.add((what) => { if (what === "feet") note.textContent = app.chosen >= 0 ? noteText(app, app.chosen) : ""; });
  const root = /** @type {HTMLElement} */ (document.getElementById("app"));
  const main = el(
    "main",
    { class: app.chart.columns > 5 ? "wide" : "" },
    stage,
    el("section", { class: "notes", "aria-label": t("notes") }, lanes, slimStanding(app), note),
    chips(app),
    tabs.side,
  );
  root.replaceChildren(
    el("header", {}, el("div", { class: "song" }, el("h1", {}, words.title), badge, app.doc.pair ? players(style) : null,
      el("p", { class: "about" }, about.filter(Boolean).join(" · "))), message, pick),
    main, el("footer", {}, el("div", { class: "place-in-song" }, strip, makeZoom(app, ui)), makeBar(app, ui)));
  if (open) tabs.choose(open);
  app.highway?.speak(t);
  app.listeners.add((what) => {
    if (what !== "frame") {
      if ((app.transport.playing && !played) || (app.practice.along && !along)) ui.fold();
      [played, along] = [app.transport.playing, app.practice.along];
      return;
    }
    message.textContent = message.title = statusText(app);
    message.classList.toggle("quiet", quiet(app));
    // On a phone that has a place of its own; what passes lies on the picture.
    const lasts = app.transport.loop !== null || app.practice.wait;
    message.classList.toggle("lasts", lasts);
    message.classList.toggle("brief", !lasts && (app.notice !== "" || app.practice.unknownKey === "now" || app.practice.over !== null));
    message.classList.toggle("shown", app.practice.along && app.practice.over !== null && !app.notice); // the card shows it
    count.textContent = countOf(app);
    const now = passedOf(app);
    if (passed.textContent !== now) passed.textContent = now;
    pick.hidden = app.sound.music !== null || app.musicLoading;
    pick.title = musicText(app);
    pick.classList.toggle("small", app.played); // on a phone only its sign is left then
    flat.hidden = !app.picture || app.picture.viewer !== null;
    for (const caption of captions) caption.hidden = !app.both;
    main.classList.toggle("along", app.practice.along);
    main.classList.toggle("looped", app.transport.loop !== null);
  });
}

/** Which colour is whose, in a chart for two. @param {import("./doc.js").Style} style */
function players(style) {
  return el("p", { class: "players" }, ...style.players.map((/** @type {string} */ colour, /** @type {number} */ k) => {
    const one = el("span", {}, `● P${k + 1} `);
    one.style.color = colour;
    return one;
  }));
}

/** @param {import("./app.js").App} app @param {import("./controls.js").Action[]} actions */
function helpSheet(app, actions) {
  const { t } = app;
  const rows = actions.map((action) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, ...action.keys.flatMap((key) => [el("kbd", {}, keyText(app, key)), " "])),
      el("td", {}, t(action.name)),
    ),
  );
  const keys = [el("p", {}, t("helpIntro")), el("table", {}, el("tbody", {}, ...rows))];
  const hands = [el("h3", {}, t("helpTouchTitle")), ...t("helpTouch").split("\n").map((line) => el("p", {}, line))];
  const mouse = el("p", {}, t("helpMouse"));
  const dialog = el("dialog", { class: "sheet", "aria-label": t("helpSheet") },
    el("button", { type: "button", onclick: () => dialog.close() }, t("close")), el("h2", {}, t("helpSheet")),
    ...(app.input.keyless ? [...hands, el("details", {}, el("summary", {}, t("helpKeys")), mouse, ...keys)] : [...keys, ...hands, mouse]));
  dialog.addEventListener("keydown", (event) => { if (event.key === "?") dialog.close(); });
  document.body.append(dialog);
  return dialog;
}

/** @param {import("./app.js").App} app @param {string} key */
function keyText(app, key) {
  const named = ["PageUp", "PageDown", "Home", "End", "Escape"].map((name) => [name, app.t(`key-${name}`)]);
  const names = { " ": app.t("space"), ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓", ...Object.fromEntries(named) };
  return key.split(/(?<=Shift)\+/).map((part) => names[/** @type {keyof typeof names} */ (part)] ?? part).join(" ").replace("Shift", "⇧");
}

/** Tabs of the panels. @param {import("./app.js").App} app @param {Ui} ui @param {[string, HTMLElement][]} panels */
function makeTabs(app, ui, panels) {
  const tabs = panels.map(([name], k) => el("button", {
    type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}`, "aria-selected": k === 0, tabindex: k === 0 ? 0 : -1,
    onclick: () => press(name),
    ...(name === "settings" ? { "aria-label": app.t("tab-settings"), title: app.t("tab-settings") } : {}),
  }, name === "settings" ? "⚙\ufe0e" : app.t(`tab-${name}`)));
  let open = panels[0][0];
  const bodies = panels.map(([name, body], k) =>
    el(
      "div",
      { role: "tabpanel", id: `panel-${name}`, "aria-labelledby": `tab-${name}`, hidden: k !== 0, class: "panel", tabindex: 0 },
      body,
    ),
  );
  /** @param {string} name */
  function choose(name) {
    ui.fewer();
    side.classList.remove("folded");
    open = name;
    findUse();
    panels.forEach(([other], k) => {
      tabs[k].setAttribute("aria-selected", String(other === name));
      tabs[k].tabIndex = other === name ? 0 : -1;
      bodies[k].hidden = other !== name;
    });
  }
  /** Authors' tab is there once there is anything in it. */
  function findUse() {
    const author = panels.findIndex(([name]) => name === "author");
    tabs[author].hidden = open !== "author" && app.chosen < 0 && !app.redance.changedRows().length;
  }
  /** On a phone the tab that is open folds its panel away, for a larger picture. @param {string} name */
  function press(name) {
    const again = tabs[panels.findIndex(([other]) => other === name)].getAttribute("aria-selected") === "true";
    const fold = !ui.fewer() && again && !side.classList.contains("folded");
    choose(name);
    side.classList.toggle("folded", fold);
    app.fresh = true;
  }
  /** A phone has no room for both; a page at 400 % (a small one that lies across) scrolls instead. */
  function fold() {
    if (!matchMedia("(max-width: 860px) and (orientation: portrait), (min-width: 561px) and (max-width: 860px)").matches) return;
    ui.fewer();
    side.classList.add("folded");
  }
  const row = el("div", { role: "tablist", class: "tabs", "aria-label": app.t("panels") }, ...tabs);
  row.addEventListener("keydown", (event) => {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (!by) return;
    const seen = tabs.filter((tab) => !tab.hidden);
    const next = seen[(seen.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement)) + by + seen.length) % seen.length];
    choose(next.id.slice(4));
    next.focus();
  });
  app.listeners.add((what) => { if (what === "feet") findUse(); });
  findUse();
  const side = el("aside", { class: "side" }, row, ...bodies);
  return { side, choose, fold };
}

/** Buttons of the cameras over the picture. @param {import("./app.js").App} app */
function cameraButtons(app) {
  const { t, settings } = app;
  const buttons = CAMERAS.map((name, k) =>
    el(
      "button",
      {
        type: "button",
        class: "toggle camera",
        title: t(`camera-${name}-long`),
        onclick: () => {
          // on a phone only the chosen one is there: a tap goes on to the next
          const alone = buttons.filter((button) => button.offsetParent !== null).length === 1;
          const turned = Object.entries(FIRST_VIEW).some(([what, value]) => settings[/** @type {"yaw"} */ (what)] !== value);
          if (name === "free" && settings.camera === "free" && (turned || !alone)) return app.resetView();
          app.setCamera(CAMERAS[alone ? (k + 1) % CAMERAS.length : k]);
        },
      },
      t(`camera-${name}`),
    ),
  );
  const both =
    app.motions.length > 1 && !app.doc.pair
      ? el(
          "button",
          {
            type: "button",
            class: "toggle",
            title: secondText(app),
            onclick: () => {
              app.both = !app.both;
              app.tell("settings");
            },
          },
          t("both"),
        )
      : null;
  const row = el("div", { class: "cameras", role: "group", "aria-label": t("camera") }, ...buttons, both);
  const show = () => {
    buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(CAMERAS[k] === settings.camera)));
    row.parentElement?.classList.toggle("free", settings.camera === "free");
    both?.setAttribute("aria-pressed", String(app.both));
  };
  app.listeners.add((what) => { if (what === "settings") show(); });
  show();
  return row;
}
