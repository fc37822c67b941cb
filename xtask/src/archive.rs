//! One file to download: the command with the Studio in it, its manual pages and completions.

use std::path::Path;

use crate::notices::{self, NOTICES};
use crate::toolchain::shown;
use crate::{studio, web};
use xtask::shell::{Outcome, built_burgeon, command, finish, output, prepare, repository, say, target_dir};

/// Shells for which packages have completions, and the names of their files.
const SHELLS: [(&str, &str); 3] = [("bash", "burgeon.bash"), ("zsh", "_burgeon"), ("fish", "burgeon.fish")];

/// Files of the archive that are copied from the repository: their path, and their name there.
const FILES: [(&str, &str); 5] = [
    ("LICENSE-APACHE", "LICENSE-APACHE"),
    ("LICENSE-MIT", "LICENSE-MIT"),
    ("CHANGELOG.md", "CHANGELOG.md"),
    ("apps/cli/archive/README.md", README),
    ("fixtures/sketches/sample.svg", "sample.svg"),
];
const README: &str = "README.md";

/// Builds `target/archives/burgeon-VERSION-SYSTEM.tar.gz`, as `cargo binstall` expects it. Unpacks it and follows its
/// README.
pub(crate) fn run() -> Outcome {
    // The build script of the command includes the built page.
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
    for (from, name) in FILES {
        std::fs::copy(repository().join(from), folder.join(name)).map_err(failed)?;
    }
    notices::write("burgeon-cli", true, &folder.join(NOTICES))?;
    for (shell, file) in SHELLS {
        let script = output(prepare(&burgeon, &["completions", shell]))?;
        std::fs::write(folder.join("completions").join(file), script).map_err(failed)?;
    }
    command(&burgeon, &["man", &folder.join("man").to_string_lossy()])?;
    let archive = format!("{name}.tar.gz");
    let mut tar = prepare("tar", &["-czf", &archive, &name]);
    tar.current_dir(&out);
    finish(tar)?;
    follow_readme(&out, &archive, &name)?;
    say(&format!("{}: the command with the Studio in it", shown(&out.join(archive))));
    Ok(())
}

/// Unpacks the archive into a folder of its own and runs the lines of its README that make something, as a newcomer
/// would.
fn follow_readme(out: &Path, archive: &str, name: &str) -> Outcome {
    let away = out.join("unpacked");
    let _ = std::fs::remove_dir_all(&away);
    std::fs::create_dir_all(&away).map_err(|e| format!("{}: {e}", shown(&away)))?;
    let mut tar = prepare("tar", &["-xzf"]);
    tar.arg(out.join(archive)).arg("-C").arg(&away);
    finish(tar)?;
    let folder = away.join(name);
    let readme = folder.join(README);
    let text = std::fs::read_to_string(&readme).map_err(|e| format!("{}: {e}", shown(&readme)))?;
    let lines = makers(&text);
    if lines.is_empty() {
        return Err(format!("{}: has no line that makes something", shown(&readme)));
    }
    let program = folder.join(format!("burgeon{}", std::env::consts::EXE_SUFFIX));
    for line in lines {
        say(&format!("$ ./burgeon {line}"));
        let mut c = prepare(&program, &line.split(' ').collect::<Vec<_>>());
        c.current_dir(&folder);
        finish(c)?;
    }
    std::fs::remove_dir_all(&away).map_err(|e| format!("{}: {e}", shown(&away)))
}

/// Returns the text after `./burgeon` in each line of a README that ends by itself: the Studio runs until somebody ends
/// it.
fn makers(readme: &str) -> Vec<&str> {
    readme
        .lines()
        .filter_map(|line| line.strip_prefix("./burgeon "))
        .filter(|args| !args.starts_with("studio"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_a_readme_that_make_something_are_found() {
        let text = "Run `./burgeon`:\n```sh\n./burgeon grow oak -o oak.glb\n./burgeon studio a.svg\n```\n";
        assert_eq!(makers(text), ["grow oak -o oak.glb"]);
        assert!(!makers(include_str!("../../apps/cli/archive/README.md")).is_empty());
    }
}
