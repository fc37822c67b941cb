/** The sheet: what was drawn, and the tools that change it. It knows nothing of plants. */
import type { StrokePoints } from '../worker/protocol';
import type { PhotoState, SketchCommand, SketchState, StrokeMode } from '../wire';
import type { Placed } from './align';
import { dragged, type Frame, frameOf, type Handle, handleAt } from './frame';
import { type Box, boxOf, fitted, toDrawing, type Viewport, zoomed } from './geometry';
import { MEETS, Painter, type UnderHand } from './painter';
import type { Pen } from './pen';
import { joined } from './snap';
import { both, type Stale, staleOf } from './stale';
import { type Stroke, Strokes } from './strokes';
import { copiesOf, type Symmetry } from './symmetry';
import { Taps } from './taps';
import { type Inked, type Paper, shownOf, UnderPen } from './underpen';

export type Tool = StrokeMode | 'erase' | 'rub' | 'select' | 'lasso' | 'pull' | 'dropper';

/** Tools that leave what is chosen as it is. */
const CHOOSERS: readonly Tool[] = ['select', 'lasso', 'dropper'];

export interface SheetEvents {
  stroke(mode: StrokeMode, inked: Inked): void;
  draft(mode: StrokeMode, inked: Inked): void;
  undraft(): void;
  erase(ids: number[]): void;
  /** A drag that changes strokes or the photograph: what it comes to replaces what it came to before. */
  begin(name: string): void;
  change(command: SketchCommand): void;
  end(keep: boolean): void;
  /** `frame`: round what is selected, pixels. */
  selected(ids: number[], frame: Frame | undefined): void;
  viewport(): void;
  /** So many fingers tapped at once. */
  tapped(fingers: number): void;
  /** A colour was taken up, CSS; nothing where there is none. */
  picked(color: string | undefined): void;
  /** The centre of the symmetry was put. */
  centred(): void;
}

/** How near a pointer must come to a stroke, in pixels: a fingertip is coarser. */
const REACH = { mouse: 8, pen: 8, touch: 18 } as const;
const reachOf = (type: string): number => REACH[type as keyof typeof REACH] ?? 8;
/** How far along a line a pull at it reaches, pixels. */
const PULL = 90;
/** A drag begins when the pointer is so far from where it went down, pixels. */
const SLIP = 4;

type Act =
  | { kind: 'draw'; stroke: UnderPen }
  | { kind: 'erase'; ids: Set<number> }
  | { kind: 'move'; from: [number, number]; moved: boolean }
  | { kind: 'frame'; handle: Handle; box: Box; from: [number, number]; moved: boolean }
  | { kind: 'pull'; id: number; from: [number, number]; moved: boolean }
  | { kind: 'rub'; path: [number, number][]; radius: number }
  | { kind: 'band'; from: [number, number]; to: [number, number]; add: boolean }
  | { kind: 'lasso'; path: [number, number][]; add: boolean; under: number | undefined }
  | { kind: 'centre' }
  | { kind: 'photo'; place: PhotoState['place']; from: [number, number]; moved: boolean }
  | { kind: 'pan'; x: number; y: number };

