//! What is answered to a request: the files of the page, and the file that the Studio was opened with. To the network
//! only to browsers that came in, and a project that was opened is written back.
//!
//! `request -> the file, if it is one of the page -> status, headers, bytes`

use std::borrow::Cow;
use std::io::Write as _;
use std::net::IpAddr;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use burgeon::document::{MAX_PROJECT_BYTES, read_project};
use rustls::ServerConfig;
use sha2::{Digest as _, Sha256};

use super::gate::{Entry, Gate, Invitation, Pace, Peers};
use super::request::{Addresses, Asked, COOKIE, Method, NO_FILE, Target, asked};
use crate::draft::Draft;
use crate::failure::{Failure, Outcome};
use crate::placing::{Move, put_all};

/// Nothing but the page's own files; WebAssembly may be compiled, data of the page may be shown as pictures.
pub(crate) const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; \
    style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; manifest-src 'self'; base-uri 'none'; \
    form-action 'none'; frame-ancestors 'none'";

/// Headers of every answer, the refusals included.
const ALWAYS: &str = "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
    Cross-Origin-Opener-Policy: same-origin\r\nCross-Origin-Embedder-Policy: require-corp\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\nPermissions-Policy: camera=(), microphone=(), geolocation=()\r\n\
    Connection: close\r\n";

