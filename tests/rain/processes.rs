//! Channels of a simulator: processes with the same inputs draw the same drops, whenever each of them began and by
//! whatever steps it reached its time and place.
//!
//! A test starts this binary again for each further channel; the environment gives the channel's name and a file for
//! its result.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    process::Command,
};

use glam::{DMat4, DVec2, DVec3, DVec4};
use welkin::{
    frame::Stages,
    gpu::{Device, DeviceOptions},
    rain::{
        Classes, RainModel, RainSettings,
        lattice::{self, Drop, SPEED_UNIT},
    },
    weather::{Weather, derive},
};
use welkin_support::rain_scene::{Host, NEAR_M, rain};

use crate::{
    drops::{WHITE, night},
    streaks::{LEAST_PIXELS, Streak, alone, distance},
};

const CHANNEL: &str = "WELKIN_TEST_CHANNEL";
const ANSWER: &str = "WELKIN_TEST_ANSWER";
const SIZE: (u32, u32) = (480, 320);
const SHUTTER_S: f64 = 3e-3;
const MOST: u32 = 100_000;
const SEED: u64 = 11;
/// Times at which neighbouring channels are compared, s.
const MOMENTS: [f64; 16] =
    [95.25, 95.6, 96.0, 96.4, 97.1, 97.5, 98.0, 98.3, 98.8, 99.2, 101.3, 102.9, 104.7, 107.1, 1234.5, 86_400.1];

/// Large drops, which are wider than a pixel.
fn shower() -> Weather {
    let mut weather = rain(60.0, 5.0);
    weather.precipitation.showers = true;
    weather
}

/// Sets the inputs of all channels: a strong wind that weakens while the rain strengthens.
fn tell(host: &mut Host) {
    host.context.set_weather(&rain(12.0, 13.0), 0.0, 0.0).unwrap();
    host.context.set_weather(&rain(20.0, 8.0), 10.0, 5.0).unwrap();
    host.context.set_weather(&shower(), 40.0, 30.0).unwrap();
    host.view
        .set_rain(RainSettings {
            model: RainModel::Drops,
            shutter_s: SHUTTER_S,
            most_drops: Some(MOST),
            ..RainSettings::default()
        })
        .unwrap();
}

fn classes() -> Classes {
    Classes::new(&derive(&shower()).unwrap().precipitation, 1.0, MOST)
}

/// Projection with reversed infinite depth between the tangents of the angles left and right, down and up.
fn off_axis([left, right]: [f64; 2], [down, up]: [f64; 2]) -> DMat4 {
    let (w, h) = (right - left, up - down);
    DMat4::from_cols(
        DVec4::new(2.0 / w, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 / h, 0.0, 0.0),
        DVec4::new((right + left) / w, (up + down) / h, 0.0, -1.0),
        DVec4::new(0.0, 0.0, NEAR_M, 0.0),
    )
}

/// One of two projectors side by side, each with its own eye position.
#[derive(Clone, Copy)]
struct Projector {
    eye: DVec3,
    projection: DMat4,
}

fn projectors() -> [Projector; 2] {
    let at = |x: f64, across| Projector { eye: DVec3::new(x, 0.0, 300.0), projection: off_axis(across, [-0.06, 0.06]) };
    [at(0.0, [-0.15, 0.03]), at(0.02, [-0.03, 0.15])]
}

impl Projector {
    fn of(self, host: &mut Host) {
        host.look(self.eye, DVec3::Y);
        host.camera.projection = self.projection;
    }

    /// Pixel of a point of the world, and its distance along the view.
    fn pixel(&self, host: &Host, world: DVec3) -> (DVec2, f64) {
        let p = self.projection * (host.camera.rotation() * (world - self.eye)).extend(1.0);
        let ndc = DVec2::new(p.x, p.y) / p.w;
        (DVec2::new(0.5 * ndc.x + 0.5, 0.5 - 0.5 * ndc.y) * DVec2::new(f64::from(SIZE.0), f64::from(SIZE.1)), p.w)
    }

