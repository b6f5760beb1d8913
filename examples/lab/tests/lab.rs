//! Tests of the lab: the basis of its charts and maps, that a stopped run continues, and that each failing method
//! fails.

use std::path::{Path, PathBuf};

use welkin::rain::{drops::relax, integrated::step};
use welkin_lab::{
    candidates::{Effect, candidate, candidates},
    chart, command, page, painted, peers,
    picture::Picture,
    plot, quadrature, rain, scenes, sky,
    stability::{self, Axis, Cell, Map, Panel, borders, numbers, particles, sky_maps},
    store::{Journal, Table},
    timing,
};

/// A temporary directory, removed afterwards.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("welkin-lab-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn run(arguments: &[&str]) -> welkin::Result<bool> {
    command::run(&arguments.iter().map(|a| (*a).to_owned()).collect::<Vec<_>>())
}

fn fields(row: &[&str]) -> Vec<String> {
    row.iter().map(|f| (*f).to_owned()).collect()
}

#[test]
fn a_stopped_run_is_continued_and_a_line_that_was_cut_is_measured_again() {
    let dir = Scratch::new("resume");
    let columns = ["name", "cost"];
    let mut first = Journal::open(&dir.0, "sky", "sky; full", &columns, false).unwrap();
    first.push(fields(&["a", "1"])).unwrap();
    first.push(fields(&["b", "2"])).unwrap();
    assert!(first.push(fields(&["wide", "2", "3"])).unwrap_err().to_string().contains("3 fields"));
    drop(first);
    let part = dir.0.join("sky.csv.part");
    let text = std::fs::read_to_string(&part).unwrap();
    std::fs::write(&part, text + "c,3").unwrap();

    let mut second = Journal::open(&dir.0, "sky", "sky; full", &columns, false).unwrap();
    assert!(second.has("a") && second.has("b") && !second.has("c"));
    second.push(fields(&["c", "4"])).unwrap();
    let (table, old) = second.finish().unwrap();
    assert_eq!(table.rows.len(), 3);
    assert!(old.is_none() && !part.exists());
    assert_eq!(Table::read(&dir.0.join("sky.csv")).unwrap().unwrap(), table);

    // A partial file of another machine is not continued.
    let mut other = Journal::open(&dir.0, "sky", "sky; full", &columns, false).unwrap();
    other.push(fields(&["a", "9"])).unwrap();
    drop(other);
    assert!(!Journal::open(&dir.0, "sky", "sky; quick", &columns, false).unwrap().has("a"));
    let (_, old) = Journal::open(&dir.0, "sky", "sky; quick", &columns, true).unwrap().finish().unwrap();
    assert_eq!(old.unwrap().rows.len(), 3);
}

#[test]
fn unknown_arguments_are_named_and_nothing_is_written() {
    let dir = Scratch::new("unknown");
    let out = dir.0.to_str().unwrap();
    for (arguments, says) in [
        (&["chart", "sea"][..], "unknown effect `sea`"),
        (&["compare", "directional", "best"], "best"),
        (&["compare", "directional", "exact"], "same effect"),
        (&["compare", "directional"], "two candidates"),
        (&["compare", "directional", "isotropic", "--scene", "moon"], "--scene"),
        (&["compare", "drops-100k", "cones", "--scene", "moon"], "one of light, steady"),
        (&["stability", "everything"], "quadrature"),
        (&["draw"], "unknown command"),
        (&["run"], "run needs the file"),
        (&["run", "no-such-file.csv"], "no-such-file.csv: no such file"),
        (&["chart", "sky", "--fast"], "--fast"),
        (&["chart", "--out"], "--out"),
        (&[], "usage"),
    ] {
        let mut all = arguments.to_vec();
        if !arguments.contains(&"--out") {
            all.extend(["--out", out]);
        }
        let e = run(&all).unwrap_err();
        assert!(e.to_string().contains(says), "{arguments:?}: {}", e);
        assert!(!dir.0.exists(), "{arguments:?} wrote something");
    }
}

