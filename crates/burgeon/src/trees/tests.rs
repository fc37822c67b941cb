//! Trees end to end.

use super::*;
use base::{CancelToken, Executor};
use glam::{DVec2, DVec3};

#[path = "../../../base/tests/share/mod.rs"]
mod share;

fn plain(spec: &TreeSpec) -> MadeTree {
    make_tree(spec, Seed::new(1), &TreeOptions::default(), &Run::plain()).expect("sound spec")
}

fn young(key: &str) -> TreeSpec {
    let spec = Preset::find(key).expect("a preset").spec().expect("sound");
    // A few rounds are enough for these tests, and quick.
    let age = match &spec.method {
        Method::SelfOrganizing(_) => Some(9),
        _ => spec.age,
    };
    TreeSpec { age, ..spec }
}

#[test]
fn every_preset_is_sound_and_has_its_words() {
    let mut names = std::collections::BTreeSet::new();
    for preset in PRESETS {
        let spec = preset.spec().expect(preset.key);
        assert!(!spec.about.is_empty() && !spec.species.is_empty(), "{}", preset.key);
        assert!(names.insert(spec.name.clone()), "{} twice", spec.name);
        assert_eq!(spec::check(&spec), Ok(()));
    }
    assert!(PRESETS.len() >= 12);
}

#[test]
fn presets_of_table_1_have_its_numbers() {
    for (key, points, attraction, kill, cycles) in
        [("pine", 2870, 0.9, 0.5, 2), ("terminalia", 525, 0.8, 0.8, 3), ("chinese-fir", 1543, 1.0, 0.4, 3)]
    {
        let spec = Preset::find(key).expect("a preset").spec().expect("sound");
        let Method::Competition(c) = spec.method else { panic!("{key}") };
        assert_eq!((c.points, c.attraction_m, c.kill_m, c.lifespan), (points, attraction, kill, cycles));
    }
}

#[test]
fn a_tree_has_its_model_its_report_and_its_colours() {
    let made = plain(&young("alder"));
    let growth = made.item.growth.as_ref().expect("the report's block");
    assert_eq!(growth.method, "self-organizing");
    assert_eq!(Some(growth.leaves_kept), made.item.counts.leaves);
    assert_eq!(growth.nodes, made.grown.skeleton.len() as u64);
    assert_eq!(made.model.validate().next(), None);
    assert_eq!(made.grown.plant.validate().next(), None);
    assert!(made.item.counts.triangles > 1000 && growth.leaves_kept > 50, "{:?}", made.item);
    let again = plain(&young("alder"));
    assert_eq!(made.item.digest, again.item.digest);
    let leaf = made.grown.plant.organs.first().expect("a leaf").paint.rgb();
    assert!(leaf[1] > leaf[0] && leaf[1] > leaf[2], "green: {leaf:?}");
    let bark = made.model.materials.iter().find(|m| m.name.starts_with("bark")).expect("bark");
    let t = bark.texture.as_ref().expect("painted");
    let mean = t.pixels.chunks_exact(4).map(|p| u64::from(p[0])).sum::<u64>() / (t.pixels.len() as u64 / 4);
    assert!((60..130).contains(&mean), "an alder's bark is dark: {mean}");
}

/// Returns the keys of its leaves, and the share of them that are more red than green.
fn leaves_in(spec: &TreeSpec, season: f64) -> (std::collections::BTreeSet<u64>, f64) {
    let mut spec = spec.clone();
    spec.look.season = season;
    let made = plain(&spec);
    assert_eq!(made.grown.plant.validate().next(), None);
    let leaves = || made.grown.plant.organs.iter().filter(|o| o.kind == plant::OrganKind::Leaf);
    let red = leaves().filter(|o| o.paint.rgb()[0] > o.paint.rgb()[1]).count();
    let growth = made.item.growth.expect("the report's block");
    assert_eq!(growth.leaves_kept, leaves().count() as u64);
    (leaves().map(|o| o.key).collect(), red as f64 / leaves().count().max(1) as f64)
}

