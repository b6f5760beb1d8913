//! Illuminance and colour of a star, and the share of its light that the air lets through.

use std::sync::OnceLock;

use crate::light::{
    luminance,
    spectrum::{black_body, rec709_of_wavelength},
};

/// Illuminance above the air of a star of magnitude 0 on a surface facing it, lux (Allen 1973, Astrophysical
/// Quantities; Crumey 2014, MNRAS 442, 2600).
pub const MAGNITUDE_0_LUX: f64 = 2.54e-6;

/// Illuminance above the air of a star of a magnitude, on a surface facing it, lux (Pogson 1856).
pub fn illuminance_lux(magnitude: f64) -> f64 {
    MAGNITUDE_0_LUX * 10f64.powf(-0.4 * magnitude)
}

/// Temperature of the black body that has a star's B-V, K (Ballesteros 2012, EPL 97, 34008, eq. 14). B-V is clamped to
/// [-0.4, 2.0].
pub fn temperature_of_color_index(b_v: f64) -> f64 {
    let x = 0.92 * b_v.clamp(-0.4, 2.0);
    4600.0 * (1.0 / (x + 1.7) + 1.0 / (x + 0.62))
}

/// Colour of a black body in linear Rec. 709 (white is D65) with luminance 1: Planck's law and the standard observer of
/// 1931, summed in steps of 5 nm. Below 1900 K the light is redder than Rec. 709 can show; its negative blue is cut
/// off.
fn integrated_color(temperature_k: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for nm in (360..=830).step_by(5).map(f64::from) {
        let c = rec709_of_wavelength(nm);
        (0..3).for_each(|k| sum[k] += c[k] * black_body(nm, temperature_k));
    }
    let sum = sum.map(|v| v.max(0.0));
    let total = luminance(&sum);
    sum.map(|v| v / total)
}

/// Step of the table of colours, mired: 1e6 divided by the temperature in kelvins.
const MIRED_STEP: f64 = 10.0;

/// Linear Rec. 709 colour, with luminance 1, of a black body. The temperature is clamped to 1000 to 1 000 000 K. The
/// colour is read from a table in steps of 10 mired. From 2000 to 93 000 K each channel is within 0.005 of the sum over
/// wavelengths. Any thread.
pub fn color_of_temperature(temperature_k: f64) -> [f64; 3] {
    static TABLE: OnceLock<[[f64; 3]; 101]> = OnceLock::new();
    let table = TABLE.get_or_init(|| std::array::from_fn(|i| integrated_color(1e6 / (MIRED_STEP * i as f64).max(1.0))));
    let x = (1e6 / temperature_k.clamp(1e3, 1e6)) / MIRED_STEP;
    let i = (x as usize).min(table.len() - 2);
    let f = x - i as f64;
    std::array::from_fn(|k| table[i][k] * (1.0 - f) + table[i + 1][k] * f)
}

/// Temperature of the sun as a black body, K (IAU 2015 resolution B3).
const SUN_K: f64 = 5772.0;

/// Returns the colour of a black body, with luminance 1, for an eye that is adapted to unscattered sunlight as white
/// (von Kries; `world::lights`). Everything that is drawn uses this white.
pub fn color_by_sunlight(temperature_k: f64) -> [f64; 3] {
    let (color, white) = (color_of_temperature(temperature_k), color_of_temperature(SUN_K));
    let adapted: [f64; 3] = std::array::from_fn(|k| color[k] / white[k]);
    let total = luminance(&adapted);
    adapted.map(|v| v / total)
}

/// Illuminance of a star above the air, lux a channel of linear Rec. 709.
pub fn star_lux(magnitude: f64, temperature_k: f64) -> [f64; 3] {
    color_by_sunlight(temperature_k).map(|c| c * illuminance_lux(magnitude))
}

/// Relative air mass in the direction of an apparent elevation, degrees (Kasten and Young 1989, eq. 3). Below the
/// horizon it is that at the horizon, 38.
pub fn air_mass(elevation_deg: f64) -> f64 {
    let h = elevation_deg.max(0.0);
    1.0 / (h.to_radians().sin() + 0.505_72 * (h + 6.079_95).powf(-1.6364))
}

