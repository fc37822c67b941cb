//! The chance that a drawing shows no plant: `its numbers, results of the model of kinds and of a glance -> chance`.
//!
//! A logistic regression. The model of kinds learnt from made drawings what is no plant, and its share of no plant
//! says little about drawings by people; but its units and those of the glance, which learnt 320 words of other
//! things, separate the two. The coefficients are data (`data/no_plants.csv`), learnt by `cargo xtask
//! train-no-plants`; `docs/strokes.md` describes how, and how good it is.

use std::sync::OnceLock;

use base::ops;

use crate::glance::{self, Glance};
use crate::kinds;

/// Limits by which a drawing counts as showing no plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoPlantLimits {
    /// A drawing shows no plant if the chance of that is larger: 2 % of plants by people are above
    /// (`docs/strokes.md`).
    pub chance_most: f64,
    /// A drawing shows no plant if the model of kinds alone gives a larger share to that: none of 1,623 plants by
    /// people is above.
    pub share_most: f64,
    /// Greatest distance from its mean, in spreads, at which a number counts, so that no single one decides.
    pub spreads_most: f64,
}

/// The limits for all drawings.
pub const NO_PLANT_LIMITS: NoPlantLimits =
    NoPlantLimits { chance_most: 0.886, share_most: 0.98, spreads_most: 4.0 };

/// Names of the numbers of [`row`] that neither the model of kinds nor the glance has.
const OWN: [&str; 2] = ["strokes", "sureness"];

/// Returns the names of the numbers, in their order.
pub fn no_plant_feature_names() -> Vec<String> {
    let own = OWN.iter().map(|n| (*n).to_owned());
    kinds::mark_names().into_iter().chain(glance::mark_names()).chain(own).collect()
}

/// Returns the numbers of a drawing: results of the model of kinds for its row and of the glance, the number of its
/// strokes, and how sure the classifier is of them.
pub(crate) fn row(kinds_row: &[f64], glance: &Glance, strokes: usize, sureness: f64) -> Vec<f64> {
    let own = [ops::ln(strokes.max(1) as f64), sureness];
    kinds::marks(kinds_row).into_iter().chain(glance.marks()).chain(own).collect()
}

/// Returns the chance that a drawing with such a [`row`] shows no plant: 0 to 1, and 0 if nothing was learnt.
pub(crate) fn chance(row: &[f64]) -> f64 {
    trained().map_or(0.0, |model| model.chance(row))
}

/// A number of the regression: its mean, its spread, its coefficient per spread.
struct Term {
    mean: f64,
    spread: f64,
    coefficient: f64,
}

struct Model {
    constant: f64,
    terms: Vec<Term>,
}

/// Name of the constant term.
const CONSTANT: &str = "one";

impl Model {
    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines().filter(|l| !l.starts_with('#')).skip(1);
        let mut term = |name: &str| {
            let mut cells = lines.next()?.split(',');
            if cells.next()? != name {
                return None;
            }
            let mut number = || cells.next()?.parse().ok().filter(|x: &f64| x.is_finite());
            let term = Term { mean: number()?, spread: number()?, coefficient: number()? };
            (term.spread > 0.0).then_some(term)
        };
        let constant = term(CONSTANT)?.coefficient;
        let terms: Option<Vec<Term>> = no_plant_feature_names().iter().map(|n| term(n)).collect();
        Some(Self { constant, terms: terms? })
    }

    fn chance(&self, row: &[f64]) -> f64 {
        let most = NO_PLANT_LIMITS.spreads_most;
        let term = |(t, x): (&Term, &f64)| t.coefficient * ((x - t.mean) / t.spread).clamp(-most, most);
        let sum = self.constant + self.terms.iter().zip(row).map(term).sum::<f64>();
        1.0 / (1.0 + ops::exp(-sum))
    }
}

fn trained() -> Option<&'static Model> {
    static MODEL: OnceLock<Option<Model>> = OnceLock::new();
    MODEL.get_or_init(|| Model::parse(include_str!("../data/no_plants.csv"))).as_ref()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_model_belongs_to_the_numbers() {
        let model =
            trained().expect("data/no_plants.csv is of other numbers: run `cargo xtask train-no-plants`");
        assert_eq!(model.terms.len(), no_plant_feature_names().len());
        let kinds_row = vec![0.0; crate::kind_feature_names().len()];
        let row = row(&kinds_row, &Glance::default(), 0, 0.0);
        assert_eq!(row.len(), model.terms.len(), "one number for each name");
        assert!((0.0..=1.0).contains(&chance(&row)));
    }

    #[test]
    fn a_chance_is_the_logistic_function_of_a_sum_in_which_no_number_counts_more_than_its_limit() {
        let term = |mean, spread, coefficient| Term { mean, spread, coefficient };
        let model = Model { constant: 0.5, terms: vec![term(1.0, 2.0, 0.25), term(0.0, 1.0, -1.0)] };
        let logistic = |x: f64| 1.0 / (1.0 + ops::exp(-x));
        assert!((model.chance(&[3.0, 0.5]) - logistic(0.5 + 0.25 - 0.5)).abs() < 1e-12);
        let far = logistic(0.5 + 0.25 * NO_PLANT_LIMITS.spreads_most);
        assert!((model.chance(&[1e9, 0.0]) - far).abs() < 1e-12);
    }

    #[test]
    fn a_file_of_other_numbers_is_refused() {
        let text = include_str!("../data/no_plants.csv");
        assert!(Model::parse(text).is_some());
        assert!(Model::parse(&text.replacen("sureness", "surety", 1)).is_none());
        assert!(Model::parse("name,mean,spread,coefficient\none,0,1,nan\n").is_none());
    }
}
