//! Transfer of pixels to and from memory: alignment, strides, and the compatibility profile's scale and bias.

use super::super::{
    api::Api,
    check::{GlInfo, GlProfile},
    names::*,
};

/// Pixel store parameters and the values that wgpu assumes: rows packed to the byte, nothing skipped or swapped.
const EVERYWHERE: &[(u32, i32)] = &[
    (UNPACK_ALIGNMENT, 1),
    (UNPACK_ROW_LENGTH, 0),
    (UNPACK_IMAGE_HEIGHT, 0),
    (UNPACK_SKIP_ROWS, 0),
    (UNPACK_SKIP_PIXELS, 0),
    (UNPACK_SKIP_IMAGES, 0),
    (PACK_ALIGNMENT, 1),
    (PACK_ROW_LENGTH, 0),
    (PACK_SKIP_ROWS, 0),
    (PACK_SKIP_PIXELS, 0),
];
/// Pixel store parameters of desktop OpenGL.
const DESKTOP: &[(u32, i32)] = &[
    (UNPACK_SWAP_BYTES, 0),
    (UNPACK_LSB_FIRST, 0),
    (PACK_SWAP_BYTES, 0),
    (PACK_LSB_FIRST, 0),
    (PACK_IMAGE_HEIGHT, 0),
    (PACK_SKIP_IMAGES, 0),
];
/// Pixel store parameters for compressed blocks (OpenGL 4.2).
const COMPRESSED: &[(u32, i32)] = &[
    (UNPACK_COMPRESSED_BLOCK_WIDTH, 0),
    (UNPACK_COMPRESSED_BLOCK_HEIGHT, 0),
    (UNPACK_COMPRESSED_BLOCK_DEPTH, 0),
    (UNPACK_COMPRESSED_BLOCK_SIZE, 0),
    (PACK_COMPRESSED_BLOCK_WIDTH, 0),
    (PACK_COMPRESSED_BLOCK_HEIGHT, 0),
    (PACK_COMPRESSED_BLOCK_DEPTH, 0),
    (PACK_COMPRESSED_BLOCK_SIZE, 0),
];
/// Pixel transfer of the compatibility profile, which applies to uploads, read-backs and copies alike.
const TRANSFER: &[(u32, f32)] = &[
    (MAP_COLOR, 0.0),
    (MAP_STENCIL, 0.0),
    (RED_SCALE, 1.0),
    (GREEN_SCALE, 1.0),
    (BLUE_SCALE, 1.0),
    (ALPHA_SCALE, 1.0),
    (RED_BIAS, 0.0),
    (GREEN_BIAS, 0.0),
    (BLUE_BIAS, 0.0),
    (ALPHA_BIAS, 0.0),
    (DEPTH_SCALE, 1.0),
    (DEPTH_BIAS, 0.0),
];

/// Saved pixel store and transfer parameters: name, value that wgpu assumes, the host's value.
#[derive(Default)]
pub(super) struct PixelState {
    store: Vec<(u32, i32, i32)>,
    transfer: Vec<(u32, f32, f32)>,
}

impl PixelState {
    pub(super) fn new(info: &GlInfo) -> Self {
        let desktop = if info.is_es() { &[] } else { DESKTOP };
        let compressed =
            if info.knows((4, 2), (0, 0), &["GL_ARB_compressed_texture_pixel_storage"]) { COMPRESSED } else { &[] };
        let transfer = if info.profile == GlProfile::Compatibility { TRANSFER } else { &[] };
        Self {
            store: EVERYWHERE.iter().chain(desktop).chain(compressed).map(|&(n, fresh)| (n, fresh, fresh)).collect(),
            transfer: transfer.iter().map(|&(n, fresh)| (n, fresh, fresh)).collect(),
        }
    }

    pub(super) fn save(&mut self, api: &Api) {
        for (name, _, was) in &mut self.store {
            *was = api.int(*name);
        }
        for (name, _, was) in &mut self.transfer {
            *was = api.floats::<1>(*name)[0];
        }
    }

    pub(super) fn normalise(&self, api: &Api) {
        for (name, fresh, _) in &self.store {
            api.PixelStorei(*name, *fresh);
        }
        for (name, fresh, was) in &self.transfer {
            if fresh != was {
                api.PixelTransferf(*name, *fresh);
            }
        }
    }

    pub(super) fn restore(&self, api: &Api) {
        for (name, _, was) in &self.store {
            api.PixelStorei(*name, *was);
        }
        for (name, fresh, was) in &self.transfer {
            if fresh != was {
                api.PixelTransferf(*name, *was);
            }
        }
    }
}
