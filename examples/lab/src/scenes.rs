//! The scenes in which errors are measured.

use welkin::fog::{FogLayer, FogLight, Patches, Phase, Profile, koschmieder_extinction_per_m};
use welkin::sky::Planet;
use welkin::weather::CloudKind;
use welkin::{Error, Result};

use crate::candidates::Effect;

/// The air of a sky scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkyAir {
    /// The Earth's on a clear day.
    Clear,
    /// Haze of about 12 km visibility.
    Haze,
}

impl SkyAir {
    pub const ALL: [SkyAir; 2] = [SkyAir::Clear, SkyAir::Haze];

    pub fn planet(self) -> Planet {
        let mut planet = Planet::earth();
        if self == SkyAir::Haze {
            planet.mie.extinction_per_m = [2.4e-4; 3];
            planet.mie.scattering_per_m = [2.2e-4; 3];
        }
        planet
    }
}

/// A camera under a sun. Below the horizon it sees the planet's grey ground through the air.
#[derive(Clone, Copy, Debug)]
pub struct SkyScene {
    pub name: &'static str,
    pub air: SkyAir,
    pub altitude_m: f64,
    pub sun_zenith_deg: f64,
    /// The view's azimuth relative to the sun's, its elevation, and the horizontal field of view.
    pub azimuth_deg: f64,
    pub elevation_deg: f64,
    pub width_deg: f64,
}

const fn sky(
    name: &'static str,
    air: SkyAir,
    altitude_m: f64,
    sun_zenith_deg: f64,
    azimuth_deg: f64,
    elevation_deg: f64,
    width_deg: f64,
) -> SkyScene {
    SkyScene { name, air, altitude_m, sun_zenith_deg, azimuth_deg, elevation_deg, width_deg }
}

/// Scenes from an excavator's seat to orbit, and from noon to twilight.
pub const SKY: [SkyScene; 10] = [
    sky("noon", SkyAir::Clear, 3.0, 28.0, 55.0, 12.0, 90.0),
    sky("afternoon-digging", SkyAir::Clear, 3.0, 57.0, -120.0, -12.0, 75.0),
    sky("low-sun", SkyAir::Clear, 20.0, 80.0, 25.0, 8.0, 90.0),
    sky("sunset", SkyAir::Clear, 20.0, 89.6, 8.0, 8.0, 90.0),
    sky("earth-shadow", SkyAir::Clear, 20.0, 91.0, 180.0, 10.0, 90.0),
    sky("twilight", SkyAir::Clear, 20.0, 95.0, 15.0, 14.0, 90.0),
    sky("haze", SkyAir::Haze, 10.0, 60.0, 70.0, 5.0, 90.0),
    sky("haze-low-sun", SkyAir::Haze, 10.0, 82.0, 20.0, 6.0, 90.0),
    sky("airliner", SkyAir::Clear, 11_000.0, 72.0, 100.0, -2.0, 90.0),
    sky("limb", SkyAir::Clear, 400_000.0, 96.0, 40.0, -18.0, 60.0),
];

/// A camera over a flat plain in a layer of fog, with masts at several distances.
#[derive(Clone, Copy, Debug)]
pub struct FogScene {
    pub name: &'static str,
    pub layer: FogLayer,
    pub altitude_m: f64,
    pub elevation_deg: f64,
    pub sun_elevation_deg: f64,
}

impl FogScene {
    /// Light with the sun ahead and to the right, and a sky brighter in blue. The sun's irradiance on a surface facing
    /// it is 1.
    pub fn light(&self) -> FogLight {
        let (s, c) = self.sun_elevation_deg.to_radians().sin_cos();
        let azimuth = 35f64.to_radians();
        FogLight {
            to_sun: glam::DVec3::new(c * azimuth.sin(), c * azimuth.cos(), s),
            sun_irradiance: [1.0, 0.96, 0.9],
            sky_irradiance: [0.16, 0.2, 0.27],
            ground_albedo: [0.18; 3],
        }
    }
}

/// Ground fog, mist, a layer seen from above, patches, dust, haze.
pub fn fog() -> Vec<FogScene> {
    let layer =
        |visibility_m, top_m, soft_m| FogLayer::ground_fog(koschmieder_extinction_per_m(visibility_m), top_m, soft_m);
    let patches = Patches { amount: 1.0, size_m: 90.0, seed: 7, drift_m: [0.0; 2] };
    let thinning = Profile::Exponential { reference_m: 0.0, scale_height_m: 60.0 };
    let dust = Phase::HenyeyGreenstein { g: 0.7 };
    let scene = |name, layer, altitude_m, elevation_deg, sun_elevation_deg| FogScene {
        name,
        layer,
        altitude_m,
        elevation_deg,
        sun_elevation_deg,
    };
    vec![
        scene("dense", layer(60.0, 40.0, 10.0), 3.0, -4.0, 30.0),
        scene("fog", layer(300.0, 80.0, 20.0), 3.0, -4.0, 30.0),
        scene("mist", layer(2500.0, 250.0, 60.0), 3.0, -3.0, 20.0),
        scene("light-haze", layer(20_000.0, 800.0, 200.0), 3.0, -3.0, 40.0),
        scene("shallow", layer(150.0, 2.5, 1.0), 4.0, -8.0, 12.0),
        scene("from-above", layer(250.0, 60.0, 20.0), 120.0, -14.0, 25.0),
        scene("patches", FogLayer { patches: Some(patches), ..layer(250.0, 15.0, 6.0) }, 3.0, -4.0, 25.0),
        scene("thinning", FogLayer { profile: thinning, ..layer(400.0, 0.0, 0.0) }, 3.0, -2.0, 15.0),
        scene("dust", FogLayer { albedo: [0.96, 0.9, 0.8], phase: dust, ..layer(350.0, 60.0, 20.0) }, 3.0, -4.0, 35.0),
    ]
}

