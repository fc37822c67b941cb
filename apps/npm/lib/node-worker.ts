/** The worker thread of Node. */
import { readFile } from 'node:fs/promises';
import { parentPort } from 'node:worker_threads';
import init, * as core from './core/burgeon_npm.js';
import { type Scope, serve } from './serve.js';

const load = async (): Promise<typeof core> => {
  const bytes = await readFile(new URL('./core/burgeon_npm_bg.wasm', import.meta.url));
  await init({ module_or_path: bytes });
  return core;
};

serve(load(), parentPort as unknown as Scope);
