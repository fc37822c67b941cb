//! Remains of lost branches on stems, and the wood that grew over them: stubs, knots, burls, hollows, broken limbs.
//!
//! `Plant of wood + ScarSpec -> Plant with axes of stubs`
//!
//! A branch in the shade dies, breaks off some distance from the stem, and its stub is grown over; if it rots before
//! that, a hollow remains (Shigo, A New Tree Biology, 1986; Mattheck and Breloer, The Body Language of Trees, 1994).

use core::ops::Range;

use base::ops::{self, TAU};
use base::{Draw, Seed};
use glam::DVec3;
use plant::{AxisId, AxisKind, NodeId, Plant};

use crate::wood::ScarSpec;
use crate::{Obstacles, WoodSpec};

/// Key under which a seed draws scars.
const SCARS: u64 = 0x0073_6361_7273;
/// Stem radii, metres, from which stubs and knots appear, and from which they are complete.
const SHED: [f64; 2] = [0.04, 0.10];
/// The same for burls, hollows and broken limbs: those of old stems.
const OLD: [f64; 2] = [0.10, 0.25];
/// Thickness of a borne axis, as a share of the stem there, above which it counts as a branch.
const BRANCH: f64 = 0.12;
/// Draws for a place, if others lie there, before it is given up.
const TRIES: u32 = 6;
/// Least distance of scars, in the sum of their radii.
const APART: f64 = 1.8;
/// Angle between a broken branch and its stem, radians.
const ANGLE: f64 = 1.2;
/// Variation of that angle, radians.
const SPREAD: f64 = 0.35;
/// Height of a dome relative to its radius.
const DOME: f64 = 0.55;
/// Pieces between the nodes of a scar.
const STEPS: u32 = 6;
/// Least height of hollows, in radii of the foot: lower ones would be buried in the flare of the drawn stem.
const ABOVE_FLARE: f64 = 2.5;
/// Height of a rim relative to its radius.
const RIM: f64 = 0.4;

/// Kind of a scar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scar {
    Stub,
    Knot,
    Burl,
    Hollow,
    BrokenLimb,
}

/// Adds the scars of lost branches to every stem that stands on the ground, except inside obstacles.
///
/// They draw nothing from the shoot and do not count in its measures ([`AxisKind::Stub`]).
pub(crate) fn add_scars(plant: &mut Plant, wood: &WoodSpec, obstacles: &Obstacles, seed: Seed) {
    if wood.scars == ScarSpec::default() {
        return;
    }
    let stems: Vec<AxisId> = (0..plant.axes.len())
        .map(AxisId::new)
        .filter(|&a| plant.axis(a).bearer.is_none() && plant.axis(a).kind == AxisKind::Branch)
        .collect();
    for stem in stems {
        let seed = seed.child(SCARS).child(plant.axis(stem).key);
        Stem::measure(plant, stem, obstacles).scar(plant, &wood.scars, seed);
    }
}

/// A stem, and its scars so far.
struct Stem<'a> {
    nodes: Vec<NodeId>,
    /// Arc length of each node from the foot, metres.
    way: Vec<f64>,
    radius: Vec<f64>,
    /// Length from the foot to its first branch.
    clear: f64,
    obstacles: &'a Obstacles,
    /// Positions of scars on the bark, and their radii.
    taken: Vec<(DVec3, f64)>,
}