#[test]
fn errors_of_pictures_are_relative_to_the_truth_as_exposed() {
    let picture = |f: f64| Picture {
        width: 16,
        height: 16,
        texels: (0..256).map(|i| [100.0 * f * (1.0 + 0.001 * f64::from(i)); 3]).collect(),
    };
    let truth = picture(1.0);
    let same = truth.figures(&truth).unwrap();
    assert!(same.luminance.worst == 0.0 && same.perceptual < 1e-6, "{same:?}");
    let brighter = picture(1.1).figures(&truth).unwrap();
    // Errors have a hundredth of white, which is the mean over 0.18, added to the denominator.
    let want = 0.1 / (1.0 + 0.01 / 0.18);
    assert!((brighter.luminance.median - want).abs() < 0.002, "{brighter:?}, {want}");
    assert!(brighter.perceptual > 0.001);
    // The brightness of the whole scene does not matter.
    let scaled = |p: Picture| Picture { texels: p.texels.iter().map(|t| t.map(|v| v * 1e-6)).collect(), ..p };
    let dim = scaled(picture(1.1)).figures(&scaled(truth)).unwrap();
    assert!((dim.luminance.p95 - brighter.luminance.p95).abs() < 1e-9);
}

#[test]
fn a_point_has_moved_when_its_spread_has_left_the_old_one() {
    let table = |rows: &[&[&str]]| Table {
        note: "x".into(),
        columns: fields(&["name", "family", "default", "cost", "cost_low", "cost_high", "ms", "p95"]),
        rows: rows.iter().map(|r| fields(r)).collect(),
    };
    let old = table(&[
        &["a", "f", "true", "1.0", "0.9", "1.1", "1", "0.01"],
        &["b", "f", "false", "1.0", "0.9", "1.1", "1", "0.01"],
        &["c", "f", "false", "1.0", "0.9", "1.1", "1", "0.01"],
    ]);
    let new = table(&[
        &["a", "f", "true", "1.05", "1.0", "1.2", "1", "0.01"],
        &["b", "f", "false", "2.0", "1.9", "2.1", "1", "0.01"],
        &["c", "f", "false", "1.0", "0.9", "1.1", "1", "0.02"],
        &["d", "f", "false", "1.0", "0.9", "1.1", "1", "0.02"],
    ]);
    let lines = chart::moved(&new, &old);
    assert_eq!(lines.len(), 3, "{lines:?}");
    assert!(lines[0].starts_with("b: cost") && lines[1].starts_with("c: error") && lines[2] == "d: new");
    let points = chart::points(&new, "cost");
    let front: Vec<&str> = points.iter().filter(|p| p.front).map(|p| p.name.as_str()).collect();
    assert!(points[0].default && front == ["a", "c", "d"], "{front:?}");
    let ratio = timing::Ratio::of(&[(2.0, 1.0), (6.0, 2.0), (1.0, 1.0)]);
    assert_eq!((ratio.median, ratio.low, ratio.high, ratio.ms), (2.0, 1.0, 3.0, 2.0));
}

#[test]
fn the_rule_with_an_offset_loses_its_last_step() {
    let medium = welkin::sky::reference::medium::Medium::of(&welkin::sky::Planet::earth());
    let exact = |mu| {
        let ray = welkin::sky::reference::ray::Ray::new(&medium, 2.0, mu);
        medium.transmittance(&ray.columns_to_space(&medium))[1]
    };
    let error = |rule: fn(&_, f64, f64, u32) -> f64, mu, n| (rule(&medium, 2.0, mu, n) / exact(mu) - 1.0f64).abs();
    for mu in [1.0, 0.3, 0.1] {
        let (usual, middle) =
            (error(sky_maps::offset_transmittance, mu, 40), error(sky_maps::midpoint_transmittance, mu, 40));
        assert!(usual > 5.0 * middle && usual > 0.005, "{mu}: {usual} {middle}");
        // First order: half the step gives half the error. The midpoint rule's error falls by a factor of four.
        let finer = error(sky_maps::offset_transmittance, mu, 80);
        assert!((1.6..2.4).contains(&(usual / finer)), "{mu}: {usual} {finer}");
    }
}

