// What emscripten makes of web/engine; build.mjs knows where it is.

declare module 'sheave-engine' {
  import type { ModuleFactory } from './engine';
  const createEngine: ModuleFactory;
  export default createEngine;
}
