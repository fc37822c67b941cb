//! Wind: weights between 0 and 1 that do not jump, and nothing else that changes.

use crate::scenes;
use base::{CancelToken, NoClock, Run};
use glam::DVec3;
use mesh::{MaterialKind, Model, TriMesh};
use plant::{AxisKind, Plant};
use skin::{SkinSpec, skin};

fn scenes() -> Vec<Plant> {
    vec![
        scenes::fork(),
        scenes::tree(40, AxisKind::Branch),
        scenes::tree(40, AxisKind::Twig),
        scenes::flower(7),
        scenes::leafy(120),
        scenes::still_life(),
    ]
}

fn blown(p: &Plant) -> Model {
    let spec = SkinSpec { wind: true, ..SkinSpec::default() };
    let model = skin(p, &spec, &Run::plain()).expect("nobody cancels");
    assert_eq!(model.validate().collect::<Vec<_>>(), [], "{}", p.name);
    model
}

/// Makes a stem of 1 m with a stalk of 0.08 m.
fn stalked() -> Plant {
    let mut p = Plant { name: "stalked".into(), ..Plant::default() };
    p.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y * 0.5, DVec3::Y], None);
    let line = [DVec3::Y * 0.5, DVec3::new(0.08, 0.5, 0.0)];
    p.add_axis(AxisKind::Petiole, Some(plant::NodeId::new(1)), 2, &line, None);
    p.nodes.radius_m = vec![0.005, 0.005, 0.004, 0.001, 0.001];
    p
}

/// Makes a trunk of 1 m with a branch of 2 m.
fn spread() -> Plant {
    let mut p = Plant { name: "spread".into(), ..Plant::default() };
    p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 0.5, DVec3::Y], None);
    let line = [DVec3::Y * 0.5, DVec3::new(1.0, 0.5, 0.0), DVec3::new(2.0, 0.6, 0.0)];
    p.add_axis(AxisKind::Branch, Some(plant::NodeId::new(1)), 2, &line, None);
    p.nodes.radius_m = vec![0.05, 0.05, 0.02, 0.03, 0.02, 0.01];
    p
}

fn is_wood(model: &Model, part: &mesh::Part) -> bool {
    matches!(
        model.material(part).kind,
        MaterialKind::Bark | MaterialKind::YoungBark | MaterialKind::Stem | MaterialKind::Root
    )
}

#[test]
fn wind_adds_its_columns_and_few_rings() {
    for p in scenes() {
        let still = skin(&p, &SkinSpec::default(), &Run::plain()).expect("nobody cancels");
        assert!(still.parts.iter().all(|p| p.mesh.wind.is_empty() && p.mesh.pivots.is_empty()));
        let mut model = blown(&p);
        for (part, before) in model.parts.iter_mut().zip(&still.parts) {
            assert_eq!(part.mesh.wind.len(), part.mesh.positions.len(), "{}: {}", p.name, part.name);
            assert_eq!(part.mesh.pivots.len(), part.mesh.positions.len(), "{}: {}", p.name, part.name);
            part.mesh.wind.clear();
            part.mesh.pivots.clear();
            let (now, then) = (part.mesh.triangles.len(), before.mesh.triangles.len());
            assert!(now >= then && 10 * now <= 11 * then, "{}: {}: {then} to {now}", p.name, part.name);
            if now == then {
                assert_eq!(part, before, "{}", p.name);
            }
        }
        assert_eq!(model.materials, still.materials);
    }
}

#[test]
fn ground_is_still_and_the_top_sways() {
    for p in scenes() {
        let model = blown(&p);
        let mut top = 0.0_f32;
        for part in &model.parts {
            for (at, w) in part.mesh.positions.iter().zip(&part.mesh.wind) {
                assert!(at[1] > 0.0 || w[0] == 0.0, "{}: {w:?} at {at:?}", p.name);
                assert!(!is_wood(&model, part) || w[2] == 0.0, "wood does not flutter: {w:?}");
                top = top.max(w[0]);
            }
        }
        assert!(top > 0.9, "{}: {top} at the top", p.name);
    }
}

