import { describe, expect, it } from 'vitest';
import { boxOf, distance, fitted, toDrawing, toScreen, zoomed } from './geometry';

describe('the sheet', () => {
  const v = { scale: 2, x: 100, y: 300 };

  it('maps there and back, y up', () => {
    expect(toScreen(v, 10, 20)).toEqual([120, 260]);
    expect(toDrawing(v, 120, 260)).toEqual([10, 20]);
  });

  it('zooms about a point that stays', () => {
    const before = toDrawing(v, 37, 41);
    expect(toDrawing(zoomed(v, 3.5, 37, 41), 37, 41)[0]).toBeCloseTo(before[0], 12);
    expect(zoomed(v, 1e12, 0, 0).scale).toBe(1e4);
  });

  it('fits a box into the middle', () => {
    const f = fitted({ left: -5, right: 5, bottom: 0, top: 100 }, 400, 400);
    expect(toScreen(f, 0, 50)).toEqual([200, 200]);
    expect(toScreen(f, 0, 100)[1]).toBeCloseTo(48, 9);
    expect(Number.isFinite(fitted({ left: 1, right: 1, bottom: 1, top: 1 }, 400, 400).scale)).toBe(true);
  });

  it('measures distances to polylines and single points', () => {
    const line = Float64Array.of(0, 0, NaN, 10, 0, NaN, 10, 10, NaN);
    expect(distance(line, 3, 5, 2)).toBe(2);
    expect(distance(line, 3, 12, 5)).toBe(2);
    expect(distance(Float64Array.of(3, 4, NaN), 3, 0, 0)).toBe(5);
    expect(boxOf(line, 3)).toEqual({ left: 0, right: 10, bottom: 0, top: 10 });
    expect(boxOf(new Float64Array(), 3)).toBeUndefined();
  });
});
