//! Connections: one request each, bounded in size, time and number.

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::site::{Answer, Site, refusal};

/// Longest request head in bytes.
const MAX_HEAD: usize = 16 << 10;
/// How often it is looked whether the time is up.
const GLANCE: Duration = Duration::from_millis(200);

/// What all peers together may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Most connections at one time; one more ends the one that waits longest.
    connections: usize,
    /// From the first byte to the last of both directions: a browser sends its head at once and takes a file of
    /// megabytes in a fraction of this.
    patience: Duration,
}

impl Limits {
    pub(super) const USUAL: Self = Self { connections: 64, patience: Duration::from_secs(5) };
}

/// A peer that is connected.
struct Guest {
    id: u64,
    stream: TcpStream,
    /// Its request was read: it is given an answer.
    answered: bool,
    /// When it came; once it is given an answer, when it last took some of it.
    since: Instant,
}

/// Everybody who is connected.
#[derive(Default)]
struct Guests(Mutex<(u64, Vec<Guest>)>);

impl Guests {
    fn all(&self) -> MutexGuard<'_, (u64, Vec<Guest>)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets one more in. Where it is full another is closed: first one that has asked for nothing yet, the oldest first,
    /// then the one that has taken nothing of its answer for longest.
    fn admit(&self, stream: TcpStream, most: usize) -> u64 {
        let mut all = self.all();
        let (next, open) = &mut *all;
        while open.len() >= most {
            let idle = (0..open.len()).min_by_key(|&k| (open[k].answered, open[k].since));
            let Some(idle) = idle else { break };
            // Its thread sees the end of the stream and is done.
            let _ = open.swap_remove(idle).stream.shutdown(Shutdown::Both);
        }
        *next += 1;
        open.push(Guest { id: *next, stream, answered: false, since: Instant::now() });
        *next
    }

    /// Takes note that an answer is going out.
    fn takes(&self, id: u64) {
        if let Some(guest) = self.all().1.iter_mut().find(|g| g.id == id) {
            (guest.answered, guest.since) = (true, Instant::now());
        }
    }

    fn leave(&self, id: u64) {
        self.all().1.retain(|g| g.id != id);
    }
}

/// Answers until the process ends.
pub(super) fn serve(listener: &TcpListener, site: &Site, limits: Limits) {
    let guests = Guests::default();
    std::thread::scope(|scope| {
        for stream in listener.incoming() {
            let both = stream.and_then(|s| Ok((s.try_clone()?, s)));
            let Ok((other, stream)) = both else {
                // Too many open files, for example: do not spin.
                std::thread::sleep(Duration::from_millis(20));
                continue;
            };
            let id = guests.admit(other, limits.connections);
            let guests = &guests;
            let work = move || {
                // A peer that went away or was too slow wants no answer.
                let _ = converse(stream, site, Instant::now() + limits.patience, &|| guests.takes(id));
                guests.leave(id);
            };
            if std::thread::Builder::new().spawn_scoped(scope, work).is_err() {
                guests.leave(id);
            }
        }
    });
}

fn converse(mut stream: TcpStream, site: &Site, end: Instant, takes: &dyn Fn()) -> std::io::Result<()> {
    stream.set_read_timeout(Some(GLANCE))?;
    stream.set_write_timeout(Some(GLANCE))?;
    // Only this machine is bound to; this holds even where a system forwards ports.
    if !stream.peer_addr()?.ip().is_loopback() {
        return Ok(());
    }
    let answer = match head(&mut stream, end)? {
        Head::Whole(head) => site.answer(&head),
        Head::TooLong(start) => refusal(431, "the request is too long").to(&start),
    };
    takes();
    send(&mut stream, &answer, end, takes)?;
    stream.shutdown(Shutdown::Write)
}

/// Whether to go on after an error of a stream with timeouts.
fn later(e: std::io::Error, end: Instant) -> std::io::Result<()> {
    let waits = matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted);
    if waits && Instant::now() < end { Ok(()) } else { Err(e) }
}

#[derive(Debug, PartialEq, Eq)]
enum Head {
    /// The bytes before the empty line.
    Whole(Vec<u8>),
    /// No empty line within [`MAX_HEAD`].
    TooLong(Vec<u8>),
}

