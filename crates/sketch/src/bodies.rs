//! What the large bodies of a drawing look like: the flesh of a cactus, or the skin of a fruit, a root or a tuber.

use std::borrow::Cow;

use geom::{bounds, perimeter, polyline_length, polyline_length3, signed_area};
use glam::DVec2;
use plant::{OrganKind, Paint, Plant, Shape};
use reading::{FruitReading, Kind, PlantReading, Reading};

/// A fruit is a body if it is longer than this share of its plant; less, if that bears thorns.
const BODY: f64 = 0.4;
const THORNY_BODY: f64 = 0.12;
/// Longer than so many widths it is long, as bananas, pods and cucumbers are.
const LONG: f64 = 2.2;
/// A root is longer than so many widths, and its thinner end this much thinner than its other end.
const ROOT_LONG: f64 = 1.3;
const ROOT_POINT: f64 = 0.6;
/// A pear is longer than so many widths, and at its stalk this much thinner than at its other end.
const PEAR_LONG: f64 = 1.1;
const PEAR_NECK: f64 = 0.75;
/// A strawberry is thinner than this share at its tip, of its other end: no pineapple.
const STRAWBERRY: f64 = 0.55;
/// So many bodies or more of one plant are berries, or peas.
const MANY: usize = 4;
/// On a pineapple stand so many leaves at least, as high as this share of it; it is no wider than so many times its length.
const TUFT: usize = 3;
const TUFT_HIGH: f64 = 0.25;
const TUFT_WIDE: f64 = 1.25;
/// They begin above this share of its height.
const TUFT_FROM: f64 = 0.8;
/// So many florets or more stand on an involucre,
const FLORETS: usize = 8;
/// begin between these shares of its height,
const FLORETS_FROM: core::ops::Range<f64> = 0.6..1.3;
/// and end above it by more than this share of that.
const FLORETS_HIGH: f64 = 0.25;
/// The height of its direction where a body hangs or stands: within 45 degrees.
const UPRIGHT: f64 = -0.7;
/// Which parts of the length its ends are.
const END: f64 = 0.3;
/// Where its thinner end is looked at, shares of the length from there: one that runs out to a point is thinner at the first than
/// so many times at the second, of a cone 0.4 (*geometry*); a stem under a cap keeps its width.
const TAPER: [[f64; 2]; 2] = [[0.05, 0.15], [0.2, 0.3]];
const TAPERS: f64 = 0.85;

/// Linear red, green and blue of skins.
const YELLOW: [f32; 3] = [0.80, 0.55, 0.04];
const ORANGE: [f32; 3] = [0.83, 0.22, 0.02];
const GREEN: [f32; 3] = [0.14, 0.31, 0.05];
const TAN: [f32; 3] = [0.52, 0.34, 0.16];
const PEAR: [f32; 3] = [0.50, 0.52, 0.07];
const BERRY: [f32; 3] = [0.09, 0.025, 0.14];
const BLUE: [f32; 3] = [0.05, 0.07, 0.22];
const CREAM: [f32; 3] = [0.62, 0.48, 0.33];
/// The outline of a whole melon fills at least this share of a circle as long as it (4 pi A / P^2); of half a disc that is 0.75
/// (*geometry*), and a slice shows its flesh.
const WHOLE: f64 = 0.9;

