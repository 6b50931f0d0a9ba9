// Typed access to the engine in WebAssembly: web/engine/binding.cpp.

import type { Channel, Machine, MachineEvent } from './machine';
import type { Vector3 } from './vector';

interface Module {
  HEAPF64: Float64Array;
  ccall(name: string, result: string | null, types: string[], values: unknown[]): unknown;
  // Functions called in every step, without the overhead of ccall.
  _sheave_step(machine: number): number;
  _sheave_sample(machine: number): number;
  _sheave_time(machine: number): number;
}
export type ModuleFactory = (options: { wasmBinary?: Uint8Array }) => Promise<Module>;

/** A fault of a scene with its position in the text (from 1; 0: no position). */
export interface Fault {
  line: number;
  column: number;
  pointer: string;
  message: string;
  value?: string;
  allowed?: string;
  text: string;
}

export interface Settings {
  solver: 'gauss-seidel' | 'direct';
  integrator: 'xpbd' | 'rattle';
  substeps: number;
  iterations: number;
  /** [m/s2] */
  gravity: Vector3;
}

/** A control of the scene that can be set during the run. */
export interface Control {
  name: string;
  unit: string;
  value: number;
  minimum: number;
  maximum: number;
}

export interface Description {
  machine: Machine;
  channels: Channel[];
  controls: Control[];
  settings: Settings;
}

export interface Certificate {
  clean: boolean;
  substeps: number;
  /** The worst figure, relative to its scale. */
  relative: number;
  sentence: string;
}

export interface Step {
  ending: 'none' | 'diverged' | 'stopped';
  /** Why the run cannot continue. */
  reason: string;
  events: MachineEvent[];
}

export class FaultyScene extends Error {
  constructor(readonly faults: Fault[]) {
    super(faults[0]?.text ?? 'the scene has faults');
  }
}

export class Engine {
  private constructor(readonly module: Module) {}

  static async load(factory: ModuleFactory, wasmBinary: Uint8Array): Promise<Engine> {
    return new Engine(await factory({ wasmBinary }));
  }

  /**
   * Makes the machine of a scene; `overrides` maps JSON pointers to JSON texts. Throws FaultyScene.
   */
  open(text: string, overrides: Record<string, string> = {}): LiveMachine {
    const handle = this.module.ccall('sheave_open', 'number', ['string', 'string'], [
      text,
      JSON.stringify(overrides),
    ]) as number;
    if (handle === 0) {
      const answer = this.module.ccall('sheave_text', 'string', [], []) as string;
      throw new FaultyScene((JSON.parse(answer) as { errors: Fault[] }).errors);
    }
    return new LiveMachine(this.module, handle);
  }
}

export class LiveMachine {
  constructor(
    private readonly module: Module,
    private handle: number,
  ) {}

  describe(): Description {
    return JSON.parse(this.text('sheave_describe')) as Description;
  }

  step(): Step {
    const code = this.module._sheave_step(this.open());
    if (code === 0) return { ending: 'none', reason: '', events: [] };
    const text = code < 4 ? '' : (this.module.ccall('sheave_text', 'string', [], []) as string);
    const ending = (['none', 'diverged', 'stopped'] as const)[code % 4];
    if (ending === 'diverged') return { ending, reason: text, events: [] };
    const events = text
      .split('\n')
      .filter((line) => line !== '')
      .map((line) => {
        const [kind, time, what] = line.split('\t');
        return { kind, time: Number(time), text: what };
      });
    return { ending, reason: ending === 'stopped' ? 'a trigger has stopped the run' : '', events };
  }

  /** [s] */
  get time(): number {
    return this.module._sheave_time(this.open());
  }
  /** One value per channel, as a view that is valid until the next call. */
  sample(count: number): Float64Array {
    const place = this.module._sheave_sample(this.open()) / 8;
    return this.module.HEAPF64.subarray(place, place + count);
  }
  get hasNewChannels(): boolean {
    return this.number('sheave_has_new_channels') !== 0;
  }

  keep(): void {
    this.number('sheave_keep');
  }
  goBack(seconds: number): boolean {
    return this.call('sheave_go_back', 'number', ['number'], [seconds]) !== 0;
  }

  set(control: string, value: number): Fault[] {
    return this.faults('sheave_set', ['string', 'number'], [control, value]);
  }
  change(settings: Partial<Settings>): Fault[] {
    return this.faults('sheave_change', ['string'], [JSON.stringify(settings)]);
  }

  grab(body: number, point: Vector3): Fault[] {
    return this.faults('sheave_grab', ['number', 'number', 'number', 'number'], [body, ...point]);
  }
  drag(target: Vector3): void {
    this.call('sheave_drag', null, ['number', 'number', 'number'], [...target]);
  }
  release(): void {
    this.call('sheave_release', null, [], []);
  }
  /** The size of the pointer's force [N]. */
  get pull(): number {
    return this.number('sheave_pull');
  }

  /** Begins a finer reference world; 0: no reference. */
  reference(refinement: number): Fault[] {
    return this.faults('sheave_reference', ['number'], [refinement]);
  }
  stepReference(): boolean {
    return this.number('sheave_step_reference') !== 0;
  }
  /** Error relative to the size of the scene; NaN without a reference. */
  get error(): number {
    return this.number('sheave_error');
  }

  certificate(reset: boolean): Certificate {
    const text = this.call('sheave_certificate', 'string', ['number'], [reset ? 1 : 0]) as string;
    return JSON.parse(text) as Certificate;
  }
  hash(): string {
    return this.text('sheave_hash');
  }

  dispose(): void {
    if (this.handle !== 0) this.call('sheave_close', null, [], []);
    this.handle = 0;
  }

  private open(): number {
    if (this.handle === 0) throw new Error('this machine has been closed');
    return this.handle;
  }
  private call(name: string, result: string | null, types: string[], values: unknown[]): unknown {
    return this.module.ccall(name, result, ['number', ...types], [this.open(), ...values]);
  }
  private number(name: string): number {
    return this.call(name, 'number', [], []) as number;
  }
  private text(name: string): string {
    return this.call(name, 'string', [], []) as string;
  }
  private faults(name: string, types: string[], values: unknown[]): Fault[] {
    const answer = JSON.parse(this.call(name, 'string', types, values) as string) as { errors?: Fault[] };
    return answer.errors ?? [];
  }
}
