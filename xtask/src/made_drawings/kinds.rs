//! Made drawings of every kind of plant, and of what is no plant: for the model of kinds, where people's drawings of the
//! part to learn from are few.
//!
//! They say how something is built, not how it was drawn in any one drawing.

use std::f64::consts::{PI, TAU};

use base::{Draw, Seed, Stream, ops};
use glam::DVec2;
use reading::Kind;

use super::{Lines, blade, direction, extent, flower, grass, hand, leafy, moved, ring, scribble, ways};

/// Makes the lines of one drawing.
type Making = fn(&mut Stream) -> Lines;

/// What is made: a word for it, its kind, how it is made.
const MAKERS: [(&str, Kind, Making); 68] = [
    ("tree, crown open below", Kind::Tree, open_tree),
    ("tree, crown open below again", Kind::Tree, open_tree),
    ("tree in one line", Kind::Tree, one_line_tree),
    ("tree with branches", Kind::Tree, branched_tree),
    ("bare tree", Kind::Tree, bare_tree),
    ("bare tree with leaves", Kind::Tree, twiggy_tree),
    ("bare tree in one line", Kind::Tree, outlined_tree),
    ("tree of loops", Kind::Tree, looped_tree),
    ("narrow tree", Kind::Tree, narrow_tree),
    ("tree of lobes", Kind::Tree, lobed_tree),
    ("fir, zigzag", Kind::Tree, zigzag_fir),
    ("fir, triangles", Kind::Tree, stacked_fir),
    ("fir, twigs", Kind::Tree, twig_fir),
    ("palm", Kind::Palm, palm),
    ("palm again", Kind::Palm, palm),
    ("bush, cloud", Kind::Bush, cloud_bush),
    ("bush, humps", Kind::Bush, humps),
    ("grass, lines", Kind::Grass, |r| grass(r).0),
    ("grass, zigzag", Kind::Grass, zigzag_grass),
    ("grass, fan", Kind::Grass, fan),
    ("leaf", Kind::Leaf, leaf),
    ("leaf again", Kind::Leaf, leaf),
    ("leaf with lobes", Kind::Leaf, lobed_leaf),
    ("flower", Kind::Flower, |r| flower(r).0),
    ("flower head", Kind::Flower, flower_head),
    ("flowers on a branching stem", Kind::Flower, spray),
    ("flowers on a branching stem again", Kind::Flower, spray),
    ("tulip", Kind::Flower, tulip),
    ("plant in a pot", Kind::HousePlant, potted),
    ("plant in a pot again", Kind::HousePlant, potted),
    ("leafy stem", Kind::Stem, |r| leafy(r).0),
    ("sprout", Kind::Stem, sprout),
    ("carrot", Kind::Vegetable, carrot),
    ("mushroom", Kind::Vegetable, mushroom),
    ("pod", Kind::Vegetable, pod),
    ("onion", Kind::Vegetable, onion),
    ("potato", Kind::Vegetable, potato),
    ("grapes", Kind::Fruit, grapes),
    ("berry", Kind::Fruit, berry),
    ("crescent", Kind::Fruit, crescent),
    ("slice", Kind::Fruit, slice),
    ("strawberry", Kind::Fruit, strawberry),
    ("pineapple", Kind::Fruit, pineapple),
    ("pear", Kind::Fruit, pear),
    ("spears", Kind::Vegetable, ways::spears),
    ("bean", Kind::Vegetable, ways::bean),
    ("open pod", Kind::Vegetable, ways::open_pod),
    ("round root", Kind::Vegetable, ways::round_root),
    ("ribbed body", Kind::Vegetable, ways::ribbed),
    ("bare body", Kind::Vegetable, ways::bare_body),
    ("pointed root", Kind::Vegetable, ways::pointed_root),
    ("mushroom again", Kind::Vegetable, ways::other_mushroom),
    ("round berries", Kind::Fruit, ways::round_berries),
    ("hanging berries", Kind::Fruit, ways::hanging),
    ("bumpy berry", Kind::Fruit, ways::bumpy_berry),
    ("palm in few strokes", Kind::Palm, ways::palm_in_few),
    ("tree of few lines", Kind::Tree, ways::sparse_tree),
    ("willow", Kind::Tree, ways::willow),
    ("tree with a loose crown", Kind::Tree, ways::loose_tree),
    ("pointed tree", Kind::Tree, ways::pointed_tree),
    ("cactus with arms", Kind::Cactus, ways::saguaro),
    ("round cactus", Kind::Cactus, ways::round_cactus),
    ("flower of arcs and lines", Kind::Flower, ways::other_flower),
    ("vase", Kind::HousePlant, ways::vase),
    ("tufts", Kind::Grass, ways::tufts),
    ("leaf of another form", Kind::Leaf, ways::other_leaf),
    ("bush of arcs and scribbles", Kind::Bush, ways::other_bush),
    ("frond", Kind::Stem, ways::other_stem),
];

/// Things that are no plants: a word, how it is made.
const OTHERS: [(&str, Making); 21] = [
    ("house", house),
    ("cat", cat),
    ("face", face),
    ("person", person),
    ("car", car),
    ("fish", fish),
    ("sun", sun),
    ("letters", letters),
    ("star", star),
    ("spiral", spiral),
    ("boat", boat),
    ("cup", cup),
    ("table", table),
    ("arrow", arrow),
    ("box", cube),
    ("hills", hills),
    ("butterfly", ways::butterfly),
    ("birds", ways::birds),
    ("sun in a corner", ways::corner_sun),
    ("word", ways::written),
    ("fence", ways::fence),
];

/// Drawings of each maker, with their words and kinds; [`Kind::None`] is no plant.
pub(crate) fn of_kinds(salt: u64, each: u64) -> Vec<(&'static str, Kind, Lines)> {
    let others = OTHERS.iter().map(|&(word, make)| (word, Kind::None, make));
    let makers = MAKERS.iter().copied().chain(others);
    let mut found = Vec::new();
    for (set, (word, kind, make)) in (0_u64..).zip(makers) {
        for k in 0..each {
            let r = &mut Seed::new(50_000 + 1_000 * salt + set).child(k).stream(Draw::Template);
            found.push((word, kind, make(r)));
        }
    }
    found
}

pub(super) fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// A line of a hand through points.
pub(super) fn pen(corners: &[DVec2], r: &mut Stream) -> Vec<DVec2> {
    hand(r, corners)
}

/// A wobbly ring.
pub(super) fn round(centre: DVec2, size: DVec2, bumps: usize, depth: f64, r: &mut Stream) -> Vec<DVec2> {
    ring(r, centre, size, bumps, depth)
}

/// A petal or leaf as an outline.
fn leafy_blade(root: DVec2, way: DVec2, half: f64, r: &mut Stream) -> Vec<DVec2> {
    blade(r, root, way, half)
}

fn scribbled(centre: DVec2, size: DVec2, r: &mut Stream) -> Vec<DVec2> {
    scribble(r, centre, size)
}

/// A soft line of a hand: corners are rounded.
pub(super) fn soft(corners: &[DVec2], r: &mut Stream) -> Vec<DVec2> {
    let (first, last) = (corners[0], corners[corners.len() - 1]);
    let mut points = vec![first];
    for w in corners.windows(3) {
        let (a, b) = (w[0].midpoint(w[1]), w[1].midpoint(w[2]));
        points.extend((0..8).map(|i| f64::from(i) / 8.0).map(|t| a.lerp(w[1], t).lerp(w[1].lerp(b, t), t)));
    }
    points.push(last);
    let shake = extent(&vec![points.clone()]);
    let shake = 0.004 * shake.0.distance(shake.1);
    points.iter().map(|p| *p + v(r.normal(), r.normal()) * shake).collect()
}

/// Part of a lobed ring, from one angle to another.
pub(super) fn arc(
    centre: DVec2,
    size: DVec2,
    from: f64,
    to: f64,
    bumps: usize,
    depth: f64,
    r: &mut Stream,
) -> Vec<DVec2> {
    let n = 30 + 8 * bumps;
    let (phase, slow) = (r.range(0.0, PI), r.range(0.0, 0.12));
    (0..=n)
        .map(|k| {
            let t = k as f64 / n as f64;
            let a = from + (to - from) * t;
            let lobe = if bumps > 0 { ops::sin(PI * bumps as f64 * t + phase).abs() } else { 1.0 };
            let radius = 1.0 - depth * (1.0 - lobe) + slow * ops::sin(3.0 * a + phase);
            centre + direction(a) * size * radius + v(r.normal(), r.normal()) * (0.005 * size.x)
        })
        .collect()
}

