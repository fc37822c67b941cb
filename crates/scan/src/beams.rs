//! Beams of a scanner that have a width, and those of a scanner on the move: echoes of surfaces.
//!
//! `places -> beams by chance -> rays over the footprint of each -> groups near one another -> echoes`

use base::{Draw, Run, Seed, Stream, map_until_cancelled, ops};
use glam::{DVec2, DVec3};
use mesh::Model;
use render::{Camera, Hit, Tracer};
use skin::Label;

use crate::survey_spec::{SurveyError, SurveySpec};

/// Named numbers of the beams.
struct Beams {
    /// Rays over the footprint of a beam.
    rays: usize,
    /// Fewest rays of an echo: a fifth of the footprint, as surfaces that fill less of it return too little light.
    least: usize,
    /// Beams that are computed together: one job of the executor.
    job: usize,
    /// Fewest jobs of a round.
    round: usize,
    /// Most beams for each point that is wanted, and at least: where the beams meet hardly anything, fewer points come
    /// back.
    most: u64,
    /// Most beams in addition, so that a few points are found, too.
    more: u64,
    /// Pieces of a path, for which the beams that can meet the plant are worked out.
    pieces: usize,
}

const BEAMS: Beams =
    Beams { rays: 16, least: 3, job: 2048, round: 8, most: 200, more: 1 << 20, pieces: 1024 };

/// A point that a beam measures.
pub(crate) struct Echo {
    pub(crate) at: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) label: Label,
    /// Plant of the label.
    pub(crate) plant: i32,
    /// Share of the echo that comes from what the label names.
    pub(crate) share: f64,
    /// Its number among the echoes of its beam, and their count.
    pub(crate) order: (u8, u8),
    /// Place of the scanner: a row of the stations, or of the legs of the path.
    pub(crate) station: u8,
    /// Share of the path that lies behind the scanner.
    pub(crate) time: f64,
    pub(crate) distance_m: f64,
}

/// Places of a scanner, and the beams that it sends from there.
enum Places {
    /// Cameras whose pictures the beams fill evenly.
    Stands(Vec<Camera>),
    /// Pieces of a path, and the sums of their weights up to each.
    Path(Vec<Piece>, Vec<f64>),
}

/// A piece of a path. Its mirror turns in planes across it; beams are sent within the window in which they can meet
/// the plant.
struct Piece {
    from: DVec3,
    to: DVec3,
    leg: u8,
    /// Share of the path up to its start and its end.
    time: [f64; 2],
    /// Unit vectors across the path: towards the plant, and at a right angle to it.
    across: [DVec3; 2],
    /// Half of the angle of the window, radians.
    half: f64,
}

/// A beam: its axis, and where and when it was sent.
struct Beam {
    eye: DVec3,
    axis: DVec3,
    station: u8,
    time: f64,
}

