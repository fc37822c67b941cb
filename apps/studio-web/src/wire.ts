// Made by `cargo xtask types` from the types of the crate `workspace`. Change those instead.

/** What has no type of its own here: the page passes it on. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** Every code of a `Refusal`, with its fields. */
export const CODES = {
  "age-beyond": ["name", "end", "age"],
  "archive": ["why"],
  "assembly-levels": [],
  "ball-none": ["row", "mark", "rows"],
  "cancelled": [],
  "class-without-stroke": ["index"],
  "clear-without-sun": [],
  "direct-without-sun": [],
  "edit-at-fault": ["row", "why"],
  "engine-file": ["wanted", "given"],
  "field-range": ["field", "range", "value"],
  "file-empty": [],
  "file-io": ["why"],
  "file-item": ["item", "why"],
  "file-line": ["line", "why"],
  "file-malformed": ["what"],
  "file-no-strokes": [],
  "file-not-utf8": ["after"],
  "file-refused": ["why"],
  "file-too-much": ["what", "limit"],
  "file-truncated": ["inside"],
  "file-unsupported": ["what"],
  "foreign-e57": [],
  "foreign-excalidraw": [],
  "foreign-gzip": [],
  "foreign-krita": [],
  "foreign-pdf": [],
  "foreign-photoshop": [],
  "foreign-picture": ["kind"],
  "foreign-procreate": [],
  "foreign-project": [],
  "foreign-tldraw": [],
  "foreign-zip": [],
  "full": ["what"],
  "gesture": [],
  "girth-reach": ["wanted", "least", "most"],
  "graph-edge": ["edge", "node", "last"],
  "graph-node": ["node"],
  "graph-one-sided": [],
  "graph-radii": ["nodes", "radii"],
  "graph-small": ["nodes"],
  "growth-light": ["why"],
  "height-low": [],
  "height-obstacles": [],
  "height-reach": ["wanted", "least", "most"],
  "internal": ["why"],
  "json-ends": [],
  "law": ["why"],
  "layer-closed": ["layer"],
  "layer-name": [],
  "leaf-scan": ["why"],
  "leaf-surface": ["why"],
  "leaf-veins": ["why"],
  "least-megabytes": ["least"],
  "least-triangles": ["least"],
  "lender-without-leaf": ["name"],
  "light-crowded": ["surfaces", "crossings", "most"],
  "light-empty": [],
  "light-far": ["triangle", "most_m"],
  "lsystem-line": ["line", "why"],
  "lsystem-no-axiom": [],
  "lsystem-no-match": ["there", "rules"],
  "lsystem-not-finite": ["rule", "line"],
  "lsystem-too-large": ["rule", "line", "step", "made", "most"],
  "margin-apart": [],
  "margin-crosses": ["times"],
  "margin-few": ["points"],
  "margin-not-finite": ["point"],
  "marks-few": ["rows"],
  "marks-not-finite": ["row", "mark"],
  "marks-one-point": ["row"],
  "marks-same-row": ["row", "next"],
  "marks-thickness": ["row", "mark", "value"],
  "marks-tip": [],
  "mesh": ["why"],
  "mesh-empty": [],
  "mesh-index": ["triangle", "vertex", "vertices"],
  "mesh-vertex": ["vertex"],
  "message": ["why"],
  "no-assembly": ["why"],
  "no-branches": ["maker"],
  "no-clipboard": [],
  "no-drawing": [],
  "no-flowers": ["name"],
  "no-girth": [],
  "no-leaf-to-lend": [],
  "no-leaves": [],
  "no-light": [],
  "no-petal-colour": ["word", "known"],
  "no-photo": [],
  "no-picture": [],
  "no-plant": [],
  "no-print": ["why"],
  "no-room": ["found", "wanted"],
  "no-roots": [],
  "no-species": ["name"],
  "no-stroke": [],
  "no-strokes": ["name"],
  "no-such-export": ["format"],
  "no-such-plant": ["plant"],
  "no-such-stroke": ["stroke"],
  "no-sunrise": [],
  "no-surface": [],
  "no-tree": ["name"],
  "no-usable-stroke": [],
  "not-json": [],
  "not-text": ["why"],
  "nothing-grew": ["why"],
  "nothing-made": [],
  "nothing-to-do": [],
  "nothing-to-shape": [],
  "nowhere-to-stand": [],
  "obstacle": ["name", "why"],
  "obstacle-file": [],
  "obstacle-not-finite": [],
  "other-maker": ["wanted", "found"],
  "over-budget": ["what", "number", "limit"],
  "photo-not-png": [],
  "photo-too-far": [],
  "photo-too-large": [],
  "picture-not-png": [],
  "picture-too-large": [],
  "place-locked": [],
  "place-too-far": [],
  "plant-gone": [],
  "plant-not-made": ["name"],
  "prints-one": [],
  "project-archive": ["why"],
  "project-json": ["entry", "why"],
  "project-missing": ["name"],
  "project-scene": ["why"],
  "project-setting": ["why"],
  "project-stroke": ["row", "why"],
  "project-too-much": ["what", "limit"],
  "project-version": ["found"],
  "record": ["why"],
  "record-form": ["form"],
  "record-keeps": [],
  "record-long": ["most"],
  "record-numbers": [],
  "record-project": [],
  "root-far": ["root"],
  "root-in-obstacle": ["root", "obstacle", "name"],
  "rule-call": ["name", "numbers"],
  "rule-chance": ["value"],
  "rule-ends": [],
  "rule-left-over": ["text"],
  "rule-no-arrow": ["text"],
  "rule-no-module": ["mark"],
  "rule-no-name": ["name"],
  "rule-no-number": ["text"],
  "rule-no-operand": ["mark"],
  "rule-no-predecessor": [],
  "rule-no-setting": ["name"],
  "rule-no-statement": [],
  "rule-not-called": ["name"],
  "rule-not-closed": ["mark"],
  "rule-not-finite": ["text"],
  "rule-not-opened": [],
  "rule-not-rewritten": ["text"],
  "rule-parameters": ["names", "most"],
  "rule-quantiles": ["count", "most"],
  "rule-range": ["name", "least", "most", "value"],
  "rule-too-deep": ["most"],
  "rule-tropism-direction": [],
  "rule-tropism-numbers": [],
  "rule-tropism-strength": [],
  "rule-unknown": ["name"],
  "scan-several": ["blades"],
  "scan-surface": ["why"],
  "scan-too-few": ["points"],
  "scan-too-many": ["points", "most"],
  "scene-full": ["mb"],
  "slip": ["why"],
  "slip-at": ["line", "column", "what"],
  "spec-choice": ["path", "name", "choices"],
  "spec-kind": ["path", "found", "value", "wanted"],
  "spec-length": ["path", "found", "wanted"],
  "spec-missing": ["path", "name"],
  "spec-pointer": ["path"],
  "spec-syntax": ["line", "why"],
  "spec-text": ["path", "why"],
  "spec-unknown": ["path", "name"],
  "spline-degree": ["degree"],
  "spline-knots": [],
  "spline-not-finite": ["point"],
  "spline-parameters": [],
  "spline-radius": ["point"],
  "spline-ragged": ["points", "columns"],
  "spline-too-few": ["needed", "given"],
  "split-edited": ["name"],
  "split-no-drawing": [],
  "split-one-plant": ["name"],
  "step-too-long": ["step_m", "space_m"],
  "sun-below": ["elevation_deg"],
  "too-far": [],
  "too-many-edits": ["most"],
  "too-many-layers": ["most"],
  "too-many-obstacles": ["most"],
  "too-many-pictures": ["most"],
  "tree-file": ["file"],
  "tree-line": ["line", "why"],
  "unknown-file": [],
  "veins-ball-none": ["ray", "mark", "rays", "marks"],
  "veins-none": [],
  "veins-not-finite": ["ray", "mark"],
  "veins-repeated": ["ray", "mark"],
  "veins-thickness": ["ray", "mark", "value"],
  "veins-too-few": ["rays", "marks"],
  "veins-unequal": ["ray", "got", "wanted"],
  "write": ["why"],
} as const;

/** The formats that are written, by their words. */
export const FORMATS = {
  glb: {
    kind: "model",
    ending: "glb",
    type: "model/gltf-binary",
    about: "Binary glTF: one file with textures and materials",
    holds: ["parts", "textures", "translucence", "wind", "levels", "instances", "joints", "morphs", "packing"],
    zipped: false,
  },
  gltf: {
    kind: "model",
    ending: "gltf",
    type: "model/gltf+json",
    about: "glTF as text, with its buffer and textures beside it",
    holds: ["parts", "textures", "translucence", "wind", "levels", "instances", "joints", "morphs", "packing"],
    zipped: true,
  },
  obj: {
    kind: "model",
    ending: "obj",
    type: "model/obj",
    about: "Wavefront OBJ with its material file and textures beside it",
    holds: ["axes", "parts", "textures", "heights"],
    zipped: true,
  },
  ply: {
    kind: "model",
    ending: "ply",
    type: "application/octet-stream",
    about: "PLY: one mesh with colours",
    holds: ["axes"],
    zipped: false,
  },
  stl: {
    kind: "model",
    ending: "stl",
    type: "model/stl",
    about: "Stereolithography: bare triangles",
    holds: ["axes"],
    zipped: false,
  },
  usda: {
    kind: "model",
    ending: "usda",
    type: "model/vnd.usda",
    about: "Universal Scene Description as text, with textures beside it",
    holds: ["axes", "parts", "textures", "wind"],
    zipped: true,
  },
  usdz: {
    kind: "model",
    ending: "usdz",
    type: "model/vnd.usdz+zip",
    about: "Universal Scene Description with its textures in one file",
    holds: ["axes", "parts", "textures", "wind"],
    zipped: false,
  },
  mtg: {
    kind: "structure",
    ending: "mtg",
    type: "text/plain",
    about: "Multiscale tree graph: axes, nodes and organs as text",
    holds: ["axes"],
    zipped: false,
  },
  opf: {
    kind: "structure",
    ending: "opf",
    type: "application/xml",
    about: "Open Plant Format: axes, internodes and organs with their meshes",
    holds: ["axes", "organ-meshes"],
    zipped: false,
  },
  qsm: {
    kind: "structure",
    ending: "qsm.csv",
    type: "text/csv",
    about: "Quantitative structure model: a table of cylinders",
    holds: ["axes"],
    zipped: false,
  },
  swc: {
    kind: "structure",
    ending: "swc",
    type: "text/plain",
    about: "Skeleton: points with radii, each with the one that it grows from",
    holds: ["axes"],
    zipped: false,
  },
  svg: {
    kind: "drawing",
    ending: "svg",
    type: "image/svg+xml",
    about: "Scalable Vector Graphics; one drawing a file",
    holds: [],
    zipped: false,
  },
  json: {
    kind: "drawing",
    ending: "json",
    type: "application/json",
    about: "Our own `drawing/1`; one drawing a file",
    holds: [],
    zipped: false,
  },
} as const;

