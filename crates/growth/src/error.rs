//! Errors of growth.

use base::Cancelled;

/// Reason why nothing could be grown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GrowthError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A limit of the budget was exceeded.
    #[error(transparent)]
    OverBudget(#[from] base::OverBudget),
    /// The light of the sky on buds cannot be computed.
    #[error("the light of the sky on the buds cannot be computed: {why}")]
    Light {
        /// Why.
        why: String,
    },
    /// A step is much longer than the whole tree.
    #[error(
        "steps of {step_m} m (step_m, or half of kill_m) are far longer than roots and attraction points are apart, \
         {space_m} m; make steps or kill_m shorter, or the envelope larger"
    )]
    StepTooLong {
        /// The step, metres.
        step_m: f64,
        /// Diagonal of the box around roots and points, metres, to a millimetre.
        space_m: f64,
    },
    /// A number of the spec is out of the range in its schema.
    #[error(transparent)]
    Range(#[from] spec::RangeFault),
    /// A part of the spec contradicts the rest, or is not a position or direction.
    #[error("{field} must be {range}, not {value}")]
    Field {
        /// The field.
        field: &'static str,
        /// The valid range.
        range: &'static str,
        /// The value given.
        value: f64,
    },
    /// The age lies beyond the life span, where it would change nothing.
    #[error("age must be 1 to {end}, not {age}: the life of {name} that is grown ends there")]
    BeyondLife {
        /// The species, or the name of the tree.
        name: String,
        /// The last age, in the spec's unit of age.
        end: u32,
        /// The age given.
        age: u32,
    },
    /// There is no root to grow from.
    #[error("nothing to grow from: no roots were given")]
    NoRoots,
    /// A root is not a finite point.
    #[error("root {} is not a finite point within 1e6 m of the origin", .root + 1)]
    Root {
        /// Its index.
        root: usize,
    },
    /// A root stands in an obstacle.
    #[error("root {} stands inside obstacle {} ({name}); move one of them", .root + 1, .obstacle + 1)]
    RootInObstacle {
        /// Index of the root.
        root: usize,
        /// Index of the obstacle.
        obstacle: usize,
        /// The word of its shape, or its name.
        name: String,
    },
    /// An obstacle is invalid.
    #[error("obstacle {} ({name}): {fault}", .obstacle + 1)]
    Obstacle {
        /// Its index.
        obstacle: usize,
        /// The word of its shape, its file, or its name.
        name: String,
        /// The fault.
        fault: Box<Self>,
    },
    /// Nothing grew.
    #[error("nothing grew: {why}")]
    Nothing {
        /// The cause, and the remedy.
        why: String,
    },
    /// The mesh cannot bound a volume.
    #[error("mesh: {0}")]
    Mesh(#[from] SolidFault),
    /// The rules of an L-system are invalid.
    #[error(transparent)]
    Lsystem(#[from] LsystemError),
    /// The envelope has hardly any room for attractors.
    #[error(
        "the envelope is empty or almost so: {found} of {wanted} points found a place in {tries} tries; \
         make it larger or free it of obstacles"
    )]
    NoRoom {
        /// Points placed.
        found: usize,
        /// Points wanted.
        wanted: usize,
        /// Points tried.
        tries: usize,
    },
}

/// Fault of a mesh that should bound a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SolidFault {
    /// No triangle with an area.
    #[error("it has no triangle with an area")]
    Empty,
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are {vertices}")]
    Index {
        /// The triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A vertex is not a finite point.
    #[error("vertex {vertex} is not a finite point within 1e6 m of the origin")]
    Vertex {
        /// The vertex.
        vertex: usize,
    },
}

/// Largest distance from the origin at which anything grows: 1e6 m leaves a tenth of a nanometre of resolution.
pub(crate) const FAR_M: f64 = 1e6;

/// Fails unless `value` lies in `lo..=hi`.
pub(crate) fn within(
    field: &'static str,
    value: f64,
    lo: f64,
    hi: f64,
    range: &'static str,
) -> Result<f64, GrowthError> {
    if (lo..=hi).contains(&value) { Ok(value) } else { Err(GrowthError::Field { field, range, value }) }
}

