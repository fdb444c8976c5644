// Loops that were kept under a name: a list, and a field to keep the one that there is.

import { el } from "./dom.js";
import { stretch } from "./places.js";

/** @param {import("./app.js").App} app */
export function loopsPart(app) {
  const { t, chart } = app;
  const name = el("input", { type: "text", id: "loop-name", maxlength: 60, autocomplete: "off", "aria-label": t("loopName"), placeholder: t("loopName") });
  const keep = el("button", { type: "submit", id: "loop-keep" }, t("loopKeep"));
  const form = el("form", { class: "group", onsubmit: (/** @type {Event} */ event) => {
    event.preventDefault();
    const { loop } = app.transport;
    if (!loop) return;
    const called = name.value.trim() || stretch(t, chart.beatAt(loop.a) / 4, chart.beatAt(loop.b) / 4);
    saveLoop(app, called);
    name.value = "";
    hint.textContent = t("loopKept", { name: called });
    list.lastElementChild?.scrollIntoView({ block: "nearest" });
  } }, name, keep);
  const list = el("ul", { class: "cards loops" });
  const hint = el("p", { class: "hint", role: "status" });
  const show = () => {
    form.hidden = keep.disabled = !app.transport.loop; // there is nothing to keep
    hint.textContent = app.transport.loop ? "" : t("loopFirst");
    list.replaceChildren(...app.record.loops.map((loop) => el("li", { class: "kept" },
      el("button", { type: "button", class: "card", onclick: () => void app.loopBeats(loop.from, loop.to, loop.rate / 100) },
        el("strong", {}, loop.name), el("span", { class: "figure" }, t("atSpeed", { rate: loop.rate })), el("span", { class: "text" }, stretch(t, loop.from / 4, loop.to / 4))),
      el("button", { type: "button", class: "sign", "aria-label": t("loopDrop", { name: loop.name }), title: t("loopDrop", { name: loop.name }), onclick: () => dropLoop(app, loop) }, "✕"))));
  };
  app.listeners.add((what) => { if (what === "loop" || what === "record") show(); });
  show();
  return el("section", {}, el("h3", {}, t("loopsTitle")), form, hint, list);
}

/** Keep the loop that there is under a name. @param {import("./app.js").App} app @param {string} name */
function saveLoop(app, name) {
  const { transport: { loop }, chart, practice, record } = app;
  if (!loop) return;
  const round = (/** @type {number} */ beat) => Math.round(1000 * beat) / 1000;
  const [from, to] = [loop.a, loop.b].map((second) => round(chart.beatAt(second)));
  record.loops = [...record.loops, { name: name.slice(0, 60), from, to, rate: Math.round(100 * practice.chosenRate) }].slice(-50);
  app.saveRecord();
}

/** @param {import("./app.js").App} app @param {import("./record.js").SavedLoop} loop */
function dropLoop(app, loop) {
  app.record.loops = app.record.loops.filter((one) => one !== loop);
  app.saveRecord();
}
