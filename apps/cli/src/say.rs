//! Lines for people. A closed pipe is no error.

use std::io::{IsTerminal, Write, stderr, stdout};

/// A line on stdout.
pub(crate) fn line(text: &str) {
    let _ = writeln!(stdout(), "{text}");
}

/// `error: ...` on stderr; line breaks inside become spaces.
pub(crate) fn error(text: &str) {
    tagged("error", "31;1", text);
}

/// `warning: ...` on stderr; line breaks inside become spaces.
pub(crate) fn warning(text: &str) {
    tagged("warning", "33;1", text);
}

fn tagged(tag: &str, color: &str, text: &str) {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut out = stderr().lock();
    let plain = !out.is_terminal() || std::env::var_os("NO_COLOR").is_some();
    let _ = if plain {
        writeln!(out, "{tag}: {text}")
    } else {
        writeln!(out, "\x1b[{color}m{tag}:\x1b[0m {text}")
    };
}

/// 1234567 as `1,234,567`.
pub(crate) fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

/// `1 leaf`, `2 leaves`.
pub(crate) fn counted(n: u64, one: &str, many: &str) -> String {
    format!("{} {}", grouped(n), if n == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    #[test]
    fn thousands_are_grouped() {
        let got = [0, 999, 1000, 1_234_567].map(super::grouped);
        assert_eq!(got, ["0", "999", "1,000", "1,234,567"]);
    }
}
