//! The text of an L-system: settings, constants, rules.

use glam::DVec3;

use super::expr::{Expression, Reader};
use crate::error::{LsystemError, RuleFault};

/// Most parameters of one module: more are a mistake.
const MOST_PARAMETERS: usize = 8;
/// Most rewriting steps. Each copies all modules, of which there may be far more than a step makes.
const MOST_STEPS: u32 = 1000;
/// Characters that a rule may not rewrite: brackets, and the symbols of the grammar itself.
const RESERVED: &[u8] = b"[](),;#";

/// A module as written in a rule.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Written {
    pub(super) symbol: u8,
    pub(super) arguments: Vec<Expression>,
}

/// One way of rewriting a module.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rule {
    /// As written, for messages.
    pub(super) text: String,
    pub(super) line: usize,
    pub(super) symbol: u8,
    pub(super) arity: usize,
    pub(super) condition: Option<Expression>,
    pub(super) chance: f64,
    pub(super) successor: Vec<Written>,
}

/// An L-system read from text.
///
/// ```
/// let text = "axiom = A(1)\nsteps = 3\nA(x) if x > 0.1 -> F(x) [ +(30) A(x / 2) ] A(x * 0.8)";
/// assert!(growth::Lsystem::parse(text).is_ok());
/// let slip = growth::Lsystem::parse("axiom = A\nA -> [ F").unwrap_err();
/// assert_eq!(slip.to_string(), "line 2: a ] is missing");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lsystem {
    pub(super) axiom: Vec<Written>,
    pub(super) rules: Vec<Rule>,
    /// Rewriting steps.
    pub steps: u32,
    /// Angle of turns without a number, degrees; default 25.
    pub angle_deg: f64,
    /// Length of `F` without a number, metres; default 0.2.
    pub length_m: f64,
    /// Diameter at the start, metres; 0, the default, leaves radii to the pipe model.
    pub width_m: f64,
    /// Direction and strength of a tropism that bends every step; default none.
    pub tropism: (DVec3, f64),
    /// Derivation of a younger plant; default from the whole plant.
    pub ages: Ages,
}

/// Derivation of a younger plant of rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ages {
    /// The whole plant is scaled back, whatever the rules say.
    #[default]
    Whole,
    /// Fewer steps.
    Steps,
    /// The rules themselves, which read the elapsed share of the plant's life.
    Rules,
}

/// Name under which rules read the share of a plant's life, above 0 to 1.
const LIFE: &str = "life";

impl Lsystem {
    /// Reads an L-system.
    ///
    /// One statement per line; `#` starts a comment. Settings: `axiom = MODULES`, `steps = N` (0 to 1000, default 5),
    /// `angle = DEGREES`, `length = METRES`, `width = METRES`, `tropism = X Y Z STRENGTH`, `let NAME = EXPRESSION`,
    /// `ages = steps` (a plant at a share of its years is the result of that share of the steps: for rules that follow
    /// growth), `ages = rules` (it is the result of the rules with `life`, the share of its years, which is 1 for the
    /// whole and available to the statements below).
    /// Rules: `A(x, y) if CONDITION prob NUMBER -> MODULES`; `if` and `prob` may be left out. Rules for the same module
    /// share by their `prob`; if those sum to less than 1, the module stays with the rest. A module is one character,
    /// with numbers in parentheses. For the turtle: `F(l)` step, `+(a)` `-(a)` left and right, `&(a)` `^(a)` down and
    /// up, `\(a)` `/(a)` roll, `|` turn around, `$` roll level, `!(d)` diameter, `L(s)` leaf and `*(s)` flower of that
    /// scale, `[` `]` branch. All others are skipped. `rand(a, b)` is uniform between two numbers, `normal(m, s)` has a
    /// mean and a deviation, and `drawn(least, ..., greatest)` has 2 to 64 quantiles at even shares. Prusinkiewicz and
    /// Lindenmayer 1990, chapters 1 and 2.
    ///
    /// # Errors
    /// [`LsystemError`] with the line.
    pub fn parse(text: &str) -> Result<Self, LsystemError> {
        Self::parse_at(text, 1.0)
    }

