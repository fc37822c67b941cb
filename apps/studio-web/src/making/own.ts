/** Presets of a person's own: settings of plants that this browser keeps; specs travel as TOML files, too. */
import type { Fields } from './form';
import { setSetting, setting } from '../keeping/store';
import type { MakerWord } from '../wire';

export interface OwnPreset {
  /** Of what kind of plant. */
  maker: MakerWord;
  name: string;
  spec: Fields;
}

/** The browser gives a page some megabytes for small settings: a spec has a few kilobytes. */
export const MOST = 100;

/** Those for plants of one kind. */
export const ownPresets = (maker: MakerWord): OwnPreset[] => all().filter((p) => p.maker === maker);

function all(): OwnPreset[] {
  try {
    const kept: unknown = JSON.parse(setting('presets') ?? '[]');
    // The first ones were of trees alone, and do not say so.
    return Array.isArray(kept) ? kept.filter(isPreset).map((p) => ({ ...p, maker: p.maker ?? 'tree' })) : [];
  } catch {
    // What another program wrote there is nobody's preset.
    return [];
  }
}

function isPreset(x: unknown): x is OwnPreset {
  const { name, spec } = (x ?? {}) as Partial<OwnPreset>;
  return typeof name === 'string' && typeof spec === 'object' && spec !== null && !Array.isArray(spec);
}

const same = (a: OwnPreset) => (b: OwnPreset) => a.maker === b.maker && a.name === b.name;

/** Keeps a preset, in the place of one of the same name; false if there are too many. */
export function keepPreset(preset: OwnPreset): boolean {
  const presets = all();
  const row = presets.findIndex(same(preset));
  if (row < 0 && presets.length >= MOST) return false;
  if (row < 0) presets.push(preset);
  else presets[row] = preset;
  setSetting('presets', JSON.stringify(presets));
  return all().some(same(preset));
}

export function dropPreset(preset: OwnPreset): void {
  const is = same(preset);
  setSetting('presets', JSON.stringify(all().filter((p) => !is(p))));
}

/** Files of specs are read of these alone. */
export const hasFile = (maker: MakerWord): boolean => maker === 'tree' || maker === 'flower';

/** The spec as `burgeon grow`, `burgeon bloom` and this page read it: what is left to the plant stands in no TOML. */
export async function asToml({ name, spec }: Pick<OwnPreset, 'name' | 'spec'>): Promise<string> {
  const { stringify } = await import('smol-toml');
  return `${stringify({ ...said(spec), name })}\n`;
}

function said(value: Fields): Fields {
  return Object.fromEntries(
    Object.entries(value).flatMap(([key, x]) => (x === null ? [] : [[key, inner(x)]])),
  ) as Fields;
}

function inner(x: Fields[string]): Fields[string] {
  if (Array.isArray(x)) return x.map((y) => inner(y));
  return typeof x === 'object' && x !== null ? said(x as Fields) : x;
}
