//! Connections: one request each, bounded in size, time and number.

use std::io::{ErrorKind, Read, Write};
use std::net::{IpAddr, Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::answer::Answer;
use super::gate::{Pace, Peers};
use super::site::{Site, refusal};

/// Longest request head in bytes.
const MAX_HEAD: usize = 16 << 10;
/// Interval between two checks of the time limit.
const GLANCE: Duration = Duration::from_millis(200);

/// Limits for all peers together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Most connections at one time; one more closes the one that has waited longest.
    connections: usize,
    /// Time from the first byte to the last of both directions: a browser sends its head at once and receives a file of
    /// megabytes in a fraction of this.
    patience: Duration,
}

impl Limits {
    pub(super) const USUAL: Self = Self { connections: 64, patience: Duration::from_secs(5) };
    /// Limits for a wireless network, which is slower.
    pub(super) const NETWORK: Self = Self { patience: Duration::from_secs(60), ..Self::USUAL };
}

/// Rate of connections of one peer of the network: a page is some sixty files.
const CONNECTIONS: Pace = Pace { at_once: 300.0, per_second: 50.0 };

/// A connected peer.
struct Guest {
    id: u64,
    stream: TcpStream,
    /// Whether its request was read, so that it is being answered.
    answered: bool,
    /// Time of its arrival; during the answer, the last time that it received some of it.
    since: Instant,
}

/// All connected peers.
#[derive(Default)]
struct Guests(Mutex<(u64, Vec<Guest>)>);

impl Guests {
    fn all(&self) -> MutexGuard<'_, (u64, Vec<Guest>)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Admits one more. If it is full, another is closed: first one that has not sent a request yet, the oldest first,
    /// then the one that has received nothing of its answer for longest.
    fn admit(&self, stream: TcpStream, most: usize) -> u64 {
        let mut all = self.all();
        let (next, open) = &mut *all;
        while open.len() >= most {
            let idle = (0..open.len()).min_by_key(|&k| (open[k].answered, open[k].since));
            let Some(idle) = idle else { break };
            // Its thread sees the end of the stream and ends.
            let _ = open.swap_remove(idle).stream.shutdown(Shutdown::Both);
        }
        *next += 1;
        open.push(Guest { id: *next, stream, answered: false, since: Instant::now() });
        *next
    }

    /// Notes that a part of an answer is being sent.
    fn takes(&self, id: u64) {
        if let Some(guest) = self.all().1.iter_mut().find(|g| g.id == id) {
            (guest.answered, guest.since) = (true, Instant::now());
        }
    }

    fn leave(&self, id: u64) {
        self.all().1.retain(|g| g.id != id);
    }
}

/// Answers requests until the process ends.
pub(super) fn serve(listener: &TcpListener, site: &Site, limits: Limits) {
    let guests = Guests::default();
    let mut peers = Peers::default();
    std::thread::scope(|scope| {
        for stream in listener.incoming() {
            let all = stream.and_then(|s| Ok((s.try_clone()?, s.peer_addr()?.ip(), s)));
            let Ok((other, peer, stream)) = all else {
                // Too many open files, for example: do not spin.
                std::thread::sleep(Duration::from_millis(20));
                continue;
            };
            // Before it costs anything.
            if site.network().is_some() && !peers.may(peer, CONNECTIONS, Instant::now()) {
                continue;
            }
            let id = guests.admit(other, limits.connections);
            let guests = &guests;
            let work = move || {
                // A peer that went away or was too slow gets no answer.
                let _ = converse(stream, peer, site, Instant::now() + limits.patience, &|| guests.takes(id));
                guests.leave(id);
            };
            if std::thread::Builder::new().spawn_scoped(scope, work).is_err() {
                guests.leave(id);
            }
        }
    });
}

