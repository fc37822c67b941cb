//! Margins and midrib of a blade, and the grid between them.

use geom::HeightField;
use glam::DVec3;

/// Margins and midrib at stations from base to tip, in the blade's plane.
pub(super) struct Lines {
    y: Vec<f64>,
    left: Vec<f64>,
    middle: Vec<f64>,
    right: Vec<f64>,
}

impl Lines {
    pub(super) fn from_points(flat: &[DVec3], field: &HeightField, rows: usize, spacing: f64) -> Self {
        let mut ys: Vec<f64> = flat.iter().map(|p| p.y).collect();
        base::sort_numbers(&mut ys);
        let (lo, hi) = (ys[0], ys[ys.len() - 1]);
        let y: Vec<f64> = (0..rows).map(|i| base::ops::lerp(lo, hi, i as f64 / (rows - 1) as f64)).collect();
        // A slab must hold some lines of the scanner.
        let half = ((hi - lo) / rows as f64).max(1.5 * spacing);
        let mut slabs: Vec<Vec<f64>> = vec![vec![]; rows];
        let mut heights = vec![0.0; rows];
        for p in flat {
            for (i, &at) in y.iter().enumerate() {
                if (p.y - at).abs() <= half {
                    slabs[i].push(p.x);
                    heights[i] += p.y;
                }
            }
        }
        for (sum, slab) in heights.iter_mut().zip(&slabs) {
            *sum /= slab.len().max(1) as f64;
        }
        let ends: Vec<Option<(f64, f64)>> = slabs
            .iter_mut()
            .map(|slab| {
                base::sort_numbers(slab);
                // The first and last in a hundred may be stray.
                let cut = slab.len() / 100;
                Some((*slab.get(cut)?, *slab.get(slab.len().checked_sub(1 + cut)?)?))
            })
            .collect();
        let ends = bridged(&ends);
        let (left, right): (Vec<f64>, Vec<f64>) = ends.into_iter().unzip();
        let (mut left, mut right) = (smooth(&left, 1), smooth(&right, 1));
        // The points of the first and the last station all lie on one side of it: from their position the margins are
        // extended to its end, where they meet at most.
        let last = rows - 1;
        for [end, inner] in [[0, 2.min(last)], [last, last.saturating_sub(2)]] {
            let run = heights[end] - heights[inner];
            let share = if run == 0.0 { 0.0 } else { ((y[end] - heights[end]) / run).clamp(0.0, 1.0) };
            let [l, r] = [&left, &right].map(|m| m[end] + (m[end] - m[inner]) * share);
            let middle = 0.5 * (l + r);
            (left[end], right[end]) = (l.min(middle), r.max(middle));
        }
        let mut middle = crease(&y, &left, &right, field);
        steady(&mut middle, (hi - lo) / (rows - 1) as f64);
        for (i, &x) in middle.iter().enumerate() {
            (left[i], right[i]) = (left[i].min(x), right[i].max(x));
        }
        Self { y, left, middle, right }
    }

    pub(super) fn grid(&self, columns: usize, field: &HeightField) -> Vec<DVec3> {
        let half = columns / 2;
        let mut out = Vec::with_capacity(columns * self.y.len());
        for (i, &y) in self.y.iter().enumerate() {
            for j in 0..columns {
                let x = if j <= half {
                    base::ops::lerp(self.left[i], self.middle[i], j as f64 / half as f64)
                } else {
                    base::ops::lerp(self.middle[i], self.right[i], (j - half) as f64 / half as f64)
                };
                out.push(DVec3::new(x, y, field.height(x, y).0));
            }
        }
        out
    }
}

