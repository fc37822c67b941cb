//! Made herbs, scanned from all around and cut into organs: leaves found of true ones, whether the organs are the same after
//! the cloud was turned, moved, shuffled and thinned, lengths and areas against the truth.
//!
//! `cargo run --release -p burgeon-bloom --example herb_scans -- [--kept] [CLOUD COUNT]...`
//!
//! Every third herb is kept for one look at the end (`--kept`). Clouds of one's own may be given instead, each with its
//! number of leaves: text or binary PLY, x y z in mm, +Z up.

#![expect(clippy::print_stdout, reason = "this is a program for the terminal")]
#![expect(clippy::expect_used, reason = "a trial without its input is worth nothing")]

use base::{Draw, Report, Run, Seed, Stream, ops};
use bloom::{CleanSpec, ScanOrgan, SegmentSpec, organs};
use glam::{DQuat, DVec3};
use leaf::ScanSpec;
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};
use plant::{AxisKind, Plant};
use scan::ScannerSpec;

/// Ways in which leaves sit on a herb.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Large leaves without stalks in a spiral, dense at the foot.
    Tobacco,
    /// The same, young: broad wavy leaves that lie on one another around a short stem.
    YoungTobacco,
    /// Two seed leaves, and compound leaves in a spiral.
    Tomato,
    /// Seed leaves, and pairs of leaves on stalks.
    Seedling,
    /// Straps in two ranks that hug the stem.
    Maize,
    /// Broad leaves on long stalks in a spiral.
    Cucumber,
    /// Leaves on stalks from the ground, with hardly any stem.
    Rosette,
}

const KINDS: [Kind; 7] = [
    Kind::Tobacco,
    Kind::YoungTobacco,
    Kind::Tomato,
    Kind::Seedling,
    Kind::Maize,
    Kind::Cucumber,
    Kind::Rosette,
];
/// Herbs of each kind.
const SEEDS: u64 = 6;

/// A herb with what is true of it. Its parts are the stem and then the leaves.
struct Herb {
    parts: Vec<TriMesh>,
    stem_m: f64,
    /// One side of the blades of each leaf.
    areas_m2: Vec<f64>,
}

/// Shape of a leaf.
#[derive(Clone, Copy)]
struct LeafShape {
    stalk_m: f64,
    blade_m: f64,
    /// Greatest width of the blade as a share of its length.
    wide: f64,
    /// Where along the blade it is widest, 0 to 1.
    widest: f64,
    /// Elevation at the base, and by how much it sinks to the tip, radians.
    rise: f64,
    sink: f64,
    /// Angle of the halves of the blade to its plane, radians.
    fold: f64,
    /// Pairs of leaflets; 0 for a simple leaf.
    pairs: u32,
    /// Height of the waves of its margin, as a share of its length.
    wave: f64,
}

fn tube(line: &[DVec3], radii: [f64; 2]) -> TriMesh {
    let mut plant = Plant::default();
    plant.add_axis(AxisKind::Stem, None, 0, line, None);
    let last = (line.len() - 1).max(1) as f64;
    for (k, r) in plant.nodes.radius_m.iter_mut().enumerate() {
        *r = ops::lerp(radii[0], radii[1], k as f64 / last);
    }
    scan::wood_mesh(&plant)
}

fn add(to: &mut TriMesh, more: &TriMesh) {
    let first = u32::try_from(to.positions.len()).expect("a small mesh");
    to.positions.extend(&more.positions);
    to.triangles.extend(more.triangles.iter().map(|t| t.map(|i| i + first)));
}

/// Makes the line of a leaf: stalk and midrib, `steps` pieces.
fn midrib(foot: DVec3, azimuth: f64, long: f64, [rise, sink]: [f64; 2], steps: u32) -> Vec<DVec3> {
    let (s, c) = ops::sin_cos(azimuth);
    let mut line = vec![foot];
    let mut at = foot;
    for k in 0..steps {
        let t = (f64::from(k) + 0.5) / f64::from(steps);
        let (up, out) = ops::sin_cos(rise - sink * t);
        at += DVec3::new(out * c, up, out * s) * (long / f64::from(steps));
        line.push(at);
    }
    line
}

