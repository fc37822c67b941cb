//! Geometry for plants, in f64: curves, frames, fits, triangulation, neighbours. Independent of plants.
//!
//! Every function accepts whatever a pen or a file can produce. A point is *usable* if all its coordinates are finite
//! and at most 1e100 in size (so that squares and their sums stay finite); others are left out, as each function says.
//! Nothing here panics on user data.
//!
//! | module | owns |
//! |---|---|
//! | `polyline` | length, resampling, smoothing, simplification, nearest point on open lines |
//! | `polygon` | area, inside test, hull, cross-sections of closed lines |
//! | `outline` | [`simple_outline`]: the polygon represented by a scribble |
//! | `pca` | principal axes and their box |
//! | `ellipse`, `cone` | the flower's ellipse and cone (He and Cheng 2021, section 5.1) |
//! | `cluster` | mean shift |
//! | `curve`, `frame` | smooth curves through points, frames along them |
//! | `triangulate` | constrained Delaunay triangulation of a blade |
//! | `concave` | outlines that follow the bays of points; triangles within an outline |
//! | `kd`, `cubes`, `voxels`, `step` | neighbours; thinned points; shortest paths |
//! | `hull3` | convex hulls in space |
//! | `spline` | ball B-spline curves and their tubes, tensor-product surfaces (Wang et al. 2011) |

mod cluster;
mod concave;
mod cone;
mod cubes;
mod curve;
mod ellipse;
mod frame;
mod hull3;
mod kd;
mod linear;
mod outline;
mod pca;
mod polygon;
mod polyline;
mod spline;
mod step;
mod triangulate;
mod vector;
mod voxels;
mod wheel;

pub use cluster::mean_shift;
pub use concave::{AlphaOutline, AlphaShape, triangulate_within};
pub use cone::{Cone, ConeSheet, FlowerCone, flower_cone};
pub use cubes::{cubes, one_a_cube};
pub use curve::{bezier_quadratic_c1, catmull_rom};
pub use ellipse::{Ellipse, fit_ellipse, fit_ellipse_harmonic};
pub use frame::{Frame3, rotation_minimising_frames};
pub use hull3::{Hull3, convex_hull3};
pub use kd::{KdTree, KdTree2};
pub use linear::{Blend, best_rotation, solve_positive};
pub use outline::{crossing_points, self_crossings, simple_outline};
pub use pca::{Pca2, pca2, pca3};
pub use polygon::{
    Inside, bounds, centroid, contains, contains_along, convex_hull, farthest_pair, medial_axis_width,
    signed_area,
};
pub use polyline::{
    Closest, closest_on_polyline, distance_to_polyline, distance_to_segment, nearest_on_polyline3, perimeter,
    point_at, point_at3, polyline_length, polyline_length3, resample, resample3, simplify, smooth_gaussian,
    smooth_gaussian_closed, tangent_at, tangent_at3, turning_angles,
};
pub use spline::{
    Ball, BallBSpline, BallTubeSpec, Basis, EndCap, HeightField, MAX_DEGREE, NaturalCubic, RingRule,
    SplineError, SplineSurface, SurfacePoint, Tube, Weights, chord_parameters, subdivided,
};
pub use step::Step;
pub use triangulate::{TriangulateError, Triangulation, triangulate_blade};
pub use voxels::{Voxels, extent};
pub use wheel::{Spoke, Wheel, wheels, widest_gap};
