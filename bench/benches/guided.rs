//! Growth guided by hand: a round by living buds, whole crowns compared with the baseline (the VR paper, Fig 19, whose
//! own times are lost), and the cost of edits on a large plant. `cargo bench --bench guided`; one thread.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark without its input is worth nothing"
)]

use std::time::Instant;

use base::{Budget, Report, Run, Seed};
use burgeon::glam::DVec3;
use burgeon::plant::{AxisId, AxisKind, Plant};
use burgeon::shape::{Context, GrowFrom, HandEdit, Input, KeptGrowth, Pointer, Ray, Shaping, Tool, ToolKind};
use burgeon_bench::Oak;
use growth::{
    Envelope, Growing, GuidedSpec, Light, Method, Obstacles, SelfOrganizingSpec, guide, self_organize,
};

fn main() {
    hands();
    rounds();
    crowns();
}

fn ms<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let made = work();
    (start.elapsed().as_secs_f64() * 1e3, made)
}

/// Returns the least time of several runs.
fn least<T>(runs: usize, mut work: impl FnMut() -> T) -> (f64, T) {
    let mut best = ms(&mut work);
    for _ in 1..runs {
        let again = ms(&mut work);
        if again.0 < best.0 {
            best = again;
        }
    }
    best
}

/// Returns the largest memory of this process so far, MiB; 0 where the system does not report it.
fn peak_mib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) / 1024
}

const ROOT: [DVec3; 1] = [DVec3::ZERO];

/// 1,300 markers for each bud exceed the default budget.
fn run() -> Run<'static> {
    Run { budget: Budget { times: 1000.0, ..Budget::default() }, ..Run::plain() }
}

/// Times one round of a tree in a ball, by the number of buds that may grow in it.
fn rounds() {
    println!("markers    buds   joints  ms a round   us a bud");
    // The last one has internodes a quarter as long, and correspondingly more buds.
    for (markers, finer) in [(12, 1.0), (60, 1.0), (1300, 1.0), (60, 4.0)] {
        let ball = Envelope::Sphere { centre: DVec3::Y * 5.0, radius_m: 5.0 };
        let plain = GuidedSpec::from_crown(ball);
        let internode_m = plain.internode_m / finer;
        let spec = GuidedSpec { markers, internode_m, rounds: 200, ..plain };
        let (none, run) = (Obstacles::none(), run());
        let plant = || Growing::plant(&ROOT, &none, &spec, Seed::new(1), &run).unwrap();
        let mut growing = plant();
        let mut told = 100;
        while growing.rounds() < 200 && told <= 12_800 {
            let buds = growing.living();
            if buds < told {
                growing.step(&run).unwrap();
                continue;
            }
            let joints = growing.skeleton().len();
            // The least of several runs of the same round, each grown from the ground: a copy has no room to grow into.
            let grown = || {
                let mut one = plant();
                while one.rounds() < growing.rounds() {
                    one.step(&run).unwrap();
                }
                one
            };
            let tries = (0..5).map(|_| grown()).map(|mut one| ms(|| one.step(&run).unwrap()).0);
            let ms = tries.fold(f64::INFINITY, f64::min);
            growing.step(&run).unwrap();
            println!("{markers:7} {buds:7} {joints:8} {ms:11.2} {:10.2}", ms * 1e3 / buds as f64);
            told *= 2;
        }
    }
}

/// Times a crown in a ball by guided growth and by space colonisation of buds, at one number of rounds.
fn crowns() {
    println!("\nmethod              markers  rounds   joints        ms  peak MiB");
    let ball = Envelope::Sphere { centre: DVec3::Y * 5.0, radius_m: 5.0 };
    let competition = growth::CompetitionSpec { envelope: ball, ..growth::CompetitionSpec::default() };
    let [guided, baseline] = burgeon::guided_methods(&Method::Competition(competition)).unwrap();
    let (Method::Guided(guided), Method::SelfOrganizing(baseline)) = (guided, baseline) else { return };
    let (none, run) = (Obstacles::none(), run());
    for rounds in [8, 16, 24, 32] {
        let spec = SelfOrganizingSpec { years: rounds, ..baseline.clone() };
        let grow = || self_organize(&ROOT, &none, &spec, Seed::new(1), &run, &mut Report::default()).unwrap();
        let (ms, tree) = least(2, grow);
        let Light::Space { markers, .. } = spec.light else { return };
        let (joints, peak) = (tree.skeleton.len(), peak_mib());
        println!("{:18} {markers:8} {rounds:7} {joints:8} {ms:9.1} {peak:9}", "self-organisation");
    }
    for markers in [60, 1300] {
        for rounds in [8, 16, 24, 32] {
            let spec = GuidedSpec { rounds, markers, ..guided.clone() };
            let grow = || guide(&ROOT, &none, &spec, Seed::new(1), &run, &mut Report::default()).unwrap();
            let (ms, tree) = least(2, grow);
            let (joints, peak) = (tree.skeleton.len(), peak_mib());
            println!("{:18} {markers:8} {rounds:7} {joints:8} {ms:9.1} {peak:9}", "guided growth");
        }
    }
}

