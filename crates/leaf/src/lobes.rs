//! Side veins of the lobes of a palmate leaf.
//!
//! chief vein, margin -> ends on the margin, teeth first -> straight paths over the blade -> `Vein`s

use base::ops;
use geom::{Ball, BallBSpline, NaturalCubic, SplineSurface};
use glam::{DVec2, DVec3};
use plant::Vein;

use crate::rays::{RayLeaf, Rays};

/// Points of a side vein on the blade; between them it is a cubic.
const POINTS: usize = 17;
/// Cosine of the angle between a side vein and its chief vein: 40 degrees.
const LEAVES_AT: f64 = 0.766;

impl RayLeaf {
    /// Adds up to `each` side veins (at most 12) from each chief vein to the margin of its lobe on either side.
    ///
    /// They are made by rule, not measured: they end on teeth where the margin has some, leave the chief vein at about
    /// 40 degrees and have half of its thickness there. All their marks lie on the blade. A path that would leave the
    /// blade gets no vein, nor do chief veins that come together again (parallel veins).
    pub fn add_side_veins(&mut self, rays: &Rays, each: usize) {
        let from_left: Vec<_> = rays.rays.iter().rev().collect();
        let ends: Vec<DVec3> = from_left.iter().filter_map(|r| r.points.last().copied()).collect();
        let Some(base) = from_left.first().and_then(|r| r.points.first().copied()) else { return };
        if ends.len() != from_left.len() {
            return;
        }
        let chiefs: Vec<usize> = (0..from_left.len()).filter(|&j| from_left[j].is_vein()).collect();
        for (i, &j) in chiefs.iter().enumerate() {
            let reach = |m: usize| ends[m].distance(base);
            let lowest = |range: core::ops::Range<usize>| {
                range.min_by(|&a, &b| reach(a).total_cmp(&reach(b)).then(a.cmp(&b))).unwrap_or(j)
            };
            let left = if i == 0 { 0 } else { lowest(chiefs[i - 1] + 1..j) };
            let right = chiefs.get(i + 1).map_or(ends.len() - 1, |&next| lowest(j + 1..next));
            let sides = [(left..=j).rev().collect::<Vec<_>>(), (j..=right).collect()];
            for margin in sides {
                let made = self.one_side(i, &margin, &ends, base, each.min(12));
                self.sides.extend(made);
            }
        }
    }

    /// Returns the side veins of one half of a lobe; `margin` are the rays from the chief vein to the notch.
    fn one_side(
        &self,
        chief: usize,
        margin: &[usize],
        ends: &[DVec3],
        base: DVec3,
        each: usize,
    ) -> Vec<Vein> {
        let (Some(vein), Some(&u0)) = (self.veins.get(chief), self.at.get(chief)) else { return vec![] };
        let us = self.blade.columns_at();
        let mut way = vec![0.0];
        for w in margin.windows(2) {
            way.push(way[way.len() - 1] + ends[w[0]].distance(ends[w[1]]));
        }
        let total = way[way.len() - 1];
        let length = ends[margin[0]].distance(base);
        // 0.15: veins that meet again at the tip, or a lobe without width.
        let wide = total > 0.15 * length && length > 0.0;
        if !wide {
            return vec![];
        }
        let tooth = |k: usize| {
            k > 0 && k + 1 < margin.len() && {
                let r = |k: usize| ends[margin[k]].distance(base);
                r(k) > r(k - 1) && r(k) > r(k + 1)
            }
        };
        let mut out: Vec<Vein> = Vec::new();
        let mut last = f64::INFINITY;
        for k in 0..each {
            let share = (k as f64 + 0.55) / (each as f64 + 0.25);
            let near = |m: &usize| (way[*m] / total - share).abs();
            let snapped = (0..margin.len())
                .filter(|&m| tooth(m) && near(&m) < 0.5 / each as f64)
                .min_by(|a, b| near(a).total_cmp(&near(b)));
            let u1 = snapped.map_or_else(
                || {
                    let m = way.partition_point(|&s| s < share * total).clamp(1, way.len() - 1);
                    let t = (share * total - way[m - 1]) / (way[m] - way[m - 1]).max(1e-300);
                    ops::lerp(us[margin[m - 1]], us[margin[m]], t.clamp(0.0, 1.0))
                },
                |m| us[margin[m]],
            );
            let Some(v0) = self.leaves_at(u0, self.blade.point(u1, 0.985)) else { continue };
            // Consecutive ends towards the base leave the chief vein in the same order, apart.
            if v0 > last - 0.045 {
                continue;
            }
            if let Some(vein) = self.side_vein(vein, [u0, v0], [u1, 0.985]) {
                last = v0;
                out.push(vein);
            }
        }
        out
    }

