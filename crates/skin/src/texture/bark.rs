//! Bark: a relief with its colours, which repeats in both directions; v runs up the trunk. A tile is a third of the
//! circumference of the thickest branch.

use base::{Cancelled, Digest, Run, ops};

use super::noise::{Plates, gradient, octaves, strokes};
use super::relief::{Sheet, Spot, Surface, surface};
use super::{Paint, mix, shade};
use crate::natural::BarkKind;

/// Paints a bark with its mean colour (sRGB, 0 to 1); for birch that of its white.
///
/// `size` pixels square, 64 to 4096. Painted once for each content.
pub(crate) fn bark(kind: BarkKind, colour: Paint, size: u32, run: &Run<'_>) -> Result<Surface, Cancelled> {
    let mut content = Digest::new();
    content.add("bark").add(&(kind as u32)).add(&colour).add(&size);
    Surface::kept(content, || {
        let mean = (kind != BarkKind::Birch).then_some(colour);
        let sheet = Sheet { size: (size, size), extent: (1.0, 1.0), depth: kind.depth(), tiles: true, mean };
        let paint = |at: &(dyn Fn(f64, f64) -> Spot + Sync)| surface(run, &sheet, false, at);
        match kind {
            BarkKind::Furrowed => paint(&furrowed(colour)),
            BarkKind::Plated => paint(&plated(colour)),
            BarkKind::Smooth => paint(&|u, v| smooth(colour, u, v)),
            BarkKind::Birch => paint(&|u, v| birch(colour, u, v)),
            BarkKind::Cherry => paint(&|u, v| cherry(colour, u, v)),
            BarkKind::Ringed => paint(&|u, v| ringed(colour, u, v)),
            BarkKind::Cane => paint(&|u, v| cane(colour, u, v)),
            BarkKind::Ribbed => paint(&|u, v| ribbed(colour, u, v)),
            BarkKind::Twig => paint(&|u, v| twig(colour, u, v)),
        }
    })
}

/// Evaluates gradient noise that repeats `n` times over the tile, about -1 to 1.
fn noise(u: f64, v: f64, n: (i32, i32), salt: u32) -> f64 {
    gradient(u * f64::from(n.0), v * f64::from(n.1), n, salt)
}

fn rough(u: f64, v: f64, n: (i32, i32), salt: u32, layers: u32) -> f64 {
    octaves(u * f64::from(n.0), v * f64::from(n.1), n, salt, layers)
}

fn grey_of(c: Paint) -> f64 {
    0.3 * c[0] + 0.6 * c[1] + 0.1 * c[2]
}

/// Returns the colour with less hue, lighter or darker: weathered cork.
fn weathered(c: Paint, hue: f64, light: f64) -> Paint {
    shade(mix([grey_of(c); 3], c, hue), light)
}

/// Adds lichen: a dusting in patches on raised parts.
fn lichen(c: Paint, u: f64, v: f64, height: f64, much: f64) -> Paint {
    let patch = noise(u, v, (3, 3), 61) + 0.5 * noise(u, v, (9, 9), 62) + 0.35 * noise(u, v, (34, 34), 63);
    let share = ops::smoothstep(0.45, 0.95, patch + 0.35 * (height - 0.7)) * much;
    mix(c, [0.58, 0.60, 0.52], share)
}

