//! Courses of wood next to obstacles: bark stays out of them, and limbs go round at a distance that suits their
//! thickness.
//!
//! `course with radii -> refined near obstacles -> pushed out by its radius -> thinned where there is no room`

use base::ops;
use glam::DVec3;

use crate::Obstacles;

/// Tolerance between the drawn line and the course, as a share of the tree's size.
const DRAWN: f64 = 0.0012;
/// Largest distance of bark from the course, in radii: bends that are smoothed, corners of fillets.
const BARK: f64 = 1.08;
/// Widening of a foot relative to the trunk above it, over two radii.
const FLARE: f64 = 0.25;
/// Straight part of a trunk above the obstacle that it stands on, in radii.
const STRAIGHT: f64 = 1.2;
/// Part of that trunk within which it is bent upwards, in radii.
const BENT: f64 = 4.0;
/// Largest taper of wood towards a place without room: radius over length.
const TAPER: f64 = 0.25;
/// Rounds of pushing; in all but the last ones neighbours follow by half, so that bends are wide.
const ROUNDS: u32 = 14;
/// Last rounds of pushing, in which neighbours do not follow.
const HARD_ROUNDS: u32 = 4;

/// An axis under construction: points with radii, and, for points that are joints, the index in the chain of joints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Course {
    /// Whether it stands on the ground and not on a bearer.
    pub(crate) rooted: bool,
    pub(crate) points: Vec<DVec3>,
    pub(crate) radii: Vec<f64>,
    pub(crate) joint: Vec<Option<usize>>,
    /// Tolerance for leaving points out, metres: smaller near an obstacle.
    pub(crate) aside: Vec<f64>,
    /// Largest radius of wood from each point on, as it was squeezed below.
    pub(crate) cap: Vec<f64>,
    /// Length from its start on which it stands on an obstacle or runs inside its bearer, and is not changed.
    hidden: f64,
    /// Distance of its start from the nearest obstacle.
    start: f64,
}

/// Start of a course.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    /// Displacement of its bearer.
    pub(crate) moved: DVec3,
    /// Largest radius of its wood.
    pub(crate) cap: f64,
    /// Length that runs inside its bearer.
    pub(crate) within: f64,
}

/// Distances that wood keeps from obstacles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room<'a> {
    obstacles: &'a Obstacles,
    /// Target of the distance between bark and obstacles, and its least value.
    wish: f64,
    least: f64,
    tip: f64,
}

impl<'a> Room<'a> {
    /// Prepares the obstacles for a tree of this `size` whose tips have the radius `tip`, both in metres.
    pub(crate) fn new(obstacles: &'a Obstacles, size: f64, tip: f64) -> Self {
        let least = DRAWN * size;
        Self { obstacles, wish: obstacles.clearance_m().max(least), least, tip }
    }

    /// Moves a course clear of the obstacles near it, if there are any.
    ///
    /// Where nothing can be moved, as between two walls, wood becomes thinner, and so does everything that grows from
    /// it; where it would be thinner than a third of a tip, it ends.
    pub(crate) fn clear(&self, course: &mut Course, foot: Foot) {
        let n = course.points.len();
        if self.obstacles.is_empty() || n < 2 {
            return;
        }
        let whole = foot.moved.length();
        if whole > 1e-9 {
            // Wood on a bearer that was pushed aside moves with it, decreasingly over four times the displacement.
            let along = lengths(&course.points);
            for (p, way) in course.points.iter_mut().zip(&along).skip(1) {
                *p += foot.moved * (1.0 - way / (4.0 * whole)).max(0.0);
            }
        }
        let near = self.refine(course);
        course.hidden = foot.within;
        let ground = if near && course.rooted { self.ground(course) } else { None };
        if let Some(out) = ground {
            course.stand(out);
        }
        course.cap = vec![foot.cap; course.points.len()];
        if !near {
            course.radii.iter_mut().for_each(|r| *r = r.min(foot.cap));
            return;
        }
        course.start = self.distance(course.points[0]).max(0.0);
        let first = usize::from(!course.rooted || ground.is_some());
        self.push(course, first);
        self.squeeze(course, first, foot.cap);
    }

