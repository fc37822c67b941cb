//! `cargo xtask train-strokes`: the table of measured strokes -> the classifier's models and `docs/strokes.md`.

use std::{collections::BTreeMap, fmt::Write as _, fs, path::Path};

use ink::{
    Drawing, StrokeClass, StrokeFigures, StrokeRow, StrokeSource, cross_validate_strokes, read_stroke_table,
    train_strokes, write_stroke_table,
};
use serde_json::Value;

use crate::ablation;
use crate::made_strokes::made_sketches;
use crate::quickdraw::{drawing_of, drawings_of, json_lines, list, read, text_of};
use xtask::shell::repository;

/// Number of fold seeds over which the figures are averaged.
const SEEDS: u64 = 8;
/// Categories of SPG, the step between the drawings measured, and their classes: enough for training, too few to
/// dominate.
const SPG: [(&str, usize, [StrokeClass; 4]); 2] = [
    ("apple", 8, [StrokeClass::Axis, StrokeClass::Blade, StrokeClass::Fruit, StrokeClass::Other]),
    (
        "cactus",
        12,
        [StrokeClass::TrunkOutline, StrokeClass::TrunkOutline, StrokeClass::Axis, StrokeClass::Pot],
    ),
];
/// Most strokes of one part of one SPG drawing: thorns come by the dozen.
const PER_PART: usize = 3;

/// Trains the models from the table, prints their quality, and writes models and figures into the repository.
///
/// `--measure <folder>` first remeasures the drawings of a folder like `shared/data/sketches`.
///
/// # Errors
/// A sentence that names the file and its fault.
#[expect(clippy::print_stdout, reason = "the figures are what the command is for")]
pub(crate) fn run(args: &[String]) -> Result<(), String> {
    let root = repository();
    let data = root.join("crates/ink/data");
    let table = data.join("strokes.csv");
    match args {
        [] => {}
        [flag, folder] if flag == "--measure" => {
            let rows = measure(Path::new(folder))?;
            write(&table, &write_stroke_table(&rows))?;
            println!("measured {} strokes into {}", rows.len(), table.display());
        }
        _ => return Err("usage: cargo xtask train-strokes [--measure <sketches folder>]".to_owned()),
    }
    let rows = read_stroke_table(&read(&table)?).map_err(|e| format!("{}: {e}", table.display()))?;
    let mut figures = Vec::new();
    for seed in 0..SEEDS {
        figures.push(cross_validate_strokes(&rows, base::Seed::new(seed)).map_err(|e| e.to_string())?);
    }
    let block = figures_block(&rows, &figures);
    println!("{block}");
    let models = train_strokes(&rows).map_err(|e| e.to_string())?;
    write(&data.join("strokes.scale"), &models.scale)?;
    write(&data.join("strokes.model"), &models.classes)?;
    let packed = models.packed_classes().map_err(|e| e.to_string())?;
    fs::write(data.join("strokes.packed"), packed).map_err(|e| format!("strokes.packed: {e}"))?;
    let docs = root.join("docs/strokes.md");
    update_docs(&docs, "figures", &block)?;
    let sketches = root.join("../shared/data/sketches");
    if !sketches.is_dir() {
        println!("skipped: what each rule is worth, because {} is not here", sketches.display());
        return Ok(());
    }
    let rules = ablation::block(&rows, &sketches, &root.join("fixtures/sketches"))?;
    println!("{rules}");
    update_docs(&docs, "rules", &rules)
}

