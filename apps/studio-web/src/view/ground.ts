/** Grass and soil under the plants: a painted disc that fades into the haze, and blades or pebbles around the stems. */
import * as THREE from 'three';
import type { GroundKind, Vec3 } from './moods';

/** Rings of the disc, and how many of them have a depth: what lies beyond is haze, which nothing touches. */
const RINGS = 40;
const NEAR_RINGS = 18;
/** As far as the ground reaches, in heights of what stands on it. */
const FAR = 60;
/** How bright the ground looks beside the horizon. */
const GROUND_SHOWN = 0.44;
/** Of each ground, linear: what it throws back up. */
export const ALBEDO: Record<GroundKind, THREE.Color> = {
  plain: new THREE.Color(0xdfe2cf),
  grass: new THREE.Color(0x56702f),
  soil: new THREE.Color(0x6b5440),
  none: new THREE.Color(0xb0b0a8),
};

/**
 * How much of what an upright face turned to the sun would receive a ground receives beside what falls on it from above: blades
 * of grass stand upright, so that a meadow is bright in the evening too; soil is flat.
 */
const UPRIGHT: Record<GroundKind, number> = { plain: 0, grass: 0.35, soil: 0.06, none: 0 };

/** What the sun gives to a ground of this kind, relative to a face turned to it. */
export function litBy(kind: GroundKind, [x, y, z]: Vec3): number {
  return Math.max(0, y) + UPRIGHT[kind] * Math.hypot(x, z);
}

/** The share of the horizon in a linear mixture that looks as a share of haze does where colours are mixed as shown. */
function linearHaze(haze: number, horizon: number): number {
  const ground = GROUND_SHOWN ** 2.2;
  const mixed = (haze + GROUND_SHOWN * (1 - haze)) ** 2.2;
  // What is brighter than white counts in full until nothing else is there.
  const bright = THREE.MathUtils.lerp(Math.max(1, horizon), 1, haze ** 8);
  return (mixed - ground) / (bright - ground);
}