/// Returns the echoes of beams on a model, as many as [`SurveySpec::points`], by stations or along the path; `label`
/// returns the label and the plant of a hit.
///
/// # Errors
/// [`SurveyError`].
pub(crate) fn echoes(
    model: &Model,
    spec: &SurveySpec,
    (seed, run): (Seed, &Run<'_>),
    label: impl Fn(&Hit) -> Option<(Label, i32)> + Sync,
) -> Result<Vec<Echo>, SurveyError> {
    let tracer = Tracer::new(model, run)?;
    let Some(sphere) = tracer.sphere() else { return Ok(Vec::new()) };
    let places = if spec.path.is_empty() {
        Places::Stands(spec.views(VIEW).iter().map(|view| tracer.camera(view)).collect())
    } else {
        path(&spec.path, sphere).ok_or(SurveyError::PathPasses)?
    };
    let wanted = spec.points as usize;
    let most = BEAMS.most * u64::from(spec.points) + BEAMS.more;
    let (mut found, mut jobs) = (Vec::new(), 0_usize);
    while found.len() < wanted && (jobs * BEAMS.job) as u64 <= most {
        let rate = (found.len() as f64 / (jobs * BEAMS.job).max(1) as f64).max(0.05);
        let lacking = (wanted - found.len()) as f64 / rate;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1e8")]
        let round = (1.05 * lacking / BEAMS.job as f64).ceil() as usize + BEAMS.round;
        let of_job = |k: usize| {
            let mut chance = seed.child((jobs + k) as u64).stream(Draw::Sampling);
            let mut own = Vec::new();
            for _ in 0..BEAMS.job {
                let beam = places.beam(&mut chance);
                measure(&tracer, &beam, spec, &mut chance, &label, &mut own);
            }
            own
        };
        found.extend(map_until_cancelled(run, round, of_job)?.into_iter().flatten());
        jobs += round;
    }
    found.truncate(wanted);
    base::sort_by(&mut found, |a, b| a.station.cmp(&b.station).then(a.time.total_cmp(&b.time)));
    Ok(found)
}

/// Pixels of the picture of a station: only its form matters.
const VIEW: u32 = 1024;

impl Places {
    fn beam(&self, chance: &mut Stream) -> Beam {
        match self {
            Self::Stands(cameras) => {
                let station = chance.below(cameras.len());
                let pixel = DVec2::new(chance.uniform(), chance.uniform()) * f64::from(VIEW);
                let (eye, axis) = cameras[station].ray(pixel);
                Beam { eye, axis, station: u8::try_from(station).unwrap_or(u8::MAX), time: 0.0 }
            }
            Self::Path(pieces, sums) => {
                let all = sums.last().copied().unwrap_or(0.0);
                let at = chance.uniform() * all;
                let piece = &pieces[sums.partition_point(|s| *s <= at).min(pieces.len() - 1)];
                let along = chance.uniform();
                let (sin, cos) = ops::sin_cos(piece.half * (2.0 * chance.uniform() - 1.0));
                Beam {
                    eye: piece.from.lerp(piece.to, along),
                    axis: piece.across[0] * cos + piece.across[1] * sin,
                    station: piece.leg,
                    time: piece.time[0] + (piece.time[1] - piece.time[0]) * along,
                }
            }
        }
    }
}

/// Returns the pieces of a path of two or more points from which beams can meet a sphere; `None` if there are none.
fn path(points: &[DVec3], (centre, radius): (DVec3, f64)) -> Option<Places> {
    let whole: f64 = points.windows(2).map(|leg| leg[0].distance(leg[1])).sum();
    let (mut pieces, mut sums) = (Vec::new(), Vec::new());
    let (mut behind, mut sum) = (0.0, 0.0);
    for (leg, ends) in (0_u8..=u8::MAX).zip(points.windows(2)) {
        let way = ends[1] - ends[0];
        let long = way.length();
        let Some(along) = way.try_normalize() else { continue };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most the number of pieces"
        )]
        let count = ((long / whole * BEAMS.pieces as f64).ceil() as usize).clamp(1, BEAMS.pieces);
        let step = long / count as f64;
        for k in 0..count {
            let from = ends[0] + along * (step * k as f64);
            let middle = from + along * (0.5 * step);
            let ahead = (centre - middle).dot(along);
            let off = centre - middle - along * ahead;
            let short = (ahead.abs() - 0.5 * step).max(0.0);
            // The planes across this piece cut the sphere in circles of at most this radius.
            let reach = (radius * radius - short * short).max(0.0).sqrt();
            if reach <= 0.0 {
                continue;
            }
            let away = off.length();
            let half = if away <= reach { ops::PI } else { ops::asin(reach / away) };
            let toward = off.try_normalize().unwrap_or_else(|| along.any_orthonormal_vector());
            let time = [k, k + 1].map(|k| (behind + step * k as f64) / whole);
            let across = [toward, along.cross(toward)];
            pieces.push(Piece { from, to: from + along * step, leg, time, across, half });
            sum += half * step;
            sums.push(sum);
        }
        behind += long;
    }
    (sum > 0.0).then_some(Places::Path(pieces, sums))
}

