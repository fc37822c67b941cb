//! Any bytes as a request to the Studio's server: refused, or from our own page and for a plain file of the folder.
#![no_main]

#[path = "../../apps/cli/src/studio/request.rs"]
mod request;

use request::{Addresses, Method, Target, asked};

libfuzzer_sys::fuzz_target!(|head: &[u8]| {
    let hosts = ["127.0.0.1:7734", "localhost:7734"].map(String::from).to_vec();
    let cookie = "burgeon-7734".into();
    let own = Addresses { scheme: "http", hosts: hosts.clone(), takes: 0, cookie };
    // The bytes unchanged, and as the rest of a request whose beginning is valid.
    let begun = [b"GET /index.html HTTP/1.1\r\nHost: 127.0.0.1:7734\r\n", head].concat();
    let target = [b"GET /", head, b" HTTP/1.1\r\nHost: 127.0.0.1:7734"].concat();
    for head in [head, &begun, &target] {
        let Ok(asked) = asked(head, &own) else { continue };
        assert!(asked.method == Method::Read && asked.length == 0, "something is taken in");
        let text = String::from_utf8(head.to_vec()).expect("text").to_ascii_lowercase();
        let given = |name: &str| -> Vec<String> {
            let of = text.split("\r\n").skip(1).filter_map(|l| l.strip_prefix(name)?.strip_prefix(':'));
            of.map(|v| v.trim().to_owned()).collect()
        };
        assert!(matches!(given("host").as_slice(), [own] if hosts.contains(own)), "a foreign host");
        let own = |origin: &String| hosts.iter().any(|h| *origin == format!("http://{h}"));
        assert!(given("origin").iter().all(own), "a foreign origin");
        assert!(given("transfer-encoding").is_empty(), "a body");
        if let Target::File(path) = asked.target {
            let plain = |p: &str| !p.is_empty() && !p.starts_with('.') && !p.contains(['\\', '%', ':']);
            assert!(path.split('/').all(plain), "out of the folder: {path}");
        }
    }
});
