//! The workspace as a page uses it: commands and answers as JSON.

use burgeon::document::{
    self, Command, Document, NewStroke, Placement, PlantCommand, PlantId, SceneCommand, SketchCommand,
    StrokeId,
};
use burgeon::glam::{DVec2, DVec3};
use burgeon::ink::{InkSample, Stroke, StrokeClass, StrokeMode};
use burgeon::shape::ToolKind;
use burgeon::skin::{OrganMaterial, Wearer};
use burgeon::{Budget, Refusal, Run, Seed, SketchOptions, formats};
use serde::Serialize;
use serde_json::Value;

use crate::{
    Action, Column, ExportFormat, ExportRequest, GUEST, Ground, NewMaker, Scatter, ShapeInput, ShapeReach,
    ShapeStep, Workspace, WorkspaceError, packed,
};

mod hands;
mod scenes;

fn line(points: &[(f64, f64)]) -> Stroke {
    let samples =
        points.iter().map(|&(x, y)| InkSample { at: DVec2::new(x, y), time_ms: None, pressure: Some(0.5) });
    Stroke { samples: samples.collect(), ..Stroke::default() }
}

fn stem() -> Stroke {
    line(&(0..40).map(|k| (0.1 * f64::from(k % 7), 5.0 * f64::from(k))).collect::<Vec<_>>())
}

fn json(answer: &impl Serialize) -> Value {
    serde_json::to_value(answer).unwrap()
}

/// Runs with the limits of a page.
fn run() -> Run<'static> {
    Run { budget: Budget { times: 0.25, raise: None }, ..Run::plain() }
}

impl Workspace {
    fn ask(&mut self, command: &str) -> Result<(), WorkspaceError> {
        self.run(serde_json::from_str::<Command>(command).unwrap())
    }

    fn stroke_points(&self, id: StrokeId) -> Vec<(f64, f64)> {
        let samples = self.stroke(id).map_or(&[][..], |s| &s.samples);
        samples.iter().map(|p| (p.at.x, p.at.y)).collect()
    }

    fn file(&mut self, format: ExportFormat) -> Vec<u8> {
        self.exported(&ExportRequest { format, ..ExportRequest::default() })
    }

    fn exported(&mut self, request: &ExportRequest) -> Vec<u8> {
        packed(request.format, self.export(request, &run()).unwrap()).unwrap()
    }
}

/// Evaluates and returns the view of the shown model, or of the chosen plant.
fn look(s: &mut Workspace) -> Value {
    let view = json(&s.evaluate(&run()).unwrap());
    let id = s.current().map(|id| id.0);
    let plant = view["plants"].as_array().unwrap().iter().find(|p| p["id"].as_u64() == id.map(u64::from));
    if view["guest"].is_null() { plant.cloned().unwrap_or_default() } else { view["guest"].clone() }
}

fn sample() -> Vec<u8> {
    std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/sketches/sample.svg")).unwrap()
}

#[test]
fn a_stroke_becomes_a_plant_and_undo_takes_it_back() {
    let mut s = Workspace::default();
    assert_eq!(look(&mut s)["item"], Value::Null);
    let id = s.add_stroke(stem(), Vec::new()).unwrap();
    assert_eq!(s.fresh_strokes(), [id]);
    assert!(s.fresh_strokes().is_empty());
    assert_eq!(s.stroke_points(id).len(), 40);
    let view = look(&mut s);
    assert_eq!(view["item"]["counts"]["branches"], 1);
    assert!(view["item"]["strokes"][0]["organ"].is_string());
    assert!(s.column(PlantId(0), 0, Column::Positions).len() > 300 && s.indices(PlantId(0), 0).len() > 300);
    let texture = &view["materials"][0]["texture"];
    assert_eq!(
        s.texture(0).len() as u64,
        4 * texture["width"].as_u64().unwrap() * texture["height"].as_u64().unwrap()
    );
    assert_eq!(s.undo(), Some("draw"));
    let view = look(&mut s);
    assert_eq!((&view["item"], view["parts"].as_array().unwrap().len()), (&Value::Null, 0));
    assert_eq!(s.redo(), Some("draw"));
    assert_eq!(look(&mut s)["item"]["counts"]["branches"], 1);
}

