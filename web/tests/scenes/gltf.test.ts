// Animated glTF of scenes: valid without an error or a warning, and it moves as the bodies do.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { inflateSync } from 'node:zlib';

import { validateBytes } from 'gltf-validator';

import { cableTubes } from '../../src/cable_path';
import { MachineState } from '../../src/machine_state';
import { unpack } from '../../src/recording';
import type { Quaternion, Vector3 } from '../../src/vector';
import { add, addScaled, dot, norm, rotate, scale, subtract } from '../../src/vector';
import { inFolder, scenePath, sceneNames, sheave } from './command';

interface Gltf {
  nodes: { name: string; translation?: number[]; rotation?: number[]; scale?: number[] }[];
  animations?: {
    channels: { sampler: number; target: { node: number; path: string } }[];
    samplers: { input: number; output: number }[];
  }[];
  accessors: { bufferView: number; byteOffset?: number; count: number }[];
  bufferViews: { byteOffset?: number }[];
}

/** The two parts of a .glb file. */
function parts(bytes: Buffer): { head: Gltf; data: Buffer } {
  const length = bytes.readUInt32LE(12);
  const head = JSON.parse(bytes.toString('utf8', 20, 20 + length)) as Gltf;
  return { head, data: bytes.subarray(20 + length + 8) };
}

function numbers({ head, data }: { head: Gltf; data: Buffer }, accessor: number, width: number): number[] {
  const { bufferView, byteOffset, count } = head.accessors[accessor];
  const start = (head.bufferViews[bufferView].byteOffset ?? 0) + (byteOffset ?? 0);
  return Array.from({ length: count * width }, (_, k) => data.readFloatLE(start + 4 * k));
}

for (const name of sceneNames()) {
  test(`${name}: glTF without an error or a warning`, { timeout: 300_000 }, () =>
    inFolder(async (folder) => {
      const path = join(folder, 'scene.glb');
      sheave('render', scenePath(name), '--quiet', '--fps', '10', '--glb', path);
      const report = await validateBytes(new Uint8Array(readFileSync(path)), { maxIssues: 5 });
      assert.equal(report.issues.numErrors, 0, JSON.stringify(report.issues.messages));
      assert.equal(report.issues.numWarnings, 0, JSON.stringify(report.issues.messages));
    }),
  );
}

test('bodies are at three times where the table has them', { timeout: 300_000 }, () =>
  inFolder(async (folder) => {
    const path = join(folder, 'scene.glb');
    const table = join(folder, 'table.csv');
    sheave('render', scenePath('paper/pulley'), '--quiet', '--fps', '10', '--glb', path);
    sheave('run', scenePath('paper/pulley'), '--quiet', '--out', table, '--columns', '*.[xyz]');
    const [heads, ...rows] = readFileSync(table, 'utf8').trimEnd().split('\n').map((l) => l.split(','));
    const glb = parts(readFileSync(path));
    const { animations, nodes } = glb.head;
    assert.ok(animations);
    let compared = 0;
    for (const { sampler, target } of animations[0].channels) {
      const column = heads.indexOf(`${nodes[target.node].name}.x`);
      if (target.path !== 'translation' || column < 0) continue;
      const { input, output } = animations[0].samplers[sampler];
      const times = numbers(glb, input, 1);
      const places = numbers(glb, output, 3);
      for (const k of [1, times.length >> 1, times.length - 1]) {
        const row = rows.find((r) => Math.abs(Number(r[0]) - times[k]) < 1e-6);
        assert.ok(row, `no row at ${times[k]}`);
        for (let i = 0; i < 3; ++i) {
          // Single precision.
          const expected = Number(row[column + i]);
          assert.ok(Math.abs(places[3 * k + i] - expected) <= 1e-6 * Math.max(1, Math.abs(expected)));
          compared += 1;
        }
      }
    }
    assert.ok(compared > 0);
  }),
);

/** The lines of cables as the page draws them at the start of a recording. */
function pageLines(path: string): { lines: Vector3[][]; radius: number } {
  const text = / id="recording"[^>]*>([^<]+)</.exec(readFileSync(path, 'utf8'))![1];
  const frames = unpack(new Uint8Array(inflateSync(Buffer.from(text, 'base64'))));
  const { machine } = frames;
  const state = new MachineState(frames);
  state.look(0);
  const style = {
    radius: machine.cable_radius, tensionMax: machine.tension_max, gravity: machine.gravity,
    floor: machine.floor, dark: false,
  };
  const tubes = machine.cables.flatMap((_, k) => cableTubes(state.cable(k), style));
  return { lines: tubes.map((t) => t.points), radius: style.radius };
}

/** Ends of the cylinders of which a line is made, in a machine whose up direction is y. */
function pieceEnds({ nodes }: Gltf, line: string): Vector3[] {
  const pieces = nodes.filter((n) => n.translation && new RegExp(`^${line} \\d+$`).test(n.name));
  return pieces.flatMap(({ translation, rotation, scale: size }) => {
    const [x, y, z, w] = rotation ?? [0, 0, 0, 1];
    const half = scale(rotate([w, x, y, z] as Quaternion, [0, 0, 1]), 0.5 * (size ?? [1, 1, 1])[2]);
    const middle = translation as Vector3;
    return [subtract(middle, half), add(middle, half)];
  });
}

function distanceToLine(point: Vector3, line: Vector3[]): number {
  let least = Infinity;
  for (let k = 1; k < line.length; ++k) {
    const along = subtract(line[k], line[k - 1]);
    const share = dot(subtract(point, line[k - 1]), along) / dot(along, along);
    const nearest = addScaled(line[k - 1], along, Math.min(Math.max(share, 0), 1));
    least = Math.min(least, norm(subtract(point, nearest)));
  }
  return least;
}

test('ropes with weight hang on the page as the renderer draws them', { timeout: 300_000 }, () =>
  inFolder(async (folder) => {
    const page = join(folder, 'page.html');
    const glb = join(folder, 'scene.glb');
    sheave('view', scenePath('analytic/hanging-ropes'), '--quiet', '--out', page);
    sheave('render', scenePath('analytic/hanging-ropes'), '--quiet', '--fps', '10', '--glb', glb);
    const { head } = parts(readFileSync(glb));
    const { lines, radius } = pageLines(page);
    // Places up to 105 m in single precision (6e-8), turns by quaternions of the same precision, and
    // the 5e-7 of the recording's lengths and forces. Both lines are polylines: chords are 3 % of
    // the cable's radius from it on the page, and 15 % in glTF.
    const tolerance = 1e-4 + 0.18 * radius;
    const names = [
      'level link 0 span', 'rising link 0 span', 'skyline link 0 span', 'skyline link 1 span', 'drop link 0 span',
    ];
    assert.equal(lines.length, names.length);
    names.forEach((name, k) => {
      const ends = pieceEnds(head, name);
      assert.ok(ends.length >= 2, `no line "${name}"`);
      for (const end of ends) assert.ok(distanceToLine(end, lines[k]) < tolerance, `${name}: ${end}`);
    });
    // The level rope of Irvine's example sags by far more than the tolerance.
    const lowest = Math.min(...lines[0].map((p) => p[1]));
    assert.ok(lowest < -6 && lowest > -6.5, `${lowest}`);
  }),
);