/// Paints long ridges that part and meet, of fibres, with cross cracks; grey on their crests, brown in the furrows.
fn furrowed(colour: Paint) -> impl Fn(f64, f64) -> Spot + Sync {
    let ridges = Plates::new((13, 4), 0.75, 11);
    let blocks = Plates::new((26, 14), 0.9, 12);
    move |u, v| {
        let sway = 0.9 * noise(u, v, (3, 2), 1) + 0.45 * noise(u, v, (8, 5), 2);
        let jag = rough(u, v, (30, 18), 3, 2);
        let (x, y) = (u + 0.024 * sway + 0.009 * jag, v + 0.03 * noise(u, v, (7, 5), 4));
        let ridge = ridges.plate_at(x, y);
        // Some neighbours have grown together: the furrow between them is only a dent. So have most that meet end to
        // end: furrows run up the trunk.
        let joined = ops::smoothstep(0.20, 0.34, ridge.border) * ops::smoothstep(0.62, 0.97, ridge.upright);
        let width = 0.0115 * (1.0 + 0.60 * noise(u, v, (5, 3), 5)) * (0.25 + 0.75 * joined);
        let wall = ops::smoothstep(0.0, 2.4 * width, ridge.edge);
        let crest = ops::smoothstep(0.0, 0.034, ridge.edge);
        let deep = (1.0 - wall) * (0.22 + 0.78 * joined);
        // Cracks break a ridge into blocks; most run across it.
        let block = blocks.plate_at(x + 0.01 * jag, y + 0.012 * sway + 0.01 * jag);
        let alive = ops::smoothstep(0.56, 0.72, block.border);
        let crack = alive * (1.0 - ops::smoothstep(0.0, 0.0068, block.edge)) * (0.3 + 0.7 * crest);
        let fibre = rough(u + 0.02 * sway, v, (44, 7), 6, 3);
        let grain = rough(u, v, (90, 60), 7, 2);
        let body = 0.70 + 0.10 * (block.own - 0.5) + 0.12 * (ridge.own - 0.5) + 0.14 * crest;
        let height =
            body * (1.0 - 0.92 * deep) - 0.15 * crack + (0.13 * fibre + 0.08 * grain) * (1.0 - 0.5 * deep);
        let lit = ops::smoothstep(0.15, 0.95, height);
        let crest_paint = weathered(colour, 0.55, 1.22 + 0.16 * (block.own - 0.5) + 0.10 * (ridge.own - 0.5));
        let wall_paint = weathered(colour, 1.15, 0.86);
        let dark = shade(weathered(colour, 1.0, 0.40), 1.0 + 0.5 * grain + 0.4 * fibre);
        let paint = mix(wall_paint, crest_paint, lit + 0.35 * fibre);
        let paint = shade(paint, 1.0 + 0.22 * grain + 0.12 * fibre);
        let paint = mix(mix(paint, dark, 0.90 * deep * deep.sqrt()), dark, 0.5 * crack);
        Spot { height, paint: lichen(paint, u, v, height, 0.30), rough: 0.94 - 0.05 * lit, through: 0.0 }
    }
}

/// Paints plates, each a pile of thin scales that ends in ragged steps; furrows between, some of which have closed.
fn plated(colour: Paint) -> impl Fn(f64, f64) -> Spot + Sync {
    let plates = Plates::new((9, 4), 0.85, 21);
    let parts = Plates::new((13, 14), 0.95, 22);
    move |u, v| {
        let sway = (
            noise(u, v, (4, 3), 1) + 0.6 * noise(u, v, (11, 8), 2),
            noise(u, v, (4, 3), 3) + 0.6 * noise(u, v, (11, 8), 4),
        );
        let ragged = rough(u, v, (26, 20), 5, 3);
        let (x, y) = (u + 0.040 * sway.0 + 0.016 * ragged, v + 0.035 * sway.1 + 0.010 * ragged);
        let plate = plates.plate_at(x, y);
        let open = ops::smoothstep(0.16, 0.42, plate.border + 0.25 * noise(u, v, (7, 5), 6));
        let width = 0.015 * (1.0 + 0.6 * noise(u, v, (4, 3), 7)) * (0.18 + 0.82 * open);
        let wall = ops::smoothstep(0.15 * width, 1.6 * width, plate.edge);
        let part = parts.plate_at(x, y);
        let alive = ops::smoothstep(0.66, 0.78, part.border) * open;
        let split = alive * (1.0 - ops::smoothstep(0.0, 0.006, part.edge));
        // Scales end in steps along the edge of their plate, and some have fallen from its middle.
        let broad = rough(u, v, (5, 4), 8, 3);
        let scale = plate.edge + 0.034 * broad + 0.016 * (part.own - 0.5) + 0.010 * ragged;
        let pile = 3.0 * ops::smoothstep(-0.014, 0.050, scale);
        let layer = pile.floor();
        let lip = pile - layer;
        let step = layer + ops::smoothstep(0.0, 0.35, lip);
        let grain = rough(u, v, (64, 52), 9, 3);
        let fibre = rough(u + 0.02 * sway.0, v, (38, 10), 10, 2);
        let top = 0.36 + 0.14 * step + 0.05 * broad + 0.05 * fibre;
        let floor = 0.10 + 0.10 * grain + 0.08 * fibre;
        let height = top * wall + floor * (1.0 - wall) - 0.10 * split + 0.05 * grain;
        // Old bark is grey; bark under a lost scale is fresh and red.
        let fresh = (0.34 - 0.20 * (step - 1.5) + 0.60 * broad + 0.35 * (part.own - 0.5)).clamp(0.0, 1.0);
        let tone = 1.0 + 0.14 * (part.own - 0.5) + 0.16 * (plate.own - 0.5) + 0.22 * grain + 0.10 * fibre;
        let old = weathered(colour, 0.42, 1.06 * tone);
        let new = [colour[0] * 1.12 * tone, colour[1] * 0.98 * tone, colour[2] * 0.84 * tone];
        let edge = 1.0 - ops::smoothstep(0.0, 0.30, lip);
        let paint = shade(mix(old, new, fresh), 1.0 - 0.08 * edge);
        let dark = shade(weathered(colour, 0.75, 0.36), 1.0 + 0.6 * grain + 0.3 * fibre);
        let deep = (1.0 - wall) * (0.45 + 0.55 * open);
        let paint = mix(paint, dark, (0.95 * deep).max(0.45 * split));
        Spot { height, paint, rough: 0.93 - 0.10 * fresh * wall, through: 0.0 }
    }
}

