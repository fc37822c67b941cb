//! Leaves with the veins of their kind, and petals: colour, relief and transmission. u across with the midrib at one
//! half, v from the tip (0) down to the root (1), as in [`BladeChart`].

use base::{Cancelled, Digest, Executor, Run, map_indexed, ops};
use glam::DVec2;
use plant::{Blade, BladeVein};

use super::blades::{LeafInks, PetalInks, petal};
use super::noise::{Plates, gradient, octaves};
use super::relief::{Sheet, Spot, Surface, surface};
use super::{line, mix, shade, whole};
use crate::BladeChart;
use crate::natural::VeinPattern;

/// Roughness of the glossiest leaf material; those of a surface are shares of it.
pub(crate) const LEAF_ROUGHNESS: f32 = 0.7;

/// Height of a leaf's relief relative to its length.
pub(super) const LEAF_DEPTH: f64 = 0.010;

/// Paints the surface of a leaf: `size` pixels from root to tip, 64 to 4096, and as wide as the blade is.
pub(crate) fn leaf(
    venation: VeinPattern,
    blade: &Blade,
    inks: &LeafInks,
    size: u32,
    run: &Run<'_>,
) -> Result<Surface, Cancelled> {
    let mut content = Digest::new();
    content
        .add("leaf")
        .add(&(venation as u32))
        .add(&size)
        .add(&blade.outline)
        .add(&blade.midrib)
        .add(&blade.veins);
    content.add(&inks.dark).add(&inks.light).add(&inks.vein);
    Surface::kept(content, || {
        let plan = Plan::new(venation, blade, run.executor);
        let width = match plan.extent.x / plan.extent.y {
            wide if wide > 0.7 => size,
            wide if wide > 0.3 => size / 2,
            _ => size / 4,
        };
        let sheet = Sheet {
            size: (width, size),
            extent: (plan.extent.x, plan.extent.y),
            depth: LEAF_DEPTH * plan.extent.y,
            tiles: false,
            mean: None,
        };
        surface(run, &sheet, true, &|u, v| plan.spot(inks, u, v))
    })
}

/// Returns a blade for leaves whose own outline is not needed: drawn leaves differ, and all share one surface.
pub(crate) fn any_blade() -> Blade {
    let right = (1..12).map(|k| {
        let t = f64::from(k) / 12.0;
        DVec2::new(0.60 * (t * (1.0 - t)).sqrt(), t)
    });
    let mut outline = vec![DVec2::ZERO];
    outline.extend(right.clone());
    outline.push(DVec2::Y);
    outline.extend(right.rev().map(|p| DVec2::new(-p.x, p.y)));
    Blade {
        outline,
        midrib: vec![DVec2::ZERO, DVec2::Y],
        veins: Vec::new(),
        needles: None,
        lift: plant::Lift::Flat,
        relief: plant::Relief::default(),
    }
}

/// A vein: its line, and half of its width at the beginning and at the end.
struct Vein {
    points: Vec<DVec2>,
    width: (f64, f64),
}

/// Positions of the veins of a blade.
pub(super) struct Plan {
    venation: VeinPattern,
    pub(super) chart: BladeChart,
    /// Extent of the chart, in units of the blade.
    pub(super) extent: DVec2,
    low: f64,
    /// Half of the blade's width at even steps from its lowest place to its highest.
    half: Vec<f64>,
    fields: Fields,
    net: Plates,
}

/// Distances from veins in the cells of a grid over the chart.
struct Fields {
    size: (usize, usize),
    /// Distance to the nearest thick or side vein in units of the blade's length, minus its half width, and that width.
    near: Vec<[f64; 2]>,
}

const STEPS: usize = 64;

/// Half of a side vein's width at its beginning and at its end, as shares of the blade's length.
const SIDE_VEIN: (f64, f64) = (0.0058, 0.0012);
/// Distance from the midrib, as a share of the blade's length, within which a vein is extended to begin on it.
const LED_ON: f64 = 0.12;
/// Largest share of a vein that may cross the midrib and still counts as its beginning.
const RUN_OVER: f64 = 0.2;

