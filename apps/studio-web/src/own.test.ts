import { parse } from 'smol-toml';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { asToml, dropPreset, keepPreset, MOST, ownPresets } from './own';

const spec = { species: 'Quercus', age: null, leaves: { length_m: 0.1, shape: null }, rules: ['a', 'b'] };

describe("presets of a person's own", () => {
  beforeEach(() => {
    const kept = new Map<string, string>();
    vi.stubGlobal('localStorage', {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => kept.set(key, value),
    });
  });

  it('are kept by their names, and go', () => {
    expect(keepPreset('my oak', spec)).toBe(true);
    expect(keepPreset('my oak', { ...spec, age: 9 })).toBe(true);
    expect(ownPresets()).toEqual([{ name: 'my oak', spec: { ...spec, age: 9 } }]);
    dropPreset('my oak');
    expect(ownPresets()).toEqual([]);
  });

  it('are no more than the browser can hold, and what cannot be read is none', () => {
    for (let k = 0; k < MOST; k += 1) keepPreset(`oak ${k}`, spec);
    expect(keepPreset('one more', spec)).toBe(false);
    expect(keepPreset('oak 3', spec)).toBe(true);
    localStorage.setItem('burgeon.presets', '[{"name":3},null,"x"]');
    expect(ownPresets()).toEqual([]);
    localStorage.setItem('burgeon.presets', '{');
    expect(ownPresets()).toEqual([]);
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