/// Paints closed bark with fine wrinkles, eyes of lost branches, and pale crusts.
fn smooth(colour: Paint, u: f64, v: f64) -> Spot {
    let bend = 0.01 * noise(u, v, (4, 4), 1);
    let wrinkle = rough(u, v + bend, (7, 46), 2, 2);
    let mottle = rough(u, v, (4, 3), 3, 4);
    let grain = rough(u, v, (70, 70), 4, 2);
    let crust = noise(u, v, (5, 5), 5) + 0.5 * noise(u, v, (15, 15), 6) + 0.3 * noise(u, v, (50, 50), 7);
    let pale = ops::smoothstep(0.30, 0.62, crust);
    // An eye is a lens with a brow over it.
    let eye = strokes((3.0 * u, 4.0 * (v + 0.4 * bend)), (3, 4), 8, |n| (n < 0.34).then_some((0.34, 0.085)));
    let brow = (1.0 - ops::smoothstep(0.0, 0.34, (eye - 1.0).abs())) * 0.8;
    let inside = 1.0 - ops::smoothstep(0.55, 0.9, eye);
    let pore = strokes((26.0 * u, 40.0 * v), (26, 40), 9, |n| (n < 0.12).then_some((0.42, 0.16)));
    let pore = 1.0 - ops::smoothstep(0.5, 1.0, pore);
    let height =
        0.5 + 0.20 * wrinkle + 0.18 * mottle + 0.05 * grain + 0.25 * brow - 0.2 * inside + 0.12 * pore;
    let paint = shade(colour, 1.0 + 0.20 * mottle + 0.10 * wrinkle + 0.07 * grain);
    let paint = mix(paint, weathered(colour, 0.45, 1.28), 0.45 * pale);
    let paint = shade(paint, 1.0 - 0.28 * inside - 0.20 * brow + 0.10 * pore);
    Spot { height, paint, rough: 0.78 + 0.08 * pale, through: 0.0 }
}

