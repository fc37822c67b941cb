//! The structure of plants, read back from our own files, and from those of other programs and people.
#![expect(clippy::unwrap_used, clippy::panic, reason = "tests")]

use crate::missing;
use std::fmt::Write as _;
use std::path::Path;

use base::{Draw, Report, Seed, Unit, UpAxis};
use formats::{ExportSpec, ReadStructure, StructureFormat, StructureSpec, read_structure, write_structure};
use glam::DVec3;
use plant::{AxisId, AxisKind, Frame, NodeId, Organ, OrganKind, Paint, Plant, Shape};
use proptest::prelude::*;

/// Axes upon one another in any order: upon tips, one another's forks, and first nodes from `first` on.
fn tree(seed: u64, axes: usize, kinds: &[AxisKind], first: usize) -> Plant {
    let mut s = Seed::new(seed).stream(Draw::Attractors);
    let mut p = Plant::default();
    for i in 0..axes {
        let bearer = (i > 0).then(|| NodeId::new(first + s.below(p.nodes.position.len() - first)));
        let mut line = vec![bearer.map_or(DVec3::ZERO, |b| p.nodes.position[b.index()])];
        for _ in 0..1 + i % 5 {
            line.push(line[line.len() - 1] + DVec3::new(s.normal(), 0.05 + s.uniform(), s.normal()));
        }
        let kind = if i == 0 { AxisKind::Branch } else { kinds[s.below(kinds.len())] };
        let id = p.add_axis(kind, bearer, i as u64, &line, None);
        for node in p.axis(id).node_ids() {
            p.nodes.radius_m[node.index()] = 0.001 + 0.1 * s.uniform();
        }
    }
    assert_eq!(p.validate().next(), None, "a sound plant");
    p
}

fn written(plant: &Plant, format: StructureFormat, spec: &ExportSpec) -> Vec<u8> {
    let mut out = Vec::new();
    write_structure(plant, &[], format, spec, &mut out).unwrap();
    out
}

fn back(bytes: &[u8], format: StructureFormat, spec: &StructureSpec) -> ReadStructure {
    let mut report = Report::default();
    let read = read_structure(bytes, format, "tree", spec, &mut report)
        .unwrap_or_else(|e| panic!("{e}\n{}", String::from_utf8_lossy(bytes)));
    for plant in &read.plants {
        assert_eq!(plant.validate().next(), None, "{format:?}");
    }
    read
}

fn failure(text: &str, format: StructureFormat) -> String {
    let spec = StructureSpec::default();
    let mut report = Report::default();
    read_structure(text.as_bytes(), format, "tree", &spec, &mut report).expect_err("refused").to_string()
}

/// Each axis of a plant is there with its places, radii, kind and bearer.
fn same(p: &Plant, q: &Plant, has_bases: bool) {
    assert_eq!(q.axes.len(), p.axes.len(), "axes");
    for i in 0..p.axes.len() {
        let id = AxisId::new(i);
        let points = p.axis_points(id);
        let is_same = |j: &usize| {
            let other = q.axis_points(AxisId::new(*j));
            other.len() == points.len() && other.iter().zip(points).all(|(a, b)| a.distance(*b) < 1e-5)
        };
        let found = (0..q.axes.len()).find(is_same).unwrap_or_else(|| panic!("axis {i} is gone: {points:?}"));
        let found = AxisId::new(found);
        let skip = usize::from(!has_bases && p.axes[i].bearer.is_some());
        for (a, b) in p.axis_radii(id).iter().zip(q.axis_radii(found)).skip(skip) {
            assert!(
                (a - b).abs() < 2e-6,
                "radii of axis {i}: {:?} {:?}",
                p.axis_radii(id),
                q.axis_radii(found)
            );
        }
        let at = |p: &Plant, b: NodeId| p.nodes.position[b.index()];
        match (p.axis(id).bearer, q.axis(found).bearer) {
            (None, None) => {}
            (Some(a), Some(b)) => assert!(at(p, a).distance(at(q, b)) < 1e-5, "bearer of axis {i}"),
            _ => panic!("axis {i} stands on the ground in one of the two"),
        }
    }
}

