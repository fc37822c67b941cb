//! A drawing that grows stroke by stroke, as a person sees it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use burgeon::document::StrokeId;
use burgeon::formats::{self, DrawingFormat};
use burgeon::ink::{Drawing, Stroke, StrokeClass};
use burgeon::{Run, StrokeReport};
use workspace::Workspace;

const GALLERY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/gallery");
/// A page shows what is less sure as doubtful.
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

/// Draws as with a page that keeps what it shows, or not: the requests, how often a stroke that was there became what it is
/// not when the drawing is done, and how many were kept as shown.
fn draw(drawing: &Drawing, keeps: bool) -> (Workspace, Vec<(Stroke, Shown)>, [usize; 2]) {
    let (mut workspace, mut asked) = (Workspace::default(), Vec::new());
    let (mut before, mut became, mut kept) = (BTreeMap::new(), Vec::new(), 0);
    for stroke in &drawing.strokes {
        let seen = strokes(&mut workspace);
        let shown: Shown = seen
            .iter()
            .filter(|_| keeps)
            .map(|s| {
                let class = StrokeClass::ALL.into_iter().find(|c| c.word() == s.class);
                (StrokeId(s.index), class.filter(|_| s.confidence >= DOUBTFUL))
            })
            .collect();
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

/// What a stroke was shown as stays without need for another, in the document, in its file and when it is done again.
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

/// Undo takes back what was kept with a stroke, and a class that is left to the classifier again is read afresh.
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
    workspace.run(burgeon::document::SketchCommand::SetClass(ids, None).of(plant)).unwrap();
    assert_eq!(shown(&workspace), 0);
}
