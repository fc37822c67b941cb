import { describe, expect, it } from 'vitest';
import { arranged } from './align';
import { isWithin, shareWithin } from './geometry';
import { joined, meeting } from './snap';
import { straightened } from './straighten';
import { copiesOf } from './symmetry';
import { Taps } from './taps';

type Point = readonly [number, number];

/** Rows of a pen: a point every ten milliseconds. */
const inked = (points: readonly Point[]): Float64Array =>
  Float64Array.from(points.flatMap(([x, y], i) => [x, y, 10 * i, 0.5]));

const drawn = (count: number, at: (share: number) => Point): Float64Array =>
  inked(Array.from({ length: count }, (_, i) => at(i / (count - 1))));

const pointsOf = (samples: Float64Array): [number, number][] =>
  Array.from({ length: samples.length / 4 }, (_, i) => [samples[4 * i]!, samples[4 * i + 1]!]);

/** A hand that trembles, the same each time. */
const tremble = (i: number, by: number): number => by * Math.sin(12.9898 * i * i + 4.1);

/** A part of an ellipse, as a hand draws it. */
const round = (a: number, b: number, from: number, to: number, tilt = 0, by = 0): Float64Array =>
  drawn(60, (s) => {
    const angle = from + s * (to - from);
    const [u, v] = [a * Math.cos(angle) + tremble(s * 59, by), b * Math.sin(angle) + tremble(s * 59 + 7, by)];
    return [300 + u * Math.cos(tilt) - v * Math.sin(tilt), 200 + u * Math.sin(tilt) + v * Math.cos(tilt)];
  });

describe('a figure that a hand meant', () => {
  it('is a line between the ends of one that trembles', () => {
    const line = straightened(drawn(40, (s) => [100 * s, 50 * s + tremble(s * 39, 1)]))!;
    const [first, last] = [pointsOf(line)[0]!, pointsOf(line).at(-1)!];
    for (const [x, y] of pointsOf(line))
      expect((last[0] - first[0]) * (y - first[1])).toBeCloseTo((last[1] - first[1]) * (x - first[0]), 9);
    // Times and pressures are the hand's.
    expect([line[2], line.at(-2), line.at(-1)]).toEqual([0, 390, 0.5]);
  });

  it('is an arc through the ends of a bow, on its own side, also a long one', () => {
    for (const [from, to] of [
      [0.3, 2],
      [2, 0.3],
      [-2.4, 2.2],
      [3, 6],
    ] as const) {
      const hand = round(80, 80, from, to, 0, 1.5);
      const arc = pointsOf(straightened(hand)!);
      const ends = pointsOf(hand);
      for (const [a, b] of [
        [arc[0]!, ends[0]!],
        [arc.at(-1)!, ends.at(-1)!],
      ] as const)
        expect(Math.hypot(a[0] - b[0], a[1] - b[1])).toBeLessThan(1e-9);
      for (const [x, y] of arc) expect(Math.abs(Math.hypot(x - 300, y - 200) - 80)).toBeLessThan(4);
    }
  });

  it('is a circle or an ellipse round what closes, closed and the same way round', () => {
    for (const way of [1, -1]) {
      const circle = pointsOf(straightened(round(70, 66, 1, 1 + way * 6.2, 0, 2))!);
      const middle = circle.slice(1).reduce(([x, y], p) => [x + p[0] / 48, y + p[1] / 48], [0, 0]);
      const radii = circle.map(([x, y]) => Math.hypot(x - middle[0]!, y - middle[1]!));
      expect(Math.max(...radii) - Math.min(...radii)).toBeLessThan(1e-6);
      expect(radii[0]).toBeCloseTo(68, -0.5);
      expect(circle[0]![0]).toBeCloseTo(circle.at(-1)![0], 9);
      const turn = Math.sign(
        (circle[1]![0] - middle[0]!) * (circle[2]![1] - middle[1]!) -
          (circle[1]![1] - middle[1]!) * (circle[2]![0] - middle[0]!),
      );
      expect(turn).toBe(way);
    }
    const ellipse = pointsOf(straightened(round(90, 40, 0.4, 6.6, 0.5, 1.5))!);
    for (const [x, y] of ellipse) {
      const [dx, dy] = [x - 300, y - 200];
      const u = (dx * Math.cos(0.5) + dy * Math.sin(0.5)) / 90;
      const v = (dy * Math.cos(0.5) - dx * Math.sin(0.5)) / 40;
      expect(Math.abs(Math.hypot(u, v) - 1)).toBeLessThan(0.06);
    }
  });

  it('is nothing where the hand drew something else', () => {
    const wave = drawn(80, (s) => [200 * s, 40 * Math.sin(9 * s)]);
    const star = drawn(81, (s) => {
      const r = 60 * (1 + 0.5 * Math.sin(5 * 2 * Math.PI * s));
      return [r * Math.cos(2 * Math.PI * s), r * Math.sin(2 * Math.PI * s)];
    });
    const dot = inked([
      [3, 3],
      [3, 3],
      [3, 3],
      [3, 3],
    ]);
    for (const other of [wave, star, dot, inked([]), inked([[1, 2]])])
      expect(straightened(other)).toBeUndefined();
    const back = drawn(40, (s) => [100 * Math.sin(Math.PI * s), 0]);
    expect(straightened(back)).toBeUndefined();
  });
});

