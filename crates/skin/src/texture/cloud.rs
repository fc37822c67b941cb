//! Paints the surfaces that were found in a scan with the colours of its points.
//!
//! `points -> dots, few enough -> weights of the dots -> the reach that predicts left-out dots best -> texels -> holes
//! filled from around`
//!
//! All means are of linear light, not of the numbers in files.

use base::{Executor, map_indexed, ops};
use geom::{KdTree, Voxels, nearest_on_polyline3};
use glam::DVec3;
use mesh::Texture;
use plant::Sheet;

use super::filled::{Cell, Light, filled};

/// Most dots: more points are merged into cubes of one colour each, as a leaf's texture shows no more.
const MOST_DOTS: usize = 60_000;
/// Least number of points that show more than their mean colour.
const FEWEST_DOTS: usize = 16;
/// Radius of the neighbourhood in which a dot is judged, in spacings: 28 neighbours or so.
const AROUND: f64 = 3.0;
/// Distance from a dot to the mean of its neighbours, in their mean distances, above which it has lost its neighbours
/// on one side and lies at a margin. On an even sheet it is 0.17, on a straight margin 0.64.
const LOPSIDED: f64 = 0.42;
/// Distance from a dot at a margin, in spacings, up to which dots are not used: a scanner's beam falls there half on
/// the background.
const BESIDE: f64 = 1.0;
/// Least share of the dots of a narrow part that must remain; with less, all are used.
const LEFT: f64 = 0.3;
/// Deviations from the median of the neighbours, in the square root of light, that count as none: 5 of 255.
const EVEN: f64 = 0.02;
/// Reaches that are tried, in spacings of the dots.
const REACHES: [f64; 8] = [0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6];
/// Dots that are left out in turn to try them.
const TRIALS: usize = 1500;
/// Distance in reaches beyond which a dot has no weight.
const CUT: f64 = 2.5;
/// Distance of the nearest dot, in spacings, and relative to the usual one, above which a place is in a hole.
const HOLE: [f64; 2] = [3.0, 2.5];
/// Most texels along a blade, and fewest on a side.
const TEXELS: [f64; 2] = [512.0, 16.0];
/// Number of colours along a limb.
const PLACES: usize = 12;
/// Largest distance of a limb's points from its line, in its radii.
const ON_LIMB: f64 = 2.0;

/// Coloured points of one organ of a scan.
///
/// ```
/// use glam::DVec3;
/// let points: Vec<DVec3> = (0..400).map(|k| DVec3::new(f64::from(k % 20), f64::from(k / 20), 0.0)).collect();
/// let colors: Vec<[u8; 3]> = points.iter().map(|p| if p.x < 10.0 { [20, 120, 20] } else { [120, 70, 20] }).collect();
/// let cloud = skin::CloudColours::new(&points, &colors, &base::Serial).ok_or("no colours")?;
/// let along = cloud.along(&[DVec3::new(0.0, 9.5, 0.0), DVec3::new(19.0, 9.5, 0.0)], &[2.0, 2.0]);
/// assert!(along[0][1] > along[0][0] && along[11][0] > along[11][1]);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug)]
pub struct CloudColours {
    /// Every dot, for limbs.
    places: Vec<DVec3>,
    light: Vec<Light>,
    /// The dots that are used for painting.
    inner: Inner,
    spacing: f64,
    /// Standard deviation of the Gaussian weight of dots, metres.
    reach: f64,
}

/// Dots that are used for painting.
#[derive(Clone, Debug)]
struct Inner {
    tree: KdTree,
    places: Vec<DVec3>,
    light: Vec<Light>,
    /// Weight of each, 0 to 1.
    weight: Vec<f64>,
}

