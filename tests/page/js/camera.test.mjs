// Cameras: who walks on from beside the pad is seen in a narrow picture too.
import assert from "node:assert/strict";
import { test } from "node:test";
import { beside, matrix, orbit, preset } from "../../../dancetutor_cli/page/js/camera.js";

const camera = { position: [0, 1.5, -4], target: [0, 0.9, 0], focal: 1.2, centre: [0.5, 0.5], feetOnly: false, mirror: false };

/** Where a point lies across the picture, 0 to 1. */
function across(one, point, width, height) {
  const m = matrix(one, width, height);
  const row = (k) => m[4 * k] * point[0] + m[4 * k + 1] * point[1] + m[4 * k + 2] * point[2] + m[4 * k + 3];
  return (row(0) / row(3) + 1) / 2;
}

test("she is never cut off at the sides, wherever she walks", () => {
  for (const mirror of [false, true]) {
    for (const x of [-3, -1, -0.2, 0, 0.5, 2]) {
      const moved = beside({ ...camera, mirror }, [x, 0.9, 0], 220 / 340);
      for (const side of [-0.4, 0.4]) {
        const at = across(moved, [x + side, 0.9, 0], 220, 340);
        assert.ok(at >= 0 && at <= 1, `${x} ${side}: ${at}`);
      }
    }
  }
});

test("the camera stands still while she is in the picture", () => {
  assert.equal(beside(camera, [0.3, 0.9, 0.1], 16 / 9), camera);
});

/** The presets' box round a pad of three panels, as the pages have it. */
const doc = {
  stage: { low: [-0.45, 0, -0.45], high: [0.45, 0, 0.45], tall: 1.7 },
  look: { stage: { pad_height: 0.05 }, cameras: { back: { margin: 0.1, height: 1.9, arms: 0.2, feet_only: false, azimuth: 0, elevation: 20, field: 34 } } },
};

test("the free camera never loses the pad, however near and from wherever it looks", () => {
  for (const [width, height] of [[610, 530], [214, 320], [300, 200]]) {
    for (const zoom of [0.5, 1, 2, 3, 40]) for (const pitch of [-5, 2, 20, 60, 88]) for (const yaw of [0, 30, 140, -75]) {
      const one = orbit(doc, { yaw, pitch, zoom }, width, height);
      const m = matrix(one, width, height);
      for (const x of [-0.45, 0.45]) for (const z of [-0.45, 0.45]) {
        const row = (k) => m[4 * k] * x + m[4 * k + 2] * z + m[4 * k + 3];
        for (const k of [0, 1]) assert.ok(Math.abs(row(k) / row(3)) <= 1, `${[width, height, zoom, pitch, yaw]}`);
      }
      assert.ok(one.zoom <= zoom && one.target[1] >= -0.01);
      if (zoom <= 1 && width > 300) assert.equal(one.zoom, zoom, "it comes as near as is asked where there is room");
    }
  }
  const [far, near] = [1, 1.5].map((zoom) => orbit(doc, { yaw: 30, pitch: 20, zoom }, 610, 530));
  assert.ok(near.zoom > 1.4 && near.target[1] < far.target[1], "nearer it looks down to the feet");
});

test("in a narrow picture less room is kept for arms: she is larger, and the pad is whole", () => {
  const about = { margin: 0.02, height: 1.86, arms: 0.36, feet_only: false, azimuth: 0, elevation: 28, field: 44 };
  const single = { stage: doc.stage, look: { stage: doc.look.stage, cameras: { back: about } } };
  const tall = (width, height) => {
    const m = matrix(preset(single, "back", width, height), width, height);
    const at = (point, k) => {
      const row = (n) => m[4 * n] * point[0] + m[4 * n + 1] * point[1] + m[4 * n + 2] * point[2] + m[4 * n + 3];
      return row(k) / row(3);
    };
    for (const x of [-0.45, 0.45]) for (const z of [-0.45, 0.45]) for (const k of [0, 1]) assert.ok(Math.abs(at([x, 0, z], k)) <= 1);
    return (at([0, 1.7, 0], 1) - at([0, 0, 0], 1)) * height / 2;
  };
  assert.ok(tall(136, 523) > 1.25 * 136, `${tall(136, 523)}`);
  const m = matrix(preset(single, "back", 154, 560), 154, 560);
  const edge = (m[6] * -0.45 + m[7]) / (m[14] * -0.45 + m[15]); // of the pad, the near one; -1 is the lower end of the picture
  assert.ok(edge > -0.95 && edge < -0.6, `most of the floor is above the dancer, where buttons are: ${edge}`);
  assert.ok(tall(300, 400) < 400 && tall(900, 500) < 500);
});
