export type StrokeClass = "blade" | "corolla" | "axis" | "trunk_outline" | "crown" | "vein" | "disc" | "pot" | "ground"
  | "fruit" | "scribble" | "other";
export type StrokeMode = "parts" | "branch-contour" | "leaf-contour";
export type PetalColor = "pink" | "white" | "yellow" | "violet" | "red" | "orange" | "blue" | "magenta";
export interface SketchSpec {
  height_m: number | null; branch_depth: "paper" | "riesz"; leaf_depth: "paper" | "signed" | "drawn";
  flipped_flowers: number[]; pipe_exponent: number | null;
  taper: { s: number; alpha: number; m: number };
  fill: { contour_pull: number; bearer_pull: number; memory: number; density: number; tropism: number };
  relief: { petal_bend_a: number; petal_bend_b: number; petal_hollow: number; leaf_bend_a: number; leaf_bend_b: number;
    leaf_fold: number };
  phototropism: number; gravity: number;
}
export interface Skin { detail: number; sides: number; textures: boolean; petals: PetalColor | null; variation: number }
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type Vec3 = [number, number, number];
/** Commands that name no plant are for the one that is chosen. */
export type Command =
  | { do: "remove"; ids: number[] } | { do: "move"; ids: number[]; x: number; y: number }
  | { do: "class"; ids: number[]; class: StrokeClass | null } | { do: "mode"; ids: number[]; mode: StrokeMode }
  | { do: "color"; ids: number[]; color: [number, number, number] | null } | { do: "clear" } | { do: "new" }
  | { do: "duplicate"; ids: number[]; x: number; y: number }
  | { do: "photo"; x: number; y: number; width: number; opacity: number; paint: boolean } | { do: "photo-off" }
  | { do: "sketch"; spec: SketchSpec } | { do: "skin"; skin: Skin } | { do: "day"; day: number | null }
  | { do: "rename-scene"; name: string } | { do: "add"; maker: MakerWord; name: string; preset?: string }
  | { do: "duplicate-plant"; plant: number; by: Vec3 } | { do: "remove-plant"; plant: number }
  | { do: "rename"; plant: number; name: string } | { do: "seed"; seed: string } | { do: "lock"; on: boolean }
  | { do: "hide"; plant: number; on: boolean }
  | { do: "place"; plant: number; position: Vec3; yaw_deg: number; scale: number }
  | { do: "preset"; key: string } | { do: "tree"; path: string; value: Json }
  | { do: "obstacle"; name: string; shape: ObstacleShape; row?: number } | { do: "obstacle-off"; row: number }
  | { do: "leaf-of"; lender: number | null }
  | { do: "leaf"; settings: Json } | { do: "marks"; name: string; text: string }
  | { do: "flower"; settings: Json } | { do: "law"; text: string | null }
  | { do: "shape"; edit: HandEdit; row?: number } | { do: "shape-leave"; row: number; off: boolean }
  | { do: "shape-remove"; rows: number[] };
