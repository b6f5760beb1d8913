//! Queries of a host: the flashes near a place, the time of their thunder, and the light that arrives.

use glam::DVec3;

use super::{
    channel::sound_m_s,
    flash::{Flash, FlashKind},
    held::HeldLightning,
    light::{COLOR, Course, Span},
    storms::Storms,
    strike::Strike,
    trigger::FlashTrigger,
};
use crate::{
    error::{Result, check_range},
    world::World,
};

/// Longest interval of time of one query, s.
pub const MOST_SPAN_S: f64 = 3600.0;
/// Largest distance for which flashes can be queried, m.
pub const MOST_DISTANCE_M: f64 = 50_000.0;
/// Largest horizontal distance of flashes whose light is included, m.
pub(crate) const LIGHT_REACH_M: f64 = 30_000.0;
/// Longest exposure over which light is averaged, s.
pub const MOST_EXPOSURE_S: f64 = 1.0;
/// Share of the extinction that is taken as loss of light: light scattered by droplets goes on nearly straight
/// (asymmetry 0.8).
pub(crate) const TAKES: f64 = 0.2;

/// A flash as seen and heard from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlashEvent {
    /// Unique number among the flashes of the context.
    pub id: u64,
    /// Time of its first stroke, s of simulation time.
    pub time_s: f64,
    /// Kind of the flash.
    pub kind: FlashKind,
    /// Number of strokes, or of steps of the light for a flash in the cloud.
    pub strokes: u32,
    /// Largest peak current of its strokes, kA.
    pub peak_ka: f64,
    /// Position that it struck, or the middle of its path in the cloud, in the host's world, m.
    pub position: DVec3,
    /// Distance from the place to the nearest point of the flash's channel, m.
    pub distance_m: f64,
    /// Direction from the place to `position`, unit vector (east, north, up).
    pub direction: DVec3,
    /// Time from the flash to the beginning of its thunder at the place, s.
    pub thunder_delay_s: f64,
}

/// Light of flashes at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightningLight {
    /// Sum of the illuminances on surfaces that each face one source, lux for red, green and blue of linear Rec. 709.
    pub facing_lux: [f64; 3],
    /// Illuminance on level ground, lux.
    pub level_lux: f64,
    /// Unit vector (east, north, up) towards the mean direction of the light; straight up without light.
    pub direction: DVec3,
}

/// Returns all flashes from `from_s` until `until_s` within the horizontal distance `most_m` of a place, in order of
/// time.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming an argument that is out of range.
pub(crate) fn events(
    world: &World,
    held: &HeldLightning,
    position: DVec3,
    (from_s, until_s): (f64, f64),
    most_m: f64,
) -> Result<Vec<FlashEvent>> {
    let local = world.frame.place_at("position", position)?;
    check_range("from_s", from_s, -1e10, 1e10, "s")?;
    check_range("until_s", until_s, from_s, from_s + MOST_SPAN_S, "s")?;
    check_range("most_distance_m", most_m, 0.0, MOST_DISTANCE_M, "m")?;
    let storms = Storms { world, held };
    let mut found: Vec<(Flash, Option<FlashTrigger>)> = Vec::new();
    storms.visit((storms.on_map(position), most_m), (from_s, until_s), |flash, by| found.push((*flash, by.copied())));
    found.sort_by(|a, b| a.0.time_s.total_cmp(&b.0.time_s).then(a.0.id.cmp(&b.0.id)));
    let event = |(flash, by): &(Flash, Option<FlashTrigger>)| {
        let strike = Strike::new(world, &held.settings.masts, *flash, by.map(|t| t.position));
        let distance_m = strike.channel.distance_m(position);
        FlashEvent {
            id: flash.id,
            time_s: flash.time_s,
            kind: flash.kind,
            strokes: flash.strokes().len() as u32,
            peak_ka: flash.peak_ka(),
            position: strike.position(),
            distance_m,
            direction: (local.world_to_enu * (strike.position() - position)).normalize_or(DVec3::Z),
            thunder_delay_s: distance_m / sound_m_s(strike.temperature_c),
        }
    };
    Ok(found.iter().map(event).collect())
}

/// Returns the light of flashes at a place, averaged over `exposure_s` before `time_s`; with 0, the light at `time_s`.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming an argument that is out of range.
pub(crate) fn light_at(
    world: &World,
    held: &HeldLightning,
    position: DVec3,
    time_s: f64,
    exposure_s: f64,
) -> Result<LightningLight> {
    let local = world.frame.place_at("position", position)?;
    check_range("time_s", time_s, -1e10, 1e10, "s")?;
    check_range("exposure_s", exposure_s, 0.0, MOST_EXPOSURE_S, "s")?;
    let storms = Storms { world, held };
    let span = Span { from_s: time_s - exposure_s, until_s: time_s };
    let extinction_per_m = world.over().weather_at(position, time_s).extinction_per_m;
    let (mut sum, mut level, mut towards) = (0.0, 0.0, DVec3::ZERO);
    let begin = Storms::begin_within(span.from_s, span.until_s);
    storms.visit((storms.on_map(position), LIGHT_REACH_M), begin, |flash, by| {
        if !Course::Natural.shines(flash, &span) {
            return;
        }
        let strike = Strike::new(world, &held.settings.masts, *flash, by.map(|t| t.position));
        for source in strike.sources(&span, Course::Natural).iter() {
            let way = local.world_to_enu * (source.position - position);
            let lux = source.intensity_cd(-way) * (-TAKES * extinction_per_m * way.length()).exp()
                / way.length_squared().max(1.0);
            let to = way.normalize_or(DVec3::Z);
            (sum, level, towards) = (sum + lux, level + lux * to.z.max(0.0), towards + to * lux);
        }
    });
    Ok(LightningLight {
        facing_lux: COLOR.map(|c| c * sum),
        level_lux: level,
        direction: towards.normalize_or(DVec3::Z),
    })
}
