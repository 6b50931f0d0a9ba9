// The line along which a cable is drawn: straight or sagging spans, and the turns round its wheels.
// Same algorithm as in render/cable_path.cpp.

import { catenaryPoints } from './catenary';
import type { Color } from './color_map';
import { mix, slackColor, tensionColor } from './color_map';
import type { CableState, LinkState, SpanState } from './machine_state';
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
const stepAngle = 0.1;
const mostTurns = 60;
const catenaryCount = 41;

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

/**
 * The line of a rope with weight. The tension at a share of its length is the force at its start
 * less that share of its weight, and the rope lies along its tension.
 */
function hangByWeight(force: Vector3, weight: Vector3, start: Vector3, end: Vector3): Vector3[] {
  const points: Vector3[] = [[0, 0, 0]];
  for (let i = 0; i < catenaryCount; ++i) {
    const tension = addScaled(force, weight, -(i + 0.5) / catenaryCount);
    points.push(add(points[i], normalized(tension)));
  }
  // The sum has the length of the number of steps; the rest is the error of the sum and the stretch.
  const chord = subtract(end, start);
  const reached = points[catenaryCount];
  const factor = norm(chord) / Math.max(norm(reached), 1e-300);
  const rest = addScaled(chord, reached, -factor);
  return points.map((p, i) => addScaled(addScaled(start, p, factor), rest, i / catenaryCount));
}

function hang(span: SpanState, start: Vector3, end: Vector3, style: CableStyle): Vector3[] {
  if (span.forces) {
    const weight = add(span.forces.start, span.forces.end);
    // Without gravity the rope has no weight.
    if (norm(weight) > 0) return hangByWeight(span.forces.start, weight, start, end);
  }
  if (!isSlack(span)) return [start, end];
  const points = catenaryPoints(start, end, span.restLength, style.gravity, catenaryCount);
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
    const steps = Math.max(2, Math.ceil(Math.abs(w.angle) / stepAngle));
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

/** The two hanging pieces of a cut cable; a cut belt has none. */
function cutPieces(cable: CableState, style: CableStyle): Tube[] {
  if (cable.closed || !(norm(style.gravity) > 0)) return [];
  const down = normalized(style.gravity);
  const tubes: Tube[] = [];
  for (const isFirst of [true, false]) {
    const end = cable.links[isFirst ? 0 : cable.links.length - 1];
    const side = isFirst ? -end.winding : end.winding;
    const start = addScaled(end.center, cross(end.normal, down), side * end.radius);
    let length = cable.pieces[isFirst ? 0 : 1] - end.storedLength;
    const floor = style.floor;
    if (floor && dot(floor.normal, down) < 0) {
      const height = dot(floor.normal, subtract(start, floor.point)) - style.radius;
      length = Math.min(length, height / -dot(floor.normal, down));
    }
    if (!(length > 0)) continue;
    tubes.push({
      points: [start, addScaled(start, down, length)],
      colors: [slackColor, slackColor],
      spans: [-1, -1],
      closed: false,
    });
  }
  return tubes;
}

/** The whole cable. It is divided at attachments, where its colour jumps. */
export function cableTubes(cable: CableState, style: CableStyle): Tube[] {
  return cable.cut ? cutPieces(cable, style) : new Drawing(cable, style).run();
}