const TYPES: [(&str, &str); 8] = [
    ("html", "text/html; charset=utf-8"),
    ("js", "text/javascript; charset=utf-8"),
    ("css", "text/css; charset=utf-8"),
    ("wasm", "application/wasm"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("json", "application/json"),
    ("webmanifest", "application/manifest+json"),
];

/// Files by their names in addresses.
pub(crate) type Files = &'static [(&'static str, &'static [u8])];

/// Where the files of the page are.
#[derive(Debug)]
pub(crate) enum Page {
    /// In this folder, as they are when they are asked for.
    Folder(PathBuf),
    /// In the program.
    Inside(Files),
}

/// What strangers may ask for, and how often codes may be tried.
const STRANGERS: Pace = Pace { at_once: 60.0, per_second: 10.0 };
const TRIES: Pace = Pace { at_once: 5.0, per_second: 0.5 };

/// A page that is served on one port of this machine.
#[derive(Debug)]
pub(crate) struct Site {
    page: Page,
    own: Addresses,
    opened: Option<PathBuf>,
    network: Option<Network>,
}

/// What a server of the network has besides.
#[derive(Debug)]
pub(crate) struct Network {
    pub(crate) tls: Arc<ServerConfig>,
    door: Mutex<Door>,
    /// One change of the file at a time.
    writing: Mutex<()>,
    /// Says how the next browser comes in.
    invite: fn(&str, &Invitation),
}

#[derive(Debug)]
struct Door {
    gate: Gate,
    strangers: Peers,
    tries: Peers,
}

impl Network {
    pub(crate) fn new(tls: Arc<ServerConfig>, gate: Gate, invite: fn(&str, &Invitation)) -> Self {
        let door = Door { gate, strangers: Peers::default(), tries: Peers::default() };
        Self { tls, door: Mutex::new(door), writing: Mutex::default(), invite }
    }

    fn door(&self) -> MutexGuard<'_, Door> {
        self.door.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Status line, headers with the empty line, and the body (none for HEAD).
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: Cow<'static, [u8]>,
}

impl Answer {
    /// The answer to a request with this head: to HEAD the headers only, refusals included.
    pub(crate) fn to(self, head: &[u8]) -> Self {
        let body = if head.starts_with(b"HEAD ") { Cow::default() } else { self.body };
        Self { body, ..self }
    }
}

impl Site {
    pub(crate) fn new(page: Page, port: u16, opened: Option<PathBuf>) -> Outcome<Self> {
        let page = match page {
            Page::Folder(folder) => {
                Page::Folder(folder.canonicalize().map_err(|e| Failure::io(&folder, "read", &e))?)
            }
            inside @ Page::Inside(_) => inside,
        };
        let hosts = ["127.0.0.1", "localhost"].map(|h| format!("{h}:{port}")).to_vec();
        Ok(Self { page, own: Addresses { scheme: "http", hosts, takes: 0 }, opened, network: None })
    }

    /// The same page for the network, under this host and no other.
    pub(crate) fn in_network(self, host: String, network: Network) -> Self {
        let own = Addresses { scheme: "https", hosts: vec![host], takes: MAX_PROJECT_BYTES };
        Self { own, network: Some(network), ..self }
    }

    pub(crate) fn network(&self) -> Option<&Network> {
        self.network.as_ref()
    }

    /// Says how the next browser comes in.
    pub(crate) fn invite(&self) {
        if let Some(network) = &self.network {
            (network.invite)(&self.own.hosts[0], network.door().gate.invitation());
        }
    }

    /// What a request with this head asks for, or the answer that refuses it before its body is read.
    pub(crate) fn asked(&self, head: &[u8], peer: IpAddr) -> Result<Asked, Answer> {
        let asked = asked(head, &self.own).map_err(|(status, why)| refusal(status, why).to(head))?;
        self.admit(&asked, peer).map_or(Ok(asked), |answer| Err(answer.to(head)))
    }

    /// The answer to a request that may be answered, whose body was read.
    pub(crate) fn answer(&self, head: &[u8], asked: &Asked, body: &[u8], peer: IpAddr) -> Answer {
        let answer = match asked.method {
            Method::Enter => self.enter(body, peer),
            Method::Save => self.save(asked, body),
            Method::Read => self.file(asked).unwrap_or_else(|| refusal(404, NO_FILE)),
        };
        answer.to(head)
    }

    /// What a stranger is told; nothing to a browser that is in.
    fn admit(&self, asked: &Asked, peer: IpAddr) -> Option<Answer> {
        let mut door = self.network.as_ref()?.door();
        if asked.cookie.as_deref().is_some_and(|c| door.gate.knows(c)) {
            return None;
        }
        if !door.strangers.may(peer, STRANGERS, Instant::now()) {
            return Some(refusal(429, "too many requests; wait a little"));
        }
        if let Some(key) = asked.key.as_deref().filter(|_| asked.method == Method::Read) {
            if let Entry::In(cookie) = door.gate.by_key(key) {
                drop(door);
                return Some(self.welcome(&cookie, peer));
            }
            return Some(doorway(
                "This link was used already, or is another one. Take the one that the terminal shows now.",
            ));
        }
        match (asked.method, &asked.target) {
            (Method::Enter, _) => None,
            (Method::Read, Target::Door) => Some(doorway("")),
            (Method::Read, Target::File(path)) if path == "index.html" => Some(doorway("")),
            _ => Some(refusal(401, "come in by the link or the code that the terminal shows")),
        }
    }

    /// The answer to a code.
    fn enter(&self, body: &[u8], peer: IpAddr) -> Answer {
        let Some(network) = &self.network else { return refusal(404, NO_FILE) };
        let mut door = network.door();
        if !door.tries.may(peer, TRIES, Instant::now()) {
            return refusal(429, "too many tries; wait a minute");
        }
        let code = str::from_utf8(body).ok().and_then(|text| text.strip_prefix("code="));
        let entry = code.map_or(Entry::Wrong, |code| door.gate.by_code(code));
        drop(door);
        match entry {
            Entry::In(cookie) => self.welcome(&cookie, peer),
            Entry::Wrong => doorway("This is not the code that the terminal shows now."),
            Entry::Renewed => {
                self.invite();
                doorway("This is not the code, and the code is another one now: look at the terminal.")
            }
        }
    }

    /// A browser is in: it keeps a cookie and goes to the page.
    fn welcome(&self, cookie: &str, peer: IpAddr) -> Answer {
        crate::say::line(&format!("A browser at {peer} is in."));
        self.invite();
        let open = self.opened.as_deref().and_then(Path::file_name);
        let to =
            open.map_or("/".into(), |name| format!("/?open=opened%2F{}", escaped(&name.to_string_lossy())));
        let head = format!(
            "HTTP/1.1 303 In\r\nLocation: {to}\r\nSet-Cookie: {COOKIE}={cookie}; Path=/; Secure; HttpOnly; SameSite=Lax\r\n\
             Content-Length: 0\r\nCache-Control: no-store\r\nContent-Security-Policy: default-src 'none'\r\n{ALWAYS}\r\n"
        );
        Answer { status: 303, head, body: Cow::default() }
    }

    /// The file that was opened, if it has that name.
    fn is_opened(&self, name: &str) -> Option<&Path> {
        self.opened.as_deref().filter(|o| o.file_name().is_some_and(|n| n == name))
    }

    /// Writes the project that was opened anew: whole or not at all, and only over the version that the browser knows.
    fn save(&self, asked: &Asked, body: &[u8]) -> Answer {
        let Target::Opened(name) = &asked.target else { return refusal(404, NO_FILE) };
        let (Some(network), Some(path)) = (&self.network, self.is_opened(name).filter(|p| is_project(p)))
        else {
            return refusal(404, "there is no project that is written here");
        };
        if let Err(e) = read_project(body) {
            return refusal(422, &e.to_string());
        }
        let _one = network.writing.lock().unwrap_or_else(PoisonError::into_inner);
        let now = std::fs::read(path).map_or(String::new(), |bytes| version(&bytes));
        if asked.known.as_ref() != Some(&now) {
            let mut answer = refusal(412, "the file was changed by another program since it was opened here");
            // A page that was closed while it wrote knows its own work by this.
            answer.head = answer.head.replace("Cache-Control:", &format!("ETag: {now}\r\nCache-Control:"));
            return answer;
        }
        let folder = path.parent().unwrap_or(Path::new("."));
        let written = Draft::create(folder).and_then(|(draft, mut file)| {
            file.write_all(body)?;
            file.sync()?;
            drop(file);
            put_all(&[Move { draft, place: path.to_path_buf() }]).map_err(|refused| refused.error)
        });
        match written {
            Ok(()) => {
                let head = format!(
                    "HTTP/1.1 204 Saved\r\nETag: {}\r\nCache-Control: no-store\r\n{ALWAYS}\r\n",
                    version(body)
                );
                Answer { status: 204, head, body: Cow::default() }
            }
            Err(e) => refusal(507, &format!("the file cannot be written: {e}")),
        }
    }

    fn file(&self, asked: &Asked) -> Option<Answer> {
        match &asked.target {
            Target::Door => Some(doorway("")),
            Target::Opened(name) => {
                let path = self.is_opened(name)?;
                let bytes = std::fs::read(path).ok()?;
                let mut answer = given("application/octet-stream", false, Cow::default());
                // Only a version that is known can be replaced.
                let version = (self.network.is_some() && is_project(path)).then(|| version(&bytes));
                let more = version.map_or(String::new(), |v| format!("ETag: {v}\r\n"));
                answer.head = answer
                    .head
                    .replace("Content-Length: 0\r\n", &format!("Content-Length: {}\r\n{more}", bytes.len()));
                Some(Answer { body: bytes.into(), ..answer })
            }
            Target::File(path) => {
                let extension = Path::new(path).extension()?.to_str()?;
                let kind = TYPES.iter().find(|t| t.0 == extension)?.1;
                // Built files bear their content in their name.
                let forever = path.starts_with("assets/");
                let packed = self.bytes(&format!("{path}{PACKED}"));
                let Some(packed) = packed else { return Some(given(kind, forever, self.bytes(path)?)) };
                if asked.unpacks {
                    let mut answer = given(kind, forever, packed);
                    answer.head =
                        answer.head.replacen("Cache-Control:", "Content-Encoding: br\r\nCache-Control:", 1);
                    return Some(answer);
                }
                let body = self.bytes(path).or_else(|| unpacked(&packed).map(Cow::Owned));
                Some(given(kind, forever, body?))
            }
        }
    }

    /// A file of the page; nothing outside its folder, whatever links lie in it.
    fn bytes(&self, path: &str) -> Option<Cow<'static, [u8]>> {
        match &self.page {
            Page::Inside(files) => files.iter().find(|f| f.0 == path).map(|f| Cow::Borrowed(f.1)),
            Page::Folder(root) => {
                let file = root.join(path).canonicalize().ok()?;
                let inside = file.starts_with(root) && file.extension() == Path::new(path).extension();
                (inside && file.is_file()).then(|| std::fs::read(file).ok())?.map(Cow::Owned)
            }
        }
    }
}

