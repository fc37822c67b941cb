//! The memory that the program may use: counted, so that an excess ends in one line instead of an abort.
//!
//! Every allocation passes here. A thread keeps its own count of allocated and freed bytes and adds it to the common
//! count in steps of [`STEP`], so that counting costs next to nothing. The core itself refuses what it can foresee,
//! with the field to change (`base::Budget`); this is the safety net below it.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicIsize, Ordering};
use std::time::Duration;

use burgeon::Budget;

/// Largest difference of a thread's own count before it is added to the common one: 256 KiB.
const STEP: isize = 256 << 10;

/// Bytes in use, except for those not yet added by threads.
static LIVE: AtomicIsize = AtomicIsize::new(0);
/// Largest number of bytes in use.
static LIMIT: AtomicIsize = AtomicIsize::new(isize::MAX);
/// Largest number of bytes in use since this was last set.
static PEAK: AtomicIsize = AtomicIsize::new(0);
/// Whether the limit is the memory of the machine rather than that of the budget.
static OF_MACHINE: AtomicBool = AtomicBool::new(false);
/// Whether the program is ending for lack of memory.
static ENDING: AtomicBool = AtomicBool::new(false);

thread_local! {
    /// Bytes that this thread has allocated minus those freed since it last added them to the common count.
    static UNTOLD: Cell<isize> = const { Cell::new(0) };
    /// Whether this thread ends the program.
    static ENDS: Cell<bool> = const { Cell::new(false) };
}

/// Counts the allocations of the system's allocator.
struct Counting;

#[global_allocator]
static MEMORY: Counting = Counting;

/// Sets the limit: that of the budget, or the free memory of the machine if that is less.
pub(crate) fn limit(budget: &Budget) {
    let allowed = isize::try_from(budget.bytes()).unwrap_or(isize::MAX);
    let free = free_bytes().and_then(|b| isize::try_from(b).ok()).unwrap_or(isize::MAX);
    OF_MACHINE.store(free < allowed, Ordering::Relaxed);
    LIMIT.store(free.min(allowed), Ordering::Relaxed);
}

/// Returns the memory that Linux could give without ending other programs; `None` where it is unknown.
fn free_bytes() -> Option<u64> {
    let text_of = |path: &str| crate::inputs::system_text(Path::new(path));
    let text = text_of("/proc/meminfo")?;
    let kib = |name: &str| {
        let rest = text.lines().find_map(|l| l.strip_prefix(name)?.strip_prefix(':'))?;
        rest.split_whitespace().next()?.parse::<u64>().ok()
    };
    let machine = (kib("MemAvailable")? + kib("SwapFree").unwrap_or(0)).saturating_mul(1024);
    // A container may have less than the machine.
    let own = text_of("/sys/fs/cgroup/memory.max");
    Some(own.and_then(|t| t.trim().parse().ok()).map_or(machine, |own: u64| own.min(machine)))
}

/// Returns the largest memory that some work used beyond what was in use before, in steps of a quarter of a MiB.
pub(crate) fn peak_of<T>(work: impl FnOnce() -> T) -> (T, u64) {
    let before = LIVE.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let made = work();
    (made, PEAK.load(Ordering::Relaxed).saturating_sub(before).max(0).unsigned_abs() as u64)
}

/// Adds to the bytes in use, or subtracts (below 0).
#[inline]
fn count(bytes: isize) {
    // A thread that is ending no longer has its own count.
    let told = UNTOLD.try_with(|untold| {
        let sum = untold.get().wrapping_add(bytes);
        let tells = sum.unsigned_abs() >= STEP.unsigned_abs();
        untold.set(if tells { 0 } else { sum });
        if tells { sum } else { 0 }
    });
    let told = told.unwrap_or(bytes);
    if told != 0 {
        tell(told);
    }
}

#[cold]
fn tell(bytes: isize) {
    let live = LIVE.fetch_add(bytes, Ordering::Relaxed).wrapping_add(bytes);
    PEAK.fetch_max(live, Ordering::Relaxed);
    if bytes > 0 && live > LIMIT.load(Ordering::Relaxed) {
        end(!OF_MACHINE.load(Ordering::Relaxed));
    }
}

/// Ends the program with one line and status 2; drafts of files are removed.
#[cold]
fn end(by_budget: bool) {
    if ENDING.swap(true, Ordering::Relaxed) {
        // Ending takes a little memory, too: where even that is unavailable, this thread continues with what it got.
        // Other threads wait for the end instead of failing themselves.
        while !ENDS.try_with(Cell::get).unwrap_or(true) {
            std::thread::sleep(Duration::from_secs(1));
        }
        return;
    }
    let _ = ENDS.try_with(|ends| ends.set(true));
    LIMIT.store(isize::MAX, Ordering::Relaxed);
    let in_use = LIVE.load(Ordering::Relaxed) >> 20;
    let mut to = std::io::stderr();
    if to.is_terminal() {
        // Replaces the progress line.
        let _ = write!(to, "\r\x1b[2K");
    }
    let _ = if by_budget {
        writeln!(
            to,
            "error: more memory would be needed than the limit of {in_use} MiB: make it smaller or coarser, or allow \
             more with --budget (docs/limits.md)"
        )
    } else {
        writeln!(
            to,
            "error: the machine has no more memory ({in_use} MiB are in use): make it smaller or coarser, or close other \
             programs"
        )
    };
    crate::placing::abandon();
    std::process::exit(2);
}

#[expect(unsafe_code, reason = "an allocator has no safe form; every call goes to the system's as it came")]
// SAFETY: memory comes from and goes back to `System` with the caller's own arguments; counting touches none of it.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(signed(layout.size()));
        // SAFETY: the caller's contract is that of `System`.
        checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(signed(layout.size()));
        // SAFETY: the caller's contract is that of `System`.
        checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(-signed(layout.size()));
        // SAFETY: the caller's contract is that of `System`, from which `memory` came.
        unsafe { System.dealloc(memory, layout) };
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(signed(size).wrapping_sub(signed(layout.size())));
        // SAFETY: the caller's contract is that of `System`, from which `memory` came.
        checked(unsafe { System.realloc(memory, layout, size) }, size)
    }
}

/// Converts a size: layouts are at most `isize::MAX` large.
const fn signed(bytes: usize) -> isize {
    bytes.cast_signed()
}

#[inline]
fn checked(memory: *mut u8, bytes: usize) -> *mut u8 {
    if memory.is_null() && bytes > 0 {
        end(false);
    }
    memory
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_and_given_back_is_counted() {
        let live = || LIVE.load(Ordering::Relaxed);
        let before = live();
        // Other tests allocate as well, so this size exceeds that of all of them together. Zeros are counted, not
        // touched.
        let large = vec![0_u8; 2 << 30];
        assert!(live() - before > 1 << 30, "{}", live() - before);
        drop(large);
        assert!(live() - before < 1 << 30, "{}", live() - before);
    }
}
