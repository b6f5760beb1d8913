//! Hosts that draw with OpenGL: real contexts without a window, in which a small picture is drawn through wgpu and
//! looked at with the host's own OpenGL.
#![cfg(target_os = "linux")]

#[path = "../c_scene/mod.rs"]
mod c_scene;
mod canvas;
mod capi;
mod cloud_shadows;
mod counting;
mod egl;
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
#[path = "../support/opaque.rs"]
mod opaque;
#[path = "../support/opaque_card.rs"]
mod opaque_card;
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

/// The size of the pictures that come through the C functions.
const SIZE: (u32, u32) = (images::WIDTH, images::HEIGHT);
