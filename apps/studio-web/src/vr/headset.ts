/**
 * The scene in a headset: hands with tracked controllers do what the pointer does on the page, with the same tools,
 * settings and history. What a tool does is the core's.
 */
import * as THREE from 'three';
import { grownText, type Shaping, type SpaceReach } from '../shaping/shaping';
import { setSetting, setting } from '../keeping/store';
import { t, type TextKey } from '../text';
import { isBrush, rowOf } from '../shaping/tools';
import { hearNotes } from '../page/ui';
import type { PlantView } from '../view/view';
import type { Growth, ShapeAnswer, ShapePointer, ViewPlane } from '../wire';
import { type Board, rowsOf } from './board';
import { Carried } from './carried';
import { Controller, type Part } from './controller';
import type { HeadsetEvents, Mode } from './events';
import { Labels, Readout } from './labels';
import { Lesson } from './lesson';
import { Placing } from './placing';
import { Recorder } from './recorder';
import { Trace } from './trace';
import { SNAP, World } from './world';
import { Wrist } from './wrist';

/** Within so far of a controller's tip, metres of the person, wood is meant that it does not touch. */
const NEAR_M = 0.035;
/** And so much more with each metre along its ray. */
const NEAR_PER_M = 0.02;
/** A stick further out than this means something. */
const OUT = 0.6;
/** A brush grows or shrinks by this in a frame with the stick all the way out. */
const BRUSH = 1.02;
/** So long the picture is dark when one goes elsewhere, ms. */
const BLINK_MS = 110;
/** A step of the seat, metres. */
const SEAT_M = 0.1;
/** Between two reports to the page, ms: writing one takes memory and time. */
const REPORT_MS = 100;
/** Eyes above the floor where the device does not know the floor. */
const EYES_M = 1.5;
/** A hand that is not seen for so long, ms, has let go. */
const LOST_MS = 1000;
/** So long the first picture waits for plants that are quickly drawn, ms. */
const PATIENCE_MS = 300;
/** After so long without anything new the page makes ready to go in, ms. */
const READY_MS = 400;
/** What the stick turns while something grows: upwards, sideways. A click on it takes the next pair. */
const TURNS = [
  ['vigour', 'angle_deg'],
  ['apical', 'lift'],
  ['apart', 'angle_deg'],
] as const satisfies readonly (readonly [keyof Growth, keyof Growth])[];
/** Triangles of all plants, drawn for each eye; what else is seen has few. */
const MOST_TRIANGLES = 140_000;
/** What a hand feels where something snaps into place. */
const SNAPPED = { strength: 0.4, ms: 15 } as const;

