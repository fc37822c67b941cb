//! Lines for people. A closed pipe is no error.

use std::io::{self, IsTerminal, Write, stderr, stdout};

/// A line on stdout for people; what stands in names of files and drawings cannot steer the terminal.
pub(crate) fn line(text: &str) {
    let _ = writeln!(stdout(), "{}", printable(text));
}

/// Text for other programs on stdout: that it did not arrive is an error, but for a reader that went away.
pub(crate) fn data(text: &str) -> io::Result<()> {
    let mut out = stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(e),
        _ => Ok(()),
    }
}

/// Control characters and those that turn the direction of writing become the replacement character.
fn printable(text: &str) -> String {
    let bad = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    text.chars().map(|c| if bad(c) { char::REPLACEMENT_CHARACTER } else { c }).collect()
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
    let text = printable(&text.split_whitespace().collect::<Vec<_>>().join(" "));
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
    fn names_cannot_steer_the_terminal() {
        assert_eq!(super::printable("a\x1b[31mb\u{202e}c\u{7f}é🌹"), "a\u{fffd}[31mb\u{fffd}c\u{fffd}é🌹");
    }

    #[test]
    fn thousands_are_grouped() {
        let got = [0, 999, 1000, 1_234_567].map(super::grouped);
        assert_eq!(got, ["0", "999", "1,000", "1,234,567"]);
    }
}