#[test]
fn the_project_is_the_same_plant_elsewhere() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, false).unwrap();
    s.ask(r#"{"plant":[0,{"set-seed":"18446744073709551615"}]}"#).unwrap();
    s.ask(r#"{"sketch":[0,{"set-class":[[0],"axis"]}]}"#).unwrap();
    let here = look(&mut s);
    let mut other = Workspace::default();
    let opened = json(&other.open("x.burgeon", &s.save().unwrap(), 0, true).unwrap());
    assert_eq!(opened["kind"], "project");
    let there = look(&mut other);
    assert_eq!(here["item"]["digest"], there["item"]["digest"]);
    assert_eq!(json(&other.state())["plants"][0]["seed"], "18446744073709551615");
    assert_eq!(other.undo(), None, "opened fresh");
    let plant = &s.document().plants()[0];
    let options = SketchOptions::from_plant(plant);
    let made = burgeon::make_from_sketch(&plant.drawing(), &options, plant.settings().seed, &Run::plain());
    assert_eq!(here["item"]["digest"], made.unwrap().item.digest.as_str());
}

#[test]
fn every_format_opens_and_a_bad_file_changes_nothing() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, false).unwrap();
    let state = json(&s.state());
    for (name, bytes) in [
        ("x.svg", &b"<svg"[..]),
        ("x.burgeon", b"PK\x03\x04"),
        ("x.glb", b"glTF"),
        ("x.exe", b"MZ"),
        ("x.json", b"{}"),
        ("x.ndjson", b"\n\n"),
        ("", b""),
    ] {
        let said = s.open(name, bytes, 0, false).unwrap_err().to_string();
        assert!(said.len() > 20, "{name}: {said}");
        assert_eq!(json(&s.state()), state, "{name}");
    }
    for (format, word) in [
        (ExportFormat::Model(formats::ModelFormat::Glb), "glb"),
        (ExportFormat::Model(formats::ModelFormat::Ply), "ply"),
        (ExportFormat::Model(formats::ModelFormat::Stl), "stl"),
    ] {
        let file = s.file(format);
        let mut other = Workspace::default();
        let opened = json(&other.open(&format!("plant.{word}"), &file, 0, false).unwrap());
        assert_eq!(opened["kind"], "model");
        let view = look(&mut other);
        assert!(!view["parts"].as_array().unwrap().is_empty() && view["max"][1].as_f64().unwrap() > 0.1);
        assert!(other.file(ExportFormat::Model(formats::ModelFormat::Glb)).starts_with(b"glTF"));
        let structure = ExportRequest {
            format: ExportFormat::Structure(formats::StructureFormat::Mtg),
            ..ExportRequest::default()
        };
        assert!(matches!(other.export(&structure, &run()), Err(WorkspaceError::Format("mtg"))));
    }
    assert!(s.file(ExportFormat::Model(formats::ModelFormat::Obj)).starts_with(b"PK"));
    let drawing = s.file(ExportFormat::Drawing(formats::DrawingFormat::Json));
    assert_eq!(json(&Workspace::default().open("d.json", &drawing, 0, false).unwrap())["kind"], "drawing");
    let two = concat!(
        r#"{"word":"a","drawing":[[[0,9],[0,90]]]}"#,
        "\nbad\n",
        r#"{"word":"b","drawing":[[[0,5],[0,70]]]}"#,
        "\n"
    );
    let opened = json(&s.open("two.ndjson", two.as_bytes(), 1, false).unwrap());
    assert_eq!((opened["names"].as_array().unwrap().len(), &opened["name"]), (2, &opened["names"][1]));
}

#[test]
fn looks_at_a_draft_keep_what_the_whole_drawing_was_understood_as() {
    let mut whole = Workspace::default();
    whole.open("sample.svg", &sample(), 0, false).unwrap();
    let said = |view: &Value| -> Vec<(Value, Value)> {
        let rows = view["item"]["strokes"].as_array().unwrap();
        rows.iter().map(|r| (r["class"].clone(), r["confidence"].clone())).collect()
    };
    let mut s = Workspace::default();
    let mut changes = 0;
    let mut before = Vec::new();
    for id in whole.fresh_strokes() {
        let rows = whole.stroke_points(id);
        for part in [rows.len() / 2, rows.len()] {
            s.draft(line(&rows[..part]));
            let now = said(&look(&mut s));
            assert_eq!(now[..before.len()], before, "{id:?}");
        }
        s.add_stroke(line(&rows), Vec::new()).unwrap();
        let now = said(&look(&mut s));
        changes += usize::from(now[..before.len()] != before[..]);
        before = now;
    }
    assert!(changes > 0, "a stroke that comes later changes what an earlier one is");
}

