// Judges whether panels are pressed in time. A pad knows panels, not feet, so nobody can tell which foot it was.

/** Seconds of real time around a note in which a press counts. */
export const WINDOW = 0.135;
export const GOOD = 0.045; // within: a hit; beyond: early or late
const SAME = 2e-3; // seconds within which notes are of one row

/** @typedef {"hit" | "early" | "late" | "miss"} Verdict */
/** @typedef {{hit: number, early: number, late: number, miss: number, wrong: number, sum: number, count: number}} Tally */

export class Judge {
  /** @param {import("./chart.js").Chart} chart */
  constructor(chart) {
    this.chart = chart;
    /** @type {Map<number, Verdict>} by note */
    this.verdicts = new Map();
    /** @type {Map<number, number>} seconds that a note was pressed late, by note */
    this.errors = new Map();
    /** @type {number[]} seconds of presses of a panel without a note */
    this.wrong = [];
    /** @type {Map<number, {row: number, limb: number, measure: number}>} the solver's row and foot of each note */
    this.stepOf = new Map(
      chart.rows.flatMap((row) =>
        row.steps.map(({ note, limb }) => [note, { row: row.row, limb, measure: Math.floor(row.beat / 4 + 1e-6) }]),
      ),
    );
    this.next = 0; // first row that may still be missed
    this.from = -Infinity; // rows before this second are not judged
    this.slowest = Infinity; // the slowest rate since the first judged row
    /** @type {number} the foot that is practised, 0 left or 1 right; -1: both */
    this.foot = -1;
    /** @type {import("./record.js").Outcome[]} results of notes since the last `takeOutcomes` */
    this.outcomes = [];
    this.slips = 0; // wrong presses since the last `takeOutcomes`
    /** @type {number | undefined} how late the last press of a note was, seconds; undefined while the clock waits for rows */
    this.lastError = undefined;
  }

  /** Whether a note is judged: while one foot is practised, the other foot's notes are not. @param {number} note */
  asks(note) {
    return this.foot < 0 || this.limbOf(note) === this.foot;
  }

  /** The limb that steps a note, -1 if unknown. @param {number} note */
  limbOf(note) {
    return this.chart.given.get(note) ?? this.stepOf.get(note)?.limb ?? -1;
  }

  /** Return the results of notes and the number of wrong presses since the last call. */
  takeOutcomes() {
    const out = { outcomes: this.outcomes, wrong: this.slips };
    [this.outcomes, this.slips] = [[], 0];
    return out;
  }

  /** Set the verdict of a note. @param {number} note @param {Verdict} verdict @param {number} [error] seconds */
  settle(note, verdict, error) {
    this.verdicts.set(note, verdict);
    if (error !== undefined) this.errors.set(note, error);
    const { row = -1, measure = -1 } = this.stepOf.get(note) ?? {};
    this.outcomes.push({ row, measure, limb: this.limbOf(note), verdict, error });
  }

  /** Judge again from a second on: the verdicts of its notes and of later ones are deleted. @param {number} second */
  restart(second) {
    this.from = second - 1e-3;
    this.next = 0;
    this.slowest = Infinity;
    this.wrong = this.wrong.filter((at) => at < this.from);
    while (this.next < this.chart.rows.length && this.chart.rowSeconds[this.next] < this.from) ++this.next;
    for (const row of this.chart.rows.slice(this.next)) {
      for (const step of row.steps) {
        this.verdicts.delete(step.note);
        this.errors.delete(step.note);
      }
    }
  }

  /**
   * Note the rate of the music for `slowest`, unless it is before the first judged row.
   * @param {number} second @param {number} rate
   */
  countRate(second, rate) {
    const first = this.chart.rowSeconds.find((one) => one >= this.from) ?? Infinity;
    if (second >= first - WINDOW * rate) this.slowest = Math.min(this.slowest, rate);
  }

