//! Preview of an export before it is written: its meshes at one level of detail, and counted figures.

use std::sync::Arc;

use burgeon::Run;
use burgeon::document::PlantId;
use burgeon::formats::{ModelFormat, Room};
use burgeon::mesh::{Material, Model, Texture, TriMesh};
use schemars::JsonSchema;
use serde::Serialize;

use crate::export::{ExportLevels, Level, MOST_LEVELS, assembly, made, packed, print, scene_files, written};
use crate::export_preview::{ExportPreview, PrintFigures};
use crate::view::GUEST;
use crate::{Column, ExportRequest, PlantView, Workspace, WorkspaceError};

/// Contents of an export at one level of detail.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ExportView {
    /// The level; 0 is the finest.
    pub level: u32,
    /// Bytes of the file with this level alone, or of its zip, counted from the written file.
    pub file_bytes: u64,
    /// Number of textures in it or next to it.
    pub textures: u32,
    /// Their bytes as PNG.
    pub texture_bytes: u64,
    /// Number of meshes that a program draws to show all of it.
    pub draws: u32,
    /// Its contents by kind.
    pub parts: Vec<PartFigures>,
    /// Its meshes; copies share theirs. See [`Workspace::exported_column`].
    pub models: Vec<PlantView>,
    /// The mesh of each plant; empty where the one model stands for the whole scene.
    pub plants: Vec<ExportedPlant>,
}

/// Figures of all meshes of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct PartFigures {
    /// Kind of the meshes: bark, leaf, petal, ...
    pub kind: &'static str,
    /// Triangles; those of copies count each time.
    pub triangles: u64,
    /// Vertices; those of copies count each time.
    pub vertices: u64,
    /// Meshes that a program draws; those of copies count each time; 0 where the file is a single mesh.
    pub draws: u32,
    /// Bytes of columns and indices, as binary glTF and graphics cards hold them; those of copies in binary glTF count
    /// once.
    pub bytes: u64,
}

/// A plant of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ExportedPlant {
    /// Its name within the document, or [`GUEST`].
    pub plant: PlantId,
    /// Row of its meshes in [`ExportView::models`].
    pub model: usize,
}

impl Workspace {
    /// Makes the files that [`Workspace::export`] would write of one level (0 to 3, or 4 for the views from all sides
    /// where `wanted` has them), to be shown and counted. `wanted.levels` is ignored. Its meshes stay until the next
    /// preview or [`Workspace::end_preview`].
    ///
    /// # Cost
    /// That of the export: the file is written, counted and thrown away.
    ///
    /// # Errors
    /// As [`Workspace::export`]; [`WorkspaceError::Format`] for a format that holds no models.
    pub fn preview_export(
        &mut self,
        wanted: &ExportRequest,
        level: u32,
        run: &Run<'_>,
    ) -> Result<ExportView, WorkspaceError> {
        let (format, spec) = (wanted.format.model()?, wanted.spec());
        wanted.check()?;
        let mut preview = std::mem::take(&mut self.export_preview).unwrap_or_default();
        preview.models.clear();
        let from_afar = level >= MOST_LEVELS && wanted.ends_far();
        let level = level.min(MOST_LEVELS - 1);
        if let Some(model) = &self.guest {
            let files = written(model, format, "plant", &spec)?;
            let bytes = packed(wanted.format, files)?.len();
            preview.models.push(model.clone());
            return self.counted(preview, (0, bytes), format, &[(GUEST, 0)]);
        }
        let only = if wanted.whole { None } else { Some(self.must()?) };
        let document = self.editor.document();
        if wanted.is_print() {
            let made = print(&mut self.scene, document, only, run)?;
            self.printed = Some(PrintFigures::from_print(&made));
            let bytes = packed(wanted.format, written(&made.model, format, "plant", &spec)?)?.len();
            preview.models.push(made.model);
            let rows: Vec<_> = only.map(|id| (id, 0)).into_iter().collect();
            return self.counted(preview, (0, bytes), format, &rows);
        }
        let now = (self.editor.revision(), wanted.surface());
        if preview.dressed.as_ref().is_none_or(|(then, _)| *then != now) {
            preview.dressed = wanted.dressed(&self.scene, document, only).map(|aside| (now, aside));
        }
        let scene = preview.dressed.as_mut().map_or(&mut self.scene, |(_, aside)| aside);
        let plants = made(scene, document, only, run)?;
        let one = ExportRequest { levels: 1, impostor: false, sway: false, ..*wanted };
        if from_afar || wanted.allowance().is_any() {
            let levels = if from_afar { 1 } else { wanted.levels.max(level + 1) };
            let all = ExportRequest { levels, ..*wanted };
            let made = ExportLevels::make((scene, document), &plants, (only, &all), run)?;
            let row = if from_afar { 1 } else { level as usize };
            let shown = made.only(row).ok_or(WorkspaceError::NothingMade)?;
            let bytes = packed(wanted.format, shown.files(&one)?)?.len();
            preview.models.extend(shown.models.into_iter().map(|joined| joined.model));
            let rows: Vec<_> = only.map(|id| (id, 0)).into_iter().collect();
            return self.counted(
                preview,
                (if from_afar { MOST_LEVELS } else { level }, bytes),
                format,
                &rows,
            );
        }
        let at = Level::make(scene, &plants, (level, wanted), run)?;
        let files = if one.is_assembly() {
            assembly(scene, &plants, wanted, run)?.0
        } else if one.is_joined() {
            let joined = at.joined(document.name(), &plants, only.is_some());
            ExportLevels::new(scene, &plants, vec![joined]).files(&one)?
        } else {
            let standing = at.standing(&plants, only.is_some());
            scene_files(document.name(), &standing, format, "plant", &spec, &mut preview.pngs)?
        };
        let bytes = packed(wanted.format, files)?.len();
        let rows: Vec<_> = plants.iter().zip(&at.rows).map(|(p, &row)| (p.id(), row)).collect();
        preview.models = at.models;
        self.counted(preview, (level, bytes), format, &rows)
    }