#[test]
fn differences_of_squares_lose_the_horizon() {
    let (radius, h) = (6_371_000.0f32, 1.7f32);
    let exact = (1.7f64 * (2.0 * 6_371_000.0 + 1.7)).sqrt();
    let usual = f64::from(numbers::horizon_by_squares(radius, h)) / exact - 1.0;
    let ours = f64::from(numbers::horizon_by_product(radius, h)) / exact - 1.0;
    assert!(usual.abs() > 0.01, "{usual}");
    assert!(ours.abs() < 1e-6, "{ours}");
    // On the wrong side of the horizon: a ray from 3 m that just clears the ground.
    let dip = (2.0f64 * 3.0 / 6_371_000.0).sqrt();
    let wrong = (1..40).filter(|i| {
        let mu = -(dip * (0.9 + 0.005 * f64::from(*i))).sin();
        sky_maps::naive_ground(radius, 3.0, mu as f32) != (mu < -dip.sin())
    });
    assert!(wrong.count() > 2);
}

#[test]
fn the_forward_peak_breaks_where_equal_numbers_are_subtracted() {
    let (g, angle) = (0.9999f32, 1e-4f64);
    let versine = 2.0 * (0.5 * angle).sin().powi(2);
    let exact = (1.0 - 0.9999f64.powi(2)) / ((1e-4f64).powi(2) + 2.0 * 0.9999 * versine).powf(1.5);
    let usual = f64::from(numbers::peak_usual(g, angle.cos() as f32));
    let ours = f64::from(numbers::peak_from_versine(g, versine as f32));
    assert!(!usual.is_finite() || (usual / exact - 1.0).abs() > 0.5, "{usual} {exact}");
    assert!((ours / exact - 1.0).abs() < 2e-3, "{ours} {exact}");
}

#[test]
fn standard_depth_and_far_origins_lose_precision_that_welkin_keeps() {
    let map = numbers::depth().unwrap();
    let at = |map: &Map, panel: usize, x: f64, y: f64| {
        let near = |values: &[f64], v: f64| {
            (0..values.len())
                .min_by(|a, b| (values[*a] / v).ln().abs().total_cmp(&(values[*b] / v).ln().abs()))
                .unwrap()
        };
        let i = near(&map.y.values, y) * map.x.values.len() + near(&map.x.values, x);
        if let Cell::Error(e) = map.panels[panel].cells[i] { e } else { f64::INFINITY }
    };
    let (standard, reversed) = (at(&map, 0, 1e4, 0.1), at(&map, 1, 1e4, 0.1));
    assert!(standard > 3e-3, "{standard}");
    assert!(reversed < 2e-7, "{reversed}");
    let map = numbers::origin().unwrap();
    let (usual, ours) = (at(&map, 0, 1e7, 10.0), at(&map, 1, 1e7, 10.0));
    assert!(usual > 0.02 && ours < 1e-6, "{usual} {ours}");
}

#[test]
fn explicit_drag_swings_then_diverges_and_steps_that_are_solved_do_not() {
    let [explicit, solved, stepped] = [(particles::euler as particles::Step, true), (relax, false), (step, true)]
        .map(|(step, square)| move |diameter, dt| particles::gust_cell(step, square, diameter, dt));
    // Where the drag time is long compared with the step, all methods are right.
    assert!(matches!(explicit(5.0, 1e-3), Cell::Error(e) if e < 5e-3), "{:?}", explicit(5.0, 1e-3));
    let small = |c: Cell, most: f64| matches!(c, Cell::Error(e) if e < most);
    for (diameter, dt) in [(0.1, 1e-3), (0.3, 1.0 / 60.0), (0.8, 0.1), (6.0, 1.0), (6.0, 10.0)] {
        let usual = explicit(diameter, dt);
        assert!(matches!(usual, Cell::Jumps | Cell::Diverged), "{diameter} mm, {dt} s: {usual:?}");
        assert!(small(solved(diameter, dt), 1e-6), "{diameter} mm, {dt} s: {:?}", solved(diameter, dt));
        assert!(small(stepped(diameter, dt), 0.1), "{diameter} mm, {dt} s: {:?}", stepped(diameter, dt));
    }
}

#[test]
fn velocity_times_time_throws_drops_and_the_displacement_does_not() {
    for (late, by) in [(1e6, 0.1), (1e6, 80.0), (100.0, 10.0)] {
        assert_eq!(particles::thrown_cell(late, by, particles::by_time).unwrap(), Cell::Jumps, "{late} s, {by} m/s");
        let ours = particles::thrown_cell(late, by, particles::by_displacement).unwrap();
        assert!(matches!(ours, Cell::Error(e) if e < 1e-6), "{late} s, {by} m/s: {ours:?}");
    }
}

