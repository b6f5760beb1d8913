//! Shadows of clouds on what the host drew.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    frame::{Frame, FrameFlags, Stages},
    gpu::readback,
    scene::Camera,
};
use welkin_support::depth_texture::depth_texture;

use crate::drawn::{SIZE, Sky};

/// Height of the camera that looks straight down at level ground.
const HEIGHT_M: f64 = 2500.0;
pub const SCATTERED: &str = "LOWI 121150Z 00000KT 9999 SCT100 18/12 Q1015";

/// Draws a frame with these flags, looking straight down on level ground of this luminance. Returns the green channel.
pub fn over_ground(sky: &mut Sky, luminance: f32, flags: FrameFlags) -> Vec<f64> {
    over_ground_from(sky, (DVec3::ZERO, 1.0), luminance, flags)
}

/// Draws as [`over_ground`] does, from above the place `over_m` and with this vertical field of view, rad.
fn over_ground_from(sky: &mut Sky, (over_m, fov): (DVec3, f64), luminance: f32, flags: FrameFlags) -> Vec<f64> {
    let camera = Camera::look_to(over_m + DVec3::Z * HEIGHT_M, DVec3::NEG_Z, DVec3::Y, fov, 16.0 / 9.0, 0.1);
    over_host(sky, camera, (HEIGHT_M, luminance), flags)
}

/// Draws a frame over a host's picture, which is a plane of this luminance `plane_m` in front of the camera; infinity
/// means that the host drew nothing. Returns the green channel.
pub fn over_host(sky: &mut Sky, camera: Camera, (plane_m, luminance): (f64, f32), flags: FrameFlags) -> Vec<f64> {
    let count = (SIZE.0 * SIZE.1) as usize;
    let depth = depth_texture(&sky.device, SIZE, &vec![(0.1 / plane_m) as f32; count]);
    let host = [luminance, luminance, luminance, 1.0].repeat(count);
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * SIZE.0), rows_per_image: None };
    sky.device.queue.write_texture(sky.color.as_image_copy(), bytemuck::cast_slice(&host), rows, sky.color.size());
    sky.frame_id += 1;
    let mut frame = Frame::new(sky.frame_id, camera, &sky.color, Some(&depth));
    frame.flags = flags;
    let stages = Stages::BACKGROUND.with(Stages::MEDIUM).with(Stages::SURFACE);
    sky.view.record(&sky.context, &frame, stages).unwrap();
    readback::rgba(&sky.device, &sky.color).unwrap().iter().map(|t| f64::from(t[1])).collect()
}

/// Returns the share of the ground's light that the shadows leave, pixel by pixel.
fn left_of_ground(sky: &mut Sky) -> Vec<f64> {
    let of = FrameFlags::NO_HISTORY;
    let (dark, bright) = (over_ground(sky, 0.0, of), over_ground(sky, 1e4, of));
    bright.iter().zip(dark).map(|(bright, dark)| (bright - dark) / 1e4).collect()
}

#[test]
fn the_shadow_on_each_pixel_is_that_of_its_place() {
    let [mut sky, mut deck] = [CloudModel::Volume, CloudModel::Deck].map(|model| Sky::new(SCATTERED, model));
    let (shaded, even) = (left_of_ground(&mut sky), left_of_ground(&mut deck));
    // In pictures the strength of the shadows follows from the light at the camera.
    let light = sky.context.light_at(DVec3::Z * HEIGHT_M, 0.0).unwrap();
    let direct = light.arriving.sun_lux[1] * light.sun.direction.z;
    let strength = direct / light.sun.direct_share / (direct + light.arriving.sky_lux[1]);
    let (half, aspect) = (HEIGHT_M * 0.5f64.tan(), 16.0 / 9.0);
    let (mut off, mut shares) = (Vec::new(), Vec::new());
    for i in (0..shaded.len()).step_by(7) {
        let (x, y) = (i as u32 % SIZE.0, i as u32 / SIZE.0);
        let at = |p: u32, of: u32| (f64::from(p) + 0.5) / f64::from(of) * 2.0 - 1.0;
        let place = DVec3::new(at(x, SIZE.0) * half * aspect, -at(y, SIZE.1) * half, 0.0);
        let want = sky.context.sun_share(place, 0.0).unwrap();
        let got = (shaded[i] / even[i] - 1.0) / strength + light.sun.direct_share;
        off.push((got - want).abs());
        shares.push(want);
    }
    off.sort_by(f64::total_cmp);
    let (half, most) = (off[off.len() / 2], off[off.len() * 95 / 100]);
    let lit = shares.iter().filter(|s| **s > 0.9).count() as f64 / shares.len() as f64;
    let dark = shares.iter().filter(|s| **s < 0.1).count() as f64 / shares.len() as f64;
    println!("shadows: off by {half:.4} in the median, {most:.3} at 95 %; {lit:.2} lit, {dark:.2} dark");
    assert!(lit > 0.1 && dark > 0.05, "the picture holds light and shadow: {lit} {dark}");
    assert!(half < 0.02 && most < 0.16, "{half} {most}");
}

