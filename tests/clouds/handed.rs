//! The map of shadows for a host's own materials.

use glam::DVec3;
use welkin::{
    clouds::{CloudModel, CloudShadows},
    frame::{FrameFlags, Stages},
    gpu::readback,
    scene::Camera,
    weather::{Weather, Wind},
};

use crate::{
    drawn::Sky,
    shadows::{SCATTERED, over_ground},
};

/// The published sampling function on the CPU, with the texture's texels.
fn share(map: &CloudShadows, texels: &[u8], place: DVec3) -> f64 {
    let size = i64::from(map.texture.width());
    let [u, v] = map.uv_from_world.map(|row| row.dot(place.extend(1.0)));
    let height = map.height_from_world.dot(place.extend(1.0));
    let at = |x: i64, y: i64| f64::from(texels[(y.rem_euclid(size) * size + x.rem_euclid(size)) as usize]) / 255.0;
    let (x, y) = (u * size as f64 - 0.5, v * size as f64 - 0.5);
    let (i, j) = (x.floor(), y.floor());
    let row = |y: i64| at(i as i64, y) + (at(i as i64 + 1, y) - at(i as i64, y)) * (x - i);
    let here = row(j as i64) + (row(j as i64 + 1) - row(j as i64)) * (y - j);
    let far = (u - map.camera_uv[0]).abs().max((v - map.camera_uv[1]).abs());
    let weight =
        map.map_weight * ((0.46 - far) / 0.06).clamp(0.0, 1.0) * ((map.top_m - height) / 100.0).clamp(0.0, 1.0);
    map.mean_share + (here - map.mean_share) * weight
}

fn record(sky: &mut Sky, position: DVec3, stages: Stages, flags: FrameFlags) {
    sky.frame_id += 1;
    let camera = Camera::look_to(position, DVec3::Y, DVec3::Z, 1.0, 16.0 / 9.0, 0.1);
    let mut frame = welkin::frame::Frame::new(sky.frame_id, camera, &sky.color, None);
    frame.flags = flags;
    sky.view.record(&sky.context, &frame, stages).unwrap();
}

/// Returns the error of the map's shares at places around the camera: median and 95th percentile.
fn off(sky: &mut Sky, eye: DVec3, time_s: f64) -> [f64; 2] {
    let map = sky.view.cloud_shadows().unwrap();
    let texels = readback::bytes(&sky.device, &map.texture, 0).unwrap();
    let mut off: Vec<f64> = (0..600)
        .map(|i| {
            let away = DVec3::new(f64::from(i % 30) - 14.5, f64::from(i / 30) - 9.5, 0.0) * 211.0;
            let place = DVec3::new(eye.x, eye.y, f64::from(i % 7) * 40.0) + away;
            (share(&map, &texels, place) - sky.context.sun_share(place, time_s).unwrap()).abs()
        })
        .collect();
    off.sort_by(f64::total_cmp);
    [off[off.len() / 2], off[off.len() * 95 / 100]]
}

#[test]
fn a_host_reads_the_shadow_of_any_place_from_the_map() {
    let mut sky = Sky::new(SCATTERED, CloudModel::Volume);
    let weather = Weather { wind: Wind::of(8.0, 250.0), ..Weather::from_metar(SCATTERED).unwrap().weather };
    sky.context.set_weather(&weather, 0.0, 0.0).unwrap();
    assert_eq!(sky.view.cloud_shadows().unwrap().map_weight, 0.0, "no frame yet");
    for (eye, time_s, flags) in [
        (DVec3::new(0.0, 0.0, 2.0), 0.0, FrameFlags::NO_HISTORY),
        (DVec3::new(3210.0, -15_400.0, 120.0), 400.0, FrameFlags::NO_HISTORY),
    ] {
        sky.context.update(time_s).unwrap();
        // Nothing has to be drawn.
        record(&mut sky, eye, Stages::PREPARE, flags);
        let [half, most] = off(&mut sky, eye, time_s);
        println!("map of shadows: off by {half:.4} in the median, {most:.3} at 95 %");
        assert!(half < 0.02 && most < 0.16, "{half} {most}");
    }
    // After a cut the map is coarse, and within a second of frames whole again.
    let eye = DVec3::new(3210.0, -15_400.0, 120.0);
    record(&mut sky, eye, Stages::PREPARE, FrameFlags::CUT);
    let cut = off(&mut sky, eye, 400.0);
    (0..16).for_each(|_| record(&mut sky, eye, Stages::PREPARE, FrameFlags(0)));
    let settled = off(&mut sky, eye, 400.0);
    println!("after a cut {cut:.3?}, then {settled:.3?}");
    assert!(cut[1] > settled[1] && settled[0] < 0.02 && settled[1] < 0.16);
}

#[test]
fn shadows_are_drawn_once_and_the_mean_holds_without_broken_clouds() {
    let mut sky = Sky::new(SCATTERED, CloudModel::Volume);
    let spread = |v: &[f64]| v.iter().fold(0.0, |m: f64, x| m.max(*x)) / v.iter().fold(f64::MAX, |m: f64, x| m.min(*x));
    let laid = over_ground(&mut sky, 1e6, FrameFlags::NO_HISTORY);
    let map = sky.view.cloud_shadows().unwrap();
    let left = over_ground(&mut sky, 1e6, FrameFlags::NO_HISTORY);
    println!(
        "brightest over darkest ground: {:.2} with shadows of Welkin's, {:.2} without",
        spread(&laid),
        spread(&left)
    );
    assert!(spread(&laid) > 2.0 && spread(&left) < 1.2, "{} {}", spread(&laid), spread(&left));
    // The texture stays the same as long as the view lives.
    assert_eq!(sky.view.cloud_shadows().unwrap().texture, map.texture);
    let mean = sky.context.light_at(DVec3::ZERO, 0.0).unwrap().sun.direct_share;
    sky.context.set_cloud_model(CloudModel::Deck);
    record(&mut sky, DVec3::Z * 2.0, Stages::PREPARE, FrameFlags::NO_HISTORY);
    let even = sky.view.cloud_shadows().unwrap();
    assert_eq!((even.map_weight, even.texture.clone()), (0.0, map.texture.clone()));
    assert!((share(&even, &[128; 512 * 512], DVec3::ZERO) - mean).abs() < 1e-6, "the mean");
}
