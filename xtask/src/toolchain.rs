//! The wasm32 target: from rustup where it can be reached, else from Debian's packages.

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::shell::{Outcome, cache_dir, cargo_path, command, finish, output, prepare, repository, say};

/// The target triple of the browser.
pub(crate) const TARGET: &str = "wasm32-unknown-unknown";
/// The name under which Debian's compiler is linked into rustup.
const DEBIAN: &str = "burgeon-debian-wasm";

/// A cargo that builds for wasm32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WasmCargo {
    /// The toolchain in use has the target.
    Own,
    /// Debian's compiler with its own build of std.
    Debian,
}

impl WasmCargo {
    /// Returns `cargo ARGS` with this toolchain.
    pub(crate) fn command(self, args: &[&str]) -> Command {
        match self {
            Self::Own => prepare(cargo_path(), args),
            Self::Debian => {
                // `cargo` of rustup understands `+toolchain`; the one in $CARGO does not.
                let mut c = prepare("cargo", &[]);
                c.env_remove("RUSTUP_TOOLCHAIN").env_remove("RUSTC").env_remove("CARGO");
                c.arg(format!("+{DEBIAN}")).args(args);
                // Its artefacts must not be mixed with those of the other compiler.
                c.env("CARGO_TARGET_DIR", xtask::shell::target_dir().join("debian"));
                c
            }
        }
    }
}

/// Finds or installs a toolchain that builds for wasm32.
pub(crate) fn wasm_cargo() -> Outcome<WasmCargo> {
    let forced = std::env::var("BURGEON_WASM_TOOLCHAIN").unwrap_or_default();
    if forced != "debian" {
        if sysroot_has_target()? {
            return Ok(WasmCargo::Own);
        }
        say(&format!("$ rustup target add {TARGET}"));
        let mut add = prepare("timeout", &["180", "rustup", "target", "add", TARGET]);
        if cfg!(not(unix)) {
            add = prepare("rustup", &["target", "add", TARGET]);
        }
        match finish(add) {
            Ok(()) if sysroot_has_target()? => return Ok(WasmCargo::Own),
            Ok(()) => say("rustup added the target to another toolchain than the one in use"),
            Err(e) => say(&format!("rustup could not add the target: {e}")),
        }
    }
    debian()
}

fn sysroot_has_target() -> Outcome<bool> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let sysroot = output(prepare(rustc, &["--print", "sysroot"]))?;
    let lib = Path::new(sysroot.trim()).join("lib/rustlib").join(TARGET).join("lib");
    Ok(std::fs::read_dir(lib).is_ok_and(|mut d| d.next().is_some()))
}

/// Whether packages can be installed here without asking anybody.
pub(crate) fn is_root_on_debian() -> bool {
    let root = output(prepare("id", &["-u"])).is_ok_and(|id| id.trim() == "0");
    root && Path::new("/etc/debian_version").exists()
}

/// Sets up Debian's compiler for web browsers with the source of its std: std is built once for wasm32 and kept.
fn debian() -> Outcome<WasmCargo> {
    let home = cache_dir().join("debian-rust");
    let usr = home.join("usr");
    let std_lib = usr.join("lib/rustlib").join(TARGET).join("lib");
    if std::fs::read_dir(&std_lib).is_ok_and(|mut d| d.next().is_some()) {
        command("rustup", &["toolchain", "link", DEBIAN, &usr.to_string_lossy()])?;
        return Ok(WasmCargo::Debian);
    }
    if !is_root_on_debian() {
        return Err(format!(
            "the {TARGET} target is missing and rustup could not add it. Install it (`rustup target add {TARGET}`), \
             or run this as root on Debian, where it can be built from packages"
        ));
    }
    say("building the wasm32 target from Debian's packages (once; a few minutes)");
    command("apt-get", &["update", "-qq"])?;
    let std_package = dependency("libstd-rust-web-dev", "libstd-rust-web-")?;
    let llvm = dependency(&std_package, "libllvm")?;
    apt_install(&[&llvm, "gcc", "libc6-dev", "binutils"])?;
    unpack_debs(&home, &["rustc-web", "rust-web-src", "libstd-rust-web-dev", &std_package])?;
    complete_toolchain(&usr)?;
    command("rustup", &["toolchain", "link", DEBIAN, &usr.to_string_lossy()])?;
    build_std(&home, &std_lib)?;
    Ok(WasmCargo::Debian)
}

/// Returns the first dependency of a package whose name starts with `prefix`.
fn dependency(package: &str, prefix: &str) -> Outcome<String> {
    let listing = output(prepare("apt-cache", &["depends", package]))?;
    let names = listing.lines().filter_map(|l| l.trim().strip_prefix("Depends: "));
    let found = names.map(str::trim).find(|n| n.starts_with(prefix)).map(str::to_owned);
    found.ok_or_else(|| format!("Debian's {package} does not depend on {prefix}*: this release is too old"))
}

