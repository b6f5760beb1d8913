//! The OpenSceneGraph host as users build and run it: installed Welkin, CMake, a display without a screen. The host
//! checks its own pictures and OpenGL state. These tests run every way in which it draws, and check the pictures.
#![cfg(target_os = "linux")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use welkin_support::{accept, x_server::Server};

/// Debian's package with what the host is built against.
const PACKAGE: &str = "libopenscenegraph-dev";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Runs a command to its end. Returns its output on both streams if it succeeds.
fn run(command: &mut Command) -> String {
    let shown = format!("{command:?}");
    let output = command.env_remove("MAKEFLAGS").env_remove("MAKELEVEL").env_remove("MFLAGS").output();
    let output = output.unwrap_or_else(|e| panic!("{shown}: {e}"));
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{shown}: {}\n{said}", output.status);
    said
}

/// Returns the tests' folder, which is kept from run to run, so that files that are up to date are not built again.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("osg_host")
}

/// Returns the folder in which Welkin is installed for the tests.
fn tree() -> PathBuf {
    folder().join("tree")
}

/// Installs Welkin and builds the host against it, once for all tests.
fn built() -> PathBuf {
    fs::create_dir_all(folder()).expect("the target directory is writable");
    let lock = fs::File::create(folder().join("lock")).expect("the folder is ours");
    lock.lock().expect("the other tests let go");
    let build = folder().join("build");
    let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
    run(Command::new("make").current_dir(root()).arg("install").args([
        format!("PROFILE={profile}"),
        format!("PREFIX={}", tree().display()),
        "DESTDIR=".to_string(),
    ]));
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(root().join("examples/osg_host")).arg("-B").arg(&build);
    cmake.arg(format!("-DCMAKE_PREFIX_PATH={}", tree().display()));
    let said =
        run(cmake.args(["-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_C_FLAGS=-O2 -Werror", "-DCMAKE_CXX_FLAGS=-Werror"]));
    assert!(!said.contains("osg_host is skipped"), "install {PACKAGE}: {said}");
    run(Command::new("cmake").arg("--build").arg(&build).args(["--parallel", "2"]));
    build.join("osg_host")
}

struct Host {
    program: PathBuf,
    server: Server,
    folder: PathBuf,
}

impl Host {
    fn new(test: &str) -> Self {
        let folder = folder().join(test);
        fs::create_dir_all(&folder).expect("the folder is ours");
        Self { program: built(), server: Server::start(), folder }
    }

    /// Runs the host with these arguments, of which only METAR reports have spaces. Returns its output, in which Welkin
    /// and OSG report no fault.
    fn run(&self, arguments: &str, metar: Option<&str>) -> String {
        let mut host = Command::new(&self.program);
        host.env("DISPLAY", &self.server.display).arg("--data").arg(root().join("examples/data"));
        host.arg("--cache").arg(folder().join("cache")).args(arguments.split_whitespace());
        host.args(metar.iter().flat_map(|report| ["--metar", report]));
        let said = run(&mut host);
        let faults = ["WK_ERROR", "FBO", "OpenGL error", "Warning"];
        assert!(!faults.iter().any(|f| said.contains(f)), "{arguments}: {said}");
        said
    }

    fn picture(&self, name: &str, arguments: &str) -> image::RgbImage {
        self.picture_of(None, name, arguments)
    }

    fn picture_of(&self, metar: Option<&str>, name: &str, arguments: &str) -> image::RgbImage {
        let path = self.folder.join(name);
        let _ = fs::remove_file(&path);
        self.run(&format!("{arguments} --out {}", path.display()), metar);
        image::open(&path).unwrap_or_else(|e| panic!("{name}: {e}")).into_rgb8()
    }
}

/// Grass near the camera in pictures of 640 x 360.
const MEADOW: [u32; 4] = [440, 260, 640, 350];