    /// Counts the figures, and makes the views of the models.
    fn counted(
        &mut self,
        mut preview: ExportPreview,
        (level, file): (u32, usize),
        format: ModelFormat,
        rows: &[(PlantId, usize)],
    ) -> Result<ExportView, WorkspaceError> {
        let mut textures = Vec::new();
        let models = preview.models.iter().flat_map(|m| &m.materials);
        for texture in models.flat_map(|m| pictures(m, format)) {
            if !textures.contains(&texture) {
                textures.push(texture);
            }
        }
        let mut texture_bytes = 0;
        for texture in &textures {
            texture_bytes += preview.pngs.png(texture)?.len() as u64;
        }
        let count = u32::try_from(textures.len()).unwrap_or(u32::MAX);
        let (parts, draws) = figures(&preview.models, rows, format);
        let models =
            preview.models.iter().map(|m| PlantView::from_model(GUEST, m, &mut self.textures)).collect();
        self.export_preview = Some(preview);
        Ok(ExportView {
            level,
            file_bytes: file as u64,
            textures: count,
            texture_bytes,
            draws,
            parts,
            models,
            plants: rows.iter().map(|&(plant, model)| ExportedPlant { plant, model }).collect(),
        })
    }

    /// Returns a column of a mesh of the last preview of an export; empty for a mesh that does not exist.
    pub fn exported_column(&self, model: usize, part: usize, column: Column) -> &[f32] {
        let model = self.export_preview.as_ref().and_then(|l| l.models.get(model));
        model.and_then(|m| m.parts.get(part)).map_or(&[], |p| column.values(&p.mesh))
    }

    /// Returns the indices of a mesh of the last preview of an export, three for each triangle.
    pub fn exported_indices(&self, model: usize, part: usize) -> &[u32] {
        let model = self.export_preview.as_ref().and_then(|l| l.models.get(model));
        model.and_then(|m| m.parts.get(part)).map_or(&[], |p| p.mesh.triangles.as_flattened())
    }

    /// Drops the preview of an export.
    pub fn end_preview(&mut self) {
        self.export_preview = None;
    }
}

/// Returns the textures of a material that a file has.
fn pictures(m: &Material, format: ModelFormat) -> impl Iterator<Item = &Arc<Texture>> {
    let height = m.maps.height.as_ref().filter(|_| format.holds(Room::Heights));
    let is_through = format.holds(Room::Translucence) && m.double_sided && m.translucency > 0.0;
    let through = m.maps.through.as_ref().filter(|_| is_through);
    let all = [m.texture.as_ref(), m.maps.normal.as_ref(), m.maps.orm.as_ref(), height, through];
    all.into_iter().flatten().filter(move |_| format.holds(Room::Textures))
}

