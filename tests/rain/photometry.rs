//! Visibility of rain: streaks against the photometric model of Garg and Nayar (2007), the rain's change from frame to
//! frame against drops that are drawn one by one ([`welkin_support::brute_rain`]), and the rain that trainees see by
//! day.  `cargo test --test rain photometry -- --nocapture` prints the tables of docs/lab/rain.md.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use welkin::{
    context::GivenDirection,
    frame::{Stages, tone},
    rain::{Classes, DropLight, RainModel, RainSettings, lattice},
    scene::Camera,
    weather::{Weather, derive},
};
use welkin_support::{
    accept,
    brute_rain::{Film, speed_m_s, sphere_radiance},
    rain_scene::{Host, NEAR_M, rain, upright},
};

use crate::{
    drops::{mean, through, white},
    streaks::{LEAST_PIXELS, Streak},
};

const SHUTTERS: [(f64, &str); 3] = [
    (RainSettings::SHUTTER_EYE_S, "1/20"),
    (RainSettings::SHUTTER_CAMERA_60_S, "1/60"),
    (RainSettings::SHUTTER_CAMERA_500_S, "1/500"),
];

#[test]
fn a_drop_shows_as_much_of_sky_and_ground_as_rays_through_a_sphere_do() {
    let light = DropLight { above: DVec3::splat(1.0), below: DVec3::splat(0.15), sun: DVec3::ZERO, to_sun: DVec3::Z };
    for elevation in [-90.0f64, -60.0, -40.0, -25.0, -10.0, -3.0, 0.0, 3.0, 10.0, 25.0, 40.0, 60.0, 90.0] {
        let (sin, cos) = elevation.to_radians().sin_cos();
        let d = DVec3::new(0.6 * cos, 0.8 * cos, sin);
        let traced = sphere_radiance(d, |to| if to.z > 0.0 { 1.0 } else { 0.15 });
        let drawn = light.radiance(d).x;
        println!("{elevation:5.0} degrees: drawn {drawn:.3}, traced {traced:.3}");
        assert!((drawn - traced).abs() < 0.02, "{elevation} degrees: {drawn} against {traced}");
    }
}

/// Distance of the board behind the streaks that are measured.
const BOARD_M: f64 = 1.9;

/// Size of the picture whose streaks are measured; its field of view is so narrow that drops are wider than a pixel.
const SIZE: (u32, u32) = (640, 360);
const NARROW_RAD: f64 = 0.1;

/// Drops of the lattice, each with its streak in the picture of a camera that looks north in still air.
fn drawn(host: &Host, classes: &Classes, t: f64, shutter_s: f64) -> Vec<(lattice::Drop, Streak)> {
    let focal = 0.5 * f64::from(SIZE.1) / (0.5 * NARROW_RAD).tan();
    lattice::drops(classes, 11, host.camera.position, DVec3::ZERO, t)
        .filter(|d| d.share > 0.0 && d.position_m.y > 0.1 && d.position_m.y < BOARD_M + 0.2)
        .map(|d| {
            let p = d.position_m * (focal / d.position_m.y);
            let middle = 0.5 * DVec2::new(f64::from(SIZE.0), f64::from(SIZE.1)) + DVec2::new(p.x, -p.z);
            let way = speed_m_s(1e3 * d.diameter_m) * shutter_s * focal / d.position_m.y;
            let end = 0.5 * (d.diameter_m * focal / d.position_m.y).max(LEAST_PIXELS);
            (d, Streak { id: d.id, middle, half: DVec2::new(0.0, 0.5 * way), end })
        })
        .collect()
}

/// Returns how far a streak is measured from its middle, across and along, pixels.
fn looked_at(streak: &Streak) -> DVec2 {
    DVec2::new(1.2 * streak.end + 1.5, (0.5 * streak.half.length()).min(20.0))
}

/// Whether no other streak lies in the measured part; in still air all streaks are vertical in the picture.
fn alone(streak: &Streak, all: &[(lattice::Drop, Streak)]) -> bool {
    let reach = looked_at(streak);
    all.iter().map(|(_, s)| s).filter(|other| other.id != streak.id).all(|other| {
        let apart = (other.middle - streak.middle).abs() - reach - 1.0;
        apart.x > other.end || apart.y > other.half.length() + other.end
    })
}

