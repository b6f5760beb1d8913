//! The opaque step on the software driver: a plane among a host's objects, in every depth mapping, with water and fog
//! on it.

pub mod host;

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3, DVec4};

use crate::{
    context::{Context, ContextDesc},
    effects::plane::{CD_M2, HALF_SIZE_M, SQUARE_M},
    frame::{ColorSpace, DepthAccess, Exposure, Frame, FrameFlags, Stages, View, tone},
    gpu::{
        Device, DeviceOptions, Shared,
        bind::{self, Slot},
        readback,
    },
    scene::{
        Camera, ClipSpace, DepthKind, DepthMapping, ViewRays,
        depth::{DepthFormat, RANGE_SKY_M},
    },
    sky::SkySettings,
    weather::{Surface, SurfaceState, Weather},
};

use host::{Host, Mapped, mappings, ndc, pixels, texture, to_plane, to_wall};

pub const SIZE: (u32, u32) = (64, 36);
const ASPECT: f64 = 64.0 / 36.0;
const EYE: DVec3 = DVec3::new(3.0, -5.0, 10.0);
const PLANE_M: f64 = 3.0;
/// Luminance of the host's wall, cd/m^2.
const HOST_CD_M2: f32 = 7000.0;
const BACK_CD_M2: f32 = 20.0;

fn reversed() -> Mapped {
    mappings()[0].1
}

const STANDARD: [DVec2; 4] =
    [DVec2::new(0.375, 0.125), DVec2::new(0.875, 0.375), DVec2::new(0.125, 0.625), DVec2::new(0.625, 0.875)];

/// Position of a sample of a pixel, in the standard pattern of multisampled pictures.
fn sample_ndc(pixel: usize, (sample, samples): (u32, u32)) -> DVec2 {
    let off = if samples == 1 { DVec2::ZERO } else { STANDARD[sample as usize] - 0.5 };
    ndc(pixel) + off * DVec2::new(2.0 / f64::from(SIZE.0), -2.0 / f64::from(SIZE.1))
}

/// Draws the host's wall and the plane, and checks each sample of each pixel against the distances to both along its
/// ray.
fn assert_drawn(name: &str, case: &Mapped, format: (wgpu::TextureFormat, DepthFormat), samples: u32) {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, format.0, samples);
    host.view.effects.plane.height_m = Some(PLANE_M);
    host.draw_own(case, false);
    let before: Vec<_> = (0..samples).map(|s| host.depths(s)).collect();
    host.record(case, Stages::SURFACE, |_| ());
    assert_eq!((host.view.report().passes, host.view.report().opaque_left_out), (1, 0), "{name}");
    let rays = case.rays();
    let (mut counts, mut left_out) = ([0; 3], 0);
    for sample in 0..samples {
        let (colors, depths) = (host.read(&host.color, sample), host.depths(sample));
        for i in pixels() {
            // The host wrote the depth of the pixel's middle to all of its samples.
            let at = sample_ndc(i, (sample, samples));
            let (wall, (covered, shade)) = (to_wall(&rays, ndc(i)), to_plane(&rays, at));
            // A shader that writes depth writes that of the pixel's middle to all samples that are covered.
            let depth_at = if matches!(case.mapping.kind, DepthKind::Logarithmic { .. }) { ndc(i) } else { at };
            let plane = if covered < RANGE_SKY_M {
                [to_plane(&rays, depth_at).0, covered].into_iter().find(|r| *r < RANGE_SKY_M).unwrap_or(covered)
            } else {
                covered
            };
            let near = 3.0 * rays.resolution_m(plane.min(wall).min(1e5), ndc(i), format.1);
            // A rasteriser rounds corners to parts of a pixel, so a sample on the plane's edge may show the plane or
            // not.
            let on_edge = [-0.02, 0.02].iter().any(|off| {
                let beside = at + DVec2::splat(off / f64::from(SIZE.1));
                (to_plane(&rays, beside).0 < RANGE_SKY_M) != (covered < RANGE_SKY_M)
            });
            if on_edge || ((wall - plane).abs() < near && plane < RANGE_SKY_M) {
                left_out += 1;
                continue;
            }
            let here = format!("{name}, {format:?}, sample {sample} of {samples}, pixel {i}: {plane} {wall}");
            let drawn = depths[i] != before[sample as usize][i];
            assert_eq!(drawn, plane < wall, "{here}");
            if !drawn {
                let host = if wall < RANGE_SKY_M { HOST_CD_M2 } else { BACK_CD_M2 };
                assert_eq!(colors[i], [host, host, host, 0.25], "{here}");
                counts[1 + usize::from(wall == RANGE_SKY_M)] += 1;
                continue;
            }
            counts[0] += 1;
            let range = to_plane(&rays, depth_at).0;
            let expected = rays.depth_at(range, depth_at);
            let off = 2.0 * format.1.step(expected) + 2f64.powi(-19) * expected + 2f64.powi(-25);
            let right = range == RANGE_SKY_M || (f64::from(depths[i]) - expected).abs() <= off;
            assert!(right, "{here}: {} {expected}", depths[i]);
            assert_eq!(colors[i][3], 0.25, "{here}");
            // All samples have the colour of the pixel's middle; far away, squares are smaller than pixels.
            let middle = to_plane(&rays, ndc(i));
            if samples == 1 || (middle.0 < 60.0 && middle.1 == shade) {
                assert_eq!(f64::from(colors[i][0]), shade, "{here}");
            }
        }
    }
    assert!(counts.iter().all(|c| *c > 50) && left_out * 200 < counts.iter().sum(), "{name}: {counts:?} {left_out}");
}

