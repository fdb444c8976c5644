// A note's shape fills its lane, whichever way it points.
import assert from "node:assert/strict";
import { test } from "node:test";

import { corners } from "../../../dancetutor_cli/page/js/noteart.js";

for (const way of [0, 90, 180, 270, 45, 135, 225, 315, null]) {
  test(`corners of ${way}`, () => {
    for (const axis of [0, 1]) {
      const values = corners(way).map((corner) => corner[axis]);
      const [least, most] = [Math.min(...values), Math.max(...values)];
      assert.ok(least >= -1 && most <= 1 && most - least >= 1.7, `${least} to ${most}`);
    }
  });
}
