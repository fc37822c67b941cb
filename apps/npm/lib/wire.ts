// Made by `cargo xtask types` from the types of the crate. Change those instead.

/** What has no type of its own here. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** What an edit changed. */
export type Changed = {
  /** Branches added. */
  added: number;
  /** Branches that a mirror plane has on one side only: nothing bears them on the other, or an obstacle stands there. */
  alone?: number;
  /** The branch was found by its likeness: its own key had changed. */
  by_likeness: boolean;
  /** Leaves added. */
  leaves_added: number;
  /** Leaves taken away. */
  leaves_removed: number;
  /** Branches turned or moved, those borne included. */
  moved: number;
  /** Branches taken away. */
  removed: number;
};

/** A measured value of a plant against what is plausible (`docs/limits.md` has the table). */
export type CheckReport = {
  /** What to do if it is not plausible. */
  advice: string;
  /** What is plausible. */
  bound: number;
  /** What was measured, with its bound, as a sentence. */
  message: string;
  /** A word that stays, such as `size-large`. */
  name: string;
  /** Whether the value is plausible. */
  ok: boolean;
  /** What it means if not. */
  severity: SeverityWord;
  /** On which side of the bound. */
  side: SideWord;
  /** What was measured. */
  value: number;
};

/** Numbers of things in a plant and its meshes; none of what was not counted, such as the leaves of a model that was read. */
export type Counts = {
  /** Axes of every kind. */
  axes: number | null;
  /** Trunks, branches, twigs and stems (not petioles, not roots). */
  branches: number | null;
  /** Flowers. */
  flowers: number | null;
  /** Leaves. */
  leaves: number | null;
  /** Nodes of all axes. */
  nodes: number | null;
  /** Petals. */
  petals: number | null;
  /** Mesh triangles. */
  triangles: number;
  /** Mesh vertices. */
  vertices: number;
};

/** What became of one edit. */
export type EditReport = {
  /** What it changed; all 0 if it was not done. */
  changed: Changed;
  /** `done`, or a stable word for why not. */
  code: string;
  /** Whether it was done. */
  done: boolean;
  /** Its place in the list, from 0. */
  index: number;
  /** In plain words. */
  said: string;
};

/** Vertices and faces of a mesh. */
export type FaceCounts = {
  /** Faces. */
  faces: number;
  /** Vertices. */
  vertices: number;
};

/** The model's front view against the drawing, measured both ways; distances are shares of the drawing's diagonal. */
export type FidelityReport = {
  /** The share of the drawing's ink that was measured, by length, 0 to 1: strokes that were left out were not. */
  compared: number | null;
  /** Mean distance from the model's axes and outlines to the ink: what the model shows and nobody drew. */
  excess_mean: number | null;
  /** 95 % of the model's axes and outlines are nearer than this. */
  excess_p95: number | null;
  /** The area that filled contours (crowns, clusters) share with what grew in them, over the area of either, 0 to 1. */
  overlap: number | null;
  /** Mean distance from the drawn lines to the model's lines and outlines. */
  reprojection_mean: number | null;
  /** 95 % of the drawn lines are nearer than this. */
  reprojection_p95: number | null;
};

/** The part of a report about growth. */
export type GrowthReport = {
  /** Attraction points or markers of all cycles. */
  attractors: number;
  /** Of these, consumed. */
  consumed: number;
  /** Life cycles. */
  cycles: number;
  /** Vertices of the meshes, wood and leaves alike, that lie more than a millimetre inside an obstacle; none where there is no obstacle, or nothing was measured. */
  inside_obstacle: number | null;
  /** How deep the deepest vertex lies inside an obstacle, metres; 0 where none does; none as above. */
  inside_obstacle_depth_m: number | null;
  /** Rounds, years or rewriting steps. */
  iterations: number;
  /** Leaves on the tree. */
  leaves_kept: number;
  /** Places for leaves. */
  leaves_placed: number;
  /** `competition`, `colonization`, `self-organizing`, `guided` or `lsystem`. */
  method: string;
  /** Joints of the skeleton. */
  nodes: number;
  /** Of these, never reached. */
  unreachable: number;
};

