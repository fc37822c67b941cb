//! A plant with a skeleton, and leaves that hang on its joints -> USD as text (assemblies of Unreal's Nanite).

use std::io::Write as _;

use glam::{DQuat, DVec3};
use mesh::{Copies, Model, Part};
use serde_json::json;

use super::usd_write::{Bound, Identifiers, Look, Quoted, fixed, head, identifier, looks, prim, transform};
use super::{BesideFile, ExportSpec, ModelFiles, TextureFiles, check, file_name};
use crate::Beside;
use crate::error::WriteError;

/// A joint of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyJoint {
    /// Its name, unique in the assembly.
    pub name: String,
    /// Row of the joint that bears it, which comes before it.
    pub parent: Option<usize>,
    /// Its place at rest, metres.
    pub at: DVec3,
    /// What kind of wood it moves.
    pub group: WindGroup,
}

/// How wood moves in the wind of Unreal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindGroup {
    /// The main axis.
    Trunk,
    /// What the main axis bears.
    Limb,
    /// All else.
    Twig,
}

impl WindGroup {
    const ALL: [Self; 3] = [Self::Trunk, Self::Limb, Self::Twig];

    /// Returns how much of the wind the wood takes, 0 to 1: figures of ours, for trees in a breeze.
    const fn influence(self) -> f64 {
        match self {
            Self::Trunk => 0.2,
            Self::Limb => 0.5,
            Self::Twig => 0.9,
        }
    }
}

/// Copies of a mesh, each on a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundCopies {
    /// The mesh and its places; its material is one of the assembly's model.
    pub copies: Copies,
    /// Row of the joint of each place.
    pub joints: Vec<u16>,
}

/// A plant with a skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// Joints, each after the one that bears it.
    pub joints: Vec<AssemblyJoint>,
    /// The meshes that bend.
    pub model: Model,
    /// Two joints of each vertex of each part of the model, with shares that add up to 1.
    pub holds: Vec<Vec<[(u16, f32); 2]>>,
    /// Leaves.
    pub copies: Vec<BoundCopies>,
    /// Whether it is low enough to count as ground cover.
    pub is_low: bool,
}

impl Assembly {
    /// Returns whether holds and copies fit the joints and the model.
    fn is_sound(&self) -> bool {
        let count = self.joints.len();
        let parents = self.joints.iter().enumerate().all(|(k, j)| j.parent.is_none_or(|p| p < k));
        let held = |holds: &[[(u16, f32); 2]]| holds.iter().flatten().all(|(j, _)| usize::from(*j) < count);
        let parts = self.holds.iter().zip(&self.model.parts);
        let bound = |b: &BoundCopies| {
            b.joints.len() == b.copies.places.len()
                && b.joints.iter().all(|j| usize::from(*j) < count)
                && b.copies.material.index() < self.model.materials.len()
                && b.copies
                    .mesh
                    .validate()
                    .all(|f| matches!(f, mesh::MeshFault::Degenerate(_) | mesh::MeshFault::Normal(_)))
        };
        parents
            && self.holds.len() == self.model.parts.len()
            && parts.into_iter().all(|(h, p)| h.len() == p.mesh.positions.len() && held(h))
            && self.copies.iter().all(bound)
    }
}

/// Writes an assembly as a USD layer with its textures, and the groups of its joints as JSON (`STEM-wind.json`): a skinned
/// mesh and, of each kind of leaf, one prototype with many places on joints.
///
/// Guaranteed: `NaniteAssemblyRootAPI` on the root and `NaniteAssemblySkelBindingAPI` on the leaves, with joints by their
/// names; schemas of Unreal, which other readers pass over. Everything else is of `UsdSkel` and `UsdGeom`: in other
/// readers the plant has a skeleton and its leaves are instances. The same assembly gives the same bytes.
///
/// # Errors
/// [`WriteError`] for a model that is not sound; [`WriteError::Rig`] if joints do not fit it.
pub fn assembly_files(assembly: &Assembly, stem: &str, spec: &ExportSpec) -> Result<ModelFiles, WriteError> {
    check(&assembly.model)?;
    if !assembly.is_sound() {
        return Err(WriteError::Rig);
    }
    let stem = file_name(stem, "model");
    let root = identifier(&assembly.model.name, "model");
    let mut writer = Writer {
        assembly,
        spec,
        paths: paths(&assembly.joints),
        root,
        out: Vec::new(),
        taken: Identifiers::default(),
    };
    let mut textures = TextureFiles::light(&stem);
    writer.all(&mut textures)?;
    let mut files = ModelFiles::new(writer.out, textures.into_files());
    let wind = BesideFile { what: Beside::Wind, name: format!("{stem}-wind.json"), bytes: wind(assembly)? };
    files.beside.push(wind);
    Ok(files)
}

