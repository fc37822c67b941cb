//! Path data and basic shapes -> sub-paths of lines and cubics (SVG 1.1 sections 8 and 9).

use base::ops;
use glam::{DAffine2, DVec2};

use crate::drawing::number_end;

/// A piece of a sub-path, from the end of the piece before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Piece {
    Line(DVec2),
    Quad(DVec2, DVec2),
    Cubic(DVec2, DVec2, DVec2),
}

/// One movement of the pen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SubPath {
    pub(super) start: DVec2,
    pub(super) pieces: Vec<Piece>,
    pub(super) closed: bool,
}

impl SubPath {
    fn new(start: DVec2) -> Self {
        Self { start, pieces: Vec::new(), closed: false }
    }

    pub(super) fn transform(&mut self, m: DAffine2) {
        let t = |p: DVec2| m.transform_point2(p);
        self.start = t(self.start);
        for piece in &mut self.pieces {
            *piece = match *piece {
                Piece::Line(p) => Piece::Line(t(p)),
                Piece::Quad(c, p) => Piece::Quad(t(c), t(p)),
                Piece::Cubic(c, d, p) => Piece::Cubic(t(c), t(d), t(p)),
            };
        }
    }

    /// Returns every control point.
    pub(super) fn control_points(&self) -> impl Iterator<Item = DVec2> + '_ {
        let pieces = self.pieces.iter().flat_map(|piece| match *piece {
            Piece::Line(p) => [p, p, p],
            Piece::Quad(c, p) => [c, c, p],
            Piece::Cubic(c, d, p) => [c, d, p],
        });
        core::iter::once(self.start).chain(pieces)
    }

    /// Returns a polyline that stays within `tolerance` of the curve; at most 128 points a piece.
    pub(super) fn flatten(&self, tolerance: f64) -> Vec<DVec2> {
        let mut out = Vec::with_capacity(self.pieces.len() + 1);
        let mut at = self.start;
        out.push(at);
        for piece in &self.pieces {
            match *piece {
                Piece::Line(p) => {
                    out.push(p);
                    at = p;
                }
                Piece::Quad(c, p) => {
                    let n = steps((at - c * 2.0 + p).length() / 4.0, tolerance);
                    for i in 1..n {
                        let t = f64::from(i) / f64::from(n);
                        let s = 1.0 - t;
                        out.push(at * (s * s) + c * (2.0 * s * t) + p * (t * t));
                    }
                    out.push(p);
                    at = p;
                }
                Piece::Cubic(c, d, p) => {
                    let bend = (at - c * 2.0 + d).length().max((c - d * 2.0 + p).length());
                    // The second derivative is at most 6 * bend; the error of a chord is an eighth of it times the
                    // step squared.
                    let n = steps(bend * 0.75, tolerance);
                    for i in 1..n {
                        let t = f64::from(i) / f64::from(n);
                        let s = 1.0 - t;
                        let (b, e) = (3.0 * s * s * t, 3.0 * s * t * t);
                        out.push(at * (s * s * s) + c * b + d * e + p * (t * t * t));
                    }
                    out.push(p);
                    at = p;
                }
            }
        }
        if self.closed && at != self.start {
            out.push(self.start);
        }
        out
    }
}

/// Returns the number of steps that brings an error of `error` for one step below `tolerance`.
fn steps(error: f64, tolerance: f64) -> u32 {
    let n = (error / tolerance).sqrt().ceil();
    // NaN and infinity come from coordinates that cleaning will refuse.
    if !n.is_finite() {
        return 1;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 1..128")]
    let n = n.clamp(1.0, 128.0) as u32;
    n
}

struct Scanner<'t> {
    text: &'t str,
    at: usize,
}

impl Scanner<'_> {
    fn skip(&mut self) {
        let bytes = self.text.as_bytes();
        while bytes.get(self.at).is_some_and(|b| b.is_ascii_whitespace() || *b == b',') {
            self.at += 1;
        }
    }

    fn number(&mut self) -> Option<f64> {
        self.skip();
        let rest = &self.text[self.at..];
        let end = number_end(rest);
        let value = rest[..end].parse().ok()?;
        self.at += end;
        Some(value)
    }

    fn flag(&mut self) -> Option<bool> {
        self.skip();
        let flag = match self.text.as_bytes().get(self.at)? {
            b'0' => false,
            b'1' => true,
            _ => return None,
        };
        self.at += 1;
        Some(flag)
    }

    fn command(&mut self) -> Option<u8> {
        self.skip();
        let b = *self.text.as_bytes().get(self.at)?;
        if b.is_ascii_alphabetic() {
            self.at += 1;
            return Some(b);
        }
        None
    }

    fn done(&mut self) -> bool {
        self.skip();
        self.at >= self.text.len()
    }
}

