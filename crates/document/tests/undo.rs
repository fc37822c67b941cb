//! Undo of every command is the identity, for any sequence of commands.

use base::Seed;
use document::{
    Command, CommandError, Document, Editor, NewStroke, Photo, StrokeId, read_project, write_project,
};
use glam::DVec2;
use proptest::collection::vec;
use proptest::prelude::*;
use sketch::{Drawing, InkSample, SketchSpec, Stroke, StrokeClass, StrokeMode};
use skin::SkinSpec;

fn point() -> impl Strategy<Value = DVec2> {
    let number = prop_oneof![
        8 => -500.0..500.0f64,
        1 => prop_oneof![Just(0.0), Just(-0.0), Just(f64::NAN), Just(f64::INFINITY), Just(1e308), Just(5e-324)],
    ];
    (number.clone(), number).prop_map(|(x, y)| DVec2::new(x, y))
}

fn stroke() -> impl Strategy<Value = NewStroke> {
    let sample = (point(), proptest::option::of(0.0..1e4f64), proptest::option::of(0.0..1.0f64));
    let sample = sample.prop_map(|(at, time_ms, pressure)| InkSample { at, time_ms, pressure });
    (vec(sample, 0..12), 0..3usize, proptest::option::of(any::<[u8; 3]>())).prop_map(
        |(samples, mode, color)| {
            let mode = [StrokeMode::Parts, StrokeMode::BranchContour, StrokeMode::LeafContour][mode];
            NewStroke { stroke: Stroke { samples, mode, color, id: None }, class: None }
        },
    )
}

