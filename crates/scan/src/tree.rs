//! A cloud with one tree or several -> the plant of one tree.

use base::{Cancelled, Report, Run};
use geom::Voxels;
use glam::DVec3;
use mesh::PointClass;
use plant::{AxisKind, NodeId, Plant};

use crate::ScanTreeError;
use crate::foliage;
use crate::ground::Ground;
use crate::intervals::{Intervals, SeenNode};
use crate::levels::Rings;
use crate::radii::{Measured, Pipes, Smoothed, measure, smooth};
use crate::stems::{Site, Stems, Trunk};
use crate::surface::surface_places;
use crate::trunks::find_trunks;
use crate::wanted::{ScanPoints, ScanTally, TreeScanSpec};
use crate::ways::{NONE, Ways};

/// A tree found in a cloud.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundTree {
    /// Its wood; it stands at the origin.
    pub plant: Plant,
    /// Place of its foot in the cloud.
    pub foot: DVec3,
    /// The ground, if there is one.
    pub ground: Option<Ground>,
    /// Counts of the points.
    pub tally: ScanTally,
    /// Intervals of its figures.
    pub intervals: Intervals,
    /// Places of other detected trunks, x and z in the cloud.
    pub other_stems: Vec<[f64; 2]>,
}

/// Least number of points of a tree.
const FEWEST: usize = 200;
/// Least diameter of a circle that shows a radius, in cubes.
const RESOLVED: f64 = 1.0;
/// A pipe model with a greater exponent is of leaves.
const STEEP: f64 = 3.0;
/// Greatest height of a tree, metres: the highest is 116.
const HIGHEST: f64 = 130.0;
/// Least height of a tree that a scanner resolves, metres; lower is a cloud in metres that was read as millimetres.
const LOWEST: f64 = 0.15;
/// A cloud wider than this in metres, with fewer points per square metre than this and without a trunk, was scanned
/// from the air.
const AIRBORNE: (f64, f64) = (15.0, 500.0);
/// If this share of a tree lies beyond a gap, gaps up to this share of its height, and up to this length in metres,
/// are bridged.
const LOOSE: (f64, f64, f64) = (0.3, 0.15, 2.0);

/// Finds a tree in a cloud: removes the ground, noise and other things, derives the skeleton from paths from the
/// foot, and the radii from circles and the pipe model.
///
/// Guaranteed: a plant without faults, radii that fall along every axis and are at most those of the bearer; the same
/// bits for any executor. Not guaranteed: twigs that are thinner than the spacing of the points. Cost: n log n; 5
/// million points take some tens of seconds.
///
/// # Errors
/// [`ScanTreeError`].
pub fn find_tree<'a>(
    points: impl Into<ScanPoints<'a>>,
    spec: &TreeScanSpec,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<FoundTree, ScanTreeError> {
    Scene::read(points.into(), run, report)?.tree(spec, run, report)
}

/// Things on the ground.
pub(crate) struct Scene {
    /// The points above the ground.
    pub(crate) above: Vec<DVec3>,
    /// Their classes in the file; empty, or one for each point.
    pub(crate) classes: Vec<PointClass>,
    pub(crate) ground: Option<Ground>,
    /// Height of the highest point over the ground, ignoring strays, metres.
    pub(crate) height: f64,
    /// Number of usable points, including the ground.
    pub(crate) points: usize,
}

