/**
 * The documents that this browser keeps. Of each there is the project file as it was last written whole, and what was
 * asked of it since then: a request is one row of a journal, written when it is made.
 *
 * The journal is only ever appended to, and nothing holds it while it waits for a page or for the disk: what is asked of
 * it is asked in one go, whether it is written or read. Everything else about a document (its entry in the list, its
 * picture, the whole file) has transactions of its own. The picture behind the plants is among the pictures.
 *
 * The tab that works on a document owns it, and writes the rows of its journal one after the other. The tab that takes
 * it over writes the next one: what the old owner still has on its way finds its row taken, and none of it is written.
 */
import { dropPen, keepPen, keptPen, laterPen, type UnderPen } from './lastpen';
import type { Request } from '../worker/protocol';

const NAME = 'burgeon';
/** 1: one project under the key `last`. */
const VERSION = 2;
/** Deleted documents are kept so long. */
const GRACE_MS = 30 * 24 * 3600 * 1000;

/** A document as the list shows it. */
export interface Entry {
  id: string;
  name: string;
  /** When it was changed last. */
  time: number;
  /** When it was deleted; 0 if it was not. */
  deleted: number;
  /** Who may write. */
  owner: string;
}

/** A document with all that makes it. */
export interface Kept {
  entry: Entry;
  /** Nothing before it was written whole for the first time. */
  whole: Uint8Array | undefined;
  rows: Row[];
}

/** A request in the place where it was asked. */
export interface Row {
  seq: number;
  request: Request;
}

/** A row of the journal that says something of an earlier one. */
export type Correction =
  /** It was refused: it is not asked again. */
  | { kind: 'struck'; seq: number }
  /** It bears more than when it was written. */
  | { kind: 'mended'; seq: number; request: Request };

/** What a row of the journal holds. */
export interface Written {
  seq: number;
  request: Request | Correction;
}

const LOCK = 'burgeon.';
/** The name of the lock of a document. */
export const lockOf = (id: string): string => LOCK + id;

/** The documents that some tab has open for writing. */
export async function held(): Promise<Set<string>> {
  const locks = (await navigator.locks?.query())?.held ?? [];
  return new Set(locks.map((lock) => lock.name?.replace(LOCK, '') ?? ''));
}

/** Which document, and who says that it is his. */
export type Mine = Pick<Entry, 'id' | 'owner'>;

/** Another tab took the document over. */
export class TakenError extends Error {}

let base: Promise<IDBDatabase> | undefined;

function opened(): Promise<IDBDatabase> {
  base ??= new Promise<IDBDatabase>((resolve, reject) => {
    const request = indexedDB.open(NAME, VERSION);
    request.onupgradeneeded = (e) => upgrade(request, e.oldVersion);
    request.onsuccess = () => {
      const { result } = request;
      const gone = (): void => {
        base = undefined;
      };
      result.onclose = gone;
      // A newer page in another tab changes the stores.
      result.onversionchange = () => {
        result.close();
        gone();
      };
      resolve(result);
    };
    request.onerror = () => reject(request.error ?? new Error('closed'));
    request.onblocked = () => reject(new Error('blocked'));
  }).catch((e: Error) => {
    base = undefined;
    throw e;
  });
  return base;
}

function upgrade(request: IDBOpenDBRequest, from: number): void {
  const { result, transaction } = request;
  result.createObjectStore('documents', { keyPath: 'id' });
  for (const store of ['pictures', 'wholes', 'journal']) result.createObjectStore(store);
  if (from !== 1 || !transaction) return;
  const last = transaction.objectStore('projects').get('last');
  last.onsuccess = () => {
    const old = last.result as { bytes: Uint8Array; name: string; time: number } | undefined;
    if (old) {
      const entry: Entry = { id: 'last', name: old.name, time: old.time, deleted: 0, owner: '' };
      transaction.objectStore('documents').put(entry);
      transaction.objectStore('wholes').put(old.bytes, entry.id);
    }
    result.deleteObjectStore('projects');
  };
}

type Store = 'documents' | 'pictures' | 'wholes' | 'journal';
type Stores<S extends Store> = { [name in S]: IDBObjectStore };
type Refuse = (why: Error) => void;

interface Manner {
  /** `strict`: it is on the disk, and so is all that was written before it; else it is with the system. */
  durability?: 'strict' | 'relaxed';
  /** More is asked for when an answer is there. Else all is asked for at once, and this page need not live to see it. */
  rounds?: true;
}

const storesOf = <S extends Store>(names: readonly S[], transaction: IDBTransaction): Stores<S> =>
  Object.fromEntries(names.map((s) => [s, transaction.objectStore(s)])) as Stores<S>;

