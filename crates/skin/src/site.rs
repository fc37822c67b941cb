//! Sites of the plants of a scene: soil with its relief, stones and pots, with the label of each part.
//!
//! `SceneSiteSpec, seed -> SceneSite { model, labels }`

use base::{Draw, Seed, ops};
use glam::{DVec2, DVec3};
use mesh::{Material, MaterialId, MaterialKind, Model, Part, TriMesh};
use spec::RangeFault;

use crate::labels::{PART_OF_SOIL, PART_OF_STONE, part_of_organ};

/// A pot that a plant stands in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PotSpec {
    /// The middle of the soil in it, where the plant stands, metres.
    pub soil_m: DVec3,
    /// Radius of its rim, metres, 0.005 to 5.
    pub radius_m: f64,
    /// Height from its foot to its rim, metres, 0.005 to 5.
    pub height_m: f64,
}

impl PotSpec {
    /// Share of a pot's height up to which it is filled.
    pub const FILLED: f64 = 0.9;
}

/// The site that plants stand on.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSiteSpec {
    /// Sides of the soil along x and z, around the origin at y = 0, metres, each 0.05 to 1000.
    pub soil_m: [f64; 2],
    /// Height from the deepest hollow to the highest clod, metres, 0 to 0.5.
    pub relief_m: f64,
    /// Number of stones on it, 0 to 5000.
    pub stones: u32,
    /// Radius of the largest stones, metres, 0.001 to 1; the smallest have a third of it.
    pub stone_m: f64,
    /// Pots.
    pub pots: Vec<PotSpec>,
}

impl Default for SceneSiteSpec {
    fn default() -> Self {
        Self { soil_m: [4.0, 4.0], relief_m: 0.02, stones: 0, stone_m: 0.03, pots: Vec::new() }
    }
}

/// Meshes of a site, and the label of each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneSite {
    /// Soil, stones and pots, each kind in a part of its own.
    pub model: Model,
    /// Row of each part of the model in [`PARTS`](crate::PARTS).
    pub labels: Vec<u8>,
}

impl SceneSiteSpec {
    fn check(&self) -> Result<(), RangeFault> {
        let own = [
            ("soil[0]", self.soil_m[0], [0.05, 1000.0], "m"),
            ("soil[1]", self.soil_m[1], [0.05, 1000.0], "m"),
            ("relief", self.relief_m, [0.0, 0.5], "m"),
            ("stones", f64::from(self.stones), [0.0, 5000.0], ""),
            ("stone_size", self.stone_m, [0.001, 1.0], "m"),
        ];
        let pots = self.pots.iter().flat_map(|pot| {
            [("pot radius", pot.radius_m, [0.005, 5.0], "m"), ("pot height", pot.height_m, [0.005, 5.0], "m")]
        });
        let out = own.into_iter().chain(pots).find(|(_, x, [least, most], _)| !(*least..=*most).contains(x));
        out.map_or(Ok(()), |(path, value, [least, most], unit)| {
            let (least, most, above) = (Some(least), Some(most), None);
            Err(RangeFault { path: path.into(), value, least, most, above, unit })
        })
    }
}

/// Cells along the longer side of the soil: a camera that stands on it loses only the cell in which it stands.
const SOIL_CELLS: usize = 160;

/// Linear colour of dry loam.
const LOAM: [f32; 3] = [0.16, 0.105, 0.066];
/// Linear colour of grey stone.
const STONE: [f32; 3] = [0.30, 0.28, 0.26];
/// Linear colour of clay.
const CLAY: [f32; 3] = [0.34, 0.13, 0.066];

/// Largest deviation of the colours of soil and stones from their mean.
const COLOUR_SPREAD: f64 = 0.3;

/// Makes soil, stones and pots. Omitted things have no part.
///
/// Guaranteed: the same spec and seed give the same bits everywhere; the soil lies between 0 and the relief, its mean
/// near half of that. Nothing of it is below 0, as pictures do not show what is. Cost: about 50,000 triangles of soil,
/// 80 for each stone, 240 for each pot.
///
/// # Errors
/// [`RangeFault`] for a number out of its range.
pub fn make_site(spec: &SceneSiteSpec, seed: Seed) -> Result<SceneSite, RangeFault> {
    spec.check()?;
    let mut site = SceneSite::default();
    site.model.name = "site".into();
    let relief = Relief::new(seed.child(1), spec.relief_m);
    site.add("soil", LOAM, PART_OF_SOIL, soil(spec.soil_m, &relief));
    if spec.stones > 0 {
        site.add("stones", STONE, PART_OF_STONE, stones(spec, &relief, seed.child(2)));
    }
    if !spec.pots.is_empty() {
        let label = part_of_organ(plant::OrganKind::Pot);
        site.add("pots", CLAY, label, pots(&spec.pots));
    }
    Ok(site)
}

