//! The sea: settings and queries
//!
//! Say what your sea is like, and ask at any time where its surface is, how steep it is and how the water moves; a hull
//! can float by the answers. Without settings a context has no sea. What you set here replaces the wave height and the
//! swell of the weather (wk_weather.sea_significant_wave_height_m, swell_height_m); what you leave out follows the
//! weather: its wind raises waves by fetch and duration. Heights keep what was asked within 1 %, no two places look
//! alike, and the same time gives the same bits on every machine. Regions say where there is no water, where a harbour
//! shelters it, and where a lake has a level of its own.
//!
//! ```text
//! wk_sea sea = WK_SEA_INIT;
//! sea.has = WK_SEA_HAS_HEIGHT | WK_SEA_HAS_PEAK_PERIOD;
//! sea.significant_height_m = 2.1;
//! sea.peak_period_s = 6.2;
//! wk_context_set_sea(context, &sea);
//! wk_context_get_sea_at(context, corners_m, 4, sizeof corners_m[0], time_s, 0.0, points, sizeof points[0]);
//! ```

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, List, MAX_BATCH, Named, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status},
    sea::{
        MAX_OUTLINE_CORNERS, MAX_SEA_REGIONS, MAX_SINGLE_WAVES, MAX_SWELLS, SeaIce, SeaPoint, SeaRegion, SeaRegionKind,
        SeaSettings, SeaStatistics, SeaSwell, SingleWave, Tide, WaterClarity, WaveScale, WindSea, water::WaterType,
    },
};

include!(concat!(env!("OUT_DIR"), "/init_sea.rs"));

/// Flags of the optional fields of a wk_sea that are set.
pub type wk_sea_has_flags = u32;
/// fetch_m
pub const WK_SEA_HAS_FETCH: wk_sea_has_flags = 0x1;
/// significant_height_m; not together with SEA_STATE or BEAUFORT.
pub const WK_SEA_HAS_HEIGHT: wk_sea_has_flags = 0x2;
/// peak_period_s; needs HEIGHT.
pub const WK_SEA_HAS_PEAK_PERIOD: wk_sea_has_flags = 0x4;
/// peak_gamma; needs HEIGHT.
pub const WK_SEA_HAS_PEAK_GAMMA: wk_sea_has_flags = 0x8;
/// sea_state; not together with HEIGHT or BEAUFORT.
pub const WK_SEA_HAS_SEA_STATE: wk_sea_has_flags = 0x10;
/// beaufort; not together with HEIGHT or SEA_STATE.
pub const WK_SEA_HAS_BEAUFORT: wk_sea_has_flags = 0x20;
/// wind_sea_from_deg
pub const WK_SEA_HAS_WIND_SEA_FROM: wk_sea_has_flags = 0x40;
/// swells: they replace the weather's swell, also with swell_count 0.
pub const WK_SEA_HAS_SWELLS: wk_sea_has_flags = 0x80;
/// temperature_c
pub const WK_SEA_HAS_TEMPERATURE: wk_sea_has_flags = 0x100;
/// clarity_percent, in place of water_type.
pub const WK_SEA_HAS_CLARITY: wk_sea_has_flags = 0x200;
/// ice_cover, ice_floe_m and ice_width_m
pub const WK_SEA_HAS_ICE: wk_sea_has_flags = 0x400;

/// Properties of a sea.
pub type wk_sea_flags = u32;
/// Waves break without foam.
pub const WK_SEA_WITHOUT_WHITECAPS: wk_sea_flags = 1;
/// There is water only inside regions (wk_context_set_sea_regions).
pub const WK_SEA_ONLY_IN_REGIONS: wk_sea_flags = 2;

/// Optical type of water (Jerlov 1976).
pub type wk_water_type = u32;
/// Ocean I, the clearest.
pub const WK_WATER_TYPE_I: wk_water_type = 0;
/// Ocean IB.
pub const WK_WATER_TYPE_IB: wk_water_type = 1;
/// Ocean II.
pub const WK_WATER_TYPE_II: wk_water_type = 2;
/// Ocean III.
pub const WK_WATER_TYPE_III: wk_water_type = 3;
/// Coast 1C.
pub const WK_WATER_TYPE_1C: wk_water_type = 4;
/// Coast 3C.
pub const WK_WATER_TYPE_3C: wk_water_type = 5;
/// Coast 5C.
pub const WK_WATER_TYPE_5C: wk_water_type = 6;
/// Coast 7C, the most turbid.
pub const WK_WATER_TYPE_7C: wk_water_type = 7;

