/** The right side: the plant in three dimensions, turned by hand, or from the front exactly as it was drawn. */
import * as THREE from 'three';
import type { Sent } from '../worker/protocol';
import type { MirrorPlane } from './mirror';
import type { CarriedPose, Carry, Mirror, PlantState, SceneView, ShapePointer, ShapeReach } from '../wire';
import type { HeldRows } from './carry';
import type { Gizmo } from '../placing/scene';
import type { Box } from '../sheet/geometry';
import { t } from '../text';
import { onScreen, pointerOf, reachOf } from './aim';
import { bonesOf } from './bones';
import { Rig, type Side } from './camera';
import { Easel } from './easel';
import { Frames } from './frames';
import { type Covered, Framing } from './framing';
import { type Guide, Guides } from './guides';
import { immerse, type Within } from './immersion';
import type { StageSetting } from './moods';
import { dragObstacles, obstacleAround } from './obstacles';
import { listenForClicks, Picker } from './picker';
import { Placer } from './placer';
import { Looks, type PlantMeshes } from './plant';
import { Plants, type StandIn } from './plants';
import type { Effects, Pipeline } from './post';
import { drawnBySoftware, Pace } from './quality';
import { Rings } from './rings';
import { cameraFor, type ShotSize, shoot } from './shot';
import { snapshotOf } from './snapshot';
import { SHADOW, Stage } from './stage';
import type { WalkMode } from './walk';

/** Eyes of a walker, metres, and between which heights of the stage they stay. */
const EYES = { m: 1.65, low: 0.03, high: 1.4 } as const;
/** Most pixels for each of the screen's. */
const FINEST = 2;
/** What a person does in the view, and what it says of itself. */
export interface ViewEvents {
  /** A plant was clicked; `more`: it is to be chosen beside the others. */
  pick(plant: number, more: boolean): void;
  /** A picture was drawn: what lies over it may have to move. */
  drawn(): void;
  /** The front view is shown, or not any more. */
  front(on: boolean): void;
  walked(mode: WalkMode | undefined): void;
  /** The graphics card took everything away, or gave it back. */
  context(lost: boolean): void;
  placeBegin(): void;
  place(plant: number, position: [number, number, number], yaw: number, scale: number): void;
  carry(plants: number[], how: Carry): void;
  /** The wheel is turned over the front view: at a place right of its middle and below it, in shares of its height. */
  zoomed(by: WheelEvent, right: number, down: number): void;
  placeEnd(): void;
  obstacle(plant: number, row: number, by: [number, number, number]): void;
}

