// Cameras: who walks on from beside the pad is seen in a narrow picture too.
import assert from "node:assert/strict";
import { test } from "node:test";
import { beside, matrix } from "../../../dancetutor_cli/page/js/camera.js";

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
