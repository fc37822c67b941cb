//! `burgeon studio`: serves the Studio to this machine's own browser, and to nobody else; with `--lan` to admitted
//! browsers of the network.

mod answer;
mod door;
mod gate;
mod http;
mod lan;
mod local;
mod request;
mod site;

use std::ffi::OsStr;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::args::StudioArgs;
use crate::failure::{Failure, Outcome};
use crate::files::{self, Kind};
use crate::{say, signals};
use gate::Gate;
use local::LocalKey;
use site::{Files, Network, Page, Site};

/// The page as it was when the program was built; empty if it had not been built then.
const PAGE: Files = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// Port that is tried first. The browser stores drawings by address: another port has another store.
const PORT: u16 = 7734;
/// Number of ports after it that are tried before any free one is used.
const NEXT: u16 = 8;

pub(crate) fn studio(args: &StudioArgs) -> Outcome {
    signals::end_at_once();
    let page = page(args.folder.as_deref(), PAGE)?;
    let opened = args.file.as_deref().map(checked).transpose()?;
    let address = args.lan.as_deref().map(lan::address).transpose()?;
    let listener = listen(address.unwrap_or(Ipv4Addr::LOCALHOST.into()), args.port)?;
    let port = listener.local_addr().map_err(|e| Failure::Bad(format!("no address: {e}")))?.port();
    let site = Site::new(page, port, opened.clone())?;
    if let Some(address) = address {
        return serve_network(&listener, address, site, opened.as_deref());
    }
    let url = format!("http://127.0.0.1:{port}{}", site.start());
    if opened.is_none() {
        say::line(&format!("The Studio is at {url}"));
        say::line("It is served to this machine only. Stop it with Ctrl-C.");
        if !args.no_open {
            open_or_say(OsStr::new(&url));
        }
        http::serve(&listener, &site, http::Limits::USUAL);
        return Ok(());
    }
    let local = LocalKey::new(lan::RANDOM);
    let link = format!("{url}&key={}", local.key());
    say::line(&format!("The Studio is at {link}"));
    say::line("It is served to this machine only, and the file only to browsers that have this whole link.");
    say::line("Stop it with Ctrl-C.");
    if !args.no_open {
        match local.lead_to(&link) {
            Ok(page) => open_or_say(page.as_os_str()),
            Err(_) => say::line(NO_BROWSER),
        }
    }
    http::serve(&listener, &site.locked_by(local), http::Limits::USUAL);
    Ok(())
}

/// Message where no browser is started.
const NO_BROWSER: &str = "No browser could be opened: open the address yourself.";

/// Opens an address or a page in a browser, or reports that there is none.
fn open_or_say(what: &OsStr) {
    if !open_browser(what) {
        say::line(NO_BROWSER);
    }
}

/// Serves the network until the process ends.
fn serve_network(listener: &TcpListener, address: IpAddr, site: Site, opened: Option<&Path>) -> Outcome {
    let own = listener.local_addr().map_err(|e| Failure::Bad(format!("no address: {e}")))?;
    let host = SocketAddr::new(address, own.port()).to_string();
    let identity = lan::identity(address)?;
    let fingerprint = identity.fingerprint.clone();
    let network = Network::new(identity, Gate::new(lan::RANDOM), lan::invite);
    let site = site.in_network(host.clone(), network);
    say::line(&format!("The Studio is at https://{host}/ for the browsers of your network that you let in."));
    say::line(
        "Browsers warn that they do not know the certificate: this program made it just now, for this address.",
    );
    say::line("Its SHA-256 fingerprint is");
    say::line(&format!("  {fingerprint}"));
    say::line(
        "Look at the certificate in the browser (the sign before the address): if its fingerprint is another one, somebody \
         is in between. If it is this one, choose \"Advanced\" and go on.",
    );
    match opened {
        Some(path) if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("burgeon")) => {
            say::line(&format!("What they change is written to {}.", path.display()));
        }
        _ => say::line(
            "What they do stays in their browser; open a .burgeon project to have it written to a file.",
        ),
    }
    say::line("Stop it with Ctrl-C.");
    site.invite();
    http::serve(listener, &site, http::Limits::NETWORK);
    Ok(())
}

