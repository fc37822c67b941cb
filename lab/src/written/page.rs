//! A drawing on a sheet, and the elements for writing it: path data, outlines of pens, hatches.

use std::fmt::Write as _;

use base::{Stream, ops};
use formats::DrawingFormat;
use glam::DVec2;
use ink::Drawing;

/// Diagonal of the drawing on its sheet.
const DIAGONAL: f64 = 800.0;
/// Margin around the drawing.
const MARGIN: f64 = 60.0;
/// Width of the pen.
pub(super) const PEN: f64 = 4.0;
/// The ends of an outline lie within this share of its length.
const GAP: f64 = 0.05;
/// An outline encloses at least this share of its length squared.
const ROUND: f64 = 0.018;

/// A line of the drawing, y down.
pub(super) struct Line {
    pub(super) points: Vec<DVec2>,
    /// Whether it encloses an area, so that its last point is its first one.
    pub(super) closed: bool,
    pub(super) color: String,
}

impl Line {
    pub(super) fn length(&self) -> f64 {
        geom::polyline_length(&self.points)
    }
}

/// The sheet with its lines.
pub(super) struct Page {
    pub(super) lines: Vec<Line>,
    pub(super) size: DVec2,
}

/// Output of a program.
pub(super) struct Written {
    pub(super) bytes: Vec<u8>,
    pub(super) format: DrawingFormat,
}

impl From<String> for Written {
    fn from(svg: String) -> Self {
        Self { bytes: svg.into_bytes(), format: DrawingFormat::Svg }
    }
}

impl Page {
    /// Puts a drawing on a sheet; `None` where it has no size.
    pub(super) fn new(drawing: &Drawing) -> Option<Self> {
        let lines: Vec<(Vec<DVec2>, Option<[u8; 3]>)> = (drawing.strokes.iter())
            .filter(|s| !s.hidden)
            .map(|s| (s.samples.iter().map(|p| p.at).filter(|p| p.is_finite()).collect(), s.color))
            .filter(|(line, _): &(Vec<DVec2>, _)| geom::polyline_length(line) > 0.0)
            .collect();
        let all: Vec<DVec2> = lines.iter().flat_map(|l| &l.0).copied().collect();
        let (lo, hi) = geom::bounds(&all)?;
        let scale = DIAGONAL / (hi - lo).length();
        let place = |p: DVec2| DVec2::new(p.x - lo.x, hi.y - p.y) * scale + MARGIN;
        let lines = lines.into_iter().map(|(points, color)| {
            let mut points: Vec<DVec2> = points.into_iter().map(place).collect();
            let length = geom::polyline_length(&points);
            let gap = points[0].distance(points[points.len() - 1]);
            let closed = gap <= GAP * length && geom::signed_area(&points).abs() >= ROUND * length * length;
            if closed && gap > 0.0 {
                points.push(points[0]);
            }
            let [r, g, b] = color.unwrap_or([34, 34, 34]);
            Line { points, closed, color: format!("#{r:02x}{g:02x}{b:02x}") }
        });
        scale.is_finite().then(|| Self { lines: lines.collect(), size: (hi - lo) * scale + 2.0 * MARGIN })
    }

    pub(super) fn outlines(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter().filter(|l| l.closed)
    }

    /// Returns a document with this content.
    pub(super) fn svg(&self, body: &str) -> Written {
        let DVec2 { x, y } = self.size;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {x:.2} {y:.2}\" width=\"{x:.2}\" height=\"{y:.2}\">\n{body}</svg>\n"
        )
        .into()
    }

    /// Returns all lines, each as a path.
    pub(super) fn paths(&self) -> String {
        self.each(|line| stroked(&path_data(&line.points), &line.color))
    }

    /// Joins the output of `write` for each line.
    pub(super) fn each(&self, write: impl FnMut(&Line) -> String) -> String {
        self.lines.iter().map(write).collect()
    }

    /// Returns a rectangle this far within the sheet, with corners of this radius, as path data.
    pub(super) fn frame(&self, inset: f64, radius: f64) -> String {
        path_data(&rounded(DVec2::splat(inset), self.size - inset, radius))
    }
}

pub(super) fn stroked(data: &str, color: &str) -> String {
    format!("<path d=\"{data}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{PEN}\"/>\n")
}

pub(super) fn filled(data: &str, color: &str) -> String {
    format!("<path d=\"{data}\" fill=\"{color}\"/>\n")
}

/// Returns `M` and lines; `Z` where the last point is the first one.
pub(super) fn path_data(points: &[DVec2]) -> String {
    let mut out = String::new();
    let closed = points.len() > 3 && points.first() == points.last();
    let drawn = if closed { &points[..points.len() - 1] } else { points };
    for (k, p) in drawn.iter().enumerate() {
        let _ = write!(out, "{}{:.2} {:.2}", if k == 0 { "M" } else { "L" }, p.x, p.y);
    }
    if closed {
        out.push('Z');
    }
    out
}

