// The scrolling notes on a 2-D canvas, in the films' colours, with L and R markers.

import { KIND, UNPLAYED } from "./chart.js";
import { lightOf } from "./feet.js";
import { GUTTER, drawBetween, drawGutter } from "./gutter.js";
import { labelsOf } from "./labels.js";
import { clamp } from "./maths.js";
import {
  COLOURS,
  INK,
  NOBODY,
  VERDICTS,
  drawBody,
  drawErrors,
  drawMarker,
  drawMine,
  drawPress,
  drawVerdict,
  drawWord,
  markerAt,
  notePath,
} from "./noteart.js";
import { SHOWN } from "./practice.js";

/**
 * @typedef {object} Scene
 * @property {number} second of the music now
 * @property {number} speed screen heights a second of music takes, before the rate
 * @property {boolean} mirror lanes the other way round
 * @property {(limb: number, row: import("./chart.js").Row | undefined) => boolean} marked whether a marker is drawn
 * @property {Map<number, string>} verdicts by note: "hit", "early", "late", "miss"
 * @property {(note: number) => boolean} asked whether who plays along has to press it
 * @property {{a: number, b: number} | null} loop
 * @property {Map<number, number>} feet limbs the author gave to notes
 * @property {number} chosen note that is chosen, or -1
 * @property {boolean} along whether somebody plays along
 * @property {number[]} errors how late the last presses were, seconds
 * @property {string[]} keys of the panels, to be shown while somebody plays along; else none
 * @property {boolean[]} held panels that are pressed by who plays along
 * @property {string} passed how the last passes went, while the next one is counted in
 * @property {import("./practice.js").Feedback | null} feedback the verdict of the last press
 */

export class Highway {
  /**
   * @param {HTMLCanvasElement} canvas @param {import("./doc.js").PageDoc} doc @param {import("./chart.js").Chart} chart
   * @param {import("./words.js").Translate} t
   */
  constructor(canvas, doc, chart, t) {
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.doc = doc;
    this.style = doc.style;
    this.chart = chart;
    this.directions = /** @type {(number | null)[]} */ (doc.pad.directions);
    /** @type {Map<number, import("./chart.js").Row>} */
    this.rowOf = new Map();
    for (const row of chart.rows) for (const step of row.steps) this.rowOf.set(step.note, row);
    this.labels = labelsOf(doc, chart, t);
    this.words = verdictWords(t);
    this.along = false; // somebody plays along: verdicts need room above the receptors, fingers wide lanes
  }

  /** Words of another language. @param {import("./words.js").Translate} t */
  speak(t) {
    this.labels = labelsOf(this.doc, this.chart, t);
    this.words = verdictWords(t);
  }

  /**
   * Where a column's arrow points, as her panels are seen; null for a square.
   * @param {number} column @param {boolean} mirror
   */
  way(column, mirror) {
    const way = this.directions[column];
    return way === null ? null : way + (mirror ? 180 : 0);
  }