/// Left and right side of a trunk, from the neck down, flaring.
pub(super) fn sides(r: &mut Stream, half: f64, top: f64) -> [Vec<DVec2>; 2] {
    let flare = r.range(1.0, 2.6);
    let lean = r.range(-0.05, 0.05);
    let mut side = |s: f64| {
        let waist = v(s * half + lean, top * r.range(0.35, 0.6));
        soft(
            &[
                v(s * half, top),
                waist,
                v(s * half * flare * 0.8 + lean, top * 0.12),
                v(s * half * flare + lean, 0.0),
            ],
            r,
        )
    };
    [side(-1.0), side(1.0)]
}

/// Roots, ground, bark, a hole: what people add below.
fn extras(r: &mut Stream, lines: &mut Lines, half: f64, top: f64) {
    if r.chance(0.2) {
        lines.push(pen(&[v(-0.4, 0.0), v(0.4, r.range(-0.03, 0.03))], r));
    }
    if r.chance(0.12) {
        for _ in 0..3 + r.below(8) {
            let at = v(r.range(-0.7, 0.7) * half, r.range(0.1, 0.9) * top);
            lines.push(pen(&[at, at - v(r.range(-0.01, 0.01), r.range(0.04, 0.1))], r));
        }
    }
    if r.chance(0.1) {
        let at = v(0.0, 0.6 * top);
        lines.push(round(at, v(0.4 * half, 0.6 * half), 0, 0.0, r));
    }
}

fn open_tree(r: &mut Stream) -> Lines {
    let half = r.range(0.05, 0.16);
    let top = r.range(0.3, 0.6);
    let size = v(r.range(0.25, 0.5), 0.5 * (1.0 - top) * r.range(0.95, 1.15));
    let centre = v(r.range(-0.04, 0.04), top + 0.85 * size.y);
    // The crown begins and ends at the tops of the trunk.
    let open = ops::atan2(half, size.y) * r.range(0.6, 1.3);
    let bumps = if r.chance(0.25) { 0 } else { 5 + r.below(10) };
    let depth = r.range(0.1, 0.25);
    let crown = arc(centre, size, -0.5 * PI + open, 1.5 * PI - open, bumps, depth, r);
    let [left, mut right] = sides(r, half, top);
    let mut lines = match r.below(4) {
        0 => vec![left, right, crown],
        1 => vec![crown, left, right],
        // Crown and one side in one go.
        2 => {
            let mut both = crown;
            both.extend(left);
            vec![both, right]
        }
        _ => {
            let mut wood = left;
            right.reverse();
            wood.extend(right);
            vec![wood, crown]
        }
    };
    inside(r, &mut lines, centre, size);
    extras(r, &mut lines, half, top);
    lines
}

/// What people put into a crown.
fn inside(r: &mut Stream, lines: &mut Lines, centre: DVec2, size: DVec2) {
    let n = 2 + r.below(7);
    let what = r.below(10);
    for _ in 0..n {
        let at = centre + direction(r.range(0.0, TAU)) * size * r.range(0.0, 0.7);
        match what {
            0 | 1 => lines.push(arc(at, size * r.range(0.1, 0.3), 0.0, PI * r.range(0.6, 1.2), 0, 0.0, r)),
            2 => lines.push(round(at, DVec2::splat(r.range(0.02, 0.04)), 0, 0.0, r)),
            3 => lines.push(arc(at, size * 0.25, r.range(0.0, TAU), r.range(7.0, 11.0), 3, 0.3, r)),
            _ => return,
        }
    }
}

fn one_line_tree(r: &mut Stream) -> Lines {
    let half = r.range(0.05, 0.14);
    let top = r.range(0.3, 0.55);
    let size = v(r.range(0.25, 0.45), 0.5 * (1.0 - top) * 1.05);
    let centre = v(0.0, top + 0.9 * size.y);
    let open = ops::atan2(half, size.y);
    let bumps = if r.chance(0.15) { 0 } else { 5 + r.below(8) };
    let depth = r.range(0.1, 0.25);
    let mut crown = arc(centre, size, -0.5 * PI + open, 1.5 * PI - open, bumps, depth, r);
    let [left, mut right] = sides(r, half, top);
    right.reverse();
    let mut line = right;
    line.append(&mut crown);
    line.extend(left);
    if r.chance(0.5) {
        let foot = line[0];
        let end = line[line.len() - 1];
        line.extend(pen(&[end, foot], r));
    }
    vec![line]
}

/// Branches from a place, and theirs.
pub(super) fn branches(
    r: &mut Stream,
    from: DVec2,
    angle: f64,
    length: f64,
    depth: usize,
    lines: &mut Lines,
) {
    let tip = from + direction(angle) * length;
    let bend = from.lerp(tip, 0.5) + direction(angle + 0.5 * PI) * (r.range(-0.15, 0.15) * length);
    lines.push(soft(&[from, bend, tip], r));
    if depth == 0 {
        return;
    }
    for k in 0..1 + r.below(3) {
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let at = from.lerp(tip, r.range(0.4, 0.95));
        let (angle, length) = (angle + side * r.range(0.3, 0.9), length * r.range(0.4, 0.7));
        branches(r, at, angle, length, depth - 1, lines);
    }
}

fn bare_tree(r: &mut Stream) -> Lines {
    let (half, top) = (r.range(0.03, 0.09), r.range(0.35, 0.6));
    let mut lines: Lines =
        if r.chance(0.6) { sides(r, half, top).into() } else { vec![pen(&[v(0.0, 0.0), v(0.0, top)], r)] };
    let n = 2 + r.below(4);
    let depth = 1 + r.below(2);
    for k in 0..n {
        let angle = 0.5 * PI + (k as f64 / (n - 1) as f64 - 0.5) * r.range(1.2, 2.4);
        let from = v(r.range(-1.0, 1.0) * half, top * r.range(0.8, 1.0));
        let length = (1.0 - top) * r.range(0.6, 0.9);
        branches(r, from, angle, length, depth, &mut lines);
    }
    extras(r, &mut lines, half, top);
    lines
}

fn twiggy_tree(r: &mut Stream) -> Lines {
    let mut lines = bare_tree(r);
    let (lo, hi) = extent(&lines);
    let tips: Vec<DVec2> =
        lines.iter().map(|l| l[l.len() - 1]).filter(|p| p.y > 0.5 * (lo.y + hi.y)).collect();
    let what = r.below(3);
    for tip in tips {
        for _ in 0..1 + r.below(2) {
            let way = direction(r.range(0.0, TAU)) * r.range(0.04, 0.09);
            lines.push(match what {
                0 => leafy_blade(tip, way, 0.3 * way.length(), r),
                1 => pen(&[tip, tip + way], r),
                _ => round(tip + way, DVec2::splat(0.6 * way.length()), 0, 0.0, r),
            });
        }
    }
    lines
}

/// A crown much higher than wide.
fn narrow_tree(r: &mut Stream) -> Lines {
    let (half, top) = (r.range(0.015, 0.05), r.range(0.12, 0.3));
    let mut lines: Lines =
        if r.chance(0.7) { sides(r, half, top).into() } else { vec![pen(&[v(0.0, 0.0), v(0.0, top)], r)] };
    let tall = 1.0 - top;
    let crown = if lines.len() > 1 && r.chance(0.5) {
        let wide = r.range(0.1, 0.2);
        leafy_blade(v(0.0, top), v(0.0, tall), wide, r)
    } else {
        let size = v(r.range(0.1, 0.2), 0.5 * tall);
        let bumps = 6 * r.below(3);
        round(v(0.0, top + 0.5 * tall), size, bumps, 0.1, r)
    };
    lines.push(crown);
    lines
}

