//! Turns a flat outline into a bent sheet: `(x, y) of the outline -> lift -> bend -> hollow, fold, waves -> (x, y, z)`.

use base::ops;
use glam::{DVec2, DVec3};

use crate::{Blade, Lift};

/// Rows of the width and length tables: blades are smooth, 32 intervals keep the error below 1e-3 of the length.
const ROWS: usize = 33;
/// Pieces of the midrib for distances: enough for a drawn vein, few enough for each mesh point.
const RIB_PIECES: usize = 8;
/// Number of waves of the margin from root to tip.
const WAVES: f64 = 3.5;

#[derive(Clone, Copy, Debug)]
struct Row {
    left: f64,
    right: f64,
    rib: f64,
}

/// A [`Blade`] with the tables that its evaluation needs.
///
/// ```
/// use glam::DVec2;
/// use plant::{Blade, Lift, Relief};
/// let outline = vec![DVec2::ZERO, DVec2::new(0.3, 0.5), DVec2::Y, DVec2::new(-0.3, 0.5)];
/// let blade = Blade {
///     midrib: vec![DVec2::ZERO, DVec2::Y],
///     veins: vec![],
///     needles: None,
///     lift: Lift::Flat,
///     relief: Relief { hollow: 0.2, ..Relief::default() },
///     outline,
/// };
/// let s = blade.surface();
/// assert!((s.point(DVec2::new(0.0, 0.5)).z + 0.2).abs() < 1e-9); // deepest at the middle
/// assert!(s.points(&blade.outline).iter().all(|p| p.z.abs() < 1e-6)); // the margin stays
/// ```
#[derive(Clone, Debug)]
pub struct BladeSurface<'a> {
    blade: &'a Blade,
    length: f64,
    along: DVec2,
    across: DVec2,
    low: f64,
    span: f64,
    rows: [Row; ROWS],
    rib: [DVec2; RIB_PIECES + 1],
    /// With `keep_length`: position along the blade and sag of the bent midrib at each row of `0..=top`.
    bent: Option<Vec<DVec2>>,
    top: f64,
}

impl Blade {
    /// Prepares the blade for evaluation at many points: tables of its width and lengths are made once.
    ///
    /// Cost: linear in the points of the outline and midrib.
    pub fn surface(&self) -> BladeSurface<'_> {
        BladeSurface::new(self)
    }

    /// Maps one point of the plane into space (local coordinates, scale 1); use [`surface`](Self::surface) for many.
    ///
    /// Guaranteed: with `keep_length` off, x and y stay as they are, so the view along z is the drawing.
    /// He and Cheng (2021), Eq 5 and section 6.2.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use plant::{Blade, Lift, Relief};
    /// let blade = Blade {
    ///     outline: vec![DVec2::ZERO, DVec2::new(0.3, 0.5), DVec2::Y, DVec2::new(-0.3, 0.5)],
    ///     midrib: vec![DVec2::ZERO, DVec2::Y],
    ///     veins: vec![],
    ///     needles: None,
    ///     lift: Lift::Flat,
    ///     relief: Relief { bend_a: 0.1, bend_b: 0.2, ..Relief::default() },
    /// };
    /// assert!(blade.point(DVec2::Y).distance(DVec3::new(0.0, 1.0, -0.3)) < 1e-12);
    /// ```
    pub fn point(&self, p: DVec2) -> DVec3 {
        self.surface().point(p)
    }
}

impl<'a> BladeSurface<'a> {
    pub(crate) fn new(blade: &'a Blade) -> Self {
        let tip = blade.midrib.last().copied().unwrap_or(DVec2::Y);
        let along = tip.try_normalize().unwrap_or(DVec2::Y);
        let across = DVec2::new(along.y, -along.x);
        let length = tip.length();
        let (mut low, mut high) = (0.0_f64, length);
        for &p in &blade.outline {
            low = low.min(p.dot(along));
            high = high.max(p.dot(along));
        }
        let span = (high - low).max(f64::MIN_POSITIVE);
        let mut surface = Self {
            blade,
            length,
            along,
            across,
            low,
            span,
            rows: [Row { left: f64::INFINITY, right: f64::NEG_INFINITY, rib: f64::NAN }; ROWS],
            rib: [DVec2::ZERO; RIB_PIECES + 1],
            bent: None,
            top: high,
        };
        surface.measure_width();
        surface.shorten_rib();
        if blade.relief.keep_length {
            surface.bent = Some(surface.bend_midrib());
        }
        surface
    }

