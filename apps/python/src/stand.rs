//! Stands of many trees: inventories and specs -> rows -> tiles of grown plants.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Read as _, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burgeon::forest::{
    BadRows, Crs, ForestError, ForestSpec, GroundSpec, InventoryError, InventorySpec, Setting, Site, Stand,
    grow_stand_on, read_inventory, write_stand_csv,
};
use burgeon::formats::{Packing, WriteError};
use burgeon::glam::{DVec2, DVec3};
use burgeon::{
    ForestPlan, ForestTilesError, ForestTilesSpec, ModelsOf, NamedMesh, NurseryError, Preset, Report, Seed,
    SiteError, SiteFiles, StandReport, StandTile, Stopped, TILES_JOURNAL, TILES_MANIFEST, TileDisk, TileFile,
    TileFolder, TileId, TileModels, TileWriter, TreeSpec, WholeForest,
};
use companions::{Named, NamedFileError, Trust};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::asked::Asked;
use crate::column::Column;
use crate::compute::compute;
use crate::fault::{beyond, misread, not_readable, refused, unusable};
use crate::make::{Base, named_mesh};

/// Largest height map or mask, in bytes.
const MOST_BYTES: u64 = 1 << 30;

/// Trees, and the specs of their species.
#[pyclass(frozen, module = "burgeon._burgeon")]
pub(crate) struct RawStand {
    stand: Arc<Stand>,
    specs: Vec<TreeSpec>,
    source: StandReport,
    warnings: Vec<String>,
}

/// Settings for reading an inventory, as Python requests it.
#[derive(FromPyObject)]
pub(crate) struct Reading<'py> {
    #[pyo3(item)]
    crs: Option<String>,
    #[pyo3(item)]
    setting: String,
    #[pyo3(item)]
    species: Option<String>,
    #[pyo3(item)]
    bad_rows: String,
    #[pyo3(item)]
    year: Option<u32>,
    /// The table of a ground, in the form of a spec.
    #[pyo3(item)]
    ground: Bound<'py, PyDict>,
    #[pyo3(item)]
    lean: f64,
    #[pyo3(item)]
    seed: u64,
    #[pyo3(item)]
    budget: f64,
}

impl Reading<'_> {
    fn spec(&self) -> PyResult<InventorySpec> {
        let crs = self.crs.as_deref().map(|word| {
            let none = || beyond("crs", format!("{word:?}"), "metres, local, utm or a zone such as utm32n");
            Crs::from_word(word).ok_or_else(none)
        });
        let (setting, bad_rows) = (&self.setting, &self.bad_rows);
        Ok(InventorySpec {
            crs: crs.transpose()?,
            setting: Setting::from_word(setting)
                .ok_or_else(|| beyond("setting", format!("{setting:?}"), &Setting::words()))?,
            species: self.species.clone(),
            bad_rows: BadRows::from_word(bad_rows)
                .ok_or_else(|| beyond("bad_rows", format!("{bad_rows:?}"), &BadRows::words()))?,
            year: self.year,
            seed: Seed::new(self.seed),
        })
    }
}

/// Reads the stand of an inventory: the bytes of CSV or GeoJSON; file names of the ground are relative to `path`.
#[pyfunction]
pub(crate) fn read_stand(
    py: Python<'_>,
    inventory: Vec<u8>,
    path: PathBuf,
    reading: Reading<'_>,
) -> PyResult<RawStand> {
    let spec = reading.spec()?;
    let ground: GroundSpec =
        serde_json::from_value(crate::value::json_of(reading.ground.as_any(), "ground")?)
            .map_err(|e| misread(py, "ground", &e))?;
    let lean = reading.lean;
    // The caller names the ground itself.
    let files = Beside { naming: path.clone(), trust: Trust { paths: true, allow: "" } };
    let made = compute(py, reading.budget, |run| -> Result<_, StandFault> {
        let (mut stand, report) = read_inventory(&inventory, &spec, run)?;
        let mut warnings = report.report.warnings.clone();
        let origin = DVec2::new(stand.origin_m.x, stand.origin_m.z);
        if ground != GroundSpec::Flat {
            let ground = burgeon::read_ground(&ground, Some(origin), &files, run)?;
            let outside = ground.set_down(&mut stand, lean, run).map_err(Stopped::from)?;
            let mut told = Report::default();
            if outside > 0 {
                told.warn(
                    "forest-outside-ground",
                    format!("{outside} trees stand outside of the ground, or where it has no data: they stay at the height that they had"),
                );
            }
            warnings.extend(told.warnings);
        }
        Ok((stand, StandReport::from(&report), warnings))
    })?;
    let (stand, source, warnings) = made.map_err(|e| e.into_exception(py))?;
    RawStand::new(py, stand, &Base::from_fields(path, false), source, &warnings)
}

