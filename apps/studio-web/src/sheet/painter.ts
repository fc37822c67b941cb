/** The pictures of the sheet: paper, photograph and strokes below, what is under the hand above. */
import { inkOf } from '../drawing/colours';
import type { PhotoState, StrokeMode } from '../wire';
import type { Frame } from './frame';
import { type Box, toDrawing, toScreen, type Viewport } from './geometry';
import {
  drawFrame,
  drawGrid,
  drawLasso,
  drawLine,
  drawRing,
  drawSymmetry,
  INK,
  LEAST_INK,
  type Line,
  lineThrough,
} from './ink';
import { meeting } from './snap';
import { reaches, THICKEST } from './stale';
import type { Stroke, Strokes } from './strokes';
import type { Symmetry } from './symmetry';
import { type Inked, shownOf, type UnderPen } from './underpen';

/** How strong a stroke is drawn that may be something else. */
const DOUBT = 0.45;
/** Dashes and gaps of a stroke that is no part of the plant, pixels. */
const LEFT_DASH = [3, 6];
/** How near an end comes to what is drawn to meet it, pixels. */
export const MEETS = 8;

/** What is under the hand. */
export interface UnderHand {
  /** A stroke that is drawn, or was lifted and is not in the document yet. */
  readonly live: { readonly inked: Inked; readonly mode: StrokeMode } | undefined;
  readonly drawn: UnderPen | undefined;
  readonly lasso: [number, number][] | undefined;
  readonly band: { readonly from: [number, number]; readonly to: [number, number] } | undefined;
  /** Strokes that the eraser has met. */
  readonly erased: ReadonlySet<number> | undefined;
  /** Round what is chosen, where handles are shown. */
  readonly frame: Frame | undefined;
}

/** What the sheet shows. */
export interface Shown {
  readonly view: Viewport;
  readonly strokes: Strokes;
  readonly photo: PhotoState | null;
  readonly image: ImageBitmap | undefined;
  readonly symmetry: Symmetry | undefined;
  readonly meets: boolean;
  readonly hand: UnderHand;
}

export class Painter {
  readonly base = document.createElement('canvas');
  readonly top = document.createElement('canvas');
  dark = false;
  /** Lines have the colours of their pens, and not of what they were understood as. */
  ownColours = false;
  /** The pen that is held: colour, and width in pixels. */
  pen: { color: string | null; width: number | null } = { color: null, width: null };
  /** What the stroke that is drawn is understood as. */
  draftOrgan: string | undefined;
  /** Width and height, pixels. */
  private room: [number, number] = [1, 1];

  constructor(private readonly shown: Shown) {}

  private get view(): Viewport {
    return this.shown.view;
  }

  resize(w: number, h: number): void {
    this.room = [w, h];
    const ratio = Math.min(3, devicePixelRatio || 1);
    for (const canvas of [this.base, this.top]) {
      canvas.width = Math.max(1, Math.round(w * ratio));
      canvas.height = Math.max(1, Math.round(h * ratio));
    }
  }

  /** The part of the drawing that is seen. */
  get seen(): Box {
    const [left, top] = toDrawing(this.view, 0, 0);
    const [right, bottom] = toDrawing(this.view, ...this.room);
    return { left, top, right, bottom };
  }

  private penOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D | undefined {
    const c = canvas.getContext('2d');
    if (!c) return undefined;
    const ratio = canvas.width / Math.max(1, this.room[0]);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.lineCap = 'round';
    c.lineJoin = 'round';
    return c;
  }

  drawBase(stale: Box | 'all'): void {
    const c = this.penOf(this.base);
    if (!c) return;
    c.save();
    const part = stale === 'all' ? undefined : this.clip(c, stale);
    c.clearRect(0, 0, ...this.room);
    this.under(c);
    drawGrid(c, this.view, part ?? this.seen, this.dark);
    const gone = this.shown.hand.erased;
    for (const s of this.shown.strokes.order) {
      if (part && !reaches(s.box, part, THICKEST * (this.wideOf(s) / this.view.scale))) continue;
      c.globalAlpha = gone?.has(s.id) ? 0.15 : s.doubtful ? DOUBT : 1;
      this.inkStroke(c, s);
    }
    c.restore();
  }

  /** Lets only the pixels round a part of the drawing be drawn; the part that they are. */
  private clip(c: CanvasRenderingContext2D, part: Box): Box {
    const ratio = c.getTransform().a;
    // Of a line as wide as the sheet's, and whole pixels.
    const around = THICKEST * INK + 2;
    const [left, top] = toScreen(this.view, part.left, part.top);
    const [right, bottom] = toScreen(this.view, part.right, part.bottom);
    const low = (at: number): number => Math.floor((at - around) * ratio) / ratio;
    const high = (at: number): number => Math.ceil((at + around) * ratio) / ratio;
    const [x0, y0, x1, y1] = [low(left), low(top), high(right), high(bottom)];
    c.beginPath();
    c.rect(x0, y0, x1 - x0, y1 - y0);
    c.clip();
    // A dot of the paper, too, may reach in from outside.
    const [x, y] = toDrawing(this.view, x0 - 2, y1 + 2);
    const [far, up] = toDrawing(this.view, x1 + 2, y0 - 2);
    return { left: x, bottom: y, right: far, top: up };
  }

