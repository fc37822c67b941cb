//! Columns of vertices and triangles.

use base::{Digest, Digestible};
use glam::DVec3;

use crate::{Material, MaterialId};

/// A triangle mesh as columns. Optional columns are empty or as long as `positions`.
///
/// Triangles wind counter-clockwise seen from outside (from the upper side, for blades).
///
/// ```
/// let mut m = mesh::TriMesh::default();
/// m.positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// m.triangles = vec![[0, 1, 2]];
/// m.compute_normals();
/// assert_eq!(m.normals[0], [0.0, 0.0, 1.0]);
/// assert_eq!(m.validate().count(), 0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// Positions, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit vectors.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, v down as in glTF.
    pub uvs: Vec<[f32; 2]>,
    /// Linear RGB multiplied with the material's base colour (tint of single organs).
    pub colors: Vec<[f32; 3]>,
    /// Effect of the wind on the vertex, each 0 to 1: sway of the whole plant, sway of its branch, flutter, phase.
    pub wind: Vec<[f32; 4]>,
    /// Point about which the vertex's branch or organ rotates in the wind, metres.
    pub pivots: Vec<[f32; 3]>,
    /// Corner indices.
    pub triangles: Vec<[u32; 3]>,
}

/// A mesh with its name and material.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Unique within the model, such as `leaves`.
    pub name: String,
    /// Row of [`Model::materials`].
    pub material: MaterialId,
    /// The triangles.
    pub mesh: TriMesh,
}

/// Parts and materials: the content of a file or a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Name of the whole, used as the root node's name.
    pub name: String,
    /// Meshes, each with one material.
    pub parts: Vec<Part>,
    /// Materials that the parts refer to.
    pub materials: Vec<Material>,
    /// Offset that was subtracted from all positions so that they fit in single precision; metres, +Y up. Files keep
    /// it as a note.
    pub offset_m: Option<DVec3>,
}

/// An axis-aligned box in metres; empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest corner.
    pub min: DVec3,
    /// Highest corner.
    pub max: DVec3,
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// Enlarges the box to hold `p`.
    pub fn include(&mut self, p: DVec3) {
        self.min = self.min.min(p);
        self.max = self.max.max(p);
    }

    /// Returns whether nothing was included.
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    /// Returns the edge lengths; zero when empty.
    pub fn size(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.max - self.min }
    }

    /// Returns the centre; the origin when empty.
    pub fn centre(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { (self.min + self.max) * 0.5 }
    }
}

/// Fault of a mesh or a model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// A coordinate is NaN or infinite.
    #[error("vertex {0} is not finite")]
    NotFinite(usize),
    /// A triangle refers to a missing vertex.
    #[error("triangle {0} names a vertex that is not there")]
    Dangling(usize),
    /// A triangle uses one vertex twice.
    #[error("triangle {0} uses one vertex twice")]
    Degenerate(usize),
    /// An optional column is neither empty nor full.
    #[error("column {0} is neither empty nor as long as the positions")]
    Ragged(&'static str),
    /// A normal is not of unit length.
    #[error("normal {0} is not of unit length")]
    Normal(usize),
    /// A weight or phase of the wind is not between 0 and 1.
    #[error("the wind at vertex {0} is not between 0 and 1")]
    Wind(usize),
    /// A part refers to a missing material.
    #[error("part {0} names a material that is not there")]
    Material(usize),
}

fn to_f64(p: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))
}

