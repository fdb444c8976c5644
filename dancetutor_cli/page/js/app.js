// The state of the page and all actions on it. Panels and keys call only these.

import { Chart } from "./chart.js";
import { Transport } from "./clock.js";
import { NARROW, scrollSpeed } from "./highway.js";
import { Input } from "./input.js";
import { Motion } from "./motion.js";
import { Practice } from "./practice.js";
import { stretch, writeLink } from "./places.js";
import { Redance } from "./redance.js";
import { passedOf } from "./status_text.js";
import { CAMERAS, FEET, FIRST_VIEW, HELPS, loadNotes, loadRecord, loadSettings, saveNotes, saveRecord, saveSettings } from "./settings.js";
import { Sound, clicksOf } from "./sound.js";
import { speak } from "./words.js";

export class App {
  /** @param {import("./doc.js").PageDoc} doc @param {import("./blob.js").Arrays} arrays */
  constructor(doc, arrays) {
    this.doc = doc;
    this.arrays = arrays;
    this.settings = loadSettings();
    const { language, t } = speak(doc.languages, this.settings.language || doc.language);
    this.language = language;
    this.t = t; // `setLanguage` replaces it; objects that hold `t` are then made again
    this.chart = new Chart(doc, arrays);
    this.id = `${doc.words.file}#${doc.words.index}:${doc.play.total}`;
    this.notes = loadNotes(this.id);
    this.record = loadRecord(this.id);
    this.motions = doc.motions.map((about) => new Motion(about, arrays, doc.body));
    this.sound = new Sound();
    this.sound.volume = this.settings.volume;
    this.start = Math.min(0, this.motions[0].start);
    this.end = Math.max(this.chart.last + 1.5, Math.min(this.motions[0].end, this.chart.last + 2.5));
    this.transport = new Transport(() => this.sound.now(), this.start, this.end);
    this.transport.countIn = this.settings.countIn;
    this.transport.lead = (a) => this.chart.secondAt(this.chart.beatAt(a) - this.leadBeats);
    this.transport.onChange = () => this.changed();
    this.practice = new Practice(this);
    this.practice.judge.foot = FEET.indexOf(this.notes.foot) - 1;
    this.transport.onPass = () => this.practice.pass();
    this.transport.onEnd = () => this.practice.finish();
    this.sound.clicks = clicksOf(this.chart, () => ({
      claps: this.claps,
      metronome: this.settings.metronome,
      played: (row) => this.practice.along && row.steps.some(({ note }) => !this.practice.judge.asks(note)),
    }));
    this.input = new Input(doc.pad.names, this.settings, doc.pad.directions);
    this.input.onControl = (name) => (name === "start" ? void this.padStart() : this.toStart());
    this.input.onPress = (press) => {
      this.fresh = true;
      if (press.device === "pad" && !this.practice.along) this.practice.idle();
      this.practice.press(press.column, press.ago);
    };
    this.pace = scrollSpeed(this.chart.rowSeconds);
    this.redance = new Redance(doc, this.chart, this.notes.feet);
    this.both = false; // whether the second dancer is shown
    this.chosen = -1; // the note that the author has chosen; -1 for none
    this.chosenAt = NaN; // the second of the clock at that choice
    this.passage = -1; // index of the passage that is looped; -1 for none
    this.fresh = true; // whether the picture must be drawn again
    this.drawn = NaN; // the second that was drawn last
    this.played = false; // whether anybody has pressed play yet
    this.notice = ""; // a message, shown until the next action
    this.musicName = ""; // the file that the music comes from
    this.musicBad = ""; // the file that is no music
    this.musicLoading = false; // the page's own is being unpacked
    /** @type {import("./picture.js").Picture | null} */
    this.picture = null;
    /** @type {import("./highway.js").Highway | null} */
    this.highway = null;
    /** @type {Set<(what: string) => void>} */
    this.listeners = new Set();
    /** @type {() => void} makes everything that holds words anew */
    this.onLanguage = () => {};
  }

  /** The number of beats before a loop, at any speed. */
  get leadBeats() {
    return this.settings.countIn ? this.settings.leadBeats : 0;
  }