struct Builder {
    paths: Vec<SubPath>,
    at: DVec2,
    start: DVec2,
    /// The last control point, and whether it belongs to a cubic.
    control: Option<(DVec2, bool)>,
    open: bool,
}

impl Builder {
    fn move_to(&mut self, p: DVec2) {
        self.paths.push(SubPath::new(p));
        (self.at, self.start, self.control, self.open) = (p, p, None, true);
    }

    fn push(&mut self, piece: Piece) {
        if !self.open {
            // After a close the next piece begins at the start of the closed path.
            self.paths.push(SubPath::new(self.start));
            self.open = true;
        }
        (self.at, self.control) = match piece {
            Piece::Line(p) => (p, None),
            Piece::Quad(c, p) => (p, Some((c, false))),
            Piece::Cubic(_, d, p) => (p, Some((d, true))),
        };
        if let Some(path) = self.paths.last_mut() {
            path.pieces.push(piece);
        }
    }

    fn close(&mut self) {
        if self.open
            && let Some(path) = self.paths.last_mut()
        {
            path.closed = true;
        }
        (self.at, self.control, self.open) = (self.start, None, false);
    }

    fn mirrored(&self, cubic: bool) -> DVec2 {
        match self.control {
            Some((c, kind)) if kind == cubic => self.at * 2.0 - c,
            _ => self.at,
        }
    }

    /// Reads the numbers of one command. `None` when they are missing or broken.
    fn apply(&mut self, command: u8, s: &mut Scanner<'_>) -> Option<()> {
        let origin = if command.is_ascii_lowercase() { self.at } else { DVec2::ZERO };
        let point = |s: &mut Scanner<'_>| Some(origin + DVec2::new(s.number()?, s.number()?));
        match command.to_ascii_uppercase() {
            b'L' => self.push(Piece::Line(point(s)?)),
            b'H' => self.push(Piece::Line(DVec2::new(origin.x + s.number()?, self.at.y))),
            b'V' => self.push(Piece::Line(DVec2::new(self.at.x, origin.y + s.number()?))),
            b'Q' => self.push(Piece::Quad(point(s)?, point(s)?)),
            b'T' => {
                let control = self.mirrored(false);
                self.push(Piece::Quad(control, point(s)?));
            }
            b'C' => self.push(Piece::Cubic(point(s)?, point(s)?, point(s)?)),
            b'S' => {
                let control = self.mirrored(true);
                self.push(Piece::Cubic(control, point(s)?, point(s)?));
            }
            b'A' => {
                let radii = DVec2::new(s.number()?, s.number()?);
                let (turn, large, sweep) = (s.number()?, s.flag()?, s.flag()?);
                let end = point(s)?;
                arc(self.at, radii, turn, [large, sweep], end).into_iter().for_each(|p| self.push(p));
                self.control = None;
            }
            _ => return None,
        }
        Some(())
    }
}

/// Reads path data. Returns the sub-paths and, if the data are broken, where; what comes before that is kept, as the
/// standard asks.
pub(super) fn parse(data: &str) -> (Vec<SubPath>, Option<usize>) {
    let mut s = Scanner { text: data, at: 0 };
    let mut b =
        Builder { paths: Vec::new(), at: DVec2::ZERO, start: DVec2::ZERO, control: None, open: false };
    let mut command = 0_u8;
    while !s.done() {
        let from = s.at;
        let repeated = match s.command() {
            Some(c) => {
                command = c;
                false
            }
            None => true,
        };
        let ok = match (command, repeated) {
            (b'M' | b'm', false) => {
                let origin = if command == b'm' { b.at } else { DVec2::ZERO };
                let point = s.number().and_then(|x| Some(DVec2::new(x, s.number()?)));
                // Further pairs are lines.
                command = if command == b'm' { b'l' } else { b'L' };
                point.map(|p| b.move_to(origin + p))
            }
            (b'Z' | b'z', false) => {
                b.close();
                Some(())
            }
            _ if b.paths.is_empty() => None,
            _ => b.apply(command, &mut s),
        };
        if ok.is_none() {
            return (b.paths, Some(from));
        }
    }
    (b.paths, None)
}

