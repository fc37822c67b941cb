//! Open Plant Format -> cylinders and organs.

use std::collections::BTreeMap;

use base::Report;
use glam::DVec3;
use plant::{AxisKind, Frame, OrganKind};
use roxmltree::{Document, Node};

use super::cylinders::{Cylinder, joined};
use super::joints::{Built, Link, build};
use super::organs::{Found, Shapes};
use super::{Fault, Inward, LIMITS, StructureSpec, fault_at, place_of, said_in};
use crate::error::FileFault;

/// Most nodes of XML: some thirty for each internode.
const MOST_NODES: u32 = 40_000_000;

/// Reads an OPF.
pub(super) fn read(text: &str, spec: &StructureSpec, report: &mut Report) -> Result<Built, Fault> {
    let options =
        roxmltree::ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..Default::default() };
    let document = Document::parse_with_options(text, options).map_err(|e| {
        let line = e.pos().row as usize;
        fault_at(line, format!("it is no sound XML: {e}"), "export it again")
    })?;
    let said = document
        .root()
        .descendants()
        .take(64)
        .filter(|n| n.is_comment())
        .filter_map(|n| n.text())
        .map(said_in)
        .find(|said| said.0.is_some());
    let said = said.unwrap_or_default();
    let is_own = said.0.is_some();
    let inward = Inward::new(spec, said);
    let meshes = Meshes::read(&document);
    let mut topology = Topology { cylinders: Vec::new(), organs: Vec::new(), entries: 0 };
    let placed = |(at, fault): Fault| {
        let line = if at > 0 { document.text_pos_at(at).row as usize } else { 0 };
        (line, fault)
    };
    topology.read(&document, &meshes, &inward, is_own).map_err(placed)?;
    if topology.cylinders.is_empty() {
        let advice = "export the plant with its geometry: each internode needs a mesh and a matrix";
        return Err(fault_at(0, "there is no internode with a geometry in it", advice));
    }
    let (joints, ends) = joined(&topology.cylinders).map_err(placed)?;
    let mut built = build(&joints).map_err(placed)?;
    let mut shapes: BTreeMap<usize, Shapes> = BTreeMap::new();
    let mut added = 0_u64;
    for (bearer, found) in &topology.organs {
        let at = bearer.and_then(|c| built.nodes[ends[c]]);
        let (plant, node) = at.map_or((0, None), |(plant, node)| (plant, Some(node)));
        let Some(of) = built.plants.get_mut(plant) else { continue };
        added += u64::from(shapes.entry(plant).or_default().add(of, &Found { bearer: node, ..*found }));
    }
    if added > 0 {
        base::warn!(
            report,
            "organs-plain",
            { organs = added },
            "{organs} organs have plain shapes of the length and area that the file says: outlines are not read"
        );
    }
    let wood = ends.iter().filter(|&&j| built.nodes[j].is_some()).count() as u64;
    built.tally.entries = topology.entries;
    built.tally.used = wood + added;
    built.tally.unit_said = is_own;
    Ok(built)
}

/// Reference meshes by their numbers: the bounding box of each, and the area of its triangles' projections on three
/// planes.
struct Meshes {
    meshes: BTreeMap<i64, Reference>,
    /// The mesh of each shape.
    of_shape: BTreeMap<i64, i64>,
}

#[derive(Clone, Debug)]
struct Reference {
    low: DVec3,
    high: DVec3,
    /// The sum of the area vectors of its triangles, with each component made positive.
    area: DVec3,
}

fn numbers(text: &str) -> impl Iterator<Item = f64> + '_ {
    text.split_whitespace().filter_map(|w| w.parse().ok())
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|c| c.has_tag_name(name))
}

fn whole(text: Option<&str>) -> Option<i64> {
    text?.trim().parse().ok()
}

impl Meshes {
    fn read(document: &Document<'_>) -> Self {
        let mut out = Self { meshes: BTreeMap::new(), of_shape: BTreeMap::new() };
        for node in document.descendants() {
            if node.has_tag_name("mesh") {
                let points = child(node, "points").and_then(|p| p.text()).unwrap_or("");
                let flat: Vec<f64> = numbers(points).collect();
                let points: Vec<DVec3> = flat.chunks_exact(3).map(DVec3::from_slice).collect();
                if let Some(id) = whole(node.attribute("Id")).filter(|_| !points.is_empty()) {
                    out.meshes.insert(id, Reference::new(&points, child(node, "faces")));
                }
            } else if node.has_tag_name("shape") {
                let of = |name| whole(child(node, name).and_then(|c| c.text()));
                if let Some((id, mesh)) = whole(node.attribute("Id")).zip(of("meshIndex")) {
                    out.of_shape.insert(id, mesh);
                }
            }
        }
        out
    }

    fn mesh_of_shape(&self, shape: i64) -> Option<&Reference> {
        self.meshes.get(self.of_shape.get(&shape)?)
    }
}

