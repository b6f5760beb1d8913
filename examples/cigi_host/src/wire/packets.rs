//! The table of offsets: every field of every packet that this program knows, in 3.x and in 4.0.
//!
//! Offsets were checked against datagrams of the class libraries 3.3.3a and 4.0, and against Wireshark's dissector.
//! Those of HAT/HOT and of Short Articulated Part Control are as the class library 4.0 packs them. Bytes that no row
//! names are reserved: they are written as 0 and ignored when read. Angles are in degrees, lengths in metres.

use super::layout::{Family, Field, Header, Layout, Role, Visitor, last, packets};
use super::slot::{
    Order, Raw, Slot,
    Slot::{Absent, Bits, F32, F64, I8, U8, U16, U32},
};

const fn header(id: u16, size: usize) -> Option<Header> {
    Some(Header { id, size })
}

packets! {
    /// First packet of each message from the host.
    IgControl = "IG Control", [header(1, 24), header(0x0000, 24)] {
        /// Major version, 3 or 4.
        major_version: u8 = U8(2), U8(4), Listed;
        /// Minor version: 0 in 3.0, 3.1 and 4.0; 2 in 3.2; 3 in 3.3.
        minor_version: u8 = Bits(4, 4, 4), Bits(7, 4, 4), Listed;
        /// Database that the host wants, 1 to 127; 0 for no change.
        database_number: i8 = I8(3), I8(5), Listed;
        /// 0 reset and standby, 1 operate, 2 debug.
        ig_mode: u8 = Bits(4, 0, 2), Bits(7, 0, 2), Listed;
        /// Whether the timestamp counts.
        timestamp_valid: bool = Bits(4, 2, 1), Bits(7, 2, 1), Listed;
        /// Master switch of smoothing by extrapolation or interpolation.
        smoothing_enable: bool = Bits(4, 3, 1), Bits(7, 3, 1), Listed;
        /// Count of the host's messages.
        host_frame_number: u32 = U32(8), U32(8), Listed;
        /// Time, ticks of 10 us.
        timestamp_10us: u32 = U32(12), U32(16), Listed;
        /// Last frame number that the host had from the image generator. Not in 3.0 and 3.1.
        last_ig_frame_number: u32 = U32(16), U32(12), Listed;
        /// 0x8000 as the sender writes it: the sign of its byte order.
        byte_swap: u16 = U16(6), Absent, Unlisted;
        /// Whether similar entity types may stand in.
        entity_type_substitution: bool = Absent, Bits(6, 0, 1), Unlisted;
    }
    /// First packet of each message from the image generator.
    StartOfFrame = "Start of Frame", [header(101, 24), header(0xffff, 24)] {
        /// Major version, 3 or 4.
        major_version: u8 = U8(2), U8(4), Listed;
        /// Minor version, as in [`IgControl`].
        minor_version: u8 = Bits(5, 4, 4), Bits(7, 4, 4), Listed;
        /// Minus the number while the database loads, the number when it is ready, -128 if loading failed, 0 if the
        /// image generator chooses.
        database_number: i8 = I8(3), I8(5), Listed;
        /// 0 if healthy; else a code of the image generator's own.
        ig_status: u8 = U8(4), Absent, Listed;
        /// 0 reset and standby, 1 operate, 2 debug, 3 offline maintenance.
        ig_mode: u8 = Bits(5, 0, 2), Bits(7, 0, 2), Listed;
        /// Whether the timestamp counts.
        timestamp_valid: bool = Bits(5, 2, 1), Bits(7, 2, 1), Listed;
        /// 0 WGS 84, 1 as the host defines.
        earth_reference_model: u8 = Bits(5, 3, 1), Bits(7, 3, 1), Listed;
        /// Count of the image generator's frames.
        ig_frame_number: u32 = U32(8), U32(8), Listed;
        /// Time, ticks of 10 us.
        timestamp_10us: u32 = U32(12), U32(12), Listed;
        /// Last frame number from the host. Not in 3.0 and 3.1.
        last_host_frame_number: u32 = U32(16), U32(16), Listed;
        /// 0x8000, as in [`IgControl`].
        byte_swap: u16 = U16(6), Absent, Unlisted;
        /// Condition flags: 1 overframing, 2 paging, 4 too much data of variable length.
        condition_flags: u8 = Absent, Bits(20, 0, 3), Unlisted;
    }
    /// State of an entity, and in 3.x its place.
    EntityControl = "Entity Control", [header(2, 48), header(0x0025, 16)], child if attach_state {
        /// Entity; 0 is the ownship by custom.
        entity_id: u16 = U16(2), U16(6), Listed;
        /// 0 standby (hidden), 1 active, 2 destroyed.
        entity_state: u8 = Bits(4, 0, 2), Bits(4, 0, 2), Listed;
        /// Whether the type is that of DIS, in seven fields.
        extended_type: bool = Absent, Bits(4, 5, 1), Listed;
        /// Type of the image generator's list, or the country of an extended type.
        entity_type: u16 = U16(8), U16(10), Listed;
        /// 0 top level, 1 child.
        attach_state: u8 = Bits(4, 2, 1), Absent, Listed;
        /// Parent of a child.
        parent_id: u16 = U16(10), Absent, Listed;
        /// 0 none, 1 altitude to the ground, 2 altitude and attitude.
        clamp: u8 = Bits(4, 5, 2), Absent, Listed;
        /// 0 clear to 255 opaque.
        alpha: u8 = U8(6), U8(5), Listed;
        /// Whether to smooth the motion.
        smoothing_enable: bool = Bits(5, 4, 1), Bits(4, 4, 1), ListedInV4;
        /// Roll.
        roll_deg: f32 = F32(12), Absent, Listed;
        /// Pitch.
        pitch_deg: f32 = F32(16), Absent, Listed;
        /// Yaw: from true north at the top level.
        yaw_deg: f32 = F32(20), Absent, Listed;
        /// Latitude, north.
        latitude_deg: f64 = F64(24), Absent, Top;
        /// Longitude, east.
        longitude_deg: f64 = F64(32), Absent, Top;
        /// Altitude.
        altitude_m: f64 = F64(40), Absent, Top;
        /// Forward in the parent's axes.
        x_offset_m: f64 = F64(24), Absent, Child;
        /// Right in the parent's axes.
        y_offset_m: f64 = F64(32), Absent, Child;
        /// Down in the parent's axes.
        z_offset_m: f64 = F64(40), Absent, Child;
        /// Whether collisions are detected.
        collision_detection: bool = Bits(4, 3, 1), Bits(4, 2, 1), Unlisted;
        /// Whether the parent's alpha counts.
        inherit_alpha: bool = Bits(4, 4, 1), Bits(4, 3, 1), Unlisted;
        /// 0 forward, 1 backward.
        animation_direction: u8 = Bits(5, 0, 1), Absent, Unlisted;
        /// Whether the animation repeats.
        animation_loop: bool = Bits(5, 1, 1), Absent, Unlisted;
        /// 0 stop, 1 pause, 2 play, 3 continue.
        animation_state: u8 = Bits(5, 2, 2), Absent, Unlisted;
        /// Kind of an extended type.
        kind: u8 = Absent, U8(8), Unlisted;
        /// Domain of an extended type.
        domain: u8 = Absent, U8(9), Unlisted;
        /// Category of an extended type.
        category: u8 = Absent, U8(12), Unlisted;
        /// Subcategory of an extended type.
        subcategory: u8 = Absent, U8(13), Unlisted;
        /// Specific field of an extended type.
        specific: u8 = Absent, U8(14), Unlisted;
        /// Extra field of an extended type.
        extra: u8 = Absent, U8(15), Unlisted;
    }
    /// Place of an entity in 4.0.
    EntityPosition = "Entity Position", [None, header(0x0001, 48)], child if attach_state {
        /// Entity.
        entity_id: u16 = Absent, U16(6), Listed;
        /// 0 top level, 1 child.
        attach_state: u8 = Absent, Bits(4, 0, 1), Listed;
        /// Parent of a child.
        parent_id: u16 = Absent, U16(8), Listed;
        /// 0 none, 1 altitude to the ground, 2 altitude and attitude.
        clamp: u8 = Absent, Bits(4, 1, 2), Listed;
        /// Roll.
        roll_deg: f32 = Absent, F32(12), Listed;
        /// Pitch.
        pitch_deg: f32 = Absent, F32(16), Listed;
        /// Yaw: from true north at the top level.
        yaw_deg: f32 = Absent, F32(20), Listed;
        /// Latitude, north.
        latitude_deg: f64 = Absent, F64(24), Top;
        /// Longitude, east.
        longitude_deg: f64 = Absent, F64(32), Top;
        /// Altitude.
        altitude_m: f64 = Absent, F64(40), Top;
        /// Forward in the parent's axes.
        x_offset_m: f64 = Absent, F64(24), Child;
        /// Right in the parent's axes.
        y_offset_m: f64 = Absent, F64(32), Child;
        /// Down in the parent's axes.
        z_offset_m: f64 = Absent, F64(40), Child;
    }
    /// Place of a view or of a group of views in an entity's axes.
    ViewControl = "View Control", [header(16, 32), header(0x000f, 40)] {
        /// View.
        view_id: u16 = U16(2), U16(6), Listed;
        /// Group; 0 if the single view counts.
        group_id: u8 = U8(4), U8(4), Listed;
        /// Entity that carries the view.
        entity_id: u16 = U16(6), U16(8), Listed;
        /// 1 x, 2 y, 4 z, 8 roll, 16 pitch, 32 yaw: a clear bit leaves the former value.
        enable_bits: u8 = Bits(5, 0, 6), Bits(5, 0, 6), Listed;
        /// Forward.
        x_offset_m: f32 = F32(8), F32(12), Listed;
        /// Right.
        y_offset_m: f32 = F32(12), F32(16), Listed;
        /// Down.
        z_offset_m: f32 = F32(16), F32(20), Listed;
        /// Roll.
        roll_deg: f32 = F32(20), F32(24), Listed;
        /// Pitch.
        pitch_deg: f32 = F32(24), F32(28), Listed;
        /// Yaw.
        yaw_deg: f32 = F32(28), F32(32), Listed;
    }
    /// Frustum of a view.
    ViewDefinition = "View Definition", [header(21, 32), header(0x0014, 40)] {
        /// View.
        view_id: u16 = U16(2), U16(4), Listed;
        /// Group that the view belongs to; 0 for none.
        group_id: u8 = U8(4), U8(6), Listed;
        /// 1 near, 2 far, 4 left, 8 right, 16 top, 32 bottom: a clear bit leaves the former value.
        enable_bits: u8 = Bits(5, 0, 6), Bits(7, 0, 6), Listed;
        /// 0 none, 1 horizontal, 2 vertical, 3 both.
        mirror_mode: u8 = Bits(5, 6, 2), Bits(7, 6, 2), Listed;
        /// Type of the image generator's own list.
        view_type: u8 = Bits(6, 5, 3), Bits(8, 5, 3), Listed;
        /// 1 brings the view to the top.
        reorder: u8 = Bits(6, 4, 1), Bits(8, 4, 1), Listed;
        /// 0 perspective, 1 orthographic.
        projection_type: u8 = Bits(6, 3, 1), Bits(8, 3, 1), Listed;
        /// 0 none, 1 1x2, 2 2x1, 3 2x2.
        pixel_replication: u8 = Bits(6, 0, 3), Bits(8, 0, 3), Listed;
        /// Distance of the near plane.
        near_m: f32 = F32(8), F32(12), Listed;
        /// Distance of the far plane.
        far_m: f32 = F32(12), F32(16), Listed;
        /// Half angle to the left.
        left_deg: f32 = F32(16), F32(20), Listed;
        /// Half angle to the right.
        right_deg: f32 = F32(20), F32(24), Listed;
        /// Half angle upward.
        top_deg: f32 = F32(24), F32(28), Listed;
        /// Half angle downward.
        bottom_deg: f32 = F32(28), F32(32), Listed;
    }
    /// Date, time, and what shines in the sky.
    CelestialSphereControl = "Celestial Sphere Control", [header(9, 16), header(0x0008, 24)] {
        /// Hour, 0 to 23.
        hour: u8 = U8(2), U8(6), Listed;
        /// Minute, 0 to 59.
        minute: u8 = U8(3), U8(7), Listed;
        /// Second, with fractions.
        second: f32 = Absent, F32(8), Listed;
        /// Month times 1e6, plus day times 1e4, plus year.
        date_mmddyyyy: u32 = U32(8), U32(12), Listed;
        /// Whether the time of day runs on by itself.
        ephemeris_enable: bool = Bits(4, 0, 1), Bits(4, 0, 1), Listed;
        /// Whether the sun shines.
        sun_enable: bool = Bits(4, 1, 1), Bits(4, 1, 1), Listed;
        /// Whether the moon shines.
        moon_enable: bool = Bits(4, 2, 1), Bits(4, 2, 1), Listed;
        /// Whether there are stars.
        star_enable: bool = Bits(4, 3, 1), Bits(4, 3, 1), Listed;
        /// Whether date and time count.
        date_time_valid: bool = Bits(4, 4, 1), Bits(4, 4, 1), Listed;
        /// Intensity of the stars, 0 to 100.
        star_intensity_percent: f32 = F32(12), F32(16), Listed;
    }
    /// The air outside of all layers.
    AtmosphereControl = "Atmosphere Control", [header(10, 32), header(0x0009, 32)] {
        /// Whether the radiance model of sensors is on.
        atmospheric_model_enable: bool = Bits(2, 0, 1), Bits(4, 7, 1), Listed;
        /// Relative humidity, 0 to 100.
        humidity_percent: u8 = U8(3), Bits(4, 0, 7), Listed;
        /// Temperature.
        air_temperature_c: f32 = F32(4), F32(8), Listed;
        /// Visibility.
        visibility_m: f32 = F32(8), F32(12), Listed;
        /// Horizontal speed of the wind.
        horizontal_wind_mps: f32 = F32(12), F32(16), Listed;
        /// Vertical speed of the wind, upward.
        vertical_wind_mps: f32 = F32(16), F32(20), Listed;
        /// Direction from which the wind blows, from true north.
        wind_from_deg: f32 = F32(20), F32(24), Listed;
        /// Pressure.
        pressure_hpa: f32 = F32(24), F32(28), Listed;
    }
    /// Shape of a region with an environment of its own.
    EnvironmentalRegionControl = "Environmental Region Control", [header(11, 48), header(0x000a, 48)] {
        /// Region.
        region_id: u16 = U16(2), U16(6), Listed;
        /// 0 inactive, 1 active, 2 destroyed.
        region_state: u8 = Bits(4, 0, 2), Bits(4, 0, 2), Listed;
        /// Weather of overlapping regions: 0 the last wins, 1 merged.
        merge_weather: u8 = Bits(4, 2, 1), Bits(4, 2, 1), Listed;
        /// Aerosol, likewise.
        merge_aerosol: u8 = Bits(4, 3, 1), Bits(4, 3, 1), Listed;
        /// Sea, likewise.
        merge_maritime: u8 = Bits(4, 4, 1), Bits(4, 4, 1), Listed;
        /// Ground, likewise.
        merge_terrestrial: u8 = Bits(4, 5, 1), Bits(4, 5, 1), Listed;
        /// Latitude of the centre.
        latitude_deg: f64 = F64(8), F64(8), Listed;
        /// Longitude of the centre.
        longitude_deg: f64 = F64(16), F64(16), Listed;
        /// Whole length along the rotation, without perimeter.
        size_x_m: f32 = F32(24), F32(24), Listed;
        /// Whole length across the rotation, without perimeter.
        size_y_m: f32 = F32(28), F32(28), Listed;
        /// Radius of the corners, at most half of the smaller size.
        corner_radius_m: f32 = F32(32), F32(32), Listed;
        /// Rotation clockwise from true north.
        rotation_deg: f32 = F32(36), F32(36), Listed;
        /// Width of the transition outside of the rectangle.
        transition_perimeter_m: f32 = F32(40), F32(40), Listed;
    }
    /// One layer of weather.
    WeatherControl = "Weather Control", [header(12, 56), header(0x000b, 72)] {
        /// 0 global, 1 regional, 2 of an entity.
        scope: u8 = Bits(7, 0, 2), Bits(7, 0, 2), Listed;
        /// Region or entity.
        entity_or_region_id: u16 = U16(2), U16(8), Listed;
        /// 0 ground fog, 1 to 3 cloud, 4 rain, 5 snow, 6 sleet, 7 hail, 8 sand, 9 dust, from 10 on the image
        /// generator's own.
        layer_id: u8 = U8(4), U8(4), Listed;
        /// Relative humidity, 0 to 100.
        humidity_percent: u8 = U8(5), U8(5), Listed;
        /// Whether the layer is on.
        weather_enable: bool = Bits(6, 0, 1), Bits(6, 0, 1), Listed;
        /// Whether there is scud, in 3.x.
        scud_enable: bool = Bits(6, 1, 1), Absent, Listed;
        /// Whether there is scud below the layer, in 4.0.
        bottom_scud_enable: bool = Absent, Bits(6, 1, 1), Listed;
        /// Whether there is scud above the layer, in 4.0.
        top_scud_enable: bool = Absent, Bits(7, 5, 1), Listed;
        /// Whether there are gusts.
        random_winds_enable: bool = Bits(6, 2, 1), Bits(6, 2, 1), Listed;
        /// Whether there is lightning.
        random_lightning_enable: bool = Bits(6, 3, 1), Bits(6, 3, 1), Listed;
        /// 0 none, 1 altocumulus, 2 altostratus, 3 cirrocumulus, 4 cirrostratus, 5 cirrus, 6 cumulonimbus, 7 cumulus,
        /// 8 nimbostratus, 9 stratocumulus, 10 stratus, from 11 on the image generator's own.
        cloud_type: u8 = Bits(6, 4, 4), Bits(6, 4, 4), Listed;
        /// 0 least to 5 most severe.
        severity: u8 = Bits(7, 2, 3), Bits(7, 2, 3), Listed;
        /// Temperature.
        air_temperature_c: f32 = F32(8), F32(12), Listed;
        /// Visibility through the layer.
        visibility_m: f32 = F32(12), F32(16), Listed;
        /// Amount of scud in 3.x, 0 to 100.
        scud_frequency_percent: f32 = F32(16), Absent, Listed;
        /// Width of the transition above and below the layer, in 3.x.
        transition_band_m: f32 = F32(32), Absent, Listed;
        /// Amount of scud below the layer in 4.0, 0 to 100.
        bottom_scud_frequency_percent: f32 = Absent, F32(20), Listed;
        /// Amount of scud above the layer in 4.0, 0 to 100.
        top_scud_frequency_percent: f32 = Absent, F32(60), Listed;
        /// Width of the transition below the layer, in 4.0.
        bottom_transition_m: f32 = Absent, F32(36), Listed;
        /// Width of the transition above the layer, in 4.0.
        top_transition_m: f32 = Absent, F32(64), Listed;
        /// Share of area, 0 to 100.
        coverage_percent: f32 = F32(20), F32(24), Listed;
        /// Base above mean sea level.
        base_elevation_m: f32 = F32(24), F32(28), Listed;
        /// Thickness.
        thickness_m: f32 = F32(28), F32(32), Listed;
        /// Horizontal speed of the wind.
        horizontal_wind_mps: f32 = F32(36), F32(40), Listed;
        /// Vertical speed of the wind, upward.
        vertical_wind_mps: f32 = F32(40), F32(44), Listed;
        /// Direction from which the wind blows, any angle.
        wind_from_deg: f32 = F32(44), F32(48), Listed;
        /// Pressure.
        pressure_hpa: f32 = F32(48), F32(52), Listed;
        /// Concentration of particles, g/m^3.
        aerosol_g_m3: f32 = F32(52), F32(56), Listed;
    }
    /// State of the sea's surface.
    MaritimeSurfaceConditionsControl = "Maritime Surface Conditions Control", [header(13, 24), header(0x000c, 24)] {
        /// 0 global, 1 regional, 2 of an entity.
        scope: u8 = Bits(4, 2, 2), Bits(4, 2, 2), Listed;
        /// Region or entity. The class library 4.0 writes it one byte too early.
        entity_or_region_id: u16 = U16(2), U16(6), Listed;
        /// Whether the region or entity has a sea of its own; ignored for the global sea.
        surface_conditions_enable: bool = Bits(4, 0, 1), Bits(4, 0, 1), Listed;
        /// Whether there are whitecaps.
        whitecap_enable: bool = Bits(4, 1, 1), Bits(4, 1, 1), Listed;
        /// Height of the sea at rest above mean sea level.
        sea_surface_height_m: f32 = F32(8), F32(8), Listed;
        /// Temperature of the water.
        water_temperature_c: f32 = F32(12), F32(12), Listed;
        /// 0 turbid to 100 clear.
        clarity_percent: f32 = F32(16), F32(16), Listed;
    }
    /// One train of waves.
    WaveControl = "Wave Control", [header(14, 32), header(0x000d, 32)] {
        /// 0 global, 1 regional, 2 of an entity.
        scope: u8 = Bits(5, 1, 2), Bits(5, 1, 2), Listed;
        /// Region or entity.
        entity_or_region_id: u16 = U16(2), U16(6), Listed;
        /// Wave.
        wave_id: u8 = U8(4), U8(4), Listed;
        /// Whether the wave is on.
        wave_enable: bool = Bits(5, 0, 1), Bits(5, 0, 1), Listed;
        /// 0 plunging, 1 spilling, 2 surging.
        breaker_type: u8 = Bits(5, 3, 2), Bits(5, 3, 2), Listed;
        /// Height from trough to crest.
        wave_height_m: f32 = F32(8), F32(8), Listed;
        /// Length.
        wavelength_m: f32 = F32(12), F32(12), Listed;
        /// Period.
        period_s: f32 = F32(16), F32(16), Listed;
        /// Direction in which the wave travels.
        direction_to_deg: f32 = F32(20), F32(20), Listed;
        /// Phase.
        phase_offset_deg: f32 = F32(24), F32(24), Listed;
        /// Lean of the crest: 0 is a sine.
        leading_deg: f32 = F32(28), F32(28), Listed;
    }
    /// One condition of the ground.
    TerrestrialSurfaceConditionsControl =
        "Terrestrial Surface Conditions Control", [header(15, 8), header(0x000e, 16)]
    {
        /// 0 global, 1 regional, 2 of an entity.
        scope: u8 = Bits(6, 1, 2), Bits(6, 1, 2), Listed;
        /// Region or entity.
        entity_or_region_id: u16 = U16(2), U16(4), Listed;
        /// Condition: 0 is dry and removes all others of the scope; others are the image generator's own.
        surface_condition_id: u16 = U16(4), U16(8), Listed;
        /// Whether the condition is on.
        surface_condition_enable: bool = Bits(6, 0, 1), Bits(6, 0, 1), Listed;
        /// 0 to 31, impassable.
        severity: u8 = Bits(6, 3, 5), Bits(6, 3, 5), Listed;
        /// Share of area, 0 to 100.
        coverage_percent: u8 = U8(7), U8(7), Listed;
    }
    /// Question about the environment at a place.
    EnvironmentalConditionsRequest = "Environmental Conditions Request", [header(28, 32), header(0x001b, 32)] {
        /// Sum of 1 maritime, 2 terrestrial, 4 weather, 8 aerosol.
        request_type_bits: u8 = Bits(2, 0, 4), Bits(4, 0, 4), Listed;
        /// Number that each answer repeats.
        request_id: u8 = U8(3), U8(5), Listed;
        /// Latitude.
        latitude_deg: f64 = F64(8), F64(8), Listed;
        /// Longitude.
        longitude_deg: f64 = F64(16), F64(16), Listed;
        /// Altitude.
        altitude_m: f64 = F64(24), F64(24), Listed;
    }
    /// Weather at a place.
    WeatherConditionsResponse = "Weather Conditions Response", [header(109, 32), header(0x0ff8, 32)] {
        /// Number of the request.
        request_id: u8 = U8(2), U8(4), Listed;
        /// Relative humidity, 0 to 100.
        humidity_percent: u8 = U8(3), U8(5), Listed;
        /// Temperature.
        air_temperature_c: f32 = F32(4), F32(8), Listed;
        /// Visibility.
        visibility_m: f32 = F32(8), F32(12), Listed;
        /// Horizontal speed of the wind.
        horizontal_wind_mps: f32 = F32(12), F32(16), Listed;
        /// Vertical speed of the wind, upward.
        vertical_wind_mps: f32 = F32(16), F32(20), Listed;
        /// Direction from which the wind blows.
        wind_from_deg: f32 = F32(20), F32(24), Listed;
        /// Pressure.
        pressure_hpa: f32 = F32(24), F32(28), Listed;
    }
    /// Particles of one layer at a place.
    AerosolConcentrationResponse = "Aerosol Concentration Response", [header(110, 8), header(0x0ff7, 16)] {
        /// Number of the request.
        request_id: u8 = U8(2), U8(4), Listed;
        /// Layer.
        layer_id: u8 = U8(3), U8(5), Listed;
        /// Concentration, g/m^3.
        aerosol_g_m3: f32 = F32(4), F32(8), Listed;
    }
    /// Sea at a place.
    MaritimeSurfaceConditionsResponse = "Maritime Surface Conditions Response", [header(111, 16), header(0x0ff6, 24)] {
        /// Number of the request.
        request_id: u8 = U8(2), U8(4), Listed;
        /// Height of the sea at rest above mean sea level.
        sea_surface_height_m: f32 = F32(4), F32(8), Listed;
        /// Temperature of the water.
        water_temperature_c: f32 = F32(8), F32(12), Listed;
        /// 0 turbid to 100 clear.
        clarity_percent: f32 = F32(12), F32(16), Listed;
    }
    /// One condition of the ground at a place.
    TerrestrialSurfaceConditionsResponse =
        "Terrestrial Surface Conditions Response", [header(112, 8), header(0x0ff5, 16)]
    {
        /// Number of the request.
        request_id: u8 = U8(2), U8(4), Listed;
        /// Condition.
        surface_condition_id: u32 = U32(4), U32(8), Listed;
    }
    /// Command to a part of an object, with six words of data.
    ComponentControl = "Component Control", [header(4, 32), header(0x0003, 40)] {
        /// 0 entity, 1 view, 2 view group, 3 sensor, 4 regional sea, 5 regional ground, 6 regional weather, 7 global
        /// sea, 8 global ground, 9 global weather, 10 atmosphere, 11 celestial sphere, 12 event, 13 system, 14 symbol
        /// surface, 15 symbol.
        component_class: u8 = Bits(6, 0, 6), Bits(6, 0, 4), Listed;
        /// Object, by class.
        instance_id: u16 = U16(4), U16(8), Listed;
        /// Component of the image generator's list.
        component_id: u16 = U16(2), U16(4), Listed;
        /// State of the image generator's list.
        component_state: u8 = U8(7), U8(7), Listed;
        /// First word, as a float.
        data0_as_f32: f32 = F32(8), F32(16), Listed;
        /// Second word.
        data1_as_u32: u32 = U32(12), U32(20), Listed;
        /// Third word.
        data2: u32 = U32(16), U32(24), Unlisted;
        /// Fourth word.
        data3: u32 = U32(20), U32(28), Unlisted;
        /// Fifth word.
        data4: u32 = U32(24), U32(32), Unlisted;
        /// Sixth word.
        data5: u32 = U32(28), U32(36), Unlisted;
    }
    /// Command to a part of an object, with two words of data.
    ShortComponentControl = "Short Component Control", [header(5, 16), header(0x0004, 24)] {
        /// Class, as in [`ComponentControl`].
        component_class: u8 = Bits(6, 0, 6), Bits(6, 0, 4), Listed;
        /// Object, by class.
        instance_id: u16 = U16(4), U16(8), Listed;
        /// Component of the image generator's list.
        component_id: u16 = U16(2), U16(4), Listed;
        /// State of the image generator's list.
        component_state: u8 = U8(7), U8(7), Listed;
        /// First word, as a float.
        data0_as_f32: f32 = F32(8), F32(16), Listed;
        /// Second word.
        data1_as_u32: u32 = U32(12), U32(20), Listed;
    }
    /// Place of a part of an entity.
    ArticulatedPartControl = "Articulated Part Control", [header(6, 32), header(0x0005, 32)] {
        /// Entity.
        entity_id: u16 = U16(2), U16(4), Listed;
        /// Part.
        part_id: u8 = U8(4), U8(6), Listed;
        /// 1 part shown, 2 x, 4 y, 8 z, 16 roll, 32 pitch, 64 yaw.
        enable_bits: u8 = Bits(5, 0, 7), Bits(7, 0, 7), Listed;
        /// Forward.
        x_offset_m: f32 = F32(8), F32(8), Listed;
        /// Right.
        y_offset_m: f32 = F32(12), F32(12), Listed;
        /// Down.
        z_offset_m: f32 = F32(16), F32(16), Listed;
        /// Roll.
        roll_deg: f32 = F32(20), F32(20), Listed;
        /// Pitch.
        pitch_deg: f32 = F32(24), F32(24), Listed;
        /// Yaw.
        yaw_deg: f32 = F32(28), F32(28), Listed;
    }
    /// One degree of freedom of each of two parts of an entity.
    ShortArticulatedPartControl = "Short Articulated Part Control", [header(7, 16), header(0x0006, 24)] {
        /// Entity.
        entity_id: u16 = U16(2), U16(4), Listed;
        /// First part.
        part1_id: u8 = U8(4), U8(6), Listed;
        /// Second part.
        part2_id: u8 = U8(5), U8(7), Listed;
        /// 0 none, 1 x, 2 y, 3 z, 4 yaw, 5 pitch, 6 roll.
        dof1_select: u8 = Bits(6, 0, 3), Bits(8, 0, 3), Listed;
        /// Second degree of freedom, likewise.
        dof2_select: u8 = Bits(6, 3, 3), Bits(8, 3, 3), Listed;
        /// Whether the first part is shown.
        part1_enable: bool = Bits(6, 6, 1), Bits(8, 6, 1), Listed;
        /// Whether the second part is shown.
        part2_enable: bool = Bits(6, 7, 1), Bits(8, 7, 1), Listed;
        /// Value of the first, m or degrees.
        dof1: f32 = F32(8), F32(12), Listed;
        /// Value of the second, m or degrees.
        dof2: f32 = F32(12), F32(16), Listed;
    }
    /// Velocities of an entity or of a part of it.
    RateControl = "Rate Control" or "Velocity Control", [header(8, 32), header(0x0007, 32)] {
        /// Entity.
        entity_id: u16 = U16(2), U16(4), Listed;
        /// Part.
        part_id: u8 = U8(4), U8(6), Listed;
        /// Whether the velocities are those of the part.
        apply_to_part: bool = Bits(5, 0, 1), Bits(7, 0, 1), Listed;
        /// 0 the world's or the parent's axes, 1 the entity's own.
        coordinate_system: u8 = Bits(5, 1, 1), Bits(7, 1, 1), Listed;
        /// Velocity forward or north, m/s.
        x_mps: f32 = F32(8), F32(8), Listed;
        /// Velocity right or east, m/s.
        y_mps: f32 = F32(12), F32(12), Listed;
        /// Velocity down, m/s.
        z_mps: f32 = F32(16), F32(16), Listed;
        /// Roll a second.
        roll_dps: f32 = F32(20), F32(20), Listed;
        /// Pitch a second.
        pitch_dps: f32 = F32(24), F32(24), Listed;
        /// Yaw a second.
        yaw_dps: f32 = F32(28), F32(28), Listed;
    }
    /// Question about the height of the ground under a place.
    HatHotRequest = "HAT/HOT Request", [header(24, 32), header(0x0017, 40)], child if coordinate_system {
        /// Number that the answer repeats.
        hat_hot_id: u16 = U16(2), U16(4), Listed;
        /// 0 height above terrain, 1 height of terrain, 2 both with the material and the normal.
        request_type: u8 = Bits(4, 0, 2), Bits(8, 0, 2), Listed;
        /// 0 geodetic, 1 an entity's axes.
        coordinate_system: u8 = Bits(4, 2, 1), Bits(8, 2, 1), Listed;
        /// Frames between answers; 0 for one answer.
        update_period: u8 = U8(5), U8(9), Listed;
        /// Entity whose axes count.
        entity_id: u16 = U16(6), U16(6), Listed;
        /// Latitude.
        latitude_deg: f64 = F64(8), F64(16), Top;
        /// Longitude.
        longitude_deg: f64 = F64(16), F64(24), Top;
        /// Altitude.
        altitude_m: f64 = F64(24), F64(32), Top;
        /// Forward.
        x_offset_m: f64 = F64(8), F64(16), Child;
        /// Right.
        y_offset_m: f64 = F64(16), F64(24), Child;
        /// Down.
        z_offset_m: f64 = F64(24), F64(32), Child;
    }
    /// Height above the ground or of the ground.
    HatHotResponse = "HAT/HOT Response", [header(102, 16), header(0x0fff, 16)] {
        /// Number of the request.
        hat_hot_id: u16 = U16(2), U16(6), Listed;
        /// Whether the height is known.
        valid: bool = Bits(4, 0, 1), Bits(4, 0, 1), Listed;
        /// 0 height above terrain, 1 height of terrain.
        response_type: u8 = Bits(4, 1, 1), Bits(4, 1, 1), Listed;
        /// Lowest four bits of the host's frame number.
        host_frame_number_lsn: u8 = Bits(4, 4, 4), Bits(4, 4, 4), Listed;
        /// Height.
        height_m: f64 = F64(8), F64(8), Listed;
    }
    /// Heights above the ground and of the ground, with its normal.
    HatHotExtendedResponse = "HAT/HOT Extended Response", [header(103, 40), header(0x0ffe, 40)] {
        /// Number of the request.
        hat_hot_id: u16 = U16(2), U16(6), Listed;
        /// Whether the heights are known.
        valid: bool = Bits(4, 0, 1), Bits(4, 0, 1), Listed;
        /// Lowest four bits of the host's frame number.
        host_frame_number_lsn: u8 = Bits(4, 4, 4), Bits(4, 4, 4), Listed;
        /// Height above terrain.
        hat_m: f64 = F64(8), F64(8), Listed;
        /// Height of terrain.
        hot_m: f64 = F64(16), F64(16), Listed;
        /// Material of the image generator's list.
        material_code: u32 = U32(24), U32(24), Listed;
        /// Azimuth of the ground's normal from true north.
        normal_azimuth_deg: f32 = F32(28), F32(28), Listed;
        /// Elevation of the ground's normal.
        normal_elevation_deg: f32 = F32(32), F32(32), Listed;
    }
}
