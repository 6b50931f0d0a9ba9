// The machine in three dimensions.

import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

import { Annotations } from './annotations';
import type { CableStyle } from './cable_path';
import { cableTubes } from './cable_path';
import { cameraAt } from './camera_path';
import { leastBodyContrast, readable } from './contrast';
import { Floor } from './floor';
import { jointLines } from './joint_lines';
import type { Bar, BodyIndex, Part } from './machine';
import type { MachineState } from './machine_state';
import type { Tag } from './segments';
import { Segments } from './segments';
import { geometryOf } from './shapes';
import { Triad } from './triad';
import type { Vector3 } from './vector';

/** The part of the machine under the pointer. */
export type Picked =
  | { kind: 'body'; index: number; point: Vector3 }
  | { kind: 'span'; index: number; span: number; point: Vector3 }
  | { kind: 'joint'; index: number; point: Vector3 };

/** A side of the machine. */
export type View = 'front' | 'side' | 'top';

const highlightColor = 0xffc107;
/** Smallest angle between faces whose edge is drawn as a line [degrees]. */
const sharpest = 28;
const lightGround = '#f2f4f7';
const darkGround = '#1a1f27';
/** Least part of the light that reaches a visible face in the dark picture. */
const darkestFace = 0.5;
/** Width over height of the films for which keyframes are made. */
const filmAspect = 16 / 9;

export class Scene3D {
  readonly canvas: HTMLCanvasElement;
  readonly camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  readonly controls: OrbitControls;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly bodies: THREE.Group[];
  private readonly world = new THREE.Group();
  private readonly jointObjects = new Map<number, THREE.Object3D[]>();
  private readonly segments: Segments;
  private readonly knots: THREE.InstancedMesh;
  private readonly floor: Floor | null;
  private readonly triad = new Triad();
  readonly annotations: Annotations;
  private readonly ambient = new THREE.HemisphereLight(0xffffff, 0x8a8580, 2.0);
  private readonly key = new THREE.DirectionalLight(0xfff8ee, 2.1);
  private readonly resizing: ResizeObserver;
  private readonly disposables: { dispose(): void }[] = [];
  /** Materials with the colours that they have on a light background. */
  private readonly tints: { material: THREE.MeshLambertMaterial; color: string }[] = [];
  private highlighted: THREE.Object3D | null = null;
  private highlightedTag: Picked | null = null;
  private dark = false;
  private scheduled = 0;
  /** The whole machine is in the picture, and stays there when the picture changes its size. */
  private fitted = true;
  /** The camera follows the keyframes of the scene, until somebody moves it. */
  private follows: boolean;
  /** Direction from the machine to the eye, and up in the picture. */
  private back: THREE.Vector3;
  private readonly up: THREE.Vector3;

  /** Whether the browser supports 3D graphics. */
  static isSupported(): boolean {
    try {
      const canvas = document.createElement('canvas');
      return canvas.getContext('webgl2') !== null;
    } catch {
      return false;
    }
  }

