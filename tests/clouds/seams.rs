//! Clouds in situations in which hosts have seen faults: flights through layers, two eyes, two channels, targets and
//! depths of every kind, saved states and time that goes back.

use std::sync::Arc;

use glam::{DMat4, DVec3, DVec4};
use welkin::{
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{ColorSpace, Exposure, Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    rain::{AreaShape, RainArea},
    scene::{Camera, DepthKind, DepthMapping},
    weather::{Weather, Wind},
};
use welkin_support::accept;

use crate::drawn::{BROKEN, CLOSED, SIZE, Sky, p95};

const SEEN: Stages = Stages::BACKGROUND.with(Stages::MEDIUM);
const FORWARD: DVec3 = DVec3::new(0.0, 1.0, 0.35);

fn camera(position: DVec3, forward: DVec3) -> Camera {
    Camera::look_to(position, forward, DVec3::new(0.1, 0.0, 1.0), 1.0, 16.0 / 9.0, 0.1)
}

/// A frame of a view into a target of its own, cd/m^2 a channel or what the target has.
fn take(device: &Device, context: &Context, view: &mut View, frame: &Frame<'_>) -> Vec<[f64; 3]> {
    view.record(context, frame, SEEN).unwrap();
    let texels = readback::rgba(device, frame.color.expect("a target")).unwrap();
    texels.iter().map(|t| [0, 1, 2].map(|k| f64::from(t[k]))).collect()
}

fn mean(picture: &[[f64; 3]]) -> f64 {
    picture.iter().map(luminance).sum::<f64>() / picture.len() as f64
}

/// Climbs through a layer at a speed, with 60 frames/s. Returns the brightness of each frame, and of a picture without
/// history at the same place.
fn fly(report: &str, speed_m_s: f64, from_m: f64, to_m: f64, every: usize) -> Vec<[f64; 2]> {
    let [mut flown, mut fresh] = [0, 1].map(|_| Sky::new(report, CloudModel::Volume));
    // Draws frames until the picture has settled.
    (0..17).for_each(|_| drop(flown.look(FORWARD, from_m, None, FrameFlags(0))));
    let frames = ((to_m - from_m) / speed_m_s * 60.0) as usize;
    let mut seen = Vec::new();
    for i in 0..frames {
        let height_m = from_m + speed_m_s * i as f64 / 60.0;
        let picture = flown.look(FORWARD, height_m, None, FrameFlags(0));
        if i % every == 0 {
            seen.push([mean(&picture), mean(&fresh.look(FORWARD, height_m, None, FrameFlags::NO_HISTORY))]);
        }
    }
    seen
}

/// During a climb each frame shows the clouds at its own place: nothing jumps, and nothing trails behind. With
/// `WELKIN_ACCEPT` the flights go all the way from below a layer to above it, and also more slowly.
#[test]
fn a_climb_through_layers_shows_no_jump() {
    let quick =
        vec![(BROKEN, 300.0, 850.0, 1050.0, 4), (CLOSED, 300.0, 850.0, 1000.0, 4), (BROKEN, 10.0, 912.0, 916.0, 6)];
    let long = vec![
        (CLOSED, 300.0, 600.0, 1500.0, 3),
        (BROKEN, 300.0, 700.0, 2000.0, 3),
        (BROKEN, 100.0, 860.0, 990.0, 3),
        (CLOSED, 10.0, 905.0, 917.0, 3),
    ];
    let flights = if accept() { long } else { quick };
    for (report, speed_m_s, from_m, to_m, every) in flights {
        let seen = fly(report, speed_m_s, from_m, to_m, every);
        let off = seen.iter().map(|[flown, fresh]| (flown / fresh - 1.0).abs());
        let (worst, all) = (off.clone().fold(0.0, f64::max), off.sum::<f64>() / seen.len() as f64);
        let step = |k: usize| seen.windows(2).map(|p| (p[1][k] / p[0][k] - 1.0).abs()).fold(0.0, f64::max);
        println!(
            "{report} at {speed_m_s} m/s: off by {all:.4} on the mean, {worst:.3} at most; steps of {:.3}, without history {:.3}",
            step(0),
            step(1)
        );
        // Pictures with history lag where light changes with height, as it does from the base of a layer to its top.
        assert!(worst < 0.1 && all < 0.03, "{worst} {all}");
        assert!(step(0) < step(1) + 0.05, "{} {}", step(0), step(1));
    }
}

/// The transmittance of a ray through cloud alone ends at 0, not below: the sun's disc behind it takes a root of the
/// transmittance.
#[test]
fn transmittance_through_whole_clouds_is_never_negative() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    for height_m in (520..560).step_by(2) {
        // Reading fails where a texel is not a number.
        sky.look(FORWARD, f64::from(height_m), None, FrameFlags::NO_HISTORY);
    }
}

