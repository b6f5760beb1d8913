//! Rain on cones: the cones hide as much of the picture as drops do, their tips are invisible, and they move with the
//! air and the camera.

use glam::{DMat4, DVec2, DVec3, DVec4};
use welkin::{
    context::GivenDirection,
    frame::Stages,
    rain::{
        RainModel, RainSettings,
        cones::{BANDS_M, CONES},
        contrast,
        lattice::HIDDEN_M,
    },
    scene::Camera,
};
use welkin_support::rain_scene::{Host, NEAR_M, rain, upright};

use crate::drops::{classes, mean, through, white};

fn draws(host: &mut Host, model: RainModel) {
    host.view.set_rain(RainSettings { model, ..RainSettings::default() }).unwrap();
}

fn cones(size: (u32, u32)) -> Host {
    let mut host = white(size);
    draws(&mut host, RainModel::Cones);
    host
}

/// Sets so many streaks, each of which hides so little, that their mean hardly depends on chance and overlaps do not
/// matter.
fn many_streaks(host: &mut Host) {
    let many = RainSettings { model: RainModel::Cones, most_drops: Some(8_000_000), ..RainSettings::default() };
    host.view.set_rain(many).unwrap();
}

/// Mean light of the drops over a picture of a black wall by day. Against black, half floats round the little light of
/// drops with the same relative error as any; against white, the little that drops hide would be lost in rounding.
fn light(host: &mut Host) -> f64 {
    host.draw(|_, _| [0.0; 3]);
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    mean(&host.pixels().iter().map(|p| f64::from(p[1])).collect::<Vec<_>>())
}

#[test]
fn cones_hide_as_much_as_the_drops_they_stand_for() {
    let mut host = cones((320, 180));
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: 50.0 })).unwrap();
    for (i, (rate, wind)) in [(2.0, 0.0), (20.0, 4.0), (100.0, 15.0)].into_iter().enumerate() {
        let (t, weather) = (10.0 + 100.0 * i as f64, rain(rate, wind));
        host.context.set_weather(&weather, t, 0.0).unwrap();
        let seen = [RainModel::Drops, RainModel::Cones].map(|model| {
            draws(&mut host, model);
            let each = (0..16).map(|k| {
                host.context.update(host.context.time_s().max(t) + 1.31 * f64::from(k.min(1))).unwrap();
                light(&mut host)
            });
            mean(&each.collect::<Vec<_>>())
        });
        // Cones stand for drops up to a greater distance.
        let more = (BANDS_M[CONES] - BANDS_M[0]) / (HIDDEN_M - BANDS_M[0]);
        println!("{rate} mm/h: cones {:.4} of drops", seen[1] / seen[0] / more);
        assert!((seen[1] / seen[0] / more - 1.0).abs() < 0.07, "{rate} mm/h: {seen:?}");
        // A wall at 3.5 m hides the rain that the two outer cones stand for.
        host.boxes[0] = upright([0.0, 3.5, 300.0], [2000.0, 1e-3, 2000.0]);
        let near = light(&mut host);
        let part = (3.75 - BANDS_M[0]) / (BANDS_M[CONES] - BANDS_M[0]);
        assert!((near / seen[1] / part - 1.0).abs() < 0.3, "{near} of {}, {part}", seen[1]);
        host.boxes[0] = upright([0.0, 400.0, 0.0], [2000.0, 1.0, 2000.0]);
    }
}

#[test]
fn what_cones_hide_is_the_optical_depth_of_their_drops() {
    let mut host = cones((320, 180));
    many_streaks(&mut host);
    for (i, rate) in [20.0, 100.0, 400.0].into_iter().enumerate() {
        let (t, weather) = (10.0 + 100.0 * i as f64, rain(rate, 3.0));
        host.context.set_weather(&weather, t, 0.0).unwrap();
        let each = (0..12).map(|k| {
            host.context.update(t + 1.31 * f64::from(k)).unwrap();
            mean(&through(&mut host))
        });
        let got = -mean(&each.collect::<Vec<_>>()).ln();
        let want = 0.5 * classes(&weather, u32::MAX).extinction_per_m * (BANDS_M[CONES] - BANDS_M[0]);
        println!("{rate} mm/h: {got:.5}, discs {want:.5}");
        assert!((got / want - 1.0).abs() < 0.06, "{rate} mm/h: {got} against {want}");
    }
}