/// Ends the name of a file of the page that Brotli packed.
const PACKED: &str = ".br";

fn unpacked(mut packed: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    brotli_decompressor::BrotliDecompress(&mut packed, &mut bytes).ok()?;
    Some(bytes)
}

fn given(kind: &str, forever: bool, body: Cow<'static, [u8]>) -> Answer {
    let cache = if forever { "public, max-age=31536000, immutable" } else { "no-cache" };
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: {cache}\r\n\
         Vary: Accept-Encoding\r\nContent-Security-Policy: {POLICY}\r\n{ALWAYS}\r\n",
        body.len()
    );
    Answer { status: 200, head, body }
}

fn is_project(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("burgeon"))
}

/// What a browser knows a file by: the SHA-256 of its bytes.
fn version(bytes: &[u8]) -> String {
    let digits: String = Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect();
    format!("\"{digits}\"")
}

/// The page at which a code is given.
fn doorway(why: &str) -> Answer {
    let body = format!(
        "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content=\"width=device-width\">\
         <title>Burgeon Studio</title><style>body{{font:1.3rem system-ui;margin:15vh auto;max-width:22rem;padding:1rem}}\
         input,button{{font:inherit;padding:.6em;width:100%;box-sizing:border-box;margin:.4em 0}}</style>\
         <h1>Burgeon Studio</h1><p role=alert>{why}</p><form method=post action=/enter>\
         <label>The code that the terminal shows · 终端显示的代码\
         <input name=code inputmode=numeric autocomplete=off autofocus maxlength=12></label>\
         <button>Come in · 进入</button></form></html>\n"
    );
    let head = format!(
        "HTTP/1.1 401 Code\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Content-Security-Policy: default-src 'none'; style-src 'unsafe-inline'; form-action 'self'; \
         frame-ancestors 'none'; base-uri 'none'\r\n{}\r\n",
        body.len(),
        // Without a referrer a form's origin would be "null".
        ALWAYS.replace("no-referrer", "same-origin")
    );
    Answer { status: 401, head, body: body.into_bytes().into() }
}

