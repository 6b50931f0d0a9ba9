// The page in a browser: with a small machine that stands in the test.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { contrast, leastBodyContrast, leastContrast } from '../../src/contrast';
import { filled, packExact, winch } from '../pages';
import type { Chromium, OpenedPage } from './chromium';
import { notDrawing, open, startChromium } from './chromium';

const template = readFileSync('dist/view.html', 'utf8');
const folder = mkdtempSync(join(tmpdir(), 'sheave-page-'));
const path = join(folder, 'winch.html');
writeFileSync(path, filled(template, packExact(winch())));

let chromium: Chromium;
before(async () => {
  chromium = await startChromium();
});
after(async () => {
  await chromium.close();
  rmSync(folder, { recursive: true });
});

const limit = { timeout: 120_000 };
const time = ({ page }: OpenedPage): Promise<number> => page.evaluate('sheave.player.time') as Promise<number>;

test('opens without a fault, from a file, without a network, and draws', limit, async () => {
  const opened = await open(chromium, path);
  const { page, faults } = opened;
  assert.equal(await page.title(), 'winch – Sheave');
  // More than the background's colour.
  const colours = await page.evaluate(`(() => {
    sheave.scene.picture();
    const copy = document.createElement('canvas');
    copy.width = copy.height = 100;
    const context = copy.getContext('2d');
    context.drawImage(sheave.scene.canvas, 0, 0, 100, 100);
    const data = new Uint32Array(context.getImageData(0, 0, 100, 100).data.buffer);
    return new Set(data).size;
  })()`);
  assert.ok(Number(colours) > 20, `${colours} colours`);
  assert.deepEqual(faults, []);
  await page.close();
});

test('everything by keys', limit, async () => {
  const opened = await open(chromium, path);
  const { page, faults } = opened;
  const press = (key: string) => page.keyboard.press(key as 'Home');
  // A page opens with the highest tension, and plays from the beginning.
  const first = await time(opened);
  assert.equal(first, await page.evaluate(`(() => {
    const series = sheave.frames.series(sheave.frames.channel('rope.0.tension'));
    const known = [...series].map((t) => (Number.isFinite(t) ? t : 0));
    return sheave.frames.time(known.indexOf(Math.max(...known)));
  })()`));
  await press('Space');
  await page.waitForFunction(`sheave.player.time !== ${first}`, { timeout: 20_000 });
  await press('Space');
  await press('Home');
  await press('ArrowRight');
  assert.equal(await time(opened), 0.1);
  await press('End');
  assert.equal(await time(opened), 1);
  await press('ArrowLeft');
  assert.equal(await time(opened), 0.9);
  await press('Home');
  assert.equal(await time(opened), 0);
  await press('+');
  assert.equal(await page.evaluate('sheave.player.speed'), 2);
  await press('-');
  await press('l');
  assert.equal(await page.evaluate('sheave.player.loop'), true);
  await press('Space');
  assert.equal(await page.evaluate('sheave.player.playing'), true);
  await page.waitForFunction('sheave.player.time > 0.3', { timeout: 20_000 });
  await press('Space');
  assert.equal(await page.evaluate('sheave.player.playing'), false);
  const theme = await page.evaluate('document.documentElement.dataset.theme');
  await press('t');
  assert.notEqual(await page.evaluate('document.documentElement.dataset.theme'), theme);
  await press('?');
  assert.equal(await page.evaluate('document.querySelector("dialog").open'), true);
  await press('Escape');
  assert.equal(await page.evaluate('document.querySelector("dialog").open'), false);
  assert.deepEqual(faults, []);
  await page.close();
});

test('a tap on a span shows its numbers, in step with the time; events are marks', limit, async () => {
  const opened = await open(chromium, path);
  const { page, faults } = opened;
  await page.evaluate('sheave.player.seek(0.5)');
  // Where the middle of the span is in the window.
  const place = (await page.evaluate(`(() => {
    const { scene } = sheave;
    scene.camera.updateMatrixWorld();
    const v = scene.camera.position.clone().set(0.5, -0.5, 0).project(scene.camera);
    const r = scene.canvas.getBoundingClientRect();
    return [r.left + (0.5 + 0.5 * v.x) * r.width, r.top + (0.5 - 0.5 * v.y) * r.height];
  })()`)) as [number, number];
  await page.mouse.click(...place);
  const text = (): Promise<string> => page.$eval('.readout', (e) => (e as HTMLElement).innerText);
  assert.match(await text(), /rope, span 0/);
  const tension = 8 + Math.sin(10);
  assert.match(await text(), new RegExp(`tension\\s+${Number(tension.toPrecision(5))} N`));
  await page.keyboard.press('ArrowRight');
  assert.match(await text(), new RegExp(`tension\\s+${Number((8 + Math.sin(12)).toPrecision(5))} N`));
  await page.keyboard.press('Escape');
  assert.equal(await page.$eval('.readout', (e) => (e as HTMLElement).hidden), true);
  assert.equal(await page.$eval('.mark', (e) => (e as HTMLElement).title), '0.50 s: half way');
  assert.equal((await page.$$('.uplot')).length, 1);
  assert.deepEqual(faults, []);
  await page.close();
});

