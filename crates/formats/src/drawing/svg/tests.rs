use ink::StrokeMode;

use super::*;

fn drawing(body: &str) -> (Drawing, Vec<String>) {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
         xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' viewBox='0 0 100 100'>{body}</svg>"
    );
    let mut report = Report::default();
    let d = read(&text, "t", &mut report).unwrap_or_else(|e| panic!("{e}\n{text}"));
    (d, report.warnings.into_iter().map(|w| w.message).collect())
}

fn failure(body: &str) -> String {
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg'>{body}</svg>");
    read(&text, "t", &mut Report::default()).expect_err("refused").to_string()
}

fn ends(d: &Drawing) -> Vec<[[f64; 2]; 2]> {
    let end = |s: &Stroke| {
        [s.samples[0].at.to_array(), s.samples[s.samples.len() - 1].at.to_array()]
            .map(|p| p.map(|x| (x * 1e9).round() / 1e9 + 0.0))
    };
    d.strokes.iter().map(end).collect()
}

#[test]
fn shapes_become_strokes_with_y_up() {
    let (d, w) = drawing(
        "<g stroke='black' fill='none'><path d='M0 0C1 2 3 4 5 6M7 8l1 0'/><polyline points='1,2 3,4'/>\
         <polygon points='0 0 1 0 1 1'/><line x1='1' y1='2' x2='3' y2='4'/><rect x='1' y='1' width='2' height='3'/>\
         <rect x='1' y='1' width='20' height='30' rx='2'/><circle cx='5' cy='5' r='2'/><ellipse cx='5' cy='5' rx='2' ry='1'/></g>",
    );
    assert_eq!(w, Vec::<String>::new());
    assert_eq!(
        ends(&d),
        [
            [[0.0, 0.0], [5.0, -6.0]],
            [[7.0, -8.0], [8.0, -8.0]],
            [[1.0, -2.0], [3.0, -4.0]],
            [[0.0, 0.0], [0.0, 0.0]],
            [[1.0, -2.0], [3.0, -4.0]],
            [[1.0, -1.0], [1.0, -1.0]],
            [[3.0, -1.0], [3.0, -1.0]],
            [[7.0, -5.0], [7.0, -5.0]],
            [[7.0, -5.0], [7.0, -5.0]],
        ]
    );
    assert_eq!(d.strokes[3].samples.len(), 4, "a polygon comes back to its start");
}

#[test]
fn transforms_nest_and_use_is_placed() {
    let (d, _) = drawing(
        "<defs><g id='twig'><line id='l' x2='1' y2='0' stroke='#0a0'/></g></defs>\
         <g transform='translate(10 0)'><g transform='scale(2)'><use xlink:href='#twig' x='3' transform='rotate(90)'/></g></g>\
         <use href='#l' y='7'/>",
    );
    assert_eq!(ends(&d), [[[10.0, -6.0], [10.0, -8.0]], [[0.0, -7.0], [1.0, -7.0]]]);
    assert_eq!(d.strokes[0].color, Some([0, 170, 0]));
}

#[test]
fn modes_come_from_layers_ids_and_classes() {
    let (d, _) = drawing(
        "<g stroke='black' inkscape:label='Leaf Contour 2' id='layer1'><path d='M0 0L1 1'/>\
         <path id='branch_contour-3' d='M0 0L1 1'/><g id='parts'><path d='M0 0L1 1'/></g></g>\
         <path stroke='red' class='big leaf-contour' d='M0 0L1 1'/><path stroke='red' id='p9' d='M0 0L1 1'/>",
    );
    use StrokeMode::{BranchContour, LeafContour, Parts};
    let modes: Vec<StrokeMode> = d.strokes.iter().map(|s| s.mode).collect();
    assert_eq!(modes, [LeafContour, BranchContour, Parts, LeafContour, Parts]);
    assert_eq!(d.strokes[4].id.as_deref(), Some("p9"));
}

#[test]
fn colours_are_inherited_from_attributes_styles_and_sheets() {
    let (d, _) = drawing(
        "<style>/* x */ .a{stroke:#123456;fill:none} #b, .c { stroke: rgb(1,2,3) }</style>\
         <g style='stroke:#ff0000;fill:none'><path d='M0 0L1 1'/><path class='a' d='M0 0L1 1'/>\
         <path id='b' stroke='blue' d='M0 0L1 1'/><path stroke='green' style='stroke: currentColor' color='#010101' d='M0 0L1 1'/></g>\
         <path fill='#00ff00' d='M0 0L9 0L9 9Z'/>",
    );
    let colors: Vec<_> = d.strokes.iter().filter_map(|s| s.color).collect();
    assert_eq!(colors, [[255, 0, 0], [18, 52, 86], [1, 2, 3], [1, 1, 1], [0, 255, 0]]);
}

