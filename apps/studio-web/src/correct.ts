/** The card beside a selected stroke: what it was understood as, and one click to say what it is. */
import { inkOf } from './colours';
import type { PlantView, SketchCommand, SketchState, StrokeClass } from './wire';
import { t, tOf } from './text';
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
const MODES = ['parts', 'branch-contour', 'leaf-contour'] as const;

export class Card {
  readonly element = el('div', { class: 'card', role: 'group' });

  constructor(private readonly run: (command: SketchCommand) => void) {
    this.hide();
  }

  hide(): void {
    this.element.hidden = true;
  }

  show(
    ids: number[],
    anchor: { x: number; y: number },
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
    const title = chosen.length === 1 ? t('correct.title') : t('correct.many', { count: chosen.length });
    const erase = el(
      'button',
      { type: 'button', class: 'chip danger', onclick: () => this.run({ 'remove-strokes': ids }) },
      t('correct.erase'),
    );
    this.element.setAttribute('aria-label', title);
    const content: HTMLElement[] = [el('strong', {}, title)];
    if (was) content.push(el('span', { class: 'muted' }, was));
    const fills = set === null || set === undefined;
    const buttons = (): HTMLButtonElement[] => [...this.element.querySelectorAll('button')];
    const focused = buttons().indexOf(document.activeElement as HTMLButtonElement);
    this.element.replaceChildren(...content, chips, ...(fills ? [modes] : []), erase);
    this.element.hidden = false;
    // The same button stays under the keys although it is another element.
    if (focused >= 0) buttons()[focused]?.focus();
    this.place(anchor);
  }

  private place(anchor: { x: number; y: number }): void {
    const host = this.element.parentElement;
    if (!host) return;
    const { offsetWidth: w, offsetHeight: h } = this.element;
    const x = anchor.x + 22 + w > host.clientWidth ? host.clientWidth - w - 10 : anchor.x + 22;
    const y = Math.min(Math.max(10, anchor.y - h / 2), host.clientHeight - h - 10);
    this.element.style.left = `${Math.max(64, x)}px`;
    this.element.style.top = `${Math.max(10, y)}px`;
  }
}

export function dot(organ: string, dark: boolean): HTMLElement {
  const d = el('i', { class: 'dot' });
  d.style.background = inkOf(organ, dark);
  return d;
}