impl Plan {
    pub(super) fn new(venation: VeinPattern, blade: &Blade, executor: &dyn Executor) -> Self {
        let chart = BladeChart::new(blade);
        let (from, to) = (chart.place(DVec2::new(0.0, 1.0)), chart.place(DVec2::new(1.0, 0.0)));
        let middle = chart.place(DVec2::new(0.5, 1.0)).x;
        let low = from.y;
        let extent = DVec2::new(2.0 * (middle - from.x).abs(), to.y - from.y).max(DVec2::splat(1e-9));
        let half = (0..=STEPS).map(|k| half_width(blade, low + extent.y * k as f64 / STEPS as f64)).collect();
        let mut plan = Self {
            venation,
            chart,
            extent,
            low,
            half,
            fields: Fields { size: (1, 1), near: vec![[1.0, 0.001]] },
            net: Plates::new((36, 36), 0.95, 71),
        };
        let veins = plan.veins(blade);
        plan.fields = Fields::new(&plan, &veins, executor);
        plan
    }

    /// Returns half of the width at a height.
    fn half_at(&self, y: f64) -> f64 {
        let at = ((y - self.low) / self.extent.y).clamp(0.0, 1.0) * STEPS as f64;
        let k = whole(at).min(STEPS - 1);
        ops::lerp(self.half[k], self.half[k + 1], at - k as f64)
    }

    fn veins(&self, blade: &Blade) -> Vec<Vein> {
        let length = self.extent.y;
        if matches!(self.venation, VeinPattern::Needle) || blade.midrib.len() < 2 {
            return Vec::new();
        }
        let mut veins = vec![Vein { points: blade.midrib.clone(), width: (0.011 * length, 0.002 * length) }];
        match self.venation {
            _ if !blade.veins.is_empty() => {
                veins.extend(blade.veins.iter().flat_map(|v| self.drawn(v, &blade.midrib)))
            }
            VeinPattern::Pinnate => {
                let lobes = tips(blade, |p| p.x);
                if lobes.len() >= 2 {
                    self.to_tips(&lobes, &mut veins);
                } else {
                    self.feathered(&mut veins);
                }
            }
            VeinPattern::Compound => {
                let leaflets = tips(blade, |p| p.x);
                self.to_tips(&leaflets, &mut veins);
                self.branched(blade, 1, 5, &mut veins);
            }
            VeinPattern::Palmate => {
                let lobes = tips(blade, |p| p.length());
                for tip in lobes.into_iter().filter(|p| p.x > 0.05 * length) {
                    for side in [1.0, -1.0] {
                        let end = DVec2::new(0.95 * side * tip.x, 0.95 * tip.y);
                        let points = curve(DVec2::ZERO, end * DVec2::new(0.52, 0.46), end);
                        veins.push(Vein { points, width: (0.009 * length, 0.0016 * length) });
                    }
                }
                self.branched(blade, 0, 6, &mut veins);
            }
            VeinPattern::Parallel | VeinPattern::Needle => {}
        }
        veins
    }

    /// Converts a drawn vein, from the midrib outwards: into two if it crosses the midrib, unless an end only
    /// overshoots it; one that begins near the midrib is extended to it.
    fn drawn(&self, vein: &BladeVein, midrib: &[DVec2]) -> Vec<Vein> {
        let line = &vein.line;
        let across = line.windows(2).enumerate().find_map(|(k, w)| {
            let way = w[1] - w[0];
            Some((k, w[0] + way * hit(w[0], way, 1.0, midrib)?))
        });
        let lines = match across {
            Some((k, at)) => {
                let outwards = |side: &mut dyn Iterator<Item = &DVec2>| -> Vec<DVec2> {
                    core::iter::once(at).chain(side.copied()).collect()
                };
                let sides = [outwards(&mut line[..=k].iter().rev()), outwards(&mut line[k + 1..].iter())];
                let least = RUN_OVER * geom::polyline_length(line);
                sides.into_iter().filter(|side| geom::polyline_length(side) > least).collect()
            }
            None => vec![self.led_on(line, midrib)],
        };
        let width = |share: f64| share * vein.boldness * self.extent.y;
        let width = (width(SIDE_VEIN.0), width(SIDE_VEIN.1));
        lines.into_iter().map(|points| Vein { points, width }).collect()
    }

