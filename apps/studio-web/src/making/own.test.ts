import { parse } from 'smol-toml';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { asToml, dropPreset, keepPreset, MOST, ownPresets } from './own';

const spec = { species: 'Quercus', age: null, leaves: { length_m: 0.1, shape: null }, rules: ['a', 'b'] };

const oak = { maker: 'tree', name: 'my oak', spec } as const;

describe("presets of a person's own", () => {
  beforeEach(() => {
    const kept = new Map<string, string>();
    vi.stubGlobal('localStorage', {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => kept.set(key, value),
    });
  });

  it('are kept by their names, and go', () => {
    expect(keepPreset(oak)).toBe(true);
    expect(keepPreset({ ...oak, spec: { ...spec, age: 9 } })).toBe(true);
    expect(ownPresets('tree')).toEqual([{ ...oak, spec: { ...spec, age: 9 } }]);
    dropPreset(oak);
    expect(ownPresets('tree')).toEqual([]);
  });

  it('of other makers have names of their own, and the first ones were of trees', () => {
    keepPreset(oak);
    keepPreset({ maker: 'flower', name: 'my oak', spec: { name: 'a lily' } });
    expect(ownPresets('flower').map((p) => p.spec)).toEqual([{ name: 'a lily' }]);
    dropPreset(oak);
    expect([ownPresets('tree'), ownPresets('flower').length]).toEqual([[], 1]);
    localStorage.setItem('burgeon.presets', JSON.stringify([{ name: 'old', spec }]));
    expect(ownPresets('tree')).toEqual([{ maker: 'tree', name: 'old', spec }]);
  });

  it('are no more than the browser can hold, and what cannot be read is none', () => {
    for (let k = 0; k < MOST; k += 1) keepPreset({ ...oak, name: `oak ${k}` });
    expect(keepPreset({ ...oak, name: 'one more' })).toBe(false);
    expect(keepPreset({ ...oak, name: 'oak 3' })).toBe(true);
    localStorage.setItem('burgeon.presets', '[{"name":3},null,"x"]');
    expect(ownPresets('tree')).toEqual([]);
    localStorage.setItem('burgeon.presets', '{');
    expect(ownPresets('tree')).toEqual([]);
  });

  it('are TOML without what is left to the plant', async () => {
    const text = await asToml({ name: 'my oak', spec });
    expect(parse(text)).toEqual({
      name: 'my oak',
      species: 'Quercus',
      leaves: { length_m: 0.1 },
      rules: ['a', 'b'],
    });
  });
});