impl CloudColours {
    /// Prepares points with an sRGB colour each.
    ///
    /// Points that are completely black count as points without a colour. Guaranteed: the same bits for any executor.
    /// `None` for fewer than 16 points with a colour, or if all coincide. Cost: n log n; a million points take about a
    /// second.
    pub fn new(points: &[DVec3], colors: &[[u8; 3]], executor: &dyn Executor) -> Option<Self> {
        let (places, light) = dots(points, colors)?;
        let tree = KdTree::new(&places);
        let spacing = spacing(&places, &tree)?;
        let judged = map_indexed(executor, places.len(), |i| judged(i, &places, &light, &tree, spacing));
        let outer: Vec<DVec3> = (0..places.len()).filter(|i| judged[*i].0).map(|i| places[i]).collect();
        let margin = KdTree::new(&outer);
        let is_inner = |i: usize| margin.nearest(places[i], BESIDE * spacing).is_none();
        let mut rows: Vec<usize> = (0..places.len()).filter(|i| is_inner(*i)).collect();
        if (rows.len() as f64) < LEFT * places.len() as f64 {
            rows = (0..places.len()).collect();
        }
        let inside: Vec<DVec3> = rows.iter().map(|&i| places[i]).collect();
        let inner = Inner {
            tree: KdTree::new(&inside),
            places: inside,
            light: rows.iter().map(|&i| light[i]).collect(),
            weight: rows.iter().map(|&i| judged[i].1).collect(),
        };
        let wrong = map_indexed(executor, REACHES.len(), |k| inner.trial(REACHES[k] * spacing));
        let best = coarsest(&wrong);
        Some(Self { places, light, inner, spacing, reach: REACHES[best] * spacing })
    }

    /// Paints the texture of a sheet that lies among the points: in the coordinates u and 1 - v of its parameters.
    ///
    /// Each texel has the mean of the points around its place, with Gaussian weights of their distances; holes of the
    /// cloud are filled from their surroundings. Guaranteed: every texel is opaque; the same bits for any executor. Not
    /// guaranteed: detail finer than the cloud. Cost: linear in texels, of which there are at most 512 along the blade.
    pub fn sheet(&self, sheet: &Sheet, executor: &dyn Executor) -> Texture {
        let (width, height) = size(sheet, 0.5 * self.reach);
        let columns = width as usize;
        let place = |k: usize| {
            let share = |i: usize, n: u32| (i as f64 + 0.5) / f64::from(n);
            place(sheet, share(k % columns, width), 1.0 - share(k / columns, height))
        };
        let count = columns * height as usize;
        let rows = map_indexed(executor, height as usize, |row| {
            let near = |k: usize| {
                let p = place(k)?;
                let dot = self.inner.tree.nearest(p, f64::INFINITY)?;
                Some((p, self.inner.places[dot].distance(p)))
            };
            (row * columns..(row + 1) * columns).map(near).collect::<Vec<_>>()
        });
        let usual = base::median(rows.iter().flatten().flatten().map(|n| n.1).collect()).unwrap_or(0.0);
        let far = (HOLE[0] * self.spacing).max(HOLE[1] * usual);
        let cells = map_indexed(executor, height as usize, |row| {
            let known = |near: &Option<(DVec3, f64)>| near.filter(|n| n.1 <= far);
            let paint = |near| known(near).and_then(|near| self.inner.light_at(near, self.reach, usize::MAX));
            rows[row].iter().map(paint).collect::<Vec<Cell>>()
        });
        let whole = filled(cells.concat(), columns);
        let mean = weighted(self.light.iter().map(|l| (*l, 1.0))).unwrap_or_default();
        let mut pixels = Vec::with_capacity(4 * count);
        for cell in whole {
            let [r, g, b] = cell.unwrap_or(mean).map(base::byte_of_light);
            pixels.extend([r, g, b, 255]);
        }
        Texture { width, height, pixels }
    }

    /// Returns colours along a limb with a radius at each point of its line, at twelve even shares of its length,
    /// linear RGB; empty if no point lies on it.
    pub fn along(&self, line: &[DVec3], radii: &[f64]) -> Vec<[f32; 3]> {
        if line.len() < 2 || radii.is_empty() {
            return Vec::new();
        }
        let thick = radii.iter().copied().fold(0.0, f64::max);
        let mut places = vec![Vec::new(); PLACES];
        for (row, p) in self.places.iter().enumerate() {
            let (gap, share) = nearest_on_polyline3(line, *p);
            if gap <= ON_LIMB * thick {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1")]
                places[((share * PLACES as f64) as usize).min(PLACES - 1)].push(row);
            }
        }
        let cells: Vec<Cell> = places.iter().map(|rows| self.usual(rows)).collect();
        if cells.iter().all(Option::is_none) {
            return Vec::new();
        }
        let nearest = |k: usize| {
            let known = (0..PLACES).filter(|i| cells[*i].is_some());
            known.min_by_key(|i| i.abs_diff(k)).and_then(|i| cells[i]).unwrap_or_default()
        };
        let whole: Vec<Light> = (0..PLACES).map(nearest).collect();
        let smooth = |k: usize| {
            let [a, b, c] = [k.saturating_sub(1), k, (k + 1).min(PLACES - 1)].map(|i| whole[i]);
            narrow([0, 1, 2].map(|i| 0.25 * (a[i] + c[i]) + 0.5 * b[i]))
        };
        (0..PLACES).map(smooth).collect()
    }

