// node bench/web/web_bench.mjs ENGINE SHEAVE: the engine in WebAssembly beside the native one, and
// beside MuJoCo's own WebAssembly, in one run of Node. Prints bench/WEB.md.
//
// ENGINE: the folder with sheave_engine.cjs; SHEAVE: the native command. Times are medians of
// repetitions that take turns, so that what else the machine does disturbs all alike.

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { cpus } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

import { loadEngine } from '../../web/tests/engine/node_engine.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, '../..');
const [folder, sheave] = process.argv.slice(2).map((p) => resolve(p));
const engine = await loadEngine(folder);
const webPackages = createRequire(join(root, 'web/package.json'));
const loadMujoco = (await import(pathToFileURL(webPackages.resolve('@mujoco/mujoco')))).default;
const mujoco = await loadMujoco();

const repetitions = 7;
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const number = (x) => (x >= 0.01 ? String(Number(x.toPrecision(3))) : x.toExponential(1));
const run = (...args) => JSON.parse(execFileSync(sheave, args, { encoding: 'utf8', maxBuffer: 1 << 28, stdio: ['ignore', 'pipe', 'ignore'] }));

/** Calls run() for so long [ms]: code that is new to Node is compiled again as it gets hot. */
function warm(run, time) {
  const start = performance.now();
  while (performance.now() - start < time) run();
}

/** The mean of what run() returns, over calls that together take so long [ms]. */
function sample(run, time) {
  const start = performance.now();
  const values = [];
  while (performance.now() - start < time) values.push(run());
  return values.reduce((a, b) => a + b, 0) / values.length;
}

/** Microseconds per step of a scene here, over so many steps from its start. */
function timeHere(text, overrides, steps) {
  const machine = engine.open(text, overrides);
  const start = performance.now();
  for (let k = 0; k < steps; ++k) {
    if (engine.step(machine) !== 0) throw new Error('a run that was to be measured ends');
  }
  const time = (1000 * (performance.now() - start)) / steps;
  const hash = engine.hash(machine);
  engine.close(machine);
  return { time, hash };
}

console.log(`# In WebAssembly

Made by \`node bench/web/web_bench.mjs build/web/web/engine build/release/tools/sheave > bench/WEB.md\`
on ${cpus()[0].model.trim()}, Node ${process.version}.

## Beside the native engine

| scene | native [us/frame] | WebAssembly [us/frame] | ratio | of a frame of 1/60 s | same bits |
|---|---|---|---|---|---|`);
let cold = 0;
for (const scene of ['gym', 'hand', 'hilbert3']) {
  const path = join(root, 'scenes/paper', `${scene}.json`);
  const text = readFileSync(path, 'utf8');
  const first = run('run', path, '--json', '--duration', '2');
  if (scene === 'gym') cold = timeHere(text, {}, 60).time;
  warm(() => timeHere(text, {}, first.steps), 2000);
  const native = [];
  const here = [];
  let hash = '';
  for (let k = 0; k < repetitions; ++k) {
    native.push(run('run', path, '--json', '--duration', '2').us_per_step);
    const one = timeHere(text, {}, first.steps);
    here.push(one.time);
    hash = one.hash;
  }
  // A step is not always a frame.
  const frame = (1 / 60) / (first.sim_time / first.steps);
  const [n, w] = [frame * median(native), frame * median(here)];
  console.log(
    `| ${scene} | ${number(n)} | ${number(w)} | ${number(w / n)} | ${number((100 * w) / (1e6 / 60))} % | ` +
      `${hash === first.state_hash ? 'yes' : 'no'} |`,
  );
}

// Weights m1, m2 on one cable over N discs of mass 1: a = (m2 - m1) g / (m1 + m2 + N / 2).
const gravity = 9.81;
const masses = [1, 2];
const radius = 0.5;
const wheelMass = 0.5; // inertia over the square of the radius
const dt = 1 / 60;
const frames = 60;

