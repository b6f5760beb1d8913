//! Spectra: the sun's above the air, ozone's absorption, and interpolation between values at three wavelengths.

use crate::light::spectrum::black_body;

/// Mean extraterrestrial solar irradiance in bins of 10 nm from 360 nm, W m^-2 nm^-1: ASTM G173-03, ETR column.
#[rustfmt::skip]
const SOLAR_IRRADIANCE: [f64; 48] = [
    1.11776, 1.14259, 1.01249, 1.14716, 1.72765, 1.73054, 1.68870, 1.61253, 1.91198, 2.03474, 2.02042, 2.02212,
    1.93377, 1.95809, 1.91686, 1.82980, 1.86850, 1.89310, 1.85149, 1.85040, 1.83410, 1.83450, 1.81470, 1.78158,
    1.75330, 1.69650, 1.68194, 1.64654, 1.60480, 1.52143, 1.55622, 1.51130, 1.47400, 1.44820, 1.41018, 1.36775,
    1.34188, 1.31429, 1.28303, 1.26758, 1.23670, 1.20820, 1.18737, 1.14683, 1.12362, 1.10580, 1.07124, 1.04992,
];

/// Mean ozone absorption cross-section at 233 K in bins of 10 nm from 360 nm, 1e-26 m^2: Serdyuchenko et al. 2014
/// (IUP Bremen), the Chappuis band.
#[rustfmt::skip]
const OZONE_CROSS_SECTION: [f64; 48] = [
    0.1180, 0.02182, 0.02818, 0.06636, 0.1527, 0.2763, 0.5520, 0.8451, 1.582, 2.316, 3.669, 4.924,
    7.752, 9.016, 14.80, 16.02, 21.39, 27.55, 30.91, 35.00, 42.66, 46.72, 43.98, 47.01,
    50.19, 43.05, 37.40, 32.15, 26.62, 22.38, 18.52, 14.73, 12.09, 9.423, 7.455, 6.566,
    5.105, 4.150, 4.228, 3.237, 2.451, 2.801, 2.534, 1.624, 1.465, 2.078, 1.383, 0.7105,
];

/// Centre of the first bin and width of the bins of the tables above, nm.
const BINS_NM: (f64, f64) = (365.0, 10.0);

/// Interpolates linearly between the bins' centres; `None` outside of them.
fn tabulated(table: &[f64; 48], wavelength_nm: f64) -> Option<f64> {
    let x = (wavelength_nm - BINS_NM.0) / BINS_NM.1;
    let last = (table.len() - 1) as f64;
    if !(0.0..=last).contains(&x) {
        return None;
    }
    let i = (x as usize).min(table.len() - 2);
    let f = x - i as f64;
    Some(table[i] * (1.0 - f) + table[i + 1] * f)
}

/// Returns the sun's spectral irradiance at 1 au above the air, W m^-2 nm^-1. From 365 to 835 nm it is ASTM G173-03,
/// means over 10 nm, interpolated. Outside it is that of a black body of 5772 K, scaled to continue the table's ends.
pub fn solar_irradiance(wavelength_nm: f64) -> f64 {
    tabulated(&SOLAR_IRRADIANCE, wavelength_nm).unwrap_or_else(|| {
        let last = SOLAR_IRRADIANCE.len() - 1;
        let end = if wavelength_nm < BINS_NM.0 { 0 } else { last };
        let end_nm = BINS_NM.0 + BINS_NM.1 * end as f64;
        SOLAR_IRRADIANCE[end] * black_body(wavelength_nm, 5772.0) / black_body(end_nm, 5772.0)
    })
}

/// Returns ozone's absorption cross-section at 233 K, m^2. From 365 to 835 nm it is that of Serdyuchenko et al. 2014,
/// means over 10 nm, interpolated; outside it is 0, because bands other than Chappuis's are not tabulated.
pub fn ozone_cross_section_m2(wavelength_nm: f64) -> f64 {
    tabulated(&OZONE_CROSS_SECTION, wavelength_nm).map_or(0.0, |s| s * 1e-26)
}

/// Interpolates linearly at `x` between three points in any order, constant outside.
pub(crate) fn between(points: &[f64; 3], values: &[f64; 3], x: f64) -> f64 {
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| points[*a].total_cmp(&points[*b]));
    let [a, b, c] = order;
    let line = |i: usize, j: usize| {
        let range = points[j] - points[i];
        let f = if range > 0.0 { ((x - points[i]) / range).clamp(0.0, 1.0) } else { 0.0 };
        values[i] * (1.0 - f) + values[j] * f
    };
    if x < points[b] { line(a, b) } else { line(b, c) }
}

/// Interpolates at `x` by a power law, value = a x^b, through those two of the three points between which `x` lies. The
/// points may be in any order. Beyond the outer points the law of the two nearest points is extrapolated. If one of the
/// two values is 0, or the two points coincide, the result is that of [`between`].
pub(crate) fn power_between(points: &[f64; 3], values: &[f64; 3], x: f64) -> f64 {
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| points[*a].total_cmp(&points[*b]));
    let [a, b, c] = order;
    let (i, j) = if x < points[b] { (a, b) } else { (b, c) };
    let range = (points[j] / points[i]).ln();
    if range <= 0.0 || values[i] <= 0.0 || values[j] <= 0.0 {
        return between(points, values, x);
    }
    values[i] * (x / points[i]).powf((values[j] / values[i]).ln() / range)
}
