// Names of places and stretches of a song. A whole number names a measure, and what is named is part of it: measures 8
// to 16 end where 17 begins. With a fraction it is a point: 8.5 is the middle of measure 8;
// in words such a stretch is named by its first and last beat, both part of it.

/** @param {number} x measures */
export const short = (x) => String(Math.round(x * 100) / 100);

/**
 * The names of a stretch's first and last measure. @param {number} from @param {number} to measures, where it ends
 * @returns {[string, string]}
 */
export function named(from, to) {
  const end = short(to);
  return [short(from), end.includes(".") ? end : String(Number(end) - 1)];
}

/** Where a stretch ends whose last measure, or the point it goes to, has this name. @param {string} name */
export function endOf(name) {
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

/** The place of a row as musicians count: the beats of each measure from 1 on. @param {import("./words.js").Translate} t @param {number} beat */
export function placeInMeasure(t, beat) {
  return t("measureAt", { measure: Math.floor(beat / 4), beat: 1 + Math.round(1000 * (beat % 4)) / 1000 });
}

/** The place of a row, as `analyze` tells it: measures and beats are both counted from 0, through the song. @param {import("./words.js").Translate} t @param {number} beat */
export function placeOf(t, beat) {
  return t("measureAt", { measure: Math.floor(beat / 4), beat: Math.round(1000 * beat) / 1000 });
}
