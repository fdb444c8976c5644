// Playing along: verdicts of presses, waiting for rows, passes of a loop, the ramp of the speed, help that becomes less.

import { Coach } from "./coach.js";
import { Judge, ramp } from "./judge.js";
import { addClean, addOutcomes, addPlay, dayOf, scoreShare, whereOf } from "./record.js";
import { FEET, HELPS, saveNotes } from "./settings.js";

const KEYS_SHOWN = 5000; // milliseconds for which the keys are shown after a key that is no panel
export const SHOWN = 400; // milliseconds in which a verdict above the receptors fades
const LOST = 10; // notes missed in a row after which something easier is offered
const MARKS = 24; // presses on the scale of errors

/**
 * @typedef {{verdict: string, column: number, at: number, run: number, error: number | undefined}} Feedback
 * of the last press, or of a miss (column -1); at: ms; run: notes in a row; error: seconds late
 */

const EARLY = 0.2; // seconds before a row from which its press counts while the clock waits for rows

export class Practice {
  /** @param {import("./app.js").App} app */
  constructor(app) {
    this.app = app;
    this.judge = new Judge(app.chart);
    this.coach = new Coach(app, this);
    this.along = false; // whether the user plays along
    this.wait = false; // whether the clock stops at each row until it is pressed
    this.passes = 0;
    this.helpNow = 0; // index in HELPS of the present help, while the setting is "auto"
    this.chosenRate = 1; // the speed that the user chose, from which the ramp begins
    /** @type {import("./judge.js").Tally | null} the tally of the pass before */
    this.before = null;
    /** @type {number[]} scores of the passes of this loop, 0..1 */
    this.scores = [];
    this.rateBefore = 0; // the speed before the last change by the ramp or the coach; 0 if they changed nothing
    /** @type {number[]} how late the last presses were, seconds */
    this.errors = [];
    /** @type {import("./judge.js").Tally | null} the tally of a song that has ended */
    this.over = null;
    /** @type {"" | "now" | "shown"} whether the keys are or were shown because a key that is no panel was pressed */
    this.unknownKey = "";
    this.unknownKeyAt = 0; // milliseconds
    this.idleNotice = ""; // the notice that a press was not judged
    /** @type {Feedback | null} */
    this.feedback = null;
    this.run = 0; // notes in a row without a miss or a wrong press
    this.longest = 0; // the longest such run
    this.lost = 0; // notes missed in a row
    this.topBefore = 0; // % of the best play before this one
  }

  /** Whether so many notes were missed in a row that the page offers something easier. */
  get struggles() {
    return this.lost >= LOST && !this.wait && !this.coach.on && this.app.transport.playing;
  }

  /** Count the verdicts in the loop, or in the whole song, from the first judged row on. */
  tally() {
    const { loop } = this.app.transport;
    return this.judge.tally(Math.max(loop ? loop.a : -Infinity, this.judge.from), loop ? loop.b : Infinity);
  }

  /** End the ramp: go back to the speed that the user chose. */
  endRamp() {
    const { transport } = this.app;
    this.passes = 0;
    this.before = null;
    this.scores = [];
    this.rateBefore = 0;
    this.coach.on = false;
    if (transport.rate === this.chosenRate) return;
    transport.setRate(this.chosenRate);
    this.app.tell("rate");
  }

  /** Evaluate a pass of the loop that has just ended. */
  pass() {
    const { transport, settings } = this.app;
    const { loop } = transport;
    if (!loop) return;
    if (!this.wait) this.judge.advance(Infinity, transport.rate, loop.b);
    this.before = this.along ? this.tally() : null;
    const slips = this.before ? this.before.miss + this.before.wrong : 0;
    ++this.passes;
    // A pass that was begun in its middle, or in which nothing was pressed, does not count.
    const idle = this.before !== null && (this.judge.from > loop.a || (!this.wait && isIdle(this.before)));
    if (this.before && !idle) this.scores.push(scoreShare(this.before));
    if (this.before && !this.wait) {
      if (!idle) this.recordPart(loop, this.before);
      this.recordOutcomes();
    }
    if (!idle) this.rateBefore = transport.rate;
    if (this.coach.on && this.before && !this.wait) {
      if (!idle) this.coach.pass(this.before);
    } else if (settings.ramp && !idle) transport.rate = ramp(transport.rate, slips, this.along);
    if (settings.help === "auto" && this.along && !idle) {
      this.helpNow = Math.min(Math.max(this.helpNow + (slips ? -1 : 1), 0), 2);
    }
    this.app.tell("pass");
    if (this.along) this.restart(transport.loop?.a ?? loop.a); // the coach may have gone on to another loop
    this.updateHold();
  }

