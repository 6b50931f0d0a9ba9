// The surfaces of shapes, with a colour per vertex that multiplies the body's colour: the same
// solids as in render/solid_mesh.cpp and render/sheave_mesh.cpp.

import * as THREE from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';

import type { Shape } from './machine';

type Sheave = Extract<Shape, { type: 'sheave' }>;
type Profile = [radius: number, z: number][];

const white = new THREE.Color(1, 1, 1);
const groove = new THREE.Color(0xcdd0d6);
const pin = new THREE.Color(0x5a5c62);
/** Colour of the spoke that makes rotation visible on a wheel of any colour. */
const accent = new THREE.Color(0x2c3a4c);

export function geometryOf(shape: Shape): THREE.BufferGeometry {
  switch (shape.type) {
    case 'box':
      return painted(new THREE.BoxGeometry(...shape.size), white);
    case 'sphere':
      return painted(new THREE.SphereGeometry(shape.radius, 40, 24), white);
    case 'cylinder':
      return painted(upright(new THREE.CylinderGeometry(shape.radius, shape.radius, shape.length, 64)), white);
    case 'capsule':
      return painted(upright(new THREE.CapsuleGeometry(shape.radius, shape.length, 12, 40)), white);
    case 'sheave':
      return sheaveGeometry(shape);
    case 'mesh':
      return painted(meshGeometry(shape.vertices, shape.triangles), white);
  }
}

/** The axis of three.js cylinders is y; here it is z. */
function upright(geometry: THREE.BufferGeometry): THREE.BufferGeometry {
  return geometry.rotateX(Math.PI / 2);
}

function painted(geometry: THREE.BufferGeometry, color: THREE.Color): THREE.BufferGeometry {
  const made = geometry.index ? geometry.toNonIndexed() : geometry;
  made.deleteAttribute('uv');
  const count = made.getAttribute('position').count;
  const colors = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) color.toArray(colors, 3 * i);
  made.setAttribute('color', new THREE.BufferAttribute(colors, 3));
  return made;
}

function meshGeometry(
  vertices: [number, number, number][],
  triangles: [number, number, number][],
): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(vertices.flat(), 3));
  geometry.setIndex(triangles.flat());
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

/** A profile rotated about z; each of its straight pieces is shaded separately. */
function revolved(profile: Profile, segments: number, color: THREE.Color): THREE.BufferGeometry {
  const pieces: THREE.BufferGeometry[] = [];
  for (let k = 0; k + 1 < profile.length; ++k) {
    const points = [profile[k], profile[k + 1]].map(([r, z]) => new THREE.Vector2(r, z));
    pieces.push(painted(upright(new THREE.LatheGeometry(points, segments)), color));
  }
  return mergeGeometries(pieces);
}

/** A bar from the hub to the rim, tapering outwards. */
function spoke(
  angle: number,
  from: number,
  to: number,
  width: number,
  half: number,
  color: THREE.Color,
): THREE.BufferGeometry {
  const outline = new THREE.Shape([
    new THREE.Vector2(from, -0.5 * width),
    new THREE.Vector2(to, -0.36 * width),
    new THREE.Vector2(to, 0.36 * width),
    new THREE.Vector2(from, 0.5 * width),
  ]);
  const bar = new THREE.ExtrudeGeometry(outline, { depth: 2 * half, bevelEnabled: false });
  bar.translate(0, 0, -half).rotateZ(angle);
  bar.clearGroups();
  return painted(bar, color);
}

function sheaveGeometry(s: Sheave): THREE.BufferGeometry {
  const half = 0.5 * s.length;
  const cable = Math.min(s.cable_radius, 0.35 * s.radius);
  const flange = s.radius - 0.3 * cable;
  const depth = 0.7 * cable;
  const widest = 0.84 * half;
  const floor = Math.min(0.5 * s.groove_width, widest);
  const lip = Math.min(floor + 1.05 * s.cable_radius, widest);
  const inner = 0.86 * (flange - depth);
  const hub = 0.24 * s.radius;
  const axle = 0.1 * s.radius;
  const segments = 72;
  const round: Profile = [];
  for (let k = 0; k <= 8; ++k) {
    const angle = (Math.PI * k) / 8;
    const side = k < 4 ? -floor : floor;
    if (k === 4 && floor > 0) round.push([flange - depth, -floor]);
    round.push([flange - depth * Math.sin(angle), side - (lip - floor) * Math.cos(angle)]);
  }
  const pieces = [
    revolved([[inner, -half], [flange, -half], [flange, -lip]], segments, white),
    revolved(depth > 0 ? round : [[flange, -lip], [flange, lip]], segments, groove),
    revolved([[flange, lip], [flange, half], [inner, half]], segments, white),
    revolved([[inner, half], [inner, -half]], segments, white),
  ];
  const z = 0.96 * half;
  pieces.push(revolved([[axle, -z], [hub, -z], [hub, z], [axle, z]], 40, white));
  const out = half + 0.35 * axle;
  pieces.push(revolved([[0, -out], [axle, -out], [axle, out], [0, out]], 24, pin));
  const reach = inner + 0.02 * flange;
  if (s.spokes <= 0) {
    pieces.push(revolved([[hub, -0.5 * half], [inner, -0.5 * half]], segments, white));
    pieces.push(revolved([[inner, 0.5 * half], [hub, 0.5 * half]], segments, white));
    pieces.push(spoke(0, 0.9 * hub, reach, 0.7 * hub, 0.6 * half, accent));
  }
  const width = Math.min((0.8 * 2 * Math.PI * hub) / s.spokes, 0.85 * hub);
  for (let k = 0; k < s.spokes; ++k) {
    const angle = (2 * Math.PI * k) / s.spokes;
    pieces.push(spoke(angle, 0.9 * hub, reach, width, 0.6 * half, k === 0 ? accent : white));
  }
  return mergeGeometries(pieces);
}
