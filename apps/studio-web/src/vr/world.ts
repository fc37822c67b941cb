/** Where the person stands in the scene, and how large. */
import * as THREE from 'three';

/** So tall is a plant that stands at arm's length, metres; the eyes are above its middle. */
const MODEL_M = 1.2;
/** And so far is its middle away. */
const ARM_M = 0.75;
/** At true scale it is seen whole from here. */
const BACK = 0.9;
/** A metre of the person is so many units of the stage at least and at most. */
const SIZES = [1e-3, 100] as const;
export const SNAP = Math.PI / 6;

/** Two places of the hands in the person's space, and where they were in the scene when they took hold. */
interface Hold {
  readonly at: readonly THREE.Vector3[];
}

export class World {
  /** Holds the camera and the controllers: the person's space within the scene. */
  readonly rig = new THREE.Group();
  private hold: Hold | undefined;

  /** A metre of the person in units of the stage. */
  get size(): number {
    return this.rig.scale.x;
  }

  /**
   * Before the plants: `metre` units of the stage are a metre of theirs; `reach`: half of their breadth in units.
   * `raised`: so many metres higher than the floor says, for somebody who sits.
   */
  stand(true_scale: boolean, metre: number, reach: number, raised: number): void {
    const size = true_scale ? metre : 1 / MODEL_M;
    const away = true_scale ? Math.max(1.5 * size, reach + BACK) : ARM_M * size + Math.max(0, reach - 0.5);
    this.rig.position.set(0, raised * size, away);
    this.rig.quaternion.identity();
    this.rig.scale.setScalar(THREE.MathUtils.clamp(size, ...SIZES));
    this.rig.updateMatrixWorld();
    this.hold = undefined;
  }

  /** From the person's space to the scene. */
  toScene(p: THREE.Vector3, out: THREE.Vector3): THREE.Vector3 {
    return out.copy(p).applyMatrix4(this.rig.matrixWorld);
  }

  /** Hands (in the person's space) hold the scene: one moves it, two also turn it about the vertical and scale it. */
  grasp(hands: readonly THREE.Vector3[]): void {
    if (this.hold?.at.length !== hands.length)
      this.hold =
        hands.length > 0 ? { at: hands.map((h) => this.toScene(h, new THREE.Vector3())) } : undefined;
    if (!this.hold) return;
    const { rig } = this;
    const [a, b] = hands;
    const [from, other] = this.hold.at;
    if (b && other) {
      const [now, then] = [gap.subVectors(b, a!), wide.subVectors(other, from!)];
      const [near, far] = [now.length(), then.length()];
      if (near > 1e-3 && far > 0) rig.scale.setScalar(THREE.MathUtils.clamp(far / near, ...SIZES));
      // Hands above one another say nothing about the vertical.
      if (Math.hypot(now.x, now.z) > 0.2 * near && Math.hypot(then.x, then.z) > 0.2 * far)
        rig.quaternion.setFromAxisAngle(UP, Math.atan2(now.z, now.x) - Math.atan2(then.z, then.x));
      gap.addVectors(a!, b).multiplyScalar(0.5);
      wide.addVectors(from!, other).multiplyScalar(0.5);
    } else {
      gap.copy(a!);
      wide.copy(from!);
    }
    // What the hands hold stays in them.
    rig.position.copy(wide).sub(gap.multiply(rig.scale).applyQuaternion(rig.quaternion));
    rig.updateMatrixWorld();
  }

  /** Higher by so many metres of the person. */
  raise(by: number): void {
    this.rig.position.y += by * this.size;
    this.rig.updateMatrixWorld();
  }

  /** Turns about the head (in the person's space). */
  turn(angle: number, head: THREE.Vector3): void {
    this.toScene(head, gap);
    this.rig.quaternion.premultiply(spin.setFromAxisAngle(UP, angle));
    this.rig.position.sub(gap).applyQuaternion(spin).add(gap);
    this.rig.updateMatrixWorld();
  }

  /** Stands at a place of the scene's ground, the head above it. */
  go(to: THREE.Vector3, head: THREE.Vector3): void {
    this.toScene(head, gap);
    this.rig.position.x += to.x - gap.x;
    this.rig.position.z += to.z - gap.z;
    this.rig.updateMatrixWorld();
  }

  /** Where a thrown arc meets the ground (both in the scene); undefined if it is too far away. */
  landing(from: THREE.Vector3, direction: THREE.Vector3, out: THREE.Vector3): THREE.Vector3 | undefined {
    // A throw of 7 m/s under gravity, in the person's metres.
    const { size } = this;
    const [v, g, h] = [7 * direction.y, 9.81, from.y / size];
    if (!(h >= 0)) return undefined;
    const time = (v + Math.sqrt(v * v + 2 * g * h)) / g;
    if (time > 2) return undefined;
    return out
      .copy(from)
      .addScaledVector(direction, 7 * time * size)
      .setY(0);
  }
}

const UP = new THREE.Vector3(0, 1, 0);
const gap = new THREE.Vector3();
const wide = new THREE.Vector3();
const spin = new THREE.Quaternion();
