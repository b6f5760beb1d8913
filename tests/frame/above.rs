//! Pictures from above the cloud that rain falls from.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    scene::Camera,
    weather::Weather,
};

const HEIGHTS_M: [f64; 4] = [2.0, 2000.0, 3500.0, 12_000.0];

#[test]
fn nothing_of_the_rain_is_seen_in_the_sky_above_it() {
    let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    let shared = Arc::new(Shared::new(&device).unwrap());
    let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 10.0, elevation_deg: 20.0 })).unwrap();
    let mut view = View::new(&context).unwrap();
    let color = welkin_support::textures::texture(&device, (64, 36), wgpu::TextureFormat::Rgba32Float, 1);
    let mut id = 0;
    let hail = Weather::from_metar("LOWI 121150Z 24008KT 9000 TSGR BKN030CB 12/11 Q1005").unwrap().weather;
    let weathers = [(Weather::preset("rain").unwrap(), 1000), (hail, 0)];
    for ((weather, least), height_m) in weathers.iter().flat_map(|w| HEIGHTS_M.map(|h| (w, h))) {
        context.set_weather(weather, 0.0, 0.0).unwrap();
        let mut picture = |stages| {
            id += 1;
            let camera =
                Camera::look_to(DVec3::Z * height_m, DVec3::new(0.0, 0.94, 0.34), DVec3::Z, 0.8, 16.0 / 9.0, 0.1);
            let mut frame = Frame::new(id, camera, &color, None);
            frame.flags = FrameFlags::NO_HISTORY;
            view.record(&context, &frame, stages).unwrap();
            let texels = readback::rgba(&device, &color).unwrap();
            texels.iter().map(|t| luminance(&[0, 1, 2].map(|k| f64::from(t[k])))).collect::<Vec<_>>()
        };
        let sky = Stages::BACKGROUND.with(Stages::MEDIUM);
        let (without, with) = (picture(sky), picture(sky.with(Stages::PARTICLES)));
        let changed = without.iter().zip(&with).filter(|(a, b)| a != b).count();
        let falls = context.conditions_at(DVec3::Z * height_m, 0.0).unwrap().precipitation.total_mm_h() > 0.0;
        println!("{height_m} m: {changed} pixels changed by what falls, if anything: {falls}");
        assert_eq!(falls, height_m < 100.0);
        assert!(if falls { changed > *least } else { changed == 0 }, "{height_m} m: {changed} pixels");
        assert!(falls || view.report().rain.drops == 0, "{height_m} m");
    }
}
