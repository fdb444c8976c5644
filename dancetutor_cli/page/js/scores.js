// Over the picture: the score and the counts while somebody plays along, a card at the song's end, and chips.

import { FAIR, countsOf, showShare } from "./counts.js";
import { el } from "./dom.js";
import { BINS, FIRST, errorBin, missedOf, scoreShare } from "./record.js";
import { timing } from "./results.js";
import { meanText, passedOf } from "./status_text.js";

const NOTABLE = 50; // %: the least that a first play is called a best score for

/** The score while it plays; the panel of playing along says it to readers. @param {import("./app.js").App} app */
export function standing(app) {
  const { share, shares, row, bar, show } = countsOf(app);
  const box = el(
    "div",
    { class: "standing", "aria-hidden": "true" },
    el("p", { class: "scored" }, share, el("span", {}, app.t("score"))),
    bar,
    shares,
    row,
  );
  app.listeners.add((what) => {
    if (what === "frame") return;
    box.hidden = !app.practice.along || app.practice.over !== null;
    if (!box.hidden) show(app.practice.tally());
  });
  box.hidden = true;
  return box;
}

/**
 * The same in a line above the lanes, where there is no room for more: score and misses, or the last passes of a loop.
 * @param {import("./app.js").App} app
 */
export function slimStanding(app) {
  const share = el("b", {}, "");
  const rest = el("span", {}, "");
  let shown = ""; // of the passes
  const line = el("p", { class: "slim", "aria-hidden": "true", hidden: true }, share, rest);
  app.listeners.add((what) => {
    const { practice } = app;
    line.hidden = !practice.along || practice.over !== null;
    if (line.hidden) return;
    const passes = passedOf(app);
    if (what === "frame" && passes === shown) return;
    shown = passes;
    const tally = practice.tally();
    if (passes) share.textContent = "";
    else showShare(share, tally);
    rest.textContent = passes || (tally.miss ? `· ${tally.miss} ${app.t("verdict-miss")}` : "");
  });
  return line;
}

/** The result of a song that is over, and what to do next. @param {import("./app.js").App} app */
export function resultCard(app) {
  const { t, practice } = app;
  const { share, shares, row, bar, show } = countsOf(app);
  const mean = el("p", { class: "hint" }, "");
  const best = el("p", { class: "best" }, "");
  const part = el("p", { class: "part" }, "");
  const feet = el("div", { class: "feet" });
  const missed = () => missedOf(app.record, app.chart.rows)[0];
  const again = el("button", { type: "button", id: "again-play", onclick: () => void app.begin() }, t("again-play"));
  const slow = el(
    "button",
    {
      type: "button",
      id: "again-missed",
      onclick: () => {
        practice.over = null;
        void practice.coach.start(missed());
      },
    },
    t("again-missed"),
  );
  const close = el(
    "button",
    {
      type: "button",
      class: "sign shut",
      "aria-label": t("close"),
      title: t("close"),
      onclick: () => {
        practice.over = null;
        app.tell("hits");
      },
    },
    "✕",
  );
  const card = el(
    "section",
    { class: "result", "aria-label": t("tab-results"), hidden: true },
    el("h2", {}, t("tab-results")),
    part,
    share,
    el("p", { class: "scored" }, t("score")),
    bar,
    shares,
    best,
    row,
    mean,
    feet,
    el("p", { class: "group" }, again, slow),
    close,
  );
  app.listeners.add((what) => {
    if (what === "frame") return;
    const { over } = practice;
    card.hidden = over === null;
    if (!over) return;
    show(over);
    part.textContent = partText(app, over);
    mean.textContent = [meanText(app, over).replace(/^\((.*)\)$/, "$1"), t("longestRun", { notes: practice.longest })]
      .filter(Boolean)
      .join(" · ");
    const { top } = app.record;
    const better = top > practice.topBefore && (practice.topBefore > 0 || top >= NOTABLE); // a first try that went badly is no record
    best.textContent = better ? t("bestNew") : top ? t("bestPlay", { percent: top }) : "";
    feet.replaceChildren(...(over.count ? [feetPart(app)] : []));
    slow.hidden = !missed();
    const bad = !slow.hidden && scoreShare(over) < FAIR;
    slow.classList.toggle("main", bad);
    again.classList.toggle("main", !bad);
  });
  return card;
}

/**
 * What was played, if it was not the whole song.
 * @param {import("./app.js").App} app @param {import("./judge.js").Tally} over
 */
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

// Chips: what holds without being seen elsewhere: one foot only, a loop on a phone, a way to play along, an easier way after
// many misses; each with a click that changes it.

/** @param {import("./app.js").App} app */
export function chips(app) {
  const { t, practice } = app;
  const foot = el("button", {
    type: "button",
    class: "chip",
    id: "chip-foot",
    title: t("footChip"),
    onclick: () => practice.setFoot("both"),
  });
  const begin = (/** @type {boolean} */ waits) => {
    // a loop is played from its start, a song goes on
    const watched = !practice.along;
    practice.setWait(waits);
    if (!watched) return;
    if (app.transport.loop) void app.beginAlong();
    else practice.setAlong(true);
  };
  const join = el("button", { type: "button", class: "chip main", id: "chip-along", onclick: () => begin(false) }, t("along"));
  const loop = el(
    "button",
    { type: "button", class: "chip loop", id: "chip-loop", title: t("noLoop"), onclick: () => app.setLoop(null, null) },
    t("loopName-bar"),
    el("span", { "aria-hidden": "true" }, " ✕"),
  );
  const slow = el(
    "button",
    {
      type: "button",
      class: "chip main",
      id: "chip-slow",
      onclick: () => {
        practice.lost = 0;
        app.setRate(FIRST);
      },
    },
    t("slowerTo", { rate: 100 * FIRST }),
  );
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
