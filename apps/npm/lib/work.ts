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
  file_names(): string[];
  take_file(name: string): Uint8Array;
  free(): void;
}

/** A tree that is asked for. */
interface Growing {
  first(): Made | undefined;
  /** Frees it, too. */
  whole(): Made;
  free(): void;
}

/** A built core; the small one makes trees alone. */
export interface Core {
  grow(asked: string, seed: bigint): Growing;
  schema(maker: string): string;
  sketch?(asked: string, file: Uint8Array, points: Float64Array, counts: Uint32Array, seed: bigint): Made;
  leaf?(asked: string, seed: bigint): Made;
  bloom?(asked: string, seed: bigint): Made;
}

/** Does what is asked; throws what `refusedBy` makes of errors. `first` gets the coarse copy of a large tree, if it is wanted. */
export function work(core: Core, asking: Asking, first: (answer: Answer) => void): Answer | string {
  try {
    if (asking.kind === 'schema') return core.schema(asking.asked);
    return taken(make(core, asking, first), asking);
  } catch (e) {
    throw refusedBy(e);
  }
}

/** Takes all that was made out of the memory of the core. */
function taken(made: Made, asking: Asking): Answer {
  try {
    return answer(made, asking);
  } finally {
    made.free();
  }
}

function grown(core: Core, asking: Asking, first: (answer: Answer) => void): Made {
  const growing = core.grow(asking.asked, asking.seed);
  if (asking.first) {
    let coarse: Made | undefined;
    try {
      coarse = growing.first();
    } catch (e) {
      growing.free();
      throw e;
    }
    if (coarse) first(taken(coarse, asking));
  }
  return growing.whole();
}

function make(core: Core, asking: Asking, first: (answer: Answer) => void): Made {
  const { kind, asked, seed, file, points, counts } = asking;
  if (kind === 'grow') return grown(core, asking, first);
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

function answer(made: Made, { measures }: Asking): Answer {
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
    files: Object.fromEntries(made.file_names().map((name) => [name, made.take_file(name)])),
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
