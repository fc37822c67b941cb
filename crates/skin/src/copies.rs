//! Leaves as copies of one another, for files that hold each form once.
//!
//! `Plant, Model, Layout -> Model without them | Copies`

use std::collections::BTreeMap;

use core::ops::Range;

use glam::{DMat3, DQuat, DVec3};
use mesh::{Copies, CopyPlace, Model, Part, TriMesh};
use plant::{Frame, Organ, OrganId, Plant};

use crate::layout::{Layout, Owner};
use crate::sleeve::{narrow, wide};

/// Least number of copies that save anything.
const FEW: usize = 8;

/// Removes the organs from a model that are copies of one another: of the same form, in one colour each. `layout` gives
/// the contents of the parts of the model, which is of `plant` ([`crate::skin_laid_out`]).
///
/// Guaranteed: the rest and [`Copies::flattened`] together are the model's triangles, corners to a few millionths of
/// the plant's size; each copy once. Not guaranteed: their order. Models with wind are unchanged: there each vertex has
/// numbers of its own. Cost: linear in vertices.
pub fn copies(plant: &Plant, model: &Model, layout: &Layout) -> (Model, Vec<Copies>) {
    let mut rest = Model { parts: Vec::new(), ..model.clone() };
    let mut all = Vec::new();
    for (part, owners) in model.parts.iter().zip(layout.owners()) {
        let mut first = 0_usize;
        let pieces: Vec<(Option<OrganId>, Range<usize>)> = owners
            .map(|(owner, triangles)| {
                let range = first..first + triangles as usize;
                first = range.end;
                match owner {
                    Owner::Organ(id) => (Some(id), range),
                    Owner::Axes(_) => (None, range),
                }
            })
            .collect();
        if first != part.mesh.triangles.len() || !part.mesh.wind.is_empty() {
            rest.parts.push(part.clone());
            continue;
        }
        let (taken, found) = part_copies(plant, part, &pieces);
        all.extend(found);
        let left = |&(k, _): &(usize, &Range<usize>)| !taken[k];
        let ranges: Vec<&Range<usize>> =
            pieces.iter().map(|(_, r)| r).enumerate().filter(left).map(|(_, r)| r).collect();
        if ranges.len() == pieces.len() {
            rest.parts.push(part.clone());
        } else if !ranges.is_empty() {
            let mut mesh = TriMesh::default();
            ranges.into_iter().for_each(|r| mesh.append(&piece(&part.mesh, r)));
            rest.parts.push(Part { mesh, ..part.clone() });
        }
    }
    (rest, all)
}

/// Finds the pieces of a part that are copies.
fn part_copies(
    plant: &Plant,
    part: &Part,
    pieces: &[(Option<OrganId>, Range<usize>)],
) -> (Vec<bool>, Vec<Copies>) {
    let mut taken = vec![false; pieces.len()];
    let mut forms: BTreeMap<usize, Vec<(usize, &Organ)>> = BTreeMap::new();
    for (k, (id, range)) in pieces.iter().enumerate() {
        let organ = id.and_then(|id| plant.organs.get(id.index()));
        if let Some(organ) = organ.filter(|o| !range.is_empty() && square(&o.frame)) {
            forms.entry(organ.shape.index()).or_default().push((k, organ));
        }
    }
    let mut found = Vec::new();
    for members in forms.into_values().filter(|m| m.len() >= FEW) {
        // The nearest to the origin has the finest coordinates.
        let nearest = members
            .iter()
            .min_by(|a, b| a.1.frame.origin.length_squared().total_cmp(&b.1.frame.origin.length_squared()));
        let Some(&(k, organ)) = nearest else { continue };
        let first = piece(&part.mesh, &pieces[k].1);
        let back = |p: &[f32; 3]| narrow(organ.frame.localise(wide(*p)) / organ.scale);
        let still = Frame { origin: DVec3::ZERO, ..organ.frame };
        let form = TriMesh {
            positions: first.positions.iter().map(back).collect(),
            normals: first.normals.iter().map(|n| narrow(still.localise(wide(*n)))).collect(),
            colors: Vec::new(),
            ..first
        };
        let mut places = Vec::with_capacity(members.len());
        for (k, organ) in members {
            let own = piece(&part.mesh, &pieces[k].1);
            let color = own.colors.first().copied().unwrap_or([1.0; 3]);
            let alike = own.triangles == form.triangles && own.uvs == form.uvs;
            if !alike || own.colors.iter().any(|c| *c != color) {
                continue;
            }
            let f = &organ.frame;
            let turn = DQuat::from_mat3(&DMat3::from_cols(f.right, f.along, f.normal)).normalize();
            places.push(CopyPlace { at: f.origin, turn, scale: organ.scale, color });
            taken[k] = true;
        }
        if !places.is_empty() {
            found.push(Copies { name: part.name.clone(), material: part.material, mesh: form, places });
        }
    }
    (taken, found)
}

/// Whether a frame is a pure rotation.
fn square(f: &Frame) -> bool {
    const NEARLY: f64 = 1e-6;
    let unit = |v: DVec3| (v.length_squared() - 1.0).abs() < NEARLY;
    unit(f.right)
        && unit(f.along)
        && f.right.dot(f.along).abs() < NEARLY
        && f.right.cross(f.along).distance(f.normal) < NEARLY
        && f.origin.is_finite()
}

/// Returns the triangles of a range with only their vertices, in the order of these.
fn piece(mesh: &TriMesh, range: &Range<usize>) -> TriMesh {
    let triangles = mesh.triangles.get(range.clone()).unwrap_or_default();
    let corners = || triangles.iter().flatten().copied();
    let (low, high) = (corners().min().unwrap_or(0), corners().max().map_or(0, |m| m + 1));
    let rows = low as usize..high as usize;
    fn copy_rows<T: Copy>(column: &[T], rows: &Range<usize>) -> Vec<T> {
        column.get(rows.clone()).unwrap_or_default().to_vec()
    }
    TriMesh {
        positions: copy_rows(&mesh.positions, &rows),
        normals: copy_rows(&mesh.normals, &rows),
        uvs: copy_rows(&mesh.uvs, &rows),
        colors: copy_rows(&mesh.colors, &rows),
        triangles: triangles.iter().map(|t| t.map(|i| i - low)).collect(),
        ..TriMesh::default()
    }
}