/// Several heads with many petals each, on stems that part.
fn spray(r: &mut Stream) -> Lines {
    let fork = v(r.range(-0.05, 0.05), r.range(0.3, 0.6));
    let mut lines = vec![soft(&[v(0.0, 0.0), fork * 0.5 + v(0.03, 0.0), fork], r)];
    let heads = 1 + r.below(5);
    let whole = r.range(0.12, 0.22) / (heads as f64).sqrt() * 1.4;
    let (petals, two, discs) = (5 + r.below(9), r.chance(0.3), r.chance(0.7));
    for k in 0..heads {
        let a = 0.5 * PI + ((k as f64 + 0.5) / heads as f64 - 0.5) * r.range(1.6, 2.4);
        let centre = fork + direction(a) * r.range(0.3, 0.5);
        lines.push(soft(&[fork, fork.lerp(centre, 0.5) + v(0.0, 0.03), centre - v(0.0, 0.5 * whole)], r));
        let disc = whole * r.range(0.15, 0.35);
        let squash = v(1.0, r.range(0.5, 1.0));
        for whorl in 0..if two { 2 } else { 1 } {
            let first = r.range(0.0, TAU);
            let reach = whole * if whorl == 0 { 1.0 } else { 0.65 };
            for i in 0..petals {
                let way = direction(first + TAU * i as f64 / petals as f64) * squash;
                let half = reach * ops::sin(PI / petals as f64) * r.range(0.4, 0.9);
                lines.push(leafy_blade(centre + way * disc, way * (reach - disc), half, r));
            }
        }
        if discs {
            lines.push(round(centre, squash * disc, 0, 0.0, r));
        }
    }
    for k in 0..r.below(5) {
        let s = if k % 2 == 0 { 1.0 } else { -1.0 };
        let way = v(s * r.range(0.15, 0.3), r.range(0.05, 0.25));
        lines.push(leafy_blade(fork * r.range(0.1, 0.9), way, 0.2 * way.length(), r));
    }
    lines
}

/// The outline of a trunk that parts into branches, or into roots as well.
fn outlined_tree(r: &mut Stream) -> Lines {
    let (half, top) = (r.range(0.06, 0.14), r.range(0.35, 0.55));
    let mut corners = vec![v(-half * r.range(1.2, 2.2), 0.0), v(-half, 0.4 * top), v(-half, top)];
    let n = 2 + r.below(4);
    for k in 0..n {
        let a = PI * (0.85 - 0.7 * (k as f64 + 0.5) / n as f64);
        let fork = v(half * (2.0 * (k as f64 + 1.0) / n as f64 - 1.0), top + r.range(0.0, 0.1));
        let tip = v(0.0, top) + direction(a) * r.range(0.3, 0.5);
        let side = direction(a + 0.5 * PI) * r.range(0.01, 0.05);
        corners.extend([tip + side, tip - side, fork]);
    }
    corners.extend([v(half, 0.4 * top), v(half * r.range(1.2, 2.2), 0.0)]);
    if r.chance(0.5) {
        let roots = 2 + r.below(4);
        for k in (0..roots).rev() {
            let x = half * 2.0 * (2.0 * (k as f64 + 0.5) / roots as f64 - 1.0);
            corners.extend([v(x, -r.range(0.03, 0.12)), v(x - half / roots as f64, 0.02)]);
        }
    }
    if r.chance(0.6) {
        corners.push(corners[0]);
    }
    vec![if r.chance(0.5) { soft(&corners, r) } else { pen(&corners, r) }]
}

/// A trunk under loops that run on and on.
fn looped_tree(r: &mut Stream) -> Lines {
    let (half, top) = (r.range(0.04, 0.12), r.range(0.3, 0.5));
    let mut lines: Lines = sides(r, half, top).into();
    let centre = v(0.0, top + 0.3);
    let (size, small) = (v(r.range(0.22, 0.36), r.range(0.2, 0.28)), r.range(0.05, 0.12));
    let (n, turns) = (140, r.range(9.0, 20.0));
    let rounds = r.range(0.95, 2.2);
    let line = (0..=n).map(|k| f64::from(k) / f64::from(n)).map(|t| {
        let way = direction(TAU * rounds * t - 0.5 * PI) * size;
        centre + way + direction(TAU * turns * t) * small
    });
    lines.push(line.collect());
    if r.chance(0.3) {
        lines.truncate(1);
        let loops = scribbled(centre, size, r);
        lines.push(loops);
    }
    lines
}

fn branched_tree(r: &mut Stream) -> Lines {
    let mut lines = bare_tree(r);
    let centre = v(0.0, r.range(0.66, 0.74));
    let size = v(r.range(0.32, 0.46), r.range(0.28, 0.36));
    let bumps = if r.chance(0.3) { 0 } else { 6 + r.below(8) };
    let crown = round(centre, size, bumps, 0.15, r);
    if r.chance(0.5) {
        lines.push(crown)
    } else {
        lines.insert(0, crown)
    }
    lines
}

fn lobed_tree(r: &mut Stream) -> Lines {
    let (half, top) = (r.range(0.04, 0.1), r.range(0.35, 0.5));
    let mut lines: Lines = sides(r, half, top).into();
    let n = 3 + r.below(4);
    for k in 0..n {
        let a = PI * (k as f64 + 0.5) / n as f64;
        let at = v(0.0, top + 0.15) + direction(a) * v(0.3, 0.25);
        let size = DVec2::splat(r.range(0.1, 0.2));
        let from = a - r.range(1.6, 2.6);
        lines.push(arc(at, size, from, from + r.range(3.2, 5.6), 2 + r.below(3), 0.15, r));
    }
    extras(r, &mut lines, half, top);
    lines
}

/// The side of a fir from its top down, to the right.
fn fir_side(r: &mut Stream, s: f64, top: f64, foot: f64, half: f64) -> Vec<DVec2> {
    let n = 3 + r.below(4);
    let mut corners = vec![v(0.0, top)];
    let back = r.range(0.35, 0.75);
    for k in 1..=n {
        let t = k as f64 / n as f64;
        let y = top + (foot - top) * t;
        corners.push(v(s * half * t * r.range(0.9, 1.1), y + r.range(-0.02, 0.02)));
        if k < n {
            corners.push(v(s * half * t * back, y + r.range(-0.01, 0.03)));
        }
    }
    corners.push(v(s * 0.05, foot));
    if r.chance(0.3) { soft(&corners, r) } else { pen(&corners, r) }
}

fn fir_trunk(r: &mut Stream, foot: f64) -> Lines {
    let half = r.range(0.02, 0.07);
    match r.below(4) {
        0 => vec![pen(&[v(-half, foot), v(-half, 0.0)], r), pen(&[v(half, foot), v(half, 0.0)], r)],
        1 => vec![pen(&[v(-half, foot), v(-half, 0.0), v(half, 0.0), v(half, foot)], r)],
        2 => vec![pen(&[v(0.0, foot), v(0.0, 0.0)], r)],
        _ => vec![pen(&[v(0.0, 0.95), v(0.0, 0.0)], r)],
    }
}

fn zigzag_fir(r: &mut Stream) -> Lines {
    let (foot, half) = (r.range(0.08, 0.3), r.range(0.2, 0.42));
    let mut left = fir_side(r, -1.0, 1.0, foot, half);
    let right = fir_side(r, 1.0, 1.0, foot, half);
    let mut lines = if r.chance(0.5) {
        left.reverse();
        left.extend(right);
        vec![left]
    } else {
        vec![left, right]
    };
    let wood = fir_trunk(r, foot);
    if r.chance(0.5) {
        lines.extend(wood)
    } else {
        lines = [wood, lines].concat()
    }
    lines
}

fn stacked_fir(r: &mut Stream) -> Lines {
    let foot = r.range(0.08, 0.25);
    let n = 1 + r.below(4);
    let tall = (1.0 - foot) / (0.4 + 0.6 * n as f64);
    let mut lines = fir_trunk(r, foot);
    for k in 0..n {
        let low = foot + 0.6 * tall * k as f64;
        let half = r.range(0.24, 0.36) * (1.0 - 0.2 * k as f64);
        lines.push(pen(&[v(-half, low), v(0.0, low + tall), v(half, low), v(-half, low)], r));
    }
    lines
}

