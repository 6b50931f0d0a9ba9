// Distance joints in the present state: rods, strings, springs, telescopes; as in
// render/joint_view.cpp.

import { coilPoints } from './coil';
import type { Color } from './color_map';
import { fromHex } from './color_map';
import type { JointLine } from './machine';
import type { MachineState } from './machine_state';
import { slackCurve } from './slack_curve';
import type { Vector3 } from './vector';
import { addScaled, anyPerpendicular, cross, norm, scale, subtract } from './vector';

const rodColor = fromHex(0x8d98a5);
const sleeveColor = fromHex(0x5f6b79);
const stringColor = fromHex(0x4a5563);

export interface ColoredLine {
  points: Vector3[];
  radius: number;
  color: Color;
}

const clamp = (x: number, low: number, high: number): number => Math.min(Math.max(x, low), high);

export function jointLines(line: JointLine, state: MachineState): ColoredLine[] {
  const unit = state.machine.joint_unit;
  const start = state.place(line.body_a, line.start);
  const end = state.place(line.body_b, line.end);
  const apart = subtract(end, start);
  const distance = norm(apart);
  if (!(distance > 1e-9 * line.length)) return [];
  const along = scale(apart, 1 / distance);
  const sleeve: ColoredLine = {
    points: [start, addScaled(start, along, Math.min(0.55 * line.length, 0.9 * distance))],
    radius: 2 * unit,
    color: sleeveColor,
  };
  switch (line.kind) {
    case 'rod':
      return [{ points: [start, end], radius: unit, color: rodColor }];
    case 'string': {
      const points = slackCurve(start, end, line.length, state.machine.gravity, 0.05 * unit);
      return [{ points, radius: 0.5 * unit, color: stringColor }];
    }
    case 'spring': {
      const radius = clamp(0.09 * line.length, 1.5 * unit, 5 * unit);
      const coils = clamp(Math.floor((0.75 * line.length) / radius), 5, 14);
      let side = state.turn(line.body_a, line.side);
      if (norm(cross(along, side)) < 0.05) side = anyPerpendicular(along);
      const points = coilPoints(start, end, side, coils, radius);
      return [{ points, radius: Math.max(0.16 * radius, 0.35 * unit), color: rodColor }];
    }
    case 'telescope':
      return [sleeve, { points: [start, end], radius: unit, color: rodColor }];
    case 'bumper': {
      const tip = addScaled(start, along, Math.min(line.length, distance));
      return [sleeve, { points: [start, tip], radius: unit, color: rodColor }];
    }
  }
}
