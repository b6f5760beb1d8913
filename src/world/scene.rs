//! Scene at a camera's place at a time: lights, air, clouds overhead, and the light on the ground.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::{
    air::planet_under,
    color::color_of,
    lights::{LandSeen, UnderClouds},
    state::World,
};
use crate::{
    error::Result,
    falling::curtain,
    light::luminance,
    moment::{GroundLight, Light, Scene},
    numerics::smoothstep,
    planet::Planet,
    scene::{LocalFrame, Place, WorldKind},
    weather::{CloudLight, Conditions, slab_diffuse_reflectance, slab_reflectance},
    wind::Blowing,
};

/// Luminance of the moonless sky without sunlight, cd/m^2, and its light on level ground, lux. These constants are used
/// while the sun is above the elevations [`NIGHT_BEGINS_DEG`]: both are then less than 1e-4 of the sunlight that the
/// sky scatters. With a lower sun, both follow from [`Couplings::night_lux`](super::Couplings::night_lux).
const UNSEEN_NIGHT_CD_M2: [f64; 3] = [1.9e-4, 1.7e-4, 1.9e-4];
const UNSEEN_NIGHT_LUX: f64 = 8e-4;
/// Elevations of the sun, degrees, between which the computed light of the night replaces [`UNSEEN_NIGHT_CD_M2`] and
/// [`UNSEEN_NIGHT_LUX`].
const NIGHT_BEGINS_DEG: (f64, f64) = (-4.0, -8.0);
/// Night light that [`TWILIGHT_LN_LUX`] contains, lux.
const TABLE_NIGHT_LUX: f64 = 6.4e-4;
/// Clear-sky illuminance on level ground in twilight: sun's elevation in degrees, ln(lux) (Explanatory Supplement to
/// the Astronomical Almanac 1992, table 8.1; the value at -18 contains the night's light).
const TWILIGHT_LN_LUX: [(f64, f64); 6] =
    [(-18.0, -7.34), (-15.0, -6.3), (-12.0, -4.82), (-9.0, -1.9), (-6.0, 1.227), (-0.8, 6.116)];
/// Colour of twilight in linear Rec. 709 of luminance 1: about 11 000 K (Lee & Hernandez-Andres 2003).
const TWILIGHT_COLOR: [f64; 3] = [0.83, 1.0, 1.5];

/// Combines two triples channel by channel.
fn map(a: [f64; 3], b: [f64; 3], f: impl Fn(f64, f64) -> f64) -> [f64; 3] {
    [0, 1, 2].map(|i| f(a[i], b[i]))
}

/// Vertical optical depths per wavelength.
struct ZenithDepths {
    /// Depths of gas by scattering.
    gas: [f64; 3],
    /// Depths of haze by scattering; `soot` has those by absorption.
    haze: [f64; 3],
    soot: [f64; 3],
    /// Depths of ozone by absorption.
    ozone: [f64; 3],
}

impl ZenithDepths {
    /// Creates the depths of the air above `altitude_m`.
    fn new(planet: &Planet, altitude_m: f64) -> Self {
        let h = altitude_m.max(0.0);
        let column = |scale: f64| if scale > 0.0 { scale * libm::exp(-h / scale) } else { 0.0 };
        let (gas, haze) = (column(planet.rayleigh.scale_height_m), column(planet.mie.scale_height_m));
        let tent = &planet.absorption;
        let above = smoothstep(-tent.half_width_m, tent.half_width_m.max(1.0), tent.center_altitude_m - h);
        let mie = &planet.mie;
        Self {
            gas: planet.rayleigh.scattering_per_m.map(|s| s * gas),
            haze: mie.scattering_per_m.map(|s| s * haze),
            soot: map(mie.extinction_per_m, mie.scattering_per_m, |e, s| (e - s).max(0.0) * haze),
            ozone: tent.extinction_per_m.map(|e| e * tent.half_width_m * above),
        }
    }

    /// Returns the depths of gas and haze together.
    fn grey(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.gas[i] + self.haze[i] + self.soot[i])
    }
}

