// Words beside the notes: in a gutter right of the lanes, or, where there is no room for one, between the notes.

import { clamp } from "./maths.js";

export const GUTTER = 98; // pixels
const PAD = 5; // pixels beside the words
const LINES = 3; // of a label at most

/** @typedef {{label: import("./labels.js").Label, y: number}} Seen a label and where its row is on the canvas, pixels */

/**
 * Each label at its row: its whole text where there is room until the next one, else without what is in brackets, else its
 * short name. One that would lie over the one before is only a tick at the lanes. It fades when its row is over.
 * @param {CanvasRenderingContext2D} c @param {Seen[]} seen in order of time
 * @param {{x: number, receptor: number, lane: number, size: number, wide: number, ratio: number}} m x: the lanes' right edge; size: of the words
 * @param {Record<string, string>} colours
 */
export function drawGutter(c, seen, { x, receptor, lane, size, wide, ratio }, colours) {
  const high = 1.3 * size;
  const fits = (/** @type {string} */ line) => c.measureText(line).width <= wide - (PAD + 4) * ratio;
  let free = -Infinity;
  c.textAlign = "left";
  seen.forEach(({ label, y }, k) => {
    c.globalAlpha = clamp(1 + (y - receptor) / lane, 0, 1);
    c.fillStyle = colours[label.severity];
    c.fillRect(x, y - ratio, PAD * ratio, 2 * ratio);
    if (y - high / 2 < free) return;
    const room = Math.floor(((seen[k + 1]?.y ?? Infinity) - y) / high + 0.01);
    const most = clamp(room, 1, LINES);
    const shown = [label.text, unexplained(label.text)].map((text) => wrapped(text, fits)).find((lines) => lines && lines.length <= most)
      ?? [cut(label.short, fits)];
    shown.forEach((line, n) => c.fillText(line, x + (PAD + 4) * ratio, y + n * high));
    free = y + (shown.length - 0.5) * high;
  });
  c.globalAlpha = 1;
}

/**
 * The names of moves without what explains them: "bracket (two panels with one foot)" is "bracket".
 * @param {string} text
 */
export const unexplained = (text) => text.replace(/ \([^)]*\)/g, "");

/** Lines of words that fit; null if a word does not. @param {string} text @param {(line: string) => boolean} fits */
function wrapped(text, fits) {
  /** @type {string[]} */
  const lines = [];
  for (const word of text.split(" ")) {
    const longer = lines.length ? `${lines[lines.length - 1]} ${word}` : word;
    if (!fits(word)) return null;
    if (lines.length && fits(longer)) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/** @param {string} text @param {(line: string) => boolean} fits */
function cut(text, fits) {
  let shown = text;
  while (shown.length > 3 && !fits(shown)) shown = `${shown.slice(0, -2)}…`;
  return shown;
}

/**
 * A label's short name between the notes, if it fits; it is gone before its row is at the receptors.
 * @param {CanvasRenderingContext2D} c @param {Seen} seen @param {[number, number]} gap that is free of notes
 * @param {number} end of the canvas
 * @param {{receptor: number, lane: number, size: number, ratio: number}} m @param {string} colour
 */
export function drawBetween(c, { label, y }, [left, right], end, { receptor, lane, size, ratio }, colour) {
  c.textAlign = "left";
  const pad = PAD * ratio;
  const wide = c.measureText(label.short).width + 2 * pad;
  if (wide > right - left) return;
  const x = right >= end ? left : left <= 0 ? right - wide : 0.5 * (left + right - wide);
  c.globalAlpha = clamp((y - receptor - 0.7 * lane) / (0.5 * lane), 0, 1);
  c.fillStyle = "rgba(12, 14, 26, 0.82)";
  c.beginPath();
  c.roundRect(x, y - 0.75 * size, wide, 1.5 * size, 4 * ratio);
  c.fill();
  c.fillStyle = colour;
  c.fillText(label.short, x + pad, y);
  c.globalAlpha = 1;
}
