//! L-systems: bracketed, parametric and stochastic rules, read from text.
//!
//! `text -> Lsystem -> modules -> Skeleton and leaves` (Prusinkiewicz and Lindenmayer 1990)

mod derive;
mod expr;
mod grammar;
mod turtle;

use base::{Counted, Report, Run, Seed};
use glam::DVec3;

use crate::error::usable;
use crate::{GrowthError, JointId, Skeleton};

pub use grammar::{Ages, Lsystem};

/// A leaf or a flower that the turtle set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafMark {
    /// Joint that bears it.
    pub joint: JointId,
    /// From root to tip, unit.
    pub heading: DVec3,
    /// Towards its upper side, unit.
    pub up: DVec3,
    /// Relative size.
    pub scale: f64,
    /// Whether it is a flower, not a leaf.
    pub flower: bool,
}

/// Result of an L-system.
#[derive(Clone, Debug, PartialEq)]
pub struct LsystemTree {
    /// All trees; with radii if the rules set diameters.
    pub skeleton: Skeleton,
    /// Leaves and flowers.
    pub leaves: Vec<LeafMark>,
    /// Modules of the last step, of all trees.
    pub modules: usize,
}

/// An oak: short trunk, wide limbs that zigzag and droop slightly under their weight, leaves at the ends.
pub const OAK_RULES: &str = include_str!("oak.lsys");