fn twig_fir(r: &mut Stream) -> Lines {
    let mut lines = vec![pen(&[v(0.0, 1.0), v(0.0, 0.0)], r)];
    let n = 4 + r.below(6);
    let rise = r.range(-0.3, 0.12);
    for k in 0..n {
        let y = 0.95 - 0.75 * k as f64 / n as f64;
        let long = 0.06 + (0.95 - y) * r.range(0.4, 0.55);
        for s in [-1.0, 1.0] {
            lines.push(pen(&[v(0.0, y), v(s * long, y + rise * long * 1.5)], r));
        }
    }
    lines
}

fn palm(r: &mut Stream) -> Lines {
    let top = v(r.range(-0.2, 0.2), r.range(0.55, 0.8));
    let half = r.range(0.015, 0.05);
    let bow = r.range(-0.12, 0.12);
    let middle = top * 0.5 + v(bow, 0.0);
    let mut lines = match r.below(3) {
        0 => vec![soft(&[v(0.0, 0.0), middle, top], r)],
        1 => {
            let a = soft(&[v(-1.6 * half, 0.0), middle - v(half, 0.0), top - v(0.7 * half, 0.0)], r);
            let b = soft(&[v(1.6 * half, 0.0), middle + v(half, 0.0), top + v(0.7 * half, 0.0)], r);
            vec![a, b]
        }
        _ => {
            let corners = [
                top - v(half, 0.0),
                middle - v(half, 0.0),
                v(-1.6 * half, 0.0),
                v(1.6 * half, 0.0),
                middle + v(half, 0.0),
                top + v(half, 0.0),
            ];
            vec![soft(&corners, r)]
        }
    };
    let n = 4 + r.below(5);
    let what = r.below(4);
    for k in 0..n {
        let a = PI * (-0.12 + 1.24 * (k as f64 + r.range(0.2, 0.8)) / n as f64);
        let way = direction(a) * r.range(0.28, 0.45);
        let droop = v(0.25 * way.x, -r.range(0.05, 0.3) * way.x.abs() - 0.04);
        let (bend, tip) = (top + way * 0.6, top + way + droop);
        match what {
            0 => lines.push(soft(&[top, bend, tip], r)),
            // There and back.
            1 => {
                let low = bend - v(0.0, r.range(0.05, 0.1));
                lines.push(soft(&[top, bend + v(0.0, 0.03), tip, low, top], r));
            }
            2 => {
                let half = 0.16 * way.length();
                lines.push(leafy_blade(top, tip - top, half, r));
            }
            _ => {
                lines.push(soft(&[top, bend, tip], r));
                for i in 2..6 {
                    let at = top
                        .lerp(bend, f64::from(i) / 6.0)
                        .lerp(bend.lerp(tip, f64::from(i) / 6.0), f64::from(i) / 6.0);
                    lines.push(pen(&[at, at + v(r.range(-0.02, 0.02), -r.range(0.05, 0.1))], r));
                }
            }
        }
    }
    if r.chance(0.3) {
        for _ in 0..2 + r.below(2) {
            let at = top + v(r.range(-0.05, 0.05), r.range(-0.06, 0.0));
            lines.push(round(at, DVec2::splat(0.03), 0, 0.0, r));
        }
    }
    if r.chance(0.25) {
        lines.push(pen(&[v(-0.35, 0.0), v(0.35, 0.0)], r));
    }
    lines
}

fn cloud_bush(r: &mut Stream) -> Lines {
    let size = v(r.range(0.45, 0.6), r.range(0.25, 0.45));
    let bumps = 6 + r.below(8);
    let mut lines = match r.below(3) {
        0 => vec![round(v(0.0, size.y), size, bumps, 0.16, r)],
        1 => {
            let open = arc(v(0.0, 0.0), size * 1.3, -0.1, PI + 0.1, bumps, 0.18, r);
            let (a, b) = (open[0], open[open.len() - 1]);
            let ground = pen(&[b, a], r);
            vec![open, ground]
        }
        _ => {
            let a = round(v(-0.25, 0.3), size * 0.6, bumps / 2 + 2, 0.16, r);
            let b = round(v(0.25, 0.3), size * 0.6, bumps / 2 + 2, 0.16, r);
            vec![a, b]
        }
    };
    match r.below(4) {
        0 => lines.push(scribbled(v(0.0, size.y), size * 0.5, r)),
        1 => {
            for _ in 0..3 + r.below(5) {
                let at = v(r.range(-0.3, 0.3), r.range(0.15, 0.5));
                lines.push(arc(at, DVec2::splat(0.05), 0.0, PI, 0, 0.0, r));
            }
        }
        _ => {}
    }
    lines
}

fn humps(r: &mut Stream) -> Lines {
    let n = 4 + r.below(5);
    let mut line = Vec::new();
    for k in 0..n {
        let a = PI * (1.0 - (k as f64 + 0.5) / n as f64);
        let long = r.range(0.4, 0.6);
        let root = direction(a) * 0.12;
        let tip = direction(a) * long;
        let side = direction(a + 0.5 * PI) * r.range(0.06, 0.1);
        line.extend(soft(&[root + side, tip + side, tip * 1.1, tip - side, root - side], r));
    }
    let mut lines = vec![line];
    if r.chance(0.7) {
        lines.push(pen(&[v(-0.5, 0.0), v(0.5, 0.0)], r));
    }
    lines
}

fn zigzag_grass(r: &mut Stream) -> Lines {
    let n = 5 + r.below(14);
    let tall = r.range(1.0, 4.0) / n as f64;
    let corners: Vec<DVec2> = (0..=2 * n)
        .map(|k| {
            v(
                k as f64 / n as f64 * 0.5,
                if k % 2 == 0 { r.range(0.0, 0.1) } else { r.range(0.7, 1.0) } * tall,
            )
        })
        .collect();
    let mut lines = vec![pen(&corners, r)];
    if r.chance(0.2) {
        lines.push(pen(&[v(0.0, 0.0), v(1.0, 0.0)], r));
    }
    lines
}

fn fan(r: &mut Stream) -> Lines {
    let n = 4 + r.below(8);
    let wide = r.range(0.0, 0.6);
    let there_and_back = r.chance(0.4);
    (0..n)
        .map(|k| {
            let t = (k as f64 + r.range(0.2, 0.8)) / n as f64 - 0.5;
            let foot = v(wide * t, 0.0);
            let tip = foot + direction(0.5 * PI - t * r.range(0.6, 1.8)) * r.range(0.5, 1.0);
            let bend = foot.lerp(tip, 0.5) + v(0.0, 0.1);
            if there_and_back {
                soft(&[foot - v(0.03, 0.0), bend, tip, tip, bend + v(0.05, -0.03), foot + v(0.03, 0.0)], r)
            } else {
                soft(&[foot, bend, tip], r)
            }
        })
        .collect()
}

fn leaf(r: &mut Stream) -> Lines {
    let angle = if r.chance(0.4) { 0.5 * PI + r.range(-0.2, 0.2) } else { r.range(0.0, TAU) };
    let way = direction(angle);
    let across = way.perp();
    let half = r.range(0.2, 0.42);
    let mut lines = if r.chance(0.6) {
        vec![leafy_blade(DVec2::ZERO, way, half, r)]
    } else {
        let side = |r: &mut Stream, s: f64| {
            soft(&[DVec2::ZERO, way * 0.2 + across * (s * half), way * 0.6 + across * (s * half), way], r)
        };
        vec![side(r, 1.0), side(r, -1.0)]
    };
    let stalk = -way * r.range(0.0, 0.3);
    lines.push(pen(&[stalk, way * r.range(0.7, 1.0)], r));
    let veins = r.below(8);
    for k in 0..veins {
        let at = way * (0.15 + 0.65 * k as f64 / veins as f64);
        for s in [-1.0, 1.0] {
            let end = at + (way * 0.5 + across * s) * (half * r.range(0.5, 0.8));
            lines.push(pen(&[at, end], r));
        }
    }
    lines
}

