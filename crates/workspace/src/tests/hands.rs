//! Shaping by hand: carried branches, kept gestures, and records of gestures.

use burgeon::LiteMap;
use burgeon::document::PlantNumbers;
use burgeon::glam::{DQuat, DVec3};
use burgeon::plant::AxisId;
use data_encoding::BASE64;

use super::*;
use crate::shown::Shown;
use crate::{GESTURES_SCHEMA, GestureDeed, GestureRecord, GestureStep, ShapePointer, ShapeReach};

/// Returns the nodes of a branch and of all that it bears.
fn nodes_of(s: &Workspace, axis: u32) -> Vec<[f64; 3]> {
    let plant = s.scene.get(PlantId(1)).unwrap().plant.unwrap();
    let borne = plant.borne_by(AxisId::new(axis as usize));
    let rows = borne.iter().enumerate().filter(|(_, is)| **is).map(|(row, _)| row);
    rows.flat_map(|row| plant.axis_points(AxisId::new(row))).map(|p| p.to_array()).collect()
}

/// Returns those nodes where a pose carries them.
fn foreseen(s: &Workspace, axis: u32, pose: &Value) -> Vec<[f64; 3]> {
    let of = |key: &str| -> Vec<f64> {
        pose[key].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let v = |key: &str| DVec3::from_slice(&of(key));
    let (from, to, turn) = (v("from"), v("to"), DQuat::from_slice(&of("turn")));
    let place = |p: [f64; 3]| (to + turn * (DVec3::from_array(p) - from)).to_array();
    nodes_of(s, axis).into_iter().map(place).collect()
}

#[test]
fn what_a_hand_carries_are_the_triangles_of_the_branch_and_of_what_it_bears() {
    for file in ["bush", "drawing"] {
        let mut s = bush().0;
        if file == "drawing" {
            s = Workspace::default();
            s.open("tulip.svg", include_bytes!("../../../../fixtures/sketches/gallery/tulip.svg"), 0, false)
                .unwrap();
            s.evaluate(&run()).unwrap();
        }
        let plant = s.scene.get(s.current().unwrap()).unwrap().plant.unwrap().clone();
        let size = s.scene.get(s.current().unwrap()).unwrap().model.bounds().size().length();
        let mut carried = 0;
        for axis in 0..plant.axes.len().min(60) {
            let id = AxisId::new(axis);
            let scene = s.scene.get(s.current().unwrap()).unwrap();
            let Some(rows) = scene.layout.unwrap().branch(&plant, id) else { continue };
            let borne = plant.borne_by(id);
            let of = |a: usize| plant.axis_points(AxisId::new(a)).to_vec();
            let all: Vec<_> = (0..plant.axes.len()).flat_map(of).collect();
            let own: Vec<_> = (0..plant.axes.len()).filter(|a| borne[*a]).flat_map(of).collect();
            assert_eq!(rows.len(), scene.model.parts.len());
            for (part, rows) in scene.model.parts.iter().zip(&rows) {
                for t in rows.iter().flat_map(|r| &part.mesh.triangles[r.start as usize..r.end as usize]) {
                    let p = part.mesh.position(t[0]);
                    let near = |of: &[DVec3]| of.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
                    // Leaves may hang next to other wood; wood does not.
                    let more = if part.name == "leaves" { 0.2 } else { 0.02 };
                    let (to_own, to_any) = (near(&own), near(&all));
                    assert!(to_own < to_any + more * size, "{file} {axis} {}: {to_own} {to_any}", part.name);
                    carried += 1;
                }
            }
            // A stem on the ground with all that it bears is the whole plant.
            if plant.axes.iter().filter(|a| a.bearer.is_none()).count() == 1 && axis == 0 {
                let all: usize = rows.iter().flatten().map(|r| r.len()).sum();
                assert_eq!(all, scene.model.triangle_count(), "{file}");
            }
        }
        assert!(carried > 100, "{file}: {carried}");
    }
}

#[test]
fn a_gesture_is_shown_and_is_one_step_when_it_is_asked_for() {
    let (mut s, (x, y)) = bush();
    let before = look(&mut s);
    let still = s.skeleton();
    let looked = hand(&mut s, r#""pick""#, &format!(r#"{{"down":{}}}"#, pointer_at(x, y)));
    assert!(looked["picked"]["key"]["mark"].is_object(), "{looked}");
    let axis = u32::try_from(looked["picked"]["axis"].as_u64().unwrap()).unwrap();
    let lines = s.branch(axis);
    assert!(!lines.is_empty() && lines.len() % 8 == 0 && s.branch(u32::MAX).is_empty());
    // The trunk bears everything.
    assert!(s.branch(0).len() >= lines.len());

    let rotate = r#""rotate""#;
    let down = hand(&mut s, rotate, &format!(r#"{{"down":{}}}"#, pointer_at(x, y)));
    assert_eq!((&down["busy"], &down["again"]), (&Value::Bool(true), &Value::Bool(false)));
    let held = hand(&mut s, rotate, &format!(r#"{{"move":[{}]}}"#, pointer_at(x, y + 0.4)));
    // The carried branch is moved as it is shown, and nothing is made again.
    assert_eq!((&held["busy"], &held["again"]), (&Value::Bool(true), &Value::Bool(false)), "{held}");
    assert_eq!(look(&mut s)["fresh"], false);
    assert_eq!(held["carried"]["mesh"], before["mesh"]);
    let foresaw = foreseen(&s, axis, &held["carried"]);
    assert_eq!(json(&s.state())["plants"][0]["edits"], Value::Array(vec![]));
    let up = hand(&mut s, rotate, &format!(r#"{{"up":{}}}"#, pointer_at(x, y + 0.4)));
    assert_eq!((&up["again"], &up["carried"]), (&Value::Bool(false), &Value::Null));
    assert_eq!(look(&mut s)["fresh"], false, "moved until it is asked for");
    s.ask(&format!(r#"{{"shape":[1,{{"add":{}}}]}}"#, up["commit"])).unwrap();
    assert!(s.held_rows().is_empty());
    let after = look(&mut s);
    assert_ne!(s.skeleton(), still);
    let turned: Vec<[f64; 3]> = nodes_of(&s, axis);
    let off =
        |(a, b): (&[f64; 3], &[f64; 3])| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let worst = turned.iter().zip(&foresaw).map(off).fold(0.0, f64::max);
    assert!(turned.len() == foresaw.len() && worst < 1e-9, "as it was carried: {worst}");
    assert!(after["item"]["digest"].as_str().is_some_and(|d| d.len() == 32));
    assert_eq!(after["item"]["edits"][0]["done"], true);
    assert_eq!(s.undo(), Some("rotate"));
    assert_eq!(look(&mut s)["item"]["digest"], before["item"]["digest"]);
    // Escape leaves nothing behind.
    gesture(&mut s, rotate, (50.0, 50.0), (51.0, 50.0));
    hand(&mut s, rotate, &format!(r#"{{"down":{}}}"#, pointer_at(x, y)));
    hand(&mut s, rotate, &format!(r#"{{"move":[{}]}}"#, pointer_at(x, y + 0.5)));
    let let_go = hand(&mut s, rotate, r#""cancel""#);
    assert_eq!((&let_go["again"], &let_go["carried"]), (&Value::Bool(false), &Value::Null));
    assert_eq!(look(&mut s)["item"]["digest"], before["item"]["digest"]);
}

/// The edit of a gesture is requested, and shown.
const KEPT: &str = r#"{"did":"keep"},{"did":"seen"}"#;

/// Replays a record without looking on.
fn replayed(s: &mut Workspace, record: &GestureRecord) -> Result<crate::Replayed, WorkspaceError> {
    s.replay(record, &run(), &mut |_, _| ())
}

/// Makes a record: a branch is turned, one drawn in the air, one grown for six rounds with more vigour on the way, and
/// one gesture has no end.
fn recorded(x: f64, y: f64) -> String {
    let step = |tool: &str, input: &str| {
        format!(r#"{{"did":{{"hand":{{"tool":{tool},"reach":{REACH},"input":{input}}}}}}}"#)
    };
    let tip = |x: f64, y: f64, z: f64| {
        pointer_at(x, y).replace(r#""pressure":1"#, &format!(r#""pressure":1,"tip":[{x},{y},{z}]"#))
    };
    let grow =
        |vigour: f64| format!(r#"{{"vigour":{vigour},"apical":0.5,"angle_deg":50,"lift":0.1,"apart":1}}"#);
    let tool = format!(r#"{{"grow":{}}}"#, grow(1.5));
    let draw = r#"{"sketch":{"twigs":1,"tilt_deg":0}}"#;
    let mut steps = vec![
        step(r#""rotate""#, &format!(r#"{{"down":{}}}"#, pointer_at(x, y))),
        step(r#""rotate""#, r#"{"twist":30}"#),
        step(r#""rotate""#, &format!(r#"{{"up":{}}}"#, pointer_at(x, y))),
        KEPT.to_owned(),
        step(draw, &format!(r#"{{"down":{}}}"#, tip(0.0, 1.2, 0.0))),
        step(draw, &format!(r#"{{"move":[{},{}]}}"#, tip(0.3, 1.5, 0.2), tip(0.6, 1.9, 0.3))),
        step(draw, &format!(r#"{{"up":{}}}"#, tip(0.9, 2.1, 0.2))),
        KEPT.to_owned(),
        step(&tool, &format!(r#"{{"down":{}}}"#, pointer_at(0.0, 1.0))),
    ];
    steps.extend((0..3).map(|_| step(&tool, r#""round""#)));
    steps.push(step(&tool, &format!(r#"{{"grow":{}}}"#, grow(2.5))));
    steps.extend((0..3).map(|_| step(&tool, r#""round""#)));
    steps.push(step(&tool, &format!(r#"{{"up":{}}}"#, pointer_at(0.0, 1.0))));
    steps.push(KEPT.to_owned());
    steps.push(step(draw, &format!(r#"{{"down":{}}}"#, tip(0.0, 1.2, 0.0))));
    format!(r#"{{"schema":"{GESTURES_SCHEMA}","steps":[{}]}}"#, steps.join(","))
}

#[test]
fn a_record_of_gestures_makes_the_same_plant_again() {
    let (mut first, (x, y)) = bush();
    let text = recorded(x, y);
    let record = GestureRecord::read(text.as_bytes()).unwrap();
    assert_eq!(replayed(&mut first, &record).unwrap().edits, 3);
    let done = look(&mut first)["item"].clone();
    let told: Vec<bool> =
        done["edits"].as_array().unwrap().iter().map(|e| e["done"].as_bool().unwrap()).collect();
    assert_eq!(told, [true; 3]);
    let again = serde_json::to_string(&record).unwrap();
    let (mut second, _) = bush();
    let came = replayed(&mut second, &GestureRecord::read(again.as_bytes()).unwrap()).unwrap();
    assert_eq!((came.edits, came.digest.as_deref()), (3, done["digest"].as_str()));
    assert_eq!(look(&mut second)["item"]["digest"], done["digest"]);
    // Each is a step of undo, and after undoing all the plant is the first one.
    for _ in 0..3 {
        assert!(second.undo().is_some());
    }
    assert_eq!(look(&mut second)["item"]["digest"], look(&mut bush().0)["item"]["digest"]);
}

#[test]
fn a_record_that_is_cut_off_or_hostile_says_so() {
    let (s, (x, y)) = bush();
    drop(s);
    let text = recorded(x, y);
    let code = |bytes: &[u8]| Refusal::from_error(&GestureRecord::read(bytes).unwrap_err()).code;
    for share in 1..40 {
        assert_eq!(code(&text.as_bytes()[..text.len() * share / 40]), "record");
    }
    assert_eq!(code(text.replace("gestures/1", "gestures/9").as_bytes()), "record-form");
    assert_eq!(code(text.replace("\"twist\":30", "\"twist\":1e999").as_bytes()), "record");
    assert_eq!(code(text.replace("\"reach\"", "\"reach\":{},\"more\"").as_bytes()), "record");
    assert_eq!(code(&vec![b'['; 1 << 16]), "record");
    let far = pointer_at(1.0, 1.0);
    let many = vec![far.as_str(); 20_001].join(",");
    let long = format!(
        r#"{{"schema":"{GESTURES_SCHEMA}","steps":[{{"did":{{"hand":{{"tool":"rotate","reach":{REACH},"input":{{"move":[{many}]}}}}}}}}]}}"#
    );
    assert_eq!(code(long.as_bytes()), "record-long");
    // Steps in any order, with any numbers, cause no fault of the tools.
    let (mut s, _) = bush();
    let mut record = GestureRecord::read(text.as_bytes()).unwrap();
    record.steps.reverse();
    record.steps.retain(|step| step.did != GestureDeed::Keep);
    let wild = record.steps.iter().map(|step| {
        let mut step = step.clone();
        let GestureDeed::Hand(hand) = &mut step.did else { return step };
        match &mut hand.input {
            ShapeInput::Down(p) => *p = ShapePointer { direction: [0.0; 3], ..*p },
            ShapeInput::Up(p) => *p = ShapePointer { tip: Some([1e300; 3]), ..*p },
            _ => {}
        }
        step
    });
    let wild = GestureRecord { steps: wild.collect(), ..record.clone() };
    for record in [&record, &wild] {
        replayed(&mut s, record).unwrap();
        assert!(look(&mut s)["error"].is_null());
    }
    // An edit that no gesture made, an invalid project, a plant that does not exist.
    let refused = |record: GestureRecord| {
        Refusal::from_error(&replayed(&mut Workspace::default(), &record).unwrap_err()).code
    };
    let keeps = vec![GestureStep { ms: 0, did: GestureDeed::Keep }];
    assert_eq!(refused(GestureRecord { steps: keeps, ..GestureRecord::default() }), "record-keeps");
    let project = |text: &str| GestureRecord { project: Some(text.into()), ..GestureRecord::default() };
    assert_eq!(refused(project("n\u{f6}")), "record-project");
    assert_ne!(refused(project("bm9uZQ==")), "record-project");
    let plant = Some(PlantId(77));
    assert_eq!(refused(GestureRecord { plant, ..GestureRecord::default() }), "plant-gone");
}

/// Returns number and digest of each plant.
fn digests(s: &mut Workspace) -> Vec<(u64, String)> {
    let view = json(&s.evaluate(&run()).unwrap());
    let digest = |p: &Value| (p["id"].as_u64().unwrap(), p["item"]["digest"].as_str().unwrap().to_owned());
    view["plants"].as_array().unwrap().iter().map(digest).collect()
}

#[test]
fn a_record_means_the_plants_that_it_names_in_a_scene_of_several() {
    let (mut s, (x, y)) = bush();
    for _ in 0..2 {
        s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap();
    }
    s.ask(r#"{"scene":{"remove":[1]}}"#).unwrap();
    s.ask(r#"{"plant":[3,{"set-seed":"77"}]}"#).unwrap();
    s.select(PlantId(2)).unwrap();
    s.evaluate(&run()).unwrap();
    let numbers = s.document().numbers();
    assert_eq!((&numbers.plants[..], numbers.next), (&[PlantId(2), PlantId(3)][..], 4));
    let project = BASE64.encode(&s.save().unwrap());
    let turn =
        |input: &str| format!(r#"{{"did":{{"hand":{{"tool":"rotate","reach":{REACH},"input":{input}}}}}}}"#);
    // A branch of the first is turned, the second gets another seed, and a copy of it comes in and has its own number.
    let steps = [
        turn(&format!(r#"{{"down":{}}}"#, pointer_at(x, y))),
        turn(r#"{"twist":30}"#),
        turn(&format!(r#"{{"up":{}}}"#, pointer_at(x, y))),
        KEPT.to_owned(),
        r#"{"did":{"command":{"plant":[3,{"set-seed":"5"}]}}}"#.to_owned(),
        r#"{"did":{"command":{"scene":{"duplicate":[3,[1.5,0,0]]}}}}"#.to_owned(),
        r#"{"did":"seen"},{"did":{"select":4}}"#.to_owned(),
        r#"{"did":{"command":{"plant":[4,{"set-seed":"6"}]}}}"#.to_owned(),
    ];
    let text = format!(r#"{{"schema":"{GESTURES_SCHEMA}","plant":2,"steps":[{}]}}"#, steps.join(","));
    let here = GestureRecord::read(text.as_bytes()).unwrap();
    let came = replayed(&mut s, &here).unwrap();
    let done = digests(&mut s);
    assert_eq!((came.edits, done.iter().map(|d| d.0).collect::<Vec<_>>()), (1, vec![2, 3, 4]));
    let record = GestureRecord { project: Some(project), numbers: Some(numbers.clone()), ..here.clone() };
    let text = serde_json::to_string(&record).unwrap();
    let record = GestureRecord::read(text.as_bytes()).unwrap();
    let mut again = Workspace::default();
    assert_eq!(replayed(&mut again, &record).unwrap(), came);
    assert_eq!(digests(&mut again), done);
    // Without its numbers it is unknown which plants are meant.
    let lost = GestureRecord { numbers: None, ..record.clone() };
    let code = |record: &GestureRecord| {
        Refusal::from_error(&replayed(&mut Workspace::default(), record).unwrap_err()).code
    };
    assert_eq!(code(&lost), "plant-gone");
    // Numbers that are too few, used twice, or not assigned yet.
    for (plants, next) in [(vec![2], 4), (vec![2, 2], 4), (vec![2, 9], 4), (vec![2, 3, 4], 9)] {
        let plants = plants.into_iter().map(PlantId).collect();
        let numbers = Some(PlantNumbers { plants, next });
        assert_eq!(code(&GestureRecord { numbers, ..record.clone() }), "record-numbers");
    }
}

#[test]
fn a_branch_that_is_pulled_off_says_on_what_it_would_be_dropped() {
    /// Orientation of a hand that turned by about 17 degrees.
    const SPUN: DQuat = DQuat::from_xyzw(0.0, 0.15, 0.0, 0.99);
    let (mut s, _) = bush();
    let before = look(&mut s)["item"]["digest"].clone();
    let plant = s.scene.get(PlantId(1)).unwrap().plant.unwrap().clone();
    let axis = plant.axes.iter().position(|a| a.order == 1).unwrap();
    let points = plant.axis_points(AxisId::new(axis));
    let (base, tip) = (points[0], *points.last().unwrap());
    let held = |p: DVec3, turn: DQuat| {
        let [x, y, z] = p.to_array();
        let hand = json(&turn.to_array());
        pointer_at(x, y)
            .replace(r#""pressure":1"#, &format!(r#""pressure":1,"tip":[{x},{y},{z}],"hand":{hand}"#))
    };
    let rotate = r#""rotate""#;
    let down = hand(&mut s, rotate, &format!(r#"{{"down":{}}}"#, held(tip, DQuat::IDENTITY)));
    let axis = u32::try_from(down["picked"]["axis"].as_u64().unwrap()).unwrap();
    let near = tip + (tip - base) * 0.1;
    let turned = hand(&mut s, rotate, &format!(r#"{{"move":[{}]}}"#, held(near, SPUN)));
    assert!(turned["host"].is_null() && turned["turned_deg"].as_f64().unwrap() > 1.0, "{turned}");
    let far = base + (tip - base) * 2.5 + DVec3::Y * 0.3;
    let off = hand(&mut s, rotate, &format!(r#"{{"move":[{}]}}"#, held(far, SPUN)));
    assert!(off["host"].is_u64() && off["again"] == false, "{off}");
    let foresaw = foreseen(&s, axis, &off["carried"]);
    let up = hand(&mut s, rotate, &format!(r#"{{"up":{}}}"#, held(far, SPUN)));
    assert_eq!((&up["commit"]["op"], up["commit"]["turn"].is_object()), (&"move".into(), true), "{up}");
    s.ask(&format!(r#"{{"shape":[1,{{"add":{}}}]}}"#, up["commit"])).unwrap();
    look(&mut s);
    // Rows may have changed; its key stays.
    let moved = s.scene.get(PlantId(1)).unwrap().plant.unwrap();
    let key = plant.axis(AxisId::new(axis as usize)).key;
    let row = moved.axes.iter().position(|a| a.key == key).unwrap();
    let off = |(q, p): (&DVec3, &[f64; 3])| q.distance(DVec3::from_array(*p));
    let worst = moved.axis_points(AxisId::new(row)).iter().zip(&foresaw).map(off).fold(0.0, f64::max);
    assert!(worst < 1e-9, "as it was carried: {worst}");
    assert_eq!(s.undo(), Some("move"));
    assert_eq!(look(&mut s)["item"]["digest"], before);
}

#[test]
fn a_copy_and_both_sides_of_a_mirror_are_done_again_from_a_record() {
    let (mut first, (x, y)) = bush();
    let plain = look(&mut first)["item"]["digest"].clone();
    // Between the hands of somebody who looks along -z.
    let placed = hand(&mut first, r#""rotate""#, &format!(r#"{{"mirror":{}}}"#, pointer_at(x, y)));
    let mirror = placed["mirror"].to_string();
    assert_eq!(placed["mirror"]["normal"], serde_json::json!([1.0, 0.0, 0.0]), "{placed}");
    let both = REACH.replace('}', &format!(r#","mirror":{mirror}}}"#));
    let tip = |x: f64, y: f64, z: f64| {
        pointer_at(x, y).replace(r#""pressure":1"#, &format!(r#""pressure":1,"tip":[{x},{y},{z}]"#))
    };
    let step = |tool: &str, reach: &str, input: &str| {
        format!(r#"{{"did":{{"hand":{{"tool":{tool},"reach":{reach},"input":{input}}}}}}}"#)
    };
    let draw = r#"{"sketch":{"twigs":1,"tilt_deg":0}}"#;
    let copy = r#""copy""#;
    let steps = [
        step(copy, REACH, &format!(r#"{{"down":{}}}"#, pointer_at(x, y))),
        step(copy, REACH, &format!(r#"{{"move":[{}]}}"#, tip(0.1, 0.9, 0.1))),
        step(copy, REACH, &format!(r#"{{"up":{}}}"#, tip(0.0, 0.8, 0.0))),
        KEPT.to_owned(),
        step(draw, &both, &format!(r#"{{"down":{}}}"#, tip(0.0, 1.2, 0.0))),
        step(draw, &both, &format!(r#"{{"move":[{}]}}"#, tip(0.4, 1.5, 0.2))),
        step(draw, &both, &format!(r#"{{"up":{}}}"#, tip(0.9, 1.9, 0.3))),
        KEPT.to_owned(),
    ];
    let record = format!(r#"{{"schema":"{GESTURES_SCHEMA}","steps":[{}]}}"#, steps.join(","));
    let record = GestureRecord::read(record.as_bytes()).unwrap();
    assert_eq!(replayed(&mut first, &record).unwrap().edits, 2);
    let done = look(&mut first)["item"].clone();
    let told: Vec<&str> =
        done["edits"].as_array().unwrap().iter().map(|e| e["said"].as_str().unwrap()).collect();
    assert!(told.iter().all(|said| said.contains("grown")), "{told:?}");
    let (mut second, _) = bush();
    assert_eq!(replayed(&mut second, &record).unwrap().edits, 2);
    assert_eq!(look(&mut second)["item"]["digest"], done["digest"]);
    for _ in 0..2 {
        assert!(second.undo().is_some());
    }
    assert_eq!(look(&mut second)["item"]["digest"], plain);
    // An invalid mirror is refused, and changes nothing.
    let flat = GestureRecord {
        steps: record.steps[5..]
            .iter()
            .map(|s| {
                let mut step = s.clone();
                let GestureDeed::Hand(hand) = &mut step.did else { return step };
                let mirror = hand.reach.mirror.map(|m| burgeon::shape::Mirror { normal: DVec3::ZERO, ..m });
                hand.reach = ShapeReach { mirror, ..hand.reach };
                step
            })
            .collect(),
        ..record.clone()
    };
    assert!(replayed(&mut second, &flat).is_err());
    second.let_go();
    assert_eq!(look(&mut second)["item"]["digest"], plain);
}

#[test]
fn what_grows_in_the_hand_says_how_old_and_how_dense_it_is() {
    let (mut s, _) = bush();
    let tool = r#"{"grow":{"vigour":2,"apical":0.54,"angle_deg":55,"lift":0.12,"apart":1}}"#;
    let first = hand(&mut s, tool, &format!(r#"{{"down":{}}}"#, pointer_at(0.0, 1.0)));
    assert_eq!((&first["grown"]["rounds"], &first["grown"]["branches"]), (&1.into(), &0.into()));
    assert_eq!(first["grown"]["per_metre"], Value::Null);
    let mut told = Vec::new();
    for round in 2..12 {
        look(&mut s);
        let answer = hand(&mut s, tool, r#""round""#);
        assert_eq!(answer["grown"]["rounds"], round);
        told.push(answer["grown"]["branches"].as_u64().unwrap());
    }
    look(&mut s);
    let last = hand(&mut s, tool, r#""round""#)["grown"].clone();
    assert!(told.windows(2).all(|w| w[1] >= w[0]) && told[9] > 5, "{told:?}");
    let density = last["per_metre"].as_f64().unwrap();
    assert!((0.2..50.0).contains(&density), "{density}");
    let up = hand(&mut s, tool, &format!(r#"{{"up":{}}}"#, pointer_at(0.0, 1.0)));
    assert_eq!(up["grown"], Value::Null);
    s.ask(&format!(r#"{{"shape":[1,{{"add":{}}}]}}"#, up["commit"])).unwrap();
    let added = look(&mut s)["item"]["edits"][0]["changed"]["added"].as_u64().unwrap();
    assert!(added >= last["branches"].as_u64().unwrap(), "{added} {last}");
}

#[test]
fn what_is_shown_stays_within_a_number_of_triangles_and_is_carried_as_it_is_shown() {
    let (mut s, (x, y)) = bush();
    let whole = look(&mut s);
    let shown = |s: &Workspace, view: &Value| -> usize {
        let parts = view["parts"].as_array().unwrap().len();
        (0..parts).map(|part| s.indices(PlantId(1), part).len() / 3).sum()
    };
    let all = shown(&s, &whole);
    // A level made in advance is not shown, and is not made again when it is needed.
    s.ready_levels(all as u64 / 2, &run());
    let still = look(&mut s);
    assert_eq!(shown(&s, &still), all);
    let columns = |of: &LiteMap<PlantId, Shown>| {
        of.values().next().map(|shown| shown.made.model.parts[0].mesh.positions.as_ptr())
    };
    let ready = columns(&s.levels.ready);
    s.set_most_triangles(Some(all as u64 / 2));
    let fewer = look(&mut s);
    assert!(ready.is_some() && columns(&s.levels.shown) == ready);
    assert!(fewer["fresh"] == true && fewer["mesh"] != whole["mesh"], "{} {}", fewer["fresh"], fewer["mesh"]);
    let now = shown(&s, &fewer);
    assert!(now <= all / 2 && now > all / 40, "{now} of {all}");
    // The plant is the same one; meshes shown again are not sent again.
    assert_eq!(fewer["item"], whole["item"]);
    let again = look(&mut s);
    assert_eq!((&again["fresh"], &again["mesh"]), (&Value::Bool(false), &fewer["mesh"]));
    // The hand carries triangles of the shown meshes.
    hand(&mut s, r#""rotate""#, &format!(r#"{{"down":{}}}"#, pointer_at(x, y)));
    let answer = hand(&mut s, r#""rotate""#, r#"{"twist":30}"#);
    assert_eq!(answer["carried"]["mesh"], fewer["mesh"], "{answer}");
    let rows: Vec<[u32; 3]> = s.held_rows().as_chunks().0.to_vec();
    assert!(!rows.is_empty());
    for [part, from, to] in rows {
        assert!(from < to && to as usize <= s.indices(PlantId(1), part as usize).len() / 3);
    }
    // Shown in the pose of the hand: as many triangles, in other places.
    let carried = s.seen().unwrap();
    assert_eq!(carried.triangle_count(), now);
    hand(&mut s, r#""rotate""#, r#""cancel""#);
    assert!(s.seen().unwrap() != carried, "it was somewhere else");
    s.set_most_triangles(None);
    let back = look(&mut s);
    assert_eq!((&back["mesh"], shown(&s, &back)), (&whole["mesh"], all));
}