/// An answer that gives nothing but a reason.
pub(crate) fn refusal(status: u16, why: &str) -> Answer {
    let body = format!("{why}\n").into_bytes();
    let allow = if status == 405 { "Allow: GET, HEAD\r\n" } else { "" };
    let head = format!(
        "HTTP/1.1 {status} Refused\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {}\r\n{allow}\
         Cache-Control: no-store\r\nContent-Security-Policy: default-src 'none'\r\n{ALWAYS}\r\n",
        body.len()
    );
    Answer { status, head, body: body.into() }
}

/// Text as part of an address.
pub(crate) fn escaped(text: &str) -> String {
    use std::fmt::Write as _;
    text.bytes().fold(String::new(), |mut out, b| {
        if b.is_ascii_alphanumeric() || matches!(b, b'-' | b'_' | b'.' | b'~') {
            out.push(char::from(b));
        } else {
            let _ = write!(out, "%{b:02X}");
        }
        out
    })
}

#[cfg(test)]
mod tests {
    use super::super::request::unescaped;
    use super::*;
    use proptest::prelude::*;
    use std::fs;

    /// A site in a folder of its own, with a secret beside it and a link to the secret inside.
    fn site(test: &str) -> (Site, PathBuf) {
        let base = std::env::temp_dir().join(format!("burgeon-site-{test}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&base);
        let root = base.join("dist");
        fs::create_dir_all(root.join("assets")).unwrap();
        fs::write(root.join("index.html"), "<!doctype html>page").unwrap();
        fs::write(root.join("assets/a-1.js"), "code").unwrap();
        fs::write(root.join(".hidden.js"), "hidden").unwrap();
        fs::write(root.join("notes.txt"), "no type").unwrap();
        fs::write(base.join("secret.js"), "secret").unwrap();
        fs::write(base.join("my rose.svg"), "<svg/>").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(base.join("secret.js"), root.join("link.js")).unwrap();
        (Site::new(Page::Folder(root), 7734, Some(base.join("my rose.svg"))).unwrap(), base)
    }

    /// The answer to a head without a body.
    fn plain(site: &Site, head: &[u8]) -> Answer {
        let peer = IpAddr::from([127, 0, 0, 1]);
        match site.asked(head, peer) {
            Ok(asked) => site.answer(head, &asked, b"", peer),
            Err(answer) => answer,
        }
    }

    fn get(site: &Site, line: &str, headers: &str) -> Answer {
        plain(site, format!("{line}\r\nHost: 127.0.0.1:7734{headers}").as_bytes())
    }

    #[test]
    fn files_of_the_folder_are_served_with_strict_headers() {
        let (site, base) = site("serves");
        let page = get(&site, "GET / HTTP/1.1", "\r\nAccept: */*");
        assert_eq!((page.status, &*page.body), (200, &b"<!doctype html>page"[..]));
        for header in ["default-src 'none'", "nosniff", "frame-ancestors 'none'", "require-corp", "text/html"]
        {
            assert!(page.head.contains(header), "{header}: {}", page.head);
        }
        assert!(!page.head.contains("unsafe-inline") && !page.head.contains("'unsafe-eval'"));
        let script = get(&site, "GET /assets/a-1.js?x=1 HTTP/1.1", "\r\nOrigin: http://127.0.0.1:7734");
        assert!(
            script.status == 200
                && script.head.contains("immutable")
                && script.head.contains("text/javascript")
        );
        let head = get(&site, "HEAD / HTTP/1.1", "");
        assert!(head.status == 200 && head.body.is_empty() && head.head.contains("Content-Length: 19"));
        for (line, headers, status) in [
            ("HEAD /none.js HTTP/1.1", "", 404),
            ("HEAD / HTTP/1.1", "\r\nOrigin: http://evil.example", 403),
            ("HEAD / HTTP/1.1", "\r\nContent-Length: 5", 413),
            ("HEAD / HTTP/2.0", "", 505),
        ] {
            let answer = get(&site, line, headers);
            assert!(answer.status == status && answer.body.is_empty(), "{line}{headers}: {answer:?}");
        }
        let opened = get(&site, "GET /opened/my%20rose.svg HTTP/1.1", "");
        assert!(opened.status == 200 && opened.head.contains("application/octet-stream"), "{}", opened.head);
        fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn the_page_inside_the_program_is_served_as_a_folder_is() {
        let (folder, base) = site("inside");
        let files: Files =
            &[("assets/a-1.js", b"code"), ("index.html", b"<!doctype html>page"), ("notes.txt", b"")];
        let inside = Site::new(Page::Inside(files), 7734, Some(base.join("my rose.svg"))).unwrap();
        for line in [
            "GET / HTTP/1.1",
            "HEAD / HTTP/1.1",
            "GET /index.html HTTP/1.1",
            "GET /assets/a-1.js?x=1 HTTP/1.1",
            "GET /opened/my%20rose.svg HTTP/1.1",
            "GET /notes.txt HTTP/1.1",
            "GET /assets HTTP/1.1",
            "GET /assets/ HTTP/1.1",
            "GET /a-1.js HTTP/1.1",
            "GET /../secret.js HTTP/1.1",
            "POST / HTTP/1.1",
        ] {
            assert_eq!(get(&inside, line, ""), get(&folder, line, ""), "{line}");
        }
        assert_eq!(get(&inside, "GET / HTTP/1.1", "\r\nOrigin: http://evil.example").status, 403);
        assert_eq!(plain(&inside, b"GET / HTTP/1.1\r\nHost: evil.example").status, 421);
        fs::remove_dir_all(base).unwrap();
    }

    /// `leaf ` eight times, packed.
    const LEAVES: &[u8] =
        &[27, 39, 0, 248, 141, 148, 110, 222, 180, 4, 41, 99, 171, 48, 179, 104, 39, 10, 232, 9];

    #[test]
    fn packed_files_are_sent_packed_to_those_who_can_unpack() {
        let (folder, base) = site("packed");
        fs::write(base.join("dist/assets/b-1.js.br"), LEAVES).unwrap();
        let files: Files = &[("assets/b-1.js.br", LEAVES)];
        let inside = Site::new(Page::Inside(files), 7734, None).unwrap();
        let plain = "leaf ".repeat(8);
        for site in [&folder, &inside] {
            for (takes, packed) in [
                ("", false),
                ("\r\nAccept-Encoding: gzip, deflate", false),
                ("\r\nAccept-Encoding: gzip, br;q=0", false),
                ("\r\nAccept-Encoding: brx, *", false),
                ("\r\nAccept-Encoding: gzip, deflate, br, zstd", true),
                ("\r\naccept-encoding: gzip\r\naccept-encoding: BR ; q=0.5", true),
            ] {
                let answer = get(site, "GET /assets/b-1.js HTTP/1.1", takes);
                let body = if packed { LEAVES } else { plain.as_bytes() };
                assert_eq!((answer.status, &*answer.body), (200, body), "{takes}");
                assert_eq!(answer.head.contains("Content-Encoding: br\r\n"), packed, "{takes}");
                assert!(answer.head.contains(&format!("Content-Length: {}\r\n", body.len())), "{takes}");
                assert!(
                    answer.head.contains("Vary: Accept-Encoding") && answer.head.contains("text/javascript")
                );
            }
            assert_eq!(get(site, "GET /assets/b-1.js.br HTTP/1.1", "").status, 404, "no type of its own");
        }
        let broken = Site::new(Page::Inside(&[("a.js.br", b"no Brotli")]), 7734, None).unwrap();
        assert_eq!(get(&broken, "GET /a.js HTTP/1.1", "").status, 404);
        fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn everything_else_is_refused() {
        let (site, base) = site("refuses");
        for (line, headers, status) in [
            ("GET /../secret.js HTTP/1.1", "", 404),
            ("GET /%2e%2e/secret.js HTTP/1.1", "", 404),
            ("GET /..%2fsecret.js HTTP/1.1", "", 404),
            ("GET /assets/..\\..\\secret.js HTTP/1.1", "", 404),
            ("GET //secret.js HTTP/1.1", "", 404),
            ("GET /link.js HTTP/1.1", "", 404),
            ("GET /.hidden.js HTTP/1.1", "", 404),
            ("GET /notes.txt HTTP/1.1", "", 404),
            ("GET /assets HTTP/1.1", "", 404),
            ("GET /opened/secret.js HTTP/1.1", "", 404),
            ("GET /opened/../secret.js HTTP/1.1", "", 404),
            ("GET /a%00.js HTTP/1.1", "", 404),
            ("GET /%zz HTTP/1.1", "", 404),
            ("GET http://127.0.0.1:7734/ HTTP/1.1", "", 404),
            ("POST / HTTP/1.1", "", 405),
            ("PUT /index.html HTTP/1.1", "\r\nContent-Length: 5", 413),
            ("POST / HTTP/1.1", "\r\nTransfer-Encoding: chunked", 413),
            ("OPTIONS * HTTP/1.1", "", 405),
            ("GET / HTTP/1.1", "\r\nOrigin: http://evil.example", 403),
            ("GET / HTTP/1.1", "\r\nOrigin: null", 403),
            ("GET /assets/a-1.js HTTP/1.1", "\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors", 403),
            ("GET / HTTP/1.1", "\r\nHost: 127.0.0.1:7734", 400),
            ("GET / HTTP/2.0", "", 505),
            ("GET /", "", 400),
            ("GET / HTTP/1.1 x", "", 400),
            ("GET / HTTP/1.1", "\r\nbroken", 400),
        ] {
            let answer = get(&site, line, headers);
            assert_eq!(answer.status, status, "{line}{headers}");
            assert!(!answer.body.windows(6).any(|w| w == b"secret"), "{line}");
            assert!(answer.head.contains("nosniff") && answer.head.ends_with("\r\n\r\n"));
        }
        for host in
            ["evil.example", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:7734.evil.example", "[::1]:7734", ""]
        {
            let answer = plain(&site, format!("GET / HTTP/1.1\r\nHost: {host}").as_bytes());
            assert_eq!(answer.status, 421, "{host}");
        }
        assert_eq!(plain(&site, b"GET / HTTP/1.1").status, 421);
        assert_eq!(plain(&site, b"\xff\xfe").status, 400);
        // A link from elsewhere may bring a person here.
        let link = get(&site, "GET / HTTP/1.1", "\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate");
        assert_eq!(link.status, 200);
        fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn names_survive_the_address() {
        for name in ["my rose.svg", "玫瑰.burgeon", "100%.json", "a+b&c=d#e?f.svg"] {
            assert_eq!(unescaped(&escaped(name)).as_deref(), Some(name));
        }
    }

    proptest! {
        #[test]
        fn no_request_gets_out_of_the_folder_or_panics(
            target in "(/|\\.\\.|\\.|%2e|%2f|%5c|\\\\|secret|\\.js|assets|link|opened|[a-z%?#])*",
            junk in proptest::collection::vec(any::<u8>(), 0..60),
        ) {
            let (site, base) = site("fuzz");
            let mut head = format!("GET {target} HTTP/1.1\r\nHost: 127.0.0.1:7734").into_bytes();
            let answer = plain(&site, &head);
            prop_assert!(!answer.body.windows(6).any(|w| w == b"secret"));
            head.extend(&junk);
            let answer = plain(&site, &head);
            prop_assert!(!answer.body.windows(6).any(|w| w == b"secret"));
            plain(&site, &junk);
            let _ = fs::remove_dir_all(base);
        }
    }
}
