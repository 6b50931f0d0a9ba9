// The line along which a cable is drawn: straight or sagging spans, and the turns round its wheels.
// Same algorithms as in cable/cable_polyline.cpp and render/cable_path.cpp.

import type { Color } from './color_map';
import { mix, slackColor, tensionColor } from './color_map';
import type { CableState, LinkState, SpanState } from './machine_state';
import { ropeCurve, slackCurve } from './slack_curve';
import type { Vector3 } from './vector';
import { add, addScaled, anyPerpendicular, cross, dot, norm, normalized, scale, subtract } from './vector';

export interface CableStyle {
  radius: number;
  tensionMax: number;
  gravity: Vector3;
  floor: { point: Vector3; normal: Vector3 } | null;
  dark: boolean;
}

/** A line with a colour at each point, and the span of each of its pieces. */
export interface Tube {
  points: Vector3[];
  colors: Color[];
  /** For the piece that begins at the point: index of the listed span; -1 on wheels. */
  spans: number[];
  closed: boolean;
}

const turn = 2 * Math.PI;
/** Distance of drawn lines from their cable, as a share of the cable's radius. */
const coarseness = 0.03;
const mostTurns = 60;

interface Winding {
  angle: number;
  shift: number;
  first: Vector3;
  second: Vector3;
}
const noWinding: Winding = { angle: 0, shift: 0, first: [0, 0, 0], second: [0, 0, 0] };

export const isSlack = (span: SpanState): boolean =>
  !(span.tension > 0) && span.restLength > span.length;

/** IEEE remainder: in [-b/2, b/2]. */
const remainder = (a: number, b: number): number => a - b * Math.round(a / b);

/**
 * The angle from the point where the cable meets the wheel to the point where it leaves it, in the
 * direction of the winding [rad]. The fraction of a turn comes from the two points, so that the
 * line meets the spans; the number of whole turns comes from the stored length.
 */
export function woundAngle(link: LinkState, isEnd: boolean): number {
  if (isEnd) return Math.max(link.wrapAngle, 0);
  const from = subtract(link.entry, link.center);
  const to = subtract(link.exit, link.center);
  const direct = link.winding * Math.atan2(dot(link.normal, cross(from, to)), dot(from, to));
  return direct + turn * Math.round((link.wrapAngle - direct) / turn);
}

function windingOf(cable: CableState, index: number, style: CableStyle): Winding {
  const link = cable.links[index];
  const end = !cable.closed && (index === 0 || index + 1 === cable.links.length);
  let angle = woundAngle(link, end);
  // Omits whole turns only, so that the ends stay in place.
  if (angle > mostTurns * turn) angle = remainder(angle, turn) + mostTurns * turn;
  // The first link of a cable has only an exit; the entry lies that many turns before it.
  const fromExit = end && index === 0;
  let out = subtract(fromExit ? link.exit : link.entry, link.center);
  out = addScaled(out, link.normal, -dot(link.normal, out));
  out = norm(out) > 0 ? normalized(out) : anyPerpendicular(link.normal);
  const ahead = scale(cross(link.normal, out), link.winding);
  const back = fromExit ? -angle : 0;
  const first = add(scale(out, Math.cos(back)), scale(ahead, Math.sin(back)));
  const second = scale(cross(link.normal, first), link.winding);
  const more = angle / turn - 1;
  let shift = 0;
  if (more > 0) {
    // The shift begins at 0, so that the line does not jump when the second turn begins.
    const wanted = ((2.15 * style.radius * angle) / turn) * Math.min(1, 8 * more);
    shift = Math.min(wanted, Math.max(0, link.room - 2 * style.radius));
  }
  return { angle, shift, first, second };
}

/** A rope with weight on its floor: the part that hangs from the start, and the part of the end. */
function lie(span: SpanState, start: Vector3, end: Vector3, tolerance: number): Vector3[] {
  const { forces, floor } = span;
  if (!forces || !floor) return [start, end];
  const load = add(forces.start, forces.end);
  const weight = norm(load);
  const up = weight > 0 ? scale(load, -1 / weight) : load;
  const level = addScaled(forces.start, up, -dot(forces.start, up));
  const part = (from: Vector3, to: Vector3, first: Vector3, last: Vector3): Vector3[] => {
    const hung = norm(add(first, last));
    if (!(hung > 0)) return [from, to];
    const length = ((span.restLength - floor.length) * hung) / weight;
    return ropeCurve(from, to, { start: first, end: last }, length, tolerance);
  };
  return [
    ...part(start, floor.start, forces.start, scale(level, -1)),
    ...part(floor.end, end, level, forces.end),
  ];
}

