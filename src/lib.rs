//! Welkin: weather for simulators, drawn into the host's own picture.
//!
//! A Rust host sets the weather and records it into its own [`wgpu`] textures, after its opaque world and before its
//! instruments. A whole program that draws the sky of a weather report:
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::DVec3;
//! use welkin::{
//!     context::{Context, ContextDesc},
//!     frame::{Frame, FrameFlags, Shared, Stages, View},
//!     gpu::{Device, DeviceOptions, readback},
//!     scene::Camera,
//!     weather::Weather,
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let device = Device::headless(&DeviceOptions::default())?; // Device::adopt takes yours
//! let shared = Arc::new(Shared::new(&device)?); // what all contexts of a device use
//! let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
//! let report = Weather::from_metar("METAR LBBG 041600Z 12012KT CAVOK 20/12 Q1015")?;
//! context.set_weather(&report.weather, 0.0, 0.0)?;
//! let mut view = View::new(&context)?;
//!
//! let color = device.device.create_texture(&wgpu::TextureDescriptor {
//!     label: None,
//!     size: wgpu::Extent3d { width: 64, height: 36, depth_or_array_layers: 1 },
//!     mip_level_count: 1,
//!     sample_count: 1,
//!     dimension: wgpu::TextureDimension::D2,
//!     format: wgpu::TextureFormat::Rgba16Float,
//!     usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
//!     view_formats: &[],
//! });
//! let (eye, north, up) = (DVec3::new(0.0, 0.0, 2.0), DVec3::Y, DVec3::Z);
//! let camera = Camera::look_to(eye, north, up, 50_f64.to_radians(), 64.0 / 36.0, 0.1);
//! // A host's own depth comes in place of `None`. Frames that follow each other leave NO_HISTORY out.
//! let frame = Frame { flags: FrameFlags::NO_HISTORY, ..Frame::new(1, camera, &color, None) };
//! context.update(0.0)?;
//! view.record(&context, &frame, Stages::ALL)?;
//!
//! let pixels = readback::rgba(&device, &color)?;
//! assert!(pixels[0][2] > pixels[0][0], "the sky is blue");
//! # Ok(())
//! # }
//! ```
//!
//! The main types:
//!
//! | noun | what it is |
//! |---|---|
//! | [`gpu::Device`] | a GPU, the host's own or one that Welkin opens; [`gpu`] has the kinds of host |
//! | [`context::Context`] | weather, time, place and simulated state, shared by all views |
//! | [`weather::Weather`] | description of the weather, from a report, a preset or fields in SI units |
//! | [`frame::View`] | one camera, with the data that it keeps from frame to frame |
//! | [`frame::Frame`] | one picture: camera, the host's images, meaning of colour and depth |
//! | [`plan`] | choice of what a view draws in less detail, or leaves out, to keep a tolerance or a time |
//! | [`error::Error`] | a status, and a sentence that names the parameter and what is accepted |
//!
//! Each effect has a room with its model, settings and cost: [`sky`], [`stars`], [`clouds`], [`fog`], [`rain`],
//! [`snow`], [`snowpack`], [`soil`], [`ground`], [`glass`], [`lightning`], [`bow`], [`wind`], [`flow`], [`sea`],
//! [`land`]. [`heights`] reads elevation files for [`terrain`], which [`land`] draws. [`regions`] give parts of the
//! world a weather of their own. The manual is `docs/README.md`. C and C++ hosts use the same types and functions
//! through `include/welkin.h`, which [`capi`] implements as a thin layer.
#![deny(missing_docs, unsafe_op_in_unsafe_fn)]
// Items that only the lab calls are public under its feature; tests and clippy check them with that feature.
#![cfg_attr(not(feature = "lab"), allow(dead_code, unused_imports, unreachable_pub))]

pub mod almanac;
pub mod bow;
#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
pub mod capi;
pub mod chance;
pub mod clouds;
pub mod context;
mod effects;
pub mod error;
mod falling;
pub mod flow;
pub mod fog;
pub mod frame;
mod front;
pub mod glass;
pub mod gpu;
pub mod ground;
pub mod heights;
pub mod land;
pub mod light;
pub mod lightning;
mod moment;
pub mod noise;
mod numerics;
mod particles;
pub mod plan;
pub mod planet;
pub mod rain;
pub mod regions;
pub mod scene;
pub mod sea;
pub mod sky;
mod slides;
pub mod snow;
pub mod snowpack;
pub mod soil;
mod stage;
pub mod stars;
mod surroundings;
pub mod terrain;
#[cfg(test)]
mod tests;
pub mod weather;
pub mod wind;
mod world;

pub use error::{Error, Result, Status};
