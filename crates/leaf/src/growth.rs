//! A leaf between the days on which it was measured.

use base::ops;
use glam::DVec3;

use crate::blade::Leaf;
use crate::marks::{FullMarks, FullRow, MARKS_A_ROW, MarksError};
use crate::spec::LeafSpec;
use crate::thickness::ThicknessRule;

/// A leaf measured on several days.
///
/// The length grows along a monotone curve of its logarithm, the shape (marks from the root, in lengths) and the
/// thickness along straight lines between stages. Guaranteed: on each measured day the measured marks; between two days
/// a length between theirs. Not supported: days outside the measured ones.
#[derive(Clone, Debug, PartialEq)]
pub struct LeafGrowth {
    stages: Vec<Stage>,
}

#[derive(Clone, Debug, PartialEq)]
struct Stage {
    day: f64,
    marks: FullMarks,
    length: f64,
    // Slope of the logarithm of the length, per day.
    slope: f64,
}

/// Reason why no leaf can be grown between stages.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StagesError {
    /// There are fewer than two stages.
    #[error("growth needs at least 2 stages, {0} were given")]
    TooFew(usize),
    /// The days do not increase.
    #[error("day {this} comes after day {before}; give the stages in the order of their days, each day once")]
    Order {
        /// The earlier entry.
        before: f64,
        /// The later entry.
        this: f64,
    },
    /// A day is not a finite number, or the requested day is not covered.
    #[error("day {day} is outside the measured days {first} to {last}")]
    Outside {
        /// The requested day.
        day: f64,
        /// The first day measured.
        first: f64,
        /// The last day measured.
        last: f64,
    },
    /// The stages cannot be one leaf, for example because their units differ.
    #[error(
        "from day {before} to day {this} the leaf's length changes {factor:.3} times; are both in the same unit?"
    )]
    Unit {
        /// The earlier day.
        before: f64,
        /// The later day.
        this: f64,
        /// Later length over earlier length.
        factor: f64,
    },
    /// The marks of a stage make no leaf.
    #[error("day {day}: {fault}")]
    Marks {
        /// The stage's day.
        day: f64,
        /// The fault.
        fault: MarksError,
    },
}

// A leaf may grow a hundredfold between two visits; a factor of 1000 means millimetres taken for metres.
const MOST: f64 = 300.0;

impl LeafGrowth {
    /// Makes the stages of one leaf by day. Stages with fewer rows than others are resampled on their own blade.
    ///
    /// # Errors
    /// [`StagesError`].
    pub fn new(stages: Vec<(f64, FullMarks)>) -> Result<Self, StagesError> {
        if stages.len() < 2 {
            return Err(StagesError::TooFew(stages.len()));
        }
        for w in stages.windows(2) {
            let (before, this) = (w[0].0, w[1].0);
            if before.is_nan() || this.is_nan() || before >= this || !(this - before).is_finite() {
                return Err(StagesError::Order { before, this });
            }
        }
        let rows = stages.iter().map(|s| s.1.rows.len()).max().unwrap_or(0);
        let mut all = Vec::with_capacity(stages.len());
        for (day, marks) in stages {
            if let Some(fault) = marks.to_marks().validate().next() {
                return Err(StagesError::Marks { day, fault });
            }
            let marks = with_rows(marks, rows);
            let length = geom::polyline_length3(&marks.midrib());
            all.push(Stage { day, marks, length, slope: 0.0 });
        }
        for w in all.windows(2) {
            let factor = w[1].length / w[0].length;
            if !(1.0 / MOST..=MOST).contains(&factor) {
                return Err(StagesError::Unit { before: w[0].day, this: w[1].day, factor });
            }
        }
        set_slopes(&mut all);
        Ok(Self { stages: all })
    }

    /// Returns the first and the last day.
    pub fn days(&self) -> (f64, f64) {
        (self.stages[0].day, self.stages[self.stages.len() - 1].day)
    }