#[test]
fn the_plane_hides_and_is_hidden_to_the_pixel_in_every_mapping() {
    for (name, case) in mappings() {
        for samples in [1, 4] {
            assert_drawn(name, &case, (wgpu::TextureFormat::Depth32Float, DepthFormat::Float32), samples);
        }
    }
}

#[test]
fn every_depth_format_is_written() {
    use wgpu::TextureFormat as F;
    let formats = [
        (F::Depth16Unorm, DepthFormat::Unorm16),
        (F::Depth24Plus, DepthFormat::Unorm24),
        (F::Depth24PlusStencil8, DepthFormat::Unorm24),
        (F::Depth32Float, DepthFormat::Float32),
    ];
    for format in formats {
        assert_drawn("ordinary", &mappings()[2].1, format, 1);
        assert_drawn("ordinary", &mappings()[2].1, format, 4);
    }
}

/// Reads the stencil of the host's depth.
fn stencil(host: &Host) -> Vec<u8> {
    let (width, height) = SIZE;
    let buffer = host.device.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(256 * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = host.device.device.create_command_encoder(&Default::default());
    let from = wgpu::TexelCopyTextureInfo { aspect: wgpu::TextureAspect::StencilOnly, ..host.depth.as_image_copy() };
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(from, to, host.depth.size());
    host.device.submit_and_wait(encoder).unwrap();
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    host.device.wait().unwrap();
    let rows = buffer.get_mapped_range(..).unwrap();
    rows.chunks_exact(256).flat_map(|row| row[..width as usize].to_vec()).collect()
}

#[test]
fn stencil_stays() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth24PlusStencil8, 1);
    host.view.effects.plane.height_m = Some(PLANE_M);
    host.draw_own(&reversed(), false);
    host.record(&reversed(), Stages::SURFACE, |_| ());
    assert_eq!(host.view.report().passes, 1);
    assert!(stencil(&host).iter().all(|s| *s == 0x5a));
}

#[test]
fn where_depth_is_only_read_not_a_bit_changes_and_the_report_says_so() {
    for samples in [1, 4] {
        let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float, samples);
        host.view.effects.plane.height_m = Some(PLANE_M);
        let bits = |host: &Host| (0..samples).map(|s| (host.depths(s), host.read(&host.color, s))).collect::<Vec<_>>();
        host.draw_own(&reversed(), false);
        let before = bits(&host);
        host.record(&reversed(), Stages::SURFACE, |frame| frame.depth_access = DepthAccess::Read);
        assert!(bits(&host) == before);
        assert_eq!((host.view.report().passes, host.view.report().opaque_left_out), (0, 1));
        // Only SURFACE draws opaque objects.
        host.record(&reversed(), Stages::MEDIUM, |frame| frame.depth_access = DepthAccess::Read);
        assert_eq!(host.view.report().opaque_left_out, 0);
        host.record(&reversed(), Stages::MEDIUM, |_| ());
        assert!((0..samples).all(|s| host.depths(s) == before[s as usize].0));
    }
}

