//! OPF files read back, and those of other people read by the same reader.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::missing;
use crate::opf_reader;
use std::path::Path;

use base::{Draw, Seed, Unit, UpAxis};
use formats::{ExportSpec, write_opf};
use glam::{DVec2, DVec3};
use mesh::TriMesh;
use opf_reader::{Opf, read};
use plant::{AxisKind, Blade, Frame, Lift, NodeId, Organ, OrganKind, Paint, Plant, Relief, Shape};
use proptest::prelude::*;

/// A kite, and its mesh.
fn blade() -> (Shape, TriMesh) {
    let outline = [(0.0, 0.0), (0.05, 0.1), (0.0, 0.2), (-0.05, 0.1)].map(|(x, y)| DVec2::new(x, y));
    let mut mesh = TriMesh::default();
    for p in outline {
        mesh.push(p.extend(0.0));
    }
    mesh.triangles = vec![[0, 1, 2], [0, 2, 3]];
    mesh.compute_normals();
    let (outline, midrib) = (outline.to_vec(), vec![DVec2::ZERO, DVec2::new(0.0, 0.2)]);
    (
        Shape::Blade(Blade {
            outline,
            midrib,
            veins: vec![],
            needles: None,
            lift: Lift::Flat,
            relief: Relief::default(),
        }),
        mesh,
    )
}

/// Axes upon one another in any order, some upon first nodes, with organs, one of them in the air.
fn wild(seed: u64, axes: usize) -> (Plant, Vec<TriMesh>) {
    let mut s = Seed::new(seed).stream(Draw::Attractors);
    let mut p = Plant { name: "Oak & <co>".into(), ..Plant::default() };
    let (shape, mesh) = blade();
    let shape = p.add_shape(shape);
    for i in 0..axes {
        let count = p.nodes.position.len();
        let bearer = (i > 0 && !s.chance(0.1)).then(|| NodeId::new(s.below(count)));
        let mut line = vec![bearer.map_or(DVec3::X * s.normal(), |b| p.nodes.position[b.index()])];
        for _ in 0..1 + i % 4 {
            let step = DVec3::new(s.normal(), s.uniform(), s.normal());
            line.push(line[line.len() - 1] + step * if s.chance(0.05) { 0.0 } else { 1.0 });
        }
        let id = p.add_axis(AxisKind::Branch, bearer, i as u64, &line, None);
        for node in p.axis(id).node_ids() {
            p.nodes.radius_m[node.index()] = 0.1 * s.uniform();
        }
        let nodes: Vec<NodeId> = p.axis(id).node_ids().collect();
        let bearer = if i == 0 { None } else { Some(nodes[s.below(nodes.len())]) };
        let frame = Frame::looking(line[line.len() - 1], DVec3::new(s.normal(), s.normal(), 1.0), DVec3::Y);
        let kind = if s.chance(0.8) { OrganKind::Leaf } else { OrganKind::Petal };
        let (key, flower, source, paint, scale) = (i as u64, None, None, Paint::default(), 0.5 + s.uniform());
        p.organs.push(Organ { kind, bearer, flower, shape, frame, scale, key, source, paint });
    }
    (p, vec![mesh])
}

