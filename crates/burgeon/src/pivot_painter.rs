//! Pivots, hierarchy and directions of a plant's parts as textures that the material functions of Pivot Painter 2 read.
//!
//! `Plant -> elements, a texel each; meshes -> the element of each vertex -> texture coordinates and textures`

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use formats::{Beside, BesideFile, WriteError, half_bits, write_exr, write_png};
use geom::KdTree;
use glam::DVec3;
use mesh::{MaterialKind, Model, Part};
use plant::{Axis, AxisKind, NodeId, OrganKind, Plant};

/// Most elements: so many Pivot Painter 2 documents for its foliage shader.
const MOST: usize = 30_000;
/// Most steps from the trunk at which wood is an element of its own, and whether leaves are; coarser where there would be
/// too many. The foliage shader follows three steps.
const DIVISIONS: [(u32, bool); 5] = [(2, true), (3, false), (2, false), (1, false), (0, false)];
/// Added to an index before its bits are those of a 16-bit float, so that small ones are not denormalised.
const INDEX_BASE: usize = 1024;
/// Greatest extent that eight bits hold, centimetres.
const FARTHEST_CM: f64 = 2048.0;
const CM: f64 = 100.0;
/// Shares of a piece of an axis at which it is looked up.
const ALONG: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
/// Vertices of a tube that say which wood it is: the last ones lie at its tip, which no other wood shares.
const VOTES: usize = 6;

/// A part of a plant that turns about a point of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Element {
    /// Where it is held, metres.
    pivot: DVec3,
    /// What bears it; itself if nothing does.
    parent: u32,
    /// Number of elements between it and the ground.
    steps: u32,
}

/// Points along wood, each with its element.
#[derive(Debug)]
struct Wood {
    points: KdTree,
    elements: Vec<u32>,
}

impl Wood {
    fn new(points: Vec<(DVec3, u32)>) -> Self {
        let (points, elements): (Vec<DVec3>, Vec<u32>) = points.into_iter().unzip();
        Self { points: KdTree::new(&points), elements }
    }

    fn nearest(&self, place: DVec3) -> Option<u32> {
        self.points.nearest(place, f64::INFINITY).map(|row| self.elements[row])
    }
}

/// The elements of a plant.
#[derive(Debug)]
pub(crate) struct PivotPainter {
    elements: Vec<Element>,
    /// The element of what is rooted at a place, by the bits of its coordinates in a mesh.
    rooted: BTreeMap<[u32; 3], u32>,
    /// Wood that stands on the ground, and all other.
    woods: [Wood; 2],
}

/// Elements under construction.
struct Division<'a> {
    plant: &'a Plant,
    /// Most steps of wood.
    most: u32,
    has_leaves: bool,
    elements: Vec<Element>,
    /// The element of each axis.
    of_axis: Vec<Option<u32>>,
}

impl Division<'_> {
    /// Adds an element; `None` if there are too many.
    fn add(&mut self, pivot: DVec3, parent: Option<u32>) -> Option<u32> {
        let row = u32::try_from(self.elements.len()).ok().filter(|row| (*row as usize) < MOST)?;
        let steps = parent.map_or(0, |p| self.elements[p as usize].steps + 1);
        self.elements.push(Element { pivot, parent: parent.unwrap_or(row), steps });
        Some(row)
    }

    /// Returns the element of the wood at a node.
    fn element_at(&self, node: NodeId) -> Option<u32> {
        let axis = self.plant.nodes.axis.get(node.index())?;
        self.of_axis.get(axis.index()).copied().flatten()
    }

    /// Gives wood its elements: each tube has one, or that of its bearer. `None` if there are too many.
    fn divide_wood(&mut self) -> Option<()> {
        for tube in skin::tubes_of(self.plant) {
            let Some(&first) = tube.first() else { continue };
            let axis = self.plant.axis(first);
            let host = axis.bearer.and_then(|bearer| self.element_at(bearer));
            let element = match host {
                Some(host) if !self.has_own(axis, host) => host,
                _ => {
                    let pivot = self.plant.axis_points(first).first().copied().unwrap_or(DVec3::ZERO);
                    self.add(pivot, host)?
                }
            };
            tube.iter().for_each(|axis| self.of_axis[axis.index()] = Some(element));
        }
        Some(())
    }

    fn has_own(&self, axis: &Axis, host: u32) -> bool {
        match axis.kind {
            AxisKind::Root => false,
            AxisKind::Petiole => self.has_leaves,
            _ => self.elements[host as usize].steps < self.most,
        }
    }

    /// Gives organs their elements: those of one root one, on a stalk that of the stalk. `None` if there are too many.
    fn divide_organs(&mut self) -> Option<BTreeMap<[u32; 3], u32>> {
        let mut rooted = BTreeMap::new();
        for organ in self.plant.organs.iter().filter(|o| !matches!(o.kind, OrganKind::Thorn | OrganKind::Pot))
        {
            let key = bits(organ.frame.origin.as_vec3().to_array());
            let bearer = organ.bearer.and_then(|node| self.element_at(node));
            let on_stalk = organ.bearer.and_then(|node| self.plant.nodes.axis.get(node.index()));
            let on_stalk = on_stalk.is_some_and(|axis| self.plant.axis(*axis).kind == AxisKind::Petiole);
            let element = match (bearer, rooted.get(&key)) {
                (_, Some(&known)) => known,
                (Some(bearer), _) if on_stalk || !self.has_leaves => bearer,
                _ => self.add(organ.frame.origin, bearer)?,
            };
            rooted.insert(key, element);
        }
        Some(rooted)
    }

    /// Returns the wood that stands on the ground, and all other.
    fn woods(&self) -> [Wood; 2] {
        let (mut main, mut other) = (Vec::new(), Vec::new());
        for (axis, element) in self.plant.axes.iter().zip(&self.of_axis) {
            let Some(element) = *element else { continue };
            let rows = axis.nodes.start as usize..axis.nodes.end as usize;
            let line = self.plant.nodes.position.get(rows).unwrap_or_default();
            let list = if self.is_main(axis, element) { &mut main } else { &mut other };
            if axis.bearer.is_none() {
                list.extend(line.first().map(|p| (*p, element)));
            }
            for piece in line.windows(2) {
                list.extend(ALONG.map(|t| (piece[0].lerp(piece[1], t), element)));
            }
        }
        [Wood::new(main), Wood::new(other)]
    }

    /// Returns whether the wind moves an axis only with the whole plant.
    fn is_main(&self, axis: &Axis, element: u32) -> bool {
        axis.kind == AxisKind::Root || self.elements[element as usize].steps == 0
    }
}

