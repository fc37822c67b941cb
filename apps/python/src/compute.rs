//! Threads, Ctrl-C and limits: the duties of a shell.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use burgeon::{Budget, CancelToken, Clock, Executor, Run};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::fault::beyond;

/// Number of threads; 0 for as many as the machine has.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// The pool, by process and number of threads: a forked process does not inherit the threads.
static POOL: Mutex<Option<(u32, usize, Arc<rayon::ThreadPool>)>> = Mutex::new(None);

/// Runs independent jobs on a number of threads.
struct Threads(Option<Arc<rayon::ThreadPool>>);

impl Threads {
    fn for_process() -> Self {
        let all = || std::thread::available_parallelism().map_or(1, usize::from);
        let asked = THREADS.load(Ordering::Relaxed);
        let count = if asked == 0 { all() } else { asked };
        if count <= 1 {
            return Self(None);
        }
        let own = (std::process::id(), count);
        let Ok(mut pool) = POOL.lock() else { return Self(None) };
        if let Some((process, threads, pool)) = &*pool
            && (*process, *threads) == own
        {
            return Self(Some(Arc::clone(pool)));
        }
        // A pool of another process has no threads that could end: it is leaked.
        if let Some((process, _, old)) = pool.take().filter(|p| p.0 != own.0) {
            debug_assert_ne!(process, own.0, "another process's");
            std::mem::forget(old);
        }
        let made = rayon::ThreadPoolBuilder::new().num_threads(count).build().ok().map(Arc::new);
        *pool = made.clone().map(|made| (own.0, own.1, made));
        Self(made)
    }
}

impl Executor for Threads {
    fn for_each(&self, n: usize, job: &(dyn Fn(usize) + Sync)) {
        match &self.0 {
            Some(pool) if n > 1 => {
                pool.install(|| (0..n).into_par_iter().with_max_len(1).for_each(job));
            }
            _ => (0..n).for_each(job),
        }
    }
}

struct WallClock(Instant);

impl Clock for WallClock {
    fn now_ms(&self) -> f64 {
        self.0.elapsed().as_secs_f64() * 1000.0
    }
}

/// Computes without Python's lock; Ctrl-C stops it.
pub(crate) fn compute<T: Send>(
    py: Python<'_>,
    budget: f64,
    work: impl FnOnce(&Run<'_>) -> T + Send,
) -> PyResult<T> {
    let (token, clock) = (CancelToken::new(), WallClock(Instant::now()));
    let budget = Budget { times: budget, raise: Some("budget") };
    let threads = py.detach(Threads::for_process);
    std::thread::scope(|scope| {
        let (over, ended) = sync_channel::<()>(1);
        let own = token.clone();
        let thread = scope.spawn(move || {
            // The drop signals the end, also after a panic.
            let _over = over;
            work(&Run { cancel: &own, executor: &threads, clock: &clock, budget })
        });
        if let Err(stop) = wait(py, ended) {
            token.cancel();
            let _ = py.detach(|| thread.join().is_ok());
            return Err(stop);
        }
        py.detach(|| thread.join()).map_err(|payload| bug(payload.as_ref()))
    })
}

/// Does uninterruptible work (files are written and read, tables filled) without Python's lock. Ctrl-C does not wait
/// for it: its result is dropped when it is done.
pub(crate) fn aside<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (over, ended) = sync_channel::<()>(1);
    let thread = std::thread::spawn(move || {
        let _over = over;
        work()
    });
    wait(py, ended)?;
    py.detach(|| thread.join()).map_err(|payload| bug(payload.as_ref()))
}

/// Waits until a thread drops its end of the channel; Ctrl-C raises an error at once.
fn wait(py: Python<'_>, ended: Receiver<()>) -> PyResult<()> {
    let ended = Mutex::new(ended);
    let next = || ended.lock().map_or(Err(RecvTimeoutError::Disconnected), |e| e.recv_timeout(TICK));
    while py.detach(next) == Err(RecvTimeoutError::Timeout) {
        py.check_signals()?;
    }
    Ok(())
}

/// Returns the error for a thread that panicked.
fn bug(payload: &(dyn std::any::Any + Send)) -> PyErr {
    let text = payload.downcast_ref::<&str>().map(|t| (*t).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
    pyo3::exceptions::PyRuntimeError::new_err(format!("internal error, a bug in burgeon: {text}"))
}

/// Interval between two checks for Ctrl-C.
const TICK: Duration = Duration::from_millis(20);

/// Sets the number of threads, 1 to 256; 0 for as many as the machine has. Results do not depend on it.
#[pyfunction]
pub(crate) fn set_threads(count: i64) -> PyResult<()> {
    let sound = usize::try_from(count).ok().filter(|&n| n <= 256);
    THREADS.store(sound.ok_or_else(|| beyond("count", count, "0 to 256"))?, Ordering::Relaxed);
    Ok(())
}
