// The record of practising a chart over days: results by row and foot, best speeds, loops with names. It is plain data
// that this browser stores. A file of it may come from anybody, so each value is checked.

import { clamp } from "./maths.js";

export const BIN = 15; // milliseconds of a bar of the histogram
export const BINS = 19; // bars: the middle one is around 0
const MOST = { days: 1000, rows: 20000, loops: 50, best: 500, charts: 2000, name: 60, id: 500, beat: 1e6 };
export const LARGEST = 4_000_000; // limit of bytes of a file that is imported
const FORMAT = "dancetutor-practice";
const APART = 1; // measures between missed rows of one stretch
const LONGEST = 4; // limit of measures of one stretch; a longer one is divided
const LOWEST = 0.25;
const PART = /^\d{1,6}(\.\d{1,2})?-\d{1,6}(\.\d{1,2})?$/; // "16-32", beats
export const FIRST = 0.7; // the first speed of a stretch that was never passed
export const PASSED = 0.95; // score with which a stretch is passed

/**
 * @typedef {object} Day counts of one day, and errors of left and right foot in bins
 * @property {string} day "2026-11-24"
 * @property {number} hit @property {number} early @property {number} late @property {number} miss @property {number} wrong
 * @property {[number[], number[]]} feet
 */
/**
 * @typedef {{tries: number, misses: number, timed: number, sum: number, missed: boolean, rate: number}} RowRecord
 * sum : ms; missed : whether at the last time; rate : speed of the last pass of its measure without a miss, %, 0: none
 */
/** @typedef {{name: string, from: number, to: number, rate: number}} SavedLoop beats, %; where it ends */
/**
 * @typedef {object} PracticeRecord
 * @property {Day[]} days @property {Record<string, RowRecord>} rows @property {SavedLoop[]} loops
 * @property {Record<string, number>} best speeds of clean passes, %, by beats "16-32"
 * @property {Record<string, number>} scores the best at full speed, %, by beats
 * @property {Record<string, [number, number]>} plays score and speed, %, of the best pass at any speed, by beats
 * @property {number} top the best of a whole song at full speed, %
 */
/**
 * @typedef {{row: number, limb: number, measure?: number, verdict: import("./judge.js").Verdict, error: number | undefined}} Outcome
 * The result of a note. error : seconds late
 */

/** @returns {PracticeRecord} */
export const emptyRecord = () => ({ days: [], rows: {}, loops: [], best: {}, scores: {}, plays: {}, top: 0 });

/** Return the bar of the histogram for an error. @param {number} error seconds */
export const errorBin = (error) => clamp(Math.round((1000 * error) / BIN), -(BINS >> 1), BINS >> 1) + (BINS >> 1);

/** @param {Date} date */
export const dayOf = (date) => [date.getFullYear(), date.getMonth() + 1, date.getDate()].map((n) => String(n).padStart(2, "0")).join("-");

/** @param {string} day @returns {Day} */
const newDay = (day) => ({ day, hit: 0, early: 0, late: 0, miss: 0, wrong: 0, feet: [new Array(BINS).fill(0), new Array(BINS).fill(0)] });

/**
 * Add results of notes at a speed.
 * @param {PracticeRecord} record @param {string} day @param {Outcome[]} outcomes @param {number} wrong
 * @param {number} rate
 */
export function addOutcomes(record, day, outcomes, wrong, rate) {
  if (!outcomes.length && !wrong) return;
  let today = record.days.find((one) => one.day === day);
  if (!today) record.days.push((today = newDay(day)));
  record.days = record.days.slice(-MOST.days);
  today.wrong += wrong;
  const failed = new Set(outcomes.filter(({ verdict }) => verdict === "miss").map(({ measure }) => measure));
  for (const { row, limb, measure, verdict, error } of outcomes) {
    ++today[verdict];
    const own = (record.rows[row] ??= { tries: 0, misses: 0, timed: 0, sum: 0, missed: false, rate: 0 });
    ++own.tries;
    own.missed = verdict === "miss";
    if (own.missed) ++own.misses;
    else if (!failed.has(measure)) own.rate = Math.round(100 * rate);
    if (error === undefined) continue;
    ++own.timed;
    own.sum += Math.round(1000 * error);
    if (limb === 0 || limb === 1) ++today.feet[limb][errorBin(error)];
  }
}