/// Light of a streak over that of a drop that fills the pixel, for each pixel near its middle: the distance from the
/// streak's line (in radii) and this share. Also the number of pixels across the streak.
fn section(streak: &Streak, pixels: &[f64], full: f64) -> (Vec<(f64, f64)>, f64) {
    let along = streak.half.normalize();
    let (low, high) = (streak.middle - looked_at(streak), streak.middle + looked_at(streak));
    let mut seen = Vec::new();
    for (y, x) in (low.y as u32..high.y as u32).flat_map(|y| (low.x as u32..high.x as u32).map(move |x| (y, x))) {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - streak.middle;
        seen.push((p.perp_dot(along) / streak.end, pixels[(y * SIZE.0 + x) as usize] / full));
    }
    (seen, f64::from(high.x as u32 - low.x as u32))
}

/// Each streak of a drop in the innermost shell changes the pixels on its line by tau / T of the difference between
/// drop and background (tau: the time the drop covers the pixel, T: the shutter time), and a section across the streak
/// by the mean of that. Against black the difference is the drop's own light.
#[test]
fn streaks_stand_out_for_as_long_as_their_drops_pass() {
    let mut host = Host::new(SIZE);
    host.look(DVec3::new(0.0, 0.0, 300.0), DVec3::Y);
    // A board hides the drops beyond the innermost shell, of which each stands for more than one.
    host.boxes = vec![upright([0.0, BOARD_M, 300.0], [2000.0, 1e-3, 2000.0])];
    // The sun is behind the camera, so that all drops in the picture have the same light.
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: 30.0 })).unwrap();
    let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
    host.camera = Camera::look_to(host.camera.position, DVec3::Y, DVec3::Z, NARROW_RAD, aspect, NEAR_M);
    let weather = rain(6.0, 0.0);
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    let most = 800_000;
    let classes = Classes::new(&derive(&weather).unwrap().precipitation, 1.0, most);
    assert_eq!(classes.weight, 1.0);
    host.draw(|_, _| [0.0; 3]);
    let mut t = 10.0;
    println!("| exposure, s | streaks | tau / T | on their lines | across them |");
    for (shutter_s, name) in SHUTTERS {
        let settings =
            RainSettings { model: RainModel::Drops, shutter_s, most_drops: Some(most), ..RainSettings::default() };
        host.view.set_rain(settings).unwrap();
        let (mut lines, mut sections, mut shares) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..40 {
            t += 0.37;
            host.context.update(t).unwrap();
            host.paint_black();
            host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
            let pixels: Vec<f64> = host.pixels().iter().map(|p| f64::from(p[1])).collect();
            let light = DropLight::of(&host.context.scene_at(host.camera.position, t).unwrap());
            let all = drawn(&host, &classes, t, shutter_s);
            for (drop, streak) in all.iter().filter(|(d, _)| d.id.0 == 0 && d.share == 1.0) {
                let far = (streak.middle - 0.5 * DVec2::new(640.0, 360.0)).abs() + looked_at(streak);
                if far.cmpgt(DVec2::new(318.0, 178.0)).any() || !alone(streak, &all) {
                    continue;
                }
                let tau_over_t = drop.diameter_m / (speed_m_s(1e3 * drop.diameter_m) * shutter_s);
                let (seen, columns) = section(streak, &pixels, light.radiance(drop.position_m.normalize()).y);
                let on_line: Vec<f64> = seen
                    .iter()
                    .filter(|(x, _)| x.abs() < 0.4)
                    .map(|(x, share)| share / (1.0 - x * x).sqrt() / tau_over_t)
                    .collect();
                if streak.end > 1.5 && on_line.len() > 4 {
                    lines.push(mean(&on_line));
                    shares.push(tau_over_t);
                }
                // The mean chord of a disc is pi / 4 of its diameter.
                let across = mean(&seen.iter().map(|s| s.1).collect::<Vec<_>>()) * columns;
                let size = drop.diameter_m * 180.0 / (0.5 * NARROW_RAD).tan() / drop.position_m.y;
                sections.push(across / (0.25 * PI * size * tau_over_t));
            }
        }
        shares.sort_by(f64::total_cmp);
        let (on_lines, across) = (mean(&lines), mean(&sections));
        let range = (shares[0], shares[shares.len() - 1]);
        println!(
            "| {name} | {} and {} | {:.3} to {:.3} | {on_lines:.3} | {across:.3} |",
            lines.len(),
            sections.len(),
            range.0,
            range.1
        );
        assert!(lines.len() > 25 && sections.len() > 60, "{} {}", lines.len(), sections.len());
        assert!((on_lines - 1.0).abs() < 0.06, "{name} s: {on_lines} of tau / T on the lines");
        assert!((across - 1.0).abs() < 0.06, "{name} s: {across} of tau / T across");
        let off = lines.iter().filter(|r| (**r - 1.0).abs() > 0.15).count();
        assert!(20 * off <= lines.len(), "{name} s: {off} of {} streaks are off by more than 15 %", lines.len());
    }
}