/** An edit by hand as `shape::HandEdit` writes it: the page passes it on. */
export type HandEdit = { op: string } & { [key: string]: Json };
export type MakerWord = "sketch" | "tree" | "leaf" | "flower";
/** A mesh is told by its size only. */
export type ObstacleShape = { shape: string } & { [key: string]: Json };
export interface StrokeState { id: number; mode: StrokeMode; class: StrokeClass | null; color: [number, number, number] | null }
export interface SketchState {
  sketch: SketchSpec; skin: Skin; strokes: StrokeState[]; photo: PhotoState | null; day: number | null; leaf: number | null;
}
export interface TreeState {
  preset: string | null; spec: { [key: string]: Json }; skin: Skin; leaf: number | null;
  obstacles: { name: string; shape: ObstacleShape }[];
}
export interface LeafState { file: string; text: string; settings: { [key: string]: Json } }
export interface FlowerState { settings: { [key: string]: Json }; law: string | null }
export interface PlantState {
  id: number; maker: MakerWord; name: string; seed: string; locked: boolean; hidden: boolean; position: Vec3;
  yaw_deg: number; scale: number; lends: boolean; edits: EditState[]; sketch: SketchState | null; tree: TreeState | null;
  leaf: LeafState | null; flower: FlowerState | null;
}
/** What kind of edit by hand; `off`: left out for now. */
export interface EditState { op: string; off: boolean }
export interface DocumentState {
  revision: number; undo: string | null; redo: string | null; steps: number; name: string; current: number | null;
  plants: PlantState[];
}
export interface PhotoState {
  x: number; y: number; width: number; height: number; opacity: number; paint: boolean; pixels: [number, number];
}
export interface ExportOptions { levels: number; up: "y" | "z"; unit: "m" | "cm" | "mm"; whole: boolean; wind?: boolean }
export interface Opened { kind: "project" | "drawing" | "model" | "leaf" | "tree" | "law"; name: string; names: string[]; warnings: string[] }
export interface StrokeReport { index: number; class: StrokeClass; organ: string; confidence: number; source?: string }
/** What became of the edit of a row; `code` is `done` or a word for why not. */
export interface EditReport {
  index: number; done: boolean; code: string; said: string;
  changed: { removed: number; added: number; moved: number; leaves_removed: number; leaves_added: number; by_likeness: boolean };
}
export interface Item {
  name: string; strokes: StrokeReport[];
  counts: { flowers: number | null; petals: number | null; leaves: number | null; branches: number | null; nodes: number | null; axes: number | null;
    vertices: number; triangles: number };
  timings_ms: { total: number } & Record<string, number>; fidelity: { reprojection_mean: number | null; reprojection_p95: number | null };
  digest: string; warnings: string[]; edits?: EditReport[]; growth?: { iterations: number } & Record<string, number | string>;
}
export interface MaterialView {
  name: string; kind: string; color: [number, number, number]; roughness: number; translucency: number; masked: boolean;
  two_sided: boolean; texture: { number: number; width: number; height: number } | null;
}
/** A plant as it is seen; `fresh` ones come with their meshes. */
export interface PlantView {
  id: number; fresh: boolean; error: string | null; item: Item | null; stages: string[];
  front: { metres_per_unit: number; x: number; y: number } | null; days: [number, number] | null; min: Vec3; max: Vec3;
  parts: { name: string; material: number }[]; materials: MaterialView[]; obstacles: ObstacleShape[];
}
export interface View { revision: number; guest: PlantView | null; plants: PlantView[] }
/** A tool in the hand, with its settings. Lengths in metres of the plant, angles in degrees. */
export type ShapeTool =
  | { tool: "pick" } | { tool: "rotate" } | { tool: "move" } | { tool: "prune"; whole: boolean } | { tool: "regrow" }
  | { tool: "sketch"; twigs: number; tilt_deg: number } | { tool: "brush"; radius_m: number; density: number }
  | { tool: "silhouette"; density: number; trim: boolean } | { tool: "leaves"; radius_m: number; keep: number };
/** A pointer in the plant's own coordinates. */
export interface ShapePointer { origin: Vec3; direction: Vec3; forward: Vec3; up: Vec3; pressure: number }
/** What the hand did; several moves at once, so that no point of a stroke is lost. */
export type ShapeInput =
  | { on: "down"; at: ShapePointer } | { on: "move"; at: ShapePointer[] } | { on: "up"; at: ShapePointer } | { on: "cancel" }
  | { on: "twist"; degrees: number } | { on: "brush"; radius_m: number; density: number };
/** How far beside a branch it is still meant: `metres + per_metre * distance`; `bearers`: or what bears it, so many up. */
export interface ShapeReach { metres: number; per_metre: number; bearers?: number }
export interface ShapeAnswer {
  /** The branch that is meant, how many it bears in all, whether nothing bears it, and a name for edits. */
  picked: { axis: number; at: number; point: Vec3; order: number; length_m: number; bears: number; stands: boolean; key: Json } | null;
  /** The edit of a gesture that ended: to be asked for as a command. */
  commit: HandEdit | null;
  /** A gesture is going on. */
  busy: boolean;
  /** What is shown of the plant is out of date. */
  again: boolean;
}
