//! Flowers on cones (He and Cheng 2021, section 5.1; docs/papers.md).
//!
//! `FlowerReading -> cone (nested ones for inner whorls) -> petals, disc, stamens`

use base::{Draw, ops};
use geom::{Cone, ConeSheet, FlowerCone, flower_cone, pca2};
use glam::{DVec2, DVec3};
use plant::{AxisKind, Blade, Flower, FlowerId, Frame, Lift, NodeId, Organ, OrganKind, Plant, Relief, Shape};
use reading::{BladeReading, FlowerReading};

use super::axes::{Part, key_of};
use super::fruit::{Profile, profile};
use super::leaf::LocalBlade;
use super::scene::{Bearing, Scene, around_one, drawn_light, sane, usable, usual_colour};

/// Half opening of a flower whose drawing does not show it (60 degrees).
const OPEN: f64 = ops::PI / 3.0;
/// Factor by which the opening shrinks from whorl to whorl inwards.
const STEEPER: f64 = 0.78;
/// Below this the axis lies in the drawing plane and petals alternate between front and back.
const SIDEWAYS: f64 = 0.08;
/// A petal that would become longer than this many times its drawn length is tilted instead.
const STEEPEST: f64 = 1.7;
/// Greatest length of a petal relative to the longest drawn one.
const LONGER: f64 = 1.5;
/// Depth by which a petal may always rise, as a share of the longest drawn one.
const LEAST_DEPTH: f64 = 0.8;
/// Radius of the inside of a bell, as a share of that of its outside.
const INSIDE: f64 = 0.93;
/// Largest slope of a bell's axis out of the drawing.
const LEAN: f64 = 0.35;
/// Least and greatest angle of the fan of petals of a flower in profile, radians: from nearly closed to flat.
const PROFILE_FAN: [f64; 2] = [0.25, 3.0];
/// Most tips that are too few to show the ellipse of a rim.
const FEW_TIPS: usize = 4;
/// Share of their distance from the petals behind them that petals at the flanks keep.
const AT_FLANKS: f64 = 0.2;
/// First key of petals that the drawing does not show.
const BEHIND: u64 = 1 << 32;
/// Distance in depth of neighbouring petals, share of a petal's length: less would flicker.
const APART: f64 = 0.015;

/// A flower during construction: everything in metres.
struct Corolla {
    /// Drawn middle.
    centre: DVec2,
    fit: FlowerCone,
    /// Mean length of petals in the drawing.
    petal: f64,
    /// Length of the longest petal in the drawing.
    longest: f64,
    /// Mean distance of tips from the middle.
    reach: f64,
    /// Mean distance of roots from the middle.
    rim: f64,
    facing: f64,
}

impl Corolla {
    /// Returns the nested cone of a whorl: same apex and axis, steeper from ring to ring.
    fn cone(&self, whorl: u32) -> Cone {
        let steep = ops::powf(STEEPER, f64::from(whorl.min(8)));
        let half_angle = (self.fit.cone.half_angle * steep).max(0.2).min(self.fit.cone.half_angle);
        Cone { half_angle, ..self.fit.cone }
    }

    /// Whether its axis lies in the plane of the drawing.
    const fn is_in_profile(&self) -> bool {
        self.fit.cone.axis.z.abs() < SIDEWAYS
    }

    fn cot(&self) -> f64 {
        let (s, c) = ops::sin_cos(self.fit.cone.half_angle);
        if s > 1e-9 { (c / s).clamp(0.0, 6.0) } else { 6.0 }
    }
}

