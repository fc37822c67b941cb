//! Several plants: added, copied, scattered, locked, placed.

use super::*;

#[test]
fn copies_variants_levels_and_links() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, true).unwrap();
    let plant = look(&mut s);
    let text = String::from_utf8(s.copy(&[StrokeId(0), StrokeId(1)]).unwrap()).unwrap();
    assert!(s.copy(&[StrokeId(99)]).is_err() && s.paste("no drawing", DVec2::ZERO).is_err());
    assert_eq!(s.paste(&text, DVec2::new(5.0, 0.0)).unwrap(), [StrokeId(15), StrokeId(16)]);
    assert_eq!(s.stroke_points(StrokeId(15))[0].0, s.stroke_points(StrokeId(0))[0].0 + 5.0);
    s.ask(r#"{"sketch":[0,{"duplicate":[[0],[0,1]]}]}"#).unwrap();
    assert_eq!(s.undo(), Some("duplicate"));
    assert_eq!(s.undo(), Some("draw"));

    let other = json(&s.variant(Seed::new(77), 0.4, &run()).unwrap());
    let positions = s.column(GUEST, 0, Column::Positions).len();
    s.end_variant();
    assert!(other["item"].is_null() && positions > 0);
    let again = look(&mut s);
    assert_eq!(again["item"]["digest"], plant["item"]["digest"], "a look at another seed changes nothing");
    assert!(s.column(PlantId(0), 0, Column::Positions).len() > positions);
    assert_eq!(s.skeleton().len() % 8, 0);
    assert!(!s.skeleton().is_empty());

    let levels = s.exported(&ExportRequest { levels: 3, ..ExportRequest::default() });
    assert!(
        levels.starts_with(b"PK") && levels.windows(9).any(|w| w == b"LOD2.glb\0" || &w[..8] == b"LOD2.glb")
    );
    let holds = |file: &[u8], word: &[u8]| file.windows(word.len()).any(|w| w == word);
    let of = |one_file, sway, impostor| ExportRequest {
        levels: 2,
        one_file,
        sway,
        impostor,
        ..ExportRequest::default()
    };
    let one = s.exported(&of(true, false, true));
    assert!(one.starts_with(b"glTF") && holds(&one, b"MSFT_lod") && holds(&one, b"hemi-octahedral"));
    let far = s.exported(&of(false, false, true));
    assert!(far.starts_with(b"PK") && holds(&far, b"plant_LOD2.glb"), "two levels and the impostor");
    // Joints need files of their own.
    assert!(s.exported(&of(true, true, false)).starts_with(b"PK"), "two files");
    let swaying = s.exported(&ExportRequest { levels: 1, ..of(false, true, false) });
    assert!(swaying.starts_with(b"glTF") && holds(&swaying, b"inverseBindMatrices"), "joints");

    let link = s.share().unwrap();
    assert!(link.len() < 16 << 10, "{} bytes", link.len());
    let mut linked = Workspace::default();
    linked.open("x.burgeon", &link, 0, true).unwrap();
    let shared = look(&mut linked);
    assert_eq!(shared["item"]["counts"]["flowers"], plant["item"]["counts"]["flowers"]);
}