impl Reference {
    fn new(points: &[DVec3], faces: Option<Node<'_, '_>>) -> Self {
        let low = points.iter().fold(DVec3::INFINITY, |a, b| a.min(*b));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |a, b| a.max(*b));
        let mut area = DVec3::ZERO;
        for face in faces.into_iter().flat_map(|f| f.children()).filter(|f| f.has_tag_name("face")) {
            let corners: Vec<DVec3> = face
                .text()
                .unwrap_or("")
                .split_whitespace()
                .filter_map(|w| w.parse::<usize>().ok())
                .filter_map(|k| points.get(k).copied())
                .collect();
            if let [a, b, c] = corners[..] {
                area += (0.5 * (b - a).cross(c - a)).abs();
            }
        }
        Self { low, high, area }
    }
}

/// Place of an element in the tree.
#[derive(Clone, Copy, Default)]
struct Place {
    /// The cylinder on which its successor hangs, and how.
    cylinder: Option<usize>,
    branches: bool,
}

struct Topology {
    cylinders: Vec<Cylinder>,
    /// Organs, each with the cylinder that bears it.
    organs: Vec<(Option<usize>, Found)>,
    entries: u64,
}

/// Returns the kind of organ of a class of elements.
fn organ_of(class: &str) -> Option<OrganKind> {
    const WORDS: [(&str, OrganKind); 14] = [
        ("leaf", OrganKind::Leaf),
        ("petal", OrganKind::Petal),
        ("sepal", OrganKind::Sepal),
        ("disc", OrganKind::Disc),
        ("fruit", OrganKind::Fruit),
        ("stamen", OrganKind::Stamen),
        ("pistil", OrganKind::Pistil),
        ("anther", OrganKind::Anther),
        ("floret", OrganKind::Floret),
        ("body", OrganKind::Body),
        ("pot", OrganKind::Pot),
        ("thorn", OrganKind::Thorn),
        ("pedicel", OrganKind::Pedicel),
        ("blade", OrganKind::Leaf),
    ];
    let low = class.to_ascii_lowercase();
    WORDS.into_iter().find(|(word, _)| low.contains(word)).map(|(_, kind)| kind)
}

fn axis_of(name: &str) -> Option<AxisKind> {
    Some(match name {
        "trunk" | "branch" => AxisKind::Branch,
        "twig" => AxisKind::Twig,
        "stem" => AxisKind::Stem,
        "petiole" => AxisKind::Petiole,
        "root" => AxisKind::Root,
        "stub" => AxisKind::Stub,
        _ => return None,
    })
}

impl Topology {
    /// Walks through the tree in the order of the file; with explicit rows instead of recursion, as it may be deep.
    fn read(
        &mut self,
        document: &Document<'_>,
        meshes: &Meshes,
        inward: &Inward,
        is_own: bool,
    ) -> Result<(), Fault> {
        let is_entry = |n: &Node<'_, '_>| {
            n.is_element() && ["topology", "decomp", "follow", "branch"].contains(&n.tag_name().name())
        };
        let mut places: BTreeMap<usize, Place> = BTreeMap::new();
        let mut kinds: BTreeMap<usize, AxisKind> = BTreeMap::new();
        // For each element: the last of its parts, or of the parts of its successor.
        let mut ends: BTreeMap<usize, usize> = BTreeMap::new();
        for node in document.descendants().filter(is_entry) {
            self.entries += 1;
            // The line is searched only for messages, because that goes through the whole text.
            let at = node.range().start;
            if self.entries > LIMITS.joints as u64 {
                let (what, advice) = ("the number of elements", "split the file into one for each plant");
                return Err((at, FileFault::TooMuch { what, limit: LIMITS.joints as u64, advice }));
            }
            let above = node.parent().filter(is_entry);
            let follows = node.has_tag_name("follow");
            let mut siblings = node.prev_siblings().skip(1).filter(|_| follows);
            let before = siblings.find(|n| is_entry(n) && !n.has_tag_name("branch"));
            let of = |n: Option<Node<'_, '_>>| {
                n.and_then(|n| places.get(&n.id().get_usize()).copied()).unwrap_or_default()
            };
            let end_of = |n: Node<'_, '_>| ends.get(&n.id().get_usize()).copied();
            let tag = node.tag_name().name();
            let place = match (tag, above, before) {
                ("follow", _, Some(before)) => Place {
                    cylinder: end_of(before).or(of(Some(before)).cylinder),
                    branches: end_of(before).is_none() && of(Some(before)).branches,
                },
                ("branch", Some(above), _) => {
                    Place { cylinder: end_of(above).or(of(Some(above)).cylinder), branches: true }
                }
                _ => of(above),
            };
            let class = node.attribute("class").unwrap_or("");
            let name = child(node, "Name").and_then(|n| n.text()).unwrap_or("").trim();
            let own = axis_of(name).or_else(|| above.and_then(|a| kinds.get(&a.id().get_usize()).copied()));
            if let Some(kind) = own {
                kinds.insert(node.id().get_usize(), kind);
            }
            places.insert(node.id().get_usize(), place);
            if let Some(kind) = organ_of(class) {
                if let Some(found) = organ(node, kind, meshes, inward, is_own, self.entries) {
                    self.organs.push((place.cylinder, found));
                }
                continue;
            }
            // An element whose parts have a geometry is not a piece of wood itself, such as the box around a plant.
            let has_parts = node.children().any(|c| c.has_tag_name("decomp"));
            let Some(geometry) = child(node, "geometry").filter(|_| !has_parts) else { continue };
            let link = match (place.cylinder, place.branches) {
                (None, _) => Link::Unsaid,
                (Some(_), true) => Link::Branches,
                (Some(_), false) => Link::Follows,
            };
            let wood = Cylinder {
                parent: place.cylinder,
                link,
                kind: own.unwrap_or(AxisKind::Branch),
                line: at,
                ..cylinder(geometry, meshes, inward).ok_or_else(|| {
                    fault_at(
                        at,
                        "the matrix of the internode is none of 12 numbers, or its mesh is missing",
                        "export it again",
                    )
                })?
            };
            self.cylinders.push(wood);
            let row = self.cylinders.len() - 1;
            // The cylinder ends the elements of which it is a part, too.
            let mut up = Some(node);
            while let Some(n) = up {
                ends.insert(n.id().get_usize(), row);
                up = if n.has_tag_name("branch") { None } else { n.parent().filter(is_entry) };
                if let Some(whole) = up.filter(|w| w.has_tag_name("branch")) {
                    ends.insert(whole.id().get_usize(), row);
                    up = None;
                }
            }
        }
        Ok(())
    }
}

