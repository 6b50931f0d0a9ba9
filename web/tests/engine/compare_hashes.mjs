// node compare_hashes.mjs ENGINE SHEAVE [SECONDS] SCENE...: runs scenes here and natively, and
// compares the hashes of their last states, for the scenes' own settings and for the other solver
// and integrator. SECONDS 0: the whole duration.

import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';

import { loadEngine } from './node_engine.mjs';

const [folder, sheave, seconds, ...scenes] = process.argv.slice(2);
const engine = await loadEngine(folder);
const choices = [
  {},
  { '/step/solver': '"direct"', '/step/integrator': '"rattle"' },
  { '/step/solver': '"gauss-seidel"', '/step/integrator': '"xpbd"' },
];

/** What the command says of a run. */
function native(scene, choice) {
  const options = ['run', scene, '--json'];
  for (const [pointer, value] of Object.entries(choice)) {
    options.push('--set', `${pointer}=${value.replaceAll('"', '')}`);
  }
  if (seconds !== '0') options.push('--duration', seconds);
  const run = spawnSync(sheave, options, { encoding: 'utf8', maxBuffer: 1 << 28 });
  return run.stdout === '' ? { fault: run.stderr } : JSON.parse(run.stdout);
}

let compared = 0;
let different = 0;
for (const scene of scenes) {
  for (const choice of choices) {
    const right = native(scene, choice);
    if (right.fault !== undefined) {
      console.log(`${scene}: ${right.fault.trim()}`);
      different += 1;
      continue;
    }
    const machine = engine.open(readFileSync(scene, 'utf8'), choice);
    let ending = 0;
    while (ending === 0 && engine.time(machine) < right.sim_time - 1e-9) ending = engine.step(machine);
    const hash = engine.hash(machine);
    engine.close(machine);
    compared += 1;
    if (hash !== right.state_hash) {
      different += 1;
      console.log(`${scene} ${JSON.stringify(choice)}: native ${right.state_hash}, here ${hash}`);
    }
  }
}
console.log(`${compared} runs compared, ${different} different`);
process.exitCode = different === 0 && compared > 0 ? 0 : 1;
