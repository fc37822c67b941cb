/** The worker: owns the session, answers requests in order, and grows the plant when nothing else is to do. */
import init, {
  settle_export as settleExport,
  studio_schema as studioSchema,
  StudioSession,
} from '../wasm/burgeon_wasm.js';
import { picturesOf, texturesOf } from './protocol';
import type {
  ExportedArrays,
  FromWorker,
  InkRequest,
  PartArrays,
  Request,
  Sent,
  SentExport,
  SentLight,
  Shown,
  Staged,
  TexturePixels,
  ToWorker,
} from './protocol';
import type {
  Command,
  ExportRequest,
  ExportView,
  LightAsk,
  LightView,
  PenStyle,
  PlantView,
  Refusal,
  SceneView,
  ShapeAnswer,
} from '../wire';

const page = self as unknown as DedicatedWorkerGlobalScope;
let session: StudioSession | undefined;
let stop: Int32Array | null = null;
let stale = false;
let scheduled = false;
const sent = new Set<number>();
/** Names of the meshes that the page has. */
let had = new Set<number>();

let toldShare = 0;
/** The share that was told when the coarse look was there: what follows is the rest. */
let lookShare = 0;
/** Large trees of this state were looked at. */
let looked = false;
// Looked at by the evaluation between its steps; it says how far it is.
(globalThis as { burgeonStop?: (share: number) => boolean }).burgeonStop = (share) => {
  const whole = lookShare + (1 - lookShare) * share;
  if (share > 0 && whole > toldShare + 0.01) {
    toldShare = whole;
    tell({ kind: 'progress', share: whole });
  }
  return stop !== null && Atomics.load(stop, 0) !== 0;
};

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  page.postMessage(message, transfer);
}

const words = (e: unknown): string => (e instanceof Error ? e.message : String(e));

/** What the core refuses it throws as the JSON of a `Refusal`; all else is a bug. */
function refusal(e: unknown): Refusal {
  if (typeof e === 'string') return JSON.parse(e);
  return { code: 'internal', fields: { why: words(e) }, message: words(e) };
}

/** After a trap the memory of the session is not to be trusted: the page starts another worker. */
function fault(e: unknown): void {
  session = undefined;
  tell({ kind: 'fault', why: words(e) });
}

/** The pen of a stroke as the core reads it. */
const penOf = ({ pen }: { pen?: PenStyle }): string => (pen ? JSON.stringify(pen) : '');

/** Does several things as one step of undo, or none of them. */
function together<T>(s: StudioSession, name: string, act: () => T): T {
  s.begin(name);
  try {
    const value = act();
    s.commit();
    return value;
  } catch (e) {
    s.abandon();
    throw e;
  }
}

/** Replaces what the open gesture did by commands, of which some may not be for their plant. */
function stage(s: StudioSession, commands: readonly Command[]): Staged {
  let [isStaged, failed]: [boolean, unknown] = [false, undefined];
  for (const command of commands) {
    const text = JSON.stringify(command);
    try {
      if (isStaged) s.run(text);
      else s.stage(text);
      isStaged = true;
    } catch (e) {
      // What is like that already needs nothing.
      if (refusal(e).code !== 'nothing-to-do') failed ??= e;
    }
  }
  if (failed === undefined) return {};
  if (!isStaged) throw failed;
  return { refused: refusal(failed) };
}

/** A stroke with its copies; then, as another step, what the hand meant by them. */
function drawn(s: StudioSession, request: InkRequest): number {
  const { mode, samples, copies = [], straight = [], shown = [] } = request;
  const add = (line: Float64Array, told: readonly Shown[]): number =>
    s.add_stroke(mode, line, penOf(request), JSON.stringify(told));
  const all = (): number[] => [add(samples, shown), ...copies.map((copy) => add(copy, []))];
  const ids = copies.length > 0 ? together(s, 'draw', all) : all();
  if (straight.length > 0)
    together(s, 'straighten', () => {
      for (const [i, line] of straight.entries()) if (i < ids.length) s.straighten(ids[i]!, line);
    });
  return ids[0]!;
}

