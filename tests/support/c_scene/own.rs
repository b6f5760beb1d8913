//! A device of Welkin's own with images of any size, and a wet scene in which every stage has something to draw.

use std::ptr::null_mut;

use welkin::capi::{device::*, frame::*, ground::*, texture::*, timeline::*, view::*, weather::*, weather_kinds::*};

use super::{Scene, frame_of, init, ok};

pub type Size = (u32, u32);

/// A device of Welkin's own and the images made on it.
pub struct Own {
    pub device: *mut wk_device,
    images: Vec<*mut wk_texture>,
}

impl Own {
    pub fn new(backends: wk_backend_flags) -> Self {
        let desc = wk_device_desc { backends, ..init("wk_device_desc") };
        let mut own = Self { device: null_mut(), images: Vec::new() };
        // SAFETY: live pointers.
        ok(unsafe { wk_device_create(&desc, &mut own.device) });
        own
    }

    /// Creates an image filled with `texels`, top row first.
    pub fn image<T: bytemuck::Pod>(&mut self, format: wk_format, size: Size, texels: &[T]) -> *mut wk_texture {
        let desc = wk_texture_desc { width: size.0, height: size.1, format, ..init("wk_texture_desc") };
        let (mut image, row) = (null_mut(), size.0 * size_of::<T>() as u32);
        assert_eq!(texels.len() as u32, size.0 * size.1);
        // SAFETY: live pointers with the sizes given.
        unsafe {
            ok(wk_texture_create(self.device, &desc, &mut image));
            ok(wk_texture_write(image, texels.as_ptr().cast(), size_of_val(texels), row));
        }
        self.images.push(image);
        image
    }

    /// Reads the texels of an image, top row first.
    pub fn read<T: bytemuck::Pod>(&self, image: *const wk_texture, size: Size) -> Vec<T> {
        let mut texels = vec![T::zeroed(); (size.0 * size.1) as usize];
        let row = size.0 * size_of::<T>() as u32;
        // SAFETY: live pointers with the sizes given.
        ok(unsafe { wk_texture_read(image.cast_mut(), texels.as_mut_ptr().cast(), size_of_val(&*texels), row) });
        texels
    }

    /// Draws the wet scene on grey ground with `view`; `change` may add images to the target.
    pub fn wet_picture(
        &mut self,
        view: *mut wk_view,
        frame_id: u64,
        size: Size,
        stages: wk_stage_flags,
        change: impl FnOnce(&mut Self, &mut wk_own_target),
    ) -> Vec<[u8; 4]> {
        let color = self.image(WK_FORMAT_RGBA8_UNORM, size, &grey_ground(size));
        let depth = self.image(WK_FORMAT_R32_FLOAT, size, &ground_depths(size));
        let mut target = wk_own_target { color, depth, ..init("wk_own_target") };
        change(self, &mut target);
        let frame = wk_frame { target: (&raw const target).cast(), ..still_frame(frame_id, size) };
        // SAFETY: live handles.
        ok(unsafe { wk_view_record(view, &frame, stages) });
        self.read(color, size)
    }

    /// Destroys the device and its images; destroy all other objects on it before.
    pub fn destroy(self) {
        // SAFETY: live handles.
        unsafe {
            self.images.iter().for_each(|image| ok(wk_texture_destroy(*image)));
            ok(wk_device_destroy(self.device));
        }
    }
}

/// Creates a view of a context with rain, fog and wet paved ground.
pub fn wet_scene(device: *mut wk_device) -> Scene {
    let scene = Scene::new(device);
    let weather = wk_weather {
        precipitation_kind: WK_PRECIPITATION_RAIN,
        precipitation_rate_mm_h: 12.0,
        visibility_m: 800.0,
        ..init("wk_weather")
    };
    // SAFETY: live handles.
    unsafe {
        ok(wk_context_set_weather(scene.context, &weather, 0.0, 0.0));
        ok(wk_context_set_default_surface_class(scene.context, WK_SURFACE_CLASS_PAVED));
        ok(wk_context_update(scene.context, 40.0));
    }
    scene
}

/// The frame of [`frame_of`] without history.
pub fn still_frame(frame_id: u64, size: Size) -> wk_frame {
    let frame = frame_of(frame_id, size);
    wk_frame { flags: frame.flags | WK_FRAME_NO_HISTORY, ..frame }
}

/// Tangent of a row's angle below the horizon; top row first.
fn fall(row: u32, size: Size) -> f64 {
    (2.0 * (f64::from(row) + 0.5) / f64::from(size.1) - 1.0) * f64::tan(0.5)
}

fn of_rows<T: Copy>(size: Size, texel: impl Fn(u32) -> T) -> Vec<T> {
    (0..size.1).flat_map(|row| std::iter::repeat_n(texel(row), size.0 as usize)).collect()
}

/// Depths of level ground 2 m below the camera of [`frame_of`], with sky above it.
pub fn ground_depths(size: Size) -> Vec<f32> {
    of_rows(size, |row| (0.1 * fall(row, size).max(0.0) / 2.0) as f32)
}

/// Grey ground under a black sky.
pub fn grey_ground(size: Size) -> Vec<[u8; 4]> {
    of_rows(size, |row| if fall(row, size) > 0.0 { [110, 110, 110, 255] } else { [0, 0, 0, 255] })
}

/// Number of pixels that differ by more than `most` steps of 1/255.
pub fn different(a: &[[u8; 4]], b: &[[u8; 4]], most: u8) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > most)).count()
}