/// Returns the joint's place in the tree of joints, as `UsdSkel` writes it.
fn paths(joints: &[AssemblyJoint]) -> Vec<String> {
    let mut paths: Vec<String> = Vec::with_capacity(joints.len());
    for joint in joints {
        let name = identifier(&joint.name, "joint");
        paths.push(joint.parent.map_or(name.clone(), |p| format!("{}/{name}", paths[p])));
    }
    paths
}

/// Returns the description of the wind that Unreal's Dynamic Wind imports.
fn wind(assembly: &Assembly) -> Result<Vec<u8>, WriteError> {
    let row = |group: WindGroup| WindGroup::ALL.iter().position(|g| *g == group).unwrap_or(0);
    let joints: Vec<_> = (assembly.joints.iter())
        .map(|j| json!({ "JointName": identifier(&j.name, "joint"), "SimulationGroupIndex": row(j.group) }))
        .collect();
    let groups: Vec<_> = (WindGroup::ALL.iter())
        .map(|group| {
            json!({
                "bUseDualInfluence": false,
                "Influence": group.influence(),
                "MinInfluence": 0.0,
                "MaxInfluence": 0.0,
                "ShiftTop": 0.0,
                "bIsTrunkGroup": *group == WindGroup::Trunk,
            })
        })
        .collect();
    let all = json!({
        "Joints": joints,
        "SimulationGroups": groups,
        "bIsGroundCover": assembly.is_low,
        "GustAttenuation": 0.0,
    });
    let mut text = serde_json::to_vec_pretty(&all).map_err(|e| WriteError::Io(e.into()))?;
    text.push(b'\n');
    Ok(text)
}

struct Writer<'a> {
    assembly: &'a Assembly,
    spec: &'a ExportSpec,
    /// Paths of the joints.
    paths: Vec<String>,
    root: String,
    out: Vec<u8>,
    /// Names of the children of the root.
    taken: Identifiers,
}

/// Names of a list, in quotes.
fn tokens(names: impl IntoIterator<Item = String>) -> String {
    let quoted: Vec<String> = names.into_iter().map(|name| format!("\"{name}\"")).collect();
    format!("[{}]", quoted.join(","))
}

