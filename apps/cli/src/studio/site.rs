//! Answers to requests: the files of the page, and the opened file, which only browsers with the key get. On the
//! network, only admitted browsers get anything, and a project that was opened is written back.
//!
//! `request -> the file, if it is one of the page -> status, headers, bytes`

use std::borrow::Cow;
use std::io::Write as _;
use std::net::IpAddr;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use burgeon::document::{MAX_PROJECT_BYTES, read_project};
use sha2::{Digest as _, Sha256};

use super::answer::{ALWAYS, Answer};
use super::door::{Asks, doorway, locked, stopped};
use super::gate::{Entry, Gate, Invitation, Pace, Peers};
use super::lan::Identity;
use super::local::LocalKey;
use super::request::{Addresses, Asked, Method, NO_FILE, Target, asked};
use crate::draft::Draft;
use crate::failure::{Failure, Outcome};
use crate::placing::{Move, put_all};

/// Allows nothing but the page's own files; WebAssembly may be compiled, data of the page may be shown as pictures.
pub(crate) const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; \
    style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; manifest-src 'self'; base-uri 'none'; \
    form-action 'none'; frame-ancestors 'none'";

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

/// Place of the files of the page.
#[derive(Debug)]
pub(crate) enum Page {
    /// In this folder, read at each request.
    Folder(PathBuf),
    /// In the program.
    Inside(Files),
}

/// Rate of requests from strangers.
const STRANGERS: Pace = Pace { at_once: 60.0, per_second: 10.0 };
/// Rate of attempts to enter a code.
const TRIES: Pace = Pace { at_once: 5.0, per_second: 0.5 };

/// Message about a key that is not the one of the link.
const USED_UP: &str =
    "This link was used already, or is another one. Take the one that the terminal shows now.";

/// A page that is served on one port of this machine.
#[derive(Debug)]
pub(crate) struct Site {
    page: Page,
    own: Addresses,
    opened: Option<PathBuf>,
    /// Key that the opened file requires, where the page is served to this machine.
    local: Option<LocalKey>,
    network: Option<Network>,
}

/// Additional state of a server of the network.
#[derive(Debug)]
pub(crate) struct Network {
    pub(crate) identity: Identity,
    door: Mutex<Door>,
    /// Lock that allows one change of the file at a time.
    writing: Mutex<()>,
    /// Prints how the next browser can enter.
    invite: fn(&str, &Invitation),
}

#[derive(Debug)]
struct Door {
    gate: Gate,
    strangers: Peers,
    tries: Peers,
}

impl Door {
    /// Returns the request to a stranger without a link.
    fn asks(&self) -> Asks<'static> {
        if self.gate.invitation().code.is_some() { Asks::Code } else { Asks::Link }
    }
}

impl Network {
    pub(crate) fn new(identity: Identity, gate: Gate, invite: fn(&str, &Invitation)) -> Self {
        let door = Door { gate, strangers: Peers::default(), tries: Peers::default() };
        Self { identity, door: Mutex::new(door), writing: Mutex::default(), invite }
    }

