//! Fog of a scene: the weather's low layer and precipitation, or a fog law of older simulators if the host has set one.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{
    curtains::{CURTAIN_WAVES, Curtains},
    layer::{FogLayer, Law, Patches, Profile},
    model::{FogKind, FogModel},
    path::{falling_path, layer_depth_above, layer_path},
    patterns::patch_mean,
    viewpoint::{FogLight, NO_LIGHT, Viewpoint},
};
use crate::{
    error::Result,
    falling::{FallingLayer, curtain},
    light::Phase,
    moment::{GroundLight, Light, MAX_EXTINCTION_PER_M, Scene},
    numerics::smoothstep,
    scene::Place,
    weather::{Conditions, GroundLayer, lifting},
    wind::Detour,
};

/// Smallest visible change of the optical depth by the longest curtain.
const LEAST_SHOWN: f64 = 1e-3;

/// Media of a weather in the air near the ground: its low layer of fog, mist or dust, and the precipitation outside
/// rain areas. Each has its own extinction and heights. A visibility reported at the station includes the extinction of
/// both.
pub(crate) struct LowAir {
    /// Fog, mist or dust near the ground, if there is any.
    layer: Option<FogLayer>,
    /// Precipitation outside rain areas.
    falling: FallingLayer,
    /// Lag of the patches where the wind flows round obstacles.
    detour: Option<Detour>,
}

impl LowAir {
    /// Creates the low air of a weather. Patches of fog move with the air; `drift_m` is the distance over which the
    /// wind has carried it (east, north).
    pub fn new(c: &Conditions, seed: u64, drift_m: [f64; 2]) -> Self {
        Self { layer: ground_layer(c, seed, drift_m), falling: FallingLayer::new(c), detour: None }
    }

    /// Returns the low air with patches that flow round obstacles to the wind.
    pub fn with_detour(self, detour: Option<Detour>) -> Self {
        Self { detour, ..self }
    }

    /// Creates the low air of a weather without patches.
    pub fn even(c: &Conditions) -> Self {
        let air = Self::new(c, 0, [0.0; 2]);
        Self { layer: air.layer.map(|layer| FogLayer { patches: None, ..layer }), ..air }
    }

    /// Whether the low air has no extinction.
    pub fn is_clear(&self) -> bool {
        self.layer.is_none() && self.falling.extinction_per_m() <= 0.0
    }

    /// Returns the model that shaders draw and queries use, without the curtains of rain.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn model(&self, light: &FogLight, view: &Viewpoint) -> Result<FogModel> {
        let mut model = FogModel::of_weather(self.layer.as_ref(), &self.falling, light, view)?;
        model.set_detour(self.detour.clone());
        Ok(model)
    }

    /// Returns the media along rays from a place, each without the other.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn media(&self, view: &Viewpoint) -> Result<LowMedia> {
        let mut layer = FogModel::of_weather(self.layer.as_ref(), &FallingLayer::NONE, &NO_LIGHT, view)?;
        layer.set_detour(self.detour.clone());
        let falling = FogModel::of_weather(None, &self.falling, &NO_LIGHT, view)?;
        Ok(LowMedia { layer, falling })
    }
}

/// Media of a weather near the ground along rays from a place, each without the other.
pub(crate) struct LowMedia {
    /// Low layer without precipitation.
    layer: FogModel,
    /// Precipitation without the layer.
    falling: FogModel,
}

impl LowMedia {
    /// Returns the optical depths of the layer per channel over the first `range_m` metres along `unit` (east, north,
    /// up).
    pub fn layer_depths(&self, unit: DVec3, range_m: f64) -> [f64; 3] {
        let m = &self.layer;
        if m.kind == FogKind::Clear || range_m <= 0.0 {
            return [0.0; 3];
        }
        let path = layer_path(m, m.altitude, unit.z.clamp(-1.0, 1.0), range_m);
        let patches = if m.patch_amount > 0.0 { patch_mean(m, DVec3::ZERO, unit, path.first, path.last) } else { 1.0 };
        (m.ratio * (path.depth * patches)).to_array()
    }

    /// Returns the optical depths of the precipitation per channel over the first `range_m` metres along `unit`.
    pub fn falling_depths(&self, unit: DVec3, range_m: f64) -> [f64; 3] {
        let m = &self.falling;
        if m.falling.extinction <= 0.0 || range_m <= 0.0 {
            return [0.0; 3];
        }
        (m.ratio * falling_path(m, m.altitude, unit.z.clamp(-1.0, 1.0), range_m).depth).to_array()
    }
}

