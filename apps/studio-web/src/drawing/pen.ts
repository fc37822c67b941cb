/** The pen that strokes are drawn with. */
import type { PenStyle, StrokeClass } from '../wire';

/** The pen as it is held: its width is in pixels of the screen at the time of drawing. */
export interface Held {
  color: string | null;
  width: number | null;
  layer: string | null;
  /** What it draws, if the person said so. */
  class: StrokeClass | null;
}

export const bytes = (hex: string): [number, number, number] =>
  [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16)) as [number, number, number];

export const hex = (color: readonly number[]): string =>
  `#${color.map((byte) => byte.toString(16).padStart(2, '0')).join('')}`;

/** What a stroke is drawn with; `unit`: units of the drawing to a pixel. Nothing for the pen that every sheet has. */
export function penOf(held: Held, unit: number): PenStyle | undefined {
  const { color, width, layer } = held;
  if (color === null && width === null && layer === null && held.class === null) return undefined;
  return {
    color: color === null ? null : bytes(color),
    width: width === null ? null : Number((width * unit).toPrecision(4)),
    layer,
    class: held.class,
  };
}
