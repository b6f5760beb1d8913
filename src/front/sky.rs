//! The sky's radiance towards a direction, as a query in f64. It follows the composition of pixels in which the host
//! drew nothing (`shaders/frame/composite.wgsl`, `shaders/between/veil.wgsl`).

use std::{cell::OnceCell, sync::Arc};

use glam::DVec3;

use super::air::unit_vector;
use crate::{
    bow,
    clouds::CloudRays,
    context::{Context, Light, Scene},
    error::Result,
    fog::{FogSample, SkyBanks},
    scene::depth::RANGE_SKY_M,
    sky::{Sightline, SolvedSkies, SolvedSky},
    stars::NightBehind,
    world::color_of,
};

/// Distance of fog, m, below which the air in front of the fog is ignored.
const NEAR_FOG_M: f64 = 50.0;
/// Ratio E / (pi L) of an overcast sky: E is the illuminance of level ground, L the luminance of the zenith (Moon and
/// Spencer 1942).
const UNDER_DECK: f64 = 7.0 / 9.0;

impl Context {
    /// Returns the radiance of the sky at `position` towards `directions`, unit vectors (east, north, up) there, at
    /// simulation time `time_s`: cd/m^2 per channel of linear Rec. 709, as a picture shows it where the host drew
    /// nothing. It includes clear air, clouds, fog, the weather's precipitation, bows, the night's glow and, below the
    /// horizon, the planet's ground. It leaves out the discs of the sun and the moon, stars and planets, rain areas,
    /// and the host's objects.
    ///
    /// Clear air comes from its f64 reference, at three wavelengths. The first call in a new state of the air solves
    /// it; that takes a second or two, during which other threads that call this function wait. The last four solutions
    /// are kept for all contexts of the device.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid or a direction is not a unit vector; for times as
    /// [`Context::conditions_at`].
    pub fn sky_radiance(&self, position: DVec3, directions: &[DVec3], time_s: f64) -> Result<Vec<[f64; 3]>> {
        let scene = self.scene_at(position, time_s)?;
        let toward = |i: usize| unit_vector(&format!("directions[{i}]"), directions[i]);
        let units = (0..directions.len()).map(toward).collect::<Result<Vec<_>>>()?;
        if units.is_empty() {
            return Ok(Vec::new());
        }
        let skies = self.shared().get(|| Ok(SolvedSkies::default()))?;
        let law = self.fog_law();
        let detour = self.world.detour(position, &scene.conditions, time_s);
        let world = &self.world;
        let fog_of = |scene: &Scene| scene.fog_model(law, world.seed, world.set.planet.bottom_radius_m);
        let fog_depth = fog_of(&scene)?.depth_above(scene.place.altitude_m);
        // A fog law of the host holds at all places alike.
        let regions = if law.is_some() { &[][..] } else { &world.set.weather_regions[..] };
        let outer = world.outer_fog(&scene.conditions, time_s)?;
        let fog = SkyBanks::new(regions, &world.frame, (&scene, position), time_s, outer, |scene| {
            let mut fog = fog_of(scene)?;
            fog.set_detour(detour);
            Ok(fog)
        })?;
        let night = NightBehind::new(&scene, self.world.utc_at(time_s), self.stars(), fog_depth)?;
        let clouds = self.cloud_rays((&scene, position), time_s)?;
        let bows = bow::in_low_air(&scene.conditions).filter(|_| bow::is_lit(&scene));
        let seen = DirectionLight { skies: &skies, solved: OnceCell::new(), scene: &scene, fog, bows, night, clouds };
        units.into_iter().map(|d| Ok(seen.with_fog(d)?.to_array())).collect()
    }
}

/// Returns the luminance of an overcast sky by elevation, 1 at the zenith (CIE S 011, the standard overcast sky).
fn overcast_gradation(sin_elevation: f64) -> f64 {
    (1.0 + 2.0 * sin_elevation.max(0.0)) / 3.0
}

