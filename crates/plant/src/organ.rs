//! Leaves, petals and the other organs that nodes bear.

use std::sync::Arc;

use base::{Digest, Digestible};
use glam::{DVec2, DVec3};

use crate::ids::{FlowerId, NodeId, ShapeId};
use crate::{Blade, Frame, Sheet, SplineBlade};

/// Kind of an organ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum OrganKind {
    /// Green blade.
    Leaf,
    /// Coloured blade of a flower.
    Petal,
    /// The centre of a flower.
    Disc,
    /// Fruit.
    Fruit,
    /// Stamen: filament and anther.
    Stamen,
    /// Pistil.
    Pistil,
    /// Thorn or spine.
    Thorn,
    /// Stalk of a flower.
    Pedicel,
    /// Green or coloured blade that held the bud: sepal or bract.
    Sepal,
    /// End of a stamen, with the pollen.
    Anther,
    /// One of the small flowers of a disc.
    Floret,
    /// A green body, such as a cactus's, which is stem and leaves in one.
    Body,
    /// The pot that the plant stands in, or its soil: not a part of the plant, but placed under it.
    Pot,
    /// A compound fruit with an eye for each of its fruitlets, such as a pineapple.
    Syncarp,
}

/// Colour of an organ, as set by its maker. Linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// The colour of organs of its kind, multiplied by this factor: makers vary it by a tenth.
    Natural([f32; 3]),
    /// A colour of its own, such as a species' autumn colour.
    Tinted([f32; 3]),
    /// The colour of the pen that it was drawn with.
    Drawn([f32; 3]),
}

impl Default for Paint {
    /// Returns the colour of organs of its kind.
    fn default() -> Self {
        Self::Natural([1.0; 3])
    }
}

impl Paint {
    /// Returns the colour, or the factor on a natural one.
    pub const fn rgb(self) -> [f32; 3] {
        match self {
            Self::Natural(c) | Self::Tinted(c) | Self::Drawn(c) => c,
        }
    }
}

/// Colours of the surfaces that are not organs, as set by the plant's maker. Linear RGB; `None` for the default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlantPaint {
    /// Green stems and stalks.
    pub stem: Option<[f32; 3]>,
    /// Veins of measured leaves.
    pub veins: Option<[f32; 3]>,
}

/// The form of an organ in its own frame, in metres at scale 1.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A leaf or petal as a bent sheet.
    Blade(Blade),
    /// A dome around the local z axis: the disc of a flower. Base at z = 0.
    Dome {
        /// Radius of the base.
        radius_m: f64,
        /// Height of the top over the base.
        height_m: f64,
    },
    /// A body of revolution around the local y axis: `(radius, y)` from the lower to the upper pole.
    Revolution {
        /// The generating line; radii 0 or more.
        profile: Vec<DVec2>,
    },
    /// A leaf of measured veins: a smooth surface.
    Spline(Arc<SplineBlade>),
    /// A blade as a grid of points: from a scan, or a petal on one day.
    Sheet(Arc<Sheet>),
    /// A round strand (filament, style, thorn, stalk) along local points with a radius at each, its end closed; with a
    /// radius of 0 at both ends it is a body that bends ([`is_bent_body`](Self::is_bent_body)).
    Strand {
        /// Local points, root first.
        path: Vec<DVec3>,
        /// Radius at each point.
        radius_m: Vec<f64>,
        /// Radius of the ball at its end (anther, stigma); 0 for none.
        knob_m: f64,
    },
}

/// Largest factor by which a blade is drawn wider than its outline, to preserve its area in few triangles.
pub const DRAWN_WIDER: f64 = 1.5;

impl Shape {
    /// Returns the distance of its farthest point from its root, metres at scale 1.
    pub fn reach(&self) -> f64 {
        match self {
            Self::Blade(b) => b.length(),
            Self::Dome { radius_m, .. } => *radius_m,
            Self::Revolution { profile } => profile.iter().map(|p| p.y.abs()).fold(0.0, f64::max),
            Self::Spline(blade) => blade.reach(),
            Self::Sheet(sheet) => sheet.reach(),
            Self::Strand { path, .. } => path.last().map_or(0.0, |p| p.length()),
        }
    }

    /// Returns the length from root to tip, metres at scale 1: along the midrib in the plane of a flat blade, along the
    /// line of a strand; `None` for bodies.
    pub fn length(&self) -> Option<f64> {
        match self {
            Self::Blade(b) => Some(b.length()),
            Self::Spline(blade) => Some(blade.length()),
            Self::Sheet(sheet) => Some(sheet.reach()),
            Self::Strand { path, .. } => Some(geom::polyline_length3(path)),
            Self::Dome { .. } | Self::Revolution { .. } => None,
        }
    }

    /// Whether this is a strand that tapers to a point at both ends: a bent fruit or pod.
    pub fn is_bent_body(&self) -> bool {
        let pole = |r: Option<&f64>| r.is_some_and(|r| *r <= 0.0);
        match self {
            Self::Strand { radius_m, knob_m, .. } => {
                pole(radius_m.first()) && pole(radius_m.last()) && *knob_m <= 0.0
            }
            _ => false,
        }
    }