/** One plant. */
export type ItemReport = {
  /** Of `shape --list`: the branches that were asked for. */
  branches?: Json[];
  /** What was checked of it: whether a person would accept it. */
  checks: CheckReport[];
  /** Numbers of things. */
  counts: Counts;
  /** Fingerprint of the plant: independent of platform and threads. */
  digest: string;
  /** Of a plant that was edited by hand: what became of each edit, in their order. */
  edits?: EditReport[];
  /** How near the model's front view is to the drawing. */
  fidelity: FidelityReport;
  /** Of `grow`: what growth did. */
  growth?: 
    | GrowthReport
    | null;
  /** Of `leaf`: veins, blade and how well they fit. */
  leaf?: 
    | LeafReport
    | null;
  /** Name of the drawing. */
  name: string;
  /** The file that was written; empty if none. */
  output: string;
  /** Of a plant with axes: what a botanist would measure on it. */
  plant?: Json;
  /** Of a drawing: what it may show, at most three: what it was read as first, then the others, the best first. */
  readings?: ReadingReport[];
  /** Every stroke and what became of it. */
  strokes: StrokeReport[];
  /** Times of the stages. */
  timings_ms: TimingsMs;
  /** What was not as the user might expect. */
  warnings: string[];
};

/** What a drawing can show. */
export type Kind =
  | /** A flower on its stem, or its head alone. */
  "flower"
  | /** Several flowers of one plant, or a row of them. */
  "flowers"
  | /** A stem with leaves. */
  "stem"
  | /** A tree: a trunk and a crown, or bare branches. */
  "tree"
  | /** A tree with a pointed crown. */
  "conifer"
  | /** Fronds at the top of a trunk. */
  "palm"
  | /** A crown on the ground. */
  "bush"
  | /** A thick body with arms or thorns. */
  "cactus"
  | /** Blades from the ground. */
  "grass"
  | /** One leaf. */
  "leaf"
  | /** A fruit. */
  "fruit"
  | /** A plant in a pot. */
  "house_plant"
  | /** A root, tuber, pod or bulb. */
  "vegetable"
  | /** Nothing that was recognised. */
  "none";

/** How far measured points are from the blade, millimetres. */
export type LeafFit = {
  /** Share of the points that the blade explains (within 2 mm): all of them for marks that it passes through. */
  explained: number;
  /** The farthest. */
  max_mm: number;
  /** 95 of 100 points are nearer. */
  p95_mm: number;
  /** Root of the mean square. */
  rms_mm: number;
};

/** The part of a report about a leaf. */
export type LeafReport = {
  /** Area of the blade's mesh, square millimetres. */
  area_mm2: number;
  /** The blade's mesh; faces are quads. */
  blade: FaceCounts;
  /** Rings at which a vein is thicker than it bends. */
  crossing_rings: number | null;
  /** Distances of what was measured from the blade. */
  fit_error: LeafFit;
  /** Length of the midrib, millimetres. */
  length_mm: number;
  /** Rows of marks. */
  rows: number;
  /** Of a scan: what was found in it. */
  scan?: 
    | ScanReport
    | null;
  /** `interpolate`, `approximate`, `bezier` or `nurbs`. */
  surface: string;
  /** Rings whose ball is inside its neighbours; none for plain rings. */
  swallowed_rings: number | null;
  /** The farthest that a vein's centre line is from the blade, millimetres. */
  vein_gap_mm: number | null;
  /** The veins' mesh; faces are quads (and triangles of caps). */
  veins: FaceCounts;
};

/** A level of detail. */
export type LevelView = {
  /** What they are made of. */
  materials: MaterialView[];
  /** Its meshes. */
  parts: PartView[];
};

/** How a mesh looks. */
export type MaterialView = {
  /** Linear red, green, blue. */
  color: [number, number, number];
  /** What it is of: bark, leaf, petal, ... */
  kind: string;
  /** The texture has holes. */
  masked: boolean;
  /** Its name in files. */
  name: string;
  /** Row of the normals of its relief, as glTF has them. */
  normal: number | null;
  /** Row of a picture in which red is occlusion and green is multiplied with the roughness. */
  orm: number | null;
  /** 0 to 1. */
  roughness: number;
  /** Row of its picture. */
  texture: number | null;
  /** 0 to 1. */
  translucency: number;
  /** Seen from both sides. */
  two_sided: boolean;
};

/** One mesh. */
export type PartView = {
  /** Row of its material. */
  material: number;
  /** Its name in files. */
  name: string;
};

/** A plant as it was made. */
export type PlantView = {
  /** Bud to full bloom, and from there to wilted, days; of what opens. */
  days: [number, number] | null;
  /** Levels of detail, the finest first. */
  levels: LevelView[];
  /** `tree`, `sketch`, `leaf` or `flower`. */
  maker: string;
  /** Upper corner of its bounds, metres. */
  max: [number, number, number];
  /** Lower corner of its bounds, metres. */
  min: [number, number, number];
  /** Its name in files. */
  name: string;
  /** The species, where it is one that comes with the program. */
  preset: string | null;
  /** The entry of the report. */
  report: ItemReport;
  /** Pictures; materials name them by row. */
  textures: TextureView[];
};

/** One interpretation of a whole drawing. */
export type ReadingReport = {
  /** The kind of plant; of several plants of different kinds that of the largest. */
  kind: Kind;
  /** How many plants it would show. */
  plants: number;
  /** How likely it is right, 0 to 1; of several plants their mean. */
  score: number;
};

