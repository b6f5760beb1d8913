//! The night sky between the stars: airglow, zodiacal light and the Milky Way.

use std::{f64::consts::TAU, sync::OnceLock};

use glam::{DMat3, DVec3};

use super::{
    galaxy::{equator_to_galactic, unresolved_s10},
    light::{MAGNITUDE_0_LUX, color_by_sunlight, transmittance},
    orbits::ecliptic_to_equator,
    places::Heavens,
};

/// Square degrees in a steradian.
const SQUARE_DEGREES_PER_SR: f64 = 3_282.806_35;
/// Luminance of 1 S10 (one star of magnitude 10 a square degree), cd/m^2: the star's illuminance divided by a square
/// degree in sr. It is 8.3e-7 cd/m^2.
pub const S10_CD_M2: f64 = MAGNITUDE_0_LUX * 1e-4 * SQUARE_DEGREES_PER_SR;
/// Airglow at the zenith at night near the minimum of solar activity, S10. Benn and Ellison (1998, La Palma Technical
/// Note 115) give 2.5 times the zodiacal light at the ecliptic's pole.
const AIRGLOW_S10: f64 = 145.0;
/// Height of the glowing layer, m.
const AIRGLOW_HEIGHT_M: f64 = 9e4;
/// Depth below the layer over which the airglow fades for an eye that rises towards it, m (Leinert et al. 1998, section
/// 6).
const AIRGLOW_DEPTH_M: f64 = 1e4;
/// Mean radius of the Earth, m.
const EARTH_RADIUS_M: f64 = 6.371e6;
/// Number of directions that sample the dome of the sky.
const DOME: u32 = 32;
/// Temperature of the black body with the airglow's colour, K: that of the dark sky, B-V = 0.8 (Benn and Ellison 1998).
const AIRGLOW_K: f64 = 5280.0;
/// Temperature of the black body with the colour of zodiacal light, which is the sun's (Leinert et al. 1998, section
/// 8), K.
const ZODIACAL_K: f64 = 5772.0;
/// Temperature of the black body with the colour of faint stars, from their tables ([`super::starlight`]), K.
pub(super) const STARLIGHT_K: f64 = 4900.0;

/// Ecliptic longitudes relative to the sun, and ecliptic latitudes, of the table of zodiacal light, degrees.
const LONGITUDES: [f64; 19] = [
    0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0, 165.0,
    180.0,
];
const LATITUDES: [f64; 11] = [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 45.0, 60.0, 75.0, 90.0];

/// Zodiacal light, S10 of the sun's colour, at 1 au: Leinert et al. 1998, table 16 (after Levasseur-Regourd and Dumont
/// 1980), within 10 %. Within 15 degrees of the sun the table has no values; there the light continues as the
/// elongation to the power -2.3, at most 3e5.
#[rustfmt::skip]
const ZODIACAL_S10: [[f64; 11]; 19] = [
    [300_000.0, 50_000.0, 8_000.0, 2_450.0, 1_260.0, 770.0, 500.0, 215.0, 117.0, 78.0, 60.0],
    [112_600.0, 33_700.0, 6_300.0, 2_300.0, 1_200.0, 740.0, 490.0, 212.0, 117.0, 78.0, 60.0],
    [22_900.0, 11_700.0, 3_700.0, 1_930.0, 1_070.0, 675.0, 460.0, 206.0, 116.0, 78.0, 60.0],
    [9_000.0, 5_300.0, 2_690.0, 1_450.0, 870.0, 590.0, 410.0, 196.0, 114.0, 78.0, 60.0],
    [5_000.0, 3_500.0, 1_880.0, 1_100.0, 710.0, 495.0, 355.0, 185.0, 110.0, 77.0, 60.0],
    [3_000.0, 2_210.0, 1_350.0, 860.0, 585.0, 425.0, 320.0, 174.0, 106.0, 76.0, 60.0],
    [1_940.0, 1_460.0, 955.0, 660.0, 480.0, 365.0, 285.0, 162.0, 102.0, 74.0, 60.0],
    [1_290.0, 990.0, 710.0, 530.0, 400.0, 310.0, 250.0, 151.0, 98.0, 73.0, 60.0],
    [925.0, 735.0, 545.0, 415.0, 325.0, 264.0, 220.0, 140.0, 94.0, 72.0, 60.0],
    [710.0, 570.0, 435.0, 345.0, 278.0, 228.0, 195.0, 130.0, 91.0, 70.0, 60.0],
    [395.0, 345.0, 275.0, 228.0, 190.0, 163.0, 143.0, 105.0, 81.0, 67.0, 60.0],
    [264.0, 248.0, 210.0, 177.0, 153.0, 134.0, 118.0, 91.0, 73.0, 64.0, 60.0],
    [202.0, 196.0, 176.0, 151.0, 130.0, 115.0, 103.0, 81.0, 67.0, 62.0, 60.0],
    [166.0, 164.0, 154.0, 133.0, 117.0, 104.0, 93.0, 75.0, 64.0, 60.0, 60.0],
    [147.0, 145.0, 138.0, 120.0, 108.0, 98.0, 88.0, 70.0, 60.0, 58.0, 60.0],
    [140.0, 139.0, 130.0, 115.0, 105.0, 95.0, 86.0, 70.0, 60.0, 57.0, 60.0],
    [140.0, 139.0, 129.0, 116.0, 107.0, 99.0, 91.0, 75.0, 62.0, 56.0, 60.0],
    [153.0, 150.0, 140.0, 129.0, 118.0, 110.0, 102.0, 81.0, 64.0, 56.0, 60.0],
    [180.0, 166.0, 152.0, 139.0, 127.0, 116.0, 105.0, 82.0, 65.0, 56.0, 60.0],
];

