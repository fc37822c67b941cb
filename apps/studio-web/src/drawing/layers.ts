/** The pen that strokes are drawn with, and the layers that they lie on. */
import type { Session } from '../worker/session';
import { t, type TextKey, tOf } from '../text';
import { askName, button, closePopover, el, icon, refill } from '../page/ui';
import { bytes, type Held, hex } from './pen';
import { CLASSES } from './classes';
import type { Sheet } from '../sheet/sheet';
import { type Symmetry, TURNS } from '../sheet/symmetry';
import type { Layer, StrokeClass, StrokeState } from '../wire';

/** Pixels of the widest pen. */
const WIDEST = 24;
/** The pen that every sheet has, pixels: its place on the slider is the left end. */
const LEAST = 0.5;

export interface LayersEvents {
  session: Session;
  /** The strokes that are chosen on the sheet. */
  chosen(): number[];
  held: Held;
  /** Units of the drawing to a pixel. */
  unit(): number;
  /** The pen was changed. */
  changed(): void;
  /** Says what the pen draws. */
  mean(kind: StrokeClass | null): void;
  /** Selects strokes. */
  choose(strokes: number[]): void;
  /** A colour is to be taken from the sheet. */
  takeColour(): void;
}

/** The panel of the pen: of the strokes that come, or, while some are chosen, of these. */
export function penPanel(events: LayersEvents): HTMLElement {
  const { session, chosen, held, unit, changed } = events;
  const panel = el('div', { class: 'settings' });
  const strokes = chosen();
  const first = session.drawn?.strokes.find((s) => strokes.includes(s.id));
  const now: Pick<Held, 'color' | 'width'> = first
    ? {
        color: first.color ? hex(first.color) : null,
        width: first.width === null ? null : Number((first.width / unit()).toPrecision(3)),
      }
    : held;
  const shown = el('output', {});
  const wide = (): number | null => (Number(width.value) < LEAST ? null : Number(width.value));
  const width = el('input', {
    type: 'range',
    min: '0',
    max: String(WIDEST),
    step: '0.5',
    id: 'b-pen-width',
    oninput: () => {
      now.width = wide();
      show();
      if (!first) changed();
    },
    onchange: () => {
      const px = wide();
      const units = px === null ? null : Number((px * unit()).toPrecision(4));
      if (first) session.draw({ 'set-width': [strokes, units] });
    },
  });
  const setColor = (to: string | null): void => {
    now.color = to;
    show();
    if (first) session.draw({ 'set-color': [strokes, to === null ? null : bytes(to)] });
    else changed();
  };
  const color = el('input', { type: 'color', id: 'b-pen-colour', onchange: () => setColor(color.value) });
  const clear = el(
    'button',
    { type: 'button', class: 'chip', onclick: () => setColor(null) },
    t('correct.colour.none'),
  );
  const show = (): void => {
    shown.textContent = now.width === null ? t('pen.width.auto') : `${now.width} px`;
    width.value = String(now.width ?? 0);
    color.value = now.color ?? '#7a9a3a';
    color.classList.toggle('unset', now.color === null);
    clear.hidden = now.color === null;
  };
  show();
  panel.append(
    el('p', { class: 'muted' }, t(first ? 'pen.of.chosen' : 'pen.of.next')),
    el('label', {}, el('span', {}, t('pen.width')), width, shown),
    el('label', {}, el('span', {}, t('pen.colour')), color, el('span')),
    el(
      'div',
      { class: 'chips' },
      el(
        'button',
        { type: 'button', class: 'chip', id: 'b-pen-take', onclick: () => events.takeColour() },
        icon('dropper'),
        t('tool.dropper'),
      ),
      clear,
    ),
    el('p', { class: 'muted' }, t('pen.hint')),
    ...(first ? [] : [meaning(held.class, (kind) => events.mean(kind))]),
    ...colourRows(events),
  );
  return panel;
}

