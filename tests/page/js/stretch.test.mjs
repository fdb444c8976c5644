// Slower and quicker music: its pitch stays, its clicks come when they should.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Stretcher } from "../../../dancetutor_cli/page/js/stretch.js";

const RATE = 44100;

function sine(hertz, seconds) {
  return Float32Array.from({ length: RATE * seconds }, (_, i) => 0.5 * Math.sin((2 * Math.PI * hertz * i) / RATE));
}

function crossings(data) {
  let count = 0;
  for (let i = 1; i < data.length; ++i) if (data[i - 1] < 0 && data[i] >= 0) ++count;
  return count;
}

for (const rate of [0.25, 0.5, 0.75, 1.25, 2]) {
  test(`pitch and loudness stay at rate ${rate}`, () => {
    const data = sine(440, 4);
    const out = new Stretcher([data], RATE, rate, 0.5).read(RATE)[0];
    const hertz = crossings(out);
    assert.ok(Math.abs(hertz - 440) <= 4, `${hertz} Hz`);
    const loud = Math.sqrt(out.reduce((sum, x) => sum + x * x, 0) / out.length);
    assert.ok(Math.abs(loud - 0.5 / Math.SQRT2) < 0.03, `loudness ${loud}`);
  });

  test(`clicks keep their place at rate ${rate}`, () => {
    const data = new Float32Array(4 * RATE);
    for (let k = 1; k < 8; ++k) for (let i = 0; i < 200; ++i) data[k * RATE * 0.5 + i] = Math.exp(-i / 30) * Math.sin(i / 3);
    const out = new Stretcher([data], RATE, rate, 0).read(Math.round((3 * RATE) / rate))[0];
    for (let k = 1; k < 6; ++k) {
      const wanted = (k * 0.5 * RATE) / rate;
      let best = 0;
      for (let i = Math.round(wanted - 0.06 * RATE); i < wanted + 0.06 * RATE; ++i) if (Math.abs(out[i]) > Math.abs(out[best])) best = i;
      // A piece is laid with its middle in place, and moved by at most 9 ms to fit: half a piece and that is the most.
      assert.ok(Math.abs(best - wanted) / RATE < 0.034, `click ${k} is ${(best - wanted) / RATE} s off`);
    }
  });
}

test("at its own speed the music is left as it is, and before it there is silence", () => {
  const data = sine(300, 1);
  const stretcher = new Stretcher([data, data], RATE, 1, -0.5);
  const out = stretcher.read(RATE);
  assert.equal(out.length, 2);
  assert.ok(out[0].subarray(0, RATE / 2).every((x) => x === 0));
  assert.deepEqual(out[1].subarray(RATE / 2), data.subarray(0, RATE / 2));
  assert.ok(new Stretcher([data], RATE, 0.5, 5).read(1000)[0].every((x) => x === 0));
});