    /// Returns the leaf on a day between the first and the last.
    ///
    /// # Errors
    /// [`StagesError::Outside`].
    pub fn marks_on_day(&self, day: f64) -> Result<FullMarks, StagesError> {
        let (first, last) = self.days();
        if !(first..=last).contains(&day) {
            return Err(StagesError::Outside { day, first, last });
        }
        let next = self.stages.partition_point(|s| s.day <= day).clamp(1, self.stages.len() - 1);
        let (a, b) = (&self.stages[next - 1], &self.stages[next]);
        let width = b.day - a.day;
        let t = (day - a.day) / width;
        // Exactly the measured marks on the measured days.
        if t <= 0.0 {
            return Ok(a.marks.clone());
        }
        if t >= 1.0 {
            return Ok(b.marks.clone());
        }
        // Cubic Hermite of the logarithm (Fritsch and Carlson 1980: monotone with the slopes chosen here).
        let (la, lb) = (ops::ln(a.length), ops::ln(b.length));
        let (t2, t3) = (t * t, t * t * t);
        let log = (2.0 * t3 - 3.0 * t2 + 1.0) * la
            + (t3 - 2.0 * t2 + t) * width * a.slope
            + (3.0 * t2 - 2.0 * t3) * lb
            + (t3 - t2) * width * b.slope;
        let length = ops::exp(log);
        let (ra, rb) = (a.marks.root(), b.marks.root());
        let root = ra.lerp(rb, t);
        let mut raw = blend(
            &a.marks,
            &b.marks,
            |p, q| ((p - ra) / a.length).lerp((q - rb) / b.length, t),
            |x, y| ops::lerp(x, y, t),
        );
        // The teeth on two days do not correspond: those of the nearer day follow the blade.
        if !a.marks.margin.is_empty() && !b.marks.margin.is_empty() {
            raw.margin.clone_from(&if t < 0.5 { a } else { b }.marks.margin);
        }
        // Straight lines between turned shapes are slightly short: the result is scaled back to the length.
        let scale = length / geom::polyline_length3(&raw.midrib()).max(f64::MIN_POSITIVE);
        Ok(raw.map(|p| root + p * scale, |t| t))
    }
}

fn blend(
    a: &FullMarks,
    b: &FullMarks,
    point: impl Fn(DVec3, DVec3) -> DVec3,
    thickness: impl Fn(f64, f64) -> f64,
) -> FullMarks {
    let rows = a.rows.iter().zip(&b.rows).map(|(x, y)| FullRow {
        points: core::array::from_fn(|j| point(x.points[j], y.points[j])),
        thickness: core::array::from_fn(|j| thickness(x.thickness[j], y.thickness[j])),
        midrib: thickness(x.midrib, y.midrib),
    });
    FullMarks {
        rows: rows.collect(),
        tip: point(a.tip, b.tip),
        tip_thickness: thickness(a.tip_thickness, b.tip_thickness),
        margin: Vec::new(),
    }
}

/// Sets the slopes of the logarithm of the length for a monotone cubic (weighted harmonic mean of neighbouring chords).
fn set_slopes(stages: &mut [Stage]) {
    let chord = |a: &Stage, b: &Stage| (ops::ln(b.length) - ops::ln(a.length)) / (b.day - a.day);
    let chords: Vec<f64> = stages.windows(2).map(|w| chord(&w[0], &w[1])).collect();
    let n = stages.len();
    for k in 0..n {
        stages[k].slope = if k == 0 {
            chords[0]
        } else if k + 1 == n {
            chords[n - 2]
        } else {
            let (a, b) = (chords[k - 1], chords[k]);
            let (h0, h1) = (stages[k].day - stages[k - 1].day, stages[k + 1].day - stages[k].day);
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            if a * b > 0.0 { (w0 + w1) / (w0 / a + w1 / b) } else { 0.0 }
        };
    }
}