#[test]
fn leaves_turn_and_fall_one_by_one_and_evergreens_keep_theirs() {
    for key in ["hazel", "beech"] {
        let spec = young(key);
        let (all, red) = leaves_in(&spec, 0.0);
        assert!(red < 0.05, "{key} is green in summer: {red}");
        let (mut last, mut turned) = (all.clone(), red);
        for season in [0.1, 0.2, 0.3, 0.4, 0.5] {
            let (leaves, red) = leaves_in(&spec, season);
            assert!(leaves == all && red >= turned, "{key} at {season}: {red} after {turned}");
            turned = red;
        }
        assert!(turned > 0.99, "{key}: {turned}");
        for season in [0.6, 0.75, 0.9] {
            let (leaves, _) = leaves_in(&spec, season);
            assert!(leaves.is_subset(&last) && !leaves.is_empty() && leaves.len() < last.len(), "{key}");
            last = leaves;
        }
        assert!(leaves_in(&spec, 1.0).0.is_empty(), "{key} is bare in winter");
    }
    let mut spruce = young("spruce");
    let summer = plain(&spruce).item.digest;
    spruce.look.season = 0.9;
    assert_eq!(plain(&spruce).item.digest, summer);
    // Plants that flower in spring do not in autumn.
    let mut rose = young("rose");
    rose.look.season = 0.4;
    let counts = plain(&rose).item.counts;
    assert!(counts.flowers == Some(0) && counts.leaves > Some(100), "{counts:?}");
}

#[test]
fn leaves_unfold_one_by_one_lighter_than_in_summer() {
    let size = |spec: &TreeSpec, season: f64| {
        let mut spec = spec.clone();
        spec.look.season = season;
        let made = plain(&spec);
        let leaves = || made.grown.plant.organs.iter().filter(|o| o.kind == plant::OrganKind::Leaf);
        let light: f64 = leaves().map(|o| f64::from(o.paint.rgb().iter().sum::<f32>())).sum();
        (leaves().map(|o| o.scale * o.scale).sum::<f64>(), light / leaves().count().max(1) as f64)
    };
    for key in ["birch", "beech"] {
        let spec = young(key);
        let (all, _) = leaves_in(&spec, 0.0);
        assert!(leaves_in(&spec, -1.0).0.is_empty(), "{key} is bare before spring");
        let (mut last, mut area) = (std::collections::BTreeSet::new(), 0.0);
        for season in [-0.85, -0.7, -0.5, -0.35] {
            let (leaves, _) = leaves_in(&spec, season);
            assert!(
                last.is_subset(&leaves) && leaves.is_subset(&all) && !leaves.is_empty(),
                "{key} at {season}"
            );
            let (now, light) = size(&spec, season);
            assert!(now > area && light > 1.05 * size(&spec, 0.0).1, "{key} at {season}: {now} after {area}");
            (last, area) = (leaves, now);
        }
        // Just before summer its size is that in summer, within a part in a million.
        let ((before, _), (summer, _)) = (size(&spec, -1e-7), size(&spec, 0.0));
        assert!(leaves_in(&spec, -1e-7).0 == all && (before / summer - 1.0).abs() < 1e-6, "{key}");
    }
    // A birch's leaves appear successively, a beech's together.
    let share = |key: &str| {
        let spec = young(key);
        leaves_in(&spec, -0.8).0.len() as f64 / leaves_in(&spec, 0.0).0.len() as f64
    };
    let (beech, birch) = (share("beech"), share("birch"));
    assert!(beech > birch + 0.2, "{beech}, {birch}");
    // Flowers come before leaves.
    let flowers = |season: f64| {
        let mut cherry = young("cherry");
        cherry.look.season = season;
        plain(&cherry).item.counts.flowers
    };
    let counts = [-1.0, -0.85, 0.0].map(flowers);
    assert!(counts[0] == Some(0) && counts[1] > Some(100) && counts[1] == counts[2], "{counts:?}");
}