    /// Returns the mean colour of dots, without the darkest and the lightest quarter of them: many dots of a thin limb
    /// are half background.
    fn usual(&self, rows: &[usize]) -> Cell {
        let mut rows = rows.to_vec();
        let bright = |row: &usize| self.light[*row].iter().sum::<f64>();
        base::sort_by(&mut rows, |a, b| bright(a).total_cmp(&bright(b)));
        let cut = rows.len() / 4;
        weighted(rows[cut..rows.len() - cut].iter().map(|&row| (self.light[row], 1.0)))
    }
}

impl Inner {
    /// Returns the light at a place whose nearest dot is `gap` away, without the dot `but`.
    fn light_at(&self, (p, gap): (DVec3, f64), reach: f64, but: usize) -> Cell {
        let mut near = Vec::new();
        // A surface at a distance from the points has all of them that much farther away.
        self.tree.within(p, (gap * gap + CUT * CUT * reach * reach).sqrt(), &mut near);
        let bell = |i: usize| {
            let over = self.places[i].distance_squared(p) - gap * gap;
            self.weight[i] * ops::exp(-0.5 * over.max(0.0) / (reach * reach))
        };
        weighted(near.into_iter().filter(|i| *i != but).map(|i| (self.light[i], bell(i))))
    }

    /// Returns the errors of the prediction of dots by the others with a reach: the weighted squared error of each
    /// tried dot.
    fn trial(&self, reach: f64) -> Vec<f64> {
        let step = self.places.len().div_ceil(TRIALS).max(1);
        let one = |i: usize| {
            let mut gaps = [0.0; 2];
            // The first is the dot itself.
            self.tree.nearest_distances(self.places[i], &mut gaps);
            let guess = self.light_at((self.places[i], gaps[1]), reach, i)?;
            let off =
                tone(guess).iter().zip(tone(self.light[i])).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            Some(self.weight[i] * off)
        };
        (0..self.places.len()).step_by(step).map(|i| one(i).unwrap_or(0.0)).collect()
    }
}

/// Returns the coarsest reach that predicts no worse than the best one beyond chance: by one standard error of the mean
/// of their differences (Breiman et al. 1984, section 3.4.3).
fn coarsest(wrong: &[Vec<f64>]) -> usize {
    let sum = |k: usize| wrong[k].iter().sum::<f64>();
    let best = (0..wrong.len()).fold(0, |best, k| if sum(k) < sum(best) { k } else { best });
    let as_good = |k: &usize| {
        let more = wrong[*k].iter().zip(&wrong[best]).map(|(a, b)| a - b);
        let n = wrong[best].len() as f64;
        let mean = more.clone().sum::<f64>() / n;
        let variance = more.map(|m| (m - mean) * (m - mean)).sum::<f64>() / n;
        mean <= (variance / n).sqrt()
    };
    (best..wrong.len()).rev().find(as_good).unwrap_or(best)
}

/// Returns usable points with their light, or if there are many the mean of each cube.
fn dots(points: &[DVec3], colors: &[[u8; 3]]) -> Option<(Vec<DVec3>, Vec<Light>)> {
    let usable = |row: &(&DVec3, &[u8; 3])| row.0.is_finite() && *row.1 != [0; 3];
    let kept = points.iter().zip(colors).filter(usable);
    let (places, light): (Vec<DVec3>, Vec<Light>) =
        kept.map(|(p, c)| (*p, c.map(base::light_of_byte))).unzip();
    if places.len() < FEWEST_DOTS {
        return None;
    }
    if places.len() <= MOST_DOTS {
        return Some((places, light));
    }
    let cubes = Voxels::new(&places, places.len() as f64 / MOST_DOTS as f64);
    let mean =
        |c: usize| weighted(cubes.rows(c).iter().map(|&i| (light[i as usize], 1.0))).unwrap_or_default();
    let lights = (0..cubes.len()).map(mean).collect();
    Some((cubes.means(&places), lights))
}