/// Resamples a leaf to `rows` rows: its interpolating blade and veins at even steps of the row's number.
fn with_rows(marks: FullMarks, rows: usize) -> FullMarks {
    let have = marks.rows.len();
    if have == rows {
        return marks;
    }
    let spec = LeafSpec { thickness: Some(ThicknessRule::Radius), ..LeafSpec::default() };
    let Ok(leaf) = Leaf::new(&marks, &spec) else { return marks };
    let places = leaf.blade.rows_at();
    let radii = |i: usize, j: usize| marks.rows[have - 1 - i.min(have - 1)].thickness[j];
    let row = |k: usize| {
        // Row k of the new ones from the root; the tip is not a row.
        let x = k as f64 * have as f64 / rows as f64;
        let i = (0..have).rev().find(|&i| i as f64 <= x).unwrap_or(0);
        let part = x - i as f64;
        let v = ops::lerp(places[i], places[i + 1], part);
        let points =
            core::array::from_fn(|j| leaf.blade.point(leaf.blade.columns_at()[MARKS_A_ROW - 1 - j], v));
        let thickness = core::array::from_fn(|j| ops::lerp(radii(i, j), radii(i + 1, j), part));
        FullRow { points, thickness, midrib: leaf.midrib.curve.ball(v).radius }
    };
    let margin = marks.margin_places();
    let more = FullMarks { rows: (0..rows).rev().map(row).collect(), margin: Vec::new(), ..marks };
    let bare = more.clone();
    more.within(&margin).unwrap_or(bare)
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::marks::tests::sample;

    fn full(rows: usize, size: f64) -> FullMarks {
        sample(rows).complete(&mut Report::default()).unwrap().scaled(size)
    }

    fn length(m: &FullMarks) -> f64 {
        geom::polyline_length3(&m.midrib())
    }

    #[test]
    fn measured_days_are_met_exactly_and_length_is_monotone() {
        let stages =
            vec![(5.0, full(6, 0.02)), (9.0, full(6, 0.1)), (12.0, full(6, 0.11)), (20.0, full(6, 0.3))];
        let growth = LeafGrowth::new(stages.clone()).unwrap();
        for (day, marks) in &stages {
            assert_eq!(&growth.marks_on_day(*day).unwrap(), marks);
        }
        let mut last = 0.0;
        for k in 0..=150 {
            let now = length(&growth.marks_on_day(5.0 + f64::from(k) * 0.1).unwrap());
            assert!(now >= last, "{k}: {now} after {last}");
            last = now;
        }
    }

    #[test]
    fn constant_rate_is_found_between() {
        let growth = LeafGrowth::new(vec![(0.0, full(5, 0.1)), (10.0, full(5, 0.4))]).unwrap();
        let middle = growth.marks_on_day(5.0).unwrap();
        assert!((length(&middle) / length(&full(5, 0.2)) - 1.0).abs() < 1e-12);
        assert!(
            middle.rows[2].points[1].distance(full(5, 0.2).rows[2].points[1] - full(5, 0.2).root()) < 1e-12
        );
    }

    #[test]
    fn stages_of_different_rows_become_one_leaf() {
        let growth = LeafGrowth::new(vec![(0.0, full(4, 0.1)), (10.0, full(9, 0.3))]).unwrap();
        let young = growth.marks_on_day(0.0).unwrap();
        assert_eq!(young.rows.len(), 9);
        assert!(young.to_marks().validate().next().is_none());
        assert!((length(&young) / length(&full(4, 0.1)) - 1.0).abs() < 0.01);
        // The root and the tip are the same points.
        assert!(young.root().distance(full(4, 0.1).root()) < 1e-12 && young.tip == full(4, 0.1).tip);
    }

    #[test]
    fn wrong_series_are_refused() {
        let one = || full(4, 0.1);
        assert_eq!(LeafGrowth::new(vec![(1.0, one())]), Err(StagesError::TooFew(1)));
        assert!(matches!(LeafGrowth::new(vec![(2.0, one()), (1.0, one())]), Err(StagesError::Order { .. })));
        assert!(matches!(
            LeafGrowth::new(vec![(1.0, one()), (f64::NAN, one())]),
            Err(StagesError::Order { .. })
        ));
        let millimetres = full(4, 1000.0 * 0.12);
        assert!(matches!(
            LeafGrowth::new(vec![(1.0, one()), (2.0, millimetres)]),
            Err(StagesError::Unit { .. })
        ));
        let growth = LeafGrowth::new(vec![(1.0, one()), (2.0, one())]).unwrap();
        assert!(matches!(growth.marks_on_day(2.5), Err(StagesError::Outside { .. })));
        assert!(matches!(growth.marks_on_day(f64::NAN), Err(StagesError::Outside { .. })));
    }
}
