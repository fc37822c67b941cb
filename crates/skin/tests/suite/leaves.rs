//! Leaves of measured veins: counts, resolution, relative positions.
#![allow(missing_docs, reason = "tests")]

use base::{Report, Run};
use glam::DVec3;
use leaf::{
    Leaf, LeafSpec, MarkRow, Marks, PalmateSpec, ParallelSpec, RayLeaf, Rays, SurfaceKind, ThicknessRule,
};
use plant::{Frame, Organ, OrganKind, Paint, Plant, Shape, SplineBlade, VeinShade};
use skin::{KeptShapes, LeafMeshSpec, ShapeMesh, SkinSpec, SurfacePictures, skin_again};

const SHADE: VeinShade = VeinShade { vein: [0.5; 3], blade: [0.1; 3], reach_m: 0.002 };

/// Returns the mesh of a blade as measured.
fn meshed(blade: SplineBlade, leaf: LeafMeshSpec) -> ShapeMesh {
    let mut plant = Plant::default();
    let shape = plant.add_shape(Shape::Spline(blade.into()));
    let frame = Frame::looking(DVec3::ZERO, DVec3::Y, DVec3::Z);
    plant.organs.push(Organ {
        kind: OrganKind::Leaf,
        bearer: None,
        flower: None,
        shape,
        frame,
        scale: 1.0,
        paint: Paint::default(),
        key: 1,
        source: None,
    });
    assert_eq!(plant.validate().next(), None, "a sound plant");
    let mut kept = KeptShapes::default();
    let spec = SkinSpec { leaf, ..SkinSpec::default() };
    let model = skin_again(&plant, &spec, SurfacePictures::default(), Some(&mut kept), &Run::plain())
        .expect("in budget");
    assert_eq!(model.validate().next(), None, "a sound model");
    let names: Vec<&str> = model.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["leaves", "veins"], "parts");
    kept.get(shape).expect("meshed").clone()
}

/// Makes a leaf along +y, x across (mark 1 at +x), side veins rising.
fn sample(rows: usize, surface: SurfaceKind) -> SplineBlade {
    let row = |i: usize| {
        let y = (rows - 1 - i) as f64 / rows as f64;
        let points = core::array::from_fn(|j| {
            let s = 1.0 - j as f64 / 3.0;
            DVec3::new(s * (0.1 + 0.3 * y * (1.1 - y)), y + 0.1 * s.abs(), 0.05 * s * s)
        });
        MarkRow { points, midrib: Some(0.02), ..MarkRow::default() }
    };
    let marks = Marks { rows: (0..rows).map(row).collect(), tip: DVec3::Y, ..Marks::default() };
    let full = marks.complete(&mut Report::default()).expect("sound marks");
    Leaf::new(&full, &LeafSpec { surface, ..LeafSpec::default() }).expect("a leaf").blade()
}

#[test]
fn counts_are_those_of_the_papers_table_1() {
    for (n, veins, blade) in
        [(10, (3610, 3500), (1581, 1500)), (17, (6130, 5950), (2666, 2550)), (14, (5050, 4900), (2201, 2100))]
    {
        for surface in SurfaceKind::ALL {
            let mesh = meshed(sample(n, surface), LeafMeshSpec::default());
            assert_eq!((mesh.veins.positions.len(), mesh.vein_faces), veins, "{n} {surface:?}");
            assert_eq!((mesh.surface.positions.len(), mesh.blade_faces), blade, "{n} {surface:?}");
            let foreseen = LeafMeshSpec::default().triangles(n);
            assert_eq!(foreseen, 2 * (veins.1 + blade.1) as u64);
            assert_eq!(mesh.surface.triangles.len(), 2 * blade.1 - 30, "one triangle a quad at the tip");
            assert_eq!(mesh.veins.validate().chain(mesh.surface.validate()).next(), None);
        }
    }
}

#[test]
fn resolution_and_extras_change_counts_as_expected() {
    let spec =
        LeafMeshSpec { subdivisions: 2, sides: 6, caps: true, margin: true, ..LeafMeshSpec::default() };
    let mesh = meshed(sample(4, SurfaceKind::default()), spec);
    let veins = 1 + 4 + 2;
    let rings = 3 * (2 * 4 + 1) + 4 * (2 * 6 + 1);
    assert_eq!(mesh.veins.positions.len(), 6 * rings + veins * 2 * (2 * 6 + 1));
    assert_eq!(mesh.surface.positions.len(), 9 * 13);
    let upper = mesh.surface.normals.iter().filter(|n| n[2] > 0.0).count();
    assert_eq!(upper, 9 * 13, "all normals point to the upper side");
}