/** The same numbers every time. */
function draws(seed: number): () => number {
  let s = seed >>> 0;
  return () => {
    s = (s + 0x6d2b79f5) | 0;
    let t = Math.imul(s ^ (s >>> 15), 1 | s);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

const hsl = (h: number, s: number, l: number): string =>
  `hsl(${h.toFixed(1)} ${s.toFixed(1)}% ${l.toFixed(1)}%)`;

/** Paints at a place and at its copies beyond the edges, so that tiles meet. */
function tiled(
  size: number,
  x: number,
  y: number,
  reach: number,
  paint: (x: number, y: number) => void,
): void {
  for (const dx of [-size, 0, size])
    for (const dy of [-size, 0, size]) {
      const [px, py] = [x + dx, y + dy];
      if (px > -reach && px < size + reach && py > -reach && py < size + reach) paint(px, py);
    }
}

function paintGrass(c: CanvasRenderingContext2D, size: number): void {
  const next = draws(7);
  c.fillStyle = hsl(78, 32, 36);
  c.fillRect(0, 0, size, size);
  for (let i = 0; i < 70; i += 1) {
    // Patches: a lawn of one green is a billiard table.
    const [x, y, r] = [next() * size, next() * size, size * (0.05 + 0.13 * next())];
    const style = `hsl(${62 + 34 * next()} ${26 + 16 * next()}% ${31 + 17 * next()}% / 40%)`;
    tiled(size, x, y, r, (px, py) => {
      const g = c.createRadialGradient(px, py, 0, px, py, r);
      g.addColorStop(0, style);
      g.addColorStop(1, 'transparent');
      c.fillStyle = g;
      c.fillRect(px - r, py - r, 2 * r, 2 * r);
    });
  }
  c.lineCap = 'round';
  for (let i = 0; i < size * 16; i += 1) {
    const [x, y, a] = [next() * size, next() * size, next() * 2 * Math.PI];
    const length = size * (0.008 + 0.018 * next());
    c.strokeStyle = hsl(66 + 32 * next(), 26 + 18 * next(), 26 + 30 * next() ** 1.3);
    c.lineWidth = size * (0.0012 + 0.0016 * next());
    const bend = a + (next() - 0.5) * 1.4;
    tiled(size, x, y, length, (px, py) => {
      c.beginPath();
      c.moveTo(px, py);
      c.quadraticCurveTo(
        px + 0.5 * length * Math.cos(a),
        py + 0.5 * length * Math.sin(a),
        px + length * Math.cos(bend),
        py + length * Math.sin(bend),
      );
      c.stroke();
    });
  }
}

function paintSoil(c: CanvasRenderingContext2D, size: number): void {
  const next = draws(11);
  c.fillStyle = hsl(27, 27, 27);
  c.fillRect(0, 0, size, size);
  const blob = (r: number, style: string, x: number, y: number): void => {
    tiled(size, x, y, r, (px, py) => {
      const g = c.createRadialGradient(px, py, 0, px, py, r);
      g.addColorStop(0, style);
      g.addColorStop(1, 'transparent');
      c.fillStyle = g;
      c.fillRect(px - r, py - r, 2 * r, 2 * r);
    });
  };
  for (let i = 0; i < 140; i += 1)
    blob(
      size * (0.03 + 0.1 * next()),
      `hsl(${20 + 14 * next()} ${18 + 16 * next()}% ${18 + 22 * next()}% / 30%)`,
      next() * size,
      next() * size,
    );
  for (let i = 0; i < size * 6; i += 1) {
    // Crumbs: light above, dark below.
    const [x, y, r] = [next() * size, next() * size, size * (0.001 + 0.006 * next() ** 3)];
    const [h, s, l] = [20 + 16 * next(), 14 + 18 * next(), 22 + 18 * next()];
    const turn = next() * Math.PI;
    tiled(size, x, y, 2 * r, (px, py) => {
      for (const [dy, light] of [
        [0.5, -9],
        [-0.2, 0],
        [-0.55, 5],
      ] as const) {
        c.fillStyle = hsl(h, s, l + light);
        c.beginPath();
        c.ellipse(px, py + dy * r, r * (light > 0 ? 0.55 : 1), r * (light > 0 ? 0.35 : 0.75), turn, 0, 7);
        c.fill();
      }
    });
  }
}

function texture(kind: 'grass' | 'soil', size: number): THREE.CanvasTexture {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const c = canvas.getContext('2d')!;
  if (kind === 'grass') paintGrass(c, size);
  else paintSoil(c, size);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  map.wrapS = map.wrapT = THREE.RepeatWrapping;
  return map;
}

/** A disc with ever wider rings; its corners hold how much of it is seen and how light it is. */
function disc(): THREE.BufferGeometry {
  const [rings, sides] = [RINGS, 72];
  const geometry = new THREE.RingGeometry(0, 1, sides, rings);
  const position = geometry.getAttribute('position') as THREE.BufferAttribute;
  const colors = new Float32Array(4 * position.count);
  for (let i = 0; i < position.count; i += 1) {
    const [x, y] = [position.getX(i), position.getY(i)];
    const r = Math.hypot(x, y);
    const far = FAR * r ** 3;
    const k = r > 0 ? far / r : 0;
    position.setXY(i, x * k, y * k);
    // Long waves hide that the texture repeats.
    const wave = 0.9 + 0.1 * Math.sin(1.7 * x * k + 1.3 * Math.sin(0.9 * y * k)) * Math.sin(1.1 * y * k + 2);
    // How much of the haze hides it, as it looks.
    const seen = 1 - THREE.MathUtils.smoothstep(Math.log(1 + far), Math.log(2.6), Math.log(0.7 * FAR));
    colors.set([wave, wave, wave, seen], 4 * i);
  }
  geometry.setAttribute('color', new THREE.BufferAttribute(colors, 4));
  const uv = geometry.getAttribute('uv') as THREE.BufferAttribute;
  for (let i = 0; i < uv.count; i += 1) uv.setXY(i, position.getX(i), position.getY(i));
  geometry.rotateX(-Math.PI / 2);
  const inner = NEAR_RINGS * sides * 6;
  geometry.addGroup(0, inner, 0);
  geometry.addGroup(inner, Infinity, 1);
  return geometry;
}

/** A blade of grass one high, seen from both sides. */
function blade(): THREE.BufferGeometry {
  const rows = [
    [0, 0.045, 0],
    [0.4, 0.04, 0.06],
    [0.75, 0.026, 0.2],
    [1, 0, 0.42],
  ] as const;
  const [positions, normals, colors]: [number[], number[], number[]] = [[], [], []];
  for (const [y, half, lean] of rows)
    for (const side of half === 0 ? [0] : [-1, 1]) {
      positions.push(side * half, y * (1 - 0.25 * lean), lean);
      normals.push(0, 1, 0);
      const light = 0.5 + 0.75 * y;
      colors.push(light, light, light * (1 - 0.15 * y));
    }
  const front = [0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5, 4, 5, 6];
  const back = front.flatMap((_, i) => (i % 3 === 0 ? [front[i]!, front[i + 2]!, front[i + 1]!] : []));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normals, 3));
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(colors, 3));
  geometry.setIndex([...front, ...back]);
  return geometry;
}