/// Rounds a model coordinate to the mesh's precision.
#[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in the mesh, by design")]
fn to_f32(p: DVec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

impl TriMesh {
    /// Appends a vertex position and returns its index.
    ///
    /// # Panics
    /// Beyond four billion vertices.
    pub fn push(&mut self, p: DVec3) -> u32 {
        let index = u32::try_from(self.positions.len());
        self.positions.push(to_f32(p));
        #[expect(clippy::expect_used, reason = "four billion vertices are a bug, not data")]
        index.expect("more vertices than u32 can name")
    }

    /// Returns the position of a vertex as f64.
    pub fn position(&self, index: u32) -> DVec3 {
        to_f64(self.positions[index as usize])
    }

    /// Computes smooth normals: the sum of the adjacent triangles' area-weighted normals. A vertex of no area gets
    /// +Y.
    pub fn compute_normals(&mut self) {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for &[a, b, c] in &self.triangles {
            let (pa, pb, pc) = (self.position(a), self.position(b), self.position(c));
            let n = (pb - pa).cross(pc - pa);
            for i in [a, b, c] {
                sums[i as usize] += n;
            }
        }
        self.normals = sums.into_iter().map(|n| to_f32(n.try_normalize().unwrap_or(DVec3::Y))).collect();
    }

    /// Appends `other`, whose filled columns must be the same as this mesh's (or this mesh empty).
    pub fn append(&mut self, other: &Self) {
        #[expect(clippy::cast_possible_truncation, reason = "push and validate guard the u32 range")]
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.uvs.extend_from_slice(&other.uvs);
        self.colors.extend_from_slice(&other.colors);
        self.wind.extend_from_slice(&other.wind);
        self.pivots.extend_from_slice(&other.pivots);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + base)));
    }

    /// Returns the box around all positions.
    pub fn bounds(&self) -> Bounds {
        let mut b = Bounds::EMPTY;
        self.positions.iter().for_each(|&p| b.include(to_f64(p)));
        b
    }

    /// Returns the area of all triangles, square metres.
    pub fn area(&self) -> f64 {
        let p = |i: u32| self.position(i);
        self.triangles.iter().map(|&[a, b, c]| 0.5 * (p(b) - p(a)).cross(p(c) - p(a)).length()).sum()
    }

    /// Returns all faults. Cost: linear.
    pub fn validate(&self) -> impl Iterator<Item = MeshFault> + '_ {
        let n = self.positions.len();
        let ragged = [
            ("normals", self.normals.len()),
            ("uvs", self.uvs.len()),
            ("colors", self.colors.len()),
            ("wind", self.wind.len()),
            ("pivots", self.pivots.len()),
        ];
        let ragged = ragged
            .into_iter()
            .filter(move |&(_, len)| len != 0 && len != n)
            .map(|(name, _)| MeshFault::Ragged(name));
        let finite = self.positions.iter().chain(&self.pivots).enumerate();
        let finite = finite
            .filter(|(_, p)| !p.iter().all(|x| x.is_finite()))
            .map(move |(i, _)| MeshFault::NotFinite(if i < n { i } else { i - n }));
        let share = |w: &[f32; 4]| w.iter().all(|x| (0.0..=1.0).contains(x));
        let wind =
            self.wind.iter().enumerate().filter(move |(_, w)| !share(w)).map(|(i, _)| MeshFault::Wind(i));
        let normals = self.normals.iter().enumerate();
        let normals = normals
            .filter(|&(_, &v)| {
                (to_f64(v).length() - 1.0).abs().partial_cmp(&1e-3) != Some(core::cmp::Ordering::Less)
            })
            .map(|(i, _)| MeshFault::Normal(i));
        let triangles = self.triangles.iter().enumerate().filter_map(move |(i, &[a, b, c])| {
            if [a, b, c].iter().any(|&v| v as usize >= n) {
                Some(MeshFault::Dangling(i))
            } else if a == b || b == c || c == a {
                Some(MeshFault::Degenerate(i))
            } else {
                None
            }
        });
        ragged.chain(finite).chain(wind).chain(normals).chain(triangles)
    }
}

impl Digestible for TriMesh {
    fn digest(&self, d: &mut Digest) {
        d.add(&self.positions).add(&self.normals).add(&self.uvs).add(&self.colors).add(&self.triangles);
        // Only if there is wind: digests of meshes without it stay the same.
        if !(self.wind.is_empty() && self.pivots.is_empty()) {
            d.add(&self.wind).add(&self.pivots);
        }
    }
}

impl Model {
    /// Returns the bytes of the columns and textures, to measure memory.
    pub fn bytes(&self) -> usize {
        let columns = |m: &TriMesh| {
            size_of_val(&*m.positions)
                + size_of_val(&*m.normals)
                + size_of_val(&*m.uvs)
                + size_of_val(&*m.colors)
                + size_of_val(&*m.wind)
                + size_of_val(&*m.pivots)
                + size_of_val(&*m.triangles)
        };
        let textures = self.materials.iter().flat_map(|m| m.texture.iter().chain(m.maps.each()));
        self.parts.iter().map(|p| columns(&p.mesh)).sum::<usize>()
            + textures.map(|t| t.pixels.len()).sum::<usize>()
    }