    /// Adds points near obstacles, so that straight pieces do not cut corners. Returns whether an obstacle is near.
    fn refine(&self, course: &mut Course) -> bool {
        let old = core::mem::take(course);
        let ways: Vec<f64> = old.points.windows(2).map(|w| w[0].distance(w[1])).collect();
        let bound = |k: usize| self.bound(old.radii[k]);
        let way = |k: Option<usize>| k.and_then(|k| ways.get(k)).copied().unwrap_or(0.0);
        // Beyond the distance that is queried below, it is infinite.
        let far: Vec<f64> = (0..old.points.len())
            .map(|k| {
                let reach = bound(k) + way(Some(k)).max(way(k.checked_sub(1)));
                self.obstacles.nearest_within(old.points[k], reach).map_or(f64::INFINITY, |w| w.0)
            })
            .collect();
        course.rooted = old.rooted;
        let mut any = false;
        for i in 0..old.points.len() {
            let near = |k: usize, beyond: f64| far[k] < bound(k) + beyond;
            let aside = if near(i, 0.0) { old.aside[i].min(0.25 * self.wish) } else { old.aside[i] };
            any |= near(i, 0.0);
            let joint = old.joint[i];
            course.add(old.points[i], old.radii[i], joint, aside);
            let Some((&to, &from)) = old.points.get(i + 1).zip(old.points.get(i)) else { break };
            let way = way(Some(i));
            if !(near(i, way) || near(i + 1, way)) {
                continue;
            }
            any = true;
            let step = 0.5 * (self.wish + old.radii[i].min(old.radii[i + 1]));
            let pieces = (way / step).ceil().clamp(1.0, 64.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 64")]
            for k in 1..pieces as u32 {
                let u = f64::from(k) / pieces;
                let r = ops::lerp(old.radii[i], old.radii[i + 1], u);
                course.add(from.lerp(to, u), r, None, aside.min(0.25 * self.wish));
            }
        }
        any
    }

    /// Returns the direction up from the obstacle that a trunk stands on, if it does.
    fn ground(&self, course: &Course) -> Option<DVec3> {
        let (distance, out) = self.obstacles.nearest(course.points[0])?;
        (distance < (1.0 + FLARE) * course.radii[0] && out.y > 0.5).then_some(out)
    }

    /// Pushes points out until bark is clear; the points next to them follow.
    fn push(&self, course: &mut Course, first: usize) {
        let n = course.points.len();
        let start = course.points.clone();
        let along = lengths(&start);
        let mut shift = vec![DVec3::ZERO; n];
        for round in 0..ROUNDS {
            let mut moved = false;
            for i in first..n {
                let Some((distance, out)) = self.wall(course, i, &along) else { continue };
                // Near its start there is no more room than the start has.
                let wish = self.wish.min(course.start + 0.5 * along[i]).max(self.least.min(along[i]));
                let needed = wish + self.bark(course, i, &along, out) * course.radii[i];
                if distance < needed - 1e-6 {
                    // The foot stays on its ground.
                    let out = if i == 0 { DVec3::new(out.x, 0.0, out.z) } else { out };
                    course.points[i] += out.normalize_or_zero() * (needed - distance);
                    moved = true;
                }
            }
            if !moved {
                return;
            }
            if round + HARD_ROUNDS >= ROUNDS {
                continue;
            }
            for (s, (p, q)) in shift.iter_mut().zip(course.points.iter().zip(&start)) {
                *s = *p - *q;
            }
            for i in first.max(1)..n {
                let after = shift[(i + 1).min(n - 1)];
                course.points[i] = start[i] + (shift[i - 1] + shift[i] * 2.0 + after) * 0.25;
            }
        }
    }

    /// Thins wood without room, and ends it where there is none at all or an obstacle stands in the way.
    fn squeeze(&self, course: &mut Course, first: usize, cap: f64) {
        let n = course.points.len();
        let along = lengths(&course.points);
        let (mut cap, mut end) = (cap, n);
        let mut squeezed = vec![false; n];
        for (i, squeezed) in squeezed.iter_mut().enumerate() {
            let wall = if i < first { None } else { self.wall(course, i, &along) };
            if let Some((distance, out)) = wall {
                let fits = (distance - self.least) / self.bark(course, i, &along, out).max(1e-3);
                let crossed = i > 0 && self.obstacles.blocks(course.points[i - 1], course.points[i]);
                *squeezed = fits < course.radii[i];
                if crossed || *squeezed && fits < self.tip / 3.0 {
                    end = i;
                    break;
                }
                cap = if *squeezed { cap.min(fits) } else { cap };
            }
            course.radii[i] = course.radii[i].min(cap);
            course.cap[i] = cap;
        }
        // Wood tapers towards a squeezed place or its end; beyond that place it stays as thin.
        let mut most = if end < n { self.tip } else { f64::INFINITY };
        for i in (0..end).rev() {
            most = if squeezed[i] { most.min(course.radii[i]) } else { most };
            course.radii[i] = course.radii[i].min(most);
            most += TAPER * course.points[i].distance(course.points[i.saturating_sub(1)]);
        }
        course.truncate(end);
    }

    /// Returns the distance of a point of a course from the nearest obstacle and the way out; `None` if the point is
    /// hidden, or so far that nothing is done.
    fn wall(&self, course: &Course, i: usize, along: &[f64]) -> Option<(f64, DVec3)> {
        let reach = 2.0 * self.bound(course.radii[i]);
        if along[i] < course.hidden { None } else { self.obstacles.nearest_within(course.points[i], reach) }
    }

    /// Returns the distance beyond which an obstacle does not affect wood of a radius, metres.
    fn bound(&self, radius: f64) -> f64 {
        2.0 * self.wish + (1.0 + FLARE) * BARK * radius
    }

    /// Returns how far bark reaches towards an obstacle from the course, in radii: a slice of wood is a disc, and a tip
    /// is round.
    fn bark(&self, course: &Course, i: usize, along: &[f64], out: DVec3) -> f64 {
        let (points, n) = (&course.points, course.points.len());
        if i + 1 == n {
            return BARK;
        }
        let ahead = (points[i + 1] - points[i.saturating_sub(1)]).normalize_or(DVec3::Y);
        let lean = ahead.dot(out);
        let flare = if course.rooted { 1.0 - along[i] / (2.0 * course.radii[0].max(1e-12)) } else { 0.0 };
        BARK * (1.0 + FLARE * flare.max(0.0)) * (1.0 - lean * lean).max(0.0).sqrt()
    }

    fn distance(&self, p: DVec3) -> f64 {
        self.obstacles.nearest(p).map_or(f64::INFINITY, |(distance, _)| distance)
    }
}

impl Course {
    /// Removes all points.
    pub(crate) fn clear(&mut self) {
        self.truncate(0);
    }