#[test]
fn a_beech_turns_from_its_outside_and_a_birch_from_its_inside() {
    // Returns the mean distance from the trunk of the remaining leaves, over that of all.
    let out = |key: &str, season: f64| {
        let mut spec = young(key);
        spec.look.season = season;
        let made = plain(&spec);
        let leaves = made.grown.plant.organs.iter().filter(|o| o.kind == plant::OrganKind::Leaf);
        let away: Vec<f64> =
            leaves.map(|o| DVec2::new(o.frame.origin.x, o.frame.origin.z).length()).collect();
        away.iter().sum::<f64>() / away.len() as f64
    };
    let change = |key| out(key, 0.75) / out(key, 0.0);
    let (beech, birch) = (change("beech"), change("birch"));
    assert!(beech < 0.98 && birch > 1.02, "{beech}, {birch}");
}

#[test]
fn a_season_grows_nothing_again() {
    let (mut spec, options) = (young("hazel"), TreeOptions::default());
    let mut evaluator = TreeEvaluator::default();
    evaluator.update(&spec, Seed::new(1), &options, &Run::plain()).expect("sound");
    spec.look.season = 0.7;
    let item = evaluator.update(&spec, Seed::new(1), &options, &Run::plain()).expect("sound");
    assert_eq!(evaluator.stages_done(), ["mesh"]);
    assert_eq!(item, plain(&spec).item);
}

#[test]
fn levels_of_detail_become_coarser_and_stay_sound() {
    let spec = young("hazel");
    let options =
        TreeOptions { levels: LevelSpec { lods: 3, ..LevelSpec::default() }, ..TreeOptions::default() };
    let made = make_tree(&spec, Seed::new(1), &options, &Run::plain()).expect("sound");
    let mut last = made.model.triangle_count();
    assert_eq!(made.levels.lods.len(), 3);
    for (level, lod) in (1..).zip(&made.levels.lods) {
        assert_eq!(lod.validate().next(), None);
        let n = lod.triangle_count();
        assert!(n < last * 7 / 10 && n > 100, "level {level}: {n} after {last}");
        last = n;
        let (plant, _) = skin::coarser(&made.grown.plant, &options.skin, level);
        assert_eq!(plant.validate().next(), None);
        let keys =
            |p: &plant::Plant| p.organs.iter().map(|o| o.key).collect::<std::collections::BTreeSet<_>>();
        assert!(keys(&plant).is_subset(&keys(&made.grown.plant)));
    }
}

/// Lengths of leaves, or of a pine's needles, in cm, as floras state them for leaves of normal shoots. B: Bean, Trees
/// and Shrubs Hardy in the British Isles. S: Stace, New Flora of the British Isles. F: Flora of China. The blade
/// without its stalk; for compound leaves the whole leaf.
const LEAVES_CM: [(&str, f64, f64); 23] = [
    ("oak", 6.0, 14.0), // B, S: Quercus robur
    ("oak-colonization", 6.0, 14.0),
    ("oak-lsystem", 6.0, 14.0),
    ("lime", 3.0, 9.0),         // S: Tilia cordata
    ("beech", 4.0, 10.0),       // S: Fagus sylvatica
    ("birch", 3.0, 7.0),        // S: Betula pendula
    ("alder", 3.0, 10.5),       // S: Alnus glutinosa
    ("hazel", 5.0, 12.0),       // S: Corylus avellana
    ("maple", 7.0, 18.0),       // B: Acer platanoides
    ("poplar", 5.0, 10.0),      // S: Populus nigra
    ("willow", 8.0, 17.0),      // B, F: Salix babylonica
    ("cherry", 5.0, 15.0),      // B: Prunus serrulata
    ("bamboo", 10.0, 30.0),     // F: Bambusa vulgaris
    ("terminalia", 3.0, 8.0),   // Terminalia mantaly
    ("ash", 18.0, 35.0),        // S: Fraxinus excelsior
    ("elm", 7.0, 16.0),         // the preset says where
    ("plane-tree", 13.0, 23.0), // the preset
    ("olive", 4.0, 10.0),       // the preset
    ("apple", 4.0, 10.0),       // F: Malus pumila
    ("ginkgo", 4.0, 8.0),       // the preset, and so on
    ("eucalyptus", 10.0, 30.0),
    ("magnolia-tree", 7.5, 20.0),
    ("plum", 3.8, 6.5),
];