function answer(s: StudioSession, request: Request): unknown {
  switch (request.kind) {
    case 'open':
      return JSON.parse(s.open(request.name, request.bytes, request.row, request.fresh));
    case 'stroke':
      return drawn(s, request);
    case 'select':
      return s.select(request.plant);
    case 'obstacle':
      return s.add_obstacle(request.name, request.bytes);
    case 'schema':
      return studioSchema();
    case 'command':
      return s.run(JSON.stringify(request.command));
    case 'action':
      return s.act(JSON.stringify(request.action));
    case 'begin':
      return s.begin(request.name);
    case 'stage':
      return stage(s, [request.command, ...(request.more ?? [])]);
    case 'commit':
      return s.commit();
    case 'abandon':
      return s.abandon();
    case 'undo':
      return s.undo();
    case 'redo':
      return s.redo();
    case 'draft':
      return s.draft(request.mode, request.samples, penOf(request));
    case 'save':
      return s.save();
    case 'load':
      sent.clear();
      had.clear();
      s.close();
      return replay(s, request.journal);
    case 'paste':
      return s.paste(request.text, request.x, request.y);
    case 'photo':
      return s.place_photo(request.png, request.x, request.y, request.width);
    case 'wear':
      return s.wear_picture(
        JSON.stringify(request.wearer),
        Uint32Array.from(request.strokes),
        JSON.stringify(request.material),
        request.png,
      );
    case 'swatch':
      return s.swatch(JSON.stringify(request.material), request.width, request.height);
    case 'copy':
      return s.copy(Uint32Array.from(request.ids));
    case 'skeleton':
      return s.skeleton();
    case 'shape':
      return JSON.parse(
        s.shape(JSON.stringify(request.tool), JSON.stringify(request.reach), JSON.stringify(request.input)),
      );
    case 'most':
      return s.set_most_triangles(request.triangles);
    case 'ready':
      return s.ready_levels(request.triangles);
    case 'branch':
      return s.branch(request.axis);
    case 'balls':
      return JSON.parse(s.balls());
    case 'held':
      return s.held_rows();
    case 'share':
      return s.share();
    case 'export':
      return s.export(JSON.stringify(request.request));
    case 'settle':
      return JSON.parse(settleExport(JSON.stringify(request.ask)));
    case 'printed':
      return JSON.parse(s.printed());
    case 'size':
      return JSON.parse(s.size(JSON.stringify(request.plants), JSON.stringify(request.goal)));
    case 'written':
      return JSON.parse(s.written());
    case 'weigh':
      return s.export(JSON.stringify(request.request)).length;
    case 'look':
      return lookAtExport(s, request.request, request.level);
    case 'light':
      return light(s, request.asked);
    case 'unlook':
      return s.end_preview();
    case 'variant': {
      const view: PlantView = JSON.parse(s.variant(request.seed, request.detail));
      try {
        return pack(s, view);
      } finally {
        s.end_variant();
      }
    }
  }
}

/** The same again. What is refused now was refused the first time too, but for the file that all else stands on. */
function replay(s: StudioSession, journal: readonly Request[]): void {
  journal.forEach((request, i) => {
    if ('placed' in request && request.placed !== undefined) s.place_next(request.placed);
    try {
      answer(s, request);
    } catch (e) {
      if (e instanceof WebAssembly.RuntimeError || (i === 0 && request.kind === 'open')) throw e;
    } finally {
      s.placed();
    }
  });
}

function tellState(s: StudioSession): void {
  const state = JSON.parse(s.state());
  const fresh = [...s.fresh_strokes()].map((id) => ({ id, points: s.stroke_points(id) }));
  const png = s.fresh_photo() as Uint8Array<ArrayBuffer>;
  const photo = png.length > 0 ? png : null;
  tell({ kind: 'state', state, fresh, photo }, [
    ...fresh.map((f) => f.points.buffer),
    ...(photo ? [photo.buffer] : []),
  ]);
}

