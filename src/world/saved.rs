//! Saved state of a world, and loading it.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{
    color::color_columns,
    saved_settings::{SavedSettings, SetBeside},
    settings::{GivenDirection, Settings},
    state::{World, next_revision},
};
use crate::{
    almanac::sun::{Utc, sun_position},
    error::{Error, Result, Status, beginning, check_range, shown},
    moment::Region,
    regions::HeldRegion,
    scene::{Figure, WorldKind},
    weather::{Timeline, timeline::MAX_TIME_S},
    wind::{Drift, LayerDrift, LayerDrifts},
};

/// Maximum length of a message about a faulty state, characters.
const MOST_FAULT: usize = 200;

/// Saved state of a world.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SavedWorld {
    time_s: f64,
    /// Unix time at simulation time 0, s.
    utc_at_zero: f64,
    /// Azimuth and elevation of the sun and of the moon, degrees, if the host has set them.
    sun: Option<[f64; 2]>,
    moon: Option<[f64; 2]>,
    timeline: String,
    /// Drift of the air at the end of the last forgotten change: time, s; length of its path, m; displacement east and
    /// north, m.
    drifted: [f64; 4],
    /// Drifts of the cloud layers at the time of `drifted`, one for each slot of a layer: way east and north, in units
    /// of the distance between clouds, and number of lives of clouds since time 0. Empty if no change has been
    /// forgotten.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    layers_drifted: Vec<[f64; 3]>,
    /// Values that the context's description fixed.
    created: toml::Table,
    settings: SavedSettings,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    areas: Vec<Region>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    weather_regions: Vec<HeldRegion>,
}

/// Creates the error for a faulty saved state. The message is cut, because a forged state could make it long.
pub(crate) fn parse_error(what: impl std::fmt::Display) -> Error {
    let what = what.to_string();
    let line = what.lines().collect::<Vec<_>>().join(" ");
    Error::new(Status::Parse, format!("saved state: {}", beginning(&line, MOST_FAULT)))
}

/// Checks that a state belongs to a context created from the same description; the error names each value that differs.
fn check_created(saved: &toml::Table, here: &toml::Table) -> Result<()> {
    let names = here.keys().chain(saved.keys().filter(|name| !here.contains_key(*name)));
    let value = |v: Option<&toml::Value>| beginning(&v.map_or("nothing".into(), ToString::to_string), 40).into_owned();
    let other = names.filter(|name| saved.get(*name) != here.get(*name)).map(|name| {
        format!("{} ({} in the state, {} here)", shown(name), value(saved.get(name)), value(here.get(name)))
    });
    let other: Vec<String> = other.collect();
    if other.is_empty() {
        return Ok(());
    }
    let other = other.join(", ");
    let other = beginning(&other, MOST_FAULT);
    Err(Error::invalid("state", format!("must be of a context that was created alike; other is {other}")))
}

/// Checks and returns the saved drift, which belongs to the end of the last change that `timeline` has forgotten.
fn drifted_from([time_s, path_m, east, north]: [f64; 4], timeline: &Timeline) -> Result<Drift> {
    let drift = Drift { time_s, path_m, displacement_m: DVec2::new(east, north) };
    let since_ever = timeline.known_since_ever() && drift == Drift::ZERO;
    let finite = [path_m, east, north].iter().all(|v| v.is_finite());
    let sound = since_ever || (finite && time_s == timeline.known_from_s());
    let wanted = "drifted must be finite and belong to the end of what the timeline has forgotten";
    sound.then_some(drift).ok_or_else(|| parse_error(wanted))
}

/// Reads the drifts of the cloud layers. Older states have none: their clouds are placed as at time 0.
fn layers_drifted_from(saved: &[[f64; 3]], time_s: f64) -> Result<LayerDrifts> {
    let mut drifts = LayerDrifts { time_s, ..LayerDrifts::ZERO };
    let fits = saved.is_empty() || saved.len() == drifts.slots.len();
    if !fits || !saved.as_flattened().iter().all(|v| v.is_finite()) {
        return Err(parse_error("layers_drifted must be finite, one of each of 16 layers"));
    }
    for (to, [east, north, lives]) in drifts.slots.iter_mut().zip(saved) {
        *to = LayerDrift { way: DVec2::new(*east, *north), lives: *lives };
    }
    Ok(drifts)
}

