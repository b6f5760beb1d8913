//! Pictures of the sea, to be looked at. They are drawn only into a folder that `WELKIN_PICTURES` names.

use std::{path::Path, sync::Arc};

use glam::DVec3;
use image::RgbImage;

use super::textures::texture;
use crate::{
    almanac::celestial::direction,
    context::{Context, ContextDesc, GivenDirection},
    frame::{DepthAccess, Frame, FrameFlags, Stages, View},
    gpu::{Device, DeviceOptions, Shared, readback},
    scene::Camera,
    sea::{SeaSettings, WindSea},
    weather::{CloudKind, CloudLayer, Weather, Wind},
};

/// Size of the pictures; each pixel is the mean of 2 x 2 drawn ones.
const SIZE: (u32, u32) = (640, 360);
const DRAWN: (u32, u32) = (2 * SIZE.0, 2 * SIZE.1);
/// Direction of the cameras, degrees clockwise from north.
const AZIMUTH_DEG: f64 = 60.0;

/// A picture: wind with its direction, wave height with its period, sun, and camera.
struct Seascape {
    name: &'static str,
    wind: [f64; 2],
    /// Significant height, m, and peak period, s; `None` for the sea of the wind.
    waves: Option<[f64; 2]>,
    /// Azimuth and elevation of the sun, degrees.
    sun: [f64; 2],
    /// Share of the sky under stratocumulus.
    cover: f64,
    eye_m: f64,
    pitch_deg: f64,
    fov_deg: f64,
}

const SEASCAPES: &[Seascape] = &[
    Seascape {
        name: "sea_dawn",
        wind: [1.5, 40.0],
        waves: None,
        sun: [75.0, 2.0],
        cover: 0.0,
        eye_m: 6.0,
        pitch_deg: -4.0,
        fov_deg: 40.0,
    },
    Seascape {
        name: "sea_breeze",
        wind: [5.0, 20.0],
        waves: None,
        sun: [170.0, 55.0],
        cover: 0.0,
        eye_m: 8.0,
        pitch_deg: -8.0,
        fov_deg: 45.0,
    },
    Seascape {
        name: "sea_storm",
        wind: [20.0, 70.0],
        waves: Some([7.0, 11.0]),
        sun: [170.0, 35.0],
        cover: 1.0,
        eye_m: 15.0,
        pitch_deg: -6.0,
        fov_deg: 45.0,
    },
    Seascape {
        name: "sea_glitter",
        wind: [6.0, 0.0],
        waves: None,
        sun: [60.0, 14.0],
        cover: 0.0,
        eye_m: 25.0,
        pitch_deg: -9.0,
        fov_deg: 50.0,
    },
    Seascape {
        name: "sea_from_above",
        wind: [9.0, 20.0],
        waves: None,
        sun: [200.0, 40.0],
        cover: 0.0,
        eye_m: 1500.0,
        pitch_deg: -50.0,
        fov_deg: 60.0,
    },
];

#[test]
fn pictures_of_the_sea_are_written_to_look_at() {
    let Some(folder) = std::env::var_os("WELKIN_PICTURES") else { return };
    let device: Arc<Device> = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    for scape in SEASCAPES {
        let path = Path::new(&folder).join(format!("{}.png", scape.name));
        picture(&device, scape).save(&path).expect("a folder to write into");
        println!("{}", path.display());
    }
}

/// Draws a picture as a display shows it.
fn picture(device: &Arc<Device>, scape: &Seascape) -> RgbImage {
    let mut context =
        Context::new(device.clone(), Arc::new(Shared::new(device).unwrap()), ContextDesc::default()).unwrap();
    let [azimuth_deg, elevation_deg] = scape.sun;
    context.set_sun(Some(GivenDirection { azimuth_deg, elevation_deg })).unwrap();
    let [speed, from_deg] = scape.wind;
    let cloud = (scape.cover > 0.0).then(|| CloudLayer::of(CloudKind::Stratocumulus, scape.cover, 900.0));
    let clouds = cloud.into_iter().collect();
    context.set_weather(&Weather { wind: Wind::of(speed, from_deg), clouds, ..Weather::default() }, 0.0, 0.0).unwrap();
    let wind_sea = scape.waves.map_or(WindSea::Weather, |[significant_m, period_s]| WindSea::Height {
        significant_m,
        peak_period_s: Some(period_s),
        gamma: None,
    });
    context.set_sea(Some(SeaSettings { wind_sea, ..SeaSettings::default() })).unwrap();
    context.build_sky(&mut |_| true).unwrap();
    let color = texture(device, DRAWN, wgpu::TextureFormat::Rgba16Float, 1);
    let depth = texture(device, DRAWN, wgpu::TextureFormat::Depth32Float, 1);
    let forward = direction(AZIMUTH_DEG, scape.pitch_deg);
    let aspect = f64::from(DRAWN.0) / f64::from(DRAWN.1);
    let eye = DVec3::Z * scape.eye_m;
    let camera = Camera::look_to(eye, forward, DVec3::Z, scape.fov_deg.to_radians(), aspect, 0.1);
    // A texture begins as zeros: nothing is drawn, and with reversed depth all is far.
    let mut frame = Frame::new(1, camera, &color, Some(&depth));
    (frame.depth_access, frame.flags) = (DepthAccess::ReadWrite, FrameFlags::NO_HISTORY);
    View::new(&context).unwrap().record(&context, &frame, Stages::ALL).unwrap();
    let texels = readback::rgba(device, &color).unwrap();
    RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| {
        let at = |dx: u32, dy: u32| texels[((2 * y + dy) * DRAWN.0 + 2 * x + dx) as usize];
        let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        let shown = |n: usize| {
            let v = 0.25 * four.iter().map(|texel| f64::from(texel[n])).sum::<f64>().clamp(0.0, 4.0);
            let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
            (255.0 * encoded + 0.5) as u8
        };
        image::Rgb([shown(0), shown(1), shown(2)])
    })
}
