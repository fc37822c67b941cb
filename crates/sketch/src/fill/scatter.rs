//! Attraction points, evenly scattered.
//!
//! `Volume + stream -> points with a guaranteed spacing`

use base::{Stream, ops};
use glam::{DVec2, DVec3};

use super::volume::Volume;

/// Rounds of dart throwing, each with a shorter spacing.
const ROUNDS: u32 = 7;
/// Darts per wanted point and round.
const DARTS: usize = 4;

/// Returns at most `n` points of the body for which `accept` holds, spaced as widely as `n` points can be, about
/// (Poisson-disc by dart throwing with shrinking spacing; Runions 2007, section 4, scatters its points so).
///
/// Cost: linear in `n`.
pub(super) fn scatter(
    volume: &Volume,
    n: usize,
    stream: &mut Stream,
    accept: impl Fn(DVec3) -> bool,
) -> Vec<DVec3> {
    let (lo, hi) = (volume.low(), volume.high());
    let deep = volume.deepest();
    // Relative to the body's middle, so that points in a body along a bent branch are scattered as in a straight one.
    let mut flat: Vec<DVec3> = Vec::with_capacity(n);
    let lift = |p: &DVec3| *p + DVec3::Z * volume.mid(p.truncate());
    // If only a shell is accepted, the first rounds are soon full and the spacing shrinks.
    let mut spacing = 1.1 * ops::cbrt(volume.bulk() / n.max(1) as f64);
    for _ in 0..ROUNDS {
        if flat.len() == n {
            break;
        }
        let mut buckets = Buckets::new(lo.extend(-deep), hi.extend(deep), spacing);
        for (i, &p) in flat.iter().enumerate() {
            buckets.add(i, p);
        }
        for _ in 0..n * DARTS {
            let xy = DVec2::new(stream.range(lo.x, hi.x), stream.range(lo.y, hi.y));
            let p = xy.extend(stream.range(-deep, deep));
            let inside = p.z.abs() <= volume.half_depth(xy) && volume.clearance(xy) > 0.0;
            if inside && accept(lift(&p)) && !buckets.any_within(&flat, p, spacing) {
                buckets.add(flat.len(), p);
                flat.push(p);
                if flat.len() == n {
                    break;
                }
            }
        }
        spacing *= 0.84;
    }
    flat.iter().map(lift).collect()
}

/// Returns at most `n` points at least `margin` inside the contour, evenly scattered as seen from the front; their
/// depths are spread over the middle `share` of the body. Cost: linear in `n`.
pub(super) fn scatter_front(
    volume: &Volume,
    n: usize,
    (margin, share): (f64, f64),
    stream: &mut Stream,
) -> Vec<DVec3> {
    let (lo, hi) = (volume.low(), volume.high());
    let mut flat: Vec<DVec3> = Vec::with_capacity(n);
    let mut spacing = 1.05 * (volume.area / n.max(1) as f64).sqrt();
    for _ in 0..ROUNDS {
        if flat.len() == n {
            break;
        }
        let mut buckets = Buckets::new(lo.extend(0.0), hi.extend(0.0), spacing);
        for (i, &p) in flat.iter().enumerate() {
            buckets.add(i, p);
        }
        for _ in 0..n * DARTS {
            let xy = DVec2::new(stream.range(lo.x, hi.x), stream.range(lo.y, hi.y));
            if volume.clearance(xy) > margin && !buckets.any_within(&flat, xy.extend(0.0), spacing) {
                buckets.add(flat.len(), xy.extend(0.0));
                flat.push(xy.extend(0.0));
                if flat.len() == n {
                    break;
                }
            }
        }
        spacing *= 0.84;
    }
    for p in &mut flat {
        let xy = p.truncate();
        p.z = volume.mid(xy) + share * volume.half_depth(xy) * stream.range(-1.0, 1.0);
    }
    flat
}

/// Returns at most `n` points along the drawn contour, `margin` inside it: they make the front view fill it. Their
/// depths are spread over the middle `share` of the body.
pub(super) fn scatter_rim(
    volume: &Volume,
    n: usize,
    (margin, share): (f64, f64),
    stream: &mut Stream,
) -> Vec<DVec3> {
    let inner = |p: DVec2| {
        let q = p + volume.inward(p) * margin;
        let z = volume.mid(q) + share * volume.half_depth(q) * stream.range(-1.0, 1.0);
        volume.contains_xy(q).then_some(q.extend(z))
    };
    volume.rim(n).into_iter().filter_map(inner).collect()
}

const NONE: u32 = u32::MAX;

/// Cubes with the points in them as linked lists: one row a cube, one a point.
#[derive(Debug)]
pub(super) struct Buckets {
    lo: DVec3,
    size: f64,
    n: [usize; 3],
    head: Vec<u32>,
    next: Vec<u32>,
}

impl Buckets {
    /// Builds cubes of edge `size`, or larger ones if there would be over 32 along an edge of the box.
    pub(super) fn new(lo: DVec3, hi: DVec3, size: f64) -> Self {
        let extent = (hi - lo).max(DVec3::ZERO);
        let size = size.max(extent.max_element() / 32.0).max(1e-12);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 32")]
        let n = (extent / size).to_array().map(|x| x as usize + 1);
        Self { lo, size, n, head: vec![NONE; n[0] * n[1] * n[2]], next: Vec::new() }
    }

    fn cell(&self, p: DVec3) -> [usize; 3] {
        let q = ((p - self.lo) / self.size).to_array();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        core::array::from_fn(|k| (q[k].max(0.0) as usize).min(self.n[k] - 1))
    }

    /// Adds point number `index`; numbers are given in order.
    pub(super) fn add(&mut self, index: usize, p: DVec3) {
        let c = self.cell(p);
        let bucket = (c[2] * self.n[1] + c[1]) * self.n[0] + c[0];
        debug_assert_eq!(index, self.next.len(), "points are added in order");
        self.next.push(self.head[bucket]);
        self.head[bucket] = u32::try_from(index).unwrap_or(NONE);
    }

    /// Calls `visit` for every point in the cubes that a box of half edge `radius` around `p` touches.
    pub(super) fn visit(&self, p: DVec3, radius: f64, mut visit: impl FnMut(usize)) {
        let (a, b) = (self.cell(p - DVec3::splat(radius)), self.cell(p + DVec3::splat(radius)));
        for z in a[2]..=b[2] {
            for y in a[1]..=b[1] {
                for x in a[0]..=b[0] {
                    let mut i = self.head[(z * self.n[1] + y) * self.n[0] + x];
                    while i != NONE {
                        visit(i as usize);
                        i = self.next[i as usize];
                    }
                }
            }
        }
    }

    fn any_within(&self, points: &[DVec3], p: DVec3, radius: f64) -> bool {
        let mut any = false;
        self.visit(p, radius, |i| any |= points[i].distance_squared(p) < radius * radius);
        any
    }
}
