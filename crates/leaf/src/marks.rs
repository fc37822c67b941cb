//! Measurements of a leaf: rows of marks along the side veins, with thickness.

use base::Report;
use glam::DVec3;

/// Marks on each side vein, margin to margin; the fourth lies on the midrib.
pub const MARKS_A_ROW: usize = 7;

const MIDDLE: usize = 3;

/// Thickness of the blade as a share of the mean thickness of its veins (Wang et al. 2011, section 2).
const BLADE_SHARE: f64 = 0.026;

/// Measured marks of one leaf; thickness may be missing.
///
/// Wang et al. (2011), section 1.2: rows are counted from the tip down, marks from the right margin to the left seen on
/// the upper side with the tip up; the fourth lies where the side veins leave the midrib.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Rows from the tip down, at least 2.
    pub rows: Vec<MarkRow>,
    /// The tip, metres.
    pub tip: DVec3,
    /// Thickness of the midrib at the tip, metres.
    pub tip_thickness: Option<f64>,
    /// The margin, metres: once round the blade, from any point on; empty if it follows the ends of the rows. With it
    /// the blade has its teeth and lobes.
    pub margin: Vec<DVec3>,
}

/// One pair of side veins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkRow {
    /// The marks from right to left, metres.
    pub points: [DVec3; MARKS_A_ROW],
    /// Thickness of the side veins at the marks, metres; above 0.
    pub thickness: [Option<f64>; MARKS_A_ROW],
    /// Thickness of the midrib at the fourth mark, metres; above 0.
    pub midrib: Option<f64>,
}

/// Marks with all thicknesses known; see [`Marks::complete`].
#[derive(Clone, Debug, PartialEq)]
pub struct FullMarks {
    /// Rows from the tip down.
    pub rows: Vec<FullRow>,
    /// The tip.
    pub tip: DVec3,
    /// Thickness of the midrib at the tip.
    pub tip_thickness: f64,
    /// The margin, counter-clockwise seen on the upper side; empty if it follows the ends of the rows.
    pub margin: Vec<MarginPoint>,
}

/// One pair of side veins with every thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullRow {
    /// The marks from right to left.
    pub points: [DVec3; MARKS_A_ROW],
    /// Thickness of the side veins.
    pub thickness: [f64; MARKS_A_ROW],
    /// Thickness of the midrib.
    pub midrib: f64,
}

/// A point of the margin, attached to the nearest point of the blade, so that it follows the blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarginPoint {
    /// Column of the nearest point: marks from the left margin (0) to the right (6).
    pub column: f64,
    /// Row of the nearest point: rows from the last (0) to the tip.
    pub row: f64,
    /// Offset from the nearest point: to the right along the row, towards the tip, to the upper side; in lengths of the
    /// midrib.
    pub off: DVec3,
}

/// Reason why marks cannot make a leaf. Rows and marks are counted from 1, as in the file.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MarksError {
    /// There are too few side veins.
    #[error("{0} rows of marks are too few for a blade; measure at least 2 side veins")]
    TooFewRows(usize),
    /// A coordinate is not a usable number.
    #[error("row {row}, mark {mark}: a coordinate is not a finite number; measure it again")]
    NotFinite {
        /// Row from 1; 0 for the tip.
        row: usize,
        /// Mark from 1.
        mark: usize,
    },
    /// A thickness is 0, negative or not a number.
    #[error(
        "row {row}, mark {mark}: a thickness must be above 0, not {value}; leave it empty if it was not measured"
    )]
    Thickness {
        /// Row from 1; 0 for the tip.
        row: usize,
        /// Mark from 1; the midrib's own thickness counts as mark 4.
        mark: usize,
        /// The value given, metres.
        value: f64,
    },
    /// All marks of a row are one point.
    #[error("row {0}: all marks are the same point; only the tip may be repeated, and before the first row")]
    Point(usize),
    /// Two neighbouring rows share their point on the midrib.
    #[error("rows {0} and {next}: both meet the midrib in the same point; was a row entered twice?", next = .0 + 1)]
    SameRow(usize),
    /// The first row starts at the tip.
    #[error(
        "row 1 meets the midrib at the tip; the tip is repeated, or row 1 is the tip itself: remove one of them"
    )]
    TipRepeated,
    /// The ball to be moved does not exist.
    #[error(
        "there is no control ball {mark} in row {row}: the leaf has rows 1 to {rows} of marks 1 to 7, and the tip as row 0"
    )]
    NoBall {
        /// The requested row.
        row: usize,
        /// The requested mark.
        mark: usize,
        /// Number of rows of the leaf.
        rows: usize,
    },
    /// The margin has too few points.
    #[error("a margin of {0} points encloses nothing; give at least 3, or none")]
    MarginFew(usize),
    /// A coordinate of the margin is not a usable number.
    #[error("margin, point {0}: a coordinate is not a finite number; measure it again")]
    MarginNotFinite(usize),
    /// The margin crosses itself.
    #[error(
        "the margin crosses itself {0} times on the blade laid flat; give its points in order, once round the blade"
    )]
    MarginCrosses(usize),
    /// The margin does not enclose the middle of the midrib.
    #[error("the middle of the midrib does not lie within the margin; are both of one leaf, in one unit?")]
    MarginApart,
}

