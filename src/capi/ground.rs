//! Wet ground
//!
//! The stage SURFACE reads the host's depth and draws water onto the host's picture. Wet ground is darker and mirrors
//! the sky, paved ground has puddles, and rain makes rings in them. Colours are right with WK_COLOR_SCENE_LINEAR; in
//! the display spaces Welkin takes the displayed colour for the ground's albedo. Ground without a wk_surface_class is
//! natural and hardly mirrors: mark roads and yards as WK_SURFACE_CLASS_PAVED. The mirrored picture is the sky's. Of
//! the host's objects, only shelters and occluder maps appear in it, as dark shapes.
//!
//! Wetness follows the present weather (wk_conditions.wetness, .puddles). With WK_GROUND_SIMULATED, set by a
//! wk_simulation_desc in wk_context_desc.next, the water on the ground is instead a state that fills, drains and dries
//! over time. wk_context_save keeps this state.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::Status,
    ground::SurfaceClass,
    ground::{GroundAt, GroundModel},
    snowpack::LyingSnowModel,
};

include!(concat!(env!("OUT_DIR"), "/init_ground.rs"));

/// Source of the ground's wetness.
pub type wk_ground_model = u32;
/// The present weather: the ground is as wet as the weather reports, or as the present rain keeps it. Ground that only
/// the rain keeps wet is dry as soon as the rain ends.
pub const WK_GROUND_REPORTED: wk_ground_model = 0;
/// A simulated state. At simulation time 0 it starts with the wetness of the weather at that time. Rain fills the
/// ground's pores, the film on it and its hollows. The water drains and dries by wind, sun and humidity (Penman 1948)
/// in steps of 10 s. After a leap of more than a day only the last day is simulated, from the wetness of the weather at
/// the beginning of that day. See wk_context_update for leaps that take more than one call.
pub const WK_GROUND_SIMULATED: wk_ground_model = 1;

/// Source of the lying snow.
pub type wk_lying_snow_model = u32;
/// The present weather: snow as deep as reported (wk_conditions.snow_depth_m), everywhere.
pub const WK_LYING_SNOW_REPORTED: wk_lying_snow_model = 0;
/// A simulated state that starts with the reported depth. Snowfall fills it; the snow settles, drifts, slides, melts
/// and refreezes in steps of 60 s. The state has the snow on level, open ground and on each cell of the host's terrain
/// (wk_context_set_ground_grid, wk_context_set_terrain). An update that moves time by more than a day runs as a
/// fast-forward (wk_context_accumulate). Of an update by more than 30 days only the last 30 days are simulated.
pub const WK_LYING_SNOW_SIMULATED: wk_lying_snow_model = 1;

/// Material of the ground; each value says how the material looks when it is wet. The first source that names a
/// material decides: an image of the target (the byte of red), then the wk_ground_grid or the tiles of the wk_terrain,
/// then the context's default.
pub type wk_surface_class = u32;
/// No material. In an image, a grid or a tile this value leaves the decision to the next source. As the context's
/// default it means natural ground: vegetation where the host's colour is green, soil elsewhere.
pub const WK_SURFACE_CLASS_UNSPECIFIED: wk_surface_class = 0;
/// Earth, sand, gravel: darkens and hardly mirrors.
pub const WK_SURFACE_CLASS_SOIL: wk_surface_class = 1;
/// Bare rock: darkens, and shines in places.
pub const WK_SURFACE_CLASS_ROCK: wk_surface_class = 2;
/// Asphalt, concrete, paving: darkens, gets a film that mirrors, and puddles.
pub const WK_SURFACE_CLASS_PAVED: wk_surface_class = 3;
/// Grass, crops, shrubs, trees: hardly changes.
pub const WK_SURFACE_CLASS_VEGETATION: wk_surface_class = 4;
/// Water that the host draws: Welkin leaves it as it is.
pub const WK_SURFACE_CLASS_WATER: wk_surface_class = 5;
/// Roofs and walls: darken and shine, without puddles.
pub const WK_SURFACE_CLASS_BUILDING: wk_surface_class = 6;

