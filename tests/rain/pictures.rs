//! Pictures for people to look at (in cargo's directory for test files), and checks of what they must show.

use glam::DVec3;
use welkin::{
    context::GivenDirection,
    frame::{Exposure, Stages},
    rain::{RainModel, RainSettings},
    scene::HostLight,
};
use welkin_support::rain_scene::{Host, rain, upright};

/// Draws the host's picture: a road in a meadow and concrete, lit by the light that Welkin returns.
pub fn paint(host: &Host) {
    let light = host.context.light_at(host.camera.position, host.context.time_s()).unwrap();
    let (sun, lux) = (light.sun.direction, light.arriving);
    host.draw(|p, n| {
        let world = p + host.camera.position;
        let grain = ((world.x * 3.1).sin() * (world.y * 2.7).sin() * 0.5 + 1.0) * 0.9;
        let albedo = if n.z < 0.9 || world.z > 0.1 {
            [0.32, 0.31, 0.29]
        } else if world.x.abs() < 3.0 {
            [0.09, 0.09, 0.095]
        } else {
            [0.10, 0.13, 0.05]
        };
        let cosine = n.dot(sun).max(0.0);
        [0, 1, 2].map(|i| {
            let lamps: f64 = host
                .context
                .lights()
                .iter()
                .map(|l| l.illuminance_lux(world)[i] * n.dot((l.position_m - world).normalize()).max(0.0))
                .sum();
            let e = lux.sun_lux[i] * cosine + lux.sky_lux[i] * (0.5 + 0.5 * n.z) + lamps;
            albedo[i] * grain * e / std::f64::consts::PI
        })
    });
}

pub fn save(host: &Host, name: &str) -> Vec<[f32; 4]> {
    let pixels = host.pixels();
    let encode = |v: f32| {
        let v = v.clamp(0.0, 1.0);
        let s = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        (s * 255.0 + 0.5) as u8
    };
    let bytes = pixels.iter().flat_map(|p| [encode(p[0]), encode(p[1]), encode(p[2])]).collect();
    let picture = image::RgbImage::from_raw(host.size.0, host.size.1, bytes).unwrap();
    picture.save(std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)).unwrap();
    pixels
}

#[test]
fn steady_rain_cloudburst_and_a_dry_place_under_a_bridge() {
    let mut host = Host::new((480, 270));
    host.boxes = vec![
        upright([0.0, 9.0, 5.0], [12.0, 3.0, 0.4]),
        upright([-5.0, 9.0, 2.5], [0.5, 3.0, 2.5]),
        upright([5.0, 9.0, 2.5], [0.5, 3.0, 2.5]),
    ];
    host.look(DVec3::new(0.5, 0.0, 1.7), DVec3::new(0.1, 1.0, -0.05));
    for (i, (rate, wind, name)) in
        [(0.5, 1.0, "drizzle"), (6.0, 3.0, "steady"), (60.0, 12.0, "cloudburst")].into_iter().enumerate()
    {
        let t = 100.0 * (i + 1) as f64;
        host.context.set_weather(&rain(rate, wind), t, 0.0).unwrap();
        host.context.update(t + 1.0).unwrap();
        host.context.set_shelters(&host.boxes).unwrap();
        paint(&host);
        host.record(Stages::ALL).unwrap();
        save(&host, &format!("rain_{name}.png"));
        println!("{name}: {} drops", host.view.report().rain.drops);
    }
}

#[test]
fn work_lights_show_the_rain_in_their_beams_at_night() {
    let mut host = Host::new((480, 270));
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    host.context.set_exposure(Exposure::Ev100(4.0)).unwrap();
    host.context.set_weather(&rain(8.0, 3.0), 10.0, 0.0).unwrap();
    host.context.update(11.0).unwrap();
    host.look(DVec3::new(0.0, 0.0, 2.2), DVec3::new(0.0, 1.0, -0.05));
    let draw = |host: &mut Host, name: &str| {
        paint(host);
        host.record(Stages::ALL).unwrap();
        save(host, name)
    };
    let dark = draw(&mut host, "rain_dark.png");
    let beam = |x: f64, to: [f64; 3]| HostLight {
        position_m: DVec3::new(x, 1.0, 4.0),
        direction: DVec3::from(to),
        intensity_cd: [30_000.0, 28_000.0, 23_000.0],
        inner_deg: 8.0,
        outer_deg: 22.0,
    };
    let lights = [beam(-1.2, [-0.35, 1.0, -0.2]), beam(1.2, [0.25, 1.0, -0.25])];
    host.context.set_lights(&lights).unwrap();
    let lit = draw(&mut host, "rain_night.png");
    // Above the horizon nothing but drops can shine.
    let sky = 0..(480 * 100);
    let sum = |p: &[[f32; 4]]| p[sky.clone()].iter().map(|v| f64::from(v[1])).sum::<f64>();
    assert!(sum(&lit) > 5.0 * sum(&dark), "{} {}", sum(&lit), sum(&dark));
    host.context.set_lights(&[]).unwrap();
    let again = draw(&mut host, "rain_dark.png");
    assert!(sum(&again) < 1.01 * sum(&dark), "the lamps are off");
}

/// Each model of the same rain, at rest, from a car at 25 m/s and from an aircraft at 300.
#[test]
fn every_model_shows_the_same_rain() {
    let mut host = Host::new((640, 360));
    host.boxes = vec![upright([-9.0, 25.0, 4.0], [4.0, 6.0, 4.0]), upright([8.0, 40.0, 6.0], [5.0, 5.0, 6.0])];
    for (i, (rate, speed)) in [(6.0, 0.0), (60.0, 0.0), (20.0, 25.0), (60.0, 300.0)].into_iter().enumerate() {
        let t = 100.0 * (i + 1) as f64;
        host.context.set_weather(&rain(rate, 5.0), t, 0.0).unwrap();
        host.context.update(t + 1.0).unwrap();
        host.velocity_m_s = DVec3::Y * speed;
        for (model, name) in [
            (RainModel::Automatic, "automatic"),
            (RainModel::Veil, "veil"),
            (RainModel::Cones, "cones"),
            (RainModel::Drops, "drops"),
            (RainModel::Integrated, "integrated"),
        ] {
            host.view.set_rain(RainSettings { model, ..RainSettings::default() }).unwrap();
            paint(&host);
            host.record(Stages::ALL).unwrap();
            save(&host, &format!("rain_model_{rate}_{speed}_{name}.png"));
        }
    }
}
