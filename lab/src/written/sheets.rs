//! Surroundings that programs add to a drawing: paper, invisible ink, text and labels.

use std::fmt::Write as _;

use base::{Stream, ops};
use glam::DVec2;

use super::page::{PEN, Page, Written, expanded, filled, path_data, ring, shaken, stroked};

pub(super) fn page_as_path(page: &Page, _: &mut Stream) -> Option<Written> {
    Some(page.svg(&(filled(&page.frame(0.0, 0.0), "#ffffff") + &page.paths())))
}

pub(super) fn page_as_polygon_with_edge(page: &Page, _: &mut Stream) -> Option<Written> {
    let DVec2 { x, y } = page.size;
    let page_of = format!(
        "<polygon points=\"0,0 {x:.2},0 {x:.2},{y:.2} 0,{y:.2}\" fill=\"#fffdf5\" stroke=\"#999\" stroke-width=\"2\"/>\n"
    );
    Some(page.svg(&(page_of + &page.paths())))
}

pub(super) fn round_frame(page: &Page, _: &mut Stream) -> Option<Written> {
    let DVec2 { x, y } = page.size - 50.0;
    let frame = format!(
        "<rect x=\"25\" y=\"25\" width=\"{x:.2}\" height=\"{y:.2}\" rx=\"22\" fill=\"none\" stroke=\"#444\" stroke-width=\"4\"/>\n"
    );
    Some(page.svg(&(page.paths() + &frame)))
}

pub(super) fn double_frame(page: &Page, _: &mut Stream) -> Option<Written> {
    let frames = stroked(&page.frame(12.0, 0.0), "#333") + &stroked(&page.frame(22.0, 0.0), "#333");
    Some(page.svg(&(frames + &page.paths())))
}

pub(super) fn card_with_shadow(page: &Page, _: &mut Stream) -> Option<Written> {
    let shadow = format!(
        "<path d=\"{}\" fill=\"#000\" opacity=\"0.25\" transform=\"translate(8 9)\"/>\n",
        page.frame(30.0, 18.0)
    );
    let card = filled(&page.frame(30.0, 18.0), "#fdf6e3");
    Some(page.svg(&(shadow + &card + &page.paths())))
}

pub(super) fn badge(page: &Page, _: &mut Stream) -> Option<Written> {
    let disc = ring(0.5 * page.size, DVec2::splat(0.5 * page.size.length()), 72);
    Some(page.svg(&(filled(&path_data(&disc), "#dcecc8") + &page.paths())))
}

pub(super) fn badge_with_rim(page: &Page, _: &mut Stream) -> Option<Written> {
    let radius = 0.5 * page.size.length();
    let DVec2 { x, y } = 0.5 * page.size;
    let disc = format!(
        "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" fill=\"#f4f1de\" stroke=\"#3d405b\" stroke-width=\"6\"/>\n"
    );
    Some(page.svg(&(disc + &page.paths())))
}

/// Writes a circle around the drawing, by its line alone.
pub(super) fn ring_around(page: &Page, _: &mut Stream) -> Option<Written> {
    let circle = ring(0.5 * page.size, DVec2::splat(0.5 * page.size.length()), 72);
    Some(page.svg(&(stroked(&path_data(&circle), "#3d405b") + &page.paths())))
}

pub(super) fn frame_of_four_lines(page: &Page, _: &mut Stream) -> Option<Written> {
    let (a, b) = (20.0, page.size - 20.0);
    let corners = [DVec2::splat(a), DVec2::new(b.x, a), b, DVec2::new(a, b.y), DVec2::splat(a)];
    let sides: String = corners.windows(2).map(|w| stroked(&path_data(w), "#222")).collect();
    Some(page.svg(&(sides + &page.paths())))
}

pub(super) fn frame_by_hand(page: &Page, r: &mut Stream) -> Option<Written> {
    let (a, b) = (20.0, page.size - 20.0);
    let corners = [DVec2::splat(a), DVec2::new(b.x, a), b, DVec2::new(a, b.y), DVec2::splat(a)];
    let frame = shaken(r, &geom::resample(&corners, 12.0), 3.0);
    Some(page.svg(&(page.paths() + &stroked(&path_data(&frame), "#222"))))
}

