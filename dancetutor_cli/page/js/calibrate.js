// Measuring delays by ear and by eye: tap to ticks, or to a light; each tap stands on a scale, with the figure that comes out.

import { el } from "./dom.js";
import { clamp } from "./maths.js";

const BEATS = 12;
const BETWEEN = 0.6; // seconds between them
const BEFORE = 1.2; // seconds until the first
const LIT = 120; // milliseconds that the light is on
const WIDE = 0.25; // seconds around a beat within which a tap is one to it
const SURE = 0.03; // seconds: taps that spread wider tell no delay
const FEWEST = 4; // taps that say something

/**
 * How late taps come after beats: each tap, the middle one, and half the range of the middle half.
 * @param {number[]} taps @param {number[]} beats seconds @returns {{errors: number[], middle: number, spread: number} | null} null: too few
 */
export function delayOf(taps, beats) {
  const errors = [];
  for (const tap of taps) {
    const nearest = beats.reduce((best, beat) => (Math.abs(beat - tap) < Math.abs(best - tap) ? beat : best), Infinity);
    if (Math.abs(tap - nearest) < WIDE) errors.push(tap - nearest);
  }
  if (errors.length < FEWEST) return null;
  const order = [...errors].sort((a, b) => a - b);
  const at = (/** @type {number} */ share) => order[Math.floor(share * (order.length - 1))];
  return { errors, middle: order[order.length >> 1], spread: (at(0.75) - at(0.25)) / 2 };
}

/** @param {import("./app.js").App} app */
export function calibrateDialog(app) {
  const { t, sound, settings } = app;
  app.transport.pause();
  const text = el("p", { role: "status", class: "calibrated" }, t("calibrateIntro"));
  const light = el("div", { class: "light", "aria-hidden": "true" });
  const scale = el("div", { class: "scale", role: "img", "aria-label": t("calibrateScale") });
  const tap = el("button", { type: "button", class: "tap", disabled: true }, t("calibrateTap"));
  const ends = el(
    "p",
    { class: "ends", "aria-hidden": "true" },
    el("span", {}, t("calibrateEarly")),
    el("span", {}, "0"),
    el("span", {}, t("calibrateLate")),
  );
  const figures = el("p", { class: "hint" });
  const apply = el("button", { type: "button", id: "calibrate-apply", class: "main" }, t("calibrateApply"));
  const keep = el("button", { type: "button", id: "calibrate-keep" }, t("calibrateKeep"));
  const choice = el("p", { class: "group choice", hidden: true }, apply, keep);
  const ear = el("button", { type: "button", id: "by-ear", onclick: () => void begin("latency") }, t("byEar"));
  const eye = el("button", { type: "button", id: "by-eye", onclick: () => void begin("sight") }, t("byEye"));
  const dialog = el(
    "dialog",
    { class: "assign calibrate", "aria-label": t("calibrate") },
    el("h2", {}, t("calibrate")),
    text,
    el("p", { class: "group" }, ear, eye),
    light,
    tap,
    scale,
    ends,
    choice,
    figures,
    el("button", { type: "button", onclick: () => dialog.close() }, t("close")),
  );
  const show = () => {
    figures.textContent = t("calibrateNow", { ear: Math.round(1000 * settings.latency), eye: Math.round(1000 * settings.sight) });
  };
  /** @type {number[]} */
  let taps = [];
  /** @type {number[]} when each beat was to be heard, or was seen, seconds */
  let beats = [];
  /** @type {() => number} */
  let now = () => sound.now();
  let round = 0; // whoever begins anew ends what went on

  /** @param {"latency" | "sight"} what */
  async function begin(what) {
    const mine = ++round;
    [taps, beats] = [[], []];
    choice.hidden = true;
    scale.replaceChildren();
    if (what === "latency") await sound.start();
    if (mine !== round) return;
    const late = sound.latency;
    now = what === "latency" ? () => sound.now() - late : () => performance.now() / 1000;
    const first = now() + late * Number(what === "latency") + BEFORE;
    const due = Array.from({ length: BEATS }, (_, k) => first + k * BETWEEN);
    if (what === "latency") {
      beats = due;
      for (const beat of due) sound.click(1600, 0.5, beat);
    }
    app.input.learning = (name) => {
      if (name === "Escape") return dialog.close();
      take();
    };
    tap.disabled = false;
    text.textContent = t(what === "latency" ? "calibrateHint" : "calibrateSee");
    const frame = () => {
      if (mine !== round) return;
      const at = what === "latency" ? sound.now() : performance.now() / 1000;
      if (what === "sight") {
        if (beats.length < BEATS && at >= due[beats.length]) beats.push(at); // as it is drawn, not as it was due
        light.classList.toggle("lit", beats.length > 0 && at - beats[beats.length - 1] < LIT / 1000);
      }
      if (at > due[BEATS - 1] + WIDE + late) finish(what);
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  function take() {
    taps.push(now());
    const nearest = delayOf(new Array(FEWEST).fill(taps[taps.length - 1]), beats);
    if (nearest) mark(nearest.middle, "dot");
  }

  /** @param {number} error seconds @param {string} kind */
  function mark(error, kind) {
    const one = el("span", { class: kind });
    one.style.left = `${clamp(50 + (50 * error) / WIDE, 0, 100)}%`;
    scale.append(one);
  }

  /** @param {"latency" | "sight"} what */
  function finish(what) {
    ++round;
    app.input.learning = null;
    tap.disabled = true;
    light.classList.remove("lit");
    const found = delayOf(taps, beats);
    if (!found) return void (text.textContent = t("calibrateFew"));
    const [ms, spread] = [Math.round(1000 * found.middle), Math.round(1000 * found.spread)];
    if (found.spread > SURE) return void (text.textContent = t("calibrateWide", { spread, most: 1000 * SURE }));
    mark(found.middle, "middle");
    // By eye a tap is late by the same hand, and by the screen: what is more than by ear is the screen's.
    const more = Math.round(1000 * (what === "latency" ? found.middle : found.middle - settings.latency));
    const after = what === "latency" ? "calibrateDone" : "calibrateSeen";
    const before = what === "latency" ? "calibrateDoneBefore" : "calibrateSeenBefore";
    const name = ms < 0 ? before : after;
    text.textContent = t(name, { ms: Math.abs(ms), spread, taps: found.errors.length, more });
    choice.hidden = false;
    const chosen = (/** @type {boolean} */ taken) => {
      if (taken) app.set(what, more / 1000);
      choice.hidden = true;
      text.textContent = t(taken ? "calibrateTaken" : "calibrateKept");
      show();
    };
    apply.onclick = () => chosen(true);
    keep.onclick = () => chosen(false);
  }

  tap.addEventListener("pointerdown", (event) => { event.preventDefault(); take(); });
  dialog.addEventListener("close", () => { ++round; app.input.learning = null; sound.follow(null); dialog.remove(); });
  show();
  document.body.append(dialog);
  dialog.showModal();
}
