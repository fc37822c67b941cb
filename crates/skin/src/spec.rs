//! Settings of the surface, and the distribution of triangles.

use std::sync::Arc;

use base::{Draw, Seed};
use geom::{BallTubeSpec, EndCap, RingRule};
use plant::{OrganKind, Plant};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spec::Colour;

use crate::natural::{BarkKind, VeinPattern};
use crate::shoots::{FoliageStyle, Shoots};
use crate::{Wearer, Worn};

/// Settings of a plant's surface. Saved with the document.
///
/// ```
/// let coarse = skin::SkinSpec { detail: 0.5, ..skin::SkinSpec::default() };
/// assert_eq!((coarse.sides, coarse.textures), (8, true));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SkinSpec {
    /// Fineness: 1 gives about 500 triangles for a branch of average length and 250 to 800 for a drawn blade; counts
    /// grow in proportion. In a crown of hundreds of branches each gets as many as its bends need. 0.1 to 8, default 1.
    #[schemars(range(min = 0.1, max = 8.0))]
    pub detail: f64,
    /// Sides of an ordinary branch at `detail` 1 or more; thick ones get up to 24. 3 to 24, default 8 (the
    /// paper's octagons).
    #[schemars(range(min = 3, max = 24))]
    pub sides: u32,
    /// Meshing of leaves of measured veins at `detail` 1. Set by the leaf, not saved here.
    #[serde(skip)]
    pub leaf: LeafMeshSpec,
    /// Give materials procedural textures; without, they have plain colours. Default true.
    pub textures: bool,
    /// Pixels of a side of the bark's textures and of the length of a leaf's, 64 to 4096. Chosen for an export, not
    /// saved. Default 512.
    #[serde(skip)]
    pub texture_size: u32,
    /// The bark of a tree. Saved with the tree, not here. Default none: furrowed, brown.
    #[serde(skip)]
    pub bark: Option<BarkSpec>,
    /// Course of the veins of its leaves, which then have a surface of their own form. Saved with the tree, not here.
    /// Default none: pinnate, on a form that suits any.
    #[serde(skip)]
    pub venation: Option<VeinPattern>,
    /// Colour of petals whose organs have no colour of their own; `None` picks one by seed and plant name.
    pub petals: Option<PetalColor>,
    /// Variation of hue and brightness from organ to organ, 0 (none) to 1 (default).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub variation: f64,
    /// Also fill the columns that set how wind moves each vertex ([`mesh::TriMesh::wind`], `pivots`). Chosen for an
    /// export, not saved. Default false.
    #[serde(skip)]
    pub wind: bool,
    /// Size in full bloom, metres, of a plant that changes from day to day: fineness is relative to that and not to the
    /// day's size, so that triangles are the same on every day. Default none.
    pub steady_m: Option<f64>,
    /// Axes (without leaf stalks) and organs of the whole plant, for a coarser copy: its remaining parts do not become
    /// finer because they are fewer. Not saved. Default none: those of the plant itself.
    #[serde(skip)]
    pub crowd: Option<[usize; 2]>,
    /// Drawing of leaves of a flat form; by their outlines if there are no textures, and if they wear a material.
    /// Shoots in needles are always cards if there are textures. Chosen for an export, not saved.
    #[serde(skip)]
    pub foliage: FoliageStyle,
    /// Shoots for cards of several leaves. Not saved. Default none.
    #[serde(skip)]
    pub shoots: Option<Arc<Shoots>>,
    /// Materials that a user gave to organs. Saved with the plant, not here. Default none.
    #[serde(skip)]
    pub worn: Worn,
    /// Seed of the variation, of the choice of colours, and of the phases of the wind.
    #[serde(skip)]
    pub seed: Seed,
}

spec::schemas!(SkinSpec = include_str!("../schemas/skin.json"));

impl Default for SkinSpec {
    fn default() -> Self {
        Self {
            detail: 1.0,
            sides: 8,
            leaf: LeafMeshSpec::default(),
            textures: true,
            texture_size: 512,
            bark: None,
            venation: None,
            petals: None,
            variation: 1.0,
            wind: false,
            steady_m: None,
            crowd: None,
            foliage: FoliageStyle::default(),
            shoots: None,
            worn: Worn::default(),
            seed: Seed::default(),
        }
    }
}

impl SkinSpec {
    /// Whether leaves are cards, for shoots in needles or for other leaves.
    pub(crate) fn cards(&self, needled: bool) -> bool {
        let wanted = self.foliage == FoliageStyle::Cards || needled;
        wanted && self.textures && self.worn.kinds[Wearer::Leaf as usize].is_none()
    }