/// Look-ahead times for a change of the weather, s. The sky builds tables for the air at both ends of such a time and
/// mixes them for the air in between. The error of the mix grows with the change of the air's vertical optical depth.
/// The first time over which this depth changes by at most [`AHEAD_DEPTH`] is used, otherwise the last. The last is
/// still far longer than the sky takes to build a draft (small tables, shown until the full ones are built).
const AHEAD_S: [f64; 3] = [20.0, 10.0, 5.0];
/// Largest change of the air's vertical optical depth over a look-ahead time other than the last.
const AHEAD_DEPTH: f64 = 0.15;

/// Albedo of the grey ground to which the eye adapts, and the albedo that replaces it on snow-covered ground. Snow of
/// albedo 0.8 then appears two stops above grey, as photographers place it (Adams 1981, The Negative: zone VII).
const GROUND_KEY: f64 = 0.18;
const SNOW_KEY: f64 = 0.2;
/// Longest path of scattered light through absorbing haze, in vertical thicknesses: light of a low sun leaves its
/// slanted path when it is scattered. Fitted to sums of radiance over computed skies.
const LONGEST_WAY: f64 = 4.0;
/// Luminous efficacy of sun and sky together, lm/W (Muneer 1997).
const LUX_PER_W_M2: f64 = 110.0;

/// Returns the vertical optical depth of all air above `altitude_m`, per wavelength.
pub(crate) fn zenith_depth(planet: &Planet, altitude_m: f64) -> [f64; 3] {
    let depths = ZenithDepths::new(planet, altitude_m);
    map(depths.grey(), depths.ozone, |s, o| s + o)
}

/// Returns the share of night in twilight: 0 by day, 1 at night.
pub(crate) fn night_share(sun: &Light) -> f64 {
    let elevation = libm::asin(sun.direction.z.clamp(-1.0, 1.0)).to_degrees();
    1.0 - smoothstep(NIGHT_BEGINS_DEG.1, NIGHT_BEGINS_DEG.0, elevation)
}

/// Returns the relative air mass at a true elevation (Kasten & Young 1989), at most 50. Below -0.8 degrees it stays 50.
fn air_mass(elevation_deg: f64) -> f64 {
    let h = elevation_deg.max(-0.8);
    1.0 / (libm::sin(h.to_radians()) + 0.505_72 * libm::pow(h + 6.079_95, -1.6364)).max(0.02)
}

/// Returns the light, lux per channel, of a source of `spectrum` above clear air over ground of an `albedo`: (direct on
/// a surface that faces the source, sky on level ground).
///
/// By day the sky's share is the light that the two-stream slab (Meador & Weaver 1980) transmits diffusely, with the
/// ground's light that the slab sends back. Below 5 degrees it blends into measured twilight. At elevations of at least
/// 6 degrees and visibilities of at least 3 km, it is within 6 % of the light of the drawn sky
/// (`tests/frame/radiance.rs`).
fn clear_light(
    (planet, color): (&Planet, &[[f64; 3]; 3]),
    (altitude_m, albedo): (f64, [f64; 3]),
    elevation_deg: f64,
    spectrum: [f64; 3],
) -> ([f64; 3], [f64; 3]) {
    let depths = ZenithDepths::new(planet, altitude_m);
    let mass = air_mass(elevation_deg);
    // From a height the horizon lies lower and the sun sets later.
    let h = altitude_m.max(0.0);
    let dip = libm::atan((h * (h + 2.0 * planet.bottom_radius_m)).sqrt() / planet.bottom_radius_m).to_degrees();
    let up = smoothstep(-0.9, -0.25, elevation_deg + dip);
    let lux = map(spectrum, depths.ozone, |l, t| l * libm::exp(-t * mass));
    let direct = map(lux, depths.grey(), |l, t| l * libm::exp(-t * mass) * up);
    let mu = libm::sin(elevation_deg.to_radians()).max(0.08);
    let day = [0, 1, 2].map(|i| {
        let depth = depths.gas[i] + depths.haze[i];
        let asymmetry = planet.mie.asymmetry_g * depths.haze[i] / depth.max(f64::MIN_POSITIVE);
        let kept = lux[i] * mu * libm::exp(-depths.soot[i] * (1.0 / mu).min(LONGEST_WAY));
        let through = 1.0 - slab_reflectance(depth, asymmetry, mu);
        let back = albedo[i] * slab_diffuse_reflectance(depth, asymmetry);
        kept * ((through - libm::exp(-depth / mu)).max(0.0) + through * back / (1.0 - back))
    });
    let (first, last) = (TWILIGHT_LN_LUX[0], TWILIGHT_LN_LUX[5]);
    let h = elevation_deg.clamp(first.0, last.0);
    let i = TWILIGHT_LN_LUX.iter().rposition(|p| p.0 <= h).unwrap_or(0).min(4);
    let (a, b) = (TWILIGHT_LN_LUX[i], TWILIGHT_LN_LUX[i + 1]);
    let ln = a.1 + (b.1 - a.1) * (h - a.0) / (b.0 - a.0);
    let dusk = TWILIGHT_COLOR.map(|c| c * (libm::exp(ln) - TABLE_NIGHT_LUX).max(0.0) * spectrum[1]);
    let t = smoothstep(-0.8, 5.0, elevation_deg);
    (color_of(color, direct).map(|v| v.max(0.0)), map(dusk, color_of(color, day), |n, d| n + (d.max(0.0) - n) * t))
}

