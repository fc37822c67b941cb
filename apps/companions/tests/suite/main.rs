//! Files that a file names are read below its folder, and nothing else is.
#![expect(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::{Path, PathBuf};

use companions::{Named, NamedFault, NotAFile, Trust};

const NEVER: Trust = Trust { paths: false, allow: "--trust-paths" };
const ALWAYS: Trust = Trust { paths: true, allow: "--trust-paths" };

/// Makes a folder with `secret.txt`, and `model/a.gltf`, `model/sub/b.bin` in it.
fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(path.join("model/sub")).unwrap();
    fs::write(path.join("secret.txt"), "secret").unwrap();
    fs::write(path.join("model/a.gltf"), "{}").unwrap();
    fs::write(path.join("model/sub/b.bin"), "inside").unwrap();
    path
}

#[expect(clippy::panic_in_result_fn, reason = "every refusal is looked at")]
fn read(folder: &Path, name: &str, trust: Trust) -> Result<Vec<u8>, NamedFault> {
    let naming = folder.join("model/a.gltf");
    let named = Named { naming: &naming, name };
    let read = named.open(trust, 100).and_then(|(file, _)| named.read(file, 100));
    read.map_err(|e| {
        let line = e.to_string();
        assert!(line.contains("a.gltf names \"") && line.lines().count() == 1, "{line}");
        e.fault
    })
}

#[test]
fn what_lies_below_is_read_however_it_is_written() {
    let dir = folder("below");
    let whole = dir.join("model/sub/b.bin");
    for name in ["sub/b.bin", "sub\\b.bin", "./sub/./b.bin", "sub/../sub/b.bin", whole.to_str().unwrap()] {
        assert_eq!(read(&dir, name, NEVER).unwrap(), b"inside", "{name}");
    }
}

#[test]
fn a_file_without_a_folder_in_its_name_has_that_of_the_process() {
    let named = Named { naming: Path::new("Cargo.toml"), name: "src/lib.rs" };
    assert!(named.find(NEVER).unwrap().ends_with("src/lib.rs"));
    let named = Named { naming: Path::new("Cargo.toml"), name: "../cli/Cargo.toml" };
    assert!(matches!(named.find(NEVER).unwrap_err().fault, NamedFault::Outside { .. }));
}

#[test]
fn what_lies_outside_needs_trust_whether_it_is_there_or_not() {
    let dir = folder("outside");
    let whole = dir.join("secret.txt");
    let whole = whole.to_str().unwrap();
    for name in ["../secret.txt", "..\\secret.txt", "sub/../../secret.txt", "sub\\..\\..\\secret.txt", whole]
    {
        assert!(matches!(read(&dir, name, NEVER), Err(NamedFault::Outside { .. })), "{name}");
        assert_eq!(read(&dir, name, ALWAYS).unwrap(), b"secret", "{name}");
    }
    // A missing file is refused in the same way, so that nobody learns what exists.
    for name in ["../none", "/none/at/all", "\\\\none\\share\\x"] {
        assert!(matches!(read(&dir, name, NEVER), Err(NamedFault::Outside { .. })), "{name}");
        assert!(matches!(read(&dir, name, ALWAYS), Err(NamedFault::Missing)), "{name}");
    }
    for name in ["none", "sub/none", "a.gltf/x", "a\0b", &"x".repeat(5000)] {
        assert!(matches!(read(&dir, name, NEVER), Err(NamedFault::Missing)), "{name}");
    }
}

#[test]
fn folders_and_what_is_too_large_are_refused() {
    let dir = folder("large");
    fs::write(dir.join("model/large"), [0; 101]).unwrap();
    for trust in [NEVER, ALWAYS] {
        for name in ["sub", ".", ""] {
            let got = read(&dir, name, trust);
            assert!(matches!(got, Err(NamedFault::NotAFile(NotAFile::Folder))), "{name}: {got:?}");
        }
        assert!(matches!(read(&dir, "large", trust), Err(NamedFault::TooLarge { limit: 100 })));
    }
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::symlink;
    use std::os::unix::net::UnixListener;
    use std::process::Command;

    #[test]
    fn links_are_followed_below_the_folder_alone() {
        let dir = folder("links");
        let link = |to: &str, name: &str| symlink(to, dir.join("model").join(name)).unwrap();
        link("sub/b.bin", "inside.bin");
        link("../secret.txt", "out.bin");
        link("..", "up");
        link("out.bin", "twice.bin");
        link("none", "nowhere.bin");
        link("round.bin", "round.bin");
        assert_eq!(read(&dir, "inside.bin", NEVER).unwrap(), b"inside");
        for name in ["out.bin", "twice.bin", "up/secret.txt"] {
            assert!(matches!(read(&dir, name, NEVER), Err(NamedFault::Link { .. })), "{name}");
            assert_eq!(read(&dir, name, ALWAYS).unwrap(), b"secret", "{name}");
        }
        assert!(matches!(read(&dir, "nowhere.bin", NEVER), Err(NamedFault::Missing)));
        assert!(matches!(read(&dir, "round.bin", NEVER), Err(NamedFault::Io(_))));
        // The folder itself may be reached by a link.
        symlink("model", dir.join("other")).unwrap();
        let naming = dir.join("other/a.gltf");
        assert!(Named { naming: &naming, name: "sub/b.bin" }.find(NEVER).is_ok());
        let whole = dir.join("other/sub/b.bin");
        assert!(Named { naming: &naming, name: whole.to_str().unwrap() }.find(NEVER).is_ok());
    }

    #[test]
    fn pipes_sockets_and_devices_are_never_opened() {
        let dir = folder("pipes");
        let made = Command::new("mkfifo").arg(dir.join("model/pipe")).status().unwrap();
        assert!(made.success(), "mkfifo");
        // A path to a socket is at most about a hundred bytes long.
        let short = std::env::temp_dir().join(format!("companions-{}", std::process::id()));
        let _ = fs::remove_file(&short);
        let socket = UnixListener::bind(&short).unwrap();
        for trust in [NEVER, ALWAYS] {
            let got = read(&dir, "pipe", trust);
            assert!(matches!(got, Err(NamedFault::NotAFile(NotAFile::Pipe))), "{got:?}");
        }
        for (name, what) in [
            ("/dev/zero", NotAFile::Device),
            ("/dev/null", NotAFile::Device),
            (short.to_str().unwrap(), NotAFile::Socket),
        ] {
            assert!(matches!(read(&dir, name, NEVER), Err(NamedFault::Outside { .. })), "{name}");
            let got = read(&dir, name, ALWAYS);
            assert!(matches!(got, Err(NamedFault::NotAFile(is)) if is == what), "{name}: {got:?}");
        }
        drop(socket);
        fs::remove_file(short).unwrap();
    }

    #[test]
    fn a_file_that_says_it_is_empty_is_read_up_to_the_limit() {
        let dir = folder("endless");
        // Its metadata give 0 bytes, but reading gives more.
        let named = Named { naming: &dir.join("model/a.gltf"), name: "/proc/self/maps" };
        let Ok((file, _)) = named.open(ALWAYS, 10) else { return };
        assert!(matches!(named.read(file, 10).unwrap_err().fault, NamedFault::TooLarge { limit: 10 }));
    }
}
