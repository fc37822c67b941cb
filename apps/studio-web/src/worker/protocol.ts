/** What page and worker say to one another. Meshes and strokes travel as typed arrays, never as JSON. */
import type {
  Action,
  Command,
  DocumentState,
  EngineAsk,
  ExportRequest,
  ExportView,
  LightAsk,
  LightView,
  MaterialView,
  OrganMaterial,
  PenStyle,
  PlantView,
  Refusal,
  SceneView,
  ShapeInput,
  ShapeReach,
  SizeGoal,
  StrokeClass,
  StrokeMode,
  TextureView,
  ToolKind,
  Wearer,
} from '../wire';

/** Where a request put the plant that it added: a replay puts it there again, without growing the others. */
interface Placing {
  placed?: number;
}

/** What a stroke was clearly shown as when another was drawn; nothing where that was not clear. */
export type Shown = [stroke: number, as: StrokeClass | null];

/** A stroke that was drawn: rows of x, y, milliseconds, pressure. */
export interface InkRequest {
  kind: 'stroke';
  mode: StrokeMode;
  samples: Float64Array;
  /** The same stroke elsewhere, by the symmetry of the sheet: one step of undo with it. */
  copies?: readonly Float64Array[];
  /** Stroke and copies as what the hand meant by them, a step of undo after what it drew. */
  straight?: readonly Float64Array[];
  pen?: PenStyle;
  shown?: Shown[];
}

/** What the page asks. Those that change the document are kept in the page's journal. */
export type Request =
  | ({ kind: 'open'; name: string; bytes: Uint8Array; row: number; fresh: boolean } & Placing)
  | InkRequest
  | { kind: 'command'; command: Command }
  /** What is more than one command. */
  | ({ kind: 'action'; action: Action } & Placing)
  | { kind: 'begin'; name: string }
  /** `more`: of other plants, in the same step. */
  | { kind: 'stage'; command: Command; more?: readonly Command[] }
  /** Chooses the plant that requests without a plant are for. */
  | { kind: 'select'; plant: number }
  /** A model file as an obstacle of the chosen tree. */
  | { kind: 'obstacle'; name: string; bytes: Uint8Array }
  /** What can be set of each maker. */
  | { kind: 'schema' }
  | { kind: 'commit' }
  | { kind: 'abandon' }
  | { kind: 'undo' }
  | { kind: 'redo' }
  /** Forgets everything, and does what was asked of another document. */
  | { kind: 'load'; journal: readonly Request[] }
  | { kind: 'paste'; text: string; x: number; y: number }
  | { kind: 'photo'; png: Uint8Array; x: number; y: number; width: number }
  /** A material with a picture (PNG) for strokes, or without any for all organs of a kind. */
  | { kind: 'wear'; wearer: Wearer; strokes: number[]; material: OrganMaterial; png: Uint8Array }
  /** RGBA pixels of a petal in a material. */
  | { kind: 'swatch'; material: OrganMaterial; width: number; height: number }
  | { kind: 'copy'; ids: number[] }
  | { kind: 'variant'; seed: string; detail: number }
  | { kind: 'skeleton' }
  | { kind: 'share' }
  /** A tool that shapes the chosen plant: what it would do is shown, what it did comes back as an edit. */
  | { kind: 'shape'; tool: ToolKind; reach: ShapeReach; input: ShapeInput }
  /** Shows at most so many triangles of all plants, the largest coarser; 0: all. */
  | { kind: 'most'; triangles: number }
  /** Makes what that would show, before it is wished for. */
  | { kind: 'ready'; triangles: number }
  /** The branch of a pick with all that it bears. */
  | { kind: 'branch'; axis: number }
  /** The control balls of the chosen leaf: `LeafBalls`. */
  | { kind: 'balls' }
  /** Triangles of the meshes that the hand carries: part, first, and the one after the last, of each range. */
  | { kind: 'held' }
  | { kind: 'draft'; mode: StrokeMode; samples: Float64Array; pen?: PenStyle }
  | { kind: 'save' }
  | { kind: 'export'; request: ExportRequest }
  /** What a program wants of an export: `EngineAnswer`. */
  | { kind: 'settle'; ask: EngineAsk }
  /** The last body for a printer: `PrintFigures`, or null. */
  | { kind: 'printed' }
  /** What gives plants a size: a list of `Command`. */
  | { kind: 'size'; plants: readonly number[]; goal: SizeGoal }
  /** What the last export of models wrote: `WrittenFigures`, or null. */
  | { kind: 'written' }
  /** How many bytes an export would write: a number. It is written and thrown away. */
  | { kind: 'weigh'; request: ExportRequest }
  /** What an export would write of one level of detail, to be seen: `SentExport`. */
  | { kind: 'look'; request: ExportRequest; level: number }
  /** The light that all plants absorb, and they in its colours: `SentLight`. */
  | { kind: 'light'; asked: LightAsk }
  /** It is no longer looked at. */
  | { kind: 'unlook' };

