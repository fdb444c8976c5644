// What holds without being seen elsewhere, on the picture: one foot only, a way to play along; each with a click that changes it.

import { el } from "./dom.js";

/** @param {import("./app.js").App} app */
export function chips(app) {
  const { t, practice } = app;
  const foot = el("button", { type: "button", class: "chip", id: "chip-foot", title: t("footChip"), onclick: () => practice.setFoot("both") });
  const join = el("button", { type: "button", class: "chip main", id: "chip-along", onclick: () => practice.setAlong(true) }, t("along"));
  const row = el("div", { class: "chips" }, foot, join);
  const show = () => {
    const only = app.settings.foot;
    foot.hidden = only === "both";
    foot.replaceChildren(t(`foot-${only}`), el("span", { "aria-hidden": "true" }, " ✕"));
    join.hidden = !practice.saysIdle;
  };
  app.listeners.add((what) => { if (what !== "frame") show(); });
  show();
  return row;
}
