//! Known trees, scanned by a virtual scanner and found again; and scans that are unusable.

use base::{Draw, Executor, Report, Run, Seed, ops};
use glam::DVec3;
use mesh::{Material, MaterialId, MaterialKind, Model, Part, PointClass, PointCloud, TriMesh};
use plant::{AxisKind, NodeId, Plant};
use scan::{
    ScanPoints, ScanTreeError, ScannerSpec, TreeScanSpec, find_plot, find_tree, scan, wood_gap, wood_mesh,
};

/// Runs jobs in reverse order.
struct Backwards;
impl Executor for Backwards {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        (0..n).rev().for_each(job);
    }
}

/// Returns the plant scaled, with its radii.
fn scaled(mut p: Plant, by: f64) -> Plant {
    p.nodes.position.iter_mut().for_each(|q| *q *= by);
    p.nodes.radius_m.iter_mut().for_each(|r| *r *= by);
    p
}

/// Returns a trunk of 6 m with ten boughs of a metre or two, each with three twigs. Radii follow the pipe model with
/// n = 2.
fn tree() -> Plant {
    let mut p = Plant::default();
    let mut s = Seed::new(4).stream(Draw::Test);
    let line = |from: DVec3, way: DVec3, n: u32| -> Vec<DVec3> {
        (0..=n).map(|i| from + way * (f64::from(i) / f64::from(n))).collect()
    };
    p.add_axis(AxisKind::Branch, None, 0, &line(DVec3::ZERO, DVec3::new(0.2, 6.0, 0.1), 40), None);
    for (k, row) in (0..10_u64).zip((12..).step_by(2)) {
        let bearer = NodeId::new(row);
        let (sin, cos) = ops::sin_cos(2.4 * k as f64);
        let from = p.nodes.position[bearer.index()];
        let way = DVec3::new(cos, 0.6, sin) * (1.8 - 0.1 * k as f64);
        let bough = p.add_axis(AxisKind::Branch, Some(bearer), 1 + k, &line(from, way, 12), None);
        let first = p.axis(bough).nodes.start as usize;
        for t in 0..3 {
            let node = NodeId::new(first + 4 + 3 * t);
            let from = p.nodes.position[node.index()];
            let side = DVec3::new(s.range(-1.0, 1.0), s.range(0.0, 1.0), s.range(-1.0, 1.0)).normalize();
            p.add_axis(
                AxisKind::Branch,
                Some(node),
                100 + 3 * k + t as u64,
                &line(from, side * 0.5, 5),
                None,
            );
        }
    }
    // Pipes: a unit for each tip, and a little for each internode.
    let mut pipes = vec![0.0_f64; p.nodes.position.len()];
    for a in p.axes.iter().rev() {
        let rows: Vec<usize> = a.node_ids().map(NodeId::index).collect();
        let mut sum = 1.0;
        for &r in rows.iter().rev() {
            sum += 0.1 + pipes[r];
            pipes[r] = sum;
        }
        if let Some(b) = a.bearer {
            pipes[b.index()] += sum;
        }
    }
    p.nodes.radius_m = pipes.iter().map(|n| 0.012 * n.sqrt()).collect();
    p
}

fn grid(corner: DVec3, u: DVec3, v: DVec3, n: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for i in 0..=n {
        for j in 0..=n {
            let p = corner + u * (f64::from(i) / f64::from(n)) + v * (f64::from(j) / f64::from(n));
            #[expect(clippy::cast_possible_truncation, reason = "a mesh")]
            mesh.positions.push(p.to_array().map(|c| c as f32));
        }
    }
    let id = |i: u32, j: u32| i * (n + 1) + j;
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    for (i, j) in cells {
        mesh.triangles.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
        mesh.triangles.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
    }
    mesh
}

