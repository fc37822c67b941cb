//! The wood of every species holds together: each branch grows out of the wood that bears it.

use burgeon::mesh::TriMesh;
use burgeon::{PRESETS, Run, Seed, TreeOptions, make_tree};
use glam::DVec3;

/// One closed piece of a mesh.
struct Piece {
    /// Its first vertices: those of its foot.
    foot: [DVec3; 3],
    triangles: Vec<[DVec3; 3]>,
    low: DVec3,
    high: DVec3,
}

/// The pieces of a mesh in the order of their vertices; vertices at one place are one.
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

/// How often a piece's surface winds around `p` (van Oosterom and Strackee 1983).
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

/// The distance from `p` to a triangle.
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

/// How far `p` is from the nearest other piece, 0 inside one.
fn gap(pieces: &[Piece], own: usize, p: DVec3, most: f64) -> f64 {
    let near = |piece: &Piece| (piece.low - p).max(p - piece.high).max_element() < most;
    let others = || pieces.iter().enumerate().filter(|(i, other)| *i != own && near(other)).map(|(_, o)| o);
    if others().any(|other| winding(other, p) > 0.5) {
        return 0.0;
    }
    others().flat_map(|other| &other.triangles).map(|t| distance(t, p)).fold(most, f64::min)
}

#[test]
fn every_branch_grows_out_of_the_wood_that_bears_it() {
    let (mut branches, mut free, mut partly) = (0, 0, 0);
    for preset in PRESETS {
        let spec = preset.spec().expect("sound");
        let made = make_tree(&spec, Seed::new(1), &TreeOptions::default(), &Run::plain()).expect("a tree");
        let wood = made.model.parts.iter().filter(|p| ["branches", "twigs"].contains(&p.name.as_str()));
        let pieces: Vec<Piece> = wood.flat_map(|p| pieces(&p.mesh)).collect();
        let plant = &made.grown.plant;
        let height = plant.nodes.position.iter().map(|p| p.y).fold(0.0, f64::max);
        // What stands on the ground is borne by nothing.
        let roots = |a: &&plant::Axis| a.bearer.is_none();
        let ground: Vec<DVec3> =
            plant.axes.iter().filter(roots).map(|a| plant.nodes.position[a.nodes.start as usize]).collect();
        for (i, piece) in pieces.iter().enumerate() {
            if ground.iter().any(|g| g.distance(piece.foot[0]) < 1e-3 * height) {
                continue;
            }
            let gaps = piece.foot.map(|p| gap(&pieces, i, p, height));
            branches += 1;
            let worst = gaps.iter().fold(0.0_f64, |a, b| a.max(*b));
            if gaps.iter().all(|g| *g > 0.0) {
                free += 1;
                println!("{}: a foot up to {:.1} mm outside all other wood", preset.key, 1e3 * worst);
            } else if worst > 0.001 {
                partly += 1;
            }
            assert!(worst < 0.003 * height, "{}: a foot {worst} m from all other wood", preset.key);
        }
    }
    println!("of {branches} feet {free} lie outside, {partly} by more than a millimetre in part");
    // A few thin twigs that run along their bearer, or start on its fillet, miss it.
    assert!(
        branches > 40_000 && 5000 * free < branches,
        "{free} of {branches} feet lie outside all other wood"
    );
}