/// Returns the light above all clouds at `altitude_m` over a scene's place, lux per channel: direct light on a surface
/// facing the sun or moon, and the sky's light on level ground, with the night's light. The direct light is that of
/// [`Scene::brighter`], which is decided at the scene's own place.
pub(crate) fn light_above_clouds(scene: &Scene, altitude_m: f64) -> ([f64; 3], [f64; 3]) {
    let one = |light: &Light| {
        let elevation = libm::asin(light.direction.z.clamp(-1.0, 1.0)).to_degrees();
        // The ground's light is left out: the clouds add it themselves.
        clear_light((&scene.planet, &scene.color), (altitude_m, [0.0; 3]), elevation, light.spectrum)
    };
    let ((sun, sun_sky), (moon, moon_sky)) = (one(&scene.sun), one(&scene.moon));
    let direct = if scene.brighter() == &scene.sun { sun } else { moon };
    (direct, [0, 1, 2].map(|i| sun_sky[i] + moon_sky[i] + PI * scene.night_floor_cd_m2[i]))
}

/// Returns the luminance to which a viewer adapts: grey ground under `total` lux, and a share of the sky. With the sun
/// near the horizon, pictures mostly show the part of the sky around the sun, which is many times brighter than the
/// mean. Above the air they show the sunlit planet, whatever the sun's elevation over the place.
fn adaptation(total: f64, sky: f64, direct: f64, sun: &Light, altitude_m: f64) -> f64 {
    let elevation = libm::asin(sun.direction.z.clamp(-1.0, 1.0)).to_degrees();
    let low = (1.0 - smoothstep(0.0, 30.0, elevation)) * smoothstep(-12.0, -4.0, elevation);
    let dusk = 1.0 - smoothstep(-5.0, 1.0, elevation);
    let ground = GROUND_KEY * total / PI + (0.35 + low * (2.0 + 4.0 * dusk)) * sky / PI;
    ground + (0.15 * direct / PI - ground).max(0.0) * smoothstep(10e3, 80e3, altitude_m)
}

/// Returns the mean share of sunlight, direct and diffuse, that the clouds let through to the air below them. The light
/// that this air scatters is reduced to the same share.
fn medium_share(left: &CloudLight) -> f64 {
    (left.direct + left.diffuse).clamp(0.0, 1.0)
}

impl World {
    /// Returns the scene from which a camera at `position` draws at simulation time `time_s`, past or future. Closed
    /// form; no device is used.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is not a place on or above the planet, or the weather is not
    /// known at the time. Errors call the position `name`.
    pub fn scene_named(&self, name: &str, position: DVec3, time_s: f64) -> Result<Scene> {
        Ok(self.scene_and_wind(name, position, time_s)?.0)
    }

    /// Returns the scene of [`World::scene_named`], with the wind if it had to be computed.
    pub(super) fn scene_and_wind(&self, name: &str, position: DVec3, time_s: f64) -> Result<(Scene, Option<Blowing>)> {
        self.frame.place_at(name, position)?;
        let conditions = self.weather_at(position, time_s)?;
        let land = self.land(&conditions);
        self.scene_over((name, position), time_s, conditions, &land)
    }

