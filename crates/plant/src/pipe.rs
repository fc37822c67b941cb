//! Radii of axes by the pipe model (He and Cheng 2021, Eq 6) and the taper along an axis (Eq 7).
//!
//! `topology + tips carried -> radius at every node`

use base::ops;

use crate::{AxisId, AxisKind, OrganKind, Plant};

/// Eq 7: `r(x) / r(0) = (s^(-alpha x) + m) / (1 + m)`, x from 0 at the base to 1 at the tip.
///
/// ```
/// let taper = plant::Taper { s: 100.0, alpha: 0.5, m: 0.0 };
/// assert!((taper.ratio(1.0) - 0.1).abs() < 1e-12 && taper.ratio(0.0) == 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// Base of the power, above 1; at or below 1 the axis does not thin.
    pub s: f64,
    /// Rate of the thinning, above 0, about 0.3 to 0.5.
    pub alpha: f64,
    /// Offset, 0 or more, about 0 to 1; larger values keep the tip thicker.
    pub m: f64,
}

impl Taper {
    /// Returns the share of the base radius left at `x`, clamped to 0 to 1. In (0, 1], falling.
    pub fn ratio(&self, x: f64) -> f64 {
        let k = self.alpha.max(0.0) * ops::ln(self.s.max(1.0));
        let m = self.m.max(0.0);
        let ratio = (ops::exp(-k * x.clamp(0.0, 1.0)) + m) / (1.0 + m);
        if ratio.is_finite() { ratio.max(1e-6) } else { 1.0 }
    }
}

/// Settings for the radii of a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct PipeModel {
    /// The exponent t of `r^t = r_1^t + ... + r_m^t`, clamped to 1 to 4: 2 is Leonardo's rule, herbs 2.5 to 3.
    pub exponent: f64,
    /// Thinning between forks.
    pub taper: Taper,
    /// Least radius of an axis, metres (unless its bearer is thinner); leaf stalks may have 0.6 of it.
    pub min_radius_m: f64,
    /// Largest base radius of an axis as a share of its length; thicker axes are thinned to it.
    pub max_per_length: f64,
    /// Base radii of axes without a bearer, metres; an axis that is not listed gets 1/60 of its length.
    pub ground: Vec<(AxisId, f64)>,
    /// Drawn radii, one for each node of the axis; they are used unchanged.
    pub drawn: Vec<(AxisId, Vec<f64>)>,
}

/// Returns the weight of an axis of this kind at its own tip, relative to a shoot.
fn tip_weight(kind: AxisKind) -> f64 {
    // A leaf needs about a quarter of the pipes of a continuing shoot.
    if kind == AxisKind::Petiole { 0.25 } else { 1.0 }
}

/// Tips carried: by each axis as a whole, and from each node upwards along its own axis.
struct Carried {
    axis: Vec<f64>,
    above: Vec<f64>,
    /// Load borne at each node itself.
    here: Vec<f64>,
}

fn carried(plant: &Plant) -> Carried {
    let mut here = vec![0.0; plant.nodes.position.len()];
    for organ in &plant.organs {
        let weight = match organ.kind {
            OrganKind::Leaf => 0.25,
            OrganKind::Fruit | OrganKind::Syncarp | OrganKind::Body => 1.0,
            _ => 0.0,
        };
        if let Some(n) = organ.bearer.and_then(|n| here.get_mut(n.index())) {
            *n += weight;
        }
    }
    for flower in &plant.flowers {
        if let Some(n) = flower.bearer.and_then(|n| here.get_mut(n.index())) {
            *n += 1.0;
        }
    }
    let mut axis = vec![0.0; plant.axes.len()];
    let mut above = vec![0.0; here.len()];
    for (i, a) in plant.axes.iter().enumerate().rev() {
        let rows = a.nodes.start as usize..a.nodes.end as usize;
        let last = rows.end.checked_sub(1).and_then(|e| here.get(e)).copied().unwrap_or(0.0);
        let mut sum = (tip_weight(a.kind) - last).max(0.0);
        for node in rows.rev() {
            sum += here[node];
            above[node] = sum;
        }
        axis[i] = sum;
        // Roots and stubs draw nothing from the shoot.
        if let Some(b) = a.bearer.filter(|_| !matches!(a.kind, AxisKind::Root | AxisKind::Stub)) {
            here[b.index()] += sum;
        }
    }
    Carried { axis, above, here }
}

