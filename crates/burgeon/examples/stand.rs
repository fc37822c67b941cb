//! A stand of one kind of tree: the variation among its trees, and the growth of each.
//!
//! `cargo run --release --example stand -p burgeon -- SPEC [--seeds N] [--ages A,B,..] [--png SHEET.png [--at AGE]]`.
//! SPEC is a preset or a TOML file. Prints means and coefficients of variation of height, diameter at breast height and
//! crown area, and the measures of one seed at each age; with `--png` also nine seeds in one picture.

#![expect(clippy::print_stdout, reason = "it tells what it measured")]

use burgeon::formats::write_png;
use burgeon::growth::grow;
use burgeon::plant::Measures;
use burgeon::render::{PictureSpec, contact_sheet, render};
use burgeon::spec::from_toml;
use burgeon::{Preset, Report, Run, Seed, TreeOptions, TreeSpec, make_tree, tree_blade};

/// Formats the mean and coefficient of variation of a measure, or `none` without values.
fn mean_and_variation(values: &[f64]) -> String {
    if values.is_empty() {
        return "none".into();
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let sd = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt();
    format!("{mean:.3} (cv {:.1} %)", 100.0 * sd / mean.max(1e-12))
}

fn one(spec: &TreeSpec, seed: u64) -> Result<Measures, String> {
    let blade = tree_blade(&spec.blade);
    let grown = grow(spec, Some(blade), Seed::new(seed), &Run::plain(), &mut Report::default());
    Ok(grown.map_err(|e| e.to_string())?.plant.measure())
}

fn sheet(spec: &TreeSpec, path: &str, count: u64, size: u32) -> Result<(), String> {
    let mut pictures = Vec::new();
    for seed in 1..=count {
        let made = make_tree(spec, Seed::new(seed), &TreeOptions::default(), &Run::plain())
            .map_err(|e| e.to_string())?;
        let picture = PictureSpec { width: size, height: size, supersample: 2, ..PictureSpec::default() };
        pictures.push(render(&made.model, &picture, &Run::plain()).map_err(|e| e.to_string())?);
    }
    let columns = if count == 1 { 1 } else { 3 };
    let sheet = contact_sheet(&pictures, columns);
    let file = std::fs::File::create(path).map_err(|e| format!("{path}: {e}"))?;
    write_png(sheet.width, sheet.height, &sheet.pixels, file).map_err(|e| e.to_string())
}

fn main() -> Result<(), String> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let what = args.first().ok_or("give a preset or a TOML file")?;
    let option = |name: &str| args.iter().position(|a| a == name).and_then(|i| args.get(i + 1)).cloned();
    let number = |name: &str, or: u64| option(name).and_then(|v| v.parse().ok()).unwrap_or(or);
    let spec: TreeSpec = match Preset::find(what) {
        Some(preset) => preset.spec().map_err(|e| e.to_string())?,
        None => {
            let text = std::fs::read_to_string(what).map_err(|e| format!("{what}: {e}"))?;
            from_toml(&text).map_err(|e| e.to_string())?
        }
    };
    let seeds = number("--seeds", 0);
    let mut rows: [Vec<f64>; 4] = Default::default();
    for seed in 1..=seeds {
        let m = one(&spec, seed)?;
        for (row, value) in
            rows.iter_mut().zip([Some(m.height_m), m.dbh_m, Some(m.crown_projection_m2), m.lai])
        {
            row.extend(value);
        }
    }
    if seeds > 0 {
        let [h, d, c, l] = rows.map(|r| mean_and_variation(&r));
        println!("{what}: height {h} m, dbh {d} m, crown {c} m2, leaf area index {l}");
    }
    for age in option("--ages").unwrap_or_default().split(',').filter_map(|a| a.parse().ok()) {
        let m = one(&TreeSpec { age: Some(age), ..spec.clone() }, 1)?;
        println!(
            "{what} at {age}: height {:.2} m, dbh {:.1} cm, crown {:.1} m2, leaves {} ({:.1} m2)",
            m.height_m,
            100.0 * m.dbh_m.unwrap_or(0.0),
            m.crown_projection_m2,
            m.leaves,
            m.leaf_area_m2
        );
    }
    if let Some(path) = option("--png") {
        let age = option("--at").and_then(|a| a.parse().ok());
        #[expect(clippy::cast_possible_truncation, reason = "a size of pictures")]
        let size = number("--size", 300) as u32;
        sheet(&TreeSpec { age, ..spec }, &path, number("--pictures", 9), size)?;
    }
    Ok(())
}
