/** The control balls of a leaf in the hand: shown over the view, dragged, made thicker by the wheel. What they do is the core's. */
import type { Request } from '../worker/protocol';
import { Overlay } from '../view/overlay';
import type { PlantView } from '../view/view';
import type { BallMove, Command, LeafBall, LeafBalls, PlantState, ShapePointer } from '../wire';

export interface BallsEvents {
  ask<T>(request: Request): Promise<T>;
  begin(name: string): void;
  stage(command: Command): void;
  commit(): void;
  /** Ends the gesture, and nothing of it stays. */
  abandon(): void;
  /** They are shown, or no longer. */
  changed(on: boolean): void;
}

type Vec = [number, number, number];

/** So near to a ball, in pixels, a pointer means it; a finger is thicker. */
const NEAR = 12;
const NEAR_TOUCH = 24;
/** A notch of the wheel makes a vein so many times as thick. */
const THICKER = 1.12;
/** Notches of the wheel are one step of undo until it rests so long. */
const REST_MS = 600;
/** What the core takes, as in the schema of `BallMove`. */
const [THINNEST, THICKEST] = [0.05, 20];

const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const sum = (a: Vec, b: Vec, times = 1): Vec => [
  a[0] + times * b[0],
  a[1] + times * b[1],
  a[2] + times * b[2],
];

/** Where a ray meets the plane through a point that looks along `forward`. */
export function onPlane({ origin, direction }: ShapePointer, through: Vec, forward: Vec): Vec | undefined {
  const along = dot(direction, forward);
  if (Math.abs(along) < 1e-6) return undefined;
  return sum(origin, direction, dot(sum(through, origin, -1), forward) / along);
}

/** The moves of a leaf with one more of a ball, in the place of what was asked of it before. */
export function withMove(
  moves: readonly BallMove[],
  { row, mark }: Pick<LeafBall, 'row' | 'mark'>,
  by: Vec,
  times: number,
): BallMove[] {
  const same = (m: BallMove): boolean => m.row === row && (m.mark === mark || row === 0);
  const before = moves.find(same) ?? { row, mark, by_m: [0, 0, 0] as Vec, thickness: 1 };
  const thickness = Math.min(THICKEST, Math.max(THINNEST, before.thickness * times));
  const now = { ...before, by_m: sum(before.by_m as Vec, by), thickness };
  return moves.some(same) ? moves.map((m) => (same(m) ? now : m)) : [...moves, now];
}

/** x, y, z and radius of each. */
const pointsOf = (seen: LeafBalls): Float32Array =>
  Float32Array.from(seen.balls.flatMap((b) => [...b.at, b.radius_m]));

/** A ball in the hand. */
interface Held {
  pointer: number;
  /** Where it was, and the plane on which it is dragged. */
  through: Vec;
  forward: Vec;
  /** From where it was taken to its middle. */
  aside: Vec;
  /** What was asked of the leaf before. */
  moves: readonly BallMove[];
}

export class Balls {
  readonly overlay: Overlay;
  private on = false;
  private plant: PlantState | undefined;
  private seen: LeafBalls | undefined;
  /** The ball under the pointer, or in the hand. */
  private meant: LeafBall | undefined;
  private held: Held | undefined;
  /** What is asked of the leaf while a gesture goes on: the state comes after it. */
  private moves: readonly BallMove[] = [];
  private turning = 0;
  private asking = false;
  private stale = false;

  constructor(
    private readonly view: PlantView,
    private readonly events: BallsEvents,
  ) {
    this.overlay = new Overlay(
      (points) => view.project(points),
      () => view.isAway,
    );
    const over = view.element;
    // Before the camera and the tools hear of it: elsewhere on the view they do what they always do.
    const first = { capture: true };
    over.addEventListener('pointerdown', (e) => this.down(e), first);
    over.addEventListener('pointermove', (e) => this.moved(e), first);
    over.addEventListener('pointerup', (e) => this.up(e), first);
    over.addEventListener('pointercancel', () => this.cancel(), first);
    over.addEventListener('wheel', (e) => this.wheel(e), { capture: true, passive: false });
    // Turning the wheel is over when something else is begun, such as an undo.
    for (const kind of ['keydown', 'pointerdown'] as const)
      document.addEventListener(kind, () => this.turning !== 0 && !this.held && this.finish(), first);
  }

  get isOn(): boolean {
    return this.on;
  }

  toggle(): void {
    this.set(!this.on);
  }

  private set(on: boolean): void {
    if (on === this.on) return;
    this.finish();
    this.on = on;
    this.seen = this.meant = undefined;
    this.draw();
    if (on) this.renewed();
    this.events.changed(on);
  }

  /** The plant that is worked on, as it is now. */
  show(plant: PlantState | undefined): void {
    const other = plant?.id !== this.plant?.id;
    this.plant = plant;
    if (!this.isGesture) this.moves = plant?.leaf?.settings.balls ?? [];
    if (this.on && (other || !plant?.leaf)) this.set(false);
  }

  /** All balls where they were measured. */
  measured(): void {
    this.finish();
    this.moves = [];
    this.events.begin('leaf');
    this.stage();
    this.events.commit();
  }

  /** New meshes are there: balls have moved. */
  renewed(): void {
    if (!this.on) return;
    this.stale = true;
    if (this.asking) return;
    [this.asking, this.stale] = [true, false];
    this.events
      .ask<LeafBalls>({ kind: 'balls' })
      .then(
        (balls) => {
          if (!this.on) return;
          this.seen = balls;
          this.meant = balls.balls.find((b) => b.row === this.meant?.row && b.mark === this.meant.mark);
          this.draw();
        },
        () => undefined,
      )
      .finally(() => {
        this.asking = false;
        if (this.stale) this.renewed();
      });
  }