describe('symmetry', () => {
  const beside = drawn(5, (s) => [20 + 30 * s, 40 * s]);

  it('repeats a stroke on the other side of a line, unless it crosses that', () => {
    expect(pointsOf(copiesOf({ kind: 'mirror', x: 10 }, beside)[0]!)).toEqual(
      pointsOf(beside).map(([x, y]) => [20 - x, y]),
    );
    expect(copiesOf({ kind: 'mirror', x: 35 }, beside)).toEqual([]);
    expect(copiesOf(undefined, beside)).toEqual([]);
  });

  it('repeats a stroke round a centre by equal turns, with its times and pressures', () => {
    const about: Point = [5, 7];
    const copies = copiesOf({ kind: 'turns', about, count: 6 }, beside);
    expect(copies.length).toBe(5);
    copies.forEach((copy, k) => {
      pointsOf(copy).forEach(([x, y], i) => {
        const [x0, y0] = pointsOf(beside)[i]!;
        expect(Math.hypot(x - 5, y - 7)).toBeCloseTo(Math.hypot(x0 - 5, y0 - 7), 9);
        const turn = Math.atan2(y - 7, x - 5) - Math.atan2(y0 - 7, x0 - 5);
        expect(Math.cos(turn)).toBeCloseTo(Math.cos(((k + 1) * Math.PI) / 3), 9);
        expect(Math.sin(turn)).toBeCloseTo(Math.sin(((k + 1) * Math.PI) / 3), 9);
      });
      expect([copy[2], copy[3], copy[6]]).toEqual([0, 0.5, 10]);
    });
  });

  it('draws what is closed round the centre once', () => {
    const turns = { kind: 'turns', about: [300, 200], count: 8 } as const;
    expect(copiesOf(turns, round(40, 40, 0, 6.1))).toEqual([]);
    expect(copiesOf({ ...turns, about: [400, 200] }, round(40, 40, 0, 6.1)).length).toBe(7);
  });
});

describe('taps of several fingers', () => {
  const tap = (fingers: number, { late = 0, far = 0, kept = true } = {}): number => {
    const taps = new Taps();
    for (let k = 0; k < fingers; k += 1) taps.down(k, [50 * k, 0], 20 * k);
    taps.move(0, [far, 0]);
    let said = 0;
    for (let k = 0; k < fingers; k += 1) said = taps.up(k, 150 + late, kept);
    return said;
  };

  it('are counted once all are lifted, unless they rest, move the sheet or are taken away', () => {
    expect([tap(1), tap(2), tap(3)]).toEqual([0, 2, 3]);
    expect([tap(2, { late: 500 }), tap(2, { far: 30 }), tap(3, { kept: false })]).toEqual([0, 0, 0]);
  });

  it('are none while a pen is at work, and begin anew after it', () => {
    const taps = new Taps();
    taps.down(1, [0, 0], 0);
    taps.down(2, [9, 0], 5);
    taps.forget();
    expect([taps.up(1, 50, true), taps.up(2, 60, true)]).toEqual([0, 0]);
  });
});

