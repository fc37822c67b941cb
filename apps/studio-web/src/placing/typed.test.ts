import { describe, expect, it } from 'vitest';
import { differing, withChanges } from '../making/schema';
import { carryOf } from './typed';

describe('numbers that are typed', () => {
  const about: [number, number, number] = [1, 0, 2];

  it('are metres along the axis or along both, degrees, or times the size', () => {
    expect(carryOf('translate', undefined, '2.5', about)?.by).toEqual([2.5, 0, 0]);
    expect(carryOf('translate', undefined, '2,-3', about)?.by).toEqual([2, 0, -3]);
    expect(carryOf('translate', 'z', '-.5', about)?.by).toEqual([0, 0, -0.5]);
    expect(carryOf('rotate', undefined, '-45', about)).toEqual({
      about,
      by: [0, 0, 0],
      turn_deg: -45,
      scale: 1,
    });
    expect(carryOf('scale', undefined, '1.5', about)?.scale).toBe(1.5);
  });

  it('are refused where they are none, or say nothing', () => {
    for (const [gizmo, axis, text] of [
      ['translate', undefined, '1,2,3'],
      ['translate', 'x', '1,2'],
      ['translate', undefined, '1,'],
      ['rotate', undefined, '--4'],
      ['scale', undefined, '0'],
      ['scale', undefined, '-2'],
      ['scale', undefined, '.'],
    ] as const)
      expect(carryOf(gizmo, axis, text, about), text).toBeUndefined();
  });
});

describe('settings of several plants', () => {
  it('differ where not all are the same, named by JSON pointers', () => {
    const oak = { age: 3, look: { season: 0, color: [1, 2, 3] }, rings: [{ n: 1 }, { n: 2 }] };
    const ash = { age: 3, look: { season: 0.5, color: [1, 9, 3] }, rings: [{ n: 1 }, { n: 4 }] };
    expect(differing(oak, [oak])).toEqual([]);
    expect(differing(oak, [oak, ash])).toEqual(['/look/season', '/look/color/1', '/rings/1/n']);
    expect(
      differing(oak, [
        { ...oak, rings: [] },
        { ...oak, age: null },
      ]),
    ).toEqual(['/age', '/rings']);
    expect(differing({ a: 1 }, [{}])).toEqual(['/a']);
  });

  it('take from another what was changed of it, and nothing else', () => {
    const [before, after] = [
      { a: 1, in: { b: 2, c: 3 }, list: [1] },
      { a: 1, in: { b: 2, c: 7 }, list: [1, 2] },
    ];
    const other = { a: 5, in: { b: 6, c: 3 }, list: [] };
    expect(withChanges(before, after, other)).toEqual({ a: 5, in: { b: 6, c: 7 }, list: [1, 2] });
  });
});
