//! A cloud of many trees -> its stems, each with its own points.

use base::{Cancelled, Draw, Report, Run, Seed, ops};
use glam::DVec3;
use mesh::PointClass;

use crate::ScanTreeError;
use crate::circle::fit_circle;
use crate::ground::Ground;
use crate::stems::{Site, Trunk};
use crate::tree::{FoundTree, Scene};
use crate::trunks::find_trunks;
use crate::wanted::{ScanPoints, TreeScanSpec};
use crate::ways::{NONE, Ways};

/// A tree of a plot, before its wood is searched.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotTree {
    /// Place of its trunk near the ground, x and z in the cloud.
    pub place: [f64; 2],
    /// Radius of its trunk, metres.
    pub radius_m: f64,
    /// Height of its highest point over the ground, metres.
    pub height_m: f64,
    /// Number of its points.
    pub points: usize,
    /// Its crown ends at the edge of the cloud: some of it is missing.
    pub is_cut: bool,
}

/// A plot with its points assigned to its trees.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Its trees, from west to east (by x, then z).
    pub trees: Vec<PlotTree>,
    /// The ground, if there is one.
    pub ground: Option<Ground>,
    /// Number of usable points, including the ground.
    pub points: usize,
    /// Number of points of the ground.
    pub ground_points: usize,
    /// Number of points of undergrowth, people and walls: things on the ground that are not trunks.
    pub others: usize,
    /// Number of points that are connected with nothing.
    pub loose: usize,
    above: Vec<DVec3>,
    /// Their classes in the file; empty, or one for each point.
    classes: Vec<PointClass>,
    /// The tree of each point above the ground; [`NONE`] for none.
    owner: Vec<u32>,
}

/// Undergrowth and other low things compete for cubes like a trunk of this radius, metres.
const UNDERGROWTH_M: f64 = 0.01;
/// Cubes nearer to a trunk at the ground, beyond its bark, belong to its foot, metres.
const FOOT_M: f64 = 0.25;
/// A crown is cut by the edge of the cloud if more than this share of its points lies nearer to the edge than this
/// distance in metres.
const CUT: (f64, f64) = (0.01, 0.15);

/// Finds the trees of a plot and assigns its points to them.
///
/// Trunks are followed upwards as far as they are round. Each cube goes to the trunk with the shortest relative path
/// through the cloud: paths are divided by the radius of the trunk to the power of 2/3, because crowns widen in this
/// proportion (comparative shortest paths; Tao et al. 2015, who measure the path to the foot, with which a branch
/// takes the top of a smaller tree that it touches). Things on the ground that are not trunks take what is connected
/// with them.
///
/// Guaranteed: each point has at most one tree; the same bits for any executor. Not guaranteed: trunks that are
/// hidden from 0.3 to 2.7 m. Cost: n log n.
///
/// # Errors
/// [`ScanTreeError`]; [`ScanTreeError::NoStem`] where no trunk is seen.
pub fn find_plot<'a>(
    points: impl Into<ScanPoints<'a>>,
    spec: &TreeScanSpec,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Plot, ScanTreeError> {
    let points = points.into();
    let scene = Scene::read(points, run, report)?;
    let mut ways = scene.ways(spec.cell_m, run)?;
    let site = scene.site(&ways);
    let mut trunks = find_trunks(&scene.above, &ways, &site, spec.noise_m, run.cancel)?;
    scene.check_stems(&trunks)?;
    if trunks.is_empty() {
        return Err(ScanTreeError::NoStem);
    }
    base::sort_by(&mut trunks, |a, b| {
        a.middle.x.total_cmp(&b.middle.x).then(a.middle.z.total_cmp(&b.middle.z))
    });
    let usual = (0.04 * scene.height).clamp(0.02 * scene.height.min(5.0), 0.6).max(4.0 * ways.voxels.cell());
    follow(&scene.above, &ways, &mut trunks, spec.noise_m, run)?;
    share(&mut ways, &site, &trunks, spec.gap_m.unwrap_or(usual), run)?;
    let edges = edges(points.places);
    let mut trees: Vec<PlotTree> = trunks
        .iter()
        .map(|t| PlotTree {
            place: [t.middle.x, t.middle.z],
            radius_m: t.radius,
            height_m: 0.0,
            points: 0,
            is_cut: false,
        })
        .collect();
    let (mut others, mut loose) = (0, 0);
    let mut owner = vec![NONE; scene.above.len()];
    let mut at_edge = vec![0_usize; trees.len()];
    for c in 0..ways.len() {
        let plant = ways.plant[c];
        let rows = ways.voxels.rows(c);
        let Some(tree) = trees.get_mut(plant as usize) else {
            *(if plant == NONE { &mut loose } else { &mut others }) += rows.len();
            continue;
        };
        tree.points += rows.len();
        tree.height_m = tree.height_m.max(site.over(ways.means[c]));
        for &row in rows {
            owner[row as usize] = plant;
            at_edge[plant as usize] += usize::from(is_at(&edges, scene.above[row as usize]));
        }
    }
    for (tree, at_edge) in trees.iter_mut().zip(at_edge) {
        tree.is_cut = at_edge as f64 > CUT.0 * tree.points as f64;
    }
    let Scene { above, classes, ground, points, .. } = scene;
    let ground_points = points - above.len();
    Ok(Plot { trees, ground, points, ground_points, others, loose, above, classes, owner })
}

