//! Weather regions
//!
//! Weather regions have a weather of their own: a fog bank, a shower of snow, a sandstorm, a front. A region has a
//! shape on the ground plan, a wk_weather, and a perimeter outside the shape, over which the region's weather fades
//! into the weather around it. The region's field `has` lists the parts of that weather that hold in the region. At
//! each place, queries and the picture of a camera there use the weather that all regions there give together. Queries
//! between two points integrate the extinction of all regions on the way. Regions move at their own velocity, never
//! with the wind; a host may also set them again in every frame. wk_context_save keeps them. Channels of a simulator
//! that set the same regions have the same weather.
//!
//! Where regions overlap, a later one in the list replaces the earlier ones in the parts that it has. Parts that
//! several regions list in `merges` are averaged by these regions' weights. The averages are those of extinction (not
//! visibility), rates, temperatures and wind vectors. A camera's picture shows the fog of all regions; the rest of its
//! weather is that at the camera. docs/regions.md has the rules, a table of what differs by place, and the quantities
//! that do not differ yet.

use std::{ffi::c_void, ptr::null};

use super::{
    boundary::{
        guard,
        input::{self, List},
        layout::{init_struct, struct_size},
        numbers::*,
        objects::{ContextObject, wk_context},
    },
    weather::wk_weather,
    weather_convert::{from_c, overrides},
};
use crate::{
    error::{Result, Status},
    regions::{MAX_REGION_CORNERS, MAX_WEATHER_REGIONS, RegionPlan, RegionShape, WeatherRegion},
    weather::{Overrides, Weather, WeatherParts},
};

include!(concat!(env!("OUT_DIR"), "/init_region.rs"));

/// Parts of the weather.
pub type wk_weather_part_flags = u32;
/// Haze: visibility_m without fog and precipitation, and the aerosol fields.
pub const WK_WEATHER_PART_HAZE: wk_weather_part_flags = 0x1;
/// Low layer: fog or mist with its top, or matter that the wind lifts. In a region without WK_WEATHER_PART_HAZE, this
/// layer lies in the haze of the weather around the region.
pub const WK_WEATHER_PART_FOG: wk_weather_part_flags = 0x2;
/// Precipitation of all kinds.
pub const WK_WEATHER_PART_PRECIPITATION: wk_weather_part_flags = 0x4;
/// Thunder, as queries report it. Flashes follow the weather outside all regions.
pub const WK_WEATHER_PART_LIGHTNING: wk_weather_part_flags = 0x8;
/// Temperature.
pub const WK_WEATHER_PART_TEMPERATURE: wk_weather_part_flags = 0x10;
/// Humidity.
pub const WK_WEATHER_PART_HUMIDITY: wk_weather_part_flags = 0x20;
/// Pressure.
pub const WK_WEATHER_PART_PRESSURE: wk_weather_part_flags = 0x40;
/// Wind, its gusts, and vertical_wind_m_s.
pub const WK_WEATHER_PART_WIND: wk_weather_part_flags = 0x80;
/// Cloud layers, and the overrides of the cloud light.
pub const WK_WEATHER_PART_CLOUDS: wk_weather_part_flags = 0x100;
/// Water, ice and snow on the ground.
pub const WK_WEATHER_PART_SURFACE: wk_weather_part_flags = 0x200;
/// Sea.
pub const WK_WEATHER_PART_SEA: wk_weather_part_flags = 0x400;

/// Shape of a weather region.
pub type wk_region_shape = u32;
/// Ellipse of the half extents half_size_m.
pub const WK_REGION_SHAPE_ELLIPSE: wk_region_shape = 0;
/// Rectangle of the half extents half_size_m with round corners of corner_radius_m.
pub const WK_REGION_SHAPE_RECTANGLE: wk_region_shape = 1;
/// Polygon of corner_count corners.
pub const WK_REGION_SHAPE_POLYGON: wk_region_shape = 2;