/// Kind of water inside a region.
pub type wk_sea_region_kind = u32;
/// No water: inside a hull or an empty dock. Such a region counts before all others.
pub const WK_SEA_REGION_DRY: wk_sea_region_kind = 0;
/// The sea with lower waves: a harbour.
pub const WK_SEA_REGION_SHELTERED: wk_sea_region_kind = 1;
/// Water with a level of its own: a lake, a lock.
pub const WK_SEA_REGION_LAKE: wk_sea_region_kind = 2;

/// A swell: waves from far away.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_swell {
    /// sizeof(wk_sea_swell) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA_SWELL.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Significant height, m. Range [0, 20], default 0; at most a fifteenth of the wave length at the peak.
    pub height_m: f64,
    /// Peak period, s. Range [1, 30], default 10.
    pub period_s: f64,
    /// Direction that it comes from, degrees clockwise from true north. Range [0, 360], default 0.
    pub from_deg: f64,
    /// Directional width, degrees. Range [1, 60]; 0, the default, is 15.
    pub spread_deg: f64,
}

impl wk_sea_swell {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SEA_SWELL,
        next: null(),
        height_m: 0.0,
        period_s: 10.0,
        from_deg: 0.0,
        spread_deg: 0.0,
    };

    fn swell(&self) -> SeaSwell {
        let spread_deg = (self.spread_deg != 0.0).then_some(self.spread_deg);
        SeaSwell { height_m: self.height_m, period_s: self.period_s, from_deg: self.from_deg, spread_deg }
    }
}

/// A regular wave of infinite crests, added to all others.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_wave {
    /// sizeof(wk_sea_wave) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA_WAVE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Height from trough to crest, m. Range [0, 40], default 0. The steepnesses of all such waves together are at most
    /// 0.142, each being height / length / tanh(2 pi depth / length) (Miche 1944): steeper waves break.
    pub height_m: f64,
    /// Wave length, m. Range [0.1, 2000]; 0, the default, where period_s says it.
    pub length_m: f64,
    /// Period, s. Range [0.25, 40]; 0, the default, where length_m says it. One of the two must be set.
    pub period_s: f64,
    /// Direction that the wave comes from, degrees clockwise from true north. Range [0, 360], default 0.
    pub from_deg: f64,
    /// Time of a crest at the world's origin, in degrees of the period after simulation time 0. Range [-360, 360],
    /// default 0.
    pub phase_deg: f64,
}

impl wk_sea_wave {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SEA_WAVE,
        next: null(),
        height_m: 0.0,
        length_m: 0.0,
        period_s: 0.0,
        from_deg: 0.0,
        phase_deg: 0.0,
    };

    fn wave(&self, name: &str) -> Result<SingleWave> {
        let scale = match (self.length_m != 0.0, self.period_s != 0.0) {
            (true, false) => WaveScale::Length(self.length_m),
            (false, true) => WaveScale::Period(self.period_s),
            _ => {
                let accepted = format!("0 where {name}.length_m is set, and set where that is 0");
                return Err(Error::range(&format!("{name}.period_s"), &accepted, self.period_s));
            }
        };
        Ok(SingleWave { height_m: self.height_m, scale, from_deg: self.from_deg, phase_deg: self.phase_deg })
    }
}

