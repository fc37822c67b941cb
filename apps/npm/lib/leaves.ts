/** Organs that are copies of one another, found in the columns of a mesh: what instancing needs. */
import type { PartArrays } from './protocol.js';

/** Fewer copies are not worth a draw of their own. */
const FEW = 24;

/** Copies of one shape: the shape at its own size and place, and where and how each copy is. */
export interface Copies {
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  readonly uvs: Float32Array;
  readonly colors: Float32Array;
  /** One a vertex; empty without wind. */
  readonly flutter: Float32Array;
  readonly indices: Uint32Array;
  /** 16 a copy, column by column. */
  readonly matrices: Float32Array;
  /** Three a copy: multiplied with the colours. */
  readonly tints: Float32Array;
  /** Three a copy: sway of the plant, of the limb, phase; empty without wind. */
  readonly sways: Float32Array;
}

/** What a part consists of. */
export interface Parted {
  readonly copies: readonly Copies[];
  /** The triangles that are no copies: indices of the part itself. */
  readonly rest: Uint32Array;
}

interface Piece {
  readonly organ: number;
  /** First index of its triangles. */
  readonly first: number;
  readonly end: number;
  /** First vertex, and how many. */
  low: number;
  count: number;
}

/** Takes the copies out of a part. Organs of one shape are the same mesh, turned, scaled and moved, by how plants are made;
 * what is not (a petal that wears a photograph) stays in the rest. */
export function part(arrays: PartArrays, organs: Float32Array): Parted {
  const { indices, pieces } = arrays;
  const shapes = new Map<string, Piece[]>();
  const rest: Piece[] = [];
  let at = 0;
  for (let k = 0; k + 2 < pieces.length; k += 3) {
    const [organ, shape, triangles] = [pieces[k]!, pieces[k + 1]!, pieces[k + 2]!];
    const piece: Piece = { organ, first: at, end: at + 3 * triangles, low: 0, count: 0 };
    at = piece.end;
    if (organ < 0 || triangles === 0) {
      rest.push(piece);
      continue;
    }
    let [low, high] = [Infinity, 0];
    for (let i = piece.first; i < piece.end; i++) {
      low = Math.min(low, indices[i]!);
      high = Math.max(high, indices[i]!);
    }
    piece.low = low;
    piece.count = high + 1 - low;
    const key = `${shape} ${triangles} ${piece.count}`;
    const known = shapes.get(key);
    if (known) known.push(piece);
    else shapes.set(key, [piece]);
  }
  // Pieces that do not tell of all triangles tell of none.
  if (at !== indices.length) return { copies: [], rest: indices };
  const copies: Copies[] = [];
  for (const group of shapes.values()) {
    const [model, ...others] = group;
    if (!model || group.length < FEW) {
      rest.push(...group);
      continue;
    }
    const base = shape(arrays, organs, model);
    const alike = others.filter((piece) => isCopy(arrays, organs, piece, model, base));
    if (alike.length + 1 < FEW) {
      rest.push(...group);
      continue;
    }
    const kept = new Set(alike);
    rest.push(...others.filter((piece) => !kept.has(piece)));
    copies.push(gathered(arrays, organs, [model, ...alike], base));
  }
  if (copies.length === 0) return { copies, rest: indices };
  rest.sort((a, b) => a.first - b.first);
  const left = new Uint32Array(rest.reduce((sum, piece) => sum + piece.end - piece.first, 0));
  let to = 0;
  for (const piece of rest) {
    left.set(indices.subarray(piece.first, piece.end), to);
    to += piece.end - piece.first;
  }
  return { copies, rest: left };
}