#[test]
fn a_tree_a_leaf_and_a_flower_in_one_scene() {
    let mut s = Workspace::default();
    let opened = json(&s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap());
    assert_eq!(
        (opened["kind"].as_str(), s.document().plants().len()),
        (Some("tree"), 1),
        "the blank sheet gave way"
    );
    s.evaluate(&run()).unwrap();
    s.open("leaf1.csv", &marks(), 0, false).unwrap();
    s.act(&serde_json::from_str::<Action>(r#"{"add":{"name":"a rose","maker":{"flower":"rose"}}}"#).unwrap())
        .unwrap();
    let made = scene(&mut s);
    assert_eq!(made.len(), 3);
    assert!(made.iter().all(|(_, digest, error)| digest.len() > 8 && error.is_null()), "{made:?}");
    // Nothing is grown or sent again for a change elsewhere.
    s.ask(r#"{"flower":[3,{"set-day":1.5}]}"#).unwrap();
    let view = json(&s.evaluate(&run()).unwrap());
    let fresh: Vec<bool> = (0..3).map(|k| view["plants"][k]["fresh"].as_bool().unwrap()).collect();
    assert_eq!(fresh, [false, false, true]);
    assert_eq!(view["plants"][2]["days"].as_array().unwrap().len(), 2);
    let mut other = Workspace::default();
    other.open("three.burgeon", &s.save().unwrap(), 0, true).unwrap();
    assert_eq!(scene(&mut other), scene(&mut s));
    // A tree grows around an obstacle; an invalid spec is refused.
    let ids: Vec<PlantId> = s.document().plants().iter().map(|p| p.id()).collect();
    assert_eq!(ids.len(), made.len());
    s.select(ids[0]).unwrap();
    let before = scene(&mut s);
    s.ask(r#"{"tree":[1,{"add-obstacle":{"name":"ball","shape":{"shape":"sphere","centre":[0,3,0],"radius_m":1}}}]}"#)
        .unwrap();
    assert_ne!(scene(&mut s)[0].1, before[0].1);
    assert!(s.ask(r#"{"tree":[1,{"set-field":["/age","old"]}]}"#).is_err());
    assert!(s.ask(r#"{"tree":[1,{"set-field":["/no/such",1]}]}"#).is_err());
    let refused = s.ask(r#"{"tree":[1,{"set-field":["/clearance_m",-1]}]}"#).unwrap_err();
    assert!(format!("{refused:?}").contains("clearance_m"), "{refused:?}");
    let model = s.file(ExportFormat::Model(formats::ModelFormat::Obj));
    assert!(model.starts_with(b"PK"));
    let ball = s.file(ExportFormat::Model(formats::ModelFormat::Ply));
    s.add_obstacle("itself.ply", &ball).unwrap();
    assert!(!s.obstacle(ids[0], 1).is_empty() && s.obstacle(ids[0], 0).is_empty());
    s.undo();
    s.undo();
    s.ask(r#"{"tree":[1,{"set-leaf":2}]}"#).unwrap();
    let borne = scene(&mut s);
    assert!(borne[0].2.is_null() && borne[0].1 != before[0].1);
    // Hidden plants are not in an export of the scene.
    let all = ExportRequest { whole: true, ..ExportRequest::default() };
    let whole = s.exported(&all).len();
    s.ask(r#"{"plant":[3,{"hide":true}]}"#).unwrap();
    assert!(s.exported(&all).len() < whole);
    assert!(s.file(ExportFormat::Structure(formats::StructureFormat::Mtg)).len() > 200);
    let opf = String::from_utf8(s.file(ExportFormat::Structure(formats::StructureFormat::Opf))).unwrap();
    assert!(opf.contains("<opf ") && opf.contains("class=\"Leaf\"") && opf.trim_end().ends_with("</opf>"));
    s.ask(r#"{"scene":{"remove":[2]}}"#).unwrap();
    assert_eq!(scene(&mut s)[0].1, before[0].1, "its own leaf again");
    while s.undo().is_some() {}
    assert_eq!(s.document(), &Document::default());
}

#[test]
fn three_hundred_trees_one_after_the_other_do_not_grow_without_bound() {
    let mut s = Workspace::default();
    let mut first = Value::Null;
    for k in 0..300 {
        s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap();
        let id = s.current().unwrap();
        s.run(PlantCommand::SetSeed(Seed::new(k + 7)).for_plant(id)).unwrap();
        let made = look(&mut s);
        assert!(made["item"]["digest"].is_string(), "{made}");
        if k == 0 {
            s.keep_at_most(8 * s.kept_bytes());
            first = made;
        }
        s.run(SceneCommand::Remove(vec![id])).unwrap();
        s.evaluate(&run()).unwrap();
        assert!(s.kept_bytes() <= s.kept.limit, "{k}: {}", s.kept_bytes());
    }
    assert!(s.scene.kept().count() > 2, "there is room for some");
    // The last one is still there, the first is made again.
    s.undo();
    assert_eq!(look(&mut s)["stages"], serde_json::json!([]));
    while s.state().steps > 2 {
        s.undo();
    }
    let again = look(&mut s);
    assert_eq!(again["item"]["digest"], first["item"]["digest"]);
    assert_ne!(again["stages"], serde_json::json!([]));
    // Visible plants stay, whatever the limit.
    s.keep_at_most(0);
    assert!(look(&mut s)["parts"].as_array().is_some_and(|p| !p.is_empty()));
    assert_eq!(s.scene.kept().count(), 1);
}

#[test]
fn plants_that_are_added_again_stand_where_they_stood() {
    let lily = Action::Add { name: "lily".into(), maker: NewMaker::Flower("lily".into()) };
    let mut s = Workspace::default();
    let mut places = Vec::new();
    for _ in 0..3 {
        s.act(&lily).unwrap();
        places.push(s.placed().unwrap());
        s.evaluate(&run()).unwrap();
    }
    s.undo();
    assert_eq!(s.placed(), None, "nothing was added");
    s.redo();
    // Without growing them.
    let mut again = Workspace::default();
    for &x in &places {
        again.place_next(x);
        again.act(&lily).unwrap();
        assert_eq!(again.placed(), Some(x));
    }
    assert_eq!(again.document(), s.document());
    assert!(places[1] < places[2], "{places:?}");
}

#[test]
fn a_scene_that_is_full_says_so_and_goes_on() {
    let lily = Action::Add { name: "lily".into(), maker: NewMaker::Flower("lily".into()) };
    let mut s = Workspace::default();
    // Identical plants would share their memory.
    let other = |s: &mut Workspace, seed| {
        s.act(&lily).unwrap();
        let id = s.current().unwrap();
        s.run(PlantCommand::SetSeed(Seed::new(seed)).for_plant(id)).unwrap();
    };
    other(&mut s, 2);
    s.evaluate(&run()).unwrap();
    s.show_at_most(s.kept_bytes());
    other(&mut s, 3);
    assert!(s.evaluate(&run()).unwrap().plants[1].error.is_none(), "the last that has room");
    other(&mut s, 4);
    let view = s.evaluate(&run()).unwrap();
    assert_eq!(view.plants[2].error.as_ref().map(|e| e.code.as_str()), Some("scene-full"));
    assert!(view.plants[2].parts.is_empty());
    // An existing plant may change, and freed room is used.
    let first = s.document().plants()[0].id();
    s.run(PlantCommand::SetSeed(Seed::new(7)).for_plant(first)).unwrap();
    assert!(s.evaluate(&run()).unwrap().plants[0].error.is_none());
    s.keep_at_most(0);
    s.run(PlantCommand::Hide(true).for_plant(first)).unwrap();
    s.evaluate(&run()).unwrap();
    let view = s.evaluate(&run()).unwrap();
    assert!(view.plants[2].error.is_none() && !view.plants[2].parts.is_empty());
}

#[test]
fn a_plant_whose_place_is_locked_stays_where_it_is() {
    let mut s = flower();
    let id = s.current().unwrap();
    s.run(PlantCommand::Fix(true).for_plant(id)).unwrap();
    let there = Placement { position: DVec3::X, ..Placement::default() };
    let why = s.run(PlantCommand::Place(there).for_plant(id)).unwrap_err();
    assert_eq!(Refusal::from_error(&why).code, "place-locked");
    assert_eq!(s.document().plants()[0].settings().placement, Placement::default());
    // It is kept with the project; a copy may move.
    s.run(SceneCommand::Duplicate(id, DVec3::Z)).unwrap();
    let mut other = Workspace::default();
    other.open("two.burgeon", &s.save().unwrap(), 0, true).unwrap();
    let fixed: Vec<bool> = other.document().plants().iter().map(|p| p.settings().fixed).collect();
    assert_eq!(fixed, [true, false]);
    s.run(PlantCommand::Fix(false).for_plant(id)).unwrap();
    s.run(PlantCommand::Place(there).for_plant(id)).unwrap();
    assert_eq!(s.undo(), Some("place"));
    assert_eq!(s.undo(), Some("fix"));
}

#[test]
fn an_obstacle_has_a_name_by_which_messages_call_it() {
    let mut s = Workspace::default();
    s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap();
    let ball =
        |y: f64| format!(r#"{{"name":"ball","shape":{{"shape":"sphere","centre":[0,{y},0],"radius_m":1}}}}"#);
    s.ask(&format!(r#"{{"tree":[1,{{"add-obstacle":{}}}]}}"#, ball(30.0))).unwrap();
    s.ask(r#"{"tree":[1,{"rename-obstacle":[0,"Grandmother's wall"]}]}"#).unwrap();
    assert_eq!(json(&s.state())["plants"][0]["tree"]["obstacles"][0]["name"], "Grandmother's wall");
    assert!(s.ask(r#"{"tree":[1,{"rename-obstacle":[7,"nothing"]}]}"#).is_err());
    // An open mesh: the warning begins with its name.
    let open = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n5 0 0\n6 0 0\n5 1 0\n3 0 1 2\n";
    s.add_obstacle("sheet.ply", open.as_bytes()).unwrap();
    let said = |s: &mut Workspace| {
        let view = s.evaluate(&Run::plain()).unwrap();
        let warnings = view.plants[0].warnings.iter();
        warnings.filter(|w| w.code == "obstacle-open").map(|w| w.message.clone()).collect::<Vec<_>>()
    };
    assert!(said(&mut s)[0].starts_with("obstacle sheet is an open mesh"));
    s.ask(r#"{"tree":[1,{"rename-obstacle":[1,"roof"]}]}"#).unwrap();
    assert!(said(&mut s)[0].starts_with("obstacle roof is an open mesh"));
    assert_eq!(s.undo(), Some("rename"));
    assert!(said(&mut s)[0].starts_with("obstacle sheet "));
}

#[test]
fn an_obstacle_is_moved_as_one_step() {
    let mut s = Workspace::default();
    s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap();
    s.ask(r#"{"tree":[1,{"add-obstacle":{"name":"ball","shape":{"shape":"sphere","centre":[0,3,0],"radius_m":1}}}]}"#)
        .unwrap();
    let before = scene(&mut s);
    s.ask(r#"{"tree":[1,{"move-obstacle":[0,[2,-1,0.5]]}]}"#).unwrap();
    let state = json(&s.state());
    assert_eq!(state["plants"][0]["tree"]["obstacles"][0]["shape"]["centre"], json(&[2.0, 2.0, 0.5]));
    assert_ne!(scene(&mut s)[0].1, before[0].1, "the tree grows otherwise");
    for refused in ["[1,[1,0,0]]", "[0,[1e9,0,0]]", "[0,[0,0,0]]"] {
        assert!(s.ask(&format!(r#"{{"tree":[1,{{"move-obstacle":{refused}}}]}}"#)).is_err(), "{refused}");
    }
    assert_eq!(s.undo(), Some("move-obstacle"));
    assert_eq!(scene(&mut s), before);
}

fn meshes(s: &mut Workspace) -> Vec<u64> {
    let view = s.evaluate(&run()).unwrap();
    view.plants.iter().filter_map(|p| p.mesh).collect()
}

#[test]
fn copies_share_meshes_in_the_view_and_in_binary_gltf() {
    let mut s = flower();
    let id = s.current().unwrap();
    let alone = s.file(ExportFormat::Model(formats::ModelFormat::Glb)).len();
    for k in 1..4 {
        s.run(SceneCommand::Duplicate(id, DVec3::X * f64::from(k))).unwrap();
    }
    let four = meshes(&mut s);
    assert!(four.len() == 4 && four.iter().all(|m| *m == four[0]), "{four:?}");
    let whole = ExportRequest { whole: true, ..ExportRequest::default() };
    let file = s.exported(&whole);
    assert!(file.len() < alone + 4000, "{} bytes of four, {alone} of one", file.len());
    let mut other = Workspace::default();
    other.open("four.glb", &file, 0, false).unwrap();
    let seen = look(&mut other);
    assert!((seen["max"][0].as_f64().unwrap() - seen["min"][0].as_f64().unwrap()) > 3.0, "they stand apart");
    // Another seed gives another plant; the others stay as they are.
    let last = s.current().unwrap();
    s.run(PlantCommand::SetSeed(Seed::new(5)).for_plant(last)).unwrap();
    let three = meshes(&mut s);
    assert!(three[..3].iter().all(|m| *m == four[0]) && three[3] != four[0], "{three:?}");
}

#[test]
fn copies_are_scattered_at_their_spacing_as_one_step() {
    let outline = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
    let path = vec![[-4.0, 3.0], [4.0, 3.0]];
    let grounds = [
        (Ground::Line(vec![[1.0, 0.0], [1.0, 4.0], [5.0, 4.0]]), 9..=9),
        (Ground::Area(outline), 40..=115),
        (Ground::Brush { path, radius_m: 1.0 }, 8..=22),
    ];
    for (ground, count) in grounds {
        let mut s = flower();
        let plant = s.current().unwrap();
        let wanted = Scatter { plant, ground: ground.clone(), spacing_m: 1.0, kinds: 3, vary: 0.2 };
        let action: Action =
            serde_json::from_value(serde_json::json!({ "scatter": wanted })).expect("as the page asks");
        s.act(&action).unwrap();
        let plants = s.document().plants();
        let copies = &plants[1..];
        assert!(count.contains(&copies.len()), "{} of {ground:?}", copies.len());
        let at = |p: &document::DocumentPlant| p.settings().placement.position;
        for (k, p) in plants.iter().enumerate() {
            assert!(plants[..k].iter().all(|q| at(p).distance(at(q)) > 0.998), "too near");
            assert!((0.8..=1.2).contains(&p.settings().placement.scale));
        }
        match &ground {
            Ground::Brush { .. } => {
                assert!(copies.iter().all(|p| (at(p).z - 3.0).abs() <= 1.0 && at(p).x.abs() <= 5.0));
            }
            _ => assert!(copies.iter().all(|p| at(p).min_element() >= 0.0 && at(p).max_element() <= 10.0)),
        }
        let seeds: std::collections::BTreeSet<_> = copies.iter().map(|p| p.settings().seed).collect();
        assert_eq!(seeds.len(), 3, "kinds");
        let again = {
            let mut t = flower();
            t.act(&action).unwrap();
            t.document().plants() == s.document().plants()
        };
        assert!(again, "the same places for the same request");
        assert_eq!(s.undo(), Some("scatter"));
        assert_eq!(s.document().plants().len(), 1);
    }
    let mut s = flower();
    let plant = s.current().unwrap();
    let wanted = Scatter { plant, ground: Ground::Area(vec![]), spacing_m: 1.0, kinds: 0, vary: 0.0 };
    assert!(matches!(s.act(&Action::Scatter(wanted)), Err(WorkspaceError::NowhereToStand)));
    let all = vec![[-500.0, -500.0], [500.0, -500.0], [500.0, 500.0]];
    let wanted = Scatter { plant, ground: Ground::Area(all), spacing_m: 0.5, kinds: 0, vary: 0.0 };
    s.act(&Action::Scatter(wanted)).unwrap();
    assert_eq!(s.document().plants().len(), 200, "as many as a scene holds");
}

#[test]
fn an_obstacle_is_turned_as_one_step() {
    let mut s = Workspace::default();
    s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap();
    s.ask(
        r#"{"tree":[1,{"add-obstacle":{"name":"box","shape":{"shape":"box","min":[0,2,0],"max":[1,3,1]}}}]}"#,
    )
    .unwrap();
    let before = scene(&mut s);
    let shape = |s: &Workspace| json(&s.state())["plants"][0]["tree"]["obstacles"][0]["shape"].clone();
    let place =
        |s: &mut Workspace, how: &str| s.ask(&format!(r#"{{"tree":[1,{{"set-down-obstacle":[{how}]}}]}}"#));
    place(&mut s, r#"0,{"times":2,"by":[0,-1,0]}"#).unwrap();
    assert_eq!((&shape(&s)["shape"], &shape(&s)["max"]), (&json(&"box"), &json(&[2.0, 5.0, 2.0])));
    place(&mut s, r#"0,{"turn":[0,0.4,0,1],"about":[1,4,1]}"#).unwrap();
    assert_eq!(shape(&s)["shape"], "mesh");
    assert_ne!(scene(&mut s)[0].1, before[0].1, "the tree grows otherwise");
    for refused in [r#"1,{}"#, r#"0,{"times":0}"#, r#"0,{"turn":[0,0,0,0]}"#] {
        assert!(place(&mut s, refused).is_err(), "{refused}");
    }
    for _ in 0..2 {
        assert_eq!(s.undo(), Some("move-obstacle"));
    }
    assert_eq!(scene(&mut s), before);
}
