//! Whether a drawing is read alike when it is drawn differently with the same meaning: smaller, with fewer points, in
//! the opposite direction, by a trembling hand.
//!
//! `drawings -> for each change, the number that are then read as something else`

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use base::turn::direction;
use base::{Draw, Report, Run, Seed, Stream, ops};
use glam::DVec2;
use ink::{Drawing, InkSample, Stroke, StrokeClass};
use reading::Kind;

/// A line, and its number in the drawing.
#[derive(Clone)]
struct Line {
    place: usize,
    points: Vec<DVec2>,
}

type Lines = Vec<Line>;

/// Redraws lines, of a drawing with a diagonal of 1.
type Again = fn(&mut Stream, &mut Lines);

/// Ways to draw the same.
const WAYS: [(&str, Again); 15] = [
    ("a hundredth as large", |_, l| points(l, |p| p * 0.01)),
    ("a hundred times as large", |_, l| points(l, |p| p * 100.0)),
    ("in whole pixels, 150 across", |_, l| points(l, |p| (p * 150.0).round())),
    ("every third point of lines with 30 or more", |_, l| lines(l, every_third)),
    ("a point more between each two", |_, l| lines(l, denser)),
    ("each point twice", |_, l| lines(l, |l| l.iter().flat_map(|&p| [p, p]).collect())),
    ("each stroke backwards", |_, l| lines(l, |l| l.iter().rev().copied().collect())),
    ("left and right exchanged", |_, l| points(l, |p| DVec2::new(-p.x, p.y))),
    ("the last stroke first", |_, l| l.reverse()),
    ("strokes in another order", shuffled),
    ("turned by 10 degrees", |_, l| points(l, |p| direction(TAU / 36.0).rotate(p))),
    ("turned by 10 degrees the other way", |_, l| points(l, |p| direction(-TAU / 36.0).rotate(p))),
    ("a shake of 0.3 % of the diagonal", |r, l| l.iter_mut().for_each(|l| shaken(r, &mut l.points))),
    ("each end 1 % shorter", |_, l| lines(l, shorter)),
    ("one stroke drawn twice", retraced),
];

fn points(lines: &mut Lines, to: impl Fn(DVec2) -> DVec2) {
    lines.iter_mut().flat_map(|l| &mut l.points).for_each(|p| *p = to(*p));
}

fn lines(lines: &mut Lines, to: impl Fn(&[DVec2]) -> Vec<DVec2>) {
    lines.iter_mut().for_each(|l| l.points = to(&l.points));
}

/// Keeps every third point of a line with many points; in a line with few, each matters.
fn every_third(line: &[DVec2]) -> Vec<DVec2> {
    const MANY: usize = 30;
    let last = line.len() - 1;
    let kept = |k: &usize| line.len() < MANY || k.is_multiple_of(3) || *k == last;
    line.iter().enumerate().filter(|(k, _)| kept(k)).map(|(_, &p)| p).collect()
}

fn denser(line: &[DVec2]) -> Vec<DVec2> {
    let between = line.windows(2).flat_map(|w| [w[0], w[0].midpoint(w[1])]);
    between.chain(line.last().copied()).collect()
}

fn shuffled(r: &mut Stream, lines: &mut Lines) {
    for k in (1..lines.len()).rev() {
        lines.swap(k, r.below(k + 1));
    }
}

/// Adds a wave along the line, at the rate of a trembling hand.
fn shaken(r: &mut Stream, line: &mut [DVec2]) {
    const WIDE: f64 = 0.003;
    const LONG: f64 = 0.03;
    let phases = [r.range(0.0, TAU), r.range(0.0, TAU)];
    let (mut gone, mut last) = (0.0, line[0]);
    for p in line {
        gone += p.distance(last);
        last = *p;
        *p += DVec2::from_array(phases.map(|phase| WIDE * ops::sin(phase + gone / LONG * TAU)));
    }
}