/// Share of a star's light that the air lets through at each of the three wavelengths (Bouguer 1729), at an apparent
/// elevation; `zenith_depth` are the optical depths straight up. The share applies channel by channel, as in the sky's
/// own conversion (`planet::spectral::Conversion::per_channel`).
pub fn transmittance(zenith_depth: [f64; 3], elevation_deg: f64) -> [f64; 3] {
    let mass = air_mass(elevation_deg);
    zenith_depth.map(|depth| (-depth * mass).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::spectrum::apply;

    /// Chromaticity x, y of a linear Rec. 709 colour (the matrix of ITU-R BT.709).
    fn chromaticity(rec709: [f64; 3]) -> [f64; 2] {
        const XYZ_FROM_REC709: [[f64; 3]; 3] = [
            [0.412_390_799, 0.357_584_339, 0.180_480_788],
            [0.212_639_006, 0.715_168_679, 0.072_192_315],
            [0.019_330_819, 0.119_194_780, 0.950_532_152],
        ];
        let xyz = apply(&XYZ_FROM_REC709, &rec709);
        let sum: f64 = xyz.iter().sum();
        [xyz[0] / sum, xyz[1] / sum]
    }

    #[test]
    fn five_magnitudes_are_a_hundredfold() {
        assert!((illuminance_lux(-1.46) - 9.75e-6).abs() < 1e-7, "Sirius, 9.7 microlux");
        assert!((illuminance_lux(1.0) / illuminance_lux(6.0) - 100.0).abs() < 1e-9);
        // The sun's magnitude -26.74 corresponds to about 126 to 134 klx.
        assert!((1.2e5..1.35e5).contains(&illuminance_lux(-26.74)));
    }

    #[test]
    fn color_indices_give_the_temperatures_of_known_stars() {
        // Ballesteros 2012, figure 5 and text: the sun (0.65) 5780 K, Vega (0.0) 9500 to 10200 K, Betelgeuse (1.85)
        // 3200 to 3600 K.
        assert!((temperature_of_color_index(0.65) - 5780.0).abs() < 60.0, "{}", temperature_of_color_index(0.65));
        assert!((9500.0..10_200.0).contains(&temperature_of_color_index(0.0)));
        assert!((3000.0..3600.0).contains(&temperature_of_color_index(1.85)));
        assert_eq!(temperature_of_color_index(9.0), temperature_of_color_index(2.0));
    }

    #[test]
    fn colours_lie_on_the_planckian_locus() {
        // CIE 15:2004 and Kim et al. 2002: chromaticities of black bodies.
        for (t, x, y) in
            [(2856.0, 0.4476, 0.4074), (5000.0, 0.3451, 0.3516), (6500.0, 0.3135, 0.3237), (10_000.0, 0.2807, 0.2884)]
        {
            let c = color_of_temperature(t);
            let got = chromaticity(c);
            assert!((luminance(&c) - 1.0).abs() < 1e-6, "{t}: {c:?}");
            assert!((got[0] - x).abs() < 0.006 && (got[1] - y).abs() < 0.006, "{t}: {got:?}");
        }
    }

    #[test]
    fn sunlight_is_white_and_stars_are_bluer_or_redder_than_it() {
        assert!(color_by_sunlight(SUN_K).iter().all(|v| (v - 1.0).abs() < 1e-9));
        let [cool, hot] = [3500.0, 12_000.0].map(color_by_sunlight);
        assert!(cool[0] > 1.2 && cool[2] < 0.8 && hot[0] < 0.95 && hot[2] > 1.2, "{cool:?} {hot:?}");
        assert!((luminance(&cool) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_table_of_colours_is_within_half_a_percent() {
        for i in 0..200 {
            let t = 2000.0 * 1.0195f64.powi(i);
            let (got, want) = (color_of_temperature(t), integrated_color(t));
            let off = (0..3).map(|k| (got[k] - want[k]).abs()).fold(0.0, f64::max);
            assert!(off < 5e-3, "{t}: {got:?} {want:?}");
        }
    }

    #[test]
    fn the_air_reddens_and_dims_towards_the_horizon() {
        // Kasten and Young 1989, table II: 1 at the zenith, 1.994 at 30, 10.3 at 5, 38 at 0 degrees.
        for (h, mass) in [(90.0, 1.0), (30.0, 1.994), (5.0, 10.31), (0.0, 37.92)] {
            assert!((air_mass(h) / mass - 1.0).abs() < 0.005, "{h}: {}", air_mass(h));
        }
        let clear = [0.07, 0.11, 0.24];
        let [up, low] = [90.0, 2.0].map(|h| transmittance(clear, h));
        assert!(up[0] > up[2] && low[0] / low[2] > 10.0 && low[1] < 0.2, "{up:?} {low:?}");
        assert_eq!(transmittance([0.0; 3], 0.0), [1.0; 3]);
    }
}