/// Returns an elliptical arc as cubics (SVG 1.1 appendix F.6). `turn` in degrees.
fn arc(from: DVec2, radii: DVec2, turn: f64, [large, sweep]: [bool; 2], to: DVec2) -> Vec<Piece> {
    let r = radii.abs();
    if from == to {
        return Vec::new();
    }
    if !(r.x > 0.0 && r.y > 0.0 && from.is_finite() && to.is_finite() && r.is_finite() && turn.is_finite()) {
        return vec![Piece::Line(to)];
    }
    let (sin, cos) = ops::sin_cos(turn % 360.0 * (ops::PI / 180.0));
    let axes = glam::DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos));
    // In the ellipse's own frame, scaled so that it is a unit circle.
    let half = (axes.transpose() * ((from - to) * 0.5)) / r;
    let lambda = half.length_squared();
    let grow = lambda.sqrt().max(1.0);
    let (r, half) = (r * grow, half / grow);
    let d = half.length_squared();
    if !(d.is_finite() && d > 0.0) {
        return vec![Piece::Line(to)];
    }
    let sign = if large == sweep { -1.0 } else { 1.0 };
    let centre = DVec2::new(half.y, -half.x) * (sign * ((1.0 - d).max(0.0) / d).sqrt());
    let (a, b) = (half - centre, -half - centre);
    let start = ops::atan2(a.y, a.x);
    let mut sweep_angle = ops::atan2(a.perp_dot(b), a.dot(b));
    if sweep && sweep_angle < 0.0 {
        sweep_angle += ops::TAU;
    } else if !sweep && sweep_angle > 0.0 {
        sweep_angle -= ops::TAU;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and 4")]
    let n = (sweep_angle.abs() / ops::FRAC_PI_2 - 1e-9).ceil().clamp(1.0, 4.0) as u32;
    let step = sweep_angle / f64::from(n);
    let kappa = 4.0 / 3.0 * ops::tan(step / 4.0);
    let middle = (from + to) * 0.5;
    let place = |p: DVec2| axes * ((p + centre) * r) + middle;
    (0..n)
        .map(|i| {
            let (s0, c0) = ops::sin_cos(start + step * f64::from(i));
            let (s1, c1) = ops::sin_cos(start + step * f64::from(i + 1));
            let c = place(DVec2::new(c0 - kappa * s0, s0 + kappa * c0));
            let d = place(DVec2::new(c1 + kappa * s1, s1 - kappa * c1));
            Piece::Cubic(c, d, if i + 1 == n { to } else { place(DVec2::new(c1, s1)) })
        })
        .collect()
}

/// Returns a closed ellipse.
pub(super) fn ellipse(centre: DVec2, r: DVec2) -> SubPath {
    let right = centre + DVec2::new(r.x, 0.0);
    let left = centre - DVec2::new(r.x, 0.0);
    let mut path = SubPath::new(right);
    path.pieces.extend(arc(right, r, 0.0, [false, true], left));
    path.pieces.extend(arc(left, r, 0.0, [false, true], right));
    path.closed = true;
    path
}

/// Returns a rectangle with corners rounded by `r` (zero: sharp).
pub(super) fn rect(at: DVec2, size: DVec2, r: DVec2) -> SubPath {
    let r = r.max(DVec2::ZERO).min(size * 0.5);
    let p = |x: f64, y: f64| at + DVec2::new(x, y);
    let (w, h) = (size.x, size.y);
    if !(r.x > 0.0 && r.y > 0.0) {
        let pieces = [p(w, 0.0), p(w, h), p(0.0, h), at].map(Piece::Line).to_vec();
        return SubPath { start: at, pieces, closed: true };
    }
    let mut path = SubPath::new(p(r.x, 0.0));
    let sides = [
        (p(w - r.x, 0.0), p(w, r.y)),
        (p(w, h - r.y), p(w - r.x, h)),
        (p(r.x, h), p(0.0, h - r.y)),
        (p(0.0, r.y), p(r.x, 0.0)),
    ];
    for (corner, after) in sides {
        path.pieces.push(Piece::Line(corner));
        path.pieces.extend(arc(corner, r, 0.0, [false, true], after));
    }
    path.closed = true;
    path
}

/// Returns a line through points, closed for a polygon.
pub(super) fn poly(points: &str, closed: bool) -> (Option<SubPath>, Option<usize>) {
    let mut s = Scanner { text: points, at: 0 };
    let mut path: Option<SubPath> = None;
    while !s.done() {
        let from = s.at;
        let Some(p) = s.number().and_then(|x| Some(DVec2::new(x, s.number()?))) else {
            return (path, Some(from));
        };
        match &mut path {
            None => path = Some(SubPath { closed, ..SubPath::new(p) }),
            Some(path) => path.pieces.push(Piece::Line(p)),
        }
    }
    (path, None)
}

