//! Leaves on thin shoots, where light reaches them.
//!
//! `Plant + FoliageSpec -> candidates by phyllotaxis -> shadows -> the brightest` (Yang et al. 2019, section 3.3)

use base::ops::{self, PI};
use base::{Counted, Draw, Report, Run, Seed, map_indexed};
use glam::{DVec2, DVec3};
use plant::{AxisId, Blade, Frame, Lift, NodeId, Organ, OrganKind, Paint, Phyllotaxis, Plant, Relief, Shape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::self_organize::ShadowGrid;
use crate::{Arrangement, GrowthError, LeafMark, Obstacles};

/// Axes whose leaves are placed in one job.
const GROUP: usize = 64;

/// Settings of the leaves of a tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FoliageSpec {
    /// Arrangement around the shoot, default a golden spiral.
    pub arrangement: Arrangement,
    /// Distance between two nodes of a shoot, metres, above 0, default 0.06.
    #[schemars(range(min = 0.0001, max = 1000.0), extend("x-unit" = "m"))]
    pub spacing_m: f64,
    /// Concentration of leaves towards the tip of their shoot, 0 (evenly, the default) to 0.95: the nodes at its tip
    /// are `1 - gather` times as far from each other as [`spacing_m`](Self::spacing_m), those at its foot `1 + gather`
    /// times.
    #[schemars(range(min = 0.0, max = 0.95))]
    pub gather: f64,
    /// Length of a blade, metres, above 0, default 0.09.
    #[schemars(range(min = 0.0001, max = 100.0), extend("x-unit" = "m"))]
    pub length_m: f64,
    /// Width over length of the blade that [`blade`](Self::blade) makes, 0.01 to 3, default 0.5.
    #[schemars(range(min = 0.01, max = 3.0))]
    pub width: f64,
    /// Standard deviation of the length as a share of it, 0 to 0.5, default 0.1.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub size_variation: f64,
    /// Angle between shoot and blade, degrees, 0 to 180, default 55.
    #[schemars(range(min = 0.0, max = 180.0), extend("x-unit" = "deg"))]
    pub angle_deg: f64,
    /// Droop of the blades, -1 to 1 (all down), default 0.15.
    #[schemars(range(min = -1.0, max = 1.0))]
    pub droop: f64,
    /// Largest radius of shoots that bear leaves, metres; default 0.009: two of the usual tips.
    #[schemars(range(min = 0.0, max = 100.0), extend("x-unit" = "m"))]
    pub max_radius_m: f64,
    /// Share of the leaves kept, the best lit ones, 0 to 1; default 1. Many, suitable and few in Fig 11 of Yang et al.
    /// (2019).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub leaf_keep: f64,
    /// Light below which leaves fall in any case, 0 or more (full light is 1), default 0.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub min_light: f64,
    /// Contribution of a leaf to the shadow of its own voxel (k of Eq 5), above 0, default 0.03.
    #[schemars(range(min = 1e-6, max = 100.0))]
    pub shade: f64,
    /// Factor by which the shadow decreases from layer to layer (b of Eq 5), above 1, default 1.8.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub shade_fall: f64,
    /// Layers below a leaf that it shades, 1 to 32, default 6.
    #[schemars(range(min = 1, max = 32))]
    pub shade_layers: u32,
    /// Side of a voxel, metres; default two blade lengths.
    #[schemars(range(min = 0.001, max = 1000.0), extend("x-unit" = "m"))]
    pub voxel_m: Option<f64>,
    /// Whether a leaf is shaded by its own shadow, as in the paper (Palubicki adds it back). Default false.
    pub self_shadow: bool,
    /// Most leaves that are considered, default 2 million.
    pub max_leaves: u32,
}

spec::schemas!(FoliageSpec => crate::TreeSpec, "/$defs/FoliageSpec");

impl Default for FoliageSpec {
    fn default() -> Self {
        Self {
            arrangement: Arrangement::default(),
            spacing_m: 0.06,
            gather: 0.0,
            length_m: 0.09,
            width: 0.5,
            size_variation: 0.1,
            angle_deg: 55.0,
            droop: 0.15,
            max_radius_m: 0.009,
            leaf_keep: 1.0,
            min_light: 0.0,
            shade: 0.03,
            shade_fall: 1.8,
            shade_layers: 6,
            voxel_m: None,
            self_shadow: false,
            max_leaves: 2_000_000,
        }
    }
}