/// Checks that the file to open is one that can be read; the page then reports faults inside.
fn checked(path: &Path) -> Outcome<PathBuf> {
    match files::open(path)?.1 {
        Kind::Drawing(_) | Kind::Model(_) | Kind::Project => {
            path.canonicalize().map_err(|e| Failure::io(path, "read", &e))
        }
        Kind::Structure(format) => Err(Failure::bad_file(
            path,
            format_args!(
                "is the structure of a plant ({}), which the Studio does not read; `burgeon shape` makes a model of it",
                format.name()
            ),
        )),
    }
}

fn listen(address: IpAddr, asked: Option<u16>) -> Outcome<TcpListener> {
    let bind = |port: u16| TcpListener::bind((address, port));
    if let Some(port) = asked {
        let advice = "choose another with --port";
        return bind(port).map_err(|e| Failure::Bad(format!("port {port} cannot be used ({e}); {advice}")));
    }
    let found = (PORT..=PORT + NEXT).chain([0]).find_map(|port| bind(port).ok());
    found.ok_or_else(|| Failure::Bad(format!("no port of {address} can be used")))
}

/// Returns the page that is served: of the given folder, else the one in the program.
fn page(folder: Option<&Path>, inside: Files) -> Outcome<Page> {
    if let Some(folder) = folder {
        return if folder.join("index.html").is_file() {
            Ok(Page::Folder(folder.into()))
        } else {
            Err(Failure::bad_file(
                folder,
                "holds no index.html; build the Studio with `cargo xtask build-web`",
            ))
        };
    }
    if inside.is_empty() {
        return Err(Failure::Bad(
            "this program was built without the Studio's page; in a checkout of Burgeon, run `cargo xtask build-web` and \
             build it again, or name a folder that holds the page with --folder"
                .into(),
        ));
    }
    Ok(Page::Inside(inside))
}

fn open_browser(what: &OsStr) -> bool {
    let screen =
        ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|v| std::env::var_os(v).is_some_and(|s| !s.is_empty()));
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(windows) {
        let mut c = Command::new("rundll32");
        c.arg("url.dll,FileProtocolHandler");
        c
    } else if screen {
        Command::new("xdg-open")
    } else {
        return false;
    };
    command.arg(what).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_page_it_is_said_how_to_build_one() {
        let why = |folder, inside| format!("{:?}", page(folder, inside).unwrap_err());
        assert!(why(None, &[]).contains("cargo xtask build-web"));
        let inside: Files = &[("index.html", b"page")];
        assert!(matches!(page(None, inside), Ok(Page::Inside(_))));
        // A given folder counts, even if it holds nothing.
        assert!(why(Some(Path::new("no such folder")), inside).contains("index.html"));
    }

    #[test]
    fn the_page_in_the_program_is_whole_or_not_there() {
        let has = |name: &str| PAGE.iter().any(|f| f.0 == name);
        assert_eq!(has("index.html"), !PAGE.is_empty(), "the page itself");
        let site = Site::new(Page::Inside(PAGE), 1, None).unwrap();
        let wasm = PAGE.iter().map(|f| f.0.trim_end_matches(".br")).find(|name| name.ends_with(".wasm"));
        let asks = |name: &str, more: &str| {
            let head = format!("GET /{name} HTTP/1.1\r\nHost: localhost:1{more}");
            let peer = Ipv4Addr::LOCALHOST.into();
            let asked = site.asked(head.as_bytes(), peer).unwrap();
            site.answer(head.as_bytes(), &asked, &[], peer)
        };
        if let Some(name) = wasm {
            assert!(asks(name, "").body.starts_with(b"\0asm"), "the core");
            let packed = asks(name, "\r\nAccept-Encoding: gzip, br");
            assert!(
                packed.head.contains("Content-Encoding: br") && packed.body.len() < 2_000_000,
                "{}",
                packed.head
            );
        }
        assert_eq!(wasm.is_some(), !PAGE.is_empty(), "the core");
    }
}
