// The ground, or a floor for shadows. It is visible from above only and has a grid that fades with
// distance.

import * as THREE from 'three';

import type { Machine } from './machine';

const vertex = `
varying vec2 place;
void main() {
  place = position.xy;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const fragment = `
varying vec2 place;
uniform vec3 ground;
uniform vec3 line;
uniform float spacing;
uniform float radius;
void main() {
  vec2 grid = place / spacing;
  vec2 change = max(fwidth(grid), vec2(1e-6));
  vec2 near = abs(fract(grid - 0.5) - 0.5) / change;
  vec2 drawn = (1.0 - smoothstep(0.3, 1.3, near)) * (1.0 - smoothstep(0.12, 0.5, change));
  float fade = 1.0 - smoothstep(0.25, 1.0, length(place) / radius);
  gl_FragColor = vec4(mix(ground, line, max(drawn.x, drawn.y)), fade);
  #include <colorspace_fragment>
}`;

export class Floor {
  readonly object = new THREE.Group();
  private readonly uniforms = {
    ground: { value: new THREE.Color() },
    line: { value: new THREE.Color() },
    spacing: { value: 1 },
    radius: { value: 1 },
  };
  private readonly shade: THREE.ShadowMaterial;

  constructor(floor: NonNullable<Machine['floor']>, bounds: Machine['bounds']) {
    const min = new THREE.Vector3(...bounds.min);
    const max = new THREE.Vector3(...bounds.max);
    const radius = 2.5 * Math.max(min.distanceTo(max), 1e-9);
    this.uniforms.radius.value = radius;
    this.uniforms.spacing.value = floor.grid_spacing > 0 ? floor.grid_spacing : radius;
    const geometry = new THREE.CircleGeometry(radius, 64);
    const surface = new THREE.ShaderMaterial({
      vertexShader: vertex,
      fragmentShader: fragment,
      uniforms: this.uniforms,
      transparent: true,
      depthWrite: false,
    });
    this.shade = new THREE.ShadowMaterial({ depthWrite: false });
    const ground = new THREE.Mesh(geometry, surface);
    const shadows = new THREE.Mesh(geometry, this.shade);
    ground.renderOrder = -2;
    shadows.renderOrder = -1;
    shadows.receiveShadow = true;
    this.object.add(ground, shadows);
    const normal = new THREE.Vector3(...floor.normal);
    this.object.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    // The floor moves in its plane below the middle of the machine; the grid stays in place.
    const middle = min.add(max).multiplyScalar(0.5);
    const height = middle.clone().sub(new THREE.Vector3(...floor.point)).dot(normal);
    this.object.position.copy(middle).addScaledVector(normal, -height);
  }

  setDark(dark: boolean): void {
    this.uniforms.ground.value.set(dark ? 0x202630 : 0xf7f8fa);
    this.uniforms.line.value.set(dark ? 0x343d4a : 0xdde2e8);
    this.shade.opacity = dark ? 0.45 : 0.22;
  }
}