/** All or nothing of what `act` asks of these stores. */
async function transact<S extends Store>(
  names: readonly S[],
  act: (stores: Stores<S>, refuse: Refuse) => void,
  { durability = 'relaxed', rounds }: Manner = {},
): Promise<void> {
  const db = await opened();
  return new Promise((resolve, reject) => {
    const transaction = db.transaction(names, 'readwrite', { durability });
    let why: Error | undefined;
    const refuse = (e: Error): void => {
      why = e;
      transaction.abort();
    };
    transaction.oncomplete = () => resolve();
    transaction.onabort = () => reject(why ?? transaction.error ?? new Error('aborted'));
    try {
      act(storesOf(names, transaction), refuse);
      if (!rounds) transaction.commit();
    } catch (e) {
      refuse(e as Error);
    }
  });
}

/** What is asked for of these stores, all at one moment. No other page waits until this one has heard the answer. */
async function look<S extends Store, T extends unknown[]>(
  names: readonly S[],
  ask: (stores: Stores<S>) => [...{ [place in keyof T]: IDBRequest<T[place]> }],
): Promise<T> {
  const transaction = (await opened()).transaction(names, 'readonly');
  const requests = ask(storesOf(names, transaction));
  // A large answer comes after the transaction is said to be complete: each request is waited for by itself.
  const answers = requests.map(
    (request) =>
      new Promise((resolve, reject) => {
        request.onsuccess = () => resolve(request.result);
        request.onerror = () => reject(request.error ?? new Error('aborted'));
      }),
  );
  transaction.commit();
  return (await Promise.all(answers)) as T;
}

const nothing = (): void => undefined;
const ROUNDS: Manner = { rounds: true };
/** The rows of a document in the journal, up to one of them. */
const rowsOf = (id: string, to = Infinity): IDBKeyRange => IDBKeyRange.bound([id, 0], [id, to]);
const PEN = 'pen';
/** Where the stroke under the pen stands: behind all numbers. */
const penOf = (id: string): [string, string] => [id, PEN];

// Entries of the list ----------------------------------------------------------------------------------------------

/** A change of a document that is still its owner's. `fresh`: what is there before the first change. */
function owned<S extends Store>(
  { id, owner }: Mine,
  others: readonly S[],
  change: (entry: Entry, stores: Stores<S>) => void,
  { fresh, durability = 'relaxed' }: { fresh?: Entry } & Pick<Manner, 'durability'> = {},
): Promise<void> {
  return transact(
    ['documents', ...others],
    (stores, refuse) => {
      const get = stores.documents.get(id);
      get.onsuccess = () => {
        const entry = (get.result as Entry | undefined) ?? fresh;
        if (entry?.owner !== owner) {
          refuse(new TakenError('taken'));
          return;
        }
        try {
          change(entry, stores);
          stores.documents.put(entry);
        } catch (e) {
          refuse(e as Error);
        }
      };
    },
    { ...ROUNDS, durability },
  );
}

/** A change of an entry, no matter which tab works on its document; the entry as it is then, if it is there. */
async function changed(id: string, change: Partial<Entry>): Promise<Entry | undefined> {
  let entry: Entry | undefined;
  const act = ({ documents: d }: Stores<'documents'>): void => {
    const get = d.get(id);
    get.onsuccess = () => {
      entry = get.result && { ...(get.result as Entry), ...change };
      if (entry) d.put(entry);
    };
  };
  await transact(['documents'], act, ROUNDS);
  return entry;
}

async function entryOf(id: string): Promise<Entry | undefined> {
  const [entry] = await look(['documents'], (stores) => [stores.documents.get(id)]);
  return entry as Entry | undefined;
}

/** Every document with its small picture (a data URL), the latest first; those that were deleted long ago go now. */
export async function documents(): Promise<(Entry & { picture: string })[]> {
  const [entries, keys, urls] = (await look(['documents', 'pictures'], ({ documents: d, pictures }) => [
    d.getAll(),
    pictures.getAllKeys(),
    pictures.getAll(),
  ])) as [Entry[], string[], string[]];
  const seen = new Map(keys.map((key, i) => [key, urls[i]]));
  const all = entries.map((e) => ({ ...e, picture: seen.get(e.id) ?? '' }));
  const lost = await withoutEntry(new Set(all.map((e) => e.id)), await held());
  all.push(...lost.map((e) => ({ ...e, picture: '' })));
  const gone = all.filter((e) => e.deleted > 0 && Date.now() - e.deleted > GRACE_MS);
  if (gone.length > 0)
    await transact(['documents', 'pictures', 'wholes', 'journal'], (stores) => {
      for (const { id } of gone) {
        for (const store of [stores.documents, stores.pictures, stores.wholes]) store.delete(id);
        stores.journal.delete(rowsOf(id));
        stores.journal.delete(penOf(id));
        dropPen(id);
      }
    });
  return all.filter((e) => !gone.includes(e)).sort((x, y) => y.time - x.time);
}

