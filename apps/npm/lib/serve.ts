/** The other end of a worker. */
import { BurgeonError, sent } from './errors.js';
import type { Asking, Said } from './protocol.js';
import { buffers, type Core, work } from './work.js';

/** What a worker has of its global scope. */
export interface Scope {
  onmessage: ((event: { data: { number: number; asking: Asking } }) => void) | null;
  postMessage(said: Said, transfer?: ArrayBuffer[]): void;
}

/** Answers requests, one after another; `scope`: that of a page's worker, or the port of a thread of Node. */
export function serve(core: Promise<Core>, scope = globalThis as unknown as Scope): void {
  scope.onmessage = async ({ data: { number, asking } }) => {
    try {
      const answer = work(await core, asking, (first) =>
        scope.postMessage({ number, first }, buffers(first)),
      );
      scope.postMessage({ number, answer }, buffers(answer));
    } catch (e) {
      scope.postMessage({ number, refused: e instanceof BurgeonError ? sent(e) : String(e) });
    }
  };
}
