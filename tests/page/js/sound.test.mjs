// What is prepared to be heard.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Sound } from "../../../dancetutor_cli/page/js/sound.js";

test("a row that waits where a count-in ends: the silence before it is prepared, and that ends", () => {
  for (let k = 0; k < 500; ++k) { // where rounding leaves a rest is chance: about one in six
    const sound = new Sound();
    const [at, rate, end] = [5 + 0.617 * k, [1, 0.7, 0.75, 0.85, 0.95, 0.5][k % 6], 1.875 * (1 + (k % 20))];
    let due = at;
    let steps = 0;
    Object.defineProperty(sound, "due", { get: () => due, set: (value) => { due = value; assert.ok(++steps < 1000, `${at} ${rate} ${end}`); } });
    sound.music = /** @type {any} */ ({}); // none of it is to be heard before the row
    sound.context = /** @type {any} */ ({ state: "running", currentTime: at + 10 });
    sound.follow({ at, from: end - 1.875, to: end + 8, rate, quietUntil: end });
    sound.pump(end); // the clock does not pass it
    assert.ok(Math.abs(due - at - 1.875 / rate) < 1e-5);
  }
});
