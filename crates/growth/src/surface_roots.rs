//! Roots that leave the foot of a stem and run along the ground until they sink into it.
//!
//! `Plant of wood + SurfaceRootSpec -> Plant with axes of roots`
//!
//! A tree has 4 to 11 main ones (Perry, Journal of Arboriculture 8, 1982), which swell where they join the stem and
//! lose most of their thickness near it, in the zone of rapid taper (Wilson, Harvard Forest Paper 11, 1964).

use base::ops::{self, TAU};
use base::{Draw, Seed};
use glam::DVec3;
use plant::{AxisKind, NodeId, Plant};

use crate::wood::SurfaceRootSpec;
use crate::{Obstacles, WoodSpec};

/// Key under which a seed draws surface roots.
const ROOTS: u64 = 0x0072_6f6f_7473;
/// Stem radii, metres, from which they appear, and from which they are complete.
const FROM_M: [f64; 2] = [0.02, 0.12];
/// Nodes of a root beyond the stem's centre.
const STEPS: u32 = 16;
/// Cross-section of all roots at the stem, relative to that of the stem's foot: they swell where they join.
const COLLAR: f64 = 9.0;
/// Share of its thickness that a root loses in the zone of rapid taper.
const TAPER: f64 = 0.62;
/// Length of that zone, as a share of the root's length.
const ZONE: f64 = 0.3;
/// Distance from the centre of the stem at which a root leaves it, in radii of the foot.
const WITHIN: f64 = 1.4;
/// Height of the centre of a root above the ground where it leaves the stem, in its own radius there.
const RAISED: f64 = 0.45;
/// Exponent of the remaining share of its length that gives its height.
const FALL: f64 = 2.0;
/// Depth of the end in the ground, in its own radius: out of sight.
const SUNK: f64 = 1.2;
/// Share of its length from which it sinks, so that it narrows by being covered and not to a spike.
const SINKS: f64 = 0.1;
/// Largest turn of a root between two nodes, radians.
const WANDER: f64 = 0.25;
/// Share of a turn that continues at the next node.
const GOES_ON: f64 = 0.3;
/// Share of roots that fork.
const FORKS: f64 = 0.5;

/// Adds roots to every stem that stands on the ground. A root that meets an obstacle is left out.
///
/// They draw nothing from the shoot and do not count in its measures ([`AxisKind::Root`]).
pub(crate) fn add_surface_roots(plant: &mut Plant, wood: &WoodSpec, obstacles: &Obstacles, seed: Seed) {
    let spec = &wood.surface_roots;
    if spec.count == 0 {
        return;
    }
    let stems: Vec<(NodeId, u64)> = plant
        .axes
        .iter()
        .filter(|a| a.bearer.is_none() && a.kind == AxisKind::Branch)
        .filter_map(|a| Some((a.node_ids().next()?, a.key)))
        .collect();
    for (foot, key) in stems {
        let radius = plant.nodes.radius_m[foot.index()];
        let grown = ops::smoothstep(FROM_M[0], FROM_M[1], radius);
        if grown <= 0.0 {
            continue;
        }
        let ground = plant.nodes.position[foot.index()].y;
        let roots = Roots { spec, radius, grown, ground, obstacles };
        for k in 0..spec.count {
            let seed = seed.child(ROOTS).child(key).child(u64::from(k));
            roots.add(plant, foot, f64::from(k) / f64::from(spec.count), seed);
        }
    }
}

/// Common data of the roots of one stem.
struct Roots<'a> {
    spec: &'a SurfaceRootSpec,
    /// Radius of the stem's foot, metres.
    radius: f64,
    /// Size of the roots of a stem of this radius relative to complete ones, 0 to 1.
    grown: f64,
    /// Height of the ground, metres.
    ground: f64,
    obstacles: &'a Obstacles,
}

