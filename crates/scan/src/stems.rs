//! Things on the ground: the tree, other trees, people, walls.

use base::{CancelToken, Cancelled, Report};
use glam::DVec3;

use crate::ScanTreeError;
use crate::ground::Ground;
use crate::levels::Rings;
use crate::wanted::{ScanTally, TreeScanSpec};
use crate::ways::{Bridges, NONE, Ways};

/// A detected trunk.
#[derive(Clone, Debug)]
pub(crate) struct Trunk {
    /// Its centre in its lowest slice.
    pub(crate) middle: DVec3,
    pub(crate) radius: f64,
    /// Its cubes in all slices.
    pub(crate) cubes: Vec<u32>,
}

/// Ground of a tree, for heights over it.
pub(crate) struct Site<'a> {
    ground: Option<&'a Ground>,
    lowest: f64,
    pub(crate) height: f64,
    /// Things that touch the ground have points below this height, metres.
    contact: f64,
}

impl<'a> Site<'a> {
    pub(crate) fn new(above: &[DVec3], ground: Option<&'a Ground>, height: f64, cell: f64) -> Self {
        let lowest = lowest(above);
        let thick = ground.map_or(0.0, |g| g.thickness_m.max(0.02));
        let contact = thick + (0.02 * height).clamp(3.0 * cell, 0.3_f64.max(3.0 * cell));
        Self { ground, lowest, height, contact }
    }

    pub(crate) fn over(&self, p: DVec3) -> f64 {
        p.y - self.level(p)
    }

    /// Returns whether a point is low enough to touch the ground.
    pub(crate) fn is_low(&self, p: DVec3) -> bool {
        self.over(p) < self.contact
    }

    pub(crate) fn level(&self, p: DVec3) -> f64 {
        self.ground.map_or(self.lowest, |g| g.height(p))
    }
}

/// Returns the lowest point, ignoring a few strays.
fn lowest(points: &[DVec3]) -> f64 {
    let mut heights: Vec<f64> = points.iter().step_by(points.len() / 100_000 + 1).map(|p| p.y).collect();
    base::sort_numbers(&mut heights);
    heights[heights.len() / 2000]
}

/// Roots and the root collar of a stem lie below this share of the height.
const ROOTED: f64 = 0.1;

/// A thing that touches the ground.
#[derive(Clone, Debug)]
struct Contact {
    cubes: Vec<u32>,
    middle: DVec3,
    /// Half of the longer side of its box, seen from above.
    half: f64,
    piece: u32,
    /// A trunk rises from here.
    is_trunk: bool,
}

/// A trunk stands on a contact that is within this distance of it, beyond its bark, metres.
const FOOT_OF_TRUNK: f64 = 0.3;
/// Trunks of one piece that are farther apart than this are two trees, metres.
const TWO_TREES: f64 = 1.0;

/// Least number of cubes of a piece that is not dust.
const LARGE: u32 = 40;

/// Things on the ground, with the chosen tree first.
pub(crate) struct Stems {
    piece: Vec<u32>,
    sizes: Vec<u32>,
    /// Feet of the tree: several for a shrub.
    feet: Vec<Contact>,
    /// Other stems and things.
    others: Vec<Contact>,
}

