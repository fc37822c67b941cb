// Made by `cargo xtask types` from the types of the crate. Change those instead.

/** What has no type of its own here. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** Changes made by an edit. */
export type Changed = {
  /** Branches added. */
  added: number;
  /** Branches that a mirror plane has on one side only: no wood bears them on the other, or an obstacle stands there. */
  alone?: number;
  /** Whether the branch was found by its likeness because its own key had changed. */
  by_likeness: boolean;
  /** Leaves added. */
  leaves_added: number;
  /** Leaves removed. */
  leaves_removed: number;
  /** Branches turned or moved, those borne included. */
  moved: number;
  /** Branches removed. */
  removed: number;
};

/** A measured value of a plant and its plausible bound (`docs/limits.md` has the table). */
export type CheckReport = {
  /** Advice for an implausible value. */
  advice: string;
  /** The plausible bound. */
  bound: number;
  /** The measured value, with its bound, as a sentence. */
  message: string;
  /** A stable word, such as `size-large`. */
  name: string;
  /** Whether the value is plausible. */
  ok: boolean;
  /** Meaning of an implausible value. */
  severity: SeverityWord;
  /** The plausible side of the bound. */
  side: SideWord;
  /** The measured value. */
  value: number;
};

/** Counts of a plant and its meshes; none where nothing was counted, such as the leaves of a model that was read. */
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

/** Outcome of one edit. */
export type EditReport = {
  /** Changes that it made; all 0 if it was not done. */
  changed: Changed;
  /** `done`, or a stable word for the reason why not. */
  code: string;
  /** Whether it was done. */
  done: boolean;
  /** Its place in the list, from 0. */
  index: number;
  /** The outcome in plain words. */
  said: string;
};

/** The program that an export is for. */
export type EngineReport = {
  /** Its word. */
  name: string;
  /** Settings that were made for it; in a report of the command as options. */
  set: string[];
};

/** Vertices and faces of a mesh. */
export type FaceCounts = {
  /** Faces. */
  faces: number;
  /** Vertices. */
  vertices: number;
};

/** Comparison of the model's front view with the drawing, measured both ways; distances are shares of the drawing's diagonal. */
export type FidelityReport = {
  /** The measured share of the drawing's ink, by length, 0 to 1: strokes that were left out were not measured. */
  compared: number | null;
  /** Mean distance from the model's axes and outlines to the ink: parts that the model shows and nobody drew. */
  excess_mean: number | null;
  /** Distance within which 95 % of the model's axes and outlines lie. */
  excess_p95: number | null;
  /** The area that filled contours (crowns, clusters) share with their filling, over the area of their union, 0 to 1. */
  overlap: number | null;
  /** Mean distance from the drawn lines to the model's lines and outlines. */
  reprojection_mean: number | null;
  /** Distance within which 95 % of the drawn lines lie. */
  reprojection_p95: number | null;
};

/** The part of a report about growth. */
export type GrowthReport = {
  /** Attraction points or markers of all cycles. */
  attractors: number;
  /** Number of these consumed. */
  consumed: number;
  /** Life cycles. */
  cycles: number;
  /** Vertices of the meshes, wood and leaves alike, that lie more than a millimetre inside an obstacle; none without an obstacle, or without a measurement. */
  inside_obstacle: number | null;
  /** Depth of the deepest vertex inside an obstacle, metres; 0 if there is none inside; none as above. */
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
  /** Number of these never reached. */
  unreachable: number;
};