/// Settings of a context's simulated state. An extension: put it into wk_context_desc.next.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_simulation_desc {
    /// sizeof(wk_simulation_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SIMULATION_DESC.
    pub struct_type: wk_struct_type,
    /// The next extension. Default NULL.
    pub next: *const c_void,
    /// Source of the ground's wetness. Default WK_GROUND_REPORTED.
    pub ground_model: wk_ground_model,
    /// Must be 0.
    pub reserved0: u32,
    /// Source of the lying snow. Default WK_LYING_SNOW_REPORTED.
    pub lying_snow_model: wk_lying_snow_model,
    /// Must be 0.
    pub reserved1: u32,
}

impl wk_simulation_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SIMULATION_DESC,
        next: null(),
        ground_model: WK_GROUND_REPORTED,
        reserved0: 0,
        lying_snow_model: WK_LYING_SNOW_REPORTED,
        reserved1: 0,
    };

    /// Converts the model of lying snow to the Rust side's.
    pub(super) fn lying_snow(&self) -> LyingSnowModel {
        if self.lying_snow_model == WK_LYING_SNOW_SIMULATED {
            LyingSnowModel::Simulated
        } else {
            LyingSnowModel::Reported
        }
    }

    /// Converts the ground's model to the Rust side's.
    pub(super) fn ground(&self) -> GroundModel {
        if self.ground_model == WK_GROUND_SIMULATED { GroundModel::Simulated } else { GroundModel::Reported }
    }
}

/// Water at a place of the ground.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ground {
    /// sizeof(wk_ground) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_GROUND.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Depth of the water on the ground, mm, as a tyre meets it: the film, plus standing water in a hollow.
    pub water_mm: f64,
    /// Depth of the film, mm: at the place if it lies on the host's terrain, else on level ground outside hollows.
    pub film_mm: f64,
    /// Wetness, of the place if it lies on the host's terrain, else of level, open ground: 0 dry, 0.3 damp, 1 under a
    /// closed film.
    pub wetness: f64,
    /// Share of the host's terrain that is under standing water; for a place off the terrain, share of all ground.
    pub puddles: f64,
    /// 1 where standing water covers the place, else 0. Off the host's terrain only paved ground has puddles.
    pub in_puddle: u32,
    /// Always 0.
    pub reserved0: u32,
    /// Material of the ground at the place, from the host's terrain or else from the context's default.
    pub surface_class: wk_surface_class,
    /// Always 0.
    pub reserved1: u32,
}

impl wk_ground {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_GROUND,
        next: null(),
        water_mm: 0.0,
        film_mm: 0.0,
        wetness: 0.0,
        puddles: 0.0,
        in_puddle: 0,
        reserved0: 0,
        surface_class: WK_SURFACE_CLASS_UNSPECIFIED,
        reserved1: 0,
    };

    fn of(g: &GroundAt) -> Self {
        Self {
            water_mm: g.water_mm,
            film_mm: g.film_mm,
            wetness: g.wetness,
            puddles: g.puddles,
            in_puddle: u32::from(g.in_puddle),
            surface_class: g.surface_class as u32,
            ..Self::INIT
        }
    }
}

/// Gets the water on the ground at a place of the host's world, as of wk_context_get_state_time. On the host's terrain
/// (wk_context_set_ground_grid, wk_context_set_terrain) and up to 3 m above it, the answer is for the terrain's cell.
/// Elsewhere it is for level, open ground with the hollows that Welkin draws: a pattern fixed to the world by the
/// context's seed.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an invalid position.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_ground(
    context: *const wk_context,
    position_m: *const [f64; 3],
    out_ground: *mut wk_ground,
) -> wk_status {
    guard("wk_context_get_ground", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) =
            unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_ground", out_ground)?) };
        let ground = object.read().ground_at(DVec3::from_array(at)).map_err(|e| e.renamed("position", "position_m"))?;
        place.set(&wk_ground::of(&ground));
        Ok(Status::Ok)
    })
}

/// Sets the surface class of ground that has none from the target's image or the host's terrain. Default
/// WK_SURFACE_CLASS_UNSPECIFIED: natural ground. The class is part of the saved state.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown class.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_default_surface_class(
    context: *mut wk_context,
    surface_class: wk_surface_class,
) -> wk_status {
    guard("wk_context_set_default_surface_class", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        input::check_enum("surface_class", &layout::WK_SURFACE_CLASS, surface_class)?;
        let class = u8::try_from(surface_class).unwrap_or(u8::MAX);
        object.write().set_default_surface_class(SurfaceClass::from_number("surface_class", class)?);
        Ok(Status::Ok)
    })
}