  /** Sizes for the canvas as it is now. */
  measure() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const box = this.canvas.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width * ratio));
    const height = Math.max(1, Math.round(box.height * ratio));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const { columns, beats } = this.chart;
    const finger = this.along && window.innerWidth <= NARROW;
    // Room left of the lanes, for the last measure's number.
    const numbers = finger && columns > 5 ? 0 : (8 + 7 * String(beats.length >> 2).length) * ratio;
    // And right of them.
    const gutter = this.labels.length && width - numbers - GUTTER * ratio >= ROOMY * ratio * columns ? GUTTER * ratio : 0;
    const beside = finger && !gutter ? 0 : Math.max(gutter, Math.min(numbers, 8 * ratio));
    const lane = Math.min((width - numbers - beside) / columns, WIDEST * ratio);
    const left = Math.max(numbers, 0.5 * (width - gutter - lane * columns));
    const above = this.along ? Math.min(VERDICT * ratio, SHARE * height) : 0;
    return { ratio, above, width, height, lane, left, gutter, receptor: Math.max(0.11 * height, 0.62 * lane + above), size: 0.92 * lane };
  }

  /**
   * x of the middle of a lane.
   * @param {number} column @param {{lane: number, left: number}} m @param {boolean} mirror
   */
  laneX(column, m, mirror) {
    const place = mirror ? this.chart.columns - 1 - column : column;
    return m.left + (place + 0.5) * m.lane;
  }

  /** @param {Scene} scene */
  draw(scene) {
    this.along = scene.along;
    const m = this.measure();
    const { context: c, chart, style } = this;
    const y = (/** @type {number} */ second) => m.receptor + (second - scene.second) * scene.speed * m.height;
    const until = scene.second + (m.height - m.receptor + m.lane) / (scene.speed * m.height);
    const from = scene.second - (m.receptor + m.lane) / (scene.speed * m.height);
    c.fillStyle = GROUND;
    c.fillRect(0, 0, m.width, m.height);
    this.drawLanes(m);
    if (scene.loop) {
      c.fillStyle = "rgba(255, 255, 255, 0.07)";
      c.fillRect(0, y(scene.loop.a), m.width, y(scene.loop.b) - y(scene.loop.a));
      c.fillStyle = style.accent;
      for (const edge of [scene.loop.a, scene.loop.b]) c.fillRect(m.left, Math.round(y(edge)), m.lane * chart.columns, 2 * m.ratio);
    }
    this.drawBeats(m, y, from, until);
    for (let column = 0; column < chart.columns; ++column) {
      const { level, limb } = lightOf(chart, column, scene.second, style.flash);
      this.drawReceptor(column, m, scene, level, limb);
    }
    const held = JSON.stringify(scene.held.flatMap((is, column) => (is ? [column] : [])));
    if (this.canvas.dataset.held !== held) this.canvas.dataset.held = held;
    const { feedback } = scene;
    if (feedback && feedback.column >= 0) drawPress(c, feedback.verdict, this.laneX(feedback.column, m, scene.mirror), m.receptor, m.size);
    for (let n = chart.second.length - 1; n >= 0; --n) {
      if (chart.second[n] > until || chart.end[n] < from) continue;
      this.drawNote(n, m, scene, y);
    }
    this.drawLabels(m, y, scene.along ? scene.second : from, until, scene.mirror);
    const x = m.left + 0.5 * m.lane * chart.columns;
    if (scene.passed) this.drawPassed(scene.passed.split(" · "), x, m);
    else if (scene.along)
      drawErrors(c, scene.errors, {
        x,
        y: m.receptor - 0.62 * m.lane - 0.26 * m.above,
        width: Math.min(0.8 * m.lane * chart.columns, 220 * m.ratio),
        ratio: m.above / VERDICT,
      });
    if (feedback && !scene.passed) this.drawFeedback(feedback, x, m);
  }

  /**
   * How the last passes of a loop went, where verdicts come else.
   * @param {string[]} lines one or two @param {number} x @param {ReturnType<Highway["measure"]>} m
   */
  drawPassed(lines, x, m) {
    const most = m.lane * this.chart.columns;
    lines.forEach((line, k) => {
      this.context.font = "800 100px system-ui, sans-serif";
      const size = Math.min((k ? 0.24 : 0.34) * m.above, (100 * most) / this.context.measureText(line).width);
      drawWord(this.context, "#fff", line, x, m.receptor - 0.62 * m.lane - (k ? 0.26 : 0.66) * m.above, size);
    });
  }

  /**
   * The verdict of the last press, the notes in a row left of it, and right how early or late it was: above the
   * receptors, where no note comes.
   * @param {import("./practice.js").Feedback} feedback @param {number} x @param {ReturnType<Highway["measure"]>} m
   */
  drawFeedback({ verdict, at, run, error }, x, m) {
    const c = this.context;
    const y = m.receptor - 0.62 * m.lane - 0.68 * m.above;
    const edge = 0.5 * m.lane * this.chart.columns - 0.4 * m.above;
    const late = error === undefined || verdict === "hit" ? "" : `${Math.round(1000 * Math.abs(error))} ms`;
    c.globalAlpha = clamp(2 - (2 * (performance.now() - at)) / SHOWN, 0, 1);
    drawWord(c, COLOURS[verdict], this.words[verdict], x, y, 0.36 * m.above);
    const small = Math.max(0.2 * m.above, LEAST * m.ratio);
    if (run >= RUN) drawWord(c, "#fff", `${run} ×`, x - edge, y, small);
    drawWord(c, "#fff", late, x + edge, y, small);
    c.globalAlpha = 1;
  }

  /** @param {ReturnType<Highway["measure"]>} m */
  drawLanes(m) {
    const c = this.context;
    c.fillStyle = this.style.background;
    c.fillRect(m.left, 0, m.lane * this.chart.columns, m.height);
    c.fillStyle = "rgba(255, 255, 255, 0.1)";
    for (let k = 0; k <= this.chart.columns; ++k) c.fillRect(Math.round(m.left + k * m.lane), 0, m.ratio, m.height);
  }

  /**
   * @param {ReturnType<Highway["measure"]>} m @param {(s: number) => number} y @param {number} from
   * @param {number} until
   */
  drawBeats(m, y, from, until) {
    const c = this.context;
    const beats = this.chart.beats;
    c.font = `${Math.round(LEAST * m.ratio)}px system-ui, sans-serif`;
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (let k = Math.max(0, Math.floor(this.chart.beatAt(from))); k < beats.length && beats[k] <= until; ++k) {
      const bar = k % 4 === 0;
      c.fillStyle = bar ? "rgba(255,255,255,0.34)" : "rgba(255,255,255,0.12)";
      c.fillRect(m.left, Math.round(y(beats[k])), m.lane * this.chart.columns, (bar ? 2 : 1) * m.ratio);
      if (bar) {
        c.fillStyle = "#9aa0bd";
        c.fillText(String(k / 4), m.left - 5 * m.ratio, y(beats[k]));
      }
    }
  }

  /**
   * @param {number} column @param {ReturnType<Highway["measure"]>} m @param {Scene} scene
   * @param {number} level @param {number} limb
   */
  drawReceptor(column, m, scene, level, limb) {
    const c = this.context;
    const x = this.laneX(column, m, scene.mirror);
    if (level > 0) {
      const colour = this.style.limbs[limb] ?? this.style.receptor;
      const glow = c.createRadialGradient(x, m.receptor, 0.2 * m.size, x, m.receptor, 0.75 * m.size);
      glow.addColorStop(0, colour);
      glow.addColorStop(1, "rgba(0,0,0,0)");
      c.globalAlpha = level;
      c.fillStyle = glow;
      c.fillRect(x - m.size, m.receptor - m.size, 2 * m.size, 2 * m.size);
      c.globalAlpha = 1;
    }
    notePath(c, this.way(column, scene.mirror), x, m.receptor, 0.98 * m.size);
    c.fillStyle = INK;
    c.fill();
    c.lineWidth = Math.max(1.5, (scene.held[column] ? 0.14 : 0.05) * m.size);
    c.strokeStyle = scene.held[column] ? "#fff" : this.style.receptor;
    c.stroke();
    if (!scene.keys[column] || ARROWS.includes(scene.keys[column])) return; // the receptor is that arrow
    c.fillStyle = "#c9cfe8";
    c.font = `700 ${Math.round(Math.max(LEAST * m.ratio, 0.22 * m.size))}px ui-monospace, monospace`;
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.fillText(scene.keys[column], x, m.receptor - 0.68 * m.size);
  }

  /**
   * @param {number} n @param {ReturnType<Highway["measure"]>} m @param {Scene} scene @param {(s: number) => number} y
   */
  drawNote(n, m, scene, y) {
    const { context: c, chart, style } = this;
    const kind = chart.kind[n];
    const column = chart.column[n];
    if (column >= chart.columns) return;
    const verdict = scene.verdicts.get(n);
    const held = chart.end[n] > chart.second[n];
    const head = held && scene.second > chart.second[n] ? Math.min(scene.second, chart.end[n]) : chart.second[n];
    const x = this.laneX(column, m, scene.mirror);
    const top = y(head);
    const rest = scene.along ? passedAlpha(m.receptor - top, m.lane) : 1;
    if (rest <= 0) return;
    c.globalAlpha = rest * (verdict === "hit" || !scene.asked(n) ? 0.35 : 1);
    const whose = style.players[chart.player[n] - 1]; // of a chart for two
    if (held) {
      const roll = kind === KIND.ROLL;
      drawBody(c, { x, top, bottom: y(chart.end[n]), width: 0.56 * m.size }, whose ?? (roll ? style.roll : style.hold), roll, m.ratio);
    }
    if (kind === KIND.MINE) {
      drawMine(c, style.mine, x, top, m.size);
    } else {
      const fake = kind === KIND.FAKE || !chart.judged[n];
      const colour = fake ? style.fake : whose ?? style.quantisation[chart.quant[n]];
      notePath(c, this.way(column, scene.mirror), x, top, m.size);
      c.fillStyle = kind === KIND.LIFT ? INK : colour;
      c.fill();
      c.lineJoin = "round";
      c.lineWidth = Math.max(1.5, 0.055 * m.size);
      c.strokeStyle = kind === KIND.LIFT ? colour : "#fff";
      c.stroke();
      const changed = scene.feet.has(n);
      const limb = changed ? /** @type {number} */ (scene.feet.get(n)) : chart.limb[n];
      const row = this.rowOf.get(n);
      const mark = markerAt(this.way(column, scene.mirror), m.size, style.mark);
      mark.size = Math.max(mark.size, Math.min(LETTER * m.ratio, 0.5 * m.size)); // but where the arrow points is still to be seen
      if (!fake && limb >= 0 && (changed || scene.marked(limb, row))) {
        drawMarker(c, { limb, colour: style.limbs[limb], changed }, x + mark.x, top + mark.y, mark.size);
      } else if (!fake && limb === UNPLAYED) {
        drawMarker(c, { limb, colour: NOBODY, changed }, x + mark.x, top + mark.y, mark.size);
      }
      if (n === scene.chosen) {
        c.lineWidth = 3 * m.ratio;
        c.strokeStyle = "#fff";
        c.strokeRect(x - 0.56 * m.size, top - 0.56 * m.size, 1.12 * m.size, 1.12 * m.size);
      }
    }
    c.globalAlpha = rest;
    if (verdict && verdict !== "hit") drawVerdict(c, verdict, x, top, m.size, m.ratio);
    c.globalAlpha = 1;
  }

  /**
   * Words beside the notes.
   * @param {ReturnType<Highway["measure"]>} m @param {(s: number) => number} y @param {number} from
   * @param {number} until @param {boolean} mirror
   */
  drawLabels(m, y, from, until, mirror) {
    const { context: c, chart } = this;
    const size = Math.round(LEAST * m.ratio);
    c.font = `600 ${size}px system-ui, sans-serif`;
    c.textBaseline = "middle";
    const seen = this.labels.filter(({ second }) => second >= from && second <= until).map((label) => ({ label, y: y(label.second) }));
    const colours = this.style.callout;
    if (m.gutter) return drawGutter(c, seen, { ...m, x: m.left + m.lane * chart.columns, size, wide: m.gutter }, colours);
    for (const one of seen) {
      const beside = (/** @type {number} */ n) =>
        y(chart.second[n]) - one.y < 0.5 * m.size + size && one.y - y(chart.end[n]) < 0.5 * m.size + size;
      const near = [...chart.second.keys()].filter(beside).map((n) => this.laneX(chart.column[n], m, mirror));
      drawBetween(c, one, widestGap(near, 0.5 * m.lane, m.width), m.width, { ...m, size }, colours[one.label.severity]);
    }
  }

  /**
   * The lane at a place of the canvas, the nearest one beside them: fingers are wide.
   * @param {number} px pixels of CSS @param {boolean} mirror
   */
  columnAt(px, mirror) {
    const m = this.measure();
    const place = clamp(Math.floor((px * m.ratio - m.left) / m.lane), 0, this.chart.columns - 1);
    return mirror ? this.chart.columns - 1 - place : place;
  }

  /**
   * The note under a point of the canvas, in its own pixels of CSS; -1 if there is none.
   * @param {number} px @param {number} py @param {Scene} scene
   */
  noteAt(px, py, scene) {
    const m = this.measure();
    let best = -1;
    let least = 0.62 * m.lane;
    for (let n = 0; n < this.chart.second.length; ++n) {
      const y = m.receptor + (this.chart.second[n] - scene.second) * scene.speed * m.height;
      const x = this.laneX(this.chart.column[n], m, scene.mirror);
      const away = Math.max(Math.abs(px * m.ratio - x), Math.abs(py * m.ratio - y));
      if (away < least && this.rowOf.has(n)) [best, least] = [n, away];
    }
    return best;
  }
}

