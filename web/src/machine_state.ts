// The state of a machine at one time: the numbers of a frame as poses, links and spans.

import type { Frames } from './frames';
import type { BodyIndex, Machine } from './machine';
import type { Quaternion, Vector3 } from './vector';
import { add, rotate, slerp } from './vector';

export interface Pose {
  position: Vector3;
  orientation: Quaternion;
}

/** Same as LinkReport in cable/cable_report.h. */
export interface LinkState {
  body: BodyIndex;
  center: Vector3;
  normal: Vector3;
  radius: number;
  winding: number;
  entry: Vector3;
  exit: Vector3;
  path: Vector3[];
  storedLength: number;
  wrapAngle: number;
  /** Width for windings side by side [m]. */
  room: number;
}

/** Same as SpanReport. */
export interface SpanState {
  start: Vector3;
  end: Vector3;
  length: number;
  restLength: number;
  tension: number;
  /** Forces of a rope with weight on the bodies at its ends [N]; null for other cables. */
  forces: { start: Vector3; end: Vector3 } | null;
  /** The part of a rope with weight that lies on its floor; null if none does. */
  floor: { length: number; start: Vector3; end: Vector3 } | null;
  /**
   * Index in the cable's list of spans; a wrap's span has the index of the listed span before it.
   */
  listed: number;
}

/** Links and spans with the wraps inserted: span k begins at link k. */
export interface CableState {
  closed: boolean;
  cut: boolean;
  /** Lines of the pieces of a cut cable. */
  pieces: Vector3[][];
  links: LinkState[];
  spans: SpanState[];
}

interface LinkPlaces {
  body: BodyIndex;
  /** Channel indices; -1 for a missing channel. A point has three consecutive channels. */
  of: Map<string, number>;
  path: number[];
  room: number;
}
interface SpanPlaces {
  tension: number;
  length: number;
  rest: number;
  start: number;
  end: number;
  /** -1: the rope has no weight. */
  startForce: number;
  endForce: number;
  /** -1: the rope has no floor. */
  floored: number;
  floorStart: number;
  floorEnd: number;
}
/** Channels of a line in the world: of its number of points, and of x of each point. */
interface LinePlaces {
  count: number;
  points: number[];
}
interface CablePlaces {
  links: LinkPlaces[];
  spans: SpanPlaces[];
  wraps: LinkPlaces[];
  pieces: LinePlaces[];
  name: string;
}

const worldPose: Pose = { position: [0, 0, 0], orientation: [1, 0, 0, 0] };
const linkChannels = [
  'radius',
  'winding',
  'stored_length',
  'wrap_angle',
  'path_count',
  'entry_x',
  'exit_x',
  'center_x',
  'normal_x',
  // Channels of wraps:
  'body',
  'after',
  'tension',
  'length',
  'rest_length',
  'end_x',
];

/** Discrete channels, which must not be interpolated between two frames. */
const discrete = /\.(winding|body|after|path_count|wrap_count|count|broken|cut|wraps)$/;

/** Reads states of a machine from frames. The object describes the time of the last look(). */
export class MachineState {
  readonly machine: Machine;
  readonly values: Float64Array;
  time = 0;
  private readonly later: Float64Array;
  private readonly bodyPlaces: number[];
  private readonly cablePlaces: CablePlaces[];
  private readonly broken: number[];
  private readonly blended: Uint8Array;
  private readonly poses: Pose[] = [];

