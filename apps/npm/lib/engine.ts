/** Where the core computes: in this thread, or in a worker. */
import { BurgeonError } from './errors.js';
import type { Answer, Asking, Said } from './protocol.js';
import { type Core, work } from './work.js';

/** Does what is asked. */
export interface Engine {
  /** `first` gets the coarse copy of a large tree, before the answer. */
  ask(asking: Asking, signal?: AbortSignal, first?: (answer: Answer) => void): Promise<Answer | string>;
  /** Gives back the memory of the core; the next request starts it again. */
  close(): void;
}

/** In this thread. `load` starts a core; it is started anew after a fault of ours, which leaves it unusable. */
export function here(load: () => Promise<Core>): Engine {
  let core: Promise<Core> | undefined;
  return {
    async ask(asking, signal, first = () => {}) {
      core ??= load();
      let ready: Core;
      try {
        ready = await core;
      } catch (e) {
        core = undefined;
        throw e;
      }
      signal?.throwIfAborted();
      try {
        return work(ready, asking, first);
      } catch (e) {
        if (!(e instanceof BurgeonError)) core = undefined;
        throw e;
      }
    },
    close() {
      core = undefined;
    },
  };
}

interface Job {
  readonly number: number;
  readonly asking: Asking;
  first(answer: Answer): void;
  resolve(answer: Answer | string): void;
  reject(why: unknown): void;
}

/** What is used of a worker. */
export interface Beside {
  onmessage: ((event: { readonly data: Said }) => void) | null;
  onerror: ((event: { readonly message: string }) => void) | null;
  postMessage(message: { readonly number: number; readonly asking: Asking }): void;
  terminate(): void;
}

/** In a worker, one request after another. Stopping one ends the worker; those that wait go to the next. */
export function beside(spawn: () => Beside): Engine {
  let thread: Beside | undefined;
  let count = 0;
  const jobs: Job[] = [];
  const stop = (): void => {
    thread?.terminate();
    thread = undefined;
  };
  const next = (): void => {
    const job = jobs[0];
    if (!job) return;
    thread ??= start();
    thread.postMessage({ number: job.number, asking: job.asking });
  };
  const start = (): Beside => {
    const made = spawn();
    made.onmessage = ({ data }) => {
      const job = jobs[0];
      if (job?.number !== data.number) return;
      if ('first' in data) {
        job.first(data.first);
        return;
      }
      jobs.shift();
      if ('answer' in data) job.resolve(data.answer);
      else if (typeof data.refused !== 'string') job.reject(new BurgeonError(data.refused));
      else {
        job.reject(new Error(data.refused));
        // A fault of ours leaves the core unusable.
        stop();
      }
      next();
    };
    made.onerror = ({ message }) => {
      stop();
      jobs
        .shift()
        ?.reject(new Error(`the worker of burgeon could not go on: ${message ?? 'it did not load'}`));
      next();
    };
    return made;
  };
  return {
    ask(asking, signal, first = () => {}) {
      return new Promise((resolve, reject) => {
        if (signal?.aborted) {
          reject(signal.reason);
          return;
        }
        const number = ++count;
        const stopped = (): void => {
          const at = jobs.findIndex((job) => job.number === number);
          if (at < 0) return;
          jobs.splice(at, 1);
          reject(signal?.reason);
          if (at > 0) return;
          stop();
          next();
        };
        const done = <T>(then: (value: T) => void) => {
          return (value: T): void => {
            signal?.removeEventListener('abort', stopped);
            then(value);
          };
        };
        signal?.addEventListener('abort', stopped, { once: true });
        jobs.push({ number, asking, first, resolve: done(resolve), reject: done(reject) });
        if (jobs.length === 1) next();
      });
    },
    close() {
      stop();
      for (const job of jobs.splice(0)) job.reject(new Error('burgeon was closed'));
    },
  };
}

/** A worker of a page; one of another host is started by way of this one's. */
export function pageWorker(own: () => Worker, address: string): Beside {
  try {
    return own() as unknown as Beside;
  } catch (e) {
    if (new URL(address).origin === globalThis.location?.origin) throw e;
    const source = new Blob([`import ${JSON.stringify(address)};`], { type: 'text/javascript' });
    const url = URL.createObjectURL(source);
    return new Worker(url, { type: 'module' }) as unknown as Beside;
  }
}
