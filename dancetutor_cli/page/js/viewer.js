// The picture: stage, shadow, dancer and the next step's soles in WebGL 2, with the dancer's shaders of the films.

import { axes, matrix } from "./camera.js";
import { bind, build, drawPart, makeMesh, makeRoom, numbers, shadowMap, skinTexture, tileTexture } from "./gl.js";
import { cross, dot, minus } from "./maths.js";

const SHADOW_REACH = 2.5; // metres of the world that the shadow map shows (film/scene/renderer.py)
const CAST_DEPTH = [-2, 6];
const MOST_JOINTS = 256;
const OFF_SURFACE = [0.012, 0.006];
const NOWHERE = -100; // the ground of a sole that is not there
const COLOURS = /** @type {const} */ (["floor", "floor_far", "floor_line", "wall", "wall_top", "strip", "pad", "pad_side", "panel",
  "panel_blank", "groove", "arrow"]);

/**
 * @typedef {object} Shown what one part of the canvas shows
 * @property {import("./camera.js").Camera} camera
 * @property {[number, number, number, number]} box x, y, width, height in pixels, y from the bottom
 * @property {Float32Array} skin skinning matrices of the dancer
 * @property {Float32Array | null} other those of the second of two in one picture
 * @property {[number, number, number]} root
 * @property {import("./feet.js").Mark[]} marks four: left foot, right foot, palms
 * @property {Float32Array} lights four numbers a panel
 * @property {[number, number][]} middles x and z of those who dance, where their shadows are darkest
 * @property {(import("./feet.js").Mark | null)[]} soles where the left and the right foot of the next step will stand
 */

