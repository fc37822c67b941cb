//! Absorption by surfaces: light of the first order, then the exchange between surfaces.
//!
//! Lines in the 46 directions of the sky cross the scene. Light travels along them, in first order from the sky to
//! the first surface that a line meets. The light that a patch scatters leaves in equal shares along all lines that
//! cross it, to the next surface on each: the method of global lines (Sbert 1993; transillumination of Neumann 1995),
//! here with the same lines for all bounces, so that energy is conserved. A line crosses a patch in proportion to its
//! projected area, which is Lambert's law.

use base::{Draw, Run, Seed, map_indexed};
use glam::{DVec2, DVec3};

use crate::lines::{Crossings, Ground, Lines, OPEN_SOIL};
use crate::scene::{Patches, check_range};
use crate::sky::sky_directions;
use crate::{Beams, LightError, LitScene};

/// Settings of the light computation. Plain data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSpec {
    /// Approximate number of lines in each direction over the scene or its cell, 1,000 to 4,194,304. Directions below 14
    /// degrees have fewer over a cell that repeats itself, as each of them crosses more leaves.
    pub lines: u32,
    /// Number of bounces after the first surface, 0 to 50. Light that remains after the last bounce is distributed as
    /// in that bounce; with 0 it counts as lost.
    pub bounces: u32,
    /// Reflectance of the soil, 0 to 1.
    pub soil_reflectance: f64,
    /// Height of the soil, metres. Surfaces below it are in the dark.
    pub ground_m: f64,
    /// Width along X and depth along Z after which the scene repeats itself without end, metres, 0.001 to 10,000;
    /// `None` for an isolated scene.
    pub repeat_m: Option<[f64; 2]>,
}

impl Default for LightSpec {
    fn default() -> Self {
        Self { lines: 1 << 18, bounces: 3, soil_reflectance: 0.1, ground_m: 0.0, repeat_m: None }
    }
}

impl LightSpec {
    pub(crate) fn check(&self) -> Result<(), LightError> {
        check_range("lines", f64::from(self.lines), [1e3, 4_194_304.0], "")?;
        check_range("bounces", f64::from(self.bounces), [0.0, 50.0], "")?;
        check_range("soil", self.soil_reflectance, [0.0, 1.0], "")?;
        check_range("ground", self.ground_m, [-1e4, 1e4], "m")?;
        for side in self.repeat_m.iter().flatten() {
            check_range("repeat", *side, [0.001, 1e4], "m")?;
        }
        Ok(())
    }
}

/// Light on one receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReceiverLight {
    /// Area of its triangles, one side, square metres.
    pub area_m2: f64,
    /// Area-weighted mean height, metres.
    pub height_m: f64,
    /// Light that falls on both sides, first order and scattered, W.
    pub incident_w: f64,
    /// Absorbed light, W.
    pub absorbed_w: f64,
    /// Share of its area that is in the sun, 0 to 1; the mean over all suns. `None` without a sun, and if no line in
    /// its direction crosses the receiver.
    pub sunlit: Option<f64>,
    /// Number of lines that cross it: the relative sampling error of its figures is about one over the square root.
    pub crossings: u64,
}

/// Light on a patch: up to 32 consecutive triangles of one receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchLight {
    /// Area of one side, square metres.
    pub area_m2: f64,
    /// Absorbed light, W.
    pub absorbed_w: f64,
}

/// Energy balance of a cell that repeats itself, W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// Light that enters the cell from above.
    pub incoming_w: f64,
    /// Light absorbed by surfaces.
    pub absorbed_w: f64,
    /// Light absorbed by the soil.
    pub soil_w: f64,
    /// Light that returns to the sky.
    pub reflected_w: f64,
    /// Light that remains when no bounce is followed.
    pub lost_w: f64,
}

/// Shadow and transmission of a scene in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionLight {
    /// Unit vector towards the light.
    pub to: DVec3,
    /// Irradiance of a horizontal surface, W/m2.
    pub horizontal: f64,
    /// Area of the shadow across the direction, square metres; of a repeating cell, within the cell.
    pub outline_m2: f64,
    /// Share of lines that reach the soil without meeting a surface; only of cells that repeat themselves.
    pub transmitted: Option<f64>,
}

