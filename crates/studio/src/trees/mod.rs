//! Trees: spec -> growth -> plant -> meshes -> report.
//!
//! `TOML | preset -> TreeSpec -> Skeleton -> Plant -> Model, levels of detail`
//!
//! | file | owns |
//! |---|---|
//! | `spec` | [`TreeSpec`]: everything that a user may ask of a tree |
//! | `file` | TOML in, JSON Schema out |
//! | `blade`, `look` | forms of leaves; colours and bark |
//! | `presets` | the species that come with the program |
//! | `lod` | coarser copies for far away |
//! | `compare` | one oak by three methods |

mod blade;
mod compare;
mod file;
mod lod;
mod look;
mod presets;
mod spec;

use base::{Cancelled, Report, Run, Seed};
use growth::{Grown, GrowthError, Method, Obstacle};
use mesh::Model;
use serde::{Deserialize, Serialize};
use shape::HandEdit;
use skin::SkinSpec;

use crate::report::{Counts, ItemReport, TimingsMs};
use crate::shaping::shape_plant;

pub use blade::{BladeForm, BladeSpec};
pub use compare::{OAK_METHODS, PAPER_OAKS, PaperOak, TreeSize, scale_to_height, tree_size};
pub use file::{NamedMesh, read_tree_spec, tree_schema};
pub use lod::coarser;
pub use look::{Bark, Colour, Look};
pub use presets::{PRESETS, Preset};
pub use spec::TreeSpec;

/// How a tree is meshed. Not saved with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeOptions {
    /// Fineness, sides, textures.
    pub skin: SkinSpec,
    /// Scale the grown wood to this height, metres, above 0; leaves keep their size. Ignored where there are
    /// obstacles, which it would meet. Default none.
    pub height_m: Option<f64>,
    /// Coarser copies to make as well, 0 to 6: each has about a third of the triangles of the one before.
    pub lods: u32,
    /// Edits by hand, done on the grown tree in this order.
    pub edits: Vec<HandEdit>,
}

/// A tree with its meshes and its entry of the report.
#[derive(Clone, Debug)]
pub struct MadeTree {
    /// Plant, skeleton and counts.
    pub grown: Grown,
    /// The finest meshes, with materials.
    pub model: Model,
    /// Coarser ones, finest first.
    pub lods: Vec<Model>,
    /// Counts, times, growth, digest, warnings.
    pub item: ItemReport,
}

/// Why no tree came out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeError {
    /// The text of a spec is at fault.
    #[error("line {line}: {message}")]
    Spec {
        /// From 1.
        line: usize,
        /// What is wrong.
        message: String,
    },
    /// A file that a spec names could not be had.
    #[error("the file \"{file}\" that it names cannot be read as a mesh or points")]
    File {
        /// As the spec names it.
        file: String,
    },
    /// Growth cannot follow the spec.
    #[error(transparent)]
    Growth(GrowthError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<GrowthError> for TreeError {
    fn from(error: GrowthError) -> Self {
        match error {
            GrowthError::Cancelled(c) => Self::Cancelled(c),
            other => Self::Growth(other),
        }
    }
}

/// The part of a report about growth.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct GrowthReport {
    /// `competition`, `colonization`, `self-organizing`, `guided` or `lsystem`.
    pub method: String,
    /// Attraction points or markers of all cycles.
    pub attractors: u64,
    /// Of these, consumed.
    pub consumed: u64,
    /// Of these, never reached.
    pub unreachable: u64,
    /// Rounds, years or rewriting steps.
    pub iterations: u64,
    /// Life cycles.
    pub cycles: u64,
    /// Joints of the skeleton.
    pub nodes: u64,
    /// Places for leaves.
    pub leaves_placed: u64,
    /// Leaves on the tree.
    pub leaves_kept: u64,
    /// Branch nodes and leaves in obstacles: 0 unless something is wrong.
    pub inside_obstacle: u64,
}

impl GrowthReport {
    fn of(spec: &TreeSpec, grown: &Grown) -> Self {
        let t = &grown.tally;
        Self {
            method: method_word(&spec.method).to_owned(),
            attractors: t.attractors as u64,
            consumed: t.consumed as u64,
            unreachable: t.unreachable as u64,
            iterations: u64::from(t.iterations),
            cycles: u64::from(t.cycles),
            nodes: grown.skeleton.len() as u64,
            leaves_placed: grown.leaves.placed as u64,
            leaves_kept: grown.leaves.kept as u64,
            inside_obstacle: (grown.nodes_in_obstacles + grown.leaves_in_obstacles) as u64,
        }
    }
}