/// In the committed rain maps, no method of Welkin's oscillates or diverges, and the usual one does.
#[test]
fn the_committed_maps_of_drops_show_where_the_usual_steps_fail() {
    for (name, panels, worst) in [("drag", 3, 0.1), ("gust", 2, 1e-3)] {
        assert!(["svg", "png"].iter().all(|e| committed(&format!("stability-{name}.{e}")).exists()));
        let cells = Table::read(&committed(&format!("stability-{name}.csv"))).unwrap().expect("committed");
        let of_ours = |r: &&Vec<String>| r[0].starts_with("Welkin");
        let titles: std::collections::BTreeSet<_> = cells.rows.iter().map(|r| &r[0]).collect();
        assert_eq!(titles.len(), panels, "{titles:?}");
        for row in cells.rows.iter().filter(of_ours) {
            let error: f64 = row[4].parse().unwrap_or(f64::INFINITY);
            assert!(row[3] == "error" && error < worst, "{name}: {row:?}");
        }
        let (usual, failed): (Vec<_>, Vec<_>) =
            cells.rows.iter().filter(|r| !of_ours(r)).partition(|r| r[3] == "error");
        assert!(failed.len() > usual.len(), "{name}: {} of {}", failed.len(), failed.len() + usual.len());
    }
}

/// In the committed cloud maps, every picture is finite, and the visible cover is the cover that was set.
#[test]
fn the_committed_maps_of_clouds_have_no_place_that_is_not_finite() {
    for (name, worst_median) in
        [("cloud-steps", 0.1), ("cloud-layers", 0.1), ("cloud-bases", 0.2), ("cloud-cover", 0.03)]
    {
        assert!(["svg", "png"].iter().all(|e| committed(&format!("stability-{name}.{e}")).exists()));
        let cells = Table::read(&committed(&format!("stability-{name}.csv"))).unwrap().expect("committed");
        let ours = cells.rows.iter().filter(|r| r[0].starts_with("Welkin") && r[3] != "nothing there");
        let mut errors = Vec::new();
        for row in ours {
            assert_eq!(row[3], "error", "{name}: {row:?}");
            errors.push(row[4].parse::<f64>().unwrap());
        }
        errors.sort_by(f64::total_cmp);
        assert!(errors.len() > 50 && errors[errors.len() / 2] < worst_median, "{name}: {errors:?}");
    }
}

/// In the committed chart of painted clouds, none comes near the default, whatever its cost.
#[test]
fn no_painted_cloud_of_the_committed_chart_is_near_the_default() {
    let table = Table::read(&committed("painted-clouds.csv")).unwrap().expect("committed");
    let error = |name: &str| table.number(table.row(name).expect(name), "p95").unwrap();
    let noise = error("truth-again");
    assert!(error("volume") < 0.1 * noise, "{} {noise}", error("volume"));
    for (name, paint) in painted::candidates() {
        if !matches!(paint, painted::Paint::Library(_) | painted::Paint::TruthAgain) {
            assert!(error(name) > 2.0 * noise, "{name}: {}", error(name));
        }
    }
}

#[test]
fn over_relaxation_ends_at_two() {
    assert!(particles::sor_residual(16, 1.7, 400) < 1e-9);
    assert!(particles::sor_residual(16, 1.95, 400) < 1e-3);
    assert!(particles::sor_residual(16, 2.0, 400) > 1e-2);
    assert!(particles::sor_residual(16, 2.05, 400) > 1.0);
}

#[test]
fn marches_of_public_code_are_not_finite_without_air_and_in_thin_shells() {
    for (factor, scale) in [(0.0, 8000.0), (1.0, 0.01), (1.0, 0.0)] {
        assert!(!sky_maps::usual_march(factor, scale).is_finite(), "{factor} {scale}");
    }
    assert!(sky_maps::usual_march(1.0, 8000.0).is_finite());
}

#[test]
fn a_timeline_does_not_depend_on_the_step() {
    let map = particles::time_steps().unwrap();
    let worst = |panel: &Panel| {
        let error = |c: &Cell| if let Cell::Error(e) = c { *e } else { f64::INFINITY };
        panel.cells.iter().map(error).fold(0.0, f64::max)
    };
    assert!(worst(&map.panels[0]).is_infinite());
    assert!(worst(&map.panels[1]) < 1e-12, "{}", worst(&map.panels[1]));
    assert!(borders("time-steps", &map).is_empty());
}