fn head(stream: &mut impl Read, end: Instant) -> std::io::Result<Head> {
    let mut head = Vec::new();
    let mut chunk = [0; 2048];
    loop {
        let n = match stream.read(&mut chunk) {
            Ok(n) => n,
            Err(e) => {
                later(e, end)?;
                continue;
            }
        };
        // A sender of one byte now and then must not hold a thread for ever.
        if n == 0 || Instant::now() >= end {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        let from = head.len().saturating_sub(3);
        head.extend_from_slice(&chunk[..n]);
        if let Some(at) = head[from..].windows(4).position(|w| w == b"\r\n\r\n") {
            head.truncate(from + at);
            return Ok(Head::Whole(head));
        }
        if head.len() > MAX_HEAD {
            return Ok(Head::TooLong(head));
        }
    }
}

fn send(stream: &mut impl Write, answer: &Answer, end: Instant, takes: &dyn Fn()) -> std::io::Result<()> {
    for part in [answer.head.as_bytes(), &answer.body] {
        let mut rest = part;
        while !rest.is_empty() {
            match stream.write(rest) {
                Ok(0) => return Err(ErrorKind::WriteZero.into()),
                Ok(n) => {
                    rest = &rest[n..];
                    takes();
                    // Nor must a reader of one byte now and then.
                    if !rest.is_empty() && Instant::now() >= end {
                        return Err(ErrorKind::TimedOut.into());
                    }
                }
                Err(e) => later(e, end)?,
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::site::Page;
    use super::*;
    use std::net::SocketAddr;
    use std::path::PathBuf;

    #[test]
    fn heads_are_cut_at_the_empty_line_and_bounded() {
        let end = Instant::now() + Duration::from_secs(60);
        let mut whole: &[u8] = b"GET / HTTP/1.1\r\nHost: x\r\n\r\nbody";
        assert_eq!(head(&mut whole, end).unwrap(), Head::Whole(b"GET / HTTP/1.1\r\nHost: x".to_vec()));
        let long = vec![b'x'; MAX_HEAD + 4096];
        assert!(matches!(head(&mut long.as_slice(), end).unwrap(), Head::TooLong(_)));
        assert!(head(&mut &b"GET / HTTP/1.1\r\n"[..], end).is_err());
        assert!(head(&mut &b"GET / HTTP/1.1\r\n\r\n"[..], Instant::now()).is_err(), "the time is up");
    }

    /// A Studio of one small page and one file of 8 MB on a port of its own, served until the tests end.
    fn studio(test: &str, limits: Limits) -> SocketAddr {
        let folder: PathBuf =
            std::env::temp_dir().join(format!("burgeon-http-{test}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("index.html"), "<!doctype html>page").unwrap();
        std::fs::write(folder.join("large.wasm"), vec![7; 8 << 20]).unwrap();
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let site = Site::new(Page::Folder(folder), address.port(), None).unwrap();
        std::thread::spawn(move || serve(&listener, &site, limits));
        address
    }

    fn ask(address: SocketAddr, line: &str) -> TcpStream {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let port = address.port();
        stream.write_all(format!("{line} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n").as_bytes()).unwrap();
        stream
    }

    fn answer(address: SocketAddr, line: &str) -> Vec<u8> {
        let mut all = Vec::new();
        ask(address, line).read_to_end(&mut all).unwrap();
        all
    }

    /// How long it takes until the other side ends a connection, whatever it sends before.
    fn ended(mut stream: TcpStream, from: Instant) -> Duration {
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let mut sink = [0; 1 << 16];
        while let Ok(n) = stream.read(&mut sink) {
            if n == 0 {
                break;
            }
        }
        from.elapsed()
    }

    #[test]
    fn a_browser_is_served_while_a_hundred_peers_wait() {
        let address = studio("many", Limits::USUAL);
        // Some say nothing, some a part of a request, some ask for much and take nothing of it.
        let idle: Vec<TcpStream> = (0..100)
            .map(|k| match k % 3 {
                0 => TcpStream::connect(address).unwrap(),
                1 => {
                    let mut s = TcpStream::connect(address).unwrap();
                    s.write_all(b"GET / HT").unwrap();
                    s
                }
                _ => ask(address, "GET /large.wasm"),
            })
            .collect();
        let from = Instant::now();
        for _ in 0..8 {
            assert!(answer(address, "GET /").ends_with(b"page"));
            assert!(answer(address, "GET /large.wasm").len() > 8 << 20);
        }
        assert!(from.elapsed() < Duration::from_secs(4), "{:?}", from.elapsed());
        drop(idle);
    }

    #[test]
    fn slow_peers_are_ended_when_their_time_is_up() {
        let address = studio("slow", Limits { connections: 8, patience: Duration::from_secs(1) });
        let from = Instant::now();
        let silent = TcpStream::connect(address).unwrap();
        let greedy = ask(address, "GET /large.wasm");
        let mut dripping = TcpStream::connect(address).unwrap();
        let dripped = std::thread::spawn(move || {
            while from.elapsed() < Duration::from_secs(6) && dripping.write_all(b"G").is_ok() {
                std::thread::sleep(Duration::from_millis(50));
            }
            from.elapsed()
        });
        // Nothing was taken of the answer until its time was up: the rest is not sent.
        std::thread::sleep(Duration::from_millis(1800));
        let mut got = Vec::new();
        let _ = (&greedy).read_to_end(&mut got);
        assert!(got.len() < 8 << 20, "all {} bytes came", got.len());
        assert!(ended(silent, from) < Duration::from_secs(4));
        assert!(dripped.join().unwrap() < Duration::from_secs(4));
    }

    #[test]
    fn an_answer_to_head_has_no_body() {
        let address = studio("head", Limits::USUAL);
        for (line, status) in [("HEAD /", "200"), ("HEAD /none.js", "404"), ("HEAD /../x", "404")] {
            let all = String::from_utf8(answer(address, line)).unwrap();
            assert!(all.starts_with(&format!("HTTP/1.1 {status}")), "{line}: {all}");
            assert!(all.ends_with("\r\n\r\n") && all.contains("Content-Length: "), "{line}: {all}");
        }
        let long = format!("HEAD /{}", "x".repeat(MAX_HEAD + 2048));
        let all = String::from_utf8(answer(address, &long)).unwrap();
        assert!(all.starts_with("HTTP/1.1 431") && all.ends_with("\r\n\r\n"), "{all}");
    }
}