    /// Maps a point of the blade's plane into space, local coordinates at scale 1.
    ///
    /// Guaranteed: finite for finite blades and points; x and y unchanged unless `keep_length` is set.
    /// He and Cheng (2021), Eq 5 (along minus the normal, x measured along the unit axis) and section 6.2.
    pub fn point(&self, p: DVec2) -> DVec3 {
        let relief = self.blade.relief;
        let (u, v) = (p.dot(self.across), p.dot(self.along));
        let (sag, plane) = match &self.bent {
            None => (self.sag(v), p),
            Some(bent) => {
                let (v_bent, sag) = self.bent_at(bent, v);
                // The halves of a folded blade come nearer to the midrib.
                let rib = self.row(v).rib;
                let narrow = 1.0 / (1.0 + relief.fold * relief.fold).sqrt();
                (sag, self.across * (rib + (u - rib) * narrow) + self.along * v_bent)
            }
        };
        let mut z = lifted(self.blade.lift, plane) - sag;
        if relief.hollow != 0.0 || relief.wave != 0.0 {
            let row = self.row(v);
            let side = if u < row.rib { row.left - row.rib } else { row.right - row.rib };
            let t = if side.abs() > 1e-12 * self.span { ((u - row.rib) / side).clamp(0.0, 1.0) } else { 0.0 };
            let xi = self.share(v);
            let arch = 4.0 * xi * (1.0 - xi);
            z -= relief.hollow * self.length * (1.0 - t * t) * arch;
            if relief.wave != 0.0 {
                // The two margins wave out of phase, as real ones do.
                let phase = if u < row.rib { 0.0 } else { 1.3 };
                let wave = ops::sin(ops::TAU * WAVES * xi + phase);
                z += relief.wave * self.length * t * t * arch.sqrt() * wave;
            }
        }
        if relief.fold != 0.0 {
            z += relief.fold * self.distance_to_rib(p);
        }
        plane.extend(z)
    }

    /// As [`point`](Self::point), for many points.
    pub fn points(&self, plane: &[DVec2]) -> Vec<DVec3> {
        plane.iter().map(|&p| self.point(p)).collect()
    }

    /// Returns the position along the blade as a share of its length, 0 to 1.
    fn share(&self, v: f64) -> f64 {
        if self.length > 0.0 { (v / self.length).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Evaluates Eq 5: the displacement against the normal of the point at `v` along the blade. Flat behind the root,
    /// straight beyond the tip.
    fn sag(&self, v: f64) -> f64 {
        let (a, b) = (self.blade.relief.bend_a, self.blade.relief.bend_b);
        if self.length <= 0.0 || v <= 0.0 {
            return 0.0;
        }
        let xi = v / self.length;
        if xi <= 1.0 {
            self.length * (a * xi * xi * xi * xi + b * xi * xi)
        } else {
            self.length * (a + b + (4.0 * a + 2.0 * b) * (xi - 1.0))
        }
    }

    fn slope(&self, v: f64) -> f64 {
        let (a, b) = (self.blade.relief.bend_a, self.blade.relief.bend_b);
        if self.length <= 0.0 || v <= 0.0 {
            return 0.0;
        }
        let xi = (v / self.length).min(1.0);
        4.0 * a * xi * xi * xi + 2.0 * b * xi
    }

    #[expect(clippy::cast_precision_loss, reason = "rows are few")]
    fn row_at(&self, i: usize) -> f64 {
        self.low + self.span * (i as f64 / (ROWS - 1) as f64)
    }

    fn row(&self, v: f64) -> Row {
        let (i, t) = cell((v - self.low) / self.span);
        let (a, b) = (self.rows[i], self.rows[i + 1]);
        Row {
            left: ops::lerp(a.left, b.left, t),
            right: ops::lerp(a.right, b.right, t),
            rib: ops::lerp(a.rib, b.rib, t),
        }
    }

    /// Measures the greatest extent of the outline on both sides of the midrib, row by row.
    fn measure_width(&mut self) {
        let uv = |p: DVec2| DVec2::new(p.dot(self.across), p.dot(self.along));
        let (low, span) = (self.low, self.span);
        let mut rows = self.rows;
        let mut scan = |a: DVec2, b: DVec2, set: &mut dyn FnMut(&mut Row, f64)| {
            let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
            #[expect(clippy::cast_precision_loss, reason = "rows are few")]
            let step = span / (ROWS - 1) as f64;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped to the table"
            )]
            let first = ((a.y - low) / step).ceil().clamp(0.0, 1e3) as usize;
            for (i, row) in rows.iter_mut().enumerate().skip(first) {
                #[expect(clippy::cast_precision_loss, reason = "rows are few")]
                let v = low + span * (i as f64 / (ROWS - 1) as f64);
                if v > b.y {
                    break;
                }
                let t = if b.y > a.y { ((v - a.y) / (b.y - a.y)).clamp(0.0, 1.0) } else { 0.0 };
                set(row, ops::lerp(a.x, b.x, t));
            }
        };
        let outline = &self.blade.outline;
        for (i, &p) in outline.iter().enumerate() {
            let q = outline[(i + 1) % outline.len()];
            scan(uv(p), uv(q), &mut |row, u| {
                row.left = row.left.min(u);
                row.right = row.right.max(u);
            });
        }
        for pair in self.blade.midrib.windows(2) {
            scan(uv(pair[0]), uv(pair[1]), &mut |row, u| {
                if row.rib.is_nan() {
                    row.rib = u;
                }
            });
        }
        fill_gaps(&mut rows);
        self.rows = rows;
    }