/// Focal length in pixels of a channel of 1280 x 720 pixels that sees 50 degrees from bottom to top.
const FOCAL: f64 = 772.0;

/// A camera whose picture is a part of such a channel's picture.
fn channel(size: (u32, u32), eye: DVec3) -> Camera {
    let fov = 2.0 * (0.5 * f64::from(size.1) / FOCAL).atan();
    Camera::look_to(eye, DVec3::Y, DVec3::Z, fov, f64::from(size.0) / f64::from(size.1), NEAR_M)
}

fn deviation(values: &[f64]) -> f64 {
    let m = mean(values);
    (values.iter().map(|v| (v - m).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

fn over(values: &[f64], threshold: f64) -> f64 {
    values.iter().filter(|v| v.abs() > threshold).count() as f64 / values.len() as f64
}

/// The rain of the default model, near drops and cones, against a picture of every single drop: the mean cover, its
/// deviation from pixel to pixel, and its change from one frame of 1/60 s to the next.
#[test]
fn rain_moves_from_frame_to_frame_as_all_its_drops_do() {
    let size = (400, 225);
    println!("| mm/h | exposure, s | hidden | pixel to pixel | frame to frame | beyond 0.004 |");
    for rate in [5.0, 20.0] {
        let mut host = white(size);
        host.camera = channel(size, host.camera.position);
        host.context.set_weather(&rain(rate, 0.0), 0.0, 0.0).unwrap();
        let mut t = 1.0;
        for (exposure_s, name) in SHUTTERS {
            let film = Film {
                size,
                fov_rad: 2.0 * (0.5 * f64::from(size.1) / FOCAL).atan(),
                exposure_s,
                rate_mm_h: rate,
                wind_m_s: DVec3::ZERO,
                camera_m_s: DVec3::ZERO,
                from_mm: 0.5,
                near_m: (0.125, 0.25),
                far_m: 14.8,
            };
            host.view.set_rain(RainSettings { shutter_s: exposure_s, ..RainSettings::default() }).unwrap();
            // Cover, deviation, change and share beyond; of the reference and of the drawn rain.
            let mut sums = [[0.0; 4]; 2];
            let mut add = |to: usize, [a, b]: [Vec<f64>; 2]| {
                let change: Vec<f64> = a.iter().zip(&b).map(|(a, b)| b - a).collect();
                let found = [mean(&a), deviation(&a), deviation(&change), over(&change, 0.004)];
                (0..4).for_each(|i| sums[to][i] += found[i]);
            };
            for k in 0..4 {
                let drops = film.drops(17 + k, 1.0 / 60.0);
                add(0, [0.0, 1.0 / 60.0].map(|s| film.cover(&drops, s)));
                let drawn = [0.7, 1.0 / 60.0].map(|step| {
                    t += step;
                    host.context.update(t).unwrap();
                    through(&mut host).iter().map(|v| 1.0 - v).collect()
                });
                add(1, drawn);
            }
            let ratio: Vec<f64> = (0..4).map(|i| sums[1][i] / sums[0][i]).collect();
            println!("| {rate} | {name} | {:.2} | {:.2} | {:.2} | {:.2} |", ratio[0], ratio[1], ratio[2], ratio[3]);
            assert!((ratio[0] - 1.0).abs() < 0.1, "{rate} mm/h, {name} s: {ratio:?}");
            for r in &ratio[1..3] {
                assert!((0.78..1.15).contains(r), "{rate} mm/h, {name} s: {ratio:?}");
            }
        }
    }
}

/// A meadow, dark wooded hills 150 and 400 m off, and the sky, under a report of heavy rain at noon.
fn hills(size: (u32, u32)) -> Host {
    let mut host = Host::new(size);
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 35.0 })).unwrap();
    host.boxes =
        vec![upright([0.0, 400.0, 0.0], [2000.0, 1.0, 42.0]), upright([-80.0, 150.0, 0.0], [75.0, 20.0, 25.0])];
    host.camera = channel(size, DVec3::new(0.0, 0.0, 1.7));
    let report = Weather::from_metar("METAR LFPG 121200Z 00000KT 4000 +RA OVC012 12/11 Q1005").unwrap();
    host.context.set_weather(&report.weather, 0.0, 0.0).unwrap();
    host.context.update(10.0).unwrap();
    host
}

