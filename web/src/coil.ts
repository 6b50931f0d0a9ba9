// The line of a helical spring, as render/coil.cpp has it.

import type { Vector3 } from './vector';
import { add, addScaled, cross, dot, normalized, scale, subtract } from './vector';

const pointsPerCoil = 20;
/** Share of the length at either end that is straight. */
const lead = 0.1;

/** From start to end, which differ; the coils begin on the side that `side` points to. */
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
    // The radius grows and fades over half a coil, so that the wire has no corner there.
    const blend = Math.min(Math.min(share, 1 - share) * 2 * coils, 1);
    const r = radius * blend * blend * (3 - 2 * blend);
    const off = add(scale(first, r * Math.cos(angle)), scale(second, r * Math.sin(angle)));
    points.push(add(addScaled(start, along, lead + (1 - 2 * lead) * share), off));
  }
  points.push(end);
  return points;
}