/// Adds the echoes of a beam.
fn measure(
    tracer: &Tracer,
    beam: &Beam,
    spec: &SurveySpec,
    chance: &mut Stream,
    label: &impl Fn(&Hit) -> Option<(Label, i32)>,
    out: &mut Vec<Echo>,
) {
    let ways = footprint(beam.axis, 0.5e-3 * spec.beam_mrad);
    let mut hits = tracer.bundle(beam.eye, beam.axis, &ways);
    let least = BEAMS.least.min(ways.len());
    if hits.len() < least {
        return;
    }
    base::sort_by(&mut hits, |a, b| a.distance_m.total_cmp(&b.distance_m).then(a.pixel.cmp(&b.pixel)));
    let first = out.len();
    let mut rest = &hits[..];
    while let Some(nearest) = rest.first() {
        let near = rest.iter().take_while(|h| h.distance_m - nearest.distance_m <= spec.pulse_m).count();
        let (group, farther) = rest.split_at(near);
        rest = farther;
        if group.len() >= least {
            out.extend(echo(group, beam, label));
        }
    }
    let count = u8::try_from(out.len() - first).unwrap_or(u8::MAX);
    for (k, echo) in (0_u8..).zip(&mut out[first..]) {
        echo.order = (k, count);
        if spec.noise_m > 0.0 {
            echo.at += beam.axis * (spec.noise_m * chance.normal());
        }
    }
}

/// Returns the echo of rays that one pulse cannot tell apart: at the mean of their distances, with the label that most
/// of them have, the nearer one of two.
fn echo(group: &[Hit], beam: &Beam, label: &impl Fn(&Hit) -> Option<(Label, i32)>) -> Option<Echo> {
    let mut labels: Vec<((Label, i32), usize, &Hit)> = Vec::new();
    // Rays of a beam that meet one triangle share its label: to look it up takes longest.
    let mut known: Vec<((u32, u32), (Label, i32))> = Vec::new();
    for hit in group {
        let triangle = (hit.part, hit.triangle);
        let own = match known.iter().find(|(own, _)| *own == triangle) {
            Some((_, label)) => *label,
            None => label(hit)?,
        };
        known.push((triangle, own));
        match labels.iter_mut().find(|(known, ..)| *known == own) {
            Some((_, count, _)) => *count += 1,
            None => labels.push((own, 1, hit)),
        }
    }
    let most = labels.iter().map(|(_, count, _)| *count).max()?;
    let ((label, plant), count, hit) = labels.into_iter().find(|(_, count, _)| *count == most)?;
    let alone = group.len() == 1;
    let distance_m = group.iter().map(|h| h.distance_m).sum::<f64>() / group.len() as f64;
    Some(Echo {
        at: if alone { hit.at } else { beam.eye + beam.axis * distance_m },
        normal: hit.normal,
        label,
        plant,
        share: count as f64 / group.len() as f64,
        order: (0, 1),
        station: beam.station,
        time: beam.time,
        distance_m,
    })
}

