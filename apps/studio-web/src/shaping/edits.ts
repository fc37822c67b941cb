/** The list of what was done to a plant by hand: what came of each edit, left out, taken back. */
import { number, t, tOf } from '../text';
import { iconOfEdit } from './tools';
import { button, el, icon, refill } from '../page/ui';
import type { EditReport, PlantState, PlantView as Seen, ShapeCommand } from '../wire';

export class EditList {
  readonly element = el('section', { class: 'edits' });
  private shown: [PlantState | undefined, Seen | undefined] = [undefined, undefined];
  /** Whether it is folded, as the person set it. */
  private folds: boolean | undefined;

  constructor(private readonly run: (command: ShapeCommand) => void) {}

  show(plant: PlantState | undefined, seen: Seen | undefined): void {
    this.shown = [plant, seen];
    const edits = plant?.edits ?? [];
    this.element.hidden = edits.length === 0;
    const reports = new Map((seen?.item?.edits ?? []).map((r) => [r.index, r]));
    const undone = edits.filter((e, row) => !e.off && reports.get(row)?.done === false).length;
    document.body.dataset['edits'] = String(edits.length);
    document.body.dataset['undone'] = String(undone);
    document.body.dataset['done'] = String([...reports.values()].filter((r) => r.done).length);
    if (this.element.hidden) {
      this.element.replaceChildren();
      return;
    }
    const rows = edits.map(({ op, off }, row) => {
      const report = reports.get(row);
      const bad = !off && report?.done === false;
      const name = tOf('edit', op);
      const what = el(
        'span',
        { class: 'what' },
        el('span', { class: 'name' }, name),
        el('span', { class: bad ? 'bad' : 'muted' }, off ? t('edit.off') : report ? said(report) : ''),
      );
      const eye = button(off ? 'hidden' : 'eye', t(off ? 'edit.show' : 'edit.hide', { name }), () =>
        this.run({ leave: [row, !off] }),
      );
      eye.setAttribute('data-key', `eye${row}`);
      const gone = button('close', t('edit.remove', { name }), () => this.run({ remove: [row] }));
      gone.setAttribute('data-key', `gone${row}`);
      return el(
        'li',
        {
          class: `${off ? 'is-off' : ''} ${bad ? 'is-bad' : ''}`,
          'data-edit': op,
          title: report && !off ? `${name}: ${said(report)}` : name,
        },
        icon(bad ? 'warning' : iconOfEdit(op)),
        what,
        eye,
        gone,
      );
    });
    const all = button('close', t('edit.remove.all'), () => this.run({ remove: edits.map((_, row) => row) }));
    all.setAttribute('data-key', 'all');
    // Open, it would lie over the plants: that is a person's wish.
    const folded = this.folds ?? true;
    const fold = el(
      'button',
      {
        type: 'button',
        class: 'fold',
        'data-key': 'fold',
        'aria-expanded': String(!folded),
        onclick: () => {
          this.folds = !folded;
          this.show(...this.shown);
        },
      },
      icon('shape'),
      t('edit.title'),
      el('span', { class: 'muted' }, String(edits.length)),
      ...(undone > 0
        ? [
            el(
              'span',
              { class: 'bad', title: t('edit.undone.count', { count: undone }) },
              icon('warning'),
              String(undone),
            ),
          ]
        : []),
    );
    this.element.classList.toggle('folded', folded);
    refill(this.element, 'data-key', () =>
      this.element.replaceChildren(
        el('div', { class: 'edits-head' }, fold, ...(folded ? [] : [all])),
        ...(folded ? [] : [el('ol', {}, ...rows)]),
      ),
    );
  }
}

/** What became of an edit, in the person's language. */
function said(r: EditReport): string {
  if (!r.done) return t('edit.undone', { why: tOf('why', r.code) });
  const parts = (['moved', 'removed', 'added', 'leaves_removed', 'leaves_added', 'alone'] as const)
    .filter((k) => (r.changed[k] ?? 0) > 0)
    .map((k) => t(`edit.${k}`, { count: number(r.changed[k]!) }));
  if (parts.length === 0) parts.push(t('edit.nothing'));
  if (r.changed.by_likeness) parts.push(t('edit.by_likeness'));
  return parts.join(' · ');
}
