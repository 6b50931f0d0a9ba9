// Parts of the playground that need no browser.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { underlined } from '../src/editor';
import type { Fault } from '../src/engine';
import { readLink, writeLink } from '../src/link';
import { Player } from '../src/player';

const fault = (line: number, column: number): Fault => ({ line, column, pointer: '', message: 'm', text: 'm' });
const words = (text: string, ...faults: Fault[]): string[] =>
  underlined(text, faults).map(([from, to]) => text.slice(from, to));

test('a fault underlines the word it is at', () => {
  const text = '{\n  "mass": -1.5e3,\n  "név 🪢 x": "a \\" b", []\n}';
  assert.deepEqual(words(text, fault(2, 11)), ['-1.5e3']);
  assert.deepEqual(words(text, fault(2, 3)), ['"mass"']);
  // Columns count characters: the knot is one of them, and two units of the string.
  assert.deepEqual(words(text, fault(3, 14)), ['"a \\" b"']);
  assert.deepEqual(words(text, fault(3, 24)), ['[']);
});

test('faults without a place, or beyond the text, underline nothing or its end', () => {
  assert.deepEqual(words('{}', fault(0, 0)), []);
  assert.deepEqual(words('{}', fault(5, 1)), []);
  assert.deepEqual(words('{}', fault(1, 99)), ['']);
  assert.deepEqual(words('', fault(1, 1)), ['']);
});

test('faults are underlined in the order of the text', () => {
  assert.deepEqual(words('a b\nc', fault(2, 1), fault(1, 3), fault(1, 1)), ['a', 'b', 'c']);
});

test('a link gives back what it was made of', async () => {
  const content = {
    text: '// Seil über Rollen 🪢\n{"format": "sheave-scene/1"}'.repeat(40),
    settings: { solver: 'gauss-seidel', integrator: 'xpbd', substeps: 3, iterations: 70, gravity: [0, -1.5, 0] },
  } as const;
  const hash = await writeLink({ ...content, settings: { ...content.settings, gravity: [0, -1.5, 0] } });
  assert.match(hash, /^#[\w.%&=-]+$/);
  assert.deepEqual(await readLink(hash), content);
  assert.deepEqual(await readLink(await writeLink({ scene: 'paper/pulley', settings: {} })), {
    scene: 'paper/pulley',
    settings: {},
  });
});

test('what a link says that means nothing is left out', async () => {
  const link = '#scene=../../etc/passwd&solver=magic&substeps=-1&iterations=x&gravity=1,2';
  assert.deepEqual(await readLink(link), { settings: {} });
});

test('a player without an end waits there; one with an end stops', () => {
  for (const endless of [false, true]) {
    const player = new Player();
    player.endless = endless;
    player.setRange(0, 1);
    player.seek(0.95);
    player.play();
    player.tick(0);
    player.tick(100);
    assert.equal(player.time, 1);
    assert.equal(player.playing, endless);
    player.play();
    assert.equal(player.time, endless ? 1 : 0);
  }
});