export class PlantView {
  readonly element = document.createElement('div');
  private readonly renderer: THREE.WebGLRenderer;
  private readonly stage: Stage;
  private readonly looks: Looks;
  private readonly plants: Plants;
  /** Holds what is shown of the plant, at the size of the stage. */
  private readonly holder = new THREE.Group();
  private bones: THREE.LineSegments | undefined;
  private mirror: MirrorPlane | undefined;
  private wantedMirror: Mirror | undefined;
  private readonly boneLook = new THREE.LineBasicMaterial({ vertexColors: true, toneMapped: false });
  private readonly flat = new THREE.OrthographicCamera(-1, 1, 1, -1, -50, 50);
  readonly rig: Rig;
  private readonly guides = new Guides();
  private pipeline: Pipeline | undefined;
  private readonly pace = new Pace();
  /** The machine turned out to be too slow for what it was thought fit for. */
  private weak = false;
  /** See `isFine`; not known before the stage is set. */
  private fine: boolean | undefined;
  private photosLit: boolean | undefined;
  private readonly placer: Placer;
  private dragging = false;
  private selection: readonly number[] = [];
  private readonly rings = new Rings();
  private boned = false;
  private readonly framing: Framing;
  private readonly slow: boolean;
  private readonly frames: Frames;
  private readonly easel: Easel | undefined;
  /** Shows the pictures and is touched. */
  private readonly canvas: HTMLCanvasElement;
  /** A headset shows the scene. */
  private immersing = false;
  private readonly picker = new Picker(this.element, () => this.camera, this.holder);
  /** Throws where the browser has no WebGL 2. */
  constructor(
    label: string,
    private readonly events: ViewEvents,
  ) {
    this.slow = drawnBySoftware();
    this.looks = new Looks(this.slow);
    this.plants = new Plants(this.looks, this.holder);
    const pixels = Math.min(FINEST, devicePixelRatio || 1);
    const drawer = {
      // A headset asks for its pictures itself.
      away: () => this.immersing,
      isLed: () => this.rig.isLed,
      draw: (ms: number) => {
        const there = this.rig.glide(1 - Math.exp(-Math.min(ms, 400) / 120));
        this.rig.update();
        this.render();
        return !there || (this.plants.standIn?.moves ?? false);
      },
      shown: () => this.easel?.show(),
      rests: (on: boolean) => {
        this.element.dataset['rests'] = on ? '1' : '0';
        delete this.element.dataset['finished'];
      },
      grained: (grain: number) => this.renderer.setPixelRatio(grain),
      finished: () => {
        if (this.element.dataset['rests'] === '1')
          this.element.dataset['finished'] = String(this.frames.grain);
      },
    };
    this.frames = new Frames(this.slow, drawer, { moving: pixels, still: FINEST });
    this.renderer = new THREE.WebGLRenderer({
      antialias: !this.slow,
      powerPreference: 'high-performance',
      preserveDrawingBuffer: this.slow,
    });
    this.easel = this.slow ? new Easel(this.renderer.getContext() as WebGL2RenderingContext) : undefined;
    this.canvas = this.easel?.canvas ?? this.renderer.domElement;
    this.stage = new Stage(this.slow ? SHADOW.fast : SHADOW.fine, this.renderer, () => this.redraw());
    this.element.className = 'view';
    const { canvas } = this;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    // Before the camera: what takes an obstacle turns no view.
    dragObstacles(canvas, {
      at: (x, y) => this.obstacleAt(x, y),
      over: (x, y) => this.obstacleUnder(x, y) !== undefined,
      ray: (x, y) => this.picker.ray(x, y),
      hold: (on) => {
        this.dragging = on;
        if (!on) this.framing.fit();
      },
      redraw: () => {
        this.stage.touch();
        this.redraw();
      },
      moved: (row, by) => {
        if (this.plants.current !== null) this.events.obstacle(this.plants.current, row, by);
      },
    });
    this.setLabel(label);
    this.element.append(canvas);
    this.stage.scene.add(this.holder);
    this.stage.scene.add(this.guides.group);
    // Before the camera, which is not seen in the front view.
    canvas.addEventListener('wheel', (e) => this.wheel(e), { passive: false });
    const rigEvents = {
      redraw: () => this.redraw(),
      taken: (turns: boolean) => this.taken(turns),
      eyes: () => ({
        height: Math.min(EYES.high, Math.max(EYES.low, EYES.m * this.framing.scale)),
        metre: this.framing.scale,
      }),
      walked: (mode: WalkMode | undefined) => events.walked(mode),
    };
    this.rig = new Rig(canvas, rigEvents, !this.slow);
    this.framing = new Framing({
      element: this.element,
      stage: this.stage,
      plants: this.plants,
      holder: this.holder,
      guides: this.guides,
      rig: this.rig,
      flat: this.flat,
      isDragged: () => this.dragging,
    });
    this.placer = new Placer(this.rig.far, canvas, this.stage.scene, {
      begin: () => {
        this.dragging = true;
        this.plants.held = new Set(this.selection);
        this.stand();
        this.rig.controls.enabled = false;
        events.placeBegin();
      },
      moved: () => this.moved(),
      end: () => {
        this.dragging = false;
        this.plants.held = new Set();
        this.rig.controls.enabled = true;
        events.placeEnd();
      },
      redraw: () => this.redraw(),
    });
    canvas.addEventListener('pointerdown', (e) => {
      if (!this.framing.hands) this.taken(e.button === 0);
      else if (e.button !== 0) this.taken(e.button === 2);
    });
    listenForClicks(
      canvas,
      () => !this.framing.hands && !this.dragging,
      (x, y, more) => {
        if (this.dragging || this.plants.guest) return;
        const plant = this.plantAt(x, y);
        if (plant !== undefined && (more || plant !== this.plants.current)) events.pick(plant, more);
      },
    );
    canvas.addEventListener('wheel', () => this.taken(false), { passive: true });
    const { domElement } = this.renderer;
    domElement.addEventListener('webglcontextlost', (e) => {
      e.preventDefault();
      events.context(true);
    });
    domElement.addEventListener('webglcontextrestored', () => {
      events.context(false);
      this.redraw();
    });
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  setLabel(label: string): void {
    this.canvas.setAttribute('aria-label', label);
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
      this.bones = bonesOf(pairs, this.boneLook);
      (this.chosen?.place ?? this.holder).add(this.bones);
    }
    this.stand();
    this.stage.touch();
    this.redraw();
  }