/// Returns the block of `docs/strokes.md` that this command owns.
fn figures_block(rows: &[StrokeRow], all: &[StrokeFigures]) -> String {
    let mut out = String::new();
    let count = all.len().max(1) as f64;
    let spread = |get: &dyn Fn(&StrokeFigures) -> f64| {
        let mean = all.iter().map(get).sum::<f64>() / count;
        let variance = all.iter().map(|f| (get(f) - mean) * (get(f) - mean)).sum::<f64>() / count;
        (mean, variance.sqrt())
    };
    let clear = rows.iter().filter(|r| r.source == StrokeSource::Public && r.is_clear()).count();
    let _ = writeln!(
        out,
        "{clear} clear strokes, 10 folds by drawing, {} random splits (mean and spread over the splits):\n",
        all.len()
    );
    let _ = writeln!(out, "| figure | mean | spread |\n|---|---|---|");
    for (name, (mean, deviation)) in [
        ("macro F1 of the classes with 20 or more clear strokes", spread(&|f| f.macro_f1)),
        (
            "closed outlines and lines: class in the right group, any third class counted wrong",
            spread(&|f| f.grouped),
        ),
        ("closed outlines and lines: not taken for the other group", spread(&|f| f.not_swapped)),
        ("closed outlines and lines: the three features alone", spread(&|f| f.three_features)),
    ] {
        let _ = writeln!(out, "| {name} | {mean:.3} | {deviation:.3} |");
    }
    let _ = writeln!(out, "\n| class | F1 mean | spread |\n|---|---|---|");
    for (k, class) in StrokeClass::ALL.into_iter().enumerate() {
        if all.iter().all(|f| f.f1[k].is_some()) {
            let (mean, deviation) = spread(&|f| f.f1[k].unwrap_or(0.0));
            let _ = writeln!(out, "| {} | {mean:.3} | {deviation:.3} |", class.word());
        }
    }
    if let Some(first) = all.first() {
        let _ = writeln!(out, "\nConfusion matrix of the first split (rows: label, columns: found):\n");
        let words: Vec<&str> = StrokeClass::ALL.iter().map(|c| c.word()).collect();
        let _ = writeln!(out, "| | {} |\n|---|{}", words.join(" | "), "---|".repeat(words.len()));
        for (word, row) in words.iter().zip(&first.confusion) {
            let cells: Vec<String> =
                row.iter().map(|n| if *n == 0 { String::new() } else { n.to_string() }).collect();
            let _ = writeln!(out, "| **{word}** | {} |", cells.join(" | "));
        }
    }
    parts_block(&mut out, all);
    out
}

/// Reports how SPG's parts were classified, over all dealings.
fn parts_block(out: &mut String, all: &[StrokeFigures]) {
    let mut parts: BTreeMap<(&str, StrokeClass), BTreeMap<StrokeClass, usize>> = BTreeMap::new();
    for (kind, label, found) in all.iter().flat_map(|f| &f.parts) {
        *parts.entry((kind, *label)).or_default().entry(*found).or_default() += 1;
    }
    let _ = writeln!(
        out,
        "\nSPG drawings (strokes with nine tenths of their points under one label), found as:\n"
    );
    let _ = writeln!(out, "| drawing | label | found |\n|---|---|---|");
    for ((kind, label), found) in parts {
        let sum: usize = found.values().sum();
        let mut shares: Vec<(usize, StrokeClass)> = found.into_iter().map(|(c, n)| (n, c)).collect();
        shares.sort_by(|a, b| b.cmp(a));
        let words: Vec<String> = shares
            .iter()
            .map(|(n, c)| format!("{} {:.1} %", c.word(), 100.0 * *n as f64 / sum as f64))
            .collect();
        let _ = writeln!(
            out,
            "| {kind} | {} ({}) | {} |",
            label.word(),
            sum / all.len().max(1),
            words.join(", ")
        );
    }
}

