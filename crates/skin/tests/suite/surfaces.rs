//! Meshes of whole plants: closed, counted, the same for any number of threads.

use crate::scenes;
use std::collections::BTreeMap;

use base::{CancelToken, Digest, NoClock, Run};
use glam::DVec3;
use mesh::{Model, TriMesh};
use plant::{AxisKind, Paint, Plant};
use proptest::prelude::*;
use skin::{SkinSpec, TubeSpec, skin, tube};

fn skinned(p: &Plant) -> Model {
    let model = skin(p, &SkinSpec::default(), &Run::plain()).expect("nobody cancels");
    assert_eq!(model.validate().collect::<Vec<_>>(), [], "{}", p.name);
    model
}

fn part<'a>(model: &'a Model, name: &str) -> &'a TriMesh {
    let names: Vec<&str> = model.parts.iter().map(|p| p.name.as_str()).collect();
    &model.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("{name} among {names:?}")).mesh
}

/// Returns the number of edges, with coincident vertices merged, that do not have exactly one partner in the opposite
/// direction.
fn open_edges(mesh: &TriMesh) -> usize {
    let mut places: BTreeMap<[u32; 3], usize> = BTreeMap::new();
    let welded: Vec<usize> = mesh
        .positions
        .iter()
        .map(|p| {
            let n = places.len();
            *places.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(n)
        })
        .collect();
    let mut edges: BTreeMap<(usize, usize), i32> = BTreeMap::new();
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| welded[i as usize]);
        for (i, j) in [(a, b), (b, c), (c, a)] {
            *edges.entry((i, j)).or_default() += 1;
        }
    }
    edges.iter().filter(|&(&(i, j), n)| edges.get(&(j, i)) != Some(n) || *n != 1).count()
}

fn volume(mesh: &TriMesh) -> f64 {
    let six: f64 = mesh
        .triangles
        .iter()
        .map(|&[a, b, c]| mesh.position(a).dot(mesh.position(b).cross(mesh.position(c))))
        .sum();
    six / 6.0
}

/// Returns the least cosine between a triangle's normal and its corners' normals.
fn worst_normal(mesh: &TriMesh) -> f64 {
    let mut worst = 1.0_f64;
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.position(i));
        let Some(n) = (b - a).cross(c - a).try_normalize() else { continue };
        for &i in t {
            let m = mesh.normals[i as usize].map(f64::from);
            worst = worst.min(n.dot(DVec3::from(m)));
        }
    }
    worst
}

#[test]
fn straight_tube_is_closed_and_of_the_right_volume() {
    let spec = TubeSpec { sides: 24, rings: 40, repeats: 1 };
    let mesh = tube(&[DVec3::ZERO, DVec3::Y], &[0.1, 0.1], &spec);
    assert_eq!(open_edges(&mesh), 0);
    // A cylinder and nine tenths of half a ball, less what the polygon cuts off.
    let want = 0.1 * 0.1 * base::ops::PI * (1.0 + 0.9 * 0.1 * 2.0 / 3.0);
    assert!((volume(&mesh) / want - 1.0).abs() < 0.03, "{} against {want}", volume(&mesh));
    assert!(worst_normal(&mesh) > 0.7, "{}", worst_normal(&mesh));
    let bounds = mesh.bounds();
    assert!((bounds.max.y - 1.09).abs() < 1e-6 && bounds.min.y.abs() < 1e-9, "{bounds:?}");
}

#[test]
fn tube_texels_are_square_and_the_seam_repeats() {
    let spec = TubeSpec { sides: 8, rings: 10, repeats: 3 };
    let mesh = tube(&[DVec3::ZERO, DVec3::Y * 2.0], &[0.1, 0.1], &spec);
    let (low, high) = mesh.uvs.iter().fold((9.0_f32, -9.0_f32), |(a, b), uv| (a.min(uv[0]), b.max(uv[0])));
    assert_eq!((low, high), (0.0, 3.0));
    // Three tiles around 0.628 m: two metres are 9.55 tiles of 0.209 m.
    let v = mesh.positions.iter().zip(&mesh.uvs).filter(|(p, _)| p[1] == 2.0).map(|(_, uv)| uv[1]);
    for v in v {
        assert!((f64::from(v) - 2.0 * 3.0 / (base::ops::TAU * 0.1)).abs() < 1e-3, "{v}");
    }
}