/// Grows the stand of a spec.
#[pyfunction]
pub(crate) fn grow_stand(py: Python<'_>, base: Base, asked: Asked<'_>) -> PyResult<RawStand> {
    let spec: ForestSpec = match base.text() {
        Some(text) => burgeon::spec::from_toml(text).map_err(|e| refused(py, &e))?,
        None => ForestSpec::default(),
    };
    let spec = asked.spec(py, &spec)?;
    let files = Beside { naming: base.naming().to_path_buf(), trust: base.trust() };
    let seed = asked.seed();
    let made = compute(py, asked.budget()?, |run| -> Result<_, StandFault> {
        let ground = burgeon::read_ground(&spec.ground, None, &files, run)?;
        let masks = burgeon::read_masks(&spec, &files, run)?;
        Ok(grow_stand_on(&spec, &Site { ground: &ground, masks: &masks }, seed, run)?)
    })?;
    let grown = made.map_err(|e| e.into_exception(py))?;
    let source = StandReport::from(&grown);
    RawStand::new(py, grown.stand, &base, source, &grown.report.warnings)
}

impl RawStand {
    fn new(
        py: Python<'_>,
        stand: Stand,
        base: &Base,
        source: StandReport,
        warnings: &[burgeon::Warning],
    ) -> PyResult<Self> {
        let spec = |name: &String| match Preset::find(name) {
            Some(preset) => preset.spec().map_err(|e| refused(py, &e)),
            None => base.tree_beside(py, name),
        };
        let specs = stand.species.iter().map(spec).collect::<PyResult<_>>()?;
        let warnings = warnings.iter().map(ToString::to_string).collect();
        Ok(Self { stand: Arc::new(stand), specs, source, warnings })
    }
}

#[pymethods]
impl RawStand {
    /// Returns the number of trees.
    fn count(&self) -> usize {
        self.stand.trees.len()
    }

    /// Returns the words of presets, or names of specs.
    fn species(&self) -> Vec<String> {
        self.stand.species.clone()
    }

    /// Returns easting, height and northing of the origin, metres.
    fn origin(&self) -> [f64; 3] {
        self.stand.origin_m.to_array()
    }

    /// Returns a column of the trees.
    fn column(&self, name: &str) -> PyResult<Column> {
        let trees = &self.stand.trees;
        let f = |of: fn(&burgeon::forest::Tree) -> f64| Column::new(trees.iter().map(of).collect::<Vec<_>>());
        let v =
            |of: fn(&burgeon::forest::Tree) -> DVec3| Column::new(trees.iter().map(of).collect::<Vec<_>>());
        Ok(match name {
            "position" => v(|t| t.foot_m),
            "up" => v(|t| t.up),
            "crown_offset" => v(|t| t.crown_offset_m),
            "height" => f(|t| t.height_m),
            "dbh" => f(|t| t.dbh_m),
            "crown_width" => f(|t| t.crown_width_m),
            "age" => f(|t| t.age_years),
            "yaw" => f(|t| t.yaw),
            "species" => Column::new(trees.iter().map(|t| u32::from(t.species)).collect::<Vec<_>>()),
            "row" => Column::new(trees.iter().map(|t| t.row).collect::<Vec<_>>()),
            other => return Err(beyond("column", format!("{other:?}"), "a column of the trees")),
        })
    }

