// Practising: who plays along, what was hit, rows that are waited for, passes of a loop, the ramp, help that fades.

import { Coach } from "./coach.js";
import { Judge, ramp } from "./judge.js";
import { addClean, addOutcomes, addPlay, dayOf, scoreShare, whereOf } from "./record.js";
import { FEET, HELPS, saveNotes } from "./settings.js";

const STRAY = 5000; // milliseconds for which the keys are shown
export const SHOWN = 400; // milliseconds in which a verdict above the receptors fades
const LOST = 10; // notes missed in a row after which something easier is offered
const MARKS = 24; // presses on the scale of errors

/** @typedef {{verdict: string, column: number, at: number, run: number, error: number | undefined}} Feedback of the last press, or of a miss (column -1); at: ms; run: notes in a row; error: seconds late */

const EARLY = 0.2; // seconds before a row from which its press counts while the clock waits for rows

export class Practice {
  /** @param {import("./app.js").App} app */
  constructor(app) {
    this.app = app;
    this.judge = new Judge(app.chart);
    this.coach = new Coach(app, this);
    this.along = false; // somebody plays along
    this.wait = false; // the clock stops at each row until it is pressed
    this.passes = 0;
    this.helpNow = 0; // place in HELPS that "auto" has come to
    this.chosenRate = 1; // the speed that was asked for; the ramp only goes on from it
    /** @type {import("./judge.js").Tally | null} of the pass before */
    this.before = null;
    /** @type {number[]} scores of the passes of this loop, 0..1 */
    this.scores = [];
    this.rateBefore = 0; // the speed before the ramp or the coach changed it last; 0: they have not
    /** @type {number[]} how late the last presses were, seconds */
    this.errors = [];
    /** @type {import("./judge.js").Tally | null} of a song that has come to its end */
    this.over = null;
    /** @type {"" | "now" | "shown"} whether a key was pressed that is no panel: once, the keys are shown then */
    this.stray = "";
    this.strayAt = 0; // milliseconds
    this.idleNotice = ""; // the notice of a press that nothing judged
    /** @type {Feedback | null} */
    this.feedback = null;
    this.run = 0; // notes in a row without a miss or a wrong press
    this.longest = 0; // the longest such run
    this.lost = 0; // notes missed in a row
    this.topBefore = 0; // % of the best play before this one
  }

  /** Whether it is too hard as it is: something easier is offered. */
  get struggles() {
    return this.lost >= LOST && !this.wait && !this.coach.on && this.app.transport.playing;
  }

  /** What was hit in the loop, or in all, since rows are asked for. */
  tally() {
    const { loop } = this.app.transport;
    return this.judge.tally(Math.max(loop ? loop.a : -Infinity, this.judge.from), loop ? loop.b : Infinity);
  }

  /** The speed is the one that was asked for again: the ramp, or its loop, is over. */
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

