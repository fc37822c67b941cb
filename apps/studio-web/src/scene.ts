/** The list of the scene's plants: choose, name, hide, copy, delete, place; and the way to add another. */
import type { Command, DocumentState, MakerWord, PlantState, SceneView } from './wire';
import { t, tell, type TextKey } from './text';
import { askName, button, closePopover, el, icon, popover, relabel } from './ui';

export type Gizmo = 'translate' | 'rotate' | 'scale';

/** How copies are drawn on the ground. */
export type Pattern = 'line' | 'area' | 'brush';

export interface Wish {
  readonly pattern: Pattern;
  /** Between any two plants, metres. */
  readonly spacing: number;
}

export interface SceneEvents {
  run(command: Command): void;
  select(plant: number): void;
  add(maker: MakerWord): void;
  /** Puts the plants of a drawing in its place. */
  split(plant: number): void;
  gizmo(mode: Gizmo | undefined): void;
  /** Whether the gizmo goes by steps. */
  snap(on: boolean): void;
  /** How wide the crown of a plant is, metres. */
  width(plant: number): number;
  /** Copies are to be drawn on the ground, or no longer. */
  scatter(wish: Wish | undefined): void;
  /** Several commands as one step of undo of this name. */
  together(name: string, commands: readonly Command[]): void;
}

const MAKERS: readonly MakerWord[] = ['sketch', 'tree', 'leaf', 'flower'];
/** A copy stands beside its plant, metres, if it is not known how wide that is. */
const ASIDE = 0.5;
/** So many plants of one name are a group. */
const GROUP = 3;
const GIZMO_KEYS: Record<Gizmo, string> = { translate: 'G', rotate: 'R', scale: 'S' };
const PATTERNS: readonly Pattern[] = ['line', 'area', 'brush'];

export class SceneList {
  readonly element = el('aside', { class: 'scene' });
  private mode: Gizmo | undefined;
  /** As the person set it; by itself it is folded while there is one plant. */
  private folds: boolean | undefined;
  /** Groups whose plants are listed. */
  private readonly opened = new Set<string>();
  private snaps = false;
  /** How copies are scattered; the spacing is the crown's until a person sets it, of each plant anew. */
  private readonly copies = { kinds: 3, vary: 0.15 };
  private spacing: { plant: number; metres: number } | undefined;
  private pattern: Pattern | undefined;
  private current: PlantState | undefined;
  private again: () => void = () => {};

  private readonly fold = el('button', { type: 'button', class: 'fold', 'data-key': 'fold' });
  private readonly adder = button('plus', t('scene.add'), () => this.openAdd(this.adder));
  private readonly head = el('div', { class: 'scene-head' }, this.fold, this.adder);

  constructor(private readonly events: SceneEvents) {
    this.adder.id = 'b-add';
    this.adder.setAttribute('data-key', 'add');
    this.element.append(this.head);
  }

  /** Takes a gizmo, or lays it down. */
  take(mode: Gizmo | undefined): void {
    this.mode = mode;
    this.events.gizmo(mode);
    for (const other of this.element.querySelectorAll('[data-gizmo]'))
      other.setAttribute('aria-pressed', String(other.getAttribute('data-gizmo') === mode));
  }

  /** How the copies of the chosen plant are to be. */
  get scattering(): { spacing_m: number; kinds: number; vary: number } {
    return { spacing_m: this.current ? this.spacingOf(this.current) : 1, ...this.copies };
  }

  /** The pen was laid down. */
  scattered(): void {
    this.pattern = undefined;
    this.again();
  }

  private spacingOf(p: PlantState): number {
    if (this.spacing?.plant === p.id) return this.spacing.metres;
    const wide = this.events.width(p.id);
    return wide > 0 ? Math.max(0.01, Number(wide.toPrecision(2))) : 1;
  }

