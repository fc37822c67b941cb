/** Strokes side by side: on one line, or with the same room between them. */
import { type Box, united } from './geometry';

export const ALIGNMENTS = ['left', 'centre', 'right', 'top', 'middle', 'bottom'] as const;
export const DISTRIBUTIONS = ['across', 'upward'] as const;
export type Arrangement = (typeof ALIGNMENTS)[number] | (typeof DISTRIBUTIONS)[number];

export interface Placed {
  readonly id: number;
  readonly box: Box;
}

/** The fewest strokes that can be put in order. */
export const fewest = (how: Arrangement): number => (how === 'across' || how === 'upward' ? 3 : 2);

/** How far each stroke is moved, of those that are. */
export function arranged(strokes: readonly Placed[], how: Arrangement): [number, [number, number]][] {
  const [first, ...others] = strokes;
  if (!first || strokes.length < fewest(how)) return [];
  const all = others.reduce((box, s) => united(box, s.box), first.box);
  const moves =
    how === 'across' || how === 'upward' ? distributed(strokes, how, all) : aligned(strokes, how, all);
  return moves.filter(([, [x, y]]) => x !== 0 || y !== 0);
}

function aligned(
  strokes: readonly Placed[],
  how: (typeof ALIGNMENTS)[number],
  all: Box,
): [number, [number, number]][] {
  const by = (box: Box): [number, number] => {
    switch (how) {
      case 'left':
        return [all.left - box.left, 0];
      case 'right':
        return [all.right - box.right, 0];
      case 'top':
        return [0, all.top - box.top];
      case 'bottom':
        return [0, all.bottom - box.bottom];
      case 'centre':
        return [(all.left + all.right - box.left - box.right) / 2, 0];
      case 'middle':
        return [0, (all.bottom + all.top - box.bottom - box.top) / 2];
    }
  };
  return strokes.map(({ id, box }) => [id, by(box)]);
}

/** The outermost stay; between any two there is as much room as between others. */
function distributed(
  strokes: readonly Placed[],
  how: (typeof DISTRIBUTIONS)[number],
  all: Box,
): [number, [number, number]][] {
  const ends = ({ box }: Placed): [number, number] =>
    how === 'across' ? [box.left, box.right] : [box.bottom, box.top];
  const middle = (s: Placed): number => ends(s)[0] + ends(s)[1];
  const row = [...strokes].sort((a, b) => middle(a) - middle(b));
  const filled = row.reduce((sum, s) => sum + ends(s)[1] - ends(s)[0], 0);
  const [low, high] = how === 'across' ? [all.left, all.right] : [all.bottom, all.top];
  const gap = (high - low - filled) / (row.length - 1);
  let at = low;
  return row.map((s): [number, [number, number]] => {
    const by = at - ends(s)[0];
    at += ends(s)[1] - ends(s)[0] + gap;
    return [s.id, how === 'across' ? [by, 0] : [0, by]];
  });
}
