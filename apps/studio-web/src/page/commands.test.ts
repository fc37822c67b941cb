import { afterEach, describe, expect, it, vi } from 'vitest';
import { type CommandId, commandOf, COMMANDS, keyOf, keySheet, type Page } from './commands';
import { commandFor, isTheirs, type Pressed } from './keyboard';
import { en, type TextKey } from '../text/en';
import { zh } from '../text/zh';

/** A page on which nothing is selected, without a view unless one is given. */
function pageWith(parts: object = {}): Page {
  const none = { sheet: { selected: [], element: null, unitsPerPixel: 1 }, session: { drawn: null } };
  return { ...none, ...parts } as unknown as Page;
}

const holding = (word: string): object => ({ shaping: { isOn: true, word } });

/** What is pressed, written as in the table; the key itself as a browser says it. */
function press(written: string): Pressed {
  const key = written.replace(/^(Ctrl\+|Shift\+)*/, '');
  return {
    key,
    ctrlKey: written.includes('Ctrl+'),
    metaKey: false,
    shiftKey: written.includes('Shift+'),
  };
}

const idFor = (page: Page, written: string): string | undefined => commandFor(page, press(written))?.id;

/** What has another name in the bar than among the commands. */
const IN_BAR: Partial<Record<string, TextKey>> = { palette: 'palette.title', help: 'menu.help' };

describe('the short name under a tool', () => {
  it('is part of its name: who speaks to a computer says what stands there', () => {
    for (const key of Object.keys(en).filter((k) => k.startsWith('short.')) as TextKey[]) {
      const id = key.slice('short.'.length) as CommandId;
      const label = IN_BAR[id] ?? commandOf(id).label;
      expect(zh[label!], key).toContain(zh[key]);
      expect(en[label!], key).toMatch(new RegExp(`\\b${en[key]}\\b`, 'i'));
    }
  });
});

describe('the table of commands', () => {
  it('names each command once', () => {
    const ids = COMMANDS.map((c) => c.id);
    expect(new Set(ids).size).toBe(ids.length);
  });

  it('gives no key to two commands of one context', () => {
    for (const shaping of [false, true]) {
      const keys = COMMANDS.filter((c) => (c.shaping ?? false) === shaping).flatMap(
        (c) => c.keys?.split(' ') ?? [],
      );
      expect(keys.length).toBeGreaterThan(0);
      expect(keys.filter((key, i) => keys.indexOf(key) !== i)).toEqual([]);
    }
  });

  it('has a label or a key for every command, and labels in both languages', () => {
    for (const c of COMMANDS) expect(c.label ?? c.keys, c.id).toBeTruthy();
    const labels = COMMANDS.flatMap((c) => c.label ?? []);
    for (const texts of [en, zh]) for (const label of labels) expect(texts[label], label).toMatch(/\S/);
  });
});

describe('the sheet of keys', () => {
  it('lists only keys that commands have', () => {
    const known = new Set(COMMANDS.flatMap((c) => c.keys?.split(' ') ?? []));
    for (const { keys } of keySheet())
      for (const key of keys.split(' ').filter((k) => k !== '·' && k !== '–'))
        expect(known, keys).toContain(key);
  });

  it('says in both languages what each key does', () => {
    for (const texts of [en, zh]) for (const { text } of keySheet()) expect(texts[text], text).toMatch(/\S/);
  });

  it('reads as it is written for people', () => {
    const rows = keySheet().map(({ keys }) => keys);
    expect(rows).toEqual([
      'P B L E Shift+E V Shift+V A Shift+I',
      'Ctrl+Z · Ctrl+Shift+Z',
      'Shift+O',
      'Ctrl+O · Ctrl+S · Ctrl+E',
      'Ctrl+C · Ctrl+X · Ctrl+V · Ctrl+D',
      'Ctrl+A',
      'Del',
      '← ↑ → ↓',
      'M',
      'Y',
      'J',
      '1 – 9',
      '`',
      'Ctrl+← Ctrl+↑ Ctrl+→ Ctrl+↓',
      'U',
      'Shift+L',
      'Shift+M',
      'Shift+R',
      'Shift+G',
      'D',
      'F · Shift+0',
      'Shift+P · Shift+F',
      'T · C · O',
      'N · Shift+N',
      'H',
      'G · R · S',
      'X · Z',
      'Ctrl+G · Ctrl+Shift+G',
      'W · K',
      'I',
      'Shift+T',
      'Shift+S',
      '1 – 9',
      'Q · Shift+Q',
      ', · .',
      '[ ]',
      'Ctrl+K',
      '?',
    ]);
  });
});