    /// Returns the vertices and triangles of all parts as one mesh, without other columns.
    pub fn triangles(&self) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for part in &self.parts {
            let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
            vertices.extend(part.mesh.positions.iter().map(|p| DVec3::from_array(p.map(f64::from))));
            triangles.extend(part.mesh.triangles.iter().map(|t| t.map(|i| i.saturating_add(first))));
        }
        (vertices, triangles)
    }

    /// Returns the number of vertices of all parts.
    pub fn vertex_count(&self) -> usize {
        self.parts.iter().map(|p| p.mesh.positions.len()).sum()
    }

    /// Returns the number of triangles of all parts.
    pub fn triangle_count(&self) -> usize {
        self.parts.iter().map(|p| p.mesh.triangles.len()).sum()
    }

    /// Returns the box around all parts.
    pub fn bounds(&self) -> Bounds {
        let mut b = Bounds::EMPTY;
        for part in &self.parts {
            let pb = part.mesh.bounds();
            if !pb.is_empty() {
                b.include(pb.min);
                b.include(pb.max);
            }
        }
        b
    }

    /// Returns the material of a part.
    pub fn material(&self, part: &Part) -> &Material {
        &self.materials[part.material.index()]
    }

    /// Returns the faults of all parts.
    pub fn validate(&self) -> impl Iterator<Item = MeshFault> + '_ {
        self.parts.iter().enumerate().flat_map(move |(i, part)| {
            let missing = part.material.index() >= self.materials.len();
            missing.then_some(MeshFault::Material(i)).into_iter().chain(part.mesh.validate())
        })
    }
}

impl Digestible for Model {
    fn digest(&self, d: &mut Digest) {
        for part in &self.parts {
            d.add(part.name.as_str()).add(&part.material.raw()).add(&part.mesh);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validate_names_every_fault() {
        let mut m = TriMesh {
            positions: vec![[0.0; 3], [f32::NAN, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 2.0]],
            triangles: vec![[0, 1, 9], [1, 1, 2]],
            ..TriMesh::default()
        };
        let faults: Vec<MeshFault> = m.validate().collect();
        let want = [
            MeshFault::Ragged("normals"),
            MeshFault::NotFinite(1),
            MeshFault::Normal(0),
            MeshFault::Dangling(0),
            MeshFault::Degenerate(1),
        ];
        assert_eq!(faults, want);
        m.positions[1][0] = 1.0;
        m.triangles = vec![[0, 1, 2]];
        m.compute_normals();
        assert_eq!(m.validate().count(), 0, "{m:?}");
    }

    #[test]
    fn wind_counts_only_where_it_is() {
        let bare = TriMesh { positions: vec![[0.0; 3]; 3], ..TriMesh::default() };
        let digest = |m: &TriMesh| {
            let mut d = Digest::new();
            d.add(m);
            d.hex()
        };
        let mut before = Digest::new();
        before.add(&bare.positions).add(&bare.normals).add(&bare.uvs).add(&bare.colors).add(&bare.triangles);
        assert_eq!(digest(&bare), before.hex());
        let mut blown = TriMesh { wind: vec![[0.0; 4]; 3], pivots: vec![[0.0; 3]; 3], ..bare.clone() };
        assert_ne!(digest(&bare), digest(&blown));
        assert_eq!(blown.validate().count(), 0);
        blown.wind[2][1] = 1.5;
        blown.pivots[1][0] = f32::NAN;
        assert_eq!(blown.validate().collect::<Vec<_>>(), [MeshFault::NotFinite(1), MeshFault::Wind(2)]);
        blown.wind.pop();
        assert_eq!(blown.validate().next(), Some(MeshFault::Ragged("wind")));
    }

    #[test]
    fn area_is_that_of_the_triangles() {
        let square = TriMesh {
            positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [2.0, 0.0, 3.0], [0.0, 0.0, 3.0]],
            triangles: vec![[0, 1, 2], [2, 3, 0], [1, 1, 2]],
            ..TriMesh::default()
        };
        assert!((square.area() - 6.0).abs() < 1e-12);
        assert!(TriMesh::default().area().abs() < 1e-12);
    }

    #[test]
    fn append_shifts_indices() {
        let mut a =
            TriMesh { positions: vec![[0.0; 3]; 3], triangles: vec![[0, 1, 2]], ..TriMesh::default() };
        let b = a.clone();
        a.append(&b);
        assert_eq!(a.triangles, [[0, 1, 2], [3, 4, 5]]);
    }
}
