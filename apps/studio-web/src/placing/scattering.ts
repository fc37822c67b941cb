/** A pen on the ground of the view: the line, the area or the brush along which copies of a plant are to stand. */
import type { Wish } from './scene';
import { el } from '../page/ui';
import { Overlay } from '../view/overlay';
import type { PlantView } from '../view/view';
import type { Ground } from '../wire';

const TRACES = { line: 'line', area: 'outline', brush: 'brush' } as const;
/** The radius of the brush, in spacings. */
const BRUSH = 1.5;
/** Points nearer than this, pixels, say nothing new. */
const STEP = 4;

export class GroundPen {
  readonly element = el('div', { class: 'ground-pen' });
  private readonly overlay = new Overlay((points) => points);
  private wish: Wish | undefined;
  private points: [number, number][] = [];
  private last: [number, number] = [0, 0];
  private pointer: number | undefined;

  /** `drawn`: where copies are to stand; `left`: the pen was laid down. */
  constructor(
    private readonly view: PlantView,
    private readonly drawn: (ground: Ground) => void,
    private readonly left: () => void,
  ) {
    this.element.append(this.overlay.element);
    const canvas = view.element.querySelector('canvas')!;
    const take = (act: (e: PointerEvent) => void) => (e: PointerEvent) => {
      if (!this.wish || (e.button > 0 && this.pointer === undefined)) return;
      e.stopImmediatePropagation();
      act(e);
    };
    const first = { capture: true };
    canvas.addEventListener(
      'pointerdown',
      take((e) => this.down(e, canvas)),
      first,
    );
    canvas.addEventListener(
      'pointermove',
      take((e) => this.moved(e)),
      first,
    );
    canvas.addEventListener(
      'pointerup',
      take((e) => this.up(e)),
      first,
    );
    canvas.addEventListener('pointercancel', () => this.reset(), first);
  }

  get isOn(): boolean {
    return this.wish !== undefined;
  }

  /** Takes the pen up for one stroke, or lays it down. */
  take(wish: Wish | undefined): void {
    this.reset();
    this.wish = wish;
    this.view.element.classList.toggle('on-ground', wish !== undefined);
    if (!wish) this.left();
  }

  private down(e: PointerEvent, canvas: HTMLCanvasElement): void {
    if (!this.wish || this.pointer !== undefined) return;
    this.pointer = e.pointerId;
    canvas.setPointerCapture?.(e.pointerId);
    const wide = this.view.groundPixels(e.clientX, e.clientY, this.radius);
    this.overlay.begin(TRACES[this.wish.pattern], this.wish.pattern === 'brush' ? 2 * wide : 3);
    this.last = [-STEP, -STEP];
    this.add(e);
  }

  private moved(e: PointerEvent): void {
    if (e.pointerId === this.pointer) this.add(e);
  }

  private up(e: PointerEvent): void {
    if (e.pointerId !== this.pointer || !this.wish) return;
    this.add(e);
    const { points, radius } = this;
    const ground: Ground =
      this.wish.pattern === 'line'
        ? { line: points }
        : this.wish.pattern === 'area'
          ? { area: points }
          : { brush: { path: points, radius_m: radius } };
    this.take(undefined);
    this.drawn(ground);
  }

  private get radius(): number {
    return BRUSH * (this.wish?.spacing ?? 1);
  }

  private add(e: PointerEvent): void {
    const box = this.view.element.getBoundingClientRect();
    const at: [number, number] = [e.clientX - box.left, e.clientY - box.top];
    if (Math.hypot(at[0] - this.last[0], at[1] - this.last[1]) < STEP) return;
    // Above the horizon there is no ground.
    const ground = this.view.groundAt(e.clientX, e.clientY);
    if (!ground) return;
    this.last = at;
    this.points.push(ground);
    this.overlay.add(...at);
    this.overlay.draw();
  }

  private reset(): void {
    this.pointer = undefined;
    this.points = [];
    this.overlay.end();
  }
}