/// The sea of a context. Optional fields have a flag in `has`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea {
    /// sizeof(wk_sea) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Flags of the optional fields that are set. Default 0.
    pub has: wk_sea_has_flags,
    /// Properties. Default 0.
    pub flags: wk_sea_flags,
    /// Mean level, m above mean sea level. Range [-500, 9000], default 0.
    pub level_m: f64,
    /// Depth of the water below the mean level, m, the same everywhere. Range [0.5, 12000], default 4000. It sets the
    /// lengths and speeds of waves; where the terrain has a bed, answers have the depth above that.
    pub depth_m: f64,
    /// Height of high water above the mean level, m; the tide has the period of the moon's half-day, 12.4206 h. Range
    /// [0, 10]; 0, the default, is no tide.
    pub tide_amplitude_m: f64,
    /// Simulation time of a high water, s. Range [-1e10, 1e10], default 0.
    pub tide_high_water_s: f64,
    /// Optional: distance over which the wind raises waves, m. Range [10, 2e7]; else the open sea.
    pub fetch_m: f64,
    /// Optional: significant height of the wind sea, m. Range [0, 30], at most a fifteenth of the wave length at the
    /// peak; else by sea_state, beaufort, or the weather.
    pub significant_height_m: f64,
    /// Optional: peak period of the wind sea, s. Range [0.5, 30]; else that of a fully developed sea of this height.
    pub peak_period_s: f64,
    /// Optional: peak enhancement of JONSWAP. Range [1, 10]; else 3.3 with a peak period and 1 without.
    pub peak_gamma: f64,
    /// Optional: Beaufort number. Range [0, 12]: the sea that a wind of 0.836 B^1.5 m/s keeps up over the fetch.
    pub beaufort: f64,
    /// Optional: direction that the wind sea comes from, degrees clockwise from true north. Range [0, 360]; else that
    /// of the wind that raised it.
    pub wind_sea_from_deg: f64,
    /// Optional: temperature of the water, degrees Celsius. Range [-3, 45]; else the weather's.
    pub temperature_c: f64,
    /// Salinity, g/kg. Range [0, 45], default 35.
    pub salinity_g_kg: f64,
    /// Optional: share of downward blue light (450 nm) that a metre of water leaves, percent. Range [41.1, 98.1], which
    /// are types 7C and I; else by water_type.
    pub clarity_percent: f64,
    /// Optional, with the next two fields: share of the surface under ice floes. Range [0, 1]; else no ice.
    pub ice_cover: f64,
    /// Diameter of the floes, m. Range [0.1, 10000], default 20. Shorter waves do not lift them.
    pub ice_floe_m: f64,
    /// Distance that the waves have come through the ice, m. Range [0, 1e7], default 1000. They fade along it by
    /// Meylan, Bennetts and Kohout (2014).
    pub ice_width_m: f64,
    /// Optional: WMO sea state, code table 3700. Range 0 to 9: the middle of its range of heights, fully developed.
    pub sea_state: u32,
    /// Optical type of the water. Default WK_WATER_TYPE_IB.
    pub water_type: wk_water_type,
    /// Optional: the swells; may be NULL if there are none. Read during the call only. Else the weather's swell.
    pub swells: *const wk_sea_swell,
    /// Number of swells, at most 4. Default 0.
    pub swell_count: u32,
    /// Bytes from one swell to the next: sizeof(wk_sea_swell) of your header, which is the default.
    pub swell_stride: u32,
    /// Single waves; may be NULL if there are none. Read during the call only.
    pub waves: *const wk_sea_wave,
    /// Number of single waves, at most 16. Default 0.
    pub wave_count: u32,
    /// Bytes from one wave to the next: sizeof(wk_sea_wave) of your header, which is the default.
    pub wave_stride: u32,
}

