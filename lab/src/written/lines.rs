//! Lines of a drawing as programs write them: with colour, in pieces, as outlines of their ink, hatched.

use std::fmt::Write as _;

use base::Stream;
use glam::DVec2;

use super::page::{
    Line, PEN, Page, Written, expanded, filled, hatches, path_data, pieces, ring, shaken, stroked, traced,
};

/// Writes the page if it has an outline; otherwise there is nothing to fill.
fn with_outlines(page: &Page, body: &str) -> Option<Written> {
    page.outlines().next().is_some().then(|| page.svg(body))
}

/// Returns the colour for the area of a line.
fn tint(line: &Line) -> &'static str {
    const TINTS: [&str; 4] = ["#8fbf6a", "#e8b0c8", "#f2d16b", "#c98b5a"];
    TINTS[line.points.len() % TINTS.len()]
}

fn line_of(line: &Line) -> String {
    stroked(&path_data(&line.points), &line.color)
}

pub(super) fn fill_below_line(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let area = if l.closed { filled(&path_data(&l.points), tint(l)) } else { String::new() };
        area + &line_of(l)
    });
    with_outlines(page, &body)
}

/// Writes a layer of colours that do not quite lie under the lines.
pub(super) fn layer_of_colours(page: &Page, _: &mut Stream) -> Option<Written> {
    let moved = |l: &Line| {
        let points: Vec<DVec2> = l.points.iter().map(|p| *p + DVec2::new(4.0, -3.0)).collect();
        filled(&path_data(&points), tint(l))
    };
    let areas: String = page.outlines().map(moved).collect();
    with_outlines(page, &format!("<g>{areas}</g><g>{}</g>", page.paths()))
}

pub(super) fn hachure_below_line(page: &Page, r: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        if !l.closed {
            return line_of(l);
        }
        let lines: String =
            hatches(&l.points, 0.8, 9.0).iter().map(|h| path_data(&shaken(r, h, 0.8))).collect();
        let hachure =
            format!("<path d=\"{lines}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>", tint(l));
        format!("<g>{hachure}{}</g>\n", line_of(l))
    });
    with_outlines(page, &body)
}

/// Returns the part of an outline to one side of the chord from its beginning to the opposite end.
fn half(line: &Line) -> Vec<DVec2> {
    let mut half = pieces(&line.points, 2, 0.0).swap_remove(0);
    half.push(half[0]);
    half
}

pub(super) fn see_through_shade(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        if !l.closed {
            return line_of(l);
        }
        let data = path_data(&l.points);
        let shade = path_data(&half(l));
        format!(
            "<path d=\"{data}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{PEN}\"/><path d=\"{shade}\" fill=\"#000\" fill-opacity=\"0.18\"/>\n",
            tint(l),
            l.color
        )
    });
    with_outlines(page, &body)
}

pub(super) fn opaque_shade(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        if !l.closed {
            return line_of(l);
        }
        filled(&path_data(&l.points), tint(l)) + &filled(&path_data(&half(l)), "#4e7a34") + &line_of(l)
    });
    with_outlines(page, &body)
}

pub(super) fn gradients(page: &Page, _: &mut Stream) -> Option<Written> {
    let defs = "<defs><linearGradient id=\"a\"><stop offset=\"0\" stop-color=\"#8fbf6a\"/><stop offset=\"1\" stop-color=\"#3e6a24\"/></linearGradient><radialGradient id=\"b\" href=\"#a\"/></defs>\n";
    let body = page.each(|l| {
        if !l.closed {
            return line_of(l);
        }
        filled(&path_data(&l.points), "url(#b)") + &line_of(l)
    });
    with_outlines(page, &(defs.to_owned() + &body))
}

/// Writes outlines as areas without lines, all else as lines.
pub(super) fn flat_areas(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| if l.closed { filled(&path_data(&l.points), tint(l)) } else { line_of(l) });
    with_outlines(page, &body)
}

/// Writes a light spot in each outline.
pub(super) fn highlights(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        if !l.closed {
            return line_of(l);
        }
        let data = path_data(&l.points);
        let middle = l.points.iter().sum::<DVec2>() / l.points.len() as f64;
        let spot: Vec<DVec2> = l.points.iter().map(|p| middle + (*p - middle) * 0.35 - 2.0).collect();
        format!(
            "<path d=\"{data}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{PEN}\"/><path d=\"{}\" fill=\"#fff\" opacity=\"0.4\"/>\n",
            tint(l),
            l.color,
            path_data(&spot)
        )
    });
    with_outlines(page, &body)
}

