import { expect, it } from 'vitest';
import { onPlane, withMove } from './balls';
import { withField } from '../making/schema';

it('moves of one ball add up, and others stay', () => {
  const first = withMove([], { row: 3, mark: 7 }, [0.01, 0, 0], 1);
  const second = withMove(first, { row: 0, mark: 1 }, [0, 0.02, 0], 2);
  const third = withMove(second, { row: 3, mark: 7 }, [0.01, 0, 0.5], 3);
  expect(third).toEqual([
    { row: 3, mark: 7, by_m: [0.02, 0, 0.5], thickness: 3 },
    { row: 0, mark: 1, by_m: [0, 0.02, 0], thickness: 2 },
  ]);
  expect(first).toEqual([{ row: 3, mark: 7, by_m: [0.01, 0, 0], thickness: 1 }]);
  // Within what the core takes.
  expect(withMove(third, { row: 3, mark: 7 }, [0, 0, 0], 1e6)[0]!.thickness).toBe(20);
});

it('a ball stays on the plane on which it was taken', () => {
  const ray = {
    origin: [0, 0, 2],
    direction: [0.6, 0, -0.8],
    forward: [0, 0, -1],
    up: [0, 1, 0],
    pressure: 1,
  };
  expect(onPlane(ray as never, [5, 5, 0.4], [0, 0, -1])).toEqual([1.2, 0, expect.closeTo(0.4)]);
  expect(onPlane({ ...ray, direction: [1, 0, 0] } as never, [0, 0, 0], [0, 0, -1])).toBeUndefined();
});

it('a field in a list leaves the list one', () => {
  const settings = { balls: [{ thickness: 1 }, { thickness: 2 }], curl: 0 };
  expect(withField(settings, ['balls', '1', 'thickness'], 5)).toEqual({
    balls: [{ thickness: 1 }, { thickness: 5 }],
    curl: 0,
  });
});