pub(super) fn crop_marks(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut marks = String::new();
    for corner in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
        let at = 16.0 + corner * (page.size - 32.0);
        for way in [DVec2::X, DVec2::Y] {
            marks += &stroked(&path_data(&[at, at + way * (1.0 - 2.0 * corner) * 24.0]), "#000");
        }
    }
    Some(page.svg(&(page.paths() + &marks)))
}

/// Writes horizontal lines over the sheet, and a margin.
pub(super) fn ruled(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut lines = String::new();
    let DVec2 { x, y } = page.size;
    let mut at = 30.0;
    while at < y {
        let _ = writeln!(
            lines,
            "<line x1=\"0\" y1=\"{at:.1}\" x2=\"{x:.1}\" y2=\"{at:.1}\" stroke=\"#a8c8e8\"/>"
        );
        at += 32.0;
    }
    let _ = writeln!(lines, "<line x1=\"50\" y1=\"0\" x2=\"50\" y2=\"{y:.1}\" stroke=\"#e8a0a0\"/>");
    Some(page.svg(&(lines + &page.paths())))
}

/// Writes squares over the sheet, all in one path.
pub(super) fn squared(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut data = String::new();
    let DVec2 { x, y } = page.size;
    let mut at = 0.0;
    while at < x.max(y) {
        if at < x {
            let _ = write!(data, "M{at:.1} 0V{y:.1}");
        }
        if at < y {
            let _ = write!(data, "M0 {at:.1}H{x:.1}");
        }
        at += 24.0;
    }
    let grid = format!("<path d=\"{data}\" stroke=\"#ccd\" stroke-width=\"1\" fill=\"none\"/>\n");
    Some(page.svg(&(grid + &page.paths())))
}

pub(super) fn dotted(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut dots = String::from("<g fill=\"#bbb\">\n");
    let mut y = 20.0;
    while y < page.size.y {
        let mut x = 20.0;
        while x < page.size.x {
            let _ = write!(dots, "<circle cx=\"{x}\" cy=\"{y}\" r=\"1.5\"/>");
            x += 30.0;
        }
        y += 30.0;
    }
    Some(page.svg(&(dots + "</g>\n" + &page.paths())))
}

pub(super) fn sky_and_lawn(page: &Page, _: &mut Stream) -> Option<Written> {
    let DVec2 { x, y } = page.size;
    let horizon = 0.72 * y;
    let lawn: Vec<DVec2> = (0..=20)
        .map(|k| DVec2::new(x * f64::from(k) / 20.0, horizon + 8.0 * ops::sin(0.9 * f64::from(k))))
        .chain([DVec2::new(x, y), DVec2::new(0.0, y), DVec2::new(0.0, horizon)])
        .collect();
    let sky = format!("<rect width=\"{x:.2}\" height=\"{y:.2}\" fill=\"#bfe3ff\"/>\n");
    Some(page.svg(&(sky + &filled(&(path_data(&lawn) + "Z"), "#8fc46a") + &page.paths())))
}

/// Returns scribbles all over the drawing, which must not be visible.
fn scribbles(page: &Page, r: &mut Stream) -> Vec<Vec<DVec2>> {
    let somewhere = |r: &mut Stream| DVec2::new(r.range(0.1, 0.9), r.range(0.1, 0.9)) * page.size;
    (0..5)
        .map(|k| {
            let (a, b) = (somewhere(r), somewhere(r));
            if k < 2 {
                ring(a, DVec2::new(40.0, 26.0), 30)
            } else {
                shaken(r, &geom::resample(&[a, b], 10.0), 9.0)
            }
        })
        .collect()
}

fn hidden(page: &Page, r: &mut Stream, open: &str, shut: &str) -> Option<Written> {
    let lines: String = scribbles(page, r).iter().map(|l| stroked(&path_data(l), "#a00")).collect();
    Some(page.svg(&format!("{open}{lines}{shut}{}", page.paths())))
}

pub(super) fn see_through_group(page: &Page, r: &mut Stream) -> Option<Written> {
    hidden(page, r, "<g opacity=\"0\"><g>", "</g></g>")
}

