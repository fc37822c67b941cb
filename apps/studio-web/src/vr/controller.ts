/** A tracked controller: where it is, and what its buttons say, by component and not by number. */
import * as THREE from 'three';

export type Part = 'trigger' | 'grip' | 'lower' | 'upper' | 'stick';

/** Where `xr-standard` has its buttons. */
const STANDARD = { trigger: 0, grip: 1, pad: 2, stick: 3 } as const;
/** Of these families of profiles the buttons above the stick (A and X, B and Y) stand here. */
const FACE: readonly (readonly [RegExp, { lower: number; upper?: number }])[] = [
  [
    /^(oculus-touch|meta-quest-touch|pico-|hp-mixed-reality|vive-focus-3|generic-trigger-squeeze-thumbstick)/,
    { lower: 4, upper: 5 },
  ],
  [/^valve-index/, { lower: 4 }],
];
/** What has a grip, which one of its names then says, knows where it is, even where a browser calls all places guessed. */
const PLACED = /squeeze/;
/** A button of which no touch is known counts as pressed from here on. */
const PRESSED = 0.5;
/** Further between two frames, metres, nobody moves a hand: the tracker jumped. */
const JUMP = 0.4;
/** A jump that lasts for so many frames is the new place. */
const SETTLED = 5;
/** The tip of a controller before the place that it points from, metres. */
const TIP = 0.03;

/** The number of a button, if the controller has it. */
export function indexOf(part: Part, profiles: readonly string[]): number | undefined {
  if (part === 'trigger' || part === 'grip' || part === 'stick') return STANDARD[part];
  const family = profiles.map((p) => FACE.find(([pattern]) => pattern.test(p))).find((f) => f !== undefined);
  return family?.[1][part];
}

/** Fingers that are nearer than this, metres, pinch; that are further apart than this do not. */
const PINCH = [0.018, 0.032] as const;

/** Tells from the gap between two fingertips whether they pinch. */
export class Pinch {
  closed = false;

  /** `gap`: metres; undefined where it is not known: then they do what they did. */
  read(gap: number | undefined): boolean {
    if (gap !== undefined && Number.isFinite(gap)) this.closed = gap < PINCH[this.closed ? 1 : 0];
    return this.closed;
  }
}

/** Tells a hand's way from jumps of its tracker. */
export class Track {
  private last: THREE.Vector3 | undefined;
  private strange = 0;

  /** `lost`: nothing is known of it now; `jumped`: it is somewhere else all of a sudden, and stays there. */
  read(at: THREE.Vector3 | undefined): 'here' | 'lost' | 'jumped' {
    if (!at || !Number.isFinite(at.x + at.y + at.z)) return 'lost';
    const jumps = this.last !== undefined && this.last.distanceTo(at) > JUMP;
    this.strange = jumps ? this.strange + 1 : 0;
    if (jumps && this.strange < SETTLED) return 'lost';
    this.last = (this.last ?? new THREE.Vector3()).copy(at);
    this.strange = 0;
    return jumps ? 'jumped' : 'here';
  }
}

/** One controller, or a hand that pinches. Places are in the person's own space, metres. */
export class Controller {
  /** Where it is and where it points, of the last frame in which that was known. */
  readonly aim = new THREE.Matrix4();
  readonly grip = new THREE.Matrix4();
  readonly tip = new THREE.Vector3();
  readonly direction = new THREE.Vector3();
  tracked = false;
  jumped = false;
  private readonly isPlaced: boolean;
  /** Its place was seen once: what is only guessed since then is as good as lost. */
  private seen = false;
  private readonly track = new Track();
  /** Thumb and forefinger are the trigger, thumb and middle finger the grip. */
  private readonly pinches = { trigger: new Pinch(), grip: new Pinch() };
  private readonly was = new Map<Part, boolean>();
  private readonly now = new Map<Part, boolean>();
  /** The numbers of the buttons: they stay while the controller does. */
  private readonly indices = new Map<Part, number | undefined>();
  /** The stick, or the touchpad under a thumb; y is up. The same pair in every frame. */
  readonly thumb: [number, number] = [0, 0];

  constructor(readonly source: XRInputSource) {
    this.isPlaced = source.hand !== undefined || source.profiles.some((p) => PLACED.test(p));
    for (const part of PARTS) this.indices.set(part, indexOf(part, source.profiles));
  }

  get handedness(): XRHandedness {
    return this.source.handedness;
  }

