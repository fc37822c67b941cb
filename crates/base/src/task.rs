//! The means of a computation, never its subject: cancellation, threads, clocks, budgets.

use core::fmt;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use crate::{Budget, OverBudget};

/// A flag that a shell sets and a computation polls; in return the computation reports its progress through it.
///
/// ```
/// let token = base::CancelToken::new();
/// token.reached(0.25);
/// assert_eq!((token.check(), token.share()), (Ok(()), Some(0.25)));
/// token.cancel();
/// assert!(token.clone().check().is_err());
/// ```
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    cancelled: AtomicBool,
    /// 1 + the share that is done, in ten thousandths; 0 before the first report.
    done: AtomicU32,
}

impl CancelToken {
    /// Creates a token that nobody has cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks every computation that holds this token to stop.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// Fails once [`cancel`](Self::cancel) was called.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.0.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Reports the share of the computation that is done, 0 to 1, for people who wait. It never decreases.
    pub fn reached(&self, share: f64) {
        if share >= 0.0 {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 10,000")]
            let done = 1 + (share.min(1.0) * 10_000.0) as u32;
            self.0.done.fetch_max(done, Ordering::Relaxed);
        }
    }

    /// Returns the share that is done, 0 to 1; `None` if the computation does not report it.
    pub fn share(&self) -> Option<f64> {
        let done = self.0.done.load(Ordering::Relaxed).checked_sub(1)?;
        Some(f64::from(done) / 10_000.0)
    }

    /// Resets the share before another computation.
    pub fn forget(&self) {
        self.0.done.store(0, Ordering::Relaxed);
    }
}

/// The user asked to stop; nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Reason why a computation ended without a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Stopped {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A limit of the budget was exceeded.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}

/// Runs independent jobs, on as many threads as the shell allows. The core never creates threads itself.
pub trait Executor: Sync {
    /// Calls `job(0)` to `job(n - 1)`, each once, in any order, and returns when all are done.
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync));
}

/// One job after another, on the caller's thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl Executor for Serial {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        (0..n).for_each(job);
    }
}

/// Reports the progress of a computation that hands its work to an executor in an unknown number of rounds: each round
/// counts as two fifths of the share that was left before it.
#[derive(Debug)]
pub struct Telling<'a> {
    run: Run<'a>,
    /// Share that is done before the next round.
    done: Mutex<f64>,
}

impl<'a> Telling<'a> {
    /// Starts to report the rounds of a computation of which the share `done`, 0 to 1, is finished.
    pub fn from(done: f64, run: &Run<'a>) -> Self {
        Self { run: *run, done: Mutex::new(done) }
    }

    /// Returns the run whose executor reports the progress.
    pub fn run(&self) -> Run<'_> {
        Run { executor: self, ..self.run }
    }
}

impl Executor for Telling<'_> {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        const ROUND: f64 = 0.4;
        // Nested rounds, and those after a panic, report nothing.
        let Ok(mut done) = self.done.try_lock() else { return self.run.executor.for_each(n, job) };
        let round = ROUND * (1.0 - *done);
        let (from, finished) = (*done, AtomicU32::new(0));
        self.run.executor.for_each(n, &|i| {
            job(i);
            let jobs = finished.fetch_add(1, Ordering::Relaxed) + 1;
            self.run.cancel.reached(from + round * f64::from(jobs) / n as f64);
        });
        *done = from + round;
    }
}

/// Computes `(0..n).map(f)`, spread over `executor`, collected in index order: the same result for any thread count.
///
/// ```
/// assert_eq!(base::map_indexed(&base::Serial, 4, |i| i * i), [0, 1, 4, 9]);
/// ```
pub fn map_indexed<T: Send>(executor: &dyn Executor, n: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let slots: Vec<Mutex<Option<T>>> = (0..n).map(|_| Mutex::new(None)).collect();
    executor.for_each(n, &|i| {
        let value = f(i);
        if let Ok(mut slot) = slots[i].lock() {
            *slot = Some(value);
        }
    });
    let values: Vec<T> = slots.into_iter().filter_map(|s| s.into_inner().ok().flatten()).collect();
    debug_assert_eq!(values.len(), n, "the executor must call every job exactly once");
    values
}