fn command() -> impl Strategy<Value = Command> {
    let ids = || vec((0..12u32).prop_map(StrokeId), 0..4);
    let class = proptest::option::of((0..12usize).prop_map(|i| StrokeClass::ALL[i]));
    prop_oneof![
        4 => vec(stroke(), 0..3).prop_map(Command::AddStrokes),
        2 => ids().prop_map(Command::RemoveStrokes),
        2 => (ids(), point()).prop_map(|(ids, by)| Command::MoveStrokes(ids, by)),
        1 => (ids(), class).prop_map(|(ids, class)| Command::SetClass(ids, class)),
        1 => ids().prop_map(|ids| Command::SetMode(ids, StrokeMode::LeafContour)),
        1 => (ids(), any::<[u8; 3]>()).prop_map(|(ids, color)| Command::SetColor(ids, Some(color))),
        2 => (ids(), point()).prop_map(|(ids, by)| Command::Duplicate(ids, by)),
        1 => proptest::option::of((point(), -1.0..3.0f64, any::<bool>())).prop_map(|photo| {
            Command::SetPhoto(photo.map(|(at, size, paint)| {
                let png = [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x02\0\0\0\x03"[..], &[1; 9]].concat();
                let mut photo = Photo::new(png.into()).expect("a PNG header");
                (photo.x, photo.y, photo.width, photo.opacity, photo.paint) = (at.x, at.y, size, size / 2.0, paint);
                Box::new(photo)
            }))
        }),
        1 => Just(Command::Clear),
        1 => ".{0,300}".prop_map(Command::Rename),
        1 => any::<u64>().prop_map(|n| Command::SetSeed(Seed::new(n))),
        1 => (-1.0..12.0f64).prop_map(|density| {
            let mut spec = SketchSpec::default();
            spec.fill.density = density;
            Command::SetSketch(Box::new(spec))
        }),
        1 => (0.0..9.0f64).prop_map(|detail| Command::SetSkin(SkinSpec { detail, ..SkinSpec::default() })),
        1 => vec(vec(point(), 0..5), 0..4).prop_map(|lines| {
            Command::Open(Box::new(Document::from_drawing(&Drawing::from_polylines("other", &lines))))
        }),
    ]
}

#[derive(Clone, Debug)]
enum Act {
    Run(Command),
    Gesture(Vec<Command>, bool),
    Undo,
    Redo,
}

fn act() -> impl Strategy<Value = Act> {
    prop_oneof![
        6 => command().prop_map(Act::Run),
        2 => (vec(command(), 0..4), any::<bool>()).prop_map(|(c, keep)| Act::Gesture(c, keep)),
        2 => Just(Act::Undo),
        1 => Just(Act::Redo),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn undo_of_everything_is_the_identity(acts in vec(act(), 0..24)) {
        let mut editor = Editor::default();
        let start = editor.document().clone();
        for act in acts {
            let before = editor.document().clone();
            let revision = editor.revision();
            match act {
                Act::Run(command) => {
                    let steps = editor.done().len();
                    if editor.run(command).is_ok() {
                        prop_assert!(editor.revision() > revision);
                        let after = editor.document().clone();
                        prop_assert!(editor.undo().is_some());
                        prop_assert_eq!(editor.document(), &before);
                        prop_assert!(editor.redo().is_some());
                        prop_assert_eq!(editor.document(), &after);
                        prop_assert_eq!(editor.done().len(), steps + 1);
                    } else {
                        prop_assert_eq!(editor.document(), &before, "a refused command changes nothing");
                    }
                }
                Act::Gesture(commands, keep) => {
                    let steps = editor.done().len();
                    editor.begin_gesture("drag").unwrap();
                    for command in commands {
                        let staged = editor.document().clone();
                        if editor.stage(command).is_err() {
                            prop_assert_eq!(editor.document(), &staged);
                        }
                    }
                    if !keep {
                        editor.cancel_gesture();
                        prop_assert_eq!(editor.document(), &before);
                    } else if editor.commit() {
                        let after = editor.document().clone();
                        prop_assert_eq!(editor.undo(), Some("drag"));
                        prop_assert_eq!(editor.document(), &before);
                        editor.redo();
                        prop_assert_eq!(editor.document(), &after);
                    } else {
                        prop_assert_eq!(editor.document(), &before);
                        prop_assert_eq!(editor.done().len(), steps);
                    }
                }
                Act::Undo => { editor.undo(); }
                Act::Redo => { editor.redo(); }
            }
            prop_assert_eq!(editor.document().validate().collect::<Vec<_>>(), vec![]);
        }
        let end = editor.document().clone();
        let steps = editor.done().len();
        while editor.undo().is_some() {}
        prop_assert_eq!(editor.document(), &start);
        for _ in 0..steps { editor.redo(); }
        prop_assert_eq!(editor.document(), &end);
    }

    #[test]
    fn a_saved_document_comes_back_with_the_same_bits(commands in vec(command(), 0..12)) {
        let mut editor = Editor::default();
        for command in commands { let _ = editor.run(command); }
        let document = editor.document();
        let back = read_project(&write_project(document, "test").unwrap()).unwrap();
        prop_assert_eq!(back.settings(), document.settings());
        prop_assert_eq!(back.classes(), document.classes());
        prop_assert_eq!(back.strokes().len(), document.strokes().len());
        for (a, b) in back.strokes().iter().zip(document.strokes()) {
            prop_assert_eq!(&a.stroke, &b.stroke);
            for (p, q) in a.stroke.samples.iter().zip(&b.stroke.samples) {
                prop_assert_eq!(p.at.x.to_bits(), q.at.x.to_bits());
                prop_assert_eq!(p.at.y.to_bits(), q.at.y.to_bits());
            }
        }
        prop_assert_eq!(back.validate().collect::<Vec<_>>(), vec![]);
    }
}

#[test]
fn a_hundred_steps_are_undone_by_name() {
    let mut editor = Editor::default();
    for k in 0..100 {
        let line = NewStroke::line(&[DVec2::ZERO, DVec2::new(f64::from(k), 1.0)]);
        editor.run(Command::AddStrokes(vec![line])).unwrap();
    }
    editor.run(Command::Clear).unwrap();
    assert_eq!(editor.document().strokes().len(), 0);
    assert_eq!(editor.undo(), Some("clear"));
    for left in (0..100).rev() {
        assert_eq!(editor.undo(), Some("draw"));
        assert_eq!(editor.document().strokes().len(), left);
    }
    assert_eq!(editor.undo(), None);
}

#[test]
fn a_drag_is_one_step_and_a_drag_back_is_none() {
    let mut editor = Editor::default();
    editor.run(Command::AddStrokes(vec![NewStroke::line(&[DVec2::ZERO, DVec2::Y])])).unwrap();
    let id = editor.document().strokes()[0].id;
    editor.begin_gesture("move").unwrap();
    for k in 1..=5 {
        editor.stage(Command::MoveStrokes(vec![id], DVec2::X * f64::from(k))).unwrap();
    }
    assert!(editor.commit());
    assert_eq!(editor.document().strokes()[0].stroke.samples[0].at, DVec2::X * 5.0);
    assert_eq!(editor.done().len(), 2);
    editor.begin_gesture("move").unwrap();
    editor.stage(Command::MoveStrokes(vec![id], DVec2::X)).unwrap();
    editor.stage(Command::MoveStrokes(vec![id], DVec2::ZERO)).unwrap();
    assert!(!editor.commit());
    assert_eq!(editor.document().strokes()[0].stroke.samples[0].at, DVec2::X * 5.0);
}

#[test]
fn refusals_say_why() {
    let mut editor = Editor::default();
    let refused = |e: &mut Editor, c| e.run(c).unwrap_err().to_string();
    assert!(refused(&mut editor, Command::RemoveStrokes(vec![StrokeId(7)])).contains("no stroke 7"));
    assert!(
        refused(&mut editor, Command::SetSkin(SkinSpec { detail: 99.0, ..SkinSpec::default() }))
            .contains("0.1 to 8")
    );
    let far = NewStroke::line(&[DVec2::splat(f64::MAX), DVec2::ZERO]);
    editor.run(Command::AddStrokes(vec![far])).unwrap();
    let too_far = editor.run(Command::MoveStrokes(vec![StrokeId(0)], DVec2::splat(f64::MAX)));
    assert_eq!(too_far, Err(CommandError::TooFar));
}
