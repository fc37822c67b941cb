/** The first minute in a headset: three things to do, each told until it was done. */

export const LESSON = ['turn', 'draw', 'undo'] as const;
export type Step = (typeof LESSON)[number];

export class Lesson {
  /** `done`: how many steps were done, as `kept` was told last. */
  constructor(
    private done: number,
    private readonly kept: (done: number) => void,
  ) {}

  /** What is to be done now; undefined when all was. */
  get step(): Step | undefined {
    return LESSON[this.done];
  }

  /** Something was done; whether it was what is to be done now. */
  did(what: Step): boolean {
    if (what !== this.step) return false;
    this.done += 1;
    this.kept(this.done);
    return true;
  }

  again(): void {
    this.done = 0;
    this.kept(0);
  }
}
