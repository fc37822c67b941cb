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
        left: Math.min(b.left, x), right: Math.max(b.right, x), bottom: Math.min(b.bottom, y), top: Math.max(b.top, y),
      };
    }
  }
  return b;
}

/** Distance from a point to a polyline of rows of `step` numbers. */
export function distance(points: Float64Array, step: number, x: number, y: number): number {
  let best = Infinity;
  let [px, py] = [points[0] ?? NaN, points[1] ?? NaN];
  for (let i = 0; i + 1 < points.length; i += step) {
    const [qx, qy] = [points[i]!, points[i + 1]!];
    const [dx, dy] = [qx - px, qy - py];
    const length = dx * dx + dy * dy;
    const s = length > 0 ? Math.min(1, Math.max(0, ((x - px) * dx + (y - py) * dy) / length)) : 0;
    best = Math.min(best, Math.hypot(px + s * dx - x, py + s * dy - y));
    [px, py] = [qx, qy];
  }
  return best;
}
