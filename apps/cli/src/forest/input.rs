//! An inventory or the spec of a stand, its ground, and the specs of its species.

use std::path::Path;

use burgeon::forest::{
    ForestError, ForestSpec, GroundSpec, InventoryError, InventorySpec, Site, Stand, grow_stand_on,
    read_inventory,
};
use burgeon::glam::DVec2;
use burgeon::growth::TreeSpec;
use burgeon::{NamedMesh, Preset, Report, Seed, SiteError, SiteFiles, StandReport};

use crate::args::{ForestArgs, GroundArgs};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::{files, grow, inputs};

/// Largest size of an inventory, a height map or a mask, bytes.
const MOST_BYTES: u64 = 1 << 30;
/// Options of inventories.
const OF_INVENTORIES: [&str; 5] = ["crs", "setting", "species", "bad_rows", "year"];
/// Options of the ground, which a spec contains.
const OF_GROUND: [&str; 4] = ["ground", "metres_per_cell", "heights", "lean"];

/// Reads the trees, on their ground.
pub(super) fn read(args: &ForestArgs, machine: &Machine, told: &mut Report) -> Outcome<(Stand, StandReport)> {
    let is_spec = files::extension(&args.input).is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let (stand, tally) = if is_spec { grown(args, machine, told)? } else { inventory(args, machine, told)? };
    if let Some(fault) = stand.validate().next() {
        return Err(Failure::Bug(format!("tree {} of the stand has a bad {}", fault.tree + 1, fault.field)));
    }
    Ok((stand, tally))
}

fn inventory(args: &ForestArgs, machine: &Machine, told: &mut Report) -> Outcome<(Stand, StandReport)> {
    let bytes = files::read_bytes(&args.input, MOST_BYTES)?;
    files::refuse_foreign(&args.input, &bytes)?;
    let stand = &args.stand;
    let spec = InventorySpec {
        crs: stand.crs,
        setting: stand.setting,
        species: stand.species.clone(),
        bad_rows: stand.bad_rows,
        year: stand.year,
        seed: Seed::new(args.seed),
    };
    let (mut stand, report) = read_inventory(&bytes, &spec, &machine.run()).map_err(|e| match e {
        InventoryError::Cancelled(_) => Failure::Cancelled,
        InventoryError::OverBudget(e) => Failure::bad_file(&args.input, e),
        e => Failure::bad_file(&args.input, in_options(&e)),
    })?;
    let tally = StandReport::from(&report);
    told.warnings.extend(report.report.warnings);
    let origin = DVec2::new(stand.origin_m.x, stand.origin_m.z);
    if let Some(path) = &args.ground.ground {
        let file = path.to_string_lossy().into_owned();
        let spec = ground_spec(path, file, &args.ground)?;
        let ground = burgeon::read_ground(&spec, Some(origin), &GivenFiles(path), &machine.run());
        let ground = ground.map_err(|e| e.into_failure(path))?;
        let outside = ground.set_down(&mut stand, args.ground.lean.unwrap_or(0.0), &machine.run())?;
        if outside as usize == stand.trees.len() {
            let what = "has no height where the trees stand: are both in the same projection and unit?";
            return Err(Failure::bad_file(path, what));
        }
        if outside > 0 {
            told.warn(
                "forest-outside-ground",
                format!(
                    "{outside} trees stand outside of the ground, or where it has no data: they stay at the height that they had"
                ),
            );
        }
    }
    Ok((stand, tally))
}

/// Returns the message of an error, with the options that help.
fn in_options(error: &InventoryError) -> String {
    let hint = match error {
        InventoryError::Degrees(_) => " (--crs local or --crs utm)",
        InventoryError::DegreesAsMetres { .. } => " (--crs local, utm or metres)",
        InventoryError::NoSpecies => " (--species NAME)",
        InventoryError::Species { .. } => {
            " (or say with --species NAME which species stands for unknown ones)"
        }
        InventoryError::Value { .. } | InventoryError::Row { .. } => {
            " (or leave such rows out with --bad-rows skip)"
        }
        _ => "",
    };
    format!("{error}{hint}")
}

