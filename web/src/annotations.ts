// The texts and arrows that a scene puts into its pictures.

import { element } from './dom';
import type { Annotation } from './machine';
import type { Vector3 } from './vector';

const space = 'http://www.w3.org/2000/svg';
/** Distance of an arrow's text from its point, to the right and upwards [pixels]. */
const reach = [46, 40];
/** Times of frames are sums of steps, so they have rounding errors [s]. */
const rounding = 1e-9;

export interface ScreenPoint {
  x: number;
  y: number;
}

export function isShown(text: Annotation, time: number): boolean {
  return time >= text.from - rounding && (text.to === undefined || time <= text.to + rounding);
}

/** The last title (or caption) that is shown at a time; empty if there is none. */
export function shownText(texts: readonly Annotation[], kind: 'title' | 'caption', time: number): string {
  return texts.reduce((last, text) => (text.kind === kind && isShown(text, time) ? text.text : last), '');
}

export class Annotations {
  readonly element = element('div', { class: 'annotations' });
  private readonly title = element('p', { class: 'title' });
  private readonly caption = element('p', { class: 'caption', 'aria-live': 'polite' });
  private readonly picture = document.createElementNS(space, 'svg');
  private readonly arrows: { text: Annotation; line: SVGLineElement; label: HTMLElement }[];

  constructor(private readonly texts: readonly Annotation[]) {
    this.picture.innerHTML =
      '<defs><marker id="arrowhead" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="9" ' +
      'markerHeight="9" orient="auto-start-reverse"><path d="M1 1 9 5 1 9"/></marker></defs>';
    this.arrows = texts
      .filter((text) => text.kind === 'arrow')
      .map((text) => {
        const line = document.createElementNS(space, 'line');
        line.setAttribute('marker-end', 'url(#arrowhead)');
        const label = element('span', { class: 'arrow' }, text.text);
        this.picture.append(line);
        return { text, line, label };
      });
    this.element.append(this.picture, ...this.arrows.map((arrow) => arrow.label), this.title, this.caption);
  }

  /** Draws the texts that are shown now into a picture with the coordinates of the page. */
  draw(context: CanvasRenderingContext2D, color: string): void {
    context.fillStyle = context.strokeStyle = color;
    context.lineWidth = 1.5;
    context.font = '14px system-ui, sans-serif';
    for (const { text, line, label } of this.arrows) {
      if (label.style.display === 'none') continue;
      const [x, y, tipX, tipY] = ['x1', 'y1', 'x2', 'y2'].map((name) => Number(line.getAttribute(name)));
      const back = Math.atan2(y - tipY, x - tipX);
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(tipX, tipY);
      for (const side of [back - 0.42, back + 0.42]) {
        context.moveTo(tipX, tipY);
        context.lineTo(tipX + 10 * Math.cos(side), tipY + 10 * Math.sin(side));
      }
      context.stroke();
      context.fillText(text.text, label.offsetLeft + 4, label.offsetTop + label.offsetHeight - 6);
    }
    const caption = this.caption.textContent ?? '';
    if (!caption) return;
    context.textAlign = 'center';
    context.fillText(caption, 0.5 * this.element.clientWidth, this.element.clientHeight - 80, this.element.clientWidth - 32);
    context.textAlign = 'start';
  }

  /** The title that is shown now; empty: that of the machine. */
  get heading(): string {
    return this.title.textContent ?? '';
  }

  /** `project`: the place of a point of a body in the picture; null if it is not in front of the eye. */
  show(time: number, project: (body: number, point: Vector3) => ScreenPoint | null): void {
    this.title.textContent = shownText(this.texts, 'title', time);
    this.caption.textContent = shownText(this.texts, 'caption', time);
    const { clientWidth: width, clientHeight: height } = this.element;
    for (const { text, line, label } of this.arrows) {
      const tip = isShown(text, time) ? project(text.body ?? -1, text.point ?? [0, 0, 0]) : null;
      const visible = tip !== null && tip.x >= 0 && tip.x <= width && tip.y >= 0 && tip.y <= height;
      line.style.display = label.style.display = visible ? '' : 'none';
      if (!visible) continue;
      // The text stands to the right of the point and above it, or on the other side at an edge.
      const right = tip.x + reach[0] + label.offsetWidth < width ? 1 : -1;
      const down = tip.y - reach[1] - label.offsetHeight > 0 ? -1 : 1;
      const x = tip.x + right * reach[0];
      const y = tip.y + down * reach[1];
      const values = { x1: x, y1: y, x2: tip.x, y2: tip.y };
      for (const [name, value] of Object.entries(values)) line.setAttribute(name, value.toFixed(1));
      label.style.left = `${(right > 0 ? x : x - label.offsetWidth).toFixed(1)}px`;
      label.style.top = `${(down > 0 ? y : y - label.offsetHeight).toFixed(1)}px`;
    }
  }
}
