import { describe, expect, it } from 'vitest';
import {
  boxOf,
  distance,
  fitted,
  lengthWithin,
  outline,
  toDrawing,
  toScreen,
  zoomed,
  type Outliner,
} from './geometry';

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
    // Also between points, and past a corner.
    expect(lengthWithin(line, 3, { left: 2, right: 6, bottom: -1, top: 1 })).toBeCloseTo(4, 12);
    expect(lengthWithin(line, 3, { left: 9, right: 12, bottom: -1, top: 3 })).toBeCloseTo(4, 12);
    expect(lengthWithin(line, 3, { left: 2, right: 6, bottom: 1, top: 3 })).toBe(0);
    expect(boxOf(new Float64Array(), 3)).toBeUndefined();
  });
});

/** How often a point lies within the loops of an outline, by the nonzero rule; curves as lines. */
function winding(rows: number[], px: number, py: number): number {
  let [turns, x, y, x0, y0] = [0, 0, 0, 0, 0];
  const line = (nx: number, ny: number): void => {
    const side = (nx - x) * (py - y) - (px - x) * (ny - y);
    if (y <= py && ny > py && side > 0) turns += 1;
    if (y > py && ny <= py && side < 0) turns -= 1;
    [x, y] = [nx, ny];
  };
  const to: Outliner = {
    moveTo: (nx, ny) => {
      [x, y, x0, y0] = [nx, ny, nx, ny];
    },
    lineTo: line,
    quadraticCurveTo: (cx, cy, nx, ny) => {
      const [ax, ay] = [x, y];
      for (let t = 0.125; t <= 1; t += 0.125)
        line(
          (1 - t) ** 2 * ax + 2 * t * (1 - t) * cx + t * t * nx,
          (1 - t) ** 2 * ay + 2 * t * (1 - t) * cy + t * t * ny,
        );
    },
    arc: (cx, cy, r) => {
      for (let k = 1; k <= 32; k += 1)
        line(cx + r * Math.cos((Math.PI * k) / 16), cy + r * Math.sin((Math.PI * k) / 16));
    },
    closePath: () => line(x0, y0),
  };
  outline(to, Float64Array.from(rows));
  return turns;
}

describe('the outline of a pressed line', () => {
  it('is as wide as the pen was pressed, with round ends', () => {
    const straight = [0, 0, 1, 10, 0, 2, 20, 0, 3, 30, 0, 3];
    expect(winding(straight, 10, 1.8)).toBeGreaterThan(0);
    expect(winding(straight, 10, 2.2)).toBe(0);
    expect(winding(straight, 25, -2.9)).toBeGreaterThan(0);
    expect(winding(straight, 32.9, 0)).toBeGreaterThan(0);
    expect(winding(straight, 33.1, 0)).toBe(0);
    expect(winding([5, 5, 2], 6.5, 5)).toBeGreaterThan(0);
    expect(winding([], 0, 0)).toBe(0);
  });

  it('has no hole along any line: sharp corners, loops, trembling, one place twice', () => {
    let seed = 7;
    const random = (): number => {
      seed = (seed * 16807) % 2147483647;
      return seed / 2147483647;
    };
    for (let n = 0; n < 200; n += 1) {
      const step = n % 2 ? 12 : 1.5;
      const rows: number[] = [];
      let [x, y, heading] = [0, 0, 0];
      for (let i = 0; i < 40; i += 1) {
        rows.push(x, y, 0.6 + 1.6 * random());
        // Mostly on, now and then back the same way.
        heading += random() < 0.1 ? Math.PI * (0.7 + 0.6 * random()) : 1.2 * (random() - 0.5);
        if (random() < 0.95) [x, y] = [x + step * Math.cos(heading), y + step * Math.sin(heading)];
      }
      // The line goes through the middles of its pieces, past the points between; dense points it passes hardly.
      for (let i = 0; i + 3 < rows.length; i += 3) {
        const [px, py, qx, qy] = [rows[i]!, rows[i + 1]!, rows[i + 3]!, rows[i + 4]!];
        if (step === 1.5) expect(winding(rows, px, py), `line ${n}, point ${i / 3}`).not.toBe(0);
        if (px !== qx || py !== qy)
          expect(winding(rows, (px + qx) / 2, (py + qy) / 2), `line ${n}, after point ${i / 3}`).not.toBe(0);
      }
    }
  });
});
