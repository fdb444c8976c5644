// Presses, misses, wrong panels, rows that wait, delays, the ramp; and links.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { passedAlpha, scrollSpeed } from "../../../dancetutor_cli/page/js/highway.js";
import { widestGap } from "../../../dancetutor_cli/page/js/highway.js";
import { findingFigures, labelsOf, moveNames } from "../../../dancetutor_cli/page/js/labels.js";
import { unexplained } from "../../../dancetutor_cli/page/js/gutter.js";
import { fillIn } from "../../../dancetutor_cli/page/js/words.js";
import { delayOf } from "../../../dancetutor_cli/page/js/calibrate.js";
import { Judge, ramp } from "../../../dancetutor_cli/page/js/judge.js";
import { makeLink, parseLink, stretch } from "../../../dancetutor_cli/page/js/places.js";

/** A page's labels as document.py makes them of a language's file, whose values are JSON strings. @param {string} name */
function wordsOf(name) {
  const prefixes = { page: "", panels: "panel-", findings: "finding-" };
  const words = {};
  let prefix;
  for (const line of readFileSync(new URL(`../../../configs/languages/${name}.yaml`, import.meta.url), "utf8").split("\n")) {
    const [, section, key, value] = line.match(/^(\w+):$|^ {2}([\w-]+): (".*")$/) ?? [];
    if (section) prefix = prefixes[section];
    else if (key && prefix !== undefined) words[prefix + key] = JSON.parse(value);
  }
  return words;
}

/** Rows at seconds 1, 2 (a jump), 3. */
function chart() {
  const second = [1, 2, 2, 3];
  const column = [0, 0, 3, 1];
  const rows = [[0], [1, 2], [3]].map((notes, row) => ({
    row, second: second[notes[0]], steps: notes.map((note) => ({ note, column: column[note], limb: note % 2, part: 0 })),
  }));
  return {
    second, end: second, given: new Map(), rows, rowSeconds: rows.map((row) => row.second),
    presses: [0, 1, 2, 3].map((c) => second.map((_, n) => n).filter((n) => column[n] === c)),
  };
}

test("presses near a note count once, early, in time or late", () => {
  const judge = new Judge(chart());
  judge.restart(0);
  assert.equal(judge.press(0, 0.91, 1), "early");
  assert.equal(judge.press(0, 1.0, 1), null);
  assert.equal(judge.press(0, 2.02, 1), "hit");
  assert.equal(judge.press(3, 2.1, 1), "late");
  assert.equal(judge.press(1, 2.5, 1), "wrong");
  assert.equal(judge.advance(4, 1), 1);
  const tally = judge.tally(0, 10);
  assert.deepEqual([tally.hit, tally.early, tally.late, tally.miss, tally.wrong], [1, 1, 1, 1, 1]);
  assert.ok(Math.abs(tally.sum - (-0.09 + 0.02 + 0.1)) < 1e-9);
});

test("the window is of real time: half as wide in the music at half speed", () => {
  const judge = new Judge(chart());
  judge.restart(0);
  assert.equal(judge.press(0, 1.1, 0.5), "wrong");
  assert.equal(judge.press(0, 1.05, 0.5), "late");
});

test("a panel that nothing asks for is wrong; one pressed again, held, or before the beginning is not", () => {
  const judge = new Judge({ ...chart(), end: [1, 2, 2, 4] });
  judge.restart(1);
  assert.equal(judge.press(1, 0.5, 1), null);
  assert.equal(judge.press(0, 1, 1), "hit");
  assert.equal(judge.press(0, 1.1, 1), null);
  assert.equal(judge.press(2, 1, 1, true), "wrong");
  assert.equal(judge.press(1, 3.6, 1), null);
  assert.equal(judge.press(1, 4.3, 1), "wrong");
  assert.equal(judge.tally(0, 4).wrong, 1);
  assert.equal(judge.tally(0, 9).wrong, 2);
  judge.restart(2);
  assert.equal(judge.tally(0, 9).wrong, 1);
});

test("a row that waits is open until all its panels are pressed", () => {
  const judge = new Judge(chart());
  judge.restart(1.5);
  assert.equal(judge.nextOpenRow(-Infinity).second, 2);
  judge.press(3, 2, 1, true);
  assert.equal(judge.nextOpenRow(-Infinity).second, 2);
  judge.press(0, 2, 1, true);
  assert.equal(judge.nextOpenRow(-Infinity).second, 3);
  judge.press(1, 3, 1, true);
  assert.equal(judge.nextOpenRow(-Infinity), null);
});

test("while the clock waits for a row, the panel of the next one is wrong, however near it is", () => {
  const judge = new Judge({ ...chart(), second: [1, 2, 1.1, 3], end: [1, 2, 1.1, 3] });
  judge.restart(0);
  assert.equal(judge.press(3, 1, 1, true), "wrong");
  assert.equal(judge.press(0, 1, 1, true), "hit");
  assert.equal(judge.tally(0, 4).wrong, 1);
});

