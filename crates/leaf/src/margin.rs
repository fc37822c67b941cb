//! A margin of a leaf's own, of any number of points: its position relative to the blade through the rows of marks.

use geom::{SplineSurface, subdivided};
use glam::DVec3;
use plant::{RimPoint, SplineBlade};

use crate::blade::Leaf;
use crate::marks::{FullMarks, MarginPoint, MarksError};
use crate::spec::LeafSpec;

/// Steps between marks in the initial search for the nearest point.
const STEPS: usize = 6;
/// Newton steps from there; three reach rounding.
const ROUNDS: u32 = 8;

impl FullMarks {
    /// Returns the same leaf with this margin, in the coordinates of the marks: counter-clockwise seen on the upper
    /// side.
    ///
    /// Cost: points times marks.
    ///
    /// # Errors
    /// [`MarksError`] for fewer than 3 points, unusable points, and a margin that crosses itself on the blade laid flat
    /// or excludes the middle of the leaf.
    pub fn within(mut self, points: &[DVec3]) -> Result<Self, MarksError> {
        self.margin.clear();
        if points.is_empty() {
            return Ok(self);
        }
        if points.len() < 3 {
            return Err(MarksError::MarginFew(points.len()));
        }
        if let Some(mark) = points.iter().position(|p| !(p.is_finite() && p.abs().max_element() < 1e100)) {
            return Err(MarksError::MarginNotFinite(mark + 1));
        }
        let Some(blade) = self.blade() else { return Ok(self) };
        let length = geom::polyline_length3(&self.midrib());
        let seeds = Seeds::from_surface(&blade.surface);
        self.margin = points.iter().map(|&p| attached(&blade, &seeds, p, length)).collect();
        let rimmed = SplineBlade { rim: self.rim(&blade), ..blade };
        let flat = rimmed.flat(2);
        let crossings = geom::self_crossings(&flat.rim);
        if crossings > 0 {
            return Err(MarksError::MarginCrosses(crossings));
        }
        let midrib = flat.midrib();
        if !midrib.get(midrib.len() / 2).is_some_and(|&p| geom::contains(&flat.rim, p)) {
            return Err(MarksError::MarginApart);
        }
        if geom::signed_area(&flat.rim) < 0.0 {
            self.margin.reverse();
        }
        Ok(self)
    }

    /// Returns the position of the margin on a blade of these marks, in any pose.
    pub(crate) fn rim(&self, blade: &SplineBlade) -> Vec<RimPoint> {
        let length = geom::polyline_length3(&self.midrib());
        let (us, vs) = (blade.surface.columns_at(), blade.surface.rows_at());
        let place = |m: &MarginPoint| {
            let (u, v) = (parameter_at(us, m.column), parameter_at(vs, m.row));
            let on = blade.surface.point(u, v);
            let off = blade.directions(u, v).map_or(DVec3::ZERO, |[across, along, up]| {
                (across * m.off.x + along * m.off.y + up * m.off.z) * length
            });
            RimPoint { u, v, place: on + off }
        };
        self.margin.iter().map(place).collect()
    }

    /// Returns the points of the margin.
    pub(crate) fn margin_places(&self) -> Vec<DVec3> {
        let blade = (!self.margin.is_empty()).then(|| self.blade()).flatten();
        blade.map_or_else(Vec::new, |b| self.rim(&b).into_iter().map(|r| r.place).collect())
    }

    /// Returns the blade through the marks, without a margin of its own.
    fn blade(&self) -> Option<SplineBlade> {
        let bare = Self { margin: Vec::new(), ..self.clone() };
        Leaf::new(&bare, &LeafSpec::default()).ok().map(|l| l.blade())
    }
}

/// Points of a surface from which the search begins.
struct Seeds(Vec<(f64, f64, DVec3)>);

impl Seeds {
    fn from_surface(surface: &SplineSurface) -> Self {
        let (us, vs) = (subdivided(surface.columns_at(), STEPS), subdivided(surface.rows_at(), STEPS));
        let points = surface.grid(&us, &vs);
        let each = points.iter().enumerate();
        Self(each.map(|(k, p)| (us[k % us.len()], vs[k / us.len()], p.position)).collect())
    }
}

/// Attaches `p` to the nearest point of the blade (Gauss and Newton, within the domain), with the remaining offset.
fn attached(blade: &SplineBlade, seeds: &Seeds, p: DVec3, length: f64) -> MarginPoint {
    let nearest = seeds.0.iter().min_by(|a, b| a.2.distance(p).total_cmp(&b.2.distance(p)));
    let (mut u, mut v) = nearest.map_or((blade.middle, 0.0), |s| (s.0, s.1));
    let (ud, vd) = (blade.surface.u().domain(), blade.surface.v().domain());
    for _ in 0..ROUNDS {
        let s = blade.surface.point_at(u, v);
        let off = p - s.position;
        let (uu, uv, vv) = (s.du.length_squared(), s.du.dot(s.dv), s.dv.length_squared());
        let (a, b) = (s.du.dot(off), s.dv.dot(off));
        // On an edge only the component along it counts.
        let edge = |x: f64, d: (f64, f64), g: f64| (x <= d.0 && g < 0.0) || (x >= d.1 && g > 0.0);
        let det = uu * vv - uv * uv;
        let (du, dv) = match (edge(u, ud, a), edge(v, vd, b)) {
            (true, true) => break,
            (true, false) => (0.0, b / vv.max(f64::MIN_POSITIVE)),
            (false, true) => (a / uu.max(f64::MIN_POSITIVE), 0.0),
            (false, false) if det > 1e-12 * uu * vv => ((a * vv - b * uv) / det, (b * uu - a * uv) / det),
            (false, false) => break,
        };
        let (next_u, next_v) = ((u + du).clamp(ud.0, ud.1), (v + dv).clamp(vd.0, vd.1));
        if blade.surface.point(next_u, next_v).distance(p) >= off.length() {
            break;
        }
        (u, v) = (next_u, next_v);
    }
    let off = p - blade.surface.point(u, v);
    let off = blade.directions(u, v).map_or(DVec3::ZERO, |[across, along, up]| {
        DVec3::new(off.dot(across), off.dot(along), off.dot(up)) / length
    });
    let (column, row) = (whereabouts(blade.surface.columns_at(), u), whereabouts(blade.surface.rows_at(), v));
    MarginPoint { column, row, off }
}

