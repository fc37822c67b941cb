//! Made drawings of trees, firs and palms, in the ways in which people draw them.

use std::f64::consts::{PI, TAU};

use base::{Stream, ops};
use glam::DVec2;

use super::pens::{arc, leafy_blade, pen, round, scribbled, sides, soft, v};
use super::{Lines, direction, extent};

/// Draws roots, ground, bark, a hole, as people add them below.
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

pub(super) fn open_tree(r: &mut Stream) -> Lines {
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
        // Crown and one side in one stroke.
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

/// Draws things that people put into a crown.
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

pub(super) fn one_line_tree(r: &mut Stream) -> Lines {
    let half = r.range(0.05, 0.2);
    let top = r.range(0.3, 0.55);
    // Its crown is wider than its trunk.
    let size = v(r.range(0.25_f64.max(1.5 * half), 0.7), 0.5 * (1.0 - top) * 1.05);
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

/// Draws branches from a place, and theirs.
fn branches(r: &mut Stream, from: DVec2, angle: f64, length: f64, depth: usize, lines: &mut Lines) {
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

pub(super) fn bare_tree(r: &mut Stream) -> Lines {
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

pub(super) fn twiggy_tree(r: &mut Stream) -> Lines {
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

/// Draws a crown much higher than wide.
pub(super) fn narrow_tree(r: &mut Stream) -> Lines {
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

/// Draws several heads with many petals each, on stems that fork.
pub(super) fn spray(r: &mut Stream) -> Lines {
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

/// Draws the outline of a trunk that divides into branches, or into roots as well.
pub(super) fn outlined_tree(r: &mut Stream) -> Lines {
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

/// Draws a trunk under loops that continue without a gap.
pub(super) fn looped_tree(r: &mut Stream) -> Lines {
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

pub(super) fn branched_tree(r: &mut Stream) -> Lines {
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

pub(super) fn lobed_tree(r: &mut Stream) -> Lines {
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

/// Returns the side of a fir from its top down, to the right.
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

pub(super) fn zigzag_fir(r: &mut Stream) -> Lines {
    let (foot, half) = (r.range(0.08, 0.45), r.range(0.2, 0.42));
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

pub(super) fn stacked_fir(r: &mut Stream) -> Lines {
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

pub(super) fn twig_fir(r: &mut Stream) -> Lines {
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

pub(super) fn palm(r: &mut Stream) -> Lines {
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

/// Returns the trunk of a palm, and the point from which fronds hang.
fn palm_trunk(r: &mut Stream) -> (Lines, DVec2) {
    let top = v(r.range(-0.25, 0.25), r.range(0.5, 0.75));
    let (half, bow) = (r.range(0.015, 0.06), r.range(-0.15, 0.15));
    let middle = top * 0.5 + v(bow, 0.0);
    let side = |s: f64, r: &mut Stream| {
        soft(&[v(s * 1.5 * half, 0.0), middle + v(s * half, 0.0), top + v(s * 0.7 * half, 0.0)], r)
    };
    let mut lines = match r.below(3) {
        0 => vec![soft(&[v(0.0, 0.0), middle, top], r)],
        1 => vec![side(-1.0, r), side(1.0, r)],
        _ => {
            let (mut a, b) = (side(-1.0, r), side(1.0, r));
            a.reverse();
            vec![[a, b].concat()]
        }
    };
    if r.chance(0.35) {
        for k in 1..3 + r.below(6) {
            let at = top * (0.1 * k as f64) + v(2.0 * bow * 0.1 * k as f64, 0.0);
            lines.push(pen(&[at - v(half, 0.0), at + v(half, r.range(-0.02, 0.02))], r));
        }
    }
    (lines, top)
}

/// Draws fronds in one stroke, there and back repeatedly; or with teeth.
pub(super) fn palm_in_few(r: &mut Stream) -> Lines {
    let (trunk, top) = palm_trunk(r);
    let n = 3 + r.below(5);
    let (teeth, one) = (r.chance(0.5), r.chance(0.5));
    let mut all = Vec::new();
    let mut crown = Lines::new();
    for k in 0..n {
        let a = PI * (-0.15 + 1.3 * (k as f64 + r.range(0.25, 0.75)) / n as f64);
        let way = direction(a) * r.range(0.25, 0.45);
        let tip = top + way + v(0.2 * way.x, -r.range(0.05, 0.35) * way.x.abs() - 0.03);
        let bend = top + way * 0.55 + v(0.0, 0.08);
        let m = if teeth { 4 + r.below(4) } else { 2 };
        let mut corners = vec![top, bend, tip];
        for i in 1..m {
            let t = i as f64 / m as f64;
            let at = tip.lerp(bend, t).lerp(bend.lerp(top, t), t);
            if teeth {
                corners.push(at - v(0.0, r.range(0.06, 0.13)));
            }
            corners.push(at - v(0.0, 0.02));
        }
        corners.push(top);
        let line = if teeth { pen(&corners, r) } else { soft(&corners, r) };
        if one { all.extend(line) } else { crown.push(line) }
    }
    if one {
        crown.push(all);
    }
    if r.chance(0.3) {
        crown.push(round(top - v(0.03, 0.03), DVec2::splat(0.03), 0, 0.0, r));
        crown.push(round(top + v(0.04, -0.03), DVec2::splat(0.03), 0, 0.0, r));
    }
    if r.chance(0.2) {
        crown.push(soft(&[v(-0.4, 0.0), v(0.0, 0.06), v(0.4, 0.0)], r));
    }
    if r.chance(0.6) { [trunk, crown].concat() } else { [crown, trunk].concat() }
}

/// Draws a trunk and two to five branches, with few twigs.
pub(super) fn sparse_tree(r: &mut Stream) -> Lines {
    let top = v(r.range(-0.06, 0.06), r.range(0.4, 0.9));
    let half = r.range(0.03, 0.1);
    let mut lines =
        if r.chance(0.6) { vec![pen(&[DVec2::ZERO, top], r)] } else { Vec::from(sides(r, half, top.y)) };
    for k in 0..2 + r.below(5) {
        let s = if k % 2 == 0 { 1.0 } else { -1.0 };
        let at = top * r.range(0.45, 1.0);
        let depth = if r.chance(0.4) { 1 } else { 0 };
        let (angle, long) = (0.5 * PI - s * r.range(0.2, 1.1), r.range(0.2, 0.5));
        branches(r, at, angle, long, depth, &mut lines);
    }
    if r.chance(0.2) {
        let tips: Vec<DVec2> = lines.iter().map(|l| l[l.len() - 1]).collect();
        for tip in tips {
            lines.push(round(tip, DVec2::splat(r.range(0.03, 0.07)), 0, 0.0, r));
        }
    }
    if r.chance(0.2) {
        for s in [-1.0, 1.0] {
            lines.push(soft(&[v(0.0, 0.04), v(s * 0.1, 0.0), v(s * 0.18, -0.04)], r));
        }
    }
    lines
}

/// Draws long twigs that hang down all round.
pub(super) fn willow(r: &mut Stream) -> Lines {
    let (half, top) = (r.range(0.03, 0.09), r.range(0.5, 0.75));
    let mut lines = Vec::from(sides(r, half, top));
    let n = 6 + r.below(10);
    for k in 0..n {
        let x = (k as f64 + r.range(0.2, 0.8)) / n as f64 * 2.0 - 1.0;
        let from = v(0.1 * x, top);
        let out = v(0.45 * x, top + 0.25 * (1.0 - x * x) + 0.05);
        lines.push(soft(&[from, out, out + v(0.06 * x, -0.1), out + v(0.08 * x, -r.range(0.2, 0.6))], r));
    }
    lines
}

/// Draws a crown of a spiral, of loose arcs or of hatching over a trunk.
pub(super) fn loose_tree(r: &mut Stream) -> Lines {
    let (half, top) = (r.range(0.03, 0.1), r.range(0.3, 0.55));
    let mut lines = if r.chance(0.7) {
        Vec::from(sides(r, half, top))
    } else {
        vec![pen(&[v(0.0, 0.0), v(0.0, top)], r)]
    };
    let size = v(r.range(0.25, 0.42), r.range(0.2, 0.35));
    let centre = v(0.0, top + 0.8 * size.y);
    match r.below(4) {
        0 => {
            let turns = r.range(2.0, 5.0);
            let line = (0..=120).map(|k| f64::from(k) / 120.0);
            lines.push(line.map(|t| centre + direction(TAU * turns * t) * size * (0.1 + 0.9 * t)).collect());
        }
        1 => {
            for _ in 0..6 + r.below(8) {
                let a = r.range(0.0, TAU);
                let at = centre + direction(a) * size * r.range(0.4, 0.9);
                lines.push(arc(at, size * 0.35, a - 1.4, a + 1.4, 0, 0.0, r));
            }
        }
        2 => {
            for k in 0..8 + r.below(10) {
                let t = r.range(-0.9, 0.9);
                let h = (1.0 - t * t).sqrt() * size.y;
                let s = if k % 2 == 0 { 1.0 } else { -1.0 };
                let x = centre.x + t * size.x;
                lines.push(pen(&[v(x, centre.y - s * h), v(x + 0.06, centre.y + s * h)], r));
            }
            if r.chance(0.5) {
                lines.push(round(centre, size, 8, 0.12, r));
            }
        }
        _ => {
            lines.push(round(centre, size, 8 * r.below(2), 0.12, r));
            for _ in 0..4 + r.below(6) {
                let at = centre + direction(r.range(0.0, TAU)) * size * r.range(0.0, 0.6);
                lines.push(pen(&[at, at + v(0.08, 0.08)], r));
            }
        }
    }
    lines
}

/// Draws a triangle, a rounded one, or a drop on a trunk.
pub(super) fn pointed_tree(r: &mut Stream) -> Lines {
    let (half, foot) = (r.range(0.02, 0.07), r.range(0.1, 0.3));
    let wide = r.range(0.15, 0.4);
    let mut lines = match r.below(3) {
        0 => Vec::from(sides(r, half, foot)),
        1 => vec![pen(&[v(-half, foot), v(-half, 0.0), v(half, 0.0), v(half, foot)], r)],
        _ => vec![pen(&[v(0.0, foot), v(0.0, 0.0)], r)],
    };
    let corners = [v(0.0, foot), v(-wide, foot), v(0.0, 1.0), v(wide, foot), v(0.0, foot)];
    lines.push(if r.chance(0.6) { pen(&corners, r) } else { soft(&corners, r) });
    if r.chance(0.3) {
        for _ in 0..3 + r.below(5) {
            let y = r.range(foot + 0.05, 0.8);
            let x = wide * (1.0 - y) * r.range(-0.6, 0.6);
            lines.push(soft(&[v(x - 0.05, y + 0.03), v(x, y - 0.02), v(x + 0.05, y + 0.03)], r));
        }
    }
    lines
}

/// Draws a crown as an uneven outline without lobes, and a trunk that continues a little behind it, with limbs in the
/// gaps.
pub(super) fn hidden_trunk(r: &mut Stream) -> Lines {
    let low = r.range(0.05, 0.5);
    let (half, into) = (r.range(0.015, 0.06), low + (1.0 - low) * r.range(0.05, 0.35));
    let size = v(r.range(0.2, 0.5), 0.5 * (1.0 - low));
    let centre = v(r.range(-0.08, 0.08), low + size.y);
    let (lean, waves) = (r.range(-0.06, 0.06), 3 + r.below(6));
    let uneven: Vec<(f64, f64)> =
        (0..waves).map(|k| (r.range(0.0, TAU), r.range(0.0, 0.3) / (1.0 + k as f64))).collect();
    let shoulder = r.range(-0.25, 0.35);
    let n = 24 + r.below(40);
    let from = r.range(0.0, TAU);
    let crown: Vec<DVec2> = (0..=n)
        .map(|k| {
            let way = direction(from + TAU * k as f64 / n as f64);
            let angle = ops::atan2(way.y, way.x);
            let mut reach = 1.0;
            for (wave, (phase, depth)) in (1_u32..).zip(&uneven) {
                reach += depth * ops::sin(f64::from(wave) * angle + phase);
            }
            // Broader below than above, or the reverse.
            let broad = 1.0 - shoulder * way.y;
            centre + way * size * reach.clamp(0.5, 1.4) * v(broad, 1.0)
        })
        .collect();
    let tip = v(lean, into);
    let wood = match r.below(5) {
        0 => pen(&[v(0.0, 0.0), tip], r),
        1 => pen(&[v(-half, 0.0), tip - v(half, 0.0), tip + v(half, 0.0), v(half, 0.0)], r),
        _ => pen(&[tip - v(half, 0.0), v(-1.2 * half, 0.0), v(1.2 * half, 0.0), tip + v(half, 0.0)], r),
    };
    let mut lines = vec![wood];
    for _ in 0..r.below(6) {
        let at = v(lean * 0.9, into * r.range(0.85, 1.0));
        let way = direction(r.range(0.0, PI)) * size * r.range(0.3, 0.9);
        lines.push(soft(&[at, at + way * 0.5 + v(0.0, r.range(-0.05, 0.05)), at + way], r));
    }
    if r.chance(0.6) {
        lines.push(crown);
    } else {
        lines.insert(0, crown);
    }
    lines
}
