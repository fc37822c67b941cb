/** The stroke under the pen: what was drawn of it so far, and the plain figure that it becomes while the pen rests. */
import type { StrokeMode } from '../wire';
import { Pen } from './pen';
import { straightened } from './straighten';

/** A stroke of the pen: rows of x, y, milliseconds, pressure. */
export interface Inked {
  readonly samples: Float64Array;
  /** The same stroke where the symmetry of the sheet repeats it. */
  readonly copies: readonly Float64Array[];
  /** Stroke and copies as the figure that the hand meant, where it waited for that. */
  readonly straight?: readonly Float64Array[];
}

/** What the sheet makes of a stroke. */
export interface Paper {
  /** Where a place on the screen lies in the drawing. */
  place(at: readonly [number, number]): [number, number];
  /** A stroke with its ends where they meet what is drawn. */
  met(samples: Float64Array): Float64Array;
  /** Where the symmetry of the sheet repeats a stroke. */
  copies(samples: Float64Array): Float64Array[];
  /** The stroke became a figure. */
  changed(): void;
}

/** So long a pen rests at the end of a stroke that is meant as a plain figure, ms. */
const HOLD_MS = 500;
/** It rests while it stays within this, and wants the figure no more when it goes beyond that, pixels. */
const REST = { within: 4, beyond: 14 } as const;

export class UnderPen {
  readonly pen: Pen;
  private straight: Float64Array | undefined;
  private timer = 0;

  /** `strength` of the stabiliser; `rests`: where the pen is, pixels. */
  constructor(
    readonly mode: StrokeMode,
    strength: number,
    private rests: readonly [number, number],
    private readonly paper: Paper,
  ) {
    this.pen = new Pen(strength);
    this.wait();
  }

  get isFigure(): boolean {
    return this.straight !== undefined;
  }

  /** A dot is a slip of the hand. */
  get isDot(): boolean {
    return this.pen.length <= 2;
  }

  /** What would be kept if it ended now. */
  get inked(): Inked {
    const all = (line: Float64Array): Float64Array[] => [line, ...this.paper.copies(line)];
    const [samples, ...copies] = all(this.paper.met(this.pen.samples));
    return { samples: samples!, copies, ...(this.straight && { straight: all(this.straight) }) };
  }

  /** The pen went on: it rests no more, or wants no figure any more. */
  moved(at: readonly [number, number]): void {
    const far = Math.hypot(at[0] - this.rests[0], at[1] - this.rests[1]);
    if (far <= (this.isFigure ? REST.beyond : REST.within)) return;
    this.straight = undefined;
    this.rests = at;
    this.wait();
  }

  /** It is no longer under the pen. */
  end(): void {
    clearTimeout(this.timer);
  }

  private wait(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.figure(), HOLD_MS);
  }

  private figure(): void {
    const { samples } = this.pen;
    // To where the pen rests: the line lags behind.
    const whole = Float64Array.of(...samples, ...this.paper.place(this.rests), ...samples.slice(-2));
    this.straight = straightened(this.paper.met(whole));
    if (this.isFigure) this.paper.changed();
  }
}

/** What is seen of a stroke: itself or its figure, and the copies of that. */
export function shownOf({ samples, copies, straight }: Inked): Inked {
  const [first, ...others] = straight ?? [];
  return first ? { samples: first, copies: others } : { samples, copies };
}
