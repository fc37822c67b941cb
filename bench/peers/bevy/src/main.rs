//! Times `bevy_procedural_tree`'s default tree: prints a line of JSON.

use std::time::Instant;

use bevy_procedural_tree::{meshgen::generate_tree_meshes, settings::TreeMeshSettings};

fn main() {
    let settings = TreeMeshSettings::default();
    let mut times = Vec::new();
    let (mut triangles, mut vertices) = (0, 0);
    for _ in 0..30 {
        let started = Instant::now();
        let (wood, leaves) =
            generate_tree_meshes(&settings, &mut fastrand::Rng::with_seed(1)).expect("its own defaults");
        times.push(started.elapsed().as_secs_f64() * 1e3);
        let both = [&wood, &leaves];
        triangles = both.iter().map(|m| m.indices().map_or(0, |i| i.len() / 3)).sum();
        vertices = both.iter().map(|m| m.count_vertices()).sum::<usize>();
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{{\"best_ms\":{:.3},\"median_ms\":{:.3},\"triangles\":{triangles},\"vertices\":{vertices}}}",
        times[0], times[15]
    );
}