pub(super) fn a_line_a_segment(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let mut out = String::new();
        for w in geom::resample(&l.points, 8.0).windows(2) {
            let _ = writeln!(
                out,
                "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"{}\" stroke-width=\"4\"/>",
                w[0].x, w[0].y, w[1].x, w[1].y, l.color
            );
        }
        out
    });
    Some(page.svg(&body))
}

/// Writes segments whose widths follow the pressure of the pen.
pub(super) fn a_path_a_segment(page: &Page, r: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let mut out = String::new();
        for w in geom::resample(&l.points, 9.0).windows(2) {
            let width = PEN * r.range(0.7, 1.3);
            let data = path_data(w);
            let _ = writeln!(
                out,
                "<path d=\"{data}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.2}\"/>",
                l.color
            );
        }
        out
    });
    Some(page.svg(&body))
}

/// Writes curves of a few points, each a path of its own.
pub(super) fn a_path_a_few_points(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let even = geom::resample(&l.points, 6.0);
        let ends = (0..even.len().saturating_sub(1)).step_by(6);
        ends.map(|k| stroked(&path_data(&even[k..(k + 7).min(even.len())]), &l.color)).collect()
    });
    Some(page.svg(&body))
}

pub(super) fn moveto_before_each_segment(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let data: String = geom::resample(&l.points, 8.0).windows(2).map(path_data).collect();
        stroked(&data, &l.color)
    });
    Some(page.svg(&body))
}

fn in_pieces(page: &Page, count: u32, gap: f64) -> Option<Written> {
    let body = page.each(|l| {
        if !l.closed {
            return line_of(l);
        }
        let cut = pieces(&l.points, count, gap * l.length());
        cut.iter().map(|p| stroked(&path_data(p), &l.color)).collect()
    });
    with_outlines(page, &body)
}

pub(super) fn outlines_in_halves(page: &Page, _: &mut Stream) -> Option<Written> {
    in_pieces(page, 2, 0.0)
}

pub(super) fn outlines_in_halves_with_gaps(page: &Page, _: &mut Stream) -> Option<Written> {
    in_pieces(page, 2, 0.01)
}

pub(super) fn outlines_in_thirds_with_gaps(page: &Page, _: &mut Stream) -> Option<Written> {
    in_pieces(page, 3, 0.008)
}

/// Writes both halves from the base to the tip, as people draw leaves.
pub(super) fn halves_the_same_way(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        if !l.closed {
            return line_of(l);
        }
        let mut cut = pieces(&l.points, 2, 0.0);
        if let Some(second) = cut.get_mut(1) {
            second.reverse();
        }
        cut.iter().map(|p| stroked(&path_data(p), &l.color)).collect()
    });
    with_outlines(page, &body)
}

/// Writes stems and veins in two pieces that meet.
pub(super) fn open_lines_in_two(page: &Page, _: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        if l.closed || l.length() < 60.0 {
            return line_of(l);
        }
        pieces(&l.points, 2, 0.0).iter().map(|p| stroked(&path_data(p), &l.color)).collect()
    });
    Some(page.svg(&body))
}

fn outline_of_ink(line: &Line, width: impl Fn(f64) -> f64) -> String {
    expanded(line, width).iter().map(|ring| path_data(ring)).collect()
}

pub(super) fn expanded_strokes(page: &Page, _: &mut Stream) -> Option<Written> {
    Some(page.svg(&page.each(|l| filled(&outline_of_ink(l, |_| PEN), &l.color))))
}

/// Writes a felt pen, twice as wide.
pub(super) fn expanded_broad_strokes(page: &Page, _: &mut Stream) -> Option<Written> {
    Some(page.svg(&page.each(|l| filled(&outline_of_ink(l, |_| 2.5 * PEN), &l.color))))
}

pub(super) fn strokes_of_a_brush(page: &Page, _: &mut Stream) -> Option<Written> {
    let width = |t: f64| PEN * (0.6 + 3.0 * t * (1.0 - t));
    Some(page.svg(&page.each(|l| filled(&outline_of_ink(l, width), &l.color))))
}

pub(super) fn one_compound_path(page: &Page, _: &mut Stream) -> Option<Written> {
    let data: String = page.lines.iter().map(|l| outline_of_ink(l, |_| PEN)).collect();
    Some(page.svg(&filled(&data, "#222222")))
}

