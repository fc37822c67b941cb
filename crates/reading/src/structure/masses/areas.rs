//! The areas that lines cover: `lines -> masses, and stems between them`.

use base::ops;
use geom::{polyline_length, resample, simple_outline, simplify, smooth_gaussian_closed};
use glam::DVec2;

use super::super::shape::Shape;
use super::MASSES;
use crate::raster::{Cells, around, distances, drawn, flood, largest, pieces, square};

/// A wide part of the drawing.
#[derive(Clone, Debug)]
pub(crate) struct Mass {
    /// Its outline, counter-clockwise.
    pub(crate) outline: Vec<DVec2>,
    pub(crate) shape: Shape,
    /// Radius of the largest circle in it.
    pub(crate) inner: f64,
    /// How much its lines run away from its middle: 1 if all do, 0 if they run in all directions, -1 if they run round
    /// it.
    pub(crate) radial: f64,
    /// Rows of the strokes that lie in it more than in other areas, the longest first.
    pub(crate) strokes: Vec<usize>,
    /// Its longest line, from end to end.
    pub(crate) middle_line: Vec<DVec2>,
}

/// A slender part of the drawing.
#[derive(Clone, Debug)]
pub(crate) struct Stem {
    pub(crate) points: Vec<DVec2>,
    /// Rows of the strokes that lie in it more than in other areas, the longest first.
    pub(crate) strokes: Vec<usize>,
}

/// The wide and the slender parts of a drawing.
#[derive(Clone, Debug)]
pub(crate) struct Areas {
    pub(crate) masses: Vec<Mass>,
    pub(crate) stems: Vec<Stem>,
}

impl Areas {
    /// Finds the areas that lines cover, with the ball that leaves the most convex masses: a smaller one finds its way
    /// into organs, a larger one finds no way between them. `None` if the lines have no extent. Cost: linear in points,
    /// and a few hundred passes over a picture of [`MASSES`]`.along` cells a side.
    pub(crate) fn new(lines: &[&[DVec2]]) -> Option<Self> {
        let size = Cells::size_for(lines, MASSES.along)?;
        let widest = MASSES.balls.into_iter().fold(0.0, f64::max);
        let cells = Cells::new(lines, MASSES.along, (widest / size).ceil() + 2.0)?;
        let to_ink = distances(&cells, &drawn(&cells, lines));
        let all = MASSES.balls.into_iter().map(|ball| Self::within_ball(&cells, lines, &to_ink, ball));
        all.reduce(|a, b| if b.convex() > a.convex() { b } else { a })
    }

    /// Returns the area of its masses, each weighted by how convex it is: organs are, but not several together.
    fn convex(&self) -> f64 {
        self.masses.iter().map(|m| m.shape.area * ops::powf(m.shape.convexity, MASSES.convex_power)).sum()
    }

    /// Parts the cells that a ball does not reach from outside.
    fn within_ball(cells: &Cells, lines: &[&[DVec2]], to_ink: &[f64], ball: f64) -> Self {
        let whole = largest_pieces(cells, &sealed(cells, to_ink, ball / cells.size));
        let depth = distances(cells, &inverted(&whole));
        let thin = MASSES.thin / cells.size;
        let deep: Vec<bool> = depth.iter().map(|d| *d > thin).collect();
        let to_deep = distances(cells, &deep);
        let is_wide: Vec<bool> = (0..whole.len()).map(|k| whole[k] && to_deep[k] <= thin).collect();
        let mut label = basins(cells, &depth, &is_wide);
        let first_stem = label.iter().flatten().max().map_or(0, |l| l + 1);
        let paths = label_stems(cells, &whole, &mut label, first_stem);
        give_to_neighbours(cells, &whole, &mut label, first_stem);
        let strokes = strokes_by_label(cells, lines, &label, first_stem + paths.len());
        let mass = |k: usize| Mass::new(cells, (lines, &label, &depth), k, strokes[k].clone());
        let stem = |(k, path): (usize, &Vec<DVec2>)| Stem {
            points: simplify(&calmed(path), 0.5 * cells.size),
            strokes: strokes[first_stem + k].clone(),
        };
        Self {
            // Basins are numbered from the deepest.
            masses: (0..first_stem.min(MASSES.most)).filter_map(mass).collect(),
            stems: paths.iter().enumerate().map(stem).collect(),
        }
    }
}

