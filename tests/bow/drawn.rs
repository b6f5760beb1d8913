//! Both bows in pictures.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    rain::{AreaShape, RainArea},
    scene::Camera,
    weather::{CloudLayer, Fog, FogKind, Precipitation, PrecipitationKind, Weather},
};

const SIZE: (u32, u32) = (192, 108);
/// Direction of the sun.
const SUN: GivenDirection = GivenDirection { azimuth_deg: 90.0, elevation_deg: 12.0 };
const SEEN: Stages = Stages::BACKGROUND.with(Stages::MEDIUM).with(Stages::PARTICLES);
const EYE: DVec3 = DVec3::new(0.0, 0.0, 20.0);

struct Scene {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
}

fn rain(rate_mm_h: f64) -> Weather {
    let precipitation = Precipitation { kind: PrecipitationKind::Rain, rate_mm_h, ..Weather::default().precipitation };
    // A low sun shines in between the clouds from which the rain falls. Their sides shade more than their cover says.
    let clouds = vec![CloudLayer::new(0.1, 1500.0)];
    Weather { precipitation, clouds, visibility_m: 20_000.0, ..Weather::default() }
}

fn fog() -> Weather {
    let fog = Fog { kind: FogKind::Fog, top_m: Some(60.0), ..Weather::default().fog };
    Weather { fog, visibility_m: 150.0, ..Weather::default() }
}

/// Returns the direction this many degrees above the point opposite to the sun.
fn above_opposite(degrees: f64) -> DVec3 {
    let (azimuth, elevation) = (SUN.azimuth_deg + 180.0, degrees - SUN.elevation_deg);
    welkin::sky::sun::direction(azimuth, elevation)
}