describe('a key', () => {
  afterEach(() => void vi.unstubAllGlobals());

  it('means its command, whatever the case', () => {
    const page = pageWith();
    for (const key of ['Shift+r', 'Shift+R']) expect(idFor(page, key)).toBe('dice');
    for (const key of ['r', 'R']) expect(idFor(pageWith({ view: {} }), key)).toBe('place-turn');
    expect(idFor(pageWith({ view: {}, gizmo: 'translate' }), 'x')).toBe('place-x');
    expect(idFor(page, 'Ctrl+z')).toBe('undo');
    expect(idFor(page, 'Ctrl+Shift+Z')).toBe('redo');
    expect(idFor(page, 'Ctrl+y')).toBe('redo');
    expect(idFor(page, 'Ctrl+Shift+S')).toBe('save');
    expect(commandFor(page, { key: 'k', ctrlKey: false, metaKey: true, shiftKey: false })?.id).toBe(
      'palette',
    );
    expect(idFor(page, 'Shift+)')).toBe('frame');
    expect(idFor(page, '0')).toBe('fit');
    expect(idFor(page, 'Shift+?')).toBe('help');
    expect(idFor(page, 'x')).toBeUndefined();
  });

  it('is the view’s own while a tool is held there', () => {
    expect(idFor(pageWith(), '1')).toBeUndefined();
    expect(idFor(pageWith(), 'q')).toBeUndefined();
    expect(idFor(pageWith(), ']')).toBe('select-next');
    expect(idFor(pageWith(), 'Escape')).toBe('select-none');
    const drawn = { session: { drawn: {} } };
    expect(idFor(pageWith(drawn), '1')).toBe('mean-axis');
    expect(idFor(pageWith({ ...drawn, ...holding('brush') }), '1')).toBe('shape-pick');
    const brush = pageWith(holding('brush'));
    expect(idFor(brush, '1')).toBe('shape-pick');
    expect(idFor(brush, 'q')).toBe('shape-up');
    expect(idFor(brush, 'Shift+Q')).toBe('shape-down');
    expect(idFor(brush, ']')).toBe('shape-larger');
    expect(idFor(brush, 'Escape')).toBe('shape-leave');
    expect(idFor(pageWith(holding('pick')), ']')).toBe('select-next');
    expect(idFor(pageWith(holding('pick')), 'Backspace')).toBe('shape-remove');
  });

  it('is left to the browser where it would do nothing', () => {
    vi.stubGlobal('getSelection', () => null);
    vi.stubGlobal('document', { activeElement: null });
    for (const key of ['Ctrl+c', 'Ctrl+x', 'Delete', 'ArrowLeft', 's', 'Shift+S'])
      expect(idFor(pageWith(), key)).toBeUndefined();
    const selected = pageWith({ sheet: { selected: [3], element: null, unitsPerPixel: 2 } });
    expect(idFor(selected, 'Ctrl+c')).toBe('copy');
    expect(idFor(selected, 'Delete')).toBe('remove');
    expect(idFor(selected, 'Ctrl+v')).toBeUndefined();
  });

  it('moves what is selected, with Shift five times as far', () => {
    const sheet = { selected: [3], element: {}, unitsPerPixel: 2 };
    const draw = vi.fn();
    const page = pageWith({ sheet, session: { draw } });
    vi.stubGlobal('document', { activeElement: sheet.element });
    commandFor(page, press('ArrowLeft'))?.run(page);
    commandFor(page, press('Shift+ArrowUp'))?.run(page);
    expect(draw.mock.calls).toEqual([
      [{ 'move-strokes': [[3], [-10, 0]] }],
      [{ 'move-strokes': [[3], [0, 50]] }],
    ]);
  });

  it('is left to a field that writes, and taken from one that does not', () => {
    for (const field of ['text', 'number', 'search', 'textarea'])
      for (const key of ['t', 'Ctrl+z', 'Delete'])
        expect(isTheirs(field, press(key)), `${field} ${key}`).toBe(true);
    for (const key of ['t', 'Ctrl+z', 'Ctrl+k', 'Escape'])
      for (const field of ['range', 'checkbox', 'color'])
        expect(isTheirs(field, press(key)), `${field} ${key}`).toBe(false);
    expect(isTheirs('range', press('ArrowLeft'))).toBe(true);
    expect(isTheirs('range', press('Delete'))).toBe(true);
    expect(isTheirs('checkbox', press(' '))).toBe(true);
    expect(isTheirs('select', press('t'))).toBe(true);
    expect(isTheirs('select', press('Ctrl+z'))).toBe(false);
  });

  it('is shown to people as the first of a command’s keys', () => {
    expect(keyOf('redo')).toBe('Ctrl+Shift+Z');
    expect(keyOf('new')).toBe('');
  });
});