#[test]
fn a_border_is_named_where_a_method_is_accepted_and_wrong() {
    let (x, y) = (Axis::list("a", &[1.0, 2.0]), Axis::list("b", &[3.0]));
    let panel = |f: fn(f64, f64) -> Cell| Panel::of("ours", true, &x, &y, f);
    let panels = vec![
        panel(|a, _| if a > 1.5 { Cell::Error(0.5) } else { Cell::Error(0.0) }),
        panel(|a, _| if a > 1.5 { Cell::Refused } else { Cell::Error(0.0) }),
        panel(|_, _| Cell::NotFinite),
    ];
    let map = Map { title: "t", panels, tolerance: 0.1, x: Axis::list("a", &[1.0, 2.0]), y: Axis::list("b", &[3.0]) };
    let lines = borders("m", &map);
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(lines[0].contains("1 of 2") && lines[0].contains("a in 2 to 2"));
}

#[test]
fn labels_and_numbers_can_be_read() {
    assert_eq!([0.0123, 1.5, 20.0, 1234.0, 2e-5].map(plot::short), ["0.012", "1.5", "20", "1234", "2e-5"]);
    let axis = plot::LogAxis::over([1.0, 100.0].into_iter(), 0.0, 100.0);
    assert!((axis.at(10.0) - 50.0).abs() < 1e-9);
}

/// A map that needs no GPU, the page and the report, end to end.
#[test]
fn a_map_is_written_and_reported() {
    let dir = Scratch::new("map");
    let out = dir.0.to_str().unwrap();
    run(&["stability", "drag", "--quick", "--out", out]).unwrap();
    let has = |file: &str| Path::new(out).join(file).exists();
    assert!(has("stability-drag.svg") && has("stability-drag.png") && has("stability-drag.csv"));
    page::write(&dir.0).unwrap();
    run(&["report", "--out", out]).unwrap();
    let html = std::fs::read_to_string(dir.0.join("report.html")).unwrap();
    assert!(html.contains("<svg") && html.contains("explicit Euler") && !html.contains("src="));
    // A second run with another map keeps the first.
    run(&["stability", "over-relaxation", "--quick", "--out", out]).unwrap();
    let table = Table::read(&dir.0.join("stability.csv")).unwrap().unwrap();
    assert!(table.row("drag/0").is_some() && table.row("over-relaxation/1").is_some());
}

/// In rain, drops of different methods are in different places, so textures are compared. The figure has both pictures
/// and states the differences of blocks.
#[test]
fn two_ways_to_draw_rain_are_compared_block_by_block() {
    let dir = Scratch::new("compare");
    run(&["compare", "cones", "veil", "--scene", "light", "--out", dir.0.to_str().unwrap()]).unwrap();
    assert!(dir.0.join("compare-cones-veil-light.png").exists());
    let svg = std::fs::read_to_string(dir.0.join("compare-cones-veil-light.svg")).unwrap();
    for said in ["A: cones", "B: veil", "blocks from the truth: p95", "blocks between them: p95"] {
        assert!(svg.contains(said), "{said}");
    }
    let device = welkin::gpu::Device::headless(&Default::default()).unwrap();
    let steady = scenes::rain()[1];
    let mut host = rain::Host::new(&device, &steady, (80, 40)).unwrap();
    let veil = candidate(Effect::Rain, "veil").unwrap();
    let (a, b) = (host.drawn_by(&veil).unwrap(), host.drawn_by(&veil).unwrap());
    // Drawn twice the same way: nothing is brighter.
    assert!(a.brighter(&b, 1.0).iter().all(|d| d.abs() < 1e-9) && a.last == b.last);
    let of_last = |share: f64| {
        let mut blocks = rain::Blocks::new((80, 40));
        blocks.add(&a.last.iter().map(|y| share * y).collect::<Vec<_>>());
        blocks
    };
    let d = of_last(0.5).brighter(&of_last(1.0), 0.0);
    assert!(d.len() == 3200 && d.iter().all(|d| (d + 0.5).abs() < 1e-6), "{:?}", &d[..4]);
}