/// Adds a drawn flower: petals, disc, stamens; and a stalk if its stem ends short of it.
pub(crate) fn place_flower(
    plant: &mut Plant,
    scene: &Scene<'_>,
    index: usize,
    flower: &FlowerReading,
    seat: Option<(Bearing, DVec3)>,
) {
    if !usable(flower.centre) {
        return;
    }
    let bearing = match seat {
        Some((b, _)) => Some(b),
        None => scene.bearing(plant, flower.bearer),
    };
    let mut at = scene.seat(flower.centre, bearing.as_ref());
    if let Some((_, given)) = seat {
        at.z = given.z;
    }
    // The key does not use the stroke of a petal: the flower stays the same without it.
    let key = key_of(Part::Flower, None, index as u64, bearing.map_or(0, |b| b.key));
    let link = key_of(Part::Link, None, 0, key);
    let bearer = scene.stalk(plant, bearing.as_ref(), flower.centre, at, AxisKind::Stem, link);
    let facing = !u32::try_from(index).is_ok_and(|i| scene.spec.flipped_flowers.contains(&i));
    let corolla = corolla(scene, flower, at, facing);
    let mut whorls: Vec<u32> = flower.petals.iter().map(|p| p.whorl).collect();
    base::sort_by_key(&mut whorls, |w| *w);
    whorls.dedup();
    plant.flowers.push(Flower {
        bearer,
        centre: corolla.fit.cone.apex,
        axis: corolla.fit.cone.axis,
        half_angle: corolla.fit.cone.half_angle.clamp(0.0, ops::FRAC_PI_2),
        whorls: u32::try_from(whorls.len()).unwrap_or(u32::MAX),
    });
    let usual = usual_colour(flower.petals.iter()).or(scene.petals);
    let part = Organs { plant, scene, flower: FlowerId::new(0), bearer, key, color: None, usual };
    let id = FlowerId::new(part.plant.flowers.len() - 1);
    let mut part = Organs { flower: id, ..part };
    if let Some(petal) = bell(flower) {
        part.bell(petal, at);
        return;
    }
    for (ring, &whorl) in whorls.iter().enumerate() {
        part.whorl(flower, &corolla, whorl, u32::try_from(ring).unwrap_or(u32::MAX));
    }
    part.centre(flower, &corolla);
}

/// Returns the corolla of a flower that was drawn in profile in one outline: united petals.
fn bell(flower: &FlowerReading) -> Option<&BladeReading> {
    let [petal] = &flower.petals[..] else { return None };
    let is_alone = flower.disc.is_none() && flower.stamens.is_empty();
    (is_alone && usable(petal.root)).then_some(petal)
}

/// Returns the cone of a flower seated at `at`, metres.
fn corolla(scene: &Scene<'_>, flower: &FlowerReading, at: DVec3, facing: bool) -> Corolla {
    let s = scene.map.metres_per_ink;
    let centre = at.truncate();
    let place = |p: DVec2| centre + (p - flower.centre) * s;
    let outer = flower.petals.iter().map(|p| p.whorl).min().unwrap_or(0);
    let outer: Vec<&BladeReading> =
        flower.petals.iter().filter(|p| p.whorl == outer && usable(p.tip) && usable(p.root)).collect();
    let tips: Vec<DVec2> = outer.iter().map(|p| place(p.tip)).collect();
    #[expect(clippy::cast_precision_loss, reason = "petals")]
    let n = outer.len().max(1) as f64;
    let reach = tips.iter().map(|t| t.distance(centre)).sum::<f64>() / n;
    let petal = outer.iter().map(|p| p.tip.distance(p.root) * s).sum::<f64>() / n;
    let longest = outer.iter().map(|p| p.tip.distance(p.root) * s).fold(0.0, f64::max);
    let disc = flower.disc.map_or(0.0, |d| if d.radius.is_finite() { d.radius.abs() * s } else { 0.0 });
    let petal = if petal > 0.0 { petal } else { disc.max(0.02 * s) };
    let sound = |f: &FlowerCone| {
        f.cone.axis.is_finite()
            && (f.cone.axis.length() - 1.0).abs() < 1e-6
            && f.cone.half_angle > 0.0
            && f.cone.half_angle <= ops::FRAC_PI_2 + 1e-9
            && f.height.is_finite()
    };
    let z = if facing { 1.0 } else { -1.0 };
    let fitted = cone_in_profile(centre, &tips).or_else(|| flower_cone(centre, &tips, facing));
    let mut fit = fitted.filter(sound).unwrap_or_else(|| {
        // One or two petals are not enough to fit a cone: open, facing the viewer.
        let (sin, cos) = ops::sin_cos(OPEN);
        let cone = Cone { apex: DVec3::ZERO, axis: DVec3::Z * z, half_angle: OPEN };
        let radius = reach.max(1e-9);
        FlowerCone { cone, height: radius * cos / sin, radius, rho: 1.0 }
    });
    let mut corolla = Corolla {
        centre,
        fit,
        petal,
        longest: longest.max(petal),
        reach: reach.max(1e-12),
        rim: 0.0,
        facing: if fit.cone.axis.z < 0.0 { -1.0 } else { 1.0 },
    };
    // The ring of the roots, not the apex, sits on the stem: so the disc does.
    let rim = (outer.iter().map(|p| p.root.distance(flower.centre) * s).sum::<f64>() / n).min(reach);
    let back = fit.cone.axis.z * rim * corolla.cot();
    fit.cone.apex = centre.extend(at.z - back);
    corolla.fit = fit;
    corolla.rim = rim;
    corolla
}

