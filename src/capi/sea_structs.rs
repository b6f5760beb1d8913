//! Structs of the sea (settings, regions and answers) and the constants of their fields.

use std::{ffi::c_void, ptr::null};

use super::boundary::{layout::struct_size, numbers::*};
use crate::{
    error::{Error, Result},
    sea::{
        SeaHull, SeaIce, SeaPoint, SeaRegion, SeaRegionKind, SeaSettings, SeaSwell, SingleWave, Tide, WaterClarity,
        WaveScale, WindSea, water::WaterType,
    },
};

/// Flags that say which optional fields of a wk_sea are set.
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
/// Coast 7C, the most turbid of these eight.
pub const WK_WATER_TYPE_7C: wk_water_type = 7;

/// Kind of water inside a region.
pub type wk_sea_region_kind = u32;
/// No water: inside a hull or an empty dock. Such a region takes precedence over all others.
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
    /// Direction that the swell comes from, degrees clockwise from true north. Range [0, 360], default 0.
    pub from_deg: f64,
    /// Directional width, degrees. Range [1, 60]; 0, the default, means 15.07.
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

    pub(super) fn swell(&self) -> SeaSwell {
        let spread_deg = (self.spread_deg != 0.0).then_some(self.spread_deg);
        SeaSwell { height_m: self.height_m, period_s: self.period_s, from_deg: self.from_deg, spread_deg }
    }
}