fn kinds(p: &Plant) -> Vec<AxisKind> {
    let mut kinds: Vec<AxisKind> = p.axes.iter().map(|a| a.kind).collect();
    kinds.sort();
    kinds
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_we_write_is_read_back(seed in 0..10_000_u64, axes in 1..50_usize, z in any::<bool>(), cm in any::<bool>()) {
        let spec = ExportSpec {
            up: if z { UpAxis::Z } else { UpAxis::Y },
            unit: if cm { Unit::Centimetre } else { Unit::Metre },
        };
        let all = [AxisKind::Branch, AxisKind::Twig, AxisKind::Stem, AxisKind::Petiole, AxisKind::Root, AxisKind::Stub];
        let p = tree(seed, axes, &all, 1);
        // An axis on the very foot may as well be the stem: a table of cylinders or points does not distinguish them.
        for format in [StructureFormat::Mtg, StructureFormat::Opf, StructureFormat::Swc] {
            // They say their unit and axes themselves.
            let read = back(&written(&p, format, &spec), format, &StructureSpec::default());
            prop_assert!(read.plants.len() == 1 && read.tally.unit_said && read.tally.radii_missing == 0, "{:?}", read.tally);
            same(&p, &read.plants[0], format != StructureFormat::Swc);
            prop_assert_eq!(kinds(&p), kinds(&read.plants[0]));
        }
        let wood = tree(seed, axes, &[AxisKind::Branch], 1);
        let told = StructureSpec { up: Some(spec.up), metres: Some(spec.unit.metres()), ..StructureSpec::default() };
        let read = back(&written(&wood, StructureFormat::Qsm, &spec), StructureFormat::Qsm, &told);
        same(&wood, &read.plants[0], true);
        prop_assert_eq!(read.tally.entries, read.tally.used);
    }

    /// The wood is the same in any order of the rows, and without a column for the successor.
    #[test]
    fn tables_may_be_in_any_order(seed in 0..10_000_u64, axes in 1..30_usize) {
        let p = tree(seed, axes, &[AxisKind::Branch], 0);
        let spec = ExportSpec { up: UpAxis::Y, ..ExportSpec::default() };
        let text = String::from_utf8(written(&p, StructureFormat::Swc, &spec)).unwrap();
        let mut rows: Vec<&str> = text.lines().filter(|l| !l.starts_with('#')).collect();
        let mut s = Seed::new(seed).stream(Draw::Curl);
        for k in (1..rows.len()).rev() {
            rows.swap(k, s.below(k + 1));
        }
        let told = StructureSpec { up: Some(UpAxis::Y), ..StructureSpec::default() };
        let read = back(rows.join("\n").as_bytes(), StructureFormat::Swc, &told);
        let (a, b) = (p.measure(), read.plants[0].measure());
        prop_assert!((a.length_m - b.length_m).abs() < 1e-4 * (1.0 + a.length_m), "{} {}", a.length_m, b.length_m);
        prop_assert!((a.height_m - b.height_m).abs() < 1e-5);
    }
}

