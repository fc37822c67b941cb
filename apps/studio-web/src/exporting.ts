/** The export dialogue: what for, which format, how fine. */
import { type ExportRequest, FORMATS as TABLE, type MakerWord } from './wire';
import { helpOf, t, type TextKey } from './text';
import { dialog, el } from './ui';

/** The word of a format that the core writes. */
export type Written = keyof typeof TABLE;
export type Target = Written | 'png';
export type ExportOptions = Omit<ExportRequest, 'format'>;
export type Room = (typeof TABLE)[Written]['holds'][number];

const WRITTEN = Object.keys(TABLE) as Written[];
/** Formats of models. */
export const MODELS: readonly Written[] = WRITTEN.filter((f) => TABLE[f].kind === 'model');
const DRAWINGS: readonly Target[] = WRITTEN.filter((f) => TABLE[f].kind === 'drawing');
const FORMATS: readonly Target[] = [
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
};

/** The preview holds on to the options: another choice is written into them. */
const last: { format: Target; readonly options: ExportOptions } = { format: 'glb', options: { ...PLAIN } };

function choose(format: Target, options: ExportOptions): void {
  last.format = format;
  Object.assign(last.options, options);
}

/** What was chosen last; the preview of the export and its dialogue share it. */
export function optionsOf(): typeof last {
  if (!isModel(last.format)) last.format = 'glb';
  return last;
}

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
    const oneFile = holds(format, 'levels');
    levels.hidden = !isModel(format);
    levels.querySelector('select')!.value = String(options.levels);
    impostor.hidden = !oneFile;
    files.hidden = !oneFile || (options.levels === 1 && !options.impostor);
    // Joints want files of their own.
    sway.hidden = !holds(format, 'joints') || (!files.hidden && options.one_file);
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
  const formats = FORMATS.filter((f) => !DRAWINGS.includes(f) || kind === 'sketch');
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
    see.hidden = !isModel(format);
    up.hidden = unit.hidden = !holds(format, 'axes');
    wind.hidden = !holds(format, 'wind');
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
        el('span', { class: 'muted' }, aboutOf(f)),
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
