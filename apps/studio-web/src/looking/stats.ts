/** Figures of the plant that is shown: every one was counted or measured. */
import type { PlantState, PlantView } from '../wire';
import { number, t, type TextKey } from '../text';
import { el } from '../page/ui';

/** A share in percent; a dash where there was nothing to measure. */
const percent = (share: number | null, digits: number): string =>
  share === null ? '–' : `${(share * 100).toFixed(digits)} %`;

export function statsTable(state: PlantState | undefined, view: PlantView | undefined): HTMLElement {
  const table = el('dl', { class: 'stats' });
  const row = (key: TextKey, value: string): void => {
    table.append(el('dt', {}, t(key)), el('dd', {}, value));
  };
  if (!view || view.parts.length === 0) {
    table.append(el('dt', {}, t('view.empty')));
    return table;
  }
  const metres = (x: number): string => (x >= 1 ? `${x.toFixed(2)} m` : `${(x * 100).toFixed(1)} cm`);
  row('stats.height', metres(view.max[1] - view.min[1]));
  row('stats.width', metres(Math.max(view.max[0] - view.min[0], view.max[2] - view.min[2])));
  const { item } = view;
  if (item) {
    // What was not counted has no row.
    const counted = (key: TextKey, count: number | null): void => {
      if (count !== null) row(key, number(count));
    };
    const c = item.counts;
    for (const kind of ['flowers', 'petals', 'leaves', 'branches'] as const)
      counted(`stats.${kind}`, c[kind]);
    counted('stats.nodes', c.nodes);
    row('stats.vertices', number(c.vertices));
    row('stats.triangles', number(c.triangles));
    row('stats.parts', number(view.parts.length));
    if (state?.maker === 'sketch') {
      const { reprojection_mean, excess_mean, overlap } = item.fidelity;
      row('stats.error', percent(reprojection_mean, 2));
      row('stats.excess', percent(excess_mean, 2));
      row('stats.overlap', percent(overlap, 0));
    }
    row('stats.time', `${item.timings_ms.total.toFixed(1)} ms`);
    row('stats.seed', state?.seed ?? '');
    row('stats.digest', item.digest.slice(0, 8));
  }
  return table;
}