  /** Whether steps are clapped: by the setting, or if that is "auto", if there is no music. */
  get claps() {
    return this.settings.claps === "auto" ? !this.sound.music && !this.musicLoading : this.settings.claps === "on";
  }

  /** @param {boolean} on */
  setClaps(on) {
    this.set("claps", on ? "on" : "off");
  }

  /** Tell all listeners what has changed. @param {string} what */
  tell(what) {
    this.fresh = true;
    for (const listener of this.listeners) listener(what);
  }

  /** React to a change of the clock: it plays, pauses or jumps. */
  changed() {
    this.sound.follow(this.transport.run);
    if (!this.transport.playing) {
      this.practice.recordOutcomes();
      this.practice.feedback = null;
    }
    this.tell("clock");
  }

  saveRecord() {
    saveRecord(this.id, this.record);
    this.tell("record");
  }

  save() {
    saveSettings(this.settings);
    this.fresh = true;
  }

  /**
   * Change a setting.
   * @template {keyof import("./settings.js").Settings} K @param {K} name
   * @param {import("./settings.js").Settings[K]} value
   */
  set(name, value) {
    this.settings[name] = value;
    if (name === "countIn") this.transport.countIn = Boolean(value);
    if (name === "volume") this.sound.volume = Number(value);
    if (name === "ramp" && !value) this.practice.endRamp();
    if (name === "ramp") this.notice = value && !this.transport.loop ? this.t("rampNeedsLoop") : "";
    this.save();
    this.tell("settings");
  }

  /** Change the language. @param {string} name "": the browser's */
  setLanguage(name) {
    this.set("language", name);
    Object.assign(this, speak(this.doc.languages, name || this.doc.language));
    this.onLanguage();
    this.tell("settings");
  }

  /**
   * Return the second of the music that is seen now: sound is heard later than it is scheduled, and a screen may be
   * late.
   */
  second() {
    const { transport, sound } = this;
    const heard =
      transport.second() - (transport.playing && !transport.waiting ? (sound.latency - this.settings.sight) * transport.rate : 0);
    return Math.max(heard, this.start);
  }

  async play() {
    if (this.transport.playing) return this.transport.pause();
    const { at } = this.transport;
    // Time to get ready.
    if (!this.played && !this.transport.loop && at > this.opening && at < this.chart.first) this.transport.seek(this.opening);
    this.played = true;
    this.notice = "";
    await this.sound.start();
    this.transport.play();
    const jumped = this.transport.second() !== at; // to the start again after the end, to the loop's lead-in
    if (this.practice.along && (this.practice.over || jumped)) this.practice.restart(this.transport.second());
    this.practice.updateHold();
  }

  /** Play from the beginning, without a loop. */
  async begin() {
    this.setLoop(null, null);
    this.transport.pause();
    this.seek(this.opening);
    await this.play();
  }

  /** Do what Start of a mat does: play along or pause; after a result, begin again. */
  async padStart() {
    if (this.practice.over) return this.begin();
    if (!this.transport.playing && !this.practice.along) this.practice.setAlong(true); // a user on a mat wants to play along
    await this.play();
  }

  /** Go back to the start of the loop or of the song; playing goes on. */
  toStart() {
    if (this.transport.loop) this.restartLoop();
    else this.seek(this.opening);
  }

  /** Go back to the lead-in of the loop. */
  restartLoop() {
    const { loop } = this.transport;
    if (!loop) return;
    this.transport.restartLoop();
    if (this.practice.along) this.practice.restart(loop.a);
    this.practice.updateHold();
  }

  /** Play along, in the loop if there is one. */
  async beginAlong() {
    this.practice.endRamp();
    this.practice.setAlong(true);
    if (!this.transport.loop) return this.begin();
    this.restartLoop();
    if (!this.transport.playing) await this.play();
  }

  /** The second at which playing begins: a little before the first step. */
  get opening() {
    return Math.max(this.start, this.chart.first - 2);
  }

