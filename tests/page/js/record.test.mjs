// What was practised: by row, foot and day; streaks, stretches that were missed, files of strangers, the coach's steps.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  BINS, addClean, addOutcomes, addPlay, coachRate, dayOf, emptyRecord, fromFile, hitShare, merged, missedOf, missesThrough, panelShare, passedFull, scoreShare, streakOf, toFile, validRecord,
} from "../../../dancetutor_cli/page/js/record.js";
import { thinned, together } from "../../../dancetutor_cli/page/js/timeline.js";

const outcome = (row, verdict, error, limb = row % 2) => ({ row, measure: Math.floor(row / 4), limb, verdict, error });

/** Two days of a chart of eight rows, a beat apart. */
function played() {
  const record = emptyRecord();
  addOutcomes(record, "2026-11-23", [outcome(0, "hit", 0.01), outcome(1, "late", 0.09), outcome(2, "miss")], 1, 0.8);
  addOutcomes(record, "2026-11-24", [outcome(0, "hit", -0.01), outcome(1, "miss"), outcome(2, "early", -0.08)], 0, 0.9);
  return record;
}

test("errors are counted by day and foot, and by row", () => {
  const { days, rows } = played();
  assert.deepEqual(days.map(({ day, hit, early, late, miss, wrong }) => [day, hit, early, late, miss, wrong]),
    [["2026-11-23", 1, 0, 1, 1, 1], ["2026-11-24", 1, 1, 0, 1, 0]]);
  const middle = BINS >> 1;
  assert.equal(days[0].feet[0][middle + 1], 1); // 10 ms late, left
  assert.equal(days[0].feet[1][middle + 6], 1); // 90 ms late, right
  assert.equal(days[1].feet[0][middle - 5], 1); // 80 ms early, left
  assert.equal(days.flatMap(({ feet }) => feet.flat()).reduce((a, b) => a + b), 4); // misses have no error
  assert.deepEqual(rows[1], { tries: 2, misses: 1, timed: 1, sum: 90, missed: true, rate: 0 }); // its measure was never played without a miss
  assert.deepEqual(rows[2], { tries: 2, misses: 1, timed: 1, sum: -80, missed: false, rate: 0 });
  assert.equal(hitShare(days[0]), 1 / 3);
  assert.equal(scoreShare(days[0]), 1.5 / 4); // of three notes and a wrong press
});

test("a row's last outcome says whether it is missed, and the stretch begins where all of it was passed", () => {
  const rows = Array.from({ length: 40 }, (_, row) => ({ row, beat: row }));
  const record = played(); // row 1, in measure 0, of which no pass was without a miss: what was hit in those does not count
  assert.deepEqual(missedOf(record, rows), [{ from: 0, to: 4, misses: 1, rate: 0.7, passed: false }]);
  addOutcomes(record, "2026-11-24", [0, 1, 2, 3].map((row) => outcome(row, "late", 0.06)), 0, 0.8);
  addOutcomes(record, "2026-11-24", [0, 1, 2, 3].map((row) => outcome(row, row === 1 ? "miss" : "hit")), 0, 1);
  assert.deepEqual(missedOf(record, rows), [{ from: 0, to: 4, misses: 1, rate: 0.8, passed: true }]);
  addOutcomes(record, "2026-11-24", [4, 5, 6, 24].map((row) => outcome(row, "miss")), 0, 1);
  assert.deepEqual(missedOf(record, rows), [{ from: 0, to: 8, misses: 4, rate: 0.7, passed: false }, { from: 24, to: 28, misses: 1, rate: 0.7, passed: false }]);
  addOutcomes(record, "2026-11-24", [1, 4, 5, 6, 24].map((row) => outcome(row, "hit", 0)), 0, 1);
  assert.deepEqual(missedOf(record, rows), []);
});

test("the right panel counts although it is early or late: half in the score", () => {
  const counts = { hit: 1, early: 3, late: 4, miss: 2, wrong: 0 };
  assert.deepEqual([panelShare(counts), hitShare(counts), scoreShare(counts)], [0.8, 0.1, 0.45]);
  assert.equal(scoreShare({ ...counts, wrong: 5 }), 0.3);
  assert.equal(scoreShare({ hit: 0, early: 0, late: 0, miss: 0, wrong: 0 }), 0);
});