impl<'a> Stem<'a> {
    fn measure(plant: &Plant, stem: AxisId, obstacles: &'a Obstacles) -> Self {
        let nodes: Vec<NodeId> = plant.axis(stem).node_ids().collect();
        let radius = plant.axis_radii(stem).to_vec();
        let mut way = vec![0.0; nodes.len()];
        for (k, pair) in plant.axis_points(stem).windows(2).enumerate() {
            way[k + 1] = way[k] + pair[0].distance(pair[1]);
        }
        let whole = way.last().copied().unwrap_or(0.0);
        let first = nodes.first().map_or(0, |n| n.index());
        let mut clear = whole;
        let mut taken = Vec::new();
        for axis in plant.axes.iter().filter(|a| a.kind == AxisKind::Branch) {
            let Some(k) = axis.bearer.and_then(|b| b.index().checked_sub(first)) else { continue };
            let Some((&at, &r)) = way.get(k).zip(radius.get(k)) else { continue };
            let mut points = axis.node_ids().map(|n| plant.nodes.position[n.index()]);
            let (Some(from), Some(to)) = (points.next(), points.next()) else { continue };
            let thick = plant.nodes.radius_m[axis.nodes.start as usize + 1];
            if thick > BRANCH * r {
                clear = clear.min(at);
                taken.push((from + (to - from).normalize_or_zero() * r, thick));
            }
        }
        Self { nodes, way, radius, clear, obstacles, taken }
    }

    /// Adds all scars that the spec sets for a stem of this thickness.
    fn scar(&mut self, plant: &mut Plant, spec: &ScarSpec, seed: Seed) {
        let foot = self.radius.first().copied().unwrap_or(0.0);
        let whole = self.way.last().copied().unwrap_or(0.0);
        let (shed, old) = (ops::smoothstep(SHED[0], SHED[1], foot), ops::smoothstep(OLD[0], OLD[1], foot));
        // Branches are lost from below: the highest stubs are the freshest, the lowest knots long grown over.
        let stubs = 0.25 * self.clear..(1.3 * self.clear).min(0.8 * whole);
        let knots = 0.12 * self.clear..(1.5 * self.clear).min(0.7 * whole);
        let low = 0.05 * self.clear..(1.1 * self.clear).min(0.6 * whole);
        let above = low.start.max(ABOVE_FLARE * foot);
        let hollows = above..low.end.max(above);
        let high = 0.9 * self.clear..(0.75 * whole).max(self.clear);
        let metres = |range: &Range<f64>| range.end - range.start;
        let wanted = [
            (Scar::BrokenLimb, old * spec.broken_limbs, high),
            (Scar::Burl, old * spec.burls, low),
            (Scar::Hollow, old * spec.hollows, hollows),
            (Scar::Knot, shed * spec.knots * metres(&knots), knots),
            (Scar::Stub, shed * spec.stubs * metres(&stubs), stubs),
        ];
        for ((what, number, range), kind) in wanted.into_iter().zip(0_u64..) {
            let seed = seed.child(kind);
            let number = ops::whole((number + seed.stream(Draw::Habit).uniform()).max(0.0));
            for k in 0..number {
                self.add(plant, what, &range, seed.child(u64::from(k) + 1));
            }
        }
    }

    /// Adds one scar somewhere in a range of the stem, where nothing lies yet.
    fn add(&mut self, plant: &mut Plant, what: Scar, range: &Range<f64>, seed: Seed) {
        let mut draw = seed.stream(Draw::Habit);
        for _ in 0..TRIES {
            let (share, turn, lean, size) = (draw.uniform(), draw.uniform(), draw.uniform(), draw.uniform());
            let at = range.start + share * (range.end - range.start);
            // A node of its own place, excluding the foot, where roots leave, and the tip.
            let k = self.way.partition_point(|w| *w < at);
            if k == 0 || k + 1 >= self.nodes.len() {
                continue;
            }
            let node = self.nodes[k];
            let (centre, r) = (plant.nodes.position[node.index()], self.radius[k]);
            let up = plant.nodes.position[self.nodes[k + 1].index()] - centre;
            let Some(course) = Course::new(what, r, (up, turn, lean, size)) else { continue };
            let bark = centre + course.way * r;
            let free = self.taken.iter().all(|(p, s)| p.distance(bark) > APART * (s + course.radius));
            let points = course.points(centre, r);
            if free && (self.obstacles.is_empty() || points.iter().all(|p| self.obstacles.free(*p))) {
                let id = plant.add_axis(AxisKind::Stub, Some(node), seed.number(), &points, None);
                let radii = course.radii();
                for (node, r) in plant.axis(id).node_ids().collect::<Vec<_>>().into_iter().zip(radii) {
                    plant.nodes.radius_m[node.index()] = r;
                }
                self.taken.push((bark, course.radius));
                return;
            }
        }
    }
}

