//! One oak, from its spec to meshes, timed for `bench/peers`: prints a line of JSON. Arguments: the share of leaves
//! kept, the fineness of the surface, the number of runs, life cycles, attraction points.

#![expect(clippy::print_stdout, reason = "its output is what it is for")]

use std::error::Error;
use std::time::Instant;

use base::{Report, Run, Seed};
use burgeon::skin::{SkinSpec, skin};
use growth::{CompetitionSpec, LeafSpec, Method, TreeSpec, grow};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1).map(|a| a.parse::<f64>());
    let mut next = |default: f64| args.next().unwrap_or(Ok(default));
    let (leaf_keep, detail, runs) = (next(1.0)?, next(1.0)?, next(20.0)?);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked by the spec")]
    let (lifespan, points) = (next(3.0)? as u32, next(2500.0)? as u32);
    let spec = TreeSpec {
        name: "oak".into(),
        method: Method::Competition(CompetitionSpec { lifespan, points, ..CompetitionSpec::oak() }),
        leaves: Some(LeafSpec { leaf_keep, ..LeafSpec::default() }),
        ..TreeSpec::default()
    };
    let surface = SkinSpec { detail, textures: false, ..SkinSpec::default() };
    let run = Run::plain();
    let make = || -> Result<_, Box<dyn Error>> {
        let tree = grow(&spec, None, Seed::new(1), &run, &mut Report::default())?;
        let model = skin(&tree.plant, &surface, &run)?;
        Ok((tree, model))
    };
    let mut times = Vec::new();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 1000")]
    for _ in 0..runs.clamp(1.0, 1000.0) as u32 {
        let started = Instant::now();
        make()?;
        times.push(started.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    let (tree, model) = make()?;
    let part = |name: &str| {
        let parts = model.parts.iter().filter(|p| p.name.starts_with(name));
        parts.map(|p| p.mesh.triangles.len()).sum::<usize>()
    };
    let leaf = part("lea");
    println!(
        "{{\"best_ms\":{:.2},\"median_ms\":{:.2},\"vertices\":{},\"triangles\":{},\"leaf_triangles\":{leaf},\"leaves\":{},\"axes\":{}}}",
        times[0],
        times[times.len() / 2],
        model.vertex_count(),
        model.triangle_count(),
        tree.leaves.kept,
        tree.plant.axes.len(),
    );
    Ok(())
}
