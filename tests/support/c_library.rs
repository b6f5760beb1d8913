//! The shared library that C and C++ programs of the tests link.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Profile of this build: another one would compile all of the library once more.
pub const PROFILE: &str = if cfg!(debug_assertions) { "dev" } else { "release" };

/// Folder of what `PROFILE` builds, given a test's `CARGO_TARGET_TMPDIR`.
pub fn built(scratch: &Path) -> PathBuf {
    let folder = if PROFILE == "dev" { "debug" } else { PROFILE };
    scratch.parent().expect("a folder of the target directory").join(folder)
}

/// Returns the shared library that `WELKIN_LIB` names. If it names none, builds one, given a test's
/// `CARGO_TARGET_TMPDIR`.
pub fn shared(scratch: &Path) -> PathBuf {
    if let Some(named) = std::env::var_os("WELKIN_LIB") {
        return named.into();
    }
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")).args(["build", "--quiet", "--locked"]);
    cargo.args(["--package", "welkin-c", "--profile", PROFILE, "--features", "shared-build"]);
    let output = cargo.output().unwrap_or_else(|e| panic!("{cargo:?}: {e}"));
    assert!(output.status.success(), "{cargo:?}: {}", String::from_utf8_lossy(&output.stderr));
    built(scratch).join("libwelkin.so")
}
