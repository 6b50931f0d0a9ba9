// Curves of selected channels, one chart per unit, synchronised with the time line.

import uPlot from 'uplot';

import { readable } from './contrast';
import { button, element } from './dom';
import type { Frames } from './frames';
import { numberText, quantityText } from './numbers';
import type { Player } from './player';
import { isDark } from './theme';
import { unitScale } from './units';

/** Okabe and Ito's colours, which colour-blind readers can distinguish, and dashes in addition. */
const strokes = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#7a7a7a'];
const dashes: number[][] = [[], [8, 4], [2, 3], [10, 3, 2, 3]];
const chartHeight = 170;

/** The colour of a curve in the page's present style. */
function strokeOf(k: number): string {
  const color = strokes[k % strokes.length];
  const paper = getComputedStyle(document.documentElement).getPropertyValue('--paper').trim();
  return readable(color, /^#[0-9a-f]{6}$/i.test(paper) ? paper : isDark() ? '#222933' : '#ffffff');
}

export class Plots {
  readonly element = element('div', { class: 'plots' });
  private chosen: string[] = [];
  private charts: uPlot[] = [];
  private drawnCount = -1;
  private values: [HTMLElement, number, string][] = [];
  private readonly resizing: ResizeObserver;
  private readonly listeners: (() => void)[] = [];

  constructor(
    private readonly frames: Frames,
    private readonly player: Player,
  ) {
    player.onChange(() => this.update());
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(this.element);
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
  /** Names of the shown channels. */
  get names(): readonly string[] {
    return this.chosen;
  }
  has(name: string): boolean {
    return this.chosen.includes(name);
  }
  choose(names: readonly string[]): void {
    this.chosen = names.filter((name) => this.frames.channel(name) >= 0);
    this.build();
    for (const listener of this.listeners) listener();
  }
  toggle(name: string): void {
    this.choose(this.has(name) ? this.chosen.filter((n) => n !== name) : [...this.chosen, name]);
  }
  /** Rebuilds the charts with the axis colours of the page's present style. */
  restyle(): void {
    this.build();
  }

  private build(): void {
    for (const chart of this.charts) chart.destroy();
    this.element.replaceChildren();
    this.values = [];
    const units = new Map<string, string[]>();
    for (const name of this.chosen) {
      const unit = this.frames.channels[this.frames.channel(name)].unit;
      units.set(unit, [...(units.get(unit) ?? []), name]);
    }
    this.charts = [...units].map(([unit, names]) => this.chart(unit, names));
    this.drawnCount = this.frames.count;
    this.tell();
    if (this.chosen.length === 0) {
      this.element.append(element('p', { class: 'hint' }, 'Choose quantities to see their course.'));
    }
  }

  private chart(unit: string, names: string[]): uPlot {
    const style = getComputedStyle(document.documentElement);
    const ink = style.getPropertyValue('--ink').trim() || '#222';
    const grid = { stroke: style.getPropertyValue('--line').trim() || '#ddd', width: 1 };
    const axis = { stroke: ink, grid, ticks: grid, font: '11px system-ui, sans-serif' };
    const scale = unitScale(this.largest(names), unit);
    const options: uPlot.Options = {
      width: this.width(),
      height: chartHeight,
      legend: { show: false },
      cursor: { sync: { key: 'sheave' }, drag: { x: false, y: false } },
      scales: { x: { time: false } },
      axes: [
        axis,
        { ...axis, size: 62, label: unit ? scale.prefix + unit : '1', labelSize: 16, labelFont: '11px system-ui, sans-serif',
          values: (_, ticks) => ticks.map((t) => numberText(t / scale.factor, 4)) },
      ],
      series: [
        { label: 't [s]' },
        ...names.map((name, k) => ({
          label: name,
          stroke: strokeOf(k),
          dash: dashes[Math.floor(k / strokes.length) % dashes.length],
          width: 1.5,
          points: { show: false },
        })),
      ],
      hooks: { draw: [(chart) => this.drawNow(chart, ink)] },
    };
    const chart = new uPlot(options, this.data(names), this.element);
    this.element.append(this.keys(names, unit));
    chart.over.addEventListener('pointerdown', (event) => this.seek(chart, event));
    chart.over.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) this.seek(chart, event);
    });
    return chart;
  }

  /** Names beside their colours, with the present values; a press removes the curve. */
  private keys(names: string[], unit: string): HTMLElement {
    const list = element('ul', { class: 'keys' });
    names.forEach((name, k) => {
      const value = element('output');
      const swatch = element('i', { style: `background: ${strokeOf(k)}` });
      const remove = button('×', `no curve of ${name} any more`, () => this.toggle(name));
      list.append(element('li', {}, swatch, element('span', {}, name), value, remove));
      this.values.push([value, this.frames.channel(name), unit]);
    });
    return list;
  }

  /** Largest size of the values of some channels. */
  private largest(names: string[]): number {
    let largest = 0;
    for (const name of names) {
      for (const v of this.frames.series(this.frames.channel(name))) {
        if (Number.isFinite(v)) largest = Math.max(largest, Math.abs(v));
      }
    }
    return largest;
  }

  private data(names: string[]): uPlot.AlignedData {
    // Unknown values, such as forces before the first step, are gaps.
    return [
      this.frames.allTimes(),
      ...names.map((name) => {
        const channel = this.frames.channel(name);
        return Array.from(this.frames.series(channel), (v, k) =>
          this.frames.isKnown(channel, k) ? v : null,
        );
      }),
    ] as uPlot.AlignedData;
  }

  /** Draws a line at the player's time. */
  private drawNow(chart: uPlot, ink: string): void {
    const x = chart.valToPos(this.player.time, 'x', true);
    const { left, top, width, height } = chart.bbox;
    if (!(x >= left && x <= left + width)) return;
    const context = chart.ctx;
    context.save();
    context.strokeStyle = ink;
    context.lineWidth = window.devicePixelRatio;
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
    context.restore();
  }

  private seek(chart: uPlot, event: PointerEvent): void {
    const bounds = chart.over.getBoundingClientRect();
    this.player.pause();
    this.player.seek(chart.posToVal(event.clientX - bounds.left, 'x'));
  }
  private update(): void {
    if (this.frames.count !== this.drawnCount) {
      this.drawnCount = this.frames.count;
      for (const chart of this.charts) {
        chart.setData(this.data(chart.series.slice(1).map((s) => String(s.label))));
      }
      this.tell();
      return;
    }
    for (const chart of this.charts) chart.redraw(false, false);
    this.tell();
  }
  private tell(): void {
    if (this.frames.count === 0) return;
    const frame = this.frames.frameAt(this.player.time);
    for (const [cell, channel, unit] of this.values) {
      const known = this.frames.isKnown(channel, frame);
      cell.textContent = quantityText(known ? this.frames.series(channel)[frame] : NaN, unit);
    }
  }
  private width(): number {
    return Math.max(this.element.clientWidth, 200);
  }
  private resize(): void {
    for (const chart of this.charts) chart.setSize({ width: this.width(), height: chartHeight });
  }
}