/**
 * Gives an entry to each document that has rows but none: its page died before the entry was written. Where there is
 * nothing but the stroke under the pen, and a tab has the document, it is being drawn.
 */
async function withoutEntry(known: ReadonlySet<string>, open: ReadonlySet<string>): Promise<Entry[]> {
  type Key = [string, number | typeof PEN];
  const [keys] = (await look(['journal'], ({ journal }) => [journal.getAllKeys()])) as [Key[]];
  const lost = keys.filter(([id, row]) => !known.has(id) && !(row === PEN && open.has(id)));
  const ids = new Set(lost.map(([id]) => id));
  const made = [...ids].map((id) => ({ id, name: '', time: Date.now(), deleted: 0, owner: '' }));
  // Where the page lives, it writes an entry of its own: this one is not put over it.
  const added = made.map((entry) =>
    create(entry, 'add')
      .then(() => entry)
      .catch(nothing),
  );
  return (await Promise.all(added)).filter((entry) => entry !== undefined);
}

/** The entry of a new document. */
export function create(entry: Entry, how: 'put' | 'add' = 'put'): Promise<void> {
  return transact(['documents'], ({ documents: d }) => {
    d[how](entry);
  });
}

/** What the list shows of a document that its owner works on: its name, when it was changed, and a small picture. */
export async function portray(
  mine: Mine,
  shown: Partial<Pick<Entry, 'name' | 'time'>>,
  picture?: string,
): Promise<void> {
  await owned(mine, [], (entry) => Object.assign(entry, shown));
  if (picture !== undefined)
    await transact(['pictures'], ({ pictures }) => {
      pictures.put(picture, mine.id);
    });
}

/** Deletes a document, or brings it back. It goes for good when its time is over. */
export async function setDeleted(id: string, on: boolean): Promise<void> {
  await changed(id, { deleted: on ? Date.now() : 0 });
}

/** Names a document that nobody works on: as if it had been asked last. */
export async function rename(id: string, name: string): Promise<void> {
  if (!(await changed(id, { name }))) return;
  const stored = await read(id);
  await write(id, numbered(stored.last, [...stored.unended, naming(name)]));
}

const naming = (name: string): Request => ({ kind: 'command', command: { scene: { rename: name } } });

/** A copy under another number and name. */
export async function copy(id: string, to: string, name: string): Promise<void> {
  const [stored, [picture], entry] = await Promise.all([
    read(id),
    look(['pictures'], ({ pictures }) => [pictures.get(id)]),
    entryOf(id),
  ]);
  if (!entry) return;
  await transact(['documents', 'pictures', 'wholes', 'journal'], (stores) => {
    stores.documents.put({ ...entry, id: to, name, time: Date.now(), owner: '', deleted: 0 });
    if (picture !== undefined) stores.pictures.put(picture, to);
    if (stored.whole) stores.wholes.put(stored.whole, to);
    const more = numbered(stored.last, [...stored.unended, naming(name)]);
    for (const { seq, request } of [...stored.written, ...more]) stores.journal.put(request, [to, seq]);
  });
}

/** The place of the picture behind the plants, which belongs to no document: their numbers have no such letters. */
const BACKDROP = '.backdrop';

/** The picture behind the plants, a data URL. */
export async function backdrop(): Promise<string | undefined> {
  const [url] = await look(['pictures'], ({ pictures }) => [pictures.get(BACKDROP)]);
  return url as string | undefined;
}

export function setBackdrop(url: string): Promise<void> {
  return transact(['pictures'], ({ pictures }) => {
    pictures.put(url, BACKDROP);
  });
}

// Contents ---------------------------------------------------------------------------------------------------------

/** The whole file, and the last row that is in it. */
interface Whole {
  bytes: Uint8Array;
  seq: number;
}

interface Stored {
  whole: Whole | undefined;
  /** What is not in the whole file. */
  written: Written[];
  /** A stroke that was under the pen when its page ended. */
  unended: readonly Request[];
  /** The number of the last row. */
  last: number;
}

