/** How high and wide plants are, in metres, and how high, wide or thick they shall be. */
import { t } from '../text';
import { el } from '../page/ui';
import type { SizeGoal } from '../wire';

/** What can be asked, with the least and the most in metres, as the core has them. */
const GOALS = {
  height: { least: 0.01, most: 1000 },
  width: { least: 0.01, most: 1000 },
  dbh: { least: 0.001, most: 30 },
} as const;
type Goal = keyof typeof GOALS;

export interface SizeEvents {
  /** What they are now, as far as it is known, metres. */
  now: Partial<Record<Goal, number>>;
  /** Whether all of them are trees, which grow to a size. */
  grows: boolean;
  /** How many plants are sized. */
  count: number;
  /** Gives them the size; else says why they cannot have it. */
  size(goal: SizeGoal): Promise<string | undefined>;
  /** They have it. */
  done(): void;
}

/** A field for each size that the chosen plants can be given. */
export function sizePanel(events: SizeEvents): HTMLElement {
  const status = el('p', { class: 'muted', role: 'status' }, hintOf(events));
  const goals: Goal[] = events.grows ? ['height', 'width', 'dbh'] : ['height', 'width'];
  const panel = el('div', { class: 'sizing', id: 'b-sizing' });
  const ask = async (goal: Goal, input: HTMLInputElement): Promise<void> => {
    const { least, most } = GOALS[goal];
    if (!Number.isFinite(input.valueAsNumber)) return;
    const wanted = Math.min(most, Math.max(least, input.valueAsNumber));
    status.textContent = t('size.working');
    const fields = [...panel.querySelectorAll('input')];
    for (const field of fields) field.disabled = true;
    const refused = await events.size({ [goal]: wanted } as SizeGoal);
    if (refused === undefined) {
      events.done();
      return;
    }
    for (const field of fields) field.disabled = false;
    status.textContent = refused;
    input.focus();
  };
  const rows = goals.map((goal) => {
    const now = events.now[goal];
    const input = el('input', {
      type: 'number',
      class: 'f-number',
      step: 'any',
      min: String(GOALS[goal].least),
      max: String(GOALS[goal].most),
      'data-size': goal,
      onchange: () => void ask(goal, input),
    });
    if (now !== undefined) input.value = String(Number(now.toPrecision(3)));
    return el('label', { class: 'f-row' }, el('span', {}, t(`size.${goal}`)), input, el('span', {}, 'm'));
  });
  panel.append(...rows, status);
  return panel;
}

function hintOf({ grows, count }: SizeEvents): string {
  const hint = t(grows ? 'size.hint.tree' : 'size.hint');
  return count > 1 ? `${hint} ${t('maker.alike', { count })}.` : hint;
}