/// Finds the stems among the cells without a label and labels them, from `first` on; returns their paths. The largest
/// pieces are looked at first, and only a few.
fn label_stems(cells: &Cells, whole: &[bool], label: &mut [Option<usize>], first: usize) -> Vec<Vec<DVec2>> {
    let thin = MASSES.thin / cells.size;
    let mut slender: Vec<bool> = (0..whole.len()).map(|k| whole[k] && label[k].is_none()).collect();
    let mut paths = Vec::new();
    for _ in 0..MASSES.most {
        let Some(piece) = largest(cells, &|k| slender[k]) else { break };
        let path = longest_path(cells, &piece);
        let points: Vec<DVec2> = path.iter().map(|&k| cells.middle(k)).collect();
        if polyline_length(&points) <= MASSES.stem {
            piece.iter().zip(&mut slender).for_each(|(p, s)| *s &= !p);
            continue;
        }
        let mut on_path = vec![false; whole.len()];
        path.iter().for_each(|&k| on_path[k] = true);
        let off = distances(cells, &on_path);
        for k in 0..whole.len() {
            if slender[k] && off[k] <= thin {
                (slender[k], label[k]) = (false, Some(first + paths.len()));
            }
        }
        paths.push(points);
    }
    paths
}

impl Mass {
    fn new(
        cells: &Cells,
        (lines, label, depth): (&[&[DVec2]], &[Option<usize>], &[f64]),
        k: usize,
        strokes: Vec<usize>,
    ) -> Option<Self> {
        let piece = largest(cells, &|at| label[at] == Some(k))?;
        let rim = around(cells, &piece)?;
        let even = resample(&rim, cells.size);
        let smooth = smooth_gaussian_closed(&even, MASSES.smooth, square(MASSES.smooth as f64 * cells.size));
        let outline = simple_outline(&simplify(&smooth, 0.3 * cells.size))?;
        let shape = Shape::new(&outline)?;
        let inner =
            (0..piece.len()).filter(|&at| piece[at]).map(|at| depth[at]).fold(0.0, f64::max) * cells.size;
        let radial = radiality(cells, (lines, &piece, depth), shape.middle);
        let path: Vec<DVec2> = longest_path(cells, &piece).into_iter().map(|at| cells.middle(at)).collect();
        let middle_line = simplify(&calmed(&path), 0.5 * cells.size);
        Some(Self { outline, shape, inner, radial, strokes, middle_line })
    }

    /// Whether a point lies in it or within a distance of it.
    pub(crate) fn is_near(&self, p: DVec2, reach: f64) -> bool {
        geom::contains(&self.outline, p) || crate::blade::nearest_on_ring(&self.outline, p).1 < reach
    }
}

fn inverted(mask: &[bool]) -> Vec<bool> {
    mask.iter().map(|m| !m).collect()
}

/// Returns the cells that a ball of a radius in cells cannot reach from outside.
fn sealed(cells: &Cells, to_ink: &[f64], ball: f64) -> Vec<bool> {
    let middles = flood(cells, 0, &|k| to_ink[k] > ball);
    distances(cells, &middles).iter().map(|d| *d > ball).collect()
}

/// Returns the largest connected pieces of a mask: a few, and none far smaller than the largest.
fn largest_pieces(cells: &Cells, mask: &[bool]) -> Vec<bool> {
    let mut all = pieces(cells, &|k| mask[k]);
    base::sort_by_key(&mut all, |piece| core::cmp::Reverse(piece.len()));
    let least = MASSES.piece * all.first().map_or(0, Vec::len) as f64;
    let mut kept = vec![false; mask.len()];
    for piece in all.iter().take(MASSES.most).take_while(|piece| piece.len() as f64 >= least) {
        piece.iter().for_each(|&k| kept[k] = true);
    }
    kept
}

/// Parts an area at its necks: each cell belongs to the basin of a place that is farthest from the rim. Two basins are
/// one if the neck between them is nearly as wide as the narrower (watershed with dynamics, Grimaud 1992).
fn basins(cells: &Cells, depth: &[f64], is: &[bool]) -> Vec<Option<usize>> {
    let mut order: Vec<usize> = (0..is.len()).filter(|&k| is[k]).collect();
    base::sort_by(&mut order, |&a, &b| depth[b].total_cmp(&depth[a]).then(a.cmp(&b)));
    // The basin of each cell, the one that each was merged into, and the deepest place of each.
    let mut label: Vec<Option<usize>> = vec![None; is.len()];
    let mut into: Vec<usize> = Vec::new();
    let mut peak: Vec<f64> = Vec::new();
    let find = |into: &[usize], mut k: usize| {
        while into[k] != k {
            k = into[k];
        }
        k
    };
    for at in order {
        let mut near: Vec<usize> =
            cells.around(at, &EIGHT).filter_map(|k| label[k]).map(|k| find(&into, k)).collect();
        near.sort_unstable();
        near.dedup();
        // Basins are numbered from the deepest: the first is the deeper one.
        let Some((&own, others)) = near.split_first() else {
            label[at] = Some(into.len());
            into.push(into.len());
            peak.push(depth[at]);
            continue;
        };
        for &other in others {
            if depth[at] >= MASSES.neck * peak[other] {
                into[other] = own;
            }
        }
        label[at] = Some(own);
    }
    // Numbers without gaps.
    let mut number: Vec<Option<usize>> = vec![None; into.len()];
    let mut count = 0;
    for k in 0..into.len() {
        if into[k] == k {
            number[k] = Some(count);
            count += 1;
        }
    }
    label.iter().map(|l| l.and_then(|l| number[find(&into, l)])).collect()
}

