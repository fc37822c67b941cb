//! Measured leaves on one stem -> a plant.

use base::{Counted, Draw, Report, Run, Seed, ops};
use geom::{Ball, BallBSpline, SplineError};
use glam::{DQuat, DVec3};
use leaf::{FullMarks, Leaf, Pose};
use plant::{AxisKind, NodeId, Plant, SplineBlade};

use crate::error::LeafError;
use crate::look::{COARSER, LeafLook, LeafyPlant, bear};

/// A whole shoot of measured leaves (Wang et al. 2011, section 3 and Fig 9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShootSpec {
    /// Number of leaves, 1 to 200. Default 22.
    pub leaves: u32,
    /// Height of the stem, metres, above 0. Default 1.0.
    pub height_m: f64,
    /// Angle between successive leaves, degrees. Default 137, with 8 of deviation.
    pub azimuth_deg: f64,
    /// Radius of the stem at its base, metres. Default 0.014.
    pub stem_radius_m: f64,
}

impl Default for ShootSpec {
    fn default() -> Self {
        Self { leaves: 22, height_m: 1.0, azimuth_deg: 137.0, stem_radius_m: 0.014 }
    }
}

/// Makes a plant of leaves on one stem: the first leaf given has the form of the lowest, the last that of the
/// uppermost.
///
/// Leaves stand `azimuth_deg` apart with noise, closer towards the top, where they are smaller and more upright; each
/// has its own slight curl. The same bits for the same seed.
///
/// # Errors
/// [`LeafError`].
pub fn build_shoot(
    name: &str,
    forms: &[FullMarks],
    spec: &ShootSpec,
    (look, seed): (&LeafLook<'_>, Seed),
    run: &Run<'_>,
    report: &mut Report,
) -> Result<LeafyPlant, LeafError> {
    if forms.is_empty() {
        return Err(LeafError::NoLeaves);
    }
    let count = spec.leaves.clamp(1, 200);
    let each = forms.iter().map(|form| look.mesh().triangles(form.rows.len())).max().unwrap_or(0);
    run.budget.check(Counted::Triangles, each * u64::from(count), COARSER)?;
    let stem = stem(spec, seed)?;
    let forms: Vec<FullMarks> = forms.iter().map(|form| look.spec.moved(form)).collect::<Result<_, _>>()?;
    let mut leafy = LeafyPlant::named(name);
    for form in &forms {
        let leaf = Leaf::new(form, look.spec)?;
        leafy.textures.push(look.texture(&leaf, seed, run));
    }
    let places: Vec<Place> = (0..count as usize).map(|k| Place::new(k, count, spec, &stem, seed)).collect();
    let made = report.stage("structure", run.clock, |_| {
        base::map_indexed(run.executor, places.len(), |k| -> Result<_, LeafError> {
            run.cancel.check()?;
            // Equal shares of the stem for each form.
            let form = (k * forms.len() / count as usize).min(forms.len() - 1);
            let marks = places[k].leaf(&forms[form], look);
            let form = u32::try_from(form).unwrap_or(u32::MAX);
            Ok(SplineBlade { form, ..Leaf::new(&marks, look.spec)?.blade() })
        })
    });
    let nodes = add_stem(&mut leafy.plant, &stem, &places, seed);
    for ((k, blade), (place, node)) in made.into_iter().enumerate().zip(places.iter().zip(nodes)) {
        bear(&mut leafy.plant, blade?, node, look.paint(place.tint), seed.child(k as u64).number());
    }
    Ok(leafy)
}

/// Adds the stem as an axis with a node for each leaf, and returns those nodes.
fn add_stem(plant: &mut Plant, stem: &BallBSpline, places: &[Place], seed: Seed) -> Vec<Option<NodeId>> {
    // Between leaves, as many nodes as its bends need.
    let mut at: Vec<f64> =
        (0..=24).map(|k| f64::from(k) / 24.0).chain(places.iter().map(|p| p.height)).collect();
    base::sort_by(&mut at, f64::total_cmp);
    at.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let balls: Vec<Ball> = at.iter().map(|&t| stem.ball(t)).collect();
    let points: Vec<DVec3> = balls.iter().map(|b| b.centre).collect();
    let axis = plant.add_axis(AxisKind::Stem, None, seed.number(), &points, None);
    plant.nodes.radius_m = balls.iter().map(|b| b.radius).collect();
    let ids: Vec<NodeId> = plant.axis(axis).node_ids().collect();
    let nearest = |h: f64| at.partition_point(|&t| t < h - 1e-9).min(ids.len() - 1);
    places.iter().map(|p| ids.get(nearest(p.height)).copied()).collect()
}

/// Makes the stem as a ball curve from the ground up, slightly irregular.
fn stem(spec: &ShootSpec, seed: Seed) -> Result<BallBSpline, SplineError> {
    let mut stream = seed.stream(Draw::Curl);
    let height = if spec.height_m > 0.0 { spec.height_m.min(1000.0) } else { 1.0 };
    let radius = if spec.stem_radius_m > 0.0 { spec.stem_radius_m.min(0.2 * height) } else { 0.014 };
    let mut sway = DVec3::ZERO;
    let marks: Vec<Ball> = (0..=6)
        .map(|k| {
            let t = f64::from(k) / 6.0;
            if k > 1 {
                sway += DVec3::new(stream.normal(), 0.0, stream.normal()) * (0.006 * height);
            }
            Ball::new(DVec3::Y * (t * height) + sway, radius * (1.0 - 0.72 * t))
        })
        .collect();
    BallBSpline::approximate(&marks)
}

/// Place and pose of one leaf.
struct Place {
    /// Parameter of the stem.
    height: f64,
    origin: DVec3,
    turn: DQuat,
    tilt: f64,
    scale: f64,
    curl: f64,
    tint: [f32; 3],
}

impl Place {
    fn new(k: usize, count: u32, spec: &ShootSpec, stem: &BallBSpline, seed: Seed) -> Self {
        let key = seed.child(k as u64);
        let t = if count > 1 { k as f64 / f64::from(count - 1) } else { 0.5 };
        // Internodes shorten towards the top, where the youngest leaves crowd: 5 % of the height are bare.
        let height = 0.05 + 0.95 * (1.0 - ops::powf(1.0 - t, 1.7));
        let ball = stem.ball(height);
        let noise = key.stream(Draw::Phyllotaxis).normal().clamp(-2.5, 2.5) * 8.0;
        let azimuth = (spec.azimuth_deg * k as f64 + noise) * (ops::PI / 180.0);
        let mut angle = key.stream(Draw::LeafAngle);
        // Old leaves hang below the measured pose, young ones stand 45 degrees above it.
        let tilt = (-10.0 + 55.0 * t * t + 5.0 * angle.normal().clamp(-2.0, 2.0)) * (ops::PI / 180.0);
        let mut size = key.stream(Draw::Size);
        // The largest leaves stand a third of the way up (tobacco), the youngest are a third as long.
        let grown = 0.78 + 0.22 * ops::smoothstep(0.0, 0.3, t) - 0.6 * ops::smoothstep(0.45, 1.0, t);
        let outwards = DQuat::from_xyzw(0.0, ops::sin(0.5 * azimuth), 0.0, ops::cos(0.5 * azimuth));
        let shade = 1.0 + 0.1 * key.stream(Draw::Tint).normal().clamp(-2.0, 2.0);
        // Young leaves are lighter and yellower.
        let tint = [shade * (0.85 + 0.3 * t), shade * (0.92 + 0.16 * t), shade * 0.9];
        Self {
            height,
            origin: ball.centre + outwards * DVec3::NEG_Z * (0.6 * ball.radius),
            turn: outwards,
            tilt,
            scale: grown * size.range(0.94, 1.06),
            curl: key.stream(Draw::Curl).range(0.02, 0.14),
            #[expect(clippy::cast_possible_truncation, reason = "colours are f32 in meshes")]
            tint: tint.map(|x: f64| x.clamp(0.0, 1.0) as f32),
        }
    }

    /// Returns a leaf's marks turned so that it leaves the stem, scaled, bent and set in its place.
    fn leaf(&self, form: &FullMarks, look: &LeafLook<'_>) -> FullMarks {
        let root = form.root();
        // The measured leaf's own direction over the ground becomes -Z; a leaf measured upright stays so.
        let line = form.midrib();
        let middle = line[line.len() / 2] - root;
        let heading = ops::atan2(-middle.x, -middle.z);
        let straight = DQuat::from_xyzw(0.0, ops::sin(-0.5 * heading), 0.0, ops::cos(-0.5 * heading));
        // Tilting the tip (at -Z) up turns it about +X.
        let lift = DQuat::from_xyzw(ops::sin(0.5 * self.tilt), 0.0, 0.0, ops::cos(0.5 * self.tilt));
        let all = self.turn * lift * straight;
        let placed = form.map(|p| self.origin + all * ((p - root) * self.scale), |t| t * self.scale);
        let curl = (look.spec.curl + self.curl).clamp(-1.0, 1.0);
        Pose { curl, ..look.spec.pose() }.apply(&placed)
    }
}
