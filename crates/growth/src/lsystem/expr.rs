//! Arithmetic in rules: text to postfix code to number.

use base::ops;
use base::{Draw, Seed};

use crate::error::RuleFault;

/// Deepest nesting of parentheses and operators: more is a mistake or an attack.
const DEEPEST: usize = 64;

/// One step of postfix code.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Op {
    Number(f64),
    /// A parameter of the predecessor.
    Parameter(usize),
    Negate,
    Not,
    Binary(Binary),
    Call(Function),
    /// A draw from this number of quantiles at even shares, the least first.
    Drawn(usize),
}

/// Most quantiles of one draw: more make no visible difference in trees.
const MOST_QUANTILES: usize = 64;
/// The name of a draw from quantiles.
const DRAWN: &str = "drawn";

#[derive(Clone, Copy, Debug, PartialEq)]
enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    Sin,
    Cos,
    Sqrt,
    Abs,
    Floor,
    Min,
    Max,
    /// Uniform between two numbers.
    Rand,
    /// Normal with mean and deviation.
    Normal,
}

impl Function {
    const ALL: [(&'static str, Self, usize); 9] = [
        ("sin", Self::Sin, 1),
        ("cos", Self::Cos, 1),
        ("sqrt", Self::Sqrt, 1),
        ("abs", Self::Abs, 1),
        ("floor", Self::Floor, 1),
        ("min", Self::Min, 2),
        ("max", Self::Max, 2),
        ("rand", Self::Rand, 2),
        ("normal", Self::Normal, 2),
    ];
}

/// A compiled expression.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Expression(Vec<Op>);

impl Expression {
    /// Returns its value; NaN if it cannot be computed. `seed` feeds `rand` and `normal`.
    pub(super) fn value(&self, parameters: &[f64], seed: Seed, stack: &mut Vec<f64>) -> f64 {
        stack.clear();
        let mut draws = 0;
        let truth = |b: bool| f64::from(u8::from(b));
        for op in &self.0 {
            let value = match *op {
                Op::Number(x) => x,
                Op::Parameter(i) => parameters.get(i).copied().unwrap_or(f64::NAN),
                Op::Negate => -stack.pop().unwrap_or(f64::NAN),
                Op::Not => truth(stack.pop().unwrap_or(f64::NAN) == 0.0),
                Op::Binary(o) => {
                    let (b, a) = (stack.pop().unwrap_or(f64::NAN), stack.pop().unwrap_or(f64::NAN));
                    match o {
                        Binary::Add => a + b,
                        Binary::Subtract => a - b,
                        Binary::Multiply => a * b,
                        Binary::Divide => a / b,
                        Binary::Power => ops::powf(a, b),
                        Binary::Less => truth(a < b),
                        Binary::LessEqual => truth(a <= b),
                        Binary::Greater => truth(a > b),
                        Binary::GreaterEqual => truth(a >= b),
                        Binary::Equal => truth((a - b).abs() <= 1e-12 * a.abs().max(b.abs())),
                        Binary::NotEqual => truth((a - b).abs() > 1e-12 * a.abs().max(b.abs())),
                        Binary::And => truth(a != 0.0 && b != 0.0),
                        Binary::Or => truth(a != 0.0 || b != 0.0),
                    }
                }
                Op::Drawn(count) => {
                    draws += 1;
                    let from = stack.len().saturating_sub(count);
                    let at = seed.child(draws).stream(Draw::Size).range(0.0, (count - 1) as f64);
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "0 to the quantiles"
                    )]
                    let low = from + at as usize;
                    let [a, b] = [low, low + 1].map(|k| stack.get(k).copied().unwrap_or(f64::NAN));
                    stack.truncate(from);
                    ops::lerp(a, b, at - at.floor())
                }
                Op::Call(f) => {
                    let two = matches!(f, Function::Min | Function::Max | Function::Rand | Function::Normal);
                    let b = if two { stack.pop().unwrap_or(f64::NAN) } else { 0.0 };
                    let a = stack.pop().unwrap_or(f64::NAN);
                    draws += 1;
                    let stream = || seed.child(draws).stream(Draw::Size);
                    match f {
                        Function::Sin => ops::sin(a * (ops::PI / 180.0)),
                        Function::Cos => ops::cos(a * (ops::PI / 180.0)),
                        Function::Sqrt => a.sqrt(),
                        Function::Abs => a.abs(),
                        Function::Floor => a.floor(),
                        Function::Min => a.min(b),
                        Function::Max => a.max(b),
                        Function::Rand => stream().range(a, b),
                        Function::Normal => a + b * stream().normal(),
                    }
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(f64::NAN)
    }
}

/// Reads an expression from the front of a text.
pub(super) struct Reader<'a> {
    text: &'a [u8],
    pub(super) at: usize,
    /// Names of parameters, then constants.
    parameters: &'a [String],
    constants: &'a [(String, f64)],
    code: Vec<Op>,
    depth: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(text: &'a str, parameters: &'a [String], constants: &'a [(String, f64)]) -> Self {
        Self { text: text.as_bytes(), at: 0, parameters, constants, code: Vec::new(), depth: 0 }
    }

