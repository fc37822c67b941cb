//! A plant as a scanner sees it: points on its surface, each with its part.
//!
//! `Model -> beams from stations around it -> hits -> a sample of them -> points with organ, axis, order`

use base::{Draw, Run, Seed};
use glam::DVec3;
use mesh::{Model, Standing};
use plant::{AxisId, Plant};
use render::Hit;
use skin::{Label, Labels, Layout, NOTHING, SceneSite};

use crate::beams::{Echo, echoes};
use crate::survey_spec::{SurveyError, SurveySpec};

/// The columns of a cloud, all of one length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surveyed {
    /// Positions, metres, +Y up.
    pub points: Vec<[f64; 3]>,
    /// Unit vectors of the surface, towards the scanner.
    pub normals: Vec<[f32; 3]>,
    /// Rows of [`PARTS`](skin::PARTS).
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
    let labels = Labels::new(plant, layout);
    let label = |hit: &Hit| Some((labels.label(hit.part, hit.triangle, hit.at)?, 0));
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
    let model = mesh::scene_model("stand", &standing);
    let labels: Vec<Labels<'_>> = stand.iter().map(|s| Labels::new(s.plant, s.layout)).collect();
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
        Some((labels[row].label(hit.part - firsts[row], hit.triangle, at)?, i32::try_from(row).ok()?))
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

    #[test]
    fn rows_are_drawn_without_putting_any_back() {
        for (all, most) in [(0, 5), (5, 5), (3, 9), (1000, 10)] {
            let rows = sample(all, most, Seed::new(2));
            assert_eq!(rows.len(), all.min(most));
            assert!(rows.windows(2).all(|w| w[0] < w[1]), "{rows:?}");
        }
    }
}
