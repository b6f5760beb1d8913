//! The three colour spaces of a host, masks, samples and orientation, each compared with the scene-linear frame.

use glam::{DMat3, DVec3};
use welkin::{
    frame::{ColorSpace, Exposure, Frame, Stages, ToneCurve, tone},
    rain::{Planes, Shelter},
    scene::Camera,
    weather::{Precipitation, PrecipitationKind, Weather},
};
use welkin_support::{
    frame_host::{Host, SIZE, camera, texture},
    opaque::{Opaque, draw_opaque},
};

pub const EXPOSURE: f64 = 2e-4;
const WALL_DEPTH: f32 = 5e-5; // 2 km in front of the camera's 0.1 m near plane

fn draw(host: &mut Host, space: ColorSpace, stages: Stages, value: f64) -> Vec<[f32; 4]> {
    host.clear([value, value, value, 1.0], WALL_DEPTH);
    let mut frame = Frame::new(1, camera(), &host.color, Some(&host.depth));
    frame.color_space = space;
    frame.exposure = Some(Exposure::Factor(EXPOSURE));
    host.view.record(&host.context, &frame, stages).unwrap();
    // The next call may use the same id again.
    frame.frame_id = 2;
    host.view.record(&host.context, &frame, Stages::PREPARE).unwrap();
    host.pixels()
}

/// Light added and transmittance of the wall's pixels, from two scene-linear frames.
pub fn veil() -> Vec<([f64; 3], [f64; 3])> {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let black = draw(&mut host, ColorSpace::SceneLinear, Stages::MEDIUM, 0.0);
    let grey = draw(&mut host, ColorSpace::SceneLinear, Stages::MEDIUM, 8192.0);
    let light = |p: &[f32; 4]| [0, 1, 2].map(|c| f64::from(p[c]));
    black.iter().zip(&grey).map(|(b, g)| (light(b), [0, 1, 2].map(|c| f64::from(g[c] - b[c]) / 8192.0))).collect()
}

#[test]
fn the_veil_has_light_and_lets_some_light_through() {
    for (light, through) in veil() {
        assert!(light[2] > 10.0 && through[2] > 0.3 && through[2] < 0.999, "{light:?} {through:?}");
    }
}

#[test]
fn display_hosts_keep_their_own_tone_and_get_welkins_light_tone_mapped() {
    let veil = veil();
    let curve = ToneCurve::default();
    let cases = [
        (ColorSpace::DisplayLinear, wgpu::TextureFormat::Rgba16Float, 0.002),
        (ColorSpace::DisplaySrgb, wgpu::TextureFormat::Rgba8UnormSrgb, 0.012),
        (ColorSpace::DisplaySrgb, wgpu::TextureFormat::Rgba8Unorm, 0.012),
    ];
    for (space, format, tolerance) in cases {
        let mut host = Host::new(format);
        // A clear value means linear in float and Srgb formats, the encoded one in a plain format.
        let value = 0.25;
        let linear = if format == wgpu::TextureFormat::Rgba8Unorm { tone::srgb_decode(value) } else { value };
        for (p, (light, through)) in draw(&mut host, space, Stages::MEDIUM, value).iter().zip(&veil) {
            for c in 0..3 {
                let want = linear * through[c] + curve.apply(EXPOSURE * light[c]);
                let want = if space == ColorSpace::DisplaySrgb { tone::srgb_encode(want) } else { want };
                assert!((f64::from(p[c]) - want).abs() < tolerance, "{space:?} {format:?}: {p:?}, want {want} at {c}");
            }
        }
    }
}

#[test]
fn tone_maps_scene_linear_hosts_only() {
    let veil = veil();
    let curve = ToneCurve::default();
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let both = Stages::MEDIUM.with(Stages::TONE);
    for (p, (light, through)) in draw(&mut host, ColorSpace::SceneLinear, both, 3000.0).iter().zip(&veil) {
        let want = curve.apply(EXPOSURE * (3000.0 * through[1] + light[1]));
        assert!((f64::from(p[1]) - want).abs() < 2e-3, "{p:?} want {want}");
    }
    // In display colour spaces the stage TONE does nothing, alone or together with others.
    for space in [ColorSpace::DisplayLinear, ColorSpace::DisplaySrgb] {
        let with = draw(&mut host, space, both, 0.25);
        assert_eq!(with, draw(&mut host, space, Stages::MEDIUM, 0.25), "{space:?}");
        let untouched = draw(&mut host, space, Stages::TONE, 0.25);
        assert!(untouched.iter().all(|p| p[..3] == [0.25; 3]), "{space:?}");
    }
}