/// Organs come back in place, with their length and area.
#[test]
fn organs_keep_place_length_and_area() {
    let mut p = tree(3, 12, &[AxisKind::Branch], 0);
    let leaf = p.add_shape(Shape::Blade(plant::BladeForm::Lanceolate.blade()));
    let fruit = p.add_shape(Shape::Dome { radius_m: 0.02, height_m: 0.03 });
    let tips: Vec<NodeId> = p.axes.iter().filter_map(|a| a.node_ids().last()).collect();
    for (k, &tip) in tips.iter().enumerate() {
        let (kind, shape) = if k % 3 == 0 { (OrganKind::Fruit, fruit) } else { (OrganKind::Leaf, leaf) };
        let frame = Frame::looking(p.nodes.position[tip.index()], DVec3::new(1.0, 0.4, 0.2), DVec3::Y);
        let (bearer, flower, source, paint) = (Some(tip), None, None, Paint::default());
        let scale = 0.1 + 0.01 * k as f64;
        p.organs.push(Organ { kind, bearer, flower, shape, frame, scale, paint, key: k as u64, source });
    }
    let spec = ExportSpec { up: UpAxis::Z, ..ExportSpec::default() };
    let read =
        back(&written(&p, StructureFormat::Mtg, &spec), StructureFormat::Mtg, &StructureSpec::default());
    let q = &read.plants[0];
    assert_eq!(q.organs.len(), p.organs.len());
    for organ in &p.organs {
        let near = |o: &&Organ| o.kind == organ.kind && o.frame.origin.distance(organ.frame.origin) < 1e-5;
        let found = q.organs.iter().find(near).expect("the organ");
        assert!(found.frame.along.distance(organ.frame.along) < 1e-4, "direction");
        assert!(found.frame.normal.distance(organ.frame.normal) < 1e-4, "upper side");
        let area = |p: &Plant, o: &Organ| p.shapes[o.shape.index()].one_side_m2() * o.scale * o.scale;
        let (a, b) = (area(&p, organ), area(q, found));
        assert!((a - b).abs() < 0.03 * a, "{:?}: {a} {b}", organ.kind);
        if organ.kind == OrganKind::Leaf {
            let length = |p: &Plant, o: &Organ| p.shapes[o.shape.index()].length().unwrap() * o.scale;
            assert!((length(&p, organ) - length(q, found)).abs() < 1e-5, "length");
        }
    }
}

/// A trunk of two cylinders and a branch, as programs write them.
const TABLES: [(&str, &str); 5] = [
    (
        "TreeQSM's text with its head",
        "radius (m)\tlength (m)\tstart_point\taxis_direction\tparent\textension\tbranch\tbranch_order\tposition_in_branch\tmad\n\
         0.2\t1\t0\t0\t0\t0\t0\t1\t0\t2\t1\t0\t1\t0.001\n0.1\t1\t0\t0\t1\t0\t0\t1\t1\t0\t1\t0\t2\t0.001\n\
         0.05\t2\t0\t0\t1\t1\t0\t0\t1\t0\t2\t1\t1\t0.001\n",
    ),
    (
        "without a head",
        "0.2 1 0 0 0 0 0 1 0 2 1 0 1 0\n0.1 1 0 0 1 0 0 1 1 0 1 0 2 0\n0.05 2 0 0 1 1 0 0 1 0 2 1 1 0\n",
    ),
    (
        "rTwig's, saved by R",
        "\"\",\"id\",\"parent\",\"start_x\",\"start_y\",\"start_z\",\"axis_x\",\"axis_y\",\"axis_z\",\"length\",\"radius\",\"branch\"\n\
         \"1\",1,0,0,0,0,0,0,1,1,0.2,1\n\"2\",2,1,0,0,1,0,0,1,1,0.1,1\n\"3\",3,1,0,0,1,1,0,0,2,0.05,2\n",
    ),
    (
        "SimpleForest's",
        "branchID,branchOrder,segmentID,parentSegmentID,ID,parentID,startX,startY,startZ,endX,endY,endZ,radius,length\n\
         0,0,0,-1,0,-1,0,0,0,0,0,1,0.2,1\n0,0,0,-1,1,0,0,0,1,0,0,2,0.1,1\n1,1,1,0,2,0,0,0,1,2,0,1,0.05,2\n",
    ),
    (
        "of a spreadsheet with decimal commas, and without what goes on",
        "radius;start_x;start_y;start_z;end_x;end_y;end_z;parent\n0,2;0;0;0;0;0;1;0\n0,1;0;0;1;0;0;2;1\n0,05;0;0;1;2;0;1;1\n",
    ),
];

