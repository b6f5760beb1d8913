//! Optics of sea water: index, reflectance of flat and rough surfaces, attenuation by water type, scattering.

use serde::{Deserialize, Serialize};

/// Eight of the optical water types of Jerlov (1976), from the clearest ocean to a turbid coast.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum WaterType {
    /// Ocean I: the clearest.
    I,
    /// Ocean IB.
    IB,
    /// Ocean II.
    II,
    /// Ocean III.
    III,
    /// Coast 1C.
    Coast1,
    /// Coast 3C.
    Coast3,
    /// Coast 5C.
    Coast5,
    /// Coast 7C: the most turbid of the eight.
    Coast7,
}

impl WaterType {
    /// All types, from clear to turbid.
    pub const ALL: [Self; 8] =
        [Self::I, Self::IB, Self::II, Self::III, Self::Coast1, Self::Coast3, Self::Coast5, Self::Coast7];

    /// Returns the diffuse attenuation of downward light, 1/m, at 450, 550 and 650 nm (Jerlov 1976; Solonenko and
    /// Mobley 2015, table 3).
    pub fn diffuse_attenuation_per_m(self) -> [f64; 3] {
        match self {
            Self::I => [0.019, 0.063, 0.36],
            Self::IB => [0.036, 0.072, 0.375],
            Self::II => [0.068, 0.089, 0.40],
            Self::III => [0.135, 0.12, 0.445],
            Self::Coast1 => [0.25, 0.12, 0.45],
            Self::Coast3 => [0.39, 0.19, 0.46],
            Self::Coast5 => [0.56, 0.30, 0.54],
            Self::Coast7 => [0.89, 0.46, 0.63],
        }
    }
}

/// Returns the refractive index of water against air for a salinity, g/kg, a temperature, degrees Celsius, and a
/// wavelength, nm (Quan and Fry 1995, equation 3; fitted for 0 to 35 g/kg, 0 to 30 C, 400 to 700 nm).
pub fn refractive_index(salinity_g_kg: f64, temperature_c: f64, wavelength_nm: f64) -> f64 {
    let (s, t, l) = (salinity_g_kg, temperature_c, wavelength_nm);
    1.31405 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t + (15.868 + 0.01155 * s - 0.00423 * t) / l
        - 4382.0 / (l * l)
        + 1.1455e6 / (l * l * l)
}

/// Returns the reflectance for unpolarised light that meets a flat surface at an angle of cosine `cos_incidence`, by
/// Fresnel's equations. The refractive index of the medium beyond the surface is `index` times that of the medium in
/// front of it. The reflectance is 1 beyond the critical angle.
pub fn fresnel_reflectance(cos_incidence: f64, index: f64) -> f64 {
    let cos = cos_incidence.clamp(0.0, 1.0);
    let inner = 1.0 - (1.0 - cos * cos) / (index * index);
    if inner <= 0.0 {
        return 1.0;
    }
    let refracted = index * inner.sqrt();
    let across = (cos - refracted) / (cos + refracted);
    let along = (index * index * cos - refracted) / (index * index * cos + refracted);
    0.5 * (across * across + along * along)
}

/// Returns the reflectance of a flat surface for diffuse light: the mean of [`fresnel_reflectance`] over the hemisphere
/// of directions, weighted by the cosine of incidence.
pub fn diffuse_reflectance(index: f64) -> f64 {
    let steps = 4000u32;
    let at = |i: u32| libm::sqrt((f64::from(i) + 0.5) / f64::from(steps));
    (0..steps).map(|i| fresnel_reflectance(at(i), index)).sum::<f64>() / f64::from(steps)
}

/// Returns the mean reflectance of a rough surface seen at an angle of cosine `cos_view` from the vertical: facets with
/// slopes of the variance `mean_square` (both axes together, the same in all directions), each weighted by the area
/// that it shows to the eye, without shadowing. Towards the horizon it is far below that of flat water, because facets
/// that face the eye are seen most.
pub fn mean_reflectance(cos_view: f64, mean_square: f64, index: f64) -> f64 {
    reflectance_by_steps((cos_view, 0.5 * mean_square), index, 48)
}

