//! Every program and script keeps the conventions of a command line: help and version on standard output with status 0,
//! errors by name on standard error with status 2, no panic message of Rust, and no incomplete file. `WELKIN_LIB` names
//! a ready library; without it the tests build one.
#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::process::ExitStatusExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use welkin_support::c_library::{self, PROFILE};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder of one test's own, empty.
fn scratch(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("command_lines-{name}"));
    let _ = fs::remove_dir_all(&dir);
    fs::create_dir_all(&dir).expect("the target directory is writable");
    dir
}

fn output(command: &mut Command) -> Output {
    command.output().unwrap_or_else(|e| panic!("{command:?}: {e}"))
}

fn run(command: &mut Command) -> String {
    let done = output(command);
    assert!(done.status.success(), "{command:?}: {}\n{}", done.status, String::from_utf8_lossy(&done.stderr));
    String::from_utf8_lossy(&done.stdout).into_owned()
}

fn cargo() -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root());
    cargo
}

/// The folder of what the tests' profile builds.
fn built() -> PathBuf {
    c_library::built(Path::new(env!("CARGO_TARGET_TMPDIR")))
}

fn library() -> PathBuf {
    c_library::shared(Path::new(env!("CARGO_TARGET_TMPDIR")))
}

/// A C program of these sources, linked as a host is.
fn c_program(folder: &Path, name: &str, sources: &[PathBuf], libraries: &[&str]) -> PathBuf {
    let library = library();
    for link in ["libwelkin.so", "libwelkin.so.1"] {
        let _ = std::os::unix::fs::symlink(&library, folder.join(link));
    }
    let path = folder.join(name);
    let mut cc = Command::new("gcc");
    cc.args(["-std=c11", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I"]).arg(root().join("include"));
    cc.args(sources).arg("-o").arg(&path).arg("-L").arg(folder).arg("-lwelkin").args(libraries).arg("-lm");
    run(cc.arg(format!("-Wl,-rpath,{}", folder.display())));
    path
}

/// An example in C, of all the sources in its folder.
fn example_in_c(folder: &Path, name: &str, libraries: &[&str]) -> PathBuf {
    let sources = fs::read_dir(root().join("examples").join(name)).expect("the example is there");
    let sources: Vec<PathBuf> = sources.map(|e| e.expect("a file").path()).collect();
    let sources: Vec<PathBuf> = sources.into_iter().filter(|p| p.extension().is_some_and(|e| e == "c")).collect();
    c_program(folder, name, &sources, libraries)
}

/// Checks that a program keeps the conventions; `wrong` are further command lines that it must refuse, each with the
/// text that its error must contain.
fn assert_conventions(program: &Path, wrong: &[(&[&str], &str)]) {
    let name = program.file_name().expect("a name").to_string_lossy().into_owned();
    let ask = |arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(arguments).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").stdin(std::process::Stdio::null());
        output(&mut command)
    };
    for (arguments, wanted) in
        [(["--help"], name.as_str()), (["-h"], &name), (["--version"], env!("CARGO_PKG_VERSION"))]
    {
        let done = ask(&arguments);
        let (out, errors) = (String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
        assert!(done.status.code() == Some(0) && errors.is_empty(), "{name} {arguments:?}: {}, {errors}", done.status);
        assert!(out.contains(wanted), "{name} {arguments:?}: {out}");
    }
    for (arguments, named) in [(["--no-such-option"].as_slice(), "--no-such-option")].iter().chain(wrong) {
        let done = ask(arguments);
        let (out, errors) = (String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
        assert!(done.status.code() == Some(2) && out.is_empty(), "{name} {arguments:?}: {}, {out}", done.status);
        assert!(errors.contains(named), "{name} {arguments:?}: {errors}");
        assert!(errors.starts_with(&name), "{name} {arguments:?} does not say who speaks: {errors}");
        let dumps = ["Error {", "Os {", "Error(", "panicked", "Some(", "RUST_BACKTRACE"];
        assert!(!dumps.iter().any(|d| errors.contains(d)), "{name} {arguments:?}: {errors}");
    }
}

#[test]
fn examples_in_rust_keep_the_conventions() {
    run(cargo().args([
        "build",
        "--quiet",
        "--locked",
        "--profile",
        PROFILE,
        "--workspace",
        "--bins",
        "--example",
        "native",
    ]));
    let native = built().join("examples/native");
    assert_conventions(
        &built().join("noise"),
        &[
            (&["a.dds", "--octaves"], "--octaves has no value"),
            (&["a.dds", "--size", "9x"], "--size"),
            (&["a.xyz"], "a.xyz"),
        ],
    );
    assert_conventions(&built().join("on_gpu"), &[(&["no-such-step"], "no-such-step"), (&[], "no step")]);
    assert_conventions(
        &built().join("probe"),
        &[
            (&["fog", "--planet", "x"], "--planet"),
            (&["fog", "--visibility"], "--visibility has no value"),
            (&["why"], "why"),
        ],
    );
    assert_conventions(
        &built().join("cigi_host"),
        &[(&["--decode"], "--decode has no value"), (&[], "--listen"), (&["--rate", "60x"], "--rate")],
    );
    assert_conventions(
        &built().join("studio"),
        &[
            (&["--headless"], "--script"),
            (&["--headless", "--script"], "--script takes a value"),
            (&["--headless", "--script", "x", "--size", "9x9"], "320x200"),
        ],
    );
    assert_conventions(&built().join("lab"), &[(&["chart", "soup"], "soup"), (&["--scene"], "--scene")]);
    assert_conventions(&native, &[(&["a.png", "METAR", "more"], "more")]);
    // Later errors are sentences too.
    let bad = output(Command::new(&native).current_dir(root()).args(["/nowhere/a.png", "METAR KTRI"]));
    let errors = String::from_utf8_lossy(&bad.stderr);
    assert!(bad.status.code() == Some(1) && errors.starts_with("native: "), "{}: {errors}", bad.status);
    assert!(!errors.contains("Error {") && !errors.contains("Parse("), "{errors}");
}

#[test]
fn examples_in_c_keep_the_conventions() {
    let folder = scratch("c");
    let window = example_in_c(&folder, "window_host", &["-lX11"]);
    assert_conventions(&window, &[(&["--check", "a.ppm", "b.ppm"], "b.ppm"), (&["a.ppm"], "a.ppm")]);
    let vulkan = example_in_c(&folder, "vulkan_host", &["-lvulkan", "-lX11"]);
    assert_conventions(
        &vulkan,
        &[(&["--samples", "3"], "1 or 4, got 3"), (&["--samples", "many"], "many"), (&["--samples"], "--samples")],
    );
    let flags = run(Command::new("pkg-config").args(["--libs", "glfw3", "egl", "libpng"]));
    let glfw = example_in_c(&folder, "glfw_host", &flags.split_whitespace().collect::<Vec<_>>());
    assert_conventions(
        &glfw,
        &[
            (&["--size", "640x"], "--size must be WxH"),
            (&["--size", "640x360x"], "--size must be WxH"),
            (&["--frames", "few"], "--frames"),
            (&["--report", "0"], "--report"),
            (&["--out"], "--out"),
            (&["picture"], "picture"),
            (&["--gallery", "nowhere"], "nowhere"),
        ],
    );
    fs::remove_dir_all(folder).expect("the folder is ours");
}

#[test]
fn scripts_keep_the_conventions() {
    use std::os::unix::fs::PermissionsExt as _;
    let scripts = fs::read_dir(root().join("scripts")).expect("the scripts").map(|e| e.expect("a file").path());
    let is_program = |p: &PathBuf| p.is_file() && fs::metadata(p).is_ok_and(|m| m.permissions().mode() & 0o111 != 0);
    let scripts: Vec<PathBuf> = scripts.filter(is_program).collect();
    assert!(scripts.len() >= 3, "{scripts:?}");
    scripts.iter().for_each(|script| assert_conventions(script, &[]));
}

/// Ctrl-C while a picture is being written: the previous file stays, and no other file is left.
#[test]
fn an_interrupted_c_program_leaves_no_half_of_a_file() {
    let folder = scratch("interrupted");
    let source = folder.join("half.c");
    let text = format!(
        "#include \"{}\"\nint main(int argc, char **argv)\n{{\n    FILE *f = fopen(part_begin(argv[1]), \"wb\");\n    \
         fputs(\"half\", f);\n    fflush(f);\n    if (argc > 2) raise(SIGINT);\n    fclose(f);\n    return part_end(argv[1], true) ? 0 : 1;\n}}\n",
        root().join("examples/command_line.h").display()
    );
    fs::write(&source, text).expect("the folder is ours");
    let program = c_program(&folder, "half", &[source], &[]);
    let picture = folder.join("a.b").join("picture.png");
    fs::create_dir_all(picture.parent().expect("a folder")).expect("the folder is ours");
    fs::write(&picture, "what was there").expect("the folder is ours");
    let ended = output(Command::new(&program).arg(&picture).arg("interrupt"));
    assert_eq!(ended.status.signal(), Some(2), "{}", ended.status);
    assert_eq!(fs::read_to_string(&picture).expect("it stays"), "what was there");
    assert_eq!(fs::read_dir(folder.join("a.b")).expect("the folder").count(), 1);
    assert!(output(Command::new(&program).arg(&picture)).status.success());
    assert_eq!(fs::read_to_string(&picture).expect("it is there"), "half");
    assert_eq!(fs::read_dir(folder.join("a.b")).expect("the folder").count(), 1);
    fs::remove_dir_all(folder).expect("the folder is ours");
}

#[test]
fn a_file_that_cannot_be_written_whole_is_not_written() {
    let folder = scratch("whole");
    let file = folder.join("a.txt");
    welkin_command_line::write_whole(&file, b"first").expect("writable");
    welkin_command_line::write_whole(&file, b"second").expect("writable");
    assert_eq!(fs::read(&file).expect("there"), b"second");
    // A folder of that name cannot be replaced by a file.
    let taken = folder.join("taken");
    fs::create_dir(&taken).expect("ours");
    fs::write(taken.join("x"), "").expect("ours");
    let e = welkin_command_line::write_whole(&taken, b"text").expect_err("a folder has this name").to_string();
    assert!(e.contains("taken"), "{e}");
    assert_eq!(fs::read_dir(&folder).expect("ours").count(), 2, "nothing is left beside them");
    assert!(welkin_command_line::write_png(&folder.join("a.png"), &[0; 3], [1, 1]).is_ok());
    assert_eq!(welkin_command_line::at_work("test", "nothing", || 7), 7);
    assert!(welkin_command_line::answered("test", "usage", ["x".to_owned()].into_iter()).is_none());
    fs::remove_dir_all(folder).expect("ours");
}

/// Files under `folder` with one of these endings.
fn sources(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").flatten().map(|e| e.path()) {
        if entry.is_dir() {
            sources(&entry, endings, found);
        } else if entry.extension().is_some_and(|e| endings.iter().any(|w| e == *w)) {
            found.push(entry);
        }
    }
}

/// No example opens a file to write in another way than these.
#[test]
fn examples_write_files_whole() {
    let mut files = Vec::new();
    for folder in ["glfw_host", "osg_host", "vulkan_host", "window_host", "native", "noise/src", "probe/src", "lab/src"]
    {
        sources(&root().join("examples").join(folder), &["rs", "c", "cpp", "hpp", "h"], &mut files);
    }
    for file in files.iter().filter(|f| !f.ends_with("lab/src/store.rs")) {
        let text = fs::read_to_string(file).expect("a source");
        let text = text.split("#[cfg(test)]").next().expect("a part");
        for (number, line) in text.lines().enumerate() {
            let writes = ["fs::write(", "File::create(", "save_buffer(", ".save(&path", "writeImageFile("];
            let is_whole = line.contains("part_begin(");
            let opens = line.contains("fopen(") && line.contains("\"w");
            let shown = file.display();
            assert!(is_whole || !opens && !writes.iter().any(|w| line.contains(w)), "{shown}:{}: {line}", number + 1);
        }
    }
}
