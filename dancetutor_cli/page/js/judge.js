// Whether panels are pressed in time. A pad knows panels, not feet: which foot it was nobody can tell.

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
    /** @type {number[]} seconds at which a panel was pressed that nothing asks for */
    this.wrong = [];
    /** @type {Map<number, {row: number, limb: number, measure: number}>} the solver's row and foot of each note */
    this.stepOf = new Map(chart.rows.flatMap((row) => row.steps.map(({ note, limb }) => [note, { row: row.row, limb, measure: Math.floor(row.beat / 4 + 1e-6) }])));
    this.next = 0; // first row that may still be missed
    this.from = -Infinity; // rows before it are not asked for
    this.slowest = Infinity; // the slowest rate since the first row after it
    /** @type {number} the foot that is practised, 0 left or 1 right; -1: both */
    this.foot = -1;
    /** @type {import("./record.js").Outcome[]} what came of notes since it was taken last */
    this.outcomes = [];
    this.slips = 0; // wrong presses since then
    /** @type {number | undefined} seconds that the last press that took a note was late; none where the clock waits */
    this.lastError = undefined;
  }

  /** Whether a note is asked for: the other foot's are not when one foot is practised. @param {number} note */
  asks(note) {
    return this.foot < 0 || this.limbOf(note) === this.foot;
  }

  /** Who steps a note. @param {number} note */
  limbOf(note) {
    return this.chart.given.get(note) ?? this.stepOf.get(note)?.limb ?? -1;
  }

  /** What came of notes since the last time. */
  take() {
    const out = { outcomes: this.outcomes, wrong: this.slips };
    [this.outcomes, this.slips] = [[], 0];
    return out;
  }

  /** @param {number} note @param {Verdict} verdict @param {number} [error] seconds */
  settle(note, verdict, error) {
    this.verdicts.set(note, verdict);
    if (error !== undefined) this.errors.set(note, error);
    const { row = -1, measure = -1 } = this.stepOf.get(note) ?? {};
    this.outcomes.push({ row, measure, limb: this.limbOf(note), verdict, error });
  }

  /** Begin at a second: notes from there on are open again. @param {number} second */
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

  /** The music goes at a rate; slow practice before the first row that is asked for does not count. @param {number} second @param {number} rate */
  noteRate(second, rate) {
    const first = this.chart.rowSeconds.find((one) => one >= this.from) ?? Infinity;
    if (second >= first - WINDOW * rate) this.slowest = Math.min(this.slowest, rate);
  }

  /**
   * A panel is pressed at a second of the music; what it counts as, null if it is neither here nor there.
   * @param {number} column @param {number} second @param {number} rate @param {boolean} [patient] the clock waits
   * @returns {Verdict | "wrong" | null}
   */
  press(column, second, rate, patient = false) {
    let best = -1;
    const reach = patient ? SAME : WINDOW * rate; // who waits for a row asks for its panels only
    let least = reach;
    for (const n of this.chart.presses[column] ?? []) {
      const away = Math.abs(this.chart.second[n] - second);
      if (this.chart.second[n] > second + least) break;
      if (away <= least && !this.verdicts.has(n) && this.asks(n) && this.chart.second[n] >= this.from) [best, least] = [n, away];
    }
    if (best < 0) return this.stray(column, second, reach);
    const error = (second - this.chart.second[best]) / rate;
    const verdict = patient || Math.abs(error) <= GOOD ? "hit" : error < 0 ? "early" : "late";
    this.lastError = patient ? undefined : error;
    this.slowest = Math.min(this.slowest, rate);
    this.settle(best, verdict, this.lastError);
    return verdict;
  }

  /**
   * A press that takes no note: wrong, but for a panel pressed again, or that is held down just now.
   * @param {number} column @param {number} second @param {number} wide seconds around a note in which its panel is asked for
   */
  stray(column, second, wide) {
    const { second: starts, end: ends } = this.chart;
    const asked = (this.chart.presses[column] ?? []).some((n) => starts[n] - wide <= second && second <= ends[n] + wide);
    if (asked || second < this.from - wide) return null;
    this.wrong.push(second);
    ++this.slips;
    return /** @type {const} */ ("wrong");
  }

  /**
   * Rows that are over become misses.
   * @param {number} second @param {number} rate @param {number} [end] of the loop: rows from there on are not asked for
   * @returns {number} how many notes were missed now
   */
  advance(second, rate, end = Infinity) {
    this.noteRate(Math.min(second, end), rate);
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
   * The first row from a second on that has a panel not pressed yet, and its second.
   * @param {number} second @returns {import("./chart.js").Row | null}
   */
  open(second) {
    for (let k = 0; k < this.chart.rows.length; ++k) {
      if (this.chart.rowSeconds[k] < Math.max(second, this.from) - 1e-3) continue;
      if (this.chart.rows[k].steps.some((step) => !this.verdicts.has(step.note) && this.asks(step.note))) return this.chart.rows[k];
    }
    return null;
  }

  /**
   * What happened between two seconds of the music.
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
 * The speed of the next pass of a loop: quicker after a clean one, a step back after misses and wrong presses.
 * @param {number} rate @param {number} misses @param {boolean} played whether anybody played along
 */
export function ramp(rate, misses, played) {
  const step = played && misses > 0 ? -0.05 : 0.05;
  return Math.min(Math.max(Math.round((rate + step) * 100) / 100, 0.25), Math.max(rate, 1));
}