/// Mean of green over a rectangle, and its standard deviation.
fn green(picture: &image::RgbImage, [x0, y0, x1, y1]: [u32; 4]) -> (f64, f64) {
    let values = (y0..y1).flat_map(|y| (x0..x1).map(move |x| f64::from(picture.get_pixel(x, y)[1])));
    let (n, sum, squares) = values.fold((0.0, 0.0, 0.0), |(n, s, q), v| (n + 1.0, s + v, q + v * v));
    (sum / n, (squares / n - (sum / n).powi(2)).max(0.0).sqrt())
}

/// Weather off, on, and off again in every kind of target: each run compares its pictures and more than a thousand
/// values of OpenGL's state.
#[test]
fn weather_comes_and_goes_without_a_trace() {
    let host = Host::new("check");
    for target in [
        "--msaa none",
        "--msaa none --shared --reversed",
        "--msaa osg --reversed",
        "--window --msaa none",
        "--msaa none --cab",
    ] {
        let said = host.run(&format!("--check --frames 2 --size 160 90 {target}"), None);
        assert!(
            said.contains("\nok\n") && said.contains("leaves 0 %") && said.contains(" 0 changed"),
            "{target}: {said}"
        );
    }
}

/// No display has a visual with 64 samples, and a display without GLX has no visual for OpenGL.
#[test]
fn a_display_without_the_visual_is_named() {
    let host = Host::new("visual");
    let said = host.run("--check --frames 2 --size 160 90 --window --samples 64", None);
    assert!(said.contains("no visual with 64 samples") && said.contains("\nok\n"), "{said}");
    let server = Server::start_with(&["-extension", "GLX"]);
    let mut without = Command::new(&host.program);
    without.env("DISPLAY", &server.display).arg("--data").arg(root().join("examples/data"));
    let output = without.args(["--check", "--size", "160", "90"]).output().expect("the host runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && said.contains("no window with OpenGL"), "{}: {said}", output.status);
}

/// A multisampled texture of which Welkin draws every sample, and a window of four samples: the picture of one sample
/// with smoother edges, and OpenGL as it was.
#[test]
fn samples_of_textures_and_windows_make_edges_smooth() {
    let host = Host::new("samples");
    let ways = [
        ("--msaa none --reversed", "--msaa textures --reversed"),
        ("--window --msaa none", "--window --msaa osg --samples 4"),
    ];
    for (i, (plain, sampled)) in ways.iter().enumerate() {
        let draw = |way: &str, name: &str| {
            // In front of a sky without clouds, because the edges of clouds are steps too.
            let metar = Some("METAR KTRI 121800Z 24012KT 10SM CLR 12/11 A2978");
            host.picture_of(metar, &format!("{i}-{name}.png"), &format!("{way} --frames 2 --size 640 360"))
        };
        let (one, four) = (draw(plain, "one"), draw(sampled, "four"));
        for part in [MEADOW, [0, 0, 200, 60]] {
            let (a, b) = (green(&one, part).0, green(&four, part).0);
            assert!((a - b).abs() < 2.0, "{sampled}: {b} where one sample a pixel has {a}");
        }
        // The boom's slanted edges: steps from pixel to pixel are smaller.
        let steps = |p: &image::RgbImage| {
            let pixels = (250..285).flat_map(|y| (200..250).map(move |x| (x, y)));
            pixels.filter(|(x, y)| p.get_pixel(*x, *y)[0].abs_diff(p.get_pixel(x + 1, *y)[0]) > 90).count()
        };
        assert!(
            steps(&four) < steps(&one) * 3 / 4,
            "{sampled}: {} hard steps, without samples {}",
            steps(&four),
            steps(&one)
        );
        let said = host.run(&format!("--check --frames 2 --size 160 90 {sampled}"), None);
        assert!(
            said.contains("\nok\n") && said.contains("leaves 0 %") && said.contains(" 0 changed"),
            "{sampled}: {said}"
        );
    }
}

/// A scene whose colours are the display's own is as bright under the weather as one in luminance, at noon and at dusk.
#[test]
fn scenes_without_units_are_lit_as_those_in_luminance() {
    let host = Host::new("light");
    for hour in ["17", "0.2"] {
        let draw =
            |way: &str, name: &str| host.picture(name, &format!("{way} --hour {hour} --frames 2 --size 640 360"));
        let (linear, window) = (draw("--msaa none", "linear.png"), draw("--window --msaa none", "window.png"));
        let (a, b) = (green(&linear, MEADOW).0, green(&window, MEADOW).0);
        assert!((a - b).abs() < 5.0, "hour {hour}: the meadow has {b} in the window, {a} in luminance");
    }
}

/// After a leap of hours a simulated ground needs more updates than one: the host's code reports that and continues to
/// draw.
#[test]
fn a_picture_waits_for_the_simulated_ground() {
    let host = Host::new("leap");
    let said = host.run("--leap 8 --msaa none --size 160 90 --frames 2", None);
    assert!(!said.contains("lagged"), "without a picture nothing waits: {said}");
    let path = host.folder.join("leap.png");
    let said = host.run(&format!("--leap 8 --msaa none --size 160 90 --frames 2 --out {}", path.display()), None);
    let lagged = said.split("the ground lagged for ").nth(1).and_then(|s| s.split(' ').next()?.parse::<u32>().ok());
    assert!(lagged.is_some_and(|frames| frames > 0), "{said}");
}

/// Two windows of one viewer draw the same in all of OSG's threading models, with Welkin in the viewer's own context
/// and in a context of its own.
#[test]
fn every_threading_model_draws_the_same_two_windows() {
    let host = Host::new("threads");
    let ways = ["--window --msaa none", "--msaa none --shared"];
    for (i, way) in ways.iter().enumerate() {
        let mut first: Option<[image::RgbImage; 2]> = None;
        for threads in ["single", "context", "draw", "camera"] {
            if i > 0 && !accept() && threads == "context" {
                continue;
            }
            let arguments = format!("{way} --windows 2 --threading {threads} --frames 3 --size 160 90");
            let one = host.picture(&format!("{i}-{threads}.png"), &arguments);
            let two =
                image::open(host.folder.join(format!("{i}-{threads}-1.png"))).expect("a second picture").into_rgb8();
            assert_ne!(one, two, "the second window looks elsewhere");
            match &first {
                None => first = Some([one, two]),
                Some(first) => assert!(*first == [one, two], "{way} --threading {threads} draws another picture"),
            }
        }
    }
}

#[test]
fn windows_are_resized_and_closed() {
    let host = Host::new("windows");
    const CLOSED: &str = "METAR KTRI 121800Z 24012KT 3SM +RA OVC012 12/11 A2978";
    for way in ["--msaa osg --threading draw", "--shared --msaa none", "--window --msaa none"] {
        let resized =
            host.picture_of(Some(CLOSED), "resized.png", &format!("--resize --frames 2 --size 320 180 {way}"));
        assert_eq!(resized.dimensions(), (240, 90), "{way}");
        // The weather reaches every corner of the new size: the same closed sky left and right.
        let (left, right) = (green(&resized, [0, 0, 20, 10]).0, green(&resized, [220, 0, 240, 10]).0);
        assert!((left - right).abs() < 10.0 && left > 100.0, "{way}: {left} {right}");
        host.run(&format!("--close --frames 2 --size 160 90 {way}"), None);
    }
}

/// Four panes at 40, 160, 640 and 2560 m, equally large in the picture, so that only the veil in front of them differs.
#[test]
fn glass_fades_into_the_air_before_it() {
    let host = Host::new("glass");
    for way in ["--msaa none --reversed", "--window --msaa none"] {
        let picture = host.picture("panes.png", &format!("{way} --frames 2 --size 640 360"));
        let beside = |x: u32| green(&picture, [x - 3, 166, x + 3, 171]).0 - green(&picture, [x - 3, 180, x + 3, 186]).0;
        let contrasts = [238, 265, 292, 319].map(beside);
        assert!(contrasts[0] > 20.0, "the near pane is seen, {way}: {contrasts:?}");
        assert!(
            contrasts.is_sorted_by(|a, b| *a > b + 3.0),
            "each fades more than the one before, {way}: {contrasts:?}"
        );
        assert!(contrasts[3] < 0.35 * contrasts[0], "the farthest is nearly gone, {way}: {contrasts:?}");
    }
}

/// Drops stand on the glass of the cab, whose box keeps the rain off the driver; without rain it is clear.
#[test]
fn the_cab_has_rain_on_its_windscreen() {
    let host = Host::new("cab");
    let view = "--cab --msaa none --reversed --frames 2 --size 640 360";
    let rain = host.picture("rain.png", view);
    let mist = "METAR KTRI 121800Z 24012KT 3SM BR OVC030 12/11 A2978";
    let dry = host.picture_of(Some(mist), "dry.png", view);
    const THROUGH_THE_GLASS: [u32; 4] = [200, 50, 440, 120];
    let (wet, clear) = (green(&rain, THROUGH_THE_GLASS).1, green(&dry, THROUGH_THE_GLASS).1);
    assert!(wet > 4.0 && clear < 0.5 * wet, "drops on grey sky: {wet}, without: {clear}");
}

#[test]
fn the_command_line_keeps_the_conventions() {
    let ask = |arguments: &[&str]| {
        let done = Command::new(built()).args(arguments).env_remove("DISPLAY").output().expect("the host runs");
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        (done.status.code(), text(done.stdout), text(done.stderr))
    };
    for (argument, wanted) in [("--help", "--precipitation"), ("--version", env!("CARGO_PKG_VERSION"))] {
        let (code, out, errors) = ask(&[argument]);
        assert!(code == Some(0) && out.contains(wanted) && errors.is_empty(), "{argument}: {code:?} {out} {errors}");
    }
    for (arguments, named) in [
        (["--no-such-option"].as_slice(), "--no-such-option"),
        (&["a.png"], "a.png"),
        (&["--msaa", "eight"], "eight"),
        (&["--frames"], "--frames"),
    ] {
        let (code, out, errors) = ask(arguments);
        assert!(code == Some(2) && errors.contains(named) && out.is_empty(), "{arguments:?}: {code:?} {out} {errors}");
    }
}

/// The tutorial's program, as it stands in the docs.
#[test]
fn the_tutorial_compiles_and_runs() {
    let host = Host::new("tutorial");
    let text = fs::read_to_string(root().join("docs/hosts-openscenegraph.md")).expect("the tutorial");
    let code = text.split("```cpp\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a program in it");
    let source = host.folder.join("rain.cpp");
    fs::write(&source, code).expect("the folder is ours");
    let mut flags = Command::new("pkg-config");
    flags.env("PKG_CONFIG_PATH", tree().join("lib/pkgconfig")).args(["--cflags", "--libs", "openscenegraph", "welkin"]);
    let flags = run(&mut flags);
    let mut cc = Command::new("g++");
    cc.args(["-std=c++17", "-Wall", "-Wextra", "-Werror", "-I"]).arg(root().join("examples/osg_host")).arg(&source);
    cc.arg("-o").arg(host.folder.join("rain")).args(flags.split_whitespace()).arg("-lGL");
    run(cc.arg(format!("-Wl,-rpath,{}", tree().join("lib").display())));
    let mut program = Command::new(host.folder.join("rain"));
    program.current_dir(&host.folder).env("DISPLAY", &host.server.display).env("OSG_RUN_FRAME_COUNT", "3");
    let said = run(&mut program);
    assert_eq!(said, "", "it has nothing to complain of");
    assert!(host.folder.join("weather-cache").is_dir(), "the sky's tables are kept for the next start");
}

/// Without OpenSceneGraph the build says why the host is skipped, and continues.
#[test]
fn without_openscenegraph_the_host_is_skipped_with_a_line() {
    built();
    let build = folder().join("without");
    let _ = fs::remove_dir_all(&build);
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(root().join("examples/osg_host")).arg("-B").arg(&build);
    cmake.arg(format!("-DCMAKE_PREFIX_PATH={}", tree().display()));
    let said = run(cmake.arg("-DCMAKE_DISABLE_FIND_PACKAGE_OpenSceneGraph=ON"));
    assert!(said.contains("osg_host is skipped") && said.contains(PACKAGE), "{said}");
    run(Command::new("cmake").arg("--build").arg(&build).args(["--parallel", "2"]));
}
