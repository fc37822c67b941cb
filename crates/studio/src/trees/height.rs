//! A tree of a given height: the age at which its species has it.

use base::{Report, Run, Seed};
use growth::TreeSpec;

use super::{TreeError, tree_blade, tree_size};

/// A tree is scaled by at most this share of its height: between two years of a life, and to what a taller or shorter one of
/// its species may have.
const SCALED: f64 = 0.2;

/// Why a tree cannot have a height.
#[derive(Debug, thiserror::Error)]
pub enum HeightError {
    /// Its species does not reach it, or is taller as a seedling.
    #[error("a height of {wanted_m} m is out of reach: this species is {least_m:.2} to {most_m:.1} m high")]
    Reach {
        /// What was asked for.
        wanted_m: f64,
        /// The least, metres.
        least_m: f64,
        /// The most, metres.
        most_m: f64,
    },
    /// It cannot be grown.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

/// The age in years at which a tree is nearest to a height; none for one without a life
/// ([`TreeSpec::years`]), which is full-grown. With [`super::TreeOptions::height_m`] it then has that height.
///
/// Guaranteed: the height is within a fifth of that of the tree at that age. Cost: at most nine growths without meshes.
///
/// # Errors
/// [`HeightError`].
pub fn age_of_height(
    spec: &TreeSpec,
    seed: Seed,
    height_m: f64,
    run: &Run<'_>,
) -> Result<Option<u32>, HeightError> {
    let at = |age: Option<u32>| -> Result<f64, TreeError> {
        let aged = TreeSpec { age, ..spec.clone() };
        aged.check(&run.budget)?;
        let blade = tree_blade(&aged.blade);
        let grown = growth::grow(&aged, Some(blade), seed, run, &mut Report::default())?;
        Ok(tree_size(&grown).height_m)
    };
    let full = at(None)?;
    let (low, most_m) = (if spec.years.is_some() { at(Some(1))? } else { full }, full * (1.0 + SCALED));
    let least_m = low * (1.0 - SCALED);
    if !(least_m..=most_m).contains(&height_m) {
        return Err(HeightError::Reach { wanted_m: height_m, least_m, most_m });
    }
    let Some(years) = spec.years.filter(|_| height_m < full) else { return Ok(None) };
    // Trees grow: the height between two ages lies between theirs.
    let (mut young, mut old) = ((1, low), (years, full));
    while old.0 - young.0 > 1 {
        let middle = young.0 + (old.0 - young.0) / 2;
        let height = at(Some(middle))?;
        if height < height_m { young = (middle, height) } else { old = (middle, height) }
    }
    let nearer = if height_m - young.1 < old.1 - height_m { young } else { old };
    Ok(Some(nearer.0))
}
