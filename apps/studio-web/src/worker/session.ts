/** The document as the worker last reported it, what is asked of it, and the stroke under the pen. */
import { Engine, type EngineEvents } from './engine';
import { measured } from '../page/measure';
import { documentName } from '../keeping/names';
import type { Request, Shown, Staged } from './protocol';
import type { Inked } from '../sheet/underpen';
import { tell } from '../text';
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
} from '../wire';

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
  /** Resolves when the worker has said for the first time what the document holds. */
  readonly known: Promise<void>;
  private shownPlant: number | null | undefined;
  private draft: { mode: StrokeMode; samples: Float64Array; pen?: PenStyle } | undefined;
  /** What strokes are drawn with; nothing for the pen that every sheet has. */
  pen: () => PenStyle | undefined = () => undefined;
  private drafted = false;
  /** When the draft that is grown now was sent. */
  private draftAt = 0;

  constructor(private readonly events: SessionEvents) {
    let resolveKnown = (): void => undefined;
    this.known = new Promise((resolve) => {
      resolveKnown = resolve;
    });
    this.engine = new Engine({
      ...events,
      state: (state, fresh, photo) => {
        this.state = state;
        resolveKnown();
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

  stage(command: Command, ...more: readonly Command[]): void {
    const request: Request = { kind: 'stage', command, ...(more.length > 0 && { more }) };
    this.engine
      .ask<Staged>(request)
      .then(({ refused }) => refused && this.events.refused(request, tell(refused)))
      .catch((e: Error) => this.events.refused(request, e.message));
  }

  /** One command or several, as one step of undo; of several it has this name. */
  runAll(name: string, commands: readonly Command[]): void {
    const [first, ...more] = commands;
    if (first && more.length === 0) this.run(first);
    else this.together(name, commands);
  }

  /** Several commands as one step of undo of this name. */
  together(name: string, commands: readonly Command[]): void {
    const [first, ...more] = commands;
    if (!first) return;
    this.begin(name);
    this.stage(first, ...more);
    this.commit();
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

  /** A stroke that is finished. */
  stroke(mode: StrokeMode, inked: Inked): void {
    this.draft = undefined;
    this.drafted = false;
    this.ask(this.asking(mode, inked));
  }

  private asking(mode: StrokeMode, { samples, copies, straight }: Inked): Request {
    const pen = this.pen();
    const shown = this.shown();
    return {
      kind: 'stroke',
      mode,
      samples,
      ...(copies.length > 0 && { copies }),
      ...(straight && { straight }),
      ...(pen && { pen }),
      ...(shown.length > 0 && { shown }),
    };
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
  setDraft(mode: StrokeMode, inked: Inked): void {
    const pen = this.pen();
    this.events.drawing(() => [this.asking(mode, inked)]);
    this.draft = { mode, samples: inked.samples, ...(pen && { pen }) };
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
