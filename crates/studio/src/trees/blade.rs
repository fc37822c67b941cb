//! Forms of tree leaves: those of the sketch maker's library, and some that only trees need.
//!
//! `BladeSpec -> Blade (length 1)`

use base::ops::{self, PI};
use glam::DVec2;
use growth::{BladeForm, BladeSpec};
use plant::{Blade, Needles, Relief};
use sketch::LeafForm;

/// The blade that a spec asks for, of length 1.
pub fn tree_blade(spec: &BladeSpec) -> Blade {
    let mut blade = form_blade(spec);
    if let Some(teeth) = spec.teeth.filter(|n| *n > 0) {
        serrate(&mut blade, teeth.min(60));
    }
    let width = width(spec);
    // Needles of a wider spray are as long; its side shoots are longer.
    if spec.form != BladeForm::Spray {
        blade.outline.iter_mut().for_each(|p| p.x *= width);
    }
    if let Some(bend) = spec.bend {
        (blade.relief.bend_a, blade.relief.bend_b) = (0.25 * bend, 0.75 * bend);
        blade.relief.keep_length = true;
    }
    if let Some(fold) = spec.fold {
        blade.relief.fold = fold;
    }
    blade
}

/// How much wider than usual.
fn width(spec: &BladeSpec) -> f64 {
    spec.width.filter(|w| w.is_finite()).unwrap_or(1.0).clamp(0.1, 4.0)
}

fn form_blade(spec: &BladeSpec) -> Blade {
    let own = |right: Vec<DVec2>, relief: Relief| Blade::mirrored(&right, relief);
    let soft = Relief { bend_a: 0.05, bend_b: 0.12, fold: 0.2, ..Relief::default() };
    match spec.form {
        BladeForm::Ovate => LeafForm::Ovate.blade(),
        BladeForm::Elliptic => LeafForm::Elliptic.blade(),
        BladeForm::Lanceolate => LeafForm::Lanceolate.blade(),
        BladeForm::Cordate => LeafForm::Cordate.blade(),
        BladeForm::Lobed => own(lobed(), soft),
        BladeForm::Leaflet => LeafForm::Leaflet.blade(),
        BladeForm::Spray => {
            let needles = Needles::of_length(spec.needle.unwrap_or(f64::NAN));
            Blade::shoot(needles, spec.shoots.unwrap_or(3), width(spec))
        }
        BladeForm::Obovate => {
            let right = (1..=8).map(|i| {
                let v = f64::from(i) / 9.0;
                DVec2::new(0.3 * ops::powf(v, 1.1) * ops::powf(1.0 - v, 0.55) / 0.362, v)
            });
            own(right.collect(), soft)
        }
        BladeForm::Deltoid => {
            let right = [
                (0.16, -0.01),
                (0.3, 0.05),
                (0.385, 0.16),
                (0.36, 0.28),
                (0.28, 0.44),
                (0.18, 0.62),
                (0.08, 0.82),
            ];
            own(right.map(|(x, y)| DVec2::new(x, y)).to_vec(), soft)
        }
        BladeForm::Palmate => own(palmate(), Relief { fold: 0.12, ..soft }),
        BladeForm::Pinnate => own(pinnate(), Relief { bend_b: 0.25, fold: 0.25, ..Relief::default() }),
        BladeForm::Needle => own(
            vec![DVec2::new(0.02, 0.1), DVec2::new(0.024, 0.5), DVec2::new(0.015, 0.85)],
            Relief { fold: 0.3, ..Relief::default() },
        ),
        BladeForm::Brush => own(brush(), Relief { fold: 0.5, bend_b: -0.06, ..Relief::default() }),
        BladeForm::Tuft => own(tuft(), Relief { fold: 0.35, bend_b: 0.05, ..Relief::default() }),
    }
}