    /// Returns the origin of the stand, and its warnings, as JSON.
    fn report(&self) -> PyResult<String> {
        json(&Told { source: &self.source, warnings: &self.warnings })
    }

    /// Returns its table as CSV.
    fn csv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut text = Vec::new();
        write_stand_csv(&self.stand, &mut text).map_err(|e| PyOSError::new_err(e.to_string()))?;
        Ok(PyBytes::new(py, &text))
    }

    /// Plans its tiles.
    fn plan(&self, py: Python<'_>, form: TilesForm<'_>) -> PyResult<RawTiles> {
        let (spec, place) = (form.spec(py)?, form.place);
        let whole = WholeForest {
            glb: form.glb,
            usd: form.usd,
            level: form.level.saturating_sub(form.finest),
            place: place.map(DVec3::from_array),
        };
        let stand = Stand::clone(&self.stand);
        let made = compute(py, form.budget, |run| ForestPlan::new(stand, &self.specs, spec, run))?;
        let plan = made.map_err(|e| StandFault::Tiles(e).into_exception(py))?;
        Ok(RawTiles { plan, whole, budget: form.budget })
    }
}

#[derive(serde::Serialize)]
struct Told<'a> {
    #[serde(flatten)]
    source: &'a StandReport,
    warnings: &'a [String],
}

fn json(value: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|e| pyo3::exceptions::PyRuntimeError::new_err(e.to_string()))
}

/// Settings for the tiles of a stand, as Python requests them.
#[derive(FromPyObject)]
pub(crate) struct TilesForm<'py> {
    #[pyo3(item)]
    variants: u32,
    #[pyo3(item)]
    seed: u64,
    #[pyo3(item)]
    finest: u32,
    #[pyo3(item)]
    lods: u32,
    /// Size of the impostors' pictures in pixels, or 0 for none.
    #[pyo3(item)]
    impostor: u32,
    #[pyo3(item)]
    tile_trees: Option<u32>,
    #[pyo3(item)]
    pack: String,
    /// Fields of the meshing of plants.
    #[pyo3(item)]
    skin: Bound<'py, PyDict>,
    #[pyo3(item)]
    glb: bool,
    #[pyo3(item)]
    usd: bool,
    #[pyo3(item)]
    level: u32,
    #[pyo3(item)]
    place: Option<[f64; 3]>,
    #[pyo3(item)]
    budget: f64,
}

impl TilesForm<'_> {
    fn spec(&self, py: Python<'_>) -> PyResult<ForestTilesSpec> {
        let mut spec = ForestTilesSpec {
            variants: self.variants,
            seed: Seed::new(self.seed),
            tile_trees: self.tile_trees,
            ..ForestTilesSpec::default()
        };
        let usual = spec.look.skin;
        spec.look.skin = crate::asked::skin_on(py, &self.skin, &usual)?.0;
        // Fields that are not saved come back with the values of single plants.
        if !self.skin.contains("texture_size")? {
            spec.look.skin.texture_size = usual.texture_size;
        }
        if !self.skin.contains("foliage")? {
            spec.look.skin.foliage = usual.foliage;
        }
        (spec.look.finest, spec.look.lods) = (self.finest, self.lods);
        spec.look.impostor = Some(self.impostor).filter(|&size| size > 0);
        spec.packing = match self.pack.as_str() {
            "meshopt" => Packing::Compressed,
            "quantized" => Packing::Quantized,
            other => return Err(beyond("pack", format!("{other:?}"), "quantized or meshopt")),
        };
        Ok(spec)
    }
}

/// Depth, column, row and level of a tile.
type Id = (u8, u32, u32, u8);

const fn id((depth, x, y, level): Id) -> TileId {
    TileId { depth, x, y, level }
}

/// The tiles of a stand, before their files.
#[pyclass(frozen, module = "burgeon._burgeon")]
pub(crate) struct RawTiles {
    plan: ForestPlan,
    whole: WholeForest,
    budget: f64,
}

#[pymethods]
impl RawTiles {
    /// Returns every tile.
    fn tiles(&self) -> Vec<Id> {
        self.plan.tiling.tiles().iter().map(|t| (t.id.depth, t.id.x, t.id.y, t.id.level)).collect()
    }