/// Smallest strength of patches that is visible.
const LEAST_PATCHES: f64 = 0.002;

/// Returns the weather's low layer of fog, mist or dust as a fog layer; `None` if it has no extinction.
fn ground_layer(c: &Conditions, seed: u64, drift_m: [f64; 2]) -> Option<FogLayer> {
    let f = &c.fog;
    if f.extinction_per_m <= 0.0 {
        return None;
    }
    let station = c.air.station_altitude_m;
    // Fog lies on the ground at any altitude of the terrain. Only a lifted layer has a base.
    let base_m = if f.base_m <= 0.0 { -1e4 } else { station + f.base_m };
    let softness = f.softness_m.min(f.top_m - f.base_m);
    let profile = Profile::Slab {
        base_m,
        // At the weather's `top_m` no fog is left. The slab's top is the middle of its upper flank.
        top_m: (station + f.top_m - 0.5 * softness).max(base_m),
        base_softness_m: 0.0,
        top_softness_m: softness,
    };
    // Particles whose extinction depends on the wavelength are not droplets.
    let (diameter_um, g) = (15.0, f.asymmetry.clamp(-0.95, 0.95));
    let phase = match smoothstep(0.25, 0.75, f.angstrom_exponent) {
        share if share <= 0.0 => Phase::Droplets { diameter_um },
        share if share >= 1.0 => Phase::HenyeyGreenstein { g },
        share => Phase::Between { diameter_um, g, share },
    };
    let covered = (2.0 * (1.0 - f.coverage)).clamp(0.0, 1.0);
    // The pattern's values have an exponential distribution with the mean 1. The densest share c of them, the part of
    // the ground under fog, has the mean 1 - ln c. The mean extinction over that part must be the reported one.
    let inside = 1.0 - covered * f.coverage.max(0.01).ln();
    // Gusts lift more dust in some places than in others. The reported extinction is the mean over all places.
    let gusts = if f.lifted > 0.0 { f.lifted * lifting::unevenness(&c.wind) } else { 0.0 };
    let amount = covered.max(gusts);
    let amount = (amount - LEAST_PATCHES) / (1.0 - LEAST_PATCHES);
    let patches = (amount > 0.0).then_some(Patches { amount, size_m: f.drawn_patch_m(), seed, drift_m });
    // Dust absorbs blue, soot all colours: absorption follows its own power of the wavelength.
    let absorbed = 1.0 - f.single_scattering_albedo.clamp(0.0, 1.0);
    let dust = lifting::DUST_ABSORPTION_EXPONENT;
    let absorbing = c.aerosol.absorption_angstrom_exponent;
    let exponent = f.angstrom_exponent - (absorbing + f.lifted * (dust - absorbing));
    let albedo = crate::light::EARTH_WAVELENGTHS_NM
        .map(|nm| 1.0 - (absorbed * (nm / crate::light::EARTH_WAVELENGTHS_NM[1]).powf(exponent)).min(1.0));
    Some(FogLayer {
        extinction_per_m: (f.extinction_per_m / inside).min(MAX_EXTINCTION_PER_M),
        angstrom: f.angstrom_exponent.clamp(-1.0, 4.0),
        albedo,
        profile,
        phase,
        patches,
    })
}

/// Returns the weather's low layer alone and without patches, as shaders and queries draw it.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter.
pub(super) fn layer_alone(c: &Conditions, light: &FogLight, view: &Viewpoint) -> Result<FogModel> {
    let layer = ground_layer(c, 0, [0.0; 2]).map(|layer| FogLayer { patches: None, ..layer });
    FogModel::of_weather(layer.as_ref(), &FallingLayer::NONE, light, view)
}

/// Returns the viewpoint of a place. Its ground lies at the station's altitude, or at the place if that is lower.
fn viewpoint(place: &Place, c: &Conditions, map_m: [f64; 2], planet_radius_m: f64) -> Viewpoint {
    let ground_m = c.air.station_altitude_m.min(place.altitude_m);
    Viewpoint { altitude_m: place.altitude_m, map_m, planet_radius_m, ground_m }
}