/** One plant. */
export type ItemReport = {
  /** For `shape --list`: the branches that were asked for. */
  branches?: Json[];
  /** Checks of whether a person would accept it. */
  checks: CheckReport[];
  /** Numbers of things. */
  counts: Counts;
  /** Fingerprint of the plant: independent of platform and threads. */
  digest: string;
  /** For a plant that was edited by hand: the outcome of each edit, in their order. */
  edits?: EditReport[];
  /** Distance between the model's front view and the drawing. */
  fidelity: FidelityReport;
  /** For `grow`: figures of the growth. */
  growth?: 
    | GrowthReport
    | null;
  /** For `leaf`: veins, blade and how well they fit. */
  leaf?: 
    | LeafReport
    | null;
  /** Name of the drawing. */
  name: string;
  /** The file written; empty if none. */
  output: string;
  /** For a plant with axes: the measures that a botanist would take of it. */
  plant?: Json;
  /** For a drawing: at most three interpretations, the chosen one first, then the others, the best first. */
  readings?: ReadingReport[];
  /** Every stroke and its result. */
  strokes: StrokeReport[];
  /** Times of the stages. */
  timings_ms: TimingsMs;
  /** Warnings for the user. */
  warnings: string[];
};

/** The kind of plant that a drawing shows. */
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

/** Distances of measured points from the blade, millimetres. */
export type LeafFit = {
  /** Share of the points that the blade explains (within 2 mm): all of them for marks that it passes through. */
  explained: number;
  /** Largest distance. */
  max_mm: number;
  /** Distance within which 95 of 100 points lie. */
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
  /** Rings at which the vein's radius exceeds its radius of curvature. */
  crossing_rings: number | null;
  /** Distances of the measured points from the blade. */
  fit_error: LeafFit;
  /** Length of the midrib, millimetres. */
  length_mm: number;
  /** Rows of marks. */
  rows: number;
  /** For a scan: its findings. */
  scan?: 
    | ScanReport
    | null;
  /** `interpolate`, `approximate`, `bezier` or `nurbs`. */
  surface: string;
  /** Rings whose ball is inside its neighbours; none for plain rings. */
  swallowed_rings: number | null;
  /** Largest distance of a vein's centre line from the blade, millimetres. */
  vein_gap_mm: number | null;
  /** The veins' mesh; faces are quads (and triangles of caps). */
  veins: FaceCounts;
};

/** A level of detail. */
export type LevelView = {
  /** Their materials. */
  materials: MaterialView[];
  /** Its meshes. */
  parts: PartView[];
};

/** Appearance of a mesh. */
export type MaterialView = {
  /** Base colour: linear red, green, blue. */
  color: [number, number, number];
  /** Kind of surface: bark, leaf, petal, ... */
  kind: string;
  /** The texture has holes. */
  masked: boolean;
  /** Its name in files. */
  name: string;
  /** Row of the normals of its relief, in the form of glTF. */
  normal: number | null;
  /** Row of a picture in which red is occlusion and green is a factor of the roughness. */
  orm: number | null;
  /** Roughness, 0 to 1. */
  roughness: number;
  /** Row of its colour texture. */
  texture: number | null;
  /** Share of light that passes through, 0 to 1. */
  translucency: number;
  /** Visible from both sides. */
  two_sided: boolean;
};

/** One mesh. */
export type PartView = {
  /** Row of its material. */
  material: number;
  /** Its name in files. */
  name: string;
};

/** A made plant. */
export type PlantView = {
  /** Bud to full bloom, and from there to wilted, days; of what opens. */
  days: [number, number] | null;
  /** The program that its files are for, and what was set for it. */
  for: 
    | EngineReport
    | null;
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
  /** The species, if it comes with the program. */
  preset: string | null;
  /** The entry of the report. */
  report: ItemReport;
  /** Pictures, to which materials refer by row. */
  textures: TextureView[];
};

/** One interpretation of a whole drawing. */
export type ReadingReport = {
  /** The kind of plant; for several plants of different kinds that of the largest. */
  kind: Kind;
  /** Number of plants in it. */
  plants: number;
  /** Probability that it is right, 0 to 1; for several plants their mean. */
  score: number;
};

/** Reason why a request was refused, for a shell: a sentence in English, and the values for one in another language. */
export type Refusal = {
  /** Fields that are refusals themselves. */
  causes?: Record<string, Refusal>;
  /** A word in kebab-case that never changes its meaning. */
  code: string;
  /** Names and values, as people read them. */
  fields: Record<string, string>;
  /** The sentence in English. */
  message: string;
};