    /// Converts a vein that does not cross the midrib, from the end nearer to it, and from the midrib itself if that is
    /// near.
    fn led_on(&self, line: &[DVec2], midrib: &[DVec2]) -> Vec<DVec2> {
        let mut points = line.to_vec();
        let to_midrib =
            |p: Option<&DVec2>| geom::closest_on_polyline(midrib, *p?).map(|c| (c.distance, c.point));
        let (mut first, last) = (to_midrib(points.first()), to_midrib(points.last()));
        if last.zip(first).is_some_and(|(last, first)| last.0 < first.0) {
            points.reverse();
            first = last;
        }
        let near = (LED_ON * self.extent.y).min(0.5 * geom::polyline_length(&points));
        if let Some((gap, nearest)) = first.filter(|(gap, _)| *gap < near) {
            points.insert(0, onwards(&points, gap, midrib).unwrap_or(nearest));
        }
        points
    }

    /// Adds side veins that leave the midrib and arch to the margin, those of both sides offset by half a step.
    fn feathered(&self, veins: &mut Vec<Vein>) {
        const EACH: u32 = 8;
        let length = self.extent.y;
        for k in 0..2 * EACH {
            let side = if k % 2 == 0 { 1.0 } else { -1.0 };
            let start = (0.03 + 0.84 * f64::from(k) / f64::from(2 * EACH)) * length;
            let mut high = start;
            for _ in 0..6 {
                high = start + 0.85 * self.half_at(self.low.max(0.0) + high);
            }
            let high = high.min(0.97 * length);
            let end = DVec2::new(side * 0.95 * self.half_at(high), high);
            let points =
                curve(DVec2::new(0.0, start), DVec2::new(0.58 * end.x, ops::lerp(start, high, 0.40)), end);
            veins.push(Vein { points, width: (SIDE_VEIN.0 * length, SIDE_VEIN.1 * length) });
        }
        // Lobes next to the stalk have veins of their own.
        if self.low < -0.01 * length {
            for side in [1.0, -1.0] {
                let end = DVec2::new(0.85 * side * self.half_at(0.5 * self.low), 0.6 * self.low);
                let points = curve(DVec2::ZERO, DVec2::new(0.6 * end.x, 0.1 * end.y), end);
                veins.push(Vein { points, width: (0.006 * length, 0.0012 * length) });
            }
        }
    }

    /// Adds side veins to the tips of lobes, and thinner ones between.
    fn to_tips(&self, tips: &[DVec2], veins: &mut Vec<Vein>) {
        let length = self.extent.y;
        for tip in tips {
            for side in [1.0, -1.0] {
                let start = (tip.y - 0.62 * tip.x).max(0.02 * length);
                let end = DVec2::new(0.96 * side * tip.x, tip.y - 0.02 * tip.x);
                let points = curve(
                    DVec2::new(0.0, start),
                    DVec2::new(0.5 * end.x, ops::lerp(start, end.y, 0.44)),
                    end,
                );
                veins.push(Vein { points, width: (0.0064 * length, 0.0014 * length) });
            }
        }
    }

