//! The site: what CIGI leaves to the image generator, as a table in TOML that a site can change.

use serde::Deserialize;

/// Datum of the altitudes of entities and of requests. Layers are above mean sea level always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Altitudes {
    /// Mean sea level.
    #[default]
    MeanSeaLevel,
    /// The ellipsoid WGS 84.
    Ellipsoid,
}

/// Meaning of severities. Each list has a value for each severity from 0 to 5. No source gives such figures: these are
/// our own choice.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Severities {
    /// Rain, mm/h, [0, 500].
    pub rain_mm_h: [f64; 6],
    /// Snow and sleet, mm/h of water, [0, 500].
    pub snow_mm_h: [f64; 6],
    /// Hail, mm/h of water, [0, 500].
    pub hail_mm_h: [f64; 6],
    /// Flashes a minute, [0, 60].
    pub flashes_per_minute: [f64; 6],
}

impl Default for Severities {
    fn default() -> Self {
        Self {
            rain_mm_h: [0.5, 2.0, 5.0, 10.0, 25.0, 60.0],
            snow_mm_h: [0.2, 0.5, 1.0, 2.0, 3.5, 6.0],
            hail_mm_h: [1.0, 2.0, 5.0, 10.0, 20.0, 40.0],
            flashes_per_minute: [0.0, 1.0, 3.0, 6.0, 12.0, 20.0],
        }
    }
}

/// Kind of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LayerMeaning {
    /// Fog on the ground.
    GroundFog,
    /// Cloud, by its cloud type.
    Cloud,
    /// Rain.
    Rain,
    /// Snow.
    Snow,
    /// Rain and snow together.
    Sleet,
    /// Hail.
    Hail,
    /// Blowing sand.
    Sand,
    /// Blowing dust.
    Dust,
    /// Haze: its visibility counts, and nothing else.
    Haze,
    /// Nothing.
    Nothing,
}

/// Meaning of one layer number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayerRow {
    /// Layer number.
    pub id: u8,
    /// What it is.
    pub means: LayerMeaning,
}

/// Kind of cloud, by the names of Welkin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CloudKind {
    /// Low grey sheet.
    Stratus,
    /// Low sheet of rounded masses.
    Stratocumulus,
    /// Fair-weather cumulus.
    Cumulus,
    /// Towering cumulus.
    ToweringCumulus,
    /// Cumulonimbus.
    Cumulonimbus,
    /// Thick sheet that rains or snows.
    Nimbostratus,
    /// Middle sheet of rounded masses.
    Altocumulus,
    /// Middle grey sheet.
    Altostratus,
    /// High fibres of ice.
    Cirrus,
    /// High veil of ice.
    Cirrostratus,
    /// High ripples of ice.
    Cirrocumulus,
}

impl CloudKind {
    /// Whether it consists of ice.
    pub fn is_ice(self) -> bool {
        matches!(self, Self::Cirrus | Self::Cirrostratus | Self::Cirrocumulus)
    }
}

/// Kind of one cloud type that CIGI leaves to the image generator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CloudRow {
    /// Cloud type, 11 to 15.
    pub number: u8,
    /// Kind.
    pub kind: CloudKind,
}

/// State of the ground, by the names of Welkin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceState {
    /// Dry.
    Dry,
    /// Damp.
    Damp,
    /// Wet.
    Wet,
    /// Puddles.
    StandingWater,
    /// Frost.
    Frost,
    /// Ice.
    Ice,
    /// Lying snow.
    Snow,
}

/// Meaning of one condition of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceRow {
    /// Surface condition, from 1 on.
    pub id: u16,
    /// State of the ground.
    pub state: SurfaceState,
    /// Depth of snow at severity 31, m, [0, 20]; less in proportion.
    #[serde(default)]
    pub snow_depth_m: f64,
}

/// Meaning of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ComponentMeaning {
    /// Windscreen wiper: the state is its speed, 0 at rest.
    Wiper,
    /// Lamp: the state is 0 off, else on.
    Light,
}

/// Meaning of one component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComponentRow {
    /// Class, 0 to 63.
    pub class: u8,
    /// Component.
    pub component: u16,
    /// What it is.
    pub means: ComponentMeaning,
}

/// A site. Every value has a default.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Site {
    /// Height of the ground to which Welkin's weather refers above mean sea level, m, [-500, 9000].
    pub station_altitude_m: f64,
    /// Datum of the host's altitudes.
    pub altitudes: Altitudes,
    /// Height of mean sea level above the ellipsoid, m, [-120, 100].
    pub geoid_height_m: f64,
    /// Hours by which the host's date and time are ahead of UTC, [-14, 14].
    pub hours_ahead_of_utc: f64,
    /// Whether to find the identifiers that the class library 4.0 writes one byte too early.
    pub reads_early_ids: bool,
    /// Databases that may be asked for, 1 to 127.
    pub databases: Vec<u8>,
    /// Meaning of severities.
    pub severities: Severities,
    /// Meanings of layers; those of 0 to 9 are as CIGI says if no row says otherwise.
    pub layers: Vec<LayerRow>,
    /// Kinds of the cloud types 11 to 15.
    pub clouds: Vec<CloudRow>,
    /// Meanings of the conditions of the ground. CIGI leaves all but 0 (dry) to the image generator.
    pub surfaces: Vec<SurfaceRow>,
    /// Meanings of components.
    pub components: Vec<ComponentRow>,
}

