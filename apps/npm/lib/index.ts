/** In a page: the core computes in a worker. */
import { beside, pageWorker } from './engine.js';
import { makers } from './makers.js';

const address = (): string => {
  const here = import.meta.url;
  return new URL('./worker.js', here).href;
};
const own = (): Worker => new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });

export const { grow, sketch, leaf, bloom, schema, close } = makers(beside(() => pageWorker(own, address())));
export * from './exports.js';