/** Note a pass without a miss or a wrong press. @param {PracticeRecord} record @param {string} where "16-32", beats @param {number} rate */
export function addClean(record, where, rate) {
  record.best[where] = Math.max(record.best[where] ?? 0, Math.round(100 * rate));
}

/**
 * Note the score of a pass. The best one has the largest product of score and speed.
 * @param {PracticeRecord} record @param {string} where @param {number} share 0..1 @param {number} rate
 */
export function addPlay(record, where, share, rate) {
  const score = Math.round(100 * share);
  record.plays[where] = better(record.plays[where], [score, Math.round(100 * rate)]);
  if (rate >= 1) record.scores[where] = Math.max(record.scores[where] ?? 0, score);
}

/**
 * Return the better of two passes; if they are equal, the faster one.
 * @param {[number, number] | undefined} mine @param {[number, number]} theirs
 */
const better = (mine, theirs) => (mine && mine[0] * mine[1] - theirs[0] * theirs[1] + (mine[1] - theirs[1]) / 1000 >= 0 ? mine : theirs);

/**
 * Whether a part was passed at full speed: without a mistake, or with the score `PASSED`.
 * @param {PracticeRecord} record @param {string} where
 */
export const passedFull = ({ best, scores }, where) => best[where] >= 100 || scores[where] >= 100 * PASSED;

/** @param {number} from @param {number} to beats */
export const whereOf = (from, to) => `${Math.round(100 * from) / 100}-${Math.round(100 * to) / 100}`;

/** @typedef {{hit: number, early: number, late: number, miss: number, wrong: number}} Counts */

/** Return the share of hits among notes, 0..1. @param {Counts} counts */
export const hitShare = ({ hit, early, late, miss }) => hit / Math.max(hit + early + late + miss, 1);

/** Return the share of notes whose panel was pressed, in time or not, 0..1. @param {Counts} counts */
export const panelShare = ({ hit, early, late, miss }) => (hit + early + late) / Math.max(hit + early + late + miss, 1);

/**
 * Return the score, 0..1: an early or late press is worth half a hit, a wrong press counts as a miss.
 * @param {Counts} counts
 */
export function scoreShare({ hit, early, late, miss, wrong }) {
  return (hit + (early + late) / 2) / Math.max(hit + early + late + miss + wrong, 1);
}

/**
 * Return the number of days in a row up to today (or yesterday, because today is not over), and the largest number ever.
 * @param {Day[]} days @param {string} today @returns {{now: number, most: number}}
 */
export function streakOf(days, today) {
  const number = (/** @type {string} */ day) => Math.round(Date.parse(`${day}T00:00:00Z`) / 86400000);
  const all = [...new Set(days.map(({ day }) => number(day)))].sort((a, b) => a - b);
  let [run, most] = [0, 0];
  all.forEach((day, k) => {
    run = day - 1 === all[k - 1] ? run + 1 : 1;
    most = Math.max(most, run);
  });
  return { now: all.length && number(today) - all[all.length - 1] <= 1 ? run : 0, most };
}

/**
 * @typedef {{from: number, to: number, misses: number, rate: number, passed: boolean}} Missed
 * A stretch of whole measures with misses. from, to : beats; rate : the first speed; passed : whether ever passed
 */

/**
 * Stretches whose rows were missed the last time, the most missed first; each with the speed at which all of it was passed last.
 * @param {PracticeRecord} record @param {import("./chart.js").Row[]} rows @param {number} [most] @returns {Missed[]}
 */
