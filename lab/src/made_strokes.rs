//! Sketches made by us, cleaner and larger than the public's: flowers of separate petals, twigs and trees of
//! lines with leaf outlines.
//!
//! They teach the classifier what careful drawings look like; they are never counted in its figures.

use std::f64::consts::TAU;

use base::{Draw, Seed, Stream, ops};
use glam::DVec2;
use ink::StrokeClass;

/// Number of sketches of each kind.
const EACH: u64 = 8;

/// One made sketch: kind, lines (y up), classes.
pub(crate) struct Made {
    pub(crate) kind: &'static str,
    pub(crate) lines: Vec<(Vec<DVec2>, StrokeClass)>,
}

/// Makes all of them; the same in every call.
pub(crate) fn made_sketches() -> Vec<Made> {
    let mut all = Vec::new();
    for k in 0..EACH {
        all.push(flower(&mut Seed::new(100 + k).stream(Draw::Template)));
        all.push(twig(&mut Seed::new(200 + k).stream(Draw::Template)));
        all.push(tree(&mut Seed::new(300 + k).stream(Draw::Template)));
    }
    all
}

fn direction(angle: f64) -> DVec2 {
    let (s, c) = ops::sin_cos(angle);
    DVec2::new(c, s)
}

/// Returns a petal or leaf as a nearly closed outline from `root` along `way`.
fn outline(r: &mut Stream, root: DVec2, way: DVec2, half: f64) -> Vec<DVec2> {
    let widest = r.range(0.8, 1.6);
    let gap = r.range(0.0, 0.04);
    let lean = r.range(-0.2, 0.2);
    let across = way.perp().normalize_or_zero();
    let shake = way.length() * 0.008;
    (0..=48)
        .map(|k| {
            let a = (f64::from(k) / 48.0 * (1.0 - gap)) * TAU;
            let t = (1.0 - ops::cos(a)) / 2.0;
            let bulge = half * ops::sin(a) * ops::powf(t.max(1e-9), widest - 1.0).min(2.0);
            let bend = lean * way.length() * t * (1.0 - t);
            root + way * t + across * (bulge + bend) + DVec2::new(r.normal(), r.normal()) * shake
        })
        .collect()
}

/// Returns a hand-drawn line from `a` to `b`.
fn line(r: &mut Stream, a: DVec2, b: DVec2) -> Vec<DVec2> {
    let across = (b - a).perp();
    let (bow, wave, phase) = (r.range(-0.12, 0.12), r.range(0.0, 0.015), r.range(0.0, TAU));
    (0..=24)
        .map(|k| {
            let t = f64::from(k) / 24.0;
            a.lerp(b, t) + across * (bow * 4.0 * t * (1.0 - t) + wave * ops::sin(phase + 7.0 * t))
        })
        .collect()
}

fn flower(r: &mut Stream) -> Made {
    let mut lines = Vec::new();
    let centre = DVec2::new(r.range(-0.1, 0.1), 1.0);
    let stem = line(r, DVec2::ZERO, centre);
    let petals = 5 + r.below(6);
    let (size, disc) = (r.range(0.2, 0.45), r.range(0.03, 0.1));
    let first = r.range(0.0, TAU);
    for k in 0..petals {
        let way = direction(first + TAU * k as f64 / petals as f64);
        let half = size * r.range(0.2, 0.4);
        lines.push((outline(r, centre + way * disc, way * size, half), StrokeClass::Blade));
    }
    if r.chance(0.5) {
        let round: Vec<DVec2> = (0..=32)
            .map(|k| centre + direction(TAU * f64::from(k) / 32.0) * disc * r.range(0.95, 1.05))
            .collect();
        lines.push((round, StrokeClass::Disc));
    }
    for k in 0..r.below(4) {
        let at = stem[5 + 4 * k];
        let way = direction(if k % 2 == 0 { 0.6 } else { TAU / 2.0 - 0.6 } + r.range(-0.3, 0.3))
            * r.range(0.2, 0.4);
        lines.push((outline(r, at, way, way.length() * 0.18), StrokeClass::Blade));
    }
    if r.chance(0.5) {
        lines.insert(0, (stem, StrokeClass::Axis))
    } else {
        lines.push((stem, StrokeClass::Axis))
    }
    Made { kind: "flower", lines }
}

fn twig(r: &mut Stream) -> Made {
    let tip = DVec2::new(r.range(-0.3, 0.3), 1.0);
    let rib = line(r, DVec2::ZERO, tip);
    let mut lines = vec![(rib.clone(), StrokeClass::Axis)];
    let leaves = 6 + r.below(9);
    for k in 0..leaves {
        let at = rib[3 + k * 20 / leaves];
        let side = if k % 2 == 0 { r.range(0.3, 1.0) } else { TAU / 2.0 - r.range(0.3, 1.0) };
        let way = direction(side);
        let long = r.range(0.15, 0.3);
        let stalk = r.range(0.0, 0.08);
        if stalk > 0.04 {
            lines.push((line(r, at, at + way * stalk), StrokeClass::Axis));
            lines.push((outline(r, at + way * stalk, way * long, long * 0.2), StrokeClass::Blade));
        } else {
            lines.push((outline(r, at, way * long, long * 0.2), StrokeClass::Blade));
        }
    }
    Made { kind: "twig", lines }
}

fn tree(r: &mut Stream) -> Made {
    let top = DVec2::new(r.range(-0.1, 0.1), 1.0);
    let trunk = line(r, DVec2::ZERO, top);
    let mut lines = vec![(trunk.clone(), StrokeClass::Axis)];
    let mut leaves = Vec::new();
    for k in 0..4 + r.below(5) {
        let at = trunk[8 + k * 2 % 16];
        let side = if k % 2 == 0 { r.range(0.4, 1.1) } else { TAU / 2.0 - r.range(0.4, 1.1) };
        let long = r.range(0.25, 0.5);
        let branch = line(r, at, at + direction(side) * long);
        for _ in 0..1 + r.below(3) {
            let from = branch[8 + r.below(16)];
            let way = direction(side + r.range(-0.9, 0.9)) * r.range(0.08, 0.16);
            leaves.push((outline(r, from, way, way.length() * 0.22), StrokeClass::Blade));
        }
        if r.chance(0.4) {
            let from = branch[10];
            lines.push((line(r, from, from + direction(side + 0.6) * long * 0.5), StrokeClass::Axis));
        }
        lines.push((branch, StrokeClass::Axis));
    }
    lines.extend(leaves);
    Made { kind: "branches", lines }
}
