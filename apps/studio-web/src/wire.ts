// Made by `cargo xtask types` from the types of the crate `workspace`. Change those instead.

/** What has no type of its own here: the page passes it on. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** Every code of a `Refusal`, with its fields. */
export const CODES = {
  "age-beyond": ["name", "end", "age"],
  "archive": ["why"],
  "ball-none": ["row", "mark", "rows"],
  "cancelled": [],
  "class-without-stroke": ["index"],
  "edit-at-fault": ["row", "why"],
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
  "graph-edge": ["edge", "node", "last"],
  "graph-node": ["node"],
  "graph-one-sided": [],
  "graph-radii": ["nodes", "radii"],
  "graph-small": ["nodes"],
  "internal": ["why"],
  "json-ends": [],
  "law": ["why"],
  "layer-closed": ["layer"],
  "layer-name": [],
  "leaf-scan": ["why"],
  "leaf-surface": ["why"],
  "leaf-veins": ["why"],
  "lender-without-leaf": ["name"],
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
  "no-branches": ["maker"],
  "no-clipboard": [],
  "no-drawing": [],
  "no-flowers": ["name"],
  "no-leaf-to-lend": [],
  "no-leaves": [],
  "no-petal-colour": ["word", "known"],
  "no-photo": [],
  "no-picture": [],
  "no-plant": [],
  "no-room": ["found", "wanted"],
  "no-roots": [],
  "no-species": ["name"],
  "no-stroke": [],
  "no-strokes": ["name"],
  "no-such-export": ["format"],
  "no-such-plant": ["plant"],
  "no-such-stroke": ["stroke"],
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

/** What can be asked that is more than one [`document::Command`]. */
export type Action =
  | /** An empty document in the place of this one. */
  "new"
  | /** Adds a plant beside the others and chooses it. */
  {
    add: {
      /** Its maker. */
      maker: NewMaker;
      /** What it is called. */
      name: string;
    };
  }
  | /** Makes a tree or a flower another species. */
  {
    preset: {
      /** The key of the preset. */
      key: string;
      /** The plant. */
      plant: PlantId;
    };
  }
  | /** Puts the plants that a drawing shows in its place, each a drawing of its own. */
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
  | /** What a program remembers of an axis that was picked. */
  {
    mark: Mark;
  }
  | /** By number: which stem of the plant, which of its branches from the base up, and so on; all from 0. */
  {
    path: number[];
  }
  | /** The axis nearest to this point, metres. */
  {
    near: [number, number, number];
  };

/** One control ball moved and rescaled: the place of a mark and the thickness of the veins there. */
export type BallMove = {
  /** How far it is moved: to the right as one looks at the upper side with the tip up, towards the tip, and off the upper side; metres, -10 to 10. */
  by_m: [number, number, number];
  /** Mark of the row from the right margin, 1 to 7, of which 4 is on the midrib; of chief veins the mark from the base. */
  mark: number;
  /** Row of marks from the tip down, from 1, or 0 for the tip; of chief veins the vein from the right margin, from 1. */
  row: number;
  /** The veins there are so many times as thick, 0.05 to 20, default 1. */
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

/** How a branch and what it bears is moved: `p -> to + turn (p - from)`, metres of the plant. */
export type CarriedPose = {
  /** Where it began. */
  from: [number, number, number];
  /** The name of the meshes of which [`Workspace::held_rows`](crate::Workspace::held_rows) are. */
  mesh: number;
  /** Where it begins now. */
  to: [number, number, number];
  /** A unit quaternion: x, y, z, w. */
  turn: [number, number, number, number];
};

/** How plants are carried: sized and turned about a point, then moved. */
export type Carry = {
  /** What stays where it is while they are sized and turned, metres. */
  about: [number, number, number];
  /** Metres. */
  by: [number, number, number];
  /** Times their size, above 0. */
  scale: number;
  /** About +Y, degrees, counter-clockwise seen from above. */
  turn_deg: number;
};

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

/** An sRGB colour, written `#rrggbb`. */
export type Colour = string;

/** What can be asked of a document: of the scene, of any plant, or of a plant of one maker. */
export type Command =
  | /** Plants come and go. */
  {
    scene: SceneCommand;
  }
  | /** Name, seed, place of a plant. */
  {
    plant: [PlantId, PlantCommand];
  }
  | /** Edits by hand of a plant with branches. */
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

/** Where a branch is moved to. */
export type Destination =
  | /** Along its bearer by so many metres, towards the tip if positive; it keeps its angle to the bearer. */
  {
    'slide-m': number;
  }
  | /** Onto a place of another branch, or of its own bearer; it keeps its angle to what bears it. */
  {
    place: {
      /** Where along it, as a share of its length. */
      at: number;
      /** What bears it then. */
      axis: AxisKey;
    };
  }
  | /** By a vector, metres: what stands on the ground is set elsewhere, what is borne slides to the place of its bearer that is nearest to the new base. */
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
  /** The numbers that they go by. */
  numbers: PlantNumbers;
  /** The plants in the order in which they came in. */
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

/** What kind of edit by hand. */
export type EditState = {
  /** Left out for now. */
  off: boolean;
  /** The word of [`burgeon::shape::HandEdit`]. */
  op: string;
};

/** A format that something is written as, by its word. */
export type ExportFormat =
  | /** The meshes of the plants. */
  ModelFormat
  | /** The structure of each plant. */
  StructureFormat
  | /** The current drawing. */
  DrawingFormat;

/** What is exported, and how it is written. */
export type ExportRequest = {
  /** The format. */
  format: ExportFormat;
  /** One more level, the last: views from all sides in one picture, where it is glTF. */
  impostor: boolean;
  /** Levels of detail, 1 to 4: each has about half of the triangles of the one before. */
  levels: number;
  /** All levels in one file, where it is glTF (`MSFT_lod`); else each has its own. */
  one_file: boolean;
  /** Joints and an animation that sways, where it is glTF; each level then has a file of its own. */
  sway: boolean;
  /** The unit of the file. */
  unit: Unit;
  /** The vertical axis of the file. */
  up: UpAxis;
  /** The whole scene, else the current plant. */
  whole: boolean;
  /** How wind moves drawings and trees, where the format has room for it. */
  wind: boolean;
};

/** What an export would write of one level of detail. */
export type ExportView = {
  /** Meshes that a program draws to show all of it. */
  draws: number;
  /** Bytes of the file with this level alone, or of its zip: it was written and counted. */
  file_bytes: number;
  /** The level; 0 is the finest. */
  level: number;
  /** Its meshes; copies share theirs. */
  models: PlantView[];
  /** What it holds, by what it is of. */
  parts: PartFigures[];
  /** Which of them each plant is; none where the one model is all that there is, as it stands. */
  plants: ExportedPlant[];
  /** Their bytes as PNG. */
  texture_bytes: number;
  /** Textures in it or beside it. */
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

/** What a file was. */
export type FileKind =
  | /** Took the document's place. */
  "project"
  | /** Took the document's place. */
  "drawing"
  | /** Is shown. */
  "model"
  | /** Marks that went to a leaf. */
  "leaf"
  | /** A new tree. */
  "tree"
  | /** A new flower that opens. */
  "flower"
  | /** A growth law that went to the current flower. */
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

/** What can be asked of a flower. */
export type FlowerCommand =
  | /** Takes another spec, such as that of a species. */
  {
    'set-spec': [string | null, Json];
  }
  | /** Sets one field of the spec, named by a JSON pointer such as `/whorls/0/count`. */
  {
    'set-field': [string, Json];
  }
  | /** Shows it on a day. */
  {
    'set-day': number;
  }
  | /** Takes a fitted law, or the species' own pace again. */
  {
    'set-law': Json;
  };

/** Which flower, on which day. */
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

/** How a drawing lies in the front view of its plant. */
export type Front = {
  /** Metres of the drawing's unit. */
  metres_per_unit: number;
  /** Where the plant's origin lies in the drawing. */
  x: number;
  /** Where the plant's origin lies in the drawing, y up. */
  y: number;
};

/** What was done in a step. */
export type GestureDeed =
  | /** A hand with a tool. */
  {
    hand: HandDeed;
  }
  | /** The edit was asked for that the last gesture made. */
  "keep"
  | /** The plants were made again, and seen. */
  "seen"
  | /** Another plant was chosen. */
  {
    select: PlantId;
  }
  | /** A command. */
  {
    command: Command;
  }
  | /** What is more than one command, and where it put a plant. */
  {
    action: [Action, number | null];
  }
  | /** What is staged from here on is one step of undo of this name. */
  {
    begin: string;
  }
  | /** In the place of what was staged before. */
  {
    stage: Command;
  }
  | /** What was staged is done. */
  "commit"
  | /** What was staged is taken back. */
  "abandon"
  | /** The last step was taken back. */
  "undo"
  | /** It was done again. */
  "redo";

/** What hands did to the plants of a session, in its order. */
export type GestureRecord = {
  /** The digest of the plant that was worked on last, as it was seen then. */
  digest?: string | null;
  /** The numbers of the project's plants, by which steps name them. */
  numbers?: 
    | PlantNumbers
    | null;
  /** The plant that was worked on first. */
  plant?: 
    | PlantId
    | null;
  /** The project as the hands found it: a `.burgeon` file in base64. */
  project?: string | null;
  /** Always [`GESTURES_SCHEMA`]. */
  schema: string;
  /** The steps. */
  steps: GestureStep[];
};

/** One step. */
export type GestureStep = {
  /** What. */
  did: GestureDeed;
  /** When, ms since the first. */
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
  | /** All over what a brush covers. */
  {
    brush: {
      /** Its way. */
      path: [number, number][];
      /** Its radius, metres. */
      radius_m: number;
    };
  };

/** Where a shoot begins that grows by itself. */
export type GrowFrom =
  | /** On a branch; at its tip, the branch goes on. */
  {
    branch: {
      /** Where along it, as a share of its length. */
      at: number;
      /** The branch. */
      axis: AxisKey;
    };
  }
  | /** On the ground, metres: another stem of the plant. */
  {
    ground: [number, number, number];
  };

/** What grew since a hand holds on, both sides of a plane of symmetry together. */
export type Grown = {
  /** Branches, those shown last. */
  branches: number;
  /** Its density: branches for each metre of new wood; none before any grew. */
  per_metre: number | null;
  /** Its age: rounds of growth. */
  rounds: number;
};

/** How a shoot grows by itself; every number may change while it does. */
export type Growth = {
  /** Between a shoot and the buds at its side, 0 to 180 degrees. */
  angle_deg: number;
  /** How strongly shoots keep apart, 0 to 10. */
  apart: number;
  /** Apical control: the share of the main axis at a fork, 0 to 1. */
  apical: number;
  /** Pull to the light, or of the weight where it is negative, -10 to 10; free space pulls with 1. */
  lift: number;
  /** Vigour per unit of free space, above 0 and at most 100. */
  vigour: number;
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

/** Numbers of [`GuidedSpec`] that change while a tree grows; what is left out stays as it was. */
export type GuidedChange = {
  /** Vigour per unit of free space, above 0 and at most 100. */
  alpha?: number | null;
  /** Between a shoot and the buds at its side, 0 to 180 degrees. */
  branch_angle_deg?: number | null;
  /** Share of the main axis at a fork (apical control), 0 to 1. */
  lambda?: number | null;
  /** Markers of one bud in one round, 4 to 10000. */
  markers?: number | null;
  /** How strongly others' markers push away, 0 to 10. */
  repulsion?: number | null;
  /** The first round that has them, from 0, at most 1000. */
  round: number;
  /** All strokes that guide from then on. */
  strokes?: BrushStroke[] | null;
  /** Weight and light. */
  tropisms?: Tropism[] | null;
};

/** What a hand did with a tool. */
export type HandDeed = {
  /** What the hand did. */
  input: ShapeInput;
  /** How far beside a branch it still was meant. */
  reach: ShapeReach;
  /** The tool, as it was set. */
  tool: ToolKind;
};

/** One edit of a plant by hand. */
export type HandEdit =
  | /** Turns a branch about its base, with all that it bears. */
  {
    /** The branch. */
    axis: AxisKey;
    op: "rotate";
    /** How. */
    turn: Turn;
  }
  | /** Moves a branch with all that it bears. */
  {
    /** The branch. */
    axis: AxisKey;
    op: "move";
    /** Where to. */
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
    /** Where to; also onto the branch itself or onto what it bears. */
    to: Destination;
  }
  | /** Cuts a branch off, with all that it bears beyond the cut. */
  {
    /** Where along it, as a share of its length; 0 (the default) takes all of it. */
    at: number;
    /** The branch. */
    axis: AxisKey;
    op: "prune";
  }
  | /** Cuts a branch off and lets another one grow in the room that it had. */
  {
    /** The branch. */
    axis: AxisKey;
    op: "regrow";
    /** Another number, another branch. */
    seed: number;
  }
  | /** Adds a branch that was drawn in space. */
  {
    /** Where along it, as a share of its length; without, where the line starts nearest to it. */
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
    /** Another number, other twigs. */
    seed: number;
    /** How many twigs grow on it, relative to the plant's habit, 0 (none) to 4; default 1. */
    twigs: number;
  }
  | /** Lets branches grow along a stroke of a brush (the VR paper). */
  {
    /** The branch that they grow from; without, the one nearest to the stroke's start. */
    bearer?: 
      | AxisKey
      | null;
    /** How densely it fills, 0.1 to 10: more markers, more branches; default 1. */
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
    /** Another number, other branches. */
    seed: number;
  }
  | /** Lets a shoot grow by itself, for as many rounds as a hand held on (the VR paper). */
  {
    /** Numbers of growth from some round on, as a hand turned them meanwhile; what they leave out stays as it was, and is that of guided growth at first, with the angles of the plant. */
    changes?: GuidedChange[];
    /** Where it begins. */
    from: GrowFrom;
    /** Makes it on the other side of a plane, too. */
    mirror?: 
      | Mirror
      | null;
    op: "grow";
    /** Rounds of growth. */
    rounds: number;
    /** Another number, other branches. */
    seed: number;
    /** The side on which it leaves its bearer; without, the upper one. */
    towards?: [number, number, number] | null;
  }
  | /** Fills an outline that was drawn in a plane facing the viewer (the VR paper). */
  {
    /** How densely it is filled, 0.1 to 10; default 1. */
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
    /** Another number, other branches. */
    seed: number;
    /** Cuts off what leaves the outline. */
    trim: boolean;
  }
  | /** Takes leaves away, or adds some. */
  {
    /** Share of the leaves that stay, 0 to 1; above 1, to 4: as many times more. */
    keep: number;
    op: "leaf-density";
    /** Where. */
    region: LeafRegion;
    /** Another number, other leaves. */
    seed: number;
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
  /** What lies on it is not seen and not part of the plant. */
  hidden: boolean;
  /** What lies on it stays as it is. */
  locked: boolean;
  /** Its name, unique in the drawing, 1 to 200 characters. */
  name: string;
};

/** One control ball. */
export type LeafBall = {
  /** Where it is, in the coordinates of the leaf, metres. */
  at: [number, number, number];
  /** As in `BallMove`. */
  mark: number;
  /** Of the thickest vein there, metres; 0 where there is none. */
  radius_m: number;
  /** As in `BallMove`. */
  row: number;
};

/** All control balls of a leaf, bent as it is, and the directions in which they are moved. */
export type LeafBalls = {
  /** The tip first, then row by row; of chief veins vein by vein. */
  balls: LeafBall[];
  /** Unit vectors of the first, second and third number of `BallMove::by_m`. */
  sides: [[number, number, number], [number, number, number], [number, number, number]];
};

/** What can be asked of a measured leaf. */
export type LeafCommand =
  | /** Takes other measurements, none of whose control balls was moved. */
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

/** The form of a leaf with one midrib, where nothing was measured. */
export type LeafForm = {
  /** How far both halves are raised along the midrib, degrees, -60 to 60, default 10. */
  fold_deg: number;
  /** Length of the midrib, metres, 0.002 to 10, default 0.1. */
  length_m: number;
  /** How far the margin goes in between the side veins, as a share of the half width: 0 (entire) to 0.8 (deep lobes), default 0. */
  lobes: number;
  /** Angle between side veins and midrib, degrees, 15 to 85, default 50. */
  vein_angle_deg: number;
  /** Pairs of side veins, 2 to 30, default 8. */
  veins: number;
  /** Where it is widest: 0.1 near the base to 0.9 near the tip, default 0.4. */
  widest: number;
  /** Greatest width over length, 0.02 to 2, default 0.5. */
  width: number;
};

/** What colours a measured blade. */
export type LeafPaint =
  | /** Painted by the distance from the veins. */
  "veins"
  | /** One green. */
  "plain";

/** Which leaves are meant. */
export type LeafRegion =
  | /** All. */
  "all"
  | /** Those of a branch and of all that it bears. */
  {
    branch: AxisKey;
  }
  | /** Those within a stroke. */
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

/** How a leaf is made of its marks (Wang et al. */
export type LeafSpec = {
  /** Control balls moved and rescaled by hand (Wang et al. */
  balls: BallMove[];
  /** Round ends on the veins; default false. */
  caps: boolean;
  /** Roll about the midrib: -1 (margins meet below) to 1 (above), 0 as measured, default 0. */
  curl: number;
  /** The form of the leaf where nothing was measured. */
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
  /** What a measured thickness is; default what the file says, else the diameter. */
  thickness: 
    | ThicknessRule
    | null;
  /** Pull of the thickest vein on a NURBS blade, 1 (none) to 100, default 4. */
  vein_weight: number;
  /** Loss of stiffness: 0 as measured to 1 hanging limp, default 0. */
  wilt: number;
};

/** What a leaf is made of. */
export type LeafState = {
  /** Name of the file of marks or veins. */
  file: string;
  /** How the leaf is made of it. */
  settings: LeafSpec;
  /** Its text. */
  text: string;
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

/** What is remembered of an axis. */
export type Mark = {
  /** Where it starts. */
  base: [number, number, number];
  /** From base to tip, a unit vector. */
  direction: [number, number, number];
  /** The axis's own key, hexadecimal. */
  id: string;
  /** Woody or green, stalk or root. */
  kind: KindWord;
  /** Along its course. */
  length: number;
  /** Order of branching, 0 for a trunk. */
  order: number;
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
  /** Normals of its relief, as glTF has them. */
  normal: 
    | TextureView
    | null;
  /** Red is occlusion; green is multiplied with the roughness. */
  orm: 
    | TextureView
    | null;
  /** 0 to 1. */
  roughness: number;
  /** Its picture. */
  texture: 
    | TextureView
    | null;
  /** 0 to 1. */
  translucency: number;
  /** Seen from both sides. */
  two_sided: boolean;
};

/** A plane of symmetry: what is made on one side is made on the other. */
export type Mirror = {
  /** Across it, of any length above 0. */
  normal: [number, number, number];
  /** A point of it, metres. */
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

/** An obstacle with the name under which a person knows it. */
export type NamedObstacle = {
  /** For lists; at most 200 characters. */
  name: string;
  /** The solid. */
  shape: Obstacle;
};

/** An obstacle with its name. */
export type NamedShape = {
  /** For lists. */
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
    /** Its middle. */
    centre: [number, number, number];
    /** Above 0. */
    radius_m: number;
    shape: "sphere";
  }
  | /** An upright cylinder. */
  {
    /** Middle of its base. */
    base: [number, number, number];
    /** Above 0. */
    height_m: number;
    /** Above 0. */
    radius_m: number;
    shape: "cylinder";
  }
  | /** Everything behind a plane: a wall, a slope. */
  {
    /** Away from the solid side; any length above 0. */
    normal: [number, number, number];
    /** Any point of the plane. */
    point: [number, number, number];
    shape: "plane";
  }
  | /** A mesh, in metres, +Y up; small holes and inverted faces are borne (winding number). */
  {
    shape: "mesh";
    /** Corners of each triangle. */
    triangles: [number, number, number][];
    /** Vertices. */
    vertices: [number, number, number][];
  };

/** An obstacle to be shown: a mesh is told by its size only, its corners are asked for. */
export type ObstacleView =
  | /** Any but a mesh. */
  Obstacle
  | /** A mesh. */
  {
    /** Always `mesh`. */
    shape: string;
    /** How many it has. */
    triangles: number;
  };

/** What was opened. */
export type Opened = {
  /** What it was. */
  kind: FileKind;
  /** What it is called. */
  name: string;
  /** Every drawing of the file, at most a thousand. */
  names: string[];
  /** What is odd about it. */
  warnings: WarningView[];
};

/** A material of leaves, petals or sepals. */
export type OrganMaterial = {
  /** How much there is of the second colour, 0 to 1, default 0.5. */
  amount: number;
  /** The first colour; that of most of the organ. */
  color: Colour;
  /** What is painted on it. */
  pattern: Pattern;
  /** Of the pattern `picture`: which. */
  picture: string | null;
  /** 0 is as glossy as wet leaves, 1 as matt as velvet; default 0.6. */
  roughness: number;
  /** The second colour: of veins, streaks, spots, the margin, the root. */
  second: Colour;
};

/** Figures of all meshes of one kind. */
export type PartFigures = {
  /** Bytes of columns and corners, as binary glTF and graphics cards hold them; of copies in binary glTF once. */
  bytes: number;
  /** Meshes that a program draws, those of copies as often as they stand there; 0 where the file is a single mesh. */
  draws: number;
  /** What they are of: bark, leaf, petal, ... */
  kind: string;
  /** Triangles, those of copies as often as they stand there. */
  triangles: number;
  /** Vertices, those of copies as often as they stand there. */
  vertices: number;
};

/** One mesh. */
export type PartView = {
  /** Row of its material. */
  material: number;
  /** Its name in files. */
  name: string;
};

/** What is painted on an organ. */
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

/** The pen that a stroke is drawn with; what is left out is that of every sheet. */
export type PenStyle = {
  /** The colour of what is drawn, sRGB. */
  color: [number, number, number] | null;
  /** The name of the layer. */
  layer: string | null;
  /** In the drawing's unit, above 0. */
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

/** How a photograph lies under the drawing. */
export type PhotoPlace = {
  /** How strongly it shows under the drawing, 0 to 1, default 0.5. */
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

/** How a photograph lies, and its size. */
export type PhotoState = {
  /** Height in the drawing's unit: it follows from the picture. */
  height: number;
  /** Pixels across and down. */
  pixels: [number, number];
  /** As it was asked for. */
  place: PhotoPlace;
};

/** The branch that is meant. */
export type Picked = {
  /** Where along it, a share of its length. */
  at: number;
  /** Its row. */
  axis: number;
  /** Shoots that it bears, and that these bear. */
  bears: number;
  /** A name for edits, where the pointer went down or up. */
  key: 
    | AxisKey
    | null;
  /** Along its course. */
  length_m: number;
  /** 0 for the main axis. */
  order: number;
  /** Where, metres. */
  point: [number, number, number];
  /** Nothing bears it. */
  stands: boolean;
};

/** Where a plant stands: scaled, turned about the vertical, then moved. */
export type Placement = {
  /** Where its origin stands, metres; each coordinate up to 100 km. */
  position: [number, number, number];
  /** Size, 0.001 to 1,000. */
  scale: number;
  /** Turn about +Y, degrees, counter-clockwise seen from above. */
  yaw_deg: number;
};

/** What can be asked of any plant. */
export type PlantCommand =
  | /** Names it. */
  {
    rename: string;
  }
  | /** Sets its seed; text as JSON, because JavaScript's numbers hold 53 bits. */
  {
    'set-seed': string;
  }
  | /** Keeps its seed from dice, or no longer. */
  {
    lock: boolean;
  }
  | /** Takes it out of the view, or back. */
  {
    hide: boolean;
  }
  | /** Puts it into the group of a name; an empty one takes it out of its group. */
  {
    group: string;
  }
  | /** Sets where it stands. */
  {
    place: Placement;
  }
  | /** Keeps it where it stands, or no longer. */
  {
    fix: boolean;
  }
  | /** Gives the organs of a kind a material, or takes it away. */
  {
    wear: [Wearer, 
      | OrganMaterial
      | null];
  };

/** Names one plant for as long as the document lives. */
export type PlantId = number;

/** The numbers that the plants of a document go by: a file keeps none, and commands name plants by them. */
export type PlantNumbers = {
  /** The one that a new plant is given; above all others. */
  next: number;
  /** Of each plant, in the order of the document. */
  plants: PlantId[];
};

/** One plant; of `sketch`, `tree`, `leaf` and `flower` that of its maker is there. */
export type PlantState = {
  /** Edits by hand, in the order in which they are done. */
  edits: EditState[];
  /** Whether it stays where it stands. */
  fixed: boolean;
  /** Of a flower. */
  flower: 
    | FlowerState
    | null;
  /** The group it belongs to; empty for none. */
  group: string;
  /** It is left out of the view. */
  hidden: boolean;
  /** Its name within the document. */
  id: PlantId;
  /** Of a measured leaf. */
  leaf: 
    | LeafState
    | null;
  /** Whether others may bear its leaf. */
  lends: boolean;
  /** Dice leave its seed alone. */
  locked: boolean;
  /** Its maker. */
  maker: MakerWord;
  /** Its name. */
  name: string;
  /** Metres. */
  position: [number, number, number];
  /** Size. */
  scale: number;
  /** As text: JavaScript's numbers hold 53 bits. */
  seed: string;
  /** Of a drawing. */
  sketch: 
    | SketchState
    | null;
  /** Of a tree. */
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
  /** Bud to full bloom, and from there to wilted. */
  days: [number, number] | null;
  /** Why it could not be made; what was made before stays. */
  error: 
    | Refusal
    | null;
  /** Its meshes are others than those of the last view. */
  fresh: boolean;
  /** How a drawing lies in the front view. */
  front: 
    | Front
    | null;
  /** Its name within the document, or [`GUEST`]. */
  id: PlantId;
  /** The entry of the report. */
  item: 
    | ItemReport
    | null;
  /** What they are made of. */
  materials: MaterialView[];
  /** Upper corner of its bounds, metres. */
  max: [number, number, number];
  /** The name of its meshes: plants that have the same share them. */
  mesh: number | null;
  /** Lower corner of its bounds, metres. */
  min: [number, number, number];
  /** What it grows around. */
  obstacles: ObstacleView[];
  /** Its meshes. */
  parts: PartView[];
  /** What was done again. */
  stages: string[];
  /** What was not as one might expect of it. */
  warnings: WarningView[];
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

/** How a ring of the tube is placed. */
export type RingRule =
  | /** A circle of the ball's radius in the plane across the centre line (Wang et al. */
  "plain"
  | /** The circle in which the ball touches the envelope of all balls: the exact surface. */
  "envelope";

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

/** Copies of a plant, and where they are to stand. */
export type Scatter = {
  /** Where. */
  ground: Ground;
  /** How many different plants the copies are, each with a seed of its own; 0 for copies that are all alike. */
  kinds: number;
  /** The plant. */
  plant: PlantId;
  /** Least distance between any two plants, metres; 0.001 to 10,000. */
  spacing_m: number;
  /** How much sizes differ: copies are up to this share smaller or larger; 0 to 0.9. */
  vary: number;
};

/** What can be asked of the scene. */
export type SceneCommand =
  | /** Names the scene. */
  {
    rename: string;
  }
  | /** Adds a moved copy of a plant after the others, metres. */
  {
    duplicate: [PlantId, [number, number, number]];
  }
  | /** Adds moved copies of plants after the others, metres. */
  {
    'duplicate-all': [PlantId[], [number, number, number]];
  }
  | /** Moves, turns and sizes plants as one thing. */
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
  /** In the document's order. */
  plants: PlantView[];
  /** Of the document when it was made. */
  revision: number;
};

/** A thing is made larger and turned about a place, and then moved. */
export type SetDown = {
  /** What is larger and turned from; metres. */
  about: [number, number, number];
  /** Metres. */
  by: [number, number, number];
  /** So many times as large, 0.01 to 100. */
  times: number;
  /** A quaternion (x, y, z, w) of any length above 0. */
  turn: [number, number, number, number];
};

/** What a check that fails means. */
export type SeverityWord =
  | /** The result may be wrong. */
  "warning"
  | /** Nobody would accept the result. */
  "error";

/** What came of an input. */
export type ShapeAnswer = {
  /** What is shown of the plant is out of date. */
  again: boolean;
  /** A gesture is going on. */
  busy: boolean;
  /** How what is held is moved: what is shown of it is to be moved, and is not made again before the hand lets go. */
  carried: 
    | CarriedPose
    | null;
  /** The edit of a gesture that ended: to be asked for as a command. */
  commit: 
    | HandEdit
    | null;
  /** What grows in the hand, as far as it is shown. */
  grown: 
    | Grown
    | null;
  /** On what the branch in the hand would be dropped, a row: once it was pulled off, or where it slid onto other wood. */
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
  /** How far the branch that is held was turned, degrees. */
  turned_deg: number | null;
};

/** What can be asked of the edits by hand of a plant. */
export type ShapeCommand =
  | /** Does one more, after the others. */
  {
    add: HandEdit;
  }
  | /** Does another in the place of that of a row. */
  {
    replace: [number, HandEdit];
  }
  | /** Leaves the edit of a row out, or does it again. */
  {
    leave: [number, boolean];
  }
  | /** Takes those of these rows away. */
  {
    remove: number[];
  };

/** What the hand did. */
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
  | /** It turned what it holds, degrees. */
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
      /** The branch that is meant now; none begins with what stands on the ground. */
      from: number | null;
      /** Where to. */
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
  | /** It holds on: what grows is a round older. */
  "round"
  | /** What grows has other numbers from now on. */
  {
    grow: Growth;
  }
  | /** It changed its brush. */
  {
    brush: {
      /** How many branches it makes. */
      density: number;
      /** How thick it is, metres. */
      radius_m: number;
    };
  };

/** A pointer in the plant's own coordinates, metres; unit vectors. */
export type ShapePointer = {
  /** Along its ray. */
  direction: [number, number, number];
  /** Into the view. */
  forward: [number, number, number];
  /** How that controller is turned, a quaternion: x, y, z, w. */
  hand?: [number, number, number, number] | null;
  /** Where its ray starts. */
  origin: [number, number, number];
  /** 0 to 1. */
  pressure: number;
  /** Where the tip of a tracked controller is: it works there, and not on a plane. */
  tip?: [number, number, number] | null;
  /** Upwards in the view. */
  up: [number, number, number];
};

/** How a hand reaches: how far beside a branch it is still meant, `metres + per_metre * distance`, and where it works a second time. */
export type ShapeReach = {
  /** Not the branch but what bears it, so many up. */
  bearers: number;
  /** Close by. */
  metres: number;
  /** A plane of symmetry: what is drawn, brushed or grown on one side is made on the other. */
  mirror?: 
    | Mirror
    | null;
  /** More with each metre of distance. */
  per_metre: number;
};

/** From one branch to another. */
export type ShapeStep =
  | /** The next that the same branch bears; after the last the first. */
  "next"
  | /** The one before. */
  "previous"
  | /** What bears it. */
  "bearer"
  | /** The first that it bears. */
  "borne";

/** Which side of a bound is plausible. */
export type SideWord =
  | /** The bound or more. */
  "at_least"
  | /** The bound or less. */
  "at_most";

/** What can be asked of a sketch. */
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
  | /** Makes one stroke of several, in the place of the first. */
  {
    'join-strokes': StrokeId[];
  }
  | /** Erases what lies within a radius of a path, of all strokes. */
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
  | /** Sets how wide the pen of strokes is, in the drawing's unit, or takes it away. */
  {
    'set-width': [StrokeId[], number | null];
  }
  | /** Gives what is read from strokes a material, or takes it away. */
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
  | /** Takes the layer of a row away; its strokes go to the sheet itself. */
  {
    'remove-layer': number;
  }
  | /** Puts strokes on a layer, by its name, or on the sheet itself. */
  {
    'put-on': [StrokeId[], string | null];
  }
  | /** Erases every stroke, but those on layers that are hidden or locked. */
  "clear"
  | /** Sets how the drawing is understood. */
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
  | /** Takes the photograph away. */
  "remove-photo"
  | /** Shows its flowers at a day, or as they are drawn. */
  {
    'set-day': number | null;
  }
  | /** Bears the leaf of another plant, or its own again. */
  {
    'set-leaf': 
      | PlantId
      | null;
  };

/** Everything that can be asked of the sketch maker; saved with the document. */
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
  /** What every plant of the drawing is taken for, whatever it looks like. */
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
  /** What lies under it. */
  photo: 
    | PhotoState
    | null;
  /** How it is understood. */
  sketch: SketchSpec;
  /** How it is meshed. */
  skin: SkinSpec;
  /** Its strokes in the order in which they were drawn. */
  strokes: StrokeState[];
};

/** How a plant is given its surface. */
export type SkinSpec = {
  /** Fineness: 1 gives about 500 triangles for a branch of average length and 250 to 800 for a drawn blade; counts grow in proportion. */
  detail: number;
  /** Colour of petals whose organs have no colour of their own; `None` picks one by seed and plant name. */
  petals: 
    | PetalColor
    | null;
  /** Sides of an ordinary branch at `detail` 1 or more; thick ones get up to 24. */
  sides: number;
  /** Of a plant that changes from day to day its size in full bloom, metres: fineness is relative to that and not to the day's, so that triangles are the same at every day. */
  steady_m: number | null;
  /** Give materials procedural textures; without, they have plain colours. */
  textures: boolean;
  /** Variation of hue and brightness from organ to organ, 0 (none) to 1 (default). */
  variation: number;
};

/** What one stroke is. */
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

/** Names one stroke for as long as the document lives, whatever is drawn or erased around it. */
export type StrokeId = number;

/** In which mode a stroke was drawn (He and Cheng 2021, section 4.1). */
export type StrokeMode =
  | /** A part of the plant: what it is, is found out. */
  "parts"
  | /** A contour to be filled with twigs. */
  "branch-contour"
  | /** A contour to be filled with leaves. */
  "leaf-contour";

/** A line bent by pulling at it. */
export type StrokePull = {
  /** Where it was taken hold of; the nearest point of the line counts. */
  at: [number, number];
  /** How far it was pulled. */
  by: [number, number];
  /** How far along the line the pull reaches, above 0. */
  reach: number;
};

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
  /** The name of its layer; none for the sheet itself. */
  layer: string | null;
  /** Its own material. */
  material: 
    | OrganMaterial
    | null;
  /** In which mode it was drawn. */
  mode: StrokeMode;
  /** What it was shown as, clearly, when the last stroke was drawn. */
  shown: 
    | StrokeClass
    | null;
  /** Its own width, in the drawing's unit. */
  width: number | null;
};

/** Turned and scaled about a point. */
export type StrokeTurn = {
  /** What stays where it is, the drawing's unit. */
  about: [number, number];
  /** Counter-clockwise, degrees. */
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

/** A picture by its number: pixels are asked for once. */
export type TextureView = {
  /** Pixels down. */
  height: number;
  /** Its name in [`crate::Workspace::texture`]. */
  number: number;
  /** Pixels across. */
  width: number;
};

/** What a measured thickness is to its vein's ball. */
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

/** What a tool does, with its settings. */
export type ToolKind =
  | /** Point at a branch: it makes no edit. */
  "pick"
  | /** Drag a branch around its base: in the plane that faces the viewer, or wherever the tip of a controller goes. */
  "rotate"
  | /** Drag a branch along its bearer, or with the tip of a controller to whatever bears it then; what stands on the ground, over the ground. */
  "move"
  | /** Drag a copy of a branch to whatever bears it then; of what stands on the ground, over the ground. */
  "copy"
  | /** Click a branch: it is cut where it was clicked, or all of it. */
  {
    prune: {
      /** All of it. */
      whole: boolean;
    };
  }
  | /** Click a branch: another one grows in its place. */
  "regrow"
  | /** Draw a branch from another one. */
  {
    sketch: {
      /** How far the drawing plane leans back from the viewer, degrees; 0 faces the viewer. */
      tilt_deg: number;
      /** Twigs on it, 0 to 4. */
      twigs: number;
    };
  }
  | /** Brush, and branches grow along the stroke. */
  {
    brush: {
      /** 0.1 to 10. */
      density: number;
      /** Radius at full pressure, metres, above 0. */
      radius_m: number;
    };
  }
  | /** Hold on a branch or on the ground, and a shoot grows by itself, round by round. */
  {
    grow: Growth;
  }
  | /** Draw an outline around what is to be filled. */
  {
    silhouette: {
      /** 0.1 to 10. */
      density: number;
      /** Where it is drawn, if that was placed in space; without, it faces the viewer and lies in the plant's middle. */
      plane?: 
        | ViewPlane
        | null;
      /** Cut off what leaves it. */
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

/** What can be asked of a tree. */
export type TreeCommand =
  | /** Takes another spec, such as that of a preset. */
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
  | /** Moves the obstacle of a row by so many metres, in the coordinates of the tree. */
  {
    'move-obstacle': [number, [number, number, number]];
  }
  | /** Sets the obstacle of a row down elsewhere, turned and larger or smaller, in the coordinates of the tree. */
  {
    'set-down-obstacle': [number, SetDown];
  }
  | /** Names the obstacle of a row. */
  {
    'rename-obstacle': [number, string];
  }
  | /** Takes the obstacle of a row away. */
  {
    'remove-obstacle': number;
  }
  | /** Sets how it is meshed. */
  {
    'set-skin': SkinSpec;
  }
  | /** Bears the leaf of another plant, or its own again. */
  {
    'set-leaf': 
      | PlantId
      | null;
  };

/** What a tree is grown from. */
export type TreeState = {
  /** The plant whose leaf it bears. */
  leaf: 
    | PlantId
    | null;
  /** What it grows around. */
  obstacles: NamedShape[];
  /** The species that the spec came from. */
  preset: string | null;
  /** How it is meshed. */
  skin: SkinSpec;
  /** The spec, without obstacles. */
  spec: Record<string, Json>;
};

/** A pull in one direction: light from above, weight downwards, wind. */
export type Tropism = {
  /** Where to; any length above 0. */
  direction: [number, number, number];
  /** Relative to the pull of free space (which is 1), -10 to 10. */
  strength: number;
};

/** A rotation about an axis. */
export type Turn = {
  /** The axis, of any length above 0; right-handed. */
  about: [number, number, number];
  /** How far. */
  degrees: number;
};

/** The unit of lengths in a file. */
export type Unit =
  | /** Metres, the unit inside. */
  "m"
  | /** Centimetres. */
  "cm"
  | /** Millimetres. */
  "mm";

/** Which axis of a file points up. */
export type UpAxis =
  | /** +Y, as inside and in glTF. */
  "y"
  | /** +Z, as in Blender and most survey data: file (x, y, z) is inside (x, z, -y). */
  "z";

/** Which parameters an interpolating side vein has. */
export type VeinParameters =
  | /** Those of the blade, so that the vein lies on it. */
  "shared"
  | /** The chord lengths of its own marks, as published: vein and blade meet at the marks only. */
  "own";

/** A plane in which an outline is drawn. */
export type ViewPlane = {
  /** Where (0, 0) of the outline lies, metres. */
  origin: [number, number, number];
  /** To the viewer's right. */
  right: [number, number, number];
  /** Upwards as the viewer sees it; made to stand at a right angle to `right`. */
  up: [number, number, number];
};

/** What was not as one might expect. */
export type WarningView = {
  /** A word that stays, such as `unlike-a-plant`. */
  code: string;
  /** Numbers and names in it. */
  fields: Record<string, string>;
  /** A sentence in English. */
  message: string;
};

/** The materials that a person gave to kinds of organs. */
export type WearState = {
  /** Of all leaves. */
  leaf: 
    | OrganMaterial
    | null;
  /** Of all petals. */
  petal: 
    | OrganMaterial
    | null;
  /** Of all sepals and bracts. */
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
