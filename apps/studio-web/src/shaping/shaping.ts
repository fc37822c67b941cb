/** Hands on a plant in the view: tools, their settings, gestures, and the list of what was done. What a tool does is the core's. */
import { EditList } from './edits';
import { measured } from '../page/measure';
import { nameButton } from '../page/names';
import type { Request } from '../worker/protocol';
import type { Outline } from './staged';
import type {
  CarriedPose,
  Command,
  HandEdit,
  Mirror,
  PlantState,
  PlantView as Seen,
  ShapeAnswer,
  ShapeCommand,
  ShapeInput,
  ShapePointer,
  ShapeReach,
  ShapeStep,
  ViewPlane,
} from '../wire';
import { hasText, number, t } from '../text';
import { isBrush, rowOf, SHAPE_WORDS, type ShapeTool } from './tools';
import { ToolSettings } from './toolsettings';
import { type Hands, toolOptions } from './toolstrip';
import { button, el } from '../page/ui';
import { Overlay } from '../view/overlay';
import type { PlantView } from '../view/view';

export interface ShapingEvents {
  run(command: Command): void;
  ask<T>(request: Request): Promise<T>;
  refused(why: string): void;
  /** An outline that also cuts: what that is shall be seen and agreed to before. */
  cut(plant: PlantState, outline: Outline): void;
  /** Tells what a gesture came to, where the plant does not show it. */
  say(what: string): void;
  select(plant: number): void;
  /** The tool was taken up or laid down. */
  changed(): void;
}

/** How far beside a branch a hand in space means it, metres of the plant. */
export type SpaceReach = Pick<ShapeReach, 'metres' | 'per_metre'>;

/** So near to a branch, in pixels, a pointer means it; a finger is thicker. */
const NEAR = 9;
const NEAR_TOUCH = 22;
/** A step of the wheel, while a branch or a plane is held. */
const TWIST_DEG = 5;
/** So many times as wide a notch of the wheel makes a brush. */
const WIDER = 1.12;
const STILL = 5;
/** Stands for the pointer of a hand in space. */
const IN_SPACE = -1;

/** Between two rounds of what grows while it is held, ms. */
const ROUND_MS = 130;

