//! A drawing that grows stroke by stroke, as a person sees it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use burgeon::document::StrokeId;
use burgeon::formats::{self, DrawingFormat};
use burgeon::glam::DVec2;
use burgeon::ink::{Drawing, InkSample, Stroke, StrokeClass};
use burgeon::{Run, StrokeReport};
use workspace::Workspace;

const GALLERY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/gallery");
/// Confidence below which a page shows a class as doubtful.
const DOUBTFUL: f64 = 0.3;

type Shown = Vec<(StrokeId, Option<StrokeClass>)>;

fn gallery() -> Vec<Drawing> {
    let entries = fs::read_dir(Path::new(GALLERY)).expect("a drawing of our own");
    let mut files: Vec<_> = entries.map(|f| f.expect("a drawing of our own").path()).collect();
    files.sort();
    let read = |file| {
        let bytes = fs::read(file).expect("a drawing of our own");
        formats::read_drawings(bytes.as_slice(), DrawingFormat::Svg, "a drawing")
            .next()
            .expect("a drawing of our own")
            .expect("a drawing of our own")
            .drawing
    };
    files.into_iter().map(read).filter(|d| d.strokes.len() < 40).collect()
}

fn digest(workspace: &mut Workspace) -> String {
    let view = workspace.evaluate(&Run::plain()).expect("a drawing of our own");
    view.plants[0].item.as_ref().expect("a drawing of our own").digest.clone()
}

fn strokes(workspace: &mut Workspace) -> Vec<StrokeReport> {
    let view = workspace.evaluate(&Run::plain()).expect("a drawing of our own");
    view.plants[0].item.as_ref().map_or_else(Vec::new, |i| i.strokes.clone())
}

fn is_clear(s: &StrokeReport) -> bool {
    s.confidence >= DOUBTFUL
}

/// Returns the classes that a page reports as clearly shown.
fn shown(seen: &[StrokeReport]) -> Shown {
    let class = |s: &StrokeReport| StrokeClass::ALL.into_iter().find(|c| c.word() == s.class);
    seen.iter().map(|s| (StrokeId(s.index), class(s).filter(|_| is_clear(s)))).collect()
}

/// Draws as with a page that keeps the shown classes, or not. Returns the requests, how often an existing stroke took a
/// class other than its final one, and how many were kept as shown.
fn draw(drawing: &Drawing, keeps: bool) -> (Workspace, Vec<(Stroke, Shown)>, [usize; 2]) {
    let (mut workspace, mut asked) = (Workspace::default(), Vec::new());
    let (mut before, mut became, mut kept) = (BTreeMap::new(), Vec::new(), 0);
    for stroke in &drawing.strokes {
        let seen = strokes(&mut workspace);
        let shown = if keeps { shown(&seen) } else { Shown::new() };
        workspace.add_stroke(stroke.clone(), shown.clone()).expect("a drawing of our own");
        asked.push((stroke.clone(), shown));
        for s in strokes(&mut workspace) {
            kept += usize::from(s.source == "rule:as-shown");
            if before.insert(s.index, s.class.clone()).is_some_and(|was| was != s.class) {
                became.push((s.index, s.class));
            }
        }
    }
    let away = became.iter().filter(|(index, class)| before.get(index) != Some(class)).count();
    (workspace, asked, [away, kept])
}

/// The class that a stroke was shown as stays, if nothing requires another, in the document, in its file and on redo.
#[test]
fn what_was_shown_stays_while_a_drawing_grows() {
    let (mut afresh, mut steady, mut kept) = (0, 0, 0);
    for drawing in gallery() {
        let (mut plain, _, [changes, _]) = draw(&drawing, false);
        afresh += changes;
        let (mut workspace, asked, [changes, held]) = draw(&drawing, true);
        (steady, kept) = (steady + changes, kept + held);
        let seen = digest(&mut workspace);

        let mut opened = Workspace::default();
        opened.open("a.burgeon", &workspace.save().unwrap(), 0, true).unwrap();
        assert_eq!(digest(&mut opened), seen, "{}: the file", drawing.name);

        let mut again = Workspace::default();
        for (stroke, shown) in asked {
            again.add_stroke(stroke, shown).unwrap();
        }
        assert_eq!(
            digest(&mut again),
            seen,
            "{}: the same requests, without a look between them",
            drawing.name
        );

        // A file of strokes has no history.
        let mut file = Vec::new();
        formats::write_drawing(&drawing, &mut file).unwrap();
        let mut opened = Workspace::default();
        opened.open("a.json", &file, 0, true).unwrap();
        assert_eq!(digest(&mut opened), digest(&mut plain), "{}: afresh", drawing.name);
    }
    assert!(kept > 0 && 4 * steady < 3 * afresh, "{afresh} changes afresh, {steady} with what was shown");
}