impl wk_sea {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SEA,
        next: null(),
        has: 0,
        flags: 0,
        level_m: 0.0,
        depth_m: 4000.0,
        tide_amplitude_m: 0.0,
        tide_high_water_s: 0.0,
        fetch_m: 0.0,
        significant_height_m: 0.0,
        peak_period_s: 0.0,
        peak_gamma: 0.0,
        beaufort: 0.0,
        wind_sea_from_deg: 0.0,
        temperature_c: 0.0,
        salinity_g_kg: 35.0,
        clarity_percent: 0.0,
        ice_cover: 0.0,
        ice_floe_m: 20.0,
        ice_width_m: 1000.0,
        sea_state: 0,
        water_type: WK_WATER_TYPE_IB,
        swells: null(),
        swell_count: 0,
        swell_stride: struct_size::<wk_sea_swell>(),
        waves: null(),
        wave_count: 0,
        wave_stride: struct_size::<wk_sea_wave>(),
    };

    /// Returns the settings but for the lists.
    fn settings(&self) -> Result<SeaSettings> {
        let some = |bit: wk_sea_has_flags, value: f64| (self.has & bit != 0).then_some(value);
        let ice = SeaIce { cover: self.ice_cover, floe_m: self.ice_floe_m, width_m: self.ice_width_m };
        let tide = Tide { amplitude_m: self.tide_amplitude_m, high_water_s: self.tide_high_water_s };
        Ok(SeaSettings {
            level_m: self.level_m,
            tide: (tide.amplitude_m != 0.0).then_some(tide),
            fetch_m: some(WK_SEA_HAS_FETCH, self.fetch_m),
            depth_m: self.depth_m,
            salinity_g_kg: self.salinity_g_kg,
            temperature_c: some(WK_SEA_HAS_TEMPERATURE, self.temperature_c),
            wind_sea: self.wind_sea()?,
            from_deg: some(WK_SEA_HAS_WIND_SEA_FROM, self.wind_sea_from_deg),
            swells: (self.has & WK_SEA_HAS_SWELLS != 0).then(Vec::new),
            waves: Vec::new(),
            ice: (self.has & WK_SEA_HAS_ICE != 0).then_some(ice),
            clarity: match some(WK_SEA_HAS_CLARITY, self.clarity_percent) {
                Some(percent) => WaterClarity::Percent(percent),
                None => WaterClarity::Type(water_type(self.water_type)),
            },
            without_whitecaps: self.flags & WK_SEA_WITHOUT_WHITECAPS != 0,
            only_in_regions: self.flags & WK_SEA_ONLY_IN_REGIONS != 0,
        })
    }

    /// Returns the source of the wind sea: one at most.
    fn wind_sea(&self) -> Result<WindSea> {
        let has = |bit: wk_sea_has_flags| self.has & bit != 0;
        let some = |bit: wk_sea_has_flags, value: f64| has(bit).then_some(value);
        let refused = |accepted: &str| Err(Error::range("sea.has", accepted, format!("{:#x}", self.has)));
        let is_shaped = has(WK_SEA_HAS_PEAK_PERIOD) || has(WK_SEA_HAS_PEAK_GAMMA);
        if is_shaped && !has(WK_SEA_HAS_HEIGHT) {
            return refused("with WK_SEA_HAS_HEIGHT where WK_SEA_HAS_PEAK_PERIOD or WK_SEA_HAS_PEAK_GAMMA is set");
        }
        Ok(match (has(WK_SEA_HAS_HEIGHT), has(WK_SEA_HAS_SEA_STATE), has(WK_SEA_HAS_BEAUFORT)) {
            (false, false, false) => WindSea::Weather,
            (true, false, false) => WindSea::Height {
                significant_m: self.significant_height_m,
                peak_period_s: some(WK_SEA_HAS_PEAK_PERIOD, self.peak_period_s),
                gamma: some(WK_SEA_HAS_PEAK_GAMMA, self.peak_gamma),
            },
            (false, true, false) => WindSea::SeaState(
                u8::try_from(self.sea_state).map_err(|_| Error::range("sea.sea_state", "in [0, 9]", self.sea_state))?,
            ),
            (false, false, true) => WindSea::Beaufort(self.beaufort),
            _ => return refused("at most one of WK_SEA_HAS_HEIGHT, WK_SEA_HAS_SEA_STATE and WK_SEA_HAS_BEAUFORT"),
        })
    }
}

/// Returns the water type of a known constant.
fn water_type(value: wk_water_type) -> WaterType {
    WaterType::ALL.get(value as usize).copied().unwrap_or(WaterType::IB)
}

/// Renames a field of [`SeaSettings`] as the header names it.
fn header_name(e: Error) -> Error {
    let flat = |field: &str| match field {
        "wind_sea.significant_m" => "significant_height_m".into(),
        "wind_sea.gamma" => "peak_gamma".into(),
        "from_deg" => "wind_sea_from_deg".into(),
        "swells" => "swell_count".into(),
        "waves" => "wave_count".into(),
        other => match other.strip_prefix("wind_sea.") {
            Some(field) => field.into(),
            None => other.replace("tide.", "tide_").replace("ice.", "ice_").replace("clarity.", "clarity_"),
        },
    };
    e.map_field(flat).within("sea")
}

