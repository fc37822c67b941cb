//! Flowers in place of leaves.
//!
//! `Plant with leaves + BlossomSpec -> the same plant, some of its leaves now flowers`

use base::ops::{self, PI, TAU};
use base::{Draw, Seed};
use glam::{DVec2, DVec3};
use plant::{
    Blade, Flower, FlowerId, Frame, Lift, NodeId, Organ, OrganKind, Paint, Plant, Relief, Shape, ShapeId,
};

use crate::look::BlossomSpec;
use crate::obstacle::Obstacles;
use crate::tree::FlowerPlace;

// Angle from the flower's axis at which the innermost of six whorls opens.
const CLOSED: f64 = 20.0 * PI / 180.0;

/// The shapes that the flowers of a tree share.
struct Shapes {
    petal: ShapeId,
    disc: Option<ShapeId>,
    stalk: ShapeId,
}

/// Replaces leaves by flowers, and adds those that rules set. The choice of leaves follows from their keys, so that a
/// larger share keeps those of a smaller. A leaf whose flower would enter an obstacle stays a leaf.
pub fn add_blossom(
    spec: &BlossomSpec,
    plant: &mut Plant,
    set: &[FlowerPlace],
    obstacles: &Obstacles,
    seed: Seed,
) {
    let blooms = |o: &Organ| {
        o.kind == OrganKind::Leaf && seed.child(o.key).stream(Draw::Template).uniform() < spec.share
    };
    if set.is_empty() && (spec.share <= 0.0 || !plant.organs.iter().any(blooms)) {
        return;
    }
    let (places, kept): (Vec<Organ>, Vec<Organ>) =
        std::mem::take(&mut plant.organs).into_iter().partition(blooms);
    plant.organs = kept;
    let shapes = Shapes {
        petal: push(plant, Shape::Blade(petal(0.5 * spec.diameter_m, spec))),
        disc: (spec.tuft > 0.0).then(|| push(plant, Shape::Blade(disc(0.5 * spec.tuft * spec.diameter_m)))),
        stalk: push(plant, stalk(spec.stalk * spec.diameter_m)),
    };
    let both = |s: &Shape| [1.0, plant::DRAWN_WIDER].into_iter().flat_map(|w| s.corners(w)).collect();
    let corners: Vec<Vec<DVec3>> = plant.shapes.iter().map(both).collect();
    // Flowers of leaves point in random directions, those that rules set along the stalk drawn for them.
    let of_leaf = |o: Organ| {
        let place = Place { bearer: o.bearer, frame: o.frame, scale: 1.0, key: o.key, stray: [0.5, 0.7] };
        (place, Some(o))
    };
    let of_rule = |f: &FlowerPlace| {
        let (bearer, stray) = (Some(f.bearer), [0.0, 0.3]);
        (Place { bearer, frame: f.frame, scale: f.scale, key: f.key, stray }, None)
    };
    for (place, leaf) in places.into_iter().map(of_leaf).chain(set.iter().map(of_rule)) {
        let (organs, flowers) = (plant.organs.len(), plant.flowers.len());
        add_flower(spec, plant, &place, &shapes, seed);
        let free = |o: &Organ| obstacles.admit(&o.frame, o.scale, &corners[o.shape.index()]);
        if !obstacles.is_empty() && !plant.organs[organs..].iter().all(free) {
            plant.organs.truncate(organs);
            plant.flowers.truncate(flowers);
            plant.organs.extend(leaf);
        }
    }
}

/// Place of a flower.
struct Place {
    bearer: Option<NodeId>,
    frame: Frame,
    scale: f64,
    key: u64,
    /// Weights of its turns to the upper side of its place, and in a random direction.
    stray: [f64; 2],
}