/// Light that a scene absorbs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Absorption {
    /// A row for each of [`LitScene::receivers`].
    pub receivers: Vec<ReceiverLight>,
    /// Light on each patch.
    pub patches: Vec<PatchLight>,
    /// For each triangle of the scene, its row of `patches`.
    pub patch_of_triangle: Vec<u32>,
    /// Irradiance of a horizontal surface above the scene, W/m2.
    pub horizontal: f64,
    /// Light that meets a surface in first order, W.
    pub intercepted_w: f64,
    /// The balance of a scene that repeats itself.
    pub balance: Option<EnergyBalance>,
    /// The directions that were computed: those of the sky and the others.
    pub directions: Vec<DirectionLight>,
}

/// Most directions that are in memory at once before they are added up, in their order.
pub(crate) const AT_ONCE: usize = 16;

/// Most bytes of crossings that are kept from bounce to bounce; those beyond are computed again.
const KEPT_BYTES: usize = 400_000_000;

/// Share of all light below which bounces end.
const NEGLIGIBLE: f64 = 1e-6;

/// Computes the light that each receiver and patch absorbs.
///
/// Guaranteed: the same bits for any executor. In a cell that repeats itself, incoming light equals the sum of absorbed
/// light, light reflected to the sky and light absorbed by the soil, to rounding. Not modelled: gloss, and differences
/// in scattering within a patch. An isolated scene stands on soil that is lit as far as the scene does not shade it.
///
/// Cost: linear in triangles and lines, times directions: 46 of the sky and the others.
///
/// # Errors
/// [`LightError`].
///
/// ```
/// use light::{Beams, LightSpec, LitScene, Optics, SkyKind, absorb};
/// use glam::DVec3;
/// // A black plate of one square metre takes all that falls on it.
/// let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
/// let scene = LitScene {
///     points: vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)],
///     triangles: vec![[0, 2, 1], [0, 3, 2]],
///     owners: vec![0, 0],
///     receivers: vec![Optics::BLACK],
/// };
/// let spec = LightSpec { repeat_m: Some([1.0, 1.0]), ..LightSpec::default() };
/// let beams = Beams::sky(SkyKind::Overcast, 100.0)?;
/// let lit = absorb(&scene, &beams, &spec, base::Seed::new(1), &base::Run::plain())?;
/// assert!((lit.receivers[0].absorbed_w - 100.0).abs() < 1e-9);
/// # Ok::<(), light::LightError>(())
/// ```
pub fn absorb(
    scene: &LitScene,
    beams: &Beams,
    spec: &LightSpec,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Absorption, LightError> {
    spec.check()?;
    scene.check(&run.budget)?;
    if beams.horizontal() <= 0.0 {
        return Err(LightError::Dark);
    }
    run.cancel.check()?;
    let optical = scene.receivers.iter().any(|o| o.scattered() > 0.0) || spec.soil_reflectance > 0.0;
    let bounces = if optical { spec.bounces } else { 0 };
    let ground = Ground::new(scene, spec.ground_m, spec.repeat_m);
    let ways = ways(scene, &ground, beams, (spec.lines, bounces > 0), seed);
    let mut exchange = Exchange::new(scene, &ground, spec, ways);
    exchange.first(beams, bounces > 0, run)?;
    exchange.bounce(bounces, run)?;
    Ok(exchange.finish(beams))
}

/// A direction of incoming light, or of scattering.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    pub(crate) to: DVec3,
    pub(crate) lines: Lines,
    /// Irradiance of a horizontal surface from this direction.
    pub(crate) horizontal: f64,
    /// Solid angle of a direction of the sky, steradians, into which light is scattered too; 0 for others.
    solid_angle: f64,
    is_sun: bool,
}

