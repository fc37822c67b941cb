//! The form of a flower head from the front: its radius in all directions, and the lobes that are its petals.

use base::ops;
use glam::DVec2;
use ink::StrokeClass;

use super::super::readers::Part;
use super::{MASSES, closed};

/// Number of directions in which the radius of a head is measured.
const DIRECTIONS: usize = 120;
/// Step along an outline between places at which the radius is measured, as a share of its greatest radius.
const STEP: f64 = 0.005;

/// The radius of a head in all directions.
pub(crate) struct Profile {
    middle: DVec2,
    radius: Vec<f64>,
}

impl Profile {
    /// Measures a simple outline about a place in it.
    pub(crate) fn new(outline: &[DVec2], middle: DVec2) -> Self {
        let size = outline.iter().map(|p| p.distance(middle)).fold(1e-6, f64::max);
        let mut radius = vec![0.0_f64; DIRECTIONS];
        let step = ops::TAU / DIRECTIONS as f64;
        for p in geom::resample(&closed(outline), STEP * size) {
            let away = p - middle;
            let turn = ops::atan2(away.y, away.x).rem_euclid(ops::TAU) / step;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped to the directions"
            )]
            let row = (turn as usize).min(DIRECTIONS - 1);
            radius[row] = radius[row].max(away.length());
        }
        Self { middle, radius }
    }

    fn mean(&self) -> f64 {
        self.radius.iter().sum::<f64>() / DIRECTIONS as f64
    }

    /// Returns the directions in which it is narrowest between two lobes, in order; none if it has no lobes.
    fn notches(&self) -> Vec<usize> {
        let least = MASSES.prominent * self.mean();
        let n = DIRECTIONS;
        let Some(start) = (0..n).min_by(|&a, &b| self.radius[a].total_cmp(&self.radius[b])) else {
            return Vec::new();
        };
        // From the narrowest direction round: a lobe ends where the radius has fallen far enough from its highest, and
        // the next one begins where it has risen again.
        let mut notches = vec![start];
        let (mut low, mut high, mut rising) = (start, self.radius[start], true);
        for k in (1..n).map(|k| (start + k) % n) {
            let r = self.radius[k];
            if rising {
                high = high.max(r);
                if r < high - least {
                    (rising, low) = (false, k);
                }
            } else {
                if r < self.radius[low] {
                    low = k;
                }
                if r > self.radius[low] + least {
                    notches.push(low);
                    (rising, high) = (true, r);
                }
            }
        }
        notches
    }

    /// Returns the directions between its lobes, if it has those of a flower, of similar width.
    pub(crate) fn lobes(&self) -> Option<Vec<usize>> {
        let is_flower = |notches: &Vec<usize>| {
            (MASSES.lobes[0]..=MASSES.lobes[1]).contains(&notches.len()) && are_even(notches)
        };
        Some(self.notches()).filter(is_flower)
    }

    /// Returns the petals and the disc of a head.
    pub(crate) fn organs(&self, strokes: &[usize]) -> Vec<Part> {
        let hub = MASSES.disc[usize::from(self.lobes().is_none())] * self.mean();
        let mut parts = self.petals(hub, strokes);
        let disc: Vec<DVec2> = (0..=24)
            .map(|k| self.middle + hub * direction(DIRECTIONS as f64 * f64::from(k) / 24.0))
            .collect();
        parts.push(Part { points: disc, class: StrokeClass::Disc, root: None, strokes: strokes.to_vec() });
        parts
    }

    /// Returns a petal for each lobe, or rays if there are none, round a disc of a radius.
    pub(crate) fn petals(&self, hub: f64, strokes: &[usize]) -> Vec<Part> {
        let rays = || (0..MASSES.rays).map(|k| k * DIRECTIONS / MASSES.rays).collect();
        let from: Vec<usize> = self.lobes().unwrap_or_else(rays);
        (0..from.len()).map(|k| self.petal(from[k], from[(k + 1) % from.len()], hub, strokes)).collect()
    }

    /// Returns the petal between two directions.
    fn petal(&self, from: usize, to: usize, hub: f64, strokes: &[usize]) -> Part {
        let span = (to + DIRECTIONS - from - 1) % DIRECTIONS + 1;
        let middle = direction(from as f64 + 0.5 * span as f64);
        let root = self.middle + 0.9 * hub * middle;
        let rim = (0..=span).map(|k| {
            let t = 2.0 * k as f64 / span as f64 - 1.0;
            let at = (from + k) % DIRECTIONS;
            let r = self.radius[at] * (1.0 - MASSES.rounded * (t * t) * (t * t));
            self.middle + r * direction(at as f64)
        });
        let points: Vec<DVec2> = core::iter::once(root).chain(rim).chain([root]).collect();
        Part { points, class: StrokeClass::Blade, root: Some(root), strokes: strokes.to_vec() }
    }
}

/// Whether lobes between these notches, in their order round a head, are of similar width.
fn are_even(notches: &[usize]) -> bool {
    let next = notches.iter().cycle().skip(1);
    let widths = notches.iter().zip(next).map(|(a, b)| (b + DIRECTIONS - a - 1) % DIRECTIONS + 1);
    let widest = widths.max().unwrap_or_default();
    (widest * notches.len()) as f64 <= MASSES.uneven * DIRECTIONS as f64
}

/// Returns the unit vector of a direction, by its number.
fn direction(k: f64) -> DVec2 {
    let angle = (k + 0.5) * ops::TAU / DIRECTIONS as f64;
    DVec2::new(ops::cos(angle), ops::sin(angle))
}