/** Findings of a scan. */
export type ScanReport = {
  /** Share of the blade that has a point within 2 mm; the rest are bridged holes. */
  covered: number;
  /** Points left out because their neighbours are far. */
  outliers: number;
  /** Length of the outline, millimetres. */
  outline_mm: number;
  /** Points read, without those that are not numbers. */
  points: number;
  /** Length of the stalk, millimetres; none if there is no stalk. */
  stalk_mm: number | null;
  /** Greatest width across the midrib, millimetres. */
  width_mm: number;
};

/** Meaning of a failed check. */
export type SeverityWord =
  | /** The result may be wrong. */
  "warning"
  | /** Nobody would accept the result. */
  "error";

/** The plausible side of a bound. */
export type SideWord =
  | /** The bound or more. */
  "at_least"
  | /** The bound or less. */
  "at_most";

/** One stroke. */
export type StrokeReport = {
  /** Its class. */
  class: string;
  /** Confidence in that class, 0 to 1: the classifier's share of it, also where a rule chose it; 1 where the user did. */
  confidence: number;
  /** Its index in the drawing, from 0. */
  index: number;
  /** The organ made of it. */
  organ: string;
  /** Source of the class: `user`, `classifier` or `rule:NAME` (`docs/strokes.md` lists the rules). */
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
  /** Measuring the fidelity of the plant to its drawing. */
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

/** Options of all makers. */
export type Asked = {
  /** How many times the usual limits may be exceeded, 1 to 4. */
  budget?: number | null;
  /** The program that a file `glb` is for, such as `unity`: packed, blown and named as its importer takes it. */
  engine?: string | null;
  /** Fields that replace those of the maker's spec. */
  fields?: Record<string, Json>;
  /** Files of the finest copy by their extensions: `glb`, `mtg`, `opf`. */
  files?: string[];
  /** Coarser copies to make as well, 0 to 6; by default none, or as many as the program wants. */
  lods?: number | null;
  /** Most megabytes of the file `glb`, 0.001 to 4000: textures become smaller first, then it becomes the first level of detail that fits. */
  megabytes?: number | null;
  /** Fields of the meshing. */
  skin?: SkinAsked;
  /** Most triangles of the finest copy, 100 or more: it becomes the first level of detail within it. */
  triangles?: number | null;
};

/** A flower on a day. */
export type FlowerAsked = {
  /** Options of all makers. */
  common?: Asked;
  /** The day: 0 is the bud; none for full bloom. */
  day?: number | null;
  /** A species. */
  preset?: string | null;
  /** The text of a TOML file. */
  toml?: string | null;
};

/** A leaf of numbers, or of the text of a file of marks or veins. */
export type LeafAsked = {
  /** Options of all makers. */
  common?: Asked;
  /** Its name. */
  name?: string | null;
  /** Marks (CSV) or a vein graph (JSON). */
  text?: string;
};

/** A drawing: a file's name with its extension, or points. */
export type SketchAsked = {
  /** Classes of strokes, by the number of the stroke. */
  classes?: Record<string, Json>;
  /** Options of all makers. */
  common?: Asked;
  /** The day, if its flowers open. */
  day?: number | null;
  /** Its name; the extension gives the format of a file. */
  name?: string;
};

/** Options of the meshing; missing ones have the usual values. */
export type SkinAsked = {
  /** Fields of its schema. */
  fields?: Record<string, Json>;
  /** Pixels along a side of the textures of bark, and along the length of those of leaves, 64 to 4096. */
  texture_size?: number | null;
  /** Whether there are columns for the effect of the wind on each vertex. */
  wind?: boolean | null;
};

/** A tree. */
export type TreeAsked = {
  /** Options of all makers. */
  common?: Asked;
  /** Diameter at breast height in metres to which it grows, in the same way. */
  dbh?: number | null;
  /** Height in metres to which it grows: it has the age at which it comes nearest, and is scaled by the rest. */
  height?: number | null;
  /** Height in metres to which the wood is scaled. */
  height_m?: number | null;
  /** A species. */
  preset?: string | null;
  /** The text of a TOML file. */
  toml?: string | null;
};
