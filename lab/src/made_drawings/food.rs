//! Made drawings of fruits, vegetables and mushrooms, in the ways in which people draw them.

use std::f64::consts::{PI, TAU};

use base::{Stream, ops};
use glam::DVec2;

use super::pens::{arc, leafy_blade, pen, round, soft, tuft, turned, v};
use super::{Lines, blade, direction, extent, moved};

pub(super) fn carrot(r: &mut Stream) -> Lines {
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

pub(super) fn mushroom(r: &mut Stream) -> Lines {
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

pub(super) fn pod(r: &mut Stream) -> Lines {
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

pub(super) fn onion(r: &mut Stream) -> Lines {
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

pub(super) fn potato(r: &mut Stream) -> Lines {
    let size = v(r.range(0.4, 0.55), r.range(0.25, 0.4));
    let mut lines = vec![arc(DVec2::ZERO, size, 0.0, TAU * 0.99, 0, 0.0, r)];
    for _ in 0..r.below(8) {
        let at = direction(r.range(0.0, TAU)) * size * r.range(0.0, 0.7);
        lines.push(pen(&[at, at + v(r.range(0.01, 0.04), r.range(-0.02, 0.02))], r));
    }
    turned(r, lines, 1.5)
}

pub(super) fn grapes(r: &mut Stream) -> Lines {
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

pub(super) fn berry(r: &mut Stream) -> Lines {
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

pub(super) fn crescent(r: &mut Stream) -> Lines {
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

pub(super) fn slice(r: &mut Stream) -> Lines {
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

pub(super) fn strawberry(r: &mut Stream) -> Lines {
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

pub(super) fn pineapple(r: &mut Stream) -> Lines {
    let size = v(r.range(0.2, 0.32), r.range(0.3, 0.42));
    let middle = v(0.0, size.y);
    let body = match r.below(4) {
        // With shoulders, so that its top is flat.
        0 => {
            let (top, foot) = (r.range(0.5, 1.0) * size.x, r.range(0.5, 1.0) * size.x);
            let corner = |x: f64, y: f64| v(x, y * size.y);
            let (left, right) = ([(-top, 1.9), (-size.x, 1.2)], [(size.x, 1.2), (top, 1.9)]);
            let below = [(-foot, 0.05), (foot, 0.05)];
            let round = [&left[..], &below[..], &right[..], &left[..1]].concat();
            soft(&round.into_iter().map(|(x, y)| corner(x, y)).collect::<Vec<_>>(), r)
        }
        // Open above, where the tuft stands.
        1 => {
            let open = r.range(0.15, 0.6);
            arc(middle, size, 0.5 * PI + open, 2.5 * PI - open, 0, 0.0, r)
        }
        _ => round(middle, size, 0, 0.0, r),
    };
    let mut lines = vec![body];
    let skin = r.below(5);
    for _ in 0..r.below(6) {
        let t = r.range(-0.6, 0.6);
        let (side, y) = (0.8 * size.x * (1.0 - t * t).sqrt(), size.y * (1.0 + t));
        match skin {
            0 => lines.push(pen(&[v(-side, y), v(side, y + r.range(-0.03, 0.03))], r)),
            1 => lines.push(round(v(r.range(-0.7, 0.7) * side, y), DVec2::splat(0.03), 0, 0.0, r)),
            2 => lines.push(pen(&[v(side * t, 0.3 * size.y), v(side * t, 1.7 * size.y)], r)),
            _ => {
                lines.push(pen(&[v(-side, y - 0.1), v(side, y + 0.1)], r));
                lines.push(pen(&[v(side, y - 0.1), v(-side, y + 0.1)], r));
            }
        }
    }
    for _ in 0..1 + r.below(5) / 4 {
        let green = r.range(0.25, 0.45);
        lines.extend(tuft(r, v(0.0, 2.0 * size.y), green));
    }
    lines
}

pub(super) fn pear(r: &mut Stream) -> Lines {
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

/// Draws spears: a long body with scales and a head of buds; one, or several in a row, with or without a band.
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

/// Draws a bent body, long and thin.
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

/// Draws an open pod: two arcs and peas between them; or peas alone.
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

/// Draws round berries, each with a small star or ring: one, or some that touch.
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

/// Draws berries that hang from a stalk each, as cherries do.
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

/// Draws a berry of bumps: the outline alone, or with arcs inside.
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

/// Draws a round root with a tail, and leaves.
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

/// Draws a gourd with ribs.
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

/// Draws a body with nothing but its outline, of any length.
pub(super) fn bare_body(r: &mut Stream) -> Lines {
    let size = v(0.5, r.range(0.14, 0.42));
    let mut lines = vec![arc(DVec2::ZERO, size, 0.0, TAU * r.range(0.95, 1.05), 0, 0.0, r)];
    if r.chance(0.3) {
        lines.push(pen(&[v(0.5, 0.0), v(0.6, r.range(-0.05, 0.05))], r));
    }
    turned(r, lines, PI)
}

/// Draws a root in one line, with or without green: wide at one end, pointed at the other.
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

/// Draws caps with gills, with a ring, or two next to each other.
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
