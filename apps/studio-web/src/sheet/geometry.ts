/** Plane geometry of the sheet; drawing coordinates have y up, screen coordinates have y down. */

export interface Viewport {
  /** Screen pixels for one unit of the drawing. */
  scale: number;
  /** Where the drawing's origin lies on the screen. */
  x: number;
  y: number;
}

export interface Box {
  left: number;
  bottom: number;
  right: number;
  top: number;
}

export function toScreen(v: Viewport, x: number, y: number): [number, number] {
  return [v.x + x * v.scale, v.y - y * v.scale];
}

export function toDrawing(v: Viewport, x: number, y: number): [number, number] {
  return [(x - v.x) / v.scale, (v.y - y) / v.scale];
}

/** The viewport after zooming by a factor about a point of the screen. */
export function zoomed(v: Viewport, factor: number, x: number, y: number): Viewport {
  const scale = Math.min(1e4, Math.max(1e-4, v.scale * factor));
  const f = scale / v.scale;
  return { scale, x: x - (x - v.x) * f, y: y - (y - v.y) * f };
}

/** The viewport that shows a box in the middle with a margin. */
export function fitted(box: Box, width: number, height: number, margin = 0.12): Viewport {
  const w = Math.max(box.right - box.left, 1e-9);
  const h = Math.max(box.top - box.bottom, 1e-9);
  const room = 1 - 2 * margin;
  const scale = Math.min((width * room) / w, (height * room) / h, 1e4);
  return {
    scale,
    x: width / 2 - ((box.left + box.right) / 2) * scale,
    y: height / 2 + ((box.bottom + box.top) / 2) * scale,
  };
}

export function boxOf(points: Float64Array, step: number, box?: Box): Box | undefined {
  let b = box;
  for (let i = 0; i + 1 < points.length; i += step) {
    const [x, y] = [points[i]!, points[i + 1]!];
    if (!b) b = { left: x, right: x, bottom: y, top: y };
    else {
      b = {
        left: Math.min(b.left, x),
        right: Math.max(b.right, x),
        bottom: Math.min(b.bottom, y),
        top: Math.max(b.top, y),
      };
    }
  }
  return b;
}

/** The box round both. */
export function united(a: Box, b: Box): Box {
  return {
    left: Math.min(a.left, b.left),
    right: Math.max(a.right, b.right),
    bottom: Math.min(a.bottom, b.bottom),
    top: Math.max(a.top, b.top),
  };
}

/** The nearest point of a polyline of rows of `step` numbers to a point, and how far it is. */
export function nearest(
  points: Float64Array,
  step: number,
  x: number,
  y: number,
): { at: [number, number]; distance: number } {
  let best = { at: [NaN, NaN] as [number, number], distance: Infinity };
  let [px, py] = [points[0] ?? NaN, points[1] ?? NaN];
  for (let i = 0; i + 1 < points.length; i += step) {
    const [qx, qy] = [points[i]!, points[i + 1]!];
    const [dx, dy] = [qx - px, qy - py];
    const length = dx * dx + dy * dy;
    const s = length > 0 ? Math.min(1, Math.max(0, ((x - px) * dx + (y - py) * dy) / length)) : 0;
    const at: [number, number] = [px + s * dx, py + s * dy];
    const distance = Math.hypot(at[0] - x, at[1] - y);
    if (distance < best.distance) best = { at, distance };
    [px, py] = [qx, qy];
  }
  return best;
}

/** Distance from a point to a polyline of rows of `step` numbers. */
export function distance(points: Float64Array, step: number, x: number, y: number): number {
  return nearest(points, step, x, y).distance;
}

/** Whether a point lies within a closed outline, by how often a ray from it crosses that. */
export function isWithin(outline: readonly (readonly [number, number])[], x: number, y: number): boolean {
  let inside = false;
  outline.forEach(([bx, by], i) => {
    const [ax, ay] = outline.at(i - 1)!;
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) inside = !inside;
  });
  return inside;
}

/** The share of the length of a polyline of rows of `step` numbers that lies within a closed outline, 0 to 1. */
export function shareWithin(
  points: Float64Array,
  step: number,
  outline: readonly (readonly [number, number])[],
): number {
  let [whole, within] = [0, 0];
  for (let i = step; i + 1 < points.length; i += step) {
    const [ax, ay, bx, by] = [points[i - step]!, points[i - step + 1]!, points[i]!, points[i + 1]!];
    const length = Math.hypot(bx - ax, by - ay);
    whole += length;
    if (isWithin(outline, (ax + bx) / 2, (ay + by) / 2)) within += length;
  }
  if (whole > 0) return within / whole;
  return points.length > 1 && isWithin(outline, points[0]!, points[1]!) ? 1 : 0;
}