    /// Reads one expression, up to a character that cannot belong to it.
    pub(super) fn expression(&mut self) -> Result<Expression, RuleFault> {
        self.code.clear();
        self.level(0)?;
        Ok(Expression(core::mem::take(&mut self.code)))
    }

    pub(super) fn skip_space(&mut self) {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    pub(super) fn take(&mut self, what: &str) -> bool {
        self.skip_space();
        let found = self.text[self.at..].starts_with(what.as_bytes());
        self.at += if found { what.len() } else { 0 };
        found
    }

    /// Reads operators by rising precedence: or, and, comparisons, sums, products; powers associate to the right.
    fn level(&mut self, level: usize) -> Result<(), RuleFault> {
        const LEVELS: [&[(&str, Binary)]; 5] = [
            &[("||", Binary::Or)],
            &[("&&", Binary::And)],
            &[
                ("<=", Binary::LessEqual),
                (">=", Binary::GreaterEqual),
                ("==", Binary::Equal),
                ("!=", Binary::NotEqual),
                ("<", Binary::Less),
                (">", Binary::Greater),
            ],
            &[("+", Binary::Add), ("-", Binary::Subtract)],
            &[("*", Binary::Multiply), ("/", Binary::Divide)],
        ];
        let Some(operators) = LEVELS.get(level) else { return self.power() };
        self.level(level + 1)?;
        loop {
            self.skip_space();
            // The arrow of a rule does not start with a minus sign.
            if self.text[self.at..].starts_with(b"->") {
                return Ok(());
            }
            let Some((_, op)) = operators.iter().find(|(name, _)| self.take(name)) else { return Ok(()) };
            self.level(level + 1)?;
            self.code.push(Op::Binary(*op));
        }
    }

    fn power(&mut self) -> Result<(), RuleFault> {
        self.unary()?;
        if self.take("^") {
            self.deeper()?;
            self.power()?;
            self.depth -= 1;
            self.code.push(Op::Binary(Binary::Power));
        }
        Ok(())
    }

    fn deeper(&mut self) -> Result<(), RuleFault> {
        self.depth += 1;
        if self.depth > DEEPEST { Err(RuleFault::TooDeep(DEEPEST)) } else { Ok(()) }
    }

    fn unary(&mut self) -> Result<(), RuleFault> {
        let sign = if self.take("-") {
            Some(Op::Negate)
        } else if self.take("!") {
            Some(Op::Not)
        } else {
            None
        };
        if let Some(op) = sign {
            self.deeper()?;
            self.unary()?;
            self.depth -= 1;
            self.code.push(op);
            return Ok(());
        }
        if self.take("(") {
            self.deeper()?;
            self.level(0)?;
            self.depth -= 1;
            return if self.take(")") { Ok(()) } else { Err(RuleFault::NotClosed(')')) };
        }
        self.skip_space();
        let rest = &self.text[self.at..];
        let word = |ok: fn(&u8) -> bool| rest.iter().take_while(|c| ok(c)).count();
        let mut number = word(|c| c.is_ascii_digit() || *c == b'.');
        if number > 0 {
            // An exponent belongs to the number if digits follow it.
            let power = rest[number..].strip_prefix(b"e").or_else(|| rest[number..].strip_prefix(b"E"));
            if let Some(power) = power {
                let sign = usize::from(power.first().is_some_and(|c| b"+-".contains(c)));
                let digits = power[sign..].iter().take_while(|c| c.is_ascii_digit()).count();
                number += if digits > 0 { 1 + sign + digits } else { 0 };
            }
            let text = core::str::from_utf8(&rest[..number]).unwrap_or_default();
            let no_number = |_: core::num::ParseFloatError| RuleFault::NoNumber(base::quoted(text));
            let value = text.parse().map_err(no_number)?;
            self.code.push(Op::Number(value));
            self.at += number;
            return Ok(());
        }
        let letters = word(|c| c.is_ascii_alphanumeric() || *c == b'_');
        let name = core::str::from_utf8(&rest[..letters]).unwrap_or_default().to_owned();
        if name.is_empty() {
            return Err(rest.first().map_or(RuleFault::Ends, |c| RuleFault::NoOperand(char::from(*c))));
        }
        self.at += letters;
        self.name(&name)
    }

    /// Reads the arguments of [`DRAWN`], at least two.
    fn quantiles(&mut self) -> Result<(), RuleFault> {
        if !self.take("(") {
            return Err(RuleFault::NotCalled(DRAWN));
        }
        self.deeper()?;
        let mut count = 0;
        while count == 0 || self.take(",") {
            self.level(0)?;
            count += 1;
        }
        self.depth -= 1;
        if !self.take(")") {
            return Err(RuleFault::NotClosed(')'));
        }
        if !(2..=MOST_QUANTILES).contains(&count) {
            return Err(RuleFault::Quantiles { count, most: MOST_QUANTILES });
        }
        self.code.push(Op::Drawn(count));
        Ok(())
    }

    fn name(&mut self, name: &str) -> Result<(), RuleFault> {
        if let Some(i) = self.parameters.iter().position(|p| p == name) {
            self.code.push(Op::Parameter(i));
            return Ok(());
        }
        if let Some((_, value)) = self.constants.iter().find(|(n, _)| n == name) {
            self.code.push(Op::Number(*value));
            return Ok(());
        }
        if name == DRAWN {
            return self.quantiles();
        }
        let Some((name, function, numbers)) = Function::ALL.into_iter().find(|(n, ..)| *n == name) else {
            return Err(RuleFault::Unknown(base::quoted(name)));
        };
        let call = RuleFault::Call { name, numbers };
        if !self.take("(") {
            return Err(RuleFault::NotCalled(name));
        }
        self.deeper()?;
        for i in 0..numbers {
            if i > 0 && !self.take(",") {
                return Err(call);
            }
            self.level(0)?;
        }
        self.depth -= 1;
        if !self.take(")") {
            return Err(call);
        }
        self.code.push(Op::Call(function));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<f64, String> {
        let (parameters, constants) = (["x".to_owned()], [("k".to_owned(), 5.0)]);
        let mut reader = Reader::new(text, &parameters, &constants);
        let e = reader.expression().map_err(|e| e.to_string())?;
        reader.skip_space();
        if reader.at < text.len() {
            return Err(format!("rest: {}", &text[reader.at..]));
        }
        Ok(e.value(&[3.0], Seed::new(1), &mut Vec::new()))
    }

    #[test]
    fn arithmetic_is_as_in_school() {
        for (text, want) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("-x ^ 2 + k", 14.0),
            ("8 / 2 / 2", 2.0),
            ("x > 2 && !(k < 5) || 0", 1.0),
            ("x == 3", 1.0),
            ("0.1 + 0.2 != 0.3", 0.0),
            ("1e-1 + 2.5E+3 - 1e2", 2400.1),
            ("2e0 - 1.e1", -8.0),
            ("min(x, k) - max(1, 2)", 1.0),
            ("sqrt(16) + abs(0 - 2) + floor(2.9)", 8.0),
        ] {
            assert_eq!(value(text), Ok(want), "{text}");
        }
        assert!(value("sin(90)").is_ok_and(|v| (v - 1.0).abs() < 1e-15));
        let drawn = value("rand(2, 3)").expect("sound");
        assert!((2.0..3.0).contains(&drawn) && value("rand(2, 3)") == Ok(drawn));
        assert_ne!(value("rand(2, 3) - rand(2, 3)"), Ok(0.0), "two draws are two");
        let drawn = value("drawn(2, 3, 10)").expect("sound");
        assert!((2.0..10.0).contains(&drawn) && value("drawn(2, 3, 10)") == Ok(drawn));
        assert_eq!(value("drawn(4, 2 * 2, k - 1) + 1"), Ok(5.0));
        assert!(value("drawn(4)").is_err_and(|e| e.contains("2 to 64")) && value("drawn(1, 2").is_err());
    }

    #[test]
    fn slips_are_named() {
        for (text, part) in [
            ("1 +", "the end"),
            ("y * 2", "`y` is no parameter"),
            ("sin 3", "needs ("),
            ("max(1)", "needs 2"),
            ("(1", ") is missing"),
            ("1..2", "1..2"),
            ("2e", "rest: e"),
            ("2e+x", "rest: e+x"),
        ] {
            assert!(value(text).is_err_and(|e| e.contains(part)), "{text}: {:?}", value(text));
        }
        assert!(value(&"(".repeat(100_000)).is_err_and(|e| e.contains("deep")));
        assert!(value(&"-".repeat(100_000)).is_err_and(|e| e.contains("deep")));
        assert!(value(&"2^".repeat(100_000)).is_err_and(|e| e.contains("deep")));
    }
}