fn update_docs(path: &Path, name: &str, block: &str) -> Result<(), String> {
    let open = format!("<!-- {name}: written by cargo xtask train-strokes -->\n");
    let close = format!("<!-- end of {name} -->\n");
    let text = read(path)?;
    let parts = text.split_once(&open).and_then(|(a, rest)| rest.split_once(&close).map(|(_, b)| (a, b)));
    let (before, after) =
        parts.ok_or_else(|| format!("{}: the marks of its {name} are missing", path.display()))?;
    write(path, &format!("{before}{open}{block}{close}{after}"))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Label of one stroke of a drawing.
struct Label {
    stroke: u32,
    class: StrokeClass,
    unsure: bool,
    mixed: bool,
}

/// Measures every labelled drawing of a folder.
fn measure(sketches: &Path) -> Result<Vec<StrokeRow>, String> {
    let drawings = drawings_of(&sketches.join("quickdraw"))?;
    let mut rows = Vec::new();
    for line in json_lines(&sketches.join("labels.ndjson"))? {
        let key = text_of(&line, "key_id");
        let drawing = drawings.get(key).ok_or_else(|| format!("labels.ndjson: there is no drawing {key}"))?;
        let label = |l: &Value| {
            let class = StrokeClass::from_word(text_of(l, "label"));
            let flag = |name: &str| l.get(name).and_then(Value::as_bool).unwrap_or(false);
            let stroke = l.get("stroke").and_then(Value::as_u64).and_then(|s| u32::try_from(s).ok());
            let (class, stroke) = class.zip(stroke).ok_or_else(|| format!("labels.ndjson, {key}: {l}"))?;
            Ok(Label { stroke, class, unsure: flag("unsure"), mixed: flag("mixed") })
        };
        let labels: Vec<Label> = list(line.get("labels")).iter().map(label).collect::<Result<_, String>>()?;
        measure_ink(&mut rows, StrokeSource::Public, text_of(&line, "word"), drawing, &labels);
    }
    for (kind, every, classes) in SPG {
        for line in json_lines(&sketches.join(format!("spg/{kind}.ndjson")))?.iter().step_by(every) {
            let mut seen = [0_usize; 4];
            let labels: Vec<Label> = (0..)
                .zip(list(line.get("drawing")))
                .filter_map(|(stroke, s)| {
                    let marks = list(s.get(2));
                    let count = |k: &u64| marks.iter().filter(|m| m.as_u64() == Some(*k)).count();
                    let (part, class) =
                        (0_u64..).zip(classes).find(|(k, _)| 10 * count(k) >= 9 * marks.len().max(1))?;
                    let seen = seen.get_mut(usize::try_from(part).ok()?)?;
                    *seen += 1;
                    (*seen <= PER_PART).then_some(Label { stroke, class, unsure: false, mixed: false })
                })
                .collect();
            measure_ink(&mut rows, StrokeSource::Parts, kind, &drawing_of(line), &labels);
        }
    }
    for (number, made) in made_sketches().into_iter().enumerate() {
        let (lines, classes): (Vec<_>, Vec<_>) = made.lines.into_iter().unzip();
        let mut seen = [0_usize; 12];
        let labels: Vec<Label> = (0..)
            .zip(classes)
            .filter(|(_, class)| {
                let seen = &mut seen[*class as usize];
                *seen += 1;
                *seen <= PER_PART
            })
            .map(|(stroke, class)| Label { stroke, class, unsure: false, mixed: false })
            .collect();
        let drawing = Drawing::from_polylines(format!("made-{number}"), &lines);
        measure_ink(&mut rows, StrokeSource::Made, made.kind, &drawing, &labels);
    }
    Ok(rows)
}

fn measure_ink(
    rows: &mut Vec<StrokeRow>,
    source: StrokeSource,
    kind: &str,
    drawing: &Drawing,
    labels: &[Label],
) {
    let ink = ink::clean(drawing, &mut base::Report::default());
    for (stroke, features) in ink.strokes.iter().zip(ink::features(&ink, &base::Run::plain())) {
        if let Some(label) = labels.iter().find(|l| l.stroke == stroke.index) {
            rows.push(StrokeRow {
                source,
                kind: kind.replace(' ', "_"),
                drawing: drawing.name.clone(),
                stroke: stroke.index,
                label: label.class,
                unsure: label.unsure,
                mixed: label.mixed,
                features,
            });
        }
    }
}
