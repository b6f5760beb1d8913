//! The C boundary and nothing else: checks, conversion, panic and error handling.
//!
//! It has two floors. `boundary` is the lower one: the numbers of statuses and struct types, the layouts of structs,
//! checks of parameters, handles and the objects behind them, the cell of a device, and the guard that keeps panics
//! inside. It has no `wk_*` call. The files beside it are the upper floor: the `wk_*` calls with their structs, the
//! code that several of them share (`host`, `weather_convert`), `abi`, the tables of the interface for tests, and
//! `by_name`, the structs and calls by their names for tools that are made from the header. Each file may use the lower
//! floor, and other files of the upper floor as long as no cycle of files results. The lower floor uses the upper one
//! only in generated code: `boundary::layout` includes the tables that `build.rs` writes from all structs.
//!
//! Each `pub mod` below without an attribute (so neither `abi` nor `by_name`) is one section of `include/welkin.h`, in
//! this order; its `//!` text is the section's article. `build.rs` writes the header from them (cbindgen does the
//! declarations). Where a section's file re-exports a whole file, as `pub use super::opengl_structs::*`, the items of
//! that file come first in the section. Three kinds of items need this. The numbers of statuses and struct types stand
//! in `boundary::numbers`, which the lower floor uses. The type of a handle stands beside its object in
//! `boundary::objects`. Structs that `host` uses stand in files of their own, because the calls of the same section use
//! `host`: one file for both would make a cycle. The structs of `sea` and `soil` stand apart only to keep the files
//! short.
#![allow(non_camel_case_types, reason = "the names are C's")]
#![allow(clippy::missing_safety_doc, reason = "the safety rules are the header's: see `manual`")]

// Empty lines keep rustfmt from sorting the modules, which are in reading order.
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

pub mod region;

pub mod air;

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

pub mod sea;

pub mod soil;

mod boundary;
mod host;
mod occluder_map;
mod opengl_structs;
mod sea_structs;
mod soil_structs;
mod vulkan_structs;
mod weather_convert;

#[doc(hidden)]
pub mod abi;

#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod by_name;
