//! What surfaces absorb: first what light meets on its way, then what they throw at one another.
//!
//! Lines in the 46 directions of the turtle cross the scene. Light goes along them, in first order from the sky to what a line
//! meets first. What a patch throws back goes in equal shares along all lines that cross it, to what lies next on each: the
//! method of global lines (Sbert 1993; transillumination of Neumann 1995), here with the same lines for all bounces, so that
//! no energy is lost. A line crosses a patch in proportion to the area that it shows, which is Lambert's law.

use base::{Draw, Run, Seed, map_indexed};
use glam::{DVec2, DVec3};

use crate::lines::{Crossings, Ground, Lines, OPEN_SOIL};
use crate::scene::{Patches, check_range};
use crate::sky::turtle;
use crate::{Beams, LightError, LitScene};

/// How light is computed. Plain data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSpec {
    /// Lines in each direction over the scene or its cell, 1,000 to 4,194,304; about so many.
    pub lines: u32,
    /// How often light is followed after the first surface, 0 to 50. What is on its way after the last bounce is shared out as
    /// in that bounce; with 0 it counts as lost.
    pub bounces: u32,
    /// The share that the soil throws back, 0 to 1.
    pub soil_reflectance: f64,
    /// Height of the soil, metres. What lies below is in the dark.
    pub ground_m: f64,
    /// Width along X and depth along Z after which the scene repeats itself without end, metres, 0.001 to 10,000. None: it
    /// stands alone.
    pub repeat_m: Option<[f64; 2]>,
}

impl Default for LightSpec {
    fn default() -> Self {
        Self { lines: 1 << 18, bounces: 3, soil_reflectance: 0.1, ground_m: 0.0, repeat_m: None }
    }
}

impl LightSpec {
    fn check(&self) -> Result<(), LightError> {
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
    /// Of its triangles, one side, square metres.
    pub area_m2: f64,
    /// Of the middle of its area, metres.
    pub height_m: f64,
    /// What falls on both sides, first and scattered, W.
    pub incident_w: f64,
    /// What stays, W.
    pub absorbed_w: f64,
    /// The share of its area that is in the sun, 0 to 1; the mean over all suns. None without a sun, and where lines in its
    /// direction do not cross the receiver.
    pub sunlit: Option<f64>,
    /// How many lines cross it: by chance, figures are off by about one over its root.
    pub crossings: u64,
}

/// Light on a patch: up to 32 triangles of one receiver that follow one another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchLight {
    /// One side, square metres.
    pub area_m2: f64,
    /// What stays, W.
    pub absorbed_w: f64,
}

/// Where the light of a cell that repeats itself goes, W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// Into the cell, from above.
    pub incoming_w: f64,
    /// Stays on surfaces.
    pub absorbed_w: f64,
    /// Stays in the soil.
    pub soil_w: f64,
    /// Back to the sky.
    pub reflected_w: f64,
    /// On its way after the last bounce, if that was none.
    pub lost_w: f64,
}

/// What a scene shows to one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionLight {
    /// Towards the light.
    pub to: DVec3,
    /// What it gives a horizontal surface, W/m2.
    pub horizontal: f64,
    /// The outline that it throws a shadow with, across the direction, square metres; of a cell that repeats itself within
    /// the cell.
    pub outline_m2: f64,
    /// The share of lines that meet nothing on their way to the soil; of cells that repeat themselves alone.
    pub transmitted: Option<f64>,
}

/// What a scene absorbs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Absorption {
    /// A row for each of [`LitScene::receivers`].
    pub receivers: Vec<ReceiverLight>,
    /// What is lit as one.
    pub patches: Vec<PatchLight>,
    /// Of each triangle of the scene, its row of `patches`.
    pub patch_of_triangle: Vec<u32>,
    /// What light gives a horizontal surface above the scene, W/m2.
    pub horizontal: f64,
    /// What meets a surface on its way from the light, W.
    pub intercepted_w: f64,
    /// The balance of a scene that repeats itself.
    pub balance: Option<EnergyBalance>,
    /// The directions that were looked along: those of the sky and the others.
    pub directions: Vec<DirectionLight>,
}

/// So many directions are kept at once before they are added up, in their order.
const AT_ONCE: usize = 16;

/// What lines cross is kept from bounce to bounce up to so many bytes; what is more is found again.
const KEPT_BYTES: usize = 400_000_000;

/// Less than this share of all light is not followed any more.
const NEGLIGIBLE: f64 = 1e-6;

/// What each receiver and patch absorbs.
///
/// Guaranteed: the same bits for any executor. In a cell that repeats itself, incoming light is what is absorbed, thrown back and
/// left in the soil, to rounding. Not modelled: gloss, and what a part of a patch throws back more than another. An isolated
/// scene stands on soil that is lit as far as the scene does not shade it.
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

/// A direction that light comes from, or is thrown into.
#[derive(Clone, Debug)]
struct Way {
    to: DVec3,
    lines: Lines,
    /// What it gives a horizontal surface.
    horizontal: f64,
    /// Of the sky, steradians: light is thrown there, too. 0 for others.
    solid_angle: f64,
    is_sun: bool,
}

/// The directions of the sky as far as they matter, then the others.
fn ways(
    scene: &LitScene,
    ground: &Ground,
    beams: &Beams,
    (count, is_scattering): (u32, bool),
    seed: Seed,
) -> Vec<Way> {
    let sky =
        turtle().zip(beams.sky).map(|((to, solid_angle), horizontal)| (to, horizontal, solid_angle, false));
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
    /// The side that a line meets from the light.
    fn upper(&self, hit: u32) -> usize {
        2 * self.0[hit as usize / 2] as usize + (1 - (hit as usize & 1))
    }

    /// The side by which it leaves.
    fn lower(&self, hit: u32) -> usize {
        2 * self.0[hit as usize / 2] as usize + (hit as usize & 1)
    }
}

/// What one direction gives in first order.
struct First {
    incident: Vec<f64>,
    /// What of the sky each side shows to lines.
    outlet: Vec<f64>,
    /// What does not arrive in each cell of the soil.
    shaded: Vec<f64>,
    /// Of each receiver in the direction of a sun: the area that is lit, and all of it.
    sunlit: Vec<[f64; 2]>,
    crossings: Vec<u64>,
    shadows: usize,
    kept: Option<Crossings>,
}

/// What one direction gives in a bounce.
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
    /// Of each side, W: what fell on it, and what it throws back.
    incident: Vec<f64>,
    emitted: Vec<f64>,
    outlet: Vec<f64>,
    /// Of each patch.
    absorbed: Vec<f64>,
    sunlit: Vec<[f64; 2]>,
    crossings: Vec<u64>,
    intercepted: f64,
    /// What the soil throws back, W/m2, by cells; the last is the open.
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
                    // Of the triangle, the area that is seen between lines.
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
            // What no line of the sky crosses keeps what it has.
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
            // The light that is still on its way goes where that of this bounce went.
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

    /// Books what arrived, `factor` times, and makes of it what is thrown back next.
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

    /// What is thrown back now, by surfaces and by the soil around them.
    fn sent(&self) -> f64 {
        self.emitted.iter().sum::<f64>() + self.soil_sent()
    }

    fn soil_sent(&self) -> f64 {
        self.soil_emitted[..OPEN_SOIL].iter().sum::<f64>() * self.ground.cell_area()
    }

    /// What would be thrown back of what arrived.
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

/// The least cosine between a sunbeam and a normal: what is seen more from its edge counts as if it were not.
const GRAZING: f64 = 0.01;