/// Cubic interpolation of values at ascending positions. The slope is continuous, and 0 at both ends, where the table
/// is mirrored. Slopes are those of parabolas through three neighbours (Catmull and Rom 1974, for uneven steps).
fn smooth(places: &[f64], value: impl Fn(usize) -> f64, x: f64) -> f64 {
    let last = places.len() - 1;
    let i = places.partition_point(|a| *a <= x).clamp(1, last) - 1;
    let rise = |i: usize| (value(i + 1) - value(i)) / (places[i + 1] - places[i]);
    let slope = |i: usize| {
        if i == 0 || i == last {
            return 0.0;
        }
        let (before, after) = (places[i] - places[i - 1], places[i + 1] - places[i]);
        (rise(i - 1) * after + rise(i) * before) / (before + after)
    };
    let h = places[i + 1] - places[i];
    let t = ((x - places[i]) / h).clamp(0.0, 1.0);
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * value(i)
        + (t3 - 2.0 * t2 + t) * h * slope(i)
        + (3.0 * t2 - 2.0 * t3) * value(i + 1)
        + (t3 - t2) * h * slope(i + 1)
}

/// Zodiacal light above the air, S10. The direction is given by the ecliptic longitude relative to the sun and the
/// ecliptic latitude, degrees. The logarithm of the table is interpolated with a continuous slope.
pub fn zodiacal_s10(longitude_from_sun_deg: f64, latitude_deg: f64) -> f64 {
    let longitude = (longitude_from_sun_deg + 180.0).rem_euclid(360.0) - 180.0;
    let latitude = latitude_deg.abs().min(90.0);
    static LOGARITHMS: OnceLock<[[f64; 11]; 19]> = OnceLock::new();
    let table = LOGARITHMS.get_or_init(|| ZODIACAL_S10.map(|row| row.map(f64::ln)));
    let row = |i: usize| smooth(&LATITUDES, |j| table[i][j], latitude);
    smooth(&LONGITUDES, row, longitude.abs()).exp()
}

/// Length of a line of sight within the thin glowing layer relative to one straight up (van Rhijn 1921):
/// `1 / (1 - (r/R)^2 sin^2 z)^(1/2)`, where r and R are the distances of eye and layer from the Earth's centre. The eye
/// is below the layer, on or above the ground.
fn van_rhijn(sine_of_elevation: f64, altitude_m: f64) -> f64 {
    let ratio = (EARTH_RADIUS_M + altitude_m) / (EARTH_RADIUS_M + AIRGLOW_HEIGHT_M);
    let sine2 = 1.0 - sine_of_elevation * sine_of_elevation;
    (1.0 - ratio * ratio * sine2).max(1e-3).sqrt().recip()
}

/// Glow of a clear, moonless night sky over a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NightSky {
    /// Rotation from (east, north, up) to the ecliptic of J2000.0, with the sun at longitude 0.
    to_sun_ecliptic: DMat3,
    /// Rotation from (east, north, up) to galactic axes.
    to_galactic: DMat3,
    /// Altitude of the eye above the sea, m, at least 0.
    altitude_m: f64,
    /// Optical depths of the air straight up at the three wavelengths.
    pub(super) zenith_depth: [f64; 3],
    /// Airglow relative to that at the minimum of solar activity.
    airglow: f64,
    /// Colours of airglow, zodiacal light and starlight, with luminance 1.
    pub(super) colors: [[f64; 3]; 3],
    /// Luminance of an infinitely deep layer of lit air, cd/m^2 a channel.
    pub(super) lit_air: [f64; 3],
}

