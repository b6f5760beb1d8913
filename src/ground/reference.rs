//! Reflection of light by water, in f64: the reference of `shaders/ground/optics.wgsl`, with the same names and order
//! of parameters.

pub use crate::chance::normal_quantile;
use std::f64::consts::PI;

use glam::DVec3;

use crate::falling::sizes::DropSizes;

/// Refractive index of water relative to air, for visible light at 20 C (Hale and Querry 1973, rounded).
pub const WATER_INDEX: f64 = 1.333;
/// Share of diffuse light from above that a level water surface reflects back up: Fresnel's law integrated over the
/// hemisphere.
pub const WATER_OUTSIDE: f64 = 0.0664;
/// Share of diffuse light from below that the surface reflects back down.
pub const WATER_INSIDE: f64 = 0.4746;

/// Returns the share of unpolarised light that water reflects, \[0, 1\], at an angle of incidence with this cosine
/// (Fresnel 1823).
pub fn fresnel_water(cosine: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt() / WATER_INDEX;
    let inside = (1.0 - sine * sine).sqrt();
    let across = (cosine - WATER_INDEX * inside) / (cosine + WATER_INDEX * inside);
    let along = (WATER_INDEX * cosine - inside) / (WATER_INDEX * cosine + inside);
    0.5 * (across * across + along * along)
}

/// Returns the factor by which a film dims the light that a rough ground of this albedo (\[0, 1\]) sends up: e (1 - p)
/// / (1 - p a), with albedo a, p = [`WATER_INSIDE`] and e = `entering`, the share of the light from above that enters
/// the water (Angstrom 1925; Lekner & Dorf 1988, eq. 1 to 3).
pub fn wet_share(albedo: f64, entering: f64) -> f64 {
    entering * (1.0 - WATER_INSIDE) / (1.0 - WATER_INSIDE * albedo)
}

/// Returns the albedo of a wet ground of this dry albedo under light at normal incidence, including the reflection at
/// the water's surface.
pub fn wet_albedo(albedo: f64) -> f64 {
    let mirrored = fresnel_water(1.0);
    mirrored + albedo * wet_share(albedo, 1.0 - mirrored)
}

/// Returns the mean slope, towards the eye, of the facets that the eye sees. `slope` is the root mean square slope of
/// the surface along one axis, normally distributed; `tangent` is the tangent of the eye's zenith angle. For steep
/// views the mean is slope^2 `tangent`; for grazing views it is sqrt(pi / 2) slope, the mean of the facets weighted by
/// their own slope.
pub fn seen_slope(slope: f64, tangent: f64) -> f64 {
    let t = slope * tangent * (2.0 / PI).sqrt();
    slope * slope * tangent / (1.0 + t * t).sqrt()
}

/// Returns the projected area of a unit of rough surface in a direction with the zenith cosine c: sqrt(c^2 + (0.4
/// slope)^2 (1 - c^2)). The second term is that of tilted facets at grazing views.
pub fn seen_area(slope: f64, cosine: f64) -> f64 {
    let c = cosine.max(0.0);
    (c * c + 0.16 * slope * slope * (1.0 - c * c)).sqrt()
}

/// Returns the luminance of the glitter of a lamp of illuminance 1 on rough water, divided by the Fresnel share (Cox &
/// Munk 1954, eq. 5, with the shadowing of facets by each other). `normal` is that of the surface, `facet` the normal
/// of the facet that reflects the lamp's centre into the eye, `disc2` = (angular radius of the lamp / 4)^2, rad^2.
pub fn glitter(slope: f64, disc2: f64, normal: DVec3, facet: DVec3, to_eye: DVec3, to_lamp: DVec3) -> f64 {
    let (c, lit, seen) = (normal.dot(facet), normal.dot(to_lamp), normal.dot(to_eye));
    let area = seen_area(slope, seen) * seen_area(slope, lit);
    if c <= 0.0 || lit <= 0.0 || area <= 1e-6 {
        return 0.0;
    }
    let tilt = facet / c - normal;
    let along = tilt.dot((to_eye - normal * seen).normalize_or_zero()).powi(2);
    let across = (tilt.length_squared() - along).max(0.0);
    let opening = facet.dot(to_eye).max(1e-3);
    let [s, t] = [disc2, disc2 / (opening * opening)].map(|d| d + slope * slope);
    let density = libm::exp(-0.5 * (along / s + across / t)) / ((s * t).sqrt() * 2.0 * PI * c.powi(4));
    density * lit / (4.0 * area)
}