fn converse(
    mut stream: TcpStream,
    peer: IpAddr,
    site: &Site,
    end: Instant,
    takes: &dyn Fn(),
) -> std::io::Result<()> {
    stream.set_read_timeout(Some(GLANCE))?;
    stream.set_write_timeout(Some(GLANCE))?;
    let Some(network) = site.network() else {
        // Only this machine is bound to; the test holds even where a system forwards ports.
        if peer.is_loopback() {
            talk(&mut stream, peer, site, end, takes)?;
        }
        return stream.shutdown(Shutdown::Write);
    };
    let mut first = [0];
    while stream.peek(&mut first).map_or_else(|e| later(e, end).map(|()| true), |_| Ok(false))? {}
    if first != TLS_HANDSHAKE {
        send(&mut stream, &refusal(400, "write https:// before the address"), end, takes)?;
        return stream.shutdown(Shutdown::Write);
    }
    let mut tls =
        rustls::ServerConnection::new(Arc::clone(&network.identity.tls)).map_err(std::io::Error::other)?;
    talk(&mut rustls::Stream::new(&mut tls, &mut stream), peer, site, end, takes)?;
    tls.send_close_notify();
    while tls.wants_write() {
        if let Err(e) = tls.write_tls(&mut stream) {
            later(e, end)?;
        }
    }
    stream.shutdown(Shutdown::Write)
}

/// The first byte of a TLS connection.
const TLS_HANDSHAKE: [u8; 1] = [0x16];

/// Handles one request and its answer.
fn talk(
    stream: &mut (impl Read + Write),
    peer: IpAddr,
    site: &Site,
    end: Instant,
    takes: &dyn Fn(),
) -> std::io::Result<()> {
    let answer = match head(stream, end)? {
        Head::Whole(head, start) => match site.asked(&head, peer) {
            Ok(asked) => site.answer(&head, &asked, &body(stream, start, asked.length, end)?, peer),
            Err(refused) => refused,
        },
        Head::TooLong(start) => refusal(431, "the request is too long").to(&start),
    };
    takes();
    send(stream, &answer, end, takes)
}

/// Reads the bytes after a head, some of which came with it.
fn body(stream: &mut impl Read, mut body: Vec<u8>, length: usize, end: Instant) -> std::io::Result<Vec<u8>> {
    body.truncate(length);
    let mut chunk = vec![0; (1 << 16).min(length)];
    while body.len() < length {
        let most = chunk.len().min(length - body.len());
        match stream.read(&mut chunk[..most]) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(n) if Instant::now() < end => body.extend_from_slice(&chunk[..n]),
            Ok(_) => return Err(ErrorKind::TimedOut.into()),
            Err(e) => later(e, end)?,
        }
    }
    Ok(body)
}

/// Whether to continue after an error of a stream with timeouts.
fn later(e: std::io::Error, end: Instant) -> std::io::Result<()> {
    let waits = matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted);
    if waits && Instant::now() < end { Ok(()) } else { Err(e) }
}

#[derive(Debug, PartialEq, Eq)]
enum Head {
    /// The bytes before the empty line, and those after it.
    Whole(Vec<u8>, Vec<u8>),
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
            let rest = head.split_off(from + at + 4);
            head.truncate(from + at);
            return Ok(Head::Whole(head, rest));
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
    // Sends what TLS still holds.
    while let Err(e) = stream.flush() {
        later(e, end)?;
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
        assert_eq!(
            head(&mut whole, end).unwrap(),
            Head::Whole(b"GET / HTTP/1.1\r\nHost: x".to_vec(), b"body".to_vec())
        );
        let long = vec![b'x'; MAX_HEAD + 4096];
        assert!(matches!(head(&mut long.as_slice(), end).unwrap(), Head::TooLong(_)));
        assert!(head(&mut &b"GET / HTTP/1.1\r\n"[..], end).is_err());
        assert!(head(&mut &b"GET / HTTP/1.1\r\n\r\n"[..], Instant::now()).is_err(), "the time is up");
    }

    /// Serves a Studio of one small page and one file of 8 MB on a port of its own until the tests end.
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