/// Iterates over the positions of the nodes along a scar, 0 to 1.
fn shares() -> impl Iterator<Item = f64> {
    (0..=STEPS).map(|k| f64::from(k) / f64::from(STEPS))
}

/// The course of a scar: from the centre of the stem outwards.
struct Course {
    what: Scar,
    way: DVec3,
    /// Its radius where it leaves the stem, and its length beyond the bark, metres.
    radius: f64,
    beyond: f64,
}

impl Course {
    /// Makes a scar on a stem of radius `r` that leads `up`; `None` if the stem is so thin that nothing would show.
    fn new(what: Scar, r: f64, (up, turn, lean, size): (DVec3, f64, f64, f64)) -> Option<Self> {
        let (radius, beyond) = match what {
            Scar::Stub => {
                let radius = (r * (0.07 + 0.15 * size * size)).clamp(0.006, 0.045);
                (radius, radius * (1.5 + 6.0 * lean))
            }
            Scar::Knot => {
                let radius = r * (0.12 + 0.14 * size);
                (radius, RIM * radius)
            }
            Scar::Burl => {
                let radius = r * (0.3 + 0.35 * size * size);
                (radius, DOME * radius)
            }
            Scar::Hollow => {
                let radius = r * (0.28 + 0.17 * size);
                (radius, RIM * radius)
            }
            Scar::BrokenLimb => {
                let radius = r * (0.3 + 0.25 * size);
                (radius, radius * (3.0 + 5.0 * lean))
            }
        };
        let up = up.try_normalize()?;
        let (sin, cos) = ops::sin_cos(TAU * turn);
        let side = up.any_orthonormal_vector();
        let out = side * cos + up.cross(side) * sin;
        let angle = match what {
            Scar::Stub => ANGLE + SPREAD * (2.0 * lean - 1.0),
            Scar::BrokenLimb => 0.75 * ANGLE + SPREAD * (2.0 * size - 1.0),
            _ => ops::FRAC_PI_2,
        };
        let (sin, cos) = ops::sin_cos(angle);
        (radius > 0.004).then(|| Self {
            what,
            way: (out * sin + up * cos).normalize_or_zero(),
            radius,
            beyond,
        })
    }

    /// Returns its nodes; the first is at the bearer. A scar that leaves the stem at a slant shows less, as `r` is
    /// measured along it.
    fn points(&self, centre: DVec3, r: f64) -> Vec<DVec3> {
        let bend = match self.what {
            Scar::BrokenLimb => DVec3::Y * (0.12 * self.beyond),
            _ => DVec3::ZERO,
        };
        let at = |t: f64| centre + self.way * (r + t * self.beyond) + bend * (t * t);
        core::iter::once(centre).chain(shares().map(at)).collect()
    }

