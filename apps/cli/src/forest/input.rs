//! An inventory or the spec of a stand, its ground, and the specs of its species.

use std::path::Path;

use burgeon::forest::{
    ForestError, ForestSpec, Ground, GroundError, GroundMesh, GroundSpec, HeightMap, InventoryError,
    InventoryReport, InventorySpec, MapScale, Mask, Site, Stand, grow_stand_on, read_inventory,
};
use burgeon::glam::DVec2;
use burgeon::growth::TreeSpec;
use burgeon::{Preset, Report, Run, Seed};
use serde::Serialize;

use crate::args::{ForestArgs, GroundArgs};
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::{files, grow, inputs};

/// An inventory, a height map or a mask is no larger.
const MOST_BYTES: u64 = 1 << 30;
/// Options of inventories.
const OF_INVENTORIES: [&str; 5] = ["crs", "setting", "species", "bad_rows", "year"];
/// Options of the ground, which a spec has within.
const OF_GROUND: [&str; 4] = ["ground", "metres_per_cell", "heights", "lean"];

/// What was read.
#[derive(Debug, Default, Serialize)]
pub(super) struct InputTally {
    /// Rows of an inventory, with those left out; null of a stand that grew.
    rows: Option<u32>,
    skipped: Option<u32>,
    /// Trees whose height, diameter, crown and age were given.
    given: Option<[u32; 4]>,
    /// Half the logarithm of high over low of those that were filled, in the mean: 0.3 is an interval from 1/1.35 to 1.35 times.
    filled_log_interval: Option<[f64; 4]>,
    /// Trees at the place of an earlier one, and whose trunks touch.
    duplicates: Option<u32>,
    touching: Option<u32>,
    /// Of a stand that grew: years, trees and square metres of basal area a hectare, after each step.
    history: Vec<[f64; 3]>,
}

impl InputTally {
    fn of(report: &InventoryReport) -> Self {
        let all = [report.height, report.dbh, report.crown_width, report.age];
        Self {
            rows: Some(report.rows),
            skipped: Some(report.skipped),
            given: Some(all.map(|f| f.given)),
            filled_log_interval: Some(all.map(|f| f.mean_log_interval)),
            duplicates: Some(report.duplicates),
            touching: Some(report.touching),
            history: Vec::new(),
        }
    }
}

/// The trees, on their ground.
pub(super) fn read(args: &ForestArgs, machine: &Machine, told: &mut Report) -> Outcome<(Stand, InputTally)> {
    let is_spec = files::extension(&args.input).is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let (stand, tally) = if is_spec { grown(args, machine, told)? } else { inventory(args, machine, told)? };
    if let Some(fault) = stand.validate().next() {
        return Err(Failure::Bug(format!("tree {} of the stand has a bad {}", fault.tree + 1, fault.field)));
    }
    Ok((stand, tally))
}

