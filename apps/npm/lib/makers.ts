/** What is asked for -> plants. The same specs, ranges and defaults as the command line has. */
import type { Engine } from './engine.js';
import { unknown, wrong } from './errors.js';
import { findThree, Plant } from './plant.js';
import type { Answer, Asking } from './protocol.js';
import type { FLOWERS, FlowerSpec, LeafSpec, SketchSpec, SkinSpec, TREES, TreeSpec } from './spec.js';
import type { Asked, FlowerAsked, Json, LeafAsked, SketchAsked, TreeAsked } from './wire.js';

/** Fields that may be left out, at any depth. */
export type Fields<T> = T extends readonly unknown[]
  ? T
  : T extends object
    ? { readonly [K in keyof T]?: Fields<T[K]> }
    : T;

/** A species of a tree; other words are refused with a list of those that there are. */
export type Tree = (typeof TREES)[number] | (string & {});
/** A species of a flower. */
export type Flower = (typeof FLOWERS)[number] | (string & {});

/** What all makers take. */
export interface Common {
  /** A whole number from 0 to 2^64 - 1. Default 1. */
  readonly seed?: number | bigint;
  /** Columns that say how wind moves each vertex. Default true. */
  readonly wind?: boolean;
  /** Coarser copies to make as well, 0 to 6; `object3D` is a `THREE.LOD` then. Default 0, or what `engine` wants. */
  readonly lods?: number;
  /** The program that a file `glb` is for: `three`, `blender`, `unity`, `unreal` or `godot` (docs/engines). */
  readonly engine?: string;
  /** Most triangles of the plant, 100 or more: it becomes the first level of detail within it. */
  readonly triangles?: number;
  /** Most megabytes of the file `glb`, which `files` must name, 0.001 to 4000: textures become smaller first, then the plant
   * becomes the first level of detail that fits. What was reduced is among the report's warnings. */
  readonly megabytes?: number;
  /** How many times the usual limits may be exceeded, 1 to 4. Default 1. */
  readonly budget?: number;
  /** Files to write as well. */
  readonly files?: readonly ('glb' | 'mtg' | 'opf')[];
  /** Whether `plant.measures` is wanted. Default false. */
  readonly measures?: boolean;
  /** Stops it. */
  readonly signal?: AbortSignal;
}

/** How drawings and trees are meshed: fineness (`detail`, 0.1 to 8), `sides`, `textures`. */
export interface SkinFields extends Fields<Pick<SkinSpec, 'detail' | 'sides' | 'textures'>> {
  /** Pixels of a side of the textures of bark, and of the length of those of leaves, 64 to 4096. Default 512. */
  readonly texture_size?: number;
}

/** Fields of a tree, by which those of the species are replaced. */
export interface GrowOptions extends Common, SkinFields {
  /** Scales the wood to this height, metres, at whatever age. */
  readonly height_m?: number;
  /** Grows to this height, metres, within what the species reaches: at the age that comes nearest, and scaled by the rest. */
  readonly height?: number;
  /** Grows to this diameter of the stem at 1.3 m, metres, in the same way. */
  readonly dbh?: number;
  /** Gets a coarse copy of a large tree as soon as it has grown, without textures, files and wind; the tree itself comes
   * later, the same as without it. A small tree comes at once, and there is no copy. */
  readonly first?: (coarse: Plant) => void;
  /** Fields of its spec: `{ age: 30, leaves: { leaf_keep: 0.5 } }`. */
  readonly fields?: Fields<TreeSpec>;
}

export interface SketchOptions extends Common, SkinFields {
  /** Its name; the extension tells the format of a file. Default `drawing`. */
  readonly name?: string;
  /** Whether y points up in strokes; on a screen it points down. Default true. */
  readonly yUp?: boolean;
  /** What strokes are, by number, such as `{ 0: 'axis' }`. */
  readonly classes?: Readonly<Record<number, string>>;
  /** Its flowers open: the day, 0 to 100. */
  readonly day?: number;
  readonly fields?: Fields<SketchSpec>;
}

export interface LeafOptions extends Common {
  readonly name?: string;
  readonly fields?: Fields<LeafSpec>;
}

export interface BloomOptions extends Common {
  /** 0 is the bud; default full bloom. */
  readonly day?: number;
  readonly fields?: Fields<FlowerSpec>;
}

