//! Results of single strokes, kept while these do not change: a drawing of thousands grows by one at a time.
//!
//! No result is found by age or number alone: it is used again only if all its inputs have the same bits, so a reading
//! is the same with kept results and without.

use glam::DVec2;

use crate::blade::Sheetlet;
use crate::body::Limb;
use crate::{BladeReading, VeinReading};

/// Outline, gaps and base of a body.
type Body = (Vec<DVec2>, Vec<usize>, Option<DVec2>);

/// Outline, root and veins of a blade.
type Blade = (Vec<DVec2>, DVec2, Vec<VeinReading>);

/// Results of single strokes, for [`read_again`](crate::read_again).
#[derive(Clone, Debug, Default)]
pub struct KeptStrokes {
    /// Outlines of blades, from the points of their strokes.
    pub(crate) blades: Kept<Vec<DVec2>, Drawn>,
    /// Limbs of bodies, from outline, gaps and base.
    pub(crate) bodies: Kept<Body, Vec<Limb>>,
    /// Tips and midribs of blades, from outline, root and veins.
    pub(crate) leaves: Kept<Blade, BladeReading>,
}

impl KeptStrokes {
    /// Drops results that were not used since the last call.
    pub(crate) fn forget(&mut self) {
        self.blades.forget();
        self.bodies.forget();
        self.leaves.forget();
    }
}

/// The form of a blade's stroke.
#[derive(Clone, Debug)]
pub(crate) enum Drawn {
    /// Closed, with or without a midrib.
    Blade(Sheetlet, Vec<Vec<DVec2>>),
    /// So open that it may be one side of a leaf.
    Open,
    /// It encloses nothing.
    Thin,
}

/// Results of one kind, by the strokes that they came from.
#[derive(Clone, Debug)]
pub(crate) struct Kept<K, V>(Vec<Vec<Found<K, V>>>);

#[derive(Clone, Debug)]
struct Found<K, V> {
    from: K,
    value: V,
    needed: bool,
}

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<K, V: Clone> Kept<K, V> {
    /// Returns the result of a stroke if its inputs are the same, or else makes a new one and keeps it.
    pub(crate) fn get(
        &mut self,
        stroke: u32,
        same: impl Fn(&K) -> bool,
        from: impl FnOnce() -> K,
        make: impl FnOnce() -> V,
    ) -> V {
        let row = stroke as usize;
        if self.0.len() <= row {
            self.0.resize_with(row + 1, Vec::new);
        }
        let own = &mut self.0[row];
        if let Some(found) = own.iter_mut().find(|r| same(&r.from)) {
            found.needed = true;
            return found.value.clone();
        }
        let value = make();
        own.push(Found { from: from(), value: value.clone(), needed: true });
        value
    }

    fn forget(&mut self) {
        for own in &mut self.0 {
            own.retain(|r| r.needed);
            own.iter_mut().for_each(|r| r.needed = false);
        }
    }
}

/// Whether two lines have the same bits.
pub(crate) fn alike(a: &[DVec2], b: &[DVec2]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_bits(*a, *b))
}

/// Whether two points have the same bits: 0 and -0 do not.
pub(crate) fn same_bits(a: DVec2, b: DVec2) -> bool {
    (a.x.to_bits(), a.y.to_bits()) == (b.x.to_bits(), b.y.to_bits())
}

#[cfg(test)]
mod tests {
    use base::{CancelToken, Report, Run, ops};
    use ink::{Drawing, Ink};

    use super::*;
    use crate::{Kind, Reading, read_again, read_as};

