/** The right side: the plant in three dimensions, turned by hand, or from the front exactly as it was drawn. */
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { texturesOf, type Sent } from '../protocol';
import type { PlantState, PlantView as Seen, SceneView, ShapePointer, ShapeReach } from '../wire';
import type { Gizmo } from '../scene';
import type { Box } from '../sheet/geometry';
import type { Handles } from './gizmo';
import { Looks, PlantMeshes } from './plant';
import { Stage } from './stage';

/** Colours of axes by order: 0, 1, 2, 3 and more; each shows on light and dark sky. */
const ORDERS = [0x8a4b14, 0xc0600f, 0x1f8a55, 0x2079c0, 0x8a4fb5].map((c) => new THREE.Color(c));
/** Leaves and petals among the axes. */
const BLADES = [0x3f9a3a, 0xd0407a].map((c) => new THREE.Color(c));

/** Height of the strip of tools with its options, pixels. */
const STRIP = 116;
/** A pointer that moved no further than this, pixels, clicked. */
const CLICK = 5;

/** Least time between pictures that the processor draws. */
const SLOW_MS = 300;
/** Its pixels for each of the screen's: at rest, and while pictures follow one another. */
const GRAIN = { rest: 0.75, moving: 0.45 } as const;

export class PlantView {
  readonly element = document.createElement('div');
  private readonly renderer: THREE.WebGLRenderer;
  private readonly stage: Stage;
  private readonly looks: Looks;
  private readonly plants = new Map<number, PlantMeshes>();
  /** A model that is viewed instead of the scene. */
  private guest: PlantMeshes | undefined;
  private states: PlantState[] = [];
  private current: number | null = null;
  /** Holds what is shown of the plant, at the size of the stage. */
  private readonly holder = new THREE.Group();
  private bones: THREE.LineSegments | undefined;
  private readonly boneLook = new THREE.LineBasicMaterial({ vertexColors: true, toneMapped: false });
  private readonly far = new THREE.PerspectiveCamera(32, 1, 0.01, 200);
  private readonly flat = new THREE.OrthographicCamera(-1, 1, 1, -1, -50, 50);
  private readonly controls: OrbitControls;
  private handles: Handles | undefined;
  private gizmo: Gizmo | undefined;
  private dragging = false;
  private boned = false;
  private scale = 1;
  /** The plant to which the stage was fitted. */
  private fitted: number | null = null;
  private front = false;
  private sheetSeen: Box | undefined;
  private follow = true;
  private readonly slow: boolean;
  /** See `spare`. */
  private grain: number = GRAIN.rest;
  private drawn = -Infinity;
  private rest = 0;
  private frame = 0;
  private last = 0;
  private rendered = 0;
  /** A tool is in the hand: the first button is the tool's, the second turns the view. */
  private hands = false;
  /** Pixels on the left that something else covers. */
  private inset = 0;
  private wanted = 0;
  /** Pixels at the foot that something else covers. */
  private low = 0;
  private readonly caster = new THREE.Raycaster();
  private wish: { target: THREE.Vector3; distance: number } | undefined;
  /** A plant was clicked. */
  onPick: (plant: number) => void = () => {};
  /** A picture was drawn: what lies over it may have to move. */
  onDraw: () => void = () => {};
  onFrontChange: (front: boolean) => void = () => {};
  onContext: (lost: boolean) => void = () => {};
  onPlaceBegin: () => void = () => {};
  onPlace: (plant: number, position: [number, number, number], yaw: number, scale: number) => void = () => {};
  onPlaceEnd: () => void = () => {};