#[test]
fn leaves_as_made_have_the_size_of_their_species() {
    for (key, least, most) in LEAVES_CM {
        let made = plain(&young(key));
        let lengths: Vec<f64> = (made.grown.plant.organs.iter())
            .filter(|o| o.kind == plant::OrganKind::Leaf)
            .map(|o| match &made.grown.plant.shapes[o.shape.index()] {
                plant::Shape::Blade(blade) => 100.0 * o.scale * blade.length(),
                other => panic!("{key}: {other:?}"),
            })
            .collect();
        let within = lengths.iter().filter(|&&l| (least..=most).contains(&l)).count();
        let share = within as f64 / lengths.len() as f64;
        assert!(share > 0.95 && lengths.len() > 100, "{key}: {share} of {} leaves", lengths.len());
    }
    // Needles: a third of a brush. S: Pinus sylvestris 2 to 8 cm; B: Pinus pinea 10 to 20 cm, Cedrus libani 1.5 to 3.5
    // cm. F: Cunninghamia lanceolata 0.8 to 6.5 cm; the presets cite sources for the others.
    let needles = [
        ("pine", 2.0, 8.0),
        ("umbrella-pine", 8.0, 20.0),
        ("cedar", 1.5, 3.5),
        ("spruce", 1.2, 2.5),
        ("larch", 1.3, 4.0),
        ("juniper", 1.0, 1.5),
        ("yew", 1.0, 4.0),
        ("chinese-fir", 0.8, 6.5),
    ];
    for (key, least, most) in needles {
        let spec = young(key);
        if let Some(needle) = spec.blade.needle {
            let length = 100.0 * needle * spec.leaves.length_m;
            assert!((least..most).contains(&length), "{key}: needles of {length} cm");
            continue;
        }
        let blade = tree_blade(&spec.blade);
        let gap = |a: &DVec2, b: &DVec2| a.distance(*b);
        let needle = blade.outline.windows(2).map(|w| gap(&w[0], &w[1])).fold(0.0, f64::max);
        let length = 100.0 * needle * spec.leaves.length_m / blade.length();
        assert!((least..most).contains(&length), "{key}: needles of {length} cm");
    }
}

/// Returns the area of the organs in the crown, m2, and their triangles.
fn weight(model: &Model) -> (f64, usize) {
    let crown = model.parts.iter().filter(|p| ["leaves", "petals", "discs"].contains(&p.name.as_str()));
    let area = |m: &mesh::TriMesh| -> f64 {
        let at = |i: u32| DVec3::from(m.positions[i as usize].map(f64::from));
        m.triangles.iter().map(|&[a, b, c]| 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).length()).sum()
    };
    (crown.map(|p| area(&p.mesh)).sum(), model.triangle_count())
}

#[test]
fn every_species_gets_lighter_level_by_level_and_keeps_its_leaves() {
    for preset in share::sample(PRESETS, 3, 4) {
        let spec = young(preset.key);
        let options =
            TreeOptions { levels: LevelSpec { lods: 3, ..LevelSpec::default() }, ..TreeOptions::default() };
        let made = make_tree(&spec, Seed::new(3), &options, &Run::plain()).expect("sound");
        let (whole, mut last) = weight(&made.model);
        for (level, lod) in (1..).zip(&made.levels.lods) {
            let (area, n) = weight(lod);
            // Few fronds, blades of grass or limbs are not reduced: such a level is light already.
            let few = last < 8_000 && n <= last;
            assert!(n < last * 7 / 10 || few, "{}, level {level}: {n} triangles after {last}", preset.key);
            last = n;
            let kept = if whole > 0.0 { area / whole } else { 1.0 };
            assert!((0.75..1.3).contains(&kept), "{}, level {level}: {kept} of the leaf area", preset.key);
        }
    }
}

