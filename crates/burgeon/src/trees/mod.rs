//! Trees: spec -> growth -> plant -> meshes -> report.
//!
//! `TOML | preset -> TreeSpec -> Skeleton -> Plant -> Model, levels of detail`
//!
//! | file | owns |
//! |---|---|
//! | `evaluate` | a tree that changes: only what a change affects is made again |
//! | `file` | TOML input; the places of faults in a text |
//! | `blade`, `look` | forms of leaves; colours and bark |
//! | `presets` | the species that come with the program |
//! | `scanned` | trees of laser scans |
//! | `structured` | trees of files of structure |
//! | `scenery` | obstacles in a picture |
//! | `compare` | one oak by three methods |

mod blade;
mod compare;
mod evaluate;
mod file;
mod height;
mod look;
mod presets;
mod scanned;
mod scenery;
mod structured;

use base::{Cancelled, OverBudget, Report, Run, Seed, Stopped};
use document::PlantEdit;
use glam::DVec3;
use growth::{Grown, GrowthError, Method, Obstacle, Obstacles, TreeSpec};
use makers::LeafTemplate;
use mesh::Model;
use skin::{Layout, SkinSpec};
use spec::SpecFault;

use crate::levels::{LevelSpec, Levels};
use crate::report::{GrowthReport, ItemReport};

pub use blade::tree_blade;
pub use compare::{
    GUIDED_METHODS, OAK_METHODS, PAPER_OAKS, PaperOak, TreeSize, guided_methods, scale_to_height, tree_size,
};
pub use evaluate::TreeEvaluator;
pub(crate) use evaluate::{grow_plant, mesh_plant};
pub use file::{NamedMesh, read_tree_spec, tree_schema};
pub use height::{HeightError, TreeGoal, TreeOfDbh, age_of_height, aim_at, tree_of_dbh};
pub use presets::{PRESETS, Preset};
pub use scanned::{ScanTreeOptions, ScannedTreeError, make_tree_from_scan, make_tree_of_plot};
pub use scenery::show_obstacles;
pub use structured::{StructureModel, StructureModelError, StructureOptions, make_from_structure};

/// Options for meshing a tree. Not saved with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeOptions {
    /// Fineness, sides, textures.
    pub skin: SkinSpec,
    /// Scale the grown wood to this height, metres, above 0; leaves keep their size. Ignored where there are
    /// obstacles, which it would meet. Default none.
    pub height_m: Option<f64>,
    /// The leaf that the tree bears instead of its spec's form. Default none.
    pub leaf: Option<LeafTemplate>,
    /// Coarser copies and other levels to make as well: each has about half of the triangles of the one before.
    pub levels: LevelSpec,
    /// Hand edits, applied to the grown tree in this order.
    pub edits: Vec<PlantEdit>,
    /// Names of the spec's obstacles in messages, in their order; those without a name have their number.
    pub obstacles: Vec<String>,
}

/// A tree with its meshes and its entry of the report.
#[derive(Clone, Debug)]
pub struct MadeTree {
    /// Plant, skeleton and counts.
    pub grown: Grown,
    /// The finest meshes, with materials.
    pub model: Model,
    /// Places of the plant's parts in the model.
    pub layout: Layout,
    /// Coarser meshes.
    pub levels: Levels,
    /// Counts, times, growth, digest, warnings.
    pub item: ItemReport,
}

/// Reason why no tree was made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeError {
    /// The text of a spec is faulty.
    #[error(transparent)]
    Spec(#[from] SpecFault),
    /// Growth cannot follow the spec; the line of its text is known.
    #[error("line {line}: {error}")]
    Line {
        /// Line, from 1.
        line: usize,
        /// The fault.
        error: GrowthError,
    },
    /// A file that a spec names could not be read.
    #[error("the file \"{file}\" that it names cannot be read as what it is named for")]
    File {
        /// Name of the file in the spec.
        file: String,
    },
    /// Growth cannot follow the spec.
    #[error(transparent)]
    Growth(GrowthError),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The result would exceed the budget.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}

impl From<Stopped> for TreeError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(c) => Self::Cancelled(c),
            Stopped::OverBudget(o) => Self::OverBudget(o),
        }
    }
}

impl From<GrowthError> for TreeError {
    fn from(error: GrowthError) -> Self {
        match error {
            GrowthError::Cancelled(c) => Self::Cancelled(c),
            GrowthError::OverBudget(o) => Self::OverBudget(o),
            other => Self::Growth(other),
        }
    }
}

impl GrowthReport {
    fn new(spec: &TreeSpec, grown: &Grown, inside: Option<Inside>) -> Self {
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
            inside_obstacle: inside.map(|i| i.vertices),
            inside_obstacle_depth_m: inside.map(|i| i.depth_m),
        }
    }
}

/// Parts of a model that lie inside obstacles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Inside {
    /// Number of vertices deeper than [`TOUCHING_M`].
    vertices: u64,
    depth_m: f64,
}

