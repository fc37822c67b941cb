import { describe, expect, it } from 'vitest';
import { penOf } from './pen';

describe('the pen', () => {
  it('is that of every sheet unless something is chosen', () => {
    expect(penOf({ color: null, width: null, layer: null, class: null }, 2)).toBeUndefined();
  });

  it('is as wide in the drawing as it is on the screen', () => {
    expect(penOf({ color: '#0a80ff', width: 12, layer: null, class: null }, 0.25)).toEqual({
      color: [10, 128, 255],
      width: 3,
      layer: null,
      class: null,
    });
    expect(penOf({ color: null, width: null, layer: 'petals', class: 'blade' }, 1)).toEqual({
      color: null,
      width: null,
      layer: 'petals',
      class: 'blade',
    });
  });
});