impl Stems {
    pub(crate) fn find(
        ways: &Ways,
        site: &Site<'_>,
        spec: &TreeScanSpec,
        trunks: &[Trunk],
        cancel: &CancelToken,
    ) -> Result<Self, ScanTreeError> {
        let (piece, sizes) = ways.pieces(2, |_| true, cancel)?;
        let solid = |k: &Contact| k.half < (0.12 * site.height).max(0.05) && k.cubes.len() >= 3;
        let mut contacts = touching(ways, site, &piece, (f64::NEG_INFINITY, site.contact), cancel)?;
        if !contacts.iter().any(solid) {
            // A stem that spreads into roots is slim above them.
            let under = site.contact.max(ROOTED * site.height);
            contacts = touching(ways, site, &piece, (0.5 * under, under), cancel)?;
        }
        stand_on(trunks, &piece, &solid, &mut contacts);
        // Greatest height of each piece; after that, loose pieces count for the nearest contact.
        let mut top = vec![0.0_f64; sizes.len()];
        for (c, &p) in piece.iter().enumerate() {
            top[p as usize] = top[p as usize].max(site.over(ways.means[c]));
        }
        let mut score: Vec<f64> = contacts.iter().map(|k| f64::from(sizes[k.piece as usize])).collect();
        add_loose(ways, &piece, &sizes, &contacts, &mut score, &solid);
        for (s, k) in score.iter_mut().zip(&contacts) {
            // A low piece is not a tree; among the feet of one piece, the thicker wins.
            *s *= (top[k.piece as usize] / site.height).min(1.0) * (0.5 + k.half);
            if !solid(k) {
                *s = 0.0;
            }
        }
        let trunk_there = |[x, z]: [f64; 2]| {
            let away = |t: &&Trunk| (t.middle - DVec3::new(x, t.middle.y, z)).length();
            trunks.iter().min_by(|a, b| away(a).total_cmp(&away(b))).filter(|t| away(t) <= spec.at_within_m)
        };
        let best = match spec.at {
            Some(at) if trunk_there(at).is_some() => {
                // The nearest stem, not the nearest weed.
                let stands =
                    trunk_there(at).map(|t| (0..contacts.len()).filter(|&i| stands_on(t, &contacts[i])));
                stands.into_iter().flatten().max_by(|&a, &b| score[a].total_cmp(&score[b]).then(b.cmp(&a)))
            }
            Some([x, z]) => {
                let flat = |k: &Contact| {
                    ((k.middle.x - x) * (k.middle.x - x) + (k.middle.z - z) * (k.middle.z - z)).sqrt()
                };
                let rows = (0..contacts.len()).filter(|&i| score[i] > 0.0);
                let near = rows.min_by(|&a, &b| flat(&contacts[a]).total_cmp(&flat(&contacts[b])));
                let near = near.ok_or(ScanTreeError::NoStem)?;
                let is = flat(&contacts[near]);
                if is > spec.at_within_m {
                    let m = contacts[near].middle;
                    return Err(ScanTreeError::NotThere([x, z], spec.at_within_m, [m.x, m.z]));
                }
                // The best of those that are about as near.
                (0..contacts.len())
                    .filter(|&i| score[i] > 0.0 && flat(&contacts[i]) < is + 0.3)
                    .max_by(|&a, &b| score[a].total_cmp(&score[b]))
            }
            None => (0..contacts.len()).max_by(|&a, &b| score[a].total_cmp(&score[b]).then(b.cmp(&a))),
        };
        let best = best.filter(|&b| score[b] > 0.0).ok_or(ScanTreeError::NoStem)?;
        let main = contacts[best].clone();
        let (mut feet, mut others) = (vec![], vec![]);
        for (i, k) in contacts.into_iter().enumerate() {
            let away = (k.middle - main.middle).length();
            let same = k.piece == main.piece;
            let shrub = same && away < (0.12 * site.height).max(6.0 * main.half) && away < 1.5;
            if i == best || (shrub && k.half > 0.4 * main.half) {
                feet.push(k);
            } else if same {
                // A twig that hangs to the ground belongs to the tree; a stem as thick is another tree's.
                let is_stem = k.half > 0.5 * main.half && solid(&k) && away > 1.5;
                if is_stem || (k.is_trunk && away > TWO_TREES) {
                    others.push(k);
                }
            } else if k.cubes.len() >= 3 {
                others.push(k);
            }
        }
        Ok(Self { piece, sizes, feet, others })
    }

