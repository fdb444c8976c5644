// The page of a capture: input beside output, play, seek, slow motion, and how far each point is from the input.

import { unpack } from "./blob.js";
import { CaptureView, colourOf, pointDistances } from "./capture_view.js";
import { Transport } from "./clock.js";
import { el, toggle } from "./dom.js";
import { showStartError } from "./start_error.js";
import { meshData } from "./gl.js";
import { Motion } from "./motion.js";
import { decodeSkins } from "./picture.js";
import { speak } from "./words.js";

const RATES = [0.25, 0.5, 1];
const FRAME = 1 / 30; // seconds of a step
const TURN = 15; // degrees of a key
const ZOOM = 1.25;
const SIDES = /** @type {const} */ ([["camera-front", 0], ["captureSide", 90], ["camera-back", 180]]);

/** @typedef {{rate: number, keys: number, start: number, end: number, step: number}} Clock of the tracks */
/**
 * @typedef {object} CaptureDoc
 * @property {string} language
 * @property {{title: string}} words
 * @property {{panels: [number, number][], width: number}} pad
 * @property {import("./doc.js").Look} look
 * @property {import("./doc.js").Stage} stage
 * @property {import("./doc.js").Body} body
 * @property {import("./doc.js").MotionDoc[]} motions
 * @property {Clock} clock
 * @property {number[]} parents of the capture's joints
 * @property {string[]} points
 * @property {number} far centimetres from which a distance is as red as it gets
 * @property {{focal: number, height: number}} camera
 * @property {Record<string, Record<string, string>>} languages
 * @property {Record<string, string>} shaders
 */

async function main() {
  const { doc: raw, arrays } = await unpack(document.getElementById("data")?.textContent ?? "");
  const doc = /** @type {CaptureDoc} */ (/** @type {unknown} */ (raw));
  const { language, t } = speak(doc.languages, doc.language);
  document.documentElement.lang = language;
  const skins = decodeSkins(raw, arrays);
  const { start, end } = doc.clock;
  const transport = new Transport(() => performance.now() / 1000, start, end);
  const place = el("section", { class: "picture", tabindex: 0, role: "application", "aria-label": t("capturePicture") });
  const view = new CaptureView(place, doc, arrays, new Motion(doc.motions[0], arrays, doc.body));
  const distance = farthest(view, doc.clock);
  const number = (/** @type {number} */ value) => value.toFixed(1).replace(".", t("decimal"));

  const act = {
    play: () => (transport.playing ? transport.pause() : transport.play()),
    step: (/** @type {number} */ by) => { transport.pause(); transport.seek(transport.second() + by * FRAME); },
    go: (/** @type {number} */ second) => { transport.pause(); transport.seek(second); },
    distances: () => distances.click(),
  };
  const play = el(
    "button",
    { type: "button", class: "play", "aria-label": t("playPause"), title: t("playPause"), onclick: act.play },
    "▶",
  );
  const seek = el("input", {
    type: "range",
    class: "strip",
    min: start,
    max: end,
    step: FRAME,
    value: start,
    "aria-label": t("capturePosition"),
  });
  seek.addEventListener("input", () => transport.seek(Number(seek.value)));
  const rate = el(
    "select",
    { class: "rate", "aria-label": t("captureSpeed") },
    ...RATES.map((one) => el("option", { value: one, selected: one === 1 }, t("captureRate", { rate: one }))),
  );
  rate.addEventListener("change", () => transport.setRate(Number(rate.value)));
  const distances = toggle(t("captureDistances"), true, (on) => {
    view.distances = on;
  });
  const cameras = SIDES.map(([label, yaw]) =>
    el(
      "button",
      {
        type: "button",
        onclick: () => {
          view.yaw = yaw;
          view.pitch = 8;
          view.zoom = 1;
        },
      },
      t(label),
    ),
  );
  const sign = (/** @type {string} */ text, /** @type {string} */ label, /** @type {() => void} */ press) =>
    el("button", { type: "button", class: "sign", "aria-label": t(label), title: t(label), onclick: press }, text);
  const clock = el("output", { class: "clock" });
  const summary = el("p", { class: "caption output" });
  const rows = doc.points.map((name, k) => {
    const cell = el("td");
    const most = el(
      "button",
      { type: "button", class: "link", title: t("captureGo"), onclick: () => act.go(distance.when[k]) },
      number(distance.most[k]),
    );
    return {
      cell,
      row: el("tr", {}, el("th", { scope: "row" }, name), cell, el("td", {}, number(distance.mean[k])), el("td", {}, most)),
    };
  });
  const head = ["capturePoint", "captureNow", "captureMean", "captureMost"].map((label) => el("th", { scope: "col" }, t(label)));
  const table = el(
    "table",
    {},
    el("caption", {}, t("captureTable")),
    el("thead", {}, el("tr", {}, ...head)),
    el("tbody", {}, ...rows.map((one) => one.row)),
  );
  place.append(el("p", { class: "caption input" }, t("captureInput")), summary);
  document.getElementById("app")?.replaceChildren(
    el("header", {}, el("h1", {}, doc.words.title)),
    el("main", {}, place, el("section", { class: "side", tabindex: 0, "aria-label": t("captureTable") }, table)),
    el("footer", {}, el("div", { class: "bar" }, play, seek, clock), el("div", { class: "bar" }, rate,
      sign("◂", "captureBack", () => act.step(-1)), sign("▸", "captureNext", () => act.step(1)), distances, ...cameras,
      sign("−", "captureFarther", () => view.nearer(1 / ZOOM)), sign("+", "captureNearer", () => view.nearer(ZOOM))),
    el("p", { class: "hint" }, t("captureKeys"))));
  listen(place, view, act);
  view.start(meshData(doc.body, arrays), await skins);
  const frame = () => {
    transport.tick();
    const second = transport.second();
    const far = view.draw(second);
    const worst = far.indexOf(Math.max(...far));
    place.classList.toggle("stacked", view.canvas.width < 0.9 * view.canvas.height);
    play.textContent = transport.playing ? "❚❚" : "▶";
    if (document.activeElement !== seek || transport.playing) seek.value = String(second);
    clock.textContent = t("captureClock", { second: (second - start).toFixed(2), end: (end - start).toFixed(2) });
    summary.textContent = t("captureSaid", {
      point: doc.points[worst],
      far: number(far[worst]),
      mean: number(far.reduce((sum, one) => sum + one, 0) / far.length),
    });
    rows.forEach(({ cell }, k) => {
      cell.textContent = number(far[k]);
      cell.style.setProperty("--far", colourOf(far[k], doc.far));
    });
    requestAnimationFrame(frame);
  };
  frame();
  document.documentElement.dataset.ready = performance.now().toFixed(0);
}

