//! Undo of every command is the identity, for any sequence of commands.

use std::sync::Arc;

use base::Seed;
use document::{
    Carry, Command, CommandError, Document, Editor, FlowerCommand, LeafCommand, LeafData, Maker,
    NamedObstacle, NewPlant, NewStroke, Photo, PhotoPlace, Placement, PlantCommand, PlantId, SceneCommand,
    Settings, ShapeCommand, SketchCommand, StrokeId, TreeCommand, WornPicture, read_project, write_project,
};
use glam::{DVec2, DVec3};
use growth::{Obstacle, TreeSpec};
use ink::{Drawing, InkSample, Layer, Stroke, StrokeClass, StrokeMode, StrokePull, StrokeTurn};
use proptest::collection::vec;
use proptest::prelude::*;
use shape::{AxisKey, Destination, HandEdit, LeafRegion, Turn, ViewPlane};
use sketch::SketchSpec;
use skin::{OrganMaterial, Pattern, SkinSpec, Wearer};

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
            NewStroke { stroke: Stroke { samples, mode, color, ..Stroke::default() }, ..NewStroke::default() }
        },
    )
}

/// Some of them name a picture that may not be there.
fn material() -> impl Strategy<Value = Option<OrganMaterial>> {
    let made = (0..Pattern::ALL.len(), -0.2..1.2f64, any::<bool>()).prop_map(|(pattern, amount, there)| {
        let pattern = Pattern::ALL[pattern];
        let name = if there { picture().name() } else { "none".into() };
        let picture = (pattern == Pattern::Picture).then_some(name);
        OrganMaterial { pattern, amount, picture, ..OrganMaterial::default() }
    });
    proptest::option::of(made)
}

