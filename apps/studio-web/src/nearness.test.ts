import { describe, expect, it } from 'vitest';
import { nearness } from './nearness';

describe('the palette', () => {
  it('finds whole words before letters in order, and nothing else', () => {
    expect(nearness('Front view, as drawn', 'view')).toBe(6);
    expect(nearness('Wireframe', 'wfr')).toBeGreaterThan(99);
    expect(nearness('Wireframe', 'zebra')).toBeUndefined();
    expect(nearness('骨架', '架')).toBe(1);
    expect(nearness('anything', '')).toBe(0);
  });
});
