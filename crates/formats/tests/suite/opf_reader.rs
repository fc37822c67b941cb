//! A reader of OPF 2.0, as `PlantGeom` reads it: reference meshes, shapes, and the tree with a matrix for each node.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use glam::{DMat3, DVec3};
use roxmltree::Node as Xml;

/// A reference mesh.
#[derive(Debug)]
pub(crate) struct Mesh {
    pub(crate) points: Vec<DVec3>,
    pub(crate) faces: Vec<[usize; 3]>,
    /// Whether the diameters of a node apply to it.
    pub(crate) scales: bool,
}

/// A node of the tree.
#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) class: String,
    /// `/` for a part, `<` for a successor, `+` for a branch.
    pub(crate) edge: char,
    pub(crate) scale: u32,
    pub(crate) id: u32,
    pub(crate) parent: Option<usize>,
    pub(crate) attributes: Vec<(String, String)>,
    /// Row of the meshes, matrix, and diameters at the lower and the upper end.
    pub(crate) geometry: Option<(usize, DMat3, DVec3, [f64; 2])>,
}

impl Node {
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        self.attributes.iter().find(|(n, _)| n == name)?.1.parse().ok()
    }
}

/// A file.
#[derive(Debug)]
pub(crate) struct Opf {
    pub(crate) meshes: Vec<(usize, Mesh)>,
    pub(crate) nodes: Vec<Node>,
}

fn numbers<T: std::str::FromStr<Err: std::fmt::Debug>>(text: &str) -> Vec<T> {
    text.split_whitespace().map(|word| word.parse().unwrap()).collect()
}

fn child<'a>(of: Xml<'a, 'a>, name: &str) -> Option<Xml<'a, 'a>> {
    of.children().find(|c| c.has_tag_name(name))
}

fn text<'a>(of: Xml<'a, 'a>, name: &str) -> &'a str {
    child(of, name).and_then(|c| c.text()).unwrap_or_default()
}

pub(crate) fn read(file: &str) -> Opf {
    let xml = roxmltree::Document::parse(file).unwrap();
    let root = xml.root_element();
    assert_eq!((root.tag_name().name(), root.attribute("version")), ("opf", Some("2.0")), "the version");
    let id = |n: Xml<'_, '_>| -> usize { n.attribute("Id").unwrap().parse().unwrap() };
    let of = |name: &str| {
        let parent = child(root, name).unwrap();
        parent.children().filter(Xml::is_element).collect::<Vec<_>>()
    };
    let meshes = of("meshBDD").into_iter().map(|m| {
        let points: Vec<f64> = numbers(text(m, "points"));
        let normals: Vec<f64> = numbers(text(m, "normals"));
        assert_eq!(points.len(), normals.len(), "a normal for each point");
        let faces = child(m, "faces").unwrap().children().filter(Xml::is_element);
        let faces = faces.map(|f| numbers::<usize>(f.text().unwrap()).try_into().unwrap()).collect();
        let points: Vec<DVec3> = points.chunks_exact(3).map(DVec3::from_slice).collect();
        let mesh = Mesh { points, faces, scales: m.attribute("enableScale").unwrap().parse().unwrap() };
        assert!(mesh.faces.iter().flatten().all(|&i| i < mesh.points.len()), "corners are points");
        (id(m), mesh)
    });
    let meshes: Vec<(usize, Mesh)> = meshes.collect();
    let materials: Vec<usize> = of("materialBDD")
        .into_iter()
        .map(|m| {
            for part in ["emission", "ambient", "diffuse", "specular"] {
                assert_eq!(numbers::<f64>(text(m, part)).len(), 4, "{part}");
            }
            id(m)
        })
        .collect();
    let shapes: Vec<(usize, usize)> = of("shapeBDD")
        .into_iter()
        .map(|s| {
            let material: usize = text(s, "materialIndex").trim().parse().unwrap();
            assert!(
                materials.contains(&material) && !text(s, "name").trim().is_empty(),
                "a material and a name"
            );
            (id(s), text(s, "meshIndex").trim().parse().unwrap())
        })
        .collect();
    let known: Vec<&str> = of("attributeBDD").into_iter().map(|a| a.attribute("name").unwrap()).collect();
    let mut nodes = Vec::new();
    let mut waiting = vec![(child(root, "topology").unwrap(), None)];
    while let Some((xml, parent)) = waiting.pop() {
        let edge = match xml.tag_name().name() {
            "topology" | "decomp" => '/',
            "follow" => '<',
            "branch" => '+',
            other => panic!("{other} is no node of a tree"),
        };
        let (mut attributes, mut geometry, mut children) = (Vec::new(), None, Vec::new());
        for part in xml.children().filter(Xml::is_element) {
            let name = part.tag_name().name();
            if known.contains(&name) {
                attributes.push((name.to_owned(), part.text().unwrap_or_default().to_owned()));
            } else if name == "geometry" {
                let Some(shape) = child(part, "shapeIndex") else { continue };
                let shape: usize = shape.text().unwrap().trim().parse().unwrap();
                let mesh = shapes.iter().find(|s| s.0 == shape).unwrap().1;
                let row = meshes.iter().position(|m| m.0 == mesh).unwrap();
                let m: Vec<f64> = numbers(text(part, "mat"));
                let column = |k: usize| DVec3::new(m[k], m[4 + k], m[8 + k]);
                assert_eq!(m.len(), 12, "three rows of a matrix");
                let diameters = ["dDwn", "dUp"].map(|d| text(part, d).trim().parse().unwrap());
                let turn = DMat3::from_cols(column(0), column(1), column(2));
                geometry = Some((row, turn, column(3), diameters));
            } else {
                children.push(part);
            }
        }
        let row = nodes.len();
        nodes.push(Node {
            class: xml.attribute("class").unwrap().to_owned(),
            edge,
            scale: xml.attribute("scale").unwrap().parse().unwrap(),
            id: xml.attribute("id").unwrap().parse().unwrap(),
            parent,
            attributes,
            geometry,
        });
        waiting.extend(children.into_iter().rev().map(|c| (c, Some(row))));
    }
    Opf { meshes, nodes }
}