/// Undo takes back the kept classes of a stroke, and a class that is left to the classifier again is read afresh.
#[test]
fn what_was_shown_is_forgotten_when_it_is_asked() {
    let drawing = gallery().into_iter().find(|d| d.strokes.len() > 5).unwrap();
    let (mut workspace, ..) = draw(&drawing, true);
    let shown = |w: &Workspace| w.document().plants()[0].shown().len();
    let all = shown(&workspace);
    assert!(all > 0);
    while workspace.undo().is_some() {}
    assert_eq!(shown(&workspace), 0);
    while workspace.redo().is_some() {}
    assert_eq!(shown(&workspace), all);
    let plant = workspace.current().unwrap();
    let ids: Vec<StrokeId> = workspace.document().plants()[0].strokes().iter().map(|s| s.id).collect();
    workspace.run(burgeon::document::SketchCommand::SetClass(ids, None).for_plant(plant)).unwrap();
    assert_eq!(shown(&workspace), 0);
}

/// Lines that a person adds to a tree that was opened: the ends of each, as shares of the drawing's box (y up).
const LINES: [(&str, [[f64; 4]; 3]); 5] = [
    ("twigs in the crown", [[0.5, 0.7, 0.35, 0.85], [0.5, 0.6, 0.7, 0.8], [0.45, 0.55, 0.25, 0.6]]),
    ("twigs at the trunk", [[0.5, 0.3, 0.3, 0.4], [0.5, 0.35, 0.7, 0.45], [0.5, 0.2, 0.6, 0.28]]),
    ("grass at the foot", [[0.06, -0.06, 0.05, 0.05], [0.16, -0.06, 0.17, 0.08], [1.0, -0.06, 1.0, 0.05]]),
    ("grass beside it", [[0.1, 0.0, 0.08, 0.1], [0.2, 0.0, 0.22, 0.12], [0.9, 0.0, 0.92, 0.1]]),
    ("long lines across", [[0.05, 0.5, 0.95, 0.55], [0.1, 0.1, 0.9, 0.9], [0.5, 0.02, 0.5, 0.98]]),
];
/// Number of points of each line.
const POINTS: usize = 24;

/// Makes a line with the slight arc of a hand.
fn line(drawing: &Drawing, [x0, y0, x1, y1]: [f64; 4]) -> Stroke {
    let points = || drawing.strokes.iter().flat_map(|s| s.samples.iter().map(|p| p.at));
    let low = points().fold(DVec2::INFINITY, DVec2::min);
    let size = points().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
    let (from, to) = (low + DVec2::new(x0, y0) * size, low + DVec2::new(x1, y1) * size);
    let aside = 0.04 * (to - from).perp();
    let at = |i| {
        let t = i as f64 / (POINTS - 1) as f64;
        InkSample::from(from.lerp(to, t) + aside * 4.0 * t * (1.0 - t))
    };
    Stroke { samples: (0..POINTS).map(at).collect(), ..Stroke::default() }
}

/// Tests trees that once became a petal or a leaf when one to three lines were added: each stroke keeps the class that
/// it was clearly shown as, and none becomes a blade.
#[test]
fn lines_more_make_nothing_else_of_a_tree() {
    // A line from edge to edge of the poplar's crown turns it into a leaf and its midrib: its outline is one.
    for (name, sets) in [("apple-tree", 5), ("oak", 5), ("pine", 5), ("poplar", 4)] {
        let bytes = fs::read(Path::new(GALLERY).join(format!("{name}.svg"))).expect("a drawing of our own");
        let drawing = formats::read_drawings(bytes.as_slice(), DrawingFormat::Svg, name);
        let drawing = drawing.map(|d| d.expect("a drawing of our own").drawing).next().expect("one drawing");
        for (what, lines) in LINES.into_iter().take(sets) {
            let mut workspace = Workspace::default();
            workspace.open(&format!("{name}.svg"), &bytes, 0, false).expect("a drawing of our own");
            let mut before = strokes(&mut workspace);
            let opened = before.len();
            for (count, ends) in lines.into_iter().enumerate() {
                workspace.add_stroke(line(&drawing, ends), shown(&before)).expect("a line");
                let now = strokes(&mut workspace);
                for (was, is) in before[..opened].iter().zip(&now) {
                    let stays = is.organ == was.organ && is.class == was.class;
                    assert!(stays || !is_clear(was), "{name}: {} of {what}: {was:?}, then {is:?}", count + 1);
                    let flat = ["petal", "leaf"].contains(&is.organ.as_str());
                    assert!(stays || !flat, "{name}: {} of {what}: {was:?}, then {is:?}", count + 1);
                }
                before = now;
            }
        }
    }
}
