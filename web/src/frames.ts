// The frames of a run: one number per channel and frame. The code that shows frames does not depend
// on their source, which is a file or a running engine.

import type { Channel, Machine, MachineEvent } from './machine';

export class Frames {
  readonly machine: Machine;
  readonly channels: readonly Channel[];
  /** Events in the order of time. */
  readonly events: MachineEvent[] = [];
  private readonly index = new Map<string, number>();
  private times: Float64Array;
  private columns: Float64Array[];
  private size = 0;

  constructor(machine: Machine, channels: readonly Channel[]) {
    this.machine = machine;
    this.channels = channels;
    channels.forEach((channel, i) => this.index.set(channel.name, i));
    this.times = new Float64Array(0);
    this.columns = channels.map(() => this.times);
  }

  /** Number of frames. */
  get count(): number {
    return this.size;
  }
  /** Index of a channel; -1 if no channel has that name. */
  channel(name: string): number {
    return this.index.get(name) ?? -1;
  }
  /** Time of a frame [s]. */
  time(frame: number): number {
    return this.times[frame];
  }
  /**
   * All times, and all values of a channel. These views do not include frames that are added later.
   */
  allTimes(): Float64Array {
    return this.times.subarray(0, this.size);
  }
  series(channel: number): Float64Array {
    return this.columns[channel].subarray(0, this.size);
  }

  /** Whether a value is known; forces are unknown before the first step. */
  isKnown(channel: number, frame: number): boolean {
    return Number.isFinite(this.columns[channel][frame]);
  }

  /** Takes complete columns, as from a file. */
  adopt(times: Float64Array, columns: Float64Array[]): void {
    if (columns.length !== this.channels.length || columns.some((c) => c.length !== times.length)) {
      throw new Error(`a recording of ${this.channels.length} channels has other columns`);
    }
    this.times = times;
    this.columns = columns;
    this.size = times.length;
  }

  /** Appends a frame: one value per channel. */
  push(time: number, values: ArrayLike<number>): void {
    if (values.length !== this.channels.length) {
      throw new Error(`${values.length} values for ${this.channels.length} channels`);
    }
    if (this.size === this.times.length) this.grow(Math.max(64, 2 * this.size));
    this.times[this.size] = time;
    for (let i = 0; i < values.length; ++i) this.columns[i][this.size] = values[i];
    this.size += 1;
  }

  /** Removes the frames from index `count` on, after the world has gone back in time. */
  truncate(count: number): void {
    this.size = Math.min(this.size, count);
  }

  /** Index of the last frame that is not later than `time`; the first frame if all are later. */
  frameAt(time: number): number {
    let low = 0;
    let high = this.size - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** The values of one frame. */
  read(frame: number, out: Float64Array): void {
    for (let i = 0; i < out.length; ++i) out[i] = this.columns[i][frame];
  }

  private grow(capacity: number): void {
    const larger = (old: Float64Array): Float64Array => {
      const made = new Float64Array(capacity);
      made.set(old.subarray(0, this.size));
      return made;
    };
    this.times = larger(this.times);
    this.columns = this.columns.map(larger);
  }
}