function xml(wheels, o) {
  const limit =
    `range="-1000 -1e-12" solreflimit="${o.constant > 0 ? `${o.constant * o.step} 1` : `${-1 / o.step ** 2} ${-1 / o.step}`}" ` +
    `solimplimit="0.9999 0.9999 0.001"`;
  const weight = (mass, k, axis) =>
    `<body><inertial pos="0 0 0" mass="${mass}" diaginertia="${mass} ${mass} ${mass}"/>` +
    `<joint name="q${k}" type="slide" axis="0 ${axis} 0"/></body>`;
  const inertia = wheelMass * radius ** 2;
  let bodies = weight(masses[0], 0, 1);
  for (let k = 1; k <= wheels; ++k) {
    bodies +=
      `<body><inertial pos="0 0 0" mass="1" diaginertia="${inertia} ${inertia} ${inertia}"/>` +
      `<joint name="q${k}" type="hinge" axis="0 0 1"/></body>`;
  }
  bodies += weight(masses[1], wheels + 1, -1);
  const factor = (k) => (k === 0 || k === wheels + 1 ? 1 : radius);
  let tendons = '';
  for (let k = 0; k <= wheels; ++k) {
    tendons +=
      `<fixed limited="true" ${limit}><joint joint="q${k}" coef="${-factor(k)}"/>` +
      `<joint joint="q${k + 1}" coef="${factor(k + 1)}"/></fixed>`;
  }
  return (
    `<mujoco><compiler inertiafromgeom="false" boundmass="0" boundinertia="0"/><size memory="64M"/>` +
    `<option timestep="${o.step}" gravity="0 ${-gravity} 0" solver="${o.solver}" jacobian="${o.jacobian}" ` +
    `integrator="${o.integrator}" iterations="${o.iterations}" tolerance="1e-10">` +
    `<flag contact="disable" equality="disable" frictionloss="disable" actuation="disable" sensor="disable"/>` +
    `</option><worldbody>${bodies}</worldbody><tendon>${tendons}</tendon></mujoco>`
  );
}

const acceleration = (wheels) => ((masses[1] - masses[0]) * gravity) / (masses[0] + masses[1] + wheels * wheelMass);

/** Root mean square over all coordinates of what they are off, largest of all frames [m]. */
function errorOf(read, wheels, step) {
  let worst = 0;
  for (let f = 1; f <= frames; ++f) {
    if (!step()) return Infinity;
    const right = 0.5 * acceleration(wheels) * (f * dt) ** 2;
    const places = read();
    const sum = places.reduce((s, q) => s + (q - right) ** 2, 0);
    worst = Math.max(worst, Math.sqrt(sum / places.length));
  }
  return Number.isFinite(worst) ? worst : Infinity;
}

function mujocoTrial(wheels, o) {
  const model = mujoco.MjModel.from_xml_string(xml(wheels, o));
  const data = new mujoco.MjData(model);
  const per = Math.round(dt / o.step);
  const step = () => {
    for (let k = 0; k < per; ++k) mujoco.mj_step(model, data);
    return Number.isFinite(data.qpos[0]);
  };
  const read = () =>
    Array.from(data.qpos, (q, k) => (k === 0 || k === wheels + 1 ? q : radius * q));
  const began = performance.now();
  const error = errorOf(read, wheels, step);
  const whole = (1000 * (performance.now() - began)) / frames;
  const time = () => {
    mujoco.mj_resetData(model, data);
    const start = performance.now();
    for (let f = 0; f < frames; ++f) step();
    return (1000 * (performance.now() - start)) / frames;
  };
  // What takes so long is measured again only if nothing else is as exact.
  const first = whole > 2000 ? whole : Math.min(time(), time());
  return { ...o, error, time, first, free: () => { data.delete(); model.delete(); } };
}

