/** The card beside a selected stroke: what it was understood as, and one click to say what it is. */
import { inkOf } from './colours';
import { cardBeside } from './cardplace';
import type { Frame } from './sheet/frame';
import type { PlantView, SketchCommand, SketchState, StrokeClass } from './wire';
import { t, type TextKey, tOf } from './text';
import { el } from './ui';

const CLASSES: readonly StrokeClass[] = [
  'axis',
  'blade',
  'corolla',
  'disc',
  'vein',
  'fruit',
  'trunk_outline',
  'crown',
  'pot',
  'ground',
  'scribble',
  'other',
];
/** The organ whose colour stands for a class. */
const LOOKS: Record<StrokeClass, string> = {
  axis: 'branch',
  blade: 'leaf',
  corolla: 'petal',
  disc: 'disc',
  vein: 'vein',
  fruit: 'fruit',
  trunk_outline: 'trunk',
  crown: 'leaf_contour',
  pot: 'ignored',
  ground: 'ignored',
  scribble: 'ignored',
  other: 'ignored',
};
/** Between the card and the edge of the sheet, and the room of the tools. Pixels. */
const EDGE = 10;
const TOOLS = 88;
const MODES = ['parts', 'branch-contour', 'leaf-contour'] as const;

/** What is selected, on the screen. */
export interface Selected {
  readonly frame: Frame;
  /** Where it was pressed, in the drawing's unit. */
  readonly pressed: [number, number] | undefined;
  /** How much of it lies in a place of the sheet, pixels. */
  covered(place: Frame): number;
}

export class Card {
  readonly element = el('div', { class: 'card', role: 'group' });

  /** `wear`: opens the materials. */
  constructor(
    private readonly run: (command: SketchCommand) => void,
    private readonly wear: () => void,
  ) {
    this.hide();
  }

  hide(): void {
    this.element.hidden = true;
  }

  show(
    ids: number[],
    selected: Selected,
    state: SketchState,
    view: PlantView | undefined,
    dark: boolean,
  ): void {
    const chosen = state.strokes.filter((s) => ids.includes(s.id));
    if (chosen.length === 0) {
      this.hide();
      return;
    }
    const same = <T>(of: (s: (typeof chosen)[number]) => T): T | undefined => {
      const first = of(chosen[0]!);
      return chosen.every((s) => of(s) === first) ? first : undefined;
    };
    const set = same((s) => s.class);
    const mode = same((s) => s.mode);
    const reports = new Map((view?.item?.strokes ?? []).map((s) => [state.strokes[s.index]?.id, s]));
    const report = chosen.length === 1 ? reports.get(chosen[0]!.id) : undefined;
    const was = report
      ? set === null || set === undefined
        ? t('correct.was', {
            organ: tOf('organ', report.organ),
            percent: Math.round(report.confidence * 100),
          })
        : t('correct.set')
      : '';
    const chip = (
      label: string,
      organ: string | undefined,
      on: boolean,
      command: SketchCommand,
    ): HTMLElement => {
      const b = el(
        'button',
        { type: 'button', class: 'chip', 'aria-pressed': String(on), onclick: () => this.run(command) },
        label,
      );
      if (organ) b.prepend(dot(organ, dark));
      return b;
    };
    const chips = el(
      'div',
      { class: 'chips' },
      chip(t('correct.auto'), undefined, set === null, { 'set-class': [ids, null] }),
    );
    for (const c of CLASSES) {
      const believed = set === null && report?.class === c;
      const b = chip(tOf('class', c), LOOKS[c], set === c, { 'set-class': [ids, c] });
      if (believed) b.classList.add('believed');
      chips.append(b);
    }
    const modes = el('div', { class: 'chips' }, el('span', { class: 'muted' }, t('correct.mode')));
    for (const m of MODES)
      modes.append(chip(tOf('correct.mode', m), undefined, mode === m, { 'set-mode': [ids, m] }));
    const act = (key: TextKey, command: SketchCommand, kind = ''): HTMLElement =>
      el('button', { type: 'button', class: `chip${kind}`, onclick: () => this.run(command) }, t(key));
    const all = chosen.map((s) => s.id);
    const acts = el('div', { class: 'chips' }, act('correct.smooth', { 'smooth-strokes': all }));
    if (all.length === 1 && selected.pressed)
      acts.append(act('correct.cut', { 'cut-strokes': [all, selected.pressed] }));
    if (all.length > 1) acts.append(act('correct.join', { 'join-strokes': all }));
    acts.append(
      this.colour(
        all,
        same((s) => hexOf(s.color)),
        chosen.some((s) => s.color !== null),
      ),
      el('button', { type: 'button', class: 'chip', onclick: () => this.wear() }, t('material.title')),
      act('correct.erase', { 'remove-strokes': all }, ' danger'),
    );
    const title = chosen.length === 1 ? t('correct.title') : t('correct.many', { count: chosen.length });
    this.element.setAttribute('aria-label', title);
    const content: HTMLElement[] = [el('strong', {}, title)];
    if (was) content.push(el('span', { class: 'muted' }, was));
    const fills = set === null || set === undefined;
    const buttons = (): HTMLButtonElement[] => [...this.element.querySelectorAll('button')];
    const focused = buttons().indexOf(document.activeElement as HTMLButtonElement);
    this.element.replaceChildren(...content, chips, ...(fills ? [modes] : []), acts);
    this.element.hidden = false;
    // The same button stays under the keys although it is another element.
    if (focused >= 0) buttons()[focused]?.focus();
    this.place(selected);
  }

