//! `Stand -> CSV`: one row a tree, which [`read_inventory`](crate::read_inventory) reads again.

use std::io;

use base::ops;

use crate::{Figure, Stand};

/// Names of the columns, in order.
const COLUMNS: [&str; 16] = [
    "row",
    "species",
    "x",
    "y",
    "elevation",
    "height_m",
    "dbh_m",
    "crown_width_m",
    "age_years",
    "yaw_deg",
    "up_x",
    "up_y",
    "up_z",
    "crown_offset_x_m",
    "crown_offset_z_m",
    "given",
];

/// Writes all trees as CSV.
///
/// | column | meaning |
/// |---|---|
/// | `row` | row of the inventory, or number of the tree |
/// | `species` | word of the preset |
/// | `x`, `y`, `elevation` | easting, northing and height of the foot in metres, [`Stand::origin_m`] added |
/// | `height_m`, `dbh_m`, `crown_width_m` | metres; `dbh_m` is empty for trees below 1.3 m |
/// | `age_years` | years since germination |
/// | `yaw_deg` | turn about the trunk, from +X towards -Z |
/// | `up_x`, `up_y`, `up_z` | axis of the trunk; +X east, +Y up, +Z south |
/// | `crown_offset_x_m`, `crown_offset_z_m` | from the foot to the middle of the crown |
/// | `given` | letters of the figures that the inventory gave: `h`eight, `d`bh, `c`rown, `a`ge |
///
/// Numbers are as short as possible and read back to the same bits. Cost: linear, a row at a time.
///
/// # Errors
/// The errors of the writer.
pub fn write_stand_csv(stand: &Stand, out: impl io::Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(COLUMNS)?;
    for tree in &stand.trees {
        let species = stand.species.get(usize::from(tree.species)).map_or("", String::as_str);
        let place = stand.origin_m + glam::DVec3::new(tree.foot_m.x, tree.foot_m.y, -tree.foot_m.z);
        let letters =
            [(Figure::Height, 'h'), (Figure::Dbh, 'd'), (Figure::CrownWidth, 'c'), (Figure::Age, 'a')];
        let given: String = letters.iter().filter(|(f, _)| tree.given.has(*f)).map(|(_, c)| *c).collect();
        let dbh = if tree.dbh_m > 0.0 { tree.dbh_m.to_string() } else { String::new() };
        writer.write_record(&[
            tree.row.to_string(),
            species.to_owned(),
            place.x.to_string(),
            place.z.to_string(),
            place.y.to_string(),
            tree.height_m.to_string(),
            dbh,
            tree.crown_width_m.to_string(),
            tree.age_years.to_string(),
            (tree.yaw * (180.0 / ops::PI)).to_string(),
            tree.up.x.to_string(),
            tree.up.y.to_string(),
            tree.up.z.to_string(),
            tree.crown_offset_m.x.to_string(),
            tree.crown_offset_m.z.to_string(),
            given,
        ])?;
    }
    writer.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Crs, ForestSpec, Ground, InventorySpec, SpeciesSpec, grow_stand, read_inventory};
    use base::{Run, Seed};

    #[test]
    fn what_is_written_is_read_again() {
        let species = ["oak", "hazel"].map(|n| SpeciesSpec { name: n.into(), ..SpeciesSpec::default() });
        let spec = ForestSpec { species: species.into(), years: 20, ..ForestSpec::default() };
        let stand = grow_stand(&spec, &Ground::Flat, Seed::new(5), &Run::plain()).expect("grows");
        let mut bytes = Vec::new();
        write_stand_csv(&stand, &mut bytes).expect("a vector takes all");
        let inventory = InventorySpec { crs: Some(Crs::Metres), ..InventorySpec::default() };
        let (again, report) = read_inventory(&bytes, &inventory, &Run::plain()).expect("is an inventory");
        assert_eq!((again.trees.len(), report.skipped, report.touching), (stand.trees.len(), 0, 0));
        for (a, b) in again.trees.iter().zip(&stand.trees) {
            assert_eq!((a.foot_m, a.height_m, a.dbh_m), (b.foot_m, b.height_m, b.dbh_m));
            assert_eq!((a.crown_width_m, a.age_years), (b.crown_width_m, b.age_years));
            assert_eq!(again.species[usize::from(a.species)], stand.species[usize::from(b.species)]);
        }
    }
}
