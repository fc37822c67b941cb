//! Traits by order -> rules that draw each of them from what was measured.

use core::fmt::Write as _;

use super::quantile_of;
use super::traits::{OrderTraits, Trait, Traits};
use crate::{Method, TreeSpec, VariationSpec, WoodSpec};

/// What bounds a fitted species.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpeciesLimits {
    /// Orders from the trunk on, 1 to 6: each needs letters of its own.
    pub orders: usize,
    /// Axes of an order, at least: fewer tell no distribution.
    pub fewest_axes: usize,
    /// Trunks, at least: fewer than 2 tell nothing of how trees differ.
    pub fewest_trees: usize,
}

impl Default for SpeciesLimits {
    fn default() -> Self {
        Self { orders: 6, fewest_axes: 20, fewest_trees: 2 }
    }
}

/// What could not be fitted, and what was done about it.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfitted {
    /// Orders from this one on have too few axes, and the trees of the spec have none of them.
    Orders {
        /// The first that is left out.
        from: usize,
        /// Its axes.
        axes: usize,
    },
    /// All trees of the spec have the same trunk.
    Trunks {
        /// How many were measured.
        trees: usize,
    },
    /// Axes bear more than rules can make: those beyond are left out.
    Borne {
        /// The most that one axis bears.
        most: usize,
    },
}

/// A species made of measured trees.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedSpecies {
    /// The spec, whose method is an L-system.
    pub spec: TreeSpec,
    /// Orders that its trees have.
    pub orders: usize,
    /// What they have not.
    pub unfitted: Vec<Unfitted>,
}

/// Trees of which no species can be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SpeciesError {
    /// There is no trunk.
    #[error("no tree has a trunk; give trees with axes")]
    NoTree,
    /// Trunks bear too little.
    #[error(
        "the trees have {axes} branches of the first order together; a species needs {fewest}: give more trees"
    )]
    FewBranches {
        /// How many there are.
        axes: usize,
        /// How many are needed.
        fewest: usize,
    },
    /// Radii are not known.
    #[error("the trees have no radii; give files that hold them")]
    NoRadii,
}

/// Quantiles that a rule draws from; as many as [`crate::Lsystem`] takes.
const QUANTILES: usize = 64;
/// Rules move on by at most this share of an axis's length at once, so that it tapers between axes that it bears; two and the collar reach
/// the middle, where taper is measured.
const STRIDE: f64 = 0.245;
/// Farther than any axis is long, metres: where the next axis is when none comes.
const NEVER: f64 = 1e4;
/// Rewriting steps at most: as many as [`crate::Lsystem`] takes.
const STEPS: usize = 1000;
/// An axis has the radius of a fork for such a share of its length beyond it: what is thickest and straightest there goes on as the
/// axis, however thin it soon becomes.
const BEYOND: f64 = 2e-5;
/// Radius of what ends, as a share of a trunk's: thinner than any axis that is measured.
const TIP: f64 = 1e-3;
/// Least and greatest taper: beyond, a radius half way along is a slip of its file.
const TAPERS: [f64; 2] = [0.02, 2.0];
/// Share of an axis's length up to which it has the radius of its base.
const COLLAR: f64 = 0.01;
/// A branch that is longer than so many times its bearer is drawn as long as that: spurs of a few centimetres bear long shoots, but of a
/// slip of a file trees would never end.
const MOST_LENGTH_RATIO: f64 = 30.0;
/// A branch that is thicker than its bearer is drawn as thick.
const MOST_RADIUS_RATIO: f64 = 1.0;
/// Steps of the shares at which waits are told.
const FINE: usize = 2000;
/// Letters of the rules of each order: an axis that begins, and one on its way.
const LETTERS: [(char, char); 6] = [('A', 'a'), ('B', 'b'), ('C', 'c'), ('D', 'd'), ('E', 'e'), ('G', 'g')];