#[test]
fn tables_of_other_programs_are_read() {
    for (name, text) in TABLES {
        if name != "without a head" {
            assert_eq!(StructureFormat::sniff(text.as_bytes()), Some(StructureFormat::Qsm), "{name}");
        }
        let read = back(text.as_bytes(), StructureFormat::Qsm, &StructureSpec::default());
        let p = &read.plants[0];
        assert_eq!((read.plants.len(), p.axes.len()), (1, 2), "{name}");
        assert_eq!(p.axis_points(AxisId::new(0)), [DVec3::ZERO, DVec3::Y, 2.0 * DVec3::Y], "{name}");
        assert_eq!(p.axis_points(AxisId::new(1)), [DVec3::Y, DVec3::new(2.0, 1.0, 0.0)], "{name}");
        let m = p.measure();
        assert_eq!(m.length_m, 4.0, "{name}");
        // Each axis keeps its volume.
        let volume = base::ops::PI * (0.04 + 0.01 + 2.0 * 0.0025);
        assert!((m.wood_volume_m3 - volume).abs() < 1e-12, "{name}: {} {volume}", m.wood_volume_m3);
    }
}

/// A branch that begins in the middle of a long cylinder stands there, and a gap of an axis closes.
#[test]
fn cylinders_are_joined_where_they_meet() {
    let text = "radius,start_x,start_y,start_z,end_x,end_y,end_z,parent,extension\n\
                0.2,0,0,0,0,0,4,0,2\n0.2,0,0,4.1,0,0,6,1,0\n0.05,0.1,0,1,3,0,1,1,0\n0.05,0.9,0,3,3,0,3,1,0\n";
    let p = back(text.as_bytes(), StructureFormat::Qsm, &StructureSpec::default()).plants.remove(0);
    let ys: Vec<f64> = p.axis_points(AxisId::new(0)).iter().map(|q| q.y).collect();
    assert_eq!(ys.len(), 5, "{ys:?}");
    for (y, expected) in ys.iter().zip([0.0, 1.0, 3.0, 4.05, 6.0]) {
        assert!((y - expected).abs() < 0.05, "{ys:?}");
    }
    // The second branch begins far from its bearer's surface.
    assert_eq!([1, 2].map(|k| p.axis_points(AxisId::new(k)).len()), [2, 3]);
}

#[test]
fn radii_that_are_none_follow_from_their_neighbours() {
    let text = "1 5 0 0 0 0.3 -1\n2 5 0 0 1 NaN 1\n3 5 0 0 3 -2 2\n4 5 0 0 4 0.1 3\n5 5 1 0 3 nan 2\n";
    let read = back(text.as_bytes(), StructureFormat::Swc, &StructureSpec::default());
    let p = &read.plants[0];
    assert_eq!(read.tally.radii_missing, 3);
    let trunk = p.axis_radii(AxisId::new(0));
    for (a, b) in trunk.iter().zip([0.3, 0.25, 0.15, 0.1]) {
        assert!((a - b).abs() < 1e-12, "{trunk:?}");
    }
    assert!(p.axis_radii(AxisId::new(1)).iter().all(|r| *r > 0.0 && *r <= 0.125), "{p:?}");
    let bare = "1 5 0 0 0 0 -1\n2 5 0 0 6 x 1\n";
    let p =
        back(bare.replace("0 0 -1", "0 x -1").as_bytes(), StructureFormat::Swc, &StructureSpec::default());
    assert!((p.plants[0].nodes.radius_m[0] - 0.1).abs() < 1e-9, "a sixtieth: {:?}", p.plants[0].nodes);
}

#[test]
fn stems_that_stand_apart_are_plants_and_those_of_a_clump_are_one() {
    let two =
        |apart: f64| format!("1 5 0 0 0 1 -1\n2 5 0 0 9 1 1\n3 5 {apart} 0 0 1 -1\n4 5 {apart} 0 8 1 3\n");
    for (apart, plants) in [(0.5, 1), (4.0, 2)] {
        let read = back(two(apart).as_bytes(), StructureFormat::Swc, &StructureSpec::default());
        assert_eq!(read.plants.len(), plants, "{apart} m apart");
        assert_eq!(read.plants.iter().map(|p| p.axes.len()).sum::<usize>(), 2);
    }
}