function sheaveTrial(wheels, name, overrides) {
  const text = execFileSync(sheave, ['generate', 'wheel-train', '--wheels', String(wheels)], { encoding: 'utf8' });
  const machine = engine.open(text, overrides);
  const { channels } = engine.describe(machine);
  const index = (channel) => channels.findIndex((c) => c.name === channel);
  const weights = [index('first weight.y'), index('last weight.y')];
  const angles = Array.from({ length: wheels }, (_, k) => index(`wheel ${k}.angle`));
  const start = engine.sample(machine, channels.length);
  const sign = (k) => (k % 2 === 0 || k === wheels - 1 ? -1 : 1);
  const read = () => {
    const now = engine.sample(machine, channels.length);
    return [
      now[weights[0]] - start[weights[0]],
      ...angles.map((c, k) => sign(k) * radius * (now[c] - start[c])),
      start[weights[1]] - now[weights[1]],
    ];
  };
  const error = errorOf(read, wheels, () => engine.step(machine) === 0);
  engine.close(machine);
  return { name, error, time: () => timeHere(text, overrides, frames).time };
}

console.log(`
The command times its steps alone; here each is called from JavaScript, and its certificate is part of it. Both columns of
times are of code that is hot: Node compiles what is new to it in two passes. The very first 60 steps (of gym) took ${number(cold)} us each.

## Beside MuJoCo's own WebAssembly

Weights of 1 and 2 kg on one cable over N discs (N = 1: Atwood's machine), 1 s in frames of 1/60 s, both in
this process, one thread each; MuJoCo ${mujoco.mj_versionString()} with fixed tendons. Errors are those of all positions against the
closed form: root mean square, largest of all frames. For each setting of Sheave the fastest of MuJoCo's with no larger
error, of all solvers, integrators, iterations, stiffnesses and steps that were tried; where none has so small an
error, the most exact one.

| wheels | Sheave | frame [us] | error [m] | MuJoCo | frame [us] | error [m] | Sheave's share |
|---|---|---|---|---|---|---|---|`);
for (const wheels of [1, 16, 64, 256]) {
  const settings = (solver, integrator, substeps) => ({
    '/step/solver': `"${solver}"`,
    '/step/integrator': `"${integrator}"`,
    '/step/substeps': String(substeps),
  });
  const ours = [
    sheaveTrial(wheels, 'direct, xpbd, 1 substep', settings('direct', 'xpbd', 1)),
    sheaveTrial(wheels, 'direct, rattle, 1 substep', settings('direct', 'rattle', 1)),
  ];
  const theirs = [];
  for (const solver of ['PGS', 'CG', 'Newton']) {
    for (const integrator of ['Euler', 'RK4', 'implicitfast']) {
      for (const constant of [0, 2]) {
        for (const iterations of wheels > 16 ? [10, 100] : [3, 10, 100]) {
          for (const substeps of wheels > 16 ? [1, 4, 16] : [1, 2, 4, 16, 64]) {
            for (const jacobian of wheels > 20 ? ['sparse'] : ['dense', 'sparse']) {
              const o = { solver, integrator, constant, iterations, jacobian, step: dt / substeps };
              const trial = mujocoTrial(wheels, o);
              trial.free();
              theirs.push(trial);
            }
          }
        }
      }
    }
  }
  for (const own of ours) {
    const good = theirs.filter((t) => t.error <= own.error * (1 + 1e-9));
    const best = good.length > 0
      ? good.reduce((a, b) => (a.first < b.first ? a : b))
      : theirs.reduce((a, b) => (a.error < b.error ? a : b));
    const other = mujocoTrial(wheels, best);
    const times = [[], []];
    warm(own.time, 500);
    warm(other.time, 500);
    for (let k = 0; k < repetitions; ++k) {
      times[0].push(sample(own.time, 50));
      times[1].push(sample(other.time, 50));
    }
    other.free();
    const [a, b] = times.map(median);
    console.log(
      `| ${wheels} | ${own.name} | ${number(a)} | ${number(own.error)} | ${best.solver}, ${best.integrator}, ` +
        `${best.iterations} iterations, ${Math.round(dt / best.step)} steps a frame${good.length > 0 ? '' : ', no setting is as exact'} | ` +
        `${number(b)} | ${number(other.error)} | ${number(a / b)} |`,
    );
  }
}