/// The committed charts contain today's candidates and show the expected results.
#[test]
fn the_committed_charts_are_complete_and_their_defaults_lie_on_the_front() {
    let read = |name: &str| Table::read(&committed(name)).unwrap().unwrap_or_else(|| panic!("{name} is not committed"));
    for (name, effect) in Effect::NAMES {
        let mut table = read(&format!("{name}.csv"));
        // The comparison of the truth with itself is not a way to draw.
        table.rows.retain(|r| r[0] != "truth-again");
        let charted: Vec<&str> = table.rows.iter().map(|r| r[0].as_str()).collect();
        let offered = candidates(effect);
        assert!(offered.iter().all(|c| charted.contains(&c.name)), "{name}: {charted:?}");
        assert_eq!(charted.len(), offered.len(), "{name}: {charted:?}");
        let points = chart::points(&table, "cost");
        if effect == Effect::Rain {
            // Drops alone are too few and too strong in the distance, whatever their number.
            let error = |name: &str| points.iter().find(|p| p.name == name).unwrap().error;
            assert!(["drops-400k", "veil"].iter().all(|n| error("drops-and-cones") < 0.8 * error(n)));
            assert!(error("drops-and-cones") < error("cones"));
            assert!(["source-20k", "source-140k"].iter().all(|n| error("drops-100k") < 0.5 * error(n)));
        }
        assert!(
            points.iter().any(|p| p.default && p.front),
            "{name}: something is cheaper and better than the default"
        );
    }
    let sky = read("sky.csv");
    let settings = |family: &str| sky.rows.iter().filter(|r| r[1] == family).count();
    for (family, least) in [("directional", 4), ("isotropic", 4), ("table3d", 4), ("march", 4), ("elek", 2)] {
        assert!(settings(family) >= least, "{family}: {}", settings(family));
    }
    // The rules of public code, at no more than the cost of the rule that Welkin uses.
    let rules = read("quadrature.csv");
    let number = |row: &[String], column: &str| rules.number(row, column).unwrap();
    for taken in rules.rows.iter().filter(|r| r[2] == "true") {
        let integral = taken[0].split('/').next().unwrap();
        let usual = ["offset-0.3", "midpoint", "trapezoid", "gauss-4"];
        let others = rules.rows.iter().filter(|r| r[0].starts_with(integral) && usual.contains(&r[1].as_str()));
        for other in others.filter(|r| number(r, "cost") <= number(taken, "cost")) {
            assert!(number(other, "p95") > number(taken, "p95"), "{} beats {}", other[0], taken[0]);
        }
    }
}

/// Path of a file of the committed lab.
fn committed(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/lab").join(name)
}

/// An error from a committed chart.
fn charted(chart: &str, row: &str, column: &str) -> f64 {
    let table = Table::read(&committed(chart)).unwrap().unwrap();
    table.number(table.row(row).unwrap(), column).unwrap()
}

/// Measures one row of the sky's chart again, against a coarser truth that is accurate to a fraction of the row's
/// error.
#[test]
fn the_committed_sky_chart_says_what_is_drawn_today() {
    let device = welkin::gpu::Device::headless(&Default::default()).unwrap();
    let scene = scenes::SKY.into_iter().find(|s| s.name == "noon").unwrap();
    let truth = sky::truth(&[scene], scene.air, sky::SIZE, true).unwrap().remove(0);
    for name in ["directional-eighth", "isotropic-eighth"] {
        let mut drawn = sky::make(&device, &candidate(Effect::Sky, name).unwrap()).unwrap();
        drawn.rebuild(&scene.air.planet()).unwrap();
        let pixels = sky::pixels(&scene, sky::SIZE);
        let veils = drawn.veils(&scene, &pixels).unwrap();
        let picture = sky::compose(&scene, &pixels, &veils, truth.ground, sky::SIZE);
        let now = picture.figures(&truth.picture).unwrap().luminance.p95;
        let then = charted("sky.csv", name, "p95_noon");
        println!("{name}: {now:.5}, charted {then:.5}");
        assert!((now / then - 1.0).abs() < 0.1, "{name} errs by {now} at noon, the chart says {then}");
    }
}

