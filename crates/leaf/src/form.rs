//! A leaf with one midrib and pairs of side veins, defined by a few numbers: `LeafForm -> Marks`.

use base::ops;
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::marks::{MARKS_A_ROW, MIDRIB_SHARE, MarkRow, Marks};

/// The form of a leaf with one midrib, used if nothing was measured.
///
/// ```
/// let form: leaf::LeafForm = spec::from_toml("width = 0.3\nveins = 6").expect("a form");
/// assert_eq!((form.marks().rows.len(), form.marks().tip.y), (7, form.length_m));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LeafForm {
    /// Length of the midrib, metres, 0.002 to 10, default 0.1.
    #[schemars(range(min = 0.002, max = 10.0), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Greatest width over length, 0.02 to 2, default 0.5.
    #[schemars(range(min = 0.02, max = 2.0))]
    pub width: f64,
    /// Position of the greatest width: 0.1 near the base to 0.9 near the tip, default 0.4.
    #[schemars(range(min = 0.1, max = 0.9))]
    pub widest: f64,
    /// Pairs of side veins, 2 to 30, default 8.
    #[schemars(range(min = 2, max = 30))]
    pub veins: u32,
    /// Angle between side veins and midrib, degrees, 15 to 85, default 50. At the base it is wider.
    #[schemars(range(min = 15.0, max = 85.0), extend("x-unit" = "deg"))]
    pub vein_angle_deg: f64,
    /// Depth of the margin between the side veins, as a share of the half width: 0 (entire) to 0.8 (deep lobes),
    /// default 0.
    #[schemars(range(min = 0.0, max = 0.8))]
    pub lobes: f64,
    /// Angle by which both halves are raised along the midrib, degrees, -60 to 60, default 10.
    #[schemars(range(min = -60.0, max = 60.0), extend("x-unit" = "deg"))]
    pub fold_deg: f64,
}

impl Default for LeafForm {
    fn default() -> Self {
        Self {
            length_m: 0.1,
            width: 0.5,
            widest: 0.4,
            veins: 8,
            vein_angle_deg: 50.0,
            lobes: 0.0,
            fold_deg: 10.0,
        }
    }
}

/// Sum of the exponents of the outline: a smaller one makes it blunt, a larger one draws it out into long points.
const POINTED: f64 = 1.5;
/// Position of the last pair of side veins, as a share of the midrib's length.
const LAST: f64 = 0.93;
/// Widening of the angle between the lowest side veins and the midrib, degrees.
const BASE_WIDER: f64 = 30.0;
/// Share of the midrib's length along which that widening decreases to nothing.
const BASE: f64 = 0.3;

impl LeafForm {
    /// Returns its marks, as if they were measured: base at the origin, tip along +y, upper side towards +z.
    ///
    /// Guaranteed for numbers within their ranges: [`Marks::validate`] finds no fault; left and right are alike; every
    /// thickness is known, by the shares that are assumed if none was measured. A lobed leaf has a thin pair of veins
    /// in each gap.
    pub fn marks(&self) -> Marks {
        let pairs = self.veins.clamp(2, 30);
        let lobed = self.lobes > 0.0;
        let rows = if lobed { 2 * pairs - 1 } else { pairs };
        // From the tip down.
        let row = |k: u32| {
            let up = LAST * f64::from(rows - 1 - k) / f64::from(rows - 1);
            self.row(up, lobed && k % 2 == 1)
        };
        let rows = (0..rows).map(row).chain((!lobed).then(|| self.below())).collect();
        let tip_thickness = Some(MIDRIB_SHARE[0] * MIDRIB_SHARE[1] * self.length_m);
        Marks { rows, tip: DVec3::Y * self.length_m, tip_thickness, margin: Vec::new() }
    }

    /// Returns half the width at a share of the length, metres.
    fn half_width(&self, up: f64) -> f64 {
        let up = up.clamp(0.0, 1.0);
        let (low, high) = (POINTED * self.widest, POINTED * (1.0 - self.widest));
        let curve = |u: f64| ops::powf(u, low) * ops::powf(1.0 - u, high);
        0.5 * self.width * self.length_m * curve(up) / curve(self.widest)
    }

