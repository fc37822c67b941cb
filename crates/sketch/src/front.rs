//! Finds the point nearest to the viewer around a place.

use glam::{DVec2, DVec3};

/// Most points of a box that is not divided.
const LEAF: usize = 12;

/// Boxes within boxes over points, each with its greatest depth.
#[derive(Debug)]
pub(crate) struct Front<'a> {
    points: &'a [DVec3],
    /// Indices of the points, box by box.
    order: Vec<usize>,
    /// Boxes in the order of a walk: after a box that is divided comes its first half.
    boxes: Vec<Bounds>,
}

#[derive(Clone, Copy, Debug)]
struct Bounds {
    min: DVec2,
    max: DVec2,
    /// Greatest z.
    top: f64,
    /// Part of `order`.
    from: usize,
    to: usize,
    /// The second half's box; 0 if it is not divided.
    second: usize,
}

impl<'a> Front<'a> {
    /// Cost: n log n.
    pub(crate) fn new(points: &'a [DVec3]) -> Self {
        let mut front = Self { points, order: (0..points.len()).collect(), boxes: Vec::new() };
        if !points.is_empty() {
            front.divide(0, points.len());
        }
        front
    }

    // Recursion depth: the logarithm of the number of points.
    fn divide(&mut self, from: usize, to: usize) -> usize {
        let part = &mut self.order[from..to];
        let mut bounds = Bounds {
            min: DVec2::INFINITY,
            max: DVec2::NEG_INFINITY,
            top: f64::NEG_INFINITY,
            from,
            to,
            second: 0,
        };
        for &i in &*part {
            let p = self.points[i];
            bounds.min = bounds.min.min(p.truncate());
            bounds.max = bounds.max.max(p.truncate());
            bounds.top = bounds.top.max(p.z);
        }
        let this = self.boxes.len();
        self.boxes.push(bounds);
        if part.len() > LEAF {
            let size = bounds.max - bounds.min;
            let side = usize::from(size.y > size.x);
            let half = part.len() / 2;
            let order = |&a: &usize, &b: &usize| self.points[a][side].total_cmp(&self.points[b][side]);
            base::first_of(part, half + 1, &mut { order });
            self.divide(from, from + half);
            let second = self.divide(from + half, to);
            self.boxes[this].second = second;
        }
        this
    }

    /// Returns the index of the point with the greatest z less twice its distance from `at` in the plane; on a tie the
    /// first. Cost: the logarithm of the number of points, if not all are equally good.
    pub(crate) fn nearest_to_viewer(&self, at: DVec2) -> Option<usize> {
        let worth = |i: usize| self.points[i].z - 2.0 * self.points[i].truncate().distance(at);
        // No point of a box is worth more; a little is added for the rounding of the two ways to compute it.
        let bound = |b: &Bounds| {
            let away = 2.0 * (b.min - at).max(at - b.max).max(DVec2::ZERO).length();
            b.top - away + 1e-12 * (b.top.abs() + away)
        };
        let mut best: Option<(f64, usize)> = None;
        let mut open = Vec::from_iter(self.boxes.first().map(|_| 0));
        while let Some(k) = open.pop() {
            let b = &self.boxes[k];
            if best.is_some_and(|(w, _)| bound(b) < w) {
                continue;
            }
            if b.second > 0 {
                let (mut near, mut far) = (k + 1, b.second);
                if bound(&self.boxes[far]) > bound(&self.boxes[near]) {
                    (near, far) = (far, near);
                }
                open.extend([far, near]);
                continue;
            }
            for &i in &self.order[b.from..b.to] {
                let w = worth(i);
                if best.is_none_or(|(most, first)| w.total_cmp(&most).then(first.cmp(&i)).is_gt()) {
                    best = Some((w, i));
                }
            }
        }
        best.map(|(_, i)| i)
    }
}

#[cfg(test)]
mod tests {
    use base::{Draw, Seed};

    use super::*;

    #[test]
    fn the_same_point_is_found_as_by_looking_at_all() {
        let mut stream = Seed::new(4).stream(Draw::TwigPlace);
        for n in [0, 1, 11, 200, 3000] {
            let mut points: Vec<DVec3> = (0..n)
                .map(|_| DVec3::new(stream.range(0.0, 2.0), stream.range(0.0, 1.0), stream.range(-0.3, 0.3)))
                .collect();
            // Ties, and a wall of them.
            points.extend_from_within(..n / 2);
            points.extend((0..n / 4).map(|_| DVec3::new(0.5, 0.5, 0.2)));
            let front = Front::new(&points);
            for _ in 0..200 {
                let at = DVec2::new(stream.range(-1.0, 3.0), stream.range(-1.0, 2.0));
                let worth = |p: &DVec3| p.z - 2.0 * p.truncate().distance(at);
                let all = points.iter().enumerate();
                let want = all.max_by(|a, b| worth(a.1).total_cmp(&worth(b.1)).then(b.0.cmp(&a.0)));
                assert_eq!(front.nearest_to_viewer(at), want.map(|(i, _)| i));
            }
        }
    }
}