  /** Go to where the page opens: half a second before the first step, so that notes are visible. */
  rewind() {
    this.seek(Math.max(this.start, this.chart.first - 0.5));
    this.played = false;
  }

  /** @param {number} second */
  seek(second) {
    this.notice = "";
    this.leaveLoop(second);
    if (this.practice.along) this.practice.restart(second);
    this.transport.seek(second);
    this.practice.updateHold();
  }

  /** End the loop if a second is outside of it. @param {number} second */
  leaveLoop(second) {
    const { loop } = this.transport;
    if (!loop || (second >= this.transport.lead(loop.a) - 1e-3 && second <= loop.b + 1e-3)) return;
    const where = stretch(this.t, this.chart.beatAt(loop.a) / 4, this.chart.beatAt(loop.b) / 4);
    this.setLoop(null, null);
    this.notice = this.t("loopLeft", { where });
  }

  /** Pause at the next row or the row before. @param {number} by 1 or -1 */
  step(by) {
    if (this.transport.playing) this.transport.pause();
    const rows = this.chart.rowSeconds;
    if (!rows.length) return;
    const now = this.chart.rowAt(this.transport.at);
    const on = now >= 0 && Math.abs(rows[now] - this.transport.at) < 2e-3;
    const next = by > 0 ? now + 1 : on ? now - 1 : now;
    const number = Math.min(Math.max(next, 0), rows.length - 1);
    this.seek(rows[number]);
    if (this.chosen >= 0) this.choose(this.chart.rows[number].steps[0].note); // if a note was chosen, choose one of this row
  }

  /** Choose a note; -1 for none. @param {number} note */
  choose(note) {
    this.chosen = note;
    this.chosenAt = this.transport.second();
    this.tell("feet");
  }

  /** Return the chosen note or, if the clock has moved since, a note of the row where it is now. */
  meant() {
    const second = this.transport.second();
    if (this.chosen >= 0 && Math.abs(second - this.chosenAt) < 1e-3) return this.chosen;
    return this.chart.rows[this.chart.rowAt(second)]?.steps[0].note ?? this.chosen;
  }

  /** Pause at a note and choose it. @param {number} note */
  goTo(note) {
    const row = this.redance.rowOf.get(note);
    if (!row) return;
    this.transport.pause();
    this.seek(row.second);
    this.choose(note);
  }

  /** @param {number} by measures */
  stepMeasure(by) {
    const at = this.chart.beatAt(this.transport.second()) / 4;
    const measure = by > 0 ? Math.floor(at + 1e-3) + 1 : Math.ceil(at - 1e-3) - 1;
    this.seek(this.chart.secondAt(4 * Math.max(measure, 0)));
  }

  /** @param {number} rate */
  setRate(rate) {
    this.takeRate(rate);
    this.tell("rate");
    writeLink(this);
  }

  /** Set the speed; it is also the one to which the ramp comes back. @param {number} rate */
  takeRate(rate) {
    this.transport.setRate(rate);
    this.practice.chosenRate = this.transport.rate;
    this.practice.rateBefore = 0;
  }

  /** @param {number | null} a @param {number | null} b seconds; null: no loop */
  setLoop(a, b, passage = -1) {
    this.passage = passage;
    this.notice = "";
    this.practice.endRamp();
    if (a === null || b === null) this.transport.setLoop(null);
    else this.transport.setLoop({ a: Math.min(a, b), b: Math.max(a, b) });
    this.tell("loop");
    writeLink(this);
  }

  /** Begin or end the loop at the beat nearest to now. @param {"a" | "b"} end */
  loopHere(end) {
    const here = this.chart.secondAt(Math.max(0, Math.round(this.chart.beatAt(this.transport.second()))));
    const bar = this.chart.secondAt(this.chart.beatAt(here) + (end === "a" ? 8 : -8));
    const { a, b } = this.transport.loop ?? { a: here, b: here };
    if (end === "a") this.setLoop(here, b > here ? b : bar);
    else this.setLoop(a < here ? a : Math.max(bar, this.start), here);
  }