/** The programs that plants go to, by their words. */
export const ENGINES = {
  three: { about: "three.js and what stands on it: .glb, packed, with wind for a shader", endings: ["glb", "gltf"] },
  blender: { about: "Blender: .glb, plain, with wind as attributes", endings: ["glb", "gltf"] },
  unity: { about: "Unity by glTFast: .glb, levels and a collider in one file, with wind for a shader", endings: ["glb", "gltf"] },
  unreal: { about: "Unreal Engine: .usda, a skeleton with leaves on its joints (Nanite), or .glb, a static mesh with shapes for collisions", endings: ["usda", "glb", "gltf"] },
  godot: { about: "Godot 4: .glb with a shape for collisions, with wind for a shader; it makes levels itself", endings: ["glb", "gltf"] },
  isaac: { about: "Isaac Sim and other readers of USD: .usda or .usdz, metres, +Z up", endings: ["usda", "usdz", "physics.usda"] },
  print: { about: "A 3-D printer: one closed body as .stl or .ply, millimetres, +Z up, on a flat foot", endings: ["stl", "ply"] },
} as const;

/** Requests that take more than one [`document::Command`]. */
export type Action =
  | /** Replaces the document by an empty one. */
  "new"
  | /** Adds a plant next to the others and chooses it. */
  {
    add: {
      /** Its maker. */
      maker: NewMaker;
      /** Its name. */
      name: string;
    };
  }
  | /** Gives a tree or a flower another species. */
  {
    preset: {
      /** The key of the preset. */
      key: string;
      /** The plant. */
      plant: PlantId;
    };
  }
  | /** Splits a drawing of several plants into drawings of one plant each. */
  {
    split: {
      /** The drawing. */
      plant: PlantId;
    };
  }
  | /** Shows the scene again, not a model. */
  "close-model"
  | /** Copies of a plant in many places. */
  {
    scatter: Scatter;
  };

/** Names one axis of a plant. */
export type AxisKey =
  | /** Mark that a program remembers of a picked axis. */
  {
    mark: Mark;
  }
  | /** Path by number, as people write it into a file: the stem of the plant, its branch from the base up, and so on, all from 0. */
  {
    path: number[];
  }
  | /** The axis nearest to this point, metres. */
  {
    near: [number, number, number];
  };

/** One control ball moved and rescaled: the position of a mark and the thickness of the veins there. */
export type BallMove = {
  /** Offset to the right as seen on the upper side with the tip up, towards the tip, and off the upper side; metres, -10 to 10. */
  by_m: [number, number, number];
  /** Mark of the row from the right margin, 1 to 7, where 4 is on the midrib; for chief veins the mark from the base. */
  mark: number;
  /** Row of marks from the tip down, from 1, or 0 for the tip; for chief veins the vein from the right margin, from 1. */
  row: number;
  /** Factor on the thickness of the veins there, 0.05 to 20, default 1. */
  thickness: number;
};

/** How the depth of branches is found (He and Cheng 2021, section 5.2). */
export type BranchDepth =
  | /** Eq 4 as printed: the sum of the angles between siblings. */
  "paper"
  | /** Riesz energy of the angles: siblings spread evenly (the sum cannot tell even from two clumps). */
  "riesz";

/** A stroke of a brush in space: buds find room only inside it, and are drawn along it (the VR paper). */
export type BrushStroke = {
  /** Its course, metres, at least two points. */
  points: [number, number, number][];
  /** Pull along the stroke, `k_s`, 0 to 10; default 1. */
  pull: number;
  /** Radius, metres, above 0: one number, or one for each point. */
  radius_m: number[];
};

/** Rigid motion of a branch and all that it bears: `p -> to + turn (p - from)`, metres of the plant. */
export type CarriedPose = {
  /** Base of the branch before. */
  from: [number, number, number];
  /** Name of the meshes that [`Workspace::held_rows`](crate::Workspace::held_rows) refers to. */
  mesh: number;
  /** Base of the branch now. */
  to: [number, number, number];
  /** Rotation, a unit quaternion: x, y, z, w. */
  turn: [number, number, number, number];
};

/** A common movement of plants: scaled and turned about a point, then moved. */
export type Carry = {
  /** Fixed point of the scaling and turning, metres. */
  about: [number, number, number];
  /** Offset, metres. */
  by: [number, number, number];
  /** Factor on their size, above 0. */
  scale: number;
  /** Turn about +Y, degrees, counter-clockwise seen from above. */
  turn_deg: number;
};

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

/** An sRGB colour, written `#rrggbb`. */
export type Colour = string;