    /// Returns the painted shoots that an atlas shows next to its leaf, for shoots in needles or for other leaves.
    pub(crate) fn shoots(&self, needled: bool) -> Option<&Shoots> {
        self.shoots.as_deref().filter(|s| s.leaf.needles.is_some() == needled)
    }

    /// Returns the number of cells of that atlas.
    pub(crate) fn cells(&self, needled: bool) -> usize {
        1 + self.shoots(needled).map_or(0, |s| s.tiles.len())
    }
}

/// The bark of a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarkSpec {
    /// Its kind.
    pub kind: BarkKind,
    /// Its mean colour; for birch that of its white.
    pub colour: Colour,
    /// The colour of twigs.
    pub twig: Colour,
    /// Ribs along thick stems, 0 to 32.
    pub ribs: u32,
    /// Depth of the furrows between ribs relative to the radius, 0 to 0.5.
    pub rib_depth: f64,
}

impl Default for BarkSpec {
    fn default() -> Self {
        Self {
            kind: BarkKind::Furrowed,
            colour: Colour([98, 81, 66]),
            twig: Colour([103, 88, 65]),
            ribs: 0,
            rib_depth: 0.0,
        }
    }
}

impl BarkSpec {
    /// Returns kind and colour of wood: `twig` for thin twigs in a plant with old wood, otherwise for trunk and limbs.
    pub(crate) const fn kind_and_colour(self, twig: bool) -> (BarkKind, Colour) {
        match (twig, self.kind) {
            (false, kind) => (kind, self.colour),
            // A bamboo's twigs are canes, too, and a cactus's arms have ribs.
            (true, BarkKind::Cane) => (BarkKind::Cane, self.twig),
            (true, BarkKind::Ribbed) => (BarkKind::Ribbed, self.colour),
            (true, _) => (BarkKind::Twig, self.twig),
        }
    }
}

/// Resolution of the mesh of leaves of measured veins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeafMeshSpec {
    /// Parts of each span between marks, 1 to 64. Default 5, as in Table 1 of Wang et al. (2011).
    pub subdivisions: usize,
    /// Points of each ring of a vein, 3 to 64. Default 10, as in Table 1.
    pub sides: usize,
    /// Plain rings (paper) or the exact envelope of the balls.
    pub rings: RingRule,
    /// Round ends of the veins; the paper's are open.
    pub caps: bool,
    /// A vein along the margin too; the paper draws it and does not count it.
    pub margin: bool,
}

impl Default for LeafMeshSpec {
    fn default() -> Self {
        Self { subdivisions: 5, sides: 10, rings: RingRule::Plain, caps: false, margin: false }
    }
}

impl LeafMeshSpec {
    /// Returns the approximate number of triangles of a leaf with this number of rows of marks, from the numbers of
    /// Table 1.
    pub fn triangles(&self, rows: usize) -> u64 {
        let [rows, steps, sides] =
            [rows, self.subdivisions.clamp(1, 64), self.sides.clamp(3, 64)].map(|n| n as u64);
        // 7 spans of veins (9 with the margin) and 6 columns of the blade per row, two triangles per quad.
        let spans = if self.margin { 9 } else { 7 };
        2 * rows * (spans * steps * sides + 6 * steps * steps)
    }

    /// Returns a coarser or finer spec: triangles in proportion to `detail`, 1 for the same.
    pub(crate) fn with_detail(self, detail: f64) -> Self {
        let times = |n: usize, low: f64| {
            #[expect(clippy::cast_precision_loss, reason = "at most 64")]
            let wanted = (n as f64 * detail.sqrt()).round();
            base::ops::whole(wanted.clamp(low, 64.0)) as usize
        };
        Self { subdivisions: times(self.subdivisions, 1.0), sides: times(self.sides, 3.0), ..self }
    }

    pub(crate) fn tube(&self) -> BallTubeSpec {
        let cap = if self.caps { EndCap::Round(3) } else { EndCap::Open };
        BallTubeSpec { rings: self.rings, sides: self.sides.clamp(3, 64), cap, first_normal: None }
    }
}

/// Natural petal colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PetalColor {
    /// Rose pink with a pale base.
    Pink,
    /// White with a greenish base.
    White,
    /// Warm yellow.
    Yellow,
    /// Violet blue with a pale base.
    Violet,
    /// Poppy red with a dark base.
    Red,
    /// Orange with a yellow base.
    Orange,
    /// Sky blue with a white base.
    Blue,
    /// Crimson magenta.
    Magenta,
}

base::words!(PetalColor {
    Pink = "pink",
    White = "white",
    Yellow = "yellow",
    Violet = "violet",
    Red = "red",
    Orange = "orange",
    Blue = "blue",
    Magenta = "magenta",
});

