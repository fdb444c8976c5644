// What the floor shows of feet and hands: where they are over it, how near, and how strongly they are marked.

import { UNPLAYED } from "./chart.js";

/**
 * @typedef {object} Mark
 * @property {number} limb 0 left foot, 1 right foot, 2 left palm, 3 right palm
 * @property {number[]} line heel x, z, toe x, z, metres
 * @property {number} ground height of what is below
 * @property {number} near 0..1, how near to it; below 0: no foot
 * @property {number} strength of the ring
 * @property {number} pressed 0..1, how lit a panel is that it presses and that is under it
 * @property {number[]} colour 0..1
 */

/**
 * Marks of left foot, right foot and palms (film/scene/renderer.py `feet_on_floor`).
 * @param {import("./doc.js").PageDoc} doc @param {import("./motion.js").Pose} pose
 * @param {Float32Array} lights four numbers a panel @returns {Mark[]}
 */
export function marksOf(doc, pose, lights) {
  const { stage, look, style } = doc;
  const reach = look.light.contact_height;
  return doc.body.marks.map((about, limb) => {
    const colour = style.limbs_rgb[limb].map((/** @type {number} */ c) => c / 255);
    const none = { limb, line: [0, 0, 0, 0], ground: 0, near: -1, strength: 0, pressed: 0, colour };
    if (!about) return none;
    const [heel, toe] = [0, 1].map((end) => place(pose, about.joints[end], about.at[end]));
    const x = (heel[0] + toe[0]) / 2;
    const z = (heel[2] + toe[2]) / 2;
    const over = stage.low[0] <= x && x <= stage.high[0] && stage.low[2] <= z && z <= stage.high[2];
    const ground = over ? 0 : -look.stage.pad_height;
    const height = Math.max(0, Math.min(heel[1], toe[1]) - ground);
    if (height >= (limb < 2 ? 1 : reach)) return none;
    const near = Math.max(0, 1 - height / reach);
    const t = Math.min(1, Math.max(0, (near - 0.88) / 0.07));
    const planted = t * t * (3 - 2 * t);
    const strength = look.stage.mark * (limb < 2 ? planted + (1 - planted) * (0.12 + 0.38 * near) : near);
    const line = [heel[0], heel[2], toe[0], toe[2]];
    const pressed = pressedBy(doc, line, colour, lights) * (limb < 2 ? planted : near);
    return { limb, line, ground, near, strength, pressed, colour };
  });
}

const UNDER = 0.75; // panel widths from a panel's middle at which a sole may still press it

/**
 * How lit a panel is that has the limb's colour and is under it, or partly so, 0..1.
 * @param {import("./doc.js").PageDoc} doc @param {number[]} line @param {number[]} colour @param {Float32Array} lights
 */
function pressedBy(doc, line, colour, lights) {
  const { panels, centre, width } = doc.pad;
  const way = [line[2] - line[0], line[3] - line[1]];
  const long = Math.max(way[0] ** 2 + way[1] ** 2, 1e-9);
  let most = 0;
  panels.forEach((/** @type {number[]} */ panel, /** @type {number} */ column) => {
    const lit = lights[4 * column + 3];
    if (lit <= most || colour.some((c, k) => Math.abs(c - lights[4 * column + k]) > 1e-3)) return;
    const from = [-(panel[0] - centre[0]) * width - line[0], (panel[1] - centre[1]) * width - line[1]];
    const along = Math.min(1, Math.max(0, (from[0] * way[0] + from[1] * way[1]) / long));
    if (Math.hypot(from[0] - along * way[0], from[1] - along * way[1]) < UNDER * width) most = lit;
  });
  return Math.min(most, 1);
}

/** @param {import("./motion.js").Pose} pose @param {number} joint @param {number[]} beside */
function place(pose, joint, beside) {
  const q = pose.turned(joint);
  const [w, x, y, z] = [q[0], q[1], q[2], q[3]];
  const tx = 2 * (y * beside[2] - z * beside[1]);
  const ty = 2 * (z * beside[0] - x * beside[2]);
  const tz = 2 * (x * beside[1] - y * beside[0]);
  const at = pose.at(joint);
  return [
    at[0] + beside[0] + w * tx + y * tz - z * ty,
    at[1] + beside[1] + w * ty + z * tx - x * tz,
    at[2] + beside[2] + w * tz + x * ty - y * tx,
  ];
}

/** Who asks for reduced motion sees panels light up softly in place of a flash. */
const BRIGHTEST = globalThis.matchMedia?.("(prefers-reduced-motion: reduce)").matches ? 0.4 : 1;
const HELD = 0.62; // brightness of a held panel after the flash (film/notes.py)

/**
 * Colour and brightness of each panel, four numbers a panel.
 * @param {import("./chart.js").Chart} chart @param {number} second @param {number} fade seconds
 * @param {number[][]} colours 0..255 by limb @param {Float32Array} out
 */
export function lightsAt(chart, second, fade, colours, out) {
  for (let column = 0; column < chart.columns; ++column) {
    const { level, limb } = lightOf(chart, column, second, fade);
    const colour = colours[limb] ?? colours[0];
    for (let k = 0; k < 3; ++k) out[4 * column + k] = colour[k] / 255;
    out[4 * column + 3] = level;
  }
}

/** What is left of a light when so much of its time is over; film/notes.py has the same. @param {number} share */
const lightLeft = (share) => Math.max(0, 1 - share * share);

/**
 * Brightness 0..1 of one column and the limb of its last press.
 * @param {import("./chart.js").Chart} chart @param {number} column @param {number} second @param {number} fade
 */
export function lightOf(chart, column, second, fade) {
  const n = chart.lastPress(column, second + 1e-6);
  if (n < 0 || (chart.limb[n] === UNPLAYED && !chart.given.has(n))) return { level: 0, limb: -1 };
  const start = chart.second[n];
  const end = chart.end[n];
  const fresh = lightLeft((second - start) / fade);
  const level = second < end
    ? Math.max(HELD, fresh)
    : lightLeft((second - end) / fade) * (end === start ? 1 : HELD);
  return { level: Math.min(BRIGHTEST, level), limb: chart.given.get(n) ?? chart.limb[n] };
}
