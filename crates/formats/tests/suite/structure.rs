//! MTG and QSM files read back by readers of the tests' own.
#![expect(clippy::unwrap_used, clippy::panic, reason = "tests")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "row numbers of tables are small"
)]

use crate::missing;
use crate::mtg_reader;
use std::path::Path;

use base::ops::PI;
use base::{Draw, Seed, Unit, UpAxis};
use formats::{
    AddedColumn, ExportSpec, StructureFormat, write_mtg, write_qsm, write_structure_with, write_swc,
};
use glam::{DVec2, DVec3};
use mtg_reader::{Edge, Graph, read};
use plant::{AxisKind, Blade, Frame, Lift, NodeId, Organ, OrganKind, Paint, Plant, Relief, Shape};
use proptest::prelude::*;

fn blade() -> Shape {
    Shape::Blade(Blade {
        outline: [(0.0, 0.0), (0.05, 0.1), (0.0, 0.2), (-0.05, 0.1)].map(|(x, y)| DVec2::new(x, y)).to_vec(),
        midrib: vec![DVec2::ZERO, DVec2::new(0.0, 0.2)],
        veins: vec![],
        needles: None,
        lift: Lift::Flat,
        relief: Relief::default(),
    })
}

/// Axes of every kind in any order of branching, some upon others' first nodes, leaves, and a leaf in the air.
fn wild(seed: u64, axes: usize) -> Plant {
    let mut s = Seed::new(seed).stream(Draw::Attractors);
    let mut p = Plant::default();
    let shape = p.add_shape(blade());
    for i in 0..axes {
        let count = p.nodes.position.len();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to count")]
        let pick = |u: f64| NodeId::new(((u * count as f64) as usize).min(count - 1));
        let bearer = (i > 0 && !s.chance(0.1)).then(|| pick(s.uniform()));
        let foot = DVec3::new(s.normal(), 0.0, s.normal());
        let mut line = vec![bearer.map_or(foot, |b| p.nodes.position[b.index()])];
        for _ in 0..1 + i % 4 {
            let step = if s.chance(0.05) { 0.0 } else { 1.0 };
            line.push(line[line.len() - 1] + DVec3::new(s.normal(), s.uniform(), s.normal()) * step);
        }
        let kinds = [
            AxisKind::Branch,
            AxisKind::Twig,
            AxisKind::Stem,
            AxisKind::Petiole,
            AxisKind::Root,
            AxisKind::Stub,
        ];
        let id = p.add_axis(kinds[if s.chance(0.7) { 0 } else { i % 6 }], bearer, i as u64, &line, None);
        for node in p.axis(id).node_ids() {
            p.nodes.radius_m[node.index()] = s.uniform() * 0.1;
        }
        let tip = p.axis(id).node_ids().last();
        let bearers =
            [if s.chance(0.6) { Some(tip) } else { None }, if s.chance(0.05) { Some(None) } else { None }];
        for bearer in bearers.into_iter().flatten() {
            let along = DVec3::new(s.normal(), s.normal(), s.normal());
            let frame = Frame::looking(line[line.len() - 1], along, DVec3::Y);
            let (key, flower, source) = (p.organs.len() as u64, None, None);
            let kinds = [
                OrganKind::Leaf,
                OrganKind::Petal,
                OrganKind::Disc,
                OrganKind::Fruit,
                OrganKind::Stamen,
                OrganKind::Pistil,
                OrganKind::Thorn,
                OrganKind::Pedicel,
                OrganKind::Body,
                OrganKind::Sepal,
                OrganKind::Anther,
                OrganKind::Floret,
            ];
            let kind = kinds[s.below(kinds.len())];
            p.organs.push(Organ {
                kind,
                bearer,
                flower,
                shape,
                frame,
                scale: 2.0,
                paint: Paint::default(),
                key,
                source,
            });
        }
    }
    assert_eq!(p.validate().next(), None, "a sound plant");
    p
}

fn mtg(plant: &Plant, spec: &ExportSpec) -> Graph {
    let mut bytes = Vec::new();
    write_mtg(plant, spec, &mut bytes).unwrap();
    read(&String::from_utf8(bytes).unwrap()).unwrap()
}

/// The place that a node stands for: the first node of a borne axis is its bearer.
fn place_of(p: &Plant, mut node: NodeId) -> NodeId {
    loop {
        let axis = p.axis(p.nodes.axis[node.index()]);
        match axis.bearer {
            Some(b) if axis.node_ids().next() == Some(node) => node = b,
            _ => return node,
        }
    }
}

