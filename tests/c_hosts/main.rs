//! The C examples of hosts that draw with Vulkan or that only have a window: compiled as a C programmer would, and run;
//! each checks its own pixels. `WELKIN_LIB` names a ready library; without it the tests build one.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};

use welkin_support::{c_library, x_server::Server};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Runs a command to its end; its output if it succeeds.
fn run(command: &mut Command) -> String {
    let shown = format!("{command:?}");
    let output = command.output().unwrap_or_else(|e| panic!("{shown}: {e}"));
    let (out, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{shown}: {}\n{out}\n{errors}", output.status);
    out.into_owned()
}

fn library() -> PathBuf {
    c_library::shared(Path::new(env!("CARGO_TARGET_TMPDIR")))
}

/// An example's program in a folder of its own, removed with the value.
struct Program {
    folder: PathBuf,
    path: PathBuf,
}

impl Program {
    fn build(name: &str, libraries: &[&str]) -> Self {
        // Tests build the same example at the same time.
        static BUILT: AtomicU32 = AtomicU32::new(0);
        let own = format!("{name}-{}-{}", std::process::id(), BUILT.fetch_add(1, Ordering::Relaxed));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(own);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("the target directory is writable");
        let library = library();
        // A library with a SONAME is looked for under that name, which only an installed one has.
        for link in ["libwelkin.so", "libwelkin.so.1"] {
            std::os::unix::fs::symlink(&library, folder.join(link)).expect("the folder is writable");
        }
        let path = folder.join(name);
        let sources = fs::read_dir(root().join("examples").join(name)).expect("the example is there");
        let sources = sources.map(|e| e.expect("a file").path()).filter(|p| p.extension().is_some_and(|e| e == "c"));
        let mut cc = Command::new("gcc");
        cc.args(["-std=c11", "-g", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I"]).arg(root().join("include"));
        cc.args(sources).arg("-o").arg(&path).arg("-L").arg(&folder).arg("-lwelkin").args(libraries).arg("-lm");
        run(cc.arg(format!("-Wl,-rpath,{}", folder.display())));
        Self { folder, path }
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// The picture's size and pixels, from a binary PPM.
fn picture(path: &Path) -> (usize, usize, Vec<u8>) {
    let bytes = fs::read(path).expect("the example wrote a picture");
    let header: Vec<&[u8]> = bytes.splitn(4, |&b| b == b'\n').collect();
    let size = String::from_utf8_lossy(header[1]).into_owned();
    let (width, height) = size.split_once(' ').expect("width and height");
    (width.parse().unwrap(), height.parse().unwrap(), header[3].to_vec())
}

#[test]
fn the_vulkan_host_draws_and_checks_its_picture() {
    let program = Program::build("vulkan_host", &["-lvulkan", "-lX11"]);
    let out = program.folder.join("picture.ppm");
    let said = run(Command::new(&program.path).arg(&out));
    assert!(said.ends_with("ok\n"), "{said}");
    let (width, height, pixels) = picture(&out);
    assert_eq!((width, height, pixels.len()), (640, 360, 640 * 360 * 3));
}

#[test]
fn the_vulkan_host_presents_resizes_and_resolves() {
    let program = Program::build("vulkan_host", &["-lvulkan", "-lX11"]);
    let server = Server::start();
    let out = program.folder.join("picture.ppm");
    let shown = ["1", "4"].map(|samples| {
        let mut host = Command::new(&program.path);
        host.args(["--window", "--samples", samples, "--check"]).arg(&out).env("DISPLAY", &server.display);
        let said = run(&mut host);
        assert!(said.ends_with("ok\n"), "{said}");
        picture(&out)
    });
    let [(width, height, one), (.., four)] = shown;
    assert_eq!((width, height, one.len(), four.len()), (640, 360, 640 * 360 * 3, 640 * 360 * 3));
    // The host's edges lie between pixels, so sample by sample the picture is the same, to rounding.
    let worst = one.iter().zip(&four).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(1), "{worst:?} of 255 between one sample a pixel and four");
}

#[test]
fn the_window_host_draws_resizes_and_hides() {
    let program = Program::build("window_host", &["-lX11"]);
    let server = Server::start();
    for backend in [&[][..], &["--gl"]] {
        let out = program.folder.join("picture.ppm");
        let mut host = Command::new(&program.path);
        let said = run(host.args(backend).arg("--check").arg(&out).env("DISPLAY", &server.display));
        assert!(said.ends_with("ok\n"), "{said}");
        let (width, height, pixels) = picture(&out);
        // The screenshot is the window's own: a sky that pales towards the horizon, in every column.
        assert_eq!((width, height), (320, 200));
        for x in [0, 100, 319] {
            let at = |y: usize| &pixels[3 * (y * width + x)..][..3];
            assert!(at(2)[2] > at(2)[0] && at(197)[0] > at(2)[0], "column {x}: {:?} above {:?}", at(2), at(197));
        }
    }
}
