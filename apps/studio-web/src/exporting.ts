/** The export dialogue: what for, which format, how fine. */
import type { ExportFormat, ExportRequest, MakerWord } from './wire';
import { t, type TextKey } from './text';
import { dialog, el } from './ui';

export type Target = ExportFormat | 'png';
export type ExportOptions = Omit<ExportRequest, 'format'>;
const FORMATS: readonly Target[] = [
  'glb',
  'usda',
  'obj',
  'ply',
  'stl',
  'mtg',
  'opf',
  'qsm',
  'png',
  'svg',
  'json',
];
/** Formats with levels of detail. */
export const LEVELS: ReadonlySet<Target> = new Set(['glb', 'usda', 'obj', 'ply', 'stl']);
const AXES: ReadonlySet<Target> = new Set(['usda', 'obj', 'ply', 'stl', 'mtg', 'opf', 'qsm']);
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

let last: { format: Target; options: ExportOptions } = { format: 'glb', options: PLAIN };

/** What was chosen last; the preview of the export and its dialogue share it. */
export function optionsOf(): typeof last {
  if (!LEVELS.has(last.format)) last.format = 'glb';
  return last;
}

export const nameOf = (format: Target): string => NAMES[format] ?? format.toUpperCase();

/** `several`: there is a scene to choose; `kind`: the maker of the plant that is chosen. */
export function openExport(
  several: boolean,
  kind: MakerWord,
  act: (format: Target, options: ExportOptions) => void,
  look: () => void,
): void {
  const choice = <T extends string>(
    text: TextKey,
    words: readonly (readonly [T, string])[],
    value: T,
    set: (v: T) => void,
  ): HTMLLabelElement => {
    const select = el('select', { onchange: () => set(select.value as T) });
    for (const [word, label] of words) select.append(el('option', { value: word }, label));
    select.value = value;
    return el('label', { class: 'option' }, el('span', {}, t(text)), select);
  };
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
      show();
    },
  );
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
  levels.querySelector('select')!.id = 'b-levels';
  const tick = (
    id: string,
    key: 'wind' | 'sway' | 'impostor',
    text: TextKey,
    help: TextKey,
  ): HTMLLabelElement => {
    const box = el('input', {
      type: 'checkbox',
      id,
      onchange: () => {
        options[key] = box.checked;
        show();
      },
    });
    box.checked = options[key];
    box.style.justifySelf = 'start';
    return el('label', { class: 'option', title: t(help) }, el('span', {}, t(text)), box);
  };
  const wind = tick('b-wind', 'wind', 'export.wind', 'export.wind.help');
  const sway = tick('b-sway', 'sway', 'export.sway', 'export.sway.help');
  const impostor = tick('b-impostor', 'impostor', 'export.impostor', 'export.impostor.help');
  const files = choice(
    'export.files',
    [
      ['each', t('export.files.each')],
      ['one', t('export.files.one')],
    ],
    options.one_file ? 'one' : 'each',
    (v) => {
      options.one_file = v === 'one';
      show();
    },
  );
  files.querySelector('select')!.id = 'b-files';
  const show = (): void => {
    levels.hidden = see.hidden = !LEVELS.has(format);
    up.hidden = unit.hidden = !AXES.has(format);
    wind.hidden = !WIND.has(format);
    const glb = format === 'glb';
    impostor.hidden = !glb;
    files.hidden = !glb || (options.levels === 1 && !options.impostor);
    // Joints want files of their own.
    sway.hidden = !glb || (!files.hidden && options.one_file);
    if (sway.hidden) options.sway = false;
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
        last = { format, options };
        d.close();
        look();
      },
    },
    t('exported.title'),
  );
  const go = el('button', { type: 'submit', class: 'primary', id: 'b-export-go' }, t('menu.export'));
  const form = el(
    'form',
    {
      class: 'export',
      onsubmit: (e) => {
        e.preventDefault();
        last = { format, options };
        d.close();
        act(format, { ...options });
      },
    },
    list,
    what,
    levels,
    impostor,
    files,
    wind,
    sway,
    up,
    unit,
    el('p', { class: 'muted' }, t('export.note')),
    el('div', { class: 'row' }, see, el('span', { class: 'space' }), go),
  );
  const d = dialog(t('export.title'), form);
  show();
  list.querySelector<HTMLInputElement>('input:checked')?.focus();
}