/// A stroke has the class that the person gave to the pen: under the pen, in the document and in one step of undo.
#[test]
fn a_pen_that_was_told_what_it_draws_draws_that() {
    let vein = || NewStroke { class: Some(StrokeClass::Vein), ..NewStroke::from(stem()) };
    let mut s = Workspace::default();
    s.draft(vein());
    let row = look(&mut s)["item"]["strokes"][0].clone();
    assert_eq!((row["class"].as_str(), row["source"].as_str()), (Some("vein"), Some("user")));
    s.add_stroke(vein(), Vec::new()).unwrap();
    assert_eq!(s.document().plants()[0].strokes()[0].class, Some(StrokeClass::Vein));
    assert_eq!(look(&mut s)["item"]["strokes"][0]["source"], "user");
    assert_eq!(json(&s.state())["steps"], 1);
}

/// Undo gives back what the hand drew, and then takes it away.
#[test]
fn a_straightened_stroke_is_a_step_after_the_drawn_one() {
    let mut s = Workspace::default();
    let id = s.add_stroke(stem(), Vec::new()).unwrap();
    let drawn = s.stroke_points(id);
    s.run(SketchCommand::SetClass(vec![id], Some(StrokeClass::Axis)).for_plant(PlantId(0))).unwrap();
    s.straighten(id, line(&[(0.0, 0.0), (0.0, 195.0)]).samples).unwrap();
    assert_eq!(
        s.stroke_points(id).iter().map(|p| (p.0, p.1)).collect::<Vec<_>>(),
        [(0.0, 0.0), (0.0, 195.0)]
    );
    assert_eq!(
        s.document().plants()[0].strokes()[0].class,
        Some(StrokeClass::Axis),
        "what was said of it stays"
    );
    assert!(s.straighten(id, Vec::new()).is_err());
    assert!(s.straighten(StrokeId(9), stem().samples).is_err());
    assert!(s.straighten(id, line(&[(f64::NAN, 0.0)]).samples).is_err());
    assert_eq!(s.undo(), Some("straighten"));
    assert_eq!(s.stroke_points(id), drawn);
}