#[test]
fn a_blade_in_its_frame_is_where_it_was_measured() {
    let measured = sample(9, SurfaceKind::Interpolate);
    let turned = {
        let turn = glam::DQuat::from_xyzw(0.1, 0.7, -0.5, 0.5).normalize();
        let place = |p: DVec3| turn * p + DVec3::new(0.3, -2.0, 1.0);
        SplineBlade { surface: measured.surface.clone().moved(place), ..measured.clone() }
    };
    for blade in [measured, turned] {
        let (local, frame) = blade.clone().framed();
        for (u, v) in [(0.0, 0.0), (0.3, 0.6), (1.0, 0.2), (0.5, 1.0)] {
            let back = frame.place(local.surface.point(u, v), 1.0);
            assert!(back.distance(blade.surface.point(u, v)) < 1e-12);
        }
        // Root at the origin, tip on +y, upper side up.
        let tip = local.surface.point(local.middle, 1.0);
        assert!(local.surface.point(local.middle, 0.0).length() < 1e-12);
        assert!(tip.x.abs() + tip.z.abs() < 1e-12 && (tip.y - local.reach()).abs() < 1e-12, "{tip}");
        assert!(local.surface.point_at(local.middle, 0.5).normal.unwrap().z > 0.9);
        let area = local.area_m2();
        assert!((area / blade.area_m2() - 1.0).abs() < 1e-9 && area > 0.1, "{area}");
    }
}

#[test]
fn blades_of_chief_veins_look_up() {
    for rays in [
        Rays::palmate(&PalmateSpec { veins: 7, ..PalmateSpec::default() }),
        Rays::palmate(&PalmateSpec { veins: 3, depth: 0.2, ..PalmateSpec::default() }),
        Rays::parallel(&ParallelSpec::default()),
    ] {
        let leaf = RayLeaf::new(&rays, ThicknessRule::Diameter).unwrap();
        let mesh = meshed(leaf.blade(SHADE), LeafMeshSpec::default());
        assert_eq!(mesh.veins.validate().chain(mesh.surface.validate()).next(), None);
        let up = mesh.surface.normals.iter().filter(|n| n[2] > 0.0).count();
        assert!(up * 100 > 98 * mesh.surface.normals.len(), "{up} of {}", mesh.surface.normals.len());
        assert_eq!(mesh.surface.colors.len(), mesh.surface.positions.len());
    }
}

#[test]
fn lobes_have_side_veins_that_lie_on_the_blade() {
    for veins in [3, 5, 7] {
        let rays = Rays::palmate(&PalmateSpec { veins, ..PalmateSpec::default() });
        let mut leaf = RayLeaf::new(&rays, ThicknessRule::Diameter).unwrap();
        let bare = meshed(leaf.blade(SHADE), LeafMeshSpec::default());
        leaf.add_side_veins(&rays, 4);
        println!("{veins} lobes: {} side veins", leaf.sides.len());
        assert!(leaf.sides.len() >= 4 * veins as usize, "{} side veins of {veins} lobes", leaf.sides.len());
        let fine = LeafMeshSpec { subdivisions: 8, ..LeafMeshSpec::default() };
        let blade = meshed(leaf.blade(SHADE), fine).surface;
        for side in &leaf.sides {
            let first = side.curve.ball(side.marks[0]);
            // It begins on a chief vein, thinner than that.
            let chief = leaf.veins.iter().flat_map(|v| (0..=200).map(|k| v.curve.ball(f64::from(k) / 200.0)));
            let near = chief
                .min_by(|a, b| a.centre.distance(first.centre).total_cmp(&b.centre.distance(first.centre)));
            let near = near.unwrap();
            assert!(near.centre.distance(first.centre) < 0.0006 && first.radius < near.radius, "{first:?}");
            // Its marks lie on the blade: the mesh of that is finer than a tenth of a millimetre of arch.
            for &t in side.marks.iter().skip(3).step_by(6) {
                let ball = side.curve.ball(t);
                let gap = blade.triangles.iter().map(|t| {
                    let [a, b, c] = t.map(|k| {
                        let p = blade.positions[k as usize].map(f64::from);
                        DVec3::from_array(p)
                    });
                    // Inside the triangle as seen from above: the height over it.
                    let flat = |p: DVec3| p.truncate();
                    let area = (flat(b) - flat(a)).perp_dot(flat(c) - flat(a));
                    let w = [(b, c), (c, a), (a, b)]
                        .map(|(p, q)| (flat(q) - flat(p)).perp_dot(flat(ball.centre) - flat(p)) / area);
                    if w.iter().all(|w| *w >= -1e-6) {
                        (a.z * w[0] + b.z * w[1] + c.z * w[2] - ball.centre.z).abs()
                    } else {
                        f64::INFINITY
                    }
                });
                let gap = gap.fold(f64::INFINITY, f64::min);
                assert!(gap < 1e-4, "{veins} lobes: {gap} m from the blade");
            }
        }
        let mesh = meshed(leaf.blade(SHADE), LeafMeshSpec::default());
        assert!(mesh.veins.positions.len() > bare.veins.positions.len());
        assert_eq!(mesh.veins.validate().chain(mesh.surface.validate()).next(), None);
    }
}
