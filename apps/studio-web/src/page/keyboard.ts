/** From a key that was pressed to the command that it means. */
import { COMMANDS, type Page, type PageCommand } from './commands';

/** A keyboard event, as far as it matters here. */
export type Pressed = Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'shiftKey'>;

/** Keys that the table calls by another name than the browser does. */
const NAMES: Record<string, string> = {
  ')': 'Shift+0',
  Escape: 'Esc',
  Delete: 'Del',
  Backspace: 'Del',
  ArrowLeft: '←',
  ArrowUp: '↑',
  ArrowRight: '→',
  ArrowDown: '↓',
};

/** The names of what was pressed, the most exact first: Shift counts only where a command asks for it. */
function namesOf(e: Pressed): string[] {
  const key = NAMES[e.key] ?? e.key.toUpperCase();
  const control = e.ctrlKey || e.metaKey ? 'Ctrl+' : '';
  const shifted = e.shiftKey && /^[A-Z←↑→↓]$/.test(key);
  return [...(shifted ? [`${control}Shift+${key}`] : []), control + key];
}

/** Whether the keys of a command count now. */
export function isAwake(page: Page, command: PageCommand): boolean {
  return !command.shaping || (page.shaping?.isOn ?? false);
}

/** The command that a key means now; none if it is to be left to the browser. */
export function commandFor(page: Page, e: Pressed): PageCommand | undefined {
  const names = namesOf(e);
  const found = (shaping: boolean): PageCommand | undefined =>
    names
      .flatMap((name) => COMMANDS.filter((c) => c.keys?.split(' ').includes(name)))
      .find((c) => (c.shaping ?? false) === shaping && isAwake(page, c) && (c.when?.(page) ?? true));
  return found(true) ?? found(false);
}

/** Fields in which nothing is written, with the keys that are theirs. */
const FIELDS: Record<string, RegExp> = {
  range: /^(Arrow.*|Home|End|Page.*|Delete|Backspace|Tab)$/,
  checkbox: /^( |Delete|Backspace|Tab)$/,
  radio: /^( |Arrow.*|Delete|Backspace|Tab)$/,
  color: /^( |Enter|Delete|Backspace|Tab)$/,
};

/**
 * Whether a key is for the field that has it: all are where text is written, and letters in a list; a slider that was just
 * moved is no reason to take undo away. `field`: the type of an input, or the name of the element.
 */
export function isTheirs(field: string, e: Pressed): boolean {
  if (field === 'select') return !e.ctrlKey && !e.metaKey;
  return FIELDS[field]?.test(e.key) ?? true;
}

/** Listens for keys, but not where text is written or a dialog is open. */
export function listenForKeys(page: Page): void {
  document.addEventListener('keydown', (e) => {
    const target = e.target as HTMLElement;
    const field = target instanceof HTMLInputElement ? target.type : target.localName;
    if (target.matches('input, select, textarea') && isTheirs(field, e)) return;
    if (document.querySelector('dialog[open]')) return;
    if (page.typing.take(e)) {
      e.preventDefault();
      return;
    }
    const command = commandFor(page, e);
    if (!command) return;
    e.preventDefault();
    command.run(page);
  });
}
