//! Plants for looking and counting, made without any drawing.
#![allow(dead_code, reason = "each test file uses its own scenes")]

use base::{Draw, Executor, Seed, ops};
use glam::{DVec2, DVec3};
use plant::{AxisKind, Blade, Frame, Lift, NodeId, Organ, OrganKind, Paint, Plant, Relief, Shape, ShapeId};

/// Three threads, each from the last job to the first.
#[derive(Debug)]
pub(crate) struct Threads;

impl Executor for Threads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        std::thread::scope(|s| {
            for k in 0..3 {
                s.spawn(move || (0..n).rev().filter(|i| i % 3 == k).for_each(job));
            }
        });
    }
}

/// Returns an egg-shaped outline from the origin along +y, `width` at its widest, which is at `belly` of its length.
pub(crate) fn outline(length: f64, width: f64, belly: f64, tip: f64) -> Vec<DVec2> {
    let n = 24;
    let half = |t: f64| {
        let bend = ops::ln(0.5) / ops::ln(belly);
        0.5 * width * ops::powf(ops::sin(ops::PI * ops::powf(t, bend)), tip)
    };
    let side = |sign: f64, k: i32| {
        let t = f64::from(k) / f64::from(n);
        DVec2::new(sign * half(t.clamp(1e-9, 1.0 - 1e-9)), t * length)
    };
    let mut points = vec![DVec2::ZERO];
    points.extend((1..n).map(|k| side(1.0, k)));
    points.push(DVec2::new(0.0, length));
    points.extend((1..n).rev().map(|k| side(-1.0, k)));
    points
}

pub(crate) fn blade(length: f64, width: f64, belly: f64, tip: f64, relief: Relief) -> Blade {
    let midrib = (0..=8).map(|k| DVec2::new(0.0, length * f64::from(k) / 8.0)).collect();
    Blade {
        outline: outline(length, width, belly, tip),
        midrib,
        veins: Vec::new(),
        needles: None,
        lift: Lift::Flat,
        relief,
    }
}

pub(crate) fn organ(
    kind: OrganKind,
    bearer: Option<NodeId>,
    shape: ShapeId,
    frame: Frame,
    key: u64,
) -> Organ {
    Organ { kind, bearer, flower: None, shape, frame, scale: 1.0, paint: Paint::default(), key, source: None }
}

/// Returns the last node of the plant's newest axis.
fn last_node(p: &Plant) -> NodeId {
    NodeId::new(p.nodes.position.len() - 1)
}

/// Returns a curved line of `n` points from `a` in direction `d`, bending towards `to`.
pub(crate) fn curve(a: DVec3, d: DVec3, to: DVec3, length: f64, n: usize) -> Vec<DVec3> {
    let step = length / (n - 1) as f64;
    let mut points = vec![a];
    for k in 1..n {
        let w = k as f64 / n as f64;
        let dir = (d.normalize() * (1.0 - w) + to.normalize() * w).normalize();
        points.push(points[k - 1] + dir * step);
    }
    points
}

pub(crate) fn set_radii(p: &mut Plant, axis: plant::AxisId, from: f64, to: f64) {
    let r = p.axis(axis).nodes.clone();
    let n = (r.end - r.start - 1) as f64;
    for (k, i) in r.enumerate() {
        p.nodes.radius_m[i as usize] = ops::lerp(from, to, k as f64 / n);
    }
}

/// Makes a trunk with a thick and a thin side branch, a Y fork at its tip, and a twig.
pub(crate) fn fork() -> Plant {
    let mut p = Plant { name: "fork".into(), ..Plant::default() };
    let trunk = curve(DVec3::ZERO, DVec3::new(0.05, 1.0, 0.0), DVec3::new(-0.1, 1.0, 0.1), 1.0, 12);
    let t = p.add_axis(AxisKind::Branch, None, 1, &trunk, None);
    set_radii(&mut p, t, 0.075, 0.05);
    let mut bear = |at: usize, d: DVec3, to: DVec3, length: f64, r: f64, key: u64| {
        let id = p.add_axis(
            AxisKind::Branch,
            Some(NodeId::new(at)),
            key,
            &curve(trunk[at], d, to, length, 10),
            None,
        );
        set_radii(&mut p, id, r, r * 0.5);
    };
    bear(5, DVec3::new(1.0, 0.6, 0.1), DVec3::new(0.6, 1.0, 0.0), 0.7, 0.045, 2);
    bear(7, DVec3::new(-1.0, 0.5, 0.4), DVec3::new(-0.8, 1.0, 0.2), 0.6, 0.022, 3);
    bear(9, DVec3::new(0.6, 0.3, 1.0), DVec3::new(0.4, 1.0, 0.8), 0.5, 0.012, 4);
    bear(11, DVec3::new(0.35, 1.0, 0.0), DVec3::new(0.7, 1.0, 0.1), 0.7, 0.040, 5);
    bear(11, DVec3::new(-0.5, 1.0, 0.1), DVec3::new(-0.6, 1.0, -0.2), 0.6, 0.036, 6);
    p
}

