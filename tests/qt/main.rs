//! The widget of `docs/hosts-qt.md` as a Qt user builds it: taken from the article, compiled after Qt's headers, run
//! with and without multisampling in both OpenGL profiles, twice in a window, resized, under an overlay. The test needs
//! Qt 6's development files; without them it prints a line and passes. `WELKIN_LIB` names a library that is already
//! built; without it the test builds one.
#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use welkin_support::c_library;

/// Debian's packages that the widget is built against.
const PACKAGES: &str = "qt6-base-dev libqt6opengl6-dev";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(said) } else { Err(format!("{command:?}: {}\n{said}", output.status)) }
}

fn library() -> PathBuf {
    c_library::shared(Path::new(env!("CARGO_TARGET_TMPDIR")))
}

/// Compiler flags of Qt, if its headers and libraries are installed.
fn qt(folder: &Path) -> Option<Vec<String>> {
    let flags = run(Command::new("pkg-config").args(["--cflags", "--libs", "Qt6OpenGLWidgets"])).ok()?;
    let flags: Vec<String> = flags.split_whitespace().map(str::to_owned).collect();
    let source = folder.join("probe.cpp");
    fs::write(&source, "#include <QOpenGLWidget>\nint main() { return 0; }\n").expect("the folder is ours");
    let mut cc = Command::new("g++");
    cc.args(["-std=c++17", "-fPIC"]).arg(&source).args(&flags).arg("-o").arg(folder.join("probe"));
    run(&mut cc).is_ok().then_some(flags)
}

#[test]
fn the_articles_widget_draws_in_every_way_that_it_promises() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("qt");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target directory is writable");
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o700)).expect("the folder is ours");
    let Some(flags) = qt(&folder) else {
        println!("skipped: Qt 6 is not installed ({PACKAGES})");
        return;
    };
    let article = fs::read_to_string(root().join("docs/hosts-qt.md")).expect("the article");
    let mut blocks = article.split("```cpp\n").skip(1).filter_map(|rest| rest.split("```").next());
    let widget = format!("#pragma once\n{}", blocks.next().expect("the widget"));
    fs::write(folder.join("weather_widget.hpp"), widget).expect("the folder is ours");
    fs::write(folder.join("main.cpp"), blocks.next().expect("the program")).expect("the folder is ours");
    let library = library();
    for link in ["libwelkin.so", "libwelkin.so.1"] {
        std::os::unix::fs::symlink(&library, folder.join(link)).expect("the folder is ours");
    }
    for (source, program) in [(folder.join("main.cpp"), "program"), (root().join("tests/qt/widgets.cpp"), "widgets")] {
        let mut cc = Command::new("g++");
        cc.args(["-std=c++17", "-fPIC", "-Wall", "-Wextra", "-Werror", "-I"])
            .arg(&folder)
            .arg("-I")
            .arg(root().join("include"));
        cc.arg(source).args(&flags).arg("-L").arg(&folder).arg("-lwelkin");
        cc.arg(format!("-Wl,-rpath,{}", folder.display())).arg("-o").arg(folder.join(program));
        run(&mut cc).unwrap_or_else(|e| panic!("{e}"));
    }
    let server = welkin_support::x_server::Server::start();
    for samples in ["0", "4"] {
        for profile in ["core", "compatibility"] {
            let mut host = Command::new(folder.join("widgets"));
            host.args([samples, profile]).arg(&folder).env("DISPLAY", &server.display).env("XDG_RUNTIME_DIR", &folder);
            let said =
                run(host.env("QT_QPA_PLATFORM", "xcb")).unwrap_or_else(|e| panic!("{samples} samples, {profile}: {e}"));
            assert!(said.ends_with("ok\n"), "{samples} samples, {profile}: {said}");
        }
    }
    fs::remove_dir_all(folder).expect("the folder is ours");
}
