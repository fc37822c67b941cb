//! The meaning of a drawing's colours: `strokes -> green strokes, strokes that may be wood`.
//!
//! A drawing in one colour shows only the colour of the pen. In a painted one, green is no bark and no clay, and a
//! plant without anything brown, grey or black is a herb.

use ink::{Ink, InkStroke, hue};

/// Limits between colours, and limits of a herb.
#[derive(Clone, Debug)]
struct PaletteLimits {
    /// Colours differ if a channel differs by more than this.
    differs: u8,
    /// A colour with less than this between its largest and smallest channel is grey.
    grey: u8,
    /// A colour whose largest channel is below this is ink, whatever its hue.
    dark: u8,
    /// A colour whose channels are all at least this is nearly white.
    pale: u8,
    /// The hues of green, degrees: from the olive of dry grass to the blue green of a conifer.
    green: core::ops::Range<f64>,
    /// The hues of blue, degrees: from cyan to violet. No leaf, wood or pot has them.
    blue: core::ops::Range<f64>,
    /// Colours lie above green if their middle does, by more than this share of the drawing's height.
    above: f64,
    /// Colours and green each cover at least this share of all painted areas.
    patch: f64,
    /// A herb is green over at least this share of its lines.
    herb_green: f64,
    /// A herb has less than this share of lines that could be wood.
    herb_wood: f64,
    /// A shorter line, in diagonals of the drawing, is not wood but a grain or a seed.
    wood_least: f64,
}

const LIMITS: PaletteLimits = PaletteLimits {
    differs: 24,
    grey: 30,
    dark: 60,
    pale: 190,
    green: 62.0..170.0,
    blue: 185.0..285.0,
    above: 0.1,
    patch: 0.08,
    herb_green: 0.25,
    herb_wood: 0.08,
    wood_least: 0.1,
};

/// Whether a drawing was made in several colours, one of them green.
pub(crate) fn is_painted(ink: &Ink) -> bool {
    has_several_colours(ink) && ink.strokes.iter().any(is_green_stroke)
}

/// Whether two strokes of a drawing differ in colour.
fn has_several_colours(ink: &Ink) -> bool {
    let mut colors = ink.strokes.iter().filter_map(|s| s.color);
    let Some(first) = colors.next() else { return false };
    let differs = |c: [u8; 3]| c.iter().zip(&first).any(|(a, b)| a.abs_diff(*b) > LIMITS.differs);
    colors.any(differs)
}

/// Whether a drawing has the colours of plants: several, one of them green, or bright ones without blue. Icons in shades of
/// a theme's blue have none.
pub(crate) fn is_coloured(ink: &Ink) -> bool {
    let is_blue = |c: [u8; 3]| hue(c).1 > LIMITS.grey && LIMITS.blue.contains(&hue(c).0);
    if !ink.strokes.iter().any(is_green_stroke) && ink.strokes.iter().filter_map(|s| s.color).any(is_blue) {
        return false;
    }
    has_several_colours(ink) && ink.strokes.iter().any(|s| is_green_stroke(s) || is_bright_stroke(s))
}

/// Whether a stroke is green: by its hue, and neither grey nor nearly black.
pub(crate) fn is_green_stroke(stroke: &InkStroke) -> bool {
    stroke.color.is_some_and(is_green)
}

/// Whether more than half of some strokes, by length, is green.
pub(crate) fn is_mostly_green<'a>(strokes: impl Iterator<Item = &'a InkStroke>) -> bool {
    let (mut green, mut other) = (0.0, 0.0);
    for stroke in strokes {
        *if is_green_stroke(stroke) { &mut green } else { &mut other } += stroke.length;
    }
    green > other
}

/// Whether a stroke has a colour that neither leaves nor wood have.
pub(crate) fn is_bright_stroke(stroke: &InkStroke) -> bool {
    stroke.color.is_some_and(|c| !is_green(c) && !may_be_wood(c))
}

/// Whether a stroke is nearly white.
pub(crate) fn is_pale_stroke(stroke: &InkStroke) -> bool {
    stroke.color.is_some_and(|c| c.into_iter().all(|x| x >= LIMITS.pale))
}

/// Where the bright colours of a painted drawing lie: those of petals, fruits and roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Brights {
    /// Above the green, as a flower on its stem.
    Above,
    /// Below the green, as a fruit on its stalk or a root under its leaves.
    Below,
    /// Among it, or there are none.
    Among,
}

