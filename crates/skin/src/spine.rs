//! Smooth, densely sampled centre lines with radii through the nodes of an axis; and these lines as drawn.

use glam::DVec3;

/// A centre line: samples of position, unit tangent, radius and arc length, straight between them. At least 2 samples,
/// length > 0. Dense from [`Spine::new`]; as drawn one sample for each ring, with the arc lengths of the dense line.
#[derive(Clone, Debug)]
pub(crate) struct Spine {
    pub p: Vec<DVec3>,
    pub t: Vec<DVec3>,
    pub r: Vec<f64>,
    pub s: Vec<f64>,
    /// The sample at each kept input point, with that point's index.
    pub knots: Vec<(usize, usize)>,
}

/// A point on a [`Spine`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Station {
    /// Its arc length.
    pub s: f64,
    pub centre: DVec3,
    pub tangent: DVec3,
    pub radius: f64,
    /// Change of radius per metre along the line.
    pub slope: f64,
}

/// Position of the fillet along a branch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    /// Station where the centre line leaves the bearer.
    pub exit: Station,
    /// The bearer's arc length there.
    pub on: f64,
    /// The arc length at which the fillet ends and the branch's own tube starts.
    pub top: f64,
}

// Least radius, as a share of the axis's length: a line without width has no surface.
const THINNEST: f64 = 1.0 / 2000.0;
// Largest radius x curvature: rings fold over one another at 1.
const TIGHTEST: f64 = 0.7;

/// Least vertical component of the direction at the foot of an axis that stands on the ground: 45 degrees off the
/// vertical.
const STANDS: f64 = 0.7;

impl Spine {
    /// Makes the curve through `points`, in about `samples` pieces; `first` replaces the first tangent.
    ///
    /// Points that are not finite or repeat their predecessor are dropped; `None` when fewer than 2 remain. Missing
    /// radii equal the last one given. Where the axis bends more sharply than its thickness allows, the line is
    /// smoothed, ends kept.
    pub(crate) fn new(points: &[DVec3], radii: &[f64], samples: usize, first: Option<DVec3>) -> Option<Self> {
        let (keep, total) = clean(points);
        if keep.len() < 2 {
            return None;
        }
        let q: Vec<DVec3> = keep.iter().map(|&i| points[i]).collect();
        let least = total * THINNEST;
        let radius = |i: usize| {
            let r = radii.get(i).or(radii.last()).copied().unwrap_or(0.0);
            if r.is_finite() { r.clamp(least, total * 4.0) } else { least }
        };
        let rq: Vec<f64> = keep.iter().map(|&i| radius(i)).collect();
        let slopes = tangents(&q, first);
        #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
        let step = total / samples.clamp(2, 4000) as f64;
        let mut spine = Self {
            p: Vec::with_capacity(samples + q.len() + 2),
            t: Vec::new(),
            r: Vec::with_capacity(samples + q.len() + 2),
            s: Vec::with_capacity(samples + q.len() + 2),
            knots: Vec::with_capacity(q.len()),
        };
        for k in 0..q.len() - 1 {
            let h = q[k].distance(q[k + 1]);
            // No finer than a quarter of the radius: finer steps only copy the jitter of the pen.
            let want = step.max(0.25 * rq[k].min(rq[k + 1]));
            let pieces = base::ops::whole((h / want).ceil().clamp(1.0, 512.0));
            spine.knots.push((spine.p.len(), keep[k]));
            for j in 0..pieces {
                let u = f64::from(j) / f64::from(pieces);
                spine.p.push(hermite(q[k], slopes[k] * h, q[k + 1], slopes[k + 1] * h, u));
                spine.r.push(base::ops::lerp(rq[k], rq[k + 1], u));
            }
        }
        let last = q.len() - 1;
        spine.knots.push((spine.p.len(), keep[last]));
        spine.p.push(q[last]);
        spine.r.push(rq[last]);
        smooth_radii(&mut spine.r);
        ease_sharp_bends(&mut spine.p, &spine.r);
        spine.finish(first);
        Some(spine)
    }

