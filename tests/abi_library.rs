//! The shared library as C programs use it: its exports, loading at run time, a C host, and the same under valgrind.
//! `WELKIN_LIB` names a ready library; without it the tests build one.
#![cfg(target_os = "linux")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::atomic::{AtomicU32, Ordering},
};

use welkin_support::c_library;

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

fn library() -> PathBuf {
    c_library::shared(Path::new(env!("CARGO_TARGET_TMPDIR")))
}

/// Compiles one of the C programs beside these tests.
fn program(name: &str, options: &[&str], library: Option<&Path>) -> PathBuf {
    // The tests run at the same time, in one process or several: each has a folder of its own.
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let folder = format!("library-{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    fs::create_dir_all(&dir).expect("the target directory is writable");
    let source = root().join(name);
    let cpp = name.ends_with(".cpp");
    let out = dir.join(source.file_stem().expect("a file"));
    let mut cc = Command::new(if cpp { "g++" } else { "gcc" });
    cc.arg(if cpp { "-std=c++11" } else { "-std=c99" }).args(options);
    cc.args(["-g", "-Wall", "-Wextra", "-Werror", "-D_DEFAULT_SOURCE", "-I"]).arg(root().join("include"));
    cc.arg(&source).arg("-o").arg(&out);
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
    let program = program("tests/c/dlopen.c", &[], None);
    let out = run(Command::new(&program).arg(library()).args(committed_symbols()));
    tidy(&program);
    assert_eq!(out, format!("{} functions\n", committed_symbols().len()));
}

#[test]
fn a_c_host_makes_uses_and_destroys_everything() {
    let noop = program("tests/c/noop.c", &[], Some(&library()));
    assert_eq!(run(&mut Command::new(&noop)), "ok\n");
    tidy(&noop);
}

#[test]
fn valgrind_finds_no_error_and_no_leak() {
    let noop = program("tests/c/noop.c", &[], Some(&library()));
    assert_eq!(watched(&noop, &[]), "ok\n");
    tidy(&noop);
}

/// Runs a program under valgrind, which must find no error and no lost memory.
fn watched(program: &Path, arguments: &[&str]) -> String {
    // A driver is unloaded before leaks are reported; this option keeps its name.
    let options = [
        "--quiet",
        "--error-exitcode=9",
        "--leak-check=full",
        "--errors-for-leak-kinds=definite,indirect",
        "--keep-debuginfo=yes",
    ];
    let not_ours = format!("--suppressions={}", root().join("tests/c/valgrind.supp").display());
    run(Command::new("valgrind").args(options).arg(not_ours).arg(program).args(arguments))
}

/// Memory checks that take minutes: the C++ wrapper, and the tests of `abi_calls`, which make every kind of right and
/// wrong call of the C interface. Their program is the one that cargo built beside this one.
#[test]
fn valgrind_finds_nothing_in_the_long_suite() {
    if std::env::var_os("WELKIN_ACCEPT").is_none() {
        return;
    }
    for options in [&["-pedantic"][..], &["-pedantic", "-fno-exceptions"]] {
        let raii = program("tests/c/raii.cpp", options, Some(&library()));
        assert_eq!(watched(&raii, &[]), "ok\n");
        tidy(&raii);
    }
    let here = std::env::current_exe().expect("a program");
    let named = |p: &PathBuf| p.file_name().is_some_and(|n| n.to_string_lossy().starts_with("abi_calls-"));
    let beside = fs::read_dir(here.parent().expect("a folder")).expect("the folder is there");
    let made = |p: &PathBuf| fs::metadata(p).and_then(|m| m.modified()).ok();
    let tests =
        beside.map(|e| e.expect("a file").path()).filter(|p| named(p) && p.extension().is_none()).max_by_key(made);
    let tests = tests.expect("cargo has built the tests of the C interface");
    let skipped = UNWATCHED.iter().flat_map(|name| ["--skip", *name]);
    let said = watched(&tests, &["--test-threads=1"].into_iter().chain(skipped).collect::<Vec<_>>());
    assert!(said.contains("test result: ok"), "{said}");
}

/// Tests that compute for long rather than call: under valgrind each would take minutes.
const UNWATCHED: [&str; 12] = [
    "tables_are_built_ahead",
    "a_leap_is_answered",
    "the_ends_of_the_altitudes",
    "sizes_of_other_versions",
    "what_any_setter_sets",
    "one_byte_changed_anywhere",
    "a_state_of_another_place",
    "the_timeline_and_the_light",
    "a_changed_context_draws_like_one_created",
    "a_planets_own_haze_is_drawn",
    "another_body_is_drawn",
    "the_sky_answers_towards_all_directions",
];

#[test]
fn a_cpp_host_with_and_without_exceptions() {
    for options in [&["-pedantic"][..], &["-pedantic", "-fno-exceptions"]] {
        let raii = program("tests/c/raii.cpp", options, Some(&library()));
        assert_eq!(run(&mut Command::new(&raii)), "ok\n");
        tidy(&raii);
    }
}

#[test]
fn the_minimal_example_draws_a_sky() {
    let minimal = program("examples/minimal.c", &[], Some(&library()));
    let output = Command::new(&minimal).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let header = b"P6 320 180 255\n";
    assert_eq!(&output.stdout[..header.len()], header);
    let pixels: Vec<&[u8]> = output.stdout[header.len()..].chunks_exact(3).collect();
    assert_eq!(pixels.len(), 320 * 180);
    // By day the sky is bluer than it is red high up, and brighter than the ground is below the horizon.
    let row = |y: usize| &pixels[y * 320..(y + 1) * 320];
    let mean = |y: usize, c: usize| row(y).iter().map(|p| f64::from(p[c])).sum::<f64>() / 320.0;
    // There are few clouds in the report.
    let bluer = pixels[..320 * 70].iter().filter(|p| i32::from(p[2]) > i32::from(p[0]) + 20).count();
    assert!(bluer > 320 * 30, "{bluer} of {} pixels above the horizon are blue", 320 * 70);
    assert!(mean(80, 1) > 60.0, "{}", mean(80, 1));
    tidy(&minimal);
}