/// Paints white paper: lenticels across, sheets that peel across and show the young bark, rhombs of old black cork.
fn birch(colour: Paint, u: f64, v: f64) -> Spot {
    const DARK: Paint = [0.165, 0.145, 0.13];
    const FRESH: Paint = [0.86, 0.70, 0.56];
    let wave = 0.006 * noise(u, v, (3, 4), 1) + 0.003 * noise(u, v, (9, 9), 2);
    let y = v + wave;
    let pore = strokes((5.0 * u, 42.0 * y), (5, 42), 3, |n| {
        (n < 0.42).then_some((0.10 + 0.85 * n, 0.10 + 0.20 * n))
    });
    let fine = strokes((14.0 * u, 90.0 * y), (14, 90), 4, |n| (n < 0.30).then_some((0.10 + 1.2 * n, 0.22)));
    let pore = (1.0 - ops::smoothstep(0.55, 1.0, pore)).max(0.55 * (1.0 - ops::smoothstep(0.4, 1.0, fine)));
    // Sheets: bands whose lower edge is torn; below it the paper is missing for some distance.
    let torn = 0.35 * noise(u, v, (6, 5), 5) + 0.16 * rough(u, v, (22, 12), 6, 3);
    let band = 5.0 * v + torn;
    let phase = band - band.floor();
    let alive = ops::smoothstep(0.05, 0.30, noise(u, v, (4, 5), 7));
    let gone = alive * ops::smoothstep(0.0, 0.02, phase) * (1.0 - ops::smoothstep(0.16, 0.30, phase));
    let lip = alive * (1.0 - ops::smoothstep(0.0, 0.05, 1.0 - phase));
    // Rhombs, wider than high, of cork that is cracked lengthwise.
    let ragged = rough(u, v, (16, 14), 8, 3);
    let rhomb = rhombs(u, v, 0.42 * ragged);
    let crack = 1.0 - ops::smoothstep(0.0, 0.28, noise(u + 0.02 * ragged, v, (22, 7), 9).abs());
    let cork = ops::smoothstep(-0.05, 0.18, rhomb);
    let tone = 1.0 + 0.05 * rough(u, v, (5, 3), 10, 3) + 0.04 * rough(u, v, (4, 60), 11, 2);
    let paper = shade(colour, tone);
    let paint = mix(paper, FRESH, 0.62 * gone);
    let paint = shade(paint, 1.0 - 0.10 * lip);
    let paint = mix(paint, [0.36, 0.30, 0.26], 0.88 * pore * (1.0 - cork));
    let grey = mix(DARK, [0.46, 0.43, 0.40], 0.45 + 0.5 * ragged);
    let paint = mix(paint, mix(grey, DARK, 0.85 * crack), cork);
    let height = 0.42 - 0.10 * gone
        + 0.16 * lip
        + 0.10 * pore
        + 0.03 * tone
        + cork * (0.40 + 0.30 * ragged - 0.50 * crack);
    Spot { height, paint, rough: 0.62 + 0.32 * cork + 0.10 * gone, through: 0.0 }
}

/// Returns how far inside a rhomb of cork a place is, below 0 outside.
fn rhombs(u: f64, v: f64, ragged: f64) -> f64 {
    // (u, v, half width, half height); a branch's scar has a chevron over it.
    const AT: [(f64, f64, f64, f64); 5] = [
        (0.22, 0.18, 0.13, 0.07),
        (0.71, 0.47, 0.17, 0.085),
        (0.36, 0.74, 0.08, 0.05),
        (0.90, 0.86, 0.10, 0.055),
        (0.55, 0.05, 0.05, 0.03),
    ];
    let wrap = |d: f64| d - d.round();
    let inside = |&(x, y, a, b): &(f64, f64, f64, f64)| {
        1.0 - (wrap(u - x) / a).abs() - (wrap(v - y) / b).abs() + ragged
    };
    AT.iter().map(inside).fold(f64::MIN, f64::max)
}