    pub(crate) fn add(&mut self, point: DVec3, radius: f64, joint: Option<usize>, aside: f64) {
        self.points.push(point);
        self.radii.push(radius);
        self.joint.push(joint);
        self.aside.push(aside);
    }

    /// Makes a trunk rise at right angles to the surface that it stands on, so that its foot lies flat on it, and bend
    /// upwards over four times its radius.
    fn stand(&mut self, out: DVec3) {
        let (foot, r, along) = (self.points[0], self.radii[0], lengths(&self.points));
        for (p, way) in self.points.iter_mut().zip(&along) {
            let u = ((way / r - STRAIGHT) / (BENT - STRAIGHT)).clamp(0.0, 1.0);
            *p = (foot + out * *way).lerp(*p, u * u * (3.0 - 2.0 * u));
        }
        self.hidden = BENT * r;
        // Three points in a row: otherwise the drawn line would lean from the start.
        let step = along[1].min(STRAIGHT * r) / 3.0;
        for k in [2.0, 1.0] {
            self.points.insert(1, foot + out * (k * step));
            self.radii.insert(1, r);
            self.joint.insert(1, None);
            self.aside.insert(1, 0.0);
        }
    }

    fn truncate(&mut self, n: usize) {
        self.points.truncate(n);
        self.radii.truncate(n);
        self.joint.truncate(n);
        self.aside.truncate(n);
        self.cap.truncate(n);
    }
}

/// Returns the length from the first point to each.
fn lengths(points: &[DVec3]) -> Vec<f64> {
    let mut sum = 0.0;
    let ways = (0..points.len()).map(|i| {
        sum += points[i].distance(points[i.saturating_sub(1)]);
        sum
    });
    ways.collect()
}

#[cfg(test)]
mod tests {
    use base::Run;

