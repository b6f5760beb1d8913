//! The packages of `make dist`, used as their receivers would: the archive is unpacked and built against; the Debian
//! package is installed into a root of its own, used and removed. The Conan recipe is tried in the long suite, where
//! conan can be had from PyPI.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const VERSION: &str = env!("CARGO_PKG_VERSION");

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn attempt(command: &mut Command) -> Result<String, String> {
    // A test may itself run under make, whose flags are not for these.
    let output = command.env_remove("MAKEFLAGS").env_remove("MAKELEVEL").env_remove("MFLAGS").output();
    let output = output.map_err(|e| format!("{command:?}: {e}"))?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    if output.status.success() { Ok(said) } else { Err(format!("{command:?}: {}\n{said}{errors}", output.status)) }
}

fn run(command: &mut Command) -> String {
    attempt(command).unwrap_or_else(|e| panic!("{e}"))
}

/// The archives, made once by the first test that asks, with the tests' own profile.
fn archives() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("dist");
    fs::create_dir_all(&folder).expect("the target directory is writable");
    let lock = fs::File::create(folder.join("lock")).expect("the folder is ours");
    lock.lock().expect("the other tests let go");
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("a parent");
    let mut make = Command::new("make");
    make.current_dir(root()).args(["dist", if cfg!(debug_assertions) { "PROFILE=dev" } else { "PROFILE=release" }]);
    run(make.env("CARGO_TARGET_DIR", target));
    target.join("dist")
}

fn scratch(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("dist-{name}"));
    let _ = fs::remove_dir_all(&dir);
    fs::create_dir_all(&dir).expect("the target directory is writable");
    dir
}

/// Builds the consumer against an installed tree by CMake, and runs it.
fn assert_consumed(prefix: &Path, consumer: &Path, build: &Path) {
    let path = format!("-DCMAKE_PREFIX_PATH={}", prefix.display());
    run(Command::new("cmake").arg("-S").arg(consumer).arg("-B").arg(build).arg(path));
    run(Command::new("cmake").arg("--build").arg(build));
    for program in ["consumer", "consumer-static"] {
        let said = run(&mut Command::new(build.join(program)));
        assert!(said.starts_with(&format!("welkin {VERSION}")), "{program}: {said}");
    }
}

#[test]
fn the_archive_has_all_that_a_host_needs() {
    let (archives, dir) = (archives(), scratch("tar"));
    let name = format!("welkin-{VERSION}-linux-{}", std::env::consts::ARCH);
    run(Command::new("tar").arg("-xzf").arg(archives.join(format!("{name}.tar.gz"))).arg("-C").arg(&dir));
    let tree = dir.join(&name);
    for file in [
        "lib/libwelkin.so",
        "lib/libwelkin.so.1",
        "lib/libwelkin.a",
        "lib/pkgconfig/welkin.pc",
        "lib/cmake/welkin/welkinConfig.cmake",
        "include/welkin.h",
        "include/welkin.hpp",
        "README.md",
        "CHANGELOG.md",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "docs/README.md",
        "docs/gallery/noon.png",
        "examples/minimal.c",
    ] {
        assert!(tree.join(file).is_file(), "{file}");
    }
    assert_consumed(&tree, &tree.join("examples/consumer"), &dir.join("build"));
    let sums = run(Command::new("sha256sum").current_dir(&archives).args(["--check", "--strict", "SHA256SUMS"]));
    assert!(sums.lines().count() >= 2 && sums.lines().all(|l| l.ends_with(": OK")), "{sums}");
    fs::remove_dir_all(dir).expect("the folder is ours");
}

/// dpkg with an empty database and root, so that this machine's own packages stay as they are.
fn dpkg(root: &Path) -> Command {
    let mut dpkg = Command::new("dpkg");
    dpkg.arg(format!("--instdir={}", root.display())).arg(format!("--admindir={}", root.join("dpkg").display()));
    dpkg.args(["--force-not-root", "--force-depends", "--force-bad-path", "--log=/dev/null"]);
    dpkg
}

#[test]
fn the_debian_package_is_installed_used_and_removed() {
    if Command::new("dpkg-deb").arg("--version").output().is_err() {
        println!("skipped: dpkg-deb is not here");
        return;
    }
    let (archives, dir) = (archives(), scratch("deb"));
    let architecture = run(Command::new("dpkg").arg("--print-architecture"));
    let package = archives.join(format!("libwelkin-dev_{VERSION}_{}.deb", architecture.trim()));
    let fields = run(Command::new("dpkg-deb").arg("--field").arg(&package).args(["Package", "Version", "Depends"]));
    assert!(fields.contains("libc6") && fields.contains(VERSION), "{fields}");
    for folder in ["updates", "info", "triggers"] {
        fs::create_dir_all(dir.join("dpkg").join(folder)).expect("the folder is ours");
    }
    fs::write(dir.join("dpkg/status"), "").expect("the folder is ours");
    run(dpkg(&dir).arg("--install").arg(&package));
    let state = run(dpkg(&dir).args(["--status", "libwelkin-dev"]));
    assert!(state.contains("Status: install ok"), "{state}");
    assert_consumed(&dir.join("usr"), &root().join("examples/consumer"), &dir.join("build"));
    run(dpkg(&dir).args(["--purge", "libwelkin-dev"]));
    assert!(!dir.join("usr/include/welkin.h").exists() && !dir.join("usr/lib/libwelkin.so").exists());
    fs::remove_dir_all(dir).expect("the folder is ours");
}

#[test]
fn the_conan_recipe_builds_the_consumer() {
    if std::env::var_os("WELKIN_ACCEPT").is_none() {
        println!("skipped: the Conan recipe is tried with WELKIN_ACCEPT=1");
        return;
    }
    let (archives, dir) = (archives(), scratch("conan"));
    let python = dir.join("venv/bin/python");
    let made = attempt(Command::new("python3").args(["-m", "venv"]).arg(dir.join("venv")))
        .and_then(|_| attempt(Command::new(&python).args(["-m", "pip", "install", "--quiet", "conan>=2,<3"])));
    if let Err(e) = made {
        println!("skipped: conan could not be had from PyPI: {e}");
        return;
    }
    let name = format!("welkin-{VERSION}-linux-{}", std::env::consts::ARCH);
    run(Command::new("tar").arg("-xzf").arg(archives.join(format!("{name}.tar.gz"))).arg("-C").arg(&dir));
    let conan = || {
        let mut conan = Command::new(dir.join("venv/bin/conan"));
        conan.current_dir(root()).env("CONAN_HOME", dir.join("home"));
        conan
    };
    run(conan().args(["profile", "detect"]));
    let tree = format!("user.welkin:tree={}", dir.join(name).display());
    let build = format!("tools.cmake.cmake_layout:test_folder={}", dir.join("build").display());
    run(conan().args(["create", "packaging/conan", "-c", &tree, "-c", &build]));
    fs::remove_dir_all(dir).expect("the folder is ours");
}