  read(frame: XRFrame, space: XRReferenceSpace): void {
    const aim = frame.getPose(this.source.targetRaySpace, space);
    const grip = this.source.gripSpace ? frame.getPose(this.source.gripSpace, space) : aim;
    if (aim) scratch.fromArray(aim.transform.matrix);
    const guessed = aim?.emulatedPosition ?? false;
    this.seen ||= aim !== undefined && aim !== null && !guessed;
    const known = aim && !(guessed && this.seen);
    const state = this.track.read(known ? place.setFromMatrixPosition(scratch) : undefined);
    this.tracked = state !== 'lost';
    this.jumped = state === 'jumped';
    if (this.tracked) {
      this.aim.copy(scratch);
      this.grip.copy(grip ? scratch.fromArray(grip.transform.matrix) : this.aim);
      this.direction.setFromMatrixColumn(this.aim, 2).normalize().negate();
      this.tip.setFromMatrixPosition(this.aim).addScaledVector(this.direction, TIP);
    }
    if (this.source.hand) this.readFingers(frame, space, this.source.hand);
    this.readThumb();
    for (const part of PARTS) {
      this.was.set(part, this.now.get(part) ?? false);
      this.now.set(part, this.value(part) >= PRESSED);
    }
  }

  /** Whether it has three degrees of freedom: it points, and nobody knows where it is. */
  get isPointer(): boolean {
    return !this.seen && !this.isPlaced;
  }

  /** Whether it is a hand without a controller. */
  get isHand(): boolean {
    return this.source.hand !== undefined && this.source.hand !== null;
  }

  private readFingers(frame: XRFrame, space: XRReferenceSpace, hand: XRHand): void {
    // What is not seen does not let go.
    if (!this.tracked) return;
    const thumb = tipOf(frame, space, hand, 'thumb-tip', THUMB);
    const fore = tipOf(frame, space, hand, 'index-finger-tip', FORE);
    const middle = tipOf(frame, space, hand, 'middle-finger-tip', MIDDLE);
    this.pinches.trigger.read(thumb && fore ? thumb.distanceTo(fore) : undefined);
    // The middle finger comes along when the forefinger pinches.
    const other = thumb && middle ? thumb.distanceTo(middle) : undefined;
    if (this.pinches.trigger.closed) this.pinches.grip.closed = false;
    else this.pinches.grip.read(other);
    if (thumb && fore) this.tip.addVectors(thumb, fore).multiplyScalar(0.5);
  }

  /** How far it is pressed, 0 to 1. */
  value(part: Part): number {
    if (this.isHand) return (part === 'trigger' || part === 'grip') && this.pinches[part].closed ? 1 : 0;
    const index = this.indices.get(part);
    const button = index === undefined ? undefined : this.source.gamepad?.buttons[index];
    return button ? Math.max(button.value, button.pressed ? PRESSED : 0) : 0;
  }

  holds(part: Part): boolean {
    return this.now.get(part) ?? false;
  }

  pressed(part: Part): boolean {
    return this.holds(part) && !this.was.get(part);
  }

  released(part: Part): boolean {
    return !this.holds(part) && (this.was.get(part) ?? false);
  }

  private readThumb(): void {
    const axes = this.source.gamepad?.axes;
    // The touchpad's come first, the stick's after them.
    const at = axes && axes.length >= 4 && (axes[2] || axes[3]) ? 2 : 0;
    this.thumb[0] = axes?.[at] ?? 0;
    this.thumb[1] = -(axes?.[at + 1] ?? 0);
  }

  /** A tick that the hand feels, where the controller can. */
  pulse(strength: number, ms: number): void {
    const actuator = this.source.gamepad?.hapticActuators?.[0] as
      | { pulse?(strength: number, ms: number): Promise<unknown> }
      | undefined;
    void actuator?.pulse?.(strength, ms)?.catch(() => undefined);
  }
}

/** Where a fingertip is, if that is seen. */
function tipOf(
  frame: XRFrame,
  space: XRReferenceSpace,
  hand: XRHand,
  name: XRHandJoint,
  out: THREE.Vector3,
): THREE.Vector3 | undefined {
  const joint = hand.get(name);
  const at = joint && frame.getJointPose?.(joint, space)?.transform.position;
  return at ? out.set(at.x, at.y, at.z) : undefined;
}

const [THUMB, FORE, MIDDLE] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()] as const;
const PARTS: readonly Part[] = ['trigger', 'grip', 'lower', 'upper', 'stick'];
const scratch = new THREE.Matrix4();
const place = new THREE.Vector3();
