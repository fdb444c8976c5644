// The row of buttons under the picture, and the keys: one table says what each does, for buttons, keys and help alike.

import { el, toggle } from "./dom.js";
import { CAMERAS, FEET } from "./settings.js";

/**
 * @typedef {object} Action
 * @property {string} name of its label
 * @property {string[]} keys as `KeyboardEvent.key`, "Shift+" before it where it counts
 * @property {() => void} run
 */

/**
 * Everything that a key does.
 * @param {import("./app.js").App} app @param {import("./layout.js").Ui} ui @returns {Action[]}
 */
export function actionsOf(app, ui) {
  const { settings, input } = app;
  const rows = input.arrows.length ? [] : ["ArrowLeft", "ArrowRight"]; // a key that is a panel is nothing else
  return [
    { name: "playPause", keys: [" "], run: () => void app.play() },
    { name: "rowBack", keys: [",", ...rows.slice(0, 1)], run: () => app.step(-1) },
    { name: "rowOn", keys: [".", ...rows.slice(1)], run: () => app.step(1) },
    { name: "measureBack", keys: ["Shift+ArrowLeft", "PageUp"], run: () => app.stepMeasure(-1) },
    { name: "measureOn", keys: ["Shift+ArrowRight", "PageDown"], run: () => app.stepMeasure(1) },
    { name: "toStart", keys: ["Home"], run: () => app.seek(app.transport.loop ? app.transport.lead(app.transport.loop.a) : app.start) },
    { name: "toEnd", keys: ["End"], run: () => app.seek(app.chart.last) },
    { name: "faster", keys: ["+"], run: () => app.setRate(app.transport.rate + 0.05) },
    { name: "slower", keys: ["-"], run: () => app.setRate(app.transport.rate - 0.05) },
    { name: "loopA", keys: ["["], run: () => app.loopHere("a") },
    { name: "loopB", keys: ["]"], run: () => app.loopHere("b") },
    { name: "noLoop", keys: ["x", "Escape"], run: () => app.setLoop(null, null) },
    { name: "nextPassage", keys: ["n"], run: () => void app.loopPassage((app.passage + 1) % Math.max(app.doc.passages.length, 1)) },
    { name: "ramp", keys: ["r"], run: () => app.set("ramp", !settings.ramp) },
    { name: "countIn", keys: ["i"], run: () => app.set("countIn", !settings.countIn) },
    { name: "metronome", keys: ["m"], run: () => app.set("metronome", !settings.metronome) },
    { name: "claps", keys: ["h"], run: () => app.setClaps(!app.claps) },
    { name: "along", keys: ["p"], run: () => app.practice.setAlong(!app.practice.along) },
    { name: "wait", keys: ["w"], run: () => app.practice.setWait(!app.practice.wait) },
    { name: "foot", keys: ["t"], run: () => app.practice.setFoot(FEET[(FEET.indexOf(app.notes.foot) + 1) % FEET.length]) },
    { name: "coach", keys: ["c"], run: () => (app.practice.coach.on ? app.practice.coach.stop() : void app.practice.coach.start()) },
    { name: "feetHelp", keys: ["g"], run: () => app.nextHelp() },
    { name: "camera", keys: ["v"], run: () => app.setCamera(CAMERAS[(CAMERAS.indexOf(settings.camera) + 1) % CAMERAS.length]) },
    { name: "resetView", keys: ["0"], run: () => app.resetView() },
    { name: "turnLeft", keys: ["Shift+A"], run: () => turn(app, -10, 0) },
    { name: "turnRight", keys: ["Shift+D"], run: () => turn(app, 10, 0) },
    { name: "turnUp", keys: ["Shift+W"], run: () => turn(app, 0, 8) },
    { name: "turnDown", keys: ["Shift+S"], run: () => turn(app, 0, -8) },
    ...(app.motions.length > 1 && !app.doc.pair
      ? [
          {
            name: "both",
            keys: ["2"],
            run: () => {
              app.both = !app.both;
              app.tell("settings");
            },
          },
        ]
      : []),
    { name: "otherFoot", keys: ["o"], run: () => otherFoot(app, ui) },
    { name: "notesFaster", keys: [">"], run: () => app.set("speed", Math.min(settings.speed * 1.15, 4)) },
    { name: "notesSlower", keys: ["<"], run: () => app.set("speed", Math.max(settings.speed / 1.15, 0.3)) },
    { name: "zoomIn", keys: ["z"], run: () => ui.zoom(1) },
    { name: "zoomOut", keys: ["Shift+Z"], run: () => ui.zoom(-1) },
    { name: "helpSheet", keys: ["?"], run: () => ui.help() },
  ];
}

