//! Saving a context and loading it again, and a number by which channels compare theirs.
//!
//! A state is text: a line with the format and a checksum of all that follows, then TOML. What the description of a context
//! fixes is compared on load ([`created`]); everything that can be set or that has come about since is restored. Keys may be added
//! without another format if a state without them means what it did; a key whose meaning changes makes another format.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{
    Context, ContextDesc, GivenDirection, GroundModel,
    areas::KeptArea,
    ground::GroundState,
    saved_settings::{SavedSettings, Settings},
    terrain::HostGround,
    terrain_saved::SavedGround,
    update::Behind,
};
use crate::{
    error::{Error, Result, Status, check_range, toml_fault},
    ground::SurfaceClass,
    scene::WorldKind,
    sky::sun::Utc,
    weather::Timeline,
    wind::Drift,
};

/// The format that is written, and the only one that is read. Format 1 did not say of which place and ground a state was.
const FORMAT: u32 = 2;
/// What the first line begins with.
const MAGIC: &str = "welkin state ";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    time_s: f64,
    utc_at_zero: f64,
    sun: Option<[f64; 2]>,
    moon: Option<[f64; 2]>,
    timeline: String,
    /// How far the wind had carried the air when the last forgotten change ended: time, path, east, north.
    drifted: [f64; 4],
    created: toml::Table,
    settings: SavedSettings,
    ground: Option<GroundState>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    areas: Vec<KeptArea>,
    terrain: Option<SavedGround>,
    /// Number of the class of ground of which nothing else is said.
    #[serde(default, skip_serializing_if = "is_unspecified")]
    surface_class: u8,
}

/// Whether a number is that of no class.
fn is_unspecified(class: &u8) -> bool {
    *class == SurfaceClass::Unspecified as u8
}

/// What the description of a context fixes of what it shows, under the names of the C header.
fn created(desc: &ContextDesc) -> toml::Table {
    // Named one by one: a new field has to be put here, among what is restored, or among what only says how things are drawn.
    let ContextDesc { world, planet, seed, exposure: _, tone, utc_at_zero: _, sky: _, ground, cache_dir: _ } = desc;
    let mut table = toml::Table::new();
    let mut put = |name: &str, value: toml::Value| table.insert(name.into(), value);
    put("world_kind", format!("{:?}", world.kind).into());
    // 0 and -0 are the same place.
    put("latitude_deg", (world.origin.latitude_deg + 0.0).into());
    put("longitude_deg", (world.origin.longitude_deg + 0.0).into());
    put("altitude_m", (world.origin.altitude_m + 0.0).into());
    if world.kind != WorldKind::Ecef {
        put("axes", format!("{:?}", world.axes).into());
        put("grid_bearing_deg", (world.grid_bearing_deg + 0.0).into());
    }
    put("seed", seed.to_string().into());
    put("planet_toml", format!("hash {:016x}", planet.hash()).into());
    put("tone_curve", format!("{tone:?}").into());
    put("ground_model", format!("{ground:?}").into());
    table
}

/// Refuses a state of a context that was created otherwise, naming all that differs.
fn check_created(saved: &toml::Table, here: &toml::Table) -> Result<()> {
    let names = here.keys().chain(saved.keys().filter(|name| !here.contains_key(*name)));
    let shown = |v: Option<&toml::Value>| v.map_or("nothing".into(), ToString::to_string);
    let other = names
        .filter(|name| saved.get(*name) != here.get(*name))
        .map(|name| format!("{name} ({} in the state, {} here)", shown(saved.get(name)), shown(here.get(name))));
    let other: Vec<String> = other.collect();
    if other.is_empty() {
        return Ok(());
    }
    Err(Error::invalid("state", format!("must be of a context that was created alike; other is {}", other.join(", "))))
}

fn parse_error(what: impl std::fmt::Display) -> Error {
    Error::new(Status::Parse, format!("saved state: {what}"))
}

/// FNV-1a, 64 bits: never the same for two texts that differ in one byte.
fn checksum(text: &str) -> u64 {
    let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, fold)
}

fn sealed(body: &str) -> String {
    format!("{MAGIC}{FORMAT} {:016x}\n{body}", checksum(body))
}

