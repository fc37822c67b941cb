//! Helpers shared by the tests of plants from readings.

use base::{Report, Run, Seed};
use glam::DVec2;
use reading::{BladeReading, Reading};
use sketch::{Built, SketchSpec, build};

pub(crate) fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

pub(crate) fn made(reading: &Reading, spec: &SketchSpec) -> Built {
    build(reading, spec, Seed::new(1), &Run::plain(), &mut Report::default()).expect("not cancelled")
}

/// A lens from root to tip.
pub(crate) fn blade(root: DVec2, tip: DVec2, width: f64, source: u32) -> BladeReading {
    let point = |i: i32, s: f64| {
        let t = f64::from(i) / 12.0;
        root.lerp(tip, t) - (tip - root).perp() * (s * width * 4.0 * t * (1.0 - t))
    };
    let outline = (0..=12).map(|i| point(i, 0.5)).chain((1..12).rev().map(|i| point(i, -0.5))).collect();
    BladeReading {
        outline,
        root,
        tip,
        midrib: vec![root, root.lerp(tip, 0.5), tip],
        veins: vec![],
        bearer: None,
        whorl: 0,
        front: None,
        source: Some(source),
        color: None,
    }
}