/// Returns figures by kind, in the order of the parts, and how many meshes are drawn.
fn figures(models: &[Model], rows: &[(PlantId, usize)], format: ModelFormat) -> (Vec<PartFigures>, u32) {
    let single = !format.holds(Room::Parts);
    let mut all: Vec<PartFigures> = Vec::new();
    for (k, model) in models.iter().enumerate() {
        // A model without a plant of its own is the whole scene.
        let places =
            rows.iter().filter(|(_, row)| *row == k).count().max(usize::from(rows.is_empty())) as u64;
        for part in model.parts.iter().filter(|p| !p.mesh.positions.is_empty()) {
            let kind = model.materials.get(part.material.index()).map_or("other", |m| m.kind.word());
            let row = all.iter().position(|p| p.kind == kind).unwrap_or_else(|| {
                all.push(PartFigures { kind, triangles: 0, vertices: 0, draws: 0, bytes: 0 });
                all.len() - 1
            });
            let (mesh, figures) = (&part.mesh, &mut all[row]);
            let triangles = mesh.triangles.len() as u64;
            // An STL repeats each corner.
            let vertices =
                if format == ModelFormat::Stl { 3 * triangles } else { mesh.positions.len() as u64 };
            figures.triangles += places * triangles;
            figures.vertices += places * vertices;
            figures.bytes += bytes(mesh) * if format.holds(Room::Instances) { 1 } else { places };
            if !single {
                figures.draws += u32::try_from(places).unwrap_or(u32::MAX);
            }
        }
    }
    let draws = if single { 1 } else { all.iter().map(|p| p.draws).sum() };
    (all, draws)
}

/// Returns the bytes of a mesh in binary glTF.
fn bytes(mesh: &TriMesh) -> u64 {
    let floats = 3 * mesh.positions.len()
        + 3 * mesh.normals.len()
        + 2 * mesh.uvs.len()
        + 3 * mesh.colors.len()
        + 4 * mesh.wind.len()
        + 4 * mesh.pivots.len();
    let corner = if mesh.positions.len() < 65_536 { 2 } else { 4 };
    (4 * floats + 3 * corner * mesh.triangles.len()) as u64
}

#[cfg(test)]
mod tests {
    use burgeon::document::{PlantCommand, SceneCommand};
    use burgeon::formats::StructureFormat;
    use burgeon::glam::DVec3;
    use serde_json::Value;

    use super::*;
    use crate::{ExportFormat, NewMaker};

    /// Reads the JSON of a binary glTF file.
    fn gltf(glb: &[u8]) -> Value {
        let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
        serde_json::from_slice(&glb[20..20 + length]).unwrap()
    }

    /// Counts in a binary glTF file: triangles and meshes that are drawn, bytes of meshes, textures and their bytes.
    fn held(glb: &[u8]) -> [u64; 5] {
        let file = gltf(glb);
        let rows = |key: &str| file[key].as_array().cloned().unwrap_or_default();
        let (accessors, views, meshes) = (rows("accessors"), rows("bufferViews"), rows("meshes"));
        let at = |list: &[Value], row: &Value| list[usize::try_from(row.as_u64().unwrap()).unwrap()].clone();
        let (mut triangles, mut draws) = (0, 0);
        for node in rows("nodes").iter().filter(|n| !n["mesh"].is_null()) {
            let primitive = at(&meshes, &node["mesh"])["primitives"][0].clone();
            triangles += at(&accessors, &primitive["indices"])["count"].as_u64().unwrap() / 3;
            draws += 1;
        }
        let length = |view: &Value| view["byteLength"].as_u64().unwrap();
        let columns = views.iter().filter(|v| !v["target"].is_null()).map(length).sum();
        let pictures = views.iter().filter(|v| v["target"].is_null()).map(length).sum();
        [triangles, draws, columns, rows("images").len() as u64, pictures]
    }

    fn totals(view: &ExportView) -> [u64; 5] {
        let sum = |f: fn(&PartFigures) -> u64| view.parts.iter().map(f).sum::<u64>();
        [sum(|p| p.triangles), view.draws.into(), sum(|p| p.bytes), view.textures.into(), view.texture_bytes]
    }

    fn with_bush() -> Workspace {
        let mut s = Workspace::default();
        let bush = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 200\nlifespan = 1\n";
        s.open("bush.toml", bush.as_bytes(), 0, false).unwrap();
        s
    }

