//! Stability of the reading of a drawing while it is drawn: `drawings, orders -> changes of classes, right ones at the
//! end`.
//!
//! Every drawing is drawn stroke by stroke, in its own order and in shuffled orders, and read after each stroke, once
//! afresh and once with the classes shown before. The changes of existing strokes are counted. Then each whole drawing
//! gets one more straight line, across it, and the changes of its kind are counted.

use std::collections::BTreeMap;
use std::path::Path;

use base::{Draw, Report, Run, Seed};
use glam::DVec2;
use ink::{Drawing, StrokeClass};
use reading::{Kind, Reading};
use serde_json::Value;

use crate::ablation::fixtures_of;
use crate::quickdraw::{drawings_of, json_lines, list, text_of};
use xtask::shell::{Outcome, repository, say};

/// Number of orders in which each drawing is drawn: its own, and shuffled ones.
const ORDERS: u64 = 4;
/// Most strokes of a drawing that is used: each is read once for every stroke.
const MOST: usize = 60;
/// Confidence below which the Studio shows a class as doubtful, and does not keep it.
const DOUBTFUL: f64 = 0.3;

#[derive(Default)]
struct Tally {
    strokes: u32,
    changes: u32,
    organs: u32,
    labelled: u32,
    right: u32,
    /// Changes of strokes away from their class when the whole is read afresh.
    away: u32,
    /// Strokes whose final class differs from that when the whole is read afresh.
    other: u32,
}

fn read(drawing: &Drawing, shown: &BTreeMap<u32, StrokeClass>) -> Reading {
    let ink = ink::clean(drawing, &mut Report::default());
    let mut classes = ink::classify(&ink, &Run::plain());
    for (stroke, class) in ink.strokes.iter().zip(&mut classes) {
        class.shown = shown.get(&stroke.index).copied();
    }
    reading::read(&ink, &classes, &mut Report::default())
}

fn draw(
    tally: &mut Tally,
    drawing: &Drawing,
    labels: &BTreeMap<usize, StrokeClass>,
    order: &[usize],
    keeps: bool,
) {
    let nothing = BTreeMap::new();
    let strokes = order.iter().map(|&k| drawing.strokes[k].clone()).collect();
    let afresh = read(&Drawing { name: drawing.name.clone(), strokes, ..Drawing::default() }, &nothing);
    let ends = base::map_of(afresh.strokes.iter().map(|s| (s.index, s.class)));
    let mut shown = BTreeMap::new();
    let mut organs = BTreeMap::new();
    let mut held = BTreeMap::new();
    for n in 1..=order.len() {
        let strokes = order[..n].iter().map(|&k| drawing.strokes[k].clone()).collect();
        let sofar = Drawing { name: drawing.name.clone(), strokes, ..Drawing::default() };
        let reading = read(&sofar, if keeps { &held } else { &nothing });
        for s in &reading.strokes {
            let turned = shown.get(&s.index).filter(|&&c| c != s.class);
            tally.changes += u32::from(turned.is_some());
            tally.away += u32::from(turned.is_some() && turned == ends.get(&s.index));
            tally.organs += u32::from(organs.insert(s.index, s.organ).is_some_and(|c| c != s.organ));
            shown.insert(s.index, s.class);
            if s.confidence < DOUBTFUL {
                held.remove(&s.index);
            } else {
                held.insert(s.index, s.class);
            }
        }
        tally.strokes += 1;
    }
    for s in &afresh.strokes {
        tally.other += u32::from(shown.get(&s.index) != Some(&s.class));
    }
    for (place, &k) in order.iter().enumerate() {
        let Some(&label) = labels.get(&k) else { continue };
        tally.labelled += 1;
        #[expect(clippy::cast_possible_truncation, reason = "few strokes")]
        let found = shown.get(&(place as u32));
        tally.right += u32::from(found == Some(&label));
    }
}

/// Lines across a drawing: from the middles of the sides of its box, from its corners, and shorter ones near its
/// middle.
const ACROSS: [[f64; 4]; 8] = [
    [0.0, 0.5, 1.0, 0.5],
    [0.5, 0.0, 0.5, 1.0],
    [0.0, 0.0, 1.0, 1.0],
    [1.0, 0.0, 0.0, 1.0],
    [0.0, 0.7, 1.0, 0.8],
    [0.3, 0.5, 0.7, 0.5],
    [0.5, 0.3, 0.5, 0.7],
    [0.35, 0.6, 0.65, 0.75],
];