/// Returns the cone of a flower in profile: its petals fan out to one side of its centre. It opens along the middle of
/// the fan, in the plane of the drawing. `None` if petals stand all round, or if their tips show the ellipse of a rim.
fn cone_in_profile(centre: DVec2, tips: &[DVec2]) -> Option<FlowerCone> {
    let ways: Vec<DVec2> = tips.iter().map(|t| *t - centre).collect();
    let middle = ways.iter().filter_map(|w| w.try_normalize()).sum::<DVec2>().try_normalize()?;
    let mut fan: Vec<(f64, DVec2)> =
        ways.iter().map(|w| (ops::atan2(middle.perp_dot(*w), middle.dot(*w)), *w)).collect();
    base::sort_by(&mut fan, |a, b| a.0.total_cmp(&b.0));
    let (first, last) = (fan.first()?.0, fan.last()?.0);
    let is_arc = fan.windows(3).all(|w| (w[1].1 - w[0].1).perp_dot(w[2].1 - w[1].1) > 0.0);
    if !(PROFILE_FAN[0]..PROFILE_FAN[1]).contains(&(last - first)) || (fan.len() > FEW_TIPS && !is_arc) {
        return None;
    }
    let axis = middle.rotate(base::turn::direction((first + last) / 2.0));
    // As deep as it is wide: if petals in the middle are as long as those at the flanks, they bend inwards.
    let height = ways.iter().map(|w| axis.dot(*w)).fold(0.0, f64::max);
    let radius = ways.iter().map(|w| axis.perp_dot(*w).abs()).fold(0.0, f64::max);
    let cone =
        Cone { apex: centre.extend(0.0), axis: axis.extend(0.0), half_angle: ops::atan2(radius, height) };
    Some(FlowerCone { cone, height, radius, rho: 0.0 })
}

/// Common data of the organs of one flower.
struct Organs<'a, 'b> {
    plant: &'a mut Plant,
    scene: &'a Scene<'b>,
    flower: FlowerId,
    bearer: Option<NodeId>,
    key: u64,
    /// Colour of the current petal.
    color: Option<[u8; 3]>,
    /// Colour of petals that were drawn in ink alone.
    usual: Option<[u8; 3]>,
}

impl Organs<'_, '_> {
    /// Returns the colour in which a petal was drawn, or that of its neighbours.
    fn colour_of(&self, petal: &BladeReading) -> Option<[u8; 3]> {
        petal.color.filter(|&c| drawn_light(c).is_some()).or(self.usual)
    }

    fn push(&mut self, kind: OrganKind, shape: Shape, frame: Frame, key: u64, source: Option<u32>) {
        let shape = self.plant.add_shape(shape);
        let petal = kind == OrganKind::Petal;
        let paint = self.scene.paint(if petal { key } else { self.key }, self.color.filter(|_| petal));
        self.plant.organs.push(Organ {
            kind,
            bearer: self.bearer,
            flower: Some(self.flower),
            shape,
            frame,
            scale: 1.0,
            paint,
            key,
            source,
        });
    }