/// Returns rays that share a footprint evenly, by a spiral of golden angles (Vogel 1979); for no width, the axis alone.
fn footprint(axis: DVec3, half_angle: f64) -> Vec<DVec3> {
    if half_angle <= 0.0 {
        return vec![axis];
    }
    let golden = ops::PI * (3.0 - 5.0_f64.sqrt());
    let (right, up) = axis.any_orthonormal_pair();
    let wide = ops::tan(half_angle);
    let ray = |k: usize| {
        let (sin, cos) = ops::sin_cos(golden * k as f64);
        let out = wide * ((k as f64 + 0.5) / BEAMS.rays as f64).sqrt();
        (axis + right * (out * cos) + up * (out * sin)).normalize_or(axis)
    };
    (0..BEAMS.rays).map(ray).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh::{Material, MaterialId, MaterialKind, Part, TriMesh};

    /// A rectangle across z: part `k` of the models here.
    fn sheet(z: f32, [left, right]: [f32; 2], [low, high]: [f32; 2]) -> Part {
        let mesh = TriMesh {
            positions: vec![[left, low, z], [right, low, z], [right, high, z], [left, high, z]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..TriMesh::default()
        };
        Part { name: format!("sheet at {z}"), material: MaterialId::new(0), mesh }
    }

    /// The left half of a wall of 4 m hidden by a board `gap` in front of it.
    fn edge_before_wall(gap: f32) -> Model {
        let parts = vec![sheet(0.0, [-2.0, 2.0], [0.0, 4.0]), sheet(gap, [-2.0, 0.0], [0.0, 4.0])];
        let materials = vec![Material::plain("plain", MaterialKind::Other, [0.5; 3])];
        Model { parts, materials, ..Model::default() }
    }

    fn by_part(hit: &Hit) -> Option<(Label, i32)> {
        Some((Label { part: u8::try_from(hit.part).ok()?, axis: -1, organ: -1, order: 0 }, 0))
    }

    /// Whether the footprint does not reach the outer edges of wall and board.
    fn is_inside(e: &Echo) -> bool {
        e.at.x.abs() < 1.9 && (0.1..3.9).contains(&e.at.y)
    }

    /// One station in front, with a footprint of 4 cm or so.
    fn wide() -> SurveySpec {
        let still = SurveySpec { points: 40_000, stations: 1, elevation_deg: 0.0, ..SurveySpec::default() };
        SurveySpec { beam_mrad: 4.0, ..still }
    }

    fn found(model: &Model, spec: &SurveySpec) -> Vec<Echo> {
        echoes(model, spec, (Seed::new(3), &Run::plain()), by_part).expect("not cancelled")
    }

    #[test]
    fn beams_split_at_an_edge_lie_between_it_and_the_wall_by_their_shares() {
        let (gap, spec) = (0.1_f32, wide());
        let echoes = found(&edge_before_wall(gap), &spec);
        let eye = Tracer::new(&edge_before_wall(gap), &Run::plain()).expect("not cancelled");
        let eye = eye.camera(&spec.views(VIEW)[0]).ray(DVec2::ZERO).0;
        let mut mixed = 0;
        for e in echoes.iter().filter(|e| is_inside(e)) {
            // Where the beam's axis crosses the plane of the board, and the radius of its footprint there.
            let way = (e.at - eye).normalize();
            let t = (f64::from(gap) - eye.z) / way.z;
            let (off, r) = ((eye + way * t).x, ops::tan(2e-3) * t);
            if off.abs() >= 1.1 * r {
                assert_eq!(
                    (e.share, usize::from(e.label.part)),
                    (1.0, usize::from(off < 0.0)),
                    "{off} of {r}"
                );
                let want = if off < 0.0 { f64::from(gap) } else { 0.0 };
                assert!((e.at.z - want).abs() < 1e-3, "{}", e.at.z);
                continue;
            }
            // Share of a disc on one side of a line: the closed form.
            let x = (off / r).clamp(-1.0, 1.0);
            let on_board = (ops::acos(x) - x * (1.0 - x * x).sqrt()) / ops::PI;
            mixed += usize::from(e.share < 1.0);
            let most = on_board.max(1.0 - on_board);
            assert!((e.share - most).abs() < 0.13, "{} for {most}", e.share);
            assert!((e.at.z - f64::from(gap) * on_board).abs() < 0.13 * f64::from(gap), "{}", e.at.z);
            if (on_board - 0.5).abs() > 0.13 {
                assert_eq!(usize::from(e.label.part), usize::from(on_board > 0.5));
            }
        }
        assert!(mixed > 200, "{mixed} of {}", echoes.len());
        // Of all beams at once, shares and places are those of the disc.
        let between = echoes.iter().filter(|e| e.at.z > 0.01 && e.at.z < f64::from(gap) - 0.01).count();
        assert!(between > 200 && between < echoes.len() / 10, "{between}");
    }

    #[test]
    fn beyond_a_pulse_each_surface_has_an_echo_of_its_own() {
        let spec = SurveySpec { pulse_m: 0.3, ..wide() };
        let echoes = found(&edge_before_wall(0.5), &spec);
        assert!(echoes.iter().all(|e| e.share == 1.0));
        let (first, later): (Vec<&Echo>, Vec<&Echo>) = echoes.iter().partition(|e| e.order.0 == 0);
        assert!(later.len() > 200 && first.len() > 30_000, "{}", later.len());
        assert!(later.iter().all(|e| e.order == (1, 2) && e.label.part == 0));
        assert!(later.iter().all(|e| e.at.z.abs() < 0.01), "half a footprint lies to one side of its axis");
        let split = first.iter().filter(|e| e.order == (0, 2)).count();
        // The last beam may have lost its second echo.
        assert!(split.abs_diff(later.len()) <= 1, "{split} of {}", later.len());
    }

    #[test]
    fn a_scanner_on_the_move_measures_across_its_path_only() {
        // Along x, 2 m up and 6 m before the wall; the path goes on far beyond it.
        let path = vec![DVec3::new(-50.0, 2.0, 6.0), DVec3::new(50.0, 2.0, 6.0)];
        let spec = SurveySpec { points: 4000, path, ..SurveySpec::default() };
        let echoes = found(&edge_before_wall(0.5), &spec);
        assert_eq!(echoes.len(), 4000);
        assert!(echoes.windows(2).all(|w| w[0].time <= w[1].time));
        for e in &echoes {
            let eye = DVec3::new(-50.0 + 100.0 * e.time, 2.0, 6.0);
            assert!((e.at.x - eye.x).abs() < 1e-6 && (e.at.distance(eye) - e.distance_m).abs() < 1e-6);
            assert!((0.48..=0.52).contains(&e.time) && e.station == 0);
            // The board hides all of the wall behind it.
            let on_board = e.at.x < 0.0;
            assert_eq!((e.at.z, e.label.part), if on_board { (0.5, 1) } else { (0.0, 0) });
        }
        // Beams are even in time and in the angle of the mirror: of a wall and a board as high, the nearer one has more.
        let angle = |away: f64| 2.0 * ops::atan(2.0 / away);
        let on_board = echoes.iter().filter(|e| e.at.x < 0.0).count() as f64;
        let want = 4000.0 * angle(5.5) / (angle(5.5) + angle(6.0));
        assert!((on_board - want).abs() < 100.0, "{on_board} for {want}");
        let early = echoes.iter().filter(|e| e.at.x > 1.0).count() as f64;
        assert!((early / (4000.0 - on_board) - 0.5).abs() < 0.05, "{early}");
    }

    #[test]
    fn a_path_that_never_has_the_plant_abeam_is_refused() {
        let path = vec![DVec3::new(30.0, 1.0, 0.0), DVec3::new(40.0, 1.0, 0.0)];
        let spec = SurveySpec { path, ..SurveySpec::default() };
        let made = echoes(&edge_before_wall(0.5), &spec, (Seed::new(3), &Run::plain()), by_part);
        assert!(matches!(made, Err(SurveyError::PathPasses)));
    }

    #[test]
    fn rays_fill_a_footprint_evenly() {
        let axis = DVec3::new(0.3, -0.5, 0.8).normalize();
        let rays = footprint(axis, 0.01);
        assert_eq!((rays.len(), footprint(axis, 0.0)), (BEAMS.rays, vec![axis]));
        let off: Vec<DVec3> = rays.iter().map(|r| *r - axis * r.dot(axis)).collect();
        assert!(off.iter().all(|o| o.length() < 0.01));
        let mean = off.iter().sum::<DVec3>() / off.len() as f64;
        let square = off.iter().map(|o| o.length_squared()).sum::<f64>() / off.len() as f64;
        // A disc has half the square of its radius.
        assert!(mean.length() < 1e-3 && (square / 1e-4 - 0.5).abs() < 0.01, "{mean} {square}");
    }
}
