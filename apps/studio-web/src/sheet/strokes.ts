/** The strokes of a drawing as the sheet knows them: where they lie, what they were understood as, which are chosen. */
import type { StrokePoints } from '../worker/protocol';
import type { SketchState, StrokeMode } from '../wire';
import { type Box, boxOf, distance, lengthWithin, shareWithin, united } from './geometry';
import type { Line } from './ink';
import { both, reaches, roomOf, type Stale } from './stale';

export interface Stroke {
  id: number;
  mode: StrokeMode;
  points: Float64Array;
  box: Box;
  organ: string | undefined;
  /** It may be something else. */
  doubtful: boolean;
  /** Nothing was found for it to be: it is no part of the plant. */
  left: boolean;
  /** Of its pen, where it is not that of the sheet: CSS, units of the drawing. */
  color: string | undefined;
  width: number | undefined;
  /** Its layer is not hidden; it is neither hidden nor locked. */
  seen: boolean;
  free: boolean;
  line: (Line & { scale: number }) | undefined;
}

/** The share of a stroke that a lasso has round it. */
const LASSOED = 0.6;

export class Strokes {
  all: Stroke[] = [];
  /** What is seen of them, from below upwards. */
  order: Stroke[] = [];
  /** Those that are chosen. */
  selection: ReadonlySet<number> = new Set();
  private points = new Map<number, Float64Array>();

  /** Takes the strokes of a document; those that are chosen and have other points than before. */
  set({ strokes, layers }: Pick<SketchState, 'strokes' | 'layers'>, fresh: StrokePoints[]): number[] {
    for (const { id, points } of fresh) this.points.set(id, points);
    const before = new Map(this.all.map((s) => [s.id, s]));
    const there = new Set(strokes.map((s) => s.id));
    for (const id of [...this.points.keys()]) if (!there.has(id)) this.points.delete(id);
    const on = new Map(layers.map((l, row) => [l.name, { ...l, row }]));
    const rows = new Map<number, number>();
    const changed: number[] = [];
    this.all = strokes.flatMap(({ id, mode, color, width, layer }) => {
      const points = this.points.get(id);
      const box = points && boxOf(points, 3);
      if (!points || !box) return [];
      const known = before.get(id);
      if (known?.points !== points && this.selection.has(id)) changed.push(id);
      const same = known?.points === points && known.mode === mode && known.width === (width ?? undefined);
      const own = layer === null ? undefined : on.get(layer);
      rows.set(id, own?.row ?? -1);
      const seen = !own?.hidden;
      return [
        {
          id,
          mode,
          points,
          box,
          organ: known?.organ,
          doubtful: known?.doubtful ?? false,
          left: known?.left ?? false,
          color: color ? `rgb(${color.join(' ')})` : undefined,
          width: width ?? undefined,
          seen,
          free: seen && !own?.locked,
          line: same ? known.line : undefined,
        },
      ];
    });
    this.order = this.all.filter((s) => s.seen).sort((a, b) => rows.get(a.id)! - rows.get(b.id)!);
    return changed;
  }

  /** What each row of the document was understood as; the part of the sheet that shows it. */
  setOrgans(organs: Map<number, string>, doubtful: ReadonlySet<number>, left: ReadonlySet<number>): Stale {
    let changed: Stale;
    this.all.forEach((s, row) => {
      if (s.organ !== organs.get(row) || s.doubtful !== doubtful.has(row) || s.left !== left.has(row))
        changed = both(changed, roomOf(s));
      [s.organ, s.doubtful, s.left] = [organs.get(row), doubtful.has(row), left.has(row)];
    });
    return changed;
  }

  /** Those that a hand may take: on no layer that is hidden or locked. */
  get free(): Stroke[] {
    return this.all.filter((s) => s.free);
  }

  get chosen(): Stroke[] {
    return this.all.filter((s) => this.selection.has(s.id));
  }

  /** Round what is chosen, in the drawing's unit. */
  get chosenBox(): Box | undefined {
    const [first, ...others] = this.chosen.map((s) => s.box);
    return first && others.reduce(united, first);
  }

  /** How much of what is chosen lies in a box, in the drawing's unit. */
  chosenWithin(box: Box): number {
    return this.chosen.reduce((sum, s) => sum + lengthWithin(s.points, 3, box), 0);
  }

  /** The stroke at a place, at most so far from it. */
  hit([x, y]: readonly [number, number], reach: number): Stroke | undefined {
    let best: Stroke | undefined;
    let least = reach;
    for (const s of this.order) {
      if (!s.free) continue;
      const b = s.box;
      if (x < b.left - reach || x > b.right + reach || y < b.bottom - reach || y > b.top + reach) continue;
      const d = distance(s.points, 3, x, y);
      // The later stroke lies on top.
      if (d <= least) [best, least] = [s, d];
    }
    return best;
  }

  /** Those that lie in a box as a whole. */
  inBand({ left, right, bottom, top }: Box): number[] {
    const inside = this.free.filter(
      ({ box }) => box.left >= left && box.right <= right && box.bottom >= bottom && box.top <= top,
    );
    return inside.map((s) => s.id);
  }

  /** Those that a lasso has round them for the most part. */
  inLasso(outline: [number, number][]): number[] {
    const round = boxOf(Float64Array.from(outline.flat()), 2)!;
    const taken = this.free.filter(
      (s) => reaches(s.box, round, 0) && shareWithin(s.points, 3, outline) >= LASSOED,
    );
    return taken.map((s) => s.id);
  }

  /** The stroke after the chosen one, or before it. */
  next(step: number): number | undefined {
    const { free } = this;
    const n = free.length;
    if (n === 0) return undefined;
    const now = free.findIndex((s) => this.selection.has(s.id));
    return free[now < 0 ? (step > 0 ? 0 : n - 1) : (now + step + n) % n]!.id;
  }
}
