// The coach: loops stretches with misses, and changes the speed by the score until full speed is passed.

import { FIRST, PASSED, coachRate, missedOf, scoreShare, whereOf } from "./record.js";

const FULL = 1; // the speed that is the goal

/**
 * @typedef {{from: number, to: number, rate: number, passed: boolean}} Target
 * A stretch to practise. from, to : beats; rate : the first speed; passed : whether it was passed at this speed
 */

export class Coach {
  /** @param {import("./app.js").App} app @param {import("./practice.js").Practice} practice */
  constructor(app, practice) {
    this.app = app;
    this.practice = practice;
    this.on = false;
    this.message = ""; // the comment on the pass before
  }

  /**
   * Return what to practise next: a stretch with misses, else the hardest passage not passed at full speed.
   * @returns {Target | null}
   */
  next() {
    const { record, chart, doc } = this.app;
    const [missed] = missedOf(record, chart.rows);
    if (missed) return missed;
    for (const { start, end } of doc.passages) {
      const [from, to] = [chart.beatAt(start), chart.beatAt(end)];
      const best = (record.best[whereOf(from, to)] ?? 0) / 100;
      if (best < FULL) return { from, to, rate: best || FIRST, passed: best > 0 };
    }
    return null;
  }

  /** Return the present loop, with the speed at which it was passed; null without a loop. @returns {Target | null} */
  looped() {
    const { transport: { loop }, chart, record } = this.app;
    if (!loop) return null;
    const [from, to] = [chart.beatAt(loop.a), chart.beatAt(loop.b)];
    const same = missedOf(record, chart.rows).find((one) => whereOf(one.from, one.to) === whereOf(from, to));
    const best = (record.best[whereOf(from, to)] ?? 0) / 100;
    return same ?? { from, to, rate: best || FIRST, passed: best > 0 };
  }

  /** Begin. @param {Target | null} [target] by default the present loop, else what is next */
  async start(target = this.looped()) {
    const { app, practice } = this;
    practice.recordOutcomes();
    const found = target ?? this.next();
    if (!found) {
      app.notice = app.t("coachNothing");
      return app.tell("coach");
    }
    practice.setWait(false); // no pass counts while the clock waits for rows
    if (!practice.along) practice.setAlong(true);
    await app.loopBeats(found.from, found.to);
    this.take(found);
  }

  stop() {
    this.practice.endRamp();
    this.app.tell("coach");
  }

  /** @param {Target} target that is looped now */
  take(target) {
    const { app } = this;
    app.transport.setRate(target.rate);
    this.practice.rateBefore = 0;
    this.on = true;
    this.message = app.t(target.passed ? "coachBegins" : "coachNew", { rate: Math.round(100 * target.rate) });
    app.tell("coach");
  }

  /** Choose the next speed or the next stretch after a pass. @param {import("./judge.js").Tally} tally */
  pass(tally) {
    const { app } = this;
    const { transport, chart } = app;
    const share = scoreShare(tally);
    const percent = Math.round(100 * share);
    if (share < PASSED || this.practice.judge.slowest < FULL) {
      transport.rate = coachRate(transport.rate, share, FULL);
      const now = { percent, rate: Math.round(100 * transport.rate) };
      this.message = share < PASSED ? app.t("coachFailed", { ...now, pass: 100 * PASSED }) : app.t("coachGoesOn", now);
      return;
    }
    const target = this.next();
    if (!target) {
      this.practice.endRamp();
      app.notice = app.t("coachDone", { percent });
      return;
    }
    app.setLoop(chart.secondAt(target.from), chart.secondAt(target.to));
    this.take(target);
    this.message = app.t("coachNext", { percent, rate: Math.round(100 * target.rate) });
  }
}