/// Rotation from J2000.0 to the ecliptic with the sun at longitude 0; `sun` is the sun's direction in J2000.0.
pub(super) fn equator_to_sun_ecliptic(sun: DVec3) -> DMat3 {
    let to_ecliptic = ecliptic_to_equator().transpose();
    let sun = to_ecliptic * sun;
    DMat3::from_rotation_z(-sun.y.atan2(sun.x)) * to_ecliptic
}

/// Zodiacal light above the air, S10, in a direction in the axes of [`equator_to_sun_ecliptic`].
pub(super) fn zodiacal_toward(e: DVec3) -> f64 {
    zodiacal_s10(e.y.atan2(e.x).to_degrees(), e.z.clamp(-1.0, 1.0).asin().to_degrees())
}

impl NightSky {
    /// Creates the glow over a place `altitude_m` above the sea, where the air has the optical depths `zenith_depth`
    /// straight up. Below the sea the altitude is taken as 0. `airglow` is the strength of the airglow: 1 at the
    /// minimum of solar activity, 1.7 at the maximum, when the sky is brighter by 0.4 magnitudes (Benn and Ellison
    /// 1998).
    pub fn new(heavens: &Heavens, altitude_m: f64, zenith_depth: [f64; 3], airglow: f64) -> Self {
        Self::under(&heavens.to_world, heavens.sun, altitude_m, zenith_depth, airglow)
    }

    /// Creates the glow as [`Self::new`] does, from the rotation `to_world` from J2000.0 to (east, north, up) and the
    /// sun's direction `sun` in J2000.0.
    pub(super) fn under(to_world: &DMat3, sun: DVec3, altitude_m: f64, zenith_depth: [f64; 3], airglow: f64) -> Self {
        let from_world = to_world.transpose();
        let mut sky = Self {
            to_sun_ecliptic: equator_to_sun_ecliptic(sun) * from_world,
            to_galactic: equator_to_galactic() * from_world,
            altitude_m: altitude_m.max(0.0),
            zenith_depth,
            airglow,
            colors: [AIRGLOW_K, ZODIACAL_K, STARLIGHT_K].map(color_by_sunlight),
            lit_air: [0.0; 3],
        };
        for direction in (0..DOME).map(dome_direction) {
            let above = sky.above_air(direction);
            (0..3).for_each(|k| sky.lit_air[k] += 0.5 * above[k] / f64::from(DOME));
        }
        sky
    }

    /// Airglow, zodiacal light and the Milky Way's unresolved stars above the air, S10, in a direction (east, north,
    /// up; unit). The airglow is what an eye below its layer would see without air between. For an eye that rises
    /// through the last 10 km below the layer the airglow fades to 0, because above the layer nothing of it is left in
    /// front of the stars. The layer seen from above is left out.
    pub fn s10(&self, direction: DVec3) -> [f64; 3] {
        let zodiacal = zodiacal_toward(self.to_sun_ecliptic * direction);
        let layer = van_rhijn(direction.z.max(0.0), self.altitude_m.min(AIRGLOW_HEIGHT_M));
        [self.airglow_s10() * layer, zodiacal, unresolved_s10(self.to_galactic * direction)]
    }

    /// Airglow straight up, S10.
    pub(super) fn airglow_s10(&self) -> f64 {
        AIRGLOW_S10 * self.airglow * ((AIRGLOW_HEIGHT_M - self.altitude_m) / AIRGLOW_DEPTH_M).clamp(0.0, 1.0)
    }

    /// Square of the ratio of the eye's distance from the Earth's centre to that of the airglow layer, at most 1.
    pub(super) fn layer_ratio2(&self) -> f64 {
        ((EARTH_RADIUS_M + self.altitude_m.min(AIRGLOW_HEIGHT_M)) / (EARTH_RADIUS_M + AIRGLOW_HEIGHT_M)).powi(2)
    }

    /// Luminance above the air, cd/m^2 a channel of linear Rec. 709.
    fn above_air(&self, direction: DVec3) -> [f64; 3] {
        let s10 = self.s10(direction);
        std::array::from_fn(|k| S10_CD_M2 * (0..3).map(|i| s10[i] * self.colors[i][k]).sum::<f64>())
    }