impl FoliageSpec {
    /// Returns a plain blade of length 1: broadest in the middle, slightly folded and bent.
    pub fn blade(&self) -> Blade {
        let half = 0.5 * if self.width.is_finite() { self.width.clamp(0.01, 3.0) } else { 0.5 };
        let right: Vec<DVec2> = (1..8)
            .map(|i| {
                let v = f64::from(i) / 8.0;
                DVec2::new(half * ops::powf(ops::sin(PI * ops::powf(v, 0.85)), 0.9), v)
            })
            .collect();
        let mut outline = vec![DVec2::ZERO];
        outline.extend_from_slice(&right);
        outline.push(DVec2::Y);
        outline.extend(right.iter().rev().map(|p| DVec2::new(-p.x, p.y)));
        let midrib = (0..=4).map(|i| DVec2::new(0.0, f64::from(i) / 4.0)).collect();
        let relief = Relief { bend_a: 0.05, bend_b: 0.12, fold: 0.2, ..Relief::default() };
        Blade { outline, midrib, veins: Vec::new(), needles: None, lift: Lift::Flat, relief }
    }

    fn check(&self) -> Result<Phyllotaxis, GrowthError> {
        spec::check(self)?;
        self.arrangement.phyllotaxis()
    }
}

/// Counts of present and removed leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeafCount {
    /// Places for leaves by phyllotaxis.
    pub placed: usize,
    /// Places among these in an obstacle, which are left out.
    pub buried: usize,
    /// Leaves that fell for lack of light, or are absent in this season.
    pub fallen: usize,
    /// Leaves on the plant.
    pub kept: usize,
}

/// A possible leaf.
struct Candidate {
    bearer: NodeId,
    at: DVec3,
    /// Direction from root to tip, before it is made a frame; direction of the upper side.
    along: DVec3,
    towards: DVec3,
    scale: f64,
    key: u64,
}

impl Candidate {
    /// As in [`Frame::looking`]: most candidates fall before they need the rest of the frame.
    fn tip(&self, share: f64, length: f64) -> DVec3 {
        self.at + self.along.try_normalize().unwrap_or(DVec3::Y) * (share * self.scale * length)
    }

    fn frame(&self) -> Frame {
        Frame::looking(self.at, self.along, self.towards)
    }
}

