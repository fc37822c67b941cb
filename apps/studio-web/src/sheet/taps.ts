/** Taps with several fingers at once, which draw and move nothing. */

/** Longer than this is a rest of the hand, ms. */
const LONGEST_MS = 450;
/** A finger that goes farther moves the sheet, pixels. */
const FARTHEST = 14;

export class Taps {
  /** Where each finger that is down went down. */
  private readonly from = new Map<number, readonly [number, number]>();
  private began = 0;
  private most = 0;
  private isSpoilt = false;

  down(finger: number, at: readonly [number, number], time: number): void {
    if (this.from.size === 0) [this.began, this.most, this.isSpoilt] = [time, 0, false];
    this.from.set(finger, at);
    this.most = Math.max(this.most, this.from.size);
  }

  move(finger: number, [x, y]: readonly [number, number]): void {
    const from = this.from.get(finger);
    if (from && Math.hypot(x - from[0], y - from[1]) > FARTHEST) this.isSpoilt = true;
  }

  /** A finger is lifted; with the last one: how many tapped, 0 where it was no tap. `kept`: the system did not take it away. */
  up(finger: number, time: number, kept: boolean): number {
    if (!this.from.delete(finger)) return 0;
    this.isSpoilt ||= !kept;
    if (this.from.size > 0) return 0;
    return !this.isSpoilt && this.most > 1 && time - this.began < LONGEST_MS ? this.most : 0;
  }

  /** What the fingers do is none of the hand's meaning. */
  forget(): void {
    this.from.clear();
  }
}