/// Fault of an L-system.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LsystemError {
    /// A line cannot be read.
    #[error("line {line}: {why}")]
    Syntax {
        /// The line, from 1.
        line: usize,
        /// The fault.
        why: RuleFault,
    },
    /// There is no axiom.
    #[error("there is no axiom: a line `axiom = ...` is needed")]
    NoAxiom,
    /// The string grows beyond all limits.
    #[error(
        "the rule `{rule}` in line {line} lets the string explode: in step {step} it had written {made} modules when \
         the limit of {most} was passed; take fewer steps or a condition that ends it"
    )]
    TooLarge {
        /// The rule that wrote the most modules.
        rule: String,
        /// Its line, from 1.
        line: usize,
        /// The step of rewriting.
        step: u32,
        /// Modules that it wrote in this step.
        made: usize,
        /// The limit.
        most: usize,
    },
    /// No rule ever had a module to rewrite.
    #[error(
        "nothing grew: no rule matches a module in any step. There is {}; the rules are for {}. A rule \
         matches a module of its name with as many numbers as it has parameters, where its `if` holds",
        listed(there),
        listed(rules)
    )]
    NoMatch {
        /// The modules that remained, with their counts of numbers.
        there: Vec<(char, usize)>,
        /// The modules that the rules match.
        rules: Vec<(char, usize)>,
    },
    /// A number of a module is not finite.
    #[error("the rule `{rule}` in line {line} gives a number that is not finite")]
    NotFinite {
        /// The rule.
        rule: String,
        /// Its line, from 1; 0 for the axiom.
        line: usize,
    },
}

/// Fault of a line of an L-system. Texts that it quotes are cut ([`base::quoted`]).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RuleFault {
    /// It is not a known statement.
    #[error("neither a setting (name = value) nor a rule (A -> B)")]
    NoStatement,
    /// There is no such setting.
    #[error("`{0}` is no setting; constants are written `let {0} = ...`")]
    NoSetting(String),
    /// A constant cannot have this name.
    #[error("`{0}` is no name")]
    NoName(String),
    /// A setting is out of its range.
    #[error("{name} must be {least} to {most}, not {value}")]
    Range {
        /// The setting.
        name: &'static str,
        /// The least value.
        least: f64,
        /// The greatest value.
        most: f64,
        /// The value given.
        value: f64,
    },
    /// The tropism has a wrong count of numbers.
    #[error("tropism needs four numbers: x y z strength")]
    TropismNumbers,
    /// The tropism points nowhere.
    #[error("tropism needs a direction with a length")]
    TropismDirection,
    /// The tropism's strength is not finite.
    #[error("the strength of tropism is no finite number")]
    TropismStrength,
    /// There is extra text.
    #[error("`{0}` is left over")]
    LeftOver(String),
    /// It has no finite value.
    #[error("`{0}` is no finite number")]
    NotFinite(String),
    /// Nothing stands before the arrow.
    #[error("a rule needs a module before ->")]
    NoPredecessor,
    /// Brackets and symbols of the grammar cannot be rewritten.
    #[error("`{0}` is no module that can be rewritten")]
    NotRewritten(String),
    /// An opening bracket is not closed.
    #[error("a {0} is missing")]
    NotClosed(char),
    /// A closing bracket was not opened.
    #[error("a ] without its [")]
    NotOpened,
    /// The parameters are not names, or too many.
    #[error("`{names}`: up to {most} names were expected")]
    Parameters {
        /// The text in their place.
        names: String,
        /// The largest count.
        most: usize,
    },
    /// Something unexpected stands before the arrow.
    #[error("`{0}`: `if`, `prob` or -> was expected")]
    NoArrow(String),
    /// A probability is below 0, or far too large.
    #[error("prob must be 0 or more, not {0}")]
    Chance(f64),
    /// A character is not a module.
    #[error("`{0}` is no module")]
    NoModule(char),
    /// Parentheses and operators are nested too deeply.
    #[error("nested more than {0} deep")]
    TooDeep(usize),
    /// Digits and dots do not form a number.
    #[error("`{0}` is no number")]
    NoNumber(String),
    /// An expression continues with something unexpected.
    #[error("a number or name was expected, not `{0}`")]
    NoOperand(char),
    /// An expression ends too early.
    #[error("a number or name was expected, not the end")]
    Ends,
    /// A name is unknown.
    #[error("`{0}` is no parameter, constant or function")]
    Unknown(String),
    /// A function lacks its parentheses.
    #[error("`{0}` is a function: it needs ( and )")]
    NotCalled(&'static str),
    /// A function has a wrong count of arguments.
    #[error("`{name}` needs {numbers} number{} and a )", if *numbers == 1 { "" } else { "s" })]
    Call {
        /// The function.
        name: &'static str,
        /// Number of its arguments.
        numbers: usize,
    },
    /// A draw has too few or too many quantiles.
    #[error("`drawn` needs 2 to {most} numbers, not {count}")]
    Quantiles {
        /// Number of quantiles.
        count: usize,
        /// The largest number.
        most: usize,
    },
}

