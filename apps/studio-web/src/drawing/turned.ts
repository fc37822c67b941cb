/** Which strokes of a drawing became something else because another one was added. */
import type { StrokeClass } from '../wire';

/** A stroke as it was shown before. */
export interface Seen {
  class: StrokeClass;
  organ: string;
}

/** A stroke that another one turned into something else. */
export interface Turned {
  id: number;
  from: Seen;
  to: Seen;
}

type Strokes = ReadonlyMap<number, Seen>;

/**
 * The strokes that became something else when others were added to them; `last`: those of the time before, which hold as
 * long as nothing else happens.
 */
export function turnedBy(before: Strokes, now: Strokes, last: readonly Turned[]): Turned[] {
  const all = [...before].every(([id]) => now.has(id));
  if (all && now.size > before.size)
    return [...before].flatMap(([id, from]) => {
      const to = now.get(id)!;
      return to.organ === from.organ ? [] : [{ id, from, to }];
    });
  // Of strokes that are something else again, or that a person said to be something, there is nothing to say.
  const holds =
    all && now.size === before.size && last.every(({ id, to }) => now.get(id)?.organ === to.organ);
  return holds ? [...last] : [];
}
