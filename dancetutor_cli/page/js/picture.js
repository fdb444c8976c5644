// The dancer's part of the page: canvas, cameras, one dancer or two, the next step's soles; feet from above without WebGL.

import { beside, orbit, preset } from "./camera.js";
import { lightsAt, marksOf } from "./feet.js";
import { drawFromAbove } from "./topview.js";
import { Viewer } from "./viewer.js";

const SLOW = 24; // milliseconds between pictures beyond which the canvas gets fewer pixels
const SHARP = 0.7; // of the pixels across with which the shadow goes first
const LEAST = 0.5; // of the pixels across that it keeps
const ENOUGH = 70_000; // pixels of a canvas that loses none: a phone's is drawn as quickly with fewer, and only looks worse

/**
 * @typedef {object} Wanted
 * @property {number} second
 * @property {string} camera
 * @property {boolean} both whether the second dancer is shown
 * @property {import("./chart.js").Row | null} next whose feet are shown as soles on the pad
 * @property {boolean} playing
 */

/** The dancer's textures. @param {import("./doc.js").PageDoc} doc @param {import("./blob.js").Arrays} arrays */
export function decodeSkins(doc, arrays) {
  return Promise.all(Array.from({ length: doc.body.skins }, (_, k) => {
    const data = /** @type {Uint8Array<ArrayBuffer>} */ (arrays.get(`skin.${k}`));
    return createImageBitmap(new Blob([data], { type: "image/webp" }), { colorSpaceConversion: "none" });
  }));
}

export class Picture {
  /**
   * @param {HTMLElement} place @param {import("./doc.js").PageDoc} doc @param {import("./chart.js").Chart} chart
   * @param {import("./motion.js").Motion[]} motions @param {import("./settings.js").Settings} settings
   */
  constructor(place, doc, chart, motions, settings) {
    this.place = place;
    this.doc = doc;
    this.chart = chart;
    this.motions = motions;
    this.settings = settings;
    this.canvas = document.createElement("canvas");
    this.canvas.className = "view";
    place.append(this.canvas);
    /** @type {Viewer | null} */
    this.viewer = null;
    this.scale = 1;
    this.simple = false; // without cast shadows while it plays
    this.slow = 0;
    this.last = 0;
    /** @type {Map<string, import("./camera.js").Camera>} fitted cameras, by name and size */
    this.cameras = new Map();
    this.poses = motions.map((motion) => motion.pose());
    this.nextPose = motions[0].pose();
    this.skins = motions.map(() => new Float32Array(12 * doc.body.parents.length));
    this.lights = new Float32Array(4 * chart.columns);
    /** @type {(second: number, pose: import("./motion.js").Pose) => void} changes a pose: the author's other feet */
    this.amend = () => {};
    /** @type {() => void} */
    this.onTurn = () => {};
  }

  /**
   * Start WebGL; without it the canvas shows feet from above.
   * @param {import("./gl.js").MeshData} mesh @param {ImageBitmap[]} skins
   */
  start(mesh, skins) {
    try {
      this.viewer = new Viewer(this.canvas, this.doc, mesh, skins);
      this.canvas = this.viewer.canvas;
    } catch {
      return this.flat();
    }
    this.listen();
    this.canvas.addEventListener("webglcontextlost", () => this.flat());
  }

  /** Go on without WebGL, on a new canvas: the old one cannot be drawn on otherwise. */
  flat() {
    this.viewer = null;
    const fresh = document.createElement("canvas");
    fresh.className = "view";
    this.canvas.replaceWith(fresh);
    this.canvas = fresh;
    this.listen();
  }

