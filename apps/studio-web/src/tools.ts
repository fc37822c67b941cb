/** The tools that a hand can hold, on the sheet and in the view, each with the key that takes it up. */
import type { Tool } from './sheet/sheet';
import type { ToolKind } from './wire';

export const SHEET_TOOLS: readonly [Tool, string][] = [
  ['parts', 'P'],
  ['branch-contour', 'B'],
  ['leaf-contour', 'L'],
  ['erase', 'E'],
  ['rub', 'Shift+E'],
  ['select', 'V'],
  ['pull', 'A'],
];

type WordOf<T> = T extends string ? T : keyof T & string;
/** A tool of the view by its word alone, without what it is set to. */
export type ShapeTool = WordOf<ToolKind>;

export const SHAPE_TOOLS: readonly [ShapeTool, string][] = [
  ['pick', '1'],
  ['rotate', '2'],
  ['move', '3'],
  ['copy', '-'],
  ['prune', '4'],
  ['regrow', '5'],
  ['sketch', '6'],
  ['brush', '7'],
  ['silhouette', '8'],
  ['leaves', '9'],
  ['grow', '0'],
];

/** To what bears the branch that a tool points at, and back to the twig. */
export const CLIMB_KEYS = { up: 'Q', down: 'Shift+Q' } as const;
