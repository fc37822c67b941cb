//! The guarantees of every reading.

use core::fmt;

use geom::{point_at, polyline_length, self_crossings, signed_area};
use glam::DVec2;

use crate::thresholds::NO_LENGTH;
use crate::{Attachment, BladeReading, Reading};

/// A fault that no reading may have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadingFault {
    /// List of the reading.
    pub part: &'static str,
    /// Row in that list.
    pub row: usize,
    /// Description of the fault.
    pub what: &'static str,
}

impl fmt::Display for ReadingFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: {}", self.part, self.row, self.what)
    }
}

impl Reading {
    /// Returns all faults of this reading; none for a reading that [`crate::read`] makes.
    ///
    /// Checks that bearers come first and bases lie on them, that numbers are finite, that outlines are simple,
    /// counter-clockwise and have 3 points or more, that lines have 2.
    pub fn validate(&self) -> impl Iterator<Item = ReadingFault> {
        let mut faults = Vec::new();
        let mut check = |ok: bool, part: &'static str, row: usize, what: &'static str| {
            if !ok {
                faults.push(ReadingFault { part, row, what });
            }
        };
        for (row, axis) in self.axes.iter().enumerate() {
            check(line(&axis.points), "axis", row, "is no line of finite points");
            check(
                axis.half_width.is_empty() || axis.half_width.len() == axis.points.len(),
                "axis",
                row,
                "has not one half width per point",
            );
            check(
                axis.half_width.iter().all(|h| h.is_finite() && *h >= 0.0),
                "axis",
                row,
                "has a bad half width",
            );
            if let Some(b) = axis.bearer {
                check(b.axis < row, "axis", row, "comes before its bearer");
                check(self.on_axis(b), "axis", row, "is borne outside its bearer");
                let foot = self.axes.get(b.axis).and_then(|a| point_at(&a.points, b.at));
                let base = axis.points.first();
                let together = foot.zip(base).is_some_and(|(f, p)| f.distance(*p) < NO_LENGTH);
                check(together, "axis", row, "does not begin on its bearer");
            }
        }
        for (row, leaf) in self.leaves.iter().enumerate() {
            check(self.blade(leaf), "leaf", row, "has a bad outline, midrib or bearer");
        }
        for (row, flower) in self.flowers.iter().enumerate() {
            check(flower.centre.is_finite(), "flower", row, "has no centre");
            check(flower.petals.iter().all(|p| self.blade(p)), "flower", row, "has a bad petal");
            check(flower.stamens.iter().all(|s| line(s)), "flower", row, "has a bad stamen");
            check(flower.bearer.is_none_or(|b| self.on_axis(b)), "flower", row, "has a bad bearer");
            let disc =
                flower.disc.is_none_or(|d| d.centre.is_finite() && d.radius.is_finite() && d.radius > 0.0);
            check(disc, "flower", row, "has a bad disc");
            check(!flower.petals.is_empty() || flower.disc.is_some(), "flower", row, "is nothing");
        }
        for (row, region) in self.regions.iter().enumerate() {
            check(outline(&region.outline), "region", row, "has a bad outline");
            check(!region.bearers.is_empty(), "region", row, "has no bearer");
            check(region.bearers.iter().all(|b| *b < self.axes.len()), "region", row, "has a bad bearer");
        }
        for (row, fruit) in self.fruits.iter().enumerate() {
            check(outline(&fruit.outline), "fruit", row, "has a bad outline");
            check(fruit.bearer.is_none_or(|b| self.on_axis(b)), "fruit", row, "has a bad bearer");
        }
        for (row, (points, bearer, _)) in self.thorns.iter().enumerate() {
            check(line(points), "thorn", row, "is no line of finite points");
            check(bearer.is_none_or(|b| self.on_axis(b)), "thorn", row, "has a bad bearer");
        }
        let ascending = self.strokes.windows(2).all(|w| w[0].index < w[1].index);
        check(ascending, "stroke", 0, "is out of order");
        faults.into_iter()
    }

    fn on_axis(&self, b: Attachment) -> bool {
        self.axes.get(b.axis).is_some_and(|a| b.at >= 0.0 && b.at <= polyline_length(&a.points) + NO_LENGTH)
    }

    fn blade(&self, b: &BladeReading) -> bool {
        let veins = line(&b.midrib) && b.veins.iter().all(|v| line(&v.points));
        let ends = b.root.is_finite() && b.tip.is_finite();
        outline(&b.outline) && veins && ends && b.bearer.is_none_or(|a| self.on_axis(a))
    }
}

fn line(points: &[DVec2]) -> bool {
    points.len() >= 2 && points.iter().all(|p| p.is_finite())
}

fn outline(points: &[DVec2]) -> bool {
    points.len() >= 3
        && points.iter().all(|p| p.is_finite())
        && signed_area(points) > 0.0
        && self_crossings(points) == 0
}
