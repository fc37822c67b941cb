//! Burgeon for npm: parses, converts, calls. No algorithms.
//!
//! | module | owns |
//! |---|---|
//! | `asked` | requests and their errors |
//! | `made` | [`Made`]: a plant and its levels, as columns |
//! | `view` | description of a plant for JavaScript; its types are `apps/npm/lib/wire.ts` |
//! | `makers`, a feature | drawings, leaves, flowers; without it only trees, in half of the download |

mod asked;
mod host;
mod made;
#[cfg(feature = "makers")]
mod makers;
mod view;

use burgeon::{Preset, Seed, TreeEvaluator, TreeOptions, TreeSpec};
use wasm_bindgen::prelude::*;

pub use asked::{Asked, Refused, SkinAsked, TreeAsked};
pub use made::{Made, parts};
#[cfg(feature = "makers")]
pub use makers::*;
pub use view::*;

use crate::asked::{from_json, refused};

/// Grows a tree: `TreeAsked` as JSON.
///
/// # Errors
/// The fault of the request, as `Refusal` in JSON.
#[wasm_bindgen]
pub fn grow(asked: &str, seed: u64) -> Result<Made, Refused> {
    host::tell_of_panics();
    let asked: TreeAsked = from_json(asked)?;
    let (base, preset) = match (&asked.preset, &asked.toml) {
        (Some(word), _) => {
            let known = || burgeon::PRESETS.iter().map(|p| p.key).collect::<Vec<_>>().join(", ");
            let preset = Preset::find(word).ok_or_else(|| Refused::choice("preset", word, &known()))?;
            (preset.spec().map_err(|e| refused(&e))?, Some(preset.key))
        }
        // A spec names files, and there are none here.
        (None, Some(text)) => {
            (burgeon::read_tree_spec(text, &|_name| None).map_err(|e| refused(&e.in_text(text)))?, None)
        }
        (None, None) => (TreeSpec::default(), None),
    };
    let spec = asked.common.spec(&base)?;
    let (skin, seed) = (asked.common.skin()?, Seed::new(seed));
    let height_m = asked.height_m.map(|h| asked::number("height_m", h, (0.001, 1000.0))).transpose()?;
    let options = TreeOptions { skin, height_m, ..TreeOptions::default() };
    let mut tree = TreeEvaluator::default();
    let item = asked.common.run(|run| tree.update_unedited(&spec, seed, &options, run))?;
    Made::of_tree(tree, (item, preset), &asked.common)
}

/// Returns the keys of trees, and of flowers if there are any.
#[wasm_bindgen]
pub fn presets() -> String {
    let trees: Vec<&str> = burgeon::PRESETS.iter().map(|p| p.key).collect();
    #[cfg(feature = "makers")]
    let flowers: &[&str] = burgeon::bloom::FlowerSpec::PRESETS;
    #[cfg(not(feature = "makers"))]
    let flowers: &[&str] = &[];
    serde_json::json!({ "trees": trees, "flowers": flowers }).to_string()
}

/// Returns the JSON Schema of a maker's options: `tree` or `skin`, with `makers` also `sketch`, `leaf`, `flower`.
///
/// # Errors
/// There is no such maker.
#[wasm_bindgen]
pub fn schema(maker: &str) -> Result<String, Refused> {
    let found = match maker {
        "tree" => burgeon::tree_schema(),
        "skin" => burgeon::skin_schema(),
        #[cfg(feature = "makers")]
        "sketch" => burgeon::sketch_schema(),
        #[cfg(feature = "makers")]
        "leaf" => burgeon::leaf_schema(),
        #[cfg(feature = "makers")]
        "flower" => burgeon::flower_schema(),
        other => {
            let known =
                if cfg!(feature = "makers") { "tree, skin, sketch, leaf, flower" } else { "tree, skin" };
            return Err(Refused::choice("maker", other, known));
        }
    };
    Ok(found.to_string())
}