    /// Adds side veins to those from the `from`th on, as far as the blade reaches.
    fn branched(&self, blade: &Blade, from: usize, each: u32, veins: &mut Vec<Vein>) {
        let length = self.extent.y;
        let mut more = Vec::new();
        for vein in &veins[from..] {
            let Some((&a, &b)) = vein.points.first().zip(vein.points.last()) else { continue };
            let along = b - a;
            for k in 0..2 * each {
                let side = if k % 2 == 0 { 1.0 } else { -1.0 };
                let share = 0.16 + 0.72 * f64::from(k) / f64::from(2 * each);
                let start = at_share(&vein.points, share);
                let way = along + side * DVec2::new(-along.y, along.x);
                let reach = 0.34 * (1.0 - 0.55 * share);
                let points = curve(
                    start,
                    start + 0.42 * reach * way + 0.03 * along,
                    start + reach * (way + 0.35 * along),
                );
                let within = points.iter().take_while(|p| geom::contains(&blade.outline, **p)).count();
                if within > 2 {
                    more.push(Vein {
                        points: points[..within].to_vec(),
                        width: (0.0038 * length, 0.001 * length),
                    });
                }
            }
        }
        veins.extend(more);
    }

    pub(super) fn spot(&self, inks: &LeafInks, u: f64, v: f64) -> Spot {
        let (x, y) = (2.0 * u - 1.0, 1.0 - v);
        let mottle = octaves(5.0 * u, 8.0 * v, (5, 8), 7, 3);
        let fine = gradient(61.0 * u, 83.0 * v, (61, 83), 8);
        if self.venation == VeinPattern::Needle {
            // Streaks that fan out with the needles; light towards the tips, which are the youngest.
            let fan = x / (0.35 + 0.65 * y);
            let streak = gradient(14.0 * fan + 40.0, 3.0 * y, (97, 3), 9);
            let paint = mix(inks.dark, inks.light, 0.30 + 0.35 * y + 0.30 * mottle + 0.18 * streak);
            return Spot { height: 0.5 + 0.25 * streak, paint, rough: 0.78 + 0.1 * fine, through: 0.35 };
        }
        let wander = 0.004 * gradient(9.0 * u, 13.0 * v, (9, 13), 3);
        let [off, width] = self.fields.interpolate(u + wander, v + wander);
        // On a vein, on the swelling next to it, and in the middle of a field between veins.
        let vein = 1.0 - ops::smoothstep(0.0, 1.0, (off + width) / (1.25 * width));
        let thick = (width / 0.009).min(1.0);
        let swell = ops::smoothstep(0.0, 0.045, off);
        let aspect = self.extent.x / self.extent.y;
        let (mut cross, mut rib) = (0.0, 0.0);
        if self.venation == VeinPattern::Parallel {
            let p = self.chart.place(DVec2::new(u, v));
            let across = p.x / self.half_at(p.y).max(1e-9 * self.extent.y);
            let phase = 9.0 * across;
            rib = (1.0 - ops::smoothstep(0.06, 0.26, (phase - phase.round()).abs())) * (1.0 - vein);
            let thin = 45.0 * across;
            rib = rib.max(0.35 * (1.0 - ops::smoothstep(0.1, 0.4, (thin - thin.round()).abs())));
        } else {
            let plate = self.net.plate_at(u * aspect + 0.006 * fine, v);
            cross = (1.0 - ops::smoothstep(0.0007, 0.0034, plate.edge)) * (0.45 + 0.55 * plate.border);
        }
        let side = vein * (0.45 + 0.55 * thick);
        let net = (0.30 * cross).max(0.42 * rib);
        let lamina = 0.36 + 0.26 * swell + 0.70 * mottle + 0.10 * y + 0.06 * fine - 0.06 * cross;
        let lamina = mix(inks.dark, inks.light, lamina);
        // Along a thick vein the blade is darker: it lies in its shade.
        let shadow = 1.0 - 0.13 * thick * (1.0 - ops::smoothstep(0.0, 0.018, off)) * (1.0 - vein);
        let paint = mix(mix(shade(lamina, shadow), inks.vein, 0.5 * net), inks.vein, 0.85 * side);
        let height = 0.42 + 0.36 * swell + 0.05 * fine + 0.05 * mottle
            - 0.36 * side
            - 0.22 * cross * swell
            - 0.30 * rib;
        let rough = 0.60 + 0.10 * mottle + 0.12 * side + 0.10 * net + 0.04 * fine;
        let through = 0.96 - 0.78 * side - 0.35 * net + 0.08 * mottle;
        Spot { height, paint, rough: rough / f64::from(LEAF_ROUGHNESS), through }
    }
}