/// Paints glossy bands: raised corky lenticels across, and strips that curl away.
fn cherry(colour: Paint, u: f64, v: f64) -> Spot {
    let wave = 0.008 * noise(u, v, (3, 3), 1) + 0.004 * noise(u, v, (10, 8), 2);
    let y = v + wave;
    let ragged = rough(u, v, (40, 24), 3, 2);
    let of = |n: f64| (n < 0.62).then_some((0.18 + 1.25 * n, 0.16 + 0.26 * n));
    let pore = strokes((6.0 * u + 0.06 * ragged, 22.0 * y + 0.12 * ragged), (6, 22), 4, of);
    let fine = strokes((18.0 * u, 60.0 * y), (18, 60), 5, |n| (n < 0.25).then_some((0.4, 0.25)));
    let cork = (1.0 - ops::smoothstep(0.55, 1.0, pore)).max(0.5 * (1.0 - ops::smoothstep(0.5, 1.0, fine)));
    let torn = 0.30 * noise(u, v, (5, 4), 6) + 0.14 * rough(u, v, (18, 12), 7, 3);
    let band = 4.0 * v + torn;
    let phase = band - band.floor();
    let alive = ops::smoothstep(0.10, 0.40, noise(u, v, (3, 4), 8));
    let gone = alive * ops::smoothstep(0.0, 0.02, phase) * (1.0 - ops::smoothstep(0.10, 0.22, phase));
    let lip = alive * (1.0 - ops::smoothstep(0.0, 0.05, 1.0 - phase));
    let streak = rough(u, y, (3, 70), 9, 3);
    let mottle = rough(u, v, (4, 4), 10, 3);
    let skin = shade(colour, 1.0 + 0.16 * streak + 0.20 * mottle);
    // Silvery where the outermost skin is thin.
    let skin =
        mix(skin, weathered(colour, 0.35, 1.55), 0.30 * ops::smoothstep(0.0, 0.5, streak + 0.6 * mottle));
    let paint = mix(skin, [colour[0] * 1.30, colour[1] * 0.92, colour[2] * 0.72], 0.6 * gone);
    let paint = mix(paint, weathered(colour, 0.9, 1.62), 0.72 * cork * (1.0 - 0.35 * ragged.abs()));
    let paint = shade(paint, 1.0 - 0.30 * lip);
    let split = cork * (1.0 - ops::smoothstep(0.05, 0.20, pore));
    let paint = shade(paint, 1.0 - 0.45 * split);
    let height =
        0.38 + 0.42 * cork + 0.15 * cork * ragged - 0.22 * split - 0.10 * gone + 0.22 * lip + 0.05 * streak;
    Spot { height, paint, rough: 0.46 + 0.44 * cork + 0.15 * gone, through: 0.0 }
}

/// Paints scars of leaves: rings with a lip, cracked lengthwise, fibres between.
fn ringed(colour: Paint, u: f64, v: f64) -> Spot {
    let y = 6.0 * v
        + 0.20 * noise(u, v, (3, 6), 1)
        + 0.10 * noise(u, v, (9, 12), 2)
        + 0.04 * rough(u, v, (30, 24), 3, 2);
    let phase = y - y.floor();
    // The scar swells, ends in a sharp edge, and a groove follows.
    let swell = ops::smoothstep(0.10, 0.86, phase) * (1.0 - ops::smoothstep(0.93, 1.0, phase));
    let groove = (1.0 - ops::smoothstep(0.0, 0.10, phase)).max(ops::smoothstep(0.96, 1.0, phase));
    let sway = 0.012 * noise(u, v, (6, 4), 4);
    let fibre = rough(u + sway, v, (56, 8), 5, 3);
    let split =
        strokes((34.0 * (u + sway), 9.0 * v), (34, 9), 6, |n| (n < 0.5).then_some((0.05 + 0.10 * n, 0.49)));
    let crack = 0.8 * (1.0 - ops::smoothstep(0.4, 1.0, split));
    let grain = rough(u, v, (70, 60), 8, 2);
    let height = 0.34 + 0.40 * swell - 0.22 * groove - 0.22 * crack + 0.12 * fibre + 0.05 * grain;
    let paint = weathered(colour, 0.8 + 0.3 * noise(u, v, (4, 6), 9), 0.98 + 0.18 * swell);
    let paint = shade(paint, 1.0 + 0.26 * fibre + 0.12 * grain);
    let paint = mix(paint, weathered(colour, 1.1, 0.42), (0.75 * groove).max(0.7 * crack));
    Spot { height, paint: lichen(paint, u, v, height, 0.25), rough: 0.9, through: 0.0 }
}