/// Returns the drifts of the cloud layers as numbers; none if no change has been forgotten, as all drifts are then 0.
fn saved_layers(drifts: &LayerDrifts) -> Vec<[f64; 3]> {
    if *drifts == LayerDrifts::ZERO {
        return Vec::new();
    }
    drifts.slots.iter().map(|d| [d.way.x, d.way.y, d.lives]).collect()
}

/// A saved world that has been read and checked.
pub(crate) struct LoadedWorld {
    time_s: f64,
    timeline: Timeline,
    drifted: Drift,
    layers_drifted: LayerDrifts,
    set: Settings,
    beside: SetBeside,
}

impl World {
    /// Returns the values that this world's description fixes and that affect its results, under the names of the C
    /// header.
    pub fn created(&self) -> toml::Table {
        // Every field is named: a new one must be added here or to the saved state, unless it follows from the rest.
        let Self {
            frame,
            seed,
            tone: _,
            exposure: _,
            timeline: _,
            timeline_revision: _,
            wind: _,
            drifted: _,
            layers_drifted: _,
            set: _,
            maps: _,
            lights: _,
            // The effect that solves the wind saves it; the other two are caches.
            solved_wind: _,
            wind_texture: _,
            detours: _,
            time_s: _,
            ephemeris: _,
            couplings: _,
            // The effects of the night sky, the snow and the soil save these.
            night: _,
            snow: _,
            dug: _,
            surroundings_revision: _,
            regions_revision: _,
        } = self;
        let mut table = toml::Table::new();
        let mut put = |name: &str, value: toml::Value| table.insert(name.into(), value);
        put("world_kind", format!("{:?}", frame.kind).into());
        // 0 and -0 are the same place.
        put("latitude_deg", (frame.origin.latitude_deg + 0.0).into());
        put("longitude_deg", (frame.origin.longitude_deg + 0.0).into());
        put("altitude_m", (frame.origin.altitude_m + 0.0).into());
        if frame.kind != WorldKind::Ecef {
            put("axes", format!("{:?}", frame.axes).into());
            put("grid_bearing_deg", (frame.grid_bearing_deg + 0.0).into());
        } else if frame.geoid_height_m != 0.0 {
            // Earlier states have none: their sea level was the ellipsoid.
            put("geoid_height_m", frame.geoid_height_m.into());
        }
        put("seed", seed.to_string().into());
        table
    }

