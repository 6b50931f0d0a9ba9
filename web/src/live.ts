// A page with the engine inside, which computes the run that the page shows.

import { button, element } from './dom';
import { dragWithPointer } from './drag';
import type { Description, Engine, Fault, LiveMachine, Settings } from './engine';
import { FaultyScene } from './engine';
import { Frames } from './frames';
import { Knobs } from './knobs';
import type { Page } from './page';
import { buildPage } from './page';

/** Factor between the substeps of the reference and of the world. */
const refinement = 8;
/** Interval of states stored for going back [s]. */
const keptEvery = 0.5;
/** Largest number of stored values; then the recording starts again. */
const mostValues = 3e7;
/** Time for steps within one picture of 16 ms [ms]. */
const budget = 11;

export interface LiveOptions {
  host: HTMLElement;
  engine: Engine;
  /** Called when another scene is opened: elements beside the page must be rebuilt. */
  built(page: Page): void;
  share(): void;
}

export class Live {
  machine!: LiveMachine;
  page!: Page;
  description!: Description;
  /** Settings changed since the scene was opened. */
  changed: Partial<Settings> = {};
  private knobs!: Knobs;
  private frames!: Frames;
  private debt = 0;
  private last = 0;
  private kept = 0;
  private cost = 0;
  private error = NaN;
  private shown = 0;

  constructor(private readonly options: LiveOptions) {
    const tick = (now: number): void => {
      this.tick(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /** Opens a scene. Returns its faults; if there are any, nothing changes. */
  open(text: string, settings: Partial<Settings> = {}): Fault[] {
    let machine: LiveMachine;
    try {
      machine = this.options.engine.open(text);
    } catch (error) {
      if (error instanceof FaultyScene) return error.faults;
      throw error;
    }
    const faults = machine.change(settings);
    if (faults.length > 0) {
      machine.dispose();
      return faults;
    }
    this.machine?.dispose();
    this.machine = machine;
    this.changed = { ...settings };
    this.build();
    return [];
  }

  /** Makes one step of the world and records a frame. False if the run cannot continue. */
  step(): boolean {
    const start = performance.now();
    const step = this.machine.step();
    const taken = performance.now() - start;
    this.cost = this.cost === 0 ? taken : 0.95 * this.cost + 0.05 * taken;
    if (step.ending === 'diverged') {
      this.halt(`The run has diverged: ${step.reason}`);
      return false;
    }
    if (this.knobs.comparing) {
      if (this.machine.stepReference()) this.error = this.machine.error;
      else this.forgetReference();
    }
    const time = this.machine.time;
    this.frames.events.push(...step.events);
    if (this.frames.count * this.frames.channels.length > mostValues) this.frames.truncate(0);
    const values = this.machine.sample(this.frames.channels.length);
    if (this.machine.hasNewChannels) {
      this.build();
      return true;
    }
    this.frames.push(time, values);
    if (time - this.kept >= keptEvery) {
      this.machine.keep();
      this.kept = time;
    }
    if (step.ending === 'stopped') {
      this.halt(step.reason);
      return false;
    }
    return true;
  }

  goBack(seconds: number): void {
    this.note(null);
    if (!this.machine.goBack(seconds)) return;
    const time = this.machine.time;
    this.kept = time;
    this.forgetReference();
    const frames = this.frames;
    frames.truncate(frames.count > 0 ? frames.frameAt(time) : 0);
    frames.events.splice(0, frames.events.length, ...frames.events.filter((e) => e.time <= time));
    this.take();
    this.page.player.seek(time);
  }

  private build(): void {
    this.description = this.machine.describe();
    const { machine, channels, controls, settings } = this.description;
    this.page?.dispose();
    this.frames = new Frames(machine, channels);
    this.frames.push(this.machine.time, this.machine.sample(channels.length));
    this.kept = this.machine.time;
    this.machine.keep();
    this.error = NaN;
    const page = buildPage(this.options.host, this.frames, {
      note: 'pull at it',
      keys: [
        { keys: ['b', 'B'], meaning: 'B: back two seconds; 0: from the start', run: () => this.goBack(2) },
        { keys: ['0'], meaning: '', run: () => this.goBack(Infinity) },
      ],
    });
    this.page = page;
    page.player.endless = true;
    this.knobs = new Knobs(
      {
        set: (control, value) => this.complain(this.machine.set(control, value)),
        change: (wanted) => this.change(wanted),
        compare: (on) => this.compare(on),
        goBack: (seconds) => this.goBack(seconds),
        share: () => this.options.share(),
      },
      controls,
      { ...settings, ...this.changed },
    );
    page.extras.append(this.knobs.element);
    dragWithPointer({
      machine: () => this.machine,
      page: () => this.page,
      taken: () => {
        this.note(null);
        page.player.seek(page.player.range[1]);
        if (!page.player.playing) page.player.play();
      },
      refused: (reason) => this.note(reason),
    });
    this.options.built(page);
    this.showNumbers();
  }

  private change(wanted: Partial<Settings>): void {
    Object.assign(this.changed, wanted);
    this.complain(this.machine.change(wanted));
    this.machine.certificate(true);
    this.cost = 0;
  }

  private compare(on: boolean): void {
    this.error = NaN;
    this.complain(this.machine.reference(on ? refinement : 0));
  }
  private forgetReference(): void {
    this.error = NaN;
    this.knobs.stopComparing();
    this.machine.reference(0);
  }

  private take(): void {
    this.frames.push(this.machine.time, this.machine.sample(this.frames.channels.length));
    this.page.player.setRange(this.frames.time(0), this.machine.time);
  }

  private tick(now: number): void {
    const passed = Math.min((now - this.last) / 1000, 0.05);
    this.last = now;
    const player = this.page?.player;
    if (!player) return;
    if (player.playing && player.time >= player.range[1]) {
      this.debt += passed * player.speed;
      const { dt } = this.description.machine;
      const end = performance.now() + budget;
      while (this.debt >= dt && this.page.player === player) {
        this.debt -= dt;
        if (!this.step()) break;
        // The engine is slower than the clock: drops the missing time.
        if (performance.now() > end) this.debt = 0;
      }
      if (this.page.player === player) {
        player.setRange(this.frames.time(0), this.machine.time);
        player.seek(this.machine.time);
      } else {
        this.page.player.setRange(this.frames.time(0), this.machine.time);
        this.page.player.play();
      }
    }
    if (now - this.shown > 200) {
      this.shown = now;
      this.showNumbers();
    }
  }

  private showNumbers(): void {
    this.knobs.showNumbers(this.cost, this.machine.pull, this.error);
    this.knobs.showCertificate(this.machine.certificate(false));
  }

  private halt(reason: string): void {
    this.page.player.pause();
    this.note(reason, true);
  }
  private complain(faults: Fault[]): void {
    if (faults.length > 0) this.note(faults.map((f) => f.text).join('\n'));
  }
  /** Shows a message over the picture; null removes it. */
  private note(text: string | null, back = false): void {
    this.options.host.querySelector('.fault')?.remove();
    if (text === null) return;
    const note = element('p', { class: 'fault', role: 'alert' }, text, ' ');
    if (back) note.append(button('Go back 2 s', 'go back two seconds', () => this.goBack(2)), ' ');
    note.append(button('×', 'close', () => note.remove()));
    this.options.host.prepend(note);
  }
}