#[test]
fn the_mean_share_over_places_is_the_queried_one() {
    let sky = Sky::new(SCATTERED, CloudModel::Volume);
    let queried = sky.context.light_at(DVec3::ZERO, 0.0).unwrap().sun.direct_share;
    let place = |i: i32| DVec3::new(f64::from(i % 24) * 1733.0, f64::from(i / 24) * 1541.0, 0.0);
    let shares: Vec<f64> = (0..24 * 24).map(|i| sky.context.sun_share(place(i), 0.0).unwrap()).collect();
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    println!("share of direct light: queried {queried:.3}, on the mean {mean:.3}");
    assert!((mean - queried).abs() < 0.1);
    let deck = Sky::new(SCATTERED, CloudModel::Deck);
    assert_eq!(deck.context.sun_share(DVec3::ZERO, 0.0).unwrap(), queried);
    assert_eq!(sky.context.sun_share(DVec3::Z * 12e3, 0.0).unwrap(), 1.0, "above all clouds");
}

#[test]
fn after_a_cut_shadows_are_coarse_for_sixteen_frames_and_then_as_without_history() {
    let mut sky = Sky::new(SCATTERED, CloudModel::Volume);
    let luminance = 1e6;
    let whole = over_ground(&mut sky, luminance, FrameFlags::NO_HISTORY);
    let off = |picture: &[f64]| {
        let mut off: Vec<f64> = picture.iter().zip(&whole).map(|(a, b)| (a / b - 1.0).abs()).collect();
        off.sort_by(f64::total_cmp);
        [50, 95].map(|percent| off[off.len() * percent / 100])
    };
    let cut = off(&over_ground(&mut sky, luminance, FrameFlags::CUT));
    (0..15).for_each(|_| drop(over_ground(&mut sky, luminance, FrameFlags(0))));
    let settled = off(&over_ground(&mut sky, luminance, FrameFlags(0)));
    println!("shadows after a cut: off by {cut:.3?} in the median and at 95 %, then {settled:.4?}");
    assert!(cut[0] < 0.1 && cut[1] > 0.1, "coarse, yet shadows: {cut:?}");
    assert!(settled[1] < 0.01, "{settled:?}");
}

#[test]
fn shadows_and_mirrored_clouds_are_made_as_they_grow_old_and_in_turns() {
    let mut sky = Sky::new("LOWI 121150Z 24012KT 9999 -RA SCT030 18/12 Q1015", CloudModel::Volume);
    let mut passes = |from: u32| -> Vec<u32> {
        let one = |i: u32| {
            sky.context.update(f64::from(i) / 60.0).unwrap();
            over_ground(&mut sky, 1e4, FrameFlags(0));
            sky.view.report().passes
        };
        (from..from + 32).map(one).collect()
    };
    passes(0);
    let settled = passes(32);
    println!("passes of a wet frame under broken clouds: {settled:?}");
    // Four passes: march, follow, resolve and the composition. A fifth is in frames that refresh old rows of the map of
    // shadows or of the mirrored clouds.
    assert!(settled.iter().all(|passes| matches!(passes, 4..=5)), "{settled:?}");
    let of_maps = settled.iter().filter(|passes| **passes == 5).count();
    assert!((4..=10).contains(&of_maps), "{settled:?}");
}

#[test]
fn shadows_of_a_day_that_goes_on_are_those_of_their_moment() {
    for (what, speed_m_s) in [("in a parked car", 0.0), ("in a car", 30.0), ("in a jet", 300.0)] {
        let mut sky = Sky::new(SCATTERED, CloudModel::Volume);
        let mut seen = |time_s: f64, flags| {
            sky.context.update(time_s).unwrap();
            over_ground_from(&mut sky, (DVec3::X * (speed_m_s * time_s), 2.2), 1e6, flags)
        };
        (0..300).for_each(|i| drop(seen(f64::from(i) / 30.0, FrameFlags(0))));
        let (kept, whole) = (seen(10.0, FrameFlags(0)), seen(10.0, FrameFlags::NO_HISTORY));
        let mut off: Vec<f64> = kept.iter().zip(&whole).map(|(a, b)| (a / b - 1.0).abs()).collect();
        off.sort_by(f64::total_cmp);
        let off = [50, 95, 99].map(|percent| off[off.len() * percent / 100]);
        println!("shadows after ten seconds {what}: off by {off:.4?} in the median, at 95 and 99 %");
        assert!(off[1] < 0.02, "{what}: {off:?}");
    }
}
