//! A plant as a scanner sees it: points on its surface, each with its part.
//!
//! `Model -> beams from stations around it -> hits -> a sample of them -> points with organ, axis, order`

use base::{Draw, Run, Seed};
use glam::DVec3;
use mesh::{Model, Standing};
use plant::{AxisId, Plant};
use render::Hit;
use skin::{Layout, Owner};

use crate::beams::{Echo, echoes};
use crate::parts::{NOTHING, part_of_axis, part_of_organ};
use crate::site::SceneSite;
use crate::survey_spec::{Label, SurveyError, SurveySpec};

/// The columns of a cloud, all of one length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surveyed {
    /// Positions, metres, +Y up.
    pub points: Vec<[f64; 3]>,
    /// Unit vectors of the surface, towards the scanner.
    pub normals: Vec<[f32; 3]>,
    /// Rows of [`PARTS`](crate::PARTS).
    pub part: Vec<u8>,
    /// Row of the plant's axes: the axis that the point lies on, or that bears its organ; [`NOTHING`] for none.
    pub axis: Vec<i32>,
    /// Row of the plant's organs; [`NOTHING`] on axes.
    pub organ: Vec<i32>,
    /// Branching order of the axis; 0 for none.
    pub order: Vec<i32>,
    /// Number of the place of the scanner, from 0.
    pub station: Vec<u8>,
    /// Distance from the scanner, metres, without noise.
    pub distance: Vec<f32>,
    /// Share of the echo that comes from what the labels name: below 1 where a beam met several things at once.
    pub share: Vec<f32>,
    /// Number of the echo among those of its beam, from 0.
    pub echo: Vec<u8>,
    /// Number of echoes of its beam.
    pub echoes: Vec<u8>,
    /// Share of the path that lay behind the scanner, 0 to 1; 0 for one that stands.
    pub time: Vec<f64>,
}

impl Surveyed {
    /// Adds an echo, and its plant to `plants`.
    fn push(&mut self, echo: &Echo, plants: &mut Vec<i32>) {
        self.points.push(echo.at.to_array());
        self.normals.push(echo.normal.as_vec3().to_array());
        self.part.push(echo.label.part);
        self.axis.push(echo.label.axis);
        self.organ.push(echo.label.organ);
        self.order.push(echo.label.order);
        self.station.push(echo.station);
        #[expect(clippy::cast_possible_truncation, reason = "a distance in a mesh of single precision")]
        self.distance.push(echo.distance_m as f32);
        #[expect(clippy::cast_possible_truncation, reason = "a share")]
        self.share.push(echo.share as f32);
        self.echo.push(echo.order.0);
        self.echoes.push(echo.order.1);
        self.time.push(echo.time);
        plants.push(echo.plant);
    }
}

/// Owner of each triangle of a model: the ends of the runs of each part, and their axes or organs.
struct Owned<'a> {
    plant: &'a Plant,
    ends: Vec<Vec<(u32, Owner<'a>)>>,
}

impl<'a> Owned<'a> {
    fn new(plant: &'a Plant, layout: &'a Layout) -> Self {
        let ends = layout.owners().map(|owners| {
            let mut end = 0;
            let run = |(owner, count): (Owner<'a>, u32)| {
                end += count;
                (end, owner)
            };
            owners.map(run).collect()
        });
        Self { plant, ends: ends.collect() }
    }

    fn label(&self, part: u32, triangle: u32, at: DVec3) -> Option<Label> {
        let ends = self.ends.get(part as usize)?;
        let (_, owner) = ends.get(ends.partition_point(|(end, _)| *end <= triangle))?;
        Some(match owner {
            Owner::Axes(axes) => self.of_axis(self.nearest(axes, at)?),
            Owner::Organ(organ) => {
                let found = self.plant.organs.get(organ.index())?;
                let bearer = found.bearer.and_then(|n| self.plant.nodes.axis.get(n.index()));
                let axis = bearer.map_or(NOTHING, |a| row(a.index()));
                let order = bearer.map_or(0, |a| self.order(*a));
                Label { part: part_of_organ(found.kind), axis, organ: row(organ.index()), order }
            }
        })
    }

