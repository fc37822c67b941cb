//! Readers of drawings on whole files: real ones, large ones, wrong ones.

use crate::effort::Effort;
use crate::missing;
use formats::{
    DrawingError, DrawingFormat, DrawingSummary, ReadDrawing, read_drawings, write_drawing, write_svg,
};
use glam::DVec2;
use ink::{Drawing, InkSample, Layer, Stroke, StrokeMode};

fn all(bytes: &[u8], format: DrawingFormat) -> Vec<Result<ReadDrawing, DrawingError>> {
    read_drawings(bytes, format, "file").collect()
}

fn error(bytes: &[u8], format: DrawingFormat) -> String {
    all(bytes, format).remove(0).expect_err("refused").to_string()
}

#[test]
fn ndjson_yields_good_lines_and_names_bad_ones() {
    let text = "{\"word\":\"house plant\",\"key_id\":\"77\",\"drawing\":[[[1,2],[3,4],[0,9]]]}\n\nnot json\n\
                {\"word\":\"leaf\",\"drawing\":[[[1,2,3],[3,4]]]}\n{\"key_id\":5,\"drawing\":[]}\n{\"drawing\":[[[7],[8]]]}";
    let items = all(text.as_bytes(), DrawingFormat::Ndjson);
    let told: Vec<String> = items
        .iter()
        .map(|i| i.as_ref().map_or_else(ToString::to_string, |r| r.drawing.name.clone()))
        .collect();
    assert_eq!(told[0], "house-plant-77");
    assert!(told[1].starts_with("ndjson, line 3, column 2: "), "{}", told[1]);
    assert!(told[2].contains("line 4, stroke 0: it has 3 x but 2 y"), "{}", told[2]);
    assert!(told[3].contains("line 5: there is no stroke"), "{}", told[3]);
    assert_eq!(told[4], "file-6");
    let first = &items[0].as_ref().expect("good").drawing.strokes[0].samples[1];
    assert_eq!(*first, InkSample { at: DVec2::new(2.0, -4.0), time_ms: Some(9.0), pressure: None });
}

#[test]
fn json_round_trip_keeps_everything() {
    let sample = |x: f64, time_ms, pressure| InkSample { at: DVec2::new(x, -x / 3.0), time_ms, pressure };
    let drawing = Drawing {
        name: "a \"quoted\" name".into(),
        strokes: vec![
            Stroke {
                samples: vec![
                    sample(0.1, Some(0.0), Some(0.5)),
                    sample(1e-9, None, Some(1.0)),
                    sample(3e200, Some(7.5), None),
                ],
                mode: StrokeMode::LeafContour,
                color: Some([1, 171, 255]),
                width: Some(2.5),
                layer: Some("petals & co".into()),
                hidden: true,
                id: Some("s<1>".into()),
            },
            Stroke {
                samples: vec![sample(5.0, None, None)],
                mode: StrokeMode::BranchContour,
                ..Stroke::default()
            },
            Stroke { samples: vec![], ..Stroke::default() },
        ],
        layers: vec![Layer { name: "petals & co".into(), hidden: true, locked: true }],
    };
    let mut bytes = Vec::new();
    write_drawing(&drawing, &mut bytes).expect("writes");
    assert_eq!(all(&bytes, DrawingFormat::Json).remove(0).expect("reads").drawing, drawing);
    assert_eq!(DrawingFormat::sniff(&bytes), Some(DrawingFormat::Json));
}

#[test]
fn wrong_json_says_what_where_and_what_to_do() {
    for (text, want) in [
        ("{\"burgeon\":\"drawing/1\",\n\"strokes\":[{\"points\":[[1,NaN]]}]}", "line 2, column"),
        ("{\"burgeon\":\"drawing/9\",\"strokes\":[]}", "drawing/9"),
        ("{\"strokes\":[]}", "\"burgeon\" is missing"),
        (
            "{\"burgeon\":\"drawing/1\",\"strokes\":[{\"points\":[[1]]}]}",
            "stroke 0, point 0: x or y is missing",
        ),
        (
            "{\"burgeon\":\"drawing/1\",\"strokes\":[{\"mode\":\"crown\",\"points\":[]}]}",
            "\"crown\" is unknown",
        ),
        ("{\"burgeon\":\"drawing/1\",\"strokes\":[", "cut off"),
        ("{\"burgeon\":\"drawing/1\",\"strokes\":[{\"points\":[[1,1e999]]}]}", "out of range"),
        ("{\"burgeon\":\"drawing/1\",\"strokes\":[]}", "no stroke"),
        ("   \n", "empty"),
    ] {
        let e = error(text.as_bytes(), DrawingFormat::Json);
        assert!(e.starts_with("drawing JSON") && e.contains(want), "{want} in {e}");
    }
    assert!(error(&[0xff, 0x41, 0x42], DrawingFormat::Json).contains("not UTF-8"));
    assert!(error(&b"[".repeat(100_000), DrawingFormat::Json).len() < 300);
    assert!(error(&b"{\"drawing\":[[[".repeat(50_000), DrawingFormat::Ndjson).len() < 300);
}

