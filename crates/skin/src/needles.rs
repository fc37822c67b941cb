//! Shoots in needles or scales: the places of a blade's plane that are leaf.

use glam::DVec2;
use plant::{Blade, NeedleMap};

/// The places of a blade's plane that are leaf.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cut {
    outline: geom::Inside,
    pub(crate) needles: Option<NeedleMap>,
}

impl Cut {
    pub(crate) fn new(blade: &Blade) -> Self {
        Self { outline: geom::Inside::new(&blade.outline), needles: NeedleMap::from_blade(blade) }
    }

    pub(crate) fn has(&self, p: DVec2) -> bool {
        match &self.needles {
            Some(map) => map.seen_at(p).is_some(),
            None => self.outline.has(p),
        }
    }

    /// Whether it is between needles: there a card has a hole seen from near by, and is closed from far away.
    pub(crate) fn between(&self, p: DVec2) -> bool {
        self.needles.is_some() && self.outline.has(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plant::Needles;

    /// `sketch` counts the shoots of a drawn conifer by the area that each covers.
    #[test]
    fn a_spruces_shoot_covers_a_fifth_of_the_square_of_its_length() {
        let cut = Cut::new(&Blade::shoot(Needles::with_length(0.075), 3, 1.0));
        let places = (-100..100).flat_map(|i| (0..200).map(move |j| (f64::from(i), f64::from(j))));
        let covered = places.filter(|&(x, y)| cut.has(DVec2::new(x + 0.5, y + 0.5) / 200.0)).count();
        let share = covered as f64 / 40_000.0;
        assert!((0.17..0.24).contains(&share), "{share}");
    }
}
