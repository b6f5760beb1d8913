//! Drops against their reference: where they are, how much they cover, where it is dry.

use glam::{DMat4, DVec2, DVec3};
use welkin::{
    context::GivenDirection,
    frame::Stages,
    rain::{
        Classes, RainModel, RainSettings,
        lattice::{self, SHELLS},
    },
    weather::{Fog, Weather, derive},
};
use welkin_support::rain_scene::{Host, rain, upright};

/// Radiance of the host's picture: far above the light of drops at night, within the range of half floats.
pub const WHITE: f64 = 3e4;

/// A host at night in front of a white wall at the horizon, which draws only drops: each pixel shows the share of light
/// that they let through.
pub fn white(size: (u32, u32)) -> Host {
    night(Host::new(size))
}

/// Sets night and drops alone on a host, as [`white`] has them.
pub fn night(mut host: Host) -> Host {
    host.view.set_rain(RainSettings { model: RainModel::Drops, ..RainSettings::default() }).unwrap();
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    host.boxes = vec![upright([0.0, 400.0, 0.0], [2000.0, 1.0, 2000.0])];
    host.look(DVec3::new(0.0, 0.0, 300.0), DVec3::Y);
    host
}

pub fn through(host: &mut Host) -> Vec<f64> {
    host.draw(|_, _| [WHITE; 3]);
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    host.pixels().iter().map(|p| f64::from(p[1]) / WHITE).collect()
}

pub fn mean(v: &[f64]) -> f64 {
    v.iter().sum::<f64>() / v.len() as f64
}

pub fn classes(weather: &Weather, most: u32) -> Classes {
    Classes::new(&derive(weather).unwrap().precipitation, 1.0, most)
}

/// Optical depth of the drawn drops' discs up to `range_m`: half of the drops' extinction, whose other half is
/// diffraction.
pub fn depth_to(classes: &Classes, range_m: f64) -> f64 {
    let n = 4000;
    let h = range_m / f64::from(n);
    let share: f64 =
        (0..n).map(|i| (0..SHELLS).map(|s| lattice::shell_share(s, (f64::from(i) + 0.5) * h)).sum::<f64>() * h).sum();
    0.5 * classes.extinction_per_m * share
}

#[test]
fn drops_cover_as_much_of_the_picture_as_their_extinction_says() {
    let mut host = white((320, 180));
    for (i, (rate, wind)) in [(2.0, 0.0), (20.0, 4.0), (100.0, 15.0)].into_iter().enumerate() {
        let (t, weather) = (10.0 + 5.0 * i as f64, rain(rate, wind));
        host.context.set_weather(&weather, t, 0.0).unwrap();
        let classes = classes(&weather, 100_000);
        let mut seen = Vec::new();
        for k in 0..16 {
            host.context.update(t + 0.3 * f64::from(k)).unwrap();
            // Other drops: those of one cell repeat.
            host.look(DVec3::new(1.7 * f64::from(k), 0.3 * f64::from(k), 300.0), DVec3::Y);
            seen.push(mean(&through(&mut host)));
        }
        let (got, want) = (-mean(&seen).ln(), depth_to(&classes, 400.0));
        // White is 3e4 in half floats, whose steps are 5e-4 of it there.
        let near = (got / want - 1.0).abs() < 0.12 || (got - want).abs() < 2e-4;
        assert!(near, "{rate} mm/h: {got} against {want}");
        host.look(DVec3::new(0.0, 0.0, 300.0), DVec3::Y);
        // A wall at 1.5 m hides the drops behind it.
        host.boxes[0] = upright([0.0, 1.5, 300.0], [2000.0, 1e-3, 2000.0]);
        let near = -mean(&through(&mut host)).ln();
        assert!(near < 0.6 * got && near > 0.02 * got, "{near} of {got}");
        host.boxes[0] = upright([0.0, 400.0, 0.0], [2000.0, 1.0, 2000.0]);
    }
}

/// A camera at 300 m/s sees drops as streaks of 5 m, which are longer than the range of drawn drops. They hide as much
/// as at rest, which is the amount that the veil leaves out.
#[test]
fn drops_hide_as_much_at_any_speed_of_the_camera() {
    let mut host = white((240, 135));
    let weather = rain(50.0, 0.0);
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    let most = 60_000;
    host.view
        .set_rain(RainSettings { model: RainModel::Drops, most_drops: Some(most), ..RainSettings::default() })
        .unwrap();
    let want = depth_to(&classes(&weather, most), 400.0);
    let mut t = 10.0;
    for speed in [0.0, 25.0, 100.0, 300.0] {
        for along in [DVec3::X, DVec3::Y, DVec3::new(0.7, -0.7, 0.0)] {
            host.velocity_m_s = along * speed;
            let mut seen = Vec::new();
            for k in 0..8 {
                t += 0.3;
                host.context.update(t).unwrap();
                host.look(DVec3::new(1.7 * f64::from(k), 0.3 * f64::from(k), 300.0), DVec3::Y);
                seen.push(mean(&through(&mut host)));
            }
            let got = -mean(&seen).ln() / want;
            println!("{speed} m/s along {along}: {got:.3} of what is left out of the veil");
            assert!((got - 1.0).abs() < 0.12, "{speed} m/s along {along}: {got}");
        }
    }
}