  /** Loop one of the passages, from its lead-in. @param {number} number */
  async loopPassage(number) {
    const passage = this.doc.passages[number];
    if (!passage) return;
    await this.loopBeats(this.chart.beatAt(passage.start), this.chart.beatAt(passage.end));
    this.passage = number;
    this.tell("loop");
  }

  /** Loop a stretch from its lead-in. @param {number} from @param {number} to beats @param {number} [rate] */
  async loopBeats(from, to, rate) {
    const [a, b] = [this.chart.secondAt(from), this.chart.secondAt(to)];
    this.setLoop(a, b);
    if (rate !== undefined) this.setRate(rate);
    this.restartLoop();
    if (!this.transport.playing) await this.play();
  }

  nextHelp() {
    this.set("help", HELPS[(HELPS.indexOf(this.settings.help) + 1) % HELPS.length]);
  }

  /** Put the free camera back to its first place. */
  resetView() {
    Object.assign(this.settings, FIRST_VIEW);
    this.setCamera("free");
  }

  /** @param {string} name of `CAMERAS` */
  setCamera(name) {
    if (CAMERAS.includes(name)) this.set("camera", name);
  }

  /** Whether lanes are mirrored: they are for a dancer seen from the front, unless the user plays along. */
  get mirrored() {
    return this.settings.camera === "front" && !this.practice.along;
  }

  /**
   * Return the row whose feet are shown as soles on the pad: while the picture stands still, the next one; else null.
   */
  nextRow() {
    const { transport, chart } = this;
    if (transport.playing && !transport.waiting) return null;
    const now = chart.rowAt(transport.second() + 1e-3);
    const row = transport.waiting ? chart.rows[now] : chart.rows[now + 1];
    return row && this.practice.tells(row) ? row : null;
  }

  /** Give a note to the other foot, or back. @param {number} note */
  giveOther(note) {
    this.redance.toggle(note);
    this.notes.feet = this.redance.stored();
    saveNotes(this.id, this.notes);
    this.tell("feet");
  }

  /** Tick a finding off, or undo that. @param {string} key @param {boolean} on */
  tick(key, on) {
    this.notes.ticked = this.notes.ticked.filter((one) => one !== key);
    if (on) this.notes.ticked.push(key);
    saveNotes(this.id, this.notes);
    this.tell("findings");
  }

  /**
   * Advance the practice, and draw one picture if anything has changed.
   * @param {import("./timeline.js").Timeline} timeline
   */
  frame(timeline) {
    const { transport, sound } = this;
    this.input.poll();
    transport.tick();
    sound.pump(transport.hold);
    const second = this.second();
    this.practice.advance(second);
    this.practice.fade();
    // While the dancer waits or nothing plays, the picture stays the same and is not drawn again.
    const shown = this.practice.feedback !== null; // a verdict fades, so the picture changes
    if (!this.fresh && !shown && second === this.drawn && !timeline.grip && !this.input.changed) return;
    this.drawn = second;
    this.input.changed = false;
    this.fresh = false;
    const next = this.nextRow();
    this.picture?.draw({ second, camera: this.settings.camera, both: this.both, next, playing: transport.playing && !transport.waiting });
    this.highway?.draw(this.highwayScene(second));
    timeline.draw(second, transport.loop, (k) => k === this.passage);
    for (const listener of this.listeners) listener("frame");
  }

  /** @param {number} second @returns {import("./highway.js").Scene} */
  highwayScene(second) {
    const { practice } = this;
    return {
      second,
      speed: this.pace * this.settings.speed,
      mirror: this.mirrored,
      marked: (_, row) => practice.tells(row),
      verdicts: practice.along ? practice.judge.verdicts : new Map(),
      asked: (n) => !practice.along || practice.judge.asks(n),
      loop: this.transport.loop,
      feet: this.redance.limbs,
      chosen: this.chosen,
      along: practice.along,
      errors: practice.along ? practice.errors : [],
      keys: practice.along ? this.input.names().map(([name]) => name) : [],
      held: practice.along ? this.input.held : [],
      feedback: practice.along ? practice.shown() : null,
      passed: window.innerWidth > NARROW ? passedOf(this) : "", // a phone has a line for it
    };
  }
}
