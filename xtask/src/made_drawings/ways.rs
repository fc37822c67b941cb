//! More ways to draw plants: those that people take when they draw few lines, one line, or another form than most.

use std::f64::consts::{PI, TAU};

use base::{Stream, ops};
use glam::DVec2;

use super::kinds::{arc, branches, pen, round, sides, soft, tuft, turned, v};
use super::{Lines, blade, direction, extent, moved, scribble};

/// Spears: a long body with scales and a head of buds; one, or some side by side, with or without a band.
pub(super) fn spears(r: &mut Stream) -> Lines {
    let n = if r.chance(0.5) { 1 } else { 2 + r.below(4) };
    let head = r.below(4);
    let mut lines = Lines::new();
    for k in 0..n {
        let half = r.range(0.03, 0.09);
        let neck = r.range(0.6, 0.78);
        let sides = [
            pen(&[v(-half, neck), v(-half * r.range(0.7, 1.1), 0.0)], r),
            pen(&[v(half, neck), v(half * r.range(0.7, 1.1), 0.0)], r),
        ];
        let wide = half * r.range(1.0, 1.8);
        let mut own = Lines::new();
        let top = match head {
            0 => soft(
                &[v(-half, neck), v(-wide, neck + 0.1), v(0.0, 1.0), v(wide, neck + 0.1), v(half, neck)],
                r,
            ),
            1 => pen(
                &[v(-half, neck), v(-wide, neck + 0.08), v(0.0, 1.0), v(wide, neck + 0.08), v(half, neck)],
                r,
            ),
            2 => {
                let m = 3 + r.below(4);
                let mut corners = vec![v(-half, neck)];
                for i in 0..m {
                    let t = (i as f64 + 0.5) / m as f64;
                    let y = neck + (1.0 - neck) * (1.0 - (2.0 * t - 1.0).abs());
                    corners.push(v((2.0 * t - 1.0) * wide * 1.3, y));
                    corners.push(v((2.0 * t - 1.0) * wide * 0.8, y - 0.02));
                }
                corners.push(v(half, neck));
                pen(&corners, r)
            }
            _ => round(v(0.0, 0.5 * (1.0 + neck)), v(wide, 0.5 * (1.0 - neck)), 7 * r.below(2), 0.15, r),
        };
        if r.chance(0.5) {
            let [mut a, b] = sides;
            a.reverse();
            own.push([a, top, b].concat());
        } else {
            own.push(top);
            own.extend(sides);
        }
        if r.chance(0.6) {
            own.push(pen(&[v(-half, 0.0), v(half, 0.0)], r));
        }
        for i in 0..r.below(7) {
            let (s, y) = (if i % 2 == 0 { 1.0 } else { -1.0 }, r.range(0.1, 0.95));
            own.push(pen(&[v(s * 0.9 * half, y), v(s * 0.3 * half, y + r.range(0.03, 0.1)), v(0.0, y)], r));
        }
        let own = turned(r, own, 0.12);
        lines.extend(moved(own, r.range(0.85, 1.1), v(0.17 * k as f64, 0.0)));
    }
    if n > 1 && r.chance(0.6) {
        let wide = 0.17 * n as f64;
        let y = r.range(0.3, 0.45);
        lines.push(pen(&[v(-0.1, y), v(wide - 0.07, y)], r));
        lines.push(pen(&[v(-0.1, y - 0.08), v(wide - 0.07, y - 0.08)], r));
    }
    turned(r, lines, 1.2)
}

/// A bent body, long and thin.
pub(super) fn bean(r: &mut Stream) -> Lines {
    let n = 1 + if r.chance(0.3) { r.below(3) } else { 0 };
    let mut lines = Lines::new();
    for k in 0..n {
        let (half, bow) = (r.range(0.03, 0.08), r.range(0.05, 0.35));
        let knots = if r.chance(0.5) { 4.0 + r.below(4) as f64 } else { 0.0 };
        let at = |t: f64, s: f64| {
            let thick = half
                * ops::powf((4.0 * t * (1.0 - t)).max(0.0), 0.3)
                * (1.0 + 0.2 * ops::sin(knots * PI * t).abs());
            v(t, bow * (4.0 * t * (1.0 - t)) + s * thick)
        };
        let side = |s: f64, r: &mut Stream| {
            let corners: Vec<DVec2> = (0..=14).map(|i| at(f64::from(i) / 14.0, s)).collect();
            soft(&corners, r)
        };
        let (a, mut b) = (side(1.0, r), side(-1.0, r));
        let mut own = if r.chance(0.6) {
            b.reverse();
            vec![[a, b].concat()]
        } else {
            vec![a, b]
        };
        for i in 0..if r.chance(0.4) { 2 + r.below(4) } else { 0 } {
            let t = 0.15 + 0.14 * i as f64;
            own.push(round(at(t, 0.0), DVec2::splat(0.6 * half), 0, 0.0, r));
        }
        if r.chance(0.6) {
            own.push(pen(&[v(1.0, 0.0), v(1.0 + r.range(0.04, 0.12), r.range(-0.06, 0.1))], r));
        }
        lines.extend(moved(turned(r, own, 0.4), 1.0, v(0.0, 0.28 * k as f64)));
    }
    turned(r, lines, PI)
}

