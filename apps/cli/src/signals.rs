//! The end of the program on request: Ctrl-C, SIGTERM and SIGHUP, a limit of processor time (SIGXCPU). At a limit of
//! the size of files (SIGXFSZ), writing fails instead.
//!
//! A request cancels the computation. If it does not return a moment later, the program does not wait: it removes its
//! drafts and ends, wherever it is.

use std::io::{self, IsTerminal as _, Read, Write};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::Duration;

use burgeon::CancelToken;

use crate::placing;

/// Exit status of a program that was asked to end, as is usual in shells for Ctrl-C.
pub(crate) const STATUS: u8 = 130;
/// Time in which a computation may return by itself.
const GRACE: Duration = Duration::from_millis(400);
/// Time that the last line may take: nobody may be reading it.
const LAST_LINE: Duration = Duration::from_millis(100);

static TOKEN: LazyLock<CancelToken> = LazyLock::new(CancelToken::new);
/// Whether there is nothing to cancel or to report, so that a request ends the program at once.
static AT_ONCE: AtomicBool = AtomicBool::new(false);
/// Whether the end was reported.
static TOLD: AtomicBool = AtomicBool::new(false);

/// Returns the token that the first request cancels.
pub(crate) fn token() -> &'static CancelToken {
    &TOKEN
}

/// Makes the first request end the program, as for a server that runs until it is stopped.
pub(crate) fn end_at_once() {
    AT_ONCE.store(true, Ordering::Relaxed);
}

/// Listens to requests; called before any thread is started.
pub(crate) fn listen() {
    #[cfg(unix)]
    limits();
    // Without a handler requests still end the program.
    let _ = ctrlc::set_handler(requested);
}

/// Cancels at the first request, and ends at the second.
fn requested() {
    let is_second = TOKEN.check().is_err();
    TOKEN.cancel();
    if is_second || AT_ONCE.load(Ordering::Relaxed) {
        end();
    }
    if std::thread::Builder::new().spawn(end_later).is_err() {
        end();
    }
}

fn end_later() {
    std::thread::sleep(GRACE);
    end();
}

/// Blocks signals of limits for all threads, which inherit this: then a file that grows too large is an error of its
/// writer, and one thread waits for the end of processor time.
#[cfg(unix)]
fn limits() {
    use nix::sys::signal::{SigSet, Signal};
    let of = |signals: &[Signal]| signals.iter().copied().collect::<SigSet>();
    let _ = of(&[Signal::SIGXCPU, Signal::SIGXFSZ]).thread_block();
    let wait = move || {
        while let Ok(_) | Err(nix::errno::Errno::EINTR) = of(&[Signal::SIGXCPU]).wait() {
            requested();
        }
    };
    let _ = std::thread::Builder::new().stack_size(64 << 10).spawn(wait);
}

/// Ends the program, whatever its other threads do.
fn end() -> ! {
    placing::leave_nothing();
    if !AT_ONCE.load(Ordering::Relaxed) {
        let (over, waits) = mpsc::channel();
        let told = std::thread::Builder::new().spawn(move || {
            tell();
            over.send(())
        });
        if told.is_ok() {
            let _ = waits.recv_timeout(LAST_LINE);
        }
    }
    std::process::exit(STATUS.into());
}

/// Reports once that the program was stopped.
pub(crate) fn tell() {
    if TOLD.swap(true, Ordering::Relaxed) {
        return;
    }
    if io::stderr().is_terminal() {
        // Replaces the progress line.
        let _ = write!(io::stderr(), "\r\x1b[2K");
    }
    crate::say::error("stopped; files that were written are whole, nothing half-written was left");
}

/// A reader or writer that stops once the program is asked to end.
#[derive(Debug)]
pub(crate) struct Stoppable<T>(pub(crate) T);

fn check() -> io::Result<()> {
    TOKEN.check().map_err(io::Error::other)
}

impl<R: Read> Read for Stoppable<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        check()?;
        self.0.read(bytes)
    }
}

impl<W: Write> Write for Stoppable<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        check()?;
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
