/**
 * The documents that this browser keeps. Of each there is the project file as it was last written whole, and what was
 * asked of it since then: a request is one row, written when it is made, so that a crash loses nothing that was done.
 *
 * Who works on a document owns it. Every write looks for its owner in the same transaction: a tab that lost a document
 * to another cannot write into it, whatever it still has on its way.
 */
import type { Request } from './protocol';

const NAME = 'burgeon';
/** 1: one project under the key `last`. */
const VERSION = 2;
const STORES = ['documents', 'wholes', 'journal'] as const;
/** Deleted documents are kept so long. */
const GRACE_MS = 30 * 24 * 3600 * 1000;

/** A document as the list shows it. */
export interface Entry {
  id: string;
  name: string;
  /** When it was changed last. */
  time: number;
  /** A small picture as a data URL; empty if there is none. */
  picture: string;
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
  result.createObjectStore('wholes');
  result.createObjectStore('journal');
  if (from !== 1 || !transaction) return;
  const last = transaction.objectStore('projects').get('last');
  last.onsuccess = () => {
    const old = last.result as { bytes: Uint8Array; name: string; time: number } | undefined;
    if (old) {
      const entry: Entry = { id: 'last', name: old.name, time: old.time, picture: '', deleted: 0, owner: '' };
      transaction.objectStore('documents').put(entry);
      transaction.objectStore('wholes').put(old.bytes, entry.id);
    }
    result.deleteObjectStore('projects');
  };
}

type Stores = { [name in (typeof STORES)[number]]: IDBObjectStore };
type Refuse = (why: Error) => void;

/** All or nothing of what `act` asks for; the answer is read when it is done. */
async function transact<T>(
  mode: IDBTransactionMode,
  act: (stores: Stores, refuse: Refuse) => () => T,
): Promise<T> {
  const db = await opened();
  return new Promise<T>((resolve, reject) => {
    // Strict: on the disk, and not only on its way there, when it is said to be.
    const transaction = db.transaction(STORES, mode, { durability: 'strict' });
    const stores = Object.fromEntries(STORES.map((s) => [s, transaction.objectStore(s)])) as Stores;
    let why: Error | undefined;
    let answer: (() => T) | undefined;
    const refuse = (e: Error): void => {
      why = e;
      transaction.abort();
    };
    transaction.oncomplete = () => resolve(answer!());
    transaction.onabort = () => reject(why ?? transaction.error ?? new Error('aborted'));
    try {
      answer = act(stores, refuse);
    } catch (e) {
      refuse(e as Error);
    }
  });
}

const nothing = (): void => undefined;
/** The rows of a document in the journal, up to one of them. */
const rowsOf = (id: string, to = Infinity): IDBKeyRange => IDBKeyRange.bound([id, 0], [id, to]);
const seqOf = (key: IDBValidKey | undefined): number => (key as [string, number] | undefined)?.[1] ?? 0;

/** A change of a document that is still its writer's. `fresh`: what is there before the first change. */
function owned(
  { id, owner }: Mine,
  change: (entry: Entry, stores: Stores) => void,
  fresh?: Entry,
): Promise<void> {
  return transact('readwrite', (stores, refuse) => {
    const get = stores.documents.get(id);
    get.onsuccess = () => {
      const entry = (get.result as Entry | undefined) ?? fresh;
      if (entry?.owner !== owner) {
        refuse(new TakenError('taken'));
        return;
      }
      change(entry, stores);
      stores.documents.put(entry);
    };
    return nothing;
  });
}

/** Every document, the latest first; those that were deleted long ago go now. */
export async function documents(): Promise<Entry[]> {
  const all = await transact('readonly', ({ documents: d }) => {
    const get = d.getAll();
    return () => get.result as Entry[];
  });
  const gone = all.filter((e) => e.deleted > 0 && Date.now() - e.deleted > GRACE_MS);
  if (gone.length > 0)
    await transact('readwrite', (s) => {
      for (const { id } of gone) {
        s.documents.delete(id);
        s.wholes.delete(id);
        s.journal.delete(rowsOf(id));
      }
      return nothing;
    });
  return all.filter((e) => !gone.includes(e)).sort((a, b) => b.time - a.time);
}