/// Lists modules for a sentence.
fn listed(modules: &[(char, usize)]) -> String {
    let one = |(symbol, numbers): &(char, usize)| match numbers {
        0 => format!("{symbol} with no number"),
        1 => format!("{symbol} with 1 number"),
        _ => format!("{symbol} with {numbers} numbers"),
    };
    modules.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Lists modules in a notation without words: `A, B(_, _)`.
fn signatures(modules: &[(char, usize)]) -> String {
    let one = |(symbol, numbers): &(char, usize)| match numbers {
        0 => symbol.to_string(),
        n => format!("{symbol}({})", vec!["_"; *n].join(", ")),
    };
    modules.iter().map(one).collect::<Vec<_>>().join(", ")
}

impl LsystemError {
    /// Returns the same error for rules that start in line `first` of a longer text: its lines count from the start of
    /// that.
    #[must_use]
    pub fn from_line(mut self, first: usize) -> Self {
        if let Self::Syntax { line, .. } | Self::TooLarge { line, .. } | Self::NotFinite { line, .. } =
            &mut self
            && *line > 0
        {
            *line += first - first.min(1);
        }
        self
    }
}

/// Whether a point is finite and not absurdly far away.
pub(crate) fn usable(p: glam::DVec3) -> bool {
    p.is_finite() && p.abs().max_element() <= FAR_M
}

base::coded!(GrowthError {
    Self::StepTooLong { step_m, space_m } => "step-too-long" { step_m, space_m },
    Self::Field { field, range, value } => "field-range" { field, range, value },
    Self::BeyondLife { name, end, age } => "age-beyond" { name, end, age },
    Self::NoRoots => "no-roots" {},
    Self::Root { root } => "root-far" { root = root + 1 },
    Self::RootInObstacle { root, obstacle, name } => "root-in-obstacle" { root = root + 1, obstacle = obstacle + 1, name },
    Self::Obstacle { name, fault, .. } => "obstacle" { name, why = fault => GrowthError },
    Self::Nothing { why } => "nothing-grew" { why },
    Self::Light { why } => "growth-light" { why },
    Self::Mesh(why) => "mesh" { why => SolidFault },
    Self::NoRoom { found, wanted, .. } => "no-room" { found, wanted },
} wraps {
    Self::Range(e) => e, spec::RangeFault;
    Self::Lsystem(e) => e, LsystemError;
    Self::Cancelled(e) => e, Cancelled;
    Self::OverBudget(e) => e, base::OverBudget;
});

base::coded!(SolidFault {
    Self::Empty => "mesh-empty" {},
    Self::Index { triangle, vertex, vertices } => "mesh-index" { triangle, vertex, vertices },
    Self::Vertex { vertex } => "mesh-vertex" { vertex },
});

base::coded!(LsystemError {
    Self::Syntax { line, why } => "lsystem-line" { line, why => RuleFault },
    Self::NoAxiom => "lsystem-no-axiom" {},
    Self::TooLarge { rule, line, step, made, most } => "lsystem-too-large" { rule, line, step, made, most },
    Self::NoMatch { there, rules } => "lsystem-no-match" { there = signatures(there), rules = signatures(rules) },
    Self::NotFinite { rule, line } => "lsystem-not-finite" { rule, line },
});

base::coded!(RuleFault {
    Self::NoStatement => "rule-no-statement" {},
    Self::NoSetting(name) => "rule-no-setting" { name },
    Self::NoName(name) => "rule-no-name" { name },
    Self::Range { name, least, most, value } => "rule-range" { name, least, most, value },
    Self::TropismNumbers => "rule-tropism-numbers" {},
    Self::TropismDirection => "rule-tropism-direction" {},
    Self::TropismStrength => "rule-tropism-strength" {},
    Self::LeftOver(text) => "rule-left-over" { text },
    Self::NotFinite(text) => "rule-not-finite" { text },
    Self::NoPredecessor => "rule-no-predecessor" {},
    Self::NotRewritten(text) => "rule-not-rewritten" { text },
    Self::NotClosed(mark) => "rule-not-closed" { mark },
    Self::NotOpened => "rule-not-opened" {},
    Self::Parameters { names, most } => "rule-parameters" { names, most },
    Self::NoArrow(text) => "rule-no-arrow" { text },
    Self::Chance(value) => "rule-chance" { value },
    Self::NoModule(mark) => "rule-no-module" { mark },
    Self::TooDeep(most) => "rule-too-deep" { most },
    Self::NoNumber(text) => "rule-no-number" { text },
    Self::NoOperand(mark) => "rule-no-operand" { mark },
    Self::Ends => "rule-ends" {},
    Self::Unknown(name) => "rule-unknown" { name },
    Self::NotCalled(name) => "rule-not-called" { name },
    Self::Call { name, numbers } => "rule-call" { name, numbers },
    Self::Quantiles { count, most } => "rule-quantiles" { count, most },
});