/** The positions and normals of an organ in its own coordinates. */
function shape(
  { positions, normals }: PartArrays,
  organs: Float32Array,
  { organ, low, count }: Piece,
): { positions: Float32Array; normals: Float32Array } {
  const m = organs.subarray(16 * organ, 16 * organ + 16);
  const size2 = m[0]! * m[0]! + m[1]! * m[1]! + m[2]! * m[2]!;
  const size = Math.sqrt(size2);
  const [local, turned] = [new Float32Array(3 * count), new Float32Array(3 * count)];
  for (let v = 0; v < count; v++) {
    const k = 3 * (low + v);
    const d = [positions[k]! - m[12]!, positions[k + 1]! - m[13]!, positions[k + 2]! - m[14]!];
    for (let axis = 0; axis < 3; axis++) {
      const [x, y, z] = [m[4 * axis]!, m[4 * axis + 1]!, m[4 * axis + 2]!];
      local[3 * v + axis] = (d[0]! * x + d[1]! * y + d[2]! * z) / size2;
      turned[3 * v + axis] = (normals[k]! * x + normals[k + 1]! * y + normals[k + 2]! * z) / size;
    }
  }
  return { positions: local, normals: turned };
}

/** Whether an organ is the model of its shape, moved: its vertices lie where they would, with the same texture. */
function isCopy(
  { positions, uvs, indices }: PartArrays,
  organs: Float32Array,
  piece: Piece,
  model: Piece,
  base: { positions: Float32Array },
): boolean {
  const m = organs.subarray(16 * piece.organ, 16 * piece.organ + 16);
  // Single precision, of a plant and of an organ.
  const near =
    1e-5 * (1 + Math.hypot(m[12]!, m[13]!, m[14]!)) + 1e-3 * Math.hypot(m[0]!, m[1]!, m[2]!) * 0.01;
  for (let v = 0; v < piece.count; v++) {
    const [x, y, z] = [base.positions[3 * v]!, base.positions[3 * v + 1]!, base.positions[3 * v + 2]!];
    for (let axis = 0; axis < 3; axis++) {
      const there = m[axis]! * x + m[4 + axis]! * y + m[8 + axis]! * z + m[12 + axis]!;
      if (!(Math.abs(there - positions[3 * (piece.low + v) + axis]!) <= near)) return false;
    }
  }
  for (let k = 0; k < (uvs.length > 0 ? 2 * piece.count : 0); k++)
    if (uvs[2 * piece.low + k] !== uvs[2 * model.low + k]) return false;
  for (let k = 0; k < piece.end - piece.first; k++)
    if (indices[piece.first + k]! - piece.low !== indices[model.first + k]! - model.low) return false;
  return true;
}

function gathered(
  { uvs, colors, wind, indices }: PartArrays,
  organs: Float32Array,
  pieces: readonly Piece[],
  base: { positions: Float32Array; normals: Float32Array },
): Copies {
  const model = pieces[0]!;
  const { low, count } = model;
  const blows = wind.length > 0;
  const tinted = colors.length > 0;
  const matrices = new Float32Array(16 * pieces.length);
  const tints = new Float32Array(3 * pieces.length).fill(1);
  const sways = new Float32Array(blows ? 3 * pieces.length : 0);
  pieces.forEach((piece, k) => {
    matrices.set(organs.subarray(16 * piece.organ, 16 * piece.organ + 16), 16 * k);
    for (let i = 0; i < 3 && tinted; i++) {
      const own = colors[3 * low + i]!;
      tints[3 * k + i] = own > 0 ? colors[3 * piece.low + i]! / own : 1;
    }
    // As the foot of the organ sways: it moves as one.
    const at = 4 * piece.low;
    if (blows) sways.set([wind[at]!, wind[at + 1]!, wind[at + 3]!], 3 * k);
  });
  const flutter = new Float32Array(blows ? count : 0);
  for (let v = 0; v < flutter.length; v++) flutter[v] = wind[4 * (low + v) + 2]!;
  return {
    ...base,
    uvs: uvs.slice(2 * low, 2 * (low + count)),
    colors: colors.slice(3 * low, 3 * (low + count)),
    flutter,
    indices: indices.slice(model.first, model.end).map((i) => i - low),
    matrices,
    tints,
    sways,
  };
}
