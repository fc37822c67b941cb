/** What lies over the view while a hand works on a plant: the branch that is meant, the stroke, the brush. */

/** A branch as pairs of points on the screen: x, y, width. */
type Line = Float32Array;

const CORE = '#ffd166';
/** Of a point that can be taken, pixels. */
const [DOT, DOT_MEANT] = [4, 7];
const EDGE = 'rgb(20 30 25 / 75%)';

export class Overlay {
  readonly element = document.createElement('canvas');
  private branch: Float32Array | undefined;
  private path: [number, number][] = [];
  private kind: 'line' | 'brush' | 'outline' = 'line';
  private width = 2;
  private ring: { x: number; y: number; r: number } | undefined;
  private dots: Float32Array | undefined;
  private meant = -1;

  /** `project`: points of the plant on the screen. `isUnseen`: the scene is in a headset. */
  constructor(
    private readonly project: (points: Float32Array) => Line,
    private readonly isUnseen = (): boolean => false,
  ) {
    this.element.className = 'overlay';
    this.element.setAttribute('aria-hidden', 'true');
  }

  /** The branch that is meant: pairs of points (x, y, z, radius). */
  setBranch(points: Float32Array | undefined): void {
    this.branch = points && points.length > 0 ? points : undefined;
    this.draw();
  }

  /** Begins a stroke; `width` in pixels. */
  begin(kind: 'line' | 'brush' | 'outline', width: number): void {
    this.kind = kind;
    this.width = width;
    this.path = [];
  }

  add(x: number, y: number): void {
    this.path.push([x, y]);
  }

  end(): void {
    this.path = [];
    this.draw();
  }

  setRing(ring: { x: number; y: number; r: number } | undefined): void {
    this.ring = ring;
    if (ring) this.width = 2 * ring.r;
    this.draw();
  }

  /** Points that can be taken (x, y, z, radius of each), and the one that is meant. */
  setDots(points: Float32Array | undefined, meant = -1): void {
    [this.dots, this.meant] = [points, meant];
    this.draw();
  }

  draw(): void {
    if (this.isUnseen()) return;
    const { element } = this;
    const [w, h, ratio] = [element.clientWidth, element.clientHeight, Math.min(2, devicePixelRatio || 1)];
    if (element.width !== Math.round(w * ratio) || element.height !== Math.round(h * ratio))
      [element.width, element.height] = [Math.round(w * ratio), Math.round(h * ratio)];
    const c = element.getContext('2d');
    if (!c) return;
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, w, h);
    c.lineCap = c.lineJoin = 'round';
    if (this.branch) this.drawBranch(c, this.project(this.branch));
    if (this.path.length > 0) this.drawPath(c);
    if (this.dots) this.drawDots(c, this.project(this.dots));
    if (this.ring) {
      const { x, y, r } = this.ring;
      for (const [style, wide] of [
        [EDGE, 3.5],
        [CORE, 1.5],
      ] as const) {
        c.strokeStyle = style;
        c.lineWidth = wide;
        c.beginPath();
        c.arc(x, y, Math.max(2, r), 0, 2 * Math.PI);
        c.stroke();
      }
    }
  }

  private drawDots(c: CanvasRenderingContext2D, dots: Line): void {
    for (let i = 0; 3 * i < dots.length; i += 1) {
      if (dots[3 * i + 2] === 0) continue;
      c.beginPath();
      c.arc(dots[3 * i]!, dots[3 * i + 1]!, i === this.meant ? DOT_MEANT : DOT, 0, 2 * Math.PI);
      c.fillStyle = i === this.meant ? CORE : 'rgb(255 255 255 / 85%)';
      c.fill();
      c.strokeStyle = EDGE;
      c.lineWidth = 1.5;
      c.stroke();
    }
  }

  /** Dark around light: it shows on every sky and in every crown. */
  private drawBranch(c: CanvasRenderingContext2D, line: Line): void {
    for (const [style, more] of [
      [EDGE, 3.5],
      [CORE, 1.5],
    ] as const) {
      c.strokeStyle = style;
      // Few widths, so that a crown of thousands of twigs is a few paths.
      const paths = new Map<number, Path2D>();
      for (let i = 0; i + 5 < line.length; i += 6) {
        if (line[i + 2] === 0 || line[i + 5] === 0) continue;
        const wide = Math.min(16, Math.round(line[i + 2]!));
        let path = paths.get(wide);
        if (!path) {
          path = new Path2D();
          paths.set(wide, path);
        }
        path.moveTo(line[i]!, line[i + 1]!);
        path.lineTo(line[i + 3]!, line[i + 4]!);
      }
      for (const [wide, path] of paths) {
        c.lineWidth = 0.6 * wide + more;
        c.stroke(path);
      }
    }
  }

  private drawPath(c: CanvasRenderingContext2D): void {
    c.beginPath();
    this.path.forEach(([x, y], i) => (i === 0 ? c.moveTo(x, y) : c.lineTo(x, y)));
    if (this.path.length === 1) c.lineTo(this.path[0]![0] + 0.1, this.path[0]![1]);
    if (this.kind === 'outline') {
      c.closePath();
      c.fillStyle = 'rgb(255 209 102 / 18%)';
      c.fill();
    }
    if (this.kind === 'brush') {
      c.strokeStyle = 'rgb(255 209 102 / 30%)';
      c.lineWidth = Math.max(3, this.width);
      c.stroke();
    }
    for (const [style, wide] of [
      [EDGE, 4.5],
      [CORE, 2.2],
    ] as const) {
      c.strokeStyle = style;
      c.lineWidth = wide;
      c.stroke();
    }
  }
}
