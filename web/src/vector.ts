// Vectors of three numbers and unit quaternions (w, x, y, z), as values.

export type Vector3 = [number, number, number];
/** w, x, y, z; unit length. */
export type Quaternion = [number, number, number, number];

export const add = (a: Vector3, b: Vector3): Vector3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vector3, b: Vector3): Vector3 => [
  a[0] - b[0],
  a[1] - b[1],
  a[2] - b[2],
];
export const scale = (a: Vector3, s: number): Vector3 => [a[0] * s, a[1] * s, a[2] * s];
/** a + s b */
export const addScaled = (a: Vector3, b: Vector3, s: number): Vector3 => [
  a[0] + s * b[0],
  a[1] + s * b[1],
  a[2] + s * b[2],
];
export const dot = (a: Vector3, b: Vector3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector3, b: Vector3): Vector3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const norm = (a: Vector3): number => Math.hypot(a[0], a[1], a[2]);
/** The zero vector stays zero. */
export const normalized = (a: Vector3): Vector3 => {
  const length = norm(a);
  return length > 0 ? scale(a, 1 / length) : [0, 0, 0];
};

/** A unit vector perpendicular to `a`, which must not be zero. */
export function anyPerpendicular(a: Vector3): Vector3 {
  const size = a.map(Math.abs);
  const least = size.indexOf(Math.min(...size));
  const axis: Vector3 = [0, 0, 0];
  axis[least] = 1;
  return normalized(cross(a, axis));
}

export function rotate(q: Quaternion, v: Vector3): Vector3 {
  const u: Vector3 = [q[1], q[2], q[3]];
  const t = scale(cross(u, v), 2);
  return add(addScaled(v, t, q[0]), cross(u, t));
}

export const multiply = (a: Quaternion, b: Quaternion): Quaternion => [
  a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
  a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
  a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
  a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
];

/** The rotation at the fraction t between a and b, on the shorter way. */
export function slerp(a: Quaternion, b: Quaternion, t: number): Quaternion {
  let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = cosine < 0 ? -1 : 1;
  cosine = Math.min(1, Math.abs(cosine));
  const angle = Math.acos(cosine);
  const sine = Math.sin(angle);
  const from = sine > 1e-6 ? Math.sin((1 - t) * angle) / sine : 1 - t;
  const to = sign * (sine > 1e-6 ? Math.sin(t * angle) / sine : t);
  const q: Quaternion = [0, 0, 0, 0];
  for (let i = 0; i < 4; ++i) q[i] = from * a[i] + to * b[i];
  const length = Math.hypot(...q);
  for (let i = 0; i < 4; ++i) q[i] /= length;
  return q;
}
