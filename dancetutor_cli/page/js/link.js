// Deep links: #m8-16@0.75 is measures 8 to 16 in a loop at three quarters of the speed; #m8 only goes there.

/** @typedef {{from: number | null, to: number | null, rate: number | null}} Link measures */

/** @param {string} hash @returns {Link | null} */
export function parseLink(hash) {
  const found = /^#?(?:m(\d+(?:\.\d+)?)(?:-(\d+(?:\.\d+)?))?)?(?:@(\d+(?:\.\d+)?))?$/.exec(hash);
  if (!found || !(found[1] || found[3])) return null;
  const [from, to, rate] = [found[1], found[2], found[3]].map((text) => (text === undefined ? null : Number(text)));
  if (from !== null && to !== null && to <= from) return { from, to: null, rate };
  return { from, to, rate };
}

/** @param {number | null} from @param {number | null} to measures @param {number} rate */
export function makeLink(from, to, rate) {
  const place = from === null ? "" : to === null ? `m${short(from)}` : `m${short(from)}-${short(to)}`;
  return place || rate !== 1 ? `#${place}${rate === 1 ? "" : `@${short(rate)}`}` : "";
}

/** @param {number} x */
const short = (x) => String(Math.round(x * 100) / 100);
