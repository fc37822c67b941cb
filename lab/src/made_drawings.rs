//! Drawings made by us, so that their subjects are known: rows of plants, trees drawn in every way, small scenes.
//!
//! `cargo xtask read-drawings` reads them. Others, with another salt, are among those from which `cargo xtask
//! train-kinds` learns.

mod food;
pub(crate) mod hands;
mod herbs;
pub(crate) mod kinds;
mod pens;
mod things;
mod trees;

use std::f64::consts::TAU;

use base::{Draw, Seed, Stream, ops};
use glam::DVec2;
use reading::Kind;

/// Number of drawings of each set of rows.
const ROWS: u64 = 40;
/// Number of drawings of beds.
const BEDS: u64 = 12;
/// Name of the set of beds of flowers.
pub(crate) const BEDS_OF_FLOWERS: &str = "beds of flowers";
/// Number of trees of each way to draw one.
const TREES: u64 = 12;

/// One made drawing and its subjects.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    /// The set that it belongs to.
    pub(crate) set: &'static str,
    pub(crate) lines: Vec<Vec<DVec2>>,
    /// The plants in it, from left to right.
    pub(crate) plants: Vec<Kind>,
    /// Number of lines that belong to plants; later lines do not.
    pub(crate) own: usize,
}

type Lines = Vec<Vec<DVec2>>;

/// Makes one plant.
type Making = fn(&mut Stream) -> (Lines, Kind);

/// Makes all of them; the same in every call with the same `salt`: the part for choosing and the part for testing have
/// different ones.
pub(crate) fn shown(salt: u64) -> Vec<Shown> {
    let mut all = Vec::new();
    let stream = |set: u64, k: u64| Seed::new(1_000 * salt + set).child(k).stream(Draw::Template);
    for k in 0..ROWS {
        all.push(row("flowers in a row", &mut stream(1, k), Kind::Flower, flower));
        all.push(row("leafy stems side by side", &mut stream(2, k), Kind::Stem, leafy));
        all.push(row("lollipop trees side by side", &mut stream(3, k), Kind::Tree, lollipop));
        all.push(row("mixed plants in a row", &mut stream(4, k), Kind::None, |_| (Vec::new(), Kind::None)));
        all.push(scene(&mut stream(5, k)));
        all.push(with_surroundings(&mut stream(6, k)));
    }
    all.extend((0..BEDS).map(|k| bed(&mut stream(7, k))));
    for (number, (set, trunk, first)) in TREE_WAYS.into_iter().enumerate() {
        for k in 0..TREES {
            let r = &mut stream(10 + number as u64, k);
            let crown = CROWNS[usize::try_from(k).unwrap_or(0) % CROWNS.len()];
            all.push(Shown {
                set,
                lines: tree(r, trunk, crown, first),
                plants: vec![Kind::Tree],
                own: usize::MAX,
            });
        }
    }
    all
}

/// Drawing of a trunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trunk {
    TwoLines,
    Closed,
    Open,
    Line,
}

/// Drawing of a crown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Crown {
    Cloud,
    Circle,
    Scribble,
    Lobes,
}

const CROWNS: [Crown; 4] = [Crown::Cloud, Crown::Circle, Crown::Scribble, Crown::Lobes];
const TRUNKS: [Trunk; 4] = [Trunk::TwoLines, Trunk::Closed, Trunk::Open, Trunk::Line];

/// Name of the set, drawing of the trunk, whether it is drawn first.
const TREE_WAYS: [(&str, Trunk, bool); 8] = [
    ("tree: two lines, trunk first", Trunk::TwoLines, true),
    ("tree: two lines, crown first", Trunk::TwoLines, false),
    ("tree: closed trunk, trunk first", Trunk::Closed, true),
    ("tree: closed trunk, crown first", Trunk::Closed, false),
    ("tree: open trunk, trunk first", Trunk::Open, true),
    ("tree: open trunk, crown first", Trunk::Open, false),
    ("tree: one line, trunk first", Trunk::Line, true),
    ("tree: one line, crown first", Trunk::Line, false),
];

fn direction(angle: f64) -> DVec2 {
    let (s, c) = ops::sin_cos(angle);
    DVec2::new(c, s)
}