#[test]
fn longest_branch_moves_most_and_main_axes_and_roots_not_by_themselves() {
    let most = |p: &Plant| {
        let model = blown(p);
        model.parts.iter().flat_map(|p| &p.mesh.wind).map(|w| w[1]).fold(0.0, f32::max)
    };
    let fork = most(&scenes::fork());
    assert!(fork > 0.5, "{fork}");
    assert_eq!(most(&spread()), 1.0);
    let stalk = most(&stalked());
    assert!((0.01..0.05).contains(&stalk), "{stalk}: a short stalk on a high stem moves little");
    for p in [scenes::flower(7), scenes::still_life()] {
        assert!(blown(&p).parts.iter().flat_map(|p| &p.mesh.wind).all(|w| w[1] == 0.0), "{}", p.name);
    }
}

/// A connected piece of a mesh: its vertices lie in one range, as it was written.
struct Piece {
    vertices: core::ops::Range<usize>,
    triangles: Vec<[u32; 3]>,
}

fn pieces(mesh: &TriMesh) -> Vec<Piece> {
    let mut home: Vec<usize> = (0..mesh.positions.len()).collect();
    fn find(home: &mut [usize], mut i: usize) -> usize {
        while home[i] != i {
            home[i] = home[home[i]];
            i = home[i];
        }
        i
    }
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2])] {
            let (a, b) = (find(&mut home, a as usize), find(&mut home, b as usize));
            let (low, high) = (a.min(b), a.max(b));
            home[high] = low;
        }
    }
    let mut all: Vec<Piece> = Vec::new();
    let mut of: Vec<Option<usize>> = vec![None; home.len()];
    for t in &mesh.triangles {
        let root = find(&mut home, t[0] as usize);
        let k = *of[root].get_or_insert_with(|| {
            all.push(Piece { vertices: t[0] as usize..t[0] as usize + 1, triangles: Vec::new() });
            all.len() - 1
        });
        all[k].triangles.push(*t);
        for i in t.map(|i| i as usize) {
            let range = &mut all[k].vertices;
            *range = range.start.min(i)..range.end.max(i + 1);
        }
    }
    all
}

/// Returns the nearest point of a triangle, as its corners' shares.
fn nearest(p: DVec3, [a, b, c]: [DVec3; 3]) -> (f64, [f64; 3]) {
    let on = |a: DVec3, b: DVec3| {
        let d = b - a;
        ((p - a).dot(d) / d.length_squared().max(1e-300)).clamp(0.0, 1.0)
    };
    let (ab, bc, ca) = (on(a, b), on(b, c), on(c, a));
    let mut tries = vec![[1.0 - ab, ab, 0.0], [0.0, 1.0 - bc, bc], [ca, 0.0, 1.0 - ca]];
    let n = (b - a).cross(c - a);
    let area = n.length_squared().max(1e-300);
    let inside = [(c - b).cross(p - b).dot(n) / area, (a - c).cross(p - c).dot(n) / area];
    let inside = [inside[0], inside[1], 1.0 - inside[0] - inside[1]];
    if inside.iter().all(|x| *x >= 0.0) {
        tries.push(inside);
    }
    let far = |w: &[f64; 3]| p.distance(a * w[0] + b * w[1] + c * w[2]);
    let best = tries.into_iter().min_by(|x, y| far(x).total_cmp(&far(y)));
    best.map_or((f64::MAX, [1.0, 0.0, 0.0]), |w| (far(&w), w))
}

/// Attributes of the mesh at the point of `pieces` nearest to `p`.
#[derive(Clone, Copy)]
struct There {
    /// Sway of the plant and of the limb.
    sway: [f64; 2],
    phase: f32,
    far: f64,
}

fn wind_at(mesh: &TriMesh, pieces: &[&Piece], p: DVec3) -> There {
    let mut best = There { sway: [0.0; 2], phase: 0.0, far: f64::MAX };
    for t in pieces.iter().flat_map(|piece| &piece.triangles) {
        let (far, shares) = nearest(p, t.map(|i| mesh.position(i)));
        if far < best.far {
            let wind = t.map(|i| mesh.wind[i as usize]);
            let mean = |c: usize| (0..3).map(|k| shares[k] * f64::from(wind[k][c])).sum();
            best = There { sway: [mean(0), mean(1)], phase: wind[0][3], far };
        }
    }
    best
}