    /// The point of the world at a pixel and a distance along the view.
    fn world(&self, pixel: DVec2, distance: f64) -> DVec3 {
        let part = pixel / DVec2::new(f64::from(SIZE.0), f64::from(SIZE.1));
        let ndc = DVec2::new(2.0 * part.x - 1.0, 1.0 - 2.0 * part.y);
        let m = self.projection;
        let tangent = DVec2::new((ndc.x + m.z_axis.x) / m.x_axis.x, (ndc.y + m.z_axis.y) / m.y_axis.y);
        self.eye + DVec3::new(tangent.x, 1.0, tangent.y) * distance
    }

    fn sees(&self, host: &Host, world: DVec3, shell: u32) -> bool {
        let (at, w) = self.pixel(host, world);
        let inside = (0.0..f64::from(SIZE.0)).contains(&at.x) && (0.0..f64::from(SIZE.1)).contains(&at.y);
        w > NEAR_M && inside && lattice::shell_share(shell as usize, (world - self.eye).length()) > 0.0
    }
}

/// Every drop of this context round an eye at its time.
fn drops(host: &Host, eye: DVec3) -> Vec<Drop> {
    let t = host.context.time_s();
    lattice::drops(&classes(), SEED, eye, host.context.wind_displacement(t).unwrap(), t).collect()
}

type Id = (u32, u32, u32);

/// Drops in the picture that no other comes near: the pixel where each is dark, and its distance along the view.
fn measured(host: &Host, own: &Projector, pixels: &[f64]) -> BTreeMap<Id, (DVec2, f64)> {
    let wind = host.context.carrying_wind(host.context.time_s()).unwrap();
    let table = classes().table;
    let (mut streaks, mut distances) = (Vec::new(), Vec::new());
    for drop in drops(host, own.eye).into_iter().filter(|d| d.share > 0.0) {
        let speed = f64::from(table[drop.id.1 as usize][1]) * SPEED_UNIT;
        let half = (wind - DVec3::Z * speed) * (0.5 * SHUTTER_S);
        let [a, b] = [-half, half].map(|h| own.pixel(host, own.eye + drop.position_m + h));
        if a.1.min(b.1) > 0.05 {
            let pixel_m = 0.12 / f64::from(SIZE.1) * drop.position_m.length();
            let end = 0.5 * (drop.diameter_m / pixel_m).max(LEAST_PIXELS);
            streaks.push(Streak { id: drop.id, middle: 0.5 * (a.0 + b.0), half: 0.5 * (b.0 - a.0), end });
            distances.push(own.pixel(host, own.eye + drop.position_m).1);
        }
    }
    let mut found = BTreeMap::new();
    for (streak, distance_m) in streaks.iter().zip(distances) {
        let reach = streak.half.abs() + 2.0 * streak.end + 3.0;
        let (low, high) = (streak.middle - reach, streak.middle + reach);
        let inside = low.min_element() >= 0.0 && high.x < f64::from(SIZE.0) && high.y < f64::from(SIZE.1);
        if !inside || !alone(streak, &streaks) {
            continue;
        }
        let (mut sum, mut at) = (0.0, DVec2::ZERO);
        for (x, y) in (low.x as u32..=high.x as u32).flat_map(|x| (low.y as u32..=high.y as u32).map(move |y| (x, y))) {
            let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            if distance(streak, p) < 2.0 * streak.end + 2.0 {
                let dark = 1.0 - pixels[(y * SIZE.0 + x) as usize];
                (sum, at) = (sum + dark, at + dark * p);
            }
        }
        // Fainter drops are lost in the steps of half floats.
        if sum > 0.3 && streak.half.length() > 5.0 && streak.end > 1.15 {
            found.insert(streak.id, (at / sum, distance_m));
        }
    }
    found
}

fn picture(host: &mut Host) -> Vec<f64> {
    host.draw(|_, _| [WHITE; 3]);
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    host.pixels().iter().map(|p| f64::from(p[1]) / WHITE).collect()
}

