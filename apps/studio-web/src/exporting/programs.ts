/** Exports for a program: what it wants by the table of the core, and what a person asks for besides. */
import { listOf, t, type TextKey, tOf } from '../text';
import {
  type Engine as Program,
  type EngineAnswer,
  type EngineAsk,
  type EngineSet,
  ENGINES,
  type ModelFormat,
} from '../wire';
import {
  type ExportOptions,
  fileOf,
  isModel,
  type OptionKey,
  PLAIN,
  sizesOf,
  type Target,
} from './exporting';

export type { Program };

/** The programs that plants go to. */
export const PROGRAMS = Object.keys(ENGINES) as Program[];
/** Names that are the same in all languages. */
const NAMES: Partial<Record<Program, string>> = {
  three: 'three.js',
  blender: 'Blender',
  unity: 'Unity',
  unreal: 'Unreal Engine',
  godot: 'Godot',
};
export const nameOfProgram = (program: Program): string => NAMES[program] ?? tOf('engine', program);

/** Whether a program is given files of a format. */
export const isGiven = (program: Program, format: Target): boolean =>
  isModel(format) && (ENGINES[program].endings as readonly string[]).includes(fileOf(format).ending);

/** Options without what only a program wants. */
export const forNoProgram = (options: ExportOptions): ExportOptions => ({
  ...options,
  engine: null,
  named: false,
});

/** What a program was given besides what was asked, in the current language. */
export function saidOf(program: Program, set: readonly EngineSet[]): string {
  const words = set.map(({ name, value }) =>
    t(`engine.set.${name}` as TextKey, { value: name === 'up' ? value.toUpperCase() : value }),
  );
  const name = nameOfProgram(program);
  return words.length === 0 ? t('engine.set.none', { name }) : t('engine.set', { name, set: listOf(words) });
}

/** What a person asked for since the program was chosen. */
type Asked = Partial<Record<OptionKey, number | string | boolean | null>>;

/** What was chosen last, as long as the page is there; the preview of the export holds on to the options. */
const last: { format: Target; readonly options: ExportOptions; asked: Asked } = {
  format: 'glb',
  options: { ...PLAIN },
  asked: {},
};

export function keepChoice(format: Target, options: ExportOptions, asked: Asked): void {
  last.format = format;
  last.asked = asked;
  Object.assign(last.options, options);
}

/** What was chosen last, whatever it is. */
export const lastChoice = (): Readonly<typeof last> => last;

/** What was chosen last of models; the preview of the export and its dialogue share it. */
export function optionsOf(): { format: Target; readonly options: ExportOptions } {
  if (!isModel(last.format)) last.format = 'glb';
  const { options } = last;
  if (options.engine && !isGiven(options.engine, last.format)) Object.assign(options, forNoProgram(options));
  return last;
}

/** What a person may choose for a program. */
const ASKED: readonly OptionKey[] = [
  'levels',
  'up',
  'unit',
  'wind',
  'sway',
  'packed',
  'one_file',
  'impostor',
  'instances',
];

/** An export for a program: what a person asked for since the program was chosen, and what the program was given besides. */
export class ForProgram {
  private turn = 0;
  /** What it was given besides. */
  said = '';
  /** Until the program has answered. */
  pending: Promise<void> = Promise.resolve();

  constructor(
    private readonly options: ExportOptions,
    public asked: Asked,
    private readonly settle: (ask: EngineAsk) => Promise<EngineAnswer>,
    private readonly changed: () => void,
  ) {}

  choose(program: Program | null, format: Target): void {
    this.asked = {};
    Object.assign(this.options, forNoProgram(this.options), { engine: program });
    this.renew(format);
  }

  ask(key: OptionKey, format: Target): void {
    this.asked = { ...this.asked, [key]: this.options[key] };
    this.renew(format);
  }

  renew(format: Target): void {
    const { engine, whole } = this.options;
    const turn = ++this.turn;
    this.said = '';
    this.changed();
    if (!engine) return;
    const open = (key: OptionKey): unknown => this.asked[key] ?? null;
    const chosen = Object.fromEntries(ASKED.map((key) => [key, open(key)]));
    const ask = { engine, format: format as ModelFormat, whole, ...chosen } as EngineAsk;
    this.pending = this.settle(ask).then(
      ({ request: { format: _, ...options }, set }) => {
        if (turn !== this.turn) return;
        Object.assign(this.options, options, sizesOf(this.options), { whole });
        this.said = saidOf(engine, set);
        this.changed();
      },
      (e: Error) => {
        if (turn !== this.turn) return;
        this.said = e.message;
        this.changed();
      },
    );
  }
}