    /// Returns every plant that represents trees.
    fn variants(&self) -> Vec<u32> {
        self.plan.used_variants().collect()
    }

    /// Returns how much plants differ from their trees, as JSON.
    fn report(&self) -> PyResult<String> {
        let (own, mut told) = (&self.plan.misfits, Report::default());
        own.tell(&mut told);
        let told: Vec<String> = told.warnings.iter().map(ToString::to_string).collect();
        json(&serde_json::json!({
            "trees": own.trees,
            "variants": self.plan.nursery.variants().len(),
            "tiles": self.plan.tiling.tiles().len(),
            "height_error_max_m": own.height_error_max_m,
            "dbh_error_max_m": own.dbh_error_max_m,
            "dbh_error_mean_m": own.dbh_error_mean_m,
            "crown_error_max_m": own.crown_error_max_m,
            "clipped": own.clipped,
            "stems_off": own.stems_off,
            "warnings": told,
        }))
    }

    /// Records files that other processes have put into a folder, and marks the folder as unfinished.
    fn adopt(&self, py: Python<'_>, folder: PathBuf, files: Vec<(String, String, u64)>) -> PyResult<()> {
        let files = files.into_iter().map(|(file, digest, bytes)| TileFile { file, digest, bytes }).collect();
        let made =
            py.detach(|| TileFolder::open(FolderDisk::new(&folder, true)?, &self.plan.key())?.adopt(files));
        made.map_err(|e| e.into_exception(py))
    }

    /// Writes the models of some plants, or some tiles, for a folder that another process keeps; returns their files.
    fn part(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        variants: Vec<u32>,
        tiles: Vec<Id>,
    ) -> PyResult<Vec<(String, String, u64)>> {
        let files = compute(py, self.budget, |run| -> Result<Vec<TileFile>, StandFault> {
            let mut folder = TileFolder::open(FolderDisk::new(&folder, false)?, &self.plan.key())?;
            if tiles.is_empty() {
                TileModels::make(&self.plan, ModelsOf::Variants(&variants), &mut folder, run, &|_, _| ())?;
            }
            let tiles = tiles.into_iter().map(|own| self.plan.tile(id(own)));
            let tiles: Vec<StandTile> = tiles.map(|t| t.cloned()).collect::<Result<_, _>>()?;
            if !tiles.is_empty() {
                let used: BTreeSet<u32> = tiles.iter().flat_map(|tile| self.plan.used_by(tile)).collect();
                let used: Vec<u32> = used.into_iter().collect();
                let models =
                    TileModels::make(&self.plan, ModelsOf::Variants(&used), &mut folder, run, &|_, _| ())?;
                TileWriter { plan: &self.plan, models: &models }.tiles(
                    &tiles,
                    &mut folder,
                    run,
                    &|_, _| (),
                )?;
            }
            Ok(folder.files().cloned().collect())
        })?;
        let files = files.map_err(|e| e.into_exception(py))?;
        Ok(files.into_iter().map(|own| (own.file, own.digest, own.bytes)).collect())
    }

    /// Writes one tile and its models.
    fn tile(&self, py: Python<'_>, folder: PathBuf, tile: Id) -> PyResult<()> {
        let made = compute(py, self.budget, |run| -> Result<(), StandFault> {
            let mut folder = TileFolder::open(FolderDisk::new(&folder, true)?, &self.plan.key())?;
            let tile = self.plan.tile(id(tile))?;
            let models = TileModels::make(&self.plan, ModelsOf::Tile(tile), &mut folder, run, &|_, _| ())?;
            let writer = TileWriter { plan: &self.plan, models: &models };
            writer.tiles(std::slice::from_ref(tile), &mut folder, run, &|_, _| ())
        })?;
        made.map_err(|e| e.into_exception(py))
    }

