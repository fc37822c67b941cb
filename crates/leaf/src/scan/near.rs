//! Distance of a point from a leaf that was found: its grid and its stalk.

use geom::{Ball, BallBSpline, KdTree};
use glam::DVec3;

/// Distances from the model: the triangles around the nearest point of the grid, and the stalk's tube.
pub(super) struct Near<'a> {
    grid: &'a [DVec3],
    columns: usize,
    points: KdTree,
    /// The bounding box of each cell of the grid, by its first corner.
    boxes: Vec<[DVec3; 2]>,
    stalk: Vec<Ball>,
    centres: KdTree,
}

impl<'a> Near<'a> {
    pub(super) fn new(grid: &'a [DVec3], columns: usize, stalk: Option<&BallBSpline>) -> Self {
        let stalk: Vec<Ball> =
            stalk.map_or_else(Vec::new, |s| (0..=200).map(|k| s.ball(f64::from(k) / 200.0)).collect());
        let centres: Vec<DVec3> = stalk.iter().map(|b| b.centre).collect();
        let corner = |k: usize| grid[k.min(grid.len() - 1)];
        let boxes = (0..grid.len()).map(|k| {
            let [a, b, c, d] = [0, 1, columns, columns + 1].map(|step| corner(k + step));
            [a.min(b).min(c).min(d), a.max(b).max(c).max(d)]
        });
        Self {
            grid,
            columns,
            points: KdTree::new(grid),
            boxes: boxes.collect(),
            stalk,
            centres: KdTree::new(&centres),
        }
    }

    pub(super) fn distance(&self, p: DVec3) -> f64 {
        let from_tube = |k: usize| {
            // A piece on each side: 200 pieces bend little from one to the next.
            let pieces = self.stalk[k.saturating_sub(1)..self.stalk.len().min(k + 2)].windows(2);
            let each = pieces.map(|w| (segment_distance(p, w[0].centre, w[1].centre) - w[0].radius).abs());
            each.fold(f64::INFINITY, f64::min)
        };
        let mut best = self.centres.nearest(p, f64::INFINITY).map_or(f64::INFINITY, from_tube);
        let Some(near) = self.points.nearest(p, f64::INFINITY) else { return best };
        best = best.min(p.distance(self.grid[near]));
        let (n, rows) = (self.columns, self.grid.len() / self.columns);
        let (i, j) = (near / n, near % n);
        // Two cells on each side: the nearest point of a stretched grid need not be on the nearest triangle.
        for y in i.saturating_sub(2)..(i + 2).min(rows - 1) {
            for x in j.saturating_sub(2)..(j + 2).min(n - 1) {
                let [lo, hi] = self.boxes[y * n + x];
                if p.distance_squared(p.clamp(lo, hi)) >= best * best {
                    continue;
                }
                let at = |dy: usize, dx: usize| self.grid[(y + dy) * n + x + dx];
                let (a, b, c, d) = (at(0, 0), at(0, 1), at(1, 1), at(1, 0));
                best = best.min(triangle_distance(p, a, b, c)).min(triangle_distance(p, a, c, d));
            }
        }
        best
    }
}

fn triangle_distance(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let n = (b - a).cross(c - a);
    let area = n.length_squared();
    if area > 0.0 {
        // Inside the prism over the triangle: the distance from its plane.
        let inside = |u: DVec3, v: DVec3| (v - u).cross(p - u).dot(n) >= 0.0;
        if inside(a, b) && inside(b, c) && inside(c, a) {
            return (p - a).dot(n).abs() / area.sqrt();
        }
    }
    segment_distance(p, a, b).min(segment_distance(p, b, c)).min(segment_distance(p, c, a))
}

pub(super) fn segment_distance(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let d = b - a;
    let l = d.length_squared();
    let t = if l > 0.0 { ((p - a).dot(d) / l).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + d * t)
}
