/** Ends of a stroke that meet what is drawn. Samples are rows of x, y, milliseconds, pressure. */
import { type Box, nearest } from './geometry';

/** What an end can meet: rows of x, y, pressure, and the box round them. */
export interface Drawn {
  readonly points: Float64Array;
  readonly box: Box;
}

/** So much of a stroke follows an end that is moved, as a share of its length. */
const FOLLOWS = 0.3;

/** Where an end meets what is drawn within its reach: an end of that before any other of its points. */
export function meeting(
  strokes: readonly Drawn[],
  [x, y]: readonly [number, number],
  reach: number,
): [number, number] | undefined {
  let [end, side]: { at: [number, number]; distance: number }[] = [];
  for (const { points, box } of strokes) {
    if (x < box.left - reach || x > box.right + reach || y < box.bottom - reach || y > box.top + reach)
      continue;
    const near = nearest(points, 3, x, y);
    if (near.distance <= reach && near.distance < (side?.distance ?? Infinity)) side = near;
    for (const i of [0, points.length - 3]) {
      const at: [number, number] = [points[i]!, points[i + 1]!];
      const distance = Math.hypot(at[0] - x, at[1] - y);
      if (distance <= reach && distance < (end?.distance ?? Infinity)) end = { at, distance };
    }
  }
  return (end ?? side)?.at;
}

/** The stroke with its ends where they meet what is drawn; the stroke itself where they meet nothing. */
export function joined(samples: Float64Array, strokes: readonly Drawn[], reach: number): Float64Array {
  const last = samples.length - 4;
  if (last < 4) return samples;
  const [from, to] = [0, last].map((i) => meeting(strokes, [samples[i]!, samples[i + 1]!], reach));
  if (!from && !to) return samples;
  const along = new Float64Array(samples.length / 4);
  for (let i = 4; i <= last; i += 4)
    along[i / 4] =
      along[i / 4 - 1]! + Math.hypot(samples[i]! - samples[i - 4]!, samples[i + 1]! - samples[i - 3]!);
  const length = along.at(-1)!;
  const result = samples.slice();
  for (const [end, at] of [
    [0, from],
    [last, to],
  ] as const) {
    if (!at) continue;
    const by = [at[0] - samples[end]!, at[1] - samples[end + 1]!] as const;
    for (let i = 0; i <= last; i += 4) {
      const away = Math.abs(along[i / 4]! - (end === 0 ? 0 : length));
      const share = Math.max(0, 1 - away / (FOLLOWS * length));
      result[i] = result[i]! + share * by[0];
      result[i + 1] = result[i + 1]! + share * by[1];
    }
  }
  return result;
}
