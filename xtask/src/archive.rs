//! One file to download: the command with the Studio in it, its manual pages and completions.

use crate::toolchain::shown;
use crate::{studio, web};
use xtask::shell::{Outcome, built_burgeon, command, finish, output, prepare, repository, say, target_dir};

/// The shells that packages have completions for, and what their files are called.
const SHELLS: [(&str, &str); 3] = [("bash", "burgeon.bash"), ("zsh", "_burgeon"), ("fish", "burgeon.fish")];

/// `target/archives/burgeon-VERSION-SYSTEM.tar.gz`, as `cargo binstall` expects it.
pub(crate) fn run() -> Outcome {
    // The build script of the command takes the built page in.
    studio::build(&web::setup()?, true)?;
    let burgeon = built_burgeon()?;
    let system = output(prepare("rustc", &["-vV"]))?;
    let system =
        system.lines().find_map(|l| l.strip_prefix("host: ")).ok_or("rustc names no host")?.to_owned();
    let name = format!("burgeon-{}-{system}", env!("CARGO_PKG_VERSION"));
    let out = target_dir().join("archives");
    let folder = out.join(&name);
    let _ = std::fs::remove_dir_all(&folder);
    let failed = |e: std::io::Error| format!("{}: {e}", shown(&folder));
    std::fs::create_dir_all(folder.join("completions")).map_err(failed)?;
    let program = format!("burgeon{}", std::env::consts::EXE_SUFFIX);
    std::fs::copy(&burgeon, folder.join(program)).map_err(failed)?;
    for file in ["LICENSE-APACHE", "LICENSE-MIT", "README.md", "CHANGELOG.md"] {
        std::fs::copy(repository().join(file), folder.join(file)).map_err(failed)?;
    }
    for (shell, file) in SHELLS {
        let script = output(prepare(&burgeon, &["completions", shell]))?;
        std::fs::write(folder.join("completions").join(file), script).map_err(failed)?;
    }
    command(&burgeon, &["man", &folder.join("man").to_string_lossy()])?;
    let archive = format!("{name}.tar.gz");
    let mut tar = prepare("tar", &["-czf", &archive, &name]);
    tar.current_dir(&out);
    finish(tar)?;
    say(&format!("{}: the command with the Studio in it", shown(&out.join(archive))));
    Ok(())
}