/// Two views of one context side by side, at rest and turning: both eyes see the same clouds.
#[test]
fn both_eyes_of_a_viewer_see_the_same_clouds() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let mut other = View::new(&sky.context).unwrap();
    let color = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::Rgba32Float, 1);
    let mut pair = |yaw_deg: f64, id: u64| {
        let yaw = yaw_deg.to_radians();
        let forward = DVec3::new(yaw.sin(), yaw.cos(), 0.35);
        let right = DVec3::new(yaw.cos(), -yaw.sin(), 0.0);
        let at = |side: f64| camera(DVec3::Z * 2.0 + right * (0.0325 * side), forward);
        let left = take(&sky.device, &sky.context, &mut sky.view, &Frame::new(id, at(-1.0), &sky.color, None));
        let right = take(&sky.device, &sky.context, &mut other, &Frame::new(id, at(1.0), &color, None));
        p95(&left, &right)
    };
    let rest = (1..=17).map(|id| pair(0.0, id)).last().unwrap();
    let turning = (18..=40).map(|id| pair(f64::from(id as u32 - 17), id)).fold(0.0, f64::max);
    println!("between two eyes: {rest:.4} at rest, {turning:.4} at most while turning");
    assert!(rest < 0.01 && turning < 0.03, "{rest} {turning}");
}

fn context(device: &Arc<Device>) -> Context {
    let shared = Arc::new(Shared::new(device).unwrap());
    let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg: 40.0 })).unwrap();
    context
}

/// Channels, a loaded state and a time that is visited again show the same clouds bit for bit; another seed shows
/// others.
#[test]
fn clouds_follow_from_seed_and_time_alone() {
    let device = Device::headless(&DeviceOptions::default()).unwrap();
    let color = welkin_support::textures::texture(&device, SIZE, wgpu::TextureFormat::Rgba32Float, 1);
    let weather = Weather { wind: Wind::of(12.0, 250.0), ..Weather::from_metar(BROKEN).unwrap().weather };
    let shot = |context: &Context, id: u64| {
        let mut frame = Frame::new(id, camera(DVec3::Z * 2.0, FORWARD), &color, None);
        frame.flags = FrameFlags::NO_HISTORY;
        take(&device, context, &mut View::new(context).unwrap(), &frame)
    };
    let mut first = context(&device);
    first.set_weather(&weather, 0.0, 0.0).unwrap();
    let at_rest = shot(&first, 1);
    first.update(300.0).unwrap();
    let later = shot(&first, 2);
    assert!(p95(&at_rest, &later) > 0.05, "they move and change");
    // Another channel that started late, and one that was loaded.
    let mut second = context(&device);
    second.set_weather(&weather, 0.0, 0.0).unwrap();
    second.update(300.0).unwrap();
    assert_eq!(shot(&second, 77), later);
    let saved = first.save().unwrap();
    let mut third = context(&device);
    third.load(&saved).unwrap();
    assert_eq!(shot(&third, 3), later);
    // Advances, then loads the earlier state.
    first.update(900.0).unwrap();
    first.load(&saved).unwrap();
    assert_eq!(shot(&first, 4), later);
}

