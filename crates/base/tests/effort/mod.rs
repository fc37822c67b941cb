//! Time that a thread computes: other programs of the machine do not change it, as they do what a clock says.

use std::time::{Duration, Instant};

/// What a thread has spent since this was made.
#[derive(Debug)]
pub(crate) struct Effort {
    begun: Instant,
    before: Option<Duration>,
}

impl Effort {
    pub(crate) fn begin() -> Self {
        Self { begun: Instant::now(), before: of_this_thread() }
    }

    /// Returns the time of the processor, where the system counts it (Linux), or else the time by the clock.
    pub(crate) fn spent(&self) -> Duration {
        // A system that does not count says 0 even now.
        let now = of_this_thread().filter(|now| !now.is_zero());
        now.zip(self.before).map_or_else(|| self.begun.elapsed(), |(now, before)| now.saturating_sub(before))
    }
}

fn of_this_thread() -> Option<Duration> {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds = counted.split_whitespace().next()?.parse().ok()?;
    Some(Duration::from_nanos(nanoseconds))
}