/// Adds leaves to the thin shoots of a plant, or at `marks` if there are any, and removes the shaded ones.
///
/// `blade`: any blade; it is scaled to the length of the spec. Guaranteed: a clean `validate()`; no corner of a leaf in
/// an obstacle; for the same tree, a smaller `leaf_keep` keeps a part of the leaves that a larger one keeps. Cost:
/// linear in places for leaves, times the square of `shade_layers`.
///
/// # Errors
/// [`GrowthError::Range`], [`GrowthError::Cancelled`].
///
/// ```
/// use base::{Report, Run, Seed};
/// use glam::DVec3;
/// use growth::{FoliageSpec, Obstacles, add_leaves};
/// use plant::{AxisKind, Plant};
/// let mut plant = Plant::default();
/// plant.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y], None);
/// let spec = FoliageSpec { leaf_keep: 0.5, ..FoliageSpec::default() };
/// let (run, none) = (Run::plain(), Obstacles::none());
/// let n = add_leaves(&mut plant, &spec, spec.blade(), &[], &none, Seed::new(1), &run, &mut Report::default())?;
/// assert_eq!((n.placed, n.kept, plant.organs.len()), (17, 9, 9));
/// # Ok::<(), growth::GrowthError>(())
/// ```
#[expect(clippy::too_many_arguments, reason = "what, where, around what, and how; all are different things")]
pub fn add_leaves(
    plant: &mut Plant,
    spec: &FoliageSpec,
    blade: Blade,
    marks: &[(NodeId, LeafMark)],
    obstacles: &Obstacles,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<LeafCount, GrowthError> {
    let phyllotaxis = spec.check()?;
    let started = run.clock.now_ms();
    let mut all = Vec::new();
    // All measures are along the given blade.
    let length = blade.length();
    let scale = if length > 1e-9 && length.is_finite() { spec.length_m / length } else { spec.length_m };
    if marks.is_empty() {
        all = on_shoots(plant, spec, phyllotaxis, scale, seed, run)?;
    } else {
        let set = (marks.len() as u64).min(u64::from(spec.max_leaves));
        run.budget.check(Counted::Leaves, set, "lower leaves.max_leaves or let the rules set fewer")?;
        for (i, (node, mark)) in marks.iter().enumerate().take(spec.max_leaves as usize) {
            let key = seed.child(i as u64).number();
            let at = plant.nodes.position[node.index()];
            let size = if mark.scale.is_finite() { mark.scale.clamp(0.0, 1e3) } else { 1.0 };
            if size > 0.0 {
                let (along, towards, scale) = (mark.heading, mark.up, scale * size);
                all.push(Candidate { bearer: *node, at, along, towards, scale, key });
            }
        }
    }
    if all.len() >= spec.max_leaves as usize {
        base::warn!(
            report,
            "leaves-stopped",
            { most = spec.max_leaves },
            "no more than {most} places for leaves were considered"
        );
    }
    let placed = all.len();
    if !obstacles.is_empty() {
        let shape = Shape::Blade(blade.clone());
        let corners: Vec<_> = [1.0, plant::DRAWN_WIDER].into_iter().flat_map(|w| shape.corners(w)).collect();
        all.retain(|c| obstacles.admit(&c.frame(), c.scale, &corners));
    }
    let buried = placed - all.len();
    run.cancel.check()?;
    let light = light_of(&all, length, spec);
    let keeps = brightest(&all, &light, spec);
    let shape = (!all.is_empty()).then(|| plant.add_shape(Shape::Blade(blade)));
    let mut kept = 0;
    plant.organs.reserve(keeps.iter().filter(|k| **k).count());
    for (c, _) in all.iter().zip(&keeps).filter(|(_, k)| **k) {
        let Some(shape) = shape else { break };
        kept += 1;
        plant.organs.push(Organ {
            kind: OrganKind::Leaf,
            bearer: Some(c.bearer),
            flower: None,
            shape,
            frame: c.frame(),
            scale: c.scale,
            paint: Paint::default(),
            key: c.key,
            source: None,
        });
    }
    report.book("leaves", run.clock.now_ms() - started);
    Ok(LeafCount { placed, buried, fallen: all.len() - kept, kept })
}

/// Returns the places on all axes, in their order; several axes are processed at a time.
fn on_shoots(
    plant: &Plant,
    spec: &FoliageSpec,
    phyllotaxis: Phyllotaxis,
    scale: f64,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Vec<Candidate>, GrowthError> {
    let most = spec.max_leaves as usize;
    let rooms: Vec<usize> =
        (0..plant.axes.len()).map(|a| room(plant, AxisId::new(a), spec, phyllotaxis).min(most)).collect();
    let longest = rooms.iter().copied().max().unwrap_or(0) as u64;
    run.budget.check(
        Counted::Course,
        longest,
        "make leaves.spacing_m longer or shoots shorter (or bare = true for no leaves)",
    )?;
    let places = rooms.iter().fold(0, |sum: usize, &n| most.min(sum.saturating_add(n)));
    run.budget.check(
        Counted::Leaves,
        places as u64,
        "make leaves.spacing_m longer, or lower leaves.max_radius_m or leaves.max_leaves",
    )?;
    let mut all = Vec::with_capacity(places);
    let mut from = 0;
    // Seldom more than one round: each takes as many axes as have room for the largest number of leaves.
    while from < rooms.len() && all.len() < most {
        let mut taken = 0;
        let fit = rooms[from..].iter().take_while(|&&n| {
            taken += n;
            taken <= most
        });
        let to = from + fit.count().max(1);
        let groups = map_indexed(run.executor, (to - from).div_ceil(GROUP), |g| {
            run.cancel.check()?;
            let axes = from + g * GROUP..to.min(from + (g + 1) * GROUP);
            let mut places = Vec::with_capacity(rooms[axes.clone()].iter().sum());
            for a in axes {
                on_axis(plant, AxisId::new(a), spec, phyllotaxis, scale, seed, &mut places);
            }
            Ok::<_, GrowthError>(places)
        });
        for group in groups {
            all.append(&mut group?);
        }
        from = to;
    }
    all.truncate(most);
    Ok(all)
}

/// Returns the length of an axis that is thin enough for leaves, or slightly more.
fn leafy(plant: &Plant, id: AxisId, spec: &FoliageSpec) -> f64 {
    let (points, radii) = (plant.axis_points(id), plant.axis_radii(id));
    let pieces = points.windows(2).zip(radii.windows(2));
    let thin = pieces.filter(|(_, r)| r[0].min(r[1]) <= spec.max_radius_m);
    thin.map(|(p, _)| p[0].distance(p[1])).sum()
}

/// Returns an upper bound of the number of places on an axis.
fn room(plant: &Plant, id: AxisId, spec: &FoliageSpec, phyllotaxis: Phyllotaxis) -> usize {
    let g = spec.gather;
    let more = if g > 0.0 { ops::ln((1.0 + g) / (1.0 - g)) / (2.0 * g) } else { 1.0 };
    let nodes = leafy(plant, id, spec) / spec.spacing_m * more;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is bounded")]
    let room = ((nodes + 1.0) * f64::from(phyllotaxis.per_node())) as usize;
    room
}

/// Distance from a node to the next one down the shoot.
///
/// `d(k)`, the node's distance from the tip, solves `dd/dk = spacing (1 - gather + 2 gather d / length)`.
struct Internodes {
    growth: f64,
    first: f64,
}

impl Internodes {
    fn new(spec: &FoliageSpec, length: f64) -> Self {
        if spec.gather <= 0.0 || length <= 0.0 {
            return Self { growth: 0.0, first: spec.spacing_m };
        }
        let twice = 2.0 * spec.gather;
        let growth = ops::exp(twice * spec.spacing_m / length) - 1.0;
        // A shoot shorter than an internode has one node, whatever the distance to the next.
        let growth = growth.min(1e6);
        Self { growth, first: growth * length * (1.0 - spec.gather) / twice }
    }

    fn after(&self, from_tip: f64) -> f64 {
        self.first + self.growth * from_tip
    }
}

/// Returns the places on the thin part of one axis, from its tip down, so that the tip always has its leaf.
fn on_axis(
    plant: &Plant,
    id: AxisId,
    spec: &FoliageSpec,
    phyllotaxis: Phyllotaxis,
    scale: f64,
    seed: Seed,
    places: &mut Vec<Candidate>,
) {
    let axis = plant.axis(id);
    let (points, radii) = (plant.axis_points(id), plant.axis_radii(id));
    let frames = geom::rotation_minimising_frames(points, None);
    let own = seed.child(axis.key);
    let offset = ops::TAU * own.stream(Draw::Phyllotaxis).uniform();
    let internodes = Internodes::new(spec, leafy(plant, id, spec));
    let (mut number, mut until_next, mut from_tip) = (0_u32, 0.0, 0.0);
    for i in (1..points.len()).rev() {
        let (from, to) = (points[i], points[i - 1]);
        let length = from.distance(to);
        // A bare base: a borne shoot has no leaf within its bearer's bark.
        let bare = if i == 1 && axis.bearer.is_some() { 0.5 * spec.spacing_m } else { 0.0 };
        while until_next <= length - bare {
            let t = if length > 0.0 { until_next / length } else { 0.0 };
            let radius = radii[i] + (radii[i - 1] - radii[i]) * t;
            if radius > spec.max_radius_m || places.len() >= spec.max_leaves as usize {
                return;
            }
            let frame = &frames[i];
            for (azimuth, k) in phyllotaxis.azimuths(number).zip(0_u64..) {
                let key = own.child(u64::from(number)).child(k);
                let around = azimuth + offset;
                let (s, c) = ops::sin_cos(around);
                let out = frame.normal * c + frame.binormal * s;
                let at = from + (to - from) * t + out * radius;
                let node = axis.nodes.start as usize + if t > 0.5 { i - 1 } else { i };
                places.push(leaf(spec, at, frame.tangent, out, scale, key, NodeId::new(node)));
            }
            number += 1;
            let next = internodes.after(from_tip);
            until_next += next;
            from_tip += next;
        }
        until_next -= length;
    }
}

fn leaf(
    spec: &FoliageSpec,
    at: DVec3,
    shoot: DVec3,
    out: DVec3,
    scale: f64,
    key: Seed,
    bearer: NodeId,
) -> Candidate {
    let mut stream = key.stream(Draw::LeafAngle);
    // 8 degrees: leaves of one shoot differ, but its phyllotaxis is still visible.
    let angle = (spec.angle_deg + 8.0 * stream.normal()) * (PI / 180.0);
    let (s, c) = ops::sin_cos(angle);
    let stands = shoot * c + out * s;
    let along = (stands * (1.0 - spec.droop.abs()) - DVec3::Y * spec.droop).normalize_or(stands);
    let size = 1.0 + spec.size_variation * key.stream(Draw::Size).normal().clamp(-2.5, 2.5);
    // The upper side faces the light; a blade that hangs straight down turns it outwards.
    let towards = DVec3::Y + out * 0.3;
    Candidate { bearer, at, along, towards, scale: scale * size.max(0.1), key: key.number() }
}

/// Computes Eq 6: Q = max(C - s, 0) with C = 1, and the leaf's own shadow added back unless the spec says otherwise.
fn light_of(all: &[Candidate], length: f64, spec: &FoliageSpec) -> Vec<f64> {
    let middles: Vec<DVec3> = all.iter().map(|c| c.tip(0.5, length)).collect();
    let all_round = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lo, hi) = middles.iter().fold(all_round, |(lo, hi), &p| (lo.min(p), hi.max(p)));
    if all.is_empty() {
        return Vec::new();
    }
    // A voxel much smaller than 1/200 of the tree makes a grid that no memory holds.
    let least = (hi - lo).max_element() / 200.0;
    let voxel = spec.voxel_m.unwrap_or(2.0 * spec.length_m).max(least);
    let mut grid = ShadowGrid::new(voxel, spec.shade, spec.shade_fall, spec.shade_layers);
    grid.cover(lo, hi, &mut []);
    let voxels: Vec<u32> = middles.iter().map(|&p| grid.voxel_of(p)).collect();
    grid.add_all(voxels.iter().copied(), 1);
    grid.spread();
    let own = if spec.self_shadow { 0.0 } else { grid.own() };
    // Not clamped to 0: in deep shade, too, one leaf has more light than another.
    voxels.iter().map(|&v| 1.0 - grid.shade(v) + own).collect()
}

/// Returns for each leaf whether it stays: enough light, and among the brightest; keys decide between equals.
fn brightest(all: &[Candidate], light: &[f64], spec: &FoliageSpec) -> Vec<bool> {
    let mut keeps = vec![false; all.len()];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length")]
    let wanted = (spec.leaf_keep * all.len() as f64).round() as usize;
    let mut rows: Vec<usize> = (0..all.len()).collect();
    let order = |a: &usize, b: &usize| {
        light[*b].total_cmp(&light[*a]).then(all[*a].key.cmp(&all[*b].key)).then(a.cmp(b))
    };
    if wanted < rows.len() && wanted > 0 {
        base::first_of(&mut rows, wanted, &mut |a, b| order(a, b));
    }
    for &r in rows.iter().take(wanted) {
        keeps[r] = light[r].max(0.0) >= spec.min_light;
    }
    keeps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CompetitionSpec, Obstacle, WoodSpec, compete, make_wood};

    fn bare() -> Plant {
        let run = Run::plain();
        let spec = CompetitionSpec { points: 800, kill_m: 0.25, ..CompetitionSpec::default() };
        let tree =
            compete(&[DVec3::ZERO], &Obstacles::none(), &spec, Seed::new(1), &run, &mut Report::default());
        make_wood(&tree.expect("sound").skeleton, &WoodSpec::default(), &Obstacles::none(), &run)
            .expect("sound")
            .plant
    }

    fn dressed(spec: &FoliageSpec, obstacles: &Obstacles) -> (Plant, LeafCount) {
        let mut plant = bare();
        let run = Run::plain();
        let count = add_leaves(
            &mut plant,
            spec,
            spec.blade(),
            &[],
            obstacles,
            Seed::new(1),
            &run,
            &mut Report::default(),
        )
        .expect("sound");
        assert_eq!(plant.validate().next(), None);
        assert_eq!(
            (count.kept, count.placed),
            (plant.organs.len(), count.kept + count.fallen + count.buried)
        );
        (plant, count)
    }

    #[test]
    fn fewer_leaves_are_a_part_of_many_and_the_bright_ones() {
        let none = Obstacles::none();
        let of = |leaf_keep: f64| dressed(&FoliageSpec { leaf_keep, ..FoliageSpec::default() }, &none);
        let ((many, all), (some, half), (few, tenth)) = (of(1.0), of(0.5), of(0.1));
        assert!(all.placed > 3000 && all.kept == all.placed, "{all:?}");
        assert!(half.kept.abs_diff(all.placed / 2) <= 1 && tenth.kept.abs_diff(all.placed / 10) <= 1);
        let keys = |p: &Plant| p.organs.iter().map(|o| o.key).collect::<std::collections::BTreeSet<_>>();
        assert!(keys(&few).is_subset(&keys(&some)) && keys(&some).is_subset(&keys(&many)));
        let height =
            |p: &Plant| p.organs.iter().map(|o| o.frame.origin.y).sum::<f64>() / p.organs.len() as f64;
        assert!(height(&few) > height(&many) + 0.3, "light comes from above");
    }

    #[test]
    fn leaves_follow_their_phyllotaxis() {
        let mut plant = Plant::default();
        let line = [DVec3::ZERO, DVec3::Y * 0.5, DVec3::Y];
        let axis = plant.add_axis(plant::AxisKind::Branch, None, 1, &line, None);
        assert_eq!(plant.axis_radii(axis), [0.0; 3]);
        let spec =
            FoliageSpec { arrangement: Arrangement::Decussate, spacing_m: 0.1, ..FoliageSpec::default() };
        let run = Run::plain();
        let none = Obstacles::none();
        let n = add_leaves(
            &mut plant,
            &spec,
            spec.blade(),
            &[],
            &none,
            Seed::new(1),
            &run,
            &mut Report::default(),
        );
        assert_eq!(n.map(|n| n.kept), Ok(22));
        let out = |i: usize| {
            let a = plant.organs[i].frame.along;
            DVec3::new(a.x, 0.0, a.z).normalize()
        };
        for i in 0..10 {
            assert!(out(2 * i).dot(out(2 * i + 1)) < -0.99, "pairs stand opposite");
            assert!(out(2 * i).dot(out(2 * i + 2)).abs() < 0.1, "each pair across the last");
        }
    }

    #[test]
    fn no_leaf_hangs_in_an_obstacle() {
        let rock = Obstacle::Sphere { centre: DVec3::new(0.8, 4.2, 0.0), radius_m: 0.9 };
        let obstacles = Obstacles::new(&[rock], 0.0).expect("sound");
        let (plant, count) = dressed(&FoliageSpec::default(), &obstacles);
        assert!(count.buried > 50, "{count:?}");
        for o in &plant.organs {
            for corner in plant.shapes[o.shape.index()].corners(1.0) {
                assert!(obstacles.inside(o.frame.place(corner, o.scale)).is_none());
            }
        }
    }

    #[test]
    fn dark_leaves_fall_by_threshold_too() {
        let spec = FoliageSpec { min_light: 0.8, ..FoliageSpec::default() };
        let (_, count) = dressed(&spec, &Obstacles::none());
        assert!(count.fallen > 100 && count.kept > 100, "{count:?}");
        let mut plant = bare();
        let bad = FoliageSpec { leaf_keep: 1.5, ..FoliageSpec::default() };
        let run = Run::plain();
        let none = Obstacles::none();
        let got =
            add_leaves(&mut plant, &bad, bad.blade(), &[], &none, Seed::new(1), &run, &mut Report::default());
        assert_eq!(got.map_err(|e| e.to_string()), Err("leaf_keep must be 0 to 1, not 1.5".into()));
    }
}