#[test]
fn hard_cases_stay_closed_and_finite() {
    let nan = DVec3::new(f64::NAN, 0.0, 0.0);
    let cases: &[(&str, Vec<DVec3>, Vec<f64>)] = &[
        ("zero radius", vec![DVec3::ZERO, DVec3::Y], vec![0.0, 0.0]),
        ("two nodes", vec![DVec3::ZERO, DVec3::X], vec![0.1, 0.05]),
        ("reversal", vec![DVec3::ZERO, DVec3::Y, DVec3::ZERO], vec![0.1, 0.1, 0.1]),
        ("reversal, offset", vec![DVec3::ZERO, DVec3::Y, DVec3::X * 0.01], vec![0.1, 0.1, 0.1]),
        ("thicker than long", vec![DVec3::ZERO, DVec3::Y * 0.1], vec![1.0, 1.0]),
        ("one good pair", vec![nan, DVec3::ZERO, DVec3::ZERO, nan, DVec3::Y], vec![0.1]),
        ("no radii", vec![DVec3::ZERO, DVec3::Y], vec![]),
        ("far away", vec![DVec3::splat(1e5), DVec3::splat(1e5) + DVec3::Y], vec![0.1, 0.1]),
        ("small", vec![DVec3::ZERO, DVec3::Y * 1e-6], vec![1e-7, 1e-8]),
    ];
    for (name, points, radii) in cases {
        let mesh = tube(points, radii, &TubeSpec::default());
        assert!(!mesh.triangles.is_empty(), "{name}");
        assert_eq!(mesh.validate().collect::<Vec<_>>(), [], "{name}");
        // An exact reversal lies on itself: welding coincident vertices would join both halves.
        if !matches!(*name, "far away" | "reversal") {
            assert_eq!(open_edges(&mesh), 0, "{name}");
        }
        assert!(mesh.uvs.iter().all(|uv| uv[0].is_finite() && uv[1].is_finite()), "{name}");
    }
    for points in [vec![], vec![DVec3::ZERO], vec![DVec3::Y, DVec3::Y], vec![nan, nan]] {
        assert_eq!(tube(&points, &[0.1], &TubeSpec::default()), TriMesh::default());
    }
}

#[test]
fn thick_line_that_jitters_does_not_fold() {
    // A zigzag of the pen, finer than the line is thick.
    let points: Vec<DVec3> = (0..60)
        .map(|k| DVec3::new(if k % 2 == 0 { 0.01 } else { -0.01 }, 0.01 * f64::from(k), 0.0))
        .collect();
    let mesh = tube(&points, &[0.05; 60], &TubeSpec { sides: 8, rings: 40, repeats: 1 });
    assert_eq!(open_edges(&mesh), 0);
    assert!(worst_normal(&mesh) > 0.2, "a face looks inwards: {}", worst_normal(&mesh));
    let right_angle = [DVec3::ZERO, DVec3::Y * 0.5, DVec3::new(0.5, 0.5, 0.0)];
    let mesh = tube(&right_angle, &[0.08; 3], &TubeSpec::default());
    assert!(worst_normal(&mesh) > 0.0, "a face looks inwards: {}", worst_normal(&mesh));
}

#[test]
fn every_tube_of_a_tree_is_closed() {
    for p in [scenes::fork(), scenes::tree(56, AxisKind::Branch)] {
        let model = skinned(&p);
        for part in &model.parts {
            assert_eq!(open_edges(&part.mesh), 0, "{} of {}", part.name, p.name);
            assert!(volume(&part.mesh) > 0.0, "{} of {}", part.name, p.name);
        }
    }
}

