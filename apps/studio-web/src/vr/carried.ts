/** An obstacle in the hand: it goes, turns and grows with it. All in the coordinates of the plant. */
import * as THREE from 'three';
import type { SetDown } from '../wire';

type Place = readonly [number, number, number];

/** It is at least and at most so many times as large as it was. */
const TIMES = [0.05, 20] as const;
/** A hand that trembles moves nothing: metres, and of the turn. */
const STILL = { metres: 0.0005, turn: 0.002 } as const;

export class Carried {
  times = 1;
  private readonly stood: { at: THREE.Vector3; turn: THREE.Quaternion; size: THREE.Vector3 };
  private readonly taken = new THREE.Vector3();
  private readonly now = new THREE.Vector3();
  private readonly turn = new THREE.Quaternion();
  private readonly untaken: THREE.Quaternion;

  /** `at`, `turned`: the hand that takes it. */
  constructor(
    readonly row: number,
    private readonly thing: THREE.Object3D,
    at: Place,
    turned: THREE.Quaternion,
  ) {
    const { position, quaternion, scale } = thing;
    this.stood = { at: position.clone(), turn: quaternion.clone(), size: scale.clone() };
    this.now.copy(this.taken.fromArray(at));
    this.untaken = turned.clone().invert();
  }

  /** So many times larger. */
  size(by: number): void {
    this.times = THREE.MathUtils.clamp(this.times * by, ...TIMES);
    this.show();
  }

  /** The hand is here now. */
  follow(at: Place, turned: THREE.Quaternion): void {
    this.now.fromArray(at);
    this.turn.copy(turned).multiply(this.untaken);
    this.show();
  }

  /** What was done to it; nothing where it stands as it did. */
  done(): SetDown | undefined {
    const exact = (x: number): number => Math.round(x * 1e6) / 1e6;
    const triple = (v: THREE.Vector3): [number, number, number] => [exact(v.x), exact(v.y), exact(v.z)];
    const by = this.now.clone().sub(this.taken);
    const { x, y, z, w } = this.turn;
    const isStill =
      by.length() < STILL.metres && Math.hypot(x, y, z) < STILL.turn && Math.abs(this.times - 1) < STILL.turn;
    if (isStill) return undefined;
    return {
      about: triple(this.taken),
      turn: [exact(x), exact(y), exact(z), exact(w)],
      times: exact(this.times),
      by: triple(by),
    };
  }

  putBack(): void {
    const { at, turn, size } = this.stood;
    this.thing.position.copy(at);
    this.thing.quaternion.copy(turn);
    this.thing.scale.copy(size);
  }

  private show(): void {
    const { at, turn, size } = this.stood;
    const { thing, taken, now, times } = this;
    thing.position.copy(at).sub(taken).applyQuaternion(this.turn).multiplyScalar(times).add(now);
    thing.quaternion.copy(this.turn).multiply(turn);
    thing.scale.copy(size).multiplyScalar(times);
  }
}
