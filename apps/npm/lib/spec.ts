// Made by `cargo xtask types` from the types of the crate. Change those instead.

/** What has no type of its own here. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** The species of trees. */
export const TREES = [
  'pine',
  'terminalia',
  'chinese-fir',
  'oak',
  'oak-colonization',
  'oak-lsystem',
  'birch',
  'lime',
  'maple',
  'spruce',
  'willow',
  'poplar',
  'palm',
  'bamboo',
  'hazel',
  'dead-oak',
  'alder',
  'umbrella-pine',
  'cypress',
  'cherry',
  'rose',
  'grass',
  'beech',
  'cedar',
  'ash',
  'elm',
  'plane-tree',
  'apple',
  'olive',
  'larch',
  'yew',
  'ginkgo',
  'eucalyptus',
  'acacia',
  'magnolia-tree',
  'plum',
  'juniper',
  'date-palm',
  'tree-fern',
  'banana',
  'maize',
  'saguaro',
  'wheat',
  'lavender',
  'reed',
  'baobab',
  'agave',
  'fig',
  'mangrove',
  'boston-ivy',
] as const;

/** The species of flowers. */
export const FLOWERS = [
  'rose',
  'lily',
  'tulip',
  'sunflower',
  'clivia',
  'peony',
  'magnolia',
  'cherry-blossom',
  'iris',
  'daisy',
  'poppy',
  'morning-glory',
  'orchid',
  'dandelion',
  'water-lily',
] as const;

/** The parts of plants, by the numbers in tables. */
export const PARTS = [
  'branch',
  'twig',
  'stem',
  'petiole',
  'root',
  'leaf',
  'petal',
  'disc',
  'fruit',
  'stamen',
  'pistil',
  'thorn',
  'pedicel',
  'sepal',
  'anther',
  'floret',
  'body',
  'pot',
  'stub',
  'soil',
  'stone',
] as const;

/** Fruits with a parachute each, all around the head: a dandelion's clock. */
export type Achenes = {
  /** Linear colour of the fruits. */
  color?: [number, number, number];
  /** Number of fruits, 0 to 400, default none. */
  count?: number;
  /** Radius of the head that bears them, metres, default 0.004. */
  head_m?: number;
  /** From the head to the parachute, metres, default 0.016. */
  length_m?: number;
};

/** Arrangement of the petals of a ring in the bud. */
export type Aestivation =
  | /** Each has one edge over and one under its neighbours. */
  "contorted"
  | /** One within the other along a spiral, the outermost first: of five, two lie outside and two inside (quincuncial). */
  "imbricate"
  | /** Edge to edge; none covers another. */
  "valvate"
  | /** Grown together to a tube or funnel. */
  "fused";

/** Arrangement of buds or leaves around their axis. */
export type Arrangement =
  | /** One per node, turned by the divergence from the one before. */
  {
    /** Divergence, degrees; 137.5 in most plants. */
    divergence_deg: number;
    kind: "spiral";
  }
  | /** One per node, in two rows. */
  {
    kind: "distichous";
  }
  | /** Two per node, all in one plane. */
  {
    kind: "opposite";
  }
  | /** Two per node, each pair at right angles to the one before. */
  {
    kind: "decussate";
  }
  | /** Several per node, 2 to 12. */
  {
    /** Number of members of a whorl. */
    count: number;
    kind: "whorled";
  };

/** One control ball moved and rescaled: the position of a mark and the thickness of the veins there. */
export type BallMove = {
  /** Offset to the right as seen on the upper side with the tip up, towards the tip, and off the upper side; metres, -10 to 10. */
  by_m?: [number, number, number];
  /** Mark of the row from the right margin, 1 to 7, where 4 is on the midrib; for chief veins the mark from the base. */
  mark?: number;
  /** Row of marks from the tip down, from 1, or 0 for the tip; for chief veins the vein from the right margin, from 1. */
  row?: number;
  /** Factor on the thickness of the veins there, 0.05 to 20, default 1. */
  thickness?: number;
};

/** Kind of bark. */
export type Bark =
  | /** Ridges and furrows along the trunk: oak, poplar, willow. */
  "furrowed"
  | /** Without plates: beech, young trees, shrubs. */
  "smooth"
  | /** Large flakes with dark cracks: pine, plane. */
  "plated"
  | /** White paper with dark stripes across: birch. */
  "birch"
  | /** Glossy bands with raised pores across, which peel: cherry. */
  "cherry"
  | /** Rings that fallen leaves have left: palm. */
  "ringed"
  | /** Smooth and jointed: bamboo. */
  "cane"
  | /** Green ribs with rows of spines on them: columnar cacti. */
  "ribbed";

/** The shape of a leaf blade, defined by a formula. */
export type BladeForm =
  | /** Broadest below the middle, drawn-out tip: pear, birch, poplar. */
  "ovate"
  | /** Broadest in the middle: beech. */
  "elliptic"
  | /** Broadest above the middle: Terminalia, magnolia. */
  "obovate"
  | /** Narrow: willow, olive, bamboo. */
  "lanceolate"
  | /** Heart-shaped: lime. */
  "cordate"
  | /** Nearly a triangle on a broad base: poplar, birch. */
  "deltoid"
  | /** Round lobes on both sides: oak. */
  "lobed"
  | /** Five pointed lobes from one place: maple, plane. */
  "palmate"
  | /** Five blunt lobes from one place, deep notches between them: fig. */
  "fingered"
  | /** Three pointed lobes, broad and toothed: Boston ivy, grape. */
  "tricuspid"
  | /** A fan on a wedge, with a notch in the middle: ginkgo. */
  "fan"
  | /** Leaflets in pairs along a midrib: ash, walnut, rowan. */
  "pinnate"
  | /** A feather of many narrow leaflets, or one feather of a larger leaf: acacia, fern. */
  "feather"
  | /** A long narrow leaflet: palm, grass. */
  "leaflet"
  | /** One needle. */
  "needle"
  | /** A bundle of needles that spread from one place: pine, larch. */
  "tuft"
  | /** A shoot with side shoots, all in needles or scales: fir, spruce, yew, cypress. */
  "spray"
  | /** The end of a shoot in long needles, a third of its length, that lean forward: pine. */
  "brush";