    /// Places the petals of one ring, in angular order.
    fn whorl(&mut self, flower: &FlowerReading, corolla: &Corolla, whorl: u32, ring: u32) {
        let cone = corolla.cone(ring);
        let middle = corolla.fit.cone.axis.truncate().try_normalize().unwrap_or(DVec2::Y);
        let mut petals: Vec<(f64, usize, &BladeReading)> = flower
            .petals
            .iter()
            .enumerate()
            .filter(|(_, p)| p.whorl == whorl && usable(p.tip) && usable(p.root))
            .map(|(i, p)| {
                let d = p.tip - flower.centre;
                // From the flower's own direction, so that a sideways flower is ordered from flank to flank.
                (ops::atan2(middle.perp_dot(d), middle.dot(d)), i, p)
            })
            .collect();
        base::sort_by(&mut petals, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let front = petals
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.0.abs().total_cmp(&b.1.0.abs()))
            .map_or(0, |(rank, _)| rank);
        let count = petals.len();
        let s = self.scene.map.metres_per_ink;
        // An inner ring's rim is lower as its petals are shorter.
        #[expect(clippy::cast_precision_loss, reason = "petals")]
        let reach =
            petals.iter().map(|p| p.2.tip.distance(flower.centre) * s).sum::<f64>() / count.max(1) as f64;
        let height =
            corolla.fit.height * if ring == 0 { 1.0 } else { (reach / corolla.reach).clamp(0.1, 1.0) };
        for (rank, &(angle, i, petal)) in petals.iter().enumerate() {
            let tip = corolla.centre + (petal.tip - flower.centre) * s;
            // As the drawing shows, or else alternating.
            let even = rank.abs_diff(front).is_multiple_of(2);
            let even = petal.front.map_or(even, |f| f >= 0.0);
            let sheet = if corolla.is_in_profile() {
                if even { ConeSheet::Near } else { ConeSheet::Far }
            } else {
                cone.sheet_for_tip(tip, height)
            };
            let last_odd = count % 2 == 1 && count > 1 && rank + 1 == count;
            let by_turns = if last_odd { 2.0 } else { f64::from(u8::from(!even)) };
            let step = petal.front.map_or(by_turns, |f| 1.0 + sane(f, 1.0) * corolla.facing);
            let mut lift = step * APART * corolla.petal;
            if corolla.is_in_profile() {
                // Petals at the flanks meet those behind them.
                let out = (1.0 - angle.abs() / cone.half_angle).max(AT_FLANKS);
                lift *= if sheet == ConeSheet::Near { out } else { -out } * corolla.facing;
            }
            let rank = flower.petals[..i].iter().filter(|p| p.source == petal.source).count();
            let key = key_of(Part::Petal, petal.source, rank as u64, self.key);
            self.petal(flower, petal, corolla, (cone, sheet), lift, key);
            // The half of the corolla that the drawing does not show.
            if corolla.is_in_profile() {
                let key = key_of(Part::Petal, petal.source, rank as u64 + BEHIND, self.key);
                self.petal(flower, petal, corolla, (cone, sheet.opposite()), -lift, key);
            }
        }
    }

    /// Places a bell or tube: the outline turned about its middle, open at the far end, with a wall.
    fn bell(&mut self, petal: &BladeReading, at: DVec3) {
        let outline: Vec<DVec2> = petal.outline.iter().copied().filter(|&p| usable(p)).collect();
        let Some(all) = pca2(&outline) else { return };
        let Some(along) = (all.centre - petal.root).try_normalize() else { return };
        let Some(Profile { rings, low, aside, .. }) = profile(&outline, all.centre, along) else { return };
        let s = self.scene.map.metres_per_ink;
        // Without its far pole the body is open there; the inside follows the outside.
        let outer = &rings[..rings.len() - 1];
        let inner = outer.iter().rev().map(|r| DVec2::new(INSIDE * r.x, r.y));
        let profile: Vec<DVec2> = outer.iter().copied().chain(inner).map(|r| r * s).collect();
        let root = all.centre + along * low + along.perp() * aside;
        let shift = self.scene.map.plant_from_ink(root) - self.scene.map.plant_from_ink(petal.root);
        let key = key_of(Part::Petal, petal.source, 0, self.key);
        let lean = self.scene.seed.child(key).stream(Draw::Curl).range(-LEAN, LEAN);
        let frame = Frame::looking(at + shift.extend(0.0), along.extend(lean).normalize(), DVec3::Z);
        self.color = self.colour_of(petal);
        self.push(OrganKind::Petal, Shape::Revolution { profile }, frame, key, petal.source);
    }