#[test]
fn the_mask_keeps_the_hosts_pixels() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    host.clear([1.0, 2.0, 3.0, 1.0], 0.0);
    let mask = texture(&host.device, wgpu::TextureFormat::R8Unorm, 1);
    let rows: Vec<u8> = (0..SIZE.0 * SIZE.1).map(|i| if i % SIZE.0 < 80 { 255 } else { 0 }).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.0), rows_per_image: None };
    host.device.queue.write_texture(mask.as_image_copy(), &rows, layout, mask.size());
    let mut frame = Frame::new(1, camera(), &host.color, Some(&host.depth));
    frame.mask = Some(&mask);
    host.view.record(&host.context, &frame, Stages::BACKGROUND).unwrap();
    let pixels = host.pixels();
    assert_eq!(pixels[10], [1.0, 2.0, 3.0, 1.0]);
    assert!(pixels[120][2] > 100.0);
}

#[test]
fn bottom_left_origin_is_the_same_picture_upside_down() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let up = Camera::look_to(DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, 1.0, 0.4), DVec3::Z, 1.2, 16.0 / 9.0, 0.1);
    let mut pictures = Vec::new();
    for (id, bottom) in [(1, false), (2, true)] {
        host.clear([0.0; 4], 0.0);
        let mut frame = Frame::new(id, up, &host.color, Some(&host.depth));
        frame.origin_bottom_left = bottom;
        host.view.record(&host.context, &frame, Stages::BACKGROUND).unwrap();
        pictures.push(host.pixels());
    }
    let (w, h) = (SIZE.0 as usize, SIZE.1 as usize);
    let mut differs = 0.0f32;
    for y in 0..h {
        for x in 0..w {
            let (a, b) = (pictures[0][y * w + x], pictures[1][(h - 1 - y) * w + x]);
            assert!((a[2] - b[2]).abs() <= 2e-3 * a[2], "{x} {y}: {a:?} {b:?}");
            differs = differs.max((a[2] - pictures[1][y * w + x][2]).abs());
        }
    }
    assert!(differs > 10.0, "the picture has an up and a down");
}

#[test]
fn every_sample_of_a_multisampled_host_is_composed_by_its_own_depth() {
    let host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let color = texture(&host.device, wgpu::TextureFormat::Rgba16Float, 4);
    let depth = texture(&host.device, wgpu::TextureFormat::Depth32Float, 4);
    let mut multi = Host { color, depth, ..host };
    let mut pixel = |far: f32| {
        multi.clear([100.0, 100.0, 100.0, 1.0], far);
        multi.record(u64::from(far.to_bits()), Stages::BACKGROUND.with(Stages::MEDIUM)).unwrap();
        resolve(&multi)[80 * 4]
    };
    let (sky, wall) = (pixel(0.0), pixel(0.01));
    assert!(sky[2] > 500.0, "{sky:?}");
    assert!((wall[2] - 100.0).abs() < 20.0, "a wall 10 m away keeps its colour: {wall:?}");
}

/// Draws what covers the picture below a slanted line into multisampled colour and depth, as a host would.
const EDGE: &str = "
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    let at = array(vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 0.37));
    return vec4(at[i], 0.01, 1.0);
}
@fragment fn wall() -> @location(0) vec4<f32> { return vec4(400.0, 400.0, 400.0, 1.0); }
";

fn draw_edge(host: &Host) {
    let edge = Opaque { shader: EDGE, vertices: 3, passes: wgpu::CompareFunction::Always };
    let encoder = draw_opaque(&host.device.device, &edge, &host.color, &host.depth);
    host.device.submit_and_wait(encoder).unwrap();
}

