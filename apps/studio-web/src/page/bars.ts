/** The page: its bars, its two sides and what lies over them. Made anew for another language; nothing is decided here. */
import { type CommandId, commandOf, keyOf, type Page } from './commands';
import { nameButton } from './names';
import { Halves } from './halves';
import { t, type TextKey } from '../text';
import { SHEET_TOOLS } from '../shaping/tools';
import { button, el, icon } from './ui';
import type { IconName } from './icons';

/** The pieces that know how to show themselves. */
export interface Pieces {
  card: HTMLElement;
  panel: HTMLElement;
  list: HTMLElement;
}

type Child = HTMLElement | string;
/** What has a short name, for under its icon. */
type ToolCommand = CommandId &
  (TextKey extends infer K ? (K extends `short.${infer id}` ? id : never) : never);
/** Buttons by their names, which stand in their ids. */
export type Buttons = Map<string, HTMLButtonElement>;

/** What is changed later. */
export interface Parts {
  buttons: Buttons;
  name: HTMLInputElement;
  halves: Halves;
  sheetTools: HTMLElement;
  viewTools: HTMLElement;
  /** What the pen was told to draw, with a cross that takes it back. */
  meant: HTMLButtonElement;
  /** Over an empty sheet. */
  empty: HTMLElement;
  /** In place of the sheet, where there is no plant. */
  noPlant: HTMLElement;
  legend: HTMLElement;
  bloom: HTMLElement;
  maker: HTMLElement;
  stats: HTMLElement;
  /** Over an empty view. */
  grows: HTMLElement;
  /** How large the plant is, beside it. */
  extent: HTMLElement;
  /** Which model is viewed instead of the plant, and how to close it. */
  model: HTMLElement;
  modelName: HTMLElement;
  counts: HTMLElement;
  /** How many warnings the plant has. */
  warned: HTMLButtonElement;
  busy: HTMLElement;
  busyText: HTMLElement;
  /** What is true of the saving. */
  kept: HTMLElement;
  /** Why the document may only be looked at. */
  readonly: HTMLElement;
}

/** Puts the page into `host`. */
export function buildPage(host: HTMLElement, page: Page, pieces: Pieces): Parts {
  const buttons: Buttons = new Map();
  const parts: Omit<Parts, 'halves'> = {
    buttons,
    name: nameField(page),
    sheetTools: sheetTools(buttons, page),
    viewTools: viewTools(buttons, page),
    meant: meantChip(page),
    empty: emptySheet(page),
    noPlant: named(
      'noplant',
      'div',
      { class: 'nothing' },
      el('h1', {}, t('scene.empty')),
      el('p', {}, t('scene.empty.hint')),
    ),
    legend: named('legend', 'div', { class: 'legend', role: 'list', 'aria-label': t('legend.title') }),
    bloom: named('bloom', 'div', { class: 'bloom' }),
    maker: pieces.panel,
    stats: named('statsbox', 'div', { class: 'statsbox' }),
    grows: named('grows', 'p', { class: 'grows' }, t('view.empty')),
    extent: named('extent', 'button', {
      type: 'button',
      class: 'extent',
      title: t('size.set'),
      onclick: () => page.openSize(),
    }),
    model: lookingLine(page),
    modelName: named('looking-name', 'span', {}),
    counts: named('counts', 'span', { class: 'counts' }),
    warned: named('warnings', 'button', {
      type: 'button',
      class: 'link',
      hidden: '',
      onclick: () => page.openWarnings(),
    }),
    busy: named('busy', 'span', { class: 'busy' }),
    busyText: named('busytext', 'span', {}, t('status.loading')),
    kept: named('kept', 'span', { class: 'muted' }),
    readonly: readonlyLine(page),
  };
  pieces.panel.id = 'b-maker';
  parts.model.hidden = true;
  parts.model.prepend(parts.modelName);
  const halves = new Halves(leftSide(page, parts), rightSide(page, pieces, parts), pieces.card);
  host.replaceChildren(
    topBar(buttons, page, parts.name),
    parts.readonly,
    halves.element,
    footer(page, parts),
  );
  return { ...parts, halves };
}

/** An element whose id tests and other programs go by. */
function named<K extends keyof HTMLElementTagNameMap>(
  name: string,
  tag: K,
  attributes: Record<string, string | ((e: Event) => void)>,
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  return el(tag, { id: `b-${name}`, ...attributes }, ...children);
}