fn inventory(args: &ForestArgs, machine: &Machine, told: &mut Report) -> Outcome<(Stand, InputTally)> {
    let bytes = files::read_bytes(&args.input, MOST_BYTES)?;
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
        InventoryError::OverBudget(e) => Failure::at(&args.input, e),
        e => Failure::at(&args.input, in_options(&e)),
    })?;
    let tally = InputTally::of(&report);
    told.warnings.extend(report.report.warnings);
    let origin = DVec2::new(stand.origin_m.x, stand.origin_m.z);
    if let Some(path) = &args.ground.ground {
        let ground = ground_file(path, &args.ground, origin, machine)?;
        let outside = ground.set_down(&mut stand, args.ground.lean.unwrap_or(0.0), &machine.run())?;
        if outside as usize == stand.trees.len() {
            let what = "has no height where the trees stand: are both in the same projection and unit?";
            return Err(Failure::at(path, what));
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

/// The message of an error, with the options that help.
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

fn ground_file(path: &Path, args: &GroundArgs, origin: DVec2, machine: &Machine) -> Outcome<Ground> {
    let extension = files::extension(path).unwrap_or_default().to_ascii_lowercase();
    let run = machine.run();
    let failed = |e: GroundError| Failure::at(path, e);
    match extension.as_str() {
        "png" => {
            let (Some(metres_per_cell), Some([low_m, high_m])) = (args.metres_per_cell, args.heights) else {
                let what = "is a height map whose metres are not known: give --metres-per-cell M and --heights LOW,HIGH";
                return Err(Failure::at(path, what));
            };
            let scale = MapScale { metres_per_cell, low_m, high_m, no_data: None };
            let bytes = files::read_bytes(path, MOST_BYTES)?;
            Ok(Ground::Map(HeightMap::from_png(&bytes, &scale, &run).map_err(failed)?))
        }
        "tif" | "tiff" => {
            let bytes = files::read_bytes(path, MOST_BYTES)?;
            Ok(Ground::Map(HeightMap::from_geotiff(&bytes, Some(origin), &run).map_err(failed)?.0))
        }
        _ => mesh_ground(path, &run),
    }
}

fn mesh_ground(path: &Path, run: &Run<'_>) -> Outcome<Ground> {
    let (model, ..) = files::read_model(path, &burgeon::formats::ExportSpec::default())?;
    let (vertices, triangles) = model.triangles();
    let mesh = GroundMesh::new(&vertices, &triangles, run).map_err(|e| Failure::at(path, e))?;
    Ok(Ground::Mesh(mesh))
}

/// A stand that grows by its spec.
fn grown(args: &ForestArgs, machine: &Machine, told: &mut Report) -> Outcome<(Stand, InputTally)> {
    args.given.refuse(&OF_INVENTORIES, "inventories", "this is the spec of a stand")?;
    args.given.refuse(&OF_GROUND, "inventories", "the spec of a stand names its own ground")?;
    let spec: ForestSpec = files::read_spec(&args.input)?;
    let run = machine.run();
    let ground = spec_ground(&spec.ground, &args.input, &run)?;
    let masks = spec.masks.iter().map(|mask| {
        let bytes = named_bytes(&args.input, &mask.file)?;
        let read = Mask::from_png(&bytes, &run)
            .map_err(|e| Failure::at(&args.input, format_args!("mask {:?}: {e}", mask.file)))?;
        Ok(if mask.inverted { read.inverted() } else { read })
    });
    let masks: Vec<Mask> = masks.collect::<Outcome<_>>()?;
    let site = Site { ground: &ground, masks: &masks };
    let grown = grow_stand_on(&spec, &site, Seed::new(args.seed), &run).map_err(|e| match e {
        ForestError::Cancelled(_) => Failure::Cancelled,
        e => Failure::at(&args.input, e),
    })?;
    told.warnings.extend(grown.report.warnings);
    let history = grown.history.iter().map(|y| [f64::from(y.year), y.trees_ha, y.basal_area_m2_ha]);
    let tally = InputTally { history: history.collect(), ..InputTally::default() };
    Ok((grown.stand, tally))
}

fn spec_ground(ground: &GroundSpec, spec: &Path, run: &Run<'_>) -> Outcome<Ground> {
    let failed = |e: GroundError| Failure::at(spec, e);
    match ground {
        GroundSpec::Flat => Ok(Ground::Flat),
        GroundSpec::Png { file, metres_per_cell, low_m, high_m, no_data } => {
            let scale = MapScale {
                metres_per_cell: *metres_per_cell,
                low_m: *low_m,
                high_m: *high_m,
                no_data: *no_data,
            };
            let bytes = named_bytes(spec, file)?;
            Ok(Ground::Map(HeightMap::from_png(&bytes, &scale, run).map_err(failed)?))
        }
        GroundSpec::Geotiff { file } => {
            let bytes = named_bytes(spec, file)?;
            Ok(Ground::Map(HeightMap::from_geotiff(&bytes, None, run).map_err(failed)?.0))
        }
        GroundSpec::Mesh { file } => mesh_ground(&inputs::named_path(spec, file)?, run),
    }
}

fn named_bytes(naming: &Path, name: &str) -> Outcome<Vec<u8>> {
    Ok(inputs::named_bytes(naming, name, MOST_BYTES)?)
}

/// The specs of the species of a stand, in their order.
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