  /** Dragging turns the free camera, the wheel and two fingers come nearer. */
  listen() {
    /** @type {Map<number, {x: number, y: number}>} */
    const fingers = new Map();
    const canvas = this.canvas;
    const apart = () => {
      const [a, b] = [...fingers.values()];
      return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
    };
    canvas.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const finger = fingers.get(event.pointerId);
      if (!finger || this.settings.camera !== "free") return;
      const before = apart();
      const [dx, dy] = [event.clientX - finger.x, event.clientY - finger.y];
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (before > 0) this.nearer(apart() / before);
      else this.turn(0.4 * dx, 0.3 * dy);
      this.onTurn();
    });
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => fingers.delete(/** @type {PointerEvent} */ (event).pointerId));
    }
    canvas.addEventListener("wheel", (event) => {
      if (this.settings.camera !== "free") return;
      event.preventDefault();
      this.nearer(Math.exp(-event.deltaY / 800));
      this.onTurn();
    }, { passive: false });
  }

  /** The free camera comes nearer, as far as it may. @param {number} times */
  nearer(times) {
    const { width, height } = this.place.getBoundingClientRect();
    this.settings.zoom = Math.min(Math.max(this.settings.zoom * times, 0.5), 3);
    this.settings.zoom = Math.max(orbit(this.doc, this.settings, width, height).zoom, 0.5);
  }

  /** Turn the free camera. @param {number} yaw @param {number} pitch degrees */
  turn(yaw, pitch) {
    this.settings.yaw = (this.settings.yaw + yaw) % 360;
    this.settings.pitch = Math.min(Math.max(this.settings.pitch + pitch, 2), 88);
  }

  /**
   * @param {string} name @param {number} width @param {number} height
   * @param {[number, number, number]} root where she is
   */
  camera(name, width, height, root) {
    if (name === "free") { // from near, the pad is what is looked at; else she is, when she walks on too
      const free = orbit(this.doc, this.settings, width, height);
      return free.zoom > 1 ? free : beside(free, root, width / height);
    }
    const key = `${name} ${width} ${height}`;
    let camera = this.cameras.get(key);
    if (!camera) {
      camera = { ...preset(this.doc, name === "mirror" ? "front" : name, width, height), mirror: name === "mirror" };
      this.cameras.set(key, camera);
    }
    return beside(camera, root, width / height);
  }

  /** @param {Wanted} wanted */
  draw(wanted) {
    const box = this.place.getBoundingClientRect();
    this.pace(wanted.playing, box.width * box.height);
    const hurried = this.viewer !== null && wanted.playing; // a picture that stands is worth its time
    const ratio = Math.min(window.devicePixelRatio || 1, 2) * (hurried ? this.scale : 1);
    const width = Math.max(2, Math.round(box.width * ratio));
    const height = Math.max(2, Math.round(box.height * ratio));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    lightsAt(this.chart, wanted.second, this.doc.style.panel, this.doc.style.limbs_rgb, this.lights);
    const pair = this.doc.pair ? this.partner(wanted.second) : null;
    const count = wanted.both ? this.motions.length : 1;
    const views = [];
    for (let k = 0; k < count; ++k) {
      const [motion, pose] = [this.motions[k], this.poses[k]];
      motion.sample(wanted.second, pose);
      motion.forward(pose);
      if (k === 0) this.amend(wanted.second, pose);
      motion.skin(pose, this.skins[k]);
      const root = pair ? pair.between(pose.at(0)) : pose.at(0);
      const marks = marksOf(this.doc, pose, this.lights);
      const left = Math.round((k * width) / count);
      const wide = Math.round(((k + 1) * width) / count) - left;
      views.push({
        camera: this.camera(wanted.camera, wide, height, root),
        box: /** @type {[number, number, number, number]} */ ([left, 0, wide, height]),
        skin: this.skins[k],
        root,
        lights: this.lights,
        other: pair?.skin ?? null,
        marks: pair ? [...marks.slice(0, 2), ...pair.marks.slice(0, 2)] : marks, // of two the feet, not the palms
        middles: /** @type {[number, number][]} */ ((pair ? [pose.at(0), pair.root] : [root]).map((at) => [at[0], at[2]])),
        soles: k === 0 && !pair && this.viewer ? this.soles(wanted.next) : [null, null],
      });
    }
    if (this.viewer) return this.viewer.draw(views, hurried && this.simple);
    const next = (wanted.next?.steps ?? []).map(({ column, limb }) => ({ column, limb }));
    drawFromAbove(this.canvas, this.doc, { marks: views[0].marks, lights: this.lights, mirror: wanted.camera === "front", next });
  }

  /** The second of two who dance in one picture. @param {number} second */
  partner(second) {
    const [motion, pose] = [this.motions[1], this.poses[1]];
    motion.sample(second, pose);
    motion.forward(pose);
    motion.skin(pose, this.skins[1]);
    const at = pose.at(0);
    return {
      skin: this.skins[1], marks: marksOf(this.doc, pose, this.lights), root: at,
      between: (/** @type {number[]} */ root) => /** @type {[number, number, number]} */ (root.map((x, k) => (x + at[k]) / 2)),
    };
  }

  /** Where the feet of the next row will be. @param {import("./chart.js").Row | null} next */
  soles(next) {
    if (!next) return [null, null];
    const motion = this.motions[0];
    motion.sample(next.second, this.nextPose);
    motion.forward(this.nextPose);
    this.amend(next.second, this.nextPose);
    const marks = marksOf(this.doc, this.nextPose, this.lights);
    return [0, 1].map((limb) => (next.steps.some((step) => step.limb === limb) && marks[limb].near >= 0 ? marks[limb] : null));
  }

  /**
   * Fewer pixels, then no shadow, then fewer still, where drawing is slow, as with WebGL in software.
   * @param {boolean} playing @param {number} area pixels of CSS
   */
  pace(playing, area) {
    const now = performance.now();
    const apart = now - this.last;
    this.last = now;
    if (!playing || apart > 1000) return;
    this.slow = 0.9 * this.slow + 0.1 * Math.min(apart, 4 * SLOW);
    if (this.slow <= SLOW) return;
    const least = this.simple ? LEAST : SHARP;
    if (this.scale > least && this.scale ** 2 * area > ENOUGH) this.scale = Math.max(least, this.scale * 0.8);
    else this.simple = true;
    this.slow = 0;
  }
}