    fn finish(&mut self, first: Option<DVec3>) {
        let n = self.p.len();
        self.s.clear();
        self.s.push(0.0);
        for i in 1..n {
            let s = self.s[i - 1] + self.p[i].distance(self.p[i - 1]);
            self.s.push(s);
        }
        self.t = (0..n)
            .map(|i| (self.p[(i + 1).min(n - 1)] - self.p[i.saturating_sub(1)]).normalize_or_zero())
            .collect();
        if let Some(d) = first {
            self.t[0] = d;
        }
        // A point of reversal has no direction of its own: it takes its predecessor's.
        let mut before = self.t.iter().copied().find(|t| *t != DVec3::ZERO).unwrap_or(DVec3::Y);
        for t in &mut self.t {
            if *t == DVec3::ZERO {
                *t = before;
            }
            before = *t;
        }
    }

    /// Swells the base as trunks do at the ground: by a share, over a number of radii.
    pub(crate) fn root_flare(&mut self, (wider, over): (f64, f64)) {
        let base = self.r[0];
        for (r, s) in self.r.iter_mut().zip(&self.s) {
            let u = (1.0 - s / (over * base)).max(0.0);
            *r *= 1.0 + wider * u * u;
        }
    }

    /// Makes the first cross-section horizontal, so that a leaning trunk meets the ground all round. An axis that lies
    /// more than it stands is not changed.
    pub(crate) fn stand(&mut self) {
        if self.t[0].y > STANDS {
            self.t[0] = DVec3::Y;
        }
    }

    /// Returns the radius an eighth of the way up: past the collar or root flare.
    pub(crate) fn stout(&self) -> f64 {
        self.r[self.r.len() / 8]
    }

    /// Returns the larger of [`Spine::stout`] and the radius half way up: a body may be drawn with a narrow foot.
    pub(crate) fn stoutest(&self) -> f64 {
        self.stout().max(self.r[self.r.len() / 2])
    }

    pub(crate) fn length(&self) -> f64 {
        self.s.last().copied().unwrap_or(0.0)
    }

    /// Returns the station at arc length `s`, clamped to the ends.
    pub(crate) fn station_at(&self, s: f64) -> Station {
        self.station(self.piece(s), s)
    }

    /// Returns the piece in which arc length `s` lies.
    pub(crate) fn piece(&self, s: f64) -> usize {
        self.s.partition_point(|&x| x <= s).clamp(1, self.s.len() - 1) - 1
    }

    /// Returns the station at arc length `s` of piece `i`.
    pub(crate) fn station(&self, i: usize, s: f64) -> Station {
        let h = self.s[i + 1] - self.s[i];
        let u = if h > 0.0 { ((s - self.s[i]) / h).clamp(0.0, 1.0) } else { 0.0 };
        let slope = if h > 0.0 { (self.r[i + 1] - self.r[i]) / h } else { 0.0 };
        Station {
            s: base::ops::lerp(self.s[i], self.s[i + 1], u),
            centre: self.p[i].lerp(self.p[i + 1], u),
            tangent: self.t[i].lerp(self.t[i + 1], u).try_normalize().unwrap_or(self.t[i]),
            radius: base::ops::lerp(self.r[i], self.r[i + 1], u),
            slope: slope.clamp(-1.0, 1.0),
        }
    }

    /// Returns the station nearest to `p`, found downhill from piece `hint`; also its piece, as the next hint.
    pub(crate) fn nearest(&self, p: DVec3, hint: usize) -> (Station, usize) {
        let (_, s, k) = self.foot(p, hint);
        (self.station(k, s), k)
    }

    /// Returns how far `p` lies outside the line's surface, the arc length of the foot and its piece.
    pub(crate) fn outside(&self, p: DVec3, hint: usize) -> (f64, f64, usize) {
        let (square, s, k) = self.foot(p, hint);
        let h = self.s[k + 1] - self.s[k];
        let u = if h > 0.0 { (s - self.s[k]) / h } else { 0.0 };
        (square.sqrt() - base::ops::lerp(self.r[k], self.r[k + 1], u), s, k)
    }