/// Returns all wood of a model as one mesh.
fn wood(model: &Model) -> TriMesh {
    let mut all = TriMesh::default();
    for part in model.parts.iter().filter(|p| is_wood(model, p)) {
        all.append(&part.mesh);
    }
    all
}

#[test]
fn a_foot_goes_with_its_bearer() {
    let mut feet = 0;
    let plants = [scenes::fork(), scenes::tree(40, AxisKind::Branch), scenes::leafy(0)];
    for (p, detail) in plants.iter().flat_map(|p| [1.0, 0.3, 0.05].map(|d| (p, d))) {
        let spec = SkinSpec { wind: true, detail, ..SkinSpec::default() };
        let mesh = wood(&skin(p, &spec, &Run::plain()).expect("nobody cancels"));
        let pieces = pieces(&mesh);
        for (k, piece) in pieces.iter().enumerate() {
            let first = piece.vertices.start;
            // The foot's row ends at its start; a tube on the ground begins with the centre of its base.
            let mut row = piece.vertices.clone().skip(1);
            let Some(width) = row.position(|i| mesh.positions[i] == mesh.positions[first]) else { continue };
            let others: Vec<&Piece> =
                pieces.iter().enumerate().filter(|&(i, _)| i != k).map(|(_, p)| p).collect();
            for i in first..=first + width {
                let there = wind_at(&mesh, &others, DVec3::from(mesh.positions[i].map(f64::from)));
                let own = mesh.wind[i];
                for c in 0..2 {
                    let off = (f64::from(own[c]) - there.sway[c]).abs();
                    assert!(off < 0.01, "{}, {detail}: {own:?} on {:?}", p.name, there.sway);
                }
                let still = there.sway[1] < 1e-6;
                assert!(still || own[3] == there.phase, "{own:?} on phase {}", there.phase);
                feet += 1;
            }
        }
    }
    assert!(feet > 900, "{feet} vertices of feet");
}

#[test]
fn neighbours_along_a_branch_move_alike() {
    for p in [scenes::fork(), scenes::tree(40, AxisKind::Branch), scenes::leafy(0)] {
        let mesh = wood(&blown(&p));
        let longest = p.axes.iter().filter(|a| a.bearer.is_some()).count();
        assert!(longest > 0);
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let far = mesh.position(a).distance(mesh.position(b));
                let (w, v) = (mesh.wind[a as usize], mesh.wind[b as usize]);
                // Limbs of these plants reach 0.6 m and more; 3/2 is the steepest slope.
                assert!(f64::from((w[1] - v[1]).abs()) < 0.02 + 1.5 * far / 0.5, "{w:?} {v:?} over {far} m");
                assert_eq!((w[3], mesh.pivots[a as usize]), (v[3], mesh.pivots[b as usize]));
            }
        }
    }
}

#[test]
fn leaves_stay_on_their_twigs() {
    let p = scenes::leafy(120);
    let model = blown(&p);
    let mesh = wood(&model);
    let pieces = pieces(&mesh);
    let all: Vec<&Piece> = pieces.iter().collect();
    let leaves = &model.parts.iter().find(|p| p.name == "leaves").expect("leaves").mesh;
    let mut seen = 0;
    for leaf in self::pieces(leaves) {
        let first = leaf.vertices.start;
        let root = DVec3::from(leaves.pivots[first].map(f64::from));
        let There { sway, phase, far } = wind_at(&mesh, &all, root);
        let (mut still, mut most) = (f32::MAX, 0.0_f32);
        for i in leaf.vertices.clone() {
            let w = leaves.wind[i];
            assert_eq!(leaves.pivots[i], leaves.pivots[first], "one pivot a leaf");
            assert_eq!((w[1], w[3]), (leaves.wind[first][1], leaves.wind[first][3]), "moves with the limb");
            still = still.min(w[2]);
            most = most.max(w[2]);
        }
        assert!(still < 1e-6 && most == 1.0, "a leaf flutters from root to tip: {still}, {most}");
        // Nodes lie within the wood, which bends around them.
        if far < 0.02 && sway[1] > 0.0 {
            let w = leaves.wind[first];
            assert!((f64::from(w[1]) - sway[1]).abs() < 0.03, "{w:?} on {sway:?}, {far} m away");
            seen += usize::from(w[3] == phase);
        }
    }
    assert!(seen > 60, "{seen} leaves have the phase of the wood they are on");
}