/// Returns a hand-drawn line through points.
fn hand(r: &mut Stream, corners: &[DVec2]) -> Vec<DVec2> {
    let whole: f64 = corners.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut points = Vec::new();
    for w in corners.windows(2) {
        let across = (w[1] - w[0]).perp();
        let bow = r.range(-0.05, 0.05);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 28")]
        let n = 4 + (24.0 * w[0].distance(w[1]) / whole) as u32;
        for k in 0..=n {
            let t = f64::from(k) / f64::from(n);
            let shake = DVec2::new(r.normal(), r.normal()) * (0.004 * whole);
            points.push(w[0].lerp(w[1], t) + across * (bow * 4.0 * t * (1.0 - t)) + shake);
        }
    }
    points
}

/// Returns a wobbly ring with half axes `size`; not quite closed.
fn ring(r: &mut Stream, centre: DVec2, size: DVec2, bumps: usize, depth: f64) -> Vec<DVec2> {
    let (from, phase) = (r.range(0.0, TAU), r.range(0.0, TAU));
    let way = if r.chance(0.5) { 1.0 } else { -1.0 };
    let gap = r.range(-0.05, 0.04);
    let n = 40 + 8 * bumps;
    let wobble = r.range(0.0, 0.05);
    (0..=n)
        .map(|k| {
            let a = from + way * (1.0 - gap) * TAU * k as f64 / n as f64;
            let lobe = if bumps > 0 { ops::sin(0.5 * bumps as f64 * a + phase).abs() } else { 1.0 };
            let radius = 1.0 - depth * (1.0 - lobe) + wobble * ops::sin(2.0 * a + phase);
            centre + direction(a) * size * radius + DVec2::new(r.normal(), r.normal()) * (0.006 * size.x)
        })
        .collect()
}

/// Returns a petal or leaf as a nearly closed outline from `root` along `way`.
fn blade(r: &mut Stream, root: DVec2, way: DVec2, half: f64) -> Vec<DVec2> {
    let (widest, gap, lean) = (r.range(0.8, 1.5), r.range(0.0, 0.03), r.range(-0.2, 0.2));
    let across = way.perp().normalize_or_zero();
    let shake = way.length() * 0.008;
    (0..=40)
        .map(|k| {
            let a = (f64::from(k) / 40.0 * (1.0 - gap)) * TAU;
            let t = (1.0 - ops::cos(a)) / 2.0;
            let bulge = half * ops::sin(a) * ops::powf(t.max(1e-9), widest - 1.0).min(2.0);
            root + way * t
                + across * (bulge + lean * way.length() * t * (1.0 - t))
                + DVec2::new(r.normal(), r.normal()) * shake
        })
        .collect()
}

/// Draws a flower on its stem, about 1 high, its foot at the origin.
fn flower(r: &mut Stream) -> (Lines, Kind) {
    let centre = DVec2::new(r.range(-0.08, 0.08), r.range(0.75, 1.0));
    let disc = r.range(0.05, 0.09);
    let size = r.range(0.13, 0.24);
    let petals = 5 + r.below(4);
    let mut head: Lines = Vec::new();
    match r.below(3) {
        // Separate petals.
        0 => {
            let first = r.range(0.0, TAU);
            for k in 0..petals {
                let way = direction(first + TAU * k as f64 / petals as f64);
                let half = size * r.range(0.28, 0.42);
                head.push(blade(r, centre + way * disc, way * size, half));
            }
        }
        // All petals in one stroke round the disc.
        1 => head.push(ring(r, centre, DVec2::splat(size + disc), petals, 0.42)),
        // Round petals that touch the disc.
        _ => {
            let first = r.range(0.0, TAU);
            for k in 0..petals {
                let way = direction(first + TAU * k as f64 / petals as f64);
                let half = (disc + size) * ops::sin(0.5 * TAU / petals as f64) * r.range(0.75, 0.95);
                head.push(ring(r, centre + way * (disc + half), DVec2::splat(half), 0, 0.0));
            }
        }
    }
    let round = ring(r, centre, DVec2::splat(disc), 0, 0.0);
    if r.chance(0.5) {
        head.insert(0, round)
    } else {
        head.push(round)
    }
    let top = centre - DVec2::Y * (disc + size * r.range(0.6, 1.0));
    let stem = hand(r, &[DVec2::ZERO, top]);
    let mut lines = if r.chance(0.5) { vec![stem] } else { Vec::new() };
    let stem_last = lines.is_empty();
    lines.extend(head);
    if stem_last {
        lines.push(hand(r, &[top, DVec2::ZERO]));
    }
    for k in 0..r.below(3) {
        let at = top * r.range(0.25, 0.7);
        let side = if k % 2 == 0 { r.range(0.3, 0.9) } else { TAU / 2.0 - r.range(0.3, 0.9) };
        let way = direction(side) * r.range(0.18, 0.3);
        lines.push(blade(r, at, way, way.length() * 0.2));
    }
    (lines, Kind::Flower)
}

