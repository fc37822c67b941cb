/** The sheet: what was drawn, and the tools that change it. It knows nothing of plants. */
import { inkOf } from '../colours';
import type { StrokePoints } from '../protocol';
import type { PhotoState, SketchCommand, SketchState, StrokeMode } from '../wire';
import { dragged, type Frame, frameOf, type Handle, handleAt } from './frame';
import {
  boxOf,
  distance,
  fitted,
  lengthWithin,
  toDrawing,
  toScreen,
  united,
  zoomed,
  type Box,
  type Viewport,
} from './geometry';
import { drawFrame, drawGrid, drawLine, INK, LEAST_INK, type Line, lineThrough } from './ink';
import { Pen } from './pen';
import { both, reaches, roomOf, type Stale, staleOf, THICKEST } from './stale';

export type Tool = StrokeMode | 'erase' | 'rub' | 'select' | 'pull';

export interface SheetEvents {
  /** `mirror`: the same stroke on the other side of the line of symmetry. */
  stroke(mode: StrokeMode, samples: Float64Array, mirror: Float64Array | undefined): void;
  draft(mode: StrokeMode, samples: Float64Array, mirror: Float64Array | undefined): void;
  undraft(): void;
  erase(ids: number[]): void;
  /** A drag that changes strokes or the photograph: what it comes to replaces what it came to before. */
  begin(name: string): void;
  change(command: SketchCommand): void;
  end(keep: boolean): void;
  /** `frame`: round what is selected, pixels. */
  selected(ids: number[], frame: Frame | undefined): void;
  viewport(): void;
}

interface Stroke {
  id: number;
  mode: StrokeMode;
  points: Float64Array;
  box: Box;
  organ: string | undefined;
  /** It may be something else. */
  doubtful: boolean;
  /** Of its pen, where it is not that of the sheet: CSS, units of the drawing. */
  color: string | undefined;
  width: number | undefined;
  /** Its layer is not hidden; it is neither hidden nor locked. */
  seen: boolean;
  free: boolean;
  line: (Line & { scale: number }) | undefined;
}

/** How near a pointer must come to a stroke, in pixels: a fingertip is coarser. */
const REACH = { mouse: 8, pen: 8, touch: 18 } as const;
const reachOf = (type: string): number => REACH[type as keyof typeof REACH] ?? 8;
/** How far along a line a pull at it reaches, pixels. */
const PULL = 90;
/** How strong a stroke is drawn that may be something else. */
const DOUBT = 0.45;
/** A drag begins when the pointer is so far from where it went down, pixels. */
const SLIP = 4;

type Act =
  | { kind: 'draw'; pen: Pen; mode: StrokeMode }
  | { kind: 'erase'; ids: Set<number> }
  | { kind: 'move'; from: [number, number]; moved: boolean }
  | { kind: 'frame'; handle: Handle; box: Box; from: [number, number]; moved: boolean }
  | { kind: 'pull'; id: number; from: [number, number]; moved: boolean }
  | { kind: 'rub'; path: [number, number][]; radius: number }
  | { kind: 'band'; from: [number, number]; to: [number, number]; add: boolean }
  | { kind: 'photo'; place: PhotoState['place']; from: [number, number]; moved: boolean }
  | { kind: 'pan'; x: number; y: number };

export class Sheet {
  readonly element = document.createElement('div');
  private readonly base = document.createElement('canvas');
  private readonly top = document.createElement('canvas');
  private strokes: Stroke[] = [];
  /** What is seen of them, from below upwards. */
  private order: Stroke[] = [];
  private ownColours = false;
  private pen: { color: string | null; width: number | null } = { color: null, width: null };
  private points = new Map<number, Float64Array>();
  private selection = new Set<number>();
  private view: Viewport = { scale: 1, x: 0, y: 0 };
  private tool: Tool = 'parts';
  private dark = false;
  private act: Act | undefined;
  private pointers = new Map<number, [number, number]>();
  private actor = -1;
  private penSeen = false;
  private penDown = false;
  private space = false;
  /** The pointer is over it. */
  private hovered = false;
  /** The focus was moved by keys since something was pressed. */
  private tabbed = false;
  /** Its width and height, pixels. */
  private room: [number, number] = [0, 0];
  private pinch: { distance: number; x: number; y: number } | undefined;
  private draftOrgan: string | undefined;
  /** A stroke that was lifted and is not in the document yet: shown until it is. */
  private pending: { pen: Pen; mode: StrokeMode } | undefined;
  private photo: PhotoState | null = null;
  private image: ImageBitmap | undefined;
  /** Where a stroke was pressed last, in the drawing's unit. */
  pressed: [number, number] | undefined;
  /** Drags move the photograph. */
  placing = false;
  /** The line of symmetry, if there is one: its x in the drawing. */
  private axis: number | undefined;
  /** Strength of the stabiliser, 0 to 3. */
  steady = 1;
  private stale: Stale = 'all';
  private frame = 0;
  private placed = false;