    /// Returns the squared distance of the nearest point, its arc length and piece.
    fn foot(&self, p: DVec3, hint: usize) -> (f64, f64, usize) {
        let last = self.p.len() - 2;
        let foot = |k: usize| {
            let (a, b) = (self.p[k], self.p[k + 1]);
            let d = b - a;
            let u = ((p - a).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (a.lerp(b, u).distance_squared(p), u)
        };
        let mut k = hint.min(last);
        let (mut best, mut at) = foot(k);
        // Downhill in both directions; the first step decides. Pieces share their ends: a foot there may belong to the
        // next piece as well, so that the search continues at equal distances.
        let up = at >= 1.0 && k < last;
        while at <= 0.0 || at >= 1.0 {
            let next = if up { k + 1 } else { k.wrapping_sub(1) };
            if next > last {
                break;
            }
            let (d, u) = foot(next);
            if d > best {
                break;
            }
            (best, at, k) = (d, u, next);
        }
        (best, base::ops::lerp(self.s[k], self.s[k + 1], at), k)
    }
}

/// Returns the indices of the points to keep, and the length of the line through them.
fn clean(points: &[DVec3]) -> (Vec<usize>, f64) {
    let rough: f64 =
        points.windows(2).map(|w| w[0].distance(w[1])).filter(|d| d.is_finite()).fold(0.0, |sum, d| sum + d);
    let eps = rough * 1e-9;
    let mut keep: Vec<usize> = Vec::with_capacity(points.len());
    let mut total = 0.0;
    for (i, p) in points.iter().enumerate() {
        if !p.is_finite() || p.abs().max_element() > 1e12 {
            continue;
        }
        match keep.last() {
            None => keep.push(i),
            Some(&k) => {
                let d = points[k].distance(*p);
                if d > eps {
                    total += d;
                    keep.push(i);
                }
            }
        }
    }
    (keep, total)
}

/// Computes three-point parabola tangents, chord-length parameter, never longer than 1.
fn tangents(q: &[DVec3], first: Option<DVec3>) -> Vec<DVec3> {
    let n = q.len();
    let chord = |k: usize| (q[k + 1] - q[k]).normalize_or_zero();
    let mut t: Vec<DVec3> = (0..n)
        .map(|i| match i {
            0 => chord(0),
            _ if i == n - 1 => chord(n - 2),
            _ => {
                let (a, b) = (q[i].distance(q[i - 1]), q[i + 1].distance(q[i]));
                (chord(i - 1) * b + chord(i) * a) / (a + b)
            }
        })
        .collect();
    if n > 2 {
        // Ends of a parabola, not of a straight line: 3/2 chord - 1/2 inner tangent.
        t[0] = (chord(0) * 1.5 - t[1] * 0.5).normalize_or(chord(0));
        t[n - 1] = (chord(n - 2) * 1.5 - t[n - 2] * 0.5).normalize_or(chord(n - 2));
    }
    if let Some(d) = first {
        t[0] = d;
    }
    t
}

fn hermite(p: DVec3, m: DVec3, q: DVec3, n: DVec3, u: f64) -> DVec3 {
    let (u2, u3) = (u * u, u * u * u);
    p * (2.0 * u3 - 3.0 * u2 + 1.0) + m * (u3 - 2.0 * u2 + u) + q * (3.0 * u2 - 2.0 * u3) + n * (u3 - u2)
}

/// Smooths by two passes of (1 2 1)/4: a change of taper at a node should not show as a ridge.
fn smooth_radii(r: &mut [f64]) {
    for _ in 0..2 {
        let mut before = r[0];
        for i in 1..r.len() - 1 {
            let here = r[i];
            r[i] = 0.25 * (before + 2.0 * here + r[i + 1]);
            before = here;
        }
    }
}

/// Moves samples towards the middle of their neighbours wherever radius x curvature exceeds [`TIGHTEST`].
fn ease_sharp_bends(p: &mut [DVec3], r: &[f64]) {
    let n = p.len();
    // 48: a right angle of a line as thick as 20 samples is round after about 40 passes.
    for _ in 0..48 {
        let mut calm = true;
        let mut before = p[0];
        let mut a = p[1] - before;
        let mut length = a.length();
        for i in 1..n - 1 {
            let here = p[i];
            let b = p[i + 1] - here;
            let next = b.length();
            let most = TIGHTEST * 0.5 * (length + next);
            // |turn| / chord, by the small angle's chord: 2 sin(turn / 2). It is 2 at most: thin lines need no test.
            if 2.000_001 * r[i] > most
                && (b.normalize_or_zero() - a.normalize_or_zero()).length() * r[i] > most
            {
                calm = false;
                p[i] = here.lerp((before + p[i + 1]) * 0.5, 0.5);
            }
            (before, a, length) = (here, b, next);
        }
        if calm {
            break;
        }
    }
}