    /// Assigns every cube to the thing with which it is connected: plant 0 is the tree. Gaps up to `gap` are bridged.
    pub(crate) fn claim(
        &self,
        site: &Site<'_>,
        ways: &mut Ways,
        gap: f64,
        cancel: &CancelToken,
    ) -> Result<Bridges, Cancelled> {
        let mut front = vec![];
        for (plant, k) in self.feet.iter().map(|k| (0, k)).chain((1..).zip(&self.others)) {
            // Start from the lowest cubes.
            let over = |c: &u32| site.over(ways.means[*c as usize]);
            let low = k.cubes.iter().map(over).fold(f64::INFINITY, f64::min) + 2.0 * ways.voxels.cell();
            let seeds: Vec<u32> = k.cubes.iter().copied().filter(|c| over(c) < low).collect();
            for c in seeds {
                ways.way[c as usize] = site.over(ways.means[c as usize]).max(0.0);
                ways.plant[c as usize] = plant;
                front.push(c);
            }
        }
        ways.spread(&front, |_| true, cancel)?;
        self.bridge(ways, gap, cancel)
    }

    /// Bridges gaps up to `gap`, but not to dust.
    fn bridge(&self, ways: &mut Ways, gap: f64, cancel: &CancelToken) -> Result<Bridges, Cancelled> {
        let sizes = &self.sizes;
        let piece: Vec<u32> =
            self.piece.iter().map(|&p| if sizes[p as usize] >= 4 { p } else { NONE }).collect();
        ways.bridge(gap, &piece, |c| piece[c] != NONE, cancel)
    }

    /// Returns the number of points of the tree, and of large pieces that are connected with nothing on the ground.
    pub(crate) fn loose(&self, ways: &Ways) -> [usize; 2] {
        let mut counts = [0; 2];
        for c in 0..ways.len() {
            let is_large = self.sizes[self.piece[c] as usize] >= LARGE;
            match ways.plant[c] {
                0 => counts[0] += ways.voxels.rows(c).len(),
                NONE if is_large => counts[1] += ways.voxels.rows(c).len(),
                _ => {}
            }
        }
        counts
    }

    /// Bridges a wider gap to large pieces, then usual ones beyond it; returns the count and the widest gap.
    pub(crate) fn reach_over(
        &self,
        ways: &mut Ways,
        (usual, wide): (f64, f64),
        cancel: &CancelToken,
    ) -> Result<Bridges, Cancelled> {
        let large: Vec<u32> =
            self.piece.iter().map(|&p| if self.sizes[p as usize] >= LARGE { p } else { NONE }).collect();
        let over = ways.bridge(wide, &large, |c| large[c] != NONE, cancel)?;
        let more = self.bridge(ways, usual, cancel)?;
        Ok(Bridges { count: over.count + more.count, longest: over.longest })
    }

    /// Returns the distance from the tree to the nearest large piece that is connected with nothing; none without
    /// one.
    pub(crate) fn next_gap(&self, ways: &Ways) -> Option<f64> {
        let places: Vec<DVec3> =
            (0..ways.len()).filter(|&c| ways.plant[c] == 0).map(|c| ways.means[c]).collect();
        let tree = geom::KdTree::new(&places);
        let lost = (0..ways.len())
            .filter(|&c| ways.plant[c] == NONE && self.sizes[self.piece[c] as usize] >= LARGE)
            .step_by(7);
        let distances = lost.filter_map(|c| {
            let near = tree.nearest(ways.means[c], f64::INFINITY)?;
            Some(places[near].distance(ways.means[c]))
        });
        distances.reduce(f64::min)
    }

    pub(crate) fn tell(&self, ways: &Ways, report: &mut Report, tally: &mut ScanTally) {
        let mut counts = vec![0; self.others.len() + 1];
        for c in 0..ways.len() {
            let n = ways.voxels.rows(c).len();
            match ways.plant[c] {
                NONE => tally.noise += n,
                p => counts[p as usize] += n,
            }
        }
        tally.others = counts[1..].iter().sum();
        let large = counts[1..].iter().filter(|&&n| n * 50 > counts[0]).count();
        tally.other_things = large;
        let others = tally.others;
        if large > 0 {
            base::warn!(
                report,
                "scan-others",
                { count = large, points = others },
                "{large} other things stand on the ground (trees, people, walls; {others} points): they were left out; \
                 say where the stem stands that is meant"
            );
        }
    }