  /**
   * Record the result of a part of the song, if both feet were played.
   * @param {{a: number, b: number}} part seconds @param {import("./judge.js").Tally} tally
   */
  recordPart({ a, b }, tally) {
    const { chart, record } = this.app;
    const { foot, slowest } = this.judge;
    if (foot >= 0) return;
    const where = whereOf(chart.beatAt(a), chart.beatAt(b));
    if (!tally.miss && !tally.wrong) addClean(record, where, slowest);
    addPlay(record, where, scoreShare(tally), slowest);
  }

  /** Record the results of notes, unless the clock waited for rows or nothing was pressed. */
  recordOutcomes() {
    const { outcomes, wrong } = this.judge.takeOutcomes();
    if (this.wait || (!wrong && outcomes.every(({ verdict }) => verdict === "miss"))) return;
    addOutcomes(this.app.record, dayOf(new Date()), outcomes, wrong, this.judge.slowest);
    this.app.saveRecord();
  }

  /** Choose whether one foot is practised or both; the page plays the other one. @param {string} foot of FEET */
  setFoot(foot) {
    this.recordOutcomes();
    this.app.notes.foot = foot;
    this.judge.foot = FEET.indexOf(foot) - 1;
    saveNotes(this.app.id, this.app.notes);
    if (foot !== "both" && !this.along) this.setAlong(true);
    this.restart(this.app.transport.second());
    this.updateHold();
    this.app.tell("along");
  }

  /** Begin or stop to play along. @param {boolean} on */
  setAlong(on) {
    this.recordOutcomes();
    if (!on) this.coach.on = false;
    if (on && this.saysIdle) this.app.notice = "";
    this.along = on;
    this.before = null;
    this.unknownKey = "";
    this.feedback = null;
    this.errors = [];
    if (!on) this.wait = false;
    this.lost = 0;
    this.judge.restart(on ? this.app.transport.second() : -Infinity);
    if (!on) this.judge.verdicts.clear();
    this.updateHold();
    this.app.tell("along");
  }

  /**
   * Let the clock wait for rows, or not; judge again, because presses while it waits are not in time.
   * @param {boolean} on
   */
  setWait(on) {
    this.recordOutcomes();
    if (on && !this.along) this.setAlong(true);
    this.wait = on;
    this.lost = 0;
    if (this.along) this.restart(this.app.transport.second());
    this.updateHold();
    this.app.tell("along");
  }

  /** Judge again from a second on, in a loop from its beginning at the earliest. @param {number} second */
  restart(second) {
    const { loop } = this.app.transport;
    this.over = null;
    this.run = 0;
    this.feedback = null;
    if (!loop) [this.longest, this.errors] = [0, []];
    this.recordOutcomes();
    this.judge.restart(loop && second < loop.b ? Math.max(second, loop.a) : second);
    this.app.tell("hits");
  }

  /** While the clock waits for rows, stop it at the first row that is not pressed. */
  updateHold() {
    const { transport } = this.app;
    const row = this.wait ? this.judge.nextOpenRow(-Infinity) : null;
    const { loop } = transport; // the clock waits for no row after the end of a loop, because the loop repeats
    transport.holdAt(row && !(loop && row.second >= loop.b) ? row.second : Infinity);
  }

  /** Judge the press of a panel. @param {number} column @param {number} ago seconds since the press */
  press(column, ago) {
    if (!this.along) return;
    const { transport, sound, settings } = this.app;
    const { rate } = transport;
    if (!transport.playing) return this.idle();
    if (this.unknownKey === "now") this.unknownKey = "shown";
    if (this.wait) {
      const row = this.judge.nextOpenRow(-Infinity);
      if (!row || row.second - transport.second() > EARLY * rate) return;
      this.show(this.judge.press(column, row.second, rate, true), column);
      this.updateHold();
    } else {
      this.show(this.judge.press(column, transport.second() - (ago + sound.latency + settings.latency) * rate, rate), column);
    }
    this.app.tell("hits");
  }

