// The camera of a film and its texts. The closed forms are those of tests/render/camera_path_test.cpp.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { isShown, shownText } from '../src/annotations';
import { cameraAt } from '../src/camera_path';
import type { Annotation, CameraKey } from '../src/machine';
import type { Vector3 } from '../src/vector';

const key = (time: number, position: Vector3, more: Partial<CameraKey> = {}): CameraKey => ({
  time, position, target: [1, 2, 3], up: [0, 1, 0], vertical_fov: 0.5, ...more,
});
const near = (a: readonly number[], b: readonly number[]): void =>
  a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) < 1e-9, `${a} is not ${b}`));

test('the camera rests at keyframes and goes round a target at the same distance', () => {
  const keys = [key(0, [1, 2, 7]), key(2, [5, 2, 3])];
  near(cameraAt(keys, -1).position, [1, 2, 7]);
  near(cameraAt(keys, 9).position, [5, 2, 3]);
  for (let k = 0; k <= 10; ++k) {
    const u = 0.1 * k;
    const angle = 0.5 * Math.PI * u * u * (3 - 2 * u);
    const camera = cameraAt(keys, 2 * u);
    near(camera.position, [1 + 4 * Math.sin(angle), 2, 3 + 4 * Math.cos(angle)]);
    near(camera.up, [0, 1, 0]);
  }
});

test('distance, angle and height change by equal ratios', () => {
  const keys = [key(0, [1, 2, 4]), key(1, [1, 2, 7], { vertical_fov: 2 * Math.atan(4 * Math.tan(0.25)) })];
  const camera = cameraAt(keys, 0.5);
  near(camera.position, [1, 2, 5]);
  near([camera.vertical_fov ?? 0], [2 * Math.atan(2 * Math.tan(0.25))]);
  const flat = [key(0, [1, 2, 4], { height: 8 }), key(1, [1, 2, 4], { height: 2 })];
  near([cameraAt(flat, 0.5).height ?? 0], [4]);
});

test('texts are shown from their first to their last time', () => {
  const texts: Annotation[] = [
    { kind: 'caption', text: 'all the time', from: 0 },
    { kind: 'caption', text: 'between', from: 1, to: 2 },
    { kind: 'title', text: 'title', from: 1 },
  ];
  assert.ok(isShown(texts[1], 1 - 1e-15));
  assert.ok(!isShown(texts[1], 2.01));
  assert.equal(shownText(texts, 'caption', 0.5), 'all the time');
  assert.equal(shownText(texts, 'caption', 1.5), 'between');
  assert.equal(shownText(texts, 'caption', 3), 'all the time');
  assert.equal(shownText(texts, 'title', 0), '');
});
