// The ramp and its end, the score of the pass before; what is said of it; the count-in's number.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Transport } from "../../../dancetutor_cli/page/js/clock.js";
import { Input } from "../../../dancetutor_cli/page/js/input.js";
import { Practice } from "../../../dancetutor_cli/page/js/practice.js";
import { addOutcomes, emptyRecord } from "../../../dancetutor_cli/page/js/record.js";
import { countOf, passedOf, statusText } from "../../../dancetutor_cli/page/js/status_text.js";

/** An app with a beat a second, a row at every second, and a clock that the test turns. */
function make() {
  const at = { now: 0 };
  const seconds = Array.from({ length: 40 }, (_, k) => k);
  const chart = {
    second: seconds, end: seconds, rowSeconds: seconds, presses: [seconds],
    given: new Map(), rows: seconds.map((second) => ({ row: second, beat: second, second, steps: [{ note: second, column: 0, limb: 0, part: 0 }] })),
    first: 0, beatAt: (second) => second, secondAt: (beat) => beat,
  };
  const transport = new Transport(() => at.now, 0, 40);
  transport.lead = (a) => a - 4;
  transport.countIn = true;
  const app = {
    chart, transport, settings: { ramp: true, help: "all", latency: 0, sight: 0 }, sound: { latency: 0 }, both: false, notice: "",
    record: emptyRecord(), saveRecord: () => {}, doc: { passages: [] }, setLoop: (a, b) => { app.practice.endRamp(); transport.setLoop({ a, b }); },
    played: true, tell: () => {}, t: (name, values = {}) => [name, ...Object.values(values)].join(" "),
  };
  app.practice = new Practice(app);
  transport.onPass = () => app.practice.pass();
  return { at, app, transport };
}

/** Let the clock come to a second of the music. */
function go(at, transport, second) {
  at.now = transport.run.at + (second - transport.run.from) / transport.run.rate;
  transport.tick();
}

test("the ramp goes on from the chosen speed, says so, and its end brings the chosen speed back", () => {
  const { at, app, transport } = make();
  transport.setRate(0.7);
  app.practice.chosenRate = transport.rate;
  transport.setLoop({ a: 8, b: 12 });
  transport.play();
  for (const rate of [0.75, 0.8]) {
    go(at, transport, 12);
    assert.equal(transport.rate, rate);
  }
  assert.equal(statusText(app), "loopFrom oneMeasure 2 2 · ramped speedStep 75 80");
  app.practice.endRamp();
  assert.equal(transport.rate, 0.7);
  assert.equal(app.practice.passes, 0);
  assert.ok(transport.playing);
});

test("a wrong panel makes a pass unclean, and what was pressed is said in the next one", () => {
  const { at, app, transport } = make();
  app.practice.setAlong(true);
  app.settings.ramp = true;
  transport.setLoop({ a: 8, b: 10 });
  transport.play();
  app.practice.restart(8);
  for (const second of [8, 8.5, 9]) {
    go(at, transport, second);
    app.practice.press(0, 0);
  }
  go(at, transport, 10);
  assert.equal(transport.rate, 0.95);
  assert.equal(passedOf(app), "passScores 67 % · speedStep 100 95"); // in the count-in: both notes hit, and a wrong press
  go(at, transport, 8.5);
  assert.equal(passedOf(app), "");
});

test("a pass in which nobody presses anything teaches neither the coach nor the ramp anything", async () => {
  const { at, app, transport } = make();
  app.loopBeats = async (a, b) => { transport.setLoop({ a, b }); transport.restartLoop(); transport.play(); };
  app.doc.passages = [{ start: 8, end: 12 }];
  await app.practice.coach.start();
  assert.deepEqual([transport.rate, app.practice.coach.message], [0.7, "coachNew 70"]);
  for (const press of [false, true]) {
    app.practice.restart(8);
    go(at, transport, 8);
    if (press) app.practice.press(0, 0);
    go(at, transport, 12.01);
    assert.equal(transport.rate, press ? 0.6 : 0.7); // a quarter hit: back by a tenth
  }
  assert.equal(app.practice.coach.message, "coachFailed 25 60 95");
  app.practice.coach.stop();
  transport.setRate(0.7);
  app.practice.restart(8);
  go(at, transport, 12.01);
  assert.equal(transport.rate, 0.7);
});

test("what a press was fades away, and is gone as a pass begins or the clock stands", () => {
  const { at, app, transport } = make();
  app.practice.setAlong(true);
  transport.setLoop({ a: 8, b: 10 });
  transport.play();
  app.practice.restart(8);
  go(at, transport, 8.06);
  app.practice.press(0, 0);
  assert.ok(Math.abs(app.practice.shown().error - 0.06) < 1e-6);
  assert.deepEqual(app.practice.errors.map((error) => Math.round(1000 * error)), [60]);
  go(at, transport, 10);
  assert.equal(app.practice.feedback, null);
  assert.equal(app.practice.errors.length, 1); // the scale goes on
});