/** Requests that change nothing and are not followed by a new plant. */
const QUIET: ReadonlySet<Request['kind']> = new Set([
  'save',
  'export',
  'settle',
  'printed',
  'size',
  'written',
  'weigh',
  'look',
  'light',
  'unlook',
  'begin',
  'copy',
  'swatch',
  'variant',
  'skeleton',
  'share',
  'schema',
  'branch',
  'balls',
  'held',
  'ready',
]);

/** Requests that change nothing of the document, but what is shown of it. */
const STATELESS: ReadonlySet<Request['kind']> = new Set(['draft', 'shape', 'most']);

/** Textures of these materials that the page does not have. */
function unsent(s: StudioSession, { materials }: PlantView): TexturePixels[] {
  const textures: TexturePixels[] = [];
  for (const texture of materials.flatMap(picturesOf)) {
    if (sent.has(texture.number)) continue;
    sent.add(texture.number);
    textures.push({ ...texture, pixels: s.texture(texture.number) });
  }
  return textures;
}

/** The columns of a model that stands in for the plants. */
const standInColumns = (s: StudioSession, model: number, { parts }: PlantView): ExportedArrays[] =>
  parts.map((_, part): ExportedArrays => {
    const [positions, normals, uvs, colors, wind, pivots] = [0, 1, 2, 3, 4, 5].map((c) =>
      s.exported_column(model, part, c),
    ) as [Float32Array, Float32Array, Float32Array, Float32Array, Float32Array, Float32Array];
    return { positions, normals, uvs, colors, wind, pivots, indices: s.exported_indices(model, part) };
  });

/** The columns of an export, which is written and counted. */
function lookAtExport(s: StudioSession, request: ExportRequest, level: number): SentExport {
  const view: ExportView = JSON.parse(s.preview_export(JSON.stringify(request), level));
  const models = view.models.map((seen, model) => standInColumns(s, model, seen));
  return { view, models, textures: view.models.flatMap((m) => unsent(s, m)) };
}

/** The plants in the colours of the light that they absorb. */
function light(s: StudioSession, asked: LightAsk): SentLight {
  const view: LightView = JSON.parse(s.light(JSON.stringify(asked)));
  const parts = standInColumns(s, 0, view.model);
  s.end_preview();
  return { view, parts };
}

/** The columns of what the session shows, and textures that the page does not have. */
function pack(s: StudioSession, view: PlantView): Sent {
  const { id, mesh } = view;
  const columns = (_: unknown, i: number): PartArrays => ({
    positions: s.positions(id, i),
    normals: s.normals(id, i),
    uvs: s.uvs(id, i),
    colors: s.colors(id, i),
    indices: s.indices(id, i),
  });
  const parts = mesh !== null && had.has(mesh) ? null : view.parts.map(columns);
  if (mesh !== null) had.add(mesh);
  const obstacles = view.obstacles.map(({ shape }, row) => (shape === 'mesh' ? s.obstacle(id, row) : null));
  return { view, parts, textures: unsent(s, view), obstacles };
}

const columnsOf = (parts: readonly PartArrays[]): Transferable[] =>
  parts.flatMap((p) => Object.values(p).map((c: Float32Array | Uint32Array) => c.buffer));

function buffers({ parts, textures, obstacles }: Sent): Transferable[] {
  return [
    ...obstacles.flatMap((o) => (o ? [o.buffer] : [])),
    ...columnsOf(parts ?? []),
    ...textures.map((x) => x.pixels.buffer),
  ];
}

