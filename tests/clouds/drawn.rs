//! Pictures of clouds.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    scene::Camera,
    weather::Weather,
};

pub const SIZE: (u32, u32) = (96, 54);

pub struct Sky {
    pub device: Arc<Device>,
    pub context: Context,
    pub view: View,
    pub color: wgpu::Texture,
    pub frame_id: u64,
}

impl Sky {
    pub fn new(report: &str, model: CloudModel) -> Self {
        Self::on(&DeviceOptions::default(), report, model)
    }

    /// Creates the sky of a report on a device with these options.
    pub fn on(options: &DeviceOptions, report: &str, model: CloudModel) -> Self {
        let device = Device::headless(options).expect("a software driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
        context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg: 40.0 })).unwrap();
        context.set_cloud_model(model);
        context.set_weather(&Weather::from_metar(report).unwrap().weather, 0.0, 0.0).unwrap();
        let view = View::new(&context).unwrap();
        // OpenGL cannot draw to whole floats.
        let format =
            if options.force_tier0 { wgpu::TextureFormat::Rgba16Float } else { wgpu::TextureFormat::Rgba32Float };
        let color = welkin_support::textures::texture(&device, SIZE, format, 1);
        Self { device, context, view, color, frame_id: 0 }
    }

    /// Draws a frame towards `yaw_deg`, degrees from north over east. Returns its picture, cd/m^2 a channel.
    fn take(&mut self, yaw_deg: f64, height_m: f64, flags: FrameFlags) -> Vec<[f64; 3]> {
        let yaw = yaw_deg.to_radians();
        let forward = DVec3::new(yaw.sin(), yaw.cos(), if height_m > 1e3 { -0.2 } else { 0.35 });
        self.look(forward, height_m, None, flags)
    }

    /// Draws a frame along `forward`, with a host's depth if given. Returns its picture, cd/m^2 a channel.
    pub fn look(
        &mut self,
        forward: DVec3,
        height_m: f64,
        depth: Option<&wgpu::Texture>,
        flags: FrameFlags,
    ) -> Vec<[f64; 3]> {
        self.frame_id += 1;
        let camera = Camera::look_to(DVec3::Z * height_m, forward, DVec3::new(0.1, 0.0, 1.0), 1.0, 16.0 / 9.0, 0.1);
        let mut frame = Frame::new(self.frame_id, camera, &self.color, depth);
        frame.flags = flags;
        self.view.record(&self.context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM)).unwrap();
        let texels = readback::rgba(&self.device, &self.color).unwrap();
        texels.iter().map(|t| [0, 1, 2].map(|k| f64::from(t[k]))).collect()
    }
}

/// 95th percentile of the difference of luminance, relative to the luminance of the second picture plus 1 % of its
/// mean.
pub fn p95(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let white = b.iter().map(luminance).sum::<f64>() / b.len() as f64;
    let off = |(a, b): (&[f64; 3], &[f64; 3])| (luminance(a) - luminance(b)).abs() / (luminance(b) + 0.01 * white);
    let mut all: Vec<f64> = a.iter().zip(b).map(off).collect();
    all.sort_by(f64::total_cmp);
    all[all.len() * 95 / 100]
}

pub const BROKEN: &str = "LOWI 121150Z 00000KT 9999 SCT030 18/12 Q1015";

#[test]
fn a_sky_without_clouds_is_the_same_in_both_models() {
    let report = "LOWI 121150Z 00000KT CAVOK 18/12 Q1015";
    let [mut deck, mut volume] = [CloudModel::Deck, CloudModel::Volume].map(|model| Sky::new(report, model));
    let pure = FrameFlags::NO_HISTORY;
    assert_eq!(deck.take(0.0, 2.0, pure), volume.take(0.0, 2.0, pure));
}

#[test]
fn at_rest_the_picture_comes_to_the_one_marched_whole() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let whole = sky.take(0.0, 2.0, FrameFlags::NO_HISTORY);
    let pictures: Vec<_> = (0..17).map(|_| sky.take(0.0, 2.0, FrameFlags(0))).collect();
    let off: Vec<f64> = pictures.iter().map(|p| p95(p, &whole)).collect();
    println!("error after each frame at rest: {off:.3?}");
    assert!(off[16] < 0.01, "{off:?}");
    assert!(off[0] > off[16], "the first frame marches one pixel of sixteen: {off:?}");
}

#[test]
fn after_a_cut_nothing_old_is_left() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let fresh = {
        let mut other = Sky::new(BROKEN, CloudModel::Volume);
        other.take(0.0, 2.0, FrameFlags::NO_HISTORY);
        other.frame_id = 40;
        other.take(90.0, 2.0, FrameFlags::CUT)
    };
    sky.take(0.0, 2.0, FrameFlags::NO_HISTORY);
    (0..20).for_each(|_| drop(sky.take(0.0, 2.0, FrameFlags(0))));
    sky.frame_id = 40;
    assert!(p95(&sky.take(90.0, 2.0, FrameFlags::CUT), &fresh) < 1e-6);
    let whole = sky.take(90.0, 2.0, FrameFlags::NO_HISTORY);
    sky.take(90.0, 2.0, FrameFlags::CUT);
    let last = (0..16).map(|_| sky.take(90.0, 2.0, FrameFlags(0))).last().unwrap();
    assert!(p95(&last, &whole) < 0.01);
}