/// Returns the columns of a matrix and its origin, in the axes and unit of the file.
fn matrix(geometry: Node<'_, '_>) -> Option<[DVec3; 4]> {
    let text = child(geometry, "mat")?.text()?;
    let m: Vec<f64> = numbers(text).collect();
    let column = |k: usize| place_of([m.get(k).copied(), m.get(4 + k).copied(), m.get(8 + k).copied()]);
    if m.len() < 12 {
        return None;
    }
    Some([column(0)?, column(1)?, column(2)?, column(3)?])
}

fn mesh_of<'a>(geometry: Node<'_, '_>, meshes: &'a Meshes) -> Option<&'a Reference> {
    meshes.mesh_of_shape(whole(child(geometry, "shapeIndex").and_then(|s| s.text()))?)
}

/// Returns an internode: its mesh lies along x.
fn cylinder(geometry: Node<'_, '_>, meshes: &Meshes, inward: &Inward) -> Option<Cylinder> {
    let [x, .., at] = matrix(geometry)?;
    let mesh = mesh_of(geometry, meshes)?;
    let ends = [mesh.low.x, mesh.high.x].map(|s| inward.place(at + x * s));
    let wide = (mesh.high.y - mesh.low.y).max(mesh.high.z - mesh.low.z);
    let radius = |name| {
        let scale: Option<f64> =
            child(geometry, name).and_then(|c| c.text()).and_then(|t| t.trim().parse().ok());
        inward.radius(scale.map(|s| 0.5 * s * wide))
    };
    let radii = [radius("dDwn"), radius("dUp")];
    let known = radii.iter().all(|r| !r.is_nan());
    Some(Cylinder {
        ends,
        radius: if known { 0.5 * (radii[0] + radii[1]) } else { f64::NAN },
        end_radii: known.then_some(radii),
        parent: None,
        link: Link::Unsaid,
        kind: AxisKind::Branch,
        line: 0,
    })
}

/// Returns an organ by its attributes, or by its mesh. Our own meshes lie along y, others along x.
fn organ(
    node: Node<'_, '_>,
    kind: OrganKind,
    meshes: &Meshes,
    inward: &Inward,
    is_own: bool,
    key: u64,
) -> Option<Found> {
    let geometry = child(node, "geometry")?;
    let [x, y, z, at] = matrix(geometry)?;
    let mesh = mesh_of(geometry, meshes)?;
    let said = |name| -> Option<f64> { child(node, name)?.text()?.trim().parse().ok() };
    let (along, reach, normal) = if is_own { (y, mesh.high.y, z) } else { (x, mesh.high.x, z) };
    // The matrix scales the area in each plane by the length of the cross product of the two columns that span it.
    let planes = [y.cross(z), z.cross(x), x.cross(y)].map(DVec3::length);
    let area = mesh.area.dot(DVec3::from_array(planes)) * inward.metres * inward.metres;
    let area = said("Area").map(|a| a * inward.metres * inward.metres).filter(|_| is_own).unwrap_or(area);
    // Our own bodies have no length.
    let long = if is_own { said("Length") } else { Some(along.length() * reach) };
    Some(Found {
        kind,
        bearer: None,
        frame: Frame::looking(inward.place(at), inward.turn(along), inward.turn(normal)),
        length_m: long.map(|l| l * inward.metres),
        area_m2: Some(area),
        key,
    })
}