export class Sheet {
  readonly element = document.createElement('div');
  readonly strokes = new Strokes();
  private readonly painter: Painter;
  /** Where the drawing lies on the screen. */
  view: Viewport = { scale: 1, x: 0, y: 0 };
  private tool: Tool = 'parts';
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
  /** A stroke that was lifted and is not in the document yet: shown until it is. */
  private pending: { inked: Inked; mode: StrokeMode } | undefined;
  private readonly taps = new Taps();
  photo: PhotoState | null = null;
  image: ImageBitmap | undefined;
  /** Where a stroke was pressed last, in the drawing's unit. */
  pressed: [number, number] | undefined;
  /** Drags move the photograph. */
  placing = false;
  /** The next press puts the centre of the symmetry. */
  centring = false;
  private mirrors: Symmetry | undefined;
  /** Ends of strokes meet what is drawn. */
  meets = true;
  /** Strength of the stabiliser, 0 to 3. */
  steady = 1;
  private readonly paper: Paper = {
    place: ([x, y]) => toDrawing(this.view, x, y),
    met: (samples) => (this.meets ? joined(samples, this.strokes.order, MEETS / this.view.scale) : samples),
    copies: (samples) => copiesOf(this.mirrors, samples),
    changed: () => {
      if (this.act?.kind === 'draw') this.draft(this.act.stroke);
      this.redraw();
    },
  };
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
    this.painter = new Painter(this);
    this.element.append(this.painter.base, this.painter.top);
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
    const { photo, strokes } = this;
    const { order } = strokes;
    this.photo = state.photo;
    if (!state.photo) this.placing = false;
    // Where it was pressed is no place of what it is now.
    if (strokes.set(state, fresh).length > 0) this.pressed = undefined;
    const free = new Set(strokes.free.map((s) => s.id));
    this.pending = undefined;
    const left = this.selected.filter((id) => free.has(id));
    if (left.length !== strokes.selection.size) this.select(left);
    this.redraw(photo || this.photo ? 'all' : staleOf(order, strokes.order));
  }

  setImage(image: ImageBitmap): void {
    this.image?.close();
    this.image = image;
    this.redraw('all');
  }

  /** Shows lines in the colours of their pens, and not of what they were understood as. */
  setOwnColours(on: boolean): void {
    this.painter.ownColours = on;
    this.redraw('all');
  }

  /** The pen that is held: colour, and width in pixels. */
  setPen(pen: { color: string | null; width: number | null }): void {
    this.painter.pen = pen;
  }

  get symmetry(): Symmetry | undefined {
    return this.mirrors;
  }

  set symmetry(symmetry: Symmetry | undefined) {
    this.mirrors = symmetry;
    if (symmetry?.kind !== 'turns') this.centring = false;
    this.redraw('all');
  }

  /** The stroke that was lifted will not come. */
  dropPending(): void {
    this.pending = undefined;
    this.redraw();
  }

  /** What each row of the document was understood as; a row beyond the document is the stroke being drawn. */
  setOrgans(organs: Map<number, string>, doubtful: ReadonlySet<number>, left: ReadonlySet<number>): void {
    const changed = this.strokes.setOrgans(organs, doubtful, left);
    this.painter.draftOrgan = organs.get(this.strokes.all.length);
    this.redraw(changed);
  }

  setTool(tool: Tool): void {
    this.tool = tool;
    this.element.dataset['tool'] = tool;
    if (!CHOOSERS.includes(tool)) this.select([]);
  }

  setDark(dark: boolean): void {
    this.painter.dark = dark;
    this.redraw('all');
  }

  setLabel(label: string): void {
    this.element.setAttribute('aria-label', label);
  }

  get selected(): number[] {
    return [...this.strokes.selection];
  }

  /** All of these but what lies on layers that are hidden or locked; `pressed`: where one of them was pressed, in the drawing's unit. */
  select(wanted: number[], pressed?: [number, number]): void {
    const { selection, all } = this.strokes;
    const closed = new Set(all.filter((s) => !s.free).map((s) => s.id));
    const ids = wanted.filter((id) => !closed.has(id));
    const same = ids.length === selection.size && ids.every((id) => selection.has(id));
    this.pressed = pressed ?? (same ? this.pressed : undefined);
    this.strokes.selection = new Set(ids);
    const box = this.selectedBox();
    this.events.selected(ids, box && frameOf(this.view, box));
    this.redraw();
  }

  /** Says again what is selected: it moved on the screen, or what is known of it changed. */
  reselect(): void {
    if (this.strokes.selection.size > 0) this.select(this.selected);
  }

  /** Selects the stroke after (or before) the selected one. */
  selectNext(step: number): void {
    const next = this.strokes.next(step);
    if (next !== undefined) this.select([next]);
  }

  /** What is selected, and where each stroke of it lies. */
  get chosen(): Placed[] {
    return this.strokes.chosen;
  }

  /** One unit of the drawing per this many screen pixels. */
  get unitsPerPixel(): number {
    return 1 / this.view.scale;
  }

  /** The part of the drawing that is seen. */
  seen(): Box {
    return this.painter.seen;
  }

  get isEmpty(): boolean {
    return this.strokes.all.length === 0 && !this.photo && !this.pending && this.act?.kind !== 'draw';
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
    const box = this.strokes.order.reduce<Box | undefined>((b, s) => boxOf(s.points, 3, b), under);
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
      this.taps.forget();
    }
    if (touch) {
      this.pointers.set(e.pointerId, at);
      this.taps.down(e.pointerId, at, e.timeStamp);
    }
    this.element.setPointerCapture(e.pointerId);
    const fingers = touch ? this.pointers.size : 0;
    if (fingers > 1) {
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
    } else if (this.centring) {
      this.act = { kind: 'centre' };
      this.putCentre(at);
    } else if (this.placing && this.photo) {
      this.act = { kind: 'photo', place: this.photo.place, from: at, moved: false };
    } else if (this.tool === 'dropper') {
      this.events.picked(this.colourAt(at, reachOf(e.pointerType)));
    } else if (this.tool === 'select' || this.tool === 'lasso') {
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
      const stroke = new UnderPen(this.tool, this.steady, at, this.paper);
      this.act = { kind: 'draw', stroke };
      this.trace(e, stroke.pen, false);
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
    if (this.tool === 'lasso' && !(hit && this.strokes.selection.has(hit.id) && !e.shiftKey)) {
      this.act = { kind: 'lasso', path: [at], add: e.shiftKey, under: hit?.id };
      return;
    }
    if (!hit) {
      this.act = { kind: 'band', from: at, to: at, add: e.shiftKey };
      return;
    }
    this.take(hit.id, at, e.shiftKey);
    this.act = { kind: 'move', from: at, moved: false };
  }

  /** Selects a stroke that was pressed; `more`: beside the others, or no longer. */
  private take(id: number, at: [number, number], more: boolean): void {
    const chosen = new Set(this.strokes.selection);
    if (more) {
      if (!chosen.delete(id)) chosen.add(id);
    } else if (!chosen.has(id)) {
      chosen.clear();
      chosen.add(id);
    }
    this.select([...chosen], toDrawing(this.view, at[0], at[1]));
  }

  private trace(e: PointerEvent, pen: Pen, last: boolean): void {
    const { left, top } = this.element.getBoundingClientRect();
    const all = last ? [] : (e.getCoalescedEvents?.() ?? []);
    for (const c of all.length > 0 ? all : [e]) pen.add(c, left, top, this.view, last);
  }

  /** The stroke as it is now: the plant is shown with it. */
  private draft(stroke: UnderPen): void {
    if (!stroke.isDot) this.events.draft(stroke.mode, shownOf(stroke.inked));
  }

  private putCentre(at: [number, number]): void {
    if (this.mirrors?.kind === 'turns')
      this.symmetry = { ...this.mirrors, about: toDrawing(this.view, at[0], at[1]) };
  }

  /** The colour of the stroke there, or of the photograph. */
  private colourAt(at: [number, number], reach: number): string | undefined {
    const own = this.hit(at, reach)?.color;
    const { photo, image } = this;
    if (own || !photo || !image) return own;
    const [x, y] = toDrawing(this.view, at[0], at[1]);
    const { place, height } = photo;
    const [u, v] = [(x - place.x) / place.width, (place.y + height - y) / height];
    const c = new OffscreenCanvas(1, 1).getContext('2d');
    if (!c || u < 0 || u >= 1 || v < 0 || v >= 1) return undefined;
    c.drawImage(image, Math.floor(u * image.width), Math.floor(v * image.height), 1, 1, 0, 0, 1, 1);
    const [r, g, b] = c.getImageData(0, 0, 1, 1).data;
    return `rgb(${r} ${g} ${b})`;
  }

  private move(e: PointerEvent): void {
    const at = this.place(e);
    if (this.pointers.has(e.pointerId)) {
      this.pointers.set(e.pointerId, at);
      this.taps.move(e.pointerId, at);
    }
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
        this.trace(e, act.stroke.pen, false);
        act.stroke.moved(at);
        this.draft(act.stroke);
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
      case 'lasso': {
        const [x, y] = act.path.at(-1)!;
        if (Math.hypot(at[0] - x, at[1] - y) >= 2) act.path.push(at);
        break;
      }
      case 'centre':
        this.putCentre(at);
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
    const fingers = this.taps.up(e.pointerId, e.timeStamp, kept);
    if (fingers > 0) {
      this.abort();
      this.events.tapped(fingers);
      return;
    }
    if (!this.act || e.pointerId !== this.actor) return;
    if (!kept) {
      this.abort();
      return;
    }
    const act = this.act;
    this.act = undefined;
    switch (act.kind) {
      case 'draw':
        this.trace(e, act.stroke.pen, true);
        act.stroke.end();
        if (!act.stroke.isDot) {
          const { inked, mode } = act.stroke;
          this.pending = { inked, mode };
          this.events.stroke(mode, inked);
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
      case 'lasso':
        this.lasso(act);
        break;
      case 'centre':
        this.centring = false;
        this.events.centred();
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
    if (act?.kind === 'draw') {
      act.stroke.end();
      this.events.undraft();
    }
    if (act?.kind === 'rub' || (act && 'moved' in act && act.moved)) this.events.end(false);
    this.redraw('all');
  }

  private band(from: [number, number], to: [number, number], add: boolean): void {
    const [x0, y0] = toDrawing(this.view, Math.min(from[0], to[0]), Math.max(from[1], to[1]));
    const [x1, y1] = toDrawing(this.view, Math.max(from[0], to[0]), Math.min(from[1], to[1]));
    const inside = this.strokes.inBand({ left: x0, right: x1, bottom: y0, top: y1 });
    this.select([...(add ? this.selected : []), ...inside]);
  }

  /** Takes what the lasso has round it; a mere tap takes the stroke under it. */
  private lasso({ path, add, under }: Extract<Act, { kind: 'lasso' }>): void {
    const far = Math.max(...path.map(([x, y]) => Math.hypot(x - path[0]![0], y - path[0]![1])));
    if (far < SLIP) {
      if (under !== undefined) this.take(under, path[0]!, add);
      else if (!add) this.select([]);
      return;
    }
    const outline = path.map(([x, y]) => toDrawing(this.view, x, y));
    this.select([...(add ? this.selected : []), ...this.strokes.inLasso(outline)]);
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
    return this.strokes.hit(toDrawing(this.view, at[0], at[1]), reach / this.view.scale);
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
    return this.strokes.chosenBox;
  }

  /** How much of what is selected lies there, pixels. */
  covered({ left, right, top, bottom }: Frame): number {
    const [x0, y0] = toDrawing(this.view, left, bottom);
    const [x1, y1] = toDrawing(this.view, right, top);
    const box = { left: x0, right: x1, bottom: y0, top: y1 };
    return this.strokes.chosenWithin(box) * this.view.scale;
  }

  /** What is under the hand, to be shown. */
  get hand(): UnderHand {
    const { act, tool } = this;
    const drawn = act?.kind === 'draw' ? act.stroke : undefined;
    // While it is dragged, the strokes show what comes of it.
    const box = CHOOSERS.includes(tool) && !act ? this.selectedBox() : undefined;
    return {
      live: drawn ?? this.pending,
      drawn,
      lasso: act?.kind === 'lasso' ? act.path : undefined,
      band: act?.kind === 'band' ? act : undefined,
      erased: act?.kind === 'erase' ? act.ids : undefined,
      frame: box && frameOf(this.view, box),
    };
  }

  // Drawing -----------------------------------------------------------------------------------------------------

  private resize(): void {
    const { clientWidth: w, clientHeight: h } = this.element;
    // Where the view fills the page, the sheet is as it was.
    if (w === 0 || h === 0) return;
    this.room = [w, h];
    this.painter.resize(w, h);
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
      if (this.stale) this.painter.drawBase(this.stale);
      this.stale = undefined;
      this.painter.drawTop();
    });
  }
}
