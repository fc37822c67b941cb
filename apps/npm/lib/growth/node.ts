/** In Node: the core computes in a worker thread. */
import { beside } from '../engine.js';
import { makers } from '../makers.js';
import { thread } from '../thread.js';

const address = new URL('./node-worker.js', import.meta.url);

export const { grow, schema, close } = makers(beside(() => thread(address)));
export * from '../exports.js';
