import { beforeEach, describe, expect, it, vi } from 'vitest';
import { dropPen, keepPen, keptPen, laterPen, type UnderPen } from './lastpen';

const pen = (after: number, numbers: readonly number[]): UnderPen => ({
  after,
  requests: [{ kind: 'stroke', mode: 'parts', samples: Float64Array.from(numbers) }],
});

describe('the last stroke', () => {
  beforeEach(() => {
    const kept = new Map<string, string>();
    vi.stubGlobal('localStorage', {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => kept.set(key, value),
      removeItem: (key: string) => kept.delete(key),
    });
  });

  it('comes back with what is not known of it', () => {
    keepPen('a', pen(3, [0.1, 2, 7, NaN]));
    expect(keptPen('a')).toEqual(pen(3, [0.1, 2, 7, NaN]));
    expect(keptPen('b')).toBeUndefined();
    dropPen('a');
    expect(keptPen('a')).toBeUndefined();
    localStorage.setItem('burgeon.pen.a', '{');
    expect(keptPen('a')).toBeUndefined();
  });

  it('is the later one of two', () => {
    const [old, short, long] = [pen(1, [1, 2, 3]), pen(2, [1]), pen(2, [1, 2])];
    expect(laterPen(old, short)).toBe(short);
    expect(laterPen(short, long)).toBe(long);
    expect(laterPen(long, short)).toBe(long);
    expect(laterPen(undefined, old)).toBe(old);
    expect(laterPen(undefined, undefined)).toBeUndefined();
  });

  it('does not take the room of all settings', () => {
    keepPen('a', pen(1, Array<number>(1 << 18).fill(0.5)));
    expect(keptPen('a')).toBeUndefined();
  });
});
