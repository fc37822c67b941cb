//! `burgeon presets`: the species that come with the program.

use burgeon::bloom::{self, FlowerSpec};
use burgeon::{PRESETS, Preset, TreeSpec, method_word, tree_schema};
use serde::Serialize;

use crate::args::PresetsArgs;
use crate::failure::{Failure, Outcome};
use crate::{output, say};

/// One row of the list.
#[derive(Serialize)]
struct Row {
    preset: &'static str,
    species: String,
    /// Method of growth; `flower` for those that `bloom run` opens.
    method: &'static str,
    about: String,
}

/// Describes a flower that opens, from the first lines of its file.
fn flower(key: &'static str) -> Row {
    let text = bloom::preset_text(key).unwrap_or_default();
    let said: Vec<&str> = text.lines().map_while(|l| l.strip_prefix("# ")).collect();
    let said = said.join(" ");
    let about = said.split(". Lengths").next().unwrap_or_default();
    Row { preset: key, species: key.into(), method: "flower", about: about.into() }
}

pub(crate) fn presets(args: &PresetsArgs) -> Outcome {
    let out = |text: &str| {
        say::data(text).map_err(|e| Failure::io(std::path::Path::new("standard output"), "written", &e))
    };
    let shown = args.show.as_deref().map(|key| {
        let tree = Preset::find(key).map(|p| p.toml);
        tree.or_else(|| bloom::preset_text(key)).ok_or_else(|| {
            let known = PRESETS.iter().map(|p| p.key).chain(FlowerSpec::PRESETS.iter().copied());
            let hint = burgeon::meant(key, known);
            Failure::Bad(format!("there is no preset `{key}`; `burgeon presets` lists them{hint}"))
        })
    });
    let shown = shown.transpose()?;
    if let Some(path) = &args.schema {
        let text = serde_json::to_string_pretty(&tree_schema())
            .map_err(|e| Failure::Bug(format!("the schema cannot be written as JSON: {e}")))?;
        output::write_one("--schema", path, |file| Ok(writeln!(file, "{text}")?))?;
    }
    if let Some(preset) = shown {
        return out(preset.trim_end());
    }
    if args.schema.is_some() && !args.json {
        return Ok(());
    }
    let row = |preset: &Preset| -> Outcome<Row> {
        let spec: TreeSpec =
            preset.spec().map_err(|e| Failure::Bug(format!("preset {}: {e}", preset.key)))?;
        let method = method_word(&spec.method);
        Ok(Row { preset: preset.key, species: spec.species, method, about: spec.about })
    };
    let mut rows = PRESETS.iter().map(row).collect::<Outcome<Vec<_>>>()?;
    rows.extend(FlowerSpec::PRESETS.iter().map(|key| flower(key)));
    if args.json {
        let text = serde_json::to_string_pretty(&rows).map_err(|e| Failure::Bug(e.to_string()))?;
        return out(&text);
    }
    let line = |r: &Row| format!("{:<17}{:<16} {} ({})", r.preset, r.method, r.about, r.species);
    out(&rows.iter().map(line).collect::<Vec<_>>().join("\n"))
}
