/** What the sheet draws: lines of the pen, the frame round what is selected, the dots of the paper. */
import { type Frame, HALF, handlesOf } from './frame';
import { type Box, centreline, outline, toScreen, type Viewport } from './geometry';
import type { Symmetry } from './symmetry';

/** A line in pixels from the drawing's origin: filled within its outline, or stroked along it. */
export interface Line {
  path: Path2D;
  filled: boolean;
  /** Pixels. */
  wide: number;
}

/** Width of a line, pixels, at half the pressure of a pen, or without any. */
export const INK = 2.6;

/** A thinner line is not seen. */
export const LEAST_INK = 0.8;

/**
 * The line through rows of `step` numbers: x and y first, the pressure last. With `pressed` its width follows the
 * pressure, where the device told one.
 */
export function lineThrough(
  points: Float64Array,
  step: number,
  scale: number,
  pressed: boolean,
  wide = INK,
): Line {
  const path = new Path2D();
  const n = Math.floor(points.length / step);
  const rows = new Float64Array(3 * n);
  let told = false;
  for (let i = 0; i < n; i += 1) {
    const pressure = points[step * i + step - 1]!;
    told ||= Number.isFinite(pressure);
    rows[3 * i] = points[step * i]! * scale;
    rows[3 * i + 1] = -points[step * i + 1]! * scale;
    rows[3 * i + 2] = 0.5 * wide * (Number.isFinite(pressure) ? 0.4 + 1.3 * pressure : 1);
  }
  const filled = pressed && told;
  if (filled) outline(path, rows);
  else centreline(path, rows);
  return { path, filled, wide };
}

export function drawLine(
  c: CanvasRenderingContext2D,
  { x, y }: Viewport,
  { path, filled }: Line,
  color: string,
  width: number,
): void {
  c.translate(x, y);
  if (filled) {
    c.fillStyle = color;
    c.fill(path);
  } else {
    c.strokeStyle = color;
    c.lineWidth = width;
    c.stroke(path);
  }
  c.translate(-x, -y);
}

/** Its colours: of its lines, and of what is inside its handles. */
export function drawFrame(
  c: CanvasRenderingContext2D,
  frame: Frame,
  [lines, inside]: readonly [string, string],
): void {
  const handles = handlesOf(frame);
  const [, x, y] = handles[0]!;
  c.strokeStyle = lines;
  c.lineWidth = 1;
  c.strokeRect(frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
  c.beginPath();
  c.moveTo(x, frame.top);
  c.lineTo(x, y);
  c.stroke();
  c.fillStyle = inside;
  for (const [handle, hx, hy] of handles) {
    c.beginPath();
    if (handle === 'turn') c.arc(hx, hy, HALF, 0, 2 * Math.PI);
    else c.rect(hx - HALF, hy - HALF, 2 * HALF, 2 * HALF);
    c.fill();
    c.stroke();
  }
}

/** Dots at a step of the drawing that is 24 to 60 pixels wide. */
export function drawGrid(
  c: CanvasRenderingContext2D,
  view: Viewport,
  { left, right, top, bottom }: Box,
  dark: boolean,
): void {
  let step = 10 ** Math.floor(Math.log10(60 / view.scale));
  for (const f of [5, 2])
    if (step * f * view.scale <= 60) {
      step *= f;
      break;
    }
  c.fillStyle = dark ? 'rgba(255,255,255,0.10)' : 'rgba(60,50,30,0.13)';
  if (((right - left) / step) * ((top - bottom) / step) > 12_000) return;
  for (let x = Math.ceil(left / step) * step; x <= right; x += step) {
    for (let y = Math.ceil(bottom / step) * step; y <= top; y += step) {
      const [sx, sy] = toScreen(view, x, y);
      c.fillRect(sx - 0.75, sy - 0.75, 1.5, 1.5);
    }
  }
}

/** The outline of a lasso that is being drawn, closed as it would be now. */
export function drawLasso(
  c: CanvasRenderingContext2D,
  path: readonly (readonly [number, number])[],
  color: string,
): void {
  c.beginPath();
  for (const [x, y] of path) c.lineTo(x, y);
  c.closePath();
  c.strokeStyle = c.fillStyle = color;
  c.lineWidth = 1.5;
  c.setLineDash([5, 4]);
  c.stroke();
  c.setLineDash([]);
  c.globalAlpha = 0.08;
  c.fill();
  c.globalAlpha = 1;
}

export function drawRing(
  c: CanvasRenderingContext2D,
  [x, y]: readonly [number, number],
  radius: number,
  color: string,
): void {
  c.strokeStyle = color;
  c.lineWidth = 1.5;
  c.beginPath();
  c.arc(x, y, radius, 0, 2 * Math.PI);
  c.stroke();
}

/** How large the centre of a symmetry is drawn, pixels. */
const CENTRE = 5;

/** The line of symmetry, or the centre and the lines that part what is drawn round it, over a sheet of this size. */
export function drawSymmetry(
  c: CanvasRenderingContext2D,
  view: Viewport,
  symmetry: Symmetry,
  [w, h]: readonly [number, number],
  color: string,
): void {
  c.strokeStyle = color;
  c.lineWidth = 1;
  c.setLineDash([3, 5]);
  c.beginPath();
  if (symmetry.kind === 'mirror') {
    const [x] = toScreen(view, symmetry.x, 0);
    c.moveTo(x, 0);
    c.lineTo(x, h);
  } else {
    const [x, y] = toScreen(view, ...symmetry.about);
    for (let k = 0; k < symmetry.count; k += 1) {
      const angle = (2 * Math.PI * k) / symmetry.count;
      c.moveTo(x, y);
      c.lineTo(x + (w + h) * Math.sin(angle), y - (w + h) * Math.cos(angle));
    }
  }
  c.stroke();
  c.setLineDash([]);
  if (symmetry.kind === 'turns') drawRing(c, toScreen(view, ...symmetry.about), CENTRE, color);
}