/// Reads a sea with its lists.
///
/// # Safety
/// `sea` is NULL or a struct of its size, whose lists are NULL or as long as they say.
unsafe fn settings_of(sea: *const wk_sea) -> Result<SeaSettings> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"sea", sea)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&"sea", c.next, &[])? };
    let mut settings = c.settings()?;
    if let Some(swells) = &mut settings.swells {
        let list = List {
            name: "sea.swells",
            count: Named("sea.swell_count", c.swell_count as usize),
            stride: Named("sea.swell_stride", c.swell_stride as usize),
            limit: MAX_SWELLS,
        };
        let mut take = |_: usize, swell: wk_sea_swell| {
            swells.push(swell.swell());
            Ok(())
        };
        // SAFETY: the caller's promise about the lists.
        unsafe { input::each(&list, c.swells, &mut take)? };
    }
    let list = List {
        name: "sea.waves",
        count: Named("sea.wave_count", c.wave_count as usize),
        stride: Named("sea.wave_stride", c.wave_stride as usize),
        limit: MAX_SINGLE_WAVES,
    };
    let mut take = |i: usize, wave: wk_sea_wave| {
        settings.waves.push(wave.wave(&format!("sea.waves[{i}]"))?);
        Ok(())
    };
    // SAFETY: as above.
    unsafe { input::each(&list, c.waves, &mut take)? };
    Ok(settings)
}

/// Sets the sea; NULL removes it. Part of the state that wk_context_save keeps. Set it before the first update: what
/// it says about fetch holds for all weather that the timeline still knows. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range, or two sources of the wave height.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_sea(context: *mut wk_context, sea: *const wk_sea) -> wk_status {
    guard("wk_context_set_sea", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `sea`.
        let settings = if sea.is_null() { None } else { Some(unsafe { settings_of(sea)? }) };
        object.write().set_sea(settings).map_err(header_name)?;
        Ok(Status::Ok)
    })
}

/// A region of the ground plan with water of its own, or without water.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_region {
    /// sizeof(wk_sea_region) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA_REGION.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Corners of the outline, m to the right and ahead of the centre, in order, either way around, each within 1e6 m.
    /// The outline must not cross or touch itself. Read during the call only.
    pub corners_m: *const [f64; 2],
    /// Number of corners. Range 3 to 64.
    pub corner_count: u32,
    /// Kind of water inside. Default WK_SEA_REGION_DRY.
    pub kind: wk_sea_region_kind,
    /// Position of the centre in the host's world at the time at_s, m, within 1e12 m of the origin. Its height does not
    /// matter. Default 0, 0, 0.
    pub center_m: [f64; 3],
    /// Heading of `ahead` at at_s, degrees clockwise from true north. Range [-360, 360], default 0.
    pub heading_deg: f64,
    /// Velocity east and north, m/s, of at most 60 m/s. Default 0, 0.
    pub velocity_m_s: [f64; 2],
    /// Rate of turn, degrees clockwise a second. Range [-90, 90], default 0.
    pub turn_deg_s: f64,
    /// Simulation time at which the centre is at center_m, s. Range [-1e10, 1e10], default 0.
    pub at_s: f64,
    /// Lakes: level without waves, m above mean sea level. Range [-500, 9000], default 0.
    pub level_m: f64,
    /// Lakes: depth below that level, m. Range [0.1, 12000], default 10. Waves keep the lengths that they have over the
    /// sea's depth.
    pub depth_m: f64,
    /// Lakes and sheltered regions: height of the waves over that on the open sea. Range [0, 1], default 1.
    pub wave_share: f64,
    /// Sheltered regions: width of the band inside the outline over which waves become lower, m. Range [0, 10000],
    /// default 0: at once.
    pub rim_m: f64,
}

impl wk_sea_region {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SEA_REGION,
        next: null(),
        corners_m: null(),
        corner_count: 0,
        kind: WK_SEA_REGION_DRY,
        center_m: [0.0, 0.0, 0.0],
        heading_deg: 0.0,
        velocity_m_s: [0.0, 0.0],
        turn_deg_s: 0.0,
        at_s: 0.0,
        level_m: 0.0,
        depth_m: 10.0,
        wave_share: 1.0,
        rim_m: 0.0,
    };

    fn region(&self, corners_m: Vec<[f64; 2]>) -> SeaRegion {
        SeaRegion {
            kind: match self.kind {
                WK_SEA_REGION_SHELTERED => SeaRegionKind::Sheltered,
                WK_SEA_REGION_LAKE => SeaRegionKind::Lake { level_m: self.level_m, depth_m: self.depth_m },
                _ => SeaRegionKind::Dry,
            },
            corners_m,
            center_m: self.center_m,
            heading_deg: self.heading_deg,
            velocity_m_s: self.velocity_m_s,
            turn_deg_s: self.turn_deg_s,
            at_s: self.at_s,
            wave_share: self.wave_share,
            rim_m: self.rim_m,
        }
    }
}

