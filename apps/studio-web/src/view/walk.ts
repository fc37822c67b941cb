/**
 * First person: on foot or in flight, by keys and by dragging. Our own and not three's: theirs take the pointer away from
 * pens and fingers, or roll, and whoever rolls is lost.
 */
import * as THREE from 'three';

export type WalkMode = 'walk' | 'fly';

interface WalkEvents {
  moved(): void;
  end(): void;
}

/** A walker's pace, m/s, and how much faster Shift is. */
const PACE = 1.4;
const RUN = 4;
/** No slower and no faster than this, in heights of what is shown each second. */
const SLOWEST = 0.25;
const FASTEST = 2.5;
/** How far a walker may go from the middle. */
const WORLD = 12;
/** Radians for each pixel of a drag. */
const TURN = 0.004;

/** Right, up, ahead. */
const KEYS: Record<string, readonly [number, number, number]> = {
  w: [0, 0, 1],
  arrowup: [0, 0, 1],
  s: [0, 0, -1],
  arrowdown: [0, 0, -1],
  a: [-1, 0, 0],
  arrowleft: [-1, 0, 0],
  d: [1, 0, 0],
  arrowright: [1, 0, 0],
  e: [0, 1, 0],
  ' ': [0, 1, 0],
  q: [0, -1, 0],
};

export class Walk {
  private readonly held = new Set<string>();
  /** Where a stick on the screen leads. */
  private readonly stick = new THREE.Vector3();
  private readonly gone = new AbortController();
  private fast = false;
  private frame = 0;
  private last = 0;
  private drag: [number, number] | undefined;
  private readonly look = new THREE.Euler(0, 0, 0, 'YXZ');

  /** `eyes`: how high they are and how long a metre is, in heights of what is shown. */
  constructor(
    private readonly camera: THREE.PerspectiveCamera,
    canvas: HTMLCanvasElement,
    readonly mode: WalkMode,
    private readonly eyes: { height: number; metre: number },
    private readonly events: WalkEvents,
  ) {
    this.look.setFromQuaternion(camera.quaternion);
    this.look.z = 0;
    if (mode === 'walk') camera.position.y = eyes.height;
    const options = { signal: this.gone.signal };
    canvas.addEventListener('keydown', (e) => this.key(e, true), options);
    canvas.addEventListener('keyup', (e) => this.key(e, false), options);
    canvas.addEventListener('blur', () => this.held.clear(), options);
    canvas.addEventListener(
      'pointerdown',
      (e) => {
        this.drag = [e.clientX, e.clientY];
        canvas.setPointerCapture(e.pointerId);
      },
      options,
    );
    canvas.addEventListener('pointermove', (e) => this.turn(e), options);
    canvas.addEventListener(
      'pointerup',
      () => {
        this.drag = undefined;
      },
      options,
    );
  }

  private key(e: KeyboardEvent, down: boolean): void {
    this.fast = e.shiftKey;
    if (e.key === 'Escape' && down) {
      e.stopPropagation();
      this.events.end();
      return;
    }
    const key = e.key.toLowerCase();
    if (!(key in KEYS) || e.ctrlKey || e.metaKey) return;
    e.preventDefault();
    e.stopPropagation();
    if (down) this.held.add(key);
    else this.held.delete(key);
    this.start();
  }

  /** Goes there until it is led elsewhere: right, up and ahead, each -1 to 1. */
  lead(right: number, up: number, ahead: number): void {
    this.stick.set(right, up, ahead);
    this.start();
  }

  private get goes(): boolean {
    return this.held.size > 0 || this.stick.lengthSq() > 0;
  }

  private start(): void {
    if (!this.goes || this.frame !== 0) return;
    this.last = performance.now();
    this.frame = requestAnimationFrame((now) => this.step(now));
  }

  private step(now: number): void {
    this.frame = 0;
    const seconds = Math.min(0.4, Math.max(0, now - this.last) / 1000);
    this.last = now;
    const way = this.stick.clone();
    for (const key of this.held) way.add(new THREE.Vector3(...KEYS[key]!));
    if (way.lengthSq() > 0) {
      const pace = Math.min(FASTEST, Math.max(SLOWEST, PACE * this.eyes.metre)) * (this.fast ? RUN : 1);
      const { camera, look } = this;
      const ahead =
        this.mode === 'fly'
          ? new THREE.Vector3(0, 0, -1).applyEuler(look)
          : new THREE.Vector3(-Math.sin(look.y), 0, -Math.cos(look.y));
      const right = new THREE.Vector3(Math.cos(look.y), 0, -Math.sin(look.y));
      const to = camera.position
        .clone()
        .addScaledVector(right, way.x * pace * seconds)
        .addScaledVector(ahead, way.z * pace * seconds);
      if (this.mode === 'fly') to.y += way.y * pace * seconds;
      to.y = this.mode === 'walk' ? this.eyes.height : Math.max(0.01, to.y);
      camera.position.copy(to.clampLength(0, WORLD));
      this.events.moved();
    }
    if (this.goes) this.frame = requestAnimationFrame((t) => this.step(t));
  }

  private turn(e: PointerEvent): void {
    if (!this.drag) return;
    const [x, y] = this.drag;
    this.drag = [e.clientX, e.clientY];
    this.look.y += (e.clientX - x) * TURN;
    this.look.x = Math.min(1.5, Math.max(-1.5, this.look.x + (e.clientY - y) * TURN));
    this.camera.quaternion.setFromEuler(this.look);
    this.events.moved();
  }

  dispose(): void {
    this.gone.abort();
    cancelAnimationFrame(this.frame);
  }
}