  /** A small picture of another plant from where this one is seen. */
  snapshot(sent: Sent, width: number, height: number): HTMLCanvasElement {
    const { renderer, stage, looks } = this;
    const eye = [this.rig.far, this.rig.controls.target] as const;
    this.holder.visible = this.guides.group.visible = false;
    const canvas = snapshotOf(sent, { renderer, stage, looks }, eye, [width, height]);
    this.holder.visible = this.guides.group.visible = true;
    this.stage.setFlat(this.isFront);
    this.stage.touch();
    this.resize();
    this.render();
    return canvas;
  }

  setWire(wire: boolean): void {
    this.looks.setWire(wire);
    this.plants.standIn?.relook();
    this.redraw();
  }

  /** A new worker names textures and meshes anew. */
  forget(): void {
    this.setStandIn(undefined);
    this.looks.forget();
    this.plants.forget();
  }

  private get chosen(): PlantMeshes | undefined {
    return this.plants.chosen;
  }

  update(view: SceneView, fresh: Sent[]): void {
    this.plants.update(view, fresh);
    this.stand();
    this.framing.fit();
    this.showHandles();
    this.stage.touch();
    this.framing.lay();
    this.redraw();
  }

  /** Shows plants much coarser until they are whole: with shapes of their own, which the next view replaces. */
  coarse(fresh: Sent[]): void {
    this.plants.coarse(fresh);
    this.stand();
    this.framing.fit();
    this.stage.touch();
    this.framing.lay();
    this.redraw();
  }

  /** Where the plants stand, which are hidden, which is chosen. */
  setPlaces(states: PlantState[], current: number | null): void {
    const other = current !== this.plants.current;
    this.plants.setStates(states, current);
    if (other && this.bones && this.chosen) this.chosen.place.add(this.bones);
    this.stand();
    this.framing.fit();
    this.showHandles();
    this.stage.touch();
    this.framing.lay();
    // A plant that is not there yet comes in a moment: one picture of a large scene can take the processor seconds.
    const whole = states.every(({ id }) => this.plants.named.has(id));
    if (whole || !this.slow) this.redraw();
  }

  /** What stands in the place of plants from now on; none shows the plants again. It is given what they look like. */
  setStandIn(make: ((looks: Looks) => StandIn) | undefined): void {
    this.plants.setStandIn(make);
    this.stand();
    this.stage.touch();
    this.redraw();
  }

  /** The stand-in is another than it was. */
  stir(): void {
    this.stage.touch();
    this.redraw();
  }

  private stand(): void {
    this.plants.stand({ front: this.isFront, boned: this.boned });
  }

  async setGizmo(mode: Gizmo | undefined): Promise<void> {
    await this.placer.take(mode);
    if (mode) this.setFront(false);
    this.showHandles();
    this.redraw();
  }

  setSnap(on: boolean): void {
    this.placer.snaps = on;
  }

  /** The gizmo goes along one axis only, or along all of them again. */
  setAxis(axis: 'x' | 'z' | undefined): void {
    this.placer.only(axis);
    this.redraw();
  }

