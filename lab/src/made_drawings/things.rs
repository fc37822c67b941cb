//! Made drawings of things other than plants.

use std::f64::consts::{PI, TAU};

use base::Stream;
use glam::DVec2;

use super::pens::{arc, pen, round, soft, turned, v};
use super::{Lines, blade, direction, moved};

pub(super) fn house(r: &mut Stream) -> Lines {
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

pub(super) fn face(r: &mut Stream) -> Lines {
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

pub(super) fn cat(r: &mut Stream) -> Lines {
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

pub(super) fn person(r: &mut Stream) -> Lines {
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

pub(super) fn car(r: &mut Stream) -> Lines {
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

pub(super) fn fish(r: &mut Stream) -> Lines {
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

pub(super) fn letters(r: &mut Stream) -> Lines {
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

pub(super) fn star(r: &mut Stream) -> Lines {
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

pub(super) fn spiral(r: &mut Stream) -> Lines {
    let turns = r.range(2.0, 5.0);
    let n = 120;
    let stretch = v(1.0, r.range(0.6, 1.0));
    let line = (0..=n)
        .map(|k| f64::from(k) / f64::from(n))
        .map(|t| direction(TAU * turns * t) * stretch * (0.05 + 0.95 * t));
    vec![line.map(|p| p + v(r.normal(), r.normal()) * 0.01).collect()]
}

pub(super) fn boat(r: &mut Stream) -> Lines {
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

pub(super) fn cup(r: &mut Stream) -> Lines {
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

pub(super) fn table(r: &mut Stream) -> Lines {
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

pub(super) fn arrow(r: &mut Stream) -> Lines {
    let lines = vec![
        pen(&[v(0.0, 0.0), v(1.0, 0.0)], r),
        pen(&[v(1.0 - r.range(0.15, 0.3), 0.2), v(1.0, 0.0), v(1.0 - r.range(0.15, 0.3), -0.2)], r),
    ];
    turned(r, lines, 1.2)
}

pub(super) fn cube(r: &mut Stream) -> Lines {
    let (w, h) = (r.range(0.3, 0.5), r.range(0.3, 0.5));
    let back = v(r.range(0.15, 0.3), r.range(0.15, 0.3));
    let mut lines = vec![pen(&[v(0.0, 0.0), v(0.0, h), v(w, h), v(w, 0.0), v(0.0, 0.0)], r)];
    if r.chance(0.7) {
        lines.push(pen(&[v(0.0, h), v(0.0, h) + back, v(w, h) + back, v(w, h)], r));
        lines.push(pen(&[v(w, h) + back, v(w, 0.0) + back, v(w, 0.0)], r));
    }
    lines
}

pub(super) fn hills(r: &mut Stream) -> Lines {
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

/// Draws two or four wings on a body, with or without feelers.
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

/// Draws one or some distant birds.
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

/// Draws a quarter of a sun, in the corner of the sheet.
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

/// Draws a word in one stroke or in some, as a name under a picture.
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

/// Draws posts and rails.
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