#[test]
fn a_tree_is_scaled_to_a_height() {
    let options = TreeOptions { height_m: Some(3.0), ..TreeOptions::default() };
    let made = make_tree(&young("oak-lsystem"), Seed::new(1), &options, &Run::plain()).expect("sound");
    assert!((tree_size(&made.grown).height_m - 3.0).abs() < 1e-9);
    assert_eq!(made.grown.plant.validate().next(), None);
}

#[test]
fn open_and_inverted_meshes_are_named() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].into_iter();
    let vertices: Vec<DVec3> = corners.map(|p| p + DVec3::new(2.0, 0.0, 2.0)).collect();
    let closed = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let warned = |triangles: Vec<[u32; 3]>| {
        let obstacles = vec![Obstacle::Mesh { vertices: vertices.clone(), triangles }];
        let spec = TreeSpec { obstacles, ..TreeSpec::default() };
        plain(&spec).item.warnings.join("; ")
    };
    assert_eq!(warned(closed.clone()), "");
    assert!(warned(closed[1..].to_vec()).contains("3 edges"));
    assert!(warned(closed.iter().map(|&[a, b, c]| [a, c, b]).collect()).contains("look inwards"));
}

#[test]
fn growth_stops_when_asked() {
    let token = CancelToken::new();
    token.cancel();
    let run = Run { cancel: &token, ..Run::plain() };
    for key in ["oak", "alder", "palm"] {
        let got = make_tree(&young(key), Seed::new(1), &TreeOptions::default(), &run);
        assert_eq!(got.map(|_| ()), Err(TreeError::Cancelled(Cancelled)), "{key}");
    }
}

#[test]
fn only_what_a_change_touches_is_made_again() {
    use shape::{AxisKey, HandEdit, Turn};
    let bush = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 200\nlifespan = 1\n";
    let mut spec = read_tree_spec(bush, &|_| None).expect("sound");
    let (mut options, run) = (TreeOptions::default(), Run::plain());
    options.skin.detail = 0.3;
    let mut kept = TreeEvaluator::default();
    // Returns the stages that an update recomputed, after checking that a fresh one gives the same.
    let mut step = |spec: &TreeSpec, seed: u64, options: &TreeOptions| {
        let item = kept.update(spec, Seed::new(seed), options, &run).expect("sound");
        let fresh = make_tree(spec, Seed::new(seed), options, &run).expect("sound");
        assert_eq!(
            (&item, kept.model(), kept.plant()),
            (&fresh.item, Some(&fresh.model), Some(&fresh.grown.plant))
        );
        (kept.stages_done().join(" "), item)
    };
    assert_eq!(step(&spec, 1, &options).0, "structure depth mesh");
    assert_eq!(step(&spec, 1, &options).0, "");
    options.skin.detail = 0.4;
    assert_eq!(step(&spec, 1, &options).0, "mesh");
    let turn = |degrees| HandEdit::Rotate {
        axis: AxisKey::Path(vec![0, 1]),
        turn: Turn { about: DVec3::Z, degrees },
    };
    options.edits.push(HandEdit::Prune { axis: AxisKey::Path(vec![0, 0]), at: 0.5 }.into());
    assert_eq!(step(&spec, 1, &options).0, "shape mesh");
    for degrees in [10.0, 20.0, 30.0] {
        options.edits.truncate(1);
        options.edits.push(turn(degrees).into());
        assert_eq!(step(&spec, 1, &options).0, "shape mesh");
    }
    options.edits.push(HandEdit::Prune { axis: AxisKey::Path(vec![0, 99]), at: 0.0 }.into());
    let (_, item) = step(&spec, 1, &options);
    assert_eq!(item.edits.iter().map(|e| e.done).collect::<Vec<_>>(), [true, true, false]);
    assert!(item.warnings.iter().any(|w| w.starts_with("edit 2 by hand (prune): not done")), "{item:?}");
    options.edits[0].off = true;
    let (_, item) = step(&spec, 1, &options);
    assert_eq!(item.edits.iter().map(|e| e.index).collect::<Vec<_>>(), [1, 2]);
    options.edits.remove(1);
    step(&spec, 1, &options);
    spec.look.bark = growth::Bark::Smooth;
    assert_eq!(step(&spec, 1, &options).0, "shape mesh");
    assert_eq!(step(&spec, 2, &options).0, "structure depth shape mesh");
    options.edits.clear();
    assert_eq!(step(&spec, 2, &options).0, "shape mesh");
}

