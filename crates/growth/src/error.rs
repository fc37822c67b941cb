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
    Lsystem(#[from] crate::LsystemError),
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

/// Finite and not absurdly far away.
pub(crate) fn usable(p: glam::DVec3) -> bool {
    p.is_finite() && p.abs().max_element() <= FAR_M
}