/// Makes a species of what was measured: every trait of every order is drawn from its own quantiles, independently of all others.
///
/// Distances from branch to branch are corrected for axes that end before the next one (Kaplan and Meier 1958), as the trees of the spec
/// have such ends as well. Azimuths are drawn evenly, and axes are straight: neither is measured.
///
/// # Errors
/// [`SpeciesError`].
pub fn fit_species(
    name: &str,
    traits: &Traits,
    limits: &SpeciesLimits,
) -> Result<FittedSpecies, SpeciesError> {
    let trunks = traits.orders.first().filter(|o| o.axes > 0).ok_or(SpeciesError::NoTree)?;
    if trunks.of(Trait::Slenderness).iter().all(|s| *s <= 0.0) {
        return Err(SpeciesError::NoRadii);
    }
    let mut unfitted = Vec::new();
    let most = limits.orders.clamp(1, LETTERS.len());
    let is_known = |o: &OrderTraits| o.axes >= limits.fewest_axes && !o.of(Trait::Angle).is_empty();
    let known = 1 + traits.orders[1..].iter().take_while(|o| is_known(o)).count();
    let orders = known.min(most);
    if let Some(next) = traits.orders.get(orders) {
        if orders == 1 {
            return Err(SpeciesError::FewBranches { axes: next.axes, fewest: limits.fewest_axes });
        }
        unfitted.push(Unfitted::Orders { from: orders, axes: next.axes });
    } else if orders == 1 {
        return Err(SpeciesError::FewBranches { axes: 0, fewest: limits.fewest_axes });
    }
    if trunks.axes < limits.fewest_trees {
        unfitted.push(Unfitted::Trunks { trees: trunks.axes });
    }
    let fitted = &traits.orders[..orders];
    // An axis moves on by one that it bears, or by a stride, in a step.
    let strides = (1.0 / STRIDE).ceil();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few strides")]
    let steps: usize = fitted.iter().map(|o| 2 * o.most_borne + strides as usize + 2).sum();
    if steps > STEPS {
        let most = fitted.iter().map(|o| o.most_borne).max().unwrap_or(0);
        unfitted.push(Unfitted::Borne { most });
    }
    let spec = TreeSpec {
        name: name.to_owned(),
        about: format!("{} measured trees, as rules", trunks.axes),
        variation: VariationSpec::default(),
        method: Method::Lsystem { rules: rules(fitted, steps.min(STEPS)), most_modules: 2_000_000 },
        wood: WoodSpec { smooth: false, relax: 0, thin_out: 0.0, ..WoodSpec::default() },
        ..TreeSpec::default()
    };
    Ok(FittedSpecies { spec, orders, unfitted })
}

fn rules(orders: &[OrderTraits], steps: usize) -> String {
    let mut out = String::new();
    let trunks = &orders[0];
    let drawn = |order: &OrderTraits, which| drawn_of(&sorted(order.of(which)));
    let median = |which| quantile_of(&sorted(trunks.of(which)), 0.5);
    let trunk_radius = median(Trait::Length) * median(Trait::Slenderness);
    let _ = write!(
        out,
        "# Each number is drawn from the quantiles of what was measured: drawn(least, ..., greatest).\n\
         axiom = Z({}, {})\nsteps = {steps}\nwidth = {}\nlet tip = {}\n\n\
         # The trunk: length, and radius as a share of it.\nZ(l, s) -> !(2 * l * s) A(l, l * s)\n",
        drawn(trunks, Trait::Length),
        drawn(trunks, Trait::Slenderness),
        short(2.0 * trunk_radius),
        short(TIP * trunk_radius),
    );
    for (k, (order, letters)) in orders.iter().zip(LETTERS).enumerate() {
        let following = orders.get(k + 1).zip(LETTERS.get(k + 1).map(|l| l.0));
        let _ = writeln!(
            out,
            "\n# Order {k}: l long, r thick at its base; x along it, d to the next axis that it bears."
        );
        out.push_str(&order_rules(order, letters, following));
    }
    out
}

/// How an axis of an order goes on from each axis that it bears to the next.
fn order_rules(
    order: &OrderTraits,
    (begin, on): (char, char),
    following: Option<(&OrderTraits, char)>,
) -> String {
    let taper = drawn_of(&tapers(order.of(Trait::Taper)));
    // What an order bears that is left out is borne by none.
    let [first, next] = [(Trait::First, 0), (Trait::Internode, 1)].map(|(which, k)| match following {
        Some(_) => drawn_of(&waits(order.of(which), &order.unended[k])),
        None => short(NEVER),
    });
    let stride = format!("l * {STRIDE}");
    let thick = |at: &str| format!("max(tip, r * t ^ (2 * ({at}) / l))");
    let mut out = format!(
        "{begin}(l, r) -> !(2 * r) F(l * {COLLAR}) {on}(l, r, {taper}, l * {COLLAR}, max(0, {first} - l * {COLLAR}))\n\
         {on}(l, r, t, x, d) if d > {stride} && x + {stride} < l * 0.999 -> !(2 * {there}) F({stride}) \
         {on}(l, r, t, x + {stride}, d - {stride})\n\
         {on}(l, r, t, x, d) if (d > {stride} && x + {stride} >= l * 0.999) || (d <= {stride} && x + d >= l) -> \
         !(2 * tip) F(l - x)\n",
        there = thick(&format!("x + {stride}")),
    );
    let Some((following, next_begin)) = following else { return out };
    let there = thick("x + d");
    let _ = writeln!(
        out,
        "{on}(l, r, t, x, d) if d <= {stride} && x + d < l -> !(2 * {there}) F(d) [ /(rand(0, 360)) &({angle}) \
         {next_begin}(l * {length}, max(tip, {there} * {radius})) ] !(2 * {there}) F(l * {BEYOND}) \
         {on}(l, r, t, x + d + l * {BEYOND}, max(0, {next} - l * {BEYOND}))",
        angle = drawn_of(&sorted(following.of(Trait::Angle))),
        length = drawn_of(&shares(following.of(Trait::LengthRatio), MOST_LENGTH_RATIO)),
        radius = drawn_of(&shares(following.of(Trait::RadiusRatio), MOST_RADIUS_RATIO)),
    );
    out
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut out = values.to_vec();
    base::sort_numbers(&mut out);
    out
}

fn shares(values: &[f64], most: f64) -> Vec<f64> {
    sorted(values).into_iter().filter(|v| *v > 0.0).map(|v| v.min(most)).collect()
}