/// The picture in every kind of target and with every kind of depth equals that of a float target without depth, within
/// the steps of the target.
#[test]
fn every_target_and_depth_shows_the_same_clouds() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let frame = |id: u64, color| {
        let frame = Frame::new(id, camera(DVec3::Z * 2.0, FORWARD), color, None);
        Frame { flags: FrameFlags::NO_HISTORY, exposure: Some(Exposure::Factor(5e-5)), ..frame }
    };
    let of = |format, samples| welkin_support::textures::texture(&sky.device, SIZE, format, samples);
    let (device, context) = (sky.device.clone(), &sky.context);
    let base = take(&device, context, &mut sky.view, &frame(1, &sky.color));
    // Half floats, logarithmic depth and OpenGL's clip space.
    let halves = of(wgpu::TextureFormat::Rgba16Float, 1);
    let logarithmic = DepthKind::Logarithmic { c: 1.0, far_m: 1e5 };
    let depths = [
        DepthMapping::default(),
        DepthMapping { reversed: true, ..DepthMapping::default() },
        DepthMapping { kind: logarithmic, ..DepthMapping::default() },
    ];
    for (i, depth_mapping) in depths.into_iter().enumerate() {
        let depth = of(wgpu::TextureFormat::R32Float, 1);
        let far = if depth_mapping.reversed { 0.0_f32 } else { 1.0 };
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
        let texels = vec![far; (SIZE.0 * SIZE.1) as usize];
        device.queue.write_texture(depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, depth.size());
        let mut camera = camera(DVec3::Z * 2.0, FORWARD);
        if !depth_mapping.reversed {
            camera.projection = with_far(camera.projection);
        }
        let frame =
            Frame { camera, depth: Some(&depth), depth_mapping, cd_m2_per_unit: 1e3, ..frame(2 + i as u64, &halves) };
        let seen: Vec<[f64; 3]> =
            take(&device, context, &mut sky.view, &frame).iter().map(|c| c.map(|v| v * 1e3)).collect();
        let off = p95(&seen, &base);
        println!("{depth_mapping:?}: {off:.5}");
        assert!(off < 2e-3, "{depth_mapping:?}: {off}");
    }
    // A display's values are those of the tone curve, in steps of 255.
    let bytes = of(wgpu::TextureFormat::Rgba8Unorm, 1);
    for color_space in [ColorSpace::DisplayLinear, ColorSpace::DisplaySrgb] {
        let frame = Frame { color_space, ..frame(9, &bytes) };
        let seen = take(&device, context, &mut View::new(context).unwrap(), &frame);
        let float = Frame { color: Some(&halves), ..frame };
        let fine = take(&device, context, &mut View::new(context).unwrap(), &float);
        let encoded = |v: f64| if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        let want = |v: f64| if color_space == ColorSpace::DisplaySrgb { encoded(v) } else { v };
        let off = seen.iter().flatten().zip(fine.iter().flatten()).map(|(a, b)| (a - want(*b)).abs());
        let worst = off.fold(0.0, f64::max);
        println!("{color_space:?}: off by {:.2} steps at most", 255.0 * worst);
        assert!(worst < 2.5 / 255.0, "{color_space:?}: {worst}");
    }
}

/// The projection with a far end at 100 km and 0 near.
fn with_far(projection: DMat4) -> DMat4 {
    let (near, far) = (0.1, 1e5);
    let mut p = projection;
    p.z_axis = DVec4::new(0.0, 0.0, -far / (far - near), -1.0);
    p.w_axis = DVec4::new(0.0, 0.0, -far * near / (far - near), 0.0);
    p
}

