//! Air, sky and fog: transmittance between two places, the sky's light and its tables, and fog laws.
//!
//! Queries are computed in f64 for any place and time. They need no device and no frame, except
//! [`Context::ambient_at`], which reads the sky's tables. Positions are in the host's world.

use std::sync::MutexGuard;

use glam::DVec3;

use crate::{
    clouds::CloudRays,
    context::{Context, Light, Scene},
    error::{Error, Result, Status},
    fog::{Between, CONTRAST_THRESHOLD, Law, LowAir, Viewpoint, koschmieder_visibility_m},
    sky::{
        FollowedSky, LightTable, Planet, Sh9, SkyLibrary, SkySettings,
        reference::{medium::Medium, ray::Ray},
    },
    world::color_of,
};

impl Context {
    /// Returns the share of light, per channel, that passes from `from` to `to` at simulation time `time_s`, and the
    /// visibility that this share gives. Air, fog, rain and snow take light away, and so do clouds that are drawn as a
    /// volume. For rain areas the share is the mean over their curtains.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if a position is invalid, or the two are less than a millimetre apart; for
    /// times as [`Context::conditions_at`].
    pub fn between(&self, from: DVec3, to: DVec3, time_s: f64) -> Result<Between> {
        let scene = self.world.scene_named("from", from, time_s)?;
        self.world.frame.place_at("to", to)?;
        let offset = scene.world_to_enu * (to - from);
        let distance = offset.length();
        if distance < 1e-3 {
            return Err(Error::range("to", "at least a millimetre from the other end", to));
        }
        let clouds = self.cloud_rays((&scene, from), time_s)?;
        let through = self.through(&scene, clouds.as_ref(), from, offset, time_s)?;
        // Negating the logarithm of 1 would give -0.
        let mean = through[1].max(f64::MIN_POSITIVE).ln().abs() / distance;
        Ok(Between { transmittance: through, visibility_m: koschmieder_visibility_m(mean) })
    }

    /// Returns the slant visual range, m: the distance at which a black object along `direction` is just visible from
    /// `position`, at simulation time `time_s`. `direction` is a unit vector (east, north, up) there. At that distance
    /// [`Context::between`] leaves 5 % of the light of 550 nm, and the object's contrast falls to 5 %. Air, fog, rain,
    /// snow, rain areas, and clouds drawn as a volume take light away. Infinite if more than 5 % is left where the ray
    /// leaves the air or meets the planet's ground.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid or the direction is not a unit vector; for times
    /// as [`Context::conditions_at`].
    pub fn visibility_toward(&self, position: DVec3, direction: DVec3, time_s: f64) -> Result<f64> {
        let scene = self.scene_at(position, time_s)?;
        let unit = unit_vector("direction", direction)?;
        let medium = Medium::of(&scene.planet);
        let Some((_, end, _)) = Ray::new(&medium, scene.place.altitude_m, unit.z).in_air(&medium) else {
            return Ok(f64::INFINITY);
        };
        let clouds = self.cloud_rays((&scene, position), time_s)?;
        let is_seen =
            |d: f64| Ok(self.through(&scene, clouds.as_ref(), position, unit * d, time_s)?[1] > CONTRAST_THRESHOLD);
        let (mut near, mut far) = (0.0, 1f64.min(end));
        while is_seen(far)? {
            if far >= end {
                return Ok(f64::INFINITY);
            }
            (near, far) = (far, (2.0 * far).min(end));
        }
        while far - near > 1e-9 * far {
            let middle = 0.5 * (near + far);
            if is_seen(middle)? { near = middle } else { far = middle }
        }
        Ok(far)
    }

    /// Returns the transmittance per channel over `offset` metres (east, north, up) from a scene's place.
    fn through(
        &self,
        scene: &Scene,
        clouds: Option<&CloudRays<'_>>,
        start: DVec3,
        offset: DVec3,
        time_s: f64,
    ) -> Result<[f64; 3]> {
        let through = match self.depths_through_regions(scene, start, offset, time_s)? {
            Some(depths) => depths.map(|depth| (-depth).exp()),
            None => self.through_even_air(scene, start, offset, time_s)?,
        };
        let clouds = clouds.map_or(0.0, |clouds| clouds.depth(offset));
        let left = (-clouds - self.areas_depth(start, offset, time_s, &scene.conditions)?).exp();
        Ok(through.map(|t| (t * left).min(1.0)))
    }