test("a streak goes on until a day is left out, over the ends of months", () => {
  const days = ["2026-02-27", "2026-02-28", "2026-03-01", "2026-03-04"].map((day) => ({ day }));
  assert.deepEqual(streakOf(days, "2026-03-05"), { now: 1, most: 3 });
  assert.deepEqual(streakOf(days, "2026-03-06"), { now: 0, most: 3 });
  assert.deepEqual(streakOf([], "2026-03-06"), { now: 0, most: 0 });
  assert.equal(dayOf(new Date(2026, 0, 5, 23, 59)), "2026-01-05");
});

test("the best clean pass is the fastest", () => {
  const record = emptyRecord();
  for (const rate of [0.8, 0.95, 0.9]) addClean(record, "8-16", rate);
  assert.deepEqual(record.best, { "8-16": 95 });
});

test("a file comes back as it was, and taken in twice changes nothing", () => {
  const record = played();
  record.loops.push({ name: "bridge </script>", from: 4, to: 8.5, rate: 75 });
  addClean(record, "4-8.5", 0.75);
  addPlay(record, "4-8.5", 0.66, 1);
  addPlay(record, "4-8.5", 0.5, 1);
  const back = fromFile(toFile({ "song.ssc#0:12": record })).get("song.ssc#0:12");
  assert.deepEqual(back, record);
  const both = merged(emptyRecord(), back);
  assert.deepEqual(both, record);
  assert.deepEqual(merged(both, back), record);
  const mine = emptyRecord();
  addOutcomes(mine, "2026-11-22", [outcome(5, "hit", 0)], 0, 1);
  addClean(mine, "4-8.5", 0.9);
  mine.top = 81;
  const joined = merged(mine, back);
  assert.deepEqual(joined.days.map(({ day }) => day), ["2026-11-22", "2026-11-23", "2026-11-24"]);
  assert.equal(joined.top, 81);
  assert.deepEqual([80, -1, 101, "80", NaN].map((top) => validRecord({ top }).top), [80, 0, 0, 0, 0]);
  assert.equal(joined.best["4-8.5"], 90);
  assert.equal(joined.scores["4-8.5"], 66);
  assert.equal(joined.rows[5].tries, 1);
});

test("of a stranger's file only what may be is kept", () => {
  for (const text of ["", "null", "[]", "{}", '{"format":"dancetutor-practice","version":2,"charts":{}}', "{", '"x"']) assert.equal(fromFile(text), null);
  const good = { tries: 1, misses: 0, timed: 1, sum: 3, missed: false, rate: 100 };
  const feet = [new Array(BINS).fill(0), new Array(BINS).fill(0)];
  const day = { day: "2026-01-01", hit: 1, early: 0, late: 0, miss: 0, wrong: 0, feet };
  const bad = {
    days: [day, { ...day, day: "2026-99-99" }, { ...day, hit: -1 }, { ...day, hit: 1.5 }, { ...day, feet: [[1], [2]] }, { ...day, day: "<b>" }, null, 7],
    rows: { 3: good, "-1": good, x: good, 4: { ...good, rate: 1e9 }, 5: { ...good, missed: 1 }, 6: { ...good, sum: "1" }, __proto__: good },
    loops: [{ name: "a".repeat(999), from: 0, to: 4, rate: 100 }, { name: "b", from: 4, to: 4, rate: 100 }, { name: 3, from: 0, to: 4, rate: 100 },
      { name: "c", from: 0, to: 4, rate: 1 }, "x"],
    scores: { "0-4": 80, "4-8": 101, "0-<b>": 80, "8-12": -1 },
    best: { "0-4": 90, "0-4<b>": 90, "4-8": "90", "8-12": null },
    other: 1,
  };
  const kept = validRecord(JSON.parse(JSON.stringify(bad)));
  assert.deepEqual(kept.days, [day]);
  assert.deepEqual(kept.rows, { 3: good });
  assert.deepEqual(kept.loops.map(({ name }) => name.length), [60]);
  assert.deepEqual(kept.best, { "0-4": 90 });
  assert.deepEqual(kept.scores, { "0-4": 80 });
  assert.deepEqual(Object.keys(kept), ["days", "rows", "loops", "best", "scores", "plays", "top"]);
  for (const value of [null, 3, "x", [], { days: {}, rows: [], loops: 3, best: "x" }]) assert.deepEqual(validRecord(value), emptyRecord());
});

