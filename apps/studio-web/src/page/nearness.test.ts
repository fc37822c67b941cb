import { describe, expect, it } from 'vitest';
import { nearness } from './nearness';

describe('the palette', () => {
  it('finds whole words before letters in order, and nothing else', () => {
    expect(nearness('Front view, as drawn', 'view')).toBe(6);
    expect(nearness('Wireframe', 'wfr')).toBeGreaterThan(99);
    expect(nearness('Show the whole plant', 'swp')).toBeGreaterThan(99);
    expect(nearness('Show the whole plant', 'shopl')).toBeGreaterThan(99);
    expect(nearness('Wireframe', 'zebra')).toBeUndefined();
    expect(nearness('骨架', '架')).toBe(1);
    expect(nearness('anything', '')).toBe(0);
  });

  it('does not find a command by letters from anywhere', () => {
    expect(nearness('Close: start empty, forget the history', 'layer')).toBeUndefined();
    expect(nearness('Close: start empty, forget the history', 'csef')).toBeGreaterThan(99);
  });
});
