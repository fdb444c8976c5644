// The whole song as a strip: how dense it is, where she faces, findings, passages, the loop; to seek and to draw loops.

import { clamp } from "./maths.js";

const DRAG = 6; // pixels that make a drag out of a click
const EDGE = 9; // pixels around an end of the loop that take hold of it
const CLOSER = 1.5; // times nearer with each step of the zoom
const MARKS = 28; // pixels of a loop with room for A and B
const LEAST = 8; // seconds that the strip shows at least
const NARROW = 3; // pixels: measures that would be drawn narrower are drawn together

export class Timeline {
  /**
   * @param {HTMLCanvasElement} canvas @param {import("./doc.js").PageDoc} doc @param {import("./chart.js").Chart} chart
   * @param {{start: number, end: number, seek: (s: number) => void, loop: (a: number, b: number) => void, changed: () => void}} about
   */
  constructor(canvas, doc, chart, about) {
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.doc = doc;
    this.chart = chart;
    this.about = about;
    this.density = densityOf(chart);
    /** @type {{a: number, b: number} | null} */
    this.drag = null;
    /** @type {{from: number, other: number | null, x: number} | null} */
    this.grip = null;
    /** @type {{a: number, b: number} | null} */
    this.loop = null;
    this.view = { from: about.start, to: about.end }; // seconds that are shown
    this.at = about.start; // the second that was drawn last
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        if (Math.abs(event.deltaX) > Math.abs(event.deltaY))
          this.show(this.view.from + (event.deltaX / canvas.clientWidth) * this.shown, this.shown);
        else this.zoom(event.deltaY < 0 ? 1 : -1, this.secondOf(event));
      },
      { passive: false },
    );
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", () => { this.grip = this.drag = null; });
  }

  /** @param {number} second */
  share(second) {
    return (second - this.view.from) / this.shown;
  }

  /** Seconds that the strip shows. */
  get shown() {
    return this.view.to - this.view.from;
  }

  /** How many times nearer than the whole song. */
  get nearness() {
    return (this.about.end - this.about.start) / this.shown;
  }

  /** Show some seconds from one on, within the song. @param {number} from @param {number} seconds */
  show(from, seconds) {
    const { start, end } = this.about;
    const long = clamp(seconds, Math.min(LEAST, end - start), end - start);
    const first = clamp(from, start, end - long);
    this.view = { from: first, to: first + long };
    this.about.changed();
  }

  /** Nearer (1) or farther (-1); a second stays where it is. @param {number} by @param {number} [second] */
  zoom(by, second = clamp(this.at, this.view.from, this.view.to)) {
    const seconds = this.shown / CLOSER ** by;
    this.show(second - this.share(second) * seconds, seconds);
  }

  /** What is played stays in sight: the strip goes on to the next part. @param {number} second */
  follow(second) {
    if (second !== this.at && !this.grip && (second > this.view.to || second < this.view.from))
      this.show(second - 0.05 * this.shown, this.shown);
    this.at = second;
  }

  /** @param {MouseEvent} event */
  secondOf(event) {
    const box = this.canvas.getBoundingClientRect();
    const share = clamp((event.clientX - box.left) / box.width, 0, 1);
    return this.view.from + share * this.shown;
  }

  /** @param {PointerEvent} event */
  down(event) {
    this.canvas.setPointerCapture(event.pointerId);
    const from = this.secondOf(event);
    const width = this.canvas.getBoundingClientRect().width;
    const away = (/** @type {number} */ s) => Math.abs(this.share(s) - this.share(from)) * width;
    let other = null;
    if (this.loop && away(this.loop.a) < EDGE) other = this.loop.b;
    else if (this.loop && away(this.loop.b) < EDGE) other = this.loop.a;
    this.grip = { from, other, x: event.clientX };
  }

  /** @param {PointerEvent} event */
  move(event) {
    if (!this.grip || Math.abs(event.clientX - this.grip.x) < DRAG) return;
    const [from, to] = [this.grip.other ?? this.grip.from, this.secondOf(event)].sort((one, two) => one - two);
    const first = this.measure(from);
    this.drag = { a: this.chart.secondAt(4 * first), b: this.chart.secondAt(4 * Math.max(this.measure(to), first + 1)) };
  }

  /** @param {PointerEvent} event */
  up(event) {
    if (this.drag && this.drag.b > this.drag.a) this.about.loop(this.drag.a, this.drag.b);
    else if (this.grip) this.about.seek(this.secondOf(event));
    this.grip = this.drag = null;
  }

  /** The nearest measure: loops that are drawn are of whole measures, as they are named. @param {number} second */
  measure(second) {
    return Math.max(0, Math.round(this.chart.beatAt(second) / 4));
  }

  /** @param {number} second @param {{a: number, b: number} | null} loop @param {(passage: number) => boolean} chosen */
  draw(second, loop, chosen) {
    this.loop = loop;
    this.follow(second);
    const { canvas, context: c } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const box = canvas.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width * ratio));
    const height = Math.max(1, Math.round(box.height * ratio));
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const x = (/** @type {number} */ s) => this.share(s) * width;
    c.fillStyle = "#11142a";
    c.fillRect(0, 0, width, height);
    const bars = 0.68 * height;
    const most = Math.max(4, ...this.density.map((bar) => bar.rate));
    const wide = this.density.length ? (x(this.density[0].end) - x(this.density[0].start)) / ratio : NARROW;
    for (const bar of together(this.density, Math.ceil(NARROW / Math.max(wide, 0.01)))) {
      if (bar.end < this.view.from || bar.start > this.view.to) continue;
      c.fillStyle = heat(bar.rate / most);
      c.globalAlpha = bar.end <= second ? 1 : 0.62; // what was played is lighter
      const tall = (bar.rate / most) * (bars - 16 * ratio);
      const wider = Math.max(1, x(bar.end) - x(bar.start) - ratio);
      c.beginPath();
      c.roundRect(x(bar.start), bars - tall, wider, tall, Math.min(2 * ratio, wider / 2));
      c.fill();
    }
    c.globalAlpha = 1;
    this.drawFacing(x, bars, height, ratio);
    this.drawMarks(x, bars, ratio, chosen);
    this.drawLoop(this.drag ?? loop, x, height, ratio);
    if (this.nearness > 1.01) { // where in the song the part that is shown lies
      const whole = this.about.end - this.about.start;
      c.fillStyle = "#ffb454";
      c.fillRect(((this.view.from - this.about.start) / whole) * width, height - 3 * ratio, (this.shown / whole) * width, 3 * ratio);
    }
    c.fillStyle = "#fff";
    c.fillRect(Math.round(x(second)) - ratio, 0, 2 * ratio, height);
    canvas.setAttribute("aria-valuenow", second.toFixed(2));
  }

  /**
   * Where she faces: up is left, down is right.
   * @param {(s: number) => number} x @param {number} top @param {number} height @param {number} ratio
   */
  drawFacing(x, top, height, ratio) {
    const c = this.context;
    const middle = (top + height) / 2 + ratio;
    c.fillStyle = "rgba(255,255,255,0.18)";
    c.fillRect(0, middle, this.canvas.width, ratio);
    c.strokeStyle = "#8a92bd";
    c.lineWidth = ratio;
    c.beginPath();
    let before = middle;
    for (const { second, facing } of thinned(this.chart.rows, this.view, (NARROW * ratio * this.shown) / this.canvas.width)) {
      const y = middle - (clamp(facing, -180, 180) / 180) * (middle - top - 2 * ratio);
      c.lineTo(x(second), before);
      c.lineTo(x(second), y);
      before = y;
    }
    c.stroke();
  }

  /**
   * @param {(s: number) => number} x @param {number} bars @param {number} ratio
   * @param {(passage: number) => boolean} chosen
   */
  drawMarks(x, bars, ratio, chosen) {
    const c = this.context;
    let free = -Infinity;
    const byPlace = this.doc.passages
      .map((/** @type {import("./doc.js").Passage} */ passage, /** @type {number} */ k) => ({ passage, k }))
      .sort((one, two) => one.passage.start - two.passage.start);
    for (const { passage, k } of byPlace) {
      c.fillStyle = chosen(k) ? "#fff" : "#ffb454";
      c.fillRect(x(passage.start), bars - 4 * ratio, x(passage.end) - x(passage.start), 3 * ratio);
      c.font = `700 ${12 * ratio}px system-ui, sans-serif`;
      c.textBaseline = "top";
      c.textAlign = "left";
      const at = Math.max(x(passage.start) + ratio, free); // two of one place stand side by side
      free = at + c.measureText(String(k + 1)).width + 4 * ratio;
      c.fillText(String(k + 1), at, 1.5 * ratio);
    }
    for (const one of this.doc.findings) {
      if (one.second === null) continue;
      const at = x(one.second);
      c.fillStyle = this.doc.style.callout[one.severity] ?? "#fff";
      c.beginPath(); // shapes differ too: a square for errors, a triangle for warnings, a dot for the rest
      if (one.severity === "info") c.arc(at, bars + 4 * ratio, 2 * ratio, 0, 2 * Math.PI);
      else if (one.severity === "error") c.rect(at - 3.5 * ratio, bars + ratio, 7 * ratio, 7 * ratio);
      else {
        c.moveTo(at, bars + ratio);
        c.lineTo(at + 4 * ratio, bars + 8 * ratio);
        c.lineTo(at - 4 * ratio, bars + 8 * ratio);
      }
      c.fill();
    }
  }

  /**
   * @param {{a: number, b: number} | null} loop @param {(s: number) => number} x @param {number} height
   * @param {number} ratio
   */
  drawLoop(loop, x, height, ratio) {
    if (!loop) return;
    const c = this.context;
    c.fillStyle = "rgba(255,255,255,0.14)";
    c.fillRect(x(loop.a), 0, x(loop.b) - x(loop.a), height);
    c.fillStyle = "#fff";
    c.font = `700 ${12 * ratio}px system-ui, sans-serif`;
    c.textBaseline = "bottom";
    const outside = x(loop.b) - x(loop.a) < MARKS * ratio; // in a short loop there is no room for both
    for (const [edge, name, side] of /** @type {[number, string, 1 | -1][]} */ ([[loop.a, "A", 1], [loop.b, "B", -1]])) {
      c.fillRect(x(edge) - (side < 0 ? 2 * ratio : 0), 0, 2 * ratio, height);
      const way = outside ? -side : side;
      c.textAlign = way > 0 ? "left" : "right";
      c.fillText(name, x(edge) + 4 * way * ratio, height - 2 * ratio);
    }
  }
}