function hang(span: SpanState, start: Vector3, end: Vector3, style: CableStyle): Vector3[] {
  const tolerance = coarseness * style.radius;
  if (span.floor) return lie(span, start, end, tolerance);
  if (span.forces) {
    const weight = add(span.forces.start, span.forces.end);
    // Without gravity the rope has no weight.
    if (norm(weight) > 0) return ropeCurve(start, end, span.forces, span.restLength, tolerance);
  }
  if (!isSlack(span)) return [start, end];
  const points = slackCurve(start, end, span.restLength, style.gravity, tolerance);
  const floor = style.floor;
  if (floor) {
    for (let i = 1; i + 1 < points.length; ++i) {
      const height = dot(floor.normal, subtract(points[i], floor.point)) - style.radius;
      if (height < 0) points[i] = addScaled(points[i], floor.normal, -height);
    }
  }
  return points;
}

class Drawing {
  private readonly windings: Winding[];
  private readonly tubes: Tube[] = [];
  private current: Tube = emptyTube();
  private cutAtStart = false;

  constructor(
    private readonly cable: CableState,
    private readonly style: CableStyle,
  ) {
    this.windings = cable.links.map((link, i) =>
      link.radius > 0 ? windingOf(cable, i, style) : noWinding,
    );
  }

  spanLine(k: number): Vector3[] {
    const { links, spans } = this.cable;
    const next = (k + 1) % links.length;
    const span = spans[k];
    const start = addScaled(span.start, links[k].normal, 0.5 * this.windings[k].shift);
    const end = addScaled(span.end, links[next].normal, -0.5 * this.windings[next].shift);
    return hang(span, start, end, this.style);
  }

  run(): Tube[] {
    const { links, spans, closed } = this.cable;
    for (let i = 0; i < links.length; ++i) {
      this.addLink(i);
      if (i >= spans.length) continue;
      const color = this.color(i);
      const line = this.spanLine(i);
      line.forEach((p, n) => this.add(p, color, n + 1 < line.length ? spans[i].listed : -1));
    }
    const joined = closed && !this.cutAtStart && this.tubes.length === 0;
    this.cut();
    if (joined && this.tubes.length > 0) this.tubes[0].closed = true;
    return this.tubes;
  }

  private color(span: number): Color {
    return tensionColor(this.cable.spans[span].tension, this.style.tensionMax, this.style.dark);
  }
  private add(point: Vector3, color: Color, span: number): void {
    this.current.points.push(point);
    this.current.colors.push(color);
    this.current.spans.push(span);
  }
  private cut(): void {
    if (this.current.points.length > 1) this.tubes.push(this.current);
    this.current = emptyTube();
  }

  private addLink(i: number): void {
    const { links, spans, closed } = this.cable;
    const link = links[i];
    const w = this.windings[i];
    const n = spans.length;
    const outgoing = i < n ? i : i - 1;
    const incoming = closed || i > 0 ? (i + n - 1) % n : outgoing;
    if (link.path.length > 0) {
      const last = Math.max(link.path.length - 1, 1);
      link.path.forEach((p, k) =>
        this.add(p, mix(this.color(incoming), this.color(outgoing), k / last), -1),
      );
      return;
    }
    // If the arc is too short to blend the colours along it, the tube is divided.
    if (!(link.radius > 0) || Math.abs(w.angle) * link.radius < 2 * this.style.radius) {
      if (i === 0) this.cutAtStart = true;
      this.cut();
      return;
    }
    const from = this.color(incoming);
    const to = this.color(outgoing);
    const sagitta = Math.min((coarseness * this.style.radius) / link.radius, 0.29);
    const steps = Math.min(Math.max(2, Math.ceil(Math.abs(w.angle) / (2 * Math.acos(1 - sagitta)))), 7999);
    for (let k = 0; k <= steps; ++k) {
      const share = k / steps;
      const angle = w.angle * share;
      const out = add(scale(w.first, Math.cos(angle)), scale(w.second, Math.sin(angle)));
      const place = addScaled(link.center, out, link.radius);
      this.add(addScaled(place, link.normal, w.shift * (share - 0.5)), mix(from, to, share), -1);
    }
  }
}

const emptyTube = (): Tube => ({ points: [], colors: [], spans: [], closed: false });

/** A piece of a cut cable, along its recorded line. */
const slackTube = (points: Vector3[]): Tube => ({
  points,
  colors: points.map(() => slackColor),
  spans: points.map(() => -1),
  closed: false,
});

/** The whole cable. It is divided at attachments, where its colour jumps. */
export function cableTubes(cable: CableState, style: CableStyle): Tube[] {
  if (!cable.cut) return new Drawing(cable, style).run();
  return cable.pieces.filter((line) => line.length > 1).map(slackTube);
}