  drawTop(): void {
    const c = this.penOf(this.top);
    if (!c) return;
    c.clearRect(0, 0, ...this.room);
    const { strokes, hand } = this.shown;
    const { live, drawn, lasso, band, frame } = hand;
    // A layer that was only cleared may be shown with its old picture by browsers that draw without a graphics card.
    const is = live || strokes.selection.size > 0 || band || lasso;
    this.top.style.visibility = is ? 'visible' : 'hidden';
    for (const s of strokes.chosen) {
      c.globalAlpha = 0.3;
      drawLine(
        c,
        this.view,
        lineThrough(s.points, 3, this.view.scale, false),
        this.accent,
        8 + this.lineOf(s).wide,
      );
      c.globalAlpha = 1;
      this.inkStroke(c, s);
    }
    // While it is dragged, the strokes show what comes of it.
    if (frame) drawFrame(c, frame, [this.accent, this.dark ? '#20261f' : '#ffffff']);
    if (live) {
      const { inked: ink, mode } = live;
      const inked = (samples: Float64Array): void =>
        this.ink(
          c,
          lineThrough(samples, 4, this.view.scale, mode === 'parts', this.pen.width ?? INK),
          mode,
          this.draftOrgan,
          this.pen.color ?? undefined,
        );
      const { samples, copies } = shownOf(ink);
      inked(samples);
      c.globalAlpha = 0.55;
      for (const copy of copies) inked(copy);
      c.globalAlpha = 1;
    }
    if (drawn) this.drawMeeting(c, drawn);
    if (lasso) drawLasso(c, lasso, this.accent);
    if (band) {
      const { from, to } = band;
      c.strokeStyle = this.accent;
      c.setLineDash([5, 4]);
      c.strokeRect(
        Math.min(from[0], to[0]),
        Math.min(from[1], to[1]),
        Math.abs(to[0] - from[0]),
        Math.abs(to[1] - from[1]),
      );
      c.setLineDash([]);
    }
  }

  /** A ring where the end of the stroke would meet what is drawn. */
  private drawMeeting(c: CanvasRenderingContext2D, { pen, isFigure, isDot }: UnderPen): void {
    if (!this.shown.meets || isFigure || isDot) return;
    const [x, y] = pen.row(pen.length - 1);
    const at = meeting(this.shown.strokes.order, [x, y], MEETS / this.view.scale);
    if (at) drawRing(c, toScreen(this.view, ...at), MEETS, this.accent);
  }

  private get accent(): string {
    return this.dark ? '#8ecbff' : '#1769aa';
  }

  /** The photograph and the line of symmetry. */
  private under(c: CanvasRenderingContext2D): void {
    const { photo: p, image, symmetry } = this.shown;
    if (p && image) {
      const { opacity, width } = p.place;
      const [x, y] = toScreen(this.view, p.place.x, p.place.y + p.height);
      c.globalAlpha = opacity;
      c.imageSmoothingQuality = 'high';
      c.drawImage(image, x, y, width * this.view.scale, p.height * this.view.scale);
      c.globalAlpha = 1;
    }
    if (symmetry) drawSymmetry(c, this.view, symmetry, this.room, this.accent);
  }

  /** A stroke of the drawing; what is no part of the plant is dashed. */
  private inkStroke(c: CanvasRenderingContext2D, s: Stroke): void {
    if (!s.left) {
      this.ink(c, this.lineOf(s), s.mode, s.organ, s.color);
      return;
    }
    c.setLineDash(LEFT_DASH);
    const line = lineThrough(s.points, 3, this.view.scale, false, this.wideOf(s));
    drawLine(c, this.view, line, inkOf('ignored', this.dark), line.wide);
    c.setLineDash([]);
  }

  private ink(
    c: CanvasRenderingContext2D,
    line: Line,
    mode: StrokeMode,
    organ?: string,
    color?: string,
  ): void {
    const fallback =
      mode === 'branch-contour' ? 'twig_contour' : mode === 'leaf-contour' ? 'leaf_contour' : undefined;
    if (mode !== 'parts') c.setLineDash([9, 7]);
    const own = this.ownColours ? color : undefined;
    drawLine(c, this.view, line, own ?? inkOf(organ ?? fallback, this.dark), line.wide);
    c.setLineDash([]);
  }

  /** Pixels; a wide pen is as wide as it is in the drawing, but never so thin that it is not seen. */
  private wideOf(s: Stroke): number {
    return s.width === undefined ? INK : Math.max(LEAST_INK, s.width * this.view.scale);
  }

  /** The line of a stroke at the sheet's scale; made again only when that changes. */
  private lineOf(s: Stroke): Line {
    if (s.line?.scale !== this.view.scale)
      s.line = {
        ...lineThrough(s.points, 3, this.view.scale, s.mode === 'parts', this.wideOf(s)),
        scale: this.view.scale,
      };
    return s.line;
  }
}
