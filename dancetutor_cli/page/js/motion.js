// The dancer's motion: where each joint is at any second. Keys lie on an even clock for each group of joints.

const ROOT = 1e-4; // metres; content.py

/**
 * @typedef {object} Group
 * @property {number[]} joints
 * @property {number} rate keys a second
 * @property {number} first number of the first key, counted from second 0
 * @property {number} count of keys
 * @property {number[]} steps of each joint's numbers
 * @property {number[]} rows the first row of each joint
 * @property {boolean[]} full whether w is there: else it follows from x, y and z
 * @property {Int16Array} turns row (w, x, y, z or x, y, z of each joint), then key
 */

export class Motion {
  /**
   * @param {import("./doc.js").MotionDoc} about @param {import("./blob.js").Arrays} arrays @param {import("./doc.js").Body} body
   */
  constructor(about, arrays, body) {
    this.parents = body.parents;
    this.offsets = body.offsets;
    this.inverse = body.inverseBind;
    this.start = about.start;
    this.end = about.end;
    this.groups = about.groups.map((group) =>
      readGroup(group, /** @type {Int16Array} */ (arrays.get(`${about.name}.turn${group.number}`))),
    );
    this.root = Float32Array.from(arrays.get(`${about.name}.root`), (x) => x * ROOT);
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
      const group = this.groups[g];
      const { joints, count, rows, full, steps } = group;
      const place = Math.min(Math.max(second * group.rate - group.first, 0), count - 1);
      const before = Math.min(Math.floor(place), Math.max(count - 2, 0));
      const after = Math.min(before + 1, count - 1);
      const share = place - before;
      for (let i = 0; i < joints.length; ++i)
        mix(local, 4 * joints[i], group.turns, rows[i] * count, count, before, after, share, full[i] ? 0 : steps[i]);
      if (g === 0) {
        for (let k = 0; k < 3; ++k) pose.root[k] = this.root[k * count + before] * (1 - share) + this.root[k * count + after] * share;
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

/** @param {import("./doc.js").MotionGroup} group @param {Int16Array} turns @returns {Group} */
function readGroup({ joints, rate, first, steps, full }, turns) {
  const rows = full.map((_, i) => full.slice(0, i).reduce((sum, whole) => sum + (whole ? 4 : 3), 0));
  const count = turns.length / full.reduce((sum, whole) => sum + (whole ? 4 : 3), 0);
  return { joints, rate, first, steps, full, rows, count, turns };
}

/**
 * A quaternion between two keys; they lie near each other and in one half of the sphere, so a straight mix will do.
 * @param {Float64Array} out @param {number} to @param {Int16Array} turns @param {number} at of the first number
 * @param {number} n keys @param {number} before @param {number} after @param {number} share
 * @param {number} step of x, y and z where w is left out, 0 where it is there
 */
function mix(out, to, turns, at, n, before, after, share, step) {
  const from = step ? 1 : 0;
  let length = 0;
  for (let k = from; k < 4; ++k) {
    const row = at + (k - from) * n;
    const value = (turns[row + before] * (1 - share) + turns[row + after] * share) * (step || 1);
    out[to + k] = value;
    length += value * value;
  }
  if (step) {
    out[to] = Math.sqrt(Math.max(1 - length, 0));
    return;
  }
  length = Math.sqrt(length) || 1;
  for (let k = 0; k < 4; ++k) out[to + k] /= length;
}
