//! The tree of connected pieces of bands of equal way (a Reeb graph), and which of its branches are leaves.

use base::{CancelToken, Cancelled};
use glam::DVec3;

use crate::ways::{NONE, SegmentSpec, Ways};

/// Width of a band, in cubes.
const BAND: f64 = 3.0;
/// Most bands of the longest way.
const MOST_BANDS: f64 = 400.0;

/// What tells a stem that goes on from a leaf.
struct Stems {
    /// Greatest distance of two chains of pieces between where they part and where they meet, as a share of the least length
    /// of a branch: up to it they are sides of one organ with a gap in its points, beyond it organs that touch.
    gap: f64,
    /// Mean level displacement of what lies beyond a fork, as a share of its mean level distance: leaves all around a
    /// stem are below, the lobes and leaflets of one leaf above. Two leaves 80 degrees apart have 0.77.
    one_sided: f64,
    /// Share of a branch's way up to which a fork counts as at its base: stalks that rise side by side part there, and the
    /// first leaflets of a leaf sit farther out.
    short: f64,
    /// Sine of the elevation from which on what lies beyond a fork is a stem, however one-sided: 70 degrees.
    steep: f64,
    /// Share of the longest way along which the course of a stem is measured.
    course: f64,
    /// Cosine of the turn up to which the last internode goes on as its stem did: 25 degrees.
    straight: f64,
    /// Cosine of the turn from which on the other leaves at the last fork have left the stem: 35 degrees.
    aside: f64,
    /// Width up to which the last internode is as thin as its stem.
    thin: f64,
}

const STEMS: Stems = Stems {
    gap: 1.0,
    one_sided: 0.78,
    short: 0.15,
    steep: 0.94,
    course: 0.06,
    straight: 0.906,
    aside: 0.819,
    thin: 1.6,
};

/// Connected pieces of bands.
pub(crate) struct Tree {
    /// The piece of each cube.
    piece: Vec<usize>,
    /// The band of each piece.
    level: Vec<usize>,
    /// The piece that each piece has become part of; itself for most.
    part_of: Vec<usize>,
    /// The piece below each piece; `NONE` for the first.
    below: Vec<usize>,
    above: Vec<Vec<usize>>,
    /// Cubes of each piece.
    cubes: Vec<Vec<usize>>,
    /// Mean position, and root mean square distance from it.
    middle: Vec<DVec3>,
    spread: Vec<f64>,
    /// For the piece and all above it: number of cubes, and the longest path from the piece.
    area: Vec<usize>,
    reach: Vec<f64>,
    band: f64,
}

impl Tree {
    pub(crate) fn new(ways: &Ways, spec: &SegmentSpec, cancel: &CancelToken) -> Result<Self, Cancelled> {
        let n = ways.way.len();
        let longest = ways.way.iter().copied().fold(0.0, f64::max);
        let band = (BAND * ways.voxels.cell()).max(longest / MOST_BANDS).max(1e-12);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 400 bands")]
        let band_of = |c: usize| (ways.way[c] / band) as usize;
        let mut order: Vec<usize> = (0..n).collect();
        base::sort_by(&mut order, |&a, &b| ways.way[a].total_cmp(&ways.way[b]).then(a.cmp(&b)));
        let mut tree = Self {
            piece: vec![NONE; n],
            level: vec![],
            part_of: vec![],
            below: vec![],
            above: vec![],
            cubes: vec![],
            middle: vec![],
            spread: vec![],
            area: vec![],
            reach: vec![],
            band,
        };
        // The piece of a lower band that the way of each cube comes from.
        let mut from = vec![NONE; n];
        let mut seen = vec![false; n];
        let mut stack = Vec::new();
        for level in order.chunk_by(|&a, &b| band_of(a) == band_of(b)) {
            for &c in level {
                let before = ways.parent[c];
                if before != NONE {
                    from[c] = if tree.piece[before] == NONE { from[before] } else { tree.piece[before] };
                }
            }
            for &first in level {
                if seen[first] {
                    continue;
                }
                cancel.check()?;
                let mut members = Vec::new();
                seen[first] = true;
                stack.push(first);
                while let Some(c) = stack.pop() {
                    members.push(c);
                    ways.near(c, |k| {
                        if !seen[k] && band_of(k) == band_of(first) {
                            seen[k] = true;
                            stack.push(k);
                        }
                    });
                }
                tree.add((ways, band_of(first)), &members, &from, STEMS.gap * spec.least_length * longest);
            }
        }
        tree.finish(ways);
        Ok(tree)
    }

    /// Joins the pieces to a tree, once all are there.
    fn finish(&mut self, ways: &Ways) {
        for p in (0..self.below.len()).filter(|&p| self.part_of[p] == p).collect::<Vec<_>>().into_iter().rev()
        {
            let square: f64 =
                self.cubes[p].iter().map(|&c| ways.means[c].distance_squared(self.middle[p])).sum();
            self.spread[p] = (square / self.cubes[p].len() as f64).sqrt();
            for &c in &self.cubes[p] {
                self.piece[c] = p;
            }
            self.below[p] = self.whole(self.below[p]);
            let below = self.below[p];
            if below != NONE {
                self.above[below].push(p);
                self.area[below] += self.area[p];
                self.reach[below] = self.reach[below].max(self.reach[p] + self.band);
            }
        }
    }

