//! Quotes the user's words in messages, at most one line of them.

/// Most characters of a quoted value.
const QUOTED: usize = 80;
/// Most characters of a whole message.
const WHOLE: usize = 1500;

/// Returns a value as messages quote it: at most 80 characters; a longer value ends with `...`.
///
/// ```
/// assert_eq!(base::quoted("oak"), "oak");
/// assert_eq!(base::quoted(&"x".repeat(3_000_000)).len(), 80);
/// ```
pub fn quoted(text: &str) -> String {
    cut(text, QUOTED)
}

/// Escapes text for use as the content or an attribute of XML. Characters that XML cannot hold become a space or are
/// left out.
///
/// ```
/// assert_eq!(base::escaped_xml("a < \"b\"\u{1}& c"), "a &lt; &quot;b&quot; &amp; c");
/// ```
pub fn escaped_xml(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            '\u{fffe}' | '\u{ffff}' => {}
            c => out.push(c),
        }
    }
    out
}

/// Shortens a message, which may come from another library: everything that it quotes in backticks or double quotes is
/// cut as by [`quoted`], and the message itself to at most 1,500 characters. Cost: linear.
///
/// ```
/// let long = format!("unknown field `{}`, expected `age`", "x".repeat(1000));
/// assert_eq!(base::brief(&long).len(), "unknown field ``, expected `age`".len() + 80);
/// ```
pub fn brief(message: &str) -> String {
    let mut out = String::with_capacity(message.len().min(2 * WHOLE));
    let mut rest = message;
    while let Some(start) = rest.find(['`', '"']) {
        let (before, from) = rest.split_at(start);
        out.push_str(before);
        let mark = if from.starts_with('`') { '`' } else { '"' };
        // Within double quotes a backslash keeps the next character from ending them.
        let mut escaped = false;
        let end = from[1..].char_indices().find(|&(_, c)| {
            let ends = c == mark && !escaped;
            escaped = mark == '"' && c == '\\' && !escaped;
            ends
        });
        let Some((end, _)) = end else {
            rest = from;
            break;
        };
        out.push(mark);
        out.push_str(&quoted(&from[1..=end]));
        out.push(mark);
        rest = &from[end + 2..];
    }
    out.push_str(rest);
    cut(&out, WHOLE)
}

fn cut(text: &str, most: usize) -> String {
    if text.char_indices().nth(most).is_none() {
        return text.to_owned();
    }
    let end = text.char_indices().nth(most - 3).map_or(text.len(), |(at, _)| at);
    format!("{}...", &text[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_quotes_are_cut_and_short_ones_stay() {
        for same in ["", "a `b` c", "\"\"", "it's `a`, not \"b\"", "one ` alone", "\u{e4}`\u{1f339}`"] {
            assert_eq!(brief(same), same);
        }
        let long = "\u{1f339}".repeat(200);
        let cut = brief(&format!("x `{long}` y \"a\\\"{long}\" z"));
        assert_eq!(cut.chars().count(), "x `` y \"\" z".len() + 160);
        assert!(cut.ends_with("...\" z") && cut.contains("...` y"), "{cut}");
        assert_eq!(brief(&format!("an open `{}", "x".repeat(1 << 20))).len(), WHOLE);
        assert_eq!(brief(&"`".repeat(1 << 20)).len(), WHOLE);
    }
}