/// An open pod: two arcs and peas between them; or peas alone.
pub(super) fn open_pod(r: &mut Stream) -> Lines {
    let (up, down, n) = (r.range(0.08, 0.25), r.range(0.08, 0.25), 2 + r.below(6));
    let mut lines = Lines::new();
    if r.chance(0.85) {
        lines.push(soft(&[v(0.0, 0.0), v(0.25, up), v(0.75, up), v(1.0, 0.0)], r));
        lines.push(soft(&[v(0.0, 0.0), v(0.25, -down), v(0.75, -down), v(1.0, 0.0)], r));
        if r.chance(0.3) {
            lines.push(soft(&[v(0.0, 0.0), v(0.3, -0.3 * down), v(0.7, -0.3 * down), v(1.0, 0.0)], r));
        }
    }
    for k in 0..n {
        let t = (k as f64 + 0.5) / n as f64;
        let own = DVec2::splat((0.42 / n as f64).min(0.14) * r.range(0.8, 1.1));
        lines.push(round(v(0.1 + 0.8 * t, r.range(-0.03, 0.03)), own, 0, 0.0, r));
    }
    if r.chance(0.4) {
        lines.push(soft(&[v(1.0, 0.0), v(1.1, 0.03), v(1.15, r.range(-0.1, 0.15))], r));
    }
    if r.chance(0.2) {
        lines.push(tendril(r, v(0.0, 0.0)));
    }
    turned(r, lines, PI)
}

fn tendril(r: &mut Stream, at: DVec2) -> Vec<DVec2> {
    let turns = r.range(1.0, 2.5);
    (0..40)
        .map(|k| f64::from(k) / 40.0)
        .map(|t| at + v(-0.15 * t, 0.05 * t) + direction(TAU * turns * t) * (0.05 * t))
        .collect()
}

/// Round berries, each with a small star or ring: one, or some that touch.
pub(super) fn round_berries(r: &mut Stream) -> Lines {
    let n = 1 + r.below(5);
    let mut lines = Lines::new();
    let mark = r.below(4);
    for k in 0..n {
        let around = direction(TAU * k as f64 / n as f64 + r.range(0.0, 0.5));
        let centre = if n == 1 { DVec2::ZERO } else { around * (0.18 * n as f64).min(0.5) };
        let size = r.range(0.22, 0.32);
        lines.push(round(centre, DVec2::splat(size), 0, 0.0, r));
        let at = centre + direction(r.range(0.0, TAU)) * (size * r.range(0.0, 0.6));
        match mark {
            0 => lines.push(round(at, DVec2::splat(0.3 * size), 5, 0.5, r)),
            1 => {
                for i in 0..5 {
                    let way = direction(TAU * f64::from(i) / 5.0) * (0.3 * size);
                    lines.push(pen(&[at, at + way], r));
                }
            }
            2 => lines.push(round(at, DVec2::splat(0.25 * size), 0, 0.0, r)),
            _ => {}
        }
    }
    if r.chance(0.35) {
        let top = extent(&lines).1.y;
        lines.push(blade(r, v(0.0, top - 0.05), v(0.3, 0.15), 0.1));
    }
    if r.chance(0.3) {
        let top = extent(&lines).1.y;
        lines.push(pen(&[v(0.0, top - 0.05), v(r.range(-0.1, 0.1), top + 0.2)], r));
    }
    lines
}