    /// Returns two weathers over a place: one with the clouds of the host's map, `None` without a map, and one with the
    /// clouds of rain areas as well, `None` if no such clouds stand over the place. `map_m` is the place, m east and
    /// north of the world's origin.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time at which the weather is not known.
    pub(crate) fn clouds_over(
        &self,
        conditions: &Conditions,
        local: &LocalFrame,
        position: DVec3,
        map_m: DVec2,
        time_s: f64,
    ) -> Result<[Option<Conditions>; 2]> {
        let mapped = self.set.cloud_map.as_ref().map(|map| conditions.under_map(map, map_m));
        let brought = (self.couplings.cloud_over_areas)(&self.over(), conditions, (local, position), time_s)?;
        let under_areas = brought.map(|slab| mapped.as_ref().unwrap_or(conditions).with_layer(slab));
        Ok([mapped, under_areas])
    }

    /// Returns the planet with the air that it will have at `position` after one of the times [`AHEAD_S`], when the
    /// timeline or moving regions have changed the weather. `now` is the planet with the air of the present weather.
    /// `None` if no change of the timeline is under way and there are no weather regions, or if the weather is not
    /// known at these times.
    pub fn planet_ahead(&self, position: DVec3, now: &Planet) -> Option<Planet> {
        let now_s = self.time_s;
        if !self.timeline.changes_between(now_s, now_s) && self.set.weather_regions.is_empty() {
            return None;
        }
        let after = |ahead_s: &f64| Some(self.planet_under(&self.weather_at(position, now_s + ahead_s).ok()?));
        let depth = |planet: &Planet| zenith_depth(planet, 0.0)[1];
        let [all @ .., last] = &AHEAD_S;
        let serves = |planet: &Planet| (depth(planet) - depth(now)).abs() <= AHEAD_DEPTH;
        all.iter().filter_map(after).find(serves).or_else(|| after(last))
    }

    /// Returns the scene in the weather `conditions` over `land`, with the wind if it had to be computed.
    fn scene_over(
        &self,
        (name, position): (&str, DVec3),
        time_s: f64,
        conditions: Conditions,
        land: &LandSeen,
    ) -> Result<(Scene, Option<Blowing>)> {
        let local = self.frame.place_at(name, position)?;
        let bare = planet_under(&self.set.planet, &conditions);
        let (planet, ground_albedo) = (land.under_sky(bare), land.albedo_on(&bare));
        let map_m = self.map_place(position, &local);
        // The lights shine through all clouds over the place, those of rain areas included. Everything else follows the
        // weather and the host's cloud map.
        let [mapped, under_areas] =
            self.clouds_over(&conditions, &local, position, DVec2::from_array(map_m), time_s)?;
        let shown = mapped.as_ref().unwrap_or(&conditions);
        let overhead = under_areas.as_ref().unwrap_or(shown);
        let lights = self.lights_over(&local.place, (overhead, land.albedo), time_s)?;
        let (night_floor_cd_m2, night_lux) = self.night(&planet, &local.place, &lights[0].0, time_s)?;
        let (above_fog, moon_is_brighter) =
            self.ground_light((&planet, &local.place), (overhead, ground_albedo), &lights, night_lux);
        let [(sun, under_sun), (moon, _)] = lights;
        // Only patches and curtains show the displacement of the air.
        let patchy = conditions.fog.is_patchy();
        let curtained = curtain::variation(&conditions.precipitation) > 0.0;
        let wind = (patchy || curtained).then(|| self.over().wind_at(time_s)).transpose()?;
        // The cloud effect draws broken cloud; a closed deck is drawn by the sky effect.
        let deck_cover = smoothstep(0.55, 0.95, shown.opaque_cover(local.place.altitude_m));
        let mut scene = Scene {
            place: local.place,
            world_to_enu: local.world_to_enu,
            map_m,
            drift_m: wind.map_or([0.0; 2], |wind| wind.drift.displacement_m.to_array()),
            curtains_fallen_m: curtain::fallen_m(time_s),
            color: self.set.color,
            planet,
            sun,
            moon,
            night_floor_cd_m2,
            deck_cd_m2: above_fog.sky_lux.map(|e| e * 9.0 / (7.0 * PI)),
            deck_cover,
            medium_share: medium_share(&under_sun),
            moon_is_brighter,
            ground: above_fog,
            ground_albedo,
            above_fog,
            conditions,
        };
        if !self.set.undimmed {
            (self.couplings.dim)(&mut scene)?;
        }
        for light in [&mut scene.ground, &mut scene.above_fog] {
            light.adaptation_cd_m2 += land.snow * (SNOW_KEY - GROUND_KEY) * light.total_lux / PI;
        }
        Ok((scene, wind))
    }