/// Cover of each pixel of a camera among white walls that looks along `forward`.
fn cover(host: &mut Host, forward: DVec3, up: DVec3) -> Vec<f64> {
    let aspect = f64::from(host.size.0) / f64::from(host.size.1);
    host.camera = Camera::look_to(DVec3::new(0.0, 0.0, 300.0), forward.normalize(), up, 0.9, aspect, NEAR_M);
    through(host).iter().map(|v| 1.0 - v).collect()
}

/// White walls on all sides.
fn amid_walls(size: (u32, u32)) -> Host {
    let mut host = cones(size);
    let wall = |axis: usize, sign: f64| {
        let (mut center, mut half) = (DVec3::new(0.0, 0.0, 300.0), DVec3::splat(200.0));
        center[axis] += sign * 100.0;
        half[axis] = 1.0;
        upright(center.to_array(), half.to_array())
    };
    host.boxes = (0..3).flat_map(|a| [wall(a, -1.0), wall(a, 1.0)]).collect();
    host
}

#[test]
fn no_tip_shows_where_the_drops_come_from_and_go_to() {
    let mut host = amid_walls((240, 240));
    many_streaks(&mut host);
    for (i, velocity) in [DVec3::ZERO, DVec3::new(0.0, 25.0, 0.0)].into_iter().enumerate() {
        let t = 200.0 * (i + 1) as f64;
        host.velocity_m_s = velocity;
        let weather = rain(200.0, 0.0);
        host.context.set_weather(&weather, t, 0.0).unwrap();
        // Drops of the mean fall speed come from here.
        let from = velocity + DVec3::Z * 6.0;
        for forward in [from, -from] {
            let n = host.size.0 as usize;
            let (mut sums, mut most) = (vec![0.0; n / 2], [0.0f64; 2]);
            let mut counts = vec![0.0; n / 2];
            for k in 0..16 {
                host.context.update(host.context.time_s().max(t) + 1.37 * f64::from(k.min(1))).unwrap();
                let picture = cover(&mut host, forward, DVec3::X);
                for (i, c) in picture.iter().enumerate() {
                    let at = DVec2::new((i % n) as f64, (i / n) as f64) + 0.5 - n as f64 / 2.0;
                    let ring = at.length() as usize;
                    if ring < n / 2 {
                        sums[ring] += c;
                        counts[ring] += 1.0;
                        most[usize::from(ring > n / 6)] = most[usize::from(ring > n / 6)].max(*c);
                    }
                }
            }
            let within = |a: usize, b: usize| sums[a..b].iter().sum::<f64>() / counts[a..b].iter().sum::<f64>();
            let all = within(0, n / 2);
            for (a, b) in [(0, 10), (10, 20), (20, 50), (50, 120)] {
                let share = within(a, b) / all;
                assert!((share - 1.0).abs() < 0.15, "{velocity} {forward}: ring {a} to {b} has {share} of the mean");
            }
            assert!(most[0] < 2.0 * most[1], "{velocity} {forward}: {most:?}");
        }
    }
}

