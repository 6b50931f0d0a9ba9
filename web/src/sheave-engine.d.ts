// The module that emscripten makes from web/engine; build_playground.mjs sets its path.

declare module 'sheave-engine' {
  import type { ModuleFactory } from './engine';
  const createEngine: ModuleFactory;
  export default createEngine;
}
