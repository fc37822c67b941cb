/** The hand that places a plant: handles that move, turn and size it, in steps or freely. */
import * as THREE from 'three';
import type { Gizmo } from '../placing/scene';
import type { Carry } from '../wire';
import type { GizmoEvents, Handles } from './gizmo';

/** What a gizmo snaps to: metres, degrees, sizes. */
const SNAP = { m: 0.25, deg: 15, size: 0.1 } as const;
const SIZES = { least: 0.001, most: 1000 } as const;

const UP = new THREE.Vector3(0, 1, 0);

/** A plant that goes where others go, and how it stood. */
interface Hanging {
  place: THREE.Object3D;
  position: THREE.Vector3;
  turn: number;
  scale: number;
}

interface Placed {
  position: [number, number, number];
  yaw: number;
  scale: number;
}

/** Lays what a gizmo moved on its steps, where it has any, and says where it is; `was`: its size before. */
function placed(place: THREE.Object3D, gizmo: Gizmo | undefined, was: number, snaps: boolean): Placed {
  const within = (size: number): number => Math.min(SIZES.most, Math.max(SIZES.least, size));
  const before = within(place.scale.x);
  if (gizmo === 'scale') {
    // Any handle sizes the whole.
    const parts = [place.scale.x, place.scale.y, place.scale.z];
    const to = parts.reduce((a, b) => (Math.abs(b - was) > Math.abs(a - was) ? b : a));
    place.scale.setScalar(within(Math.abs(to)));
  }
  let yaw = THREE.MathUtils.radToDeg(new THREE.Euler().setFromQuaternion(place.quaternion, 'YXZ').y);
  if (snaps) {
    const to = (x: number, step: number): number => Math.round(x / step) * step;
    const { x, y, z } = place.position;
    if (gizmo === 'translate') place.position.set(to(x, SNAP.m), y, to(z, SNAP.m));
    if (gizmo === 'rotate') {
      yaw = to(yaw, SNAP.deg);
      place.rotation.set(0, THREE.MathUtils.degToRad(yaw), 0);
    }
    if (gizmo === 'scale') place.scale.setScalar(Math.max(SNAP.size, to(place.scale.x, SNAP.size)));
  }
  const round = (x: number): number => Math.round(x * 1000) / 1000;
  const { x, y, z } = place.position;
  return {
    position: [round(x), round(y), round(z)],
    yaw: Math.round(yaw * 10) / 10,
    scale: round(gizmo === 'scale' ? place.scale.x : before),
  };
}

export class Placer {
  private handles: Handles | undefined;
  private gizmo: Gizmo | undefined;
  /** Gizmos go by steps; while Shift is held, the other way. */
  snaps = false;
  private shifted = false;
  /** Several plants hang on it and go where it goes. */
  private readonly pivot = new THREE.Object3D();
  private readonly from = new THREE.Vector3();
  private hanging: Hanging[] = [];

  constructor(
    private readonly camera: THREE.Camera,
    private readonly canvas: HTMLCanvasElement,
    private readonly scene: THREE.Scene,
    private readonly events: GizmoEvents,
  ) {
    const shift = (e: PointerEvent): void => {
      this.shifted = e.shiftKey;
    };
    canvas.addEventListener('pointerdown', shift, { capture: true });
    canvas.addEventListener('pointermove', shift, { capture: true });
  }

  async take(gizmo: Gizmo | undefined): Promise<void> {
    this.gizmo = gizmo;
    if (!gizmo || this.handles) return;
    const { Handles } = await import('./gizmo');
    this.handles ??= new Handles(this.camera, this.canvas, this.scene, this.events);
  }

  /** Puts the handles to a plant, or amid those that go together; none takes the handles away. */
  show(places: readonly THREE.Object3D[], together: boolean): void {
    this.pivot.removeFromParent();
    this.hanging = [];
    const amid = together && places.length > 0;
    if (amid) {
      this.hanging = places.map((place) => ({
        place,
        position: place.position.clone(),
        turn: place.rotation.y,
        scale: place.scale.x,
      }));
      this.from.set(0, 0, 0);
      for (const { position } of this.hanging) this.from.addScaledVector(position, 1 / places.length);
      this.pivot.position.copy(this.from);
      this.pivot.rotation.set(0, 0, 0);
      this.pivot.scale.setScalar(1);
      places[0]!.parent?.add(this.pivot);
    }
    this.handles?.show(amid ? this.pivot : places[0], this.gizmo);
  }

  /** Takes the plants along that hang together, and says how they were carried. */
  carried(): Carry {
    const { position, yaw, scale } = placed(this.pivot, this.gizmo, 1, this.snaps !== this.shifted);
    const turn = THREE.MathUtils.degToRad(yaw);
    for (const { place, ...was } of this.hanging) {
      place.position.copy(was.position).sub(this.from).multiplyScalar(scale).applyAxisAngle(UP, turn);
      place.position.add(this.pivot.position);
      place.rotation.set(0, was.turn + turn, 0);
      place.scale.setScalar(was.scale * scale);
    }
    const about = this.from.toArray();
    const by = position.map((x, k) => x - about[k]!) as [number, number, number];
    return { about, by, turn_deg: yaw, scale };
  }

  get isShown(): boolean {
    return this.handles?.isShown ?? false;
  }

  setVisible(on: boolean): void {
    this.handles?.setVisible(on);
  }

  /** They go along one axis only, or along all of them again. */
  only(axis: 'x' | 'z' | undefined): void {
    this.handles?.only(axis);
  }

  get isUnderPointer(): boolean {
    return this.handles?.isUnderPointer ?? false;
  }

  /** Where they left a plant; `was`: its size before. */
  placed(place: THREE.Object3D, was: number): Placed {
    return placed(place, this.gizmo, was, this.snaps !== this.shifted);
  }
}
