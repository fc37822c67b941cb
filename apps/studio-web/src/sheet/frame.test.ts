import { describe, expect, it } from 'vitest';
import { dragged, frameOf, handleAt, handlesOf } from './frame';

const box = { left: 0, right: 100, bottom: 0, top: 50 };
const view = { scale: 2, x: 10, y: 200 };

describe('the frame round what is selected', () => {
  it('is found by its handles, with the pixels of the screen running down', () => {
    const frame = frameOf(view, box);
    expect(frame.top).toBeLessThan(frame.bottom);
    for (const [handle, x, y] of handlesOf(frame)) expect(handleAt(frame, [x + 3, y - 3], 5)).toBe(handle);
    expect(handleAt(frame, [110, 150], 5)).toBeUndefined();
  });

  it('scales about the corner across, in proportion unless it is held', () => {
    const turn = dragged('right-top', box, [100, 50], [200, 100], false);
    expect(turn).toEqual({ about: [0, 0], angle_deg: 0, scale: [2, 2] });
    expect(dragged('right-top', box, [100, 50], [200, 50], true).scale).toEqual([2, 1]);
    expect(dragged('left-bottom', box, [0, 0], [50, 25], false).about).toEqual([100, 50]);
    // Dragged beyond the corner across, it is small and not turned inside out.
    expect(dragged('right-top', box, [100, 50], [-100, -50], false).scale[0]).toBeGreaterThan(0);
  });

  it('scales a level line along itself', () => {
    const line = { left: 0, right: 100, bottom: 7, top: 7 };
    expect(dragged('right-top', line, [100, 7.1], [150, 9], true).scale).toEqual([1.5, 1]);
  });

  it('turns counter-clockwise about the middle, in steps when it is held', () => {
    const turn = dragged('turn', box, [50, 60], [15, 25], false);
    expect(turn.about).toEqual([50, 25]);
    expect(turn.angle_deg).toBeCloseTo(90, 9);
    expect(dragged('turn', box, [50, 60], [48, 60], true).angle_deg).toBeCloseTo(0, 9);
    expect(dragged('turn', box, [50, 60], [40, 60], true).angle_deg).toBe(15);
  });
});