/// Makes a blade along a line; returns its mesh.
fn blade(line: &[DVec3], side: DVec3, half_m: impl Fn(f64) -> f64, [fold, wave_m]: [f64; 2]) -> TriMesh {
    const ACROSS: u32 = 8;
    let mut mesh = TriMesh::default();
    let (lift, out) = ops::sin_cos(fold);
    for (k, p) in line.iter().enumerate() {
        let along = line[(k + 1).min(line.len() - 1)] - line[k.saturating_sub(1)];
        let side = side.reject_from(along.normalize_or(DVec3::X)).normalize_or(DVec3::X);
        let normal = side.cross(along).normalize_or(DVec3::Y);
        let normal = if normal.y < 0.0 { -normal } else { normal };
        let half = half_m(k as f64 / (line.len() - 1) as f64);
        for j in 0..=ACROSS {
            let out_at = f64::from(j) / f64::from(ACROSS) * 2.0 - 1.0;
            let u = out_at * half;
            let wave = wave_m * out_at * out_at * ops::sin(0.7 * k as f64 + 2.0 * out_at);
            let at = *p + side * (u * out) + normal * (u.abs() * lift + wave);
            mesh.positions.push(at.as_vec3().to_array());
        }
    }
    for k in 0..u32::try_from(line.len() - 1).expect("a short line") {
        for j in 0..ACROSS {
            let a = k * (ACROSS + 1) + j;
            mesh.triangles.push([a, a + 1, a + ACROSS + 2]);
            mesh.triangles.push([a, a + ACROSS + 2, a + ACROSS + 1]);
        }
    }
    mesh
}

/// Makes a leaf; returns its mesh, and one side of its blades.
fn leaf(foot: DVec3, azimuth: f64, shape: &LeafShape) -> (TriMesh, f64) {
    const STEPS: u32 = 40;
    let long = shape.stalk_m + shape.blade_m;
    let line = midrib(foot, azimuth, long, [shape.rise, shape.sink], STEPS);
    let (s, c) = ops::sin_cos(azimuth);
    let side = DVec3::new(-s, 0.0, c);
    let outline = |wide: f64| {
        move |t: f64| {
            let bend = ops::ln(0.5) / ops::ln(shape.widest);
            0.5 * wide * ops::sin(ops::PI * ops::powf(t, bend)).max(0.02)
        }
    };
    let at = |m: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a row of the line")]
        let k = ((m / long * f64::from(STEPS)).round() as usize).min(line.len() - 2);
        k
    };
    let thick = 0.012 * long;
    if shape.pairs == 0 {
        let from = at(shape.stalk_m);
        let half = outline(shape.wide * shape.blade_m);
        let sheet = blade(&line[from..], side, half, [shape.fold, shape.wave * shape.blade_m]);
        let area = sheet.area();
        let mut mesh = if from > 0 { tube(&line[..=from], [thick, 0.7 * thick]) } else { TriMesh::default() };
        add(&mut mesh, &sheet);
        return (mesh, area);
    }
    let mut mesh = tube(&line, [thick, 0.4 * thick]);
    let mut area = 0.0;
    let mut leaflet = |foot: DVec3, turn: f64, size: f64| {
        let rib = midrib(foot, azimuth + turn, size, [0.2 * shape.rise, 0.5], 16);
        let (s, c) = ops::sin_cos(azimuth + turn);
        let sheet = blade(&rib, DVec3::new(-s, 0.0, c), outline(shape.wide * size), [shape.fold, 0.0]);
        area += sheet.area();
        add(&mut mesh, &sheet);
    };
    let size = 0.5 * shape.blade_m;
    for k in 0..shape.pairs {
        let place = line[at(shape.stalk_m + shape.blade_m * f64::from(k) / f64::from(shape.pairs))];
        leaflet(place, 1.2, 0.8 * size);
        leaflet(place, -1.2, 0.8 * size);
    }
    leaflet(line[line.len() - 1], 0.0, size);
    (mesh, area)
}

/// A leaf with the height at which it sits, and its azimuth.
type Sitting = (f64, f64, LeafShape);

