//! Results that nobody would accept, and with --strict those that somebody would not.

use burgeon::{CheckReport, ItemReport, SeverityWord};

use crate::args::CheckArgs;
use crate::failure::{Failure, Outcome};

/// Fails on the first check that makes an item no result; nothing is written then.
pub(crate) fn accept(items: &[ItemReport], args: &CheckArgs) -> Outcome {
    let refused = items.iter().find_map(|item| Some((item, item.refusal(args.strict)?)));
    let Some((item, check)) = refused else { return Ok(()) };
    let strict = if check.severity == SeverityWord::Error { "" } else { " (--strict)" };
    Err(Failure::Bad(format!("{}: {}{strict}", item.name, sentence(check))))
}

/// What a check that failed says.
pub(crate) fn sentence(check: &CheckReport) -> String {
    format!("{}: {}", check.message, check.advice)
}