    /// Returns points whose convex hull contains the surface, in its own frame at scale 1: a blade's margin, midrib and
    /// veins as they are bent, `wider` times as wide; of a body the corners of the boxes around its parts.
    pub fn corners(&self, wider: f64) -> Vec<DVec3> {
        let around = |p: DVec3, r: f64| {
            (0..8).map(move |i: u32| {
                let side = |bit: u32| if i & bit == 0 { -r } else { r };
                p + DVec3::new(side(1), side(2), side(4))
            })
        };
        match self {
            Self::Blade(blade) => {
                let plane = blade.outline.iter().chain(blade.lines().flatten());
                let plane: Vec<DVec2> = plane.map(|p| DVec2::new(p.x * wider, p.y)).collect();
                blade.surface().points(&plane)
            }
            Self::Dome { radius_m, height_m } => around(DVec3::ZERO, 1.0)
                .map(|c| DVec3::new(c.x * radius_m, c.y * radius_m, c.z.max(0.0) * height_m))
                .collect(),
            Self::Revolution { profile } => {
                let ring = |p: &DVec2| {
                    around(DVec3::ZERO, p.x).map(|c| DVec3::new(c.x, p.y, c.z)).collect::<Vec<_>>()
                };
                profile.iter().flat_map(ring).collect()
            }
            Self::Spline(blade) => blade.marks(),
            Self::Sheet(sheet) => sheet.points.clone(),
            Self::Strand { path, radius_m, knob_m } => {
                let radius = |i: usize| radius_m.get(i).or(radius_m.last()).copied().unwrap_or(0.0);
                let end = path.last().map(|p| (*p, *knob_m));
                let all = path.iter().enumerate().map(|(i, p)| (*p, radius(i))).chain(end);
                all.flat_map(|(p, r)| around(p, r)).collect()
            }
        }
    }
}

/// One organ: a shape placed in the plant.
#[derive(Clone, Debug, PartialEq)]
pub struct Organ {
    /// Its kind.
    pub kind: OrganKind,
    /// The node that bears it; `None` for an organ of a drawing without any axis.
    pub bearer: Option<NodeId>,
    /// The flower that it belongs to.
    pub flower: Option<FlowerId>,
    /// Its form.
    pub shape: ShapeId,
    /// Its position and orientation.
    pub frame: Frame,
    /// Size relative to the shape, above 0.
    pub scale: f64,
    /// Its colour.
    pub paint: Paint,
    /// A key that is stable under edits of other parts.
    pub key: u64,
    /// The stroke it was read from; `None` for organs that the program placed.
    pub source: Option<u32>,
}

/// A flower: the petals on one cone or several nested ones, a disc, stamens.
#[derive(Clone, Debug, PartialEq)]
pub struct Flower {
    /// The node that bears it.
    pub bearer: Option<NodeId>,
    /// The apex of its cone, where petals are rooted, metres.
    pub centre: DVec3,
    /// Unit vector along its axis, from the stem outwards.
    pub axis: DVec3,
    /// Half opening angle of its outermost whorl, radians, 0 (closed) to pi/2 (flat).
    pub half_angle: f64,
    /// Number of whorls, 1 or more; 0 for a flower without petals.
    pub whorls: u32,
}

impl Digestible for Paint {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.rgb());
        match self {
            Self::Natural(_) => {}
            Self::Tinted(_) => {
                d.add(&1_u8);
            }
            Self::Drawn(_) => {
                d.add(&2_u8);
            }
        }
    }
}

impl Digestible for PlantPaint {
    fn digest(&self, d: &mut Digest) {
        for (row, color) in (0_u8..).zip([self.stem, self.veins]) {
            if let Some(color) = color {
                d.add(&row).add(&color);
            }
        }
    }
}

impl Digestible for Organ {
    fn digest(&self, d: &mut Digest) {
        d.add(&(self.kind as u8)).add(&self.bearer.map(NodeId::raw)).add(&self.flower.map(FlowerId::raw));
        d.add(&self.shape.raw())
            .add(&self.frame)
            .add(&self.scale)
            .add(&self.paint)
            .add(&self.key)
            .add(&self.source);
    }
}

impl Digestible for Flower {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.bearer.map(NodeId::raw)).add(&self.centre).add(&self.axis);
        d.add(&self.half_angle).add(&self.whorls);
    }
}

impl Digestible for Shape {
    fn digest(&self, d: &mut Digest) {
        match self {
            Self::Blade(b) => {
                d.add(&0_u8).add(b);
            }
            Self::Dome { radius_m, height_m } => {
                d.add(&1_u8).add(radius_m).add(height_m);
            }
            Self::Revolution { profile } => {
                d.add(&2_u8).add(profile);
            }
            Self::Spline(blade) => {
                d.add(&4_u8).add(&**blade);
            }
            Self::Sheet(sheet) => {
                d.add(&5_u8).add(&**sheet);
            }
            Self::Strand { path, radius_m, knob_m } => {
                d.add(&3_u8).add(path).add(radius_m).add(knob_m);
            }
        }
    }
}
