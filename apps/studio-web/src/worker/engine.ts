/**
 * The page's side of the worker. The document lives in the worker, but everything that was asked of it is kept here
 * too: when the worker dies, another one does the same again, and no stroke is lost.
 */
import wasmUrl from '../wasm/burgeon_wasm_bg.wasm?url';
import type { FromWorker, Request, Sent, StrokePoints, ToWorker } from './protocol';
import { tell } from '../text';
import type { DocumentState, Opened, Refusal, SceneView } from '../wire';

export interface EngineEvents {
  ready(): void;
  state(state: DocumentState, fresh: StrokePoints[], photo: Uint8Array<ArrayBuffer> | null): void;
  view(view: SceneView, fresh: Sent[]): void;
  /** Large trees that are still being made, much coarser. */
  coarse(fresh: Sent[]): void;
  busy(): void;
  /** The share that is done of what is grown, 0 to 1. */
  progress(share: number): void;
  /** No plant could be made; the last one stays. */
  failed(why: Refusal): void;
  /** The worker died and was replaced; with `hold` it does not grow this drawing again by itself. */
  fault(hold: boolean): void;
  /** The worker cannot be started at all. */
  dead(why: string): void;
  /** Why nothing may be changed now; undefined if it may. */
  refusal(): string | undefined;
  /** A change is asked for. */
  asked(request: Request): void;
  /** It was refused, or changed nothing. */
  vain(request: Request): void;
  /** It bears now where its plant was put. */
  told(request: Request): void;
  /** The worker did it, and answered so: in the order of its work. */
  did(request: Request, value: unknown): void;
}

const CHANGES: ReadonlySet<Request['kind']> = new Set([
  'open',
  'select',
  'obstacle',
  'stroke',
  'paste',
  'photo',
  'wear',
  'command',
  'action',
  'begin',
  'stage',
  'commit',
  'abandon',
  'undo',
  'redo',
]);

export class Engine {
  private worker: Worker | undefined;
  private seq = 0;
  private waiting = new Map<
    number,
    { resolve: (v: unknown) => void; reject: (e: Error) => void; request: Request }
  >();
  private journal: Request[] = [];
  private faults = 0;
  /** Workers in a row that fell before they were ready. */
  private stillborn = 0;
  private wasReady = false;
  /** Shared with the worker where the page is isolated: lets an evaluation end early. */
  private readonly stop = globalThis.crossOriginIsolated ? new Int32Array(new SharedArrayBuffer(4)) : null;
  /** An evaluation is under way or about to be. */
  growing = false;
  private interrupted = false;

  constructor(private readonly events: EngineEvents) {}

  start(hold = false): void {
    this.worker?.terminate();
    const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if (worker === this.worker) this.hear(data);
    };
    worker.onerror = (e) => {
      e.preventDefault();
      if (worker === this.worker) this.fell(e.message);
    };
    this.worker = worker;
    const url = new URL(wasmUrl, location.href).href;
    this.send({ kind: 'start', wasm: url, stop: this.stop, journal: this.journal, hold });
  }

  /** Asks; the promise is kept when the worker has done it and broken, with words for people, when it refused. */
  ask<T = unknown>(request: Request): Promise<T> {
    const seq = ++this.seq;
    const changes = CHANGES.has(request.kind);
    if (changes) {
      const why = this.events.refusal();
      // Looking at another plant changes nothing.
      if (why !== undefined && request.kind !== 'select') return Promise.reject(new Error(why));
      if (request.kind === 'stage') this.forget('stage'); // only the last of a drag counts
      this.journal.push(request);
      if (why === undefined) this.events.asked(request);
    }
    // What was before is forgotten here too.
    if (request.kind === 'load') this.journal = [...request.journal];
    // What is being grown is out of date already; a gesture's beginning changes nothing yet.
    if (this.stop && (changes || request.kind === 'load') && request.kind !== 'begin')
      Atomics.store(this.stop, 0, 1);
    return new Promise((resolve, reject) => {
      this.waiting.set(seq, { resolve: resolve as (v: unknown) => void, reject, request });
      this.send({ kind: 'ask', seq, request });
    });
  }

  /** Ends an evaluation that takes too long; the plant stays as it was until the next change. */
  interrupt(): void {
    this.interrupted = true;
    if (this.stop) Atomics.store(this.stop, 0, 1);
    else this.start(true);
  }

  /** What the worker computes for an answer ends early, and is refused. */
  giveWay(): void {
    if (this.stop) Atomics.store(this.stop, 0, 1);
    else this.start(true);
  }

  private forget(kind: Request['kind']): void {
    if (this.journal.at(-1)?.kind === kind) this.journal.pop();
  }

  private send(message: ToWorker): void {
    this.worker?.postMessage(message);
  }

  private hear(message: FromWorker): void {
    switch (message.kind) {
      case 'ready':
        this.wasReady = true;
        this.stillborn = 0;
        this.events.ready();
        break;
      case 'done': {
        const waiting = this.waiting.get(message.seq);
        if (waiting) {
          this.done(waiting.request, message.placed, message.value);
          this.events.did(waiting.request, message.value);
        }
        waiting?.resolve(message.value);
        this.waiting.delete(message.seq);
        break;
      }
      case 'refused': {
        const waiting = this.waiting.get(message.seq);
        if (waiting?.request.kind === 'load') this.journal = [];
        // What was refused once would only be refused again.
        if (waiting) this.drop(waiting.request);
        waiting?.reject(new Error(tell(message.why)));
        this.waiting.delete(message.seq);
        break;
      }
      case 'state':
        this.events.state(message.state, message.fresh, message.photo);
        break;
      case 'view':
        this.growing = false;
        this.faults = 0;
        this.events.view(message.view, message.fresh);
        break;
      case 'coarse':
        this.events.coarse(message.fresh);
        break;
      case 'busy':
        this.growing = true;
        this.events.busy();
        break;
      case 'progress':
        this.events.progress(message.share);
        break;
      case 'failed': {
        // What gave way to a newer change is no news.
        const told = message.why.code !== 'cancelled' || this.interrupted;
        this.interrupted = false;
        this.growing = false;
        if (told) this.events.failed(message.why);
        break;
      }
      case 'fault':
        this.fell(message.why);
        break;
    }
  }

  private done(request: Request, placed: number | undefined, value: unknown): void {
    if (request.kind === 'open' && (value as Opened).kind === 'model')
      this.drop(request); // only looked at
    else if (placed !== undefined && (request.kind === 'open' || request.kind === 'action')) {
      request.placed = placed;
      this.events.told(request);
    }
  }

  private drop(request: Request): void {
    if (!this.journal.includes(request)) return;
    this.journal = this.journal.filter((r) => r !== request);
    this.events.vain(request);
  }

  private fell(why: string): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.growing = false;
    for (const { reject } of this.waiting.values()) reject(new Error('restarted'));
    this.waiting.clear();
    if (!this.wasReady) {
      this.events.dead(why);
      return;
    }
    this.faults += 1;
    this.stillborn += 1;
    // The second fault in a row: growing this drawing is what fails. Each change tries again: undo always works.
    const hold = this.faults > 1;
    if (this.stillborn > 4) {
      this.events.dead(why);
      return;
    }
    this.events.fault(hold);
    this.start(hold);
  }
}
