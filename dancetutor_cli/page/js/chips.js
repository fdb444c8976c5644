// What holds without being seen elsewhere, on the picture: one foot only, a loop on a phone, a way to play along, an easier way
// after many misses; each with a click that changes it.

import { el } from "./dom.js";
import { FIRST } from "./record.js";

/** @param {import("./app.js").App} app */
export function chips(app) {
  const { t, practice } = app;
  const foot = el("button", { type: "button", class: "chip", id: "chip-foot", title: t("footChip"), onclick: () => practice.setFoot("both") });
  const join = el("button", { type: "button", class: "chip main", id: "chip-along", onclick: () => practice.setAlong(true) }, t("along"));
  const loop = el("button", { type: "button", class: "chip loop", id: "chip-loop", title: t("noLoop"), onclick: () => app.setLoop(null, null) },
    t("loopName-bar"), el("span", { "aria-hidden": "true" }, " ✕"));
  const slow = el("button", { type: "button", class: "chip main", id: "chip-slow", onclick: () => {
    practice.lost = 0;
    app.setRate(FIRST);
  } }, t("slowerTo", { rate: 100 * FIRST }));
  const wait = el("button", { type: "button", class: "chip main", id: "chip-wait", onclick: () => practice.setWait(true) }, t("wait"));
  const row = el("div", { class: "chips" }, foot, loop, join, slow, wait);
  const show = () => {
    const only = app.settings.foot;
    foot.hidden = only === "both";
    foot.replaceChildren(t(`foot-${only}`), el("span", { "aria-hidden": "true" }, " ✕"));
    loop.hidden = !app.transport.loop;
    join.hidden = practice.along || !practice.saysIdle;
    slow.hidden = !practice.struggles || app.transport.rate <= FIRST;
    wait.hidden = !practice.struggles;
  };
  app.listeners.add((what) => { if (what !== "frame") show(); });
  show();
  return row;
}