/// Asks to stop when work is distributed for the n-th time.
#[derive(Debug)]
struct StopAt<'a>(std::sync::atomic::AtomicUsize, &'a CancelToken);

impl Executor for StopAt<'_> {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        if self.0.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) == 1 {
            self.1.cancel();
        }
        (0..n).for_each(job);
    }
}

#[test]
fn a_tree_that_was_left_half_edited_is_still_there() {
    use document::{Editor, Maker, NewPlant, SceneCommand, Settings, ShapeCommand};
    let bush = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 100\nlifespan = 1\n";
    let spec = read_tree_spec(bush, &|_| None).expect("sound");
    let maker = Maker::Tree(Box::new(crate::tree_settings(&spec, None)));
    let mut editor = Editor::default();
    let settings = Settings { maker, ..Settings::default() };
    editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes: vec![] }))).expect("sound");
    let tree = editor.document().plants()[1].id();
    let mut scene = crate::SceneEvaluator::default();
    scene.update(tree, editor.document(), &Run::plain()).expect("sound");
    let whole = scene.get(tree).expect("made").model.clone();
    let edit = shape::HandEdit::Prune { axis: shape::AxisKey::Path(vec![0, 0]), at: 0.0 };
    let mut stopped = 0;
    for n in 1..30 {
        editor.run(ShapeCommand::Add(edit.clone().into()).for_plant(tree)).expect("sound");
        let cancel = CancelToken::new();
        let executor = StopAt(n.into(), &cancel);
        let run = Run { cancel: &cancel, executor: &executor, ..Run::plain() };
        let done = scene.update(tree, editor.document(), &run);
        stopped += usize::from(done.is_err());
        assert!(scene.get(tree).is_some(), "gone after the {n}-th piece of work");
        editor.undo();
        scene.update(tree, editor.document(), &Run::plain()).expect("sound");
        assert_eq!(scene.get(tree).map(|p| p.model), Some(&whole), "after the {n}-th piece of work");
        if done.is_ok() {
            break;
        }
    }
    assert!(stopped > 0, "nothing was stopped");
}

#[test]
fn a_look_has_no_digest_and_what_follows_it_has() {
    use document::{Editor, Maker, NewPlant, SceneCommand, Settings, ShapeCommand};

    let mut editor = Editor::default();
    let line: Vec<DVec2> = (0..9).map(|i| DVec2::new(0.0, f64::from(i))).collect();
    let stem = document::NewStroke::line(&line);
    for (maker, strokes) in
        [(Maker::Tree(Box::default()), vec![]), (Maker::Sketch(Box::default()), vec![stem])]
    {
        let settings = Settings { maker, ..Settings::default() };
        editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes }))).expect("sound");
    }
    let edit = shape::HandEdit::Prune { axis: shape::AxisKey::Path(vec![0]), at: 0.5 };
    for plant in editor.document().plants()[1..].iter().map(document::DocumentPlant::id).collect::<Vec<_>>() {
        let mut scene = crate::SceneEvaluator::default();
        let mut digest = |editor: &Editor, previewing: bool| {
            scene.set_previewing(previewing);
            scene.update(plant, editor.document(), &Run::plain()).expect("sound");
            scene.get(plant).expect("made").report().digest
        };
        let whole = digest(&editor, false);
        editor.run(ShapeCommand::Add(edit.clone().into()).for_plant(plant)).expect("sound");
        assert_eq!(digest(&editor, true), "");
        let cut = digest(&editor, false);
        assert!(!cut.is_empty() && cut != whole, "of the same document as the look");
        editor.undo();
        assert_eq!(digest(&editor, true), "");
        assert_eq!(digest(&editor, false), whole);
    }
}

