//! The height of a layer's base in queries and pictures.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    frame::{Frame, FrameFlags, Stages},
    gpu::readback,
    scene::Camera,
    weather::{CloudKind, CloudLayer, Weather},
};
use welkin_support::accept;

use crate::drawn::{BROKEN, SIZE, Sky};

/// Length of a level look, m: along it the planet's curve rises by 8 cm.
const LOOK_M: f64 = 1000.0;
/// Optical depth from which on a cloud counts as seen.
const SEEN: f64 = 0.1;

fn place(i: usize, height_m: f64) -> DVec3 {
    DVec3::new(900.0 * (i % 20) as f64 - 9000.0, 900.0 * (i / 20) as f64 - 9000.0, height_m)
}

/// Returns the optical depth of clouds and air between two places.
fn depth(sky: &Sky, from: DVec3, to: DVec3) -> f64 {
    -sky.context.between(from, to, 0.0).unwrap().transmittance[1].max(1e-300).ln()
}

/// Returns the lowest height between two at which `is_cloud` holds, by bisection; it holds above and not below.
fn lowest(mut low: f64, mut high: f64, mut is_cloud: impl FnMut(f64) -> bool) -> f64 {
    while high - low > 1e-4 * high {
        let middle = 0.5 * (low + high);
        if is_cloud(middle) { high = middle } else { low = middle }
    }
    high
}

/// Returns the lowest height at which any of 400 level rays meets cloud, m, and the index of that ray.
fn met_m(sky: &Sky, base_m: f64) -> (f64, usize) {
    let first = |z: f64| (0..400).find(|i| depth(sky, place(*i, z), place(*i, z) + DVec3::Y * LOOK_M) > SEEN);
    let (low, high) = (0.9 * base_m, 1.1 * base_m);
    assert!(first(low).is_none() && first(high).is_some());
    let found = lowest(low, high, |z| first(z).is_some());
    (found, first(found).unwrap())
}

/// Returns the median height at which looks straight up end in cloud.
fn over_m(sky: &Sky, base_m: f64) -> f64 {
    let up =
        |i: usize, z: f64| depth(sky, place(i, 2.0), place(i, z)) - depth(sky, place(i, 2.0), place(i, 0.9 * base_m));
    let clouded = (0..400).filter(|i| up(*i, 1.5 * base_m) > 1.0).take(30);
    let mut each: Vec<f64> = clouded.map(|i| lowest(0.9 * base_m, 1.5 * base_m, |z| up(i, z) > SEEN)).collect();
    each.sort_by(f64::total_cmp);
    each[each.len() / 2]
}

/// Fills a texture with one texel.
fn write(sky: &Sky, texture: &wgpu::Texture, texel: &[f32]) {
    let texels = texel.repeat((SIZE.0 * SIZE.1) as usize);
    let size = wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 };
    let bytes_per_row = Some(4 * texel.len() as u32 * SIZE.0);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
    sky.device.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
}

/// Luminance in the middle of a picture along one of the looks, before a black wall at its end.
fn drawn(sky: &mut Sky, depth: &wgpu::Texture, eye: DVec3) -> f64 {
    sky.frame_id += 1;
    write(sky, &sky.color, &[0.0, 0.0, 0.0, 1.0]);
    let camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 0.01, 16.0 / 9.0, 0.1);
    let mut frame = Frame::new(sky.frame_id, camera, &sky.color, Some(depth));
    frame.flags = FrameFlags::NO_HISTORY;
    sky.view.record(&sky.context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM)).unwrap();
    let texels = readback::rgba(&sky.device, &sky.color).unwrap();
    let middle = (SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize;
    f64::from(texels[middle][1])
}

#[test]
fn the_base_that_is_seen_is_the_one_asked_for() {
    for (kind, bases) in [
        (CloudKind::Cumulus, [600.0, 1200.0, 2400.0]),
        (CloudKind::Stratus, [150.0, 300.0, 900.0]),
        (CloudKind::Cumulonimbus, [500.0, 1000.0, 2000.0]),
    ] {
        for base_m in if accept() { &bases[..] } else { &bases[1..2] } {
            let base_m = *base_m;
            let mut sky = Sky::new(BROKEN, CloudModel::default());
            let clouds = vec![CloudLayer::of(kind, 0.5, base_m)];
            sky.context.set_weather(&Weather { clouds, ..Weather::default() }, 0.0, 0.0).unwrap();
            let (met_m, look) = met_m(&sky, base_m);
            let over_m = over_m(&sky, base_m);
            let wall = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::R32Float, 1);
            write(&sky, &wall, &[(0.1 / LOOK_M) as f32]);
            let mut light = |z: f64| drawn(&mut sky, &wall, place(look, z));
            // Some distant cloud is drawn before the wall too, because the planet is curved. The limit is therefore
            // half-way to the luminance inside cloud.
            let (under, within) = (light(0.98 * base_m), light(1.02 * base_m));
            assert!((within / under - 1.0).abs() > 0.3, "{under} {within}");
            let is_within = |light: f64| (light - under).abs() > 0.5 * (within - under).abs();
            let drawn_m = lowest(0.98 * base_m, 1.02 * base_m, |z| is_within(light(z)));
            println!(
                "{kind:?} at {base_m} m: met at {met_m:.1} m, half overhead at {over_m:.1} m, drawn at {drawn_m:.1} m"
            );
            for (name, seen_m) in [("met", met_m), ("overhead", over_m), ("drawn", drawn_m)] {
                assert!((seen_m / base_m - 1.0).abs() < 0.01, "{kind:?} at {base_m} m: {name} at {seen_m} m");
            }
        }
    }
}
