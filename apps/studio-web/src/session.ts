/** The document as the worker last reported it, what is asked of it, and the stroke under the pen. */
import { Engine, type EngineEvents } from './engine';
import { measured } from './measure';
import { documentName } from './names';
import type { Request, Shown } from './protocol';
import type {
  Action,
  Command,
  DocumentState,
  PenStyle,
  PlantState,
  PlantView as Seen,
  SceneView,
  SketchCommand,
  SketchState,
  StrokeClass,
  StrokeMode,
} from './wire';

/** Below this share the reading of a stroke is shown to be doubtful. */
export const DOUBTFUL = 0.3;

export interface SessionEvents extends Omit<EngineEvents, 'state'> {
  /** The document changed; `other`: another plant than before is on the left side. */
  state(
    fresh: Parameters<EngineEvents['state']>[1],
    photo: Parameters<EngineEvents['state']>[2],
    other: boolean,
  ): void;
  refused(request: Request, why: string): void;
  /** A stroke is under the pen; what would be asked if it ended now. */
  drawing(requests: () => Request[]): void;
  /** It was none. */
  undrawn(): void;
}

export class Session {
  readonly engine: Engine;
  /** Nothing is known before the worker has answered for the first time. */
  state: DocumentState | undefined;
  scene: SceneView | undefined;
  private shownPlant: number | null | undefined;
  private draft: { mode: StrokeMode; samples: Float64Array; pen?: PenStyle } | undefined;
  /** What strokes are drawn with; nothing for the pen that every sheet has. */
  pen: () => PenStyle | undefined = () => undefined;
  private drafted = false;
  /** When the draft that is grown now was sent. */
  private draftAt = 0;

  constructor(private readonly events: SessionEvents) {
    this.engine = new Engine({
      ...events,
      state: (state, fresh, photo) => {
        this.state = state;
        const other = this.shownPlant !== undefined && state.current !== this.shownPlant;
        this.shownPlant = state.current;
        events.state(fresh, photo, other);
      },
      view: (view, fresh) => {
        this.scene = view;
        events.view(view, fresh);
        this.sendDraft();
      },
    });
  }

  /** The plant on the left side. */
  get plant(): PlantState | undefined {
    return this.state?.plants.find((p) => p.id === this.state?.current);
  }

  /** What the document is called. */
  get title(): string {
    return documentName(this.state, this.scene);
  }

  /** What is drawn of it, if it is a sketch. */
  get drawn(): SketchState | null {
    return this.plant?.sketch ?? null;
  }

  /** What the view shows of it, or the model that is viewed instead. */
  get seen(): Seen | undefined {
    return this.scene?.guest ?? this.scene?.plants.find((p) => p.id === this.state?.current);
  }

  /** What the view shows of it; nothing while a model is viewed. */
  get shapeable(): Seen | undefined {
    return this.scene?.guest ? undefined : this.seen;
  }

  /** The organ of each stroke, by the stroke's place in the drawing. */
  get organs(): Map<number, string> {
    return new Map((this.seen?.item?.strokes ?? []).map((s) => [s.index, s.organ]));
  }

  /** Whether the view has nothing to show. */
  get isBare(): boolean {
    return [this.scene?.guest, ...(this.scene?.plants ?? [])].every((p) => !p || p.parts.length === 0);
  }

  // Asking -------------------------------------------------------------------------------------------------------

  ask(request: Request): void {
    const start = performance.now();
    this.engine
      .ask(request)
      .then(() => {
        if (request.kind === 'undo') measured('undo', start);
      })
      .catch((e: Error) => this.events.refused(request, e.message));
  }

  run(command: Command): void {
    this.ask({ kind: 'command', command });
  }

  act(action: Action): void {
    this.ask({ kind: 'action', action });
  }

  select(plant: number): void {
    this.ask({ kind: 'select', plant });
  }

  /** A gesture: what is staged until it ends is one step of undo. */
  begin(name: string): void {
    this.ask({ kind: 'begin', name });
  }

  stage(command: Command): void {
    this.ask({ kind: 'stage', command });
  }

  commit(): void {
    this.ask({ kind: 'commit' });
  }

  end(keep: boolean): void {
    this.ask({ kind: keep ? 'commit' : 'abandon' });
  }

  /** Asks the drawing on the sheet. */
  draw(command: SketchCommand): void {
    if (this.plant) this.run({ sketch: [this.plant.id, command] });
  }

  stageDrawn(command: SketchCommand): void {
    if (this.plant) this.stage({ sketch: [this.plant.id, command] });
  }

  // The pen ------------------------------------------------------------------------------------------------------

  /** A stroke that is finished; `mirror`: the same on the other side. */
  stroke(mode: StrokeMode, samples: Float64Array, mirror: Float64Array | undefined): void {
    this.draft = undefined;
    this.drafted = false;
    for (const request of this.asking(mode, samples, mirror)) this.ask(request);
  }

  private asking(mode: StrokeMode, samples: Float64Array, mirror: Float64Array | undefined): Request[] {
    const pen = this.pen();
    const shown = this.shown();
    const worn = pen && { pen };
    const stroke: Request = { kind: 'stroke', mode, samples, ...worn, ...(shown.length > 0 && { shown }) };
    if (!mirror) return [stroke];
    const other: Request = { kind: 'stroke', mode, samples: mirror, ...worn };
    return [{ kind: 'begin', name: 'draw' }, stroke, other, { kind: 'commit' }];
  }

  /** What the strokes of the sheet are clearly shown as, where that is news. Nothing while what is seen is older. */
  private shown(): Shown[] {
    const { drawn, scene, seen, state } = this;
    if (!drawn || scene?.revision !== state?.revision) return [];
    const rows = new Map((seen?.item?.strokes ?? []).map((s) => [s.index, s]));
    return drawn.strokes.flatMap(({ id, class: own, shown }, row): Shown[] => {
      const is = rows.get(row);
      if (!is || own !== null) return [];
      const now = is.confidence < DOUBTFUL ? null : (is.class as StrokeClass);
      return now === shown ? [] : [[id, now]];
    });
  }

  /** The stroke under the pen, as it is now. */
  setDraft(mode: StrokeMode, samples: Float64Array, mirror: Float64Array | undefined): void {
    const pen = this.pen();
    this.events.drawing(() => this.asking(mode, samples, mirror));
    this.draft = { mode, samples, ...(pen && { pen }) };
    if (!this.engine.growing) this.sendDraft();
  }

  dropDraft(): void {
    this.draft = undefined;
    this.events.undrawn();
    if (this.drafted) this.ask({ kind: 'draft', mode: 'parts', samples: new Float64Array() });
    this.drafted = false;
  }

  /** The plant with the draft is on the screen. */
  draftShown(): void {
    if (this.draftAt > 0) measured('pen', this.draftAt);
    this.draftAt = 0;
  }

  /** At most one draft at a time is on its way. */
  private sendDraft(): void {
    const { draft } = this;
    if (!draft) return;
    this.draft = undefined;
    this.drafted = true;
    this.engine.growing = true;
    this.draftAt = performance.now();
    this.engine.ask({ kind: 'draft', ...draft }).catch(() => {
      this.engine.growing = false;
    });
  }
}
