//! Ends of stubs: broken off, in a rim of bark around a knot, or in one around a hollow. Wood without bark is a mesh of
//! its own.

use base::{Draw, Seed, ops};
use mesh::TriMesh;

use crate::hollow::{MOUTH, Opening};
use crate::rings::Ring;
use crate::sleeve::{Circle, Sleeve, narrow2, wide};
use crate::spine::Station;

/// End of a tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    Round,
    /// Broken off, with a seed of its own.
    Broken(Seed),
    /// In a rim of bark around a dark bottom of this depth, metres.
    Rim(f64),
    /// In a rim of bark around the mouth of a cavity in the stem.
    Hollow(Opening),
}

/// Least thickness of the end of a stub, relative to its own, at which it broke off or is a rim; others are round.
const THICK: f64 = 0.3;
/// Depth of a knot's bottom relative to the height of its rim.
const DEEP: f64 = 0.75;
/// Longest splinters, in radii.
const SPLINTER: f64 = 1.1;
/// Exponential darkening for each radius of depth.
const SHADE: f64 = 6.0;
/// Radius of the wood within the bark, relative to that of the stub.
const WOOD: f64 = 0.84;
/// The roll of bark around a mouth: width and rise relative to the radius, and the lean of the normals.
const ROLL: [(f64, f64, f64); 3] = [(0.95, 0.07, 0.7), (0.84, 0.09, 1.5), (MOUTH, 0.0, 2.4)];

impl End {
    /// Returns the end of a stub with a key that stands out by `beyond` and narrows from `stout` to `radius`, metres:
    /// one with a thick end broke off there, and one that is shorter than thick is the rim that grew around a rotted
    /// branch.
    pub(crate) fn from_stub(key: u64, beyond: f64, stout: f64, radius: f64) -> Self {
        if radius < THICK * stout {
            Self::Round
        } else if beyond > radius {
            Self::Broken(Seed::new(key))
        } else {
            Self::Rim(DEEP * beyond)
        }
    }

    pub(crate) fn is_broken(self) -> bool {
        matches!(self, Self::Broken(_))
    }

    /// Closes a tube behind its last ring; wood without bark, if any, becomes a mesh with colours. Triangles: sides
    /// times twice the rows of both and one.
    pub(crate) fn close(
        self,
        out: &mut Sleeve<'_>,
        last: &Ring,
        circle: &Circle,
        round: u32,
    ) -> Option<TriMesh> {
        let sides = circle.sides();
        let even = vec![0.0; sides];
        match self {
            Self::Round => {
                out.round_tip(last, round);
                None
            }
            Self::Broken(seed) => {
                let mut draw = seed.stream(Draw::Texture);
                let mut long = || -> Vec<f64> {
                    (0..sides).map(|_| SPLINTER * draw.uniform() * draw.uniform()).collect()
                };
                let (bark, wood) = (long(), long());
                out.beyond(last, (WOOD, 0.0, 0.9), &bark);
                let rows = [(WOOD, 0.0, 0.9, &bark), (0.45, 0.0, 1.2, &wood)];
                Some(face(last, circle, &rows, 0.1))
            }
            Self::Hollow(opening) => {
                for row in ROLL {
                    out.beyond(last, row, &even);
                }
                Some(opening.cavity(last, circle))
            }
            Self::Rim(depth) => {
                for row in ROLL {
                    out.beyond(last, row, &even);
                }
                let deep = depth / last.radius.max(f64::MIN_POSITIVE);
                let rows =
                    [(MOUTH, 0.0, 2.4, &even), (0.6, -0.7 * deep, 2.2, &even), (0.35, -deep, 1.7, &even)];
                Some(face(last, circle, &rows, -deep))
            }
        }
    }
}

/// Lays the bark of the bearer over a scar on it, along the bearer and not around the scar: `scale` repetitions a
/// metre.
pub(crate) fn lay_bark(mesh: &mut TriMesh, exit: &Station, bearer: &Station, scale: f64) {
    let up = bearer.tangent;
    let side = up.cross(exit.tangent).normalize_or_zero();
    for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
        let p = wide(*p) - exit.centre;
        *uv = narrow2(side.dot(p) * scale, up.dot(p) * scale);
    }
}

/// A row of a face: its width and rise relative to the radius, the lean of its normals, and the additional offset of
/// each corner.
type FaceRow<'a> = (f64, f64, f64, &'a Vec<f64>);

/// Makes the wood within, from its edge to its middle, darker with depth.
fn face(last: &Ring, circle: &Circle, rows: &[FaceRow<'_>], middle: f64) -> TriMesh {
    let mut mesh = TriMesh::default();
    let mut out = Sleeve::new(&mut mesh, circle, 1);
    for &(width, rise, lean, further) in rows {
        out.beyond(last, (width, rise, lean), further);
    }
    out.close(last.centre + last.tangent * (middle * last.radius), last.tangent);
    let of_row = |rise: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "a colour")]
        let light = ops::exp(SHADE * rise.min(0.0)) as f32;
        [light; 3]
    };
    for &(_, rise, ..) in rows {
        mesh.colors.resize(mesh.colors.len() + circle.sides() + 1, of_row(rise));
    }
    mesh.colors.resize(mesh.positions.len(), of_row(middle));
    mesh
}

/// Moves the face of a stub with its bark, if that moves.
pub(crate) fn follow(face: &mut TriMesh, bark: &TriMesh) {
    let n = face.positions.len();
    if let Some((wind, pivot)) = bark.wind.last().zip(bark.pivots.last()) {
        (face.wind, face.pivots) = (vec![*wind; n], vec![*pivot; n]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn what_stands_out_says_how_it_ends() {
        assert_eq!(End::from_stub(1, 0.1, 0.05, 0.005), End::Round);
        assert_eq!(End::from_stub(1, 0.1, 0.05, 0.04), End::Broken(Seed::new(1)));
        assert!(matches!(End::from_stub(1, 0.02, 0.05, 0.04), End::Rim(d) if d > 0.0 && d < 0.02));
    }

    #[test]
    fn bark_and_wood_close_the_end_together() {
        let ring = Ring {
            centre: DVec3::Y,
            tangent: DVec3::Y,
            across: DVec3::Z,
            up: DVec3::X,
            radius: 0.1,
            slope: 0.0,
        };
        let circle = Circle::new(9);
        for end in [End::Broken(Seed::new(3)), End::Rim(0.03)] {
            let mut bark = TriMesh::default();
            let mut out = Sleeve::new(&mut bark, &circle, 1);
            out.rings(&[Ring { centre: DVec3::ZERO, ..ring }, ring]);
            let wood = end.close(&mut out, &ring, &circle, 2).expect("an open end");
            assert_eq!(wood.colors.len(), wood.positions.len());
            // The edge of the wood lies on the edge of the bark.
            for p in &wood.positions[..9] {
                assert!(bark.positions.contains(p), "{p:?}");
            }
            let (deepest, edge) = (wood.colors.last().expect("some")[0], wood.colors[0][0]);
            assert!(deepest <= edge && (end == End::Rim(0.03)) == (deepest < 0.5), "{deepest} {edge}");
        }
    }
}