    /// A flower with two leaves, one of them with a vein, and a trunk of two lines next to it.
    fn lines() -> Vec<Vec<DVec2>> {
        let ring = |x: f64, y: f64, (a, b): (f64, f64)| -> Vec<DVec2> {
            let turn = (0..=40).map(|i| ops::sin_cos(ops::TAU * f64::from(i) / 40.0));
            turn.map(|(s, c)| DVec2::new(x + a * c, y + b * s)).collect()
        };
        let line = |a: (f64, f64), b: (f64, f64)| -> Vec<DVec2> {
            (0..=30).map(|i| DVec2::from(a).lerp(DVec2::from(b), f64::from(i) / 30.0)).collect()
        };
        let petal = |k: i32| {
            let (s, c) = ops::sin_cos(ops::TAU * f64::from(k) / 6.0);
            ring(1.6 * c, 8.0 + 1.6 * s, (0.8, 0.8))
        };
        let mut lines = vec![line((0.0, 0.0), (0.0, 7.2)), ring(0.0, 8.0, (0.7, 0.7))];
        lines.extend((0..6).map(petal));
        lines.extend([ring(1.5, 3.0, (1.5, 0.5)), line((0.2, 3.0), (2.6, 3.0)), ring(-1.5, 4.0, (1.5, 0.5))]);
        lines.extend([
            line((4.0, 0.0), (4.2, 5.0)),
            line((5.2, 0.0), (5.0, 5.0)),
            ring(4.6, 6.5, (2.0, 1.6)),
        ]);
        lines
    }

    fn both(lines: &[Vec<DVec2>], kind: Option<Kind>, kept: &mut KeptStrokes) -> [Reading; 2] {
        let ink: Ink = ink::clean(&Drawing::from_polylines("grows", lines), &mut Report::default());
        let classes = ink::classify(&ink, &Run::plain());
        let afresh = read_as(kind, &ink, &classes, &mut Report::default());
        [afresh, read_again(kind, &[], (&ink, &classes), kept, &Run::plain(), &mut Report::default())]
    }

    #[test]
    fn a_drawing_that_changes_is_read_as_if_it_were_new() {
        let (all, mut kept) = (lines(), KeptStrokes::default());
        let mut last = 0;
        let grows = (1..=all.len()).map(|n| all[..n].to_vec());
        // The whole drawing once more, one without its first stroke, and one with another line in its place.
        let other: Vec<DVec2> = all[0].iter().map(|p| *p + DVec2::new(0.1 * p.y, 0.0)).collect();
        let changed = [all.clone(), all[1..].to_vec(), [&[other], &all[1..]].concat()];
        for lines in grows.chain(changed) {
            for kind in [None, Some(Kind::Tree)] {
                let [afresh, again] = both(&lines, kind, &mut kept);
                assert_eq!(afresh, again, "{} strokes as {kind:?}", lines.len());
            }
            last = kept.blades.0.iter().map(Vec::len).sum::<usize>();
        }
        assert!((1..=8 * all.len()).contains(&last), "what is no longer needed is forgotten: {last}");
    }

    #[test]
    fn a_cancelled_run_reads_nothing_and_spoils_nothing() {
        let ink: Ink = ink::clean(&Drawing::from_polylines("stops", &lines()), &mut Report::default());
        let classes = ink::classify(&ink, &Run::plain());
        let cancel = CancelToken::new();
        let run = Run { cancel: &cancel, ..Run::plain() };
        let (mut kept, mut report) = (KeptStrokes::default(), Report::default());
        let mut read = || read_again(None, &[], (&ink, &classes), &mut kept, &run, &mut report);
        let whole = read();
        assert!(!whole.flowers.is_empty() && !whole.leaves.is_empty());
        cancel.cancel();
        let stopped = read();
        assert_eq!(stopped, Reading::default());
        let again = read_again(None, &[], (&ink, &classes), &mut kept, &Run::plain(), &mut report);
        assert_eq!(again, whole);
    }

    #[test]
    fn what_has_not_changed_is_not_made_again() {
        let mut kept: Kept<u32, u32> = Kept::default();
        let mut get = |from: u32, most: u32| kept.get(3, |k| *k == from, || from, || most);
        assert_eq!([get(1, 10), get(1, 11), get(2, 12), get(1, 13)], [10, 10, 12, 10]);
        kept.forget();
        assert_eq!(kept.get(3, |k| *k == 2, || 2, || 14), 12);
        kept.forget();
        assert_eq!(kept.get(3, |k| *k == 1, || 1, || 15), 15, "it was not needed");
    }
}