test("going back opens rows again", () => {
  const judge = new Judge(chart());
  judge.restart(0);
  judge.advance(9, 1);
  assert.equal(judge.tally(0, 9).miss, 4);
  judge.restart(1.5);
  assert.equal(judge.tally(0, 9).miss, 1);
});

test("the delay is the middle of all taps; strays do not count, too few are none", () => {
  const beats = [1, 2, 3, 4, 5, 6];
  assert.equal(delayOf([1.05, 2.06, 3.04], beats), null);
  const { middle, spread, errors } = delayOf([1.05, 2.06, 3.05, 4.05, 5.24, 6.49], beats);
  assert.ok(Math.abs(middle - 0.05) < 1e-9 && spread > 0.004 && spread < 0.1);
  assert.equal(errors.length, 5); // the last one came to no beat
});

test("the ramp goes up after clean passes, back after misses, and ends at full speed", () => {
  assert.equal(ramp(0.5, 0, true), 0.55);
  assert.equal(ramp(0.5, 3, true), 0.45);
  assert.equal(ramp(0.25, 3, true), 0.25);
  assert.equal(ramp(1, 0, true), 1);
  assert.equal(ramp(0.5, 9, false), 0.55);
});

test("links say measures and speed", () => {
  assert.deepEqual(parseLink("#m8-16@0.75"), { from: 8, to: 17, rate: 0.75, backwards: false }); // 16 is part of it
  assert.deepEqual(parseLink("#m8-8"), { from: 8, to: 9, rate: null, backwards: false });
  assert.deepEqual(parseLink("#m8-16.5"), { from: 8, to: 16.5, rate: null, backwards: false });
  assert.deepEqual(parseLink("#m8"), { from: 8, to: null, rate: null, backwards: false });
  assert.deepEqual(parseLink("#@1.5"), { from: null, to: null, rate: 1.5, backwards: false });
  assert.deepEqual(parseLink("#m9-3"), { from: 9, to: null, rate: null, backwards: true });
  for (const bad of ["", "#", "#m", "#x8", "#m8-16@fast", "#m8<script>"]) assert.equal(parseLink(bad), null);
  assert.equal(makeLink(8, 17, 0.75), "#m8-16@0.75");
  assert.equal(makeLink(8, 16.333, 1), "#m8-16.33");
  assert.equal(makeLink(null, null, 1), "");
});

test("a stretch has one name everywhere: whole measures are part of it, a fraction is a point", () => {
  const t = (name, values) => `${name} ${Object.values(values).join(" ")}`;
  assert.equal(stretch(t, 7, 11), "measures 7 10");
  assert.equal(stretch(t, 7, 8), "oneMeasure 7");
  assert.equal(stretch(t, 7.5, 8.25), "fromTo measureAt 7 30 measureAt 8 32"); // the last beat is part of it as well
  assert.equal(stretch(t, 0.33, 1.2), "points 0.33 1.2");
  for (const [from, to] of [[7, 11], [7, 8], [7.5, 8], [0, 0.25]]) {
    const link = parseLink(makeLink(from, to, 1));
    assert.deepEqual([link.from, link.to], [from, to]);
  }
});

test("quick charts have their rows farther apart, so that notes do not lie over one another", () => {
  const rows = (gap) => Array.from({ length: 50 }, (_, k) => gap * k);
  assert.equal(scrollSpeed(rows(0.5)), 0.42);
  const quick = scrollSpeed(rows(1 / 12)); // sixteenths at 180 BPM
  assert.ok(quick / 12 > 0.08 && quick < 1.1, String(quick));
  assert.equal(scrollSpeed(rows(1 / 30)), 1.2);
  assert.equal(scrollSpeed([]), 0.42);
});

test("a note is whole until it is by the receptors, and gone before the verdict's place", () => {
  assert.deepEqual([-100, 0, 10, 30, 31].map((above) => passedAlpha(above, 40)), [1, 1, 1, 0, 0]);
  assert.equal(passedAlpha(20, 40), 0.5);
});

test("a row's moves are named in a dancer's words, each once", () => {
  const named = (file, ...names) => {
    const words = wordsOf(file);
    return moveNames((name) => words[name] ?? name, names);
  };
  assert.equal(named("en", "crossover-front", "crossover-half"), "crossover in front");
  assert.equal(named("en", "crossover-half", "candle", "stream"), "crossover, long step, long run");
  assert.equal(named("en", "footswitch-up", "footswitch-down"), "footswitch (swap feet)");
  assert.equal(named("de", "crossover-back", "crossover-half", "jack"), "Überkreuzen hinten, Jack (noch einmal dasselbe Feld)");
});