/// A simple leaf, from which the others differ.
const BROAD: LeafShape = LeafShape {
    stalk_m: 0.0,
    blade_m: 0.2,
    wide: 0.5,
    widest: 0.5,
    rise: 0.7,
    sink: 1.0,
    fold: 0.15,
    pairs: 0,
    wave: 0.0,
};

/// Angle between successive leaves of a spiral.
const GOLDEN: f64 = 137.5 / 180.0 * ops::PI;

fn count(s: &mut Stream, low: f64, high: f64) -> u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few leaves")]
    let n = s.range(low, high + 1.0) as u32;
    n
}

/// Returns the share of the way up at which leaf `k` of `n` sits.
fn rank(k: u32, n: u32) -> f64 {
    f64::from(k) / f64::from(n.max(2) - 1)
}

/// Draws the length of the stem and the leaves of a herb; `first` is an azimuth.
fn leaves(kind: Kind, first: f64, s: &mut Stream) -> (f64, Vec<Sitting>) {
    match kind {
        Kind::Tobacco | Kind::YoungTobacco => tobacco(kind == Kind::YoungTobacco, first, s),
        Kind::Tomato => tomato(first, s),
        Kind::Seedling => seedling(first, s),
        Kind::Maize => maize(first, s),
        Kind::Cucumber => cucumber(first, s),
        Kind::Rosette => rosette(first, s),
    }
}

fn tobacco(young: bool, first: f64, s: &mut Stream) -> (f64, Vec<Sitting>) {
    let (n, stem) = (count(s, 5.0, 10.0), if young { s.range(0.03, 0.08) } else { s.range(0.12, 0.4) });
    let sits = (0..n).map(|k| {
        let t = rank(k, n);
        // Dense at the foot; the youngest are small and upright.
        let size = (0.16 + 0.3 * t * (1.0 - t)) * (1.0 - 0.55 * t * t) * s.range(0.9, 1.1);
        let shape = LeafShape {
            wide: if young { 0.65 } else { 0.5 },
            wave: if young { 0.03 } else { 0.0 },
            stalk_m: 0.02 * size,
            blade_m: size,
            rise: s.range(0.4, 0.7) + 0.5 * t,
            sink: s.range(0.5, 1.5) * (1.0 - 0.6 * t),
            ..BROAD
        };
        (stem * (0.12 + 0.88 * ops::powf(t, 1.3)), first + GOLDEN * f64::from(k), shape)
    });
    (stem, sits.collect())
}

/// Draws two seed leaves at a height.
fn seed_leaves(s: &mut Stream, first: f64, height: f64, size: f64) -> Vec<Sitting> {
    let one = |k: u32| {
        let shape = LeafShape {
            stalk_m: 0.3 * size,
            blade_m: size,
            wide: 0.35,
            rise: s.range(0.1, 0.5),
            sink: 0.4,
            ..BROAD
        };
        (height, first + ops::PI * f64::from(k) + s.range(-0.2, 0.2), shape)
    };
    (0..2).map(one).collect()
}

fn tomato(first: f64, s: &mut Stream) -> (f64, Vec<Sitting>) {
    let (n, low) = (count(s, 1.0, 4.0), s.range(0.03, 0.05));
    let mut sits = seed_leaves(s, first, low, 0.03);
    for k in 0..n {
        let size = 0.09 * (1.0 - 0.15 * f64::from(k)) * s.range(0.8, 1.1);
        let shape = LeafShape {
            stalk_m: 0.3 * size,
            blade_m: 0.7 * size,
            rise: s.range(0.5, 0.9),
            sink: s.range(0.3, 0.8),
            pairs: if k + 1 < n { 2 } else { 1 },
            ..BROAD
        };
        sits.push((low + 0.025 + 0.02 * f64::from(k), first + 1.2 + GOLDEN * f64::from(k), shape));
    }
    (low + 0.005 + 0.02 * f64::from(n), sits)
}