/** Why something was not done, for a shell: words for people in English, and what another language needs for its own. */
export type Refusal = {
  /** Those of the fields that are refusals themselves. */
  causes?: Record<string, Refusal>;
  /** A word in kebab-case that never changes its meaning. */
  code: string;
  /** Names and values, as people read them. */
  fields: Record<string, string>;
  /** The sentence in English. */
  message: string;
};

/** What was found in a scan. */
export type ScanReport = {
  /** Share of the blade that has a point within 2 mm; the rest are holes that were bridged. */
  covered: number;
  /** Points left out because their neighbours are far. */
  outliers: number;
  /** Length of the outline, millimetres. */
  outline_mm: number;
  /** Points read, without those that are no numbers. */
  points: number;
  /** Length of the stalk, millimetres; none if there is no stalk. */
  stalk_mm: number | null;
  /** Greatest width across the midrib, millimetres. */
  width_mm: number;
};

/** What a check that fails means. */
export type SeverityWord =
  | /** The result may be wrong. */
  "warning"
  | /** Nobody would accept the result. */
  "error";

/** Which side of a bound is plausible. */
export type SideWord =
  | /** The bound or more. */
  "at_least"
  | /** The bound or less. */
  "at_most";

/** One stroke. */
export type StrokeReport = {
  /** What it is. */
  class: string;
  /** How sure that class is, 0 to 1: the classifier's share of it, also where a rule chose it; 1 where the user did. */
  confidence: number;
  /** Its index in the drawing, from 0. */
  index: number;
  /** What became of it. */
  organ: string;
  /** What decided the class: `user`, `classifier` or `rule:NAME` (`docs/strokes.md` lists the rules). */
  source?: string;
};

/** A picture. */
export type TextureView = {
  /** Pixels down. */
  height: number;
  /** Pixels across. */
  width: number;
};

/** Milliseconds of each stage. */
export type TimingsMs = {
  /** Stroke classes. */
  classify: number;
  /** Filling, depth, radii. */
  depth: number;
  /** Measuring how true the plant is to its drawing. */
  fidelity: number;
  /** Measures and digest of the plant. */
  measure: number;
  /** Skinning. */
  mesh: number;
  /** Drawing the picture. */
  picture: number;
  /** Resampling and smoothing. */
  preprocess: number;
  /** Reading the file. */
  read: number;
  /** Hierarchy, flowers, attachment. */
  structure: number;
  /** From the command's start to its last file but the report: reading, computing, pictures and writing. */
  total: number;
  /** Writing the model. */
  write: number;
};

/** What all makers are asked for. */
export type Asked = {
  /** How many times the usual limits may be exceeded, 1 to 4. */
  budget?: number | null;
  /** Fields of the maker's spec in the place of its own. */
  fields?: Record<string, Json>;
  /** Files of the finest copy by their extensions: `glb`, `mtg`, `opf`. */
  files?: string[];
  /** Coarser copies to make as well, 0 to 6. */
  lods?: number;
  /** Fields of how it is meshed. */
  skin?: SkinAsked;
};

/** A flower on a day. */
export type FlowerAsked = {
  /** What all makers are asked for. */
  common?: Asked;
  /** 0 is the bud; none for full bloom. */
  day?: number | null;
  /** A species. */
  preset?: string | null;
  /** The text of a TOML file. */
  toml?: string | null;
};

/** A leaf of numbers, or of the text of a file of marks or veins. */
export type LeafAsked = {
  /** What all makers are asked for. */
  common?: Asked;
  /** Its name. */
  name?: string | null;
  /** Marks (CSV) or a vein graph (JSON). */
  text?: string;
};

/** A drawing: a file's name with its extension, or points. */
export type SketchAsked = {
  /** What strokes are, by number. */
  classes?: Record<string, Json>;
  /** What all makers are asked for. */
  common?: Asked;
  /** Its flowers open: the day. */
  day?: number | null;
  /** Its name; the extension tells the format of a file. */
  name?: string;
};

/** How a plant is meshed; what is left out is as usual. */
export type SkinAsked = {
  /** The fields of its schema. */
  fields?: Record<string, Json>;
  /** Pixels of a side of the textures of bark, and of the length of those of leaves, 64 to 4096. */
  texture_size?: number | null;
  /** Columns that say how wind moves each vertex. */
  wind?: boolean | null;
};

/** A tree. */
export type TreeAsked = {
  /** What all makers are asked for. */
  common?: Asked;
  /** Scales the wood to this height, metres. */
  height_m?: number | null;
  /** A species. */
  preset?: string | null;
  /** The text of a TOML file. */
  toml?: string | null;
};
