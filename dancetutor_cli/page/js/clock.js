// The one clock of the page: which second of the music it is, at which speed, in which loop, and whether it waits.

/**
 * @typedef {object} Run a stretch that is played without a jump
 * @property {number} at when it begins, seconds of the clock underneath
 * @property {number} from second of the music there
 * @property {number} to second of the music at its end
 * @property {number} rate
 * @property {number} quietUntil second of the music up to which the music is silent: a count-in
 */

/** @typedef {{a: number, b: number}} Loop seconds of the music */

const START = 0.06; // seconds between "play" and the first sound: what is due at once would come too late

export class Transport {
  /**
   * @param {() => number} now seconds of an even clock, the sound's
   * @param {number} start @param {number} end seconds of the music
   */
  constructor(now, start, end) {
    this.now = now;
    this.start = start;
    this.end = end;
    this.rate = 1;
    /** @type {Loop | null} */
    this.loop = null;
    /** @type {(a: number) => number} where a pass begins that shall play from second a: before it, to get ready */
    this.lead = (a) => a;
    this.countIn = false;
    /** second of the music that the clock does not pass: a row to be waited for */
    this.hold = Infinity;
    this.at = start;
    /** @type {Run | null} */
    this.run = null;
    /** @type {() => void} called whenever what was to be heard is no longer so */
    this.onChange = () => {};
    /** @type {() => void} called at the end of each pass of a loop; may change the rate */
    this.onPass = () => {};
    /** @type {() => void} called when the last second has been played */
    this.onEnd = () => {};
  }

  get playing() {
    return this.run !== null;
  }

  /** Whether the clock stands at a row that waits to be pressed. */
  get waiting() {
    return this.run !== null && this.raw() >= this.hold;
  }

  /** The second of the music now. */
  second() {
    return this.run ? Math.min(this.raw(), this.run.to, this.hold) : this.at;
  }

  raw() {
    const run = /** @type {Run} */ (this.run);
    return run.from + Math.max(0, this.now() - run.at) * run.rate;
  }

  play() {
    if (this.run) return;
    let from = this.at;
    // At the loop's beginning or before it, as a deep link leaves it, a pass begins with its lead-in.
    if (this.loop && (from <= this.loop.a + 1e-3 || from >= this.loop.b - 0.05)) from = this.lead(this.loop.a);
    if (!this.loop && from >= this.end - 0.05) from = this.start;
    this.begin(from, this.now() + START);
  }

  pause() {
    if (!this.run) return;
    this.at = this.second();
    this.run = null;
    this.onChange();
  }

  /** @param {number} second */
  seek(second) {
    this.at = Math.min(Math.max(second, this.start), this.end);
    if (this.run) this.begin(this.at, this.now() + START);
    else this.onChange();
  }

  /** @param {number} rate */
  setRate(rate) {
    const at = this.second();
    this.rate = Math.min(Math.max(Math.round(rate * 100) / 100, 0.25), 2);
    if (this.run) this.begin(at, Math.max(this.now(), this.run.at)); // what has not begun begins when it was to
  }

  /** @param {Loop | null} loop */
  setLoop(loop) {
    this.loop = loop && loop.b - loop.a > 0.05 ? loop : null;
    if (this.run) this.begin(this.second(), this.now());
    else this.onChange();
  }

  /** Play the loop from its lead-in. */
  restartLoop() {
    if (!this.loop) return;
    this.at = this.lead(this.loop.a); // even before the song's start
    if (this.run) this.begin(this.at, this.now() + START);
    else this.onChange();
  }

  /** The clock may go on to another second: to the next row that is waited for. @param {number} hold */
  holdAt(hold) {
    if (hold === this.hold) return;
    const stood = this.waiting;
    const at = this.second();
    this.hold = hold;
    if (stood && this.run) this.begin(at, this.now());
  }

  /** To be called for every picture: ends passes and begins the next ones. */
  tick() {
    const run = this.run;
    if (!run || this.raw() < run.to || this.waiting) return;
    const over = run.at + (run.to - run.from) / run.rate;
    if (this.loop) {
      this.onPass();
      if (this.run && this.loop) this.begin(this.lead(this.loop.a), Math.max(over, this.now() - 0.1));
    } else {
      this.at = run.to;
      this.run = null;
      this.onEnd();
      this.onChange();
    }
  }

  /** Whether a count-in goes on: nothing is played yet, only counted. */
  get counting() {
    return this.run !== null && this.second() < this.run.quietUntil;
  }

  /** @param {number} from @param {number} at */
  begin(from, at) {
    const { loop } = this;
    const inside = loop !== null && from < loop.b;
    this.run = {
      at, from, to: inside ? loop.b : this.end, rate: this.rate,
      quietUntil: inside && this.countIn ? loop.a : -Infinity,
    };
    this.at = from;
    this.onChange();
  }
}
