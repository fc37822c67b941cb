//! Bright areas: petals round a disc, petals in profile, and fruits.

use geom::{bounds, convex_hull};
use glam::DVec2;
use ink::StrokeClass;

use super::areas::{Area, Painted, Tone};
use super::{PAINTED, Plant};
use crate::blade::nearest_on_ring;
use crate::palette::Brights;
use crate::structure::masses::{Profile, closed};
use crate::structure::widest_gap;

impl Plant {
    /// Adds groups of bright areas that touch one another, each as flowers or as fruits.
    pub(super) fn add_brights(&mut self, painted: &Painted<'_>, place: Brights) {
        // Petals need not touch their disc.
        let all: Vec<&Area> = painted.areas.iter().filter(|a| may_be_of_flower(a)).collect();
        let rays = if place == Brights::Below { None } else { self.add_rays(&all) };
        let is_taken = |a: &Area| rays.iter().flatten().any(|f| core::ptr::eq(*f, a) || a.lies_in(f));
        let left: Vec<&Area> = all.into_iter().filter(|a| !is_taken(a)).collect();
        for mut members in groups(left, touch) {
            while let Some(flower) = self.add_from_front(&members) {
                members.retain(|a| !flower.iter().any(|f| core::ptr::eq(*f, *a) || a.lies_in(f)));
            }
            members.retain(|a| a.tone == Tone::Bright);
            if self.are_fruits(&members, place) {
                self.add_fruits(&members);
                continue;
            }
            let is_of_flower = |a: &Area, b: &Area| painted.are_of_one_hue(a, b) && touch(a, b);
            for petals in groups(members, is_of_flower) {
                self.add_profile(&petals);
            }
        }
    }

    /// Adds a flower from the front: petals round a disc, or a corolla with lobes. Returns its areas.
    fn add_from_front<'a>(&mut self, members: &[&'a Area]) -> Option<Vec<&'a Area>> {
        let points: Vec<DVec2> = members.iter().flat_map(|a| a.outline.iter().copied()).collect();
        let hull = convex_hull(&points);
        if hull.len() < 3 {
            return None;
        }
        if let Some(rays) = self.add_rays(members) {
            return Some(rays);
        }
        // Without a disc, petals meet in the middle.
        let centre = geom::centroid(&hull);
        if let Some(petals) = petals_round(members, None, centre) {
            self.add_head(None, &petals, centre);
            return Some(petals);
        }
        self.add_corolla(members)
    }

    /// Adds the flower with the largest petals round a disc. Returns its areas.
    fn add_rays<'a>(&mut self, members: &[&'a Area]) -> Option<Vec<&'a Area>> {
        let heads = members
            .iter()
            .filter(|a| a.may_be_disc())
            .filter_map(|disc| Some((*disc, petals_round(members, Some(disc), disc.shape.middle)?)));
        let size = |petals: &[&Area]| petals.iter().map(|a| a.shape.area).sum::<f64>();
        let (disc, petals) = heads.max_by(|a, b| size(&a.1).total_cmp(&size(&b.1)))?;
        self.add_head(Some(disc), &petals, disc.shape.middle);
        Some(petals.into_iter().chain([disc]).collect())
    }

    /// Adds a corolla in one area: with a disc in it, or with lobes. Returns its areas.
    fn add_corolla<'a>(&mut self, members: &[&'a Area]) -> Option<Vec<&'a Area>> {
        for &corolla in members.iter().filter(|a| a.tone == Tone::Bright) {
            let is_disc = |a: &&&&Area| {
                a.lies_in(corolla)
                    && a.may_be_disc()
                    && a.shape.area < PAINTED.disc * corolla.shape.area
                    && a.shape.middle.distance(corolla.shape.middle)
                        < PAINTED.disc_off * 0.5 * corolla.shape.length()
            };
            let disc =
                members.iter().filter(|a| is_disc(&a)).max_by(|a, b| a.shape.area.total_cmp(&b.shape.area));
            let centre = disc.map_or(corolla.shape.middle, |d| d.shape.middle);
            let profile = Profile::new(&corolla.outline, centre);
            if !geom::contains(&corolla.outline, centre)
                || corolla.shape.slenderness < PAINTED.fruit_round
                || profile.lobes().is_none() && (disc.is_none() || corolla.shape.convexity > PAINTED.corolla)
            {
                continue;
            }
            let first = self.parts.len();
            if let Some(disc) = disc {
                let hub = (disc.shape.area / base::ops::PI).sqrt();
                self.add(closed(&disc.outline), StrokeClass::Disc, None, disc.strokes.clone());
                self.parts.extend(profile.petals(hub, &corolla.strokes));
            } else {
                self.parts.extend(profile.organs(&corolla.strokes));
            }
            self.heads.push((first..self.parts.len()).collect());
            return Some(disc.into_iter().copied().chain([corolla]).collect());
        }
        None
    }

    fn add_head(&mut self, disc: Option<&Area>, petals: &[&Area], centre: DVec2) {
        let first = self.parts.len();
        if let Some(disc) = disc {
            self.add(closed(&disc.outline), StrokeClass::Disc, None, disc.strokes.clone());
        }
        for petal in petals {
            let root = nearest_on_ring(&petal.outline, centre).0;
            self.add(closed(&petal.outline), StrokeClass::Blade, Some(root), petal.strokes.clone());
        }
        self.heads.push((first..self.parts.len()).collect());
    }

    /// Whether bright areas are fruits: round, and they hang on a stem or lie below the leaves.
    fn are_fruits(&self, members: &[&Area], place: Brights) -> bool {
        if place == Brights::Below {
            return true;
        }
        let outer = outermost(members);
        let hangs = |a: &Area| match self.end_of_stem_on(&a.outline) {
            Some(end) => end.y > a.shape.middle.y,
            None => place != Brights::Above && a.shape.slenderness > PAINTED.berry,
        };
        let are_berries = outer.iter().all(|a| a.shape.slenderness > PAINTED.berry);
        (are_berries || outer.len() == 1)
            && outer.iter().all(|a| a.is_round())
            && outer.iter().any(|a| hangs(a))
    }

    fn add_fruits(&mut self, members: &[&Area]) {
        for area in outermost(members) {
            self.add(closed(&area.outline), StrokeClass::Fruit, None, area.strokes.clone());
        }
    }

    /// Adds a flower in profile: its petals rise from the place nearest to its stem, or from its lowest one.
    fn add_profile(&mut self, members: &[&Area]) {
        let points: Vec<DVec2> = members.iter().flat_map(|a| a.outline.iter().copied()).collect();
        let hull = convex_hull(&points);
        let Some((low, high)) = bounds(&hull) else { return };
        let lowest = || nearest_on_ring(&hull, DVec2::new(low.x.midpoint(high.x), low.y)).0;
        let base = self.end_of_stem_on(&hull).unwrap_or_else(lowest);
        let first = self.parts.len();
        for petal in outermost(members) {
            let touches = nearest_on_ring(&petal.outline, base).1 < PAINTED.touch;
            let outline = if touches {
                closed(&petal.outline)
            } else {
                closed(&convex_hull(&[&petal.outline[..], &[base]].concat()))
            };
            self.add(outline, StrokeClass::Blade, Some(base), petal.strokes.clone());
        }
        self.heads.push((first..self.parts.len()).collect());
    }
}

