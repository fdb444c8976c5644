// Other feet given by the author: what they cost, and roughly how she dances them until the chart is baked again.

import { between, minus, multiply, plus, smooth, turn, unit } from "./maths.js";

const BEFORE = 0.35, AFTER = 0.35; // seconds around a changed row in which the legs go other ways
const LIFT = 0.11; // metres that a foot rises on its way

/**
 * @typedef {object} Flip what the solver says about other feet in one row (page/facts.py)
 * @property {number} row number in the play
 * @property {number} extra cost, more than the best play's; -1: nobody can step it so
 * @property {[number, number, number][]} changes row, column, limb: of everything that is stepped otherwise then
 */

export class Redance {
  /**
   * @param {import("./doc.js").PageDoc} doc @param {import("./chart.js").Chart} chart
   * @param {[number, number, number][]} stored tick, column, limb
   */
  constructor(doc, chart, stored) {
    this.doc = doc;
    this.chart = chart;
    /** @type {Map<number, Flip>} by row of the play */
    this.flips = new Map(doc.flips.map((/** @type {Flip} */ flip) => [flip.row, flip]));
    /** @type {Map<number, number>} limb by note: what the author asked for */
    this.given = new Map();
    /** @type {Map<number, number>} limb by note: what is stepped otherwise then, the rows after it too */
    this.limbs = new Map();
    /** @type {Map<number, import("./chart.js").Row>} by row of the play */
    this.rows = new Map(chart.rows.map((row) => [row.row, row]));
    /** @type {Map<number, import("./chart.js").Row>} by note */
    this.rowOf = new Map(chart.rows.flatMap((row) => row.steps.map((step) => [step.note, row])));
    for (const [tick, column, limb] of stored) {
      const row = chart.rows.find((one) => Math.round(one.beat * 48) === tick);
      const step = row?.steps.find((one) => one.column === column);
      if (step && step.note >= 0) this.given.set(step.note, limb);
    }
    this.apply();
    const names = doc.body.names;
    this.legs = ["l", "r"].map((side) => ["hip", "knee", "talocrural"].map((part) => names.indexOf(`${side}_${part}`)));
    this.children = childrenOf(doc.body.parents);
  }

  /** Whether a note can be given to the other foot. @param {number} note */
  can(note) {
    const row = this.rowOf.get(note);
    return row !== undefined && row.steps.some((step) => step.note === note && (step.limb === 0 || step.limb === 1));
  }

  /** @param {number} note */
  toggle(note) {
    if (!this.can(note)) return;
    const row = /** @type {import("./chart.js").Row} */ (this.rowOf.get(note));
    // Feet of a row change together: a jump swaps both, a bracket goes to the other foot whole.
    for (const step of row.steps) {
      if (step.limb > 1 || step.limb < 0) continue;
      if (this.given.has(step.note)) this.given.delete(step.note);
      else this.given.set(step.note, 1 - step.limb);
    }
    this.apply();
  }

  apply() {
    this.limbs = new Map();
    for (const row of this.changedRows()) {
      for (const [number, column, limb] of this.flips.get(row.row)?.changes ?? []) {
        const step = this.rows.get(number)?.steps.find((one) => one.column === column);
        if (step) this.limbs.set(step.note, limb);
      }
    }
    for (const [note, limb] of this.given) this.limbs.set(note, limb); // what was asked for holds above what follows
    this.chart.given = this.limbs;
    this.windows = this.windowsOf();
  }

  /** Rows the author changed, in order. */
  changedRows() {
    const rows = new Set([...this.given.keys()].map((note) => /** @type {import("./chart.js").Row} */ (this.rowOf.get(note))));
    return [...rows].sort((a, b) => a.second - b.second);
  }

  /** @returns {[number, number, number][]} */
  stored() {
    return [...this.given].map(([note, limb]) => [this.chart.tick[note], this.chart.column[note], limb]);
  }

  /** Who steps a note now. @param {import("./chart.js").Step} step */
  limbOf(step) {
    return this.limbs.get(step.note) ?? step.limb;
  }

  /** Where the feet stand and go in the changed rows: for each foot a list of (second, panel) with the rows around. */
  windowsOf() {
    /** @type {{from: number, to: number, keys: {second: number, panel: number}[][]}[]} */
    const out = [];
    const rows = this.chart.rows;
    for (let k = 0; k < rows.length; ++k) {
      if (!rows[k].steps.some((step) => this.limbs.has(step.note) && this.limbs.get(step.note) !== step.limb)) continue;
      const last = out[out.length - 1];
      const from = Math.max(rows[k].second - BEFORE, k ? rows[k - 1].second : -Infinity);
      const to = Math.min(rows[k].second + AFTER, rows[k + 1]?.second ?? Infinity);
      const stands = [0, 1].map((foot) => this.standsAfter(k - 1, foot));
      const lands = [0, 1].map((foot) => this.standsAfter(k, foot));
      const keys = [0, 1].map((foot) => [
        { second: from, panel: stands[foot] }, { second: rows[k].second, panel: lands[foot] },
        { second: to, panel: lands[foot] },
      ]);
      if (last && last.to >= from - 1e-6) {
        last.to = to;
        keys.forEach((more, foot) => last.keys[foot].push(...more.slice(1)));
      } else {
        out.push({ from, to, keys });
      }
    }
    return out;
  }

