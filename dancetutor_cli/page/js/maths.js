// Vectors, quaternions and matrices of the viewer: plain arrays, column vectors, matrices row by row as in the films.

/** @typedef {[number, number, number]} Vec3 */

/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b @returns {Vec3} */
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b @returns {Vec3} */
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b @param {number} [t] @returns {Vec3} */
export const plus = (a, b, t = 1) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
/** @param {ArrayLike<number>} a @returns {Vec3} */
export const unit = (a) => {
  const n = Math.hypot(a[0], a[1], a[2]) || 1;
  return [a[0] / n, a[1] / n, a[2] / n];
};
/** @param {number} x @param {number} low @param {number} high */
export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
/** @param {number} t */
export const smooth = (t) => { const x = clamp(t, 0, 1); return x * x * (3 - 2 * x); };

/**
 * Product of quaternions (w, x, y, z).
 * @param {ArrayLike<number>} a @param {ArrayLike<number>} b @returns {[number, number, number, number]}
 */
export function multiply(a, b) {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}

/**
 * A vector turned by a quaternion.
 * @param {ArrayLike<number>} q @param {ArrayLike<number>} v @returns {Vec3}
 */
export function turn(q, v) {
  const [w, x, y, z] = [q[0], q[1], q[2], q[3]];
  const tx = 2 * (y * v[2] - z * v[1]);
  const ty = 2 * (z * v[0] - x * v[2]);
  const tz = 2 * (x * v[1] - y * v[0]);
  return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx];
}

/**
 * The shortest turn that takes one unit vector to another.
 * @param {ArrayLike<number>} a @param {ArrayLike<number>} b @returns {[number, number, number, number]}
 */
export function between(a, b) {
  const c = cross(a, b);
  const w = 1 + dot(a, b);
  if (w < 1e-6) return [0, 0, 0, 1];
  const n = Math.hypot(w, ...c);
  return [w / n, c[0] / n, c[1] / n, c[2] / n];
}

/**
 * Index of the last of sorted values that is not greater than x; -1 before the first.
 * @param {ArrayLike<number>} values @param {number} x
 */
export function lastUpTo(values, x) {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
