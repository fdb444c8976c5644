// The dancer's motion: where each joint is at any second, as a .glb viewer would draw it.

import { lastUpTo } from "./maths.js";

const TICK = 1e-5; // body.py

/**
 * @typedef {object} Group
 * @property {number[]} joints
 * @property {Float64Array} times
 * @property {Int16Array} turns joint, then w x y z, then key
 */

export class Motion {
  /**
   * @param {any} about @param {import("./blob.js").Arrays} arrays @param {any} body
   */
  constructor(about, arrays, body) {
    this.parents = /** @type {number[]} */ (body.parents);
    this.offsets = /** @type {number[][]} */ (body.offsets);
    this.inverse = /** @type {number[][]} */ (body.inverseBind);
    this.start = /** @type {number} */ (about.start);
    this.end = /** @type {number} */ (about.end);
    /** @type {Group[]} */
    this.groups = about.groups.map((/** @type {any} */ group, /** @type {number} */ k) => ({
      joints: group.joints,
      times: Float64Array.from(arrays.get(`${about.name}.time${k}`), (t) => t * TICK),
      turns: /** @type {Int16Array} */ (arrays.get(`${about.name}.turn${k}`)),
    }));
    this.root = Float32Array.from(arrays.get(`${about.name}.root`), (x) => x * TICK);
  }

  /** @returns {Pose} */
  pose() {
    return new Pose(this.parents.length);
  }

  /**
   * Fill a pose with local rotations and the root's place at a second of the music.
   * @param {number} second @param {Pose} pose
   */
  sample(second, pose) {
    const local = pose.local;
    for (let j = 0; j < this.parents.length; ++j) local.set([1, 0, 0, 0], 4 * j);
    for (let g = 0; g < this.groups.length; ++g) {
      const { joints, times, turns } = this.groups[g];
      const n = times.length;
      const before = Math.min(Math.max(lastUpTo(times, second), 0), Math.max(n - 2, 0));
      const after = Math.min(before + 1, n - 1);
      const span = times[after] - times[before];
      const share = span > 0 ? Math.min(Math.max((second - times[before]) / span, 0), 1) : 0;
      for (let i = 0; i < joints.length; ++i) {
        const at = 4 * i * n;
        mix(local, 4 * joints[i], turns, at, n, before, after, share);
      }
      if (g === 0) {
        for (let k = 0; k < 3; ++k) {
          pose.root[k] = this.root[k * n + before] * (1 - share) + this.root[k * n + after] * share;
        }
      }
    }
  }

  /**
   * Places and turns of all joints in the world, from the pose's local rotations.
   * @param {Pose} pose
   */
  forward(pose) {
    const { local, world, place, root } = pose;
    for (let j = 0; j < this.parents.length; ++j) {
      const p = this.parents[j];
      const offset = this.offsets[j];
      if (p === -2) {
        world.set([1, 0, 0, 0], 4 * j);
        place.set(offset, 3 * j);
      } else if (p < 0) {
        for (let k = 0; k < 4; ++k) world[4 * j + k] = local[4 * j + k];
        for (let k = 0; k < 3; ++k) place[3 * j + k] = root[k];
      } else {
        const w = world[4 * p], x = world[4 * p + 1], y = world[4 * p + 2], z = world[4 * p + 3];
        const tx = 2 * (y * offset[2] - z * offset[1]);
        const ty = 2 * (z * offset[0] - x * offset[2]);
        const tz = 2 * (x * offset[1] - y * offset[0]);
        place[3 * j] = place[3 * p] + offset[0] + w * tx + y * tz - z * ty;
        place[3 * j + 1] = place[3 * p + 1] + offset[1] + w * ty + z * tx - x * tz;
        place[3 * j + 2] = place[3 * p + 2] + offset[2] + w * tz + x * ty - y * tx;
        const a = local[4 * j], b = local[4 * j + 1], c = local[4 * j + 2], d = local[4 * j + 3];
        world[4 * j] = w * a - x * b - y * c - z * d;
        world[4 * j + 1] = w * b + x * a + y * d - z * c;
        world[4 * j + 2] = w * c - x * d + y * a + z * b;
        world[4 * j + 3] = w * d + x * c - y * b + z * a;
      }
    }
  }

  /**
   * Skinning matrices, three rows of four a joint: binding pose to world, moved aside by (x, 0, 0).
   * @param {Pose} pose @param {Float32Array} out @param {number} [aside]
   */
  skin(pose, out, aside = 0) {
    const { world, place } = pose;
    for (let j = 0; j < this.parents.length; ++j) {
      const w = world[4 * j], x = world[4 * j + 1], y = world[4 * j + 2], z = world[4 * j + 3];
      const m = [
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), place[3 * j] + aside,
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), place[3 * j + 1],
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), place[3 * j + 2],
      ];
      const i = this.inverse[j];
      for (let r = 0; r < 3; ++r) {
        const a = m[4 * r], b = m[4 * r + 1], c = m[4 * r + 2];
        for (let k = 0; k < 4; ++k) {
          out[12 * j + 4 * r + k] = a * i[k] + b * i[4 + k] + c * i[8 + k] + (k === 3 ? m[4 * r + 3] : 0);
        }
      }
    }
  }
}

/** Rotations and places of all joints at one moment. */
export class Pose {
  /** @param {number} joints */
  constructor(joints) {
    this.local = new Float64Array(4 * joints);
    this.world = new Float64Array(4 * joints);
    this.place = new Float64Array(3 * joints);
    this.root = new Float64Array(3);
  }

  /** @param {number} joint @returns {[number, number, number]} */
  at(joint) {
    return [this.place[3 * joint], this.place[3 * joint + 1], this.place[3 * joint + 2]];
  }

  /** @param {number} joint @returns {Float64Array} */
  turned(joint) {
    return this.world.subarray(4 * joint, 4 * joint + 4);
  }
}

/**
 * A quaternion between two keys; they lie near each other and in one half of the sphere, so a straight mix will do.
 * @param {Float64Array} out @param {number} to @param {Int16Array} turns @param {number} at @param {number} n
 * @param {number} before @param {number} after @param {number} share
 */
function mix(out, to, turns, at, n, before, after, share) {
  let length = 0;
  for (let k = 0; k < 4; ++k) {
    const value = turns[at + k * n + before] * (1 - share) + turns[at + k * n + after] * share;
    out[to + k] = value;
    length += value * value;
  }
  length = Math.sqrt(length) || 1;
  for (let k = 0; k < 4; ++k) out[to + k] /= length;
}