    /// Makes the pair of side veins that leaves the midrib at a share of its length; `gap`: it ends between two lobes.
    fn row(&self, up: f64, gap: bool) -> MarkRow {
        let wider = BASE_WIDER * (1.0 - up / BASE).max(0.0);
        let angle = (self.vein_angle_deg + wider).min(88.0) * (ops::PI / 180.0);
        let (sin, cos) = ops::sin_cos(angle);
        let rise = cos / sin;
        let (mut least, mut most) = (0.0, 0.5 * self.width * self.length_m);
        // The intersection with the outline: 40 halvings are precise to the last bits of a millimetre.
        for _ in 0..40 {
            let across = 0.5 * (least + most);
            if across < self.half_width(up + across * rise / self.length_m) {
                least = across;
            } else {
                most = across;
            }
        }
        // If the outline ends in a point, a vein still has some length.
        let across = least.max(0.01 * self.width * self.length_m);
        let reach = if gap { 1.0 - self.lobes } else { 1.0 };
        self.pair(up, (across * reach, rise), gap)
    }

    /// Returns the lower margin of an entire leaf, along which no side vein runs.
    fn below(&self) -> MarkRow {
        self.pair(-0.004, (0.02 * self.width * self.length_m, 0.1), true)
    }

    fn pair(&self, up: f64, (across, rise): (f64, f64), thin: bool) -> MarkRow {
        const MIDDLE: f64 = 3.0;
        let (sin, cos) = ops::sin_cos(self.fold_deg * (ops::PI / 180.0));
        let points = core::array::from_fn(|j| {
            let side = 1.0 - j as f64 / MIDDLE; // 1 on the right margin, -1 on the left
            let out = across * side.abs();
            DVec3::new(across * side * cos, up * self.length_m + out * rise, out * sin)
        });
        let [base, tip] = MIDRIB_SHARE;
        let midrib = base * self.length_m * ops::lerp(1.0, tip, up.max(0.0));
        let vein = midrib * if thin { 0.25 } else { 0.5 };
        let mut thickness = [None; MARKS_A_ROW];
        (thickness[0], thickness[3], thickness[MARKS_A_ROW - 1]) =
            (Some(0.2 * vein), Some(vein), Some(0.2 * vein));
        MarkRow { points, thickness, midrib: Some(midrib) }
    }
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::{Leaf, LeafSpec};

    #[test]
    fn every_form_makes_a_leaf_of_its_size() {
        for (width, widest, veins, vein_angle_deg, lobes) in [
            (0.5, 0.4, 8, 50.0, 0.0),
            (0.02, 0.1, 30, 15.0, 0.0),
            (2.0, 0.9, 2, 85.0, 0.0),
            (0.7, 0.6, 6, 45.0, 0.5),
            (2.0, 0.1, 30, 15.0, 0.8),
            (1.0, 0.5, 2, 15.0, 0.8),
        ] {
            let form = LeafForm { width, widest, veins, vein_angle_deg, lobes, ..LeafForm::default() };
            assert!(spec::check(&form).is_ok());
            let marks = form.marks();
            let mut report = Report::default();
            let full = marks.complete(&mut report).expect("sound marks");
            assert_eq!(report.warnings, [], "{form:?}");
            // If there are only two pairs, one lies far from the other.
            assert!(veins < 3 || marks.strays().is_empty(), "{form:?}");
            let across = marks.rows.iter().flat_map(|r| r.points).map(|p| p.x.abs()).fold(0.0, f64::max);
            let most = 0.5 * width * form.length_m;
            assert!(across <= most * 1.001 && across > 0.3 * most, "{form:?}: {across} of {most}");
            for row in &marks.rows {
                let [right, .., left] = row.points;
                assert_eq!((right.x, right.y, right.z), (-left.x, left.y, left.z), "left as right");
            }
            Leaf::new(&full, &LeafSpec::default()).expect("a blade");
        }
        assert!(spec::check(&LeafForm { lobes: 0.9, ..LeafForm::default() }).is_err());
    }

    #[test]
    fn the_outline_is_widest_where_it_is_asked_to_be() {
        for widest in [0.2, 0.5, 0.8] {
            let form = LeafForm { widest, ..LeafForm::default() };
            let best = (0..=1000).max_by(|&a, &b| {
                form.half_width(f64::from(a) / 1000.0).total_cmp(&form.half_width(f64::from(b) / 1000.0))
            });
            assert!((f64::from(best.unwrap()) / 1000.0 - widest).abs() < 0.002, "{best:?}");
            assert!((form.half_width(widest) - 0.025).abs() < 1e-12);
        }
    }
}
