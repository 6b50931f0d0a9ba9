// The page's parts without a browser: recordings, moments, cables as lines.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { cableTubes, woundAngle } from '../src/cable_path';
import { firstChoice } from '../src/chooser';
import { sample, slackColor, tensionColor, toCss } from '../src/color_map';
import { contrast, leastContrast, readable } from '../src/contrast';
import { csv } from '../src/exports';
import { legendTexts } from '../src/legend';
import { Frames } from '../src/frames';
import type { CableState } from '../src/machine_state';
import { MachineState } from '../src/machine_state';
import { numberText, quantityText } from '../src/numbers';
import { Player } from '../src/player';
import { slackCurve } from '../src/slack_curve';
import type { RecordingHead } from '../src/recording';
import { checksum, requireChecksum, unpack } from '../src/recording';
import { kindTexts } from '../src/timeline';
import type { Vector3 } from '../src/vector';
import { add, dot, norm, scale, subtract } from '../src/vector';
import { joined, packExact, winch, winchChannels, winchTimes } from './pages';

const near = (a: number, b: number, tolerance: number): void =>
  assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b} within ${tolerance}`);

function zigzag(values: number[]): number[] {
  const bytes: number[] = [];
  for (const value of values) {
    let z = value < 0 ? -2 * value - 1 : 2 * value;
    for (; z >= 128; z = Math.floor(z / 128)) bytes.push((z % 128) + 128);
    bytes.push(z);
  }
  return bytes;
}

test('every packing of a channel is read', () => {
  // Third differences of k^3 are 1, 5, 6, 6 after nothing; and a number beyond 32 bits.
  const head: RecordingHead = {
    machine: winch(),
    events: [],
    frames: 4,
    channels: [
      { name: 'a', unit: '', hidden: false, packing: 'constant', value: 0.1 },
      { name: 'b', unit: '', hidden: false, packing: 'steps', quantum: 0.5, order: 3 },
      { name: 'c', unit: '', hidden: false, packing: 'steps', quantum: 1, order: 0, missing: 2 },
      { name: 'd', unit: '', hidden: false, packing: 'steps', quantum: 1, order: 1 },
    ],
  };
  const times = new Uint8Array(Float64Array.from([0, 1, 2, 3]).buffer);
  const numbers = [0, 1, 5, 6, 2 ** 48 + 1, -(2 ** 48) - 1, 7, -3, 0, 1];
  const frames = unpack(joined(head, Uint8Array.from([...times, ...zigzag(numbers)])));
  assert.deepEqual([...frames.allTimes()], [0, 1, 2, 3]);
  assert.deepEqual([...frames.series(0)], [0.1, 0.1, 0.1, 0.1]);
  assert.deepEqual([...frames.series(1)], [0, 0.5, 4, 13.5]);
  assert.deepEqual([...frames.series(2)], [NaN, NaN, 2 ** 48 + 1, -(2 ** 48) - 1]);
  assert.deepEqual([...frames.series(3)], [7, 4, 4, 5]);
});

test('a recording that is cut off, or too long, is refused', () => {
  const bytes = packExact(winch());
  assert.throws(() => unpack(bytes.subarray(0, bytes.length - 3)));
  const longer = new Uint8Array(bytes.length + 1);
  longer.set(bytes);
  assert.throws(() => unpack(longer), /longer/);
});

test('a recording of which one byte is another is refused', () => {
  assert.equal(checksum(''), '811c9dc5');
  assert.equal(checksum('a'), 'e40c292c'); // as the authors of FNV-1a publish it
  const text = btoa(String.fromCharCode(...packExact(winch()).subarray(0, 900)));
  const written = checksum(text);
  requireChecksum(text, written);
  for (let k = 0; k < text.length; ++k) {
    for (const other of ['A', 'B', '/', '=', ' ', '\n']) {
      if (other === text[k]) continue;
      assert.throws(() => requireChecksum(text.slice(0, k) + other + text.slice(k + 1), written), /has been changed/);
    }
  }
  assert.throws(() => requireChecksum(text, undefined), /must be there/);
});

test('frames that are pushed are those that are read', () => {
  const frames = new Frames(winch(), [
    { name: 'a', unit: 'm', hidden: false },
    { name: 'b', unit: '', hidden: true },
  ]);
  for (let k = 0; k < 200; ++k) frames.push(0.1 * k, [k, -k]);
  assert.equal(frames.count, 200);
  assert.equal(frames.series(frames.channel('b'))[137], -137);
  assert.equal(frames.frameAt(0.1 * 50), 50);
  assert.equal(frames.frameAt(0.1 * 50 + 0.05), 50);
  assert.equal(frames.frameAt(-1), 0);
  assert.equal(frames.frameAt(1e9), 199);
  frames.truncate(10);
  assert.equal(frames.count, 10);
  assert.throws(() => frames.push(1, [1]));
  assert.equal(csv(frames, []).split('\n')[1], '0,0');
});

test('moments: exact at frames, between them half way, forces of the start those of the first step', () => {
  const frames = unpack(packExact(winch()));
  const state = new MachineState(frames);
  const channels = winchChannels();
  for (const t of winchTimes) {
    state.look(t);
    channels.forEach((channel, i) => {
      const value = channel.at(t);
      if (!Number.isNaN(value)) assert.equal(state.values[i], value, channel.name);
    });
  }
  state.look(0.55);
  near(state.pose(1).position[1], 0.5 * (-1.25 - 1.36), 1e-15);
  // Turned by the mean of both angles.
  near(2 * Math.atan2(state.pose(0).orientation[3], state.pose(0).orientation[0]), -(0.25 + 0.36), 1e-12);
  state.look(0);
  near(state.cable(0).spans[0].tension, 8 + Math.sin(2), 1e-15);
});

test('a cable is drawn from its drum to its end, as long as it is', () => {
  const state = new MachineState(unpack(packExact(winch())));
  state.look(0.5);
  const cable = state.cable(0);
  near(woundAngle(cable.links[0], true), 2.75 / 0.5, 1e-12);
  const style = {
    radius: 0.02, tensionMax: 10, gravity: [0, -10, 0] as [number, number, number], floor: null, dark: false,
  };
  const tubes = cableTubes(cable, style);
  assert.equal(tubes.length, 1);
  const { points } = tubes[0];
  let length = 0;
  for (let k = 1; k < points.length; ++k) length += norm(subtract(points[k], points[k - 1]));
  const whole = 2.75 + 1.25;
  // Chords with a sagitta of 3 % of 0.02 m on 0.5 m are shorter than their arcs by a third of its share.
  assert.ok(length <= whole && length > whole * (1 - (0.03 * 0.02) / 0.5 / 3), `${length}`);
  near(norm(subtract(points[points.length - 1], [0.5, -1.25, 0])), 0, 1e-12);
});

test('a rope with weight is the catenary of its forces, and straight without gravity', () => {
  // y = a cosh(x / a) with a = H / w = 5 m, from x = -3 m to 4 m; s = a sinh(x / a).
  const a = 5;
  const density = 2;
  const place = (x: number): Vector3 => [x, a * Math.cosh(x / a), 0];
  const length = a * (Math.sinh(4 / a) - Math.sinh(-3 / a));
  const force = (x: number, sign: number): Vector3 => [
    sign * 10 * density * a, sign * 10 * density * a * Math.sinh(x / a), 0,
  ];
  const start = place(-3);
  const end = place(4);
  const point = { body: -1, normal: [0, 0, 1] as Vector3, radius: 0, winding: 0, path: [], storedLength: 0, wrapAngle: 0, room: 0 };
  const cable: CableState = {
    closed: false, cut: false, pieces: [],
    links: [start, end].map((p) => ({ ...point, center: p, entry: p, exit: p })),
    spans: [{
      start, end, length: norm(subtract(end, start)), restLength: length, tension: 100,
      forces: { start: force(-3, 1), end: force(4, -1) }, floor: null, listed: 0,
    }],
  };
  // The force of the rope on its end is opposite to that of the end on the rope: the sum is the weight.
  near(cable.spans[0].forces!.start[1] + cable.spans[0].forces!.end[1], -10 * density * length, 1e-9);
  const style = { radius: 0.01, tensionMax: 100, gravity: [0, -10, 0] as Vector3, floor: null, dark: false };
  const { points } = cableTubes(cable, style)[0];
  assert.ok(points.length > 10);
  for (const p of points) near(p[1], a * Math.cosh(p[0] / a), 1e-12);
  for (let k = 1; k < points.length; ++k) {
    const middle = scale(add(points[k - 1], points[k]), 0.5);
    assert.ok(middle[1] - a * Math.cosh(middle[0] / a) < 0.03 * style.radius);
  }
  near(norm(subtract(points[points.length - 1], end)), 0, 1e-12);
  cable.spans[0].forces = { start: [1, 0, 0], end: [-1, 0, 0] };
  assert.deepEqual(cableTubes(cable, style)[0].points, [start, end]);
});

test('a rope with weight on a floor hangs from its ends and lies between', () => {
  const [a, w] = [4, 10]; // H = w a
  const hung = (s: number): [number, number] => [a * Math.asinh(s / a), Math.hypot(a, s) - a];
  const [first, second] = [hung(3), hung(5)];
  const start: Vector3 = [0, first[1], 0];
  const end: Vector3 = [first[0] + 6 + second[0], second[1], 0];
  const point = { body: -1, normal: [0, 0, 1] as Vector3, radius: 0, winding: 0, path: [], storedLength: 0, wrapAngle: 0, room: 0 };
  const cable: CableState = {
    closed: false, cut: false, pieces: [],
    links: [start, end].map((p) => ({ ...point, center: p, entry: p, exit: p })),
    spans: [{
      start, end, length: norm(subtract(end, start)), restLength: 14, tension: 100,
      forces: { start: [w * a, -w * 3, 0], end: [-w * a, -w * 5, 0] },
      floor: { length: 6, start: [first[0], 0, 0], end: [first[0] + 6, 0, 0] }, listed: 0,
    }],
  };
  const style = { radius: 0.01, tensionMax: 100, gravity: [0, -10, 0] as Vector3, floor: null, dark: false };
  const { points } = cableTubes(cable, style)[0];
  assert.ok(points.length > 20);
  for (const p of points) {
    const beyond = Math.max(first[0] - p[0], p[0] - first[0] - 6, 0);
    near(p[1], a * (Math.cosh(beyond / a) - 1), 1e-12);
  }
  near(norm(subtract(points[points.length - 1], end)), 0, 1e-12);
});

test('a cut cable is drawn along the recorded lines of its pieces', () => {
  const line: Vector3[] = [[0, 0, 0], [0, -1, 0], [0.5, -1.5, 0]];
  const cable: CableState = { closed: true, cut: true, pieces: [line, []], links: [], spans: [] };
  const style = { radius: 0.01, tensionMax: 1, gravity: [0, -10, 0] as Vector3, floor: null, dark: false };
  const tubes = cableTubes(cable, style);
  assert.deepEqual(tubes.map((tube) => tube.points), [line]);
  assert.deepEqual(tubes[0].colors, line.map(() => slackColor));
});

test('a hanging cable has its length, its ends, and is lowest in the middle', () => {
  const points = slackCurve([0, 0, 0], [1, 0, 0], 2, [0, -10, 0], 1e-6);
  let length = 0;
  for (let k = 1; k < points.length; ++k) length += norm(subtract(points[k], points[k - 1]));
  // sinh(q)/q = 2 has q = 2.1773; the sag is then (cosh(q) - 1) / (2 q).
  const q = 2.1773189849653067;
  near(length, 2, 1e-3);
  near(Math.min(...points.map((p) => p[1])), -(Math.cosh(q) - 1) / (2 * q), 1e-6);
  near(dot(points[points.length - 1], [1, 0, 0]), 1, 1e-15);
});

test('units have the prefixes of stills', () => {
  // As quantity_text() and unit_scale() of the renderer.
  assert.equal(quantityText(76400, 'N'), '76.4 kN');
  assert.equal(quantityText(9999, 'N'), '9999 N');
  assert.equal(quantityText(0.05, 'm'), '50 mm');
  assert.equal(quantityText(-2.5e7, 'J'), '-25 MJ');
  assert.equal(quantityText(3e5, 's'), '300000 s');
  assert.equal(quantityText(12345, 'N m'), '12.345 kN m');
  assert.equal(quantityText(5e4, 'rad/s'), '50000 rad/s');
  assert.equal(quantityText(5e4, ''), '50000');
  assert.equal(quantityText(0, 'N'), '0 N');
  assert.equal(quantityText(NaN, 'N'), '–');
  assert.deepEqual(legendTexts(80000), { heading: 'tension [kN]', ticks: ['0', '40', '80'] });
});

test('the first curves are those that vary most, and no two coincide', () => {
  const curves: ((t: number) => number)[] = [
    () => 5,
    (t) => 10 + Math.sin(t),
    (t) => 10 + 1.005 * Math.sin(t),
    (t) => 100 * t,
    ...[1, 2, 3, 4, 5, 6].map((k) => (t: number) => k * 0.1 * t * t + k),
  ];
  const machine = winch();
  machine.cables[0].spans = curves.length;
  const channels = curves.map((_, k) => ({ name: `rope.${k}.tension`, unit: 'N', hidden: false }));
  const frames = new Frames(machine, channels);
  const times = Float64Array.from({ length: 50 }, (_, k) => k / 10);
  // The first value is unknown.
  frames.adopt(times, curves.map((f) => times.map((t, k) => (k === 0 ? NaN : f(t)))));
  // Ranges of the last six: 2.5 to 15 N; the sines have 2 N.
  assert.deepEqual(firstChoice(frames), [3, 5, 6, 7, 8, 9].map((k) => `rope.${k}.tension`));
  machine.cables[0].spans = 4;
  assert.deepEqual(firstChoice(frames), ['rope.2.tension', 'rope.3.tension']);
  machine.cables[0].spans = 1;
  assert.deepEqual(firstChoice(frames), ['rope.0.tension']);
});

test('contrast is that of WCAG, and curves reach the least one on dark and on light', () => {
  near(contrast('#000000', '#ffffff'), 21, 1e-12);
  near(contrast('#777777', '#ffffff'), 4.48, 5e-3); // as the authors of WCAG tell of this grey
  assert.equal(contrast('#123456', '#123456'), 1);
  assert.ok(contrast('#0072b2', '#222933') < leastContrast);
  for (const color of ['#0072b2', '#d55e00', '#7a7a7a', '#000000']) {
    assert.ok(contrast(readable(color, '#222933'), '#222933') >= leastContrast, color);
  }
  assert.equal(readable('#e69f00', '#222933'), '#e69f00');
  const colors = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#7a7a7a'];
  const onWhite = colors.map((color) => readable(color, '#ffffff'));
  for (const color of onWhite) assert.ok(contrast(color, '#ffffff') >= leastContrast, color);
  assert.equal(new Set(onWhite).size, colors.length);
  assert.equal(readable('#0072b2', '#ffffff'), '#0072b2');
});

test('colours: a scale of its own for slack, and lightness that only rises', () => {
  assert.deepEqual(tensionColor(0, 10), slackColor);
  assert.deepEqual(tensionColor(NaN, 10), slackColor);
  assert.equal(toCss(sample(0)), '#2b0594');
  assert.equal(toCss(sample(2)), '#f79342');
  for (const dark of [false, true]) {
    let before = 0;
    for (let k = 0; k <= 64; ++k) {
      const linear = sample(k / 64, dark).map((c) => ((c + 0.055) / 1.055) ** 2.4);
      const luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
      assert.ok(luminance > before, `${k}`);
      before = luminance;
    }
  }
});

test('the player stops at the end, goes round in a loop, and changes speed by known steps', () => {
  const player = new Player();
  player.setRange(0, 1);
  player.tick(0);
  player.play();
  player.tick(50);
  near(player.time, 0.05, 1e-12);
  player.changeSpeed(1);
  assert.equal(player.speed, 2);
  player.seek(0.99);
  player.tick(100);
  assert.equal(player.time, 1);
  assert.equal(player.playing, false);
  player.setLoop(true);
  player.seek(0.95);
  player.play();
  player.tick(150);
  near(player.time, 0.05, 1e-12);
});

test('a still is shown until something is played, from the beginning', () => {
  const player = new Player();
  player.setRange(1, 3);
  player.showStill(2.5);
  assert.equal(player.time, 2.5);
  player.play();
  assert.equal(player.time, 1);
  player.pause();
  player.seek(2);
  player.play();
  assert.equal(player.time, 2);
});

test('slow pictures skip frames, and a hidden page does not play on', () => {
  const player = new Player();
  player.setRange(0, 10);
  player.tick(0);
  player.play();
  // Three pictures of 400 ms: playback is as far as the clock.
  for (const now of [400, 800, 1200]) player.tick(now);
  near(player.time, 1.2, 1e-12);
  player.skipPause();
  player.tick(60_000);
  near(player.time, 1.2, 1e-12);
  player.tick(60_100);
  near(player.time, 1.3, 1e-12);
  // The browser slept without saying so.
  player.tick(160_100);
  near(player.time, 3.3, 1e-12);
});

test('the legend of events names triggers and counts all others', () => {
  const set = (name: string) => ({ time: 0, kind: 'set', text: `trigger ${name}: set` });
  const touch = { time: 1, kind: 'touch', text: 'cable rope: touch at link 2 on post' };
  assert.deepEqual(kindTexts([set('go: slow'), touch, set('stop'), touch, set('stop')]), [
    { kind: 'set', text: 'set: go: slow, stop' },
    { kind: 'touch', text: 'touch (2)' },
  ]);
  const many = kindTexts(['a', 'b', 'c', 'd', 'e', 'f'].map(set));
  assert.equal(many[0].text, 'set: a, b, c, d and 2 more');
  assert.deepEqual(kindTexts([]), []);
});

test('numbers for people', () => {
  assert.equal(numberText(12.857143), '12.857');
  assert.equal(numberText(0), '0');
  assert.equal(numberText(NaN), '–');
  assert.equal(numberText(1.5e-5), '1.5e-5');
  assert.equal(numberText(-123456.7), '-123460');
});