#[test]
fn copies_share_one_result_until_one_of_them_changes() {
    use document::{Editor, Maker, NewPlant, PlantCommand, SceneCommand, Settings};

    let mut editor = Editor::default();
    let line: Vec<DVec2> = (0..9).map(|i| DVec2::new(0.0, f64::from(i))).collect();
    let bush = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 100\nlifespan = 1\n";
    let spec = read_tree_spec(bush, &|_| None).expect("sound");
    let tree = Maker::Tree(Box::new(crate::tree_settings(&spec, None)));
    let flower = Maker::Flower(Box::default());
    for (maker, strokes) in [
        (tree, vec![]),
        (flower, vec![]),
        (Maker::Sketch(Box::default()), vec![document::NewStroke::line(&line)]),
    ] {
        let settings = Settings { maker, ..Settings::default() };
        editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes }))).expect("sound");
        let first = editor.document().plants().last().expect("added").id();
        editor.run(SceneCommand::Duplicate(first, DVec3::X)).expect("sound");
        let copy = editor.document().plants().last().expect("copied").id();
        let mut scene = crate::SceneEvaluator::default();
        let mut update = |id, editor: &Editor| {
            scene.update(id, editor.document(), &Run::plain()).expect("sound");
            let made = scene.get(id).expect("made");
            let bytes: usize = scene.kept().map(|(_, bytes)| bytes).sum();
            (made.model as *const Model, made.revision, made.report(), made.stages.len(), bytes)
        };
        let one = update(first, &editor);
        let two = update(copy, &editor);
        assert_eq!((one.0, one.1, one.4), (two.0, two.1, two.4), "one model, one number, the same memory");
        assert_eq!((one.2.digest, two.3), (two.2.digest, 0), "and nothing was made");
        editor.run(PlantCommand::SetSeed(Seed::new(77)).for_plant(copy)).expect("sound");
        let other = update(copy, &editor);
        let same = update(first, &editor);
        assert!(other.1 != one.1 && other.0 != one.0, "another plant by now");
        assert_eq!((same.1, same.3), (one.1, 0), "the first one is as it was");
        editor.undo();
        assert_eq!(update(copy, &editor).1, one.1, "and shared again");
    }
}

#[test]
fn the_name_of_a_tree_is_no_reason_to_grow_it() {
    use document::{Editor, Maker, NewPlant, PlantCommand, SceneCommand, Settings};

    let mut editor = Editor::default();
    let settings = Settings { maker: Maker::Tree(Box::default()), ..Settings::default() };
    editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes: vec![] }))).expect("sound");
    let tree = editor.document().plants()[1].id();
    let mut scene = crate::SceneEvaluator::default();
    scene.update(tree, editor.document(), &Run::plain()).expect("sound");
    editor.run(PlantCommand::Rename("an elder".into()).for_plant(tree)).expect("sound");
    scene.update(tree, editor.document(), &Run::plain()).expect("sound");
    let made = scene.get(tree).expect("made");
    assert_eq!((made.report().name.as_str(), made.stages.len()), ("an elder", 0));
}

#[test]
fn vertices_inside_obstacles_are_counted_with_the_deepest() {
    let mut mesh = mesh::TriMesh::default();
    for x in [0.0, 0.9995, 1.0015, 1.5, 2.25] {
        mesh.push(DVec3::new(x, 0.5, 0.5));
    }
    let material = mesh::MaterialId::new(0);
    let parts = vec![
        mesh::Part { name: "a".into(), material, mesh: mesh.clone() },
        mesh::Part { name: "b".into(), material, mesh },
    ];
    let model = Model { parts, ..Model::default() };
    let block = Obstacle::Box { min: DVec3::new(1.0, -9.0, -9.0), max: DVec3::new(2.0, 9.0, 9.0) };
    let inside =
        Inside::measure(&model, &Obstacles::new(&[block], 0.0).expect("sound")).expect("there is one");
    assert_eq!(inside.vertices, 4, "two of each part, and what is 0.5 mm away from it is not");
    assert!((inside.depth_m - 0.5).abs() < 1e-6, "{}", inside.depth_m);
    assert_eq!(Inside::measure(&model, &Obstacles::none()), None);
}
