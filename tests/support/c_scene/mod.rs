//! One small scene set through the C functions, for the tests of every kind of host: the same context, camera and
//! picture.

// Handles are live, and the library recognises those that are not.
#![allow(clippy::not_unsafe_ptr_arg_deref)]

pub mod cloud_shadows;
pub mod ground;
// The memory limit uses a Linux call.
#[cfg(target_os = "linux")]
pub mod limited;
pub mod loss;
pub mod marks;
pub mod own;
pub mod veil;

use std::ffi::c_void;
use std::ptr::{null, null_mut};

use crate::refusals;
use welkin::capi::{abi, context::*, device::*, frame::*, sky::*, status::*, texture::*, timeline::*, view::*};

/// The thread's last message; also checks its field against the header.
pub fn message() -> String {
    assert_eq!(refusals::field_fault(), None);
    refusals::message()
}

/// Panics with the message unless the call succeeded.
#[track_caller]
pub fn ok(status: wk_status) {
    assert_eq!(status, WK_OK, "{}", message());
}

/// A struct with every field at its default.
pub fn init<T>(name: &str) -> T {
    let mut bytes = vec![0_u64; size_of::<T>().div_ceil(8)];
    ok(abi::init(name, &mut bytes, size_of::<T>() as u32));
    // SAFETY: `bytes` holds a `T`, for which every bit pattern is valid.
    unsafe { bytes.as_ptr().cast::<T>().read() }
}

/// A context and a view with the sun in the picture.
pub struct Scene {
    pub context: *mut wk_context,
    pub view: *mut wk_view,
}

impl Scene {
    pub fn new(device: *mut wk_device) -> Self {
        Self::with(device, null())
    }

    /// `next` is appended to the context's description, after the sky's settings.
    pub fn with(device: *mut wk_device, next: *const c_void) -> Self {
        let mut scene = Self { context: null_mut(), view: null_mut() };
        // Small tables, because the tests are about the interface and not the sky.
        let sky = wk_sky_settings {
            model: WK_SKY_ISOTROPIC,
            suns: 16,
            altitudes: 8,
            sky_azimuths: 12,
            sky_above: 16,
            sky_below: 8,
            next,
            ..init("wk_sky_settings")
        };
        let desc = wk_context_desc { next: (&raw const sky).cast(), ..init("wk_context_desc") };
        let sun = wk_given_direction { azimuth_deg: 10.0, elevation_deg: 12.0, ..init("wk_given_direction") };
        // SAFETY: live pointers.
        unsafe {
            ok(wk_context_create(device, &desc, &mut scene.context));
            ok(wk_context_set_sun(scene.context, &sun));
            ok(wk_view_create(scene.context, null(), &mut scene.view));
        }
        scene
    }

    pub fn destroy(self) {
        // SAFETY: live handles.
        unsafe {
            ok(wk_view_destroy(self.view));
            ok(wk_context_destroy(self.context));
        }
    }
}

/// A camera 2 m above the ground, looking north, with a field of view 1 rad high and reversed infinite depth. The
/// picture is sRGB-encoded.
pub fn frame_of(frame_id: u64, size: (u32, u32)) -> wk_frame {
    let focal = 1.0 / f64::tan(0.5);
    let aspect = f64::from(size.0) / f64::from(size.1);
    let mut projection = [0.0; 16];
    (projection[0], projection[5], projection[11], projection[14]) = (focal / aspect, focal, -1.0, 0.1);
    // East is right in the picture, up is up, and north points away from the camera.
    let view = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    wk_frame {
        frame_id,
        position_m: [0.0, 0.0, 2.0],
        view,
        projection,
        flags: WK_FRAME_DEPTH_REVERSED,
        color_space: WK_COLOR_DISPLAY_SRGB,
        ..init("wk_frame")
    }
}

/// The scene over blue 0.5 with the same depth everywhere, on a Vulkan device of Welkin's own; top row first.
pub fn own_picture(size: (u32, u32), depth: f32, frame_id: u64) -> Vec<[u8; 4]> {
    let desc = wk_device_desc { backends: WK_BACKEND_VULKAN, ..init("wk_device_desc") };
    let pixels = (size.0 * size.1) as usize;
    let mut picture = vec![[0, 0, 128, 255_u8]; pixels];
    let depths = vec![depth; pixels];
    let (mut device, mut color, mut depth) = (null_mut(), null_mut(), null_mut());
    let texture = wk_texture_desc { width: size.0, height: size.1, ..init("wk_texture_desc") };
    let depth_desc = wk_texture_desc { format: WK_FORMAT_R32_FLOAT, ..texture };
    // SAFETY: live pointers with the sizes given.
    unsafe {
        ok(wk_device_create(&desc, &mut device));
        let scene = Scene::new(device);
        ok(wk_texture_create(device, &texture, &mut color));
        ok(wk_texture_create(device, &depth_desc, &mut depth));
        ok(wk_texture_write(color, picture.as_ptr().cast(), 4 * pixels, 4 * size.0));
        ok(wk_texture_write(depth, depths.as_ptr().cast(), 4 * pixels, 4 * size.0));
        let target = wk_own_target { color, depth, ..init("wk_own_target") };
        let frame = wk_frame { target: (&raw const target).cast(), ..frame_of(frame_id, size) };
        ok(wk_view_record(scene.view, &frame, WK_STAGE_ALL));
        ok(wk_texture_read(color, picture.as_mut_ptr().cast(), 4 * pixels, 4 * size.0));
        scene.destroy();
        ok(wk_texture_destroy(color));
        ok(wk_texture_destroy(depth));
        ok(wk_device_destroy(device));
    }
    picture
}

/// Asserts that two pictures differ by at most `most` steps of 1/255.
#[track_caller]
pub fn assert_same(got: &[[u8; 4]], wanted: &[[u8; 4]], most: u8) {
    assert_eq!(got.len(), wanted.len());
    for (i, (g, w)) in got.iter().zip(wanted).enumerate() {
        let close = g.iter().zip(w).all(|(a, b)| a.abs_diff(*b) <= most);
        assert!(close, "pixel {i}: {g:?}, wanted {w:?}");
    }
}