/// Draws the host's picture, which is the same in every frame.
fn paint(host: &Host) {
    let light = host.context.light_at(host.camera.position, host.context.time_s()).unwrap();
    let (sun, lux) = (light.sun.direction, light.arriving);
    host.draw(|p, n| {
        let wood = p.length() > 100.0;
        let world = p + host.camera.position;
        let albedo = if wood { [0.03, 0.045, 0.02] } else { [0.06, 0.09, 0.04] };
        let grain = 1.0 + 0.2 * (world.x * 0.31).sin() * (world.z * 0.27).sin();
        [0, 1, 2].map(|i| {
            let lit = lux.sun_lux[i] * n.dot(sun).max(0.0) + lux.sky_lux[i] * (0.5 + 0.5 * n.z);
            albedo[i] * grain * lit / PI
        })
    });
}

/// Part of the picture by what it shows.
#[derive(Clone, Copy, PartialEq)]
enum PicturePart {
    Sky,
    Hills,
    Meadow,
}

fn shown(host: &Host) -> Vec<PicturePart> {
    let (w, h) = host.size;
    let of = |i: u32| {
        let at = DVec2::new(f64::from(i % w) + 0.5, f64::from(i / w) + 0.5);
        let ndc = DVec2::new(2.0 * at.x / f64::from(w) - 1.0, 1.0 - 2.0 * at.y / f64::from(h));
        match host.cast(ndc) {
            None => PicturePart::Sky,
            Some((p, _)) if p.length() > 100.0 => PicturePart::Hills,
            Some(_) => PicturePart::Meadow,
        }
    };
    (0..w * h).map(of).collect()
}

/// Frames in eight-bit sRGB: three 1/60 s apart, then two half a second apart.
fn frames(host: &mut Host, settings: RainSettings) -> Vec<Vec<[u8; 3]>> {
    host.view.set_rain(settings).unwrap();
    let code = |v: f32| (tone::srgb_encode(f64::from(v.clamp(0.0, 1.0))) * 255.0).round() as u8;
    [1.0 / 60.0, 1.0 / 60.0, 1.0 / 60.0, 0.5, 0.5]
        .into_iter()
        .map(|step| {
            host.context.update(host.context.time_s() + step).unwrap();
            paint(host);
            host.record(Stages::ALL).unwrap();
            host.pixels().iter().map(|p| [code(p[0]), code(p[1]), code(p[2])]).collect()
        })
        .collect()
}

/// Share of the pixels of a part that change by more than 2 of 255 from frame to frame.
fn changing(frames: &[Vec<[u8; 3]>], parts: &[PicturePart], part: PicturePart) -> f64 {
    let mut counts = (0, 0);
    for pair in frames.windows(2).take(2) {
        for ((a, b), _) in pair[0].iter().zip(&pair[1]).zip(parts).filter(|(_, p)| **p == part) {
            counts = (counts.0 + u32::from((0..3).any(|i| a[i].abs_diff(b[i]) > 2)), counts.1 + 1);
        }
    }
    f64::from(counts.0) / f64::from(counts.1)
}

/// Correlation of the changes in front of the hills with those `dx` and `dy` pixels away.
fn alike(frames: &[Vec<[u8; 3]>], parts: &[PicturePart], width: usize, (dx, dy): (usize, usize)) -> f64 {
    let (mut both, mut own) = (0.0, 0.0);
    // These frames have no streak in common.
    for pair in frames.windows(2).skip(2) {
        let change = |i: usize| f64::from(pair[1][i][1]) - f64::from(pair[0][i][1]);
        for i in 0..parts.len().saturating_sub(dx + dy * width) {
            let there = i + dx + dy * width;
            if i % width + dx < width && parts[i] == PicturePart::Hills && parts[there] == PicturePart::Hills {
                both += change(i) * change(there);
                own += 0.5 * (change(i).powi(2) + change(there).powi(2));
            }
        }
    }
    both / own
}