/// Returns the directions of the sky as far as they matter, then the others.
pub(crate) fn ways(
    scene: &LitScene,
    ground: &Ground,
    beams: &Beams,
    (count, is_scattering): (u32, bool),
    seed: Seed,
) -> Vec<Way> {
    let sky = sky_directions()
        .zip(beams.sky)
        .map(|((to, solid_angle), horizontal)| (to, horizontal, solid_angle, false));
    let others = beams.others.iter().map(|b| (b.to, b.horizontal, 0.0, b.is_sun));
    let wanted = sky.chain(others).filter(|w| w.1 > 0.0 || (is_scattering && w.2 > 0.0));
    let way = |(k, (to, horizontal, solid_angle, is_sun)): (u64, (DVec3, f64, f64, bool))| {
        let mut chance = seed.child(k).stream(Draw::Sampling);
        let jitter = DVec2::new(chance.uniform(), chance.uniform());
        let lines = Lines::new(scene, ground, to, count, jitter);
        Way { to, lines, horizontal, solid_angle, is_sun }
    };
    (0..).zip(wanted).map(way).collect()
}

/// Sides of patches: twice the row of the patch, and 1 for its back.
struct Sides<'a>(&'a [u32]);

impl Sides<'_> {
    /// Returns the side that a line from the light meets.
    fn upper(&self, hit: u32) -> usize {
        2 * self.0[hit as usize / 2] as usize + (1 - (hit as usize & 1))
    }

    /// Returns the side by which the line leaves.
    fn lower(&self, hit: u32) -> usize {
        2 * self.0[hit as usize / 2] as usize + (hit as usize & 1)
    }
}

/// Result of one direction in first order.
struct First {
    incident: Vec<f64>,
    /// Projected area of each side, weighted by the solid angles of the sky.
    outlet: Vec<f64>,
    /// Light that does not arrive in each cell of the soil.
    shaded: Vec<f64>,
    /// For each receiver in the direction of a sun, the lit area and the whole area.
    sunlit: Vec<[f64; 2]>,
    crossings: Vec<u64>,
    shadows: usize,
    kept: Option<Crossings>,
}

/// Result of one direction in a bounce.
struct Bounced {
    received: Vec<f64>,
    soil: Vec<f64>,
    sky: f64,
    from_soil: f64,
}

struct Exchange<'a> {
    scene: &'a LitScene,
    ground: &'a Ground,
    spec: &'a LightSpec,
    ways: Vec<Way>,
    patches: Patches,
    kept: Vec<Option<Crossings>>,
    shadows: Vec<usize>,
    /// For each side, W: the light that fell on it, and the light that it scatters.
    incident: Vec<f64>,
    emitted: Vec<f64>,
    outlet: Vec<f64>,
    /// Absorbed light of each patch, W.
    absorbed: Vec<f64>,
    sunlit: Vec<[f64; 2]>,
    crossings: Vec<u64>,
    intercepted: f64,
    /// Light that the soil reflects, W/m2, by cells; the last is the open.
    soil_emitted: Vec<f64>,
    soil_absorbed: f64,
    reflected: f64,
    lost: f64,
}

fn add<T: Copy + std::ops::AddAssign>(sum: &mut [T], more: &[T]) {
    for (sum, more) in sum.iter_mut().zip(more) {
        *sum += *more;
    }
}

impl<'a> Exchange<'a> {
    fn new(scene: &'a LitScene, ground: &'a Ground, spec: &'a LightSpec, ways: Vec<Way>) -> Self {
        let patches = scene.patches();
        let (sides, receivers) = (2 * patches.area.len(), scene.receivers.len());
        Self {
            scene,
            ground,
            spec,
            kept: Vec::new(),
            shadows: Vec::new(),
            incident: vec![0.0; sides],
            emitted: vec![0.0; sides],
            outlet: vec![0.0; sides],
            absorbed: vec![0.0; patches.area.len()],
            sunlit: vec![[0.0; 2]; receivers],
            crossings: vec![0; receivers],
            intercepted: 0.0,
            soil_emitted: vec![0.0; OPEN_SOIL + 1],
            soil_absorbed: 0.0,
            reflected: 0.0,
            lost: 0.0,
            ways,
            patches,
        }
    }