/** What the strokes that come are: one of all classes, or what is found out. */
function meaning(now: StrokeClass | null, mean: (kind: StrokeClass | null) => void): HTMLElement {
  const chips = el('div', { class: 'chips', role: 'group', 'aria-label': t('pen.means') });
  const chip = (kind: StrokeClass | null, label: string): void => {
    const take = (): void => {
      mean(kind);
      for (const other of chips.children) other.setAttribute('aria-pressed', String(other === b));
    };
    const pressed = { 'aria-pressed': String(now === kind), 'data-means': kind ?? 'auto' };
    const b = el('button', { type: 'button', class: 'chip', ...pressed, onclick: take }, label);
    chips.append(b);
  };
  chip(null, t('correct.auto'));
  for (const kind of CLASSES) chip(kind, tOf('class', kind));
  return el('div', {}, el('p', { class: 'muted' }, t('pen.means')), chips);
}

/** What strokes of each colour are, where strokes have colours: all of one are told at once. */
function colourRows({ session, choose }: LayersEvents): HTMLElement[] {
  const of = new Map<string, StrokeState[]>();
  for (const s of session.drawn?.strokes ?? [])
    if (s.color) of.set(hex(s.color), [...(of.get(hex(s.color)) ?? []), s]);
  if (of.size === 0) return [];
  const rows = [...of].map(([color, strokes]) => {
    const ids = strokes.map((s) => s.id);
    const first = strokes[0]!.class;
    const mixed = strokes.some((s) => s.class !== first);
    const select = el(
      'select',
      {
        'data-colour': color,
        'aria-label': t('pen.colour.means', { color }),
        onchange: () =>
          session.draw({ 'set-class': [ids, select.value === '' ? null : (select.value as StrokeClass)] }),
      },
      ...(mixed ? [el('option', { value: 'mixed', disabled: '' }, t('mixed'))] : []),
      el('option', { value: '' }, t('correct.auto')),
      ...CLASSES.map((kind) => el('option', { value: kind }, tOf('class', kind))),
    );
    select.value = mixed ? 'mixed' : (first ?? '');
    const label = t('pen.colour.choose', { count: ids.length });
    const pick = { type: 'button', class: 'swatch', title: label, 'aria-label': label };
    const swatch = el('button', { ...pick, onclick: () => choose(ids) });
    swatch.style.background = color;
    return el(
      'div',
      { class: 'colour-row' },
      swatch,
      el('span', { class: 'muted' }, `× ${ids.length}`),
      select,
    );
  });
  return [el('p', { class: 'muted' }, t('pen.colours')), ...rows];
}

/** How often strokes are drawn round a centre, where that is, and how to leave it. `changed`: the symmetry is another. */
export function turnsPanel(sheet: Sheet, changed: () => void): HTMLElement {
  const set = (symmetry: Symmetry | undefined): void => {
    sheet.symmetry = symmetry;
    changed();
  };
  const now = (): Extract<Symmetry, { kind: 'turns' }> | undefined =>
    sheet.symmetry?.kind === 'turns' ? sheet.symmetry : undefined;
  const take = (): void => {
    const turns = now();
    const count = Math.round(Math.min(TURNS.most, Math.max(TURNS.least, number.valueAsNumber)));
    if (turns && Number.isFinite(count)) set({ ...turns, count });
    number.value = String(now()?.count ?? TURNS.first);
  };
  const number = el('input', {
    type: 'number',
    class: 'f-number',
    id: 'b-turns-count',
    min: String(TURNS.least),
    max: String(TURNS.most),
    step: '1',
    onchange: take,
  });
  number.value = String(now()?.count ?? TURNS.first);
  const act = (id: string, text: TextKey, run: () => void): HTMLElement =>
    el(
      'button',
      {
        type: 'button',
        class: 'chip',
        id,
        onclick: () => {
          closePopover();
          run();
        },
      },
      t(text),
    );
  const box = sheet.selectedBox();
  const amid = (): void => {
    const turns = now();
    if (!box || !turns) return;
    set({ ...turns, about: [(box.left + box.right) / 2, (box.bottom + box.top) / 2] });
    sheet.centring = false;
  };
  const put = (): void => {
    sheet.centring = true;
  };
  return el(
    'div',
    { class: 'settings' },
    el('label', {}, el('span', {}, t('turns.count')), number, el('span')),
    el('p', { class: 'muted' }, t('turns.hint')),
    el(
      'div',
      { class: 'chips' },
      act('b-turns-put', 'turns.put', put),
      ...(box ? [act('b-turns-amid', 'turns.amid', amid)] : []),
      act('b-turns-off', 'turns.off', () => set(undefined)),
    ),
  );
}