/// Returns clouds of meshes from three places.
fn cloud(meshes: &[TriMesh]) -> Vec<DVec3> {
    let mut scene = Model::default();
    scene.materials.push(Material::plain("all", MaterialKind::Other, [0.5; 3]));
    for mesh in meshes {
        scene.parts.push(Part { name: "part".into(), material: MaterialId::new(0), mesh: mesh.clone() });
    }
    (0..3_u64)
        .flat_map(|k| {
            let (sin, cos) = ops::sin_cos(ops::TAU * (k as f64 + 0.2) / 3.0);
            let position = DVec3::new(6.0 * cos, 1.6, 6.0 * sin);
            scan(&scene, &ScannerSpec { position, step: 1.5e-3, ..ScannerSpec::default() }, Seed::new(k)).0
        })
        .collect()
}

fn ground() -> TriMesh {
    // A slope of 6 %.
    grid(DVec3::new(-3.0, -0.18, -3.0), DVec3::new(6.0, 0.36, 0.0), DVec3::Z * 6.0, 40)
}

fn moved(mut p: Plant, by: DVec3) -> Plant {
    p.nodes.position.iter_mut().for_each(|q| *q += by);
    p
}

#[test]
fn volume_height_and_diameter_come_back_and_the_cone_is_far_off() {
    let truth = tree();
    let points = cloud(&[wood_mesh(&truth), ground()]);
    let mut report = Report::default();
    let found = find_tree(&points, &TreeScanSpec::default(), &Run::plain(), &mut report).unwrap();
    assert_eq!(found.plant.validate().count(), 0);
    let (a, b) = (truth.measure(), found.plant.measure());
    let near = |x: f64, y: f64| (x / y - 1.0).abs() < 0.05;
    assert!(near(b.height_m, a.height_m), "{} {}", b.height_m, a.height_m);
    assert!(near(b.dbh_m.unwrap(), a.dbh_m.unwrap()), "{:?} {:?}", b.dbh_m, a.dbh_m);
    assert!(near(b.wood_volume_m3, a.wood_volume_m3), "{} {}", b.wood_volume_m3, a.wood_volume_m3);
    // The trivial answer: a cone by allometry.
    let cone = ops::PI / 8.0 * b.dbh_m.unwrap() * b.dbh_m.unwrap() * b.height_m;
    let (ours, its) = (b.wood_volume_m3 - a.wood_volume_m3, cone - a.wood_volume_m3);
    assert!(3.0 * ours.abs() < its.abs(), "{ours} {its}");
    assert_eq!(b.orders[0].axes, 1);
    // Every bough, and a twig or two that seem to leave the trunk.
    assert!((10..=12).contains(&b.orders[1].axes), "{}", b.orders[1].axes);
    let stands = moved(found.plant.clone(), found.foot);
    for (from, to) in [(&truth, &stands), (&stands, &truth)] {
        let gap = wood_gap(from, to, 0.02, 0.01).unwrap();
        assert!(gap.median < 0.004 && gap.p95 < 0.04, "{gap:?}");
    }
    // The same bits, whoever does the work in whichever order.
    let run = Run { executor: &Backwards, ..Run::plain() };
    let again = find_tree(&points, &TreeScanSpec::default(), &run, &mut Report::default()).unwrap();
    assert_eq!(again.plant.digest_hex(), found.plant.digest_hex());
}

