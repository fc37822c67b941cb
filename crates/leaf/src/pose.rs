//! Curl and wilt: a leaf's marks moved as in a living leaf.

use base::ops::{self, smoothstep};
use base::turn;
use glam::{DQuat, DVec3};

use crate::marks::{FullMarks, FullRow, MARKS_A_ROW};
use crate::rays::Rays;

/// Bending of a leaf from its measured shape.
///
/// Guaranteed: distances between neighbouring marks along the midrib and along the side veins are kept, and (0, 0)
/// changes nothing. A blade hardly stretches: it bends like a sheet of paper, so that its area stays within 2 % on the
/// leaves that were tried (docs/leaves.md). Not guaranteed: that a blade that was measured with folds can bend so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Roll of the blade about its midrib: 0 as measured, at 1 the margins meet above the upper side, at -1 below.
    pub curl: f64,
    /// Loss of stiffness: 0 fresh, 1 hanging limp, halves folded down.
    pub wilt: f64,
    /// Direction in which a limp leaf hangs.
    pub down: DVec3,
}

impl Default for Pose {
    fn default() -> Self {
        Self { curl: 0.0, wilt: 0.0, down: DVec3::NEG_Y }
    }
}

// Half of a full turn to each side brings the margins together above the midrib.
const FULL_CURL: f64 = ops::PI;
// 55 degrees: the halves of a limp tobacco leaf hang like a roof, not like a closed book.
const FULL_FOLD: f64 = 55.0 / 180.0 * ops::PI;
// Rounds that restore the distances between marks; more make no visible difference.
const ROUNDS: u32 = 600;

const MIDDLE: usize = MARKS_A_ROW / 2;

impl Pose {
    /// Returns the marks in this pose; the root stays in place.
    ///
    /// Values beyond -1 to 1 (wilt: 0 to 1) are clamped, NaN counts as 0. Cost: linear.
    pub fn apply(&self, marks: &FullMarks) -> FullMarks {
        let Some((curl, wilt, down)) = self.asked() else { return marks.clone() };
        let line = marks.midrib();
        // Rows from the root up; the last of `line` is the tip.
        let rows: Vec<&FullRow> = marks.rows.iter().rev().collect();
        let mut grid = Grid::from_rows(rows.iter().map(|r| r.points.to_vec()).collect(), (marks.tip, true));
        for (i, row) in rows.iter().enumerate() {
            let step = line[i + 1] - line[i];
            let before = if i == 0 { step } else { line[i] - line[i - 1] };
            let tangent = before.normalize_or_zero() + step.normalize_or_zero();
            let axis = tangent.try_normalize().unwrap_or(DVec3::Y);
            let turned = pose_row(row, axis, [curl, wilt]);
            grid.points[i * MARKS_A_ROW..(i + 1) * MARKS_A_ROW].copy_from_slice(&turned);
        }
        grid.relax();
        if wilt > 0.0 {
            hang(&mut grid.points, &line, down, wilt);
            grid.relax();
        }
        grid.keep_rows();
        let tip = grid.points.pop().unwrap_or(marks.tip);
        let posed = grid.points.chunks_exact(MARKS_A_ROW).zip(&rows);
        let mut out: Vec<FullRow> =
            posed.map(|(p, row)| FullRow { points: core::array::from_fn(|j| p[j]), ..**row }).collect();
        out.reverse();
        FullMarks { rows: out, tip, ..marks.clone() }
    }