    /// As [`Self::parse`], for a plant at a share of its life, 0 to 1, which rules with `ages = rules` read as `life`.
    ///
    /// # Errors
    /// [`LsystemError`] with the line.
    pub fn parse_at(text: &str, life: f64) -> Result<Self, LsystemError> {
        let mut system = Self {
            axiom: Vec::new(),
            rules: Vec::new(),
            steps: 5,
            angle_deg: 25.0,
            length_m: 0.2,
            width_m: 0.0,
            tropism: (DVec3::NEG_Y, 0.0),
            ages: Ages::Whole,
        };
        let mut constants: Vec<(String, f64)> = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.is_empty() {
                continue;
            }
            let fault = |why| LsystemError::Syntax { line: number + 1, why };
            if let Some((left, right)) = line.split_once("->") {
                let rule =
                    read_rule(left.trim(), right.trim(), line, number + 1, &constants).map_err(fault)?;
                system.rules.push(rule);
            } else if let Some((name, value)) = line.split_once('=') {
                system.set(name.trim(), value.trim(), life, &mut constants).map_err(fault)?;
            } else {
                return Err(fault(RuleFault::NoStatement));
            }
        }
        if system.axiom.is_empty() {
            return Err(LsystemError::NoAxiom);
        }
        Ok(system)
    }

    fn set(
        &mut self,
        name: &str,
        value: &str,
        life: f64,
        constants: &mut Vec<(String, f64)>,
    ) -> Result<(), RuleFault> {
        let number = |name, least: f64, most: f64| {
            let value = evaluate(value, constants)?;
            if (least..=most).contains(&value) {
                Ok(value)
            } else {
                Err(RuleFault::Range { name, least, most, value })
            }
        };
        match name {
            "axiom" => self.axiom = read_modules(value, &[], constants)?,
            "steps" => {
                let n = number("steps", 0.0, f64::from(MOST_STEPS))?;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "0 to a thousand"
                )]
                let n = n as u32;
                self.steps = n;
            }
            "angle" => self.angle_deg = number("angle", -360.0, 360.0)?,
            "length" => self.length_m = number("length", 0.0, 1e4)?,
            "width" => self.width_m = number("width", 0.0, 100.0)?,
            "ages" if value == "steps" => self.ages = Ages::Steps,
            "ages" if value == "rules" => {
                self.ages = Ages::Rules;
                constants.push((LIFE.to_owned(), life.clamp(0.0, 1.0)));
            }
            "tropism" => {
                let c: Vec<f64> =
                    value.split_whitespace().map(|w| evaluate(w, constants)).collect::<Result<_, _>>()?;
                let &[x, y, z, strength] = c.as_slice() else {
                    return Err(RuleFault::TropismNumbers);
                };
                let direction = DVec3::new(x, y, z).try_normalize();
                self.tropism = (direction.ok_or(RuleFault::TropismDirection)?, strength);
                if !strength.is_finite() {
                    return Err(RuleFault::TropismStrength);
                }
            }
            _ => {
                let Some(name) = name.strip_prefix("let ").map(str::trim) else {
                    return Err(RuleFault::NoSetting(base::quoted(name)));
                };
                let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
                if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || !name.chars().all(word) {
                    return Err(RuleFault::NoName(base::quoted(name)));
                }
                let x = evaluate(value, constants)?;
                constants.push((name.to_owned(), x));
            }
        }
        Ok(())
    }
}

