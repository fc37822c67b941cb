/** The pen that strokes are drawn with, and the layers that they lie on. */
import type { Session } from './session';
import { t } from './text';
import { askName, button, el, refill } from './ui';
import { bytes, type Held, hex } from './pen';
import type { Layer } from './wire';

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
}

/** The panel of the pen: of the strokes that come, or, while some are chosen, of these. */
export function penPanel({ session, chosen, held, unit, changed }: LayersEvents): HTMLElement {
  const panel = el('div', { class: 'settings' });
  const strokes = chosen();
  const first = session.drawn?.strokes.find((s) => strokes.includes(s.id));
  const now: Omit<Held, 'layer'> = first
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
    el('div', { class: 'chips' }, clear),
    el('p', { class: 'muted' }, t('pen.hint')),
  );
  return panel;
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
