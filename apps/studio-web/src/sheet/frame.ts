/** The frame round what is selected: corners that scale it, and a knob over it that turns it. */
import type { StrokeTurn } from '../wire';
import { type Box, toScreen, type Viewport } from './geometry';

export type Handle = 'turn' | 'left-bottom' | 'right-bottom' | 'left-top' | 'right-top';

/** Between the strokes and the frame, and between the frame and the knob, pixels. */
const MARGIN = 10;
const ARM = 26;
/** Half of a handle's side, pixels. */
export const HALF = 5;
/** A turn stops at these angles while it is held to them, degrees. */
const SNAP = 15;
/** Nothing becomes smaller than this share of itself in one go. */
const LEAST = 0.02;

export interface Frame {
  left: number;
  right: number;
  /** Smaller than `bottom`: pixels run downwards. */
  top: number;
  bottom: number;
}

export function frameOf(view: Viewport, box: Box): Frame {
  const [left, top] = toScreen(view, box.left, box.top);
  const [right, bottom] = toScreen(view, box.right, box.bottom);
  return { left: left - MARGIN, right: right + MARGIN, top: top - MARGIN, bottom: bottom + MARGIN };
}

/** Where each handle is, pixels. */
export function handlesOf({ left, right, top, bottom }: Frame): [Handle, number, number][] {
  return [
    ['turn', (left + right) / 2, top - ARM],
    ['left-bottom', left, bottom],
    ['right-bottom', right, bottom],
    ['left-top', left, top],
    ['right-top', right, top],
  ];
}

export function handleAt(frame: Frame, [x, y]: [number, number], reach: number): Handle | undefined {
  const near = handlesOf(frame).find(([, hx, hy]) => Math.max(Math.abs(x - hx), Math.abs(y - hy)) <= reach);
  return near?.[0];
}

/**
 * What a drag of a handle does to what lies in `box`, all in the drawing's unit. `held`: a turn keeps to steps of 15
 * degrees, and a corner to no proportion.
 */
export function dragged(
  handle: Handle,
  box: Box,
  from: [number, number],
  to: [number, number],
  held: boolean,
): StrokeTurn {
  if (handle === 'turn') {
    const about: [number, number] = [(box.left + box.right) / 2, (box.bottom + box.top) / 2];
    const [ax, ay] = [from[0] - about[0], from[1] - about[1]];
    const [bx, by] = [to[0] - about[0], to[1] - about[1]];
    const angle = (Math.atan2(ax * by - ay * bx, ax * bx + ay * by) * 180) / Math.PI;
    return { about, angle_deg: held ? SNAP * Math.round(angle / SNAP) : angle, scale: [1, 1] };
  }
  const [side, end] = handle.split('-');
  const about: [number, number] = [
    side === 'left' ? box.right : box.left,
    end === 'bottom' ? box.top : box.bottom,
  ];
  const [ax, ay] = [from[0] - about[0], from[1] - about[1]];
  const [bx, by] = [to[0] - about[0], to[1] - about[1]];
  const even = (ax * bx + ay * by) / Math.max(ax * ax + ay * ay, 1e-300);
  const size = Math.hypot(ax, ay);
  // Along a line without width nothing can be said of it.
  const share = (a: number, b: number): number => (Math.abs(a) < 0.05 * size ? 1 : b / a);
  const scale = held ? [share(ax, bx), share(ay, by)] : [even, even];
  return {
    about,
    angle_deg: 0,
    scale: [Math.max(LEAST, scale[0]!), Math.max(LEAST, scale[1]!)],
  };
}
