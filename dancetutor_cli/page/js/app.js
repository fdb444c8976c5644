// The page's state and everything that can be done with it; panels and keys only call what is here.

import { Chart } from "./chart.js";
import { Transport } from "./clock.js";
import { Highway, scrollSpeed } from "./highway.js";
import { Input, keyName } from "./input.js";
import { Judge, ramp } from "./judge.js";
import { makeLink, parseLink } from "./link.js";
import { Motion } from "./motion.js";
import { CAMERAS, Picture } from "./picture.js";
import { Redance } from "./redance.js";
import { loadNotes, loadSettings, saveNotes, saveSettings } from "./settings.js";
import { Sound, clicksOf } from "./sound.js";
import { speak } from "./words.js";

const HELPS = ["all", "tricky", "none", "auto"];
const EARLY = 0.2; // seconds before a row from which its press counts while the clock waits for rows

export class App {
  /** @param {any} doc @param {import("./blob.js").Arrays} arrays */
  constructor(doc, arrays) {
    this.doc = doc;
    this.arrays = arrays;
    this.settings = loadSettings();
    const { language, t } = speak(doc.languages, this.settings.language);
    this.language = language;
    this.t = t;
    this.chart = new Chart(doc, arrays);
    this.id = `${doc.words.file}#${doc.words.index}:${doc.play.total}`;
    this.notes = loadNotes(this.id);
    this.motions = /** @type {Motion[]} */ (doc.motions.map((/** @type {any} */ about) => new Motion(about, arrays, doc.body)));
    this.sound = new Sound();
    this.sound.volume = this.settings.volume;
    this.start = Math.min(0, this.motions[0].start);
    this.end = Math.max(this.chart.last + 1.5, Math.min(this.motions[0].end, this.chart.last + 4));
    this.transport = new Transport(() => this.sound.now(), this.start, this.end);
    this.transport.countIn = this.settings.countIn;
    this.transport.lead = (a) => this.chart.secondAt(this.chart.beatAt(a) - this.leadBeats);
    this.transport.onChange = () => this.changed();
    this.transport.onPass = () => this.pass();
    this.sound.clicks = clicksOf(this.chart, () => ({
      claps: this.claps, metronome: this.settings.metronome,
    }));
    this.judge = new Judge(this.chart);
    this.input = new Input(doc.pad.names, this.settings);
    this.input.onPress = (press) => this.press(press.column, press.ago);
    this.redance = new Redance(doc, this.chart, this.notes.feet);
    this.along = false; // somebody plays along
    this.wait = false; // the clock stops at each row until it is pressed
    this.both = false; // the second dancer is shown
    this.helpNow = 0; // place in HELPS that "auto" has come to
    this.passes = 0;
    this.chosen = -1; // note that the author looks at
    this.passage = -1; // of the list, that is looped
    this.fresh = true; // something is to be drawn
    this.played = false; // whether anybody has pressed play yet
    this.message = ""; // what went wrong with the music
    /** @type {Picture | null} */
    this.picture = null;
    /** @type {Highway | null} */
    this.highway = null;
    /** @type {Set<(what: string) => void>} */
    this.listeners = new Set();
  }

  /** Beats of getting ready before a loop; at a higher speed as many. */
  get leadBeats() {
    return this.settings.countIn ? this.settings.leadBeats : 0;
  }

  /** Whether steps are clapped: as asked for, else where there is no music. */
  get claps() {
    return this.settings.claps === "auto" ? !this.sound.music : this.settings.claps === "on";
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
    this.tell("clock");
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
    this.save();
    this.tell("settings");
  }

  /** The second that is seen now: what is heard now was scheduled a little earlier. */
  second() {
    const { transport, sound } = this;
    const heard = transport.second() - (transport.playing && !transport.waiting ? sound.latency * transport.rate : 0);
    return Math.max(heard, this.start);
  }

  async play() {
    if (this.transport.playing) return this.transport.pause();
    this.played = true;
    await this.sound.start();
    if (this.along) this.restartJudge(this.transport.at);
    this.transport.play();
    this.updateHold();
  }

  /** @param {number} second */
  seek(second) {
    if (this.along) this.restartJudge(second);
    this.transport.seek(second);
    this.updateHold();
  }

