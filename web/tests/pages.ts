// Pages for tests: a small machine that needs no engine, packed as the command packs.

import { deflateSync } from 'node:zlib';

import type { Machine } from '../src/machine';
import type { PackedChannel, RecordingHead } from '../src/recording';
import { checksum } from '../src/recording';

/** A wheel with a cable over it and a weight at one end that sinks. */
export function winch(): Machine {
  return {
    format: 'sheave-view/1',
    name: 'winch',
    description: 'a weight on a wheel',
    gravity: [0, -10, 0],
    dt: 0.1,
    duration: 1,
    bodies: [
      { name: 'wheel', mobility: 'rotor' },
      { name: 'weight', mobility: 'slider' },
    ],
    joints: [],
    cables: [
      {
        name: 'rope',
        closed: false,
        links: [
          { type: 'spool', body: 0, winding_room: 0 },
          { type: 'attachment', body: 1, winding_room: 0 },
        ],
        spans: 1,
        wraps: 0,
      },
    ],
    parts: [
      {
        body: 0,
        shape: { type: 'cylinder', radius: 0.5, length: 0.2 },
        position: [0, 0, 0],
        orientation: [1, 0, 0, 0],
        color: '#9aabbe',
      },
      {
        body: 1,
        shape: { type: 'box', size: [0.4, 0.4, 0.4] },
        position: [0, 0, 0],
        orientation: [1, 0, 0, 0],
        color: '#5d7fa3',
      },
    ],
    bars: [],
    joint_pieces: [],
    joint_unit: 0.02,
    cable_radius: 0.02,
    tension_max: 10,
    floor: null,
    camera: { position: [0, -1, 8], target: [0, -1, 0], up: [0, 1, 0], vertical_fov: 0.45 },
    camera_path: [],
    annotations: [],
    bounds: { min: [-0.7, -3, -0.3], max: [0.7, 0.5, 0.3] },
  };
}

const fixed = (value: number) => () => value;

/** The values of the winch's channels at a time. */
export function winchChannels(): { name: string; unit: string; hidden: boolean; at(t: number): number }[] {
  const depth = (t: number): number => -1 - t * t;
  const channel = (name: string, unit: string, at: (t: number) => number, hidden = false) => ({
    name, unit, hidden, at,
  });
  const pose = (body: string, x: number, y: (t: number) => number, angle: (t: number) => number) => [
    channel(`${body}.x`, 'm', fixed(x)),
    channel(`${body}.y`, 'm', y),
    channel(`${body}.z`, 'm', fixed(0)),
    channel(`${body}.qw`, '', (t) => Math.cos(0.5 * angle(t))),
    channel(`${body}.qx`, '', fixed(0)),
    channel(`${body}.qy`, '', fixed(0)),
    channel(`${body}.qz`, '', (t) => Math.sin(0.5 * angle(t))),
  ];
  const link = (prefix: string, radius: number, winding: number) => [
    channel(`${prefix}.radius`, 'm', fixed(radius), true),
    channel(`${prefix}.winding`, '', fixed(winding), true),
    ...['center_x', 'center_y', 'center_z', 'normal_x', 'normal_y'].map((n) =>
      channel(`${prefix}.${n}`, 'm', fixed(0), true),
    ),
    channel(`${prefix}.normal_z`, '', fixed(1), true),
    ...['entry', 'exit'].flatMap((n) => [
      channel(`${prefix}.${n}_x`, 'm', fixed(0.5)),
      channel(`${prefix}.${n}_y`, 'm', radius > 0 ? fixed(0) : depth),
      channel(`${prefix}.${n}_z`, 'm', fixed(0)),
    ]),
    channel(`${prefix}.stored_length`, 'm', (t) => (radius > 0 ? 3 - t * t : 0)),
    channel(`${prefix}.wrap_angle`, 'rad', (t) => (radius > 0 ? (3 - t * t) / radius : 0)),
  ];
  return [
    ...pose('wheel', 0, fixed(0), (t) => -2 * t * t),
    ...pose('weight', 0.5, depth, fixed(0)),
    channel('rope.0.tension', 'N', (t) => (t > 0 ? 8 + Math.sin(20 * t) : NaN)),
    channel('rope.0.length', 'm', (t) => 1 + t * t),
    channel('rope.0.rest_length', 'm', (t) => 1 + t * t),
    channel('rope.0.start_x', 'm', fixed(0.5), true),
    channel('rope.0.start_y', 'm', fixed(0), true),
    channel('rope.0.start_z', 'm', fixed(0), true),
    channel('rope.0.end_x', 'm', fixed(0.5), true),
    channel('rope.0.end_y', 'm', depth, true),
    channel('rope.0.end_z', 'm', fixed(0), true),
    ...link('rope.link0', 0.5, -1),
    ...link('rope.link1', 0, 0),
    channel('rope.wrap_count', '', fixed(0), true),
  ];
}

export const winchTimes = Array.from({ length: 11 }, (_, k) => k / 10);

/** A recording of doubles. */
export function packExact(machine: Machine): Uint8Array {
  const channels = winchChannels();
  const heads = channels.map(
    ({ name, unit, hidden, at }): PackedChannel => ({
      name,
      unit,
      hidden,
      packing: 'exact',
      missing: winchTimes.findIndex((t) => !Number.isNaN(at(t))),
    }),
  );
  const numbers = [
    ...winchTimes,
    ...channels.flatMap(({ at }, i) => winchTimes.slice(heads[i].missing).map(at)),
  ];
  const head: RecordingHead = {
    machine,
    events: [{ time: 0.5, kind: 'touch', text: 'half way' }],
    frames: winchTimes.length,
    channels: heads,
  };
  return joined(head, new Uint8Array(Float64Array.from(numbers).buffer));
}

export function joined(head: RecordingHead, stream: Uint8Array): Uint8Array {
  const text = new TextEncoder().encode(JSON.stringify(head));
  const bytes = new Uint8Array(4 + text.length + stream.length);
  new DataView(bytes.buffer).setUint32(0, text.length, true);
  bytes.set(text, 4);
  bytes.set(stream, 4 + text.length);
  return bytes;
}

export function filled(template: string, bytes: Uint8Array): string {
  const text = deflateSync(bytes).toString('base64');
  return template.replace(
    '<!--RECORDING-->',
    () => `<script type="text/plain" id="recording" data-checksum="${checksum(text)}">${text}</script>`,
  );
}
