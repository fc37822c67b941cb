//! Trees in blossom.

use std::f64::consts::PI;

use base::ops;
use burgeon::glam::DVec3;
use burgeon::growth::BlossomSpec;
use burgeon::plant::{Organ, OrganKind};
use burgeon::{MadeTree, Preset, Run, Seed, TreeOptions, make_tree};

fn made(share: f64) -> MadeTree {
    let mut spec = Preset::find("hazel").expect("a preset").spec().expect("sound");
    spec.blossom = BlossomSpec { share, ..BlossomSpec::default() };
    make_tree(&spec, Seed::new(1), &TreeOptions::default(), &Run::plain()).expect("sound")
}

#[test]
fn goblets_stand_on_short_stalks() {
    let of = |open_deg: f64, stalk: f64| {
        let mut spec = Preset::find("hazel").expect("a preset").spec().expect("sound");
        spec.blossom = BlossomSpec { share: 0.3, open_deg, stalk, ..BlossomSpec::default() };
        let made = make_tree(&spec, Seed::new(1), &TreeOptions::default(), &Run::plain()).expect("sound");
        let plant = &made.grown.plant;
        let petals = plant.organs.iter().filter(|o| o.kind == OrganKind::Petal);
        let lean =
            petals.map(|o| o.frame.along.dot(plant.flowers[o.flower.expect("a flower's").index()].axis));
        let lean: Vec<f64> = lean.collect();
        let stalks = plant.organs.iter().filter(|o| o.kind == OrganKind::Pedicel);
        let reach = stalks.map(|o| {
            let flower = &plant.flowers[o.flower.expect("a flower's").index()];
            flower.centre.distance(o.frame.origin)
        });
        (lean.iter().sum::<f64>() / lean.len() as f64, reach.sum::<f64>() / plant.flowers.len() as f64)
    };
    let ((flat, far), (goblet, near)) = (of(76.0, 0.7), of(30.0, 0.1));
    assert!((flat - ops::cos(76.0 * PI / 180.0)).abs() < 0.03, "{flat}");
    assert!((goblet - ops::cos(PI / 6.0)).abs() < 0.03, "{goblet}");
    assert!((far - near - 0.6 * 0.035).abs() < 0.003, "{far} {near}");
}

#[test]
fn flowers_take_the_places_of_leaves() {
    let (bare, some, all) = (made(0.0), made(0.3), made(1.0));
    let [places, flowers] = [bare.item.counts.leaves, some.item.counts.flowers].map(Option::unwrap);
    assert_eq!(some.item.counts.leaves, Some(places - flowers));
    assert!((0.25..0.35).contains(&(flowers as f64 / places as f64)), "{flowers} of {places}");
    assert_eq!((all.item.counts.leaves, all.item.counts.flowers), (Some(0), Some(places)));
    for tree in [&some, &all] {
        assert_eq!(tree.grown.plant.validate().next(), None);
        assert_eq!(tree.model.validate().next(), None);
        assert_eq!(tree.item.counts.petals, tree.item.counts.flowers.map(|n| 5 * n));
        let stalk = |o: &&Organ| o.kind == OrganKind::Pedicel;
        let ends = tree.grown.plant.organs.iter().filter(stalk).map(|o| {
            let flower = &tree.grown.plant.flowers[o.flower.expect("a flower's").index()];
            let BlossomSpec { stalk, diameter_m, .. } = BlossomSpec::default();
            let length = stalk * diameter_m * o.scale;
            o.frame.place(DVec3::Y * stalk * diameter_m, o.scale).distance(flower.centre) / length
        });
        let ends: Vec<f64> = ends.collect();
        assert_eq!(Some(ends.len() as u64), tree.item.counts.flowers);
        assert!(ends.iter().all(|off| *off < 1e-9));
    }
    let petals = some.model.parts.iter().find(|p| p.name == "petals").expect("petals");
    let [r, g, b] = petals.mesh.colors[0];
    assert!(r > 0.5 && g > 0.5 && b > 0.5, "as pale as its spec says: {r} {g} {b}");
    assert_eq!(some.model.material(petals).name, "petal");
}
