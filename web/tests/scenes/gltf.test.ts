// Animated glTF of scenes: valid without an error or a warning, and it moves as the bodies do.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import { validateBytes } from 'gltf-validator';

import { inFolder, scenePath, sceneNames, sheave } from './command';

interface Gltf {
  nodes: { name: string; translation?: number[] }[];
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
