//! Finds the known word that an unknown word was meant to be.

/// Returns the choice that a typing error turns into `word`: letters that are wrong, missing, extra or swapped, up to a
/// third of the longer word (Damerau 1964). Of equally near choices it returns the first; `None` if all are farther.
/// Cost: the product of both lengths for each choice.
///
/// ```
/// let known = ["leaves", "age", "seed"];
/// assert_eq!(base::nearest("leave", known), Some("leaves"));
/// assert_eq!(base::nearest("sede", known), Some("seed"));
/// assert_eq!(base::nearest("roots", known), None);
/// ```
pub fn nearest<'a>(word: &str, choices: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let long = word.chars().count();
    let mut best: Option<(usize, &str)> = None;
    for choice in choices {
        let most = ((long.max(choice.chars().count()) + 1) / 3).max(1).min(long.saturating_sub(1));
        let slips = strsim::osa_distance(word, choice);
        if slips <= most && best.is_none_or(|(least, _)| slips < least) {
            best = Some((slips, choice));
        }
    }
    best.map(|(_, choice)| choice)
}

/// Returns the end of a message that lists the known words: the one that was probably meant, in backticks; empty if
/// none is near.
///
/// ```
/// assert_eq!(base::meant("oka", ["ash", "oak"]), "; is `oak` meant?");
/// assert_eq!(base::meant("lotus", ["ash", "oak"]), "");
/// ```
pub fn meant<'a>(word: &str, choices: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, choices).map(|near| format!("; is `{near}` meant?")).unwrap_or_default()
}

/// Removes the hint that [`meant`] appended to a message.
pub(crate) fn without_hint(message: &str) -> &str {
    let before = message.strip_suffix("` meant?").and_then(|rest| rest.rsplit_once("; is `"));
    before.map_or(message, |(before, _)| before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_is_meant() {
        let trees = ["apple", "ash", "beech", "birch", "oak"];
        assert_eq!(nearest("birhc", trees), Some("birch"));
        assert_eq!(nearest("ok", trees), Some("oak"));
        // A word of one letter could be a typing error of any word.
        for far in ["", "o", "k", "palm", "\u{1f339}"] {
            assert_eq!(nearest(far, trees), None, "{far}");
        }
        assert_eq!(nearest("height", ["width_m", "height_m"]), Some("height_m"));
        assert_eq!(nearest("depth", ["width_m", "height_m"]), None);
        assert_eq!(nearest("anything", []), None);
    }
}