/// Evaluates a constant expression.
fn evaluate(text: &str, constants: &[(String, f64)]) -> Result<f64, RuleFault> {
    let mut reader = Reader::new(text, &[], constants);
    let e = reader.expression()?;
    reader.skip_space();
    if reader.at < text.len() {
        return Err(RuleFault::LeftOver(base::quoted(&text[reader.at..])));
    }
    let x = e.value(&[], base::Seed::new(0), &mut Vec::new());
    if x.is_finite() { Ok(x) } else { Err(RuleFault::NotFinite(base::quoted(text))) }
}

fn read_rule(
    left: &str,
    right: &str,
    text: &str,
    line: usize,
    constants: &[(String, f64)],
) -> Result<Rule, RuleFault> {
    let symbol = *left.as_bytes().first().ok_or(RuleFault::NoPredecessor)?;
    if !symbol.is_ascii_graphic() || RESERVED.contains(&symbol) {
        return Err(RuleFault::NotRewritten(base::quoted(left)));
    }
    let mut rest = left[1..].trim_start();
    let mut parameters = Vec::new();
    if let Some(inner) = rest.strip_prefix('(') {
        let (names, after) = inner.split_once(')').ok_or(RuleFault::NotClosed(')'))?;
        parameters = names.split(',').map(|n| n.trim().to_owned()).collect();
        rest = after.trim_start();
        let word = |n: &String| {
            n.starts_with(|c: char| c.is_ascii_alphabetic())
                && n.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        if !parameters.iter().all(word) || parameters.len() > MOST_PARAMETERS {
            return Err(RuleFault::Parameters { names: base::quoted(names), most: MOST_PARAMETERS });
        }
    }
    let mut condition = None;
    if let Some(after) = rest.strip_prefix("if ") {
        let (test, chance) = after.split_once(" prob ").map_or((after, ""), |(a, b)| (a, b));
        let mut reader = Reader::new(test, &parameters, constants);
        condition = Some(reader.expression()?);
        reader.skip_space();
        if reader.at < test.len() {
            return Err(RuleFault::LeftOver(base::quoted(&test[reader.at..])));
        }
        rest = chance;
    } else if let Some(after) = rest.strip_prefix("prob ") {
        rest = after;
    } else if !rest.is_empty() {
        return Err(RuleFault::NoArrow(base::quoted(rest)));
    }
    let chance = if rest.is_empty() { 1.0 } else { evaluate(rest, constants)? };
    if !(0.0..=1e6).contains(&chance) {
        return Err(RuleFault::Chance(chance));
    }
    let successor = read_modules(right, &parameters, constants)?;
    Ok(Rule { text: base::quoted(text), line, symbol, arity: parameters.len(), condition, chance, successor })
}

fn read_modules(
    text: &str,
    parameters: &[String],
    constants: &[(String, f64)],
) -> Result<Vec<Written>, RuleFault> {
    let mut modules = Vec::new();
    let mut reader = Reader::new(text, parameters, constants);
    let mut open = 0_usize;
    loop {
        reader.skip_space();
        let Some(&symbol) = text.as_bytes().get(reader.at) else { break };
        if !symbol.is_ascii_graphic() || b"(),;".contains(&symbol) {
            return Err(RuleFault::NoModule(char::from(symbol)));
        }
        reader.at += 1;
        match symbol {
            b'[' => open += 1,
            b']' => open = open.checked_sub(1).ok_or(RuleFault::NotOpened)?,
            _ => {}
        }
        let mut arguments = Vec::new();
        // A parenthesis belongs to a module only if it follows immediately.
        if text.as_bytes().get(reader.at) == Some(&b'(') {
            reader.at += 1;
            loop {
                arguments.push(reader.expression()?);
                if reader.take(")") {
                    break;
                }
                if !reader.take(",") || arguments.len() >= MOST_PARAMETERS {
                    return Err(RuleFault::NotClosed(')'));
                }
            }
        }
        modules.push(Written { symbol, arguments });
    }
    if open > 0 { Err(RuleFault::NotClosed(']')) } else { Ok(modules) }
}