    fn of_axis(&self, axis: AxisId) -> Label {
        let (part, order) = (part_of_axis(self.plant.axis(axis).kind), self.order(axis));
        Label { part, axis: row(axis.index()), organ: NOTHING, order }
    }

    fn order(&self, axis: AxisId) -> i32 {
        self.plant.axes.get(axis.index()).map_or(0, |a| i32::try_from(a.order).unwrap_or(i32::MAX))
    }

    /// Returns, of axes that share one tube, the one whose line passes nearest.
    fn nearest(&self, axes: &[AxisId], at: DVec3) -> Option<AxisId> {
        let [first, others @ ..] = axes else { return None };
        if others.is_empty() {
            return Some(*first);
        }
        let away = |axis: &AxisId| {
            let lines = self.plant.axis_points(*axis).windows(2);
            lines.map(|l| from_line(at, l[0], l[1])).fold(f64::INFINITY, f64::min)
        };
        axes.iter().map(|a| (away(a), *a)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, axis)| axis)
    }
}

/// Fails if a point of the path lies in wood: `from` brings it into the coordinates of the plant.
fn check_path(plant: &Plant, path: &[DVec3], from: impl Fn(DVec3) -> DVec3) -> Result<(), SurveyError> {
    for (row, at) in path.iter().enumerate() {
        let at = from(*at);
        let in_axis = |axis| {
            let radii = plant.axis_radii(axis).windows(2).map(|r| r[0].min(r[1]));
            let mut lines = plant.axis_points(axis).windows(2).zip(radii);
            lines.any(|(line, radius)| from_line(at, line[0], line[1]) < radius * radius)
        };
        if (0..plant.axes.len()).map(AxisId::new).any(in_axis) {
            return Err(SurveyError::InWood { path: format!("path[{row}]") });
        }
    }
    Ok(())
}