    #[test]
    fn the_figures_are_those_of_the_file() {
        let mut s = with_bush();
        let bush = s.current().unwrap();
        for k in 1..3 {
            s.run(SceneCommand::Duplicate(bush, DVec3::X * f64::from(k))).unwrap();
        }
        let maker = NewMaker::Flower("lily".into());
        s.act(&crate::Action::Add { name: "a lily".into(), maker }).unwrap();
        let mut before = [u64::MAX; 5];
        for (wind, level) in [(false, 0), (true, 0), (true, 1), (true, 2)] {
            let wanted = ExportRequest { whole: true, wind, levels: level + 1, ..ExportRequest::default() };
            let view = s.preview_export(&wanted, level, &Run::plain()).unwrap();
            let files = s.export(&wanted, &Run::plain()).unwrap();
            let (_, file) = &files[level as usize];
            assert_eq!(totals(&view), held(file), "wind {wind}, level {level}");
            assert_eq!(view.file_bytes, file.len() as u64);
            assert_eq!((view.models.len(), view.plants.len()), (2, 4), "copies share their meshes");
            let (positions, blown) = (
                s.exported_column(0, 0, Column::Positions).len(),
                s.exported_column(0, 0, Column::Wind).len(),
            );
            assert!(positions > 0 && blown == if wind { positions / 3 * 4 } else { 0 });
            assert!(!s.exported_indices(0, 0).is_empty());
            let now = totals(&view);
            if level > 0 {
                assert!(now[0] < before[0], "a level has fewer triangles: {now:?}");
            }
            before = now;
        }
        s.end_preview();
        assert!(s.exported_column(0, 0, Column::Positions).is_empty());
        // Hidden plants are not written; one plant alone is.
        s.run(PlantCommand::Hide(true).for_plant(bush)).unwrap();
        let all = ExportRequest { whole: true, ..ExportRequest::default() };
        assert_eq!(s.preview_export(&all, 0, &Run::plain()).unwrap().plants.len(), 3);
        let one = s.preview_export(&ExportRequest::default(), 0, &Run::plain()).unwrap();
        assert_eq!(one.plants.len(), 1);
    }

    #[test]
    fn views_from_all_sides_are_seen_as_they_are_written() {
        let mut s = Workspace::default();
        let maker = NewMaker::Flower("lily".into());
        s.act(&crate::Action::Add { name: "a lily".into(), maker }).unwrap();
        let lily = s.current().unwrap();
        s.run(SceneCommand::Duplicate(lily, DVec3::X)).unwrap();
        for whole in [false, true] {
            let wanted = ExportRequest { whole, impostor: true, ..ExportRequest::default() };
            let view = s.preview_export(&wanted, MOST_LEVELS, &Run::plain()).unwrap();
            let files = s.export(&wanted, &Run::plain()).unwrap();
            let (_, file) = files.last().unwrap();
            assert_eq!((totals(&view), view.file_bytes), (held(file), file.len() as u64));
            // A scene of several plants is one model, which no plant stands for.
            assert_eq!(view.plants.len(), usize::from(!whole));
            assert_eq!(s.exported_indices(0, 0).len(), 12, "two upright pictures");
        }
        // Without them the finest levels are the last.
        let plain = s.preview_export(&ExportRequest::default(), MOST_LEVELS, &Run::plain()).unwrap();
        assert_eq!(plain.level, MOST_LEVELS - 1);
    }

    #[test]
    fn each_format_is_counted_as_it_is() {
        let mut s = Workspace::default();
        let maker = NewMaker::Flower("lily".into());
        s.act(&crate::Action::Add { name: "a lily".into(), maker }).unwrap();
        let lily = s.current().unwrap();
        s.run(SceneCommand::Duplicate(lily, DVec3::X)).unwrap();
        let mut look = |format, wind| {
            let wanted = ExportRequest { format, wind, whole: true, ..ExportRequest::default() };
            let view = s.preview_export(&wanted, 0, &Run::plain()).unwrap();
            let saved = packed(format, s.export(&wanted, &Run::plain()).unwrap()).unwrap();
            assert_eq!(view.file_bytes, saved.len() as u64, "{format:?}");
            view
        };
        let glb = look(ExportFormat::Model(ModelFormat::Glb), false);
        let obj = look(ExportFormat::Model(ModelFormat::Obj), true);
        let [ply, stl] = [ExportFormat::Model(ModelFormat::Ply), ExportFormat::Model(ModelFormat::Stl)]
            .map(|f| look(f, true));
        assert_eq!((obj.draws, obj.textures), (glb.draws, glb.textures));
        assert_eq!(totals(&obj)[2], 2 * totals(&glb)[2], "others hold a copy twice, and no wind");
        assert_eq!((ply.draws, ply.textures, stl.draws), (1, 0, 1));
        let vertices = |v: &ExportView| v.parts.iter().map(|p| p.vertices).sum::<u64>();
        assert_eq!(vertices(&stl), 3 * totals(&stl)[0]);
        assert_eq!(vertices(&ply), vertices(&glb));
        let mtg = ExportRequest {
            format: ExportFormat::Structure(StructureFormat::Mtg),
            ..ExportRequest::default()
        };
        assert!(matches!(s.preview_export(&mtg, 0, &Run::plain()), Err(WorkspaceError::Format("mtg"))));
    }

