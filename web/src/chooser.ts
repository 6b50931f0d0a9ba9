// The list of all channels, with a search by words, from which the curves are selected.

import { element } from './dom';
import type { Frames } from './frames';
import type { Plots } from './plots';

/** Largest number of listed channels; a more specific search finds the others. */
const most = 150;

export class Chooser {
  readonly element: HTMLElement;
  private readonly list = element('ul', { class: 'quantities' });
  private readonly search: HTMLInputElement;

  constructor(
    private readonly frames: Frames,
    private readonly plots: Plots,
  ) {
    this.search = element('input', {
      type: 'search',
      placeholder: 'find quantities: tension, energy …',
      'aria-label': 'find quantities',
      oninput: () => this.update(),
    });
    this.element = element(
      'details',
      { class: 'chooser', ontoggle: () => this.update() },
      element('summary', {}, 'Quantities'),
      this.search,
      this.list,
    );
    plots.onChange(() => this.update());
  }

  private update(): void {
    if (!(this.element as HTMLDetailsElement).open) return;
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = this.frames.channels.filter(
      (c) => !c.hidden && words.every((word) => c.name.toLowerCase().includes(word)),
    );
    // Selected channels come first.
    fits.sort((a, b) => Number(this.plots.has(b.name)) - Number(this.plots.has(a.name)));
    const rows = fits.slice(0, most).map((channel) => {
      const box = element('input', {
        type: 'checkbox',
        checked: this.plots.has(channel.name),
        onchange: () => this.plots.toggle(channel.name),
      });
      return element('li', {}, element('label', {}, box, ` ${channel.name}`, unitText(channel.unit)));
    });
    if (fits.length > most) rows.push(element('li', {}, `… and ${fits.length - most} more`));
    this.list.replaceChildren(...rows);
  }
}

const unitText = (unit: string): HTMLElement => element('small', {}, unit ? ` ${unit}` : '');

/** The initial curves: tensions, else coordinates of joints, else the path of the last body. */
export function firstChoice(frames: Frames): string[] {
  const moves = (name: string): boolean => {
    const channel = frames.channel(name);
    if (channel < 0) return false;
    const values = frames.series(channel).filter(Number.isFinite);
    return values.some((v) => Math.abs(v - values[0]) > 1e-6 * Math.abs(values[0]) + 1e-9);
  };
  const { cables, joints, bodies } = frames.machine;
  const tensions = cables.flatMap((cable) =>
    Array.from({ length: cable.spans }, (_, k) => `${cable.name}.${k}.tension`),
  );
  if (tensions.length > 0) {
    const moving = tensions.filter(moves);
    return (moving.length > 0 ? moving : tensions).slice(0, 6);
  }
  const coordinates = joints.flatMap((j) => ['angle', 'travel', 'extension'].map((q) => `${j.name}.${q}`));
  const places = bodies.flatMap((b) => ['x', 'y', 'z'].map((q) => `${b.name}.${q}`));
  const moving = [...coordinates.filter(moves).slice(0, 3), ...places.filter(moves).slice(-3)];
  return moving.length > 0 ? moving : ['energy.total'];
}