/// Returns the mean reflectance for the variance of slopes along one axis, integrated over 6 standard deviations on
/// both sides. Along the view the integral takes `steps` pairs of steps by Simpson's rule, up to where facets turn away
/// from the eye. Across the view it takes `steps` trapezoids on one side. The error of trapezoids falls exponentially
/// with their number here, because the integrand is smooth and fades out like a Gaussian.
fn reflectance_by_steps((cos_view, variance): (f64, f64), index: f64, steps: i32) -> f64 {
    let cos = cos_view.clamp(0.0, 1.0);
    let sin = (1.0 - cos * cos).sqrt();
    let deviation = variance.sqrt();
    if deviation < 1e-6 {
        return fresnel_reflectance(cos, index);
    }
    let (mut reflected, mut shown) = (0.0, 0.0);
    let last = if cos < 6.0 * deviation * sin { cos / (deviation * sin) } else { 6.0 };
    for i in 0..=2 * steps {
        let along = -6.0 + (last + 6.0) * f64::from(i) / f64::from(2 * steps);
        let facing = (cos - along * deviation * sin).max(0.0);
        let simpson = if i == 0 || i == 2 * steps { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
        for j in 0..=steps {
            let across = 6.0 * f64::from(j) / f64::from(steps);
            let half = if j == 0 { 0.5 } else { 1.0 };
            let weight = simpson * half * facing * libm::exp(-0.5 * (along * along + across * across));
            let square = deviation * deviation * (along * along + across * across);
            reflected += weight * fresnel_reflectance(facing / (1.0 + square).sqrt(), index);
            shown += weight;
        }
    }
    reflected / shown
}

/// Numbers of columns and rows of [`reflectance_table`].
pub(super) const TABLE_SIDES: [usize; 2] = [64, 32];
/// Largest root mean square slope of [`reflectance_table`]. `SEA_MOST_SLOPE` of `shaders/sea/light.wgsl` has the same
/// value.
pub(super) const TABLE_MOST_SLOPE: f64 = 0.4;

/// Returns the mean reflectance of rough water row by row. The rows belong to root mean square slopes along one axis,
/// from 0 to [`TABLE_MOST_SLOPE`]. The columns belong to roots of the cosine of the view's zenith angle, from 0 to 1.
pub(super) fn reflectance_table(index: f64) -> Vec<f64> {
    let [columns, rows] = TABLE_SIDES;
    let entry = |i: usize| {
        let root = (i % columns) as f64 / (columns - 1) as f64;
        let slope = TABLE_MOST_SLOPE * (i / columns) as f64 / (rows - 1) as f64;
        reflectance_by_steps((root * root, slope * slope), index, 14)
    };
    (0..columns * rows).map(entry).collect()
}

/// Diffuse attenuation of pure sea water, 1/m, at 450, 550 and 650 nm: below that of Jerlov's clearest type.
const PURE_ATTENUATION_PER_M: [f64; 3] = [0.0168, 0.0607, 0.342];
/// Wavelengths of the three values of an attenuation, nm.
const ATTENUATED_NM: [f64; 3] = [450.0, 550.0, 650.0];

/// Returns the reflectance of a body of deep water seen from straight above, relative to the light that enters the
/// water, at 450, 550 and 650 nm. The water has the diffuse attenuation `attenuation_per_m`, 1/m. Below the surface the
/// reflectance is 0.33 b / a (Morel and Prieur 1977). Here b is the coefficient with which water and particles scatter
/// light back, and a that of absorption. The attenuation K of blue light and that of pure water, Kw, give the
/// chlorophyll C, mg/m^3, by K - Kw = 0.11 C^0.67. At 550 nm particles then scatter back 0.416 C^0.766 (0.002 + 0.01
/// (0.5 - 0.25 log C)), 1/m, with the logarithm to base 10 (Morel and Maritorena 2001). At other wavelengths l, nm, the
/// coefficient is 550 / l times that.
pub(super) fn body_reflectance(attenuation_per_m: [f64; 3], index: f64) -> [f64; 3] {
    let green_blue = (attenuation_per_m[0] - PURE_ATTENUATION_PER_M[0]).max(1e-4) / 0.11;
    let chlorophyll = libm::pow(green_blue, 1.0 / 0.67).clamp(0.01, 10.0);
    let share = (0.002 + 0.01 * (0.5 - 0.25 * libm::log10(chlorophyll))).max(0.002);
    let particles = 0.416 * libm::pow(chlorophyll, 0.766) * share;
    let inside = diffuse_inside(index);
    std::array::from_fn(|i| {
        let back = 0.5 * pure_scattering_per_m(ATTENUATED_NM[i]) + particles * 550.0 / ATTENUATED_NM[i];
        // Downward light goes aslant; its attenuation is (a + b) over a mean cosine of some 0.9.
        let absorbed = (0.9 * attenuation_per_m[i] - back).max(0.1 * attenuation_per_m[i]);
        let below = (0.33 * back / absorbed).min(0.3);
        // Light that leaves spreads into a wider cone, by the square of the index; some is thrown back inside.
        below * (1.0 - fresnel_reflectance(1.0, index)) / (index * index * (1.0 - inside * below))
    })
}

/// Returns the share r of diffuse light that the surface throws back into the water. Light that enters from outside
/// must leave again: 1 - r = (1 - R) / n^2, with the reflectance R from outside and the index n.
fn diffuse_inside(index: f64) -> f64 {
    // Mean reflectance from outside, by steps of equal light.
    let at = |i: i32| fresnel_reflectance(((f64::from(i) + 0.5) / 1000.0).sqrt(), index);
    let outside = (0..1000).map(at).sum::<f64>() / 1000.0;
    1.0 - (1.0 - outside) / (index * index)
}

/// Returns the scattering coefficient of pure sea water, 1/m, at a wavelength, nm: 16.06 times its volume scattering at
/// 90 degrees, 4.72e-4 (400 / l)^4.32 (Morel 1974).
pub fn pure_scattering_per_m(wavelength_nm: f64) -> f64 {
    16.06 * 4.72e-4 * libm::pow(400.0 / wavelength_nm, 4.32)
}

/// Returns the angle of incidence, rad, at which reflected light is wholly polarised (Brewster).
pub fn brewster_angle(index: f64) -> f64 {
    libm::atan(index)
}

/// Returns the angle from the vertical, rad, beyond which no light leaves the water.
pub fn critical_angle(index: f64) -> f64 {
    libm::asin(1.0 / index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_those_of_quan_and_fry() {
        for (salt, nm, index) in [
            (35.0, 440.0, 1.346561),
            (35.0, 550.0, 1.340789),
            (35.0, 650.0, 1.337661),
            (0.0, 440.0, 1.339926),
            (0.0, 550.0, 1.334338),
            (0.0, 650.0, 1.331324),
        ] {
            let found = refractive_index(salt, 20.0, nm);
            assert!((found - index).abs() < 1e-6, "{salt} {nm}: {found}");
        }
    }

    #[test]
    fn flat_water_reflects_by_fresnel() {
        for (index, deg, wanted) in [
            (1.3398, 0.0f64, 0.02109),
            (1.3398, 60.0, 0.06097),
            (1.3398, 80.0, 0.35014),
            (1.3398, 85.0, 0.58528),
            (1.333, 45.0, 0.02790),
            (1.333, 70.0, 0.13348),
            (1.333, 89.0, 0.89628),
        ] {
            let found = fresnel_reflectance(deg.to_radians().cos(), index);
            assert!((found - wanted).abs() < 1.5e-5, "{index} {deg}: {found}");
        }
        assert!((brewster_angle(1.3398).to_degrees() - 53.26).abs() < 6e-3);
        assert!((critical_angle(1.3398).to_degrees() - 48.28).abs() < 6e-3);
        assert!((diffuse_reflectance(1.3398) - 0.0675).abs() < 6e-5, "{}", diffuse_reflectance(1.3398));
        let inside = diffuse_reflectance(1.0 / 1.3398);
        assert!((inside - 0.4805).abs() < 2e-4, "{inside}");
    }

    #[test]
    fn rough_water_reflects_less_towards_the_horizon() {
        let degrees = [40.0f64, 60.0, 70.0, 80.0, 85.0, 89.0];
        for (wind, row) in [
            (0.0, [0.0253, 0.0610, 0.1354, 0.3502, 0.5853, 0.8968]),
            (5.0, [0.0266, 0.0658, 0.1359, 0.2746, 0.3633, 0.4353]),
            (10.0, [0.0278, 0.0690, 0.1311, 0.2328, 0.2941, 0.3456]),
            (15.0, [0.0290, 0.0710, 0.1252, 0.2055, 0.2533, 0.2943]),
        ] {
            for (deg, wanted) in degrees.iter().zip(row) {
                let mss = if wind > 0.0 { super::super::slopes::mean_square_slope(wind) } else { 0.0 };
                let found = mean_reflectance(deg.to_radians().cos(), mss, 1.34);
                assert!((found - wanted).abs() < 1e-3, "{wind} {deg}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn the_table_has_the_mean_reflectance() {
        let table = reflectance_table(1.34);
        let [columns, rows] = TABLE_SIDES;
        // As the shader looks it up: linear between entries.
        let found = |cos: f64, slope: f64| {
            let x = cos.sqrt() * (columns - 1) as f64;
            let y = slope / TABLE_MOST_SLOPE * (rows - 1) as f64;
            let (i, j) = ((x as usize).min(columns - 2), (y as usize).min(rows - 2));
            let (s, t) = (x - i as f64, y - j as f64);
            let row = |j: usize| table[j * columns + i] * (1.0 - s) + table[j * columns + i + 1] * s;
            row(j) * (1.0 - t) + row(j + 1) * t
        };
        let mut worst = 0.0f64;
        for wind in [0.5, 2.0, 5.0, 10.0, 15.0, 20.0] {
            let variance = 0.5 * super::super::slopes::mean_square_slope(wind);
            for deg in [0.0f64, 20.0, 40.0, 60.0, 70.0, 75.0, 80.0, 83.0, 85.0, 87.0, 89.0, 89.8] {
                let cos = deg.to_radians().cos();
                let off = found(cos, variance.sqrt()) - mean_reflectance(cos, 2.0 * variance, 1.34);
                println!("{wind} m/s, {deg} deg: {off:+.4}");
                worst = worst.max(off.abs());
            }
        }
        println!("worst {worst:.4}");
        assert!(worst < 4e-3, "{worst}");
    }

    #[test]
    fn clear_water_is_blue_and_turbid_water_green() {
        assert!((diffuse_inside(1.3398) - diffuse_reflectance(1.0 / 1.3398)).abs() < 5e-4);
        let of = |water: WaterType| body_reflectance(water.diffuse_attenuation_per_m(), 1.34);
        let [blue, green, red] = of(WaterType::IB);
        // Remote sensing finds 0.02 to 0.04 just below the surface in blue water of this type, half of it above.
        assert!(blue > 2.0 * green && green > 2.0 * red && (0.008..0.03).contains(&blue), "{blue} {green} {red}");
        let [blue, green, _] = of(WaterType::Coast3);
        assert!(green > blue, "{blue} {green}");
    }

    #[test]
    fn water_scatters_and_absorbs_as_published() {
        assert!((pure_scattering_per_m(440.0) - 0.00502).abs() < 6e-6);
        assert!((pure_scattering_per_m(550.0) - 0.00192).abs() < 1.3e-5, "{}", pure_scattering_per_m(550.0));
        let types = [WaterType::I, WaterType::IB, WaterType::II, WaterType::III, WaterType::Coast1, WaterType::Coast3];
        let green = types.map(|t| t.diffuse_attenuation_per_m()[0]);
        assert!(green.windows(2).all(|w| w[0] < w[1]), "{green:?}");
    }
}
