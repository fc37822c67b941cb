/** What says how large things are: a person, a grid and a staff, all in metres. */
import * as THREE from 'three';

export const GUIDES = ['figure', 'grid', 'staff'] as const;
export type Guide = (typeof GUIDES)[number];

/** Of the person, metres. */
export const FIGURE_M = 1.75;

/** The right half of a standing person, heights from the neck down and back up to the crotch. */
const OUTLINE: readonly (readonly [number, number])[] = [
  [0, 0.892],
  [0.026, 0.884],
  [0.029, 0.862],
  [0.055, 0.846],
  [0.112, 0.828],
  [0.135, 0.79],
  [0.145, 0.72],
  [0.152, 0.63],
  [0.164, 0.55],
  [0.174, 0.485],
  [0.181, 0.44],
  [0.175, 0.402],
  [0.161, 0.42],
  [0.154, 0.48],
  [0.139, 0.55],
  [0.123, 0.63],
  [0.113, 0.7],
  [0.103, 0.742],
  [0.097, 0.68],
  [0.086, 0.612],
  [0.095, 0.55],
  [0.104, 0.49],
  [0.101, 0.41],
  [0.088, 0.31],
  [0.081, 0.27],
  [0.083, 0.205],
  [0.067, 0.11],
  [0.055, 0.05],
  [0.062, 0.02],
  [0.08, 0.004],
  [0.03, 0],
  [0.022, 0.03],
  [0.026, 0.07],
  [0.021, 0.16],
  [0.025, 0.25],
  [0.017, 0.33],
  [0.009, 0.42],
  [0, 0.452],
];

/** The step of 1, 2 or 5 times a power of ten that divides a length into at most so many. */
export function stepFor(length: number, most: number): number {
  const rough = Math.max(1e-6, length) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((n) => n * power).find((s) => s >= rough * 0.9999) ?? 10 * power;
}

/** A length as people write it. */
export function metres(x: number): string {
  const round = (n: number): string => String(Math.round(n * 100) / 100);
  return x === 0
    ? '0'
    : x >= 1
      ? `${round(x)} m`
      : x >= 0.01
        ? `${round(100 * x)} cm`
        : `${round(1000 * x)} mm`;
}

function figure(): THREE.Group {
  const side = OUTLINE.map(([x, y]) => new THREE.Vector2(x, y));
  const half = new THREE.SplineCurve(side).getPoints(150);
  const other = half.map((p) => new THREE.Vector2(-p.x, p.y)).reverse();
  const body = new THREE.Shape([...half, ...other.slice(1, -1)]);
  const head = new THREE.Shape();
  head.absellipse(0, 0.936, 0.051, 0.064, 0, 2 * Math.PI, false, 0);
  const look = new THREE.MeshBasicMaterial({
    color: 0x7d898e,
    side: THREE.DoubleSide,
  });
  const group = new THREE.Group();
  group.add(new THREE.Mesh(new THREE.ShapeGeometry([body]), look));
  group.add(new THREE.Mesh(new THREE.ShapeGeometry([head], 24), look));
  group.scale.setScalar(FIGURE_M);
  return group;
}

/** A few words that face the camera, so high in metres. */
function label(text: string, height: number): THREE.Sprite {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [256, 64];
  const c = canvas.getContext('2d')!;
  c.font = '600 40px system-ui, sans-serif';
  c.textBaseline = 'middle';
  c.lineJoin = 'round';
  c.lineWidth = 9;
  c.strokeStyle = 'rgb(255 255 255 / 85%)';
  c.strokeText(text, 8, 33);
  c.fillStyle = '#23302a';
  c.fillText(text, 8, 33);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const look = new THREE.SpriteMaterial({ map, depthWrite: false, fog: false, toneMapped: false });
  const sprite = new THREE.Sprite(look);
  sprite.scale.set(4 * height, height, 1);
  sprite.center.set(0, 0.5);
  return sprite;
}

/** Rungs of red and white beside the plant, with a number at every second. */
function staff(height: number, size: number): THREE.Group {
  const group = new THREE.Group();
  const step = stepFor(height, 8);
  const rungs = Math.max(1, Math.ceil(height / step - 0.01));
  const width = 0.012 * size;
  const box = new THREE.BoxGeometry(width, step, width);
  const looks = [0xb8402f, 0xf4f1e8].map((color) => new THREE.MeshBasicMaterial({ color }));
  for (let i = 0; i < rungs; i += 1) {
    const rung = new THREE.Mesh(box, looks[i % 2]);
    rung.position.y = (i + 0.5) * step;
    group.add(rung);
  }
  for (let i = 0; i <= rungs; i += 1) {
    const text = label(metres(i * step), 0.052 * size);
    text.position.set(-0.19 * size, i * step, 0);
    group.add(text);
  }
  return group;
}

