// The engine in Node, for tests and measurements.

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';

/** The module that emscripten made in `folder`, with calls by name. */
export async function loadEngine(folder) {
  const createEngine = createRequire(import.meta.url)(resolve(folder, 'sheave_engine.cjs'));
  const module = await createEngine({ wasmBinary: readFileSync(join(folder, 'sheave_engine.wasm')) });
  const call = (name, result, types, ...values) => module.ccall(`sheave_${name}`, result, types, values);
  return {
    open(text, overrides = {}) {
      const machine = call('open', 'number', ['string', 'string'], text, JSON.stringify(overrides));
      if (machine === 0) throw new Error(call('text', 'string', []));
      return machine;
    },
    /** 0: done; else it has ended. */
    step: (machine) => module._sheave_step(machine) % 4,
    text: () => call('text', 'string', []),
    time: (machine) => call('time', 'number', ['number'], machine),
    hash: (machine) => call('hash', 'string', ['number'], machine),
    /** One value per channel, copied. */
    sample(machine, count) {
      const place = call('sample', 'number', ['number'], machine) / 8;
      return module.HEAPF64.slice(place, place + count);
    },
    describe: (machine) => JSON.parse(call('describe', 'string', ['number'], machine)),
    close: (machine) => call('close', null, ['number'], machine),
  };
}
