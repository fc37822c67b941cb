//! Lines for people. A closed pipe is not an error.

use std::ffi::OsStr;
use std::io::{self, IsTerminal, Write, stderr, stdout};
use std::sync::{Mutex, PoisonError};

pub(crate) use burgeon::grouped;

/// Prints a line on stdout for people; names of files and drawings cannot control the terminal.
pub(crate) fn line(text: &str) {
    let mut out = stdout().lock();
    match writeln!(out, "{}", printable(text)).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            LOST.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(e);
        }
        _ => {}
    }
}

/// Returns the reason why a [`line`] did not arrive, if one did not, except for a reader that closed the pipe.
pub(crate) fn lost() -> Option<io::Error> {
    LOST.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// The first error of [`line`].
static LOST: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints text for other programs on stdout: if it does not arrive, that is an error, except for a reader that closed
/// the pipe.
pub(crate) fn data(text: &str) -> io::Result<()> {
    let mut out = stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(e),
        _ => Ok(()),
    }
}

/// Replaces control characters and those that turn the direction of writing by the replacement character.
fn printable(text: &str) -> String {
    let bad = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    text.chars().map(|c| if bad(c) { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// Prints `error: ...` on stderr; line breaks inside become spaces.
pub(crate) fn error(text: &str) {
    tagged("error", "31;1", text);
}

/// Prints `warning: ...` on stderr; line breaks inside become spaces.
pub(crate) fn warning(text: &str) {
    tagged("warning", "33;1", text);
}

fn tagged(tag: &str, color: &str, text: &str) {
    let text = printable(&short(text));
    let mut out = stderr().lock();
    let [no_color, term] = ["NO_COLOR", "TERM"].map(std::env::var_os);
    let _ = if !out.is_terminal() || plain(no_color.as_deref(), term.as_deref()) {
        writeln!(out, "{tag}: {text}")
    } else {
        writeln!(out, "\x1b[{color}m{tag}:\x1b[0m {text}")
    };
}

/// Returns a text as one line. If it is longer than 400 characters, its longest words, such as names of files, keep
/// only their two ends, so that the rest of the message is not lost.
pub(crate) fn short(text: &str) -> String {
    const MOST: usize = 80;
    let words: Vec<&str> = text.split_whitespace().collect();
    let line = words.join(" ");
    if line.chars().nth(400).is_none() {
        return line;
    }
    let ends = |word: &&str| {
        let count = word.chars().count();
        if count <= MOST {
            return (*word).to_owned();
        }
        let (start, end) =
            word.chars().enumerate().fold((String::new(), String::new()), |mut all, (i, c)| {
                match i {
                    i if i < MOST / 2 => all.0.push(c),
                    i if i >= count - MOST / 2 => all.1.push(c),
                    _ => {}
                }
                all
            });
        format!("{start}...{end}")
    };
    words.iter().map(ends).collect::<Vec<_>>().join(" ")
}

/// Whether a terminal gets no colours: by <https://no-color.org>, or because it supports none.
fn plain(no_color: Option<&OsStr>, term: Option<&OsStr>) -> bool {
    no_color.is_some() || term.is_some_and(|t| t == "dumb")
}

/// Returns `1 leaf`, `2 leaves`.
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
    fn long_words_keep_their_ends() {
        let short = super::short(&format!("ab{}yz: cannot be read", "x".repeat(5000)));
        assert!(
            short.starts_with("abx") && short.ends_with("xyz: cannot be read") && short.len() < 120,
            "{short}"
        );
        let path = format!("{}.svg:\n is empty", "x".repeat(300));
        assert_eq!(super::short(&path), path.replace('\n', ""));
    }

    #[test]
    fn dumb_terminals_get_no_colours() {
        use std::ffi::OsStr;
        let plain = |no_color: Option<&str>, term: Option<&str>| {
            super::plain(no_color.map(OsStr::new), term.map(OsStr::new))
        };
        assert!(plain(None, Some("dumb")) && plain(Some("1"), Some("xterm")));
        assert!(!plain(None, Some("xterm-256color")) && !plain(None, None));
    }
}