/// Draws a stem with leaves on both sides.
fn leafy(r: &mut Stream) -> (Lines, Kind) {
    let top = DVec2::new(r.range(-0.12, 0.12), r.range(0.8, 1.0));
    let stem = hand(r, &[DVec2::ZERO, top]);
    let leaves = 4 + r.below(6);
    let mut lines = vec![stem];
    for k in 0..leaves {
        let at = top * (0.2 + 0.75 * k as f64 / leaves as f64);
        let side = if k % 2 == 0 { r.range(0.3, 0.9) } else { TAU / 2.0 - r.range(0.3, 0.9) };
        let way = direction(side) * r.range(0.16, 0.3);
        let half = way.length() * r.range(0.16, 0.28);
        lines.push(blade(r, at, way, half));
    }
    (lines, Kind::Stem)
}

fn lollipop(r: &mut Stream) -> (Lines, Kind) {
    let trunk = TRUNKS[r.below(TRUNKS.len())];
    let crown = [Crown::Cloud, Crown::Circle][r.below(2)];
    let first = r.chance(0.5);
    (tree(r, trunk, crown, first), Kind::Tree)
}

fn bush(r: &mut Stream) -> (Lines, Kind) {
    let size = DVec2::new(r.range(0.25, 0.4), r.range(0.18, 0.26));
    let n = 60;
    let bumps = f64::from(5 + u32::try_from(r.below(4)).unwrap_or(0));
    let phase = r.range(0.0, TAU);
    let cloud: Vec<DVec2> = (0..=n)
        .map(|k| {
            let a = TAU / 2.0 * k as f64 / n as f64;
            let lobe = 0.8 + 0.2 * ops::sin(bumps * a + phase).abs();
            direction(a) * size * 2.0_f64.sqrt() * lobe
        })
        .collect();
    let mut lines = vec![cloud];
    let ends = (lines[0][0], lines[0][lines[0].len() - 1]);
    if r.chance(0.6) {
        lines.push(hand(r, &[ends.1, ends.0]));
    } else {
        let back = hand(r, &[ends.1, ends.0]);
        lines[0].extend(back);
    }
    (lines, Kind::Bush)
}

fn grass(r: &mut Stream) -> (Lines, Kind) {
    let blades = 5 + r.below(5);
    let lines = (0..blades)
        .map(|k| {
            let x = 0.05 * k as f64;
            let tip = DVec2::new(x + r.range(-0.08, 0.08), r.range(0.12, 0.26));
            let foot = DVec2::new(x, r.range(-0.01, 0.01));
            hand(r, &[foot, tip])
        })
        .collect();
    (lines, Kind::Grass)
}

/// Draws one trunk and one crown, 1 high, the foot at the origin.
fn tree(r: &mut Stream, trunk: Trunk, crown: Crown, trunk_first: bool) -> Lines {
    let half = r.range(0.035, 0.075);
    let centre = DVec2::new(r.range(-0.04, 0.04), r.range(0.62, 0.72));
    let size = DVec2::new(r.range(0.24, 0.36), r.range(0.22, 0.3));
    let low = centre.y - size.y;
    // Tops lie below, at or a little inside the crown.
    let top = low + r.range(-0.015, 0.06);
    let flare = r.range(1.0, 1.5);
    let (a, b) = (DVec2::new(-half * flare, 0.0), DVec2::new(-half, top));
    let (c, d) =
        (DVec2::new(half, top + r.range(-0.02, 0.02)), DVec2::new(half * flare, r.range(-0.01, 0.01)));
    let wood: Lines = match trunk {
        Trunk::TwoLines if r.chance(0.5) => vec![hand(r, &[a, b]), hand(r, &[c, d])],
        Trunk::TwoLines => vec![hand(r, &[b, a]), hand(r, &[c, d])],
        Trunk::Closed => vec![hand(r, &[a, b, c, d, a])],
        Trunk::Open => vec![hand(r, &[b, a, d, c])],
        Trunk::Line => {
            let tip = DVec2::new(r.range(-0.02, 0.02), top);
            vec![hand(r, &[DVec2::ZERO, tip])]
        }
    };
    let green: Lines = match crown {
        Crown::Cloud => {
            let bumps = 7 + r.below(6);
            vec![ring(r, centre, size, bumps, 0.16)]
        }
        Crown::Circle => vec![ring(r, centre, size, 0, 0.0)],
        Crown::Scribble => vec![scribble(r, centre, size)],
        Crown::Lobes => {
            let n = 3 + r.below(3);
            let from = r.range(0.0, TAU);
            (0..n)
                .map(|k| {
                    let way = direction(from + TAU * k as f64 / n as f64 + r.range(-0.45, 0.45));
                    let out = r.range(0.3, 0.55);
                    let own = size * r.range(0.45, 0.7);
                    ring(r, centre + way * size * out, own, 0, 0.0)
                })
                .collect()
        }
    };
    if trunk_first { [wood, green].concat() } else { [green, wood].concat() }
}

