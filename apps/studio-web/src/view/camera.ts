/** The camera: turned about what it looks at, led to a wish by itself, walked through the scene, and kept. */
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Box } from '../sheet/geometry';
import type { PlantView } from '../wire';
import { Walk, type WalkMode } from './walk';

export const SIDES = ['front', 'back', 'left', 'right', 'top', 'bottom'] as const;
export type Side = (typeof SIDES)[number];

/** Where a camera stands, in heights of what is shown. */
export interface Pose {
  readonly position: readonly [number, number, number];
  readonly target: readonly [number, number, number];
  /** Angle from the lower to the upper edge, degrees. */
  readonly lens: number;
}

/** As many cameras are kept. */
export const MOST_CAMERAS = 9;

const isTriple = (x: unknown): x is Pose['position'] =>
  Array.isArray(x) && x.length === 3 && x.every((n) => typeof n === 'number' && Math.abs(n) < 1000);

/** Cameras that were kept, as far as they can be used. */
export function posesFrom(kept: unknown): Pose[] {
  return (Array.isArray(kept) ? kept : [])
    .filter(
      (p): p is Pose =>
        typeof p === 'object' &&
        p !== null &&
        isTriple((p as Pose).position) &&
        isTriple((p as Pose).target) &&
        typeof (p as Pose).lens === 'number',
    )
    .slice(0, MOST_CAMERAS);
}

/** Angles about the vertical and from the zenith. */
const TOWARDS: Record<Side, readonly [number, number]> = {
  front: [0, Math.PI / 2],
  back: [Math.PI, Math.PI / 2],
  left: [-Math.PI / 2, Math.PI / 2],
  right: [Math.PI / 2, Math.PI / 2],
  top: [0, 0.001],
  bottom: [0, Math.PI - 0.001],
};
/** As low as a hand turns the view by itself: the ground has an upper side only. */
const LOWEST = Math.PI * 0.53;
const FARTHEST = 12;
/** Where a camera stands at first: before the plants, a little above their middle. */
const FIRST_PHI = 0.45 * Math.PI;
const FIRST_DISTANCE = 3;
export const LENS = { first: 32, low: 12, high: 90 } as const;

interface Wish {
  target: THREE.Vector3;
  distance: number;
  /** Angles, where the camera is to go round as well. */
  theta?: number;
  phi?: number;
}

export interface RigEvents {
  redraw(): void;
  /** A hand takes the camera; `turns`: about what it looks at. */
  taken(turns: boolean): void;
  /** How high a walker's eyes are, in heights of what is shown, and what a metre is. */
  eyes(): { height: number; metre: number };
  walked(mode: WalkMode | undefined): void;
}

/**
 * Has a camera see the part of a plant's front view that the sheet shows. The sheet's height decides; its middle is the
 * picture's middle, whatever the widths are. `scale`: units of the stage a metre, `up`: of the plant's foot, `aspect`: width by
 * height of the picture.
 */
export function frameSheet(
  camera: THREE.OrthographicCamera,
  front: NonNullable<PlantView['front']>,
  sheet: Box,
  scale: number,
  up: number,
  aspect: number,
): void {
  const k = front.metres_per_unit * scale;
  const x = ((sheet.left + sheet.right) / 2 - front.x) * k;
  const y = ((sheet.bottom + sheet.top) / 2 - front.y) * k + up;
  const half = ((sheet.top - sheet.bottom) / 2) * k;
  const wide = half * aspect;
  [camera.left, camera.right, camera.bottom, camera.top] = [x - wide, x + wide, y - half, y + half];
  camera.position.set(0, 0, 10);
  camera.updateProjectionMatrix();
}

export class Rig {
  readonly far = new THREE.PerspectiveCamera(LENS.first, 1, 0.01, 200);
  readonly controls: OrbitControls;
  private wish: Wish | undefined;
  private walk: Walk | undefined;

  /** `damped`: the view turns on a little after the hand let go, which takes many pictures. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly events: RigEvents,
    damped: boolean,
  ) {
    this.controls = new OrbitControls(this.far, canvas);
    this.controls.enableDamping = damped;
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = 0.1;
    this.controls.maxDistance = FARTHEST;
    this.controls.maxPolarAngle = LOWEST;
    this.controls.target.set(0, 0.48, 0);
    this.standBefore(FIRST_DISTANCE);
    // What lies under the pointer stays there, and what is looked at stays near the plants.
    this.controls.zoomToCursor = true;
    this.controls.cursor.set(0, 0.48, 0);
    this.controls.maxTargetRadius = 3;
    this.controls.addEventListener('change', () => events.redraw());
    canvas.addEventListener('keydown', (e) => this.key(e));
  }

  // What it does by itself ---------------------------------------------------------------------------------------

  get isLed(): boolean {
    return this.wish !== undefined;
  }

  leave(): void {
    this.wish = undefined;
  }

  /** With a tool in the hand the second button or two fingers turn the view. */
  setHands(on: boolean): void {
    this.controls.mouseButtons = on
      ? { LEFT: null, MIDDLE: THREE.MOUSE.PAN, RIGHT: THREE.MOUSE.ROTATE }
      : { LEFT: THREE.MOUSE.ROTATE, MIDDLE: THREE.MOUSE.DOLLY, RIGHT: THREE.MOUSE.PAN };
    this.controls.touches = on
      ? { ONE: null, TWO: THREE.TOUCH.DOLLY_ROTATE }
      : { ONE: THREE.TOUCH.ROTATE, TWO: THREE.TOUCH.DOLLY_PAN };
  }