/// The rain in front of a wall takes the same share of the wall's light with drawn drops and veil as with the veil
/// alone: nothing is counted twice.
#[test]
fn drops_and_veil_together_hide_as_much_as_the_rain() {
    let mut host = white((320, 180));
    // A wall nearer than the distance at which curtains begin.
    host.boxes[0] = upright([0.0, 20.0, 300.0], [2000.0, 1e-3, 2000.0]);
    // A camera in mist and rain, and one above mist.
    let deep = Fog { top_m: Some(2000.0), ..Fog::default() };
    let cases = [(30.0, 700.0, deep), (200.0, 200.0, deep), (30.0, 700.0, Fog::default())];
    for (i, (rate, visibility_m, fog)) in cases.into_iter().enumerate() {
        let t = 10.0 * (i + 1) as f64;
        let weather = Weather { visibility_m, fog, ..rain(rate, 0.0) };
        host.context.set_weather(&weather, t, 0.0).unwrap();
        let all = Stages::PREPARE.with(Stages::MEDIUM).with(Stages::PARTICLES);
        let mut seen = Vec::new();
        for k in 0..6 {
            host.context.update(t + 0.7 * f64::from(k)).unwrap();
            host.draw(|_, _| [WHITE; 3]);
            host.record(all).unwrap();
            seen.push(mean(&host.pixels().iter().map(|p| f64::from(p[1]) / WHITE).collect::<Vec<_>>()));
        }
        let c = derive(&weather).unwrap();
        let is_below = fog.top_m.is_none();
        assert!(c.fog.extinction_per_m > 0.1 * c.extinction_per_m && (c.fog.top_m < 200.0) == is_below, "{:?}", c.fog);
        let extinction_per_m = c.extinction_per_m - if is_below { c.fog.extinction_per_m } else { 0.0 };
        // The wall is flat: the mean over the picture of the distance along each ray to it.
        let rays = host.rays();
        let n = 60;
        let want: f64 = (0..n * n)
            .map(|i| DVec2::new(f64::from(i % n), f64::from(i / n)) * 2.0 / f64::from(n) - 1.0 + 1.0 / f64::from(n))
            .map(|ndc| (-extinction_per_m * 20.0 / rays.view_ray(ndc).direction.y).exp())
            .sum::<f64>()
            / f64::from(n * n);
        let (got, want) = (-mean(&seen).ln(), -want.ln());
        assert!((got / want - 1.0).abs() < 0.05, "{rate} mm/h: {got} of {want}");
    }
}

#[test]
fn each_drop_is_drawn_where_the_reference_has_it_and_none_beside() {
    let mut host = white((480, 270));
    let weather = rain(10.0, 0.0);
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    let few =
        RainSettings { model: RainModel::Drops, shutter_s: 1e-3, most_drops: Some(2000), ..RainSettings::default() };
    host.view.set_rain(few).unwrap();
    let classes = classes(&weather, 2000);
    for (t, eye) in [(3.0, DVec3::new(0.0, 0.0, 300.0)), (123_456.7, DVec3::new(1.3, 0.4, 301.0))] {
        host.context.update(t).unwrap();
        host.look(eye, DVec3::Y);
        let pixels = through(&mut host);
        let clip = host.camera.projection * DMat4::from_mat3(host.camera.rotation());
        let (w, h) = (f64::from(host.size.0), f64::from(host.size.1));
        let mut near = vec![false; pixels.len()];
        let mut found = 0;
        for drop in lattice::drops(&classes, 11, eye, DVec3::ZERO, t) {
            let p = clip * drop.position_m.extend(1.0);
            let ndc = DVec2::new(p.x, p.y) / p.w;
            if drop.share <= 0.0 || p.w < 0.05 || ndc.abs().max_element() > 1.2 {
                continue;
            }
            let at = ((ndc.x * 0.5 + 0.5) * w, (0.5 - ndc.y * 0.5) * h);
            let checked = drop.share > 0.3 && p.w > 0.5 && ndc.abs().max_element() < 0.98;
            found += u32::from(checked);
            let dark = (-2..=2).flat_map(|y| (-2..=2).map(move |x| (at.0 as i32 + x, at.1 as i32 + y)));
            let mut least = 1.0f64;
            for (x, y) in dark.filter(|p| p.0 >= 0 && p.1 >= 0 && p.0 < w as i32 && p.1 < h as i32) {
                least = least.min(pixels[(y as u32 * host.size.0 + x as u32) as usize]);
            }
            assert!(!checked || least < 1.0 - 1e-4, "t {t}: drop {:?} at {at:?}, {} m off, is not drawn", drop.id, p.w);
            let reach = (w / p.w * 0.02).ceil().min(w) as i32 + 4;
            for y in -reach..=reach {
                for x in -reach..=reach {
                    let (x, y) = (at.0 as i32 + x, at.1 as i32 + y);
                    if x >= 0 && y >= 0 && x < w as i32 && y < h as i32 {
                        near[(y as u32 * host.size.0 + x as u32) as usize] = true;
                    }
                }
            }
        }
        let beside = pixels.iter().zip(&near).filter(|(p, n)| **p < 0.97 && !**n).count();
        assert!(found > 30 && beside == 0, "{found} drops, {beside} dark pixels beside them");
    }
}