impl PivotPainter {
    /// Divides a plant into at most 30,000 elements: its trunk, limbs, branches and leaves; of more, twigs with their
    /// leaves, and so on. Roots belong to what stands on them, stalks to their leaf. `None` for a plant without any.
    pub(crate) fn new(plant: &Plant) -> Option<Self> {
        let divided = |&(most, has_leaves): &(u32, bool)| {
            let of_axis = vec![None; plant.axes.len()];
            let mut division = Division { plant, most, has_leaves, elements: Vec::new(), of_axis };
            division.divide_wood()?;
            let rooted = division.divide_organs()?;
            let woods = division.woods();
            Some(Self { elements: division.elements, rooted, woods })
        };
        DIVISIONS.iter().find_map(divided).filter(|made| !made.elements.is_empty())
    }

    /// Columns and rows of the textures: powers of two, so that 16-bit floats hold the middles of texels exactly.
    fn sides(&self) -> (usize, usize) {
        let count = self.elements.len();
        let mut columns = 1;
        while columns * columns < count {
            columns *= 2;
        }
        (columns, count.div_ceil(columns).next_power_of_two())
    }

    /// Returns the middle of the texel of an element.
    fn cell(&self, element: u32) -> [f32; 2] {
        let (columns, rows) = self.sides();
        let at = |place: usize, count: usize| {
            #[expect(
                clippy::cast_precision_loss,
                clippy::cast_possible_truncation,
                reason = "at most 256 texels"
            )]
            let middle = ((place as f64 + 0.5) / count as f64) as f32;
            middle
        };
        [at(element as usize % columns, columns), at(element as usize / columns, rows)]
    }

    /// Returns the texture coordinates of the vertices of each part of a model of the plant, at any level of detail.
    pub(crate) fn cells(&self, model: &Model) -> Vec<Vec<[f32; 2]>> {
        let parts = model.parts.iter().map(|part| self.part_elements(model, part));
        parts.map(|rows| rows.into_iter().map(|element| self.cell(element)).collect()).collect()
    }

    /// Returns the element of each vertex of a part.
    fn part_elements(&self, model: &Model, part: &Part) -> Vec<u32> {
        use MaterialKind::{Bark, Root, Stem, YoungBark};
        let mesh = &part.mesh;
        let is_wood = matches!(model.material(part).kind, Bark | YoungBark | Stem | Root);
        let mut of: Vec<Option<u32>> = vec![None; mesh.positions.len()];
        if !is_wood {
            for (element, pivot) in of.iter_mut().zip(&mesh.pivots) {
                *element = self.rooted.get(&bits(*pivot)).copied();
            }
        }
        for piece in pieces(part, &of) {
            let is_main = piece.iter().all(|&v| mesh.wind.get(v).is_none_or(|wind| wind[1] == 0.0));
            let [main, other] = &self.woods;
            let nearest = |wood: &Wood, v: usize| wood.nearest(DVec3::from(mesh.positions[v].map(f64::from)));
            let vote = |&v: &usize| {
                let (first, second) = if is_main { (main, other) } else { (other, main) };
                nearest(first, v).or_else(|| nearest(second, v))
            };
            let element = most_frequent(piece.iter().rev().take(VOTES).filter_map(vote));
            piece.iter().for_each(|&v| of[v] = Some(element));
        }
        of.into_iter().map(|element| element.unwrap_or(0)).collect()
    }

    /// Returns for each element the direction from its pivot to the middle of its vertices, and how far they go along it,
    /// metres.
    fn spans(&self, model: &Model) -> Vec<(DVec3, f64)> {
        let parts: Vec<Vec<u32>> = model.parts.iter().map(|part| self.part_elements(model, part)).collect();
        let vertices = || {
            let parts = model.parts.iter().zip(&parts);
            parts.flat_map(|(part, of)| {
                part.mesh.positions.iter().map(|p| DVec3::from(p.map(f64::from))).zip(of)
            })
        };
        let mut sums = vec![DVec3::ZERO; self.elements.len()];
        for (place, &element) in vertices() {
            sums[element as usize] += place - self.elements[element as usize].pivot;
        }
        let mut spans: Vec<(DVec3, f64)> =
            sums.iter().map(|sum| (sum.try_normalize().unwrap_or(DVec3::Y), 0.0)).collect();
        for (place, &element) in vertices() {
            let (way, extent) = &mut spans[element as usize];
            *extent = extent.max((place - self.elements[element as usize].pivot).dot(*way));
        }
        spans
    }

    /// Writes the textures: `STEM-pivots.exr`, pivots and parents, and `STEM-axes.png`, directions and extents. `model`:
    /// the finest of the plant.
    ///
    /// # Errors
    /// [`WriteError`] of the writers.
    pub(crate) fn textures(&self, model: &Model, stem: &str) -> Result<Vec<BesideFile>, WriteError> {
        let (columns, rows) = self.sides();
        let mut pivots = vec![[0_u16; 4]; columns * rows];
        let mut axes = vec![0_u8; 4 * columns * rows];
        for (row, (element, (way, extent))) in self.elements.iter().zip(self.spans(model)).enumerate() {
            let [x, y, z] = in_unreal(element.pivot * CM).as_vec3().to_array().map(half_bits);
            pivots[row] = [x, y, z, index_bits(element.parent)];
            let [r, g, b] = in_unreal(way).to_array().map(|x| byte(0.5 + 0.5 * x));
            axes[4 * row..4 * row + 4].copy_from_slice(&[r, g, b, byte(extent * CM / FARTHEST_CM).max(1)]);
        }
        #[expect(clippy::cast_possible_truncation, reason = "at most 256 texels a side")]
        let (width, height) = (columns as u32, rows as u32);
        let (mut exr, mut png) = (Vec::new(), Vec::new());
        write_exr(width, height, &pivots, &mut exr)?;
        write_png(width, height, &axes, &mut png)?;
        let file = |name: String, bytes| BesideFile { what: Beside::Textures, name, bytes };
        Ok(vec![file(format!("{stem}-pivots.exr"), exr), file(format!("{stem}-axes.png"), png)])
    }
}

