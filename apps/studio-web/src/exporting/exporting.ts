/** What can be chosen of an export: formats, how fine, in how many files. */
import { type ExportRequest, type FoliageStyle, FORMATS as TABLE } from '../wire';
import { helpOf, t, type TextKey } from '../text';
import { el } from '../page/ui';

/** The word of a format that the core writes. */
export type Written = keyof typeof TABLE;
export type Target = Written | 'png';
export type ExportOptions = Omit<ExportRequest, 'format'>;
export type Room = (typeof TABLE)[Written]['holds'][number];

const WRITTEN = Object.keys(TABLE) as Written[];
/** Formats of models. */
export const MODELS: readonly Written[] = WRITTEN.filter((f) => TABLE[f].kind === 'model');
export const DRAWINGS: readonly Target[] = WRITTEN.filter((f) => TABLE[f].kind === 'drawing');
export const FORMATS: readonly Target[] = [
  ...WRITTEN.filter((f) => TABLE[f].kind !== 'drawing'),
  'png',
  ...DRAWINGS,
];
/** Whether a format holds models. */
export const isModel = (format: Target): boolean => format !== 'png' && TABLE[format].kind === 'model';

/** Whether files of a format have room for something. */
export const holds = (format: Target, room: Room): boolean =>
  format !== 'png' && (TABLE[format].holds as readonly Room[]).includes(room);

/** Whether a format is saved as a zip, as it has files beside its own. */
export const isZipped = (format: Target): boolean => format !== 'png' && TABLE[format].zipped;

/** The type and the ending of a format's files. */
export function fileOf(format: Target): { type: string; ending: string } {
  return format === 'png' ? { type: 'image/png', ending: 'png' } : TABLE[format];
}

/** The word of a format as labels have it. */
export const nameOf = (format: Target): string => format.toUpperCase();

/** What a format is, in the current language. */
export const aboutOf = (format: Target): string =>
  format === 'png' ? t('export.png') : helpOf(`format.${format}`, TABLE[format].about);

/** One level as it is shown. */
export const PLAIN: ExportOptions = {
  levels: 1,
  up: 'y',
  unit: 'm',
  whole: false,
  wind: false,
  one_file: false,
  sway: false,
  impostor: false,
  packed: false,
  instances: false,
  foliage: null,
  texture_size: null,
  triangles: null,
  megabytes: null,
  named: false,
  engine: null,
};

export type Choice<T extends string> = readonly (readonly [T, string])[];

export function choice<T extends string>(
  text: TextKey,
  words: Choice<T>,
  value: T,
  set: (v: T) => void,
  id = '',
): HTMLLabelElement {
  const select = el('select', { id, onchange: () => set(select.value as T) });
  for (const [word, label] of words) select.append(el('option', { value: word }, label));
  select.value = value;
  return el('label', { class: 'option' }, el('span', {}, t(text)), select);
}

/** Fields of the options that say how large an export may become; no program wants any of them. */
const SIZES = ['foliage', 'texture_size', 'triangles', 'megabytes'] as const;
type Sizes = Pick<ExportOptions, (typeof SIZES)[number]>;
/** Fields of the options that a person chooses. */
export type OptionKey = Exclude<keyof ExportOptions, 'engine' | 'named' | 'whole'>;

/** How large an export may become. */
export const sizesOf = ({ foliage, texture_size, triangles, megabytes }: ExportOptions): Sizes => ({
  foliage,
  texture_size,
  triangles,
  megabytes,
});

/** How leaves are drawn, in the order of the list. */
const FOLIAGE: readonly FoliageStyle[] = ['outlines', 'cards', 'by-level'];
/** Sides of textures that are offered, pixels. */
const TEXTURE_SIZES: readonly number[] = [128, 256, 512, 1024, 2048];
/** What a budget may be: as the core has it. */
const BUDGETS = {
  triangles: { least: 100, most: 4_000_000_000 },
  megabytes: { least: 0.001, most: 4000 },
} as const;