impl Plot {
    /// Returns the points above the ground, each with the number of its tree; none for points without a tree.
    pub fn owned(&self) -> impl ExactSizeIterator<Item = (DVec3, Option<usize>)> + '_ {
        self.above.iter().zip(&self.owner).map(|(&p, &o)| (p, (o != NONE).then_some(o as usize)))
    }

    /// Returns the points of a tree.
    pub fn points_of(&self, tree: usize) -> Vec<DVec3> {
        self.owned().filter(|(_, owner)| *owner == Some(tree)).map(|(p, _)| p).collect()
    }

    /// Classes of the points of a tree in the file; empty, or one for each point.
    pub fn classes_of(&self, tree: usize) -> Vec<PointClass> {
        let rows = self.classes.iter().zip(&self.owner);
        rows.filter(|(_, owner)| **owner as usize == tree).map(|(class, _)| *class).collect()
    }

    /// The wood of a tree, as [`find_tree`](crate::find_tree) finds it in the tree's own points over the ground of the plot.
    ///
    /// # Errors
    /// [`ScanTreeError`].
    pub fn find_tree(
        &self,
        tree: usize,
        spec: &TreeScanSpec,
        run: &Run<'_>,
        report: &mut Report,
    ) -> Result<FoundTree, ScanTreeError> {
        let Some(own) = self.trees.get(tree) else { return Err(ScanTreeError::NoStem) };
        let scene = Scene::from_tree(self.points_of(tree), self.classes_of(tree), self.ground.clone())?;
        let spec = TreeScanSpec { at: Some(own.place), ..spec.clone() };
        scene.tree(&spec, run, report)
    }
}

/// Rules for following a trunk upwards: steps of `step_m` metres, points within `reach` radii of the expected axis, a
/// radius between the shares `ratio` of the radius below, and circles that are `covered` by points; it ends after
/// `missed` steps without a circle.
struct Following {
    step_m: f64,
    reach: f64,
    ratio: [f64; 2],
    covered: f64,
    missed: u32,
}

const FOLLOWING: Following =
    Following { step_m: 0.2, reach: 1.6, ratio: [0.6, 1.15], covered: 0.3, missed: 3 };