#[test]
fn empty_files_and_wrong_formats_are_errors() {
    for format in DrawingFormat::ALL {
        assert!(error(b"", format).contains("empty"), "{format:?}");
        error(b"\x89PNG\r\n\x1a\n", format);
    }
    assert!(error(b"<html></html>", DrawingFormat::Svg).contains("<html>, not <svg>"));
    assert!(error(b"<svg/>", DrawingFormat::InkMl).contains("not <ink>"));
}

#[test]
fn utf16_with_a_mark_is_read() {
    let text = "<svg><path id='bl\u{e4}tt' stroke='red' d='M0 0L1 1'/></svg>";
    let mut bytes = vec![0xff, 0xfe];
    text.encode_utf16().for_each(|u| bytes.extend(u.to_le_bytes()));
    let read = all(&bytes, DrawingFormat::Svg).remove(0).expect("reads");
    assert_eq!(read.drawing.strokes[0].id.as_deref(), Some("bl\u{e4}tt"));
}

#[test]
fn a_hundred_thousand_strokes_are_read() {
    let mut svg = String::from("<svg><g stroke='red'>");
    for i in 0..100_000 {
        svg += &format!("<path d='M{i} 0l1 2'/>");
    }
    svg += "</g></svg>";
    let read = all(svg.as_bytes(), DrawingFormat::Svg).remove(0).expect("reads");
    assert_eq!(read.drawing.strokes.len(), 100_000);
    let mut bytes = Vec::new();
    write_drawing(&read.drawing, &mut bytes).expect("writes");
    assert_eq!(all(&bytes, DrawingFormat::Json).remove(0).expect("reads").drawing, read.drawing);
}

#[test]
fn a_style_sheet_of_many_rules_does_not_slow_each_element() {
    let mut svg = String::from("<svg><style>");
    (0..200_000).for_each(|_| svg += "path{stroke:red}");
    svg += "</style>";
    (0..20_000).for_each(|_| svg += "<path d='M0 0L1 1'/>");
    svg += "</svg>";
    let effort = Effort::begin();
    let read = all(svg.as_bytes(), DrawingFormat::Svg).remove(0).expect("reads");
    assert_eq!(read.drawing.strokes[9].color, Some([255, 0, 0]));
    assert!(effort.spent().as_secs() < 10, "{:?}", effort.spent());
}

/// Every drawing of the shared data folder, where it is there.
#[test]
fn real_drawings_are_read() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/sketches");
    if !std::path::Path::new(folder).is_dir() {
        return missing::skipped(folder);
    }
    let mut counts = [0_usize; 2];
    for (row, sub) in ["quickdraw", "spg"].iter().enumerate() {
        let entries = std::fs::read_dir(format!("{folder}/{sub}")).expect("a folder");
        for path in entries.filter_map(Result::ok).map(|e| e.path()) {
            if path.extension().is_some_and(|e| e == "ndjson") {
                counts[row] += every_drawing(&path, row == 0);
            }
        }
    }
    assert_eq!(counts, [138, 1446], "every drawing");
}

#[test]
fn drawings_of_our_own_are_read_with_their_times_and_with_labels() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/ndjson");
    for (name, timed) in [("raw.ndjson", true), ("labelled.ndjson", false)] {
        assert_eq!(every_drawing(&folder.join(name), timed), 6, "{name}");
    }
}

/// Returns the number of drawings in a file, each with more than one point, and with or without times.
fn every_drawing(path: &std::path::Path, timed: bool) -> usize {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("opens"));
    let mut count = 0;
    for read in read_drawings(file, DrawingFormat::Ndjson, "d") {
        let read = read.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let info = DrawingSummary::from_drawing(&read.drawing, &read.warnings);
        assert!(info.points > 1 && info.not_finite == 0, "{info:?}");
        // Raw drawings have times; the labels in the third row of the others are none.
        assert_eq!(info.times, timed, "{}: {}", path.display(), info.name);
        count += 1;
    }
    count
}

/// Gives one good line, then fails for ever.
struct Failing(Vec<u8>);

impl std::io::Read for Failing {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.0.is_empty() {
            return Err(std::io::Error::other("the disk is gone"));
        }
        let n = buffer.len().min(self.0.len());
        buffer[..n].copy_from_slice(&self.0[..n]);
        self.0.drain(..n);
        Ok(n)
    }
}

#[test]
fn an_input_that_fails_ends() {
    let line = b"{\"word\":\"a\",\"drawing\":[[[1,2],[3,4]]]}\n{\"word\":".to_vec();
    let input = std::io::BufReader::new(Failing(line));
    let got: Vec<_> = read_drawings(input, DrawingFormat::Ndjson, "x").take(10).collect();
    assert_eq!(got.len(), 2, "{got:?}");
    assert!(got[0].is_ok() && got[1].as_ref().is_err_and(|e| e.to_string().contains("the disk is gone")));
}