/** A command on a document: on the scene, on any plant, or on a plant of one maker. */
export type Command =
  | /** Adds, removes and moves plants. */
  {
    scene: SceneCommand;
  }
  | /** Name, seed and place of a plant. */
  {
    plant: [PlantId, PlantCommand];
  }
  | /** Hand edits of a plant with branches. */
  {
    shape: [PlantId, ShapeCommand];
  }
  | /** Strokes and settings of a sketch. */
  {
    sketch: [PlantId, SketchCommand];
  }
  | /** Spec and obstacles of a tree. */
  {
    tree: [PlantId, TreeCommand];
  }
  | /** Marks and surface of a leaf. */
  {
    leaf: [PlantId, LeafCommand];
  }
  | /** Species and day of a flower. */
  {
    flower: [PlantId, FlowerCommand];
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

/** Destination of a moved branch. */
export type Destination =
  | /** Along its bearer by this distance in metres, towards the tip if positive; it keeps its angle to the bearer. */
  {
    'slide-m': number;
  }
  | /** Onto a place of another branch, or of its own bearer; it keeps its angle to its bearer. */
  {
    place: {
      /** Place on the bearer, as a share of its length. */
      at: number;
      /** The new bearer. */
      axis: AxisKey;
    };
  }
  | /** By a vector, metres: a branch on the ground is set elsewhere, a borne branch slides to the place of its bearer nearest to the new base. */
  {
    'by-m': [number, number, number];
  };

/** A document with its history, as lists and panels show it. */
export type DocumentState = {
  /** The plant that is chosen. */
  current: 
    | PlantId
    | null;
  /** Name of the scene. */
  name: string;
  /** Their numbers. */
  numbers: PlantNumbers;
  /** The plants in the order in which they were added. */
  plants: PlantState[];
  /** Name of the step that redo does again. */
  redo: string | null;
  /** Grows with every change. */
  revision: number;
  /** Steps that can be undone. */
  steps: number;
  /** Name of the step that undo takes back. */
  undo: string | null;
};

/** The file formats that hold strokes. */
export type DrawingFormat =
  | /** Scalable Vector Graphics; one drawing a file. */
  "svg"
  | /** Ink Markup Language (W3C 2011); one drawing a file. */
  "inkml"
  | /** One JSON object a line, as in "Quick, Draw!"; any number of drawings a file. */
  "ndjson"
  | /** Our own `drawing/1`; one drawing a file. */
  "json"
  | /** Excalidraw's files and what it puts on the clipboard; one drawing a file. */
  "excalidraw"
  | /** tldraw's files; one drawing a file. */
  "tldraw";

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

/** A hand edit. */
export type EditState = {
  /** Whether it is left out for now. */
  off: boolean;
  /** Its word in [`burgeon::shape::HandEdit`]. */
  op: string;
};

/** A program that plants go to. */
export type Engine =
  | /** three.js and what stands on it. */
  "three"
  | /** Blender. */
  "blender"
  | /** Unity by glTFast. */
  "unity"
  | /** Unreal Engine. */
  "unreal"
  | /** Godot 4. */
  "godot"
  | /** Isaac Sim and other readers of USD. */
  "isaac"
  | /** A 3-D printer. */
  "print";

/** An export as a program wants it. */
export type EngineAnswer = {
  /** The export. */
  request: ExportRequest;
  /** What was set for the program. */
  set: EngineSet[];
};

/** Choices of a person for an export to a program; null is open. */
export type EngineAsk = {
  /** The program. */
  engine: Engine;
  /** The format. */
  format: ModelFormat;
  /** Whether to add views from all sides. */
  impostor: boolean | null;
  /** Whether leaves of one form are written once. */
  instances: boolean | null;
  /** Levels of detail, 1 to 4. */
  levels: number | null;
  /** Whether all levels go into one file. */
  one_file: boolean | null;
  /** Whether columns are compressed. */
  packed: boolean | null;
  /** Whether to write joints and an animation that sways. */
  sway: boolean | null;
  /** The unit of the file. */
  unit: 
    | Unit
    | null;
  /** The vertical axis of the file. */
  up: 
    | UpAxis
    | null;
  /** Whether the whole scene is exported. */
  whole: boolean;
  /** Whether drawings and trees get wind columns. */
  wind: boolean | null;
};

/** A setting that a program wants and the person left open. */
export type EngineSet = {
  /** The option (up, unit, lods, pack, wind), or what no option sets: levels, collider, pivots, skeleton, names, ... */
  name: string;
  /** Its value, empty for a switch; for what no option sets a few English words. */
  value: string;
};

/** Format of an export, by its word. */
export type ExportFormat =
  | /** The meshes of the plants. */
  ModelFormat
  | /** The structure of each plant. */
  StructureFormat
  | /** The current drawing. */
  DrawingFormat;

/** Subject and format of an export. */
export type ExportRequest = {
  /** The program that the files are for: [`Engine::Print`] gets one closed body, the others what the settings above say. */
  engine: 
    | Engine
    | null;
  /** How leaves are drawn, for formats with textures; null for as each plant has it. */
  foliage: 
    | FoliageStyle
    | null;
  /** The format. */
  format: ExportFormat;
  /** Whether to add a last level, views from all sides in one picture, for glTF. */
  impostor: boolean;
  /** Whether leaves of one form are written once, for glTF (`EXT_mesh_gpu_instancing`); they do not move in the wind. */
  instances: boolean;
  /** Levels of detail, 1 to 4: each has about half of the triangles of the one before. */
  levels: number;
  /** Most megabytes of its file, 0.001 to 4000: textures become smaller first, then it becomes the first level of detail that fits. */
  megabytes: number | null;
  /** Whether parts and materials are named after their plant. */
  named: boolean;
  /** Whether all levels go into one file, for glTF (`MSFT_lod`); else each has its own. */
  one_file: boolean;
  /** Whether columns are compressed (`EXT_meshopt_compression`), for glTF without joints. */
  packed: boolean;
  /** Whether to write joints and an animation that sways, for glTF; each level then has a file of its own. */
  sway: boolean;
  /** Pixels of a side of the textures of bark, and of the length of those of leaves, 64 to 4096; null for as shown. */
  texture_size: number | null;
  /** Most triangles of the finest level, 100 or more: it becomes the first level of detail within them. */
  triangles: number | null;
  /** The unit of the file. */
  unit: Unit;
  /** The vertical axis of the file. */
  up: UpAxis;
  /** Whether the whole scene is exported, else the current plant. */
  whole: boolean;
  /** Whether drawings and trees get wind columns, where the format has room for them. */
  wind: boolean;
};

/** Contents of an export at one level of detail. */
export type ExportView = {
  /** Number of meshes that a program draws to show all of it. */
  draws: number;
  /** Bytes of the file with this level alone, or of its zip, counted from the written file. */
  file_bytes: number;
  /** The level; 0 is the finest. */
  level: number;
  /** Its meshes; copies share theirs. */
  models: PlantView[];
  /** Its contents by kind. */
  parts: PartFigures[];
  /** The mesh of each plant; empty where the one model stands for the whole scene. */
  plants: ExportedPlant[];
  /** Their bytes as PNG. */
  texture_bytes: number;
  /** Number of textures in it or next to it. */
  textures: number;
};

/** A plant of an export. */
export type ExportedPlant = {
  /** Row of its meshes in [`ExportView::models`]. */
  model: number;
  /** Its name within the document, or [`GUEST`]. */
  plant: PlantId;
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

/** Kind of an opened file. */
export type FileKind =
  | /** A project, which replaced the document. */
  "project"
  | /** A drawing, which replaced the document. */
  "drawing"
  | /** A model, which is shown. */
  "model"
  | /** Measurements, which went to a leaf. */
  "leaf"
  | /** A new tree. */
  "tree"
  | /** A new flower that opens. */
  "flower"
  | /** A growth law, which went to the current flower. */
  "law";

/** Eq 2: growth of twigs and midribs inside a contour. */
export type FillSpec = {
  /** Attraction along the bearer, `k_b`. */
  bearer_pull: number;
  /** Attraction by the contour, `k_p`. */
  contour_pull: number;
  /** How many twigs and leaves relative to the default, 0.1 to 10, default 1. */
  density: number;
  /** Memory of the last direction, `k_m`. */
  memory: number;
  /** Named coefficients. */
  set?: 
    | PullSet
    | null;
  /** Pull against gravity on grown twigs, -1 (weeping) to 1 (upright), default 0.1. */
  tropism: number;
};

/** Commands of a flower. */
export type FlowerCommand =
  | /** Replaces the spec, for example by that of a species. */
  {
    'set-spec': [string | null, Json];
  }
  | /** Sets one field of the spec, named by a JSON pointer such as `/whorls/0/count`. */
  {
    'set-field': [string, Json];
  }
  | /** Sets the day on which it is shown. */
  {
    'set-day': number;
  }
  | /** Sets a fitted law, or the species' own pace again. */
  {
    'set-law': Json;
  };

/** Settings of a flower, and its day. */
export type FlowerState = {
  /** Days since the bud. */
  day: number;
  /** Name of the fitted law that sets its pace. */
  law: string | null;
  /** The species that the spec came from. */
  preset: string | null;
  /** The spec. */
  spec: Record<string, Json>;
};

/** Drawing of leaves. */
export type FoliageStyle =
  | /** By their outlines. */
  "outlines"
  | /** By cards of six corners, with the leaf cut out of their texture. */
  "cards"
  | /** By outlines in the finest level, by cards in the next, and by cards of whole shoots in those that are coarser. */
  "by-level";

/** Placement of a drawing in the front view of its plant. */
export type Front = {
  /** Metres for each unit of the drawing. */
  metres_per_unit: number;
  /** Position of the plant's origin in the drawing, along x. */
  x: number;
  /** Position of the plant's origin in the drawing, along y, up. */
  y: number;
};

/** A deed of a step. */
export type GestureDeed =
  | /** A hand with a tool. */
  {
    hand: HandDeed;
  }
  | /** The edit of the last gesture was requested. */
  "keep"
  | /** The plants were made again, and shown. */
  "seen"
  | /** Another plant was chosen. */
  {
    select: PlantId;
  }
  | /** A command. */
  {
    command: Command;
  }
  | /** An action of more than one command, and the place that it gave a plant. */
  {
    action: [Action, number | null];
  }
  | /** Begins a gesture: the commands staged from here on form one step of undo of this name. */
  {
    begin: string;
  }
  | /** Replaces the staged command. */
  {
    stage: Command;
  }
  | /** Commits the staged command. */
  "commit"
  | /** Takes the staged command back. */
  "abandon"
  | /** The last step was taken back. */
  "undo"
  | /** It was redone. */
  "redo";

/** Gestures on the plants of a session, in their order. */
export type GestureRecord = {
  /** Digest of the plant that was worked on last, at its last evaluation. */
  digest?: string | null;
  /** Numbers of the project's plants, by which steps name them. */
  numbers?: 
    | PlantNumbers
    | null;
  /** The plant that was worked on first. */
  plant?: 
    | PlantId
    | null;
  /** The project at the start of the session: a `.burgeon` file in base64. */
  project?: string | null;
  /** Always [`GESTURES_SCHEMA`]. */
  schema: string;
  /** The steps. */
  steps: GestureStep[];
};

/** One step. */
export type GestureStep = {
  /** The deed. */
  did: GestureDeed;
  /** Time in ms since the first step. */
  ms: number;
};

/** Places on the ground: x and z, metres. */
export type Ground =
  | /** In a row along a line. */
  {
    line: [number, number][];
  }
  | /** All over a closed outline. */
  {
    area: [number, number][];
  }
  | /** All over the ground that a brush covers. */
  {
    brush: {
      /** Path of the brush. */
      path: [number, number][];
      /** Its radius, metres. */
      radius_m: number;
    };
  };

/** Start of a shoot that grows by itself. */
export type GrowFrom =
  | /** On a branch; at its tip, the shoot continues the branch. */
  {
    branch: {
      /** Place on it, as a share of its length. */
      at: number;
      /** The branch. */
      axis: AxisKey;
    };
  }
  | /** On the ground, metres: another stem of the plant. */
  {
    ground: [number, number, number];
  };

/** Growth since a hand began to hold, both sides of a plane of symmetry together. */
export type Grown = {
  /** Number of branches in the last view. */
  branches: number;
  /** Its density: branches for each metre of new wood; none before any grew. */
  per_metre: number | null;
  /** Its age: rounds of growth. */
  rounds: number;
};

/** Settings of a shoot that grows by itself; every number may change while it grows. */
export type Growth = {
  /** Angle between a shoot and its lateral buds, 0 to 180 degrees. */
  angle_deg: number;
  /** Strength with which shoots keep apart, 0 to 10. */
  apart: number;
  /** Apical control: the share of the main axis at a fork, 0 to 1. */
  apical: number;
  /** Pull to the light, or of the weight if negative, -10 to 10; free space pulls with 1. */
  lift: number;
  /** Vigour per unit of free space, above 0 and at most 100. */
  vigour: number;
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

/** Numbers of [`GuidedSpec`] that change while a tree grows; numbers that are left out stay. */
export type GuidedChange = {
  /** Vigour per unit of free space, above 0 and at most 100. */
  alpha?: number | null;
  /** Angle between a shoot and its lateral buds, 0 to 180 degrees. */
  branch_angle_deg?: number | null;
  /** Share of the main axis at a fork (apical control), 0 to 1. */
  lambda?: number | null;
  /** Markers of one bud in one round, 4 to 10000. */
  markers?: number | null;
  /** Strength of the repulsion by others' markers, 0 to 10. */
  repulsion?: number | null;
  /** The first round with these numbers, from 0, at most 1000. */
  round: number;
  /** All guiding strokes from then on. */
  strokes?: BrushStroke[] | null;
  /** Weight and light. */
  tropisms?: Tropism[] | null;
};

/** A deed of a hand with a tool. */
export type HandDeed = {
  /** Input of the hand. */
  input: ShapeInput;
  /** Largest distance from a branch at which it is still meant. */
  reach: ShapeReach;
  /** The tool, with its settings. */
  tool: ToolKind;
};

/** One edit of a plant by hand. */
export type HandEdit =
  | /** Turns a branch about its base, with all that it bears. */
  {
    /** The branch. */
    axis: AxisKey;
    op: "rotate";
    /** The rotation. */
    turn: Turn;
  }
  | /** Moves a branch with all that it bears. */
  {
    /** The branch. */
    axis: AxisKey;
    op: "move";
    /** The destination. */
    to: Destination;
    /** Turns it about its base there, from how it would stand otherwise. */
    turn?: 
      | Turn
      | null;
  }
  | /** Sets a copy of a branch, with all that it bears, elsewhere; the branch itself stays. */
  {
    /** The branch. */
    axis: AxisKey;
    op: "copy";
    /** The destination; also on the branch itself or on a part that it bears. */
    to: Destination;
  }
  | /** Cuts a branch off, with all that it bears beyond the cut. */
  {
    /** Place of the cut, as a share of its length; 0 (the default) removes all of it. */
    at: number;
    /** The branch. */
    axis: AxisKey;
    op: "prune";
  }
  | /** Cuts a branch off and grows another one in the room that it had. */
  {
    /** The branch. */
    axis: AxisKey;
    op: "regrow";
    /** Seed: another number gives another branch. */
    seed: number;
  }
  | /** Adds a branch that was drawn in space. */
  {
    /** Place on the bearer, as a share of its length; without it, the place nearest to the start of the line. */
    at?: number | null;
    /** The branch that it grows from. */
    bearer: AxisKey;
    /** Makes it on the other side of a plane, too. */
    mirror?: 
      | Mirror
      | null;
    op: "sketch-branch";
    /** Its course, metres, at least two points; it is joined to its bearer. */
    points: [number, number, number][];
    /** Seed: another number gives other twigs. */
    seed: number;
    /** Number of twigs on it, relative to the plant's habit, 0 (none) to 4; default 1. */
    twigs: number;
  }
  | /** Lets branches grow along a stroke of a brush (the VR paper). */
  {
    /** The bearer of the new branches; without it, the branch nearest to the stroke's start. */
    bearer?: 
      | AxisKey
      | null;
    /** Density of the filling, 0.1 to 10: more markers, more branches; default 1. */
    density: number;
    /** Makes it on the other side of a plane, too. */
    mirror?: 
      | Mirror
      | null;
    op: "brush";
    /** The stroke, metres, at least two points. */
    points: [number, number, number][];
    /** Radius of the brush, metres, above 0: one number, or one for each point. */
    radius_m: number[];
    /** Seed: another number gives other branches. */
    seed: number;
  }
  | /** Lets a shoot grow by itself, for as many rounds as a hand held on (the VR paper). */
  {
    /** Settings of growth from some round on, as a hand changed them; a field left out keeps its value, at first that of guided growth with the angles of the plant. */
    changes?: GuidedChange[];
    /** Start of the shoot. */
    from: GrowFrom;
    /** Makes it on the other side of a plane, too. */
    mirror?: 
      | Mirror
      | null;
    op: "grow";
    /** Rounds of growth. */
    rounds: number;
    /** Seed: another number gives other branches. */
    seed: number;
    /** The side on which it leaves its bearer; without, the upper one. */
    towards?: [number, number, number] | null;
  }
  | /** Fills an outline that was drawn in a plane facing the viewer (the VR paper). */
  {
    /** Density of the filling, 0.1 to 10; default 1. */
    density: number;
    /** Fills the image of the outline on the other side of a plane, too. */
    mirror?: 
      | Mirror
      | null;
    op: "silhouette";
    /** The outline in the plane, metres, at least three points; the first is not repeated. */
    outline: [number, number][];
    /** The plane. */
    plane: ViewPlane;
    /** Seed: another number gives other branches. */
    seed: number;
    /** Whether parts outside the outline are cut off. */
    trim: boolean;
  }
  | /** Removes leaves, or adds some. */
  {
    /** Share of the leaves that stay, 0 to 1; above 1, up to 4, the factor by which their number grows. */
    keep: number;
    op: "leaf-density";
    /** The region. */
    region: LeafRegion;
    /** Seed: another number gives other leaves. */
    seed: number;
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

/** [`AxisKind`] as it is written. */
export type KindWord =
  | /** Trunk, branch or twig. */
  "wood"
  | /** Green stem. */
  "stem"
  | /** Stalk of a leaf. */
  "petiole"
  | /** Below ground. */
  "root";

/** A layer of a drawing. */
export type Layer = {
  /** Whether its strokes are invisible and not part of the plant. */
  hidden: boolean;
  /** Whether its strokes are protected from changes. */
  locked: boolean;
  /** Its name, unique in the drawing, 1 to 200 characters. */
  name: string;
};

/** One control ball. */
export type LeafBall = {
  /** Position in the coordinates of the leaf, metres. */
  at: [number, number, number];
  /** As in `BallMove`. */
  mark: number;
  /** Radius of the thickest vein there, metres; 0 where there is none. */
  radius_m: number;
  /** As in `BallMove`. */
  row: number;
};

/** All control balls of a leaf in its bent form, and the directions in which they are moved. */
export type LeafBalls = {
  /** Balls with the tip first, then row by row; for chief veins, vein by vein. */
  balls: LeafBall[];
  /** Unit vectors of the first, second and third number of `BallMove::by_m`. */
  sides: [[number, number, number], [number, number, number], [number, number, number]];
};

/** Commands of a measured leaf. */
export type LeafCommand =
  | /** Replaces the measurements by others, with no control ball moved. */
  {
    'set-data': LeafData;
  }
  | /** Sets how the leaf is made. */
  {
    set: LeafSpec;
  };

/** The file of a measured leaf: marks as CSV, or a vein graph as JSON. */
export type LeafData = {
  /** Name of the file. */
  name: string;
  /** Its text. */
  text: string;
};

/** How the depth of leaves is found (He and Cheng 2021, section 5.3). */
export type LeafDepth =
  | /** The light prior as printed: every leaf turns to the same side. */
  "paper"
  | /** The light prior with left and right kept. */
  "signed"
  | /** The front view of the model is the drawing; the blade leaves the plane by tilt and bend only. */
  "drawn";

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

/** The form of a leaf with one midrib, used if nothing was measured. */
export type LeafForm = {
  /** Angle by which both halves are raised along the midrib, degrees, -60 to 60, default 10. */
  fold_deg: number;
  /** Length of the midrib, metres, 0.002 to 10, default 0.1. */
  length_m: number;
  /** Depth of the margin between the side veins, as a share of the half width: 0 (entire) to 0.8 (deep lobes), default 0. */
  lobes: number;
  /** Angle between side veins and midrib, degrees, 15 to 85, default 50. */
  vein_angle_deg: number;
  /** Pairs of side veins, 2 to 30, default 8. */
  veins: number;
  /** Position of the greatest width: 0.1 near the base to 0.9 near the tip, default 0.4. */
  widest: number;
  /** Greatest width over length, 0.02 to 2, default 0.5. */
  width: number;
};

/** Colouring of a measured blade. */
export type LeafPaint =
  | /** Painted by the distance from the veins. */
  "veins"
  | /** One green. */
  "plain";

/** Region of leaves. */
export type LeafRegion =
  | /** All leaves. */
  "all"
  | /** The leaves of a branch and of all that it bears. */
  {
    branch: AxisKey;
  }
  | /** The leaves within a stroke. */
  {
    stroke: {
      /** The stroke, metres, one point or more. */
      points: [number, number, number][];
      /** Its radius, metres, above 0. */
      radius_m: number;
    };
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

/** Construction of a leaf from its marks (Wang et al. */
export type LeafSpec = {
  /** Control balls moved and rescaled by hand (Wang et al. */
  balls: BallMove[];
  /** Round ends on the veins; default false. */
  caps: boolean;
  /** Roll about the midrib: -1 (margins meet below) to 1 (above), 0 as measured, default 0. */
  curl: number;
  /** Form of the leaf if nothing was measured. */
  form: LeafForm;
  /** Length of the midrib for a vein graph in pixels, metres, 0.002 to 10, default 0.1. */
  length_m: number;
  /** A vein along the margin too; default false. */
  margin_vein: boolean;
  /** Parameters of interpolating side veins. */
  parameters: VeinParameters;
  /** Rings of the veins. */
  rings: RingRule;
  /** Points around a vein, 3 to 64, default 10. */
  sides: number;
  /** Parts of each span between marks, 1 to 64, default 5. */
  subdivisions: number;
  /** Surface of the blade. */
  surface: SurfaceKind;
  /** Colour of the blade. */
  texture: LeafPaint;
  /** Meaning of a measured thickness; default that of the file, otherwise the diameter. */
  thickness: 
    | ThicknessRule
    | null;
  /** Pull of the thickest vein on a NURBS blade, 1 (none) to 100, default 4. */
  vein_weight: number;
  /** Loss of stiffness: 0 as measured to 1 hanging limp, default 0. */
  wilt: number;
};

/** Source of a leaf. */
export type LeafState = {
  /** Name of the file of marks or veins. */
  file: string;
  /** Settings for making the leaf of it. */
  settings: LeafSpec;
  /** Its text. */
  text: string;
};

/** Light that is asked for: sky, and sun by its direction or by a place on earth. */
export type LightAsk = {
  /** PAR of the sky on a horizontal surface, W/m2. */
  diffuse: number | null;
  /** PAR of the sun on a horizontal surface, W/m2. */
  direct: number | null;
  /** Place and day. */
  place: 
    | LightPlace
    | null;
  /** Approximate number of lines of light in each direction. */
  rays: number | null;
  /** The sky. */
  sky: 
    | SkyShape
    | null;
  /** Azimuth of the sun from north over east, and its elevation, degrees. */
  sun: [number, number] | null;
};

/** A place on earth on a day. */
export type LightPlace = {
  /** Year, month and day. */
  date: [number, number, number];
  /** The hour by the clock; null: the sum of the day. */
  hour: number | null;
  /** Latitude, degrees north. */
  latitude: number;
  /** Longitude, degrees east. */
  longitude: number;
};

/** The scene in light. */
export type LightView = {
  /** Light absorbed by all plants. */
  absorbed: number;
  /** Light at the end of the scale of colours, absorbed by a square metre of surface. */
  brightest: number;
  /** That of the sky. */
  diffuse: number;
  /** That of the sun. */
  direct: number;
  /** Hours of sunshine, for a day. */
  hours: number | null;
  /** Light on a square metre of a horizontal surface above the plants. */
  incoming: number;
  /** Light absorbed by leaves. */
  leaf_absorbed: number;
  /** One side of all leaves, square metres. */
  leaf_area: number;
  /** Light absorbed by a square metre of leaves, over that on a horizontal surface. */
  leaf_share: number | null;
  /** The coloured meshes of all plants. */
  model: PlantView;
  /** Colours at even shares of it, sRGB. */
  scale: [number, number, number][];
  /** Azimuth and elevation of the sun, degrees. */
  sun: [number, number] | null;
  /** Share of the leaf area that is in the sun. */
  sunlit: number | null;
  /** W for a moment, MJ for a day. */
  unit: string;
  /** Warnings. */
  warnings: WarningView[];
};

/** The maker of a plant. */
export type MakerWord =
  | /** Drawn with a pen. */
  "sketch"
  | /** Grown. */
  "tree"
  | /** Measured. */
  "leaf"
  | /** A species that opens. */
  "flower";

/** Mark by which an axis is remembered. */
export type Mark = {
  /** Position of its base. */
  base: [number, number, number];
  /** Direction from base to tip, a unit vector. */
  direction: [number, number, number];
  /** The axis's own key, hexadecimal. */
  id: string;
  /** Woody or green, stalk or root. */
  kind: KindWord;
  /** Length along its course. */
  length: number;
  /** Order of branching, 0 for a trunk. */
  order: number;
};

/** Appearance of a mesh. */
export type MaterialView = {
  /** Linear red, green, blue. */
  color: [number, number, number];
  /** Kind of its organs: bark, leaf, petal, ... */
  kind: string;
  /** Whether the texture has holes. */
  masked: boolean;
  /** Its name in files. */
  name: string;
  /** Normals of its relief, as glTF has them. */
  normal: 
    | TextureView
    | null;
  /** Red is occlusion; green is multiplied with the roughness. */
  orm: 
    | TextureView
    | null;
  /** Roughness, 0 to 1. */
  roughness: number;
  /** Its picture. */
  texture: 
    | TextureView
    | null;
  /** Translucency, 0 to 1. */
  translucency: number;
  /** Whether it is visible from both sides. */
  two_sided: boolean;
};

/** A plane of symmetry: an edit on one side is mirrored to the other. */
export type Mirror = {
  /** Normal of the plane, of any length above 0. */
  normal: [number, number, number];
  /** A point on the plane, metres. */
  point: [number, number, number];
};

/** The file formats that hold models. */
export type ModelFormat =
  | /** Binary glTF: one file with textures and materials. */
  "glb"
  | /** glTF as text, with its buffer and textures beside it. */
  "gltf"
  | /** Wavefront OBJ with its material file and textures beside it. */
  "obj"
  | /** PLY: one mesh with colours. */
  "ply"
  | /** Stereolithography: bare triangles. */
  "stl"
  | /** Universal Scene Description as text, with textures beside it. */
  "usda"
  | /** Universal Scene Description with its textures in one file. */
  "usdz";

/** An obstacle with a name for its user. */
export type NamedObstacle = {
  /** Name in lists; at most 200 characters. */
  name: string;
  /** The solid. */
  shape: Obstacle;
};

/** An obstacle with its name. */
export type NamedShape = {
  /** Name in lists. */
  name: string;
  /** The solid. */
  shape: ObstacleView;
};

/** The maker of a new plant. */
export type NewMaker =
  | /** An empty sheet. */
  "sketch"
  | /** A tree of this preset. */
  {
    tree: string;
  }
  | /** A leaf of a few numbers, until it is given marks. */
  "leaf"
  | /** A flower of this species. */
  {
    flower: string;
  };

/** A solid thing. */
export type Obstacle =
  | /** A box along the axes. */
  {
    /** Upper corner, above the lower one in each coordinate. */
    max: [number, number, number];
    /** Lower corner. */
    min: [number, number, number];
    shape: "box";
  }
  | /** A ball. */
  {
    /** Its centre. */
    centre: [number, number, number];
    /** Its radius, above 0. */
    radius_m: number;
    shape: "sphere";
  }
  | /** An upright cylinder. */
  {
    /** Centre of its base. */
    base: [number, number, number];
    /** Its height, above 0. */
    height_m: number;
    /** Its radius, above 0. */
    radius_m: number;
    shape: "cylinder";
  }
  | /** Everything behind a plane: a wall, a slope. */
  {
    /** Direction away from the solid side; any length above 0. */
    normal: [number, number, number];
    /** Any point of the plane. */
    point: [number, number, number];
    shape: "plane";
  }
  | /** A mesh, in metres, +Y up; small holes and inverted faces are tolerated (winding number). */
  {
    shape: "mesh";
    /** Corners of each triangle. */
    triangles: [number, number, number][];
    /** Vertices. */
    vertices: [number, number, number][];
  };

/** An obstacle to be shown: of a mesh only the size; its corners are fetched separately. */
export type ObstacleView =
  | /** Any shape but a mesh. */
  Obstacle
  | /** A mesh. */
  {
    /** Always `mesh`. */
    shape: string;
    /** Number of triangles. */
    triangles: number;
  };

/** Result of opening a file. */
export type Opened = {
  /** Kind of the file. */
  kind: FileKind;
  /** Its name. */
  name: string;
  /** Every drawing of the file, at most a thousand. */
  names: string[];
  /** Warnings about it. */
  warnings: WarningView[];
};

/** A material of leaves, petals or sepals. */
export type OrganMaterial = {
  /** Amount of the second colour, 0 to 1, default 0.5. */
  amount: number;
  /** The first colour, which covers most of the organ. */
  color: Colour;
  /** The painted pattern. */
  pattern: Pattern;
  /** Picture of the pattern `picture`. */
  picture: string | null;
  /** Roughness: 0 is as glossy as wet leaves, 1 as matt as velvet; default 0.6. */
  roughness: number;
  /** The second colour, for veins, streaks, spots, the margin, the root. */
  second: Colour;
};

/** Figures of all meshes of one kind. */
export type PartFigures = {
  /** Bytes of columns and indices, as binary glTF and graphics cards hold them; those of copies in binary glTF count once. */
  bytes: number;
  /** Meshes that a program draws; those of copies count each time; 0 where the file is a single mesh. */
  draws: number;
  /** Kind of the meshes: bark, leaf, petal, ... */
  kind: string;
  /** Triangles; those of copies count each time. */
  triangles: number;
  /** Vertices; those of copies count each time. */
  vertices: number;
};

/** One mesh. */
export type PartView = {
  /** Row of its material. */
  material: number;
  /** Its name in files. */
  name: string;
};

/** Pattern that is painted on an organ. */
export type Pattern =
  | /** One colour. */
  "plain"
  | /** From the second colour at the root to the first at the tip. */
  "shaded"
  | /** Midrib and side veins in the second colour. */
  "veined"
  | /** Lines of the second colour that fan out from the throat. */
  "streaked"
  | /** Spots of the second colour, more of them towards the throat. */
  "speckled"
  | /** A margin of the second colour (picotee). */
  "picotee"
  | /** An uneven margin of the second colour that runs into the first (variegated leaf). */
  "variegated"
  | /** A picture, upright from root to tip. */
  "picture";

/** The pen that a stroke is drawn with; a field left out is that of the default pen. */
export type PenStyle = {
  /** The class of strokes that are drawn with it, if the person chose one. */
  class: 
    | StrokeClass
    | null;
  /** Colour of the stroke, sRGB. */
  color: [number, number, number] | null;
  /** The name of the layer. */
  layer: string | null;
  /** Width in the drawing's unit, above 0. */
  width: number | null;
};

/** Natural petal colours. */
export type PetalColor =
  | /** Rose pink with a pale base. */
  "pink"
  | /** White with a greenish base. */
  "white"
  | /** Warm yellow. */
  "yellow"
  | /** Violet blue with a pale base. */
  "violet"
  | /** Poppy red with a dark base. */
  "red"
  | /** Orange with a yellow base. */
  "orange"
  | /** Sky blue with a white base. */
  "blue"
  | /** Crimson magenta. */
  "magenta";

/** Place of a photograph under the drawing. */
export type PhotoPlace = {
  /** Opacity under the drawing, 0 to 1, default 0.5. */
  opacity: number;
  /** Whether organs that were traced over it take its colours. */
  paint: boolean;
  /** Width, in the drawing's unit, above 0; the height follows from the picture. */
  width: number;
  /** Left edge, in the drawing's unit. */
  x: number;
  /** Lower edge, in the drawing's unit, y up. */
  y: number;
};

/** Placement of a photograph, and its size. */
export type PhotoState = {
  /** Height in the drawing's unit, which follows from the picture. */
  height: number;
  /** Pixels across and down. */
  pixels: [number, number];
  /** Requested placement. */
  place: PhotoPlace;
};

/** The branch that is meant. */
export type Picked = {
  /** Place on it, as a share of its length. */
  at: number;
  /** Its row. */
  axis: number;
  /** Number of shoots that it bears, directly or through others. */
  bears: number;
  /** Key for edits, where the pointer went down or up. */
  key: 
    | AxisKey
    | null;
  /** Length along its course. */
  length_m: number;
  /** Order of branching, 0 for the main axis. */
  order: number;
  /** That place, metres. */
  point: [number, number, number];
  /** Whether it stands on the ground. */
  stands: boolean;
};

/** Place of a plant: scaled, turned about the vertical, then moved. */
export type Placement = {
  /** Position of its origin, metres; each coordinate up to 100 km. */
  position: [number, number, number];
  /** Size, 0.001 to 1,000. */
  scale: number;
  /** Turn about +Y, degrees, counter-clockwise seen from above. */
  yaw_deg: number;
};

/** Commands of any plant. */
export type PlantCommand =
  | /** Renames it. */
  {
    rename: string;
  }
  | /** Sets its seed; text as JSON, because JavaScript's numbers hold 53 bits. */
  {
    'set-seed': string;
  }
  | /** Locks or unlocks its seed for dice. */
  {
    lock: boolean;
  }
  | /** Hides it from the view, or shows it again. */
  {
    hide: boolean;
  }
  | /** Puts it into the group of a name; an empty name takes it out of its group. */
  {
    group: string;
  }
  | /** Sets its placement. */
  {
    place: Placement;
  }
  | /** Locks or unlocks its place. */
  {
    fix: boolean;
  }
  | /** Gives the organs of a kind a material, or takes it away. */
  {
    wear: [Wearer, 
      | OrganMaterial
      | null];
  };

/** Names one plant for the lifetime of the document. */
export type PlantId = number;

/** Numbers of the plants of a document: files do not store them, but commands name plants by them. */
export type PlantNumbers = {
  /** Number of the next new plant; above all others. */
  next: number;
  /** Number of each plant, in the order of the document. */
  plants: PlantId[];
};

/** One plant; of `sketch`, `tree`, `leaf` and `flower`, the field of its maker is present. */
export type PlantState = {
  /** Hand edits, in the order in which they are applied. */
  edits: EditState[];
  /** Whether its place is locked. */
  fixed: boolean;
  /** State of a flower. */
  flower: 
    | FlowerState
    | null;
  /** The group it belongs to; empty for none. */
  group: string;
  /** Whether it is left out of the view. */
  hidden: boolean;
  /** Its name within the document. */
  id: PlantId;
  /** State of a measured leaf. */
  leaf: 
    | LeafState
    | null;
  /** Whether others may bear its leaf. */
  lends: boolean;
  /** Whether dice leave its seed alone. */
  locked: boolean;
  /** Its maker. */
  maker: MakerWord;
  /** Its name. */
  name: string;
  /** Position, metres. */
  position: [number, number, number];
  /** Scale. */
  scale: number;
  /** Seed as text: JavaScript's numbers hold 53 bits. */
  seed: string;
  /** State of a drawing. */
  sketch: 
    | SketchState
    | null;
  /** State of a tree. */
  tree: 
    | TreeState
    | null;
  /** The materials of its leaves, petals and sepals. */
  wear: WearState;
  /** Turn about +Y, degrees. */
  yaw_deg: number;
};

/** A plant as it is seen. */
export type PlantView = {
  /** Days from bud to full bloom, and from there to wilted. */
  days: [number, number] | null;
  /** Reason why it could not be made; earlier results stay. */
  error: 
    | Refusal
    | null;
  /** Whether its meshes differ from those of the last view. */
  fresh: boolean;
  /** Placement of a drawing in the front view. */
  front: 
    | Front
    | null;
  /** Its name within the document, or [`GUEST`]. */
  id: PlantId;
  /** The entry of the report. */
  item: 
    | ItemReport
    | null;
  /** Materials of the meshes. */
  materials: MaterialView[];
  /** Upper corner of its bounds, metres. */
  max: [number, number, number];
  /** Name of its meshes: plants with the same meshes share it. */
  mesh: number | null;
  /** Lower corner of its bounds, metres. */
  min: [number, number, number];
  /** Obstacles that it grows around. */
  obstacles: ObstacleView[];
  /** Its meshes. */
  parts: PartView[];
  /** Stages that were computed again. */
  stages: string[];
  /** Warnings about it. */
  warnings: WarningView[];
};

/** A body for a printer beside its plant. */
export type PrintFigures = {
  /** Number of surfaces that were left out, as they hang on nothing or lie within the body. */
  loose: number;
  /** Number of times that the plant is larger. */
  scale: number;
  /** Least thickness of any part, millimetres: thinner ones are thickened. */
  wall_mm: number;
};

/** The coefficients of Eq 2 by the names of Fig 2 (He and Cheng 2021): the more the contour pulls, the wider twigs stand off from their bearer. */
export type PullSet =
  | /** Fig 2a: 0.45, 0.45, 0.1. */
  "fig2a"
  | /** Fig 2b: 0.55, 0.35, 0.1. */
  "fig2b"
  | /** Fig 2c with the sum that a and b have: 0.65, 0.25, 0.1. */
  "fig2c"
  | /** Fig 2c as printed, very likely by mistake: 0.65, 0.35, 0.1. */
  "fig2c-printed";

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

/** Eq 5 and section 6.2: how blades bend and hollow, as shares of their length. */
export type ReliefSpec = {
  /** A of Eq 5 for leaves, default 0.05. */
  leaf_bend_a: number;
  /** B of Eq 5 for leaves, default 0.18. */
  leaf_bend_b: number;
  /** Fold of leaves along the midrib, slope of the halves, 0 to 1, default 0.25. */
  leaf_fold: number;
  /** A of Eq 5 for petals, -0.2 to 0.2, default 0.08. */
  petal_bend_a: number;
  /** B of Eq 5 for petals, -0.3 to 0.5, default 0.06. */
  petal_bend_b: number;
  /** Hollow of petals, 0 to 0.3, default 0.08. */
  petal_hollow: number;
};

/** Placement of a ring of the tube. */
export type RingRule =
  | /** A circle of the ball's radius in the plane across the centre line (Wang et al. */
  "plain"
  | /** The circle in which the ball touches the envelope of all balls: the exact surface. */
  "envelope";

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

/** Copies of a plant, and the ground that they stand on. */
export type Scatter = {
  /** The ground. */
  ground: Ground;
  /** Number of different plants among the copies, each with a seed of its own; 0 for copies that are all alike. */
  kinds: number;
  /** The plant. */
  plant: PlantId;
  /** Least distance between any two plants, metres; 0.001 to 10,000. */
  spacing_m: number;
  /** Variation of size: copies are up to this share smaller or larger; 0 to 0.9. */
  vary: number;
};

/** Commands of the scene. */
export type SceneCommand =
  | /** Renames the scene. */
  {
    rename: string;
  }
  | /** Adds a copy of a plant after the others, moved by an offset in metres. */
  {
    duplicate: [PlantId, [number, number, number]];
  }
  | /** Adds copies of plants after the others, moved by an offset in metres. */
  {
    'duplicate-all': [PlantId[], [number, number, number]];
  }
  | /** Moves, turns and scales plants as one unit. */
  {
    carry: [PlantId[], Carry];
  }
  | /** Deletes plants; a plant that bore the leaf of one bears its own again. */
  {
    remove: PlantId[];
  };

/** Every plant of a scene, as it was made last. */
export type SceneView = {
  /** A model that is shown instead. */
  guest: 
    | PlantView
    | null;
  /** Views in the document's order. */
  plants: PlantView[];
  /** Revision of the document at the evaluation. */
  revision: number;
};

/** A movement: scaling and rotation about a point, followed by a translation. */
export type SetDown = {
  /** Fixed point of the scaling and rotation; metres. */
  about: [number, number, number];
  /** Offset, metres. */
  by: [number, number, number];
  /** Factor on the size, 0.01 to 100. */
  times: number;
  /** Rotation as a quaternion (x, y, z, w) of any length above 0. */
  turn: [number, number, number, number];
};

/** Meaning of a failed check. */
export type SeverityWord =
  | /** The result may be wrong. */
  "warning"
  | /** Nobody would accept the result. */
  "error";

/** Answer to an input. */
export type ShapeAnswer = {
  /** Whether the view of the plant is out of date. */
  again: boolean;
  /** Whether a gesture is in progress. */
  busy: boolean;
  /** Motion of the held branch: the shell moves its triangles, which are not made again before the hand lets go. */
  carried: 
    | CarriedPose
    | null;
  /** The edit of a gesture that ended, to be requested as a command. */
  commit: 
    | HandEdit
    | null;
  /** The growth in the hand, as far as it is shown. */
  grown: 
    | Grown
    | null;
  /** Row of the axis that the branch in the hand would be dropped on: once it was pulled off, or slid onto other wood. */
  host: number | null;
  /** The plane of symmetry that was placed. */
  mirror: 
    | Mirror
    | null;
  /** The branch that is meant. */
  picked: 
    | Picked
    | null;
  /** The plane that was placed. */
  plane: 
    | ViewPlane
    | null;
  /** Rotation of the held branch so far, degrees. */
  turned_deg: number | null;
};

/** Commands on the hand edits of a plant. */
export type ShapeCommand =
  | /** Adds an edit after the others. */
  {
    add: HandEdit;
  }
  | /** Replaces the edit of a row. */
  {
    replace: [number, HandEdit];
  }
  | /** Switches the edit of a row off or on. */
  {
    leave: [number, boolean];
  }
  | /** Removes the edits of these rows. */
  {
    remove: number[];
  };

/** Input of a hand. */
export type ShapeInput =
  | /** It went down. */
  {
    down: ShapePointer;
  }
  | /** It moved; several moves at once, so that no point of a stroke is lost. */
  {
    move: ShapePointer[];
  }
  | /** It was lifted. */
  {
    up: ShapePointer;
  }
  | /** It takes everything back. */
  "cancel"
  | /** It turned the held branch, degrees. */
  {
    twist: number;
  }
  | /** A thumb on its touchpad or stick, whose rim is 1, x to the right and y up; none: it was lifted. */
  {
    thumb: [number, number] | null;
  }
  | /** It goes from branch to branch by keys, without a pointer. */
  {
    walk: {
      /** The current branch; none begins with the stems on the ground. */
      from: number | null;
      /** The step. */
      to: ShapeStep;
    };
  }
  | /** A plane is placed: through its tip (without one, its origin), facing it. */
  {
    plane: ShapePointer;
  }
  | /** A plane of symmetry is placed: upright through the foot of the plant's longest stem, between the viewer's hands. */
  {
    mirror: ShapePointer;
  }
  | /** It keeps holding: the growing shoot is a round older. */
  "round"
  | /** The growing shoot has new settings from now on. */
  {
    grow: Growth;
  }
  | /** It changed its brush. */
  {
    brush: {
      /** Density of the branches. */
      density: number;
      /** Radius of the brush, metres. */
      radius_m: number;
    };
  };

/** A pointer in the plant's own coordinates, metres; unit vectors. */
export type ShapePointer = {
  /** Direction of its ray. */
  direction: [number, number, number];
  /** Direction into the view. */
  forward: [number, number, number];
  /** Orientation of that controller, a quaternion: x, y, z, w. */
  hand?: [number, number, number, number] | null;
  /** Start of its ray. */
  origin: [number, number, number];
  /** Pressure, 0 to 1. */
  pressure: number;
  /** Position of the tip of a tracked controller: it works there, and not on a plane. */
  tip?: [number, number, number] | null;
  /** Upward direction of the view. */
  up: [number, number, number];
};

/** Reach of a hand: the largest distance from a branch that is still meant, `metres + per_metre * distance`, and the plane in which its edits are mirrored. */
export type ShapeReach = {
  /** Number of steps from the branch to its bearers. */
  bearers: number;
  /** Distance close by, metres. */
  metres: number;
  /** A plane of symmetry: branches drawn, brushed or grown on one side are mirrored to the other. */
  mirror?: 
    | Mirror
    | null;
  /** Increase with each metre of distance. */
  per_metre: number;
};

/** Step from one branch to another. */
export type ShapeStep =
  | /** The next branch of the same bearer; after the last the first. */
  "next"
  | /** The previous branch of the same bearer. */
  "previous"
  | /** Its bearer. */
  "bearer"
  | /** The first branch that it bears. */
  "borne";

/** The plausible side of a bound. */
export type SideWord =
  | /** The bound or more. */
  "at_least"
  | /** The bound or less. */
  "at_most";

/** Size that plants shall have in the scene, metres. */
export type SizeGoal =
  | /** A height. */
  {
    height: number;
  }
  | /** The larger of the two extents along the ground. */
  {
    width: number;
  }
  | /** A diameter at breast height (1.3 m), of trees. */
  {
    dbh: number;
  };

/** Commands that change a sketch. */
export type SketchCommand =
  | /** Adds moved copies of strokes after the others, with what was said of them. */
  {
    duplicate: [StrokeId[], [number, number]];
  }
  | /** Erases strokes. */
  {
    'remove-strokes': StrokeId[];
  }
  | /** Moves strokes, in the drawing's unit, y up. */
  {
    'move-strokes': [StrokeId[], [number, number]];
  }
  | /** Turns and scales strokes about a point. */
  {
    'turn-strokes': [StrokeId[], StrokeTurn];
  }
  | /** Bends strokes by pulling at them. */
  {
    'pull-strokes': [StrokeId[], StrokePull];
  }
  | /** Smooths strokes once more. */
  {
    'smooth-strokes': StrokeId[];
  }
  | /** Cuts strokes in two at their point nearest to this one. */
  {
    'cut-strokes': [StrokeId[], [number, number]];
  }
  | /** Joins several strokes into one, in the place of the first. */
  {
    'join-strokes': StrokeId[];
  }
  | /** Erases the parts of all strokes that lie within a radius of a path. */
  {
    'rub-out': [[number, number][], number];
  }
  | /** Sets the class of strokes, or leaves it to the classifier again. */
  {
    'set-class': [StrokeId[], 
      | StrokeClass
      | null];
  }
  | /** Sets the mode of strokes. */
  {
    'set-mode': [StrokeId[], StrokeMode];
  }
  | /** Gives strokes a colour, or takes it away. */
  {
    'set-color': [StrokeId[], [number, number, number] | null];
  }
  | /** Sets the width of the pen of strokes, in the drawing's unit, or takes it away. */
  {
    'set-width': [StrokeId[], number | null];
  }
  | /** Gives the organs of strokes a material, or takes it away. */
  {
    'set-material': [StrokeId[], 
      | OrganMaterial
      | null];
  }
  | /** Adds a layer of this name above the others. */
  {
    'add-layer': string;
  }
  | /** Renames, hides or locks the layer of a row, from below. */
  {
    'set-layer': [number, Layer];
  }
  | /** Moves the layer of a row to another row. */
  {
    'move-layer': [number, number];
  }
  | /** Removes the layer of a row; its strokes move to the sheet itself. */
  {
    'remove-layer': number;
  }
  | /** Puts strokes on a layer, by its name, or on the sheet itself. */
  {
    'put-on': [StrokeId[], string | null];
  }
  | /** Erases every stroke, except those on layers that are hidden or locked. */
  "clear"
  | /** Sets how the drawing is interpreted. */
  {
    'set-sketch': SketchSpec;
  }
  | /** Sets how the plant is meshed and coloured. */
  {
    'set-skin': SkinSpec;
  }
  | /** Changes how the photograph lies under the drawing. */
  {
    'place-photo': PhotoPlace;
  }
  | /** Removes the photograph. */
  "remove-photo"
  | /** Shows its flowers on a day, or as they are drawn. */
  {
    'set-day': number | null;
  }
  | /** Takes the leaf of another plant, or its own again. */
  {
    'set-leaf': 
      | PlantId
      | null;
  };

/** All settings of the sketch maker; saved with the document. */
export type SketchSpec = {
  /** Depth of branches. */
  branch_depth: BranchDepth;
  /** Growth inside contours. */
  fill: FillSpec;
  /** Flowers (by index in the reading) that face away from the viewer: orthography cannot tell. */
  flipped_flowers: number[];
  /** Sag of recovered branches under gravity, 0 to 1, default 0. */
  gravity: number;
  /** Height of the plant in metres, above 0. */
  height_m: number | null;
  /** Depth of leaves. */
  leaf_depth: LeafDepth;
  /** Pull of light (upwards) on recovered branches, -1 to 1, default 0. */
  phototropism: number;
  /** Pipe model exponent t of Eq 6, 1.8 to 3. */
  pipe_exponent: number | null;
  /** The kind that every plant is taken for, whatever it looks like. */
  read_as: 
    | Kind
    | null;
  /** Bending of blades. */
  relief: ReliefSpec;
  /** Thinning along an axis. */
  taper: TaperSpec;
};

/** A drawing without its points. */
export type SketchState = {
  /** The day at which its flowers are shown. */
  day: number | null;
  /** Its layers from below upwards. */
  layers: Layer[];
  /** The plant whose leaf it bears. */
  leaf: 
    | PlantId
    | null;
  /** The photograph under it. */
  photo: 
    | PhotoState
    | null;
  /** Settings for reading it. */
  sketch: SketchSpec;
  /** Settings for meshing it. */
  skin: SkinSpec;
  /** Its strokes in the order in which they were drawn. */
  strokes: StrokeState[];
};

/** Settings of a plant's surface. */
export type SkinSpec = {
  /** Fineness: 1 gives about 500 triangles for a branch of average length and 250 to 800 for a drawn blade; counts grow in proportion. */
  detail: number;
  /** Colour of petals whose organs have no colour of their own; `None` picks one by seed and plant name. */
  petals: 
    | PetalColor
    | null;
  /** Sides of an ordinary branch at `detail` 1 or more; thick ones get up to 24. */
  sides: number;
  /** Size in full bloom, metres, of a plant that changes from day to day: fineness is relative to that and not to the day's size, so that triangles are the same on every day. */
  steady_m: number | null;
  /** Give materials procedural textures; without, they have plain colours. */
  textures: boolean;
  /** Variation of hue and brightness from organ to organ, 0 (none) to 1 (default). */
  variation: number;
};

/** Distribution of the light of a sky. */
export type SkyShape =
  | /** Three times as bright at the zenith as at the horizon (Moon and Spencer 1942). */
  "overcast"
  | /** The same everywhere. */
  "uniform"
  | /** Bright around the sun (CIE S 011, type 12). */
  "clear";

/** The class of one stroke, named by the words of the command line's contract. */
export type StrokeClass =
  | /** One petal or leaf as a nearly closed outline. */
  "blade"
  | /** Several petals, fronds or grass blades in one stroke. */
  "corolla"
  | /** A stem, branch, stalk or spine drawn as a line. */
  "axis"
  | /** A trunk (or cactus body or arm) drawn as an outline. */
  "trunk_outline"
  | /** The outline of a tree's crown. */
  "crown"
  | /** A vein or midrib of a blade. */
  "vein"
  | /** The centre of a flower. */
  "disc"
  | /** A flower pot. */
  "pot"
  | /** The ground. */
  "ground"
  | /** A fruit. */
  "fruit"
  | /** Shading, bark lines. */
  "scribble"
  | /** Nothing of the plant. */
  "other";

/** Names one stroke for the lifetime of the document, whatever is drawn or erased around it. */
export type StrokeId = number;

/** Mode in which a stroke was drawn (He and Cheng 2021, section 4.1). */
export type StrokeMode =
  | /** A part of the plant: the stroke is classified. */
  "parts"
  | /** A contour to be filled with twigs. */
  "branch-contour"
  | /** A contour to be filled with leaves. */
  "leaf-contour";

/** A bend of a line by a pull. */
export type StrokePull = {
  /** Point of the grip; the nearest point of the line counts. */
  at: [number, number];
  /** Vector of the pull. */
  by: [number, number];
  /** Reach of the pull along the line, above 0. */
  reach: number;
};

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

/** A stroke without its points. */
export type StrokeState = {
  /** The class that the person set. */
  class: 
    | StrokeClass
    | null;
  /** Its own colour. */
  color: [number, number, number] | null;
  /** Its name within the document. */
  id: StrokeId;
  /** Name of its layer; none for the sheet itself. */
  layer: string | null;
  /** Its own material. */
  material: 
    | OrganMaterial
    | null;
  /** Mode in which it was drawn. */
  mode: StrokeMode;
  /** Class that it was clearly shown as when the last stroke was drawn. */
  shown: 
    | StrokeClass
    | null;
  /** Its own width, in the drawing's unit. */
  width: number | null;
};

/** A rotation and scaling about a point. */
export type StrokeTurn = {
  /** Fixed point, in the drawing's unit. */
  about: [number, number];
  /** Rotation counter-clockwise, degrees. */
  angle_deg: number;
  /** Factors of size along x and y before the turn; a negative one mirrors. */
  scale: [number, number];
};

/** The file formats that hold the structure of a plant, as text. */
export type StructureFormat =
  | /** Multiscale tree graph: axes, nodes and organs as text. */
  "mtg"
  | /** Open Plant Format: axes, internodes and organs with their meshes. */
  "opf"
  | /** Quantitative structure model: a table of cylinders. */
  "qsm"
  | /** Skeleton: points with radii, each with the one that it grows from. */
  "swc";

/** Surface of a measured blade (Wang et al. */
export type SurfaceKind =
  | /** One smooth polynomial of the marks as controls, far from the marks. */
  "bezier"
  | /** A B-spline near the marks. */
  "approximate"
  | /** A B-spline through all marks, with the folds of the blade. */
  "interpolate"
  | /** As approximate, drawn towards thick veins. */
  "nurbs";

/** Eq 7: how an axis thins from base to tip: r(x) = (s^(-alpha x) + m) / (1 + m). */
export type TaperSpec = {
  /** alpha, above 0, default 0.5. */
  alpha: number;
  /** m, 0 or more, default 0: the tip is 0.1 of the base. */
  m: number;
  /** s, above 1, default 100. */
  s: number;
};

/** A picture by its number: its pixels are fetched once. */
export type TextureView = {
  /** Pixels down. */
  height: number;
  /** Its number for [`crate::Workspace::texture`], never reused for another picture. */
  number: number;
  /** Pixels across. */
  width: number;
};

/** Relation of a measured thickness to its vein's ball. */
export type ThicknessRule =
  | /** A calliper's reading: the ball's diameter. */
  "diameter"
  | /** The ball's radius, as the formulas take it. */
  "radius";

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

/** Kind of a tool, with its settings. */
export type ToolKind =
  | /** Point at a branch: it makes no edit. */
  "pick"
  | /** Drag a branch around its base: in the plane that faces the viewer, or after the tip of a controller. */
  "rotate"
  | /** Drag a branch along its bearer, or with the tip of a controller to a new bearer; a branch on the ground, over the ground. */
  "move"
  | /** Drag a copy of a branch to a new bearer; a copy of a branch on the ground, over the ground. */
  "copy"
  | /** Click a branch: it is cut at the clicked place, or removed. */
  {
    prune: {
      /** Whether to remove all of it. */
      whole: boolean;
    };
  }
  | /** Click a branch: another one grows in its place. */
  "regrow"
  | /** Draw a branch from another one. */
  {
    sketch: {
      /** Tilt of the drawing plane away from the viewer, degrees; 0 faces the viewer. */
      tilt_deg: number;
      /** Twigs on it, 0 to 4. */
      twigs: number;
    };
  }
  | /** Brush, and branches grow along the stroke. */
  {
    brush: {
      /** Density, 0.1 to 10. */
      density: number;
      /** Radius at full pressure, metres, above 0. */
      radius_m: number;
    };
  }
  | /** Hold on a branch or on the ground, and a shoot grows by itself, round by round. */
  {
    grow: Growth;
  }
  | /** Draw an outline around the space to be filled. */
  {
    silhouette: {
      /** Density, 0.1 to 10. */
      density: number;
      /** Plane of the outline, if it was placed in space; without it, the plane faces the viewer through the plant's middle. */
      plane?: 
        | ViewPlane
        | null;
      /** Whether parts outside it are cut off. */
      trim: boolean;
    };
  }
  | /** Brush over leaves. */
  {
    leaves: {
      /** Share that stays, 0 to 4. */
      keep: number;
      /** Radius, metres, above 0. */
      radius_m: number;
    };
  };

/** Commands of a tree. */
export type TreeCommand =
  | /** Replaces the spec, for example by that of a preset. */
  {
    'set-spec': [string | null, Json];
  }
  | /** Sets one field of the spec, named by a JSON pointer such as `/method/points`. */
  {
    'set-field': [string, Json];
  }
  | /** Adds an obstacle after the others. */
  {
    'add-obstacle': NamedObstacle;
  }
  | /** Replaces the obstacle of a row. */
  {
    'set-obstacle': [number, NamedObstacle];
  }
  | /** Moves the obstacle of a row by an offset in metres, in the coordinates of the tree. */
  {
    'move-obstacle': [number, [number, number, number]];
  }
  | /** Moves, turns and scales the obstacle of a row, in the coordinates of the tree. */
  {
    'set-down-obstacle': [number, SetDown];
  }
  | /** Renames the obstacle of a row. */
  {
    'rename-obstacle': [number, string];
  }
  | /** Removes the obstacle of a row. */
  {
    'remove-obstacle': number;
  }
  | /** Scales the wood to a height in metres, or leaves it as it grows. */
  {
    'set-height': number | null;
  }
  | /** Sets how the tree is meshed. */
  {
    'set-skin': SkinSpec;
  }
  | /** Takes the leaf of another plant, or its own again. */
  {
    'set-leaf': 
      | PlantId
      | null;
  };

/** Settings of a tree. */
export type TreeState = {
  /** The plant whose leaf it bears. */
  leaf: 
    | PlantId
    | null;
  /** Obstacles that it grows around. */
  obstacles: NamedShape[];
  /** The species that the spec came from. */
  preset: string | null;
  /** Settings for meshing it. */
  skin: SkinSpec;
  /** The spec, without obstacles. */
  spec: Record<string, Json>;
};

/** An influence in one direction: light from above, weight downwards, wind. */
export type Tropism = {
  /** Direction of growth; any length above 0. */
  direction: [number, number, number];
  /** Strength relative to the pull of free space (which is 1), -10 to 10. */
  strength: number;
};

/** A rotation about an axis. */
export type Turn = {
  /** The axis, of any length above 0; right-handed. */
  about: [number, number, number];
  /** The angle. */
  degrees: number;
};

/** The unit of lengths in a file. */
export type Unit =
  | /** Metres, the unit inside. */
  "m"
  | /** Centimetres. */
  "cm"
  | /** Millimetres. */
  "mm"
  | /** International feet. */
  "ft";

/** Which axis of a file points up. */
export type UpAxis =
  | /** +Y, as inside and in glTF. */
  "y"
  | /** +Z, as in Blender and most survey data: file (x, y, z) is inside (x, z, -y). */
  "z";

/** Parameters of an interpolating side vein. */
export type VeinParameters =
  | /** Those of the blade, so that the vein lies on it. */
  "shared"
  | /** The chord lengths of its own marks, as published: vein and blade meet at the marks only. */
  "own";

/** A plane in which an outline is drawn. */
export type ViewPlane = {
  /** Position of the point (0, 0) of the outline, metres. */
  origin: [number, number, number];
  /** Direction to the viewer's right. */
  right: [number, number, number];
  /** Direction upwards as the viewer sees it; made perpendicular to `right`. */
  up: [number, number, number];
};

/** A warning. */
export type WarningView = {
  /** A stable word, such as `unlike-a-plant`. */
  code: string;
  /** Numbers and names in it. */
  fields: Record<string, string>;
  /** A sentence in English. */
  message: string;
};

/** The materials that a person gave to kinds of organs. */
export type WearState = {
  /** Material of all leaves. */
  leaf: 
    | OrganMaterial
    | null;
  /** Material of all petals. */
  petal: 
    | OrganMaterial
    | null;
  /** Material of all sepals and bracts. */
  sepal: 
    | OrganMaterial
    | null;
};

/** The organs that can wear a material. */
export type Wearer =
  | /** Leaves. */
  "leaf"
  | /** Petals. */
  "petal"
  | /** Sepals and bracts. */
  "sepal";

/** Contents of the files of the last export of models. */
export type WrittenFigures = {
  /** Number of halvings of the sides of the textures, to keep within the megabytes. */
  halvings: number;
  /** Level of detail of the first of them: 0, the finest, unless triangles or megabytes are limited. */
  level: number;
  /** Triangles of each level, the finest first, and of the views from all sides; those of copies count each time. */
  triangles: number[];
};
