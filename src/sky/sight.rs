//! Visibility through clear air: sunlight at a point, and the line of sight between two points. Computed in f64 at
//! once, without tables or a device, for any planet. Other rooms add fog, clouds and precipitation.

use std::f64::consts::PI;

use super::reference::medium::Medium;
use super::reference::ray::Ray;
use super::reference::sun::{disc_strips, sun_transmittance};
use crate::error::{Error, Result, check_range};
use crate::planet::Planet;

/// Contrast below which a black target cannot be seen against the horizon sky, by definition of the meteorological
/// optical range (WMO).
pub const LEAST_CONTRAST: f64 = 0.05;

/// Number of strips of the sun's disc. The light of a half-set sun is within 0.3 % of that with 200 strips.
const STRIPS: usize = 24;

/// Depth below the ground's sphere down to which a line of sight is not hidden, m. Two points on the ground of the
/// Earth therefore see each other if they are less than 225 m apart.
const GRAZE_M: f64 = 1e-3;

/// Sunlight at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sunlight {
    /// Irradiance of a surface facing the sun, per wavelength, in the unit of [`Planet::solar_irradiance`].
    pub irradiance: [f64; 3],
    /// Share of the irradiance above the air that the air lets through and the ground does not hide.
    pub transmittance: [f64; 3],
    /// Share of the disc above the horizon, `[0, 1]`.
    pub visible_share: f64,
}

/// Line of sight between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Straight-line distance, m.
    pub distance_m: f64,
    /// Whether the planet's sphere hides one point from the other.
    pub hidden: bool,
    /// Transmittance of the air, per wavelength of the planet; 0 if hidden.
    pub transmittance: [f64; 3],
    /// Contrast of a black target against the horizon sky behind it (Koschmieder 1924): the transmittance at 550 nm; 0
    /// if hidden.
    pub contrast: f64,
}

impl Sight {
    /// Whether a black target can be seen: it is not hidden, and its contrast is at least `least_contrast` (usually
    /// [`LEAST_CONTRAST`]).
    pub fn is_visible(&self, least_contrast: f64) -> bool {
        !self.hidden && self.contrast >= least_contrast
    }
}

/// Computes the sunlight at an altitude for a geometric zenith angle of the sun (radians, `[0, pi]`). The sun is a disc
/// that sets behind the sphere; refraction is left out.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a planet, an altitude (`[-1e5, 1e12]` m) or an angle out of range.
pub fn sunlight(planet: &Planet, altitude_m: f64, sun_zenith: f64) -> Result<Sunlight> {
    planet.check()?;
    check_range("altitude_m", altitude_m, -1e5, 1e12, "m")?;
    check_range("sun_zenith", sun_zenith, 0.0, PI + 1e-12, "rad")?;
    let medium = Medium::of(planet);
    let mut out = Sunlight { irradiance: [0.0; 3], transmittance: [0.0; 3], visible_share: 0.0 };
    for (zenith, share) in disc_strips(sun_zenith, planet.sun_angular_radius_deg.to_radians(), STRIPS) {
        let mu_s = zenith.clamp(0.0, PI).cos();
        if super::reference::ray::sun_hidden(&medium, altitude_m, mu_s) {
            continue;
        }
        let t = sun_transmittance(&medium, altitude_m, mu_s);
        out.visible_share += share;
        (0..3).for_each(|c| out.transmittance[c] += share * t[c]);
    }
    out.irradiance = std::array::from_fn(|c| out.transmittance[c] * planet.solar_irradiance[c]);
    out.visible_share = out.visible_share.min(1.0);
    Ok(out)
}