    /// Returns the piece that a piece is part of by now.
    fn whole(&self, mut piece: usize) -> usize {
        while piece != NONE && self.part_of[piece] != piece {
            piece = self.part_of[piece];
        }
        piece
    }

    /// Adds what hangs together in a band: one piece, or several where organs touch that were farther apart than `gap`
    /// since they parted.
    fn add(&mut self, (ways, level): (&Ways, usize), members: &[usize], from: &[usize], gap: f64) {
        let source = |tree: &Self, c: usize| tree.whole(from[c]);
        let mut sources: Vec<usize> = members.iter().map(|&c| source(self, c)).collect();
        sources.sort_unstable();
        sources.dedup();
        for b in 1..sources.len() {
            for a in 0..b {
                let [x, y] = [self.whole(sources[a]), self.whole(sources[b])];
                if x != y && self.apart(x, y) <= gap {
                    self.join(x, y);
                }
            }
        }
        let mut sources: Vec<usize> = sources.into_iter().map(|s| self.whole(s)).collect();
        sources.sort_unstable();
        sources.dedup();
        for below in sources {
            let cubes: Vec<usize> = members.iter().copied().filter(|&c| source(self, c) == below).collect();
            let mark = self.below.len();
            cubes.iter().for_each(|&c| self.piece[c] = mark);
            self.level.push(level);
            self.part_of.push(mark);
            self.below.push(below);
            self.above.push(vec![]);
            self.middle.push(cubes.iter().map(|&c| ways.means[c]).sum::<DVec3>() / cubes.len() as f64);
            self.spread.push(0.0);
            self.area.push(cubes.len());
            self.reach.push(self.band);
            self.cubes.push(cubes);
        }
    }

    /// Calls `f` with the pieces of the same band below two pieces, and with these, down to where the two parted; returns
    /// whether they did.
    fn descend(&self, a: usize, b: usize, mut f: impl FnMut(usize, usize)) -> bool {
        let (mut a, mut b) = (a, b);
        while a != b && a != NONE && b != NONE {
            let (high, low) = (self.level[a], self.level[b]);
            if high == low {
                f(a, b);
            }
            if high >= low {
                a = self.whole(self.below[a]);
            }
            if low >= high {
                b = self.whole(self.below[b]);
            }
        }
        a == b
    }

    /// Returns how far apart two chains of pieces are at most since they parted; infinite if they never were one.
    fn apart(&self, a: usize, b: usize) -> f64 {
        let mut most = 0.0_f64;
        let met = self.descend(a, b, |a, b| most = most.max(self.middle[a].distance(self.middle[b])));
        if met { most } else { f64::INFINITY }
    }

    /// Makes two chains of pieces one, band by band, down to where they parted.
    fn join(&mut self, a: usize, b: usize) {
        let mut pairs = Vec::new();
        self.descend(a, b, |a, b| pairs.push((a.min(b), a.max(b))));
        for (into, gone) in pairs {
            let cubes = core::mem::take(&mut self.cubes[gone]);
            let [m, n] = [self.cubes[into].len() as f64, cubes.len() as f64];
            self.middle[into] = (self.middle[into] * m + self.middle[gone] * n) / (m + n);
            self.area[into] += cubes.len();
            self.cubes[into].extend(cubes);
            self.part_of[gone] = into;
        }
    }

    /// Returns a label per cube: 0 for the stem, 1 and on for each leaf, those of the most cubes first.
    pub(crate) fn labels(&self, ways: &Ways, spec: &SegmentSpec) -> Vec<usize> {
        let branches = Branches::new(self, spec);
        let up = spec.up.try_normalize().unwrap_or(DVec3::Y);
        let mut label = vec![NONE; self.below.len()];
        let mut leaves = Vec::new();
        let mut work = if self.below.is_empty() { vec![] } else { vec![0] };
        while let Some(start) = work.pop() {
            // Along the stem to the next fork.
            let (chain, fork) = branches.chain(start);
            chain.iter().for_each(|&p| label[p] = 0);
            let place = self.middle[chain[chain.len() - 1]];
            let (stems, ends): (Vec<usize>, Vec<usize>) =
                fork.iter().copied().partition(|&b| self.is_stem(b, &branches, ways, place, up));
            let top = if stems.is_empty() { self.internode(&chain, &ends, &branches, up) } else { None };
            for leaf in ends {
                let mut first = leaf;
                if let Some((_, stem, beyond)) = top.as_ref().filter(|t| t.0 == leaf) {
                    stem.iter().for_each(|&p| label[p] = 0);
                    first = *beyond;
                }
                leaves.push((first, self.area[leaf]));
            }
            work.extend(stems);
        }
        if leaves.is_empty() {
            // No fork: a single organ or a bare stem.
            return vec![0; ways.way.len()];
        }
        base::sort_by_key(&mut leaves, |&(first, area)| (core::cmp::Reverse(area), first));
        for (k, (first, _)) in (1..).zip(leaves) {
            label[first] = k;
        }
        for p in (0..label.len()).filter(|&p| self.part_of[p] == p) {
            if label[p] == NONE {
                label[p] = if self.below[p] == NONE { 0 } else { label[self.below[p]] };
            }
        }
        self.piece.iter().map(|&p| if p == NONE { 0 } else { label[p] }).collect()
    }