  constructor(
    private readonly events: SheetEvents,
    label: string,
  ) {
    this.element.className = 'sheet';
    this.element.tabIndex = 0;
    this.element.setAttribute('role', 'application');
    this.element.setAttribute('aria-label', label);
    this.element.append(this.base, this.top);
    const on = this.element.addEventListener.bind(this.element);
    on('pointerdown', (e) => this.down(e));
    on('pointermove', (e) => this.move(e));
    on('pointerup', (e) => this.up(e, true));
    on('pointercancel', (e) => this.up(e, false));
    on('wheel', (e) => this.wheel(e), { passive: false });
    on('contextmenu', (e) => e.preventDefault());
    // The click that a browser makes of a tap would press whatever the tap opened under the finger.
    on('touchend', (e) => e.cancelable && e.preventDefault(), { passive: false });
    on('pointerenter', () => {
      this.hovered = true;
    });
    on('pointerleave', () => {
      this.hovered = false;
    });
    document.addEventListener('keydown', (e) => {
      if (e.code === 'Tab') this.tabbed = true;
      if (e.code === 'Space' && this.ownsSpace) this.setSpace(true, e);
    });
    const point = (): void => {
      this.tabbed = false;
    };
    document.addEventListener('pointerdown', point, { capture: true });
    document.addEventListener('keyup', (e) => {
      if (e.code === 'Space' && this.space) this.setSpace(false, e);
    });
    globalThis.addEventListener('blur', () => this.setSpace(false));
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  // What is shown -----------------------------------------------------------------------------------------------

  setState(state: Pick<SketchState, 'strokes' | 'photo' | 'layers'>, fresh: StrokePoints[]): void {
    const [photo, order] = [this.photo, this.order];
    this.photo = state.photo;
    if (!state.photo) this.placing = false;
    for (const { id, points } of fresh) this.points.set(id, points);
    const before = new Map(this.strokes.map((s) => [s.id, s]));
    const there = new Set(state.strokes.map((s) => s.id));
    for (const id of [...this.points.keys()]) if (!there.has(id)) this.points.delete(id);
    const layers = new Map(state.layers.map((l, row) => [l.name, { ...l, row }]));
    const rows = new Map<number, number>();
    this.strokes = state.strokes.flatMap(({ id, mode, color, width, layer }) => {
      const points = this.points.get(id);
      const box = points && boxOf(points, 3);
      if (!points || !box) return [];
      const known = before.get(id);
      // Where it was pressed is no place of what it is now.
      if (known?.points !== points && this.selection.has(id)) this.pressed = undefined;
      const same = known?.points === points && known.mode === mode && known.width === (width ?? undefined);
      const line = same ? known.line : undefined;
      const on = layer === null ? undefined : layers.get(layer);
      rows.set(id, on?.row ?? -1);
      const seen = !on?.hidden;
      return [
        {
          id,
          mode,
          points,
          box,
          organ: known?.organ,
          doubtful: known?.doubtful ?? false,
          color: color ? `rgb(${color.join(' ')})` : undefined,
          width: width ?? undefined,
          seen,
          free: seen && !on?.locked,
          line,
        },
      ];
    });
    this.order = this.strokes.filter((s) => s.seen).sort((a, b) => rows.get(a.id)! - rows.get(b.id)!);
    const free = new Set(this.strokes.filter((s) => s.free).map((s) => s.id));
    this.pending = undefined;
    const left = [...this.selection].filter((id) => free.has(id));
    if (left.length !== this.selection.size) this.select(left);
    this.redraw(photo || this.photo ? 'all' : staleOf(order, this.order));
  }

  setImage(image: ImageBitmap): void {
    this.image?.close();
    this.image = image;
    this.redraw('all');
  }

  /** Shows lines in the colours of their pens, and not of what they were understood as. */
  setOwnColours(on: boolean): void {
    this.ownColours = on;
    this.redraw('all');
  }

  /** The pen that is held: colour, and width in pixels. */
  setPen(pen: { color: string | null; width: number | null }): void {
    this.pen = pen;
  }

  setAxis(axis: number | undefined): void {
    this.axis = axis;
    this.redraw('all');
  }

  get symmetric(): boolean {
    return this.axis !== undefined;
  }

  /** The stroke that was lifted will not come. */
  dropPending(): void {
    this.pending = undefined;
    this.redraw();
  }

  /** What each row of the document was understood as; a row beyond the document is the stroke being drawn. */
  setOrgans(organs: Map<number, string>, doubtful: ReadonlySet<number>): void {
    let changed: Stale;
    this.strokes.forEach((s, row) => {
      if (s.organ !== organs.get(row) || s.doubtful !== doubtful.has(row)) changed = both(changed, roomOf(s));
      [s.organ, s.doubtful] = [organs.get(row), doubtful.has(row)];
    });
    this.draftOrgan = organs.get(this.strokes.length);
    this.redraw(changed);
  }

  setTool(tool: Tool): void {
    this.tool = tool;
    this.element.dataset['tool'] = tool;
    if (tool !== 'select') this.select([]);
  }

  setDark(dark: boolean): void {
    this.dark = dark;
    this.redraw('all');
  }

  setLabel(label: string): void {
    this.element.setAttribute('aria-label', label);
  }

  get selected(): number[] {
    return [...this.selection];
  }

  /** All of these but what lies on layers that are hidden or locked; `pressed`: where one of them was pressed, in the drawing's unit. */
  select(wanted: number[], pressed?: [number, number]): void {
    const closed = new Set(this.strokes.filter((s) => !s.free).map((s) => s.id));
    const ids = wanted.filter((id) => !closed.has(id));
    const same = ids.length === this.selection.size && ids.every((id) => this.selection.has(id));
    this.pressed = pressed ?? (same ? this.pressed : undefined);
    this.selection = new Set(ids);
    const box = this.selectedBox();
    this.events.selected(ids, box && frameOf(this.view, box));
    this.redraw();
  }

  /** Says again what is selected: it moved on the screen, or what is known of it changed. */
  reselect(): void {
    if (this.selection.size > 0) this.select(this.selected);
  }

  /** Selects the stroke after (or before) the selected one. */
  selectNext(step: number): void {
    const free = this.strokes.filter((s) => s.free);
    const n = free.length;
    if (n === 0) return;
    const now = free.findIndex((s) => this.selection.has(s.id));
    const next = now < 0 ? (step > 0 ? 0 : n - 1) : (now + step + n) % n;
    this.select([free[next]!.id]);
  }

  /** One unit of the drawing per this many screen pixels. */
  get unitsPerPixel(): number {
    return 1 / this.view.scale;
  }

  /** The part of the drawing that is seen. */
  seen(): Box {
    const [left, top] = toDrawing(this.view, 0, 0);
    const [right, bottom] = toDrawing(this.view, ...this.room);
    return { left, top, right, bottom };
  }

  get isEmpty(): boolean {
    return this.strokes.length === 0 && !this.photo && !this.pending && this.act?.kind !== 'draw';
  }

  fit(): void {
    const p = this.photo;
    const under: Box | undefined = p
      ? {
          left: p.place.x,
          bottom: p.place.y,
          right: p.place.x + p.place.width,
          top: p.place.y + p.height,
        }
      : undefined;
    const box = this.order.reduce<Box | undefined>((b, s) => boxOf(s.points, 3, b), under);
    const [w, h] = this.room;
    this.view = box ? fitted(box, w, h) : { scale: 1, x: w / 2, y: h * 0.85 };
    this.redraw('all');
    this.events.viewport();
  }

  // Pointers ----------------------------------------------------------------------------------------------------

  /** Space is for the sheet: it has the focus, or the pointer is over it, no text is written and no button was gone to by Tab. */
  private get ownsSpace(): boolean {
    const focused = document.activeElement;
    if (focused === this.element) return true;
    return this.hovered && !this.tabbed && !focused?.matches('input:not([type]), textarea, select');
  }

  /** Holds Space, or lets go; a button that has the focus does not hear the key. */
  private setSpace(held: boolean, e?: KeyboardEvent): void {
    this.space = held;
    this.element.classList.toggle('pans', held);
    e?.preventDefault();
  }

  private place(e: PointerEvent | WheelEvent): [number, number] {
    const box = this.element.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  private down(e: PointerEvent): void {
    this.element.focus({ preventScroll: true });
    const at = this.place(e);
    const touch = e.pointerType === 'touch';
    // The palm rests on the glass while the pen is down.
    if (touch && this.penDown) return;
    if (e.pointerType === 'pen') {
      this.penSeen = true;
      this.penDown = true;
      // The palm often comes first: what it began is none of the hand's meaning.
      if (this.act) this.abort();
      this.pinch = undefined;
      this.pointers.clear();
    }
    if (touch) this.pointers.set(e.pointerId, at);
    this.element.setPointerCapture(e.pointerId);
    const fingers = touch ? this.pointers.size : 0;
    if (fingers === 2) {
      this.abort();
      this.pinch = this.pinchNow();
      return;
    }
    if (this.act) return;
    this.actor = e.pointerId;
    // With a pen at hand, fingers and the palm only move the sheet.
    const palm = e.pointerType === 'touch' && this.penSeen;
    if (palm || this.space || e.button === 1) {
      this.act = { kind: 'pan', x: at[0], y: at[1] };
    } else if (e.button === 2) {
      const hit = this.hit(at, reachOf(e.pointerType));
      this.select(hit ? [hit.id] : [], toDrawing(this.view, at[0], at[1]));
    } else if (e.button === 5 || e.buttons === 32 || this.tool === 'erase') {
      this.act = { kind: 'erase', ids: new Set() };
      this.rub(at, reachOf(e.pointerType));
    } else if (this.placing && this.photo) {
      this.act = { kind: 'photo', place: this.photo.place, from: at, moved: false };
    } else if (this.tool === 'select') {
      this.grab(at, e);
    } else if (this.tool === 'pull') {
      const hit = this.hit(at, reachOf(e.pointerType));
      if (hit) this.act = { kind: 'pull', id: hit.id, from: at, moved: false };
    } else if (this.tool === 'rub') {
      const radius = reachOf(e.pointerType) / this.view.scale;
      this.act = { kind: 'rub', path: [toDrawing(this.view, at[0], at[1])], radius };
      this.events.begin('rub');
      this.rubAlong();
    } else {
      const pen = new Pen(this.steady);
      this.act = { kind: 'draw', pen, mode: this.tool };
      this.trace(e, pen, false);
      this.redraw();
    }
  }

  private grab(at: [number, number], e: PointerEvent): void {
    const reach = reachOf(e.pointerType);
    const box = this.selectedBox();
    const handle = box && handleAt(frameOf(this.view, box), at, reach);
    if (box && handle) {
      this.act = { kind: 'frame', handle, box, from: at, moved: false };
      return;
    }
    const hit = this.hit(at, reach);
    if (!hit) {
      this.act = { kind: 'band', from: at, to: at, add: e.shiftKey };
      return;
    }
    const chosen = new Set(this.selection);
    if (e.shiftKey) {
      if (!chosen.delete(hit.id)) chosen.add(hit.id);
    } else if (!chosen.has(hit.id)) {
      chosen.clear();
      chosen.add(hit.id);
    }
    this.select([...chosen], toDrawing(this.view, at[0], at[1]));
    this.act = { kind: 'move', from: at, moved: false };
  }

  private trace(e: PointerEvent, pen: Pen, last: boolean): void {
    const { left, top } = this.element.getBoundingClientRect();
    const all = last ? [] : (e.getCoalescedEvents?.() ?? []);
    for (const c of all.length > 0 ? all : [e]) pen.add(c, left, top, this.view, last);
  }

  /** The stroke on the other side of the line of symmetry, if it has one there. */
  private mirrored(pen: Pen): Float64Array | undefined {
    const { axis } = this;
    return axis !== undefined && pen.beside(axis) ? pen.mirrored(axis) : undefined;
  }

  private move(e: PointerEvent): void {
    const at = this.place(e);
    if (this.pointers.has(e.pointerId)) this.pointers.set(e.pointerId, at);
    if (this.pinch && e.pointerType === 'touch' && this.pointers.size >= 2) {
      const now = this.pinchNow();
      this.view = zoomed(this.view, now.distance / this.pinch.distance, this.pinch.x, this.pinch.y);
      this.view = {
        ...this.view,
        x: this.view.x + now.x - this.pinch.x,
        y: this.view.y + now.y - this.pinch.y,
      };
      this.pinch = now;
      this.moved();
      return;
    }
    if (!this.act || e.pointerId !== this.actor) return;
    const act = this.act;
    switch (act.kind) {
      case 'draw':
        this.trace(e, act.pen, false);
        if (act.pen.length > 2) this.events.draft(act.mode, act.pen.samples, this.mirrored(act.pen));
        break;
      case 'erase':
        this.rub(at, reachOf(e.pointerType));
        break;
      case 'move':
      case 'frame':
      case 'pull':
      case 'photo':
        if (act.kind !== 'photo' && !act.moved && Math.hypot(at[0] - act.from[0], at[1] - act.from[1]) < SLIP)
          return;
        if (!act.moved) this.events.begin(act.kind === 'frame' ? 'turn' : act.kind);
        act.moved = true;
        this.events.change(this.changeOf(act, at, e.shiftKey));
        break;
      case 'rub': {
        const p = toDrawing(this.view, at[0], at[1]);
        const [x, y] = act.path.at(-1)!;
        if (Math.hypot(p[0] - x, p[1] - y) < act.radius / 2) return;
        act.path.push(p);
        this.rubAlong();
        break;
      }
      case 'band':
        act.to = at;
        break;
      case 'pan':
        this.view = { ...this.view, x: this.view.x + at[0] - act.x, y: this.view.y + at[1] - act.y };
        [act.x, act.y] = at;
        this.moved();
        break;
    }
    this.redraw();
  }

  /** What a drag comes to with the pointer here. */
  private changeOf(
    act: Extract<Act, { moved: boolean }>,
    at: [number, number],
    held: boolean,
  ): SketchCommand {
    const [from, to] = [act.from, at].map(([x, y]) => toDrawing(this.view, x, y)) as [
      [number, number],
      [number, number],
    ];
    const by: [number, number] = [to[0] - from[0], to[1] - from[1]];
    if (act.kind === 'photo')
      return { 'place-photo': { ...act.place, x: act.place.x + by[0], y: act.place.y + by[1] } };
    if (act.kind === 'move') return { 'move-strokes': [this.selected, by] };
    if (act.kind === 'pull')
      return { 'pull-strokes': [[act.id], { at: from, by, reach: PULL / this.view.scale }] };
    return { 'turn-strokes': [this.selected, dragged(act.handle, act.box, from, to, held)] };
  }

  private rubAlong(): void {
    if (this.act?.kind === 'rub') this.events.change({ 'rub-out': [this.act.path, this.act.radius] });
  }

  private up(e: PointerEvent, kept: boolean): void {
    if (e.pointerType === 'pen') this.penDown = false;
    this.pointers.delete(e.pointerId);
    if (this.pointers.size < 2) this.pinch = undefined;
    if (!this.act || e.pointerId !== this.actor) return;
    if (!kept) {
      this.abort();
      return;
    }
    const act = this.act;
    this.act = undefined;
    switch (act.kind) {
      case 'draw':
        this.trace(e, act.pen, true);
        // A dot is a slip of the hand.
        if (act.pen.length > 2) {
          this.pending = { pen: act.pen, mode: act.mode };
          this.events.stroke(act.mode, act.pen.samples, this.mirrored(act.pen));
        } else {
          this.events.undraft();
        }
        break;
      case 'erase':
        if (act.ids.size > 0) this.events.erase([...act.ids]);
        break;
      case 'move':
      case 'frame':
      case 'pull':
      case 'photo':
        if (act.moved) this.events.end(true);
        break;
      case 'rub':
        this.events.end(true);
        break;
      case 'band':
        this.band(act.from, act.to, act.add);
        break;
      case 'pan':
        break;
    }
    this.redraw('all');
  }

  /** Leaves what was begun: a second finger came, or the system took the pointer away. */
  private abort(): void {
    const act = this.act;
    this.act = undefined;
    if (act?.kind === 'draw') this.events.undraft();
    if (act?.kind === 'rub' || (act && 'moved' in act && act.moved)) this.events.end(false);
    this.redraw('all');
  }

  private band(from: [number, number], to: [number, number], add: boolean): void {
    const [x0, y0] = toDrawing(this.view, Math.min(from[0], to[0]), Math.max(from[1], to[1]));
    const [x1, y1] = toDrawing(this.view, Math.max(from[0], to[0]), Math.min(from[1], to[1]));
    const inside = this.strokes.filter(
      (s) => s.free && s.box.left >= x0 && s.box.right <= x1 && s.box.bottom >= y0 && s.box.top <= y1,
    );
    this.select([...(add ? this.selection : []), ...inside.map((s) => s.id)]);
  }

  private pinchNow(): { distance: number; x: number; y: number } {
    const [a, b] = [...this.pointers.values()];
    const p: [number, number] = a ?? [0, 0];
    const q: [number, number] = b ?? p;
    return {
      distance: Math.max(1, Math.hypot(p[0] - q[0], p[1] - q[1])),
      x: (p[0] + q[0]) / 2,
      y: (p[1] + q[1]) / 2,
    };
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    this.turnWheel(e, ...this.place(e));
  }

  /** The wheel is turned over the front view: right of its middle and below it, in shares of its height. */
  zoomAbout(e: WheelEvent, right: number, down: number): void {
    const [w, h] = this.room;
    this.turnWheel(e, w / 2 + right * h, h / 2 + down * h);
  }

  private turnWheel(e: WheelEvent, x: number, y: number): void {
    if (e.shiftKey) this.view = { ...this.view, x: this.view.x - (e.deltaX || e.deltaY), y: this.view.y };
    else this.view = zoomed(this.view, Math.exp(-e.deltaY * (e.ctrlKey ? 0.01 : 0.0015)), x, y);
    this.moved();
  }

  private moved(): void {
    this.redraw('all');
    this.events.viewport();
  }

  private hit(at: [number, number], reach: number): Stroke | undefined {
    const [x, y] = toDrawing(this.view, at[0], at[1]);
    const r = reach / this.view.scale;
    let best: Stroke | undefined;
    let least = r;
    for (const s of this.order) {
      if (!s.free) continue;
      const b = s.box;
      if (x < b.left - r || x > b.right + r || y < b.bottom - r || y > b.top + r) continue;
      const d = distance(s.points, 3, x, y);
      // The later stroke lies on top.
      if (d <= least) [best, least] = [s, d];
    }
    return best;
  }

  private rub(at: [number, number], reach: number): void {
    if (this.act?.kind !== 'erase') return;
    const hit = this.hit(at, reach);
    if (hit) {
      this.act.ids.add(hit.id);
      this.redraw('all');
    }
  }

  /** Round what is selected, in the drawing's unit. */
  selectedBox(): Box | undefined {
    const [first, ...others] = this.strokes.filter((s) => this.selection.has(s.id)).map((s) => s.box);
    return first && others.reduce(united, first);
  }

  /** How much of what is selected lies there, pixels. */
  covered({ left, right, top, bottom }: Frame): number {
    const [x0, y0] = toDrawing(this.view, left, bottom);
    const [x1, y1] = toDrawing(this.view, right, top);
    const box = { left: x0, right: x1, bottom: y0, top: y1 };
    const chosen = this.strokes.filter((s) => this.selection.has(s.id));
    return chosen.reduce((sum, s) => sum + lengthWithin(s.points, 3, box), 0) * this.view.scale;
  }

  // Drawing -----------------------------------------------------------------------------------------------------

  private resize(): void {
    const ratio = Math.min(3, devicePixelRatio || 1);
    const { clientWidth: w, clientHeight: h } = this.element;
    // Where the view fills the page, the sheet is as it was.
    if (w === 0 || h === 0) return;
    this.room = [w, h];
    for (const canvas of [this.base, this.top]) {
      canvas.width = Math.max(1, Math.round(w * ratio));
      canvas.height = Math.max(1, Math.round(h * ratio));
    }
    if (!this.placed) {
      this.placed = true;
      this.fit();
    }
    this.moved();
  }

  private redraw(base?: Stale): void {
    this.stale = both(this.stale, base);
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      if (this.stale) this.drawBase(this.stale);
      this.stale = undefined;
      this.drawTop();
    });
  }

