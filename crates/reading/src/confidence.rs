//! How likely a reading is right: `evidence -> the chance that a person would name the same kind`.
//!
//! The share that the model of kinds gives to a kind is no such chance: the model saw most of its drawings again and
//! again, and is as sure of drawings in a style that it never saw, of which half are read wrongly. So a logistic
//! regression over the evidence for a reading is fitted to drawings by people from which the model learnt nothing.
//! Its coefficients are data (`data/confidence.csv`), fitted by `cargo xtask train-confidence`.

use std::sync::OnceLock;

use base::ops;

/// Limits on how far the evidence for a reading is trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConfidenceLimits {
    /// Greatest distance from 0 at which the log odds of a share among kinds count.
    pub share_log_odds_most: f64,
    /// The least share of no plant that counts.
    pub no_plant_least: f64,
    /// Least confidence in a reading by structure. The models of kinds learnt from doodles and know nothing of it:
    /// about this share of readings of fewer strokes than [`many_strokes`](Self::many_strokes) is right.
    pub by_structure_least: f64,
    /// Least confidence in a reading by structure of as many strokes or more.
    pub by_structure_of_many: f64,
    /// Least confidence in a reading by the arrangement of faces and lines, which the model of kinds does not see: of
    /// 60 such readings of drawings by people, whose kind is known, 48 are right (`cargo xtask train-confidence`, and
    /// `--end`).
    pub by_arrangement_least: f64,
    /// Greatest confidence in a tangle of bare lines ([`crate::tangled_length`]): of 49 in line art by people one is
    /// right.
    pub tangle_most: f64,
    /// Confidence in a reading by masses: of ten in line art by people six are acceptable, and none is complete.
    pub by_masses: f64,
    /// Least confidence in a reading by the colours of a painted picture.
    pub by_colours_least: f64,
    /// Confidence in a drawing of so many strokes that the model compares no kinds: both such drawings among the line
    /// art by people are read wrongly.
    pub not_weighed: f64,
    /// A reading of many strokes that explains less of them than this (0 to 1) is a guess.
    pub explained_least: f64,
    /// Greatest confidence in such a guess: of 8 in line art by people none is right.
    pub guess_most: f64,
    /// Number of strokes from which a drawing counts as a botanical illustration; a doodle has fewer.
    pub many_strokes: usize,
}

/// The limits for all drawings.
pub const CONFIDENCE_LIMITS: ConfidenceLimits = ConfidenceLimits {
    share_log_odds_most: 12.0,
    no_plant_least: 1e-6,
    by_structure_least: 0.35,
    by_structure_of_many: 0.65,
    by_arrangement_least: 0.8,
    tangle_most: 0.05,
    by_masses: 0.25,
    by_colours_least: 0.6,
    not_weighed: 0.35,
    explained_least: 0.8,
    guess_most: 0.35,
    many_strokes: 15,
};

/// Evidence for and against the reading of one plant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Evidence {
    /// Share of its kind among all, judged by the whole drawing; the kind that the strokes alone gave has a higher
    /// weight.
    pub share: f64,
    /// How undecided a glance is between words: the entropy of their shares, natural units.
    pub undecided: f64,
    /// The share of no plant, by the model of kinds.
    pub no_plant: f64,
    /// Number of strokes.
    pub strokes: usize,
    /// Whether its classes follow from the structure of the drawing.
    pub by_structure: bool,
    /// Whether its parts were cut by a reader of arrangements.
    pub by_arrangement: bool,
    /// Whether most of its axes lead to nothing.
    pub is_tangle: bool,
    /// Whether it was read by its masses, since its lines are a tangle.
    pub by_masses: bool,
    /// Whether it was read by the colours of a painted picture.
    pub by_colours: bool,
    /// Whether it is a tree, palm or bush: the model has seen all forms of these kinds, so its share counts whatever
    /// the structure says.
    pub is_wood: bool,
    /// How much of a drawing of many strokes the reading explains: 0 to 1.
    pub explained: f64,
}

/// Names of the numbers of [`Evidence::row`], in their order.
pub const EVIDENCE_NAMES: [&str; 4] = ["one", "share", "undecided", "no-plant"];

impl Evidence {
    /// Returns the weighted numbers: 1, the log odds of the share, how undecided a glance is, and the logarithm of
    /// the share of no plant.
    pub fn row(&self) -> [f64; EVIDENCE_NAMES.len()] {
        let limits = CONFIDENCE_LIMITS;
        let share = log_odds(self.share, limits.share_log_odds_most);
        [1.0, share, self.undecided, ops::ln(self.no_plant.max(limits.no_plant_least))]
    }

