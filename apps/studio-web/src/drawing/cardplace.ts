/** Where the card of a selection stands, so that it covers none of the strokes that it is of. Pixels of the sheet. */
import type { Frame } from '../sheet/frame';

/** Between the card and the frame of what is selected, pixels. */
const GAP = 14;

export interface Spot {
  readonly left: number;
  readonly top: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
}

/**
 * Beside the frame, above it, below it, or in a corner of `room` that is free of strokes; none where the room has no such place.
 * `covered`: how much of the strokes lies in a place.
 */
export function cardBeside(
  { frame, covered }: { frame: Frame; covered(place: Frame): number },
  { width, height }: Size,
  room: Frame,
): Spot | undefined {
  const [farthest, lowest] = [room.right - width, room.bottom - height];
  if (farthest < room.left || lowest < room.top) return undefined;
  const across = (x: number): number => Math.min(farthest, Math.max(room.left, x));
  const along = (y: number): number => Math.min(lowest, Math.max(room.top, y));
  const [x, y] = [(frame.left + frame.right - width) / 2, (frame.top + frame.bottom - height) / 2];
  const beside: readonly Spot[] = [
    { left: frame.right + GAP, top: along(y) },
    { left: frame.left - GAP - width, top: along(y) },
    { left: across(x), top: frame.bottom + GAP },
    { left: across(x), top: frame.top - GAP - height },
  ];
  const fits = ({ left, top }: Spot): boolean =>
    left >= room.left && left <= farthest && top >= room.top && top <= lowest;
  const corners: readonly Spot[] = [
    { left: farthest, top: room.top },
    { left: farthest, top: lowest },
    { left: room.left, top: room.top },
    { left: room.left, top: lowest },
  ];
  const isFree = ({ left, top }: Spot): boolean =>
    covered({ left: left - GAP, right: left + width + GAP, top: top - GAP, bottom: top + height + GAP }) ===
    0;
  return beside.find(fits) ?? corners.find(isFree);
}