impl Fields {
    fn new(plan: &Plan, veins: &[Vein], executor: &dyn Executor) -> Self {
        if veins.is_empty() {
            return Self { size: (1, 1), near: vec![[1.0, 0.001]] };
        }
        // As fine as the thinnest vein: between cells the distance is nearly linear.
        let size = (160, 320);
        let length = plan.extent.y;
        let pieces: Vec<(DVec2, DVec2, f64, f64)> = veins
            .iter()
            .flat_map(|vein| {
                let n = vein.points.len().max(2) - 1;
                let width = move |k: usize| ops::lerp(vein.width.0, vein.width.1, k as f64 / n as f64);
                vein.points.windows(2).enumerate().map(move |(k, w)| (w[0], w[1], width(k), width(k + 1)))
            })
            .collect();
        let rows = map_indexed(executor, size.1, |j| {
            let v = (j as f64 + 0.5) / size.1 as f64;
            let mut row = Vec::with_capacity(size.0);
            let y = plan.chart.place(DVec2::new(0.5, v)).y;
            // Only veins that may be nearest: one further away along the blade than this is not.
            let reach = 0.16 * length;
            let (lows, highs) = (y - reach, y + reach);
            let near: Vec<_> =
                pieces.iter().filter(|(a, b, ..)| a.y.max(b.y) > lows && a.y.min(b.y) < highs).collect();
            for i in 0..size.0 {
                let p = plan.chart.place(DVec2::new((i as f64 + 0.5) / size.0 as f64, v));
                let mut best = [1.0, 0.001];
                for &&(a, b, wa, wb) in &near {
                    let ab = b - a;
                    let t = ((p - a).dot(ab) / ab.length_squared().max(1e-18)).clamp(0.0, 1.0);
                    let width = ops::lerp(wa, wb, t);
                    let off = (p.distance(a + ab * t) - width) / length;
                    if off < best[0] {
                        best = [off, width / length];
                    }
                }
                row.push(best);
            }
            row
        });
        Self { size, near: rows.concat() }
    }

