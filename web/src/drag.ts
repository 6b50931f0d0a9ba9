// Dragging of a body with the pointer, or of a rope by the body at its nearer end.

import * as THREE from 'three';

import type { LiveMachine } from './engine';
import type { Page } from './page';
import type { Picked } from './scene3d';
import type { Vector3 } from './vector';

const mouseReach = 7;
const touchReach = 18;
/** A press that moves no further than this is a tap [pixels]. */
const tapMoves = 4;

/** The bodies to grab, and the points on them, for the object under the pointer. */
export function gripOf(page: Page, picked: Picked): { body: number; point: Vector3 }[] {
  if (picked.kind === 'body') return [{ body: picked.index, point: picked.point }];
  if (picked.kind !== 'span') return [];
  const cable = page.state.cable(picked.index);
  const span = cable.spans.findIndex((s) => s.listed === picked.span);
  if (span < 0) return [];
  const { start, end } = cable.spans[span];
  const far = (p: Vector3): number => Math.hypot(...p.map((x, k) => x - picked.point[k]));
  const ends = [
    { body: cable.links[span].body, point: start },
    { body: cable.links[(span + 1) % cable.links.length].body, point: end },
  ];
  if (far(end) < far(start)) ends.reverse();
  return ends.filter((e) => e.body >= 0);
}

export interface DragHost {
  machine(): LiveMachine;
  page(): Page;
  /** A body was grabbed: the machine must run and show its present state. */
  taken(): void;
  /** Reports why a body cannot be grabbed. */
  refused(reason: string): void;
}

/** Listens to a page's picture as long as the picture exists. */
export function dragWithPointer(host: DragHost): void {
  const { scene } = host.page();
  const stage = scene?.canvas.parentElement;
  if (!scene || !stage) return;
  const onPlane = (event: PointerEvent, plane: THREE.Plane): THREE.Vector3 | null =>
    scene.ray(event.clientX, event.clientY).ray.intersectPlane(plane, new THREE.Vector3());

  // Handles events before the camera controls, which listen to the canvas itself.
  stage.addEventListener(
    'pointerdown',
    (event) => {
      if (event.button !== 0 || event.target !== scene.canvas || event.shiftKey) return;
      const reach = event.pointerType === 'mouse' ? mouseReach : touchReach;
      const picked = scene.pick(event.clientX, event.clientY, reach);
      if (!picked) return;
      let reason = '';
      const grip = gripOf(host.page(), picked).find(({ body, point }) => {
        const faults = host.machine().grab(body, point);
        reason ||= faults[0]?.message ?? '';
        return faults.length === 0;
      });
      if (!grip) {
        // Dragging an immovable body rotates the view, like dragging the background.
        if (reason) host.refused(reason);
        return;
      }
      event.stopPropagation();
      event.preventDefault();
      host.taken();
      const machine = host.machine();
      const normal = scene.camera.getWorldDirection(new THREE.Vector3());
      const start = new THREE.Vector3(...grip.point);
      const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, start);
      const first = onPlane(event, plane) ?? start.clone();
      const pressed = { x: event.clientX, y: event.clientY };
      let farthest = 0;
      const move = (moved: PointerEvent): void => {
        if (moved.pointerId !== event.pointerId || host.machine() !== machine) return;
        farthest = Math.max(farthest, Math.hypot(moved.clientX - pressed.x, moved.clientY - pressed.y));
        const now = onPlane(moved, plane);
        if (now) machine.drag(now.sub(first).add(start).toArray());
      };
      const end = (ended: PointerEvent): void => {
        if (ended.pointerId !== event.pointerId) return;
        window.removeEventListener('pointermove', move);
        window.removeEventListener('pointerup', end);
        window.removeEventListener('pointercancel', end);
        if (host.machine() === machine) machine.release();
        if (farthest <= tapMoves) host.page().readout.tap(picked);
      };
      window.addEventListener('pointermove', move);
      window.addEventListener('pointerup', end);
      window.addEventListener('pointercancel', end);
    },
    { capture: true },
  );
}
