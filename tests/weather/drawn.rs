//! Frames of every accepted weather have finite light that is not negative in every pixel.

use glam::DVec3;
use welkin::{
    context::{ContextDesc, GivenDirection},
    frame::{Exposure, Frame, FrameFlags, Stages},
    gpu::{Device, DeviceOptions},
    rain::RainSettings,
    scene::Camera,
    sky::SkySettings,
    weather::{AerosolKind, Fog, FogKind, derive_with},
};
use welkin_support::{accept, coarse_sky::coarse_sky, frame_host::Host};

use crate::{accepted::report, host::Dice, random::Given};

/// Cameras: at the ground looking level and up, in low cloud, high above.
const EYES: [(f64, f64); 4] = [(2.0, 0.05), (1.5, 0.6), (700.0, -0.1), (11_000.0, -0.3)];

/// Settings of a sky that is built for each weather in a small part of the coarse sky's time. Its table covers the same
/// range as any sky, with nodes farther apart, so that curves between them pass below 0 more easily.
fn smallest_sky() -> SkySettings {
    SkySettings { suns: 16, altitudes: 8, zeniths: 6, azimuths: 4, rule_zeniths: 4, rule_azimuths: 6, ..coarse_sky() }
}

/// A weather, the sun's elevation and the camera of its picture.
struct Case {
    given: Given,
    elevation_deg: f64,
    eye: (f64, f64),
    is_sky: bool,
}

impl Case {
    /// Properties that decide which shaders draw the case: compiling a shader takes longer than drawing a frame.
    fn kind(&self) -> [bool; 14] {
        let Ok(c) = derive_with(&self.given.weather, &self.given.overrides) else { return [false; 14] };
        let (fog, falling) = (&c.fog, &c.precipitation);
        let (up, _) = self.eye;
        [
            c.cloud_cover() >= 1.0,
            c.cloud_cover() > 0.0,
            falling.total_mm_h() > 0.0,
            fog.extinction_per_m > 0.0,
            fog.lifted > 0.0,
            fog.coverage < 1.0,
            fog.base_m > 0.0,
            fog.single_scattering_albedo < 1.0,
            fog.angstrom_exponent != 0.0,
            falling.showers > 0.0,
            self.elevation_deg < 0.0,
            up > 100.0,
            up > 1000.0,
            falling.hail_mm_h + falling.ice_pellets_mm_h > 0.0,
        ]
    }
}

/// Draws the cases in two halves, for two cores.
#[test]
fn every_random_weather_is_drawn_finite() {
    random_weathers_are_drawn_finite(0);
}

#[test]
fn every_random_weather_is_drawn_finite_in_the_other_half() {
    random_weathers_are_drawn_finite(1);
}

fn random_weathers_are_drawn_finite(half: usize) {
    let count = if accept() { 72 } else { 8 };
    let (mut dice, mut faults) = (Dice(5), Vec::new());
    let mut cases: Vec<_> = (0..count)
        .map(|n| {
            let given = Given::random(&mut dice);
            let elevation_deg = dice.below(70) as f64 - 10.0;
            Case { given, elevation_deg, eye: EYES[n / 2 % EYES.len()], is_sky: n.is_multiple_of(2) }
        })
        .collect();
    cases.sort_by_key(Case::kind);
    let mut host = host();
    // Cases that the same shaders draw are next to each other.
    for (n, case) in cases.iter().enumerate().skip(half * count / 2).take(count / 2) {
        if let Err(text) = fault(&mut host, case, n) {
            faults.push((text, case.given.clone()));
        }
    }
    report(count / 2, &faults);
}

/// Air so thick that the sky is black: no star is visible, and the frame is not refused.
#[test]
fn a_night_in_the_thickest_air_is_drawn() {
    let mut given = Given::default();
    given.weather.visibility_m = 1.0;
    given.weather.aerosol.kind = AerosolKind::Haze;
    given.weather.aerosol.scale_height_m = Some(20_000.0);
    given.weather.fog = Fog { visibility_inside_m: Some(10_000.0), ..Fog::of(FogKind::Shallow) };
    let case = Case { given, elevation_deg: -12.0, eye: EYES[1], is_sky: true };
    assert_eq!(fault(&mut host(), &case, 0), Ok(()));
}

fn host() -> Host {
    let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    let desc = ContextDesc { sky: smallest_sky(), ..ContextDesc::default() };
    let mut host = Host::of(device, wgpu::TextureFormat::Rgba16Float, desc);
    host.view.set_rain(RainSettings { most_drops: Some(4000), ..RainSettings::default() }).unwrap();
    host
}

fn fault(host: &mut Host, case: &Case, n: usize) -> Result<(), String> {
    let Case { given, elevation_deg, eye: (up, pitch), is_sky } = case;
    let time_s = 5.0 * (n + 1) as f64;
    let says = |what: &'static str| move |e: welkin::Error| format!("{what}: {e}");
    let sun = GivenDirection { azimuth_deg: 30.0, elevation_deg: *elevation_deg };
    host.context.set_sun(Some(sun)).unwrap();
    host.context.set_weather_with(&given.weather, &given.overrides, time_s, 0.0).map_err(says("set_weather"))?;
    host.context.update(time_s).map_err(says("update"))?;
    host.clear([0.2, 0.3, 0.4, 1.0], if *is_sky { 0.0 } else { 2e-4 });
    let forward = DVec3::new(0.3, 1.0, *pitch).normalize();
    let camera = Camera::look_to(DVec3::Z * *up, forward, DVec3::Z, 1.0, 160.0 / 90.0, 0.1);
    // Half floats cannot hold the luminance of sunlit snow in cd/m^2.
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