fn lobed_leaf(r: &mut Stream) -> Lines {
    let n = 3 + 2 * r.below(3);
    let angle = if r.chance(0.6) { 0.5 * PI + r.range(-0.2, 0.2) } else { r.range(0.2, 2.9) };
    let (deep, teeth, sharp) = (r.range(0.25, 0.5), r.chance(0.4), r.range(0.1, 0.28));
    let mut corners = Vec::new();
    let mut tips = Vec::new();
    for k in 0..n {
        let a = angle + PI * 1.35 * (k as f64 / (n - 1) as f64 - 0.5);
        let long = 0.65 + 0.35 * ops::cos(a - angle);
        corners.push(direction(a - sharp) * deep);
        if teeth {
            corners.extend([
                direction(a - 0.8 * sharp) * (0.75 * long),
                direction(a - 0.4 * sharp) * (0.7 * long),
            ]);
        }
        corners.push(direction(a) * long);
        tips.push(direction(a) * long);
        if teeth {
            corners.extend([
                direction(a + 0.4 * sharp) * (0.7 * long),
                direction(a + 0.8 * sharp) * (0.75 * long),
            ]);
        }
        corners.push(direction(a + sharp) * deep);
    }
    let root = -direction(angle) * 0.1;
    corners.insert(0, root);
    corners.push(root);
    let mut lines = vec![if r.chance(0.4) { soft(&corners, r) } else { pen(&corners, r) }];
    let stalk = root - direction(angle) * r.range(0.1, 0.5);
    let rib = direction(angle) * r.range(0.0, 0.9);
    lines.push(pen(&[stalk, rib], r));
    if r.chance(0.6) {
        for tip in tips {
            lines.push(pen(&[root, root.lerp(tip, r.range(0.6, 0.9))], r));
        }
    }
    lines
}

fn flower_head(r: &mut Stream) -> Lines {
    let n = 4 + r.below(8);
    let disc = r.range(0.1, 0.25);
    let mut lines = vec![round(DVec2::ZERO, DVec2::splat(disc), 0, 0.0, r)];
    if r.chance(0.4) {
        lines.push(round(DVec2::ZERO, DVec2::splat(0.55), n, 0.42, r));
        return lines;
    }
    let first = r.range(0.0, TAU);
    for k in 0..n {
        let way = direction(first + TAU * k as f64 / n as f64);
        let half = ops::sin(PI / n as f64) * r.range(0.3, 0.5);
        lines.push(leafy_blade(way * disc, way * r.range(0.4, 0.5), half, r));
    }
    lines
}

fn tulip(r: &mut Stream) -> Lines {
    let (half, low, top) = (r.range(0.12, 0.22), r.range(0.55, 0.7), 1.0);
    let n = 3;
    let mut corners = vec![v(-half, top)];
    for k in 0..n {
        let x = -half + 2.0 * half * (k as f64 + 0.5) / n as f64;
        corners.push(v(x, top - r.range(0.1, 0.15)));
        corners.push(v(-half + 2.0 * half * (k + 1) as f64 / n as f64, top));
    }
    corners.extend([v(half, low + 0.1), v(0.0, low), v(-half, low + 0.1), v(-half, top)]);
    let mut lines = vec![pen(&corners, r), pen(&[v(0.0, low), v(0.0, 0.0)], r)];
    for s in [-1.0, 1.0] {
        if r.chance(0.6) {
            lines.push(leafy_blade(v(0.0, r.range(0.05, 0.3)), v(s * 0.15, 0.25), 0.05, r));
        }
    }
    lines
}

fn potted(r: &mut Stream) -> Lines {
    let (above, _) = match r.below(6) {
        0 => (flower(r).0, 0),
        1 => (leafy(r).0, 0),
        2 => (fan(r), 0),
        3 => (sprout(r), 0),
        4 => (cloud_bush(r), 0),
        _ => (palm(r), 0),
    };
    let (lo, hi) = extent(&above);
    let scale = r.range(0.5, 0.9) / (hi.y - lo.y).max(0.5 * (hi.x - lo.x));
    let above = moved(above, scale, v(-0.5 * (lo.x + hi.x) * scale, -lo.y * scale));
    let (top, foot, tall) = (r.range(0.15, 0.3), r.range(0.1, 0.22), r.range(0.2, 0.45));
    let mut pot = match r.below(4) {
        0 => vec![pen(&[v(-top, 0.0), v(-foot, -tall), v(foot, -tall), v(top, 0.0), v(-top, 0.0)], r)],
        1 => {
            let rim = 0.22 * tall;
            vec![
                pen(&[v(-top, 0.0), v(-top, -rim), v(top, -rim), v(top, 0.0), v(-top, 0.0)], r),
                pen(&[v(-0.85 * top, -rim), v(-foot, -tall), v(foot, -tall), v(0.85 * top, -rim)], r),
            ]
        }
        2 => vec![
            round(v(0.0, 0.0), v(top, 0.05), 0, 0.0, r),
            soft(&[v(-top, 0.0), v(-foot, -tall), v(foot, -tall), v(top, 0.0)], r),
        ],
        _ => {
            let (a, b) = (v(-top, 0.0), v(top, 0.0));
            vec![
                pen(&[a, v(-foot, -tall)], r),
                pen(&[v(-foot, -tall), v(foot, -tall)], r),
                pen(&[v(foot, -tall), b], r),
                pen(&[a, b], r),
            ]
        }
    };
    if r.chance(0.5) {
        pot.extend(above);
        pot
    } else {
        [above, pot].concat()
    }
}

fn sprout(r: &mut Stream) -> Lines {
    let top = v(r.range(-0.1, 0.1), 1.0);
    let mut lines = vec![soft(&[v(0.0, 0.0), top * 0.5 + v(r.range(-0.1, 0.1), 0.0), top], r)];
    let n = 2 + r.below(6);
    let closed = r.chance(0.6);
    for k in 0..n {
        let at = top * r.range(0.3, 1.0);
        let s = if k % 2 == 0 { 1.0 } else { -1.0 };
        let way = v(s * r.range(0.2, 0.4), r.range(0.0, 0.3));
        let half = 0.2 * way.length();
        lines.push(if closed {
            leafy_blade(at, way, half, r)
        } else {
            soft(&[at, at + way * 0.6 + v(0.0, 0.06), at + way], r)
        });
    }
    lines
}

pub(super) fn turned(r: &mut Stream, lines: Lines, most: f64) -> Lines {
    let (s, c) = ops::sin_cos(r.range(-most, most));
    lines
        .into_iter()
        .map(|l| l.into_iter().map(|p| v(c * p.x - s * p.y, s * p.x + c * p.y)).collect())
        .collect()
}

/// A tuft of green at a place.
pub(super) fn tuft(r: &mut Stream, at: DVec2, size: f64) -> Lines {
    let n = 3 + r.below(4);
    match r.below(3) {
        0 => (0..n)
            .map(|_| {
                let tip = at + direction(0.5 * PI + r.range(-0.7, 0.7)) * size;
                pen(&[at, tip], r)
            })
            .collect(),
        1 => {
            let mut corners = vec![at - v(0.3 * size, 0.0)];
            for k in 0..n {
                let t = (k as f64 + 0.5) / n as f64 - 0.5;
                corners.push(at + v(size * t * 1.2, size * r.range(0.7, 1.0)));
                corners.push(at + v(size * (t + 0.5 / n as f64) * 0.5, 0.2 * size));
            }
            vec![pen(&corners, r)]
        }
        _ => (0..n)
            .map(|_| {
                let way = direction(0.5 * PI + r.range(-0.8, 0.8)) * size;
                leafy_blade(at, way, 0.2 * size, r)
            })
            .collect(),
    }
}

fn carrot(r: &mut Stream) -> Lines {
    let half = r.range(0.1, 0.2);
    let mut lines = vec![soft(
        &[
            v(0.0, 0.7),
            v(-half, 0.72),
            v(-half, 0.5),
            v(0.0, -0.1),
            v(0.0, -0.1),
            v(half, 0.5),
            v(half, 0.72),
            v(0.0, 0.7),
        ],
        r,
    )];
    let green = r.range(0.2, 0.4);
    lines.extend(tuft(r, v(0.0, 0.7), green));
    for _ in 0..r.below(6) {
        let y = r.range(0.1, 0.6);
        let x = half * (y + 0.1) * r.range(-1.0, 0.3);
        lines.push(pen(&[v(x, y), v(x + r.range(0.04, 0.1), y + r.range(-0.02, 0.02))], r));
    }
    turned(r, lines, 1.6)
}

