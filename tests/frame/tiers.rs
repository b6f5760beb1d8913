//! A device without compute on OpenGL draws the frame that one with compute draws.

use glam::DVec3;
use welkin::{
    context::GivenDirection,
    frame::{Exposure, Frame, Stages},
    gpu::{Device, DeviceOptions},
    light::luminance,
    scene::Camera,
    weather::{CloudLayer, Fog, FogKind, LayerWind, Precipitation, PrecipitationKind, Weather},
};
use welkin_support::frame_host::Host;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Clear air, fog, shallow fog seen from inside, and rain in haze.
fn weathers() -> [Weather; 4] {
    let foggy = |visibility_m, kind| Weather { visibility_m, fog: Fog::of(kind), ..Weather::default() };
    let rain = Precipitation { kind: PrecipitationKind::Rain, rate_mm_h: 8.0, ..Default::default() };
    [
        Weather::default(),
        foggy(150.0, FogKind::Fog),
        foggy(800.0, FogKind::Shallow),
        Weather { visibility_m: 4000.0, precipitation: rain, ..Weather::default() },
    ]
}

/// One on OpenGL without compute, and one with.
fn hosts() -> [Host; 2] {
    let options = DeviceOptions { backends: wgpu::Backends::GL, force_tier0: true, ..Default::default() };
    let gl = Device::headless(&options).expect("an OpenGL driver: make setup installs one");
    assert_eq!(gl.caps().tier, 0);
    [Host::on(gl, FORMAT), Host::new(FORMAT)]
}

#[test]
fn tier_0_composes_the_same_frame() {
    let mut hosts = hosts();
    let mut id = 0;
    for (w, weather) in weathers().iter().enumerate() {
        for host in &mut hosts {
            host.context.set_weather(weather, w as f64, 0.0).unwrap();
            host.context.update(w as f64).unwrap();
        }
        for (elevation_deg, height, depth) in
            [(40.0, 2500.0, 0.0), (2.0, 1.5, 0.0), (2.0, 1.5, 1e-3), (-5.0, 1.5, 0.0), (40.0, 2500.0, 1e-5)]
        {
            id += 1;
            for host in &mut hosts {
                let sun = GivenDirection { azimuth_deg: 20.0, elevation_deg };
                host.context.set_sun(Some(sun)).unwrap();
                host.clear([0.05, 0.2, 0.4, 1.0], depth);
                let eye = DVec3::new(0.0, 0.0, height);
                let camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 1.0, 160.0 / 90.0, 0.1);
                let mut frame = Frame::new(id, camera, &host.color, Some(&host.depth));
                frame.exposure = Some(Exposure::Auto { compensation_ev: 0.0 });
                frame.cd_m2_per_unit = 100.0;
                host.view.record(&host.context, &frame, Stages::ALL.without(Stages::TONE)).unwrap();
            }
            let [tier_0, tier_1] = hosts.each_ref().map(Host::pixels);
            let [tier_0, tier_1] =
                [tier_0, tier_1].map(|l| l.into_iter().map(|p| p.map(f64::from)).collect::<Vec<_>>());
            let place = format!("weather {w} sun {elevation_deg} height {height} depth {depth}");
            differ_by_roundings(&tier_0, &tier_1, &place);
        }
    }
}

/// Checks that two pictures differ only by rounding. The last bits of f32 differ between drivers, so that a table or
/// the target may round to the next half float. One step of the target is 1e-3 of a channel, one step of a table's
/// square root is 2e-3. Luminances must agree within 1e-3 everywhere, and all channels but one in a thousand within a
/// step of the target.
fn differ_by_roundings(tier_0: &[[f64; 4]], tier_1: &[[f64; 4]], place: &str) {
    let y = |p: &[f64; 4]| luminance(&[p[0], p[1], p[2]]);
    let mut large = 0;
    for (a, b) in tier_0.iter().zip(tier_1) {
        assert!((y(a) / y(b) - 1.0).abs() < 1e-3, "{place}: {a:?} {b:?}");
        for c in 0..3 {
            let off = (a[c] - b[c]).abs() / b[c].abs().max(1e-4);
            assert!(off < 2.5e-3, "{place}: {a:?} {b:?}");
            large += usize::from(off > 1e-3);
        }
    }
    assert!(large * 1000 < 3 * tier_0.len(), "{place}: {large} channels");
}

/// History that a frame takes over from earlier frames: a sky that fades into another, and clouds that are followed.
#[test]
fn tier_0_carries_the_same_from_frame_to_frame() {
    let mut hosts = hosts();
    let wind = Some(LayerWind { from_deg: 250.0, speed_m_s: 20.0 });
    let clouds = |cover| vec![CloudLayer { wind, ..CloudLayer::new(cover, 1500.0) }];
    let mut worst = [0.0f64; 3];
    for (part, (visibility_m, cover)) in [(60e3, 0.0), (8e3, 0.0), (8e3, 0.4)].into_iter().enumerate() {
        for i in 0..50u32 {
            let id = 50 * part as u32 + i;
            let time_s = f64::from(id) / 30.0;
            for host in &mut hosts {
                if i == 0 {
                    let clouds = if cover > 0.0 { clouds(cover) } else { Vec::new() };
                    let weather = Weather { visibility_m, clouds, ..Weather::default() };
                    host.context.set_weather(&weather, time_s, 0.0).unwrap();
                }
                host.context.set_sun(Some(GivenDirection { azimuth_deg: 60.0, elevation_deg: 25.0 })).unwrap();
                host.context.update(time_s).unwrap();
                host.clear([0.05, 0.2, 0.4, 1.0], 0.0);
                let forward = DVec3::new((0.01 * f64::from(id)).sin(), 1.0, 0.4);
                let camera = Camera::look_to(DVec3::Z * 2.0, forward, DVec3::Z, 1.0, 160.0 / 90.0, 0.1);
                let mut frame = Frame::new(id.into(), camera, &host.color, Some(&host.depth));
                frame.cd_m2_per_unit = 100.0;
                host.view.record(&host.context, &frame, Stages::ALL.without(Stages::TONE)).unwrap();
            }
            let [a, b] = hosts.each_ref().map(Host::pixels);
            let y = |p: &[f32; 4]| luminance(&[p[0], p[1], p[2]].map(f64::from));
            let mut off: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (y(a) / y(b) - 1.0).abs()).collect();
            off.sort_by(f64::total_cmp);
            worst[part] = worst[part].max(off[off.len() * 95 / 100]);
        }
    }
    println!("tier 0 is apart by {worst:.5?} at 95 %: clear, into haze, among clouds");
    assert!(worst[0] < 2.5e-3 && worst[1] < 2.5e-3 && worst[2] < 1e-2, "{worst:?}");
}