/// Returns the parameter at a count of marks, linear between two.
fn parameter_at(marks: &[f64], count: f64) -> f64 {
    let last = marks.len() - 1;
    let k = (0..last).rev().find(|&k| k as f64 <= count).unwrap_or(0);
    base::ops::lerp(marks[k], marks[k + 1], (count - k as f64).clamp(0.0, 1.0))
}

/// Returns the count of marks at a parameter.
fn whereabouts(marks: &[f64], x: f64) -> f64 {
    let k = marks.partition_point(|&m| m <= x).clamp(1, marks.len() - 1);
    (k - 1) as f64 + ((x - marks[k - 1]) / (marks[k] - marks[k - 1])).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::marks::Marks;
    use crate::{LeafForm, Pose};

    /// Makes a leaf and a margin with teeth of a tenth of its half width, `n` points per side.
    fn toothed(n: u32) -> Marks {
        let form = LeafForm { fold_deg: 0.0, ..LeafForm::default() };
        let mut marks = form.marks();
        let side = |k: u32| {
            let t = f64::from(k) / f64::from(n);
            let tooth = if k.is_multiple_of(2) { 1.0 } else { 0.85 };
            (0.1 * t, 0.026 * tooth * base::ops::sin(base::ops::PI * (0.06 + 0.94 * t)))
        };
        let right = (0..n).map(side).map(|(y, x)| DVec3::new(x, y, 0.0));
        let left = (1..=n).rev().map(side).map(|(y, x)| DVec3::new(-x, y, 0.0));
        marks.margin = right.chain([DVec3::Y * 0.1]).chain(left.skip(1)).collect();
        marks
    }

    fn area(marks: &FullMarks) -> f64 {
        Leaf::new(marks, &LeafSpec::default()).expect("a leaf").blade().area_m2()
    }

    #[test]
    fn the_blade_ends_where_its_margin_is() {
        let marks = toothed(40);
        let full = marks.complete(&mut Report::default()).expect("marks");
        for (a, b) in full.margin_places().iter().zip(&marks.margin) {
            assert!(a.distance(*b) < 1e-6, "{a} {b}");
        }
        let flat: Vec<glam::DVec2> = marks.margin.iter().map(|p| p.truncate()).collect();
        let (want, got) = (geom::signed_area(&flat), area(&full));
        assert!((got / want - 1.0).abs() < 1e-3, "{got} {want}");
        let bare = Marks { margin: Vec::new(), ..marks };
        let bare = area(&bare.complete(&mut Report::default()).expect("marks"));
        assert!((bare / want - 1.0).abs() > 0.01, "without it the blade is another");
    }

    #[test]
    fn teeth_go_with_a_blade_that_bends_and_keep_their_area() {
        let full = toothed(40).complete(&mut Report::default()).expect("marks");
        let before = area(&full);
        for (curl, wilt) in [(0.4, 0.0), (1.0, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, 1.0)] {
            let bent = Pose { curl, wilt, ..Pose::default() }.apply(&full);
            let change = 100.0 * (area(&bent) / before - 1.0);
            assert!(change.abs() < 2.0, "curl {curl} wilt {wilt}: {change:+.2} %");
        }
        // At twice the size it has the same teeth.
        let twice = full.scaled(2.0);
        assert!((area(&twice) / before - 4.0).abs() < 1e-6);
    }

    #[test]
    fn a_margin_that_is_none_is_told() {
        let fault = |change: fn(&mut Marks)| {
            let mut marks = toothed(20);
            change(&mut marks);
            marks.complete(&mut Report::default()).expect_err("a fault")
        };
        assert_eq!(fault(|m| m.margin.truncate(2)), MarksError::MarginFew(2));
        assert_eq!(fault(|m| m.margin[7].x = f64::NAN), MarksError::MarginNotFinite(8));
        assert!(matches!(fault(|m| m.margin.swap(5, 25)), MarksError::MarginCrosses(_)));
        assert_eq!(fault(|m| m.margin.iter_mut().for_each(|p| p.x += 0.5)), MarksError::MarginApart);
        // In the reverse direction it is the same margin.
        let mut back = toothed(20);
        back.margin.reverse();
        let (a, b) = (toothed(20), back);
        let [a, b] = [a, b].map(|m| area(&m.complete(&mut Report::default()).expect("marks")));
        assert!((a - b).abs() < 1e-9 * a);
    }
}
