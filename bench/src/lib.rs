//! Shared parts of the benchmarks: the drawings of Table 1, very large ones, an oak, and two threads.

mod piles;

use std::path::PathBuf;
use std::sync::OnceLock;

use base::{Report, Run, Seed};
use burgeon::formats::{DrawingFormat, read_drawings};
use burgeon::ink::Drawing;
use burgeon::mesh::Model;
use burgeon::skin::{SkinSpec, skin};
use burgeon::{Clock, Executor};
use growth::{CompetitionSpec, FoliageSpec, Grown, Method, TreeSpec, grow};
use rayon::prelude::*;

pub use piles::Pile;

/// The eight drawings of the paper's Table 1.
pub const TABLE1: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];

/// Reads a drawing of Table 1 into memory.
///
/// # Panics
/// When the fixture cannot be read: a benchmark without its input is worth nothing.
pub fn table1(name: &str) -> Drawing {
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("../fixtures/sketches/table1/{name}.svg"));
    #[expect(clippy::expect_used, reason = "a benchmark without its input is worth nothing")]
    {
        let bytes = std::fs::read(&path).expect("the fixture is in the repository");
        let mut drawings = read_drawings(bytes.as_slice(), DrawingFormat::Svg, name);
        drawings.next().expect("the fixture has a drawing").expect("the fixture can be read").drawing
    }
}

/// An oak in the envelope of Yang et al.'s Table 2, from its spec to meshes without textures.
#[derive(Clone, Copy, Debug)]
pub struct Oak {
    lifespan: u32,
    points: u32,
    leaf_spacing_m: f64,
    leaf_keep: f64,
    detail: f64,
}

impl Oak {
    /// About as many triangles as the paper's (122,100): two life cycles, leaves 5 cm apart, of 4 triangles each.
    pub const FULL: Self =
        Self { lifespan: 2, points: 1500, leaf_spacing_m: 0.05, leaf_keep: 1.0, detail: 0.45 };
    /// About as many triangles as the large oak of the most used web peer.
    pub const SMALL: Self =
        Self { lifespan: 1, points: 2500, leaf_spacing_m: 0.06, leaf_keep: 0.06, detail: 0.2 };

    /// Grows the oak and makes its surface; the report has the times of the stages `grow`, `wood`, `leaves`, `mesh`.
    ///
    /// # Panics
    /// When it cannot be grown: a benchmark without its input is worth nothing.
    pub fn made(&self, run: &Run<'_>) -> (Grown, Model, Report) {
        let (lifespan, points) = (self.lifespan, self.points);
        let (spacing_m, leaf_keep) = (self.leaf_spacing_m, self.leaf_keep);
        let spec = TreeSpec {
            name: "oak".into(),
            method: Method::Competition(CompetitionSpec { lifespan, points, ..CompetitionSpec::oak() }),
            leaves: FoliageSpec { spacing_m, leaf_keep, ..FoliageSpec::default() },
            ..TreeSpec::default()
        };
        let mut report = Report::default();
        let surface = SkinSpec { detail: self.detail, textures: false, ..SkinSpec::default() };
        #[expect(clippy::expect_used, reason = "a benchmark without its input is worth nothing")]
        let tree = grow(&spec, None, Seed::new(1), run, &mut report).expect("the spec is sound");
        let model = report.stage("mesh", run.clock, |_| skin(&tree.plant, &surface, run));
        #[expect(clippy::expect_used, reason = "a benchmark without its input is worth nothing")]
        let model = model.expect("nobody cancels");
        (tree, model, report)
    }
}

/// A stopwatch.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch(std::time::Instant);

impl Stopwatch {
    /// Starts a stopwatch.
    pub fn start() -> Self {
        Self(std::time::Instant::now())
    }
}

impl Clock for Stopwatch {
    fn now_ms(&self) -> f64 {
        self.0.elapsed().as_secs_f64() * 1e3
    }
}

/// Two threads, as the machine of the paper had two cores: the calling one and one more, as in the command line.
#[derive(Clone, Copy, Debug)]
pub struct TwoThreads;

impl Executor for TwoThreads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        static POOL: OnceLock<rayon::ThreadPool> = OnceLock::new();
        #[expect(clippy::expect_used, reason = "a benchmark on one thread would not measure what it says")]
        let pool = POOL.get_or_init(|| {
            let two = rayon::ThreadPoolBuilder::new().num_threads(2).use_current_thread();
            two.build().expect("two threads can be made")
        });
        pool.install(|| (0..n).into_par_iter().with_max_len(1).for_each(job));
    }
}