/// Depth up to which vertices may lie in what they touch, metres.
const TOUCHING_M: f64 = 0.001;

impl Inside {
    /// Checks every vertex of a model. `None` without obstacles.
    fn measure(model: &Model, obstacles: &Obstacles) -> Option<Self> {
        if obstacles.is_empty() {
            return None;
        }
        let mut found = Self::default();
        for p in model.parts.iter().flat_map(|part| &part.mesh.positions) {
            let depth = obstacles.depth(DVec3::from_array(p.map(f64::from)));
            found.vertices += u64::from(depth > TOUCHING_M);
            found.depth_m = found.depth_m.max(depth);
        }
        Some(found)
    }
}

/// Returns the word of a method in reports and on the command line.
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
/// A spec that names a leaf's file needs [`TreeOptions::leaf`]: the core opens no files. The same spec, options and
/// seed give the same bits on every platform and for any executor. Growth itself is booked as `structure`, wood and
/// leaves as `depth`, skinning as `mesh`.
///
/// # Errors
/// [`TreeError`]: a fault of the spec, or cancelled.
///
/// ```
/// use burgeon::{Run, Seed, TreeOptions, TreeSpec, make_tree};
/// let made = make_tree(&TreeSpec::default(), Seed::new(1), &TreeOptions::default(), &Run::plain())?;
/// let growth = made.item.growth.ok_or(burgeon::Cancelled)?;
/// assert_eq!((growth.method.as_str(), growth.cycles, growth.inside_obstacle), ("competition", 2, None));
/// # Ok::<(), burgeon::TreeError>(())
/// ```
pub fn make_tree(
    spec: &TreeSpec,
    seed: Seed,
    options: &TreeOptions,
    run: &Run<'_>,
) -> Result<MadeTree, TreeError> {
    let mut evaluator = TreeEvaluator::default();
    let mut item = evaluator.update(spec, seed, options, run)?;
    let start = run.clock.now_ms();
    let levels = match evaluator.laid_out() {
        Some(finest) => Levels::new(&options.levels, finest, |level| evaluator.laid_out_at(level, run), run)?,
        None => Levels::default(),
    };
    if !levels.lods.is_empty() {
        let ms = run.clock.now_ms() - start;
        item.timings_ms.mesh += ms;
        item.timings_ms.total += ms;
    }
    let (grown, model, layout) = evaluator.take().ok_or(Cancelled)?; // update succeeded: all are there
    Ok(MadeTree { grown, model, layout, levels, item })
}

/// An obstacle that does not bound a volume; it is accepted all the same.
#[derive(Clone, Copy, Debug)]
struct OddMesh {
    obstacle: usize,
    /// Edges with only one face; 0 where the faces point inwards.
    open: usize,
}

impl OddMesh {
    fn check(obstacle: usize, shape: &Obstacle) -> Option<Self> {
        let Obstacle::Mesh { vertices, triangles } = shape else { return None };
        let open = growth::open_edges(vertices, triangles);
        (open > 0 || growth::signed_volume(vertices, triangles) < 0.0).then_some(Self { obstacle, open })
    }

    /// Warns of it. `names`: of all obstacles that have one.
    fn tell(self, names: &[String], report: &mut Report) {
        let name = names.get(self.obstacle).filter(|n| !n.is_empty());
        let obstacle = name.cloned().unwrap_or_else(|| (self.obstacle + 1).to_string());
        let open = self.open;
        if open > 0 {
            base::warn!(
                report,
                "obstacle-open",
                { obstacle = obstacle, edges = open },
                "obstacle {obstacle} is an open mesh ({edges} edges have one face only): what is inside was found by its \
                 winding number, so growth may enter through large holes"
            );
        } else {
            base::warn!(
                report,
                "obstacle-inverted",
                { obstacle = obstacle },
                "the faces of obstacle {obstacle} look inwards; its inside was taken as solid all the same"
            );
        }
    }
}

impl TreeError {
    /// Returns the same error, with the names of the obstacles.
    fn naming(self, names: &[String]) -> Self {
        let Self::Growth(mut error) = self else { return self };
        if let GrowthError::Obstacle { obstacle, name, .. }
        | GrowthError::RootInObstacle { obstacle, name, .. } = &mut error
            && let Some(called) = names.get(*obstacle).filter(|n| !n.is_empty())
        {
            name.clone_from(called);
        }
        Self::Growth(error)
    }
}

base::coded!(TreeError {
    Self::Line { line, error } => "tree-line" { line, why = error => GrowthError },
    Self::File { file } => "tree-file" { file },
} wraps {
    Self::Spec(e) => e, SpecFault;
    Self::Growth(e) => e, GrowthError;
    Self::Cancelled(e) => e, Cancelled;
    Self::OverBudget(e) => e, OverBudget;
});

#[cfg(test)]
mod tests;