    /// Follows light to the first surface on its way.
    fn first(&mut self, beams: &Beams, keep: bool, run: &Run<'_>) -> Result<(), LightError> {
        let horizontal = beams.horizontal();
        let mut arrived = vec![0.0; self.incident.len()];
        let mut shaded = vec![0.0; OPEN_SOIL + 1];
        let mut bytes = 0;
        for from in (0..self.ways.len()).step_by(AT_ONCE) {
            let count = AT_ONCE.min(self.ways.len() - from);
            let found = map_indexed(run.executor, count, |k| self.first_of(&self.ways[from + k], run));
            for (k, first) in found.into_iter().enumerate() {
                let First { incident, outlet, shaded: cells, sunlit, crossings, shadows, kept } = first?;
                add(&mut arrived, &incident);
                add(&mut self.outlet, &outlet);
                add(&mut shaded, &cells);
                for (sum, more) in self.sunlit.iter_mut().zip(&sunlit) {
                    add(sum, more);
                }
                add(&mut self.crossings, &crossings);
                self.shadows.push(shadows);
                bytes += kept.as_ref().map_or(0, Crossings::bytes);
                let is_kept = keep && self.ways[from + k].solid_angle > 0.0 && bytes <= KEPT_BYTES;
                self.kept.push(kept.filter(|_| is_kept));
            }
        }
        self.intercepted = arrived.iter().sum();
        let cell = self.ground.cell_area();
        let lit: Vec<f64> = shaded[..OPEN_SOIL].iter().map(|s| (horizontal * cell - s).max(0.0)).collect();
        self.settle(&arrived, &lit, 1.0);
        self.soil_emitted[OPEN_SOIL] = horizontal * self.spec.soil_reflectance;
        Ok(())
    }

    fn first_of(&self, way: &Way, run: &Run<'_>) -> Result<First, LightError> {
        let found = way.lines.cross(self.scene, self.ground, run.cancel)?;
        let sides = Sides(&self.patches.of_triangle);
        let receivers = self.scene.receivers.len();
        let mut first = First {
            incident: vec![0.0; self.incident.len()],
            outlet: vec![0.0; if way.solid_angle > 0.0 { self.incident.len() } else { 0 }],
            shaded: vec![0.0; OPEN_SOIL + 1],
            sunlit: vec![[0.0; 2]; if way.is_sun { receivers } else { 0 }],
            crossings: vec![0; receivers],
            shadows: found.count(),
            kept: None,
        };
        let flux = way.horizontal * way.lines.horizontal_area();
        let weight = way.lines.area * way.solid_angle;
        for (line, soil) in found.lines() {
            if let Some(hit) = line.first() {
                first.incident[sides.upper(*hit)] += flux;
                first.shaded[soil] += flux;
            }
            for (k, hit) in line.iter().enumerate() {
                let triangle = *hit as usize / 2;
                let owner = self.scene.owners[triangle] as usize;
                first.crossings[owner] += 1;
                if way.solid_angle > 0.0 {
                    first.outlet[sides.upper(*hit)] += weight;
                    first.outlet[sides.lower(*hit)] += weight;
                }
                if way.is_sun {
                    // Area of the triangle that is seen between lines.
                    let normal = self.scene.normal(triangle);
                    let area = way.lines.area * normal.length()
                        / normal.dot(way.to).abs().max(GRAZING * normal.length());
                    first.sunlit[owner][1] += area;
                    first.sunlit[owner][0] += if k == 0 { area } else { 0.0 };
                }
            }
        }
        first.kept = Some(found);
        Ok(first)
    }

