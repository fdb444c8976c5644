// Lit panels: a flash that fades, and only a soft light for who asks for reduced motion.
import assert from "node:assert/strict";
import { test } from "node:test";

const chart = {
  second: [10], end: [10], limb: [1], given: new Map(),
  lastPress: (/** @type {number} */ _column, /** @type {number} */ second) => (second >= 10 ? 0 : -1),
};

/** The module anew, in a browser with or without the wish for reduced motion. */
async function light(reduce) {
  globalThis.matchMedia = () => ({ matches: reduce });
  const { lightOf } = await import(`../../../dancetutor_cli/page/js/feet.js?reduce=${reduce}`);
  return (second) => lightOf(chart, 0, second, 0.4).level;
}

test("a press is a flash that fades", async () => {
  const at = await light(false);
  assert.equal(at(9.9), 0);
  assert.equal(at(10), 1);
  assert.ok(Math.abs(at(10.2) - 0.75) < 1e-9 && at(10.5) === 0);
  assert.ok(at(10.35) < 0.25, "it goes out quickly");
});

test("reduced motion has no flash", async () => {
  const at = await light(true);
  assert.equal(at(10), 0.4);
  for (let t = 10; t < 10.5; t += 0.01) assert.ok(at(t) <= 0.4);
  assert.equal(at(10.5), 0);
});

test("a note that nobody plays lights no panel, until it is given to a foot", async () => {
  const { lightOf } = await import("../../../dancetutor_cli/page/js/feet.js?reduce=0");
  const note = { second: [1], end: [1], limb: [-2], given: new Map(), lastPress: () => 0 };
  assert.deepEqual(lightOf(note, 0, 1, 0.4), { level: 0, limb: -1 });
  const given = { ...note, given: new Map([[0, 1]]) };
  assert.ok(lightOf(given, 0, 1, 0.4).level > 0.3);
  assert.equal(lightOf(given, 0, 1, 0.4).limb, 1);
});

test("a foot presses the lit panel of its own colour that is under its sole", async () => {
  const { marksOf } = await import("../../../dancetutor_cli/page/js/feet.js?reduce=0");
  const none = [null, null, null];
  const doc = {
    body: { marks: [{ joints: [0, 0], at: [[0, 0, -0.1], [0, 0, 0.1]] }, ...none] },
    look: { light: { contact_height: 0.22 }, stage: { pad_height: 0.1, mark: 1 } },
    stage: { low: [-1, 0, -1], high: [1, 0, 1] }, style: { limbs_rgb: [[255, 140, 0], [0, 200, 220], [1, 1, 1], [2, 2, 2]] },
    pad: { panels: [[1, 0], [1, 2]], centre: [1, 1], width: 0.3 },
  };
  const at = (/** @type {number} */ z, /** @type {number} */ y) => ({ at: () => [0, y, z], turned: () => [1, 0, 0, 0] });
  const lights = (/** @type {number[]} */ colour) => new Float32Array([0, 0, 0, 0, ...colour.map((c) => c / 255), 0.8]);
  const pressed = (/** @type {number} */ z, /** @type {number} */ y, /** @type {number[]} */ colour) =>
    marksOf(doc, at(z, y), lights(colour))[0].pressed;
  assert.ok(Math.abs(pressed(0.3, 0, [255, 140, 0]) - 0.8) < 1e-6, "on it");
  assert.equal(pressed(-0.3, 0, [255, 140, 0]), 0, "on another panel");
  assert.equal(pressed(0.3, 0, [0, 200, 220]), 0, "lit by the other foot");
  assert.equal(pressed(0.3, 0.1, [255, 140, 0]), 0, "over it");
});