/// Returns leaves of 6 cm, ten along each twig and bough.
fn leaves(p: &Plant) -> TriMesh {
    let mut mesh = TriMesh::default();
    let mut s = Seed::new(9).stream(Draw::Test);
    let tips: Vec<DVec3> =
        p.axes[1..].iter().flat_map(|a| a.node_ids()).map(|n| p.nodes.position[n.index()]).collect();
    for at in tips.iter().flat_map(|t| [*t; 6]) {
        let mut way = || DVec3::new(s.normal(), s.normal(), s.normal()).normalize();
        let (long, across) = (way(), way());
        let wide = long.cross(across).normalize() * 0.02;
        let foot = at + long * 0.03;
        let corners = [foot, foot + long * 0.03 + wide, foot + long * 0.06, foot + long * 0.03 - wide];
        let first = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
        #[expect(clippy::cast_possible_truncation, reason = "a mesh")]
        mesh.positions.extend(corners.map(|c| c.to_array().map(|x| x as f32)));
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}

#[test]
fn a_tree_in_leaf_keeps_its_wood_and_its_leaves_are_left_out() {
    let truth = tree();
    let a = truth.measure();
    for (meshes, in_leaf) in [
        (vec![wood_mesh(&truth), leaves(&truth), ground()], true),
        (vec![wood_mesh(&truth), ground()], false),
    ] {
        let mut report = Report::default();
        let found = find_tree(&cloud(&meshes), &TreeScanSpec::default(), &Run::plain(), &mut report).unwrap();
        let b = found.plant.measure();
        println!("in leaf {in_leaf}: {} of {} m3, {:?}", b.wood_volume_m3, a.wood_volume_m3, found.tally);
        assert_eq!(report.warnings.iter().any(|w| w.code == "scan-in-leaf"), in_leaf);
        assert_eq!(found.tally.leaves > 0, in_leaf);
        assert!((b.dbh_m.unwrap() / a.dbh_m.unwrap() - 1.0).abs() < 0.05, "{:?} {:?}", b.dbh_m, a.dbh_m);
        assert!((b.height_m / a.height_m - 1.0).abs() < 0.05, "{} {}", b.height_m, a.height_m);
        let volume = b.wood_volume_m3 / a.wood_volume_m3;
        assert!((volume - 1.0).abs() < 0.15, "{volume}");
    }
}

#[test]
fn half_bits_the_points_change_little() {
    let truth = tree();
    let points = cloud(&[wood_mesh(&truth), ground()]);
    let volume = |step: usize| {
        let some: Vec<DVec3> = points.iter().copied().step_by(step).collect();
        let found =
            find_tree(&some, &TreeScanSpec::default(), &Run::plain(), &mut Report::default()).unwrap();
        found.plant.measure().wood_volume_m3
    };
    let whole = volume(1);
    assert!((volume(2) / whole - 1.0).abs() < 0.06, "{} {whole}", volume(2));
}

#[test]
fn other_trees_walls_and_people_are_left_out() {
    let truth = tree();
    let other = moved(tree(), DVec3::new(3.2, 0.0, 1.0));
    let wall = grid(DVec3::new(-3.0, -0.18, -2.8), DVec3::new(6.0, 0.36, 0.0), DVec3::Y * 2.0, 20);
    let mut person = Plant::default();
    person.add_axis(
        AxisKind::Stem,
        None,
        0,
        &[DVec3::new(-2.0, -0.2, 1.0), DVec3::new(-2.0, 1.6, 1.0)],
        None,
    );
    person.nodes.radius_m.fill(0.2);
    let meshes = [wood_mesh(&truth), wood_mesh(&other), wall, wood_mesh(&person), ground()];
    let points = cloud(&meshes);
    for (at, wanted) in [([0.0, 0.0], DVec3::ZERO), ([3.2, 1.0], DVec3::new(3.2, 0.0, 1.0))] {
        let mut report = Report::default();
        let spec = TreeScanSpec { at: Some(at), ..TreeScanSpec::default() };
        let found = find_tree(&points, &spec, &Run::plain(), &mut report).unwrap();
        assert!((found.foot - wanted).with_y(0.0).length() < 0.1, "{:?}", found.foot);
        assert!(report.warnings.iter().any(|w| w.code == "scan-others"), "{:?}", report.warnings);
        let (a, b) = (truth.measure(), found.plant.measure());
        assert!((b.dbh_m.unwrap() / a.dbh_m.unwrap() - 1.0).abs() < 0.05, "{:?} {:?}", b.dbh_m, a.dbh_m);
    }
    let spec = TreeScanSpec { at: Some([-9.0, -9.0]), ..TreeScanSpec::default() };
    let fault = find_tree(&points, &spec, &Run::plain(), &mut Report::default());
    assert!(matches!(fault, Err(ScanTreeError::NotThere(..))), "{fault:?}");
}

#[test]
fn scans_that_are_no_good_say_so() {
    let run = Run::plain();
    let find = |points: &[DVec3]| {
        let mut report = Report::default();
        let found = find_tree(points, &TreeScanSpec::default(), &run, &mut report);
        (found, report.warnings.iter().map(|w| w.code).collect::<Vec<_>>())
    };
    assert!(matches!(find(&[]).0, Err(ScanTreeError::TooFew(0, _))));
    assert!(matches!(find(&[DVec3::Y; 10]).0, Err(ScanTreeError::TooFew(10, _))));
    assert!(matches!(find(&[DVec3::NAN; 1000]).0, Err(ScanTreeError::TooFew(0, _))));
    // All in one place, and on a line: no panic.
    let _ = find(&[DVec3::ONE; 1000]);
    let line: Vec<DVec3> = (0..1000).map(|i| DVec3::Y * f64::from(i) * 0.001).collect();
    let _ = find(&line);
    let truth = tree();
    let points = cloud(&[wood_mesh(&truth), ground()]);
    // Millimetres taken for metres.
    let large: Vec<DVec3> = points.iter().map(|p| *p * 1000.0).collect();
    assert!(matches!(find(&large).0, Err(ScanTreeError::TooLarge(_))));
    // Lying on its side: the error names the axis that points up.
    let lying: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
    assert!(find(&lying).1.contains(&"scan-lies-down"));
    // Without a ground, and with invalid points.
    let mut bare = cloud(&[wood_mesh(&truth)]);
    bare.extend([DVec3::NAN, DVec3::INFINITY, DVec3::splat(1e300)]);
    let (found, warnings) = find(&bare);
    assert!(warnings.contains(&"scan-no-ground"), "{warnings:?}");
    let found = found.unwrap().plant.measure();
    assert!((found.height_m / truth.measure().height_m - 1.0).abs() < 0.05, "{}", found.height_m);
    // A mirrored tree is a tree.
    let mirrored: Vec<DVec3> = points.iter().map(|p| DVec3::new(-p.x, p.y, p.z)).collect();
    let volume = find(&mirrored).0.unwrap().plant.measure().wood_volume_m3;
    assert!((volume / truth.measure().wood_volume_m3 - 1.0).abs() < 0.05, "{volume}");
}

/// Returns the points of the tree on its slope, without those between two heights over the ground.
fn with_gap(points: &[DVec3], from: f64, to: f64) -> Vec<DVec3> {
    points.iter().copied().filter(|p| !(from..to).contains(&(p.y - 0.06 * p.x))).collect()
}

#[test]
fn a_crown_beyond_a_gap_belongs_to_its_trunk_and_it_is_told() {
    let truth = tree();
    let points = with_gap(&cloud(&[wood_mesh(&truth), ground()]), 0.9, 1.5);
    let mut report = Report::default();
    let found = find_tree(&points, &TreeScanSpec::default(), &Run::plain(), &mut report).unwrap();
    assert!(report.warnings.iter().any(|w| w.code == "scan-gap"), "{:?}", report.warnings);
    assert!(found.tally.wide_gap_m.is_some_and(|g| (0.5..0.75).contains(&g)), "{:?}", found.tally);
    let (a, b) = (truth.measure(), found.plant.measure());
    assert!((b.height_m / a.height_m - 1.0).abs() < 0.02, "{} {}", b.height_m, a.height_m);
    assert!(
        (b.wood_volume_m3 / a.wood_volume_m3 - 1.0).abs() < 0.08,
        "{} {}",
        b.wood_volume_m3,
        a.wood_volume_m3
    );
    // With an explicit gap the search bridges no wider ones, and reports what was left out.
    let spec = TreeScanSpec { gap_m: Some(0.2), ..TreeScanSpec::default() };
    let found = find_tree(&points, &spec, &Run::plain(), &mut Report::default()).unwrap();
    let t = found.tally;
    assert!(t.loose > 2 * t.wood && t.explained < 0.5, "{t:?}");
    assert!(t.next_gap_m.is_some_and(|g| (0.5..0.75).contains(&g)), "{t:?}");
    assert!(t.coverage[0].is_some_and(|c| c > 0.9) && t.coverage[8].is_some_and(|c| c < 0.1), "{t:?}");
}

#[test]
fn trunks_are_counted_and_the_stem_at_a_place_is_taken_and_not_a_weed() {
    let truth = tree();
    let other = moved(tree(), DVec3::new(2.2, 0.1, 0.8));
    // A weed between the two, nearer to the given place.
    let mut weed = Plant::default();
    weed.add_axis(AxisKind::Stem, None, 0, &[DVec3::new(1.9, 0.0, 0.2), DVec3::new(1.9, 0.8, 0.2)], None);
    weed.nodes.radius_m.fill(0.03);
    let points = cloud(&[wood_mesh(&truth), wood_mesh(&other), wood_mesh(&weed), ground()]);
    let found = find_tree(&points, &TreeScanSpec::default(), &Run::plain(), &mut Report::default()).unwrap();
    assert_eq!((found.tally.stems, found.other_stems.len()), (2, 1), "{:?}", found.other_stems);
    let spec = TreeScanSpec { at: Some([2.0, 0.4]), ..TreeScanSpec::default() };
    let found = find_tree(&points, &spec, &Run::plain(), &mut Report::default()).unwrap();
    assert!((found.foot - DVec3::new(2.2, 0.1, 0.8)).with_y(0.0).length() < 0.1, "{:?}", found.foot);
    let (a, b) = (truth.measure(), found.plant.measure());
    assert!((b.height_m / a.height_m - 1.0).abs() < 0.03, "{} {}", b.height_m, a.height_m);
}

#[test]
fn scans_from_the_air_and_in_another_unit_are_refused() {
    let mut s = Seed::new(6).stream(Draw::Test);
    let mut points: Vec<DVec3> = (0..20_000)
        .map(|_| DVec3::new(s.range(-30.0, 30.0), s.range(0.0, 0.1), s.range(-30.0, 30.0)))
        .collect();
    for k in 0..36 {
        let middle = DVec3::new(f64::from(k % 6) * 10.0 - 25.0, 12.0, f64::from(k / 6) * 10.0 - 25.0);
        points.extend((0..400).map(|_| middle + DVec3::new(s.normal(), 2.0 * s.normal(), s.normal()) * 1.2));
    }
    let fault = find_tree(&points, &TreeScanSpec::default(), &Run::plain(), &mut Report::default());
    assert!(matches!(fault, Err(ScanTreeError::Airborne(density, _)) if density < 10.0), "{fault:?}");
    let truth = tree();
    let small: Vec<DVec3> = cloud(&[wood_mesh(&truth), ground()]).iter().map(|p| *p * 0.001).collect();
    let fault = find_tree(&small, &TreeScanSpec::default(), &Run::plain(), &mut Report::default());
    assert!(matches!(fault, Err(ScanTreeError::TooSmall(_))), "{fault:?}");
}

#[test]
fn figures_lie_in_their_intervals() {
    let truth = tree();
    let points = cloud(&[wood_mesh(&truth), ground()]);
    let found = find_tree(&points, &TreeScanSpec::default(), &Run::plain(), &mut Report::default()).unwrap();
    let (a, i) = (truth.measure(), found.intervals);
    let holds = |i: scan::Interval, x: f64| i.low <= x && x <= i.high;
    assert!(holds(i.height_m, a.height_m) && i.dbh_m.is_some_and(|d| holds(d, a.dbh_m.unwrap())), "{i:?}");
    assert!(holds(i.volume_m3, a.wood_volume_m3), "{i:?} {}", a.wood_volume_m3);
    // The intervals are not wider than is useful.
    assert!(i.volume_m3.high < 1.4 * i.volume_m3.low && i.height_m.high < 1.05 * i.height_m.low, "{i:?}");
}

#[test]
fn the_trees_of_a_plot_are_found_and_their_points_shared() {
    let truth = tree();
    // Two equal trees whose crowns touch, 2.4 m apart, a third, undergrowth and a person.
    let places = [DVec3::ZERO, DVec3::new(2.4, 0.14, 0.0), DVec3::new(-0.3, 0.0, -2.4)];
    let mut meshes: Vec<TriMesh> = places.iter().map(|&p| wood_mesh(&moved(tree(), p))).collect();
    for (at, top, radius) in [(DVec3::new(1.2, 0.0, 0.5), 0.5, 0.02), (DVec3::new(-2.0, -0.2, 1.5), 1.6, 0.2)]
    {
        let mut low = Plant::default();
        low.add_axis(AxisKind::Stem, None, 0, &[at, at + DVec3::Y * top], None);
        low.nodes.radius_m.fill(radius);
        meshes.push(wood_mesh(&low));
    }
    meshes.push(ground());
    let points = cloud(&meshes);
    let spec = TreeScanSpec::default();
    let plot = find_plot(&points, &spec, &Run::plain(), &mut Report::default()).unwrap();
    assert_eq!(plot.trees.len(), 3, "{:?}", plot.trees);
    let owned: usize = plot.trees.iter().map(|t| t.points).sum();
    assert_eq!(owned + plot.others + plot.loose + plot.ground_points, plot.points);
    assert!(plot.others > 500, "the person: {}", plot.others);
    let a = truth.measure();
    for (k, tree) in plot.trees.iter().enumerate() {
        let trunk = DVec3::new(tree.place[0], 0.0, tree.place[1]);
        let at = places.iter().find(|p| (**p - trunk).with_y(0.0).length() < 0.15);
        assert!(at.is_some(), "{tree:?}");
        let found = plot.find_tree(k, &spec, &Run::plain(), &mut Report::default()).unwrap();
        let b = found.plant.measure();
        assert!((b.height_m / a.height_m - 1.0).abs() < 0.03, "{k}: {} {}", b.height_m, a.height_m);
        assert!((b.dbh_m.unwrap() / a.dbh_m.unwrap() - 1.0).abs() < 0.08, "{k}: {:?} {:?}", b.dbh_m, a.dbh_m);
        assert!(
            (b.wood_volume_m3 / a.wood_volume_m3 - 1.0).abs() < 0.15,
            "{k}: {} {}",
            b.wood_volume_m3,
            a.wood_volume_m3
        );
    }
    // The result does not depend on the order of the points.
    let turned: Vec<DVec3> = points.iter().rev().copied().collect();
    let again = find_plot(&turned, &spec, &Run::plain(), &mut Report::default()).unwrap();
    let counts = |p: &scan::Plot| p.trees.iter().map(|t| t.points).collect::<Vec<_>>();
    assert_eq!(counts(&again), counts(&plot));
}

/// A bough of the larger tree touches the trunk of the smaller: it takes neither its top nor its boughs.
#[test]
fn a_bough_that_touches_a_smaller_tree_does_not_take_its_top() {
    let (large, small) = (scaled(tree(), 1.4), scaled(tree(), 0.8));
    // The first bough leaves the trunk along +x at 2.5 m, and ends 2.6 m away.
    let at = DVec3::new(1.7, 0.1, 0.05);
    let points = cloud(&[wood_mesh(&large), wood_mesh(&moved(small.clone(), at)), ground()]);
    let spec = TreeScanSpec::default();
    let plot = find_plot(&points, &spec, &Run::plain(), &mut Report::default()).unwrap();
    assert_eq!(plot.trees.len(), 2, "{:?}", plot.trees);
    for (k, truth) in [large, small].iter().enumerate() {
        let found = plot.find_tree(k, &spec, &Run::plain(), &mut Report::default()).unwrap();
        let (a, b) = (truth.measure(), found.plant.measure());
        println!(
            "{k}: height {} of {}, volume {} of {}",
            b.height_m, a.height_m, b.wood_volume_m3, a.wood_volume_m3
        );
        assert!((b.height_m / a.height_m - 1.0).abs() < 0.03, "{k}: {} {}", b.height_m, a.height_m);
        assert!(
            (b.wood_volume_m3 / a.wood_volume_m3 - 1.0).abs() < 0.2,
            "{k}: {} {}",
            b.wood_volume_m3,
            a.wood_volume_m3
        );
    }
}

/// A tree in leaf with its ground: points, and what a file says of them.
fn labelled() -> PointCloud {
    let truth = tree();
    let mut leaves = TriMesh::default();
    let mut s = Seed::new(9).stream(Draw::Test);
    for axis in truth.axes.iter().filter(|a| a.bearer.is_some()) {
        for node in axis.node_ids().flat_map(|node| [node; 8]) {
            let mut any = || DVec3::new(s.range(-1.0, 1.0), s.range(-1.0, 1.0), s.range(-1.0, 1.0));
            let at = truth.nodes.position[node.index()] + 0.15 * any();
            leaves.append(&grid(at, 0.05 * any().normalize(), 0.05 * any().normalize(), 1));
        }
    }
    let mut out = PointCloud::default();
    for (mesh, class) in
        [(ground(), PointClass::Ground), (wood_mesh(&truth), PointClass::Wood), (leaves, PointClass::Leaf)]
    {
        out.points.extend(cloud(&[mesh]));
        out.classes.resize(out.points.len(), class);
    }
    out
}

#[test]
fn ground_wood_and_leaves_are_what_the_file_says() {
    let truth = tree().measure();
    let cloud = labelled();
    let count = |class| cloud.classes.iter().filter(|c| **c == class).count();
    let find = |points: ScanPoints<'_>| {
        let mut report = Report::default();
        let found = find_tree(points, &TreeScanSpec::default(), &Run::plain(), &mut report).unwrap();
        (found, report.warnings.iter().any(|w| w.code == "scan-classes"))
    };
    let (said, is_told) = find((&cloud).into());
    let (seen, is_told_too) = find((&cloud.points).into());
    assert!(is_told && !is_told_too);
    let off =
        |found: &scan::FoundTree| (found.plant.measure().wood_volume_m3 / truth.wood_volume_m3 - 1.0).abs();
    println!("volume off by {:.3} with classes, {:.3} without", off(&said), off(&seen));
    assert!(off(&said) < 0.06 && off(&said) < off(&seen), "{} {}", off(&said), off(&seen));
    assert!((said.plant.measure().height_m / truth.height_m - 1.0).abs() < 0.05);
    // No point of the ground stands on it, and leaves are leaves but for those in cubes of wood.
    assert!(said.tally.ground >= count(PointClass::Ground), "{:?}", said.tally);
    let leaves = said.tally.leaves as f64 / count(PointClass::Leaf) as f64;
    assert!((0.6..1.05).contains(&leaves), "{leaves} {:?}", said.tally);
    // The trees of a plot keep what is said of their points.
    let plot = find_plot(&cloud, &TreeScanSpec::default(), &Run::plain(), &mut Report::default()).unwrap();
    assert_eq!(plot.classes_of(0).len(), plot.points_of(0).len());
    let tree = plot.find_tree(0, &TreeScanSpec::default(), &Run::plain(), &mut Report::default()).unwrap();
    assert!(off(&tree) < 0.06, "{}", off(&tree));
}
