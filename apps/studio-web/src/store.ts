/** The browser's own storage. Every function may fail quietly: private mode and full disks are told once by the page. */

const NAME = 'burgeon';
const STORE = 'projects';
const KEY = 'last';

export interface Kept {
  bytes: Uint8Array;
  name: string;
  time: number;
}

function open(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open(NAME, 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE);
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
    request.onblocked = () => reject(new Error('blocked'));
  });
}

async function transact<T>(mode: IDBTransactionMode, act: (s: IDBObjectStore) => IDBRequest<T>): Promise<T> {
  const base = await open();
  try {
    return await new Promise<T>((resolve, reject) => {
      const transaction = base.transaction(STORE, mode);
      const request = act(transaction.objectStore(STORE));
      transaction.oncomplete = () => resolve(request.result);
      transaction.onerror = () => reject(transaction.error);
      transaction.onabort = () => reject(transaction.error);
    });
  } finally {
    base.close();
  }
}

export async function keep(kept: Kept): Promise<void> {
  await transact('readwrite', (s) => s.put(kept, KEY));
}

export async function kept(): Promise<Kept | undefined> {
  return (await transact('readonly', (s) => s.get(KEY))) as Kept | undefined;
}

/** A small setting, such as the language; undefined if there is none or nothing may be read. */
export function setting(name: string): string | undefined {
  try {
    return localStorage.getItem(`burgeon.${name}`) ?? undefined;
  } catch {
    return undefined;
  }
}

export function setSetting(name: string, value: string): void {
  try {
    localStorage.setItem(`burgeon.${name}`, value);
  } catch {
    // The choice lasts until the page closes.
  }
}