    /// Whether the branch forks again, and does so at its base, or its parts stand around it, as leaves around a stem and
    /// not as lobes and leaflets of a leaf on one side of `place`.
    fn is_stem(&self, first: usize, branches: &Branches<'_>, ways: &Ways, place: DVec3, up: DVec3) -> bool {
        let (chain, fork) = branches.chain(first);
        if fork.is_empty() {
            return false;
        }
        if chain.len() as f64 * self.band <= STEMS.short * self.reach[first] {
            return true;
        }
        let (mut sum, mut far) = (DVec3::ZERO, 0.0);
        let mut work = vec![first];
        while let Some(p) = work.pop() {
            for d in self.cubes[p].iter().map(|&c| ways.means[c] - place) {
                sum += d;
                far += d.reject_from_normalized(up).length();
            }
            work.extend(&self.above[p]);
        }
        let aside = sum.reject_from_normalized(up).length();
        aside < STEMS.one_sided * far || sum.dot(up) > STEMS.steep * sum.length()
    }

    /// Returns the leaf at the last fork that hides the last internode, the pieces of that, and the first piece of the leaf
    /// itself: the internode goes on as thin and straight as the stem did, and the other leaves have left it.
    fn internode(
        &self,
        stem: &[usize],
        fork: &[usize],
        branches: &Branches<'_>,
        up: DVec3,
    ) -> Option<(usize, Vec<usize>, usize)> {
        if fork.len() < 2 {
            return None;
        }
        let longest = self.reach.first().copied().unwrap_or(0.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 400 bands")]
        let steps = ((STEMS.course * longest / self.band).ceil() as usize).max(2);
        let last = stem.len() - 1;
        let course = match last.checked_sub(steps) {
            Some(k) => (self.middle[stem[last]] - self.middle[stem[k]]).normalize_or(up),
            None => up,
        };
        let place = self.middle[stem[last]];
        let turn = |b: usize| {
            let chain = branches.chain(b).0;
            (self.middle[chain[steps.min(chain.len() - 1)]] - place).normalize_or(up).dot(course)
        };
        let child = fork.iter().copied().max_by(|&a, &b| turn(a).total_cmp(&turn(b)))?;
        if turn(child) < STEMS.straight || fork.iter().any(|&b| b != child && turn(b) > STEMS.aside) {
            return None;
        }
        let mut widths: Vec<f64> = stem.iter().map(|&p| self.spread[p]).collect();
        base::sort_numbers(&mut widths);
        let thin = STEMS.thin * widths[widths.len() / 2].max(0.5 * self.band);
        let chain = branches.chain(child).0;
        let goes_on = |k: usize| {
            let ahead = self.middle[chain[(k + steps / 2).min(chain.len() - 1)]] - self.middle[chain[k]];
            self.spread[chain[k]] < thin && ahead.normalize_or(course).dot(course) > STEMS.straight
        };
        let more = (0..chain.len()).take_while(|&k| goes_on(k)).count();
        Some((child, chain[..more].to_vec(), *chain.get(more)?))
    }
}

/// What is a branch and no bump of a tree.
struct Branches<'a> {
    tree: &'a Tree,
    least_reach: f64,
    least_area: f64,
}

impl<'a> Branches<'a> {
    fn new(tree: &'a Tree, spec: &SegmentSpec) -> Self {
        let whole = tree.area.first().copied().unwrap_or(0) as f64;
        let longest = tree.reach.first().copied().unwrap_or(0.0);
        Self { tree, least_reach: spec.least_length * longest, least_area: spec.least_area * whole }
    }

    /// Returns the pieces from one on to the next fork, and the branches there; none at an end.
    fn chain(&self, first: usize) -> (Vec<usize>, Vec<usize>) {
        let is_branch = |p: &usize| {
            self.tree.reach[*p] >= self.least_reach && self.tree.area[*p] as f64 >= self.least_area
        };
        let above = |p: usize| self.tree.above[p].iter().copied().filter(is_branch).collect::<Vec<usize>>();
        let mut chain = vec![first];
        let mut fork = above(first);
        while let [only] = fork[..] {
            chain.push(only);
            fork = above(only);
        }
        (chain, fork)
    }
}