    /// Luminance in a direction (east, north, up; unit), cd/m^2 a channel of linear Rec. 709, after the air: `L T + S
    /// (1 - T)`. For directions below the horizon T is the transmittance at the horizon.
    ///
    /// L is the luminance above the air, and T the air's transmittance. S is the light that an infinitely deep layer of
    /// lit air sends: half the mean of the dome, because air scatters equally to all sides, absorbs little, and has the
    /// dome above and dark ground below (Schuster 1905 in its simplest form). A sky without moon is therefore about as
    /// bright at the horizon as at the zenith, and a glow from all sides loses half as much light as a star does.
    pub fn luminance(&self, direction: DVec3) -> [f64; 3] {
        let level = DVec3::new(direction.x, direction.y, direction.z.max(0.0)).normalize_or(DVec3::X);
        let left = transmittance(self.zenith_depth, level.z.asin().to_degrees());
        let above = self.above_air(direction);
        std::array::from_fn(|k| above[k] * left[k] + self.lit_air[k] * (1.0 - left[k]))
    }
}

impl NightSky {
    /// Illuminance of level ground by the glow, lux a channel: the sum over the dome. The catalogue's stars, 6e-5 lux,
    /// are left out.
    pub fn level_lux(&self) -> [f64; 3] {
        (0..DOME).map(dome_direction).fold([0.0; 3], |sum, direction| {
            let luminance = self.luminance(direction);
            std::array::from_fn(|k| sum[k] + luminance[k] * direction.z * TAU / f64::from(DOME))
        })
    }
}

/// Direction `i` of [`DOME`], each with an equal share of the upper hemisphere (a spiral by the golden angle; Swinbank
/// and Purser 2006).
fn dome_direction(i: u32) -> DVec3 {
    let z = (f64::from(i) + 0.5) / f64::from(DOME);
    let (s, c) = (2.399_963_23 * f64::from(i)).sin_cos();
    let level = (1.0 - z * z).sqrt();
    DVec3::new(level * c, level * s, z)
}

#[cfg(test)]
mod tests {
    use super::super::settings::StarSettings;
    use super::*;
    use crate::{almanac::Utc, light::luminance, scene::Place};

    /// Optical depths of clear air at the three wavelengths.
    const CLEAR: [f64; 3] = [0.07, 0.11, 0.24];

    fn night(utc: f64, latitude_deg: f64) -> (Heavens, NightSky) {
        let place = Place { latitude_deg, longitude_deg: 10.0, altitude_m: 0.0 };
        let heavens = Heavens::at(Utc(utc), &place, &StarSettings::default()).unwrap();
        (heavens, NightSky::new(&heavens, 0.0, CLEAR, 1.0))
    }

    fn per_square_arc_second(s10: f64) -> f64 {
        27.782 - 2.5 * s10.log10()
    }

    #[test]
    fn a_tenth_magnitude_star_a_square_degree_is_27_78_a_square_arc_second() {
        assert!((S10_CD_M2 - 8.338e-7).abs() < 1e-9, "{S10_CD_M2}");
        assert!((10.0 + 2.5 * (3600.0f64 * 3600.0).log10() - 27.782).abs() < 1e-3);
    }

    #[test]
    fn zodiacal_light_has_the_values_of_the_table_and_is_symmetric() {
        for (i, l) in LONGITUDES.iter().enumerate() {
            for (j, b) in LATITUDES.iter().enumerate() {
                for (l, b) in [(*l, *b), (-l, *b), (*l, -b), (l + 360.0, *b)] {
                    assert!((zodiacal_s10(l, b) / ZODIACAL_S10[i][j] - 1.0).abs() < 1e-9, "{l} {b}");
                }
            }
        }
    }

    #[test]
    fn zodiacal_light_is_smooth_and_between_its_neighbours() {
        // The ratio of second to first differences over steps of half a degree stays small: there are no kinks and no
        // seams.
        for b in -89..89 {
            for l in 40..320 {
                let (l, b) = (f64::from(l), f64::from(b));
                let [before, here, after] = [-0.5, 0.0, 0.5].map(|d| zodiacal_s10(l + d, b).ln());
                assert!((after - 2.0 * here + before).abs() < 0.006, "{l} {b}");
                let [before, after] = [-0.5, 0.5].map(|d| zodiacal_s10(l, b + d).ln());
                assert!((after - 2.0 * here + before).abs() < 0.02, "{l} {b}");
                assert!((53.0..6000.0).contains(&here.exp()), "{l} {b}: {}", here.exp());
            }
        }
        // The gegenschein is a maximum, and all longitudes agree at the pole.
        assert!(zodiacal_s10(180.0, 0.0) > 1.1 * zodiacal_s10(150.0, 0.0));
        assert!((zodiacal_s10(17.0, 90.0) - 60.0).abs() < 1e-9);
    }