/// The mean of each pixel's samples.
pub fn resolve(host: &Host) -> Vec<[f32; 4]> {
    let to = texture(&host.device, host.color.format(), 1);
    let (from, target) = (host.color.create_view(&Default::default()), to.create_view(&Default::default()));
    let mut encoder = host.device.device.create_command_encoder(&Default::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &from,
            depth_slice: None,
            resolve_target: Some(&target),
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    host.device.submit_and_wait(encoder).unwrap();
    welkin::gpu::readback::rgba(&host.device, &to).unwrap()
}

/// Where a wall's edge crosses a pixel, some of its samples show the wall and some the sky: the pixel is their mean.
#[test]
fn a_pixel_at_an_edge_is_the_mean_of_its_samples_composed_one_by_one() {
    const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
    let host = Host::new(FORMAT);
    let served = |f: wgpu::TextureFormat| host.device.adapter.get_texture_format_features(f).flags;
    let (of_color, of_depth) = (served(FORMAT), served(wgpu::TextureFormat::Depth32Float));
    let mut counts = vec![2, 4, 8];
    counts.retain(|&n| of_color.sample_count_supported(n) && of_depth.sample_count_supported(n));
    assert!(counts.contains(&4), "every driver has four samples");
    let mut host = host;
    for samples in counts {
        let color = texture(&host.device, FORMAT, samples);
        let depth = texture(&host.device, wgpu::TextureFormat::Depth32Float, samples);
        let mut multi = Host { color, depth, ..host };
        let mut id = 0;
        // The host's own picture, and with Welkin's sky and air in it.
        let mut shoot = |multi: &mut Host, wall: f64, depth: f32, edge: bool| {
            multi.clear([wall, wall, wall, 1.0], depth);
            if edge {
                draw_edge(multi);
            }
            let bare = resolve(multi);
            id += 1;
            multi.record(id, Stages::BACKGROUND.with(Stages::MEDIUM)).unwrap();
            (bare, resolve(multi))
        };
        let (_, sky) = shoot(&mut multi, 0.0, 0.0, false);
        let (_, wall) = shoot(&mut multi, 400.0, 0.01, false);
        let (covered, edge) = shoot(&mut multi, 0.0, 0.0, true);
        let mut partly = std::collections::BTreeSet::new();
        for (i, got) in edge.iter().enumerate() {
            let share = covered[i][0] / 400.0;
            if share > 0.0 && share < 1.0 {
                partly.insert((share * samples as f32).round() as u32);
            }
            for c in 0..3 {
                let want = sky[i][c] + share * (wall[i][c] - sky[i][c]);
                assert!(
                    (got[c] - want).abs() < 0.01 * want + 1.0,
                    "{samples} samples, pixel {i}: {got:?}, want {want}"
                );
            }
        }
        assert!((sky[4000][2] - wall[4000][2]).abs() > 100.0, "sky and wall differ: {:?} {:?}", sky[4000], wall[4000]);
        assert_eq!(partly.len() as u32, samples - 1, "the edge leaves every number of samples: {partly:?}");
        host = multi;
    }
}

/// Draws rain of the default model from a camera that lies on its side. A block stands above everything to the right of
/// it in the world, which is the upper half of the picture.
#[test]
fn a_block_keeps_rain_off_the_same_half_whatever_samples_and_orientation() {
    const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
    let mut host = Host::new(FORMAT);
    let mut weather =
        Weather { precipitation: Precipitation::of(PrecipitationKind::Rain, 300.0), ..Weather::default() };
    weather.wind.speed_m_s = 0.0;
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    host.context.update(1.0).unwrap();
    let block = Shelter {
        center_m: DVec3::new(20.0, 0.0, 206.0),
        axes: DMat3::IDENTITY,
        half_size_m: DVec3::new(20.0, 40.0, 200.0),
        velocity_m_s: DVec3::ZERO,
        planes: Planes::NONE,
    };
    let camera = Camera::look_to(DVec3::new(0.0, 0.0, 2.0), DVec3::Y, DVec3::X, 1.0, 16.0 / 9.0, 0.1);
    let mut id = 0;
    for (samples, bottom) in [(1, false), (4, false), (1, true), (4, true)] {
        host.color = texture(&host.device, FORMAT, samples);
        host.depth = texture(&host.device, wgpu::TextureFormat::Depth32Float, samples);
        // Light of the rain above and below the middle.
        let [open, below] = [&[][..], &[block][..]].map(|blocks| {
            host.context.set_shelters(blocks).unwrap();
            host.clear([0.0, 0.0, 0.0, 1.0], 0.001);
            id += 1;
            let mut frame = Frame::new(id, camera, &host.color, Some(&host.depth));
            frame.origin_bottom_left = bottom;
            host.view.record(&host.context, &frame, Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
            let pixels = if samples > 1 { resolve(&host) } else { host.pixels() };
            let half = pixels.len() / 2;
            [&pixels[..half - 1280], &pixels[half + 1280..]].map(|h| h.iter().map(|p| f64::from(p[1])).sum::<f64>())
        });
        // The camera's up is to the right in the world.
        let (dry, wet) = if bottom { (1, 0) } else { (0, 1) };
        let what = format!("{samples} samples, bottom {bottom}: {below:?} of {open:?}");
        assert!(open[dry] > 0.0 && below[dry] == 0.0, "{what}");
        assert!(below[wet] > 0.98 * open[wet] && below[wet] <= 1.001 * open[wet], "{what}");
    }
}
