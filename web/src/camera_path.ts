// The camera of a film, as render/camera_path.cpp has it: it rests at each keyframe and moves
// smoothly from one to the next.

import * as THREE from 'three';

import type { Camera, CameraKey } from './machine';
import type { Vector3 } from './vector';

const ratio = (a: number, b: number, s: number): number => a * (b / a) ** s;

/** The rotation whose columns are the directions to the right, up and to the eye. */
function turnOf(camera: Camera): THREE.Quaternion {
  const view = new THREE.Matrix4().lookAt(
    new THREE.Vector3(...camera.position),
    new THREE.Vector3(...camera.target),
    new THREE.Vector3(...camera.up),
  );
  return new THREE.Quaternion().setFromRotationMatrix(view);
}

const distanceOf = (camera: Camera): number =>
  Math.hypot(...camera.position.map((x, k) => x - camera.target[k]));

function between(a: Camera, b: Camera, s: number): Camera {
  const turn = turnOf(a).slerp(turnOf(b), s);
  const distance = ratio(distanceOf(a), distanceOf(b), s);
  const target = a.target.map((x, k) => (1 - s) * x + s * b.target[k]) as Vector3;
  const back = new THREE.Vector3(0, 0, distance).applyQuaternion(turn);
  const up = new THREE.Vector3(0, 1, 0).applyQuaternion(turn);
  const camera: Camera = {
    position: [target[0] + back.x, target[1] + back.y, target[2] + back.z],
    target,
    up: [up.x, up.y, up.z],
  };
  if (a.vertical_fov !== undefined && b.vertical_fov !== undefined) {
    const tangent = ratio(Math.tan(0.5 * a.vertical_fov), Math.tan(0.5 * b.vertical_fov), s);
    camera.vertical_fov = 2 * Math.atan(tangent);
  }
  if (a.height !== undefined && b.height !== undefined) camera.height = ratio(a.height, b.height, s);
  return camera;
}

/** The camera at a time [s]; at least one keyframe. */
export function cameraAt(keys: readonly CameraKey[], time: number): Camera {
  const next = keys.findIndex((key) => key.time > time);
  if (next === 0) return keys[0];
  if (next < 0) return keys[keys.length - 1];
  const [a, b] = [keys[next - 1], keys[next]];
  const u = (time - a.time) / (b.time - a.time);
  return between(a, b, u * u * (3 - 2 * u));
}
