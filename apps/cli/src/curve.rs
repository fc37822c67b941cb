//! `burgeon compare guided`: time against buds, as in the VR paper's Fig 19 (its own numbers are lost).

use burgeon::growth::{self, Envelope, GuidedSpec, Light, Method, Obstacles, SelfOrganizingSpec, Skeleton};
use burgeon::{Budget, Report, Run, Seed, glam::DVec3};
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::{memory, say};

/// Markers of a bud in the paper.
const PAPER_MARKERS: u32 = 1300;
/// Rounds at which a tree is measured.
const ROUNDS: [u32; 4] = [8, 16, 24, 32];
/// Time below which a measurement is repeated, ms.
const QUICK_MS: f64 = 200.0;
/// Number of places of the crown that are tested for wood nearby.
const PLACES: usize = 2000;
/// Share of a crown with wood within a bud's perception at which it counts as full.
const FULL: f64 = 0.95;

/// A method at a number of rounds.
#[derive(Debug, Serialize)]
pub(crate) struct Point {
    method: &'static str,
    /// Markers of a bud and round; of the whole crown for the baseline, which scatters them once.
    markers: u32,
    rounds: u32,
    /// Internodes grown, including shed ones: each bore a bud.
    buds: usize,
    /// Share of the crown that has wood within a bud's perception.
    filled: f64,
    /// Time of growth alone.
    seconds: f64,
    /// Largest memory that growth used.
    peak_mib: f64,
}

/// Ratio of the times in which both methods fill the crown equally; one for each number of markers.
#[derive(Debug, Serialize)]
pub(crate) struct Ratio {
    markers: u32,
    /// Share of the crown at which both are compared.
    filled: f64,
    baseline_seconds: f64,
    seconds: f64,
    /// Time of the baseline over ours.
    times: f64,
    /// Memory of the baseline over ours.
    memory: f64,
}

/// The curve, and its results.
#[derive(Debug, Serialize)]
pub(crate) struct Curve {
    points: Vec<Point>,
    at_equal_quality: Vec<Ratio>,
}

pub(crate) fn curve(methods: &[Method; 2], seed: u64, machine: &Machine) -> Outcome<Curve> {
    let [Method::Guided(guided), Method::SelfOrganizing(baseline)] = methods else {
        return Err(Failure::Bug("the methods to compare are others".to_owned()));
    };
    let envelope = guided.envelope.clone().ok_or_else(|| Failure::Bug("no envelope".to_owned()))?;
    let crown = Crown::new(&envelope, guided.far * guided.internode_m)?;
    // The paper's markers exceed the default budget.
    let run = Run { budget: Budget { times: 1000.0, ..Budget::default() }, ..machine.single() };
    let mut points = Vec::new();
    let Light::Space { markers, .. } = baseline.light else {
        return Err(Failure::Bug("the baseline asks for light".to_owned()));
    };
    for rounds in ROUNDS {
        let spec = SelfOrganizingSpec { years: rounds, ..baseline.clone() };
        let grow = || {
            let (roots, none) = ([DVec3::ZERO], Obstacles::none());
            let grown =
                growth::self_organize(&roots, &none, &spec, Seed::new(seed), &run, &mut Report::default());
            grown.map(|g| (g.generated, g.skeleton))
        };
        points.push(crown.point(("self-organisation", markers, rounds), grow, machine)?);
    }
    for markers in [guided.markers, PAPER_MARKERS] {
        for rounds in ROUNDS {
            let spec = GuidedSpec { rounds, markers, ..guided.clone() };
            let grow = || {
                let (roots, none) = ([DVec3::ZERO], Obstacles::none());
                let grown =
                    growth::guide(&roots, &none, &spec, Seed::new(seed), &run, &mut Report::default());
                grown.map(|g| (g.skeleton.len(), g.skeleton))
            };
            points.push(crown.point(("guided growth", markers, rounds), grow, machine)?);
        }
    }
    let at_equal_quality = [guided.markers, PAPER_MARKERS].map(|of| ratio(&points, of));
    Ok(Curve { points, at_equal_quality: at_equal_quality.into_iter().flatten().collect() })
}

