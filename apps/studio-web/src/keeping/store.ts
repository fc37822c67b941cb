/** The browser's own storage. What it does not keep it does not keep: whoever asks says so to people. */

/** A small setting, such as the language; undefined if there is none or nothing may be read. */
export function setting(name: string): string | undefined {
  return read(() => localStorage, name);
}

export function setSetting(name: string, value: string): void {
  write(() => localStorage, name, value);
}

export function dropSetting(name: string): void {
  try {
    localStorage.removeItem(`burgeon.${name}`);
  } catch {
    // Where nothing may be written, there is nothing to be removed.
  }
}

/** The same for this tab alone; it survives a reload. */
export function tabSetting(name: string): string | undefined {
  return read(() => sessionStorage, name);
}

export function setTabSetting(name: string, value: string): void {
  write(() => sessionStorage, name, value);
}

function read(storage: () => Storage, name: string): string | undefined {
  try {
    return storage().getItem(`burgeon.${name}`) ?? undefined;
  } catch {
    return undefined;
  }
}

function write(storage: () => Storage, name: string, value: string): void {
  try {
    storage().setItem(`burgeon.${name}`, value);
  } catch {
    // The choice lasts until the page closes.
  }
}