/// Inputs of the radiance towards a direction.
struct DirectionLight<'a> {
    skies: &'a SolvedSkies,
    solved: OnceCell<Arc<SolvedSky>>,
    scene: &'a Scene,
    fog: SkyBanks<'a>,
    /// Bows of the drops, where there is light to show them.
    bows: Option<bow::Table>,
    night: NightBehind,
    /// Clouds, if the model draws them as a volume.
    clouds: Option<CloudRays<'a>>,
}

impl DirectionLight<'_> {
    /// Returns the lamps (sun, moon) that light the picture.
    fn lamps(&self) -> impl Iterator<Item = &Light> {
        [&self.scene.sun, &self.scene.moon].into_iter().filter(|light| light.matters)
    }

    /// Returns the clear sky. It is solved at the first use, because a closed deck or dense fog may hide all of it.
    fn clear(&self) -> Result<&SolvedSky> {
        if let Some(solved) = self.solved.get() {
            return Ok(solved);
        }
        let solved = self.skies.of(&self.scene.planet)?;
        Ok(self.solved.get_or_init(|| solved))
    }

    /// Returns the ray through the clear air in a direction, lit by a lamp.
    fn line(&self, direction: DVec3, lamp: &Light) -> Sightline {
        let altitude_m = self.scene.place.altitude_m.clamp(-1e4, 1e8);
        Sightline { altitude_m, direction, to_lamp: lamp.direction }
    }

    /// Returns the colour of light at the planet's wavelengths, clipped to Rec. 709 as in a picture.
    fn color(&self, spectrum: [f64; 3]) -> DVec3 {
        DVec3::from_array(color_of(&self.scene.color, spectrum)).max(DVec3::ZERO)
    }

    /// Returns the share of the sky above the horizon that is drawn as a deck.
    fn deck_share(&self) -> f64 {
        self.clouds.as_ref().map_or(self.scene.deck_cover, |clouds| f64::from(u8::from(clouds.has_deck)))
    }

    /// Returns the sky behind all fog, with the clouds in front of it: `before_sky` of the composition.
    fn behind(&self, d: DVec3) -> Result<DVec3> {
        let Some(clouds) = &self.clouds else { return self.open(d) };
        let seen = clouds.seen(d, RANGE_SKY_M);
        let open = self.open(d)? * seen.transmittance;
        if seen.transmittance >= 1.0 {
            return Ok(open);
        }
        let (air, through) = self.air(d, seen.distance_m)?;
        Ok(open + seen.light * through + air * (1.0 - seen.transmittance))
    }

    /// Returns the sky behind fog and clouds: `behind_all` of the composition.
    fn open(&self, d: DVec3) -> Result<DVec3> {
        let (scene, deck_share) = (self.scene, self.deck_share());
        let deck = DVec3::from_array(scene.deck_cd_m2);
        let above = deck * overcast_gradation(d.z);
        if d.z >= 0.0 && deck_share >= 1.0 {
            return Ok(above);
        }
        let mut spectrum = [0.0; 3];
        for lamp in self.lamps() {
            let seen = self.clear()?.radiance(&self.line(d, lamp))?;
            (0..3).for_each(|i| spectrum[i] += lamp.spectrum[i] * seen[i]);
        }
        let (clear, night) = (self.color(spectrum), DVec3::from_array(self.night.toward(d)));
        if d.z < 0.0 {
            let under_deck = deck * self.ground_under_deck(d)?;
            return Ok((clear * scene.medium_share).lerp(under_deck, scene.deck_cover) + night);
        }
        Ok((clear + night).lerp(above, deck_share))
    }

    /// Returns the luminance of the ground with the air in front of it, divided by that of a closed deck's zenith:
    /// `ground_under_deck` of the shaders.
    fn ground_under_deck(&self, d: DVec3) -> Result<DVec3> {
        let Some(lamp) = self.lamps().next() else { return Ok(DVec3::ZERO) };
        let along = self.clear()?.whole(&self.line(d, lamp))?;
        let through = DVec3::from_array(along.transmittance);
        let albedo = if along.ground { self.scene.planet.ground_albedo } else { [0.0; 3] };
        let air = DVec3::splat(overcast_gradation(0.0)) * (DVec3::ONE - through);
        Ok(air + DVec3::from_array(albedo) * UNDER_DECK * through)
    }

    /// Returns the light of the air up to `distance_m`, and its transmittance: `air_on` of the shaders.
    fn air(&self, d: DVec3, distance_m: f64) -> Result<(DVec3, DVec3)> {
        let (mut spectrum, mut through) = ([0.0; 3], [1.0; 3]);
        for lamp in self.lamps() {
            let (light, left) = self.clear()?.aerial(&self.line(d, lamp), distance_m)?;
            (0..3).for_each(|i| spectrum[i] += lamp.spectrum[i] * light[i]);
            through = left;
        }
        let through = DVec3::from_array(through);
        let lit = |v: [f64; 3]| DVec3::from_array(v) * (DVec3::ONE - through);
        let clear = self.color(spectrum) * self.scene.medium_share;
        let under_deck = lit(self.scene.deck_cd_m2) * overcast_gradation(0.0);
        Ok((clear.lerp(under_deck, self.scene.deck_cover) + lit(self.scene.night_floor_cd_m2), through))
    }

    /// Returns the radiance of a pixel of the sky, as `with_fog` of the shaders.
    fn with_fog(&self, d: DVec3) -> Result<DVec3> {
        let fog = self.fog.along(d, RANGE_SKY_M)?;
        let through = fog.banks.iter().fold(fog.outer.transmittance, |left, bank| left * bank.transmittance);
        // Where the fog lets nothing through, the sky behind it is not needed.
        let behind = if through.max_element() > 0.0 { self.behind(d)? } else { DVec3::ZERO };
        let mut sky = self.with_outer(d, &fog.outer, FarLight { light: behind, through: DVec3::ONE })?;
        for bank in &fog.banks {
            let mut before = self.air_before(d, bank)?;
            if bank.distance > NEAR_FOG_M {
                before = self.with_outer(d, &self.fog.along(d, bank.distance)?.outer, before)?;
            }
            sky = with_layer(bank, bank.radiance, &before, &sky);
        }
        Ok(sky.light)
    }

    /// Returns the light of the air in front of a layer of fog.
    fn air_before(&self, d: DVec3, fog: &FogSample) -> Result<FarLight> {
        if fog.distance <= NEAR_FOG_M {
            return Ok(FarLight { light: DVec3::ZERO, through: DVec3::ONE });
        }
        let (light, through) = self.air(d, fog.distance)?;
        Ok(FarLight { light, through })
    }

    /// Lays the fog outside all banks over what is behind it.
    fn with_outer(&self, d: DVec3, fog: &FogSample, far: FarLight) -> Result<FarLight> {
        let bow = self.bows.as_ref().map_or(DVec3::ZERO, |table| bow::phase_in(table, d, self.fog.to_sun()));
        Ok(with_layer(fog, (fog.radiance + fog.once * bow).max(DVec3::ZERO), &self.air_before(d, fog)?, &far))
    }
}

/// Light that some media on a ray send towards the eye, and the transmittance of these media.
struct FarLight {
    light: DVec3,
    through: DVec3,
}

/// Lays a layer of fog over the light `back` behind the layer. The layer itself scatters `radiance`. The air in front
/// of the layer is `veil`.
fn with_layer(fog: &FogSample, radiance: DVec3, veil: &FarLight, back: &FarLight) -> FarLight {
    let beyond = back.light * fog.shade - veil.light;
    FarLight {
        light: veil.light + veil.through * radiance + fog.transmittance * beyond,
        through: back.through * fog.transmittance,
    }
}