/// Returns a rectangle with round corners, closed.
fn rounded(lo: DVec2, hi: DVec2, radius: f64) -> Vec<DVec2> {
    let corners = [DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y), lo];
    let mut out = Vec::new();
    for (k, corner) in (0_u8..).zip(corners) {
        let inwards = (lo.midpoint(hi) - corner).signum() * radius;
        for i in 0..=6_u8 {
            let angle = ops::TAU * (0.25 * f64::from(k) - 0.25 + f64::from(i) / 24.0);
            let (sin, cos) = ops::sin_cos(angle);
            out.push(corner + inwards + DVec2::new(cos, sin) * radius);
        }
    }
    out.dedup();
    out.push(out[0]);
    out
}

pub(super) fn ring(centre: DVec2, radius: DVec2, n: u32) -> Vec<DVec2> {
    let point = |k: u32| {
        let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k % n) / f64::from(n));
        centre + DVec2::new(cos, sin) * radius
    };
    (0..=n).map(point).collect()
}

/// Returns the outline of a pen that moved along a line: one ring, or an outer and an inner one where the line is
/// closed. `width`: of the pen, by the share of the length.
pub(super) fn expanded(line: &Line, width: impl Fn(f64) -> f64) -> Vec<Vec<DVec2>> {
    let way = geom::resample(&line.points, 1.5 * PEN);
    let n = way.len();
    if n < 2 {
        return Vec::new();
    }
    let before = |k: usize| if line.closed && k == 0 { way[n - 2] } else { way[k.saturating_sub(1)] };
    let after = |k: usize| if line.closed && k == n - 1 { way[1] } else { way[(k + 1).min(n - 1)] };
    let side = |k: usize, sign: f64| {
        let across = (after(k) - before(k)).normalize_or_zero().perp();
        way[k] + across * (0.5 * sign * width(k as f64 / (n - 1) as f64))
    };
    let left: Vec<DVec2> = (0..n).map(|k| side(k, 1.0)).collect();
    let right: Vec<DVec2> = (0..n).rev().map(|k| side(k, -1.0)).collect();
    if line.closed {
        let shut = |mut ring: Vec<DVec2>| {
            let last = ring.len() - 1;
            ring[last] = ring[0];
            ring
        };
        return vec![shut(left), shut(right)];
    }
    let mut out = left;
    out.extend(cap(way[n - 1], way[n - 1] - way[n - 2], width(1.0)));
    out.extend(right);
    out.extend(cap(way[0], way[0] - way[1], width(0.0)));
    out.push(out[0]);
    vec![out]
}

/// Returns half a circle round the end of a pen's path, from its left to its right.
fn cap(end: DVec2, way: DVec2, width: f64) -> Vec<DVec2> {
    let way = way.normalize_or_zero();
    let point = |k: u8| {
        let (sin, cos) = ops::sin_cos(ops::PI * (0.5 - f64::from(k) / 6.0));
        end + (way * cos + way.perp() * sin) * (0.5 * width)
    };
    (1..6).map(point).collect()
}

/// Returns straight lines across an outline in one direction, from edge to edge.
pub(super) fn hatches(outline: &[DVec2], angle: f64, apart: f64) -> Vec<[DVec2; 2]> {
    let way = DVec2::new(ops::cos(angle), ops::sin(angle));
    let turned: Vec<DVec2> = outline.iter().map(|p| DVec2::new(p.dot(way), p.dot(way.perp()))).collect();
    let Some((lo, hi)) = geom::bounds(&turned) else { return Vec::new() };
    let mut out = Vec::new();
    let mut y = lo.y + 0.5 * apart;
    while y < hi.y {
        let mut crossings: Vec<f64> = (turned.windows(2))
            .filter(|w| (w[0].y <= y) != (w[1].y <= y))
            .map(|w| w[0].x + (w[1].x - w[0].x) * (y - w[0].y) / (w[1].y - w[0].y))
            .collect();
        base::sort_numbers(&mut crossings);
        for pair in crossings.chunks_exact(2) {
            out.push([pair[0], pair[1]].map(|x| way * x + way.perp() * y));
        }
        y += apart;
    }
    out
}