/// The word of a method in reports and on the command line.
pub fn method_word(method: &Method) -> &'static str {
    match method {
        Method::Colonization { .. } | Method::Points { .. } => "colonization",
        Method::Competition(_) => "competition",
        Method::SelfOrganizing(_) => "self-organizing",
        Method::Guided(_) => "guided",
        Method::Lsystem { .. } => "lsystem",
        _ => "other",
    }
}

/// Grows a tree (or several that compete) and gives it its surface.
///
/// The same spec, options and seed give the same bits on every platform and for any executor. Growth itself is
/// booked as `structure`, wood and leaves as `depth`, skinning as `mesh`.
///
/// # Errors
/// [`TreeError`]: whatever is wrong with the spec, or cancelled.
///
/// ```
/// use burgeon::{Run, Seed, TreeOptions, TreeSpec, make_tree};
/// let made = make_tree(&TreeSpec::default(), Seed::new(1), &TreeOptions::default(), &Run::plain())?;
/// let growth = made.item.growth.ok_or(burgeon::Cancelled)?;
/// assert_eq!((growth.method.as_str(), growth.cycles, growth.inside_obstacle), ("competition", 2, 0));
/// # Ok::<(), burgeon::TreeError>(())
/// ```
pub fn make_tree(
    spec: &TreeSpec,
    seed: Seed,
    options: &TreeOptions,
    run: &Run<'_>,
) -> Result<MadeTree, TreeError> {
    let mut told = Report::default();
    look_at_meshes(&spec.obstacles, &mut told);
    let wanted = spec.growth()?;
    let mut grown = growth::grow(&wanted, Some(spec.blade.blade()), seed, run, &mut told)?;
    spec.look.tint(&mut grown.plant, seed);
    if let Some(height) = options.height_m.filter(|_| spec.obstacles.is_empty()) {
        scale_to_height(&mut grown, height);
    }
    let mut edits = Vec::new();
    if !options.edits.is_empty() {
        let obstacles = growth::Obstacles::new(&wanted.obstacles, wanted.clearance_m)?;
        let context = shape::Context { pipe_exponent: None, obstacles };
        edits =
            told.stage("shape", run.clock, |_| shape_plant(&mut grown.plant, &options.edits, &context, run))?;
    }
    let skin_spec = SkinSpec { seed, ..options.skin.clone() };
    let mut report = Report::default();
    for stage in &told.stages {
        report.book(if stage.name == "grow" { "structure" } else { "depth" }, stage.ms);
    }
    let mesh = |plant: &plant::Plant, skin_spec: &SkinSpec| {
        skin::skin(plant, skin_spec, run).map(|mut model| {
            spec.look.paint(&mut model);
            model
        })
    };
    let model = report.stage("mesh", run.clock, |_| mesh(&grown.plant, &skin_spec))?;
    let lods = (1..=options.lods.min(6)).map(|level| {
        let (plant, skin_spec) = coarser(&grown.plant, &skin_spec, level);
        mesh(&plant, &skin_spec)
    });
    let lods = lods.collect::<Result<Vec<_>, _>>()?;
    let growth = GrowthReport::of(spec, &grown);
    // Some points are always out of reach where they are scattered; it is news only when they were given, or most.
    let given = matches!(spec.method, Method::Points { .. });
    let many = 2 * growth.unreachable > growth.attractors;
    let mut warnings = told.warnings.iter().filter(|w| given || many || w.code != "attractors-unreached");
    let item = ItemReport {
        name: spec.name.clone(),
        counts: Counts {
            vertices: model.vertex_count() as u64,
            triangles: model.triangle_count() as u64,
            ..Counts::of_plant(&grown.plant)
        },
        timings_ms: TimingsMs::from_report(&report),
        digest: grown.plant.digest_hex(),
        warnings: warnings.by_ref().map(ToString::to_string).collect(),
        growth: Some(growth),
        edits,
        ..ItemReport::default()
    };
    Ok(MadeTree { grown, model, lods, item })
}

/// Warns of obstacles that do not bound a volume; they are borne all the same.
fn look_at_meshes(obstacles: &[Obstacle], report: &mut Report) {
    for (i, obstacle) in obstacles.iter().enumerate() {
        let Obstacle::Mesh { vertices, triangles } = obstacle else { continue };
        let open = growth::open_edges(vertices, triangles);
        if open > 0 {
            report.warn(
                "obstacle-open",
                format!(
                    "obstacle {i} is an open mesh ({open} edges have one face only): what is inside was found by its \
                     winding number, so growth may enter through large holes"
                ),
            );
        } else if growth::signed_volume(vertices, triangles) < 0.0 {
            report.warn(
                "obstacle-inverted",
                format!("the faces of obstacle {i} look inwards; its inside was taken as solid all the same"),
            );
        }
    }
}

#[cfg(test)]
mod tests;