  /**
   * The panel under a foot after row k with the author's feet; -1 if it has not stepped yet.
   * @param {number} k @param {number} foot
   */
  standsAfter(k, foot) {
    for (let i = k; i >= 0; --i) {
      const step = this.chart.rows[i].steps.find((one) => this.limbOf(one) === foot);
      if (step) return step.column;
    }
    return -1;
  }

  /**
   * Move the legs of a pose where the author's feet differ: the baked body stays, hips and knees reach for the panels.
   * @param {number} second @param {import("./motion.js").Pose} pose
   */
  amend(second, pose) {
    const window = this.windows?.find((one) => second > one.from && second < one.to);
    if (!window) return;
    const share = smooth((second - window.from) / 0.12) * smooth((window.to - second) / 0.12);
    for (const foot of [0, 1]) {
      const keys = window.keys[foot];
      let at = 0;
      while (at < keys.length - 2 && keys[at + 1].second < second) ++at;
      const [a, b] = [keys[at], keys[at + 1]];
      const now = pose.at(this.legs[foot][2]);
      const [from, to] = [this.over(a.panel, now), this.over(b.panel, now)];
      const moved = a.panel !== b.panel;
      const along = smooth((second - a.second) / Math.max(b.second - a.second, 0.02));
      const goal = plus(from, minus(to, from), along);
      const height = this.doc.body.offsets.length ? 0.085 : 0;
      goal[1] = height + (moved ? LIFT * Math.sin(Math.PI * along) : 0);
      this.reach(pose, this.legs[foot], plus(now, minus(goal, now), share));
    }
  }

  /**
   * Where an ankle is above a panel; where it is, if the foot has not stepped.
   * @param {number} panel @param {[number, number, number]} now @returns {[number, number, number]}
   */
  over(panel, now) {
    if (panel < 0) return [now[0], now[1], now[2]];
    const { panels, centre, width } = this.doc.pad;
    return [-(panels[panel][0] - centre[0]) * width, 0.085, (panels[panel][1] - centre[1]) * width - 0.06];
  }

  /**
   * Hip and knee so that the ankle comes to a place: the cosine rule in the plane of the leg as it is; the foot keeps
   * its turn in the world.
   * @param {import("./motion.js").Pose} pose @param {number[]} leg hip, knee, ankle @param {[number, number, number]} goal
   */
  reach(pose, leg, goal) {
    const [hip, knee, ankle] = leg.map((joint) => pose.at(joint));
    const upper = Math.hypot(...minus(knee, hip));
    const lower = Math.hypot(...minus(ankle, knee));
    const way = minus(goal, hip);
    const far = Math.min(Math.hypot(...way), upper + lower - 1e-3);
    const forward = unit(way);
    const bend = minus(knee, hip);
    const side = unit(plus(bend, forward, -(bend[0] * forward[0] + bend[1] * forward[1] + bend[2] * forward[2])));
    const cos = Math.min(Math.max((upper * upper + far * far - lower * lower) / (2 * upper * far), -1), 1);
    const bent = plus(plus(hip, forward, upper * cos), side, upper * Math.sqrt(1 - cos * cos));
    const end = plus(hip, forward, far);
    this.swing(pose, leg[0], between(unit(minus(knee, hip)), unit(minus(bent, hip))), hip);
    const [knee2, ankle2] = [pose.at(leg[1]), pose.at(leg[2])];
    const foot = Float64Array.from(pose.turned(leg[2]));
    this.swing(pose, leg[1], between(unit(minus(ankle2, knee2)), unit(minus(end, knee2))), knee2);
    const back = multiply(foot, conjugate(pose.turned(leg[2])));
    this.swing(pose, leg[2], back, pose.at(leg[2]));
  }

  /**
   * Turn a joint and all below it in the world.
   * @param {import("./motion.js").Pose} pose @param {number} joint @param {ArrayLike<number>} by @param {number[]} about
   */
  swing(pose, joint, by, about) {
    for (const j of [joint, ...this.children[joint]]) {
      pose.world.set(multiply(by, pose.turned(j)), 4 * j);
      pose.place.set(plus(about, turn(by, minus(pose.at(j), about))), 3 * j);
    }
  }
}

/** @param {ArrayLike<number>} q @returns {[number, number, number, number]} */
function conjugate(q) {
  return [q[0], -q[1], -q[2], -q[3]];
}

/** All joints below each joint. @param {number[]} parents @returns {number[][]} */
function childrenOf(parents) {
  /** @type {number[][]} */
  const out = parents.map(() => []);
  parents.forEach((_, j) => {
    for (let p = parents[j]; p >= 0; p = parents[p]) out[p].push(j);
  });
  return out;
}