/// Installs Debian packages without their recommendations.
pub(crate) fn apt_install(packages: &[&str]) -> Outcome {
    say(&format!("$ apt-get install {}", packages.join(" ")));
    let mut args = vec!["install", "-y", "-qq", "--no-install-recommends"];
    args.extend(packages);
    let mut c = prepare("apt-get", &args);
    c.env("DEBIAN_FRONTEND", "noninteractive").stdout(std::process::Stdio::null());
    finish(c)
}

fn unpack_debs(home: &Path, packages: &[&str]) -> Outcome {
    let _ = std::fs::remove_dir_all(home);
    let downloads = home.join("deb");
    std::fs::create_dir_all(&downloads).map_err(|e| format!("{}: {e}", downloads.display()))?;
    let mut args = vec!["download", "-qq"];
    args.extend(packages);
    let mut c = prepare("apt-get", &args);
    c.current_dir(&downloads).stderr(std::process::Stdio::null());
    finish(c)?;
    for entry in read_dir(&downloads)? {
        command("dpkg", &["-x", &entry.to_string_lossy(), &home.to_string_lossy()])?;
    }
    std::fs::remove_dir_all(&downloads).map_err(|e| format!("{}: {e}", downloads.display()))
}

fn read_dir(dir: &Path) -> Outcome<Vec<PathBuf>> {
    let entries = std::fs::read_dir(dir).map_err(|e| format!("{}: {e}", dir.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(Result::ok).map(|e| e.path()).collect();
    paths.sort();
    Ok(paths)
}

/// Links Debian's compiler, which expects its libraries on the system's path and has neither cargo nor a linker for
/// wasm.
#[cfg(unix)]
fn complete_toolchain(usr: &Path) -> Outcome {
    let link = |from: &Path, to: &Path| -> Outcome {
        if let Some(dir) = to.parent() {
            std::fs::create_dir_all(dir).map_err(|e| format!("{}: {e}", dir.display()))?;
        }
        let _ = std::fs::remove_file(to);
        std::os::unix::fs::symlink(from, to).map_err(|e| format!("{}: {e}", to.display()))
    };
    let verbose = output(prepare("rustc", &["-vV"]))?;
    let host = verbose.lines().find_map(|l| l.strip_prefix("host: ")).unwrap_or_default().to_owned();
    let multiarch = output(prepare("gcc", &["-print-multiarch"]))?.trim().to_owned();
    for library in read_dir(&usr.join("lib").join(&multiarch))? {
        if library.extension().is_some_and(|e| e == "so") {
            link(&library, &usr.join("lib").join(library.file_name().unwrap_or_default()))?;
        }
    }
    let sysroot = PathBuf::from(output(prepare("rustc", &["--print", "sysroot"]))?.trim());
    link(&sysroot.join("bin/cargo"), &usr.join("bin/cargo"))?;
    let linker = usr.join("lib/rustlib").join(&host).join("bin/rust-lld");
    let own = sysroot.join("lib/rustlib").join(&host).join("bin/rust-lld");
    if own.exists() {
        link(&own, &linker)
    } else {
        apt_install(&["lld-19"])?;
        link(Path::new("/usr/bin/wasm-ld-19"), &linker)
    }
}

#[cfg(not(unix))]
fn complete_toolchain(_usr: &Path) -> Outcome {
    Err("Debian's packages are of no use here".into())
}

/// Builds std for wasm32 and puts it into the sysroot, so that plain builds find it.
fn build_std(home: &Path, std_lib: &Path) -> Outcome {
    let package = home.join("std");
    let source = package.join("src");
    std::fs::create_dir_all(&source).map_err(|e| format!("{}: {e}", source.display()))?;
    let write = |path: PathBuf, text: &str| {
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
    };
    write(source.join("lib.rs"), "")?;
    write(
        package.join("Cargo.toml"),
        "[package]\nname = \"std-for-wasm\"\nversion = \"0.0.0\"\nedition = \"2021\"\n[workspace]\n\
         [profile.release]\npanic = \"abort\"\n",
    )?;
    let mut c =
        WasmCargo::Debian.command(&["build", "--release", "--target", TARGET, "-Zbuild-std=std,panic_abort"]);
    c.current_dir(&package).env_remove("CARGO_TARGET_DIR");
    c.env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", "-Cembed-bitcode=yes");
    finish(c)?;
    std::fs::create_dir_all(std_lib).map_err(|e| format!("{}: {e}", std_lib.display()))?;
    for library in read_dir(&package.join("target").join(TARGET).join("release/deps"))? {
        let name = library.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.ends_with(".rlib") && !name.starts_with("libstd_for_wasm") {
            std::fs::copy(&library, std_lib.join(&name)).map_err(|e| format!("{name}: {e}"))?;
        }
    }
    std::fs::remove_dir_all(&package).map_err(|e| format!("{}: {e}", package.display()))
}

/// Returns the path of a file relative to the repository, for messages.
pub(crate) fn shown(path: &Path) -> String {
    path.strip_prefix(repository()).unwrap_or(path).display().to_string()
}
