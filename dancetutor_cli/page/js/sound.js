// What is heard: the music at any speed, claps on steps, ticks on beats, all on the clock of the audio output.

import { lastUpTo } from "./maths.js";
import { Stretcher } from "./stretch.js";

const AHEAD = 0.25; // seconds that are prepared
const CHUNK = 0.12; // seconds of music in one go
const NOTHING = 1e-6; // seconds of music that are as good as none
const PATIENCE = 400; // milliseconds to wait for the audio output
const CLAP = 1150, TICK = 1600, ACCENT = 2200; // Hz, as in the films
const LENGTH = 0.045;

/** @typedef {{second: number, pitch: number, loudness: number}} Click */

export class Sound {
  constructor() {
    /** @type {AudioContext | null} */
    this.context = null;
    /** @type {AudioBuffer | null} */
    this.music = null;
    this.volume = 0.9;
    this.offset = NaN; // of the audio clock against the page's
    /** @type {Set<AudioScheduledSourceNode>} */
    this.sources = new Set();
    /** @type {Stretcher | null} */
    this.stretcher = null;
    this.due = 0; // audio time of the next chunk
    this.told = 0; // second of the music up to which clicks are scheduled
    /** @type {import("./clock.js").Run | null} */
    this.run = null;
    /** @type {(from: number, to: number, quietUntil: number) => Click[]} clicks between two seconds of the music */
    this.clicks = () => [];
    /** @type {Map<number, AudioBuffer>} */
    this.made = new Map();
  }

  /** Seconds of an even clock: that of the audio output once it runs, smoothed; before that the page's. */
  now() {
    const page = performance.now() / 1000;
    if (!this.context || this.context.state !== "running") return page + (Number.isNaN(this.offset) ? 0 : this.offset);
    const apart = this.context.currentTime - page;
    if (Number.isNaN(this.offset) || Math.abs(apart - this.offset) > 0.08) this.offset = apart;
    else this.offset += 0.02 * (apart - this.offset);
    return page + this.offset;
  }

  /** Seconds by which what is scheduled now is heard late. */
  get latency() {
    const c = this.context;
    return c && c.state === "running" ? c.outputLatency || c.baseLatency || 0 : 0;
  }

  /** Make sure that the audio output runs; without one the page goes on by its own clock. */
  async start() {
    if (!this.context && typeof AudioContext !== "undefined") {
      try {
        this.context = new AudioContext({ latencyHint: "interactive" });
      } catch {
        return;
      }
    }
    if (this.context && this.context.state !== "running") {
      await Promise.race([this.context.resume().catch(() => {}), new Promise((done) => setTimeout(done, PATIENCE))]);
    }
  }

  /**
   * The music out of a file's bytes.
   * @param {ArrayBuffer} data
   */
  async load(data) {
    const offline = new OfflineAudioContext(2, 1, 48000);
    this.music = await offline.decodeAudioData(data);
  }

  /**
   * Forget what was to be heard; what follows is a run of the clock, or silence.
   * @param {import("./clock.js").Run | null} run
   */
  follow(run) {
    for (const source of this.sources) source.stop();
    this.sources.clear();
    this.run = run;
    this.stretcher = null;
    if (!run) return;
    this.told = run.from - 1e-6;
    this.due = run.at;
  }

  /**
   * Prepare what is due soon; to be called for every picture.
   * @param {number} hold second that the clock does not pass
   */
  pump(hold) {
    const { context, run } = this;
    if (!context || !run || context.state !== "running") return;
    const until = context.currentTime + AHEAD;
    const end = Math.min(run.to, hold);
    this.pumpClicks(context, run, Math.min(end, run.from + (until - run.at) * run.rate));
    if (!this.music) return;
    while (this.due < until) {
      const second = run.from + (this.due - run.at) * run.rate;
      if (second >= end - NOTHING) break; // what rounding leaves would never be used up
      const length = Math.min(CHUNK, (end - second) / run.rate);
      if (second + length * run.rate <= run.quietUntil) {
        this.due += length;
        continue;
      }
      this.chunk(context, this.music, run, second, length);
    }
  }