/// A turning head leaves no trail: what is seen after a turn is what a fresh view sees.
#[test]
fn a_turning_camera_leaves_no_trail() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    sky.take(-20.0, 2.0, FrameFlags::NO_HISTORY);
    let turned = (0..20).map(|i| sky.take(f64::from(i) - 19.0, 2.0, FrameFlags(0))).last().unwrap();
    let whole = sky.take(0.0, 2.0, FrameFlags::NO_HISTORY);
    let off = p95(&turned, &whole);
    println!("turning by a degree a frame: {off:.3}");
    let mut still = Sky::new(BROKEN, CloudModel::Volume);
    let first = still.take(0.0, 2.0, FrameFlags::CUT);
    assert!(off < 1.05 * p95(&first, &whole), "{off}");
}

#[test]
fn a_closed_layer_hides_the_sky_from_below_and_the_ground_from_above() {
    let mut sky = Sky::new(CLOSED, CloudModel::Volume);
    let mut clear = Sky::new("LOWI 121150Z 00000KT CAVOK 18/12 Q1015", CloudModel::Deck);
    let pure = FrameFlags::NO_HISTORY;
    let spread = |p: &[[f64; 3]]| p.iter().map(|c| c[2] / c[0].max(1e-9)).sum::<f64>() / p.len() as f64;
    let (below, above) = (sky.take(0.0, 2.0, pure), sky.take(0.0, 6000.0, pure));
    let open = clear.take(0.0, 2.0, pure);
    println!("blue over red: under {:.2}, above {:.2}, clear {:.2}", spread(&below), spread(&above), spread(&open));
    assert!(spread(&below) < 1.3 && spread(&open) > 1.6);
    // The last rows look down on the tops.
    let (tops, bases) = (mean(&above[above.len() * 3 / 4..]), mean(&below));
    println!("tops {tops:.0}, bases {bases:.0} cd/m^2");
    assert!(tops > 2.0 * bases, "{tops} {bases}");
    assert!(below.iter().chain(&above).flatten().all(|v| v.is_finite() && *v >= 0.0));
}

pub const CLOSED: &str = "LOWI 121150Z 00000KT 9999 OVC030 18/12 Q1015";

fn mean(picture: &[[f64; 3]]) -> f64 {
    picture.iter().map(luminance).sum::<f64>() / picture.len() as f64
}

/// A closed layer is a deck from far below, and a volume where the camera comes near its base at 914 m.
#[test]
fn a_deck_becomes_a_volume_without_a_jump() {
    let mut sky = Sky::new(CLOSED, CloudModel::Volume);
    let mut deck = Sky::new(CLOSED, CloudModel::Deck);
    let up = DVec3::new(0.0, 0.3, 1.0);
    let pure = FrameFlags::NO_HISTORY;
    assert_eq!(sky.look(up, 2.0, None, pure), deck.look(up, 2.0, None, pure), "from far below it is the deck");
    let seen: Vec<f64> = (0..17).map(|i| mean(&sky.look(up, 450.0 + 25.0 * f64::from(i), None, pure))).collect();
    println!("from 450 m to 850 m: {seen:.0?} cd/m^2");
    for pair in seen.windows(2) {
        assert!((pair[1] / pair[0] - 1.0).abs() < 0.04, "{seen:?}");
    }
    assert!((seen[16] / seen[0] - 1.0).abs() < 0.15, "{seen:?}");
}

/// The light under a closed layer is the same in both models: their laws have nothing in common but the layer.
#[test]
fn volume_and_deck_are_as_bright_as_one_another() {
    let mut sky = Sky::new(CLOSED, CloudModel::Volume);
    let mut deck = Sky::new(CLOSED, CloudModel::Deck);
    let up = DVec3::new(0.0, 0.3, 1.0);
    let (volume, deck) = (
        mean(&sky.look(up, 714.0, None, FrameFlags::NO_HISTORY)),
        mean(&deck.look(up, 714.0, None, FrameFlags::NO_HISTORY)),
    );
    println!("volume {volume:.0}, deck {deck:.0} cd/m^2");
    assert!((volume / deck - 1.0).abs() < 0.1, "{volume} and {deck}");
}

/// A wall 30 m ahead stands before the clouds, one 40 km ahead behind them, and no pixel of either shows what the other
/// hides.
#[test]
fn things_stand_before_and_behind_clouds() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let depth = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::R32Float, 1);
    let mut seen = |range_m: Option<f32>| {
        let texels = vec![range_m.map_or(0.0, |r| 0.1 / r); (SIZE.0 * SIZE.1) as usize];
        let size = wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 };
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
        sky.device.queue.write_texture(depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
        sky.look(DVec3::new(0.0, 1.0, 0.35), 2.0, Some(&depth), FrameFlags::NO_HISTORY)
    };
    let (near, far, open) = (seen(Some(30.0)), seen(Some(40e3)), seen(None));
    // The host drew black: what is seen before it is air, and cloud.
    let brightest = |p: &[[f64; 3]]| p.iter().map(luminance).fold(0.0, f64::max);
    println!(
        "before a wall at 30 m {:.1}, at 40 km {:.0}, the sky {:.0}",
        brightest(&near),
        brightest(&far),
        brightest(&open)
    );
    assert!(brightest(&near) < 0.01 * brightest(&open));
    let rows = |p: &[[f64; 3]]| p[..(SIZE.0 * SIZE.1 / 3) as usize].to_vec();
    let (far, open) = (rows(&far), rows(&open));
    // Clouds of the upper third are within 40 km: their bright tops are as bright before the wall.
    assert!((brightest(&far) / brightest(&open) - 1.0).abs() < 0.02);
}
