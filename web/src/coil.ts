// The line of a helical spring; same algorithm as in render/coil.cpp.

import type { Vector3 } from './vector';
import { add, addScaled, cross, dot, normalized, scale, subtract } from './vector';

const pointsPerCoil = 20;
/** Straight part at each end, as a share of the length. */
const lead = 0.1;

/** From start to end, which must differ; the coils begin on the side of the direction `side`. */
export function coilPoints(
  start: Vector3,
  end: Vector3,
  side: Vector3,
  coils: number,
  radius: number,
): Vector3[] {
  const along = subtract(end, start);
  const axis = normalized(along);
  const first = normalized(addScaled(side, axis, -dot(axis, side)));
  const second = cross(axis, first);
  const count = coils * pointsPerCoil;
  const points: Vector3[] = [start];
  for (let i = 0; i <= count; ++i) {
    const share = i / count;
    const angle = 2 * Math.PI * coils * share;
    // The radius grows and shrinks over half a coil, so that the wire has no corner there.
    const blend = Math.min(Math.min(share, 1 - share) * 2 * coils, 1);
    const r = radius * blend * blend * (3 - 2 * blend);
    const off = add(scale(first, r * Math.cos(angle)), scale(second, r * Math.sin(angle)));
    points.push(add(addScaled(start, along, lead + (1 - 2 * lead) * share), off));
  }
  points.push(end);
  return points;
}
