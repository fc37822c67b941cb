//! `cargo xtask layers`: a test that is skipped reports it where people see it.

use crate::bare_numbers::{packages, sources};
use xtask::shell::{Outcome, repository, say};

/// Output that libtest captures for a passing test, so that nobody reads it.
const UNSEEN: [&str; 2] = ["println!(\"skip", "eprintln!(\"skip"];

/// Fails if a source of `crates` or `apps` reports a skipped test in such output.
pub(crate) fn check() -> Outcome {
    let mut faults = Vec::new();
    for folder in packages()?.iter().flat_map(|p| [p.join("src"), p.join("tests")]).filter(|f| f.is_dir()) {
        for file in sources(&folder)? {
            let text = std::fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
            let place = file.strip_prefix(repository()).unwrap_or(&file).display();
            faults.extend(unseen(&text).map(|line| format!("{place}:{line}")));
        }
    }
    if faults.is_empty() {
        say("skips: every test that is skipped says so where it is seen");
        return Ok(());
    }
    Err(format!(
        "what a test that passes prints is captured; say by `skipped` of crates/base/tests/missing that it was skipped:\n  {}",
        faults.join("\n  ")
    ))
}

/// Returns the numbers of the lines, from 1.
fn unseen(text: &str) -> impl Iterator<Item = usize> {
    let of_line = |(k, line): (usize, &str)| UNSEEN.iter().any(|u| line.contains(u)).then_some(k + 1);
    text.lines().enumerate().filter_map(of_line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_skip_that_is_captured_is_found() {
        let macros = ["print", "eprint"].map(|m| format!("let x = 1;\n    {m}ln!(\"skipped: {{x}}\");\n"));
        for text in macros {
            assert_eq!(unseen(&text).collect::<Vec<_>>(), [2], "{text}");
        }
        assert_eq!(unseen("println!(\"3 skipped\");\nmissing::skipped(folder);\n").count(), 0);
    }
}