pub(super) fn hidden_by_display(page: &Page, r: &mut Stream) -> Option<Written> {
    hidden(
        page,
        r,
        "<style>.helper .lines{display:none}</style><g class=\"helper\"><g class=\"lines\">",
        "</g></g>",
    )
}

pub(super) fn hidden_by_visibility(page: &Page, r: &mut Stream) -> Option<Written> {
    hidden(page, r, "<g style=\"visibility:hidden\">", "</g>")
}

pub(super) fn unused_definitions(page: &Page, r: &mut Stream) -> Option<Written> {
    hidden(page, r, "<defs><symbol id=\"brush\">", "</symbol></defs>")
}

pub(super) fn clipped_away(page: &Page, r: &mut Stream) -> Option<Written> {
    let clip = "<clipPath id=\"window\"><rect x=\"-90\" y=\"-90\" width=\"60\" height=\"60\"/></clipPath><g clip-path=\"url(#window)\">";
    hidden(page, r, clip, "</g>")
}

pub(super) fn masked_away(page: &Page, r: &mut Stream) -> Option<Written> {
    let mask = "<mask id=\"gone\"><rect x=\"-90\" y=\"-90\" width=\"60\" height=\"60\" fill=\"#fff\"/></mask><g mask=\"url(#gone)\">";
    hidden(page, r, mask, "</g>")
}

pub(super) fn off_the_sheet(page: &Page, r: &mut Stream) -> Option<Written> {
    let open = format!("<g transform=\"translate({:.1} 0)\">", 1.2 * page.size.x);
    hidden(page, r, &open, "</g>")
}

pub(super) fn lines_without_width(page: &Page, r: &mut Stream) -> Option<Written> {
    let line = |l: &Vec<DVec2>| {
        format!("<path d=\"{}\" style=\"fill:none;stroke:#a00;stroke-width:0px\"/>\n", path_data(l))
    };
    let lines: String = scribbles(page, r).iter().map(line).collect();
    Some(page.svg(&(lines + &page.paths())))
}

/// Gives the same width by a style sheet.
pub(super) fn lines_without_width_by_class(page: &Page, r: &mut Stream) -> Option<Written> {
    let line = |l: &Vec<DVec2>| format!("<path class=\"guide\" d=\"{}\"/>\n", path_data(l));
    let lines: String = scribbles(page, r).iter().map(line).collect();
    let style = "<style>.guide{fill:none;stroke:#a00;stroke-width:0}</style>\n";
    Some(page.svg(&(style.to_owned() + &lines + &page.paths())))
}

/// Writes lines in the colour of the paper on a page of that colour.
pub(super) fn white_on_white(page: &Page, r: &mut Stream) -> Option<Written> {
    let lines: String = scribbles(page, r).iter().map(|l| stroked(&path_data(l), "#ffffff")).collect();
    Some(page.svg(&(filled(&page.frame(0.0, 0.0), "#ffffff") + &lines + &page.paths())))
}

/// Returns places next to the drawing, and the places in it that they label.
fn labels(page: &Page) -> Vec<(DVec2, DVec2)> {
    let step = (page.lines.len() / 4).max(1);
    let named = page.lines.iter().step_by(step).take(4);
    let middle = named.map(|l| l.points[l.points.len() / 2]);
    let beside = |(k, p): (usize, DVec2)| (DVec2::new(page.size.x + 150.0, 80.0 + 70.0 * k as f64), p);
    middle.enumerate().map(beside).collect()
}

fn wide(page: &Page, body: &str) -> Written {
    let DVec2 { x, y } = page.size + DVec2::new(280.0, 0.0);
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {x:.2} {y:.2}\">\n{body}</svg>\n").into()
}

pub(super) fn text_with_marked_arrows(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut body = page.paths();
    body += "<defs><marker id=\"tip\" viewBox=\"0 0 9 9\" refX=\"8\" refY=\"4\"><path d=\"M0 0L9 4L0 9Z\"/></marker></defs>\n";
    for (at, to) in labels(page) {
        let _ = writeln!(
            body,
            "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"20\">organ</text><path d=\"{}\" fill=\"none\" stroke=\"#000\" marker-end=\"url(#tip)\"/>",
            at.x,
            at.y,
            path_data(&[at - 8.0 * DVec2::X, to])
        );
    }
    Some(wide(page, &body))
}