/// Paints one joint for each turn of the tile: a pale ring of wax below a raised edge.
fn cane(colour: Paint, u: f64, v: f64) -> Spot {
    let gloss = rough(u, v, (30, 2), 1, 2);
    let mottle = rough(u, v, (4, 3), 2, 3);
    let from = (v - 0.5).abs();
    let wax = ops::smoothstep(0.0, 0.01, 0.5 - v) * (1.0 - ops::smoothstep(0.02, 0.09, 0.5 - v));
    let edge = 1.0 - ops::smoothstep(0.006, 0.018, from);
    let sheath = 1.0 - ops::smoothstep(0.0, 0.006, (from - 0.022).abs());
    let paint = shade(colour, 1.0 + 0.10 * gloss + 0.14 * mottle);
    let paint = mix(paint, [0.86, 0.87, 0.75], 0.55 * wax);
    let paint = mix(paint, shade(colour, 0.45), edge.max(0.6 * sheath));
    let height = 0.30 + 0.55 * (1.0 - ops::smoothstep(0.008, 0.035, from)) + 0.03 * gloss;
    Spot { height, paint, rough: 0.38 + 0.25 * wax, through: 0.0 }
}

/// Paints four ribs, light on their crests, each with a row of grey felt from which spines spread.
fn ribbed(colour: Paint, u: f64, v: f64) -> Spot {
    const FELT: Paint = [0.72, 0.67, 0.56];
    const ROWS: f64 = 8.0;
    let x = 4.0 * u;
    let rib = x.floor();
    // From the crest, in widths of a rib: 0 on it, 0.5 in the furrow.
    let aside = x - rib - 0.5;
    // The rows of neighbouring ribs stand at different heights.
    let y = ROWS * v + 0.37 * rib + 0.10 * noise(u, v, (4, 5), 1);
    let up = (y - y.floor() - 0.5) / ROWS * 4.0;
    let away = (aside * aside + up * up).sqrt();
    let felt = 1.0 - ops::smoothstep(0.06, 0.11, away);
    // Spines spread from the felt like the spokes of a wheel.
    let turn = ops::atan2(up, aside) * 11.0 / ops::TAU + 3.0 * noise(u, v, (16, 16), 2);
    let spoke = 1.0 - ops::smoothstep(0.10, 0.30, (turn - turn.round()).abs());
    let spines = spoke * (1.0 - ops::smoothstep(0.16, 0.34, away)) * (1.0 - felt);
    let mottle = rough(u, v, (6, 4), 3, 3);
    let grain = rough(u, v, (48, 48), 4, 2);
    let lit = 1.0 - ops::smoothstep(0.05, 0.5, aside.abs());
    let paint = shade(colour, 0.72 + 0.44 * lit + 0.10 * mottle + 0.06 * grain);
    let paint = mix(paint, FELT, (0.85 * felt).max(0.75 * spines));
    Spot {
        height: 0.4 + 0.2 * lit + 0.3 * felt + 0.1 * spines + 0.05 * grain,
        paint,
        rough: 0.62,
        through: 0.0,
    }
}

