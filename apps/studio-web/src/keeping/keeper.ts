/**
 * Writes down what is asked of the document of this tab, as it is asked, and says what is true of it.
 *
 * A gesture is written when it ends, all else at once. Now and then the document is written whole, so that the journal
 * stays short; and where the journal has a hole, because the storage took something not, or because a step was undone
 * that it does not hold.
 */
import {
  append,
  create,
  type Entry,
  type Mine,
  type Row,
  TakenError,
  underPen,
  writeWhole,
  type Written,
} from './library';
import type { Request } from '../worker/protocol';

/** What is true of the document now. */
export type Standing =
  /** Nothing was done that could be lost. */
  | 'empty'
  | 'saving'
  | 'saved'
  /** Another tab works on it. */
  | 'readonly'
  /** Another document is coming. */
  | 'opening'
  /** Why it is not saved. */
  | { failed: Error };

export interface KeeperEvents {
  standing(now: Standing): void;
  /** The first change of a new document: it has a number now. */
  created(id: string): void;
  /** Another tab has the document. */
  taken(): void;
  /** The document as a project file. */
  save(): Promise<Uint8Array>;
  name(): string;
}

/** More than this in the journal, and the document is written whole. */
const MANY = 500;
const LARGE = 16 << 20;
/** So many may be done again when a document is opened. */
const MANY_AT_ONCE = 200;
const RETRY_MS = 5000;
/** So long the stroke under the pen may be ahead of what is written of it. */
const UNDER_PEN_MS = 50;

const ENDS: ReadonlySet<Request['kind']> = new Set(['commit', 'abandon', 'undo', 'redo', 'open']);

export class Keeper {
  /** The document, if there is anything of it. */
  mine: Mine | undefined;
  /** When something was asked of it last; 0 if nothing was since it is here. */
  changed = 0;
  private mode: 'readonly' | 'opening' | undefined = 'opening';
  private seq = 0;
  private readonly seqs = new WeakMap<Request, number>();
  /** What an open gesture has asked so far. */
  private held: Request[] = [];
  private gesture = false;
  /** The document has an entry in the list. */
  private entered = false;
  /** The stroke under the pen, where it is ahead of what is written of it. */
  private drawn: (() => Request[]) | undefined;
  private penRests = false;
  private penWritten = false;
  private batch: Written[] = [];
  private readonly writes = new Set<Promise<void>>();
  /** In the journal. */
  private count = 0;
  private size = 0;
  /** The steps before the document was written whole are in the memory of the worker, but not in the journal. */
  private cut = false;
  /** It is to be written whole; `hole`: because the journal alone is not the document. */
  private wanted = false;
  private hole = false;
  private failed: Error | undefined;
  private whole = false;
  private timer = 0;

  constructor(
    readonly owner: string,
    private readonly events: KeeperEvents,
  ) {}

  get standing(): Standing {
    if (this.mode) return this.mode;
    if (this.failed) return { failed: this.failed };
    if (this.writes.size > 0 || this.batch.length > 0 || this.hole) return 'saving';
    return this.entered ? 'saved' : 'empty';
  }

  /** From now on this document, with what the journal holds of it; undefined: a new one. */
  open(id: string | undefined, rows: readonly Row[], mode?: 'readonly'): void {
    this.mine = id === undefined ? undefined : { id, owner: this.owner };
    this.mode = mode;
    this.entered = id !== undefined;
    [this.drawn, this.penWritten] = [undefined, false];
    this.changed = 0;
    this.seq = rows.at(-1)?.seq ?? 0;
    this.count = rows.length;
    this.size = rows.reduce((sum, row) => sum + sizeOf(row.request), 0);
    [this.held, this.gesture, this.cut, this.hole, this.failed] = [[], false, false, false, undefined];
    this.wanted = !mode && this.count > MANY_AT_ONCE;
    this.tell();
    this.pump();
  }

  /** Takes nothing more; what was taken is written when the promise is kept. */
  async close(mode: 'readonly' | 'opening'): Promise<void> {
    this.mode = mode;
    this.tell();
    await this.settled();
  }

  /** The storage cannot be used at all. */
  broken(why: Error): void {
    this.mode = undefined;
    this.failed = why;
    this.hole = true;
    this.tell();
  }

  async settled(): Promise<void> {
    this.flush();
    while (this.writes.size > 0) await Promise.allSettled(this.writes);
  }

  // What is asked ------------------------------------------------------------------------------------------------

  record(request: Request): void {
    const { kind } = request;
    if (kind === 'begin') {
      this.gesture = true;
      this.held.push(request);
      return;
    }
    if (kind === 'stage') {
      // Only the last of a drag counts.
      if (this.held.at(-1)?.kind === 'stage') this.held.pop();
      this.held.push(request);
      return;
    }
    if (ENDS.has(kind)) this.gesture = false;
    const done = this.held;
    this.held = [];
    if (kind === 'abandon' && done[0]?.kind === 'begin') return;
    // A document does not begin with looking at it.
    if (!this.entered && kind === 'select') return;
    // The row that comes now says that the stroke under the pen is over.
    [this.drawn, this.penWritten] = [undefined, false];
    const mine = this.begun();
    if (!this.entered) {
      this.entered = true;
      this.track(create(this.entry(mine)));
    }
    this.changed = Date.now();
    if (this.failed || (this.cut && (kind === 'undo' || kind === 'redo'))) this.wanted = this.hole = true;
    else
      for (const each of [...done, request]) {
        this.enqueue(each, sizeOf(each));
        this.seqs.set(each, this.seq);
      }
    if (this.count > MANY || this.size > LARGE) this.wanted = true;
    this.tell();
    // What failed is tried again now and then, not with every stroke.
    if (this.failed) this.later();
    // Whoever asks goes to the worker right after this: a document that was saved before would lack what made it necessary.
    else queueMicrotask(() => this.pump());
  }

