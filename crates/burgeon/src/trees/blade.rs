//! Leaves of trees: a form, modified by a spec.
//!
//! `BladeSpec -> Blade (length 1)`

use glam::DVec2;
use growth::BladeSpec;
use plant::{Blade, BladeForm, Needles};

/// Returns the blade of a spec, of length 1.
pub fn tree_blade(spec: &BladeSpec) -> Blade {
    let mut blade = form_blade(spec);
    if let Some(teeth) = spec.teeth.filter(|n| *n > 0) {
        serrate(&mut blade, teeth.min(60));
    }
    let width = width(spec);
    // Needles of a wider spray keep their length; its side shoots are longer.
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

/// Returns the width of the blade, relative to the default.
fn width(spec: &BladeSpec) -> f64 {
    spec.width.filter(|w| w.is_finite()).unwrap_or(1.0).clamp(0.1, 4.0)
}

fn form_blade(spec: &BladeSpec) -> Blade {
    if spec.form == BladeForm::Spray {
        let needles = Needles::with_length(spec.needle.unwrap_or(f64::NAN));
        return Blade::shoot(needles, spec.shoots.unwrap_or(3), width(spec));
    }
    spec.form.blade()
}

/// Cuts teeth along the margin of a blade, which point forward; the foot of the blade has none.
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
    // A tooth near the end may reach beyond the tip.
    right.retain(|p| *p == DVec2::ZERO || (p.x > 0.0 && p.y < 0.995) || *p == DVec2::Y);
    let n = right.len();
    right.extend((1..n - 1).rev().map(|k| DVec2::new(-right[k].x, right[k].y)).collect::<Vec<_>>());
    if geom::self_crossings(&right) == 0 {
        blade.outline = right;
    }
}

/// Returns a smooth line through these points (Catmull and Rom 1974).
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
