/**
 * The last stroke, a second time: a browser that loses a page drops what it has not written yet of the page's transactions,
 * but keeps what was set among its small settings. Where it falls itself, it is the other way round.
 */
import type { Request } from '../worker/protocol';
import { dropSetting, setSetting, setting } from './store';

/** A stroke as it would be asked for if it ended now, or as it was asked for. */
export interface UnderPen {
  /** The last row of the journal that was written before it. */
  after: number;
  requests: readonly Request[];
}

/** Characters of a stroke of some ten thousand points: what is longer would take the room of all settings. */
const MOST = 1 << 19;

const placeOf = (id: string): string => `pen.${id}`;

export function keepPen(id: string, pen: UnderPen): void {
  const text = JSON.stringify(pen, (_, value: unknown) =>
    value instanceof Float64Array ? { floats: [...value] } : value,
  );
  if (text.length < MOST) setSetting(placeOf(id), text);
}

export function dropPen(id: string): void {
  dropSetting(placeOf(id));
}

export function keptPen(id: string): UnderPen | undefined {
  try {
    return JSON.parse(setting(placeOf(id)) ?? 'null', revived) ?? undefined;
  } catch {
    return undefined;
  }
}

/** JSON has no word for a pressure that is not known. */
function revived(_: string, value: unknown): unknown {
  const { floats } = (value ?? {}) as { floats?: (number | null)[] };
  return Array.isArray(floats) ? Float64Array.from(floats, (x) => x ?? NaN) : value;
}

const pointsOf = (pen: UnderPen): number =>
  pen.requests.reduce((sum, r) => sum + (r.kind === 'stroke' ? r.samples.length : 0), 0);

/** The later of two. */
export function laterPen(a: UnderPen | undefined, b: UnderPen | undefined): UnderPen | undefined {
  if (!a || !b) return a ?? b;
  if (a.after !== b.after) return a.after > b.after ? a : b;
  return pointsOf(a) > pointsOf(b) ? a : b;
}