/// A regular wave with infinitely long crests, added to all others.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_wave {
    /// sizeof(wk_sea_wave) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA_WAVE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Height from trough to crest, m. Range [0, 40], default 0. The steepness of a wave is height / length / tanh(2 pi
    /// depth / length). The sum of the steepnesses of all single waves is at most 0.142: steeper waves break (Miche
    /// 1944).
    pub height_m: f64,
    /// Wave length, m. Range [0.1, 2000]; 0, the default, if you set period_s instead.
    pub length_m: f64,
    /// Period, s. Range [0.25, 40]; 0, the default, if you set length_m instead. Set exactly one of the two.
    pub period_s: f64,
    /// Direction that the wave comes from, degrees clockwise from true north. Range [0, 360], default 0.
    pub from_deg: f64,
    /// Time from simulation time 0 until a crest passes the world's origin, in degrees: 360 is one period of the wave.
    /// Range [-360, 360], default 0.
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

    pub(super) fn wave(&self, name: &str) -> Result<SingleWave> {
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
    /// lengths and speeds of waves. Over the host's terrain tiles, queries return the depth above the terrain instead.
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
    /// Optional: peak enhancement of JONSWAP. Range [1, 10]; else 3.3 if peak_period_s is set, and 1 if it is not.
    pub peak_gamma: f64,
    /// Optional: Beaufort number B. Range [0, 12]. The sea is the one that a steady wind of 0.836 B^1.5 m/s sustains
    /// over the fetch.
    pub beaufort: f64,
    /// Optional: direction that the wind sea comes from, degrees clockwise from true north. Range [0, 360]; else that
    /// of the wind that raised it.
    pub wind_sea_from_deg: f64,
    /// Optional: temperature of the water, degrees Celsius. Range [-3, 45]; else the weather's.
    pub temperature_c: f64,
    /// Salinity, g/kg. Range [0, 45], default 35.
    pub salinity_g_kg: f64,
    /// Optional: share of downward blue light (450 nm) that passes a metre of water, percent. Range [41.1, 98.1]: from
    /// type 7C to type I; else by water_type.
    pub clarity_percent: f64,
    /// Optional, with ice_floe_m and ice_width_m: share of the surface under ice floes. Range [0, 1]; else no ice.
    pub ice_cover: f64,
    /// Diameter of the floes, m. Range [0.1, 10000], default 20. Waves shorter than a floe do not lift it.
    pub ice_floe_m: f64,
    /// Distance that the waves have travelled through the ice, m. Range [0, 1e7], default 1000. The waves decay along
    /// this distance (Meylan, Bennetts and Kohout 2014).
    pub ice_width_m: f64,
    /// Optional: WMO sea state, code table 3700. Range 0 to 9. The sea is fully developed, with the middle of the
    /// code's range of heights.
    pub sea_state: u32,
    /// Optical type of the water. Default WK_WATER_TYPE_IB.
    pub water_type: wk_water_type,
    /// Optional: the swells; else the weather's swell. May be NULL if there are none. Read during the call only.
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

    /// Returns the settings without the lists of swells and waves.
    pub(super) fn settings(&self) -> Result<SeaSettings> {
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

    /// Returns the source of the wind sea, after checking that there is at most one.
    pub(super) fn wind_sea(&self) -> Result<WindSea> {
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
    /// Corners of the outline, in clockwise or counter-clockwise order. Each corner is two numbers: its distances from
    /// the centre to the right of the heading and along the heading, m, within 1e6. The outline must not cross or touch
    /// itself. Read during the call only.
    pub corners_m: *const [f64; 2],
    /// Number of corners, [3, 64]. Default 0; must be given.
    pub corner_count: u32,
    /// Kind of water inside. Default WK_SEA_REGION_DRY.
    pub kind: wk_sea_region_kind,
    /// Position of the centre in the host's world at the time at_s, m, within 1e12 m of the origin; its height has no
    /// effect. Default 0, 0, 0.
    pub center_m: [f64; 3],
    /// Heading of the outline at the time at_s, degrees clockwise from true north. Range [-360, 360], default 0.
    pub heading_deg: f64,
    /// Velocity to the east and north, m/s; its length is at most 60. Default 0, 0.
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
    /// Lakes and sheltered regions: ratio of the height of the waves to that on the open sea. Range [0, 1], default 1.
    pub wave_share: f64,
    /// Sheltered regions: width of the band inside the outline over which the waves become lower, m. Range [0, 10000];
    /// 0, the default, is a step at the outline.
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

    pub(super) fn region(&self, corners_m: Vec<[f64; 2]>) -> SeaRegion {
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

/// A hull that moves through the water and raises a wake. The waves of its bow and stern follow from its length, beam,
/// draught and speed (Michell 1898); the wake also contains the foam of the hull's wash. The hull goes on at its speed
/// and rate of turn until it is set anew.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_hull {
    /// sizeof(wk_sea_hull) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SEA_HULL.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Your number for the hull; no two hulls of a list have the same. Default 0.
    pub id: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// Length of the waterline, m. Range [1, 500], default 30.
    pub length_m: f64,
    /// Beam of the waterline, m. Range [0.2, 100], default 8.
    pub beam_m: f64,
    /// Draught, m. Range [0.05, 30], default 2.5.
    pub draught_m: f64,
    /// Position of the middle of the waterline in the host's world at the time at_s, m, within 1e12 m of the origin.
    /// Its height does not matter. Default 0, 0, 0.
    pub position_m: [f64; 3],
    /// Heading at at_s, degrees clockwise from true north. Range [-360, 360], default 0. The hull moves along it.
    pub heading_deg: f64,
    /// Speed through the water, m/s. Range [0, 60], default 0.
    pub speed_m_s: f64,
    /// Rate of turn, degrees clockwise a second. Range [-90, 90], default 0.
    pub turn_deg_s: f64,
    /// Simulation time of position and heading, s. Range [-1e10, 1e10], default 0.
    pub at_s: f64,
}

impl wk_sea_hull {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SEA_HULL,
        next: null(),
        id: 0,
        reserved0: 0,
        length_m: 30.0,
        beam_m: 8.0,
        draught_m: 2.5,
        position_m: [0.0, 0.0, 0.0],
        heading_deg: 0.0,
        speed_m_s: 0.0,
        turn_deg_s: 0.0,
        at_s: 0.0,
    };

    pub(super) fn hull(&self) -> SeaHull {
        SeaHull {
            id: self.id,
            length_m: self.length_m,
            beam_m: self.beam_m,
            draught_m: self.draught_m,
            position_m: self.position_m,
            heading_deg: self.heading_deg,
            speed_m_s: self.speed_m_s,
            turn_deg_s: self.turn_deg_s,
            at_s: self.at_s,
        }
    }
}

/// The sea at a place and time. Element of an array, without struct_size; calls take its sizeof instead. Where there is
/// no water, surface_m is the queried position, normal is up, and all other numbers are 0. A dry region is an
/// exception: there has_water is 0, and the other fields are those of the water around the region.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sea_point {
    /// Height of the surface above mean sea level, m.
    pub height_m: f64,
    /// Bound of the error of height_m, m: 4 standard deviations of the waves left out, plus the tolerance of the
    /// computation.
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
    /// Share of the place under foam, 0 to 1: foam of waves that break now, what is left of the foam of the last 3.6 s,
    /// and the wash of hulls.
    pub foam: f64,
    /// 1 where there is water, 0 where there is none or in a dry region.
    pub has_water: u32,
    /// Always 0.
    pub reserved0: u32,
}

impl wk_sea_point {
    pub(super) fn of(p: &SeaPoint) -> Self {
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