impl PetalColor {
    /// Returns the mean of a petal of this colour, linear RGB.
    pub const fn linear(self) -> [f32; 3] {
        match self {
            Self::Pink => [0.80, 0.33, 0.42],
            Self::White => [0.90, 0.91, 0.80],
            Self::Yellow => [0.93, 0.60, 0.03],
            Self::Violet => [0.26, 0.14, 0.50],
            Self::Red => [0.52, 0.02, 0.01],
            Self::Orange => [0.87, 0.26, 0.02],
            Self::Blue => [0.20, 0.29, 0.73],
            Self::Magenta => [0.55, 0.06, 0.23],
        }
    }

    /// Returns the colour of the petals of a plant that have no colour of their own.
    pub fn for_plant(plant: &Plant, spec: &SkinSpec) -> Self {
        // Rays around a disc belong to a daisy or a sunflower, which is never blue or red. In a drawing the disc
        // decides and not the number of petals: one petal more or less would change the colour of all.
        const RAYS: [PetalColor; 4] =
            [PetalColor::Yellow, PetalColor::White, PetalColor::Orange, PetalColor::Yellow];
        let key = plant.name.bytes().fold(spec.seed, |key, b| key.child(u64::from(b)));
        let of_kind = |kind| plant.organs.iter().filter(move |o| o.kind == kind);
        let drawn = of_kind(OrganKind::Petal).any(|o| o.source.is_some());
        let rays = if drawn {
            of_kind(OrganKind::Disc).any(|o| o.source.is_some())
        } else {
            of_kind(OrganKind::Disc).next().is_some()
                && of_kind(OrganKind::Petal).count() >= 9 * plant.flowers.len().max(1)
        };
        let among = if rays { &RAYS[..] } else { &Self::ALL };
        spec.petals.unwrap_or_else(|| among[key.stream(Draw::Tint).below(among.len())])
    }
}

/// Number of triangles for one axis or one blade of a given plant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    pub detail: f64,
    /// Diagonal of the plant's box, metres.
    size: f64,
    /// Mean length of its axes other than leaf stalks, metres.
    axis_length: f64,
    axes: f64,
    blades: f64,
}

// The paper's sketch (a) has 33.4 rings a branch; collar and tip are part of them.
const RINGS: f64 = 32.0;
// Totals (at detail 1) above which axes and blades share: a crown of thousands of twigs and leaves stays a model that a
// game or a page can hold, while every sketch of the paper's Table 1 stays below.
const ALL_RINGS: f64 = 2_600.0;
const ALL_BLADES: f64 = 64_000.0;
// Number of blades beyond which each is one of a crowd and the sum decreases too.
const CROWD: f64 = 200.0;

// Share of the plant's size below which details are invisible.
const TOLERANCE: f64 = 7e-4;

// Number of axes from which a plant is a tree in leaf rather than a drawing: twigs are a crowd.
const CROWN_AXES: f64 = 150.0;
// Number of blades from which they are a crowd.
const CROWN_BLADES: f64 = 1500.0;
// Triangles of a crown's leaf, as a share of the number that its margin would need.
const LEAN: f64 = 0.55;
// Number of blades from which each has fewer triangles: small leaves are many, and are seen from farther away.
const MANY_BLADES: f64 = 16_000.0;

impl Budget {
    /// Whether blades are so many that each gets no more triangles than its form needs.
    pub(crate) fn crown(&self) -> bool {
        self.blades > CROWN_BLADES
    }

    /// Returns the triangles of a crown's leaf whose margin would need `least` when seen from near by.
    ///
    /// 8 for a plain leaf, 12 for an oak's, 22 for a bundle of needles; down to a quarter of that where there are very
    /// many.
    pub(crate) fn lean_triangles(&self, least: f64) -> f64 {
        LEAN * least * (MANY_BLADES / self.blades).sqrt().clamp(0.25, 1.0) * self.detail
    }