/// Returns a line that runs to and fro all over an ellipse.
fn scribble(r: &mut Stream, centre: DVec2, size: DVec2) -> Vec<DVec2> {
    let n = 9 + r.below(8);
    let mut corners = vec![centre + direction(r.range(0.0, TAU)) * size];
    for k in 0..n {
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let y = 1.0 - 2.0 * (k as f64 + 0.5) / n as f64 + r.range(-0.15, 0.15);
        let x = side * (1.0 - y * y).max(0.0).sqrt() * r.range(0.7, 1.05);
        corners.push(centre + DVec2::new(x, y) * size);
    }
    // Back up again, and once more across.
    for _ in 0..3 + r.below(4) {
        corners.push(centre + direction(r.range(0.0, TAU)) * size * r.range(0.6, 1.0));
    }
    let mut points = Vec::new();
    for w in corners.windows(3) {
        let (a, b) = (w[0].midpoint(w[1]), w[1].midpoint(w[2]));
        points.extend((0..12).map(|i| f64::from(i) / 12.0).map(|t| a.lerp(w[1], t).lerp(w[1].lerp(b, t), t)));
    }
    points
}

pub(crate) use hands::varied;

fn moved(lines: Lines, scale: f64, to: DVec2) -> Lines {
    lines.into_iter().map(|l| l.into_iter().map(|p| p * scale + to).collect()).collect()
}

fn extent(lines: &Lines) -> (DVec2, DVec2) {
    lines.iter().flatten().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)))
}

/// Puts drawings next to one another on one ground: larger and smaller ones, a little apart.
pub(crate) fn side_by_side(r: &mut Stream, drawings: Vec<Lines>) -> Lines {
    let mut groups: Vec<Lines> = Vec::new();
    let mut x = 0.0;
    for lines in drawings {
        let scale = r.range(0.7, 1.15);
        let lines = moved(lines, scale, DVec2::ZERO);
        let (lo, hi) = extent(&lines);
        let to = DVec2::new(x - lo.x, -lo.y + r.range(-0.03, 0.03));
        x += (hi.x - lo.x) + r.range(0.08, 0.35) * (hi.x - lo.x).max(0.4);
        groups.push(moved(lines, 1.0, to));
    }
    let mut all: Lines = match r.below(4) {
        // All first strokes, then all second ones.
        0 => {
            let most = groups.iter().map(Vec::len).max().unwrap_or(0);
            (0..most).flat_map(|k| groups.iter().filter_map(move |g| g.get(k).cloned())).collect()
        }
        1 => groups.into_iter().rev().flatten().collect(),
        _ => groups.into_iter().flatten().collect(),
    };
    if r.chance(0.35) {
        let (lo, hi) = extent(&all);
        let end = DVec2::new(hi.x + 0.1, r.range(-0.02, 0.02));
        let ground = hand(r, &[DVec2::new(lo.x - 0.1, 0.0), end]);
        if r.chance(0.5) { all.insert(0, ground) } else { all.push(ground) }
    }
    all
}

/// Draws two to six plants of a kind; of any kind where that is `None`.
fn row(set: &'static str, r: &mut Stream, kind: Kind, make: Making) -> Shown {
    let n = 2 + r.below(5);
    let any: [Making; 4] = [flower, leafy, lollipop, bush];
    let made: Vec<(Lines, Kind)> =
        (0..n).map(|_| if kind == Kind::None { any[r.below(4)](r) } else { make(r) }).collect();
    let (drawings, plants) = made.into_iter().unzip();
    Shown { set, lines: side_by_side(r, drawings), plants, own: usize::MAX }
}