/** A leaf's form. */
export type BladeSpec = {
  /** Downward bend of the tip, as a share of the length, -1 to 1; default the form's. */
  bend?: number | null;
  /** A leaf of your own instead of the form: marks (.csv), a vein graph (.json) or a model of one leaf (.glb, .obj, .ply, .stl), relative to the spec. */
  file?: string | null;
  /** Slope of the halves along the midrib, -1 to 2; default the form's. */
  fold?: number | null;
  /** The form, default ovate. */
  form?: BladeForm;
  /** For a spray: length of a needle or scale relative to that of the spray, 0.01 to 0.6; default 0.1. */
  needle?: number | null;
  /** For a spray: side shoots on each side, 0 to 12; default 3. */
  shoots?: number | null;
  /** Teeth of the margin on each side, 0 to 60; default none. */
  teeth?: number | null;
  /** Width relative to the form's usual, 0.1 to 4; default 1. */
  width?: number | null;
};

/** Flowers of a tree, in the place of leaves. */
export type BlossomSpec = {
  /** Colour of petals, default a white. */
  color?: Colour;
  /** Colour towards which single flowers vary; default none. */
  color_to?: 
    | Colour
    | null;
  /** Diameter of an open flower, metres, default 0.035. */
  diameter_m?: number;
  /** Angle by which the outermost petals open from the flower's axis, degrees, 5 to 90, default 76; about 30 for a goblet. */
  open_deg?: number;
  /** Width of a petal relative to that which closes the whorl, 0.1 to 1.5, default 1; less for spikelets and plumes. */
  petal_width?: number;
  /** Petals of a flower's whorl, 3 to 12, default 5. */
  petals?: number;
  /** Share of the leaves' places that bear a flower instead, 0 to 1, default 0: no flowers except those that rules set. */
  share?: number;
  /** Mean length of a flower's stalk relative to its diameter, 0.02 to 3, default 0.7. */
  stalk?: number;
  /** Width of the tuft of stamens relative to that of the flower, 0 to 1, default 0.3; 0: none is visible. */
  tuft?: number;
  /** Whorls of petals, one within the other, 1 to 6, default 1; 3 and more make a double flower such as a rose's. */
  whorls?: number;
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
  pull?: number;
  /** Radius, metres, above 0: one number, or one for each point. */
  radius_m: number[];
};

/** Arrangement of the flowers of a cluster. */
export type Cluster = {
  /** Angle by which the axis arches over, degrees, 0 to 120, default 0. */
  arch_deg?: number;
  /** Length of the axis that bears a raceme or a spike, metres, default 0. */
  axis_m?: number;
  /** Its kind. */
  form?: ClusterForm;
  /** Length of the stalk of one flower, metres; 0, the default, for one that fits the flower. */
  pedicel_m?: number;
  /** Share to which all flowers turn to the front, from 0, evenly around, to 1; default 0. */
  sided?: number;
  /** Days from the first flower that opens to the last, 0 to 60, default 0. */
  spread_days?: number;
  /** Widest angle of the stalks of flowers to the axis, degrees, 0 to 150, default 75. */
  spread_deg?: number;
};

/** Kinds of clusters. */
export type ClusterForm =
  | /** All stalks from one point; outer flowers open first. */
  "umbel"
  | /** Flowers along an axis, each on a stalk; lower ones open first. */
  "raceme"
  | /** Flowers along an axis, without stalks. */
  "spike";

/** Settings of the growth towards attraction points. */
export type ColonizeSpec = {
  /** Distance `d_i` within which a joint perceives a point, metres, above 0, default 1. */
  attraction_m?: number;
  /** Share of the last direction kept in each step, 0 to 10, default 0. */
  inertia?: number;
  /** Distance `d_k` at which a point is consumed, metres, above 0 and at most `attraction_m` (otherwise that is raised to it, with a warning), default 0.4. */
  kill_m?: number;
  /** Growth stops, with a warning, at this many joints; 1 to 2^31, default 4 million. */
  max_joints?: number;
  /** Whether a point steers one step before it is consumed, as in Yang et al. */
  steer_before_kill?: boolean;
  /** Length D of one step, metres; default half of `kill_m`. */
  step_m?: number | null;
  /** Other directions of growth: light, gravity, wind. */
  tropisms?: Tropism[];
};

/** An sRGB colour, written `#rrggbb`. */
export type Colour = string;

/** The disc of florets in the middle of a flower head. */
export type Disc = {
  /** Height of the dome as a share of its radius, 0 to 1.5, default 0.3. */
  dome?: number;
  /** Linear colour of the dome under the florets and of withered florets. */
  dry_color?: [number, number, number];
  /** Florets, 10 to 1000, default 280. */
  florets?: number;
  /** Linear colour of open florets with their pollen. */
  open_color?: [number, number, number];
  /** Linear colour of florets that are still closed. */
  young_color?: [number, number, number];
};

