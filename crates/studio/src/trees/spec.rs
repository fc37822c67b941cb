//! What a user asks of a tree: a TOML file, or the panels of the Studio.

use glam::DVec3;
use growth::{GrowthError, LeafSpec, Method, Obstacle, WoodSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::blade::BladeSpec;
use super::blossom::BlossomSpec;
use super::look::Look;

/// A kind of tree, where it stands and how it looks. Metres, degrees, +Y up; saved as TOML.
///
/// Every number's unit (`x-unit`), range and default are in the JSON Schema that [`tree_schema`](super::tree_schema)
/// writes.
///
/// ```
/// let spec = burgeon::read_tree_spec("name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 300", &|_| None)?;
/// assert_eq!((spec.name.as_str(), spec.roots.len(), spec.bare), ("bush", 1, false));
/// # Ok::<(), burgeon::TreeError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TreeSpec {
    /// For files and reports.
    pub name: String,
    /// Scientific name; may be empty.
    pub species: String,
    /// One line about it.
    pub about: String,
    /// Where trees of this kind stand, metres; they compete. Default one at the origin.
    #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
    pub roots: Vec<DVec3>,
    /// What they grow around; meshes may be named by `file`, in metres, +Y up. Default nothing.
    pub obstacles: Vec<Obstacle>,
    /// Distance that bark keeps from obstacles where there is room, metres, 0 to 1e6, default 0.05; leaves may touch.
    #[schemars(range(min = 0.0, max = 1e6), extend("x-unit" = "m"))]
    pub clearance_m: f64,
    /// The trees as they were after so many rounds, years (self-organising) or rewriting steps (L-systems); default
    /// none: to the end.
    pub age: Option<u32>,
    /// How they grow.
    pub method: Method,
    /// How skeletons become wood.
    pub wood: WoodSpec,
    /// How leaves stand, and how many fall.
    pub leaves: LeafSpec,
    /// No leaves at all: a dead or winter tree. Default false.
    pub bare: bool,
    /// The form of a leaf.
    pub blade: BladeSpec,
    /// Flowers in the place of some leaves. Default none.
    pub blossom: BlossomSpec,
    /// Colours and bark.
    pub look: Look,
}

impl Default for TreeSpec {
    fn default() -> Self {
        let plain = growth::TreeSpec::default();
        Self {
            name: plain.name,
            species: String::new(),
            about: String::new(),
            roots: plain.roots,
            obstacles: plain.obstacles,
            clearance_m: plain.clearance_m,
            age: plain.age,
            method: plain.method,
            wood: plain.wood,
            leaves: LeafSpec::default(),
            bare: false,
            blade: BladeSpec::default(),
            blossom: BlossomSpec::default(),
            look: Look::default(),
        }
    }
}

impl TreeSpec {
    /// The part that growth reads.
    ///
    /// # Errors
    /// [`GrowthError::Field`] for numbers of blade and look that are out of range; growth checks its own.
    pub(super) fn growth(&self) -> Result<growth::TreeSpec, GrowthError> {
        self.blade.check()?;
        self.blossom.check()?;
        self.look.check()?;
        Ok(growth::TreeSpec {
            name: self.name.clone(),
            roots: self.roots.clone(),
            obstacles: self.obstacles.clone(),
            clearance_m: self.clearance_m,
            age: self.age,
            method: self.method.clone(),
            wood: self.wood.clone(),
            leaves: (!self.bare).then(|| self.leaves.clone()),
        })
    }
}

/// Fails unless `value` lies in `lo..=hi`.
pub(super) fn within(
    field: &'static str,
    value: f64,
    lo: f64,
    hi: f64,
    range: &'static str,
) -> Result<(), GrowthError> {
    if (lo..=hi).contains(&value) { Ok(()) } else { Err(GrowthError::Field { field, range, value }) }
}
