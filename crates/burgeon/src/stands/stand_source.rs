//! Sources of stands: the contents of an inventory or a spec, and the files that either of them names.

use base::Run;
use forest::{
    ForestSpec, Ground, GroundError, GroundMesh, GroundSpec, GrownStand, HeightMap, InventoryReport,
    MapScale, Mask,
};
use glam::DVec2;
use serde::Serialize;

use crate::NamedMesh;

/// The part of a report about the source of a stand.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StandReport {
    /// Rows of an inventory, including those left out; none for a stand that grew.
    pub rows: Option<u32>,
    /// Rows that were left out.
    pub skipped: Option<u32>,
    /// Numbers of trees whose height, diameter, crown and age were given.
    pub given: Option<[u32; 4]>,
    /// Mean half logarithm of the upper over the lower bound of estimated values: 0.3 is an interval from 1/1.35 to
    /// 1.35 times.
    pub filled_log_interval: Option<[f64; 4]>,
    /// Trees at the place of an earlier one.
    pub duplicates: Option<u32>,
    /// Trees whose trunks touch.
    pub touching: Option<u32>,
    /// For a stand that grew: years, trees and square metres of basal area a hectare, after each step.
    pub history: Vec<[f64; 3]>,
}

impl From<&InventoryReport> for StandReport {
    fn from(report: &InventoryReport) -> Self {
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

impl From<&GrownStand> for StandReport {
    fn from(grown: &GrownStand) -> Self {
        let history = grown.history.iter().map(|y| [f64::from(y.year), y.trees_ha, y.basal_area_m2_ha]);
        Self { history: history.collect(), ..Self::default() }
    }
}

/// The reason why a file of the ground or of a mask cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SiteError {
    /// The ground cannot be used.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// A mask cannot be used.
    #[error("mask {file:?}: {error}")]
    Mask {
        /// Its name in the spec.
        file: String,
        /// The reason.
        error: GroundError,
    },
}

/// Files that a spec names, as a shell reads them.
pub trait SiteFiles {
    /// Errors of the shell.
    type Error: From<SiteError>;

    /// Returns the contents of a file.
    ///
    /// # Errors
    /// Error of a file that does not exist, or must not be read.
    fn bytes(&self, name: &str) -> Result<Vec<u8>, Self::Error>;

    /// Returns the corners and triangles of a model, metres, +Y up.
    ///
    /// # Errors
    /// Error of a file that is not a model, does not exist, or must not be read.
    fn mesh(&self, name: &str) -> Result<NamedMesh, Self::Error>;
}

/// Reads a ground. `origin`: easting and northing of the stand's origin in the projection of a GeoTIFF; `None`: the
/// middle of the map.
///
/// # Errors
/// [`SiteError`], and those of the files.
pub fn read_ground<F: SiteFiles>(
    spec: &GroundSpec,
    origin: Option<DVec2>,
    files: &F,
    run: &Run<'_>,
) -> Result<Ground, F::Error> {
    let ground = match spec {
        GroundSpec::Flat => Ok(Ground::Flat),
        GroundSpec::Png { file, metres_per_cell, low_m, high_m, no_data } => {
            let (metres_per_cell, low_m, high_m) = (*metres_per_cell, *low_m, *high_m);
            let scale = MapScale { metres_per_cell, low_m, high_m, no_data: *no_data };
            HeightMap::from_png(&files.bytes(file)?, &scale, run).map(Ground::Map)
        }
        GroundSpec::Geotiff { file } => {
            HeightMap::from_geotiff(&files.bytes(file)?, origin, run).map(|(map, _)| Ground::Map(map))
        }
        GroundSpec::Mesh { file } => {
            let (vertices, triangles) = files.mesh(file)?;
            GroundMesh::new(&vertices, &triangles, run).map(Ground::Mesh)
        }
    };
    ground.map_err(|e| SiteError::from(e).into())
}

/// Reads the masks of a stand that grows.
///
/// # Errors
/// [`SiteError`], and those of the files.
pub fn read_masks<F: SiteFiles>(spec: &ForestSpec, files: &F, run: &Run<'_>) -> Result<Vec<Mask>, F::Error> {
    let read = |mask: &forest::MaskSpec| {
        let failed = |error| SiteError::Mask { file: mask.file.clone(), error };
        let read = Mask::from_png(&files.bytes(&mask.file)?, run).map_err(failed)?;
        Ok(if mask.inverted { read.inverted() } else { read })
    };
    spec.masks.iter().map(read).collect()
}
