// The panel of results: errors by foot, days, rows with mistakes, misses through the song, and files of results.

import { countsOf } from "./counts.js";
import { bars, download, el } from "./dom.js";
import { placeInMeasure, stretch } from "./places.js";
import { BIN, BINS, LARGEST, dayOf, fromFile, missedOf, missesThrough, scoreShare, streakOf, toFile } from "./record.js";
import { lateText } from "./status_text.js";
import { allRecords, loadRecord, saveRecord, takeRecords } from "./settings.js";

const DAYS = 14; // limit of days that are shown
const ROWS = 5; // limit of rows that are listed
const TOPS = [10, 25, 50]; // percent at the top of the plot of misses, else 100
const OFF = 30; // ms; rows with a larger mean error are listed even if they are never missed

/** @param {import("./app.js").App} app */
export function resultsPanel(app) {
  const { t } = app;
  const panel = el("div", { class: "results" });
  const body = el("div");
  const show = () => {
    const today = app.record.days.find(({ day }) => day === dayOf(new Date()));
    const parts = app.record.days.length
      ? [summary(app), histogram(app, today), missed(app), through(app), rowsOf(app), days(app)]
      : [el("p", {}, t("noResults"))];
    body.replaceChildren(...parts.filter((part) => part !== null));
  };
  app.listeners.add((what) => {
    if (["record", "coach", "settings", "pass", "along"].includes(what)) show();
  });
  panel.append(body);
  show();
  return panel;
}

/** Make the buttons that save and import a file of the results of all charts. @param {import("./app.js").App} app */
export function recordPart(app) {
  const { t, practice } = app;
  const file = el("input", {
    type: "file",
    accept: "application/json,.json",
    id: "record-file",
    hidden: true,
    "aria-label": t("recordLoad"),
  });
  const message = el("p", { class: "hint", role: "status", id: "record-message" });
  const load = el("button", { type: "button", onclick: () => file.click() }, t("recordLoad"));
  const save = el("button", { type: "button", id: "record-save", onclick: () => {
    practice.recordOutcomes();
    download("dancetutor-practice.json", toFile({ ...allRecords(), [app.id]: app.record }));
    message.textContent = t("recordSaved", { name: "dancetutor-practice.json" });
  } }, t("recordSave"));
  file.addEventListener("change", async () => {
    const [one] = file.files ?? [];
    if (one) message.textContent = await takeFile(app, one);
    file.value = "";
  });
  return el(
    "section",
    {},
    el("h3", {}, t("recordTitle")),
    el("p", { class: "group" }, save, load),
    file,
    message,
    el("p", { class: "hint" }, t("recordHint")),
  );
}

/** Import a file of records; return a message. @param {import("./app.js").App} app @param {File} file */
async function takeFile(app, file) {
  if (file.size > LARGEST) return app.t("recordLarge", { name: file.name.slice(0, 60), most: LARGEST / 1e6 });
  const records = fromFile(await file.text());
  if (!records) return app.t("recordBad", { name: file.name.slice(0, 60) });
  app.practice.recordOutcomes();
  saveRecord(app.id, app.record);
  takeRecords(records);
  if (records.has(app.id)) app.record = loadRecord(app.id);
  app.tell("record");
  return app.t(records.has(app.id) ? "recordTaken" : "recordTakenOthers", { charts: records.size });
}

/** Make the line with the score of today and the days in a row. @param {import("./app.js").App} app */
function summary(app) {
  const { t, record } = app;
  const today = dayOf(new Date());
  const one = record.days.find(({ day }) => day === today);
  const streak = streakOf(record.days, today);
  const row = streak.now ? t("streak", { days: streak.now, most: streak.most }) : "";
  if (!one) return el("p", {}, [t("todayNone"), row].join(" "));
  const counts = countsOf(app);
  counts.show(one);
  const notes = one.hit + one.early + one.late + one.miss;
  return el(
    "section",
    { class: "today" },
    el("h3", {}, t("today", { notes })),
    el("p", { class: "scored" }, counts.share, el("span", {}, t("score"))),
    counts.bar,
    counts.shares,
    counts.row,
    el("p", { class: "hint" }, row),
  );
}

/**
 * Errors of left and right foot, of today if anything was played, else of all days.
 * @param {import("./app.js").App} app @param {import("./record.js").Day} [today]
 */
function histogram(app, today) {
  const some = today ? [today] : app.record.days;
  const feet = [0, 1].map((foot) => Array.from({ length: BINS }, (_, k) => some.reduce((sum, day) => sum + day.feet[foot][k], 0)));
  return timing(app, feet, app.t(today ? "histogramToday" : "histogramAll"));
}

/**
 * How early or late each foot was. @param {import("./app.js").App} app @param {number[][]} feet counts by bar @param {string} title
 * @param {number[]} [means] ms; else those of the bars
 */