/// One channel's result, as text: its drops in both pictures' overlap, where its picture shows them, and its state.
fn channel(name: &str) -> String {
    let [left, right] = projectors();
    let (own, other) = if name == "left" { (left, right) } else { (right, left) };
    // The two run on different drivers, and reach the same time in different steps.
    let backends = if name == "left" { wgpu::Backends::VULKAN } else { wgpu::Backends::GL };
    let device = Device::headless(&DeviceOptions { backends, ..Default::default() }).unwrap();
    let mut host = night(Host::on(device, SIZE));
    tell(&mut host);
    if name == "left" {
        (0..2857).for_each(|i| host.context.update(f64::from(i) / 30.0).unwrap());
    }
    own.of(&mut host);
    let mut text = String::new();
    for t in MOMENTS {
        host.context.update(t).unwrap();
        let pixels = picture(&mut host);
        text += &format!("state {t} {:016x}\n", host.context.state_hash().unwrap());
        for d in drops(&host, own.eye) {
            let world = own.eye + d.position_m;
            if own.sees(&host, world, d.id.0) && other.sees(&host, world, d.id.0) {
                text += &format!("drop {t} {:?} {:?}\n", d.id, d.place);
            }
        }
        for ((shell, class, index), (at, distance)) in measured(&host, &own, &pixels) {
            text += &format!("seen {t} {shell} {class} {index} {} {} {distance}\n", at.x, at.y);
        }
    }
    text
}

/// Path of a file that only channel `name` of the test `test` uses, for tests run in parallel.
fn answer_file(test: &str, name: &str) -> PathBuf {
    let test = test.rsplit("::").next().unwrap();
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{test}_{name}.txt"))
}

/// Runs the test `test` of this binary as channel `name` in its own process, and returns what that wrote.
fn run(test: &str, name: &str) -> String {
    let answer = answer_file(test, name);
    let _ = std::fs::remove_file(&answer);
    let done = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--nocapture"])
        .env(CHANNEL, name)
        .env(ANSWER, &answer)
        .output()
        .unwrap();
    assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
    std::fs::read_to_string(answer).unwrap()
}

/// Writes the result of `channel` and returns true, if this is a process that [`run`] started.
fn is_channel(channel: impl Fn(&str) -> String) -> bool {
    let (Ok(name), Ok(answer)) = (std::env::var(CHANNEL), std::env::var(ANSWER)) else { return false };
    std::fs::write(answer, channel(&name)).unwrap();
    true
}

fn lines<'a>(text: &'a str, kind: &str) -> Vec<&'a str> {
    text.lines().filter_map(|l| l.strip_prefix(kind)).collect()
}

/// Pixel and distance of each measured drop, by the index of the moment and the drop's id.
fn seen(text: &str) -> BTreeMap<(usize, Id), (DVec2, f64)> {
    let entry = |line: &str| {
        let v: Vec<f64> = line.split_whitespace().map(|n| n.parse().unwrap()).collect();
        let moment = MOMENTS.iter().position(|t| *t == v[0]).unwrap();
        ((moment, (v[1] as u32, v[2] as u32, v[3] as u32)), (DVec2::new(v[4], v[5]), v[6]))
    };
    lines(text, "seen ").into_iter().map(entry).collect()
}

#[test]
fn neighbouring_channels_of_two_processes_show_the_same_drops() {
    if is_channel(channel) {
        return;
    }
    let test = "processes::neighbouring_channels_of_two_processes_show_the_same_drops";
    let [a, b] = ["left", "right"].map(|name| run(test, name));
    assert_eq!(lines(&a, "state "), lines(&b, "state "));
    let (list, other) = (lines(&a, "drop "), lines(&b, "drop "));
    assert!(list.len() > 60, "{}", list.len());
    assert_eq!(list, other, "ids and places in the overlap");
    // A drop in both pictures is at the same place of the world, and the reference has it there.
    let [left, right] = projectors();
    let mut host = Host::new((16, 16));
    tell(&mut host);
    host.look(left.eye, DVec3::Y);
    let (seen_left, seen_right) = (seen(&a), seen(&b));
    let shared: Vec<f64> = seen_left
        .iter()
        .filter_map(|(id, (at, distance))| {
            let (there, _) = seen_right.get(id)?;
            Some((right.pixel(&host, left.world(*at, *distance)).0 - *there).length())
        })
        .collect();
    let mut off = Vec::new();
    for (moment, t) in MOMENTS.into_iter().enumerate() {
        let air = host.context.wind_displacement(t).unwrap();
        for (own, seen) in [(left, &seen_left), (right, &seen_right)] {
            let known: BTreeMap<Id, DVec3> =
                lattice::drops(&classes(), SEED, own.eye, air, t).map(|d| (d.id, d.position_m)).collect();
            let now = seen.iter().filter(|(key, _)| key.0 == moment);
            off.extend(now.map(|((_, id), (at, _))| (own.pixel(&host, own.eye + known[id]).0 - *at).length()));
        }
    }
    let worst = |v: &[f64]| v.iter().copied().fold(0.0, f64::max);
    println!(
        "{} drops in the overlap; {} measured in both pictures, {:.2} px apart at most; {} in either, {:.2} px from the reference",
        list.len(),
        shared.len(),
        worst(&shared),
        off.len(),
        worst(&off),
    );
    assert!(shared.len() >= 5, "{}", shared.len());
    assert!(worst(&shared) <= 0.5 && worst(&off) <= 0.5);
}