#[test]
fn without_rain_nothing_is_drawn_and_nothing_changes() {
    let mut host = white((160, 90));
    host.draw(|p, _| [p.x.abs() + 0.123; 3]);
    let before = host.pixels();
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    assert_eq!(before, host.pixels());
    assert_eq!((host.view.report().passes, host.view.report().rain.drops), (0, 0));
}

#[test]
fn it_is_dry_in_a_cab_and_under_a_deck_whatever_the_wind() {
    let mut host = white((240, 135));
    for (i, wind) in [0.0, 10.0, 25.0].into_iter().enumerate() {
        let t = 10.0 * (i + 1) as f64;
        host.context.set_weather(&rain(30.0, wind), t, 0.0).unwrap();
        host.context.update(t).unwrap();
        // Inside a cab whose walls fill the picture there is no drop.
        let eye = DVec3::new(0.0, 0.0, 300.0);
        host.look(eye, DVec3::new(0.3, 1.0, 0.1));
        host.boxes = vec![upright([0.0, 2.0, 300.0], [50.0, 1e-3, 50.0])];
        let cab = upright([0.0, 0.0, 300.0], [4.0, 4.0, 4.0]);
        host.context.set_shelters(&[]).unwrap();
        assert!(through(&mut host).iter().any(|v| *v < 0.99), "it rains");
        host.context.set_shelters(&[cab]).unwrap();
        let inside = through(&mut host);
        assert!(inside.iter().all(|v| *v == 1.0), "wind {wind}: {:?}", inside.iter().copied().fold(1.0, f64::min));
        // On the ground under a deck that extends far enough upwind, a camera that looks at the ground sees no drop and
        // no splash.
        host.boxes = Vec::new();
        host.look(DVec3::new(0.0, 0.0, 1.5), DVec3::new(0.0, 1.0, -0.9));
        host.context.set_shelters(&[]).unwrap();
        assert!(through(&mut host).iter().any(|v| *v < 0.99), "it rains");
        host.context.set_shelters(&[upright([0.0, 0.0, 3.0], [400.0, 400.0, 0.1])]).unwrap();
        assert!(through(&mut host).iter().all(|v| *v == 1.0), "wind {wind}");
    }
}

/// Where rain has more drops or splashes than are drawn, the report has the number of drops that each drawn one stands
/// for, and the rate of the splashes left out.
#[test]
fn the_report_has_the_weight_of_a_drop_and_the_splashes_left_out() {
    let mut host = white((64, 36));
    let report = |host: &mut Host, rate: f64, t: f64| {
        host.context.set_weather(&rain(rate, 0.0), t, 0.0).unwrap();
        host.context.update(t + 1.0).unwrap();
        through(host);
        host.view.report().rain
    };
    host.view.set_rain(RainSettings { most_drops: Some(8_000_000), ..RainSettings::default() }).unwrap();
    let light = report(&mut host, 1.0, 10.0);
    assert!(light.drops > 1000 && light.drop_weight == 1.0 && light.splashes_left_out_per_m2_s == 0.0, "{light:?}");
    host.view.set_rain(RainSettings { most_drops: Some(5000), ..RainSettings::default() }).unwrap();
    let heavy = report(&mut host, 300.0, 20.0);
    assert!((4900..=5000).contains(&heavy.drops) && heavy.splashes_left_out_per_m2_s > 10.0, "{heavy:?}");
    let all = classes(&rain(300.0, 0.0), u32::MAX);
    assert!((heavy.drop_weight * f64::from(heavy.drops) / f64::from(all.per_shell) - 1.0).abs() < 0.01, "{heavy:?}");
    assert_eq!(report(&mut host, 0.0, 30.0), Default::default());
}