/// Fills stations without points (holes across the whole blade) with the mean of their neighbours.
fn bridged(ends: &[Option<(f64, f64)>]) -> Vec<(f64, f64)> {
    let known: Vec<(usize, (f64, f64))> =
        ends.iter().enumerate().filter_map(|(i, e)| Some((i, (*e)?))).collect();
    (0..ends.len())
        .map(|i| {
            let after = known.partition_point(|k| k.0 < i);
            match (after.checked_sub(1).map(|k| known[k].1), known.get(after).map(|k| k.1)) {
                (_, Some(b)) if known[after].0 == i => b,
                (Some(a), Some(b)) => (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)),
                (Some(e), None) | (None, Some(e)) => e,
                (None, None) => (0.0, 0.0),
            }
        })
        .collect()
}

fn smooth(line: &[f64], passes: usize) -> Vec<f64> {
    let mut line = line.to_vec();
    for _ in 0..passes {
        let old = line.clone();
        for i in 1..old.len().saturating_sub(1) {
            line[i] = 0.25 * old[i - 1] + 0.5 * old[i] + 0.25 * old[i + 1];
        }
    }
    line
}

/// Limits each sideways step to the length of a step along the blade: a corner of a blunt base, which may be all of the
/// first station, does not bend the midrib towards it.
pub(super) fn steady(line: &mut [f64], step: f64) {
    let half = line.len() / 2;
    for i in half + 1..line.len() {
        line[i] = line[i].clamp(line[i - 1] - step, line[i - 1] + step);
    }
    for i in (0..half).rev() {
        line[i] = line[i].clamp(line[i + 1] - step, line[i + 1] + step);
    }
}

/// Returns the midrib: the line near the middle along which the blade is folded most, as a valley or as a ridge.
fn crease(y: &[f64], left: &[f64], right: &[f64], field: &HeightField) -> Vec<f64> {
    const PLACES: usize = 31;
    let rows = y.len();
    // The middle half of each station.
    let place = |i: usize, k: usize| {
        let share = 0.25 + 0.5 * k as f64 / (PLACES - 1) as f64;
        base::ops::lerp(left[i], right[i], share)
    };
    let bend = |i: usize, k: usize| {
        let h = (0.12 * (right[i] - left[i])).max(1e-9);
        let x = place(i, k);
        let z = |x: f64| field.height(x, y[i]).0;
        (z(x - h) - 2.0 * z(x) + z(x + h)) / h
    };
    let bends: Vec<[f64; PLACES]> = (0..rows).map(|i| core::array::from_fn(|k| bend(i, k))).collect();
    let path = |sign: f64| -> (f64, Vec<usize>) {
        let mut score = vec![[0.0_f64; PLACES]; rows];
        let mut from = vec![[0_usize; PLACES]; rows];
        for i in 0..rows {
            for k in 0..PLACES {
                let aside = (k as f64 - (PLACES / 2) as f64) / (PLACES / 2) as f64;
                // Without a fold the line runs in the middle; a fold of a tenth outweighs it.
                let own = sign * bends[i][k] - 0.1 * aside * aside;
                let near = k.saturating_sub(2)..(k + 3).min(PLACES);
                let best = if i == 0 {
                    None
                } else {
                    let cost = |j: usize| score[i - 1][j] - 0.02 * (j.abs_diff(k) * j.abs_diff(k)) as f64;
                    near.map(|j| (cost(j), j)).max_by(|a, b| a.0.total_cmp(&b.0))
                };
                (score[i][k], from[i][k]) = best.map_or((own, k), |(s, j)| (s + own, j));
            }
        }
        let end = (0..PLACES).max_by(|&a, &b| score[rows - 1][a].total_cmp(&score[rows - 1][b])).unwrap_or(0);
        let mut line = vec![end; rows];
        for i in (1..rows).rev() {
            line[i - 1] = from[i][line[i]];
        }
        (score[rows - 1][end], line)
    };
    let (valley, ridge) = (path(1.0), path(-1.0));
    let line = if ridge.0 > valley.0 { ridge.1 } else { valley.1 };
    let xs: Vec<f64> = line.iter().enumerate().map(|(i, &k)| place(i, k)).collect();
    // Single steps are not the midrib's: smoothed over about a twelfth of the leaf.
    smooth(&xs, 12)
}