/** Squares that fade outwards, and what the side of one is. */
function grid(size: number): THREE.Group {
  const step = stepFor(size, 6);
  const reach = 2.2 * size;
  const n = Math.floor(reach / step);
  const [positions, colors]: [number[], number[]] = [[], []];
  const add = (x: number, z: number, major: boolean): void => {
    positions.push(x, 0, z);
    const seen = Math.max(0, 1 - Math.hypot(x, z) / reach) * (major ? 0.85 : 0.5);
    colors.push(0.16, 0.2, 0.18, seen);
  };
  for (let i = -n; i <= n; i += 1)
    for (let k = -n; k < n; k += 1) {
      const [a, b, c] = [i * step, k * step, (k + 1) * step];
      add(a, b, i === 0);
      add(a, c, i === 0);
      add(b, a, i === 0);
      add(c, a, i === 0);
    }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(colors, 4));
  const look = new THREE.LineBasicMaterial({
    vertexColors: true,
    transparent: true,
    depthWrite: false,
    fog: false,
  });
  const lines = new THREE.LineSegments(geometry, look);
  const group = new THREE.Group();
  const text = label(metres(step), 0.045 * size);
  text.position.set(
    step * 0.12,
    0.03 * size,
    Math.max(1, Math.round((0.55 * size) / step)) * step + 0.1 * step,
  );
  group.add(lines, text);
  return group;
}

/** Everything in metres of the scene: it hangs where the plants hang. */
export class Guides {
  readonly group = new THREE.Group();
  private readonly shown: Record<Guide, boolean> = { figure: false, grid: false, staff: false };
  private readonly made: Partial<Record<Guide, THREE.Group>> = {};
  private box = new THREE.Box3();

  set(guide: Guide, on: boolean): void {
    this.shown[guide] = on;
    this.build(guide);
  }

  isShown(guide: Guide): boolean {
    return this.shown[guide];
  }

  get any(): boolean {
    return GUIDES.some((g) => this.shown[g]);
  }

  /** The box around the plants, metres. */
  setBox(box: THREE.Box3): void {
    if (box.isEmpty() || box.equals(this.box)) return;
    this.box = box.clone();
    for (const guide of GUIDES) this.build(guide);
  }

  /** What the figure adds to what is to be seen, metres. */
  extend(box: THREE.Box3): THREE.Box3 {
    const { figure } = this.made;
    if (!figure) return box;
    const [{ x, z }, half] = [figure.position, 0.2 * FIGURE_M];
    return box
      .clone()
      .expandByPoint(new THREE.Vector3(x + half, FIGURE_M, z))
      .expandByPoint(new THREE.Vector3(x + half, 0, z));
  }

  private build(guide: Guide): void {
    const old = this.made[guide];
    if (old) {
      old.removeFromParent();
      old.traverse((o) => {
        if (o instanceof THREE.Mesh || o instanceof THREE.LineSegments) o.geometry.dispose();
        if (o instanceof THREE.Sprite) {
          o.material.map?.dispose();
          o.material.dispose();
        }
      });
      delete this.made[guide];
    }
    if (!this.shown[guide] || this.box.isEmpty()) return;
    const { min, max } = this.box;
    const across = this.box.getSize(new THREE.Vector3());
    const size = Math.max(across.x, across.y, across.z, 1e-3);
    const made = guide === 'figure' ? figure() : guide === 'staff' ? staff(max.y, size) : grid(size);
    if (guide === 'figure') made.position.set(max.x + 0.12 * size + 0.2 * FIGURE_M, 0, (min.z + max.z) / 2);
    if (guide === 'staff') made.position.set(min.x - 0.08 * size, 0, (min.z + max.z) / 2);
    if (guide === 'grid') made.position.set(0, 0.002 * size, 0);
    this.made[guide] = made;
    this.group.add(made);
  }

  /** The figure turns about the vertical to who looks at it. */
  face(camera: THREE.Camera): void {
    const { figure } = this.made;
    if (!figure) return;
    const way = camera.getWorldDirection(new THREE.Vector3());
    if (Math.hypot(way.x, way.z) > 1e-3) figure.rotation.y = Math.atan2(-way.x, -way.z);
  }
}