fn correlation(pairs: &[(f64, f64)]) -> f64 {
    let n = pairs.len() as f64;
    let (a, b) = pairs.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
    let sum = |f: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|p| f(p.0 - a, p.1 - b)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// The picture in a direction does not depend on how the camera is turned.
#[test]
fn a_camera_that_turns_does_not_drag_the_streaks_along() {
    let mut host = amid_walls((320, 240));
    host.context.set_weather(&rain(10.0, 5.0), 5.0, 0.0).unwrap();
    host.context.update(5.0).unwrap();
    let first = cover(&mut host, DVec3::Y, DVec3::Z);
    let clip = host.camera.projection * DMat4::from_mat3(host.camera.rotation());
    let (w, h) = (host.size.0 as usize, host.size.1 as usize);
    let seen = |d: DVec3| {
        let p: DVec4 = clip * d.extend(1.0);
        let at = DVec2::new((p.x / p.w * 0.5 + 0.5) * w as f64, (0.5 - p.y / p.w * 0.5) * h as f64) - 0.5;
        let inside = p.w > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x < w as f64 - 1.0 && at.y < h as f64 - 1.0;
        inside.then(|| {
            let (x, y) = (at.x as usize, at.y as usize);
            let f = at - at.floor();
            let v = |x: usize, y: usize| first[y * w + x];
            (v(x, y) * (1.0 - f.x) + v(x + 1, y) * f.x) * (1.0 - f.y)
                + (v(x, y + 1) * (1.0 - f.x) + v(x + 1, y + 1) * f.x) * f.y
        })
    };
    for (forward, up) in [(DVec3::new(0.2, 1.0, 0.1), DVec3::Z), (DVec3::Y, DVec3::new(0.5, 0.0, 1.0))] {
        let turned = cover(&mut host, forward, up);
        let rays = host.rays();
        let pairs: Vec<_> = (0..w * h)
            .filter_map(|i| {
                let ndc = DVec2::new(
                    ((i % w) as f64 + 0.5) / w as f64 * 2.0 - 1.0,
                    1.0 - ((i / w) as f64 + 0.5) / h as f64 * 2.0,
                );
                Some((turned[i], seen(rays.view_ray(ndc).direction)?))
            })
            .collect();
        let same = correlation(&pairs);
        assert!(pairs.len() > w * h / 3 && same > 0.85, "{forward}: {same} over {} pixels", pairs.len());
    }
}

#[test]
fn streaks_move_alike_at_any_time_and_no_change_throws_them() {
    let mut host = cones((160, 90));
    let step = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>();
    let mut moved = Vec::new();
    for t in [30.0, 1e6] {
        host.context.set_weather(&rain(20.0, 12.0), t, 0.0).unwrap();
        host.context.update(t + 10.0).unwrap();
        let mut pictures = Vec::new();
        for k in 0..40 {
            host.context.update(t + 10.0 + f64::from(k) * 2e-3).unwrap();
            pictures.push(through(&mut host));
        }
        assert_eq!(pictures[39], through(&mut host), "the same moment gives the same picture");
        let steps: Vec<f64> = pictures.windows(2).map(|p| step(&p[0], &p[1])).collect();
        let (most, mean) = (steps.iter().copied().fold(0.0, f64::max), mean(&steps));
        let apart = step(&pictures[0], &pictures[39]);
        assert!(most < 1.5 * mean && mean < 0.5 * apart, "t {t}: a step of {most}, {mean} on the mean, {apart} in all");
        moved.push(mean);
        // The camera brakes a little: the picture changes as little as by a few such steps.
        let before = pictures.pop().unwrap();
        host.velocity_m_s = DVec3::new(0.0, 0.05, 0.0);
        let jolt = step(&before, &through(&mut host));
        host.velocity_m_s = DVec3::ZERO;
        assert!(jolt < 4.0 * mean, "t {t}: {jolt} against {mean}");
    }
    // The streaks are others; the rain is the same.
    assert!((0.4..2.5).contains(&(moved[1] / moved[0])), "{moved:?}");
}

#[test]
fn storms_far_places_and_fast_cameras_stay_finite_on_cones() {
    let mut host = Host::new((160, 90));
    draws(&mut host, RainModel::Cones);
    for (i, (rate, wind, at, speed)) in
        [(500.0, 80.0, 0.0, 300.0), (0.01, 0.0, 1e7, -300.0), (200.0, 40.0, -1e7, 0.0)].into_iter().enumerate()
    {
        let t = 1e6 * i as f64;
        host.context.set_weather(&rain(rate, wind), t, 0.0).unwrap();
        host.context.update(t + 0.5).unwrap();
        host.velocity_m_s = DVec3::new(0.0, speed, 0.0);
        host.look(DVec3::new(at, at, 2.0), DVec3::new(0.2, 1.0, -0.1));
        host.draw(|_, _| [10.0; 3]);
        host.record(Stages::ALL).unwrap();
        assert!(host.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{rate} {wind} {at}");
        assert_eq!(host.view.report().rain.drops, 0);
    }
}

#[test]
fn cones_leave_a_cab_dry_and_a_veil_draws_nothing() {
    let mut host = cones((160, 90));
    host.context.set_weather(&rain(30.0, 5.0), 1.0, 0.0).unwrap();
    host.context.update(1.0).unwrap();
    host.boxes = vec![upright([0.0, 2.0, 300.0], [50.0, 1e-3, 50.0])];
    assert!(through(&mut host).iter().any(|v| *v < 0.999), "it rains");
    host.context.set_shelters(&[upright([0.0, 0.0, 300.0], [4.0; 3])]).unwrap();
    assert!(through(&mut host).iter().all(|v| *v == 1.0));
    host.context.set_shelters(&[]).unwrap();
    draws(&mut host, RainModel::Veil);
    assert!(through(&mut host).iter().all(|v| *v == 1.0));
    assert_eq!(host.view.report().passes, 0);
}

/// Compares the closed form by which the plan weighs streaks with pictures: the deviation of their cover from pixel to
/// pixel.
#[test]
fn streaks_stand_out_as_the_sum_of_their_squared_covers_says() {
    let mut host = amid_walls((320, 180));
    let pixel = 2.0 * (0.5f64 * 0.9).tan() / 180.0;
    let cases =
        [(2.0, 0.0, 1.0), (20.0, 0.0, 1.0), (20.0, 25.0, 1.0), (100.0, 0.0, 1.0), (5.0, 0.0, 4.0), (20.0, 0.0, 8.0)];
    for (i, (rate, speed, gain)) in cases.into_iter().enumerate() {
        let (t, weather) = (10.0 + 100.0 * i as f64, rain(rate, 0.0));
        host.view.set_rain(RainSettings { contrast_gain: gain, ..RainSettings::default() }).unwrap();
        host.velocity_m_s = DVec3::X * speed;
        host.context.set_weather(&weather, t, 0.0).unwrap();
        let mut variance = 0.0;
        for k in 0..12 {
            host.context.update(t + 1.31 * f64::from(k)).unwrap();
            let seen = cover(&mut host, DVec3::Y, DVec3::Z);
            let m = mean(&seen);
            variance += seen.iter().map(|c| (c - m).powi(2)).sum::<f64>() / (seen.len() as f64 * 12.0);
        }
        let classes = classes(&weather, u32::MAX);
        let fall = classes.flux[16].1;
        let along = DVec3::new(speed, 0.0, fall).length() / 60.0;
        let want = contrast::cover_variance(&classes, pixel, (along, gain), (0.2, BANDS_M[CONES])).sqrt();
        let ratio = variance.sqrt() / want;
        println!(
            "{rate} mm/h at {speed} m/s, gain {gain}: deviation {:.5}, by the closed form {want:.5}, {ratio:.3}",
            variance.sqrt()
        );
        // In light rain cones deviate more than by the closed form, because their texture does not get fewer streaks.
        let most = if rate < 10.0 { 1.35 } else { 1.15 };
        assert!((0.85..most).contains(&ratio), "{rate} mm/h at {speed} m/s, gain {gain}: {ratio}");
    }
}