  /** Hold the pose of the next row or the one before. @param {number} by */
  step(by) {
    if (this.transport.playing) this.transport.pause();
    const rows = this.chart.rowSeconds;
    if (!rows.length) return;
    const now = this.chart.rowAt(this.transport.at);
    const on = now >= 0 && Math.abs(rows[now] - this.transport.at) < 2e-3;
    const next = by > 0 ? now + 1 : on ? now - 1 : now;
    this.seek(rows[Math.min(Math.max(next, 0), rows.length - 1)]);
  }

  /** @param {number} by measures */
  stepMeasure(by) {
    const at = this.chart.beatAt(this.transport.second()) / 4;
    const measure = by > 0 ? Math.floor(at + 1e-3) + 1 : Math.ceil(at - 1e-3) - 1;
    this.seek(this.chart.secondAt(4 * Math.max(measure, 0)));
  }

  /** @param {number} rate */
  setRate(rate) {
    this.transport.setRate(rate);
    this.tell("rate");
    this.writeLink();
  }

  /** @param {number | null} a @param {number | null} b seconds; null: no loop */
  setLoop(a, b, passage = -1) {
    this.passage = passage;
    this.passes = 0;
    if (a === null || b === null) this.transport.setLoop(null);
    else this.transport.setLoop({ a: Math.min(a, b), b: Math.max(a, b) });
    this.tell("loop");
    this.writeLink();
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
    this.setLoop(passage.start, passage.end, number);
    const playing = this.transport.playing;
    this.transport.restartLoop();
    if (this.along) this.restartJudge(passage.start);
    if (!playing) await this.play();
    this.updateHold();
  }

  /** A pass of the loop is over. */
  pass() {
    const { loop } = this.transport;
    if (!loop) return;
    if (!this.wait) this.judge.advance(loop.b + 1, this.transport.rate);
    const { miss } = this.judge.tally(loop.a, loop.b);
    ++this.passes;
    if (this.settings.ramp) this.transport.rate = ramp(this.transport.rate, miss, this.along);
    if (this.settings.help === "auto" && this.along) {
      this.helpNow = Math.min(Math.max(this.helpNow + (miss ? -1 : 1), 0), 2);
    }
    this.tell("pass");
    if (this.along) this.restartJudge(loop.a);
    this.updateHold();
    if (this.settings.ramp) this.writeLink();
  }

  /** Play along, or only watch. @param {boolean} on */
  setAlong(on) {
    this.along = on;
    if (!on) this.wait = false;
    this.judge.restart(on ? this.transport.second() : -Infinity);
    if (!on) this.judge.verdicts.clear();
    this.updateHold();
    this.tell("along");
  }

  /** @param {boolean} on */
  setWait(on) {
    if (on && !this.along) this.setAlong(true);
    this.wait = on;
    if (on) this.restartJudge(this.transport.second());
    this.updateHold();
    this.tell("along");
  }

  /** @param {number} second */
  restartJudge(second) {
    const { loop } = this.transport;
    this.judge.restart(loop && second < loop.b ? Math.max(second, loop.a) : second);
    this.tell("hits");
  }

  /** While the clock waits for rows it does not pass the first one that is not pressed. */
  updateHold() {
    const row = this.wait ? this.judge.open(-Infinity) : null;
    const { loop } = this.transport; // beyond its end nothing is waited for: it begins anew
    this.transport.holdAt(row && !(loop && row.second >= loop.b) ? row.second : Infinity);
  }

  /** A panel is pressed, some seconds ago. @param {number} column @param {number} ago */
  press(column, ago) {
    this.fresh = true;
    if (!this.along) return;
    const { rate } = this.transport;
    if (this.wait) {
      const row = this.judge.open(-Infinity);
      if (!row || row.second - this.transport.second() > EARLY * rate) return;
      this.judge.press(column, row.second, rate, true);
      this.updateHold();
    } else if (this.transport.playing) {
      this.judge.press(column, this.transport.second() - (ago + this.sound.latency + this.settings.latency) * rate, rate);
    }
    this.tell("hits");
  }

  /** The level of help that holds now: "all", "tricky" or "none". */
  get help() {
    return this.settings.help === "auto" ? HELPS[this.helpNow] : this.settings.help;
  }

