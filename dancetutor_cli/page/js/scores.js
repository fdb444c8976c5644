// How it goes, over the picture: the share of hits and the counts while somebody plays along, and a card at the song's end.

import { el } from "./dom.js";
import { COLOURS } from "./noteart.js";
import { hitShare, missedOf } from "./record.js";
import { meanText } from "./said.js";

const KINDS = /** @type {const} */ (["hit", "early", "late", "miss", "wrong"]);

/** Each count in its colour, with its word. @param {import("./app.js").App} app */
function countsRow({ t }) {
  const numbers = KINDS.map(() => el("b", {}, "0"));
  const row = el("p", { class: "counts" }, ...KINDS.map((name, k) => {
    numbers[k].style.color = COLOURS[name];
    return el("span", {}, numbers[k], ` ${t(`verdict-${name}`)}`);
  }));
  const show = (/** @type {import("./judge.js").Tally} */ tally) => KINDS.forEach((name, k) => { numbers[k].textContent = String(tally[name]); });
  return { row, show };
}

/** @param {import("./judge.js").Tally} tally */
const percentOf = (tally) => `${Math.round(100 * hitShare(tally))} %`;

/** The score while it plays; a line above the picture says it to readers. @param {import("./app.js").App} app */
export function standing(app) {
  const share = el("strong", {}, "");
  const { row, show } = countsRow(app);
  const box = el("div", { class: "standing", "aria-hidden": "true" }, share, row);
  app.listeners.add((what) => {
    if (what === "frame") return;
    box.hidden = !app.practice.along || app.practice.over !== null;
    if (box.hidden) return;
    const tally = app.practice.tally();
    share.textContent = hitShare(tally) || tally.miss ? percentOf(tally) : "–";
    show(tally);
  });
  box.hidden = true;
  return box;
}

/** The result of a song that is over, and what to do next. @param {import("./app.js").App} app */
export function resultCard(app) {
  const { t, practice } = app;
  const share = el("strong", {}, "");
  const mean = el("p", { class: "hint" }, "");
  const best = el("p", { class: "best" }, "");
  const { row, show } = countsRow(app);
  const missed = () => missedOf(app.record, app.chart.rows)[0];
  const again = el("button", { type: "button", class: "main", onclick: () => void app.begin() }, t("again-play"));
  const slow = el("button", { type: "button", onclick: () => {
    const one = missed();
    practice.over = null;
    void app.loopBeats(one.from, one.to, one.rate);
  } }, t("again-missed"));
  const close = el("button", { type: "button", class: "sign shut", "aria-label": t("close"), title: t("close"), onclick: () => { practice.over = null; app.tell("hits"); } }, "✕");
  const card = el("section", { class: "result", "aria-label": t("tab-results"), hidden: true }, el("h2", {}, t("tab-results")), share, best, row, mean, el("p", { class: "group" }, again, slow), close);
  app.listeners.add((what) => {
    if (what === "frame") return;
    card.hidden = practice.over === null;
    if (!practice.over) return;
    share.textContent = percentOf(practice.over);
    mean.textContent = [meanText(app, practice.over).replace(/^\((.*)\)$/, "$1"), t("longestRun", { notes: practice.longest })].filter(Boolean).join(" · ");
    const { top } = app.record;
    best.textContent = top > practice.topBefore ? t("bestNew") : top ? t("bestPlay", { percent: top }) : "";
    slow.hidden = !missed();
    show(practice.over);
  });
  return card;
}
