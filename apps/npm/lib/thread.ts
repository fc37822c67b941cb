/** Threads of Node, as `beside` uses the workers of a page. */
import { Worker } from 'node:worker_threads';
import type { Asking, Said } from './protocol.js';
import type { Beside } from './engine.js';

/** A thread that keeps the program alive only while it is asked something. */
export function thread(address: URL): Beside {
  // What Node was told of the program's own script, such as `--input-type`, is not for a file of the package.
  const own = new Worker(address, { execArgv: [] });
  const made: Beside = {
    onmessage: null,
    onerror: null,
    postMessage(message: { number: number; asking: Asking }) {
      own.ref();
      own.postMessage(message);
    },
    terminate() {
      own.removeAllListeners();
      // What it says last is nobody's.
      own.on('error', () => undefined);
      void own.terminate();
    },
  };
  own.on('message', (data: Said) => {
    // A coarse copy is not the end of it.
    if (!('first' in data)) own.unref();
    made.onmessage?.({ data });
  });
  own.on('error', (e: Error) => made.onerror?.({ message: e.message }));
  own.on('exit', (code) => made.onerror?.({ message: `it ended with ${code}` }));
  return made;
}
