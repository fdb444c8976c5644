// The page's state and everything that can be done with it; panels and keys only call what is here.

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
    this.t = t; // another one after `setLanguage`: who keeps it is made anew then
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
      claps: this.claps, metronome: this.settings.metronome, played: (row) => this.practice.along && row.steps.some(({ note }) => !this.practice.judge.asks(note)),
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
    this.both = false; // the second dancer is shown
    this.chosen = -1; // note that the author looks at
    this.chosenAt = NaN; // the second that stood then
    this.passage = -1; // of the list, that is looped
    this.fresh = true; // something is to be drawn
    this.drawn = NaN; // the second that was drawn last
    this.played = false; // whether anybody has pressed play yet
    this.notice = ""; // what is to be known of a link; until something else is done
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

  /** Beats of getting ready before a loop; at a higher speed as many. */
  get leadBeats() {
    return this.settings.countIn ? this.settings.leadBeats : 0;
  }

  /** Whether steps are clapped: as asked for, else where there is no music. */
  get claps() {
    return this.settings.claps === "auto" ? !this.sound.music && !this.musicLoading : this.settings.claps === "on";
  }

  /** @param {boolean} on */
  setClaps(on) {
    this.set("claps", on ? "on" : "off");
  }

  /** Tell the panels. @param {string} what */
  tell(what) {
    this.fresh = true;
    for (const listener of this.listeners) listener(what);
  }

  /** The clock does something else than before. */
  changed() {
    this.sound.follow(this.transport.run);
    if (!this.transport.playing) {
      this.practice.keep();
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

  /** Change a setting. @template {keyof import("./settings.js").Settings} K @param {K} name @param {import("./settings.js").Settings[K]} value */
  set(name, value) {
    this.settings[name] = value;
    if (name === "countIn") this.transport.countIn = Boolean(value);
    if (name === "volume") this.sound.volume = Number(value);
    if (name === "ramp" && !value) this.practice.endRamp();
    if (name === "ramp") this.notice = value && !this.transport.loop ? this.t("rampNeedsLoop") : "";
    this.save();
    this.tell("settings");
  }

  /** Speak another language, from now on. @param {string} name "": the browser's */
  setLanguage(name) {
    this.set("language", name);
    Object.assign(this, speak(this.doc.languages, name || this.doc.language));
    this.onLanguage();
    this.tell("settings");
  }

  /** The second that is seen now: what is heard now was scheduled a little earlier, and the screen may be late. */
  second() {
    const { transport, sound } = this;
    const heard = transport.second() - (transport.playing && !transport.waiting ? (sound.latency - this.settings.sight) * transport.rate : 0);
    return Math.max(heard, this.start);
  }

  async play() {
    if (this.transport.playing) return this.transport.pause();
    const { at } = this.transport;
    if (!this.played && !this.transport.loop && at > this.opening && at < this.chart.first) this.transport.seek(this.opening); // time to get ready
    this.played = true;
    this.notice = "";
    await this.sound.start();
    this.transport.play();
    const jumped = this.transport.second() !== at; // to the start again after the end, to the loop's lead-in
    if (this.practice.along && (this.practice.over || jumped)) this.practice.restart(this.transport.second());
    this.practice.updateHold();
  }

  /** From the beginning, without a loop. */
  async begin() {
    this.setLoop(null, null);
    this.transport.pause();
    this.seek(this.opening);
    await this.play();
  }

  /** What a mat's Start does: play along, pause; after a result the same again. */
  async padStart() {
    if (this.practice.over) return this.begin();
    if (!this.transport.playing && !this.practice.along) this.practice.setAlong(true); // who stands on a mat means to play
    await this.play();
  }

  /** Back to the loop's start, or the song's; what plays goes on from there. */
  toStart() {
    if (this.transport.loop) this.restartLoop();
    else this.seek(this.opening);
  }

  /** From the loop's lead-in. */
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

  /** Where whoever plays begins: a little before the first step. */
  get opening() {
    return Math.max(this.start, this.chart.first - 2);
  }

  /** As the page opens: half a second before the first step, so that notes are in sight. */
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

  /** Whoever goes out of a loop has done with it. @param {number} second */
  leaveLoop(second) {
    const { loop } = this.transport;
    if (!loop || (second >= this.transport.lead(loop.a) - 1e-3 && second <= loop.b + 1e-3)) return;
    const where = stretch(this.t, this.chart.beatAt(loop.a) / 4, this.chart.beatAt(loop.b) / 4);
    this.setLoop(null, null);
    this.notice = this.t("loopLeft", { where });
  }

  /** Hold the pose of the next row or the one before. @param {number} by */
  step(by) {
    if (this.transport.playing) this.transport.pause();
    const rows = this.chart.rowSeconds;
    if (!rows.length) return;
    const now = this.chart.rowAt(this.transport.at);
    const on = now >= 0 && Math.abs(rows[now] - this.transport.at) < 2e-3;
    const next = by > 0 ? now + 1 : on ? now - 1 : now;
    const number = Math.min(Math.max(next, 0), rows.length - 1);
    this.seek(rows[number]);
    if (this.chosen >= 0) this.choose(this.chart.rows[number].steps[0].note); // who looks at feet goes on looking at them
  }

  /** A note is looked at; -1: none is. @param {number} note */
  choose(note) {
    this.chosen = note;
    this.chosenAt = this.transport.second();
    this.tell("feet");
  }

  /** The note that the author means: the one that was chosen, or of the row that has been gone to since. */
  meant() {
    const second = this.transport.second();
    if (this.chosen >= 0 && Math.abs(second - this.chosenAt) < 1e-3) return this.chosen;
    return this.chart.rows[this.chart.rowAt(second)]?.steps[0].note ?? this.chosen;
  }

  /** Stand at a note and look at it. @param {number} note */
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

  /** The speed is this one, and no other is come back to. @param {number} rate */
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

  /** The loop begins or ends now, at the nearest beat. @param {"a" | "b"} end */
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

  /** The free camera stands as at first. */
  resetView() {
    Object.assign(this.settings, FIRST_VIEW);
    this.setCamera("free");
  }

  /** @param {string} name of `CAMERAS` */
  setCamera(name) {
    if (CAMERAS.includes(name)) this.set("camera", name);
  }

  /** Mirrored lanes fit a dancer who is seen from before; whoever plays along has the mat's own. */
  get mirrored() {
    return this.settings.camera === "front" && !this.practice.along;
  }

  /** The row whose feet are shown as soles on the pad: the next one, while the picture stands. */
  nextRow() {
    const { transport, chart } = this;
    if (transport.playing && !transport.waiting) return null;
    const now = chart.rowAt(transport.second() + 1e-3);
    const row = transport.waiting ? chart.rows[now] : chart.rows[now + 1];
    return row && this.practice.tells(row) ? row : null;
  }

  /** Give a note to another foot, and back. @param {number} note */
  giveOther(note) {
    this.redance.toggle(note);
    this.notes.feet = this.redance.stored();
    saveNotes(this.id, this.notes);
    this.tell("feet");
  }

  /** Tick a finding off, or not. @param {string} key @param {boolean} on */
  tick(key, on) {
    this.notes.ticked = this.notes.ticked.filter((one) => one !== key);
    if (on) this.notes.ticked.push(key);
    saveNotes(this.id, this.notes);
    this.tell("findings");
  }

  /** Everything that is drawn for one picture. @param {import("./timeline.js").Timeline} timeline */
  frame(timeline) {
    const { transport, sound } = this;
    this.input.poll();
    transport.tick();
    sound.pump(transport.hold);
    const second = this.second();
    this.practice.advance(second);
    this.practice.fade();
    // While she waits, or nothing plays, the picture stays: nothing is drawn again.
    const shown = this.practice.feedback !== null; // and once more when it has to go
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
      second, speed: this.pace * this.settings.speed, mirror: this.mirrored, marked: (_, row) => practice.tells(row), verdicts: practice.along ? practice.judge.verdicts : new Map(),
      asked: (n) => !practice.along || practice.judge.asks(n),
      loop: this.transport.loop, feet: this.redance.limbs, chosen: this.chosen,
      along: practice.along, errors: practice.along ? practice.errors : [],
      keys: practice.along ? this.input.names().map(([name]) => name) : [], held: practice.along ? this.input.held : [],
      feedback: practice.along ? practice.shown() : null, passed: window.innerWidth > NARROW ? passedOf(this) : "", // a phone has a line for it
    };
  }
}
