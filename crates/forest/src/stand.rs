//! The trees of a forest, one row each.

use glam::DVec3;

/// Measures of a tree whose origin is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// [`Tree::height_m`]
    Height,
    /// [`Tree::dbh_m`]
    Dbh,
    /// [`Tree::crown_width_m`]
    CrownWidth,
    /// [`Tree::age_years`]
    Age,
}

/// Set of the figures of a tree that its inventory gave; the others follow from the allometry of its species.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Given(u8);

impl Given {
    /// Returns the set with `figure` marked as given.
    #[must_use]
    pub fn with(self, figure: Figure) -> Self {
        Self(self.0 | (1 << figure as u8))
    }

    /// Returns whether `figure` was given.
    pub fn has(self, figure: Figure) -> bool {
        self.0 & (1 << figure as u8) != 0
    }
}

/// One tree of a stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tree {
    /// Foot of the trunk in metres, +Y up, relative to [`Stand::origin_m`].
    pub foot_m: DVec3,
    /// Row of [`Stand::species`].
    pub species: u16,
    /// Row of the inventory, from 1 without its header; for a planted tree its number, from 1. Unique within a stand.
    pub row: u32,
    /// Years since germination, 0 and more.
    pub age_years: f64,
    /// Height from the foot to the top of the crown, metres, above 0.
    pub height_m: f64,
    /// Diameter of the stem 1.3 m above the foot, in metres; 0 for trees below 1.3 m.
    pub dbh_m: f64,
    /// Mean diameter of the crown in metres, above 0.
    pub crown_width_m: f64,
    /// Rotation about the vertical in radians, 0 to 2 pi.
    pub yaw: f64,
    /// Direction of the trunk's axis at its foot: a unit vector, +Y if the tree is upright.
    pub up: DVec3,
    /// Horizontal offset of the centre of the crown from the foot in metres: crowns grow away from their neighbours.
    pub crown_offset_m: DVec3,
    /// Figures that were given.
    pub given: Given,
}

/// The trees of a forest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stand {
    /// Names of presets, or paths of specs, in order of first use.
    pub species: Vec<String>,
    /// The trees in order of their rows.
    pub trees: Vec<Tree>,
    /// Place of the origin in the coordinates of the inventory: easting, height, northing in metres.
    pub origin_m: DVec3,
}

/// A row of a stand that breaks an invariant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandFault {
    /// Index into [`Stand::trees`].
    pub tree: usize,
    /// The field at fault.
    pub field: &'static str,
}

impl Stand {
    /// Returns the faults of all trees: numbers that are not finite or out of range, species without a row, rows that
    /// do not ascend.
    pub fn validate(&self) -> impl Iterator<Item = StandFault> + '_ {
        self.trees.iter().enumerate().flat_map(|(tree, t)| {
            let follows = tree == 0 || self.trees[tree - 1].row < t.row;
            let checks = [
                ("foot_m", t.foot_m.is_finite()),
                ("species", usize::from(t.species) < self.species.len()),
                ("row", t.row > 0 && follows),
                ("age_years", t.age_years.is_finite() && t.age_years >= 0.0),
                ("height_m", t.height_m.is_finite() && t.height_m > 0.0),
                ("dbh_m", t.dbh_m.is_finite() && t.dbh_m >= 0.0),
                ("crown_width_m", t.crown_width_m.is_finite() && t.crown_width_m > 0.0),
                ("yaw", t.yaw.is_finite()),
                ("up", (t.up.length() - 1.0).abs() < 1e-9),
                ("crown_offset_m", t.crown_offset_m.is_finite()),
            ];
            checks
                .into_iter()
                .filter(|(_, is_sound)| !is_sound)
                .map(move |(field, _)| StandFault { tree, field })
        })
    }
}