impl Roots<'_> {
    /// Adds a root that leaves at a share of the circumference, and its forks.
    fn add(&self, plant: &mut Plant, foot: NodeId, share: f64, seed: Seed) {
        let mut draw = seed.stream(Draw::Habit);
        let turn = TAU * (share + 0.7 * (draw.uniform() - 0.5) / f64::from(self.spec.count));
        let weight = 0.6 + 0.8 * draw.uniform();
        let thick = self.grown * self.radius * (COLLAR * weight / f64::from(self.spec.count).max(4.0)).sqrt();
        let beyond = (self.spec.reach - WITHIN) * self.grown * (0.6 + 0.8 * draw.uniform());
        // Nothing shows within the stem, which is wider at the ground.
        let within = WITHIN * self.radius;
        let length = within + self.radius * beyond;
        let lift = RAISED * thick;
        let Some(root) = self.run(plant, foot, turn, (length, thick, lift, within / length), seed) else {
            return;
        };
        if draw.uniform() < FORKS {
            let middle = root[root.len() / 2];
            let (at, r) = (plant.nodes.position[middle.index()], plant.nodes.radius_m[middle.index()]);
            let aside = turn + if draw.uniform() < 0.5 { 0.6 } else { -0.6 };
            let lift = at.y - self.ground;
            self.run(plant, middle, aside, (0.55 * length, 0.85 * r, lift, 0.0), seed.child(1));
        }
    }

    /// Returns the nodes of one course of a length, with thickness and height at its start, of which a first share is
    /// hidden; `None` if an obstacle stands there.
    fn run(
        &self,
        plant: &mut Plant,
        bearer: NodeId,
        turn: f64,
        (length, thick, lift, hidden): (f64, f64, f64, f64),
        seed: Seed,
    ) -> Option<Vec<NodeId>> {
        let mut draw = seed.child(2).stream(Draw::Habit);
        let start = plant.nodes.position[bearer.index()];
        let end = thick * (1.0 - TAPER) * 0.5;
        let (mut points, mut radii) = (vec![start], vec![thick]);
        let (mut at, mut turn, mut turns) = (DVec3::new(start.x, 0.0, start.z), turn, 0.0);
        for step in 1..=STEPS {
            let way = f64::from(step) / f64::from(STEPS);
            let t = ((way - hidden) / (1.0 - hidden)).max(0.0);
            if t > 0.0 {
                turns = GOES_ON * turns + WANDER * (draw.uniform() - 0.5) * 2.0;
                turn += turns;
            }
            let (sin, cos) = ops::sin_cos(turn);
            at += DVec3::new(cos, 0.0, sin) * (length / f64::from(STEPS));
            let rapid = TAPER * (1.0 - ops::exp(-t / ZONE)) / (1.0 - ops::exp(-1.0 / ZONE));
            let r = (thick * (1.0 - rapid) * (1.0 - 0.5 * t)).max(end);
            let bob = 0.3 * r * (draw.uniform() - 0.5) * t.sqrt();
            let sunk = SUNK * r * ops::smoothstep(SINKS, 1.0, t);
            let y = lift * ops::powf(1.0 - t, FALL) * (way / hidden.max(1e-9)).min(1.0) - sunk + bob;
            points.push(DVec3::new(at.x, self.ground + y, at.z));
            radii.push(r);
        }
        if !self.obstacles.is_empty() && !points.iter().all(|p| self.obstacles.free(*p)) {
            return None;
        }
        let id = plant.add_axis(AxisKind::Root, Some(bearer), seed.number(), &points, None);
        let nodes: Vec<NodeId> = plant.axis(id).node_ids().collect();
        for (node, r) in nodes.iter().zip(radii) {
            plant.nodes.radius_m[node.index()] = r;
        }
        Some(nodes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Obstacle;

    /// Makes a stem of 6 m with this radius at its foot, standing one metre up.
    fn pole(radius: f64) -> Plant {
        let mut plant = Plant::default();
        let line: Vec<DVec3> = (1..=7).map(|y| DVec3::Y * f64::from(y)).collect();
        plant.add_axis(AxisKind::Branch, None, 7, &line, None);
        plant.nodes.radius_m.fill(radius);
        plant
    }

    fn rooted(radius: f64, obstacles: &Obstacles, seed: u64) -> Plant {
        let mut plant = pole(radius);
        let wood = WoodSpec {
            surface_roots: SurfaceRootSpec { count: 8, ..SurfaceRootSpec::default() },
            ..WoodSpec::default()
        };
        add_surface_roots(&mut plant, &wood, obstacles, Seed::new(seed));
        plant
    }

    #[test]
    fn roots_lead_out_all_round_and_end_in_the_ground() {
        let plant = rooted(0.2, &Obstacles::none(), 1);
        assert_eq!(plant.validate().count(), 0);
        let roots: Vec<_> = plant.axes.iter().filter(|a| a.kind == AxisKind::Root).collect();
        assert!((9..16).contains(&roots.len()), "{} with their forks", roots.len());
        for root in &roots {
            let nodes: Vec<NodeId> = root.node_ids().collect();
            let at = |k: usize| plant.nodes.position[nodes[k].index()] - DVec3::Y;
            let r = |k: usize| plant.nodes.radius_m[nodes[k].index()];
            let last = nodes.len() - 1;
            assert!(at(last).y + r(last) < 0.0, "out of sight: {}", at(last));
            assert!(r(last) < 0.3 * r(0) && (0..last).all(|k| r(k + 1) <= r(k)), "tapers");
            assert!((0..=last).all(|k| at(k).y.abs() < 0.3), "on the ground");
            let reach = DVec3::new(at(last).x, 0.0, at(last).z).length();
            assert!((0.3..2.0).contains(&reach), "{reach}");
        }
        let ends: Vec<DVec3> = plant
            .axes
            .iter()
            .filter(|a| a.kind == AxisKind::Root)
            .map(|a| plant.nodes.position[a.nodes.end as usize - 1])
            .collect();
        for [x, z] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            assert!(ends.iter().any(|p| p.x * x > 0.0 && p.z * z > 0.0), "{x} {z}");
        }
        assert_ne!(plant, rooted(0.2, &Obstacles::none(), 2));
    }

    #[test]
    fn thin_stems_have_none_and_obstacles_keep_theirs_away() {
        let is_bare = |plant: &Plant| plant.axes.len() == 1;
        assert!(is_bare(&rooted(0.015, &Obstacles::none(), 1)));
        let longest = |plant: &Plant| {
            let far = |p: &DVec3| DVec3::new(p.x, 0.0, p.z).length();
            plant.nodes.position.iter().map(far).fold(0.0, f64::max)
        };
        for radius in [0.0201, 0.021, 0.03] {
            let thin = rooted(radius, &Obstacles::none(), 1);
            assert!(longest(&thin) < 9.0 * radius, "{radius}: {}", longest(&thin));
            assert!(thin.nodes.position.iter().all(|p| p.y > 0.8 && p.y <= 7.0), "{radius}");
        }
        // A thinner stem has shorter ones, also relative to its own size.
        let (thin, thick) = (rooted(0.05, &Obstacles::none(), 1), rooted(0.2, &Obstacles::none(), 1));
        assert!(!is_bare(&thin) && longest(&thin) / 0.05 < longest(&thick) / 0.2);
        let wall = Obstacle::Box { min: DVec3::new(0.4, 0.0, -9.0), max: DVec3::new(9.0, 3.0, 9.0) };
        let walled = rooted(0.2, &Obstacles::new(&[wall], 0.02).expect("sound"), 1);
        assert!(walled.axes.len() < thick.axes.len() && walled.axes.len() > 3);
        assert!(walled.nodes.position.iter().all(|p| p.x < 0.4));
    }
}