  constructor(private readonly frames: Frames) {
    const machine = frames.machine;
    this.machine = machine;
    this.values = new Float64Array(frames.channels.length);
    this.later = new Float64Array(frames.channels.length);
    this.blended = Uint8Array.from(frames.channels, (c) => (discrete.test(c.name) ? 0 : 1));
    this.bodyPlaces = machine.bodies.map((b) => this.need(`${b.name}.x`));
    // Orientations are interpolated as rotations, not by components.
    for (const place of this.bodyPlaces) this.blended.fill(0, place + 3, place + 7);
    this.broken = machine.joints.map((j) => frames.channel(`${j.name}.broken`));
    this.cablePlaces = machine.cables.map((cable) => ({
      name: cable.name,
      links: cable.links.map((link, k) => ({
        ...this.linkPlaces(`${cable.name}.link${k}`),
        body: link.body,
        room: link.winding_room,
      })),
      spans: Array.from({ length: cable.spans }, (_, k) => ({
        tension: this.need(`${cable.name}.${k}.tension`),
        length: this.need(`${cable.name}.${k}.length`),
        rest: this.need(`${cable.name}.${k}.rest_length`),
        start: this.need(`${cable.name}.${k}.start_x`),
        end: this.need(`${cable.name}.${k}.end_x`),
        startForce: frames.channel(`${cable.name}.${k}.start_force_x`),
        endForce: frames.channel(`${cable.name}.${k}.end_force_x`),
        floored: frames.channel(`${cable.name}.${k}.floored`),
        floorStart: frames.channel(`${cable.name}.${k}.floor_start_x`),
        floorEnd: frames.channel(`${cable.name}.${k}.floor_end_x`),
      })),
      wraps: Array.from({ length: cable.wraps }, (_, k) =>
        this.linkPlaces(`${cable.name}.wrap${k}`),
      ),
      pieces: [0, 1].map((k) => this.linePlaces(`${cable.name}.piece${k}`)),
    }));
  }

  /** Sets the time; between two frames the state is interpolated. */
  look(time: number): void {
    const frames = this.frames;
    if (frames.count === 0) return;
    const first = frames.frameAt(time);
    frames.read(first, this.values);
    this.time = frames.time(first);
    const next = first + 1;
    if (first === 0) this.fillStart();
    if (time > this.time && next < frames.count) {
      const share = (time - this.time) / (frames.time(next) - this.time);
      frames.read(next, this.later);
      this.blend(share);
      this.time = time;
    }
    for (let i = 0; i < this.bodyPlaces.length; ++i) this.poses[i] = this.readPose(i);
  }

  pose(body: BodyIndex): Pose {
    return body < 0 ? worldPose : this.poses[body];
  }
  /** The position in the world of a point of a body. */
  place(body: BodyIndex, local: Vector3): Vector3 {
    if (body < 0) return local;
    const pose = this.poses[body];
    return add(pose.position, rotate(pose.orientation, local));
  }
  turn(body: BodyIndex, local: Vector3): Vector3 {
    return body < 0 ? local : rotate(this.poses[body].orientation, local);
  }
  isBroken(joint: number): boolean {
    const channel = this.broken[joint];
    return channel >= 0 && this.values[channel] > 0;
  }
  value(name: string): number {
    const channel = this.frames.channel(name);
    return channel < 0 ? NaN : this.values[channel];
  }

  cable(index: number): CableState {
    const places = this.cablePlaces[index];
    const { closed, spans } = this.machine.cables[index];
    const state: CableState = {
      closed,
      cut: this.value(`${places.name}.cut`) > 0,
      pieces: places.pieces.map((piece) => this.line(piece)),
      links: [],
      spans: [],
    };
    const wraps = this.value(`${places.name}.wrap_count`) || 0;
    places.links.forEach((place, k) => {
      state.links.push(this.link(place, place.body));
      if (k < spans) state.spans.push(this.span(places, k));
      for (let w = 0; w < wraps; ++w) {
        const wrap = places.wraps[w];
        if (this.number(wrap, 'after') !== k) continue;
        state.links.push(this.link(wrap, this.number(wrap, 'body')));
        state.spans.push({
          start: this.point(wrap.of.get('exit_x')!),
          end: this.point(wrap.of.get('end_x')!),
          length: this.number(wrap, 'length'),
          restLength: this.number(wrap, 'rest_length'),
          tension: this.number(wrap, 'tension'),
          forces: null,
          floor: null,
          listed: k,
        });
      }
    });
    return state;
  }

