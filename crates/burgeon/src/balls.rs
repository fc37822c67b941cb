//! Control balls of a leaf of a document, in their places, for hands that move them.

use document::LeafMaker;
use glam::DVec3;
use leaf::{FullMarks, LeafSpec, Rays};
use makers::LeafError;
use schemars::JsonSchema;
use serde::Serialize;

use crate::scene::{LeafInput, SceneError, leaf_input};

/// One control ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LeafBall {
    /// As in `BallMove`.
    pub row: u32,
    /// As in `BallMove`.
    pub mark: u32,
    /// Position in the coordinates of the leaf, metres.
    pub at: [f64; 3],
    /// Radius of the thickest vein there, metres; 0 where there is none.
    pub radius_m: f64,
}

/// All control balls of a leaf in its bent form, and the directions in which they are moved.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LeafBalls {
    /// Balls with the tip first, then row by row; for chief veins, vein by vein.
    pub balls: Vec<LeafBall>,
    /// Unit vectors of the first, second and third number of `BallMove::by_m`.
    pub sides: [[f64; 3]; 3],
}

/// Returns the control balls of a leaf as it stands in a document.
///
/// # Errors
/// [`SceneError`]: the reason why it makes no leaf.
pub fn leaf_balls(maker: &LeafMaker) -> Result<LeafBalls, SceneError> {
    let (input, options) = leaf_input(maker)?;
    Ok(match &input {
        LeafInput::Marks(marks) => balls_of_marks(marks, &options.spec)?,
        LeafInput::Rays(rays) => balls_of_rays(rays, &options.spec)?,
    })
}

fn balls_of_marks(marks: &FullMarks, spec: &LeafSpec) -> Result<LeafBalls, LeafError> {
    let (shaped, half) = (spec.shaped(marks)?, spec.thickness.unwrap_or_default().radius());
    let ball = |row: usize, mark: usize, at: DVec3, thick: f64| {
        let [row, mark] = [row, mark].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
        LeafBall { row, mark, at: at.to_array(), radius_m: half * thick }
    };
    let mut balls = vec![ball(0, 1, shaped.tip, shaped.tip_thickness)];
    for (i, row) in shaped.rows.iter().enumerate() {
        for (j, (&at, &thick)) in row.points.iter().zip(&row.thickness).enumerate() {
            let middle = 2 * j + 1 == row.points.len();
            balls.push(ball(i + 1, j + 1, at, if middle { thick.max(row.midrib) } else { thick }));
        }
    }
    Ok(LeafBalls { balls, sides: leaf::ball_sides(marks).map(|side| side.to_array()) })
}

fn balls_of_rays(rays: &Rays, spec: &LeafSpec) -> Result<LeafBalls, LeafError> {
    let (shaped, half) = (spec.shaped_rays(rays)?, spec.thickness.unwrap_or_default().radius());
    let mut balls = Vec::new();
    for (i, ray) in shaped.rays.iter().enumerate() {
        for (j, (&at, thick)) in ray.points.iter().zip(&ray.thickness).enumerate() {
            // The base is one ball of all veins.
            if i > 0 && shaped.rays[0].points.get(j) == Some(&at) {
                continue;
            }
            let [row, mark] = [i + 1, j + 1].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
            balls.push(LeafBall { row, mark, at: at.to_array(), radius_m: half * thick.unwrap_or(0.0) });
        }
    }
    Ok(LeafBalls { balls, sides: leaf::ball_sides_of_rays(rays).map(|side| side.to_array()) })
}