/** Strokes of points [x, y], or of x and y one after another. */
export type Strokes = readonly (readonly (readonly [number, number])[] | Float32Array | Float64Array)[];

/** What makes plants. */
export interface Makers {
  /** A tree of a species, of fields alone, or of the text of a TOML file (`burgeon grow`). */
  grow(tree: Tree | { readonly toml: string } | null, options?: GrowOptions): Promise<Plant>;
  /** The plant of a drawing: the bytes or the text of a file, or strokes (`burgeon sketch`). */
  sketch(drawing: Strokes | Uint8Array | ArrayBuffer | string, options?: SketchOptions): Promise<Plant>;
  /** A leaf of numbers, or of the text of a file of marks or veins (`burgeon leaf`). */
  leaf(text?: string | null, options?: LeafOptions): Promise<Plant>;
  /** A flower on a day (`burgeon bloom run`). */
  bloom(flower?: Flower | { readonly toml: string } | null, options?: BloomOptions): Promise<Plant>;
  /** The JSON Schema of what a maker can be asked for: meaning, unit (`x-unit`), range and default of each field. */
  schema(maker: 'tree' | 'sketch' | 'leaf' | 'flower' | 'skin'): Promise<Record<string, Json>>;
  /** Gives back the memory of the core; the next request starts it again. */
  close(): void;
}

const SKIN = ['detail', 'sides', 'textures'] as const;

const COMMON = [
  'seed',
  'wind',
  'lods',
  'engine',
  'triangles',
  'megabytes',
  'budget',
  'files',
  'measures',
  'signal',
  'fields',
] as const;

/** `more`: the options that not all makers have. */
function common(options: Common & SkinFields & { readonly fields?: object }, more: readonly string[]): Asked {
  if (typeof options !== 'object' || options === null || Array.isArray(options))
    throw wrong('options', options, 'an object of options');
  if (options.files !== undefined && !Array.isArray(options.files))
    throw wrong('files', options.files, "a list of 'glb', 'mtg', 'opf'");
  const all = [...COMMON, ...more];
  const strange = Object.keys(options).find((name) => !all.includes(name));
  if (strange !== undefined) throw unknown(strange, all);
  if (options.textures === false && options.texture_size !== undefined)
    throw wrong('texture_size', options.texture_size, 'left out where textures are');
  const skin: Record<string, Json> = {};
  for (const name of SKIN) if (options[name] !== undefined) skin[name] = options[name] as Json;
  return {
    fields: (options.fields ?? {}) as Record<string, Json>,
    skin: {
      wind: options.wind ?? true,
      fields: skin,
      texture_size:
        options.texture_size === undefined ? null : whole('texture_size', options.texture_size, 4096),
    },
    lods: options.lods === undefined ? null : whole('lods', options.lods, 6),
    engine: options.engine ?? null,
    triangles:
      options.triangles === undefined ? null : whole('triangles', options.triangles, MOST_TRIANGLES, 100),
    megabytes: options.megabytes ?? null,
    ...(options.budget === undefined ? {} : { budget: options.budget }),
    files: [...(options.files ?? [])],
  };
}

const MOST_TRIANGLES = 4e9;

function whole(name: string, value: number, most: number, least = 0): number {
  if (!Number.isInteger(value) || value < least || value > most)
    throw wrong(name, value, `a whole number, ${least} to ${most}`);
  return value;
}

function seedOf(seed: number | bigint = 1): bigint {
  const whole = typeof seed === 'bigint' || Number.isSafeInteger(seed) ? BigInt(seed) : -1n;
  if (whole < 0n || whole >= 1n << 64n) throw wrong('seed', seed, 'a whole number, 0 to 2^64 - 1');
  return whole;
}

/** What has no JSON would be taken for something that was left out, or end in an error without a name. */
function text(asked: object): string {
  return JSON.stringify(asked, (key, value: unknown) => {
    if (typeof value === 'number' && !Number.isFinite(value)) throw wrong(key, value, 'a finite number');
    if (typeof value === 'bigint' || typeof value === 'symbol' || typeof value === 'function')
      throw wrong(key, value, 'a number, a text, a list or an object');
    return value;
  });
}