    /// Returns the values that the description fixed in earlier versions and that are settings now. An old state has
    /// them among its fixed values; they are then compared, not restored.
    fn fixed_before(&self) -> [(&'static str, toml::Value); 2] {
        let planet = format!("hash {:016x}", self.set.planet.hash());
        [("planet_toml", planet.into()), ("tone_curve", format!("{:?}", self.tone).into())]
    }

    /// Returns the saved state: weather, time, clock, lights, surroundings, and the fixed values `created`.
    ///
    /// # Errors
    /// [`Status::Internal`] if a number cannot be written.
    pub fn saved(&self, created: toml::Table) -> Result<SavedWorld> {
        // Every field is named: one that affects results must be saved, unless it follows from the rest.
        let Settings {
            shelters,
            terrain: _,
            tiles: _,
            regions,
            weather_regions,
            cloud_map,
            host_wind,
            given_sun,
            given_moon,
            utc_at_zero,
            undimmed: _,
            planet,
            color: _,
        } = &self.set;
        let angles = |g: &Option<GivenDirection>| g.map(|g| [g.azimuth_deg, g.elevation_deg]);
        let (drifted, carried) = (&self.drifted, self.drifted.displacement_m);
        let mut settings =
            SavedSettings::of(self.exposure, shelters, &self.lights, host_wind.as_ref().map(|w| &*w.grid));
        (settings.tone_curve, settings.planet) = (Some(self.tone), Some(*planet));
        settings.set_cloud_map(cloud_map.as_deref());
        Ok(SavedWorld {
            time_s: self.time_s,
            utc_at_zero: utc_at_zero.0,
            sun: angles(given_sun),
            moon: angles(given_moon),
            timeline: self.timeline.save()?,
            drifted: [drifted.time_s, drifted.path_m, carried.x, carried.y],
            layers_drifted: saved_layers(&self.layers_drifted),
            created,
            settings,
            areas: regions.clone(),
            weather_regions: weather_regions.clone(),
        })
    }

    /// Reads a saved world and checks that it fits this one, whose fixed values are `created`.
    ///
    /// # Errors
    /// [`Status::Parse`] or [`Status::InvalidArgument`], naming the value that does not fit.
    pub fn read(&self, saved: SavedWorld, created: &toml::Table) -> Result<LoadedWorld> {
        let mut here = created.clone();
        let before = self.fixed_before().into_iter().filter(|(name, _)| saved.created.contains_key(*name));
        here.extend(before.map(|(name, value)| (name.into(), value)));
        check_created(&saved.created, &here)?;
        let given = |name: &str, a: Option<[f64; 2]>| -> Result<Option<GivenDirection>> {
            let given = a.map(|[azimuth_deg, elevation_deg]| GivenDirection { azimuth_deg, elevation_deg });
            given.map_or(Ok(()), |g| g.validate(name))?;
            Ok(given)
        };
        check_range("time_s", saved.time_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        let utc_at_zero = Utc(saved.utc_at_zero);
        sun_position(utc_at_zero, &self.frame.origin)?;
        let (given_sun, given_moon) = (given("sun", saved.sun)?, given("moon", saved.moon)?);
        let timeline = Timeline::load(&saved.timeline)?;
        if !self.are_valid(&saved.areas, &timeline) {
            return Err(parse_error("areas must be as they can be set"));
        }
        if !self.are_valid_weathers(&saved.weather_regions) {
            return Err(parse_error("weather_regions must be as they can be set"));
        }
        let mut beside = saved.settings.checked().map_err(|e| e.found_in("saved state"))?;
        let shelters = std::mem::take(&mut beside.shelters);
        let planet = beside.planet.unwrap_or(self.set.planet);
        let color = if planet == self.set.planet { self.set.color } else { color_columns(&planet) };
        let set = Settings {
            shelters,
            terrain: None,
            tiles: None,
            regions: saved.areas,
            weather_regions: saved.weather_regions,
            cloud_map: beside.cloud_map.take(),
            host_wind: beside.wind_grid.take().map(|grid| self.host_wind(grid)),
            given_sun,
            given_moon,
            utc_at_zero,
            undimmed: false,
            planet,
            color,
        };
        beside.tone.get_or_insert(self.tone);
        Ok(LoadedWorld {
            time_s: saved.time_s,
            drifted: drifted_from(saved.drifted, &timeline)?,
            layers_drifted: layers_drifted_from(&saved.layers_drifted, saved.drifted[0])?,
            timeline,
            set,
            beside,
        })
    }

    /// Swaps the loaded world in; `other` then holds the previous one.
    pub fn swap_in(&mut self, other: &mut LoadedWorld) {
        use std::mem::swap;
        swap(&mut self.time_s, &mut other.time_s);
        swap(&mut self.timeline, &mut other.timeline);
        self.timeline_revision = next_revision();
        swap(&mut self.drifted, &mut other.drifted);
        swap(&mut self.layers_drifted, &mut other.layers_drifted);
        swap(&mut self.set, &mut other.set);
        self.frame.figure = Figure::of_radius(self.set.planet.bottom_radius_m);
        // Tiles belong to the host, whatever is loaded.
        swap(&mut self.set.tiles, &mut other.set.tiles);
        swap(&mut self.exposure, &mut other.beside.exposure);
        if let Some(tone) = &mut other.beside.tone {
            swap(&mut self.tone, tone);
        }
        swap(&mut self.lights, &mut other.beside.lights);
        self.surroundings_revision += 1;
        self.regions_revision += 1;
    }
}