    /// Returns the chance that the kind is right: 0 to 1. The share itself if nothing was fitted.
    pub(crate) fn confidence(&self) -> f64 {
        let Some(coefficients) = fitted() else { return self.share };
        let sum: f64 = self.row().iter().zip(coefficients).map(|(x, c)| x * c).sum();
        let chance = 1.0 / (1.0 + ops::exp(-sum));
        let limits = CONFIDENCE_LIMITS;
        if self.is_tangle {
            return chance.min(limits.tangle_most);
        }
        if self.by_masses {
            return limits.by_masses;
        }
        let is_many = self.strokes >= limits.many_strokes;
        if is_many && self.explained < limits.explained_least {
            return chance.min(limits.guess_most);
        }
        if self.by_colours {
            return chance.max(limits.by_colours_least);
        }
        if self.by_arrangement {
            return chance.max(limits.by_arrangement_least);
        }
        if !self.by_structure || self.is_wood {
            return chance;
        }
        chance.max(if is_many { limits.by_structure_of_many } else { limits.by_structure_least })
    }
}

fn log_odds(share: f64, most: f64) -> f64 {
    if share <= 0.0 {
        return -most;
    }
    ops::ln(share / (1.0 - share).max(f64::MIN_POSITIVE)).clamp(-most, most)
}

type Coefficients = [f64; EVIDENCE_NAMES.len()];

fn parse(text: &str) -> Option<Coefficients> {
    let mut lines = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    let mut found = [0.0; EVIDENCE_NAMES.len()];
    for (to, name) in found.iter_mut().zip(EVIDENCE_NAMES) {
        let (own, number) = lines.next()?.split_once(',')?;
        *to = number.parse().ok().filter(|x: &f64| own == name && x.is_finite())?;
    }
    Some(found)
}

fn fitted() -> Option<&'static Coefficients> {
    static FITTED: OnceLock<Option<Coefficients>> = OnceLock::new();
    FITTED.get_or_init(|| parse(include_str!("../data/confidence.csv"))).as_ref()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_speaks_for_a_reading_raises_its_confidence_and_nothing_makes_it_infinite() {
        assert!(fitted().is_some(), "data/confidence.csv: run `cargo xtask train-confidence`");
        let own = Evidence {
            share: 0.7,
            undecided: 1.0,
            no_plant: 0.2,
            strokes: 4,
            by_structure: false,
            by_arrangement: false,
            is_tangle: false,
            by_masses: false,
            by_colours: false,
            is_wood: false,
            explained: 1.0,
        };
        let now = own.confidence();
        assert!(now > 0.0 && now < 1.0);
        assert!(Evidence { share: 0.9, ..own }.confidence() > now);
        assert!(Evidence { undecided: 2.0, ..own }.confidence() < now);
        assert!(Evidence { no_plant: 0.9, ..own }.confidence() < now);
        for share in [0.0, 1.0, f64::MIN_POSITIVE] {
            let far = Evidence { share, no_plant: share, ..own }.confidence();
            assert!(far > 0.0 && far < 1.0, "{far}");
        }
    }

    #[test]
    fn a_reading_by_structure_is_not_told_by_kinds_that_know_nothing_of_it() {
        let own = Evidence {
            share: 0.01,
            undecided: 2.0,
            no_plant: 0.4,
            strokes: 40,
            by_structure: true,
            by_arrangement: false,
            is_tangle: false,
            by_masses: false,
            by_colours: false,
            is_wood: false,
            explained: 1.0,
        };
        assert!(own.confidence() >= CONFIDENCE_LIMITS.by_structure_of_many);
        assert!(Evidence { by_structure: false, ..own }.confidence() < own.confidence());
        let tangle = Evidence { is_tangle: true, ..own }.confidence();
        assert!(tangle <= CONFIDENCE_LIMITS.tangle_most);
        // The model knows trees, and a reading that leaves out most of the ink is a guess.
        assert!(Evidence { is_wood: true, ..own }.confidence() < own.confidence());
        let guess = Evidence { share: 1.0, by_structure: false, explained: 0.5, ..own };
        assert!(guess.confidence() <= CONFIDENCE_LIMITS.guess_most);
        assert!(Evidence { explained: 1.0, ..guess }.confidence() > CONFIDENCE_LIMITS.guess_most);
    }
}
