//! Burgeon for Python: parses, converts, calls. No algorithms.
//!
//! | module | owns |
//! |---|---|
//! | `make` | request -> a document of one plant -> the plant; growth laws |
//! | `again` | a plant with other settings |
//! | `scan` | trees of laser scans |
//! | `days` | plants of scans on several days |
//! | `write` | a plant's files with coarser copies, instances, joints |
//! | `held` | results, as long as anything uses them |
//! | `plant`, `model` | results: tables, meshes, clouds, files, pictures |
//! | `grove` | plants that stand together |
//! | `light` | light that plants absorb |
//! | `stand` | stands of many trees, and their tiles |
//! | `column` | memory of ours for `NumPy` without a copy |
//! | `value` | Python values -> JSON |
//! | `compute` | threads, Ctrl-C, limits |
//! | `fault` | errors with codes -> exceptions |
//!
//! The package `burgeon` (apps/python/burgeon) is what people import; this is its private module.

mod again;
mod asked;
mod column;
mod compute;
mod days;
mod fault;
mod grove;
mod held;
mod light;
mod make;
mod model;
mod plant;
mod scan;
mod stand;
mod value;
mod write;

/// The private module of the package `burgeon`.
#[pyo3::pymodule]
mod _burgeon {
    #[pymodule_export]
    use crate::column::Column;
    #[pymodule_export]
    use crate::compute::set_threads;
    #[pymodule_export]
    use crate::days::RawDays;
    #[pymodule_export]
    use crate::fault::{foreign, meant};
    #[pymodule_export]
    use crate::grove::{RawGrove, places};
    #[pymodule_export]
    use crate::make::{
        RawLaw, bloom, grow, is_rays, leaf, leaf_of_scan, leaf_of_veins, open_project, presets, schema,
        sketch,
    };
    #[pymodule_export]
    use crate::model::{RawModel, drawing_svg, formats, png};
    #[pymodule_export]
    use crate::plant::RawPlant;
    #[pymodule_export]
    use crate::scan::tree_of_scan;
    #[pymodule_export]
    use crate::stand::{RawStand, RawTiles, grow_stand, read_stand};

    #[pymodule_export]
    const VERSION: &str = burgeon::VERSION;

    /// Words for the parts of plants and grounds, by their label numbers.
    #[pymodule_export]
    const PARTS: [&str; 21] = burgeon::PARTS;
}