/// Without compute shaders, from a parallel projection, and over several samples a pixel clouds are drawn as well.
#[test]
fn the_least_device_parallel_views_and_several_samples_show_clouds() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let whole = sky.look(FORWARD, 2.0, None, FrameFlags::NO_HISTORY);
    let least = Device::headless(&DeviceOptions { force_tier0: true, ..DeviceOptions::default() }).unwrap();
    let mut bare = context(&least);
    bare.set_weather(&Weather::from_metar(BROKEN).unwrap().weather, 0.0, 0.0).unwrap();
    let color = welkin_support::textures::texture(&least, SIZE, wgpu::TextureFormat::Rgba32Float, 1);
    let mut frame = Frame::new(1, camera(DVec3::Z * 2.0, FORWARD), &color, None);
    frame.flags = FrameFlags::NO_HISTORY;
    let seen = take(&least, &bare, &mut View::new(&bare).unwrap(), &frame);
    let off = p95(&seen, &whole);
    println!("tier 0: off by {off:.5}");
    assert!(off < 1e-3, "{off}");

    // Four samples a pixel, resolved: the sky has no edges, so each sample is the pixel.
    let many = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::Rgba16Float, 4);
    let one = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::Rgba16Float, 1);
    let mut frame = Frame::new(2, camera(DVec3::Z * 2.0, FORWARD), &many, None);
    (frame.flags, frame.cd_m2_per_unit) = (FrameFlags::NO_HISTORY, 1e3);
    sky.view.record(&sky.context, &frame, SEEN).unwrap();
    resolve(&sky.device, &many, &one);
    let texels = readback::rgba(&sky.device, &one).unwrap();
    let seen: Vec<[f64; 3]> = texels.iter().map(|t| [0, 1, 2].map(|k| 1e3 * f64::from(t[k]))).collect();
    let off = p95(&seen, &whole);
    println!("four samples: off by {off:.5}");
    assert!(off < 2e-3, "{off}");

    // A parallel view straight up at one place after another sees cloud and sky, each pixel the same way.
    let mut camera = camera(DVec3::Z * 2.0, DVec3::new(0.0, 0.05, 1.0));
    // 8 km wide, 100 km deep.
    camera.projection = DMat4::from_cols(
        DVec4::new(1.0 / 4000.0, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0 / 2250.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -1e-5, 0.0),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
    );
    let depth_mapping = DepthMapping { kind: DepthKind::Orthographic, ..DepthMapping::default() };
    let mut frame = Frame::new(3, camera, &sky.color, None);
    (frame.flags, frame.depth_mapping) = (FrameFlags::NO_HISTORY, depth_mapping);
    let seen = take(&sky.device, &sky.context, &mut sky.view, &frame);
    let light: Vec<f64> = seen.iter().map(luminance).collect();
    let (dark, bright) = light.iter().fold((f64::MAX, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
    println!("parallel: from {dark:.0} to {bright:.0} cd/m^2");
    assert!(light.iter().all(|v| v.is_finite()) && bright > 2.0 * dark, "{dark} {bright}");
}

fn resolve(device: &Device, from: &wgpu::Texture, to: &wgpu::Texture) {
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let (from, to) = (from.create_view(&Default::default()), to.create_view(&Default::default()));
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &from,
            depth_slice: None,
            resolve_target: Some(&to),
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    }));
    device.queue.submit([encoder.finish()]);
}

/// Columns of rain stand before and behind clouds in the very first frame as in later ones.
#[test]
fn a_shower_among_clouds_is_whole_in_the_first_frame() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let shape = AreaShape::Ellipse([3000.0, 3000.0]);
    let area = RainArea { center_m: [0.0, 5000.0, 0.0], shape, top_m: 2500.0, ..RainArea::default() };
    sky.context.set_rain_areas(&[area]).unwrap();
    let mut shot = |id: u64| {
        let mut frame = Frame::new(id, camera(DVec3::Z * 2.0, FORWARD), &sky.color, None);
        frame.flags = FrameFlags::NO_HISTORY;
        sky.view.record(&sky.context, &frame, SEEN.with(Stages::PARTICLES)).unwrap();
        let texels = readback::rgba(&sky.device, &sky.color).unwrap();
        texels.iter().map(|t| [0, 1, 2].map(|k| f64::from(t[k]))).collect::<Vec<_>>()
    };
    let [first, second, third] = [1, 2, 3].map(&mut shot);
    let off = [p95(&first, &third), p95(&second, &third)];
    println!("first and second frame against the third: {off:.5?}");
    assert!(off[0] < 1e-3 && off[1] < 1e-3, "{off:?}");
}