#[test]
fn units_of_lengths_and_of_thickness_are_told_apart() {
    let text = "1 5 0 0 0 100 -1\n2 5 0 0 300 50 1\n";
    let spec =
        StructureSpec { metres: Some(0.01), thickness_metres: Some(0.001), ..StructureSpec::default() };
    let p = back(text.as_bytes(), StructureFormat::Swc, &spec).plants.remove(0);
    assert_eq!((p.nodes.position[1].y, p.nodes.radius_m[0]), (3.0, 0.1));
    let micro = StructureSpec { metres: Some(1e-6), ..StructureSpec::default() };
    let p = back(text.as_bytes(), StructureFormat::Swc, &micro).plants.remove(0);
    assert!((p.nodes.position[1].y - 3e-4).abs() < 1e-15, "{p:?}");
}

#[test]
fn what_cannot_be_a_plant_is_refused_with_its_line() {
    let swc = StructureFormat::Swc;
    let round = "1 5 0 0 0 1 -1\n2 5 0 0 1 1 4\n3 5 0 0 2 1 2\n4 5 0 0 3 1 3\n";
    assert!(
        failure(round, swc).contains("line 2: what it hangs on leads round in a circle"),
        "{}",
        failure(round, swc)
    );
    let gone = failure("1 5 0 0 0 1 -1\n2 5 0 0 1 1 7\n", swc);
    assert!(gone.contains("line 2") && gone.contains("the row 7"), "{gone}");
    assert!(failure("1 5 0 0 0 1 -1\n1 5 0 0 1 1 1\n", swc).contains("line 2: the number 1 is there twice"));
    assert!(failure("1 5 0 0 nan 1 -1\n2 5 0 0 1 1 1\n", swc).contains("line 1"));
    assert!(failure("1 5 0 0 1e300 1 -1\n2 5 0 0 1 1 1\n", swc).contains("no place"));
    assert!(failure("1 5 0 0 0 1 -1\n", swc).contains("no axis"));
    assert!(failure("1 5 0 0 0\n", swc).contains("5 numbers"));
    let qsm = StructureFormat::Qsm;
    assert!(failure("radius,parent\n1,0\n", qsm).contains("no column start_x"));
    let head = "radius,start_x,start_y,start_z,end_x,end_y,end_z,parent\n";
    let ring = failure(&format!("{head}1,0,0,0,0,0,1,2\n1,0,0,1,0,0,2,1\n"), qsm);
    assert!(ring.contains("circle"), "{ring}");
    assert!(failure(&format!("{head}1,0,0,0,0,0,1,9\n"), qsm).contains("the cylinder 9"));
    assert!(failure(&format!("{head}1,0,0,x,0,0,1,0\n"), qsm).contains("line 2: the start"));
    let mtg = StructureFormat::Mtg;
    let form = "CODE:\tFORM-A\nCLASSES:\nSYMBOL\tSCALE\nP\t1\nE\t2\nMTG:\nENTITY-CODE\t\tXX\tYY\tZZ\n";
    assert!(failure(&format!("{form}/P1\n^/E1\n^<E2\n"), mtg).contains("has a place"));
    assert!(failure(&format!("{form}\t^/E1\n"), mtg).contains("below nothing"));
    assert!(failure(form, mtg).contains("no entity"));
    let opf = StructureFormat::Opf;
    assert!(
        failure("<opf><topology class=\"Plant\" scale=\"1\" id=\"1\"/></opf>", opf).contains("no internode")
    );
    assert!(failure("<opf><topology>", opf).contains("no sound XML"));
    for format in StructureFormat::ALL {
        assert!(failure(" \n", format).contains("empty"), "{format:?}");
    }
    let many: String = (1..=1200)
        .flat_map(|k| {
            [2 * k - 1, 2 * k].map(|id| {
                let parent = if id % 2 == 1 { -1 } else { id - 1 };
                format!("{id} 5 {k} 0 {} 1 {parent}\n", (id + 1) % 2)
            })
        })
        .collect();
    assert!(failure(&many, swc).contains("limit of 1000"), "{}", failure(&many, swc));
}

