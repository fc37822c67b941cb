import { expect, test } from 'vitest';
import { reaches, type Seen, staleOf } from './stale';

const at = (id: number, x: number, more: Partial<Seen> = {}): Seen => ({
  id,
  mode: 'parts',
  points: new Float64Array(3),
  box: { left: x, right: x + 1, bottom: 0, top: 1 },
  color: undefined,
  width: undefined,
  ...more,
});

test('one stroke more, or less, is drawn alone', () => {
  const [a, b, c] = [at(1, 0), at(2, 5), at(3, 9)];
  expect(staleOf([a, b], [a, b])).toBeUndefined();
  expect(staleOf([a, b], [a, b, c])).toEqual(c.box);
  expect(staleOf([a, b, c], [a, c])).toEqual(b.box);
  expect(staleOf([a, c], [a, b, c])).toEqual(b.box);
});

test('a stroke that moved is drawn where it was and where it is', () => {
  const [a, b] = [at(1, 0), at(2, 5)];
  expect(staleOf([a, b], [a, at(2, 7)])).toEqual({ left: 5, right: 8, bottom: 0, top: 1 });
  expect(staleOf([a, b], [a, { ...b, color: 'red' }])).toEqual(b.box);
  // Where its wide line was, and is no more.
  const wide = staleOf([a, { ...b, width: 10 }], [a, b]);
  expect(wide).toEqual({ left: -4, right: 15, bottom: -9, top: 10 });
});

test('another order is another picture', () => {
  const [a, b, c] = [at(1, 0), at(2, 5), at(3, 9)];
  expect(staleOf([a, b, c], [b, a, c])).toBe('all');
  expect(staleOf([a, b], [b, c, a])).toBe('all');
});

test('a thick line reaches farther than its middle', () => {
  const box = { left: 0, right: 1, bottom: 0, top: 1 };
  const beside = { left: 2, right: 3, bottom: 0, top: 1 };
  expect(reaches(box, beside, 0.5)).toBe(false);
  expect(reaches(box, beside, 1)).toBe(true);
});