    /// Returns the place on the chief vein at `u` where a side vein to `end` leaves at the right angle.
    fn leaves_at(&self, u: f64, end: DVec3) -> Option<f64> {
        let cosine = |v: f64| {
            let at = self.blade.point(u, v);
            let along = self.blade.point(u, v + 0.02) - at;
            along.normalize_or_zero().dot((end - at).normalize_or_zero())
        };
        let found = (6..=45).map(|k| 0.02 * f64::from(k)).find(|&v| cosine(v) < LEAVES_AT)?;
        // Near the base an end may lie far to the side: at 72 degrees it is no longer a side vein.
        (cosine(found) > 0.3).then_some(found)
    }

    fn side_vein(&self, chief: &Vein, from: [f64; 2], to: [f64; 2]) -> Option<Vein> {
        let place = |[u, v]: [f64; 2]| self.blade.point(u, v);
        let (start, end) = (place(from), place(to));
        let ahead = (self.blade.point(from[0], from[1] + 0.02) - start).normalize_or_zero();
        let long = start.distance(end);
        let thick = chief.curve.ball(from[1]).radius;
        let mut balls = Vec::with_capacity(POINTS);
        let mut uv = DVec2::from_array(from);
        for k in 0..POINTS {
            let s = k as f64 / (POINTS - 1) as f64;
            // Slightly arched towards the tip of the lobe.
            let target = start.lerp(end, s) + ahead * (0.16 * long * s * (1.0 - s));
            uv = nearest(&self.blade, uv, target);
            let p = self.blade.point(uv.x, uv.y);
            if p.distance(target) > 0.06 * long {
                return None;
            }
            balls.push(Ball::new(p, thick * ops::lerp(0.5, 0.14, s)));
        }
        let points: Vec<DVec3> = balls.iter().map(|b| b.centre).collect();
        let marks = geom::chord_parameters(&points)?;
        // Coincident points have no chord.
        if marks.len() != balls.len() {
            return None;
        }
        let curve = BallBSpline::interpolate_at(&NaturalCubic::new(&marks).ok()?, &balls).ok()?;
        Some(Vein { curve, marks })
    }
}

/// Returns the parameters of the point on a blade nearest to `p`, by Gauss and Newton from `uv` on.
fn nearest(blade: &SplineSurface, mut uv: DVec2, p: DVec3) -> DVec2 {
    const STEP: f64 = 1e-6;
    for _ in 0..12 {
        let at = blade.point(uv.x, uv.y);
        // Differences are taken inwards, so that both points lie in the domain.
        let side = DVec2::select(uv.cmplt(DVec2::splat(0.5)), DVec2::ONE, DVec2::NEG_ONE) * STEP;
        let du = (blade.point(uv.x + side.x, uv.y) - at) / side.x;
        let dv = (blade.point(uv.x, uv.y + side.y) - at) / side.y;
        let off = p - at;
        let (a, b, c) = (du.dot(du), du.dot(dv), dv.dot(dv));
        let det = a * c - b * b;
        if det <= 1e-12 * a * c {
            break;
        }
        let step = DVec2::new(c * du.dot(off) - b * dv.dot(off), a * dv.dot(off) - b * du.dot(off)) / det;
        // 0.2: teeth make the blade wavy, a long step could land on another lobe.
        let step = step.clamp_length_max(0.2);
        uv = (uv + step).clamp(DVec2::new(0.0, 0.01), DVec2::ONE);
        if step.length() < 1e-10 {
            break;
        }
    }
    uv
}

#[cfg(test)]
mod tests {
    use crate::{ParallelSpec, RayLeaf, Rays, ThicknessRule};

    #[test]
    fn parallel_veins_have_none() {
        let rays = Rays::parallel(&ParallelSpec::default());
        let mut leaf = RayLeaf::new(&rays, ThicknessRule::Diameter).unwrap();
        leaf.add_side_veins(&rays, 4);
        assert!(leaf.sides.is_empty(), "{}", leaf.sides.len());
    }
}
