//! What can stop growth.

use base::Cancelled;

/// Why nothing could be grown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GrowthError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// It would have been too much.
    #[error(transparent)]
    OverBudget(#[from] base::OverBudget),
    /// A step is much longer than all that is to be grown.
    #[error(
        "steps of {step_m} m (step_m, or half of kill_m) are far longer than roots and attraction points are apart, \
         {space_m} m; make steps or kill_m shorter, or the envelope larger"
    )]
    StepTooLong {
        /// The step, metres.
        step_m: f64,
        /// Diagonal of the box around roots and points, metres, to a millimetre.
        space_m: f64,
    },
    /// A number of the spec is out of the range that its schema has.
    #[error(transparent)]
    Range(#[from] spec::RangeFault),
    /// Something of the spec does not go with the rest of it, or is no place or direction.
    #[error("{field} must be {range}, not {value}")]
    Field {
        /// The field.
        field: &'static str,
        /// What it must be.
        range: &'static str,
        /// The value given.
        value: f64,
    },
    /// There is no root to grow from.
    #[error("nothing to grow from: no roots were given")]
    NoRoots,
    /// A root is not a finite point.
    #[error("root {root} is not a finite point within 1e6 m of the origin")]
    Root {
        /// Its index.
        root: usize,
    },
    /// A root stands in an obstacle.
    #[error("root {root} stands inside obstacle {obstacle}; move one of them")]
    RootInObstacle {
        /// Index of the root.
        root: usize,
        /// Index of the obstacle.
        obstacle: usize,
    },
    /// Something is wrong with an obstacle.
    #[error("obstacle {obstacle} ({name}): {fault}")]
    Obstacle {
        /// Its index.
        obstacle: usize,
        /// The word of its shape, or its file.
        name: String,
        /// What is wrong.
        fault: Box<Self>,
    },
    /// Nothing grew.
    #[error("nothing grew: {why}")]
    Nothing {
        /// The cause, and what to change.
        why: String,
    },
    /// A mesh cannot bound anything.
    #[error("mesh: {0}")]
    Mesh(#[from] MeshFault),
    /// The rules of an L-system are at fault.
    #[error(transparent)]
    Lsystem(#[from] LsystemError),
    /// The envelope has hardly any room for attractors.
    #[error(
        "the envelope is empty or almost so: {found} of {wanted} points found a place in {tries} tries; \
         make it larger or free it of obstacles"
    )]
    NoRoom {
        /// Points placed.
        found: usize,
        /// Points wanted.
        wanted: usize,
        /// Points tried.
        tries: usize,
    },
}

/// What is wrong with a mesh that should bound a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// No triangle with an area.
    #[error("it has no triangle with an area")]
    Empty,
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {vertex}, but there are {vertices}")]
    Index {
        /// The triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A vertex is not a finite point.
    #[error("vertex {vertex} is not a finite point within 1e6 m of the origin")]
    Vertex {
        /// The vertex.
        vertex: usize,
    },
}

/// Farther than this from the origin nothing grows: 1e6 m leaves a tenth of a nanometre of resolution.
pub(crate) const FAR_M: f64 = 1e6;

/// Fails unless `value` lies in `lo..=hi`.
pub(crate) fn within(
    field: &'static str,
    value: f64,
    lo: f64,
    hi: f64,
    range: &'static str,
) -> Result<f64, GrowthError> {
    if (lo..=hi).contains(&value) { Ok(value) } else { Err(GrowthError::Field { field, range, value }) }
}

/// What is wrong with an L-system.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LsystemError {
    /// A line cannot be read.
    #[error("line {line}: {why}")]
    Syntax {
        /// From 1.
        line: usize,
        /// What was expected.
        why: String,
    },
    /// There is no axiom.
    #[error("there is no axiom: a line `axiom = ...` is needed")]
    NoAxiom,
    /// The string explodes.
    #[error(
        "the rule `{rule}` in line {line} lets the string explode: in step {step} it had written {made} modules when \
         the limit of {most} was passed; take fewer steps or a condition that ends it"
    )]
    TooLarge {
        /// The rule that wrote most.
        rule: String,
        /// Its line, from 1.
        line: usize,
        /// The step of rewriting.
        step: u32,
        /// Modules that it wrote in this step.
        made: usize,
        /// The limit.
        most: usize,
    },
    /// No rule ever had a module to rewrite.
    #[error(
        "nothing grew: no rule matches a module in any step. There is {there}; the rules are for {rules}. A rule \
         matches a module of its name with as many numbers as it has parameters, where its `if` holds"
    )]
    NoMatch {
        /// The modules that were left, with their counts of numbers.
        there: String,
        /// What the rules are for.
        rules: String,
    },
    /// A number of a module is not finite.
    #[error("the rule `{rule}` in line {line} gives a number that is not finite")]
    NotFinite {
        /// The rule.
        rule: String,
        /// Its line, from 1; 0 for the axiom.
        line: usize,
    },
}

impl LsystemError {
    /// The same error where the rules start in line `first` of a longer text: its lines count from the start of that.
    #[must_use]
    pub fn from_line(mut self, first: usize) -> Self {
        if let Self::Syntax { line, .. } | Self::TooLarge { line, .. } | Self::NotFinite { line, .. } =
            &mut self
            && *line > 0
        {
            *line += first - first.min(1);
        }
        self
    }
}

/// Finite and not absurdly far away.
pub(crate) fn usable(p: glam::DVec3) -> bool {
    p.is_finite() && p.abs().max_element() <= FAR_M
}

base::coded!(GrowthError {
    Self::StepTooLong { step_m, space_m } => "step-too-long" { step_m, space_m },
    Self::Field { field, range, value } => "field-range" { field, range, value },
    Self::NoRoots => "no-roots" {},
    Self::Root { root } => "root-far" { root },
    Self::RootInObstacle { root, obstacle } => "root-in-obstacle" { root, obstacle },
    Self::Obstacle { name, fault, .. } => "obstacle" { name, why = fault => GrowthError },
    Self::Nothing { why } => "nothing-grew" { why },
    Self::Mesh(why) => "mesh" { why => MeshFault },
    Self::Lsystem(why) => "lsystem" { why },
    Self::NoRoom { found, wanted, .. } => "no-room" { found, wanted },
} wraps {
    Self::Range(e) => e, spec::RangeFault;
    Self::Cancelled(e) => e, Cancelled;
    Self::OverBudget(e) => e, base::OverBudget;
});

base::coded!(MeshFault {
    Self::Empty => "mesh-empty" {},
    Self::Index { triangle, vertex, vertices } => "mesh-index" { triangle, vertex, vertices },
    Self::Vertex { vertex } => "mesh-vertex" { vertex },
});