/// Steps to the eight neighbours of a cell.
const EIGHT: [(isize, isize); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// Gives slender cells that are no stem, such as the tips of leaves, to the mass that they adjoin.
fn give_to_neighbours(cells: &Cells, whole: &[bool], label: &mut [Option<usize>], first_stem: usize) {
    let is_mass = |l: Option<usize>| l.filter(|l| *l < first_stem);
    let mut ahead: Vec<usize> = (0..whole.len()).filter(|&k| is_mass(label[k]).is_some()).collect();
    let mut next = 0;
    while let Some(&at) = ahead.get(next) {
        next += 1;
        for k in cells.around(at, &EIGHT) {
            if whole[k] && label[k].is_none() {
                label[k] = label[at];
                ahead.push(k);
            }
        }
    }
}

/// Returns the longest path through the cells of a connected piece: between two cells that are farthest apart, as the
/// path runs.
fn longest_path(cells: &Cells, piece: &[bool]) -> Vec<usize> {
    let Some(first) = piece.iter().position(|p| *p) else { return Vec::new() };
    let (from, _) = farthest(cells, piece, first);
    let (mut at, before) = farthest(cells, piece, from);
    let mut path = vec![at];
    while before[at] != at {
        at = before[at];
        path.push(at);
    }
    path
}

/// Returns the cell that is reached last from a cell, and for each cell the one before it.
fn farthest(cells: &Cells, piece: &[bool], from: usize) -> (usize, Vec<usize>) {
    let mut before = vec![usize::MAX; piece.len()];
    before[from] = from;
    let mut ahead = vec![from];
    let mut next = 0;
    while let Some(&at) = ahead.get(next) {
        next += 1;
        for k in cells.around(at, &EIGHT) {
            if piece[k] && before[k] == usize::MAX {
                before[k] = at;
                ahead.push(k);
            }
        }
    }
    (ahead[ahead.len() - 1], before)
}

/// Smooths a path of cells; its ends stay.
fn calmed(path: &[DVec2]) -> Vec<DVec2> {
    let step = path.windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
    geom::smooth_gaussian(path, MASSES.smooth, square(MASSES.smooth as f64 * step))
}

/// Returns for each area the rows of the strokes that lie in it more than in others, the longest first.
fn strokes_by_label(
    cells: &Cells,
    lines: &[&[DVec2]],
    label: &[Option<usize>],
    count: usize,
) -> Vec<Vec<usize>> {
    let mut found: Vec<Vec<(usize, usize)>> = vec![Vec::new(); count];
    for (row, line) in lines.iter().enumerate() {
        let mut steps = vec![0_usize; count];
        cells.walk(line, |p| {
            if let Some(l) = label[cells.place(p)] {
                steps[l] += 1;
            }
        });
        let most = (0..count).max_by_key(|&l| (steps[l], count - l));
        if let Some(l) = most.filter(|&l| steps[l] > 0) {
            found[l].push((row, steps[l]));
        }
    }
    for rows in &mut found {
        rows.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    }
    found.into_iter().map(|rows| rows.into_iter().map(|r| r.0).collect()).collect()
}

/// Returns how much the lines in a piece run away from a point; see [`Mass::radial`]. Its rim does not count, nor what
/// lies round the point, where lines of all directions meet.
fn radiality(cells: &Cells, (lines, piece, depth): (&[&[DVec2]], &[bool], &[f64]), middle: DVec2) -> f64 {
    let reach = (piece.iter().filter(|p| **p).count() as f64 / ops::PI).sqrt() * cells.size;
    let (mut sum, mut length) = (0.0, 0.0);
    for pair in lines.iter().flat_map(|l| l.windows(2)) {
        let at = pair[0].midpoint(pair[1]);
        let cell = cells.place(at);
        let (away, along) = (at - middle, pair[1] - pair[0]);
        if !piece[cell] || depth[cell] < MASSES.rim || away.length() < MASSES.hub * reach {
            continue;
        }
        let cos = away.normalize_or_zero().dot(along.normalize_or_zero());
        sum += along.length() * (2.0 * cos * cos - 1.0);
        length += along.length();
    }
    if length > 0.0 { sum / length } else { 0.0 }
}
