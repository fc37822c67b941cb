//! Strokes -> SVG: a path each, on the layers of Inkscape.

use std::io::Write;

use base::escaped_xml;
use glam::DVec2;
use ink::{Drawing, Layer, Stroke, StrokeMode};

use crate::drawing::mode::mode_in;
use crate::error::WriteError;

/// Pen width of strokes that have none, as a share of the drawing's diagonal.
const PEN: f64 = 0.004;

/// Writes a drawing as SVG with the layers of Inkscape: first the strokes on no layer, then the layers from below
/// upwards.
///
/// Guaranteed: [`read_drawings`](crate::read_drawings) gives back the same strokes with their points, modes, colours,
/// widths, ids and layers, in the order in which they are written; those of hidden layers come last. Points that are
/// not finite are left out, and so are strokes of fewer than two.
/// Not guaranteed: pressures and times, which SVG has no place for.
///
/// # Errors
/// [`WriteError::Io`] of the sink.
///
/// ```
/// use formats::{DrawingFormat, read_drawings, write_svg};
/// let stem = ink::Drawing::from_polylines("stem", &[vec![glam::DVec2::ZERO, glam::DVec2::Y]]);
/// let mut file = Vec::new();
/// write_svg(&stem, &mut file)?;
/// let read = read_drawings(&file[..], DrawingFormat::Svg, "stem").next().unwrap()?.drawing;
/// assert_eq!(read.strokes[0].samples, stem.strokes[0].samples);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_svg(drawing: &Drawing, mut out: impl Write) -> Result<(), WriteError> {
    let points = || drawing.strokes.iter().flat_map(finite);
    let (low, high) =
        points().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let (low, high) = if low.is_finite() { (low, high) } else { (DVec2::ZERO, DVec2::ONE) };
    let diagonal = low.distance(high).max(f64::MIN_POSITIVE);
    let margin = 0.05 * diagonal;
    let (low, high) = (low - margin, high + margin);
    let size = high - low;
    write!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\" \
         viewBox=\"{} {} {} {}\" fill=\"none\" stroke=\"black\" stroke-linecap=\"round\" \
         stroke-linejoin=\"round\">\n<title>{}</title>\n<style>path{{stroke-width:{}}}</style>\n",
        low.x,
        0.0 - high.y,
        size.x,
        size.y,
        escaped_xml(&drawing.name),
        PEN * diagonal
    )?;
    let known = |s: &&Stroke| drawing.layers.iter().any(|l| Some(&l.name) == s.layer.as_ref());
    for stroke in drawing.strokes.iter().filter(|s| !known(s)) {
        path(stroke, None, &mut out)?;
    }
    for (row, layer) in drawing.layers.iter().enumerate() {
        let (hidden, locked) = (
            if layer.hidden { " style=\"display:none\"" } else { "" },
            if layer.locked { " sodipodi:insensitive=\"true\"" } else { "" },
        );
        writeln!(
            out,
            "<g id=\"layer-{}\" inkscape:groupmode=\"layer\" inkscape:label=\"{}\"{hidden}{locked}>",
            row + 1,
            escaped_xml(&layer.name)
        )?;
        for stroke in drawing.strokes.iter().filter(|s| s.layer.as_ref() == Some(&layer.name)) {
            path(stroke, Some(layer), &mut out)?;
        }
        out.write_all(b"</g>\n")?;
    }
    out.write_all(b"</svg>\n")?;
    Ok(())
}

fn finite(stroke: &Stroke) -> impl Iterator<Item = DVec2> {
    stroke.samples.iter().map(|s| s.at).filter(|p| p.is_finite())
}

fn path(stroke: &Stroke, layer: Option<&Layer>, out: &mut impl Write) -> Result<(), WriteError> {
    if finite(stroke).count() < 2 {
        return Ok(());
    }
    out.write_all(b"<path")?;
    if let Some(id) = &stroke.id {
        write!(out, " id=\"{}\"", escaped_xml(id))?;
    }
    // The name of the layer or of the stroke may look like a mode.
    let named = stroke.id.as_deref().and_then(mode_in).or_else(|| mode_in(&layer?.name));
    match stroke.mode {
        StrokeMode::BranchContour => out.write_all(b" data-mode=\"branch-contour\"")?,
        StrokeMode::LeafContour => out.write_all(b" data-mode=\"leaf-contour\"")?,
        StrokeMode::Parts if named.is_some() => out.write_all(b" data-mode=\"parts\"")?,
        StrokeMode::Parts => {}
    }
    if let Some([r, g, b]) = stroke.color {
        write!(out, " stroke=\"#{r:02x}{g:02x}{b:02x}\"")?;
    }
    if let Some(width) = stroke.width {
        // Written as a style, which takes precedence over the sheet.
        write!(out, " style=\"stroke-width:{width}\"")?;
    }
    out.write_all(b" d=\"")?;
    for (k, p) in finite(stroke).enumerate() {
        write!(out, "{}{} {}", if k == 0 { 'M' } else { 'L' }, p.x, 0.0 - p.y)?;
    }
    out.write_all(b"\"/>\n")?;
    Ok(())
}
