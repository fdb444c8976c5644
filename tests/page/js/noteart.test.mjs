// A note's shape fills its lane, whichever way it points.
import assert from "node:assert/strict";
import { test } from "node:test";

import { corners, markerAt } from "../../../dancetutor_cli/page/js/noteart.js";

for (const way of [0, 90, 180, 270, 45, 135, 225, 315, null]) {
  test(`corners of ${way}`, () => {
    for (const axis of [0, 1]) {
      const values = corners(way).map((corner) => corner[axis]);
      const [least, most] = [Math.min(...values), Math.max(...values)];
      assert.ok(least >= -1 && most <= 1 && most - least >= 1.7, `${least} to ${most}`);
    }
  });
}

const MARK = { aside: [0.135, 0.25], size: 0.435 };

for (const way of [0, 90, 180, 270, 45, 135, 225, 315]) {
  test(`a marker on an arrow of ${way} stands on its tail, in its lane`, () => {
    const { x, y, size } = markerAt(way, 1, MARK);
    const ahead = [Math.sin((way * Math.PI) / 180), -Math.cos((way * Math.PI) / 180)];
    assert.ok(x * ahead[0] + y * ahead[1] < -0.1);
    assert.ok(Math.abs(x) + size / 2 <= 0.5 && Math.abs(y) + size / 2 <= 0.5);
  });
}

test("on a middle panel it stands in the middle", () => assert.deepEqual(markerAt(null, 2, MARK), { x: 0, y: 0, size: 1 }));