/// Replaces the list of regions; count 0 removes all. At most 64. Regions that move at a constant velocity and rate of
/// turn move by themselves: set them again when these change. Later regions count before earlier ones, dry ones before
/// all. Part of the state that wk_context_save keeps. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range: outlines that cross themselves, too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_sea_regions(
    context: *mut wk_context,
    regions: *const wk_sea_region,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_sea_regions", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = Vec::new();
        let mut take = |i: usize, c: wk_sea_region| {
            let (of, name) = (c.corner_count as usize, format!("regions[{i}].corner_count"));
            // SAFETY: the caller's promise about the corners.
            let corners = unsafe {
                input::slice(&format!("regions[{i}].corners_m"), c.corners_m, Named(&name, of), MAX_OUTLINE_CORNERS)?
            };
            list.push(c.region(corners.to_vec()));
            Ok(())
        };
        // SAFETY: the caller's promise about `regions`.
        unsafe { input::each(&List::parameters("regions", count, stride, MAX_SEA_REGIONS), regions, &mut take)? };
        object.write().set_sea_regions(list)?;
        Ok(Status::Ok)
    })
}

/// The sea at a place and time. Element of an array, without struct_size; calls take its sizeof instead. Where there is
/// no water, surface_m is the position that was asked about, normal is up, and all other numbers are 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_point {
    /// Height of the surface above mean sea level, m.
    pub height_m: f64,
    /// Largest error of the height, m: 4 standard deviations of the waves left out, and the tolerances of the sums.
    pub height_error_m: f64,
    /// Point of the surface above or below the position, in the host's world, m.
    pub surface_m: [f64; 3],
    /// Unit normal of the surface (east, north, up).
    pub normal: [f64; 3],
    /// Velocity of the water at the surface, m/s (east, north, up), without its slow drift.
    pub velocity_m_s: [f64; 3],
    /// Acceleration of the water at the surface, m/s^2 (east, north, up).
    pub acceleration_m_s2: [f64; 3],
    /// Depth of the water under the surface, m.
    pub depth_m: f64,
    /// Share of the place under foam of waves that break now, 0 to 1.
    pub foam: f64,
    /// 1 where there is water, else 0.
    pub has_water: u32,
    /// 0.
    pub reserved0: u32,
}

impl wk_sea_point {
    fn of(p: &SeaPoint) -> Self {
        Self {
            height_m: p.height_m,
            height_error_m: p.height_error_m,
            surface_m: p.surface.to_array(),
            normal: p.normal.to_array(),
            velocity_m_s: p.velocity_m_s.to_array(),
            acceleration_m_s2: p.acceleration_m_s2.to_array(),
            depth_m: p.depth_m,
            foam: p.foam,
            has_water: u32::from(p.has_water),
            reserved0: 0,
        }
    }
}

/// Gets the sea at places of the host's world and at a simulation time, past or future, at most wk_caps.max_batch of
/// them. Only the place on the ground of a position counts, not its height. There is no water in dry regions, and where
/// the terrain's tiles lie above the surface, except in cells of WK_SURFACE_CLASS_WATER. `shortest_wave_m`, range
/// [0, 10000], leaves out waves shorter than your hull feels; 0 leaves out none. `position_size` and `point_size` are
/// the distances from one element to the next, bytes: 24 or more for positions, sizeof(wk_sea_point) of your header for
/// points. The first call for a time costs some milliseconds; the sums of the last two times are kept, and each place
/// then costs some microseconds. No device is needed, and nothing is allocated after the first calls.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER without a sea; WK_ERROR_INVALID_ARGUMENT for an invalid position; for times as
/// wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sea_at(
    context: *const wk_context,
    positions_m: *const [f64; 3],
    count: u32,
    position_size: u32,
    time_s: f64,
    shortest_wave_m: f64,
    points: *mut wk_sea_point,
    point_size: u32,
) -> wk_status {
    guard("wk_context_get_sea_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let places = input::Places::new("positions_m", "position_size", positions_m, count, position_size, MAX_BATCH)?;
        let room = input::Room::new("points", "point_size", points, count, point_size)?;
        let context = object.read();
        let query = context.sea_query(time_s, shortest_wave_m)?;
        let place = |i: usize| {
            let named = |e: Error| e.renamed("position", &format!("positions_m[{i}]"));
            // SAFETY: `i` is below the count that the caller promises.
            let at = unsafe { position("position", places.at(i)) }.map_err(named)?;
            Ok(DVec3::from_array(at))
        };
        for i in 0..count as usize {
            let named = |e: Error| e.renamed("position", &format!("positions_m[{i}]"));
            context.check_sea_position(place(i)?).map_err(named)?;
        }
        for i in 0..count as usize {
            let point = query.at(place(i)?)?;
            // SAFETY: the caller's promise about the room, which has as many elements.
            unsafe { room.write(i, &wk_sea_point::of(&point)) };
        }
        Ok(Status::Ok)
    })
}

