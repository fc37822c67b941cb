/** The tools that a hand can hold, on the sheet and in the view, one row each. What they do is the sheet's and the core's. */
import type { Tool } from '../sheet/sheet';
import type { IconName } from '../page/icons';
import type { ToolKind } from '../wire';

/** Each with the key that takes it up. */
export const SHEET_TOOLS: readonly [Tool, string][] = [
  ['parts', 'P'],
  ['branch-contour', 'B'],
  ['leaf-contour', 'L'],
  ['erase', 'E'],
  ['rub', 'Shift+E'],
  ['select', 'V'],
  ['lasso', 'Shift+V'],
  ['pull', 'A'],
  ['dropper', 'Shift+I'],
];

type WordOf<T> = T extends string ? T : keyof T & string;
/** A tool of the view by its word alone, without what it is set to. */
export type ShapeTool = WordOf<ToolKind>;

/** A number that a tool is set to, within what a hand needs of what the core takes. */
export interface NumberSetting {
  readonly low: number;
  readonly high: number;
  readonly step: number;
  readonly is: number;
  readonly unit?: '°';
  /** In shares of the plant's size, for metres of it; its steps are shares of itself. */
  readonly ofPlant?: true;
  /** What a key of the wrist or a notch of the wheel adds, or by which share of it it grows. */
  readonly notch?: number | { readonly share: number };
}

/** One of two values, by the words of its buttons. */
export interface ChoiceSetting<T extends number | boolean = number | boolean> {
  readonly is: T;
  readonly words: Readonly<Record<string, T>>;
}

/** On or off. */
export interface SwitchSetting {
  readonly is: boolean;
  readonly word: string;
}

export type Setting = NumberSetting | ChoiceSetting | SwitchSetting;

export const isNumber = (s: Setting): s is NumberSetting => 'low' in s;
export const isChoice = (s: Setting): s is ChoiceSetting => 'words' in s;

/** What the core asks of a tool, without what is placed by a gesture. */
type Fields<W extends ShapeTool> =
  Extract<ToolKind, Record<W, unknown>> extends Record<W, infer F> ? F : Record<never, never>;
type Asked<F> = { [K in keyof F as undefined extends F[K] ? never : K]: F[K] };
type SettingsOf<F> = {
  readonly [K in keyof F]-?: F[K] extends boolean
    ? ChoiceSetting<boolean> | SwitchSetting
    : NumberSetting | ChoiceSetting<number>;
};

/** The trace that the pointer leaves: a line, a ring that is as wide as the brush, or an outline that is closed. */
export type Trace = 'line' | 'brush' | 'outline';

export interface ToolRow {
  readonly keys: string;
  readonly icon: IconName;
  /** The edit that it makes, where that is not called as the tool is. */
  readonly edit?: string;
  readonly trace?: Trace;
  /** It means a branch: in a dense crown, what bears the twig under the pointer. */
  readonly climbs?: true;
  /** It chooses a branch and changes nothing. */
  readonly chooses?: true;
  /** What it holds grows by itself, round by round. */
  readonly rounds?: true;
  /** Its settings count at once, also in the middle of a gesture. */
  readonly live?: true;
  /** Both sides of a plane of symmetry can be made at once. */
  readonly mirrors?: true;
  /** The wheel, while something is held: it turns that, or these numbers, the second with Shift. */
  readonly wheel?: 'twist' | readonly [string, string];
  readonly settings: Readonly<Record<string, Setting>>;
}

/** With a setting for each field that the core asks of the tool, and none besides. */
type Row<W extends ShapeTool> = ToolRow & {
  readonly wheel?: 'twist' | readonly [keyof Fields<W>, keyof Fields<W>];
  readonly settings: SettingsOf<Asked<Fields<W>>>;
};

const RADIUS = { low: 0.01, high: 0.4, step: 0.01, is: 0.07, ofPlant: true } as const;
const DENSITY = { low: 0.25, high: 4, step: 0.25, is: 1, notch: { share: 0.4 } } as const;

/** In the order in which they are shown. */
export const SHAPE_TOOLS = {
  pick: { keys: '1', icon: 'select', climbs: true, chooses: true, settings: {} },
  rotate: { keys: '2', icon: 'rotate', climbs: true, wheel: 'twist', settings: {} },
  move: { keys: '3', icon: 'slide', climbs: true, settings: {} },
  copy: { keys: '-', icon: 'copy', climbs: true, settings: {} },
  prune: {
    keys: '4',
    icon: 'prune',
    climbs: true,
    settings: { whole: { is: false, words: { part: false, whole: true } } },
  },
  regrow: { keys: '5', icon: 'regrow', climbs: true, settings: {} },
  sketch: {
    keys: '6',
    icon: 'branch',
    edit: 'sketch-branch',
    trace: 'line',
    mirrors: true,
    wheel: 'twist',
    settings: {
      twigs: { low: 0, high: 4, step: 0.25, is: 1, notch: 0.5 },
      tilt_deg: { low: -75, high: 75, step: 5, is: 0, unit: '°' },
    },
  },
  brush: {
    keys: '7',
    icon: 'brush',
    trace: 'brush',
    live: true,
    mirrors: true,
    settings: { radius_m: RADIUS, density: DENSITY },
  },
  silhouette: {
    keys: '8',
    icon: 'silhouette',
    trace: 'outline',
    mirrors: true,
    settings: { density: DENSITY, trim: { is: false, word: 'trim' } },
  },
  leaves: {
    keys: '9',
    icon: 'leaf',
    edit: 'leaf-density',
    trace: 'brush',
    settings: { keep: { is: 0.25, words: { fewer: 0.25, more: 2 } }, radius_m: RADIUS },
  },
  grow: {
    keys: '0',
    icon: 'tree',
    rounds: true,
    live: true,
    mirrors: true,
    wheel: ['vigour', 'angle_deg'],
    settings: {
      vigour: { low: 0.5, high: 8, step: 0.1, is: 2, notch: { share: 0.12 } },
      apical: { low: 0, high: 1, step: 0.02, is: 0.54, notch: 0.04 },
      angle_deg: { low: 15, high: 110, step: 5, is: 55, unit: '°', notch: 5 },
      lift: { low: -0.6, high: 0.6, step: 0.02, is: 0.12, notch: 0.04 },
      apart: { low: 0, high: 4, step: 0.1, is: 1, notch: 0.2 },
    },
  },
} as const satisfies { readonly [W in ShapeTool]: Row<W> };

export const SHAPE_WORDS = Object.keys(SHAPE_TOOLS) as readonly ShapeTool[];

export const rowOf = (word: ShapeTool): ToolRow => SHAPE_TOOLS[word];

/** It is as wide as it is set to. */
export const isBrush = (word: ShapeTool | undefined): boolean =>
  word !== undefined && 'radius_m' in rowOf(word).settings;

/** The icon of an edit: that of the tool that makes it. */
export function iconOfEdit(op: string): IconName {
  return SHAPE_WORDS.map(rowOf).find((row, i) => (row.edit ?? SHAPE_WORDS[i]) === op)?.icon ?? 'branch';
}

/** To what bears the branch that a tool points at, and back to the twig. */
export const CLIMB_KEYS = { up: 'Q', down: 'Shift+Q' } as const;