/// Converts a number with a unit of CSS into degrees or pixels, percents by `whole`; plain numbers stay.
fn unit(name: &str, value: f64, whole: f64) -> Option<f64> {
    Some(match name {
        "" | "px" | "deg" => value,
        "rad" => value * (180.0 / ops::PI),
        "grad" => value * 0.9,
        "turn" => value * 360.0,
        "%" => value * whole / 100.0,
        "pt" => value * 96.0 / 72.0,
        "mm" => value * 96.0 / 25.4,
        "cm" => value * 96.0 / 2.54,
        "in" => value * 96.0,
        "em" | "rem" => value * 16.0,
        _ => return None,
    })
}

/// Parses numbers with the units of CSS; percents refer to the sheet's width and height in turn.
pub(super) fn css_numbers(text: &str, sheet: DVec2) -> Option<Vec<f64>> {
    let mut s = Scanner { text, at: 0 };
    let mut v = Vec::new();
    while !s.done() && v.len() < 7 {
        let value = s.number()?;
        let rest = &s.text[s.at..];
        let end = rest.find(|c: char| !(c.is_ascii_alphabetic() || c == '%')).unwrap_or(rest.len());
        s.at += end;
        v.push(unit(&rest[..end], value, if v.len() % 2 == 0 { sheet.x } else { sheet.y })?);
    }
    Some(v)
}