/// Returns where the bright colours of a drawing lie. Cost: linear in strokes.
pub(crate) fn brights(ink: &Ink) -> Brights {
    if !is_painted(ink) {
        return Brights::Among;
    }
    // Area, and area times height of the middle, of green and of bright colours.
    let (mut green, mut bright, mut whole) = ([0.0; 2], [0.0; 2], 0.0);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for stroke in &ink.strokes {
        let area = geom::signed_area(stroke.hull()).abs();
        let Some((lo, hi)) = geom::bounds(&stroke.points) else { continue };
        (low, high) = (low.min(lo.y), high.max(hi.y));
        whole += area;
        let sum = match stroke.color {
            Some(c) if is_green(c) => &mut green,
            _ if is_bright_stroke(stroke) => &mut bright,
            _ => continue,
        };
        sum[0] += area;
        sum[1] += area * lo.midpoint(hi).y;
    }
    if green[0].min(bright[0]) <= LIMITS.patch * whole {
        return Brights::Among;
    }
    let rise = (bright[1] / bright[0] - green[1] / green[0]) / (high - low).max(f64::MIN_POSITIVE);
    if rise > LIMITS.above {
        Brights::Above
    } else if rise < -LIMITS.above {
        Brights::Below
    } else {
        Brights::Among
    }
}

/// Whether a stroke has the colour of wood: brown, grey or black. It says nothing unless the drawing is painted.
pub(crate) fn is_brown_stroke(stroke: &InkStroke) -> bool {
    stroke.color.is_some_and(may_be_wood)
}

/// Whether the colours of a drawing are those of a plant without wood. Cost: linear in strokes.
pub(crate) fn is_herb(ink: &Ink) -> bool {
    if !is_painted(ink) {
        return false;
    }
    let (mut whole, mut green, mut wood) = (0.0, 0.0, 0.0);
    for stroke in &ink.strokes {
        whole += stroke.length;
        if is_green_stroke(stroke) {
            green += stroke.length;
        } else if stroke.length > LIMITS.wood_least && stroke.color.is_none_or(may_be_wood) {
            wood += stroke.length;
        }
    }
    green >= LIMITS.herb_green * whole && wood < LIMITS.herb_wood * whole
}

fn is_green(c: [u8; 3]) -> bool {
    let (hue, span) = hue(c);
    span > LIMITS.grey && c.into_iter().any(|x| x >= LIMITS.dark) && LIMITS.green.contains(&hue)
}

/// Whether a drawing is in one blue pen: each colour of it that is not grey is blue, and so is that of an organ which
/// no plant has in blue. `flowers`: colours of petals; `others`: colours of leaves, fruits, contours and pots.
pub fn is_in_blue_pen(
    flowers: impl Iterator<Item = [u8; 3]>,
    others: impl Iterator<Item = [u8; 3]> + Clone,
) -> bool {
    let is_coloured = |c: &[u8; 3]| hue(*c).1 > LIMITS.grey;
    let is_blue = |c: [u8; 3]| LIMITS.blue.contains(&hue(c).0);
    flowers.chain(others.clone()).filter(is_coloured).all(is_blue) && others.filter(is_coloured).any(is_blue)
}

/// Whether a colour may be wood: brown, grey or black; bark is not white or bright.
fn may_be_wood(c: [u8; 3]) -> bool {
    /// Greatest brightness of bark.
    const BRIGHT: u8 = 205;
    let (hue, span) = hue(c);
    let is_brown = (0.0..LIMITS.green.start).contains(&hue);
    c.into_iter().all(|x| x < BRIGHT)
        && (is_brown || span <= LIMITS.grey || c.into_iter().all(|x| x < LIMITS.dark))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_with_blue_leaves_is_in_one_pen() {
        let [blue, sky, ink, green] = [[32, 90, 200], [143, 191, 250], [20, 20, 20], [60, 150, 40]];
        assert!(is_in_blue_pen([sky].into_iter(), [blue, ink].into_iter()));
        assert!(!is_in_blue_pen([sky].into_iter(), [green].into_iter()));
        assert!(!is_in_blue_pen([sky].into_iter(), [ink].into_iter()));
    }

    #[test]
    fn greens_of_leaves_are_green_and_barks_are_not() {
        for c in [[124, 171, 9], [78, 103, 12], [68, 80, 22], [0, 104, 56], [144, 183, 75]] {
            assert!(is_green(c) && !may_be_wood(c), "{c:?}");
        }
        for c in [[123, 85, 23], [88, 44, 44], [150, 84, 70], [52, 52, 52], [0, 0, 0]] {
            assert!(!is_green(c) && may_be_wood(c), "{c:?}");
        }
        for c in [[255, 255, 255], [125, 138, 215], [254, 134, 0], [252, 237, 0]] {
            assert!(!is_green(c) && !may_be_wood(c), "{c:?}");
        }
    }
}