test('a legend names the kinds of events; axes are as the camera sees them', limit, async () => {
  const opened = await open(chromium, path);
  const { page, faults } = opened;
  assert.deepEqual(await page.$$eval('.event-kinds li', (all) => all.map((e) => e.textContent)), ['touch']);
  // A frame is drawn with the axes before each look.
  const axes = async (key: string): Promise<string | null> => {
    await page.keyboard.press(key as '1');
    await page.evaluate('sheave.scene.picture()');
    return page.$eval('.triad', (e) => e.getAttribute('aria-label'));
  };
  assert.equal(await axes('1'), 'axes: x right, y up, z along the view');
  assert.equal(await axes('2'), 'axes: x along the view, y up, z left');
  assert.equal(await axes('3'), 'axes: x right, y along the view, z down');
  assert.deepEqual(faults, []);
  await page.close();
});

// Curves keep the published colours on white, of which the first has 5.2.
test('texts, curves and marks have a contrast of 4.5, light and dark', limit, async () => {
  const opened = await open(chromium, path);
  const { page, faults } = opened;
  for (const scheme of ['light', 'dark']) {
    await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: scheme }]);
    await new Promise((resolve) => setTimeout(resolve, 300));
    assert.equal(await page.evaluate('document.documentElement.dataset.theme'), scheme);
    // "rgb(1, 2, 3)" of what is seen, and of the nearest opaque background behind it.
    const seen = (await page.evaluate(`(() => {
      const opaque = (color) => color.startsWith('rgb(');
      const behind = (e) => {
        for (; e; e = e.parentElement) {
          const color = getComputedStyle(e).backgroundColor;
          if (opaque(color)) return color;
        }
        return 'rgb(255, 255, 255)';
      };
      const all = [...document.querySelectorAll('#page *')].filter((e) => e.getClientRects().length > 0);
      const texts = all.filter((e) => !e.closest('svg, .uplot') &&
        [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()));
      const swatches = all.filter((e) => e.matches('.mark, .plots .keys i'));
      return [
        ...texts.map((e) => [e.textContent, getComputedStyle(e).color, behind(e)]),
        ...swatches.map((e) => [e.className, getComputedStyle(e).backgroundColor, behind(e.parentElement)]),
      ];
    })()`)) as [string, string, string][];
    assert.ok(seen.length > 15, `${seen.length} texts`);
    const hex = (rgb: string): string =>
      `#${rgb.match(/\d+/g)!.slice(0, 3).map((n) => Number(n).toString(16).padStart(2, '0')).join('')}`;
    for (const [name, color, ground] of seen) {
      const found = contrast(hex(color), hex(ground));
      assert.ok(found >= leastContrast, `${scheme}: "${name}" has ${found.toFixed(2)}`);
    }
  }
  assert.deepEqual(faults, []);
  await page.close();
});

// Bodies of all hues, light and dark, with three faces in view. A face has one colour, so colours of
// many pixels are faces; the edges between them are lines.
test('bodies have a contrast of 3 in dark mode', limit, async () => {
  const machine = winch();
  const colors = ['#1b2430', '#5a6675', '#0b5fae', '#7a2a00', '#00644a', '#c04040', '#f2e9d8', '#404040'];
  machine.parts = colors.map((color, k) => ({
    body: -1,
    shape: { type: 'box', size: [1, 1, 1] },
    position: [1.6 * (k % 4), 1.6 * Math.floor(k / 4), 0],
    orientation: [1, 0, 0, 0],
    color,
  })) as typeof machine.parts;
  machine.bars = [];
  machine.joint_pieces = [];
  machine.bounds = { min: [-1, -1, -1], max: [5.4, 2.4, 1] };
  machine.camera = { ...machine.camera, position: [14, 10, 16], target: [2.2, 0.7, 0] };
  const many = join(folder, 'colours.html');
  writeFileSync(many, filled(template, packExact(machine)));
  const { page, faults } = await open(chromium, many);
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'dark' }]);
  await new Promise((resolve) => setTimeout(resolve, 500));
  const counted = (await page.evaluate(`(async () => {
    await sheave.scene.picture();
    const { canvas } = sheave.scene;
    const copy = document.createElement('canvas');
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    const counts = new Map();
    for (let i = 0; i < data.length; i += 4) {
      const hex = '#' + [data[i], data[i + 1], data[i + 2]].map((b) => b.toString(16).padStart(2, '0')).join('');
      counts.set(hex, (counts.get(hex) ?? 0) + 1);
    }
    return [...counts].filter(([, count]) => count > 300);
  })()`)) as [string, number][];
  const faces = counted.map(([color]) => color).filter((color) => color !== '#1a1f27');
  assert.ok(faces.length >= colors.length, `${faces.length} faces`);
  for (const color of faces) {
    const found = contrast(color, '#1a1f27');
    assert.ok(found >= leastBodyContrast, `${color} has ${found.toFixed(2)}`);
  }
  assert.deepEqual(faults, []);
  await page.close();
});