#[test]
fn what_is_not_seen_is_left_out_and_said() {
    let (d, w) = drawing(
        "<rect width='100%' height='100%' fill='white'/><g display='none'><path stroke='red' d='M0 0L1 1'/></g>\
         <path visibility='hidden' stroke='red' d='M0 0L1 1'/><path fill='none' d='M0 0L1 1'/>\
         <text>hello</text><image/><use href='#nothing'/><clipPath><path stroke='red' d='M0 0L1 1'/></clipPath>\
         <path id='seen' stroke='red' d='M0 0L1 1'/>",
    );
    assert_eq!(d.strokes.len(), 1);
    let all = w.join("\n");
    for word in [
        "1 lines belong to the paper",
        "hidden (2)",
        "without stroke and fill (1)",
        "text (1)",
        "image (1)",
        "not in the file (1)",
    ] {
        assert!(all.contains(word), "{word} in {all}");
    }
}

#[test]
fn broken_path_data_is_named_and_the_rest_kept() {
    let (d, w) = drawing("<g stroke='red'>\n<path id='p' d='M0 0L1 1L2'/><path d='M5 5L6 6'/></g>");
    assert_eq!(ends(&d), [[[0.0, 0.0], [1.0, -1.0]], [[5.0, -5.0], [6.0, -6.0]]]);
    assert!(w[0].contains("line 2, <path> `p`: the attribute `d` is broken"), "{w:?}");
}

#[test]
fn use_bombs_are_refused() {
    let mut body = String::from("<defs><path id='u0' d='M0 0L1 1' stroke='red'/>");
    for i in 1..12 {
        let uses = format!("<use href='#u{}'/>", i - 1).repeat(10);
        body += &format!("<g id='u{i}'>{uses}</g>");
    }
    let m = failure(&format!("{body}</defs><use href='#u11'/>"));
    assert!(m.contains("after expanding `use`"), "{m}");
}

#[test]
fn a_use_that_refers_to_itself_loses_itself_only() {
    let (d, w) = drawing(
        "<g stroke='red'><g id='a'><path d='M0 0L1 1'/><use href='#b'/></g><g id='b'><use href='#a'/></g>\
         <use id='s' href='#s'/><path d='M5 5L6 6'/></g>",
    );
    assert!(ends(&d).contains(&[[0.0, 0.0], [1.0, -1.0]]) && ends(&d).contains(&[[5.0, -5.0], [6.0, -6.0]]));
    assert!(w.iter().any(|w| w.contains("use that refers to itself")), "{w:?}");
}

#[test]
fn invisible_ink_is_left_out_and_said() {
    let (d, w) = drawing(
        "<defs><clipPath id='c'><rect width='9' height='9'/></clipPath></defs>\
         <g stroke='red' fill='none'><g opacity='0'><path d='M1 1L2 2'/></g><path stroke-width='0' d='M1 1L2 2'/>\
         <path stroke-opacity='0' d='M1 1L2 2'/><path stroke='#f000' d='M1 1L2 2'/>\
         <path clip-path='url(#c)' d='M20 20L30 30'/><path clip-path='url(#c)' d='M5 5L30 30'/>\
         <path d='M200 200L300 300'/><path d='M50 50L60 60'/><path d='M50 50L60 70'/></g>",
    );
    assert_eq!(d.strokes.len(), 3, "{:?}", ends(&d));
    let all = w.join("\n");
    for word in
        ["invisible (3)", "clipped away (1)", "1 shapes lie outside the sheet", "without stroke and fill (1)"]
    {
        assert!(all.contains(word), "{word} in {all}");
    }
}

#[test]
fn styles_of_css_place_and_paint() {
    let (d, w) = drawing(
        "<style>g.a > .p { stroke: #010203 } .a .q .p { stroke: #040506 } .turned { transform: rotate(90deg); \
         transform-origin: 10px 10px }</style><g class='a' fill='none' stroke='red'><path class='p' d='M0 0L1 1'/>\
         <g class='q'><g><path class='p' d='M0 0L1 1'/></g></g><path class='turned' d='M10 10L20 10'/></g>",
    );
    assert_eq!(w, Vec::<String>::new());
    let colors: Vec<_> = d.strokes.iter().filter_map(|s| s.color).collect();
    assert_eq!(colors, [[1, 2, 3], [4, 5, 6], [255, 0, 0]]);
    assert_eq!(ends(&d)[2], [[10.0, -10.0], [10.0, -20.0]]);
}

#[test]
fn gradients_give_their_mean() {
    let (d, _) = drawing(
        "<linearGradient id='g'><stop stop-color='#000000'/><stop style='stop-color:#ff0000'/></linearGradient>\
         <radialGradient id='h' href='#g'/><path fill='url(#h)' d='M0 0L30 0L30 40L2 50Z'/>",
    );
    assert_eq!(d.strokes[0].color, Some([128, 0, 0]));
}

#[test]
fn a_gradient_that_fades_out_has_the_colour_that_is_seen_and_casts_no_outline() {
    let (d, _) = drawing(
        "<linearGradient id='g'><stop style='stop-color:#0000ff;stop-opacity:1'/>\
         <stop stop-color='#ff0000' stop-opacity='0'/></linearGradient>\
         <path fill='url(#g)' d='M0 0L30 0L30 40L2 50Z'/>",
    );
    assert_eq!(d.strokes[0].color, Some([0, 0, 255]));
    let plant = "<path fill='#00b300' d='M20 10L40 10L36 80L24 80Z'/>";
    let shadow = "<radialGradient id='s'><stop/><stop stop-opacity='0'/></radialGradient>\
                  <ellipse fill='url(#s)' cx='30' cy='78' rx='20' ry='9'/>";
    let (d, _) = drawing(&format!("{plant}{shadow}"));
    assert_eq!(d.strokes.len(), 1, "the shadow at the foot is no part of the plant");
}