/// Compares both methods where they first fill as much as each of them can, or [`FULL`] if both reach it.
fn ratio(points: &[Point], markers: u32) -> Option<Ratio> {
    let ours: Vec<&Point> =
        points.iter().filter(|p| p.method == "guided growth" && p.markers == markers).collect();
    let theirs: Vec<&Point> = points.iter().filter(|p| p.method != "guided growth").collect();
    let most = |of: &[&Point]| of.iter().map(|p| p.filled).fold(0.0, f64::max);
    let filled = FULL.min(most(&ours)).min(most(&theirs));
    let first = |of: &[&Point]| -> Option<(f64, f64)> {
        let p = of.iter().find(|p| p.filled >= filled)?;
        Some((p.seconds, p.peak_mib))
    };
    let ((seconds, own), (baseline_seconds, other)) = (first(&ours)?, first(&theirs)?);
    let over = |a: f64, b: f64| if b > 0.0 { a / b } else { f64::NAN };
    let (times, memory) = (over(baseline_seconds, seconds), over(other, own));
    Some(Ratio { markers, filled, baseline_seconds, seconds, times, memory })
}

/// The crown to be filled.
struct Crown {
    places: Vec<DVec3>,
    near_m: f64,
}

impl Crown {
    fn new(envelope: &Envelope, near_m: f64) -> Outcome<Self> {
        let bug = |e: growth::GrowthError| Failure::Bug(format!("the envelope: {e}"));
        let region = envelope.prepare().map_err(bug)?;
        Ok(Self { places: region.scatter(PLACES, 0.0, Seed::new(7), |_| true).map_err(bug)?, near_m })
    }

    fn point(
        &self,
        (method, markers, rounds): (&'static str, u32, u32),
        grow: impl Fn() -> Result<(usize, Skeleton), growth::GrowthError>,
        machine: &Machine,
    ) -> Outcome<Point> {
        let once = || {
            let ((grown, ms), peak) = memory::peak_of(|| machine.timed(&grow));
            let grown = grown.map_err(|e| match e {
                growth::GrowthError::Cancelled(_) => Failure::Cancelled,
                e => Failure::Bug(format!("{method}: {e}")),
            });
            grown.map(|g| (g, ms, peak))
        };
        let ((buds, skeleton), first, peak) = once()?;
        // A very short measurement is repeated.
        let second = if first < QUICK_MS { once()?.1 } else { first };
        let wood = burgeon::geom::KdTree::new(&skeleton.position);
        let near = self.places.iter().filter(|p| wood.nearest(**p, self.near_m).is_some()).count();
        Ok(Point {
            method,
            markers,
            rounds,
            buds,
            filled: near as f64 / self.places.len().max(1) as f64,
            seconds: first.min(second) / 1000.0,
            peak_mib: peak as f64 / f64::from(1 << 20),
        })
    }
}

pub(crate) fn table(curve: &Curve) {
    say::line(&format!(
        "\n{:<20}{:>9}{:>8}{:>9}{:>9}{:>10}{:>10}",
        "growth alone", "markers", "rounds", "buds", "filled", "seconds", "memory"
    ));
    for p in &curve.points {
        say::line(&format!(
            "{:<20}{:>9}{:>8}{:>9}{:>7.0} %{:>10.4}{:>6.1} MiB",
            p.method,
            p.markers,
            p.rounds,
            say::grouped(p.buds as u64),
            100.0 * p.filled,
            p.seconds,
            p.peak_mib
        ));
    }
    for r in &curve.at_equal_quality {
        say::line(&format!(
            "{:.0} % of the crown filled: {:.4} s for the baseline, {:.4} s with {} markers a bud: {:.1} times; \
             memory {:.1} times",
            100.0 * r.filled,
            r.baseline_seconds,
            r.seconds,
            r.markers,
            r.times,
            r.memory
        ));
    }
}
