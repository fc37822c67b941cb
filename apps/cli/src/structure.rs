//! Plants read from files of structure: MTG, OPF, QSM and SWC.

use std::path::Path;

use burgeon::formats::{ReadStructure, StructureFormat, StructureSpec, StructureTally, read_structure};
use burgeon::glam::DVec3;
use burgeon::plant::Plant;
use burgeon::{
    PLAUSIBLE, Report, Seed, Stopped, StructureModel, StructureModelError, StructureOptions, Warning,
    check_read, make_from_structure,
};

use crate::failure::{Failure, Outcome};
use crate::files::{self, Input};
use crate::machine::Machine;
use crate::say;

/// Reads the plants of a file.
pub(crate) fn read(
    path: &Path,
    input: Input,
    format: StructureFormat,
    spec: &StructureSpec,
    told: &mut Report,
) -> Outcome<ReadStructure> {
    let read = read_structure(input, format, &files::stem(path), spec, told);
    let read = read.map_err(|e| Failure::bad_file(path, e))?;
    // A table of cylinders is in metres, as its programs write it.
    if !read.tally.unit_said && spec.metres.is_none() && format != StructureFormat::Qsm {
        let height = read.plants.iter().map(height_m).fold(0.0, f64::max);
        told.warnings.push(Warning {
            code: "unit-taken",
            message: format!(
                "the file says no unit: lengths were taken for metres, and the plant is {height:.3} m high; --in-unit says another"
            ),
            fields: Vec::new(),
        });
    }
    Ok(read)
}

fn height_m(plant: &Plant) -> f64 {
    plant.extent().map_or(0.0, |(low, high)| high.y - low.y)
}

/// Returns the only plant of a file, or the one of the given number from 1.
pub(crate) fn choose(
    path: &Path,
    read: ReadStructure,
    asked: Option<&str>,
) -> Outcome<(Plant, StructureTally)> {
    let count = read.plants.len();
    let row = match asked {
        None if count == 1 => 0,
        None => {
            let line = format_args!(
                "holds {} that stand apart; --plant 1 to --plant {count} takes one of them",
                say::counted(count as u64, "plant", "plants")
            );
            return Err(Failure::bad_file(path, line));
        }
        Some(asked) => {
            let number = asked.parse::<usize>().ok().filter(|n| (1..=count).contains(n));
            let wrong = || {
                Failure::bad_file(path, format_args!("has no plant {asked}: give a number from 1 to {count}"))
            };
            number.ok_or_else(wrong)? - 1
        }
    };
    let plant = read.plants.into_iter().nth(row).ok_or_else(|| Failure::Bug("a plant is gone".into()))?;
    // The tally covers all plants, so it does not apply to one of several.
    let tally = if count > 1 { StructureTally::default() } else { read.tally };
    Ok((plant, tally))
}

/// Fails on a plant that is higher than any real one.
pub(crate) fn check_height(path: &Path, plant: &Plant) -> Outcome {
    let height = height_m(plant);
    if height <= PLAUSIBLE.size_most_m {
        return Ok(());
    }
    let line = format_args!(
        "the plant would be {height:.0} m high, and none is: --in-unit cm, mm or um says the unit of the file"
    );
    Err(Failure::bad_file(path, line))
}

/// Makes a plant that was read, and refuses an impossible one.
pub(crate) fn make(
    path: &Path,
    (plant, tally): (Plant, &StructureTally),
    options: &StructureOptions,
    seed: Seed,
    machine: &Machine,
) -> Outcome<StructureModel> {
    check_height(path, &plant)?;
    let made = make_from_structure(plant, tally, options, seed, &machine.run()).map_err(|e| match e {
        StructureModelError::Stopped(Stopped::Cancelled(_)) => Failure::Cancelled,
        other => Failure::bad_file(path, other),
    });
    let mut made = made?;
    let item = &mut made.made.item;
    for (said, told) in item.warnings.iter_mut().zip(&item.told) {
        *said = named(std::mem::take(said), told.code);
    }
    Ok(made)
}

/// Returns a warning followed by the option that helps.
fn named(said: String, code: &str) -> String {
    let option = match code {
        "size-small" | "size-large" | "leaf-long" => "--in-unit",
        "volume-large" | "stem-slender" => "--thickness-unit",
        _ => return said,
    };
    format!("{said} ({option})")
}

/// Returns implausible properties of a plant as it stands in its file.
pub(crate) fn doubts(plant: &Plant, tally: &StructureTally) -> Vec<String> {
    let told = check_read(plant, tally).warnings;
    told.iter().map(|w| named(w.to_string(), w.code)).collect()
}

/// Describes the offset subtracted from the coordinates of a plant, in metres.
pub(crate) fn moved(foot: DVec3) -> Option<String> {
    let [x, y, z] = [foot.x, foot.y, foot.z].map(|x| (x * 1e4).round() / 1e4);
    (foot != DVec3::ZERO).then(|| {
        format!("the plant was moved to the origin: {x}, {y}, {z} m (+Y up) were taken off its coordinates")
    })
}
