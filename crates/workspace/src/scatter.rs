//! Places of copies of a plant: along a line, in an area, under a brush.

use burgeon::document::{Placement, PlantId};
use burgeon::geom;
use burgeon::glam::{DVec2, DVec3};
use burgeon::{Draw, Seed, Stream};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Copies of a plant, and the ground that they stand on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scatter {
    /// The plant.
    pub plant: PlantId,
    /// The ground.
    pub ground: Ground,
    /// Least distance between any two plants, metres; 0.001 to 10,000.
    pub spacing_m: f64,
    /// Number of different plants among the copies, each with a seed of its own; 0 for copies that are all alike.
    pub kinds: u32,
    /// Variation of size: copies are up to this share smaller or larger; 0 to 0.9.
    pub vary: f64,
}

/// Places on the ground: x and z, metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Ground {
    /// In a row along a line.
    Line(Vec<[f64; 2]>),
    /// All over a closed outline.
    Area(Vec<[f64; 2]>),
    /// All over the ground that a brush covers.
    Brush {
        /// Path of the brush.
        path: Vec<[f64; 2]>,
        /// Its radius, metres.
        radius_m: f64,
    },
}

/// Number of successive misses of darts after which the ground counts as full.
const MISSES: usize = 400;
/// Most places: as many as a scene may have plants.
const MOST: usize = 200;

/// Returns places all over an outline with at least `spacing_m` between them, at most `most`, each with a random
/// rotation and up to a share of `vary` (0 to 0.9) smaller or larger, for plants that shells show but no document
/// holds.
///
/// The same places for the same seed; outlines and numbers as in [`Scatter`]. Cost: quadratic in places.
pub fn stand(outline: &[[f64; 2]], spacing_m: f64, vary: f64, most: usize, seed: Seed) -> Vec<Placement> {
    let spacing = if spacing_m.is_finite() { spacing_m.clamp(1e-3, 1e4) } else { 1.0 };
    let vary = if vary.is_finite() { vary.clamp(0.0, 0.9) } else { 0.0 };
    let outline: Vec<DVec2> =
        outline.iter().map(|&p| DVec2::from(p)).filter(|p| p.abs().max_element() <= 1e5).collect();
    let mut stream = seed.stream(Draw::Scatter);
    let within = |p| geom::contains(&outline, p);
    let found = darts((&outline, 0.0), spacing, (&[], most), &mut stream, within);
    found.into_iter().map(|at| turned(at, 0.0, 1.0, vary, &mut stream)).collect()
}

/// Makes a place on the ground with a random rotation and size.
pub(crate) fn turned(at: DVec2, height_m: f64, scale: f64, vary: f64, stream: &mut Stream) -> Placement {
    Placement {
        position: DVec3::new(at.x, height_m, at.y),
        yaw_deg: (stream.range(0.0, 3600.0)).round() / 10.0,
        scale: (scale * stream.range(1.0 - vary, 1.0 + vary) * 1000.0).round() / 1000.0,
    }
}

/// Finds places with at least `spacing` between them and from those that are taken.
pub(crate) fn places(ground: &Ground, spacing: f64, taken: &[DVec2], stream: &mut Stream) -> Vec<DVec2> {
    let finite = |points: &[[f64; 2]]| -> Vec<DVec2> {
        points.iter().map(|&p| DVec2::from(p)).filter(|p| p.abs().max_element() <= 1e5).collect()
    };
    match ground {
        Ground::Line(line) => row(&finite(line), spacing, taken),
        Ground::Area(outline) => {
            let outline = finite(outline);
            darts((&outline, 0.0), spacing, (taken, MOST), stream, |p| geom::contains(&outline, p))
        }
        Ground::Brush { path, radius_m } => {
            let (path, radius) =
                (finite(path), if radius_m.is_finite() { radius_m.clamp(0.0, 1e5) } else { 0.0 });
            let near = |p| geom::distance_to_polyline(&path, p).is_some_and(|d| d <= radius);
            darts((&path, radius), spacing, (taken, MOST), stream, near)
        }
    }
}

/// Places points every `spacing` metres along a line, from its start.
fn row(line: &[DVec2], spacing: f64, taken: &[DVec2]) -> Vec<DVec2> {
    let mut out: Vec<DVec2> = Vec::new();
    let mut next = 0.0;
    for w in line.windows(2) {
        let length = w[0].distance(w[1]);
        while next <= length && out.len() < MOST {
            let at = w[0].lerp(w[1], if length > 0.0 { next / length } else { 0.0 });
            // A thousandth less: the length of a path is not exact.
            if taken.iter().all(|t| t.distance(at) >= 0.999 * spacing) {
                out.push(at);
            }
            next += spacing;
        }
        next -= length;
    }
    out
}

/// Draws Poisson-disc samples by darts (Cook 1986): each falls anywhere in the box and stays where it has room.
fn darts(
    (around, margin): (&[DVec2], f64),
    spacing: f64,
    (taken, most): (&[DVec2], usize),
    stream: &mut Stream,
    within: impl Fn(DVec2) -> bool,
) -> Vec<DVec2> {
    let (low, high) = around.iter().fold((DVec2::MAX, DVec2::MIN), |(a, b), &p| (a.min(p), b.max(p)));
    let (low, high) = (low - margin, high + margin);
    let mut out: Vec<DVec2> = Vec::new();
    let mut misses = 0;
    while misses < MISSES && out.len() < most && low.cmple(high).all() {
        let at = DVec2::new(stream.range(low.x, high.x), stream.range(low.y, high.y));
        let free = within(at) && taken.iter().chain(&out).all(|t| t.distance(at) >= spacing);
        misses = if free { 0 } else { misses + 1 };
        if free {
            out.push(at);
        }
    }
    out
}