fn mushroom(r: &mut Stream) -> Lines {
    let (half, stem, low) = (r.range(0.35, 0.55), r.range(0.08, 0.2), r.range(0.4, 0.6));
    let mut cap = arc(v(0.0, low), v(half, r.range(0.3, 0.45)), 0.0, PI, 0, 0.0, r);
    let (a, b) = (cap[0], cap[cap.len() - 1]);
    let under = soft(&[b, v(0.0, low - r.range(-0.05, 0.12)), a], r);
    cap.extend(under);
    let wood = match r.below(3) {
        0 => vec![pen(&[v(-stem, low), v(-stem, 0.0), v(stem, 0.0), v(stem, low)], r)],
        1 => vec![soft(&[v(-stem, low), v(-1.5 * stem, 0.0), v(1.5 * stem, 0.0), v(stem, low)], r)],
        _ => vec![pen(&[v(-stem, low), v(-stem, 0.0)], r), pen(&[v(stem, low), v(stem, 0.0)], r)],
    };
    let mut lines = if r.chance(0.5) { [wood, vec![cap]].concat() } else { [vec![cap], wood].concat() };
    if r.chance(0.4) {
        for _ in 0..2 + r.below(4) {
            let at = v(r.range(-0.6, 0.6) * half, low + r.range(0.06, 0.25));
            let size = DVec2::splat(r.range(0.02, 0.06));
            lines.push(round(at, size, 0, 0.0, r));
        }
    }
    lines
}

fn pod(r: &mut Stream) -> Lines {
    let half = r.range(0.08, 0.22);
    let bow = r.range(0.0, 0.3);
    let bent = |p: DVec2| p + v(0.0, bow * (2.0 * p.x - 1.0) * (2.0 * p.x - 1.0));
    let mut lines = vec![leafy_blade(DVec2::ZERO, v(1.0, 0.0), half, r).into_iter().map(bent).collect()];
    let peas = r.below(7);
    for k in 0..peas {
        let at = bent(v(0.15 + 0.7 * (k as f64 + 0.5) / peas as f64, 0.0));
        let size = DVec2::splat((0.7 * half).min(0.3 / peas as f64));
        lines.push(round(at, size, 0, 0.0, r));
    }
    if r.chance(0.4) {
        let end = bent(v(1.0, 0.0));
        lines.push(pen(&[end, end + v(0.1, r.range(-0.05, 0.08))], r));
    }
    turned(r, lines, PI)
}

fn onion(r: &mut Stream) -> Lines {
    let size = v(r.range(0.35, 0.5), r.range(0.3, 0.42));
    let mut lines = vec![round(v(0.0, 0.4), size, 0, 0.0, r)];
    let shells = r.below(4);
    for k in 0..shells {
        let inner = size * (0.8 - 0.2 * k as f64);
        lines.push(round(v(0.0, 0.4), inner, 0, 0.0, r));
    }
    let green = r.range(0.15, 0.3);
    lines.extend(tuft(r, v(0.0, 0.4 + size.y), green));
    if r.chance(0.4) {
        for _ in 0..3 {
            lines.push(pen(&[v(0.0, 0.4 - size.y), v(r.range(-0.08, 0.08), 0.3 - size.y)], r));
        }
    }
    lines
}

fn potato(r: &mut Stream) -> Lines {
    let size = v(r.range(0.4, 0.55), r.range(0.25, 0.4));
    let mut lines = vec![arc(DVec2::ZERO, size, 0.0, TAU * 0.99, 0, 0.0, r)];
    for _ in 0..r.below(8) {
        let at = direction(r.range(0.0, TAU)) * size * r.range(0.0, 0.7);
        lines.push(pen(&[at, at + v(r.range(0.01, 0.04), r.range(-0.02, 0.02))], r));
    }
    turned(r, lines, 1.5)
}

fn grapes(r: &mut Stream) -> Lines {
    let rows = 3 + r.below(3);
    let size = r.range(0.09, 0.14);
    let mut lines = Vec::new();
    for k in 0..rows {
        for i in 0..rows - k {
            let x = (i as f64 - 0.5 * (rows - k - 1) as f64) * 1.9 * size;
            let at = v(x + r.range(-0.02, 0.02), -1.7 * size * k as f64 + r.range(-0.02, 0.02));
            let own = DVec2::splat(size * r.range(0.85, 1.15));
            lines.push(round(at, own, 0, 0.0, r));
        }
    }
    if r.chance(0.8) {
        lines.push(pen(&[v(0.0, size), v(r.range(-0.05, 0.05), size + r.range(0.1, 0.25))], r));
    }
    if r.chance(0.3) {
        lines.push(leafy_blade(v(0.0, size + 0.1), v(0.25, 0.1), 0.08, r));
    }
    lines
}

fn berry(r: &mut Stream) -> Lines {
    let size = v(r.range(0.25, 0.4), r.range(0.3, 0.45));
    let small = r.range(0.06, 0.11);
    let mut lines = Vec::new();
    for _ in 0..12 + r.below(14) {
        let at = direction(r.range(0.0, TAU)) * size * r.range(0.0, 1.0).sqrt();
        lines.push(round(at, DVec2::splat(small), 0, 0.0, r));
    }
    if r.chance(0.5) {
        lines.push(round(DVec2::ZERO, size + DVec2::splat(small), 6, 0.1, r));
    }
    if r.chance(0.6) {
        let green = r.range(0.15, 0.25);
        lines.extend(tuft(r, v(0.0, size.y), green));
    }
    lines
}

fn crescent(r: &mut Stream) -> Lines {
    let thick = r.range(0.12, 0.3);
    let outer = arc(DVec2::ZERO, DVec2::splat(1.0), 0.2, r.range(1.7, 2.6), 0, 0.0, r);
    let (a, b) = (outer[0], outer[outer.len() - 1]);
    let mid = direction(1.1) * (1.0 - thick);
    let inner = soft(&[b, b.lerp(mid, 0.5) * 0.97, mid, mid.lerp(a, 0.5) * 0.97, a], r);
    let mut lines = if r.chance(0.6) { vec![[outer, inner].concat()] } else { vec![outer, inner] };
    if r.chance(0.3) {
        lines.push(soft(&[b * 0.98, direction(1.1) * (1.0 - 0.5 * thick), a * 0.98], r));
    }
    turned(r, lines, PI)
}

fn slice(r: &mut Stream) -> Lines {
    let mut rind = arc(DVec2::ZERO, v(0.5, r.range(0.35, 0.5)), PI, TAU, 0, 0.0, r);
    let (a, b) = (rind[0], rind[rind.len() - 1]);
    let top = pen(&[b, a], r);
    let mut lines = if r.chance(0.5) {
        rind.extend(top);
        vec![rind]
    } else {
        vec![rind, top]
    };
    if r.chance(0.5) {
        lines.push(arc(DVec2::ZERO, v(0.42, 0.34), PI, TAU, 0, 0.0, r));
    }
    for _ in 0..r.below(7) {
        let at = v(r.range(-0.3, 0.3), r.range(-0.2, -0.04));
        lines.push(pen(&[at, at + v(0.0, 0.04)], r));
    }
    turned(r, lines, 0.6)
}

fn strawberry(r: &mut Stream) -> Lines {
    let half = r.range(0.3, 0.42);
    let body = [
        v(0.0, 0.8),
        v(-half, 0.85),
        v(-half, 0.45),
        v(-0.05, 0.0),
        v(0.05, 0.0),
        v(half, 0.45),
        v(half, 0.85),
        v(0.0, 0.8),
    ];
    let mut lines = vec![soft(&body, r)];
    let green = r.range(0.15, 0.3);
    lines.extend(tuft(r, v(0.0, 0.78), green));
    for _ in 0..r.below(10) {
        let at = v(r.range(-0.2, 0.2), r.range(0.25, 0.65));
        lines.push(pen(&[at, at - v(0.0, 0.03)], r));
    }
    lines
}