test("words beside the notes have short forms for narrow lanes", () => {
  const doc = { style: { callouts: { spin: "spin", doublestep: "doublestep" } }, findings: [{ rule: "DT213", name: "unsure-feet", severity: "info", second: 2, column: 0 }] };
  const rows = [{ second: 1, moves: ["doublestep", "spin"], steps: [{ column: 2 }] }, { second: 1.5, moves: ["spin"], steps: [] }];
  for (const file of ["en", "de", "es", "ja", "ko"]) {
    const words = wordsOf(file);
    const labels = labelsOf(doc, { rows }, (name, values = {}) => fillIn(words[name] ?? name, values, words.decimal));
    assert.deepEqual(labels.map((one) => one.short), [words["short-doublestep"], words["short-DT213"]]);
    assert.deepEqual(labels.map((one) => one.columns), [[2], [0]]);
    assert.ok(labels[0].text.length > labels[0].short.length && labels[0].short.length <= 6);
    for (const [name, word] of Object.entries(words)) if (name.startsWith("short-")) assert.ok(word.length <= 6, name);
  }
  assert.deepEqual([0, 1, 2].map((count) => fillIn("{count} {count|press|presses}", { count })), ["0 presses", "1 press", "2 presses"]);
  assert.equal(fillIn("{a} {b}", { a: 2.5, b: "2.5" }, ","), "2,5 2.5"); // numbers only, no names
});

test("where what explains a move has no room, its name stands alone", () => {
  assert.equal(unexplained("half turn (back to the screen), footswitch (swap feet)"), "half turn, footswitch");
  assert.equal(unexplained("ブラケット (片足で2枚)"), "ブラケット");
});

test("one other row is singular", () => {
  const said = (file, label, rows) => fillIn(wordsOf(file)[label], { rows, where: "x", word: "x", extra: 1 });
  assert.equal(said("en", "secondRows", 1), "other feet in 1 row: x");
  assert.match(said("en", "costRows", 1), /feet of 1 other row\.$/);
  assert.match(said("en", "givenRows", 2), /and 2 other rows get other feet\.$/);
  assert.match(said("de", "costRows", 1), /1 weitere Reihe bekommt andere Füße\.$/);
  assert.match(said("es", "givenRows", 1), /de 1 fila más\.$/);
});

test("words lie where most lanes are free beside the notes of their row", () => {
  assert.deepEqual(widestGap([150], 50, 400), [200, 400]); // of four lanes the second is taken
  assert.deepEqual(widestGap([250], 50, 400), [0, 200]);
  assert.deepEqual(widestGap([350, 50], 50, 400), [100, 300]); // between left and right
  assert.deepEqual(widestGap([150, 250], 50, 400), [300, 400]); // as much on both sides
});

test("the figures of a finding are shown in another language too", () => {
  const words = wordsOf("de");
  const t = (name, values = {}) => fillIn(words[name] ?? name, values, words.decimal);
  const figures = (message) => findingFigures(t, { message });
  assert.equal(figures("2 rows from beat 49 to 49.5; the solver is only 50 % sure of beat 49"), "(50 % sicher)");
  assert.equal(figures("the solver is only 55 % sure of this row"), "(55 % sicher)");
  assert.equal(figures("the left foot has to travel 1.5 panel widths in 120 ms"), "(1,5 Felder in 120 ms)");
  assert.equal(figures("the chart lasts 95.3 s, not 100 to 150 s"), "(95,3 s statt 100 bis 150 s)");
  assert.equal(figures("8 rows 45 ms apart: too quick for feet"), "(8 Reihen, 45 ms auseinander)");
  assert.equal(figures("this row comes 12 ms after the row before: were they meant as one?"), "(12 ms nach der Reihe davor)");
  const dense = { "120 ms before the next step": "120 ms vor dem nächsten Schritt", "95 ms after the step before": "95 ms nach dem Schritt davor" };
  for (const [english, german] of Object.entries(dense)) {
    assert.equal(figures(`three panels, ${english}`), `(3 Felder, ${german})`);
    assert.equal(figures(`5 panels in the middle of 16ths, ${english}`), `(5 Felder inmitten von 16teln, ${german})`);
  }
  assert.equal(figures("two panels, then one, then two in 16ths, 110 ms apart"), "(2, 1 und 2 Felder in 16teln, 110 ms auseinander)");
  assert.equal(figures("something else"), "");
  assert.equal(figures("the body turns by 180 degrees"), "");
});

test("of one foot the other's notes are neither asked for, missed nor wrong", () => {
  const judge = new Judge(chart()); // left steps 0 and 2, right 1 and 3
  judge.foot = 0;
  judge.restart(0);
  assert.equal(judge.press(0, 1.01, 1), "hit");
  assert.equal(judge.press(0, 2.0, 1), null); // the right foot's: played for you
  assert.equal(judge.press(3, 2.0, 1), "hit");
  assert.equal(judge.advance(9, 1), 0);
  assert.equal(judge.nextOpenRow(0), null);
  const { outcomes, wrong } = judge.takeOutcomes();
  assert.deepEqual(outcomes.map(({ row, limb, verdict }) => [row, limb, verdict]), [[0, 0, "hit"], [1, 0, "hit"]]);
  assert.equal(wrong, 0);
  assert.deepEqual(judge.takeOutcomes(), { outcomes: [], wrong: 0 });
  judge.chart.given.set(3, 0); // the author gave the last note to the left foot
  judge.restart(0);
  assert.equal(judge.press(1, 3.0, 1), "hit");
});
