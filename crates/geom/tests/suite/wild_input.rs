//! Robustness against whatever a pen or a file can produce: no function panics, and each keeps its guarantees.

use geom::{Cone, ConeSheet, KdTree2};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

/// Coordinates with ties, near-duplicates, extremes of f64, and NaN.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => (-4..4_i32).prop_map(|i| f64::from(i) * 0.5),
        8 => -2.0..2.0,
        2 => (-4..4_i32, -1.0..1.0).prop_map(|(i, e)| f64::from(i) * 0.5 + e * 1e-12),
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE, 5e-324, -0.0,
            1e300, -1e300, 1e99, -1e99, 1e-200,
        ]),
    ]
}

fn points2(most: usize) -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((coordinate(), coordinate()).prop_map(DVec2::from), 0..most)
}

fn points3(most: usize) -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec((coordinate(), coordinate(), coordinate()).prop_map(DVec3::from), 0..most)
}

fn usable(p: DVec2) -> bool {
    p.x.abs() <= 1e100 && p.y.abs() <= 1e100
}

fn usable3(p: DVec3) -> bool {
    usable(p.truncate()) && p.z.abs() <= 1e100
}

/// Returns the distance allowed for rounding, from the largest usable coordinate.
fn rounding(points: &[DVec2]) -> f64 {
    points.iter().filter(|&&p| usable(p)).fold(1e-290, |m, p| p.x.abs().max(p.y.abs()).max(m)) * 1e-9
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn lines_keep_their_promises(points in points2(30), step in coordinate(), at in coordinate(), p in points2(2)) {
        let length = geom::polyline_length(&points);
        prop_assert!(length.is_finite() && length >= 0.0);
        let line = geom::resample(&points, step.abs().max(length * 1e-3));
        prop_assert!(line.iter().all(|&p| usable(p)));
        let kept: Vec<DVec2> = points.iter().copied().filter(|&p| usable(p)).collect();
        prop_assert_eq!(line.first(), kept.first());
        if length > 0.0 {
            prop_assert_eq!(line.last().map(|p| p.length()), kept.last().map(|p| p.length()));
            prop_assert!(geom::polyline_length(&line) <= length * (1.0 + 1e-9));
        }
        for (smooth, m) in [(geom::smooth_gaussian(&points, 3, at), 3), (geom::smooth_gaussian_closed(&points, 5, at), 5)] {
            prop_assert_eq!(smooth.len(), points.len(), "{}", m);
            prop_assert!(points.iter().zip(&smooth).all(|(p, s)| !usable(*p) || s.is_finite()));
        }
        let simple = geom::simplify(&points, step);
        prop_assert!(simple.len() <= kept.len() && simple.iter().all(|p| kept.contains(p)));
        let tolerance = rounding(&points) + if step > 0.0 { step } else { 0.0 };
        for &q in &kept {
            let off = geom::closest_on_polyline(&simple, q).map_or(f64::INFINITY, |c| c.distance);
            prop_assert!(off <= tolerance, "{off} {tolerance}");
        }
        prop_assert_eq!(geom::point_at(&points, at).is_some(), !kept.is_empty());
        prop_assert!(geom::point_at(&points, at).is_none_or(|p| p.is_finite()));
        prop_assert!(geom::tangent_at(&points, at).is_none_or(|t| (t.length() - 1.0).abs() < 1e-12));
        prop_assert!(geom::turning_angles(&points).iter().all(|a| a.abs() <= std::f64::consts::PI));
        for &q in &p {
            let closest = geom::closest_on_polyline(&points, q);
            prop_assert_eq!(closest.is_some(), usable(q) && !kept.is_empty());
            if let Some(c) = closest {
                let vertex = kept.iter().map(|k| k.distance(q)).fold(f64::INFINITY, f64::min);
                prop_assert!(c.distance <= vertex && c.index < points.len() && (0.0..=1.0).contains(&c.t));
                let again = geom::point_at(&points, c.at).unwrap();
                prop_assert!(again.distance(c.point) <= rounding(&points), "{c:?} {again}");
            }
        }
    }

    #[test]
    fn lines_in_space_keep_their_promises(points in points3(20), step in 0.01..2.0, at in coordinate(), n in 0..20_usize) {
        prop_assert!(geom::polyline_length3(&points).is_finite());
        prop_assert!(geom::resample3(&points, geom::polyline_length3(&points) * step).iter().all(|&p| usable3(p)));
        prop_assert!(geom::point_at3(&points, at).is_none_or(|p| p.is_finite()));
        prop_assert!(geom::tangent_at3(&points, at).is_none_or(|t| (t.length() - 1.0).abs() < 1e-12));
        let kept: Vec<DVec3> = points.iter().copied().filter(|&p| usable3(p)).collect();
        for curve in [geom::bezier_quadratic_c1(&points, n), geom::catmull_rom(&points, n)] {
            prop_assert!(curve.iter().all(|p| p.is_finite()));
            prop_assert_eq!(curve.is_empty(), kept.is_empty());
        }
        // A quadratic piece never leaves the box of its control points.
        let box_of = |points: &[DVec3]| points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
        let ((lo, hi), slack) = (box_of(&kept), kept.iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element())) * 1e-12);
        prop_assert!(geom::bezier_quadratic_c1(&points, n)
            .iter()
            .all(|p| p.cmpge(lo - DVec3::splat(slack)).all() && p.cmple(hi + DVec3::splat(slack)).all()));
    }

    #[test]
    fn frames_are_orthonormal(points in points3(20), wish in points3(2)) {
        let frames = geom::rotation_minimising_frames(&points, wish.first().copied());
        prop_assert_eq!(frames.len(), points.len());
        for f in &frames {
            for v in [f.tangent, f.normal, f.binormal] {
                prop_assert!((v.length() - 1.0).abs() < 1e-9, "{f:?}");
            }
            prop_assert!(f.tangent.dot(f.normal).abs() < 1e-9, "{f:?}");
            prop_assert!((f.tangent.cross(f.normal) - f.binormal).length() < 1e-9, "{f:?}");
        }
    }

    #[test]
    fn polygons_keep_their_promises(points in points2(30), from in points2(2), to in points2(2)) {
        prop_assert!(geom::signed_area(&points).is_finite() && geom::centroid(&points).is_finite());
        let hull = geom::convex_hull(&points);
        let slack = rounding(&points);
        prop_assert!(geom::signed_area(&hull) >= 0.0);
        for w in 0..hull.len() {
            let (a, b) = (hull[w], hull[(w + 1) % hull.len()]);
            let side = (b - a).normalize_or_zero();
            prop_assert!(points.iter().filter(|&&p| usable(p)).all(|&p| side.perp_dot(p - a) >= -slack));
        }
        let distance = |(i, j): (usize, usize)| points[i].distance(points[j]);
        if let Some(pair) = geom::farthest_pair(&points) {
            prop_assert!(pair.0 <= pair.1);
            for i in (0..points.len()).filter(|&i| usable(points[i])) {
                prop_assert!(distance((pair.0, i)) <= distance(pair) + slack);
            }
        }
        geom::self_crossings(&points);
        for (&a, &b) in from.iter().zip(&to) {
            geom::contains(&points, a);
            for (centre, half) in geom::medial_axis_width(&points, a, b, 9) {
                prop_assert!(centre.is_finite() && half >= 0.0 && half.is_finite(), "{centre} {half}");
            }
        }
    }

    #[test]
    fn fits_are_finite(points in points2(12), facing in any::<bool>()) {
        if let Some(p) = geom::pca2(&points) {
            prop_assert!(p.centre.is_finite() && p.lambda[0] >= p.lambda[1] && p.lambda[1] >= 0.0);
            prop_assert!((p.major.length() - 1.0).abs() < 1e-12 && p.extent.iter().all(|e| *e >= 0.0));
        }
        for e in [geom::fit_ellipse(&points), geom::fit_ellipse_harmonic(&points)].into_iter().flatten() {
            prop_assert!(e.centre.is_finite() && e.major > 0.0 && e.major.is_finite(), "{e:?}");
            prop_assert!((0.0..=1.0).contains(&e.ratio()) && (e.axis.length() - 1.0).abs() < 1e-12, "{e:?}");
        }
        if let Some((&centre, tips)) = points.split_first()
            && let Some(f) = geom::flower_cone(centre, tips, facing)
        {
            prop_assert!((f.cone.axis.length() - 1.0).abs() < 1e-9 && f.height > 0.0 && f.radius > 0.0, "{f:?}");
            prop_assert!(f.cone.half_angle > 0.0 && f.cone.half_angle <= std::f64::consts::FRAC_PI_2, "{f:?}");
            prop_assert_eq!(f.cone.axis.z >= 0.0, facing || f.cone.axis.z == 0.0, "{:?}", f);
            for (&tip, sheet) in tips.iter().zip(f.cone.sheets_for_tips(tips, f.height)) {
                prop_assert!(f.cone.depth(tip, sheet).is_finite());
            }
        }
    }

    #[test]
    fn any_cone_has_a_depth(v in prop::collection::vec(coordinate(), 9)) {
        let cone = Cone { apex: DVec3::new(v[0], v[1], v[2]), axis: DVec3::new(v[3], v[4], v[5]), half_angle: v[6] };
        let xy = DVec2::new(v[7], v[8]);
        for sheet in [ConeSheet::Near, ConeSheet::Far] {
            let z = cone.depth(xy, sheet);
            prop_assert!(z.is_finite() || !cone.apex.is_finite(), "{z}");
        }
        cone.sheet_for_tip(xy, v[0]);
        cone.covers(xy);
    }

    #[test]
    fn clusters_are_numbered_by_first_member(points in points2(25), bandwidth in coordinate()) {
        let labels = geom::mean_shift(&points, bandwidth);
        prop_assert_eq!(labels.len(), points.len());
        let mut next = 0;
        for &label in &labels {
            prop_assert!(label <= next);
            next = next.max(label + 1);
        }
        for (i, p) in points.iter().enumerate() {
            for (j, q) in points.iter().enumerate() {
                prop_assert!(!usable(*p) || p != q || labels[i] == labels[j], "equal points share a cluster");
            }
        }
        prop_assert_eq!(labels, geom::mean_shift(&points, bandwidth));
    }

    #[test]
    fn grids_in_the_plane_agree_with_looking(points in points2(25), p in points2(2), r in coordinate()) {
        let grid = KdTree2::new(&points);
        let mut found = vec![];
        for &p in &p {
            grid.within(p, r, &mut found);
            let looked: Vec<usize> = (0..points.len())
                .filter(|&i| usable(p) && usable(points[i]) && points[i].distance(p) <= r)
                .collect();
            prop_assert_eq!(&found, &looked);
            prop_assert_eq!(grid.nearest(p, r).is_some(), !looked.is_empty());
        }
    }

}

proptest! {
    // With outliers the edge becomes tiny compared with the blade, and then each case costs 20 000 points.
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn triangulations_repeat_to_the_bit(outline in points2(20), vein in points2(5), edge in coordinate()) {
        let once = geom::triangulate_blade(&outline, &[&vein], edge.clamp(0.1, 5.0));
        let again = geom::triangulate_blade(&outline, &[&vein], edge.clamp(0.1, 5.0));
        prop_assert_eq!(&once.is_ok(), &again.is_ok());
        if let (Ok(a), Ok(b)) = (once, again) {
            prop_assert_eq!(&a.triangles, &b.triangles);
            prop_assert!(a.points.iter().zip(&b.points).all(|(p, q)| p == q));
            prop_assert!(a.points.iter().all(|p| p.is_finite()));
        }
        let wild = geom::triangulate_blade(&outline, &[], edge);
        let fault = matches!(wild, Err(geom::TriangulateError::Internal { .. }));
        prop_assert!(!fault);
    }
}