/// Returns a place or direction of glTF in Unreal's coordinates, as its importer turns them: +Z up, left-handed.
fn in_unreal(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, p.y)
}

/// Returns the bits of the 16-bit float that stands for an index.
fn index_bits(index: u32) -> u16 {
    u16::try_from(index as usize + INDEX_BASE).unwrap_or(u16::MAX)
}

fn bits(place: [f32; 3]) -> [u32; 3] {
    // -0 and 0 are one place.
    place.map(|x| (x + 0.0).to_bits())
}

fn byte(share: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let byte = (share.clamp(0.0, 1.0) * 255.0).round() as u8;
    byte
}

/// Returns what occurs most often, of several the least; 0 for nothing.
fn most_frequent(votes: impl Iterator<Item = u32>) -> u32 {
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    votes.for_each(|vote| *counts.entry(vote).or_default() += 1);
    let best = counts.iter().max_by(|a, b| a.1.cmp(b.1).then(b.0.cmp(a.0)));
    best.map_or(0, |(element, _)| *element)
}

/// Returns the connected pieces of the vertices that have no element yet, each ascending.
fn pieces(part: &Part, of: &[Option<u32>]) -> Vec<Vec<usize>> {
    let mut first: Vec<usize> = (0..of.len()).collect();
    let root = |first: &mut Vec<usize>, mut v: usize| {
        while first[v] != v {
            first[v] = first[first[v]];
            v = first[v];
        }
        v
    };
    for corners in &part.mesh.triangles {
        let [a, b, c] = corners.map(|corner| corner as usize);
        if of[a].is_none() && of[b].is_none() && of[c].is_none() {
            let a = root(&mut first, a);
            for other in [b, c] {
                let (a, other) = (root(&mut first, a), root(&mut first, other));
                first[a.max(other)] = a.min(other);
            }
        }
    }
    let mut rows: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for v in (0..of.len()).filter(|&v| of[v].is_none()) {
        let v0 = root(&mut first, v);
        rows.entry(v0).or_default().push(v);
    }
    rows.into_values().collect()
}