    pub(crate) fn new(detail: f64, size: f64, axis_length: f64, axes: usize, blades: usize) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
        let count = |n: usize| (n as f64).max(1.0);
        let detail = if detail.is_finite() { detail.clamp(0.05, 16.0) } else { 1.0 };
        let sound = |x: f64| if x.is_finite() && x > 0.0 { x } else { 1.0 };
        Self {
            detail,
            size: sound(size),
            axis_length: sound(axis_length),
            axes: count(axes),
            blades: count(blades),
        }
    }

    /// Returns the diagonal of the plant's box, metres.
    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// Returns the rings of an axis, including collar and tip: by the square root of its length, so that a twig is
    /// coarser than a trunk but less than in proportion to its length.
    pub(crate) fn rings(&self, length: f64) -> f64 {
        let share = (ALL_RINGS / self.axes).min(RINGS);
        let relative = (length / self.axis_length).clamp(0.0, 16.0).sqrt();
        (share * relative * self.detail).clamp(4.0, 600.0)
    }

    /// Whether a twig of a crown is so thin that its ends are invisible in a view of the whole plant.
    pub(crate) fn unseen(&self, radius: f64) -> bool {
        self.axes > CROWN_AXES && radius * self.detail < 0.7 * TOLERANCE * self.size
    }

    /// Returns the tolerance between drawn wood and the plant's at a radius of `radius`, metres: 0.07 % of the plant's
    /// size, and at most the radius, so that organs on a thin twig stay attached.
    pub(crate) fn tolerance(&self, radius: f64) -> f64 {
        (TOLERANCE * self.size).min(radius) / self.detail
    }

    /// Returns the sides of an axis of this radius: enough that its polygon deviates from the circle by less than 0.07
    /// % of the plant's size, even, `least` to 24.
    pub(crate) fn sides(&self, radius: f64, least: u32) -> u32 {
        let crowded = if self.axes > ALL_RINGS / RINGS { 2.0 } else { 0.0 };
        let floor = (f64::from(least.clamp(3, 24)) * self.detail.min(1.0) - crowded).max(3.0);
        let floor = match least {
            // Twigs of a crown are thinner than a pixel of its picture.
            _ if self.axes > CROWN_AXES => (floor - 3.0).max(3.0),
            5.. => floor.max(5.0),
            _ => floor,
        };
        let tolerance = TOLERANCE * self.size / self.detail;
        let round = base::ops::PI / base::ops::acos_clamped(1.0 - (tolerance / radius.max(1e-12)).min(1.0));
        base::ops::whole(round.clamp(floor, 24.0_f64.max(floor)).ceil())
    }

    /// Returns the triangles of a blade with this area (m2, at the size at which it is placed).
    ///
    /// By the fourth root of its area relative to the plant's box: Table 1's six large petals have 780 each, its 142
    /// leaves 408, its 126 small ones 251. If many blades share a plant each gets fewer, down to 14: enough for a
    /// midrib and a margin, so that even crown leaves fold.
    pub(crate) fn blade_triangles(&self, area: f64) -> f64 {
        let relative = (area / (self.size * self.size)).clamp(1e-6, 1.0);
        let by_size = 780.0 * base::ops::powf(relative / 0.04, 0.3);
        let crowd = base::ops::powf((CROWD / self.blades).min(1.0), 0.4);
        let by_count = (crowd * ALL_BLADES / self.blades).max(14.0);
        // Far away, where a whole level is an eighth of the size, a blade may be two kites.
        let least = (32.0 * self.detail).clamp(4.0, 8.0);
        (by_size.clamp(32.0, 1200.0).min(by_count) * self.detail).clamp(least, 20_000.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use plant::{Flower, FlowerId, Frame, Organ, Paint, Shape};

    /// Makes a flower with petals, and with a disc that was drawn or not.
    fn flower(petals: u32, disc: Option<u32>) -> Plant {
        let mut plant = Plant { name: "daisy".to_owned(), ..Plant::default() };
        plant.flowers.push(Flower {
            bearer: None,
            centre: DVec3::ZERO,
            axis: DVec3::Z,
            half_angle: 1.0,
            whorls: 1,
        });
        let shape = plant.add_shape(Shape::Dome { radius_m: 0.01, height_m: 0.004 });
        let frame = Frame { origin: DVec3::ZERO, right: DVec3::X, along: DVec3::Y, normal: DVec3::Z };
        let mut add = |kind, source| {
            let (flower, paint) = (Some(FlowerId::new(0)), Paint::default());
            plant.organs.push(Organ {
                kind,
                bearer: None,
                flower,
                shape,
                frame,
                scale: 1.0,
                paint,
                key: 0,
                source,
            });
        };
        (0..petals).for_each(|k| add(OrganKind::Petal, Some(k)));
        add(OrganKind::Disc, disc);
        plant
    }

    #[test]
    fn one_petal_more_or_less_recolours_no_flower() {
        for seed in 1..=12 {
            let spec = SkinSpec { seed: Seed::new(seed), ..SkinSpec::default() };
            for disc in [None, Some(99)] {
                let color = PetalColor::for_plant(&flower(3, disc), &spec);
                for petals in 4..20 {
                    let other = PetalColor::for_plant(&flower(petals, disc), &spec);
                    assert_eq!(other, color, "{petals} petals, seed {seed}");
                }
                let daisy = !matches!(color, PetalColor::Blue | PetalColor::Red);
                assert!(daisy || disc.is_none(), "a daisy is not {}", color.word());
            }
        }
    }
}
