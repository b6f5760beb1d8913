//! The length of a drawn streak: the relative way of drop and camera while the shutter is open.

use glam::{DVec2, DVec3};
use welkin::{
    rain::{
        Classes, RainModel, RainSettings,
        drops::{streak_length_m, terminal_speed_m_s},
        lattice::{self, CLASSES, SPEED_UNIT},
    },
    scene::Camera,
    weather::{Weather, derive},
};
use welkin_support::rain_scene::{Host, NEAR_M, rain};

use crate::drops::{through, white};

const SIZE: (u32, u32) = (640, 360);
const FOV: f64 = 0.25;
const MOST: u32 = 12_000;
/// Streaks are at least this wide, in pixels: `LEAST_PIXELS` of `shaders/rain/drops.wgsl`.
pub const LEAST_PIXELS: f64 = 1.2;

/// A drop in a picture.
pub struct Streak {
    pub id: (u32, u32, u32),
    /// Middle of the streak, pixels.
    pub middle: DVec2,
    /// Half of the path of the drop's centre, pixels.
    pub half: DVec2,
    /// Length that the drop's own size adds at each end, pixels.
    pub end: f64,
}

fn pixel(camera: &Camera, from_eye: DVec3) -> (DVec2, f64) {
    let p = camera.projection * (camera.rotation() * from_eye).extend(1.0);
    let ndc = DVec2::new(p.x, p.y) / p.w;
    (DVec2::new(0.5 * ndc.x + 0.5, 0.5 - 0.5 * ndc.y) * DVec2::new(f64::from(SIZE.0), f64::from(SIZE.1)), p.w)
}

/// Streaks that the picture should have, by the laws alone: speeds are those of Gunn and Kinzer.
fn streaks(host: &Host, classes: &Classes, t: f64, shutter_s: f64) -> Vec<Streak> {
    let pixel_m = 2.0 * (0.5 * FOV).tan() / f64::from(SIZE.1);
    lattice::drops(classes, 11, host.camera.position, host.context.wind_displacement(t).unwrap(), t)
        .filter(|d| d.share > 0.0 && d.position_m.y > 0.5)
        .map(|d| {
            let velocity = -DVec3::Z * terminal_speed_m_s(1e3 * d.diameter_m) - host.velocity_m_s;
            let half = velocity * (0.5 * shutter_s);
            let [a, b] = [-half, half].map(|h| pixel(&host.camera, d.position_m + h).0);
            let end = 0.5 * (d.diameter_m / (pixel_m * d.position_m.length())).max(LEAST_PIXELS);
            Streak { id: d.id, middle: 0.5 * (a + b), half: 0.5 * (b - a), end }
        })
        .collect()
}

/// Distance from a point to the line between a streak's ends.
pub fn distance(streak: &Streak, p: DVec2) -> f64 {
    let along = ((p - streak.middle).dot(streak.half) / streak.half.length_squared()).clamp(-1.0, 1.0);
    (p - streak.middle - streak.half * along).length()
}

/// Whether no other streak comes nearer than their widths.
pub fn alone(streak: &Streak, all: &[Streak]) -> bool {
    let samples = |s: &Streak| (-8..=8).map(|i| s.middle + s.half * (f64::from(i) / 8.0)).collect::<Vec<_>>();
    let own = samples(streak);
    let room = |other: &Streak| 4.0 + 2.0 * (streak.end + other.end);
    all.iter().filter(|o| o.id != streak.id).all(|o| {
        let far = (o.middle - streak.middle).length() - o.half.length() - streak.half.length() > room(o);
        far || (own.iter().all(|p| distance(o, *p) > room(o))
            && samples(o).iter().all(|p| distance(streak, *p) > room(o)))
    })
}