/// Returns the ground of an inventory, by the ending of its file.
fn ground_spec(path: &Path, file: String, args: &GroundArgs) -> Outcome<GroundSpec> {
    match files::extension(path).unwrap_or_default().to_ascii_lowercase().as_str() {
        "png" => {
            let (Some(metres_per_cell), Some([low_m, high_m])) = (args.metres_per_cell, args.heights) else {
                let what = "is a height map whose metres are not known: give --metres-per-cell M and --heights LOW,HIGH";
                return Err(Failure::bad_file(path, what));
            };
            Ok(GroundSpec::Png { file, metres_per_cell, low_m, high_m, no_data: None })
        }
        "tif" | "tiff" => Ok(GroundSpec::Geotiff { file }),
        _ => Ok(GroundSpec::Mesh { file }),
    }
}

/// The file of the ground that an option names.
struct GivenFiles<'a>(&'a Path);

/// The files that a spec names.
struct NamedFiles<'a>(&'a Path);

/// Reason why a site was not read: its content, or a file that was reported already.
enum SiteFailure {
    Site(SiteError),
    File(Failure),
}

impl SiteFailure {
    fn into_failure(self, path: &Path) -> Failure {
        match self {
            Self::Site(error) => Failure::bad_file(path, error),
            Self::File(failure) => failure,
        }
    }
}

impl From<SiteError> for SiteFailure {
    fn from(error: SiteError) -> Self {
        Self::Site(error)
    }
}

impl SiteFiles for GivenFiles<'_> {
    type Error = SiteFailure;

    fn bytes(&self, _: &str) -> Result<Vec<u8>, SiteFailure> {
        files::read_bytes(self.0, MOST_BYTES).map_err(SiteFailure::File)
    }

    fn mesh(&self, _: &str) -> Result<NamedMesh, SiteFailure> {
        read_mesh(self.0).map_err(SiteFailure::File)
    }
}

impl SiteFiles for NamedFiles<'_> {
    type Error = SiteFailure;

    fn bytes(&self, name: &str) -> Result<Vec<u8>, SiteFailure> {
        inputs::named_bytes(self.0, name, MOST_BYTES).map_err(|e| SiteFailure::File(e.into()))
    }

    fn mesh(&self, name: &str) -> Result<NamedMesh, SiteFailure> {
        let path = inputs::named_path(self.0, name).map_err(|e| SiteFailure::File(e.into()))?;
        read_mesh(&path).map_err(SiteFailure::File)
    }
}

fn read_mesh(path: &Path) -> Outcome<NamedMesh> {
    let (model, ..) = files::read_model(path, &burgeon::formats::ExportSpec::default())?;
    Ok(model.triangles())
}

/// Grows a stand by its spec.
fn grown(args: &ForestArgs, machine: &Machine, told: &mut Report) -> Outcome<(Stand, StandReport)> {
    args.given.refuse(&OF_INVENTORIES, "inventories", "this is the spec of a stand")?;
    args.given.refuse(&OF_GROUND, "inventories", "the spec of a stand names its own ground")?;
    let spec: ForestSpec = files::read_spec(&args.input)?;
    let run = machine.run();
    let named = NamedFiles(&args.input);
    let ground =
        burgeon::read_ground(&spec.ground, None, &named, &run).map_err(|e| e.into_failure(&args.input))?;
    let masks = burgeon::read_masks(&spec, &named, &run).map_err(|e| e.into_failure(&args.input))?;
    let site = Site { ground: &ground, masks: &masks };
    let grown = grow_stand_on(&spec, &site, Seed::new(args.seed), &run).map_err(|e| match e {
        ForestError::Cancelled(_) => Failure::Cancelled,
        e => Failure::bad_file(&args.input, e),
    })?;
    let tally = StandReport::from(&grown);
    told.warnings.extend(grown.report.warnings);
    Ok((grown.stand, tally))
}

/// Returns the specs of the species of a stand, in their order.
pub(super) fn specs(args: &ForestArgs, stand: &Stand, told: &mut Report) -> Outcome<Vec<TreeSpec>> {
    let spec = |name: &String| {
        if let Some(preset) = Preset::find(name) {
            return preset.spec().map_err(|e| Failure::Bug(format!("preset {name}: {e}")));
        }
        let path = inputs::named_path(&args.input, name)?;
        grow::read_spec(&path, told)
    };
    stand.species.iter().map(spec).collect()
}