impl Writer<'_> {
    fn all(&mut self, textures: &mut TextureFiles<'_>) -> Result<(), WriteError> {
        let (root, model) = (self.root.clone(), &self.assembly.model);
        head(&mut self.out, (&root, model), self.spec)?;
        let scope = self.taken.fresh("materials", "materials");
        let trunk = self.taken.fresh("trunk", "trunk");
        writeln!(self.out, "def Xform \"{root}\" (")?;
        writeln!(self.out, "    prepend apiSchemas = [\"NaniteAssemblyRootAPI\"]")?;
        writeln!(self.out, "    assetInfo = {{\n        string name = {}\n    }}", Quoted(&model.name))?;
        writeln!(self.out, "    kind = \"component\"\n)\n{{")?;
        writeln!(self.out, "    uniform token unreal:naniteAssembly:meshType = \"skeletalMesh\"")?;
        let skeleton = format!("/{root}/{trunk}/skeleton");
        writeln!(self.out, "    rel unreal:naniteAssembly:skeleton = <{skeleton}>")?;
        let looks = looks(&mut self.out, model, &format!("/{root}/{scope}"), textures)?;
        writeln!(self.out, "\n    def SkelRoot \"{trunk}\"\n    {{")?;
        self.skeleton()?;
        let mut among = Identifiers::default();
        among.fresh("skeleton", "skeleton");
        for (part, holds) in model.parts.iter().zip(&self.assembly.holds) {
            if part.mesh.positions.is_empty() {
                continue;
            }
            let name = among.fresh(&part.name, "part");
            let shown = (&looks[part.material.index()], model.material(part).double_sided);
            let bound = Bound { skeleton: &skeleton, holds };
            prim(&mut self.out, part, &name, shown, Some(&bound), self.spec)?;
        }
        writeln!(self.out, "    }}")?;
        for bound in &self.assembly.copies {
            self.leaves(bound, &looks)?;
        }
        Ok(writeln!(self.out, "}}")?)
    }

    fn skeleton(&mut self) -> Result<(), WriteError> {
        let joints = &self.assembly.joints;
        let place = |at: DVec3| transform(self.spec.place(at));
        let bind: Vec<String> = joints.iter().map(|j| place(j.at)).collect();
        let rest = joints.iter().map(|j| place(j.at - j.parent.map_or(DVec3::ZERO, |p| joints[p].at)));
        let rest: Vec<String> = rest.collect();
        let names = joints.iter().map(|j| identifier(&j.name, "joint"));
        let out = &mut self.out;
        writeln!(out, "    def Skeleton \"skeleton\"\n    {{")?;
        writeln!(out, "        uniform matrix4d[] bindTransforms = [{}]", bind.join(", "))?;
        writeln!(out, "        uniform token[] jointNames = {}", tokens(names))?;
        writeln!(out, "        uniform token[] joints = {}", tokens(self.paths.iter().cloned()))?;
        writeln!(out, "        uniform matrix4d[] restTransforms = [{}]", rest.join(", "))?;
        Ok(writeln!(out, "    }}")?)
    }

    /// Writes leaves of one form: their places, and one leaf with a skeleton of one joint, as parts of an assembly with
    /// joints must have one.
    fn leaves(&mut self, bound: &BoundCopies, looks: &[Look]) -> Result<(), WriteError> {
        let (copies, spec) = (&bound.copies, self.spec);
        let name = self.taken.fresh(&copies.name, "leaves");
        let own = format!("/{}/{name}/prototypes/leaf", self.root);
        writeln!(self.out, "\n    def PointInstancer \"{name}\" (")?;
        writeln!(self.out, "        prepend apiSchemas = [\"NaniteAssemblySkelBindingAPI\"]\n    )\n    {{")?;
        self.extent(copies)?;
        self.places(copies)?;
        let names =
            bound.joints.iter().map(|j| identifier(&self.assembly.joints[usize::from(*j)].name, "joint"));
        let names = tokens(names);
        writeln!(self.out, "        uniform token[] primvars:unreal:naniteAssembly:bindJoints = {names} (")?;
        writeln!(
            self.out,
            "            elementSize = 1\n            interpolation = \"uniform\"\n        )"
        )?;
        writeln!(self.out, "        int[] protoIndices = [{}]", vec!["0"; copies.places.len()].join(","))?;
        writeln!(self.out, "        rel prototypes = <{own}>")?;
        writeln!(self.out, "        def Scope \"prototypes\"\n        {{")?;
        writeln!(self.out, "    def SkelRoot \"leaf\"\n    {{\n    def Skeleton \"skeleton\"\n    {{")?;
        for word in ["bindTransforms", "restTransforms"] {
            writeln!(self.out, "        uniform matrix4d[] {word} = [{}]", transform([0.0; 3]))?;
        }
        writeln!(self.out, "        uniform token[] joints = [\"leaf\"]\n    }}")?;
        let part = Part { name: "blade".into(), material: copies.material, mesh: copies.mesh.clone() };
        let holds = vec![[(0, 1.0), (0, 0.0)]; part.mesh.positions.len()];
        let skeleton = format!("{own}/skeleton");
        let bound = Bound { skeleton: &skeleton, holds: &holds };
        let shown = (
            &looks[part.material.index()],
            self.assembly.model.materials[part.material.index()].double_sided,
        );
        prim(&mut self.out, &part, "blade", shown, Some(&bound), spec)?;
        Ok(writeln!(self.out, "    }}\n        }}\n    }}")?)
    }

    fn extent(&mut self, copies: &Copies) -> Result<(), WriteError> {
        let reach = copies.mesh.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)).length());
        let reach = reach.fold(0.0, f64::max);
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for place in &copies.places {
            let at = DVec3::from_array(self.spec.place(place.at));
            let around = DVec3::splat(place.scale * reach / self.spec.unit.metres());
            (low, high) = (low.min(at - around), high.max(at + around));
        }
        let row = |v: DVec3| format!("({}, {}, {})", v.x, v.y, v.z);
        Ok(writeln!(self.out, "        float3[] extent = [{}, {}]", row(low), row(high))?)
    }

    fn places(&mut self, copies: &Copies) -> Result<(), WriteError> {
        let places = &copies.places;
        let spec = self.spec;
        self.rows("point3f[] positions", places.iter().map(|p| spec.place(p.at)), 2)?;
        let turns = places.iter().map(|p| {
            let [x, y, z] = turned(spec, p.turn);
            [p.turn.w, x, y, z]
        });
        self.rows("quath[] orientations", turns, 3)?;
        self.rows("float3[] scales", places.iter().map(|p| [p.scale; 3]), 3)
    }

    fn rows<const N: usize>(
        &mut self,
        what: &str,
        rows: impl Iterator<Item = [f64; N]>,
        places: u32,
    ) -> Result<(), WriteError> {
        write!(self.out, "        {what} = [")?;
        for (k, row) in rows.enumerate() {
            self.out.extend_from_slice(if k > 0 { b",(" } else { b"(" });
            for (k, x) in row.into_iter().enumerate() {
                if k > 0 {
                    self.out.push(b',');
                }
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "f64 in the model, f32 in files, by design"
                )]
                fixed(&mut self.out, x as f32, places)?;
            }
            self.out.push(b')');
        }
        Ok(writeln!(self.out, "]")?)
    }
}

/// Returns the axis of a rotation, times the sine of half its angle, in the axes of the file. The axes of the mesh turn
/// with those of the file, so that a rotation is the same about the turned axis.
fn turned(spec: &ExportSpec, turn: DQuat) -> [f64; 3] {
    let axis = DVec3::new(turn.x, turn.y, turn.z);
    let spec = ExportSpec { up: spec.up, unit: base::Unit::Metre };
    spec.place(axis)
}
