// Drawings of notes: shapes, bodies of holds and rolls, mines, markers of the limb, signs of the verdict.

import { GOOD, WINDOW } from "./judge.js";

// Corners of an arrow that points up, in halves of its size (film/overlay/sprites.py).
const ARROW = [[0, -0.94], [0.94, 0], [0.62, 0.32], [0.36, 0.06], [0.36, 0.88], [-0.36, 0.88], [-0.36, 0.06],
  [-0.62, 0.32], [-0.94, 0]];
const SQUARE = [[-0.86, -0.86], [0.86, -0.86], [0.86, 0.86], [-0.86, 0.86]];
const WIDTH = 1.88; // of an arrow, whichever way it points
/** @type {Map<number | null, number[][]>} */
const shapes = new Map();
export const INK = "#0a0b14";
export const NOBODY = "#969aaa"; // of a note that nobody plays

/** @typedef {CanvasRenderingContext2D} Context */

/**
 * Corners of a note's shape, in halves of its size; a diagonal fills its lane as others do.
 * @param {number | null} way
 */
export function corners(way) {
  if (way === null) return SQUARE;
  const [cos, sin] = [Math.cos((way * Math.PI) / 180), Math.sin((way * Math.PI) / 180)];
  const turned = ARROW.map(([px, py]) => [px * cos - py * sin, px * sin + py * cos]);
  if (way % 90 === 0) return turned;
  const spans = [0, 1].map((i) => [Math.min(...turned.map((p) => p[i])), Math.max(...turned.map((p) => p[i]))]);
  const scale = WIDTH / Math.max(...spans.map(([least, most]) => most - least));
  return turned.map((p) => p.map((value, i) => (value - (spans[i][0] + spans[i][1]) / 2) * scale));
}

/**
 * Path of a note's shape: an arrow turned by some degrees, a square where there is none to be turned.
 * @param {Context} c @param {number | null} way @param {number} x @param {number} y @param {number} size
 */
export function notePath(c, way, x, y, size) {
  if (!shapes.has(way)) shapes.set(way, corners(way));
  c.beginPath();
  for (const [px, py] of shapes.get(way) ?? SQUARE) c.lineTo(x + (px * size) / 2, y + (py * size) / 2);
  c.closePath();
}

/**
 * The body of a hold, or of a roll with its stripes.
 * @param {Context} c @param {{x: number, top: number, bottom: number, width: number}} box
 * @param {string} colour @param {boolean} roll @param {number} ratio pixels of the canvas for one of CSS
 */
export function drawBody(c, { x, top, bottom, width }, colour, roll, ratio) {
  c.fillStyle = colour;
  c.beginPath();
  c.roundRect(x - width / 2, top, width, Math.max(bottom - top, 1), [0, 0, width / 2, width / 2]);
  c.fill();
  c.lineWidth = 1.5 * ratio;
  c.strokeStyle = "rgba(255,255,255,0.85)";
  c.stroke();
  if (!roll) return;
  c.save();
  c.clip();
  c.strokeStyle = "rgba(255,255,255,0.5)";
  c.lineWidth = 3 * ratio;
  for (let at = top; at < bottom + width; at += 0.4 * width) {
    c.beginPath();
    c.moveTo(x - width / 2, at);
    c.lineTo(x, at - 0.25 * width);
    c.lineTo(x + width / 2, at);
    c.stroke();
  }
  c.restore();
}