  /** Plants that are chosen together: the gizmo takes them all. */
  setChosen(plants: readonly number[]): void {
    if (String(plants) === String(this.selection)) return;
    this.selection = plants;
    this.showHandles();
    this.redraw();
  }

  private showHandles(): void {
    if (this.dragging) return;
    const fixed = this.selection.some((id) => this.plants.stateOf(id)?.fixed);
    const places = this.selection.flatMap((id) => this.plants.named.get(id)?.place ?? []);
    const away = this.isFront || this.plants.guest !== undefined || fixed;
    // Those that are hidden go with the others.
    const seen = places.some((place) => place.visible);
    const together = this.selection.length > 1;
    this.placer.show(away || !seen ? [] : places, together);
    // One that is chosen alone has its panel open.
    this.rings.show(together ? this.selection.flatMap((id) => this.plants.named.get(id) ?? []) : []);
  }

  private moved(): void {
    const { current } = this.plants;
    if (this.selection.length > 1) this.events.carry([...this.selection], this.placer.carried());
    else if (this.chosen && current !== null) {
      const { position, yaw, scale } = this.placer.placed(this.chosen.place, this.plants.state?.scale ?? 1);
      this.events.place(current, position, yaw, scale);
    }
    this.stage.touch();
    this.redraw();
  }

  /** The plant under a point of the screen. */
  plantAt(x: number, y: number): number | undefined {
    return this.picker.plant(x, y, this.plants.named);
  }

  /** The obstacle of the chosen plant under a point of the screen. */
  private obstacleUnder(x: number, y: number): THREE.Intersection | undefined {
    const { chosen } = this;
    if (this.framing.hands || this.plants.guest || this.isFront || this.rig.walking || !chosen?.place.visible)
      return undefined;
    if (this.dragging || this.placer.isUnderPointer || chosen.obstacles.children.length === 0)
      return undefined;
    return this.picker.obstacle(x, y, chosen);
  }

  /** The same, if nothing of the plant lies before it. */
  private obstacleAt(
    x: number,
    y: number,
  ): { mesh: THREE.Mesh; place: THREE.Object3D; point: THREE.Vector3 } | undefined {
    const hit = this.obstacleUnder(x, y);
    const { chosen } = this;
    if (!hit || !chosen || this.picker.isBehind(hit, chosen)) return undefined;
    return { mesh: hit.object as THREE.Mesh, place: chosen.place, point: hit.point.clone() };
  }

