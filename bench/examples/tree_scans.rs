//! Our own trees, scanned by a virtual scanner and found again: volume, height, diameter, orders, surface, compared
//! with the truth and with a cone by allometry.
//!
//! `cargo run --release -p burgeon-bench --example tree_scans -- [--leaves] [--positions N] [--save FOLDER] [PRESET
//! SEED]...`

#![expect(clippy::print_stdout, reason = "this is a program for the terminal")]

use std::path::PathBuf;
use std::time::Instant;

use base::{Executor, Report, Run, Seed, ops};
use burgeon::formats::{ExportSpec, write_cloud_ply, write_qsm};
use burgeon::glam::DVec3;
use burgeon::mesh::{Material, MaterialId, MaterialKind, Model, Part, PointCloud, TriMesh};
use burgeon::plant::Plant;
use burgeon::scan::{Interval, ScannerSpec, TreeScanSpec, find_tree, wood_gap};
use burgeon::skin::{SkinSpec, skin};
use burgeon::{Preset, TreeOptions, make_tree};
use rayon::prelude::*;

struct Threads;
impl Executor for Threads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        (0..n).into_par_iter().with_max_len(1).for_each(job);
    }
}

/// Makes a slope with bumps, large enough that the scan does not see its edge near the tree.
fn terrain(size: f64) -> TriMesh {
    let mut mesh = TriMesh::default();
    let n = 60_u32;
    let at = |i: u32| f64::from(i) / f64::from(n) * 2.0 * size - size;
    for i in 0..=n {
        for j in 0..=n {
            let (x, z) = (at(i), at(j));
            let y = 0.05 * x + 0.06 * ops::sin(1.3 * x) * ops::cos(0.9 * z);
            #[expect(clippy::cast_possible_truncation, reason = "a mesh")]
            mesh.positions.push([x, y, z].map(|c| c as f32));
        }
    }
    let id = |i: u32, j: u32| i * (n + 1) + j;
    for i in 0..n {
        for j in 0..n {
            mesh.triangles.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
            mesh.triangles.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
        }
    }
    mesh
}

fn scanned(plant: &Plant, positions: usize, seed: u64) -> Vec<DVec3> {
    let run = Run { executor: &Threads, ..Run::plain() };
    let spec = SkinSpec { textures: false, detail: 0.7, ..SkinSpec::default() };
    let model = skin(plant, &spec, &run).expect("a sound plant");
    let (low, high) = plant.extent().expect("a tree");
    let height = high.y;
    let is_wood = |p: &Part| {
        let kind = model.materials[p.material.index()].kind;
        matches!(kind, MaterialKind::Bark | MaterialKind::YoungBark | MaterialKind::Stem | MaterialKind::Root)
    };
    let mut scene =
        Model { parts: model.parts.iter().filter(|p| !is_wood(p)).cloned().collect(), ..Model::default() };
    scene.parts.push(Part {
        name: "wood".into(),
        material: MaterialId::new(0),
        mesh: burgeon::scan::wood_mesh(plant),
    });
    scene.materials.push(Material::plain("all", MaterialKind::Other, [0.5; 3]));
    let size = 0.5 * (high - low).x.max((high - low).z) + 1.0;
    scene.parts.push(Part { name: "ground".into(), material: MaterialId::new(0), mesh: terrain(size) });
    let places: Vec<usize> = (0..positions).collect();
    let clouds: Vec<Vec<DVec3>> = places
        .into_par_iter()
        .map(|k| {
            let (sin, cos) = ops::sin_cos(ops::TAU * (k as f64 + 0.15) / positions as f64);
            let away = (0.8 * height).max(size + 2.0);
            let position = DVec3::new(away * cos, 1.7 + 0.05 * away * cos, away * sin);
            burgeon::scan::scan(
                &scene,
                &ScannerSpec { position, ..ScannerSpec::default() },
                Seed::new(seed * 10 + k as u64),
            )
            .0
        })
        .collect();
    clouds.concat()
}

struct Row {
    truth: [f64; 3],
    found: [f64; 3],
    /// Reported intervals of the figures.
    said: [Interval; 3],
}

