//! `make install` as a C project uses it: the tree is installed, moved, and a small consumer is built against it by
//! pkg-config and by find_package(welkin), linked to the shared and to the static library, and run.
#![cfg(unix)]

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(command: &mut Command) -> String {
    let shown = format!("{command:?}");
    // A test may itself run under make, whose flags are not for these.
    let output = command.env_remove("MAKEFLAGS").env_remove("MAKELEVEL").env_remove("MFLAGS").output();
    let output = output.unwrap_or_else(|e| panic!("{shown}: {e}"));
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{shown}: {}\n{said}", output.status);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// A folder of one test's own, empty.
fn scratch(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("install-{name}"));
    let _ = fs::remove_dir_all(&dir);
    fs::create_dir_all(&dir).expect("the target directory is writable");
    dir
}

/// Installs below a staging directory, as a package builder does, then moves the tree to a folder that it does not
/// know.
fn installed(name: &str) -> PathBuf {
    let (dir, profile) = (scratch(name), if cfg!(debug_assertions) { "dev" } else { "release" });
    let mut make = Command::new("make");
    make.current_dir(root()).arg("install").arg(format!("PROFILE={profile}")).arg("PREFIX=/opt/welkin");
    run(make.arg(format!("DESTDIR={}", dir.join("stage").display())));
    let moved = dir.join("a moved tree");
    fs::rename(dir.join("stage/opt/welkin"), &moved).expect("both are ours");
    moved
}

/// The consumer's sources, copied out of this repository.
fn consumer(tree: &Path) -> PathBuf {
    let to = tree.parent().expect("a parent").join("consumer");
    fs::create_dir_all(&to).expect("the folder is ours");
    for file in ["main.c", "Makefile", "CMakeLists.txt"] {
        fs::copy(root().join("examples/consumer").join(file), to.join(file)).expect("a source of the consumer");
    }
    to
}

fn assert_runs(program: &Path) {
    let said = run(&mut Command::new(program));
    assert!(said.starts_with(&format!("welkin {}", env!("CARGO_PKG_VERSION"))), "{}: {said}", program.display());
}

fn tidy(tree: &Path) {
    fs::remove_dir_all(tree.parent().expect("a parent")).expect("the folder is ours");
}

#[test]
fn installed_tree_has_the_names_that_linkers_and_people_look_for() {
    let tree = installed("names");
    for file in ["include/welkin.h", "lib/libwelkin.a", "lib/pkgconfig/welkin.pc"] {
        assert!(tree.join(file).is_file(), "{file}");
    }
    for header in fs::read_dir(root().join("include")).expect("the headers").flatten() {
        assert!(tree.join("include").join(header.file_name()).is_file(), "{}", header.path().display());
    }
    if cfg!(target_os = "linux") {
        for link in ["lib/libwelkin.so", "lib/libwelkin.so.1"] {
            assert!(tree.join(link).is_symlink() && tree.join(link).is_file(), "{link}");
        }
        let dynamic = run(Command::new("readelf").arg("-d").arg(tree.join("lib/libwelkin.so")));
        assert!(dynamic.contains("[libwelkin.so.1]"), "SONAME: {dynamic}");
    }
    tidy(&tree);
}

#[test]
fn a_consumer_builds_by_pkg_config() {
    // pkg-config splits its answer at spaces, as every makefile does, so this tree lies at a path without any.
    let tree = installed("pkg-config");
    let plain = tree.with_file_name("tree");
    fs::rename(&tree, &plain).expect("both are ours");
    let dir = consumer(&plain);
    run(Command::new("make").current_dir(&dir).env("PKG_CONFIG_PATH", plain.join("lib/pkgconfig")));
    assert_runs(&dir.join("consumer"));
    assert_runs(&dir.join("consumer-static"));
    tidy(&plain);
}

#[test]
fn a_consumer_builds_by_find_package() {
    let tree = installed("cmake");
    let dir = consumer(&tree);
    let build = dir.join("build");
    let prefix = format!("-DCMAKE_PREFIX_PATH={}", tree.display());
    run(Command::new("cmake").args(["-S"]).arg(&dir).arg("-B").arg(&build).arg(prefix));
    run(Command::new("cmake").arg("--build").arg(&build));
    assert_runs(&build.join("consumer"));
    assert_runs(&build.join("consumer-static"));
    tidy(&tree);
}

#[test]
fn the_readme_s_c_program_compiles() {
    let readme = fs::read_to_string(root().join("README.md")).expect("the README");
    let code = readme.split("```c\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a C program in it");
    let dir = scratch("readme");
    fs::write(dir.join("readme.c"), code).expect("the folder is ours");
    let strict = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I"];
    run(Command::new("gcc").args(strict).arg(root().join("include")).arg(dir.join("readme.c")));
    fs::remove_dir_all(dir).expect("the folder is ours");
}