/// A camera 12 m above the ground, under rain, looking at a wall that is half dark and half light, with sky above.
#[derive(Clone, Copy, Debug)]
pub struct RainScene {
    pub name: &'static str,
    pub rate_mm_h: f64,
    pub wind_m_s: f64,
    pub driving_m_s: f64,
    pub sun_deg: f64,
    /// Relative to north, which is ahead.
    pub sun_azimuth_deg: f64,
    /// Whether two headlights beside the camera are on.
    pub lamps: bool,
    /// Air temperature, C, if snow falls in place of rain.
    pub snow_c: Option<f64>,
}

/// Scenes from a drizzle to a cloudburst, from noon to a night with headlights.
pub fn rain() -> Vec<RainScene> {
    let scene = |name, rate_mm_h, wind_m_s, driving_m_s| RainScene {
        name,
        rate_mm_h,
        wind_m_s,
        driving_m_s,
        sun_deg: 40.0,
        sun_azimuth_deg: 140.0,
        lamps: false,
        snow_c: None,
    };
    vec![
        scene("light", 1.0, 2.0, 0.0),
        scene("steady", 6.0, 5.0, 0.0),
        scene("shower", 25.0, 8.0, 0.0),
        scene("cloudburst", 100.0, 5.0, 0.0),
        scene("driving", 10.0, 5.0, 25.0),
        scene("storm", 25.0, 20.0, 0.0),
        RainScene { sun_deg: 12.0, sun_azimuth_deg: 10.0, ..scene("towards-the-sun", 6.0, 3.0, 0.0) },
        RainScene { sun_deg: -20.0, lamps: true, ..scene("head-lights", 10.0, 3.0, 0.0) },
    ]
}

/// Snow in front of the same wall: large flakes in almost no wind, dry snow, a storm, and a moving camera.
pub fn snow() -> Vec<RainScene> {
    let scene = |name, rate_mm_h, snow_c, wind_m_s, driving_m_s| RainScene {
        name,
        rate_mm_h,
        wind_m_s,
        driving_m_s,
        sun_deg: 25.0,
        sun_azimuth_deg: 140.0,
        lamps: false,
        snow_c: Some(snow_c),
    };
    vec![
        scene("quiet", 1.5, 0.3, 0.6, 0.0),
        scene("dry", 0.5, -12.0, 3.0, 0.0),
        scene("storm", 4.0, -6.0, 16.0, 0.0),
        scene("driving", 1.0, -3.0, 3.0, 20.0),
    ]
}

/// A clear night at 50 degrees north; the camera looks south, 40 degrees up.
#[derive(Clone, Copy, Debug)]
pub struct StarScene {
    pub name: &'static str,
    pub sun_deg: f64,
    pub moon_deg: f64,
}

/// Scenes from a dark sky to one that hides all but the brightest stars.
pub const STARS: [StarScene; 3] = [
    StarScene { name: "moonless", sun_deg: -40.0, moon_deg: -40.0 },
    StarScene { name: "moonlit", sun_deg: -40.0, moon_deg: 30.0 },
    StarScene { name: "dusk", sun_deg: -9.0, moon_deg: -40.0 },
];

/// One layer of cloud by day.
#[derive(Clone, Copy, Debug)]
pub struct CloudScene {
    pub name: &'static str,
    pub kind: CloudKind,
    pub cover: f64,
    pub base_m: f64,
    pub height_m: f64,
    pub pitch_deg: f64,
    pub sun_deg: f64,
}

/// Views from below, from above, from inside, and of distant and thin clouds.
pub const CLOUDS: [CloudScene; 6] = {
    const fn scene(name: &'static str, kind: CloudKind, at: [f64; 5]) -> CloudScene {
        let [cover, base_m, height_m, pitch_deg, sun_deg] = at;
        CloudScene { name, kind, cover, base_m, height_m, pitch_deg, sun_deg }
    }
    [
        scene("fair-cumulus", CloudKind::Cumulus, [0.4, 1000.0, 2.0, 20.0, 45.0]),
        scene("evening-cumulus", CloudKind::Cumulus, [0.4, 1000.0, 2.0, 10.0, 8.0]),
        scene("altocumulus", CloudKind::Altocumulus, [0.6, 4000.0, 2.0, 35.0, 40.0]),
        scene("cirrus", CloudKind::Cirrus, [0.5, 9000.0, 2.0, 40.0, 30.0]),
        scene("deck-from-above", CloudKind::Stratocumulus, [1.0, 800.0, 3000.0, -15.0, 40.0]),
        scene("among-towers", CloudKind::ToweringCumulus, [0.5, 1000.0, 2500.0, 0.0, 30.0]),
    ]
};

/// Finds the index of a scene by its name.
///
/// # Errors
/// An unknown name, with the known ones.
pub fn find(effect: Effect, name: &str) -> Result<usize> {
    let names: Vec<&str> = match effect {
        Effect::Sky => SKY.iter().map(|s| s.name).collect(),
        Effect::Fog => fog().iter().map(|s| s.name).collect(),
        Effect::Rain => rain().iter().map(|s| s.name).collect(),
        Effect::Stars => STARS.iter().map(|s| s.name).collect(),
        Effect::Snow => snow().iter().map(|s| s.name).collect(),
        Effect::Clouds => CLOUDS.iter().map(|s| s.name).collect(),
    };
    let fault = || Error::range("--scene", &format!("one of {}", names.join(", ")), name);
    names.iter().position(|n| *n == name).ok_or_else(fault)
}