/// Computes the line of sight from one point to another. Positions are in metres from the planet's centre, in any axes.
/// The ground is the sphere of the bottom radius. If the lower point is below this sphere, the sphere is lowered to
/// that point.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a planet out of range, or for a position that is not finite, farther than
/// 1e12 m, or deeper than 1e5 m below the ground's sphere.
pub fn sight(planet: &Planet, from_m: [f64; 3], to_m: [f64; 3]) -> Result<Sight> {
    planet.check()?;
    let altitude = |name: &str, p: &[f64; 3]| -> Result<f64> {
        let r = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        let h = r - planet.bottom_radius_m;
        if h.is_finite() && (-1e5..=1e12).contains(&h) && r > 0.0 {
            return Ok(h);
        }
        Err(Error::range(name, "a place from 1e5 m below the ground's sphere to 1e12 m", format!("{p:?}")))
    };
    let (h, h_to) = (altitude("from_m", &from_m)?, altitude("to_m", &to_m)?);
    let way: [f64; 3] = std::array::from_fn(|i| to_m[i] - from_m[i]);
    let distance_m = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    if distance_m == 0.0 {
        return Ok(Sight { distance_m, hidden: false, transmittance: [1.0; 3], contrast: 1.0 });
    }
    let medium = Medium::of(planet);
    let mu = way.iter().zip(&from_m).map(|(w, p)| w * p).sum::<f64>() / distance_m / (medium.bottom_m + h);
    let ray = Ray::new(&medium, h, mu);
    // The lowest point of the line counts only if it lies between the ends.
    let to_perigee = -ray.radius_m() * ray.mu;
    let dips = to_perigee > 0.0 && to_perigee < distance_m;
    let hidden = dips && ray.perigee_altitude_m() < h.min(h_to).min(0.0) - GRAZE_M;
    if hidden {
        return Ok(Sight { distance_m, hidden, transmittance: [0.0; 3], contrast: 0.0 });
    }
    let columns = ray.columns(&medium, 0.0, distance_m);
    let green = Medium::of(&planet.at_wavelengths([550.0; 3]));
    Ok(Sight {
        distance_m,
        hidden,
        transmittance: medium.transmittance(&columns),
        contrast: (-green.optical_depth(&columns)[0]).exp(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const R: f64 = 6_371_000.0;

    /// Position at an altitude, `distance` along the ground from the pole.
    fn place(altitude: f64, distance: f64) -> [f64; 3] {
        let a = distance / R;
        [(R + altitude) * a.sin(), 0.0, (R + altitude) * a.cos()]
    }

    fn fog(visibility_m: f64) -> Planet {
        let mut planet = Planet::earth();
        let total = -LEAST_CONTRAST.ln() / visibility_m;
        let haze = total - planet.rayleigh.scattering_per_m[1];
        planet.mie.extinction_per_m = [haze; 3];
        planet.mie.scattering_per_m = [haze; 3];
        planet
    }

    #[test]
    fn black_target_at_the_optical_range_is_at_the_threshold() {
        // The air is curved and stratified. The eye is 2 m up and looks horizontally, so the target at 50 km is 198 m
        // above the ground. Therefore a little more than 5 % arrives (haze with a scale height of 1.2 km).
        for (visibility, contrast) in [(50.0, 0.05), (5000.0, 0.0503), (50_000.0, 0.0572)] {
            let level = [visibility, 0.0, R + 2.0];
            let seen = sight(&fog(visibility), place(2.0, 0.0), level).unwrap();
            assert!((seen.contrast - contrast).abs() < 3e-4, "{visibility}: {}", seen.contrast);
            assert!(!seen.hidden && seen.is_visible(0.0499) && !seen.is_visible(0.06));
        }
        let sunk = sight(&fog(5000.0), place(0.0, 0.0), place(0.0, 5000.0)).unwrap();
        assert!(sunk.hidden && !sunk.is_visible(0.0) && sunk.contrast == 0.0, "the chord of two points on a sphere");
    }

    #[test]
    fn the_sphere_hides_what_is_beyond_the_horizon() {
        // Two eyes at 100 m see each other over almost twice 35.7 km.
        let reach = 2.0 * f64::sqrt(2.0 * R * 100.0);
        let clear = Planet::earth();
        assert!(!sight(&clear, place(100.0, 0.0), place(100.0, 0.999 * reach)).unwrap().hidden);
        assert!(sight(&clear, place(100.0, 0.0), place(100.0, 1.001 * reach)).unwrap().hidden);
        assert!(!sight(&clear, place(-20.0, 0.0), place(-20.0, 10.0)).unwrap().hidden, "in a pit");
    }

    #[test]
    fn both_ends_see_the_same_air() {
        let planet = fog(20_000.0);
        let (a, b) = (place(12_000.0, 0.0), place(3.0, 90_000.0));
        let (there, back) = (sight(&planet, a, b).unwrap(), sight(&planet, b, a).unwrap());
        assert!((there.contrast / back.contrast - 1.0).abs() < 1e-6 && there.contrast < 1.0);
        let nothing = sight(&planet, place(2e6, 0.0), [-(R + 2e6), 0.0, 4e6]).unwrap();
        assert_eq!((nothing.transmittance, nothing.contrast), ([1.0; 3], 1.0));
        assert_eq!(sight(&planet, a, a).unwrap().contrast, 1.0);
    }

    #[test]
    fn the_sun_sets_by_parts() {
        let planet = Planet::earth();
        let at = |deg: f64| sunlight(&planet, 0.0, deg.to_radians()).unwrap();
        assert!((at(90.0).visible_share - 0.5).abs() < 0.03);
        assert_eq!((at(90.3).visible_share, at(90.3).irradiance), (0.0, [0.0; 3]));
        assert!((at(30.0).visible_share - 1.0).abs() < 1e-12);
        let mut before = 1.1;
        for i in 0..=60 {
            let now = at(89.7 + 0.01 * f64::from(i));
            assert!(now.transmittance[0] < before || before == 0.0, "falls without a step up");
            assert!(now.transmittance[0] >= now.transmittance[2], "red goes last");
            before = now.transmittance[0];
        }
        // From an aeroplane the sun is visible after it has set on the ground.
        assert!(sunlight(&planet, 11_000.0, 92f64.to_radians()).unwrap().visible_share > 0.99);
    }

    #[test]
    fn wrong_numbers_are_refused_by_name() {
        let planet = Planet::earth();
        assert!(sunlight(&planet, f64::NAN, 0.0).unwrap_err().to_string().contains("altitude_m"));
        assert!(sunlight(&planet, 0.0, 4.0).unwrap_err().to_string().contains("sun_zenith"));
        assert!(sight(&planet, [0.0; 3], place(0.0, 0.0)).unwrap_err().to_string().contains("from_m"));
        assert!(sight(&planet, place(0.0, 0.0), [f64::INFINITY; 3]).unwrap_err().to_string().contains("to_m"));
    }
}
