//! Errors of finding a tree in a cloud.

use base::Cancelled;

/// Reason why no tree was found in a cloud.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScanTreeError {
    /// The cloud has too few points.
    #[error("the cloud has {0} usable points; a tree needs at least {1}: scan it more densely")]
    TooFew(usize, usize),
    /// The cloud is larger than any tree.
    #[error("the cloud is {0:.0} m high: no tree is. Say its unit (mm or cm), or cut the tree out of it")]
    TooLarge(f64),
    /// The cloud is smaller than any tree.
    #[error("the cloud is {} high: no tree is. Say its unit (m or cm)", small(*.0))]
    TooSmall(f64),
    /// The cloud was scanned from the air: it has crowns, and no stems.
    #[error(
        "the cloud looks as if it was scanned from the air: {0:.1} points above each square metre over {1:.0} m, and none \
         of them show a stem. Trees are found in scans from the ground alone"
    )]
    Airborne(f64, f64),
    /// Nothing on the ground rises like a stem.
    #[error(
        "nothing in the cloud stands on the ground and goes up as a stem does; check which axis points up and \
         the unit, or say where the stem stands"
    )]
    NoStem,
    /// No stem stands at the place that the user gave.
    #[error(
        "no stem stands within {:.1} m of {}; the nearest thing that stands on the ground is at {}",
        .1,
        pair(.0),
        pair(.2)
    )]
    NotThere([f64; 2], f64, [f64; 2]),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn small(height_m: f64) -> String {
    format!("{:.1} mm", 1e3 * height_m)
}

/// Formats a place on the ground, to a centimetre.
fn pair([x, y]: &[f64; 2]) -> String {
    format!("{x:.2},{y:.2}")
}

base::coded!(ScanTreeError {
    Self::TooFew(is, wanted) => "scan-tree-few" { is, wanted },
    Self::TooLarge(height_m) => "scan-tree-large" { height_m },
    Self::TooSmall(height_m) => "scan-tree-small" { height_m },
    Self::Airborne(density, wide_m) => "scan-tree-airborne" { density, wide_m },
    Self::NoStem => "scan-tree-no-stem" {},
    Self::NotThere(at, within_m, nearest) => "scan-tree-not-there" {
        x = at[0], z = at[1], within_m, near_x = nearest[0], near_z = nearest[1]
    },
} wraps {
    Self::Cancelled(e) => e, Cancelled;
});
