// The chart as the page uses it: notes, rows with their feet, beats.

import { lastUpTo } from "./maths.js";

export const KIND = { TAP: 1, HOLD: 2, ROLL: 3, MINE: 4, LIFT: 5, FAKE: 6 };
export const UNPLAYED = -2; // play.played.Limb: a note that nobody plays
const STEPS = [KIND.TAP, KIND.HOLD, KIND.ROLL, KIND.LIFT];
const ROLL_TAP = 5; // play.played.StepKind
const TICKS = 48;
/** Moves that a learner has to know: rows with one of them are "tricky". */
const TRICKY = [
  "half-turn-away",
  "half-turn-back",
  "half-turn",
  "crossover-half",
  "crossover-full",
  "spin",
  "doublestep",
  "jump-footswitch",
  "footswitch-up",
  "footswitch-down",
  "footswitch",
  "sideswitch-left",
  "sideswitch-right",
  "holdswitch",
  "bracket",
  "hand",
];

/**
 * @typedef {object} Step one panel of a row
 * @property {number} column
 * @property {number} limb 0 left foot, 1 right foot, 2 left hand, 3 right hand, -1 nobody, UNPLAYED
 * @property {number} part 0 whole foot, else heel or toe
 * @property {number} note index of its note
 */

/**
 * @typedef {object} Row
 * @property {number} row its number in the solver's play
 * @property {number} second
 * @property {number} beat
 * @property {Step[]} steps
 * @property {string[]} moves
 * @property {number} facing degrees, positive left
 * @property {[number, number]} feet panels of left and right foot after it, -1 none
 * @property {number} cost
 * @property {number} margin what other feet would cost more; -1: no other way
 * @property {boolean} tricky
 */

export class Chart {
  /** @param {import("./doc.js").PageDoc} doc @param {import("./blob.js").Arrays} arrays */
  constructor(doc, arrays) {
    this.second = /** @type {Float64Array} */ (arrays.get("note.second"));
    this.end = /** @type {Float64Array} */ (arrays.get("note.end"));
    this.tick = /** @type {Int32Array} */ (arrays.get("note.tick"));
    this.column = /** @type {Uint8Array} */ (arrays.get("note.column"));
    this.kind = /** @type {Uint8Array} */ (arrays.get("note.kind"));
    this.limb = /** @type {Int8Array} */ (arrays.get("note.limb"));
    this.quant = /** @type {Uint8Array} */ (arrays.get("note.quant"));
    this.judged = /** @type {Uint8Array} */ (arrays.get("note.judged"));
    this.player = /** @type {Uint8Array} */ (arrays.get("note.player")); // of a chart for two whose, 1 or 2; else 0
    this.beats = /** @type {number[]} */ (doc.beats);
    this.columns = doc.pad.panels.length;
    /** @type {Map<number, number>} limbs that the author gave to notes */
    this.given = new Map();
    /** @type {number[][]} notes that press a panel, by column */
    this.presses = Array.from({ length: this.columns }, () => []);
    for (let n = 0; n < this.second.length; ++n) {
      if (this.judged[n] && STEPS.includes(this.kind[n])) this.presses[this.column[n]]?.push(n);
    }
    this.starts = this.presses.map((notes) => notes.map((n) => this.second[n]));
    this.rows = this.readRows(doc, arrays);
    this.rowSeconds = this.rows.map((row) => row.second);
    this.first = this.rows.length ? this.rows[0].second : 0;
    this.last = Math.max(0, ...this.rows.map((row) => row.second), ...this.presses.flat().map((n) => this.end[n]));
  }

  /** @param {import("./doc.js").PageDoc} doc @param {import("./blob.js").Arrays} arrays @returns {Row[]} */
  readRows(doc, arrays) {
    const columns = this.columns;
    const steps = arrays.get("row.steps");
    const limbs = arrays.get("row.limb");
    const parts = arrays.get("row.part");
    const feet = arrays.get("row.feet");
    const seconds = arrays.get("row.second");
    const ticks = arrays.get("row.tick");
    const [facing, cost, margin] = ["facing", "cost", "margin"].map((name) => arrays.get(`row.${name}`));
    /** @type {Map<string, number>} */
    const notes = new Map();
    for (let n = 0; n < this.tick.length; ++n) {
      if (STEPS.includes(this.kind[n])) notes.set(`${this.tick[n]}:${this.column[n]}`, n);
    }
    const out = [];
    for (let row = 0; row < seconds.length; ++row) {
      /** @type {Step[]} */
      const here = [];
      for (let column = 0; column < columns; ++column) {
        const at = row * columns + column;
        if (!steps[at] || steps[at] === ROLL_TAP) continue;
        here.push({ column, limb: limbs[at], part: parts[at], note: notes.get(`${ticks[row]}:${column}`) ?? -1 });
      }
      if (!here.length) continue;
      const moves = doc.play.moves[row].map((/** @type {number} */ k) => doc.play.names[k]);
      out.push({
        row, second: seconds[row], beat: ticks[row] / TICKS, steps: here, moves, facing: facing[row],
        feet: /** @type {[number, number]} */ ([feet[2 * row], feet[2 * row + 1]]), cost: cost[row],
        margin: margin[row], tricky: moves.some((/** @type {string} */ name) => TRICKY.includes(name)),
      });
    }
    return out;
  }

  /**
   * The last note of a column pressed up to a second; -1 if there is none.
   * @param {number} column @param {number} second
   */
  lastPress(column, second) {
    const at = lastUpTo(this.starts[column], second);
    return at < 0 ? -1 : this.presses[column][at];
  }

  /** The beat at a second. @param {number} second */
  beatAt(second) {
    const beats = this.beats;
    const k = Math.min(Math.max(lastUpTo(beats, second), 0), beats.length - 2);
    const span = beats[k + 1] - beats[k];
    return span > 0 ? k + (second - beats[k]) / span : k;
  }

  /** The second of a beat. @param {number} beat */
  secondAt(beat) {
    const beats = this.beats;
    const k = Math.min(Math.max(Math.floor(beat), 0), beats.length - 2);
    return beats[k] + (beat - k) * (beats[k + 1] - beats[k]);
  }

  /** Number of the last row that has begun; -1 before the first. @param {number} second */
  rowAt(second) {
    return lastUpTo(this.rowSeconds, second + 1e-4);
  }
}