export class Headset {
  private session: XRSession | undefined;
  private readonly world = new World();
  private readonly wrist = new Wrist();
  private hands: Controller[] = [];
  private readonly grasping: THREE.Vector3[] = [];
  private readonly pointerLine = line(2, 0xffffff);
  private readonly trace = new Trace();
  private readonly lit = new THREE.LineSegments(
    new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ color: 0xffd34d, depthTest: false, toneMapped: false }),
  );
  private readonly tips = [0, 1].map(() => new THREE.Mesh(new THREE.SphereGeometry(0.006, 12, 8), white()));
  private readonly ring = new THREE.Mesh(
    new THREE.RingGeometry(0.16, 0.2, 40).rotateX(-Math.PI / 2),
    white(),
  );
  private readonly dark = new THREE.Mesh(
    new THREE.SphereGeometry(0.08, 8, 6),
    new THREE.MeshBasicMaterial({ color: 0, side: THREE.BackSide, depthTest: false }),
  );
  private darkUntil = 0;
  private trueScale = false;
  private leftHanded = setting('vr.left') === 'yes';
  private seat = Number(setting('vr.seat')) || 0;
  private raised = 0;
  /** The controller whose gesture is going on, and where it was last. */
  private working: { hand: Controller; by: 'trigger' | 'grip'; last: ShapePointer } | undefined;
  private aiming = false;
  private turned = false;
  /** On what the branch in the hand would be dropped, as it was heard last. */
  private host: number | null = null;
  /** Without a second hand the board stands beside the person, since it was put there. */
  private isBoardPut = false;
  private frames = 0;
  private readying = 0;
  private onSeen: () => void = () => {};
  /** From the wish to go in until the session was there, the scene was given to it, and the first picture was drawn. */
  private readonly entryMs = { session: 0, ready: 0, first: 0 };
  private reportAt = 0;
  /** The pair of numbers that the stick turns. */
  private pair = 0;
  private readonly readout = new Readout();
  private readonly placing = new Placing();
  readonly recorder = new Recorder();
  /** An obstacle in the hand. */
  private carried: Carried | undefined;
  private lostAt = 0;
  private readonly lesson = new Lesson(Number(setting('vr.lesson')) || 0, (done) =>
    setSetting('vr.lesson', String(done)),
  );
  private labels: Labels[] = [];
  /** What one of them says: another language says something else. */
  private labelled = '';
  /** The plane on which outlines are drawn. */
  private readonly sheet = new THREE.GridHelper(1, 12, 0x9be07a, 0x9be07a);

  /** What the keys of the wrist show and do. */
  private readonly board: Board = {
    page: 'tools',
    state: () => ({
      placed: this.placing.kind,
      isRecorded: this.recorder.isOn,
      trueScale: this.trueScale,
      leftHanded: this.leftHanded,
      trace: { colour: `#${this.trace.hex.toString(16).padStart(6, '0')}`, mm: this.trace.mm },
    }),
    say: (text) => this.wrist.say(text),
    undone: () => this.did('undo'),
    tellPlant: (by) => this.tellPlant(by),
    place: (kind) => this.place(kind),
    writeDown: () => void this.writeDown(),
    mirror: (hand) => void this.mirror(this.pointer(hand)),
    brush: (by) => this.brush(by),
    traceColour: () => this.trace.nextColour(),
    traceThickness: () => this.trace.nextThickness(),
    resize: () => {
      this.trueScale = !this.trueScale;
      this.blink(() => this.stand());
    },
    swapHands: () => {
      this.leftHanded = !this.leftHanded;
      setSetting('vr.left', this.leftHanded ? 'yes' : 'no');
      this.label();
    },
    sit: (by) => this.sit(by * SEAT_M),
    leave: () => void this.leave(),
    startLesson: () => this.startLesson(),
  };

  constructor(
    private readonly view: PlantView,
    private readonly shaping: Shaping,
    private readonly events: HeadsetEvents,
  ) {
    const { rig } = this.world;
    for (const thing of [this.wrist.board, this.pointerLine, ...this.tips, this.dark, this.readout.sprite])
      rig.add(thing);
    for (const thing of [this.pointerLine, this.lit]) thing.frustumCulled = false;
    this.lit.renderOrder = 9;
    this.dark.renderOrder = 20;
    this.dark.visible = this.ring.visible = false;
    this.sheet.matrixAutoUpdate = false;
    (this.sheet.material as THREE.Material).transparent = true;
    (this.sheet.material as THREE.Material).opacity = 0.45;
    this.makeReady();
  }

  get isOn(): boolean {
    return this.session !== undefined;
  }

  /** Puts the scene before the person's eyes. */
  async enter(mode: Mode): Promise<void> {
    const { xr } = navigator as { xr?: XRSystem };
    if (!xr || this.session) return;
    const asked = performance.now();
    // Coarser plants come while the device wakes up; the first picture waits for them a little.
    const coarser = new Promise<void>((done) => {
      this.onSeen = done;
      setTimeout(done, PATIENCE_MS);
    });
    this.events.most(MOST_TRIANGLES);
    const session = await xr
      .requestSession(mode, { optionalFeatures: ['local-floor', 'hand-tracking'] })
      .catch((e: unknown) => {
        this.events.most(0);
        throw e;
      });
    this.entryMs.session = Math.round(performance.now() - asked);
    this.session = session;
    session.addEventListener('end', () => this.left());
    session.addEventListener('inputsourceschange', (e) => {
      for (const source of e.removed) this.gone(source);
      for (const source of e.added) this.come(source);
    });
    session.addEventListener('visibilitychange', () => {
      // The headset was taken off, or its menu is open: nothing is held on to.
      if (session.visibilityState !== 'visible') this.finish();
    });
    for (const source of session.inputSources) this.come(source);
    this.shaping.onLight = (points) => this.light(points);
    this.shaping.onHeard = (answer) => this.heard(answer);
    // What the page notes is not seen in here.
    hearNotes((text) => this.wrist.say(text));
    this.shaping.onPlane = (plane, size) => this.showPlane(plane, size);
    this.labelAgain();
    const floor = await session.requestReferenceSpace('local-floor').then(
      () => true,
      () => false,
    );
    this.raised = floor ? 0 : EYES_M;
    this.frames = 0;
    this.isBoardPut = false;
    await coarser;
    if (this.session !== session) return;
    // From here on the page draws no picture of its own: one of all that stands there may take long.
    if (!this.shaping.isOn) this.shaping.toggle();
    this.stand();
    this.tellStep();
    this.showKeys();
    await this.view.immerse(
      session,
      floor ? 'local-floor' : 'local',
      this.world.rig,
      mode === 'immersive-ar',
      {
        things: [this.trace.mesh, this.lit, this.ring],
        frame: (frame, space) => {
          // Of the first picture: all of this is done before the next is begun.
          if (this.frames === 1) this.entryMs.first = Math.round(performance.now() - asked);
          this.frame(frame, space);
        },
      },
    );
    this.entryMs.ready = Math.round(performance.now() - asked);
    this.events.changed(true);
  }

  async leave(): Promise<void> {
    this.finish();
    await this.session?.end();
  }

  /** The plants were made again, and are seen. */
  seen(): void {
    this.recorder.seen();
    this.onSeen();
  }

  /** The plant that is shaped, its meshes or its edits are others now. */
  renewed(): void {
    if (this.isOn) this.showKeys();
    else this.makeReady();
  }

  /** What takes time before the first picture is done while nobody waits for it; once, however much is new. */
  private makeReady(): void {
    clearTimeout(this.readying);
    this.readying = window.setTimeout(() => {
      if (this.isOn) return;
      this.labelAgain();
      this.showKeys();
      this.events.ready(MOST_TRIANGLES);
      void this.view.readyToImmerse([this.world.rig, this.trace.mesh, this.lit, this.ring, this.sheet]);
    }, READY_MS);
  }

  private left(): void {
    this.finish();
    this.session = undefined;
    this.hands = [];
    this.events.most(0);
    this.light(undefined);
    this.shaping.onLight = this.shaping.onHeard = this.shaping.onPlane = () => {};
    hearNotes(undefined);
    this.placing.put(undefined);
    this.readout.say(undefined);
    this.sheet.removeFromParent();
    this.events.changed(false);
  }

  private come(source: XRInputSource): void {
    if (source.targetRayMode === 'tracked-pointer') this.hands.push(new Controller(source));
  }

  private gone(source: XRInputSource): void {
    if (this.working?.hand.source === source) this.finish();
    this.hands = this.hands.filter((hand) => hand.source !== source);
  }

  private stand(): void {
    const { metre, reach } = this.view.immersed;
    this.world.stand(this.trueScale, metre, reach, this.raised + this.seat);
  }

  // Every frame: nothing is made here that lasts ------------------------------------------------------------------

  private frame(frame: XRFrame, space: XRReferenceSpace): void {
    this.frames += 1;
    const pose = frame.getViewerPose(space);
    if (pose) head.setFromMatrixPosition(eyes.fromArray(pose.transform.matrix));
    let tool: Controller | undefined;
    let menu: Controller | undefined;
    for (const hand of this.hands) {
      hand.read(frame, space);
      if (hand.handedness === (this.leftHanded ? 'right' : 'left')) menu = hand;
      else tool = hand;
    }
    // One controller alone works.
    if (!tool) {
      tool = menu;
      menu = undefined;
    }
    this.show(tool, menu);
    if (tool && menu && tool.holds('grip') && menu.holds('grip')) this.cancelGrip();
    this.moveWorld(tool, menu);
    if (menu) this.walk(menu);
    if (tool) this.work(tool);
    this.dark.visible = performance.now() < this.darkUntil;
    this.dark.position.copy(head);
    this.report(tool);
  }

  private show(tool: Controller | undefined, menu: Controller | undefined): void {
    this.wrist.board.visible = menu ? menu.tracked : tool !== undefined;
    if (menu?.tracked) this.wrist.follow(menu.grip);
    else if (!menu && tool && !this.isBoardPut) this.wrist.rest(eyes);
    this.isBoardPut = !menu && tool !== undefined;
    this.readout.follow(tool);
    this.mark(0, tool);
    this.mark(1, menu);
  }

  private mark(i: 0 | 1, hand: Controller | undefined): void {
    const tip = this.tips[i]!;
    tip.visible = hand?.tracked ?? false;
    if (hand) tip.position.copy(hand.tip);
    this.labels[i]?.follow(hand);
  }

  /** The other hand's grip moves the scene, both turn and scale it. */
  private moveWorld(tool: Controller | undefined, menu: Controller | undefined): void {
    const both = menu?.holds('grip') && tool?.holds('grip') && !this.working && !this.carried;
    const { grasping } = this;
    grasping.length = 0;
    if (both) grasping.push(tool!.tip, menu!.tip);
    else if (menu?.holds('grip') && menu.tracked) grasping.push(menu.tip);
    this.world.grasp(grasping);
  }

  /** The other hand's stick: forward goes where it points, sideways turns. */
  private walk(menu: Controller): void {
    const x = menu.thumb[0];
    const y = menu.thumb[1];
    if (y > OUT && menu.tracked) this.aiming = true;
    if (this.aiming) {
      this.world.toScene(menu.tip, from);
      way.copy(menu.direction).applyQuaternion(this.world.rig.quaternion);
      const to = this.world.landing(from, way, landing);
      this.ring.visible = to !== undefined;
      if (to) {
        this.ring.position.copy(to);
        this.ring.scale.setScalar(this.world.size);
      }
      if (y < OUT / 2) {
        if (to) this.blink(() => this.world.go(to, head));
        this.aiming = this.ring.visible = false;
      }
    } else if (Math.abs(x) > OUT && !this.turned) {
      this.blink(() => this.world.turn(x > 0 ? -SNAP : SNAP, head));
      menu.pulse(SNAPPED.strength, SNAPPED.ms);
      this.turned = true;
    }
    if (Math.abs(x) < OUT / 2) this.turned = false;
  }

  private blink(act: () => void): void {
    act();
    this.darkUntil = performance.now() + BLINK_MS;
  }

  private work(hand: Controller): void {
    const { shaping } = this;
    const busy = this.working !== undefined || this.placing.isDrawn || this.carried !== undefined;
    const board = busy ? undefined : this.wrist.meet(hand.tip, hand.direction);
    this.wrist.point(board?.key);
    this.pointTo(hand, board?.distance);
    if (!this.shaping.isGrowing) {
      if (hand.pressed('upper')) {
        this.events.undo();
        this.did('undo');
      }
      if (hand.pressed('lower')) this.events.redo();
    }
    if (board) {
      if (hand.pressed('trigger') && board.key) {
        hand.pulse(0.5, 20);
        board.key.act(hand);
        this.showKeys();
      }
      return;
    }
    const { working } = this;
    if (working && working.hand !== hand) {
      this.finish();
      return;
    }
    const at = hand.tracked && this.asks(hand) ? this.pointer(hand) : undefined;
    if (this.carried) {
      this.carry(hand, at);
      return;
    }
    if (!working && this.placing.isOn) {
      this.obstruct(hand, at);
      return;
    }
    if (!working && shaping.isOutlining && hand.holds('grip')) {
      // The plane goes with the hand until the grip is let go.
      if (at && this.frames % 3 === 0) void shaping.placePlane(at);
      if (hand.pressed('grip')) this.wrist.say(t('vr.plane.hint'));
      return;
    }
    if (!working) {
      const by = hand.pressed('trigger') ? 'trigger' : hand.pressed('grip') ? 'grip' : undefined;
      if (at && by === 'grip' && this.takeObstacle(hand, at)) return;
      if (at && by) this.begin(hand, by, at);
      else if (at && this.frames % 3 === 0) shaping.hoverAt(at, this.reach());
      this.size(hand);
      return;
    }
    if (hand.jumped || hand.released(working.by)) {
      this.finish(hand.jumped ? undefined : at);
      return;
    }
    if (!at) {
      // A controller says itself when its trigger is let go; fingers that are not seen never do.
      if (this.lostAt === 0) this.lostAt = performance.now();
      if (hand.isHand && performance.now() - this.lostAt > LOST_MS) this.finish();
      return;
    }
    this.lostAt = 0;
    working.last = at;
    shaping.follow(at);
    this.draw(hand);
    const x = hand.thumb[0];
    const y = hand.thumb[1];
    const word = working.by === 'grip' ? 'rotate' : shaping.word;
    const row = word && rowOf(word);
    if (row?.live && !row.rounds) this.size(hand);
    else if (!row?.rounds) shaping.thumb(x === 0 && y === 0 ? undefined : [x, y]);
    else this.turnNumbers(hand, x, y);
  }

  /** Whether this picture needs to know where a hand is in the plant: with nothing in it, every third one does. */
  private asks(hand: Controller): boolean {
    if (this.working || this.carried || this.placing.isOn || this.frames % 3 === 0) return true;
    return hand.holds('grip') || hand.holds('trigger');
  }

  /** While it grows: the stick turns two numbers, a click on it takes the next two, and the wrist has all. */
  private turnNumbers(hand: Controller, x: number, y: number): void {
    const { shaping } = this;
    if (hand.pressed('stick')) this.pair = (this.pair + 1) % TURNS.length;
    const [up, aside] = TURNS[this.pair]!;
    if (Math.hypot(x, y) > OUT && this.frames % 6 === 0) {
      if (Math.abs(y) > OUT / 2) shaping.turn(up, y / 2);
      if (Math.abs(x) > OUT / 2) shaping.turn(aside, x / 2);
    } else if (!hand.pressed('stick')) {
      const meant = this.wrist.meet(hand.tip, hand.direction)?.key;
      this.wrist.point(meant);
      // The trigger is taken: the lower button presses keys.
      if (!meant || !hand.pressed('lower')) return;
      hand.pulse(0.5, 20);
      meant.act(hand);
      return;
    }
    this.wrist.say(shaping.settingsText(up, aside));
  }

  private begin(hand: Controller, by: 'trigger' | 'grip', at: ShapePointer): void {
    // What the grip takes is turned, whatever tool is chosen.
    const tool = by === 'grip' ? 'rotate' : undefined;
    if (!this.shaping.begin(at, this.reach(), tool)) {
      this.wrist.say(t('vr.nothing'));
      return;
    }
    hand.pulse(0.7, 30);
    this.working = { hand, by, last: at };
    this.host = null;
    this.trace.begin();
    const word = tool ?? this.shaping.word;
    if (word && rowOf(word).rounds) this.showKeys();
    if (word === 'rotate') this.did('turn');
    else if (word !== 'pick') this.did('draw');
    // What only points draws elsewhere than it is.
    this.trace.mesh.visible = word !== undefined && rowOf(word).trace !== undefined && !hand.isPointer;
    this.draw(hand);
  }

  /** The gesture ends where the hand is, or was last. */
  private finish(at?: ShapePointer): void {
    this.layDown();
    const { working } = this;
    if (!working) return;
    this.working = undefined;
    this.trace.mesh.visible = false;
    this.lostAt = 0;
    working.hand.pulse(0.9, 40);
    void this.shaping.end(at ?? working.last);
    this.showKeys();
  }

  /** An obstacle is drawn out with the trigger; the grip lays it down. */
  private obstruct(hand: Controller, at: ShapePointer | undefined): void {
    const { placing } = this;
    if (hand.pressed('grip')) placing.put(undefined);
    else if (hand.released('trigger')) {
      const shape = placing.end(3 * this.reach().metres);
      if (!shape) return;
      hand.pulse(0.9, 40);
      this.events.obstruct(shape);
    } else if (at) {
      if (hand.pressed('trigger')) {
        hand.pulse(0.7, 30);
        this.view.lieOnPlant(placing.begin(at.origin));
      } else placing.follow(at.origin);
      return;
    } else return;
    this.showKeys();
  }

  /** What stands in the way is taken by the grip in it; whether there is any. */
  private takeObstacle(hand: Controller, at: ShapePointer): boolean {
    const taken = at.tip && this.view.obstacleAround(at.tip);
    if (!taken) return false;
    hand.pulse(0.7, 30);
    this.carried = new Carried(taken.row, taken.thing, at.origin, this.turnOf(hand));
    return true;
  }

  /** How a hand is turned, in the coordinates of the plant. */
  private turnOf(hand: Controller): THREE.Quaternion {
    turn.setFromRotationMatrix(hand.grip).premultiply(this.world.rig.quaternion);
    return this.view.turnOnPlant(turn);
  }

  /** It goes and turns with the hand until the grip is let go; the stick makes it larger or smaller. */
  private carry(hand: Controller, at: ShapePointer | undefined): void {
    const { carried } = this;
    if (!carried) return;
    if (!hand.holds('grip') || hand.jumped) {
      this.layDown();
      return;
    }
    const y = hand.thumb[1];
    if (Math.abs(y) > OUT) {
      carried.size(BRUSH ** Math.sign(y));
      this.wrist.say(t('vr.obstacle.size', { percent: Math.round(100 * carried.times) }));
    }
    if (at) carried.follow(at.origin, this.turnOf(hand));
  }

  /** What was carried stands where the hand was last. */
  private layDown(): void {
    const { carried } = this;
    if (!carried) return;
    this.carried = undefined;
    const how = carried.done();
    if (how) this.events.setDown(carried.row, how);
    else carried.putBack();
  }

  /** Both grips mean the scene. */
  private cancelGrip(): void {
    if (this.working?.by !== 'grip') return;
    this.working = undefined;
    this.shaping.cancel();
  }

  /** The stick makes a brush larger or smaller. */
  private size(hand: Controller): void {
    const [x, y] = hand.thumb;
    // Sideways: how dense it is.
    const { word } = this.shaping;
    if (isBrush(word) && Math.abs(x) > OUT && Math.abs(x) > Math.abs(y)) {
      const said = this.frames % 12 === 0 && this.shaping.turn('density', Math.sign(x));
      if (said) this.wrist.say(said);
      return;
    }
    if (Math.abs(y) > OUT && this.shaping.resize(BRUSH ** Math.sign(y)))
      this.wrist.say(this.shaping.brushText);
  }

  private pointer(hand: Controller): ShapePointer | undefined {
    this.world.toScene(hand.tip, from);
    way.copy(hand.direction).applyQuaternion(this.world.rig.quaternion);
    const pressure = hand.holds('trigger') ? hand.value('trigger') : 1;
    const at = this.view.pointerInSpace(from, way, pressure);
    if (!at) return undefined;
    // Of three degrees of freedom only the way it points is known: it works on planes, as a mouse does.
    if (hand.isPointer) at.tip = null;
    else at.hand = this.turnOf(hand).toArray();
    return at;
  }

  private reach(): SpaceReach {
    return { metres: NEAR_M * this.world.size * this.view.metresPerUnit, per_metre: NEAR_PER_M };
  }

  private pointTo(hand: Controller, distance: number | undefined): void {
    const { pointerLine: drawn } = this;
    drawn.visible = hand.tracked && !this.trace.mesh.visible;
    const place = drawn.geometry.getAttribute('position') as THREE.BufferAttribute;
    place.setXYZ(0, hand.tip.x, hand.tip.y, hand.tip.z);
    from.copy(hand.tip).addScaledVector(hand.direction, distance ?? 0.35);
    place.setXYZ(1, from.x, from.y, from.z);
    place.needsUpdate = true;
  }

  private draw(hand: Controller): void {
    if (!this.trace.mesh.visible) return;
    this.world.toScene(hand.tip, from);
    this.trace.add(from, hand.value('trigger'), this.world.size);
  }

  /** What tests and support see of it, where they look: it takes memory in every picture. */
  private report(tool: Controller | undefined): void {
    if (!(window as { burgeonWatches?: boolean }).burgeonWatches) return;
    const now = performance.now();
    if (now < this.reportAt) return;
    this.reportAt = now + REPORT_MS;
    const { position, quaternion, scale } = this.world.rig;
    const state = {
      frames: this.frames,
      size: scale.x,
      at: position.toArray(),
      working: this.working !== undefined,
      tool: this.shaping.word,
      turn: THREE.MathUtils.radToDeg(2 * Math.atan2(quaternion.y, quaternion.w)),
      tracked: tool?.tracked ?? false,
      said: this.wrist.text,
      labels: this.labels.reduce((sum, l) => sum + l.shown, 0),
      step: this.lesson.step ?? '',
      plane: this.shaping.plane !== undefined,
      read: this.readout.text,
      page: this.board.page,
      letters: this.wrist.lettersMm,
      trace: { points: this.trace.points, colour: this.trace.hex, mm: this.trace.mm },
      pointer: tool?.isPointer ?? false,
      hand: tool?.isHand ?? false,
      entry: this.entryMs,
      cost: this.view.cost,
      records: this.recorder.isOn,
    };
    document.body.dataset['vr'] = JSON.stringify(state);
    document.body.dataset['wrist'] = JSON.stringify(this.wrist.places());
  }

  // What is told --------------------------------------------------------------------------------------------------

  private heard({ turned_deg: degrees, grown, busy, host }: ShapeAnswer): void {
    // It would sit elsewhere now: the hand feels that it came off, or where it snaps to.
    if (busy && host !== this.host) this.working?.hand.pulse(SNAPPED.strength, SNAPPED.ms);
    this.host = host;
    if (degrees !== null) this.wrist.say(`${degrees.toFixed(1)}°`);
    this.readout.say(grown && busy ? grownText(grown) : undefined);
  }

  /** Which plant is worked on. */
  private tellPlant(by: -1 | 0 | 1): void {
    const plant = this.events.select(by);
    if (plant) this.wrist.say(t('vr.plant.is', plant));
  }

  /** A switch: the sides are those of who looks now. */
  private async mirror(at: ShapePointer | undefined): Promise<void> {
    await this.shaping.mirror(this.shaping.isMirrored ? undefined : at);
    this.wrist.say(t(this.shaping.isMirrored ? 'vr.mirror.on' : 'vr.mirror.off'));
    this.showKeys();
  }

  /** Begins to write down what hands do, or ends it and hands the record to the browser. */
  private async writeDown(): Promise<void> {
    const { recorder, events } = this;
    if (recorder.isOn) {
      const record = recorder.stop(events.seen().digest);
      if (record) events.write(record);
    } else {
      const project = await events.project();
      recorder.start(project, events.seen());
      this.wrist.say(t('vr.record.on'));
    }
    this.showKeys();
  }

  private place(kind: 'ball' | 'box'): void {
    const could = this.events.obstacles() !== undefined;
    this.placing.put(could && this.placing.kind !== kind ? kind : undefined);
    this.wrist.say(t(could ? 'vr.place' : 'vr.place.tree'));
  }

  /** Lights the branch that is meant. */
  private light(points: Float32Array | undefined): void {
    const { geometry } = this.lit;
    this.lit.visible = points !== undefined && points.length > 0;
    if (!points) return;
    const n = points.length / 4;
    const places = new Float32Array(3 * n);
    for (let i = 0; i < n; i += 1) places.set(points.subarray(4 * i, 4 * i + 3), 3 * i);
    geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
    this.view.lieOnPlant(this.lit);
  }

  private showKeys(): void {
    this.wrist.set(rowsOf(this.board, this.shaping, this.events));
  }

  // The first minute ----------------------------------------------------------------------------------------------

  private labelAgain(): void {
    if (this.labelled !== t('vr.label.work.trigger')) this.label();
  }

  /** What each part does, beside it, until it was used. */
  private label(): void {
    this.labelled = t('vr.label.work.trigger');
    const used = new Set((setting('vr.used') ?? '').split(' '));
    const learn = (name: string): void => {
      used.add(name);
      setSetting('vr.used', [...used].filter((n) => n !== '').join(' '));
    };
    const texts = (parts: readonly Part[], hand: string): Partial<Record<Part, string>> =>
      Object.fromEntries(parts.map((part) => [part, t(`vr.label.${hand}.${part}` as TextKey)]));
    for (const labels of this.labels) labels.dispose();
    this.labels = [
      new Labels(texts(['trigger', 'grip', 'upper', 'stick'], 'work'), used, 'work', learn),
      new Labels(texts(['grip', 'stick'], 'other'), used, 'other', learn, this.leftHanded ? 0.17 : -0.17),
    ];
    this.world.rig.add(...this.labels.map((l) => l.group));
  }

  private did(what: 'turn' | 'draw' | 'undo'): void {
    if (this.lesson.did(what)) this.tellStep();
  }

  /** What is to be done first; who has done it all is told what trigger and grip are. */
  private tellStep(): void {
    const { step } = this.lesson;
    this.wrist.say(t(step ? `vr.lesson.${step}` : 'vr.hello'));
  }

  private startLesson(): void {
    this.lesson.again();
    // Its first step is that of this tool; with others the grip may do something else.
    this.shaping.take('rotate');
    setSetting('vr.used', '');
    this.label();
    this.tellStep();
  }

  /** A grid where outlines are drawn. */
  private showPlane(plane: ViewPlane | undefined, size: number): void {
    this.sheet.removeFromParent();
    this.showKeys();
    if (!plane) return;
    // A grid lies in x and z, and looks along y.
    const [right, up] = [from.fromArray(plane.right), way.fromArray(plane.up)];
    landing.crossVectors(right, up);
    this.sheet.matrix
      .makeBasis(right, landing, up.negate())
      .scale(scale.setScalar(1.6 * size))
      .setPosition(...plane.origin);
    this.view.lieOnPlant(this.sheet);
    this.sheet.matrixWorldNeedsUpdate = true;
  }

  private brush(by: number): void {
    if (this.shaping.resize(by)) this.wrist.say(this.shaping.brushText);
  }

  private sit(by: number): void {
    const seat = THREE.MathUtils.clamp(this.seat + by, -1, 1.5);
    this.world.raise(seat - this.seat);
    this.seat = seat;
    setSetting('vr.seat', String(seat));
  }
}

function white(): THREE.MeshBasicMaterial {
  return new THREE.MeshBasicMaterial({ color: 0xffffff, toneMapped: false });
}

function line(points: number, color: number): THREE.Line<THREE.BufferGeometry, THREE.LineBasicMaterial> {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * points), 3));
  return new THREE.Line(geometry, new THREE.LineBasicMaterial({ color, toneMapped: false }));
}

const head = new THREE.Vector3(0, 1.6, 0);
const from = new THREE.Vector3();
const way = new THREE.Vector3();
const landing = new THREE.Vector3();
const turn = new THREE.Quaternion();
/** The head, in the person's space. */
const eyes = new THREE.Matrix4().setPosition(0, 1.6, 0);
const scale = new THREE.Vector3();