/** The space that a crown may fill. */
export type Envelope =
  | /** A ball. */
  {
    /** Its centre. */
    centre: [number, number, number];
    /** Its radius, above 0. */
    radius_m: number;
    shape: "sphere";
  }
  | /** A ball stretched along the axes. */
  {
    /** Its centre. */
    centre: [number, number, number];
    /** Half its extents, each above 0. */
    radii_m: [number, number, number];
    shape: "ellipsoid";
  }
  | /** An upright cone, its point up. */
  {
    /** Centre of its base. */
    base: [number, number, number];
    /** Its height, above 0. */
    height_m: number;
    /** Radius of its base, above 0. */
    radius_m: number;
    shape: "cone";
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
  | /** A surface of revolution about the vertical through `base`. */
  {
    /** Origin of the heights of the profile. */
    base: [number, number, number];
    /** `(radius, height)`, at least 2 points, heights rising, radii 0 or more. */
    profile: [number, number][];
    shape: "revolution";
  }
  | /** A closed outline drawn in the plane z = `centre_z`; across the plane each height is as deep as it is wide. */
  {
    /** The plane of the drawing. */
    centre_z_m: number;
    /** Depth over width, above 0; 1 gives round sections. */
    depth: number;
    /** The outline, at least 3 points. */
    polygon: [number, number][];
    shape: "outline";
  }
  | /** A closed mesh. */
  {
    shape: "mesh";
    /** Corners of each triangle. */
    triangles: [number, number, number][];
    /** Vertices. */
    vertices: [number, number, number][];
  }
  | /** A cloud of points: the space within `reach_m` of any of them. */
  {
    /** The points, at least one of them usable. */
    points: [number, number, number][];
    /** Distance from a point up to which the space counts, above 0. */
    reach_m: number;
    shape: "points";
  }
  | /** Masses of foliage on limbs, drawn anew for each seed. */
  {
    /** Distance from mass to mass along a limb, in radii of a mass, 0.3 to 6, default 1.3. */
    apart?: number;
    /** Share of each limb, from the trunk on, that bears no mass, 0 to 0.95, default 0.4: the shaded inside. */
    bare?: number;
    /** Height above the root at which the profile starts, 0 to 1e6. */
    base_m: number;
    /** Bend of the limbs, -1 (their ends hang) to 1 (they turn up), default 0. */
    bend?: number;
    /** Crookedness of trunk and limbs, 0 (straight) to 1, default 0.2. */
    crook?: number;
    /** Height of a mass over its width, 0.05 to 3, default 0.7: small values make layers. */
    flat?: number;
    /** Share of the crown's height up to which the trunk does not fork, 0 to 1, default 1: a spruce has 1, an oak a half. */
    leader?: number;
    /** Limbs of a tree, 1 to 400; `variation.limbs` sets how much trees differ. */
    limbs: number;
    /** Radius of a mass of foliage, above 0. */
    mass_m: number;
    /** Profile that the crown fills: `(radius, height)`, at least 2 points, heights rising, radii 0 or more. */
    profile: [number, number][];
    /** Angle of limbs at the trunk at the foot of the crown and at its top, degrees above the horizontal, -60 to 85, default 20 and 60. */
    rise_deg?: [number, number];
    shape: "limbs";
    /** Vertical distance between whorls of limbs, metres; default none: limbs stand in a spiral. */
    whorl_m?: number | null;
  };

/** Fate of the petals at the end. */
export type Fate =
  | /** They wither in place. */
  "cling"
  | /** They fall, one after another, and lie on the ground. */
  "drop"
  | /** They fall and disappear: for flowers high above the ground. */
  "gone";

/** Eq 2: growth of twigs and midribs inside a contour. */
export type FillSpec = {
  /** Attraction along the bearer, `k_b`. */
  bearer_pull?: number;
  /** Attraction by the contour, `k_p`. */
  contour_pull?: number;
  /** How many twigs and leaves relative to the default, 0.1 to 10, default 1. */
  density?: number;
  /** Memory of the last direction, `k_m`. */
  memory?: number;
  /** Named coefficients. */
  set?: 
    | PullSet
    | null;
  /** Pull against gravity on grown twigs, -1 (weeping) to 1 (upright), default 0.1. */
  tropism?: number;
};

/** A flower that opens. */
export type FlowerSpec = {
  /** Fruits with a parachute each, as dandelions have; default none. */
  achenes?: Achenes;
  /** Arrangement of the flowers of a cluster. */
  cluster?: Cluster;
  /** Appearance of the disc. */
  disc?: Disc;
  /** Radius of a disc of florets, metres; 0, the default, for none. */
  disc_m?: number;
  /** The ovary and the fruit that grows from it; default none. */
  fruit?: Fruit;
  /** Its leaves, one kind after the other. */
  leaves?: Foliage[];
  /** Resolution of the mesh of a petal. */
  mesh?: PetalMesh;
  /** Name of the species. */
  name?: string;
  /** Angle by which the open flower nods, degrees, 0 to 120, default 0. */
  nod_deg?: number;
  /** Nodding of bud and wilted flower relative to the open one. */
  nods?: Nods;
  /** Days from bud to full bloom, 0.1 to 60, default 6. */
  opening_days?: number;
  /** Linear colour of the pistil. */
  pistil_color?: [number, number, number];
  /** Length of the pistil, metres; 0, the default, for none. */
  pistil_m?: number;
  /** Radius of its style, metres, 0 to 0.05; 0, the default, for one that fits its length. */
  pistil_radius_m?: number;
  /** Share of the style that falls as the fruit grows, 0 to 1, default 0. */
  pistil_shed?: number;
  /** Rate of the flower's own growth law, per day, 0.01 to 100, default 0.95. */
  rate_per_day?: number;
  /** Share of the wilting in which the fruit ripens, 0 to 0.9, default 0: the flower ends with withered petals. */
  ripening?: number;
  /** Linear colour of the stalk. */
  stalk_color?: [number, number, number];
  /** Length of the stalk, metres, 0 to 5, default 0.25; 0 for a flower without one, such as one that is put on a plant. */
  stalk_m?: number;
  /** Radius of the stalk, metres, 0 to 0.1; 0, the default, for one that fits the flower. */
  stalk_radius_m?: number;
  /** Stamens; default none. */
  stamens?: Stamens;
  /** Flowers of an umbel or another cluster, 1 to 200; 1, the default, for a single flower. */
  umbel?: number;
  /** Rings of petals, outermost first. */
  whorls?: Whorl[];
  /** Days from full bloom to wilted, 0.1 to 40, default 4. */
  wilting_days?: number;
};

/** Leaves of one kind. */
export type Foliage = {
  /** Angle to the stalk at base, middle and tip, degrees. */
  angle_deg?: [number, number, number];
  /** Leaves at one node, 1 to 12, default 1. */
  at_node?: number;
  /** Width at the base as a share of the greatest, 0 to 1, default 0.1. */
  base?: number;
  /** Linear colour. */
  color?: [number, number, number];
  /** Number of leaves, 1 to 200, default 3. */
  count?: number;
  /** Angle from one node to the next about the stalk, degrees, default 137.5. */
  divergence_deg?: number;
  /** Angle by which both halves are raised, degrees, -60 to 80, default 12. */
  fold_deg?: number;
  /** Place of the lowest on the stalk as a share of its length, 0 to 1, default 0. */
  from?: number;
  /** Distance between neighbours, one within the other, if several stand at one place, metres, default 0. */
  gap_m?: number;
  /** Length of the basal lobes on both sides of the stalk, as a share of the blade's length, 0 to 0.6, default 0. */
  heart?: number;
  /** Leaflets of a pinnate leaf, 1 to 21, default 1: a simple leaf. */
  leaflets?: number;
  /** Length of the blade, or of a leaflet, metres, default 0.08. */
  length_m?: number;
  /** Their depth as a share of half the width, 0 to 0.9, default 0. */
  lobe_depth?: number;
  /** Lobes or teeth per side, 0 to 20, default 0. */
  lobes?: number;
  /** Length of the stalk of the leaf, metres, default 0. */
  petiole_m?: number;
  /** Turn of the first about the stalk, degrees, default 0. */
  phase_deg?: number;
  /** Pointedness of the tip, 0 round to 1, default 0.9. */
  point?: number;
  /** Reduction of the size of the last ones, as a share, 0 to 0.9, default 0. */
  smaller?: number;
  /** Reduction of the angle of the last ones, which stand steeper, as a share, 0 to 1, default 0. */
  steeper?: number;
  /** Place of the highest, 0 to 1, default 0. */
  to?: number;
  /** Place of the greatest width along the blade, 0.1 to 0.9, default 0.4. */
  widest?: number;
  /** Greatest width, metres, default 0.03. */
  width_m?: number;
};

/** Settings of the leaves of a tree. */
export type FoliageSpec = {
  /** Angle between shoot and blade, degrees, 0 to 180, default 55. */
  angle_deg?: number;
  /** Arrangement around the shoot, default a golden spiral. */
  arrangement?: Arrangement;
  /** Droop of the blades, -1 to 1 (all down), default 0.15. */
  droop?: number;
  /** Concentration of leaves towards the tip of their shoot, 0 (evenly, the default) to 0.95: the nodes at its tip are `1 - gather` times as far from each other as `spacing_m`, those at its foot `1 + gather` times. */
  gather?: number;
  /** Share of the leaves kept, the best lit ones, 0 to 1; default 1. */
  leaf_keep?: number;
  /** Length of a blade, metres, above 0, default 0.09. */
  length_m?: number;
  /** Most leaves that are considered, default 2 million. */
  max_leaves?: number;
  /** Largest radius of shoots that bear leaves, metres; default 0.009: two of the usual tips. */
  max_radius_m?: number;
  /** Light below which leaves fall in any case, 0 or more (full light is 1), default 0. */
  min_light?: number;
  /** Whether a leaf is shaded by its own shadow, as in the paper (Palubicki adds it back). */
  self_shadow?: boolean;
  /** Contribution of a leaf to the shadow of its own voxel (k of Eq 5), above 0, default 0.03. */
  shade?: number;
  /** Factor by which the shadow decreases from layer to layer (b of Eq 5), above 1, default 1.8. */
  shade_fall?: number;
  /** Layers below a leaf that it shades, 1 to 32, default 6. */
  shade_layers?: number;
  /** Standard deviation of the length as a share of it, 0 to 0.5, default 0.1. */
  size_variation?: number;
  /** Distance between two nodes of a shoot, metres, above 0, default 0.06. */
  spacing_m?: number;
  /** Side of a voxel, metres; default two blade lengths. */
  voxel_m?: number | null;
  /** Width over length of the blade that `blade` makes, 0.01 to 3, default 0.5. */
  width?: number;
};

/** The ovary and the fruit that grows from it. */
export type Fruit = {
  /** It grows below petals and sepals (an inferior ovary, a hip). */
  below?: boolean;
  /** Radius of a cap of stigmas on it, as a share of its own, 0 to 1.2, default 0. */
  cap?: number;
  /** Linear colour of the ovary. */
  color?: [number, number, number];
  /** Length of the ripe fruit, metres; 0, the default, for none. */
  length_m?: number;
  /** Size of the ovary in full bloom as a share of the ripe fruit, 0.05 to 1, default 0.4. */
  ovary?: number;
  /** Number of ribs around it, 0 to 20, default 0. */
  ribs?: number;
  /** Linear colour of the ripe fruit. */
  ripe_color?: [number, number, number];
  /** Place of the greatest width, 0.2 to 0.8, default 0.5. */
  widest?: number;
  /** Its greatest width, metres, default 0.01. */
  width_m?: number;
};

/** A mark on petals that guides visitors to the nectar. */
export type Guide = {
  /** Its linear colour. */
  color?: [number, number, number];
  /** Number of lines, 0 to 9; 0, the default, for a blotch. */
  lines?: number;
  /** Reach from the base along the petal, 0 to 1; 0, the default, for none. */
  reach?: number;
  /** Strength, 0 to 1, default 1. */
  strength?: number;
  /** Width across the petal, 0 to 1, default 1. */
  width?: number;
};

/** Numbers of `GuidedSpec` that change while a tree grows; numbers that are left out stay. */
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
  round?: number;
  /** All guiding strokes from then on. */
  strokes?: BrushStroke[] | null;
  /** Weight and light. */
  tropisms?: Tropism[] | null;
};