/** The panel of layers, the uppermost first. */
export class LayersPanel {
  readonly element = el('div', { class: 'settings layers' });

  constructor(private readonly events: LayersEvents) {
    this.show();
  }

  show(): void {
    const { session, held, chosen, changed } = this.events;
    const layers = session.drawn?.layers ?? [];
    const take = (name: string | null): void => {
      held.layer = name;
      changed();
      this.show();
    };
    const row = (name: string | null, label: string, ...more: HTMLElement[]): HTMLElement => {
      const count = session.drawn?.strokes.filter((s) => s.layer === name).length ?? 0;
      const pick = el(
        'button',
        {
          type: 'button',
          class: 'chip layer',
          'data-layer': name ?? '',
          'data-key': `take ${name ?? ''}`,
          'aria-pressed': String(held.layer === name),
          title: t('layer.take'),
          onclick: () => take(name),
        },
        el('span', {}, label),
        el('span', { class: 'muted' }, String(count)),
      );
      return el('li', {}, pick, ...more);
    };
    const rows = layers.map((layer, at) =>
      row(layer.name, layer.name, ...this.tools(layer, at, layers.length)),
    );
    const add = el(
      'button',
      {
        type: 'button',
        class: 'chip',
        id: 'b-layer-add',
        'data-key': 'add',
        onclick: () =>
          askName(t('layer.add'), t('layer.name'), this.freshName(layers), (name) => {
            session.draw({ 'add-layer': name });
            held.layer = name;
            changed();
          }),
      },
      t('layer.add'),
    );
    const put = el(
      'button',
      {
        type: 'button',
        class: 'chip',
        id: 'b-layer-put',
        'data-key': 'put',
        onclick: () => session.draw({ 'put-on': [chosen(), held.layer] }),
      },
      t('layer.put', { name: held.layer ?? t('layer.sheet') }),
    );
    put.hidden = chosen().length === 0;
    refill(this.element, 'data-key', () =>
      this.element.replaceChildren(
        el('ul', { class: 'layer-rows' }, ...rows.reverse(), row(null, t('layer.sheet'))),
        el('div', { class: 'chips' }, add, put),
      ),
    );
  }

  private freshName(layers: readonly Layer[]): string {
    const taken = new Set(layers.map((l) => l.name));
    let k = layers.length + 1;
    while (taken.has(t('layer.nth', { n: String(k) }))) k += 1;
    return t('layer.nth', { n: String(k) });
  }

  private tools(layer: Layer, at: number, count: number): HTMLElement[] {
    const { session, held } = this.events;
    const set = (change: Partial<Layer>): void =>
      session.draw({ 'set-layer': [at, { ...layer, ...change }] });
    const { name } = layer;
    const eye = button(
      layer.hidden ? 'hidden' : 'eye',
      t(layer.hidden ? 'layer.show' : 'layer.hide', { name }),
      () => set({ hidden: !layer.hidden }),
    );
    const lock = button(
      layer.locked ? 'lock' : 'unlock',
      t(layer.locked ? 'layer.unlock' : 'layer.lock', { name }),
      () => set({ locked: !layer.locked }),
    );
    const up = button('up', t('layer.up', { name }), () => session.draw({ 'move-layer': [at, at + 1] }));
    up.disabled = at + 1 >= count;
    const rename = button('parts', t('layer.rename', { name }), () =>
      askName(t('layer.rename.title'), t('layer.name'), name, (to) => {
        if (held.layer === name) held.layer = to;
        set({ name: to });
      }),
    );
    const drop = button('bin', t('layer.remove', { name }), () => {
      if (held.layer === name) held.layer = null;
      session.draw({ 'remove-layer': at });
    });
    const tools = { eye, lock, up, rename, drop };
    for (const [key, b] of Object.entries(tools)) b.setAttribute('data-key', `${key} ${name}`);
    return Object.values(tools);
  }
}