/** How much of a polyline of rows of `step` numbers lies in a box, in its unit. */
export function lengthWithin(points: Float64Array, step: number, box: Box): number {
  let sum = 0;
  for (let i = step; i + 1 < points.length; i += step) {
    const [x, y] = [points[i - step]!, points[i - step + 1]!];
    const [dx, dy] = [points[i]! - x, points[i + 1]! - y];
    // Where along this piece the line enters the box and where it leaves it (Liang and Barsky 1984).
    let [enters, leaves] = [0, 1];
    for (const [by, room] of [
      [-dx, x - box.left],
      [dx, box.right - x],
      [-dy, y - box.bottom],
      [dy, box.top - y],
    ] as const) {
      if (by < 0) enters = Math.max(enters, room / by);
      else if (by > 0) leaves = Math.min(leaves, room / by);
      else if (room < 0) leaves = -1;
    }
    sum += Math.max(0, leaves - enters) * Math.hypot(dx, dy);
  }
  return sum;
}

/** What an outline is drawn with: a canvas' path, or a test that listens. */
export type Outliner = Pick<Path2D, 'moveTo' | 'lineTo' | 'quadraticCurveTo' | 'arc' | 'closePath'>;

/** Cosine of the turn from which on a line has a corner. */
const CORNER = 0.5;

/**
 * The outline of a line whose width changes along it, to be filled by the nonzero rule: `rows` of x, y and half width,
 * all in the path's unit. One closed loop for each stretch between corners, with a disc at its ends, all the same way
 * round, so that none cuts a hole into another.
 */
export function outline(to: Outliner, rows: Float64Array): void {
  // A point nearer than half the width adds nothing but folds.
  const kept: number[] = [];
  for (let i = 0; i + 2 < rows.length; i += 3) {
    const [x, y, r] = [rows[i]!, rows[i + 1]!, rows[i + 2]!];
    const n = kept.length;
    if (n > 0 && Math.hypot(x - kept[n - 3]!, y - kept[n - 2]!) < 0.5 * r) continue;
    kept.push(x, y, r);
  }
  const count = kept.length / 3;
  const disc = (i: number): void => {
    const [x, y, r] = [kept[3 * i]!, kept[3 * i + 1]!, kept[3 * i + 2]!];
    to.moveTo(x + r, y);
    to.arc(x, y, r, 0, 2 * Math.PI);
    to.closePath();
  };
  /** Unit vector from a point to the next. */
  const along = (i: number): [number, number] => {
    const [dx, dy] = [kept[3 * i + 3]! - kept[3 * i]!, kept[3 * i + 4]! - kept[3 * i + 1]!];
    const d = Math.hypot(dx, dy);
    return [dx / d, dy / d];
  };
  if (count > 0) disc(0);
  let first = 0;
  while (first + 1 < count) {
    const left: number[] = [];
    const right: number[] = [];
    const side = (i: number, dx: number, dy: number): void => {
      const [x, y, r] = [kept[3 * i]!, kept[3 * i + 1]!, kept[3 * i + 2]!];
      left.push(x - r * dy, y + r * dx);
      right.push(x + r * dy, y - r * dx);
    };
    let [dx, dy] = along(first);
    side(first, dx, dy);
    let last = first + 1;
    for (; last + 1 < count; last += 1) {
      const [ex, ey] = along(last);
      const turn = dx * ex + dy * ey;
      if (turn < CORNER) break;
      // Half way between the two directions, as long as keeps the width.
      side(last, (dx + ex) / (1 + turn), (dy + ey) / (1 + turn));
      [dx, dy] = [ex, ey];
    }
    side(last, dx, dy);
    to.moveTo(right[0]!, right[1]!);
    smooth(to, right);
    smooth(to, backwards(left));
    to.closePath();
    disc(last);
    first = last;
  }
}

function backwards(line: number[]): number[] {
  const back: number[] = [];
  for (let i = line.length - 2; i >= 0; i -= 2) back.push(line[i]!, line[i + 1]!);
  return back;
}

/** The line itself, to be stroked: `rows` as for an outline. */
export function centreline(to: Outliner, rows: Float64Array): void {
  const line: number[] = [];
  for (let i = 0; i + 2 < rows.length; i += 3) line.push(rows[i]!, rows[i + 1]!);
  if (line.length === 0) return;
  to.moveTo(line[0]!, line[1]!);
  smooth(to, line);
}

/** Goes on to a polyline's beginning and through the middles of its pieces to its end. */
function smooth(to: Outliner, line: number[]): void {
  to.lineTo(line[0]!, line[1]!);
  for (let i = 0; i + 3 < line.length; i += 2) {
    const [x, y] = [line[i]!, line[i + 1]!];
    to.quadraticCurveTo(x, y, (x + line[i + 2]!) / 2, (y + line[i + 3]!) / 2);
  }
  to.lineTo(line.at(-2)!, line.at(-1)!);
}
