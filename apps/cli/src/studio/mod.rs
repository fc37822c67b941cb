//! `burgeon studio`: serves the Studio to this machine's own browser, and to nobody else.

mod http;
mod request;
mod site;

use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::args::StudioArgs;
use crate::failure::{Failure, Outcome};
use crate::files::{self, Kind};
use crate::say;
use site::Site;

/// The port that is tried first. The browser keeps drawings by address: another port, another drawer.
const PORT: u16 = 7734;
/// How many ports after it are tried before any free one is taken.
const NEXT: u16 = 8;

pub(crate) fn studio(args: &StudioArgs) -> Outcome {
    let folder = args.folder.clone().map_or_else(find, Ok)?;
    if !folder.join("index.html").is_file() {
        return Err(Failure::at(
            &folder,
            "holds no index.html; build the Studio with `cargo xtask build-web`",
        ));
    }
    let opened = args.file.as_deref().map(checked).transpose()?;
    let listener = listen(args.port)?;
    let port = listener.local_addr().map_err(|e| Failure::Bad(format!("no address: {e}")))?.port();
    let site = Site::new(&folder, port, opened.clone())?;
    let mut url = format!("http://127.0.0.1:{port}/");
    if let Some(name) = opened.as_deref().and_then(Path::file_name) {
        url += &format!("?open=opened%2F{}", site::escaped(&name.to_string_lossy()));
    }
    say::line(&format!("The Studio is at {url}"));
    say::line("It is served to this machine only. Stop it with Ctrl-C.");
    if !args.no_open && !open_browser(&url) {
        say::line("No browser could be opened: open the address yourself.");
    }
    http::serve(&listener, &site, http::Limits::USUAL);
    Ok(())
}

/// The file to open must be one that is read; the page then says what is wrong inside.
fn checked(path: &Path) -> Outcome<PathBuf> {
    match files::open(path)?.1 {
        Kind::Drawing(_) | Kind::Model(_) | Kind::Project => {
            path.canonicalize().map_err(|e| Failure::io(path, "read", &e))
        }
    }
}

fn listen(asked: Option<u16>) -> Outcome<TcpListener> {
    let bind = |port: u16| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    if let Some(port) = asked {
        let advice = "choose another with --port";
        return bind(port).map_err(|e| Failure::Bad(format!("port {port} cannot be used ({e}); {advice}")));
    }
    let found = (PORT..=PORT + NEXT).chain([0]).find_map(|port| bind(port).ok());
    found.ok_or_else(|| Failure::Bad("no port of 127.0.0.1 can be used".into()))
}

/// The built Studio: beside the program, or in the repository that it was built in.
fn find() -> Outcome<PathBuf> {
    let program = std::env::current_exe().ok().and_then(|p| p.canonicalize().ok());
    let beside = program.as_deref().and_then(Path::parent).into_iter().flat_map(|folder| {
        let share = folder.join("../share/burgeon/studio");
        let built = folder.join("../../apps/studio-web/dist");
        [folder.join("studio"), share, built]
    });
    let found = beside.into_iter().find(|f| f.join("index.html").is_file());
    found.ok_or_else(|| {
        Failure::Bad(
            "the built Studio was not found beside this program; build it with `cargo xtask build-web` and name its \
             folder with --folder"
                .into(),
        )
    })
}

fn open_browser(url: &str) -> bool {
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
    command.arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().is_ok()
}
