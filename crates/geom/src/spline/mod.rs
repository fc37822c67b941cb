//! Ball B-spline curves and tensor-product surfaces from marks: veins with thickness, blades through veins.
//!
//! A curve or surface is a [`Basis`] per direction and control balls or points. One kind of basis serves all:
//! a Bezier curve is the basis with no inner knot.

mod ball;
mod basis;
mod fit;
mod height;
mod surface;
mod tube;

pub use ball::{Ball, BallBSpline};
pub use basis::{Basis, MAX_DEGREE, Weights};
pub use fit::{NaturalCubic, chord_parameters, subdivided};
pub use height::HeightField;
pub use surface::{SplineSurface, SurfacePoint};
pub use tube::{BallTubeSpec, EndCap, RingRule, Tube};

/// Reason why a curve or surface cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SplineError {
    /// There are not enough distinct points, controls or rows.
    #[error("a spline needs {needed} distinct points here, {given} were given")]
    TooFew {
        /// The least number.
        needed: usize,
        /// The given number.
        given: usize,
    },
    /// The degree is 0 or above [`MAX_DEGREE`].
    #[error("a spline of degree {0} cannot be made: 1 to 63")]
    Degree(usize),
    /// The knots decrease, are not finite, or do not fit the number of controls.
    #[error("the knots must be finite, must not decrease and must span more than a point")]
    Knots,
    /// The parameters do not increase or do not fit the number of points.
    #[error("the parameters must be finite, increase, and be as many as the points")]
    Parameters,
    /// A coordinate, radius or weight is not usable.
    #[error("point {0} has a coordinate or weight that is no usable number")]
    NotFinite(usize),
    /// A radius is below 0.
    #[error("point {0} has a negative radius")]
    NegativeRadius(usize),
    /// The points do not form a grid of equal rows.
    #[error("{points} points do not form rows of {columns}")]
    Ragged {
        /// Number of points.
        points: usize,
        /// Points per row.
        columns: usize,
    },
}

base::coded!(SplineError {
    Self::TooFew { needed, given } => "spline-too-few" { needed, given },
    Self::Degree(degree) => "spline-degree" { degree },
    Self::Knots => "spline-knots" {},
    Self::Parameters => "spline-parameters" {},
    Self::NotFinite(point) => "spline-not-finite" { point },
    Self::NegativeRadius(point) => "spline-radius" { point },
    Self::Ragged { points, columns } => "spline-ragged" { points, columns },
});
