//! The look of the large bodies of a drawing: the flesh of a cactus, or the skin of a fruit, a root or a tuber.

use std::borrow::Cow;

use geom::{bounds, perimeter, polyline_length, polyline_length3, signed_area};
use glam::DVec2;
use plant::{OrganKind, Paint, Plant, Shape};
use reading::{FruitReading, Kind, PlantReading, Reading};

/// A fruit is a body if it is longer than this share of its plant.
const BODY: f64 = 0.4;
/// That share for a plant with thorns.
const THORNY_BODY: f64 = 0.12;
/// A body is long if its length is more than this factor of its width, as in bananas, pods and cucumbers.
const LONG: f64 = 2.2;
/// A ball is at most this many times as long as wide, or as wide as long.
const BALL: f64 = 1.15;
/// The length of a root is more than this factor of its width.
const ROOT_LONG: f64 = 1.3;
/// The thinner end of a root is thinner than this share of its thicker end.
const ROOT_POINT: f64 = 0.6;
/// The length of a root that was read as a fruit is more than this factor of its width; a strawberry is shorter.
const FRUIT_ROOT_LONG: f64 = 1.6;
/// The length of a pear is more than this factor of its width.
const PEAR_LONG: f64 = 1.1;
/// A chilli is at its tip thinner than this share of its other end; both ends of a banana are alike.
const CHILLI: f64 = 0.7;
/// A pear is at its stalk thinner than this share of its other end.
const PEAR_NECK: f64 = 0.75;
/// A strawberry, unlike a pineapple, is at its tip thinner than this share of its other end.
const STRAWBERRY: f64 = 0.55;
/// This many bodies of one plant, or more, are berries or peas.
const MANY: usize = 4;
/// Fewest leaves on a pineapple.
const TUFT: usize = 3;
/// Least height of these leaves as a share of the body's height.
const TUFT_HIGH: f64 = 0.25;
/// A pineapple's width is less than this factor of its length.
const TUFT_WIDE: f64 = 1.25;
/// They begin above this share of its height.
const TUFT_FROM: f64 = 0.8;
/// A stalk begins above this share of a fruit's height.
const STALK_FROM: f64 = 0.6;
/// A leaf on a fruit begins at most this share of its height above it.
const LEAF_NEAR: f64 = 0.15;
/// At least this many florets stand on an involucre,
const FLORETS: usize = 8;
/// begin between these shares of its height,
const FLORETS_FROM: core::ops::Range<f64> = 0.6..1.3;
/// and end above it by more than this share of that.
const FLORETS_HIGH: f64 = 0.25;
/// Vertical component of the direction of a body that hangs or stands: within 45 degrees.
const UPRIGHT: f64 = -0.7;
/// Share of the length that counts as an end.
const END: f64 = 0.3;
/// Shares of the length, from the thinner end, between which the width is measured at two places. A stem under a cap
/// keeps its width.
const TAPER: [[f64; 2]; 2] = [[0.05, 0.15], [0.2, 0.3]];
/// A body that runs out to a point is at the first place thinner than this share of its width at the second: a cone
/// has 0.4 (*geometry*).
const TAPERS: f64 = 0.85;

/// Linear red, green and blue of a banana.
const YELLOW: [f32; 3] = [0.80, 0.55, 0.04];
/// Linear red, green and blue of a carrot.
const ORANGE: [f32; 3] = [0.83, 0.22, 0.02];
/// Linear red, green and blue of green fruits and vegetables.
const GREEN: [f32; 3] = [0.14, 0.31, 0.05];
/// Linear red, green and blue of an onion or a potato.
const TAN: [f32; 3] = [0.52, 0.34, 0.16];
/// Linear red, green and blue of a pear.
const PEAR: [f32; 3] = [0.50, 0.52, 0.07];
/// Linear red, green and blue of dark berries.
const BERRY: [f32; 3] = [0.09, 0.025, 0.14];
/// Linear red, green and blue of a blueberry.
const BLUE: [f32; 3] = [0.05, 0.07, 0.22];
/// Linear red, green and blue of a mushroom.
const CREAM: [f32; 3] = [0.62, 0.48, 0.33];
/// The outline of a whole melon fills at least this share of a circle with its perimeter (4 pi A / P^2); half a disc
/// fills 0.75 (*geometry*), and a slice shows its flesh.
const WHOLE: f64 = 0.9;