    /// Resamples the midrib to few pieces of equal length.
    fn shorten_rib(&mut self) {
        let rib = &self.blade.midrib;
        let total: f64 = rib.windows(2).map(|p| p[0].distance(p[1])).sum();
        let (mut i, mut passed) = (0, 0.0);
        for (k, out) in self.rib.iter_mut().enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "pieces are few")]
            let want = total * k as f64 / RIB_PIECES as f64;
            while i + 2 < rib.len() && passed + rib[i].distance(rib[i + 1]) < want {
                passed += rib[i].distance(rib[i + 1]);
                i += 1;
            }
            if let (Some(&a), Some(&b)) = (rib.get(i), rib.get(i + 1)) {
                let d = a.distance(b);
                let t = if d > 0.0 { ((want - passed) / d).clamp(0.0, 1.0) } else { 0.0 };
                *out = a.lerp(b, t);
            }
        }
    }

    fn distance_to_rib(&self, p: DVec2) -> f64 {
        let squared = self.rib.windows(2).fold(f64::INFINITY, |best, s| {
            let d = s[1] - s[0];
            let n = d.length_squared();
            let t = if n > 0.0 { ((p - s[0]).dot(d) / n).clamp(0.0, 1.0) } else { 0.0 };
            best.min(p.distance_squared(s[0] + d * t))
        });
        squared.sqrt()
    }

    /// Returns the bent midrib with the length of the unbent one: the position of each row, and its sag.
    ///
    /// For a flat blade `v' = integral of sqrt(1 - sag'^2)`; for a lifted one the same with the lift's own slope in
    /// both lengths.
    fn bend_midrib(&self) -> Vec<DVec2> {
        const FINE: usize = 4;
        #[expect(clippy::cast_precision_loss, reason = "rows are few")]
        let step = self.top / ((ROWS - 1) * FINE) as f64;
        let lift_slope = |v: f64| {
            let h = 1e-4 * self.span;
            let at = |v: f64| lifted(self.blade.lift, self.along * v);
            ((at(v + h) - at(v - h)) / (2.0 * h)).clamp(-10.0, 10.0)
        };
        let mut out = Vec::with_capacity(ROWS);
        let (mut place, mut sag, mut v) = (0.0, 0.0, 0.0);
        for i in 0..(ROWS - 1) * FINE {
            if i % FINE == 0 {
                out.push(DVec2::new(place, sag));
            }
            let (m, rest) = (lift_slope(place + 0.5 * step), lift_slope(v + 0.5 * step));
            let length2 = 1.0 + rest * rest;
            // A blade cannot sag by more than its own length.
            let fall = self.slope(v + 0.5 * step).clamp(-length2.sqrt(), length2.sqrt());
            let root = m * m * fall * fall - (1.0 + m * m) * (fall * fall - length2);
            place += step * (m * fall + root.max(0.0).sqrt()) / (1.0 + m * m);
            sag += step * fall;
            v += step;
        }
        out.push(DVec2::new(place, sag));
        out
    }

    fn bent_at(&self, bent: &[DVec2], v: f64) -> (f64, f64) {
        if v <= 0.0 || self.top <= 0.0 || bent.len() < ROWS {
            return (v, 0.0);
        }
        let (i, t) = cell(v / self.top);
        let p = bent[i].lerp(bent[i + 1], t);
        (p.x, p.y)
    }

    /// Returns the outline's half widths to the left and right of the midrib at a place along the blade, metres.
    ///
    /// `v` is measured from the root along the blade; outside the blade the nearest row counts.
    pub fn half_widths(&self, v: f64) -> (f64, f64) {
        let row = self.row(v);
        (row.rib - row.left, row.right - row.rib)
    }

    /// Returns the distance along the blade of the lowest and the highest point of the outline, metres.
    pub fn extent(&self) -> (f64, f64) {
        (self.low, self.row_at(ROWS - 1))
    }
}

