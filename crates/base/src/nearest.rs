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
    let word: Vec<char> = word.chars().collect();
    let mut best: Option<(usize, &str)> = None;
    for choice in choices {
        let letters: Vec<char> = choice.chars().collect();
        let most = ((word.len().max(letters.len()) + 1) / 3).max(1).min(word.len().saturating_sub(1));
        let slips = slips(&word, &letters);
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

/// How many letters are wrong, missing, too many or swapped with their neighbour.
fn slips(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, y) in b.iter().enumerate() {
            let changed = above[j] + usize::from(x != y);
            let mut least = changed.min(above[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *x == b[j - 1] && a[i - 1] == *y {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut above, row);
    }
    above[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_counted() {
        let count = |a: &str, b: &str| slips(&a.chars().collect::<Vec<_>>(), &b.chars().collect::<Vec<_>>());
        for (a, b, want) in [
            ("", "", 0),
            ("", "oak", 3),
            ("oak", "", 3),
            ("oak", "oka", 1),
            ("kitten", "sitting", 3),
            ("leaf_kept", "leaf_keep", 2),
            ("\u{1f339}x", "x\u{1f339}", 1),
        ] {
            assert_eq!((count(a, b), count(b, a)), (want, want), "{a} {b}");
        }
    }

    #[test]
    fn what_is_near_is_meant() {
        let trees = ["apple", "ash", "beech", "birch", "oak"];
        assert_eq!(nearest("birhc", trees), Some("birch"));
        assert_eq!(nearest("ok", trees), Some("oak"));
        // One letter is a slip of anything.
        for far in ["", "o", "k", "palm", "\u{1f339}"] {
            assert_eq!(nearest(far, trees), None, "{far}");
        }
        assert_eq!(nearest("heigth", ["width_m", "height_m"]), Some("height_m"));
        assert_eq!(nearest("depth", ["width_m", "height_m"]), None);
        assert_eq!(nearest("anything", []), None);
    }
}