/// Checks that a graph holds every axis, node and organ of a plant, in place and borne by the right one.
fn same(p: &Plant, g: &Graph, up: UpAxis, per_metre: f64) {
    let close =
        |a: f64, metres: f64| assert!((a - metres * per_metre).abs() < 2e-6 * per_metre, "{a} {metres}");
    let at = |v: usize, p: DVec3| {
        let there = [g.number(v, "XX"), g.number(v, "YY"), g.number(v, "ZZ")].map(Option::unwrap);
        let turned = if up == UpAxis::Z { DVec3::new(p.x, -p.z, p.y) } else { p };
        turned.to_array().into_iter().zip(there).for_each(|(metres, a)| close(a, metres));
    };
    assert_eq!(g.vertices[0].label, "P1", "the plant comes first");
    let axes: Vec<usize> = g.with_symbol("A").filter(|v| g.word(*v, "Kind") != Some("none")).collect();
    assert_eq!(axes.len(), p.axes.len(), "axes");
    // The vertex of each node that is a place of its own.
    let mut vertex = vec![None; p.nodes.position.len()];
    for &v in &axes {
        let axis = &p.axes[g.index(v) - 1];
        let skip = usize::from(axis.bearer.is_some());
        let nodes: Vec<usize> = g.components(v).filter(|c| g.vertices[*c].label.starts_with('N')).collect();
        assert_eq!(nodes.len(), axis.nodes.len() - skip, "nodes of an axis");
        for (&n, id) in nodes.iter().zip(axis.node_ids().skip(skip)) {
            vertex[id.index()] = Some(n);
            at(n, p.nodes.position[id.index()]);
            close(g.number(n, "TopDia").unwrap(), 2.0 * p.nodes.radius_m[id.index()]);
        }
        for w in nodes.windows(2) {
            assert_eq!(g.vertices[w[1]].parent, Some((w[0], Edge::Follows)), "nodes follow");
        }
        if axis.bearer.is_some() {
            close(g.number(nodes[0], "BotDia").unwrap(), 2.0 * p.nodes.radius_m[axis.nodes.start as usize]);
        }
    }
    for &v in &axes {
        let axis = &p.axes[g.index(v) - 1];
        let bearer = axis.bearer.map(|b| place_of(p, b));
        let first = g.components(v).next().unwrap();
        let expected = bearer.map(|b| (vertex[b.index()].unwrap(), Edge::Bears));
        assert_eq!(g.vertices[first].parent, expected, "what bears an axis");
        // At the scale of axes, too.
        let bearing_axis = bearer.map(|b| p.nodes.axis[b.index()].index() + 1);
        assert_eq!(g.vertices[v].parent.map(|(a, _)| g.index(a)), bearing_axis, "the bearing axis");
    }
    let organs: Vec<usize> = ["L", "K", "D", "U", "B", "S", "C", "T", "Q", "E", "H", "F"]
        .into_iter()
        .flat_map(|s| g.with_symbol(s))
        .collect();
    assert_eq!(organs.len(), p.organs.len(), "organs");
    for v in organs {
        let organ = &p.organs[g.index(v) - 1];
        at(v, organ.frame.origin);
        let bearer = organ.bearer.map(|b| (vertex[place_of(p, b).index()].unwrap(), Edge::Bears));
        assert_eq!(g.vertices[v].parent, bearer, "what bears an organ");
        close(g.number(v, "Length").unwrap(), 0.4);
        // A rhombus of 0.1 by 0.2 m at twice the size.
        let area = g.number(v, "Area").unwrap() / per_metre / per_metre;
        assert!((area - 0.04).abs() < 1e-6, "{area}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn an_mtg_holds_the_whole_structure(seed in 0..10_000_u64, axes in 0..60_usize) {
        let p = wild(seed, axes);
        same(&p, &mtg(&p, &ExportSpec::default()), UpAxis::Y, 1.0);
        let z = ExportSpec { up: UpAxis::Z, unit: Unit::Millimetre };
        same(&p, &mtg(&p, &z), UpAxis::Z, 1000.0);
    }

    #[test]
    fn cylinders_keep_volume_length_and_connection(seed in 0..10_000_u64, axes in 0..60_usize) {
        let p = wild(seed, axes);
        let mut bytes = Vec::new();
        write_qsm(&p, &ExportSpec { up: UpAxis::Z, unit: Unit::Metre }, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let head = text.lines().next().unwrap();
        // The first columns have fixed positions for programs that read by position; after them come those that rTwig
        // reads by name.
        let words: Vec<&str> = head.split(',').collect();
        prop_assert_eq!(words[..5].join(" "), "radius length start_x start_y start_z");
        prop_assert_eq!(words[5..13].join(" "), "axis_x axis_y axis_z parent extension branch BranchOrder PositionInBranch");
        prop_assert_eq!(words[13..].join(" "), "UnmodRadius start.x start.y start.z axis.x axis.y axis.z added start_radius end_radius");
        let rows: Vec<Vec<f64>> =
            text.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        let m = p.measure();
        let volume: f64 = rows.iter().map(|r| PI * r[0] * r[0] * r[1]).sum();
        let length: f64 = rows.iter().map(|r| r[1]).sum();
        prop_assert!((volume - m.wood_volume_m3).abs() < 1e-5 * (1.0 + m.wood_volume_m3), "{} {:?}", volume, m);
        prop_assert!((length - m.length_m).abs() < 1e-4 * (1.0 + m.length_m));
        for (i, r) in rows.iter().enumerate() {
            prop_assert!(r.len() == 23 && r[13] == r[0] && r[14..20] == r[2..8] && r[20] == 0.0);
            let (start, axis) = (DVec3::new(r[2], r[3], r[4]), DVec3::new(r[5], r[6], r[7]));
            prop_assert!((axis.length() - 1.0).abs() < 1e-6 && r[0] >= 0.0 && r[1] > 0.0);
            let parent = r[8] as usize;
            prop_assert!(parent <= i, "bearers come first");
            if parent > 0 {
                let b = &rows[parent - 1];
                let end = DVec3::new(b[2], b[3], b[4]) + DVec3::new(b[5], b[6], b[7]) * b[1];
                let foot = DVec3::new(b[2], b[3], b[4]);
                prop_assert!(start.distance(end) < 1e-4 || start.distance(foot) < 1e-4, "{} {}", start, end);
            }
            let extension = r[9] as usize;
            if extension > 0 {
                let next = &rows[extension - 1];
                prop_assert_eq!((next[8] as usize, next[10], next[12]), (i + 1, r[10], r[12] + 1.0));
            } else {
                prop_assert!(rows.get(i + 1).is_none_or(|next| next[10] != r[10]));
            }
        }
        let branches = rows.iter().map(|r| r[11] as usize).collect::<Vec<_>>();
        prop_assert!(branches.iter().all(|o| *o < m.orders.len()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_skeleton_keeps_places_radii_and_connection(seed in 0..10_000_u64, axes in 0..60_usize) {
        let p = wild(seed, axes);
        let mut bytes = Vec::new();
        write_swc(&p, &ExportSpec { up: UpAxis::Y, unit: Unit::Metre }, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let rows: Vec<Vec<f64>> = text
            .lines()
            .filter(|l| !l.starts_with('#'))
            .map(|l| l.split(' ').map(|x| x.parse().unwrap()).collect())
            .collect();
        // Each node once, but for the first ones of borne axes, which lie on their bearers.
        let borne = p.axes.iter().filter(|a| a.bearer.is_some()).count();
        prop_assert_eq!(rows.len(), p.nodes.position.len() - borne);
        let at = |r: &[f64]| DVec3::new(r[2], r[3], r[4]);
        let mut length = 0.0;
        for (i, r) in rows.iter().enumerate() {
            prop_assert!(r.len() == 7 && r[0] as usize == i + 1 && (5.0..=10.0).contains(&r[1]));
            prop_assert!(r[6] == -1.0 || (r[6] >= 1.0 && r[6] <= i as f64), "bearers come first: {r:?}");
            if r[6] > 0.0 {
                length += at(r).distance(at(&rows[r[6] as usize - 1]));
            }
            let here = |n: usize| p.nodes.position[n].distance(at(r)) < 1e-5 && (p.nodes.radius_m[n] - r[5]).abs() < 1e-7;
            prop_assert!((0..p.nodes.position.len()).any(here), "no node is there: {r:?}");
        }
        let whole: f64 = (0..p.axes.len())
            .flat_map(|i| p.axis_points(plant::AxisId::new(i)).windows(2))
            .map(|w| w[0].distance(w[1]))
            .sum();
        prop_assert!((length - whole).abs() < 1e-4 * (1.0 + whole), "{length} of {whole} m");
    }
}

/// A plant in the dialect of digitised plants: `^`, several entities on a line, ranges, scales that change on the way.
#[test]
fn the_reader_reads_a_digitised_plant_of_our_own() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/structure/digitised.mtg");
    let g = read(&std::fs::read_to_string(path).unwrap()).unwrap();
    let at_scale = |scale: usize| g.vertices.iter().filter(move |v| v.scale == scale);
    assert_eq!([1, 2, 3].map(|s| at_scale(s).count()), [1, 4, 19]);
    assert_eq!(at_scale(3).filter(|v| v.parent.is_none()).count(), 1, "one foot");
    let borne = at_scale(3).filter(|v| v.parent.is_some_and(|(_, edge)| edge == Edge::Bears));
    // The two branches begin at an edge of the coarse scale, the leaves at their own.
    assert_eq!(borne.count(), 4);
    let placed = (0..g.vertices.len()).filter(|&v| g.number(v, "XX").is_some());
    assert_eq!(placed.clone().count(), 8);
    let heights: Vec<f64> = placed.filter_map(|v| g.number(v, "ZZ")).collect();
    assert_eq!(heights, [0.0, 240.0, 310.0, 395.0, 470.0, 520.0, 610.0, 655.0]);
}

/// Real digitised plants: what reads them reads the dialect of the field's own programs.
#[test]
fn the_reader_reads_real_plants() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mtg");
    let files = ["noylum2.mtg", "agraf.mtg", "rose/10.mtg", "rose/459.mtg", "rose/1017.mtg", "mtg1.mtg"];
    for name in files {
        let Ok(bytes) = std::fs::read(folder.join(name)) else {
            missing::skipped(folder.join(name).display());
            continue;
        };
        let text: String = bytes.into_iter().map(char::from).collect();
        let g = read(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let scales = g.vertices.iter().map(|v| v.scale).max().unwrap();
        let placed = (0..g.vertices.len()).filter(|&v| g.number(v, "XX").is_some()).count();
        println!("{name}: {} vertices, {scales} scales, {placed} with a place", g.vertices.len());
        // One plant each, connected: at the finest scale everything but its foot is borne or follows.
        let fine = g.vertices.iter().filter(|v| v.scale == scales);
        let feet = fine.clone().filter(|v| v.parent.is_none()).count();
        assert!(fine.count() >= 3, "{name}");
        assert!(feet <= 2 || name == "mtg1.mtg", "{name}: {feet} feet");
        if name == "noylum2.mtg" {
            assert!(placed > 8_200, "{placed}");
        }
    }
}

#[test]
fn added_columns_are_read_back_row_by_row() {
    let p = wild(7, 12);
    let value = |k: usize| (!k.is_multiple_of(3)).then_some(0.25 * k as f64 - 1.0);
    let column = AddedColumn {
        name: "AbsorbedPAR".into(),
        axes: (0..p.axes.len()).map(value).collect(),
        organs: (0..p.organs.len()).map(|k| value(k + 1)).collect(),
    };
    let short = AddedColumn { name: "fAPAR".into(), axes: Vec::new(), organs: vec![Some(f64::NAN)] };
    let added = [column.clone(), short];
    let written = |format| {
        let mut bytes = Vec::new();
        write_structure_with(&p, &[], &added, format, &ExportSpec::default(), &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    let g = read(&written(StructureFormat::Mtg)).unwrap();
    same(&p, &g, UpAxis::Y, 1.0);
    for v in g.with_symbol("A").filter(|v| g.word(*v, "Kind") != Some("none")) {
        assert_eq!(g.number(v, "AbsorbedPAR"), column.axes[g.index(v) - 1]);
        assert_eq!(g.number(v, "fAPAR"), None);
    }
    let symbols = ["L", "K", "D", "U", "B", "S", "C", "T", "Q", "E", "H", "F"];
    let organs: Vec<usize> = symbols.into_iter().flat_map(|s| g.with_symbol(s)).collect();
    assert!(organs.len() == p.organs.len() && !organs.is_empty());
    for v in organs {
        assert_eq!(g.number(v, "AbsorbedPAR"), column.organs[g.index(v) - 1]);
    }
    let opf = written(StructureFormat::Opf);
    let said = opf.matches("<AbsorbedPAR>").count();
    assert_eq!(said, column.axes.iter().chain(&column.organs).flatten().count());
    assert!(opf.contains("<attribute name=\"fAPAR\" class=\"Double\"/>") && !opf.contains("<fAPAR>"));
}