export function missedOf(record, rows, most = 6) {
  /** @type {Missed[]} */
  const out = [];
  for (const { row, beat } of rows) {
    const own = record.rows[row];
    if (!own?.missed) continue;
    const measure = Math.floor(beat / 4 + 1e-6);
    const last = out[out.length - 1];
    if (last && measure <= last.to / 4 + APART - 1 + 1e-6 && measure < last.from / 4 + LONGEST)
      [last.to, last.misses] = [4 * (measure + 1), last.misses + 1];
    else out.push({ from: 4 * measure, to: 4 * (measure + 1), misses: 1, rate: FIRST, passed: false });
  }
  for (const one of out) {
    const rates = rows.filter(({ beat }) => beat >= one.from - 1e-6 && beat < one.to - 1e-6).map(({ row }) => record.rows[row]?.rate ?? 0);
    one.passed = rates.every((rate) => rate > 0);
    if (one.passed) one.rate = clamp(Math.min(...rates) / 100, LOWEST, 1);
  }
  return out.sort((a, b) => b.misses - a.misses || a.from - b.from).slice(0, most);
}

/**
 * Share of missed notes through the song, of left and right foot, in parts of as many measures each.
 * @param {PracticeRecord} record @param {import("./chart.js").Row[]} rows @param {number} [most] parts
 * @returns {[number, number][]} percent
 */
export function missesThrough(record, rows, most = 48) {
  const count = rows.length ? Math.floor(rows[rows.length - 1].beat / 4 + 1e-6) + 1 : 0;
  const long = Math.ceil(count / most) || 1;
  const sums = Array.from({ length: Math.ceil(count / long) }, () => [0, 1].map(() => ({ tries: 0, misses: 0 })));
  for (const { row, beat, steps } of rows) {
    const own = record.rows[row];
    if (!own) continue;
    for (const { limb } of steps) {
      const sum = sums[Math.floor(Math.floor(beat / 4 + 1e-6) / long)][limb];
      if (!sum) continue;
      sum.tries += own.tries;
      sum.misses += own.misses;
    }
  }
  return sums.map(
    (feet) => /** @type {[number, number]} */ (feet.map(({ tries, misses }) => Math.round((100 * misses) / Math.max(tries, 1)))),
  );
}

/**
 * The coach's next speed: it goes by the score. @param {number} rate @param {number} share 0..1
 * @param {number} goal the speed that is wanted in the end
 */
export function coachRate(rate, share, goal) {
  const step = share >= 0.95 ? 0.1 : share >= 0.85 ? 0.05 : share >= 0.7 ? 0 : share >= 0.5 ? -0.05 : -0.1;
  return clamp(Math.round(100 * (rate + step)) / 100, LOWEST, Math.max(goal, LOWEST));
}

/**
 * Merge two records of one chart. Merging the same record twice changes nothing.
 * @param {PracticeRecord} mine @param {PracticeRecord} theirs
 */
export function merged(mine, theirs) {
  const played = (/** @type {Day} */ day) => day.hit + day.early + day.late + day.miss + day.wrong;
  const days = new Map(mine.days.map((one) => [one.day, one]));
  for (const one of theirs.days) {
    const own = days.get(one.day);
    if (!own || played(one) > played(own)) days.set(one.day, one);
  }
  const out = {
    ...mine,
    days: [...days.values()].sort((a, b) => (a.day < b.day ? -1 : 1)).slice(-MOST.days),
    rows: { ...mine.rows },
    best: { ...mine.best },
    scores: { ...mine.scores },
    plays: { ...mine.plays },
    loops: [...mine.loops],
    top: Math.max(mine.top, theirs.top),
  };
  for (const [row, one] of Object.entries(theirs.rows)) if (one.tries > (out.rows[row]?.tries ?? 0)) out.rows[row] = one;
  for (const kind of /** @type {const} */ (["best", "scores"])) {
    for (const [where, value] of Object.entries(theirs[kind])) out[kind][where] = Math.max(out[kind][where] ?? 0, value);
  }
  for (const [where, one] of Object.entries(theirs.plays)) out.plays[where] = better(out.plays[where], one);
  const same = (/** @type {SavedLoop} */ a, /** @type {SavedLoop} */ b) => a.name === b.name && a.from === b.from && a.to === b.to;
  for (const one of theirs.loops) if (out.loops.length < MOST.loops && !out.loops.some((own) => same(own, one))) out.loops.push(one);
  return out;
}