#[test]
fn tip_that_goes_on_is_one_tube() {
    let mut p = Plant::default();
    let a = [DVec3::ZERO, DVec3::Y * 0.5, DVec3::Y];
    let t = p.add_axis(AxisKind::Stem, None, 1, &a, None);
    let b = [DVec3::Y, DVec3::new(0.1, 1.5, 0.0), DVec3::new(0.3, 2.0, 0.0)];
    let node = p.axis(t).node_ids().last();
    p.add_axis(AxisKind::Stem, node, 2, &b, None);
    p.nodes.radius_m = vec![0.05; 6];
    let model = skinned(&p);
    let mesh = part(&model, "stems");
    // The only faces across the line are the base and the tip: no cap stays inside at the joint.
    let across = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.position(i));
        let n = (b - a).cross(c - a).normalize_or_zero();
        n.y.abs() > 0.9 && (0.6..1.4).contains(&a.y)
    };
    assert_eq!(mesh.triangles.iter().filter(across).count(), 0);
    assert_eq!(open_edges(mesh), 0);
}

#[test]
fn branch_counts_follow_the_paper() {
    let model = skinned(&scenes::tree(56, AxisKind::Branch));
    // Table 1 (a): 56 branches, 29,888 triangles; a fifth off either way.
    let n = model.triangle_count();
    assert!((23_900..35_800).contains(&n), "{n}");
    let half = SkinSpec { detail: 0.5, ..SkinSpec::default() };
    let coarse = skin(&scenes::tree(56, AxisKind::Branch), &half, &Run::plain()).unwrap().triangle_count();
    assert!(coarse * 2 < n, "{coarse} at half the detail");
}

#[test]
fn flower_has_its_parts_and_counts() {
    let p = scenes::flower(6);
    let model = skinned(&p);
    let names: Vec<&str> = model.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["stems", "leaves", "petals", "discs", "stamens"]);
    let petals = part(&model, "petals").triangles.len() / 6;
    assert!((450..1000).contains(&petals), "{petals} triangles a petal");
    for p in &model.parts {
        let material = model.material(p);
        let blade = matches!(p.name.as_str(), "leaves" | "petals");
        assert_eq!(material.double_sided, blade, "{}", p.name);
        assert!(material.texture.is_some(), "{}", p.name);
        assert_eq!(p.mesh.uvs.len(), p.mesh.positions.len(), "{}", p.name);
        if p.name != "stems" {
            assert!(p.mesh.uvs.iter().flatten().all(|x| (0.0..=1.0).contains(x)), "{}", p.name);
        }
    }
    assert_eq!(open_edges(part(&model, "discs")), 0);
    assert!(volume(part(&model, "discs")) > 0.0);
    assert!(worst_normal(part(&model, "petals")) > 0.5, "petals are smooth");
}

#[test]
fn crown_leaves_are_coarse_but_fold() {
    let p = scenes::leafy(3000);
    let model = skinned(&p);
    let each = part(&model, "leaves").triangles.len() / 3000;
    // A plain outline with a midrib that can bend; the rest goes to lobes and needles.
    assert!((6..=24).contains(&each), "{each}");
    let colors = &part(&model, "leaves").colors;
    assert_eq!(colors.len(), part(&model, "leaves").positions.len());
    assert!(colors.iter().flatten().all(|c| (0.5..=1.0).contains(c)));
    assert_ne!(colors.first(), colors.last(), "leaves differ");
}