fn pineapple(r: &mut Stream) -> Lines {
    let size = v(r.range(0.2, 0.32), r.range(0.3, 0.42));
    let mut lines = vec![round(v(0.0, size.y), size, 0, 0.0, r)];
    for _ in 0..r.below(5) {
        let t = r.range(-0.6, 0.6);
        lines.push(pen(
            &[v(-size.x * 0.8, size.y * (1.0 + t) - 0.1), v(size.x * 0.8, size.y * (1.0 + t) + 0.1)],
            r,
        ));
        lines.push(pen(
            &[v(size.x * 0.8, size.y * (1.0 + t) - 0.1), v(-size.x * 0.8, size.y * (1.0 + t) + 0.1)],
            r,
        ));
    }
    let green = r.range(0.25, 0.45);
    lines.extend(tuft(r, v(0.0, 2.0 * size.y), green));
    lines
}

fn pear(r: &mut Stream) -> Lines {
    let half = r.range(0.3, 0.4);
    let body = [
        v(0.0, 0.95),
        v(-0.16, 0.95),
        v(-0.16, 0.6),
        v(-half, 0.45),
        v(-half, 0.0),
        v(half, 0.0),
        v(half, 0.45),
        v(0.16, 0.6),
        v(0.16, 0.95),
        v(0.0, 0.95),
    ];
    let mut lines = vec![soft(&body, r)];
    lines.push(pen(&[v(0.0, 0.92), v(r.range(-0.06, 0.06), 1.1)], r));
    if r.chance(0.4) {
        lines.push(leafy_blade(v(0.0, 1.0), v(0.2, 0.1), 0.06, r));
    }
    lines
}

fn house(r: &mut Stream) -> Lines {
    let (w, h, roof) = (r.range(0.3, 0.55), r.range(0.4, 0.7), r.range(0.2, 0.45));
    let over = r.range(0.0, 0.1);
    let mut lines = vec![
        pen(&[v(-w, 0.0), v(-w, h), v(w, h), v(w, 0.0), v(-w, 0.0)], r),
        pen(&[v(-w - over, h), v(0.0, h + roof), v(w + over, h)], r),
    ];
    if r.chance(0.8) {
        let d = r.range(0.06, 0.1);
        lines.push(pen(&[v(-d, 0.0), v(-d, 0.5 * h), v(d, 0.5 * h), v(d, 0.0)], r));
    }
    for s in [-1.0, 1.0] {
        if r.chance(0.6) {
            let (c, d) = (v(s * 0.6 * w, 0.6 * h), 0.15 * w);
            lines.push(pen(&[c + v(-d, -d), c + v(-d, d), c + v(d, d), c + v(d, -d), c + v(-d, -d)], r));
            if r.chance(0.5) {
                lines.push(pen(&[c - v(d, 0.0), c + v(d, 0.0)], r));
                lines.push(pen(&[c - v(0.0, d), c + v(0.0, d)], r));
            }
        }
    }
    if r.chance(0.4) {
        lines.push(pen(
            &[
                v(0.5 * w, h + 0.4 * roof),
                v(0.5 * w, h + roof),
                v(0.7 * w, h + roof),
                v(0.7 * w, h + 0.25 * roof),
            ],
            r,
        ));
    }
    lines
}

fn head(r: &mut Stream) -> Lines {
    let size = v(r.range(0.4, 0.55), r.range(0.4, 0.5));
    let mut lines = vec![round(DVec2::ZERO, size, 0, 0.0, r)];
    for s in [-1.0, 1.0] {
        let eye = DVec2::splat(r.range(0.03, 0.08));
        lines.push(round(v(s * 0.18, 0.12), eye, 0, 0.0, r));
    }
    lines.push(soft(&[v(-0.2, -0.18), v(0.0, -0.18 - r.range(0.0, 0.15)), v(0.2, -0.18)], r));
    lines
}

fn face(r: &mut Stream) -> Lines {
    let mut lines = head(r);
    if r.chance(0.6) {
        lines.push(pen(&[v(0.0, 0.08), v(0.04, -0.06), v(-0.02, -0.07)], r));
    }
    for _ in 0..r.below(7) {
        let a = r.range(0.6, 2.5);
        lines.push(pen(&[direction(a) * 0.47, direction(a) * r.range(0.55, 0.75)], r));
    }
    lines
}

fn cat(r: &mut Stream) -> Lines {
    let mut lines = head(r);
    for s in [-1.0, 1.0] {
        lines.push(pen(
            &[v(s * 0.4, 0.25), v(s * r.range(0.35, 0.45), r.range(0.6, 0.75)), v(s * 0.12, 0.44)],
            r,
        ));
        for k in 0..2 + r.below(2) {
            let y = -0.08 * k as f64;
            lines.push(pen(&[v(s * 0.15, y - 0.03), v(s * r.range(0.5, 0.75), y + r.range(-0.08, 0.08))], r));
        }
    }
    lines.push(pen(&[v(-0.04, 0.0), v(0.04, 0.0), v(0.0, -0.06), v(-0.04, 0.0)], r));
    if r.chance(0.5) {
        lines.push(round(v(0.3, -1.0), v(0.5, 0.55), 0, 0.0, r));
        lines.push(soft(&[v(0.75, -1.2), v(1.2, -1.1), v(1.1, -0.6), v(1.3, -0.4)], r));
        for x in [0.0, 0.5] {
            lines.push(pen(&[v(x, -1.5), v(x, -1.8)], r));
        }
    }
    lines
}

fn person(r: &mut Stream) -> Lines {
    let size = DVec2::splat(r.range(0.09, 0.15));
    let mut lines = vec![round(v(0.0, 0.88), size, 0, 0.0, r)];
    lines.push(pen(&[v(0.0, 0.88 - size.y), v(0.0, 0.4)], r));
    for s in [-1.0, 1.0] {
        lines.push(pen(&[v(0.0, 0.4), v(s * r.range(0.12, 0.25), 0.0)], r));
        lines.push(pen(&[v(0.0, 0.66), v(s * r.range(0.2, 0.3), r.range(0.45, 0.8))], r));
    }
    if r.chance(0.5) {
        for s in [-1.0, 1.0] {
            lines.push(round(v(s * 0.04, 0.9), DVec2::splat(0.015), 0, 0.0, r));
        }
        lines.push(soft(&[v(-0.05, 0.84), v(0.0, 0.81), v(0.05, 0.84)], r));
    }
    lines
}

fn car(r: &mut Stream) -> Lines {
    let (w, roof) = (r.range(0.6, 0.8), r.range(0.2, 0.3));
    let mut lines = vec![pen(
        &[
            v(-w, 0.1),
            v(-w, 0.35),
            v(-0.5 * w, 0.38),
            v(-0.3 * w, 0.38 + roof),
            v(0.35 * w, 0.38 + roof),
            v(0.55 * w, 0.38),
            v(w, 0.33),
            v(w, 0.1),
            v(-w, 0.1),
        ],
        r,
    )];
    for s in [-1.0, 1.0] {
        lines.push(round(v(s * 0.55 * w, 0.1), DVec2::splat(0.12), 0, 0.0, r));
        if r.chance(0.5) {
            lines.push(round(v(s * 0.55 * w, 0.1), DVec2::splat(0.05), 0, 0.0, r));
        }
    }
    if r.chance(0.7) {
        lines.push(pen(
            &[
                v(-0.25 * w, 0.4),
                v(-0.2 * w, 0.34 + roof),
                v(0.0, 0.34 + roof),
                v(0.0, 0.4),
                v(-0.25 * w, 0.4),
            ],
            r,
        ));
    }
    lines
}

fn fish(r: &mut Stream) -> Lines {
    let size = v(r.range(0.4, 0.55), r.range(0.18, 0.3));
    let mut lines = vec![round(DVec2::ZERO, size, 0, 0.0, r)];
    lines.push(pen(&[v(size.x, 0.0), v(size.x + 0.25, 0.2), v(size.x + 0.22, -0.2), v(size.x, 0.0)], r));
    lines.push(round(v(-0.6 * size.x, 0.05), DVec2::splat(0.03), 0, 0.0, r));
    if r.chance(0.5) {
        lines.push(pen(&[v(-0.1, size.y), v(0.05, size.y + 0.15), v(0.2, 0.85 * size.y)], r));
    }
    for k in 0..r.below(4) {
        lines.push(arc(v(-0.1 + 0.15 * k as f64, 0.0), v(0.05, 0.1), -1.3, 1.3, 0, 0.0, r));
    }
    lines
}