/// Names the large bodies of cacti, and gives fruits and vegetables that were not drawn in colour the usual colour of
/// the plant that they look like, or else of their form. Among fruits, one that bears a tuft is a pineapple with eyes,
/// long ones are yellow, pears a yellow green, many of one plant as dark as berries, others red. Among vegetables,
/// roots that run out to a point are orange, long or bent ones and many of one plant green, others tan.
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
        let Some(form) = plant.shapes.get(organ.shape.index()).and_then(Form::from_shape) else { continue };
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
        let bodies = of_plants.iter().filter(|p| **p == of).count();
        let many = bodies >= MANY;
        let natural = matches!(organ.paint, Paint::Natural(_));
        let word = of.and_then(|k| reading.plants[k].word);
        let is_pineapple = || word == Some("pineapple") || has_tuft(reading, organ.source);
        if natural && kind == Kind::Fruit && bodies == 1 && !form.is_pointed() && is_pineapple() {
            organ.kind = OrganKind::Syncarp;
            continue;
        }
        let points_up = organ.frame.along.y < UPRIGHT && form.ends[0] < form.ends[1];
        let by_form = || match kind {
            Kind::Fruit => fruit_skin(&form, many),
            _ => Some(vegetable_skin(&form, many, points_up)),
        };
        let skin = match word {
            // Red, as a slice of a melon is.
            Some("apple" | "strawberry") => None,
            // Berries are balls, and have neither stalks of their own nor leaves.
            Some("blueberry")
                if !form.is_ball()
                    || !many && (has_stalk(reading, organ.source) || has_leaf(reading, organ.source)) =>
            {
                by_form()
            }
            // A word for something round says nothing of a long body.
            Some("watermelon" | "potato" | "onion") if form.is_long() => by_form(),
            Some("watermelon") if !is_whole(reading, organ.source) => None,
            // The thin end of a pear is that of its stalk.
            Some("pear") if form.is_root() || form.is_long() => by_form(),
            word => word.and_then(skin_of).or_else(by_form),
        };
        if let (Paint::Natural(varied), Some(skin)) = (organ.paint, skin) {
            organ.paint = tinted(varied, skin);
        }
    }
}

/// Returns a colour with the variation of an organ.
fn tinted(varied: [f32; 3], color: [f32; 3]) -> Paint {
    Paint::Tinted([0, 1, 2].map(|k| varied[k] * color[k]))
}

/// Measures of the form of a body.
#[derive(Debug)]
struct Form {
    tall: f64,
    wide: f64,
    /// Mean half widths of both ends, first of the end at its stalk.
    ends: [f64; 2],
    /// The thinner end is a point rather than a stem.
    runs_out: bool,
    bent: bool,
}

impl Form {
    fn from_shape(shape: &Shape) -> Option<Self> {
        let (profile, bent) = match shape {
            Shape::Revolution { profile } => (Cow::Borrowed(profile), false),
            Shape::Strand { path, radius_m, .. } if shape.is_bent_body() => {
                let way = (0..path.len()).map(|k| polyline_length3(&path[..=k]));
                (Cow::Owned(radius_m.iter().zip(way).map(|(r, y)| DVec2::new(*r, y)).collect()), true)
            }
            _ => return None,
        };
        // The root of a cactus's body is its origin, even if no part of it lies there.
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

    /// Whether it is thinner away from its stalk, as a strawberry is.
    fn is_pointed(&self) -> bool {
        self.ends[1] < STRAWBERRY * self.ends[0]
    }

    fn is_ball(&self) -> bool {
        (1.0 / BALL..BALL).contains(&(self.tall / self.wide))
    }

    fn is_long(&self) -> bool {
        self.tall > LONG * self.wide
    }

    /// Whether it is longish and runs out to a point away from its stalk, as a carrot or a chilli does.
    fn is_root(&self) -> bool {
        self.runs_out && self.tall > FRUIT_ROOT_LONG * self.wide && self.is_pointed()
    }
}

/// Returns the body that a stroke became.
fn body(reading: &Reading, source: Option<u32>) -> Option<&FruitReading> {
    reading.fruits.iter().find(|f| f.source == source && source.is_some())
}

/// Whether leaves stand on it, all from its top.
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

/// Whether a line ends on the upper side of a body and leads up from it.
fn has_stalk(reading: &Reading, source: Option<u32>) -> bool {
    let Some((low, high)) = body(reading, source).and_then(|f| bounds(&f.outline)) else { return false };
    let tall = high.y - low.y;
    reading.axes.iter().filter_map(|a| bounds(&a.points)).any(|(foot, top)| {
        foot.y > low.y + STALK_FROM * tall && top.y > high.y && foot.x < high.x && top.x > low.x
    })
}

/// Whether a leaf begins on the upper side of a body.
fn has_leaf(reading: &Reading, source: Option<u32>) -> bool {
    let Some((low, high)) = body(reading, source).and_then(|f| bounds(&f.outline)) else { return false };
    let size = high - low;
    reading.leaves.iter().any(|leaf| {
        let root = leaf.root;
        root.y > low.y + STALK_FROM * size.y
            && root.y < high.y + LEAF_NEAR * size.y
            && root.x > low.x
            && root.x < high.x
    })
}

/// Whether a body is drawn whole rather than in slices.
fn is_whole(reading: &Reading, source: Option<u32>) -> bool {
    body(reading, source).is_some_and(|f| {
        let around = perimeter(&f.outline);
        4.0 * core::f64::consts::PI * signed_area(&f.outline).abs() > WHOLE * around * around
    })
}

/// Returns the colour of a plant whose name determines it.
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

/// Returns the usual colour of a fruit by its form; `None`: red.
fn fruit_skin(form: &Form, many: bool) -> Option<[f32; 3]> {
    let [stalk, tip] = form.ends;
    if many {
        Some(BERRY)
    } else if form.is_root() && !form.bent {
        Some(ORANGE)
    } else if form.is_long() && tip < CHILLI * stalk {
        None
    } else if form.is_long() {
        Some(YELLOW)
    } else if form.tall > PEAR_LONG * form.wide && stalk < PEAR_NECK * tip {
        Some(PEAR)
    } else {
        None
    }
}

/// Returns the usual colour of a vegetable by its form. `points_up`: it stands, and its thinner end is the upper one,
/// as in a spear but not in a root.
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