fn add_flower(spec: &BlossomSpec, plant: &mut Plant, place: &Place, shapes: &Shapes, seed: Seed) {
    let key = seed.child(place.key).child(Draw::Template as u64);
    let mut draw = key.stream(Draw::Template);
    // Flowers point outwards, to the light and slightly at random.
    let stray = DVec3::new(draw.uniform() - 0.5, draw.uniform() - 0.3, draw.uniform() - 0.5);
    let [upper, astray] = place.stray;
    let axis = (place.frame.along + upper * place.frame.normal + astray * stray).normalize_or(DVec3::Y);
    let longer = (0.7 + 0.6 * draw.uniform()) * place.scale;
    let centre = place.frame.origin + place.frame.along * (spec.stalk * spec.diameter_m * longer);
    let scale = (0.85 + 0.3 * draw.uniform()) * place.scale;
    let share = draw.uniform();
    let (from, to) = (spec.color.linear(), spec.color_to.unwrap_or(spec.color).linear());
    let id = FlowerId::new(plant.flowers.len());
    let opened = spec.open_deg * PI / 180.0;
    let bearer = place.bearer;
    plant.flowers.push(Flower { bearer, centre, axis, half_angle: opened, whorls: spec.whorls });
    let across = axis.any_orthonormal_vector();
    let up = axis.cross(across);
    let turn = TAU * draw.uniform();
    let organ = |kind, shape, frame, scale, paint, key: Seed| Organ {
        kind,
        bearer,
        flower: Some(id),
        shape,
        frame,
        scale,
        paint,
        key: key.number(),
        source: None,
    };
    for whorl in 0..spec.whorls {
        let inner = f64::from(whorl) / f64::from(spec.whorls.max(2));
        let open = ops::lerp(opened, CLOSED.min(opened), inner) + 0.2 * (draw.uniform() - 0.5);
        let (rise, out) = (ops::cos(open), ops::sin(open));
        for k in 0..spec.petals {
            let step = f64::from(k) + 0.5 * f64::from(whorl % 2);
            let (s, c) = ops::sin_cos(turn + TAU * step / f64::from(spec.petals));
            let along = (across * c + up * s) * out + axis * rise;
            let frame = Frame::looking(centre, along, axis);
            let shade = 1.0 - 0.1 * draw.uniform() - 0.15 * inner;
            #[expect(clippy::cast_possible_truncation, reason = "a colour")]
            let tint = [0, 1, 2].map(|i| (shade * ops::lerp(from[i], to[i], share)) as f32);
            let key = key.child(u64::from(whorl * spec.petals + k));
            plant.organs.push(organ(
                OrganKind::Petal,
                shapes.petal,
                frame,
                scale * (1.0 - 0.45 * inner),
                Paint::Tinted(tint),
                key,
            ));
        }
    }
    if let Some(disc) = shapes.disc {
        let origin = centre + axis * (0.06 * spec.diameter_m * place.scale);
        let frame = Frame { origin, right: across, along: up, normal: axis };
        let key = key.child(u64::MAX);
        plant.organs.push(organ(OrganKind::Disc, disc, frame, scale, Paint::default(), key));
    }
    let key = key.child(u64::MAX - 1);
    plant.organs.push(organ(OrganKind::Pedicel, shapes.stalk, place.frame, longer, Paint::default(), key));
}

fn push(plant: &mut Plant, shape: Shape) -> ShapeId {
    plant.shapes.push(shape);
    ShapeId::new(plant.shapes.len() - 1)
}

/// Returns a round petal with a notch at its end, wide enough to close the whorl, or narrower.
fn petal(length_m: f64, spec: &BlossomSpec) -> Blade {
    let half = (1.08 * ops::sin(PI / f64::from(spec.petals.max(3)))).min(0.62) * spec.petal_width;
    // Few corners: a tree in blossom has tens of thousands of these.
    let right = [(0.95, 0.6), (0.62, 1.02)];
    let right = right.map(|(x, y)| DVec2::new(x * half, y) * length_m);
    let mut outline = vec![DVec2::ZERO];
    outline.extend(right);
    outline.push(DVec2::new(0.0, length_m));
    outline.extend(right.iter().rev().map(|p| DVec2::new(-p.x, p.y)));
    let midrib = vec![DVec2::ZERO, DVec2::new(0.0, 0.5 * length_m), DVec2::new(0.0, length_m)];
    let relief = Relief { bend_b: -0.12, hollow: 0.08, ..Relief::default() };
    Blade { outline, midrib, veins: Vec::new(), needles: None, lift: Lift::Flat, relief }
}

/// Returns a stalk that widens towards the flower.
fn stalk(length_m: f64) -> Shape {
    let path = vec![DVec3::ZERO, DVec3::Y * length_m];
    Shape::Strand { path, radius_m: vec![0.022 * length_m, 0.035 * length_m], knob_m: 0.0 }
}

/// Returns the tuft of stamens in the middle, as a small inverted bowl.
fn disc(radius_m: f64) -> Blade {
    let corner = |k: u32| {
        let (s, c) = ops::sin_cos(TAU * f64::from(k) / 6.0);
        DVec2::new(s, -c) * radius_m
    };
    let outline: Vec<DVec2> = (0..6).map(corner).collect();
    let midrib = vec![outline[0], DVec2::ZERO, outline[3]];
    let relief = Relief { hollow: -0.3, ..Relief::default() };
    Blade { outline, midrib, veins: Vec::new(), needles: None, lift: Lift::Flat, relief }
}
