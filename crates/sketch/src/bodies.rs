//! What the large bodies of a drawing look like: the flesh of a cactus, or the skin of a fruit, a root or a tuber.

use glam::DVec2;
use plant::{OrganKind, Paint, Plant, Shape};
use reading::{Kind, PlantReading, Reading};

/// A fruit is a body if it is longer than this share of its plant; less, if that bears thorns.
const BODY: f64 = 0.4;
const THORNY_BODY: f64 = 0.12;
/// Longer than so many widths it is long, as bananas, pods and cucumbers are.
const LONG: f64 = 2.2;
/// A root is longer than so many widths, and its thinner end this much thinner than its other end.
const ROOT_LONG: f64 = 1.3;
const ROOT_POINT: f64 = 0.6;
/// Which parts of the length its ends are.
const END: f64 = 0.3;

/// Linear red, green and blue of skins.
const YELLOW: [f32; 3] = [0.80, 0.55, 0.04];
const ORANGE: [f32; 3] = [0.83, 0.22, 0.02];
const GREEN: [f32; 3] = [0.14, 0.31, 0.05];
const TAN: [f32; 3] = [0.52, 0.34, 0.16];

/// Names the large bodies of cacti, and gives those of fruits and vegetables the usual colour of their form, where nobody
/// drew them in colour: long fruits are yellow, roots that run to a point orange, long vegetables green, others tan; all
/// other fruits are red.
pub(crate) fn name_bodies(plant: &mut Plant, reading: &Reading) {
    let Some((low, high)) = plant.extent() else { return };
    let thorny = plant.organs.iter().any(|o| o.kind == OrganKind::Thorn);
    let large = low.distance(high) * if thorny { THORNY_BODY } else { BODY };
    for organ in plant.organs.iter_mut().filter(|o| o.kind == OrganKind::Fruit) {
        let Some(Shape::Revolution { profile }) = plant.shapes.get(organ.shape.index()) else { continue };
        let kind = kind_of(reading, organ.source);
        if !kind.is_like(Kind::Fruit) {
            if length(profile) * organ.scale > large {
                organ.kind = OrganKind::Body;
            }
        } else if let (Paint::Natural(varied), Some(skin)) = (organ.paint, skin(kind, profile)) {
            organ.paint = Paint::Tinted([0, 1, 2].map(|k| varied[k] * skin[k]));
        }
    }
}

/// The kind of the plant of a stroke.
fn kind_of(reading: &Reading, stroke: Option<u32>) -> Kind {
    let has = |p: &&PlantReading| stroke.is_some_and(|s| p.strokes.contains(&s));
    reading.plants.iter().find(has).map_or(Kind::None, |p| p.kind)
}

fn length(profile: &[DVec2]) -> f64 {
    let (low, high) = profile.iter().fold((0.0_f64, 0.0_f64), |(a, b), p| (a.min(p.y), b.max(p.y)));
    high - low
}

/// The usual colour of a skin by the form under it; `None`: red.
fn skin(kind: Kind, profile: &[DVec2]) -> Option<[f32; 3]> {
    let tall = length(profile);
    let wide = 2.0 * profile.iter().map(|p| p.x).fold(0.0, f64::max);
    if kind == Kind::Fruit {
        return (tall > LONG * wide).then_some(YELLOW);
    }
    let low = profile.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let mean = |from: f64, to: f64| {
        let at = |p: &&DVec2| p.y >= low + from * tall && p.y <= low + to * tall;
        let (sum, n) = profile.iter().filter(at).fold((0.0, 0.0_f64), |(s, n), p| (s + p.x, n + 1.0));
        sum / n.max(1.0)
    };
    let (a, b) = (mean(0.0, END), mean(1.0 - END, 1.0));
    Some(if tall > ROOT_LONG * wide && a.min(b) < ROOT_POINT * a.max(b) {
        ORANGE
    } else if tall > LONG * wide {
        GREEN
    } else {
        TAN
    })
}