impl Scene {
    /// Takes the ground away.
    pub(crate) fn read(
        points: ScanPoints<'_>,
        run: &Run<'_>,
        report: &mut Report,
    ) -> Result<Self, ScanTreeError> {
        let is_usable = |p: &DVec3| p.abs().max_element() <= 1e9;
        let all: Vec<DVec3> = points.places.iter().copied().filter(is_usable).collect();
        let rows = points.places.iter().zip(points.classes);
        let mut classes: Vec<PointClass> = rows.filter(|(p, _)| is_usable(p)).map(|(_, c)| *c).collect();
        if points.classes.len() != points.places.len() {
            classes.clear();
        }
        if all.len() < FEWEST {
            return Err(ScanTreeError::TooFew(all.len(), FEWEST));
        }
        run.cancel.check()?;
        let ground = ground_of(&all, &classes);
        run.cancel.check()?;
        let (low, high) =
            all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.y), b.max(p.y)));
        if high - low < LOWEST {
            return Err(ScanTreeError::TooSmall(high - low));
        }
        let Above { points: above, classes: above_classes, height } =
            Above::select(&all, &classes, ground.as_ref());
        if height > HIGHEST {
            return Err(ScanTreeError::TooLarge(height));
        }
        if above.len() < FEWEST {
            return Err(ScanTreeError::TooFew(above.len(), FEWEST));
        }
        warn_of_ground(&all, ground.as_ref(), report);
        tell_classes(&classes, report);
        Ok(Self { points: all.len(), above, classes: above_classes, ground, height })
    }

    /// One tree's own points, over a ground that is known.
    pub(crate) fn from_tree(
        above: Vec<DVec3>,
        classes: Vec<PointClass>,
        ground: Option<Ground>,
    ) -> Result<Self, ScanTreeError> {
        if above.len() < FEWEST {
            return Err(ScanTreeError::TooFew(above.len(), FEWEST));
        }
        let lowest = above.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let over = |p: &DVec3| p.y - ground.as_ref().map_or(lowest, |g| g.height(*p));
        let height = highest(above.iter().map(over), above.len());
        Ok(Self { points: above.len(), above, classes, ground, height })
    }

    /// Returns the occupied cubes of the things on the ground.
    pub(crate) fn ways(&self, cell_m: Option<f64>, run: &Run<'_>) -> Result<Ways, Cancelled> {
        run.cancel.check()?;
        let cell = match cell_m {
            Some(cell) => cell,
            None => cell_of(&self.above, self.height, run)?,
        };
        Ok(Ways::new(&self.above, cell))
    }

    pub(crate) fn site(&self, ways: &Ways) -> Site<'_> {
        Site::new(&self.above, self.ground.as_ref(), self.height, ways.voxels.cell())
    }

    /// Fails if this is a scan from the air.
    pub(crate) fn check_stems(&self, trunks: &[Trunk]) -> Result<(), ScanTreeError> {
        let (low, high) =
            self.above.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
        let size = high - low;
        let density = self.above.len() as f64 / (size.x * size.z);
        let wide = size.x.min(size.z);
        if trunks.is_empty() && wide > AIRBORNE.0 && density < AIRBORNE.1 {
            return Err(ScanTreeError::Airborne(density, wide));
        }
        Ok(())
    }

    /// Finds its tree, or the requested one.
    pub(crate) fn tree(
        self,
        spec: &TreeScanSpec,
        run: &Run<'_>,
        report: &mut Report,
    ) -> Result<FoundTree, ScanTreeError> {
        let mut tally =
            ScanTally { points: self.points, ground: self.points - self.above.len(), ..ScanTally::default() };
        let mut ways = self.ways(spec.cell_m, run)?;
        tally.cell_m = ways.voxels.cell();
        run.cancel.check()?;
        let site = self.site(&ways);
        let trunks = find_trunks(&self.above, &ways, &site, spec.noise_m, run.cancel)?;
        if spec.at.is_none() {
            self.check_stems(&trunks)?;
        }
        tally.stems = trunks.len();
        let stems = Stems::find(&ways, &site, spec, &trunks, run.cancel)?;
        self.claim(&stems, &mut ways, spec, &mut tally, (run, report))?;
        let mine = |c: usize| ways.plant[c] == 0 && ways.way[c].is_finite();
        tally.scattered = foliage::scattered(&ways, mine, run.cancel)?;
        let mut woody = foliage::labelled_wood(&ways, &self.classes, mine);
        if woody.is_none() && tally.scattered > foliage::SCATTERED {
            woody = Some(foliage::wood(&ways, mine, run.cancel)?);
        }
        let in_leaf = woody.as_ref().is_some_and(|wood| (0..ways.len()).any(|c| mine(c) && !wood[c]));
        let is_wood = |c: usize| mine(c) && woody.as_ref().is_none_or(|w| w[c]);
        let is_leaf = |c: usize| mine(c) && !is_wood(c);
        tally.leaves = (0..ways.len()).filter(|&c| is_leaf(c)).map(|c| ways.voxels.rows(c).len()).sum();
        run.cancel.check()?;
        warn_of_leaves(in_leaf, &tally, report);
        let mut rings = Rings::new(&ways, 2.5 * ways.voxels.cell(), is_wood, run.cancel)?;
        run.cancel.check()?;
        rings.prune(3.0);
        tally.rings = rings.rings.iter().filter(|r| r.alive).count();
        let axes = rings.axes();
        let mut found = measure(&self.above, &ways, &rings, &axes, spec.noise_m, run)?;
        centre(&mut rings, &axes, &found);
        // Sections along the new centres are more accurate.
        found = measure(&self.above, &ways, &rings, &axes, spec.noise_m, run)?;
        centre(&mut rings, &axes, &found);
        tally.circles = found.iter().flatten().flatten().count();
        for ring in rings.rings.iter().filter(|r| r.alive) {
            tally.wood += ring.cubes.iter().map(|&c| ways.voxels.rows(c as usize).len()).sum::<usize>();
        }
        run.cancel.check()?;
        let foot = stems.foot(&site, &rings);
        let Wood { plant, pipes, nodes } = wood(&self.above, &ways, &rings, &axes, &found, foot, in_leaf);
        (tally.pipe_exponent, tally.pipe_scatter) = (1.0 / pipes.b, pipes.scatter);
        (tally.pipe_source, tally.pipe_circles) = (pipes.source, pipes.count);
        warn_of_pipes(in_leaf, &tally, report);
        explain(&mut tally, (&plant, foot), (&ways, &site), is_leaf);
        debug_assert_eq!(plant.validate().next(), None, "a found tree is sound");
        let intervals = Intervals::new(&plant, &nodes, &tally, in_leaf);
        let apart = |t: &&Trunk| (t.middle - foot).with_y(0.0).length() > t.radius + 1.0;
        let other_stems = trunks.iter().filter(apart).map(|t| [t.middle.x, t.middle.z]).collect();
        Ok(FoundTree { plant, foot, ground: self.ground, tally, intervals, other_stems })
    }

    /// Assigns the cubes to the things on the ground; a crown that lies beyond a gap belongs to the stem below it.
    fn claim(
        &self,
        stems: &Stems,
        ways: &mut Ways,
        spec: &TreeScanSpec,
        tally: &mut ScanTally,
        (run, report): (&Run<'_>, &mut Report),
    ) -> Result<(), Cancelled> {
        let site = self.site(ways);
        let cell = ways.voxels.cell();
        let usual = spec
            .gap_m
            .unwrap_or((0.04 * self.height).clamp(0.02 * self.height.min(5.0), 0.6))
            .max(4.0 * cell);
        let bridges = stems.claim(&site, ways, usual, run.cancel)?;
        tally.bridges = bridges.count;
        run.cancel.check()?;
        let [tree, loose] = stems.loose(ways);
        let (share, by_height, most) = LOOSE;
        let wide = (by_height * self.height).min(most);
        if spec.gap_m.is_none() && loose as f64 > share * (tree + loose) as f64 && wide > usual {
            let over = stems.reach_over(ways, (usual, wide), run.cancel)?;
            let [_, left] = stems.loose(ways);
            tally.bridges += over.count;
            if over.longest > usual && left < loose {
                tally.wide_gap_m = Some(over.longest);
                let gap_m = (over.longest * 100.0).round() / 100.0;
                let percent = (100.0 * (loose - left) as f64 / (tree + loose) as f64).round();
                base::warn!(
                    report,
                    "scan-gap",
                    { percent = percent, gap_m = gap_m },
                    "{percent} % of the points lay beyond a gap, which was bridged ({gap_m} m): check that what is on both \
                     sides of it is one tree, or say which gaps may be bridged"
                );
            }
        }
        tally.loose = stems.loose(ways)[1];
        tally.next_gap_m = if tally.loose > 0 { stems.next_gap(ways) } else { None };
        run.cancel.check()?;
        stems.tell(ways, report, tally);
        Ok(())
    }
}

