/**
 * What a hand meant: a line, an arc, a circle or an ellipse in place of what it drew. Plane geometry; samples are rows of x,
 * y, milliseconds, pressure.
 */

type Point = readonly [number, number];

/** Ends that are nearer than this share of a line's length close it. */
const CLOSED = 0.18;
/** How far a line may leave its chord, in shares of the chord. */
const BOW = 0.05;
/** How far a hand may leave an arc, in shares of the arc's length. */
const WAVE = 0.06;
/** How far a hand may leave an ellipse, in shares of its radius there: at one point, and in the mean. */
const DENT = { most: 0.3, mean: 0.1 } as const;
/** An ellipse that is nearly as wide as it is high is a circle: this share of its longer axis. */
const ROUND = 0.82;
/** Points of what is made. */
const COUNT = { line: 9, curve: 49 } as const;

/** The plain figure that a stroke comes near to; nothing where it comes near to none. */
export function straightened(samples: Float64Array): Float64Array | undefined {
  const points = pointsOf(samples);
  const [first, last] = [points[0], points.at(-1)];
  if (!first || !last || points.length < 3) return undefined;
  const length = points.reduce((sum, p, i) => sum + (i > 0 ? apart(points[i - 1]!, p) : 0), 0);
  if (!(length > 0)) return undefined;
  const figure =
    apart(first, last) < CLOSED * length
      ? ellipseOf(points)
      : (lineOf(points, first, last) ?? arcOf(points, first, last, length));
  return figure && sampled(samples, figure);
}

function pointsOf(samples: Float64Array): Point[] {
  const points: Point[] = [];
  for (let i = 0; i + 3 < samples.length; i += 4) points.push([samples[i]!, samples[i + 1]!]);
  return points;
}

const apart = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1]);

function along(count: number, at: (share: number) => Point): Point[] {
  return Array.from({ length: count }, (_, i) => at(i / (count - 1)));
}

/** Each point in the frame of the chord: along it from its middle, and across it. */
function acrossChord(points: readonly Point[], first: Point, last: Point): Point[] {
  const chord = apart(first, last);
  const [ux, uy] = [(last[0] - first[0]) / chord, (last[1] - first[1]) / chord];
  const [mx, my] = [(first[0] + last[0]) / 2, (first[1] + last[1]) / 2];
  return points.map(([x, y]) => [(x - mx) * ux + (y - my) * uy, (y - my) * ux - (x - mx) * uy]);
}

function lineOf(points: readonly Point[], first: Point, last: Point): Point[] | undefined {
  const off = acrossChord(points, first, last).map(([, v]) => Math.abs(v));
  if (Math.max(...off) > BOW * apart(first, last)) return undefined;
  return along(COUNT.line, (s) => [first[0] + s * (last[0] - first[0]), first[1] + s * (last[1] - first[1])]);
}

/** The arc from the first point to the last that goes nearest to those between: of all circles through both, by least squares. */
function arcOf(points: readonly Point[], first: Point, last: Point, length: number): Point[] | undefined {
  const half = apart(first, last) / 2;
  // A circle through both ends has its middle at height c over the chord: u^2 + v^2 - 2 c v = half^2.
  let [above, below] = [0, 0];
  for (const [u, v] of acrossChord(points, first, last)) {
    above += v * (u * u + v * v - half * half);
    below += 2 * v * v;
  }
  const c = above / below;
  const r = Math.hypot(c, half);
  if (!Number.isFinite(r)) return undefined;
  const own = acrossChord(points, first, last);
  if (own.some(([u, v]) => Math.abs(Math.hypot(u, v - c) - r) > WAVE * length)) return undefined;
  // Round the side on which the points lie.
  const side = own.reduce((sum, [, v]) => sum + v, 0) > 0 ? 1 : -1;
  const half_turn = Math.acos(Math.max(-1, Math.min(1, (-side * c) / r)));
  const [ux, uy] = [(last[0] - first[0]) / (2 * half), (last[1] - first[1]) / (2 * half)];
  const [mx, my] = [(first[0] + last[0]) / 2, (first[1] + last[1]) / 2];
  return along(COUNT.curve, (s) => {
    const angle = (2 * s - 1) * half_turn;
    const [u, v] = [r * Math.sin(angle), c + side * r * Math.cos(angle)];
    return [mx + u * ux - v * uy, my + u * uy + v * ux];
  });
}

/** The ellipse of the same area, middle and spread as what the line encloses; a circle where that is nearly one. */
function ellipseOf(points: readonly Point[]): Point[] | undefined {
  const [ox, oy] = points[0]!;
  let [area, sx, sy, xx, yy, xy] = [0, 0, 0, 0, 0, 0];
  points.forEach(([px, py], i) => {
    const [qx, qy] = points[(i + 1) % points.length]!;
    const [ax, ay, bx, by] = [px - ox, py - oy, qx - ox, qy - oy];
    const cross = ax * by - bx * ay;
    area += cross / 2;
    sx += ((ax + bx) * cross) / 6;
    sy += ((ay + by) * cross) / 6;
    xx += ((ax * ax + ax * bx + bx * bx) * cross) / 12;
    yy += ((ay * ay + ay * by + by * by) * cross) / 12;
    xy += ((ax * by + 2 * ax * ay + 2 * bx * by + bx * ay) * cross) / 24;
  });
  const [mx, my] = [sx / area, sy / area];
  const [vx, vy, vxy] = [xx / area - mx * mx, yy / area - my * my, xy / area - mx * my];
  // Of an ellipse, the spread along an axis is a quarter of its square.
  const [middle, spread] = [(vx + vy) / 2, Math.hypot((vx - vy) / 2, vxy)];
  let [a, b] = [2 * Math.sqrt(middle + spread), 2 * Math.sqrt(Math.max(0, middle - spread))];
  if (!(b > 0) || !Number.isFinite(a)) return undefined;
  const tilt = Math.atan2(2 * vxy, vx - vy) / 2;
  if (b > ROUND * a) a = b = Math.sqrt(a * b);
  const [c, s] = [Math.cos(tilt), Math.sin(tilt)];
  const inner = points.map(([x, y]): Point => {
    const [dx, dy] = [x - ox - mx, y - oy - my];
    return [(dx * c + dy * s) / a, (dy * c - dx * s) / b];
  });
  const dents = inner.map(([u, v]) => Math.abs(Math.hypot(u, v) - 1));
  const mean = dents.reduce((sum, d) => sum + d, 0) / dents.length;
  if (Math.max(...dents) > DENT.most || mean > DENT.mean) return undefined;
  const from = Math.atan2(inner[0]![1], inner[0]![0]);
  const way = area > 0 ? 2 * Math.PI : -2 * Math.PI;
  return along(COUNT.curve, (share) => {
    const angle = from + share * way;
    const [u, v] = [a * Math.cos(angle), b * Math.sin(angle)];
    return [ox + mx + u * c - v * s, oy + my + u * s + v * c];
  });
}

/** The figure with the times and the pressures that the hand had so far along its stroke. */
function sampled(samples: Float64Array, figure: readonly Point[]): Float64Array {
  const rows = samples.length / 4;
  const to = new Float64Array(4 * figure.length);
  figure.forEach(([x, y], i) => {
    const row = Math.round((i / (figure.length - 1)) * (rows - 1));
    to.set([x, y, samples[4 * row + 2]!, samples[4 * row + 3]!], 4 * i);
  });
  return to;
}