  /** Count misses up to the second that is seen. @param {number} second */
  advance(second) {
    const { transport, settings } = this.app;
    if (!transport.playing || !this.along || this.wait) return;
    const missed = this.judge.advance(second - (settings.latency + settings.sight) * transport.rate, transport.rate);
    if (!missed) return;
    this.lost += missed;
    this.show("miss", -1);
    this.app.tell("hits");
  }

  /**
   * Show a verdict for a moment.
   * @param {string | null} verdict null: the press does not count @param {number} column
   */
  show(verdict, column) {
    if (!verdict) return;
    this.run = verdict === "miss" || verdict === "wrong" ? 0 : this.run + 1;
    this.longest = Math.max(this.longest, this.run);
    if (this.run) this.lost = 0;
    const error = verdict === "miss" || verdict === "wrong" ? undefined : this.judge.lastError;
    if (error !== undefined) this.errors = [...this.errors, error].slice(-MARKS);
    this.feedback = { verdict, column, at: performance.now(), run: this.run, error };
  }

  /** Return the verdict that is shown now; delete it after `SHOWN` milliseconds. */
  shown() {
    if (this.feedback && performance.now() - this.feedback.at > SHOWN) this.feedback = null;
    return this.feedback;
  }

  /** Show a notice that a press is not judged, because the user does not play along or the song is paused. */
  idle() {
    const {
      t,
      input: { keyless },
    } = this.app;
    this.app.notice = this.along
      ? t("paused", { keys: keyless ? "▶" : `▶ (${t("space")})` })
      : t("padIdle", { key: keyless ? "" : " (p)" });
    this.idleNotice = this.app.notice;
    this.unknownKeyAt = performance.now();
    this.app.tell("along");
  }

  /** Whether the notice of `idle` is shown now. */
  get saysIdle() {
    return this.idleNotice !== "" && this.app.notice === this.idleNotice;
  }

  /** Show the keys of the panels, because a key was pressed that is no panel; only the first time. */
  showKeys() {
    if (this.unknownKey) return;
    this.unknownKey = "now";
    this.unknownKeyAt = performance.now();
    this.app.tell("along");
  }

  /** Hide the keys of the panels, or the notice of `idle`, after `KEYS_SHOWN` milliseconds. */
  fade() {
    if ((this.unknownKey !== "now" && !this.saysIdle) || performance.now() - this.unknownKeyAt < KEYS_SHOWN) return;
    if (this.saysIdle) this.app.notice = "";
    else this.unknownKey = "shown";
    this.app.tell("along");
  }

  /** Evaluate the song at its end; the result is shown until the user goes on. */
  finish() {
    if (!this.along) return this.app.rewind();
    this.judge.advance(Infinity, this.app.transport.rate);
    this.lost = 0;
    this.over = this.tally();
    this.topBefore = this.app.record.top;
    const whole = this.judge.from <= this.app.chart.first && this.judge.foot < 0 && !this.wait && !isIdle(this.over);
    if (whole && this.judge.slowest >= 1) this.app.record.top = Math.max(this.topBefore, Math.round(100 * scoreShare(this.over)));
    for (const { start, end } of this.wait ? [] : this.app.doc.passages) {
      const tally = this.judge.tally(start, end);
      if (this.judge.from <= start + 1e-3 && !isIdle(tally)) this.recordPart({ a: start, b: end }, tally);
    }
    this.recordOutcomes();
    this.app.tell("hits");
  }

  /** The level of help that holds now: "all", "tricky" or "none". */
  get help() {
    return this.app.settings.help === "auto" ? HELPS[this.helpNow] : this.app.settings.help;
  }

  /** Whether the foot of a row is shown. @param {import("./chart.js").Row | undefined} row */
  tells(row) {
    return this.help === "all" || (this.help === "tricky" && Boolean(row?.tricky));
  }
}

/** Whether nothing was pressed. @param {import("./judge.js").Tally} tally */
const isIdle = ({ hit, early, late, wrong }) => hit + early + late + wrong === 0;