    fn petal(
        &mut self,
        flower: &FlowerReading,
        petal: &BladeReading,
        corolla: &Corolla,
        (cone, sheet): (Cone, ConeSheet),
        lift: f64,
        key: u64,
    ) {
        let s = self.scene.map.metres_per_ink;
        let place = |p: DVec2| corolla.centre + (p - flower.centre) * s;
        let (root, tip) = (place(petal.root), place(petal.tip));
        let on_cone = |p: DVec2| p.extend(cone.depth(p, sheet));
        let (root3, tip3) = (on_cone(root), on_cone(tip));
        // The inner side faces the axis: it is the upper one.
        let out = (tip3 - cone.apex).try_normalize().unwrap_or(DVec3::Z);
        let inner = (cone.axis - out * cone.axis.dot(out)).try_normalize().unwrap_or(DVec3::Z);
        let mirrored = inner.z < 0.0;
        let Some(local) = LocalBlade::new(petal, s, mirrored, |of| self.scene.boldness(of)) else { return };
        let drawn = root.distance(tip).max(1e-12);
        let depth = |p: &DVec2| cone.depth(place(*p), sheet) - root3.z;
        let deepest = petal.outline.iter().map(|p| depth(p).abs()).fold(0.0, f64::max);
        // A petal may point at the viewer, but not be much longer than the longest that was drawn.
        let longest = LONGER * corolla.longest;
        let limit = (longest * longest - drawn * drawn).max(0.0).sqrt().max(LEAST_DEPTH * corolla.longest);
        let sound = root3.is_finite() && deepest.is_finite() && deepest <= limit;
        let origin_z = if root3.is_finite() { root3.z } else { cone.apex.z };
        let origin_z = origin_z.clamp(cone.apex.z - 3.0 * corolla.petal, cone.apex.z + 3.0 * corolla.petal);
        let frame = local.frame(root.extend(origin_z + lift * corolla.facing));
        let lift = if sound {
            let to = |v: DVec3| DVec3::new(v.dot(frame.right), v.dot(frame.along), v.dot(frame.normal));
            // The offset of neighbours moves the petal's cone with it.
            let apex = to(cone.apex - root.extend(root3.z));
            let sheet = if mirrored { sheet.opposite() } else { sheet };
            Lift::Cone { cone: Cone { apex, axis: to(cone.axis), half_angle: cone.half_angle }, sheet }
        } else {
            // Nearly along the line of sight the cone would stretch the petal without end.
            let rise = if tip3.is_finite() { (tip3.z - root3.z) / drawn } else { 0.0 };
            let rise = if rise.is_finite() { rise.clamp(-STEEPEST, STEEPEST) } else { 0.0 };
            Lift::Tilt { slope: DVec2::new(0.0, if mirrored { -rise } else { rise }) }
        };
        let mut curl = self.scene.seed.child(key).stream(Draw::Curl);
        let spec = &self.scene.spec.relief;
        // The normal of a petal seen edge-on lies in the drawing: only the part along the view may move.
        let seen = inner.z.abs().max(0.2);
        let relief = Relief {
            bend_a: sane(spec.petal_bend_a, 1.0) * seen * around_one(curl.uniform(), 0.35),
            bend_b: sane(spec.petal_bend_b, 1.0) * seen * around_one(curl.uniform(), 0.35),
            hollow: sane(spec.petal_hollow, 1.0) * seen * around_one(curl.uniform(), 0.25),
            fold: 0.0,
            wave: 0.012 * curl.uniform(),
            keep_length: false,
        };
        let blade = Blade {
            outline: local.outline,
            midrib: local.midrib,
            veins: local.veins,
            needles: None,
            lift,
            relief,
        };
        self.color = self.colour_of(petal);
        self.push(OrganKind::Petal, Shape::Blade(blade), frame, key, petal.source);
    }

    /// Places disc, stamens and pistil: as drawn, else those that such a flower has.
    fn centre(&mut self, flower: &FlowerReading, corolla: &Corolla) {
        let cone = corolla.fit.cone;
        let s = self.scene.map.metres_per_ink;
        let open = cone.axis.z.abs() > 0.35;
        let drawn = flower.disc.filter(|d| usable(d.centre) && d.radius.is_finite() && d.radius > 0.0);
        // Petals that begin on a ring leave room for as large a disc.
        let usual = (0.18 * corolla.petal).max(corolla.rim);
        let radius = drawn.map_or(usual, |d| (d.radius * s).min(1e6 * s));
        let middle = drawn.map_or(corolla.centre, |d| corolla.centre + (d.centre - flower.centre) * s);
        // As high as the petals stand at its rim, or they would cover it.
        let rim = radius * corolla.cot().min(1.5);
        let top = cone.apex.z + cone.axis.z * rim;
        if drawn.is_some() || (open && !flower.petals.is_empty()) {
            let origin = middle.extend(top);
            let frame = facing_frame(origin, cone.axis);
            let height_m = 0.42 * radius;
            let key = key_of(Part::Disc, drawn.and_then(|d| d.source), 0, self.key);
            let source = drawn.and_then(|d| d.source);
            self.push(OrganKind::Disc, Shape::Dome { radius_m: radius, height_m }, frame, key, source);
        }
        if flower.stamens.iter().any(|l| l.len() >= 2) {
            self.drawn_stamens(flower, corolla);
        } else if drawn.is_none() && !flower.petals.is_empty() {
            self.default_stamens(corolla, if open { 0.42 * radius } else { 0.0 });
        }
    }