  /** Whether the foot of a note is told. @param {import("./chart.js").Row | undefined} row */
  tells(row) {
    return this.help === "all" || (this.help === "tricky" && Boolean(row?.tricky));
  }

  nextHelp() {
    this.set("help", HELPS[(HELPS.indexOf(this.settings.help) + 1) % HELPS.length]);
  }

  /** @param {string} name of `CAMERAS` */
  setCamera(name) {
    if (CAMERAS.includes(name)) this.set("camera", name);
  }

  /** Mirrored lanes fit a dancer who is seen from before. */
  get mirrored() {
    return this.settings.camera === "front";
  }

  /** The row whose feet are shown as ghosts: the next one, while the picture stands. */
  nextRow() {
    const { transport, chart } = this;
    if (transport.playing && !transport.waiting) return null;
    const now = chart.rowAt(transport.second() + 1e-3);
    const row = transport.waiting ? chart.rows[now] : chart.rows[now + 1];
    return row && this.tells(row) ? row : null;
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

  /** What is said over the picture: what she waits for, what is looped, who dances. */
  said() {
    const { t, transport } = this;
    if (this.message) return this.message;
    if (transport.waiting) return t("waiting");
    const measure = (/** @type {number} */ s) => String(Math.round((100 * this.chart.beatAt(s)) / 4) / 100);
    const { loop } = transport;
    const looped = loop ? t("loopFrom", { from: measure(loop.a), to: measure(loop.b), passes: this.passes }) : "";
    const told = [this.both ? this.besideText() : "", looped].filter(Boolean).join(" · ");
    const silent = !this.played && !this.sound.music;
    return told || (silent ? t("musicMissing", { name: this.doc.words.music || "…" }) : "");
  }

  /** Who dances beside her, and where her feet differ. */
  besideText() {
    const { name, rows } = this.doc.beside;
    const beats = rows.slice(0, 3).map((/** @type {number} */ row) => this.redance.rows.get(row)?.beat).filter((/** @type {number | undefined} */ beat) => beat !== undefined);
    const where = beats.map((/** @type {number} */ beat) => `m${Math.floor(beat / 4)}:${Math.round(100 * ((beat % 4) + 1)) / 100}`).join(", ");
    const what = name === "next" ? this.t("nextBest") : name;
    return this.t("bothLong", { name: what, rows: rows.length, where: rows.length > 3 ? `${where} …` : where });
  }

  /** Everything that is drawn for one picture. @param {import("./timeline.js").Timeline} timeline */
  frame(timeline) {
    const { transport, sound } = this;
    this.input.poll();
    transport.tick();
    sound.pump(transport.hold);
    const second = this.second();
    if (transport.playing && this.along && !this.wait) {
      if (this.judge.advance(second - this.settings.latency * transport.rate, transport.rate)) this.tell("hits");
    }
    if (!this.fresh && !transport.playing && !timeline.grip && !this.input.changed) return;
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
    return {
      second, speed: scrollSpeed(this.settings.speed), mirror: this.mirrored,
      marked: (_, row) => this.tells(row), verdicts: this.along ? this.judge.verdicts : new Map(),
      loop: this.transport.loop, feet: this.redance.limbs, chosen: this.chosen,
      keys: this.along ? this.input.keys.map(keyName) : [], held: this.along ? this.input.held : [],
    };
  }

  /** The address says what is looped, and how fast. */
  writeLink() {
    const { loop, rate } = this.transport;
    const measure = (/** @type {number} */ s) => this.chart.beatAt(s) / 4;
    const link = loop ? makeLink(measure(loop.a), measure(loop.b), rate) : makeLink(null, null, rate);
    try {
      history.replaceState(null, "", link || location.pathname + location.search);
    } catch {
      // A browser that forbids it for pages from the disk: the link is only not in the address.
    }
  }

  /** Do what the address says. @param {string} hash */
  readLink(hash) {
    const link = parseLink(hash);
    if (!link) return;
    if (link.rate !== null) this.transport.setRate(link.rate);
    if (link.from !== null && link.to !== null) {
      this.setLoop(this.chart.secondAt(4 * link.from), this.chart.secondAt(4 * link.to));
      this.seek(this.chart.secondAt(4 * link.from));
    } else if (link.from !== null) {
      this.seek(this.chart.secondAt(4 * link.from));
    }
    this.tell("rate");
  }
}
