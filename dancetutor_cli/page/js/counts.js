// How it went, for the eye: the score in a colour, a line parted as it counts, and each count with its word.

import { el } from "./dom.js";
import { COLOURS } from "./noteart.js";
import { scoreShare } from "./record.js";
import { KINDS, sharesText } from "./status_text.js";

const GOOD = 0.9; // a score that is good
export const FAIR = 0.7; // and one below which the missed rows are worth more than another try

/** Each count that is not 0 in its colour, with its word. @param {import("./app.js").App} app */
function countsRow({ t }) {
  const numbers = KINDS.map(() => el("b", {}, "0"));
  const each = KINDS.map((name, k) => {
    numbers[k].style.color = COLOURS[name];
    return el("span", {}, numbers[k], ` ${t(`verdict-${name}`)}`);
  });
  const row = el("p", { class: "counts" }, ...each);
  const show = (/** @type {import("./record.js").Counts} */ counts) => KINDS.forEach((name, k) => {
    numbers[k].textContent = String(counts[name]);
    each[k].hidden = counts[name] === 0;
  });
  return { row, show };
}

/** A line that is parted as the score counts: notes by their verdicts, and wrong presses. */
function countsBar() {
  const parts = KINDS.map((name) => {
    const part = el("span", { class: name });
    part.style.background = COLOURS[name];
    return part;
  });
  const bar = el("div", { class: "parts", "aria-hidden": "true" }, ...parts);
  const show = (/** @type {import("./record.js").Counts} */ counts) =>
    parts.forEach((part, k) => {
      part.style.flexGrow = String(counts[KINDS[k]]);
    });
  return { bar, show };
}

/**
 * The score in a colour by how good it is; "–" where nothing was played.
 * @param {HTMLElement} element @param {import("./record.js").Counts} counts
 */
export function showShare(element, counts) {
  const share = scoreShare(counts);
  const any = share || counts.miss || counts.wrong;
  element.textContent = any ? `${Math.round(100 * share)} %` : "–";
  element.style.color = any ? COLOURS[share >= GOOD ? "hit" : share >= FAIR ? "early" : "miss"] : "";
}

/** Number, line, shares and counts, to be placed, and what fills them in. @param {import("./app.js").App} app */
export function countsOf(app) {
  const share = el("strong", {}, "");
  const shares = el("p", { class: "shares" }, "");
  const { row, show } = countsRow(app);
  const line = countsBar();
  return {
    share, shares, row, bar: line.bar,
    show: (/** @type {import("./record.js").Counts} */ counts) => {
      showShare(share, counts);
      shares.textContent = scoreShare(counts) || counts.miss ? sharesText(app, counts) : "";
      line.show(counts);
      show(counts);
    },
  };
}