test('a long title and a long doubt are told as a whole, on a phone and on a screen', limit, async () => {
  const name = 'Container crane with forty settings, from rest, in the wind of a storm';
  const text = `doubtful: ${'the stretch of the span fore rope.2 does not fit its tension; '.repeat(4)}`;
  const long = join(folder, 'long.html');
  writeFileSync(long, filled(template, packExact({ ...winch(), name, verdict: { clean: false, text } })));
  const { page, faults } = await open(chromium, long);
  for (const [width, height] of [[390, 844], [1280, 800]]) {
    await page.setViewport({ width, height });
    await new Promise((resolve) => setTimeout(resolve, 300));
    for (const part of ['.top h1', '.note', '.verdict']) {
      const cut = await page.$eval(part, (e) => [e.scrollWidth - e.clientWidth, e.scrollHeight - e.clientHeight]);
      assert.ok(Math.max(...cut) <= 1, `${part} at ${width}: ${cut}`);
    }
    const stage = (await page.$eval('.stage', (e) => e.getBoundingClientRect().toJSON())) as DOMRect;
    assert.ok(stage.height > 200, JSON.stringify(stage));
  }
  assert.deepEqual(faults, []);
  await page.close();
});

test('fits on a phone', limit, async () => {
  const opened = await open(chromium, path);
  const { page, faults } = opened;
  await page.setViewport({ width: 360, height: 740, hasTouch: true, isMobile: true });
  await new Promise((resolve) => setTimeout(resolve, 300));
  const width = await page.evaluate('document.documentElement.scrollWidth');
  assert.equal(width, 360);
  const stage = (await page.$eval('.stage', (e) => e.getBoundingClientRect().toJSON())) as DOMRect;
  assert.ok(stage.width > 350 && stage.height > 200, JSON.stringify(stage));
  assert.deepEqual(faults, []);
  await page.close();
});

/** The farthest corner of the machine from the middle of the picture; 1 is its edge. */
const reach = ({ page }: OpenedPage): Promise<number> =>
  page.evaluate(`(() => {
    const { camera } = sheave.scene;
    const { min, max } = sheave.state.machine.bounds;
    camera.updateMatrixWorld();
    const times = (m, v) => [0, 1, 2, 3].map((row) => v.reduce((sum, x, k) => sum + m[row + 4 * k] * x, 0));
    let most = 0;
    for (let i = 0; i < 8; ++i) {
      const corner = [0, 1, 2].map((k) => ((i >> k) & 1 ? max : min)[k]);
      const eye = times(camera.matrixWorldInverse.elements, [...corner, 1]);
      const [x, y, , w] = times(camera.projectionMatrix.elements, eye);
      most = Math.max(most, Math.abs(x / w), Math.abs(y / w));
    }
    return most;
  })()`) as Promise<number>;

test('a wide machine is wholly in the picture on a phone and on a screen, from all sides', limit, async () => {
  const machine = winch();
  machine.bounds = { min: [-40, -1, -1], max: [40, 3, 1] };
  const wide = join(folder, 'wide.html');
  writeFileSync(wide, filled(template, packExact(machine)));
  const opened = await open(chromium, wide);
  const { page, faults } = opened;
  for (const [width, height] of [[1280, 800], [390, 844], [1280, 800]]) {
    await page.setViewport({ width, height });
    await new Promise((resolve) => setTimeout(resolve, 300));
    for (const key of ['f', '1', '2', '3', 'f']) {
      await page.keyboard.press(key as 'f');
      const most = await reach(opened);
      assert.ok(most < 1 && most > 0.5, `${key} at ${width}: ${most}`);
    }
  }
  // The panels get their content after the first picture: nobody has pressed a key here.
  await page.reload();
  await page.waitForFunction('window.sheave !== undefined');
  await new Promise((resolve) => setTimeout(resolve, 500));
  assert.ok((await reach(opened)) < 1);
  assert.deepEqual(faults, []);
  await page.close();
});

test('tells the verdict of the certificate', limit, async () => {
  for (const [clean, text] of [[true, 'certificate: clean'], [false, 'doubtful: the span rope.0']] as const) {
    const judged = join(folder, 'judged.html');
    writeFileSync(judged, filled(template, packExact({ ...winch(), verdict: { clean, text } })));
    const { page, faults } = await open(chromium, judged);
    assert.equal(await page.$eval('.verdict', (e) => e.textContent), text);
    assert.equal((await page.$$('.verdict.doubtful')).length, clean ? 0 : 1);
    assert.deepEqual(faults, []);
    await page.close();
  }
  const { page } = await open(chromium, path);
  assert.equal((await page.$$('.verdict')).length, 0);
  await page.close();
});

test('without WebGL it says so, and the curves are there', limit, async () => {
  const plain = await startChromium(notDrawing);
  const { page, faults } = await open(plain, path);
  assert.match(await page.$eval('.no-webgl', (e) => e.textContent ?? ''), /WebGL 2/);
  assert.equal((await page.$$('.uplot')).length, 1);
  await page.keyboard.press('End');
  assert.equal(await page.evaluate('sheave.player.time'), 1);
  assert.deepEqual(faults, []);
  await plain.close();
});
