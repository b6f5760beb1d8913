//! Whatever weather is accepted, a frame of it has light in every pixel that is a number and not below 0.

use glam::DVec3;
use welkin::{
    context::GivenDirection,
    frame::{Exposure, Frame, FrameFlags, Stages},
    rain::RainSettings,
    scene::Camera,
};

use crate::{accepted::report, frame_host::Host, host::Dice, random::Given};

/// Cameras: at the ground looking level and up, in low cloud, high above.
const EYES: [(f64, f64); 4] = [(2.0, 0.05), (1.5, 0.6), (700.0, -0.1), (11_000.0, -0.3)];

#[test]
fn every_random_weather_is_drawn_finite() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    host.view.set_rain(RainSettings { most_drops: Some(4000), ..RainSettings::default() }).unwrap();
    let count = if std::env::var_os("WELKIN_ACCEPT").is_some() { 2000 } else { 8 };
    let (mut dice, mut faults) = (Dice(5), Vec::new());
    for n in 0..count {
        let given = Given::random(&mut dice);
        let elevation_deg = dice.below(70) as f64 - 10.0;
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 30.0, elevation_deg })).unwrap();
        if let Err(text) = fault(&mut host, &given, n) {
            faults.push((text, given));
        }
    }
    report(count, &faults);
}

fn fault(host: &mut Host, given: &Given, n: usize) -> Result<(), String> {
    let time_s = 5.0 * (n + 1) as f64;
    let says = |what: &'static str| move |e: welkin::Error| format!("{what}: {e}");
    host.context.set_weather_with(&given.weather, &given.overrides, time_s, 0.0).map_err(says("set_weather"))?;
    host.context.update(time_s).map_err(says("update"))?;
    host.clear([0.2, 0.3, 0.4, 1.0], if n.is_multiple_of(2) { 0.0 } else { 2e-4 });
    let (up, pitch) = EYES[n / 2 % EYES.len()];
    let forward = DVec3::new(0.3, 1.0, pitch).normalize();
    let camera = Camera::look_to(DVec3::Z * up, forward, DVec3::Z, 1.0, 160.0 / 90.0, 0.1);
    // Half floats hold no sunlit snow in cd/m^2.
    let exposure = Some(Exposure::Factor(1e-4));
    let frame = Frame {
        exposure,
        flags: FrameFlags::NO_HISTORY,
        cd_m2_per_unit: 1e4,
        ..Frame::new(n as u64, camera, &host.color, Some(&host.depth))
    };
    host.view.record(&host.context, &frame, Stages::ALL.without(Stages::TONE)).map_err(says("record"))?;
    let pixels = host.pixels();
    match pixels.iter().position(|p| !p.iter().all(|v| v.is_finite() && *v >= 0.0)) {
        None => Ok(()),
        Some(at) => Err(format!("pixel {at}: {:?}", pixels[at])),
    }
}
