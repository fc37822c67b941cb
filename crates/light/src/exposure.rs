//! Light of the first order on each receiver, and where it comes from.

use base::{Run, Seed, map_indexed};
use glam::DVec3;

use crate::exchange::{AT_ONCE, Way, ways};
use crate::lines::Ground;
use crate::{Beams, LightError, LightSpec, LitScene};

/// Light on one receiver before any is scattered.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    /// Light that falls on both sides, W.
    pub incident_w: f64,
    /// Sum of the unit vectors towards the light, each times the light from there, W: it points to where most light
    /// comes from, and is shorter than `incident_w` where light comes from all around.
    pub towards_w: DVec3,
}

/// Computes the light that falls on each of [`LitScene::receivers`] before any is scattered.
///
/// `spec.bounces` and `spec.soil_reflectance` have no effect. Guaranteed: the same bits for any executor. Cost: linear in
/// triangles and lines, times directions; a fraction of [`absorb`](crate::absorb), which also follows scattered light.
///
/// # Errors
/// [`LightError`].
///
/// ```
/// use light::{Beams, LightSpec, LitScene, Optics, SkyKind, exposure};
/// use glam::DVec3;
/// // A horizontal plate in the open, a metre above the soil: all of its light comes from above.
/// let corner = |x: f64, z: f64| DVec3::new(x, 1.0, z);
/// let scene = LitScene {
///     points: vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)],
///     triangles: vec![[0, 2, 1], [0, 3, 2]],
///     owners: vec![0, 0],
///     receivers: vec![Optics::BLACK],
/// };
/// let beams = Beams::sky(SkyKind::Uniform, 100.0)?;
/// let lit = exposure(&scene, &beams, &LightSpec::default(), base::Seed::new(1), &base::Run::plain())?;
/// assert!((lit[0].incident_w - 100.0).abs() < 0.5 && lit[0].towards_w.normalize().y > 0.999);
/// # Ok::<(), light::LightError>(())
/// ```
pub fn exposure(
    scene: &LitScene,
    beams: &Beams,
    spec: &LightSpec,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Vec<Exposure>, LightError> {
    spec.check()?;
    scene.check(&run.budget)?;
    if beams.horizontal() <= 0.0 {
        return Err(LightError::Dark);
    }
    run.cancel.check()?;
    let ground = Ground::new(scene, spec.ground_m, spec.repeat_m);
    let ways = ways(scene, &ground, beams, (spec.lines, false), seed);
    let mut lit = vec![Exposure::default(); scene.receivers.len()];
    for some in ways.chunks(AT_ONCE) {
        let found = map_indexed(run.executor, some.len(), |k| incident(&some[k], scene, &ground, run));
        for (way, incident) in some.iter().zip(found) {
            for (sum, incident) in lit.iter_mut().zip(incident?) {
                sum.incident_w += incident;
                sum.towards_w += way.to * incident;
            }
        }
    }
    Ok(lit)
}

/// Returns the light that falls on each receiver from one direction, W.
fn incident(way: &Way, scene: &LitScene, ground: &Ground, run: &Run<'_>) -> Result<Vec<f64>, LightError> {
    let mut incident = vec![0.0; scene.receivers.len()];
    let flux = way.horizontal * way.lines.horizontal_area();
    for (line, _) in way.lines.cross(scene, ground, run.cancel)?.lines() {
        if let Some(hit) = line.first() {
            incident[scene.owners[*hit as usize / 2] as usize] += flux;
        }
    }
    Ok(incident)
}
