/**
 * The documents that this browser keeps. Of each there is the project file as it was last written whole, and what was
 * asked of it since then: a request is one row, written when it is made, so that a crash loses nothing that was saved.
 *
 * Who works on a document owns it, and writes the rows of its journal one after the other. Who takes it over writes the
 * next one: what the old owner still has on its way finds its row taken, and nothing of it is written.
 */
import type { Request } from './protocol';

const NAME = 'burgeon';
/** 1: one project under the key `last`. */
const VERSION = 2;
const STORES = ['documents', 'pictures', 'wholes', 'journal'] as const;
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

type Stores = { [name in (typeof STORES)[number]]: IDBObjectStore };
type Refuse = (why: Error) => void;

/**
 * All or nothing of what `act` asks for; the answer is read when it is done. `commit`: nothing more is asked for, and
 * the browser need not come back to this page to end it.
 */
async function transact<T>(
  mode: IDBTransactionMode,
  act: (stores: Stores, refuse: Refuse, commit: () => void) => () => T,
  durability: 'strict' | 'relaxed' = 'strict',
): Promise<T> {
  const db = await opened();
  return new Promise<T>((resolve, reject) => {
    const transaction = db.transaction(STORES, mode, { durability });
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
      answer = act(stores, refuse, () => transaction.commit());
    } catch (e) {
      refuse(e as Error);
    }
  });
}

const nothing = (): void => undefined;
/** The rows of a document in the journal, up to one of them. */
const rowsOf = (id: string, to = Infinity): IDBKeyRange => IDBKeyRange.bound([id, 0], [id, to]);
const seqOf = (key: IDBValidKey | undefined): number => (key as [string, number] | undefined)?.[1] ?? 0;

/** A change of a document that is still its owner's. `fresh`: what is there before the first change. */
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

/** Every document with its small picture (a data URL), the latest first; those that were deleted long ago go now. */
export async function documents(): Promise<(Entry & { picture: string })[]> {
  const all = await transact('readonly', ({ documents: d, pictures }) => {
    const [entries, keys, urls] = [d.getAll(), pictures.getAllKeys(), pictures.getAll()];
    return () => {
      const seen = new Map(keys.result.map((key, i) => [key, urls.result[i] as string]));
      return (entries.result as Entry[]).map((e) => ({ ...e, picture: seen.get(e.id) ?? '' }));
    };
  });
  const gone = all.filter((e) => e.deleted > 0 && Date.now() - e.deleted > GRACE_MS);
  if (gone.length > 0)
    await transact('readwrite', ({ documents: d, pictures, wholes, journal }) => {
      for (const { id } of gone) {
        for (const store of [d, pictures, wholes]) store.delete(id);
        journal.delete(rowsOf(id));
      }
      return nothing;
    });
  return all.filter((e) => !gone.includes(e)).sort((x, y) => y.time - x.time);
}

/**
 * A document for reading, or for writing too, by this owner from now on. Undefined if it is not there.
 *
 * The last row of what an owner gets is its own: it says nothing but that the row is taken.
 */
export function take(id: string, owner?: string): Promise<Kept | undefined> {
  return transact(owner === undefined ? 'readonly' : 'readwrite', ({ documents: d, wholes, journal }) => {
    const [entry, whole] = [d.get(id), wholes.get(id)];
    const [keys, requests] = [journal.getAllKeys(rowsOf(id)), journal.getAll(rowsOf(id))];
    const rows = (): Row[] =>
      keys.result.map((key, i) => ({ seq: seqOf(key), request: requests.result[i] as Request }));
    let mine: Row[] = [];
    requests.onsuccess = () => {
      if (owner === undefined || !entry.result) return;
      const taken: Row = { seq: seqOf(keys.result.at(-1)) + 1, request: { kind: 'abandon' } };
      mine = [taken];
      d.put({ ...entry.result, owner });
      journal.put(taken.request, [id, taken.seq]);
    };
    return () => entry.result && { entry: entry.result, whole: whole.result, rows: [...rows(), ...mine] };
  });
}

/**
 * Writes what was asked, in rows that nobody has written yet. All is on its way when this returns. Not guaranteed: that
 * it is kept if the page ends while another change of these stores, such as `portray`, is still being written.
 *
 * Relaxed: with the system, not yet on the disk. Who waits for the disk has the next rows wait too, and a page that ends
 * takes with it what waits. What is written strictly at the next rest brings these rows to the disk as well.
 */
export function append(entry: Entry, rows: readonly Row[]): Promise<void> {
  return transact(
    'readwrite',
    ({ documents: d, journal }, _, commit) => {
      for (const { seq, request } of rows) journal.add(request, [entry.id, seq]);
      d.put({ ...entry, time: Date.now() });
      commit();
      return nothing;
    },
    'relaxed',
  ).catch((e: Error) => {
    throw e.name === 'ConstraintError' ? new TakenError('taken') : e;
  });
}

/** Writes a row again that bears more than it did. */
export function mend(mine: Mine, { seq, request }: Row): Promise<void> {
  return owned(mine, ({ id }, { journal }) => journal.put(request, [id, seq]));
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

/** What the list shows of a document that its owner works on: its name and a small picture. */
export function portray(mine: Mine, name: string, picture?: string): Promise<void> {
  const change = (entry: Entry, { pictures }: Stores): void => {
    entry.name = name;
    if (picture !== undefined) pictures.put(picture, entry.id);
  };
  return owned(mine, change);
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
  return transact('readwrite', ({ documents: d, pictures, wholes, journal }) => {
    const [entry, picture, whole] = [d.get(id), pictures.get(id), wholes.get(id)];
    const rows = journal.openCursor(rowsOf(id));
    let last = 0;
    rows.onsuccess = () => {
      const row = rows.result;
      if (row) {
        last = seqOf(row.key);
        journal.put(row.value, [to, last]);
        row.continue();
      } else if (entry.result) {
        d.put({ ...entry.result, id: to, name, time: Date.now(), owner: '', deleted: 0 });
        if (picture.result) pictures.put(picture.result, to);
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