    fn interpolate(&self, u: f64, v: f64) -> [f64; 2] {
        let place = |x: f64, n: usize| {
            let at = (x * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
            let k = whole(at).min(n.saturating_sub(2));
            (k, (k + 1).min(n - 1), at - k as f64)
        };
        let (x0, x1, tx) = place(u, self.size.0);
        let (y0, y1, ty) = place(v, self.size.1);
        let at = |x: usize, y: usize| self.near[y * self.size.0 + x];
        let between = |k: usize| {
            let row = |y: usize| ops::lerp(at(x0, y)[k], at(x1, y)[k], tx);
            ops::lerp(row(y0), row(y1), ty)
        };
        [between(0), between(1)]
    }
}

/// Returns half of the blade's width at a height.
fn half_width(blade: &Blade, y: f64) -> f64 {
    let n = blade.outline.len();
    let edges = (0..n).map(|i| (blade.outline[i], blade.outline[(i + 1) % n]));
    let crossing = |(a, b): (DVec2, DVec2)| {
        ((a.y <= y) != (b.y <= y)).then(|| ops::lerp(a.x, b.x, (y - a.y) / (b.y - a.y)).abs())
    };
    edges.filter_map(crossing).fold(0.0, f64::max)
}

/// Returns the places of the right margin where `far` is larger than on both sides by a twentieth of the blade's width:
/// tips of lobes, from the root on. The widest place of a blade without lobes is one, too.
fn tips(blade: &Blade, far: fn(DVec2) -> f64) -> Vec<DVec2> {
    let widest = blade.outline.iter().map(|p| p.x).fold(0.0, f64::max);
    let least = 0.05 * widest;
    let right: Vec<DVec2> = blade.outline.iter().copied().filter(|p| p.x >= 0.0).collect();
    let mut tips: Vec<DVec2> = Vec::new();
    let (mut best, mut low) = (None::<DVec2>, 0.0_f64);
    for &p in &right {
        let here = far(p);
        match best {
            Some(b) if here > far(b) => best = Some(p),
            Some(b) if here < far(b) - least => {
                tips.push(b);
                (best, low) = (None, here);
            }
            None if here > low + least => best = Some(p),
            None => low = low.min(here),
            Some(_) => {}
        }
    }
    tips
}

/// Returns the place on the midrib from which a vein that begins `gap` away from it starts, by extending its direction
/// over its first `gap`.
fn onwards(vein: &[DVec2], gap: f64, midrib: &[DVec2]) -> Option<DVec2> {
    // Beyond this number of gaps it would run along the midrib.
    const FARTHEST: f64 = 3.0;
    let from = *vein.first()?;
    let way = (from - geom::point_at(vein, gap)?).try_normalize()?;
    hit(from, way, FARTHEST * gap, midrib).map(|far| from + way * far)
}

/// Returns the distance from a point along `way` to a line, in units of `way`, if at most `most`.
fn hit(from: DVec2, way: DVec2, most: f64, line: &[DVec2]) -> Option<f64> {
    let hits = line.windows(2).filter_map(|w| {
        let (along, across) = (w[1] - w[0], way.perp_dot(w[1] - w[0]));
        let (far, share) = ((w[0] - from).perp_dot(along) / across, (w[0] - from).perp_dot(way) / across);
        (across.abs() > 0.0 && (0.0..=most).contains(&far) && (0.0..=1.0).contains(&share)).then_some(far)
    });
    hits.min_by(f64::total_cmp)
}

/// Returns a curve from `a` to `b` that is drawn towards `pull`.
fn curve(a: DVec2, pull: DVec2, b: DVec2) -> Vec<DVec2> {
    let at = |k: u32| {
        let t = f64::from(k) / 12.0;
        a * ((1.0 - t) * (1.0 - t)) + pull * (2.0 * t * (1.0 - t)) + b * (t * t)
    };
    (0..=12).map(at).collect()
}

/// Returns the point at a share of the points of a line.
fn at_share(points: &[DVec2], share: f64) -> DVec2 {
    let last = points.len() - 1;
    let at = share.clamp(0.0, 1.0) * last as f64;
    let k = whole(at).min(last.saturating_sub(1));
    points[k].lerp(points[(k + 1).min(last)], at - k as f64)
}

/// Paints the surface of a petal, twice as long as it is wide; `size` pixels long.
pub(crate) fn petals(inks: &PetalInks, size: u32, run: &Run<'_>) -> Result<Surface, Cancelled> {
    let mut content = Digest::new();
    content.add("petal").add(&size);
    inks.each().iter().for_each(|ink| {
        content.add(ink);
    });
    Surface::kept(content, || {
        let sheet =
            Sheet { size: (size / 2, size), extent: (0.6, 1.0), depth: 0.006, tiles: false, mean: None };
        surface(run, &sheet, true, &|u, v| {
            let (paint, vein) = petal(inks, u, v);
            // Raised cells of the skin: velvet.
            let skin = gradient(97.0 * u, 193.0 * v, (97, 193), 81);
            let keel = line(2.0 * u - 1.0, 0.35) * v;
            Spot {
                height: 0.45 + 0.40 * vein + 0.04 * skin,
                paint,
                rough: (0.62 + 0.10 * vein + 0.05 * skin) / f64::from(LEAF_ROUGHNESS),
                through: 0.95 - 0.45 * vein - 0.35 * keel,
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::GREEN;
    use base::Serial;

    #[test]
    fn a_midrib_is_pale_and_thick_but_on_needles() {
        for venation in VeinPattern::ALL {
            let s = leaf(venation, &any_blade(), &GREEN, 256, &Run::plain()).expect("not cancelled");
            let (width, height) = (s.color.width, s.color.height);
            let column = |t: &mesh::Texture, x: u32, k: usize| {
                let sum = (height / 4..height * 3 / 4)
                    .map(|y| u32::from(t.pixels[4 * (y * width + x) as usize + k]));
                sum.sum::<u32>() / (height / 2)
            };
            let through = s.maps.through.as_ref().expect("a leaf is thin");
            let (middle, beside) = (width / 2, width * 5 / 8);
            let paler = column(&s.color, middle, 1) > column(&s.color, beside, 1) + 15;
            let thicker = column(through, middle, 3) + 30 < column(through, beside, 3);
            let veined = venation != VeinPattern::Needle;
            assert_eq!((paler, thicker), (veined, veined), "{venation:?}");
        }
    }

    #[test]
    fn drawn_veins_begin_on_the_midrib_and_are_as_bold_as_they_were_drawn() {
        let p = DVec2::new;
        // One from the margin to near the midrib, drawn lightly, and one that branches off far from it.
        let light = BladeVein { line: vec![p(0.25, 0.6), p(0.15, 0.5), p(0.04, 0.4)], boldness: 0.5 };
        let bold = BladeVein { line: vec![p(-0.2, 0.5), p(-0.28, 0.6)], boldness: 2.0 };
        let blade = Blade { veins: vec![light, bold], ..any_blade() };
        let veins = Plan::new(VeinPattern::Pinnate, &blade, &Serial).veins(&blade);
        assert_eq!(veins.len(), 3, "the midrib and what was drawn, nothing else");
        assert_eq!(veins[1].points[1..], [p(0.04, 0.4), p(0.15, 0.5), p(0.25, 0.6)]);
        let start = veins[1].points[0];
        assert!(start.distance(p(0.0, 0.4 - 0.04 / 1.1)) < 1e-12, "{start}: straight on");
        assert_eq!(veins[2].points[0], p(-0.2, 0.5));
        // Across the midrib: one on each side, but not for an end that only overshoots it.
        let plan = Plan::new(VeinPattern::Pinnate, &blade, &Serial);
        let of = |from: DVec2, to: DVec2| -> Vec<Vec<DVec2>> {
            let vein = BladeVein::from(vec![from, to]);
            plan.drawn(&vein, &blade.midrib).into_iter().map(|v| v.points).collect()
        };
        let (left, right, short) = (p(-0.2, 0.5), p(0.2, 0.3), p(-0.02, 0.41));
        assert_eq!(of(left, right), [[p(0.0, 0.4), left], [p(0.0, 0.4), right]]);
        let over = of(right, short);
        assert!(over.len() == 1 && over[0][0].x.abs() < 1e-12 && over[0][1] == right, "{over:?}");
        // A short one next to it does not begin on it.
        assert_eq!(of(p(0.1, 0.4), p(0.11, 0.45)), [[p(0.1, 0.4), p(0.11, 0.45)]]);
        assert!((veins[2].width.0 - 4.0 * veins[1].width.0).abs() < 1e-12);
    }

    #[test]
    fn side_veins_end_in_the_tips_of_lobes() {
        let mut lobed = any_blade();
        // Two lobes a side.
        let right =
            [(0.1, 0.05), (0.32, 0.3), (0.1, 0.42), (0.3, 0.66), (0.08, 0.8)].map(|(x, y)| DVec2::new(x, y));
        lobed.outline = core::iter::once(DVec2::ZERO)
            .chain(right)
            .chain([DVec2::Y])
            .chain(right.iter().rev().map(|p| DVec2::new(-p.x, p.y)))
            .collect();
        assert_eq!(tips(&lobed, |p| p.x), [DVec2::new(0.32, 0.3), DVec2::new(0.3, 0.66)]);
        assert!(tips(&any_blade(), |p| p.x).len() < 2, "an ellipse has no lobes");
        let plan = Plan::new(VeinPattern::Pinnate, &lobed, &Serial);
        let ends: Vec<DVec2> = plan.veins(&lobed).iter().filter_map(|v| v.points.last().copied()).collect();
        for tip in [DVec2::new(0.32, 0.3), DVec2::new(-0.3, 0.66)] {
            assert!(ends.iter().any(|e| e.distance(tip) < 0.03), "{tip} among {ends:?}");
        }
    }
}