/** The rows are read first: what is cut off meanwhile, since it was written whole, is in the whole file read then. */
async function read(id: string): Promise<Stored> {
  const [keys, requests, inBase] = (await look(['journal'], ({ journal }) => [
    journal.getAllKeys(rowsOf(id)),
    journal.getAll(rowsOf(id)),
    journal.get(penOf(id)),
  ])) as [[string, number][], Written['request'][], UnderPen | undefined];
  const rows = keys.map(([, seq], i) => ({ seq, request: requests[i]! }));
  const [found] = (await look(['wholes'], ({ wholes }) => [wholes.get(id)])) as [
    Whole | Uint8Array | undefined,
  ];
  // Once the bytes alone stood there, and no row that is in them stayed.
  const whole = found instanceof Uint8Array ? { bytes: found, seq: 0 } : found;
  const inWhole = whole?.seq ?? 0;
  const last = Math.max(inWhole, rows.at(-1)?.seq ?? 0);
  const written = rows.filter((row) => row.seq > inWhole);
  const pen = laterPen(inBase, keptPen(id));
  // What is asked after it began is its own end, or that of another owner: a correction is neither.
  const ended =
    !pen || inWhole > pen.after || written.some((row) => row.seq > pen.after && !isCorrection(row.request));
  return { whole, written, unended: ended ? [] : pen.requests, last };
}

function isCorrection(r: Written['request']): r is Correction {
  return r.kind === 'struck' || r.kind === 'mended';
}

const numbered = (last: number, requests: readonly Request[]): Row[] =>
  requests.map((request, i) => ({ seq: last + 1 + i, request }));

/** The requests of a journal as they were corrected later. */
export function corrected(written: readonly Written[]): Row[] {
  const rows = new Map<number, Row>();
  for (const { seq, request } of written) {
    if (request.kind === 'struck') rows.delete(request.seq);
    else if (request.kind !== 'mended') rows.set(seq, { seq, request });
    else if (rows.has(request.seq)) rows.set(request.seq, { seq: request.seq, request: request.request });
  }
  return [...rows.values()];
}

/** Rows that nobody has written yet. They are on their way when the base is open, and wait for no other document. */
function write(id: string, rows: readonly Written[]): Promise<void> {
  return transact(['journal'], ({ journal }) => {
    for (const { seq, request } of rows) journal.add(request, [id, seq]);
  }).catch((e: Error) => {
    throw e.name === 'ConstraintError' ? new TakenError('taken') : e;
  });
}

/**
 * A document for reading, or for writing too, by this owner from now on. Undefined if it is not there.
 *
 * An owner also gets the stroke that was under the pen, as one that ended. The last row of what an owner gets is its own: it says nothing but that the row is taken.
 */
export async function take(id: string, owner?: string): Promise<Kept | undefined> {
  const entry = await (owner === undefined ? entryOf(id) : changed(id, { owner }));
  if (!entry) return undefined;
  for (;;) {
    const { whole, written, unended, last } = await read(id);
    const kept = { entry, whole: whole?.bytes, rows: corrected(written) };
    if (owner === undefined) return kept;
    const taken = numbered(last, [...unended, { kind: 'abandon' }]);
    try {
      await write(id, taken);
      dropPen(id);
      return { ...kept, rows: [...kept.rows, ...taken] };
    } catch (e) {
      // The old owner wrote something meanwhile: that belongs to it, too.
      if (!(e instanceof TakenError)) throw e;
    }
  }
}

/**
 * Writes what was asked. Relaxed: with the system, not yet on the disk. Waiting for the disk would have the next rows
 * wait too, and a page that ends takes with it what waits. What is written strictly brings these rows to the disk as
 * well.
 */
export function append({ id }: Mine, rows: readonly Written[]): Promise<void> {
  const requests = rows.flatMap(({ request }) => (isCorrection(request) ? [] : [request]));
  // The page may end before they are written.
  if (requests.some((r) => r.kind === 'stroke')) keepPen(id, { after: rows[0]!.seq - 1, requests });
  return write(id, rows);
}

/** Writes the stroke under the pen, of which row `after` is before it, in the place of what it was; without requests: it is none. */
export function underPen({ id }: Mine, after: number, requests: readonly Request[]): Promise<void> {
  if (requests.length === 0) dropPen(id);
  else keepPen(id, { after, requests });
  return transact(['journal'], ({ journal }) => {
    if (requests.length === 0) journal.delete(penOf(id));
    else journal.put({ after, requests } satisfies UnderPen, penOf(id));
  });
}

/** Writes the document whole; what was asked before, up to `seq`, is in it. */
export async function writeWhole(fresh: Entry, bytes: Uint8Array, seq: number): Promise<void> {
  const change = (entry: Entry, { wholes }: Stores<'documents' | 'wholes'>): void => {
    entry.time = Date.now();
    wholes.put({ bytes, seq } satisfies Whole, entry.id);
  };
  await owned(fresh, ['wholes'], change, { fresh, durability: 'strict' });
  await transact(['journal'], ({ journal }) => {
    journal.delete(rowsOf(fresh.id, seq));
  });
}
