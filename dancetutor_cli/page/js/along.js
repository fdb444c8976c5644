// The panel of playing along: keys and pads, one foot, the amount of help, calibration, and results.

import { calibrateDialog } from "./calibrate.js";
import { el } from "./dom.js";
import { CONTROLS } from "./input.js";
import { GOOD, WINDOW } from "./judge.js";
import { panelName } from "./labels.js";
import { meanText, scoreText } from "./status_text.js";
import { FEET, HELPS } from "./settings.js";

/** @param {import("./app.js").App} app */
export function alongPanel(app) {
  const { t, settings } = app;
  const help = el("select", { id: "feet-help" }, ...HELPS.map((name) => el("option", { value: name }, t(`help-${name}`))));
  help.addEventListener("change", () => app.set("help", help.value));
  const foot = el("select", { id: "foot" }, ...FEET.map((name) => el("option", { value: name }, t(`foot-${name}`))));
  foot.addEventListener("change", () => app.practice.setFoot(foot.value));
  const score = el("p", { class: "score", role: "status" });
  const keys = el("p", { class: "keys" });
  const pads = el("p", { class: "hint", role: "status" });
  const assign = el("button", { type: "button", id: "assign", onclick: () => assignDialog(app, show) }, t("assign"));
  const calibrate = el("button", { type: "button", id: "calibrate", onclick: () => calibrateDialog(app) }, t("calibrate"));
  let listed = "";
  const show = () => {
    const names = app.input.listed();
    if (listed === (listed = JSON.stringify(names))) return;
    keys.replaceChildren(...app.doc.pad.names.map((/** @type {string} */ name, /** @type {number} */ k) =>
      el("span", {}, `${panelName(app.t, name)} `, ...names[k].flatMap((key) => [el("kbd", {}, key), " "]))));
  };
  const refresh = () => {
    show();
    help.value = settings.help;
    foot.value = app.notes.foot;
    const plugged = app.input.pads().map((pad) => pad.id.slice(0, 40));
    pads.textContent = plugged.length ? t("padIs", { name: plugged.join(", ") }) : t("noPad");
    const tally = app.practice.tally();
    score.textContent = app.practice.along ? `${scoreText(app, tally)} ${meanText(app, tally)}` : "";
  };
  app.listeners.add((what) => { if (what !== "frame") refresh(); });
  refresh();
  return el("div", {},
    el("p", { class: "hint" }, t("alongHint")),
    keys, pads, el("div", { class: "modes two" }, assign, calibrate),
    el("p", { class: "field whole" }, el("label", { for: "foot" }, t("foot")), foot),
    el("p", { class: "field whole" }, el("label", { for: "feet-help" }, t("feetHelp")), help), score,
    el("details", { class: "hint" }, el("summary", {}, t("judging")), el("p", {}, t("windows", { good: 1000 * GOOD, wide: 1000 * WINDOW })),
      ...t("padHint").split("\n").map((line) => el("p", {}, line))));
}

/**
 * Ask for a key or button for each panel in turn. Nothing changes if the user stops before the last one.
 * @param {import("./app.js").App} app @param {() => void} done
 */
function assignDialog(app, done) {
  const { t, settings } = app;
  const before = structuredClone({ keys: settings.keys, pads: settings.pads, controls: settings.controls });
  let all = false; // whether every panel has got its key
  const text = el("p", { role: "status" });
  const dialog = el("dialog", { class: "assign", "aria-label": t("assign") }, el("h2", {}, t("assign")), text,
    el("p", { class: "group" }, el("button", { type: "button", id: "assign-cancel", onclick: () => dialog.close() }, t("cancel")),
      el("button", { type: "button", id: "assign-defaults", onclick: () => { app.input.forget(); end(); } }, t("assignDefaults"))));
  const panels = app.doc.pad.names;
  let column = 0;
  const ask = () => {
    text.textContent =
      column < panels.length
        ? t("pressFor", { panel: panelName(app.t, panels[column]) })
        : t(`pressControl-${CONTROLS[column - panels.length]}`);
  };
  const end = () => {
    all = true;
    dialog.close();
  };
  app.input.learning = (name) => {
    if (name === "Escape") return dialog.close();
    if (column < panels.length) app.input.assign(column, name);
    else app.input.assignControl(column - panels.length, name);
    ++column;
    const last = panels.length + (name.includes("#") ? CONTROLS.length : 0); // a mat has Start and Select too
    if (column < last) ask();
    else end();
  };
  dialog.addEventListener("close", () => {
    app.input.learning = null;
    if (!all) Object.assign(settings, before);
    app.save();
    done();
    dialog.remove();
  });
  ask();
  document.body.append(dialog);
  dialog.showModal();
}