  /** Wishes to see a box whole; `across`: the share of the height that is free on both sides. */
  frame(box: THREE.Box3, across: number, now: boolean): void {
    const radius = box.getSize(new THREE.Vector3()).length() / 2;
    // Whoever walks is led by nothing else.
    if (!(radius > 0) || this.walk) return;
    const angle = THREE.MathUtils.degToRad(this.far.fov / 2);
    const distance = Math.min(FARTHEST, (radius / Math.sin(angle) / across) * 0.98);
    this.controls.minDistance = Math.min(0.1, Math.max(0.004, 0.4 * radius));
    this.wish = { ...this.wish, target: box.getCenter(new THREE.Vector3()), distance };
    if (now) this.glide(1);
  }

  /** Stands where it stood at first, as far away as it is, and is led nowhere else. */
  begin(): void {
    this.stopWalking();
    this.wish = undefined;
    this.controls.maxPolarAngle = LOWEST;
    this.standBefore(this.far.position.distanceTo(this.controls.target));
    this.events.redraw();
  }

  private standBefore(distance: number): void {
    this.far.position.setFromSphericalCoords(distance, FIRST_PHI, 0).add(this.controls.target);
  }

  /**
   * Sees a part of a plane as an orthographic camera before it does. `middle`: of what is seen; `towards`: unit vector from the
   * plane to the camera; `height`: from the lower to the upper edge; `shift`: of the middle of the picture, in shares of its
   * height, rightwards and upwards. Units of the stage.
   */
  face(
    middle: THREE.Vector3,
    towards: THREE.Vector3,
    height: number,
    [right, up]: readonly [number, number],
  ): void {
    const { target } = this.controls;
    const across = new THREE.Vector3().crossVectors(this.far.up, towards).normalize();
    target
      .copy(middle)
      .addScaledVector(across, right * height)
      .addScaledVector(this.far.up, up * height);
    const distance = height / (2 * Math.tan(THREE.MathUtils.degToRad(this.far.fov / 2)));
    this.far.position.copy(target).addScaledVector(towards, Math.min(FARTHEST, distance));
    this.wish = undefined;
    this.controls.update();
    this.events.redraw();
  }

  /** Goes round to a side. */
  side(side: Side): void {
    this.stopWalking();
    const [theta, phi] = TOWARDS[side];
    const target = this.wish?.target ?? this.controls.target.clone();
    const distance = this.wish?.distance ?? this.far.position.distanceTo(this.controls.target);
    this.controls.maxPolarAngle = side === 'bottom' ? Math.PI : LOWEST;
    this.wish = { target, distance, theta, phi };
    this.events.redraw();
  }

  /** Moves the camera a share of the way to where it should be; true when it is there. */
  glide(share: number): boolean {
    if (!this.wish) return true;
    const { target, distance, theta, phi } = this.wish;
    const arm = new THREE.Spherical().setFromVector3(this.far.position.clone().sub(this.controls.target));
    arm.radius += (distance - arm.radius) * share;
    let turned = 0;
    if (theta !== undefined && phi !== undefined) {
      // The shorter way round.
      const way = THREE.MathUtils.euclideanModulo(theta - arm.theta + Math.PI, 2 * Math.PI) - Math.PI;
      turned = Math.abs(way) * Math.sin(phi) + Math.abs(phi - arm.phi);
      arm.theta += way * share;
      arm.phi += (phi - arm.phi) * share;
      arm.makeSafe();
    }
    this.controls.target.lerp(target, share);
    this.far.position.setFromSpherical(arm).add(this.controls.target);
    const there =
      Math.abs(arm.radius - distance) < 1e-3 &&
      turned * (1 - share) < 2e-3 &&
      this.controls.target.distanceTo(target) < 1e-3;
    if (there) this.wish = { target, distance };
    return there;
  }