#[test]
fn why_there_is_no_stroke_is_told() {
    for (body, part) in [
        ("<path stroke='red' display='none' d='M0 0L1 1'/>", "left out: hidden (1)"),
        ("<path stroke='red' d='MNaN 0L1 1'/>", "`d` is broken"),
        ("<text>leaf</text>", "left out: text (1)"),
    ] {
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg'>{body}</svg>");
        let message = error(text.as_bytes(), DrawingFormat::Svg);
        assert!(message.contains("no stroke") && message.contains(part), "{body}: {message}");
    }
    let nan = br#"{"burgeon":"drawing/1","strokes":[{"points":[[NaN,1],[2,3]]}]}"#;
    let message = error(nan, DrawingFormat::Json);
    assert!(
        message.contains("column 47") && message.contains("NaN") && message.contains("leave"),
        "{message}"
    );
}

#[test]
fn latin_1_is_read_where_xml_says_so() {
    let body =
        "<svg xmlns='http://www.w3.org/2000/svg'><path id='Bl\u{fc}te' stroke='red' d='M0 0L1 1'/></svg>";
    let bytes = |text: &str| text.chars().map(|c| u8::try_from(c).expect("Latin-1")).collect::<Vec<u8>>();
    let said = bytes(&format!("<?xml version='1.0' encoding='ISO-8859-1'?>{body}"));
    let read = all(&said, DrawingFormat::Svg).remove(0).expect("reads");
    assert_eq!(read.drawing.strokes[0].id.as_deref(), Some("Bl\u{fc}te"));
    let message = error(&bytes(body), DrawingFormat::Svg);
    assert!(message.contains("save it again as UTF-8"), "{message}");
}

/// Found by fuzzing: four kilobytes that become a million elements.
#[test]
fn nested_use_ends_soon() {
    let mut text =
        String::from("<svg xmlns='http://www.w3.org/2000/svg'><path id='u0' stroke='red' d='M0 0L1 1'/>");
    for i in 1..14 {
        let inner = format!("<use href='#u{}'/>", i - 1).repeat(10);
        text += &format!("<g id='u{i}'>{inner}</g>");
    }
    let effort = Effort::begin();
    let message = error((text + "</svg>").as_bytes(), DrawingFormat::Svg);
    assert!(message.contains("after expanding `use`"), "{message}");
    assert!(effort.spent().as_secs() < 5, "{:?}", effort.spent());
}

#[test]
fn svg_keeps_layers_widths_and_points() {
    let layer = |name: &str, hidden, locked| Layer { name: name.into(), hidden, locked };
    let stroke = |k: u8, layer: Option<&str>, hidden| Stroke {
        samples: (0..5)
            .map(|i| DVec2::new(f64::from(i * k) / 7.0, 0.1 * f64::from(i * i)))
            .map(Into::into)
            .collect(),
        color: Some([1, 2, k]),
        width: (k == 2).then_some(0.75),
        layer: layer.map(Into::into),
        hidden,
        mode: if k == 3 { StrokeMode::LeafContour } else { StrokeMode::Parts },
        id: Some(format!("s{k}")),
    };
    let drawing = Drawing {
        name: "a < b".into(),
        // Strokes on the sheet, then from below upwards; hidden ones last.
        strokes: vec![
            stroke(1, None, false),
            stroke(2, Some("leaf contour \"A\""), false),
            stroke(3, Some("top"), false),
            stroke(4, Some("notes"), true),
        ],
        layers: vec![
            layer("leaf contour \"A\"", false, true),
            layer("notes", true, false),
            layer("top", false, false),
            layer("empty", false, false),
        ],
    };
    let mut bytes = Vec::new();
    write_svg(&drawing, &mut bytes).expect("writes");
    let read = all(&bytes, DrawingFormat::Svg).remove(0).expect("reads");
    assert_eq!((read.drawing.strokes, read.drawing.layers), (drawing.strokes, drawing.layers));
    assert!(String::from_utf8_lossy(&bytes).contains("inkscape:groupmode=\"layer\""));
}

#[test]
fn what_is_hidden_changes_no_number_of_what_is_seen() {
    let file = |first: &str| {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:i='http://www.inkscape.org/namespaces/inkscape' \
             stroke='black'>{first}<g i:groupmode='layer' i:label='A' transform='scale(2)'>\
             <path stroke-width='3' d='M0 0L30 40'/></g></svg>"
        )
    };
    let hidden = "<g i:groupmode='layer' i:label='A' style='display:none'><path d='M0 0L1e6 5'/></g>";
    let plain = all(file("").as_bytes(), DrawingFormat::Svg).remove(0).expect("reads").drawing;
    let read = all(file(hidden).as_bytes(), DrawingFormat::Svg).remove(0).expect("reads").drawing;
    let [seen, unseen] = &read.strokes[..] else { panic!("{read:?}") };
    assert_eq!((&seen.samples, seen.width), (&plain.strokes[0].samples, Some(6.0)));
    assert_eq!(
        (seen.layer.as_deref(), unseen.layer.as_deref()),
        (Some("A 2"), Some("A")),
        "names of their own"
    );
    assert!(unseen.hidden && !seen.hidden && read.layers[0].hidden);
    let ink = |d: &Drawing| ink::clean(d, &mut base::Report::default());
    assert_eq!(ink(&read).strokes, ink(&plain).strokes, "and it is no part of the plant");
}