    /// Returns the transmittance per channel of air, haze, fog and precipitation as they are at a scene's place, over
    /// `offset` metres (east, north, up) from there.
    fn through_even_air(&self, scene: &Scene, start: DVec3, offset: DVec3, time_s: f64) -> Result<[f64; 3]> {
        let distance = offset.length();
        let medium = Medium::of(&scene.planet);
        let ray = Ray::new(&medium, scene.place.altitude_m, offset.z / distance);
        let mut through = medium.transmittance(&ray.columns(&medium, 0.0, distance));
        let detour = self.world.detour(start, &scene.conditions, time_s);
        let low = LowAir::new(&scene.conditions, self.world.seed, scene.drift_m).with_detour(detour);
        if !low.is_clear() {
            let view = Viewpoint {
                altitude_m: scene.place.altitude_m,
                map_m: scene.map_m,
                planet_radius_m: scene.planet.bottom_radius_m,
                ..Viewpoint::flat(0.0)
            };
            let fog = low.transmittance(&view, offset)?;
            through = [0, 1, 2].map(|i| through[i] * fog[i]);
        }
        Ok(through)
    }

    /// Returns the sky's light on surfaces of any slope at `position` and simulation time `time_s`: nine spherical
    /// harmonics of radiance, cd/m^2 per channel, in (east, north, up) of the place. The lower half is the lit ground.
    /// Clouds dim and whiten the sky.
    ///
    /// The query reads the sky's tables: it builds them first if no frame did. The first query after each change of the
    /// tables waits for the GPU. The pattern of the clear sky is that of the air in the tables; the overall brightness,
    /// clouds and fog are those of `time_s`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is invalid; for times as [`Context::conditions_at`];
    /// [`crate::Status::DeviceLost`] or a GPU fault.
    pub fn ambient_at(&self, position: DVec3, time_s: f64) -> Result<Sh9> {
        let scene = self.scene_at(position, time_s)?;
        let table = self.light_table(&scene.planet)?;
        let clear = |light: &Light| -> (Sh9, f32) {
            let sh = table.sh9(scene.place.altitude_m, light.direction.to_array());
            let colored = |c: [f32; 3]| {
                let lit = [0, 1, 2].map(|i| f64::from(c[i]) * light.spectrum[i]);
                color_of(&scene.color, lit).map(|v| v as f32)
            };
            (sh.map(colored), colored(table.irradiance(scene.place.altitude_m, light.direction.z))[1])
        };
        let ((sun, sun_e), (moon, moon_e)) = (clear(&scene.sun), clear(&scene.moon));
        // Clouds and fog replace the clear sky's pattern by a uniform sky, which has the light that they let through.
        let through = if scene.ground != scene.above_fog {
            let above = Viewpoint::flat(scene.place.altitude_m);
            LowAir::even(&scene.conditions).transmittance(&above, DVec3::Z * 1e5)?[1]
        } else {
            1.0
        };
        let cover = 1.0 - (1.0 - scene.deck_cover as f32) * through as f32;
        let even = scene.ground.sky_lux.map(|e| (e / std::f64::consts::PI) as f32);
        let clear_e = (sun_e + moon_e).max(1e-9);
        let keep = (1.0 - cover) * (scene.ground.sky_lux[1] as f32 / clear_e).min(1.0);
        let mut sh: Sh9 = std::array::from_fn(|k| [0, 1, 2].map(|i| (sun[k][i] + moon[k][i]) * keep));
        let kept = keep * clear_e / scene.ground.sky_lux[1].max(1e-9) as f32;
        add_even_sky(&mut sh, even.map(|u| u * (1.0 - kept).max(0.0)), scene.ground_albedo);
        Ok(sh)
    }

