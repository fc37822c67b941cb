//! Meaning of a request, and whether it is allowed: a pure function of its head, tested and fuzzed without a network.
//!
//! `bytes of the head, our own addresses -> the request | reason why it is refused`
//!
//! It uses nothing but the standard library: the fuzz target `request` includes this file unchanged.

/// Reason why a file is not given.
pub(crate) const NO_FILE: &str = "there is no such file";

/// Target of a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// A file below the folder: parts of letters, digits, `.`, `-` and `_` between single slashes, none with a dot first.
    File(String),
    /// The file with which the Studio was opened, by its name.
    Opened(String),
    /// The door at which a code or a key is given; only of a server of the network.
    Door,
}

/// Operation on the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// GET or HEAD.
    Read,
    /// POST, at the door: a code, or the key of a link.
    Enter,
    /// PUT, of the opened file.
    Save,
}

/// A request that is not refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Asked {
    pub(crate) method: Method,
    pub(crate) target: Target,
    /// Number of bytes that follow the head.
    pub(crate) length: usize,
    /// Cookie that the browser got when it entered.
    pub(crate) cookie: Option<String>,
    /// The key of a link.
    pub(crate) key: Option<String>,
    /// Version of the file that is to be replaced.
    pub(crate) known: Option<String>,
    /// Whether the browser accepts Brotli.
    pub(crate) unpacks: bool,
}

/// Addresses to which a server answers.
#[derive(Clone, Debug)]
pub(crate) struct Addresses {
    /// `http` of this machine alone, `https` of its network.
    pub(crate) scheme: &'static str,
    /// Our own hosts, with the port.
    pub(crate) hosts: Vec<String>,
    /// Most bytes that are accepted; 0 for a server that accepts none.
    pub(crate) takes: usize,
    /// Name of the cookie of an admitted browser: it contains the port, as browsers distinguish cookies by host only.
    pub(crate) cookie: String,
}

/// Longest code or key with its name at the door, bytes.
const DOOR_BYTES: usize = 64;

/// Parses a request with this head (up to and without the empty line).
///
/// # Errors
/// The status and the words of the refusal.
pub(crate) fn asked(head: &[u8], own: &Addresses) -> Result<Asked, (u16, &'static str)> {
    let text = str::from_utf8(head).ok().filter(|t| !t.contains('\0'));
    let mut lines = text.ok_or((400, "the request is no text"))?.split("\r\n");
    let mut words = lines.next().unwrap_or_default().split(' ');
    let (Some(method), Some(target), Some(version), None) =
        (words.next(), words.next(), words.next(), words.next())
    else {
        return Err((400, "the request line is broken"));
    };
    if !matches!(version, "HTTP/1.0" | "HTTP/1.1") {
        return Err((505, "only HTTP/1.1 is spoken here"));
    }
    let (mut host, mut origin, mut site, mut mode) = (None, None, None, None);
    let (mut length, mut cookies, mut known, mut unpacks) = (None, None, None, false);
    for line in lines {
        let (name, value) = line.split_once(':').ok_or((400, "a header is broken"))?;
        let value = value.trim();
        let slot = match name.to_ascii_lowercase().as_str() {
            "host" => &mut host,
            "origin" => &mut origin,
            "sec-fetch-site" => &mut site,
            "sec-fetch-mode" => &mut mode,
            "content-length" if own.takes == 0 && value != "0" => {
                return Err((413, "nothing is taken in here"));
            }
            "content-length" => &mut length,
            "cookie" => &mut cookies,
            "if-match" => &mut known,
            "accept-encoding" => {
                unpacks |= takes_brotli(value);
                continue;
            }
            "transfer-encoding" | "upgrade" => return Err((413, "nothing is taken in here")),
            _ => continue,
        };
        if slot.replace(value).is_some() {
            return Err((400, "a header is given twice"));
        }
    }
    // Another name for this address would let a foreign page send requests to us (DNS rebinding).
    let ours = |h: &str| own.hosts.iter().any(|own| own == h);
    if !host.is_some_and(ours) {
        return Err((421, "this is the Studio of another address"));
    }
    let own_origin =
        |o: &str| o.strip_prefix(own.scheme).and_then(|o| o.strip_prefix("://")).is_some_and(ours);
    let foreign = site.is_some_and(|s| matches!(s, "cross-site" | "same-site")) && mode != Some("navigate");
    if foreign || origin.is_some_and(|o| !own_origin(o)) {
        return Err((403, "another page may not ask here"));
    }
    let target_is = target_of(target, own.takes > 0);
    let (method, most) = match (method, &target_is) {
        ("GET" | "HEAD", _) => (Method::Read, 0),
        ("POST", Some(Target::Door)) => (Method::Enter, DOOR_BYTES),
        // A change must come from our own page, as its origin shows.
        ("PUT", Some(Target::Opened(_))) if own.takes > 0 && origin.is_some() => (Method::Save, own.takes),
        _ => return Err((405, "files are only read here")),
    };
    let length =
        length.map_or(Some(0), |l| l.parse::<usize>().ok().filter(|_| l.bytes().all(|b| b.is_ascii_digit())));
    let length = length.ok_or((400, "the length is no number"))?;
    if length > most {
        return Err((413, "more than is taken in here"));
    }
    let target_is = target_is.ok_or((404, NO_FILE))?;
    let pairs = cookies.unwrap_or_default().split(';').filter_map(|pair| pair.trim().split_once('='));
    let cookie = pairs.filter(|(name, _)| *name == own.cookie).map(|(_, value)| value.to_owned()).next();
    let query = target.split_once('?').map_or("", |(_, query)| query).split('#').next().unwrap_or_default();
    let key = query.split('&').find_map(|pair| pair.strip_prefix("key=")).map(str::to_owned);
    Ok(Asked { method, target: target_is, length, cookie, key, known: known.map(str::to_owned), unpacks })
}