    fn drawn_stamens(&mut self, flower: &FlowerReading, corolla: &Corolla) {
        let s = self.scene.map.metres_per_ink;
        let fit = corolla.fit.cone;
        let inner = Cone { half_angle: (0.6 * fit.half_angle).max(0.1).min(fit.half_angle), ..fit };
        let limit = 1.5 * corolla.petal;
        for (i, line) in flower.stamens.iter().enumerate() {
            let mut path: Vec<DVec3> = Vec::with_capacity(line.len());
            for p in line.iter().filter(|p| usable(**p)) {
                let xy = corolla.centre + (*p - flower.centre) * s;
                let sheet = if fit.axis.z < 0.0 { ConeSheet::Far } else { ConeSheet::Near };
                let z = inner.depth(xy, sheet) - fit.apex.z;
                let z = if z.is_finite() { z.clamp(-limit, limit) } else { 0.0 };
                path.push(xy.extend(fit.apex.z + z));
            }
            path.dedup();
            let Some(&origin) = path.first().filter(|_| path.len() >= 2) else { continue };
            let key = key_of(Part::Stamen, None, i as u64, self.key);
            self.strand(OrganKind::Stamen, origin, &path, corolla.petal, key);
        }
    }

    /// Places a pistil and six stamens, about the axis.
    fn default_stamens(&mut self, corolla: &Corolla, raised: f64) {
        let cone = corolla.fit.cone;
        let base = cone.apex
            + cone.axis * (0.5 * raised)
            + DVec3::Z * (cone.axis.z * 0.18 * corolla.petal * corolla.cot().min(1.5));
        let side = facing_frame(base, cone.axis);
        let mut draw = self.scene.seed.child(self.key).stream(Draw::Phyllotaxis);
        let first = draw.range(0.0, ops::TAU);
        for i in 0..=6_u32 {
            let pistil = i == 0;
            let lean = if pistil { 0.0 } else { (0.45 * cone.half_angle).min(0.5) };
            let (s, c) = ops::sin_cos(first + f64::from(i) * ops::TAU / 6.0 + draw.range(-0.1, 0.1));
            let across = side.right * c + side.along * s;
            let long = corolla.petal * if pistil { 0.42 } else { draw.range(0.3, 0.36) };
            let path: Vec<DVec3> = (0..=5_i32)
                .map(|k| {
                    let t = f64::from(k) / 5.0;
                    let (s, c) = ops::sin_cos(lean * (0.5 + 0.5 * t));
                    let foot = if pistil { DVec3::ZERO } else { across * (0.05 * corolla.petal) };
                    base + foot + (cone.axis * c + across * s) * (long * t)
                })
                .collect();
            let kind = if pistil { OrganKind::Pistil } else { OrganKind::Stamen };
            let key = key_of(Part::Stamen, None, u64::from(i), self.key);
            self.strand(kind, path[0], &path, corolla.petal, key);
        }
    }

    fn strand(&mut self, kind: OrganKind, origin: DVec3, path: &[DVec3], petal: f64, key: u64) {
        let thick = petal * if kind == OrganKind::Pistil { 0.016 } else { 0.009 };
        let last = path.len().saturating_sub(1).max(1);
        #[expect(clippy::cast_precision_loss, reason = "points of one strand")]
        let radius_m = (0..path.len()).map(|i| thick * ops::lerp(1.0, 0.7, i as f64 / last as f64)).collect();
        let shape = Shape::Strand {
            path: path.iter().map(|&p| p - origin).collect(),
            radius_m,
            knob_m: petal * if kind == OrganKind::Pistil { 0.035 } else { 0.028 },
        };
        let frame = Frame { origin, right: DVec3::X, along: DVec3::Y, normal: DVec3::Z };
        self.push(kind, shape, frame, key, None);
    }
}

/// Returns a frame whose normal is `axis`.
fn facing_frame(origin: DVec3, axis: DVec3) -> Frame {
    let up = DVec3::Y - axis * axis.y;
    let along = up.try_normalize().filter(|_| up.length_squared() > 1e-6).unwrap_or_else(|| {
        let flat = DVec3::X - axis * axis.x;
        flat.try_normalize().unwrap_or(DVec3::Z)
    });
    Frame { origin, right: along.cross(axis), along, normal: axis }
}
