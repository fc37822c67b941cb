/** The export dialogue: what for, which format, how fine. */
import type { ExportFormat, ExportRequest, MakerWord, StructureFormat } from './wire';
import { t, type TextKey } from './text';
import { dialog, el } from './ui';

export type Target = ExportFormat | 'png';
export type ExportOptions = Omit<ExportRequest, 'format'>;
const MODELS = ['glb', 'usda', 'obj', 'ply', 'stl'] as const satisfies readonly Target[];
/** What is written of the structure of plants, and what kind of file that is. */
const STRUCTURES = {
  mtg: { type: 'text/plain', extension: 'mtg' },
  opf: { type: 'application/xml', extension: 'opf' },
  qsm: { type: 'text/csv', extension: 'csv' },
  swc: { type: 'text/plain', extension: 'swc' },
} as const satisfies Record<StructureFormat, { type: string; extension: string }>;
const STRUCTURE_WORDS = Object.keys(STRUCTURES) as StructureFormat[];
const FORMATS: readonly Target[] = [...MODELS, ...STRUCTURE_WORDS, 'png', 'svg', 'json'];
/** Formats with levels of detail. */
export const LEVELS: ReadonlySet<Target> = new Set(MODELS);
const AXES: ReadonlySet<Target> = new Set([...FORMATS.slice(1, MODELS.length), ...STRUCTURE_WORDS]);
/** Formats with room for wind. */
export const WIND: ReadonlySet<Target> = new Set(['glb', 'usda']);
const NAMES: Partial<Record<Target, string>> = { qsm: 'CSV', usda: 'USD' };

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
};

/** The preview holds on to the options: another choice is written into them. */
const last: { format: Target; readonly options: ExportOptions } = { format: 'glb', options: { ...PLAIN } };

function choose(format: Target, options: ExportOptions): void {
  last.format = format;
  Object.assign(last.options, options);
}

/** What was chosen last; the preview of the export and its dialogue share it. */
export function optionsOf(): typeof last {
  if (!LEVELS.has(last.format)) last.format = 'glb';
  return last;
}

/** The type and the extension of a file of structure; none of other formats. */
export function structureFile(format: Target): { type: string; extension: string } | undefined {
  return format in STRUCTURES ? STRUCTURES[format as StructureFormat] : undefined;
}

export const nameOf = (format: Target): string => NAMES[format] ?? format.toUpperCase();

type Choice<T extends string> = readonly (readonly [T, string])[];

function choice<T extends string>(
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

/**
 * How fine a model is written, and in how many files: rows for `options`, of which those are shown that count for a format.
 * `changed`: another is chosen. `id`: before the names of the fields.
 */
export function levelRows(
  options: ExportOptions,
  changed: () => void,
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
      changed();
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
      changed();
    },
    `${id}files`,
  );
  const impostor = tick(options, 'impostor', changed, id);
  const sway = tick(options, 'sway', changed, id);
  const show = (format: Target): void => {
    const glb = format === 'glb';
    levels.hidden = !LEVELS.has(format);
    levels.querySelector('select')!.value = String(options.levels);
    impostor.hidden = !glb;
    files.hidden = !glb || (options.levels === 1 && !options.impostor);
    // Joints want files of their own.
    sway.hidden = !glb || (!files.hidden && options.one_file);
    if (sway.hidden) {
      options.sway = false;
      sway.querySelector('input')!.checked = false;
    }
  };
  return { rows: [levels, impostor, files, sway], show };
}

function tick(
  options: ExportOptions,
  key: 'wind' | 'sway' | 'impostor',
  changed: () => void,
  id: string,
): HTMLLabelElement {
  const box = el('input', {
    type: 'checkbox',
    id: `${id}${key}`,
    onchange: () => {
      options[key] = box.checked;
      changed();
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

/** `several`: there is a scene to choose; `kind`: the maker of the plant that is chosen. */
export function openExport(
  several: boolean,
  kind: MakerWord,
  act: (format: Target, options: ExportOptions) => void,
  look: () => void,
  games: (whole: boolean) => void,
): void {
  let { format, options } = last;
  options = { ...options, whole: several };
  const formats = FORMATS.filter((f) => (f !== 'json' && f !== 'svg') || kind === 'sketch');
  if (!formats.includes(format)) format = 'glb';
  const what = choice(
    'export.what',
    [
      ['scene', t('export.what.scene')],
      ['plant', t('export.what.plant')],
    ],
    'scene',
    (v) => {
      options.whole = v === 'scene';
    },
  );
  what.hidden = !several;
  const up = choice(
    'export.up',
    [
      ['y', '+Y'],
      ['z', '+Z'],
    ],
    options.up,
    (v) => {
      options.up = v;
    },
  );
  const unit = choice(
    'export.unit',
    [
      ['m', 'm'],
      ['cm', 'cm'],
      ['mm', 'mm'],
    ],
    options.unit,
    (v) => {
      options.unit = v;
    },
  );
  const fine = levelRows(options, () => show(), 'b-');
  const wind = tick(options, 'wind', () => show(), 'b-');
  const show = (): void => {
    see.hidden = !LEVELS.has(format);
    up.hidden = unit.hidden = !AXES.has(format);
    wind.hidden = !WIND.has(format);
    fine.show(format);
  };
  const list = el('div', { class: 'formats', role: 'radiogroup', 'aria-label': t('menu.export') });
  for (const f of formats) {
    const radio = el('input', {
      type: 'radio',
      name: 'format',
      value: f,
      'data-format': f,
      onchange: () => {
        format = f;
        show();
      },
    });
    radio.checked = f === format;
    list.append(
      el(
        'label',
        { class: 'format' },
        radio,
        el('b', {}, nameOf(f)),
        el('span', { class: 'muted' }, t(`export.${f}`)),
      ),
    );
  }
  // First the view, then the file.
  const see = el(
    'button',
    {
      type: 'button',
      class: 'link',
      id: 'b-export-look',
      onclick: () => {
        choose(format, options);
        d.close();
        look();
      },
    },
    t('exported.title'),
  );
  const play = el(
    'button',
    {
      type: 'button',
      class: 'chip',
      id: 'b-export-games',
      onclick: () => {
        d.close();
        games(options.whole);
      },
    },
    t('games.title'),
  );
  const go = el('button', { type: 'submit', class: 'primary', id: 'b-export-go' }, t('menu.export'));
  const form = el(
    'form',
    {
      class: 'export',
      onsubmit: (e) => {
        e.preventDefault();
        choose(format, options);
        d.close();
        act(format, { ...options });
      },
    },
    list,
    what,
    ...fine.rows,
    wind,
    up,
    unit,
    el('p', { class: 'muted' }, t('export.note')),
    el('div', { class: 'row' }, see, play, el('span', { class: 'space' }), go),
  );
  const d = dialog(t('export.title'), form);
  show();
  list.querySelector<HTMLInputElement>('input:checked')?.focus();
}