/// Whether Brotli is among these encodings with a weight above 0 (RFC 9110, 12.5.3).
fn takes_brotli(encodings: &str) -> bool {
    encodings.split(',').any(|one| {
        let (name, weight) = one.split_once(';').unwrap_or((one, "q=1"));
        let weight = weight.trim().strip_prefix("q=").and_then(|q| q.parse::<f64>().ok());
        name.trim().eq_ignore_ascii_case("br") && weight.is_some_and(|q| q > 0.0)
    })
}

/// Parses a target.
fn target_of(target: &str, door: bool) -> Option<Target> {
    let path = target.split(['?', '#']).next()?.strip_prefix('/')?;
    let path = unescaped(path)?;
    if let Some(name) = path.strip_prefix("opened/") {
        return Some(Target::Opened(name.into()));
    }
    if door && path == "enter" {
        return Some(Target::Door);
    }
    let path = if path.is_empty() { "index.html" } else { &path };
    let plain = |part: &str| {
        !part.is_empty()
            && !part.starts_with('.')
            && part.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-' | b'_'))
    };
    path.split('/').all(plain).then(|| Target::File(path.into()))
}

/// Decodes percent escapes; `None` for broken ones, for text that is not UTF-8 and for control characters.
pub(crate) fn unescaped(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        if first == b'%' {
            let digit = |b: &u8| char::from(*b).to_digit(16).and_then(|d| u8::try_from(d).ok());
            bytes.push(digit(after.first()?)? * 16 + digit(after.get(1)?)?);
            rest = after.get(2..)?;
        } else {
            bytes.push(first);
            rest = after;
        }
    }
    String::from_utf8(bytes).ok().filter(|t| !t.chars().any(char::is_control))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn hosts() -> Addresses {
        let hosts = ["127.0.0.1:7734", "localhost:7734"].map(String::from).to_vec();
        Addresses { scheme: "http", hosts, takes: 0, cookie: "burgeon-7734".into() }
    }

    /// Checks properties of any accepted head, found by reading it in a different way.
    fn sound(head: &[u8]) {
        let Ok(Asked { target, method, length, .. }) = asked(head, &hosts()) else { return };
        assert!(method == Method::Read && length == 0 && target != Target::Door);
        let text = String::from_utf8(head.to_vec()).expect("text").to_lowercase();
        let given = |name: &str| -> Vec<String> {
            let of = text.split("\r\n").skip(1).filter_map(|l| l.strip_prefix(name)?.strip_prefix(':'));
            of.map(|v| v.trim().to_owned()).collect()
        };
        assert!(text.starts_with("get /") || text.starts_with("head /"), "{text}");
        assert!(matches!(given("host").as_slice(), [own] if hosts().hosts.contains(own)), "{text}");
        for origin in given("origin") {
            assert!(hosts().hosts.iter().any(|own| origin == format!("http://{own}")), "{text}");
        }
        assert!(given("transfer-encoding").is_empty() && given("content-length").iter().all(|l| l == "0"));
        if let Target::File(path) = target {
            assert!(
                !path.contains(['\\', '%', ':', '\0'])
                    && !path.split('/').any(|p| p.is_empty() || p.starts_with('.'))
            );
        }
    }

    /// Generates requests that are nearly right.
    fn nearly() -> impl Strategy<Value = Vec<u8>> {
        let method = prop_oneof![4 => Just("GET"), 1 => Just("HEAD"), 1 => Just("POST"), 1 => Just("get"), 1 => Just("")];
        let target = "(/|\\.\\.|\\.|%2e|%2f|%5c|\\\\|%00|\\.js|assets|opened|index|[a-z%?#])*";
        let host = prop_oneof![
            3 => Just("127.0.0.1:7734"), 1 => Just("localhost:7734"), 1 => Just("evil.example"),
            1 => Just("127.0.0.1:7734.evil.example"), 1 => Just("127.0.0.1"), 1 => Just(""),
        ];
        let origin = prop_oneof![
            3 => Just(""), 1 => Just("http://127.0.0.1:7734"), 1 => Just("http://evil.example"), 1 => Just("null"),
            1 => Just("https://127.0.0.1:7734"), 1 => Just("http://127.0.0.1:77340"),
        ];
        let more = prop_oneof![
            4 => Just(""), 1 => Just("\r\nHOST: evil.example"), 1 => Just("\r\nOrigin: http://evil.example"),
            1 => Just("\r\nSec-Fetch-Site: cross-site"), 1 => Just("\r\nContent-Length: 9"), 1 => Just("\nHost: x"),
        ];
        (method, target, host, origin, more, proptest::collection::vec(any::<u8>(), 0..4)).prop_map(
            |(method, target, host, origin, more, junk)| {
                let origin = if origin.is_empty() { String::new() } else { format!("\r\nOrigin: {origin}") };
                let head = format!("{method} /{target} HTTP/1.1\r\nHost: {host}{origin}{more}");
                [head.as_bytes(), &junk].concat()
            },
        )
    }

    proptest! {
        #[test]
        fn what_is_not_refused_comes_from_our_own_page_and_names_a_plain_file(head in nearly()) {
            sound(&head);
        }

        #[test]
        fn any_bytes_are_refused_or_sound(head in proptest::collection::vec(any::<u8>(), 0..200)) {
            sound(&head);
        }
    }

    /// Replays the kept inputs of the fuzz target, which `burgeon-workspace` cannot call.
    #[test]
    fn every_kept_request_is_refused_or_sound_as_its_name_says() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/kept/request");
        let mut count = 0;
        for entry in std::fs::read_dir(folder).expect("a folder of the repository") {
            let path = entry.expect("an entry").path();
            let head = std::fs::read(&path).expect("a file of the repository");
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            sound(&head);
            assert_eq!(asked(&head, &hosts()).is_err(), name.starts_with("bad-"), "{name}");
            count += 1;
        }
        assert!(count > 20, "{count} kept requests");
    }

    #[test]
    fn a_plain_request_is_understood() {
        let head =
            b"GET /assets/a-1.js?v=2 HTTP/1.1\r\nHost: localhost:7734\r\nOrigin: http://localhost:7734";
        sound(head);
        let plain = asked(head, &hosts()).map(|a| (a.method, a.target));
        assert_eq!(plain, Ok((Method::Read, Target::File("assets/a-1.js".into()))));
    }

    #[test]
    fn a_server_of_the_network_takes_codes_and_the_file_that_was_opened_and_no_more() {
        let hosts = vec!["192.0.2.7:7734".into()];
        let own = Addresses { scheme: "https", hosts, takes: 1000, cookie: "burgeon-7734".into() };
        let ask = |line: &str, headers: &str| {
            asked(format!("{line} HTTP/1.1\r\nHost: 192.0.2.7:7734{headers}").as_bytes(), &own)
        };
        let ours = "\r\nOrigin: https://192.0.2.7:7734";
        let link =
            ask("GET /?open=opened%2Fa.burgeon&key=abc", "\r\nCookie: burgeon-8080=no; burgeon-7734=xyz")
                .unwrap();
        assert_eq!((link.key.as_deref(), link.cookie.as_deref()), (Some("abc"), Some("xyz")));
        let door = ask("POST /enter", &format!("{ours}\r\nContent-Length: 13")).unwrap();
        assert_eq!((door.method, door.target, door.length), (Method::Enter, Target::Door, 13));
        let saved = format!("{ours}\r\nContent-Length: 1000\r\nIf-Match: \"1\"");
        let saved = ask("PUT /opened/a.burgeon", &saved).unwrap();
        assert_eq!((saved.method, saved.length, saved.known.as_deref()), (Method::Save, 1000, Some("\"1\"")));
        for (line, headers, status) in [
            ("PUT /opened/a.burgeon", "\r\nContent-Length: 5".to_owned(), 405),
            ("PUT /opened/a.burgeon", format!("{ours}\r\nContent-Length: 1001"), 413),
            ("PUT /opened/a.burgeon", format!("{ours}\r\nContent-Length: +5"), 400),
            ("PUT /opened/a.burgeon", format!("{ours}\r\nContent-Length: 5\r\nContent-Length: 6"), 400),
            ("PUT /index.html", format!("{ours}\r\nContent-Length: 5"), 405),
            ("POST /enter", format!("{ours}\r\nContent-Length: 65"), 413),
            ("POST /enter", "\r\nOrigin: https://evil.example\r\nContent-Length: 13".into(), 403),
            ("POST /enter", "\r\nOrigin: http://192.0.2.7:7734\r\nContent-Length: 13".into(), 403),
            ("GET /", "\r\nContent-Length: 5".into(), 413),
            ("POST /", ours.into(), 405),
        ] {
            assert_eq!(ask(line, &headers).map_err(|e| e.0), Err(status), "{line}{headers}");
        }
    }
}
