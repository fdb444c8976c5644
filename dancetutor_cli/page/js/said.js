// What is said over the picture: what she waits for, what is looped, how it goes, who dances; and the count-in's number.

import { placeOf, stretch } from "./places.js";

/** @param {import("./app.js").App} app */
export function saidOf(app) {
  const { t, transport, practice, sound } = app;
  if (app.message) return app.message;
  if (transport.waiting) return t("waiting");
  const parts = [app.both ? besideText(app) : "", loopText(app), practice.along ? scoreText(app, practice.tally()) : ""];
  const told = parts.filter(Boolean).join(" · ");
  const silent = !app.played && !sound.music;
  return told || (silent ? t("musicMissing", { name: app.doc.words.music || "…" }) : "");
}

/** @param {import("./app.js").App} app */
function loopText(app) {
  const { t, transport, practice, chart } = app;
  const { loop, rate } = transport;
  if (!loop) return "";
  const where = stretch(t, chart.beatAt(loop.a) / 4, chart.beatAt(loop.b) / 4);
  const percent = (/** @type {number} */ x) => Math.round(100 * x);
  const ramped = rate === practice.chosenRate ? "" : t("ramped", { from: percent(practice.chosenRate), to: percent(rate) });
  const before = practice.before ? t("passBefore", { counts: scoreText(app, practice.before) }) : "";
  return [t("loopFrom", { where, passes: practice.passes }), ramped, before].filter(Boolean).join(" · ");
}

/** How it went. @param {import("./app.js").App} app @param {import("./judge.js").Tally} tally */
export function scoreText(app, tally) {
  const { hit, early, late, miss, wrong } = tally;
  return app.t("counts", { hit, early, late, miss, wrong });
}

/** Who dances beside her, and where her feet differ. @param {import("./app.js").App} app */
export function besideText(app) {
  const { name, rows } = app.doc.beside;
  const found = rows.slice(0, 3).map((/** @type {number} */ row) => app.redance.rows.get(row));
  const where = found.filter(Boolean).map((/** @type {import("./chart.js").Row} */ row) => placeOf(app.t, row.beat)).join("; ");
  const what = name === "next" ? app.t("nextBest") : name;
  return app.t("bothLong", { name: what, rows: rows.length, where: rows.length > 3 ? `${where} …` : where });
}

/** Beats that are still counted in, as they are said: 4, 3, 2, 1; "" while none are. @param {import("./app.js").App} app */
export function countOf(app) {
  const { transport, chart } = app;
  if (!transport.counting || !transport.loop) return "";
  return String(Math.max(1, Math.ceil(chart.beatAt(transport.loop.a) - chart.beatAt(transport.second()) - 1e-6)));
}
