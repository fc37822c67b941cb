//! The same self-organising tree by shadow voxels and by the light of the sky: figures, and a drawing of both.
//!
//! `cargo run --release -p burgeon-growth --example light -- FILE.svg`

use std::fmt::Write as _;
use std::io::Write as _;
use std::time::Instant;

use base::{Report, Run, Seed};
use glam::DVec3;
use growth::{Light, Obstacles, SelfOrganizingSpec, Skeleton, self_organize};

/// Width of the drawing of one tree, and height of the picture, pixels.
const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 320.0;

/// Pixels per metre.
const SCALE: f64 = 27.0;

/// Draws all internodes: from the front, or from the side.
fn draw(svg: &mut String, skeleton: &Skeleton, middle: f64, is_side: bool) -> std::fmt::Result {
    let place = |p: DVec3| {
        let across = if is_side { -p.z } else { p.x };
        (middle + SCALE * across, HEIGHT - 20.0 - SCALE * p.y)
    };
    for (joint, parent) in skeleton.parent.iter().enumerate() {
        let Some(parent) = parent else { continue };
        let (x0, y0) = place(skeleton.position[parent.index()]);
        let (x1, y1) = place(skeleton.position[joint]);
        let wide = (2.0 * SCALE * skeleton.radius_m[joint]).max(0.4);
        write!(svg, "<path d=\"M{x0:.0} {y0:.0}L{x1:.0} {y1:.0}\" stroke-width=\"{wide:.1}\"/>")?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = std::io::stdout().lock();
    let sky = Light::Sky { leaf_m: None, lines: 32_768, full: 1.0 };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {HEIGHT}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n<g stroke=\"#4a3a2a\" stroke-linecap=\"round\">\n",
        4.0 * WIDTH,
        4.0 * WIDTH
    );
    let mut names = String::new();
    for (k, name, light) in [(0.0, "shadow", Light::default()), (1.0, "sky", sky)] {
        let spec = SelfOrganizingSpec { light, years: 12, ..SelfOrganizingSpec::default() };
        let begun = Instant::now();
        let run = Run::plain();
        let none = Obstacles::none();
        let tree = self_organize(&[DVec3::ZERO], &none, &spec, Seed::new(1), &run, &mut Report::default())?;
        let seconds = begun.elapsed().as_secs_f64();
        let position = &tree.skeleton.position;
        let high = position.iter().map(|p| p.y).fold(0.0, f64::max);
        let wide = 2.0 * position.iter().map(|p| p.x.abs().max(p.z.abs())).fold(0.0, f64::max);
        writeln!(
            out,
            "{name}: {} internodes, {} shed, {high:.1} m high, {wide:.1} m wide, {seconds:.2} s",
            position.len() - 1,
            tree.shed
        )?;
        for (side, view) in [(0.0, "front"), (1.0, "side")] {
            let left = (2.0 * k + side) * WIDTH;
            draw(&mut svg, &tree.skeleton, left + 0.5 * WIDTH, side > 0.0)?;
            writeln!(names, "<text x=\"{}\" y=\"18\">{name}, {view}</text>", left + 12.0)?;
        }
    }
    write!(svg, "</g>\n{names}</svg>\n")?;
    if let Some(file) = std::env::args().nth(1) {
        std::fs::write(file, svg)?;
    }
    Ok(())
}