impl SceneSite {
    fn add(&mut self, name: &str, color: [f32; 3], label: u8, mut mesh: TriMesh) {
        mesh.compute_normals();
        let material = MaterialId::new(self.model.materials.len());
        self.model.materials.push(Material::plain(name, MaterialKind::Other, color));
        self.model.parts.push(Part { name: name.into(), material, mesh });
        self.labels.push(label);
    }
}

/// Smooth noise of several sizes over the soil: value noise (Perlin 1985) on lattices, each of twice as many places.
struct Relief {
    octaves: Vec<Vec<f64>>,
    height_m: f64,
}

impl Relief {
    /// Cells of the coarsest lattice along a side.
    const COARSEST: usize = 8;
    /// Number of lattices.
    const OCTAVES: usize = 4;
    /// Height of a lattice over that of the next coarser one.
    const FALL: f64 = 0.55;

    fn new(seed: Seed, height_m: f64) -> Self {
        let mut chance = seed.stream(Draw::Scatter);
        let octave = |k: usize| {
            let side = (Self::COARSEST << k) + 1;
            (0..side * side).map(|_| chance.uniform()).collect()
        };
        Self { octaves: (0..Self::OCTAVES).map(octave).collect(), height_m }
    }

    /// Returns the height, 0 to 1, at a place of the soil whose coordinates are shares of its sides.
    fn share(&self, at: DVec2) -> f64 {
        let (mut sum, mut most, mut weight) = (0.0, 0.0, 1.0);
        for (k, lattice) in self.octaves.iter().enumerate() {
            sum += weight * sampled(lattice, Self::COARSEST << k, at);
            most += weight;
            weight *= Self::FALL;
        }
        sum / most
    }

    fn height(&self, at: DVec2) -> f64 {
        self.height_m * self.share(at)
    }
}

/// Interpolates a lattice of `cells` by `cells` between its places.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the lattice")]
fn sampled(lattice: &[f64], cells: usize, at: DVec2) -> f64 {
    let s = at.clamp(DVec2::ZERO, DVec2::ONE) * cells as f64;
    let (x, y) = ((s.x as usize).min(cells - 1), (s.y as usize).min(cells - 1));
    let (tx, ty) = (ops::smoothstep(0.0, 1.0, s.x - x as f64), ops::smoothstep(0.0, 1.0, s.y - y as f64));
    let row = y * (cells + 1) + x;
    let near = ops::lerp(lattice[row], lattice[row + 1], tx);
    let far = ops::lerp(lattice[row + cells + 1], lattice[row + cells + 2], tx);
    ops::lerp(near, far, ty)
}

#[expect(clippy::cast_possible_truncation, reason = "meshes are of single precision")]
fn grey(share: f64) -> [f32; 3] {
    [(1.0 + COLOUR_SPREAD * (2.0 * share - 1.0)) as f32; 3]
}

fn index(k: usize) -> u32 {
    u32::try_from(k).unwrap_or(u32::MAX)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 160 cells")]
fn soil([width, depth]: [f64; 2], relief: &Relief) -> TriMesh {
    let cell = width.max(depth) / SOIL_CELLS as f64;
    let cells = |side: f64| ((side / cell).ceil() as usize).clamp(1, SOIL_CELLS);
    let (columns, rows) = (cells(width), cells(depth));
    let mut mesh = TriMesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let at = DVec2::new(column as f64 / columns as f64, row as f64 / rows as f64);
            let place = DVec3::new((at.x - 0.5) * width, relief.height(at), (at.y - 0.5) * depth);
            mesh.positions.push(place.as_vec3().to_array());
            mesh.colors.push(grey(relief.share(at)));
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let a = index(row * (columns + 1) + column);
            let (b, c) = (a + 1, a + index(columns) + 1);
            mesh.triangles.extend([[a, c, b], [b, c, c + 1]]);
        }
    }
    mesh
}

/// A mesh of rings from the lowest to the highest point, each of `around` places; the first and the last may have
/// radius 0.
struct Rings {
    around: u32,
    first: u32,
}

impl Rings {
    fn new(mesh: &TriMesh, around: u32) -> Self {
        Self { around, first: index(mesh.positions.len()) }
    }