    /// Returns the light of sun, moon and sky on level ground at the world's origin, in whole W/m^2. Rounding
    /// differences between machines in the drawn light must not change a state.
    pub fn sunlight_w_m2(&self, time_s: f64) -> Result<f64> {
        let frame = &self.frame;
        let origin = if frame.kind == WorldKind::Ecef { frame.position_of(&frame.origin) } else { DVec3::ZERO };
        // The simulated snow is left out: a state must not depend on how far another state has advanced.
        let conditions = self.timeline.at(time_s);
        let land = LandSeen::reported(&conditions);
        let (scene, _) = self.scene_over(("position", origin), time_s, conditions, &land)?;
        Ok((scene.ground.total_lux / LUX_PER_W_M2).round())
    }

    /// Returns where a position lies on the world's map, m east and north of the world's origin. On a round planet the
    /// map is equirectangular, with lengths true at the latitude of the origin. `local` is the local frame of the
    /// position.
    pub fn map_place(&self, position: DVec3, local: &LocalFrame) -> [f64; 2] {
        let p = &local.place;
        let o = &self.frame.origin;
        match self.frame.kind {
            WorldKind::Flat => {
                let enu = local.world_to_enu * position;
                [enu.x, enu.y]
            }
            _ => {
                let metres_per_deg = self.set.planet.bottom_radius_m.to_radians();
                let east = (p.longitude_deg - o.longitude_deg) * libm::cos(o.latitude_deg.to_radians());
                [east * metres_per_deg, (p.latitude_deg - o.latitude_deg) * metres_per_deg]
            }
        }
    }

    /// Returns where a position in the host's world lies on the map of [`World::map_place`], m east and north of the
    /// world's origin.
    pub fn map_at(&self, position: DVec3) -> DVec2 {
        DVec2::from_array(self.map_place(position, &self.frame.frame_at(position)))
    }

    /// Returns the position in the host's world of a place on the map, at an altitude: the inverse of
    /// [`World::map_at`].
    pub fn position_on_map(&self, map_m: DVec2, altitude_m: f64) -> DVec3 {
        let o = &self.frame.origin;
        if self.frame.kind == WorldKind::Flat {
            let to_enu = self.frame.frame_at(DVec3::ZERO).world_to_enu;
            return to_enu.transpose() * map_m.extend(altitude_m - o.altitude_m);
        }
        let metres_per_deg = self.set.planet.bottom_radius_m.to_radians();
        let east_m = metres_per_deg * libm::cos(o.latitude_deg.to_radians()).max(1e-6);
        let place = Place {
            latitude_deg: (o.latitude_deg + map_m.y / metres_per_deg).clamp(-90.0, 90.0),
            longitude_deg: o.longitude_deg + map_m.x / east_m,
            altitude_m,
        };
        self.frame.position_of(&place)
    }

    /// Returns the mean luminance of the moonless sky, cd/m^2, and its light on level ground, lux, per channel.
    fn night(&self, planet: &Planet, place: &Place, sun: &Light, time_s: f64) -> Result<([f64; 3], [f64; 3])> {
        let day = UNSEEN_NIGHT_CD_M2.map(|v| v / luminance(&UNSEEN_NIGHT_CD_M2) * UNSEEN_NIGHT_LUX);
        let share = night_share(sun);
        if share == 0.0 {
            return Ok((UNSEEN_NIGHT_CD_M2, day));
        }
        let depth = zenith_depth(planet, place.altitude_m);
        let lux = (self.couplings.night_lux)(self.utc_at(time_s), place, depth, &self.night)?;
        let between = |a: f64, b: f64| a + (b - a) * share;
        Ok((map(UNSEEN_NIGHT_CD_M2, lux.map(|e| e / PI), between), map(day, lux, between)))
    }

