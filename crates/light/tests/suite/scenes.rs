//! Scenes whose absorption is known.

use base::{Draw, Seed, ops};
use glam::DVec3;
use light::{LitScene, Optics};

/// Adds a rectangle of two triangles around a place, with its front along `normal`.
pub(crate) fn add_square(scene: &mut LitScene, middle: DVec3, normal: DVec3, side: f64, owner: u32) {
    let (a, b) = normal.any_orthonormal_pair();
    let (a, b) = (a * side * 0.5, b * side * 0.5);
    let first = u32::try_from(scene.points.len()).expect("few points");
    scene.points.extend([middle - a - b, middle + a - b, middle + a + b, middle - a + b]);
    scene.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    scene.owners.extend([owner, owner]);
}

/// Makes a canopy of small square leaves in a cell of 1 m by 1 m, in a layer above the ground, in all directions
/// evenly.
pub(crate) fn canopy(leaf_area_index: f64, side: f64, optics: Optics, seed: u64) -> LitScene {
    let mut chance = Seed::new(seed).stream(Draw::Test);
    let count = ops::whole((leaf_area_index / (side * side)).round());
    let mut scene = LitScene { receivers: vec![optics; count as usize], ..LitScene::default() };
    for leaf in 0..count {
        let middle = DVec3::new(chance.uniform(), 0.1 + chance.uniform(), chance.uniform());
        let up = chance.range(-1.0, 1.0);
        let (sin, cos) = ops::sin_cos(chance.range(0.0, ops::TAU));
        let flat = (1.0 - up * up).sqrt();
        add_square(&mut scene, middle, DVec3::new(flat * cos, up, flat * sin), side, leaf);
    }
    scene
}

/// Makes a ball of triangles around a place.
pub(crate) fn ball(middle: DVec3, radius: f64, rings: u32) -> LitScene {
    let turns = 2 * rings;
    let mut scene = LitScene { receivers: vec![Optics::BLACK], ..LitScene::default() };
    for ring in 0..=rings {
        let (s, c) = ops::sin_cos(ops::PI * f64::from(ring) / f64::from(rings));
        for turn in 0..turns {
            let (sin, cos) = ops::sin_cos(ops::TAU * f64::from(turn) / f64::from(turns));
            scene.points.push(middle + radius * DVec3::new(s * cos, c, s * sin));
        }
    }
    for ring in 0..rings {
        for turn in 0..turns {
            let at = |r: u32, t: u32| r * turns + t % turns;
            let [a, b] = [at(ring, turn), at(ring, turn + 1)];
            let [c, d] = [at(ring + 1, turn), at(ring + 1, turn + 1)];
            scene.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    scene.owners = vec![0; scene.triangles.len()];
    scene
}