/// Statistics of the sea at a time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_state {
    /// sizeof(wk_sea_state) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA_STATE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Level without waves, m above mean sea level: the mean level and the tide.
    pub level_m: f64,
    /// Significant height of all waves, m: four standard deviations of the surface's height, single waves included.
    pub significant_height_m: f64,
    /// Period of the strongest waves, s; 0 without waves.
    pub peak_period_s: f64,
    /// Mean direction that the waves come from, degrees clockwise from true north, weighted by variance; 0 without
    /// waves.
    pub mean_from_deg: f64,
    /// Mean square slope of the surface: Cox and Munk's (1954) for the wind, or that of the waves if it is larger.
    pub mean_square_slope: f64,
    /// Part of it that the waves of the surface have; the rest is in waves too short for it.
    pub drawn_square_slope: f64,
    /// Height of the largest wave expected in an hour, m, crest to trough (Longuet-Higgins 1952), plus the heights of
    /// all single waves.
    pub highest_in_hour_m: f64,
    /// Share of the sea under whitecaps, 0 to 1 (Monahan and O'Muircheartaigh 1980), less under ice.
    pub whitecap_share: f64,
    /// Temperature of the water, degrees Celsius.
    pub water_temperature_c: f64,
    /// Refractive index of the water against air at 550 nm (Quan and Fry 1995).
    pub refractive_index: f64,
    /// Diffuse attenuation of downward light at 450, 550 and 650 nm, 1/m (Jerlov 1976).
    pub attenuation_per_m: [f64; 3],
}

impl wk_sea_state {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SEA_STATE,
        next: null(),
        level_m: 0.0,
        significant_height_m: 0.0,
        peak_period_s: 0.0,
        mean_from_deg: 0.0,
        mean_square_slope: 0.0,
        drawn_square_slope: 0.0,
        highest_in_hour_m: 0.0,
        whitecap_share: 0.0,
        water_temperature_c: 0.0,
        refractive_index: 0.0,
        attenuation_per_m: [0.0, 0.0, 0.0],
    };

    fn of(s: &SeaStatistics) -> Self {
        Self {
            level_m: s.level_m,
            significant_height_m: s.significant_height_m,
            peak_period_s: s.peak_period_s,
            mean_from_deg: s.mean_from_deg,
            mean_square_slope: s.mean_square_slope,
            drawn_square_slope: s.drawn_square_slope,
            highest_in_hour_m: s.highest_in_hour_m,
            whitecap_share: s.whitecap_share,
            water_temperature_c: s.water_temperature_c,
            refractive_index: s.refractive_index,
            attenuation_per_m: s.attenuation_per_m,
            ..Self::INIT
        }
    }
}

/// Gets the statistics of the open sea at a simulation time, past or future.
/// Thread: concurrent.
/// Errors: WK_ERROR_WRONG_ORDER without a sea; for times as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sea_state(
    context: *const wk_context,
    time_s: f64,
    out_state: *mut wk_sea_state,
) -> wk_status {
    guard("wk_context_get_sea_state", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `out_state`.
        let out = unsafe { layout::out_struct(&"out_state", out_state)? };
        out.set(&wk_sea_state::of(&object.read().sea_statistics(time_s)?));
        Ok(Status::Ok)
    })
}