/// Weather with fog and water on the ground, on a bright day.
fn wet_fog() -> Weather {
    let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
    Weather { visibility_m: 300.0, relative_humidity: 1.0, surface, ..Weather::default() }
}

#[test]
fn without_anything_opaque_a_frame_that_may_write_is_the_same() {
    for samples in [1, 4] {
        let pictures = [DepthAccess::Read, DepthAccess::ReadWrite].map(|access| {
            let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float, samples);
            host.context.set_weather(&wet_fog(), 0.0, 0.0).unwrap();
            host.draw_own(&reversed(), false);
            host.record(&reversed(), Stages::ALL, |frame| frame.depth_access = access);
            let bits: Vec<_> = (0..samples).map(|s| (host.depths(s), host.read(&host.color, s))).collect();
            (bits, host.view.report().passes, host.view.report().bytes)
        });
        assert!(pictures[0] == pictures[1]);
    }
}

#[test]
fn water_and_fog_lie_on_what_is_opaque_as_on_the_hosts_own() {
    for samples in [1, 4] {
        let weathers = Stages::SURFACE.with(Stages::MEDIUM);
        let opaque = |fogged: bool, plane: bool| {
            let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float, samples);
            if fogged {
                host.context.set_weather(&wet_fog(), 0.0, 0.0).unwrap();
            }
            host.view.effects.plane.height_m = plane.then_some(PLANE_M);
            host.draw_own(&reversed(), false);
            host
        };
        // First the plane in dry weather, as if the host had drawn it; then the weather over that picture.
        let mut given = opaque(false, true);
        given.record(&reversed(), Stages::SURFACE, |_| ());
        let dry = given.read(&given.color, 0);
        given.view.effects.plane.height_m = None;
        given.context.set_weather(&wet_fog(), 0.0, 0.0).unwrap();
        given.record(&reversed(), weathers, |frame| frame.flags = FrameFlags::NO_HISTORY);
        let mut own = opaque(true, true);
        own.record(&reversed(), weathers, |frame| frame.flags = FrameFlags::NO_HISTORY);
        for sample in 0..samples {
            assert!(own.read(&own.color, sample) == given.read(&given.color, sample), "sample {sample} of {samples}");
        }
        // The weather is visible: far squares vanish in the fog, near ones reflect the sky.
        let shown = own.read(&own.color, 0);
        let rays = reversed().rays();
        let plane = |i: &usize| to_plane(&rays, ndc(*i)).0 < to_wall(&rays, ndc(*i));
        assert!(pixels().filter(plane).all(|i| CD_M2.contains(&f64::from(dry[i][0]))));
        let changed = pixels().filter(plane).filter(|i| (shown[*i][0] / dry[*i][0] - 1.0).abs() > 0.05).count();
        assert!(changed > 400, "{changed} pixels");
    }
}

#[test]
fn a_frame_in_steps_shows_what_it_shows_at_once() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float, 1);
    host.context.set_weather(&wet_fog(), 0.0, 0.0).unwrap();
    host.view.effects.plane.height_m = Some(PLANE_M);
    let (behind, rest) = (Stages::PREPARE.with(Stages::BACKGROUND), Stages::SURFACE.with(Stages::MEDIUM));
    host.draw_own(&reversed(), false);
    host.record(&reversed(), behind.with(rest), |_| ());
    let once = host.colors();
    host.draw_own(&reversed(), false);
    host.record(&reversed(), behind, |_| ());
    let id = host.frame_id;
    host.record(&reversed(), rest, |frame| frame.frame_id = id);
    let steps = host.colors();
    // Fog is drawn over the sky in another call: the picture between the calls is rounded to half floats.
    let near = |a: &[f32; 4], b: &[f32; 4]| (0..3).all(|c| (a[c] - b[c]).abs() <= 3e-3 * a[c].abs());
    assert!(once.iter().zip(&steps).all(|(a, b)| near(a, b)));
    let rays = reversed().rays();
    let plane = |i: &usize| to_plane(&rays, ndc(*i)).0 < to_wall(&rays, ndc(*i));
    assert!(pixels().filter(plane).all(|i| once[i] == steps[i]));
}