/// Sets the radius of every node of a sound plant.
///
/// At a fork, `r^t` below is the sum of `r^t` above (Eq 6), shared by the tips carried (leaves count a quarter);
/// between forks and to the tip an axis thins by Eq 7, as far as its forks have not thinned it already. An axis without
/// forks follows Eq 7 exactly; one whose load hangs at its end hardly thins.
/// Guaranteed: finite, above 0 where the base radii are, falling along every axis that was not drawn, and no axis
/// thicker at its base than its bearer there. Not guaranteed: Eq 6 where `min_radius_m` or `max_per_length` takes
/// effect. Cost: linear in nodes and organs.
///
/// ```
/// use glam::DVec3;
/// use plant::{AxisKind, PipeModel, Plant, Taper, pipe_radii};
/// let mut p = Plant::default();
/// let stem = p.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y], None);
/// let taper = Taper { s: 100.0, alpha: 0.5, m: 0.0 };
/// let model = PipeModel {
///     exponent: 2.0, taper, min_radius_m: 0.0, max_per_length: 1.0,
///     ground: vec![(stem, 0.02)], drawn: vec![],
/// };
/// pipe_radii(&mut p, &model);
/// assert!((p.axis_radii(stem)[1] - 0.002).abs() < 1e-12);
/// ```
pub fn pipe_radii(plant: &mut Plant, model: &PipeModel) {
    let t = if model.exponent.is_finite() { model.exponent.clamp(1.0, 4.0) } else { 2.0 };
    let load = carried(plant);
    let sound = |r: f64| if r.is_finite() { r.max(0.0) } else { 0.0 };
    let mut drawn: Vec<Option<&[f64]>> = vec![None; plant.axes.len()];
    for (id, radii) in &model.drawn {
        if let Some(slot) = drawn.get_mut(id.index()) {
            *slot = Some(radii);
        }
    }
    let mut ground: Vec<Option<f64>> = vec![None; plant.axes.len()];
    for &(id, r) in &model.ground {
        if let Some(slot) = ground.get_mut(id.index()) {
            *slot = Some(sound(r));
        }
    }
    let least = sound(model.min_radius_m);
    for i in 0..plant.axes.len() {
        let id = AxisId::new(i);
        let (kind, bearer) = (plant.axes[i].kind, plant.axes[i].bearer);
        let floor = least * if kind == AxisKind::Petiole { 0.6 } else { 1.0 };
        let rows = plant.axes[i].nodes.start as usize..plant.axes[i].nodes.end as usize;
        if let Some(radii) = drawn[i].filter(|r| r.len() == rows.len()) {
            plant.nodes.radius_m[rows].iter_mut().zip(radii).for_each(|(to, &r)| *to = sound(r));
            continue;
        }
        let places = shares_of_length(plant, id);
        let length = places.1;
        let base = match bearer {
            None => ground[i].unwrap_or(length / 60.0),
            Some(b) => {
                let below = plant.nodes.radius_m[b.index()];
                // A root next to the shoot takes half of the collar.
                let share = if kind == AxisKind::Root {
                    0.5
                } else {
                    ops::powf((load.axis[i] / load.above[b.index()].max(1e-12)).min(1.0), 1.0 / t)
                };
                let cap = sound(model.max_per_length) * length;
                (below * share).min(cap).max(floor).min(below)
            }
        };
        let rest = thinning_left(model.taper, &load, &rows, &places.0, t);
        let whole = load.above[rows.start].max(1e-12);
        for (k, node) in rows.enumerate() {
            let pipes = ops::powf((load.above[node] / whole).min(1.0), 1.0 / t);
            let taper = if rest > 0.0 { ops::powf(model.taper.ratio(places.0[k]), rest) } else { 1.0 };
            plant.nodes.radius_m[node] = sound(base * pipes * taper).max(floor.min(base));
        }
    }
}

