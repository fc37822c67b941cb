/** An obstacle that a hand draws out: a ball from its middle, a box from a corner. In the coordinates of the plant. */
import * as THREE from 'three';
import type { Obstacle } from '../wire';

export type ObstacleKind = 'ball' | 'box';
type Place = readonly [number, number, number];

/** The obstacle between two places, metres; one that is hardly drawn out is as large as `usual`. */
export function obstacleOf(kind: ObstacleKind, from: Place, to: Place, usual: number): Obstacle {
  const gap = Math.hypot(...from.map((x, i) => to[i]! - x));
  const drawn = gap > usual / 4;
  const exact = (x: number): number => Math.round(x * 1000) / 1000;
  if (kind === 'ball')
    return {
      shape: 'sphere',
      centre: from.map(exact) as [number, number, number],
      radius_m: Math.max(0.001, exact(drawn ? gap : usual)),
    };
  // Held straight, a corner lies in a plane with the other: it has some thickness nevertheless.
  const sides = from.map((x, i) => {
    const [low, high] = drawn ? [Math.min(x, to[i]!), Math.max(x, to[i]!)] : [x - usual / 2, x + usual / 2];
    const least = Math.max(0.001, (drawn ? gap : usual) / 20);
    const wide = Math.max(least, high - low);
    const middle = (low + high) / 2;
    return [exact(middle - wide / 2), exact(middle + wide / 2)] as const;
  });
  const [x, y, z] = sides as [(typeof sides)[0], (typeof sides)[0], (typeof sides)[0]];
  return { shape: 'box', min: [x[0], y[0], z[0]], max: [x[1], y[1], z[1]] };
}

export class Placing {
  kind: ObstacleKind | undefined;
  private from: Place | undefined;
  private to: Place | undefined;
  private readonly look = new THREE.MeshBasicMaterial({
    color: 0xe8845c,
    transparent: true,
    opacity: 0.4,
    depthWrite: false,
    toneMapped: false,
  });
  private readonly ghosts = {
    ball: new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), this.look),
    box: new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1), this.look),
  };

  get isOn(): boolean {
    return this.kind !== undefined;
  }

  /** Whether it is being drawn out. */
  get isDrawn(): boolean {
    return this.from !== undefined;
  }

  /** Takes one into the hand; undefined: lays it down. */
  put(kind: ObstacleKind | undefined): void {
    this.kind = kind;
    this.from = this.to = undefined;
    for (const ghost of Object.values(this.ghosts)) ghost.removeFromParent();
  }

  /** What is seen of it, from its first place on. */
  begin(at: Place): THREE.Object3D {
    this.from = this.to = at;
    const ghost = this.ghosts[this.kind ?? 'ball'];
    ghost.scale.setScalar(1e-6);
    ghost.position.set(...at);
    return ghost;
  }

  follow(at: Place): void {
    if (!this.kind || !this.from) return;
    this.to = at;
    const shape = obstacleOf(this.kind, this.from, at, 0);
    const { ball, box } = this.ghosts;
    if (shape.shape === 'sphere') {
      ball.position.set(...shape.centre);
      ball.scale.setScalar(shape.radius_m);
    } else if (shape.shape === 'box') {
      box.position.set(...mean(shape.min, shape.max));
      box.scale.set(...(shape.min.map((low, i) => shape.max[i]! - low) as [number, number, number]));
    }
  }

  /** What was drawn out, where the hand was seen last; nothing before it began. */
  end(usual: number): Obstacle | undefined {
    const { kind, from, to } = this;
    if (!kind || !from || !to) return undefined;
    this.put(undefined);
    return obstacleOf(kind, from, to, usual);
  }
}

const mean = (a: Place, b: Place): [number, number, number] =>
  a.map((x, i) => (x + b[i]!) / 2) as [number, number, number];
