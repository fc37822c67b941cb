//! Connections: one request each, bounded in size, time and number.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::site::{Answer, Site, refusal};

/// Longest request head in bytes.
const MAX_HEAD: usize = 16 << 10;
/// Most connections at one time.
const MAX_CONNECTIONS: usize = 64;
/// A browser sends its head at once and takes a file of megabytes in this time.
const PATIENCE: Duration = Duration::from_secs(10);

/// Answers until the process ends.
pub(super) fn serve(listener: &TcpListener, site: &Site) {
    let open = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for stream in listener.incoming() {
            let Ok(stream) = stream else {
                // Too many open files, for example: do not spin.
                std::thread::sleep(Duration::from_millis(20));
                continue;
            };
            if open.fetch_add(1, Ordering::Relaxed) >= MAX_CONNECTIONS {
                send(stream, &refusal(503, "too many connections"));
                open.fetch_sub(1, Ordering::Relaxed);
                continue;
            }
            let open = &open;
            let work = move || {
                converse(stream, site);
                open.fetch_sub(1, Ordering::Relaxed);
            };
            if std::thread::Builder::new().spawn_scoped(scope, work).is_err() {
                open.fetch_sub(1, Ordering::Relaxed);
            }
        }
    });
}

fn converse(mut stream: TcpStream, site: &Site) {
    let patient = stream.set_read_timeout(Some(PATIENCE)).and(stream.set_write_timeout(Some(PATIENCE)));
    // Only this machine is bound to; this holds even where a system forwards ports.
    let local = stream.peer_addr().is_ok_and(|a| a.ip().is_loopback());
    if patient.is_err() || !local {
        return;
    }
    let answer = match head(&mut stream) {
        Ok(Some(head)) => site.answer(&head),
        Ok(None) => refusal(431, "the request is too long"),
        Err(_) => return,
    };
    send(stream, &answer);
}

/// The bytes before the empty line; `None` if there are too many.
fn head(stream: &mut impl Read) -> std::io::Result<Option<Vec<u8>>> {
    let began = Instant::now();
    let mut head = Vec::new();
    let mut chunk = [0; 2048];
    loop {
        let n = stream.read(&mut chunk)?;
        // A sender of one byte now and then must not hold a thread for ever.
        if n == 0 || began.elapsed() > PATIENCE {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
        let from = head.len().saturating_sub(3);
        head.extend_from_slice(&chunk[..n]);
        if let Some(at) = head[from..].windows(4).position(|w| w == b"\r\n\r\n") {
            head.truncate(from + at);
            return Ok(Some(head));
        }
        if head.len() > MAX_HEAD {
            return Ok(None);
        }
    }
}

fn send(mut stream: TcpStream, answer: &Answer) {
    // Whoever hung up does not want it.
    let sent = stream.write_all(answer.head.as_bytes()).and_then(|()| stream.write_all(&answer.body));
    let _ = sent.and_then(|()| stream.shutdown(Shutdown::Write));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_cut_at_the_empty_line_and_bounded() {
        let mut whole: &[u8] = b"GET / HTTP/1.1\r\nHost: x\r\n\r\nbody";
        assert_eq!(head(&mut whole).unwrap().unwrap(), b"GET / HTTP/1.1\r\nHost: x");
        let long = vec![b'x'; MAX_HEAD + 4096];
        assert_eq!(head(&mut long.as_slice()).unwrap(), None);
        assert!(head(&mut &b"GET / HTTP/1.1\r\n"[..]).is_err());
    }
}
