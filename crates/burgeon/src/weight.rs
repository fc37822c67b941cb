//! The file of a plant's model as its bytes are counted and written: the same for every shell.

use std::io::{self, Write};

use base::Report;
use formats::{
    BesideFile, ExportSpec, Level, ModelFormat, PngCache, Room, WriteError, model_files, write_glb_levels,
    write_glb_rigged,
};
use mesh::Model;
use plant::Plant;

use crate::engine::Engine;
use crate::engine_nodes::{engine_textures, write_engine_glb};

/// Form of the file of a model.
#[derive(Clone, Copy, Debug)]
pub struct FileForm {
    /// Its format.
    pub format: ModelFormat,
    /// Axes and unit, where the format has room for them.
    pub axes: ExportSpec,
    /// How it is packed, where the format has room for that.
    pub packing: Option<formats::Packing>,
    /// Whether it has joints that sway.
    pub sways: bool,
    /// Whether its levels are in the file, too.
    pub is_one_file: bool,
    /// The program that wants levels and shapes for collisions as nodes of one file ([`Engine::has_nodes`]).
    pub nodes: Option<Engine>,
}

impl FileForm {
    /// Writes levels into one `.glb`, as named nodes if a program wants them.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write_levels(
        &self,
        plant: &Plant,
        levels: &[Level<'_>],
        cache: &mut PngCache,
        out: impl Write,
    ) -> Result<(), WriteError> {
        match self.nodes {
            Some(engine) => {
                let models: Vec<&Model> = levels.iter().map(|level| level.model).collect();
                write_engine_glb(engine, plant, &models, cache, out)
            }
            None => write_glb_levels(levels, self.packing, cache, out),
        }
    }

    /// Returns the bytes of the file of a model, the first of `levels`, and of the files beside it.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn weigh(
        &self,
        plant: &Plant,
        levels: &[Level<'_>],
        cache: &mut PngCache,
    ) -> Result<u64, WriteError> {
        let Some(Level { model, .. }) = levels.first() else { return Ok(0) };
        if !self.format.holds(Room::Packing) {
            let made = model_files(model, self.format, "model", &self.axes, cache, &mut Report::default())?;
            return Ok((made.own.len() + made.beside.iter().map(|f| f.bytes.len()).sum::<usize>()) as u64);
        }
        let count = if self.is_one_file { levels.len() } else { 1 };
        let mut out = Counter::default();
        self.write_glb(plant, &levels[..count], cache, &mut out)?;
        let beside = self.textures_beside(plant, model, "model")?;
        Ok(out.bytes + beside.iter().map(|file| file.bytes.len() as u64).sum::<u64>())
    }

    /// Returns the textures that a program wants beside a file of named nodes, which does not name them
    /// ([`engine_textures`]). `model`: the finest level.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn textures_beside(
        &self,
        plant: &Plant,
        model: &Model,
        stem: &str,
    ) -> Result<Vec<BesideFile>, WriteError> {
        self.nodes.map_or_else(|| Ok(Vec::new()), |engine| engine_textures(engine, plant, model, stem))
    }

    /// Writes a `.glb`: the first of `levels` with joints if it sways, or else all of them.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write_glb(
        &self,
        plant: &Plant,
        levels: &[Level<'_>],
        cache: &mut PngCache,
        out: impl Write,
    ) -> Result<(), WriteError> {
        let swaying = levels.first().map(|level| level.model).filter(|_| self.sways);
        match swaying.and_then(|model| Some((model, skin::sway(model, skin::gust(model))?))) {
            Some((model, rig)) => write_glb_rigged(model, &rig, cache, out),
            None => self.write_levels(plant, levels, cache, out),
        }
    }
}

/// Counts bytes.
#[derive(Default)]
struct Counter {
    bytes: u64,
}

impl Write for Counter {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.bytes += buffer.len() as u64;
        Ok(buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