fn seedling(first: f64, s: &mut Stream) -> (f64, Vec<Sitting>) {
    let (n, low) = (count(s, 0.0, 2.0), s.range(0.04, 0.07));
    let mut sits = seed_leaves(s, first, low, 0.035);
    for k in 0..2 * n {
        let size = 0.06 * s.range(0.8, 1.1);
        let shape = LeafShape {
            stalk_m: 0.35 * size,
            blade_m: size,
            wide: 0.6,
            widest: 0.4,
            rise: s.range(0.3, 0.9),
            sink: s.range(0.3, 0.8),
            ..BROAD
        };
        let pair = f64::from(k / 2 + 1);
        let azimuth = first + ops::FRAC_PI_2 * pair + ops::PI * f64::from(k % 2);
        sits.push((low + 0.03 * pair, azimuth, shape));
    }
    (low + 0.03 * f64::from(n), sits)
}

fn maize(first: f64, s: &mut Stream) -> (f64, Vec<Sitting>) {
    let (n, stem) = (count(s, 4.0, 8.0), s.range(0.15, 0.3));
    let sits = (0..n).map(|k| {
        let t = rank(k, n);
        let shape = LeafShape {
            blade_m: 0.35 * (0.6 + 1.2 * t * (1.0 - t)) * s.range(0.9, 1.1),
            wide: 0.09,
            widest: 0.4,
            rise: s.range(1.0, 1.25),
            sink: s.range(1.0, 2.2) * (1.0 - 0.5 * t),
            fold: 0.25,
            ..BROAD
        };
        (stem * (0.15 + 0.85 * t), first + ops::PI * f64::from(k) + s.range(-0.25, 0.25), shape)
    });
    (stem, sits.collect())
}

fn cucumber(first: f64, s: &mut Stream) -> (f64, Vec<Sitting>) {
    let (n, stem) = (count(s, 3.0, 7.0), s.range(0.15, 0.3));
    let sits = (0..n).map(|k| {
        let t = rank(k, n);
        let size = 0.11 * (1.0 - 0.4 * t) * s.range(0.85, 1.1);
        let shape = LeafShape {
            stalk_m: 0.8 * size,
            blade_m: size,
            wide: 0.95,
            widest: 0.4,
            rise: s.range(0.5, 1.0),
            sink: s.range(0.6, 1.2),
            ..BROAD
        };
        (stem * (0.25 + 0.75 * t), first + GOLDEN * f64::from(k), shape)
    });
    (stem, sits.collect())
}

fn rosette(first: f64, s: &mut Stream) -> (f64, Vec<Sitting>) {
    let n = count(s, 5.0, 11.0);
    let sits = (0..n).map(|k| {
        let size = 0.07 * s.range(0.7, 1.1);
        let shape = LeafShape {
            stalk_m: 0.6 * size,
            blade_m: size,
            wide: 0.6,
            widest: 0.6,
            rise: s.range(0.4, 1.2),
            sink: s.range(0.3, 0.9),
            ..BROAD
        };
        (0.004 + 0.0008 * f64::from(k), first + GOLDEN * f64::from(k), shape)
    });
    (0.004 + 0.0008 * f64::from(n), sits.collect())
}

fn herb(kind: Kind, seed: u64) -> Herb {
    let mut s = Seed::new(seed).child(kind as u64).stream(Draw::Test);
    let first = s.range(0.0, ops::TAU);
    let (stem_m, leaves) = leaves(kind, first, &mut s);
    let largest = leaves.iter().map(|l| l.2.stalk_m + l.2.blade_m).fold(0.0, f64::max);
    let radius = (0.012 * stem_m.max(largest)).max(0.0008);
    let lean = DVec3::new(s.range(-0.1, 0.1), 0.0, s.range(-0.1, 0.1));
    let place = |h: f64| DVec3::Y * h + lean * (h * h / stem_m);
    let line: Vec<DVec3> = (0..=24).map(|k| place(stem_m * f64::from(k) / 24.0)).collect();
    let mut parts = vec![tube(&line, [radius, 0.6 * radius])];
    let mut areas_m2 = vec![];
    for (height, azimuth, shape) in &leaves {
        let (mesh, area) = leaf(place(*height), *azimuth, shape);
        parts.push(mesh);
        areas_m2.push(area);
    }
    Herb { parts, stem_m: geom::polyline_length3(&line), areas_m2 }
}

/// A cloud, and the part of the herb that each point is of.
struct Cloud {
    name: String,
    points: Vec<DVec3>,
    parts: Vec<u32>,
    leaves: usize,
    truth: Option<Herb>,
}

