//! Light in canopies of small leaves compared with the closed form of the turbid medium, as a table and as a plot.
//!
//! `cargo run --release -p burgeon-light --example canopies -- FILE.svg`

use std::fmt::Write as _;
use std::io::Write as _;

use base::{Draw, Run, Seed, ops};
use glam::DVec3;
use light::{Beams, LightError, LightSpec, LitScene, Optics, SkyKind, SunPosition, absorb};

/// Leaf area indices, each with the colour of its curve.
const CANOPIES: [(f64, &str); 4] = [(1.0, "#8bc34a"), (2.0, "#4b9f3c"), (3.0, "#26703a"), (4.0, "#0d4030")];

/// Edge of a leaf, metres.
const LEAF_M: f64 = 0.02;

/// Azimuths for each elevation.
const TURNS: u32 = 6;

/// Square leaves in all directions evenly, in a cell of 1 m by 1 m.
fn canopy(leaf_area_index: f64, optics: Optics) -> LitScene {
    let mut chance = Seed::new(11).stream(Draw::Test);
    let count = ops::whole((leaf_area_index / (LEAF_M * LEAF_M)).round());
    let mut scene = LitScene { receivers: vec![optics], ..LitScene::default() };
    for leaf in 0..count {
        let middle = DVec3::new(chance.uniform(), 0.1 + chance.uniform(), chance.uniform());
        let up = chance.range(-1.0, 1.0);
        let (sin, cos) = ops::sin_cos(chance.range(0.0, ops::TAU));
        let flat = (1.0 - up * up).sqrt();
        let (a, b) = DVec3::new(flat * cos, up, flat * sin).any_orthonormal_pair();
        let (a, b) = (a * LEAF_M * 0.5, b * LEAF_M * 0.5);
        scene.points.extend([middle - a - b, middle + a - b, middle + a + b, middle - a + b]);
        scene
            .triangles
            .extend([[4 * leaf, 4 * leaf + 1, 4 * leaf + 2], [4 * leaf, 4 * leaf + 2, 4 * leaf + 3]]);
        scene.owners.extend([0, 0]);
    }
    scene
}

fn spec() -> LightSpec {
    LightSpec { lines: 1 << 16, repeat_m: Some([1.0, 1.0]), ..LightSpec::default() }
}

/// Returns the share that a canopy transmits at each elevation: the mean over azimuths.
fn through(scene: &LitScene, elevations: &[f64]) -> Result<Vec<f64>, LightError> {
    let mut beams = Beams::default();
    for elevation_deg in elevations {
        for turn in 0..TURNS {
            let azimuth_deg = 17.0 + 360.0 / f64::from(TURNS) * f64::from(turn);
            beams.add_beam(SunPosition { azimuth_deg, elevation_deg: *elevation_deg }, 1.0)?;
        }
    }
    let first = LightSpec { bounces: 0, soil_reflectance: 0.0, ..spec() };
    let found = absorb(scene, &beams, &first, Seed::new(1), &Run::plain())?;
    let of_elevation = found.directions.chunks(TURNS as usize);
    Ok(of_elevation.map(|d| d.iter().filter_map(|d| d.transmitted).sum::<f64>() / f64::from(TURNS)).collect())
}

fn closed_form(leaf_area_index: f64, elevation_deg: f64) -> f64 {
    ops::exp(-0.5 * leaf_area_index / ops::sin(elevation_deg.to_radians()))
}

/// Returns the position in the plot.
fn plot_position(elevation_deg: f64, share: f64) -> (f64, f64) {
    (60.0 + elevation_deg / 90.0 * 500.0, 330.0 - share * 300.0)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = std::io::stdout().lock();
    let elevations: Vec<f64> = (1..=17).map(|k| 5.0 * f64::from(k)).chain([90.0]).collect();
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 390\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"600\" height=\"390\" fill=\"#fff\"/>\n",
    );
    for k in 0..=5 {
        let share = 0.2 * f64::from(k);
        let (x, y) = plot_position(0.0, share);
        writeln!(
            svg,
            "<path d=\"M{x} {y}h500\" stroke=\"#ddd\"/><text x=\"52\" y=\"{}\" text-anchor=\"end\">{share:.1}</text>",
            y + 4.0
        )?;
        let (x, y) = plot_position(18.0 * f64::from(k), 0.0);
        writeln!(svg, "<text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{}</text>", y + 18.0, 18 * k)?;
    }
    writeln!(svg, "<text x=\"310\" y=\"378\" text-anchor=\"middle\">elevation of the light, degrees</text>")?;
    writeln!(
        svg,
        "<text x=\"66\" y=\"22\">share of light that meets no leaf: lines exp(-0.5 LAI / sin elevation), dots computed</text>"
    )?;
    writeln!(out, "leaf area index, elevation, computed, closed form")?;
    let mut worst = 0.0_f64;
    for (leaf_area_index, colour) in CANOPIES {
        let found = through(&canopy(leaf_area_index, Optics::BLACK), &elevations)?;
        let line: Vec<String> = (2..=90)
            .map(|k| plot_position(f64::from(k), closed_form(leaf_area_index, f64::from(k))))
            .map(|(x, y)| format!("{x:.1},{y:.1}"))
            .collect();
        writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"/>",
            line.join(" ")
        )?;
        for (elevation, share) in elevations.iter().zip(found) {
            let wanted = closed_form(leaf_area_index, *elevation);
            worst = worst.max((share - wanted).abs());
            writeln!(out, "{leaf_area_index}, {elevation}, {share:.4}, {wanted:.4}")?;
            let (x, y) = plot_position(*elevation, share);
            writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>")?;
        }
        let (x, y) = plot_position(90.0, closed_form(leaf_area_index, 90.0));
        writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" fill=\"{colour}\">LAI {leaf_area_index}</text>",
            x - 30.0,
            y - 8.0
        )?;
    }
    svg.push_str("</svg>\n");
    writeln!(out, "largest difference: {worst:.4}")?;
    writeln!(out, "leaf area index, absorbed, soil, back, sum over incoming")?;
    for (leaf_area_index, _) in CANOPIES {
        let beams = Beams::sky(SkyKind::Overcast, 100.0)?;
        let found =
            absorb(&canopy(leaf_area_index, Optics::LEAF), &beams, &spec(), Seed::new(1), &Run::plain())?;
        let Some(b) = found.balance else { continue };
        let [plants, soil, back] = [b.absorbed_w, b.soil_w, b.reflected_w].map(|w| w / b.incoming_w);
        writeln!(out, "{leaf_area_index}, {plants:.4}, {soil:.4}, {back:.4}, {:.6}", plants + soil + back)?;
    }
    if let Some(file) = std::env::args().nth(1) {
        std::fs::write(file, svg)?;
    }
    Ok(())
}