/// Draws eight to thirty flowers and tulips in one to three rows above one another, which may overlap.
fn bed(r: &mut Stream) -> Shown {
    let (rows, apart, high) = (1 + r.below(3), r.range(0.6, 0.9), r.range(0.55, 1.4));
    let each = (8 / rows + r.below(23)).min(30 / rows);
    let mut drawings: Vec<Lines> = Vec::new();
    for row in (0..rows).rev() {
        for k in 0..each {
            let one = if r.chance(0.7) { flower(r).0 } else { herbs::tulip(r) };
            let x = apart * (k as f64 + 0.5 * (row % 2) as f64) + r.range(-0.06, 0.06);
            let to = DVec2::new(x, high * row as f64 + r.range(-0.04, 0.04));
            drawings.push(moved(one, r.range(0.8, 1.0), to));
        }
    }
    let plants = vec![Kind::Flower; drawings.len()];
    let mut lines: Lines = drawings.into_iter().flatten().collect();
    if r.chance(0.5) {
        let (lo, hi) = extent(&lines);
        lines.push(hand(r, &[DVec2::new(lo.x - 0.1, 0.0), DVec2::new(hi.x + 0.1, 0.0)]));
    }
    Shown { set: BEDS_OF_FLOWERS, lines, plants, own: usize::MAX }
}

/// Draws a tree among bushes and grass.
fn scene(r: &mut Stream) -> Shown {
    let (mut drawings, mut plants) = (Vec::new(), Vec::new());
    let tall = r.below(3);
    for k in 0..3 {
        // Two adjacent tufts are one.
        let tuft = plants.last() == Some(&Kind::Grass);
        let (lines, kind) = match (k == tall, tuft || r.chance(0.5)) {
            (true, _) => {
                let (lines, kind) = lollipop(r);
                (moved(lines, 1.4, DVec2::ZERO), kind)
            }
            (false, true) => bush(r),
            (false, false) => grass(r),
        };
        drawings.push(lines);
        plants.push(kind);
    }
    Shown { set: "a tree among bushes and grass", lines: side_by_side(r, drawings), plants, own: usize::MAX }
}

/// Draws a plant with the sun, a cloud, birds, a butterfly or a word next to it.
fn with_surroundings(r: &mut Stream) -> Shown {
    let any: [Making; 4] = [flower, leafy, lollipop, bush];
    let (mut lines, kind) = any[r.below(4)](r);
    let own = lines.len();
    let (lo, hi) = extent(&lines);
    let tall = (hi.y - lo.y).max(0.6 * (hi.x - lo.x));
    let side = if r.chance(0.5) { 1.0 } else { -1.0 };
    for k in 0..1 + r.below(3) {
        let side = if k == 1 { -side } else { side };
        let (thing, size, high) = match r.below(5) {
            0 => (things::sun(r), r.range(0.15, 0.3), r.range(0.75, 1.1)),
            1 => (
                vec![ring(r, DVec2::ZERO, DVec2::new(0.5, 0.22), 7, 0.2)],
                r.range(0.2, 0.35),
                r.range(0.8, 1.1),
            ),
            2 => (things::birds(r), r.range(0.1, 0.25), r.range(0.7, 1.1)),
            3 => (things::butterfly(r), r.range(0.1, 0.22), r.range(0.5, 0.9)),
            _ => (things::written(r), r.range(0.25, 0.45), r.range(-0.2, -0.1)),
        };
        let (a, b) = extent(&thing);
        let scale = size * tall / (b - a).max_element().max(1e-9);
        let half = 0.5 * (b - a) * scale;
        let word = high < 0.0;
        let out = 0.5 * (hi.x - lo.x) + half.x + r.range(0.12, 0.4) * tall;
        let x = if word { r.range(-0.3, 0.3) * tall } else { side * out };
        let to = DVec2::new(0.5 * (lo.x + hi.x) + x, lo.y + (high + 0.12 * k as f64) * tall);
        let to = if word { to - DVec2::new(0.0, half.y) } else { to };
        lines.extend(moved(thing, scale, to - 0.5 * (a + b) * scale));
    }
    Shown { set: "a plant and what is beside it", lines, plants: vec![kind], own }
}