/// Assumed thickness of an unmeasured midrib at its base relative to its length, and at its tip relative to that at its
/// base. Our own numbers, those of the leaves in `fixtures/leaves`.
pub(crate) const MIDRIB_SHARE: [f64; 2] = [0.018, 0.08];

impl Marks {
    /// Returns the length of the midrib by the chords of its marks, from the last row to the tip.
    pub fn length(&self) -> f64 {
        let midrib = self.rows.iter().map(|r| r.points[MIDDLE]);
        let line: Vec<DVec3> = core::iter::once(self.tip).chain(midrib).collect();
        geom::polyline_length3(&line)
    }

    /// Returns all points scaled about the origin, thickness too.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let rows = self.rows.iter().map(|r| MarkRow {
            points: r.points.map(|p| p * factor),
            thickness: r.thickness.map(|t| t.map(|t| t * factor)),
            midrib: r.midrib.map(|t| t * factor),
        });
        Self {
            rows: rows.collect(),
            tip: self.tip * factor,
            tip_thickness: self.tip_thickness.map(|t| t * factor),
            margin: self.margin.iter().map(|&p| p * factor).collect(),
        }
    }

    /// Returns the marks that lie much farther from their neighbours than usual on this leaf, each as
    /// `(row, mark, ratio to the usual distance)`, row and mark from 1, row 0 for the tip.
    ///
    /// The measure is the distance to the nearest of the up to eight neighbours; 20 times the median is far. Such a
    /// mark may still be right.
    pub fn strays(&self) -> Vec<(usize, usize, f64)> {
        let rows = self.rows.len();
        let nearest = |i: usize, j: usize| {
            let p = self.rows[i].points[j];
            let around = (i.saturating_sub(1)..(i + 2).min(rows))
                .flat_map(|k| (j.saturating_sub(1)..(j + 2).min(MARKS_A_ROW)).map(move |l| (k, l)));
            around
                .filter(|&at| at != (i, j))
                .map(|(k, l)| p.distance(self.rows[k].points[l]))
                .min_by(f64::total_cmp)
        };
        let marks = (0..rows).flat_map(|i| (0..MARKS_A_ROW).map(move |j| (i, j)));
        let mut found: Vec<(usize, usize, f64)> =
            marks.filter_map(|(i, j)| Some((i + 1, j + 1, nearest(i, j)?))).collect();
        let first = self.rows.first().into_iter().flat_map(|r| r.points);
        found.extend(first.map(|p| p.distance(self.tip)).min_by(f64::total_cmp).map(|d| (0, 1, d)));
        let mut distances: Vec<f64> = found.iter().map(|f| f.2).collect();
        base::sort_by(&mut distances, f64::total_cmp);
        let median = distances.get(distances.len() / 2).copied().unwrap_or(0.0);
        if median <= 0.0 {
            return Vec::new();
        }
        found.into_iter().map(|(i, j, d)| (i, j, d / median)).filter(|f| f.2 > 20.0).collect()
    }

    /// Iterates over all faults of the points and thicknesses.
    pub fn validate(&self) -> impl Iterator<Item = MarksError> + '_ {
        let usable = |p: DVec3| p.is_finite() && p.abs().max_element() < 1e100;
        let few = (self.rows.len() < 2).then_some(MarksError::TooFewRows(self.rows.len()));
        let tip = (!usable(self.tip)).then_some(MarksError::NotFinite { row: 0, mark: 1 });
        let wrong = |row: usize, mark: usize, t: Option<f64>| {
            let value = t.filter(|&t| !(t > 0.0 && t < 1e100))?;
            Some(MarksError::Thickness { row, mark, value })
        };
        let tip_thickness = wrong(0, 1, self.tip_thickness);
        let rows = self.rows.iter().enumerate().flat_map(move |(i, row)| {
            let points = row.points.iter().enumerate();
            let points = points
                .filter(move |(_, p)| !usable(**p))
                .map(move |(j, _)| MarksError::NotFinite { row: i + 1, mark: j + 1 });
            let thickness = row.thickness.iter().enumerate();
            let thickness = thickness.filter_map(move |(j, &t)| wrong(i + 1, j + 1, t));
            let one = row.points.iter().all(|&p| p == row.points[0]);
            let one = one.then_some(MarksError::Point(i + 1));
            points.chain(thickness).chain(wrong(i + 1, MIDDLE + 1, row.midrib)).chain(one)
        });
        // 1e-9 of the length: below this two marks are one.
        let near = 1e-9 * self.length();
        let start = self.rows.first().filter(|r| r.points[MIDDLE].distance(self.tip) <= near);
        let start = start.map(|_| MarksError::TipRepeated);
        let same = self.rows.windows(2).enumerate().filter_map(move |(i, w)| {
            (w[0].points[MIDDLE].distance(w[1].points[MIDDLE]) <= near).then_some(MarksError::SameRow(i + 1))
        });
        few.into_iter().chain(tip).chain(tip_thickness).chain(rows).chain(start).chain(same)
    }

    /// Fills in missing measurements.
    ///
    /// Along a side vein thickness changes linearly from the vein's own at the midrib to that of the margin (Wang et
    /// al. 2011, section 1.3: `r2 = (2 d + r4) / 3`, `r3 = (d + 2 r4) / 3`), left as right. Values that a whole row
    /// lacks are interpolated between its neighbours along the midrib. An unmeasured midrib is 1.8 % of its length
    /// thick at the base and a twelfth of that at the tip. An unmeasured margin is 2.6 % of the veins' mean thickness;
    /// unmeasured side veins are half as thick as the midrib. Each such guess is reported in `report`.
    ///
    /// # Errors
    /// The first fault of [`validate`](Self::validate); those of [`FullMarks::within`].
    pub fn complete(&self, report: &mut Report) -> Result<FullMarks, MarksError> {
        if let Some(fault) = self.validate().next() {
            return Err(fault);
        }
        let places = self.places();
        let midrib: Vec<Option<f64>> = self.rows.iter().map(|r| r.midrib).collect();
        let midrib = spread(&places, &midrib).unwrap_or_else(|| {
            report.warn(
                "midrib-guessed",
                "no row has a thickness of the midrib: 1.8 % of its length at the base was taken, thinner to the tip",
            );
            let length = self.length();
            let [share, tip] = MIDRIB_SHARE;
            places.iter().map(|p| share * length * base::ops::lerp(tip, 1.0, p / length)).collect()
        });
        let stalks: Vec<Option<f64>> = self.rows.iter().map(|r| r.thickness[MIDDLE]).collect();
        let stalks = spread(&places, &stalks).unwrap_or_else(|| {
            report.warn(
                "thickness-guessed",
                "no side vein has a thickness at the midrib: half of the midrib's was taken",
            );
            midrib.iter().map(|m| 0.5 * m).collect()
        });
        let margin = |j: usize| -> Vec<Option<f64>> { self.rows.iter().map(|r| r.thickness[j]).collect() };
        let (right, left) = (margin(0), margin(MARKS_A_ROW - 1));
        // The measured side serves for both if only one was measured.
        let either = |a: &[Option<f64>], b: &[Option<f64>]| -> Vec<Option<f64>> {
            a.iter().zip(b).map(|(a, b)| a.or(*b)).collect()
        };
        let (right, left) = (either(&right, &left), either(&left, &right));
        let guess = || {
            let mean = midrib.iter().chain(&stalks).sum::<f64>() / (2 * midrib.len()) as f64;
            vec![BLADE_SHARE * mean; self.rows.len()]
        };
        let margins = match (spread(&places, &right), spread(&places, &left)) {
            (Some(right), Some(left)) => (right, left),
            _ => {
                report.warn(
                    "margin-guessed",
                    "the margin has no thickness anywhere: 2.6 % of the mean thickness of the veins was taken",
                );
                (guess(), guess())
            }
        };
        let rows = self.rows.iter().enumerate().map(|(i, row)| {
            let (r4, known) = (stalks[i], row.thickness);
            let half = |d: f64| [d, (2.0 * d + r4) / 3.0, (d + 2.0 * r4) / 3.0];
            let (r, l) = (half(margins.0[i]), half(margins.1[i]));
            let rule = [r[0], r[1], r[2], r4, l[2], l[1], l[0]];
            let mirrored = |j: usize| known[j].or(known[MARKS_A_ROW - 1 - j]);
            let thickness = core::array::from_fn(|j| mirrored(j).unwrap_or(rule[j]));
            FullRow { points: row.points, thickness, midrib: midrib[i] }
        });
        let rows: Vec<FullRow> = rows.collect();
        let tip_thickness = self.tip_thickness.unwrap_or(rows[0].thickness[0].min(rows[0].midrib));
        FullMarks { rows, tip: self.tip, tip_thickness, margin: Vec::new() }.within(&self.margin)
    }

    /// Returns the positions of the rows on the midrib, by length from the tip.
    fn places(&self) -> Vec<f64> {
        let mut last = self.tip;
        let mut sum = 0.0;
        let each = self.rows.iter().map(|r| {
            sum += last.distance(r.points[MIDDLE]);
            last = r.points[MIDDLE];
            sum
        });
        each.collect()
    }
}