/// Grows one tree from each root; stochastic rules draw anew for each.
///
/// Guaranteed: at most `most_modules` (1 to 100 million) modules; a clean `validate()`; the rewriting of one module
/// draws nothing on which another depends.
///
/// # Errors
/// [`GrowthError::Lsystem`] if rules explode or give numbers that are not finite, with the rule;
/// [`GrowthError::NoRoots`], [`GrowthError::Root`]; cancelled.
///
/// ```
/// use base::{Counted, Report, Run, Seed};
/// use glam::DVec3;
/// use growth::{Lsystem, grow_lsystem};
/// let system = Lsystem::parse("axiom = A\nsteps = 4\nA -> F(1) [ +(40) A ] [ -(40) A ]")?;
/// let run = Run::plain();
/// let tree = grow_lsystem(&[DVec3::ZERO], &system, 1000, Seed::new(1), &run, &mut Report::default())?;
/// assert_eq!(tree.skeleton.len(), 1 + 1 + 2 + 4 + 8);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn grow_lsystem(
    roots: &[DVec3],
    system: &Lsystem,
    most_modules: u32,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<LsystemTree, GrowthError> {
    if roots.is_empty() {
        return Err(GrowthError::NoRoots);
    }
    run.budget.check(Counted::Roots, roots.len() as u64, "give fewer roots")?;
    let started = run.clock.now_ms();
    let most = most_modules.clamp(1, 100_000_000) as usize;
    let mut tree = LsystemTree { skeleton: Skeleton::default(), leaves: Vec::new(), modules: 0 };
    for (root, &at) in roots.iter().enumerate() {
        if !usable(at) {
            return Err(GrowthError::Root { root });
        }
        let modules =
            derive::derive(system, most.saturating_sub(tree.modules), seed.child(root as u64), run)?;
        tree.modules += modules.len();
        #[expect(clippy::cast_possible_truncation, reason = "fewer roots than joints")]
        let number = root as u32;
        if !turtle::draw(system, &modules, at, number, &mut tree.skeleton, &mut tree.leaves) {
            base::warn!(
                report,
                "turtle-lost",
                { tree = root + 1 },
                "tree {tree} left the world (1e6 m) and was cut off there"
            );
        }
    }
    report.book("grow", run.clock.now_ms() - started);
    debug_assert_eq!(tree.skeleton.validate().next(), None, "a drawn skeleton is sound");
    Ok(tree)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LsystemError;

    fn grow(text: &str, seed: u64) -> Result<LsystemTree, GrowthError> {
        let system = Lsystem::parse(text)?;
        grow_lsystem(&[DVec3::ZERO], &system, 100_000, Seed::new(seed), &Run::plain(), &mut Report::default())
    }

    #[test]
    fn the_turtle_draws_a_known_figure() {
        let tree = grow("axiom = F(1) [ +(90) F(2) L(0.5) ] &(90) F(3)\nsteps = 0", 1).expect("sound");
        let p = &tree.skeleton.position;
        assert_eq!(p.len(), 4);
        // To the left of a turtle that heads up and has its back to the viewer is -x; downwards from there is away from
        // up.
        assert!(p[2].distance(DVec3::new(-2.0, 1.0, 0.0)) < 1e-12, "{}", p[2]);
        assert!(p[3].distance(DVec3::new(0.0, 1.0, -3.0)) < 1e-12, "{}", p[3]);
        assert_eq!(
            (tree.leaves.len(), tree.leaves[0].joint, tree.leaves[0].scale),
            (1, JointId::new(2), 0.5)
        );
    }

    #[test]
    fn flowers_are_set_where_rules_say() {
        let tree = grow("axiom = F(1) L F(1) *(0.5)\nsteps = 0", 1).expect("sound");
        let got: Vec<_> = tree.leaves.iter().map(|m| (m.joint, m.scale, m.flower)).collect();
        assert_eq!(got, [(JointId::new(1), 1.0, false), (JointId::new(2), 0.5, true)]);
    }

    #[test]
    fn parameters_and_conditions_decide() {
        let tree = grow("axiom = A(1)\nsteps = 50\nlet r = 0.5\nA(x) if x > 0.1 -> F(x) A(x * r)", 1);
        let s = tree.expect("sound").skeleton;
        assert_eq!(s.len(), 5, "1, 0.5, 0.25, 0.125");
        assert!((s.position[4].y - 1.875).abs() < 1e-12);
        let binary = grow("axiom = A\nsteps = 10\nA -> F [ + A ] [ - A ]", 1).expect("sound");
        assert_eq!(binary.skeleton.len(), 1 << 10);
    }

    #[test]
    fn chances_are_kept_and_repeatable() {
        let text = "axiom = A A A A A A A A\nsteps = 8\nA -> A A\nA prob 0 -> F";
        assert!(grow(text, 1).is_ok());
        let mix = "axiom = A\nsteps = 12\nA -> B B\nB prob 0.3 -> F(1) A\nB prob 0.7 -> F(2) A";
        let count = |seed| {
            let s = grow(mix, seed).expect("sound").skeleton;
            let one = (1..s.len()).filter(|&j| s.position[j].y - s.position[j - 1].y < 1.5).count();
            (one, s.len() - 1)
        };
        let (one, all) = count(4);
        assert_eq!(all, 126);
        assert!((0.15..0.45).contains(&(one as f64 / all as f64)), "{one} of {all}");
        assert_eq!(count(4), count(4));
        assert!((5..9).any(|seed| count(seed) != count(4)), "another seed, another tree");
    }

    #[test]
    fn an_explosion_names_its_rule() {
        let got = grow("axiom = A\nsteps = 90\nA -> A B\nB -> B B B # too much", 1);
        let Err(GrowthError::Lsystem(LsystemError::TooLarge { rule, line, most, .. })) = &got else {
            panic!("{got:?}")
        };
        assert_eq!((rule.as_str(), *line, *most), ("B -> B B B", 4, 100_000));
        let got = grow("axiom = A(1)\nsteps = 9\nA(x) -> F(1 / (x - 1)) A(x)", 1);
        let not_finite = LsystemError::NotFinite { rule: "A(x) -> F(1 / (x - 1)) A(x)".into(), line: 3 };
        assert_eq!(got, Err(not_finite.into()));
    }

    #[test]
    fn slips_are_named_with_their_line() {
        for (text, want) in [
            ("", "there is no axiom"),
            ("axiom = F ]", "line 1: a ] without its ["),
            ("axiom = A\nA -> F(", "line 2: a number or name"),
            ("axiom = A\nA(x -> F", "line 2: a ) is missing"),
            ("axiom = A\nA(x) if x >  -> F", "line 2: a number or name"),
            ("axiom = A\n[ -> F", "line 2: `[` is no module"),
            ("axiom = A\nstps = 3", "line 2: `stps` is no setting"),
            ("axiom = A\nsteps = 10000", "line 2: steps must be 0 to 1000, not 10000"),
            ("axiom = A\nhello", "line 2: neither"),
            ("axiom = A\nA prob -1 -> F", "line 2: prob must be"),
            ("axiom = A\nA when x -> F", "line 2: `when x`"),
            ("axiom = \u{e4}", "line 1: `\u{c3}` is no module"),
        ] {
            let got = Lsystem::parse(text).map(|_| ()).map_err(|e| e.to_string());
            assert!(got.as_ref().is_err_and(|e| e.starts_with(want)), "{text:?}: {got:?}");
        }
    }

    #[test]
    fn rules_that_never_match_are_told_with_names_and_numbers() {
        for (text, there, rules) in [
            ("axiom = F(1)\nF -> F F", "F with 1 number", "F with no number"),
            ("axiom = A(1,2) [ B ]\nA(x) -> F(x)", "A with 2 numbers, B with no number", "A with 1 number"),
            ("axiom = A(1)\nA(x) if x > 2 -> F(x)", "A with 1 number", "A with 1 number"),
        ] {
            let said = grow(text, 1).map(|_| ()).map_err(|e| e.to_string());
            let want = format!("There is {there}; the rules are for {rules}.");
            assert!(said.as_ref().is_err_and(|said| said.contains(&want)), "{text}: {said:?}");
        }
        let told =
            grow("axiom = A(1,2) [ B ]\nA(x) -> F(x)", 1).map(|_| ()).map_err(|e| base::Coded::details(&e));
        let told = told.expect_err("no rule matches");
        let field = |name| told.fields[name].as_str();
        assert_eq!((told.code, field("there"), field("rules")), ("lsystem-no-match", "A(_, _), B", "A(_)"));
        // A rule that waits for its chance, and an axiom alone, are no mistakes.
        assert!(grow("axiom = A F\nsteps = 1\nA prob 0.001 -> F", 1).is_ok());
        assert!(grow("axiom = F(1)\nsteps = 0\nF -> F F", 1).is_ok() && grow("axiom = F(1)", 1).is_ok());
    }

    #[test]
    fn numbers_have_exponents() {
        let tree = grow("axiom = F(1e-1) F(2.5E+1)\nsteps = 0", 1).expect("sound");
        assert!((tree.skeleton.position[2].y - 25.1).abs() < 1e-12);
    }

    #[test]
    fn a_message_quotes_a_line_and_no_more() {
        let got = Lsystem::parse(&format!("axiom = F\n{} -> F", "\u{e4}".repeat(1_000_000)));
        assert!(got.is_err_and(|e| e.to_string().chars().count() < 200));
        let got = grow(&format!("axiom = A\nsteps = 90\nA -> {}", "A ".repeat(100_000)), 1);
        assert!(got.is_err_and(|e| e.to_string().len() < 400));
    }

    #[test]
    fn the_oak_is_an_oak() {
        let tree = grow(OAK_RULES, 1).expect("sound");
        let s = &tree.skeleton;
        let top = s.position.iter().map(|p| p.y).fold(0.0, f64::max);
        let wide = s.position.iter().map(|p| p.x.abs().max(p.z.abs())).fold(0.0, f64::max);
        assert!((5.0..20.0).contains(&top) && wide > 0.3 * top, "{top} {wide}");
        assert!(tree.leaves.len() > 2000 && s.len() > 2000, "{} {}", tree.leaves.len(), s.len());
        assert_eq!(s.validate().count(), 0);
    }

    proptest::proptest! {
        #[test]
        fn no_text_panics(text in "(axiom = [A-C\\[\\]+(0-9)]{1,9}\n)?(let r = [0-9.]{1,3}\n)?([ABC](\\([xy]\\))?( if [x<>0-9.&|!()]{1,8})?( prob [0-9.]{1,3})? -> [-A-CF\\[\\]()+*/^x0-9,.& ]{0,20}\n){0,4}") {
            let _ = grow(&text, 1);
        }
        #[test]
        fn no_noise_panics(text in "[ -~\n\u{e4}]{0,60}") {
            let _ = grow(&text, 1);
        }
    }
}
