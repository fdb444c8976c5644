// How it goes, over the picture: the score and the counts while somebody plays along, and a card at the song's end.

import { el } from "./dom.js";
import { COLOURS } from "./noteart.js";
import { BINS, errorBin, missedOf, scoreShare } from "./record.js";
import { timing } from "./results.js";
import { KINDS, meanText, sharesText } from "./said.js";

const GOOD = 0.9; // a score that is good
const FAIR = 0.7; // and one below which the missed rows are worth more than another try

/** Each count that is not 0 in its colour, with its word. @param {import("./app.js").App} app */
function countsRow({ t }) {
  const numbers = KINDS.map(() => el("b", {}, "0"));
  const each = KINDS.map((name, k) => {
    numbers[k].style.color = COLOURS[name];
    return el("span", {}, numbers[k], ` ${t(`verdict-${name}`)}`);
  });
  const row = el("p", { class: "counts" }, ...each);
  const show = (/** @type {import("./judge.js").Tally} */ tally) => KINDS.forEach((name, k) => {
    numbers[k].textContent = String(tally[name]);
    each[k].hidden = tally[name] === 0;
  });
  return { row, show };
}

/** A line that is parted as the score counts: notes by their verdicts, and wrong presses. */
function countsBar() {
  const parts = KINDS.map((name) => {
    const part = el("span", { class: name });
    part.style.background = COLOURS[name];
    return part;
  });
  const bar = el("div", { class: "parts", "aria-hidden": "true" }, ...parts);
  const show = (/** @type {import("./judge.js").Tally} */ tally) => parts.forEach((part, k) => { part.style.flexGrow = String(tally[KINDS[k]]); });
  return { bar, show };
}

/** The score, large, in a colour by how good it is. @param {HTMLElement} element @param {import("./judge.js").Tally} tally */
function showShare(element, tally) {
  const share = scoreShare(tally);
  element.textContent = share || tally.miss || tally.wrong ? `${Math.round(100 * share)} %` : "–";
  element.style.color = share || tally.miss || tally.wrong ? COLOURS[share >= GOOD ? "hit" : share >= FAIR ? "early" : "miss"] : "";
}

/** The score while it plays; the panel of playing along says it to readers. @param {import("./app.js").App} app */
export function standing(app) {
  const share = el("strong", {}, "");
  const shares = el("p", { class: "shares" }, "");
  const { row, show } = countsRow(app);
  const line = countsBar();
  const box = el("div", { class: "standing", "aria-hidden": "true" }, el("p", { class: "scored" }, share, el("span", {}, app.t("score"))), line.bar, shares, row);
  app.listeners.add((what) => {
    if (what === "frame") return;
    box.hidden = !app.practice.along || app.practice.over !== null;
    if (box.hidden) return;
    const tally = app.practice.tally();
    showShare(share, tally);
    shares.textContent = scoreShare(tally) || tally.miss ? sharesText(app, tally) : "";
    line.show(tally);
    show(tally);
  });
  box.hidden = true;
  return box;
}

/** The result of a song that is over, and what to do next. @param {import("./app.js").App} app */
export function resultCard(app) {
  const { t, practice } = app;
  const share = el("strong", {}, "");
  const shares = el("p", { class: "shares" }, "");
  const mean = el("p", { class: "hint" }, "");
  const best = el("p", { class: "best" }, "");
  const part = el("p", { class: "part" }, "");
  const feet = el("div", { class: "feet" });
  const { row, show } = countsRow(app);
  const line = countsBar();
  const missed = () => missedOf(app.record, app.chart.rows)[0];
  const again = el("button", { type: "button", id: "again-play", onclick: () => void app.begin() }, t("again-play"));
  const slow = el("button", { type: "button", id: "again-missed", onclick: () => {
    practice.over = null;
    void practice.coach.start(missed());
  } }, t("again-missed"));
  const close = el("button", { type: "button", class: "sign shut", "aria-label": t("close"), title: t("close"), onclick: () => { practice.over = null; app.tell("hits"); } }, "✕");
  const card = el("section", { class: "result", "aria-label": t("tab-results"), hidden: true }, el("h2", {}, t("tab-results")), part, share, el("p", { class: "scored" }, t("score")), line.bar, shares, best, row, mean, feet, el("p", { class: "group" }, again, slow), close);
  app.listeners.add((what) => {
    if (what === "frame") return;
    const { over } = practice;
    card.hidden = over === null;
    if (!over) return;
    showShare(share, over);
    shares.textContent = sharesText(app, over);
    part.textContent = partText(app, over);
    mean.textContent = [meanText(app, over).replace(/^\((.*)\)$/, "$1"), t("longestRun", { notes: practice.longest })].filter(Boolean).join(" · ");
    const { top } = app.record;
    best.textContent = top > practice.topBefore ? t("bestNew") : top ? t("bestPlay", { percent: top }) : "";
    feet.replaceChildren(...(over.count ? [feetPart(app)] : []));
    slow.hidden = !missed();
    const bad = !slow.hidden && scoreShare(over) < FAIR;
    slow.classList.toggle("main", bad);
    again.classList.toggle("main", !bad);
    line.show(over);
    show(over);
  });
  return card;
}

/** What was played, if it was not the whole song. @param {import("./app.js").App} app @param {import("./judge.js").Tally} over */
function partText({ t, chart, practice }, { hit, early, late, miss }) {
  const { from } = practice.judge;
  if (from <= chart.first) return "";
  return t("playedPart", { notes: hit + early + late + miss, from: Math.floor(chart.beatAt(Math.max(from, 0)) / 4 + 1e-3) });
}

/** How early or late each foot was in this play. @param {import("./app.js").App} app */
function feetPart(app) {
  const { judge } = app.practice;
  /** @type {number[][]} */
  const errors = [[], []];
  for (const [note, error] of judge.errors) {
    if (judge.chart.second[note] >= judge.from) errors[judge.limbOf(note)]?.push(error); // a hand's have no bars
  }
  const feet = errors.map((some) => some.reduce((bars, error) => {
    ++bars[errorBin(error)];
    return bars;
  }, new Array(BINS).fill(0)));
  const means = errors.map((some) => (1000 * some.reduce((sum, error) => sum + error, 0)) / Math.max(some.length, 1));
  return timing(app, feet, app.t("histogramNow"), means);
}
