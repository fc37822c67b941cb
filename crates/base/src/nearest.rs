//! Of a word that is not known, which of those that are known is meant.

/// The choice that a slip of the hand turns into `word`: letters that are wrong, missing, too many or swapped, up to a
/// third of the longer word (Damerau 1964). The first of several that are as near; none if all are farther.
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

/// How a message that ends with the words that are known goes on: which of them is meant, in backticks; empty if none is
/// near.
///
/// ```
/// assert_eq!(base::meant("oka", ["ash", "oak"]), "; is `oak` meant?");
/// assert_eq!(base::meant("lotus", ["ash", "oak"]), "");
/// ```
pub fn meant<'a>(word: &str, choices: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, choices).map(|near| format!("; is `{near}` meant?")).unwrap_or_default()
}

/// A message without what [`meant`] put to its end.
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
        // One letter is a slip of anything.
        for far in ["", "o", "k", "palm", "\u{1f339}"] {
            assert_eq!(nearest(far, trees), None, "{far}");
        }
        assert_eq!(nearest("height", ["width_m", "height_m"]), Some("height_m"));
        assert_eq!(nearest("depth", ["width_m", "height_m"]), None);
        assert_eq!(nearest("anything", []), None);
    }
}