const space = (): HTMLElement => el('span', { class: 'space' });
const group = (...children: Child[]): HTMLElement => el('span', { class: 'group' }, ...children);

/** A button of a command, with its name and its key; `name` and `label` where they are not those of the command. */
interface ButtonSpec {
  command: CommandId;
  icon: IconName;
  name?: string;
  label?: TextKey;
}

function labelOf({ command, label }: ButtonSpec): string {
  return t(label ?? commandOf(command).label!);
}

/** A button that is an icon. */
function iconButton(buttons: Buttons, page: Page, spec: ButtonSpec): HTMLButtonElement {
  const act = () => commandOf(spec.command).run(page);
  return keepButton(buttons, spec, button(spec.icon, labelOf(spec), act, keyOf(spec.command)));
}

/** Under the icon its short name. */
function captioned(command: ToolCommand, b: HTMLButtonElement): HTMLButtonElement {
  return nameButton(b, t(`short.${command}`));
}

/** A tool: an icon with its name. */
function toolButton(buttons: Buttons, page: Page, command: ToolCommand, of: IconName): HTMLButtonElement {
  return captioned(command, iconButton(buttons, page, { command, icon: of }));
}

/** A button with its name beside the icon, or under it where there is less room. */
function wideButton(
  buttons: Buttons,
  page: Page,
  spec: ButtonSpec & { command: ToolCommand },
): HTMLButtonElement {
  const label = labelOf(spec);
  const key = keyOf(spec.command);
  const title = key ? `${label}  (${key})` : label;
  const act = () => commandOf(spec.command).run(page);
  const attributes = { type: 'button', class: 'wide', title, 'aria-label': label, onclick: act };
  const b = el('button', attributes, icon(spec.icon), el('span', { class: 'beside' }, label));
  return captioned(spec.command, keepButton(buttons, spec, b));
}

function keepButton(buttons: Buttons, spec: ButtonSpec, b: HTMLButtonElement): HTMLButtonElement {
  const name = spec.name ?? spec.command;
  b.id = `b-${name}`;
  buttons.set(name, b);
  return b;
}

/** Under the bar, while another tab works on the document. */
function readonlyLine(page: Page): HTMLElement {
  const act = (name: string, text: TextKey, run: () => void): HTMLElement =>
    named(name, 'button', { type: 'button', class: 'link', onclick: run }, t(text));
  const line = named(
    'readonly',
    'div',
    { class: 'readonly', role: 'status' },
    el('span', {}, t('readonly.hint')),
    act('takeover', 'readonly.take', () => void page.documents.takeOver()),
    act('readonly-new', 'readonly.new', () => commandOf('new').run(page)),
  );
  line.hidden = true;
  return line;
}

/** Over the view, while a model is viewed instead of the plants. */
function lookingLine(page: Page): HTMLElement {
  const close = () => page.session.act('close-model');
  return named(
    'looking',
    'p',
    { class: 'looking' },
    named(
      'looking-close',
      'button',
      { type: 'button', class: 'chip', onclick: close },
      t('view.model.close'),
    ),
  );
}

function nameField(page: Page): HTMLInputElement {
  const field = named('name', 'input', {
    class: 'name',
    spellcheck: 'false',
    maxlength: '200',
    'aria-label': t('menu.name'),
    title: t('menu.name'),
    onchange: () => {
      const name = field.value.trim();
      if (name) page.session.run({ scene: { rename: name } });
    },
    onkeydown: (e) => {
      if ((e as KeyboardEvent).key === 'Enter') field.blur();
    },
  });
  return field;
}