  private penOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D | undefined {
    const c = canvas.getContext('2d');
    if (!c) return undefined;
    const ratio = canvas.width / Math.max(1, this.element.clientWidth);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.lineCap = 'round';
    c.lineJoin = 'round';
    return c;
  }

  private drawBase(stale: Box | 'all'): void {
    const c = this.penOf(this.base);
    if (!c) return;
    c.save();
    const part = stale === 'all' ? undefined : this.clip(c, stale);
    c.clearRect(0, 0, this.element.clientWidth, this.element.clientHeight);
    this.under(c);
    drawGrid(c, this.view, part ?? this.seen(), this.dark);
    const gone = this.act?.kind === 'erase' ? this.act.ids : undefined;
    for (const s of this.order) {
      if (part && !reaches(s.box, part, THICKEST * (this.wideOf(s) / this.view.scale))) continue;
      c.globalAlpha = gone?.has(s.id) ? 0.15 : s.doubtful ? DOUBT : 1;
      this.ink(c, this.lineOf(s), s.mode, s.organ, s.color);
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

  private drawTop(): void {
    const c = this.penOf(this.top);
    if (!c) return;
    c.clearRect(0, 0, this.element.clientWidth, this.element.clientHeight);
    const live = this.act?.kind === 'draw' ? this.act : this.pending;
    // A layer that was only cleared may be shown with its old picture by browsers that draw without a graphics card.
    this.top.style.visibility =
      live || this.selection.size > 0 || this.act?.kind === 'band' ? 'visible' : 'hidden';
    for (const s of this.strokes) {
      if (!this.selection.has(s.id)) continue;
      c.globalAlpha = 0.3;
      drawLine(
        c,
        this.view,
        lineThrough(s.points, 3, this.view.scale, false),
        this.accent(),
        8 + this.lineOf(s).wide,
      );
      c.globalAlpha = 1;
      this.ink(c, this.lineOf(s), s.mode, s.organ, s.color);
    }
    // While it is dragged, the strokes show what comes of it.
    const box = this.tool === 'select' && !this.act ? this.selectedBox() : undefined;
    if (box) drawFrame(c, frameOf(this.view, box), [this.accent(), this.dark ? '#20261f' : '#ffffff']);
    if (live) {
      const { pen, mode } = live;
      const inked = (samples: Float64Array): void =>
        this.ink(
          c,
          lineThrough(samples, 4, this.view.scale, mode === 'parts', this.pen.width ?? INK),
          mode,
          this.draftOrgan,
          this.pen.color ?? undefined,
        );
      inked(pen.samples);
      const { axis } = this;
      if (axis !== undefined && pen.beside(axis)) {
        c.globalAlpha = 0.55;
        inked(pen.mirrored(axis));
        c.globalAlpha = 1;
      }
    }
    if (this.act?.kind === 'band') {
      const { from, to } = this.act;
      c.strokeStyle = this.accent();
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

  private accent(): string {
    return this.dark ? '#8ecbff' : '#1769aa';
  }

  /** The photograph and the line of symmetry. */
  private under(c: CanvasRenderingContext2D): void {
    const p = this.photo;
    if (p && this.image) {
      const { opacity, width } = p.place;
      const [x, y] = toScreen(this.view, p.place.x, p.place.y + p.height);
      c.globalAlpha = opacity;
      c.imageSmoothingQuality = 'high';
      c.drawImage(this.image, x, y, width * this.view.scale, p.height * this.view.scale);
      c.globalAlpha = 1;
    }
    if (this.axis !== undefined) {
      const [x] = toScreen(this.view, this.axis, 0);
      c.strokeStyle = this.accent();
      c.lineWidth = 1;
      c.setLineDash([3, 5]);
      c.beginPath();
      c.moveTo(x, 0);
      c.lineTo(x, this.element.clientHeight);
      c.stroke();
      c.setLineDash([]);
    }
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