    /// Returns the light on the ground, and whether, without clouds, the moon would give more direct light than the
    /// sun.
    fn ground_light(
        &self,
        (planet, place): (&Planet, &Place),
        (c, albedo): (&Conditions, [f64; 3]),
        lights: &[UnderClouds; 2],
        night_lux: [f64; 3],
    ) -> (GroundLight, bool) {
        let cloud_top_m = c.lit_top_m(place.altitude_m);
        let one = |(light, clouds): &UnderClouds| {
            let elevation = libm::asin(light.direction.z.clamp(-1.0, 1.0));
            let planet = (planet, &self.set.color);
            let at = |altitude_m| clear_light(planet, (altitude_m, albedo), elevation.to_degrees(), light.spectrum);
            let (direct, sky) = at(place.altitude_m);
            // Light that clouds transmit diffusely fell on their tops, through less air.
            let (on_top, _) = at(cloud_top_m);
            let level = light.direction.z.max(0.0);
            let diffuse = map(on_top, sky, |d, s| s * clouds.sky + d * level * clouds.diffuse);
            (direct[1], direct.map(|d| d * clouds.direct), diffuse)
        };
        let ((sun_clear, sun_lux, sun_sky), (moon_clear, moon_lux, moon_sky)) = (one(&lights[0]), one(&lights[1]));
        let sky_lux = [0, 1, 2].map(|i| sun_sky[i] + moon_sky[i] + night_lux[i]);
        let light = GroundLight::new([sun_lux, moon_lux, sky_lux], [&lights[0].0, &lights[1].0], place.altitude_m);
        (light, moon_clear > sun_clear)
    }
}

impl GroundLight {
    /// Sums the light of sun, moon and sky that arrives at a place, lux.
    pub(crate) fn new([sun_lux, moon_lux, sky_lux]: [[f64; 3]; 3], [sun, moon]: [&Light; 2], altitude_m: f64) -> Self {
        let total_lux = luminance(&sky_lux)
            + luminance(&sun_lux) * sun.direction.z.max(0.0)
            + luminance(&moon_lux) * moon.direction.z.max(0.0);
        let adaptation_cd_m2 = adaptation(total_lux, luminance(&sky_lux), luminance(&sun_lux), sun, altitude_m);
        Self { sun_lux, moon_lux, sky_lux, total_lux, adaptation_cd_m2 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::color::color_columns;
    use super::*;

    fn lux(elevation_deg: f64) -> f64 {
        static EARTH: std::sync::LazyLock<(Planet, [[f64; 3]; 3])> =
            std::sync::LazyLock::new(|| (Planet::earth(), color_columns(&Planet::earth())));
        let (planet, color) = &*EARTH;
        let (direct, sky) = clear_light((planet, color), (0.0, planet.ground_albedo), elevation_deg, [1.0; 3]);
        luminance(&direct) * elevation_deg.to_radians().sin().max(0.0) + luminance(&sky)
    }

    #[test]
    fn clear_sky_illuminance_follows_the_almanacs() {
        // Explanatory Supplement 1992, table 8.1 (clear, sea level): elevation, lux.
        for (h, want) in [(60.0, 102_000.0), (30.0, 52_600.0), (10.0, 10_900.0), (-6.0, 3.41), (-12.0, 8.06e-3)] {
            let got = lux(h);
            // The table's air is hazier than the default planet's, which shows most with a low sun.
            assert!((got / want).ln().abs() < 0.4, "{h}: {got} lux, want {want}");
        }
    }

    #[test]
    fn illuminance_rises_with_the_sun_without_a_jump() {
        let mut last = lux(-20.0);
        for i in 1..2200 {
            let now = lux(-20.0 + 0.05 * f64::from(i));
            assert!(
                now >= last * 0.999 && now < (last + 1e-5) * 1.2,
                "{}: {last} to {now}",
                -20.0 + 0.05 * f64::from(i)
            );
            last = now;
        }
    }
}
