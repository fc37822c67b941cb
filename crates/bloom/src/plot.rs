//! Plots a growth law as a picture of its fits with their points.

use core::fmt::Write as _;

use base::{TimeUnit, escaped_xml};

use crate::{GrowthLaw, RegionLaw};

const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 190.0;
const COLUMNS: usize = 4;

/// Plots all laws as panels of an SVG: measured values as dots, the fit as a line, labels with first and final value, r
/// and R2, and the band that contains 9 of 10 new measurements. Values in mm, times in the series' own count and unit.
///
/// ```
/// let svg = bloom::plot_svg(&bloom::GrowthLaw::logistic("lily", 6.0, 0.9));
/// assert!(svg.starts_with("<svg") && svg.contains("lily"));
/// ```
pub fn plot_svg(law: &GrowthLaw) -> String {
    let rows = law.laws.len().div_ceil(COLUMNS);
    let (w, h) = (WIDTH * COLUMNS.min(law.laws.len().max(1)) as f64, HEIGHT * rows as f64 + 34.0);
    let mut s = String::new();
    let _ = write!(
        s,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"12\" y=\"22\" font-size=\"15\">{}: growth laws (mm by {})</text>\n",
        escaped_xml(&law.name),
        law.time.word()
    );
    for (i, row) in law.laws.iter().enumerate() {
        let (x, y) = ((i % COLUMNS) as f64 * WIDTH, (i / COLUMNS) as f64 * HEIGHT + 34.0);
        panel(&mut s, law, row, x, y);
    }
    s.push_str("</svg>\n");
    s
}

/// Returns the label of a panel: the first and final value of the law, not K and p0 above some constant.
fn figures(row: &RegionLaw, time: TimeUnit) -> String {
    let time = time.word();
    let start = row.value(0.0) * 1e3;
    let form = row.form.word();
    match row.final_value() {
        Some(end) => {
            format!("{form}: {start:.2} to {:.2} r {:.3} a {time} R2 {:.3}", end * 1e3, row.law.r, row.r2)
        }
        None if row.is_determined() => {
            format!("{form}: from {start:.2} r {:.3} a {time} R2 {:.3}", row.law.r, row.r2)
        }
        None => format!("not determined ({form})"),
    }
}

/// Returns the interval, mm, that contains 9 of 10 new measurements on days of the span; empty if there are too few
/// values.
fn law_band(law: &GrowthLaw, row: &RegionLaw) -> Vec<(f64, [f64; 2])> {
    let days = (0..=30).map(|k| law.span_days * f64::from(k) / 30.0);
    let band: Option<Vec<_>> =
        days.map(|day| Some((day, row.predict(day).interval?.map(|v| v * 1e3)))).collect();
    band.unwrap_or_default()
}

fn panel(s: &mut String, law: &GrowthLaw, row: &RegionLaw, x0: f64, y0: f64) {
    let (left, right, top, bottom) = (x0 + 46.0, x0 + WIDTH - 12.0, y0 + 40.0, y0 + HEIGHT - 22.0);
    let curve: Vec<(f64, f64)> = (0..=60)
        .map(|k| {
            let day = law.span_days * f64::from(k) / 60.0;
            (day, row.value(day) * 1e3)
        })
        .filter(|p| p.1.is_finite())
        .collect();
    let dots: Vec<(f64, f64)> = row.days.iter().zip(&row.values).map(|(d, v)| (*d, v * 1e3)).collect();
    let all = || curve.iter().chain(&dots).map(|p| p.1);
    let low = all().fold(f64::INFINITY, f64::min);
    let high = all().fold(f64::NEG_INFINITY, f64::max);
    let pad = 0.08 * (high - low).max(1e-6);
    let (low, high) = (low - pad, high + pad);
    let px = |d: f64| left + (right - left) * d / law.span_days.max(1e-12);
    let py = |v: f64| bottom - (bottom - top) * (v - low) / (high - low);
    let region = if row.region == 0 { "whole".to_owned() } else { format!("region {}", row.region) };
    let _ = write!(
        s,
        "<g><text x=\"{left:.0}\" y=\"{:.0}\" font-weight=\"bold\">{} {region} {}</text>\n\
         <text x=\"{left:.0}\" y=\"{:.0}\" fill=\"#555\">{}</text>\n\
         <path d=\"M{left:.1} {top:.1}V{bottom:.1}H{right:.1}\" fill=\"none\" stroke=\"#888\"/>\n",
        y0 + 14.0,
        escaped_xml(&row.organ),
        row.axis.word(),
        y0 + 29.0,
        figures(row, law.time)
    );
    for (v, y) in [(low + pad, bottom - 2.0), (high - pad, top + 8.0)] {
        let _ = writeln!(s, "<text x=\"{:.0}\" y=\"{y:.0}\" text-anchor=\"end\">{v:.2}</text>", left - 4.0);
    }
    for d in [0.0, law.span_days] {
        let day = law.first_day + d;
        let _ = writeln!(
            s,
            "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{day}</text>",
            px(d),
            bottom + 14.0
        );
    }
    let ends = law_band(law, row);
    if !ends.is_empty() {
        let upper = ends.iter().map(|&(d, [_, high])| (d, high));
        let lower = ends.iter().rev().map(|&(d, [low, _])| (d, low));
        let within = |v: f64| v.clamp(low, high);
        let around: Vec<String> =
            upper.chain(lower).map(|(d, v)| format!("{:.1},{:.1}", px(d), py(within(v)))).collect();
        let _ =
            writeln!(s, "<polygon points=\"{}\" fill=\"#2a7d3f\" fill-opacity=\"0.14\"/>", around.join(" "));
    }
    let line: Vec<String> = curve.iter().map(|&(d, v)| format!("{:.1},{:.1}", px(d), py(v))).collect();
    let _ = writeln!(
        s,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#2a7d3f\" stroke-width=\"1.6\"/>",
        line.join(" ")
    );
    for (d, v) in dots {
        let _ = writeln!(s, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"#c2185b\"/>", px(d), py(v));
    }
    s.push_str("</g>\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    /// XML excludes these characters: no program would open the picture.
    #[test]
    fn names_with_characters_that_xml_lacks_make_a_picture() {
        let svg = plot_svg(&GrowthLaw::logistic("a\u{1}<b>\u{fffe}", 6.0, 0.9));
        assert!(svg.contains("a &lt;b&gt;: growth laws"), "{svg}");
        assert!(!svg.contains(|c: char| (c.is_control() && c != '\n') || c == '\u{fffe}'));
    }
}