/// Region with a weather of its own.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_weather_region {
    /// sizeof(wk_weather_region) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_WEATHER_REGION.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Parts of `weather` that the region has. Default 0.
    pub has: wk_weather_part_flags,
    /// Parts that are averaged with those of earlier regions that merge them too. In all other parts that it has, the
    /// region replaces the earlier regions of the list. Default 0.
    pub merges: wk_weather_part_flags,
    /// Weather inside the region, with its overrides in its chain; NULL, the default, is that of WK_WEATHER_INIT. Its
    /// heights are above the station of the weather outside; station_altitude_m, the runway visual range and the ozone
    /// column have no effect. Read during the call only.
    pub weather: *const wk_weather,
    /// Centre in the host's world at the time at_s, m, within 1e12 m of the origin; its height has no effect. Default
    /// 0, 0, 0.
    pub center_m: [f64; 3],
    /// Half extents of an ellipse or a rectangle to the right of the heading and along the heading, m. Range [1, 1e6],
    /// default 2000, 2000.
    pub half_size_m: [f64; 2],
    /// Radius of a rectangle's corners, m. Range [0, 1e6], at most the smaller half extent. Default 0.
    pub corner_radius_m: f64,
    /// Corners of a polygon, in clockwise or counter-clockwise order, convex or not. Each corner is two numbers: its
    /// distances from the centre to the right of the heading and along the heading, m, within 1e6. A side must not
    /// cross or touch any other, except its neighbours at their common corners. The area must be larger than 1 m^2.
    /// Default 0.
    pub corners_m: [f64; 32],
    /// Number of corners of a polygon, [3, 16]; ignored for other shapes. Default 0.
    pub corner_count: u32,
    /// Shape. Default WK_REGION_SHAPE_ELLIPSE.
    pub shape: wk_region_shape,
    /// Heading of the shape, degrees clockwise from true north. Range [-360, 360], default 0.
    pub heading_deg: f64,
    /// Width of the band outside the shape over which the region's weather fades, m. Range [0, 1e6]; 0 is a step at the
    /// border. Default 500.
    pub perimeter_m: f64,
    /// Velocity to the east and north, m/s. Range [-400, 400] each, default 0, 0.
    pub velocity_m_s: [f64; 2],
    /// Simulation time at which the centre is at center_m, s. Range [-1e10, 1e10], default 0.
    pub at_s: f64,
    /// Share by which the region acts, to fade it in and out. Range [0, 1], default 1.
    pub strength: f64,
    /// Upward velocity of the wind 100 m or more above the station, m/s. Lower down it decreases linearly to 0 at the
    /// station's height. Without WK_WEATHER_PART_WIND in `has` it has no effect. Range [-50, 50], default 0.
    pub vertical_wind_m_s: f64,
}

impl wk_weather_region {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_WEATHER_REGION,
        next: null(),
        has: 0,
        merges: 0,
        weather: null(),
        center_m: [0.0, 0.0, 0.0],
        half_size_m: [2000.0, 2000.0],
        corner_radius_m: 0.0,
        corners_m: [
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
        ],
        corner_count: 0,
        shape: WK_REGION_SHAPE_ELLIPSE,
        heading_deg: 0.0,
        perimeter_m: 500.0,
        velocity_m_s: [0.0, 0.0],
        at_s: 0.0,
        strength: 1.0,
        vertical_wind_m_s: 0.0,
    };

    /// Returns the shape, with fields that are not checked yet.
    fn region_shape(&self) -> RegionShape {
        match self.shape {
            WK_REGION_SHAPE_RECTANGLE => {
                RegionShape::Rectangle { half_m: self.half_size_m, corner_radius_m: self.corner_radius_m }
            }
            WK_REGION_SHAPE_POLYGON => {
                let corner = |i: usize| [self.corners_m[2 * i], self.corners_m[2 * i + 1]];
                let corners_m: [[f64; 2]; MAX_REGION_CORNERS] = std::array::from_fn(corner);
                RegionShape::Polygon { corners_m, count: self.corner_count as usize }
            }
            _ => RegionShape::Ellipse { half_m: self.half_size_m },
        }
    }

    /// Reads the region.
    ///
    /// # Safety
    /// `weather` is NULL or points to a `wk_weather` with readable cloud layers.
    ///
    /// # Errors
    /// Names the first wrong field of the weather as in the header.
    unsafe fn region(&self, name: &str) -> Result<WeatherRegion> {
        let (weather, overrides) = if self.weather.is_null() {
            (Weather::default(), Overrides::default())
        } else {
            let name = format!("{name}.weather");
            // SAFETY: the caller's promise.
            unsafe { (from_c(&name, self.weather)?, overrides(&name, self.weather)?) }
        };
        Ok(WeatherRegion {
            plan: RegionPlan {
                shape: self.region_shape(),
                center_m: self.center_m,
                heading_deg: self.heading_deg,
                perimeter_m: self.perimeter_m,
                velocity_m_s: self.velocity_m_s,
                at_s: self.at_s,
                strength: self.strength,
            },
            has: WeatherParts(self.has),
            merges: WeatherParts(self.merges),
            weather,
            overrides,
            vertical_wind_m_s: self.vertical_wind_m_s,
        })
    }
}

/// Replaces the list of weather regions, at most 64; count 0 removes all. Regions move at their velocity by themselves.
/// Set them again to change them; you may also do so in every frame, at their new places. Unchanged after an error.
/// Copied during the call.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range, also for a polygon whose sides cross or a
/// corner radius larger than the smaller half extent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_weather_regions(
    context: *mut wk_context,
    regions: *const wk_weather_region,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_weather_regions", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = Vec::new();
        let mut take = |i: usize, c: wk_weather_region| {
            // SAFETY: the caller's promise about the weather of each region.
            list.push(unsafe { c.region(&format!("regions[{i}]"))? });
            Ok(())
        };
        // SAFETY: the caller's promise about `regions`.
        unsafe {
            input::each(&List::parameters("regions", count, stride, MAX_WEATHER_REGIONS), regions, &mut take)?;
        }
        object.write().set_weather_regions(&list).map_err(|e| e.renamed("weather_regions", "regions"))?;
        Ok(Status::Ok)
    })
}
