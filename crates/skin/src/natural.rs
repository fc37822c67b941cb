//! Kinds of bark and of leaf venation.

/// Kind of bark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum BarkKind {
    /// Ridges that part and meet again, broken across, with furrows between: oak, poplar, willow.
    #[default]
    Furrowed,
    /// Closed and grey, with fine cross wrinkles and eyes where branches have been: beech.
    Smooth,
    /// Plates of thin scales with deep cracks between: pine.
    Plated,
    /// White paper with lenticels across, which peels, and black rhombs: birch.
    Birch,
    /// Glossy bands with raised lenticels, which peels across: cherry.
    Cherry,
    /// Rings that fallen leaves have left: palm.
    Ringed,
    /// Smooth and jointed: bamboo.
    Cane,
    /// Ribs with rows of spines, four to a tile: cactus.
    Ribbed,
    /// Young: fine lengthwise wrinkles and small lenticels.
    Twig,
}

impl BarkKind {
    /// Every kind.
    pub const ALL: [Self; 9] = [
        Self::Furrowed,
        Self::Smooth,
        Self::Plated,
        Self::Birch,
        Self::Cherry,
        Self::Ringed,
        Self::Cane,
        Self::Ribbed,
        Self::Twig,
    ];

    /// Returns the height of the relief relative to the width of a tile.
    pub(crate) const fn depth(self) -> f64 {
        match self {
            Self::Furrowed => 0.030,
            Self::Plated => 0.034,
            Self::Birch | Self::Cherry => 0.010,
            Self::Ringed => 0.024,
            Self::Smooth => 0.007,
            Self::Cane => 0.010,
            Self::Ribbed => 0.008,
            Self::Twig => 0.016,
        }
    }
}

/// Course of the veins of a leaf.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum VeinPattern {
    /// A midrib with side veins, which end in the tips of lobes where there are any: oak, beech, lime.
    #[default]
    Pinnate,
    /// One vein for each lobe from the end of the stalk: maple.
    Palmate,
    /// Parallel from root to tip: grasses, palms.
    Parallel,
    /// Leaflets, each with a midrib of its own: ash, rose.
    Compound,
    /// Not visible: needles and scales.
    Needle,
}

impl VeinPattern {
    /// Every kind.
    pub const ALL: [Self; 5] = [Self::Pinnate, Self::Palmate, Self::Parallel, Self::Compound, Self::Needle];
}