#[test]
fn masked_pixels_stay_the_hosts() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float, 1);
    host.view.effects.plane.height_m = Some(PLANE_M);
    let mask = texture(&host.device, wgpu::TextureFormat::R8Unorm, 1);
    let rows: Vec<u8> = pixels().map(|i| if i % 64 < 32 { 255 } else { 0 }).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(64), rows_per_image: None };
    host.device.queue.write_texture(mask.as_image_copy(), &rows, layout, mask.size());
    host.draw_own(&reversed(), false);
    let before = (host.depths(0), host.colors());
    let (color, depth, case) = (host.color.clone(), host.depth.clone(), reversed());
    let mut frame = Frame::new(1, case.camera, &color, Some(&depth));
    (frame.mask, frame.depth_access) = (Some(&mask), DepthAccess::ReadWrite);
    host.view.record(&host.context, &frame, Stages::SURFACE).unwrap();
    let after = (host.depths(0), host.colors());
    let drawn = |i: usize| before.0[i] != after.0[i] && before.1[i] != after.1[i];
    assert!(pixels().filter(|i| i % 64 < 32).all(|i| !drawn(i)));
    assert!(pixels().filter(|i| i % 64 >= 32).filter(|i| drawn(*i)).count() > 300);
}

#[test]
fn displays_get_the_plane_by_the_tone_curve_and_opengl_gets_it_the_right_way_up() {
    for (space, format) in [
        (ColorSpace::DisplayLinear, wgpu::TextureFormat::Rgba16Float),
        (ColorSpace::DisplaySrgb, wgpu::TextureFormat::Rgba8Unorm),
        (ColorSpace::DisplaySrgb, wgpu::TextureFormat::Rgba8UnormSrgb),
    ] {
        let mut host = Host::new(format, wgpu::TextureFormat::Depth32Float, 1);
        host.view.effects.plane.height_m = Some(PLANE_M);
        host.draw_own(&reversed(), true);
        let exposure = 2e-4;
        host.record(&reversed(), Stages::SURFACE, |frame| {
            (frame.color_space, frame.exposure) = (space, Some(Exposure::Factor(exposure)));
            frame.origin_bottom_left = true;
        });
        let (shown, rays) = (host.colors(), reversed().rays());
        let mut counted = 0;
        for i in pixels() {
            let at = ndc(i) * DVec2::new(1.0, -1.0);
            let (plane, shade) = to_plane(&rays, at);
            if plane > to_wall(&rays, at) || plane > 60.0 {
                continue;
            }
            counted += 1;
            let linear = host.context.tone_curve().apply(shade * exposure);
            // Shaders read linear values from an sRGB format.
            let encoded = format == wgpu::TextureFormat::Rgba8Unorm;
            let expected = if encoded { tone::srgb_encode(linear) } else { linear };
            assert!(
                (f64::from(shown[i][1]) - expected).abs() < 4e-3,
                "{space:?} {format:?} {i}: {:?} {expected}",
                shown[i]
            );
        }
        assert!(counted > 300, "{counted}");
    }
}

#[test]
fn depth_that_cannot_be_written_is_refused_by_name_before_anything_is_drawn() {
    use wgpu::TextureUsages as U;
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float, 1);
    let case = reversed();
    let made = |format, samples, usage| {
        host.device.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: host.color.size(),
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let both = U::TEXTURE_BINDING | U::RENDER_ATTACHMENT;
    let wrong = [
        (None, "depth_access", "no depth"),
        (Some(made(wgpu::TextureFormat::R32Float, 1, both)), "depth.format", "R32Float"),
        (Some(made(wgpu::TextureFormat::Depth32Float, 1, U::TEXTURE_BINDING)), "depth.usage", "RENDER_ATTACHMENT"),
        (Some(made(wgpu::TextureFormat::Depth32Float, 4, both)), "depth.samples", "got 4"),
    ];
    for (depth, field, word) in &wrong {
        for (stages, access) in [(Stages::SURFACE, DepthAccess::ReadWrite), (Stages::SURFACE, DepthAccess::Read)] {
            let mut frame = Frame::new(1, case.camera, &host.color, depth.as_ref());
            frame.depth_access = access;
            let answer = host.view.record(&host.context, &frame, stages);
            if access == DepthAccess::Read {
                host.view.take_back(Stages(0));
                answer.unwrap();
                continue;
            }
            let error = answer.unwrap_err();
            assert_eq!(error.field(), Some(*field), "{error}");
            assert!(error.to_string().contains(word), "{error}");
        }
    }
}