#[test]
fn shoots_in_needles_are_cut_out_of_cards_beside_leaves_that_are_not() {
    let mut p = scenes::leafy(60);
    let shoot =
        p.add_shape(plant::Shape::Blade(plant::Blade::shoot(plant::Needles::with_length(0.08), 3, 1.0)));
    for organ in p.organs.iter_mut().skip(40) {
        organ.shape = shoot;
    }
    let model = skinned(&p);
    assert_eq!(part(&model, "needles").triangles.len(), 20 * 4, "a card each");
    assert!(part(&model, "leaves").triangles.len() > 40 * 4, "leaves keep their outlines");
    for (name, alpha) in [("needles", mesh::AlphaMode::Mask), ("leaf", mesh::AlphaMode::Opaque)] {
        let m = model.materials.iter().find(|m| m.name == name).expect("a material of its own");
        assert_eq!(m.alpha, alpha, "{name}");
    }
    let plain = SkinSpec { textures: false, ..SkinSpec::default() };
    let plain = skin(&p, &plain, &Run::plain()).expect("nobody cancels");
    assert!(plain.materials.iter().all(|m| m.alpha == mesh::AlphaMode::Opaque), "nothing to cut out");
}

#[test]
fn drawn_colours_and_bodies_find_their_parts() {
    let p = scenes::still_life();
    let model = skinned(&p);
    let names: Vec<&str> = model.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["roots", "leaves-drawn", "fruits", "bodies", "thorns"]);
    let red = part(&model, "leaves-drawn").colors[0];
    assert!(red[0] > 5.0 * red[1], "{red:?}");
    for name in ["roots", "fruits", "bodies", "thorns"] {
        let mesh = part(&model, name);
        assert_eq!(open_edges(mesh), 0, "{name}");
        assert!(volume(mesh) > 0.0, "{name} is inside out");
    }
}

#[test]
fn thick_green_axis_is_a_body_beside_tinted_ones() {
    let mut p = scenes::still_life();
    let arm = [DVec3::new(0.0, 0.2, 0.0), DVec3::new(0.2, 0.3, 0.0), DVec3::new(0.22, 0.5, 0.0)];
    let id = p.add_axis(AxisKind::Stem, None, 77, &arm, None);
    scenes::set_radii(&mut p, id, 0.07, 0.06);
    let model = skinned(&p);
    let bodies = part(&model, "bodies");
    assert_eq!(bodies.colors.len(), bodies.positions.len());
    assert_eq!(bodies.colors[0], [1.0; 3]);
    assert!(model.parts.iter().all(|p| p.name != "stems"));
}

#[test]
fn paint_is_what_the_maker_says() {
    let petals = |paint: fn([f32; 3]) -> Paint, rgb: [f32; 3]| {
        let mut p = scenes::flower(3);
        p.organs.iter_mut().filter(|o| o.kind == plant::OrganKind::Petal).for_each(|o| o.paint = paint(rgb));
        let model = skinned(&p);
        let part = model.parts.iter().find(|p| model.material(p).kind == mesh::MaterialKind::Petal).unwrap();
        (part.name.clone(), model.material(part).name.clone(), part.mesh.colors[0])
    };
    let natural = petals(Paint::Natural, [0.9; 3]);
    // Pale or dark: a colour means what its maker set.
    for rgb in [[0.9; 3], [0.95, 0.62, 0.68], [0.01, 0.02, 0.01]] {
        let (part, material, color) = petals(Paint::Tinted, rgb);
        assert_eq!((part.as_str(), material.as_str()), ("petals", "petal"));
        assert!(color.iter().zip(rgb).all(|(c, x)| (0.8 * x..=x).contains(c)), "{color:?} {rgb:?}");
        let (part, material, drawn) = petals(Paint::Drawn, rgb);
        assert_eq!((part.as_str(), material.as_str(), drawn), ("petals-drawn", "petal-drawn", color));
    }
    assert!(natural.0 == "petals" && natural.1.starts_with("petal-"), "{natural:?}");
}

#[test]
fn same_bits_for_any_executor() {
    let token = CancelToken::new();
    let run = Run { cancel: &token, executor: &scenes::Threads, clock: &NoClock, ..Run::plain() };
    for p in [scenes::leafy(500), scenes::flower(9), scenes::fork()] {
        let hex = |m: &Model| {
            let mut d = Digest::new();
            d.add(m);
            d.hex()
        };
        let threaded = skin(&p, &SkinSpec::default(), &run).unwrap();
        assert_eq!(hex(&threaded), hex(&skinned(&p)), "{}", p.name);
    }
    token.cancel();
    assert!(skin(&scenes::fork(), &SkinSpec::default(), &run).is_err());
}