/**
 * Facings that are in sight; of rows that would lie closer than `apart` seconds their mean.
 * @param {{second: number, facing: number}[]} rows @param {{from: number, to: number}} view @param {number} apart
 */
export function thinned(rows, view, apart) {
  /** @type {{second: number, facing: number, count: number}[]} */
  const out = [];
  for (const { second, facing } of rows) {
    if (second < view.from - apart || second > view.to + apart) continue;
    const last = out[out.length - 1];
    if (!last || second - last.second >= apart) out.push({ second, facing, count: 1 });
    else last.facing += (facing - last.facing) / ++last.count;
  }
  return out;
}

/**
 * Bars of several measures drawn as one, as high as the highest of them. @param {{start: number, end: number, rate: number}[]} density
 * @param {number} count measures of one bar
 */
export function together(density, count) {
  if (count < 2) return density;
  return Array.from({ length: Math.ceil(density.length / count) }, (_, k) => density.slice(k * count, (k + 1) * count))
    .map((some) => ({ start: some[0].start, end: some[some.length - 1].end, rate: Math.max(...some.map(({ rate }) => rate)) }));
}

/** A bar's colour: blue where it is calm, red where most is to be done. @param {number} share 0..1 */
const heat = (share) => `hsl(${Math.round(232 + 108 * clamp(share, 0, 1) ** 1.5)} 58% 64%)`;

/** Rows a second in every measure. @param {import("./chart.js").Chart} chart */
function densityOf(chart) {
  /** @type {{start: number, end: number, rate: number}[]} */
  const out = [];
  for (const row of chart.rows) {
    const measure = Math.floor(row.beat / 4 + 1e-6);
    const [start, end] = [chart.secondAt(4 * measure), chart.secondAt(4 * measure + 4)];
    const last = out[out.length - 1];
    if (last && last.start === start) ++last.rate;
    else out.push({ start, end, rate: 1 });
  }
  for (const bar of out) bar.rate /= Math.max(bar.end - bar.start, 0.12);
  return out;
}
