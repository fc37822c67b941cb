/** The list of the scene's plants: choose, name, hide, copy, delete, place; and the way to add another. */
import type { Command, DocumentState, MakerWord, PlantState, SceneView } from './wire';
import { t, tell, type TextKey } from './text';
import { button, closePopover, dialog, el, icon, popover } from './ui';

export type Gizmo = 'translate' | 'rotate' | 'scale';

export interface SceneEvents {
  run(command: Command): void;
  select(plant: number): void;
  add(maker: MakerWord): void;
  /** Puts the plants of a drawing in its place. */
  split(plant: number): void;
  gizmo(mode: Gizmo | undefined): void;
}

const MAKERS: readonly MakerWord[] = ['sketch', 'tree', 'leaf', 'flower'];
/** A copy stands beside its plant, metres. */
const ASIDE = 0.5;

export class SceneList {
  readonly element = el('aside', { class: 'scene' });
  private mode: Gizmo | undefined;
  /** As the person set it; by itself it is folded while there is one plant. */
  private folds: boolean | undefined;

  constructor(private readonly events: SceneEvents) {}

  show(state: DocumentState, view: SceneView | undefined): void {
    const focused = this.element.contains(document.activeElement)
      ? document.activeElement?.getAttribute('data-key')
      : null;
    this.element.setAttribute('aria-label', t('scene.title'));
    const rows = state.plants.map((p) => this.row(p, state, view));
    const folded = this.folds ?? state.plants.length === 1;
    this.element.classList.toggle('folded', folded);
    const fold = el(
      'button',
      {
        type: 'button',
        class: 'fold',
        'data-key': 'fold',
        'aria-expanded': String(!folded),
        onclick: () => {
          this.folds = !folded;
          this.show(state, view);
        },
      },
      icon('scene'),
      t('scene.title'),
      el('span', { class: 'muted' }, String(state.plants.length)),
    );
    const add = button('plus', t('scene.add'), () => this.openAdd(add));
    add.id = 'b-add';
    add.setAttribute('data-key', 'add');
    const content: HTMLElement[] = [el('div', { class: 'scene-head' }, fold, add)];
    if (!folded) {
      content.push(el('ul', { class: 'plants' }, ...rows));
      const current = state.plants.find((p) => p.id === state.current);
      if (current && (state.plants.length > 1 || current.maker !== 'sketch'))
        content.push(this.placing(current));
    }
    this.element.replaceChildren(...content);
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
        ondblclick: () => this.rename(p),
        onkeydown: (e) => this.key(e as KeyboardEvent, p, state),
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

  private key(e: KeyboardEvent, p: PlantState, state: DocumentState): void {
    const row = state.plants.findIndex((x) => x.id === p.id);
    const to = e.key === 'ArrowDown' ? row + 1 : e.key === 'ArrowUp' ? row - 1 : -1;
    const act = state.plants[to]
      ? () => this.element.querySelector<HTMLElement>(`[data-key="p${state.plants[to]!.id}"]`)?.focus()
      : e.key === 'F2'
        ? () => this.rename(p)
        : e.key === 'Delete'
          ? () => this.events.run({ scene: { remove: [p.id] } })
          : undefined;
    if (!act) return;
    e.preventDefault();
    e.stopPropagation();
    act();
  }

  private rename(p: PlantState): void {
    const field = el('input', { class: 'field', maxlength: '200', 'aria-label': t('scene.name') });
    field.value = p.name;
    const form = el(
      'form',
      {
        onsubmit: (e) => {
          e.preventDefault();
          d.close();
          const name = field.value.trim();
          if (name) this.events.run({ plant: [p.id, { rename: name }] });
        },
      },
      field,
      el(
        'div',
        { class: 'row' },
        el('span', { class: 'space' }),
        el('button', { type: 'submit', class: 'primary' }, t('scene.rename')),
      ),
    );
    const d = dialog(t('scene.rename'), form);
    field.select();
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
    const item = (key: TextKey, act: () => void, kind = ''): HTMLElement =>
      el(
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
    popover(
      anchor,
      el(
        'div',
        { class: 'menu' },
        item('scene.rename', () => this.rename(p)),
        item('scene.duplicate', () => this.events.run({ scene: { duplicate: [p.id, [ASIDE, 0, 0]] } })),
        ...(p.maker === 'sketch' ? [item('scene.split', () => this.events.split(p.id))] : []),
        item('scene.delete', () => this.events.run({ scene: { remove: [p.id] } }), 'danger'),
      ),
      p.name,
    );
  }

  /** Gizmos, and the same as numbers. */
  private placing(p: PlantState): HTMLElement {
    const mode = (name: Gizmo): HTMLElement => {
      const b = button(name, t(`place.${name}` as TextKey), () => {
        this.mode = this.mode === name ? undefined : name;
        this.events.gizmo(this.mode);
        for (const other of this.element.querySelectorAll('[data-gizmo]'))
          other.setAttribute('aria-pressed', String(other.getAttribute('data-gizmo') === this.mode));
      });
      b.setAttribute('data-gizmo', name);
      b.setAttribute('data-key', `g${name}`);
      b.setAttribute('aria-pressed', String(this.mode === name));
      return b;
    };
    const place = (change: Partial<Pick<PlantState, 'position' | 'yaw_deg' | 'scale'>>): void => {
      const { position, yaw_deg, scale } = { ...p, ...change };
      this.events.run({ plant: [p.id, { place: { position, yaw_deg, scale } }] });
    };
    const box = (label: string, key: string, value: number, act: (x: number) => void): HTMLElement => {
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
      return el('label', {}, el('span', {}, label), input);
    };
    const [x, y, z] = p.position;
    return el(
      'div',
      { class: 'placing' },
      el('div', { class: 'chips' }, mode('translate'), mode('rotate'), mode('scale')),
      el(
        'div',
        { class: 'numbers' },
        box(t('place.x'), 'x', x, (v) => place({ position: [v, y, z] })),
        box(t('place.z'), 'z', z, (v) => place({ position: [x, y, v] })),
        box(t('place.yaw'), 'yaw', p.yaw_deg, (v) => place({ yaw_deg: v })),
        box(t('place.scale.short'), 'scale', p.scale, (v) => place({ scale: v })),
      ),
    );
  }
}
