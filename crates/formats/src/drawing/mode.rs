//! Words in layer and element names -> [`StrokeMode`].

use ink::StrokeMode;

/// Returns the mode that a name asks for: `parts`, `branch-contour` or `leaf-contour`, in any case, with `-`, `_`,
/// spaces, camel case or nothing between the words, and with anything after (`Leaf contour 2`).
pub(crate) fn mode_in(name: &str) -> Option<StrokeMode> {
    let words = words(name);
    let contour = |w: Option<&String>| w.is_some_and(|w| matches!(w.as_str(), "contour" | "contours"));
    for (i, word) in words.iter().enumerate() {
        match word.as_str() {
            "branch" | "branches" if contour(words.get(i + 1)) => return Some(StrokeMode::BranchContour),
            "leaf" | "leaves" if contour(words.get(i + 1)) => return Some(StrokeMode::LeafContour),
            "branchcontour" | "branchcontours" => return Some(StrokeMode::BranchContour),
            "leafcontour" | "leafcontours" => return Some(StrokeMode::LeafContour),
            // `parts` counts only as the first word: `petal-parts` is a name for a petal.
            "parts" if i == 0 => return Some(StrokeMode::Parts),
            _ => {}
        }
    }
    None
}

fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut fresh = true;
    let mut previous_lower = false;
    for c in name.chars().take(200) {
        if !c.is_ascii_alphabetic() {
            fresh = true;
            previous_lower = false;
            continue;
        }
        if fresh || (previous_lower && c.is_ascii_uppercase()) {
            words.push(String::new());
            fresh = false;
        }
        previous_lower = c.is_ascii_lowercase();
        if let Some(word) = words.last_mut() {
            word.push(c.to_ascii_lowercase());
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_layers_give_the_mode() {
        for name in
            ["leaf-contour", "Leaf Contour", "leaf_contour_2", "leafContour", "LEAF-CONTOUR", "3 leafcontour"]
        {
            assert_eq!(mode_in(name), Some(StrokeMode::LeafContour), "{name}");
        }
        for name in ["branch-contour", "branches contour", "BranchContour7", "my branch-contours"] {
            assert_eq!(mode_in(name), Some(StrokeMode::BranchContour), "{name}");
        }
        assert_eq!(mode_in("Parts 1"), Some(StrokeMode::Parts));
        for name in ["", "leaf", "leaf 3", "contour", "path-1", "petal-parts", "branch", "leaf outer contour"]
        {
            assert_eq!(mode_in(name), None, "{name}");
        }
    }
}
