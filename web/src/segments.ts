// Many straight round pieces of lines, drawn together, and found again under the pointer.

import * as THREE from 'three';

import type { Color } from './color_map';
import type { Vector3 } from './vector';

/** The owner of a piece. */
export interface Tag {
  kind: 'span' | 'joint' | 'cable';
  /** Index of the cable or joint. */
  index: number;
  /** Index of the span within its cable. */
  span: number;
}

/** Share of unlit colour, so that the colours match the legend. */
const flatness = 0.62;

export class Segments {
  private capacity = 256;
  private count = 0;
  private ends: Float32Array = new Float32Array(6 * this.capacity);
  private tags: Tag[] = [];
  private current: THREE.InstancedMesh;
  private readonly group: THREE.Object3D;
  private readonly geometry: THREE.BufferGeometry;
  private readonly material: THREE.MeshLambertMaterial;

  constructor(group: THREE.Object3D) {
    this.group = group;
    this.geometry = new THREE.CylinderGeometry(1, 1, 1, 10, 1, false);
    this.material = new THREE.MeshLambertMaterial({ color: 0xffffff });
    this.material.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace(
        '#include <opaque_fragment>',
        `outgoingLight = mix(outgoingLight, diffuseColor.rgb, ${flatness});
        #include <opaque_fragment>`,
      );
    };
    this.current = this.make();
  }

  begin(): void {
    this.count = 0;
    this.tags.length = 0;
  }

  add(a: Vector3, b: Vector3, radius: number, color: Color, tag: Tag): void {
    const dx = b[0] - a[0];
    const dy = b[1] - a[1];
    const dz = b[2] - a[2];
    const length = Math.hypot(dx, dy, dz);
    if (!(length > 0)) return;
    if (this.count === this.capacity) this.grow();
    const k = this.count++;
    this.ends.set(a, 6 * k);
    this.ends.set(b, 6 * k + 3);
    this.tags.push(tag);
    // The columns of a scaled rotation that turns y to the line; the two other directions are
    // arbitrary.
    const u: Vector3 = [dx / length, dy / length, dz / length];
    const v: Vector3 = Math.abs(u[0]) < 0.7 ? [0, u[2], -u[1]] : [-u[2], 0, u[0]];
    const n = Math.hypot(v[0], v[1], v[2]);
    for (let i = 0; i < 3; ++i) v[i] /= n;
    const w: Vector3 = [
      v[1] * u[2] - v[2] * u[1],
      v[2] * u[0] - v[0] * u[2],
      v[0] * u[1] - v[1] * u[0],
    ];
    const m = this.current.instanceMatrix.array;
    const o = 16 * k;
    // Slightly longer, so that pieces meet without a gap where the line bends.
    const long = length + 0.1 * radius;
    for (let i = 0; i < 3; ++i) {
      m[o + i] = v[i] * radius;
      m[o + 4 + i] = u[i] * long;
      m[o + 8 + i] = w[i] * radius;
      m[o + 12 + i] = 0.5 * (a[i] + b[i]);
    }
    m[o + 3] = m[o + 7] = m[o + 11] = 0;
    m[o + 15] = 1;
    scratch.setRGB(color[0], color[1], color[2], THREE.SRGBColorSpace);
    this.current.setColorAt(k, scratch);
  }

  end(): void {
    const mesh = this.current;
    mesh.count = this.count;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }

  /**
   * The piece nearest to a point of the picture and within `reach` of it; all in pixels. `matrix`
   * transforms world points to clip coordinates.
   */
  nearest(
    x: number,
    y: number,
    reach: number,
    matrix: THREE.Matrix4,
    width: number,
    height: number,
  ): { tag: Tag; distance: number; point: Vector3 } | null {
    let best: { tag: Tag; distance: number; point: Vector3 } | null = null;
    const a = new THREE.Vector4();
    const b = new THREE.Vector4();
    for (let k = 0; k < this.count; ++k) {
      const e = this.ends.subarray(6 * k, 6 * k + 6);
      a.set(e[0], e[1], e[2], 1).applyMatrix4(matrix);
      b.set(e[3], e[4], e[5], 1).applyMatrix4(matrix);
      if (a.w <= 0 || b.w <= 0) continue;
      const ax = (0.5 + (0.5 * a.x) / a.w) * width;
      const ay = (0.5 - (0.5 * a.y) / a.w) * height;
      const bx = (0.5 + (0.5 * b.x) / b.w) * width;
      const by = (0.5 - (0.5 * b.y) / b.w) * height;
      const lengthSquared = (bx - ax) ** 2 + (by - ay) ** 2;
      const along = lengthSquared > 0 ? ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / lengthSquared : 0;
      const t = Math.min(Math.max(along, 0), 1);
      const distance = Math.hypot(ax + t * (bx - ax) - x, ay + t * (by - ay) - y);
      if (distance > reach || (best && distance >= best.distance)) continue;
      const mix = (i: number): number => e[i] + t * (e[i + 3] - e[i]);
      best = { tag: this.tags[k], distance, point: [mix(0), mix(1), mix(2)] };
    }
    return best;
  }

  dispose(): void {
    this.current.dispose();
    this.geometry.dispose();
    this.material.dispose();
  }

  private make(): THREE.InstancedMesh {
    const mesh = new THREE.InstancedMesh(this.geometry, this.material, this.capacity);
    mesh.frustumCulled = false;
    mesh.castShadow = true;
    mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    this.group.add(mesh);
    return mesh;
  }
  private grow(): void {
    const old = this.current;
    this.capacity *= 2;
    const ends = new Float32Array(6 * this.capacity);
    ends.set(this.ends);
    this.ends = ends;
    this.current = this.make();
    this.current.instanceMatrix.array.set(old.instanceMatrix.array);
    this.current.setColorAt(0, scratch);
    if (old.instanceColor) this.current.instanceColor!.array.set(old.instanceColor.array);
    this.group.remove(old);
    old.dispose();
  }
}

const scratch = new THREE.Color();
