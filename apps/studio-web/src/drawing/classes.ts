/** What a person can say that a stroke is. */
import type { StrokeClass } from '../wire';

/** In the order in which they are shown; the first nine have the keys 1 to 9. */
export const CLASSES = [
  'axis',
  'blade',
  'corolla',
  'disc',
  'vein',
  'fruit',
  'trunk_outline',
  'crown',
  'pot',
  'ground',
  'scribble',
  'other',
] as const satisfies readonly StrokeClass[];

/** The organ whose colour stands for a class. */
export const LOOKS: Record<StrokeClass, string> = {
  axis: 'branch',
  blade: 'leaf',
  corolla: 'petal',
  disc: 'disc',
  vein: 'vein',
  fruit: 'fruit',
  trunk_outline: 'trunk',
  crown: 'leaf_contour',
  pot: 'ignored',
  ground: 'ignored',
  scribble: 'ignored',
  other: 'ignored',
};
