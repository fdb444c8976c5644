// Deep links: #m8-16@0.75 is measures 8 to 16 in a loop at three quarters of the speed; #m8 only goes there.

import { endOf, named, short } from "./places.js";

/** @typedef {{from: number | null, to: number | null, rate: number | null}} Link measures; to: where the loop ends */

const MEASURE = "(\\d+(?:\\.\\d+)?)";
const LINK = new RegExp(`^#?(?:m${MEASURE}(?:-${MEASURE})?)?(?:@${MEASURE})?$`);

/** @param {string} hash @returns {Link | null} */
export function parseLink(hash) {
  const found = LINK.exec(hash);
  if (!found || !(found[1] || found[3])) return null;
  const [from, rate] = [found[1], found[3]].map((text) => (text === undefined ? null : Number(text)));
  const to = found[2] === undefined ? null : endOf(found[2]);
  if (from !== null && to !== null && to <= from) return { from, to: null, rate };
  return { from, to, rate };
}

/** @param {number | null} from @param {number | null} to measures; where the loop ends @param {number} rate */
export function makeLink(from, to, rate) {
  const place = from === null ? "" : to === null ? `m${short(from)}` : `m${named(from, to).join("-")}`;
  return place || rate !== 1 ? `#${place}${rate === 1 ? "" : `@${short(rate)}`}` : "";
}

/** The address says what is looped, and how fast. @param {import("./app.js").App} app */
export function writeLink(app) {
  const { loop } = app.transport;
  const measure = (/** @type {number} */ second) => app.chart.beatAt(second) / 4;
  const link = makeLink(loop && measure(loop.a), loop && measure(loop.b), app.practice.chosenRate);
  try {
    history.replaceState(null, "", link || location.pathname + location.search);
  } catch {
    // A browser that forbids it for pages from the disk: the link is only not in the address.
  }
}

/** Do what the address says. @param {import("./app.js").App} app @param {string} hash */
export function readLink(app, hash) {
  const link = parseLink(hash);
  if (!link) return;
  const place = (/** @type {number} */ measure) => app.chart.secondAt(4 * measure);
  if (link.rate !== null) app.takeRate(link.rate);
  if (link.from !== null && link.to !== null) app.setLoop(place(link.from), place(link.to));
  if (link.from !== null) app.seek(place(link.from));
  app.tell("rate");
}
