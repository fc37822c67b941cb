//! An inventory, and the specs of its species.

use burgeon::forest::{Figure, Given, Stand, Tree};
use burgeon::glam::DVec3;
use burgeon::growth::TreeSpec;
use burgeon::{Preset, Report};

use crate::args::ForestArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::{files, grow, inputs};

/// The trees.
pub(super) fn read(args: &ForestArgs, _machine: &Machine, _told: &mut Report) -> Outcome<Stand> {
    let text = files::read_text(&args.input)?;
    let mut stand = Stand::default();
    for (row, line) in (1_u32..).zip(text.lines().skip(1)) {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let number = |k: usize| fields.get(k).and_then(|f| f.parse::<f64>().ok()).unwrap_or(0.0);
        let name = fields.first().copied().unwrap_or("oak");
        let species = stand.species.iter().position(|s| s == name).unwrap_or_else(|| {
            stand.species.push(name.to_owned());
            stand.species.len() - 1
        });
        stand.trees.push(Tree {
            foot_m: DVec3::new(number(1), 0.0, -number(2)),
            species: u16::try_from(species).unwrap_or(0),
            row,
            age_years: 50.0,
            height_m: number(3),
            dbh_m: number(4),
            crown_width_m: number(5),
            yaw: f64::from(row % 63) * 0.1,
            up: DVec3::Y,
            crown_offset_m: DVec3::ZERO,
            given: Given::default().with(Figure::Height),
        });
    }
    Ok(stand)
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