    /// As [`apply`](Self::apply), for chief veins that start together: the blade rolls about the middle one.
    pub fn apply_rays(&self, rays: &Rays) -> Rays {
        let Some((curl, wilt, down)) = self.asked() else { return rays.clone() };
        let middle = rays.rays.len() / 2;
        let mut out = rays.clone();
        let Some(line) = rays.rays.get(middle).map(|r| r.points.clone()).filter(|l| l.len() >= 2) else {
            return out;
        };
        let marks = line.len();
        if rays.rays.iter().any(|r| r.points.len() != marks) {
            return out;
        }
        let (root, end) = (line[0], line[marks - 1]);
        let axis = (end - root).try_normalize().unwrap_or(DVec3::Y);
        let (right, left) = (&rays.rays[0].points, &rays.rays[rays.rays.len() - 1].points);
        let across = right[marks / 2] - left[marks / 2];
        let across = (across - axis * across.dot(axis))
            .try_normalize()
            .unwrap_or_else(|| axis.any_orthonormal_vector());
        let up = across.cross(axis);
        let wide = rays.rays.iter().flat_map(|r| &r.points).map(|&p| (p - root).dot(across).abs());
        let wide = wide.fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        // Columns are rays, rows the marks from the base outwards.
        let rows = (0..marks).map(|m| rays.rays.iter().map(|r| r.points[m]).collect()).collect();
        let mut grid = Grid::from_rows(rows, (end, false));
        let bend = curl * FULL_CURL / wide;
        for p in &mut grid.points {
            let (d, h, y) = ((*p - root).dot(across), (*p - root).dot(up), (*p - root).dot(axis));
            // On a cylinder about a line along the midrib: as far round it as it was across. This is an isometry.
            let (s, c) = ops::sin_cos(bend * d);
            let [x, z] = if bend.abs() > 1e-9 { [s / bend, (1.0 - c) / bend] } else { [d, 0.0] };
            *p = root + axis * y + across * (x - h * s) + up * (z + h * c);
        }
        // Parts off the plane of the leaf were stretched.
        if curl != 0.0 {
            grid.relax();
        }
        if wilt > 0.0 {
            // A bend along the midrib alone stretches nothing.
            hang(&mut grid.points, &line, down, wilt);
        }
        for (m, row) in grid.points.chunks_exact(grid.columns).take(marks).enumerate() {
            for (ray, &p) in out.rays.iter_mut().zip(row) {
                ray.points[m] = p;
            }
        }
        out
    }

    /// Returns curl, wilt and the direction down; `None` if neither curl nor wilt is set.
    fn asked(&self) -> Option<(f64, f64, DVec3)> {
        let clean = |x: f64, lo: f64| if x.is_nan() { 0.0 } else { x.clamp(lo, 1.0) };
        let (curl, wilt) = (clean(self.curl, -1.0), clean(self.wilt, 0.0));
        let down = self.down.try_normalize().unwrap_or(DVec3::NEG_Y);
        (curl != 0.0 || wilt != 0.0).then_some((curl, wilt, down))
    }
}

/// Marks in rows, in their current and former positions.
struct Grid {
    columns: usize,
    points: Vec<DVec3>,
    /// Distances that a sheet preserves: to the neighbours along, across and diagonal.
    edges: Vec<(usize, usize, f64)>,
    /// Distances within rows, from the middle outwards.
    chains: Vec<(usize, usize, f64)>,
    pinned: Vec<bool>,
}

impl Grid {
    /// Makes a grid of rows of one length, followed by the tip, in which they end if they are joined; the middle of
    /// each row and the tip stay in place.
    fn from_rows(rows: Vec<Vec<DVec3>>, (tip, joined): (DVec3, bool)) -> Self {
        let columns = rows.first().map_or(1, Vec::len);
        let (n, middle) = (rows.len(), columns / 2);
        let mut points: Vec<DVec3> = rows.into_iter().flatten().collect();
        points.push(tip);
        let last = points.len() - 1;
        let edge = |a: usize, b: usize| (a, b, points[a].distance(points[b]));
        let (mut edges, mut chains) = (Vec::new(), Vec::new());
        for i in 0..n {
            for j in 0..columns {
                let a = i * columns + j;
                if j + 1 < columns {
                    edges.push(edge(a, a + 1));
                }
                if i + 1 < n {
                    edges.push(edge(a, a + columns));
                    if j + 1 < columns {
                        edges.extend([edge(a, a + columns + 1), edge(a + 1, a + columns)]);
                    }
                }
            }
            let at = |j: usize| i * columns + j;
            chains.extend((0..middle).rev().map(|j| edge(at(j + 1), at(j))));
            chains.extend((middle + 1..columns).map(|j| edge(at(j - 1), at(j))));
        }
        // Lobes end apart from one another.
        if n > 0 && joined {
            edges.extend((0..columns).map(|j| edge((n - 1) * columns + j, last)));
        }
        let pinned = (0..=last).map(|k| k == last || k % columns == middle).collect();
        Self { columns, points, edges, chains, pinned }
    }

    /// Restores the distances between neighbours, each pair in turn.
    fn relax(&mut self) {
        for _ in 0..ROUNDS {
            for &(a, b, rest) in &self.edges {
                let free = [a, b].map(|k| f64::from(u8::from(!self.pinned[k])));
                let weight = free[0] + free[1];
                let apart = self.points[b] - self.points[a];
                let length = apart.length();
                if weight > 0.0 && length > 1e-12 {
                    let push = apart * ((length - rest) / (length * weight));
                    self.points[a] += push * free[0];
                    self.points[b] -= push * free[1];
                }
            }
        }
    }

