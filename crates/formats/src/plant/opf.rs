//! Plant -> Open Plant Format, as `AMAPstudio`, `ARCHIMED` and `PlantGeom` read it: structure and meshes in one file.

use std::io::Write;

use base::UpAxis;
use glam::DVec3;
use mesh::TriMesh;
use plant::{AxisId, AxisKind, NodeId, Organ, OrganKind, Plant};

use super::{AddedColumn, Borne, Subject, decimal, length, micrometres, numbered, place, turn};
use crate::{ExportSpec, WriteError};

/// Number of sides of the reference mesh of wood.
const SIDES: u32 = 12;

/// Attributes of the nodes of the tree, with their types.
const ATTRIBUTES: [(&str, &str); 5] = [
    ("Name", "String"),
    ("Length", "Double"),
    ("Width", "Double"),
    ("Area", "Double"),
    ("Flower", "Integer"),
];

/// Writes a sound plant as OPF 2.0 (XML): reference meshes, materials, and the tree of the plant: the plant, its axes,
/// their internodes, and organs, each with a matrix that puts a reference mesh in its place.
///
/// `shapes`: the mesh of each of the plant's shapes at scale 1, in metres, in the coordinates of its organs; an organ
/// whose mesh is missing or empty has no geometry. An internode is a cylinder along x with the diameters `dDwn` and
/// `dUp` of its ends, between two nodes of its axis. Lengths are in `spec`'s unit, to a micrometre; areas in its
/// square. An axis or organ hangs on the internode that ends at its bearer. Not written: textures, wind, strokes.
/// Cost: linear.
///
/// # Errors
/// [`WriteError::Io`].
///
/// ```
/// use glam::DVec3;
/// let mut p = plant::Plant::default();
/// p.add_axis(plant::AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::Y * 2.0], None);
/// let mut out = Vec::new();
/// formats::write_opf(&p, &[], &formats::ExportSpec::default(), &mut out)?;
/// assert!(String::from_utf8(out)?.contains("<decomp class=\"Internode\" scale=\"3\""));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn write_opf(
    plant: &Plant,
    shapes: &[TriMesh],
    spec: &ExportSpec,
    out: impl Write,
) -> Result<(), WriteError> {
    write_opf_with(plant, shapes, &[], spec, out)
}

/// Writes as [`write_opf`] does, with further attributes of axes and organs.
pub(super) fn write_opf_with(
    plant: &Plant,
    shapes: &[TriMesh],
    added: &[AddedColumn],
    spec: &ExportSpec,
    out: impl Write,
) -> Result<(), WriteError> {
    let borne = Borne::from_plant(plant);
    let areas = plant.shapes.iter().map(plant::Shape::one_side_m2).collect();
    let mut writer = Writer { plant, added, spec, out, areas, looks: Vec::new(), next: 1 };
    writer.head(shapes)?;
    writer.open("topology", "Plant", 1)?;
    let name = base::escaped_xml(&plant.name).trim().to_owned();
    writer.say("Name", if name.is_empty() { "plant" } else { &name })?;
    for (id, _) in numbered(plant).filter(|(id, _)| plant.axis(*id).bearer.is_none()) {
        writer.tree(id, &borne)?;
    }
    for (row, organ) in plant.organs.iter().enumerate().filter(|(_, o)| o.bearer.is_none()) {
        // An organ must belong to an axis, so each organ without a bearer gets one of its own.
        writer.open("decomp", "Axis", 2)?;
        writer.say("Name", "none")?;
        writer.organ("decomp", row, organ)?;
        writer.close("decomp")?;
    }
    writer.close("topology")?;
    Ok(writeln!(writer.out, "</opf>")?)
}

/// Returns the class of an organ, its name and its colour without paint.
fn organ_class(kind: OrganKind) -> (&'static str, &'static str, [f64; 3]) {
    const GREEN: [f64; 3] = [0.25, 0.45, 0.12];
    match kind {
        OrganKind::Petal => ("Petal", "petal", [0.95, 0.85, 0.88]),
        OrganKind::Disc => ("Disc", "disc", [0.75, 0.6, 0.15]),
        OrganKind::Fruit | OrganKind::Syncarp => ("Fruit", "fruit", [0.7, 0.25, 0.15]),
        OrganKind::Stamen => ("Stamen", "stamen", [0.9, 0.8, 0.4]),
        OrganKind::Pistil => ("Pistil", "pistil", GREEN),
        OrganKind::Sepal => ("Sepal", "sepal", GREEN),
        OrganKind::Anther => ("Anther", "anther", [0.8, 0.6, 0.2]),
        OrganKind::Floret => ("Floret", "floret", [0.8, 0.65, 0.2]),
        OrganKind::Body => ("Body", "body", GREEN),
        OrganKind::Pot => ("Pot", "pot", [0.6, 0.3, 0.2]),
        OrganKind::Thorn => ("Thorn", "thorn", [0.5, 0.35, 0.25]),
        OrganKind::Pedicel => ("Pedicel", "pedicel", GREEN),
        _ => ("Leaf", "leaf", GREEN),
    }
}