    #[test]
    fn airglow_brightens_towards_the_horizon() {
        // Leinert et al. 1998, section 6, and Roach and Meinel 1955: the factor is 1.9 at 60 degrees from the zenith,
        // and about 6 at the horizon.
        assert_eq!(van_rhijn(1.0, 0.0), 1.0);
        assert!((van_rhijn(0.5, 0.0) - 1.92).abs() < 0.05, "{}", van_rhijn(0.5, 0.0));
        assert!((5.5..6.5).contains(&van_rhijn(0.0, 0.0)), "{}", van_rhijn(0.0, 0.0));
        let (heavens, _) = night(1.7e9, 40.0);
        let above = NightSky::new(&heavens, 2e5, [0.0; 3], 1.0);
        assert_eq!(above.s10(DVec3::Z)[0], 0.0, "no layer above one in orbit");
    }

    #[test]
    fn dark_sites_are_as_dark_as_measured_at_the_zenith() {
        // The range is 21.2 to 22.05 over nights and seasons, with the Milky Way and the zodiacal light (Falchi et al.
        // 2016: 22; Patat 2003: 21.6; Benn and Ellison 1998: 21.9 at high latitudes of both). It is brighter where the
        // Milky Way's star clouds stand overhead.
        let (mut darkest, mut brightest) = (0.0f64, 30.0f64);
        for i in 0..400 {
            let (heavens, sky) = night(1.6e9 + 86_400.0 * 1.37 * f64::from(i), -30.0 + 0.15 * f64::from(i));
            // Only nights count: the sun is far below the horizon.
            if (heavens.to_world * heavens.sun).z > -0.31 {
                continue;
            }
            let m = per_square_arc_second(luminance(&sky.luminance(DVec3::Z)) / S10_CD_M2);
            darkest = darkest.max(m);
            brightest = brightest.min(m);
        }
        println!("zenith from {brightest:.2} to {darkest:.2} mag/arcsec^2");
        assert!((21.7..22.1).contains(&darkest) && (20.9..21.7).contains(&brightest), "{brightest} {darkest}");
    }

    #[test]
    fn the_sky_is_without_seams_from_zenith_to_horizon() {
        let (_, sky) = night(1.7e9, 35.0);
        for azimuth in 0..360 {
            for elevation in 0..89 {
                let at = |a: i32, e: i32| {
                    luminance(&sky.luminance(crate::almanac::celestial::direction(f64::from(a), f64::from(e))))
                };
                let here = at(azimuth, elevation);
                let next = [at(azimuth + 1, elevation), at(azimuth, elevation + 1)];
                assert!((2e-5..4e-3).contains(&here), "{azimuth} {elevation}: {here}");
                let most = if elevation < 4 { 0.2 } else { 0.13 };
                for there in next {
                    assert!((there / here - 1.0).abs() < most, "{azimuth} {elevation}: {here} {there}");
                }
            }
        }
        // Moonless ground receives 0.5 to 1.5 mlux from the sky alone. The dome's few directions represent all.
        let lux = luminance(&sky.level_lux());
        println!("level ground {:.2} mlux", 1e3 * lux);
        assert!((5e-4..1.5e-3).contains(&lux), "{lux}");
        // Horizon and zenith agree within a factor of two. At 1.5 air masses the sky is brighter by 0.25 magnitudes
        // (Benn and Ellison 1998).
        let dome = |e: f64| {
            (0..36)
                .map(|a| luminance(&sky.luminance(crate::almanac::celestial::direction(10.0 * f64::from(a), e))))
                .sum::<f64>()
        };
        let ratio = dome(0.0) / dome(90.0);
        assert!((0.5..2.0).contains(&ratio), "{ratio}");
        let slanting = 2.5 * (dome(41.8) / dome(90.0)).log10();
        assert!((0.1..0.4).contains(&slanting), "{slanting}");
        let at = |e: f64| sky.luminance(crate::almanac::celestial::direction(10.0, e));
        assert!((at(-0.01)[1] / at(0.01)[1] - 1.0).abs() < 1e-3, "no seam at the horizon");
        // Below the horizon the luminance is that of the light from there, seen through the air at the horizon, as
        // pictures show it.
        let (down, left) = (crate::almanac::celestial::direction(10.0, -30.0), transmittance(sky.zenith_depth, 0.0));
        let above = sky.above_air(down);
        let through = [0, 1, 2].map(|k| above[k] * left[k] + sky.lit_air[k] * (1.0 - left[k]));
        assert!((0..3).all(|k| (sky.luminance(down)[k] / through[k] - 1.0).abs() < 1e-9));
    }
}
