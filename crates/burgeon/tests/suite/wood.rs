//! The wood of every species is connected: each branch grows out of the wood that bears it.

use burgeon::mesh::{Model, TriMesh};
use burgeon::skin::SkinSpec;
use burgeon::{PRESETS, Run, Seed, TreeOptions, TreeSpec, make_tree};
use glam::DVec3;

use crate::SPECIES;
use crate::share::sample;

/// One closed piece of a mesh.
struct Piece {
    /// Its first vertices: those of its foot.
    foot: [DVec3; 3],
    triangles: Vec<[DVec3; 3]>,
    low: DVec3,
    high: DVec3,
}

/// Returns the pieces of a mesh in the order of their vertices; vertices at one place are one.
fn pieces(mesh: &TriMesh) -> Vec<Piece> {
    let mut parent: Vec<usize> = (0..mesh.positions.len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let join = |parent: &mut [usize], i: usize, j: usize| {
        let (a, b) = (root(parent, i), root(parent, j));
        parent[a.max(b)] = a.min(b);
    };
    let mut places = std::collections::BTreeMap::new();
    for (i, p) in mesh.positions.iter().enumerate() {
        let first = *places.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(i);
        join(&mut parent, first, i);
    }
    for t in &mesh.triangles {
        join(&mut parent, t[0] as usize, t[1] as usize);
        join(&mut parent, t[1] as usize, t[2] as usize);
    }
    let mut found: std::collections::BTreeMap<usize, Piece> = std::collections::BTreeMap::new();
    for t in &mesh.triangles {
        let of = root(&mut parent, t[0] as usize);
        let corners = t.map(|i| mesh.position(i));
        let piece = found.entry(of).or_insert_with(|| Piece {
            foot: [0, 1, 2].map(|k| DVec3::from(mesh.positions[of + k].map(f64::from))),
            triangles: Vec::new(),
            low: DVec3::MAX,
            high: DVec3::MIN,
        });
        piece.triangles.push(corners);
        for p in corners {
            (piece.low, piece.high) = (piece.low.min(p), piece.high.max(p));
        }
    }
    found.into_values().collect()
}

/// Returns how often a piece's surface winds around `p` (van Oosterom and Strackee 1983).
fn winding(piece: &Piece, p: DVec3) -> f64 {
    if p.cmplt(piece.low).any() || p.cmpgt(piece.high).any() {
        return 0.0;
    }
    let angle = |t: &[DVec3; 3]| {
        let [a, b, c] = t.map(|q| q - p);
        let (x, y, z) = (a.length(), b.length(), c.length());
        let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        2.0 * base::ops::atan2(a.dot(b.cross(c)), below)
    };
    piece.triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Returns the distance from `p` to a triangle.
fn distance(t: &[DVec3; 3], p: DVec3) -> f64 {
    let [a, b, c] = *t;
    let n = (b - a).cross(c - a);
    let side = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(n) >= 0.0;
    if side(a, b) && side(b, c) && side(c, a) {
        return (p - a).dot(n.normalize_or_zero()).abs();
    }
    let edge = |a: DVec3, b: DVec3| {
        let d = b - a;
        (a + d * ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0)).distance(p)
    };
    edge(a, b).min(edge(b, c)).min(edge(c, a))
}

/// Returns the distance of `p` from the nearest other piece, 0 inside one.
fn gap(pieces: &[Piece], own: usize, p: DVec3, most: f64) -> f64 {
    let near = |piece: &Piece| (piece.low - p).max(p - piece.high).max_element() < most;
    let others = || pieces.iter().enumerate().filter(|(i, other)| *i != own && near(other)).map(|(_, o)| o);
    if others().any(|other| winding(other, p) > 0.5) {
        return 0.0;
    }
    others().flat_map(|other| &other.triangles).map(|t| distance(t, p)).fold(most, f64::min)
}

/// Feet of the branches of a tree: the distances of the nearest and the farthest of three corners of each from all
/// other wood, metres.
struct Feet {
    height: f64,
    gaps: Vec<[f64; 2]>,
}

impl Feet {
    fn grow(spec: &TreeSpec, seed: u64) -> Self {
        let made = make_tree(spec, Seed::new(seed), &TreeOptions::default(), &Run::plain()).expect("a tree");
        Self::on(&made.grown.plant, &made.model)
    }

    fn on(plant: &plant::Plant, model: &Model) -> Self {
        let wood = model.parts.iter().filter(|p| ["branches", "twigs"].contains(&p.name.as_str()));
        let pieces: Vec<Piece> = wood.flat_map(|p| pieces(&p.mesh)).collect();
        let height = plant.nodes.position.iter().map(|p| p.y).fold(0.0, f64::max);
        // Stems on the ground have no bearer.
        let roots = |a: &&plant::Axis| a.bearer.is_none();
        let ground: Vec<DVec3> =
            plant.axes.iter().filter(roots).map(|a| plant.nodes.position[a.nodes.start as usize]).collect();
        let borne = |piece: &Piece| !ground.iter().any(|g| g.distance(piece.foot[0]) < 1e-3 * height);
        let gaps = |(i, piece): (usize, &Piece)| {
            let gaps = piece.foot.map(|p| gap(&pieces, i, p, height));
            [gaps.iter().fold(f64::INFINITY, |a, b| a.min(*b)), gaps.iter().fold(0.0, |a, b| a.max(*b))]
        };
        let gaps = pieces.iter().enumerate().filter(|(_, piece)| borne(piece)).map(gaps).collect();
        Self { height, gaps }
    }

    /// Counts feet that lie outside all other wood as a whole; and in part, by more than a millimetre.
    fn free(&self) -> [usize; 2] {
        let count = |is: fn(&[f64; 2]) -> bool| self.gaps.iter().filter(|g| is(g)).count();
        [count(|g| g[0] > 0.0), count(|g| g[0] == 0.0 && g[1] > 0.001)]
    }

    fn worst(&self) -> f64 {
        self.gaps.iter().map(|g| g[1]).fold(0.0, f64::max)
    }
}

#[test]
fn every_branch_grows_out_of_the_wood_that_bears_it() {
    let (mut branches, mut free, mut partly) = (0, 0, 0);
    let presets = sample(PRESETS, 1, SPECIES);
    for preset in &presets {
        let feet = Feet::grow(&preset.spec().expect("sound"), 1);
        let [outside, in_part] = feet.free();
        (branches, free, partly) = (branches + feet.gaps.len(), free + outside, partly + in_part);
        let worst = feet.worst();
        println!(
            "{}: {outside} of {} feet outside, the worst by {:.1} mm",
            preset.key,
            feet.gaps.len(),
            1e3 * worst
        );
        assert!(worst < 0.003 * feet.height, "{}: a foot {worst} m from all other wood", preset.key);
    }
    println!("of {branches} feet {free} lie outside, {partly} by more than a millimetre in part");
    // A few thin twigs that run along their bearer, or start on its fillet, miss it.
    assert!(
        branches > 800 * presets.len() && 5000 * free < branches,
        "{free} of {branches} feet lie outside all other wood"
    );
}

#[test]
fn level_limbs_grow_out_of_their_bearers_whatever_the_seed() {
    let cedar = PRESETS.iter().find(|p| p.key == "cedar").expect("a cedar");
    let spec = cedar.spec().expect("sound");
    let (mut branches, mut free) = (0, 0);
    for seed in 1..=9 {
        let feet = Feet::grow(&spec, seed);
        let [outside, in_part] = feet.free();
        (branches, free) = (branches + feet.gaps.len(), free + outside);
        assert!(feet.worst() < 0.02, "seed {seed}: a foot {} m from all other wood", feet.worst());
        println!(
            "seed {seed}: {outside} of {} feet outside, {in_part} in part, the worst by {:.1} mm",
            feet.gaps.len(),
            1e3 * feet.worst()
        );
    }
    assert!(
        branches > 40_000 && 2000 * free < branches,
        "{free} of {branches} feet lie outside all other wood"
    );
}

/// Makes a trunk with level limbs that turn at random by up to a right angle, at intervals of a few of their own
/// diameters, with a twig at each joint. Limbs are a centimetre to `thickest` thick, metres.
fn crooked(seed: u64, thickest: f64) -> plant::Plant {
    use plant::AxisKind::{Branch, Twig};
    let mut stream = Seed::new(seed).stream(base::Draw::Habit);
    let mut plant = plant::Plant::default();
    let trunk: Vec<DVec3> = (0..12).map(|k| DVec3::Y * f64::from(k)).collect();
    let trunk = plant.add_axis(Branch, None, 0, &trunk, None);
    let mut radii = vec![stream.range(0.1, 0.3); 12];
    for (key, node) in (1..11).zip(plant.axis(trunk).node_ids().skip(1)) {
        let mut p = plant.nodes.position[node.index()];
        let mut heading = stream.range(0.0, base::ops::TAU);
        let mut course = vec![p];
        for _ in 0..stream.below(8) + 4 {
            let way = base::turn::direction(heading);
            p += DVec3::new(way.x, stream.range(-0.3, 0.3), way.y) * stream.range(0.15, 0.3);
            course.push(p);
            heading += stream.range(-1.5, 1.5);
        }
        let thick = stream.range(0.01, thickest);
        let limb = plant.add_axis(Branch, Some(node), key, &course, None);
        radii.extend((0..course.len()).map(|k| thick * (1.0 - 0.5 * k as f64 / course.len() as f64)));
        for (k, joint) in plant.axis(limb).node_ids().enumerate().skip(1) {
            let foot = plant.nodes.position[joint.index()];
            let way = base::turn::direction(stream.range(0.0, base::ops::TAU));
            let tip = foot + DVec3::new(way.x, stream.range(-0.5, 0.5), way.y) * 0.5;
            plant.add_axis(Twig, Some(joint), 100 * key + k as u64, &[foot, foot.lerp(tip, 0.5), tip], None);
            radii.extend([0.008, 0.007, 0.005]);
        }
    }
    plant.nodes.radius_m = radii;
    plant
}

/// Returns, for sixty crooked trees, the number of feet, of those outside all other wood, and the worst distance.
#[expect(clippy::print_stdout, reason = "figures for docs/trees.md")]
fn measure_crooked(thickest: f64) -> (usize, usize, f64) {
    let (mut branches, mut free, mut worst) = (0, 0, 0.0_f64);
    for seed in 0..60 {
        let plant = crooked(seed, thickest);
        assert_eq!(plant.validate().next(), None, "seed {seed}");
        let model = skin::skin(&plant, &SkinSpec::default(), &Run::plain()).expect("a surface");
        let feet = Feet::on(&plant, &model);
        let [outside, _] = feet.free();
        (branches, free, worst) = (branches + feet.gaps.len(), free + outside, worst.max(feet.worst()));
        println!(
            "seed {seed}: {outside} of {} feet outside, the worst by {:.1} mm",
            feet.gaps.len(),
            1e3 * feet.worst()
        );
    }
    println!("{free} of {branches} feet outside, the worst by {:.1} mm", 1e3 * worst);
    (branches, free, worst)
}

#[test]
fn twigs_at_the_turns_of_stout_limbs_are_borne_by_them() {
    // Limbs as thick as the distance between two turns.
    let (branches, free, worst) = measure_crooked(0.12);
    assert!(
        branches > 4000 && 1000 * free < branches,
        "{free} of {branches} feet lie outside all other wood"
    );
    assert!(worst < 0.004 * 11.0, "a foot {worst} m from all other wood");
}

#[test]
fn twigs_at_the_turns_of_level_limbs_are_borne_by_them() {
    let (branches, free, worst) = measure_crooked(0.04);
    assert!(worst < 0.003 * 11.0, "a foot {worst} m from all other wood");
    assert!(branches > 4000 && 500 * free < branches, "{free} of {branches} feet lie outside all other wood");
}