  /** Shows the time of `state` in `host` and fills it. */
  constructor(
    private readonly host: HTMLElement,
    private readonly state: MachineState,
  ) {
    const machine = state.machine;
    // The last picture must stay readable for its export.
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    // Shadows show the place above a ground.
    this.renderer.shadowMap.enabled = state.machine.floor !== null;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = -1;
    this.annotations = new Annotations(machine.annotations);
    host.append(this.canvas, this.annotations.element, this.triad.element);

    this.bodies = machine.bodies.map((_, index) => {
      const group = new THREE.Group();
      group.userData = { kind: 'body', index };
      this.scene.add(group);
      return group;
    });
    this.scene.add(this.world, this.ambient, this.key, this.key.target);
    for (const part of machine.parts) this.addPart(part, { kind: 'body', index: part.body });
    for (const bar of machine.bars) this.addBar(bar, { kind: 'body', index: bar.body });
    for (const piece of machine.joint_pieces) {
      const owner = { kind: 'joint' as const, index: piece.joint };
      const made = [
        ...piece.parts.map((part) => this.addPart(part, owner)),
        ...piece.bars.map((bar) => this.addBar(bar, owner)),
      ];
      this.jointObjects.set(piece.joint, made);
    }
    this.segments = new Segments(this.scene);
    this.knots = this.makeKnots();
    this.floor = machine.floor ? new Floor(machine.floor, machine.bounds) : null;
    if (this.floor) this.scene.add(this.floor.object);

    const size = this.diagonal();
    this.camera =
      machine.camera.height === undefined
        ? new THREE.PerspectiveCamera(
            THREE.MathUtils.radToDeg(machine.camera.vertical_fov ?? 0.45),
            1,
            0.01 * size,
            100 * size,
          )
        : new THREE.OrthographicCamera(-1, 1, 1, -1, -50 * size, 100 * size);
    this.up = new THREE.Vector3(...machine.camera.up).normalize();
    this.camera.up.copy(this.up);
    this.back = this.wantedBack();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.redraw());
    this.follows = machine.camera_path.length > 0;
    this.controls.addEventListener('start', () => {
      if (this.follows) this.camera.up.copy(this.up);
      this.fitted = this.follows = false;
    });
    this.placeLight();
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(host);
    this.setDark(false);
    this.resize();
    this.fit();
  }

  setDark(dark: boolean): void {
    this.dark = dark;
    this.scene.background = new THREE.Color(dark ? darkGround : lightGround);
    // On a dark background the light comes more evenly, so that faces in shade stay visible.
    this.ambient.intensity = dark ? 2.6 : 2.0;
    this.ambient.groundColor.set(dark ? 0xc4c0bc : 0x8a8580);
    this.key.intensity = dark ? 1.2 : 2.1;
    for (const { material, color } of this.tints) material.color.set(this.tint(color));
    this.floor?.setDark(dark);
    this.show();
  }

  /** Draws the state in the browser's next animation frame. */
  show(): void {
    const machine = this.state.machine;
    this.bodies.forEach((group, index) => {
      const { position, orientation } = this.state.pose(index);
      group.position.set(...position);
      group.quaternion.set(orientation[1], orientation[2], orientation[3], orientation[0]);
    });
    for (const [joint, objects] of this.jointObjects) {
      const visible = !this.state.isBroken(joint);
      for (const object of objects) object.visible = visible;
    }
    const style: CableStyle = {
      radius: machine.cable_radius,
      tensionMax: machine.tension_max,
      gravity: machine.gravity,
      floor: machine.floor,
      dark: this.dark,
    };
    this.segments.begin();
    this.knots.count = 0;
    machine.cables.forEach((_, index) => this.addCable(index, style));
    this.knots.instanceMatrix.needsUpdate = true;
    for (const piece of machine.joint_pieces) {
      if (this.state.isBroken(piece.joint)) continue;
      const tag: Tag = { kind: 'joint', index: piece.joint, span: -1 };
      for (const line of piece.lines) {
        for (const { points, radius, color } of jointLines(line, this.state)) {
          for (let k = 1; k < points.length; ++k) {
            this.segments.add(points[k - 1], points[k], radius, color, tag);
          }
        }
      }
    }
    this.segments.end();
    if (this.follows) this.followPath();
    this.redraw();
  }

  /** The whole run from the front (the camera of the scene looks there), from the side or from above. */
  look(from: View): void {
    this.follows = false;
    const front = this.wantedBack();
    front.addScaledVector(this.up, -front.dot(this.up));
    // A camera that looks straight down has no front.
    if (!(front.length() > 1e-3)) front.set(0, 0, 1).addScaledVector(this.up, -this.up.z);
    if (!(front.length() > 1e-3)) front.set(0, -1, 0);
    front.normalize();
    // The nearest axis: a picture from the front is a drawing.
    const axis = [Math.abs(front.x), Math.abs(front.y), Math.abs(front.z)];
    const most = axis.indexOf(Math.max(...axis));
    const sign = Math.sign(front.getComponent(most));
    front.set(0, 0, 0).setComponent(most, sign);
    const side = new THREE.Vector3().crossVectors(this.up, front);
    this.back = from === 'front' ? front : from === 'side' ? side : this.up.clone();
    this.camera.up.copy(from === 'top' ? front.negate() : this.up);
    this.place();
    this.camera.up.copy(this.up);
  }

  /** Places the camera of the scene so that the whole run is visible. */
  fit(): void {
    this.back = this.wantedBack();
    this.follows = this.state.machine.camera_path.length > 0;
    if (this.follows) {
      this.fitted = true;
      this.followPath();
    } else {
      this.place();
    }
  }

  /** Places the camera as the keyframes have it. A picture narrower than theirs shows their whole width. */
  private followPath(): void {
    const key = cameraAt(this.state.machine.camera_path, this.state.time);
    const wider = Math.max(1, filmAspect / this.aspect());
    if (this.camera instanceof THREE.PerspectiveCamera) {
      const tangent = wider * Math.tan(0.5 * (key.vertical_fov ?? 0.45));
      this.camera.fov = THREE.MathUtils.radToDeg(2 * Math.atan(tangent));
    } else {
      this.camera.zoom = 2 / (wider * (key.height ?? 1));
    }
    this.camera.up.set(...key.up);
    this.camera.position.set(...key.position);
    this.camera.lookAt(...key.target);
    this.camera.updateProjectionMatrix();
    // The controls turn about the up direction that they began with.
    this.controls.target.set(...key.target);
    this.redraw();
  }

  private wantedBack(): THREE.Vector3 {
    const { position, target } = this.state.machine.camera;
    return new THREE.Vector3(...position).sub(new THREE.Vector3(...target)).normalize();
  }

  private place(): void {
    const { bounds } = this.state.machine;
    const box = new THREE.Box3(new THREE.Vector3(...bounds.min), new THREE.Vector3(...bounds.max));
    const target = box.getCenter(new THREE.Vector3());
    const back = this.back;
    this.fitted = true;
    this.camera.position.copy(target).add(back);
    this.camera.lookAt(target);
    this.camera.updateMatrixWorld();
    const [right, up] = [0, 1].map((column) =>
      new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, column),
    );
    const margin = 1.12;
    let distance = 0;
    let half = 0;
    const aspect = this.aspect();
    const fov = this.camera instanceof THREE.PerspectiveCamera ? this.camera.fov : 0;
    const slope = Math.tan(THREE.MathUtils.degToRad(0.5 * fov));
    for (let i = 0; i < 8; ++i) {
      const corner = new THREE.Vector3(
        i & 1 ? box.max.x : box.min.x,
        i & 2 ? box.max.y : box.min.y,
        i & 4 ? box.max.z : box.min.z,
      ).sub(target);
      const reach = margin * Math.max(Math.abs(corner.dot(right)) / aspect, Math.abs(corner.dot(up)));
      half = Math.max(half, reach);
      if (slope > 0) distance = Math.max(distance, corner.dot(back) + reach / slope);
    }
    if (this.camera instanceof THREE.OrthographicCamera) {
      this.camera.zoom = 1 / Math.max(half, 1e-9);
      distance = 2 * this.diagonal();
    }
    this.camera.position.copy(target).addScaledVector(back, Math.max(distance, 1e-6));
    this.controls.target.copy(target);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.redraw();
  }

  /** The object at a point of the window, within `reach` pixels for thin objects. */
  pick(clientX: number, clientY: number, reach: number): Picked | null {
    const bounds = this.canvas.getBoundingClientRect();
    const x = clientX - bounds.left;
    const y = clientY - bounds.top;
    this.camera.updateMatrixWorld();
    const matrix = new THREE.Matrix4().multiplyMatrices(
      this.camera.projectionMatrix,
      this.camera.matrixWorldInverse,
    );
    const line = this.segments.nearest(x, y, reach, matrix, bounds.width, bounds.height);
    if (line && line.tag.kind === 'span') {
      return { kind: 'span', index: line.tag.index, span: line.tag.span, point: line.point };
    }
    const ray = this.ray(clientX, clientY);
    for (const hit of ray.intersectObjects([...this.bodies, this.world], true)) {
      if (!(hit.object instanceof THREE.Mesh) || !hit.object.visible) continue;
      const { kind, index } = hit.object.userData as { kind: 'body' | 'joint'; index: number };
      if (index < 0) continue;
      return { kind, index, point: hit.point.toArray() };
    }
    if (line && line.tag.kind === 'joint') {
      return { kind: 'joint', index: line.tag.index, point: line.point };
    }
    return null;
  }

  /** The ray from the eye through a point of the window. */
  ray(clientX: number, clientY: number): THREE.Raycaster {
    const bounds = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2(
      (2 * (clientX - bounds.left)) / bounds.width - 1,
      1 - (2 * (clientY - bounds.top)) / bounds.height,
    );
    const ray = new THREE.Raycaster();
    ray.setFromCamera(place, this.camera);
    return ray;
  }

  highlight(picked: Picked | null): void {
    const same = JSON.stringify(strip(picked)) === JSON.stringify(strip(this.highlightedTag));
    if (same) return;
    this.highlightedTag = picked;
    this.setGlow(this.highlighted, 0);
    this.highlighted = null;
    if (picked && picked.kind === 'body') this.highlighted = this.bodies[picked.index];
    this.setGlow(this.highlighted, 0.35);
    this.show();
  }

  /** The present picture as a PNG. */
  picture(): Promise<Blob> {
    this.draw();
    return new Promise((resolve, reject) => {
      this.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('no picture'))), 'image/png');
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.scheduled);
    this.resizing.disconnect();
    this.controls.dispose();
    this.segments.dispose();
    for (const item of this.disposables) item.dispose();
    this.renderer.dispose();
    this.canvas.remove();
    this.annotations.element.remove();
    this.triad.element.remove();
  }

  private addCable(index: number, style: CableStyle): void {
    const glow = this.highlightedTag?.kind === 'span' && this.highlightedTag.index === index;
    const chosen = glow && this.highlightedTag?.kind === 'span' ? this.highlightedTag.span : -2;
    const cable = this.state.cable(index);
    for (const link of cable.links) {
      if (link.radius > 0) continue;
      const place = new THREE.Matrix4().makeTranslation(...link.center);
      this.knots.setMatrixAt(this.knots.count++, place);
    }
    for (const tube of cableTubes(cable, style)) {
      const count = tube.points.length;
      for (let k = 0; k < (tube.closed ? count : count - 1); ++k) {
        const span = tube.spans[k];
        const tag: Tag = span >= 0 ? { kind: 'span', index, span } : { kind: 'cable', index, span };
        const radius = span === chosen ? 1.8 * style.radius : style.radius;
        this.segments.add(tube.points[k], tube.points[(k + 1) % count], radius, tube.colors[k], tag);
      }
    }
  }

  /** Spheres where cables are fixed to bodies. */
  private makeKnots(): THREE.InstancedMesh {
    const { cables, cable_radius } = this.state.machine;
    const most = cables.reduce((sum, cable) => sum + cable.links.length, 0);
    const geometry = new THREE.SphereGeometry(1.7 * cable_radius, 20, 14);
    const material = this.bodyMaterial('#3b4656');
    const mesh = new THREE.InstancedMesh(geometry, material, Math.max(most, 1));
    mesh.frustumCulled = false;
    mesh.castShadow = true;
    this.scene.add(mesh);
    this.disposables.push(geometry, material, mesh);
    return mesh;
  }

  /** The colour of a body on the present background. */
  private tint(color: string): string {
    // (L + 0.05) / (l + 0.05) of a face in shade, with L proportional to the light.
    return this.dark ? readable(color, darkGround, leastBodyContrast / darkestFace) : color;
  }

  private bodyMaterial(color: string, vertexColors = false): THREE.MeshLambertMaterial {
    const material = new THREE.MeshLambertMaterial({ color, vertexColors });
    this.tints.push({ material, color });
    return material;
  }

  private holder(body: BodyIndex): THREE.Object3D {
    return body < 0 ? this.world : this.bodies[body];
  }

  private addPart(part: Part, owner: { kind: string; index: number }): THREE.Object3D {
    const geometry = geometryOf(part.shape);
    const color = new THREE.Color(part.color);
    const material = this.bodyMaterial(part.color, true);
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.set(...part.position);
    const q = part.orientation;
    mesh.quaternion.set(q[1], q[2], q[3], q[0]);
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    mesh.userData = owner;
    const edges = new THREE.EdgesGeometry(geometry, sharpest);
    const lines = new THREE.LineBasicMaterial({ color: color.clone().multiplyScalar(0.3) });
    mesh.add(new THREE.LineSegments(edges, lines));
    this.holder(part.body).add(mesh);
    this.disposables.push(geometry, material, edges, lines);
    return mesh;
  }

  private addBar(bar: Bar, owner: { kind: string; index: number }): THREE.Object3D {
    const start = new THREE.Vector3(...bar.start);
    const along = new THREE.Vector3(...bar.end).sub(start);
    const geometry = new THREE.CylinderGeometry(bar.radius, bar.radius, along.length(), 16);
    const material = this.bodyMaterial(bar.color);
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.copy(start).addScaledVector(along, 0.5);
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
    mesh.castShadow = true;
    mesh.userData = owner;
    this.holder(bar.body).add(mesh);
    this.disposables.push(geometry, material);
    return mesh;
  }

  private setGlow(object: THREE.Object3D | null, strength: number): void {
    object?.traverse((child) => {
      if (!(child instanceof THREE.Mesh)) return;
      if (!(child.material instanceof THREE.MeshLambertMaterial)) return;
      child.material.emissive.set(strength > 0 ? highlightColor : 0x000000);
      child.material.emissiveIntensity = strength;
    });
  }

  private diagonal(): number {
    const { min, max } = this.state.machine.bounds;
    return Math.max(Math.hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2]), 1e-9);
  }
  private aspect(): number {
    return Math.max(this.host.clientWidth, 1) / Math.max(this.host.clientHeight, 1);
  }

  /** Lights from above, from the side and from the front, for any up direction. */
  private placeLight(): void {
    const { camera, gravity, bounds } = this.state.machine;
    const up = new THREE.Vector3(...gravity).negate();
    if (!(up.length() > 0)) up.set(...camera.up);
    up.normalize();
    const front = new THREE.Vector3(...camera.position).sub(new THREE.Vector3(...camera.target)).normalize();
    const side = new THREE.Vector3().crossVectors(up, front);
    const center = new THREE.Vector3(...bounds.min).add(new THREE.Vector3(...bounds.max)).multiplyScalar(0.5);
    const size = this.diagonal();
    this.ambient.position.copy(up);
    this.key.target.position.copy(center);
    const way = up.multiplyScalar(1.1).addScaledVector(front, 0.75).addScaledVector(side, -0.45);
    this.key.position.copy(center).addScaledVector(way.normalize(), 2 * size);
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(2048, 2048);
    this.key.shadow.normalBias = 0.002 * size;
    this.key.shadow.radius = 3;
    const frustum = this.key.shadow.camera;
    frustum.left = frustum.bottom = -0.75 * size;
    frustum.right = frustum.top = 0.75 * size;
    frustum.near = 0.5 * size;
    frustum.far = 4 * size;
  }

  private resize(): void {
    const width = Math.max(this.host.clientWidth, 1);
    const height = Math.max(this.host.clientHeight, 1);
    this.renderer.setSize(width, height);
    if (this.camera instanceof THREE.PerspectiveCamera) {
      this.camera.aspect = width / height;
    } else {
      this.camera.left = -width / height;
      this.camera.right = width / height;
    }
    this.camera.updateProjectionMatrix();
    // Panels beside the picture get their content, and with it their size, after the first picture.
    if (this.follows) this.followPath();
    else if (this.fitted) this.place();
    this.draw();
  }

  private redraw(): void {
    if (this.scheduled) return;
    this.scheduled = requestAnimationFrame(() => this.draw());
  }
  private draw(): void {
    cancelAnimationFrame(this.scheduled);
    this.scheduled = 0;
    this.renderer.render(this.scene, this.camera);
    this.triad.show(this.camera);
    this.annotations.show(this.state.time, (body, point) => this.screenPoint(body, point));
  }

  /** The place of a point of a body in the picture [pixels]; null behind the eye. */
  private screenPoint(body: BodyIndex, point: Vector3): { x: number; y: number } | null {
    const place = this.holder(body).localToWorld(new THREE.Vector3(...point)).project(this.camera);
    if (place.z > 1) return null;
    const { clientWidth, clientHeight } = this.canvas;
    return { x: 0.5 * (1 + place.x) * clientWidth, y: 0.5 * (1 - place.y) * clientHeight };
  }
}

function strip(picked: Picked | null): unknown {
  return picked && { ...picked, point: 0 };
}
