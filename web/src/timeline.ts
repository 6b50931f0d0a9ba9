// The time line: the player's position, the events, and the controls of the player.

import { button, element } from './dom';
import type { Frames } from './frames';
import type { MachineEvent } from './machine';
import { timeText } from './numbers';
import type { Player } from './player';
import { speeds } from './player';

/** Marks closer than this share of the line are merged. */
const closest = 0.004;

const markClass = (kind: string): string => `mark ${kind.replaceAll(' ', '-')}`;

/** Names of triggers of one kind in the legend. */
const mostNames = 4;

/** The kinds of events in their first order: with the names of triggers, otherwise with their number. */
export function kindTexts(events: readonly MachineEvent[]): { kind: string; text: string }[] {
  const kinds = new Map<string, { count: number; names: Set<string> }>();
  for (const { kind, text } of events) {
    const known = kinds.get(kind) ?? { count: 0, names: new Set<string>() };
    known.count += 1;
    const trigger = /^trigger (.+): [^:]+$/.exec(text);
    if (trigger) known.names.add(trigger[1]);
    kinds.set(kind, known);
  }
  return [...kinds].map(([kind, { count, names }]) => {
    const shown = [...names].slice(0, mostNames).join(', ');
    const more = names.size > mostNames ? ` and ${names.size - mostNames} more` : '';
    if (names.size > 0) return { kind, text: `${kind}: ${shown}${more}` };
    return { kind, text: count > 1 ? `${kind} (${count})` : kind };
  });
}

export class Timeline {
  readonly element: HTMLElement;
  private readonly track: HTMLElement;
  private readonly fill = element('div', { class: 'fill' });
  private readonly knob = element('div', { class: 'knob' });
  private readonly marks = element('div', { class: 'marks' });
  private readonly kinds = element('ul', { class: 'event-kinds', 'aria-label': 'events' });
  private readonly clock = element('output', { class: 'clock' });
  private readonly playButton: HTMLButtonElement;
  private readonly loopButton: HTMLButtonElement;
  private readonly speedChoice: HTMLSelectElement;
  private marked = -1;

  constructor(
    private readonly player: Player,
    private readonly frames: Frames,
  ) {
    this.playButton = button('▶', 'play (space)', () => player.toggle());
    this.loopButton = button('⟳', 'play again and again (L)', () => player.setLoop(!player.loop));
    this.speedChoice = element('select', {
      title: 'speed (+ and -)',
      'aria-label': 'speed',
      onchange: () => player.setSpeed(Number(this.speedChoice.value)),
    });
    for (const speed of speeds) {
      this.speedChoice.append(element('option', { value: String(speed) }, `${speed} ×`));
    }
    this.track = element(
      'div',
      {
        class: 'track',
        role: 'slider',
        tabindex: '0',
        'aria-label': 'time in seconds',
        onpointerdown: (event: PointerEvent) => this.grab(event),
        onpointermove: (event: PointerEvent) => this.drag(event),
      },
      this.fill,
      this.knob,
      this.marks,
    );
    this.element = element(
      'div',
      { class: 'timeline' },
      button('|◂', 'to the start (Home)', () => this.jump(0)),
      button('◂', 'one step back (left)', () => this.step(-1)),
      this.playButton,
      button('▸', 'one step on (right)', () => this.step(1)),
      button('▸|', 'to the end (End)', () => this.jump(frames.count - 1)),
      this.track,
      this.clock,
      this.speedChoice,
      this.loopButton,
      this.kinds,
    );
    player.onChange(() => this.update());
    this.update();
  }

  /** Moves by a number of frames from the shown one. */
  step(by: number): void {
    this.player.pause();
    const now = this.frames.frameAt(this.player.time);
    // A step back from a time between two frames goes to the earlier frame.
    const between = this.player.time > this.frames.time(now) && by < 0 ? 1 : 0;
    this.jump(now + by + between);
  }
  jump(frame: number): void {
    const inside = Math.min(Math.max(frame, 0), this.frames.count - 1);
    if (inside >= 0) this.player.seek(this.frames.time(inside));
  }

  private update(): void {
    const { time, playing, speed, loop, range } = this.player;
    const [begin, end] = range;
    const share = end > begin ? (time - begin) / (end - begin) : 0;
    this.fill.style.width = `${100 * share}%`;
    this.knob.style.left = `${100 * share}%`;
    const text = timeText(time, this.frames.machine.dt);
    this.clock.textContent = `${text} / ${timeText(end, this.frames.machine.dt)} s`;
    this.track.setAttribute('aria-valuemin', String(begin));
    this.track.setAttribute('aria-valuemax', String(end));
    this.track.setAttribute('aria-valuenow', text);
    this.playButton.textContent = playing ? '❚❚' : '▶';
    this.playButton.title = playing ? 'pause (space)' : 'play (space)';
    this.playButton.setAttribute('aria-label', this.playButton.title);
    this.loopButton.setAttribute('aria-pressed', String(loop));
    this.speedChoice.value = String(speed);
    // Marks move when the end moves or events are added.
    const key = this.frames.events.length + end;
    if (key !== this.marked) this.mark(begin, end);
    this.marked = key;
  }

  private mark(begin: number, end: number): void {
    this.marks.replaceChildren();
    let group: MachineEvent[] = [];
    const flush = (): void => {
      const first = group[0];
      if (!first) return;
      const title = group.slice(0, 8).map((e) => `${timeText(e.time, this.frames.machine.dt)} s: ${e.text}`);
      if (group.length > 8) title.push(`and ${group.length - 8} more`);
      const mark = element('span', {
        class: markClass(first.kind),
        title: title.join('\n'),
        style: `left: ${(100 * (first.time - begin)) / Math.max(end - begin, 1e-300)}%`,
      });
      this.marks.append(mark);
      group = [];
    };
    for (const event of this.frames.events) {
      if (group[0] && event.time - group[0].time > closest * (end - begin)) flush();
      group.push(event);
    }
    flush();
    this.tellKinds();
  }

  /** The legend of the marks: the kinds of events of this run. */
  private tellKinds(): void {
    const kinds = kindTexts(this.frames.events);
    this.kinds.hidden = kinds.length === 0;
    this.kinds.replaceChildren(
      ...kinds.map(({ kind, text }) => element('li', {}, element('i', { class: markClass(kind) }), text)),
    );
  }

  private timeAt(event: PointerEvent): number {
    const bounds = this.track.getBoundingClientRect();
    const [begin, end] = this.player.range;
    return begin + ((event.clientX - bounds.left) / bounds.width) * (end - begin);
  }
  private grab(event: PointerEvent): void {
    this.track.setPointerCapture(event.pointerId);
    this.player.pause();
    this.player.seek(this.timeAt(event));
  }
  private drag(event: PointerEvent): void {
    if (this.track.hasPointerCapture(event.pointerId)) this.player.seek(this.timeAt(event));
  }
}
