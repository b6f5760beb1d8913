//! Rain areas
//!
//! Rain areas have rain of their own: a passing shower, a squall line, a dry hole in steady rain. Inside an area its
//! rain replaces the weather's rain and drizzle. The change is smooth over the rim, a band inside the area's border.
//! Where areas overlap, a later one in the list covers the earlier ones. Around a camera in or near a rim, the number
//! of drops varies from place to place with the rain rate. Seen from outside, an area is a shaft with falling curtains.
//! The shaft leans because the drops lag behind the moving cloud. All queries of rain and visibility include the areas,
//! and so does the ground's wetness (with WK_GROUND_REPORTED too). Where clouds are a volume (WK_CLOUD_MODEL_VOLUME),
//! an area with at least 0.05 mm/h of rain has cloud above it, unless a closed layer hides the sky. wk_context_save
//! keeps the areas.

use std::{ffi::c_void, ptr::null};

use super::boundary::{
    guard,
    input::{self, List},
    layout::{init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Status},
    rain::{AreaMotion, AreaRain, AreaShape, MAX_AREAS, MAX_CORNERS, RainArea},
};

include!(concat!(env!("OUT_DIR"), "/init_area.rs"));

/// Kind of rain in a rain area.
pub type wk_area_rain = u32;
/// Steady rain.
pub const WK_AREA_RAIN_STEADY: wk_area_rain = 0;
/// Showers: fewer and larger drops.
pub const WK_AREA_RAIN_SHOWERS: wk_area_rain = 1;
/// Drizzle.
pub const WK_AREA_RAIN_DRIZZLE: wk_area_rain = 2;

/// Kind of snow in a rain area.
pub type wk_area_snow = u32;
/// No snow.
pub const WK_AREA_SNOW_NONE: wk_area_snow = 0;
/// Flakes. Not in this version.
pub const WK_AREA_SNOW_FLAKES: wk_area_snow = 1;
/// Snow grains. Not in this version.
pub const WK_AREA_SNOW_GRAINS: wk_area_snow = 2;
/// Snow pellets. Not in this version.
pub const WK_AREA_SNOW_PELLETS: wk_area_snow = 3;

/// Motion of a rain area.
pub type wk_area_motion = u32;
/// Motion by the displacement of the wind at 10 m, gusts included.
pub const WK_AREA_MOTION_WITH_WIND: wk_area_motion = 0;
/// Motion at the area's own velocity.
pub const WK_AREA_MOTION_OWN: wk_area_motion = 1;

/// An area with rain of its own.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_rain_area {
    /// sizeof(wk_rain_area) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_RAIN_AREA.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Centre in the host's world at the time at_s, m, within 1e12 m of the origin; the height has no effect. Default
    /// 0, 0, 0.
    pub center_m: [f64; 3],
    /// Half extents of the ellipse to the right of the heading and along the heading, m. Range [10, 1e6], default 2000,
    /// 2000.
    pub semi_axes_m: [f64; 2],
    /// Corners of a polygon that replaces the ellipse, in clockwise or counter-clockwise order. Each corner is two
    /// numbers: its distances from the centre to the right of the heading and along the heading, m, within 1e6. The
    /// polygon must be convex and larger than 1 m^2. Default 0.
    pub corners_m: [f64; 16],
    /// Number of corners of the polygon, [3, 8], or 0, the default, for the ellipse.
    pub corner_count: u32,
    /// Kind of rain. Default WK_AREA_RAIN_STEADY.
    pub rain: wk_area_rain,
    /// Heading of the shape, degrees clockwise from true north. Range [-360, 360], default 0.
    pub heading_deg: f64,
    /// Width of the band inside the border over which the rain fades, m. Range [1, 1e6]; at most the smaller half
    /// extent of an ellipse, or the radius of the largest circle in a polygon. Default 500.
    pub rim_m: f64,
    /// Rain rate at the ground, mm/h; 0 makes a dry hole. Range [0, 500], default 10.
    pub rate_mm_h: f64,
    /// Altitude of the cloud base above mean sea level (not above the ground), m. Above it no rain falls inside the
    /// area: neither the area's nor, except in the rim, the weather's. Range [-1000, 20 000], default 1500.
    pub top_m: f64,
    /// Velocity of the area towards the east and towards the north, m/s, each within [-200, 200]. It is used with
    /// WK_AREA_MOTION_OWN. Default 0, 0.
    pub velocity_m_s: [f64; 2],
    /// Simulation time at which the centre is at center_m, s. Range [-1e10, 1e10], default 0. With
    /// WK_AREA_MOTION_WITH_WIND it must be 0 or a time that the timeline still knows.
    pub at_s: f64,
    /// Motion of the area. Default WK_AREA_MOTION_WITH_WIND.
    pub motion: wk_area_motion,
    /// Snow that falls in place of the rain. Default WK_AREA_SNOW_NONE, the only value that this version accepts.
    pub snow: wk_area_snow,
}

impl wk_rain_area {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_RAIN_AREA,
        next: null(),
        center_m: [0.0, 0.0, 0.0],
        semi_axes_m: [2000.0, 2000.0],
        corners_m: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        corner_count: 0,
        rain: WK_AREA_RAIN_STEADY,
        heading_deg: 0.0,
        rim_m: 500.0,
        rate_mm_h: 10.0,
        top_m: 1500.0,
        velocity_m_s: [0.0, 0.0],
        at_s: 0.0,
        motion: WK_AREA_MOTION_WITH_WIND,
        snow: WK_AREA_SNOW_NONE,
    };

    fn corners(&self) -> [[f64; 2]; MAX_CORNERS] {
        std::array::from_fn(|i| [self.corners_m[2 * i], self.corners_m[2 * i + 1]])
    }

    fn area(&self) -> RainArea {
        RainArea {
            center_m: self.center_m,
            shape: match self.corner_count {
                0 => AreaShape::Ellipse(self.semi_axes_m),
                count => AreaShape::Polygon(self.corners(), count as usize),
            },
            heading_deg: self.heading_deg,
            rim_m: self.rim_m,
            rate_mm_h: self.rate_mm_h,
            kind: match self.rain {
                WK_AREA_RAIN_SHOWERS => AreaRain::Showers,
                WK_AREA_RAIN_DRIZZLE => AreaRain::Drizzle,
                _ => AreaRain::Rain,
            },
            top_m: self.top_m,
            motion: match self.motion {
                WK_AREA_MOTION_OWN => AreaMotion::Own(self.velocity_m_s),
                _ => AreaMotion::WithWind,
            },
            at_s: self.at_s,
        }
    }
}

/// Replaces the list of rain areas, at most 16; count 0 removes all. Areas move by themselves: set them again only to
/// change them. A failed call changes nothing.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range; WK_ERROR_UNSUPPORTED for snow.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_rain_areas(
    context: *mut wk_context,
    areas: *const wk_rain_area,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_rain_areas", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = [RainArea::default(); MAX_AREAS];
        let mut take = |i: usize, c: wk_rain_area| {
            if c.snow != WK_AREA_SNOW_NONE {
                let what = "must be WK_AREA_SNOW_NONE: no snow falls in this version";
                return Err(Error::about(Status::Unsupported, format!("areas[{i}].snow"), what));
            }
            list[i] = c.area();
            Ok(())
        };
        // SAFETY: the caller's promise about `areas`.
        unsafe {
            input::each(&List::parameters("areas", count, stride, MAX_AREAS), areas, &mut take)?;
        }
        let list = &list[..count as usize];
        object.write().set_rain_areas(list).map_err(|e| e.renamed("rain_areas", "areas"))?;
        Ok(Status::Ok)
    })
}
