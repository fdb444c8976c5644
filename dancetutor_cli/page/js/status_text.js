// The message over the picture: what is waited for, what is looped, how it goes, who dances; and the number of the count-in.

import { keyName } from "./input.js";
import { placeOf, stretch } from "./places.js";
import { hitShare, panelShare, scoreShare } from "./record.js";

export const KINDS = /** @type {const} */ (["hit", "early", "late", "miss", "wrong"]);

/** @param {import("./app.js").App} app */
export function statusText(app) {
  const { t, transport, practice, sound } = app;
  if (app.notice) return app.notice;
  if (practice.unknownKey === "now") return keysText(app);
  if (transport.waiting) return t("waiting");
  const over = practice.along && practice.over ? overText(app, practice.over) : "";
  const parts = [over, practice.coach.on && practice.along ? practice.coach.message : "", loopText(app)].filter(Boolean).join(" · ");
  return parts || (app.musicLoading || (!app.played && !sound.music) ? musicText(app) : "");
}

/** Whether nothing happens that is worth a look: only that there is no music. @param {import("./app.js").App} app */
export const quiet = (app) => !app.notice && !app.practice.along && !app.transport.loop;

/** Whether there is music, and whose: the same words in every place. @param {import("./app.js").App} app */
export function musicText(app) {
  const { t, sound, musicName, musicBad } = app;
  if (app.musicLoading) return t("musicLoading");
  const now = sound.music ? t("musicIs", { name: musicName || app.doc.words.music || "…" }) : t("musicMissing");
  return musicBad ? `${t("musicBad", { name: musicBad })} ${now}` : now;
}

/** Which keys are the panels. @param {import("./app.js").App} app */
function keysText(app) {
  const { keys, arrows } = app.input; // of whoever has pressed a key, a mat or not
  const names = [keys, arrows].filter((one) => one.length).map((one) => one.map(keyName).join(" "));
  return names.length > 1 ? app.t("keysOrArrows", { keys: names[0], arrows: names[1] }) : app.t("keysAre", { keys: names[0] });
}

/** How a song went that is over. @param {import("./app.js").App} app @param {import("./judge.js").Tally} tally */
function overText(app, tally) {
  return app.t("songOver", {
    percent: Math.round(100 * scoreShare(tally)),
    counts: `${scoreText(app, tally)} ${meanText(app, tally)}`.trim(),
  });
}

/** What the score is made of. @param {import("./app.js").App} app @param {import("./record.js").Counts} counts */
export function sharesText(app, counts) {
  return app.t("shares", { panel: Math.round(100 * panelShare(counts)), time: Math.round(100 * hitShare(counts)) });
}

/**
 * How late presses came on average; "" without any.
 * @param {import("./app.js").App} app @param {import("./judge.js").Tally} tally
 */
export function meanText(app, { sum, count }) {
  const mean = count ? Math.round((1000 * sum) / count) : 0;
  return count ? app.t(mean < 0 ? "meanEarly" : "meanLate", { ms: Math.abs(mean) }) : "";
}

/** @param {import("./app.js").App} app */
function loopText(app) {
  const { t, transport, practice, chart } = app;
  const { loop, rate } = transport;
  if (!loop) return "";
  const where = stretch(t, chart.beatAt(loop.a) / 4, chart.beatAt(loop.b) / 4);
  const percent = (/** @type {number} */ x) => Math.round(100 * x);
  const full = app.settings.ramp && rate >= 1 && practice.chosenRate >= 1;
  const ramped =
    practice.coach.on || !app.settings.ramp
      ? ""
      : full
        ? t("rampFull", { rate: percent(rate) })
        : speedStep(app) && t("ramped", { step: speedStep(app) });
  return [t("loopFrom", { where, passes: practice.passes }), ramped].filter(Boolean).join(" · ");
}

/**
 * The last step that the ramp or the coach made: "speed 60 % → 65 %"; "" for none.
 * @param {import("./app.js").App} app
 */
function speedStep({ t, transport: { rate }, practice: { rateBefore } }) {
  return rateBefore && rateBefore !== rate ? t("speedStep", { from: Math.round(100 * rateBefore), to: Math.round(100 * rate) }) : "";
}

/** How late presses came on average, in words. @param {import("./app.js").App} app @param {number} ms */
export function lateText({ t }, ms) {
  const whole = Math.round(ms);
  return whole ? t(whole < 0 ? "early" : "late", { ms: Math.abs(whole) }) : t("exact");
}

/**
 * How it went: the counts that are not 0.
 * @param {import("./app.js").App} app @param {import("./judge.js").Tally} tally
 */
export function scoreText({ t }, tally) {
  const some = KINDS.filter((name) => tally[name] > 0);
  return (some.length ? some : [KINDS[0]]).map((name) => `${tally[name]} ${t(`verdict-${name}`)}`).join(", ");
}

/**
 * The last passes of a loop and the step of the speed, for its count-in: "score 80 % → 100 %"; "" while it plays.
 * @param {import("./app.js").App} app
 */
export function passedOf(app) {
  const { t, transport, practice } = app;
  if (!practice.along || !transport.counting) return "";
  const scores = practice.scores.slice(-2).map((share) => `${Math.round(100 * share)} %`).join(" → ");
  return scores && [t("passScores", { scores }), speedStep(app)].filter(Boolean).join(" · ");
}

/** Who dances beside her, and where her feet differ, for her caption. @param {import("./app.js").App} app */
export function secondCaption(app) {
  const { name, rows } = app.doc.second;
  const found = rows.slice(0, 3).flatMap((row) => app.redance.rows.get(row) ?? []);
  const where = found.map((row) => placeOf(app.t, row.beat)).join("; ");
  const what = name === "next" ? app.t("nextBest") : name;
  return [what, !rows.length ? "" : app.t("secondRows", { rows: rows.length, where: rows.length > 3 ? `${where} …` : where })];
}

/** The same for both. @param {import("./app.js").App} app */
export function secondText(app) {
  return app.t("bothLong", { left: app.t("theseFeet"), right: secondCaption(app).filter(Boolean).join(": ") });
}

/** Beats that are still counted in: 4, 3, 2, 1; "" while none are. @param {import("./app.js").App} app */
export function countOf(app) {
  const { transport, chart } = app;
  if (!transport.counting || !transport.loop) return "";
  return String(Math.max(1, Math.ceil(chart.beatAt(transport.loop.a) - chart.beatAt(transport.second()) - 1e-6)));
}