fn warn_of_leaves(in_leaf: bool, tally: &ScanTally, report: &mut Report) {
    if in_leaf {
        base::warn!(
            report,
            "scan-in-leaf",
            { points = tally.leaves },
            "the tree is in leaf: {points} points were taken for leaves and left out. Radii of twigs come from those of \
             the wood that was seen; a scan without leaves is truer"
        );
    }
}

fn warn_of_pipes(in_leaf: bool, tally: &ScanTally, report: &mut Report) {
    let exponent = tally.pipe_exponent;
    if in_leaf && exponent > STEEP {
        base::warn!(
            report,
            "scan-radii-unsure",
            { exponent = exponent },
            "too little wood is seen among the leaves: radii and volume of branches are not to be trusted (pipe model \
             {exponent:.1}, trees have 1.5 to 3); scan the tree without leaves"
        );
    }
}

/// Most cubes that are compared with the wood.
const COMPARED: usize = 30_000;

/// Computes the share of the points that the wood and the leaves explain, in total and for each tenth of the height.
fn explain(
    tally: &mut ScanTally,
    (plant, foot): (&Plant, DVec3),
    (ways, site): (&Ways, &Site<'_>),
    is_leaf: impl Fn(usize) -> bool,
) {
    let cell = ways.voxels.cell();
    let near = (2.5 * cell).max(0.05);
    let places = surface_places(plant, near);
    let wood = geom::KdTree::new(&places);
    let is_mine = |c: &usize| matches!(ways.plant[*c], 0 | NONE);
    let mine: Vec<usize> = (0..ways.len()).filter(is_mine).collect();
    let (mut seen, mut explained) = ([0.0; 10], [0.0; 10]);
    tally.top_m = mine.iter().map(|&c| site.over(ways.means[c])).fold(0.0, f64::max);
    for &c in mine.iter().step_by(mine.len() / COMPARED + 1) {
        let share = site.over(ways.means[c]) / tally.top_m.max(1e-9);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 9")]
        let tenth = (10.0 * share).clamp(0.0, 9.0) as usize;
        let points = ways.voxels.rows(c).len() as f64;
        seen[tenth] += points;
        if is_leaf(c) || wood.nearest(ways.means[c] - foot, 1.5 * near).is_some() {
            explained[tenth] += points;
        }
    }
    let all: f64 = seen.iter().sum();
    tally.explained = if all > 0.0 { explained.iter().sum::<f64>() / all } else { 0.0 };
    for (to, (seen, explained)) in tally.coverage.iter_mut().zip(seen.iter().zip(explained)) {
        *to = (*seen > 0.0).then(|| explained / seen);
    }
}

/// Least points of a class of ground that show it.
const FEWEST_OF_GROUND: usize = 200;

/// The ground through what the file says is ground, or else through the lowest points.
fn ground_of(all: &[DVec3], classes: &[PointClass]) -> Option<Ground> {
    let said = all.iter().zip(classes).filter(|(_, class)| **class == PointClass::Ground);
    let said: Vec<DVec3> = said.map(|(p, _)| *p).collect();
    let known = if said.len() < FEWEST_OF_GROUND { None } else { Ground::find(&said) };
    known.or_else(|| Ground::find(all))
}

fn tell_classes(classes: &[PointClass], report: &mut Report) {
    let count = |class| classes.iter().filter(|c| **c == class).count();
    let [ground, wood, leaves] = [PointClass::Ground, PointClass::Wood, PointClass::Leaf].map(count);
    if ground + wood + leaves > 0 {
        base::warn!(
            report,
            "scan-classes",
            { ground = ground, wood = wood, leaves = leaves },
            "the classes of the file were taken as they are: {ground} points of ground, {wood} of wood, {leaves} of leaves"
        );
    }
}

/// Points that stand on the ground.
struct Above {
    points: Vec<DVec3>,
    classes: Vec<PointClass>,
    /// Height above the ground, metres; one point in a thousand above it may be noise.
    height: f64,
}

impl Above {
    fn select(all: &[DVec3], classes: &[PointClass], ground: Option<&Ground>) -> Self {
        let lowest = all.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let over = |p: &DVec3| p.y - ground.map_or(lowest, |g| g.height(*p));
        let thick = ground.map_or(f64::NEG_INFINITY, |g| g.thickness_m.max(0.02));
        let class = |i: usize| classes.get(i).copied().unwrap_or_default();
        let is_above = |i: &usize| over(&all[*i]) > thick && class(*i) != PointClass::Ground;
        let (mut points, mut kept) = (Vec::with_capacity(all.len()), vec![]);
        for i in (0..all.len()).filter(is_above) {
            points.push(all[i]);
            kept.extend(classes.get(i));
        }
        let height = highest(points.iter().map(over), points.len());
        Self { points, classes: kept, height }
    }
}

/// Returns the greatest of `count` heights: one in a thousand may be noise.
fn highest(heights: impl Iterator<Item = f64>, count: usize) -> f64 {
    let mut few: Vec<f64> = heights.step_by(count / 100_000 + 1).collect();
    base::sort_numbers(&mut few);
    let top = few.len().saturating_sub(1 + few.len() / 1000);
    few.get(top).copied().unwrap_or(0.0)
}

/// Returns the edge of cubes that have three points or more on average, as far as the size of the tree allows.
fn cell_of(points: &[DVec3], height: f64, run: &Run<'_>) -> Result<f64, Cancelled> {
    let mut cell = height / 1200.0;
    while cell < height / 150.0 {
        run.cancel.check()?;
        let v = Voxels::with_cell(points, cell);
        if points.len() as f64 >= 3.0 * v.len() as f64 && v.len() < 3_000_000 {
            break;
        }
        cell *= 1.25;
    }
    Ok(cell)
}

/// Rotation that brings another axis up.
type Turn = fn(DVec3) -> DVec3;

fn warn_of_ground(all: &[DVec3], ground: Option<&Ground>, report: &mut Report) {
    if ground.is_some() {
        return;
    }
    // A sample is enough to see whether the scan lies on its side.
    let few: Vec<DVec3> = all.iter().copied().step_by(all.len() / 200_000 + 1).collect();
    let ways: [(&str, Turn); 5] = [
        ("+Z", |p| DVec3::new(p.x, p.z, -p.y)),
        ("-Z", |p| DVec3::new(p.x, -p.z, p.y)),
        ("-Y", |p| DVec3::new(p.x, -p.y, -p.z)),
        ("+X", |p| DVec3::new(-p.y, p.x, p.z)),
        ("-X", |p| DVec3::new(p.y, -p.x, p.z)),
    ];
    for (name, turn) in ways {
        let turned: Vec<DVec3> = few.iter().copied().map(turn).collect();
        if Ground::find(&turned).is_some() {
            base::warn!(
                report,
                "scan-lies-down",
                { up = name },
                "no ground lies across the up axis, but one does across {name} (with +Y up): the scan may lie down or be \
                 upside down; check which axis points up"
            );
            return;
        }
    }
    report.warn(
        "scan-no-ground",
        "no ground was found below the tree: its lowest points were taken for its foot, so heights and the diameter at \
         1.3 m count from there",
    );
}

/// Moves the centres of rings to those of their circles, if these are sound.
fn centre(rings: &mut Rings, axes: &[(u32, Vec<u32>)], found: &[Vec<Option<Measured>>]) {
    for ((_, run), found) in axes.iter().zip(found) {
        for (&k, m) in run.iter().zip(found) {
            let ring = &mut rings.rings[k as usize];
            let Some(m) = m.filter(|m| m.error < 0.25) else { continue };
            let limit = 1.5 * ring.spread.max(m.radius.min(2.0 * ring.spread));
            if m.middle.distance(ring.middle) < limit {
                ring.middle = m.middle;
            }
        }
    }
}

/// Axes with radii, and the accuracy of the radius of each node.
struct Wood {
    plant: Plant,
    pipes: Pipes,
    nodes: Vec<SeenNode>,
}

/// Builds axes with radii.
fn wood(
    points: &[DVec3],
    ways: &Ways,
    rings: &Rings,
    axes: &[(u32, Vec<u32>)],
    found: &[Vec<Option<Measured>>],
    foot: DVec3,
    in_leaf: bool,
) -> Wood {
    let load = |k: u32| rings.rings[k as usize].load;
    let rows: Vec<(f64, Measured)> = axes
        .iter()
        .zip(found)
        .flat_map(|((_, run), found)| run.iter().zip(found))
        .filter_map(|(&k, m)| Some((load(k), (*m)?)))
        .collect();
    let least = RESOLVED * ways.voxels.cell();
    let (pipes, from) = Pipes::fit(&rows, least);
    let mut plant = Plant::default();
    let mut nodes: Vec<SeenNode> = vec![];
    // For each ring: its node, radius and offset from the pipe model.
    let mut node_of: Vec<Option<NodeId>> = vec![None; rings.rings.len()];
    let mut offset_of = vec![0.0; rings.rings.len()];
    for (key, ((bearer, run), found)) in (0_u64..).zip(axes.iter().zip(found)) {
        let loads: Vec<f64> = run.iter().map(|&k| load(k)).collect();
        let below = (*bearer != NONE).then(|| offset_of[*bearer as usize]);
        let mut found = found.clone();
        if let Some(below) = Some(*bearer).filter(|b| *b != NONE) {
            hide(&mut found, run, rings, &plant, node_of[below as usize]);
        }
        for (m, &k) in found.iter_mut().zip(run) {
            let thin = load(k) < from || (!in_leaf && m.is_some_and(|m| m.radius < least));
            *m = m.filter(|_| !thin);
        }
        let Smoothed { radii, offsets, errors } = smooth(&loads, &found, &pipes, below, 0.06);
        run.iter().zip(&offsets).for_each(|(&k, &o)| offset_of[k as usize] = o);
        let course = course(points, ways, rings, run);
        let bearer = (*bearer != NONE).then(|| node_of[*bearer as usize]).flatten();
        let (mut line, mut thick) = (course, radii);
        match bearer {
            Some(node) => {
                let most = plant.nodes.radius_m[node.index()];
                thick.iter_mut().for_each(|r| *r = r.min(most));
                line.insert(0, plant.nodes.position[node.index()]);
                thick.insert(0, thick[0]);
            }
            None => {
                // The axis continues down to the ground, below the first ring.
                let first = line[0] - foot;
                line.iter_mut().for_each(|p| *p -= foot);
                if first.y > 1e-3 {
                    line.insert(0, DVec3::new(first.x, 0.0, first.z));
                    thick.insert(0, thick[0]);
                }
            }
        }
        if bearer.is_some() {
            line[1..].iter_mut().for_each(|p| *p -= foot);
        }
        // The tip is one more node than there are rings.
        while thick.len() < line.len() {
            let last = thick[thick.len() - 1];
            thick.push(0.7 * last);
        }
        if line.len() < 2 {
            continue;
        }
        let axis = plant.add_axis(AxisKind::Branch, bearer, key, &line, None);
        let rows = plant.axis(axis).nodes.clone();
        let start = rows.start as usize;
        plant.nodes.radius_m[start..rows.end as usize].copy_from_slice(&thick[..line.len()]);
        let first = line.len() - run.len() - 1;
        let row_of = |i: usize| i.saturating_sub(first).min(run.len() - 1);
        nodes.extend(
            (0..line.len()).map(row_of).map(|i| SeenNode { error: errors[i], is_seen: found[i].is_some() }),
        );
        for (i, &k) in run.iter().enumerate() {
            node_of[k as usize] = Some(NodeId::new(start + first + i));
        }
    }
    Wood { plant, pipes, nodes }
}

/// Removes the circles within the wood that bears an axis: they are the bearer's.
fn hide(found: &mut [Option<Measured>], run: &[u32], rings: &Rings, plant: &Plant, bearer: Option<NodeId>) {
    let Some(bearer) = bearer else { return };
    let radius = plant.nodes.radius_m[bearer.index()];
    let from = rings.rings[rings.rings[run[0] as usize].below as usize].middle;
    for (m, &k) in found.iter_mut().zip(run) {
        let near = rings.rings[k as usize].middle.distance(from) < 1.3 * radius + rings.band;
        if near || m.is_some_and(|m| m.radius > 1.05 * radius) {
            *m = None;
        }
    }
}

/// Returns the centres along an axis, slightly smoothed, and its tip.
fn course(points: &[DVec3], ways: &Ways, rings: &Rings, run: &[u32]) -> Vec<DVec3> {
    let raw: Vec<DVec3> = run.iter().map(|&k| rings.rings[k as usize].middle).collect();
    let mut line = raw.clone();
    for i in 1..raw.len().saturating_sub(1) {
        line[i] = (raw[i - 1] + raw[i] * 2.0 + raw[i + 1]) * 0.25;
    }
    let last = run[run.len() - 1];
    let end = raw[raw.len() - 1];
    let before = if raw.len() > 1 {
        raw[raw.len().saturating_sub(4)]
    } else {
        let below = rings.rings[last as usize].below;
        if below == NONE { end - DVec3::Y } else { rings.rings[below as usize].middle }
    };
    let along = (end - before).normalize_or(DVec3::Y);
    // The farthest point of the last ring along the axis, ignoring strays.
    let mut ahead: Vec<f64> = rings.rings[last as usize]
        .cubes
        .iter()
        .flat_map(|&c| ways.voxels.rows(c as usize))
        .map(|&p| (points[p as usize] - end).dot(along))
        .collect();
    base::sort_numbers(&mut ahead);
    let reach = ahead[ahead.len() - 1 - ahead.len() / 20].max(0.25 * rings.band);
    line.push(end + along * reach);
    line
}