  /**
   * The stroke under the pen, as it would be asked for if it ended now. Where the page ends before the stroke does, or
   * before its end is written, it is taken as one that ended here.
   */
  drawing(requests: () => Request[]): void {
    if (this.mode || this.failed) return;
    this.drawn = requests;
    if (!this.penRests) this.writeDrawn();
  }

  /** It was none. */
  undrawn(): void {
    this.drawn = undefined;
    if (this.penWritten && this.mine) void underPen(this.mine, this.seq, []).catch(() => undefined);
    this.penWritten = false;
  }

  private writeDrawn(): void {
    const { drawn } = this;
    this.penRests = drawn !== undefined;
    if (!drawn) return;
    this.drawn = undefined;
    this.penWritten = true;
    // If it cannot be written, neither can the stroke when it ends, and that is told.
    void underPen(this.begun(), this.seq, drawn()).catch(() => undefined);
    window.setTimeout(() => this.writeDrawn(), UNDER_PEN_MS);
  }

  /** The document, which begins now if there was none. */
  private begun(): Mine {
    if (!this.mine) {
      this.mine = { id: newId(), owner: this.owner };
      this.events.created(this.mine.id);
    }
    return this.mine;
  }

  /** It was refused, and need not be asked again when the document is opened. */
  forget(request: Request): void {
    this.held = this.held.filter((r) => r !== request);
    const seq = this.seqs.get(request);
    if (seq === undefined || !this.mine || this.mode || this.failed) return;
    const waiting = this.batch.length;
    this.batch = this.batch.filter((row) => row.seq !== seq);
    if (this.batch.length === waiting) this.enqueue({ kind: 'struck', seq }, 0);
  }

  /** It bears something now that it did not when it was asked. */
  again(request: Request): void {
    const seq = this.seqs.get(request);
    if (seq === undefined || !this.mine || this.mode || this.failed) return;
    if (!this.batch.some((row) => row.seq === seq))
      this.enqueue({ kind: 'mended', seq, request }, sizeOf(request));
  }

  private enqueue(request: Written['request'], size: number): void {
    this.seq += 1;
    this.count += 1;
    this.size += size;
    // What is asked in one go, such as a stroke and its mirror image, is written in one go.
    if (this.batch.length === 0) queueMicrotask(() => this.flush());
    this.batch.push({ seq: this.seq, request });
  }

  private flush(): void {
    const rows = this.batch;
    this.batch = [];
    if (rows.length > 0 && this.mine) this.track(append(this.mine, rows));
  }

  private entry({ id, owner }: Mine): Entry {
    return { id, owner, name: this.events.name(), time: Date.now(), deleted: 0 };
  }

  private track(write: Promise<void>): void {
    const { mine } = this;
    const done = write
      .catch((e: Error) => {
        if (mine === this.mine) this.fail(e);
      })
      .finally(() => {
        this.writes.delete(done);
        this.tell();
      });
    this.writes.add(done);
    this.tell();
  }

  private fail(e: Error): void {
    if (e instanceof TakenError) {
      this.events.taken();
      return;
    }
    this.failed = e;
    this.wanted = this.hole = true;
    this.later();
  }

  private later(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.pump(), RETRY_MS);
  }

  // The whole ----------------------------------------------------------------------------------------------------

  private pump(): void {
    if (this.wanted && !this.gesture && !this.whole && !this.mode) void this.writeWhole();
  }

  private async writeWhole(): Promise<void> {
    const { mine, seq } = this;
    if (!mine) return;
    [this.whole, this.wanted, this.cut] = [true, false, true];
    [this.count, this.size] = [0, 0];
    try {
      const bytes = await this.events.save().catch(() => undefined);
      if (mine !== this.mine || this.mode) return;
      if (!bytes) {
        // The worker fell and comes again: the journal is as it was.
        this.wanted = true;
        this.later();
        return;
      }
      await writeWhole(this.entry(mine), bytes, seq);
      if (mine !== this.mine) return;
      // Something came meanwhile that is not in it: once more.
      if (!this.wanted) [this.hole, this.failed] = [false, undefined];
    } catch (e) {
      if (mine === this.mine) this.fail(e as Error);
    } finally {
      this.whole = false;
      this.tell();
      if (!this.failed) this.pump();
    }
  }

  private tell(): void {
    this.events.standing(this.standing);
  }
}

/** Not `randomUUID`: pages of a plain http address do not have it. */
export function newId(): string {
  return [...crypto.getRandomValues(new Uint32Array(4))].map((n) => n.toString(36)).join('');
}

function sizeOf(request: Request): number {
  const columns = [request].flatMap((r) => Object.values(r).filter((v) => ArrayBuffer.isView(v)));
  return columns.reduce((sum, column) => sum + column.byteLength, 200);
}