/** @param {Context} c @param {string} colour @param {number} x @param {number} y @param {number} size */
export function drawMine(c, colour, x, y, size) {
  c.beginPath();
  for (let k = 0; k < 16; ++k) {
    const radius = (k % 2 ? 0.3 : 0.37) * size;
    const angle = (k * Math.PI) / 8;
    c.lineTo(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
  }
  c.closePath();
  c.fillStyle = "#1a1a22";
  c.fill();
  c.lineWidth = 0.03 * size;
  c.strokeStyle = "#fff";
  c.stroke();
  c.strokeStyle = colour;
  c.lineWidth = 0.075 * size;
  c.beginPath();
  c.arc(x, y, 0.22 * size, 0, 2 * Math.PI);
  for (const [dx, dy] of [[1, 1], [1, -1]]) {
    c.moveTo(x - 0.11 * size * dx, y - 0.11 * size * dy);
    c.lineTo(x + 0.11 * size * dx, y + 0.11 * size * dy);
  }
  c.stroke();
}

/**
 * Where a marker stands on a note, from its middle, and how large it is: on an arrow's tail, so that it is seen where that
 * points.
 * @param {number | null} way @param {number} size
 * @param {{aside: number[], size: number}} mark the style's, for arrows of size 1
 */
export function markerAt(way, size, mark) {
  if (way === null) return { x: 0, y: 0, size: 0.5 * size };
  const far = mark.aside[way % 90 ? 1 : 0] * size;
  const angle = (way * Math.PI) / 180;
  return { x: -far * Math.sin(angle), y: far * Math.cos(angle), size: mark.size * size };
}

/**
 * Draw the marker of a limb with its letter: a disc for the left foot, a square for the right one, a ring for hands; a cross for nobody.
 * @param {Context} c @param {{limb: number, colour: string, changed: boolean}} who changed: by the author
 * @param {number} x @param {number} y @param {number} size
 */
export function drawMarker(c, { limb, colour, changed }, x, y, size) {
  const right = limb % 2 === 1;
  c.beginPath();
  if (right) c.roundRect(x - 0.46 * size, y - 0.46 * size, 0.92 * size, 0.92 * size, 0.15 * size);
  else c.arc(x, y, 0.48 * size, 0, 2 * Math.PI);
  c.fillStyle = colour;
  c.fill();
  c.lineWidth = 0.08 * size;
  c.strokeStyle = changed ? "#fff" : INK;
  c.stroke();
  if (limb < 0) {
    c.beginPath();
    for (const dy of [-1, 1]) {
      c.moveTo(x - 0.22 * size, y - 0.22 * size * dy);
      c.lineTo(x + 0.22 * size, y + 0.22 * size * dy);
    }
    c.lineWidth = 0.12 * size;
    c.strokeStyle = INK;
    c.stroke();
    return;
  }
  if (limb >= 2) {
    c.beginPath();
    c.arc(x, y, 0.33 * size, 0, 2 * Math.PI);
    c.strokeStyle = INK;
    c.stroke();
  }
  c.fillStyle = INK;
  c.font = `800 ${Math.round(0.66 * size)}px system-ui, sans-serif`;
  c.textAlign = "center";
  c.textBaseline = "middle";
  c.fillText(right ? "R" : "L", x, y + 0.04 * size);
}

export const COLOURS = /** @type {Record<string, string>} */ ({
  hit: "#6fe38a",
  early: "#ffc857",
  late: "#ffa14a",
  miss: "#ff6b6b",
  wrong: "#ff6b6b",
});
export const VERDICTS = Object.keys(COLOURS);

/**
 * Draw a sign at a note that was missed, or pressed early or late.
 * @param {Context} c @param {string} verdict @param {number} x @param {number} y @param {number} size @param {number} ratio
 */
export function drawVerdict(c, verdict, x, y, size, ratio) {
  c.font = `700 ${Math.round(0.5 * size)}px system-ui, sans-serif`;
  c.textAlign = "center";
  c.textBaseline = "middle";
  c.lineWidth = 3 * ratio;
  c.strokeStyle = INK;
  c.fillStyle = COLOURS[verdict];
  const sign = verdict === "miss" ? "✕" : verdict === "early" ? "−" : "+";
  c.strokeText(sign, x + 0.42 * size, y - 0.3 * size);
  c.fillText(sign, x + 0.42 * size, y - 0.3 * size);
}

/**
 * Draw the verdict of a press at a receptor: a ring, or a cross for a wrong press.
 * @param {Context} c @param {string} verdict @param {number} x @param {number} y @param {number} size
 */
export function drawPress(c, verdict, x, y, size) {
  c.strokeStyle = COLOURS[verdict];
  c.lineWidth = 0.1 * size;
  c.beginPath();
  if (verdict === "wrong") {
    for (const way of [1, -1]) {
      c.moveTo(x - 0.4 * size, y - 0.4 * way * size);
      c.lineTo(x + 0.4 * size, y + 0.4 * way * size);
    }
  } else c.arc(x, y, 0.56 * size, 0, 2 * Math.PI);
  c.stroke();
}

/**
 * Write a verdict above the receptors.
 * @param {Context} c @param {string} colour @param {string} word @param {number} x its middle @param {number} y
 * @param {number} size pixels of the canvas
 */
export function drawWord(c, colour, word, x, y, size) {
  c.font = `800 ${Math.round(size)}px system-ui, sans-serif`;
  c.textAlign = "center";
  c.textBaseline = "middle";
  c.lineJoin = "round";
  c.lineWidth = 0.25 * size;
  c.strokeStyle = INK;
  c.strokeText(word, x, y);
  c.fillStyle = colour;
  c.fillText(word, x, y);
}

/**
 * A scale of how late the last presses were, early ones left: the newest is the brightest, a triangle stands at their mean.
 * @param {Context} c @param {number[]} errors seconds @param {{x: number, y: number, width: number, ratio: number}} place its middle
 */
export function drawErrors(c, errors, { x, y, width, ratio }) {
  const at = (/** @type {number} */ error) => x + (0.5 * width * Math.max(-WINDOW, Math.min(error, WINDOW))) / WINDOW;
  const colour = (/** @type {number} */ error) => COLOURS[Math.abs(error) <= GOOD ? "hit" : error < 0 ? "early" : "late"];
  c.globalAlpha = 0.6;
  c.fillStyle = INK; // a note that is over may still be seen below it
  c.fillRect(x - 0.5 * width - 4 * ratio, y - 7 * ratio, width + 8 * ratio, 14 * ratio);
  c.globalAlpha = 0.85;
  for (const [from, to, fill] of /** @type {[number, number, string][]} */ ([
    [-WINDOW, -GOOD, COLOURS.early],
    [-GOOD, GOOD, COLOURS.hit],
    [GOOD, WINDOW, COLOURS.late],
  ])) {
    c.fillStyle = fill;
    c.fillRect(at(from), y - 1.5 * ratio, at(to) - at(from), 3 * ratio);
  }
  errors.forEach((error, k) => {
    c.globalAlpha = 0.25 + (0.75 * (k + 1)) / errors.length;
    c.fillStyle = colour(error);
    c.fillRect(at(error) - ratio, y - 6 * ratio, 2 * ratio, 12 * ratio);
  });
  c.globalAlpha = 1;
  c.fillStyle = "#fff";
  c.fillRect(x - 0.5 * ratio, y - 6 * ratio, ratio, 12 * ratio);
  if (!errors.length) return;
  const mean = at(errors.reduce((sum, error) => sum + error, 0) / errors.length);
  c.beginPath();
  c.moveTo(mean, y - 5 * ratio);
  c.lineTo(mean - 4 * ratio, y - 11 * ratio);
  c.lineTo(mean + 4 * ratio, y - 11 * ratio);
  c.fill();
}
