// The picture of a capture's page: its skeleton, and the dancer who follows it with the distance of each point.

import { matrix } from "./camera.js";
import { clamp, dot } from "./maths.js";
import { Viewer } from "./viewer.js";

const ROOM = [1.9, 2.15]; // metres across and high that are always in the picture
const FILLS = 0.95; // of the picture
const NEAR_COLOUR = [0, 158, 115];
const FAR_COLOUR = [213, 0, 0]; // of a point that is `far` centimetres away, or farther: the films' colours
const NO_MARK = { line: [0, 0, 0, 1], ground: 0, near: -1, strength: 0, pressed: 0, colour: [0, 0, 0] };

/** @typedef {[number, number, number, number]} Box x, y, width and height in pixels, y from the top */

/** Places at even keys, and what they are at any second. */
class Track {
  /**
   * @param {import("./blob.js").Numbers} values a row for each number, then keys
   * @param {import("./capture.js").Clock} clock
   */
  constructor(values, clock) {
    this.keys = clock.keys;
    this.rows = values.length / this.keys;
    this.values = values;
    this.clock = clock;
    this.places = new Float64Array(this.rows);
  }

  /** @param {number} second @returns {Float64Array} x, y and z of each place; the same array every time */
  at(second) {
    const { rate, start, step } = this.clock;
    const place = clamp((second - start) * rate, 0, this.keys - 1);
    const before = Math.min(Math.floor(place), Math.max(this.keys - 2, 0));
    const share = place - before;
    for (let row = 0; row < this.rows; ++row) {
      const k = row * this.keys + before;
      this.places[row] = step * (this.values[k] * (1 - share) + (share ? this.values[k + 1] : 0) * share);
    }
    return this.places;
  }
}

/**
 * Centimetres between two sets of places.
 * @param {ArrayLike<number>} a @param {ArrayLike<number>} b
 */
export function pointDistances(a, b) {
  return Array.from(
    { length: a.length / 3 },
    (_, k) => 100 * Math.hypot(a[3 * k] - b[3 * k], a[3 * k + 1] - b[3 * k + 1], a[3 * k + 2] - b[3 * k + 2]),
  );
}

/**
 * The colour of a distance. @param {number} centimetres @param {number} far
 */
export function colourOf(centimetres, far) {
  const share = clamp(centimetres / far, 0, 1);
  return `rgb(${NEAR_COLOUR.map((near, k) => Math.round(near + share * (FAR_COLOUR[k] - near))).join(", ")})`;
}

export class CaptureView {
  /**
   * @param {HTMLElement} place @param {import("./capture.js").CaptureDoc} doc @param {import("./blob.js").Arrays} arrays
   * @param {import("./motion.js").Motion} motion
   */
  constructor(place, doc, arrays, motion) {
    this.place = place;
    this.doc = doc;
    this.motion = motion;
    this.pose = motion.pose();
    this.skeleton = new Track(arrays.get("skeleton"), doc.clock);
    this.before = new Track(arrays.get("before"), doc.clock);
    this.after = new Track(arrays.get("after"), doc.clock);
    this.way = new Track(arrays.get("way"), doc.clock);
    this.yaw = 25;
    this.pitch = 8;
    this.zoom = 1;
    this.distances = true;
    this.skin = new Float32Array(12 * doc.body.parents.length);
    this.hidden = new Float32Array(this.skin.length); // far below: nobody stands in the input's half
    for (let k = 7; k < this.hidden.length; k += 12) this.hidden[k] = -100;
    this.lights = new Float32Array(4 * doc.pad.panels.length);
    this.canvas = document.createElement("canvas");
    this.canvas.className = "view";
    this.lines = document.createElement("canvas");
    this.lines.className = "lines";
    place.append(this.canvas, this.lines);
    /** @type {Viewer | null} */
    this.viewer = null;
  }

  /**
   * Start WebGL; without it both figures are drawn as lines.
   * @param {import("./gl.js").MeshData} mesh @param {ImageBitmap[]} skins
   */
  start(mesh, skins) {
    try {
      this.viewer = new Viewer(this.canvas, /** @type {import("./doc.js").PageDoc} */ (/** @type {unknown} */ (this.doc)), mesh, skins);
      this.canvas = this.viewer.canvas;
    } catch {
      this.viewer = null;
    }
    this.canvas.addEventListener("webglcontextlost", () => { this.viewer = null; });
  }

  /** @param {number} yaw @param {number} pitch degrees */
  turn(yaw, pitch) {
    this.yaw = (this.yaw + yaw) % 360;
    this.pitch = clamp(this.pitch + pitch, -5, 89);
  }

  /** @param {number} times */
  nearer(times) {
    this.zoom = clamp(this.zoom * times, 0.5, 4);
  }

  /**
   * Both halves: beside each other, or one above the other where it is narrow.
   * @param {number} width @param {number} height @returns {Box[]}
   */
  halves(width, height) {
    const [left, top] = [Math.round(width / 2), Math.round(height / 2)];
    return width >= 0.9 * height
      ? [
          [0, 0, left, height],
          [left, 0, width - left, height],
        ]
      : [
          [0, 0, width, top],
          [0, top, width, height - top],
        ];
  }

