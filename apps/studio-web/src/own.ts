/** Presets of a person's own: specs of trees that this browser keeps, and that travel as TOML files. */
import type { Fields } from './form';
import { setSetting, setting } from './store';

export interface OwnPreset {
  name: string;
  spec: Fields;
}

/** The browser gives a page some megabytes for small settings: a spec has a few kilobytes. */
export const MOST = 100;

export function ownPresets(): OwnPreset[] {
  try {
    const kept: unknown = JSON.parse(setting('presets') ?? '[]');
    return Array.isArray(kept) ? kept.filter(isPreset) : [];
  } catch {
    // What another program wrote there is nobody's preset.
    return [];
  }
}

function isPreset(x: unknown): x is OwnPreset {
  const { name, spec } = (x ?? {}) as Partial<OwnPreset>;
  return typeof name === 'string' && typeof spec === 'object' && spec !== null && !Array.isArray(spec);
}

/** Keeps a spec under a name, in the place of one of the same name; false if there are too many. */
export function keepPreset(name: string, spec: Fields): boolean {
  const all = ownPresets();
  const same = all.findIndex((p) => p.name === name);
  if (same < 0 && all.length >= MOST) return false;
  if (same < 0) all.push({ name, spec });
  else all[same] = { name, spec };
  setSetting('presets', JSON.stringify(all));
  return ownPresets().some((p) => p.name === name);
}

export function dropPreset(name: string): void {
  setSetting('presets', JSON.stringify(ownPresets().filter((p) => p.name !== name)));
}

/** The spec as `burgeon grow` and this page read it: what is left to the plant stands in no TOML. */
export async function asToml({ name, spec }: OwnPreset): Promise<string> {
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