/// Berries hang from a stalk each, as cherries.
pub(super) fn hanging(r: &mut Stream) -> Lines {
    let n = 2 + r.below(2);
    let mut lines = Lines::new();
    let top = v(r.range(-0.1, 0.1), 0.6);
    for k in 0..n {
        let at = v(0.5 * (k as f64 - 0.5 * (n - 1) as f64), r.range(-0.1, 0.1));
        let size = r.range(0.16, 0.24);
        lines.push(round(at, DVec2::splat(size), 0, 0.0, r));
        lines.push(soft(&[at + v(0.0, 0.9 * size), at.lerp(top, 0.6) + v(0.05, 0.0), top], r));
    }
    if r.chance(0.6) {
        let way = v(0.35, r.range(-0.05, 0.2));
        lines.push(blade(r, top, way, 0.1));
    }
    lines
}

/// A berry of bumps: the outline alone, or with arcs inside.
pub(super) fn bumpy_berry(r: &mut Stream) -> Lines {
    let size = v(r.range(0.25, 0.38), r.range(0.3, 0.45));
    let bumps = 9 + r.below(8);
    let mut lines = vec![round(DVec2::ZERO, size, bumps, r.range(0.1, 0.2), r)];
    let n = r.below(18);
    let full = r.chance(0.5);
    for _ in 0..n {
        let at = direction(r.range(0.0, TAU)) * size * r.range(0.0, 0.8);
        let to = if full { TAU } else { PI * r.range(0.8, 1.4) };
        let from = r.range(0.0, TAU);
        lines.push(arc(at, DVec2::splat(r.range(0.04, 0.08)), from, from + to, 0, 0.0, r));
    }
    if r.chance(0.7) {
        let green = r.range(0.12, 0.25);
        lines.extend(tuft(r, v(0.0, size.y), green));
    }
    if r.chance(0.5) {
        lines.push(pen(&[v(0.0, size.y), v(r.range(-0.05, 0.05), size.y + r.range(0.15, 0.3))], r));
    }
    lines
}

/// A round root with a tail, and leaves.
pub(super) fn round_root(r: &mut Stream) -> Lines {
    let size = v(r.range(0.2, 0.32), r.range(0.2, 0.3));
    let mut lines = vec![round(v(0.0, 0.0), size, 0, 0.0, r)];
    lines.push(soft(&[v(0.0, -0.95 * size.y), v(0.03, -1.3 * size.y), v(-0.04, -1.8 * size.y)], r));
    for _ in 0..2 + r.below(3) {
        let way = direction(0.5 * PI + r.range(-0.6, 0.6)) * r.range(0.3, 0.6);
        lines.push(blade(r, v(0.0, 0.95 * size.y), way, way.length() * 0.18));
    }
    lines
}

/// A gourd with ribs.
pub(super) fn ribbed(r: &mut Stream) -> Lines {
    let size = v(r.range(0.45, 0.6), r.range(0.35, 0.45));
    let mut lines = vec![round(DVec2::ZERO, size, if r.chance(0.4) { 6 } else { 0 }, 0.08, r)];
    let n = 1 + r.below(3);
    for k in 0..n {
        let x = size.x * (k as f64 + 1.0) / (n as f64 + 1.0);
        for s in [-1.0, 1.0] {
            lines.push(soft(
                &[
                    v(0.0, 0.95 * size.y),
                    v(s * x, 0.4 * size.y),
                    v(s * x, -0.4 * size.y),
                    v(0.0, -0.95 * size.y),
                ],
                r,
            ));
        }
    }
    if r.chance(0.8) {
        lines.push(pen(
            &[v(-0.04, size.y), v(-0.03, size.y + 0.12), v(0.05, size.y + 0.12), v(0.04, size.y)],
            r,
        ));
    }
    turned(r, lines, 0.2)
}

/// A body with nothing but its outline, of any length.
pub(super) fn bare_body(r: &mut Stream) -> Lines {
    let size = v(0.5, r.range(0.14, 0.42));
    let mut lines = vec![arc(DVec2::ZERO, size, 0.0, TAU * r.range(0.95, 1.05), 0, 0.0, r)];
    if r.chance(0.3) {
        lines.push(pen(&[v(0.5, 0.0), v(0.6, r.range(-0.05, 0.05))], r));
    }
    turned(r, lines, PI)
}