/// Parses `transform="..."`, or the same as CSS: translate, scale, rotate, skew, matrix, also along one axis. `None`
/// if it is broken.
pub(super) fn transform(text: &str, sheet: DVec2) -> Option<DAffine2> {
    if text.trim() == "none" {
        return Some(DAffine2::IDENTITY);
    }
    let mut all = DAffine2::IDENTITY;
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (name, after) = rest.split_once('(')?;
        let (inside, after) = after.split_once(')')?;
        rest = after.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
        // Percents in a scale are shares of 1, not of the sheet.
        let whole = if name.trim().starts_with("scale") { DVec2::ONE } else { sheet };
        let v = css_numbers(inside, whole)?;
        let radians = |deg: f64| deg % 360.0 * (ops::PI / 180.0);
        let matrix = |m: [f64; 6]| DAffine2::from_cols_array(&m);
        all *= match (name.trim(), v.as_slice()) {
            ("matrix", &[a, b, c, d, e, f]) => matrix([a, b, c, d, e, f]),
            ("translate", &[x]) => DAffine2::from_translation(DVec2::new(x, 0.0)),
            ("translate", &[x, y]) => DAffine2::from_translation(DVec2::new(x, y)),
            ("translateX", &[x]) => DAffine2::from_translation(DVec2::new(x, 0.0)),
            ("translateY", &[y]) => DAffine2::from_translation(DVec2::new(0.0, y)),
            ("scaleX", &[x]) => DAffine2::from_scale(DVec2::new(x, 1.0)),
            ("scaleY", &[y]) => DAffine2::from_scale(DVec2::new(1.0, y)),
            ("skew", &[a]) => matrix([1.0, 0.0, ops::tan(radians(a)), 1.0, 0.0, 0.0]),
            ("skew", &[a, b]) => matrix([1.0, ops::tan(radians(b)), ops::tan(radians(a)), 1.0, 0.0, 0.0]),
            ("scale", &[s]) => DAffine2::from_scale(DVec2::splat(s)),
            ("scale", &[x, y]) => DAffine2::from_scale(DVec2::new(x, y)),
            ("rotate", &[a] | &[a, _, _]) => {
                let centre = if let &[_, x, y] = v.as_slice() { DVec2::new(x, y) } else { DVec2::ZERO };
                let (sin, cos) = ops::sin_cos(radians(a));
                DAffine2::from_translation(centre)
                    * matrix([cos, sin, -sin, cos, 0.0, 0.0])
                    * DAffine2::from_translation(-centre)
            }
            ("skewX", &[a]) => matrix([1.0, 0.0, ops::tan(radians(a)), 1.0, 0.0, 0.0]),
            ("skewY", &[a]) => matrix([1.0, ops::tan(radians(a)), 0.0, 1.0, 0.0, 0.0]),
            _ => return None,
        };
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(data: &str) -> Vec<Vec<[f64; 2]>> {
        let (paths, fault) = parse(data);
        assert_eq!(fault, None, "{data}");
        paths.iter().map(|p| p.flatten(1e9).iter().map(|p| p.to_array()).collect()).collect()
    }

    #[test]
    fn every_command_ends_where_it_says() {
        assert_eq!(
            ends("M1 2 3 4l1 1H9v-2h1V0z"),
            [vec![
                [1.0, 2.0],
                [3.0, 4.0],
                [4.0, 5.0],
                [9.0, 5.0],
                [9.0, 3.0],
                [10.0, 3.0],
                [10.0, 0.0],
                [1.0, 2.0]
            ]]
        );
        assert_eq!(
            ends("m1,1c0 0 1 0 1 1s1 1 1 0q1 1 2 0t2 0a1 1 0 0 1 2 0"),
            [vec![[1.0, 1.0], [2.0, 2.0], [3.0, 2.0], [5.0, 2.0], [7.0, 2.0], [8.0, 1.0], [9.0, 2.0]]]
        );
        assert_eq!(ends("M0 0L1 0zl0 1M5 5L6 6").len(), 3, "a piece after z starts a path");
        assert_eq!(ends("M.5.5-1-1e0")[0], [[0.5, 0.5], [-1.0, -1.0]]);
    }

    #[test]
    fn arcs_lie_on_their_circle() {
        for flags in ["0 0", "0 1", "1 0", "1 1", "01", "10"] {
            let sep = if flags.len() == 2 { "" } else { " " };
            let (paths, fault) = parse(&format!("M3 0A5 5 30 {flags}{sep}0 4"));
            assert_eq!(fault, None, "{flags}");
            let points = paths[0].flatten(1e-4);
            assert_eq!(points.last(), Some(&DVec2::new(0.0, 4.0)), "ends exactly");
            // The two circles of radius 5 through both ends.
            let middle = DVec2::new(1.5, 2.0);
            let offset = DVec2::new(4.0, 3.0).normalize() * (25.0_f64 - 6.25).sqrt();
            let on = |c: DVec2| points.iter().all(|p| ((*p - c).length() - 5.0).abs() < 2e-3);
            assert!(on(middle + offset) || on(middle - offset), "{flags}: {points:?}");
            let length: f64 = points.windows(2).map(|w| (w[1] - w[0]).length()).sum();
            let large = flags.starts_with('1');
            assert!((length > 5.0 * ops::PI) == large, "{flags}: {length}");
        }
    }

    #[test]
    fn an_arc_of_a_huge_radius_is_a_line_and_does_not_hang() {
        for data in ["M0 0A1e300 1e300 0 0 0 1 1", "M0 0A1 1 0 0 0 1e300 1e300", "M0 0A1e999 1 0 0 1 5 5"] {
            let (paths, _) = parse(data);
            assert!(paths[0].flatten(1e-9).len() < 1000, "{data}");
        }
    }

    #[test]
    fn broken_data_keeps_what_was_before() {
        let (paths, fault) = parse("M0 0L1 1L2 X");
        assert_eq!((paths[0].pieces.len(), fault), (1, Some(8)));
        assert_eq!(parse("hello").1, Some(0));
        assert_eq!(parse("L1 1").1, Some(0));
        assert_eq!(parse(""), (vec![], None));
    }

    #[test]
    fn transforms_compose_from_left_to_right() {
        let m = transform("translate(10) rotate(90 1 1), scale(2)", DVec2::ZERO).expect("reads");
        assert!((m.transform_point2(DVec2::new(1.0, 0.0)) - DVec2::new(12.0, 2.0)).length() < 1e-12);
        let m = transform("matrix(1 0 0 -1 5 6)", DVec2::ZERO).expect("reads");
        assert_eq!(m.transform_point2(DVec2::new(1.0, 2.0)), DVec2::new(6.0, 4.0));
        assert!(transform("rotate(90", DVec2::ZERO).is_none());
        assert!(transform("spin(3)", DVec2::ZERO).is_none());
        let m =
            transform("translate(50%, 10px) rotate(0.25turn) scaleX(2)", DVec2::splat(40.0)).expect("CSS");
        assert!((m.transform_point2(DVec2::X) - DVec2::new(20.0, 12.0)).length() < 1e-12);
    }

    #[test]
    fn flattening_keeps_the_tolerance() {
        let circle = ellipse(DVec2::ZERO, DVec2::splat(100.0));
        let points = circle.flatten(0.05);
        let worst = points.windows(2).map(|w| ((w[0] + w[1]) * 0.5).length()).fold(f64::MAX, f64::min);
        assert!(worst > 100.0 - 0.08, "{worst}");
        assert!(points.len() < 200, "{}", points.len());
    }
}
