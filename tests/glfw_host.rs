//! The C OpenGL host as users build and run it: compiled without a warning, run without a display, its pictures
//! checked; and its window on an X server without a screen. `WELKIN_LIB` names a ready library; without it the tests
//! build one.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use welkin_support::{c_library, x_server::Server};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

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

/// Compiles the host, once for all tests. They are processes of their own: the first locks the others out.
fn program() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("glfw_host");
    fs::create_dir_all(&folder).expect("the target directory is writable");
    let lock = fs::File::create(folder.join("lock")).expect("the folder is ours");
    lock.lock().expect("the other tests let go");
    let (program, library) = (folder.join("glfw_host"), library());
    let listed = |folder: &str| {
        let listed = fs::read_dir(root().join(folder)).expect("a folder of the repository");
        listed.map(|e| e.expect("a file").path()).collect::<Vec<_>>()
    };
    let (sources, headers) = (listed("examples/glfw_host"), listed("include"));
    let age = |path: &PathBuf| fs::metadata(path).and_then(|m| m.modified()).ok();
    let newest = sources.iter().chain(&headers).chain([&library]).map(age).max().expect("files");
    if age(&program) > newest {
        return program;
    }
    for link in ["libwelkin.so", "libwelkin.so.1"] {
        let _ = fs::remove_file(folder.join(link));
        std::os::unix::fs::symlink(&library, folder.join(link)).expect("the folder is writable");
    }
    let flags = run(Command::new("pkg-config").args(["--cflags", "--libs", "glfw3", "egl", "libpng"]));
    let mut cc = Command::new("gcc");
    cc.args(["-std=c11", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I"]).arg(root().join("include"));
    cc.args(sources.iter().filter(|p| p.extension().is_some_and(|e| e == "c")));
    cc.arg("-o").arg(&program).arg("-L").arg(&folder).arg("-lwelkin").args(flags.split_whitespace()).arg("-lm");
    run(cc.arg(format!("-Wl,-rpath,{}", folder.display())));
    program
}

/// The host and a folder of one test's own, removed with the value.
struct Host {
    program: PathBuf,
    folder: PathBuf,
}

impl Host {
    fn build(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("glfw_host-{name}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("the target directory is writable");
        Self { program: program(), folder }
    }

    fn command(&self) -> Command {
        let mut host = Command::new(&self.program);
        host.arg("--data").arg(root().join("examples/data")).arg("--out").arg(&self.folder).args(["--size", "640x360"]);
        host.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        host
    }

    /// One of the pictures it wrote.
    fn picture(&self, name: &str) -> image::RgbImage {
        image::open(self.folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}")).into_rgb8()
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Mean of red, green and blue over a rectangle.
fn mean(picture: &image::RgbImage, [x0, y0, x1, y1]: [u32; 4]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for y in y0..y1 {
        for x in x0..x1 {
            (0..3).for_each(|c| sum[c] += f64::from(picture.get_pixel(x, y)[c]));
        }
    }
    sum.map(|s| s / f64::from((x1 - x0) * (y1 - y0)))
}

/// Returns the largest difference of green along a row: the contrast there.
fn contrast(picture: &image::RgbImage, y: u32) -> u8 {
    let row = (0..picture.width()).map(|x| picture.get_pixel(x, y)[1]);
    let (lo, hi) = row.fold((255, 0), |(lo, hi): (u8, u8), v| (lo.min(v), hi.max(v)));
    hi - lo
}

const SKY: [u32; 4] = [0, 0, 200, 60];
const MEADOW: [u32; 4] = [440, 260, 640, 350];

#[test]
fn clear_weather_is_blue_at_noon_red_at_sunset_and_dark_by_the_moon() {
    let host = Host::build("clear");
    let said = run(host.command().args(["--report", "1"]));
    assert!(said.contains("adapter: ") && said.contains("ms a frame") && said.contains("contact_sheet.png"), "{said}");
    let sheet = host.picture("contact_sheet.png");
    assert!(sheet.width() > 1600 && sheet.height() > 200);

    let (noon, sunset, night) =
        (host.picture("01_noon.png"), host.picture("01_sunset.png"), host.picture("01_moonlight.png"));
    let (sky, low, dark) = (mean(&noon, SKY), mean(&sunset, [250, 120, 640, 160]), mean(&night, SKY));
    assert!(sky[2] > sky[0] + 20.0 && sky[2] > 120.0, "a blue sky, got {sky:?}");
    assert!(low[0] > low[2] + 20.0, "a red horizon, got {low:?}");
    assert!(dark[2] > 1.0 && dark[2] < 0.5 * sky[2], "a night that is dark and not black, got {dark:?}");
    // The host's own ground is lit by the light that Welkin's query returns: darker at sunset than at noon, but still
    // with visible relief.
    let (day, evening) = (mean(&noon, MEADOW), mean(&sunset, MEADOW));
    assert!(day[1] > 60.0 && day[1] > day[2] && evening[1] > 5.0 && evening[1] < 0.8 * day[1], "{day:?} {evening:?}");
    // Hills about ten kilometres away are paler than the meadow, and visible.
    assert!(mean(&noon, [0, 172, 200, 186])[2] > day[2] + 20.0);
}

#[test]
fn a_planet_file_gives_the_host_another_sky() {
    let host = Host::build("planet");
    let dusty = root().join("examples/data/planet_dusty.toml");
    run(host.command().args(["--report", "1", "--planet"]).arg(dusty));
    let sky = mean(&host.picture("01_noon.png"), SKY);
    assert!(sky[1] > 100.0 && sky[2] < sky[0] + 5.0, "under dust no sky is blue, got {sky:?}");
    let missing = host.command().args(["--planet", "nowhere.toml"]).output().expect("the host runs");
    let said = String::from_utf8_lossy(&missing.stderr).into_owned();
    assert!(!missing.status.success() && said.contains("nowhere.toml: cannot be read"), "{said}");
}

#[test]
fn fog_hides_what_is_beyond_its_visibility_and_not_the_excavator() {
    let host = Host::build("fog");
    run(host.command().args(["--report", "7"]));
    let fog = host.picture("07_noon.png");
    // The excavator is 45 m away, the reported visibility 150 m; under fog no sun makes it glare.
    assert!(contrast(&fog, 285) > 30, "the excavator shows: {}", contrast(&fog, 285));
    // Hills and the posts from 1 km on are gone: what is left is the fog's own slow change.
    let far = mean(&fog, [380, 165, 400, 175]);
    for x in [300, 340, 420, 460] {
        let beside = mean(&fog, [x, 165, x + 20, 175]);
        assert!((0..3).all(|c| (far[c] - beside[c]).abs() < 6.0), "{x}: {beside:?} against {far:?}");
    }
    assert!(far[1] > 100.0, "fog at noon is bright, got {far:?}");
}

/// A vessel lies on the sea, with its deck above the water.
#[test]
fn a_vessel_floats_on_the_sea() {
    let host = Host::build("sea");
    run(host.command().args(["--sea", "--report", "3", "--size", "320x180"]));
    let noon = host.picture("03_noon.png");
    let (sky, sea) = (mean(&noon, [0, 0, 320, 60]), mean(&noon, [0, 130, 320, 180]));
    assert!(sea[2] > sea[0] + 20.0 && sea[1] < 0.7 * sky[1], "a blue sea under the sky: {sea:?} {sky:?}");
    let house = mean(&noon, [164, 88, 184, 96]);
    assert!(house[0] > 120.0 && house[2] < house[0] + 30.0, "a white house: {house:?}");
    let crane = noon.enumerate_pixels().filter(|(_, _, p)| p[0] > p[2].saturating_add(40)).count();
    assert!(crane > 15, "an orange crane: {crane} pixels");
}

/// Welkin draws the heights of a file where they are: a cliff to the east of a plain. Files that are no grid of heights
/// are refused by what is wrong with them.
#[test]
fn heights_of_a_file_are_drawn_by_welkin() {
    let host = Host::build("terrain");
    let file = host.folder.join("cliff.asc");
    let heights = |low: &str| format!("{low} ").repeat(154) + &"140 ".repeat(146) + "\n";
    let grid =
        |low: &str| "ncols 300\nnrows 300\nxllcorner 5000\ncellsize 10\n".to_string() + &heights(low).repeat(300);
    fs::write(&file, grid("100")).expect("the folder is ours");
    let at = |path: &Path| {
        let mut command = host.command();
        command.arg("--terrain").arg(path).args(["--report", "1", "--size", "320x180"]);
        command
    };
    run(&mut at(&file));
    let noon = host.picture("01_noon.png");
    let (sky, plain, cliff) =
        (mean(&noon, [0, 0, 160, 60]), mean(&noon, [0, 130, 160, 180]), mean(&noon, [280, 20, 320, 90]));
    assert!(sky[2] > sky[0] + 30.0, "a blue sky: {sky:?}");
    assert!(plain[1] > plain[2] + 10.0, "a green plain: {plain:?}");
    assert!(cliff[2] < sky[2] - 20.0 && (cliff[0] - cliff[1]).abs() < 25.0, "a grey cliff: {cliff:?}");
    for (text, named) in [
        ("ncols 2\nnrows 2\n1 2 3 4\n", "cellsize above 0"),
        ("ncols 2\nnrows 2\ncellsize 5\n1 2 3\n", "3 of 4 heights"),
        ("ncols 2\nnrows 2\ncellsize 5\nNODATA_value 7\n7 7 7 7\n", "0 are known"),
        ("ncolumns 2\n", "\"ncolumns\" is no word"),
        ("ncols 2\nnrows 2\ncellsize 5\n1 2 3 200000\n", "heights_m"),
    ] {
        fs::write(&file, text).expect("the folder is ours");
        let refused = at(&file).output().expect("the host runs");
        let errors = String::from_utf8_lossy(&refused.stderr);
        assert!(refused.status.code() == Some(1) && errors.contains(named), "{text}: {errors}");
    }
    let refused = at(&host.folder.join("none.asc")).arg("--sea").output().expect("the host runs");
    assert!(refused.status.code() == Some(2), "{}", String::from_utf8_lossy(&refused.stderr));
}

/// The gallery's pictures have the size that was asked for or half of it, smooth edges, and in them what only they
/// have: lamps, a bridge.
#[test]
fn the_gallery_has_smooth_edges_lamps_and_a_bridge() {
    let host = Host::build("gallery");
    // Both pictures are written at half the size.
    for name in ["work_lights", "under_the_bridge"] {
        let said = run(host.command().args(["--size", "640x360", "--gallery", name]));
        assert_eq!(said.matches(".png: ").count(), 1, "each picture is said as it is made: {said}");
    }
    let [lamps, bridge] = ["work_lights.png", "under_the_bridge.png"].map(|name| host.picture(name));
    assert!([&lamps, &bridge].iter().all(|p| p.dimensions() == (320, 180)));
    // The deck's underside is dark before a bright sky; pixels on the edge between them have a part of both.
    let column = |y: u32| bridge.get_pixel(150, y)[0];
    assert!(column(44) < 80 && column(64) > 170, "a deck before the sky: {} {}", column(44), column(64));
    let edge = (45..60).flat_map(|y| (0..320).map(move |x| (x, y)));
    let between = edge.filter(|(x, y)| (80..170).contains(&bridge.get_pixel(*x, *y)[0])).count();
    assert!(between > 120, "one sample a pixel leaves a score of them, four some hundred: {between}");
    // The ground in the lamps' beams is lit; the top of the picture is dark.
    let (work, night) = (mean(&lamps, [70, 100, 100, 112]), mean(&lamps, [0, 0, 320, 10]));
    assert!(work[1] > 120.0 && night[1] < 60.0, "{work:?} before {night:?}");
    let mut unknown = host.command();
    let unknown = unknown.args(["--gallery", "volcano"]).output().expect("the host runs");
    let said = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert!(!unknown.status.success() && said.contains("under_the_bridge"), "the names that there are: {said}");
}

/// The gallery's page shows each of its pictures, and `docs/gallery` holds no others but the OpenSceneGraph host's.
#[test]
fn the_page_shows_the_gallery() {
    let page = fs::read_to_string(root().join("docs/gallery.md")).expect("the gallery's page");
    let shots = fs::read_to_string(root().join("examples/glfw_host/shots.c")).expect("the shots");
    let shots = shots.split("SHOTS[] = {").nth(1).expect("a table");
    let names = shots.lines().filter_map(|l| l.trim().strip_prefix("{\"")?.split('"').next());
    let mut shown: Vec<String> = names.map(|name| format!("{name}.png")).collect();
    assert!(shown.len() > 20, "{shown:?}");
    shown.extend(["osg_host.png", "osg_precipitation.png", "osg_cab.png"].map(str::to_owned));
    assert!(shown.iter().all(|name| page.contains(&format!("(gallery/{name})"))), "{shown:?}");
    let files = fs::read_dir(root().join("docs/gallery")).expect("the gallery").map(|f| f.expect("a file"));
    let (mut found, mut bytes) = (Vec::new(), 0);
    for file in files {
        bytes += file.metadata().expect("a file").len();
        found.push(file.file_name().into_string().expect("a name"));
    }
    found.sort();
    shown.sort();
    assert_eq!(found, shown);
    assert!(bytes < 10_000_000, "the gallery has {bytes} bytes: every clone carries them");
}

#[test]
fn a_window_opens_draws_and_closes() {
    let host = Host::build("window");
    let server = Server::start();
    let mut window = host.command();
    window.env("DISPLAY", &server.display).args(["--frames", "3"]);
    let output = window.output();
    let output = output.expect("the host runs");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("adapter: ") && said.contains("last frame: "), "{output:?}");
}
