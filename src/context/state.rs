//! Saving a context and taking it up again, and a number by which channels compare theirs.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{Context, GivenDirection, GroundModel, areas::KeptArea, ground::GroundState, terrain_saved::SavedGround};
use crate::{
    error::{Error, Result, Status, check_range},
    ground::SurfaceClass,
    rain::MAX_AREAS,
    sky::sun::Utc,
    weather::Timeline,
    wind::Drift,
};

const VERSION: u32 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    version: u32,
    time_s: f64,
    utc_at_zero: f64,
    seed: String,
    planet: String,
    sun: Option<[f64; 2]>,
    moon: Option<[f64; 2]>,
    timeline: String,
    /// How far the wind had carried the air when the last forgotten change ended: time, path, east, north.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    drifted: Option<[f64; 4]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    ground: Option<GroundState>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    areas: Vec<KeptArea>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    terrain: Option<SavedGround>,
    /// Number of the class of ground of which nothing else is said.
    #[serde(default, skip_serializing_if = "is_unspecified")]
    surface_class: u8,
}

/// Whether a number is that of no class.
fn is_unspecified(class: &u8) -> bool {
    *class == SurfaceClass::Unspecified as u8
}

/// Where counting goes on: at the end of what `timeline` has forgotten. States written before there was a drift begin there
/// anew.
fn drifted_from(saved: Option<[f64; 4]>, timeline: &Timeline) -> std::result::Result<Drift, &'static str> {
    let Some([time_s, path_m, east, north]) = saved else {
        let forgotten = timeline.known_from_s();
        return Ok(if timeline.known_since_ever() { Drift::ZERO } else { Drift { time_s: forgotten, ..Drift::ZERO } });
    };
    let sound = [path_m, east, north].iter().all(|v| v.is_finite()) && time_s == timeline.known_from_s();
    let drift = Drift { time_s, path_m, displacement_m: DVec2::new(east, north) };
    sound.then_some(drift).ok_or("drifted must be finite and belong to the end of what the timeline has forgotten")
}

impl Context {
    fn saved(&self) -> Result<String> {
        let angles = |g: Option<GivenDirection>| g.map(|g| [g.azimuth_deg, g.elevation_deg]);
        let drifted = self.drifted();
        let saved = Saved {
            version: VERSION,
            time_s: self.time_s,
            utc_at_zero: self.desc.utc_at_zero.0,
            seed: self.desc.seed.to_string(),
            planet: format!("{:016x}", self.desc.planet.hash()),
            sun: angles(self.given_sun),
            moon: angles(self.given_moon),
            timeline: self.timeline.save()?,
            drifted: (drifted != Drift::ZERO).then(|| {
                let d = drifted.displacement_m;
                [drifted.time_s, drifted.path_m, d.x, d.y]
            }),
            ground: self.ground,
            areas: self.areas.clone(),
            terrain: self.host_ground.as_deref().map(SavedGround::of),
            surface_class: self.surface_class as u8,
        };
        toml::to_string(&saved).map_err(|e| Error::new(Status::Internal, format!("the state cannot be written: {e}")))
    }

    /// Everything that decides what this context shows from now on, as UTF-8 text.
    ///
    /// # Errors
    /// [`Status::Internal`] if a number cannot be written.
    pub fn save(&self) -> Result<Vec<u8>> {
        Ok(self.saved()?.into_bytes())
    }

    /// Takes up a state that [`Context::save`] wrote, on a context of the same planet, seed and ground model.
    ///
    /// # Errors
    /// [`Status::Parse`] for bytes that are no such state, cut short, or of another version;
    /// [`Status::InvalidArgument`] if planet or seed differ. The context stays as it was.
    pub fn load(&mut self, bytes: &[u8]) -> Result<()> {
        let parse = |e: &dyn std::fmt::Display| Error::new(Status::Parse, format!("saved state: {e}"));
        let text = std::str::from_utf8(bytes).map_err(|e| parse(&e))?;
        let saved: Saved = toml::from_str(text).map_err(|e| parse(&e))?;
        if saved.version != VERSION {
            return Err(parse(&format!("version must be {VERSION}, got {}", saved.version)));
        }
        let planet = format!("{:016x}", self.desc.planet.hash());
        if saved.planet != planet || saved.seed != self.desc.seed.to_string() {
            return Err(Error::range(
                "state",
                &format!("of planet {planet} and seed {}", self.desc.seed),
                format!("planet {} and seed {}", saved.planet, saved.seed),
            ));
        }
        let given = |name: &str, a: Option<[f64; 2]>| -> Result<Option<GivenDirection>> {
            let given = a.map(|[azimuth_deg, elevation_deg]| GivenDirection { azimuth_deg, elevation_deg });
            given.map_or(Ok(()), |g| g.validate(name))?;
            Ok(given)
        };
        check_range("time_s", saved.time_s, -super::MAX_TIME_S, super::MAX_TIME_S, "s")?;
        crate::sky::sun::sun_position(Utc(saved.utc_at_zero), &self.desc.world.origin)?;
        let (sun, moon) = (given("sun", saved.sun)?, given("moon", saved.moon)?);
        if saved.ground.is_some() && self.desc.ground == GroundModel::Reported {
            return Err(Error::range(
                "state",
                "of a context whose ground is as reported",
                "one whose ground is simulated",
            ));
        }
        if saved.ground.is_some_and(|g| !g.is_valid()) {
            return Err(parse(&"ground must have finite amounts of water from 0 on"));
        }
        if saved.areas.len() > MAX_AREAS || !saved.areas.iter().all(KeptArea::is_valid) {
            return Err(parse(&"areas must be as they can be set"));
        }
        let terrain = saved.terrain.as_ref().map(|t| {
            let of_a_state = self.desc.ground == GroundModel::Simulated && saved.ground.is_some();
            let loaded = t.host_ground(&self.desc.world).filter(|held| of_a_state || !held.begun);
            loaded.ok_or_else(|| parse(&"terrain must be a grid of heights and the water that it can hold"))
        });
        let terrain = terrain.transpose()?;
        let surface_class = SurfaceClass::from_number("saved state: surface_class", saved.surface_class);
        let surface_class = surface_class.map_err(|e| Error::new(Status::Parse, e.message))?;
        let timeline = Timeline::load(&saved.timeline)?;
        let drifted = drifted_from(saved.drifted, &timeline).map_err(|e| parse(&e))?;
        (self.timeline, self.drifted) = (timeline, drifted);
        self.ground = saved.ground;
        self.areas = saved.areas;
        self.surface_class = surface_class;
        (self.given_sun, self.given_moon) = (sun, moon);
        self.time_s = saved.time_s;
        self.desc.utc_at_zero = Utc(saved.utc_at_zero);
        self.take_up_terrain(terrain)
    }

    /// A number that is equal on two channels whose contexts show the same world from now on (FNV-1a of the saved
    /// state).
    ///
    /// # Errors
    /// As [`Context::save`].
    pub fn state_hash(&self) -> Result<u64> {
        let fold = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        Ok(self.saved()?.as_bytes().iter().fold(0xcbf2_9ce4_8422_2325, fold))
    }
}