/// A channel's pictures of the default model, from one eye, one line of text a row.
fn default_channel(name: &str) -> String {
    let backends = if name == "left" { wgpu::Backends::VULKAN } else { wgpu::Backends::GL };
    let device = Device::headless(&DeviceOptions { backends, ..Default::default() }).unwrap();
    let mut host = night(Host::on(device, SIZE));
    tell(&mut host);
    host.view
        .set_rain(RainSettings {
            model: RainModel::Automatic,
            shutter_s: SHUTTER_S,
            most_drops: Some(MOST),
            ..RainSettings::default()
        })
        .unwrap();
    let across = if name == "left" { [-0.15, 0.03] } else { [-0.03, 0.15] };
    Projector { projection: off_axis(across, [-0.06, 0.06]), ..projectors()[0] }.of(&mut host);
    let mut text = String::new();
    for t in &MOMENTS[..2] {
        host.context.update(*t).unwrap();
        for row in picture(&mut host).chunks(SIZE.0 as usize) {
            // Both channels see the right third of the left picture, which is the left third of the right one.
            let third = SIZE.0 as usize / 3;
            let shared = if name == "left" { &row[2 * third..] } else { &row[..third] };
            let numbers: Vec<String> = shared.iter().map(|v| format!("{v}")).collect();
            text += &format!("row {}\n", numbers.join(" "));
        }
    }
    text
}

#[test]
fn neighbouring_channels_of_two_processes_show_the_same_streaks_by_default() {
    if is_channel(default_channel) {
        return;
    }
    let test = "processes::neighbouring_channels_of_two_processes_show_the_same_streaks_by_default";
    let cover = |name: &str| -> Vec<f64> {
        let text = run(test, name);
        let numbers = lines(&text, "row ").join(" ");
        numbers.split_whitespace().map(|v| 1.0 - v.parse::<f64>().unwrap()).collect()
    };
    let [a, b] = ["left", "right"].map(cover);
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let spread = mean(&a.iter().map(|v| (v - mean(&a)).abs()).collect::<Vec<_>>());
    let apart = mean(&a.iter().zip(&b).map(|(a, b)| (a - b).abs()).collect::<Vec<_>>());
    println!("{} pixels hide {:.4}, {spread:.5} from each other; {apart:.6} between the channels", a.len(), mean(&a));
    assert!(a.len() == b.len() && a.len() == 2 * 160 * 320 && spread > 1e-3, "{} {spread}", a.len());
    assert!(apart < 0.03 * spread, "{apart} between the channels, {spread} from pixel to pixel");
}

