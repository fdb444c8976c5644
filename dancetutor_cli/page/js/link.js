// Deep links: #m8-16@0.75 is measures 8 to 16 in a loop at three quarters of the speed; #m8 only goes there.

import { endOf, named, short } from "./places.js";

/**
 * @typedef {object} Link
 * @property {number | null} from measures
 * @property {number | null} to where the loop ends
 * @property {number | null} rate
 * @property {boolean} backwards whether the end that it names comes before its beginning
 */

const MEASURE = "(\\d{1,6}(?:\\.\\d{1,6})?)"; // longer numbers name no place of a song
const LINK = new RegExp(`^#?(?:m${MEASURE}(?:-${MEASURE})?)?(?:@${MEASURE})?$`);

/** @param {string} hash @returns {Link | null} */
export function parseLink(hash) {
  const found = LINK.exec(hash);
  if (!found || !(found[1] || found[3])) return null;
  const [from, rate] = [found[1], found[3]].map((text) => (text === undefined ? null : Number(text)));
  const to = found[2] === undefined ? null : endOf(found[2]);
  const backwards = from !== null && to !== null && to <= from;
  return { from, to: backwards ? null : to, rate, backwards };
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
  const { t, chart } = app;
  if (!link) {
    if (hash.length > 1) app.notice = t("linkUnknown", { link: hash.slice(0, 40) });
    return app.tell("rate");
  }
  const place = (/** @type {number} */ measure) => chart.secondAt(4 * measure);
  const last = Math.max(0, Math.ceil(chart.beatAt(chart.last) / 4 - 1e-6) - 1); // measure in which the last step ends
  if (link.rate !== null) app.takeRate(link.rate);
  if (link.from !== null && link.from < last + 1) {
    if (link.to !== null) app.setLoop(place(link.from), place(Math.min(link.to, last + 1)));
    app.seek(place(link.from));
  }
  const short = link.from !== null && link.from < last + 1 && link.to !== null && !app.transport.loop;
  if (short) app.notice = t("linkShort");
  else if (link.from !== null && link.from >= last + 1) app.notice = t("linkBeyond", { from: link.from, last });
  else if (link.to !== null && link.to > last + 1) app.notice = t("linkCut", { last });
  else if (link.backwards) app.notice = t("linkBackwards", { from: /** @type {number} */ (link.from) });
  app.tell("rate");
}
