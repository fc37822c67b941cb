//! Labels of points, pixels and triangles: the parts that they lie on, as words, and their rows.

use plant::{AxisKind, OrganKind};

/// Parts that a point can lie on, by the row that is its label.
pub const PARTS: [&str; 21] = [
    "branch", "twig", "stem", "petiole", "root", "leaf", "petal", "disc", "fruit", "stamen", "pistil",
    "thorn", "pedicel", "sepal", "anther", "floret", "body", "pot", "stub", "soil", "stone",
];

/// Row of soil in [`PARTS`].
pub const PART_OF_SOIL: u8 = 19;

/// Row of stones in [`PARTS`].
pub const PART_OF_STONE: u8 = 20;

/// Returns the row of an axis in [`PARTS`].
pub const fn part_of_axis(kind: AxisKind) -> u8 {
    match kind {
        AxisKind::Branch => 0,
        AxisKind::Twig => 1,
        AxisKind::Stem => 2,
        AxisKind::Petiole => 3,
        AxisKind::Stub => 18,
        _ => 4,
    }
}

/// Whether a row of [`PARTS`] is an axis, not an organ.
pub(crate) const fn part_is_of_axis(part: u8) -> bool {
    part < 5 || part == part_of_axis(AxisKind::Stub)
}

/// Returns the row of an organ in [`PARTS`].
pub const fn part_of_organ(kind: OrganKind) -> u8 {
    match kind {
        OrganKind::Leaf => 5,
        OrganKind::Petal => 6,
        OrganKind::Disc => 7,
        OrganKind::Fruit | OrganKind::Syncarp => 8,
        OrganKind::Stamen => 9,
        OrganKind::Pistil => 10,
        OrganKind::Thorn => 11,
        OrganKind::Pedicel => 12,
        OrganKind::Sepal => 13,
        OrganKind::Anther => 14,
        OrganKind::Floret => 15,
        OrganKind::Pot => 17,
        _ => 16,
    }
}

/// Row that means no axis or no organ.
pub const NOTHING: i32 = -1;