    use super::*;
    use crate::{Obstacle, Skeleton, Wood, WoodSpec, make_wood};

    /// Makes a pole of 4 m whose foot is `x` from the centre, 10 cm thick all along.
    fn pole(obstacles: &[Obstacle]) -> Wood {
        let mut s = Skeleton::default();
        let mut top = s.push_root(DVec3::ZERO, 0);
        for i in 1..=20 {
            top = s.push(DVec3::Y * (0.2 * f64::from(i)), top, 1);
        }
        s.radius_m.fill(0.1);
        let all = Obstacles::new(obstacles, 0.05).expect("sound");
        make_wood(&s, &WoodSpec { relax: 0, ..WoodSpec::default() }, &all, &Run::plain()).expect("sound")
    }

    fn wall(x: f64) -> Obstacle {
        let sign = if x > 0.0 { 1.0 } else { -1.0 };
        let (a, b) = (DVec3::new(x, 1.0, -2.0), DVec3::new(x + sign, 2.5, 2.0));
        Obstacle::Box { min: a.min(b), max: a.max(b) }
    }

    #[test]
    fn a_pole_bends_round_a_wall_by_what_it_is_thick() {
        let plain = pole(&[]).plant;
        let far = pole(&[wall(3.0)]).plant;
        assert_eq!(plain.digest_hex(), far.digest_hex(), "what is far changes nothing");
        let bent = pole(&[wall(0.07)]).plant;
        for (p, r) in bent.nodes.position.iter().zip(&bent.nodes.radius_m) {
            assert!((*r - 0.1).abs() < 1e-9, "there is room on the other side");
            let beside = (1.0..2.5).contains(&p.y);
            assert!(!beside || p.x <= 0.07 - 0.05 - 0.1 + 1e-6, "{p}");
        }
        let (foot, tip) = (bent.nodes.position[0], bent.nodes.position[bent.nodes.position.len() - 1]);
        assert!(foot.length() < 1e-9 && tip.x.abs() < 0.02, "{foot} {tip}");
    }

    #[test]
    fn between_two_walls_wood_is_thinner_and_stays_so_above() {
        let thin = pole(&[wall(0.08), wall(-0.08)]).plant;
        let radius = |low: f64, high: f64| {
            let nodes = thin.nodes.position.iter().zip(&thin.nodes.radius_m);
            nodes.filter(|(p, _)| (low..high).contains(&p.y)).map(|(_, r)| *r).fold(0.0, f64::max)
        };
        assert!(radius(0.0, 0.5) > 0.099 && radius(1.0, 2.5) < 0.08, "{}", radius(1.0, 2.5));
        assert!(radius(2.5, 4.1) <= radius(1.0, 2.5) + 1e-9);
        // No twig fits through a slit: it ends below, and thin.
        let cut = pole(&[wall(0.004), wall(-0.004)]).plant;
        let top = cut.nodes.position.iter().map(|p| p.y).fold(0.0, f64::max);
        let end = cut.nodes.radius_m[cut.nodes.radius_m.len() - 1];
        assert!((0.4..1.0).contains(&top) && end < 0.01, "{top} {end}");
    }

    #[test]
    fn a_foot_lies_flat_on_its_slope_and_beside_its_wall() {
        let normal = DVec3::new(-0.5, 0.75_f64.sqrt(), 0.0);
        let slope = pole(&[Obstacle::Plane { point: DVec3::ZERO, normal }]).plant;
        let p = &slope.nodes.position;
        assert!(p[0].length() < 1e-9 && (p[1] - p[0]).normalize().dot(normal) > 1.0 - 1e-9);
        assert!((p[p.len() - 1] - p[p.len() - 2]).normalize().y > 0.99);
        let house = Obstacle::Box { min: DVec3::new(0.06, -1.0, -2.0), max: DVec3::new(2.0, 6.0, 2.0) };
        let beside = pole(&[house]).plant;
        let foot = beside.nodes.position[0];
        assert!(foot.y.abs() < 1e-12 && (-0.15..-0.09).contains(&foot.x), "{foot}");
    }
}