/// Returns the spacing of dots: the edge of the square that each has, if the sixth neighbour is as far as on an even
/// sheet.
fn spacing(places: &[DVec3], tree: &KdTree) -> Option<f64> {
    let step = places.len().div_ceil(2000).max(1);
    let sixth = places.iter().step_by(step).map(|p| {
        let mut gaps = [0.0; 7];
        tree.nearest_distances(*p, &mut gaps);
        gaps[6]
    });
    let spacing = base::median(sixth.collect())? * (ops::PI / 6.0).sqrt();
    (spacing > 0.0 && spacing.is_finite()).then_some(spacing)
}

/// Returns whether a dot lies at a margin, and its weight: lower the more it differs from its surroundings.
fn judged(row: usize, places: &[DVec3], light: &[Light], tree: &KdTree, spacing: f64) -> (bool, f64) {
    let (p, mut near) = (places[row], Vec::new());
    tree.within(p, AROUND * spacing, &mut near);
    near.retain(|i| *i != row);
    if near.len() < 3 {
        return (true, 1.0);
    }
    let n = near.len() as f64;
    let middle = near.iter().map(|&i| places[i] - p).sum::<DVec3>() / n;
    let away = near.iter().map(|&i| places[i].distance(p)).sum::<f64>() / n;
    let own = tone(light[row]);
    let alike = [0, 1, 2].map(|k| {
        let tones = near.iter().map(|&i| tone(light[i])[k]);
        let usual = base::median(tones.clone().collect()).unwrap_or(own[k]);
        let spread = base::median(tones.map(|t| (t - usual).abs()).collect()).unwrap_or(0.0);
        // 4.685 deviations, estimated from the median (Huber 1981).
        let x = (own[k] - usual) / (4.685 * 1.4826 * spread.max(EVEN));
        if x.abs() < 1.0 { (1.0 - x * x) * (1.0 - x * x) } else { 0.0 }
    });
    // Never 0: a place may have no other dot.
    (middle.length() > LOPSIDED * away, alike[0].min(alike[1]).min(alike[2]).max(1e-3))
}

/// Converts light to a nearly perceptual scale.
fn tone(light: Light) -> [f64; 3] {
    light.map(f64::sqrt)
}

fn weighted(rows: impl Iterator<Item = (Light, f64)>) -> Cell {
    let (mut sum, mut all) = ([0.0; 3], 0.0);
    for (light, weight) in rows {
        sum = [0, 1, 2].map(|k| sum[k] + weight * light[k]);
        all += weight;
    }
    (all > 0.0).then(|| sum.map(|x| x / all))
}

#[expect(clippy::cast_possible_truncation, reason = "a colour")]
fn narrow(light: Light) -> [f32; 3] {
    light.map(|x| x as f32)
}

/// Returns width and height of a texture whose texels are `step` metres wide on the sheet, within bounds.
fn size(sheet: &Sheet, step: f64) -> (u32, u32) {
    let n = sheet.across.len().max(1);
    let middle: Vec<DVec3> = sheet.points.iter().skip(n / 2).step_by(n).copied().collect();
    let long = geom::polyline_length3(&middle);
    let wide = sheet.points.chunks(n).map(geom::polyline_length3).fold(0.0, f64::max);
    let step = step.max(long.max(wide) / TEXELS[0]).max(f64::MIN_POSITIVE);
    let count = |length: f64| ops::whole((length / step).ceil().clamp(TEXELS[1], TEXELS[0]));
    (count(wide), count(long))
}

/// Returns the point of a sheet at u and at a share of the length to the tip.
fn place(sheet: &Sheet, u: f64, share: f64) -> Option<DVec3> {
    let n = sheet.across.len();
    let ((j, s), (i, t)) = (between(&sheet.across, u)?, between(&sheet.along, share)?);
    let at = |i: usize, j: usize| sheet.points.get(i * n + j).copied();
    let (near, far) = (at(i, j)?.lerp(at(i, j + 1)?, s), at(i + 1, j)?.lerp(at(i + 1, j + 1)?, s));
    Some(near.lerp(far, t))
}

/// Returns the interval of monotonic numbers that contains x, and the position in it from the first end to the second.
fn between(numbers: &[f64], x: f64) -> Option<(usize, f64)> {
    let last = numbers.len().checked_sub(2)?;
    let falls = numbers[0] > numbers[last + 1];
    let after = numbers.partition_point(|n| if falls { *n > x } else { *n < x });
    let k = after.saturating_sub(1).min(last);
    let span = numbers[k + 1] - numbers[k];
    let share = (x - numbers[k]) / span;
    Some((k, if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }))
}