/// Returns the position of each node as a share of its axis's length, and that length.
fn shares_of_length(plant: &Plant, id: AxisId) -> (Vec<f64>, f64) {
    let points = plant.axis_points(id);
    let mut at = Vec::with_capacity(points.len());
    let mut sum = 0.0;
    for (k, p) in points.iter().enumerate() {
        if k > 0 {
            sum += p.distance(points[k - 1]);
        }
        at.push(sum);
    }
    if sum > 0.0 {
        at.iter_mut().for_each(|a| *a /= sum);
    }
    (at, sum)
}

/// Returns the factor on the exponent of Eq 7 for one axis, 0 to 1: the thinning that its forks have not produced
/// already.
fn thinning_left(
    taper: Taper,
    load: &Carried,
    rows: &core::ops::Range<usize>,
    places: &[f64],
    t: f64,
) -> f64 {
    // The load of the last 15 % is the load on the tip.
    let at_end: f64 = rows.clone().zip(places).filter(|(_, x)| **x >= 0.85).map(|(n, _)| load.here[n]).sum();
    let whole = load.above[rows.start].max(1e-12);
    let end_share = (at_end / whole).clamp(0.0, 1.0);
    let by_forks = ops::ln((load.above[rows.end - 1].max(1e-12) / whole).min(1.0)) / t;
    let by_taper = ops::ln(taper.ratio(1.0));
    if by_taper >= -1e-12 {
        return 1.0;
    }
    let left = (1.0 - by_forks / by_taper).clamp(0.15, 1.0);
    // 0.07: a stem with its flower at the end still thins by a sixth.
    ops::lerp(left, 0.07, end_share)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    const NONE: Taper = Taper { s: 1.0, alpha: 0.5, m: 0.0 };

    fn model(taper: Taper, exponent: f64, ground: Vec<(AxisId, f64)>) -> PipeModel {
        PipeModel { exponent, taper, min_radius_m: 0.0, max_per_length: 1.0, ground, drawn: vec![] }
    }

    /// Makes a trunk of 10 nodes with `n` straight children at node 4 and one with its own child at node 7.
    fn tree(n: usize) -> Plant {
        let mut p = Plant::default();
        let line = |a: DVec3, d: DVec3| -> Vec<DVec3> { (0..10).map(|i| a + d * f64::from(i)).collect() };
        let trunk = p.add_axis(AxisKind::Branch, None, 0, &line(DVec3::ZERO, DVec3::Y), None);
        let nodes: Vec<_> = p.axis(trunk).node_ids().collect();
        for k in 0..n {
            #[expect(clippy::cast_precision_loss, reason = "few")]
            let (s, c) = ops::sin_cos(k as f64);
            let at = p.axis_points(trunk)[4];
            p.add_axis(
                AxisKind::Branch,
                Some(nodes[4]),
                1 + k as u64,
                &line(at, DVec3::new(c, 0.3, s)),
                None,
            );
        }
        let at = p.axis_points(trunk)[7];
        let limb = p.add_axis(AxisKind::Branch, Some(nodes[7]), 99, &line(at, DVec3::X), None);
        let fork = p.axis(limb).node_ids().nth(5).expect("ten nodes");
        let at = p.axis_points(limb)[5];
        p.add_axis(AxisKind::Twig, Some(fork), 100, &line(at, DVec3::Z), None);
        assert_eq!(p.validate().count(), 0);
        p
    }

    #[test]
    fn taper_has_the_values_of_the_paper() {
        for (alpha, want) in [(0.3, 0.501), (0.4, 0.398), (0.5, 0.316)] {
            assert!((Taper { s: 10.0, alpha, m: 0.0 }.ratio(1.0) - want).abs() < 5e-4, "{alpha}");
        }
        assert!((Taper { s: 100.0, alpha: 0.5, m: 0.0 }.ratio(1.0) - 0.1).abs() < 1e-12);
        let half = Taper { s: 10.0, alpha: 0.3, m: 1.0 };
        assert!((half.ratio(1.0) - 0.75).abs() < 5e-3 && half.ratio(0.0) == 1.0);
    }

    #[test]
    fn pipe_model_conserves_the_power_sum_at_every_fork() {
        for t in [2.0, 2.5, 3.0] {
            let mut p = tree(3);
            pipe_radii(&mut p, &model(NONE, t, vec![(AxisId::new(0), 0.5)]));
            let r = |n: usize| ops::powf(p.nodes.radius_m[n], t);
            // Trunk node 4: three children; node 7: the limb; limb node 5: the twig.
            let children = |node: usize| -> f64 {
                p.axes
                    .iter()
                    .filter(|a| a.bearer.is_some_and(|b| b.index() == node))
                    .map(|a| r(a.nodes.start as usize))
                    .sum()
            };
            for node in [4, 7, 40 + 5] {
                assert!(children(node) > 0.0, "{node}");
                assert!((r(node) - (children(node) + r(node + 1))).abs() < 1e-12, "t {t}, node {node}");
            }
            assert!((r(0) - 6.0 * r(9)).abs() < 1e-12, "six tips");
        }
    }

    #[test]
    fn an_axis_without_forks_follows_eq7() {
        let mut p = Plant::default();
        let points: Vec<DVec3> = (0..=10).map(|i| DVec3::Y * f64::from(i)).collect();
        let a = p.add_axis(AxisKind::Stem, None, 0, &points, None);
        let taper = Taper { s: 10.0, alpha: 0.4, m: 0.2 };
        pipe_radii(&mut p, &model(taper, 2.0, vec![(a, 0.3)]));
        for (i, r) in (0..=10).zip(p.axis_radii(a)) {
            assert!((r - 0.3 * taper.ratio(f64::from(i) / 10.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn radii_fall_along_axes_and_never_exceed_the_bearer() {
        let mut p = tree(7);
        pipe_radii(&mut p, &model(Taper { s: 100.0, alpha: 0.5, m: 0.0 }, 2.0, vec![(AxisId::new(0), 0.5)]));
        for (i, a) in p.axes.iter().enumerate() {
            let r = p.axis_radii(AxisId::new(i));
            assert!(r.windows(2).all(|w| w[1] <= w[0] + 1e-15) && r[0] > 0.0, "{i}: {r:?}");
            if let Some(b) = a.bearer {
                assert!(r[0] <= p.nodes.radius_m[b.index()], "{i}");
            }
        }
    }

    #[test]
    fn drawn_radii_win_and_children_still_fit() {
        let mut p = tree(2);
        let mut m = model(NONE, 2.0, vec![]);
        m.drawn = vec![(AxisId::new(0), (0..10).map(|i| 1.0 - 0.05 * f64::from(i)).collect())];
        pipe_radii(&mut p, &m);
        assert_eq!(p.axis_radii(AxisId::new(0))[3], 1.0 - 0.05 * 3.0);
        assert!(p.axis_radii(AxisId::new(1))[0] < 0.8);
    }

    #[test]
    fn nonsense_numbers_give_finite_radii() {
        let mut p = tree(2);
        let bad = Taper { s: f64::NAN, alpha: f64::INFINITY, m: -3.0 };
        let mut m = model(bad, f64::NAN, vec![(AxisId::new(0), f64::NAN), (AxisId::new(9999), 1.0)]);
        m.drawn = vec![(AxisId::new(1), vec![f64::NAN; 10]), (AxisId::new(2), vec![1.0])];
        pipe_radii(&mut p, &m);
        assert!(p.nodes.radius_m.iter().all(|r| r.is_finite() && *r >= 0.0));
    }
}
