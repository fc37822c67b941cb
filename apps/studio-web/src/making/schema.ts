/** JSON Schemas as the core writes them, and the names of their texts. */
import type { Json } from '../wire';

export interface Schema {
  $ref?: string;
  $defs?: Record<string, Schema>;
  type?: string | string[];
  description?: string;
  default?: Json;
  minimum?: number;
  maximum?: number;
  'x-unit'?: string;
  /** Set by `named`: what the description is called in tables of texts. */
  'x-help'?: string;
  enum?: Json[];
  const?: Json;
  oneOf?: Schema[];
  anyOf?: Schema[];
  properties?: Record<string, Schema>;
  required?: string[];
  items?: Schema | boolean;
}

/** The word of one of several forms: what its tag, or it itself, is. */
function formOf(s: Schema): string {
  const tag = Object.values(s.properties ?? {}).find((p) => p.const !== undefined);
  return String(s.const ?? tag?.const ?? s.enum?.join('-') ?? '');
}

/**
 * Names the text of every part of a schema by where it stands: `tree.clearance_m`, and for what is defined once and used
 * in several places `tree.CompetitionSpec.kill_m`, `tree.Envelope.sphere.radius_m`, `tree.Bark.birch`.
 */
export function named(schema: Schema, path: string, root = path): Schema {
  if (schema.description !== undefined) schema['x-help'] = path;
  for (const [name, field] of Object.entries(schema.properties ?? {})) named(field, `${path}.${name}`, root);
  for (const [name, part] of Object.entries(schema.$defs ?? {})) named(part, `${root}.${name}`, root);
  for (const form of schema.oneOf ?? []) named(form, `${path}.${formOf(form)}`, root);
  for (const form of schema.anyOf ?? []) named(form, path, root);
  if (typeof schema.items === 'object') named(schema.items, `${path}.items`, root);
  return schema;
}

/** What other panels ask for: what a drawing is read as, one flower, an animation. */
const ELSEWHERE = ['read_as', 'flipped_flowers', 'steady_m'];

/** The schema of a drawing with that of its surface as its field `skin`, without what other panels ask for. */
export function drawingSchema(sketch: Schema, skin: Schema): Schema {
  const { $defs, ...surface } = skin;
  const shown = (fields: Record<string, Schema> = {}): Record<string, Schema> =>
    Object.fromEntries(Object.entries(fields).filter(([name]) => !ELSEWHERE.includes(name)));
  const { Kind: _, ...parts } = { ...sketch.$defs, ...$defs };
  return {
    ...sketch,
    $defs: parts,
    properties: { ...shown(sketch.properties), skin: { ...surface, properties: shown(skin.properties) } },
  };
}

/** A copy with another value at the end of a way into it. */
export function withField<T extends object>(settings: T, [key, ...rest]: string[], value: Json): T {
  const inner = (settings as Record<string, unknown>)[key!];
  const now = rest.length > 0 ? withField(inner as object, rest, value) : value;
  // A list stays one.
  if (Array.isArray(settings)) return settings.with(Number(key), now) as unknown as T;
  return { ...settings, [key!]: now };
}

const isFields = (value: unknown): value is Record<string, Json> =>
  typeof value === 'object' && value !== null && !Array.isArray(value);
const isSame = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** The JSON pointers of what is not the same in all of some values. */
export function differing(
  first: Json | undefined,
  others: readonly (Json | undefined)[],
  path = '',
): string[] {
  if (others.every((other) => isSame(first, other))) return [];
  const all = [first, ...others];
  const inner = (key: string): string[] => {
    const [one, ...rest] = all.map((x) => (x as Record<string, Json>)[key]);
    return differing(one, rest, `${path}/${key}`);
  };
  if (all.every(isFields)) return [...new Set(all.flatMap((x) => Object.keys(x)))].flatMap(inner);
  if (Array.isArray(first) && all.every((x) => Array.isArray(x) && x.length === first.length))
    return Object.keys(first).flatMap(inner);
  return [path];
}

/** Other settings with what was changed of some: from `before` to `after`. */
export function withChanges<T extends object>(before: T, after: T, other: T): T {
  const [was, is, has] = [before, after, other] as Record<string, unknown>[];
  const changed = Object.keys(is!).filter((key) => !isSame(was![key], is![key]));
  const of = (key: string): unknown => {
    const [a, b, c] = [was![key], is![key], has![key]];
    return isFields(a) && isFields(b) && isFields(c) ? withChanges(a, b, c) : b;
  };
  return { ...other, ...Object.fromEntries(changed.map((key) => [key, of(key)])) };
}
