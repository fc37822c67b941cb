/** In Node, in this thread: nothing else goes on in it while a plant is made, and a signal stops only what waits. */
import { readFile } from 'node:fs/promises';
import init, * as core from './core/burgeon_npm.js';
import { here } from '../engine.js';
import { makers } from '../makers.js';

const load = async (): Promise<typeof core> => {
  const bytes = await readFile(new URL('./core/burgeon_npm_bg.wasm', import.meta.url));
  await init({ module_or_path: bytes });
  return core;
};

export const { grow, schema, close } = makers(here(load));
export * from '../exports.js';
