//! The shared library as C programs meet it: what it exports, loading at run time, a C host, and the same under
//! valgrind. `WELKIN_LIB` names a ready library; without it the tests build one.
#![cfg(target_os = "linux")]

use std::{fs, path::Path, path::PathBuf, process::Command};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(command: &mut Command) -> String {
    let shown = format!("{command:?}");
    let output = command.output().unwrap_or_else(|e| panic!("{shown}: {e}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{shown}: {}\n{errors}", output.status);
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The shared library, built in the tests' own profile if none is named.
fn library() -> PathBuf {
    if let Some(named) = std::env::var_os("WELKIN_LIB") {
        return named.into();
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    run(Command::new(cargo).current_dir(root()).args(["rustc", "--quiet", "--lib", "--crate-type", "cdylib"]));
    // The tests' temporary directory lies in the target directory.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("a parent");
    target.join("debug/libwelkin.so")
}

/// Compiles one of the C programs beside these tests.
fn program(name: &str, library: Option<&Path>) -> PathBuf {
    // The tests run at the same time: each has a folder of its own.
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("library-{}", std::process::id()));
    fs::create_dir_all(&dir).expect("the target directory is writable");
    let out = dir.join(name);
    let mut cc = Command::new("gcc");
    cc.args(["-std=c99", "-g", "-Wall", "-Wextra", "-Werror", "-D_DEFAULT_SOURCE", "-I"]).arg(root().join("include"));
    cc.arg(root().join(format!("tests/c/{name}.c"))).arg("-o").arg(&out);
    if let Some(library) = library {
        // A library with a SONAME is looked for under that name, which only an installed one has.
        for link in ["libwelkin.so", "libwelkin.so.1"] {
            let _ = fs::remove_file(dir.join(link));
            std::os::unix::fs::symlink(library, dir.join(link)).expect("the folder is writable");
        }
        cc.arg("-L").arg(&dir).arg("-lwelkin").arg(format!("-Wl,-rpath,{}", dir.display()));
    }
    run(cc.arg("-ldl"));
    out
}

/// Removes the folder of this test's programs.
fn tidy(program: &Path) {
    fs::remove_dir_all(program.parent().expect("a folder")).expect("the folder is ours");
}

fn committed_symbols() -> Vec<String> {
    let list = fs::read_to_string(root().join("tests/abi/symbols.txt")).expect("the committed list");
    list.lines().map(str::to_owned).collect()
}

#[test]
fn the_library_exports_the_committed_list_and_nothing_else() {
    let text = run(Command::new("nm").args(["-D", "--defined-only", "--format=posix"]).arg(library()));
    let mut exported: Vec<String> = text.lines().filter_map(|l| l.split(' ').next()).map(str::to_owned).collect();
    exported.sort_unstable();
    assert_eq!(exported, committed_symbols());
}

#[test]
fn the_library_loads_at_run_time() {
    let program = program("dlopen", None);
    let out = run(Command::new(&program).arg(library()).args(committed_symbols()));
    tidy(&program);
    assert_eq!(out, format!("{} functions\n", committed_symbols().len()));
}

#[test]
fn a_c_host_makes_uses_and_destroys_everything() {
    let noop = program("noop", Some(&library()));
    assert_eq!(run(&mut Command::new(&noop)), "ok\n");
    tidy(&noop);
}

#[test]
fn valgrind_finds_no_error_and_no_leak() {
    let noop = program("noop", Some(&library()));
    let options = ["--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect"];
    assert_eq!(run(Command::new("valgrind").args(options).arg(&noop)), "ok\n");
    tidy(&noop);
}
