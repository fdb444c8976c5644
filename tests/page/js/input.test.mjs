// Mats: arrows that are buttons or the ends of axes, what they are called, and what a mat that is pulled out lets go.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Input } from "../../../dancetutor_cli/page/js/input.js";

const NAMES = ["left", "down", "up", "right"];
const WAYS = [270, 180, 0, 90];

/** @param {object} pad what the browser says of it, with `AXES` and buttons that the test moves */
function plugged(pad) {
  const all = { id: "mat", connected: true, mapping: "", axes: [0, 0], timestamp: 0, buttons: Array.from({ length: 12 }, () => ({ pressed: false, value: 0 })), ...pad };
  Object.defineProperty(globalThis, "navigator", { value: { getGamepads: () => [all] }, configurable: true });
  const input = new Input(NAMES, { keys: {}, pads: {}, controls: {} }, WAYS);
  const pressed = [];
  input.onPress = ({ column }) => pressed.push(column);
  return { input, pressed, pad: all };
}

test("both ends of the first two axes are the arrows", () => {
  const { input, pressed, pad } = plugged({});
  input.poll();
  for (const [axes, column] of [[[-1, 0], 0], [[0, 1], 1], [[0, -1], 2], [[1, 0], 3]]) {
    pad.axes = axes;
    input.poll();
    assert.equal(pressed.at(-1), column);
    assert.deepEqual(input.held, NAMES.map((_, k) => k === column));
    pad.axes = [0, 0];
    input.poll();
    assert.ok(!input.held.includes(true));
  }
});

test("what rests at its end, a hat's number beyond its ends, and the sticks of a controller are no panels", () => {
  for (const about of [{ axes: [-1, 0] }, { axes: [3.29, 0] }, { mapping: "standard" }]) {
    const { input, pressed, pad } = plugged(about);
    input.poll();
    pad.axes = about.mapping ? [-1, 1] : [about.axes[0], 0];
    input.poll();
    assert.deepEqual(pressed, []);
  }
});

test("a mat that is stepped on as it is seen first counts from the next step on", () => {
  const { input, pressed, pad } = plugged({ axes: [-1, 0] });
  for (const x of [-1, 0, -1]) {
    pad.axes = [x, 0];
    input.poll();
  }
  assert.deepEqual(pressed, [0]);
});

test("a mat's panels are called by their arrows until a key is pressed", () => {
  const { input, pad } = plugged({});
  assert.equal(input.names()[0][0], "D");
  pad.buttons[0].pressed = true;
  input.poll();
  assert.deepEqual(input.names().map(([name]) => name), ["←", "↓", "↑", "→"]);
  input.key({ code: "KeyD", repeat: false, timeStamp: 0 });
  assert.equal(input.names()[0][0], "D");
});

test("buttons that were chosen hold in place of axes, and an end can be chosen", () => {
  const { input, pressed, pad } = plugged({});
  input.poll();
  input.assign(2, "mat/4#66");
  pad.axes = [0, -1];
  input.poll();
  assert.deepEqual(pressed, [2]);
  pad.axes = [-1, 0];
  input.poll();
  assert.deepEqual(pressed, [2], "left was not chosen so");
});

test("Start and Select of a mat do what they say, others that were chosen do so instead, and panels come first", () => {
  const { input, pressed, pad } = plugged({});
  /** @type {string[]} */
  const done = [];
  input.onControl = (name) => done.push(name);
  const tap = (number) => {
    for (const down of [true, false]) {
      pad.buttons[number] = { pressed: down, value: 0 };
      input.poll();
    }
  };
  pad.buttons = Array.from({ length: 12 }, () => ({ pressed: false, value: 0 }));
  input.poll();
  for (const number of [9, 8, 10]) tap(number);
  assert.deepEqual(done, ["start", "select"]);
  input.assignControl(0, "mat/4#10");
  input.assignControl(1, "KeyK"); // keys have their own
  for (const number of [10, 9, 8]) tap(number);
  assert.deepEqual(done, ["start", "select", "start", "select"]);
  input.assign(0, "mat/4#8"); // now a panel
  tap(8);
  assert.deepEqual([done.length, pressed.at(-1)], [4, 0]);
});

test("a press of 50 ms between two pictures is not lost", async () => {
  const { input, pressed, pad } = plugged({});
  const pause = (/** @type {number} */ ms) => new Promise((done) => setTimeout(done, ms));
  const timer = input.watch();
  await pause(30);
  pad.axes = [-1, 0];
  await pause(50);
  pad.axes = [0, 0];
  await pause(50);
  clearInterval(timer);
  assert.deepEqual(pressed, [0]);
  assert.ok(!input.held.includes(true));
});