fn length(line: &[DVec2]) -> f64 {
    line.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn shorter(line: &[DVec2]) -> Vec<DVec2> {
    let length = length(line);
    let (mut gone, mut kept) = (0.0, Vec::new());
    for w in line.windows(2) {
        let d = w[0].distance(w[1]);
        for (at, p) in [(gone, w[0]), (gone + d, w[1])] {
            if at > 0.01 * length && at < 0.99 * length && kept.last() != Some(&p) {
                kept.push(p);
            }
        }
        gone += d;
    }
    if kept.len() > 1 { kept } else { line.to_vec() }
}

/// Repeats the longest stroke with a shift, at the end.
fn retraced(_: &mut Stream, lines: &mut Lines) {
    let longest = lines.iter().max_by(|a, b| length(&a.points).total_cmp(&length(&b.points))).cloned();
    lines.extend(longest.map(|l| Line {
        place: usize::MAX,
        points: l.points.into_iter().map(|p| p + DVec2::splat(0.004)).collect(),
    }));
}

/// Result of reading: the kinds of the plants, sorted, and the class of each line of the drawing.
struct Read {
    kinds: Vec<Kind>,
    classes: BTreeMap<usize, StrokeClass>,
}

impl Read {
    fn from_lines(lines: &Lines) -> Self {
        let samples = |l: &Line| l.points.iter().map(|&p| InkSample::from(p)).collect();
        let strokes = lines.iter().map(|l| Stroke { samples: samples(l), ..Stroke::default() }).collect();
        let drawing = Drawing { strokes, ..Drawing::default() };
        let ink = ink::clean(&drawing, &mut Report::default());
        let classes = ink::classify(&ink, &Run::plain());
        let reading = reading::read(&ink, &classes, &mut Report::default());
        let mut kinds: Vec<Kind> = reading.plants.iter().map(|p| p.kind).collect();
        kinds.sort_unstable();
        let classes = reading.strokes.iter().map(|s| (lines[s.index as usize].place, s.class)).collect();
        Self { kinds, classes }
    }

    fn same_kinds(&self, other: &Self) -> bool {
        self.kinds.len() == other.kinds.len()
            && self.kinds.iter().zip(&other.kinds).all(|(a, b)| a.is_like(*b))
    }
}

/// Returns the lines of a drawing, its diagonal 1; strokes of one point are left out.
fn lines_of(drawing: &Drawing) -> Lines {
    let strokes = drawing.strokes.iter().filter(|s| s.samples.len() > 1).enumerate();
    let mut lines: Lines =
        strokes.map(|(place, s)| Line { place, points: s.samples.iter().map(|p| p.at).collect() }).collect();
    let all = lines.iter().flat_map(|l| &l.points).map(|&p| (p, p));
    if let Some((lo, hi)) = all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) {
        let scale = 1.0 / lo.distance(hi).max(1e-9);
        points(&mut lines, |p| (p - lo) * scale);
    }
    lines
}

/// Effects of one change: drawings whose number of plants, kinds, or class of any stroke changes; strokes whose class
/// changes, and all.
#[derive(Clone, Copy, Default)]
struct Changes {
    number: usize,
    kinds: usize,
    drawings: usize,
    strokes: usize,
    all: usize,
}

/// Applies each of the [`WAYS`] to one drawing.
fn changes(place: u64, drawing: &Drawing) -> [Changes; WAYS.len()] {
    let lines = lines_of(drawing);
    let plain = Read::from_lines(&lines);
    WAYS.map(|(_, again)| {
        let mut drawn = lines.clone();
        again(&mut Seed::new(300).child(place).stream(Draw::Template), &mut drawn);
        let now = Read::from_lines(&drawn);
        let both = |(k, class): (&usize, &StrokeClass)| Some((*class, *now.classes.get(k)?));
        let both: Vec<(StrokeClass, StrokeClass)> = plain.classes.iter().filter_map(both).collect();
        let strokes = both.iter().filter(|(a, b)| a != b).count();
        Changes {
            number: usize::from(now.kinds.len() != plain.kinds.len()),
            kinds: usize::from(!now.same_kinds(&plain)),
            drawings: usize::from(strokes > 0),
            strokes,
            all: both.len(),
        }
    })
}

/// Returns for each way to draw the same the share of drawings that are then read as something else.
pub(super) fn table(drawings: &[Drawing]) -> String {
    const HANDS: usize = 2;
    let mut found: Vec<[Changes; WAYS.len()]> = vec![[Changes::default(); WAYS.len()]; drawings.len()];
    let part = drawings.len().div_ceil(HANDS).max(1);
    std::thread::scope(|scope| {
        for (hand, (drawings, found)) in drawings.chunks(part).zip(found.chunks_mut(part)).enumerate() {
            scope.spawn(move || {
                for (k, (drawing, found)) in drawings.iter().zip(found).enumerate() {
                    *found = changes((hand * part + k) as u64, drawing);
                }
            });
        }
    });
    let mut out = String::from(
        "| drawn again | number of plants | kind | class of any stroke | strokes of another class |\n|---|---|---|---|---|\n",
    );
    for (way, (name, _)) in WAYS.iter().enumerate() {
        let sum = |of: fn(&Changes) -> usize| found.iter().map(|f| of(&f[way])).sum::<usize>() as f64;
        let share = |n: f64| 100.0 * n / drawings.len().max(1) as f64;
        let _ = writeln!(
            out,
            "| {name} | {:.1} % | {:.1} % | {:.1} % | {:.1} % |",
            share(sum(|c| c.number)),
            share(sum(|c| c.kinds)),
            share(sum(|c| c.drawings)),
            100.0 * sum(|c| c.strokes) / sum(|c| c.all).max(1.0)
        );
    }
    out
}