/// A picture's bits, its drops and its state in one number each.
fn summary(host: &mut Host) -> String {
    let eye = projectors()[0].eye;
    let bits =
        |p: Vec<f64>| p.iter().fold(0u64, |h, v| (h.rotate_left(5) ^ v.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let picture = bits(picture(host));
    let places = drops(host, eye)
        .iter()
        .flat_map(|d| d.place)
        .fold(0u64, |h, p| (h.rotate_left(5) ^ u64::from(p)).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    format!("picture {picture:016x} places {places:016x} state {:016x}", host.context.state_hash().unwrap())
}

fn saved_file() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("rain_channel_saved.bin")
}

fn dark() -> Host {
    let mut host = night(Host::new(SIZE));
    projectors()[0].of(&mut host);
    host.view
        .set_rain(RainSettings {
            model: RainModel::Drops,
            shutter_s: SHUTTER_S,
            most_drops: Some(MOST),
            ..RainSettings::default()
        })
        .unwrap();
    host
}

#[test]
fn a_saved_context_goes_on_in_another_process_as_it_would_have_here() {
    let taken_up = |_: &str| {
        let mut host = dark();
        host.context.load(&std::fs::read(saved_file()).unwrap()).unwrap();
        (61..=120).for_each(|s| host.context.update(f64::from(s)).unwrap());
        summary(&mut host)
    };
    if is_channel(taken_up) {
        return;
    }
    let mut host = dark();
    tell(&mut host);
    // When the state is saved one change of the weather has ended and is dropped, and another is under way.
    (0..=900).for_each(|i| host.context.update(f64::from(i) / 15.0).unwrap());
    std::fs::write(saved_file(), host.context.save().unwrap()).unwrap();
    (901..=1800).for_each(|i| host.context.update(f64::from(i) / 15.0).unwrap());
    let here = summary(&mut host);
    let there = run("processes::a_saved_context_goes_on_in_another_process_as_it_would_have_here", "loaded");
    assert_eq!(here, there);
}

#[test]
fn time_backwards_shows_what_time_forwards_showed() {
    let mut host = dark();
    tell(&mut host);
    let start = host.context.save().unwrap();
    let times = [5.0, 33.3, 61.7, 95.25, 1e4 + 1.0 / 3.0];
    let forwards: Vec<String> = times
        .iter()
        .map(|t| {
            host.context.update(*t).unwrap();
            summary(&mut host)
        })
        .collect();
    let distinct: std::collections::BTreeSet<_> = forwards.iter().map(|s| &s[..24]).collect();
    assert_eq!(distinct.len(), times.len(), "the drops move: {forwards:?}");
    for (t, there) in times.iter().zip(&forwards).rev() {
        host.context.load(&start).unwrap();
        host.context.update(*t).unwrap();
        assert_eq!(&summary(&mut host), there, "t {t}");
    }
}

#[test]
fn a_gust_after_a_million_seconds_moves_no_drop_by_more_than_it_blows() {
    let mut host = Host::new((16, 16));
    let start = 1e6;
    let gust = |mean: f64, gust: f64| {
        let mut w = rain(20.0, mean);
        w.wind.gust_m_s = Some(gust);
        w
    };
    host.context.set_weather(&gust(4.0, 6.0), 0.0, 0.0).unwrap();
    host.context.set_weather(&gust(30.0, 48.0), start, 2.0).unwrap();
    host.context.set_weather(&gust(3.0, 5.0), start + 8.0, 1.0).unwrap();
    let classes = Classes::new(&derive(&rain(20.0, 4.0)).unwrap().precipitation, 1.0, 2000);
    let dt = 1.0 / 60.0;
    let air = |t: f64| host.context.wind_displacement(t).unwrap();
    let mut fastest = 0.0f64;
    for step in 0..900 {
        let t = start - 2.0 + f64::from(step) * dt;
        let speed = |k: i32| host.context.carrying_wind(t + dt * f64::from(k) / 8.0).unwrap().length();
        let wind = (0..=8).map(speed).fold(0.0, f64::max);
        fastest = fastest.max(wind);
        // The wind's speed is highest between the nodes; it changes by less than this there.
        let most = wind * dt * 1.01 + 1e-6;
        let moved = air(t + dt) - air(t);
        assert!(moved.length() <= most, "t {t}: the air moved {moved}, wind {wind}");
        for (a, b) in lattice::drops(&classes, SEED, DVec3::ZERO, air(t), t)
            .zip(lattice::drops(&classes, SEED, DVec3::ZERO, air(t + dt), t + dt))
            .step_by(37)
        {
            let side = lattice::side_m(a.id.0 as usize);
            let fall = f64::from(classes.table[a.id.1 as usize][1]) * SPEED_UNIT * dt;
            let way = lattice::nearest(b.place, a.place, side);
            assert!((way + DVec3::Z * fall).length() <= most + 1e-5, "t {t}: drop {:?} moved {way}", a.id);
        }
    }
    assert!(fastest > 30.0, "{fastest}");
}
