import { describe, expect, it } from 'vitest';
import { type Seen, turnedBy } from './turned';

const leaf: Seen = { class: 'blade', organ: 'leaf' };
const petal: Seen = { class: 'blade', organ: 'petal' };
const stem: Seen = { class: 'axis', organ: 'branch' };

describe('strokes that another one turned', () => {
  const before = new Map([
    [1, stem],
    [2, leaf],
  ]);
  const after = new Map([
    [1, stem],
    [2, petal],
    [3, petal],
  ]);

  it('are those that became something else when one was added', () => {
    expect(turnedBy(before, after, [])).toEqual([{ id: 2, from: leaf, to: petal }]);
    expect(turnedBy(before, new Map([...before, [3, petal]]), [])).toEqual([]);
  });

  it('are told until something else happens', () => {
    const told = turnedBy(before, after, []);
    expect(turnedBy(after, after, told)).toEqual(told);
    expect(turnedBy(after, new Map([...after, [2, leaf]]), told)).toEqual([]);
    // Undone, or another drawing.
    expect(turnedBy(after, before, told)).toEqual([]);
    expect(turnedBy(after, new Map([[9, stem]]), told)).toEqual([]);
  });
});
