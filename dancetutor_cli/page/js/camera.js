// Cameras: the presets of configs/picture.yaml, fitted to the canvas as in the films, and one that turns by hand.

import { clamp, cross, dot, minus, plus } from "./maths.js";

const NEAR = 0.05;
const FAR = 100;
const WAIST = 0.85; // metres; where the free camera looks from afar
const ARM = 0.42; // metres beside her middle that are to be seen of her
const TALL = 0.5; // width by height of a picture in which she is low: a phone's
const FLOOR = 0.4; // of the room above and below her, that goes above: at most a half
const LEAST_ARMS = 0.05; // of the room for arms beside the pad that is kept in a picture half as wide as all of it: she would be tiny

/**
 * @typedef {object} Camera
 * @property {[number, number, number]} position
 * @property {[number, number, number]} target
 * @property {number} focal in picture heights
 * @property {[number, number]} centre where the line of sight meets the picture, 0..1
 * @property {boolean} feetOnly
 * @property {boolean} mirror the picture is turned left to right
 */

/**
 * Right, up and forward; straight down the side of the screen is up, as on a plan of the pad.
 * @param {{position: ArrayLike<number>, target: ArrayLike<number>}} camera
 */
export function axes(camera) {
  const way = minus(camera.target, camera.position);
  const length = Math.hypot(...way);
  let forward = /** @type {[number, number, number]} */ (way.map((x) => x / length));
  const flat = Math.hypot(forward[0], forward[2]);
  /** @type {[number, number, number]} */
  let right = [-forward[2] / flat, 0, forward[0] / flat];
  if (flat < 1e-3) {
    forward = [0, Math.sign(forward[1]), 0];
    right = [-1, 0, 0];
  }
  return { right, up: cross(right, forward), forward };
}

/**
 * World to clip space, 4 x 4 row by row.
 * @param {Camera} camera @param {number} width @param {number} height
 */
export function matrix(camera, width, height) {
  const { right, up, forward } = axes(camera);
  const out = new Float32Array(16);
  const flip = camera.mirror ? -1 : 1;
  for (let k = 0; k < 3; ++k) {
    out[k] = flip * ((2 * camera.focal * height * right[k]) / width + (2 * camera.centre[0] - 1) * forward[k]);
    out[4 + k] = 2 * camera.focal * up[k] - (2 * camera.centre[1] - 1) * forward[k];
    out[8 + k] = ((FAR + NEAR) / (FAR - NEAR)) * forward[k];
    out[12 + k] = forward[k];
  }
  for (let r = 0; r < 4; ++r) out[4 * r + 3] = -dot(out.subarray(4 * r, 4 * r + 3), camera.position);
  out[11] -= (2 * FAR * NEAR) / (FAR - NEAR);
  return out;
}

/**
 * A preset that stands as near as it can while pad, arms and hands up are seen (film/scene/camera.py).
 * @param {import("./doc.js").PageDoc} doc @param {string} name @param {number} width @param {number} height
 * @returns {Camera}
 */
export function preset(doc, name, width, height) {
  const about = doc.look.cameras[name];
  const whole = (doc.stage.high[0] - doc.stage.low[0] + 2 * about.arms) / Math.max(about.height, doc.stage.tall); // by its height
  const arms = about.feet_only
    ? about.arms
    : about.arms * clamp(1 - (2 * (1 - LEAST_ARMS) * (whole - width / height)) / whole, LEAST_ARMS, 1);
  const box = corners(doc, { ...about, arms });
  /** @type {[number, number, number]} */
  const target = [0, 0, 0];
  for (let k = 0; k < 3; ++k) {
    const values = box.map((p) => p[k]);
    target[k] = (Math.min(...values) + Math.max(...values)) / 2;
  }
  const azimuth = (about.azimuth * Math.PI) / 180;
  const elevation = (about.elevation * Math.PI) / 180;
  const away = [-Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation), -Math.cos(azimuth) * Math.cos(elevation)];
  const focal = 0.5 / Math.tan(((about.field / 2) * Math.PI) / 180);
  let near = 0.5;
  let far = 200;
  for (let round = 0; round < 40; ++round) {
    const middle = Math.sqrt(near * far);
    if (fit(box, target, plus(target, away, middle), focal, width / height)) far = middle;
    else near = middle;
  }
  const position = plus(target, away, far);
  const centre = fit(box, target, position, focal, width / height) || /** @type {[number, number]} */ ([0.5, 0.5]);
  if (!about.feet_only && width / height < TALL) centre[1] += lower(box, { position, target }, focal);
  return { position, target, focal, centre, feetOnly: about.feet_only, mirror: false };
}

/**
 * A camera turned round the dancer by hand. Nearer it looks down to the pad, and never so near that the pad, where her
 * feet are, leaves the picture.
 * @param {import("./doc.js").PageDoc} doc @param {{yaw: number, pitch: number, zoom: number}} free degrees, degrees, 1 = as near as "back"
 * @param {number} width @param {number} height
 * @returns {Camera & {zoom: number}} zoom: as near as it has come
 */
