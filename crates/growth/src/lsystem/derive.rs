//! Rewrites the axiom to modules, step by step, within bounds.

use base::{Counted, Draw, Run, Seed};

use super::grammar::{Lsystem, Rule, Written};
use crate::GrowthError;
use crate::error::LsystemError;

/// A string of modules in columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Modules {
    symbol: Vec<u8>,
    /// End of each module's numbers; they start where the previous module's end.
    end: Vec<u32>,
    numbers: Vec<f64>,
    /// Seed of the draws of each module, from its bearer's and its position in it.
    seed: Vec<Seed>,
}

impl Modules {
    pub(super) fn len(&self) -> usize {
        self.symbol.len()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (u8, &[f64])> {
        (0..self.len()).map(|i| (self.symbol[i], self.parameters(i)))
    }

    fn parameters(&self, i: usize) -> &[f64] {
        let start = if i == 0 { 0 } else { self.end[i - 1] as usize };
        &self.numbers[start..self.end[i] as usize]
    }

    fn push(&mut self, symbol: u8, seed: Seed) {
        self.symbol.push(symbol);
        self.seed.push(seed);
        #[expect(clippy::cast_possible_truncation, reason = "modules are bounded, and so are their numbers")]
        self.end.push(self.numbers.len() as u32);
    }

    fn clear(&mut self) {
        self.symbol.clear();
        self.end.clear();
        self.numbers.clear();
        self.seed.clear();
    }
}

/// Rewrites the axiom; returns the modules of the last step.
pub(super) fn derive(
    system: &Lsystem,
    most: usize,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Modules, GrowthError> {
    let (mut now, mut next) = (Modules::default(), Modules::default());
    let mut stack = Vec::new();
    for (w, i) in system.axiom.iter().zip(0..) {
        write(w, &[], seed.child(i), seed.child(i), &mut next, &mut stack);
        if next.parameters(next.len() - 1).iter().any(|x| !x.is_finite()) {
            return Err(LsystemError::NotFinite { rule: "axiom".into(), line: 0 }.into());
        }
    }
    core::mem::swap(&mut now, &mut next);
    let mut by_symbol: Vec<Vec<usize>> = vec![Vec::new(); 256];
    for (r, rule) in system.rules.iter().enumerate() {
        by_symbol[usize::from(rule.symbol)].push(r);
    }
    let mut made = vec![0_usize; system.rules.len()];
    let mut matched = system.steps == 0 || system.rules.is_empty();
    for step in 1..=system.steps {
        next.clear();
        made.fill(0);
        for i in 0..now.len() {
            if i % 4096 == 0 {
                run.cancel.check()?;
            }
            let (symbol, numbers, own) = (now.symbol[i], now.parameters(i), now.seed[i]);
            let rules = by_symbol[usize::from(symbol)].iter().map(|&r| (r, &system.rules[r]));
            let (fits, chosen) = choose(rules, numbers, own, &mut stack);
            matched |= fits;
            let Some((r, rule)) = chosen else {
                next.numbers.extend_from_slice(numbers);
                // A module that waits draws again in the next step.
                next.push(symbol, own.child(u64::MAX));
                continue;
            };
            made[r] += rule.successor.len();
            if next.len() + rule.successor.len() > most {
                return Err(too_large(system, &made, step, most).into());
            }
            // Checked occasionally: one rule writes few modules.
            if i % 1024 == 0 {
                let all = next.len() as u64;
                run.budget.check(Counted::Joints, all, "take fewer steps or lower most_modules")?;
            }
            let from = next.numbers.len();
            for (w, k) in rule.successor.iter().zip(0..) {
                write(w, numbers, own.child(k), own, &mut next, &mut stack);
            }
            if next.numbers[from..].iter().any(|x| !x.is_finite()) {
                return Err(LsystemError::NotFinite { rule: rule.text.clone(), line: rule.line }.into());
            }
        }
        core::mem::swap(&mut now, &mut next);
    }
    if matched { Ok(now) } else { Err(no_match(system, &now).into()) }
}

fn no_match(system: &Lsystem, modules: &Modules) -> LsystemError {
    let list = |kinds: &mut dyn Iterator<Item = (u8, usize)>| {
        let mut named: Vec<(char, usize)> = Vec::new();
        for (symbol, numbers) in kinds {
            let kind = (char::from(symbol), numbers);
            // Brackets are never rewritten; if there are many kinds, the first ones suffice.
            if !b"[]".contains(&symbol) && named.len() < 6 && !named.contains(&kind) {
                named.push(kind);
            }
        }
        named
    };
    LsystemError::NoMatch {
        there: list(&mut modules.iter().map(|(symbol, numbers)| (symbol, numbers.len()))),
        rules: list(&mut system.rules.iter().map(|rule| (rule.symbol, rule.arity))),
    }
}

fn too_large(system: &Lsystem, made: &[usize], step: u32, most: usize) -> LsystemError {
    let worst = made.iter().zip(&system.rules).max_by_key(|(n, rule)| (**n, core::cmp::Reverse(rule.line)));
    let (text, line, n) = worst.map_or((String::new(), 0, 0), |(n, r)| (r.text.clone(), r.line, *n));
    LsystemError::TooLarge { rule: text, line, step, made: n, most }
}

fn write(w: &Written, given: &[f64], seed: Seed, draws: Seed, to: &mut Modules, stack: &mut Vec<f64>) {
    for (e, i) in w.arguments.iter().zip(0..) {
        let x = e.value(given, seed.child(draws.number()).child(i), stack);
        to.numbers.push(x);
    }
    to.push(w.symbol, seed);
}

/// Returns whether any rule matches a module, and the chosen one: among the matching ones, by their probabilities.
fn choose<'a>(
    rules: impl Iterator<Item = (usize, &'a Rule)> + Clone,
    numbers: &[f64],
    seed: Seed,
    stack: &mut Vec<f64>,
) -> (bool, Option<(usize, &'a Rule)>) {
    let mut fits = |rule: &Rule| {
        rule.arity == numbers.len()
            && rule.condition.as_ref().is_none_or(|c| {
                let x = c.value(numbers, seed, stack);
                x != 0.0 && !x.is_nan()
            })
    };
    let mut whole = 0.0;
    let mut only = None;
    let mut count = 0;
    for (r, rule) in rules.clone() {
        if fits(rule) {
            whole += rule.chance;
            count += 1;
            only = Some((r, rule));
        }
    }
    if count == 0 || (count == 1 && whole >= 1.0) {
        return (count > 0, only);
    }
    // If the probabilities sum to less than 1, the module stays unchanged with the rest.
    let mut at = seed.stream(Draw::Template).uniform() * f64::max(whole, 1.0);
    for (r, rule) in rules {
        if fits(rule) {
            at -= rule.chance;
            if at < 0.0 {
                return (true, Some((r, rule)));
            }
        }
    }
    (true, None)
}