/// Scans a herb from 14 places around it, in beams a 250th of its size apart, with noise of a tenth of that.
fn scanned(name: String, herb: Herb, seed: u64) -> Cloud {
    let part =
        |mesh: &TriMesh| Part { name: "part".into(), material: MaterialId::new(0), mesh: mesh.clone() };
    let model = Model {
        parts: herb.parts.iter().map(part).collect(),
        materials: vec![Material::plain("all", MaterialKind::Other, [0.5; 3])],
        ..Model::default()
    };
    let places: Vec<DVec3> = herb
        .parts
        .iter()
        .flat_map(|m| m.positions.iter().map(|p| DVec3::from_array(p.map(f64::from))))
        .collect();
    let size = geom::extent(&places);
    let middle = DVec3::Y * (0.5 * places.iter().map(|p| p.y).fold(0.0, f64::max));
    let away = 3.0 * size;
    let (mut points, mut parts) = (vec![], vec![]);
    for k in 0..14_u32 {
        let (around, up) = (f64::from(k) * 2.399_963, [-0.15, 0.35, 0.9][(k % 3) as usize]);
        let ((sa, ca), (se, ce)) = (ops::sin_cos(around), ops::sin_cos(up));
        let spec = ScannerSpec {
            position: middle + DVec3::new(ce * ca, se, ce * sa) * away,
            step: size / 250.0 / away,
            divergence: 0.2 * size / 250.0 / away,
            aperture_m: 0.0,
            noise_m: size / 2500.0,
            pulse_m: size / 250.0,
            range_m: 10.0 * away,
        };
        let (more, of) = scan::scan(&model, &spec, Seed::new(seed).child(u64::from(k)));
        points.extend(more);
        parts.extend(of);
    }
    Cloud { name, points, parts, leaves: herb.areas_m2.len(), truth: Some(herb) }
}

/// Turns, moves and thins a cloud; returns the rows that are kept and their points, in the order of the rows.
fn changed(points: &[DVec3], azimuth: f64, thinned: usize, shuffle: bool) -> (Vec<usize>, Vec<DVec3>) {
    let mut rows: Vec<usize> = (0..points.len()).collect();
    let mut s = Seed::new(7).stream(Draw::Test);
    if shuffle || thinned > 1 {
        for k in (1..rows.len()).rev() {
            rows.swap(k, s.below(k + 1));
        }
    }
    rows.truncate(points.len() / thinned);
    let (sin, cos) = ops::sin_cos(0.5 * azimuth);
    let turn = DQuat::from_xyzw(0.0, sin, 0.0, cos);
    let shift = DVec3::new(0.37, -0.11, 0.73) * if azimuth > 0.0 { 1.0 } else { 0.0 };
    let moved = rows.iter().map(|&i| turn * points[i] + shift).collect();
    (rows, moved)
}

/// Returns the organ of each row; 0 is the stem, `u32::MAX` a row that was left out.
fn labels(found: &[ScanOrgan], rows: &[usize], count: usize) -> Vec<u32> {
    let mut label = vec![u32::MAX; count];
    for (k, organ) in (0_u32..).zip(found) {
        let mark = if organ.name == "stem" { 0 } else { k.max(1) };
        organ.rows.iter().for_each(|&i| label[rows[i]] = mark);
    }
    label
}

/// Returns for each label of `a` but the stem the greatest share (of the union) that a label of `b` but the stem has of it.
fn overlaps(a: &[u32], b: &[u32]) -> Vec<f64> {
    let most = |l: &[u32]| l.iter().copied().filter(|&x| x != u32::MAX).max().unwrap_or(0) as usize + 1;
    let (n, m) = (most(a), most(b));
    let mut both = vec![0_usize; n * m];
    let (mut in_a, mut in_b) = (vec![0_usize; n], vec![0_usize; m]);
    for (&x, &y) in a.iter().zip(b).filter(|(x, y)| **x != u32::MAX && **y != u32::MAX) {
        both[x as usize * m + y as usize] += 1;
        in_a[x as usize] += 1;
        in_b[y as usize] += 1;
    }
    let share =
        |i: usize, j: usize| both[i * m + j] as f64 / (in_a[i] + in_b[j] - both[i * m + j]).max(1) as f64;
    (1..n).filter(|&i| in_a[i] > 0).map(|i| (1..m).map(|j| share(i, j)).fold(0.0, f64::max)).collect()
}