export type ToWorker =
  | { kind: 'start'; wasm: string; stop: Int32Array | null; journal: readonly Request[]; hold: boolean }
  | { kind: 'ask'; seq: number; request: Request };

export interface PartArrays {
  positions: Float32Array;
  normals: Float32Array;
  uvs: Float32Array;
  colors: Float32Array;
  indices: Uint32Array;
}

export interface TexturePixels {
  number: number;
  width: number;
  height: number;
  pixels: Uint8Array;
}

/** Points of a stroke: x, y (up), pressure (NaN where not known). */
export interface StrokePoints {
  id: number;
  points: Float64Array;
}

/** A plant as it travels. */
export interface Sent {
  view: PlantView;
  /** None where the page has them already: the plant is a copy. */
  parts: PartArrays[] | null;
  textures: TexturePixels[];
  /** Corners of obstacles that are meshes. */
  obstacles: (Float32Array | null)[];
}

/** The meshes of an export: how wind moves each vertex, too, where it is written. */
export interface ExportedArrays extends PartArrays {
  wind: Float32Array;
  pivots: Float32Array;
}

/** An export as it travels. */
export interface SentExport {
  view: ExportView;
  /** Those of each model. */
  models: ExportedArrays[][];
  textures: TexturePixels[];
}

/** The plants in the colours of light, as they travel. */
export interface SentLight {
  view: LightView;
  parts: ExportedArrays[];
}

/** What became of a stage of several commands: why one of them was not done, if so. */
export interface Staged {
  refused?: Refusal;
}

export type FromWorker =
  | { kind: 'ready' }
  | { kind: 'done'; seq: number; value: unknown; placed: number | undefined }
  | { kind: 'refused'; seq: number; why: Refusal }
  | { kind: 'state'; state: DocumentState; fresh: StrokePoints[]; photo: Uint8Array<ArrayBuffer> | null }
  /** `fresh`: the plants whose meshes changed. */
  | { kind: 'view'; view: SceneView; fresh: Sent[] }
  /** Large trees that are still being made, much coarser: looks, in no view. */
  | { kind: 'coarse'; fresh: Sent[] }
  | { kind: 'busy' }
  /** The share of an evaluation that is done. */
  | { kind: 'progress'; share: number }
  | { kind: 'failed'; why: Refusal }
  | { kind: 'fault'; why: string };

/** The pictures of a material: colour, normals, occlusion and roughness. */
export function picturesOf({ texture, normal, orm }: MaterialView): TextureView[] {
  return [texture, normal, orm].filter((t) => t !== null);
}

/** Numbers of the textures that these plants are shown with. */
export function texturesOf(plants: readonly PlantView[]): Set<number> {
  return new Set(plants.flatMap((p) => p.materials.flatMap(picturesOf).map((t) => t.number)));
}
