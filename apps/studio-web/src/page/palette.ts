/** The command palette: everything the page can do, by name. */
import { COMMANDS, keyOf, type Page } from './commands';
import { isAwake } from './keyboard';
import { nearness } from './nearness';
import { t } from '../text';
import { dialog, el } from './ui';

interface Entry {
  id: string;
  label: string;
  keys: string;
  act(): void;
}

/** What has a name, with the key that would do the same now. */
function entriesOf(page: Page): Entry[] {
  return COMMANDS.flatMap((c) =>
    c.label
      ? [{ id: c.id, label: t(c.label), keys: isAwake(page, c) ? keyOf(c.id) : '', act: () => c.run(page) }]
      : [],
  );
}

function option(entry: Entry, onclick: () => void): HTMLElement {
  return el(
    'button',
    { type: 'button', role: 'option', id: `p-${entry.id}`, tabindex: '-1', onclick },
    el('span', {}, entry.label),
    ...(entry.keys ? [el('kbd', {}, entry.keys)] : []),
  );
}

export function openPalette(page: Page): void {
  const entries = entriesOf(page);
  const list = el('div', {
    class: 'menu',
    role: 'listbox',
    id: 'palette-list',
    'aria-label': t('palette.title'),
  });
  let shown: Entry[] = [];
  let chosen = 0;
  const mark = (): void => {
    [...list.children].forEach((c, i) => c.setAttribute('aria-selected', String(i === chosen)));
    input.setAttribute('aria-activedescendant', list.children[chosen]?.id ?? '');
    list.children[chosen]?.scrollIntoView({ block: 'nearest' });
  };
  const run = (a: Entry | undefined): void => {
    if (a) {
      d.close();
      a.act();
    }
  };
  const fill = (): void => {
    const found = entries.flatMap((a) => {
      const n = nearness(a.label, input.value);
      return n === undefined ? [] : [{ a, n }];
    });
    shown = found.sort((x, y) => x.n - y.n).map(({ a }) => a);
    chosen = 0;
    list.replaceChildren(...shown.map((a) => option(a, () => run(a))));
    if (shown.length === 0) list.append(el('p', { class: 'muted' }, t('palette.none')));
    mark();
  };
  const input = el('input', {
    type: 'search',
    class: 'field',
    placeholder: t('palette.hint'),
    'aria-label': t('palette.hint'),
    role: 'combobox',
    'aria-expanded': 'true',
    'aria-controls': 'palette-list',
    autocomplete: 'off',
    spellcheck: 'false',
    oninput: fill,
    onkeydown: (e) => {
      const { key } = e as KeyboardEvent;
      const step = { ArrowDown: 1, ArrowUp: -1 }[key];
      if (step) {
        chosen = (chosen + step + shown.length) % Math.max(1, shown.length);
        mark();
      } else if (key === 'Enter') run(shown[chosen]);
      else return;
      e.preventDefault();
    },
  });
  const d = dialog(t('palette.title'), input, list);
  d.classList.add('palette');
  fill();
  input.focus();
}