/** @param {import("./app.js").App} app @param {number} yaw @param {number} pitch */
function turn(app, yaw, pitch) {
  app.setCamera("free");
  app.picture?.turn(yaw, pitch);
  app.save();
}

/**
 * The note that is chosen, or of the row that stands, gets the other foot.
 * @param {import("./app.js").App} app @param {{tab: (name: string) => void}} ui
 */
function otherFoot(app, ui) {
  app.transport.pause();
  const note = app.meant();
  if (note >= 0) {
    app.choose(note);
    app.giveOther(note);
  }
  ui.tab("author");
}

/**
 * Answer to keys: panels first while somebody plays along, then the table.
 * @param {import("./app.js").App} app @param {Action[]} actions
 */
export function listenToKeys(app, actions) {
  const arrows = (/** @type {KeyboardEvent} */ event) => /^Arrow/.test(event.key) && !event.shiftKey;
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || (document.querySelector("dialog[open]") && !app.input.learning)) return;
    const target = /** @type {HTMLElement} */ (event.target);
    if (target.matches("input[type=text], input[type=number], select, textarea")) return;
    if ((app.practice.along || app.input.learning) && !event.shiftKey && app.input.key(event)) return event.preventDefault();
    if (target.matches("button, summary, a, input, [role=tab]") && [" ", "Enter"].includes(event.key)) return;
    if (target.matches("input[type=range], [role=tab]") && /^(Arrow|Home|End|Page)/.test(event.key)) return;
    if (target.matches("[role=slider]") && /^Arrow(Left|Right)$/.test(event.key) && !event.shiftKey) {
      // the strip, for who came to it with Tab
      event.preventDefault();
      return app.step(event.key === "ArrowLeft" ? -1 : 1);
    }
    // Whoever plays along looks for panels under the arrows: they neither seek nor change the speed then.
    if (app.practice.along && arrows(event)) {
      event.preventDefault();
      return app.practice.showKeys();
    }
    const name = event.shiftKey && (event.key.length > 1 || /[A-Z]/.test(event.key)) ? `Shift+${event.key}` : event.key;
    const action = actions.find((one) => one.keys.includes(name) || one.keys.includes(name.toLowerCase()));
    const panel = !app.practice.along && app.input.columnOf(event.code) >= 0;
    if (!action && panel) {
      event.preventDefault();
      return app.practice.idle();
    }
    if (!action) return event.key.length === 1 && app.practice.along ? app.practice.showKeys() : undefined;
    event.preventDefault();
    action.run();
  });
  // What the mouse has pressed gives the keys back: the space bar plays, and arrows are panels.
  document.addEventListener("click", (event) => {
    const button = /** @type {HTMLElement | null} */ (/** @type {HTMLElement} */ (event.target).closest("button, .strip"));
    if (event.detail > 0 && button && !button.closest("dialog")) button.blur();
  });
  document.addEventListener("keyup", (event) => app.input.keyUp(event));
  window.addEventListener("blur", () => app.input.releaseAll()); // what is let go elsewhere is not told here
}

/**
 * Buttons beside the strip that show less or more of the song.
 * @param {import("./app.js").App} app @param {import("./layout.js").Ui} ui
 */
export function makeZoom({ t }, ui) {
  return el("div", { class: "zoom" }, ...[["zoomIn", "+", 1, "z"], ["zoomOut", "−", -1, "⇧Z"]].map(([name, sign, by, key]) => el("button", {
    type: "button", "aria-label": t(String(name)), title: `${t(String(name))} (${key})`, onclick: () => ui.zoom(Number(by)),
  }, String(sign))));
}

/**
 * The bar of buttons.
 * @param {import("./app.js").App} app @param {import("./layout.js").Ui} ui
 */