/// Number of times that one more line changes the kind of a drawing: afresh, and with the classes shown. `of` that many
/// lines.
#[derive(Default)]
struct Lines {
    of: u32,
    afresh: u32,
    shown: u32,
}

fn one_line_more(tally: &mut Lines, drawing: &Drawing) {
    let nothing = BTreeMap::new();
    let whole = read(drawing, &nothing);
    let sure = whole.strokes.iter().filter(|s| s.confidence >= DOUBTFUL);
    let shown: BTreeMap<u32, StrokeClass> = sure.map(|s| (s.index, s.class)).collect();
    let points = || drawing.strokes.iter().flat_map(|s| s.samples.iter().map(|p| p.at));
    let (low, high) = points().fold((DVec2::MAX, DVec2::MIN), |(a, b), p| (a.min(p), b.max(p)));
    for [x0, y0, x1, y1] in ACROSS {
        let at = |x: f64, y: f64| low + DVec2::new(x, y) * (high - low);
        let line = (0..=20).map(|k| at(x0, y0).lerp(at(x1, y1), f64::from(k) / 20.0)).collect();
        let mut more = drawing.clone();
        more.strokes.extend(Drawing::from_polylines("line", &[line]).strokes);
        let other = |shown| Kind::from_reading(&read(&more, shown)) != Kind::from_reading(&whole);
        tally.of += 1;
        tally.afresh += u32::from(other(&nothing));
        tally.shown += u32::from(other(&shown));
    }
}

/// # Errors
/// A sentence that names the file and its fault.
pub(crate) fn run(args: &[String]) -> Outcome {
    let folder =
        args.first().map_or_else(|| repository().join("../shared/data/sketches"), |f| Path::new(f).into());
    let mut labelled = Vec::new();
    let drawings = drawings_of(&folder.join("quickdraw"))?;
    for line in json_lines(&folder.join("labels.ndjson"))? {
        let Some(drawing) = drawings.get(text_of(&line, "key_id")) else { continue };
        let clear = |l: &&Value| l.get("unsure").is_none() && l.get("mixed").is_none();
        let labels = list(line.get("labels")).iter().filter(clear).filter_map(|l| {
            let class = StrokeClass::ALL.into_iter().find(|c| c.word() == text_of(l, "label"))?;
            Some((usize::try_from(l.get("stroke")?.as_u64()?).ok()?, class))
        });
        labelled.push((drawing.clone(), labels.collect()));
    }
    let own = fixtures_of(&repository().join("fixtures/sketches"))?;
    let own: Vec<_> = own.into_iter().map(|d| (d, BTreeMap::new())).collect();
    say(
        "| drawings | order | | strokes | classes changed | away from the end | organs changed | right at the end | other than afresh |",
    );
    say("|---|---|---|---|---|---|---|---|---|");
    for (what, set) in [("labelled", &labelled), ("our own", &own)] {
        for shuffled in [false, true] {
            for keeps in [false, true] {
                let mut tally = Tally::default();
                for (row, (drawing, labels)) in set.iter().enumerate() {
                    if drawing.strokes.len() > MOST {
                        continue;
                    }
                    let orders = if shuffled { 1..ORDERS } else { 0..1 };
                    for turn in orders {
                        let mut order: Vec<usize> = (0..drawing.strokes.len()).collect();
                        let r = &mut Seed::new(turn).child(row as u64).stream(Draw::Template);
                        if turn > 0 {
                            for i in (1..order.len()).rev() {
                                order.swap(i, r.below(i + 1));
                            }
                        }
                        draw(&mut tally, drawing, labels, &order, keeps);
                    }
                }
                let t = tally;
                say(&format!(
                    "| {what} | {} | {} | {} | {} | {} | {} | {} of {} | {} |",
                    if shuffled { "shuffled" } else { "as drawn" },
                    if keeps { "with what was shown" } else { "afresh" },
                    t.strokes,
                    t.changes,
                    t.away,
                    t.organs,
                    t.right,
                    t.labelled,
                    t.other
                ));
            }
        }
    }
    say("| drawings | one line more | another kind, afresh | another kind, with what was shown |");
    say("|---|---|---|---|");
    for (what, set) in [("labelled", &labelled), ("our own", &own)] {
        let mut tally = Lines::default();
        for (drawing, _) in set.iter().filter(|(d, _)| d.strokes.len() <= MOST) {
            one_line_more(&mut tally, drawing);
        }
        say(&format!("| {what} | {} | {} | {} |", tally.of, tally.afresh, tally.shown));
    }
    Ok(())
}
