/** What numbers mean that are typed while plants are moved, turned or sized. */
import type { Gizmo } from './scene';
import type { Carry, PlantState } from '../wire';

/**
 * How plants are carried by what was typed: metres along the axis, or along x and z with a comma between them; degrees;
 * times the size. Nothing where that is no such number.
 */
export function carryOf(
  gizmo: Gizmo,
  axis: 'x' | 'z' | undefined,
  typed: string,
  about: Carry['about'],
): Carry | undefined {
  const numbers = typed.split(',').map((word) => (word.trim() === '' ? NaN : Number(word)));
  const most = gizmo === 'translate' && axis === undefined ? 2 : 1;
  if (numbers.length > most || !numbers.every(Number.isFinite)) return undefined;
  const [first = 0, second = 0] = numbers;
  const how: Carry = { about, by: [0, 0, 0], turn_deg: 0, scale: 1 };
  if (gizmo === 'translate') return { ...how, by: axis === 'z' ? [0, 0, first] : [first, 0, second] };
  if (gizmo === 'rotate') return { ...how, turn_deg: first };
  return first > 0 ? { ...how, scale: first } : undefined;
}

/** Amid some plants, metres. */
export function middleOf(plants: readonly PlantState[]): Carry['about'] {
  const sum = (axis: 0 | 1 | 2): number => plants.reduce((s, p) => s + p.position[axis], 0) / plants.length;
  return [sum(0), sum(1), sum(2)];
}