/** A document for reading, or for writing too, by this owner from now on. Undefined if it is not there. */
export function take(id: string, owner?: string): Promise<Kept | undefined> {
  return transact(owner === undefined ? 'readonly' : 'readwrite', ({ documents: d, wholes, journal }) => {
    const [entry, whole] = [d.get(id), wholes.get(id)];
    const [keys, requests] = [journal.getAllKeys(rowsOf(id)), journal.getAll(rowsOf(id))];
    if (owner !== undefined)
      entry.onsuccess = () => {
        if (entry.result) d.put({ ...entry.result, owner });
      };
    const row = (key: IDBValidKey, i: number): Row => ({ seq: seqOf(key), request: requests.result[i] });
    return () => entry.result && { entry: entry.result, whole: whole.result, rows: keys.result.map(row) };
  });
}

/** Writes what was asked. */
export function append(fresh: Entry, rows: readonly Row[]): Promise<void> {
  const change = (entry: Entry, { journal }: Stores): void => {
    entry.time = Date.now();
    for (const { seq, request } of rows) journal.put(request, [entry.id, seq]);
  };
  return owned(fresh, change, fresh);
}

/** Forgets a request that was refused. */
export function strike(mine: Mine, seq: number): Promise<void> {
  return owned(mine, ({ id }, { journal }) => journal.delete([id, seq]));
}

/** Writes the document whole; what was asked before, up to `seq`, is in it. */
export function writeWhole(fresh: Entry, whole: Uint8Array, seq: number): Promise<void> {
  const change = (entry: Entry, { wholes, journal }: Stores): void => {
    entry.time = Date.now();
    wholes.put(whole, entry.id);
    journal.delete(rowsOf(entry.id, seq));
  };
  return owned(fresh, change, fresh);
}

/** What the list shows of a document that its owner works on. */
export function portray(mine: Mine, seen: Pick<Entry, 'name' | 'picture'>): Promise<void> {
  return owned(mine, (entry) => Object.assign(entry, seen));
}

const naming = (name: string): Request => ({ kind: 'command', command: { scene: { rename: name } } });

/** Names a document that nobody works on: as if it had been asked last. */
export function rename(id: string, name: string): Promise<void> {
  return transact('readwrite', ({ documents: d, journal }) => {
    const [entry, last] = [d.get(id), journal.openKeyCursor(rowsOf(id), 'prev')];
    last.onsuccess = () => {
      if (!entry.result) return;
      d.put({ ...entry.result, name });
      journal.put(naming(name), [id, seqOf(last.result?.key) + 1]);
    };
    return nothing;
  });
}

/** A copy under another number and name. */
export function copy(id: string, to: string, name: string): Promise<void> {
  return transact('readwrite', ({ documents: d, wholes, journal }) => {
    const [entry, whole, rows] = [d.get(id), wholes.get(id), journal.openCursor(rowsOf(id))];
    let last = 0;
    rows.onsuccess = () => {
      const row = rows.result;
      if (row) {
        last = seqOf(row.key);
        journal.put(row.value, [to, last]);
        row.continue();
      } else if (entry.result) {
        d.put({ ...entry.result, id: to, name, time: Date.now(), owner: '', deleted: 0 });
        if (whole.result) wholes.put(whole.result, to);
        journal.put(naming(name), [to, last + 1]);
      }
    };
    return nothing;
  });
}

/** Deletes a document, or brings it back. It goes for good when its time is over. */
export function setDeleted(id: string, on: boolean): Promise<void> {
  return transact('readwrite', ({ documents: d }) => {
    const entry = d.get(id);
    entry.onsuccess = () => {
      if (entry.result) d.put({ ...entry.result, deleted: on ? Date.now() : 0 });
    };
    return nothing;
  });
}