  /** Throws where the browser has no WebGL 2. */
  constructor(label: string) {
    this.slow = drawnBySoftware();
    this.looks = new Looks(this.slow);
    this.renderer = new THREE.WebGLRenderer({ antialias: !this.slow, powerPreference: 'high-performance' });
    this.renderer.shadowMap.enabled = true;
    // The light stands still: its shadows change with the plant only.
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.renderer.toneMappingExposure = 1.08;
    this.stage = new Stage(this.slow ? 512 : 2048);
    this.element.className = 'view';
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    this.setLabel(label);
    this.element.append(canvas);
    this.stage.scene.add(this.holder);
    this.far.position.set(1.25, 0.95, 2.6);
    this.controls = new OrbitControls(this.far, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = 0.1;
    this.controls.maxDistance = 12;
    this.controls.maxPolarAngle = Math.PI * 0.53;
    this.controls.target.set(0, 0.48, 0);
    this.controls.addEventListener('change', () => this.redraw());
    canvas.addEventListener('pointerdown', (e) => {
      if (!this.hands) this.taken(e.button === 0);
      else if (e.button !== 0) this.taken(e.button === 2);
    });
    this.listenForClicks(canvas);
    canvas.addEventListener('wheel', () => this.taken(false), { passive: true });
    canvas.addEventListener('keydown', (e) => this.key(e));
    canvas.addEventListener('webglcontextlost', (e) => {
      e.preventDefault();
      this.onContext(true);
    });
    canvas.addEventListener('webglcontextrestored', () => {
      this.onContext(false);
      this.redraw();
    });
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  setLabel(label: string): void {
    this.renderer.domElement.setAttribute('aria-label', label);
  }

  setDark(dark: boolean): void {
    this.stage.setDark(dark);
    this.redraw();
  }

  /** The axes as lines in the place of the plant: pairs of points with the order of each (100 leaf, 101 petal); none shows the plant. */
  setSkeleton(pairs: Float32Array | undefined): void {
    if (this.bones) {
      this.bones.geometry.dispose();
      this.bones.removeFromParent();
      this.bones = undefined;
    }
    this.boned = pairs !== undefined;
    if (pairs) {
      const n = pairs.length / 4;
      const [positions, colors] = [new Float32Array(3 * n), new Float32Array(3 * n)];
      for (let i = 0; i < n; i += 1) {
        positions.set(pairs.subarray(4 * i, 4 * i + 3), 3 * i);
        const kind = pairs[4 * i + 3]!;
        const { r, g, b } = kind >= 100 ? BLADES[kind - 100]! : ORDERS[Math.min(kind, ORDERS.length - 1)]!;
        colors.set([r, g, b], 3 * i);
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
      geometry.setAttribute('color', new THREE.BufferAttribute(colors, 3));
      this.bones = new THREE.LineSegments(geometry, this.boneLook);
      (this.chosen?.place ?? this.holder).add(this.bones);
    }
    this.stand();
    this.renderer.shadowMap.needsUpdate = true;
    this.redraw();
  }

  /** A small picture of another plant from where this one is seen. */
  snapshot(sent: Sent, width: number, height: number): HTMLCanvasElement {
    const group = this.looks.build(sent);
    const [min, max] = [new THREE.Vector3(...sent.view.min), new THREE.Vector3(...sent.view.max)];
    const size = max.clone().sub(min);
    const scale = 1 / Math.max(size.x, size.y, size.z, 1e-9);
    group.scale.setScalar(scale);
    group.position.y = Math.max(0, -min.y * scale);
    const camera = new THREE.PerspectiveCamera(this.far.fov, width / height, 0.01, 200);
    const target = min
      .clone()
      .add(max)
      .multiplyScalar(scale / 2);
    target.y += group.position.y;
    const distance =
      (size.length() * scale * 0.48) /
      Math.sin(THREE.MathUtils.degToRad(camera.fov / 2)) /
      Math.min(1, width / height);
    camera.position.copy(this.far.position).sub(this.controls.target).setLength(distance).add(target);
    camera.lookAt(target);
    const { scene } = this.stage;
    this.holder.visible = false;
    this.stage.setFlat(false);
    scene.add(group);
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.renderer.shadowMap.needsUpdate = true;
    this.renderer.render(scene, camera);
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [width, height];
    canvas.getContext('2d')?.drawImage(this.renderer.domElement, 0, 0);
    scene.remove(group);
    for (const mesh of group.children) (mesh as THREE.Mesh).geometry.dispose();
    this.holder.visible = true;
    this.stage.setFlat(this.front);
    this.renderer.shadowMap.needsUpdate = true;
    this.resize();
    this.render();
    return canvas;
  }

  setWire(wire: boolean): void {
    this.looks.setWire(wire);
    this.redraw();
  }

  forget(): void {
    this.looks.forget();
  }

  private get chosen(): PlantMeshes | undefined {
    return this.guest ?? (this.current === null ? undefined : this.plants.get(this.current));
  }

  /** The plant whose front view is shown. */
  private get seen(): Seen | undefined {
    return this.chosen?.view;
  }

  update(view: SceneView, fresh: Sent[]): void {
    this.looks.keep(texturesOf(view.guest ? [view.guest, ...view.plants] : view.plants));
    for (const { textures } of fresh) for (const texture of textures) this.looks.addTexture(texture);
    const meshes = new Map(fresh.map((sent) => [sent.view.id, sent]));
    const take = (known: PlantMeshes | undefined, seen: Seen): PlantMeshes => {
      const plant = known ?? new PlantMeshes(this.looks);
      if (!known) this.holder.add(plant.place);
      plant.view = seen;
      const sent = meshes.get(seen.id);
      if (sent) {
        plant.update(seen, sent.parts);
        plant.setObstacles(seen.obstacles, sent.obstacles);
      }
      return plant;
    };
    if (view.guest) this.guest = take(this.guest, view.guest);
    else if (this.guest) {
      this.guest.dispose();
      this.guest = undefined;
    }
    const there = new Set(view.plants.map((p) => p.id));
    for (const [id, plant] of this.plants) {
      if (there.has(id)) continue;
      plant.dispose();
      this.plants.delete(id);
    }
    for (const seen of view.plants) this.plants.set(seen.id, take(this.plants.get(seen.id), seen));
    this.stand();
    this.fitStage();
    this.showHandles();
    this.renderer.shadowMap.needsUpdate = true;
    this.lay();
    this.redraw();
  }

  /** Where the plants stand, which are hidden, which is chosen. */
  setPlaces(states: PlantState[], current: number | null): void {
    this.states = states;
    const other = current !== this.current;
    this.current = current;
    if (other && this.bones && this.chosen) this.chosen.place.add(this.bones);
    this.stand();
    this.fitStage();
    this.showHandles();
    this.renderer.shadowMap.needsUpdate = true;
    this.lay();
    this.redraw();
  }

  private stand(): void {
    const alone = this.front || this.guest !== undefined;
    for (const [id, plant] of this.plants) {
      const state = this.states.find((s) => s.id === id);
      const mine = id === this.current;
      plant.place.visible = this.guest === undefined && (mine || !alone) && !(state?.hidden ?? false);
      plant.group.visible = !(this.boned && mine);
      if (!state || (this.dragging && mine)) continue;
      // The front view is the drawing, wherever the plant stands.
      const [x, y, z] = this.front ? [0, 0, 0] : state.position;
      plant.place.position.set(x, y, z);
      plant.place.rotation.set(0, this.front ? 0 : THREE.MathUtils.degToRad(state.yaw_deg), 0);
      plant.place.scale.setScalar(this.front ? 1 : state.scale);
    }
  }

  /** The box around all that is seen, metres. */
  private bounds(): THREE.Box3 {
    const box = new THREE.Box3();
    const add = ({ place, obstacles, view }: PlantMeshes): void => {
      if (!view || !place.visible) return;
      place.updateMatrix();
      for (const mesh of obstacles.children as THREE.Mesh[]) {
        mesh.updateMatrix();
        mesh.geometry.computeBoundingBox();
        if (mesh.geometry.boundingBox)
          box.union(mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrix).applyMatrix4(place.matrix));
      }
      const own = new THREE.Box3(new THREE.Vector3(...view.min), new THREE.Vector3(...view.max));
      if (view.parts.length > 0) box.union(own.applyMatrix4(place.matrix));
    };
    if (this.guest) add(this.guest);
    else for (const plant of this.plants.values()) add(plant);
    return box;
  }

  /** Brings all that is seen to the size of the stage. */
  private fitStage(): void {
    // Under a hand that works on it a plant keeps its size.
    if (this.dragging || (this.hands && this.fitted === this.current)) return;
    const { min, max } = this.bounds();
    const size = max.clone().sub(min);
    const largest = Math.max(size.x, size.y, size.z);
    if (!(largest > 0)) return;
    this.fitted = this.current;
    this.scale = 1 / largest;
    this.holder.scale.setScalar(this.scale);
    // One plant stands where it was drawn; several stand around the middle of the stage.
    const several = this.plants.size > 1 && !this.front && !this.guest;
    const [x, z] = several
      ? [(min.x + max.x) / 2, (min.z + max.z) / 2]
      : this.front || this.guest
        ? [0, 0]
        : this.only();
    // Roots below the ground are shown: the ground sinks no plant.
    this.holder.position.set(-x * this.scale, Math.max(0, -min.y * this.scale), -z * this.scale);
    if (this.follow) this.frameAll(min, max, this.wish === undefined);
  }

  private only(): [number, number] {
    const [x, , z] = this.states[0]?.position ?? [0, 0, 0];
    return [x, z];
  }

  async setGizmo(mode: Gizmo | undefined): Promise<void> {
    this.gizmo = mode;
    if (mode && !this.handles) {
      const { Handles } = await import('./gizmo');
      this.handles ??= new Handles(this.far, this.renderer.domElement, this.stage.scene, {
        begin: () => {
          this.dragging = true;
          this.controls.enabled = false;
          this.onPlaceBegin();
        },
        moved: () => this.moved(),
        end: () => {
          this.dragging = false;
          this.controls.enabled = true;
          this.onPlaceEnd();
        },
        redraw: () => this.redraw(),
      });
    }
    if (mode) this.setFront(false);
    this.showHandles();
    this.redraw();
  }

  private showHandles(): void {
    if (this.dragging) return;
    const plant = this.front || this.guest ? undefined : this.chosen;
    this.handles?.show(plant?.place.visible ? plant.place : undefined, this.gizmo);
  }

  private moved(): void {
    const place = this.chosen?.place;
    if (!place || this.current === null) return;
    const scale = Math.min(
      1000,
      Math.max(
        0.001,
        this.gizmo === 'scale' ? Math.max(place.scale.x, place.scale.y, place.scale.z) : place.scale.x,
      ),
    );
    if (this.gizmo === 'scale') {
      // Any handle sizes the whole.
      const was = this.states.find((s) => s.id === this.current)?.scale ?? 1;
      const parts = [place.scale.x, place.scale.y, place.scale.z];
      const to = parts.reduce((a, b) => (Math.abs(b - was) > Math.abs(a - was) ? b : a));
      place.scale.setScalar(Math.min(1000, Math.max(0.001, Math.abs(to))));
    }
    const yaw = new THREE.Euler().setFromQuaternion(place.quaternion, 'YXZ').y;
    const round = (x: number): number => Math.round(x * 1000) / 1000;
    this.onPlace(
      this.current,
      [round(place.position.x), round(place.position.y), round(place.position.z)],
      Math.round(THREE.MathUtils.radToDeg(yaw) * 10) / 10,
      round(this.gizmo === 'scale' ? place.scale.x : scale),
    );
    this.renderer.shadowMap.needsUpdate = true;
    this.redraw();
  }

  /** A click on a plant chooses it. */
  private listenForClicks(canvas: HTMLCanvasElement): void {
    let from: [number, number] | undefined;
    canvas.addEventListener('pointerdown', (e) => {
      from =
        e.button === 0 && e.isPrimary && !this.hands && !this.dragging ? [e.clientX, e.clientY] : undefined;
    });
    canvas.addEventListener('pointerup', (e) => {
      const still = from && Math.hypot(e.clientX - from[0], e.clientY - from[1]) <= CLICK;
      from = undefined;
      if (!still || this.dragging || this.guest) return;
      const plant = this.plantAt(e.clientX, e.clientY);
      if (plant !== undefined && plant !== this.current) this.onPick(plant);
    });
  }

  /** The plant under a point of the screen. */
  plantAt(x: number, y: number): number | undefined {
    this.aim(x, y);
    let best: { id: number; distance: number } | undefined;
    for (const [id, plant] of this.plants) {
      if (!plant.place.visible) continue;
      plant.place.updateWorldMatrix(true, true);
      const hit = this.caster.intersectObject(plant.group, true)[0];
      if (hit && (!best || hit.distance < best.distance)) best = { id, distance: hit.distance };
    }
    return best?.id;
  }

  private get camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.front && this.seen?.front ? this.flat : this.far;
  }

  private aim(x: number, y: number): void {
    const box = this.element.getBoundingClientRect();
    const { camera } = this;
    camera.updateMatrixWorld();
    this.caster.setFromCamera(
      new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2),
      camera,
    );
  }