/** How large a model may become: rows for `options`, folded while nothing of it is chosen. */
function sizeRows(
  options: ExportOptions,
  changed: (key: OptionKey) => void,
  id: string,
): { fold: HTMLDetailsElement; show(format: Target): void } {
  const foliage = choice(
    'export.foliage',
    [['', t('export.foliage.own')], ...FOLIAGE.map((f) => [f, t(`export.foliage.${f}`)] as const)],
    options.foliage ?? '',
    (word) => {
      options.foliage = word === '' ? null : word;
      changed('foliage');
    },
    `${id}foliage`,
  );
  const textures = choice(
    'export.texture_size',
    [['', t('export.texture_size.own')], ...TEXTURE_SIZES.map((n) => [String(n), `${n} px`] as const)],
    String(options.texture_size ?? ''),
    (word) => {
      options.texture_size = word === '' ? null : Number(word);
      changed('texture_size');
    },
    `${id}texture_size`,
  );
  const budgets = (['triangles', 'megabytes'] as const).map((key) => budget(options, key, changed, id));
  const fold = el(
    'details',
    { class: 'sizes', id: `${id}sizes` },
    el('summary', {}, t('export.sizes')),
    foliage,
    textures,
    ...budgets,
    el('p', { class: 'muted' }, t('export.sizes.help')),
  );
  fold.open = SIZES.some((key) => options[key] !== null);
  const show = (format: Target): void => {
    fold.hidden = !isModel(format) || options.engine === 'print';
    foliage.hidden = textures.hidden = !holds(format, 'textures');
    foliage.querySelector('select')!.value = options.foliage ?? '';
    textures.querySelector('select')!.value = String(options.texture_size ?? '');
  };
  return { fold, show };
}

/** A number that an export may not exceed; empty for any. */
function budget(
  options: ExportOptions,
  key: keyof typeof BUDGETS,
  changed: (key: OptionKey) => void,
  id: string,
): HTMLLabelElement {
  const { least, most } = BUDGETS[key];
  const input = el('input', {
    type: 'number',
    id: `${id}${key}`,
    min: String(least),
    max: String(most),
    step: 'any',
    placeholder: t('export.budget.any'),
    onchange: () => {
      const wanted = input.value === '' ? null : Math.min(most, Math.max(least, Number(input.value)));
      options[key] = wanted !== null && key === 'triangles' ? Math.round(wanted) : wanted;
      input.value = String(options[key] ?? '');
      changed(key);
    },
  });
  input.value = String(options[key] ?? '');
  return el('label', { class: 'option' }, el('span', {}, t(`export.budget.${key}`)), input);
}

/**
 * How fine a model is written, and in how many files: rows for `options`, of which those are shown that count for a format.
 * `changed`: another is chosen. `id`: before the names of the fields.
 */
export function levelRows(
  options: ExportOptions,
  changed: (key: OptionKey) => void,
  id: string,
): { rows: HTMLElement[]; show(format: Target): void } {
  const levels = choice(
    'export.levels',
    [
      ['1', t('export.levels.one')],
      ['2', '2'],
      ['3', '3'],
      ['4', '4'],
    ],
    String(options.levels) as '1' | '2' | '3' | '4',
    (v) => {
      options.levels = Number(v);
      changed('levels');
    },
    `${id}levels`,
  );
  const files = choice(
    'export.files',
    [
      ['each', t('export.files.each')],
      ['one', t('export.files.one')],
    ],
    options.one_file ? 'one' : 'each',
    (v) => {
      options.one_file = v === 'one';
      changed('one_file');
    },
    `${id}files`,
  );
  const ticks = (['impostor', 'sway', 'packed', 'instances'] as const).map(
    (key) => [key, tick(options, key, changed, id)] as const,
  );
  const sizes = sizeRows(options, changed, id);
  const rowOf = Object.fromEntries(ticks) as Record<(typeof ticks)[number][0], HTMLLabelElement>;
  const show = (format: Target): void => {
    const oneFile = holds(format, 'levels');
    const printed = options.engine === 'print';
    levels.hidden = !isModel(format) || printed;
    levels.querySelector('select')!.value = String(options.levels);
    rowOf.impostor.hidden = !oneFile;
    files.hidden = !oneFile || (options.levels === 1 && !options.impostor);
    files.querySelector('select')!.value = options.one_file ? 'one' : 'each';
    rowOf.instances.hidden = !holds(format, 'instances');
    // Joints want files of their own.
    rowOf.sway.hidden = !holds(format, 'joints') || options.instances || (!files.hidden && options.one_file);
    if (rowOf.sway.hidden) options.sway = false;
    rowOf.packed.hidden = !holds(format, 'packing') || options.sway;
    sizes.show(format);
    for (const [key, row] of ticks) row.querySelector('input')!.checked = options[key];
  };
  const { impostor, sway, packed, instances } = rowOf;
  return { rows: [levels, impostor, files, sway, packed, instances, sizes.fold], show };
}

export function tick(
  options: ExportOptions,
  key: 'wind' | 'sway' | 'impostor' | 'packed' | 'instances',
  changed: (key: OptionKey) => void,
  id: string,
): HTMLLabelElement {
  const box = el('input', {
    type: 'checkbox',
    id: `${id}${key}`,
    onchange: () => {
      options[key] = box.checked;
      changed(key);
    },
  });
  box.checked = options[key];
  box.style.justifySelf = 'start';
  return el(
    'label',
    { class: 'option', title: t(`export.${key}.help`) },
    el('span', {}, t(`export.${key}`)),
    box,
  );
}