fn trial(preset: &str, seed: u64, positions: usize, leaves: bool, save: Option<&PathBuf>) -> Row {
    let run = Run { executor: &Threads, ..Run::plain() };
    let spec = Preset::find(preset).expect("a preset").spec().expect("sound");
    let made = make_tree(&spec, Seed::new(seed), &TreeOptions::default(), &run).expect("a tree");
    let mut plant = made.grown.plant;
    if !leaves {
        plant.organs.clear();
        plant.flowers.clear();
    }
    let points = scanned(&plant, positions, seed);
    if let Some(folder) = save {
        let name = format!("{preset}-{seed}{}", if leaves { "-leaves" } else { "" });
        let cloud = PointCloud { points: points.clone(), ..PointCloud::default() };
        let file = std::fs::File::create(folder.join(format!("{name}.ply"))).expect("a file");
        write_cloud_ply(&cloud, &ExportSpec::default(), std::io::BufWriter::new(file)).expect("written");
        let file = std::fs::File::create(folder.join(format!("{name}-truth.csv"))).expect("a file");
        write_qsm(&plant, &ExportSpec::default(), std::io::BufWriter::new(file)).expect("written");
    }
    let start = Instant::now();
    let mut report = Report::default();
    let found = match find_tree(&points, &TreeScanSpec::default(), &run, &mut report) {
        Ok(found) => found,
        Err(e) => {
            println!("{preset} {seed}: {e}");
            return Row { truth: [1.0; 3], found: [0.0; 3], said: [Interval::default(); 3] };
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let (a, b) = (plant.measure(), found.plant.measure());
    let off = |x: f64, y: f64| 100.0 * (x / y - 1.0);
    let dbh = b.dbh_m.unwrap_or(0.0);
    let cone = ops::PI / 8.0 * dbh * dbh * b.height_m;
    println!(
        "{preset} {seed}: {} points, {seconds:.1} s, cell {:.1} mm, rings {} circles {}, n {:.2} +- {:.2}, foot {:.2} {:.2} {:.2}",
        points.len(),
        found.tally.cell_m * 1e3,
        found.tally.rings,
        found.tally.circles,
        found.tally.pipe_exponent,
        found.tally.pipe_scatter,
        found.foot.x,
        found.foot.y,
        found.foot.z
    );
    report.warnings.iter().for_each(|w| println!("  warning: {w}"));
    println!("  {:?}", found.tally);
    println!(
        "  volume {:.4} of {:.4} ({:+.1} %; cone {:+.1} %), height {:.2} of {:.2} ({:+.1} %), DBH {:.4} of {:.4} ({:+.1} %), length {:.0} of {:.0}",
        b.wood_volume_m3,
        a.wood_volume_m3,
        off(b.wood_volume_m3, a.wood_volume_m3),
        off(cone, a.wood_volume_m3),
        b.height_m,
        a.height_m,
        off(b.height_m, a.height_m),
        b.dbh_m.unwrap_or(0.0),
        a.dbh_m.unwrap_or(0.0),
        off(b.dbh_m.unwrap_or(0.0), a.dbh_m.unwrap_or(1.0)),
        b.length_m,
        a.length_m
    );
    for k in 0..a.orders.len().max(b.orders.len()).min(5) {
        let get = |m: &burgeon::plant::Measures| {
            m.orders.get(k).map_or((0, 0.0, 0.0), |o| (o.axes, o.length_m, o.volume_m3))
        };
        let ((n, l, v), (tn, tl, tv)) = (get(&b), get(&a));
        println!("  order {k}: axes {n} of {tn}, length {l:.1} of {tl:.1}, volume {v:.4} of {tv:.4}");
    }
    let moved = {
        let mut p = found.plant.clone();
        p.nodes.position.iter_mut().for_each(|q| *q += found.foot);
        p
    };
    for least in [0.0, 0.02] {
        let to = wood_gap(&plant, &moved, 0.01, least);
        let back = wood_gap(&moved, &plant, 0.01, least);
        if let (Some(t), Some(b)) = (to, back) {
            println!(
                "  surface (radius over {:.0} mm): truth to found mean {:.1} median {:.1} p95 {:.1} mm; found to truth {:.1} {:.1} {:.1}",
                least * 1e3,
                t.mean * 1e3,
                t.median * 1e3,
                t.p95 * 1e3,
                b.mean * 1e3,
                b.median * 1e3,
                b.p95 * 1e3
            );
        }
    }
    let i = found.intervals;
    let said = [i.volume_m3, i.height_m, i.dbh_m.unwrap_or_default()];
    println!(
        "  said: volume {:.4} to {:.4}, height {:.2} to {:.2}, DBH {:.4} to {:.4}",
        said[0].low, said[0].high, said[1].low, said[1].high, said[2].low, said[2].high
    );
    Row {
        said,
        truth: [a.wood_volume_m3, a.height_m, a.dbh_m.unwrap_or(1.0)],
        found: [b.wood_volume_m3, b.height_m, b.dbh_m.unwrap_or(0.0)],
    }
}

fn main() {
    let mut leaves = false;
    let mut positions = 4;
    let mut save = None;
    let mut cases: Vec<(String, u64)> = vec![];
    let mut args = std::env::args().skip(1);
    while let Some(a) = args.next() {
        match a.as_str() {
            "--leaves" => leaves = true,
            "--positions" => positions = args.next().and_then(|n| n.parse().ok()).unwrap_or(4),
            "--save" => save = args.next().map(PathBuf::from),
            preset => {
                let seed = args.next().and_then(|n| n.parse().ok()).unwrap_or(1);
                cases.push((preset.into(), seed));
            }
        }
    }
    let (mut within, mut covered) = ([0; 3], [0; 3]);
    let count = cases.len();
    for (preset, seed) in cases {
        let row = trial(&preset, seed, positions, leaves, save.as_ref());
        for ((within, found), truth) in within.iter_mut().zip(row.found).zip(row.truth) {
            *within += usize::from((found / truth - 1.0).abs() <= 0.05);
        }
        for ((covered, said), truth) in covered.iter_mut().zip(row.said).zip(row.truth) {
            *covered += usize::from((said.low..=said.high).contains(&truth));
        }
    }
    println!("in their intervals: volume {} height {} DBH {} of {count}", covered[0], covered[1], covered[2]);
    println!("within 5 %: volume {} height {} DBH {} of {count}", within[0], within[1], within[2]);
}