  /** A point of the screen as a ray in the coordinates of the chosen plant. */
  pointer(x: number, y: number, pressure: number): ShapePointer | undefined {
    const place = this.chosen?.place;
    if (!place) return undefined;
    this.aim(x, y);
    place.updateWorldMatrix(true, false);
    const plantFromWorld = place.matrixWorld.clone().invert();
    const way = (v: THREE.Vector3): [number, number, number] =>
      v.clone().transformDirection(plantFromWorld).toArray();
    const { origin, direction } = this.caster.ray;
    return {
      origin: origin.clone().applyMatrix4(plantFromWorld).toArray(),
      direction: way(direction),
      forward: way(this.camera.getWorldDirection(new THREE.Vector3())),
      up: way(new THREE.Vector3(0, 1, 0).applyQuaternion(this.camera.quaternion)),
      pressure,
    };
  }

  /** So many pixels, in metres of the chosen plant. */
  reach(pixels: number): Omit<ShapeReach, 'bearers'> {
    const size = (this.chosen?.place.getWorldScale(new THREE.Vector3()).x ?? 1) || 1;
    const share = pixels / Math.max(1, this.element.clientHeight);
    const { camera } = this;
    if (camera instanceof THREE.OrthographicCamera)
      return { metres: (share * (camera.top - camera.bottom)) / size, per_metre: 0 };
    return { metres: 0, per_metre: 2 * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)) * share };
  }

  /** Points of the chosen plant (x, y, z, radius) on the screen: x, y and width, pixels; width 0 behind the eye. */
  project(points: Float32Array): Float32Array {
    const place = this.chosen?.place;
    const out = new Float32Array((points.length / 4) * 3);
    if (!place) return out;
    const { camera } = this;
    camera.updateMatrixWorld();
    place.updateWorldMatrix(true, false);
    const { clientWidth: w, clientHeight: h } = this.element;
    const size = place.getWorldScale(new THREE.Vector3()).x;
    const eye = camera.matrixWorldInverse;
    const v = new THREE.Vector3();
    for (let i = 0, o = 0; i < points.length; i += 4, o += 3) {
      v.set(points[i]!, points[i + 1]!, points[i + 2]!)
        .applyMatrix4(place.matrixWorld)
        .applyMatrix4(eye);
      const depth = -v.z;
      v.applyMatrix4(camera.projectionMatrix);
      const wide =
        camera instanceof THREE.OrthographicCamera
          ? (points[i + 3]! * size * h) / (camera.top - camera.bottom)
          : (points[i + 3]! * size * h) /
            (2 * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)) * Math.max(1e-6, depth));
      out.set([((v.x + 1) / 2) * w, ((1 - v.y) / 2) * h, depth > 0 ? 2 * wide : 0], o);
    }
    return out;
  }

  /** With a tool in the hand the second button or two fingers turn the view, and it keeps its size. */
  setHands(on: boolean): void {
    if (on === this.hands) return;
    this.hands = on;
    this.controls.mouseButtons = on
      ? { LEFT: null, MIDDLE: THREE.MOUSE.PAN, RIGHT: THREE.MOUSE.ROTATE }
      : { LEFT: THREE.MOUSE.ROTATE, MIDDLE: THREE.MOUSE.DOLLY, RIGHT: THREE.MOUSE.PAN };
    this.controls.touches = on
      ? { ONE: null, TWO: THREE.TOUCH.DOLLY_ROTATE }
      : { ONE: THREE.TOUCH.ROTATE, TWO: THREE.TOUCH.DOLLY_PAN };
    // The tools' strip lies over the foot of the view.
    this.low = on ? STRIP : 0;
    this.inset = this.wanted;
    this.lay();
    if (!on && this.follow) this.fitStage();
    else if (this.follow) this.frameNowBox();
    this.redraw();
  }

  /** The wheel is the tool's for now, or it zooms. */
  setZoom(on: boolean): void {
    this.controls.enableZoom = on;
  }

  /** Pixels on the left that a list covers: the plant is shown beside it. */
  setInset(pixels: number): void {
    this.wanted = pixels > 0.5 * this.element.clientWidth ? 0 : pixels;
    // Under a hand the view stands still.
    if (this.hands || this.wanted === this.inset) return;
    this.inset = this.wanted;
    this.lay();
    if (this.follow) this.frameNowBox();
    this.redraw();
  }

  /** Shows the whole plant and follows it again. */
  frameNow(): void {
    this.follow = true;
    this.fitted = null;
    this.setFront(false);
    this.fitStage();
    this.frameNowBox();
    this.redraw();
  }

  private frameNowBox(): void {
    const { min, max } = this.bounds();
    if (!this.bounds().isEmpty()) this.frameAll(min, max, false);
  }

  /** The front view shows the same part of the plane as the sheet. */
  setFront(front: boolean): void {
    if (front === this.front) return;
    this.front = front;
    this.stage.setFlat(front);
    this.stand();
    this.fitStage();
    this.showHandles();
    this.lay();
    this.redraw();
    this.onFrontChange(front);
  }

  get isFront(): boolean {
    return this.front;
  }

  setSheetSeen(box: Box): void {
    this.sheetSeen = box;
    if (this.front) {
      this.lay();
      this.redraw();
    }
  }

  /** The picture as it is shown now, or would be at rest. */
  async picture(): Promise<Blob> {
    if (this.slow) this.refine(GRAIN.rest);
    this.render();
    const canvas = this.renderer.domElement;
    return new Promise((resolve, reject) => {
      canvas.toBlob((b) => (b ? resolve(b) : reject(new Error('no picture'))), 'image/png');
    });
  }

  private frameAll(min: THREE.Vector3, max: THREE.Vector3, now: boolean): void {
    const s = this.scale;
    const up = this.holder.position.y;
    const target = min
      .clone()
      .add(max)
      .multiplyScalar(s / 2)
      .add(this.holder.position);
    target.y += up - this.holder.position.y;
    if (max.equals(min)) return;
    const radius = max.clone().sub(min).length() * s * 0.5;
    const angle = THREE.MathUtils.degToRad(this.far.fov / 2);
    const { clientWidth: w, clientHeight: h } = this.element;
    const free = Math.max(1, h - this.low);
    const across = Math.min(1, (w - this.inset) / free) * (free / Math.max(1, h));
    const distance = (radius / Math.sin(angle) / across) * 0.98;
    this.wish = { target, distance };
    if (now) {
      this.glide(1);
    }
  }

  /** Moves the camera a share of the way to where it should be; true when it is there. */
  private glide(share: number): boolean {
    if (!this.wish) return true;
    const { target, distance } = this.wish;
    const arm = this.far.position.clone().sub(this.controls.target);
    const length = arm.length() + (distance - arm.length()) * share;
    this.controls.target.lerp(target, share);
    this.far.position.copy(this.controls.target).add(arm.setLength(length));
    return Math.abs(length - distance) < 1e-3 && this.controls.target.distanceTo(target) < 1e-3;
  }

  /** A hand took the camera: it is no longer moved by itself, and turning leaves the front view. */
  private taken(turns: boolean): void {
    if (this.front && turns) this.setFront(false);
    this.wish = undefined;
    if (!turns) this.follow = false;
  }

  private key(e: KeyboardEvent): void {
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
    this.taken(by !== undefined);
    const arm = new THREE.Spherical().setFromVector3(this.far.position.clone().sub(this.controls.target));
    if (by) {
      arm.theta += by[0];
      arm.phi = Math.min(this.controls.maxPolarAngle, Math.max(0.05, arm.phi + by[1]));
    } else {
      arm.radius = Math.min(12, Math.max(0.1, arm.radius * zoom));
    }
    this.far.position.setFromSpherical(arm).add(this.controls.target);
    this.redraw();
  }

  private lay(): void {
    const { clientWidth: w, clientHeight: h } = this.element;
    this.far.aspect = w / Math.max(1, h);
    if (this.inset > 0 || this.low > 0) this.far.setViewOffset(w, h, -this.inset / 2, this.low / 2, w, h);
    else this.far.clearViewOffset();
    this.far.updateProjectionMatrix();
    const front = this.seen?.front;
    if (!front || !this.sheetSeen) return;
    const k = front.metres_per_unit * this.scale;
    const seen = this.sheetSeen;
    const up = this.holder.position.y;
    // The sheet's height decides; its middle is the picture's middle, whatever the widths are.
    const [cx, cy] = [
      ((seen.left + seen.right) / 2 - front.x) * k,
      ((seen.bottom + seen.top) / 2 - front.y) * k + up,
    ];
    const half = ((seen.top - seen.bottom) / 2) * k;
    const wide = half * this.far.aspect;
    [this.flat.left, this.flat.right, this.flat.bottom, this.flat.top] = [
      cx - wide,
      cx + wide,
      cy - half,
      cy + half,
    ];
    this.flat.position.set(0, 0, 10);
    this.flat.updateProjectionMatrix();
  }

  private resize(): void {
    const { clientWidth: w, clientHeight: h } = this.element;
    if (w === 0 || h === 0) return;
    this.renderer.setPixelRatio(this.slow ? this.grain : Math.min(2, devicePixelRatio || 1));
    this.renderer.setSize(w, h, false);
    this.lay();
    if (this.follow) this.frameNowBox();
    this.redraw();
  }

  private redraw(): void {
    if (this.frame) return;
    if (this.wish === undefined) this.last = performance.now();
    // Drawing without a graphics card takes the whole processor: the pen goes before the picture.
    const wait = this.slow ? SLOW_MS - (performance.now() - this.rendered) : 0;
    if (wait > 0) {
      this.frame = window.setTimeout(() => {
        this.frame = 0;
        this.rendered = 0;
        this.redraw();
      }, wait);
      return;
    }
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      const now = performance.now();
      const there = this.glide(1 - Math.exp(-Math.min(now - this.last, 400) / 120));
      this.last = now;
      this.controls.update();
      if (this.slow) this.spare(now);
      this.render();
      this.rendered = performance.now();
      if (!there) this.redraw();
    });
  }

  /** Coarse pictures while they follow one another, a fine one when they have come to rest. */
  private spare(now: number): void {
    const moving = now - this.drawn < 3 * SLOW_MS;
    this.drawn = now;
    this.refine(moving ? GRAIN.moving : GRAIN.rest);
    window.clearTimeout(this.rest);
    if (moving)
      this.rest = window.setTimeout(() => {
        this.drawn = -Infinity;
        this.redraw();
      }, 2 * SLOW_MS);
  }

  private refine(grain: number): void {
    if (grain === this.grain) return;
    this.grain = grain;
    this.renderer.setPixelRatio(grain);
  }

  private render(): void {
    this.renderer.render(this.stage.scene, this.camera);
    this.onDraw();
  }
}

/** Without a graphics card everything is drawn by the processor: then less is asked of it. Throws without WebGL 2. */
function drawnBySoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) throw new Error('no WebGL 2');
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