fn written(plant: &Plant, shapes: &[TriMesh], spec: &ExportSpec) -> Opf {
    let mut out = Vec::new();
    write_opf(plant, shapes, spec, &mut out).unwrap();
    read(&String::from_utf8(out).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_back(seed in 0_u64..1000, axes in 1_usize..30, z in any::<bool>(), cm in any::<bool>()) {
        let (plant, shapes) = wild(seed, axes);
        let spec = ExportSpec {
            up: if z { UpAxis::Z } else { UpAxis::Y },
            unit: if cm { Unit::Centimetre } else { Unit::Metre },
        };
        let size = if cm { 100.0 } else { 1.0 };
        let file = written(&plant, &shapes, &spec);
        let near = |a: DVec3, b: DVec3| a.distance(b) < 2e-6 * size * (1.0 + b.length() / size);
        // Every node has a name of its own, and hangs on an earlier one.
        let mut ids: Vec<u32> = file.nodes.iter().map(|n| n.id).collect();
        ids.sort_unstable();
        ids.dedup();
        prop_assert_eq!(ids.len(), file.nodes.len());
        prop_assert_eq!(file.nodes[0].attributes[0].1.as_str(), "Oak & <co>");
        let count = |class: &str| file.nodes.iter().filter(|n| n.class == class).count();
        let lone = plant.organs.iter().filter(|o| o.bearer.is_none()).count();
        prop_assert_eq!(count("Axis"), plant.axes.len() + lone);
        prop_assert_eq!(count("Internode"), plant.nodes.position.len() - plant.axes.len());
        prop_assert_eq!(count("Leaf") + count("Petal"), plant.organs.len());
        // Internodes are the pieces of the axes: ends and diameters.
        let place = |p: DVec3| DVec3::from_array(spec.place(p));
        let mut pieces: Vec<[DVec3; 2]> = plant.axes.iter().flat_map(|a| {
            let rows = a.nodes.start as usize..a.nodes.end as usize;
            plant.nodes.position[rows].windows(2).map(|w| [place(w[0]), place(w[1])]).collect::<Vec<_>>()
        }).filter(|[a, b]| a != b).collect();
        for node in file.nodes.iter().filter(|n| n.class == "Internode") {
            let Some((mesh, turn, at, diameters)) = node.geometry else { continue };
            prop_assert!(file.meshes[mesh].1.scales && diameters.iter().all(|d| (0.0..=0.2 * size).contains(d)));
            let ends = [at, at + turn * DVec3::X];
            let found = pieces.iter().position(|p| near(p[0], ends[0]) && near(p[1], ends[1]));
            prop_assert!(found.is_some(), "{ends:?}");
            pieces.swap_remove(found.unwrap());
            let length = node.number("Length").unwrap();
            prop_assert!((length - ends[0].distance(ends[1])).abs() < 1e-5 * size);
            let [y, z] = [turn.y_axis, turn.z_axis];
            prop_assert!((y.length() - 1.0).abs() < 1e-6 && y.dot(z).abs() < 1e-6);
            prop_assert!(node.parent.is_some_and(|p| file.nodes[p].class == "Axis"));
        }
        prop_assert!(pieces.is_empty(), "{pieces:?}");
        // Organs lie where they lie in the plant, in the file's unit and axes.
        for node in file.nodes.iter().filter(|n| n.class == "Leaf" || n.class == "Petal") {
            let number: usize = node.attributes[0].1.split(' ').nth(1).unwrap().parse().unwrap();
            let organ = &plant.organs[number - 1];
            let (mesh, turn, at, _) = node.geometry.unwrap();
            prop_assert_eq!(file.meshes[mesh].1.faces.len(), 2);
            for p in &file.meshes[mesh].1.points {
                prop_assert!(near(turn * *p + at, place(organ.frame.place(*p, organ.scale))));
            }
            let area = 0.01 * organ.scale * organ.scale * size * size;
            prop_assert!((node.number("Area").unwrap() - area).abs() < 1e-6 * size * size);
            prop_assert_eq!(node.edge, if organ.bearer.is_some() { '+' } else { '/' });
        }
    }
}

#[test]
fn a_deep_plant_is_no_deep_recursion() {
    let mut p = Plant::default();
    let mut bearer = None;
    for i in 0..3000_u32 {
        let from = f64::from(i) * DVec3::Y;
        let id = p.add_axis(AxisKind::Branch, bearer, i.into(), &[from, from + DVec3::Y], None);
        bearer = p.axis(id).node_ids().last();
    }
    let mut out = Vec::new();
    write_opf(&p, &[], &ExportSpec::default(), &mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    let count = |word: &str| text.matches(word).count();
    assert_eq!(
        (count("<branch"), count("</branch>"), count("<decomp"), count("</decomp>")),
        (2999, 2999, 3001, 3001)
    );
}

#[test]
fn files_of_other_people_are_read_by_the_same_reader() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mtg/coffee.opf");
    let Ok(text) = std::fs::read_to_string(&file) else {
        return missing::skipped(file.display());
    };
    let coffee = read(&text);
    let count = |class: &str| coffee.nodes.iter().filter(|n| n.class == class).count();
    assert_eq!((count("Axis"), count("Metamer"), count("Leaf")), (158, 1853, 2179));
    let scales: Vec<u32> = ["Individual", "Axis", "Metamer"]
        .iter()
        .map(|class| coffee.nodes.iter().find(|n| n.class == *class).unwrap().scale)
        .collect();
    assert!(scales.windows(2).all(|w| w[0] < w[1]), "{scales:?}");
    // Its conventions are ours: a metamer is a cylinder along x between its ends, with diameters; the next of its axis
    // begins where it ends; leaves are branches.
    let metamers: Vec<_> =
        coffee.nodes.iter().filter(|n| n.class == "Metamer" && n.geometry.is_some()).collect();
    let mut apart = Vec::new();
    for pair in metamers.windows(2).filter(|w| w[1].edge == '<' && w[0].parent == w[1].parent) {
        let [(mesh, turn, at, [down, up]), (_, _, next, [following, _])] =
            [pair[0], pair[1]].map(|n| n.geometry.unwrap());
        assert!(coffee.meshes[mesh].1.scales && up <= down);
        let x = coffee.meshes[mesh].1.points.iter().map(|p| p.x);
        assert_eq!((x.clone().fold(1.0, f64::min), x.fold(0.0, f64::max)), (0.0, 1.0));
        let length = pair[0].number("Length").unwrap();
        assert!((turn.x_axis.length() - length).abs() < 1e-3, "{length} {turn:?}");
        apart.push((at + turn.x_axis).distance(next) / length.max(1.0));
        assert!((up - following).abs() < 0.02 * down, "{up} {following}");
    }
    apart.sort_by(f64::total_cmp);
    assert!(apart.len() > 1000 && apart[apart.len() / 2] < 1e-4, "{} {:?}", apart.len(), apart.last());
    assert!(coffee.nodes.iter().filter(|n| n.class == "Leaf").all(|n| n.edge == '+'));
}
