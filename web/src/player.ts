// The time that is shown, and its progress.

export const speeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];

/** A longer time between two pictures is a pause of the browser and not made up for [s]. */
const longestPicture = 2;

export class Player {
  time = 0;
  playing = false;
  speed = 1;
  loop = false;
  /** Whether the range can grow because an engine runs: at its end the player then waits. */
  endless = false;
  private begin = 0;
  private end = 0;
  private last = NaN;
  private isStill = false;
  private readonly listeners: (() => void)[] = [];

  /** Calls `listener` after every change. */
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  get range(): [number, number] {
    return [this.begin, this.end];
  }
  /** Range of the available times [s]; it grows while an engine runs. */
  setRange(begin: number, end: number): void {
    this.begin = begin;
    this.end = end;
    this.time = Math.min(Math.max(this.time, begin), end);
    this.changed();
  }

  seek(time: number): void {
    this.isStill = false;
    this.time = Math.min(Math.max(time, this.begin), this.end);
    this.changed();
  }
  /** Shows a moment before anything has been played; play() then starts from the beginning. */
  showStill(time: number): void {
    this.seek(time);
    this.isStill = true;
  }
  /** Plays; from the beginning if the end has been reached, or if a still is shown. */
  play(): void {
    if (this.isStill || (this.time >= this.end && !this.endless)) this.time = this.begin;
    this.isStill = false;
    this.playing = true;
    this.changed();
  }
  pause(): void {
    this.playing = false;
    this.changed();
  }
  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }
  setLoop(loop: boolean): void {
    this.loop = loop;
    this.changed();
  }
  setSpeed(speed: number): void {
    this.speed = speed;
    this.changed();
  }
  /** Selects the next faster (1) or slower (-1) of `speeds`. */
  changeSpeed(by: 1 | -1): void {
    const faster = speeds.filter((s) => (by > 0 ? s > this.speed : s < this.speed));
    const next = by > 0 ? faster[0] : faster[faster.length - 1];
    if (next !== undefined) this.setSpeed(next);
  }

  /** The time until the next tick is not made up for: the page was hidden. */
  skipPause(): void {
    this.last = NaN;
  }

  /**
   * To be called for every animation frame of the browser; `now` in milliseconds. If pictures take
   * long, playback skips frames and keeps its speed.
   */
  tick(now: number): void {
    const passed = Number.isNaN(this.last) ? 0 : Math.min((now - this.last) / 1000, longestPicture);
    this.last = now;
    if (!this.playing) return;
    const next = this.time + passed * this.speed;
    if (next < this.end) {
      this.time = next;
    } else if (this.loop && !this.endless && this.end > this.begin) {
      this.time = this.begin + ((next - this.begin) % (this.end - this.begin));
    } else {
      this.time = this.end;
      this.playing = this.endless;
    }
    this.changed();
  }

  private changed(): void {
    for (const listener of this.listeners) listener();
  }
}
