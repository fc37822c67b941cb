/** The list of the scene's plants: choose, name, hide, copy, delete, place; and the way to add another. */
import type { Command, DocumentState, MakerWord, PlantCommand, PlantState, SceneView } from '../wire';
import { plantName } from '../keeping/names';
import { t, tell, type TextKey } from '../text';
import { askName, button, closePopover, el, icon, popover, refill, relabel } from '../page/ui';

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
  /** These plants are chosen together. */
  chose(plants: readonly number[]): void;
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
  private plants: readonly PlantState[] = [];
  /** What is chosen: the current plant, and others beside it. */
  private selected = new Set<number>();
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

  /** The plants that are chosen, in the order of the list. */
  get chosen(): PlantState[] {
    return this.plants.filter((p) => this.selected.has(p.id));
  }

  /** Chooses plants, and no others; the first of them is the current one if it was not among them. */
  choose(plants: readonly number[]): void {
    this.selected = new Set(plants);
    const first = plants[0];
    if (first === undefined || plants.includes(this.current?.id ?? first)) this.again();
    else this.events.select(first);
  }

  /** Chooses a plant beside the others, or no longer. */
  chooseToo(plant: number): void {
    const others = [...this.selected].filter((id) => id !== plant);
    if (!this.selected.has(plant)) this.choose([...others, plant]);
    else if (others.length > 0) this.choose(others);
  }

  /** Chooses all plants from the current one to this. */
  private chooseTo(plant: number): void {
    const row = (id: number | undefined): number => this.plants.findIndex((p) => p.id === id);
    const [from, to] = [row(this.current?.id), row(plant)].sort((a, b) => a - b) as [number, number];
    this.choose([...this.selected, ...this.plants.slice(Math.max(0, from), to + 1).map((p) => p.id)]);
  }

  /** Makes the chosen plants a group. */
  group(): void {
    if (this.chosen.length < 2) return;
    const taken = new Set(this.plants.map((p) => p.group));
    const names = Array.from({ length: taken.size + 1 }, (_, k) => t('scene.group.name', { number: k + 1 }));
    this.into(this.chosen, names.find((name) => !taken.has(name))!);
  }

  /** Takes the chosen plants out of their groups. */
  ungroup(): void {
    this.into(this.chosen, '');
  }

  private into(plants: readonly PlantState[], group: string): void {
    const others = plants.filter((p) => p.group !== group);
    this.opened.add(group);
    this.each('group', others, { group });
  }

  /** Asks several plants the same, as one step. */
  private each(name: string, plants: readonly PlantState[], command: PlantCommand): void {
    const commands = plants.map((p): Command => ({ plant: [p.id, command] }));
    if (commands.length === 1) this.events.run(commands[0]!);
    else if (commands.length > 1) this.events.together(name, commands);
  }

  private remove(plants: readonly PlantState[]): void {
    this.events.run({ scene: { remove: plants.map((p) => p.id) } });
  }

  private spacingOf(p: PlantState): number {
    if (this.spacing?.plant === p.id) return this.spacing.metres;
    const wide = this.events.width(p.id);
    return wide > 0 ? Math.max(0.01, Number(wide.toPrecision(2))) : 1;
  }

  show(state: DocumentState, view: SceneView | undefined): void {
    this.element.setAttribute('aria-label', t('scene.title'));
    this.plants = state.plants;
    this.current = state.plants.find((p) => p.id === state.current);
    this.selected = new Set(this.chosen.map((p) => p.id));
    // What became the current one by other ways is chosen alone.
    if (state.current !== null && !this.selected.has(state.current)) this.selected = new Set([state.current]);
    this.events.chose([...this.selected]);
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
      const { current, chosen } = this;
      if (chosen.length > 1) content.push(this.placingAll(chosen));
      else if (current && (state.plants.length > 1 || current.maker !== 'sketch'))
        content.push(this.placing(current));
    }
    refill(this.element, 'data-key', () => {
      while (this.head.nextSibling) this.head.nextSibling.remove();
      this.element.append(...content);
    });
  }

  /** Only its head is shown. */
  get isFolded(): boolean {
    return this.element.classList.contains('folded');
  }

  get gizmo(): Gizmo | undefined {
    return this.mode;
  }

  /** A row a plant; a group has one, below which its plants are listed where it is unfolded. */
  private rows(state: DocumentState, view: SceneView | undefined): HTMLElement[] {
    const groups = new Map<string, PlantState[]>();
    for (const p of state.plants) {
      // Plants of no group stand where they came in.
      const key = p.group === '' ? String(p.id) : `g${p.group}`;
      groups.set(key, [...(groups.get(key) ?? []), p]);
    }
    return [...groups.values()].flatMap((plants) => {
      const { group } = plants[0]!;
      if (group === '') return plants.map((p) => this.row(p, state, view));
      const shown = this.opened.has(group) ? plants : plants.filter((p) => p.id === state.current);
      return [this.groupRow(group, plants), ...shown.map((p) => this.row(p, state, view))];
    });
  }

  private groupRow(name: string, plants: readonly PlantState[]): HTMLElement {
    const open = this.opened.has(name);
    const ids = plants.map((p) => p.id);
    const turn = (): void => {
      this.opened[open ? 'delete' : 'add'](name);
      this.again();
    };
    const twist = button(open ? 'folds' : 'unfolds', t(open ? 'scene.fold' : 'scene.unfold', { name }), turn);
    twist.setAttribute('data-key', `gt${name}`);
    twist.setAttribute('aria-expanded', String(open));
    const row = el(
      'button',
      {
        type: 'button',
        class: 'plant group',
        'data-key': `f${name}`,
        'aria-pressed': String(ids.every((id) => this.selected.has(id))),
        onclick: (e) => {
          const { ctrlKey, metaKey, shiftKey } = e as MouseEvent;
          this.choose(ctrlKey || metaKey || shiftKey ? [...this.selected, ...ids] : ids);
        },
        ondblclick: () => this.renameGroup(plants),
        onkeydown: (e) => this.key(e as KeyboardEvent, plants),
      },
      el('span', {}, t('scene.group', { name, count: plants.length })),
    );
    const hidden = plants.every((p) => p.hidden);
    const eye = button(hidden ? 'hidden' : 'eye', t(hidden ? 'scene.show' : 'scene.hide', { name }), () => {
      this.each(
        'hide',
        plants.filter((p) => p.hidden === hidden),
        { hide: !hidden },
      );
    });
    eye.setAttribute('data-key', `ge${name}`);
    const fixed = plants.every((p) => p.fixed);
    const more = button('more', t('scene.more', { name }), () => {
      popover(
        more,
        el(
          'div',
          { class: 'menu' },
          item('scene.rename', () => this.renameGroup(plants)),
          item('scene.duplicate', () => this.duplicate(plants)),
          item(fixed ? 'scene.free' : 'scene.fix', () => this.fix(plants, !fixed)),
          item('scene.ungroup', () => this.into(plants, '')),
          item('scene.delete', () => this.remove(plants), 'danger'),
        ),
        name,
      );
    });
    more.setAttribute('data-key', `gm${name}`);
    return el('li', { class: hidden ? 'is-hidden' : '' }, twist, row, eye, more);
  }

  private row(p: PlantState, state: DocumentState, view: SceneView | undefined): HTMLElement {
    const seen = view?.plants.find((v) => v.id === p.id);
    const error = seen?.error;
    const called = plantName(p, seen);
    const name = el(
      'button',
      {
        type: 'button',
        class: 'plant',
        'data-key': `p${p.id}`,
        'data-plant': p.maker,
        title: error ? tell(error) : t(`maker.${p.maker}` as TextKey),
        'aria-pressed': String(this.selected.has(p.id)),
        'aria-current': String(p.id === state.current),
        onclick: (e) => {
          const { ctrlKey, metaKey, shiftKey } = e as MouseEvent;
          if (shiftKey) this.chooseTo(p.id);
          else if (ctrlKey || metaKey) this.chooseToo(p.id);
          else this.choose([p.id]);
        },
        ondblclick: () => this.rename(p),
        onkeydown: (e) => this.key(e as KeyboardEvent, [p]),
      },
      icon(error ? 'warning' : p.maker),
      el('span', {}, called),
    );
    const eye = button(
      p.hidden ? 'hidden' : 'eye',
      t(p.hidden ? 'scene.show' : 'scene.hide', { name: called }),
      () => this.events.run({ plant: [p.id, { hide: !p.hidden }] }),
    );
    eye.setAttribute('data-key', `e${p.id}`);
    const more = button('more', t('scene.more', { name: called }), () => this.openMore(more, p));
    more.id = `b-more-${p.id}`;
    more.setAttribute('data-key', `m${p.id}`);
    const states = [...(p.hidden ? ['is-hidden'] : []), ...(p.group === '' ? [] : ['in-group'])];
    return el('li', { class: states.join(' ') }, name, eye, more);
  }

  /** Arrows go from row to row; `of`: the plants of the row. */
  private key(e: KeyboardEvent, of: readonly PlantState[]): void {
    const by = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    const rows = [...this.element.querySelectorAll<HTMLElement>('.plant')];
    const to = by && rows[rows.indexOf(e.currentTarget as HTMLElement) + by];
    const group = (e.currentTarget as HTMLElement).matches('.group');
    const act = to
      ? () => {
          to.focus();
          if (e.shiftKey) to.dispatchEvent(new MouseEvent('click', { ctrlKey: true, bubbles: true }));
        }
      : e.key === 'F2'
        ? () => (group ? this.renameGroup(of) : this.rename(of[0]!))
        : e.key === 'Delete'
          ? () => this.remove(this.meant(of))
          : undefined;
    if (!act) return;
    e.preventDefault();
    e.stopPropagation();
    act();
  }

  /** Those of a row, or all that are chosen if they are among them. */
  private meant(of: readonly PlantState[]): readonly PlantState[] {
    return of.every((p) => this.selected.has(p.id)) ? this.chosen : of;
  }

  /** Beside them, so that crowns touch. */
  duplicate(plants: readonly PlantState[] = this.chosen): void {
    const [one] = plants;
    if (!one) return;
    const places = plants.map((p) => p.position[0]);
    const wide = Math.max(...plants.map((p) => this.events.width(p.id))) || ASIDE;
    const aside = Math.round((Math.max(...places) - Math.min(...places) + wide) * 100) / 100;
    const ids = plants.map((p) => p.id);
    this.events.run({
      scene:
        plants.length === 1
          ? { duplicate: [one.id, [aside, 0, 0]] }
          : { 'duplicate-all': [ids, [aside, 0, 0]] },
    });
  }

  private rename(p: PlantState): void {
    askName(t('scene.rename'), t('scene.name'), p.name, (name) =>
      this.events.run({ plant: [p.id, { rename: name }] }),
    );
  }

  private renameGroup(plants: readonly PlantState[]): void {
    askName(t('scene.rename'), t('scene.group.title'), plants[0]!.group, (name) => this.into(plants, name));
  }

  private fix(plants: readonly PlantState[], fixed: boolean): void {
    if (fixed) this.take(undefined);
    this.each(
      'fix',
      plants.filter((p) => p.fixed !== fixed),
      { fix: fixed },
    );
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
    const chosen = this.selected.has(p.id);
    const alone = chosen && this.selected.size === 1;
    const meant = this.meant([p]);
    popover(
      anchor,
      el(
        'div',
        { class: 'menu' },
        item('scene.rename', () => this.rename(p)),
        item('scene.duplicate', () => this.duplicate(meant)),
        // For fingers, which hold no key meanwhile.
        ...(alone ? [] : [item(chosen ? 'scene.unchoose' : 'scene.choose', () => this.chooseToo(p.id))]),
        ...(meant.length > 1 ? [item('scene.group.make', () => this.group())] : []),
        ...(p.group === '' ? [] : [item('scene.group.leave', () => this.into(meant, ''))]),
        ...(p.maker === 'sketch' ? [item('scene.split', () => this.events.split(p.id))] : []),
        item('scene.delete', () => this.remove(meant), 'danger'),
      ),
      p.name,
    );
  }

  private gizmoButton(name: Gizmo, off: boolean): HTMLElement {
    const act = (): void => this.take(this.mode === name ? undefined : name);
    const b = button(name, t(`place.${name}` as TextKey), act, GIZMO_KEYS[name]);
    b.setAttribute('data-gizmo', name);
    b.setAttribute('data-key', `g${name}`);
    b.setAttribute('aria-pressed', String(this.mode === name));
    b.disabled = off;
    return b;
  }

  /** What moves them, which of them it moves, and whether it may. */
  private gizmos(plants: readonly PlantState[]): HTMLElement {
    const off = plants.some((p) => p.fixed);
    const modes = (['translate', 'rotate', 'scale'] as const).map((name) => this.gizmoButton(name, off));
    return el('div', { class: 'chips' }, ...modes, this.snapChip(), this.fixButton(plants));
  }

  /** Gizmos for several plants, and what can be done with all of them. */
  private placingAll(plants: readonly PlantState[]): HTMLElement {
    const act = (key: TextKey, run: () => void, keys?: string): HTMLElement =>
      el(
        'button',
        { type: 'button', class: 'chip', 'data-key': key, onclick: run, title: keys ?? '' },
        t(key),
      );
    const grouped = plants.some((p) => p.group !== '');
    const one = grouped && plants.every((p) => p.group === plants[0]!.group);
    return el(
      'div',
      { class: 'placing' },
      el('span', { class: 'muted' }, t('scene.chosen', { count: plants.length })),
      this.gizmos(plants),
      this.placeBoxes(plants),
      el(
        'div',
        { class: 'chips' },
        ...(one ? [] : [act('scene.group.make', () => this.group(), 'Ctrl+G')]),
        ...(grouped ? [act('scene.ungroup', () => this.ungroup(), 'Ctrl+Shift+G')] : []),
        act('scene.duplicate', () => this.duplicate(plants)),
        act('scene.delete', () => this.remove(plants)),
      ),
    );
  }

  /** Gizmos, and the same as numbers. */
  private placing(p: PlantState): HTMLElement {
    return el(
      'div',
      { class: 'placing' },
      this.gizmos([p]),
      this.placeBoxes([p]),
      el('span', { class: 'muted' }, t('scatter.title')),
      el('div', { class: 'chips' }, ...PATTERNS.map((pattern) => this.patternChip(p, pattern))),
      el(
        'div',
        { class: 'numbers' },
        numberBox(t('scatter.spacing'), 'spacing', [this.spacingOf(p)], (v) => {
          if (v > 0) this.spacing = { plant: p.id, metres: v };
        }),
        numberBox(t('scatter.kinds'), 'kinds', [this.copies.kinds], (v) => {
          this.copies.kinds = Math.min(200, Math.max(0, Math.round(v)));
        }),
      ),
    );
  }

  /** Where plants stand, as numbers; what is set is set of all of them. */
  private placeBoxes(plants: readonly PlantState[]): HTMLElement {
    const off = plants.some((p) => p.fixed);
    type Place = Pick<PlantState, 'position' | 'yaw_deg' | 'scale'>;
    const box = (
      label: TextKey,
      key: string,
      of: (p: PlantState) => number,
      change: (p: PlantState, to: number) => Partial<Place>,
    ): HTMLElement => {
      const act = (to: number): void => {
        const commands = plants.map((p): Command => {
          const { position, yaw_deg, scale } = { ...p, ...change(p, to) };
          return { plant: [p.id, { place: { position, yaw_deg, scale } }] };
        });
        if (commands.length === 1) this.events.run(commands[0]!);
        else this.events.together('place', commands);
      };
      return numberBox(t(label), key, plants.map(of), act, off);
    };
    return el(
      'div',
      { class: 'numbers' },
      box(
        'place.x',
        'x',
        (p) => p.position[0],
        ({ position: [, y, z] }, x) => ({ position: [x, y, z] }),
      ),
      box(
        'place.z',
        'z',
        (p) => p.position[2],
        ({ position: [x, y] }, z) => ({ position: [x, y, z] }),
      ),
      box(
        'place.yaw',
        'yaw',
        (p) => p.yaw_deg,
        (_, yaw_deg) => ({ yaw_deg }),
      ),
      box(
        'place.scale.short',
        'scale',
        (p) => p.scale,
        (_, scale) => ({ scale }),
      ),
    );
  }

  /** Their places are kept, whatever is dragged. */
  private fixButton(plants: readonly PlantState[]): HTMLElement {
    const fixed = plants.some((p) => p.fixed);
    const text = t(fixed ? 'place.free' : 'place.fix');
    const b = button(fixed ? 'lock' : 'unlock', text, () => this.fix(plants, !fixed));
    b.id = 'b-fix';
    b.setAttribute('data-key', 'fix');
    b.setAttribute('aria-pressed', String(fixed));
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

/** A number with its name; of several that are not the same it says so. */
function numberBox(
  label: string,
  key: string,
  values: readonly number[],
  act: (x: number) => void,
  off = false,
): HTMLElement {
  const input = el('input', {
    type: 'number',
    step: key === 'yaw' ? '5' : '0.1',
    class: 'f-number',
    'data-key': `n${key}`,
    onchange: () => {
      if (Number.isFinite(input.valueAsNumber)) act(input.valueAsNumber);
    },
  });
  const [first = 0] = values;
  if (values.every((x) => x === first)) input.value = String(Math.round(first * 1000) / 1000);
  else input.placeholder = t('mixed');
  input.disabled = off;
  return el('label', {}, el('span', {}, label), input);
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
