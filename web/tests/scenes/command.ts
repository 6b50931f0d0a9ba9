// Scenes of the repository, run by the command.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';

const root = resolve('..');
export const command = process.env['SHEAVE'] ?? join(root, 'build/release/tools/sheave');

/** Of every kind of thing that is drawn: drums, sag, weight, cuts, wraps, outlines, contacts, springs, space. */
const some = [
  'paper/pulley', 'paper/gym', 'paper/shapes', 'paper/bow', 'machines/obstacle-course',
  'machines/brake-failure', 'stress/box-stack', 'analytic/tumbling-body', 'analytic/hanging-ropes',
];

/** Names of scenes: of all with SCENES=all, of those that SCENES names, or some of each kind. */
export function sceneNames(): string[] {
  const wanted = process.env['SCENES'];
  if (wanted === 'all') {
    return ['paper', 'analytic', 'machines', 'stress'].flatMap((folder) =>
      readdirSync(join(root, 'scenes', folder))
        .filter((name) => name.endsWith('.json'))
        .map((name) => `${folder}/${basename(name, '.json')}`),
    );
  }
  return wanted ? wanted.split(',') : some;
}

export const scenePath = (name: string): string => join(root, 'scenes', `${name}.json`);

export function sheave(...parameters: string[]): void {
  execFileSync(command, parameters, { stdio: ['ignore', 'ignore', 'pipe'], maxBuffer: 1 << 24 });
}

export function inFolder<T>(action: (folder: string) => Promise<T>): Promise<T> {
  const folder = mkdtempSync(join(tmpdir(), 'sheave-scenes-'));
  return action(folder).finally(() => rmSync(folder, { recursive: true, force: true }));
}
