//! `cargo xtask gallery`: makes every fixture drawing and writes docs/table1.md and docs/gallery.md with
//! the pictures and the figures of that run.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use xtask::shell::{Outcome, built_burgeon, burgeon, command, repository, say, target_dir};

/// Table 1 of He and Cheng (2021): strokes, leaves or petals, branches, triangles, milliseconds.
const PAPER: [(&str, [u32; 5]); 8] = [
    ("a", [15, 0, 56, 29_888, 145]),
    ("b", [7, 6, 1, 5_132, 148]),
    ("c", [13, 34, 7, 20_558, 236]),
    ("d", [22, 19, 3, 11_972, 188]),
    ("e", [31, 27, 4, 10_464, 230]),
    ("f", [27, 16, 21, 13_360, 217]),
    ("g", [31, 142, 22, 67_918, 1711]),
    ("h", [25, 126, 13, 37_528, 967]),
];

/// Makes the pictures and writes both pages.
pub(crate) fn run() -> Outcome {
    built_burgeon()?;
    let mut page = String::from(
        "# The eight sketches of Table 1\n\n\
         He and Cheng (2021) report on eight drawings by users. Their drawings are not published, so we drew\n\
         our own of the same composition. Each cell reads *ours / the paper's*.\n\n\
         `cargo xtask gallery` makes the models, the pictures and this page. Times are for one run of the\n\
         command line, from strokes in memory to meshes in memory ([performance](performance.md) has the\n\
         benchmark).\n\n\
         | | drawing | model | strokes | leaves or petals | branches | triangles | time, ms |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for (name, [strokes, blades, branches, triangles, ms]) in PAPER {
        let item = make(&format!("table1/{name}"))?;
        let counts = &item["counts"];
        let count = |key: &str| counts[key].as_u64().unwrap_or_default();
        let times = &item["timings_ms"];
        let time = |key: &str| times[key].as_f64().unwrap_or_default();
        let core = time("total") - time("read") - time("write");
        let _ = writeln!(
            page,
            "| {name} | <img src=\"../fixtures/sketches/table1/{name}.svg\" width=\"150\"> | \
             <img src=\"pictures/table1/{name}.png\" width=\"260\"> | {} / {strokes} | {} / {blades} | {} / {branches} | \
             {} / {triangles} | {core:.1} / {ms} |",
            item["strokes"].as_array().map_or(0, Vec::len),
            count("leaves") + count("petals"),
            count("branches"),
            count("triangles"),
        );
    }
    write(&repository().join("docs/table1.md"), &page)?;

    let mut page = String::from(
        "# Gallery\n\n\
         These are drawings of this repository and what `burgeon sketch` makes of them with default\n\
         settings. The eight drawings of [Table 1](table1.md) come last. `cargo xtask gallery` writes this\n\
         page.\n\n\
         | drawing | model | what was recognised |\n|---|---|---|\n",
    );
    let own = names_in("fixtures/sketches/gallery")?.into_iter();
    let mut names: Vec<String> = own.map(|name| format!("gallery/{name}")).collect();
    names.extend(PAPER.iter().map(|(name, _)| format!("table1/{name}")));
    for name in &names {
        let item = make(name)?;
        let _ = writeln!(
            page,
            "| <img src=\"../fixtures/sketches/{name}.svg\" width=\"180\"> | \
             <img src=\"pictures/{name}.png\" width=\"320\"> | {} |",
            summary(&item)
        );
    }
    page.push_str(
        "\nSeveral plants in one drawing:\n\n\
         | drawing | model | what was recognised |\n|---|---|---|\n",
    );
    for name in names_in("docs/scenes")? {
        let item = made(&format!("docs/scenes/{name}.svg"), &format!("scenes/{name}"))?;
        let plants = item["readings"][0]["plants"].as_u64().unwrap_or(1);
        let _ = writeln!(
            page,
            "| <img src=\"scenes/{name}.svg\" width=\"180\"> | \
             <img src=\"pictures/scenes/{name}.png\" width=\"320\"> | {}{} |",
            if plants > 1 { format!("{plants} plants, ") } else { String::new() },
            summary(&item)
        );
    }
    write(&repository().join("docs/gallery.md"), &page)?;
    make("sample")?;
    say(&format!("docs/table1.md and docs/gallery.md: {} drawings", names.len()));
    Ok(())
}

fn write(path: &Path, text: &str) -> Outcome {
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Returns the names of the files in a folder of the repository, without their endings.
fn names_in(folder: &str) -> Outcome<Vec<String>> {
    let folder = repository().join(folder);
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut names: Vec<String> =
        entries.filter_map(|e| Some(e.ok()?.path().file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    Ok(names)
}

/// Makes one fixture, with its picture in docs/pictures, and returns the report's item.
fn make(name: &str) -> Outcome<Value> {
    made(&format!("fixtures/sketches/{name}.svg"), name)
}

/// Makes any drawing of the repository as [`make`] does; `name`: of its picture.
fn made(drawing: &str, name: &str) -> Outcome<Value> {
    let root = repository();
    let picture = root.join(format!("docs/pictures/{name}.png"));
    let scratch = target_dir().join("gallery");
    for folder in [picture.parent(), Some(scratch.as_path())].into_iter().flatten() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    let report = scratch.join("report.json");
    let as_text = |p: &Path| p.to_string_lossy().into_owned();
    command(
        burgeon("release"),
        &[
            "sketch",
            drawing,
            "-o",
            &as_text(&scratch.join("model.glb")),
            "--png",
            &as_text(&picture),
            "--size",
            "480x560",
            "--report",
            &as_text(&report),
            "--quiet",
        ],
    )?;
    let text = std::fs::read_to_string(&report).map_err(|e| format!("{}: {e}", report.display()))?;
    let mut json: Value = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", report.display()))?;
    Ok(json["items"][0].take())
}

/// Returns one line about a plant: its name, and counts that are not 0.
fn summary(item: &Value) -> String {
    let counts = &item["counts"];
    let words = [
        ("flower", "flowers"),
        ("petal", "petals"),
        ("leaf", "leaves"),
        ("branch", "branches"),
        ("triangle", "triangles"),
    ];
    let parts = words.into_iter().filter_map(|(one, many)| {
        let n = counts[many].as_u64().filter(|&n| n > 0)?;
        Some(format!("{n} {}", if n == 1 { one } else { many }))
    });
    format!(
        "{} strokes: {}",
        item["strokes"].as_array().map_or(0, Vec::len),
        parts.collect::<Vec<_>>().join(", ")
    )
}
