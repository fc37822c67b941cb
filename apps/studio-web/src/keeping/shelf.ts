/** The list of the documents that this browser keeps: open, rename, copy, delete and bring back. */
import type { Documents } from './documents';
import { newId } from './keeper';
import { copy, documents, held, rename, setDeleted } from './library';
import { currentLanguage, t } from '../text';
import { button, dialog, el, icon } from '../page/ui';

type Entry = Awaited<ReturnType<typeof documents>>[number];

export interface ShelfEvents {
  readonly here: Documents;
  /** The document that is here is named as any change is made. */
  rename(name: string): void;
  failed(why: Error): void;
}

export async function openShelf(page: ShelfEvents): Promise<void> {
  const { here } = page;
  const list = el('ul', { class: 'shelf' });
  const gone = el('ul', { class: 'shelf' });
  const away = el('details', { class: 'shelf-gone' }, el('summary', {}), gone);
  const fresh = el(
    'button',
    {
      type: 'button',
      class: 'primary',
      id: 'b-shelf-new',
      onclick: () => {
        d.close();
        void here.fresh();
      },
    },
    t('menu.new'),
  );

  /** Does it, and shows what there is then; `focus`: where the keyboard goes on. */
  const act = async (does: () => Promise<void>, focus = ''): Promise<void> => {
    try {
      await does();
      await fill();
    } catch (e) {
      d.close();
      page.failed(e as Error);
    }
    d.querySelector<HTMLElement>(focus || '.shelf button')?.focus();
  };

  const fill = async (): Promise<void> => {
    await here.keeper.settled();
    const [found, open] = await Promise.all([documents(), held()]);
    const all = found.map((e) => ({ ...e, name: e.name || t('app.untitled') }));
    const [kept, deleted] = [all.filter((e) => e.deleted === 0), all.filter((e) => e.deleted > 0)];
    list.replaceChildren(...kept.map((e) => row(e, open.has(e.id) && e.id !== here.current)));
    if (kept.length === 0) list.append(el('li', { class: 'muted' }, t('documents.none')));
    gone.replaceChildren(...deleted.map(goneRow));
    away.querySelector('summary')!.textContent = t('documents.deleted', { count: deleted.length });
    away.hidden = deleted.length === 0;
  };

  const row = (e: Entry, elsewhere: boolean): HTMLElement => {
    const mine = e.id === here.current;
    const where = mine ? t('documents.here') : elsewhere ? t('documents.elsewhere') : '';
    const open: HTMLElement = el(
      'button',
      {
        type: 'button',
        class: 'shelf-open',
        'data-document': e.id,
        'aria-current': String(mine),
        onclick: () => {
          d.close();
          void here.open(e.id);
        },
        onkeydown: (k) => key(k as KeyboardEvent, line),
      },
      e.picture ? el('img', { src: e.picture, alt: '' }) : el('span', { class: 'blank' }, icon('sketch')),
      el(
        'span',
        {},
        el('b', {}, e.name),
        el('span', { class: 'muted' }, [dateOf(e.time), where].filter(Boolean).join(' · ')),
      ),
    );
    const named = button('parts', t('documents.rename', { name: e.name }), () =>
      line.replaceChild(naming(e, line), open),
    );
    named.setAttribute('data-act', 'rename');
    const copied = button(
      'copy',
      t('documents.copy', { name: e.name }),
      () => void act(() => copy(e.id, newId(), t('documents.copied', { name: e.name }))),
    );
    copied.setAttribute('data-act', 'copy');
    const removed = button(
      'bin',
      t('documents.delete', { name: e.name }),
      () =>
        void act(async () => {
          if (mine) await here.fresh(true);
          await setDeleted(e.id, true);
          away.open = true;
        }, `[data-back="${e.id}"]`),
    );
    removed.setAttribute('data-act', 'delete');
    // Another tab would go on as if nothing had happened.
    named.disabled = removed.disabled = elsewhere || (mine && here.refusal() !== undefined);
    const line: HTMLElement = el('li', {}, open, named, copied, removed);
    return line;
  };

  const goneRow = (e: Entry): HTMLElement =>
    el(
      'li',
      {},
      el(
        'span',
        { class: 'shelf-open' },
        el('span', {}, el('b', {}, e.name), el('span', { class: 'muted' }, dateOf(e.deleted))),
      ),
      el(
        'button',
        {
          type: 'button',
          class: 'link',
          'data-back': e.id,
          onclick: () => void act(() => setDeleted(e.id, false), `[data-document="${e.id}"]`),
        },
        t('documents.back'),
      ),
    );

  const naming = (e: Entry, line: HTMLElement): HTMLElement => {
    const field = el('input', { class: 'field', maxlength: '200', 'aria-label': t('menu.name') });
    field.value = e.name;
    const done = (keep: boolean): void => {
      const name = field.value.trim();
      const changed = keep && name !== '' && name !== e.name;
      void act(async () => {
        if (!changed) return;
        if (e.id === here.current) {
          page.rename(name);
          await here.named(name);
        } else await rename(e.id, name);
      }, `[data-document="${e.id}"]`);
    };
    const form = el(
      'form',
      {
        class: 'shelf-open',
        onsubmit: (s) => {
          s.preventDefault();
          done(true);
        },
        onkeydown: (k) => {
          if ((k as KeyboardEvent).key !== 'Escape') return;
          // The list stays.
          k.preventDefault();
          done(false);
        },
      },
      field,
      el('button', { type: 'submit', class: 'primary' }, t('scene.rename')),
    );
    requestAnimationFrame(() => field.select());
    line.classList.add('named');
    return form;
  };

  /** Arrows walk through the list; F2 and Delete do here what they do elsewhere. */
  const key = (k: KeyboardEvent, line: HTMLElement): void => {
    const to = { ArrowDown: line.nextElementSibling, ArrowUp: line.previousElementSibling }[k.key];
    const press = { F2: 'rename', Delete: 'delete' }[k.key];
    if (to) to.querySelector<HTMLElement>('.shelf-open')?.focus();
    else if (press) line.querySelector<HTMLElement>(`[data-act=${press}]`)?.click();
    else return;
    k.preventDefault();
  };

  const d = dialog(
    t('documents.title'),
    list,
    away,
    el(
      'div',
      { class: 'row' },
      el('span', { class: 'muted' }, t('documents.hint')),
      el('span', { class: 'space' }),
      fresh,
    ),
  );
  d.classList.add('wide-dialog', 'shelf-dialog');
  await here.portray();
  await act(() => Promise.resolve());
}

function dateOf(time: number): string {
  const language = currentLanguage() === 'zh' ? 'zh-CN' : 'en-GB';
  return new Intl.DateTimeFormat(language, { dateStyle: 'medium', timeStyle: 'short' }).format(time);
}