export function makeBar(app, ui) {
  const { t, settings, transport } = app;
  const button = (/** @type {string} */ name, /** @type {string} */ sign, /** @type {() => void} */ run, key = "") =>
    el(
      "button",
      { type: "button", class: "sign", "aria-label": t(name), title: key ? `${t(name)} (${key})` : t(name), onclick: run },
      sign,
    );
  const play = button("playPause", "▶", () => void app.play(), t("space"));
  play.className = "sign play";
  const rate = el("input", { type: "range", min: 0.25, max: 2, step: 0.05, value: 1, "aria-label": t("speed"), class: "rate" });
  rate.addEventListener("input", () => app.setRate(Number(rate.value)));
  const rateText = el("output", { class: "rate-text" }, "100 %");
  const [whereMeasure, whereBeat, whereTime] = [el("span"), el("span", { class: "where-beat" }), el("span")];
  const where = el("output", { class: "where", "aria-label": t("position") }, whereMeasure, whereBeat, whereTime);
  const toggles = /** @type {[string, string, () => boolean, (on: boolean) => void][]} */ ([
    ["ramp", "r", () => settings.ramp, (on) => app.set("ramp", on)],
    ["countIn", "i", () => settings.countIn, (on) => app.set("countIn", on)],
    ["metronome", "m", () => settings.metronome, (on) => app.set("metronome", on)],
    ["claps", "h", () => app.claps, (on) => app.setClaps(on)],
  ]).map(([name, key, is, change]) => ({ is, button: toggle(t(name), is(), change, key) }));
  const clear = button("noLoop", "✕", () => app.setLoop(null, null), "x");
  const more = el(
    "button",
    { type: "button", class: "sign more", "aria-label": t("moreControls"), title: t("moreControls"), "aria-expanded": false },
    "⋯",
  );
  const unfold = (/** @type {boolean} */ open) => {
    more.setAttribute("aria-expanded", String(bar.classList.toggle("open", open)));
    app.fresh = true;
  };
  more.addEventListener("click", () => unfold(!bar.classList.contains("open")));
  ui.fewer = () => {
    const open = bar.classList.contains("open");
    if (open) unfold(false);
    return open;
  };
  const bar = el("div", { class: "bar", role: "toolbar", "aria-label": t("controls") },
    el("div", { class: "group" },
      button("measureBack", "«", () => app.stepMeasure(-1), "⇧←"), button("rowBack", "◂", () => app.step(-1), ","), play,
      button("rowOn", "▸", () => app.step(1), "."), button("measureOn", "»", () => app.stepMeasure(1), "⇧→")),
    el("div", { class: "group place" }, where),
    el(
      "div",
      { class: "group extra" },
      el("span", { class: "name", "aria-hidden": "true" }, t("speedName")),
      button("slower", "−", () => app.setRate(transport.rate - 0.05), "-"),
      rate,
      button("faster", "+", () => app.setRate(transport.rate + 0.05), "+"),
      rateText,
    ),
    el(
      "div",
      { class: "group extra" },
      el("span", { class: "name", "aria-hidden": "true" }, t("loopName-bar")),
      button("loopA", "A", () => app.loopHere("a"), "["),
      button("loopB", "B", () => app.loopHere("b"), "]"),
      clear,
    ),
    el("div", { class: "group extra" }, ...toggles.map((one) => one.button)),
    el("div", { class: "group last" }, more, button("helpSheet", "?", () => ui.help(), "?")));
  app.listeners.add((what) => {
    if (what === "frame") {
      const second = app.second();
      const exact = Math.max(0, Math.round(100 * app.chart.beatAt(second)) / 100);
      const beat = transport.playing && !transport.waiting ? Math.floor(exact) : exact; // what stands has a place between the beats too
      [whereMeasure.textContent, whereBeat.textContent, whereTime.textContent] = whereParts(
        t("where", { measure: Math.floor(beat / 4), beat: Math.round(100 * beat) / 100, time: clock(second) }),
      );
      play.textContent = transport.playing ? "❚❚" : "▶";
      return;
    }
    rate.value = String(transport.rate);
    rateText.textContent = `${Math.round(100 * transport.rate)} %`;
    more.textContent = transport.rate === 1 ? "⋯" : `${rateText.textContent} ⋯`; // on a phone the speed is behind it
    clear.disabled = !transport.loop;
    for (const one of toggles) one.button.setAttribute("aria-pressed", String(one.is()));
  });
  return bar;
}

/**
 * Measure, beat and time, each with what stands between them: a narrow window leaves the beat out.
 * @param {string} text
 */
function whereParts(text) {
  const [measure, beat, time] = text.split(" · ");
  return [measure, ` · ${beat}`, ` · ${time}`];
}

/** @param {number} second */
function clock(second) {
  const s = Math.max(0, second);
  return `${Math.floor(s / 60)}:${String(Math.floor(s % 60)).padStart(2, "0")}`;
}