  /** A picture of the plant was drawn: the view may have been turned. */
  drawn(): void {
    if (this.on) this.draw();
  }

  private draw(): void {
    const { seen, meant } = this;
    this.overlay.setDots(seen && pointsOf(seen), seen && meant ? seen.balls.indexOf(meant) : -1);
    // Where they are seen, those of the tip first.
    const places = seen ? this.view.project(pointsOf(seen)) : [];
    document.body.dataset['balls'] = [...places].map((x) => x.toFixed(1)).join(' ');
  }

  // Gestures -----------------------------------------------------------------------------------------------------

  private get isGesture(): boolean {
    return this.held !== undefined || this.turning !== 0;
  }

  /** The ball nearest to a place of the screen, if one is near. */
  private at(e: { clientX: number; clientY: number }, near: number): LeafBall | undefined {
    const { seen } = this;
    if (!seen) return undefined;
    const box = this.view.element.getBoundingClientRect();
    const places = this.view.project(pointsOf(seen));
    const far = seen.balls.map((_, i) =>
      places[3 * i + 2] === 0
        ? Infinity
        : Math.hypot(places[3 * i]! - (e.clientX - box.left), places[3 * i + 1]! - (e.clientY - box.top)),
    );
    const least = Math.min(...far);
    return least <= near ? seen.balls[far.indexOf(least)] : undefined;
  }

  private down(e: PointerEvent): void {
    if (!this.on) return;
    if (this.held) {
      // A second finger: the view is turned.
      this.cancel();
      return;
    }
    const ball = this.at(e, e.pointerType === 'touch' ? NEAR_TOUCH : NEAR);
    const pointer = this.view.pointer(e.clientX, e.clientY, 1);
    if (e.button !== 0 || !e.isPrimary || !ball || !pointer || !this.plant?.leaf) return;
    e.stopPropagation();
    e.preventDefault();
    this.finish();
    const forward = pointer.forward as Vec;
    const through = ball.at as Vec;
    // As far beside the ball as it was taken.
    this.meant = ball;
    this.held = {
      pointer: e.pointerId,
      through,
      forward,
      aside: sum(through, onPlane(pointer, through, forward) ?? through, -1),
      moves: this.moves,
    };
    this.view.element.setPointerCapture?.(e.pointerId);
    this.events.begin('leaf');
    this.draw();
  }

  private moved(e: PointerEvent): void {
    if (!this.on) return;
    const { held } = this;
    if (!held) {
      if (e.buttons !== 0) return;
      const ball = this.at(e, NEAR);
      if (ball === this.meant) return;
      this.meant = ball;
      this.view.element.style.cursor = ball ? 'grab' : '';
      this.draw();
      return;
    }
    if (e.pointerId !== held.pointer) return;
    e.stopPropagation();
    this.pull(e);
  }

  /** The ball goes with the pointer. A leaf that is curled or limp is moved before it is bent, and carries it further. */
  private pull(e: PointerEvent): void {
    const { held, meant, seen } = this;
    const pointer = this.view.pointer(e.clientX, e.clientY, 1);
    const place = held && pointer && onPlane(pointer, held.through, held.forward);
    if (!held || !meant || !seen || !place) return;
    const by = sum(sum(place, held.aside), held.through, -1);
    const [right, forth, up] = seen.sides as [Vec, Vec, Vec];
    this.moves = withMove(held.moves, meant, [dot(right, by), dot(forth, by), dot(up, by)], 1);
    this.stage();
  }

  private up(e: PointerEvent): void {
    if (!this.held || e.pointerId !== this.held.pointer) return;
    e.stopPropagation();
    this.finish();
  }

  private wheel(e: WheelEvent): void {
    const ball = this.on ? (this.held ? this.meant : this.at(e, NEAR)) : undefined;
    if (!ball || !this.plant?.leaf) return;
    e.preventDefault();
    e.stopImmediatePropagation();
    this.meant = ball;
    if (!this.held) {
      if (this.turning === 0) this.events.begin('leaf');
      clearTimeout(this.turning);
      this.turning = window.setTimeout(() => this.finish(), REST_MS);
    }
    const times = e.deltaY < 0 || e.deltaX < 0 ? THICKER : 1 / THICKER;
    const thicker = (moves: readonly BallMove[]): BallMove[] => withMove(moves, ball, [0, 0, 0], times);
    this.moves = thicker(this.moves);
    if (this.held) this.held.moves = thicker(this.held.moves);
    this.stage();
  }

  private stage(): void {
    const { plant } = this;
    if (!plant?.leaf) return;
    const settings = { ...plant.leaf.settings, balls: [...this.moves] };
    this.events.stage({ leaf: [plant.id, { set: settings }] });
  }

  /** Lets go; what was done stays. */
  private finish(): void {
    if (!this.isGesture) return;
    this.release();
    this.events.commit();
  }

  /** Escape: what is held goes back, else the balls are no longer shown. */
  leave(): void {
    if (this.isGesture) this.cancel();
    else this.set(false);
  }

  /** A second finger, a lost pointer: nothing is done. */
  private cancel(): void {
    if (!this.isGesture) return;
    this.release();
    this.moves = this.plant?.leaf?.settings.balls ?? [];
    this.events.abandon();
    this.renewed();
  }

  private release(): void {
    clearTimeout(this.turning);
    [this.held, this.turning] = [undefined, 0];
    this.view.element.style.cursor = '';
  }
}