export class Shaping {
  readonly element = el('div', { class: 'shaping' });
  readonly overlay: Overlay;
  readonly edits = new EditList((command) => this.edit(command));
  private tool: ShapeTool | undefined;
  private last: ShapeTool = 'rotate';
  private plant: PlantState | undefined;
  private seen: Seen | undefined;
  private readonly settings = new ToolSettings();
  /** The plane of symmetry, in the coordinates of the plant. */
  private sides: Mirror | undefined;
  /** Has what is held grow on. */
  private growing = 0;
  /** Its numbers were turned since the last round. */
  private turned = false;
  /** The branch that was clicked with the pointing tool. */
  private chosen: ShapeAnswer['picked'] = null;
  private lit: number | undefined;
  /** Where what is held is carried, and the meshes of which it was asked what that is. */
  private carried: CarriedPose | undefined;
  private carryAsked: number | undefined;
  /** Not what the pointer meets is meant but what bears it, so many branches up. */
  private bearers = 0;
  /** Nothing bears what was meant last. */
  private top = false;
  /** Where the pointer was last between gestures, and where the branch was clicked that is chosen. */
  private hover: ShapePointer | undefined;
  private clicked: ShapePointer | undefined;
  private pointerId: number | undefined;
  /** A hand in space: how far it reaches, and the tool of its gesture, if that is not the chosen one. */
  private space: SpaceReach | undefined;
  private once: ShapeTool | undefined;
  private thumbed = false;
  /** The branch that is meant: its course and that of all that it bears, if one is. */
  onLight: (points: Float32Array | undefined) => void = () => {};
  onHeard: (answer: ShapeAnswer) => void = () => {};
  /** The plane of outlines was placed or taken away; how large the plant is, metres. */
  onPlane: (plane: ViewPlane | undefined, size: number) => void = () => {};
  private from: [number, number] = [0, 0];
  private at: [number, number] | undefined;
  private distance: number | undefined;
  private near = NEAR;
  private moves: ShapePointer[] = [];
  /** When the first move was asked for that is not seen in the plant yet. */
  private movedAt = 0;
  private inFlight = false;
  /** What the core is asked and what follows from its answers, in order. Never fails. */
  private line: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly view: PlantView,
    private readonly events: ShapingEvents,
  ) {
    this.overlay = new Overlay(
      (points) => view.project(points),
      () => view.isAway,
    );
    const canvas = view.element.querySelector('canvas')!;
    canvas.addEventListener('pointerdown', (e) => this.down(e, canvas));
    canvas.addEventListener('pointermove', (e) => this.moved(e));
    canvas.addEventListener('pointerup', (e) => this.up(e));
    canvas.addEventListener('pointercancel', () => this.cancel());
    canvas.addEventListener('pointerleave', () => {
      if (this.pointerId === undefined) {
        this.at = undefined;
        this.light(undefined);
        this.overlay.setRing(undefined);
      }
    });
    canvas.addEventListener('wheel', (e) => this.wheel(e), { capture: true, passive: false });
    canvas.addEventListener('contextmenu', (e) => {
      if (this.tool) e.preventDefault();
    });
  }

  /** A picture of the plant was drawn: what lies over it may have moved. */
  drawn(): void {
    if (this.tool) this.overlay.draw();
  }

  get isOn(): boolean {
    return this.tool !== undefined;
  }

  get isBusy(): boolean {
    return this.pointerId !== undefined;
  }

  /** The tool, if one is in the hand. */
  get word(): ShapeTool | undefined {
    return this.tool;
  }

  /** The tool in the hand chooses branches. */
  private get isChoosing(): boolean {
    return this.tool !== undefined && rowOf(this.tool).chooses === true;
  }

  /** The tool in the hand draws outlines, on a plane that can be placed in space. */
  get isOutlining(): boolean {
    return this.tool !== undefined && rowOf(this.tool).trace === 'outline';
  }

  /** All but single leaves have stems and branches. */
  get isPossible(): boolean {
    return this.plant !== undefined && this.plant.maker !== 'leaf' && (this.seen?.parts.length ?? 0) > 0;
  }

  toggle(): void {
    this.take(this.tool ? undefined : this.last);
  }

  /** Takes a tool up, or lays it down. */
  take(tool: ShapeTool | undefined): void {
    if (tool && !this.isPossible) return;
    if (this.isBusy) this.cancel();
    if (tool !== this.tool) this.bearers = 0;
    this.tool = tool;
    if (tool) this.last = tool;
    this.chosen = null;
    this.light(undefined);
    this.overlay.setRing(undefined);
    this.view.setHands(tool !== undefined);
    if (this.sides) void this.view.setMirror(tool && this.sides, this.size);
    if (tool) this.view.element.dataset['shape'] = tool;
    else delete this.view.element.dataset['shape'];
    this.show(this.plant, this.seen);
    this.events.changed();
  }

  /** The plant that is worked on, as it is now. */
  show(plant: PlantState | undefined, seen: Seen | undefined): void {
    if (plant?.id !== this.plant?.id) {
      this.setSides(undefined);
      this.chosen = null;
      this.bearers = 0;
      this.light(undefined);
    }
    this.plant = plant;
    this.seen = seen;
    if (this.tool && !this.isPossible) {
      // A plant that is being made again is no reason to lay the tool down; another plant is.
      if (plant?.maker === 'leaf') {
        this.take(undefined);
        return;
      }
    }
    this.showStrip();
    this.edits.show(plant, seen);
  }

  /** New meshes are there: numbers of branches may have changed. */
  renewed(): void {
    if (this.movedAt > 0) measured('shape', this.movedAt);
    this.movedAt = 0;
    if (this.isBusy) return;
    // The branch that was chosen keeps its name, which is what commands go by.
    this.light(undefined);
    this.showStrip();
  }

  // The strip ----------------------------------------------------------------------------------------------------

  private showStrip(): void {
    this.element.hidden = !this.tool;
    if (
      !this.tool ||
      (this.element.contains(document.activeElement) && document.activeElement instanceof HTMLInputElement)
    )
      return;
    const focused = this.element.contains(document.activeElement) ? document.activeElement?.id : undefined;
    const bar = el('div', { class: 'tools strip', role: 'toolbar', 'aria-label': t('shape.title') });
    for (const word of SHAPE_WORDS) {
      const { icon, keys } = rowOf(word);
      const b = button(icon, t(`shape.${word}`), () => this.take(word), keys);
      b.id = `b-shape-${word}`;
      b.setAttribute('aria-pressed', String(word === this.tool));
      bar.append(nameButton(b, t(`vr.tool.${word}`)));
    }
    this.element.replaceChildren(
      el('div', { class: 'options', role: 'status' }, ...toolOptions(this.tool, this.hands)),
      bar,
    );
    if (focused) document.getElementById(focused)?.focus();
  }

  /** Means what bears the branch that was meant, or goes back towards the twig. */
  climb(by: 1 | -1): void {
    if (this.chosen && !this.clicked) {
      this.walk(by > 0 ? 'bearer' : 'borne');
      return;
    }
    if (!this.tool || !rowOf(this.tool).climbs || this.isBusy || (by > 0 ? this.top : this.bearers === 0))
      return;
    this.bearers += by;
    const at = this.chosen ? this.clicked : this.hover;
    // Not further before it is known whether there is more.
    this.top = by > 0 && at !== undefined;
    this.showStrip();
    if (!at) return;
    if (!this.chosen) {
      void this.send({ move: [at] });
      return;
    }
    this.line = this.send({ up: at }).then((answer) => {
      if (!answer?.picked || !this.isChoosing) return;
      this.chosen = answer.picked;
      this.showStrip();
    });
  }

  /** From branch to branch by keys: the pointing tool chooses without a pointer. */
  walk(to: ShapeStep): void {
    if (!this.isChoosing || this.isBusy) return;
    const from = this.chosen?.axis ?? null;
    this.line = this.send({ walk: { from, to } }).then((answer) => {
      if (!answer?.picked || !this.isChoosing) return;
      this.chosen = answer.picked;
      this.clicked = undefined;
      this.bearers = 0;
      this.showStrip();
    });
  }

  /** Changes the chosen branch, which is another one then. */
  private shapeChosen(command: ShapeCommand): void {
    this.chosen = null;
    this.light(undefined);
    this.showStrip();
    this.edit(command);
  }

  /** An edit of the plant that is shaped. */
  private edit(command: ShapeCommand): void {
    if (this.plant) this.events.run({ shape: [this.plant.id, command] });
  }

  /** Metres of the plant. */
  private get size(): number {
    const { min, max } = this.seen ?? { min: [0, 0, 0], max: [1, 1, 1] };
    return Math.max(1e-3, ...max.map((x, i) => x - min[i]!));
  }

  /** Of the brush, metres. */
  private get radius(): number {
    return this.settings.radius(this.tool, this.size);
  }

  /** `[` and `]`: the brush smaller or larger; false if the tool is no brush. */
  resize(by: number): boolean {
    const { tool } = this;
    if (!tool || !isBrush(tool)) return false;
    this.settings.set(tool, 'radius_m', Number(this.settings.of(tool)['radius_m']) * by);
    this.setTo();
    this.showStrip();
    return true;
  }

  /** The tool in the hand is set to something else, which counts at once where the tool says so. */
  private setTo(): void {
    this.showRing();
    const { tool } = this;
    if (!tool || !this.isBusy || !rowOf(tool).live) return;
    if (rowOf(tool).rounds) this.turned = true;
    else void this.send({ [tool]: this.settings.fields(tool, this.size) } as unknown as ShapeInput);
  }

  /** As the strip sees them. */
  private get hands(): Hands {
    const { settings, chosen, bearers, isMirrored, size, plant } = this;
    return {
      settings,
      chosen,
      bearers,
      isMirrored,
      size,
      editCount: plant?.edits.length ?? 0,
      turnMirror: () =>
        void this.mirror(isMirrored ? undefined : this.pointerAtMiddle()).then(() => this.showStrip()),
      changed: () => this.setTo(),
      climb: (by) => this.climb(by),
      shapeChosen: (command) => this.shapeChosen(command),
      renew: () => this.showStrip(),
    };
  }

  // A hand in space -----------------------------------------------------------------------------------------------

  /** Begins a gesture, with another tool than the chosen one if that is said; whether it did. */
  begin(at: ShapePointer, reach: SpaceReach, tool?: ShapeTool): boolean {
    if (!this.tool || this.isBusy || !this.isPossible) return false;
    [this.pointerId, this.space, this.once] = [IN_SPACE, reach, tool];
    this.moves = [];
    void this.send({ down: at });
    this.beat();
    return true;
  }

  /** Whether something grows in the hand. */
  get isGrowing(): boolean {
    return this.isBusy && this.growing !== 0;
  }

  /**
   * A number of the tool in the hand more or less, by so many of its notches, or the other of two values; nothing where it has no
   * such setting. What it is then, in words.
   */
  turn(name: string, notches: number): string {
    if (!this.tool || !(name in rowOf(this.tool).settings)) return '';
    this.settings.turn(this.tool, name, notches);
    this.setTo();
    this.showStrip();
    return this.settingsText(name);
  }

  /** Settings of the tool in the hand, in words. */
  settingsText(...names: string[]): string {
    return this.tool ? this.settings.text(this.tool, this.size, ...names) : '';
  }

  /** The plane on which outlines are drawn, if one was placed. */
  get plane(): ViewPlane | undefined {
    return this.settings.plane;
  }

  /** Places the plane on which outlines are drawn where a hand is, facing it; undefined: outlines face the eyes again. */
  async placePlane(at: ShapePointer | undefined): Promise<void> {
    const answer = at && (await this.send({ plane: at }));
    if (at && !answer?.plane) return;
    this.settings.plane = answer?.plane ?? undefined;
    this.onPlane(this.settings.plane, this.size);
  }

  /** Whether there is a plane of symmetry. */
  get isMirrored(): boolean {
    return this.sides !== undefined;
  }

  /** A plane of symmetry between the hands of somebody who looks from there; undefined: none any more. */
  async mirror(at: ShapePointer | undefined): Promise<void> {
    this.setSides((at && (await this.send({ mirror: at }))?.mirror) ?? undefined);
  }

  private setSides(sides: Mirror | undefined): void {
    if (!sides && !this.sides) return;
    this.sides = sides;
    document.body.dataset['mirror'] = sides ? sides.normal.join(' ') : '';
    void this.view.setMirror(sides, this.size);
  }

  /** What is held grows by itself, a round after the other, as fast as it can be shown. */
  private beat(): void {
    const tool = this.once ?? this.tool;
    if (!tool || !rowOf(tool).rounds) return;
    let waiting = false;
    this.turned = false;
    this.growing = window.setInterval(() => {
      if (waiting) return;
      waiting = true;
      // Only the latest numbers are told, and with the next round.
      if (this.turned)
        void this.send({ [tool]: this.settings.fields(tool, this.size) } as unknown as ShapeInput);
      this.turned = false;
      void this.send('round').finally(() => {
        waiting = false;
      });
    }, ROUND_MS);
  }

  follow(at: ShapePointer): void {
    if (this.pointerId !== IN_SPACE) return;
    this.moves.push(at);
    void this.pump();
  }

  /** The thumb on its stick, which turns what is held; undefined: it lets go of it. */
  thumb(at: [number, number] | undefined): void {
    if (this.pointerId !== IN_SPACE || (at === undefined && !this.thumbed)) return;
    this.thumbed = at !== undefined;
    void this.send({ thumb: at ?? null });
  }

  async end(at: ShapePointer): Promise<void> {
    if (this.pointerId === IN_SPACE) await this.finish(at);
  }

  /** Between gestures: what would be taken. */
  hoverAt(at: ShapePointer, reach: SpaceReach): void {
    if (!this.tool || this.isBusy || this.inFlight) return;
    this.space = reach;
    this.moves = [at];
    void this.pump();
  }

  /** How large the brush is, in words. */
  get brushText(): string {
    return this.settingsText('radius_m');
  }

  // Gestures -----------------------------------------------------------------------------------------------------

  private place(e: { clientX: number; clientY: number }): [number, number] {
    const box = this.view.element.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  private pointer(e: PointerEvent): ShapePointer | undefined {
    return this.view.pointer(
      e.clientX,
      e.clientY,
      e.pointerType === 'pen' && e.pressure > 0 ? e.pressure : 1,
    );
  }

  private down(e: PointerEvent, canvas: HTMLCanvasElement): void {
    if (!this.tool) return;
    if (this.isBusy) {
      this.cancel();
      return;
    } // a second finger: the view is turned
    const at = this.pointer(e);
    if (e.button !== 0 || !e.isPrimary || !at) return;
    this.pointerId = e.pointerId;
    canvas.setPointerCapture?.(e.pointerId);
    this.near = e.pointerType === 'touch' ? NEAR_TOUCH : NEAR;
    this.from = [e.clientX, e.clientY];
    this.view.setZoom(false);
    const { trace } = rowOf(this.tool);
    if (trace) {
      this.overlay.begin(trace, 2 * this.pixels);
      this.overlay.add(...this.place(e));
      this.overlay.draw();
    }
    void this.send({ down: at });
    this.beat();
  }

  private moved(e: PointerEvent): void {
    if (!this.tool || (this.isBusy && e.pointerId !== this.pointerId) || (!this.isBusy && e.buttons !== 0))
      return;
    this.at = this.place(e);
    const all = e.getCoalescedEvents?.() ?? [];
    for (const c of this.isBusy && all.length > 0 ? all : [e]) {
      const at = this.pointer(c);
      if (!at) continue;
      this.moves.push(at);
      if (this.isBusy && rowOf(this.tool).trace) this.overlay.add(...this.place(c));
    }
    // Between gestures only the latest place is of interest.
    if (!this.isBusy) {
      this.moves.splice(0, this.moves.length - 1);
      this.hover = this.moves[0];
      this.near = NEAR;
    } else this.overlay.draw();
    this.showRing();
    void this.pump();
  }

  private async pump(): Promise<void> {
    if (this.inFlight || this.moves.length === 0) return;
    this.inFlight = true;
    const at = this.moves.splice(0);
    if (this.isBusy && this.movedAt === 0) this.movedAt = performance.now();
    await this.send({ move: at });
    this.inFlight = false;
    void this.pump();
  }

  private up(e: PointerEvent): void {
    if (!this.isBusy || e.pointerId !== this.pointerId) return;
    const at = this.pointer(e);
    const still = Math.hypot(e.clientX - this.from[0], e.clientY - this.from[1]) <= STILL;
    if (!at) {
      this.release();
      return;
    }
    void this.finish(at, (answer) => {
      if (answer.commit) return;
      const nothing = `shape.${this.tool}.nothing`;
      if (!still && hasText(nothing)) this.events.say(t(nothing));
      if (!still || answer.picked) return;
      const plant = this.view.plantAt(e.clientX, e.clientY);
      if (plant !== undefined && plant !== this.plant?.id) this.events.select(plant);
    });
  }

  /** Lets go, and asks for the edit that this makes; `then`: what else follows from the answer. */
  private finish(at: ShapePointer, then: (answer: ShapeAnswer) => void = () => {}): Promise<unknown> {
    if (this.moves.length > 0) void this.send({ move: this.moves.splice(0) });
    const answered = this.send({ up: at });
    this.release();
    this.line = answered
      .then((answer) => {
        if (!this.isBusy) this.overlay.end();
        if (!answer) return;
        if (answer.commit) this.commit(answer.commit);
        if (this.isChoosing) {
          this.chosen = answer.picked;
          this.clicked = at;
          this.showStrip();
        }
        then(answer);
      })
      .catch((e: unknown) => this.events.refused(String(e)));
    return this.line;
  }

  /** The edit of a gesture. In a headset nothing can be asked meanwhile. */
  private commit(edit: HandEdit): void {
    if (edit.op === 'silhouette' && edit.trim && this.plant && !this.view.isAway)
      this.events.cut(this.plant, edit);
    else this.edit({ add: edit });
  }

  private release(): void {
    clearInterval(this.growing);
    this.growing = 0;
    this.pointerId = this.space = this.once = this.carryAsked = undefined;
    this.movedAt = 0;
    this.view.setZoom(true);
  }

  /** Escape, a second finger, a lost pointer: nothing is done. False if nothing was held. */
  cancel(): boolean {
    if (!this.isBusy) return false;
    this.moves = [];
    this.release();
    this.overlay.end();
    void this.send('cancel');
    return true;
  }

  /** Delete: the branch that was pointed at goes. */
  remove(): boolean {
    if (!this.isChoosing || !this.chosen?.key) return false;
    this.shapeChosen({ add: { op: 'prune', axis: this.chosen.key, at: 0 } });
    return true;
  }

  /** While something is held the wheel turns it; else a brush changes its size with Shift, and the view is zoomed. */
  private wheel(e: WheelEvent): void {
    if (!this.tool) return;
    const up = e.deltaY < 0 || e.deltaX < 0;
    const brush = isBrush(this.tool) && (this.isBusy || e.shiftKey);
    const wheel = this.isBusy ? rowOf(this.tool).wheel : undefined;
    if (!brush && !wheel) return;
    e.preventDefault();
    e.stopImmediatePropagation();
    if (brush) this.resize(up ? WIDER : 1 / WIDER);
    else if (wheel === 'twist') void this.send({ twist: up ? TWIST_DEG : -TWIST_DEG });
    else {
      this.turn(wheel![e.shiftKey ? 1 : 0], up ? 1 : -1);
    }
  }

  /** One after another: the edit of a gesture is asked for before the next gesture begins, however long the core takes. */
  private send(input: ShapeInput): Promise<ShapeAnswer | undefined> {
    const tool = this.once ?? this.tool ?? 'pick';
    const reach = {
      ...(this.space ?? this.view.reach(this.near)),
      bearers: rowOf(tool).climbs ? this.bearers : 0,
      ...(this.sides ? { mirror: this.sides } : {}),
    };
    const request: Request = {
      kind: 'shape',
      tool: this.settings.wire(tool, this.size),
      reach,
      input,
    };
    const answered = this.line.then(() => this.ask(request));
    this.line = answered;
    return answered;
  }

  private async ask(request: Request): Promise<ShapeAnswer | undefined> {
    try {
      const answer = await this.events.ask<ShapeAnswer>(request);
      this.heard(answer);
      this.onHeard(answer);
      return answer;
    } catch (e) {
      if (this.isBusy) {
        this.release();
        this.overlay.end();
      }
      if ((e as Error).message !== 'restarted') this.events.refused((e as Error).message);
      return undefined;
    }
  }

  private heard({ picked, busy, commit, carried, grown }: ShapeAnswer): void {
    this.carry(carried, commit !== null);
    const line = grown && document.getElementById('grown');
    if (line) line.textContent = grownText(grown);
    this.top = picked?.stands ?? false;
    if (picked) {
      const eye = this.at && this.view.element.getBoundingClientRect();
      const at =
        eye && this.at ? this.view.pointer(this.at[0] + eye.left, this.at[1] + eye.top, 1) : undefined;
      if (at) this.distance = Math.hypot(...picked.point.map((x, i) => x - at.origin[i]!));
      this.showRing();
    }
    document.body.dataset['picked'] = String(picked?.axis ?? '');
    document.body.dataset['bears'] = String(picked?.bears ?? '');
    // What moves under the hand is seen in the plant itself.
    const row = this.tool && rowOf(this.tool);
    const draws = row?.trace !== undefined;
    const isLine = row?.trace === 'line';
    const moving = commit !== null || ((busy || this.isBusy) && !isLine);
    this.light(
      moving || (draws && !isLine)
        ? undefined
        : (picked?.axis ?? (row?.chooses ? this.chosen?.axis : undefined)),
    );
  }

  /** Moves what the hand carries as it is seen; what it let go stays there until it is meshed again. */
  private carry(pose: CarriedPose | null, done: boolean): void {
    this.carried = pose ?? undefined;
    document.body.dataset['carried'] = pose ? pose.to.concat(pose.turn).join(' ') : '';
    if (!pose) {
      if (!done) this.view.putBack();
      return;
    }
    if (this.view.carried === pose.mesh) this.pose(pose);
    else if (this.carryAsked !== pose.mesh) {
      this.carryAsked = pose.mesh;
      this.events.ask<Uint32Array>({ kind: 'held' }).then(
        (rows) => {
          if (this.carried?.mesh !== pose.mesh) return;
          this.view.carry(pose.mesh, rows);
          this.pose(this.carried);
        },
        () => undefined,
      );
    }
  }

  private pose(pose: CarriedPose): void {
    this.view.pose(pose);
    if (this.movedAt > 0) measured('shape', this.movedAt);
    this.movedAt = 0;
  }

  /** Lights the branch that is meant, with all that it bears. */
  private light(axis: number | undefined): void {
    if (axis === this.lit) return;
    this.lit = axis;
    if (axis === undefined) {
      this.overlay.setBranch(undefined);
      this.onLight(undefined);
      return;
    }
    this.events.ask<Float32Array>({ kind: 'branch', axis }).then(
      (points) => {
        if (this.lit !== axis) return;
        this.overlay.setBranch(points);
        this.onLight(points);
      },
      () => undefined,
    );
  }

  /** The brush's radius on the screen. */
  private get pixels(): number {
    const { metres, per_metre } = this.view.reach(1);
    const far = this.distance ?? this.middle();
    return this.radius / Math.max(1e-9, metres + per_metre * far);
  }

  /** How far the plant's middle is away, metres. */
  private middle(): number {
    const { min, max } = this.seen ?? { min: [0, 0, 0], max: [1, 1, 1] };
    const at = this.pointerAtMiddle();
    return at ? Math.hypot(...min.map((x, i) => (x + max[i]!) / 2 - at.origin[i]!)) : this.size;
  }

  private pointerAtMiddle(): ShapePointer | undefined {
    const box = this.view.element.getBoundingClientRect();
    return this.view.pointer(box.left + box.width / 2, box.top + box.height / 2, 1);
  }

  private showRing(): void {
    this.overlay.setRing(
      isBrush(this.tool) && this.at ? { x: this.at[0], y: this.at[1], r: this.pixels } : undefined,
    );
  }
}

/** How old and how dense it is what grows in the hand. */
export function grownText({ rounds, branches, per_metre }: NonNullable<ShapeAnswer['grown']>): string {
  const density = per_metre === null ? '–' : per_metre.toFixed(1);
  return t('shape.grown', { rounds, branches: number(branches), density });
}