#[test]
fn empty_plant_gives_an_empty_model() {
    let model = skinned(&Plant::default());
    assert_eq!((model.parts.len(), model.materials.len()), (0, 0));
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![-1.0..1.0_f64, Just(0.0), Just(1e-9), Just(0.5), Just(1e30), Just(f64::NAN)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_axes_give_a_valid_model(
        lines in prop::collection::vec(
            (prop::collection::vec((coordinate(), coordinate(), coordinate()), 2..8), 0_usize..40, -0.1..0.5_f64),
            1..6,
        ),
        detail in 0.0..4.0_f64,
    ) {
        let mut p = Plant::default();
        for (k, (points, bearer, radius)) in lines.iter().enumerate() {
            let mut line: Vec<DVec3> = points.iter().map(|&(x, y, z)| DVec3::new(x, y, z)).collect();
            let n = p.nodes.position.len();
            let bearer = (n > 0 && bearer % 4 != 0).then(|| plant::NodeId::new(bearer % n));
            if let Some(b) = bearer {
                line[0] = p.nodes.position[b.index()];
            }
            p.add_axis(AxisKind::Branch, bearer, k as u64, &line, None);
            for r in &mut p.nodes.radius_m[n..] {
                *r = *radius;
            }
        }
        let spec = SkinSpec { detail, wind: true, ..SkinSpec::default() };
        let model = skin(&p, &spec, &Run::plain()).unwrap();
        prop_assert_eq!(model.validate().collect::<Vec<_>>(), []);
        for part in &model.parts {
            prop_assert!(part.mesh.normals.iter().flatten().all(|x| x.is_finite()));
            prop_assert!(part.mesh.uvs.iter().flatten().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn leaves_that_are_one_form_are_taken_out_once_each() {
    let p = scenes::leafy(120);
    let spec = SkinSpec { textures: false, ..SkinSpec::default() };
    let run = Run::plain();
    let (model, layout) =
        skin::skin_laid_out(&p, &spec, skin::SurfacePictures::default(), None, &run).expect("a surface");
    let (rest, copies) = skin::copies(&p, &model, &layout);
    assert!(!copies.is_empty() && copies.iter().all(|c| c.places.len() >= 8));
    let taken: usize = copies.iter().map(|c| c.places.len() * c.mesh.triangles.len()).sum();
    assert_eq!(rest.triangle_count() + taken, model.triangle_count());
    // Corners of all triangles, in ten-thousandths of a metre.
    let corners = |parts: &mut dyn Iterator<Item = &TriMesh>| {
        let mut sum = [0.0_f64; 6];
        for m in parts {
            for &i in m.triangles.iter().flatten() {
                let at = m.positions[i as usize].map(f64::from);
                for k in 0..3 {
                    sum[k] += at[k];
                    sum[3 + k] += at[k] * at[k];
                }
            }
        }
        sum
    };
    let flat: Vec<mesh::Part> = copies.iter().map(mesh::Copies::flattened).collect();
    let whole = corners(&mut model.parts.iter().map(|p| &p.mesh));
    let both = corners(&mut rest.parts.iter().chain(&flat).map(|p| &p.mesh));
    for (a, b) in whole.iter().zip(&both) {
        assert!((a - b).abs() < 1e-4 * (1.0 + a.abs()), "{whole:?} {both:?}");
    }
    for part in &flat {
        let before = model.parts.iter().find(|p| p.name == part.name).expect("its part");
        let same = before
            .mesh
            .colors
            .iter()
            .all(|c| part.mesh.colors.contains(c) || rest.parts.iter().any(|r| r.name == part.name));
        assert!(same && part.mesh.normals.len() == part.mesh.positions.len());
    }
}
