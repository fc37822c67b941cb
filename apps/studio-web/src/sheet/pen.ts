/** The stroke that is being drawn: a stabilised copy of what the pen sends, in drawing coordinates. */
import { toDrawing, type Viewport } from './geometry';

/** Share of the way to the pen that the line goes at each event, by strength of the stabiliser. */
export const FOLLOW = [1, 0.55, 0.3, 0.15] as const;

export class Pen {
  private rows: number[] = [];
  private at: [number, number] | undefined;
  private started = 0;

  /** `strength` of the stabiliser: 0 (none) to 3. 1 takes the tremor of a mouse away. */
  constructor(private readonly strength = 1) {}

  /** x, y, milliseconds, pressure of each point; NaN where the device does not know. */
  get samples(): Float64Array {
    return Float64Array.from(this.rows);
  }

  get length(): number {
    return this.rows.length / 4;
  }

  row(i: number): [number, number, number] {
    return [this.rows[4 * i]!, this.rows[4 * i + 1]!, this.rows[4 * i + 3]!];
  }

  add(e: PointerEvent, left: number, top: number, view: Viewport, last = false): void {
    const [x, y] = [e.clientX - left, e.clientY - top];
    if (!this.at) this.started = e.timeStamp;
    // The end is where the pen was lifted, not where the line lagged behind.
    const follow = last || !this.at ? 1 : (FOLLOW[this.strength] ?? 1);
    const [ax, ay] = this.at ?? [x, y];
    const next: [number, number] = [ax + (x - ax) * follow, ay + (y - ay) * follow];
    if (this.at && Math.hypot(next[0] - ax, next[1] - ay) < 0.3) return;
    this.at = next;
    // A 32nd of a pixel is below what a hand can mean, and makes files and links small.
    const grid = 2 ** Math.round(Math.log2(32 * view.scale));
    const [dx, dy] = toDrawing(view, next[0], next[1]).map((c) => Math.round(c * grid) / grid) as [
      number,
      number,
    ];
    // A mouse says 0.5 while a button is down: that is no pressure.
    const pressure = e.pointerType === 'pen' ? Math.round(e.pressure * 1024) / 1024 : NaN;
    this.rows.push(dx, dy, Math.round(Math.max(0, e.timeStamp - this.started)), pressure);
  }
}