/// Makes a tree of `count` branches, each borne by an earlier one, no leaves.
pub(crate) fn tree(count: usize, kind: AxisKind) -> Plant {
    let mut p = Plant { name: "tree".into(), ..Plant::default() };
    let trunk = curve(DVec3::ZERO, DVec3::Y, DVec3::new(0.2, 1.0, 0.0), 1.0, 16);
    let t = p.add_axis(AxisKind::Branch, None, 1, &trunk, None);
    set_radii(&mut p, t, 0.03, 0.006);
    let mut draw = Seed::new(5).stream(Draw::Test);
    for k in 1..count {
        let host = plant::AxisId::new(draw.below((k).min(9)));
        let nodes = p.axis(host).nodes.clone();
        let at = nodes.start as usize + 4 + draw.below(nodes.len() - 5);
        let (start, r) = (p.nodes.position[at], p.nodes.radius_m[at]);
        let along = p.nodes.position[at] - p.nodes.position[at - 1];
        let out = DVec3::new(draw.normal(), 0.4 * draw.normal(), draw.normal()).normalize();
        let length = draw.range(0.2, 0.5);
        let line = curve(start, along.normalize() * 0.6 + out, DVec3::Y * 0.5 + out, length, 12);
        let id = p.add_axis(kind, Some(NodeId::new(at)), k as u64 + 1, &line, None);
        set_radii(&mut p, id, r * 0.55, r * 0.2);
    }
    p
}

/// Makes a daisy-like flower on a stem: `petals` petals, a disc, stamens, two leaves.
pub(crate) fn flower(petals: u32) -> Plant {
    let mut p = Plant { name: "flower".into(), ..Plant::default() };
    let line = curve(DVec3::ZERO, DVec3::new(-0.1, 1.0, 0.0), DVec3::new(0.35, 1.0, 0.1), 0.62, 20);
    let stem = p.add_axis(AxisKind::Stem, None, 1, &line, Some(0));
    set_radii(&mut p, stem, 0.012, 0.009);
    let top = last_node(&p);
    let centre = line[line.len() - 1];
    let axis = DVec3::new(0.3, 0.55, 0.8).normalize();
    let relief = Relief { bend_a: 0.05, bend_b: 0.12, hollow: 0.10, keep_length: true, ..Relief::default() };
    let petal = p.add_shape(Shape::Blade(blade(0.30, 0.17, 0.6, 0.75, relief)));
    let first = Frame::looking(centre, axis, DVec3::Y);
    for k in 0..petals {
        let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k) / f64::from(petals));
        let out = first.right * cos + first.normal * sin;
        let along = out * 0.93 + axis * 0.35;
        let frame = Frame::looking(centre + out * 0.03, along, axis);
        p.organs.push(organ(OrganKind::Petal, Some(top), petal, frame, 100 + u64::from(k)));
    }
    let disc = p.add_shape(Shape::Dome { radius_m: 0.055, height_m: 0.028 });
    let side = axis.any_orthonormal_vector();
    let looking = Frame { origin: centre + axis * 0.012, right: side, along: axis.cross(side), normal: axis };
    p.organs.push(organ(OrganKind::Disc, Some(top), disc, looking, 200));
    let stamen = p.add_shape(Shape::Strand {
        path: vec![DVec3::ZERO, DVec3::new(0.01, 0.03, 0.0), DVec3::new(0.015, 0.06, 0.0)],
        radius_m: vec![0.0014, 0.0012, 0.0012],
        knob_m: 0.004,
    });
    for k in 0..9_u32 {
        let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k) / 9.0);
        let out = looking.right * cos + looking.along * sin;
        let frame = Frame::looking(centre + axis * 0.02 + out * 0.045, axis + out * 0.5, out);
        p.organs.push(organ(OrganKind::Stamen, Some(top), stamen, frame, 300 + u64::from(k)));
    }
    let relief = Relief { bend_b: 0.25, fold: 0.25, wave: 0.02, keep_length: true, ..Relief::default() };
    let leaf = p.add_shape(Shape::Blade(blade(0.24, 0.10, 0.42, 0.9, relief)));
    for (k, (at, x)) in [(5_usize, 1.0), (8, -1.0)].into_iter().enumerate() {
        let frame = Frame::looking(line[at], DVec3::new(x, 0.55, 0.25), DVec3::new(-0.4 * x, 1.0, 0.6));
        p.organs.push(organ(OrganKind::Leaf, Some(NodeId::new(at)), leaf, frame, 400 + k as u64));
    }
    p
}

