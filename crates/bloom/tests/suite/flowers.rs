//! Every flower that comes with the program, on days and between them.

use base::Seed;
use bloom::{Aestivation, Fate, FlowerSpec, PartTriangle, Whorl, preset};
use glam::DVec3;
use plant::{OrganKind, Plant, Shape};

fn share(rows: &[PartTriangle]) -> f64 {
    bloom::crossed(rows).iter().flatten().count() as f64 / rows.len().max(1) as f64
}

/// Keyframes of a bloom.
const FRAMES: u32 = 20;

fn flower_at_share(spec: &FlowerSpec, share: f64) -> Plant {
    spec.make_on_day((spec.opening_days + spec.wilting_days) * share, &spec.own_law(), Seed::new(1))
}

/// Stamens, disc, fruit, sepals, leaves and stem are included, and the display of a player half way between two
/// keyframes.
#[test]
fn no_part_passes_through_another_at_keyframes_or_between_them() {
    for name in FlowerSpec::PRESETS {
        let spec = preset(name).unwrap();
        let rows = |k: u32| {
            bloom::part_triangles(&flower_at_share(&spec, f64::from(k) / f64::from(FRAMES - 1)), None)
        };
        let (mut worst, mut between, mut told) = (0.0_f64, 0.0_f64, String::new());
        let mut before = rows(0);
        for k in 0..FRAMES {
            let now = rows(k);
            assert_eq!(now.len(), before.len(), "{name}: the same triangles at every day");
            let crossed = share(&now);
            worst = worst.max(crossed);
            if k % 3 == 0 || k == FRAMES - 1 {
                told += &format!(" {:.3}", crossed * 100.0);
            }
            let half = |(a, b): (&PartTriangle, &PartTriangle)| PartTriangle {
                corners: [0, 1, 2].map(|q| a.corners[q].lerp(b.corners[q], 0.5)),
                ..*b
            };
            if k > 0 {
                between = between.max(share(&before.iter().zip(&now).map(half).collect::<Vec<_>>()));
            }
            before = now;
        }
        println!("| {name} |{told} | {:.3} | {:.3} |", worst * 100.0, between * 100.0);
        assert!(worst < 0.001, "{name}: {worst} at a keyframe");
        // A falling petal moves straight from keyframe to keyframe.
        let falls = spec.whorls.iter().any(|w| w.fate == Fate::Drop);
        assert!(between < if falls { 0.01 } else { 0.003 }, "{name}: {between} between keyframes");
    }
}

/// Returns the corners of all organs of a kind, in place.
fn corners(plant: &Plant, kind: OrganKind) -> Vec<Vec<DVec3>> {
    let organs = plant.organs.iter().filter(|o| o.kind == kind);
    organs
        .map(|o| match &plant.shapes[o.shape.index()] {
            Shape::Sheet(s) => s.points.iter().map(|&p| o.frame.place(p, o.scale)).collect(),
            shape => shape.corners(o.scale).into_iter().map(|c| o.frame.place(c, 1.0)).collect(),
        })
        .collect()
}

#[test]
fn petals_that_drop_lie_on_the_ground_in_the_end_and_none_on_another() {
    for name in FlowerSpec::PRESETS {
        let spec = preset(name).unwrap();
        if !spec.whorls.iter().any(|w| w.fate == Fate::Drop && !w.sepal) {
            continue;
        }
        let top = |plant: &Plant| {
            corners(plant, OrganKind::Petal).into_iter().flatten().map(|p| p.y).fold(0.0, f64::max)
        };
        let lowest = |plant: &Plant| {
            corners(plant, OrganKind::Petal).into_iter().flatten().map(|p| p.y).fold(f64::INFINITY, f64::min)
        };
        let end = flower_at_share(&spec, 1.0);
        assert!(top(&end) < 0.5 * spec.stalk_m, "{name}: {}", top(&end));
        assert!(lowest(&end) >= 0.0 && lowest(&end) < 0.002, "{name}: {}", lowest(&end));
        assert!(
            lowest(&flower_at_share(&spec, spec.opening_days / (spec.opening_days + spec.wilting_days)))
                > 0.03,
            "{name}"
        );
    }
}

#[test]
fn flowers_of_a_cluster_open_one_after_another() {
    let spec = preset("orchid").unwrap();
    let flower = flower_at_share(&spec, 0.35);
    let wide = |f: usize| {
        let of = flower
            .organs
            .iter()
            .filter(|o| o.kind == OrganKind::Petal && o.flower.is_some_and(|id| id.index() == f));
        let points: Vec<DVec3> = of
            .flat_map(|o| match &flower.shapes[o.shape.index()] {
                Shape::Sheet(s) => s.points.iter().map(|&p| o.frame.place(p, o.scale)).collect(),
                _ => Vec::new(),
            })
            .collect();
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        points.iter().map(|p| p.distance(middle)).fold(0.0, f64::max)
    };
    let sizes: Vec<f64> = (0..spec.umbel as usize).map(wide).collect();
    assert!(sizes.windows(2).all(|w| w[0] >= w[1]), "lower ones are farther: {sizes:?}");
    assert!(sizes[0] > 2.0 * sizes[5], "{sizes:?}");
}

#[test]
fn petals_of_a_ring_open_one_after_another_and_a_fused_ring_stays_closed() {
    let ring = |aestivation, succession| FlowerSpec {
        whorls: vec![Whorl { count: 5, aestivation, succession, lean_m: 1e-4, ..Whorl::default() }],
        ..FlowerSpec::default()
    };
    let tips = |spec: &FlowerSpec| {
        let petals = corners(&spec.make_on_day(2.5, &spec.own_law(), Seed::new(1)), OrganKind::Petal);
        petals.iter().map(|p| p[p.len() - 8]).map(|p| (p.x * p.x + p.z * p.z).sqrt()).collect::<Vec<f64>>()
    };
    let spread = |all: &[f64]| {
        all.iter().copied().fold(0.0, f64::max) - all.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let (even, late) = (tips(&ring(Aestivation::Imbricate, 0.0)), tips(&ring(Aestivation::Imbricate, 0.4)));
    assert!(spread(&late) > 4.0 * spread(&even) + 1e-4, "{even:?} {late:?}");
    let tube = ring(Aestivation::Fused, 0.0);
    for day in [0.0, 3.0, 6.0, 10.0] {
        let petals = corners(&tube.make_on_day(day, &tube.own_law(), Seed::new(1)), OrganKind::Petal);
        let columns = tube.mesh.columns as usize + 1;
        for (k, petal) in petals.iter().enumerate() {
            let next = &petals[(k + 1) % petals.len()];
            for row in 0..petal.len() / columns {
                let (a, b) = (petal[(row + 1) * columns - 1], next[row * columns]);
                assert!(a.distance(b) < 1e-9, "day {day}: {a} {b}");
            }
        }
    }
}
