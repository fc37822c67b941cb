//! Made drawings of bushes, grasses, leaves, flowers, cacti and plants in pots, in the ways in which people draw them.

use std::f64::consts::{PI, TAU};

use base::{Stream, ops};
use glam::DVec2;

use super::pens::{arc, leafy_blade, pen, round, scribbled, soft, turned, v};
use super::trees::palm;
use super::{Lines, blade, direction, extent, flower, leafy, moved, scribble};

pub(super) fn cloud_bush(r: &mut Stream) -> Lines {
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

pub(super) fn humps(r: &mut Stream) -> Lines {
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

pub(super) fn zigzag_grass(r: &mut Stream) -> Lines {
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

pub(super) fn fan(r: &mut Stream) -> Lines {
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

pub(super) fn leaf(r: &mut Stream) -> Lines {
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

pub(super) fn lobed_leaf(r: &mut Stream) -> Lines {
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

pub(super) fn flower_head(r: &mut Stream) -> Lines {
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

pub(super) fn tulip(r: &mut Stream) -> Lines {
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

pub(super) fn potted(r: &mut Stream) -> Lines {
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

/// Draws a stem and its leaves in one line: round each leaf on the way up, the last at the top or below it.
fn sprout_in_one_go(r: &mut Stream) -> Lines {
    let (top, n) = (v(r.range(-0.15, 0.15), 1.0), 1 + r.below(5));
    let mut line = vec![DVec2::ZERO];
    let mut from = DVec2::ZERO;
    let ends_in_leaf = r.chance(0.3);
    for k in 0..n {
        let last = ends_in_leaf && k + 1 == n;
        let at = if last { top } else { top * ((k as f64 + r.range(0.6, 1.3)) / (n as f64 + 0.6)) };
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let way =
            if last { v(r.range(-0.2, 0.2), 0.4) } else { v(side * r.range(0.2, 0.5), r.range(0.05, 0.4)) };
        line.extend(pen(&[from, at], r));
        line.extend(leafy_blade(at, way, r.range(0.15, 0.3) * way.length(), r));
        from = at;
    }
    if !ends_in_leaf {
        line.extend(pen(&[from, top], r));
    }
    vec![line]
}

pub(super) fn sprout(r: &mut Stream) -> Lines {
    if r.chance(0.3) {
        return sprout_in_one_go(r);
    }
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

/// Draws a body with arms in one outline; or each part in one; with ribs, thorns, a pot.
pub(super) fn saguaro(r: &mut Stream) -> Lines {
    let half = r.range(0.07, 0.16);
    let apart = r.chance(0.5);
    let mut lines = Lines::new();
    let tube = |path: &[DVec2], w: f64, r: &mut Stream| -> Vec<DVec2> {
        let across = |k: usize| {
            let (a, b) = (path[k.saturating_sub(1)], path[(k + 1).min(path.len() - 1)]);
            (b - a).perp().normalize_or_zero() * w
        };
        let mut out: Vec<DVec2> = (0..path.len()).map(|k| path[k] + across(k)).collect();
        let end = path[path.len() - 1];
        let way = (end - path[path.len() - 2]).normalize_or_zero() * w;
        out.push(end + way);
        out.extend((0..path.len()).rev().map(|k| path[k] - across(k)));
        soft(&out, r)
    };
    lines.push(tube(&[v(0.0, 0.0), v(0.0, 0.4), v(0.0, 0.9)], half, r));
    let arms = if apart { 1 + r.below(3) } else { r.below(4) };
    for k in 0..arms {
        let s = if k % 2 == 0 { 1.0 } else { -1.0 };
        let y = r.range(0.25, 0.6);
        let out = s * (half + r.range(0.12, 0.25));
        let up = y + r.range(0.15, 0.4);
        lines.push(tube(
            &[v(s * half, y), v(out, y), v(out, 0.5 * (y + up)), v(out, up)],
            half * r.range(0.5, 0.8),
            r,
        ));
    }
    let thorns = if r.chance(0.6) { 4 + r.below(14) } else { 0 };
    for _ in 0..thorns {
        let at = v(r.range(-1.0, 1.0) * half, r.range(0.05, 0.9));
        let way = direction(r.range(0.0, TAU)) * 0.05;
        lines.push(pen(&[at, at + way], r));
    }
    if r.chance(0.3) {
        for x in [-0.4, 0.0, 0.4] {
            lines.push(pen(&[v(x * half, 0.05), v(x * half, 0.9)], r));
        }
    }
    foot_of(r, &mut lines, half);
    lines
}

/// Draws a pot, a ground, or nothing.
fn foot_of(r: &mut Stream, lines: &mut Lines, half: f64) {
    match r.below(4) {
        0 => {
            let top = half * r.range(1.2, 2.0);
            lines.push(pen(
                &[v(-top, 0.02), v(-0.7 * top, -0.3), v(0.7 * top, -0.3), v(top, 0.02), v(-top, 0.02)],
                r,
            ));
        }
        1 => lines.push(pen(&[v(-0.4, 0.0), v(0.4, r.range(-0.02, 0.02))], r)),
        _ => {}
    }
}

/// Draws a round body with ribs or thorns; pads upon pads.
pub(super) fn round_cactus(r: &mut Stream) -> Lines {
    let mut lines = Lines::new();
    if r.chance(0.5) {
        let size = v(r.range(0.25, 0.4), r.range(0.28, 0.45));
        lines.push(round(v(0.0, 0.9 * size.y), size, 0, 0.0, r));
        for k in 0..2 + r.below(3) {
            let x = size.x * (0.5 * k as f64 - 0.5);
            lines.push(soft(&[v(0.3 * x, 1.85 * size.y), v(x, size.y), v(0.3 * x, 0.0)], r));
        }
        foot_of(r, &mut lines, size.x);
    } else {
        let mut tops = vec![(DVec2::ZERO, 0.5 * PI)];
        for _ in 0..2 + r.below(5) {
            let (at, a) = tops[r.below(tops.len())];
            let a = if lines.is_empty() { a } else { a + r.range(-0.9, 0.9) };
            let long = r.range(0.3, 0.45);
            let half = long * r.range(0.28, 0.4);
            lines.push(blade(r, at, direction(a) * long, half));
            tops.push((at + direction(a) * long * 0.95, a));
        }
        foot_of(r, &mut lines, 0.1);
    }
    let (lo, hi) = extent(&lines);
    for _ in 0..r.below(14) {
        let at = lo + (hi - lo) * v(r.range(0.25, 0.75), r.range(0.2, 0.9));
        let way = direction(r.range(0.0, TAU)) * 0.05;
        lines.push(pen(&[at, at + way], r));
    }
    lines
}

/// Draws an open bell and its rim.
fn bell(r: &mut Stream, centre: DVec2, size: f64) -> Lines {
    let mut head = Lines::new();
    let half = size * r.range(0.7, 1.0);
    head.push(soft(
        &[
            centre + v(-half, size),
            centre + v(-0.8 * half, -0.3 * size),
            centre + v(0.0, -size),
            centre + v(0.8 * half, -0.3 * size),
            centre + v(half, size),
        ],
        r,
    ));
    head.push(soft(
        &[
            centre + v(-half, size),
            centre + v(-0.3 * half, 0.5 * size),
            centre + v(0.0, size),
            centre + v(0.3 * half, 0.5 * size),
            centre + v(half, size),
        ],
        r,
    ));
    head
}

/// Draws a head of open arcs, of lines or of a spiral on a stem.
pub(super) fn other_flower(r: &mut Stream) -> Lines {
    let centre = v(r.range(-0.08, 0.08), r.range(0.7, 1.0));
    let n = 5 + r.below(8);
    let (disc, size) = (r.range(0.05, 0.12), r.range(0.14, 0.26));
    let mut head = Lines::new();
    let around = |k: usize| direction(TAU * k as f64 / n as f64);
    match r.below(6) {
        0 => {
            head.push(round(centre, DVec2::splat(disc), 0, 0.0, r));
            for k in 0..n {
                let (a, b) = (around(k), around(k + 1));
                let out = (a + b).normalize_or_zero() * (disc + size);
                head.push(soft(
                    &[
                        centre + a * disc,
                        centre + a * disc + out * 0.6,
                        centre + out * 1.1,
                        centre + b * disc + out * 0.6,
                        centre + b * disc,
                    ],
                    r,
                ));
            }
        }
        1 => {
            head.push(round(centre, DVec2::splat(disc), 0, 0.0, r));
            for k in 0..2 * n {
                let way = direction(TAU * k as f64 / (2 * n) as f64);
                head.push(pen(&[centre + way * disc, centre + way * (disc + size)], r));
            }
        }
        2 => {
            let turns = r.range(2.0, 4.0);
            let line = (0..=80).map(|k| f64::from(k) / 80.0);
            head.push(line.map(|t| centre + direction(TAU * turns * t) * (0.03 + size * t)).collect());
            if r.chance(0.5) {
                head.push(round(centre, DVec2::splat(size + 0.05), n, 0.2, r));
            }
        }
        3 => {
            // Loops in one stroke.
            let loops = f64::from(u32::try_from(n).unwrap_or(5));
            let line = (0..=160).map(|k| f64::from(k) / 160.0);
            head.push(
                line.map(|t| {
                    let s = ops::sin(PI * loops * t);
                    centre + direction(TAU * t + 0.25 * ops::sin(TAU * loops * t)) * (disc + size * s * s)
                })
                .collect(),
            );
            if r.chance(0.7) {
                head.push(round(centre, DVec2::splat(disc), 0, 0.0, r));
            }
        }
        4 => {
            head.extend(bell(r, centre, size));
        }
        _ => {
            head.push(round(centre, DVec2::splat(disc + size), n, 0.3, r));
            head.push(round(centre, DVec2::splat(disc * 1.2), 0, 0.0, r));
            for _ in 0..4 {
                let s = r.range(-0.8, 0.8) * disc;
                head.push(pen(&[centre + v(s, -disc), centre + v(s + 0.02, disc)], r));
            }
        }
    }
    let stem = soft(
        &[centre - v(0.0, disc + 0.8 * size), v(0.5 * centre.x + r.range(-0.06, 0.06), 0.4), DVec2::ZERO],
        r,
    );
    let mut lines = if r.chance(0.5) { [vec![stem], head].concat() } else { [head, vec![stem]].concat() };
    for k in 0..r.below(4) {
        let s = if k % 2 == 0 { 1.0 } else { -1.0 };
        let way = v(s * r.range(0.12, 0.3), r.range(0.05, 0.25));
        let at = v(0.0, r.range(0.1, 0.4));
        lines.push(if r.chance(0.7) {
            blade(r, at, way, 0.22 * way.length())
        } else {
            soft(&[at, at + way * 0.6, at + way], r)
        });
    }
    lines
}

/// Draws flowers in a vase; blades in a pot.
pub(super) fn vase(r: &mut Stream) -> Lines {
    let (neck, belly, tall) = (r.range(0.08, 0.2), r.range(0.15, 0.3), r.range(0.35, 0.6));
    let mut lines = match r.below(2) {
        0 => vec![soft(
            &[
                v(-neck, 0.0),
                v(-neck, -0.2 * tall),
                v(-belly, -0.6 * tall),
                v(-0.6 * belly, -tall),
                v(0.6 * belly, -tall),
                v(belly, -0.6 * tall),
                v(neck, -0.2 * tall),
                v(neck, 0.0),
                v(-neck, 0.0),
            ],
            r,
        )],
        _ => vec![
            pen(&[v(-belly, 0.0), v(belly, 0.0)], r),
            pen(&[v(-belly, 0.0), v(-0.7 * belly, -tall), v(0.7 * belly, -tall), v(belly, 0.0)], r),
        ],
    };
    let n = 2 + r.below(5);
    let what = r.below(4);
    for k in 0..n {
        let t = (k as f64 + 0.5) / n as f64 - 0.5;
        let tip = v(t * r.range(0.6, 1.4), r.range(0.4, 0.75));
        let at = v(t * neck, 0.0);
        match what {
            0 => lines.push(blade(r, at, tip - at, 0.13 * tip.length())),
            1 => lines.push(soft(&[at, v(0.4 * tip.x, 0.6 * tip.y), tip], r)),
            2 => {
                lines.push(soft(&[at, v(0.4 * tip.x, 0.6 * tip.y), tip], r));
                lines.push(round(tip + v(0.0, 0.06), DVec2::splat(0.09), 5 * r.below(2), 0.35, r));
                lines.push(round(tip + v(0.0, 0.06), DVec2::splat(0.03), 0, 0.0, r));
            }
            _ => {
                lines.push(soft(&[at, v(0.4 * tip.x, 0.6 * tip.y), tip], r));
                let way = direction(0.5 * PI - 2.0 * t) * 0.22;
                lines.push(blade(r, tip, way, 0.08));
            }
        }
    }
    lines
}

/// Draws tufts in one stroke, or blades that bend.
pub(super) fn tufts(r: &mut Stream) -> Lines {
    let n = 1 + r.below(3);
    let mut lines = Lines::new();
    for k in 0..n {
        let x = 0.5 * k as f64;
        let blades = 2 + r.below(5);
        let mut corners = vec![v(x, 0.0)];
        for i in 0..blades {
            let t = (i as f64 + 0.5) / blades as f64;
            corners.push(v(x + 0.3 * t + (t - 0.5) * r.range(0.0, 0.3), r.range(0.25, 0.6)));
            corners.push(v(x + 0.3 * (i as f64 + 1.0) / blades as f64, r.range(0.0, 0.06)));
        }
        lines.push(if r.chance(0.3) { soft(&corners, r) } else { pen(&corners, r) });
    }
    if r.chance(0.3) {
        lines.push(pen(&[v(-0.1, 0.0), v(0.5 * n as f64, 0.0)], r));
    }
    lines
}

/// Draws a heart, a drop, or a leaf in one stroke with its stalk and its rib.
pub(super) fn other_leaf(r: &mut Stream) -> Lines {
    let half = r.range(0.22, 0.45);
    let mut lines = match r.below(3) {
        0 => vec![soft(
            &[
                v(0.0, 0.1),
                v(-0.25, 0.0),
                v(-half, 0.25),
                v(-0.6 * half, 0.65),
                v(0.0, 1.0),
                v(0.6 * half, 0.65),
                v(half, 0.25),
                v(0.25, 0.0),
                v(0.0, 0.1),
            ],
            r,
        )],
        1 => {
            let mut line = soft(
                &[
                    v(0.0, -0.3),
                    v(0.0, 0.0),
                    v(-half, 0.3),
                    v(-half, 0.7),
                    v(0.0, 1.0),
                    v(half, 0.7),
                    v(half, 0.3),
                    v(0.0, 0.0),
                ],
                r,
            );
            if r.chance(0.5) {
                line.extend(pen(&[v(0.0, 0.0), v(0.0, 0.85)], r));
            }
            vec![line]
        }
        _ => {
            let teeth = 4 + r.below(5);
            let side = |s: f64, r: &mut Stream| {
                let mut corners = vec![v(0.0, 0.0)];
                for k in 0..teeth {
                    let t = (k as f64 + 0.6) / (teeth as f64 + 0.6);
                    let w = half * (4.0 * t * (1.0 - t)).max(0.0).sqrt();
                    corners.push(v(s * w, t));
                    corners.push(v(s * 0.8 * w, t + 0.02));
                }
                corners.push(v(0.0, 1.0));
                pen(&corners, r)
            };
            vec![side(-1.0, r), side(1.0, r)]
        }
    };
    if r.chance(0.7) {
        lines.push(pen(&[v(0.0, -r.range(0.0, 0.3)), v(0.0, r.range(0.6, 0.95))], r));
    }
    for k in 0..r.below(5) {
        let y = 0.2 + 0.14 * k as f64;
        for s in [-1.0, 1.0] {
            lines.push(pen(&[v(0.0, y), v(s * 0.6 * half, y + 0.15)], r));
        }
    }
    turned(r, lines, PI)
}

/// Draws a bush of a scribble, of arcs, or of leaves.
pub(super) fn other_bush(r: &mut Stream) -> Lines {
    let size = v(r.range(0.4, 0.6), r.range(0.22, 0.38));
    let mut lines = match r.below(3) {
        0 => vec![scribble(r, v(0.0, size.y), size)],
        1 => (0..4 + r.below(4))
            .map(|k| {
                let at = v(-0.5 + 0.22 * k as f64, r.range(0.08, 0.35));
                let from = r.range(-0.4, 0.2);
                arc(at, DVec2::splat(r.range(0.14, 0.22)), from, from + r.range(2.8, 4.2), 0, 0.0, r)
            })
            .collect(),
        _ => {
            let mut lines = vec![round(v(0.0, size.y), size, 9 + r.below(6), 0.18, r)];
            for _ in 0..r.below(7) {
                let at = v(r.range(-0.6, 0.6) * size.x, size.y * r.range(0.5, 1.5));
                lines.push(round(at, DVec2::splat(0.04), 0, 0.0, r));
            }
            lines
        }
    };
    if r.chance(0.3) {
        for x in [-0.05, 0.05] {
            lines.push(pen(&[v(x, 0.05), v(x, -0.08)], r));
        }
    }
    if r.chance(0.3) {
        lines.push(pen(&[v(-0.7, 0.0), v(0.7, r.range(-0.02, 0.02))], r));
    }
    lines
}

/// Draws a frond, a vine, a stem with leaves in pairs or of lines.
pub(super) fn other_stem(r: &mut Stream) -> Lines {
    let tip = v(r.range(-0.3, 0.3), 1.0);
    let bend = v(r.range(-0.25, 0.25), 0.5);
    let mut lines = vec![soft(&[DVec2::ZERO, bend, tip], r)];
    let n = 3 + r.below(6);
    let (pairs, what) = (r.chance(0.6), r.below(3));
    for k in 0..n {
        let t = 0.15 + 0.8 * k as f64 / n as f64;
        let at = DVec2::ZERO.lerp(bend, t).lerp(bend.lerp(tip, t), t);
        for s in [-1.0, 1.0] {
            if !pairs && (k % 2 == 0) == (s > 0.0) {
                continue;
            }
            let way = v(s * r.range(0.15, 0.3), r.range(0.02, 0.2)) * (1.2 - 0.6 * t);
            lines.push(match what {
                0 => {
                    let half = way.length() * r.range(0.15, 0.3);
                    blade(r, at, way, half)
                }
                1 => {
                    soft(&[at, at + way * 0.5 + v(0.0, 0.06), at + way, at + way * 0.5 - v(0.0, 0.04), at], r)
                }
                _ => {
                    let mut line = pen(&[at, at + way * 0.3], r);
                    line.extend(blade(r, at + way * 0.3, way * 0.7, way.length() * 0.15));
                    line
                }
            });
        }
    }
    lines
}

/// Draws a cup with points above, and leaves as tall as the stem.
pub(super) fn tall_tulip(r: &mut Stream) -> Lines {
    let (half, low) = (r.range(0.1, 0.2), r.range(0.6, 0.72));
    let points = 2 + r.below(3);
    let tip = |k: usize| v(half * (2.0 * k as f64 / (points - 1) as f64 - 1.0), r.range(0.94, 1.0));
    let tips: Vec<DVec2> = (0..points).map(tip).collect();
    let mut rim = vec![tips[0]];
    for w in tips.windows(2) {
        rim.extend([w[0].midpoint(w[1]) - v(0.0, r.range(0.07, 0.16)), w[1]]);
    }
    let cup =
        [v(1.05 * half, low + 0.12), v(0.5 * half, low), v(-0.5 * half, low), v(-1.05 * half, low + 0.12)];
    let mut lines = match r.below(3) {
        0 => {
            let outline: Vec<DVec2> = rim.iter().copied().chain(cup).chain([rim[0]]).collect();
            vec![pen(&outline, r)]
        }
        1 => {
            let round: Vec<DVec2> = [tips[points - 1]].into_iter().chain(cup).chain([tips[0]]).collect();
            vec![soft(&round, r), pen(&rim, r)]
        }
        _ => {
            let outline: Vec<DVec2> = rim.iter().copied().chain(cup).chain([rim[0]]).collect();
            vec![soft(&outline, r)]
        }
    };
    let stem = pen(&[v(0.0, low), v(r.range(-0.05, 0.05), 0.0)], r);
    if r.chance(0.5) {
        lines.insert(0, stem)
    } else {
        lines.push(stem)
    }
    for s in [-1.0, 1.0] {
        if r.chance(0.85) {
            let way = v(s * r.range(0.08, 0.3), r.range(0.3, 0.65));
            lines.push(leafy_blade(v(0.0, r.range(0.0, 0.12)), way, r.range(0.03, 0.08), r));
        }
    }
    lines
}

/// Draws several flowers of petals or cups in one vase, their heads close together.
pub(super) fn bouquet(r: &mut Stream) -> Lines {
    let (neck, belly, tall) = (r.range(0.07, 0.18), r.range(0.15, 0.3), r.range(0.3, 0.6));
    let half = [v(-neck, 0.0), v(-r.range(0.6, 1.0) * neck, -0.2 * tall), v(-belly, -0.6 * tall)];
    let foot = v(-r.range(0.5, 0.9) * belly, -tall);
    let mut corners: Vec<DVec2> = half.into_iter().chain([foot]).collect();
    let right: Vec<DVec2> = corners.iter().rev().map(|p| v(-p.x, p.y)).collect();
    corners.extend(right);
    corners.push(corners[0]);
    let mut lines = vec![if r.chance(0.5) { soft(&corners, r) } else { pen(&corners, r) }];
    let n = 2 + r.below(5);
    for k in 0..n {
        let t = (k as f64 + 0.5) / n as f64 - 0.5;
        let head = if r.chance(0.7) { flower(r).0 } else { tall_tulip(r) };
        let (scale, turn) = (r.range(0.6, 1.0), -1.3 * t + r.range(-0.1, 0.1));
        let (s, c) = ops::sin_cos(turn);
        lines.extend(head.into_iter().map(|line| {
            line.into_iter()
                .map(|p| v(p.x * c - p.y * s, p.x * s + p.y * c) * scale + v(1.2 * t * neck, 0.0))
                .collect()
        }));
    }
    lines
}