test("the best pass of a passage is kept from a song that is played, too", () => {
  const { at, app, transport } = make();
  app.doc.passages = [{ start: 8, end: 12 }, { start: 20, end: 24 }];
  app.practice.setAlong(true);
  transport.onEnd = () => app.practice.finish();
  transport.play();
  for (const second of [8, 9, 10.1, 11]) {
    go(at, transport, second);
    app.practice.press(0, 0);
  }
  go(at, transport, 40.5);
  assert.deepEqual(app.record.scores, { "8-12": 88 }); // 3 hits and a half of 4; nobody played the other one
  assert.deepEqual(app.record.best, { "8-12": 100 });
});

/** Play the song from its start: press a second's panels, then go on. */
function song(change = () => {}, columns = [0]) {
  const { at, app, transport } = make();
  app.chart.presses = [app.chart.second, [], []];
  app.doc.passages = [{ start: 8, end: 12 }];
  transport.onEnd = () => app.practice.finish();
  app.practice.setAlong(true);
  app.practice.restart(0);
  transport.play();
  for (let second = 0; second < 40; ++second) {
    go(at, transport, second);
    change(second, app);
    for (const column of columns) app.practice.press(column, 0);
    app.practice.advance(second + 0.2);
  }
  go(at, transport, 40.5);
  return app;
}

test("a song that is played at full speed is the best, and what is pressed besides counts against it", () => {
  const { record, practice } = song();
  assert.deepEqual([record.top, record.scores, record.best, practice.longest], [100, { "8-12": 100 }, { "8-12": 100 }, 40]);
  const all = song(undefined, [0, 1, 2]); // every panel on every row
  assert.deepEqual([all.record.top, all.record.scores, all.record.best], [33, { "8-12": 33 }, {}]);
  assert.match(statusText(all), /^songOver 33 /);
});

test("what was pressed while the clock waited is no part of the best", () => {
  const off = (last) => song((second, { practice }) => { if (second === 1 || second === last) practice.setWait(second === 1); });
  for (const last of [13, 39]) {
    const { record, practice } = off(last);
    assert.deepEqual([record.top, record.scores, record.best], [0, {}, {}]);
    assert.equal(practice.over.hit, 40 - last); // since it waits no more
  }
  assert.deepEqual(off(5).record.best, { "8-12": 100 }); // all of the passage was played in time
});

test("a pass of a loop that the clock waited in is no pass, whatever came after", () => {
  const { at, app, transport } = make();
  app.practice.setAlong(true);
  transport.setLoop({ a: 8, b: 12 });
  transport.play();
  app.practice.restart(8);
  app.practice.setWait(true);
  for (const second of [8, 9, 10, 11]) {
    go(at, transport, second);
    if (second === 11) app.practice.setWait(false);
    app.practice.press(0, 0);
  }
  go(at, transport, 12.01);
  assert.deepEqual([app.record.scores, app.record.best, app.practice.scores, transport.rate], [{}, {}, [], 1]);
  for (const second of [8, 9, 10, 11]) {
    go(at, transport, second);
    app.practice.press(0, 0);
  }
  go(at, transport, 12.01);
  assert.deepEqual([app.record.scores, app.record.best, app.practice.scores], [{ "8-12": 100 }, { "8-12": 100 }, [1]]);
});

test("what was played slowly is not the best at full speed, whichever speed it ended at", () => {
  const at = (slow, full) => song((second, { transport }) => {
    if (second === slow) transport.setRate(0.25);
    if (second === full) transport.setRate(1);
  });
  const { record } = at(0, 39);
  assert.deepEqual([record.top, record.scores, record.best, record.rows[39].rate], [0, {}, { "8-12": 25 }, 25]);
  assert.equal(at(20, 21).record.top, 0);
});

test("the speed before the first row is nobody's practice", () => {
  const { at, app, transport } = make();
  app.practice.setAlong(true);
  transport.setLoop({ a: 8, b: 10 });
  transport.setRate(0.5);
  transport.play();
  app.practice.restart(8);
  go(at, transport, 6);
  app.practice.advance(6);
  transport.setRate(1);
  for (const second of [8, 9]) {
    go(at, transport, second);
    app.practice.advance(second);
    app.practice.press(0, 0);
  }
  go(at, transport, 10);
  assert.deepEqual(app.record.best, { "8-10": 100 });
});