#[test]
fn a_sheet_that_is_stretched_stretches_its_drawing() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 10' width='40' height='20' \
                preserveAspectRatio='none'><path stroke='red' d='M1 1L5 3'/></svg>";
    let d = read(text, "t", &mut Report::default()).expect("reads");
    assert_eq!(ends(&d), [[[2.0, -1.0], [10.0, -3.0]]]);
}

#[test]
fn a_use_of_a_large_path_is_bounded_by_points() {
    let long = "1 1 ".repeat(400_000);
    let uses = "<use href='#l'/>".repeat(500);
    let m = failure(&format!("<defs><polyline id='l' stroke='red' points='{long}'/></defs>{uses}"));
    assert!(m.contains("number of points") || m.contains("text after expanding"), "{m}");
}

#[test]
fn a_filled_pen_outline_is_reduced_and_said() {
    let (d, w) = drawing("<path fill='#123' d='M10 10L50 12L90 10L90 11L50 13L10 11Z'/>");
    assert!(w[0].contains("variable-width pen"), "{w:?}");
    let s = &d.strokes[0];
    assert!(s.samples.iter().all(|p| p.pressure.is_some() && p.at.y < -10.0 && p.at.y > -13.0), "{s:?}");
    let length: f64 = s.samples.windows(2).map(|w| (w[1].at - w[0].at).length()).sum();
    assert!((length - 80.0).abs() < 3.0, "{length}");
    let (_, w) = drawing("<path stroke='red' d='M10 10L50 12L90 10L90 11L50 13L10 11Z'/>");
    assert!(w.is_empty(), "a stroked shape is what it is: {w:?}");
}

#[test]
fn wrong_numbers_pass_or_are_named_but_never_hang() {
    let (d, _) = drawing(
        "<g stroke='red'><path d='M1e300 1e300C-1e300 0 1e308 1e308 0 0'/><path d='M1e999 0L1 1'/><circle r='1e300'/>\
         <path d='M3 3'/><path d=''/><circle r='-1'/><rect width='NaN' height='1'/></g>",
    );
    assert_eq!(d.strokes.len(), 4);
    assert!(d.strokes.iter().all(|s| s.samples.len() < 2000));
}

#[test]
fn rules_for_screens_count_and_those_after_them_too() {
    let (d, w) = drawing(
        "<style>@charset \"utf-8\"; @import url('a.css'); .a { stroke: #010203 } @media print { .b { display: none } }\
         @font-face { font-family: x } @media screen and (min-width: 1px) { .b { stroke: #040506 } }\
         @keyframes k { from { opacity: 0 } to { opacity: 1 } } .c { stroke: #070809; stroke-width: 3px }\
         .d { stroke: red; stroke-width: 0 }</style>\
         <g fill='none'><path class='a' d='M0 0L1 1'/><path class='b' d='M0 0L1 1'/><path class='c' d='M0 0L1 1'/>\
         <path class='d' d='M0 0L1 1'/></g>",
    );
    let colors: Vec<_> = d.strokes.iter().filter_map(|s| s.color).collect();
    assert_eq!(colors, [[1, 2, 3], [4, 5, 6], [7, 8, 9]]);
    assert_eq!(d.strokes[2].width, Some(3.0));
    assert!(w.iter().any(|w| w.contains("invisible (1)")), "{w:?}");
}

#[test]
fn what_is_turned_in_its_own_box_stays_there() {
    let (d, _) = drawing(
        "<style>.t { transform-box: fill-box; transform-origin: center; transform: rotate(0.5turn) }\
         .s { transform-box: fill-box; transform: scale(200%) }</style>\
         <g transform='translate(5 0)'><g class='t'><path d='M10 10L30 50' stroke='red'/></g>\
         <path class='s' d='M10 10L30 50' stroke='red' stroke-width='2'/></g>",
    );
    assert_eq!(ends(&d), [[[35.0, -50.0], [15.0, -10.0]], [[15.0, -10.0], [55.0, -90.0]]]);
    assert_eq!(d.strokes[1].width, Some(4.0));
}

#[test]
fn what_a_mask_takes_away_as_a_whole_is_left_out_and_said() {
    let (d, w) = drawing(
        "<mask id='m'><rect width='100' height='100' fill='black'/><circle cx='20' cy='20' r='10' fill='white'/></mask>\
         <g mask='url(#m)'><path d='M15 15L25 25' stroke='red'/><path d='M60 60L90 90' stroke='red'/></g>",
    );
    assert_eq!(ends(&d), [[[15.0, -15.0], [25.0, -25.0]]]);
    assert!(w.iter().any(|w| w.contains("clipped away (1)")), "{w:?}");
}