  /**
   * @param {AudioContext} context @param {AudioBuffer} music @param {import("./clock.js").Run} run
   * @param {number} second @param {number} length seconds of the clock
   */
  chunk(context, music, run, second, length) {
    if (!this.stretcher || this.due < context.currentTime) {
      this.due = Math.max(this.due, context.currentTime + 0.005);
      const at = run.from + (this.due - run.at) * run.rate;
      const channels = Array.from({ length: music.numberOfChannels }, (_, c) => music.getChannelData(c));
      this.stretcher = new Stretcher(channels, music.sampleRate, run.rate, Math.max(at, run.quietUntil));
      if (at < run.quietUntil) this.due += (run.quietUntil - at) / run.rate;
    }
    const frames = Math.max(1, Math.round(length * music.sampleRate));
    const data = this.stretcher.read(frames);
    const buffer = context.createBuffer(data.length, frames, music.sampleRate);
    data.forEach((channel, c) => buffer.copyToChannel(/** @type {Float32Array<ArrayBuffer>} */ (channel), c));
    this.play(context, buffer, this.due, this.volume);
    this.due += frames / music.sampleRate;
  }

  /** @param {AudioContext} context @param {import("./clock.js").Run} run @param {number} until second of the music */
  pumpClicks(context, run, until) {
    if (until <= this.told) return;
    for (const click of this.clicks(this.told, until, run.quietUntil)) {
      const at = run.at + (click.second - run.from) / run.rate;
      if (at >= context.currentTime - 0.01) this.click(click.pitch, click.loudness, at);
    }
    this.told = until;
  }

  /** A click at a moment of the audio clock. @param {number} pitch @param {number} loudness @param {number} at */
  click(pitch, loudness, at) {
    if (!this.context) return;
    let buffer = this.made.get(pitch);
    if (!buffer) {
      const rate = this.context.sampleRate;
      buffer = this.context.createBuffer(1, Math.round(LENGTH * rate), rate);
      const data = buffer.getChannelData(0);
      for (let i = 0; i < data.length; ++i) {
        data[i] = Math.sin((2 * Math.PI * pitch * i) / rate) * Math.exp((-7 * i) / data.length);
      }
      this.made.set(pitch, buffer);
    }
    this.play(this.context, buffer, at, loudness);
  }

  /** @param {AudioContext} context @param {AudioBuffer} buffer @param {number} at @param {number} loudness */
  play(context, buffer, at, loudness) {
    const source = context.createBufferSource();
    const gain = context.createGain();
    source.buffer = buffer;
    gain.gain.value = loudness;
    source.connect(gain).connect(context.destination);
    source.onended = () => this.sources.delete(source);
    source.start(Math.max(at, 0));
    this.sources.add(source);
  }
}

/**
 * The clicks of a chart: claps on rows, ticks on beats, ticks of a count-in.
 * @param {import("./chart.js").Chart} chart
 * @param {() => {claps: boolean, metronome: boolean, played: (row: import("./chart.js").Row) => boolean}} wanted
 * @returns {(from: number, to: number, quietUntil: number) => Click[]}
 */
export function clicksOf(chart, wanted) {
  return (from, to, quietUntil) => {
    const { claps, metronome, played } = wanted();
    /** @type {Click[]} */
    const out = [];
    for (let k = lastUpTo(chart.rowSeconds, from) + 1; k < chart.rows.length && chart.rowSeconds[k] <= to; ++k) {
      if (chart.rowSeconds[k] >= quietUntil && (claps || played(chart.rows[k])))
        out.push({ second: chart.rowSeconds[k], pitch: CLAP, loudness: 0.55 });
    }
    // A count-in may begin before the first beat.
    let k = from < chart.beats[0] ? Math.floor(chart.beatAt(from) + 1e-9) + 1 : lastUpTo(chart.beats, from) + 1;
    for (; k < chart.beats.length; ++k) {
      const second = k < 0 ? chart.secondAt(k) : chart.beats[k];
      if (second > to) break;
      if (metronome || second < quietUntil - 1e-6) {
        out.push({ second, pitch: k % 4 === 0 ? ACCENT : TICK, loudness: 0.4 });
      }
    }
    return out;
  };
}