pub(super) fn traced_bitmap(page: &Page, _: &mut Stream) -> Option<Written> {
    let data: String = traced(page, 1.2).iter().map(|ring| path_data(ring)).collect();
    Some(page.svg(&format!("<path d=\"{data}\" fill=\"#000000\" fill-rule=\"evenodd\"/>\n")))
}

/// Writes each line twice in one path, as programs that imitate a hand draw it.
pub(super) fn doubled_in_one_path(page: &Page, r: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let data = path_data(&shaken(r, &l.points, 1.6)) + &path_data(&shaken(r, &l.points, 1.6));
        stroked(&data, &l.color)
    });
    Some(page.svg(&body))
}

/// Writes each line twice, one element after the other.
pub(super) fn doubled_in_two_paths(page: &Page, r: &mut Stream) -> Option<Written> {
    let body = page.each(|l| {
        let mut again = || stroked(&path_data(&shaken(r, &l.points, 1.6)), &l.color);
        again() + &again()
    });
    Some(page.svg(&body))
}

/// Writes shading within each outline, after it.
fn shaded(page: &Page, mut shade: impl FnMut(&Line) -> String) -> Option<Written> {
    let body = page.each(|l| if l.closed { line_of(l) + &shade(l) } else { line_of(l) });
    with_outlines(page, &body)
}

pub(super) fn hatched_in_one_path(page: &Page, _: &mut Stream) -> Option<Written> {
    shaded(page, |l| {
        let lines: String = hatches(&l.points, 0.6, 8.0).iter().map(|h| path_data(h)).collect();
        stroked(&lines, "#333")
    })
}

pub(super) fn hatched_line_by_line(page: &Page, r: &mut Stream) -> Option<Written> {
    shaded(page, |l| {
        let lines = hatches(&l.points, 0.6, 8.0);
        lines.iter().map(|h| stroked(&path_data(&inset(r, *h)), "#333")).collect()
    })
}

/// Returns a hatch that a hand begins and ends near the edge.
fn inset(r: &mut Stream, [a, b]: [DVec2; 2]) -> [DVec2; 2] {
    [a.lerp(b, r.range(0.0, 0.08)), b.lerp(a, r.range(0.0, 0.08))]
}

pub(super) fn crosshatched(page: &Page, _: &mut Stream) -> Option<Written> {
    shaded(page, |l| {
        let lines = [0.7, -0.7].map(|angle| hatches(&l.points, angle, 9.0)).concat();
        lines.iter().map(|h| stroked(&path_data(h), "#333")).collect()
    })
}

pub(super) fn zigzag(page: &Page, _: &mut Stream) -> Option<Written> {
    shaded(page, |l| {
        let lines = hatches(&l.points, 0.6, 7.0);
        let turned =
            lines.iter().enumerate().flat_map(|(k, [a, b])| if k % 2 == 0 { [*a, *b] } else { [*b, *a] });
        let points: Vec<DVec2> = turned.collect();
        if points.len() < 6 { String::new() } else { stroked(&path_data(&points), "#333") }
    })
}

/// Writes shading along one side of the outline only, as engravers do.
pub(super) fn half_hatched(page: &Page, _: &mut Stream) -> Option<Written> {
    shaded(page, |l| {
        let lines = hatches(&l.points, 0.6, 7.0);
        lines.iter().map(|[a, b]| stroked(&path_data(&[a.lerp(*b, 0.55), *b]), "#333")).collect()
    })
}

/// Writes short strokes along the outline that reach no edge, as bark is drawn.
pub(super) fn short_strokes(page: &Page, r: &mut Stream) -> Option<Written> {
    shaded(page, |l| {
        let lines = hatches(&l.points, 1.4, 14.0);
        let dash = |h: &[DVec2; 2]| {
            let from = r.range(0.2, 0.55);
            stroked(&path_data(&[h[0].lerp(h[1], from), h[0].lerp(h[1], from + 0.25)]), "#333")
        };
        lines.iter().map(dash).collect()
    })
}

pub(super) fn stippled(page: &Page, _: &mut Stream) -> Option<Written> {
    shaded(page, |l| {
        let mut dots = String::new();
        for h in hatches(&l.points, 0.3, 9.0) {
            for p in geom::resample(&h, 9.0) {
                dots += &filled(&path_data(&ring(p, DVec2::splat(1.4), 8)), "#222");
            }
        }
        dots
    })
}