/// Names the large bodies of cacti, and gives those of fruits and vegetables the usual colour of what they look like, or else of
/// their form, where nobody drew them in colour. Of fruits what bears a tuft is a pineapple with eyes, long ones are yellow, pears
/// a yellow green, many of one plant as dark as berries, others red. Of vegetables roots that run out to a point are orange, long
/// or bent ones and many of one plant green, others tan.
pub(crate) fn name_bodies(plant: &mut Plant, reading: &Reading) {
    let Some((low, high)) = plant.extent() else { return };
    let thorny = plant.organs.iter().any(|o| o.kind == OrganKind::Thorn);
    let large = low.distance(high) * if thorny { THORNY_BODY } else { BODY };
    let row = |source: Option<u32>| {
        let has = |p: &PlantReading| source.is_some_and(|s| p.strokes.contains(&s));
        reading.plants.iter().position(has)
    };
    let fruits = plant.organs.iter().filter(|o| o.kind == OrganKind::Fruit);
    let of_plants: Vec<Option<usize>> = fruits.map(|o| row(o.source)).collect();
    for organ in plant.organs.iter_mut().filter(|o| o.kind == OrganKind::Fruit) {
        let Some(form) = plant.shapes.get(organ.shape.index()).and_then(Form::of) else { continue };
        let of = row(organ.source);
        let kind = of.and_then(|k| reading.plants.get(k)).map_or(Kind::None, |p| p.kind);
        if !kind.is_like(Kind::Fruit) {
            if form.tall * organ.scale > large {
                organ.kind = OrganKind::Body;
            }
            if let Paint::Natural(varied) = organ.paint
                && is_involucre(reading, organ.source)
            {
                organ.paint = tinted(varied, GREEN);
            }
            continue;
        }
        let many = of_plants.iter().filter(|p| **p == of).count() >= MANY;
        let natural = matches!(organ.paint, Paint::Natural(_));
        if natural && kind == Kind::Fruit && !many && !form.is_pointed() && has_tuft(reading, organ.source) {
            organ.kind = OrganKind::Syncarp;
            continue;
        }
        let points_up = organ.frame.along.y < UPRIGHT && form.ends[0] < form.ends[1];
        let by_form = || match kind {
            Kind::Fruit => fruit_skin(&form, many),
            _ => Some(vegetable_skin(&form, many, points_up)),
        };
        let skin = match of.and_then(|k| reading.plants[k].word) {
            // Red, as a slice of a melon is.
            Some("apple" | "strawberry") => None,
            Some("watermelon") if !is_whole(reading, organ.source) => None,
            word => word.and_then(skin_of).or_else(by_form),
        };
        if let (Paint::Natural(varied), Some(skin)) = (organ.paint, skin) {
            organ.paint = tinted(varied, skin);
        }
    }
}

/// A colour with the variation of an organ.
fn tinted(varied: [f32; 3], color: [f32; 3]) -> Paint {
    Paint::Tinted([0, 1, 2].map(|k| varied[k] * color[k]))
}

/// What the form of a body says about it.
#[derive(Debug)]
struct Form {
    tall: f64,
    wide: f64,
    /// Mean half widths of both ends, of that at its stalk first.
    ends: [f64; 2],
    /// The thinner end is a point rather than a stem.
    runs_out: bool,
    bent: bool,
}

impl Form {
    fn of(shape: &Shape) -> Option<Self> {
        let (profile, bent) = match shape {
            Shape::Revolution { profile } => (Cow::Borrowed(profile), false),
            Shape::Strand { path, radius_m, .. } if shape.is_bent_body() => {
                let way = (0..path.len()).map(|k| polyline_length3(&path[..=k]));
                (Cow::Owned(radius_m.iter().zip(way).map(|(r, y)| DVec2::new(*r, y)).collect()), true)
            }
            _ => return None,
        };
        // The root of a cactus's body is its origin, even if nothing of it is there.
        let (low, high) = profile.iter().fold((0.0_f64, 0.0_f64), |(a, b), p| (a.min(p.y), b.max(p.y)));
        let tall = high - low;
        let mean = |from: f64, to: f64| {
            let at = |p: &&DVec2| p.y >= low + from * tall && p.y <= low + to * tall;
            let (sum, n) = profile.iter().filter(at).fold((0.0, 0.0_f64), |(s, n), p| (s + p.x, n + 1.0));
            sum / n.max(1.0)
        };
        let wide = 2.0 * profile.iter().map(|p| p.x).fold(0.0, f64::max);
        let ends = [mean(0.0, END), mean(1.0 - END, 1.0)];
        let from_thin =
            |[a, b]: [f64; 2]| if ends[0] < ends[1] { mean(a, b) } else { mean(1.0 - b, 1.0 - a) };
        let runs_out = from_thin(TAPER[0]) < TAPERS * from_thin(TAPER[1]);
        Some(Self { tall, wide, ends, runs_out, bent })
    }

    /// Thinner away from its stalk, as a strawberry is.
    fn is_pointed(&self) -> bool {
        self.ends[1] < STRAWBERRY * self.ends[0]
    }

    fn is_long(&self) -> bool {
        self.tall > LONG * self.wide
    }
}