test("the coach has a stretch passed at full speed only if all of it was", async () => {
  const { at, app, transport } = make();
  app.doc.passages = [{ start: 8, end: 10 }];
  app.loopBeats = async (a, b) => { transport.setLoop({ a, b }); transport.restartLoop(); transport.play(); };
  await app.practice.coach.start();
  app.practice.restart(8);
  for (const second of [8, 9]) {
    go(at, transport, second);
    if (second === 9) transport.setRate(1);
    app.practice.press(0, 0);
  }
  go(at, transport, 10);
  assert.equal(app.practice.coach.message, "coachGoesOn 100 100");
});

test("the count-in shows the beats that are left, and nothing once the loop has begun", () => {
  const { at, app, transport } = make();
  transport.setLoop({ a: 8, b: 12 });
  transport.play();
  const seen = [4, 4.5, 5, 6, 7, 7.9, 8, 9].map((second) => { go(at, transport, second); return countOf(app); });
  assert.deepEqual(seen, ["4", "4", "3", "2", "1", "1", "", ""]);
  go(at, transport, 12); // and in every pass
  assert.equal(countOf(app), "4");
  transport.pause();
  assert.equal(countOf(app), "");
});

test("each press is judged in sight, for a moment; the end of the song says how it went", () => {
  const { at, app, transport } = make();
  app.practice.setAlong(true);
  transport.onEnd = () => app.practice.finish();
  transport.play();
  for (const [second, verdict] of [[1, "hit"], [1.4, "wrong"], [2.1, "late"], [2.9, "early"]]) {
    go(at, transport, second);
    app.practice.press(0, 0);
    assert.deepEqual([app.practice.shown().verdict, app.practice.shown().column], [verdict, 0]);
  }
  go(at, transport, 4.5);
  app.practice.advance(4.5);
  assert.deepEqual([app.practice.shown().verdict, app.practice.shown().column], ["miss", -1]);
  app.practice.feedback.at -= 800;
  assert.equal(app.practice.shown(), null);
  go(at, transport, 40.5);
  assert.equal(transport.playing, false);
  assert.match(statusText(app), /^songOver 5 1 verdict-hit, 1 verdict-early, 1 verdict-late, 37 verdict-miss, 1 verdict-wrong/); // 1 + 2 halves of 41
  app.practice.restart(0);
  assert.equal(statusText(app), "");
});

test("the first key that is no panel has the keys said, until a panel is pressed", () => {
  const { app } = make();
  app.input = new Input(["left", "down", "up", "right"], { keys: {}, pads: {} });
  app.practice.setAlong(true);
  app.practice.showKeys();
  assert.equal(statusText(app), "keysOrArrows D F J K ← ↓ ↑ →");
  app.practice.press(0, 0);
  app.practice.showKeys();
  assert.doesNotMatch(statusText(app), /keys/);
  assert.equal(new Input(["a", "b", "c", "d", "e"], { keys: {}, pads: {} }).columnOf("ArrowLeft"), -1); // Pump keeps its keys
  assert.deepEqual(["ArrowLeft", "ArrowDown", "ArrowUp", "ArrowRight", "KeyK"].map((code) => app.input.columnOf(code)), [0, 1, 2, 3, 3]);
});

test("the coach loops what was missed, raises the speed by what is hit, and goes on when it is passed at full speed", async () => {
  const { at, app, transport } = make();
  const missed = (row) => ({ row, limb: 0, verdict: "miss", error: undefined });
  addOutcomes(app.record, "2026-11-23", [...[8, 9, 10, 11].map((row) => ({ row, limb: 0, verdict: "hit", error: 0 }))], 0, 0.9);
  addOutcomes(app.record, "2026-11-24", [missed(8), missed(9), missed(20)], 0, 1);
  app.loopBeats = async (a, b) => { transport.setLoop({ a, b }); transport.restartLoop(); transport.play(); };
  const { coach } = app.practice;
  await coach.start();
  assert.deepEqual([transport.loop, transport.rate, app.practice.along], [{ a: 8, b: 12 }, 0.9, true]);
  const pass = (hits) => {
    const { a, b } = transport.loop;
    app.practice.restart(a);
    for (let second = a; second < b; ++second) {
      go(at, transport, second);
      if (second - a < hits) app.practice.press(0, 0);
    }
    go(at, transport, b + 0.01);
  };
  pass(4);
  assert.deepEqual([transport.rate, transport.loop.a], [1, 8]); // all hit at 90 %
  pass(2);
  assert.equal(transport.rate, 0.95); // half of it missed
  pass(4);
  assert.equal(transport.rate, 1);
  pass(4);
  assert.deepEqual([transport.loop, transport.rate], [{ a: 20, b: 24 }, 0.7]); // passed: the next stretch, never passed yet
  assert.match(statusText(app), /coachNext 100 70/);
  coach.stop();
  assert.equal(transport.rate, 1);
  assert.deepEqual(app.record.best, { "8-12": 100 });
});