  show(state: DocumentState, view: SceneView | undefined): void {
    const focused = this.element.contains(document.activeElement)
      ? document.activeElement?.getAttribute('data-key')
      : null;
    this.element.setAttribute('aria-label', t('scene.title'));
    this.current = state.plants.find((p) => p.id === state.current);
    this.again = () => this.show(state, view);
    const rows = this.rows(state, view);
    const folded = this.folds ?? state.plants.length === 1;
    this.element.classList.toggle('folded', folded);
    // The head stays what it is: a button that is replaced between press and release is not clicked.
    this.fold.setAttribute('aria-expanded', String(!folded));
    this.fold.onclick = () => {
      this.folds = !folded;
      this.show(state, view);
    };
    this.fold.replaceChildren(
      icon('scene'),
      t('scene.title'),
      el('span', { class: 'muted' }, String(state.plants.length)),
    );
    relabel(this.adder, t('scene.add'));
    const content: HTMLElement[] = [];
    if (!folded) {
      content.push(el('ul', { class: 'plants' }, ...rows));
      const { current } = this;
      if (current && (state.plants.length > 1 || current.maker !== 'sketch'))
        content.push(this.placing(current));
    }
    while (this.head.nextSibling) this.head.nextSibling.remove();
    this.element.append(...content);
    if (focused)
      this.element
        .querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)
        ?.focus({ preventScroll: true });
  }

  /** Only its head is shown. */
  get isFolded(): boolean {
    return this.element.classList.contains('folded');
  }

  get gizmo(): Gizmo | undefined {
    return this.mode;
  }

  /** A row a plant; plants of one name and maker are a group, which is folded. */
  private rows(state: DocumentState, view: SceneView | undefined): HTMLElement[] {
    const groups = new Map<string, PlantState[]>();
    for (const p of state.plants) {
      const key = `${p.maker} ${p.name}`;
      groups.set(key, [...(groups.get(key) ?? []), p]);
    }
    return [...groups].flatMap(([key, plants]) => {
      if (plants.length < GROUP) return plants.map((p) => this.row(p, state, view));
      const open = this.opened.has(key);
      const shown = open ? plants : plants.filter((p) => p.id === state.current);
      return [this.groupRow(key, plants, open), ...shown.map((p) => this.row(p, state, view))];
    });
  }

  private groupRow(key: string, plants: readonly PlantState[], open: boolean): HTMLElement {
    const name = plants[0]!.name;
    const fold = el(
      'button',
      {
        type: 'button',
        class: 'plant group',
        'data-key': `f${key}`,
        'aria-expanded': String(open),
        onclick: () => {
          if (open) this.opened.delete(key);
          else this.opened.add(key);
          this.again();
        },
        onkeydown: (e) => this.key(e as KeyboardEvent),
      },
      icon(plants[0]!.maker),
      el('span', {}, t('scene.group', { name, count: plants.length })),
    );
    const hidden = plants.every((p) => p.hidden);
    const eye = button(hidden ? 'hidden' : 'eye', t(hidden ? 'scene.show' : 'scene.hide', { name }), () =>
      this.events.together(
        'hide',
        plants.filter((p) => p.hidden === hidden).map((p) => ({ plant: [p.id, { hide: !hidden }] })),
      ),
    );
    eye.setAttribute('data-key', `ge${key}`);
    const more = button('more', t('scene.more', { name }), () => {
      popover(
        more,
        el(
          'div',
          { class: 'menu' },
          item('scene.rename', () => this.rename(plants)),
          item(
            'scene.delete',
            () => this.events.run({ scene: { remove: plants.map((p) => p.id) } }),
            'danger',
          ),
        ),
        name,
      );
    });
    more.setAttribute('data-key', `gm${key}`);
    return el('li', { class: hidden ? 'is-hidden' : '' }, fold, eye, more);
  }

  private row(p: PlantState, state: DocumentState, view: SceneView | undefined): HTMLElement {
    const error = view?.plants.find((v) => v.id === p.id)?.error;
    const name = el(
      'button',
      {
        type: 'button',
        class: 'plant',
        'data-key': `p${p.id}`,
        'data-plant': p.maker,
        title: error ? tell(error) : t(`maker.${p.maker}` as TextKey),
        'aria-pressed': String(p.id === state.current),
        onclick: () => this.events.select(p.id),
        ondblclick: () => this.rename([p]),
        onkeydown: (e) => this.key(e as KeyboardEvent, p),
      },
      icon(error ? 'warning' : p.maker),
      el('span', {}, p.name),
    );
    const eye = button(
      p.hidden ? 'hidden' : 'eye',
      t(p.hidden ? 'scene.show' : 'scene.hide', { name: p.name }),
      () => this.events.run({ plant: [p.id, { hide: !p.hidden }] }),
    );
    eye.setAttribute('data-key', `e${p.id}`);
    const more = button('more', t('scene.more', { name: p.name }), () => this.openMore(more, p));
    more.id = `b-more-${p.id}`;
    more.setAttribute('data-key', `m${p.id}`);
    return el('li', { class: p.hidden ? 'is-hidden' : '' }, name, eye, more);
  }

  /** Arrows go from row to row; `p`: the plant of a row that is no group. */
  private key(e: KeyboardEvent, p?: PlantState): void {
    const by = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    const rows = [...this.element.querySelectorAll<HTMLElement>('.plant')];
    const to = by && rows[rows.indexOf(e.currentTarget as HTMLElement) + by];
    const act = to
      ? () => to.focus()
      : p && e.key === 'F2'
        ? () => this.rename([p])
        : p && e.key === 'Delete'
          ? () => this.events.run({ scene: { remove: [p.id] } })
          : undefined;
    if (!act) return;
    e.preventDefault();
    e.stopPropagation();
    act();
  }

  /** Beside it, so that their crowns touch. */
  private duplicate(p: PlantState): void {
    const aside = this.events.width(p.id) || ASIDE;
    this.events.run({ scene: { duplicate: [p.id, [Math.round(aside * 100) / 100, 0, 0]] } });
  }

  /** The plants of a group have one name. */
  private rename(plants: readonly PlantState[]): void {
    askName(t('scene.rename'), t('scene.name'), plants[0]!.name, (name) => {
      const commands = plants.map((p): Command => ({ plant: [p.id, { rename: name }] }));
      if (commands.length === 1) this.events.run(commands[0]!);
      else this.events.together('rename', commands);
    });
  }

  openAdd(anchor: HTMLElement): void {
    const menu = el('div', { class: 'menu add' });
    for (const maker of MAKERS) {
      menu.append(
        el(
          'button',
          {
            type: 'button',
            'data-add': maker,
            onclick: () => {
              closePopover();
              this.events.add(maker);
            },
          },
          icon(maker),
          el(
            'span',
            {},
            el('b', {}, t(`maker.${maker}` as TextKey)),
            el('span', { class: 'muted' }, t(`maker.${maker}.hint` as TextKey)),
          ),
        ),
      );
    }
    popover(anchor, menu, t('scene.add'));
  }

  private openMore(anchor: HTMLElement, p: PlantState): void {
    popover(
      anchor,
      el(
        'div',
        { class: 'menu' },
        item('scene.rename', () => this.rename([p])),
        item('scene.duplicate', () => this.duplicate(p)),
        ...(p.maker === 'sketch' ? [item('scene.split', () => this.events.split(p.id))] : []),
        item('scene.delete', () => this.events.run({ scene: { remove: [p.id] } }), 'danger'),
      ),
      p.name,
    );
  }

  /** Gizmos, and the same as numbers. */
  private placing(p: PlantState): HTMLElement {
    const mode = (name: Gizmo): HTMLElement => {
      const act = (): void => this.take(this.mode === name ? undefined : name);
      const b = button(name, t(`place.${name}` as TextKey), act, GIZMO_KEYS[name]);
      b.setAttribute('data-gizmo', name);
      b.setAttribute('data-key', `g${name}`);
      b.setAttribute('aria-pressed', String(this.mode === name));
      b.disabled = p.fixed;
      return b;
    };
    const place = (change: Partial<Pick<PlantState, 'position' | 'yaw_deg' | 'scale'>>): void => {
      const { position, yaw_deg, scale } = { ...p, ...change };
      this.events.run({ plant: [p.id, { place: { position, yaw_deg, scale } }] });
    };
    const box = (
      label: string,
      key: string,
      value: number,
      act: (x: number) => void,
      off = false,
    ): HTMLElement => {
      const input = el('input', {
        type: 'number',
        step: key === 'yaw' ? '5' : '0.1',
        class: 'f-number',
        'data-key': `n${key}`,
        onchange: () => {
          if (Number.isFinite(input.valueAsNumber)) act(input.valueAsNumber);
        },
      });
      input.value = String(Math.round(value * 1000) / 1000);
      input.disabled = off;
      return el('label', {}, el('span', {}, label), input);
    };
    const [x, y, z] = p.position;
    return el(
      'div',
      { class: 'placing' },
      el(
        'div',
        { class: 'chips' },
        mode('translate'),
        mode('rotate'),
        mode('scale'),
        this.snapChip(),
        this.fixButton(p),
      ),
      el(
        'div',
        { class: 'numbers' },
        box(t('place.x'), 'x', x, (v) => place({ position: [v, y, z] }), p.fixed),
        box(t('place.z'), 'z', z, (v) => place({ position: [x, y, v] }), p.fixed),
        box(t('place.yaw'), 'yaw', p.yaw_deg, (v) => place({ yaw_deg: v }), p.fixed),
        box(t('place.scale.short'), 'scale', p.scale, (v) => place({ scale: v }), p.fixed),
      ),
      el('span', { class: 'muted' }, t('scatter.title')),
      el('div', { class: 'chips' }, ...PATTERNS.map((pattern) => this.patternChip(p, pattern))),
      el(
        'div',
        { class: 'numbers' },
        box(t('scatter.spacing'), 'spacing', this.spacingOf(p), (v) => {
          if (v > 0) this.spacing = { plant: p.id, metres: v };
        }),
        box(t('scatter.kinds'), 'kinds', this.copies.kinds, (v) => {
          this.copies.kinds = Math.min(200, Math.max(0, Math.round(v)));
        }),
      ),
    );
  }

  /** Its place is kept, whatever is dragged. */
  private fixButton(p: PlantState): HTMLElement {
    const text = t(p.fixed ? 'place.free' : 'place.fix');
    const b = button(p.fixed ? 'lock' : 'unlock', text, () => {
      if (!p.fixed) this.take(undefined);
      this.events.run({ plant: [p.id, { fix: !p.fixed }] });
    });
    b.id = 'b-fix';
    b.setAttribute('data-key', 'fix');
    b.setAttribute('aria-pressed', String(p.fixed));
    return b;
  }

  private snapChip(): HTMLElement {
    const chip = el(
      'button',
      {
        type: 'button',
        class: 'chip',
        'data-key': 'snap',
        title: t('place.snap.hint'),
        'aria-pressed': String(this.snaps),
        onclick: () => {
          this.snaps = !this.snaps;
          chip.setAttribute('aria-pressed', String(this.snaps));
          this.events.snap(this.snaps);
        },
      },
      t('place.snap'),
    );
    return chip;
  }

  private patternChip(p: PlantState, pattern: Pattern): HTMLElement {
    return el(
      'button',
      {
        type: 'button',
        class: 'chip',
        'data-key': `s${pattern}`,
        'data-scatter': pattern,
        'aria-pressed': String(this.pattern === pattern),
        onclick: () => {
          const on = this.pattern !== pattern;
          this.events.scatter(on ? { pattern, spacing: this.spacingOf(p) } : undefined);
          this.pattern = on ? pattern : undefined;
          this.again();
        },
      },
      t(`scatter.${pattern}`),
    );
  }
}

/** A row of a menu, which closes it. */
function item(key: TextKey, act: () => void, kind = ''): HTMLElement {
  return el(
    'button',
    {
      type: 'button',
      class: kind,
      onclick: () => {
        closePopover();
        act();
      },
    },
    t(key),
  );
}