/// Keeps known values, interpolates between the nearest known ones, and extends them as constants.
pub(crate) fn spread(places: &[f64], values: &[Option<f64>]) -> Option<Vec<f64>> {
    let known: Vec<(f64, f64)> = places.iter().zip(values).filter_map(|(&p, v)| Some((p, (*v)?))).collect();
    let (&first, &last) = (known.first()?, known.last()?);
    let at = |p: f64| {
        let after = known.partition_point(|k| k.0 <= p);
        match (after.checked_sub(1).map(|k| known[k]), known.get(after)) {
            (Some(a), Some(b)) => base::ops::lerp(a.1, b.1, (p - a.0) / (b.0 - a.0)),
            (Some(_), None) => last.1,
            (None, _) => first.1,
        }
    };
    Some(places.iter().zip(values).map(|(&p, v)| v.unwrap_or_else(|| at(p))).collect())
}

impl FullMarks {
    /// Returns the marks as measured ones, with all thicknesses known.
    pub fn to_marks(&self) -> Marks {
        let rows = self.rows.iter().map(|r| MarkRow {
            points: r.points,
            thickness: r.thickness.map(Some),
            midrib: Some(r.midrib),
        });
        let margin = self.margin_places();
        Marks { rows: rows.collect(), tip: self.tip, tip_thickness: Some(self.tip_thickness), margin }
    }