    /// Draws one of the older simulators' fog laws in place of the weather's fog; `None` returns to the weather's fog.
    /// While a law is set, no fog dims the light of sun, moon and sky.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn set_fog_law(&mut self, law: Option<Law>) -> Result<()> {
        law.as_ref().map_or(Ok(()), Law::validate)?;
        self.held.fog.law = law;
        self.world.set.undimmed = law.is_some();
        Ok(())
    }

    /// Returns the fog law that the host has set.
    pub fn fog_law(&self) -> Option<&Law> {
        self.held.fog.law.as_ref()
    }

    /// Locks the sky's tables of the context.
    pub(crate) fn sky(&self) -> Result<MutexGuard<'_, FollowedSky>> {
        self.held
            .sky
            .lock()
            .map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked while building the sky"))
    }

    /// Builds the sky's tables for the present weather now, in sixteen parts with a wait for the GPU after each, and
    /// puts them into use, so that no frame has to build them. It reuses tables that another context of the device uses
    /// or that lie in [`ContextDesc::cache_dir`](crate::context::ContextDesc::cache_dir), and writes new ones there.
    /// `progress` receives the completed share, which is 1 at the end. If it returns false, the build ends and the
    /// context stays as it was.
    ///
    /// # Errors
    /// [`Status::Aborted`], [`Status::DeviceLost`], or a GPU fault.
    pub fn build_sky(&self, progress: &mut dyn FnMut(f32) -> bool) -> Result<()> {
        let planet = self.world.planet_under(&self.world.timeline.at(self.world.time_s));
        planet.check()?;
        // The sky's lock is not held here: frames and queries of other threads continue during the build.
        let kit = self.sky()?.kit().clone();
        let set = kit.build(&planet, self.sky()?.cache_dir().as_deref(), progress)?;
        let _entered = self.device().enter()?;
        self.sky()?.show_now(set)
    }

    /// Replaces the planet: air, ground and sun. The sky's tables follow as after a change of the weather, by a draft
    /// that fades in within sixteen frames. If the planet's radius, the top of its air or its wavelengths differ, the
    /// next frame cuts to a draft of the new planet, and later ones refine it. Remaining steps of the simulated ground
    /// still use the previous planet.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; nothing changes then.
    pub fn set_planet(&mut self, planet: &Planet) -> Result<()> {
        self.world.set_planet(*planet)
    }

    /// Sets how the sky is drawn. Views use the new tables from their next frame on, which shows a draft like a first
    /// frame, unless [`Context::build_sky`] has built the tables. An existing plan stays. Setting the same settings
    /// again changes nothing.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field, [`crate::Status::DeviceLost`], or a GPU fault; nothing
    /// changes then.
    pub fn set_sky_settings(&mut self, settings: &SkySettings) -> Result<()> {
        let library = self.shared().get(|| Ok(SkyLibrary::default()))?;
        let device = self.device().clone();
        let _entered = device.enter()?;
        self.sky()?.set_settings(&device, &library, settings)
    }

    /// Returns the settings of the sky.
    ///
    /// # Errors
    /// [`crate::Status::Poisoned`] after a panic.
    pub fn sky_settings(&self) -> Result<SkySettings> {
        Ok(*self.sky()?.settings())
    }

    /// Returns the table of a planet's sky light, built at its first use.
    fn light_table(&self, planet: &crate::sky::Planet) -> Result<std::sync::Arc<LightTable>> {
        let device = self.device().clone();
        let _entered = device.enter()?;
        self.sky()?.light_table(&device, planet)
    }
}

/// Largest deviation of a direction's length from 1.
const LENGTH_OFF: f64 = 1e-3;

/// Checks a host's direction and normalises it to length 1.
pub(super) fn unit_vector(name: &str, direction: DVec3) -> Result<DVec3> {
    let length = direction.length();
    if (length - 1.0).abs() < LENGTH_OFF {
        return Ok(direction / length);
    }
    Err(Error::range(name, "a unit vector (east, north, up)", direction))
}

/// Adds a sky of uniform radiance `u` above the horizon, and below the horizon a ground of albedo `albedo` that this
/// sky lights.
fn add_even_sky(sh: &mut Sh9, u: [f32; 3], albedo: [f64; 3]) {
    // Integrals of the basis over the upper half: Y00 sqrt(pi), Y10 sqrt(3 pi)/2, the zonal Y20 vanishes.
    let (y00, y10) = (std::f32::consts::PI.sqrt(), (3.0 * std::f32::consts::PI).sqrt() / 2.0);
    for i in 0..3 {
        let below = u[i] * albedo[i] as f32;
        sh[0][i] += (u[i] + below) * y00;
        sh[2][i] += (u[i] - below) * y10;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_sky_lights_a_level_surface_by_pi_times_its_radiance() {
        let mut sh: Sh9 = [[0.0; 3]; 9];
        add_even_sky(&mut sh, [1.0; 3], [0.0; 3]);
        // Irradiance from the harmonics, Ramamoorthi & Hanrahan 2001: A0 = pi, A1 = 2 pi/3; facing up,
        // Y10 = sqrt(3/(4 pi)).
        let pi = std::f32::consts::PI;
        let up = pi * sh[0][0] * 0.5 / pi.sqrt() + 2.0 * pi / 3.0 * sh[2][0] * (3.0 / (4.0 * pi)).sqrt();
        assert!((up - pi).abs() < 1e-4, "{up}");
    }
}