/// Sums over clouds.
#[derive(Default)]
struct Sums {
    clouds: usize,
    near: usize,
    exact: usize,
    changes: usize,
    near_changed: usize,
    same: usize,
    leaves: usize,
    right: usize,
    stems: usize,
    stems_near: usize,
    areas: usize,
    areas_near: usize,
}

/// Deviation of a length of the stem, and of an area of a leaf, that counts as near; shares.
const NEAR: [f64; 2] = [0.05, 0.1];
/// Share of the union of an organ and the true one, or that of the cloud as it was, from which on they are the same.
const SAME: [f64; 2] = [0.7, 0.8];

/// Cuts a cloud as it is and in 15 changed forms; prints a row.
fn trial(cloud: &Cloud, sums: &mut Sums) {
    let run = Run::plain();
    let cut = |azimuth: f64, thinned: usize, shuffle: bool| {
        let (rows, points) = changed(&cloud.points, azimuth, thinned, shuffle);
        let found = organs(&points, &SegmentSpec::default(), &run).expect("enough points");
        let count = found.iter().filter(|o| o.name != "stem").count();
        (count, labels(&found, &rows, cloud.points.len()), found)
    };
    let (count, label, found) = cut(0.0, 1, false);
    let turns = (1..12).map(|k| (ops::TAU * f64::from(k) / 12.0, 1, false));
    let forms = turns.chain([(0.0, 1, true), (0.0, 2, true), (2.0, 2, true), (4.0, 4, true)]);
    let (mut counts, mut same) = (vec![], 0);
    for (azimuth, thinned, shuffle) in forms {
        let (n, other, _) = cut(azimuth, thinned, shuffle);
        counts.push(n);
        same += usize::from(n == count && overlaps(&label, &other).iter().all(|&o| o > SAME[1]));
    }
    let near = |n: &usize| n.abs_diff(cloud.leaves) <= 1;
    print!("{:<15} {:>6} points, leaves {count} of {}", cloud.name, cloud.points.len(), cloud.leaves);
    print!(", changed {counts:?}, the same organs {same} of {}", counts.len());
    sums.clouds += 1;
    sums.near += usize::from(near(&count));
    sums.exact += usize::from(count == cloud.leaves);
    sums.changes += counts.len();
    sums.near_changed += counts.iter().filter(|n| near(n)).count();
    sums.same += same;
    if let Some(truth) = &cloud.truth {
        compare(cloud, truth, (&found, &label), sums);
    }
    println!();
}

/// Compares leaves, stem and areas with what is true.
fn compare(cloud: &Cloud, truth: &Herb, (found, label): (&[ScanOrgan], &[u32]), sums: &mut Sums) {
    let right = overlaps(&cloud.parts, label).iter().filter(|&&o| o > SAME[0]).count();
    sums.leaves += cloud.leaves;
    sums.right += right;
    print!(", right {right}");
    let Some(stem) = found.iter().find(|o| o.name == "stem") else { return };
    if !cloud.name.starts_with("Rosette") {
        let limb = bloom::stem(&stem.points, &Run::plain()).unwrap_or_default();
        let off = geom::polyline_length3(&limb.line) / truth.stem_m - 1.0;
        sums.stems += 1;
        sums.stems_near += usize::from(off.abs() <= NEAR[0]);
        print!(", stem {:+.0} %", 100.0 * off);
    }
    if cloud.name.starts_with("Tomato") {
        return;
    }
    let mut offs = vec![];
    for leaf in found.iter().filter(|o| o.name != "stem") {
        let mut votes = vec![0_usize; truth.areas_m2.len() + 1];
        leaf.rows.iter().for_each(|&i| votes[cloud.parts[i] as usize] += 1);
        let part = (1..votes.len()).max_by_key(|&k| votes[k]).unwrap_or(1);
        if let Some(area) = area(leaf, &stem.points) {
            offs.push(area / truth.areas_m2[part - 1] - 1.0);
        }
    }
    sums.areas += truth.areas_m2.len();
    sums.areas_near += offs.iter().filter(|o| o.abs() <= NEAR[1]).count().min(truth.areas_m2.len());
    let percent: Vec<String> = offs.iter().map(|o| format!("{:+.0}", 100.0 * o)).collect();
    print!(", areas {} %", percent.join(" "));
}