struct Writer<'a, W> {
    plant: &'a Plant,
    added: &'a [AddedColumn],
    spec: &'a ExportSpec,
    out: W,
    /// Area of one side of each shape, square metres, at scale 1.
    areas: Vec<f64>,
    /// Shapes of the plant with the kind of organ: the shapes of the file from 1 on. 0 is wood.
    looks: Vec<(usize, OrganKind)>,
    /// Number of the next node of the tree.
    next: usize,
}

/// An axis that is being written, and the progress.
struct Frame {
    axis: AxisId,
    /// Tag of its element.
    tag: &'static str,
    /// The internode that ends at the node of this index comes next.
    node: usize,
    /// Tag of the open internode, and the axes on it that are still to be written; none if no internode is open.
    waiting: Option<(&'static str, Vec<AxisId>)>,
}

impl<W: Write> Writer<'_, W> {
    fn head(&mut self, shapes: &[TriMesh]) -> Result<(), WriteError> {
        let up = match self.spec.up {
            UpAxis::Y => 'Y',
            UpAxis::Z => 'Z',
        };
        writeln!(self.out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
        writeln!(self.out, "<opf version=\"2.0\" editable=\"true\">")?;
        let version = env!("CARGO_PKG_VERSION");
        writeln!(self.out, "<!-- Burgeon {version}; lengths in {}, +{up} up -->", self.spec.unit.plural())?;
        // Organs of one shape and kind share a mesh and a material, which has the colour of the first.
        let mut first: Vec<&Organ> = Vec::new();
        for organ in &self.plant.organs {
            let look = (organ.shape.index(), organ.kind);
            let drawn = shapes.get(look.0).is_some_and(|m| !m.triangles.is_empty());
            if drawn && !self.looks.contains(&look) {
                self.looks.push(look);
                first.push(organ);
            }
        }
        writeln!(self.out, "<meshBDD>")?;
        self.mesh(0, &cylinder(), true)?;
        for (k, row) in self.looks.iter().map(|l| l.0).enumerate().collect::<Vec<_>>() {
            self.mesh(k + 1, &shapes[row], false)?;
        }
        writeln!(self.out, "</meshBDD>\n<materialBDD>")?;
        self.material(0, [0.38, 0.31, 0.25])?;
        for (k, organ) in first.into_iter().enumerate() {
            let (_, _, own) = organ_class(organ.kind);
            let paint = organ.paint.rgb();
            self.material(k + 1, [0, 1, 2].map(|i| (own[i] * f64::from(paint[i])).clamp(0.0, 1.0)))?;
        }
        writeln!(self.out, "</materialBDD>\n<shapeBDD>")?;
        for k in 0..=self.looks.len() {
            let name = if k == 0 { "wood" } else { organ_class(self.looks[k - 1].1).1 };
            writeln!(
                self.out,
                "<shape Id=\"{k}\"><name>{name}</name><meshIndex>{k}</meshIndex><materialIndex>{k}</materialIndex></shape>"
            )?;
        }
        writeln!(self.out, "</shapeBDD>\n<attributeBDD>")?;
        for (name, class) in ATTRIBUTES {
            writeln!(self.out, "<attribute name=\"{name}\" class=\"{class}\"/>")?;
        }
        for column in self.added {
            writeln!(self.out, "<attribute name=\"{}\" class=\"Double\"/>", column.name)?;
        }
        Ok(writeln!(self.out, "</attributeBDD>")?)
    }

    /// Writes a reference mesh; its matrix converts it to the unit and axes of the file.
    fn mesh(&mut self, id: usize, mesh: &TriMesh, scales: bool) -> Result<(), WriteError> {
        let out = &mut self.out;
        writeln!(out, "<mesh name=\"\" shape=\"\" Id=\"{id}\" enableScale=\"{scales}\">")?;
        write!(out, "<points>")?;
        for p in mesh.positions.as_flattened() {
            write!(out, "{}\t", decimal(f64::from(*p), 7))?;
        }
        write!(out, "</points>\n<normals>")?;
        for n in mesh.normals.as_flattened() {
            write!(out, "{}\t", decimal(f64::from(*n), 5))?;
        }
        writeln!(out, "</normals>")?;
        if mesh.uvs.len() == mesh.positions.len() {
            write!(out, "<textureCoords>")?;
            for uv in mesh.uvs.as_flattened() {
                write!(out, "{}\t", decimal(f64::from(*uv), 5))?;
            }
            writeln!(out, "</textureCoords>")?;
        }
        writeln!(out, "<faces>")?;
        for (k, [a, b, c]) in mesh.triangles.iter().enumerate() {
            writeln!(out, "<face Id=\"{k}\">{a}\t{b}\t{c}</face>")?;
        }
        Ok(writeln!(out, "</faces>\n</mesh>")?)
    }

    fn material(&mut self, id: usize, rgb: [f64; 3]) -> Result<(), WriteError> {
        let four = |rgb: [f64; 3], a: f64| {
            let [r, g, b] = rgb.map(|x| decimal(x, 4));
            format!("{r}\t{g}\t{b}\t{}", decimal(a, 4))
        };
        let (none, ambient) = (four([0.0; 3], 1.0), four(rgb.map(|x| 0.3 * x), 1.0));
        let (diffuse, specular) = (four(rgb, 1.0), four([0.05; 3], 1.0));
        writeln!(
            self.out,
            "<material Id=\"{id}\"><emission>{none}</emission><ambient>{ambient}</ambient><diffuse>{diffuse}</diffuse>\
             <specular>{specular}</specular><shininess>10</shininess></material>"
        )
        .map_err(WriteError::from)
    }

    fn open(&mut self, tag: &str, class: &str, scale: u8) -> Result<(), WriteError> {
        let id = self.next;
        self.next += 1;
        Ok(writeln!(self.out, "<{tag} class=\"{class}\" scale=\"{scale}\" id=\"{id}\">")?)
    }

    fn close(&mut self, tag: &str) -> Result<(), WriteError> {
        Ok(writeln!(self.out, "</{tag}>")?)
    }

    fn say(&mut self, name: &str, value: &str) -> Result<(), WriteError> {
        Ok(writeln!(self.out, "<{name}>{value}</{name}>")?)
    }

    fn say_added(&mut self, subject: Subject) -> Result<(), WriteError> {
        for column in self.added {
            let cell = column.cell(Some(subject));
            if !cell.is_empty() {
                self.say(&column.name, &cell)?;
            }
        }
        Ok(())
    }

    /// Writes a geometry. `columns`: the images of the mesh's axes, in the unit and axes of the file, as the origin
    /// is.
    fn geometry(
        &mut self,
        shape: usize,
        columns: [DVec3; 3],
        origin: DVec3,
        diameters: [f64; 2],
    ) -> Result<(), WriteError> {
        let [x, y, z] = columns.map(|c| c.to_array());
        let at = origin.to_array();
        write!(self.out, "<geometry class=\"Mesh\"><shapeIndex>{shape}</shapeIndex><mat>")?;
        for row in 0..3 {
            let [a, b, c] = [x[row], y[row], z[row]].map(|v| decimal(v, 9));
            writeln!(self.out, "{a}\t{b}\t{c}\t{}", micrometres(self.spec, at[row]))?;
        }
        let [down, up] = diameters.map(|d| decimal(d, 9));
        Ok(writeln!(self.out, "</mat><dUp>{up}</dUp><dDwn>{down}</dDwn></geometry>")?)
    }

    /// Writes an axis that stands on the ground and all that it bears; with an explicit stack, as the orders may be
    /// many.
    fn tree(&mut self, root: AxisId, borne: &Borne) -> Result<(), WriteError> {
        let mut stack: Vec<Frame> = Vec::new();
        self.axis("decomp", root, &mut stack)?;
        while let Some(frame) = stack.last_mut() {
            if let Some((tag, children)) = &mut frame.waiting {
                let tag = *tag;
                match children.pop() {
                    Some(child) => self.axis("branch", child, &mut stack)?,
                    None => {
                        frame.waiting = None;
                        self.close(tag)?;
                    }
                }
                continue;
            }
            let axis = self.plant.axis(frame.axis);
            let Some(node) = axis.node_ids().nth(frame.node) else {
                let tag = frame.tag;
                stack.pop();
                self.close(tag)?;
                continue;
            };
            let tag = if frame.node == 1 { "decomp" } else { "follow" };
            let start = (frame.node == 1).then(|| axis.node_ids().next()).flatten();
            let mut axes: Vec<AxisId> = Borne::on(&borne.axes, node).collect();
            let mut organs: Vec<usize> = Borne::on(&borne.organs, node).collect();
            // Axes and organs on the very first node of an axis come here, because no internode ends there.
            axes.extend(start.into_iter().flat_map(|s| Borne::on(&borne.axes, s)));
            organs.extend(start.into_iter().flat_map(|s| Borne::on(&borne.organs, s)));
            axes.reverse();
            frame.waiting = Some((tag, axes));
            frame.node += 1;
            let before = NodeId::new(node.index() - 1);
            self.internode(tag, before, node)?;
            for organ in organs {
                self.organ("branch", organ, &self.plant.organs[organ])?;
            }
        }
        Ok(())
    }

    fn axis(&mut self, tag: &'static str, id: AxisId, stack: &mut Vec<Frame>) -> Result<(), WriteError> {
        let axis = self.plant.axis(id);
        let name = match axis.kind {
            AxisKind::Branch if axis.order == 0 => "trunk",
            AxisKind::Branch => "branch",
            AxisKind::Twig => "twig",
            AxisKind::Stem => "stem",
            AxisKind::Petiole => "petiole",
            AxisKind::Root => "root",
            AxisKind::Stub => "stub",
            _ => "axis",
        };
        stack.push(Frame { axis: id, tag, node: 1, waiting: None });
        self.open(tag, "Axis", 2)?;
        self.say("Name", name)?;
        self.say_added(Subject::Axis(id.index()))
    }

    fn internode(&mut self, tag: &str, from: NodeId, to: NodeId) -> Result<(), WriteError> {
        let (plant, spec) = (self.plant, self.spec);
        let [start, end] = [from, to].map(|n| place(spec, plant.nodes.position[n.index()]));
        let [down, up] = [from, to].map(|n| length(spec, 2.0 * plant.nodes.radius_m[n.index()]));
        let way = end - start;
        self.open(tag, "Internode", 3)?;
        self.say("Length", &micrometres(spec, way.length()))?;
        self.say("Width", &micrometres(spec, up))?;
        if let Some(along) = way.try_normalize() {
            let across = along.any_orthonormal_vector();
            self.geometry(0, [way, across, along.cross(across)], start, [down, up])?;
        }
        Ok(())
    }

    fn organ(&mut self, tag: &str, row: usize, organ: &Organ) -> Result<(), WriteError> {
        let (spec, shape) = (self.spec, organ.shape.index());
        let (class, name, _) = organ_class(organ.kind);
        self.open(tag, class, 3)?;
        self.say("Name", &format!("{name} {}", row + 1))?;
        if let Some(long) = self.plant.shapes[shape].length() {
            self.say("Length", &micrometres(spec, length(spec, long * organ.scale)))?;
        }
        let area = self.areas[shape] * organ.scale * organ.scale;
        self.say("Area", &decimal(length(spec, length(spec, area)), 9))?;
        if let Some(flower) = organ.flower {
            self.say("Flower", &(flower.raw() + 1).to_string())?;
        }
        self.say_added(Subject::Organ(row))?;
        if let Some(look) = self.looks.iter().position(|l| *l == (shape, organ.kind)) {
            let f = &organ.frame;
            let scale = length(spec, organ.scale);
            let columns = [f.right, f.along, f.normal].map(|v| turn(spec, v) * scale);
            self.geometry(look + 1, columns, place(spec, f.origin), [1.0; 2])?;
        }
        self.close(tag)
    }
}

/// Returns a cylinder along x, from 0 to 1, of diameter 1.
fn cylinder() -> TriMesh {
    let mut mesh = TriMesh::default();
    for k in 0..SIDES {
        let (s, c) = base::ops::sin_cos(2.0 * base::ops::PI * f64::from(k) / f64::from(SIDES));
        for x in [0.0, 1.0] {
            mesh.push(DVec3::new(x, 0.5 * c, 0.5 * s));
            #[expect(clippy::cast_possible_truncation, reason = "a normal of a mesh")]
            mesh.normals.push([0.0, c as f32, s as f32]);
        }
        let [a, b] = [2 * k, 2 * ((k + 1) % SIDES)];
        mesh.triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
    }
    mesh
}