/**
 * Of each point its mean and largest distance in centimetres, and when that is.
 * @param {CaptureView} view @param {Clock} clock
 */
function farthest(view, clock) {
  const count = view.before.keys;
  const points = view.before.rows / 3;
  const [mean, most, when] = [0, 0, clock.start].map((value) => new Array(points).fill(value));
  for (let key = 0; key < count; ++key) {
    const second = clock.start + key / clock.rate;
    pointDistances(view.before.at(second), view.after.at(second)).forEach((far, k) => {
      mean[k] += far / count;
      if (far > most[k]) [most[k], when[k]] = [far, second];
    });
  }
  return { mean, most, when };
}

/**
 * Keys, and fingers on the picture.
 * @param {HTMLElement} place @param {CaptureView} view
 * @param {{play: () => void, step: (by: number) => void, distances: () => void}} act
 */
function listen(place, view, act) {
  document.addEventListener("keydown", (event) => {
    const target = /** @type {HTMLElement} */ (event.target);
    if (
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      /^(SELECT|INPUT)$/.test(target.tagName) ||
      (event.key === " " && target.tagName === "BUTTON")
    )
      return;
    const by = /** @type {Record<string, () => void>} */ ({
      " ": act.play,
      ",": () => act.step(-1),
      ".": () => act.step(1),
      d: act.distances,
      ArrowLeft: () => view.turn(-TURN, 0),
      ArrowRight: () => view.turn(TURN, 0),
      ArrowUp: () => view.turn(0, TURN),
      ArrowDown: () => view.turn(0, -TURN),
      "+": () => view.nearer(ZOOM),
      "-": () => view.nearer(1 / ZOOM),
    })[event.key];
    if (!by || (event.key.startsWith("Arrow") && target !== place && target !== document.body && target.tagName !== "BUTTON")) return;
    event.preventDefault();
    by();
  });
  /** @type {Map<number, {x: number, y: number}>} */
  const fingers = new Map();
  const span = () => {
    const [a, b] = [...fingers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  place.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    place.setPointerCapture(event.pointerId);
  });
  place.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    const before = span();
    const [dx, dy] = [event.clientX - finger.x, event.clientY - finger.y];
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (before > 0) view.nearer(span() / before);
    else view.turn(-0.4 * dx, 0.3 * dy);
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"]))
    place.addEventListener(name, (event) => fingers.delete(event.pointerId));
  place.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      view.nearer(Math.exp(-event.deltaY / 800));
    },
    { passive: false },
  );
}

main().catch((error) => {
  if (!document.documentElement.dataset.ready) showStartError(error);
  console.error(error);
});