  /**
   * Judge the press of a panel at a second of the music. Returns null if the press does not count.
   * @param {number} column @param {number} second @param {number} rate @param {boolean} [patient] whether the clock waits for rows
   * @returns {Verdict | "wrong" | null}
   */
  press(column, second, rate, patient = false) {
    let best = -1;
    const reach = patient ? SAME : WINDOW * rate; // while the clock waits for a row, only its own panels count
    let least = reach;
    for (const n of this.chart.presses[column] ?? []) {
      const away = Math.abs(this.chart.second[n] - second);
      if (this.chart.second[n] > second + least) break;
      if (away <= least && !this.verdicts.has(n) && this.asks(n) && this.chart.second[n] >= this.from) [best, least] = [n, away];
    }
    if (best < 0) return this.pressWithoutNote(column, second, reach);
    const error = (second - this.chart.second[best]) / rate;
    const verdict = patient || Math.abs(error) <= GOOD ? "hit" : error < 0 ? "early" : "late";
    this.lastError = patient ? undefined : error;
    this.slowest = Math.min(this.slowest, rate);
    this.settle(best, verdict, this.lastError);
    return verdict;
  }

  /**
   * Judge a press without an open note: it is wrong, unless the panel has a judged note or a hold at this time.
   * @param {number} column @param {number} second @param {number} wide seconds around a note in which a press of its panel is not wrong
   */
  pressWithoutNote(column, second, wide) {
    const { second: starts, end: ends } = this.chart;
    const asked = (this.chart.presses[column] ?? []).some((n) => starts[n] - wide <= second && second <= ends[n] + wide);
    if (asked || second < this.from - wide) return null;
    this.wrong.push(second);
    ++this.slips;
    return /** @type {const} */ ("wrong");
  }

  /**
   * Count the notes that can no longer be hit as misses.
   * @param {number} second @param {number} rate @param {number} [end] of the loop: later rows are not judged
   * @returns {number} number of new misses
   */
  advance(second, rate, end = Infinity) {
    this.countRate(Math.min(second, end), rate);
    let missed = 0;
    while (this.next < this.chart.rows.length && this.chart.rowSeconds[this.next] < Math.min(second - WINDOW * rate, end - 1e-3)) {
      for (const step of this.chart.rows[this.next].steps) {
        if (step.limb < 0 || this.verdicts.has(step.note) || !this.asks(step.note)) continue;
        this.settle(step.note, "miss");
        ++missed;
      }
      ++this.next;
    }
    return missed;
  }

  /**
   * Return the first row from a second on with a note that has no verdict yet; null if there is none.
   * @param {number} second @returns {import("./chart.js").Row | null}
   */
  nextOpenRow(second) {
    for (let k = 0; k < this.chart.rows.length; ++k) {
      if (this.chart.rowSeconds[k] < Math.max(second, this.from) - 1e-3) continue;
      if (this.chart.rows[k].steps.some((step) => !this.verdicts.has(step.note) && this.asks(step.note))) return this.chart.rows[k];
    }
    return null;
  }

  /**
   * Count the verdicts between two seconds of the music.
   * @param {number} from @param {number} to @returns {Tally}
   */
  tally(from, to) {
    const wrong = this.wrong.filter((at) => from - 1e-3 <= at && at < to).length;
    const out = { hit: 0, early: 0, late: 0, miss: 0, wrong, sum: 0, count: 0 };
    for (const [n, verdict] of this.verdicts) {
      if (this.chart.second[n] < from - 1e-3 || this.chart.second[n] >= to) continue;
      ++out[verdict];
      const error = this.errors.get(n);
      if (error === undefined) continue;
      out.sum += error;
      ++out.count;
    }
    return out;
  }
}

/**
 * Return the speed of the next pass of a loop: faster after a clean pass, slower after misses and wrong presses.
 * @param {number} rate @param {number} misses @param {boolean} played whether the user played along
 */
export function ramp(rate, misses, played) {
  const step = played && misses > 0 ? -0.05 : 0.05;
  return Math.min(Math.max(Math.round((rate + step) * 100) / 100, 0.25), Math.max(rate, 1));
}
