//! Turns traits by order into rules that draw each of them from the measurements.

use core::fmt::Write as _;

use super::quantile_of;
use super::traits::{OrderTraits, Trait, Traits};
use crate::{Method, TreeSpec, VariationSpec, WoodSpec};

/// Limits of a fitted species.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpeciesLimits {
    /// Orders from the trunk on, 1 to 6: each needs letters of its own.
    pub orders: usize,
    /// Least number of axes of an order: fewer do not determine a distribution.
    pub fewest_axes: usize,
    /// Least number of trunks: fewer than 2 do not show how trees differ.
    pub fewest_trees: usize,
}

impl Default for SpeciesLimits {
    fn default() -> Self {
        Self { orders: 6, fewest_axes: 20, fewest_trees: 2 }
    }
}

/// A part that could not be fitted, and its replacement.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfitted {
    /// Orders from this one on have too few axes, and are missing in the trees of the spec.
    Orders {
        /// The first omitted order.
        from: usize,
        /// Number of its axes.
        axes: usize,
    },
    /// All trees of the spec have the same trunk.
    Trunks {
        /// Number of measured trees.
        trees: usize,
    },
    /// Axes bear more than rules can make: the rest is left out.
    Borne {
        /// The most that one axis bears.
        most: usize,
    },
}

/// A species fitted to measured trees.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedSpecies {
    /// The spec, whose method is an L-system.
    pub spec: TreeSpec,
    /// Number of orders of its trees.
    pub orders: usize,
    /// The parts that are missing.
    pub unfitted: Vec<Unfitted>,
}

/// Reason why trees cannot be made into a species.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SpeciesError {
    /// There is no trunk.
    #[error("no tree has a trunk; give trees with axes")]
    NoTree,
    /// Trunks bear too few branches.
    #[error(
        "the trees have {axes} branches of the first order together; a species needs {fewest}: give more trees"
    )]
    FewBranches {
        /// Actual number of branches.
        axes: usize,
        /// Number of branches needed.
        fewest: usize,
    },
    /// The radii are unknown.
    #[error("the trees have no radii; give files that hold them")]
    NoRadii,
}

/// Most quantiles of a draw in a rule; as many as [`crate::Lsystem`] accepts.
const QUANTILES: usize = 64;
/// Largest step of rules, as a share of an axis's length, so that the axis tapers between those that it bears; two
/// steps and the collar reach the middle, where taper is measured.
const STRIDE: f64 = 0.245;
/// Distance, metres, longer than any axis, to the next axis if none follows.
const NEVER: f64 = 1e4;
/// Most rewriting steps: as many as [`crate::Lsystem`] accepts.
const STEPS: usize = 1000;
/// Length beyond a fork, as a share of the axis, on which it keeps the radius of the fork: the thickest and straightest
/// branch there continues the axis, however thin it soon becomes.
const BEYOND: f64 = 2e-5;
/// Radius of a tip, as a share of a trunk's: thinner than any measured axis.
const TIP: f64 = 1e-3;
/// Least and greatest taper: beyond them, a radius half way along is a mistake in its file.
const TAPERS: [f64; 2] = [0.02, 2.0];
/// Share of an axis's length up to which it has the radius of its base.
const COLLAR: f64 = 0.01;
/// Largest length of a branch relative to its bearer; longer ones are cut to it: spurs of a few centimetres bear long
/// shoots, but a mistake in a file would make endless trees.
const MOST_LENGTH_RATIO: f64 = 30.0;
/// Largest radius of a branch relative to its bearer; thicker ones are reduced to it.
const MOST_RADIUS_RATIO: f64 = 1.0;
/// Number of shares at which waits are evaluated.
const FINE: usize = 2000;
/// Letters of the rules of each order: an axis that begins, and one that continues.
const LETTERS: [(char, char); 6] = [('A', 'a'), ('B', 'b'), ('C', 'c'), ('D', 'd'), ('E', 'e'), ('G', 'g')];

/// Makes a species from measurements: every trait of every order is drawn from its own quantiles, independently of all
/// others.
///
/// Distances from branch to branch are corrected for axes that end before the next one (Kaplan and Meier 1958), as the
/// trees of the spec have such ends as well. Azimuths are drawn uniformly, and axes are straight: neither is measured.
///
/// # Errors
/// [`SpeciesError`].
pub fn fit_species(
    name: &str,
    traits: &Traits,
    limits: &SpeciesLimits,
) -> Result<FittedSpecies, SpeciesError> {
    let trunks = traits.orders.first().filter(|o| o.axes > 0).ok_or(SpeciesError::NoTree)?;
    if trunks.values(Trait::Slenderness).iter().all(|s| *s <= 0.0) {
        return Err(SpeciesError::NoRadii);
    }
    let mut unfitted = Vec::new();
    let most = limits.orders.clamp(1, LETTERS.len());
    let is_known = |o: &OrderTraits| o.axes >= limits.fewest_axes && !o.values(Trait::Angle).is_empty();
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
    // An axis advances by one borne axis, or by a stride, in a step.
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
    let drawn = |order: &OrderTraits, which| drawn_of(&sorted(order.values(which)));
    let median = |which| quantile_of(&sorted(trunks.values(which)), 0.5);
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

/// Writes the rules by which an axis of an order continues from each axis that it bears to the next.
fn order_rules(
    order: &OrderTraits,
    (begin, on): (char, char),
    following: Option<(&OrderTraits, char)>,
) -> String {
    let taper = drawn_of(&tapers(order.values(Trait::Taper)));
    // Axes of an omitted order are not borne.
    let [first, next] = [(Trait::First, 0), (Trait::Internode, 1)].map(|(which, k)| match following {
        Some(_) => drawn_of(&waits(order.values(which), &order.unended[k])),
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
        angle = drawn_of(&sorted(following.values(Trait::Angle))),
        length = drawn_of(&shares(following.values(Trait::LengthRatio), MOST_LENGTH_RATIO)),
        radius = drawn_of(&shares(following.values(Trait::RadiusRatio), MOST_RADIUS_RATIO)),
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

/// Returns sorted tapers that rules can draw: an axis with the share t of its radius half way along has t^(2x/l) at x,
/// and ends in a cone.
fn tapers(values: &[f64]) -> Vec<f64> {
    sorted(values).into_iter().map(|t| t.clamp(TAPERS[0], TAPERS[1])).collect()
}

/// Returns the sorted distances to the next axis as they would be if no axis ended before it (Kaplan and Meier 1958):
/// as many values as keep the shares, [`NEVER`] for those that never ended.
fn waits(ended: &[f64], unended: &[f64]) -> Vec<f64> {
    let mut all: Vec<(f64, bool)> =
        ended.iter().map(|w| (*w, true)).chain(unended.iter().map(|w| (*w, false))).collect();
    // Ended ones come before unended ones of the same length.
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

/// Writes a draw from sorted values, in the language of rules.
fn drawn_of(sorted: &[f64]) -> String {
    let numbers: Vec<String> =
        (0..QUANTILES).map(|k| short(quantile_of(sorted, k as f64 / (QUANTILES - 1) as f64))).collect();
    format!("drawn({})", numbers.join(", "))
}

/// Writes five digits, however small the value is.
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
        // Two of four axes end before the second branch would come: half of the rest then waits for ever.
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

    /// Trees grown from a species, measured and fitted again, give the same species.
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