/// Tapers as rules can draw them, sorted: an axis that has the share t of its radius half way along has t^(2x/l) at x, and ends in a cone.
fn tapers(values: &[f64]) -> Vec<f64> {
    sorted(values).into_iter().map(|t| t.clamp(TAPERS[0], TAPERS[1])).collect()
}

/// Waits for the next axis, sorted, as they would be if no axis ended before it (Kaplan and Meier 1958): as many values as keep the
/// shares, [`NEVER`] for what never ended.
fn waits(ended: &[f64], unended: &[f64]) -> Vec<f64> {
    let mut all: Vec<(f64, bool)> =
        ended.iter().map(|w| (*w, true)).chain(unended.iter().map(|w| (*w, false))).collect();
    // What ended comes before what was seen as long.
    base::sort_by(&mut all, |a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let mut left = 1.0;
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for (k, &(wait, has_ended)) in all.iter().enumerate() {
        if has_ended {
            left *= 1.0 - 1.0 / (all.len() - k) as f64;
            steps.push((wait, 1.0 - left));
        }
    }
    (0..=FINE)
        .map(|k| {
            let share = k as f64 / FINE as f64;
            let at = steps.partition_point(|(_, reached)| *reached < share - 1e-12);
            steps.get(at).map_or(NEVER, |s| s.0)
        })
        .collect()
}

/// A draw from sorted values, in the language of rules.
fn drawn_of(sorted: &[f64]) -> String {
    let numbers: Vec<String> =
        (0..QUANTILES).map(|k| short(quantile_of(sorted, k as f64 / (QUANTILES - 1) as f64))).collect();
    format!("drawn({})", numbers.join(", "))
}

/// Five digits, however small it is.
fn short(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let (mut decimals, mut size) = (0, value.abs());
    while size < 1e4 && decimals < 9 {
        size *= 10.0;
        decimals += 1;
    }
    let mut text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grow;
    use base::{Report, Run, Seed};

    #[test]
    fn waits_are_those_of_axes_that_did_not_end_before() {
        // Of four axes two end before the second branch would come: half of what is left then waits for ever.
        let got = waits(&[1.0, 2.0], &[1.5, 3.0]);
        let at = |share: f64| quantile_of(&got, share);
        assert!((at(0.1) - 1.0).abs() < 1e-9 && (at(0.5) - 2.0).abs() < 1e-9, "{got:?}");
        assert!(at(0.9) > 1e3 && waits(&[], &[1.0]).iter().all(|w| *w > 1e3));
    }

    #[test]
    fn numbers_of_rules_have_five_digits() {
        for (value, want) in
            [(0.0, "0"), (0.000_123_456, "0.00012346"), (12.345_678, "12.346"), (1e4, "10000")]
        {
            assert_eq!(short(value), want);
        }
    }

    /// Trees grown of a species, measured and fitted again, give the same species.
    #[test]
    fn a_species_of_its_own_trees_is_itself() {
        let rules = "axiom = A(6, 0.1)\nsteps = 40\nwidth = 0.2\n\
                     A(l, r) if l > 0.3 -> !(2 * r) F(0.4) [ /(rand(0, 360)) &(rand(35, 65)) B(l * rand(0.2, 0.4), r * 0.4) ] A(l - 0.4, r * 0.95)\n\
                     B(l, r) -> !(2 * r) F(l * 0.5) [ /(rand(0, 360)) &(40) C(l * 0.4, r * 0.5) ] !(r) F(l * 0.5)\n\
                     C(l, r) -> !(2 * r) F(l * 0.5) !(r) F(l * 0.5)";
        let mut spec = TreeSpec { bare: true, ..TreeSpec::default() };
        spec.method = Method::Lsystem { rules: rules.into(), most_modules: 100_000 };
        spec.wood = WoodSpec { smooth: false, relax: 0, thin_out: 0.0, ..WoodSpec::default() };
        let lot = |spec: &TreeSpec, seeds: core::ops::Range<u64>| {
            let mut out = Traits::default();
            for seed in seeds {
                let tree = grow(spec, None, Seed::new(seed), &Run::plain(), &mut Report::default()).unwrap();
                out.add(&tree.plant);
            }
            out
        };
        let measured = lot(&spec, 0..12);
        let species = fit_species("own", &measured, &SpeciesLimits::default()).unwrap();
        assert_eq!(species.orders, 3);
        let mut fitted = species.spec;
        fitted.bare = true;
        let rows = super::super::agree(&lot(&spec, 100..112), &lot(&fitted, 0..60), species.orders);
        for order in [1, 2] {
            for which in [Trait::Angle, Trait::LengthRatio] {
                let row = rows.iter().find(|a| a.order == order && a.which == which).unwrap();
                println!("{row:?}");
                assert!(row.distance < 0.12, "{row:?}");
            }
        }
    }

    #[test]
    fn trees_without_branches_or_radii_are_refused() {
        assert_eq!(
            fit_species("x", &Traits::default(), &SpeciesLimits::default()),
            Err(SpeciesError::NoTree)
        );
    }
}