impl Default for Site {
    fn default() -> Self {
        let row = |id, state, snow_depth_m| SurfaceRow { id, state, snow_depth_m };
        Self {
            station_altitude_m: 0.0,
            altitudes: Altitudes::default(),
            geoid_height_m: 0.0,
            hours_ahead_of_utc: 0.0,
            reads_early_ids: true,
            databases: (1..=127).collect(),
            severities: Severities::default(),
            layers: Vec::new(),
            clouds: Vec::new(),
            surfaces: vec![
                row(1, SurfaceState::Wet, 0.0),
                row(2, SurfaceState::StandingWater, 0.0),
                row(3, SurfaceState::Snow, 0.5),
                row(4, SurfaceState::Ice, 0.0),
                row(5, SurfaceState::Frost, 0.0),
            ],
            components: Vec::new(),
        }
    }
}

/// Returns the message for a value out of range.
fn check(name: &str, value: f64, range: [f64; 2]) -> Result<(), String> {
    let [low, high] = range;
    if (low..=high).contains(&value) { Ok(()) } else { Err(format!("{name} must be in [{low}, {high}], got {value}")) }
}

/// Returns the message for a number that two rows have.
fn check_once<K: Ord + std::fmt::Debug>(table: &str, keys: impl Iterator<Item = K>) -> Result<(), String> {
    let mut seen = std::collections::BTreeSet::new();
    for key in keys {
        if seen.contains(&key) {
            return Err(format!("{table}: {key:?} must have one row, has more"));
        }
        seen.insert(key);
    }
    Ok(())
}

impl Site {
    /// Reads a site's table.
    ///
    /// # Errors
    /// A sentence that names the key and what is accepted.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        let site: Self = toml::from_str(text).map_err(|e| e.to_string().trim_end().to_owned())?;
        site.validate()?;
        Ok(site)
    }

    fn validate(&self) -> Result<(), String> {
        check("station_altitude_m", self.station_altitude_m, [-500.0, 9000.0])?;
        check("geoid_height_m", self.geoid_height_m, [-120.0, 100.0])?;
        check("hours_ahead_of_utc", self.hours_ahead_of_utc, [-14.0, 14.0])?;
        for database in &self.databases {
            check("databases", f64::from(*database), [1.0, 127.0])?;
        }
        let Severities { rain_mm_h, snow_mm_h, hail_mm_h, flashes_per_minute } = self.severities;
        let lists = [
            ("severities.rain_mm_h", rain_mm_h, 500.0),
            ("severities.snow_mm_h", snow_mm_h, 500.0),
            ("severities.hail_mm_h", hail_mm_h, 500.0),
            ("severities.flashes_per_minute", flashes_per_minute, 60.0),
        ];
        for (name, values, most) in lists {
            values.iter().try_for_each(|value| check(name, *value, [0.0, most]))?;
        }
        for row in &self.clouds {
            check("clouds.number", row.number.into(), [11.0, 15.0])?;
        }
        for row in &self.surfaces {
            check("surfaces.id", row.id.into(), [1.0, 65_535.0])?;
            check("surfaces.snow_depth_m", row.snow_depth_m, [0.0, 20.0])?;
        }
        for row in &self.components {
            check("components.class", row.class.into(), [0.0, 63.0])?;
        }
        check_once("layers.id", self.layers.iter().map(|row| row.id))?;
        check_once("clouds.number", self.clouds.iter().map(|row| row.number))?;
        check_once("surfaces.id", self.surfaces.iter().map(|row| row.id))?;
        check_once("components", self.components.iter().map(|row| [row.class.into(), row.component]))
    }

    /// Returns what a layer is.
    pub fn layer(&self, id: u8) -> LayerMeaning {
        if let Some(row) = self.layers.iter().find(|row| row.id == id) {
            return row.means;
        }
        match id {
            0 => LayerMeaning::GroundFog,
            1..=3 => LayerMeaning::Cloud,
            4 => LayerMeaning::Rain,
            5 => LayerMeaning::Snow,
            6 => LayerMeaning::Sleet,
            7 => LayerMeaning::Hail,
            8 => LayerMeaning::Sand,
            9 => LayerMeaning::Dust,
            _ => LayerMeaning::Nothing,
        }
    }

    /// Returns the kind of a cloud type; `None` for no cloud, and for a number of 11 to 15 without a row.
    pub fn cloud(&self, number: u8) -> Option<CloudKind> {
        const KINDS: [CloudKind; 10] = [
            CloudKind::Altocumulus,
            CloudKind::Altostratus,
            CloudKind::Cirrocumulus,
            CloudKind::Cirrostratus,
            CloudKind::Cirrus,
            CloudKind::Cumulonimbus,
            CloudKind::Cumulus,
            CloudKind::Nimbostratus,
            CloudKind::Stratocumulus,
            CloudKind::Stratus,
        ];
        let own = || self.clouds.iter().find(|row| row.number == number).map(|row| row.kind);
        number.checked_sub(1).and_then(|i| KINDS.get(usize::from(i)).copied()).or_else(own)
    }

    /// Returns the height above the ellipsoid of an altitude as the host states it, m: that of Welkin's Earth-centred
    /// world.
    pub fn above_ellipsoid_m(&self, altitude_m: f64) -> f64 {
        altitude_m + self.geoid_height_m - self.sea_level_m()
    }

    /// Returns how high mean sea level lies above the datum of the host's altitudes, m.
    pub fn sea_level_m(&self) -> f64 {
        match self.altitudes {
            Altitudes::MeanSeaLevel => 0.0,
            Altitudes::Ellipsoid => self.geoid_height_m,
        }
    }
}