    /// Returns the radius of each node.
    fn radii(&self) -> Vec<f64> {
        let at = |t: f64| match self.what {
            Scar::Stub => 1.0 - 0.3 * t,
            Scar::BrokenLimb => 1.0 - 0.2 * t,
            Scar::Knot | Scar::Hollow => 1.0 - 0.15 * t,
            // A ball that rises from the bark.
            Scar::Burl => (1.0 - 0.98 * t * t).sqrt(),
        };
        core::iter::once(self.radius).chain(shares().map(|t| self.radius * at(t))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Obstacle;

    /// Makes a stem of 10 m with this radius and one branch at 6 m.
    fn stem(radius: f64) -> Plant {
        let mut plant = Plant::default();
        let line: Vec<DVec3> = (0..=100).map(|k| DVec3::Y * (0.1 * f64::from(k))).collect();
        let id = plant.add_axis(AxisKind::Branch, None, 7, &line, None);
        let bearer = plant.axis(id).node_ids().nth(60);
        plant.add_axis(AxisKind::Branch, bearer, 8, &[DVec3::Y * 6.0, DVec3::new(2.0, 7.0, 0.0)], None);
        plant.nodes.radius_m.fill(radius);
        plant
    }

    fn scarred(radius: f64, scars: &ScarSpec, obstacles: &Obstacles, seed: u64) -> Plant {
        let mut plant = stem(radius);
        let wood = WoodSpec { scars: scars.clone(), ..WoodSpec::default() };
        add_scars(&mut plant, &wood, obstacles, Seed::new(seed));
        assert_eq!(plant.validate().count(), 0);
        plant
    }

    fn all() -> ScarSpec {
        ScarSpec { stubs: 2.0, knots: 1.0, burls: 1.0, hollows: 1.0, broken_limbs: 1.0 }
    }

    #[test]
    fn as_many_as_are_asked_for_where_branches_have_gone() {
        let plant = scarred(0.3, &all(), &Obstacles::none(), 1);
        let stubs: Vec<_> = plant.axes.iter().filter(|a| a.kind == AxisKind::Stub).collect();
        // Stubs from 1.5 to 7.8 m, knots from 0.7 to 7 m; a few find no place.
        assert!((15..=24).contains(&stubs.len()), "{}", stubs.len());
        for stub in &stubs {
            let place = plant.nodes.position[stub.bearer.expect("borne").index()].y;
            assert!((0.25..8.0).contains(&place), "{place}");
            let [first, .., last] = &plant.nodes.position[stub.nodes.start as usize..stub.nodes.end as usize]
            else {
                panic!("a course")
            };
            assert_eq!(first.y, place);
            let out = DVec3::new(last.x, 0.0, last.z).length();
            assert!(out > 0.25 && out < 2.0, "out of the bark: {out}");
        }
        assert_ne!(plant, scarred(0.3, &all(), &Obstacles::none(), 2));
        assert_eq!(plant, scarred(0.3, &all(), &Obstacles::none(), 1));
    }

    #[test]
    fn thin_stems_have_none_and_obstacles_keep_them_away() {
        assert_eq!(scarred(0.03, &all(), &Obstacles::none(), 1).axes.len(), 2);
        assert_eq!(scarred(0.3, &ScarSpec::default(), &Obstacles::none(), 1).axes.len(), 2);
        // A stem of 8 cm has only lost branches.
        let old = ScarSpec { stubs: 0.0, knots: 0.0, ..all() };
        assert_eq!(scarred(0.08, &old, &Obstacles::none(), 1).axes.len(), 2);
        assert!(scarred(0.08, &all(), &Obstacles::none(), 1).axes.len() > 6);
        let wall = Obstacle::Box { min: DVec3::new(0.2, 0.0, -9.0), max: DVec3::new(9.0, 20.0, 9.0) };
        let walled = scarred(0.3, &all(), &Obstacles::new(&[wall], 0.02).expect("sound"), 1);
        let stubs = walled.axes.iter().filter(|a| a.kind == AxisKind::Stub);
        let ends: Vec<f64> = stubs.map(|a| walled.nodes.position[a.nodes.end as usize - 1].x).collect();
        assert!(ends.len() > 5 && ends.iter().all(|x| *x < 0.2), "{ends:?}");
    }

    #[test]
    fn hollows_lie_above_the_flare_of_the_foot() {
        let hollows = ScarSpec { hollows: 3.0, ..ScarSpec::default() };
        for seed in 0..20 {
            let plant = scarred(0.4, &hollows, &Obstacles::none(), seed);
            for hollow in plant.axes.iter().filter(|a| a.kind == AxisKind::Stub) {
                let place = plant.nodes.position[hollow.bearer.expect("borne").index()].y;
                assert!(place > ABOVE_FLARE * 0.4 - 0.05, "{place}");
            }
        }
    }
}