#[test]
fn a_drag_is_staged_and_a_draft_leaves_no_trace() {
    let mut s = Workspace::default();
    let id = s.add_stroke(stem(), Vec::new()).unwrap();
    s.begin("move").unwrap();
    s.stage(SketchCommand::MoveStrokes(vec![id], DVec2::new(5.0, 1.0)).for_plant(PlantId(0))).unwrap();
    s.stage(SketchCommand::MoveStrokes(vec![id], DVec2::new(50.0, 0.0)).for_plant(PlantId(0))).unwrap();
    s.commit();
    assert_eq!(s.stroke_points(id)[0].0, 50.0);
    assert_eq!(json(&s.state())["steps"], 2);
    let before = look(&mut s);
    let contour = line(&[(0.0, 0.0), (40.0, 0.0), (40.0, 40.0)]);
    s.draft(Stroke { mode: StrokeMode::LeafContour, ..contour });
    assert_eq!(look(&mut s)["item"]["strokes"].as_array().unwrap().len(), 2);
    s.draft(line(&[]));
    let after = look(&mut s);
    assert_eq!(before["item"]["digest"], after["item"]["digest"]);
    assert!(serde_json::from_str::<Command>(r#"{"sketch":[0,{"explode":1}]}"#).is_err());
}

fn photo() -> Vec<u8> {
    let pixels: Vec<u8> = (0..64).flat_map(|k| [200, 3 * (k % 8), 3 * (k / 8), 255]).collect();
    let mut png = Vec::new();
    formats::write_png(8, 8, &pixels, &mut png).unwrap();
    png
}

fn names(view: &Value) -> Vec<String> {
    view["parts"].as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn organs_wear_materials_by_kind_and_by_stroke_and_files_keep_them() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, true).unwrap();
    let plain = look(&mut s);
    s.ask(r##"{"plant":[0,{"wear":["petal",{"pattern":"picotee","color":"#ffffff","second":"#c02050"}]}]}"##)
        .unwrap();
    let worn = look(&mut s);
    assert_eq!(worn["item"]["digest"], plain["item"]["digest"], "the plant is the same");
    assert_eq!(worn["stages"], json(&["mesh"]), "only the surface is made again");
    assert!(names(&worn).contains(&"petals-picotee-1".to_owned()), "{:?}", names(&worn));
    // One petal wears a picture.
    let strokes = plain["item"]["strokes"].as_array().unwrap();
    let petal = strokes.iter().find(|s| s["organ"] == "petal").unwrap()["index"].as_u64().unwrap();
    let id = StrokeId(u32::try_from(petal).unwrap());
    let material = OrganMaterial { roughness: 0.25, ..OrganMaterial::default() };
    assert!(s.wear_picture((Wearer::Petal, vec![id]), material.clone(), b"GIF").is_err());
    let steps = json(&s.state())["steps"].clone();
    s.wear_picture((Wearer::Petal, vec![id]), material, &photo()).unwrap();
    assert_eq!(json(&s.state())["steps"], steps.as_u64().unwrap() + 1, "one step");
    let pictured = look(&mut s);
    let parts = names(&pictured);
    assert!(
        parts.iter().any(|n| n == "petals-picture-2") && parts.iter().any(|n| n == "petals-picotee-1"),
        "{parts:?}"
    );
    let rough = pictured["materials"].as_array().unwrap().iter().find(|m| m["name"] == "petal-picture-2");
    let rough = rough.unwrap();
    assert_eq!((&rough["roughness"], &rough["texture"]["width"]), (&json(&0.25_f32), &json(&8)));
    let mut other = Workspace::default();
    other.open("p.burgeon", &s.save().unwrap(), 0, true).unwrap();
    assert_eq!(look(&mut other)["parts"], pictured["parts"]);
    assert_eq!(
        other.file(ExportFormat::Model(formats::ModelFormat::Glb)),
        s.file(ExportFormat::Model(formats::ModelFormat::Glb))
    );
    assert_eq!(other.document().plants()[0].wear(), s.document().plants()[0].wear());
    // A link has no room for pictures.
    other.open("l.burgeon", &s.share().unwrap(), 0, true).unwrap();
    assert!(names(&look(&mut other)).contains(&"petals-plain-2".to_owned()));
    // A material that is removed leaves no picture behind.
    s.ask(&format!(r#"{{"sketch":[0,{{"set-material":[[{petal}],null]}}]}}"#)).unwrap();
    assert!(s.document().plants()[0].settings().pictures.is_empty());
    for _ in 0..3 {
        assert_eq!(s.undo(), Some("material"));
    }
    assert_eq!(names(&look(&mut s)), names(&plain));
    // A day at which the petals differ from the drawn ones.
    s.ask(&format!(
        r#"{{"sketch":[0,{{"set-material":[{:?},{{"pattern":"speckled"}}]}}]}}"#,
        (0..15).collect::<Vec<_>>()
    ))
    .unwrap();
    s.ask(r#"{"sketch":[0,{"set-day":3}]}"#).unwrap();
    assert!(names(&look(&mut s)).contains(&"petals-speckled-1".to_owned()));
}

#[test]
fn trees_flowers_and_measured_leaves_wear_materials_too() {
    for (maker, wearer, part) in [
        (NewMaker::Tree("birch".into()), "leaf", "leaves-streaked-1"),
        (NewMaker::Flower("lily".into()), "petal", "petals-streaked-1"),
    ] {
        let mut s = Workspace::default();
        s.act(&Action::Add { name: "a".into(), maker }).unwrap();
        let id = s.current().unwrap().0;
        s.ask(&format!(r#"{{"plant":[{id},{{"wear":["{wearer}",{{"pattern":"streaked"}}]}}]}}"#)).unwrap();
        let view = look(&mut s);
        assert!(names(&view).contains(&part.to_owned()), "{:?}", names(&view));
        let glb = s.file(ExportFormat::Model(formats::ModelFormat::Glb));
        assert!(String::from_utf8_lossy(&glb).contains(&format!("{wearer}-streaked-1")));
    }
}

#[test]
fn layers_hide_lock_and_travel() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, true).unwrap();
    let plain = look(&mut s);
    let petal = plain["item"]["strokes"].as_array().unwrap().iter().find(|s| s["organ"] == "petal").unwrap();
    let petal = petal["index"].as_u64().unwrap();
    s.ask(r#"{"sketch":[0,{"add-layer":"notes"}]}"#).unwrap();
    s.ask(r#"{"sketch":[0,{"add-layer":"notes"}]}"#).unwrap_err();
    s.ask(&format!(r#"{{"sketch":[0,{{"put-on":[[{petal}],"notes"]}}]}}"#)).unwrap();
    assert_eq!(look(&mut s)["item"]["digest"], plain["item"]["digest"]);
    s.ask(r#"{"sketch":[0,{"set-layer":[0,{"name":"aside","hidden":true}]}]}"#).unwrap();
    let hidden = look(&mut s);
    assert_eq!(
        hidden["item"]["counts"]["petals"].as_u64().unwrap() + 1,
        plain["item"]["counts"]["petals"].as_u64().unwrap()
    );
    assert!(s.ask(&format!(r#"{{"sketch":[0,{{"remove-strokes":[{petal}]}}]}}"#)).is_err(), "out of reach");
    let strokes = s.document().plants()[0].strokes().len();
    s.ask(r#"{"sketch":[0,"clear"]}"#).unwrap();
    assert_eq!((s.document().plants()[0].strokes().len(), s.undo()), (1, Some("clear")));
    // Files keep them; in an SVG the hidden one comes last.
    let svg = s.file(ExportFormat::Drawing(formats::DrawingFormat::Svg));
    let mut other = Workspace::default();
    other.open("p.burgeon", &s.save().unwrap(), 0, true).unwrap();
    assert_eq!(look(&mut other)["item"]["digest"], hidden["item"]["digest"]);
    other.open("d.svg", &svg, 0, true).unwrap();
    let plant = &other.document().plants()[0];
    assert_eq!((plant.strokes().len(), plant.layers()), (strokes, s.document().plants()[0].layers()));
    assert_eq!(plant.strokes()[strokes - 1].stroke.layer.as_deref(), Some("aside"));
    // A new stroke on it is refused, one on the sheet is not; without the layer its strokes are visible again.
    let on = Stroke { layer: Some("aside".into()), width: Some(3.0), ..stem() };
    assert!(s.add_stroke(on.clone(), Vec::new()).is_err());
    s.ask(r#"{"sketch":[0,{"remove-layer":0}]}"#).unwrap();
    assert_eq!(look(&mut s)["item"]["digest"], plain["item"]["digest"]);
    let id = s.add_stroke(on, Vec::new()).unwrap();
    assert_eq!((s.stroke(id).unwrap().layer.as_ref(), s.stroke(id).unwrap().width), (None, Some(3.0)));
}

#[test]
fn the_width_of_a_pen_is_no_matter_for_the_plant() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, true).unwrap();
    let before = look(&mut s);
    s.ask(r#"{"sketch":[0,{"set-width":[[0,1,2],9.5]}]}"#).unwrap();
    assert_eq!(look(&mut s)["item"]["digest"], before["item"]["digest"]);
    assert!(s.ask(r#"{"sketch":[0,{"set-width":[[0],-1]}]}"#).is_err());
    assert_eq!(
        (json(&s.state())["plants"][0]["sketch"]["strokes"][1]["width"].as_f64(), s.undo()),
        (Some(9.5), Some("width"))
    );
}

#[test]
fn traced_organs_take_the_photograph_and_others_do_not() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, true).unwrap();
    let plain = look(&mut s);
    assert!(s.place_photo(b"GIF", DVec2::ZERO, 1.0).is_err());
    s.place_photo(&photo(), DVec2::splat(-1e4), 2e4).unwrap();
    assert_eq!((s.fresh_photo().as_deref(), s.fresh_photo()), (Some(&photo()[..]), None));
    let traced = look(&mut s);
    assert_eq!(traced["item"]["digest"], plain["item"]["digest"], "the plant is the same");
    assert_eq!(traced["stages"].as_array().unwrap().len(), 1, "only the surface is made again");
    assert!(names(&traced).contains(&"petals-traced".to_owned()), "{:?}", names(&traced));
    let part = names(&traced).iter().position(|n| n == "petals-traced").unwrap();
    let uvs = s.column(PlantId(0), part, Column::Uvs);
    assert_eq!(uvs.len() / 2, s.column(PlantId(0), part, Column::Positions).len() / 3);
    assert!(uvs.iter().all(|x| (0.0..=1.0).contains(x)));
    // A small photograph far away traces nothing; neither does one that does not paint.
    s.ask(r#"{"sketch":[0,{"place-photo":{"x":-9000,"y":-9000,"width":1,"opacity":0.5,"paint":true}}]}"#)
        .unwrap();
    assert_eq!(names(&look(&mut s)), names(&plain));
    s.ask(r#"{"sketch":[0,{"place-photo":{"x":-1e4,"y":-1e4,"width":2e4,"opacity":0.2,"paint":false}}]}"#)
        .unwrap();
    assert_eq!(names(&look(&mut s)), names(&plain));
    let mut other = Workspace::default();
    other.open("p.burgeon", &s.save().unwrap(), 0, true).unwrap();
    assert_eq!(other.fresh_photo().as_deref(), Some(&photo()[..]));
    s.ask(r#"{"sketch":[0,"remove-photo"]}"#).unwrap();
    assert!(
        s.ask(r#"{"sketch":[0,{"place-photo":{"x":0,"y":0,"width":1,"opacity":0.2,"paint":true}}]}"#)
            .is_err()
    );
    assert_eq!(s.undo(), Some("photo"));
}

const BUSH: &str = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 200\nlifespan = 1\n";

fn marks() -> Vec<u8> {
    std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/leaves/leaf1.csv")).unwrap()
}

/// Returns name, digest and problem of every plant.
fn scene(s: &mut Workspace) -> Vec<(String, String, Value)> {
    let state = json(&s.state());
    let view = json(&s.evaluate(&run()).unwrap());
    let both = state["plants"].as_array().unwrap().iter().zip(view["plants"].as_array().unwrap());
    let word = |v: &Value| v.as_str().unwrap_or_default().to_owned();
    both.map(|(p, v)| (word(&p["name"]), word(&v["item"]["digest"]), v["error"]["message"].clone())).collect()
}

#[test]
fn a_drawn_flower_opens_and_closes() {
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, true).unwrap();
    let drawn = look(&mut s);
    s.ask(r#"{"sketch":[0,{"set-day":0}]}"#).unwrap();
    let bud = look(&mut s);
    assert!(bud["fresh"].as_bool().unwrap() && bud["error"].is_null(), "{}", bud["error"]);
    let days = bud["days"].as_array().unwrap();
    assert_eq!((days.len(), &bud["item"]["digest"]), (2, &drawn["item"]["digest"]));
    let closed = s.column(PlantId(0), 0, Column::Positions).to_vec();
    s.ask(r#"{"sketch":[0,{"set-day":6}]}"#).unwrap();
    s.evaluate(&run()).unwrap();
    let last = s.model(PlantId(0)).unwrap().parts.len() - 1;
    let open = s.column(PlantId(0), last, Column::Positions);
    assert!(!open.is_empty() && closed != *open);
    s.undo();
    s.undo();
    assert_eq!(look(&mut s)["parts"], drawn["parts"]);
    // A plant that was removed from the page returns with its meshes.
    s.act(&Action::New).unwrap();
    assert!(look(&mut s)["parts"].as_array().unwrap().is_empty());
    s.undo();
    let back = look(&mut s);
    assert!(back["fresh"].as_bool().unwrap() && back["parts"] == drawn["parts"]);
}

#[test]
fn a_tree_where_another_document_had_a_drawing() {
    let (mut grown, _) = bush();
    let project = grown.save().unwrap();
    let mut s = Workspace::default();
    s.open("sample.svg", &sample(), 0, true).unwrap();
    look(&mut s);
    s.open("bush.burgeon", &project, 0, false).unwrap();
    let (here, there) = (look(&mut s), look(&mut grown));
    assert_eq!((&here["parts"], &here["max"]), (&there["parts"], &there["max"]));
    s.undo();
    assert!(look(&mut s)["front"].is_object());
}

/// Returns a pointer in front of the plant, looking along -Z at (x, y).
fn pointer_at(x: f64, y: f64) -> String {
    format!(r#"{{"origin":[{x},{y},9],"direction":[0,0,-1],"forward":[0,0,-1],"up":[0,1,0],"pressure":1}}"#)
}

const REACH: &str = r#"{"metres":0.05,"per_metre":0,"bearers":0}"#;

fn hand(s: &mut Workspace, tool: &str, input: &str) -> Value {
    let read = |text| serde_json::from_str(text).unwrap();
    json(
        &s.shape(read(tool), serde_json::from_str(REACH).unwrap(), serde_json::from_str(input).unwrap())
            .unwrap(),
    )
}

/// Makes a gesture from one place to another and returns its answer, with the command for it.
fn gesture(s: &mut Workspace, tool: &str, from: (f64, f64), to: (f64, f64)) -> Value {
    hand(s, tool, &format!(r#"{{"down":{}}}"#, pointer_at(from.0, from.1)));
    hand(s, tool, &format!(r#"{{"move":[{}]}}"#, pointer_at(to.0, to.1)));
    hand(s, tool, &format!(r#"{{"up":{}}}"#, pointer_at(to.0, to.1)))
}

/// Makes a bush, and returns the middle of one of its branches as the viewer sees it.
fn bush() -> (Workspace, (f64, f64)) {
    let mut s = Workspace::default();
    s.open("bush.toml", BUSH.as_bytes(), 0, false).unwrap();
    s.evaluate(&run()).unwrap();
    let plant = s.scene.get(PlantId(1)).unwrap().plant.unwrap();
    let branch = plant.axes.iter().position(|a| a.order == 1).unwrap();
    let points = plant.axis_points(burgeon::plant::AxisId::new(branch));
    let middle = points[points.len() / 2];
    (s, (middle.x, middle.y))
}

#[test]
fn an_impossible_tree_is_an_error_on_the_page_and_the_last_one_stays() {
    let (mut s, _) = bush();
    let before = scene(&mut s);
    assert!(before[0].2.is_null() && !s.scene.get(PlantId(1)).unwrap().model.parts.is_empty());
    // Within the limits of the command line, but beyond those of a page, which has a quarter of them.
    s.ask(r#"{"tree":[1,{"set-field":["/method",{"kind":"competition","points":600000}]}]}"#).unwrap();
    let said = scene(&mut s)[0].2.as_str().unwrap().to_owned();
    assert!(said.contains("600,000 attraction points") && said.contains("500,000"), "{said}");
    assert!(!said.contains("--budget"), "a page has no options: {said}");
    assert!(!s.scene.get(PlantId(1)).unwrap().model.parts.is_empty());
    s.undo();
    assert_eq!(scene(&mut s), before);
}

#[test]
fn edits_survive_a_file_and_say_when_their_branch_is_gone() {
    let (mut s, (x, y)) = bush();
    for tool in [
        r#"{"prune":{"whole":false}}"#,
        r#""regrow""#,
        r#"{"sketch":{"twigs":1,"tilt_deg":20}}"#,
        r#"{"brush":{"radius_m":0.4,"density":1}}"#,
        r#"{"leaves":{"radius_m":0.5,"keep":0.2}}"#,
        r#""move""#,
    ] {
        let made = gesture(&mut s, tool, (x, y), (x + 0.4, y + 0.5));
        assert!(made["commit"].is_object(), "{tool}: {made}");
        s.ask(&format!(r#"{{"shape":[1,{{"add":{}}}]}}"#, made["commit"])).unwrap();
        look(&mut s);
    }
    let shaped = look(&mut s);
    let told = shaped["item"]["edits"].as_array().unwrap();
    assert_eq!(told.len(), 6);
    assert!(told.iter().take(5).all(|e| e["done"] == true), "{told:?}");
    let mut other = Workspace::default();
    other.open("x.burgeon", &s.save().unwrap(), 0, true).unwrap();
    assert_eq!(look(&mut other)["item"]["digest"], shaped["item"]["digest"]);
    // One edit is left out, by its row; the others keep their numbers.
    s.ask(r#"{"shape":[1,{"leave":[0,true]}]}"#).unwrap();
    let left = look(&mut s);
    assert_eq!(
        (left["item"]["edits"][0]["index"].as_u64(), left["item"]["edits"].as_array().unwrap().len()),
        (Some(1), 5)
    );
    s.ask(r#"{"shape":[1,{"remove":[0,1,2,3,4,5]}]}"#).unwrap();
    s.ask(r#"{"shape":[1,{"add":{"op":"prune","axis":{"mark":{"id":"0","kind":"wood","order":9,"base":[0,9,0],"direction":[1,0,0],"length":9}}}}]}"#).unwrap();
    let gone = look(&mut s);
    assert_eq!(gone["item"]["edits"][0]["code"], "branch-gone");
    assert!(
        gone["item"]["warnings"][0].as_str().unwrap().contains("edit 0 by hand (prune): not done"),
        "{gone}"
    );
    assert!(s.ask(r#"{"shape":[1,{"add":{"op":"prune","axis":{"path":[0]},"at":7}}]}"#).is_err());
    // Nothing is grown again for an edit.
    s.ask(r#"{"shape":[1,{"add":{"op":"prune","axis":{"path":[0,0]}}}]}"#).unwrap();
    let pruned = look(&mut s);
    assert_eq!(pruned["stages"], serde_json::json!(["shape", "mesh"]));
}

#[test]
fn warnings_are_told_with_their_codes() {
    let mut s = Workspace::default();
    // A house is not a plant.
    let house: [&[(f64, f64)]; 4] = [
        &[(0.0, 0.0), (0.0, 60.0), (100.0, 60.0), (100.0, 0.0), (0.0, 0.0)],
        &[(-8.0, 60.0), (50.0, 110.0), (108.0, 60.0)],
        &[(40.0, 0.0), (40.0, 35.0), (60.0, 35.0), (60.0, 0.0)],
        &[(12.0, 25.0), (12.0, 45.0), (30.0, 45.0), (30.0, 25.0), (12.0, 25.0)],
    ];
    for wall in house {
        s.add_stroke(line(wall), Vec::new()).unwrap();
    }
    let view = s.evaluate(&run()).unwrap();
    let warned = view.plants.iter().flat_map(|p| &p.warnings).map(|w| w.code).collect::<Vec<_>>();
    assert!(!warned.is_empty() && warned.iter().all(|c| !c.is_empty()), "{warned:?}");
    for plant in &view.plants {
        let messages: Vec<&String> = plant.warnings.iter().map(|w| &w.message).collect();
        assert_eq!(messages, plant.item.iter().flat_map(|i| &i.warnings).collect::<Vec<_>>());
    }
}

/// Makes a scene of one flower.
fn flower() -> Workspace {
    let mut s = Workspace::default();
    s.act(&Action::Add { name: "a lily".into(), maker: NewMaker::Flower("lily".into()) }).unwrap();
    s
}

#[test]
fn branches_are_walked_by_keys() {
    let mut s = Workspace::default();
    let bush = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 100\nlifespan = 1\n";
    s.open("bush.toml", bush.as_bytes(), 0, false).unwrap();
    s.evaluate(&run()).unwrap();
    let mut walk = |from: Option<u32>, to: ShapeStep| {
        let input = ShapeInput::Walk { from, to };
        s.shape(ToolKind::Pick, ShapeReach::default(), input).unwrap().picked.unwrap()
    };
    let stem = walk(None, ShapeStep::Next);
    assert!(stem.stands && stem.key.is_some());
    let first = walk(Some(stem.axis), ShapeStep::Borne);
    assert!(first.axis != stem.axis && first.order == stem.order + 1);
    assert_eq!(walk(Some(first.axis), ShapeStep::Bearer), stem);
    // Walks round all that the stem bears, and back.
    let mut seen = vec![first.axis];
    loop {
        let next = walk(seen.last().copied(), ShapeStep::Next).axis;
        if next == first.axis {
            break;
        }
        assert!(!seen.contains(&next));
        seen.push(next);
    }
    assert!(seen.len() > 1, "{seen:?}");
    assert_eq!(walk(Some(first.axis), ShapeStep::Previous).axis, seen[seen.len() - 1]);
}

#[test]
fn a_model_that_is_looked_at_is_closed_and_the_scene_is_there_again() {
    let mut s = flower();
    let file = s.file(ExportFormat::Model(formats::ModelFormat::Glb));
    s.evaluate(&run()).unwrap();
    s.open("x.glb", &file, 0, false).unwrap();
    assert!(s.evaluate(&run()).unwrap().guest.is_some());
    s.act(&Action::CloseModel).unwrap();
    let view = s.evaluate(&run()).unwrap();
    assert!(view.guest.is_none() && !view.plants[0].parts.is_empty());
}