    /// Adds triangles between rings `k` and `k + 1`, counter-clockwise from the outside where rings ascend.
    fn join(&self, mesh: &mut TriMesh, k: u32) {
        for j in 0..self.around {
            let next = (j + 1) % self.around;
            let place = |ring: u32, j: u32| self.first + ring * self.around + j;
            let [a, b, c, d] = [place(k, j), place(k, next), place(k + 1, j), place(k + 1, next)];
            mesh.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
}

fn stones(spec: &SceneSiteSpec, relief: &Relief, seed: Seed) -> TriMesh {
    const AROUND: u32 = 8;
    const RINGS: u32 = 5;
    let mut mesh = TriMesh::default();
    for k in 0..spec.stones {
        let mut chance = seed.child(u64::from(k)).stream(Draw::Scatter);
        let at = DVec2::new(chance.uniform(), chance.uniform());
        let radius = spec.stone_m * chance.range(1.0 / 3.0, 1.0);
        let flat = chance.range(0.45, 0.8);
        let wide = chance.range(0.7, 1.0);
        let middle = DVec3::new(
            (at.x - 0.5) * spec.soil_m[0],
            relief.height(at) + 0.2 * radius * flat,
            (at.y - 0.5) * spec.soil_m[1],
        );
        let color = grey(chance.uniform());
        let rings = Rings::new(&mesh, AROUND);
        for ring in 0..=RINGS {
            let (up, out) = ops::sin_cos(ops::PI * (f64::from(ring) / f64::from(RINGS) - 0.5));
            for j in 0..AROUND {
                let (s, c) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(AROUND));
                let rough = radius * chance.range(0.85, 1.0);
                let way = DVec3::new(wide * out * c, flat * up, out * s) * rough;
                mesh.positions.push((middle + way).as_vec3().to_array());
                mesh.colors.push(color);
            }
        }
        (0..RINGS).for_each(|ring| rings.join(&mut mesh, ring));
    }
    mesh
}

fn pots(pots: &[PotSpec]) -> TriMesh {
    const AROUND: u32 = 24;
    /// Shares of the radius and of the height: foot, wall, rim, inner wall, soil.
    const PROFILE: [[f64; 2]; 6] =
        [[0.0, 0.0], [0.72, 0.0], [1.0, 1.0], [0.93, 1.0], [0.9, PotSpec::FILLED], [0.0, PotSpec::FILLED]];
    let mut mesh = TriMesh::default();
    for pot in pots {
        let foot = pot.soil_m - DVec3::Y * (PotSpec::FILLED * pot.height_m);
        let rings = Rings::new(&mesh, AROUND);
        for [out, up] in PROFILE {
            for j in 0..AROUND {
                let (s, c) = ops::sin_cos(ops::TAU * f64::from(j) / f64::from(AROUND));
                let way = DVec3::new(out * pot.radius_m * c, up * pot.height_m, out * pot.radius_m * s);
                mesh.positions.push((foot + way).as_vec3().to_array());
            }
        }
        (0..index(PROFILE.len()) - 1).for_each(|ring| rings.join(&mut mesh, ring));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(spec: &SceneSiteSpec, seed: u64) -> SceneSite {
        make_site(spec, Seed::new(seed)).expect("a site")
    }

    #[test]
    fn soil_has_its_sides_and_its_relief_and_faces_upwards() {
        let spec = SceneSiteSpec { soil_m: [3.0, 1.5], relief_m: 0.1, ..SceneSiteSpec::default() };
        let site = made(&spec, 1);
        let mesh = &site.model.parts[0].mesh;
        let reach = |k: usize| {
            let values = mesh.positions.iter().map(|p| f64::from(p[k]));
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)])
        };
        assert_eq!((reach(0), reach(2)), ([-1.5, 1.5], [-0.75, 0.75]));
        let [low, high] = reach(1);
        assert!(low >= 0.0 && high <= 0.1 && high - low > 0.03, "{low} {high}");
        assert!(mesh.normals.iter().all(|n| n[1] > 0.5));
        assert_eq!(site.labels, [PART_OF_SOIL]);
        assert_ne!(made(&spec, 2), site);
        assert_eq!(made(&spec, 1), site);
    }

    #[test]
    fn stones_and_pots_are_closed_to_the_outside() {
        let pot = PotSpec { soil_m: DVec3::new(0.5, 0.18, 0.0), radius_m: 0.1, height_m: 0.2 };
        let spec = SceneSiteSpec { stones: 3, pots: vec![pot], ..SceneSiteSpec::default() };
        let site = made(&spec, 1);
        assert_eq!(site.labels.len(), 3);
        for part in &site.model.parts[1..] {
            let corner = |i: u32| DVec3::from_array(part.mesh.positions[i as usize].map(f64::from));
            // By the divergence theorem, a surface that faces outwards encloses a volume above 0.
            let volume: f64 = part
                .mesh
                .triangles
                .iter()
                .map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0)
                .sum();
            assert!(volume > 0.0, "{}: {volume}", part.name);
        }
        let lowest = site.model.parts[2].mesh.positions.iter().map(|p| p[1]).fold(f32::INFINITY, f32::min);
        assert!(lowest.abs() < 1e-6, "it stands on the ground: {lowest}");
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let told = |spec: SceneSiteSpec| make_site(&spec, Seed::new(1)).expect_err("a fault").to_string();
        assert!(told(SceneSiteSpec { relief_m: 2.0, ..SceneSiteSpec::default() }).contains("relief"));
        assert!(
            told(SceneSiteSpec { soil_m: [f64::NAN, 1.0], ..SceneSiteSpec::default() }).contains("soil[0]")
        );
        let pot = PotSpec { soil_m: DVec3::ZERO, radius_m: 0.0, height_m: 0.2 };
        assert!(told(SceneSiteSpec { pots: vec![pot], ..SceneSiteSpec::default() }).contains("pot radius"));
    }
}