/// Returns the areas that stand round a place or a disc like petals, if there are enough.
fn petals_round<'a>(members: &[&'a Area], disc: Option<&Area>, centre: DVec2) -> Option<Vec<&'a Area>> {
    let hub = disc.map_or(0.0, |d| (d.shape.area / base::ops::PI).sqrt());
    let reach = |a: &Area| a.outline.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    let may_be_petal = |a: &&&Area| {
        a.tone == Tone::Bright
            && !disc.is_some_and(|d| core::ptr::eq(d, **a) || a.lies_in(d) || d.lies_in(a))
            && !geom::contains(&a.outline, centre)
            && nearest_on_ring(&a.outline, centre).1 < hub + PAINTED.petal_off * reach(a)
    };
    let found: Vec<&Area> = members.iter().filter(may_be_petal).copied().collect();
    // Several petals that lie in an area have it as their rim.
    let is_rim = |o: &Area| found.iter().filter(|a| a.lies_in(o)).count() > PAINTED.petals;
    let without_rims: Vec<&Area> = found.iter().filter(|a| !is_rim(a)).copied().collect();
    let mut petals = outermost(&without_rims);
    let most = petals.iter().map(|a| a.shape.area).fold(0.0, f64::max);
    // Smaller ones are gloss.
    petals.retain(|a| a.shape.area > PAINTED.alike * most);
    let fewest = if disc.is_some() { PAINTED.petals } else { PAINTED.many_petals };
    let is_side = disc.is_some() && petals.len() > PAINTED.petals;
    let gap = if is_side { PAINTED.side_gap } else { PAINTED.gap };
    let is_flower = petals.len() >= fewest
        && disc.is_none_or(|d| is_disc_of(d, &petals))
        && widest_gap(petals.iter().map(|a| a.shape.middle - centre)) < gap;
    is_flower.then_some(petals)
}

/// Whether an area may be the disc of these petals: smaller than all of them, and unlike the berries of a bunch.
fn is_disc_of(disc: &Area, petals: &[&Area]) -> bool {
    let whole: f64 = petals.iter().map(|a| a.shape.area).sum();
    let are_berries = petals.iter().all(|a| a.shape.slenderness > PAINTED.berry);
    let mean = whole / petals.len() as f64;
    disc.shape.area < PAINTED.disc * whole && !(are_berries && disc.shape.area > PAINTED.berry_alike * mean)
}

/// Whether an area may belong to a flower: a bright one, or a dark one, which may be a disc.
fn may_be_of_flower(area: &Area) -> bool {
    area.tone == Tone::Bright || area.tone == Tone::Wood && !area.is_stem()
}

/// Parts areas into groups: each member but the first goes with another one. `go_together`: whether two areas do.
fn groups(mut left: Vec<&Area>, go_together: impl Fn(&Area, &Area) -> bool) -> Vec<Vec<&Area>> {
    let mut groups = Vec::new();
    while let Some(first) = left.pop() {
        let mut group = vec![first];
        let mut next = 0;
        while let Some(&own) = group.get(next) {
            next += 1;
            let near: Vec<&Area> = left.extract_if(.., |a| go_together(own, a)).collect();
            group.extend(near);
        }
        groups.push(group);
    }
    groups
}

/// Returns the areas that lie in no other one of them: tones, gloss and seeds lie in an organ.
fn outermost<'a>(members: &[&'a Area]) -> Vec<&'a Area> {
    members.iter().filter(|a| !members.iter().any(|o| a.lies_in(o))).copied().collect()
}

/// Whether two areas touch or overlap.
fn touch(a: &Area, b: &Area) -> bool {
    let (Some((low, high)), Some((from, to))) = (bounds(&a.outline), bounds(&b.outline)) else {
        return false;
    };
    let near = PAINTED.touch;
    (low - to).max(from - high).max_element() < near
        && (a
            .outline
            .iter()
            .any(|&p| geom::contains(&b.outline, p) || nearest_on_ring(&b.outline, p).1 < near)
            || b.outline.iter().any(|&p| geom::contains(&a.outline, p)))
}