/**
 * What is left of a note that has gone by the receptors: above them stands the verdict.
 * @param {number} above pixels @param {number} lane pixels
 */
export const passedAlpha = (above, lane) => clamp(1.5 - (2 * above) / lane, 0, 1);

/**
 * Where most room is beside notes; as much on the right as on the left is on the right.
 * @param {number[]} middles of the notes @param {number} half their width @param {number} end of the room
 * @returns {[number, number]}
 */
export function widestGap(middles, half, end) {
  const sorted = [...middles].sort((a, b) => a - b);
  const gaps = [...sorted, end + half].map((x, k) => /** @type {[number, number]} */ ([k ? sorted[k - 1] + half : 0, x - half]));
  return gaps.reduce((best, gap) => (gap[1] - gap[0] >= best[1] - best[0] ? gap : best));
}

const LEAST = 12; // pixels of the smallest words
export const NARROW = 860; // pixels of a phone's window, as in page.css
const VERDICT = 68; // pixels above the receptors for a verdict and the scale of errors
const SHARE = 0.15; // of a low canvas that they take at most
const WIDEST = 96; // pixels of a lane
const ROOMY = 44; // pixels of a lane that are left beside a gutter for words
const LETTER = 14; // pixels of the sign of a foot, at least
const RUN = 4; // notes in a row from which their number is shown
const ARROWS = "←↑→↓↖↗↘↙";
const GROUND = "#171a30"; // beside the lanes: that of the panels
const SLOWEST = 0.42; // canvas heights a second
const FASTEST = 1.2; // what comes quicker cannot be read
const APART = 0.085; // heights between the rows of a chart's quick parts: about a note's

/**
 * Speed of a chart's notes in canvas heights a second: quicker for quick ones, whose notes would lie over one another.
 * @param {number[]} rows their seconds, ascending
 */
export function scrollSpeed(rows) {
  const gaps = rows.slice(1).map((second, k) => second - rows[k]).filter((gap) => gap > 0.02).sort((a, b) => a - b);
  const quick = gaps[Math.floor(gaps.length / 5)] ?? Infinity;
  return clamp(APART / quick, SLOWEST, FASTEST);
}

/** @param {import("./words.js").Translate} t @returns {Record<string, string>} */
function verdictWords(t) {
  return Object.fromEntries(VERDICTS.map((name) => [name, t(`verdict-${name}`)]));
}
