//! Stiffness, density and strength of the tissues of plants.

use plant::{AxisKind, OrganKind, Plant, Shape};

/// Mechanical properties of a living tissue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tissue {
    /// Young's modulus along the axis, pascals, above 0.
    pub modulus_pa: f64,
    /// Density with its water, kilograms per cubic metre, above 0.
    pub density_kg_m3: f64,
    /// Tensile strength, pascals, above 0.
    pub strength_pa: f64,
}

/// The group of species that the woody axes of a plant belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WoodGroup {
    /// Broad-leaved trees and shrubs.
    #[default]
    Hardwood,
    /// Conifers.
    Softwood,
    /// Herbs and grasses: no wood.
    Green,
}

base::words!(WoodGroup { Hardwood = "hardwood", Softwood = "softwood", Green = "green" });

impl WoodGroup {
    /// Returns the tissue of a group: a value in the middle of the range of its species, not of one species.
    ///
    /// Green wood (Wood Handbook, Forest Products Laboratory 2010, chapter 5): modulus of hardwoods 7e9 to 11e9 Pa and
    /// of softwoods 6e9 to 11e9, bending strength 45e6 to 75e6 and 35e6 to 60e6 Pa. Herbaceous stems as whole sections
    /// (Niklas 1992, Plant Biomechanics): 0.1e9 to 2e9 Pa, strength 1e6 to 20e6. Densities are those of tissue full of
    /// water: 850 to 1100.
    pub const fn tissue(self) -> Tissue {
        match self {
            Self::Hardwood => Tissue { modulus_pa: 9e9, density_kg_m3: 1000.0, strength_pa: 6e7 },
            Self::Softwood => Tissue { modulus_pa: 8e9, density_kg_m3: 850.0, strength_pa: 5e7 },
            Self::Green => Tissue { modulus_pa: 6e8, density_kg_m3: 1000.0, strength_pa: 5e6 },
        }
    }

    /// Infers the group of a plant: conifers by their needles, herbs by the names of the species that come with Burgeon
    /// or by having stems and stalks alone; all others are hardwood. Green stems and stalks are green in any group.
    pub fn seen_in(plant: &Plant) -> Self {
        let name = plant.name.trim().to_lowercase();
        let has_needles = |s: &Shape| matches!(s, Shape::Blade(blade) if blade.needles.is_some());
        let has_wood =
            |a: &plant::Axis| !matches!(a.kind, AxisKind::Stem | AxisKind::Petiole | AxisKind::Root);
        if HERBS.contains(&name.as_str()) || !plant.axes.iter().any(has_wood) {
            Self::Green
        } else if plant.shapes.iter().any(has_needles) {
            Self::Softwood
        } else {
            Self::Hardwood
        }
    }

    /// Returns the group of one axis of a plant of this group.
    pub(crate) const fn group_of_axis(self, kind: AxisKind) -> Self {
        match kind {
            AxisKind::Stem | AxisKind::Petiole => Self::Green,
            _ => self,
        }
    }
}

/// Species without wood whose stems are grown as branches, by the names of their presets in lower case.
const HERBS: [&str; 6] = ["wheat", "maize", "fountain grass", "common reed", "banana", "century plant"];

/// Mass of a leaf over the area of one side, kilograms per square metre: fresh leaves have 0.1 to 0.4.
const LEAF_KG_M2: f64 = 0.2;

/// Mass of a petal over the area of one side, kilograms per square metre: fresh petals have 0.05 to 0.2.
const PETAL_KG_M2: f64 = 0.1;

/// Density of fruits, discs and other fleshy bodies, kilograms per cubic metre: nearly that of water.
const FLESH_KG_M3: f64 = 1000.0;

/// Mass and projected area of a shape as an organ of a kind, at scale 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weighed {
    /// Mass, kilograms.
    pub(crate) mass: f64,
    /// Area of one side of a sheet, projected area of a body; square metres.
    pub(crate) area_m2: f64,
    /// The shape is a thin sheet: its mass scales with the area, not the volume.
    pub(crate) is_flat: bool,
}

/// Computes mass and area of a shape. Pots weigh nothing: they are not part of the plant.
pub(crate) fn weigh(kind: OrganKind, shape: &Shape) -> Weighed {
    let is_flat = matches!(shape, Shape::Blade(_) | Shape::Spline(_) | Shape::Sheet(_));
    let side = shape.one_side_m2();
    // Half of a ball's surface is twice its projected area.
    let area_m2 = if is_flat { side } else { side / 2.0 };
    let mass = match kind {
        OrganKind::Pot => return Weighed { mass: 0.0, area_m2: 0.0, is_flat },
        OrganKind::Leaf | OrganKind::Sepal if is_flat => LEAF_KG_M2 * side,
        _ if is_flat => PETAL_KG_M2 * side,
        _ => FLESH_KG_M3 * volume_m3(shape),
    };
    Weighed { mass, area_m2, is_flat }
}

/// Returns the volume of a round shape at scale 1, cubic metres; 0 for sheets.
fn volume_m3(shape: &Shape) -> f64 {
    use base::ops::PI;
    match shape {
        Shape::Dome { radius_m: r, height_m: h } => PI * h / 6.0 * (3.0 * r * r + h * h),
        Shape::Revolution { profile } => {
            let ring =
                |w: &[glam::DVec2]| (w[1].y - w[0].y) * (w[0].x * w[0].x + w[0].x * w[1].x + w[1].x * w[1].x);
            profile.windows(2).map(ring).sum::<f64>().abs() * PI / 3.0
        }
        Shape::Strand { path, radius_m, knob_m } => {
            let piece = |(p, r): (&[glam::DVec3], &[f64])| {
                PI / 3.0 * p[0].distance(p[1]) * (r[0] * r[0] + r[0] * r[1] + r[1] * r[1])
            };
            let line: f64 = path.windows(2).zip(radius_m.windows(2)).map(piece).sum();
            line + 4.0 / 3.0 * PI * knob_m * knob_m * knob_m
        }
        _ => 0.0,
    }
}