/// Attenuates the light of a scene by the weather's low layer and precipitation.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter.
pub(crate) fn dim(scene: &mut Scene) -> Result<()> {
    let (above, lights) = (&scene.above_fog, [&scene.sun, &scene.moon]);
    let lux = [above.sun_lux, above.moon_lux, above.sky_lux];
    let left = through_fog(&scene.conditions, &scene.place, lights, lux, scene.ground_albedo)?;
    scene.ground = GroundLight::new(left, lights, scene.place.altitude_m);
    Ok(())
}

/// Returns the light that the weather's low layer and precipitation leave at a place. `lux` is the light above both.
/// Either light has three illuminances, lux: that of the sun, that of the moon, and that of all other light on level
/// ground.
fn through_fog(
    c: &Conditions,
    place: &Place,
    [sun, moon]: [&Light; 2],
    lux: [[f64; 3]; 3],
    ground_albedo: [f64; 3],
) -> Result<[[f64; 3]; 3]> {
    let [sun_lux, moon_lux, sky_lux] = lux;
    let air = LowAir::even(c);
    if air.is_clear() {
        return Ok(lux);
    }
    let view = viewpoint(place, c, [0.0; 2], f64::INFINITY);
    let under = |light: &Light, sun_irradiance, sky_irradiance| -> Result<FogModel> {
        air.model(&FogLight { to_sun: light.direction, sun_irradiance, sky_irradiance, ground_albedo }, &view)
    };
    let model = under(sun, sun_lux, sky_lux)?;
    let [sun_under, mut sky_under] = model.light_at(place.altitude_m).unwrap_or([sun_lux, sky_lux]);
    // By day the moonlight scattered by fog is invisible.
    let seen = smoothstep(1e-4, 2e-4, moon_lux[1] / sky_lux[1].max(f64::MIN_POSITIVE));
    if seen > 0.0 {
        let [_, more] = under(moon, moon_lux, [0.0; 3])?.light_at(place.altitude_m).unwrap_or_default();
        sky_under = [0, 1, 2].map(|i| sky_under[i] + more[i] * seen);
    }
    let share = model.beam_share(moon.direction.z, place.altitude_m);
    Ok([sun_under, [0, 1, 2].map(|i| moon_lux[i] * share[i]), sky_under])
}

impl Scene {
    /// Returns the light on top of the fog: that of the sky, and of the brighter of sun and moon.
    pub(super) fn fog_light(&self) -> FogLight {
        let light = self.brighter();
        let lux = if light == &self.sun { self.above_fog.sun_lux } else { self.above_fog.moon_lux };
        FogLight {
            to_sun: light.direction,
            sun_irradiance: lux,
            sky_irradiance: self.above_fog.sky_lux,
            ground_albedo: self.ground_albedo,
        }
    }

    /// Returns the scene with another low layer.
    pub(super) fn with_fog(&self, fog: GroundLayer) -> Self {
        Self { conditions: Conditions { fog, ..self.conditions }, ..*self }
    }

    /// Returns the viewpoint of the camera in the fog.
    pub(super) fn fog_viewpoint(&self, planet_radius_m: f64) -> Viewpoint {
        viewpoint(&self.place, &self.conditions, self.map_m, planet_radius_m)
    }

    /// Returns the fog that the frame draws, lit by the brighter of sun and moon.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn fog_model(&self, law: Option<&Law>, seed: u64, planet_radius_m: f64) -> Result<FogModel> {
        let (light, view) = (self.fog_light(), self.fog_viewpoint(planet_radius_m));
        if let Some(law) = law {
            return FogModel::new(law, &light, &view);
        }
        let mut model = LowAir::new(&self.conditions, seed, self.drift_m).model(&light, &view)?;
        model.falling.curtains = self.curtains(seed);
        Ok(model)
    }

    /// Returns the curtains of the weather's own rain, relative to the extinction of all that falls.
    fn curtains(&self, seed: u64) -> Curtains {
        let falling = &self.conditions.precipitation;
        let variation = curtain::variation(falling);
        let rain_per_m = falling.liquid_extinction_per_m;
        // Curtains are invisible in very thin rain.
        let shown = variation * rain_per_m * curtain::OWN_LENGTHS_M[1];
        if shown < LEAST_SHOWN {
            return Curtains::NONE;
        }
        // The variance of a cosine is a half.
        let each = variation * (1.0 - LEAST_SHOWN / shown) * (2.0 / CURTAIN_WAVES as f64).sqrt();
        let place = [0, 1].map(|i| self.map_m[i] - self.drift_m[i]);
        let at = DVec3::new(place[0], place[1], self.place.altitude_m + self.curtains_fallen_m);
        let phased = |k: DVec3, phase: f64| (k, (k.dot(at) + phase).rem_euclid(TAU));
        let waves = curtain::waves::<CURTAIN_WAVES>(seed as u32, curtain::OWN_LENGTHS_M)
            .map(|[x, y, z, phase]| phased(DVec3::new(x, y, z), phase));
        Curtains { amount: each * rain_per_m / falling.extinction_per_m(), waves }
    }
}