    /// Returns the time until the other side ends a connection, whatever it sends before.
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
        // Some send nothing, some a part of a request, some request much and receive nothing of it.
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
        // Nothing of the answer was received before its time was up: the rest is not sent.
        std::thread::sleep(Duration::from_millis(1800));
        let mut got = Vec::new();
        let _ = (&greedy).read_to_end(&mut got);
        assert!(got.len() < 8 << 20, "all {} bytes came", got.len());
        assert!(ended(silent, from) < Duration::from_secs(4));
        assert!(dripped.join().unwrap() < Duration::from_secs(4));
    }

    /// A client of the network, which does not verify the server.
    mod network {
        use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream};
        use std::path::PathBuf;
        use std::sync::{Arc, Mutex};

        use super::super::super::gate::{Gate, Invitation};
        use super::super::super::site::{Network, Page, Site};
        use super::super::super::{http, lan};
        use burgeon::document::{Document, write_project};
        use rustls::client::danger::{HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier};
        use rustls::pki_types::{CertificateDer, ServerName, UnixTime};
        use rustls::{ClientConfig, ClientConnection, DigitallySignedStruct, Error, SignatureScheme};
        use std::io::{Read, Write};
        use std::time::{Duration, Instant};

        #[derive(Debug)]
        struct Anybody;

        impl ServerCertVerifier for Anybody {
            fn verify_server_cert(
                &self,
                _: &CertificateDer<'_>,
                _: &[CertificateDer<'_>],
                _: &ServerName<'_>,
                _: &[u8],
                _: UnixTime,
            ) -> Result<ServerCertVerified, Error> {
                Ok(ServerCertVerified::assertion())
            }

            fn verify_tls12_signature(
                &self,
                _: &[u8],
                _: &CertificateDer<'_>,
                _: &DigitallySignedStruct,
            ) -> Result<HandshakeSignatureValid, Error> {
                Ok(HandshakeSignatureValid::assertion())
            }

            fn verify_tls13_signature(
                &self,
                _: &[u8],
                _: &CertificateDer<'_>,
                _: &DigitallySignedStruct,
            ) -> Result<HandshakeSignatureValid, Error> {
                Ok(HandshakeSignatureValid::assertion())
            }

            fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
                rustls::crypto::ring::default_provider().signature_verification_algorithms.supported_schemes()
            }
        }

        /// Invitations that the terminal showed, of all servers of these tests.
        static SHOWN: Mutex<Vec<(String, Invitation)>> = Mutex::new(Vec::new());

        fn shown(host: &str, invitation: &Invitation) {
            SHOWN.lock().unwrap().push((host.to_owned(), invitation.clone()));
        }

        struct Served {
            address: SocketAddr,
            client: Arc<ClientConfig>,
            project: PathBuf,
            fingerprint: String,
        }

        impl Served {
            fn new(test: &str) -> Self {
                Self::behind(test, Gate::new(lan::RANDOM))
            }

            fn behind(test: &str, gate: Gate) -> Self {
                let folder = std::env::temp_dir().join(format!("burgeon-lan-{test}-{}", std::process::id()));
                std::fs::create_dir_all(&folder).unwrap();
                std::fs::write(folder.join("index.html"), "<!doctype html>page").unwrap();
                let project = folder.join("my rose.burgeon");
                std::fs::write(&project, write_project(&Document::default(), "test").unwrap()).unwrap();
                let listener = TcpListener::bind("127.0.0.1:0").unwrap();
                let address = listener.local_addr().unwrap();
                let site = Site::new(Page::Folder(folder), address.port(), Some(project.clone())).unwrap();
                let identity = lan::identity(IpAddr::from([127, 0, 0, 1])).unwrap();
                let fingerprint = identity.fingerprint.clone();
                let network = Network::new(identity, gate, shown);
                let site = site.in_network(address.to_string(), network);
                site.invite();
                std::thread::spawn(move || http::serve(&listener, &site, http::Limits::NETWORK));
                let provider = Arc::new(rustls::crypto::ring::default_provider());
                let client = ClientConfig::builder_with_provider(provider)
                    .with_safe_default_protocol_versions()
                    .unwrap()
                    .dangerous()
                    .with_custom_certificate_verifier(Arc::new(Anybody))
                    .with_no_client_auth();
                Self { address, client: Arc::new(client), project, fingerprint }
            }

            /// Returns the invitation that the terminal shows now.
            fn invitation(&self) -> Invitation {
                let host = self.address.to_string();
                let all = SHOWN.lock().unwrap();
                all.iter().rev().find(|(h, _)| *h == host).expect("shown").1.clone()
            }

            fn send(&self, head: &str, body: &[u8]) -> String {
                let mut tcp = TcpStream::connect(self.address).unwrap();
                tcp.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
                let name = ServerName::try_from("127.0.0.1").unwrap();
                let mut tls = ClientConnection::new(Arc::clone(&self.client), name).unwrap();
                let mut stream = rustls::Stream::new(&mut tls, &mut tcp);
                let mut all = Vec::new();
                let sent = stream
                    .write_all(head.as_bytes())
                    .and_then(|()| stream.write_all(body))
                    .and_then(|()| stream.flush());
                if sent.is_ok() {
                    let _ = stream.read_to_end(&mut all);
                }
                String::from_utf8_lossy(&all).into_owned()
            }

            fn ask(&self, line: &str, headers: &str, body: &[u8]) -> String {
                let own = self.address;
                let length = if body.is_empty() {
                    String::new()
                } else {
                    format!("Content-Length: {}\r\n", body.len())
                };
                self.send(
                    &format!(
                        "{line} HTTP/1.1\r\nHost: {own}\r\nOrigin: https://{own}\r\n{length}{headers}\r\n"
                    ),
                    body,
                )
            }

            /// Returns the cookie of a browser that enters by the link.
            fn enter(&self) -> String {
                let key = format!("key={}", self.invitation().key);
                let answer = self.ask("POST /enter", "", key.as_bytes());
                assert!(
                    answer.starts_with("HTTP/1.1 303")
                        && answer.contains("/?open=opened%2Fmy%20rose.burgeon")
                );
                let name = format!("Set-Cookie: burgeon-{}=", self.address.port());
                assert!(answer.contains("; Secure; HttpOnly; SameSite=Lax"), "{answer}");
                assert!(answer.contains(&name), "{answer}");
                let cookie = answer.split("Set-Cookie: ").nth(1).unwrap().split(';').next().unwrap();
                format!("Cookie: {cookie}\r\n")
            }
        }

        fn etag(answer: &str) -> String {
            answer.split("ETag: ").nth(1).unwrap().split("\r\n").next().unwrap().to_owned()
        }

        #[test]
        fn nothing_is_given_without_the_link_or_the_code() {
            let served = Served::new("door");
            let first = served.invitation();
            for (line, status, words) in [
                ("GET /", "401", "name=code"),
                ("GET /assets/a-1.js", "401", "come in by"),
                ("GET /opened/my%20rose.burgeon", "401", "come in by"),
                ("GET /?key=0123456789abcdef0123456789abcdef", "401", "used already"),
                ("GET /?key=", "401", "used already"),
                ("PUT /opened/my%20rose.burgeon", "401", "come in by"),
            ] {
                let port = served.address.port();
                for cookie in [
                    String::new(),
                    format!("Cookie: burgeon-{port}=\r\n"),
                    format!("Cookie: burgeon-{port}=0123456789abcdef0123456789abcdef\r\n"),
                ] {
                    let answer = served.ask(line, &cookie, b"");
                    assert!(
                        answer.starts_with(&format!("HTTP/1.1 {status}")) && answer.contains(words),
                        "{line}: {answer}"
                    );
                    assert!(!answer.contains("page"), "{line}");
                }
            }
            let cookie = served.enter();
            assert!(served.ask("GET /", &cookie, b"").ends_with("page"));
            // The link is used up; the next one is shown, with another code.
            let used = format!("key={}", first.key);
            assert!(served.ask("POST /enter", "", used.as_bytes()).contains("used already"));
            assert!(served.ask(&format!("GET /?{used}"), "", b"").contains("used already"));
            let code = served.invitation().code.unwrap();
            assert_ne!(Some(&code), first.code.as_ref());
            let given = format!("code={}+{}", &code[..4], &code[4..]);
            assert!(served.ask("POST /enter", "", b"code=1").contains("not the code"));
            assert!(served.ask("POST /enter", "", given.as_bytes()).starts_with("HTTP/1.1 303"));
            // Another name for this address, and another page.
            let foreign = format!("GET / HTTP/1.1\r\nHost: evil.example\r\n{cookie}\r\n");
            assert!(served.send(&foreign, b"").starts_with("HTTP/1.1 421"));
            let own = served.address;
            let other =
                format!("GET / HTTP/1.1\r\nHost: {own}\r\nOrigin: https://evil.example\r\n{cookie}\r\n");
            assert!(served.send(&other, b"").starts_with("HTTP/1.1 403"));
            // Without TLS, the answer only says what to do.
            let mut plain = TcpStream::connect(own).unwrap();
            plain.write_all(format!("GET / HTTP/1.1\r\nHost: {own}\r\n{cookie}\r\n").as_bytes()).unwrap();
            let mut all = String::new();
            let _ = plain.read_to_string(&mut all);
            assert!(all.starts_with("HTTP/1.1 400") && all.contains("https://"), "{all}");
        }

        #[test]
        fn a_project_is_written_back_whole_and_over_the_version_that_is_known() {
            let served = Served::new("save");
            let cookie = served.enter();
            let path = "/opened/my%20rose.burgeon";
            let read = served.ask(&format!("GET {path}"), &cookie, b"");
            let known = |version: &str| format!("{cookie}If-Match: {version}\r\n");
            let first = etag(&read);
            let mut other = document_of("another name");
            let put = |headers: &str, body: &[u8]| served.ask(&format!("PUT {path}"), headers, body);
            assert!(put(&cookie, &other).starts_with("HTTP/1.1 412"), "a version must be known");
            assert!(put(&known(&first), b"PK nonsense").starts_with("HTTP/1.1 422"));
            let saved = put(&known(&first), &other);
            assert!(saved.starts_with("HTTP/1.1 204"), "{saved}");
            assert_eq!(std::fs::read(&served.project).unwrap(), other);
            // The version known before is outdated, until the file is read again.
            other = document_of("a third name");
            assert!(put(&known(&first), &other).starts_with("HTTP/1.1 412"));
            assert!(put(&known(&etag(&saved)), &other).starts_with("HTTP/1.1 204"));
            // The desktop wrote meanwhile: its version is kept.
            let desktop = document_of("the desktop's");
            std::fs::write(&served.project, &desktop).unwrap();
            assert!(put(&known(&first), &other).starts_with("HTTP/1.1 412"));
            assert_eq!(std::fs::read(&served.project).unwrap(), desktop);
            let folder = served.project.parent().unwrap();
            let left =
                std::fs::read_dir(folder).unwrap().filter_map(|f| f.unwrap().file_name().into_string().ok());
            assert!(left.into_iter().all(|name| !name.ends_with(".part")), "no draft is left");
        }

        #[test]
        fn a_link_that_is_only_looked_at_is_not_used_up() {
            let served = Served::new("looked");
            let key = served.invitation().key;
            let link = format!("/?key={key}");
            // Programs that show a preview request the head, then the page, as often as they like.
            for _ in 0..5 {
                let head = served.ask(&format!("HEAD {link}"), "", b"");
                assert!(head.starts_with("HTTP/1.1 401") && head.ends_with("\r\n\r\n"), "{head}");
                let page = served.ask(&format!("GET {link}"), "", b"");
                assert!(page.starts_with("HTTP/1.1 401") && !page.contains("Set-Cookie"), "{page}");
                assert!(page.contains(&format!("name=key value=\"{key}\"")), "{page}");
                assert!(page.contains(&served.fingerprint), "{page}");
            }
            assert_eq!(served.invitation().key, key);
            // Another page cannot press the button.
            let own = served.address;
            let foreign = format!(
                "POST /enter HTTP/1.1\r\nHost: {own}\r\nOrigin: https://evil.example\r\nContent-Length: 36\r\n\r\n"
            );
            assert!(served.send(&foreign, format!("key={key}").as_bytes()).starts_with("HTTP/1.1 403"));
            let cookie = served.enter();
            assert!(served.ask("GET /", &cookie, b"").ends_with("page"));
            assert!(served.ask(&format!("GET {link}"), "", b"").contains("used already"));
            // A browser that is admitted and opens the next link uses nothing up.
            let next = served.invitation().key;
            assert!(served.ask(&format!("GET /?key={next}"), &cookie, b"").ends_with("page"));
            let pressed = served.ask("POST /enter", &cookie, format!("key={next}").as_bytes());
            assert!(pressed.starts_with("HTTP/1.1 303") && served.invitation().key == next, "{pressed}");
        }

        #[test]
        fn when_codes_are_stopped_the_page_and_the_terminal_say_how_to_go_on() {
            let mut gate = Gate::new(lan::RANDOM);
            (0..23).for_each(|_| drop(gate.by_code("1")));
            let served = Served::behind("stopped", gate);
            let wrong = || served.ask("POST /enter", "", b"code=1");
            assert!(wrong().contains("name=code") && served.invitation().code.is_some(), "the 24th");
            let last = wrong();
            assert!(last.contains("no code is taken any more") && last.contains("Open the link"), "{last}");
            assert!(!last.contains("name=code") && served.invitation().code.is_none());
            let after = wrong();
            assert!(after.contains("Open the link") && !after.contains("name=code"), "{after}");
            assert!(served.ask("GET /", "", b"").contains("start the program anew"));
            let cookie = served.enter();
            assert!(served.ask("GET /", &cookie, b"").ends_with("page"), "the link still works");
        }

        #[cfg(unix)]
        #[test]
        fn a_project_that_is_written_back_keeps_its_rights() {
            use std::os::unix::fs::PermissionsExt as _;
            let served = Served::new("rights");
            let cookie = served.enter();
            let path = "/opened/my%20rose.burgeon";
            let known = || {
                let read = served.ask(&format!("GET {path}"), &cookie, b"");
                format!("{cookie}If-Match: {}\r\n", etag(&read))
            };
            let rights = || std::fs::metadata(&served.project).unwrap().permissions().mode() & 0o7777;
            let set = |mode| {
                std::fs::set_permissions(&served.project, std::fs::Permissions::from_mode(mode)).unwrap();
            };
            for mode in [0o600, 0o640, 0o664] {
                set(mode);
                let saved = served.ask(&format!("PUT {path}"), &known(), &document_of(&format!("{mode:o}")));
                assert!(saved.starts_with("HTTP/1.1 204"), "{saved}");
                assert_eq!(rights(), mode, "{mode:o}");
            }
            // Nor is a read-only file replaced.
            set(0o400);
            let before = std::fs::read(&served.project).unwrap();
            let saved = served.ask(&format!("PUT {path}"), &known(), &document_of("not this"));
            assert!(saved.starts_with("HTTP/1.1 507") && saved.contains("cannot be written"), "{saved}");
            assert_eq!((rights(), std::fs::read(&served.project).unwrap()), (0o400, before));
        }

        fn document_of(name: &str) -> Vec<u8> {
            let mut editor = burgeon::document::Editor::default();
            editor.run(burgeon::document::SceneCommand::Rename(name.into())).unwrap();
            write_project(editor.document(), "test").unwrap()
        }

        #[test]
        fn a_thousand_requests_of_a_stranger_keep_nobody_who_is_in_from_working() {
            let served = Served::new("flood");
            let cookie = served.enter();
            let from = Instant::now();
            let answered = std::thread::scope(|scope| {
                let many: Vec<_> = (0..4)
                    .map(|_| {
                        scope.spawn(|| {
                            (0..250)
                                .filter(|_| served.ask("GET /", "", b"").starts_with("HTTP/1.1 401"))
                                .count()
                        })
                    })
                    .collect();
                many.into_iter().map(|t| t.join().unwrap()).sum::<usize>()
            });
            // The burst allowed, and ten a second after that.
            let most = 61.0 + 10.0 * from.elapsed().as_secs_f64();
            assert!((answered as f64) < most, "{answered} of 1000 were answered");
            // When there is room for one more of this peer.
            std::thread::sleep(Duration::from_secs(1));
            assert!(served.ask("GET /", &cookie, b"").ends_with("page"), "after {:?}", from.elapsed());
        }
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
