/** A request -> the core -> columns. */
import { refusedBy } from './errors.js';
import type { Answer, Asking, PartArrays } from './protocol.js';
import type { PlantView } from './wire.js';

/** What was made, in the memory of the core. */
interface Made {
  view(): string;
  measures(): string;
  column(level: number, part: number, name: string): Float32Array;
  indices(level: number, part: number): Uint32Array;
  pieces(level: number, part: number): Int32Array;
  organs(level: number): Float32Array;
  numbers(name: string): Float64Array;
  handles(name: string): Int32Array;
  texture(row: number): Uint8Array;
  take_file(extension: string): Uint8Array;
  free(): void;
}

/** A built core; the small one makes trees alone. */
export interface Core {
  grow(asked: string, seed: bigint): Made;
  schema(maker: string): string;
  sketch?(asked: string, file: Uint8Array, points: Float64Array, counts: Uint32Array, seed: bigint): Made;
  leaf?(asked: string, seed: bigint): Made;
  bloom?(asked: string, seed: bigint): Made;
}

/** Does what is asked; throws what `refusedBy` makes of errors. */
export function work(core: Core, asking: Asking): Answer | string {
  try {
    if (asking.kind === 'schema') return core.schema(asking.asked);
    const made = make(core, asking);
    try {
      return answer(made, asking);
    } finally {
      made.free();
    }
  } catch (e) {
    throw refusedBy(e);
  }
}

function make(core: Core, { kind, asked, seed, file, points, counts }: Asking): Made {
  if (kind === 'grow') return core.grow(asked, seed);
  const made =
    kind === 'sketch'
      ? core.sketch?.(
          asked,
          file ?? new Uint8Array(),
          points ?? new Float64Array(),
          counts ?? new Uint32Array(),
          seed,
        )
      : kind === 'leaf'
        ? core.leaf?.(asked, seed)
        : core.bloom?.(asked, seed);
  if (!made) throw new Error(`burgeon/growth makes trees alone: import burgeon for ${kind}`);
  return made;
}

function answer(made: Made, { asked, measures }: Asking): Answer {
  const view = JSON.parse(made.view()) as PlantView;
  const part = (level: number, i: number): PartArrays => ({
    positions: made.column(level, i, 'positions'),
    normals: made.column(level, i, 'normals'),
    uvs: made.column(level, i, 'uvs'),
    colors: made.column(level, i, 'colors'),
    wind: made.column(level, i, 'wind'),
    pivots: made.column(level, i, 'pivots'),
    indices: made.indices(level, i),
    pieces: made.pieces(level, i),
  });
  const wanted = (JSON.parse(asked) as { common: { files?: string[] } }).common.files ?? [];
  return {
    view,
    levels: view.levels.map(({ parts }, level) => parts.map((_, i) => part(level, i))),
    organs: view.levels.map((_, level) => made.organs(level)),
    textures: view.textures.map((_, row) => made.texture(row)),
    tables: {
      nodes: {
        position: made.numbers('position'),
        radius: made.numbers('radius'),
        axis: made.handles('node_axis'),
      },
      axes: {
        part: made.handles('axis_part'),
        order: made.handles('axis_order'),
        bearer: made.handles('axis_bearer'),
        first: made.handles('axis_first'),
        end: made.handles('axis_end'),
      },
      organs: {
        part: made.handles('organ_part'),
        bearer: made.handles('organ_bearer'),
        flower: made.handles('organ_flower'),
      },
    },
    files: Object.fromEntries(wanted.map((extension) => [extension, made.take_file(extension)])),
    measures: measures ? made.measures() : '',
  };
}

/** Every buffer of an answer: they are moved, not copied, to the page. */
export function buffers(answer: Answer | string): ArrayBuffer[] {
  if (typeof answer === 'string') return [];
  const { levels, organs, textures, tables, files } = answer;
  const columns = [
    ...levels.flat().flatMap((part) => Object.values(part) as ArrayBufferView[]),
    ...organs,
    ...textures,
    ...Object.values(tables).flatMap((table) => Object.values(table) as ArrayBufferView[]),
    ...Object.values(files),
  ];
  return [...new Set(columns.map((column) => column.buffer as ArrayBuffer))];
}
