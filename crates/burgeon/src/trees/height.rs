//! A tree of a given height or girth: the age at which its species has it.

use base::{Report, Run, Seed};
use growth::{Grown, TreeSpec};

use super::{TreeError, tree_blade, tree_size};

/// Largest share of its height by which a tree is scaled: between two years of a life, and to the variation of its
/// species.
const SCALED: f64 = 0.2;

/// Reason why a tree cannot have a height.
#[derive(Debug, thiserror::Error)]
pub enum HeightError {
    /// Its species does not reach it, or is taller as a seedling.
    #[error("a height of {wanted_m} m is out of reach: this species is {least_m:.2} to {most_m:.1} m high")]
    Reach {
        /// The requested height, metres.
        wanted_m: f64,
        /// The least, metres.
        least_m: f64,
        /// The most, metres.
        most_m: f64,
    },
    /// Its species never has a stem as thick, or none as thin that is taller than a breast.
    #[error(
        "a diameter of {wanted_m} m at breast height is out of reach: stems of this species have {least_m:.3} to {most_m:.3} m"
    )]
    Girth {
        /// The requested diameter, metres.
        wanted_m: f64,
        /// The least, metres.
        least_m: f64,
        /// The most, metres.
        most_m: f64,
    },
    /// It never reaches breast height.
    #[error(
        "a plant of this species stays below breast height (1.3 m), where a diameter is measured: give its height"
    )]
    Low,
    /// It grows around obstacles, which it would meet when it is scaled.
    #[error(
        "a tree with obstacles has no height or diameter to grow to, as it would meet them: give its age"
    )]
    Obstacles,
    /// It cannot be grown.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

base::coded!(HeightError {
    Self::Reach { wanted_m, least_m, most_m } => "height-reach" {
        wanted = wanted_m, least = format!("{least_m:.2}"), most = format!("{most_m:.1}")
    },
    Self::Girth { wanted_m, least_m, most_m } => "girth-reach" {
        wanted = wanted_m, least = format!("{least_m:.3}"), most = format!("{most_m:.3}")
    },
    Self::Low => "height-low" {},
    Self::Obstacles => "height-obstacles" {},
} wraps {
    Self::Tree(e) => e, TreeError;
});

/// Grows a tree at an age, without meshes.
fn grown_at(spec: &TreeSpec, seed: Seed, age: Option<u32>, run: &Run<'_>) -> Result<Grown, TreeError> {
    let aged = TreeSpec { age, ..spec.clone() };
    aged.check(&run.budget)?;
    let blade = tree_blade(&aged.blade);
    Ok(growth::grow(&aged, Some(blade), seed, run, &mut Report::default())?)
}

/// Size that a tree shall have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TreeGoal {
    /// A height, metres.
    Height(f64),
    /// A diameter at breast height (1.3 m), metres.
    Dbh(f64),
}

impl TreeGoal {
    /// Range of heights in requests, metres.
    pub const HEIGHTS_M: (f64, f64) = (0.01, 1000.0);
    /// Range of diameters in requests, metres.
    pub const DIAMETERS_M: (f64, f64) = (0.001, 30.0);

    /// Returns the word of its option.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Height(_) => "height",
            Self::Dbh(_) => "dbh",
        }
    }
}

/// Sets the age at which a tree is nearest to a size; returns the height to which it is then scaled
/// ([`super::TreeOptions::height_m`]).
///
/// # Errors
/// [`HeightError`].
pub fn aim_at(spec: &mut TreeSpec, seed: Seed, goal: TreeGoal, run: &Run<'_>) -> Result<f64, HeightError> {
    if !spec.obstacles.is_empty() {
        return Err(HeightError::Obstacles);
    }
    let (age, height_m) = match goal {
        TreeGoal::Height(height_m) => (age_of_height(spec, seed, height_m, run)?, height_m),
        TreeGoal::Dbh(dbh_m) => {
            let found = tree_of_dbh(spec, seed, dbh_m, run)?;
            (found.age, found.height_m)
        }
    };
    spec.age = age;
    Ok(height_m)
}

/// A tree that has a diameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeOfDbh {
    /// Its age in years; `None`: full-grown.
    pub age: Option<u32>,
    /// The height to which it is scaled ([`super::TreeOptions::height_m`]), metres.
    pub height_m: f64,
}

/// Returns the age at which a tree is nearest to a diameter at breast height (1.3 m), and the height to which it is
/// scaled so that it has it.
///
/// Guaranteed: it is scaled by a fifth at most, height and girth alike. Not guaranteed: the diameter to the last per
/// cent, as breast height is elsewhere on a scaled stem. Cost: at most ten growths without meshes.
///
/// # Errors
/// [`HeightError`].
pub fn tree_of_dbh(spec: &TreeSpec, seed: Seed, dbh_m: f64, run: &Run<'_>) -> Result<TreeOfDbh, HeightError> {
    let at = |age: Option<u32>| -> Result<(f64, f64), TreeError> {
        let grown = grown_at(spec, seed, age, run)?;
        Ok((grown.plant.measure().dbh_m.unwrap_or(0.0), tree_size(&grown).height_m))
    };
    let full = at(None)?;
    if full.0 <= 0.0 {
        return Err(HeightError::Low);
    }
    let mut old = (spec.years.unwrap_or(0), full);
    let mut young = (1, if spec.years.is_some() { at(Some(1))? } else { full });
    if spec.years.is_some() && dbh_m < full.0 {
        while old.0 - young.0 > 1 {
            let middle = young.0 + (old.0 - young.0) / 2;
            let size = at(Some(middle))?;
            if size.0 < dbh_m { young = (middle, size) } else { old = (middle, size) }
        }
    } else {
        young = old;
    }
    // A tree below breast height has no diameter.
    let is_young = young.1.0 > 0.0 && dbh_m - young.1.0 < old.1.0 - dbh_m;
    let (age, (has_m, height_m)) = if is_young { young } else { old };
    let factor = dbh_m / has_m;
    if !(1.0 - SCALED..=1.0 + SCALED).contains(&factor) {
        let (least_m, most_m) = (old.1.0.min(full.0) * (1.0 - SCALED), full.0 * (1.0 + SCALED));
        return Err(HeightError::Girth { wanted_m: dbh_m, least_m, most_m });
    }
    let is_full = spec.years.is_none_or(|years| age == years);
    Ok(TreeOfDbh { age: (!is_full).then_some(age), height_m: height_m * factor })
}

/// Returns the age in years at which a tree is nearest to a height; `None` for one without a life
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
        Ok(tree_size(&grown_at(spec, seed, age, run)?).height_m)
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