/// Returns one side of the blade of a leaf, as a plant of a scan has it.
fn area(organ: &ScanOrgan, stem: &[DVec3]) -> Option<f64> {
    let run = Run::plain();
    let joint = bloom::joint(&organ.points, stem)?;
    let limb = bloom::stalk(&organ.points, joint, &run).ok()?;
    let base = Some(limb.line.last().copied().unwrap_or(joint));
    let spec = ScanSpec { rows: 32, columns: 21, base, ..ScanSpec::default() };
    let blade = leaf::fit_scan(&limb.beyond, &spec, &run, &mut Report::default()).ok()?;
    let n = blade.columns;
    let half = |a: usize, b: usize, c: usize| {
        let [a, b, c] = [a, b, c].map(|k| blade.grid[k]);
        0.5 * (b - a).cross(c - a).length()
    };
    let corners = (0..blade.grid.len() - n).filter(|k| k % n + 1 < n);
    Some(corners.map(|k| half(k, k + 1, k + n) + half(k + 1, k + n + 1, k + n)).sum())
}

/// Reads a cloud of text, or the points of a binary PLY of three singles a point; mm, +Z up.
fn read(path: &str) -> Vec<DVec3> {
    let up = |p: [f64; 3]| DVec3::new(p[0], p[2], -p[1]) * 1e-3;
    let bytes = std::fs::read(path).expect("a file");
    let head = b"end_header\n";
    if let Some(at) = bytes.windows(head.len()).position(|w| w == head) {
        let single = |b: &[u8]| b.try_into().map_or(0.0, |b| f64::from(f32::from_le_bytes(b)));
        let row = |r: &[u8]| up([single(&r[..4]), single(&r[4..8]), single(&r[8..12])]);
        return bytes[at + head.len()..].chunks_exact(12).map(row).collect();
    }
    let text = String::from_utf8(bytes).expect("text");
    let numbers = |l: &str| l.split_whitespace().filter_map(|w| w.parse().ok()).collect::<Vec<f64>>();
    text.lines().map(numbers).filter(|n| n.len() >= 3).map(|n| up([n[0], n[1], n[2]])).collect()
}

fn main() {
    let mut kept = false;
    let mut clouds = vec![];
    let mut args = std::env::args().skip(1);
    while let Some(path) = args.next() {
        if path == "--kept" {
            kept = true;
            continue;
        }
        let leaves = args.next().and_then(|n| n.parse().ok()).expect("a number of leaves");
        let all = read(&path);
        let spec = CleanSpec { plane: false, ..CleanSpec::default() };
        let rows = bloom::clean(&all, &spec, Seed::new(1), &Run::plain()).expect("not cancelled").kept;
        let points: Vec<DVec3> = rows.iter().map(|&i| all[i]).collect();
        let name = path.rsplit('/').next().unwrap_or_default().to_owned();
        clouds.push(Cloud { name, points, parts: vec![], leaves, truth: None });
    }
    let mut sums = Sums::default();
    clouds.iter().for_each(|cloud| trial(cloud, &mut sums));
    if clouds.is_empty() {
        let all = KINDS.iter().flat_map(|&kind| (0..SEEDS).map(move |seed| (kind, seed)));
        for (kind, seed) in all.filter(|(_, seed)| (seed % 3 == 2) == kept) {
            trial(&scanned(format!("{kind:?}-{seed}"), herb(kind, seed), seed), &mut sums);
        }
    }
    let s = &sums;
    println!("leaves within 1: {} of {} clouds, exact {}", s.near, s.clouds, s.exact);
    println!("changed clouds: within 1 {}, the same organs {} of {}", s.near_changed, s.same, s.changes);
    println!("leaves right {} of {}", s.right, s.leaves);
    println!(
        "stems within 5 %: {} of {}; areas within 10 %: {} of {}",
        s.stems_near, s.stems, s.areas_near, s.areas
    );
}