export function orbit(doc, free, width, height) {
  const base = preset(doc, "back", width, height);
  const distance = Math.hypot(...minus(base.position, base.target));
  const yaw = (free.yaw * Math.PI) / 180;
  const pitch = (clamp(free.pitch, 1, 89) * Math.PI) / 180;
  const away = [-Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), -Math.cos(yaw) * Math.cos(pitch)];
  const { low, high } = doc.stage;
  const pad = [low[0], high[0]].flatMap((x) => [low[2], high[2]].map((z) => [x, 0, z]));
  /** @param {number} zoom @param {number} height of the target @returns {Camera} */
  const at = (zoom, height) => {
    /** @type {[number, number, number]} */
    const target = [base.target[0], height, base.target[2]];
    return { ...base, target, position: plus(target, away, distance / zoom), centre: [0.5, 0.5], feetOnly: false };
  };
  for (let zoom = clamp(free.zoom, 0.4, 4); ; zoom *= 0.97) {
    for (let high = WAIST; high >= 0; high -= 0.02) {
      const camera = at(zoom, high);
      if (zoom < 0.3 || holds(camera, pad, width / height)) return { ...camera, zoom };
    }
  }
}

/** Whether points are in the picture. @param {Camera} camera @param {number[][]} points @param {number} aspect */
function holds(camera, points, aspect) {
  const { right, up, forward } = axes(camera);
  return points.every((point) => {
    const way = minus(point, camera.position);
    const depth = dot(way, forward);
    const [x, y] = [(camera.focal * dot(way, right)) / depth / aspect, (camera.focal * dot(way, up)) / depth];
    return depth > NEAR && Math.abs(x) <= 0.49 && Math.abs(y) <= 0.49;
  });
}

/**
 * The camera moved sideways as far as she would leave the picture otherwise: when she walks on, in a narrow one.
 * @param {Camera} camera @param {[number, number, number]} root @param {number} aspect @returns {Camera}
 */
export function beside(camera, root, aspect) {
  const { right, forward } = axes(camera);
  const way = minus(root, camera.position);
  const depth = dot(way, forward);
  if (depth < NEAR) return camera;
  const across = (/** @type {number} */ edge) => ((edge - camera.centre[0]) * aspect * depth) / camera.focal;
  const at = dot(way, right);
  const by = Math.max(0, at + ARM - across(1)) + Math.min(0, at - ARM - across(0));
  return by === 0 ? camera : { ...camera, position: plus(camera.position, right, by), target: plus(camera.target, right, by) };
}

/** @param {import("./doc.js").PageDoc} doc @param {import("./doc.js").Camera} about @returns {number[][]} */
function corners(doc, about) {
  const { low, high, tall } = doc.stage;
  const thick = doc.look.stage.pad_height;
  const height = about.feet_only ? about.height : Math.max(about.height, tall);
  const middle = (low[2] + high[2]) / 2;
  const layers = [
    [-thick, about.margin, low[2] - about.margin, high[2] + about.margin],
    [0, about.margin, low[2] - about.margin, high[2] + about.margin],
    [Math.min(1.45, height), about.arms, middle - 0.2, middle + 0.2],
    [height, -0.1, middle - 0.2, middle + 0.2],
  ];
  const out = [];
  for (const [y, wider, near, far] of layers) {
    for (const x of [low[0] - wider, high[0] + wider]) out.push([x, y, near], [x, y, far]);
  }
  return out;
}

/**
 * How far a box in the middle goes down, in picture heights, so that most of the floor below it is not seen.
 * @param {number[][]} box @param {{position: [number, number, number], target: [number, number, number]}} camera @param {number} focal
 */
function lower(box, { position, target }, focal) {
  const { up, forward } = axes({ position, target });
  const heights = box.map((point) => minus(point, position)).map((p) => (focal * dot(p, up)) / dot(p, forward));
  return FLOOR * Math.max(0, 1 - (Math.max(...heights) - Math.min(...heights)));
}

/**
 * The centre that puts the box into the middle of the picture, if all of it fits.
 * @param {number[][]} box @param {number[]} target @param {number[]} position @param {number} focal
 * @param {number} aspect @returns {[number, number] | null}
 */
function fit(box, target, position, focal, aspect) {
  const { right, up, forward } = axes({ position, target });
  const low = [Infinity, Infinity];
  const high = [-Infinity, -Infinity];
  for (const point of box) {
    const p = minus(point, position);
    const depth = dot(p, forward);
    if (depth < NEAR) return null;
    const at = [(focal * dot(p, right)) / depth / aspect, (-focal * dot(p, up)) / depth];
    for (const k of [0, 1]) {
      low[k] = Math.min(low[k], at[k]);
      high[k] = Math.max(high[k], at[k]);
    }
  }
  if (high[0] - low[0] > 1 || high[1] - low[1] > 1) return null;
  return [0.5 - (low[0] + high[0]) / 2, 0.5 - (low[1] + high[1]) / 2];
}