/// Paints fine lengthwise wrinkles, lenticels, and thin skin that peels in places.
fn twig(colour: Paint, u: f64, v: f64) -> Spot {
    let sway = 0.03 * noise(u, v, (3, 3), 1);
    let wrinkle = rough(u + sway, v, (12, 3), 2, 3);
    let mottle = rough(u, v, (4, 4), 3, 3);
    let grain = rough(u, v, (44, 30), 4, 2);
    let pore = strokes((9.0 * u, 12.0 * v), (9, 12), 5, |n| (n < 0.45).then_some((0.13, 0.07 + 0.14 * n)));
    let pore = 1.0 - ops::smoothstep(0.6, 1.0, pore);
    let ring = 1.0 - ops::smoothstep(0.0, 0.012, (v - 0.31 - 0.5 * sway).abs());
    let height = 0.45 + 0.42 * wrinkle + 0.10 * grain + 0.25 * pore + 0.16 * ring;
    let paint = shade(colour, 1.0 + 0.34 * wrinkle + 0.22 * mottle + 0.10 * grain);
    let paint = mix(paint, weathered(colour, 0.6, 1.45), (0.45 * pore).max(0.25 * ring));
    Spot { height, paint, rough: 0.74 + 0.12 * pore, through: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bark_has_its_colour_no_seam_and_sound_normals() {
        let colour = [0.50, 0.44, 0.38];
        for kind in BarkKind::ALL {
            let s = bark(kind, colour, 128, &Run::plain()).expect("not cancelled");
            let mean = |t: &mesh::Texture, k: usize| {
                let sum: u64 = t.pixels.chunks_exact(4).map(|p| u64::from(p[k])).sum();
                sum / u64::from(t.width * t.height)
            };
            if kind != BarkKind::Birch {
                let off = mean(&s.color, 1).abs_diff(112);
                assert!(off < 12, "{kind:?} has its colour: {off}");
            }
            let all: Vec<_> = s.maps.each().chain([&s.color]).collect();
            assert_eq!(all.len(), 4, "colour, normal, occlusion with roughness, height");
            for t in all {
                let at = |x: u32, y: u32, k: usize| i32::from(t.pixels[4 * (y * 128 + x) as usize + k]);
                let step =
                    |x: u32| (0..128).map(|y| (at(x, y, 1) - at((x + 1) % 128, y, 1)).abs()).sum::<i32>();
                let most = (0..127).map(step).max().unwrap_or(0);
                assert!(step(127) <= most + 128, "{kind:?}: {} at the seam, {most} at most", step(127));
                let step =
                    |y: u32| (0..128).map(|x| (at(x, y, 1) - at(x, (y + 1) % 128, 1)).abs()).sum::<i32>();
                let most = (0..127).map(step).max().unwrap_or(0);
                assert!(step(127) <= most + 128, "{kind:?}: {} at the end, {most} at most", step(127));
            }
            let normal = s.maps.normal.as_ref().expect("normals");
            for p in normal.pixels.chunks_exact(4) {
                let n = [0, 1, 2].map(|k| f64::from(p[k]) / 127.5 - 1.0);
                let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
                assert!((length - 1.0).abs() < 0.02 && n[2] > 0.0, "{kind:?}: {n:?}");
            }
            // The relief is not plane, and its normals do not lean on average.
            assert!(mean(normal, 0).abs_diff(128) < 3 && mean(normal, 1).abs_diff(128) < 3, "{kind:?}");
            let level = |p: &&[u8]| p[0].abs_diff(128) < 2 && p[1].abs_diff(128) < 2;
            let flat = normal.pixels.chunks_exact(4).filter(level).count();
            assert!(flat < 128 * 128 * 99 / 100, "{kind:?}: {flat} of it are flat");
        }
    }

    #[test]
    fn a_surface_is_painted_once_for_each_content() {
        let twice = [1, 2]
            .map(|_| bark(BarkKind::Twig, [0.4, 0.3, 0.2], 64, &Run::plain()).expect("not cancelled").color);
        assert!(std::sync::Arc::ptr_eq(&twice[0], &twice[1]), "kept");
        let other = bark(BarkKind::Twig, [0.4, 0.3, 0.3], 64, &Run::plain()).expect("not cancelled").color;
        assert!(!std::sync::Arc::ptr_eq(&twice[0], &other), "another colour is another surface");
    }

    #[test]
    fn what_is_stopped_is_not_kept() {
        let (plain, cancel) = (Run::plain(), base::CancelToken::new());
        let stopped = Run { cancel: &cancel, ..plain };
        cancel.cancel();
        // A colour that no other test has.
        let paint = |run: &Run<'_>| bark(BarkKind::Twig, [0.41, 0.32, 0.23], 64, run);
        assert!(paint(&stopped).is_err());
        assert_eq!(paint(&plain).expect("not cancelled").color.pixels.len(), 4 * 64 * 64);
        assert!(paint(&stopped).is_ok(), "what was painted to its end is known");
    }
}