/// Returns the number of drops larger than [`RING_DIAMETER_MM`] that land on a square metre of level ground per second.
pub fn ring_drops_per_m2_s(sizes: &DropSizes) -> f64 {
    let slowest = sizes.speed_m_s(RING_DIAMETER_MM);
    sizes.on_surface_of(DVec3::Z, DVec3::ZERO, |falls_m_s| falls_m_s > slowest).drops_per_m2_s
}

/// Diameter above which a drop makes a ring that is drawn, mm.
pub const RING_DIAMETER_MM: f64 = 1.8;

/// Returns the density of the standard normal distribution.
pub fn normal_density(x: f64) -> f64 {
    libm::exp(-0.5 * x * x) / (2.0 * PI).sqrt()
}

/// Returns the cumulative standard normal distribution.
pub fn normal_share(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn water_mirrors_as_fresnel_says() {
        // n = 1.333, unpolarised: angle of incidence in degrees, reflected share.
        let table = [
            (0.0, 0.02037),
            (45.0, 0.02790),
            (60.0, 0.05969),
            (70.0, 0.13348),
            (80.0, 0.34792),
            (85.0, 0.58352),
            (89.0, 0.89628),
        ];
        for (deg, want) in table {
            let got = fresnel_water(f64::to_radians(deg).cos());
            assert!((got - want).abs() < 1e-5, "{deg}: {got}, want {want}");
        }
    }

    #[test]
    fn diffuse_shares_are_fresnel_over_the_half_space() {
        // From above, 2 int F(mu) mu dmu; from below, 1 - (1 - outside) / n^2 by reciprocity.
        let n = 20_000;
        let mean: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) / f64::from(n))
            .map(|mu| 2.0 * mu * fresnel_water(mu) / f64::from(n))
            .sum();
        assert!((mean - WATER_OUTSIDE).abs() < 5e-4, "{mean}");
        let inside = 1.0 - (1.0 - WATER_OUTSIDE) / (WATER_INDEX * WATER_INDEX);
        assert!((inside - WATER_INSIDE).abs() < 5e-4, "{inside}");
    }

    #[test]
    fn wet_ground_darkens_as_angstrom_says() {
        for (dry, wet) in [(0.1, 0.074), (0.2, 0.134), (0.3, 0.200), (0.5, 0.358), (0.8, 0.684)] {
            let got = wet_albedo(dry);
            assert!((got - wet).abs() < 1e-3, "{dry}: {got}, want {wet}");
        }
    }

    #[test]
    fn facets_seen_are_the_mean_over_the_slopes() {
        // Mean of z max(0, 1 + z tan) over that of max(0, 1 + z tan); z is normal with the slope as its standard
        // deviation.
        for slope in [0.02, 0.1, 0.3] {
            for tangent in [0.1, 1.0, 5.0, 50.0] {
                let (mut sum, mut weight, mut n) = (0.0, 0.0, 0.0);
                for i in -4000..=4000 {
                    let z = f64::from(i) * 2e-3;
                    let p = (-0.5 * z * z).exp();
                    let w = p * (1.0 + z * slope * tangent).max(0.0);
                    (sum, weight, n) = (sum + w * z * slope, weight + w, n + p);
                }
                let got = seen_slope(slope, tangent);
                assert!((got / (sum / weight) - 1.0).abs() < 0.16, "{slope} {tangent}: {got} {}", sum / weight);
                let cosine = 1.0 / f64::hypot(1.0, tangent);
                let area = cosine * weight / n;
                let got = seen_area(slope, cosine);
                assert!((got / area - 1.0).abs() < 0.16, "{slope} {tangent}: {got} {area}");
            }
        }
    }

    #[test]
    fn more_rain_and_larger_drops_make_more_rings() {
        let of = |rate| ring_drops_per_m2_s(&DropSizes::of_rain(rate, 1.0));
        let rates = [0.1, 0.5, 1.0, 5.0, 10.0, 50.0, 100.0].map(of);
        assert!(rates.windows(2).all(|r| r[1] > 1.5 * r[0]), "{rates:?}");
        let sizes = DropSizes::of_rain(5.0, 1.0);
        let (step, mut number) = (1e-3, 0.0);
        for i in 1800..6000 {
            let d = (f64::from(i) + 0.5) * step;
            number += sizes.number_between(d - 0.5 * step, d + 0.5 * step) * sizes.speed_m_s(d);
        }
        assert!((rates[3] / number - 1.0).abs() < 1e-3, "{} {number}", rates[3]);
        assert_eq!(of(0.0), 0.0);
    }

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (p, z) in [(0.5, 0.0), (0.975, 1.959_964), (0.01, -2.326_348), (0.3, -0.524_401)] {
            assert!((normal_quantile(p) - z).abs() < 1e-6, "{p}: {}", normal_quantile(p));
        }
    }
}