  /** Forces are unknown before the first step; at the start those of the first step are shown. */
  private fillStart(): void {
    if (this.frames.count < 2) return;
    this.frames.read(1, this.later);
    for (let i = 0; i < this.values.length; ++i) {
      if (!this.frames.isKnown(i, 0)) this.values[i] = this.later[i];
    }
  }

  private blend(share: number): void {
    const { values, later, blended } = this;
    for (let i = 0; i < values.length; ++i) {
      if (blended[i]) values[i] += share * (later[i] - values[i]);
    }
    for (const place of this.bodyPlaces) {
      const from = Array.from(values.subarray(place + 3, place + 7)) as Quaternion;
      const to = Array.from(later.subarray(place + 3, place + 7)) as Quaternion;
      values.set(slerp(from, to, share), place + 3);
    }
  }
  private readPose(body: number): Pose {
    const p = this.bodyPlaces[body];
    const v = this.values;
    return {
      position: [v[p], v[p + 1], v[p + 2]],
      orientation: [v[p + 3], v[p + 4], v[p + 5], v[p + 6]],
    };
  }
  private link(place: LinkPlaces, body: BodyIndex): LinkState {
    const count = this.number(place, 'path_count') || 0;
    return {
      body,
      center: this.place(body, this.point(place.of.get('center_x')!)),
      normal: this.turn(body, this.point(place.of.get('normal_x')!)),
      radius: this.number(place, 'radius'),
      winding: this.number(place, 'winding'),
      entry: this.point(place.of.get('entry_x')!),
      exit: this.point(place.of.get('exit_x')!),
      path: place.path.slice(0, count).map((channel) => this.place(body, this.point(channel))),
      storedLength: this.number(place, 'stored_length'),
      wrapAngle: this.number(place, 'wrap_angle'),
      room: place.room,
    };
  }
  private span(places: CablePlaces, k: number): SpanState {
    const span = places.spans[k];
    return {
      start: this.point(span.start),
      end: this.point(span.end),
      length: this.values[span.length],
      restLength: this.values[span.rest],
      tension: this.values[span.tension],
      forces:
        span.startForce < 0
          ? null
          : { start: this.point(span.startForce), end: this.point(span.endForce) },
      floor:
        span.floored < 0 || !(this.values[span.floored] > 0)
          ? null
          : {
              length: this.values[span.floored],
              start: this.point(span.floorStart),
              end: this.point(span.floorEnd),
            },
      listed: k,
    };
  }
  private number(place: LinkPlaces, name: string): number {
    const channel = place.of.get(name);
    return channel === undefined ? NaN : this.values[channel];
  }
  private point(channel: number): Vector3 {
    const v = this.values;
    return [v[channel], v[channel + 1], v[channel + 2]];
  }
  private line(places: LinePlaces): Vector3[] {
    const count = places.count < 0 ? 0 : this.values[places.count] || 0;
    return places.points.slice(0, count).map((channel) => this.point(channel));
  }
  private linePlaces(prefix: string): LinePlaces {
    return {
      count: this.frames.channel(`${prefix}.count`),
      points: this.pointChannels((k) => `${prefix}.${k}_x`),
    };
  }
  /** The channels of x of numbered points, as far as there are any. */
  private pointChannels(name: (k: number) => string): number[] {
    const channels: number[] = [];
    for (;;) {
      const channel = this.frames.channel(name(channels.length));
      if (channel < 0) return channels;
      channels.push(channel);
    }
  }
  private linkPlaces(prefix: string): LinkPlaces {
    const of = new Map<string, number>();
    for (const name of linkChannels) {
      const channel = this.frames.channel(`${prefix}.${name}`);
      if (channel >= 0) of.set(name, channel);
    }
    const path = this.pointChannels((k) => `${prefix}.path${k}_x`);
    return { body: -1, of, path, room: 0 };
  }
  private need(name: string): number {
    const channel = this.frames.channel(name);
    if (channel < 0) throw new Error(`the recording has no channel "${name}"`);
    return channel;
  }
}
