//! Features of a single stroke: `InkStroke -> Shape -> StrokeFeatures` (with those that [`context`](super::context)
//! adds).

use base::ops;
use geom::convex_hull;
use glam::DVec2;

use super::region::Region;

/// Number of samples on which a stroke is measured: a corolla of twelve petals still has eight on each.
pub(super) const SAMPLES: usize = 96;

macro_rules! columns {
    ($($(#[$doc:meta])* $name:ident,)+) => {
        /// Features of one stroke as the classifier sees them: scale-free numbers, about -1 to 3 each, always finite.
        ///
        /// They do not depend on the direction in which a stroke was drawn, nor on left and right.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct StrokeFeatures { $($(#[$doc])* pub $name: f64,)+ }

        impl StrokeFeatures {
            /// The features' names, in the order of [`values`](Self::values): the header of the table.
            pub const NAMES: [&'static str; [$(stringify!($name)),+].len()] = [$(stringify!($name)),+];

            /// Returns the numbers in the order of [`NAMES`](Self::NAMES).
            pub fn values(&self) -> [f64; Self::NAMES.len()] { [$(self.$name),+] }

            /// Returns the features of a row of the table.
            pub fn from_values(values: [f64; Self::NAMES.len()]) -> Self {
                let [$($name),+] = values;
                Self { $($name),+ }
            }

            /// Replaces numbers that are not finite by 0 and limits huge ones to 10.
            pub(super) fn tamed(self) -> Self {
                Self::from_values(self.values().map(|x| if x.is_finite() { x.clamp(-10.0, 10.0) } else { 0.0 }))
            }
        }
    };
}

columns! {
    /// Distance of the two ends over length: the first feature of He and Cheng (2021), section 4.1.
    gap,
    /// Square root of the ratio of the smaller to the larger eigenvalue of the points' covariance: the inverse of their
    /// second feature, so that it stays in \[0, 1\].
    slim,
    /// Root of the area of the principal box over length: their third feature, made scale-free.
    box_area,
    /// Area enclosed when the ends are joined, over that of a circle of the same length.
    round,
    /// Enclosed area over the area of the convex hull.
    solid,
    /// Perimeter of the convex hull over length.
    hull,
    /// Total turning, in full turns, as ln(1 + turns).
    turning,
    /// Net turning in full turns, at most 3.
    turns,
    /// ln(1 + corners above 50 degrees).
    corners,
    /// ln(1 + corners that turn against the direction of the outline): the notches between lobes.
    inward,
    /// The sharpest corner over a half turn.
    sharpest,
    /// ln(1 + crossings with itself).
    crossings,
    /// ln(1 + maxima of the distance from the middle).
    lobes,
    /// Share of the length that runs straight.
    straight,
    /// Share of the length that is nearly upright.
    upright,
    /// Share of the length that is nearly level.
    level,
    /// Position of the gap between the ends: -1 below, 1 above the middle, 0 when closed.
    opening,
    /// How level the line between the ends is, times the gap.
    opening_level,
    /// Length over the drawing's diagonal.
    length,
    /// Width of its box over the drawing's.
    width,
    /// Height of its box over the drawing's.
    height,
    /// Height over width plus height.
    tall,
    /// Its lowest point in the drawing's box.
    bottom,
    /// Level distance of its two ends over the drawing's width.
    ends_apart,
    /// Number in the order of drawing, 0 first, 1 last.
    order,
    /// 1 for the first stroke.
    first,
    /// Share of the strokes that are shorter.
    rank,
    /// Length over the longest stroke's.
    of_longest,
    /// Length over the whole ink's.
    of_ink,
    /// ln(1 + strokes of about its size and form).
    alike,
    /// Share of it inside the outline that holds most of it.
    inside,
    /// Roundness of that outline.
    inside_round,
    /// ln(1 + corners of that outline).
    inside_corners,
    /// Share of it inside the drawing's body: the largest region that one stroke or two joined ones enclose.
    in_body,
    /// Share of it inside the convex hull of the one other stroke that holds most of it.
    in_hull,
    /// Straightness of the stroke at the nearer end: its gap.
    near_gap,
    /// Cosine of the angle between it and that stroke where they meet.
    near_along,
    /// 1 for a stroke of the body's outline.
    is_body,
    /// Share of it inside the convex hull of all other strokes.
    amid,
    /// Distance from its lower end to the nearest other stroke, diagonals, at most 0.2, over 0.2.
    low_gap,
    /// Distance from its upper end to the nearest other stroke.
    high_gap,
    /// Position at which its lower end meets that stroke: 0 at an end, 1 in the middle.
    low_where,
    /// Roundness of the stroke that the lower end is nearest to.
    low_round,
    /// Roundness of the stroke that the upper end is nearest to.
    high_round,
    /// Length of the stroke at the lower end over both lengths.
    low_length,
    /// Length of the stroke at the upper end over both lengths.
    high_length,
    /// ln(1 + ends of other strokes that lie on it).
    guests,
    /// ln(1 + lines whose upper end lies on its lower half).
    stems,
    /// Share of its two ends that touch another stroke.
    ends_touch,
    /// 1 where both ends touch the same stroke.
    both_same,
    /// Distance of the stroke that runs most nearly parallel to it, over its length.
    partner_gap,
    /// Share of the other strokes that lie in its box widened by a tenth of the diagonal.
    company,
    /// Largest roundness of a stroke that lies mostly above its middle.
    round_above,
    /// Width of the widest stroke that lies mostly above its middle, over the drawing's width.
    wide_above,
    /// Width of the widest stroke that lies mostly below its middle, over the drawing's width.
    wide_below,
    /// Best pair of upright parallel lines below its middle.
    pair_below,
    /// Best pair of upright parallel lines above its middle.
    pair_above,
    /// Largest corner count of a stroke that lies mostly above its middle.
    corners_above,
    /// Roundness of the stroke drawn before it; -1 for the first.
    before_round,
    /// Roundness of the stroke drawn after it; -1 for the last.
    after_round,
    /// Length of the stroke drawn before over both lengths.
    before_length,
    /// Length of the stroke drawn after over both lengths.
    after_length,
    /// The drawing: ln(strokes) / 4.
    d_strokes,
    /// The drawing: height over width plus height.
    d_tall,
    /// The drawing: total ink over its diagonal, as ln(1 + ink).
    d_ink,
    /// The drawing: share of strokes that enclose an area.
    d_round,
    /// The drawing: area of the largest enclosed region over the box.
    d_largest,
    /// The drawing: share of strokes shorter than a tenth of the diagonal.
    d_short,
    /// The drawing: best pair of parallel upright lines, 0 to 1.
    d_pair,
    /// The drawing: width of the lowest fifth of the ink over the width.
    d_foot,
    /// The drawing: ln(1 + most corners of any stroke).
    d_corners,
    /// The drawing: ln(1 + most strokes inside one).
    d_holds,
    /// The drawing: roundness of its lowest wide stroke.
    d_base_round,
    /// The drawing: opening of its lowest wide stroke.
    d_base_opening,
    /// The drawing: area of its body's box over its own.
    d_body_area,
    /// The drawing: solidity of its body.
    d_body_solid,
    /// The drawing: lowest point of its body.
    d_body_bottom,
}

/// One stroke, measured on its own.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    /// [`SAMPLES`] points at even arc length.
    pub(super) points: Vec<DVec2>,
    /// Region that every second sample encloses; empty for lines.
    pub(super) region: Region,
    /// Region inside the hull; empty for straight lines.
    pub(super) hull_region: Region,
    pub(super) hull_area: f64,
    /// Convex hull, counter-clockwise.
    pub(super) hull: Vec<DVec2>,
    pub(super) length: f64,
    pub(super) min: DVec2,
    pub(super) max: DVec2,
    pub(super) middle: DVec2,
    /// Area with the ends joined.
    pub(super) area: f64,
    pub(super) round: f64,
    /// Whether the regions are computed.
    pub(super) enclosed: bool,
}

impl Shape {
    /// Computes its regions, or drops them.
    pub(super) fn enclose(&mut self, wanted: bool) {
        self.enclosed = wanted;
        if !wanted {
            (self.region, self.hull_region) = (Region::default(), Region::default());
            return;
        }
        if self.round > 0.1 {
            self.region = Region::new(&self.points.iter().copied().step_by(2).collect::<Vec<_>>());
        }
        if self.hull_area > 0.02 * self.length * self.length {
            self.hull_region = Region::new(&self.hull);
        }
    }

    pub(super) fn size(&self) -> DVec2 {
        self.max - self.min
    }

    pub(super) fn first(&self) -> DVec2 {
        self.points.first().copied().unwrap_or_default()
    }

    pub(super) fn last(&self) -> DVec2 {
        self.points.last().copied().unwrap_or_default()
    }

    /// Whether it encloses an area rather than being a line.
    pub(super) fn encloses(&self) -> bool {
        self.round > 0.2
    }
}

/// Returns even samples, box, hull and area of a stroke, and the features that need nothing else.
pub(super) fn shape(points: &[DVec2]) -> (Shape, StrokeFeatures) {
    let (points, length) = even_samples(points);
    let mut s = Shape { length, ..Shape::default() };
    let mut f = StrokeFeatures::default();
    let n = points.len();
    if n < 3 || length <= 1e-12 {
        let p = points.first().copied().unwrap_or_default();
        (s.min, s.max, s.middle, s.points) = (p, p, p, vec![p; SAMPLES]);
        return (s, f);
    }
    let count = n as f64;
    s.min = points.iter().fold(points[0], |a, &p| a.min(p));
    s.max = points.iter().fold(points[0], |a, &p| a.max(p));
    s.middle = points.iter().sum::<DVec2>() / count;
    s.hull = convex_hull(&points);
    s.area = signed_area(&points).abs();
    s.points = points;
    s.round = 4.0 * ops::PI * s.area / (length * length);
    let hull_area = signed_area(&s.hull).abs();
    s.hull_area = hull_area;
    f.gap = s.first().distance(s.last()) / length;
    principal(&s, &mut f);
    f.round = s.round;
    f.solid = if hull_area > 1e-12 { s.area / hull_area } else { 0.0 };
    f.hull = perimeter(&s.hull) / length;
    bending(&s, &mut f);
    f.crossings = ops::ln(1.0 + self_crossings(&s.points));
    radial(&s, &mut f);
    slopes(&s, &mut f);
    openings(&s, &mut f);
    (s, f)
}

/// Returns `SAMPLES` points at even arc length, and the length.
fn even_samples(points: &[DVec2]) -> (Vec<DVec2>, f64) {
    let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    if points.len() < 2 || length <= 0.0 || !length.is_finite() {
        return (points.first().copied().filter(|p| p.is_finite()).into_iter().collect(), 0.0);
    }
    let mut out = Vec::with_capacity(SAMPLES);
    let step = length / (SAMPLES - 1) as f64;
    let (mut segment, mut behind) = (0, 0.0);
    for k in 0..SAMPLES {
        let at = step * k as f64;
        let mut here = points[segment].distance(points[segment + 1]);
        while behind + here < at && segment + 2 < points.len() {
            behind += here;
            segment += 1;
            here = points[segment].distance(points[segment + 1]);
        }
        let t = if here > 0.0 { ((at - behind) / here).clamp(0.0, 1.0) } else { 0.0 };
        out.push(points[segment].lerp(points[segment + 1], t));
    }
    (out, length)
}

/// Returns the square root of the eigenvalue ratio of the points' covariance, and the unit vector of the larger one.
fn slimness(points: &[DVec2]) -> (f64, DVec2) {
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    let middle = points.iter().sum::<DVec2>() / points.len().max(1) as f64;
    for &p in points {
        let d = p - middle;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    let mean = (xx + yy) / 2.0;
    let root = ((xx - yy) * (xx - yy) / 4.0 + xy * xy).sqrt();
    let (large, small) = (mean + root, (mean - root).max(0.0));
    let slim = if large > 0.0 { (small / large).sqrt() } else { 0.0 };
    let (sin, cos) = ops::sin_cos(0.5 * ops::atan2(2.0 * xy, xx - yy));
    (slim, DVec2::new(cos, sin))
}

/// Computes features 2 and 3 of He and Cheng (2021), section 4.1.
fn principal(s: &Shape, f: &mut StrokeFeatures) {
    let (slim, u) = slimness(&s.points);
    let v = u.perp();
    f.slim = slim;
    let reach = |axis: DVec2| {
        let (lo, hi) = s.points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| {
            let x = p.dot(axis);
            (lo.min(x), hi.max(x))
        });
        (hi - lo).max(0.0)
    };
    f.box_area = (reach(u) * reach(v)).sqrt() / s.length;
}

/// Returns the signed angle from `a` to `b`, radians; 0 where one of them has no length.
fn angle(a: DVec2, b: DVec2) -> f64 {
    if a.length_squared() > 0.0 && b.length_squared() > 0.0 {
        ops::atan2(a.perp_dot(b), a.dot(b))
    } else {
        0.0
    }
}

/// Measures turning, corners and straight parts.
fn bending(s: &Shape, f: &mut StrokeFeatures) {
    // Two samples to each side: a corner that the pen rounded off still counts, the jitter of the hand does not.
    const REACH: usize = 2;
    let p = &s.points;
    let n = p.len();
    let signed: Vec<f64> =
        (0..n)
            .map(|k| {
                if k < REACH || k + REACH >= n {
                    0.0
                } else {
                    angle(p[k] - p[k - REACH], p[k + REACH] - p[k])
                }
            })
            .collect();
    let (mut total, mut net) = (0.0, 0.0);
    for a in signed[REACH..n - REACH].iter().step_by(REACH) {
        total += a.abs();
        net += a;
    }
    f.turning = ops::ln(1.0 + total / ops::TAU);
    f.turns = (net.abs() / ops::TAU).min(3.0);
    let bend: Vec<f64> = signed.iter().map(|a| a.abs()).collect();
    let (mut corners, mut straight, mut inward) = (0.0, 0.0, 0.0);
    let way = signed_area(p);
    for k in 0..n {
        let lo = k.saturating_sub(REACH);
        let hi = (k + REACH).min(n - 1);
        let peak = (lo..k).all(|j| bend[j] < bend[k]) && (k + 1..=hi).all(|j| bend[j] <= bend[k]);
        if peak && bend[k] > 50.0 / 180.0 * ops::PI {
            corners += 1.0;
            if signed[k] * way < 0.0 {
                inward += 1.0;
            }
        }
        if bend[k] < 0.12 {
            straight += 1.0;
        }
    }
    f.corners = ops::ln(1.0 + corners);
    f.inward = ops::ln(1.0 + inward);
    f.sharpest = bend.iter().fold(0.0_f64, |a, &b| a.max(b)) / ops::PI;
    f.straight = straight / n as f64;
}

/// Measures the distance from the middle along the stroke: lobes.
fn radial(s: &Shape, f: &mut StrokeFeatures) {
    let n = s.points.len();
    let r: Vec<f64> = s.points.iter().map(|p| p.distance(s.middle)).collect();
    let mean = r.iter().sum::<f64>() / n as f64;
    if mean <= 0.0 {
        return;
    }
    // A lobe rises and falls by a tenth of the mean radius.
    let (mut lobes, mut rising, mut low, mut high) = (0.0, true, r[0], r[0]);
    for &x in &r {
        if rising {
            high = high.max(x);
            if x < high - 0.1 * mean {
                (lobes, rising, low) = (lobes + 1.0, false, x);
            }
        } else {
            low = low.min(x);
            if x > low + 0.1 * mean {
                (rising, high) = (true, x);
            }
        }
    }
    f.lobes = ops::ln(1.0_f64 + lobes);
}

/// Measures the shares of upright and level length.
fn slopes(s: &Shape, f: &mut StrokeFeatures) {
    let (mut upright, mut level) = (0.0, 0.0);
    for w in s.points.windows(3).step_by(2) {
        let d = (w[2] - w[0]).abs();
        if d.y > 2.0 * d.x {
            upright += 1.0;
        }
        if d.x > 2.0 * d.y {
            level += 1.0;
        }
    }
    let steps = ((s.points.len() - 1) / 2) as f64;
    (f.upright, f.level) = (upright / steps, level / steps);
    let size = s.size();
    f.tall = size.y / (size.x + size.y).max(1e-12);
}

/// Measures where the ends lie, seen from the middle.
fn openings(s: &Shape, f: &mut StrokeFeatures) {
    let (a, b) = (s.first(), s.last());
    let ends = (a + b) / 2.0;
    let half = (s.size().y / 2.0).max(1e-12);
    f.opening = ((ends.y - s.middle.y) / half).clamp(-1.0, 1.0);
    let d = (b - a).abs();
    f.opening_level = if d.x + d.y > 1e-12 { d.x / (d.x + d.y) * f.gap } else { 0.0 };
}

/// Returns the signed area as [`geom::signed_area`] does, but without shifting the coordinates: the models were trained
/// with its rounding.
pub(super) fn signed_area(polygon: &[DVec2]) -> f64 {
    let Some(&last) = polygon.last() else { return 0.0 };
    let mut before = last;
    let mut twice = 0.0;
    for &p in polygon {
        twice += before.perp_dot(p);
        before = p;
    }
    twice / 2.0
}

fn perimeter(polygon: &[DVec2]) -> f64 {
    let Some(&last) = polygon.last() else { return 0.0 };
    let mut before = last;
    let mut sum = 0.0;
    for &p in polygon {
        sum += before.distance(p);
        before = p;
    }
    sum
}

/// Whether the open segments `ab` and `cd` cross.
fn cross(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// Counts crossings of every second chord.
fn self_crossings(points: &[DVec2]) -> f64 {
    let p: Vec<DVec2> = points.iter().copied().step_by(2).collect();
    let mut count = 0.0;
    for i in 0..p.len().saturating_sub(3) {
        let (lo, hi) = (p[i].min(p[i + 1]), p[i].max(p[i + 1]));
        for j in i + 2..p.len() - 1 {
            let (c, d) = (p[j], p[j + 1]);
            if c.x.max(d.x) < lo.x || c.x.min(d.x) > hi.x || c.y.max(d.y) < lo.y || c.y.min(d.y) > hi.y {
                continue;
            }
            if cross(p[i], p[i + 1], c, d) {
                count += 1.0;
            }
        }
    }
    count
}
