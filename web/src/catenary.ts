// The shape of a cable of given length that hangs between two points. Derivation:
// render/catenary.cpp, which has the same algorithm.

import type { Vector3 } from './vector';
import { add, addScaled, anyPerpendicular, dot, norm, scale, subtract } from './vector';

/** ln(sinh(q)/q) without overflow. */
function logSinhc(q: number): number {
  if (q < 0.1) {
    const t = q * q;
    return t / 6 - (t * t) / 180 + (t * t * t) / 2835 - (t * t * t * t) / 37800;
  }
  return q + Math.log1p(-Math.exp(-2 * q)) - Math.log(2 * q);
}

/** The derivative of logSinhc: coth(q) - 1/q. */
function logSinhcSlope(q: number): number {
  if (q < 0.1) {
    const t = q * q;
    return q * (1 / 3 - t / 45 + (2 * t * t) / 945 - (t * t * t) / 4725);
  }
  return 1 / Math.tanh(q) - 1 / q;
}

function solveShape(target: number): number {
  let q = target < 1 ? Math.sqrt(6 * target) : target + Math.log(2 * (target + 1));
  for (let round = 0; round < 40; ++round) {
    const next = q - (logSinhc(q) - target) / logSinhcSlope(q);
    const safe = next > 0 ? next : 0.5 * q;
    const done = Math.abs(safe - q) <= 4e-16 * q;
    q = safe;
    if (done) break;
  }
  return q;
}

/** asinh(b) - asinh(c) without cancellation. */
function asinhDifference(b: number, c: number): number {
  if (b > 0 && c < 0) return Math.asinh(b) - Math.asinh(c);
  if (c < 0) return asinhDifference(-c, -b);
  const rb = Math.sqrt(1 + b * b);
  const rc = Math.sqrt(1 + c * c);
  return Math.log1p(((b - c) * (1 + (b + c) / (rb + rc))) / (c + rc));
}

/** `count` points from start to end of a cable of this length [m]. */
export function catenaryPoints(
  start: Vector3,
  end: Vector3,
  length: number,
  gravity: Vector3,
  count: number,
): Vector3[] {
  const d = subtract(end, start);
  const distance = norm(d);
  const strength = norm(gravity);
  const up: Vector3 = strength > 0 ? scale(gravity, -1 / strength) : [0, 1, 0];
  const rise = dot(d, up);
  const level = addScaled(d, up, -rise);
  const width = norm(level);
  const across = width > 0 ? scale(level, 1 / width) : anyPerpendicular(up);
  if (!(length > distance * (1 + 1e-14))) return [start, end];
  let radius = 0;
  let lowest = 0.5 * (length - rise);
  if (width > 1e-12 * length) {
    const excess = ((length - distance) * (length + distance)) / (width * width);
    const q = solveShape(0.5 * Math.log1p(excess));
    radius = (0.5 * width) / q;
    lowest = 0.5 * (length - rise / Math.tanh(q));
  }
  const point = (s: number): Vector3 => {
    if (!(s > 0)) return start;
    if (s >= length) return end;
    const from = -lowest;
    const to = s - lowest;
    const height = ((to - from) * (to + from)) / (Math.hypot(radius, to) + Math.hypot(radius, from));
    const x = radius > 0 ? radius * asinhDifference(to / radius, from / radius) : (width * s) / length;
    return add(addScaled(start, across, x), scale(up, height));
  };
  // Half of the points have equal distances along the cable, half have equal changes of direction:
  // neither long arms nor bends look angular.
  const places: number[] = [];
  const even = Math.floor(count / 2) + 1;
  for (let k = 0; k < even; ++k) places.push((length * k) / (even - 1));
  const from = Math.atan2(-lowest, radius);
  const to = Math.atan2(length - lowest, radius);
  for (let k = 1; k <= count - even; ++k) {
    const angle = from + ((to - from) * k) / (count - even + 1);
    places.push(Math.min(Math.max(lowest + radius * Math.tan(angle), 0), length));
  }
  places.sort((a, b) => a - b);
  return places.map(point);
}