/// Four round lobes a side between narrow notches, the third the largest, on a wedge that widens upwards from small ears
/// (Quercus robur).
fn lobed() -> Vec<DVec2> {
    const LOBES: f64 = 4.0;
    const STEPS: u32 = 56;
    (1..STEPS)
        .map(|i| {
            let v = f64::from(i) / f64::from(STEPS);
            let hull = 0.33 * ops::powf(v, 0.8) * ops::powf(1.0 - v, 0.42) / 0.53;
            let phase = LOBES * ops::powf((v - 0.03).max(0.0), 0.92) - 0.08;
            let notch = ops::powf(0.5 + 0.5 * ops::cos(2.0 * PI * phase), 2.2);
            // Shallow towards the tip, which is one blunt lobe.
            let deep = 0.46 * (1.0 - ops::smoothstep(0.72, 0.95, v));
            let ear = 0.045 * ops::powf((1.0 - (v - 0.035).abs() / 0.035).max(0.0), 0.5);
            let wide = (hull * (1.0 - deep * notch) + ear).max(0.012);
            // Lobes point forward.
            DVec2::new(wide, v + 0.10 * hull * (1.0 - notch) * (1.0 - v))
        })
        .collect()
}

/// Half of five lobes around the end of the stalk, each drawn out to a point with a tooth or two beside it (Acer
/// platanoides): two of each side, the middle one is the tip.
fn palmate() -> Vec<DVec2> {
    [
        (0.1, -0.06),
        (0.22, -0.11),
        (0.36, -0.13),
        (0.35, -0.06),
        (0.45, -0.02),
        (0.38, 0.04),
        (0.33, 0.1),
        (0.45, 0.13),
        (0.58, 0.16),
        (0.56, 0.23),
        (0.67, 0.35),
        (0.56, 0.36),
        (0.55, 0.46),
        (0.43, 0.4),
        (0.3, 0.37),
        (0.18, 0.39),
        (0.2, 0.52),
        (0.24, 0.64),
        (0.34, 0.74),
        (0.23, 0.74),
        (0.18, 0.78),
        (0.18, 0.87),
        (0.09, 0.87),
    ]
    .map(|(x, y)| DVec2::new(x, y))
    .to_vec()
}

/// Teeth along the margin of a blade, which point forward; the foot of the blade has none.
fn serrate(blade: &mut Blade, teeth: u32) {
    let Some(tip) = blade.outline.iter().position(|p| *p == DVec2::Y) else { return };
    let side = &blade.outline[..=tip];
    let whole = geom::polyline_length(side);
    let step = 0.86 * whole / f64::from(teeth);
    let smooth = curve(side);
    let long = geom::polyline_length(&smooth);
    let at = |s: f64| geom::point_at(&smooth, s * long / whole).unwrap_or(DVec2::Y);
    let mut right = vec![DVec2::ZERO];
    right.extend((1..4).map(|k| at(0.035 * whole * f64::from(k))));
    for k in 0..teeth {
        let from = 0.13 * whole + step * f64::from(k);
        let (a, b) = (at(from), at(from + 0.8 * step));
        let way = (b - a).normalize_or_zero();
        right.push(a);
        right.push(b + DVec2::new(way.y, -way.x) * (0.32 * step));
    }
    right.push(DVec2::Y);
    // A tooth of the far end may reach over the tip.
    right.retain(|p| *p == DVec2::ZERO || (p.x > 0.0 && p.y < 0.995) || *p == DVec2::Y);
    let n = right.len();
    right.extend((1..n - 1).rev().map(|k| DVec2::new(-right[k].x, right[k].y)).collect::<Vec<_>>());
    if geom::self_crossings(&right) == 0 {
        blade.outline = right;
    }
}