/// What stands below the first line, if that fits.
fn unsealed(bytes: &[u8]) -> Result<&str> {
    let text = std::str::from_utf8(bytes).map_err(|_| parse_error("the bytes are no UTF-8 text"))?;
    let (head, body) = text.split_once('\n').ok_or_else(|| parse_error("the first line is missing"))?;
    let format = match head.strip_prefix(MAGIC) {
        Some(rest) => rest.split(' ').next().unwrap_or_default(),
        None => head.strip_prefix("version = ").ok_or_else(|| parse_error("the first line is not a state's"))?,
    };
    if format != FORMAT.to_string() {
        let format: String = format.chars().take(12).collect();
        return Err(parse_error(format_args!(
            "it is of format {format}, this version of Welkin reads format {FORMAT} alone: save it anew"
        )));
    }
    // A text that was cut may still be TOML, and so may one with another digit.
    if sealed(body) != text {
        return Err(parse_error("it is cut short or changed, its checksum does not fit"));
    }
    Ok(body)
}

/// Where counting goes on: at the end of what `timeline` has forgotten.
fn drifted_from([time_s, path_m, east, north]: [f64; 4], timeline: &Timeline) -> Result<Drift> {
    let drift = Drift { time_s, path_m, displacement_m: DVec2::new(east, north) };
    let since_ever = timeline.known_since_ever() && drift == Drift::ZERO;
    let finite = [path_m, east, north].iter().all(|v| v.is_finite());
    let sound = since_ever || (finite && time_s == timeline.known_from_s());
    let wanted = "drifted must be finite and belong to the end of what the timeline has forgotten";
    sound.then_some(drift).ok_or_else(|| parse_error(wanted))
}

/// A state that can be shown.
struct Loaded {
    time_s: f64,
    utc_at_zero: Utc,
    given: [Option<GivenDirection>; 2],
    timeline: Timeline,
    drifted: Drift,
    ground: Option<GroundState>,
    behind: Option<Box<Behind>>,
    areas: Vec<KeptArea>,
    terrain: Option<Box<HostGround>>,
    surface_class: SurfaceClass,
    settings: Settings,
}

impl Context {
    fn saved(&self) -> Result<String> {
        // Named one by one: what a new field decides has to be saved, unless it follows from the rest.
        let Self {
            desc,
            timeline,
            drifted,
            given_sun,
            given_moon,
            fog_law,
            shelters,
            areas,
            lights,
            wind_grid,
            time_s,
            ground,
            host_ground,
            surface_class,
            behind,
            // Images of the host's, each channel's own like its depth.
            maps: _,
            // Follow from the description.
            color: _,
            wind: _,
            hollows: _,
            ephemeris: _,
            // How it is drawn.
            device: _,
            shared: _,
            sky: _,
            ground_revision: _,
            ground_generation: _,
            classes_revision: _,
            terrain_textures: _,
            told: _,
        } = self;
        if behind.is_some() {
            let wanted = "a state comes after wk_context_update has answered WK_OK: steps of the ground remain";
            return Err(Error::new(Status::WrongOrder, format!("{wanted} up to {time_s} s")));
        }
        let angles = |g: &Option<GivenDirection>| g.map(|g| [g.azimuth_deg, g.elevation_deg]);
        let carried = drifted.displacement_m;
        let saved = Saved {
            time_s: *time_s,
            utc_at_zero: desc.utc_at_zero.0,
            sun: angles(given_sun),
            moon: angles(given_moon),
            timeline: timeline.save()?,
            drifted: [drifted.time_s, drifted.path_m, carried.x, carried.y],
            created: created(desc),
            settings: SavedSettings::of(desc.exposure, fog_law, shelters, lights, wind_grid.as_deref()),
            ground: *ground,
            areas: areas.clone(),
            terrain: host_ground.as_deref().map(SavedGround::of),
            surface_class: *surface_class as u8,
        };
        toml::to_string(&saved).map_err(|e| Error::new(Status::Internal, format!("the state cannot be written: {e}")))
    }

    /// Everything that decides what this context shows from now on, as UTF-8 text: weather, time, clock, lights, water, areas,
    /// shelters, lamps, wind grid, fog law and exposure, and of which place, planet, seed and ground model it is. Not in it: how
    /// it is drawn (sky settings, views), and the images of [`Context::set_occluder_maps`], which are each channel's own.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] while [`Context::update_within`] has steps to do; [`Status::Internal`] if a number cannot be written.
    pub fn save(&self) -> Result<Vec<u8>> {
        Ok(sealed(&self.saved()?).into_bytes())
    }