    /// Returns all points scaled about the root, thickness too.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let root = self.root();
        self.map(|p| root + (p - root) * factor, |t| t * factor)
    }

    /// Returns the lower end of the midrib: the fourth mark of the last row.
    pub fn root(&self) -> DVec3 {
        self.rows.last().map_or(self.tip, |r| r.points[MIDDLE])
    }

    /// Applies a similarity transformation to every point and every thickness; the margin follows.
    #[must_use]
    pub fn map(&self, point: impl Fn(DVec3) -> DVec3, thickness: impl Fn(f64) -> f64) -> Self {
        let rows = self.rows.iter().map(|r| FullRow {
            points: r.points.map(&point),
            thickness: r.thickness.map(&thickness),
            midrib: thickness(r.midrib),
        });
        let rows = rows.collect();
        let (tip, tip_thickness) = (point(self.tip), thickness(self.tip_thickness));
        Self { rows, tip, tip_thickness, margin: self.margin.clone() }
    }

    /// Returns the points of the midrib from root to tip.
    pub fn midrib(&self) -> Vec<DVec3> {
        self.rows.iter().rev().map(|r| r.points[MIDDLE]).chain([self.tip]).collect()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Makes a flat leaf along +y, x across (mark 1 at +x), side veins rising.
    pub(crate) fn sample(rows: usize) -> Marks {
        let row = |i: usize| {
            let y = (rows - 1 - i) as f64 / rows as f64;
            let points = core::array::from_fn(|j| {
                let s = 1.0 - j as f64 / 3.0; // 1 at the right margin
                let wide = 0.1 + 0.3 * y * (1.1 - y);
                DVec3::new(s * wide, y + 0.1 * s.abs(), 0.05 * s * s)
            });
            MarkRow { points, thickness: [None; 7], midrib: None }
        };
        let mut marks = Marks { rows: (0..rows).map(row).collect(), tip: DVec3::Y, ..Marks::default() };
        marks.rows[0].midrib = Some(0.01);
        marks.rows[rows - 1].midrib = Some(0.03);
        marks.rows[0].thickness[3] = Some(0.004);
        marks.rows[0].thickness[0] = Some(0.001);
        marks
    }

    #[test]
    fn missing_thickness_follows_the_papers_rule() {
        let mut report = Report::default();
        let full = sample(5).complete(&mut report).unwrap();
        let want = [0.001, 0.002, 0.003, 0.004, 0.003, 0.002, 0.001];
        for row in &full.rows {
            row.thickness.iter().zip(want).for_each(|(a, b)| assert!((a - b).abs() < 1e-15, "{row:?}"));
        }
        let midrib: Vec<f64> = full.rows.iter().map(|r| r.midrib).collect();
        for (got, want) in midrib.iter().zip([0.01, 0.015, 0.02, 0.025, 0.03]) {
            assert!((got - want).abs() < 1e-12, "{midrib:?}");
        }
        assert_eq!(report.warnings, []);
        assert_eq!(full.to_marks().complete(&mut report).unwrap(), full);
    }

    #[test]
    fn measured_thickness_is_kept_and_mirrored() {
        let mut marks = sample(3);
        marks.rows[1].thickness[1] = Some(0.0077);
        let full = marks.complete(&mut Report::default()).unwrap();
        assert_eq!((full.rows[1].thickness[1], full.rows[1].thickness[5]), (0.0077, 0.0077));
    }

    #[test]
    fn guesses_are_told() {
        let mut marks = sample(4);
        marks.rows[0].thickness = [None; 7];
        let mut report = Report::default();
        let full = marks.complete(&mut report).unwrap();
        assert_eq!(report.warnings.len(), 2);
        assert!((full.rows[0].thickness[3] - 0.005).abs() < 1e-15);
        marks.rows.iter_mut().for_each(|r| r.midrib = None);
        let full = marks.complete(&mut report).unwrap();
        assert_eq!(report.warnings.len(), 5, "midrib, side veins, margin");
        assert!((full.rows[3].midrib - 0.018 * marks.length()).abs() < 1e-15, "1.8 % at the base");
    }

    #[test]
    fn a_mark_times_a_hundred_is_told() {
        let marks = sample(6);
        assert_eq!(marks.strays(), []);
        for (row, mark) in [(1, 1), (3, 4), (6, 7), (2, 2)] {
            let mut wrong = marks.clone();
            wrong.rows[row - 1].points[mark - 1] *= 100.0;
            let found: Vec<_> = wrong.strays().iter().map(|s| (s.0, s.1)).collect();
            assert_eq!(found, [(row, mark)]);
        }
        let mut wrong = marks;
        wrong.tip *= 100.0;
        assert_eq!(wrong.strays().iter().map(|s| (s.0, s.1)).collect::<Vec<_>>(), [(0, 1)]);
    }

    #[test]
    fn faults_name_row_and_mark() {
        let fault = |change: fn(&mut Marks)| {
            let mut marks = sample(4);
            change(&mut marks);
            marks.complete(&mut Report::default()).unwrap_err()
        };
        assert_eq!(fault(|m| m.rows[2].points[6].z = f64::NAN), MarksError::NotFinite { row: 3, mark: 7 });
        assert_eq!(fault(|m| m.tip.x = f64::INFINITY), MarksError::NotFinite { row: 0, mark: 1 });
        assert_eq!(
            fault(|m| m.rows[1].thickness[0] = Some(0.0)),
            MarksError::Thickness { row: 2, mark: 1, value: 0.0 }
        );
        assert_eq!(
            fault(|m| m.rows[3].midrib = Some(-1.0)),
            MarksError::Thickness { row: 4, mark: 4, value: -1.0 }
        );
        assert_eq!(fault(|m| m.rows[2].points = [DVec3::X; 7]), MarksError::Point(3));
        assert_eq!(fault(|m| m.rows[2].points = m.rows[1].points), MarksError::SameRow(2));
        assert_eq!(fault(|m| m.tip = m.rows[0].points[3]), MarksError::TipRepeated);
        assert_eq!(fault(|m| m.rows.truncate(1)), MarksError::TooFewRows(1));
    }
}

base::coded!(MarksError {
    Self::TooFewRows(rows) => "marks-few" { rows },
    Self::NotFinite { row, mark } => "marks-not-finite" { row, mark },
    Self::Thickness { row, mark, value } => "marks-thickness" { row, mark, value },
    Self::Point(row) => "marks-one-point" { row },
    Self::SameRow(row) => "marks-same-row" { row, next = row + 1 },
    Self::TipRepeated => "marks-tip" {},
    Self::NoBall { row, mark, rows } => "ball-none" { row, mark, rows },
    Self::MarginFew(points) => "margin-few" { points },
    Self::MarginNotFinite(point) => "margin-not-finite" { point },
    Self::MarginCrosses(times) => "margin-crosses" { times },
    Self::MarginApart => "margin-apart" {},
});