/** What of an answer is given away and not copied. */
function given(kind: Request['kind'], value: unknown): Transferable[] {
  if (ArrayBuffer.isView(value)) return [value.buffer as ArrayBuffer];
  if (kind === 'variant') return buffers(value as Sent);
  if (kind === 'light') return columnsOf((value as SentLight).parts);
  if (kind !== 'look') return [];
  const { models, textures } = value as SentExport;
  return [...models.flatMap(columnsOf), ...textures.map((x) => x.pixels.buffer)];
}

/** Large trees, much coarser, before they are whole: whether there are any. Requests that come meanwhile go first. */
function look(s: StudioSession): boolean {
  looked = true;
  [toldShare, lookShare] = [0, 0];
  const views: PlantView[] = JSON.parse(s.preview_trees());
  lookShare = toldShare;
  const fresh = views.map((view) => pack(s, view));
  if (fresh.length > 0) tell({ kind: 'coarse', fresh }, fresh.flatMap(buffers));
  return fresh.length > 0;
}

function evaluate(): void {
  scheduled = false;
  if (!session || !stale) return;
  try {
    if (!looked && look(session)) {
      scheduled = true;
      setTimeout(evaluate, 0);
      return;
    }
    stale = false;
    const view: SceneView = JSON.parse(session.evaluate());
    const s = session;
    const all = view.guest ? [view.guest, ...view.plants] : view.plants;
    // The core and the page forget pictures that nothing shows.
    const shown = texturesOf(all);
    for (const number of sent) if (!shown.has(number)) sent.delete(number);
    const fresh = all.filter((p) => p.fresh).map((p) => pack(s, p));
    had = new Set(all.flatMap(({ mesh }) => (mesh === null ? [] : [mesh])));
    tell({ kind: 'view', view, fresh }, fresh.flatMap(buffers));
    setTimeout(measure, 0);
  } catch (e) {
    if (e instanceof WebAssembly.RuntimeError || e instanceof RangeError) fault(e);
    else {
      const why = refusal(e);
      stale = why.code === 'cancelled';
      tell({ kind: 'failed', why });
    }
  }
}

/** What the evaluation left for later, once nothing else is to do. */
function measure(): void {
  if (!session || stale || scheduled) return;
  try {
    const later = session.measure();
    if (later) tell({ kind: 'view', view: JSON.parse(later), fresh: [] });
  } catch (e) {
    // What comes next is evaluated and measured anew.
    if (e instanceof WebAssembly.RuntimeError || e instanceof RangeError) fault(e);
  }
}

/** Requests that wait already go first: only the latest state is grown. */
function schedule(): void {
  stale = true;
  looked = false;
  if (!scheduled) {
    scheduled = true;
    setTimeout(evaluate, 0);
    tell({ kind: 'busy' });
  }
}

async function start(message: Extract<ToWorker, { kind: 'start' }>): Promise<void> {
  stop = message.stop;
  await init({ module_or_path: message.wasm });
  const s = new StudioSession();
  replay(s, message.journal);
  session = s;
  tell({ kind: 'ready' });
  tellState(s);
  if (!message.hold) schedule();
}

page.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.kind === 'start') {
    start(data).catch(fault);
    return;
  }
  if (stop) Atomics.store(stop, 0, 0);
  const { seq, request } = data;
  if (!session) {
    tell({ kind: 'refused', seq, why: refusal(new Error('the plant maker is not there')) });
    return;
  }
  try {
    const value = answer(session, request);
    const quiet = QUIET.has(request.kind) || (request.kind === 'shape' && !(value as ShapeAnswer).again);
    // The state first: what waits for the answer may look at it.
    if (!quiet && !STATELESS.has(request.kind)) tellState(session);
    tell({ kind: 'done', seq, value, placed: session.placed() }, given(request.kind, value));
    if (!quiet) schedule();
  } catch (e) {
    tell({ kind: 'refused', seq, why: refusal(e) });
    if (stale) schedule(); // stopped for a change that did not come
    if (e instanceof WebAssembly.RuntimeError || e instanceof RangeError) fault(e);
  }
};