    #[test]
    fn packed_files_and_leaves_of_one_form_are_those_of_the_writers() {
        let mut s = with_bush();
        let only = s.current().unwrap();
        let packed = ExportRequest { packed: true, ..ExportRequest::default() };
        let copies = ExportRequest { instances: true, ..packed };
        let mut sizes = Vec::new();
        for wanted in [ExportRequest::default(), packed, copies] {
            let view = s.preview_export(&wanted, 0, &Run::plain()).unwrap();
            let files = s.export(&wanted, &Run::plain()).unwrap();
            assert_eq!(view.file_bytes, files[0].1.len() as u64);
            sizes.push(files[0].1.len());
        }
        assert!(3 * sizes[1] < sizes[0] && sizes[2] < sizes[1], "{sizes:?}");
        let file = gltf(&s.export(&copies, &Run::plain()).unwrap()[0].1);
        assert!(file["extensionsUsed"].to_string().contains("EXT_mesh_gpu_instancing"));
        let mut direct = Vec::new();
        let made = s.scene.get(only).unwrap();
        let (rest, leaves) = burgeon::skin::copies(made.plant.unwrap(), made.model, made.owners.unwrap());
        let rest = Model { name: s.document().name().to_owned(), ..rest };
        let level = burgeon::formats::Level { model: &rest, copies: &leaves };
        let packing = Some(burgeon::formats::Packing::Compressed);
        let mut cache = burgeon::formats::PngCache::new();
        burgeon::formats::write_glb_levels(&[level], packing, &mut cache, &mut direct).unwrap();
        assert!(direct == s.export(&copies, &Run::plain()).unwrap()[0].1, "the file of the command");
        // Two plants: each form of leaf in the places of both.
        s.run(SceneCommand::Duplicate(only, DVec3::X)).unwrap();
        let both = s.export(&ExportRequest { whole: true, ..copies }, &Run::plain()).unwrap();
        let places = |glb: &[u8]| -> u64 {
            let file = gltf(glb);
            let nodes = file["nodes"].as_array().cloned().unwrap_or_default();
            let rows = nodes.iter().filter_map(|n| {
                let row = n["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"].as_u64()?;
                file["accessors"][usize::try_from(row).unwrap()]["count"].as_u64()
            });
            rows.sum()
        };
        assert_eq!(places(&both[0].1), 2 * places(&direct));
    }

    #[test]
    fn a_print_is_one_body_of_one_plant() {
        let mut s = Workspace::default();
        let maker = NewMaker::Flower("tulip".into());
        s.act(&crate::Action::Add { name: "a tulip".into(), maker }).unwrap();
        let ask = crate::EngineAsk::new(burgeon::Engine::Print, ModelFormat::Stl);
        let print = ask.settle().unwrap().request;
        let view = s.preview_export(&print, 0, &Run::plain()).unwrap();
        let files = s.export(&print, &Run::plain()).unwrap();
        assert_eq!((view.models.len(), view.file_bytes), (1, files[0].1.len() as u64));
        assert!(s.printed().is_some_and(|p| p.scale > 0.0 && p.wall_mm > 0.0), "{:?}", s.printed());
        let tulip = s.current().unwrap();
        s.run(SceneCommand::Duplicate(tulip, DVec3::X)).unwrap();
        let all = ExportRequest { whole: true, ..print };
        assert!(matches!(s.export(&all, &Run::plain()), Err(WorkspaceError::PrintsOne)));
    }
}
