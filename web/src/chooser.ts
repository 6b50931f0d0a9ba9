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

/** Largest number of initial curves. */
const mostCurves = 6;

/**
 * Those of the channels that vary most, in the order of the list. Of curves that coincide to a
 * hundredth of their range, such as tensions on both sides of a pinhole, the first one is kept.
 */
function mostVaried(frames: Frames, names: string[]): string[] {
  const known = (values: ArrayLike<number>, k: number): number =>
    Number.isFinite(values[k]) ? values[k] : NaN;
  const varied = names
    .filter((name) => frames.channel(name) >= 0)
    .map((name, place) => {
      const values = frames.series(frames.channel(name));
      let low = Infinity;
      let high = -Infinity;
      for (let k = 0; k < values.length; ++k) {
        if (!Number.isFinite(values[k])) continue;
        low = Math.min(low, values[k]);
        high = Math.max(high, values[k]);
      }
      return { name, place, values, range: high - low, size: Math.max(Math.abs(low), Math.abs(high)) };
    })
    .filter(({ range, size }) => range > 1e-6 * size + 1e-9)
    .sort((a, b) => b.range - a.range || a.place - b.place);
  const chosen: typeof varied = [];
  for (const one of varied) {
    const coincides = chosen.some(({ values, range }) => {
      for (let k = 0; k < values.length; ++k) {
        if (Math.abs(known(values, k) - known(one.values, k)) > 0.01 * range) return false;
      }
      return true;
    });
    if (!coincides) chosen.push(one);
    if (chosen.length === mostCurves) break;
  }
  return chosen.sort((a, b) => a.place - b.place).map(({ name }) => name);
}

/** The time of the highest tension [s], as in stills; that of the first frame without cables. */
export function tautestTime(frames: Frames): number {
  let most = 0;
  let best = 0;
  for (const cable of frames.machine.cables) {
    for (let k = 0; k < cable.spans; ++k) {
      const channel = frames.channel(`${cable.name}.${k}.tension`);
      if (channel < 0) continue;
      frames.series(channel).forEach((tension, frame) => {
        if (tension <= most || !Number.isFinite(tension)) return;
        most = tension;
        best = frame;
      });
    }
  }
  return frames.time(best);
}

/** The initial curves: tensions, else coordinates of joints, else the path of the last body. */
export function firstChoice(frames: Frames): string[] {
  const moves = (name: string): boolean => mostVaried(frames, [name]).length > 0;
  const { cables, joints, bodies } = frames.machine;
  const tensions = cables.flatMap((cable) =>
    Array.from({ length: cable.spans }, (_, k) => `${cable.name}.${k}.tension`),
  );
  if (tensions.length > 0) {
    const moving = mostVaried(frames, tensions);
    return moving.length > 0 ? moving : tensions.slice(0, mostCurves);
  }
  const coordinates = joints.flatMap((j) => ['angle', 'travel', 'extension'].map((q) => `${j.name}.${q}`));
  const places = bodies.flatMap((b) => ['x', 'y', 'z'].map((q) => `${b.name}.${q}`));
  const moving = [...coordinates.filter(moves).slice(0, 3), ...places.filter(moves).slice(-3)];
  return moving.length > 0 ? moving : ['energy.total'];
}
