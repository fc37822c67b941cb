/** What of the sheet has to be drawn again: of a drawing of thousands of strokes, one more changes a corner. */
import { type Box, united } from './geometry';

/** What a stroke looks like. */
export interface Seen {
  readonly id: number;
  readonly mode: string;
  readonly points: Float64Array;
  readonly box: Box;
  readonly color: string | undefined;
  readonly width: number | undefined;
}

/** So many times its width a line reaches from its middle: the pressure of a pen makes it 1.7 times as wide. */
export const THICKEST = 0.9;

/** Where its line may be; one without a width of its own is some pixels wide, which the drawing does not tell. */
export function roomOf({ box, width }: Pick<Seen, 'box' | 'width'>): Box {
  const by = THICKEST * (width ?? 0);
  return { left: box.left - by, right: box.right + by, bottom: box.bottom - by, top: box.top + by };
}

/** Nothing, what is in a box of the drawing, or everything. */
export type Stale = Box | 'all' | undefined;

export function both(a: Stale, b: Stale): Stale {
  if (a === 'all' || b === 'all') return 'all';
  return a && b ? united(a, b) : (a ?? b);
}

const alike = (a: Seen, b: Seen): boolean =>
  a.points === b.points && a.mode === b.mode && a.color === b.color && a.width === b.width;

/** What changed between two states of what is seen, each from below upwards. */
export function staleOf(before: readonly Seen[], now: readonly Seen[]): Stale {
  const [old, fresh] = [new Map(before.map((s) => [s.id, s])), new Set(now.map((s) => s.id))];
  const stayed = before.filter((s) => fresh.has(s.id));
  let row = 0;
  let stale: Stale;
  for (const s of now) {
    const was = old.get(s.id);
    if (was) {
      // What lies over what is another.
      if (stayed[row]?.id !== s.id) return 'all';
      row += 1;
    }
    if (!was || !alike(was, s)) stale = both(stale, was ? united(roomOf(was), roomOf(s)) : roomOf(s));
  }
  for (const s of before) if (!fresh.has(s.id)) stale = both(stale, roomOf(s));
  return stale;
}

/** Whether a stroke may reach into a box: `reach` is the half of its width, in the drawing's unit. */
export const reaches = (box: Box, { left, right, bottom, top }: Box, reach: number): boolean =>
  box.left - reach <= right &&
  box.right + reach >= left &&
  box.bottom - reach <= top &&
  box.top + reach >= bottom;
