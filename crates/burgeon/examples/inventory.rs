//! A custom maker in one file: trees of a stand from the rows of an inventory.
//!
//! `cargo run --example inventory -p burgeon [INVENTORY.csv [FOLDER]]`. A row is `preset,x_m,z_m,height_m,crown_m`;
//! without a file a small stand is made.
//!
//! A maker turns a description into a [`Plant`](burgeon::plant::Plant) and leaves the rest to the readers of plants.
//! This one grows a species and scales it to the measured height of its tree and the width of its crown.

use std::path::PathBuf;

use burgeon::formats::{ExportSpec, write_glb, write_mtg};
use burgeon::glam::DVec3;
use burgeon::plant::Plant;
use burgeon::skin::{SkinSpec, skin};
use burgeon::{Preset, Run, Seed, TreeOptions, make_tree};

/// One tree of an inventory.
struct Row {
    preset: &'static Preset,
    /// Position x and z, height, and diameter of its crown, metres.
    numbers: [f64; 4],
}

/// Reads the description: the rows of the file, or the fault of one.
fn read(text: &str) -> Result<Vec<Row>, String> {
    let rows = text.lines().enumerate().map(|(k, l)| (k + 1, l.trim())).filter(|(_, l)| !l.is_empty());
    let row = |(line, text): (usize, &str)| {
        let mut words = text.split(',').map(str::trim);
        let key = words.next().unwrap_or_default();
        let preset = Preset::find(key).ok_or_else(|| format!("line {line}: there is no preset {key:?}"))?;
        let numbers: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
        match numbers[..] {
            [x, z, height, crown] if height > 0.0 && crown > 0.0 => {
                Ok(Row { preset, numbers: [x, z, height, crown] })
            }
            _ => Err(format!("line {line}: give preset,x_m,z_m,height_m,crown_m, the last two above 0")),
        }
    };
    rows.map(row).collect()
}

/// Makes a plant as high and as wide as its row says, at its place.
fn make(row: &Row, seed: Seed, run: &Run<'_>) -> Result<Plant, Box<dyn std::error::Error>> {
    let [x, z, height, crown] = row.numbers;
    let mut plant = make_tree(&row.preset.spec()?, seed, &TreeOptions::default(), run)?.grown.plant;
    let (low, high) = plant.extent().ok_or("a tree without wood")?;
    let size = high - low;
    let (up, out) = (height / size.y, crown / (0.5 * (size.x + size.z)));
    let placed = |p: DVec3| DVec3::new(x + p.x * out, p.y * up, z + p.z * out);
    plant.nodes.position.iter_mut().for_each(|p| *p = placed(*p));
    plant.nodes.radius_m.iter_mut().for_each(|r| *r *= up);
    for organ in &mut plant.organs {
        organ.frame.origin = placed(organ.frame.origin);
    }
    Ok(plant)
}

#[expect(clippy::print_stdout, reason = "this is a program for the terminal")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let text = match arguments.next() {
        Some(file) => std::fs::read_to_string(file)?,
        None => "hazel, 0, 0, 4.5, 3.5\nhazel, 5, 1, 3.2, 2.8\ngrass, 2, 2, 0.6, 0.5\n".into(),
    };
    let folder = arguments.next().unwrap_or_else(std::env::temp_dir);
    let run = Run::plain();
    for (k, row) in (0_u64..).zip(read(&text)?) {
        let plant = make(&row, Seed::new(1).child(k), &run)?;
        // Every reader of plants now accepts this one: meshes, structure, measures.
        let model = skin(&plant, &SkinSpec { detail: 0.2, textures: false, ..SkinSpec::default() }, &run)?;
        let path = folder.join(format!("inventory-{k}"));
        write_glb(&model, std::fs::File::create(path.with_extension("glb"))?)?;
        write_mtg(&plant, &ExportSpec::default(), std::fs::File::create(path.with_extension("mtg"))?)?;
        let measures = plant.measure();
        println!(
            "{}: {:.1} m high, {} leaves, {:.4} m3 of wood, {} triangles",
            path.display(),
            measures.height_m,
            measures.leaves,
            measures.wood_volume_m3,
            model.triangle_count()
        );
    }
    Ok(())
}
