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