    /// Loads a state that [`Context::save`] wrote, in place of all that it holds, on a context that was created alike: the same
    /// world, place, planet, seed, tone curve and ground model. Occluder maps stay as they are.
    ///
    /// # Errors
    /// [`Status::Parse`] for bytes that are no such state, cut short, changed, or of another format, which it names;
    /// [`Status::InvalidArgument`] naming what was created otherwise. The context stays as it was.
    pub fn load(&mut self, bytes: &[u8]) -> Result<()> {
        let loaded = self.read_state(unsealed(bytes)?)?;
        let before = self.take_up(loaded);
        let shown = self.show_terrain();
        if shown.is_err() {
            self.take_up(before);
        }
        shown
    }

    /// A state that fits this context.
    fn read_state(&self, body: &str) -> Result<Loaded> {
        let saved: Saved = toml::from_str(body).map_err(|e| parse_error(toml_fault(body, &e)))?;
        check_created(&saved.created, &created(&self.desc))?;
        let given = |name: &str, a: Option<[f64; 2]>| -> Result<Option<GivenDirection>> {
            let given = a.map(|[azimuth_deg, elevation_deg]| GivenDirection { azimuth_deg, elevation_deg });
            given.map_or(Ok(()), |g| g.validate(name))?;
            Ok(given)
        };
        check_range("time_s", saved.time_s, -super::MAX_TIME_S, super::MAX_TIME_S, "s")?;
        let utc_at_zero = Utc(saved.utc_at_zero);
        crate::sky::sun::sun_position(utc_at_zero, &self.desc.world.origin)?;
        let given = [given("sun", saved.sun)?, given("moon", saved.moon)?];
        let simulated = self.desc.ground == GroundModel::Simulated;
        if saved.ground.is_some_and(|g| !simulated || !g.is_valid()) {
            return Err(parse_error("ground must be a simulated one with finite amounts of water from 0 on"));
        }
        let timeline = Timeline::load(&saved.timeline)?;
        if !self.are_valid(&saved.areas, &timeline) {
            return Err(parse_error("areas must be as they can be set"));
        }
        let terrain = saved.terrain.as_ref().map(|t| {
            let of_a_state = simulated && saved.ground.is_some();
            let loaded = t.host_ground(&self.desc.world).filter(|held| of_a_state || !held.begun);
            let wanted = "terrain must be a grid of heights and the water that it can hold";
            loaded.map(Box::new).ok_or_else(|| parse_error(wanted))
        });
        let surface_class = SurfaceClass::from_number("surface_class", saved.surface_class);
        Ok(Loaded {
            time_s: saved.time_s,
            utc_at_zero,
            given,
            drifted: drifted_from(saved.drifted, &timeline)?,
            timeline,
            ground: saved.ground,
            behind: None,
            areas: saved.areas,
            terrain: terrain.transpose()?,
            surface_class: surface_class.map_err(|e| e.with_status(Status::Parse).found_in("saved state"))?,
            settings: saved.settings.checked().map_err(|e| e.found_in("saved state"))?,
        })
    }

    /// Shows a state, and answers the one before it.
    fn take_up(&mut self, mut other: Loaded) -> Loaded {
        use std::mem::swap;
        swap(&mut self.time_s, &mut other.time_s);
        swap(&mut self.desc.utc_at_zero, &mut other.utc_at_zero);
        swap(&mut self.given_sun, &mut other.given[0]);
        swap(&mut self.given_moon, &mut other.given[1]);
        swap(&mut self.timeline, &mut other.timeline);
        swap(&mut self.drifted, &mut other.drifted);
        swap(&mut self.ground, &mut other.ground);
        swap(&mut self.behind, &mut other.behind);
        swap(&mut self.areas, &mut other.areas);
        self.swap_terrain(&mut other.terrain);
        swap(&mut self.surface_class, &mut other.surface_class);
        let settings = &mut other.settings;
        swap(&mut self.desc.exposure, &mut settings.exposure);
        swap(&mut self.fog_law, &mut settings.fog_law);
        swap(&mut self.shelters, &mut settings.shelters);
        swap(&mut self.lights, &mut settings.lights);
        swap(&mut self.wind_grid, &mut settings.wind_grid);
        self.told += 1;
        other
    }

    /// A number that is equal on two channels whose contexts show the same world from now on: a hash of what
    /// [`Context::save`] writes.
    ///
    /// # Errors
    /// As [`Context::save`].
    pub fn state_hash(&self) -> Result<u64> {
        Ok(checksum(&self.saved()?))
    }
}
