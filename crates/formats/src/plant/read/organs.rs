//! Organs of a file, given by their length and area -> shapes.

use std::collections::BTreeMap;

use base::ops;
use glam::{DVec2, DVec3};
use plant::{Blade, BladeForm, Frame, NodeId, Organ, OrganKind, Paint, Plant, Shape, ShapeId};

/// An organ of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) kind: OrganKind,
    pub(super) bearer: Option<NodeId>,
    pub(super) frame: Frame,
    /// Length from root to tip, metres; none for bodies.
    pub(super) length_m: Option<f64>,
    /// Area of one side, square metres; none: usual for its length.
    pub(super) area_m2: Option<f64>,
    /// Its position in the file.
    pub(super) key: u64,
}

/// Shapes whose proportions differ by less than this share are the same.
const ALIKE: f64 = 0.02;

/// Adds organs to a plant; organs of similar proportions share a shape.
#[derive(Default)]
pub(super) struct Shapes {
    known: BTreeMap<(OrganKind, i64), (ShapeId, f64)>,
}

impl Shapes {
    /// Adds an organ and returns whether it did: it skips one without a size.
    pub(super) fn add(&mut self, plant: &mut Plant, found: &Found) -> bool {
        let sound = |x: Option<f64>| x.filter(|x| x.is_finite() && *x > 0.0);
        let (length, area) = (sound(found.length_m), sound(found.area_m2));
        if !found.frame.origin.is_finite() {
            return false;
        }
        let (proportion, scale) = match (length, area) {
            (Some(length), Some(area)) => (area / (length * length), length),
            (Some(length), None) => (usual(found.kind), length),
            (None, Some(area)) => (f64::NAN, area.sqrt()),
            (None, None) => return false,
        };
        #[expect(clippy::cast_possible_truncation, reason = "a logarithm of a finite number")]
        let step = if proportion.is_nan() { i64::MAX } else { (ops::ln(proportion) / ALIKE).round() as i64 };
        let entry = self.known.entry((found.kind, step));
        let (shape, unit) = *entry.or_insert_with(|| {
            let shape = shape(found.kind, (!proportion.is_nan()).then_some(proportion));
            // For bodies the area is exact, for other organs the length.
            let unit =
                if proportion.is_nan() { shape.one_side_m2().sqrt() } else { shape.length().unwrap_or(1.0) };
            (plant.add_shape(shape), unit)
        });
        plant.organs.push(Organ {
            kind: found.kind,
            bearer: found.bearer,
            flower: None,
            shape,
            frame: found.frame,
            scale: scale / unit.max(f64::MIN_POSITIVE),
            paint: Paint::default(),
            key: found.key,
            source: None,
        });
        true
    }
}

/// Returns the usual ratio of the area to the square of the length.
fn usual(kind: OrganKind) -> f64 {
    match kind {
        OrganKind::Stamen | OrganKind::Pistil | OrganKind::Thorn | OrganKind::Pedicel => 0.1,
        _ => 0.35,
    }
}

/// Returns a shape of length 1 with this area, or a round body.
fn shape(kind: OrganKind, proportion: Option<f64>) -> Shape {
    match (kind, proportion) {
        (OrganKind::Stamen | OrganKind::Pistil | OrganKind::Thorn | OrganKind::Pedicel, proportion) => {
            // Half of the surface of a strand of length 1.
            let radius = proportion.unwrap_or(0.1) / ops::PI;
            Shape::Strand { path: vec![DVec3::ZERO, DVec3::Y], radius_m: vec![radius, radius], knob_m: 0.0 }
        }
        (_, None) => Shape::Revolution { profile: ball() },
        (_, Some(proportion)) => Shape::Blade(leaf(proportion)),
    }
}

/// Returns a ball of radius 0.5 that stands on its root.
fn ball() -> Vec<DVec2> {
    const STEPS: u32 = 12;
    let point = |k: u32| {
        let (s, c) = ops::sin_cos(ops::PI * f64::from(k) / f64::from(STEPS));
        DVec2::new(if k.is_multiple_of(STEPS) { 0.0 } else { 0.5 * s }, 0.5 - 0.5 * c)
    };
    (0..=STEPS).map(point).collect()
}

/// Returns an ovate blade of length 1 with this area: flat, as the file does not describe its curvature.
fn leaf(area: f64) -> Blade {
    let mut blade = BladeForm::Ovate.blade();
    blade.relief = plant::Relief::default();
    let own = geom::signed_area(&blade.outline).abs();
    let wider = (area / own).clamp(0.01, 100.0);
    blade.outline.iter_mut().for_each(|p| p.x *= wider);
    blade
}