/// A root in one line, with or without green: wide at one end, pointed at the other.
pub(super) fn pointed_root(r: &mut Stream) -> Lines {
    let (half, tall) = (r.range(0.1, 0.24), r.range(0.7, 1.0));
    let body = if r.chance(0.5) {
        pen(&[v(-half, tall), v(0.0, 0.0), v(half, tall), v(0.0, tall + 0.03), v(-half, tall)], r)
    } else {
        soft(
            &[
                v(-0.7 * half, tall),
                v(-half, 0.8 * tall),
                v(0.0, 0.0),
                v(half, 0.8 * tall),
                v(0.7 * half, tall),
                v(0.0, tall + 0.02),
                v(-0.7 * half, tall),
            ],
            r,
        )
    };
    let mut lines = vec![body];
    if r.chance(0.8) {
        let green = r.range(0.15, 0.5);
        lines.extend(tuft(r, v(0.0, tall), green));
    }
    for _ in 0..r.below(5) {
        let y = r.range(0.2, 0.9) * tall;
        let x = half * y / tall * r.range(-0.9, 0.2);
        lines.push(pen(&[v(x, y), v(x + 0.5 * half, y + r.range(-0.02, 0.02))], r));
    }
    turned(r, lines, 1.8)
}

/// Where fronds hang from, and the trunk below.
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

/// Fronds in one stroke, there and back again and again; or with teeth.
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

/// A trunk and two to five branches, with few twigs.
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

/// Long twigs hang down all round.
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

/// A crown of a spiral, of loose arcs or of hatching over a trunk.
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

/// A triangle, a rounded one, or a drop on a trunk.
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

/// A body with arms in one outline; or each part in one; with ribs, thorns, a pot.
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

/// A pot, a ground, or nothing.
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

/// A round body with ribs or thorns; pads upon pads.
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

/// An open bell and its rim.
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

/// A head of open arcs, of lines or of a spiral on a stem.
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

/// Flowers in a vase; blades in a pot.
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

/// Tufts in one stroke, or blades that bend.
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

/// A heart, a drop, or a leaf in one go with its stalk and its rib.
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

/// A bush of a scribble, of arcs, or of leaves.
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

/// A frond, a vine, a stem with leaves in pairs or of lines.
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

/// Caps with gills, with a ring, two beside one another.
pub(super) fn other_mushroom(r: &mut Stream) -> Lines {
    let mut lines = Lines::new();
    for k in 0..1 + r.below(2) {
        let (half, low, stem) = (r.range(0.25, 0.5), r.range(0.4, 0.7), r.range(0.05, 0.14));
        let top = low + r.range(0.2, 0.5);
        let mut own = match r.below(3) {
            0 => vec![
                soft(&[v(-half, low), v(-0.8 * half, top), v(0.8 * half, top), v(half, low)], r),
                soft(&[v(-half, low), v(0.0, low - 0.1), v(half, low)], r),
            ],
            1 => vec![pen(&[v(-half, low), v(0.0, top + 0.1), v(half, low), v(-half, low)], r)],
            _ => vec![round(v(0.0, low), v(half, 0.6 * (top - low)), 0, 0.0, r)],
        };
        own.push(soft(
            &[
                v(-stem, low - 0.02),
                v(-0.9 * stem, 0.2),
                v(-1.3 * stem, 0.0),
                v(1.3 * stem, 0.0),
                v(0.9 * stem, 0.2),
                v(stem, low - 0.02),
            ],
            r,
        ));
        if r.chance(0.3) {
            for i in 0..5 {
                let x = half * (f64::from(i) - 2.0) * 0.35;
                own.push(pen(&[v(x, low), v(0.6 * x, low - 0.08)], r));
            }
        }
        lines.extend(moved(own, if k == 0 { 1.0 } else { r.range(0.4, 0.8) }, v(0.7 * k as f64, 0.0)));
    }
    lines
}

