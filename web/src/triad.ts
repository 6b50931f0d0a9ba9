// The directions of the world's axes, in a corner of the picture.

import type * as THREE from 'three';

import { element } from './dom';

const names = ['x', 'y', 'z'];
const space = 'http://www.w3.org/2000/svg';
/** Length of an axis in the plane of the picture, and distance of its name [pixels]. */
const reach = 24;
const nameReach = 33;
/** An axis that points to the eye within this share of its length has no direction to draw. */
const leastSeen = 0.15;

export class Triad {
  readonly element = element('div', { class: 'triad', role: 'img' });
  private readonly axes: { group: SVGGElement; line: SVGLineElement; text: SVGTextElement }[];

  constructor() {
    const picture = document.createElementNS(space, 'svg');
    picture.setAttribute('viewBox', '-42 -42 84 84');
    this.axes = names.map((name) => {
      const group = document.createElementNS(space, 'g');
      group.setAttribute('class', `axis-${name}`);
      const line = document.createElementNS(space, 'line');
      const text = document.createElementNS(space, 'text');
      text.textContent = name;
      group.append(line, text);
      picture.append(group);
      return { group, line, text };
    });
    this.element.append(picture);
  }

  /** Shows the axes as this camera sees them. Its world matrix must be up to date. */
  show(camera: THREE.Camera): void {
    // Rows of the rotation are the directions to the right, up, and to the eye.
    const e = camera.matrixWorld.elements;
    const seen = names.map((_, k) => ({ k, right: e[k], up: e[4 + k], near: e[8 + k] }));
    for (const { k, right, up } of seen) {
      const { line, text, group } = this.axes[k];
      const size = Math.hypot(right, up);
      line.setAttribute('x2', (reach * right).toFixed(2));
      line.setAttribute('y2', (-reach * up).toFixed(2));
      const share = nameReach / Math.max(size, leastSeen);
      text.setAttribute('x', (share * size * right).toFixed(2));
      text.setAttribute('y', (-share * size * up).toFixed(2));
      group.setAttribute('visibility', size < leastSeen ? 'hidden' : 'visible');
    }
    // Axes that point to the eye are drawn over the others.
    const order = [...seen].sort((a, b) => a.near - b.near);
    for (const { k } of order) this.element.firstElementChild!.append(this.axes[k].group);
    const words = seen.map(({ k, right, up }) => {
      if (Math.hypot(right, up) < leastSeen) return `${names[k]} along the view`;
      const level = Math.abs(right) >= Math.abs(up);
      return `${names[k]} ${level ? (right > 0 ? 'right' : 'left') : up > 0 ? 'up' : 'down'}`;
    });
    this.element.setAttribute('aria-label', `axes: ${words.join(', ')}`);
  }
}