describe('strokes in order', () => {
  const box = (left: number, right: number, bottom: number, top: number) => ({ left, right, bottom, top });
  const three = [
    { id: 1, box: box(0, 10, 0, 10) },
    { id: 2, box: box(12, 16, 5, 25) },
    { id: 3, box: box(40, 60, -10, 0) },
  ];

  it('lie on one line', () => {
    expect(arranged(three, 'left')).toEqual([
      [2, [-12, 0]],
      [3, [-40, 0]],
    ]);
    expect(arranged(three, 'right').map(([id, [x]]) => [id, x])).toEqual([
      [1, 50],
      [2, 44],
    ]);
    expect(arranged(three, 'top').map(([id, [, y]]) => [id, y])).toEqual([
      [1, 15],
      [3, 25],
    ]);
    expect(arranged(three, 'bottom').map(([id, [, y]]) => [id, y])).toEqual([
      [1, -10],
      [2, -15],
    ]);
    expect(arranged(three, 'centre').map(([id, [x]]) => [id, x])).toEqual([
      [1, 25],
      [2, 16],
      [3, -20],
    ]);
    expect(arranged(three, 'middle').map(([id, [, y]]) => [id, y])).toEqual([
      [1, 2.5],
      [2, -7.5],
      [3, 12.5],
    ]);
    expect(arranged(three.slice(0, 1), 'left')).toEqual([]);
  });

  it('have the same room between them, and the outermost stay', () => {
    // 60 wide, filled by 34: 13 between any two.
    expect(arranged(three, 'across')).toEqual([[2, [11, 0]]]);
    const upward = new Map(arranged(three, 'upward'));
    expect([...upward]).toEqual([[1, [0, -2.5]]]);
    expect(arranged(three.slice(0, 2), 'across')).toEqual([]);
  });
});

describe('ends of a stroke', () => {
  const lines = [
    { points: Float64Array.of(0, 0, NaN, 100, 0, NaN), box: { left: 0, right: 100, bottom: 0, top: 0 } },
    { points: Float64Array.of(50, 40, NaN, 50, 90, NaN), box: { left: 50, right: 50, bottom: 40, top: 90 } },
  ];

  it('meet an end before a side, and only what is near', () => {
    expect(meeting(lines, [3, 4], 6)).toEqual([0, 0]);
    expect(meeting(lines, [30, 4], 6)).toEqual([30, 0]);
    expect(meeting(lines, [30, 7], 6)).toBeUndefined();
  });

  it('are moved with what is near them, and the middle of the stroke stays', () => {
    const stroke = drawn(21, (s) => [52, 3 + 34 * s]);
    const to = pointsOf(joined(stroke, lines, 6));
    expect([to[0], to.at(-1)]).toEqual([
      [52, 0],
      [50, 40],
    ]);
    expect(to[10]).toEqual(pointsOf(stroke)[10]);
    const far = drawn(21, (s) => [200 + s, 300]);
    expect(joined(far, lines, 6)).toBe(far);
    expect(joined(stroke.subarray(0, 4), lines, 6)).toEqual(stroke.subarray(0, 4));
  });
});

it('a lasso has round it what lies within its outline, however that is bent', () => {
  const bay = [
    [0, 0],
    [10, 0],
    [10, 10],
    [6, 10],
    [6, 3],
    [4, 3],
    [4, 10],
    [0, 10],
  ] as const;
  expect([isWithin(bay, 2, 8), isWithin(bay, 5, 8), isWithin(bay, 5, 1), isWithin(bay, 12, 8)]).toEqual([
    true,
    false,
    true,
    false,
  ]);
  const row = Float64Array.from({ length: 63 }, (_, i) => (i % 3 === 0 ? i / 6 : i % 3 === 1 ? 8 : NaN));
  expect(shareWithin(row, 3, bay)).toBeCloseTo(0.8, 6);
  expect(shareWithin(Float64Array.of(1, 1, NaN), 3, bay)).toBe(1);
});
