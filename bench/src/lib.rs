//! What the benchmarks share: the drawings of Table 1 and two threads.

use std::path::PathBuf;
use std::sync::OnceLock;

use burgeon::formats::{DrawingFormat, read_drawings};
use burgeon::sketch::Drawing;
use burgeon::{Clock, Executor};
use rayon::prelude::*;

/// The eight drawings of the paper's Table 1.
pub const TABLE1: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];

/// A drawing of Table 1, read into memory.
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

/// A stopwatch.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch(std::time::Instant);

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self(std::time::Instant::now())
    }
}

impl Clock for Stopwatch {
    fn now_ms(&self) -> f64 {
        self.0.elapsed().as_secs_f64() * 1e3
    }
}

/// Two threads, as the machine of the paper had two cores: the first that asks and one more, as in the command line.
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
