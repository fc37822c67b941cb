/** Symmetry of the sheet: what is drawn once is there several times. Samples are rows of x, y, milliseconds, pressure. */

export type Symmetry =
  /** On both sides of an upright line, at this x. */
  | { readonly kind: 'mirror'; readonly x: number }
  /** So many times round a centre. */
  | { readonly kind: 'turns'; readonly about: readonly [number, number]; readonly count: number };

/** How many times a stroke can be there round a centre. */
export const TURNS = { least: 2, most: 24, first: 5 } as const;

/** Ends that are nearer than this share of a line's length close it. */
const CLOSED = 0.15;

/** Where a stroke is drawn besides; nothing where it has its symmetry in itself. */
export function copiesOf(symmetry: Symmetry | undefined, samples: Float64Array): Float64Array[] {
  if (!symmetry || samples.length < 8) return [];
  if (symmetry.kind === 'mirror') return isBeside(samples, symmetry.x) ? [mirrored(samples, symmetry.x)] : [];
  const { about, count } = symmetry;
  if (isRound(samples, about)) return [];
  const turns = Array.from({ length: count - 1 }, (_, k) => (2 * Math.PI * (k + 1)) / count);
  return turns.map((angle) => turned(samples, about, angle));
}

/** The same stroke on the other side of an upright line. */
function mirrored(samples: Float64Array, x: number): Float64Array {
  return samples.map((value, i) => (i % 4 === 0 ? 2 * x - value : value));
}

function turned(samples: Float64Array, [x, y]: readonly [number, number], angle: number): Float64Array {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const to = samples.slice();
  for (let i = 0; i + 3 < to.length; i += 4) {
    const [dx, dy] = [samples[i]! - x, samples[i + 1]! - y];
    [to[i], to[i + 1]] = [x + dx * c - dy * s, y + dx * s + dy * c];
  }
  return to;
}

/** Whether the stroke lies on one side of an upright line, by a good part of its size. */
function isBeside(samples: Float64Array, axis: number): boolean {
  let [low, high, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let i = 0; i + 3 < samples.length; i += 4) {
    const [x, y] = [samples[i]!, samples[i + 1]!];
    [low, high, bottom, top] = [
      Math.min(low, x - axis),
      Math.max(high, x - axis),
      Math.min(bottom, y),
      Math.max(top, y),
    ];
  }
  const far = Math.max(Math.abs(low), Math.abs(high));
  // What begins on the line (a leaf on its stem) still lies beside it.
  const over = low < 0 && high > 0 ? Math.min(-low, high) : 0;
  return far > 0.08 * (top - bottom) && over < 0.25 * far;
}

/** Whether the stroke is closed round a point, as the disc of a flower: turned about it, it would lie on itself. */
function isRound(samples: Float64Array, [x, y]: readonly [number, number]): boolean {
  const last = samples.length - 4;
  let [length, turn] = [0, 0];
  for (let i = 0; i < last; i += 4) {
    const [ax, ay] = [samples[i]! - x, samples[i + 1]! - y];
    const [bx, by] = [samples[i + 4]! - x, samples[i + 5]! - y];
    length += Math.hypot(bx - ax, by - ay);
    turn += Math.atan2(ax * by - ay * bx, ax * bx + ay * by);
  }
  const gap = Math.hypot(samples[last]! - samples[0]!, samples[last + 1]! - samples[1]!);
  return gap < CLOSED * length && Math.abs(turn) > Math.PI;
}