/** The innermost of several rings, relative to the outermost; the rings between are interpolated. */
export type Innermost = {
  /** Delay of its opening, as a share of the opening, 0 to 0.6, default 0. */
  delay?: number;
  /** Additional height of its insertion, metres, 0 to 1, default 0.002. */
  height_m?: number;
  /** Share by which it opens and wilts from the bud, 0 to 1, default 1. */
  open?: number;
  /** Distance from the axis as a share, 0 to 1, default 0.7. */
  radius?: number;
  /** Size of its petals as a share, 0.05 to 2, default 1. */
  size?: number;
};

/** Insertion of the petals of a whorl. */
export type Insertion = {
  /** Height above the base of the flower, metres. */
  height_m: number;
  /** Distance from the axis, metres. */
  radius_m: number;
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

/** How the depth of leaves is found (He and Cheng 2021, section 5.3). */
export type LeafDepth =
  | /** The light prior as printed: every leaf turns to the same side. */
  "paper"
  | /** The light prior with left and right kept. */
  "signed"
  | /** The front view of the model is the drawing; the blade leaves the plane by tilt and bend only. */
  "drawn";

/** The form of a leaf with one midrib, used if nothing was measured. */
export type LeafForm = {
  /** Angle by which both halves are raised along the midrib, degrees, -60 to 60, default 10. */
  fold_deg?: number;
  /** Length of the midrib, metres, 0.002 to 10, default 0.1. */
  length_m?: number;
  /** Depth of the margin between the side veins, as a share of the half width: 0 (entire) to 0.8 (deep lobes), default 0. */
  lobes?: number;
  /** Angle between side veins and midrib, degrees, 15 to 85, default 50. */
  vein_angle_deg?: number;
  /** Pairs of side veins, 2 to 30, default 8. */
  veins?: number;
  /** Position of the greatest width: 0.1 near the base to 0.9 near the tip, default 0.4. */
  widest?: number;
  /** Greatest width over length, 0.02 to 2, default 0.5. */
  width?: number;
};

/** Colouring of a measured blade. */
export type LeafPaint =
  | /** Painted by the distance from the veins. */
  "veins"
  | /** One green. */
  "plain";

/** Construction of a leaf from its marks (Wang et al. */
export type LeafSpec = {
  /** Control balls moved and rescaled by hand (Wang et al. */
  balls?: BallMove[];
  /** Round ends on the veins; default false. */
  caps?: boolean;
  /** Roll about the midrib: -1 (margins meet below) to 1 (above), 0 as measured, default 0. */
  curl?: number;
  /** Form of the leaf if nothing was measured. */
  form?: LeafForm;
  /** Length of the midrib for a vein graph in pixels, metres, 0.002 to 10, default 0.1. */
  length_m?: number;
  /** A vein along the margin too; default false. */
  margin_vein?: boolean;
  /** Parameters of interpolating side veins. */
  parameters?: VeinParameters;
  /** Rings of the veins. */
  rings?: RingRule;
  /** Points around a vein, 3 to 64, default 10. */
  sides?: number;
  /** Parts of each span between marks, 1 to 64, default 5. */
  subdivisions?: number;
  /** Surface of the blade. */
  surface?: SurfaceKind;
  /** Colour of the blade. */
  texture?: LeafPaint;
  /** Meaning of a measured thickness; default that of the file, otherwise the diameter. */
  thickness?: 
    | ThicknessRule
    | null;
  /** Pull of the thickest vein on a NURBS blade, 1 (none) to 100, default 4. */
  vein_weight?: number;
  /** Loss of stiffness: 0 as measured to 1 hanging limp, default 0. */
  wilt?: number;
};

/** Model of the light that buds receive. */
export type Light =
  | /** Shadow propagation: Q = max(C - s + a, 0), direction down the shadow's gradient. */
  {
    /** Contribution of a joint to its own voxel, above 0 and at most 100. */
    a: number;
    /** Factor by which the shadow decreases from layer to layer, above 1 and at most 100. */
    b: number;
    /** Full light C, above 0. */
    full: number;
    kind: "shadow";
    /** Layers below that are shaded, 1 to 32. */
    layers: number;
    /** Side of a voxel, metres; default two internodes. */
    voxel_m?: number | null;
  }
  | /** Light from the sky: each internode bears a square leaf that lies level. */
  {
    /** Q in the open, above 0, default 1. */
    full?: number;
    kind: "sky";
    /** Edge of the leaf, metres; default an internode. */
    leaf_m?: number | null;
    /** Lines of light in each of 46 directions, 1,000 to 262,144, default 32,768: more are more exact and slower. */
    lines?: number;
  }
  | /** Space colonisation: Q = 1 for a bud that is nearest to a free marker in its cone, otherwise 0. */
  {
    /** Space of the markers, relative to the root. */
    envelope: Envelope;
    /** Half opening angle of the cone of sight, degrees; 45. */
    half_angle_deg: number;
    kind: "space";
    /** Markers for each tree, 1 to 10 million. */
    markers: number;
    /** Radius in which a joint removes markers, internodes; 2 in the paper. */
    occupancy: number;
    /** Radius in which a bud perceives markers, internodes; 4 to 6 in the paper. */
    perception: number;
  };

/** Colours and bark. */
export type Look = {
  /** Colour of leaves in autumn; default none: an evergreen. */
  autumn_color?: 
    | Colour
    | null;
  /** Colour towards which single leaves vary in autumn; default `autumn_color`. */
  autumn_color_to?: 
    | Colour
    | null;
  /** Whether leaves turn and fall first on the outside of the crown, as in beech and maple, and not inside, as in birch; in spring they unfold nearly together, not one after another. */
  autumn_outside?: boolean;
  /** Kind of bark. */
  bark?: Bark;
  /** Mean colour of the bark of trunk and branches. */
  bark_color?: Colour;
  /** Colour of the bark at the foot of the trunk, old and rough, not lighter than `bark_color`; default the same. */
  foot_color?: 
    | Colour
    | null;
  /** Share of the tree's height up to which the foot's colour reaches, 0.01 to 1, default 0.2. */
  foot_height?: number;
  /** Colour of leaves. */
  leaf_color?: Colour;
  /** Colour towards which single leaves vary (young growth); default the leaf colour. */
  leaf_color_to?: 
    | Colour
    | null;
  /** Degree of that variation, 0 to 1, default 0.5. */
  leaf_variation?: number;
  /** Depth of the furrows between ribs relative to the radius of the stem, 0 to 0.5, default 0.15. */
  rib_depth?: number;
  /** Ribs along thick stems, 0 to 32, default 0: round stems. */
  ribs?: number;
  /** The season, -1 to 1, default 0: leaves as in summer; -1: bare before spring, after which leaves unfold; 0.5: all in the colours of autumn; 1: all fallen. */
  season?: number;
  /** Mean colour of the bark of twigs. */
  twig_color?: Colour;
};

/** Method of growth. */
export type Method =
  | /** Space colonisation (Runions 2007). */
  {
    /** The space of the crown, relative to the root. */
    envelope: Envelope;
    /** Share of the envelope left empty inside, 0 to 0.99. */
    hollow?: number;
    kind: "colonization";
    /** Attraction points for each tree, 1 to 10 million. */
    points: number;
    /** Distances and pulls. */
    steps?: ColonizeSpec;
  }
  | /** Space colonisation of given points instead of scattered ones. */
  {
    kind: "points";
    /** Attraction points, metres; not relative to a root. */
    points: [number, number, number][];
    /** Distances and pulls. */
    steps?: ColonizeSpec;
  }
  | /** Competition for space in life cycles (Yang et al. */
  {
    /** Attraction distance `d_i`, default 0.9. */
    attraction_m?: number;
    /** Height of that ball over its width, 0 to 4: small values make flat tiers. */
    ball_height?: number;
    /** Radius of the ball of those points; default `d_i`. */
    ball_m?: number | null;
    /** The space of the crown. */
    envelope?: Envelope;
    /** Space that the first cycle fills, if it differs: a narrow one makes a trunk with few limbs, on which later cycles grow the branches. */
    first_envelope?: 
      | Envelope
      | null;
    /** Share of the envelope left empty inside, 0 to 0.99, default 0. */
    hollow?: number;
    /** Share of the last direction kept in each step, 0 to 10, default 0. */
    inertia?: number;
    /** Share of the joints around which each later cycle puts points (K), 0 to 1, default 0.15. */
    joints_share?: number;
    /** Absorption distance `d_k`, default 0.4. */
    kill_m?: number;
    kind: "competition";
    /** Life cycles, 1 to 20, default 2. */
    lifespan?: number;
    /** Most joints of all trees together, default 4 million. */
    max_joints?: number;
    /** Points of the first cycle for each tree, N; 1 to 10 million, default 1500. */
    points?: number;
    /** Points around each of them (M), 1 to 10000, default 40. */
    points_per_joint?: number;
    /** Factor on `d_i`, `d_k`, D and the ball from one cycle to the next, 0.1 to 1, default 1 (as in the paper). */
    shrink?: number;
    /** Step D, default half of `d_k` (the paper does not give it; Runions requires `d_k` of 2 D or more). */
    step_m?: number | null;
    /** Vertical distance between the tiers of branches that grow on what the first cycle made; default none: anywhere. */
    tier_m?: number | null;
    /** Other directions of growth. */
    tropisms?: Tropism[];
  }
  | /** Buds that compete for light (Palubicki 2009). */
  {
    /** Vigour per unit of light, above 0 and at most 100, default 2. */
    alpha?: number;
    /** Arrangement of the axillary buds, default a golden spiral. */
    arrangement?: Arrangement;
    /** Angle between a shoot and its lateral buds, 0 to 180 degrees, default 60. */
    branch_angle_deg?: number;
    /** Length of an internode at vigour 1, above 0, default 0.25. */
    internode_m?: number;
    /** Standard deviation of that angle and of the azimuths, 0 to 60 degrees, default 4. */
    jitter_deg?: number;
    kind: "self-organizing";
    /** Years until `lambda_late` holds, default 10. */
    lambda_years?: number;
    /** Model of the light of buds. */
    light?: Light;
    /** Weight xi of the best-lit direction, 0 to 10, default 0.25. */
    light_weight?: number;
    /** Most joints of all trees together; growth stops, with a warning, before the year that would exceed it. */
    max_joints?: number;
    /** Most internodes of one shoot a year, 1 to 100, default 6. */
    most_per_shoot?: number;
    /** Exponent n of the pipe model, 1 to 4, default 2.4. */
    pipe_exponent?: number;
    /** Distribution of the resource. */
    resource?: Resource;
    /** Whether a bud is shaded by its own leaf (Yang et al. */
    self_shadow?: boolean;
    /** Years for which a branch is spared, default 3. */
    shed_after_years?: number;
    /** Light per internode below which a branch is shed, 0 or more, default 0.15. */
    shed_below?: number;
    /** Radius of a fresh shoot, above 0, default 0.004. */
    tip_radius_m?: number;
    /** Weight eta and direction of other influences, default 0.05 upwards. */
    tropisms?: Tropism[];
    /** Years of growth, 0 to 1000, default 25. */
    years?: number;
  }
  | /** Buds with their own markers that keep away from others' and follow strokes of a brush (the VR paper). */
  {
    /** Vigour per unit of free space, above 0 and at most 100, default 2. */
    alpha?: number;
    /** Arrangement of the buds, default a golden spiral. */
    arrangement?: Arrangement;
    /** Angle between a shoot and its lateral buds, 0 to 180 degrees, default 55. */
    branch_angle_deg?: number;
    /** Changes of numbers from some round on, in ascending order of rounds: the record of the user's changes while the tree grew. */
    changes?: GuidedChange[];
    /** The space of the crown, relative to the root; default none: growth ends with its rounds. */
    envelope?: 
      | Envelope
      | null;
    /** Perception radius, in internodes, above `near` and at most 100, default 5. */
    far?: number;
    /** Half the opening of the perception cone, 1 to 180 degrees, default 45. */
    half_angle_deg?: number;
    /** Length of an internode at vigour 1, above 0, default 0.25. */
    internode_m?: number;
    /** Standard deviation of that angle and of the azimuths, 0 to 60 degrees, default 6. */
    jitter_deg?: number;
    kind: "guided";
    /** Share of the main axis at a fork, 0 to 1, default 0.54. */
    lambda?: number;
    /** Markers of one bud in one round, N, 4 to 10000, default 60. */
    markers?: number;
    /** Most joints, default 1 million. */
    max_joints?: number;
    /** Most internodes of one shoot in one round, 1 to 100, default 3. */
    most_per_shoot?: number;
    /** Occupancy radius, in internodes, 0 to 100, default 2: there are no markers nearer to a bud. */
    near?: number;
    /** Strength of the repulsion by others' markers, `k_r`, 0 to 10, default 1. */
    repulsion?: number;
    /** Rounds of growth, 0 to 1000, default 14. */
    rounds?: number;
    /** Most internodes of stopped twigs that are shed at the end, 0 (none) to 1000; default 1. */
    shed_up_to?: number;
    /** Strokes that guide growth; with any, buds grow only inside them. */
    strokes?: BrushStroke[];
    /** Weight and light, `k_g g`; relative to the pull of free space. */
    tropisms?: Tropism[];
  }
  | /** Rules (Prusinkiewicz and Lindenmayer 1990). */
  {
    kind: "lsystem";
    /** Most modules of all trees, 1 to 100 million. */
    most_modules: number;
    /** Axiom and rules, one per line. */
    rules: string;
  };

/** Nodding of bud and wilted flower, as shares of the angle of the open one. */
export type Nods = {
  /** Share of the bud, 0 to 40, default 0.35. */
  bud?: number;
  /** Share of the wilted flower, 0 to 40, default 1.6. */
  wilted?: number;
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

/** Resolution of the mesh of a petal. */
export type PetalMesh = {
  /** Columns across, 2 to 100. */
  columns: number;
  /** Rows from base to tip, 2 to 100. */
  rows: number;
};

/** Roots that arch from the stem to the ground and carry it: mangroves, screw pines. */
export type PropSpec = {
  /** Number of props that leave the stem, 0 to 200, default 0. */
  count?: number;
  /** Probability that a further arch leaves one half-way down, 0 to 1, default 0.5. */
  fork?: number;
  /** Mean radius, metres, 0.001 to 5, default 0.025. */
  radius_m?: number;
  /** Distance from the stem at which the highest reach the ground, metres, 0.01 to 50, default 1.5; each varies by half. */
  reach_m?: number;
  /** Height up to which they leave it when the tree is complete, metres, 0.01 to 50, default 1.5. */
  rise_m?: number;
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

/** Eq 5 and section 6.2: how blades bend and hollow, as shares of their length. */
export type ReliefSpec = {
  /** A of Eq 5 for leaves, default 0.05. */
  leaf_bend_a?: number;
  /** B of Eq 5 for leaves, default 0.18. */
  leaf_bend_b?: number;
  /** Fold of leaves along the midrib, slope of the halves, 0 to 1, default 0.25. */
  leaf_fold?: number;
  /** A of Eq 5 for petals, -0.2 to 0.2, default 0.08. */
  petal_bend_a?: number;
  /** B of Eq 5 for petals, -0.3 to 0.5, default 0.06. */
  petal_bend_b?: number;
  /** Hollow of petals, 0 to 0.3, default 0.08. */
  petal_hollow?: number;
};

/** Distribution of the gathered resource. */
export type Resource =
  | /** The extended Borchert-Honda model. */
  {
    kind: "borchert-honda";
    /** Bias for the main axis, 0 to 1; 0.46 makes a bush, 0.54 a leader. */
    lambda: number;
    /** The bias after `lambda_years`; default the same. */
    lambda_late?: number | null;
  }
  | /** The priority model: weights by rank along each axis. */
  {
    /** Rank, 1 or more. */
    kappa: number;
    kind: "priority";
    /** Weight of the tip, above 0. */
    w_max: number;
    /** Weight from rank `kappa` on, 0 or more. */
    w_min: number;
  };

/** Placement of a ring of the tube. */
export type RingRule =
  | /** A circle of the ball's radius in the plane across the centre line (Wang et al. */
  "plain"
  | /** The circle in which the ball touches the envelope of all balls: the exact surface. */
  "envelope";

/** Remains of lost branches on stems: mean numbers, which vary from seed to seed. */
export type ScarSpec = {
  /** Limbs that broke off, 0 to 50, default 0. */
  broken_limbs?: number;
  /** Burls, 0 to 50, default 0. */
  burls?: number;
  /** Hollows, where a stub has rotted away, 0 to 50, default 0. */
  hollows?: number;
  /** Knots, where the stem has grown around a stub, per metre, 0 to 30, default 0. */
  knots?: number;
  /** Stubs of dead branches per metre, 0 to 30, default 0. */
  stubs?: number;
};

/** All settings of the sketch maker; saved with the document. */
export type SketchSpec = {
  /** Depth of branches. */
  branch_depth?: BranchDepth;
  /** Growth inside contours. */
  fill?: FillSpec;
  /** Flowers (by index in the reading) that face away from the viewer: orthography cannot tell. */
  flipped_flowers?: number[];
  /** Sag of recovered branches under gravity, 0 to 1, default 0. */
  gravity?: number;
  /** Height of the plant in metres, above 0. */
  height_m?: number | null;
  /** Depth of leaves. */
  leaf_depth?: LeafDepth;
  /** Pull of light (upwards) on recovered branches, -1 to 1, default 0. */
  phototropism?: number;
  /** Pipe model exponent t of Eq 6, 1.8 to 3. */
  pipe_exponent?: number | null;
  /** The kind that every plant is taken for, whatever it looks like. */
  read_as?: 
    | Kind
    | null;
  /** Bending of blades. */
  relief?: ReliefSpec;
  /** Thinning along an axis. */
  taper?: TaperSpec;
};

/** Settings of a plant's surface. */
export type SkinSpec = {
  /** Fineness: 1 gives about 500 triangles for a branch of average length and 250 to 800 for a drawn blade; counts grow in proportion. */
  detail?: number;
  /** Colour of petals whose organs have no colour of their own; `None` picks one by seed and plant name. */
  petals?: 
    | PetalColor
    | null;
  /** Sides of an ordinary branch at `detail` 1 or more; thick ones get up to 24. */
  sides?: number;
  /** Size in full bloom, metres, of a plant that changes from day to day: fineness is relative to that and not to the day's size, so that triangles are the same on every day. */
  steady_m?: number | null;
  /** Give materials procedural textures; without, they have plain colours. */
  textures?: boolean;
  /** Variation of hue and brightness from organ to organ, 0 (none) to 1 (default). */
  variation?: number;
};

/** The stamens of a flower. */
export type Stamens = {
  /** Length of an anther as a share of the stamen, 0.02 to 0.9, default 0.17. */
  anther?: number;
  /** Linear colour of the anthers with their pollen. */
  anther_color?: [number, number, number];
  /** Number of stamens, 0 to 500. */
  count?: number;
  /** Linear colour of the filaments. */
  filament_color?: [number, number, number];
  /** Distance of their feet from the axis, metres, 0 to 0.2; 0, the default, for close round the pistil. */
  foot_m?: number;
  /** Length of one in an open flower, metres. */
  length_m?: number;
  /** Share of the wilting at which they fall, from 0, not at all, to 1, before the petals; default 0. */
  shed?: number;
  /** Angle by which they spread from the axis, degrees, 0 to 180. */
  spread_deg?: number;
};

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

/** Roots that run along the ground from the foot of a stem, half sunk, until they are out of sight. */
export type SurfaceRootSpec = {
  /** Number of roots of each stem, 0 to 40, default 0; half of them fork. */
  count?: number;
  /** Distance from the centre of the stem up to which they show, in its radii at the foot, 1.5 to 40, default 5; each varies by two fifths. */
  reach?: number;
};

/** Eq 7: how an axis thins from base to tip: r(x) = (s^(-alpha x) + m) / (1 + m). */
export type TaperSpec = {
  /** alpha, above 0, default 0.5. */
  alpha?: number;
  /** m, 0 or more, default 0: the tip is 0.1 of the base. */
  m?: number;
  /** s, above 1, default 100. */
  s?: number;
};

/** Relation of a measured thickness to its vein's ball. */
export type ThicknessRule =
  | /** A calliper's reading: the ball's diameter. */
  "diameter"
  | /** The ball's radius, as the formulas take it. */
  "radius";

/** A kind of tree, with its site and appearance. */
export type TreeSpec = {
  /** Description in one line. */
  about?: string;
  /** Age at which the trees are shown, in years of `years`; without those, in rounds, years (self-organising) or rewriting steps (L-systems). */
  age?: number | null;
  /** Whether there are no leaves at all: a dead or winter tree. */
  bare?: boolean;
  /** The form of a leaf. */
  blade?: BladeSpec;
  /** Flowers in the place of some leaves. */
  blossom?: BlossomSpec;
  /** Distance that bark keeps from obstacles where there is room, metres, 0 to 1e6, default 0.05; leaves may touch. */
  clearance_m?: number;
  /** Arrangement of leaves, and their loss. */
  leaves?: FoliageSpec;
  /** Colours and bark. */
  look?: Look;
  /** Method of growth. */
  method?: Method;
  /** Name in files and reports. */
  name?: string;
  /** Obstacles that they grow around; meshes may be named by `file`, in metres, +Y up. */
  obstacles?: Obstacle[];
  /** Positions of trees of this kind, metres; they compete. */
  roots?: [number, number, number][];
  /** Scientific name; may be empty. */
  species?: string;
  /** Variation of trees of this kind from seed to seed. */
  variation?: VariationSpec;
  /** Conversion of skeletons to wood. */
  wood?: WoodSpec;
  /** Age of the tree that the method grows, years, 1 to 5000. */
  years?: number | null;
};

/** An influence in one direction: light from above, weight downwards, wind. */
export type Tropism = {
  /** Direction of growth; any length above 0. */
  direction: [number, number, number];
  /** Strength relative to the pull of free space (which is 1), -10 to 10. */
  strength: number;
};

/** Variation of trees of this kind from seed to seed: in a wood, not on a drawing board. */
export type VariationSpec = {
  /** Spread of the share by which a crown reaches farther to one side, 0 to 0.4, default 0. */
  asymmetry?: number;
  /** Share of the limbs that are dead: without leaves and fine twigs, 0 to 0.9, default 0. */
  dead?: number;
  /** Probability that the trunk forks, 0 to 1, default 0. */
  fork?: number;
  /** Coefficient of variation of the thickness of wood in addition to that of the crown, 0 to 0.4, default 0. */
  girth?: number;
  /** Coefficient of variation of the height, 0 to 0.4, default 0; the crown grows with it. */
  height?: number;
  /** Spread of the lean, degrees, 0 to 30, default 0: half of the trees lean more than 1.2 times this. */
  lean_deg?: number;
  /** Coefficient of variation of the number of limbs, 0 to 0.5, default 0. */
  limbs?: number;
  /** Share of the limbs that storms or shade have removed completely, 0 to 0.5, default 0. */
  lost?: number;
  /** Coefficient of variation of the crown's width in addition to that of the height, 0 to 0.4, default 0. */
  width?: number;
};

/** Parameters of an interpolating side vein. */
export type VeinParameters =
  | /** Those of the blade, so that the vein lies on it. */
  "shared"
  | /** The chord lengths of its own marks, as published: vein and blade meet at the marks only. */
  "own";

/** One ring of petals. */
export type Whorl = {
  /** Arrangement of the petals in the bud. */
  aestivation?: Aestivation;
  /** Linear colour that petals take as the days pass after full bloom. */
  aged_color?: [number, number, number];
  /** Share of that colour, 0 to 1, default 0. */
  aging?: number;
  /** Linear colour at the base: shares of red, green and blue light. */
  base_color?: [number, number, number];
  /** Angle to the axis at base, middle and tip in the bud, degrees. */
  bud_deg?: [number, number, number];
  /** Width at the base as a share of the greatest, default 0.3. */
  claw?: number;
  /** Share of the petal that is as narrow as its base (a clawed petal), 0 to 0.7, default 0. */
  claw_length?: number;
  /** Number of petals, 1 to 200, default 6. */
  count?: number;
  /** Strength of the waves of petals in bloom and of their crumpling when withered, 0 to 3, default 1. */
  crumple?: number;
  /** Rise of the margins towards the axis of the flower, as a share of half the width, -1 to 1, default 0. */
  cup?: number;
  /** Delay of the opening of the whorl, as a share of the opening, 0 to 0.9, default 0. */
  delay?: number;
  /** Time at which the first of them falls, -1 to 0.9, default 0.3: -1 is the bud, 0 full bloom, 1 the end of wilting. */
  falls?: number;
  /** Fate of the petals at the end. */
  fate?: Fate;
  /** Depth of the fringe of the margin, 0 to 1, default 0. */
  fringe?: number;
  /** Greenness of the bud, 0 to 1, default 0. */
  green?: number;
  /** A mark that guides visitors to the nectar. */
  guide?: Guide;
  /** The innermost of several rings. */
  innermost?: Innermost;
  /** Insertion of the petals. */
  insertion?: Insertion;
  /** Lean within the whorl: distance of one edge to the other across the petal, metres, default 0.002. */
  lean_m?: number;
  /** Length of an open petal, metres, default 0.05. */
  length_m?: number;
  /** Depth of a notch in the tip, as a share of the length, 0 to 0.5, default 0. */
  notch?: number;
  /** Angle to the axis at base, middle and tip in full bloom, degrees. */
  open_deg?: [number, number, number];
  /** Turn of the whorl about the axis, degrees, default 0. */
  phase_deg?: number;
  /** Pointedness of the tip: 1 is a point, 0 is round; default 0.5. */
  point?: number;
  /** Rings with this number of petals, one within the other, 1 to 20, default 1. */
  rings?: number;
  /** Angle to the axis at base, middle and tip when the fruit is ripe, degrees: for a flower with `ripening`. */
  ripe_deg?: [number, number, number];
  /** Share of the way from the wilted to the ripe angles, 0 to 1, default 0. */
  ripens?: number;
  /** Whether they are sepals or bracts, which keep their form when petals are replaced. */
  sepal?: boolean;
  /** Shrinking of withered petals, 0 not at all to 1, default 1: a quarter shorter, nearly half as wide. */
  shrivel?: number;
  /** Angle from one petal to the next, degrees, 0 to 360; 0, the default, for evenly around the axis. */
  spacing_deg?: number;
  /** Delay of the last petal of the ring after the first, as a share of the opening, 0 to 0.6, default 0. */
  succession?: number;
  /** Linear colour at the tip. */
  tip_color?: [number, number, number];
  /** Turn of the tips about the axis in the bud, degrees, default 0. */
  twist_deg?: number;
  /** Place of the greatest width along the petal, 0.2 to 0.9, default 0.5. */
  widest?: number;
  /** Greatest width, metres, default 0.02. */
  width_m?: number;
  /** Angle to the axis at base, middle and tip when wilted, degrees. */
  wilted_deg?: [number, number, number];
};

/** Conversion of a skeleton to wood. */
export type WoodSpec = {
  /** Contribution of every internode to the pipes, as a share of a tip's, 0 to 1, default 0.05. */
  internode_share?: number;
  /** Exponent t of `r^t = sum of r_i^t` (Yang et al. */
  pipe_exponent?: number;
  /** Roots that arch from the bole to the ground. */
  props?: PropSpec;
  /** Number of times that every joint is moved half-way to its parent (Runions 2007, step e), 0 to 10: angles at forks become acute and courses straighter; each time costs half an internode of size. */
  relax?: number;
  /** Remains of lost branches on stems. */
  scars?: ScarSpec;
  /** Smooths courses to quadratic Bezier pieces that join with one tangent (Eq 3, C1 variant). */
  smooth?: boolean;
  /** Visible roots around the foot of each stem. */
  surface_roots?: SurfaceRootSpec;
  /** Factor on the thickness of the bole relative to that which its crown needs, 1 to 20, default 1: baobabs and bottle trees store water there. */
  swell?: number;
  /** Tolerance for leaving out joints that bear nothing: the displacement of the course as a share of the radius, 0 to 10, default 0.25. */
  thin_out?: number;
  /** Radius of a tip, metres, above 0, default 0.004. */
  tip_radius_m?: number;
  /** Radius at the foot of the thickest trunk when the tree is complete, metres: all radii, including those of the tips and `max_radius_m`, are scaled to it, so that the pipe model holds. */
  trunk_radius_m?: number | null;
};
