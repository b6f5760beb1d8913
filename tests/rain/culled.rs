//! Drops drawn from a list of those in the picture: the same picture as when every drop is tested one by one.

use glam::{DMat4, DVec3, DVec4};
use welkin::{
    frame::Stages,
    gpu::{Device, DeviceOptions},
    rain::{AreaMotion, AreaRain, AreaShape, OccluderMap, RainArea, RainSettings, Taken},
    scene::HostLight,
    weather::Weather,
};
use welkin_support::rain_scene::{Host, rain, upright};

use crate::shelter::map;

/// One host without compute shaders, which draws every drop, and one with them.
fn hosts(backends: wgpu::Backends) -> [Host; 2] {
    [true, false].map(|force_tier0| {
        let options = DeviceOptions { backends, force_tier0, ..DeviceOptions::default() };
        let device = Device::headless(&options).unwrap();
        assert_eq!(device.caps().tier, u32::from(!force_tier0));
        Host::on(device, (240, 135))
    })
}

fn picture(host: &mut Host) -> Vec<[f32; 4]> {
    host.draw(|p, _| [if (p.x * 0.5).sin() > 0.0 { 40.0 } else { 4000.0 }; 3]);
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    host.pixels()
}

/// Checks that two pictures differ only by the rounding of half floats, except where the end of a streak falls on the
/// other side of a pixel's middle.
fn same(a: &[[f32; 4]], b: &[[f32; 4]], what: &str) {
    let mut mean = 0.0;
    let mut apart = 0;
    for (p, q) in a.iter().zip(b) {
        for c in 0..3 {
            let off = f64::from((p[c] - q[c]).abs()) / f64::from(q[c]).max(1.0);
            mean += off / (3.0 * a.len() as f64);
            apart += usize::from(c == 1 && off > 2e-3);
        }
    }
    println!("{what}: {mean:.2e} apart on the mean, {apart} pixels of {}", a.len());
    assert!(mean < 2e-5 && apart * 500 < a.len(), "{what}: {mean} on the mean, {apart} pixels");
}

/// Name of a scene, and the function that sets it up.
type Scene = (&'static str, fn(&mut Host));

fn weather(host: &mut Host, weather: &Weather) {
    let t = host.context.time_s() + 1.0;
    host.context.set_weather(weather, t, 0.0).unwrap();
    host.context.update(t + 0.5).unwrap();
}

const SCENES: [Scene; 9] = [
    ("steady rain", |h| weather(h, &rain(5.0, 6.0))),
    ("cloudburst", |h| weather(h, &rain(150.0, 20.0))),
    ("fast camera", |h| h.velocity_m_s = DVec3::new(20.0, 90.0, 0.0)),
    ("off-axis picture", |h| {
        h.velocity_m_s = DVec3::ZERO;
        let (left, right, up, down, near) = (-0.01, 0.16, 0.07, -0.03, 0.1);
        h.camera.projection = DMat4::from_cols(
            DVec4::new(2.0 * near / (right - left), 0.0, 0.0, 0.0),
            DVec4::new(0.0, 2.0 * near / (up - down), 0.0, 0.0),
            DVec4::new((right + left) / (right - left), (up + down) / (up - down), 0.0, -1.0),
            DVec4::new(0.0, 0.0, near, 0.0),
        );
    }),
    ("beside a box", |h| {
        h.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.3, 1.0, 0.1));
        h.context.set_shelters(&[upright([0.0, 3.0, 4.0], [1.0, 2.0, 0.1])]).unwrap();
    }),
    ("under a map of a roof", |h| {
        h.context.set_shelters(&[]).unwrap();
        let taken = Taken::parallel(DVec3::new(0.0, 0.0, 30.0), DVec3::NEG_Z, [42.0; 2], 60.0);
        let depth = map(h, &[upright([-19.0, 0.0, 6.0], [20.0, 40.0, 0.2])], &taken, (512, 512));
        h.context.set_occluder_maps(&[OccluderMap { depth: &depth, taken }]).unwrap();
    }),
    ("in lamps", |h| {
        h.context.set_occluder_maps(&[]).unwrap();
        let lamp = |x: f64| HostLight {
            position_m: DVec3::new(x, 1.0, 3.0),
            direction: DVec3::new(-0.2 * x, 1.0, -0.2),
            intensity_cd: [300_000.0; 3],
            inner_deg: 10.0,
            outer_deg: 30.0,
        };
        h.context.set_lights(&[lamp(-1.2), lamp(1.2)]).unwrap();
    }),
    ("on the rim of an area", |h| {
        h.context.set_lights(&[]).unwrap();
        let area = RainArea {
            center_m: [0.0, 900.0, 0.0],
            shape: AreaShape::Ellipse([1000.0, 1000.0]),
            rim_m: 200.0,
            rate_mm_h: 20.0,
            kind: AreaRain::Showers,
            motion: AreaMotion::Own([0.0, 0.0]),
            ..RainArea::default()
        };
        h.context.set_rain_areas(&[area]).unwrap();
    }),
    ("few drops that stand for many", |h| {
        h.context.set_rain_areas(&[]).unwrap();
        h.view.set_rain(RainSettings { most_drops: Some(4000), ..RainSettings::default() }).unwrap();
    }),
];

#[test]
fn the_list_draws_what_all_drops_draw() {
    for backends in [DeviceOptions::default().backends, wgpu::Backends::GL] {
        let mut hosts = hosts(backends);
        let mut before = Vec::new();
        for (what, set) in SCENES {
            let [all, listed] = hosts.each_mut().map(|host| {
                set(host);
                picture(host)
            });
            same(&listed, &all, &format!("{backends:?}, {what}"));
            assert_eq!(listed, picture(&mut hosts[1]), "{what}: from run to run");
            assert_ne!(before, listed, "{what}: shows in the picture");
            before = listed;
        }
    }
}