#[test]
fn the_committed_quadrature_chart_says_what_is_drawn_today() {
    let device = welkin::gpu::Device::headless(&Default::default()).unwrap();
    for (rule, n) in [("offset-0.3", 20), ("midpoint", 32)] {
        let now = quadrature::transmittance_error(&device, rule, n).unwrap().p95;
        let then = charted("quadrature.csv", &format!("transmittance/{rule} {n}"), "p95");
        assert!((now / then - 1.0).abs() < 0.02, "{rule} {n} errs by {now}, the chart says {then}");
    }
}

/// Computes the maps that need no GPU again.
#[test]
fn the_committed_maps_say_what_is_computed_today() {
    let table = Table::read(&committed("stability.csv")).unwrap().unwrap();
    let maps = [
        ("horizon-distance", numbers::horizon_distance()),
        ("phase", numbers::phase()),
        ("depth", numbers::depth().unwrap()),
        ("origin", numbers::origin().unwrap()),
        ("drag", particles::drag()),
        ("gust", particles::gust().unwrap()),
        ("over-relaxation", particles::over_relaxation()),
        ("time-steps", particles::time_steps().unwrap()),
    ];
    for (name, map) in maps {
        for (i, panel) in map.panels.iter().enumerate() {
            let now = stability::summary(name, i, panel);
            let then = table.row(&now[0]).unwrap_or_else(|| panic!("{} is not committed", now[0]));
            // All but the date: key, method, counts by kind, median and worst error.
            assert_eq!(now[..9], then[..9], "{name}");
            for k in 9..11 {
                let [a, b] = [&now[k], &then[k]].map(|v| v.parse::<f64>().unwrap());
                assert!((a - b).abs() <= 0.02 * b + 1e-9, "{}: {a}, the map says {b}", now[0]);
            }
        }
    }
}

/// Measures one row of the rain's chart again, in the same way.
#[test]
fn the_committed_rain_chart_says_what_is_drawn_today() {
    let device = welkin::gpu::Device::headless(&Default::default()).unwrap();
    let light = scenes::rain()[0];
    let mut host = rain::Host::new(&device, &light, rain::SIZE).unwrap();
    let start = std::time::Instant::now();
    let truth = host.truth(1).unwrap();
    println!("truth in {:?}", start.elapsed());
    for name in ["veil", "cones"] {
        let mut errors = host.drawn_by(&candidate(Effect::Rain, name).unwrap()).unwrap().errors(&truth.0, truth.1);
        errors.sort_by(f64::total_cmp);
        let now = welkin::plan::difference::percentile(&errors, 0.95);
        let then = charted("rain.csv", name, &format!("p95_{}", light.name));
        println!("{name}: {now:.5}, charted {then:.5}; {:?}", start.elapsed());
        assert!((now / then - 1.0).abs() < 0.05, "{name} errs by {now}, the chart says {then}");
    }
}

#[test]
fn the_table_of_peers_agrees_with_the_charts() {
    let table = Table::read(&committed("peers.csv")).unwrap().unwrap();
    let number = |name: &str, when: &str, column: &str| {
        let row = table.rows.iter().find(|r| r[0] == name && r[1] == when).unwrap_or_else(|| panic!("{name}, {when}"));
        table.number(row, column).unwrap_or_else(|| panic!("{name}, {when}: {column}"))
    };
    for (name, chart, default) in
        [("rain of 5 mm/h", "rain.csv", "drops-and-cones"), ("broken cumulus", "clouds.csv", "volume-double-steps")]
    {
        let (said, charted) = (number(name, "now", "error"), charted(chart, default, "p95"));
        assert!((said / charted - 1.0).abs() < 0.01, "{name}: {said}, charted {charted}");
    }
    for row in table.rows.iter().filter(|r| r[1] == "before") {
        let cost = |when, column| number(&row[0], when, column);
        assert!(cost("now", "cost_high") < cost("before", "cost_low"), "{}", row[0]);
    }
    let mut page = String::new();
    peers::section(&mut page, &table);
    assert!(page.contains("| sky and air | 13.6 to 14.6 (9 %) | 44 to 50 (1.1 %) | 11.4 to 11.8 (1.1 %) |"), "{page}");
}