function topBar(buttons: Buttons, page: Page, name: HTMLInputElement): HTMLElement {
  type Spec = ButtonSpec & { command: ToolCommand };
  const small = (spec: Spec) => captioned(spec.command, iconButton(buttons, page, spec));
  const wide = (spec: Spec) => wideButton(buttons, page, spec);
  const language = { class: 'plain', type: 'button', title: t('menu.language.hint') };
  return el(
    'header',
    { class: 'bar' },
    el(
      'span',
      { class: 'logo' },
      el('img', { src: './icon.svg', alt: '', width: '26', height: '26' }),
      el('b', {}, 'Burgeon'),
    ),
    name,
    group(small({ command: 'undo', icon: 'undo' }), small({ command: 'redo', icon: 'redo' })),
    group(
      small({ command: 'dice', icon: 'dice' }),
      small({ command: 'lock', icon: 'unlock' }),
      small({ command: 'grid', icon: 'grid' }),
      small({ command: 'settings', icon: 'settings' }),
      small({ command: 'materials', icon: 'materials' }),
    ),
    space(),
    group(
      wide({ command: 'documents', icon: 'documents' }),
      wide({ command: 'new', icon: 'fresh', name: 'fresh' }),
      wide({ command: 'samples', icon: 'samples' }),
      wide({ command: 'open', icon: 'open' }),
      wide({ command: 'save', icon: 'save' }),
      wide({ command: 'share', icon: 'share' }),
      wide({ command: 'export', icon: 'export' }),
    ),
    group(
      named(
        'language',
        'button',
        { ...language, onclick: () => commandOf('language').run(page) },
        t('menu.language'),
      ),
      small({ command: 'theme', icon: 'theme' }),
      small({ command: 'palette', icon: 'commands', name: 'commands', label: 'palette.title' }),
      small({ command: 'help', icon: 'help', label: 'menu.help' }),
    ),
  );
}

function sheetTools(buttons: Buttons, page: Page): HTMLElement {
  const small = (command: ToolCommand & IconName) => toolButton(buttons, page, command, command);
  return el(
    'div',
    { class: 'tools', role: 'toolbar', 'aria-orientation': 'vertical' },
    ...SHEET_TOOLS.map(([tool]) => small(tool)),
    el('hr'),
    small('mirror'),
    small('turns'),
    small('pen'),
    small('layers'),
    small('photo'),
    small('fit'),
  );
}

function viewTools(buttons: Buttons, page: Page): HTMLElement {
  const small = (command: ToolCommand, of: IconName) => toolButton(buttons, page, command, of);
  return el(
    'div',
    { class: 'tools right-tools', role: 'toolbar' },
    small('shape', 'shape'),
    el('hr'),
    small('front', 'front'),
    small('frame', 'fit'),
    small('wire', 'wire'),
    small('skeleton', 'skeleton'),
    small('stats', 'stats'),
    small('light', 'light'),
    el('hr'),
    small('stage', 'sun'),
    small('camera', 'camera'),
    small('film', 'picture'),
    small('export-view', 'preview'),
    small('headset', 'headset'),
  );
}

function meantChip(page: Page): HTMLButtonElement {
  const act = () => page.mean(null);
  return named('meant', 'button', { type: 'button', class: 'chip meant', hidden: '', onclick: act });
}

function emptySheet(page: Page): HTMLElement {
  const samples = () => commandOf('samples').run(page);
  return named(
    'empty',
    'div',
    { class: 'empty' },
    el('h1', {}, t('sheet.empty')),
    el('p', {}, t('sheet.empty.hint')),
    el('button', { type: 'button', class: 'link', onclick: samples }, t('sheet.empty.sample')),
  );
}

function leftSide(page: Page, parts: Omit<Parts, 'halves'>): HTMLElement {
  const sheet = page.sheet.element;
  const { sheetTools, empty, meant, legend, bloom, maker, noPlant } = parts;
  return el('section', { class: 'left' }, sheet, sheetTools, empty, meant, legend, bloom, maker, noPlant);
}

function rightSide(page: Page, pieces: Pieces, parts: Omit<Parts, 'halves'>): HTMLElement {
  const { view, shaping, balls, pen } = page;
  const shown =
    view && shaping
      ? [
          view.element,
          parts.extent,
          page.typing.element,
          shaping.overlay.element,
          ...(balls ? [balls.overlay.element] : []),
          ...(pen ? [pen.element] : []),
          parts.viewTools,
          shaping.element,
        ]
      : [el('p', { class: 'nogl' }, t('note.nowebgl'))];
  // The scene and the edits by hand, in the view's corner.
  const column = el('div', { class: 'column' }, pieces.list, ...(shaping ? [shaping.edits.element] : []));
  return el('section', { class: 'right' }, ...shown, parts.stats, column, parts.grows, parts.model);
}

function footer(page: Page, { counts, warned, busy, busyText, kept }: Omit<Parts, 'halves'>): HTMLElement {
  const stop = () => page.session.engine.interrupt();
  const cancel = el('button', { type: 'button', class: 'link', onclick: stop }, t('status.cancel'));
  busy.append(el('i'), busyText, cancel);
  return el('footer', { class: 'foot' }, counts, warned, space(), busy, kept);
}
