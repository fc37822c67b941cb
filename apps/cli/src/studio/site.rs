//! What is answered to a request: the files of the page, and the file that the Studio was opened with.
//!
//! `request -> the file, if it is one of the page -> status, headers, bytes`

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::request::{NO_FILE, Target, asked};
use crate::failure::{Failure, Outcome};

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

/// A page that is served on one port of this machine.
#[derive(Debug)]
pub(crate) struct Site {
    page: Page,
    hosts: [String; 2],
    opened: Option<PathBuf>,
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
        Ok(Self { page, hosts: ["127.0.0.1", "localhost"].map(|h| format!("{h}:{port}")), opened })
    }

    /// The answer to a request whose head (up to and without the empty line) is `head`.
    pub(crate) fn answer(&self, head: &[u8]) -> Answer {
        let answer = match asked(head, &self.hosts) {
            Ok(target) => self.file(&target).unwrap_or_else(|| refusal(404, NO_FILE)),
            Err((status, why)) => refusal(status, why),
        };
        answer.to(head)
    }

    fn file(&self, target: &Target) -> Option<Answer> {
        match target {
            Target::Opened(name) => {
                let opened =
                    self.opened.as_ref().filter(|o| o.file_name().is_some_and(|n| n == name.as_str()))?;
                Some(given("application/octet-stream", false, std::fs::read(opened).ok()?.into()))
            }
            Target::File(path) => {
                let extension = Path::new(path).extension()?.to_str()?;
                let kind = TYPES.iter().find(|t| t.0 == extension)?.1;
                // Built files bear their content in their name.
                Some(given(kind, path.starts_with("assets/"), self.bytes(path)?))
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

fn given(kind: &str, forever: bool, body: Cow<'static, [u8]>) -> Answer {
    let cache = if forever { "public, max-age=31536000, immutable" } else { "no-cache" };
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: {cache}\r\n\
         Content-Security-Policy: {POLICY}\r\n{ALWAYS}\r\n",
        body.len()
    );
    Answer { status: 200, head, body }
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

    fn get(site: &Site, line: &str, headers: &str) -> Answer {
        site.answer(format!("{line}\r\nHost: 127.0.0.1:7734{headers}").as_bytes())
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
        assert_eq!(inside.answer(b"GET / HTTP/1.1\r\nHost: evil.example").status, 421);
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
            let answer = site.answer(format!("GET / HTTP/1.1\r\nHost: {host}").as_bytes());
            assert_eq!(answer.status, 421, "{host}");
        }
        assert_eq!(site.answer(b"GET / HTTP/1.1").status, 421);
        assert_eq!(site.answer(b"\xff\xfe").status, 400);
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
            let answer = site.answer(&head);
            prop_assert!(!answer.body.windows(6).any(|w| w == b"secret"));
            head.extend(&junk);
            let answer = site.answer(&head);
            prop_assert!(!answer.body.windows(6).any(|w| w == b"secret"));
            site.answer(&junk);
            let _ = fs::remove_dir_all(base);
        }
    }
}
