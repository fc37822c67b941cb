//! Elements of made drawings: lines as a pen draws them, and parts that many kinds share.

use std::f64::consts::PI;

use base::{Stream, ops};
use glam::DVec2;

use super::{Lines, blade, direction, extent, hand, ring, scribble};

pub(super) fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// Returns a hand-drawn line through points.
pub(super) fn pen(corners: &[DVec2], r: &mut Stream) -> Vec<DVec2> {
    hand(r, corners)
}

/// Returns a wobbly ring.
pub(super) fn round(centre: DVec2, size: DVec2, bumps: usize, depth: f64, r: &mut Stream) -> Vec<DVec2> {
    ring(r, centre, size, bumps, depth)
}

/// Returns a petal or leaf as an outline.
pub(super) fn leafy_blade(root: DVec2, way: DVec2, half: f64, r: &mut Stream) -> Vec<DVec2> {
    blade(r, root, way, half)
}

pub(super) fn scribbled(centre: DVec2, size: DVec2, r: &mut Stream) -> Vec<DVec2> {
    scribble(r, centre, size)
}

/// Returns a soft hand-drawn line with rounded corners.
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

/// Returns part of a lobed ring, from one angle to another.
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

/// Returns the left and right side of a trunk, from the neck down, flaring.
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

pub(super) fn turned(r: &mut Stream, lines: Lines, most: f64) -> Lines {
    let (s, c) = ops::sin_cos(r.range(-most, most));
    lines
        .into_iter()
        .map(|l| l.into_iter().map(|p| v(c * p.x - s * p.y, s * p.x + c * p.y)).collect())
        .collect()
}

/// Draws a tuft of green at a place.
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
