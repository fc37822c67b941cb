//! Refusal of results that nobody would accept, and with --strict of those that somebody might not.

use burgeon::{CheckReport, ItemReport, SeverityWord};

use crate::args::CheckArgs;
use crate::failure::{Failure, Outcome};

/// Fails on the first check that rules an item out; nothing is written then.
pub(crate) fn accept(items: &[ItemReport], args: &CheckArgs) -> Outcome {
    let refused = items.iter().find_map(|item| Some((item, item.refusal(args.strict)?)));
    let Some((item, check)) = refused else { return Ok(()) };
    let strict = if check.severity == SeverityWord::Error { "" } else { " (--strict)" };
    Err(Failure::Bad(format!("{}: {}{strict}", item.name, sentence(check))))
}

/// Returns the sentence of a failed check.
pub(crate) fn sentence(check: &CheckReport) -> String {
    format!("{}: {}", check.message, check.advice)
}