/// A line through these points without corners (Catmull and Rom 1974).
fn curve(points: &[DVec2]) -> Vec<DVec2> {
    const STEPS: u32 = 8;
    let mut out = Vec::new();
    for (k, w) in points.windows(2).enumerate() {
        let (b, c) = (w[0], w[1]);
        let a = if k > 0 { points[k - 1] } else { b };
        let d = points.get(k + 2).copied().unwrap_or(c);
        out.extend((0..STEPS).map(|i| {
            let t = f64::from(i) / f64::from(STEPS);
            0.5 * (2.0 * b
                + (c - a) * t
                + (2.0 * a - 5.0 * b + 4.0 * c - d) * (t * t)
                + (3.0 * b - a - 3.0 * c + d) * (t * t * t))
        }));
    }
    out.extend(points.last());
    out
}

/// Five leaflets a side.
fn pinnate() -> Vec<DVec2> {
    let mut right = Vec::with_capacity(25);
    for i in 0..5 {
        let v = 0.1 + 0.165 * f64::from(i);
        let reach = 0.3 - 0.03 * f64::from(i);
        right.extend([
            DVec2::new(0.008, v),
            DVec2::new(0.55 * reach, v + 0.1 * reach),
            DVec2::new(reach, v + 0.55 * reach),
            DVec2::new(0.5 * reach, v + 0.55 * reach),
            DVec2::new(0.008, v + 0.07),
        ]);
    }
    right.extend([DVec2::new(0.06, 0.9), DVec2::new(0.05, 0.96)]);
    right
}

/// Three needles a side and one in the middle, which is the tip.
fn tuft() -> Vec<DVec2> {
    let mut right = Vec::with_capacity(6);
    for (degrees, reach) in [(62.0, 0.86), (40.0, 0.94), (19.0, 0.98)] {
        let (s, c) = ops::sin_cos(degrees * (PI / 180.0));
        right.push(DVec2::new(reach * s, reach * c));
        let (s, c) = ops::sin_cos((degrees - 10.5) * (PI / 180.0));
        right.push(DVec2::new(0.12 * s, 0.12 * c));
    }
    right
}

/// Five needles a side, each from its place on the shoot, and one at the end, which is the tip.
fn brush() -> Vec<DVec2> {
    let mut right = Vec::with_capacity(11);
    for i in 0..5 {
        let v = 0.06 + 0.125 * f64::from(i);
        let (s, c) = ops::sin_cos((58.0 - 7.0 * f64::from(i)) * (PI / 180.0));
        right.push(DVec2::new(0.014, v));
        right.push(DVec2::new(0.014 + BRUSH_NEEDLE * s, v + 0.03 + BRUSH_NEEDLE * c));
    }
    right.push(DVec2::new(0.014, 0.7));
    right
}

/// Length of a needle over that of the brush.
const BRUSH_NEEDLE: f64 = 0.34;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_is_a_leaf_that_can_be_meshed() {
        for form in BladeForm::ALL {
            let blade = tree_blade(&BladeSpec { form, ..BladeSpec::default() });
            let area: f64 = geom::signed_area(&blade.outline);
            assert!(area > 0.01 && area < 0.7, "{form:?}: {area}");
            assert!((blade.length() - 1.0).abs() < 1e-12, "{form:?}");
            for triangles in [14.0, 40.0, 400.0] {
                let mesh = skin::blade_mesh(&blade, triangles);
                assert_eq!(mesh.validate().next(), None, "{form:?}");
                assert!(mesh.triangles.len() >= 4, "{form:?}: {}", mesh.triangles.len());
                let wide = |of: fn(f32, f32) -> f32| mesh.positions.iter().map(|p| p[0]).fold(0.0, of);
                assert!((wide(f32::max) + wide(f32::min)).abs() < 0.05, "{form:?} is symmetric");
            }
        }
    }

    #[test]
    fn width_bend_and_fold_are_heard() {
        let spec = BladeSpec { width: Some(2.0), bend: Some(0.4), fold: Some(0.0), ..BladeSpec::default() };
        let (plain, wide) = (tree_blade(&BladeSpec::default()), tree_blade(&spec));
        assert!((wide.outline[4].x - 2.0 * plain.outline[4].x).abs() < 1e-12);
        assert!(wide.point(DVec2::Y).z < plain.point(DVec2::Y).z);
    }
}