    /// Follows light from surface to surface.
    fn bounce(&mut self, bounces: u32, run: &Run<'_>) -> Result<(), LightError> {
        let flat: f64 = self.ways.iter().map(|w| w.solid_angle * w.to.y).sum();
        for pass in 1..=bounces {
            let sent = self.sent();
            if sent <= NEGLIGIBLE * self.intercepted {
                break;
            }
            let unit: Vec<f64> = self
                .emitted
                .iter()
                .zip(&self.outlet)
                .map(|(emitted, outlet)| if *outlet > 0.0 { emitted / outlet } else { 0.0 })
                .collect();
            // A side that no line of the sky crosses keeps its light.
            for (side, _) in self.outlet.iter().enumerate().filter(|(_, outlet)| **outlet <= 0.0) {
                self.absorbed[side / 2] += self.emitted[side];
            }
            let mut sum = Bounced {
                received: vec![0.0; self.incident.len()],
                soil: vec![0.0; OPEN_SOIL + 1],
                sky: 0.0,
                from_soil: 0.0,
            };
            for from in (0..self.ways.len()).step_by(AT_ONCE) {
                let count = AT_ONCE.min(self.ways.len() - from);
                let bounced =
                    map_indexed(run.executor, count, |k| self.bounce_of(from + k, (&unit, flat), run));
                for bounced in bounced {
                    let Some(bounced) = bounced? else { continue };
                    add(&mut sum.received, &bounced.received);
                    add(&mut sum.soil, &bounced.soil);
                    sum.sky += bounced.sky;
                    sum.from_soil += bounced.from_soil;
                }
            }
            let from_soil = self.soil_sent() - sum.from_soil;
            let left = if pass == bounces { self.would_send(&sum) } else { 0.0 };
            // Light that remains is distributed as that of this bounce was.
            let factor = if left > 0.0 && left < sent { sent / (sent - left) } else { 1.0 };
            self.reflected += factor * (sum.sky + from_soil.max(0.0));
            self.settle(&sum.received, &sum.soil, factor);
            self.soil_emitted[OPEN_SOIL] = 0.0;
            if pass == bounces && factor > 1.0 {
                self.emitted.fill(0.0);
                self.soil_emitted.fill(0.0);
            }
        }
        self.lost = self.sent();
        Ok(())
    }

    fn bounce_of(
        &self,
        row: usize,
        (unit, flat): (&[f64], f64),
        run: &Run<'_>,
    ) -> Result<Option<Bounced>, LightError> {
        let way = &self.ways[row];
        if way.solid_angle <= 0.0 {
            return Ok(None);
        }
        run.cancel.check()?;
        let again;
        let found = match &self.kept[row] {
            Some(kept) => kept,
            None => {
                again = way.lines.cross(self.scene, self.ground, run.cancel)?;
                &again
            }
        };
        let sides = Sides(&self.patches.of_triangle);
        let mut out = Bounced {
            received: vec![0.0; self.incident.len()],
            soil: vec![0.0; OPEN_SOIL + 1],
            sky: 0.0,
            from_soil: 0.0,
        };
        let weight = way.lines.area * way.solid_angle;
        let soil_weight = way.lines.horizontal_area() * way.solid_angle * way.to.y / flat;
        for (line, soil) in found.lines() {
            let (Some(first), Some(last)) = (line.first(), line.last()) else { continue };
            out.sky += unit[sides.upper(*first)] * weight;
            for pair in line.windows(2) {
                let (above, below) = (sides.lower(pair[0]), sides.upper(pair[1]));
                out.received[below] += unit[above] * weight;
                out.received[above] += unit[below] * weight;
            }
            let lowest = sides.lower(*last);
            out.soil[soil] += unit[lowest] * weight;
            let up = self.soil_emitted[soil] * soil_weight;
            out.received[lowest] += up;
            out.from_soil += if soil == OPEN_SOIL { 0.0 } else { up };
        }
        Ok(Some(out))
    }

