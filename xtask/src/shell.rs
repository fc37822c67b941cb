//! Running other programs and finding the repository.

#![expect(clippy::missing_errors_doc, reason = "each fails with a message for the person at the terminal")]

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Success, or a message for the person at the terminal.
pub type Outcome<T = ()> = Result<T, String>;

/// Prints a line for the person at the terminal.
#[expect(clippy::print_stdout, reason = "this is a program for the terminal")]
pub fn say(text: &str) {
    println!("{text}");
}

/// Returns the folder of the workspace.
pub fn repository() -> PathBuf {
    // xtask lies directly below the root.
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or_else(|| Path::new(".")).to_path_buf()
}

/// Returns the folder in which cargo builds.
pub fn target_dir() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| repository().join("target"), PathBuf::from)
}

/// Returns the command line in the folder of a build profile.
pub fn burgeon(profile: &str) -> PathBuf {
    target_dir().join(profile).join(format!("burgeon{}", std::env::consts::EXE_SUFFIX))
}

/// Returns an example that the tests of the workspace have built.
pub fn example(name: &str) -> PathBuf {
    target_dir().join("debug/examples").join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

/// Ensures that there is a development build of the command line. The tests of the workspace leave one, if they have
/// just run. Named as a program and not as a package, it uses what the tests have compiled.
pub fn debug_burgeon(tested: bool) -> Outcome {
    if tested && burgeon("debug").exists() {
        Ok(())
    } else {
        cargo(&["build", "--workspace", "--bin", "burgeon"])
    }
}

/// Builds the command line quickly, rather than to be fast, and returns its path.
pub fn quick_burgeon() -> Outcome<PathBuf> {
    cargo(&["build", "--profile", "quick", "--package", "burgeon-cli"])?;
    Ok(burgeon("quick"))
}

/// Builds the command line for release and returns its path.
pub fn built_burgeon() -> Outcome<PathBuf> {
    cargo(&["build", "--release", "--package", "burgeon-cli"])?;
    Ok(burgeon("release"))
}

/// Runs two things in parallel: one that mostly waits and one that computes. Both run to their end, whatever happens to
/// the other.
pub fn in_parallel<T: Send>(
    one: impl FnOnce() -> Outcome<T>,
    other: impl FnOnce() -> Outcome<T> + Send,
) -> Outcome<[T; 2]> {
    std::thread::scope(|scope| {
        let other = scope.spawn(other);
        let one = one();
        let other = other.join().map_err(|_panic| "a step beside another one panicked")?;
        match (one, other) {
            (Ok(one), Ok(other)) => Ok([one, other]),
            (Err(one), Err(other)) => Err(format!("{one}\n{other}")),
            (Err(e), _) | (_, Err(e)) => Err(e),
        }
    })
}

/// Returns the folder of tools that several checkouts share.
pub fn cache_dir() -> PathBuf {
    let base = std::env::var_os("XDG_CACHE_HOME")
        .map(PathBuf::from)
        .or_else(|| std::env::var_os("HOME").map(|h| PathBuf::from(h).join(".cache")))
        .unwrap_or_else(target_dir);
    base.join("burgeon")
}

/// Returns a command in the repository, with its program and arguments.
pub fn prepare(program: impl AsRef<OsStr>, args: &[&str]) -> Command {
    let mut c = Command::new(program);
    c.args(args).current_dir(repository());
    c
}

/// Runs a prepared command to its end; its output goes to the terminal.
pub fn finish(mut command: Command) -> Outcome {
    let what = describe(&command);
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{what}` failed ({status})")),
        Err(e) => Err(format!("`{what}` could not be started: {e}")),
    }
}

/// Runs a prepared command and returns what it printed.
pub fn output(mut command: Command) -> Outcome<String> {
    let what = describe(&command);
    let out = command.output().map_err(|e| format!("`{what}` could not be started: {e}"))?;
    if out.status.success() {
        Ok(String::from_utf8_lossy(&out.stdout).into_owned())
    } else {
        Err(format!("`{what}` failed ({}): {}", out.status, String::from_utf8_lossy(&out.stderr).trim()))
    }
}

/// Runs a program in the repository.
pub fn command(program: impl AsRef<OsStr>, args: &[&str]) -> Outcome {
    finish(prepare(program, args))
}

/// Runs the cargo that runs this program.
pub fn cargo(args: &[&str]) -> Outcome {
    say(&format!("$ cargo {}", args.join(" ")));
    command(cargo_path(), args)
}

/// Returns the cargo that runs this program.
pub fn cargo_path() -> PathBuf {
    std::env::var_os("CARGO").map_or_else(|| PathBuf::from("cargo"), PathBuf::from)
}

fn describe(c: &Command) -> String {
    let words = std::iter::once(c.get_program()).chain(c.get_args());
    words.map(|w| w.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

/// Returns a program of the registry, of one version: built into the cache if it is not there. `extra`: further
/// arguments of `cargo install`; `optimise`: the level, which trades compile time against run time.
pub fn installed(
    (package, program): (&str, &str),
    version: &str,
    extra: &[&str],
    optimise: &str,
) -> Outcome<PathBuf> {
    let root = cache_dir().join(format!("{program}-{version}"));
    let path = root.join("bin").join(format!("{program}{}", std::env::consts::EXE_SUFFIX));
    if path.exists() {
        return Ok(path);
    }
    say(&format!("$ cargo install {package} --version ={version} (once)"));
    let exact = format!("={version}");
    // No --locked: the lock file inside a crate may name versions that a registry does not serve.
    let mut c = prepare(cargo_path(), &["install", "--quiet", package, "--version", &exact]);
    c.args(extra).arg("--root").arg(&root);
    c.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", optimise).env("CARGO_PROFILE_RELEASE_LTO", "off");
    finish(c)?;
    Ok(path)
}