  private get camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.isFront && this.chosen?.view?.front ? this.flat : this.rig.far;
  }

  /** The place of the ground under a point of the screen: x and z, metres of the scene; none at or above the horizon. */
  groundAt(x: number, y: number): [number, number] | undefined {
    return this.picker.ground(x, y);
  }

  /** So many metres on the ground under a point of the screen, in pixels. */
  groundPixels(x: number, y: number, metres: number): number {
    const share = this.reach(1);
    const far = this.picker.groundDistance(x, y);
    if (far === undefined) return 0;
    return metres / Math.max(1e-9, share.metres + share.per_metre * far);
  }

  /** The crown of a plant seen from above, metres: how wide it is where it is widest; 0 before it is made. */
  widthOf(plant: number): number {
    return this.plants.widthOf(plant);
  }

  /** A point of the screen as a ray in the coordinates of the chosen plant. */
  pointer(x: number, y: number, pressure: number): ShapePointer | undefined {
    const place = this.chosen?.place;
    if (!place) return undefined;
    return pointerOf(this.picker.ray(x, y), this.camera, place, pressure);
  }

  /** How high and wide the chosen plant is, metres of the scene, and the lower right corner of its box on the screen, pixels. */
  extent(): { high: number; wide: number; x: number; y: number } | undefined {
    const box = this.chosen?.box() ?? new THREE.Box3();
    if (box.isEmpty() || this.immersing) return undefined;
    const { clientWidth: w, clientHeight: h } = this.element;
    const size = box.getSize(new THREE.Vector3());
    let [x, y] = [0, 0];
    for (let corner = 0; corner < 8; corner += 1) {
      const at = new THREE.Vector3(
        corner & 1 ? box.max.x : box.min.x,
        corner & 2 ? box.max.y : box.min.y,
        corner & 4 ? box.max.z : box.min.z,
      );
      this.holder.localToWorld(at).project(this.camera);
      x = Math.max(x, ((at.x + 1) / 2) * w);
      y = Math.max(y, ((1 - at.y) / 2) * h);
    }
    return { high: size.y, wide: Math.max(size.x, size.z), x, y };
  }

  /** So many pixels, in metres of the chosen plant. */
  reach(pixels: number): Omit<ShapeReach, 'bearers'> {
    return reachOf(this.camera, this.chosen?.place, pixels / Math.max(1, this.element.clientHeight));
  }

  /** The name of the meshes of which a hand carries something. */
  get carried(): number | undefined {
    return this.chosen?.carried;
  }

  /** A hand carries some triangles of the chosen plant: they go where `pose` says, and nothing is meshed. */
  carry(mesh: number, rows: HeldRows): void {
    this.chosen?.carry(mesh, rows);
  }

  pose(pose: CarriedPose): void {
    this.chosen?.pose(pose);
    this.stage.touch();
    this.redraw();
  }

  /** What was carried is where it was. */
  putBack(): void {
    for (const plant of this.plants.all) plant.putBack();
    this.redraw();
  }

  // Headset ------------------------------------------------------------------------------------------------------

  /** What a headset is to know of the stage: a metre of the plants, and half of their breadth, in its units. */
  get immersed(): { metre: number; reach: number } {
    const size = this.plants.bounds().getSize(new THREE.Vector3());
    return { metre: this.framing.scale, reach: (Math.max(0, size.x, size.z) * this.framing.scale) / 2 };
  }

  /** It gives its pictures to a headset. */
  get isAway(): boolean {
    return this.immersing;
  }

  /** Triangles and draw calls of the last picture, for both eyes where there are two. */
  get cost(): { triangles: number; calls: number } {
    const { triangles, calls } = this.renderer.info.render;
    return { triangles, calls };
  }

  /** Metres of the chosen plant for each unit of the stage. */
  get metresPerUnit(): number {
    return 1 / (this.chosen?.place.getWorldScale(sized).x || 1);
  }

  /** The tip of a controller and where it points, both on the stage, in the coordinates of the chosen plant. */
  pointerInSpace(tip: THREE.Vector3, direction: THREE.Vector3, pressure: number): ShapePointer | undefined {
    const place = this.chosen?.place;
    if (!place) return undefined;
    aimed.origin.copy(tip);
    aimed.direction.copy(direction);
    const at = pointerOf(aimed, this.rig.far, place, pressure);
    at.tip = at.origin;
    return at;
  }

  /** How something that is turned in the scene is turned in the coordinates of the chosen plant; it is written to `turn`. */
  turnOnPlant(turn: THREE.Quaternion): THREE.Quaternion {
    const place = this.chosen?.place.getWorldQuaternion(stands);
    return place ? turn.premultiply(place.invert()) : turn;
  }

  /** What the chosen plant grows around, where a point (in its coordinates) lies in it. */
  obstacleAround(at: readonly [number, number, number]): { row: number; thing: THREE.Object3D } | undefined {
    return obstacleAround((this.chosen?.obstacles.children ?? []) as THREE.Mesh[], at);
  }

  /** Shows a plane of symmetry of the chosen plant, `size` metres wide; undefined: none any more. */
  async setMirror(mirror: Mirror | undefined, size: number): Promise<void> {
    this.wantedMirror = mirror;
    if (mirror) this.mirror ??= new (await import('./mirror')).MirrorPlane();
    // Another wish may have come while it loaded.
    const wanted = this.wantedMirror;
    this.mirror?.mesh.removeFromParent();
    if (wanted && this.mirror) this.lieOnPlant(this.mirror.place(wanted, size));
    this.redraw();
  }

  /** Lays something whose coordinates are those of the chosen plant onto it. */
  lieOnPlant(thing: THREE.Object3D): void {
    this.chosen?.place.add(thing);
  }

  /** Has the card translate now what draws the stage, and `things` in it, straight to a headset: it takes its time. */
  async readyToImmerse(things: readonly THREE.Object3D[]): Promise<void> {
    if (this.immersing) return;
    const { renderer, stage } = this;
    const { far } = this.rig;
    await renderer.compileAsync(stage.scene, far);
    for (const thing of things) await renderer.compileAsync(thing, far, stage.scene);
  }

  /**
   * Gives its pictures to a headset, until its session ends: of the same scene, from `rig`. `through`: the room is seen
   * behind the plants.
   */
  async immerse(
    session: XRSession,
    floor: 'local-floor' | 'local',
    rig: THREE.Group,
    through: boolean,
    within: Within,
  ): Promise<void> {
    const { renderer, stage, holder: plants } = this;
    const { far } = this.rig;
    this.setFront(false);
    this.rig.stopWalking();
    const ended = (): void => {
      this.immersing = false;
      this.resize();
    };
    this.immersing = true;
    await immerse({ renderer, stage, far, plants, ended }, session, { floor, rig, through }, within);
  }

  /** Points of the chosen plant (x, y, z, radius) on the screen: x, y and width, pixels; width 0 behind the eye. */
  project(points: Float32Array): Float32Array {
    const { clientWidth: w, clientHeight: h } = this.element;
    return onScreen(this.camera, this.chosen?.place, w, h, points);
  }

  /** With a tool in the hand the second button or two fingers turn the view, and it keeps its size. */
  setHands(on: boolean): void {
    if (on === this.framing.hands) return;
    this.rig.setHands(on);
    this.framing.setHands(on);
    this.redraw();
  }

  /** The wheel is the tool's for now, or it zooms. */
  setZoom(on: boolean): void {
    this.rig.controls.enableZoom = on;
  }

  /** What panels cover: plants are shown beside them. */
  setCovered(covered: Covered): void {
    if (this.framing.setCovered(covered)) this.redraw();
  }

  /** Another document: from the front again, and whole. */
  begin(): void {
    this.rig.begin();
    this.frameNow();
  }

  /** Shows the whole plant and follows it again. */
  frameNow(): void {
    this.setFront(false);
    this.rig.stopWalking();
    this.framing.reset();
    this.redraw();
  }

  /** Goes round to a side of what is shown. */
  seeSide(side: Side): void {
    this.setFront(false);
    this.rig.side(side);
  }

  /** Comes near to the plant that is chosen. */
  focus(): void {
    const { chosen } = this;
    if (!chosen?.view || chosen.view.parts.length === 0) return;
    this.setFront(false);
    this.rig.stopWalking();
    this.framing.follow = false;
    this.framing.look(chosen.box(), false);
    this.redraw();
  }

  // Stage --------------------------------------------------------------------------------------------------------

  /** Whether surfaces are glossy, and corners dark. */
  private get isFine(): boolean {
    return this.fine ?? false;
  }

  setStage(setting: StageSetting): void {
    const { quality, blur } = setting;
    const fine = quality === 'fine' || (quality === 'auto' && !this.slow && !this.weak);
    const covered = this.stage.covers;
    this.stage.set(setting, fine);
    if (fine !== this.fine) this.refit(fine);
    this.lightPhotos(setting.sky !== 'studio');
    if (fine || blur > 0) void this.needPipeline();
    if (this.stage.covers !== covered) this.framing.fit();
    this.redraw();
  }

  /** Under an open sky photographs are lit as all else; in the studio they keep their colours. */
  private lightPhotos(lit: boolean): void {
    if (lit === this.photosLit) return;
    this.photosLit = lit;
    this.looks.setPhotosLit(lit);
    this.relook();
  }

  private relook(): void {
    this.plants.relook();
    this.plants.standIn?.relook();
  }

  /** Materials and shadows for another quality. */
  private refit(fine: boolean): void {
    this.fine = fine;
    this.stage.sharpen(fine ? SHADOW.fine : SHADOW.fast);
    this.looks.setMatt(!fine);
    this.relook();
    this.element.dataset['quality'] = fine ? 'fine' : 'fast';
  }

  setPicture(image: TexImageSource | undefined): void {
    this.stage.setPicture(image);
  }

  setGuide(guide: Guide, on: boolean): void {
    this.guides.set(guide, on);
    this.framing.lookAtAll();
    this.redraw();
  }

  isGuided(guide: Guide): boolean {
    return this.guides.isShown(guide);
  }

  private async needPipeline(): Promise<Pipeline> {
    if (this.pipeline) return this.pipeline;
    const { Pipeline } = await import('./post');
    this.pipeline ??= new Pipeline(this.renderer);
    this.redraw();
    return this.pipeline;
  }

  private get effects(): Omit<Effects, 'transparent' | 'zoom'> {
    const { far, controls } = this.rig;
    return {
      occlusion: this.isFine,
      blur: this.isFront ? 0 : this.stage.current.blur,
      focus: far.position.distanceTo(controls.target),
    };
  }

  /** A hand brought the camera to a place and a distance of its own. */
  get isComposed(): boolean {
    return !this.framing.follow;
  }

  /** The plant keeps its size from now on, or fits the stage again. */
  hold(on: boolean): void {
    if (on) this.rig.glide(1);
    this.framing.hold(on);
    this.redraw();
  }

  /**
   * The view as pixels of any size. `turn`: of the camera about the vertical, radians; `watch`: sees how far it is, and may
   * throw.
   */
  async shot(
    size: ShotSize,
    turn = 0,
    watch: (share: number) => void = () => {},
  ): Promise<Uint8ClampedArray<ArrayBuffer>> {
    const pipeline = await this.needPipeline();
    const { clientWidth: w, clientHeight: h } = this.element;
    const camera = cameraFor(this.camera, size, w / Math.max(1, h), this.rig.controls.target, turn);
    const { renderer, stage, effects, holder: plants } = this;
    const shadow = stage.shadowSize;
    const before = (): void => {
      this.showAids(false);
      stage.sharpen(SHADOW.fine);
      if (size.transparent) stage.setBare(true);
      this.looks.photoAlpha.value = size.transparent ? 1 : 0;
      this.guides.face(camera);
    };
    const after = (): void => {
      this.showAids(true);
      stage.setBare(false);
      this.looks.photoAlpha.value = 1;
    };
    const steps = { before, after, watch };
    const pixels = await shoot({ renderer, stage, plants, pipeline, camera, effects }, size, steps);
    if (shadow !== SHADOW.fine) stage.sharpen(shadow);
    this.redraw();
    return pixels;
  }

  /** Handles, rings and panes are for who works, and in no picture that is kept. */
  private showAids(on: boolean): void {
    this.placer.setVisible(on);
    this.rings.setVisible(on);
    if (this.mirror) this.mirror.mesh.visible = on;
  }

  /** The front view shows the same part of the plane as the sheet. */
  setFront(front: boolean): void {
    if (front === this.isFront) return;
    this.framing.front = front;
    this.stage.setFlat(front);
    this.stand();
    this.framing.fit();
    this.showHandles();
    this.framing.lay();
    this.redraw();
    this.events.front(front);
  }

  get isFront(): boolean {
    return this.framing.front;
  }

  setSheetSeen(box: Box): void {
    this.framing.setSheetSeen(box);
    if (this.isFront) this.redraw();
  }

  /** The picture as it is shown now, or would be at rest. */
  async picture(): Promise<Blob> {
    this.frames.settle();
    const aided = this.placer.isShown || this.selection.length > 1 || this.mirror !== undefined;
    if (aided) this.showAids(false);
    this.render();
    if (aided) this.showAids(true);
    if (aided) this.redraw();
    const canvas = this.renderer.domElement;
    return new Promise((resolve, reject) => {
      canvas.toBlob((b) => (b ? resolve(b) : reject(new Error(t('fault.picture')))), 'image/png');
    });
  }

  /** A hand took the camera: it is no longer moved by itself, and turning leaves the front view. */
  private taken(turns: boolean): void {
    if (this.isFront && turns) this.leaveFront();
    this.rig.leave();
    if (!turns) this.framing.follow = false;
  }

  /** From the front view into orbit: the camera begins where what is seen stays where it is. */
  leaveFront(): void {
    if (!this.isFront) return;
    const { flat, chosen, holder } = this;
    const before = chosen?.view?.front && {
      middle: holder.worldToLocal(
        new THREE.Vector3((flat.left + flat.right) / 2, (flat.bottom + flat.top) / 2, 0),
      ),
      height: (flat.top - flat.bottom) / this.framing.scale,
    };
    this.setFront(false);
    if (!before || !chosen) return;
    const { place } = chosen;
    place.updateWorldMatrix(true, false);
    const [x, y] = this.framing.shift;
    const tall = Math.max(1, this.element.clientHeight);
    this.rig.face(
      place.localToWorld(before.middle),
      new THREE.Vector3(0, 0, 1).transformDirection(place.matrixWorld),
      before.height * place.getWorldScale(sized).y,
      [x / tall, y / tall],
    );
    this.framing.follow = false;
  }

  /** In the front view the wheel zooms the sheet, whose part of the plane is seen. */
  private wheel(e: WheelEvent): void {
    if (this.camera !== this.flat || !this.rig.controls.enableZoom) return;
    e.preventDefault();
    e.stopImmediatePropagation();
    const box = this.element.getBoundingClientRect();
    const [x, y] = [e.clientX - box.left - box.width / 2, e.clientY - box.top - box.height / 2];
    this.events.zoomed(e, x / box.height, y / box.height);
  }

  private resize(): void {
    const { clientWidth: w, clientHeight: h } = this.element;
    if (w === 0 || h === 0 || this.immersing) return;
    this.renderer.setPixelRatio(this.frames.grain);
    this.renderer.setSize(w, h, false);
    this.easel?.discard();
    this.framing.lay();
    this.framing.lookAtAll();
    // The canvas is empty now. Without a graphics card another one is seen, which keeps its picture.
    if (!this.slow) this.render();
    this.redraw();
  }

  private redraw(): void {
    this.frames.redraw();
  }

  private render(): void {
    if (this.immersing) return;
    const { camera, pipeline } = this;
    this.guides.face(camera);
    this.plants.standIn?.tick(performance.now() / 1000);
    // Shadows that move with it are for a graphics card.
    if (this.plants.standIn?.moves && !this.slow) this.renderer.shadowMap.needsUpdate = true;
    const through = pipeline && (this.isFine || (this.stage.current.blur > 0 && !this.isFront));
    this.stage.prepare(!through, this.rig.far.aspect, this.holder);
    this.looks.photoAlpha.value = through ? 0 : 1;
    if (through) {
      const { x, y } = this.renderer.getDrawingBufferSize(new THREE.Vector2());
      const effects = { ...this.effects, transparent: false, zoom: 1 };
      pipeline.render(this.stage.scene, camera, x, y, null, effects);
      if (!this.slow && !this.weak && this.pace.drew(performance.now())) this.tire();
    } else {
      this.renderer.render(this.stage.scene, camera);
    }
    const { scale, shift } = this.framing;
    this.element.dataset['eye'] = JSON.stringify({ ...this.rig.pose, metre: scale, shift });
    this.events.drawn();
  }

  /** A machine that cannot draw so fast is asked for less, unless a person wants it so. */
  private tire(): void {
    this.weak = true;
    if (this.stage.current.quality === 'auto') this.setStage(this.stage.current);
  }
}

// What a headset asks for in every picture is worked out in these.
const aimed = new THREE.Ray();
const sized = new THREE.Vector3();
const stands = new THREE.Quaternion();