  /** @param {number} second @param {Box} box @returns {import("./camera.js").Camera} */
  camera(second, [, , width, height]) {
    const { focal, height: look } = this.doc.camera;
    const [x, , z] = this.way.at(second);
    const far = (focal * Math.max(ROOM[1], (ROOM[0] * height) / width)) / FILLS / this.zoom;
    const [yaw, pitch] = [(this.yaw * Math.PI) / 180, (this.pitch * Math.PI) / 180];
    const away = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
    const target = /** @type {[number, number, number]} */ ([x, look, z]);
    return {
      position: /** @type {[number, number, number]} */ (target.map((value, k) => value + far * away[k])), target, focal,
      centre: [0.5, 0.5], feetOnly: false, mirror: false,
    };
  }

  /** Draw a moment. @param {number} second @returns {number[]} centimetres of each point */
  draw(second) {
    const box = this.place.getBoundingClientRect();
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [Math.max(2, Math.round(box.width * ratio)), Math.max(2, Math.round(box.height * ratio))];
    for (const canvas of [this.canvas, this.lines]) {
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
    }
    const { motion, pose } = this;
    motion.sample(second, pose);
    motion.forward(pose);
    motion.skin(pose, this.skin);
    const halves = this.halves(width, height);
    const cameras = halves.map((half) => this.camera(second, half));
    this.viewer?.draw(halves.map(([x, y, wide, high], k) => ({
      camera: cameras[k], box: /** @type {Box} */ ([x, height - y - high, wide, high]), skin: k ? this.skin : this.hidden, other: null,
      root: pose.at(0), marks: /** @type {import("./feet.js").Mark[]} */ (/** @type {unknown} */ ([NO_MARK, NO_MARK, NO_MARK, NO_MARK])),
      lights: this.lights, middles: /** @type {[number, number][]} */ ([[pose.place[0], pose.place[2]]]), soles: [null, null],
    })), false);
    return this.drawLines(second, halves, cameras, ratio);
  }

  /**
   * Skeleton and distances over the picture.
   * @param {number} second @param {Box[]} halves @param {import("./camera.js").Camera[]} cameras @param {number} ratio
   */
  drawLines(second, halves, cameras, ratio) {
    const flat = /** @type {CanvasRenderingContext2D} */ (this.lines.getContext("2d"));
    flat.clearRect(0, 0, this.lines.width, this.lines.height);
    flat.lineCap = "round";
    const { doc } = this;
    const [before, after] = [this.before.at(second), this.after.at(second)];
    const far = pointDistances(before, after);
    halves.forEach((half, k) => {
      flat.save();
      flat.beginPath();
      flat.rect(...half);
      flat.clip();
      const project = projector(cameras[k], half);
      if (k === 0) bones(flat, doc.parents, this.skeleton.at(second), project, "#f2b65a", ratio);
      else if (!this.viewer) bones(flat, doc.body.parents, this.pose.place, project, "#8fb4ff", ratio);
      if (k === 1 && this.distances) {
        for (const n of far.map((_, i) => i).sort((a, b) => far[a] - far[b])) {
          const [from, to] = [before, after].map((places) => project(places, n));
          const share = clamp(far[n] / doc.far, 0, 1);
          flat.strokeStyle = flat.fillStyle = colourOf(far[n], doc.far);
          flat.lineWidth = 3 * ratio;
          line(flat, from, to);
          flat.beginPath();
          flat.arc(to[0], to[1], (3 + 5 * share) * ratio, 0, 2 * Math.PI);
          flat.fill();
          flat.lineWidth = ratio;
          flat.strokeStyle = "#fff";
          flat.stroke();
        }
      }
      flat.restore();
    });
    return far;
  }
}

/** @param {CanvasRenderingContext2D} flat @param {number[]} from @param {number[]} to */
function line(flat, from, to) {
  flat.beginPath();
  flat.moveTo(from[0], from[1]);
  flat.lineTo(to[0], to[1]);
  flat.stroke();
}

/**
 * A skeleton as lines.
 * @param {CanvasRenderingContext2D} flat @param {number[]} parents @param {ArrayLike<number>} places
 * @param {(places: ArrayLike<number>, n: number) => number[]} project @param {string} colour @param {number} ratio
 */
function bones(flat, parents, places, project, colour, ratio) {
  for (const [style, width] of /** @type {const} */ ([["rgba(5, 6, 14, .8)", 7], [colour, 4]])) {
    flat.strokeStyle = style;
    flat.lineWidth = width * ratio;
    parents.forEach((parent, joint) => {
      if (parent >= 0) line(flat, project(places, parent), project(places, joint));
    });
  }
}

/**
 * Where places of the world are in a part of the picture, in pixels.
 * @param {import("./camera.js").Camera} camera @param {Box} box
 */
function projector(camera, [left, top, width, height]) {
  const world = matrix(camera, width, height);
  return (/** @type {ArrayLike<number>} */ places, /** @type {number} */ n) => {
    const at = [places[3 * n], places[3 * n + 1], places[3 * n + 2], 1];
    const [x, y, , w] = [0, 1, 2, 3].map((row) => dot(world.subarray(4 * row, 4 * row + 3), at) + world[4 * row + 3]);
    return [left + (0.5 + x / w / 2) * width, top + (0.5 - y / w / 2) * height];
  };
}