/// Makes a branch with `count` small leaves.
pub(crate) fn leafy(count: usize) -> Plant {
    let mut p = tree(12, AxisKind::Twig);
    p.name = "leafy".into();
    let relief = Relief { bend_b: 0.2, fold: 0.2, ..Relief::default() };
    let leaf = p.add_shape(Shape::Blade(blade(0.05, 0.028, 0.4, 0.9, relief)));
    let mut draw = Seed::new(9).stream(Draw::Test);
    for k in 0..count {
        let node = draw.below(p.nodes.position.len());
        let out = DVec3::new(draw.normal(), 0.3 * draw.normal() + 0.2, draw.normal());
        let mut o = organ(
            OrganKind::Leaf,
            Some(NodeId::new(node)),
            leaf,
            Frame::looking(p.nodes.position[node], out, DVec3::Y + 0.3 * out),
            k as u64,
        );
        o.scale = draw.range(0.7, 1.3);
        p.organs.push(o);
    }
    p
}

/// Makes fruits, a drawn red leaf, a cactus-like body with thorns, roots.
pub(crate) fn still_life() -> Plant {
    let mut p = Plant { name: "still life".into(), ..Plant::default() };
    let apple: Vec<DVec2> =
        [(0.0, 0.02), (0.03, 0.0), (0.07, 0.03), (0.08, 0.08), (0.06, 0.125), (0.025, 0.13), (0.0, 0.115)]
            .map(|(x, y)| DVec2::new(x, y))
            .to_vec();
    let apple = p.add_shape(Shape::Revolution { profile: apple });
    let body: Vec<DVec2> = [(0.10, 0.0), (0.14, 0.1), (0.15, 0.25), (0.13, 0.42), (0.07, 0.52), (0.0, 0.55)]
        .map(|(x, y)| DVec2::new(x, y))
        .to_vec();
    let body = p.add_shape(Shape::Revolution { profile: body });
    let thorn = p.add_shape(Shape::Strand {
        path: vec![DVec3::ZERO, DVec3::new(0.0, 0.02, 0.0), DVec3::new(0.0, 0.045, 0.004)],
        radius_m: vec![0.0025, 0.0015, 0.0002],
        knob_m: 0.0,
    });
    let upright = |x: f64| Frame::looking(DVec3::new(x, 0.0, 0.0), DVec3::Y, DVec3::Z);
    p.organs.push(organ(OrganKind::Fruit, None, apple, upright(-0.35), 1));
    p.organs.push(organ(OrganKind::Body, None, body, upright(0.0), 2));
    for k in 0..60_u32 {
        let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(k % 8) / 8.0);
        let y = 0.06 + 0.055 * f64::from(k / 8);
        let out = DVec3::new(sin, 0.1, cos);
        let frame = Frame::looking(DVec3::new(0.145 * sin, y, 0.145 * cos), out, DVec3::Y);
        p.organs.push(organ(OrganKind::Thorn, None, thorn, frame, 10 + u64::from(k)));
    }
    let relief = Relief { bend_b: 0.3, fold: 0.15, wave: 0.03, ..Relief::default() };
    let leaf = p.add_shape(Shape::Blade(blade(0.35, 0.2, 0.4, 0.9, relief)));
    let frame = Frame::looking(DVec3::new(0.4, 0.1, 0.0), DVec3::new(0.1, 1.0, 0.1), DVec3::Z);
    let mut red = organ(OrganKind::Leaf, None, leaf, frame, 100);
    red.paint = Paint::Drawn([0.6, 0.05, 0.03]);
    p.organs.push(red);
    for k in 0..4_u32 {
        let (sin, cos) = ops::sin_cos(1.2 + ops::TAU * f64::from(k) / 4.0);
        let line = curve(DVec3::ZERO, DVec3::new(cos, -0.3, sin), DVec3::new(cos, -1.5, sin), 0.3, 8);
        let id = p.add_axis(AxisKind::Root, None, u64::from(k), &line, None);
        set_radii(&mut p, id, 0.012, 0.002);
    }
    p
}