/** How tall grass is beside a plant, in heights of what stands there: a lawn by a flower, a meadow by a tree. */
export function grassHeight(metre: number): number {
  return Math.min(0.045, Math.max(0.009, 0.05 * metre));
}

export class Ground {
  readonly group = new THREE.Group();
  private kind: GroundKind = 'plain';
  private metre = 1;
  private fine = false;
  private tufts: THREE.InstancedMesh | undefined;
  private readonly maps = new Map<string, THREE.CanvasTexture>();
  private readonly sheet: THREE.Mesh;
  private built = '';
  private toned: number | undefined;
  /** Which way all of the ground is turned, as far as its light goes: up, and to the sun as far as it stands upright. */
  private readonly turned = { value: new THREE.Vector3(0, 1, 0) };
  /** How much is seen of each corner of the disc. */
  private readonly clear: Float32Array;

  constructor() {
    this.sheet = new THREE.Mesh(disc());
    const colors = this.sheet.geometry.getAttribute('color') as THREE.BufferAttribute;
    this.clear = Float32Array.from({ length: colors.count }, (_, i) => colors.getW(i));
    this.sheet.receiveShadow = true;
    this.sheet.renderOrder = -1;
    this.group.add(this.sheet);
    this.group.visible = false;
  }

  /** `metre`: in heights of what stands here; `fine`: with gloss and more blades. */
  set(kind: GroundKind, metre: number, fine: boolean): void {
    // Sizes in steps: a plant that grows a little does not sow the meadow anew.
    const step = 2 ** (Math.round(Math.log2(Math.max(1e-4, metre)) * 2) / 2);
    [this.kind, this.metre, this.fine] = [kind, step, fine];
    this.group.visible = kind === 'grass' || kind === 'soil';
    if (this.group.visible) this.build();
  }

  /** The way to the sun. */
  setSun(way: Vec3): void {
    const [x, , z] = way;
    const share = UPRIGHT[this.kind];
    this.turned.value.set(share * x, 1, share * z).normalize();
  }

  private build(): void {
    const { kind, fine, metre } = this;
    if (kind !== 'grass' && kind !== 'soil') return;
    const key = `${kind} ${fine} ${metre}`;
    if (key === this.built) return;
    this.built = key;
    const size = fine ? 1024 : 512;
    const name = `${kind} ${size}`;
    const map = this.maps.get(name) ?? texture(kind, size);
    this.maps.set(name, map);
    // A tile of a metre and a half, as far as that is neither a blur nor a pattern.
    const tile = Math.min(1.4, Math.max(0.6, 1.5 * metre));
    map.repeat.setScalar(1 / tile);
    map.anisotropy = fine ? 8 : 2;
    for (const material of [this.sheet.material].flat()) material.dispose();
    const of = { map, vertexColors: true, transparent: true };
    this.sheet.material = [this.look(of), this.look({ ...of, depthWrite: false })];
    if (this.tufts) {
      this.group.remove(this.tufts);
      this.tufts.geometry.dispose();
      (this.tufts.material as THREE.Material).dispose();
      this.tufts.dispose();
    }
    this.tufts = kind === 'grass' ? this.meadow() : this.pebbles();
    this.group.add(this.tufts);
  }