/// Returns a line as a hand repeats it: moved by a slow wave of this width.
pub(super) fn shaken(r: &mut Stream, line: &[DVec2], wide: f64) -> Vec<DVec2> {
    let phases = [r.range(0.0, ops::TAU), r.range(0.0, ops::TAU)];
    let closed = line.len() > 3 && line.first() == line.last();
    let length = geom::polyline_length(line);
    let wave = ops::TAU * (length / 120.0).round().max(1.0) / length;
    let mut gone = 0.0;
    let mut out: Vec<DVec2> = Vec::with_capacity(line.len());
    for (k, p) in line.iter().enumerate() {
        gone += if k > 0 { p.distance(line[k - 1]) } else { 0.0 };
        out.push(*p + DVec2::from_array(phases.map(|phase| wide * ops::sin(phase + gone * wave))));
    }
    if closed {
        let last = out.len() - 1;
        out[last] = out[0];
    }
    out
}

/// Cuts a line into `count` pieces of one length, each shortened by `gap` at both ends.
pub(super) fn pieces(line: &[DVec2], count: u32, gap: f64) -> Vec<Vec<DVec2>> {
    let length = geom::polyline_length(line);
    let share = length / f64::from(count);
    (0..count)
        .map(|k| part(line, f64::from(k) * share + gap, f64::from(k + 1) * share - gap))
        .filter(|p| p.len() > 1)
        .collect()
}

/// Returns the part of a line between two shares of its length.
fn part(line: &[DVec2], from: f64, to: f64) -> Vec<DVec2> {
    let mut out: Vec<DVec2> = geom::point_at(line, from.max(0.0)).into_iter().collect();
    let mut gone = 0.0;
    for w in line.windows(2) {
        gone += w[0].distance(w[1]);
        if gone > from + 1e-6 && gone < to - 1e-6 {
            out.push(w[1]);
        }
    }
    out.extend(geom::point_at(line, to.min(geom::polyline_length(line))));
    out
}

/// Returns the edges of the ink of all lines on a raster, as a tracer of bitmaps finds them: closed rings, ink to one
/// side.
pub(super) fn traced(page: &Page, cell: f64) -> Vec<Vec<DVec2>> {
    let size = (page.size / cell).ceil();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the size of a page")]
    let (wide, high) = (size.x as usize + 2, size.y as usize + 2);
    let mut on = vec![false; wide * high];
    let reach = 0.5 * PEN / cell;
    for line in &page.lines {
        for p in geom::resample(&line.points, 0.5 * cell) {
            ink_disc(&mut on, wide, p / cell, reach);
        }
    }
    let has = |x: usize, y: usize| x < wide && y < high && on[y * wide + x];
    // Edges of cells, each from a corner to the next one with ink to its right.
    let mut leaves: Vec<Vec<usize>> = vec![Vec::new(); (wide + 1) * (high + 1)];
    let corner = |x: usize, y: usize| y * (wide + 1) + x;
    for y in 0..high {
        for x in (0..wide).filter(|&x| has(x, y)) {
            let edges = [
                (y == 0 || !has(x, y - 1), corner(x, y), corner(x + 1, y)),
                (!has(x + 1, y), corner(x + 1, y), corner(x + 1, y + 1)),
                (!has(x, y + 1), corner(x + 1, y + 1), corner(x, y + 1)),
                (x == 0 || !has(x - 1, y), corner(x, y + 1), corner(x, y)),
            ];
            for (_, from, to) in edges.into_iter().filter(|e| e.0) {
                leaves[from].push(to);
            }
        }
    }
    let mut rings = Vec::new();
    for start in 0..leaves.len() {
        while !leaves[start].is_empty() {
            let mut ring = Vec::new();
            let mut at = start;
            while let Some(next) = leaves[at].pop() {
                #[expect(clippy::cast_precision_loss, reason = "corners of a raster")]
                ring.push(DVec2::new((at % (wide + 1)) as f64, (at / (wide + 1)) as f64) * cell);
                at = next;
            }
            rings.push(smooth(&ring));
        }
    }
    rings
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cells of a page")]
fn ink_disc(on: &mut [bool], wide: usize, middle: DVec2, reach: f64) {
    let (lo, hi) = ((middle - reach).max(DVec2::ZERO), middle + reach);
    for y in lo.y as usize..=hi.y as usize {
        for x in lo.x as usize..=hi.x as usize {
            let centre = DVec2::new(x as f64, y as f64) + 0.5;
            if centre.distance(middle) <= reach && y * wide + x < on.len() {
                on[y * wide + x] = true;
            }
        }
    }
}

/// Averages five neighbours round a ring, keeping every second one.
fn smooth(ring: &[DVec2]) -> Vec<DVec2> {
    let n = ring.len();
    let mean = |k: usize| (0..5).map(|j| ring[(k + n + j - 2) % n]).sum::<DVec2>() / 5.0;
    let mut out: Vec<DVec2> = (0..n).step_by(2).map(mean).collect();
    out.push(out[0]);
    out
}