/// Makes a plant of `nodes` nodes: shoots of 20 nodes along a limb, which a trunk bears.
fn limb(nodes: usize) -> Plant {
    let mut p = Plant::default();
    let line = |from: DVec3, along: DVec3, n: u32| -> Vec<DVec3> {
        (0..n).map(|k| from + along * f64::from(k)).collect()
    };
    let trunk = p.add_axis(AxisKind::Branch, None, 1, &line(DVec3::ZERO, DVec3::Y * 0.1, 40), None);
    let fork = p.axis(trunk).node_ids().nth(20);
    let count = u32::try_from(nodes / 20).unwrap();
    let points = line(DVec3::Y * 2.0, DVec3::X * 0.01, count);
    let limb = p.add_axis(AxisKind::Branch, fork, 2, &points, None);
    let forks: Vec<_> = p.axis(limb).node_ids().collect();
    for (k, (fork, from)) in (3_u64..).zip(forks.into_iter().zip(points)) {
        p.add_axis(AxisKind::Branch, Some(fork), k, &line(from, DVec3::Z * 0.02, 19), None);
    }
    p.nodes.radius_m.iter_mut().for_each(|r| *r = 0.01);
    p
}

fn hands() {
    let plant = limb(20_000);
    let at = |p: DVec3| Pointer {
        ray: Ray { origin: p + DVec3::Z * 5.0, direction: DVec3::NEG_Z },
        forward: DVec3::NEG_Z,
        up: DVec3::Y,
        pressure: 1.0,
        tip: Some(p),
        hand: None,
    };
    let held = DVec3::new(3.0, 2.0, 0.0);
    println!("\na branch of {} nodes in the hand, ms a pose (mean of 200)", plant.nodes.position.len());
    for (name, kind) in [("turned", ToolKind::Rotate), ("moved", ToolKind::Move)] {
        let mut tool = Tool::new(kind);
        tool.handle(&plant, &Input::Down(at(held)));
        let (ms, _) = ms(|| {
            for k in 0..200 {
                let to = held + DVec3::new(0.0, 0.004, 0.002) * f64::from(k);
                tool.handle(&plant, &Input::Move(at(to)));
                assert!(tool.carried(&plant).is_some() || kind == ToolKind::Move, "it is in the hand");
            }
        });
        println!("  {name:8} {:8.3}", ms / 200.0);
    }
    let (tree, _, _) = Oak::FULL.made(&Run::plain());
    let from = GrowFrom::Branch {
        axis: burgeon::shape::AxisKey::for_axis(&tree.plant, AxisId::new(0)).unwrap(),
        at: 0.6,
    };
    let grow = |rounds| HandEdit::Grow {
        from: from.clone(),
        towards: Some(DVec3::X),
        rounds,
        changes: Vec::new(),
        seed: 1,
        mirror: None,
    };
    println!("\na shoot that grows in the hand, on an oak of {} axes: ms a round", tree.plant.axes.len());
    println!("  round      kept  from its start");
    let (context, run) = (Context::default(), Run::plain());
    let begun = Shaping::new(&tree.plant);
    let mut kept = KeptGrowth::default();
    for round in 1..=16 {
        let mut one = begun.clone();
        let (on, _) = ms(|| one.push_again(&grow(round), &context, &mut kept, &run).unwrap());
        let mut other = begun.clone();
        let (anew, _) = ms(|| other.push(&grow(round), &context, &run).unwrap());
        if round % 4 == 0 {
            println!("  {round:5} {on:9.2} {anew:15.2}");
        }
    }
}
