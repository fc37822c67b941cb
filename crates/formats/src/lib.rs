//! Readers of strokes, readers and writers of models and of the structure of plants, on byte streams: no paths, no file
//! system.
//!
//! bytes -> [`read_drawings`] -> [`ink::Drawing`]; bytes -> [`read_model`] -> [`mesh::Model`] ->
//! [`write_model`] -> bytes; bytes -> [`read_cloud`] -> [`mesh::PointCloud`]; bytes -> [`read_structure`] ->
//! `plant::Plant` -> [`write_structure`] -> bytes; [`mechanics::Mechanism`] -> [`robot_files`] -> bytes.
//!
//! The input may be hostile: sizes, nesting and expansion are bounded, errors name the place and what to do, and
//! nothing panics. Inside, y points up and lengths are metres; this crate converts everything else.

mod cloud;
mod drawing;
mod error;
mod foreign;
mod kind;
mod leaves;
mod model;
mod plant;
mod robots;
mod summary;
mod table;
mod tiles;

pub use cloud::{
    ClassCount, CloudFacts, MAX_CLOUD_BYTES, read_cloud, read_cloud_with_facts, write_cloud_ply,
};
pub use drawing::{Drawings, MAX_DRAWING_BYTES, ReadDrawing, read_drawings, write_drawing, write_svg};
pub use error::{CloudError, DrawingError, FileFault, ModelError, Place, WriteError};
pub use foreign::Foreign;
pub use leaves::{
    DateOrder, GrowthEntry, GrowthSpec, LeafFile, LeafFileError, MAX_LEAF_BYTES, MarksAxes, ReadGraph,
    ReadGrowth, ReadMarks, ReadProfile, ReadProfiles, ReadRays, ReadSheet, is_rays, marks_template,
    read_growth, read_leaf_file, read_marks, read_profiles, read_rays, read_vein_graph, read_xlsx,
    write_marks, write_rays,
};
pub use model::{
    Assembly, AssemblyJoint, BesideFile, BoundCopies, ExportSpec, FileStems, Level, MAX_MODEL_BYTES,
    ModelFiles, Morph, NamedNodes, NoFile, ObjFiles, Packing, PngCache, Resolver, SideFile, UsdFiles,
    WindGroup, assembly_files, decode_uri, file_name, gltf_files, half_bits, model_files, names_beside,
    no_files, obj_files, read_model, read_picture, usd_files, warn_of_wind, write_exr, write_glb,
    write_glb_joined, write_glb_levels, write_glb_morph, write_glb_nodes, write_glb_packed, write_glb_rigged,
    write_glb_scene, write_glb_with, write_model, write_ply, write_png, write_stl,
};
pub use plant::{
    AddedColumn, ReadStructure, StructureError, StructureSpec, StructureTally, read_structure, write_mtg,
    write_opf, write_qsm, write_structure, write_structure_with, write_swc,
};
pub use robots::{BodyMesh, robot_files};
pub use summary::{DrawingSummary, MaterialSummary, ModelSummary, PartSummary};
pub use table::{
    Access, Beside, CloudFormat, DrawingFormat, FormatRow, ModelFormat, RobotFormat, Room, StructureFormat,
    list_of_endings,
};
pub use tiles::{
    Group, Instance, Linking, Prototype, SharedModel, TileNode, Tileset, TreeRow, TreeTable, earth_frame,
    share_pictures, stand_usda, tileset_json, write_tile,
};