export function timing(app, feet, title, means) {
  const { t, doc } = app;
  const about = feet.map((counts, foot) => {
    const all = counts.reduce((a, b) => a + b, 0);
    const mean = means?.[foot] ?? counts.reduce((sum, n, k) => sum + n * BIN * (k - (BINS >> 1)), 0) / Math.max(all, 1);
    return [t(foot ? "rightMean" : "leftMean", { count: all }), all ? t("onAverage", { how: lateText(app, mean) }) : ""]
      .filter(Boolean)
      .join(", ");
  });
  const edge = BIN * (BINS >> 1);
  return el("figure", {}, el("figcaption", {}, title),
    bars(feet, doc.style.limbs, `${about.join("; ")}`, undefined, "timing"),
    el(
      "p",
      { class: "ends", "aria-hidden": "true" },
      el("span", {}, t("early", { ms: edge })),
      el("span", {}, "0"),
      el("span", {}, t("late", { ms: edge })),
    ),
    el(
      "p",
      { class: "legend" },
      ...about.map((text, foot) => {
        const sign = el("span", { "aria-hidden": "true" }, "■ ");
        sign.style.color = doc.style.limbs[foot];
        return el("span", {}, sign, text, " ");
      }),
    ),
  );
}

/** @param {import("./app.js").App} app */
function missed(app) {
  const { t, record, chart } = app;
  const list = missedOf(record, chart.rows);
  if (!list.length) return el("p", {}, t("nothingMissed"));
  return el(
    "section",
    {},
    el("h3", {}, t("missedTitle")),
    el(
      "ol",
      { class: "cards" },
      ...list.map((one) =>
        el(
          "li",
          {},
          el(
            "button",
            { type: "button", class: "card missed", onclick: () => void app.practice.coach.start(one) },
            el("strong", {}, el("span", {}, stretch(t, one.from / 4, one.to / 4))),
            el("span", { class: "figure" }, t("startsAt", { rate: Math.round(100 * one.rate) })),
            el(
              "span",
              { class: "text" },
              `${t("missedRows", { count: one.misses })} · ${t(one.passed ? "missedPassed" : "missedNew")}`,
            ),
          ),
        ),
      ),
    ),
  );
}

/** Where in the song notes were missed, by foot. @param {import("./app.js").App} app */
function through({ t, record, chart, doc }) {
  const shares = missesThrough(record, chart.rows);
  const last = Math.floor((chart.rows[chart.rows.length - 1]?.beat ?? 0) / 4 + 1e-6);
  const title = t("throughTitle");
  const most = TOPS.find((top) => top >= Math.max(...shares.flat())) ?? 100;
  return el(
    "figure",
    {},
    el("figcaption", {}, title),
    el("p", { class: "ends", "aria-hidden": "true" }, el("span", {}, `${most} %`)),
    bars(
      [0, 1].map((foot) => shares.map((one) => one[foot])),
      doc.style.limbs,
      title,
      most,
      "through",
    ),
    el(
      "p",
      { class: "ends", "aria-hidden": "true" },
      el("span", {}, t("oneMeasure", { from: 0 })),
      el("span", {}, t("oneMeasure", { from: last })),
    ),
  );
}

/** Rows that went wrong most often. @param {import("./app.js").App} app */
function rowsOf(app) {
  const { t, record, chart } = app;
  const worst = chart.rows.filter(({ row }) => record.rows[row]?.tries).map((row) => ({ row, own: record.rows[row.row] }))
    .map((one) => ({ ...one, mean: one.own.timed ? Math.round(one.own.sum / one.own.timed) : 0 }))
    .filter(({ own, mean }) => own.misses > 0 || Math.abs(mean) > OFF)
    .sort((a, b) => b.own.misses / b.own.tries - a.own.misses / a.own.tries || Math.abs(b.mean) - Math.abs(a.mean)).slice(0, ROWS);
  if (!worst.length) return null;
  const cells = worst.map(({ row, own, mean }) =>
    el(
      "tr",
      {},
      el(
        "th",
        { scope: "row" },
        el("button", { type: "button", class: "link", onclick: () => app.goTo(row.steps[0].note) }, placeInMeasure(t, row.beat)),
      ),
      el("td", {}, row.steps.map(({ limb }) => (limb === 0 || limb === 1 ? t(limb ? "footR" : "footL") : "")).join("")),
      el("td", {}, t("missedOf", { misses: own.misses, tries: own.tries })),
      el("td", {}, own.timed ? lateText(app, mean) : ""),
    ),
  );
  return el(
    "section",
    {},
    el("h3", {}, t("rowsTitle")),
    el(
      "table",
      { class: "rows" },
      el(
        "thead",
        {},
        el("tr", {}, ...["rowsPlace", "rowsFoot", "rowsMissed", "rowsMean"].map((name) => el("th", { scope: "col" }, t(name)))),
      ),
      el("tbody", {}, ...cells),
    ),
  );
}

/** The score by day, where there are days to compare. @param {import("./app.js").App} app */
function days({ t, record }) {
  const some = record.days.slice(-DAYS);
  if (some.length < 2) return null;
  const shares = some.map((day) => Math.round(100 * scoreShare(day)));
  const about = some.map((one, k) => `${one.day}: ${shares[k]} %`).join("; ");
  return el(
    "figure",
    {},
    el("figcaption", {}, t("daysTitle")),
    bars([shares], ["#8f98d8"], about, 100),
    el(
      "p",
      { class: "ends", "aria-hidden": "true" },
      el("span", {}, `${some[0].day}: ${shares[0]} %`),
      el("span", {}, `${some[some.length - 1].day}: ${shares[shares.length - 1]} %`),
    ),
  );
}