/** One point after another, y upwards, and how many each stroke has. */
function points(strokes: Strokes, yUp: boolean): { points: Float64Array; counts: Uint32Array } {
  if (!Array.isArray(strokes)) throw wrong('drawing', strokes, 'a file, or a list of strokes');
  const flat = (strokes as Strokes).map((stroke, row) => {
    if (!Array.isArray(stroke) && !(stroke instanceof Float32Array || stroke instanceof Float64Array))
      throw wrong(`strokes[${row}]`, stroke, 'a list of points, or an array of numbers');
    const numbers = ArrayBuffer.isView(stroke) ? Array.from(stroke as Float64Array) : stroke.flat();
    if (numbers.length % 2 !== 0)
      throw wrong(`strokes[${row}]`, `${numbers.length} numbers`, 'pairs of x and y');
    const odd = numbers.findIndex((x) => !Number.isFinite(x));
    if (odd >= 0) throw wrong(`strokes[${row}][${odd >> 1}]`, numbers[odd], 'a finite number');
    return numbers;
  });
  const counts = Uint32Array.from(flat, (numbers) => numbers.length / 2);
  const all = Float64Array.from(flat.flat());
  if (!yUp) for (let k = 1; k < all.length; k += 2) all[k] = -all[k]!;
  return { points: all, counts };
}

/** The makers of a core. */
export function makers(engine: Engine): Makers {
  const make = async (
    asking: Omit<Asking, 'seed' | 'measures'>,
    options: Common & Pick<GrowOptions, 'first'>,
  ): Promise<Plant> => {
    const { first } = options;
    if (first !== undefined && typeof first !== 'function') throw wrong('first', first, 'a function');
    const full: Asking = {
      ...asking,
      seed: seedOf(options.seed),
      measures: options.measures ?? false,
      first: first !== undefined,
    };
    let shown = Promise.resolve();
    const look = (coarse: Answer): void => {
      shown = findThree().then(() => first?.(new Plant(coarse)));
      // What it throws is told at the end.
      shown.catch(() => {});
    };
    const [answer] = await Promise.all([engine.ask(full, options.signal, look), findThree()]);
    await shown;
    if (typeof answer === 'string') throw new Error('a plant was asked for');
    return new Plant(answer);
  };
  return {
    async grow(tree, options = {}) {
      const asked: TreeAsked = {
        common: common(options, [...SKIN, 'texture_size', 'height_m', 'height', 'dbh', 'first']),
        preset: typeof tree === 'string' ? tree : null,
        toml: typeof tree === 'object' && tree ? tree.toml : null,
        height_m: options.height_m ?? null,
        height: options.height ?? null,
        dbh: options.dbh ?? null,
      };
      return make({ kind: 'grow', asked: text(asked) }, options);
    },
    async sketch(drawing, options = {}) {
      const bytes =
        typeof drawing === 'string'
          ? new TextEncoder().encode(drawing)
          : drawing instanceof ArrayBuffer
            ? new Uint8Array(drawing)
            : drawing instanceof Uint8Array
              ? drawing
              : undefined;
      if (bytes && options.yUp !== undefined)
        throw wrong('yUp', options.yUp, 'left out: a file says itself where up is');
      if (bytes && bytes.length === 0) throw wrong('drawing', '0 bytes', 'a file, or strokes');
      const asked: SketchAsked = {
        common: common(options, [...SKIN, 'texture_size', 'name', 'yUp', 'classes', 'day']),
        name: options.name ?? 'drawing',
        classes: { ...options.classes },
        day: options.day ?? null,
      };
      const ink = bytes ? { file: bytes } : points(drawing as Strokes, options.yUp ?? true);
      return make({ kind: 'sketch', asked: text(asked), ...ink }, options);
    },
    async leaf(file = '', options = {}) {
      const asked: LeafAsked = {
        common: common(options, ['name']),
        name: options.name ?? null,
        text: file ?? '',
      };
      return make({ kind: 'leaf', asked: text(asked) }, options);
    },
    async bloom(flower = 'lily', options = {}) {
      const asked: FlowerAsked = {
        common: common(options, ['day']),
        preset: typeof flower === 'string' ? flower : null,
        toml: typeof flower === 'object' && flower ? flower.toml : null,
        day: options.day ?? null,
      };
      return make({ kind: 'bloom', asked: text(asked) }, options);
    },
    async schema(maker) {
      const answer = await engine.ask({ kind: 'schema', asked: maker, seed: 0n, measures: false });
      return JSON.parse(answer as string) as Record<string, Json>;
    },
    close: () => engine.close(),
  };
}
