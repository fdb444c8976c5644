// Names of places and stretches of a song. A whole number names a measure, and what is named is part of it: measures 8
// to 16 end where 17 begins. With a fraction it is a point: 8.5 is the middle of measure 8;
// in words such a stretch is named by its first and last beat, both part of it.

/** @param {number} x measures */
export const short = (x) => String(Math.round(x * 100) / 100);

/**
 * Return the names of the first and the last measure of a stretch. @param {number} from @param {number} to measures, where it ends
 * @returns {[string, string]}
 */
export function named(from, to) {
  const end = short(to);
  return [short(from), end.includes(".") ? end : String(Number(end) - 1)];
}

/** Return where a stretch ends, from the name of its last measure or point. @param {string} name */
function endOf(name) {
  return Number(name) + (name.includes(".") ? 0 : 1);
}

/**
 * A stretch in words; the last measure, or beat, that is named is part of it.
 * @param {import("./words.js").Translate} t @param {number} from @param {number} to measures
 */
export function stretch(t, from, to) {
  const [first, last] = named(from, to);
  const whole = (/** @type {number} */ x) => Math.abs(x - Math.round(x)) < 5e-3;
  if (whole(from) && whole(to)) return first === last ? t("oneMeasure", { from: first }) : t("measures", { from: first, to: last });
  if (!whole(4 * from) || !whole(4 * to)) return t("points", { from: Number(short(from)), to: Number(short(to)) });
  return t("fromTo", { from: placeOf(t, Math.round(4 * from)), to: placeOf(t, Math.round(4 * to) - 1) });
}

/**
 * Return the place of a row as musicians count: the beats of each measure from 1.
 * @param {import("./words.js").Translate} t @param {number} beat
 */
export function placeInMeasure(t, beat) {
  return t("measureAt", { measure: Math.floor(beat / 4), beat: 1 + Math.round(1000 * (beat % 4)) / 1000 });
}

/**
 * Return the place of a row as `analyze` prints it: measures and beats are both counted from 0, through the song.
 * @param {import("./words.js").Translate} t @param {number} beat
 */
export function placeOf(t, beat) {
  return t("measureAt", { measure: Math.floor(beat / 4), beat: Math.round(1000 * beat) / 1000 });
}

// Deep links: #m8-16@0.75 is measures 8 to 16 in a loop at three quarters of the speed; #m8 only goes there.

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

/** Write the loop and the speed into the address. @param {import("./app.js").App} app */
export function writeLink(app) {
  const { loop } = app.transport;
  const measure = (/** @type {number} */ second) => app.chart.beatAt(second) / 4;
  const link = makeLink(loop && measure(loop.a), loop && measure(loop.b), app.practice.chosenRate);
  try {
    history.replaceState(null, "", link || location.pathname + location.search);
  } catch {
    // Some browsers forbid this for pages from the disk. Then the address stays as it is.
  }
}

/** Set the loop, the speed and the place that the address names. @param {import("./app.js").App} app @param {string} hash */
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