fn picture() -> WornPicture {
    let png = [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x02\0\0\0\x03"[..], &[7; 9]].concat();
    WornPicture::new(png.into()).expect("a PNG header")
}

fn layer_command() -> impl Strategy<Value = SketchCommand> {
    let ids = || vec((0..12u32).prop_map(StrokeId), 0..4);
    let name = || prop_oneof![Just("petals"), Just("stem"), Just(" ")].prop_map(str::to_owned);
    let layer = (name(), any::<bool>(), any::<bool>());
    let layer = layer.prop_map(|(name, hidden, locked)| Layer { name: name.into(), hidden, locked });
    prop_oneof![
        3 => name().prop_map(SketchCommand::AddLayer),
        2 => (0..3usize, layer).prop_map(|(row, layer)| SketchCommand::SetLayer(row, layer)),
        1 => (0..3usize, 0..3usize).prop_map(|(from, to)| SketchCommand::MoveLayer(from, to)),
        1 => (0..3usize).prop_map(SketchCommand::RemoveLayer),
        3 => (ids(), proptest::option::of(name())).prop_map(|(ids, name)| SketchCommand::PutOn(ids, name)),
    ]
}

/// Upper bound of the numbers of most plants in a test.
const PLANTS: u32 = 6;

fn sketch_command() -> impl Strategy<Value = SketchCommand> {
    let ids = || vec((0..12u32).prop_map(StrokeId), 0..4);
    let class = proptest::option::of((0..12usize).prop_map(|i| StrokeClass::ALL[i]));
    prop_oneof![
        4 => vec(stroke(), 0..3).prop_map(SketchCommand::AddStrokes),
        2 => ids().prop_map(SketchCommand::RemoveStrokes),
        2 => (ids(), point()).prop_map(|(ids, by)| SketchCommand::MoveStrokes(ids, by)),
        1 => (ids(), point(), point(), -400.0..400.0f64).prop_map(|(ids, about, scale, angle_deg)| {
            SketchCommand::TurnStrokes(ids, StrokeTurn { about, angle_deg, scale })
        }),
        1 => (ids(), point(), point(), -1.0..50.0f64)
            .prop_map(|(ids, at, by, reach)| SketchCommand::PullStrokes(ids, StrokePull { at, by, reach })),
        1 => ids().prop_map(SketchCommand::SmoothStrokes),
        1 => (ids(), point()).prop_map(|(ids, at)| SketchCommand::CutStrokes(ids, at)),
        1 => ids().prop_map(SketchCommand::JoinStrokes),
        1 => (vec(point(), 0..4), -1.0..20.0f64).prop_map(|(path, radius)| SketchCommand::RubOut(path, radius)),
        1 => (ids(), class).prop_map(|(ids, class)| SketchCommand::SetClass(ids, class)),
        1 => ids().prop_map(|ids| SketchCommand::SetMode(ids, StrokeMode::LeafContour)),
        1 => (ids(), any::<[u8; 3]>()).prop_map(|(ids, color)| SketchCommand::SetColor(ids, Some(color))),
        2 => (ids(), point()).prop_map(|(ids, by)| SketchCommand::Duplicate(ids, by)),
        1 => proptest::option::of((point(), -1.0..3.0f64, any::<bool>())).prop_map(|photo| {
            photo.map_or(SketchCommand::RemovePhoto, |(at, size, paint)| {
                let png = [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x02\0\0\0\x03"[..], &[1; 9]].concat();
                let mut photo = Photo::new(png.into()).expect("a PNG header");
                photo.place = PhotoPlace { x: at.x, y: at.y, width: size, opacity: size / 2.0, paint };
                SketchCommand::SetPhoto(Box::new(photo))
            })
        }),
        1 => Just(SketchCommand::Clear),
        1 => (ids(), proptest::option::of(-1.0..9.0f64)).prop_map(|(ids, w)| SketchCommand::SetWidth(ids, w)),
        1 => (ids(), material()).prop_map(|(ids, m)| SketchCommand::SetMaterial(ids, m)),
        3 => layer_command(),
        1 => (-1.0..12.0f64).prop_map(|density| {
            let mut spec = SketchSpec::default();
            spec.fill.density = density;
            SketchCommand::SetSketch(Box::new(spec))
        }),
        1 => (0.0..9.0f64).prop_map(|detail| SketchCommand::SetSkin(SkinSpec { detail, ..SkinSpec::default() })),
        1 => proptest::option::of(-1.0..110.0f64).prop_map(SketchCommand::SetDay),
        1 => proptest::option::of(0..PLANTS).prop_map(|p| SketchCommand::SetLeaf(p.map(PlantId))),
    ]
}

fn obstacle() -> impl Strategy<Value = NamedObstacle> {
    (".{0,4}", point()).prop_map(|(name, at)| {
        let shape = Obstacle::Sphere { centre: DVec3::new(at.x, 1.0, at.y), radius_m: 0.5 };
        NamedObstacle { name, shape: Arc::new(shape) }
    })
}

fn tree_command() -> impl Strategy<Value = TreeCommand> {
    let spec = (0..9u32).prop_map(|age| Arc::new(TreeSpec { age: Some(age), ..TreeSpec::default() }));
    let path = prop_oneof![
        Just("/clearance_m"),
        Just("/wood/thin_out"),
        Just("/method/kill_m"),
        Just("/no/such"),
        Just("age"),
        Just("")
    ];
    prop_oneof![
        spec.prop_map(|s| TreeCommand::SetSpec(Some("oak".into()), s)),
        (path, -1e3..1e3f64).prop_map(|(p, x)| TreeCommand::SetField(p.into(), serde_json::json!(x))),
        obstacle().prop_map(TreeCommand::AddObstacle),
        (0..4usize, obstacle()).prop_map(|(row, o)| TreeCommand::SetObstacle(row, o)),
        (0..4usize).prop_map(TreeCommand::RemoveObstacle),
        (0.0..9.0f64).prop_map(|detail| TreeCommand::SetSkin(SkinSpec { detail, ..SkinSpec::default() })),
        proptest::option::of(0..PLANTS).prop_map(|p| TreeCommand::SetLeaf(p.map(PlantId))),
    ]
}

fn leaf_command() -> impl Strategy<Value = LeafCommand> {
    prop_oneof![
        (".{0,300}", ".{0,30}")
            .prop_map(|(name, text)| LeafCommand::SetData(LeafData { name, text: text.into() })),
        (-2.0..2.0f64, 0..70u32).prop_map(|(curl, sides)| {
            LeafCommand::Set(Box::new(leaf::LeafSpec { curl, sides, ..leaf::LeafSpec::default() }))
        }),
    ]
}

fn flower_command() -> impl Strategy<Value = FlowerCommand> {
    let species = prop_oneof![Just("lily"), Just("rose")];
    let field = prop_oneof![Just("/stalk_m"), Just("/whorls/0/length_m"), Just("/whorls/9/length_m")];
    prop_oneof![
        species.prop_map(|name: &str| {
            FlowerCommand::SetSpec(Some(name.into()), Arc::new(bloom::preset(name).expect("known")))
        }),
        (field, -1.0..6.0f64)
            .prop_map(|(field, x): (&str, f64)| FlowerCommand::SetField(field.into(), x.into())),
        (-1.0..110.0f64).prop_map(FlowerCommand::SetDay),
        (-1.0..6.0f64).prop_map(|span| {
            FlowerCommand::SetLaw(Some(Arc::new(bloom::GrowthLaw::logistic("a", span, 0.9))))
        }),
    ]
}

fn plant_command() -> impl Strategy<Value = PlantCommand> {
    prop_oneof![
        (0..3usize, material()).prop_map(|(w, m)| PlantCommand::Wear(Wearer::ALL[w], m)),
        Just(PlantCommand::AddPicture(picture())),
        ".{0,300}".prop_map(PlantCommand::Rename),
        any::<u64>().prop_map(|n| PlantCommand::SetSeed(Seed::new(n))),
        any::<bool>().prop_map(PlantCommand::Lock),
        any::<bool>().prop_map(PlantCommand::Hide),
        ".{0,300}".prop_map(PlantCommand::Group),
        (point(), -1e3..1e3f64, -1.0..3.0f64).prop_map(|(at, yaw_deg, scale)| {
            PlantCommand::Place(Placement { position: DVec3::new(at.x, 0.0, at.y), yaw_deg, scale })
        }),
    ]
}

fn hand_edit() -> BoxedStrategy<HandEdit> {
    let axis = || {
        prop_oneof![
            vec(0..4u32, 0..4).prop_map(AxisKey::Path),
            point().prop_map(|p| AxisKey::Near(p.extend(0.5))),
        ]
    };
    let points = || vec(point().prop_map(|p| p.extend(1.0)), 0..5);
    let (number, seed) = (-1.0..5.0f64, any::<u64>());
    prop_oneof![
        (axis(), point(), -400.0..400.0f64).prop_map(|(axis, about, degrees)| {
            HandEdit::Rotate { axis, turn: Turn { about: about.extend(1.0), degrees } }
        }),
        (axis(), number.clone()).prop_map(|(axis, by)| HandEdit::Move {
            axis,
            to: Destination::SlideM(by),
            turn: None
        }),
        (axis(), axis(), number.clone()).prop_map(|(axis, on, at)| {
            HandEdit::Move { axis, to: Destination::Place { axis: on, at }, turn: None }
        }),
        (axis(), number.clone()).prop_map(|(axis, at)| HandEdit::Prune { axis, at }),
        (axis(), seed).prop_map(|(axis, seed)| HandEdit::Regrow { axis, seed }),
        (axis(), points(), number.clone()).prop_map(|(bearer, points, twigs)| {
            HandEdit::SketchBranch { bearer, at: None, points, twigs, seed: 1, mirror: None }
        }),
        (points(), vec(number.clone(), 0..3), number.clone()).prop_map(|(points, radius_m, density)| {
            HandEdit::Brush { bearer: None, points, radius_m, density, seed: 2, mirror: None }
        }),
        (vec(point(), 0..5), number.clone(), seed).prop_map(|(outline, density, seed)| {
            HandEdit::Silhouette {
                plane: ViewPlane::default(),
                outline,
                density,
                trim: true,
                seed,
                mirror: None,
            }
        }),
        (points(), number).prop_map(|(points, keep)| {
            HandEdit::LeafDensity { region: LeafRegion::Stroke { points, radius_m: 0.5 }, keep, seed: 3 }
        }),
    ]
    .boxed()
}

fn shape_command() -> BoxedStrategy<ShapeCommand> {
    let edit = || hand_edit().prop_map(Arc::new);
    prop_oneof![
        4 => edit().prop_map(ShapeCommand::Add),
        1 => (0..4usize, edit()).prop_map(|(row, e)| ShapeCommand::Replace(row, e)),
        1 => (0..4usize, any::<bool>()).prop_map(|(row, off)| ShapeCommand::Leave(row, off)),
        1 => vec(0..4usize, 0..3).prop_map(ShapeCommand::Remove),
    ]
    .boxed()
}

fn new_plant() -> impl Strategy<Value = NewPlant> {
    let maker = prop_oneof![
        Just(Maker::default()),
        Just(Maker::Tree(Box::default())),
        Just(Maker::Leaf(Box::default())),
        Just(Maker::Flower(Box::default())),
    ];
    (maker, vec(stroke(), 0..3)).prop_map(|(maker, strokes)| NewPlant {
        settings: Settings { maker, ..Settings::default() },
        strokes,
    })
}

fn scene_command() -> impl Strategy<Value = SceneCommand> {
    let plant = || (0..PLANTS).prop_map(PlantId);
    prop_oneof![
        1 => ".{0,300}".prop_map(SceneCommand::Rename),
        3 => new_plant().prop_map(|p| SceneCommand::Add(Box::new(p))),
        1 => (plant(), point()).prop_map(|(id, by)| SceneCommand::Duplicate(id, by.extend(0.0))),
        1 => (vec(plant(), 0..3), point())
            .prop_map(|(ids, by)| SceneCommand::DuplicateAll(ids, by.extend(0.0))),
        1 => (vec(plant(), 0..3), point(), -400.0..400.0f64, -1.0..3.0f64).prop_map(
            |(ids, by, turn_deg, scale)| {
                let carry = Carry { about: DVec3::X, by: by.extend(0.0), turn_deg, scale };
                SceneCommand::Carry(ids, carry)
            }
        ),
        2 => vec(plant(), 0..3).prop_map(SceneCommand::Remove),
        1 => vec(vec(point(), 0..5), 0..4).prop_map(|lines| {
            SceneCommand::Open(Box::new(Document::from_drawing(&Drawing::from_polylines("other", &lines))))
        }),
    ]
}

fn command() -> BoxedStrategy<Command> {
    let plant = || (0..PLANTS).prop_map(PlantId);
    prop_oneof![
        6 => sketch_command().prop_map(|c| c.for_plant(PlantId(0))),
        1 => (plant(), sketch_command()).prop_map(|(p, c)| c.for_plant(p)),
        2 => (plant(), tree_command()).prop_map(|(p, c)| c.for_plant(p)),
        1 => (plant(), leaf_command()).prop_map(|(p, c)| c.for_plant(p)),
        1 => (plant(), flower_command()).prop_map(|(p, c)| c.for_plant(p)),
        2 => (plant(), plant_command()).prop_map(|(p, c)| c.for_plant(p)),
        3 => (plant(), shape_command()).prop_map(|(p, c)| c.for_plant(p)),
        4 => scene_command().prop_map(Command::from),
    ]
    .boxed()
}

#[derive(Clone, Debug)]
enum Act {
    Run(Box<Command>),
    Gesture(Vec<Command>, bool),
    Undo,
    Redo,
}

fn act() -> impl Strategy<Value = Act> {
    prop_oneof![
        6 => command().prop_map(|c| Act::Run(Box::new(c))),
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
                    if editor.run(*command).is_ok() {
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
    fn a_saved_document_comes_back_with_the_same_bits(commands in vec(command(), 0..16)) {
        let mut editor = Editor::default();
        for command in commands { let _ = editor.run(command); }
        let document = editor.document();
        let back = read_project(&write_project(document, "test").unwrap()).unwrap();
        prop_assert_eq!((back.name(), back.plants().len()), (document.name(), document.plants().len()));
        for (new, old) in back.plants().iter().zip(document.plants()) {
            // Plants are renumbered: a reference to a leaf keeps its row.
            let row = |d: &Document, id: Option<PlantId>| id.map(|id| d.plants().iter().position(|p| p.id() == id));
            let (lent, was) = (new.settings().maker.leaf(), old.settings().maker.leaf());
            prop_assert_eq!(row(&back, lent), row(document, was));
            if lent == was {
                prop_assert_eq!(new.settings(), old.settings());
            }
            prop_assert_eq!(new.classes(), old.classes());
            prop_assert_eq!(new.strokes().len(), old.strokes().len());
            for (a, b) in new.strokes().iter().zip(old.strokes()) {
                prop_assert_eq!(&a.stroke, &b.stroke);
                for (p, q) in a.stroke.samples.iter().zip(&b.stroke.samples) {
                    prop_assert_eq!(p.at.x.to_bits(), q.at.x.to_bits());
                    prop_assert_eq!(p.at.y.to_bits(), q.at.y.to_bits());
                }
            }
        }
        prop_assert_eq!(back.validate().collect::<Vec<_>>(), vec![]);
    }
}

/// Plants that are carried together turn about one point; a locked one keeps all in place.
#[test]
fn plants_are_carried_as_one_thing() {
    let mut editor = Editor::default();
    editor.run(SceneCommand::Duplicate(PlantId(0), DVec3::new(2.0, 0.0, 0.0))).unwrap();
    let both = vec![PlantId(0), PlantId(1)];
    let carry = Carry { about: DVec3::X, by: DVec3::new(0.0, 0.0, 5.0), turn_deg: 90.0, scale: 2.0 };
    editor.run(SceneCommand::Carry(both.clone(), carry)).unwrap();
    // A quarter turn counter-clockwise, seen from above, takes +x to -z.
    let places = |e: &Editor| -> Vec<Placement> {
        e.document().plants().iter().map(|p| p.settings().placement).collect()
    };
    let at = |z: f64| Placement { position: DVec3::new(1.0, 0.0, z), yaw_deg: 90.0, scale: 2.0 };
    assert_eq!(places(&editor), [at(7.0), at(3.0)]);
    let before = places(&editor);
    let back = Carry { about: DVec3::new(1.0, 0.0, 5.0), by: -carry.by, turn_deg: -90.0, scale: 0.5 };
    editor.run(SceneCommand::Carry(both.clone(), back)).unwrap();
    assert_eq!(places(&editor)[1].position, DVec3::new(2.0, 0.0, 0.0));
    editor.undo();
    assert_eq!(places(&editor), before);
    editor.run(PlantCommand::Fix(true).for_plant(PlantId(1))).unwrap();
    assert_eq!(editor.run(SceneCommand::Carry(both, back)), Err(CommandError::Fixed));
    assert_eq!(places(&editor), before);
}

#[test]
fn copies_of_a_group_are_a_group_of_their_own() {
    let mut editor = Editor::default();
    editor.run(SceneCommand::Duplicate(PlantId(0), DVec3::X)).unwrap();
    for id in [0, 1] {
        editor.run(PlantCommand::Group("bed 2".into()).for_plant(PlantId(id))).unwrap();
    }
    editor.run(SceneCommand::DuplicateAll(vec![PlantId(0), PlantId(1)], DVec3::Z)).unwrap();
    let groups = |e: &Editor| -> Vec<String> {
        e.document().plants().iter().map(|p| p.settings().group.clone()).collect()
    };
    assert_eq!(groups(&editor), ["bed 2", "bed 2", "bed 3", "bed 3"]);
    assert_eq!(editor.document().plants()[3].settings().placement.position, DVec3::new(1.0, 0.0, 1.0));
    assert_eq!(editor.undo(), Some("duplicate-plant"));
    assert_eq!(editor.document().plants().len(), 2, "one step");
}

fn strokes(editor: &Editor) -> &[document::DocumentStroke] {
    editor.document().plants()[0].strokes()
}

#[test]
fn a_hundred_steps_are_undone_by_name() {
    let mut editor = Editor::default();
    for k in 0..100 {
        let line = NewStroke::line(&[DVec2::ZERO, DVec2::new(f64::from(k), 1.0)]);
        editor.run(SketchCommand::AddStrokes(vec![line]).for_plant(PlantId(0))).unwrap();
    }
    editor.run(SketchCommand::Clear.for_plant(PlantId(0))).unwrap();
    assert_eq!(strokes(&editor).len(), 0);
    assert_eq!(editor.undo(), Some("clear"));
    for left in (0..100).rev() {
        assert_eq!(editor.undo(), Some("draw"));
        assert_eq!(strokes(&editor).len(), left);
    }
    assert_eq!(editor.undo(), None);
}

#[test]
fn a_drag_is_one_step_and_a_drag_back_is_none() {
    let mut editor = Editor::default();
    editor
        .run(SketchCommand::AddStrokes(vec![NewStroke::line(&[DVec2::ZERO, DVec2::Y])]).for_plant(PlantId(0)))
        .unwrap();
    let id = strokes(&editor)[0].id;
    editor.begin_gesture("move").unwrap();
    for k in 1..=5 {
        editor
            .stage(SketchCommand::MoveStrokes(vec![id], DVec2::X * f64::from(k)).for_plant(PlantId(0)))
            .unwrap();
    }
    assert!(editor.commit());
    assert_eq!(strokes(&editor)[0].stroke.samples[0].at, DVec2::X * 5.0);
    assert_eq!(editor.done().len(), 2);
    editor.begin_gesture("move").unwrap();
    editor.stage(SketchCommand::MoveStrokes(vec![id], DVec2::X).for_plant(PlantId(0))).unwrap();
    editor.stage(SketchCommand::MoveStrokes(vec![id], DVec2::ZERO).for_plant(PlantId(0))).unwrap();
    assert!(!editor.commit());
    assert_eq!(strokes(&editor)[0].stroke.samples[0].at, DVec2::X * 5.0);
}

#[test]
fn what_is_cut_rubbed_and_joined_keeps_its_place_and_its_class() {
    let mut editor = Editor::default();
    let level = |y: f64| NewStroke::line(&[DVec2::new(0.0, y), DVec2::new(100.0, y)]);
    let three = SketchCommand::AddStrokes(vec![level(0.0), level(50.0), level(100.0)]);
    editor.run(three.for_plant(PlantId(0))).unwrap();
    editor
        .run(SketchCommand::SetClass(vec![StrokeId(1)], Some(StrokeClass::Vein)).for_plant(PlantId(0)))
        .unwrap();
    let before = editor.document().clone();
    let shown = |e: &Editor| -> Vec<(u32, f64, f64, bool)> {
        let ends = |s: &document::DocumentStroke| {
            let samples = &s.stroke.samples;
            (s.id.0, samples[0].at.x, samples[samples.len() - 1].at.x, s.class == Some(StrokeClass::Vein))
        };
        strokes(e).iter().map(ends).collect()
    };
    editor
        .run(SketchCommand::CutStrokes(vec![StrokeId(1)], DVec2::new(30.0, 52.0)).for_plant(PlantId(0)))
        .unwrap();
    let cut = [(0, 0.0, 100.0, false), (1, 0.0, 30.0, true), (3, 30.0, 100.0, true), (2, 0.0, 100.0, false)];
    assert_eq!(shown(&editor), cut);
    editor.run(SketchCommand::JoinStrokes(vec![StrokeId(3), StrokeId(1)]).for_plant(PlantId(0))).unwrap();
    assert_eq!(shown(&editor), [(0, 0.0, 100.0, false), (1, 0.0, 100.0, true), (2, 0.0, 100.0, false)]);
    // The eraser crosses two of them, and removes the third.
    let path = vec![DVec2::new(40.0, -5.0), DVec2::new(40.0, 60.0)];
    editor.run(SketchCommand::RubOut(path, 4.0).for_plant(PlantId(0))).unwrap();
    let numbers: Vec<u32> = shown(&editor).iter().map(|s| s.0).collect();
    assert_eq!(numbers, [0, 4, 1, 5, 2]);
    let all = vec![DVec2::new(-9.0, 100.0), DVec2::new(109.0, 100.0)];
    editor.run(SketchCommand::RubOut(all, 4.0).for_plant(PlantId(0))).unwrap();
    assert_eq!(strokes(&editor).len(), 4);
    for _ in 0..4 {
        editor.undo();
    }
    assert_eq!(*editor.document(), before);
    let none = editor.run(SketchCommand::RubOut(vec![DVec2::splat(-900.0)], 4.0).for_plant(PlantId(0)));
    assert!(matches!(none, Err(CommandError::Nothing(_))));
    let one = editor.run(SketchCommand::JoinStrokes(vec![StrokeId(0)]).for_plant(PlantId(0)));
    assert!(matches!(one, Err(CommandError::Nothing(_))));
}

#[test]
fn refusals_say_why() {
    let mut editor = Editor::default();
    let refused = |e: &mut Editor, c: SketchCommand| e.run(c.for_plant(PlantId(0))).unwrap_err().to_string();
    assert!(refused(&mut editor, SketchCommand::RemoveStrokes(vec![StrokeId(7)])).contains("no stroke 7"));
    assert!(
        refused(&mut editor, SketchCommand::SetSkin(SkinSpec { detail: 99.0, ..SkinSpec::default() }))
            .contains("0.1 to 8")
    );
    let far = NewStroke::line(&[DVec2::splat(f64::MAX), DVec2::ZERO]);
    editor.run(SketchCommand::AddStrokes(vec![far]).for_plant(PlantId(0))).unwrap();
    let too_far = editor
        .run(SketchCommand::MoveStrokes(vec![StrokeId(0)], DVec2::splat(f64::MAX)).for_plant(PlantId(0)));
    assert_eq!(too_far, Err(CommandError::TooFar));
}

#[test]
fn edits_by_hand_are_steps_with_names_and_are_checked_at_the_door() {
    let (mut editor, id) = (Editor::default(), PlantId(0));
    let cut = |at| Arc::new(HandEdit::Prune { axis: AxisKey::Path(vec![0, 1]), at });
    editor.run(ShapeCommand::Add(cut(0.0)).for_plant(id)).unwrap();
    editor.run(ShapeCommand::Add(cut(0.5)).for_plant(id)).unwrap();
    editor.run(ShapeCommand::Leave(0, true).for_plant(id)).unwrap();
    editor.run(ShapeCommand::Replace(1, cut(0.25)).for_plant(id)).unwrap();
    for bad in [f64::NAN, -0.1, 1.1, f64::INFINITY] {
        let refused = editor.run(ShapeCommand::Add(cut(bad)).for_plant(id)).unwrap_err().to_string();
        assert_eq!(refused, "edit 2 by hand: at is not a number that can be used");
    }
    let long = HandEdit::Brush {
        bearer: None,
        points: vec![DVec3::ZERO; 20_001],
        radius_m: vec![1.0],
        density: 1.0,
        seed: 1,
        mirror: None,
    };
    assert!(editor.run(ShapeCommand::Add(Arc::new(long)).for_plant(id)).is_err());
    editor.run(ShapeCommand::Remove(vec![0]).for_plant(id)).unwrap();
    let edits = |e: &Editor| e.document().plants()[0].settings().edits.clone();
    assert_eq!((edits(&editor).len(), &edits(&editor)[0].edit), (1, &cut(0.25)));
    assert!(editor.run(ShapeCommand::Remove(vec![1]).for_plant(id)).is_err());
    for name in ["shape-remove", "shape-change", "shape-leave", "prune", "prune"] {
        assert_eq!(editor.undo(), Some(name));
    }
    assert!(edits(&editor).is_empty());
    // Makers without branches take no edits.
    for maker in [Maker::Leaf(Box::default()), Maker::Flower(Box::default())] {
        let settings = Settings { maker, ..Settings::default() };
        editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes: vec![] }))).unwrap();
    }
    let refused = editor.run(ShapeCommand::Add(cut(0.0)).for_plant(PlantId(1)));
    assert_eq!(refused, Err(CommandError::OtherMaker { wanted: "plant with branches", found: "leaf" }));
    editor.run(ShapeCommand::Add(cut(0.0)).for_plant(PlantId(2))).unwrap();
}