/// Saves the pictures of a trainer's view, for people to look at.
fn save(host: &Host, frame: &[[u8; 3]], name: &str) {
    let bytes = frame.iter().flatten().copied().collect();
    let picture = image::RgbImage::from_raw(host.size.0, host.size.1, bytes).unwrap();
    picture.save(std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)).unwrap();
}

/// Rain by day is visible in front of dark hills with the setting for trainers, as thin long streaks. With a gain of 1
/// it is hardly visible, and in front of the sky it never is. With `WELKIN_ACCEPT` the test draws the whole channel,
/// otherwise a part of it with pixels of the same size.
#[test]
fn trainees_see_rain_by_day_and_no_snow() {
    let size = if accept() { (1280, 720) } else { (384, 216) };
    let mut host = hills(size);
    let parts = shown(&host);
    println!("| rain | exposure, s | gain | sky, % | hills, % | meadow, % | alike 5 pixels along | 2 pixels across |");
    let mut seen = |name: &str, settings: RainSettings| {
        let frames = frames(&mut host, settings);
        save(&host, &frames[2], &format!("rain_by_day_{name}.png"));
        let [sky, hills, meadow] =
            [PicturePart::Sky, PicturePart::Hills, PicturePart::Meadow].map(|p| changing(&frames, &parts, p));
        let [along, across] = [(0, 5), (2, 0)].map(|step| alike(&frames, &parts, size.0 as usize, step));
        println!(
            "| +RA | 1/{:.0} | {} | {:.1} | {:.1} | {:.1} | {along:.2} | {across:.2} |",
            1.0 / settings.shutter_s,
            settings.contrast_gain,
            100.0 * sky,
            100.0 * hills,
            100.0 * meadow
        );
        (sky, hills, along, across)
    };
    let plain = seen("plain", RainSettings::default());
    let trainer = seen("trainer", RainSettings::TRAINER);
    let eye = RainSettings { shutter_s: RainSettings::SHUTTER_EYE_S, ..RainSettings::TRAINER };
    seen("trainer_eye", eye);
    let short = seen("short", RainSettings { shutter_s: RainSettings::SHUTTER_CAMERA_500_S, ..RainSettings::TRAINER });
    assert!(trainer.1 > 0.05, "{:.2} % of the hills change", 100.0 * trainer.1);
    assert!(trainer.1 > 3.0 * plain.1, "{} against {} at gain 1", trainer.1, plain.1);
    assert!(trainer.0 < 0.001, "before the sky {} changes", trainer.0);
    // The changes are correlated along the fall and not across it: they are streaks, not dots of a short exposure.
    assert!(trainer.2 > 0.4 && trainer.3 < 0.2, "{trainer:?}");
    assert!(short.2 < 0.3, "{short:?}");
}

/// A gain leaves the mean light of things tens of metres away unchanged, and gives streaks no colour.
#[test]
fn a_gain_keeps_the_mean_of_what_lies_far_off_and_is_said_in_the_report() {
    let size = (320, 180);
    let mut host = hills(size);
    let parts = shown(&host);
    let mut means = |gain: f64| {
        host.view.set_rain(RainSettings { contrast_gain: gain, ..RainSettings::default() }).unwrap();
        let mut sums = [0.0f64; 3];
        for _ in 0..6 {
            host.context.update(host.context.time_s() + 0.7).unwrap();
            paint(&host);
            host.record(Stages::ALL.without(Stages::TONE)).unwrap();
            let pixels = host.pixels();
            for (p, _) in pixels.iter().zip(&parts).filter(|(_, s)| **s == PicturePart::Hills) {
                (0..3).for_each(|i| sums[i] += f64::from(p[i]));
            }
        }
        assert_eq!(host.view.report().rain.contrast_gain, gain);
        sums
    };
    let (plain, trainer) = (means(1.0), means(RainSettings::GAIN_TRAINER));
    for i in 0..3 {
        let ratio = trainer[i] / plain[i];
        println!("colour {i}: {ratio:.4} of what it is without a gain");
        assert!((ratio - 1.0).abs() < 0.02, "colour {i}: {ratio}");
    }
    for gain in [0.0, 0.5, 16.5, f64::NAN, f64::INFINITY] {
        let refused = host.view.set_rain(RainSettings { contrast_gain: gain, ..RainSettings::default() });
        let message = refused.unwrap_err().to_string();
        assert!(message.starts_with("rain.contrast_gain must be in [1, 16]"), "{message}");
    }
    assert_eq!(host.view.report().rain.contrast_gain, RainSettings::GAIN_TRAINER, "unchanged");
}