    /// Returns the foot of the tree: below its lowest ring, on the ground.
    pub(crate) fn foot(&self, site: &Site<'_>, rings: &Rings) -> DVec3 {
        let feet = rings.rings.iter().filter(|r| r.below == NONE && r.alive);
        let stem = feet.max_by(|a, b| a.reach.total_cmp(&b.reach));
        let first = stem.map_or(self.feet[0].middle, |r| r.middle);
        DVec3::new(first.x, site.level(first), first.z)
    }
}

/// Returns the things that touch the ground, up to a height over it; their centre and width are measured above
/// another height.
fn touching(
    ways: &Ways,
    site: &Site<'_>,
    piece: &[u32],
    (from, under): (f64, f64),
    cancel: &CancelToken,
) -> Result<Vec<Contact>, Cancelled> {
    let over = |c: usize| site.over(ways.means[c]);
    let (contact_of, counts) = ways.pieces(2, |c| over(c) < under, cancel)?;
    let none =
        Contact { cubes: vec![], middle: DVec3::ZERO, half: f64::INFINITY, piece: NONE, is_trunk: false };
    let mut contacts = vec![none; counts.len()];
    for (c, &k) in (0_u32..).zip(&contact_of) {
        if k != NONE {
            contacts[k as usize].cubes.push(c);
        }
    }
    for k in &mut contacts {
        k.piece = piece[k.cubes[0] as usize];
        let high = |c: &&u32| over(**c as usize) >= from;
        let places: Vec<DVec3> = k.cubes.iter().filter(high).map(|&c| ways.means[c as usize]).collect();
        if places.is_empty() {
            continue;
        }
        k.middle = places.iter().sum::<DVec3>() / places.len() as f64;
        let (a, b) =
            places.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
        k.half = 0.5 * (b - a).x.max((b - a).z);
    }
    Ok(contacts)
}

/// Returns whether a trunk stands on a contact.
fn stands_on(trunk: &Trunk, contact: &Contact) -> bool {
    (contact.middle - trunk.middle).with_y(0.0).length() < trunk.radius + FOOT_OF_TRUNK
}

/// Marks the contacts on which trunks stand. A trunk whose foot is hidden by the plants around it becomes a contact
/// itself.
fn stand_on(trunks: &[Trunk], piece: &[u32], solid: &dyn Fn(&Contact) -> bool, contacts: &mut Vec<Contact>) {
    for trunk in trunks {
        let mut is_seen = false;
        for k in contacts.iter_mut().filter(|k| solid(k) && stands_on(trunk, k)) {
            k.is_trunk = true;
            is_seen = true;
        }
        if !is_seen {
            let cubes = trunk.cubes.clone();
            let piece = piece[cubes[0] as usize];
            let (middle, half) = (trunk.middle, trunk.radius);
            contacts.push(Contact { cubes, middle, half, piece, is_trunk: true });
        }
    }
}

/// Adds loose pieces to the score of the contact that is nearest in plan.
fn add_loose(
    ways: &Ways,
    piece: &[u32],
    sizes: &[u32],
    contacts: &[Contact],
    score: &mut [f64],
    solid: &dyn Fn(&Contact) -> bool,
) {
    let mut middle = vec![DVec3::ZERO; sizes.len()];
    piece.iter().zip(&ways.means).for_each(|(&p, m)| middle[p as usize] += *m / f64::from(sizes[p as usize]));
    let mut stands = vec![false; sizes.len()];
    contacts.iter().for_each(|k| stands[k.piece as usize] = true);
    let rows: Vec<usize> = (0..contacts.len()).filter(|&i| solid(&contacts[i])).collect();
    let flat = |p: DVec3| DVec3::new(p.x, 0.0, p.z);
    let places: Vec<DVec3> = rows.iter().map(|&i| flat(contacts[i].middle)).collect();
    let tree = geom::KdTree::new(&places);
    for (p, &m) in middle.iter().enumerate() {
        if !stands[p]
            && sizes[p] >= 20
            && let Some(k) = tree.nearest(flat(m), f64::INFINITY)
        {
            score[rows[k]] += f64::from(sizes[p]);
        }
    }
}