/// The body that a stroke gave.
fn body(reading: &Reading, source: Option<u32>) -> Option<&FruitReading> {
    reading.fruits.iter().find(|f| f.source == source && source.is_some())
}

/// Leaves stand on it, all from its top.
fn has_tuft(reading: &Reading, source: Option<u32>) -> bool {
    let Some((low, high)) = body(reading, source).and_then(|f| bounds(&f.outline)) else { return false };
    let tall = high.y - low.y;
    let on_top = |line: &[DVec2]| {
        bounds(line).is_some_and(|(l, h)| {
            l.y > low.y + TUFT_FROM * tall
                && h.y > high.y + 0.5 * TUFT_HIGH * tall
                && l.x < high.x
                && h.x > low.x
                && polyline_length(line) > TUFT_HIGH * tall
        })
    };
    let petals = reading.flowers.iter().flat_map(|f| &f.petals);
    let blades = reading.leaves.iter().chain(petals).filter(|b| on_top(&b.outline)).count();
    let lines = reading.axes.iter().filter(|a| on_top(&a.points)).count();
    let wide = high.x - low.x;
    wide < TUFT_WIDE * tall && (blades >= TUFT || lines >= TUFT || blades + lines > TUFT)
}

/// Whether a body is the involucre of a head: many florets begin at its upper end and lead out of it.
fn is_involucre(reading: &Reading, source: Option<u32>) -> bool {
    let Some((low, high)) = body(reading, source).and_then(|f| bounds(&f.outline)) else { return false };
    let tall = high.y - low.y;
    let is_foot = |p: DVec2| {
        let level = (p.y - low.y) / tall;
        p.x > low.x && p.x < high.x && FLORETS_FROM.contains(&level)
    };
    let leads_out = |foot: DVec2, tip: DVec2| is_foot(foot) && tip.y > high.y + FLORETS_HIGH * tall;
    let axes = reading.axes.iter().filter_map(|a| a.points.first().zip(a.points.last()));
    let lines = axes.filter(|&(&a, &b)| leads_out(a, b) || leads_out(b, a)).count();
    let petals = reading.flowers.iter().flat_map(|f| &f.petals);
    let blades = reading.leaves.iter().chain(petals).filter(|b| leads_out(b.root, b.tip)).count();
    lines + blades >= FLORETS
}

/// Whether a body is drawn whole rather than in slices.
fn is_whole(reading: &Reading, source: Option<u32>) -> bool {
    body(reading, source).is_some_and(|f| {
        let around = perimeter(&f.outline);
        4.0 * core::f64::consts::PI * signed_area(&f.outline).abs() > WHOLE * around * around
    })
}

/// The colour of what goes by a word that says one.
fn skin_of(word: &str) -> Option<[f32; 3]> {
    match word {
        "watermelon" | "broccoli" | "asparagus" | "peas" | "string bean" => Some(GREEN),
        "banana" => Some(YELLOW),
        "pear" => Some(PEAR),
        "blackberry" | "grapes" => Some(BERRY),
        "blueberry" => Some(BLUE),
        "carrot" => Some(ORANGE),
        "mushroom" => Some(CREAM),
        "onion" | "potato" => Some(TAN),
        _ => None,
    }
}

/// The usual colour of a fruit by its form; `None`: red.
fn fruit_skin(form: &Form, many: bool) -> Option<[f32; 3]> {
    let [stalk, tip] = form.ends;
    if many {
        Some(BERRY)
    } else if form.is_long() {
        Some(YELLOW)
    } else if form.tall > PEAR_LONG * form.wide && stalk < PEAR_NECK * tip {
        Some(PEAR)
    } else {
        None
    }
}

/// The usual colour of a vegetable by its form.
/// `points_up`: it stands, and its thinner end is the upper one, as a spear's is and no root's.
fn vegetable_skin(form: &Form, many: bool, points_up: bool) -> [f32; 3] {
    let [a, b] = form.ends;
    if many || form.bent {
        GREEN
    } else if !points_up
        && form.runs_out
        && form.tall > ROOT_LONG * form.wide
        && a.min(b) < ROOT_POINT * a.max(b)
    {
        ORANGE
    } else if form.is_long() {
        GREEN
    } else {
        TAN
    }
}