/// Runs the chart of fog, the cheapest one, from start to end on the software driver.
#[test]
fn no_fog_of_the_chart_is_better_than_the_default() {
    let dir = Scratch::new("fog");
    run(&["chart", "fog", "--quick", "--out", dir.0.to_str().unwrap()]).unwrap();
    let table = Table::read(&dir.0.join("fog.csv")).unwrap().unwrap();
    let error = |name: &str| table.number(table.row(name).unwrap(), "p95").unwrap();
    assert!(error("exact") < 1e-4 && error("exact") < error("froxels-64"));
    assert!(error("froxels-64") < error("froxels-16") && error("froxels-16") < error("exponential"));
    // The committed chart must match today's shaders, because errors do not depend on the machine.
    let committed = Table::read(&committed("fog.csv")).unwrap().unwrap();
    for row in &table.rows {
        let (now, then) = (error(&row[0]), committed.number(committed.row(&row[0]).unwrap(), "p95").unwrap());
        assert!((now - then).abs() < 0.05 * then + 1e-6, "fog: {} errs by {now}, the chart says {then}", row[0]);
    }
    // No candidate is more accurate; which one is cheaper depends on how busy the machine is.
    let points = chart::points(&table, "cost");
    let default = points.iter().find(|p| p.default).unwrap();
    assert!(points.iter().all(|p| p.error >= default.error));
}

/// The sheet in the manual is what the command draws.
#[test]
fn the_sheet_of_mistakes_with_heights_is_drawn_by_the_lab() {
    let dir = Scratch::new("heights");
    run(&["heights", "--out", dir.0.to_str().unwrap()]).unwrap();
    let pixels = |path: PathBuf| image::open(path).unwrap().into_rgb8();
    assert!(pixels(dir.0.join("heights.png")) == pixels(committed("heights.png")), "run `lab heights`");
}

#[test]
fn a_run_is_charted_and_a_file_without_frames_is_refused() {
    let dir = Scratch::new("run");
    std::fs::create_dir_all(&dir.0).unwrap();
    let (file, out) = (dir.0.join("frames.csv"), dir.0.join("lab"));
    let head = "frame,segment,time_s,settled,wall_ms,submitted_ms,processor_ms,copy_ms,rest_ms,base_ms,cause";
    let frame = |i: u32, segment: &str, settled: u8, wall: f64, cause: &str| {
        format!("{i},{segment},0.1,{settled},{wall},1,1,0.7,8,10,{cause}")
    };
    let rows = [
        frame(0, "clear", 1, 8.0, ""),
        frame(1, "clear", 1, 12.0, ""),
        frame(2, "light rain", 0, 40.0, "pipeline + upload"),
        frame(3, "light rain", 0, 16.0, "gauge"),
        frame(4, "light rain", 1, 9.0, ""),
    ];
    std::fs::write(&file, format!("# run; quick; a driver\n{head}\n{}\n", rows.join("\n"))).unwrap();
    let run_file = || run(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(run_file().unwrap());
    let page = std::fs::read_to_string(out.join("README.md")).unwrap();
    assert!(page.contains("| clear | 8 | 8 | 0.8 | 1.2 | 1 |  |\n"), "{page}");
    assert!(page.contains("| light rain | 8 | 16 | 1.6 | 4 | 1.1 | 1 pipeline, 1 other |\n"), "{page}");
    assert!(page.contains("Measured: run; quick; a driver; 2"), "{page}");
    let chart = std::fs::read_to_string(out.join("run.svg")).unwrap();
    assert!(chart.contains("light rain") && out.join("run.png").exists());

    for (text, says) in [
        ("frame,segment\n1,clear\n".to_owned(), "no column settled"),
        (format!("{head}\n"), "no row"),
        (format!("{head}\n{}\n", frame(7, "clear", 1, -1.0, "")), "wall_ms of frame 7 is `-1`"),
        (format!("{head}\n{}\n", frame(7, "clear", 1, f64::NAN, "")), "wall_ms of frame 7 is `NaN`"),
        (format!("{head}\n{}\n", frame(7, "clear", 1, 8.0, "")), "the first line"),
    ] {
        std::fs::write(&file, text).unwrap();
        let fault = run_file().unwrap_err().to_string();
        assert!(fault.contains(says), "{fault}");
        assert_eq!(std::fs::read_to_string(out.join("README.md")).unwrap(), page, "the page is as it was");
    }
}