fn from_line(at: DVec3, a: DVec3, b: DVec3) -> f64 {
    let way = b - a;
    let along = ((at - a).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    at.distance_squared(a + way * along)
}

fn row(index: usize) -> i32 {
    i32::try_from(index).unwrap_or(i32::MAX)
}

/// Returns the labels of the triangles of each part of a model: rows of [`PARTS`](crate::PARTS), of the plant's axes
/// and of its organs.
///
/// `layout`: of this model. A triangle of a tube along several axes has the axis that is nearest to its middle.
pub fn triangle_labels(plant: &Plant, model: &Model, layout: &Layout) -> Vec<Vec<[i32; 3]>> {
    let owned = Owned::new(plant, layout);
    let of_part = |(row, part): (u32, &mesh::Part)| {
        let triangles = (0_u32..).zip(&part.mesh.triangles);
        let of_triangle = |(k, corners): (u32, &[u32; 3])| {
            let corner = |i: u32| part.mesh.positions.get(i as usize).map_or(DVec3::ZERO, to_f64);
            let middle = corners.iter().map(|&i| corner(i)).sum::<DVec3>() / 3.0;
            let label = owned.label(row, k, middle);
            label.map_or([NOTHING; 3], |l| [i32::from(l.part), l.axis, l.organ])
        };
        triangles.map(of_triangle).collect()
    };
    (0_u32..).zip(&model.parts).map(of_part).collect()
}

fn to_f64(p: &[f32; 3]) -> DVec3 {
    DVec3::from_array(p.map(f64::from))
}

/// Scans a plant from stations around it: the first surface that a beam meets gives a point and hides those behind it.
///
/// Each station's beams are even over its view, so near and frontal surfaces get more points, as from a scanner. Of all
/// hits of the beams, `points` are drawn by chance without replacement. `layout`: of this model. Guaranteed: the same
/// bits for any executor; points lie on the surface to the last bit except for the noise, which is along the beam.
///
/// Beams of a width ([`SurveySpec::beam_mrad`]) are 16 rays over their footprint. Rays within a pulse of the nearest one
/// give an echo at the mean of their distances, so a beam that an edge splits gives a point between two surfaces: it has
/// the label of the one with more rays, and their share. Farther rays give echoes of their own. A scanner on the move
/// ([`SurveySpec::path`]) sends beams across its path, evenly in time and angle. Not modelled: reflectance.
///
/// # Errors
/// [`SurveyError`].
pub fn survey(
    (plant, model, layout): (&Plant, &Model, &Layout),
    spec: &SurveySpec,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Surveyed, SurveyError> {
    let owned = Owned::new(plant, layout);
    let label = |hit: &Hit| Some((owned.label(hit.part, hit.triangle, hit.at)?, 0));
    spec.check()?;
    check_path(plant, &spec.path, |at| at)?;
    Ok(measured(model, spec, (seed, run), label)?.0)
}

/// A plant of a stand: its place, and the places of its parts in its model.
#[derive(Clone, Copy, Debug)]
pub struct Stood<'a> {
    /// Place and model.
    pub standing: Standing<'a>,
    /// Its structure.
    pub plant: &'a Plant,
    /// Layout of this model.
    pub layout: &'a Layout,
}

/// Scans a stand from stations around all of it, as [`survey`] scans a plant: plants hide one another. Labels are rows
/// of the tables of each point's own plant. `site`: the ground of the stand, which is scanned as well.
///
/// Returns the cloud, and for each point its plant, by its place in the stand; [`NOTHING`] on the site.
///
/// # Errors
/// [`SurveyError`].
pub fn survey_stand(
    stand: &[Stood<'_>],
    site: Option<&SceneSite>,
    spec: &SurveySpec,
    (seed, run): (Seed, &Run<'_>),
) -> Result<(Surveyed, Vec<i32>), SurveyError> {
    let mut standing: Vec<Standing<'_>> = stand.iter().map(|s| s.standing).collect();
    standing.extend(site.map(|site| Standing::home("site", &site.model)));
    let model = crate::scene_model("stand", &standing);
    let owned: Vec<Owned<'_>> = stand.iter().map(|s| Owned::new(s.plant, s.layout)).collect();
    // The parts of the plants are in the order of the plants.
    let mut first = 0;
    let firsts: Vec<u32> = stand
        .iter()
        .map(|s| {
            let own = first;
            first += u32::try_from(s.standing.model.parts.len()).unwrap_or(u32::MAX);
            own
        })
        .collect();
    let label = |hit: &Hit| {
        if let Some(part) = hit.part.checked_sub(first) {
            let part = *site?.labels.get(part as usize)?;
            return Some((Label { part, axis: NOTHING, organ: NOTHING, order: 0 }, NOTHING));
        }
        let row = firsts.partition_point(|f| *f <= hit.part).checked_sub(1)?;
        let Standing { position, turn, scale, .. } = stand[row].standing;
        let at = turn.inverse() * (hit.at - position) / scale;
        Some((owned[row].label(hit.part - firsts[row], hit.triangle, at)?, i32::try_from(row).ok()?))
    };
    spec.check()?;
    for Stood { standing: Standing { position, turn, scale, .. }, plant, .. } in stand {
        check_path(plant, &spec.path, |at| turn.inverse() * (at - *position) / *scale)?;
    }
    measured(&model, spec, (seed, run), label)
}

/// Returns what the beams measure of a model, and the plant of each point; `label` returns both for a hit.
fn measured(
    model: &Model,
    spec: &SurveySpec,
    (seed, run): (Seed, &Run<'_>),
    label: impl Fn(&Hit) -> Option<(Label, i32)> + Sync,
) -> Result<(Surveyed, Vec<i32>), SurveyError> {
    let (mut out, mut plants) = (Surveyed::default(), Vec::new());
    if spec.is_traced() {
        let found = echoes(model, spec, (seed, run), label)?;
        found.iter().for_each(|echo| out.push(echo, &mut plants));
        return Ok((out, plants));
    }
    let wanted = spec.points as usize;
    // A fifth of the beams meet a plant of a dense crown, fewer a thin one: then the grid becomes finer.
    let beams = 6.0 * f64::from(spec.points) / f64::from(spec.stations);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 8192")]
    let mut pixels = (beams.sqrt().ceil() as u32).clamp(64, MOST_PIXELS);
    let hits = loop {
        let seen = render::hits(model, &spec.views(pixels), run)?;
        let count: usize = seen.iter().map(Vec::len).sum();
        if count >= wanted || count == 0 || pixels >= MOST_PIXELS {
            break seen;
        }
        // One step suffices where the share of beams that meet the plant is constant.
        let finer = (1.1 * wanted as f64 / count as f64).sqrt().clamp(1.1, 8.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 8 times 4096")]
        let next = (f64::from(pixels) * finer).ceil() as u32;
        pixels = next.min(MOST_PIXELS);
    };
    let all: Vec<(u8, Hit)> =
        (0_u8..).zip(hits).flat_map(|(k, hits)| hits.into_iter().map(move |h| (k, h))).collect();
    let chosen = sample(all.len(), wanted, seed);
    let mut noise = seed.child(1).stream(Draw::Sampling);
    for i in chosen {
        let (station, hit) = &all[i];
        let Some((label, plant)) = label(hit) else { continue };
        let off = if spec.noise_m > 0.0 { spec.noise_m * noise.normal() } else { 0.0 };
        let (at, normal, distance_m) = (hit.at + hit.beam * off, hit.normal, hit.distance_m);
        let (share, order, station, time) = (1.0, (0, 1), *station, 0.0);
        let echo = Echo { at, normal, label, plant, share, order, station, time, distance_m };
        out.push(&echo, &mut plants);
    }
    Ok((out, plants))
}

/// Largest side of the grid of beams: that of a picture.
const MOST_PIXELS: u32 = 4096;

/// Draws `most` of the rows `0..all` by chance, ascending; all of them if there are no more.
fn sample(all: usize, most: usize, seed: Seed) -> Vec<usize> {
    let mut chance = seed.stream(Draw::Sampling);
    let mut rows = Vec::with_capacity(most.min(all));
    // Knuth's algorithm S: each row with the share that is still needed of the remaining ones.
    for row in 0..all {
        let (left, wanted) = ((all - row) as f64, (most.min(all) - rows.len()) as f64);
        if chance.uniform() * left < wanted {
            rows.push(row);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{TreeEvaluator, TreeOptions, TreeSpec};

    fn tree() -> TreeEvaluator {
        let mut evaluator = TreeEvaluator::default();
        let made =
            evaluator.update(&TreeSpec::default(), Seed::new(3), &TreeOptions::default(), &Run::plain());
        made.expect("a tree");
        evaluator
    }

    fn scanned(evaluator: &TreeEvaluator, spec: &SurveySpec) -> Surveyed {
        let of = (
            evaluator.plant().expect("a plant"),
            evaluator.model().expect("a model"),
            evaluator.layout().expect("a layout"),
        );
        survey(of, spec, Seed::new(5), &Run::plain()).expect("a cloud")
    }

    #[test]
    fn rows_are_drawn_without_putting_any_back() {
        for (all, most) in [(0, 5), (5, 5), (3, 9), (1000, 10)] {
            let rows = sample(all, most, Seed::new(2));
            assert_eq!(rows.len(), all.min(most));
            assert!(rows.windows(2).all(|w| w[0] < w[1]), "{rows:?}");
        }
    }

    #[test]
    fn points_of_an_axis_lie_within_its_radius_and_those_of_leaves_near_their_leaf() {
        let tree = tree();
        let plant = tree.plant().expect("a plant");
        let cloud = scanned(&tree, &SurveySpec { points: 5000, ..SurveySpec::default() });
        assert_eq!(cloud.points.len(), 5000);
        let (mut on_axes, mut on_leaves) = (0, 0);
        for (k, p) in cloud.points.iter().enumerate() {
            let at = DVec3::from_array(*p);
            if cloud.organ[k] == NOTHING {
                on_axes += 1;
                let axis = AxisId::new(usize::try_from(cloud.axis[k]).expect("a row"));
                let thick = plant.axis_radii(axis).iter().copied().fold(0.0, f64::max);
                let away = plant.axis_points(axis).windows(2).map(|l| from_line(at, l[0], l[1]));
                let away = away.fold(f64::INFINITY, f64::min).sqrt();
                assert!(away <= 3.0 * thick + 0.03, "{away} m from an axis of {thick} m");
            } else {
                on_leaves += 1;
                let organ = &plant.organs[usize::try_from(cloud.organ[k]).expect("a row")];
                let reach = organ.scale * plant.shapes[organ.shape.index()].reach();
                assert!(at.distance(organ.frame.origin) <= 1.5 * reach + 1e-3);
                assert_eq!(cloud.part[k], 5);
            }
        }
        assert!(on_axes > 50 && on_leaves > 1000, "{on_axes} on axes, {on_leaves} on leaves");
    }

    #[test]
    fn noise_moves_points_along_their_beams_only() {
        let tree = tree();
        let plain = SurveySpec { points: 2000, ..SurveySpec::default() };
        let still = scanned(&tree, &plain);
        let moved = scanned(&tree, &SurveySpec { noise_m: 0.02, ..plain.clone() });
        let off: Vec<f64> = still
            .points
            .iter()
            .zip(&moved.points)
            .map(|(a, b)| DVec3::from_array(*a).distance(DVec3::from_array(*b)))
            .collect();
        let rms = (off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64).sqrt();
        assert!((rms - 0.02).abs() < 0.002, "{rms}");
        assert_eq!((still.part, still.organ), (moved.part, moved.organ));
    }

    #[test]
    fn trees_of_a_stand_hide_one_another_and_keep_their_labels() {
        let tree = tree();
        let (plant, model) = (tree.plant().expect("a plant"), tree.model().expect("a model"));
        let layout = tree.layout().expect("a layout");
        let spec = SurveySpec { points: 6000, ..SurveySpec::default() };
        let at = |x: f64, scale: f64| {
            let turn = glam::DQuat::from_xyzw(0.0, 0.6, 0.0, 0.8);
            let standing =
                Standing { position: DVec3::X * x, scale, turn, ..Standing::home("a tree", model) };
            Stood { standing, plant, layout }
        };
        let alone = Stood { standing: Standing::home("a tree", model), plant, layout };
        let (same, plants) =
            survey_stand(&[alone], None, &spec, (Seed::new(5), &Run::plain())).expect("a cloud");
        assert_eq!(same, scanned(&tree, &spec));
        assert!(plants.iter().all(|p| *p == 0));
        let stand = [at(-2.0, 1.0), at(0.0, 0.7), at(2.0, 1.2)];
        let (cloud, plants) =
            survey_stand(&stand, None, &spec, (Seed::new(5), &Run::plain())).expect("a cloud");
        assert_eq!((cloud.points.len(), plants.len()), (6000, 6000));
        for (k, p) in cloud.points.iter().enumerate().filter(|(k, _)| cloud.organ[*k] != NOTHING) {
            let Stood { standing, .. } = stand[usize::try_from(plants[k]).expect("of a plant")];
            let organ = &plant.organs[usize::try_from(cloud.organ[k]).expect("a row")];
            let root = standing.turn * (organ.frame.origin * standing.scale) + standing.position;
            let reach = standing.scale * organ.scale * plant.shapes[organ.shape.index()].reach();
            assert!(DVec3::from_array(*p).distance(root) <= 1.5 * reach + 1e-3);
        }
        let of = |row: i32| plants.iter().filter(|p| **p == row).count();
        // The small one stands in the middle.
        assert!(of(1) > 0 && of(1) < of(0).min(of(2)), "{} {} {}", of(0), of(1), of(2));
    }

    #[test]
    fn wide_beams_see_the_same_tree_and_say_where_they_are_split() {
        let tree = tree();
        let plain = SurveySpec { points: 4000, ..SurveySpec::default() };
        let (still, wide) =
            (scanned(&tree, &plain), scanned(&tree, &SurveySpec { beam_mrad: 3.0, ..plain.clone() }));
        assert_eq!((wide.points.len(), wide.share.len(), wide.time.len()), (4000, 4000, 4000));
        assert!(still.share.iter().all(|s| *s == 1.0) && still.echoes.iter().all(|n| *n == 1));
        let leaves = |c: &Surveyed| c.organ.iter().filter(|o| **o != NOTHING).count() as f64;
        assert!((leaves(&still) / leaves(&wide) - 1.0).abs() < 0.1, "{} {}", leaves(&still), leaves(&wide));
        let mixed = wide.share.iter().filter(|s| **s < 1.0).count();
        assert!(mixed > 1000, "{mixed}");
        assert!(wide.share.iter().all(|s| (0.0..=1.0).contains(s)));
        assert!(wide.echo.iter().zip(&wide.echoes).all(|(k, n)| k < n));
        let again = SurveySpec { beam_mrad: 3.0, ..plain };
        assert_eq!(scanned(&tree, &again), wide);
    }

    #[test]
    fn a_path_goes_past_trees_and_not_through_their_wood() {
        let tree = tree();
        let along = |x: f64| vec![DVec3::new(x, 1.0, -9.0), DVec3::new(x, 1.0, 0.0), DVec3::new(x, 1.0, 9.0)];
        let spec = |x| SurveySpec { points: 2000, path: along(x), ..SurveySpec::default() };
        let seen = scanned(&tree, &spec(6.0));
        assert_eq!(seen.points.len(), 2000);
        assert!(seen.time.windows(2).all(|w| w[0] <= w[1]));
        for (p, (time, leg)) in seen.points.iter().zip(seen.time.iter().zip(&seen.station)) {
            assert!((p[2] - (18.0 * time - 9.0)).abs() < 1e-6);
            assert_eq!(*leg == 0, *time <= 0.5);
        }
        let of = (
            tree.plant().expect("a plant"),
            tree.model().expect("a model"),
            tree.layout().expect("a layout"),
        );
        let refused = survey(of, &spec(0.0), Seed::new(5), &Run::plain()).expect_err("in the trunk");
        assert_eq!(refused.to_string(), "path[1] lies in the wood of the plant: lead the path around it");
    }

    #[test]
    fn what_is_out_of_range_is_refused_by_name() {
        let bad = SurveySpec { stations: 0, ..SurveySpec::default() };
        let fault = bad.check().expect_err("no station");
        assert_eq!(fault.to_string(), "stations must be 1 to 64, not 0");
        assert!(SurveySpec { noise_m: f64::NAN, ..SurveySpec::default() }.check().is_err());
        let bad = SurveySpec { path: vec![DVec3::ZERO; 1], ..SurveySpec::default() };
        assert_eq!(
            bad.check().expect_err("one point").to_string(),
            "length of path must be 2 to 256 points, not 1"
        );
        let path = vec![DVec3::ZERO, DVec3::new(0.0, f64::NAN, 0.0)];
        let fault = SurveySpec { path, ..SurveySpec::default() }.check().expect_err("no number").to_string();
        assert!(fault.starts_with("path[1][1] must be -100,000 to 100,000 m"), "{fault}");
    }
}
