/** Nine plants of one drawing, to choose from. */
import type { Engine } from '../worker/engine';
import type { Sent } from '../worker/protocol';
import { t } from '../text';
import { dialog, el } from '../page/ui';

const COUNT = 9;
/** A small picture needs fewer triangles than the plant itself. */
const DETAIL = 0.4;

export interface VariationsEvents {
  /** A small picture of a plant; undefined without WebGL. */
  snapshot(sent: Sent): HTMLCanvasElement | undefined;
  take(seed: string): void;
}

/** Opens the grid: the first is the plant as it is, the others are rolled. */
export function openVariations(engine: Engine, now: string, events: VariationsEvents): void {
  let open = true;
  const grid = el('div', { class: 'variations' });
  const roll = (): string => String(1 + (crypto.getRandomValues(new Uint32Array(1))[0]! % 999_999));
  const again = el(
    'button',
    { type: 'button', class: 'wide', onclick: () => void fill() },
    t('variations.again'),
  );
  const d = dialog(
    t('variations.title'),
    el('p', { class: 'muted' }, t('variations.hint')),
    grid,
    el('div', { class: 'row' }, el('span', { class: 'space' }), again),
  );
  d.addEventListener('close', () => {
    open = false;
  });
  let round = 0;
  async function fill(): Promise<void> {
    const mine = ++round;
    const seeds = [now, ...Array.from({ length: COUNT - 1 }, roll)];
    const cells = seeds.map((seed, i) => {
      const cell = el(
        'button',
        {
          type: 'button',
          'data-seed': seed,
          disabled: '',
          onclick: () => {
            d.close();
            if (seed !== now) events.take(seed);
          },
        },
        el('span', { class: 'blank' }),
        el('span', {}, i === 0 ? t('variations.now') : seed),
      );
      return { seed, cell };
    });
    grid.replaceChildren(...cells.map(({ cell }) => cell));
    for (const { seed, cell } of cells) {
      // One after the other: each shows as soon as it is there, and closing ends the work.
      if (!open || mine !== round) return;
      try {
        const picture = events.snapshot(await engine.ask<Sent>({ kind: 'variant', seed, detail: DETAIL }));
        if (picture) cell.firstElementChild?.replaceWith(picture);
        cell.disabled = false;
      } catch (e) {
        cell.lastElementChild!.textContent = (e as Error).message;
      }
    }
    grid.dataset['full'] = 'true';
  }
  void fill();
}
