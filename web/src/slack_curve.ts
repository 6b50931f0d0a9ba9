// The curve of a cable that hangs between two points, as in cable/slack_curve.cpp, which has the
// derivation.

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

/** A catenary x = a (u - from), z = a (cosh u - cosh from) from its start. */
interface Curve {
  start: Vector3;
  end: Vector3;
  across: Vector3;
  up: Vector3;
  /** a: radius of curvature at the lowest point [m]; 0: the curve has no width. */
  radius: number;
  from: number;
  to: number;
  /** Way down to the lowest point of a curve without width [m]. */
  depth: number;
}

/** Largest number of steps on either side of the lowest point. */
const mostSteps = 1000;

function place({ across, up, radius, from }: Curve, u: number): Vector3 {
  const half = 0.5 * (u - from);
  const height = 2 * radius * Math.sinh(from + half) * Math.sinh(half);
  return addScaled(scale(across, 2 * radius * half), up, height);
}

/** A polyline no farther from the curve than the tolerance, with equal steps of u. */
function polyline(curve: Curve, tolerance: number): Vector3[] {
  const { start, end, radius, from, to } = curve;
  if (radius === 0) {
    return curve.depth > 0 ? [start, addScaled(start, curve.up, -curve.depth), end] : [start, end];
  }
  const stepsOf = (wide: number): number =>
    Math.min(Math.max(Math.ceil(wide * Math.sqrt(radius / (4 * tolerance))), 1), mostSteps);
  const turns = from < 0 && to > 0;
  const middle = turns ? 0 : to;
  const before = stepsOf(middle - from);
  const behind = turns ? stepsOf(to) : 0;
  const rest = subtract(subtract(end, start), place(curve, to));
  const points = [start];
  for (let k = 1; k < before + behind; ++k) {
    const u = k <= before ? from + ((middle - from) * k) / before : (to * (k - before)) / behind;
    points.push(add(start, addScaled(place(curve, u), rest, (u - from) / (to - from))));
  }
  points.push(end);
  return points;
}

/** A slack cable of this length [m]. */
export function slackCurve(
  start: Vector3,
  end: Vector3,
  length: number,
  gravity: Vector3,
  tolerance: number,
): Vector3[] {
  const d = subtract(end, start);
  const distance = norm(d);
  if (!(length > distance * (1 + 1e-14))) return [start, end];
  const strength = norm(gravity);
  const up: Vector3 = strength > 0 ? scale(gravity, -1 / strength) : [0, 1, 0];
  const rise = dot(d, up);
  const level = addScaled(d, up, -rise);
  const width = norm(level);
  const curve: Curve = { start, end, across: anyPerpendicular(up), up, radius: 0, from: 0, to: 0, depth: 0 };
  if (width <= 1e-12 * length) {
    const depth = 0.5 * (length - rise);
    return polyline({ ...curve, depth: depth < length ? depth : 0 }, tolerance);
  }
  const excess = ((length - distance) * (length + distance)) / (width * width);
  const q = solveShape(0.5 * Math.log1p(excess));
  const radius = (0.5 * width) / q;
  const lowest = 0.5 * (length - rise / Math.tanh(q));
  const [from, to] = [Math.asinh(-lowest / radius), Math.asinh((length - lowest) / radius)];
  return polyline({ ...curve, across: scale(level, 1 / width), radius, from, to }, tolerance);
}

/** A rope with weight by the forces on the bodies at its ends [N], whose sum is the weight. */
export function ropeCurve(
  start: Vector3,
  end: Vector3,
  forces: { start: Vector3; end: Vector3 },
  length: number,
  tolerance: number,
): Vector3[] {
  const load = add(forces.start, forces.end);
  const weight = norm(load);
  const up = scale(load, -1 / weight);
  const before = dot(forces.start, up);
  const level = addScaled(forces.start, up, -before);
  const horizontal = norm(level);
  const depth = (-length * before) / weight;
  const curve: Curve = { start, end, across: level, up, radius: 0, from: 0, to: 0, depth: 0 };
  if (!(horizontal > 1e-12 * weight)) {
    return polyline({ ...curve, depth: depth < length ? depth : 0 }, tolerance);
  }
  const one: Curve = {
    ...curve,
    across: scale(level, 1 / horizontal),
    radius: 1,
    from: Math.asinh(before / horizontal),
    to: Math.asinh((before + weight) / horizontal),
  };
  const unit = norm(place(one, one.to));
  const byLength = (length * horizontal) / weight;
  const radius = unit * byLength > 1e-6 * length ? norm(subtract(end, start)) / unit : byLength;
  return polyline({ ...one, radius }, tolerance);
}