    /// Restores the lengths of side veins, from the midrib outwards.
    fn keep_rows(&mut self) {
        let before = self.points.clone();
        for &(a, b, rest) in &self.chains {
            let step = (before[b] - before[a]).normalize_or_zero();
            self.points[b] = self.points[a] + step * rest;
        }
    }
}

/// Returns the rotation of a direction at a share of the path from the root to the tip: towards down, more the farther
/// out.
fn sag(direction: DVec3, down: DVec3, share: f64, wilt: f64) -> DQuat {
    let Some(from) = direction.try_normalize() else { return DQuat::IDENTITY };
    // The stalk holds; from there to the middle the midrib yields.
    let part = wilt * smoothstep(-0.05, 0.55, share);
    let axis = from.cross(down);
    let angle = ops::atan2(axis.length(), from.dot(down));
    match axis.try_normalize() {
        Some(axis) => turn::about(axis, angle * part),
        // Straight up or down: the direction of the fall is undefined.
        None => DQuat::IDENTITY,
    }
}

/// Bends a blade with its midrib: points next to a place of the midrib move with that place, wherever their vein began.
fn hang(points: &mut [DVec3], line: &[DVec3], down: DVec3, wilt: f64) {
    let length = geom::polyline_length3(line).max(f64::MIN_POSITIVE);
    // The hanging midrib, and the rotation of each of its pieces.
    let mut place = line[0];
    let (mut hung, mut turns, mut walked) = (vec![place], Vec::new(), vec![0.0]);
    for w in line.windows(2) {
        let step = w[1] - w[0];
        let along = walked[walked.len() - 1];
        let turn = sag(step, down, (along + 0.5 * step.length()) / length, wilt);
        place += turn * step;
        hung.push(place);
        turns.push(turn);
        walked.push(along + step.length());
    }
    for p in points.iter_mut() {
        // The piece that the point lies next to.
        let beside = |k: usize| {
            let (a, step) = (line[k], line[k + 1] - line[k]);
            let t = (*p - a).dot(step) / step.length_squared().max(f64::MIN_POSITIVE);
            // Before the first and behind the last piece it continues straight.
            let low = if k == 0 { f64::NEG_INFINITY } else { 0.0 };
            let high = if k + 2 == line.len() { f64::INFINITY } else { 1.0 };
            let t = t.clamp(low, high);
            (p.distance(a + step * t), k, t)
        };
        let nearest = (0..turns.len()).map(beside).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, k, t)) = nearest {
            *p = hung[k]
                + turns[k] * (*p - line[k] - (line[k + 1] - line[k]) * t)
                + (hung[k + 1] - hung[k]) * t;
        }
    }
}

