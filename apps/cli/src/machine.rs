//! Threads, time and the progress line: services that the core leaves to its shell.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex};
use std::time::{Duration, Instant};

use burgeon::{Budget, CancelToken, Clock, Executor, Run};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rayon::prelude::*;

use crate::args::CommonArgs;
use crate::signals;

/// Independent jobs on a number of threads.
#[derive(Debug)]
pub(crate) struct Threads {
    pub(crate) count: usize,
    /// `None` for one thread, or where the system grants no more.
    pool: Option<rayon::ThreadPool>,
}

impl Threads {
    /// Starts `asked` threads, or as many as the machine has.
    pub(crate) fn new(asked: Option<u16>) -> Self {
        let all = || std::thread::available_parallelism().map_or(1, usize::from);
        let count = asked.map_or_else(all, usize::from).max(1);
        let builder = || rayon::ThreadPoolBuilder::new().num_threads(count);
        // The calling thread is one of them: it starts at once instead of waking another and waiting for it, which
        // matters where a drawing takes a few milliseconds. A thread can belong to one pool only.
        let pool = || builder().use_current_thread().build().or_else(|_| builder().build()).ok();
        Self { count, pool: (count > 1).then(pool).flatten() }
    }
}

impl Executor for Threads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        match &self.pool {
            Some(pool) if n > 1 => {
                pool.install(|| (0..n).into_par_iter().with_max_len(1).for_each(job));
            }
            _ => (0..n).for_each(job),
        }
    }
}

/// Milliseconds since the program started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallClock(Instant);

impl WallClock {
    pub(crate) fn start() -> Self {
        Self(Instant::now())
    }
}

impl Clock for WallClock {
    fn now_ms(&self) -> f64 {
        self.0.elapsed().as_secs_f64() * 1000.0
    }
}

/// Resources with which a command computes.
#[derive(Debug)]
pub(crate) struct Machine {
    pub(crate) threads: Threads,
    pub(crate) clock: WallClock,
    pub(crate) cancel: &'static CancelToken,
    /// Limits of what may be made.
    pub(crate) budget: Budget,
    /// Whether to print nothing but errors, and show no progress.
    pub(crate) quiet: bool,
}

impl Machine {
    /// Sets up the machine by the options; limits memory from now on.
    pub(crate) fn new(args: &CommonArgs) -> Self {
        let clock = WallClock::start();
        let budget = Budget { times: args.budget, raise: Some("--budget") };
        crate::memory::limit(&budget);
        crate::inputs::trust_paths(args.trust_paths);
        let quiet = args.quiet || args.json;
        Self { threads: Threads::new(args.threads), clock, cancel: signals::token(), budget, quiet }
    }

    /// Returns a run on all threads.
    pub(crate) fn run(&self) -> Run<'_> {
        Run { cancel: self.cancel, executor: &self.threads, clock: &self.clock, budget: self.budget }
    }

    /// Returns a run on the calling thread, for batches whose drawings are spread over threads already.
    pub(crate) fn single(&self) -> Run<'_> {
        Run { cancel: self.cancel, executor: &burgeon::Serial, clock: &self.clock, budget: self.budget }
    }

    /// Returns the milliseconds since the command began: of reading, computing, pictures and writing together.
    pub(crate) fn whole_ms(&self) -> f64 {
        self.clock.now_ms()
    }

    /// Runs `work` and its clock.
    pub(crate) fn timed<T>(&self, work: impl FnOnce() -> T) -> (T, f64) {
        let start = self.clock.now_ms();
        let value = work();
        (value, self.clock.now_ms() - start)
    }

    /// Runs `work` with a progress line on a terminal once it has taken a second: a bar where parts are counted or the
    /// core reports progress.
    pub(crate) fn with_progress<T>(&self, what: &str, work: impl FnOnce(&Progress) -> T) -> T {
        let progress = Progress { done: AtomicUsize::new(0), total: AtomicUsize::new(0) };
        if self.quiet || !std::io::IsTerminal::is_terminal(&std::io::stderr()) {
            return work(&progress);
        }
        self.cancel.forget();
        let over = (Mutex::new(false), Condvar::new());
        std::thread::scope(|scope| {
            scope.spawn(|| show(what, &progress, self.cancel, &over));
            let value = work(&progress);
            if let Ok(mut flag) = over.0.lock() {
                *flag = true;
            }
            over.1.notify_all();
            value
        })
    }
}

/// Progress of a command; the work itself counts parts.
#[derive(Debug)]
pub(crate) struct Progress {
    done: AtomicUsize,
    total: AtomicUsize,
}

impl Progress {
    pub(crate) fn expect(&self, parts: usize) {
        self.total.store(parts, Ordering::Relaxed);
    }

    pub(crate) fn reached(&self, parts: usize) {
        self.done.store(parts, Ordering::Relaxed);
    }

    /// Returns position and length of the bar: of the parts, or of a hundred by the progress of the core.
    fn bar(&self, core: &CancelToken) -> Option<(u64, u64)> {
        let total = self.total.load(Ordering::Relaxed) as u64;
        if total > 0 {
            return Some((self.done.load(Ordering::Relaxed) as u64, total));
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 100")]
        core.share().map(|share| ((share * 100.0) as u64, 100))
    }
}

fn show(what: &str, progress: &Progress, core: &CancelToken, (over, bell): &(Mutex<bool>, Condvar)) {
    // Waits; true when the work is over.
    let wait = |time: u64| -> bool {
        let Ok(flag) = over.lock() else { return true };
        bell.wait_timeout_while(flag, Duration::from_millis(time), |over| !*over).map_or(true, |(f, _)| *f)
    };
    if wait(1000) {
        return;
    }
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let look = |template: &str| {
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
    };
    look("{spinner} {msg} {elapsed}");
    bar.set_message(what.to_owned());
    let mut known = false;
    loop {
        if let Some((done, total)) = progress.bar(core) {
            if !known {
                look("{msg} [{bar:30}] {percent} % {elapsed}");
                known = true;
            }
            bar.set_length(total);
            bar.set_position(done);
        }
        bar.tick();
        if wait(100) {
            break;
        }
    }
    bar.finish_and_clear();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_shows_parts_or_what_the_core_tells() {
        let progress = Progress { done: AtomicUsize::new(0), total: AtomicUsize::new(0) };
        let core = CancelToken::new();
        assert_eq!(progress.bar(&core), None);
        core.reached(0.374);
        assert_eq!(progress.bar(&core), Some((37, 100)));
        progress.expect(8);
        progress.reached(3);
        assert_eq!(progress.bar(&core), Some((3, 8)));
    }

    #[test]
    fn threads_do_every_job_once() {
        for threads in [1, 3, 8] {
            let got = burgeon::map_indexed(&Threads::new(Some(threads)), 100, |i| i * 2);
            assert_eq!(got, (0..100).map(|i| i * 2).collect::<Vec<_>>());
        }
    }
}