/// Writes leaders without heads from words to organs.
pub(super) fn text_with_leaders(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut body = page.paths();
    for (at, to) in labels(page) {
        let _ = writeln!(body, "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"20\">organ</text>", at.x, at.y);
        body += &stroked(&path_data(&[at - DVec2::new(8.0, 6.0), to]), "#000");
    }
    Some(wide(page, &body))
}

/// Writes arrows whose heads are lines of their own.
pub(super) fn text_with_drawn_arrows(page: &Page, _: &mut Stream) -> Option<Written> {
    let mut body = page.paths();
    for (at, to) in labels(page) {
        let _ = writeln!(body, "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"20\">organ</text>", at.x, at.y);
        let from = at - DVec2::new(8.0, 6.0);
        let way = (to - from).normalize_or_zero();
        let head = [1.0, -1.0].map(|side| to - way * 14.0 + way.perp() * (7.0 * side));
        body += &stroked(&path_data(&[from, to]), "#000");
        body += &stroked(&path_data(&[head[0], to, head[1]]), "#000");
    }
    Some(wide(page, &body))
}

/// Writes a title under the drawing in letters that are areas, as programs write text that must look the same
/// everywhere.
pub(super) fn title_as_outlines(page: &Page, _: &mut Stream) -> Option<Written> {
    const LETTERS: [&[[f64; 2]]; 4] = [
        &[[0.0, 0.0], [2.0, 0.0], [2.0, 8.0], [7.0, 8.0], [7.0, 10.0], [0.0, 10.0], [0.0, 0.0]],
        &[
            [0.0, 0.0],
            [7.0, 0.0],
            [7.0, 2.0],
            [4.5, 2.0],
            [4.5, 10.0],
            [2.5, 10.0],
            [2.5, 2.0],
            [0.0, 2.0],
            [0.0, 0.0],
        ],
        &[[0.0, 0.0], [2.0, 0.0], [2.0, 10.0], [0.0, 10.0], [0.0, 0.0]],
        &[
            [0.0, 0.0],
            [7.0, 0.0],
            [7.0, 2.0],
            [2.0, 2.0],
            [2.0, 4.0],
            [6.0, 4.0],
            [6.0, 6.0],
            [2.0, 6.0],
            [2.0, 10.0],
            [0.0, 10.0],
            [0.0, 0.0],
        ],
    ];
    let mut data = String::new();
    for k in 0..10_u8 {
        let letter = LETTERS[usize::from(k) % LETTERS.len()];
        let place = |p: &[f64; 2]| {
            DVec2::new(0.5 * page.size.x + 20.0 * (f64::from(k) - 5.0), page.size.y + 30.0)
                + 1.8 * DVec2::from(*p)
        };
        data += &path_data(&letter.iter().map(place).collect::<Vec<_>>());
    }
    let DVec2 { x, y } = page.size + DVec2::new(0.0, 80.0);
    let body = page.paths() + &filled(&data, "#000");
    Some(
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {x:.2} {y:.2}\">\n{body}</svg>\n")
            .into(),
    )
}

/// Writes a signature in the corner.
pub(super) fn signature(page: &Page, _: &mut Stream) -> Option<Written> {
    let wave = |k: u8| {
        let t = f64::from(k) / 60.0;
        page.size - DVec2::new(110.0 - 80.0 * t, 24.0 - 9.0 * ops::sin(31.0 * t) * (1.0 - 0.6 * t))
    };
    let line: Vec<DVec2> = (0..=60).map(wave).collect();
    Some(page.svg(&(page.paths() + &stroked(&path_data(&line), "#222"))))
}

/// Writes a halo of paper round each line, as makers of maps and stickers draw it below the line.
pub(super) fn white_halo(page: &Page, _: &mut Stream) -> Option<Written> {
    let halo = page.each(|l| {
        let rings: String = expanded(l, |_| 4.0 * PEN).iter().map(|ring| path_data(ring)).collect();
        filled(&rings, "#ffffff")
    });
    Some(page.svg(&(halo + &page.paths())))
}