/// Extends the cubes of trunks upwards, as far as the trunks are round.
fn follow(
    points: &[DVec3],
    ways: &Ways,
    trunks: &mut [Trunk],
    noise: f64,
    run: &Run<'_>,
) -> Result<(), Cancelled> {
    let cell = ways.voxels.cell();
    let tree = geom::KdTree::new(&ways.means);
    let mut near = vec![];
    for trunk in trunks {
        run.cancel.check()?;
        let top = |c: &&u32| ways.means[**c as usize].y;
        let Some(&highest) = trunk.cubes.iter().max_by(|a, b| top(a).total_cmp(&top(b))) else { continue };
        // The lean from the foot to the highest slice.
        let high = ways.means[highest as usize].y;
        let slice =
            trunk.cubes.iter().map(|&c| ways.means[c as usize]).filter(|m| high - m.y < FOLLOWING.step_m);
        let slice: Vec<DVec3> = slice.collect();
        let mut at = slice.iter().sum::<DVec3>() / slice.len() as f64;
        let mut lean = ((at - trunk.middle) / (at.y - trunk.middle.y).max(0.1)).with_y(1.0);
        let (mut radius, mut missed) = (trunk.radius, 0);
        while missed < FOLLOWING.missed && radius > cell {
            let next = at + lean * FOLLOWING.step_m;
            let reach = FOLLOWING.reach * radius + cell;
            near.clear();
            tree.within(next, reach.max(FOLLOWING.step_m), &mut near);
            let flat = |p: DVec3| glam::DVec2::new(p.x - next.x, p.z - next.z);
            near.retain(|&c| {
                let m = ways.means[c];
                (m.y - next.y).abs() <= 0.5 * FOLLOWING.step_m && flat(m).length() < reach
            });
            near.sort_unstable();
            let rows: Vec<u32> = near.iter().flat_map(|&c| ways.voxels.rows(c)).copied().collect();
            let few: Vec<glam::DVec2> =
                rows.iter().step_by(rows.len() / 300 + 1).map(|&i| flat(points[i as usize])).collect();
            let mut stream = Seed::new(rows.first().map_or(0, |&r| u64::from(r))).stream(Draw::Sampling);
            let circle = fit_circle(&few, noise.max(0.5 * cell), 1.2 * radius, &mut stream);
            let [least, most] = FOLLOWING.ratio.map(|r| r * radius);
            let circle =
                circle.filter(|c| c.covered >= FOLLOWING.covered && (least..=most).contains(&c.radius));
            let Some(circle) = circle else {
                (at, missed) = (next, missed + 1);
                continue;
            };
            let middle = next + DVec3::new(circle.centre.x, 0.0, circle.centre.y);
            let on = |c: usize| (ways.means[c] - middle).with_y(0.0).length() < circle.radius + cell + noise;
            #[expect(clippy::cast_possible_truncation, reason = "cubes are u32")]
            trunk.cubes.extend(near.iter().copied().filter(|&c| on(c)).map(|c| c as u32));
            lean = (lean * 0.7 + ((middle - at) / (middle.y - at.y).max(1e-3)) * 0.3).with_y(1.0);
            (at, radius, missed) = (middle, circle.radius, 0);
        }
    }
    Ok(())
}

/// Assigns each cube to a trunk, or to undergrowth, whose number is that of the trunks.
fn share(
    ways: &mut Ways,
    site: &Site<'_>,
    trunks: &[Trunk],
    gap: f64,
    run: &Run<'_>,
) -> Result<(), Cancelled> {
    let pace = |radius: f64| ops::powf(radius.max(1e-3), -2.0 / 3.0);
    ways.pace = trunks.iter().map(|t| pace(t.radius)).chain([pace(UNDERGROWTH_M)]).collect();
    let mut front = vec![];
    let mut begin = |ways: &mut Ways, c: u32, plant: usize| {
        ways.way[c as usize] = 0.0;
        #[expect(clippy::cast_possible_truncation, reason = "fewer trunks than cubes")]
        let plant = plant as u32;
        ways.plant[c as usize] = plant;
        front.push(c);
    };
    for (k, trunk) in trunks.iter().enumerate() {
        trunk.cubes.iter().for_each(|&c| begin(ways, c, k));
    }
    let places: Vec<DVec3> = trunks.iter().map(|t| t.middle.with_y(0.0)).collect();
    let tree = geom::KdTree::new(&places);
    let (mut near, widest) = (vec![], trunks.iter().map(|t| t.radius).fold(0.0, f64::max));
    #[expect(clippy::cast_possible_truncation, reason = "cubes are u32")]
    for c in 0..ways.len() as u32 {
        if ways.plant[c as usize] != NONE || !site.is_low(ways.means[c as usize]) {
            continue;
        }
        near.clear();
        let flat = ways.means[c as usize].with_y(0.0);
        tree.within(flat, widest + FOOT_M, &mut near);
        let away = |k: usize| places[k].distance(flat) - trunks[k].radius;
        let foot = near.iter().copied().filter(|&k| away(k) < FOOT_M);
        let foot = foot.min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b)));
        begin(ways, c, foot.unwrap_or(trunks.len()));
    }
    // A trunk or the undergrowth keeps its first cubes: no path is shorter than 0.
    ways.spread(&front, |_| true, run.cancel)?;
    let (piece, sizes) = ways.pieces(2, |_| true, run.cancel)?;
    let piece: Vec<u32> = piece.iter().map(|&p| if sizes[p as usize] >= 4 { p } else { NONE }).collect();
    ways.bridge(gap, &piece, |c| piece[c] != NONE, run.cancel)?;
    Ok(())
}

/// Returns the corners of the box around all points.
fn edges(points: &[DVec3]) -> [DVec3; 2] {
    let sound = points.iter().filter(|p| p.abs().max_element() <= 1e9);
    let (low, high) = sound.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
    [low, high]
}

fn is_at([low, high]: &[DVec3; 2], p: DVec3) -> bool {
    let inside = (p - *low).min(*high - p);
    inside.x.min(inside.z) < CUT.1
}
