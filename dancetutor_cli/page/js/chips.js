// What holds without being seen elsewhere, on the picture: one foot only, a loop on a phone, a way to play along, an easier way
// after many misses; each with a click that changes it.

import { el } from "./dom.js";
import { FIRST } from "./record.js";

/** @param {import("./app.js").App} app */
export function chips(app) {
  const { t, practice } = app;
  const foot = el("button", { type: "button", class: "chip", id: "chip-foot", title: t("footChip"), onclick: () => practice.setFoot("both") });
  const begin = (/** @type {boolean} */ waits) => { // a loop is played from its start, a song goes on
    const watched = !practice.along;
    practice.setWait(waits);
    if (!watched) return;
    if (app.transport.loop) void app.beginAlong();
    else practice.setAlong(true);
  };
  const join = el("button", { type: "button", class: "chip main", id: "chip-along", onclick: () => begin(false) }, t("along"));
  const loop = el("button", { type: "button", class: "chip loop", id: "chip-loop", title: t("noLoop"), onclick: () => app.setLoop(null, null) },
    t("loopName-bar"), el("span", { "aria-hidden": "true" }, " ✕"));
  const slow = el("button", { type: "button", class: "chip main", id: "chip-slow", onclick: () => {
    practice.lost = 0;
    app.setRate(FIRST);
  } }, t("slowerTo", { rate: 100 * FIRST }));
  const wait = el("button", { type: "button", class: "chip", id: "chip-wait", onclick: () => begin(true) }, t("wait"));
  const row = el("div", { class: "chips" }, join, wait, slow, foot, loop);
  const show = () => {
    const only = app.notes.foot;
    foot.hidden = only === "both";
    foot.replaceChildren(t(`foot-${only}`), el("span", { "aria-hidden": "true" }, " ✕"));
    loop.hidden = !app.transport.loop;
    join.hidden = practice.along && !practice.wait;
    join.classList.toggle("begin", practice.along || !practice.saysIdle); // only a phone has no other place for it
    slow.hidden = !practice.struggles || app.transport.rate <= FIRST;
    wait.hidden = practice.wait;
    for (const name of ["begin", "main"]) wait.classList.toggle(name, practice.struggles === (name === "main"));
  };
  app.listeners.add((what) => { if (what !== "frame") show(); });
  show();
  return row;
}