/** @param {unknown} value @returns {Record<string, unknown>} */
const table = (value) =>
  value && typeof value === "object" && !Array.isArray(value) ? /** @type {Record<string, unknown>} */ (value) : {};
/** @param {unknown} value @param {number} low @param {number} high @returns {value is number} */
const within = (value, low, high) => typeof value === "number" && Number.isFinite(value) && value >= low && value <= high;
/** @param {unknown} value @returns {value is number} */
const count = (value) => Number.isInteger(value) && within(value, 0, 1e9);

/**
 * Return the valid parts of an unknown value as a record.
 * @param {unknown} value @returns {PracticeRecord}
 */
export function validRecord(value) {
  const { days, rows, loops, best, scores, plays, top } = table(value);
  const list = (/** @type {unknown} */ some, /** @type {number} */ most) => (Array.isArray(some) ? some.slice(-most) : []);
  const out = emptyRecord();
  if (within(top, 0, 100)) out.top = top;
  out.days = list(days, MOST.days)
    .map(table)
    .flatMap((one) => {
      const { day, feet } = one;
      if (typeof day !== "string" || !/^\d{4}-\d\d-\d\d$/.test(day) || !Number.isFinite(Date.parse(day))) return [];
      const counts = ["hit", "early", "late", "miss", "wrong"].map((name) => one[name]);
      const bins =
        Array.isArray(feet) &&
        feet.length === 2 &&
        feet.every((foot) => Array.isArray(foot) && foot.length === BINS && foot.every(count));
      if (!counts.every(count) || !bins) return [];
      const [hit, early, late, miss, wrong] = /** @type {number[]} */ (counts);
      return [{ day, hit, early, late, miss, wrong, feet: /** @type {[number[], number[]]} */ (feet) }];
    });
  for (const [row, one] of Object.entries(table(rows)).slice(0, MOST.rows)) {
    const { tries, misses, timed, sum, missed, rate } = table(one);
    if (
      !/^\d{1,6}$/.test(row) ||
      !count(tries) ||
      !count(misses) ||
      !count(timed) ||
      !within(sum, -1e9, 1e9) ||
      typeof missed !== "boolean" ||
      !within(rate, 0, 200)
    )
      continue;
    out.rows[row] = { tries, misses, timed, sum, missed, rate };
  }
  for (const { name, from, to, rate } of list(loops, MOST.loops).map(table)) {
    if (
      typeof name !== "string" ||
      !within(from, 0, MOST.beat) ||
      !within(to, 0, MOST.beat) ||
      to <= from ||
      !within(rate, 25, 200)
    )
      continue;
    out.loops.push({ name: name.slice(0, MOST.name), from, to, rate });
  }
  for (const [kind, some, low, high] of /** @type {["best" | "scores", unknown, number, number][]} */ ([
    ["best", best, 25, 200],
    ["scores", scores, 0, 100],
  ])) {
    for (const [where, value] of Object.entries(table(some)).slice(0, MOST.best)) {
      if (PART.test(where) && within(value, low, high)) out[kind][where] = value;
    }
  }
  for (const [where, one] of Object.entries(table(plays)).slice(0, MOST.best)) {
    const [score, rate] = list(one, 2);
    if (PART.test(where) && within(score, 0, 100) && within(rate, 25, 200)) out.plays[where] = [score, rate];
  }
  for (const [where, score] of Object.entries(out.scores)) out.plays[where] = better(out.plays[where], [score, 100]); // from an older page
  return out;
}

/** Return the text of a file with the records of charts. @param {Record<string, PracticeRecord>} charts */
export const toFile = (charts) => JSON.stringify({ format: FORMAT, version: 1, charts });

/**
 * Return the records in such a file; null if the text is not one.
 * @param {string} text @returns {Map<string, PracticeRecord> | null}
 */
export function fromFile(text) {
  try {
    const { format, version, charts } = table(JSON.parse(text));
    if (format !== FORMAT || version !== 1) return null;
    return new Map(
      Object.entries(table(charts))
        .filter(([id]) => id.length <= MOST.id)
        .slice(0, MOST.charts)
        .map(([id, one]) => [id, validRecord(one)]),
    );
  } catch {
    return null;
  }
}