    /// Writes all missing files, and the file that readers open.
    fn write(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let made = compute(py, self.budget, |run| -> Result<(), StandFault> {
            let mut folder = TileFolder::open(FolderDisk::new(&folder, true)?, &self.plan.key())?;
            let usd = self.whole.usd.then_some(self.whole.level);
            let models = TileModels::make(&self.plan, ModelsOf::All { usd }, &mut folder, run, &|_, _| ())?;
            let writer = TileWriter { plan: &self.plan, models: &models };
            writer.tiles(self.plan.tiling.tiles(), &mut folder, run, &|_, _| ())?;
            writer.whole(&self.whole, &mut folder)?;
            folder.disk().place_last()?;
            folder.end()
        })?;
        made.map_err(|e| e.into_exception(py))
    }
}

/// Files whose names are relative to another file.
struct Beside {
    naming: PathBuf,
    trust: Trust,
}

impl Beside {
    fn named<'a>(&'a self, name: &'a str) -> Named<'a> {
        Named { naming: &self.naming, name }
    }
}

impl SiteFiles for Beside {
    type Error = StandFault;

    fn bytes(&self, name: &str) -> Result<Vec<u8>, StandFault> {
        let named = self.named(name);
        let (file, _) = named.open(self.trust, MOST_BYTES)?;
        Ok(named.read(file, MOST_BYTES)?)
    }

    fn mesh(&self, name: &str) -> Result<NamedMesh, StandFault> {
        named_mesh(&self.named(name), self.trust)?.ok_or_else(|| StandFault::NoMesh(name.to_owned()))
    }
}

/// The folder of a tileset.
struct FolderDisk {
    path: PathBuf,
    /// Whether this process writes the journal; if not, another one does.
    has_journal: bool,
    /// Drafts of the last step, and their final places.
    last: Vec<(PathBuf, PathBuf)>,
}

impl FolderDisk {
    fn new(path: &Path, has_journal: bool) -> Result<Self, StandFault> {
        let failed = |e| StandFault::Io(path.to_path_buf(), e);
        let is_ours = [TILES_MANIFEST, TILES_JOURNAL].iter().any(|file| path.join(file).exists());
        if !is_ours && path.exists() {
            let mut names = fs::read_dir(path).map_err(failed)?.filter_map(|e| Some(e.ok()?.file_name()));
            if names.any(|name| !name.to_string_lossy().starts_with('.')) {
                return Err(StandFault::NotOurs(path.to_path_buf()));
            }
        }
        fs::create_dir_all(path).map_err(failed)?;
        Ok(Self { path: path.to_path_buf(), has_journal, last: Vec::new() })
    }

    /// Creates a draft file next to its place; returns the file and both names.
    fn draft(&self, file: &str) -> Result<(File, PathBuf, PathBuf), StandFault> {
        let place = self.path.join(file);
        let folder = place.parent().unwrap_or(&self.path);
        let name = place.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let draft = folder.join(format!(".{name}.{}.draft", std::process::id()));
        let open = || {
            fs::create_dir_all(folder)?;
            File::create(&draft)
        };
        let opened = open().map_err(|e| StandFault::Io(place.clone(), e))?;
        Ok((opened, draft, place))
    }

    fn place_last(&mut self) -> Result<(), StandFault> {
        put(&std::mem::take(&mut self.last))
    }
}

/// Renames drafts; if one fails, the rest are deleted.
fn put(drafts: &[(PathBuf, PathBuf)]) -> Result<(), StandFault> {
    for (k, (draft, place)) in drafts.iter().enumerate() {
        if let Err(e) = fs::rename(draft, place) {
            drafts[k..].iter().for_each(|(draft, _)| drop(fs::remove_file(draft)));
            return Err(StandFault::Io(place.clone(), e));
        }
    }
    Ok(())
}

impl Drop for FolderDisk {
    fn drop(&mut self) {
        self.last.iter().for_each(|(draft, _)| drop(fs::remove_file(draft)));
    }
}

impl TileDisk for FolderDisk {
    type Error = StandFault;

    fn read(&self, file: &str, most: u64) -> Result<Option<Vec<u8>>, StandFault> {
        let path = self.path.join(file);
        let mut bytes = Vec::new();
        let read = File::open(&path).and_then(|f| f.take(most.saturating_add(1)).read_to_end(&mut bytes));
        match read {
            Ok(_) => Ok(Some(bytes)),
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(e) => Err(StandFault::Io(path, e)),
        }
    }