  /**
   * How bright the horizon is where colours are toned after they are mixed: then less haze has the same look. Nothing where
   * they are mixed as they are shown.
   */
  setToned(horizon: number | undefined): void {
    if (horizon === this.toned) return;
    this.toned = horizon;
    const colors = this.sheet.geometry.getAttribute('color') as THREE.BufferAttribute;
    for (let i = 0; i < colors.count; i += 1) {
      const haze = 1 - this.clear[i]!;
      colors.setW(i, 1 - (horizon === undefined ? haze : linearHaze(haze, horizon)));
    }
    colors.needsUpdate = true;
  }

  /** `stands`: lit as the ground that it is of, whichever way its faces look. */
  private look(of: THREE.MeshLambertMaterialParameters, stands = true): THREE.Material {
    const material = this.fine
      ? new THREE.MeshPhysicalMaterial({ ...of, roughness: 1, metalness: 0, specularIntensity: 0 })
      : new THREE.MeshLambertMaterial(of);
    if (!stands) return material;
    material.onBeforeCompile = (shader) => {
      shader.uniforms['groundTurned'] = this.turned;
      shader.vertexShader = shader.vertexShader
        .replace('#include <common>', '#include <common>\nuniform vec3 groundTurned;')
        .replace(
          '#include <defaultnormal_vertex>',
          '#include <defaultnormal_vertex>\ntransformedNormal = normalMatrix * groundTurned;',
        );
    };
    material.customProgramCacheKey = () => 'ground';
    return material;
  }

  private meadow(): THREE.InstancedMesh {
    const height = grassHeight(this.metre);
    const n = this.fine ? 26_000 : 5000;
    const reach = Math.min(2.2, 34 * height);
    const next = draws(23);
    const mesh = new THREE.InstancedMesh(blade(), this.look({ vertexColors: true }), n);
    const [at, tint] = [new THREE.Object3D(), new THREE.Color()];
    for (let i = 0; i < n; i += 1) {
      // Dense at the stems, thinner outwards: there the painted ground takes over.
      const r = reach * next() ** 0.8;
      const a = 2 * Math.PI * next();
      at.position.set(r * Math.cos(a), 0, r * Math.sin(a));
      at.rotation.set((next() - 0.5) * 0.5, 2 * Math.PI * next(), (next() - 0.5) * 0.5);
      const edge = 1 - 0.65 * THREE.MathUtils.smoothstep(r, 0.45 * reach, reach);
      const tall = height * (0.45 + 0.75 * next()) * edge;
      at.scale.set(tall * (1.2 + 0.8 * next()), tall, tall);
      at.updateMatrix();
      mesh.setMatrixAt(i, at.matrix);
      tint.setHSL((66 + 28 * next()) / 360, 0.26 + 0.16 * next(), 0.33 + 0.13 * next(), THREE.SRGBColorSpace);
      mesh.setColorAt(i, tint);
    }
    mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    return mesh;
  }

  private pebbles(): THREE.InstancedMesh {
    const n = 420;
    const next = draws(31);
    const size = Math.min(0.016, Math.max(0.003, 0.014 * this.metre));
    const mesh = new THREE.InstancedMesh(new THREE.IcosahedronGeometry(1, 1), this.look({}, false), n);
    const [at, tint] = [new THREE.Object3D(), new THREE.Color()];
    for (let i = 0; i < n; i += 1) {
      const r = 0.02 + 1.8 * next();
      const a = 2 * Math.PI * next();
      const s = size * (0.25 + 0.75 * next() ** 3);
      at.position.set(r * Math.cos(a), 0.15 * s, r * Math.sin(a));
      at.rotation.set(next(), 6 * next(), next());
      at.scale.set(s * (0.7 + 0.6 * next()), s * 0.55, s);
      at.updateMatrix();
      mesh.setMatrixAt(i, at.matrix);
      tint.setHSL((22 + 16 * next()) / 360, 0.12 + 0.14 * next(), 0.26 + 0.2 * next(), THREE.SRGBColorSpace);
      mesh.setColorAt(i, tint);
    }
    mesh.receiveShadow = true;
    mesh.castShadow = true;
    mesh.frustumCulled = false;
    return mesh;
  }
}