/// Returns row and fraction of a share of the table.
fn cell(share: f64) -> (usize, f64) {
    #[expect(clippy::cast_precision_loss, reason = "rows are few")]
    let x = share.clamp(0.0, 1.0) * (ROWS - 1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the table")]
    let i = (x as usize).min(ROWS - 2);
    #[expect(clippy::cast_precision_loss, reason = "rows are few")]
    let t = x - i as f64;
    (i, t)
}

fn lifted(lift: Lift, p: DVec2) -> f64 {
    match lift {
        Lift::Flat => 0.0,
        Lift::Tilt { slope } => slope.dot(p),
        Lift::Cone { cone, sheet } => cone.depth(p, sheet),
    }
}

/// Fills rows that no edge crosses with the values of their nearest neighbour.
fn fill_gaps(rows: &mut [Row; ROWS]) {
    let mut last = 0.0;
    let known = |r: &Row| r.rib.is_finite();
    let first = rows.iter().find(|r| known(r)).map_or(0.0, |r| r.rib);
    let mut seen = false;
    for row in rows.iter_mut() {
        if known(row) {
            last = row.rib;
            seen = true;
        } else {
            row.rib = if seen { last } else { first };
        }
        if row.left > row.right {
            (row.left, row.right) = (row.rib, row.rib);
        }
        row.left = row.left.min(row.rib);
        row.right = row.right.max(row.rib);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Relief;

    /// Makes a blade of length 2 and half width 0.5 * sin-like profile.
    fn blade(relief: Relief, lift: Lift) -> Blade {
        let side = |s: f64| {
            (0..=20).map(move |i| {
                let t = f64::from(i) / 20.0;
                DVec2::new(s * 4.0 * t * (1.0 - t) * 0.5, 2.0 * t)
            })
        };
        let mut outline: Vec<DVec2> = side(1.0).collect();
        outline.extend(side(-1.0).rev().skip(1).take(19));
        Blade {
            outline,
            midrib: vec![DVec2::ZERO, DVec2::new(0.0, 2.0)],
            veins: vec![],
            needles: None,
            lift,
            relief,
        }
    }

    #[test]
    fn eq5_moves_the_tip_by_a_plus_b_against_the_normal() {
        let b = blade(Relief { bend_a: 0.1, bend_b: 0.25, ..Relief::default() }, Lift::Flat);
        let s = b.surface();
        assert!((s.point(DVec2::new(0.0, 2.0)).z + 2.0 * 0.35).abs() < 1e-12);
        // Half way: A/16 + B/4.
        assert!((s.point(DVec2::new(0.3, 1.0)).z + 2.0 * (0.1 / 16.0 + 0.25 / 4.0)).abs() < 1e-12);
        assert_eq!(s.point(DVec2::new(0.1, -0.3)).z, 0.0, "behind the root nothing bends");
    }

    #[test]
    fn projection_is_kept_to_the_bit_without_keep_length() {
        let relief =
            Relief { bend_a: -0.1, bend_b: 0.3, hollow: 0.15, fold: 0.4, wave: 0.05, keep_length: false };
        let b = blade(relief, Lift::Tilt { slope: DVec2::new(0.2, -0.6) });
        for p in &b.outline {
            let q = b.point(*p);
            assert_eq!((q.x, q.y), (p.x, p.y));
        }
    }

    #[test]
    fn keep_length_keeps_the_midrib_and_the_plain_form_stretches_it() {
        let length = |relief: Relief, lift: Lift| {
            let b = blade(relief, lift);
            let s = b.surface();
            let rib: Vec<DVec3> =
                (0..=200).map(|i| s.point(DVec2::new(0.0, 2.0 * f64::from(i) / 200.0))).collect();
            rib.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>()
        };
        let relief = Relief { bend_a: 0.05, bend_b: 0.3, keep_length: true, ..Relief::default() };
        assert!((length(relief, Lift::Flat) / 2.0 - 1.0).abs() < 1e-3);
        let tilt = DVec2::new(0.1, 0.5);
        let want = 2.0 * (1.0 + 0.25_f64).sqrt();
        assert!((length(relief, Lift::Tilt { slope: tilt }) / want - 1.0).abs() < 1e-3);
        // Plain: 2/3 (B/L)^2 too long for A = 0.
        let plain = Relief { bend_b: 0.1, ..Relief::default() };
        assert!((length(plain, Lift::Flat) / 2.0 - 1.0 - 2.0 / 3.0 * 0.01).abs() < 3e-4);
    }

    #[test]
    fn hollow_has_the_two_stated_maxima_and_leaves_the_margin() {
        let b = blade(Relief { hollow: 0.1, ..Relief::default() }, Lift::Flat);
        let s = b.surface();
        let depth = |x: f64, y: f64| -s.point(DVec2::new(x, y)).z;
        assert!((depth(0.0, 1.0) - 0.2).abs() < 1e-9);
        assert!(depth(0.0, 1.0) > depth(0.1, 1.0) && depth(0.1, 1.0) > depth(0.2, 1.0));
        assert!(depth(0.0, 1.0) > depth(0.0, 0.7) && depth(0.0, 1.0) > depth(0.0, 1.3));
        assert!(b.outline.iter().all(|&p| s.point(p).z.abs() < 5e-3));
    }

    #[test]
    fn fold_follows_the_drawn_vein() {
        let mut b = blade(Relief { fold: 0.5, ..Relief::default() }, Lift::Flat);
        b.midrib = vec![DVec2::ZERO, DVec2::new(0.2, 1.0), DVec2::new(0.0, 2.0)];
        let s = b.surface();
        assert!(s.point(DVec2::new(0.2, 1.0)).z.abs() < 1e-9, "no height on the vein");
        assert!(s.point(DVec2::new(0.0, 1.0)).z > 0.05 && s.point(DVec2::new(0.4, 1.0)).z > 0.05);
    }

    #[test]
    fn blades_without_area_or_length_stay_finite() {
        for outline in
            [vec![DVec2::ZERO; 3], vec![DVec2::X, DVec2::Y, DVec2::X], vec![DVec2::splat(1e150); 4]]
        {
            for keep_length in [false, true] {
                let relief =
                    Relief { bend_a: 0.2, bend_b: 0.5, hollow: 0.2, fold: 1.0, wave: 0.1, keep_length };
                let midrib = vec![outline[0], outline[1]];
                let b = Blade {
                    outline: outline.clone(),
                    midrib,
                    veins: vec![],
                    needles: None,
                    lift: Lift::Flat,
                    relief,
                };
                assert!(b.surface().points(&b.outline).iter().all(|p| p.is_finite()), "{outline:?}");
            }
        }
    }

    #[test]
    fn half_widths_are_those_of_the_outline() {
        let b = blade(Relief::default(), Lift::Flat);
        let (l, r) = b.surface().half_widths(1.0);
        assert!((l - 0.5).abs() < 1e-9 && (r - 0.5).abs() < 1e-9);
        assert!((b.surface().extent().1 - 2.0).abs() < 1e-12);
    }
}