/// Length of the way of a drop that left a dark bar in the picture, from the bar's variance: a way of even speed adds a
/// twelfth of its square, and the disc itself a quarter of the square of its radius.
fn drawn_length(streak: &Streak, pixels: &[f64]) -> Option<f64> {
    let reach = streak.half.abs() + 2.0 * streak.end + 3.0;
    let (low, high) = (streak.middle - reach, streak.middle + reach);
    if low.min_element() < 0.0 || high.x >= f64::from(SIZE.0) || high.y >= f64::from(SIZE.1) {
        return None;
    }
    let along = streak.half.normalize();
    let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
    for (x, y) in (low.x as u32..=high.x as u32).flat_map(|x| (low.y as u32..=high.y as u32).map(move |y| (x, y))) {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        if distance(streak, p) < 2.0 * streak.end + 2.0 {
            let (dark, at) = (1.0 - pixels[(y * SIZE.0 + x) as usize], (p - streak.middle).dot(along));
            (sum, first, second) = (sum + dark, first + dark * at, second + dark * at * at);
        }
    }
    // Fainter ones are lost in the steps of half floats.
    (sum > 0.3).then(|| (12.0 * (second / sum - (first / sum).powi(2) - 0.25 * streak.end.powi(2))).sqrt())
}

#[test]
fn streaks_are_as_long_as_drop_and_camera_move_against_each_other() {
    let mut host = white(SIZE);
    let mut weather = Weather { ..rain(500.0, 0.0) };
    weather.precipitation.showers = true;
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    let classes = Classes::new(&derive(&weather).unwrap().precipitation, 1.0, MOST);
    let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
    host.camera = Camera::look_to(host.camera.position, DVec3::Y, DVec3::Z, FOV, aspect, NEAR_M);
    let mut t = 10.0;
    for (speed, shutter_s) in [(0.0, 0.02), (25.0, 0.008)] {
        host.velocity_m_s = DVec3::X * speed;
        host.view
            .set_rain(RainSettings {
                model: RainModel::Drops,
                shutter_s,
                most_drops: Some(MOST),
                ..RainSettings::default()
            })
            .unwrap();
        let mut ratios = vec![Vec::new(); CLASSES];
        for _ in 0..90 {
            t += 0.37;
            host.context.update(t).unwrap();
            let pixels = through(&mut host);
            let all = streaks(&host, &classes, t, shutter_s);
            for streak in all.iter().filter(|s| s.half.length() > 6.0 && alone(s, &all)) {
                if let Some(length) = drawn_length(streak, &pixels) {
                    ratios[streak.id.1 as usize].push(length / (2.0 * streak.half.length()));
                }
            }
        }
        let means: Vec<(usize, usize, f64)> = ratios
            .iter()
            .enumerate()
            .filter(|(_, r)| r.len() >= 4)
            .map(|(class, r)| (class, r.len(), r.iter().sum::<f64>() / r.len() as f64))
            .collect();
        let worst = means.iter().map(|m| (m.2 - 1.0).abs()).fold(0.0, f64::max);
        let measured: usize = means.iter().map(|m| m.1).sum();
        println!(
            "camera at {speed} m/s: {measured} streaks of {} sizes, off by {:.2} % at most",
            means.len(),
            100.0 * worst
        );
        let sizes = |i: usize| 1e3 * classes.table[means[i].0][0];
        assert!(means.len() >= 28, "{means:?}");
        assert!(sizes(0) < 0.6 && sizes(means.len() - 1) > 4.9, "{means:?}");
        for (class, count, mean) in means {
            let d = 1e3 * classes.table[class][0];
            assert!((mean - 1.0).abs() < 0.03, "{d} mm, {count} streaks: {mean} of the law's length");
        }
    }
}

/// Drops too small to be drawn keep to the law too: checked on the numbers by which the lattice would draw them.
#[test]
fn the_lattices_speeds_keep_streaks_of_any_size_within_three_percent() {
    for i in 0..=590 {
        let speed = terminal_speed_m_s(0.1 + 0.01 * f64::from(i));
        let drawn = (speed / SPEED_UNIT).round() * SPEED_UNIT;
        for camera in [DVec3::ZERO, DVec3::X * 25.0] {
            let length = |v: f64| streak_length_m(-DVec3::Z * v - camera, 1.0 / 60.0);
            assert!((length(drawn) / length(speed) - 1.0).abs() < 0.03, "{i}: {speed} m/s");
        }
    }
}
