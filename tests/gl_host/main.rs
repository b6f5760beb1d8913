//! Hosts that draw with OpenGL: real contexts without a window, in which a small picture is drawn through wgpu and read
//! with the host's own OpenGL.
#![cfg(target_os = "linux")]

mod canvas;
mod capi;
mod cloud_shadows;
mod counting;
mod exercise;
mod faulty;
mod ground;
mod host;
mod images;
mod kinds;
mod life;
mod loss;
mod marks;
mod matrix;
mod memory;
mod own;
mod painter;
mod pictures;
mod resized;
mod sky;
mod snapshot;
mod state;
mod strict;
mod unusual;
mod veil;
mod windows;
mod written;

use welkin::capi::frame::wk_frame;
use welkin_support::c_scene;

/// The size of the pictures that come through the C functions.
const SIZE: (u32, u32) = (images::WIDTH, images::HEIGHT);

/// Frame of the scene at the size of the pictures.
fn frame(frame_id: u64) -> wk_frame {
    c_scene::frame_of(frame_id, SIZE)
}
