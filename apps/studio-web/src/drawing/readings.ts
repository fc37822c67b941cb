/**
 * What the whole drawing was read as, and what else it may show: each one click away. And which strokes the last one
 * turned into something else, with one click that says what they were.
 */
import { DOUBTFUL, type Session } from '../worker/session';
import { number, t, tOf } from '../text';
import { type Seen, type Turned, turnedBy } from './turned';
import { el } from '../page/ui';
import type { Kind, StrokeClass, StrokeReport } from '../wire';

/** What decided the class of a stroke that may be doubted: a rule knows why, a person knows. */
const GUESSES = ['classifier', 'rule:as-shown'];
/** What is rightly no part of a plant. */
const BESIDE: readonly string[] = ['ground', 'scribble'] satisfies StrokeClass[];

/** Whether nothing was found for a stroke to be, and nobody said that it is nothing. */
export const isLeft = (s: StrokeReport): boolean =>
  s.organ === 'ignored' && s.source !== 'user' && !BESIDE.includes(s.class);

export class Readings {
  readonly element = el('div', { class: 'readings', role: 'group' });
  private plant = -1;
  /** What each stroke was shown as, by its number. */
  private before = new Map<number, Seen>();
  /** The strokes that became something else when one was added. */
  private turned: Turned[] = [];

  constructor(
    private readonly session: Session,
    /** Selects strokes. */
    private readonly choose: (strokes: number[]) => void,
  ) {}

  /** The rows of strokes that are no part of the plant although nobody said so. */
  get left(): Set<number> {
    return new Set((this.session.seen?.item?.strokes ?? []).filter(isLeft).map((s) => s.index));
  }

  /** The rows of strokes of which the classifier is hardly sure. */
  get doubtful(): Set<number> {
    const doubt = (this.session.seen?.item?.strokes ?? []).filter(
      (s) => GUESSES.includes(s.source ?? '') && s.organ !== 'ignored' && s.confidence < DOUBTFUL,
    );
    return new Set(doubt.map((s) => s.index));
  }

  /** The plants are made anew, of the document or of it and a stroke under the pen. */
  show(): void {
    const { session } = this;
    const { drawn, seen, plant } = session;
    const rows = seen?.item?.strokes ?? [];
    this.element.hidden = !drawn || drawn.strokes.length === 0;
    if (!drawn || !plant) return;
    // Nothing is decided by what is seen of another time, or with a stroke under the pen.
    const now = session.scene?.revision === session.state?.revision;
    if (now && rows.length === drawn.strokes.length) this.compare(plant.id);
    this.element.setAttribute('aria-label', t('readings.title'));
    const chosen = (drawn.sketch.read_as ?? null) as Kind | null;
    const found = seen?.item?.readings ?? [];
    const kinds = found.filter((r) => r.kind !== 'none').map((r) => r.kind);
    if (chosen && !kinds.includes(chosen)) kinds.unshift(chosen);
    // One reading and no choice says nothing that the plant does not.
    const leftRows = this.left;
    const left = drawn.strokes.filter((_, row) => leftRows.has(row)).map((s) => s.id);
    this.element.hidden =
      kinds.length + (chosen ? 1 : 0) < 2 && this.turned.length === 0 && left.length === 0;
    const chips = kinds.map((kind) => {
      const score = found.find((r) => r.kind === kind)?.score ?? 0;
      const is = chosen ? kind === chosen : kind === found[0]?.kind;
      const percent = t('readings.score', { percent: number(Math.round(100 * score)) });
      return el(
        'button',
        {
          type: 'button',
          class: 'chip',
          'data-reading': kind,
          'aria-pressed': String(is),
          title: `${t('readings.as', { kind: tOf('kind', kind) })} · ${percent}`,
          onclick: () => this.take(kind),
        },
        tOf('kind', kind),
      );
    });
    if (chosen) chips.push(this.chip(t('readings.auto'), t('readings.auto.hint'), () => this.take(null)));
    const focused = this.element.contains(document.activeElement) && document.activeElement;
    const same = focused
      ? chips.find((c) => c.dataset['reading'] === (focused as HTMLElement).dataset['reading'])
      : undefined;
    this.element.replaceChildren(...chips, ...this.back(), ...this.lacking(left));
    same?.focus();
  }

  private chip(label: string, title: string, act: () => void): HTMLButtonElement {
    return el('button', { type: 'button', class: 'chip', title, onclick: act }, label);
  }

  private take(kind: Kind | null): void {
    const { drawn } = this.session;
    if (drawn) this.session.draw({ 'set-sketch': { ...drawn.sketch, read_as: kind } });
  }

  /** What became of the strokes that were there, since the last time. */
  private compare(plant: number): void {
    const { drawn, seen } = this.session;
    const rows = new Map((seen?.item?.strokes ?? []).map((s) => [s.index, s]));
    const now = new Map<number, Seen>();
    drawn?.strokes.forEach(({ id }, row) => {
      const s = rows.get(row);
      if (s) now.set(id, { class: s.class as StrokeClass, organ: s.organ });
    });
    this.turned = plant === this.plant ? turnedBy(this.before, now, this.turned) : [];
    [this.plant, this.before] = [plant, now];
  }

  private back(): HTMLElement[] {
    const [first] = this.turned;
    if (!first) return [];
    const change = { from: tOf('organ', first.from.organ), to: tOf('organ', first.to.organ) };
    const count = number(this.turned.length);
    const b = this.chip(t('readings.turned', { count, ...change }), t('readings.turned.hint'), () =>
      this.restore(),
    );
    b.classList.add('turned');
    return [b];
  }

  /** How many strokes are no part of the plant; a click selects them, to say what they are. */
  private lacking(ids: number[]): HTMLElement[] {
    document.body.dataset['left'] = String(ids.length);
    if (ids.length === 0) return [];
    const b = this.chip(t('readings.left', { count: number(ids.length) }), t('readings.left.hint'), () =>
      this.choose(ids),
    );
    b.classList.add('left-out');
    return [b];
  }

  /** Says of each stroke that it is what it was. */
  private restore(): void {
    const { session, turned } = this;
    const ids = new Map<StrokeClass, number[]>();
    for (const { id, from } of turned) ids.set(from.class, [...(ids.get(from.class) ?? []), id]);
    session.begin('class');
    for (const [kind, strokes] of ids) session.draw({ 'set-class': [strokes, kind] });
    session.commit();
    this.turned = [];
  }
}
