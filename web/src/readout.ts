// The numbers of the object under the pointer. After a tap they stay on the screen and follow the
// time.

import { button, element } from './dom';
import type { Frames } from './frames';
import { quantityText } from './numbers';
import type { Plots } from './plots';
import type { MachineState } from './machine_state';
import type { Picked } from './scene3d';

/** The channels of the picked object, in the order of display. */
export function quantitiesOf(frames: Frames, picked: Picked): string[] {
  const machine = frames.machine;
  let prefix: string;
  let skip = /^$/;
  if (picked.kind === 'span') {
    prefix = `${machine.cables[picked.index].name}.${picked.span}.`;
  } else if (picked.kind === 'joint') {
    prefix = `${machine.joints[picked.index].name}.`;
  } else {
    prefix = `${machine.bodies[picked.index].name}.`;
    skip = /\.q[wxyz]$/;
  }
  return frames.channels
    .filter((c) => !c.hidden && c.name.startsWith(prefix) && !skip.test(c.name))
    .map((c) => c.name);
}

export function titleOf(frames: Frames, picked: Picked): string {
  const machine = frames.machine;
  if (picked.kind === 'span') return `${machine.cables[picked.index].name}, span ${picked.span}`;
  if (picked.kind === 'joint') {
    const joint = machine.joints[picked.index];
    return `${joint.name} (${joint.type})`;
  }
  const body = machine.bodies[picked.index];
  return `${body.name} (${body.mobility})`;
}

export class Readout {
  readonly element = element('div', { class: 'readout', 'aria-live': 'off', hidden: true });
  private shown: Picked | null = null;
  private kept = false;
  private rows: [HTMLElement, number, string][] = [];

  constructor(
    private readonly frames: Frames,
    private readonly state: MachineState,
    private readonly plots: Plots | null,
  ) {}

  get picked(): Picked | null {
    return this.shown;
  }
  /** The pointer is over an object, or over none; a tapped object stays selected. */
  hover(picked: Picked | null): void {
    if (!this.kept) this.set(picked);
  }
  tap(picked: Picked | null): void {
    this.kept = picked !== null;
    this.set(picked);
  }

  /** Shows the values at the present time. */
  update(): void {
    for (const [cell, channel, unit] of this.rows) {
      cell.textContent = quantityText(this.state.values[channel], unit);
    }
  }

  private set(picked: Picked | null): void {
    this.shown = picked;
    this.element.hidden = picked === null;
    this.rows = [];
    if (!picked) return;
    const table = element('table');
    for (const name of quantitiesOf(this.frames, picked)) {
      const channel = this.frames.channel(name);
      const cell = element('td');
      const label = name.slice(name.lastIndexOf('.') + 1).replaceAll('_', ' ');
      const row = element('tr', {}, element('th', {}, label), cell);
      if (this.kept && this.plots) {
        const plots = this.plots;
        const knob = button('∿', `show ${name} as a curve, or no more`, () => plots.toggle(name));
        row.append(element('td', {}, knob));
      }
      table.append(row);
      this.rows.push([cell, channel, this.frames.channels[channel].unit]);
    }
    const head = element('header', {}, element('strong', {}, titleOf(this.frames, picked)));
    if (this.kept) head.append(button('×', 'close', () => this.tap(null)));
    this.element.replaceChildren(head, table);
    this.update();
  }
}
