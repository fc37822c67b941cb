//! Drawings by people: those that show no plant are reported, plants are not, and the score of a reading is the
//! probability that it is right.

use std::path::{Path, PathBuf};

use crate::missing;
use burgeon::bloom;
use burgeon::formats::{DrawingFormat, read_drawings};
use burgeon::ink::{self, Drawing};
use burgeon::reading::{self, Kind, UNLIKE_A_PLANT};
use burgeon::{Report, Run};

/// One drawing of this many in a file is read.
const EACH: usize = 8;

/// Returns one of every [`EACH`] drawings of a file.
fn some(path: &Path) -> Vec<Drawing> {
    let format = match path.extension() {
        Some(e) if e == "svg" => DrawingFormat::Svg,
        _ => DrawingFormat::Ndjson,
    };
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let all = read_drawings(bytes.as_slice(), format, "drawn");
    all.step_by(EACH).map(|d| d.unwrap_or_else(|e| panic!("{}: {e}", path.display())).drawing).collect()
}

/// Returns the files of a folder of sketches, by name.
fn files(folder: &Path, sub: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder.join(sub)).unwrap_or_else(|e| panic!("{sub}: {e}"));
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "ndjson" || e == "svg"));
    files.sort();
    files
}

/// Returns the kind of the first plant with its score, and whether the drawing was reported as no plant.
fn read(drawing: &Drawing) -> (Kind, f64, bool) {
    let mut report = Report::default();
    let ink = ink::clean(drawing, &mut report);
    let reading = reading::read(&ink, &ink::classify(&ink, &Run::plain()), &mut report);
    let told = report.warnings.iter().any(|w| w.code == UNLIKE_A_PLANT);
    reading.plants.first().map_or((Kind::None, 0.0, told), |p| (p.kind, p.readings[0].score, told))
}

/// Counts the drawings reported as no plant, and all of them.
fn count(files: &[PathBuf]) -> (usize, usize) {
    let drawings: Vec<Drawing> = files.iter().flat_map(|f| some(f)).collect();
    (drawings.iter().filter(|d| read(d).2).count(), drawings.len())
}

#[test]
fn of_drawings_by_people_other_things_are_told_and_plants_are_not() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/sketches");
    if !folder.is_dir() {
        return missing::skipped(folder.display());
    }
    let (told, things) = count(&files(&folder, "no_plants"));
    assert_eq!(things, 1272_usize.div_ceil(EACH));
    assert!(told * 5 > things * 2, "{told} of {things} drawings of other things are told");
    let sets = ["quickdraw", "quickdraw_more", "spg", "trees_by_hand", "illustrations"];
    let (told, plants) = sets.iter().fold((0, 0), |sum, sub| {
        let own = count(&files(&folder, sub));
        (sum.0 + own.0, sum.1 + own.1)
    });
    assert!(plants > 200 && told * 33 <= plants, "{told} of {plants} plants are told");
}

#[test]
fn a_score_is_how_often_such_a_reading_is_right() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/sketches/trees_by_hand");
    if !folder.is_dir() {
        return missing::skipped(folder.display());
    }
    let all: Vec<(Kind, f64, bool)> =
        files(&folder, "").iter().flat_map(|f| some(f)).map(|d| read(&d)).collect();
    let right = all.iter().filter(|r| r.0.is_like(Kind::Tree)).count() as f64 / all.len() as f64;
    let said = all.iter().map(|r| r.1).sum::<f64>() / all.len() as f64;
    assert!(all.len() > 30 && (right - said).abs() < 0.1, "{right} are right, {said} is said");
}

#[test]
fn flowers_that_come_with_the_program_are_plausible_on_every_day() {
    use burgeon::bloom::FlowerSpec;
    use burgeon::skin::SkinSpec;
    use burgeon::{FlowerOptions, Seed, make_flower};

    let coarse = SkinSpec { detail: 0.2, ..SkinSpec::default() };
    let options = FlowerOptions { skin: coarse, ..FlowerOptions::default() };
    for word in FlowerSpec::PRESETS {
        let spec = bloom::preset(word).unwrap_or_else(|| panic!("{word} is no preset"));
        for day in [0.0, spec.opening_days, spec.opening_days + spec.wilting_days] {
            let made =
                make_flower(&spec.name, &spec, (day, &spec.own_law()), &options, Seed::new(1), &Run::plain());
            let item = made.unwrap_or_else(|e| panic!("{word} on day {day}: {e}")).item;
            let failed: Vec<_> = item.checks.iter().filter(|c| !c.ok).collect();
            assert!(!item.checks.is_empty() && failed.is_empty(), "{word} on day {day}: {failed:?}");
        }
    }
}