impl Scene {
    fn new(weather: &Weather, backends: wgpu::Backends) -> Self {
        let device = Device::headless(&DeviceOptions { backends, ..DeviceOptions::default() })
            .expect("a software driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
        context.set_sun(Some(SUN)).unwrap();
        // Single clouds would hide parts of the bow.
        context.set_cloud_model(CloudModel::Deck);
        context.set_weather(weather, 0.0, 0.0).unwrap();
        let view = View::new(&context).unwrap();
        let color = welkin_support::textures::texture(&device, SIZE, wgpu::TextureFormat::Rgba16Float, 1);
        Self { device, context, view, color }
    }

    /// A picture of the sky, cd/m^2 a channel, and the direction of each of its pixels.
    fn take(&mut self, frame_id: u64, forward: DVec3, fov: f64) -> (Vec<[f64; 3]>, Vec<DVec3>) {
        let camera = Camera::look_to(EYE, forward, DVec3::Z, fov, 16.0 / 9.0, 0.1);
        let mut frame = Frame::new(frame_id, camera, &self.color, None);
        (frame.flags, frame.cd_m2_per_unit) = (FrameFlags::NO_HISTORY, 1e3);
        self.view.record(&self.context, &frame, SEEN).unwrap();
        let texels = readback::rgba(&self.device, &self.color).unwrap();
        if let Ok(folder) = std::env::var("BOW_PICTURES") {
            let raw: Vec<u8> = texels.iter().flat_map(|t| t.iter().flat_map(|v| v.to_le_bytes())).collect();
            std::fs::write(format!("{folder}/{frame_id}.raw"), raw).unwrap();
        }
        let inverse = camera.projection.inverse();
        let of = |i: u32| {
            let uv = [(i % SIZE.0, SIZE.0), (i / SIZE.0, SIZE.1)].map(|(p, of)| (f64::from(p) + 0.5) / f64::from(of));
            let eye = inverse.project_point3(DVec3::new(2.0 * uv[0] - 1.0, 1.0 - 2.0 * uv[1], 0.5)).normalize();
            camera.rotation().transpose() * eye
        };
        let picture = texels.iter().map(|t| [0, 1, 2].map(|k| 1e3 * f64::from(t[k]))).collect();
        (picture, (0..SIZE.0 * SIZE.1).map(of).collect())
    }

    /// The column of pixels above the point opposite to the sun: angle from it, degrees, and radiance.
    fn profile(&mut self, frame_id: u64) -> Vec<(f64, [f64; 3])> {
        let (picture, directions) = self.take(frame_id, above_opposite(45.0), 0.7);
        let opposite = above_opposite(0.0);
        let middle = (0..SIZE.1).map(|y| (y * SIZE.0 + SIZE.0 / 2) as usize);
        middle.map(|i| (directions[i].angle_between(opposite).to_degrees(), picture[i])).collect()
    }
}

fn mean(profile: &[(f64, [f64; 3])], from: f64, to: f64) -> [f64; 3] {
    let inside: Vec<_> = profile.iter().filter(|(angle, _)| (from..to).contains(angle)).collect();
    [0, 1, 2].map(|c| inside.iter().map(|(_, v)| v[c]).sum::<f64>() / inside.len() as f64)
}

/// Checks that a picture of the sky agrees with the queries.
fn agrees_with_queries(scene: &mut Scene, frame_id: u64) {
    let (picture, directions) = scene.take(frame_id, above_opposite(42.0), 0.9);
    let some: Vec<usize> = (0..picture.len()).step_by(97).filter(|i| directions[*i].z > 0.01).collect();
    let asked: Vec<DVec3> = some.iter().map(|i| directions[*i]).collect();
    let queried = scene.context.sky_radiance(EYE, &asked, 0.0).unwrap();
    let off = |(i, t): (&usize, &[f64; 3])| (luminance(&picture[*i]) / luminance(t) - 1.0).abs();
    let mut off: Vec<f64> = some.iter().zip(&queried).map(off).collect();
    off.sort_by(f64::total_cmp);
    let (median, p95) = (off[off.len() / 2], off[off.len() * 95 / 100]);
    println!("off by {median:.4} in the median, {p95:.4} at the 95th percentile of {}", off.len());
    assert!(median < 0.01 && p95 < 0.03, "{median} {p95}");
}

#[test]
fn a_fogbow_in_pictures_is_that_of_the_queries() {
    let mut scene = Scene::new(&fog(), DeviceOptions::default().backends);
    agrees_with_queries(&mut scene, 2);
    let profile = scene.profile(6);
    let of = |from: f64, to: f64| luminance(&mean(&profile, from, to));
    let (inside, bow, outside) = (of(32.0, 33.5), of(36.5, 39.5), of(44.0, 47.0));
    println!("fog: inside {inside:.0}, bow {bow:.0}, outside {outside:.0} cd/m^2");
    assert!(bow > 1.01 * 0.5 * (inside + outside), "{inside} {bow} {outside}");
}

#[test]
fn a_rainbow_stands_at_42_degrees_with_a_second_one_at_51_and_a_dark_band_between() {
    let mut scene = Scene::new(&rain(5.0), DeviceOptions::default().backends);
    agrees_with_queries(&mut scene, 1);
    let profile = scene.profile(3);
    let of = |from: f64, to: f64| luminance(&mean(&profile, from, to));
    let (inside, primary, band, secondary, outside) =
        (of(34.0, 38.0), of(41.0, 42.2), of(44.5, 48.5), of(50.8, 52.5), of(57.0, 60.0));
    println!(
        "inside {inside:.0}, primary {primary:.0}, band {band:.0}, secondary {secondary:.0}, outside {outside:.0} cd/m^2"
    );
    assert!(primary > 1.1 * 0.5 * (inside + band) && inside > 1.1 * band, "{inside} {primary} {band}");
    assert!(secondary > 1.02 * 0.5 * (band + outside), "{band} {secondary} {outside}");
    // Red outside, blue inside, over the light beside it.
    let base = mean(&profile, 44.5, 48.5);
    let [outer, inner] = [(42.0, 42.8), (39.8, 40.8)].map(|(a, b)| mean(&profile, a, b));
    let redness = |v: [f64; 3]| (v[0] - base[0]) / (v[2] - base[2]).max(1.0);
    println!("red over blue outside {:.2}, inside {:.2}", redness(outer), redness(inner));
    assert!(redness(outer) > 2.0 * redness(inner).abs());
}

#[test]
fn a_shower_in_the_distance_has_a_bow_and_one_under_a_closed_deck_none() {
    let area = RainArea {
        center_m: [-4500.0, 0.0, 0.0],
        shape: AreaShape::Ellipse([3000.0, 8000.0]),
        rate_mm_h: 12.0,
        top_m: 3500.0,
        ..RainArea::default()
    };
    let of = |id, weather: &Weather| {
        let mut scene = Scene::new(weather, wgpu::Backends::GL);
        scene.context.set_rain_areas(&[area]).unwrap();
        let profile = scene.profile(id);
        let light = |from, to| luminance(&mean(&profile, from, to));
        light(40.8, 42.2) / light(44.5, 48.5)
    };
    let (lit, dull) = (of(4, &Weather::default()), of(5, &closed()));
    println!("primary over dark band: {lit:.3} in the sun, {dull:.3} under a deck");
    assert!(lit > 1.1 && dull < 1.06, "{lit} {dull}");
}

fn closed() -> Weather {
    Weather::from_metar("LOWI 121150Z 00000KT 9999 OVC060 18/12 Q1015").unwrap().weather
}
