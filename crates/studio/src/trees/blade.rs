//! Forms of tree leaves: those of the sketch maker's library, and some that only trees need.
//!
//! `BladeSpec -> Blade (length 1)`

use base::ops::{self, PI};
use glam::DVec2;
use growth::{BladeForm, BladeSpec};
use plant::{Blade, Lift, Relief};
use sketch::LeafForm;

/// The blade that a spec asks for, of length 1.
pub fn tree_blade(spec: &BladeSpec) -> Blade {
    let mut blade = form_blade(spec.form);
    let width = spec.width.filter(|w| w.is_finite()).unwrap_or(1.0).clamp(0.1, 4.0);
    blade.outline.iter_mut().for_each(|p| p.x *= width);
    if let Some(bend) = spec.bend {
        (blade.relief.bend_a, blade.relief.bend_b) = (0.25 * bend, 0.75 * bend);
        blade.relief.keep_length = true;
    }
    if let Some(fold) = spec.fold {
        blade.relief.fold = fold;
    }
    blade
}

fn form_blade(form: BladeForm) -> Blade {
    let own = |right: Vec<DVec2>, relief: Relief| mirrored(&right, relief);
    let soft = Relief { bend_a: 0.05, bend_b: 0.12, fold: 0.2, ..Relief::default() };
    match form {
        BladeForm::Ovate => LeafForm::Ovate.blade(),
        BladeForm::Elliptic => LeafForm::Elliptic.blade(),
        BladeForm::Lanceolate => LeafForm::Lanceolate.blade(),
        BladeForm::Cordate => LeafForm::Cordate.blade(),
        BladeForm::Lobed => LeafForm::Lobed.blade(),
        BladeForm::Leaflet => LeafForm::Leaflet.blade(),
        BladeForm::Spray => LeafForm::Spray.blade(),
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

/// A blade from its right margin, root and tip left out.
fn mirrored(right: &[DVec2], relief: Relief) -> Blade {
    let mut outline = vec![DVec2::ZERO];
    outline.extend_from_slice(right);
    outline.push(DVec2::Y);
    outline.extend(right.iter().rev().map(|p| DVec2::new(-p.x, p.y)));
    let midrib = (0..=4).map(|i| DVec2::new(0.0, f64::from(i) / 4.0)).collect();
    Blade { outline, midrib, veins: Vec::new(), lift: Lift::Flat, relief }
}

/// Half of five lobes around the end of the stalk: two of each side, the middle one is the tip.
fn palmate() -> Vec<DVec2> {
    [
        (0.1, -0.04),
        (0.34, -0.1),
        (0.27, 0.1),
        (0.42, 0.17),
        (0.6, 0.42),
        (0.41, 0.45),
        (0.39, 0.57),
        (0.16, 0.46),
        (0.2, 0.7),
        (0.09, 0.83),
    ]
    .map(|(x, y)| DVec2::new(x, y))
    .to_vec()
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