pub(super) fn sun(r: &mut Stream) -> Lines {
    let size = r.range(0.2, 0.35);
    let mut lines = vec![round(DVec2::ZERO, DVec2::splat(size), 0, 0.0, r)];
    let n = 7 + r.below(7);
    for k in 0..n {
        let way = direction(TAU * k as f64 / n as f64 + r.range(-0.1, 0.1));
        lines.push(pen(&[way * (size + r.range(0.04, 0.08)), way * (size + r.range(0.2, 0.3))], r));
    }
    lines
}

fn letters(r: &mut Stream) -> Lines {
    let n = 2 + r.below(5);
    let mut lines = Vec::new();
    for k in 0..n {
        let at = v(0.62 * k as f64, 0.0);
        let own: Lines = match r.below(9) {
            0 => vec![pen(&[v(0.0, 0.0), v(0.2, 0.8), v(0.4, 0.0)], r), pen(&[v(0.1, 0.3), v(0.3, 0.3)], r)],
            1 => vec![pen(&[v(0.0, 0.8), v(0.0, 0.0), v(0.35, 0.0)], r)],
            2 => vec![
                pen(&[v(0.4, 0.8), v(0.0, 0.8), v(0.0, 0.0), v(0.4, 0.0)], r),
                pen(&[v(0.0, 0.4), v(0.3, 0.4)], r),
            ],
            3 => vec![pen(&[v(0.0, 0.8), v(0.4, 0.8)], r), pen(&[v(0.2, 0.8), v(0.2, 0.0)], r)],
            4 => vec![round(v(0.2, 0.4), v(0.2, 0.4), 0, 0.0, r)],
            5 => vec![soft(
                &[v(0.4, 0.7), v(0.1, 0.9), v(0.0, 0.5), v(0.4, 0.4), v(0.4, 0.0), v(0.0, 0.05)],
                r,
            )],
            6 => vec![pen(&[v(0.0, 0.0), v(0.0, 0.8), v(0.4, 0.0), v(0.4, 0.8)], r)],
            7 => vec![pen(&[v(0.0, 0.8), v(0.4, 0.0)], r), pen(&[v(0.4, 0.8), v(0.0, 0.0)], r)],
            _ => vec![
                pen(&[v(0.0, 0.0), v(0.0, 0.8)], r),
                pen(&[v(0.4, 0.0), v(0.4, 0.8)], r),
                pen(&[v(0.0, 0.4), v(0.4, 0.4)], r),
            ],
        };
        lines.extend(moved(own, 1.0, at));
    }
    lines
}

fn star(r: &mut Stream) -> Lines {
    let first = 0.5 * PI + r.range(-0.15, 0.15);
    let order = if r.chance(0.5) { 2 } else { 1 };
    let corners: Vec<DVec2> = if order == 2 {
        (0..=5).map(|k| direction(first + TAU * f64::from(k * 2) / 5.0)).collect()
    } else {
        (0..=10)
            .map(|k| direction(first + TAU * f64::from(k) / 10.0) * if k % 2 == 0 { 1.0 } else { 0.42 })
            .collect()
    };
    vec![pen(&corners, r)]
}

fn spiral(r: &mut Stream) -> Lines {
    let turns = r.range(2.0, 5.0);
    let n = 120;
    let stretch = v(1.0, r.range(0.6, 1.0));
    let line = (0..=n)
        .map(|k| f64::from(k) / f64::from(n))
        .map(|t| direction(TAU * turns * t) * stretch * (0.05 + 0.95 * t));
    vec![line.map(|p| p + v(r.normal(), r.normal()) * 0.01).collect()]
}

fn boat(r: &mut Stream) -> Lines {
    let w = r.range(0.45, 0.6);
    let mut lines = vec![
        pen(&[v(-w, 0.25), v(-0.6 * w, 0.0), v(0.6 * w, 0.0), v(w, 0.25), v(-w, 0.25)], r),
        pen(&[v(0.0, 0.25), v(0.0, 1.0)], r),
        pen(&[v(0.0, 1.0), v(0.6 * w, 0.35), v(0.0, 0.35)], r),
    ];
    if r.chance(0.4) {
        lines.push(pen(&[v(0.0, 0.9), v(-0.5 * w, 0.35), v(0.0, 0.35)], r));
    }
    if r.chance(0.4) {
        let waves: Vec<DVec2> =
            (0..16).map(|k| v(-0.9 + 0.12 * f64::from(k), if k % 2 == 0 { -0.05 } else { 0.02 })).collect();
        lines.push(soft(&waves, r));
    }
    lines
}

fn cup(r: &mut Stream) -> Lines {
    let (w, h) = (r.range(0.25, 0.4), r.range(0.5, 0.8));
    let mut lines = vec![
        round(v(0.0, h), v(w, 0.07), 0, 0.0, r),
        pen(&[v(-w, h), v(-0.8 * w, 0.0), v(0.8 * w, 0.0), v(w, h)], r),
        soft(&[v(w, 0.8 * h), v(w + 0.3, 0.8 * h), v(w + 0.3, 0.3 * h), v(0.88 * w, 0.3 * h)], r),
    ];
    if r.chance(0.3) {
        for x in [-0.1, 0.1] {
            lines.push(soft(&[v(x, h + 0.12), v(x + 0.06, h + 0.2), v(x - 0.06, h + 0.3), v(x, h + 0.4)], r));
        }
    }
    lines
}

fn table(r: &mut Stream) -> Lines {
    let (w, h) = (r.range(0.5, 0.7), r.range(0.4, 0.6));
    let mut lines = vec![pen(&[v(-w, h), v(w, h), v(w, h + 0.08), v(-w, h + 0.08), v(-w, h)], r)];
    for x in [-0.9_f64, 0.9, -0.7, 0.7] {
        if x.abs() > 0.8 || r.chance(0.4) {
            lines.push(pen(&[v(x * w, h), v(x * w, 0.0)], r));
        }
    }
    if r.chance(0.3) {
        lines.push(pen(&[v(-0.9 * w, h), v(-0.9 * w, 2.0 * h), v(-0.75 * w, 2.0 * h), v(-0.75 * w, h)], r));
    }
    lines
}

fn arrow(r: &mut Stream) -> Lines {
    let lines = vec![
        pen(&[v(0.0, 0.0), v(1.0, 0.0)], r),
        pen(&[v(1.0 - r.range(0.15, 0.3), 0.2), v(1.0, 0.0), v(1.0 - r.range(0.15, 0.3), -0.2)], r),
    ];
    turned(r, lines, 1.2)
}

fn cube(r: &mut Stream) -> Lines {
    let (w, h) = (r.range(0.3, 0.5), r.range(0.3, 0.5));
    let back = v(r.range(0.15, 0.3), r.range(0.15, 0.3));
    let mut lines = vec![pen(&[v(0.0, 0.0), v(0.0, h), v(w, h), v(w, 0.0), v(0.0, 0.0)], r)];
    if r.chance(0.7) {
        lines.push(pen(&[v(0.0, h), v(0.0, h) + back, v(w, h) + back, v(w, h)], r));
        lines.push(pen(&[v(w, h) + back, v(w, 0.0) + back, v(w, 0.0)], r));
    }
    lines
}

fn hills(r: &mut Stream) -> Lines {
    let corners: Vec<DVec2> = (0..5 + r.below(4))
        .map(|k| v(0.25 * k as f64, if k % 2 == 0 { 0.0 } else { r.range(0.2, 0.5) }))
        .collect();
    let sharp = r.chance(0.5);
    let mut lines = vec![if sharp { pen(&corners, r) } else { soft(&corners, r) }];
    if r.chance(0.6) {
        lines.push(round(v(r.range(0.2, 1.0), 0.7), DVec2::splat(0.1), 0, 0.0, r));
    }
    if r.chance(0.4) {
        lines.push(round(v(r.range(0.2, 1.0), 0.8), v(0.2, 0.08), 5, 0.2, r));
    }
    lines
}
