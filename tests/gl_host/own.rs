//! Welkin's own device on OpenGL: every format of texture is made, filled, read and drawn with, or refused by name.

use std::ptr::{null, null_mut};

use welkin::capi::{device::*, frame::*, status::*, texture::*, view::*};
use welkin_support::c_scene::{Scene, init, message, ok};

use crate::{SIZE, frame};

#[test]
fn every_texture_of_an_own_device_serves_or_is_refused_by_name() {
    let desc = wk_device_desc { backends: WK_BACKEND_GL, ..init("wk_device_desc") };
    let mut device = null_mut();
    // SAFETY: live pointers.
    ok(unsafe { wk_device_create(&desc, &mut device) });
    let scene = Scene::new(device);
    let mut textures = Vec::new();
    for (format, bytes) in [
        (WK_FORMAT_RGBA8_UNORM, 4),
        (WK_FORMAT_RGBA8_SRGB, 4),
        (WK_FORMAT_BGRA8_UNORM, 4),
        (WK_FORMAT_BGRA8_SRGB, 4),
        (WK_FORMAT_RGBA16_FLOAT, 8),
        (WK_FORMAT_RGBA32_FLOAT, 16),
        (WK_FORMAT_R32_FLOAT, 4),
        (WK_FORMAT_R8_UNORM, 1),
    ] {
        let desc = wk_texture_desc { width: SIZE.0, height: SIZE.1, format, ..init("wk_texture_desc") };
        let mut texture = null_mut();
        let row = SIZE.0 * bytes;
        let data: Vec<u8> = (0..row * SIZE.1).map(|i| (i % 59) as u8).collect();
        let mut back = vec![0_u8; data.len()];
        // SAFETY: live pointers with the sizes given.
        unsafe {
            let status = wk_texture_create(device, &desc, &mut texture);
            if format == WK_FORMAT_RGBA32_FLOAT && status == WK_ERROR_UNSUPPORTED {
                assert!(message().contains("desc.format") && message().contains("got WK_FORMAT_RGBA32_FLOAT"));
                continue;
            }
            ok(status);
            ok(wk_texture_write(texture, data.as_ptr().cast(), data.len(), row));
            if format != WK_FORMAT_R8_UNORM {
                ok(wk_texture_read(texture, back.as_mut_ptr().cast(), back.len(), row));
                assert_eq!(back, data, "format {format}");
            }
        }
        textures.push((format, texture.cast_const()));
    }
    // Every texture in every role, also one texture in two roles: the frame is drawn, or refused with the header's
    // names.
    let with_none = || textures.iter().copied().chain([(0, null())]);
    let (mut id, mut drawn) = (0, 0);
    for &(color_format, color) in &textures {
        for (depth_format, depth) in with_none() {
            for (mask_format, mask) in with_none() {
                // Each format of colour with one depth, one with all depths and masks: every draw compiles pipelines
                // first.
                let plain = depth_format == WK_FORMAT_R32_FLOAT && mask.is_null();
                if !(plain || color_format == WK_FORMAT_RGBA8_UNORM || depth == color || mask == color) {
                    continue;
                }
                id += 1;
                let target = wk_own_target { color, depth, mask, ..init("wk_own_target") };
                let frame = wk_frame { target: (&raw const target).cast(), ..frame(id) };
                // SAFETY: live handles.
                let status = unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) };
                let fits = !matches!(color_format, WK_FORMAT_R32_FLOAT | WK_FORMAT_R8_UNORM)
                    && matches!(depth_format, 0 | WK_FORMAT_R32_FLOAT)
                    && matches!(
                        mask_format,
                        0 | WK_FORMAT_R8_UNORM | WK_FORMAT_RGBA8_UNORM | WK_FORMAT_RGBA8_SRGB | WK_FORMAT_BGRA8_UNORM
                    )
                    && mask != color;
                let what = format!("{color_format} {depth_format} {mask_format}: {status} {}", message());
                if fits {
                    assert_eq!(status, WK_OK, "{what}");
                    drawn += 1;
                } else {
                    assert!(matches!(status, WK_ERROR_UNSUPPORTED | WK_ERROR_INVALID_ARGUMENT), "{what}");
                    assert!(message().contains("frame.target.") && !message().contains("Texture"), "{what}");
                    assert!(message().contains("WK_FORMAT_") || message().contains("another texture"), "{what}");
                }
            }
        }
    }
    assert!(drawn >= 12, "{drawn}");
    scene.destroy();
    // SAFETY: live handles.
    unsafe {
        textures.iter().for_each(|t| ok(wk_texture_destroy(t.1.cast_mut())));
        ok(wk_device_destroy(device));
    }
}