export class Viewer {
  /**
   * @param {HTMLCanvasElement} canvas @param {import("./doc.js").PageDoc} doc @param {import("./gl.js").MeshData} mesh
   * @param {ImageBitmap[]} skins
   */
  constructor(canvas, doc, mesh, skins) {
    const { gl, soft } = contextOf(canvas);
    this.canvas = /** @type {HTMLCanvasElement} */ (gl.canvas);
    this.simple = false;
    this.gl = gl;
    this.doc = doc;
    const shaders = doc.shaders;
    const skinned = shaders["skinned.vert"];
    const [stage, dancer, depth] = build(gl, [[shaders["stage.vert"], shaders["stage.frag"]],
      [skinned, shaders["dancer.frag"]], [skinned, shaders["depth.frag"]]]);
    this.stage = stage;
    this.dancer = dancer;
    this.depth = depth;
    this.joints = gl.createBuffer();
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.joints);
    gl.bufferData(gl.UNIFORM_BUFFER, MOST_JOINTS * 48, gl.DYNAMIC_DRAW);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.joints);
    for (const one of [this.dancer, this.depth]) {
      gl.uniformBlockBinding(one.program, gl.getUniformBlockIndex(one.program, "Joints"), 0);
    }
    this.mesh = makeMesh(gl, mesh);
    this.room = makeRoom(gl, doc.stage);
    this.skins = skins.map((image) => skinTexture(gl, image));
    this.tiles = tileTexture(gl, doc.stage);
    this.lights = numbers(gl, new Float32Array(4 * doc.pad.panels.length), doc.pad.panels.length, 1);
    this.texels = soft ? 512 : 1024;
    this.map = shadowMap(gl, this.texels);
    this.palette = new Float32Array(COLOURS.flatMap((name) => doc.look.stage[name].map((c) => c / 255)));
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
  }

  /** @param {Shown[]} views @param {boolean} simple without cast shadows: for machines that draw slowly */
  draw(views, simple) {
    this.simple = simple;
    const gl = this.gl;
    for (const view of views) {
      const cast = this.cast(view);
      const bodies = view.other ? [view.skin, view.other] : [view.skin];
      if (!this.simple) this.drawShadow(cast, bodies);
      const [x, y, width, height] = view.box;
      gl.viewport(x, y, width, height);
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(x, y, width, height);
      gl.clearColor(0.05, 0.05, 0.11, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.frontFace(view.camera.mirror ? gl.CW : gl.CCW);
      const world = matrix(view.camera, width, height);
      this.drawStage(view, world, cast);
      bodies.forEach((skin, who) => {
        this.setJoints(skin);
        this.drawBody(view, world, cast, who);
      });
      gl.disable(gl.SCISSOR_TEST);
    }
  }

  /** @param {Float32Array} skin */
  setJoints(skin) {
    const gl = this.gl;
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.joints);
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, skin);
  }

  /**
   * The sun's axes and the shadow map's matrix: it stands beside the camera, the map lies on the world's texel grid.
   * @param {Shown} view
   */
  cast(view) {
    const { up, forward } = axes(view.camera);
    const heading = Math.hypot(forward[0], forward[2]) > 1e-3 ? forward : up;
    const look = this.doc.look.light;
    const side = view.camera.mirror ? -1 : 1;
    const yaw = Math.atan2(-heading[0], -heading[2]) + (side * look.azimuth * Math.PI) / 180;
    const elevation = (look.elevation * Math.PI) / 180;
    const flat = Math.cos(elevation);
    const sun = [flat * Math.sin(yaw), Math.sin(elevation), flat * Math.cos(yaw)];
    const u = [sun[2] / flat, 0, -sun[0] / flat];
    const rows = [u, cross(u, sun), sun];
    const scale = this.texels / SHADOW_REACH;
    const light = new Float32Array(16);
    for (const k of [0, 1]) {
      const origin = Math.floor(dot(rows[k], view.root) * scale) / scale - SHADOW_REACH / 2;
      for (let i = 0; i < 3; ++i) light[4 * k + i] = (rows[k][i] * 2) / SHADOW_REACH;
      light[4 * k + 3] = (-origin * 2) / SHADOW_REACH - 1;
    }
    const [low, high] = CAST_DEPTH;
    for (let i = 0; i < 3; ++i) light[8 + i] = (-rows[2][i] * 2) / (high - low);
    light[11] = (high + low) / (high - low);
    light[15] = 1;
    return { sun, light };
  }

  /** @param {{sun: number[], light: Float32Array}} cast @param {Float32Array[]} bodies skinning matrices */
  drawShadow(cast, bodies) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.map.frame);
    gl.viewport(0, 0, this.texels, this.texels);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.CULL_FACE);
    const { program, at } = this.depth;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.light, true, cast.light);
    gl.uniform1f(at.to_map, 1);
    gl.bindVertexArray(this.mesh);
    for (const skin of bodies) {
      this.setJoints(skin);
      for (const part of this.doc.body.parts) drawPart(gl, part);
    }
    gl.enable(gl.CULL_FACE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** @param {Shown} view @param {Float32Array} world @param {{sun: number[], light: Float32Array}} cast */
  drawStage(view, world, cast) {
    const gl = this.gl;
    const { stage, look } = this.doc;
    const { program, at } = this.stage;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.camera, true, world);
    gl.uniformMatrix4fv(at.light, true, cast.light);
    gl.uniform3fv(at.palette, this.palette);
    gl.uniform3f(at.size, look.stage.tile, look.stage.pool, this.doc.pad.width);
    gl.uniform4f(at.pad, (stage.low[0] + stage.high[0]) / 2, (stage.low[2] + stage.high[2]) / 2,
      (stage.high[0] - stage.low[0]) / 2, (stage.high[2] - stage.low[2]) / 2);
    gl.uniform2f(at.corner_of_tiles, stage.corner[0], stage.corner[1]);
    gl.uniform2i(at.tiles, stage.panel.length, stage.panel[0].length);
    gl.uniform1f(at.dark, this.simple ? 0 : look.light.shadow);
    const texel = Math.max(1, Math.round((look.light.shadow_soft * this.texels) / SHADOW_REACH / 2));
    gl.uniform1f(at.spread, (texel * 1.35) / this.texels);
    gl.uniform3f(at.contact, look.light.contact, look.light.contact_soft, look.stage.glow);
    gl.uniform1f(at.radius, stage.sole);
    gl.uniform4fv(at.foot, view.marks.flatMap((m) => m.line));
    gl.uniform4fv(at.foot_state, view.marks.flatMap((m) => [m.ground, m.near, m.strength, m.pressed]));
    gl.uniform3fv(at.foot_colour, view.marks.flatMap((m) => m.colour));
    gl.uniform2fv(at.middles, [view.middles[0], view.middles[1] ?? view.middles[0]].flat());
    gl.uniform3f(at.fade, stage.shadow_fade[0], stage.shadow_fade[1], look.light.shadow_far);
    gl.uniform1f(at.beside, stage.ring_share);
    gl.uniform4fv(at.sole, view.soles.flatMap((sole) => sole?.line ?? [0, 0, 0, 1]));
    gl.uniform2fv(at.sole_ground, view.soles.map((sole) => sole?.ground ?? NOWHERE));
    bind(gl, 0, this.tiles, at.tile_of);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.lights);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, view.lights.length / 4, 1, gl.RGBA, gl.FLOAT, view.lights);
    gl.uniform1i(at.lights, 1);
    bind(gl, 2, this.map.texture, at.shadow);
    gl.bindVertexArray(this.room.array);
    gl.drawElements(gl.TRIANGLES, this.room.count, gl.UNSIGNED_SHORT, 0);
  }

  /**
   * The dancer and her outline.
   * @param {Shown} view @param {Float32Array} world @param {{sun: number[], light: Float32Array}} cast
   * @param {number} who the first or the second of two
   */
  drawBody(view, world, cast, who) {
    const gl = this.gl;
    const { camera } = view;
    const toon = this.doc.look.toon;
    const [, , width, height] = view.box;
    const { program, at } = this.dancer;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.camera, true, world);
    gl.uniformMatrix4fv(at.light, true, cast.light);
    gl.uniform3fv(at.eye, camera.position);
    gl.uniform3fv(at.sun, cast.sun);
    gl.uniform2f(at.pixels, width / 2, height / 2);
    gl.uniform1f(at.focal, camera.focal * height);
    gl.uniform2fv(at.off_surface, OFF_SURFACE);
    gl.uniform1f(at.to_map, 0);
    gl.uniform3f(at.bands, toon.bands[0], toon.bands[1], toon.soft);
    gl.uniform3fv(at.levels, toon.levels);
    gl.uniform2f(at.rim, toon.rim, toon.rim_from);
    gl.uniform3fv(at.shade, toon.shade.map((/** @type {number} */ c) => c / 255));
    gl.uniform3fv(at.outline_colour, toon.outline.map((/** @type {number} */ c) => c / 255));
    gl.uniform1f(at.has_shadow, this.simple ? 0 : 1);
    bind(gl, 2, this.map.texture, at.shadow);
    gl.bindVertexArray(this.mesh);
    const depth = Math.max(dot(minus(view.root, camera.position), axes(camera).forward), 0.05);
    const wide = (toon.outline_width * camera.focal * height) / depth;
    for (const [outline, cull] of [[0, gl.BACK], [wide, gl.FRONT]]) {
      gl.uniform1f(at.outline, outline);
      gl.cullFace(cull);
      for (const part of this.doc.body.parts) {
        if (camera.feetOnly && !part.feet) continue;
        bind(gl, 3, this.skins[part.skin[who]], at.skin);
        gl.uniform3fv(at.tint, part.tint[who]);
        gl.uniform1f(at.least, part.limb ? toon.limbs : 0);
        drawPart(gl, part);
      }
    }
    gl.cullFace(gl.BACK);
  }
}

/**
 * WebGL 2 for a canvas; with smooth edges, on another canvas in its place, unless the processor draws: they cost more
 * than they give there, and who draws is only known of a context.
 * @param {HTMLCanvasElement} canvas
 */
function contextOf(canvas) {
  const wanted = /** @type {WebGLContextAttributes} */ ({ antialias: false, alpha: false, powerPreference: "high-performance" });
  const gl = canvas.getContext("webgl2", wanted);
  if (!gl) throw new Error("no WebGL 2");
  const about = gl.getExtension("WEBGL_debug_renderer_info");
  const name = about ? String(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)) : "";
  if (/swiftshader|llvmpipe|softpipe|software/i.test(name)) return { gl, soft: true };
  const other = /** @type {HTMLCanvasElement} */ (canvas.cloneNode());
  const smooth = other.getContext("webgl2", { ...wanted, antialias: true });
  if (!smooth) return { gl, soft: false };
  canvas.replaceWith(other);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return { gl: smooth, soft: false };
}