/// As [`map_indexed`], but checks before each job whether the run was cancelled: a job should take at most some ten
/// milliseconds.
///
/// # Errors
/// [`Cancelled`]: at least one job was not done.
///
/// ```
/// let (run, cancel) = (base::Run::plain(), base::CancelToken::new());
/// let stopped = base::Run { cancel: &cancel, ..run };
/// cancel.cancel();
/// assert_eq!(base::map_until_cancelled(&run, 3, |i| i * i), Ok(vec![0, 1, 4]));
/// assert_eq!(base::map_until_cancelled(&stopped, 3, |i| i * i), Err(base::Cancelled));
/// ```
pub fn map_until_cancelled<T: Send>(
    run: &Run<'_>,
    n: usize,
    f: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    map_indexed(run.executor, n, |i| run.cancel.check().map(|()| f(i))).into_iter().collect()
}

/// Time as the shell provides it: the core reads no clock of its own.
pub trait Clock: Sync {
    /// Milliseconds since any fixed moment.
    fn now_ms(&self) -> f64;
}

/// A clock that stands still, for callers that want no timings.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoClock;

impl Clock for NoClock {
    fn now_ms(&self) -> f64 {
        0.0
    }
}

/// The machinery of one computation. Never saved: it cannot change a result, only when and whether it comes.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Polled between steps.
    pub cancel: &'a CancelToken,
    /// Executor of the independent parts.
    pub executor: &'a dyn Executor,
    /// Read for the stage times of the report only.
    pub clock: &'a dyn Clock,
    /// Limits on the amount that may be made. A larger request is refused, never reduced.
    pub budget: Budget,
}

impl fmt::Debug for Run<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Run")
            .field("cancel", self.cancel)
            .field("budget", &self.budget)
            .finish_non_exhaustive()
    }
}

impl Run<'static> {
    /// Creates a run with one thread and no clock, never cancelled, for tests and doctests.
    pub fn plain() -> Self {
        static NEVER: std::sync::OnceLock<CancelToken> = std::sync::OnceLock::new();
        Self {
            cancel: NEVER.get_or_init(CancelToken::new),
            executor: &Serial,
            clock: &NoClock,
            budget: Budget::default(),
        }
    }
}

crate::coded!(Cancelled { Self => "cancelled" {} });

#[cfg(test)]
mod tests {
    use super::*;

    struct Backwards;
    impl Executor for Backwards {
        fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
            std::thread::scope(|s| {
                for k in 0..2 {
                    s.spawn(move || (0..n).rev().filter(|i| i % 2 == k).for_each(job));
                }
            });
        }
    }

    #[test]
    fn map_indexed_keeps_order_on_any_executor() {
        let want: Vec<usize> = (0..101).map(|i| i * 3).collect();
        assert_eq!(map_indexed(&Backwards, 101, |i| i * 3), want);
        assert_eq!(map_indexed(&Serial, 101, |i| i * 3), want);
    }

    #[test]
    fn rounds_tell_how_far_they_are() {
        let token = CancelToken::new();
        let run = Run { cancel: &token, ..Run::plain() };
        let telling = Telling::from(0.5, &run);
        let seen = Mutex::new(Vec::new());
        for _ in 0..3 {
            telling.run().executor.for_each(2, &|_| seen.lock().unwrap().extend(token.share()));
        }
        assert_eq!(token.share(), Some(0.892));
        let seen = seen.into_inner().unwrap();
        assert_eq!(seen.len(), 5, "before the first job nothing was told");
        assert!(seen.windows(2).all(|w| w[0] <= w[1]) && seen[0] == 0.6, "{seen:?}");
    }

    #[test]
    fn cancel_reaches_every_clone() {
        let token = CancelToken::new();
        let copy = token.clone();
        assert_eq!(copy.check(), Ok(()));
        token.cancel();
        assert_eq!(copy.check(), Err(Cancelled));
    }

    #[test]
    fn the_share_that_is_done_only_grows_until_it_is_forgotten() {
        let token = CancelToken::new();
        assert_eq!(token.share(), None);
        for told in [0.0, 0.5, 0.25, f64::NAN, -1.0] {
            token.reached(told);
        }
        assert_eq!(token.share(), Some(0.5));
        token.reached(7.0);
        assert_eq!(token.clone().share(), Some(1.0));
        token.forget();
        assert_eq!(token.share(), None);
    }
}
