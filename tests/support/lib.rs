//! Code shared by the library's tests, its benchmarks and the lab: small hosts, their own textures and pipelines,
//! scenes through the C functions, and references that use nothing of the library.

pub mod brute_rain;
pub mod c_library;
pub mod c_scene;
pub mod cloud_shape;
pub mod coarse_sky;
pub mod cube_lookup;
pub mod depth_texture;
#[cfg(target_os = "linux")]
pub mod egl;
pub mod frame_host;
pub mod fullscreen;
pub mod fuzz;
pub mod level_ground;
pub mod opaque;
pub mod opaque_card;
pub mod processor;
pub mod rain_scene;
pub mod refusals;
pub mod seen_lux;
pub mod textures;
pub mod x_server;

/// Returns whether this is the acceptance run: `make accept` sets `WELKIN_ACCEPT`, and tests then run their long cases
/// and hold the narrow bounds that need an idle machine.
pub fn accept() -> bool {
    std::env::var_os("WELKIN_ACCEPT").is_some()
}