/// Poses one row, each half turned about the midrib's direction `axis`.
fn pose_row(row: &FullRow, axis: DVec3, [curl, wilt]: [f64; 2]) -> [DVec3; MARKS_A_ROW] {
    let mut points = row.points;
    let halves = [(0..MIDDLE).rev().collect::<Vec<_>>(), (MIDDLE + 1..MARKS_A_ROW).collect()];
    for (half, outwards) in halves.iter().zip([1.0, -1.0]) {
        let mut last = row.points[MIDDLE];
        let mut at = last;
        for (k, &j) in half.iter().enumerate() {
            let step = row.points[j] - last;
            last = row.points[j];
            // Lifting the right half (at +across) to the upper side turns it about -tangent.
            let rolled = curl * FULL_CURL * (k as f64 + 0.5) / MIDDLE as f64;
            at += turn::about(axis, outwards * (wilt * FULL_FOLD - rolled)) * step;
            points[j] = at;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use base::Report;

    use super::*;
    use crate::marks::tests::sample;

    fn flat() -> FullMarks {
        let mut marks = sample(8);
        marks.rows.iter_mut().for_each(|r| r.points.iter_mut().for_each(|p| p.z = 0.0));
        marks.complete(&mut Report::default()).unwrap()
    }

    fn lengths(m: &FullMarks) -> Vec<f64> {
        let rows = m.rows.iter().flat_map(|r| r.points.windows(2).map(|w| w[0].distance(w[1])));
        rows.chain(m.midrib().windows(2).map(|w| w[0].distance(w[1]))).collect()
    }

    #[test]
    fn nothing_asked_changes_nothing() {
        assert_eq!(Pose::default().apply(&flat()), flat());
        assert_eq!(Pose { curl: f64::NAN, wilt: f64::NAN, ..Pose::default() }.apply(&flat()), flat());
    }

    #[test]
    fn curl_keeps_lengths_and_brings_the_margins_together_above() {
        let before = flat();
        let after = Pose { curl: 1.0, ..Pose::default() }.apply(&before);
        for (a, b) in lengths(&before).iter().zip(lengths(&after)) {
            assert!((a - b).abs() < 1e-12);
        }
        for (a, b) in before.rows.iter().zip(&after.rows) {
            let gap = |r: &FullRow| r.points[0].distance(r.points[6]);
            assert!(gap(b) < 0.35 * gap(a), "{} {}", gap(a), gap(b));
            // The sample lies in the plane z = 0 with its upper side at +z.
            assert!(b.points[0].z > 0.0 && b.points[6].z > 0.0);
        }
        let under = Pose { curl: -0.5, ..Pose::default() }.apply(&before);
        assert!(under.rows[4].points[0].z < 0.0);
    }

    #[test]
    fn wilted_leaf_hangs_down_and_keeps_its_midrib() {
        let before = flat();
        let down = DVec3::NEG_Z;
        let after = Pose { wilt: 1.0, down, ..Pose::default() }.apply(&before);
        let length = |m: &FullMarks| geom::polyline_length3(&m.midrib());
        assert!((length(&before) - length(&after)).abs() < 1e-12);
        assert_eq!(after.root(), before.root());
        let line = after.midrib();
        let end = (line[8] - line[7]).normalize();
        assert!(end.dot(down) > 0.999, "{end:?}");
        assert!(line[8].z < -0.6, "{:?}", line[8]);
        // More wilt, lower tip, all the way.
        let mut last = 0.0;
        for k in 1..=10 {
            let tip = Pose { wilt: f64::from(k) / 10.0, down, ..Pose::default() }.apply(&before).tip.z;
            assert!(tip < last);
            last = tip;
        }
    }

    /// Returns the area of the surface through the marks, as it is meshed.
    fn area(marks: &FullMarks) -> f64 {
        crate::Leaf::new(marks, &crate::LeafSpec::default()).unwrap().blade().area_m2()
    }

    #[test]
    fn bending_keeps_the_area_within_two_per_cent() {
        let broad = crate::LeafForm { width: 0.9, ..crate::LeafForm::default() };
        let slim = crate::LeafForm { width: 0.25, veins: 12, ..crate::LeafForm::default() };
        let folded = crate::LeafForm { fold_deg: 20.0, ..crate::LeafForm::default() };
        for form in [crate::LeafForm::default(), broad, slim, folded] {
            let marks = form.marks().complete(&mut Report::default()).unwrap();
            let before = area(&marks);
            for (curl, wilt) in [(0.4, 0.0), (1.0, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, 1.0), (0.3, 0.7)] {
                let after = area(&Pose { curl, wilt, ..Pose::default() }.apply(&marks));
                let change = 100.0 * (after / before - 1.0);
                assert!(change.abs() < 2.0, "{form:?} curl {curl} wilt {wilt}: {change:+.2} %");
            }
        }
    }

    #[test]
    fn palmate_leaves_bend_and_keep_their_area() {
        for veins in [3, 5, 7] {
            let rays = Rays::palmate(&crate::PalmateSpec { veins, ..crate::PalmateSpec::default() });
            let area = |rays: &Rays| {
                let leaf = crate::RayLeaf::new(rays, crate::ThicknessRule::Diameter).unwrap();
                leaf.blade(plant::VeinShade { vein: [0.0; 3], blade: [0.0; 3], reach_m: 0.0 }).area_m2()
            };
            let before = area(&rays);
            assert_eq!(Pose::default().apply_rays(&rays), rays);
            for (curl, wilt) in [(0.4, 0.0), (1.0, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, 1.0)] {
                let bent = Pose { curl, wilt, ..Pose::default() }.apply_rays(&rays);
                let change = 100.0 * (area(&bent) / before - 1.0);
                // Drooping lobes do not lie in a plane: fully rolled up or hanging they stretch slightly more.
                let most = if !(0.0..=0.9).contains(&curl) {
                    3.5
                } else if wilt > 0.9 {
                    6.5
                } else {
                    2.0
                };
                assert!(change.abs() < most, "{veins} veins, curl {curl} wilt {wilt}: {change:+.2} %");
                assert_ne!(bent, rays);
            }
        }
    }
}