/// Each row hangs on the one before, and bears one more: linear time, no recursion.
#[test]
fn long_tables_take_no_longer_than_they_are_long() {
    let mut text = String::from("1 5 0 0 0 0.5 -1\n");
    for k in 2..=120_000_i64 {
        let parent = if k % 3 == 0 { k - 2 } else { k - 1 };
        writeln!(text, "{k} 5 {} {} {} 0.1 {parent}", k % 7, k % 11, k as f64 * 1e-4).unwrap();
    }
    let read = back(text.as_bytes(), StructureFormat::Swc, &StructureSpec::default());
    assert_eq!(read.tally.used, 120_000);
}

/// Real digitised plants, complete and of their true size.
#[test]
fn real_plants_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mtg");
    // Its name, the units of places and diameters, the least and the largest height, the fewest organs.
    let files = [
        ("noylum2.mtg", StructureFormat::Mtg, 0.01, 0.001, [6.0, 12.0], 0),
        ("agraf.mtg", StructureFormat::Mtg, 0.001, 0.0001, [1.0, 4.0], 0),
        ("rose/10.mtg", StructureFormat::Mtg, 0.001, 0.001, [0.05, 1.0], 20),
        ("rose/459.mtg", StructureFormat::Mtg, 0.001, 0.001, [0.05, 1.0], 20),
        ("rose/1017.mtg", StructureFormat::Mtg, 0.001, 0.001, [0.05, 1.0], 20),
        ("coffee.opf", StructureFormat::Opf, 0.01, 0.01, [0.5, 4.0], 2000),
    ];
    for (name, format, metres, thick, [low, high], organs) in files {
        let Ok(bytes) = std::fs::read(folder.join(name)) else {
            missing::skipped(folder.join(name).display());
            continue;
        };
        let spec =
            StructureSpec { metres: Some(metres), thickness_metres: Some(thick), ..StructureSpec::default() };
        let read = back(&bytes, format, &spec);
        assert_eq!(read.plants.len(), 1, "{name}");
        let (p, m) = (&read.plants[0], read.plants[0].measure());
        println!(
            "{name}: {:?}, {} axes, {} nodes, {} organs, {m:?}",
            read.tally,
            p.axes.len(),
            p.nodes.position.len(),
            p.organs.len()
        );
        assert!((low..high).contains(&m.height_m), "{name}: {} m high", m.height_m);
        assert!(p.organs.len() >= organs, "{name}: {} organs", p.organs.len());
        assert!(3 * read.tally.used > read.tally.entries, "{name}: {:?}", read.tally);
    }
    if folder.join("coffee.mtg").exists() {
        let text = std::fs::read_to_string(folder.join("coffee.mtg")).unwrap();
        assert!(failure(&text, StructureFormat::Mtg).contains("XX, YY, ZZ"), "lengths and angles alone");
    }
}

/// A young tree as a digitiser writes it, of our own.
#[test]
fn a_digitised_plant_of_our_own_is_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/structure/digitised.mtg");
    let spec = StructureSpec { metres: Some(0.001), ..StructureSpec::default() };
    let p = back(&std::fs::read(path).unwrap(), StructureFormat::Mtg, &spec).plants.remove(0);
    assert_eq!(p.axes.len(), 3);
    let ys: Vec<f64> = p.axis_points(AxisId::new(0)).iter().map(|q| q.y).collect();
    assert_eq!(ys.len(), 5);
    for (y, expected) in ys.iter().zip([0.0, 0.24, 0.47, 0.61, 0.655]) {
        assert!((y - expected).abs() < 1e-12, "{ys:?}");
    }
    let bearers: Vec<f64> =
        p.axes.iter().filter_map(|a| a.bearer).map(|b| p.nodes.position[b.index()].y).collect();
    for (y, expected) in bearers.iter().zip([0.24, 0.47]) {
        assert!((y - expected).abs() < 1e-12, "{bearers:?}");
    }
    assert!((p.nodes.radius_m[0] - 0.02).abs() < 1e-12);
}
