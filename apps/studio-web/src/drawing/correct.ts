/** The card beside a selected stroke: what it was understood as, and one click to say what it is. */
import { inkOf } from './colours';
import { cardBeside } from './cardplace';
import { CLASSES, LOOKS } from './classes';
import { isLeft } from './readings';
import { ALIGNMENTS, type Arrangement, DISTRIBUTIONS, fewest } from '../sheet/align';
import type { Frame } from '../sheet/frame';
import type { PlantView, SketchCommand, SketchState } from '../wire';
import { t, type TextKey, tOf } from '../text';
import { button, el } from '../page/ui';

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

export interface CardEvents {
  /** Asked of the drawing. */
  run(command: SketchCommand): void;
  /** The chosen strokes are the outline of one leaf or petal. */
  oneBlade(): void;
  /** Opens the materials. */
  wear(): void;
  /** To the clipboard. */
  copy(): void;
  duplicate(): void;
  arrange(how: Arrangement): void;
  choose(strokes: number[]): void;
}

export class Card {
  readonly element = el('div', { class: 'card', role: 'group' });

  constructor(private readonly events: CardEvents) {
    this.hide();
  }

  private run(command: SketchCommand): void {
    this.events.run(command);
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
    const told = report && {
      organ: tOf('organ', report.organ),
      percent: Math.round(report.confidence * 100),
    };
    const isSet = set !== null && set !== undefined;
    const was = !told
      ? ''
      : isSet
        ? t('correct.set')
        : isLeft(report!)
          ? t('correct.left')
          : t('correct.was', told);
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
    const does = (key: TextKey, run: () => void): HTMLElement =>
      el('button', { type: 'button', class: 'chip', onclick: run }, t(key));
    const acts = el('div', { class: 'chips' }, act('correct.smooth', { 'smooth-strokes': all }));
    if (all.length === 1 && selected.pressed)
      acts.append(act('correct.cut', { 'cut-strokes': [all, selected.pressed] }));
    if (all.length > 1) {
      const one = does('correct.oneblade', () => this.events.oneBlade());
      one.title = t('act.oneblade');
      acts.append(act('correct.join', { 'join-strokes': all }), one);
    }
    acts.append(
      this.colour(
        all,
        same((s) => hexOf(s.color)),
        chosen.some((s) => s.color !== null),
      ),
      ...this.likewise(
        state.strokes,
        all,
        same((s) => hexOf(s.color)),
      ),
      does('material.title', () => this.events.wear()),
      does('correct.duplicate', () => this.events.duplicate()),
      does('correct.copy', () => this.events.copy()),
      act('correct.erase', { 'remove-strokes': all }, ' danger'),
    );
    const title = chosen.length === 1 ? t('correct.title') : t('correct.many', { count: chosen.length });
    this.element.setAttribute('aria-label', title);
    const content: HTMLElement[] = [el('strong', {}, title)];
    if (was) content.push(el('span', { class: 'muted' }, was));
    const fills = set === null || set === undefined;
    const buttons = (): HTMLButtonElement[] => [...this.element.querySelectorAll('button')];
    const focused = buttons().indexOf(document.activeElement as HTMLButtonElement);
    const order = all.length > 1 ? [this.arrangements(all.length)] : [];
    this.element.replaceChildren(...content, chips, ...(fills ? [modes] : []), ...order, acts);
    this.element.hidden = false;
    // The same button stays under the keys although it is another element.
    if (focused >= 0) buttons()[focused]?.focus();
    this.place(selected);
  }

  /** Ways to put several strokes in order. */
  private arrangements(count: number): HTMLElement {
    const ways = [...ALIGNMENTS, ...DISTRIBUTIONS].filter((how) => count >= fewest(how));
    const label = t('arrange.title');
    return el(
      'div',
      { class: 'chips arrange', role: 'group', 'aria-label': label },
      ...ways.map((how) => button(`arrange-${how}`, t(`arrange.${how}`), () => this.events.arrange(how))),
    );
  }

  /** Chooses all strokes of a colour, where there are others of it. */
  private likewise(
    strokes: SketchState['strokes'],
    ids: readonly number[],
    color: string | undefined,
  ): HTMLElement[] {
    if (color === undefined) return [];
    const all = strokes.filter((s) => hexOf(s.color) === color).map((s) => s.id);
    if (all.length <= ids.length) return [];
    const choose = (): void => this.events.choose(all);
    const chip = el('button', { type: 'button', class: 'chip', onclick: choose });
    chip.textContent = t('correct.likewise', { count: all.length });
    return [chip];
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