    fn door(&self) -> MutexGuard<'_, Door> {
        self.door.lock().unwrap_or_else(PoisonError::into_inner)
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
        let own = Addresses { scheme: "http", hosts, takes: 0, cookie: format!("burgeon-{port}") };
        Ok(Self { page, own, opened, local: None, network: None })
    }

    /// Returns the same page, whose opened file is for browsers of this machine that have the key; without one nobody
    /// gets it.
    pub(crate) fn locked_by(self, local: LocalKey) -> Self {
        Self { local: Some(local), ..self }
    }

    /// Returns the same page for the network, under this host and no other.
    pub(crate) fn in_network(self, host: String, network: Network) -> Self {
        let own = Addresses { scheme: "https", hosts: vec![host], takes: MAX_PROJECT_BYTES, ..self.own };
        Self { own, network: Some(network), ..self }
    }

    pub(crate) fn network(&self) -> Option<&Network> {
        self.network.as_ref()
    }

    /// Prints how the next browser can enter.
    pub(crate) fn invite(&self) {
        if let Some(network) = &self.network {
            (network.invite)(&self.own.hosts[0], network.door().gate.invitation());
        }
    }

    /// Parses a request with this head, or returns the answer that refuses it before its body is read.
    pub(crate) fn asked(&self, head: &[u8], peer: IpAddr) -> Result<Asked, Answer> {
        let asked = asked(head, &self.own).map_err(|(status, why)| refusal(status, why).to(head))?;
        let instead = match &self.network {
            Some(network) => self.admit(network, &asked, peer),
            None => self.unlock(&asked),
        };
        instead.map_or(Ok(asked), |answer| Err(answer.to(head)))
    }

    /// Returns the answer to an allowed request whose body was read.
    pub(crate) fn answer(&self, head: &[u8], asked: &Asked, body: &[u8], peer: IpAddr) -> Answer {
        let answer = match asked.method {
            Method::Enter => self.enter(asked, body, peer),
            Method::Save => self.save(asked, body),
            Method::Read => self.file(asked).unwrap_or_else(|| refusal(404, NO_FILE)),
        };
        answer.to(head)
    }

    /// Returns an answer to a browser of this machine that requests the file without its key, or comes with the key;
    /// `None` for others, as the page itself is no secret.
    fn unlock(&self, asked: &Asked) -> Option<Answer> {
        let has = |given: Option<&str>| self.local.as_ref().filter(|l| given.is_some_and(|g| l.is_key(g)));
        if matches!(asked.target, Target::Opened(_)) {
            return has(asked.cookie.as_deref()).is_none().then(locked);
        }
        // If no file was opened, a key opens nothing.
        asked.key.as_deref().filter(|_| self.opened.is_some())?;
        let Some(local) = has(asked.key.as_deref()) else { return Some(locked()) };
        local.arrived();
        Some(self.admitted(&format!("{}; Path=/; HttpOnly; SameSite=Strict", local.key())))
    }

    /// Returns the answer to a stranger of the network; `None` for an admitted browser.
    fn admit(&self, network: &Network, asked: &Asked, peer: IpAddr) -> Option<Answer> {
        let mut door = network.door();
        if asked.cookie.as_deref().is_some_and(|c| door.gate.knows(c)) {
            return None;
        }
        if !door.strangers.may(peer, STRANGERS, Instant::now()) {
            return Some(refusal(429, "too many requests; wait a little"));
        }
        let at_door = match &asked.target {
            Target::Door => true,
            Target::File(path) => path == "index.html",
            Target::Opened(_) => false,
        };
        match asked.method {
            Method::Enter => None,
            Method::Read if at_door => {
                let key = asked.key.as_deref();
                let right = key.filter(|key| door.gate.is_key(key)).map(Asks::Button);
                let why = if key.is_some() && right.is_none() { USED_UP } else { "" };
                let asks = right.unwrap_or(door.asks());
                drop(door);
                Some(doorway(why, asks, &network.identity.fingerprint))
            }
            _ => Some(refusal(401, "come in by the link or the code that the terminal shows")),
        }
    }

    /// Returns the answer to a code, or to the key of a link.
    fn enter(&self, asked: &Asked, body: &[u8], peer: IpAddr) -> Answer {
        let Some(network) = &self.network else { return refusal(404, NO_FILE) };
        let mut door = network.door();
        // An admitted browser that presses the button of another link leaves that link to the next browser.
        if asked.cookie.as_deref().is_some_and(|c| door.gate.knows(c)) {
            drop(door);
            return self.redirected("");
        }
        if !door.tries.may(peer, TRIES, Instant::now()) {
            return refusal(429, "too many tries; wait a minute");
        }
        let given = str::from_utf8(body).ok().and_then(|text| text.split_once('='));
        let (entry, wrong) = match given {
            Some(("key", key)) => (door.gate.by_key(key), USED_UP),
            Some(("code", code)) => {
                (door.gate.by_code(code), "This is not the code that the terminal shows now.")
            }
            _ => (Entry::Wrong, "This is neither a code nor the key of a link."),
        };
        let asks = door.asks();
        drop(door);
        let again = |why: &str| doorway(why, asks, &network.identity.fingerprint);
        match entry {
            Entry::In(cookie) => self.welcome(&cookie, peer),
            Entry::Wrong => again(wrong),
            Entry::Stopped => again(""),
            Entry::Renewed => {
                self.invite();
                match asks {
                    Asks::Code | Asks::Button(_) => {
                        again("This is not the code, and the code is another one now: look at the terminal.")
                    }
                    Asks::Link => again(&stopped()),
                }
            }
        }
    }

    /// Admits a browser: it gets a cookie and is sent to the page.
    fn welcome(&self, cookie: &str, peer: IpAddr) -> Answer {
        crate::say::line(&format!("A browser at {peer} is in."));
        self.invite();
        self.admitted(&format!("{cookie}; Path=/; Secure; HttpOnly; SameSite=Lax"))
    }

    /// Returns the path and the query of the page with the opened file.
    pub(crate) fn start(&self) -> String {
        let open = self.opened.as_deref().and_then(Path::file_name);
        open.map_or("/".into(), |name| format!("/?open=opened%2F{}", escaped(&name.to_string_lossy())))
    }

    /// Gives a browser a cookie and sends it to the page.
    fn admitted(&self, cookie: &str) -> Answer {
        self.redirected(&format!("Set-Cookie: {}={cookie}\r\n", self.own.cookie))
    }

    /// Sends a browser to the page.
    fn redirected(&self, more: &str) -> Answer {
        let head = format!(
            "HTTP/1.1 303 In\r\nLocation: {}\r\n{more}Content-Length: 0\r\nCache-Control: no-store\r\n\
             Content-Security-Policy: default-src 'none'\r\n{ALWAYS}\r\n",
            self.start()
        );
        Answer { status: 303, head, body: Cow::default() }
    }

    /// Returns the opened file, if it has that name.
    fn is_opened(&self, name: &str) -> Option<&Path> {
        self.opened.as_deref().filter(|o| o.file_name().is_some_and(|n| n == name))
    }

    /// Rewrites the opened project: whole or not at all, and only over the version that the browser knows.
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
            // A page that was closed during the write recognises its own work by this.
            answer.head = answer.head.replace("Cache-Control:", &format!("ETag: {now}\r\nCache-Control:"));
            return answer;
        }
        match replace(path, body) {
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
            // A stranger has already got the door.
            Target::Door => Some(self.redirected("")),
            Target::Opened(name) => {
                let path = self.is_opened(name)?;
                let bytes = std::fs::read(path).ok()?;
                let mut answer = given("application/octet-stream", false, Cow::default());
                // Only a known version can be replaced.
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
                // The names of built files contain a digest of their content.
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

    /// Returns a file of the page; nothing outside its folder, whatever links lie in it.
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

/// Ending of the name of a file of the page that Brotli packed.
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

/// Returns the version by which a browser identifies a file: the SHA-256 of its bytes.
fn version(bytes: &[u8]) -> String {
    let digits: String = Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect();
    format!("\"{digits}\"")
}

/// Replaces a file by these bytes, whole or not at all, and keeps its permissions.
fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let rights = std::fs::metadata(path)?.permissions();
    if rights.readonly() {
        return Err(std::io::ErrorKind::PermissionDenied.into());
    }
    let (draft, mut file) = Draft::create(path.parent().unwrap_or(Path::new(".")))?;
    // Set before there is any content to read.
    file.file().set_permissions(rights)?;
    file.write_all(bytes)?;
    file.sync()?;
    drop(file);
    put_all(&[Move { draft, place: path.to_path_buf() }]).map_err(|refused| refused.error)
}

/// Returns an answer that contains only a reason.
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

/// Escapes text as part of an address.
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

    /// Makes a site in a folder of its own, with a secret next to it and a link to the secret inside.
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
        let site = Site::new(Page::Folder(root), 7734, Some(base.join("my rose.svg"))).unwrap();
        (site.locked_by(LocalKey::new(|bytes| bytes.fill(0xab))), base)
    }

    /// Returns the cookie of a browser that has come with the key.
    fn kept() -> String {
        format!("\r\nCookie: burgeon-80=1; burgeon-7734={}", "ab".repeat(16))
    }

    /// Returns the answer to a head without a body.
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
        let opened = get(&site, "GET /opened/my%20rose.svg HTTP/1.1", &kept());
        assert!(opened.status == 200 && opened.head.contains("application/octet-stream"), "{}", opened.head);
        fs::remove_dir_all(base).unwrap();
    }

    #[test]
    fn the_page_inside_the_program_is_served_as_a_folder_is() {
        let (folder, base) = site("inside");
        let files: Files =
            &[("assets/a-1.js", b"code"), ("index.html", b"<!doctype html>page"), ("notes.txt", b"")];
        let inside = Site::new(Page::Inside(files), 7734, Some(base.join("my rose.svg"))).unwrap();
        let inside = inside.locked_by(LocalKey::new(|bytes| bytes.fill(0xab)));
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
            assert_eq!(get(&inside, line, &kept()), get(&folder, line, &kept()), "{line}");
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
        let kept = kept();
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
            ("GET /opened/secret.js HTTP/1.1", &kept, 404),
            ("GET /opened/../secret.js HTTP/1.1", &kept, 404),
            ("GET /opened/secret.js HTTP/1.1", "", 401),
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
    fn the_file_that_was_opened_is_for_those_who_have_the_key() {
        let (site, base) = site("locked");
        let key = "ab".repeat(16);
        fs::write(base.join("my rose.svg"), "private").unwrap();
        let file = "GET /opened/my%20rose.svg HTTP/1.1";
        let wrong = "ac".repeat(16);
        for cookie in [
            String::new(),
            "\r\nCookie: burgeon-7734=".into(),
            format!("\r\nCookie: burgeon-7734={wrong}"),
            format!("\r\nCookie: burgeon={key}"),
            format!("\r\nCookie: burgeon-7735={key}"),
            format!("\r\nCookie: burgeon-7734={}", &key[1..]),
        ] {
            for line in [file, "HEAD /opened/my%20rose.svg HTTP/1.1", "GET /opened/another.svg HTTP/1.1"] {
                let answer = get(&site, line, &cookie);
                assert_eq!(answer.status, 401, "{line}{cookie}");
                assert!(!answer.body.windows(7).any(|w| w == b"private"), "{line}{cookie}");
            }
        }
        let told = get(&site, file, "");
        assert!(String::from_utf8_lossy(&told.body).contains("Copy the link from the terminal"));
        // A key in the address of the file itself is not enough: it would appear in the history of the browser.
        assert_eq!(get(&site, &format!("GET /opened/my%20rose.svg?key={key} HTTP/1.1"), "").status, 401);
        assert_eq!(get(&site, "GET / HTTP/1.1", "").status, 200, "the page is no secret");
        assert_eq!(get(&site, &format!("GET /?key={wrong} HTTP/1.1"), "").status, 401);
        // The link works as often as it is opened, as a browser may be closed and opened again.
        for line in ["HEAD", "GET", "GET"] {
            let link = format!("{line} /?open=opened%2Fmy%20rose.svg&key={key} HTTP/1.1");
            let entered = get(&site, &link, "\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate");
            assert_eq!(entered.status, 303);
            assert!(entered.head.contains("Location: /?open=opened%2Fmy%20rose.svg\r\n"), "{}", entered.head);
            let keeps = format!("Set-Cookie: burgeon-7734={key}; Path=/; HttpOnly; SameSite=Strict\r\n");
            assert!(entered.head.contains(&keeps), "{}", entered.head);
        }
        assert_eq!(&*get(&site, file, &kept()).body, b"private");
        // Nobody gets a file without a key, and a page without a file needs no key.
        let nobodys = Site::new(Page::Inside(&[]), 7734, Some(base.join("my rose.svg"))).unwrap();
        assert_eq!(get(&nobodys, file, &kept()).status, 401);
        assert_eq!(get(&nobodys, &format!("GET /?key={key} HTTP/1.1"), "").status, 401);
        let empty = Site::new(Page::Inside(&[("index.html", b"page")]), 7734, None).unwrap();
        assert_eq!(get(&empty, &format!("GET /?key={key} HTTP/1.1"), "").status, 200);
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
