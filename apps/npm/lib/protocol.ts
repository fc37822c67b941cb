/** What travels between a page and its worker. */
import type { PlantView, Refusal } from './wire.js';

/** A request to the core. */
export interface Asking {
  readonly kind: 'grow' | 'sketch' | 'leaf' | 'bloom' | 'schema';
  /** What is asked for, as JSON; the maker of a schema. */
  readonly asked: string;
  readonly seed: bigint;
  readonly measures: boolean;
  /** Whether a coarse copy of a large tree is wanted first. */
  readonly first?: boolean;
  readonly file?: Uint8Array;
  readonly points?: Float64Array;
  readonly counts?: Uint32Array;
}

/** The columns of one mesh; those that it has not are empty. */
export interface PartArrays {
  /** Three a vertex, metres, +y up. */
  readonly positions: Float32Array;
  /** Three a vertex, of unit length. */
  readonly normals: Float32Array;
  /** Two a vertex, v down. */
  readonly uvs: Float32Array;
  /** Three a vertex, linear; multiplied with the colour of the material. */
  readonly colors: Float32Array;
  /** Four a vertex, 0 to 1: sway of the plant, sway of the limb, flutter, phase. */
  readonly wind: Float32Array;
  /** Three a vertex, metres: about what wind turns it. */
  readonly pivots: Float32Array;
  /** Three a triangle. */
  readonly indices: Uint32Array;
  /** Three a piece, in the order of the triangles: organ (-1: wood), its shape, number of triangles. */
  readonly pieces: Int32Array;
}

/** Tables of the plant; -1 stands for none. `part` is a row of `PARTS`. */
export interface Tables {
  readonly nodes: {
    /** Three a node, metres. */
    readonly position: Float64Array;
    /** Metres. */
    readonly radius: Float64Array;
    readonly axis: Int32Array;
  };
  readonly axes: {
    readonly part: Int32Array;
    readonly order: Int32Array;
    /** The node that bears it. */
    readonly bearer: Int32Array;
    readonly first: Int32Array;
    readonly end: Int32Array;
  };
  readonly organs: {
    readonly part: Int32Array;
    readonly bearer: Int32Array;
    readonly flower: Int32Array;
  };
}

/** A plant as it travels. */
export interface Answer {
  readonly view: PlantView;
  readonly levels: readonly (readonly PartArrays[])[];
  /** Of each level, where its organs are: matrices, column by column. */
  readonly organs: readonly Float32Array[];
  /** RGBA. */
  readonly textures: readonly Uint8Array[];
  readonly tables: Tables;
  readonly files: Readonly<Record<string, Uint8Array>>;
  /** As JSON; empty where they were not asked for. */
  readonly measures: string;
}

/** What a worker says. */
export type Said =
  | { readonly number: number; readonly first: Answer }
  | { readonly number: number; readonly answer: Answer | string }
  | { readonly number: number; readonly refused: Refusal | string };