  /** Before each picture. */
  update(): void {
    if (!this.walk) this.controls.update();
    const distance = this.far.position.distanceTo(this.controls.target);
    const near = Math.min(0.01, Math.max(0.0005, 0.02 * distance));
    if (near === this.far.near) return;
    this.far.near = near;
    this.far.updateProjectionMatrix();
  }

  // Lens and places that are kept --------------------------------------------------------------------------------

  get lens(): number {
    return this.far.fov;
  }

  /** Another lens from a distance at which what is looked at keeps its size. */
  setLens(degrees: number): void {
    const to = Math.min(LENS.high, Math.max(LENS.low, degrees));
    const tan = (a: number): number => Math.tan(THREE.MathUtils.degToRad(a / 2));
    const by = tan(this.far.fov) / tan(to);
    this.far.fov = to;
    this.far.updateProjectionMatrix();
    const arm = this.far.position.clone().sub(this.controls.target).multiplyScalar(by);
    this.far.position.copy(this.controls.target).add(arm.clampLength(this.controls.minDistance, FARTHEST));
    if (this.wish) this.wish = { ...this.wish, distance: Math.min(FARTHEST, this.wish.distance * by) };
    this.events.redraw();
  }

  get pose(): Pose {
    const round = (v: THREE.Vector3): [number, number, number] => [
      Math.round(v.x * 1e4) / 1e4,
      Math.round(v.y * 1e4) / 1e4,
      Math.round(v.z * 1e4) / 1e4,
    ];
    return {
      position: round(this.far.position),
      target: round(this.controls.target),
      lens: Math.round(this.far.fov * 10) / 10,
    };
  }

  /** Back to where the camera stood once. */
  take({ position, target, lens }: Pose): void {
    this.stopWalking();
    this.events.taken(true);
    this.wish = undefined;
    this.controls.maxPolarAngle = position[1] < target[1] - 0.01 ? Math.PI : LOWEST;
    this.far.fov = Math.min(LENS.high, Math.max(LENS.low, lens));
    this.far.updateProjectionMatrix();
    this.controls.target.set(...target);
    this.far.position.set(...position);
    this.events.redraw();
  }

  // Walking ------------------------------------------------------------------------------------------------------

  get walking(): WalkMode | undefined {
    return this.walk?.mode;
  }

  /** Through the scene on foot or in flight; the same mode again ends it. */
  setWalking(mode: WalkMode | undefined): void {
    const was = this.walk?.mode;
    this.stopWalking();
    if (mode === undefined || mode === was) return;
    this.events.taken(true);
    this.wish = undefined;
    this.controls.enabled = false;
    this.walk = new Walk(this.far, this.canvas, mode, this.events.eyes(), {
      moved: () => this.events.redraw(),
      end: () => this.setWalking(undefined),
    });
    this.canvas.focus({ preventScroll: true });
    this.events.walked(mode);
    this.events.redraw();
  }

  /** A walker goes there until led elsewhere: right, up and ahead, each -1 to 1. */
  lead(right: number, up: number, ahead: number): void {
    this.walk?.lead(right, up, ahead);
  }

  stopWalking(): void {
    if (!this.walk) return;
    this.walk.dispose();
    this.walk = undefined;
    this.controls.enabled = true;
    // What is looked at is ahead, at the depth of the plants.
    const ahead = this.far.getWorldDirection(new THREE.Vector3());
    const depth = Math.max(0.2, -this.far.position.clone().sub(this.controls.cursor).dot(ahead));
    this.controls.target.copy(this.far.position).addScaledVector(ahead, Math.min(depth, 3));
    this.events.walked(undefined);
    this.events.redraw();
  }

  // Keys ---------------------------------------------------------------------------------------------------------

  private key(e: KeyboardEvent): void {
    if (this.walk) return;
    const turn: Record<string, [number, number]> = {
      ArrowLeft: [-0.12, 0],
      ArrowRight: [0.12, 0],
      ArrowUp: [0, -0.1],
      ArrowDown: [0, 0.1],
    };
    const by = turn[e.key];
    const zoom = e.key === '+' || e.key === '=' ? 0.88 : e.key === '-' ? 1.14 : 0;
    if (!by && !zoom) return;
    e.preventDefault();
    e.stopPropagation();
    this.events.taken(by !== undefined);
    const arm = new THREE.Spherical().setFromVector3(this.far.position.clone().sub(this.controls.target));
    if (by) {
      arm.theta += by[0];
      arm.phi = Math.min(this.controls.maxPolarAngle, Math.max(0.05, arm.phi + by[1]));
    } else {
      arm.radius = Math.min(FARTHEST, Math.max(this.controls.minDistance, arm.radius * zoom));
    }
    this.far.position.setFromSpherical(arm).add(this.controls.target);
    this.events.redraw();
  }
}