#[test]
fn phases_differ_from_limb_to_limb_and_follow_the_seed() {
    let p = scenes::tree(40, AxisKind::Branch);
    let phases = |seed: u64| -> Vec<u32> {
        let spec = SkinSpec { wind: true, seed: base::Seed::new(seed), ..SkinSpec::default() };
        let model = skin(&p, &spec, &Run::plain()).expect("nobody cancels");
        let mut all: Vec<u32> = model
            .parts
            .iter()
            .flat_map(|p| &p.mesh.wind)
            .filter(|w| w[1] > 0.0)
            .map(|w| w[3].to_bits())
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    assert!(phases(1).len() > 3, "{:?}", phases(1).len());
    assert_eq!(phases(1), phases(1));
    assert_ne!(phases(1), phases(2));
}

#[test]
fn same_wind_for_any_executor() {
    let token = CancelToken::new();
    let run = Run { cancel: &token, executor: &scenes::Threads, clock: &NoClock, ..Run::plain() };
    let spec = SkinSpec { wind: true, ..SkinSpec::default() };
    for p in scenes() {
        assert_eq!(skin(&p, &spec, &run).expect("nobody cancels"), blown(&p), "{}", p.name);
    }
}

#[test]
fn joints_sway_as_the_columns_say_and_come_back() {
    let gust = DVec3::new(0.15, 0.0, 0.04);
    for p in scenes().into_iter().chain([spread(), stalked()]) {
        let model = blown(&p);
        let Some(rig) = skin::sway(&model, gust) else {
            assert!(model.bounds().size().y <= 0.0 || model.parts.is_empty(), "{}", p.name);
            continue;
        };
        assert!(rig.fits(&model), "{}", p.name);
        assert!(rig.moves.iter().all(|m| m.first() == m.last()), "{}: no loop", p.name);
        // Nothing tears: coincident vertices, in whatever part, move alike to a hundredth of the gust, as their columns
        // do.
        let mut seen: std::collections::BTreeMap<[i64; 3], (DVec3, [f32; 4])> =
            std::collections::BTreeMap::new();
        for (part, holds) in model.parts.iter().zip(&rig.holds) {
            for ((at, hold), wind) in part.mesh.positions.iter().zip(holds).zip(&part.mesh.wind) {
                let at = DVec3::from(at.map(f64::from));
                for key in [3, 11] {
                    let far = rig.moved(at, hold, key) - at;
                    assert!(far.length() < 3.0 * gust.length(), "{}: {far}", p.name);
                    if wind[0] < 1e-6 && wind[1] < 1e-6 {
                        assert!(far.length() < 1e-3 * gust.length(), "{}: the ground moves by {far}", p.name);
                    }
                    if key == 3 {
                        #[expect(clippy::cast_possible_truncation, reason = "micrometres of small plants")]
                        let place = (at * 1e6).to_array().map(|x| x.round() as i64);
                        let (before, columns) = *seen.entry(place).or_insert((far, *wind));
                        let alike = (0..4).all(|k| (columns[k] - wind[k]).abs() < 0.01);
                        assert!(
                            !alike || before.distance(far) < 0.1 * gust.length(),
                            "{}: {before} {far}",
                            p.name
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn the_tip_of_a_level_limb_swings_by_the_gust() {
    let model = blown(&spread());
    let gust = DVec3::new(0.0, 0.0, 0.1);
    let rig = skin::sway(&model, gust).expect("it has wind");
    assert_eq!(rig.joints.len(), 3, "ground, trunk, one limb");
    let part = &model.parts[0];
    let tip =
        (0..part.mesh.positions.len()).max_by(|a, b| part.mesh.wind[*a][1].total_cmp(&part.mesh.wind[*b][1]));
    let tip = tip.expect("a vertex");
    let at = DVec3::from(part.mesh.positions[tip].map(f64::from));
    // About its mean, which is that of the trunk's lean.
    let z: Vec<f64> = (0..rig.seconds.len()).map(|k| (rig.moved(at, &rig.holds[0][tip], k) - at).z).collect();
    let swing =
        0.5 * (z.iter().copied().fold(f64::MIN, f64::max) - z.iter().copied().fold(f64::MAX, f64::min));
    assert!((0.07..0.15).contains(&swing), "{swing}");
}