impl FogModel {
    /// Sets the detour on which the patches flow round obstacles to the wind.
    pub(crate) fn set_detour(&mut self, detour: Option<Detour>) {
        self.detour = detour.filter(|_| self.patch_amount > 0.0);
    }

    /// Returns the optical depth straight up from an altitude. It is 0 for the compatibility laws, which have no height
    /// and do not affect the light above the ground.
    pub(crate) fn depth_above(&self, altitude_m: f64) -> f64 {
        match self.kind {
            FogKind::Clear | FogKind::Slab | FogKind::Exponential => layer_depth_above(self, altitude_m),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::fog::patterns::patch_mean;
    use crate::weather::{FogKind, PrecipitationKind, Weather, derive};

    /// A reported visibility is the total: air, haze, rain and the drawn layer together leave 5 % at that distance.
    #[test]
    fn nothing_is_counted_twice_at_station_height() {
        for (kind, visibility) in [
            (FogKind::None, 20_000.0),
            (FogKind::Mist, 2500.0),
            (FogKind::Fog, 150.0),
            (FogKind::Fog, 50.0),
            (FogKind::Freezing, 700.0),
        ] {
            for (fall, rate) in
                [(PrecipitationKind::None, 0.0), (PrecipitationKind::Rain, 4.0), (PrecipitationKind::Snow, 1.0)]
            {
                let mut w = Weather { visibility_m: visibility, ..Weather::default() };
                w.fog.kind = kind;
                w.precipitation.kind = fall;
                w.precipitation.rate_mm_h = rate;
                let c = derive(&w).unwrap();
                let eye = Viewpoint::flat(c.air.station_altitude_m + 0.5);
                let level = DVec3::X * visibility;
                let layer = LowAir::new(&c, 1, [0.0; 2]).transmittance(&eye, level).unwrap()[1];
                let others = c.air.rayleigh_extinction_per_m + c.aerosol.extinction_per_m;
                let contrast = layer * (-others * visibility).exp();
                assert!((contrast - 0.05).abs() < 1e-6, "{kind:?} {visibility} m {fall:?}: {contrast}");
            }
        }
    }

    /// The pattern has the mean 1, reaches clear gaps, and is as dense inside its patches as `ground_layer` assumes.
    #[test]
    fn patches_hold_the_reported_extinction_inside() {
        let patches = Patches { amount: 1.0, size_m: 100.0, seed: 5, drift_m: [0.0; 2] };
        let layer = FogLayer { patches: Some(patches), ..FogLayer::ground_fog(0.02, 10.0, 1.0) };
        let light =
            FogLight { to_sun: DVec3::Z, sun_irradiance: [1.0; 3], sky_irradiance: [0.2; 3], ground_albedo: [0.1; 3] };
        let m = FogModel::new(&Law::Layer(layer), &light, &Viewpoint::flat(1.0)).unwrap();
        let mut values: Vec<f64> = (0..40_000)
            .map(|i| DVec3::new(f64::from(i % 200) * 37.0, f64::from(i / 200) * 41.0, 0.0))
            .map(|p| patch_mean(&m, p, DVec3::X, 0.0, 0.0))
            .collect();
        values.sort_by(f64::total_cmp);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!(
            (mean - 1.0).abs() < 0.03 && values[0] >= 0.0 && values[400] < 0.1,
            "{mean} {} {}",
            values[0],
            values[400]
        );
        for coverage in [0.4f64, 0.6] {
            let dense = &values[((1.0 - coverage) * values.len() as f64) as usize..];
            let inside = dense.iter().sum::<f64>() / dense.len() as f64;
            assert!((inside / (1.0 - coverage.ln()) - 1.0).abs() < 0.1, "coverage {coverage}: {inside}");
        }
    }
}
