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

use burgeon::{HeightError, Preset, Seed, TreeEvaluator, TreeOptions, TreeSpec};
use wasm_bindgen::prelude::*;

pub use asked::{Asked, Refused, SkinAsked, TreeAsked};
pub use made::{Made, parts};
#[cfg(feature = "makers")]
pub use makers::*;
pub use view::*;

use crate::asked::{from_json, refused};

/// A tree that is asked for.
#[wasm_bindgen]
#[derive(Debug)]
pub struct GrowingTree {
    asked: TreeAsked,
    spec: TreeSpec,
    preset: Option<&'static str>,
    seed: Seed,
    options: TreeOptions,
    tree: TreeEvaluator,
}

/// Reads what is asked of a tree: `TreeAsked` as JSON.
///
/// # Errors
/// The fault of the request, as `Refusal` in JSON.
#[wasm_bindgen]
pub fn grow(asked: &str, seed: u64) -> Result<GrowingTree, Refused> {
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
    let mut spec = asked.common.spec(&base)?;
    let (skin, seed) = (asked.common.skin()?, Seed::new(seed));
    let height_m = match asked.goal()? {
        Some(goal) => {
            let height = asked.common.computed(|run| burgeon::aim_at(&mut spec, seed, goal, run))?;
            Some(height.map_err(|e| match e {
                HeightError::Tree(e) => refused(&e),
                e => Refused::plain(goal.word(), format!("{}: {e}", goal.word())),
            })?)
        }
        None => asked.height_m.map(|h| asked::number("height_m", h, (0.001, 1000.0))).transpose()?,
    };
    let options = TreeOptions { skin, height_m, ..TreeOptions::default() };
    Ok(GrowingTree { asked, spec, preset, seed, options, tree: TreeEvaluator::default() })
}

#[wasm_bindgen]
impl GrowingTree {
    /// Makes a coarse copy of a large tree, without textures: it is ready long before the whole, which then takes as much less
    /// time.
    ///
    /// # Errors
    /// The fault of the request, as `Refusal` in JSON.
    pub fn first(&mut self) -> Result<Option<Made>, Refused> {
        let Self { asked, spec, seed, options, tree, .. } = self;
        let look = asked.common.run(|run| tree.preview_unedited(spec, *seed, options, run))?;
        look.map(|look| Made::from_look(look, self.preset)).transpose()
    }

    /// Makes the tree; equal whether there was a first copy or none.
    ///
    /// # Errors
    /// The fault of the request, as `Refusal` in JSON.
    pub fn whole(self) -> Result<Made, Refused> {
        let Self { asked, spec, preset, seed, options, mut tree } = self;
        let item = asked.common.run(|run| tree.update_unedited(&spec, seed, &options, run))?;
        Made::from_tree(tree, (item, preset), &asked.common)
    }
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
