//! The C boundary and nothing else: checks, conversion, panic and error handling.
//!
//! Each `pub mod` below is one section of `include/welkin.h`, in this order; its `//!` text is the section's article.
//! `build.rs` writes the header from them (cbindgen does the declarations). The private modules are the machinery
//! that every call shares.
#![allow(non_camel_case_types, reason = "the names are C's")]
#![allow(clippy::missing_safety_doc, reason = "the safety rules are the header's: see `manual`")]

// Empty lines keep rustfmt from sorting what is in reading order.
pub mod manual;

pub mod status;

pub mod device;

pub mod texture;

pub mod surface;

pub mod opengl;

pub mod vulkan;

pub mod weather_kinds;

pub mod weather;

pub mod report;

pub mod context;

pub mod sky;

pub mod timeline;

pub mod fog_law;

pub mod conditions;

pub mod query;

pub mod radiance;

pub mod wind;

pub mod frame;

pub mod view;

pub mod veil;

pub mod environment;

pub mod plan;

pub mod rain;

pub mod snow;

pub mod area;

pub mod wind_grid;

pub mod wind_field;

pub mod occluder;

pub mod light;

pub mod stars;

pub mod cloud_map;
pub mod clouds;

pub mod cloud_shadow;

pub mod lightning;

pub mod windscreen;

pub mod ground;

pub mod ground_grid;

pub mod ground_texture;

pub mod snowpack;

pub mod terrain;

mod boundary;
mod device_cell;
mod handles;
mod host;
mod input;
mod layout;
mod log_sink;
mod weather_convert;

#[doc(hidden)]
pub mod abi;

/// Most places or rays in one batch query: bounds the time of one call.
const MAX_BATCH: usize = 65_536;
