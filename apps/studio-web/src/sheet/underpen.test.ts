import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { shownOf, UnderPen } from './underpen';

const VIEW = { scale: 1, x: 0, y: 0 };

/** A stroke that is mirrored at x = 0, and how often it became a figure. */
function drawing(): { stroke: UnderPen; changes: () => number; to: (x: number, y: number) => void } {
  let changes = 0;
  const stroke = new UnderPen('parts', 0, [10, 0], {
    place: ([x, y]) => [x, -y],
    met: (samples) => samples,
    copies: (samples) => [samples.map((value, i) => (i % 4 === 0 ? -value : value))],
    changed: () => {
      changes += 1;
    },
  });
  const to = (x: number, y: number): void => {
    const e = { clientX: x, clientY: y, timeStamp: 0, pointerType: 'mouse' } as PointerEvent;
    stroke.pen.add(e, 0, 0, VIEW);
    stroke.moved([x, y]);
  };
  return { stroke, changes: () => changes, to };
}

describe('the stroke under the pen', () => {
  beforeEach(() => {
    vi.useFakeTimers();
    vi.stubGlobal('window', globalThis);
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  const draw = (to: (x: number, y: number) => void): void => {
    for (let i = 0; i <= 20; i += 1) to(10 + 5 * i, 2 * (i % 2));
  };

  it('becomes a figure with its copies once the pen has rested, to where that rests', () => {
    const { stroke, changes, to } = drawing();
    draw(to);
    vi.advanceTimersByTime(300);
    // A hand is never quite still.
    to(111, 1);
    vi.advanceTimersByTime(190);
    expect([stroke.isFigure, changes()]).toEqual([false, 0]);
    vi.advanceTimersByTime(20);
    expect([stroke.isFigure, changes()]).toEqual([true, 1]);
    const { samples, copies, straight } = stroke.inked;
    expect([samples.length / 4, copies.length, straight?.length]).toEqual([22, 1, 2]);
    const shown = shownOf(stroke.inked);
    expect([...shown.samples.slice(-4, -2)]).toEqual([110, 0]);
    expect([...shown.copies[0]!.slice(-4, -2)]).toEqual([-110, 0]);
    expect(shownOf({ samples, copies }).samples).toBe(samples);
  });

  it('is the hand’s own again where that goes on, and when it is over', () => {
    const { stroke, changes, to } = drawing();
    draw(to);
    vi.advanceTimersByTime(600);
    to(118, 0);
    expect(stroke.isFigure).toBe(true);
    to(140, 0);
    expect(stroke.isFigure).toBe(false);
    expect(stroke.inked.straight).toBeUndefined();
    stroke.end();
    vi.advanceTimersByTime(2000);
    expect(changes()).toBe(1);
  });

  it('is no figure while it is a dot or comes near to none', () => {
    const dot = drawing();
    dot.to(10, 0);
    vi.advanceTimersByTime(600);
    const wave = drawing();
    for (let i = 0; i <= 60; i += 1) wave.to(10 + 3 * i, 40 * Math.sin(i / 4));
    vi.advanceTimersByTime(600);
    expect([dot.stroke.isDot, dot.stroke.isFigure, dot.changes()]).toEqual([true, false, 0]);
    expect([wave.stroke.isDot, wave.stroke.isFigure, wave.changes()]).toEqual([false, false, 0]);
  });
});