  /** The colour of what is made of these strokes; "automatic" takes it away. */
  private colour(ids: number[], now: string | undefined, any: boolean): HTMLElement {
    const field = el('input', {
      type: 'color',
      value: now ?? '#7a9a3a',
      'aria-label': t('correct.colour'),
      onchange: () => this.run({ 'set-color': [ids, bytesOf(field.value)] }),
    });
    const label = el('label', { class: 'chip', title: t('correct.colour') }, field, t('correct.colour'));
    if (!any) return label;
    const clear = el(
      'button',
      { type: 'button', class: 'chip', onclick: () => this.run({ 'set-color': [ids, null] }) },
      t('correct.colour.none'),
    );
    return el('span', { class: 'chips' }, label, clear);
  }

  /** Where it covers nothing of what is selected: on the sheet, or else over the view. */
  private place({ frame, covered }: Selected): void {
    const host = this.element.parentElement;
    const [sheet, view] = ['.left', '.right'].map((q) => host?.querySelector<HTMLElement>(q));
    if (!sheet || !view) return;
    const { style, classList } = this.element;
    // Tools along the lower edge, as on a phone, leave the sides free.
    const tools = sheet.querySelector<HTMLElement>('.tools');
    const under = tools && tools.offsetWidth > tools.offsetHeight ? tools.offsetHeight : 0;
    const room: Frame = {
      left: under > 0 ? EDGE : TOOLS,
      right: sheet.clientWidth - EDGE,
      top: EDGE,
      bottom: sheet.clientHeight - EDGE - under,
    };
    classList.remove('along');
    style.removeProperty('max-height');
    const size = { width: this.element.offsetWidth, height: this.element.offsetHeight };
    const spot = cardBeside({ frame, covered }, size, room);
    // As wide as the view, where that lies below.
    const along = !spot && view.offsetTop > 0;
    classList.toggle('along', along);
    style.left = `${spot?.left ?? (along ? EDGE : view.offsetLeft + EDGE)}px`;
    style.top = `${spot?.top ?? view.offsetTop + EDGE}px`;
    style.maxHeight = `${spot ? room.bottom - room.top : view.clientHeight - 2 * EDGE}px`;
  }
}

/** A colour as the browser writes it; empty if there is none. */
function hexOf(color: readonly number[] | null): string | undefined {
  return color ? `#${color.map((byte) => byte.toString(16).padStart(2, '0')).join('')}` : undefined;
}

function bytesOf(hex: string): [number, number, number] {
  return [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16)) as [number, number, number];
}

export function dot(organ: string, dark: boolean): HTMLElement {
  const d = el('i', { class: 'dot' });
  d.style.background = inkOf(organ, dark);
  return d;
}