test("the coach goes by what is hit, up to the goal and never below a quarter", () => {
  const next = [1, 0.9, 0.75, 0.6, 0.2].map((share) => coachRate(0.7, share, 1));
  assert.deepEqual(next, [0.8, 0.75, 0.7, 0.65, 0.6]);
  assert.equal(coachRate(0.95, 1, 1), 1);
  assert.equal(coachRate(0.25, 0, 1), 0.25);
});

test("narrow measures of the strip are drawn together, as high as the highest", () => {
  const density = Array.from({ length: 10 }, (_, k) => ({ start: k, end: k + 1, rate: k % 4 }));
  assert.equal(together(density, 1), density);
  assert.deepEqual(together(density, 4), [{ start: 0, end: 4, rate: 3 }, { start: 4, end: 8, rate: 3 }, { start: 8, end: 10, rate: 1 }]);
});

test("where rows lie closer than a few pixels, the strip draws their mean facing, and only what is in sight", () => {
  const rows = Array.from({ length: 100 }, (_, k) => ({ second: k / 10, facing: k % 2 ? 90 : -90 }));
  const some = thinned(rows, { from: 2, to: 4 }, 1);
  assert.ok(some.length >= 3 && some.length <= 5);
  assert.ok(some.slice(0, -1).every(({ facing }) => Math.abs(facing) <= 10)); // the last one may be of a row alone
  assert.equal(thinned(rows, { from: 2, to: 4 }, 0.05).length, 21);
});

test("a long stretch of misses is practised in parts of four measures", () => {
  const rows = Array.from({ length: 40 }, (_, row) => ({ row, beat: row }));
  const record = emptyRecord();
  addOutcomes(record, "2026-11-24", rows.map(({ row }) => outcome(row, "miss")), 0, 1);
  assert.deepEqual(missedOf(record, rows).map(({ from, to }) => [from, to]), [[0, 16], [16, 32], [32, 40]]);
});

test("misses through the song are counted by foot, in parts of as many measures each", () => {
  const rows = Array.from({ length: 24 }, (_, row) => ({ row, beat: row, steps: [{ limb: row % 2 }] }));
  const record = emptyRecord();
  addOutcomes(record, "2026-11-24", [0, 1, 2, 3, 9, 23].map((row) => outcome(row, row % 2 ? "miss" : "hit", 0)), 0, 1);
  assert.deepEqual(missesThrough(record, rows), [[0, 100], [0, 0], [0, 100], [0, 0], [0, 0], [0, 100]]);
  addOutcomes(record, "2026-11-25", [outcome(1, "hit", 0)], 0, 1); // one of two tries: of the first part's rows 2 of 3
  assert.deepEqual(missesThrough(record, rows, 3), [[0, 67], [0, 100], [0, 100]]);
});

test("the best pass of a part is kept at whatever speed it was, and a pass at full speed is told", () => {
  const record = emptyRecord();
  addPlay(record, "4-8", 0.72, 0.55);
  assert.deepEqual([record.plays["4-8"], record.scores["4-8"], passedFull(record, "4-8")], [[72, 55], undefined, false]);
  addPlay(record, "4-8", 0.9, 0.4); // slower: less was done
  assert.deepEqual(record.plays["4-8"], [72, 55]);
  addPlay(record, "4-8", 0.55, 0.72); // as much, but quicker
  assert.deepEqual(record.plays["4-8"], [55, 72]);
  addPlay(record, "4-8", 0.94, 1);
  assert.equal(passedFull(record, "4-8"), false);
  addPlay(record, "4-8", 0.95, 1);
  assert.deepEqual([record.plays["4-8"], passedFull(record, "4-8")], [[95, 100], true]);
  addClean(record, "8-12", 1);
  assert.equal(passedFull(record, "8-12"), true);
  const back = fromFile(toFile({ a: record })).get("a");
  assert.deepEqual(back, record);
  const mine = emptyRecord();
  addPlay(mine, "4-8", 0.9, 1);
  assert.deepEqual(merged(mine, back).plays["4-8"], [95, 100]);
  const old = validRecord({ ...emptyRecord(), scores: { "4-8": 80 }, plays: { "8-12": [80, "x"], "x": [1, 50], "0-4": [101, 50] } });
  assert.deepEqual(old.plays, { "4-8": [80, 100] }); // of a page that kept no speeds
});
