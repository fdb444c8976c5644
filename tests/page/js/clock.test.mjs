// The clock: seeks, loops with lead-in, rates, waiting; under a clock that the test turns.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Transport } from "../../../dancetutor_cli/page/js/clock.js";

function make() {
  const at = { now: 100 };
  const transport = new Transport(() => at.now, 0, 60);
  return { at, transport };
}

const near = (a, b, by = 1e-9) => assert.ok(Math.abs(a - b) <= by, `${a} is not ${b}`);

test("a second of the clock is a second of the music at rate 1, and half of one at 0.5", () => {
  const { at, transport } = make();
  transport.play();
  const start = transport.run.at;
  at.now = start + 4;
  near(transport.second(), 4);
  transport.setRate(0.5);
  near(transport.second(), 4);
  at.now += 4;
  near(transport.second(), 6);
  transport.pause();
  at.now += 100;
  near(transport.second(), 6);
});

test("rates stay between a quarter and two", () => {
  const { transport } = make();
  transport.setRate(0.01);
  assert.equal(transport.rate, 0.25);
  transport.setRate(9);
  assert.equal(transport.rate, 2);
});

test("a loop begins again from its lead-in, without losing a moment", () => {
  const { at, transport } = make();
  transport.lead = (a) => a - 2;
  transport.countIn = true;
  transport.setLoop({ a: 10, b: 14 });
  let passes = 0;
  transport.onPass = () => { ++passes; };
  transport.play();
  near(transport.run.from, 8);
  assert.equal(transport.run.quietUntil, 10);
  const first = transport.run.at;
  at.now = first + 6 + 0.016; // a picture late
  transport.tick();
  assert.equal(passes, 1);
  near(transport.run.at, first + 6);
  near(transport.second(), 8.016, 1e-9);
});

test("the rate that a pass sets holds for the next one", () => {
  const { at, transport } = make();
  transport.setLoop({ a: 0, b: 2 });
  transport.onPass = () => { transport.rate = 0.5; };
  transport.play();
  at.now = transport.run.at + 2;
  transport.tick();
  assert.equal(transport.run.rate, 0.5);
});

test("it waits at a row until it may go on", () => {
  const { at, transport } = make();
  transport.holdAt(3);
  transport.play();
  at.now = transport.run.at + 10;
  transport.tick();
  near(transport.second(), 3);
  assert.ok(transport.waiting);
  transport.holdAt(5);
  assert.ok(!transport.waiting);
  at.now += 1;
  near(transport.second(), 4);
  at.now += 9;
  near(transport.second(), 5);
});

test("it ends at the end, and begins again from the start", () => {
  const { at, transport } = make();
  transport.seek(59);
  transport.play();
  at.now = transport.run.at + 3;
  transport.tick();
  assert.ok(!transport.playing);
  near(transport.second(), 60);
  transport.play();
  near(transport.second(), 0);
});

test("a seek while it plays goes on there", () => {
  const { at, transport } = make();
  transport.play();
  at.now += 5;
  transport.seek(30);
  at.now = transport.run.at + 1;
  near(transport.second(), 31);
});

test("from the loop's beginning it plays with the lead-in, from within it does not; before the song's start too", () => {
  const { transport } = make();
  transport.lead = (a) => a - 2;
  transport.countIn = true;
  transport.setLoop({ a: 1, b: 4 });
  transport.seek(1); // as a deep link leaves it
  transport.play();
  near(transport.run.from, -1);
  assert.ok(transport.counting);
  transport.pause();
  transport.seek(2);
  transport.play();
  near(transport.run.from, 2);
  assert.ok(!transport.counting);
  transport.restartLoop();
  near(transport.run.from, -1);
});