    /// Adds the light that arrived, `factor` times, and turns it into the light that is scattered next.
    fn settle(&mut self, arrived: &[f64], soil: &[f64], factor: f64) {
        for (patch, receiver) in self.patches.receiver.iter().enumerate() {
            let optics = self.scene.receivers[*receiver as usize];
            let (front, back) = (arrived[2 * patch], arrived[2 * patch + 1]);
            self.absorbed[patch] += factor * (1.0 - optics.scattered()) * (front + back);
            self.emitted[2 * patch] = optics.reflectance * front + optics.transmittance * back;
            self.emitted[2 * patch + 1] = optics.reflectance * back + optics.transmittance * front;
        }
        for (sum, more) in self.incident.iter_mut().zip(arrived) {
            *sum += factor * more;
        }
        let cell = self.ground.cell_area();
        for (emitted, arrived) in self.soil_emitted[..OPEN_SOIL].iter_mut().zip(soil) {
            self.soil_absorbed += factor * (1.0 - self.spec.soil_reflectance) * arrived;
            *emitted = self.spec.soil_reflectance * arrived / cell;
        }
    }

    /// Returns the light that is scattered now, by surfaces and by the soil around them.
    fn sent(&self) -> f64 {
        self.emitted.iter().sum::<f64>() + self.soil_sent()
    }

    fn soil_sent(&self) -> f64 {
        self.soil_emitted[..OPEN_SOIL].iter().sum::<f64>() * self.ground.cell_area()
    }

    /// Returns the light that would be scattered of what arrived.
    fn would_send(&self, arrived: &Bounced) -> f64 {
        let sides = arrived.received.chunks_exact(2).zip(&self.patches.receiver);
        let surfaces: f64 =
            sides.map(|(s, r)| self.scene.receivers[*r as usize].scattered() * (s[0] + s[1])).sum();
        surfaces + self.spec.soil_reflectance * arrived.soil[..OPEN_SOIL].iter().sum::<f64>()
    }

    fn finish(self, beams: &Beams) -> Absorption {
        let mut receivers = vec![ReceiverLight::default(); self.scene.receivers.len()];
        for (k, corners) in self.scene.triangles.iter().enumerate() {
            let area = 0.5 * self.scene.normal(k).length();
            let height = corners.iter().map(|i| self.scene.points[*i as usize].y).sum::<f64>() / 3.0;
            let receiver = &mut receivers[self.scene.owners[k] as usize];
            receiver.area_m2 += area;
            receiver.height_m += area * height;
        }
        for (patch, owner) in self.patches.receiver.iter().enumerate() {
            let receiver = &mut receivers[*owner as usize];
            receiver.incident_w += self.incident[2 * patch] + self.incident[2 * patch + 1];
            receiver.absorbed_w += self.absorbed[patch];
        }
        for ((receiver, [lit, all]), crossings) in receivers.iter_mut().zip(&self.sunlit).zip(&self.crossings)
        {
            receiver.height_m /= if receiver.area_m2 > 0.0 { receiver.area_m2 } else { 1.0 };
            receiver.sunlit = (*all > 0.0).then(|| lit / all);
            receiver.crossings = *crossings;
        }
        let cell = self.spec.repeat_m.map(|[w, d]| w * d);
        let horizontal = beams.horizontal();
        let balance = cell.map(|cell| EnergyBalance {
            incoming_w: cell * horizontal,
            absorbed_w: self.absorbed.iter().sum(),
            soil_w: self.soil_absorbed,
            reflected_w: self.reflected,
            lost_w: self.lost,
        });
        let directions = self.ways.iter().zip(&self.shadows).map(|(way, shadows)| {
            let outline_m2 = *shadows as f64 * way.lines.area;
            let transmitted = cell.map(|cell| 1.0 - outline_m2 / (way.to.y * cell));
            DirectionLight { to: way.to, horizontal: way.horizontal, outline_m2, transmitted }
        });
        Absorption {
            directions: directions.collect(),
            receivers,
            patches: self
                .patches
                .area
                .iter()
                .zip(&self.absorbed)
                .map(|(area, absorbed)| PatchLight { area_m2: *area, absorbed_w: *absorbed })
                .collect(),
            patch_of_triangle: self.patches.of_triangle,
            horizontal,
            intercepted_w: self.intercepted,
            balance,
        }
    }
}

/// Least cosine between a sunbeam and a normal: a surface at a more grazing angle counts as unseen.
const GRAZING: f64 = 0.01;