#[test]
fn a_leaf_that_is_lent_goes_with_its_plant_and_comes_back() {
    let mut editor = Editor::default();
    for maker in [Maker::Leaf(Box::default()), Maker::Tree(Box::default())] {
        let settings = Settings { maker, ..Settings::default() };
        editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes: vec![] }))).unwrap();
    }
    let (sketch, leaf, tree) = (PlantId(0), PlantId(1), PlantId(2));
    editor.run(TreeCommand::SetLeaf(Some(leaf)).for_plant(tree)).unwrap();
    assert_eq!(editor.run(TreeCommand::SetLeaf(Some(tree)).for_plant(tree)), Err(CommandError::NoLeaf));
    editor.run(SketchCommand::SetLeaf(Some(leaf)).for_plant(sketch)).unwrap();
    let own = editor.run(TreeCommand::SetLeaf(Some(sketch)).for_plant(tree));
    assert_eq!(own, Err(CommandError::NoLeaf), "its leaf is borrowed itself");
    let before = editor.document().clone();
    editor.run(SceneCommand::Remove(vec![leaf])).unwrap();
    assert_eq!(editor.document().plant(tree).unwrap().settings().maker.leaf(), None);
    editor.undo();
    assert_eq!(*editor.document(), before);
    let other = editor.run(FlowerCommand::SetLaw(None).for_plant(tree)).unwrap_err();
    assert!(other.to_string().contains("is a tree, not a flower"), "{other}");
}
