/** When pictures are drawn: one after a change, more while something moves, few where the processor draws them. */

/** Least time between pictures that the processor draws. */
const SLOW_MS = 300;
/** Its pixels for each of the screen's: while pictures follow one another, at rest, and once the view has been still. */
const GRAIN = { moving: 0.45, rest: 0.75, still: 1.5 } as const;
/** The view is still when nothing moved for so long. */
const STILL_MS = 1500;
/** A picture that took longer is not drawn again. */
const DEAR_MS = 500;

export interface Drawer {
  /** No picture is wanted: another draws them. */
  away(): boolean;
  /** The camera is on a way of its own. */
  isLed(): boolean;
  /** Draws one, so many milliseconds after the one before; whether something still moves. */
  draw(ms: number): boolean;
  /** When the last one is seen; undefined: at once. */
  shown(): Promise<void> | undefined;
  /** Whether what is on the screen is what is wanted there, and nothing more is coming. */
  rests(on: boolean): void;
  /** Another grain from now on. */
  grained(grain: number): void;
  /** No finer picture of what is seen is coming. */
  finished(): void;
}

export class Frames {
  /** Pixels for each of the screen's. */
  grain: number;
  private drawn = -Infinity;
  private stillness = 0;
  /** From the wish to the picture on the screen, of the last one, ms. */
  private took = 0;
  private rest = 0;
  private frame = 0;
  private last = 0;
  private rendered = 0;
  /** A picture is on its way to the screen, and whether another is wanted after it. */
  private coming = false;
  private again = false;

  constructor(
    private readonly slow: boolean,
    private readonly drawer: Drawer,
    /** Pixels of a graphics card for each of the screen's, while something moves and once the view has been still. */
    private readonly fine: { readonly moving: number; readonly still: number },
  ) {
    this.grain = slow ? GRAIN.rest : fine.moving;
  }

  redraw(): void {
    window.clearTimeout(this.stillness);
    if (this.drawer.away()) return;
    this.drawer.rests(false);
    if (this.frame) return;
    if (this.coming) {
      this.again = true;
      return;
    }
    if (!this.drawer.isLed()) this.last = performance.now();
    // Drawing without a graphics card takes the whole processor: the pen goes before the picture.
    const wait = this.slow ? SLOW_MS - (performance.now() - this.rendered) : 0;
    if (wait > 0) {
      this.frame = window.setTimeout(() => {
        this.frame = 0;
        this.rendered = 0;
        this.redraw();
      }, wait);
      return;
    }
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      const now = performance.now();
      const since = now - this.last;
      this.last = now;
      if (this.slow) this.spare(now);
      else this.refine(this.fine.moving);
      const moves = this.drawer.draw(since);
      this.rendered = performance.now();
      this.took = this.rendered - now;
      const shown = this.drawer.shown();
      if (shown) void this.follow(shown, moves);
      else this.went(moves);
    });
  }

  /** The next picture is drawn when this one is seen. */
  private async follow(shown: Promise<void>, moves: boolean): Promise<void> {
    this.coming = true;
    this.again = moves;
    await shown;
    this.took += performance.now() - this.rendered;
    this.coming = false;
    this.rendered = performance.now();
    this.went(this.again);
  }

  /** A picture is seen; `more`: another is to follow it. */
  private went(more: boolean): void {
    if (more) {
      this.redraw();
      return;
    }
    const rests = !this.frame && !this.rest;
    this.drawer.rests(rests);
    if (!rests) return;
    if (this.took < DEAR_MS) this.stillness = window.setTimeout(() => this.sharpen(), STILL_MS);
    else this.drawer.finished();
  }

  /** The view was still for a while: the same picture again, as fine as it can be. */
  private sharpen(): void {
    if (this.drawer.away() || this.frame || this.coming) return;
    this.refine(this.slow ? GRAIN.still : this.fine.still);
    this.drawer.draw(0);
    this.rendered = performance.now();
    const shown = this.drawer.shown();
    if (shown) void shown.then(() => this.drawer.finished());
    else this.drawer.finished();
  }

  /** The next picture is as fine as those at rest. */
  settle(): void {
    this.refine(this.slow ? GRAIN.rest : this.fine.moving);
  }

  /** Coarse pictures while they follow one another, a fine one when they have come to rest. */
  private spare(now: number): void {
    const moving = now - this.drawn < 3 * SLOW_MS;
    this.drawn = now;
    this.refine(moving ? GRAIN.moving : GRAIN.rest);
    window.clearTimeout(this.rest);
    this.rest = 0;
    if (moving)
      this.rest = window.setTimeout(() => {
        this.rest = 0;
        this.drawn = -Infinity;
        this.redraw();
      }, 2 * SLOW_MS);
  }

  private refine(grain: number): void {
    if (grain === this.grain) return;
    this.grain = grain;
    this.drawer.grained(grain);
  }
}