    fn place(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), StandFault> {
        let mut drafts = Vec::with_capacity(files.len());
        for (name, bytes) in files.iter().filter(|(name, _)| self.has_journal || name != TILES_JOURNAL) {
            let (mut file, draft, place) = self.draft(name)?;
            let written = file.write_all(bytes).and_then(|()| file.sync_all());
            drafts.push((draft, place.clone()));
            if let Err(e) = written {
                drafts.iter().for_each(|(draft, _)| drop(fs::remove_file(draft)));
                return Err(StandFault::Io(place, e));
            }
        }
        put(&drafts)
    }

    fn append(&mut self, file: &str, text: &str) -> Result<(), StandFault> {
        if !self.has_journal {
            return Ok(());
        }
        let path = self.path.join(file);
        let opened = OpenOptions::new().append(true).create(true).open(&path);
        opened.and_then(|mut f| f.write_all(text.as_bytes())).map_err(|e| StandFault::Io(path, e))
    }

    fn remove(&mut self, file: &str) -> Result<(), StandFault> {
        let path = self.path.join(file);
        match fs::remove_file(&path) {
            Err(e) if self.has_journal && e.kind() != io::ErrorKind::NotFound => Err(StandFault::Io(path, e)),
            _ => Ok(()),
        }
    }

    fn write_last(
        &mut self,
        name: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Result<(), StandFault> {
        let (file, draft, place) = self.draft(name)?;
        self.last.push((draft, place.clone()));
        let mut out = BufWriter::new(file);
        write(&mut out).map_err(ForestTilesError::from)?;
        let file = out.into_inner().map_err(|e| StandFault::Io(place.clone(), e.into_error()))?;
        file.sync_all().map_err(|e| StandFault::Io(place, e))
    }
}

/// Reason why there is no stand, or why its tiles failed.
enum StandFault {
    Inventory(InventoryError),
    Forest(ForestError),
    Site(SiteError),
    Stopped(Stopped),
    Named(NamedFileError),
    NoMesh(String),
    Tiles(ForestTilesError),
    NotOurs(PathBuf),
    Io(PathBuf, io::Error),
}

macro_rules! faults {
    ($($error:ty => $variant:ident),* $(,)?) => {$(
        impl From<$error> for StandFault {
            fn from(error: $error) -> Self {
                Self::$variant(error)
            }
        }
    )*};
}

faults!(InventoryError => Inventory, ForestError => Forest, SiteError => Site, Stopped => Stopped, NamedFileError => Named, ForestTilesError => Tiles);

impl StandFault {
    /// Returns the exception of Python.
    fn into_exception(self, py: Python<'_>) -> PyErr {
        let stopped = || PyKeyboardInterrupt::new_err("stopped");
        match self {
            Self::Inventory(InventoryError::Cancelled(_)) | Self::Forest(ForestError::Cancelled(_)) => {
                stopped()
            }
            Self::Inventory(InventoryError::OverBudget(e)) => refused(py, &e),
            Self::Inventory(e) => unusable(py, &e),
            Self::Forest(e) => unusable(py, &e),
            Self::Site(e) => unusable(py, &e),
            Self::Stopped(e) | Self::Tiles(ForestTilesError::Nursery(NurseryError::Stopped(e))) => match e {
                Stopped::Cancelled(_) => stopped(),
                Stopped::OverBudget(e) => refused(py, &e),
            },
            Self::Named(e) => not_readable(py, &e),
            Self::NoMesh(name) => unusable(py, &format!("{name}: is no model, or is not there")),
            Self::Tiles(e) => unusable(py, &e),
            Self::NotOurs(path) => unusable(
                py,
                &format!(
                    "{}: is a folder with other files in it, and tiles of a forest want one of their own; name a new one",
                    path.display()
                ),
            ),
            Self::Io(path, e) => match e.raw_os_error() {
                Some(number) => PyOSError::new_err((number, e.to_string(), path.display().to_string())),
                None => PyOSError::new_err(format!("{}: {e}", path.display())),
            },
        }
    }
}