  /** A pass of the loop is over. */
  pass() {
    const { transport, settings } = this.app;
    const { loop } = transport;
    if (!loop) return;
    if (!this.wait) this.judge.advance(Infinity, transport.rate, loop.b);
    this.before = this.along ? this.tally() : null;
    const slips = this.before ? this.before.miss + this.before.wrong : 0;
    ++this.passes;
    // Begun in its middle, or nobody plays: nothing is to be learnt of it.
    const idle = this.before !== null && (this.judge.from > loop.a || (!this.wait && isIdle(this.before)));
    if (this.before && !idle) this.scores.push(scoreShare(this.before));
    if (this.before && !this.wait) {
      if (!idle) this.keepPart(loop, this.before);
      this.keep();
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

  /** How a part of the song went, if both feet played it. @param {{a: number, b: number}} part seconds @param {import("./judge.js").Tally} tally */
  keepPart({ a, b }, tally) {
    const { chart, record } = this.app;
    const { foot, slowest } = this.judge;
    if (foot >= 0) return;
    const where = whereOf(chart.beatAt(a), chart.beatAt(b));
    if (!tally.miss && !tally.wrong) addClean(record, where, slowest);
    addPlay(record, where, scoreShare(tally), slowest);
  }

  /** What came of notes goes into the record; while the clock waits, or nobody presses anything, there is nothing to keep. */
  keep() {
    const { outcomes, wrong } = this.judge.take();
    if (this.wait || (!wrong && outcomes.every(({ verdict }) => verdict === "miss"))) return;
    addOutcomes(this.app.record, dayOf(new Date()), outcomes, wrong, this.judge.slowest);
    this.app.saveRecord();
  }

  /** One foot is practised, the other one is played for you; or both are. @param {string} foot of FEET */
  setFoot(foot) {
    this.keep();
    this.app.notes.foot = foot;
    this.judge.foot = FEET.indexOf(foot) - 1;
    saveNotes(this.app.id, this.app.notes);
    if (foot !== "both" && !this.along) this.setAlong(true);
    this.restart(this.app.transport.second());
    this.updateHold();
    this.app.tell("along");
  }

  /** Play along, or only watch. @param {boolean} on */
  setAlong(on) {
    this.keep();
    if (!on) this.coach.on = false;
    if (on && this.saysIdle) this.app.notice = "";
    this.along = on;
    this.before = null;
    this.stray = "";
    this.feedback = null;
    this.errors = [];
    if (!on) this.wait = false;
    this.lost = 0;
    this.judge.restart(on ? this.app.transport.second() : -Infinity);
    if (!on) this.judge.verdicts.clear();
    this.updateHold();
    this.app.tell("along");
  }

  /** What was pressed while the clock waited is not in time: rows are asked for anew on both ways. @param {boolean} on */
  setWait(on) {
    this.keep();
    if (on && !this.along) this.setAlong(true);
    this.wait = on;
    this.lost = 0;
    if (this.along) this.restart(this.app.transport.second());
    this.updateHold();
    this.app.tell("along");
  }

  /** Rows from a second on are asked for anew, in a loop not those before it. @param {number} second */
  restart(second) {
    const { loop } = this.app.transport;
    this.over = null;
    this.run = 0;
    this.feedback = null;
    if (!loop) [this.longest, this.errors] = [0, []];
    this.keep();
    this.judge.restart(loop && second < loop.b ? Math.max(second, loop.a) : second);
    this.app.tell("hits");
  }

  /** While the clock waits for rows it does not pass the first one that is not pressed. */
  updateHold() {
    const { transport } = this.app;
    const row = this.wait ? this.judge.open(-Infinity) : null;
    const { loop } = transport; // beyond its end nothing is waited for: it begins anew
    transport.holdAt(row && !(loop && row.second >= loop.b) ? row.second : Infinity);
  }

  /** A panel is pressed, some seconds ago. @param {number} column @param {number} ago */
  press(column, ago) {
    if (!this.along) return;
    const { transport, sound, settings } = this.app;
    const { rate } = transport;
    if (!transport.playing) return this.idle();
    if (this.stray === "now") this.stray = "shown";
    if (this.wait) {
      const row = this.judge.open(-Infinity);
      if (!row || row.second - transport.second() > EARLY * rate) return;
      this.show(this.judge.press(column, row.second, rate, true), column);
      this.updateHold();
    } else {
      this.show(this.judge.press(column, transport.second() - (ago + sound.latency + settings.latency) * rate, rate), column);
    }
    this.app.tell("hits");
  }

  /** Rows that are over by the second that is seen are missed. @param {number} second */
  advance(second) {
    const { transport, settings } = this.app;
    if (!transport.playing || !this.along || this.wait) return;
    const missed = this.judge.advance(second - (settings.latency + settings.sight) * transport.rate, transport.rate);
    if (!missed) return;
    this.lost += missed;
    this.show("miss", -1);
    this.app.tell("hits");
  }

  /** A verdict is shown for a moment. @param {string | null} verdict null: neither here nor there @param {number} column */
  show(verdict, column) {
    if (!verdict) return;
    this.run = verdict === "miss" || verdict === "wrong" ? 0 : this.run + 1;
    this.longest = Math.max(this.longest, this.run);
    if (this.run) this.lost = 0;
    const error = verdict === "miss" || verdict === "wrong" ? undefined : this.judge.lastError;
    if (error !== undefined) this.errors = [...this.errors, error].slice(-MARKS);
    this.feedback = { verdict, column, at: performance.now(), run: this.run, error };
  }

  /** The verdict that is shown now; what is no longer is forgotten. */
  shown() {
    if (this.feedback && performance.now() - this.feedback.at > SHOWN) this.feedback = null;
    return this.feedback;
  }

  /** A panel was pressed that nothing judges, for nobody plays along or nothing plays: a notice says so. */
  idle() {
    const { t, input: { keyless } } = this.app;
    this.app.notice = this.along ? t("paused", { keys: keyless ? "▶" : `▶ (${t("space")})` }) : t("padIdle", { key: keyless ? "" : " (p)" });
    this.idleNotice = this.app.notice;
    this.strayAt = performance.now();
    this.app.tell("along");
  }

  /** Whether that notice is shown now. */
  get saysIdle() {
    return this.idleNotice !== "" && this.app.notice === this.idleNotice;
  }

  /** A key was pressed that is no panel. */
  strayKey() {
    if (this.stray) return;
    this.stray = "now";
    this.strayAt = performance.now();
    this.app.tell("along");
  }

  /** The keys, or that nothing is judged, have been shown for long enough. */
  fade() {
    if ((this.stray !== "now" && !this.saysIdle) || performance.now() - this.strayAt < STRAY) return;
    if (this.saysIdle) this.app.notice = "";
    else this.stray = "shown";
    this.app.tell("along");
  }

  /** The song is over: how it went is shown until somebody goes on. */
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
      if (this.judge.from <= start + 1e-3 && !isIdle(tally)) this.keepPart({ a: start, b: end }, tally);
    }
    this.keep();
    this.app.tell("hits");
  }

  /** The level of help that holds now: "all", "tricky" or "none". */
  get help() {
    return this.app.settings.help === "auto" ? HELPS[this.helpNow] : this.app.settings.help;
  }

  /** Whether the foot of a note is told. @param {import("./chart.js").Row | undefined} row */
  tells(row) {
    return this.help === "all" || (this.help === "tricky" && Boolean(row?.tricky));
  }
}

/** Whether nobody pressed anything. @param {import("./judge.js").Tally} tally */
const isIdle = ({ hit, early, late, wrong }) => hit + early + late + wrong === 0;