/// Two or four wings on a body, with or without feelers.
pub(super) fn butterfly(r: &mut Stream) -> Lines {
    let mut lines = Lines::new();
    let (tall, wide) = (r.range(0.25, 0.45), r.range(0.3, 0.5));
    let one = r.chance(0.3);
    for s in [-1.0, 1.0] {
        let upper = v(s * wide, r.range(0.25, 0.5));
        let lower = v(s * 0.7 * wide, -r.range(0.2, 0.45));
        if one {
            lines.push(soft(
                &[v(0.0, 0.1), upper, v(s * 1.1 * wide, 0.0), v(s * 0.3 * wide, 0.0), lower, v(0.0, -0.1)],
                r,
            ));
        } else {
            let (a, b) = (r.range(0.1, 0.2), r.range(0.08, 0.18));
            lines.push(blade(r, v(0.0, 0.08), upper, a));
            lines.push(blade(r, v(0.0, -0.05), lower, b));
        }
        if r.chance(0.5) {
            lines.push(soft(&[v(0.0, 0.5 * tall), v(s * 0.08, tall * 0.9), v(s * 0.14, tall)], r));
        }
        if r.chance(0.3) {
            lines.push(round(upper * 0.6, DVec2::splat(0.05), 0, 0.0, r));
        }
    }
    lines.push(if r.chance(0.5) {
        pen(&[v(0.0, 0.5 * tall), v(0.0, -0.5 * tall)], r)
    } else {
        round(DVec2::ZERO, v(0.05, 0.5 * tall), 0, 0.0, r)
    });
    turned(r, lines, 0.7)
}

/// One or some birds far away.
pub(super) fn birds(r: &mut Stream) -> Lines {
    (0..1 + r.below(4))
        .map(|k| {
            let (at, w) = (v(0.6 * k as f64, r.range(-0.3, 0.3)), r.range(0.15, 0.25));
            let up = w * r.range(0.3, 0.9);
            let corners = [
                at + v(-w, 0.2 * up),
                at + v(-0.6 * w, up),
                at,
                at,
                at + v(0.6 * w, up),
                at + v(w, 0.2 * up),
            ];
            if r.chance(0.7) { soft(&corners, r) } else { pen(&[corners[1], at, corners[4]], r) }
        })
        .collect()
}

/// A quarter of a sun, in the corner of the sheet.
pub(super) fn corner_sun(r: &mut Stream) -> Lines {
    let size = r.range(0.3, 0.5);
    let s = if r.chance(0.5) { 1.0 } else { -1.0 };
    let mut lines = vec![arc(DVec2::ZERO, v(s * size, size), PI, 1.5 * PI, 0, 0.0, r)];
    let n = 3 + r.below(5);
    for k in 0..n {
        let a = PI * (1.0 + 0.5 * (k as f64 + 0.5) / n as f64);
        let way = direction(a) * v(s, 1.0);
        let (from, to) = (size + r.range(0.03, 0.1), size + r.range(0.2, 0.45));
        lines.push(pen(&[way * from, way * to], r));
    }
    lines
}

/// A word in one stroke or in some, as a name under a picture.
pub(super) fn written(r: &mut Stream) -> Lines {
    let mut lines = Lines::new();
    let mut line = vec![v(0.0, 0.1)];
    let n = 4 + r.below(7);
    for k in 0..n {
        let x = 0.3 * k as f64;
        let tall = if r.chance(0.25) { 0.75 } else { 0.35 };
        match r.below(4) {
            0 => line.extend([v(x + 0.05, tall), v(x + 0.12, 0.0), v(x + 0.2, 0.32), v(x + 0.28, 0.0)]),
            1 => line.extend([
                v(x + 0.22, 0.3),
                v(x + 0.08, 0.34),
                v(x + 0.03, 0.05),
                v(x + 0.2, 0.02),
                v(x + 0.24, 0.3),
                v(x + 0.28, 0.0),
            ]),
            2 => line.extend([v(x + 0.18, tall), v(x + 0.1, tall), v(x + 0.12, 0.0), v(x + 0.28, 0.05)]),
            _ => line.extend([
                v(x + 0.06, 0.3),
                v(x + 0.1, 0.0),
                v(x + 0.2, 0.02),
                v(x + 0.24, 0.3),
                v(x + 0.28, 0.0),
            ]),
        }
        if r.chance(0.25) && k + 1 < n {
            lines.push(soft(&line, r));
            line = vec![v(x + 0.32, 0.05)];
        }
    }
    if line.len() > 2 {
        lines.push(soft(&line, r));
    }
    lines
}

/// Posts and rails.
pub(super) fn fence(r: &mut Stream) -> Lines {
    let n = 3 + r.below(4);
    let mut lines: Lines = (0..n)
        .map(|k| {
            let (x, w) = (0.35 * k as f64, 0.08);
            pen(&[v(x - w, 0.0), v(x - w, 0.7), v(x, 0.85), v(x + w, 0.7), v(x + w, 0.0)], r)
        })
        .collect();
    for y in [0.25, 0.55] {
        lines.push(pen(&[v(-0.2, y), v(0.35 * n as f64 - 0.15, y)], r));
    }
    lines
}
