//! Conversion of wavelengths to colours: black bodies, the CIE 1931 standard observer, and linear Rec. 709.

/// Returns the radiance of a black body per unit of wavelength, up to a constant factor: Planck's law.
pub fn black_body(wavelength_nm: f64, temperature_k: f64) -> f64 {
    let um = wavelength_nm * 1e-3;
    // Second radiation constant, 14387.77 um K.
    um.powi(-5) / (14_387.77 / (um * temperature_k)).exp_m1()
}

/// Returns the colour matching functions of the CIE 1931 standard observer (2 degrees), as sums of lobes (Wyman, Sloan
/// and Shirley 2013, table 1). The integrals of these sums are within 1 % of those of the tabulated functions.
/// Wavelength in nm.
pub fn cie_1931(wavelength_nm: f64) -> [f64; 3] {
    let lobe = |mean: f64, below: f64, above: f64| {
        let t = (wavelength_nm - mean) / if wavelength_nm < mean { below } else { above };
        (-0.5 * t * t).exp()
    };
    [
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
    ]
}

/// Luminous efficacy of radiation at 555 nm, lm/W (SI definition of the candela).
pub const LUMINOUS_EFFICACY_LM_PER_W: f64 = 683.002;

/// Matrix from CIE XYZ to linear Rec. 709 (ITU-R BT.709 primaries, D65).
#[rustfmt::skip]
pub(crate) const REC709_FROM_XYZ: [[f64; 3]; 3] = [
    [ 3.240_969_942, -1.537_383_178, -0.498_610_760],
    [-0.969_243_636,  1.875_967_502,  0.041_555_057],
    [ 0.055_630_080, -0.203_976_959,  1.056_971_514],
];

/// Returns the linear Rec. 709 colour of light of one wavelength and unit radiance: cd/m^2 per W m^-2 sr^-1.
pub fn rec709_of_wavelength(wavelength_nm: f64) -> [f64; 3] {
    apply(&REC709_FROM_XYZ, &cie_1931(wavelength_nm)).map(|v| v * LUMINOUS_EFFICACY_LM_PER_W)
}

/// Multiplies a matrix by a column vector.
pub fn apply(matrix: &[[f64; 3]; 3], column: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| matrix[i][j] * column[j]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eye_has_its_known_sums_and_d65_is_white() {
        let sum = |f: &dyn Fn(f64) -> f64| (360..=830).map(|nm| f(f64::from(nm))).sum::<f64>();
        // CIE 1931: the sum of each of the three functions over 1 nm is 106.87 (equal-energy white); the fit is within
        // 1 %.
        for k in 0..3 {
            let total = sum(&|nm| cie_1931(nm)[k]);
            assert!((total / 106.87 - 1.0).abs() < 0.01, "{k}: {total}");
        }
        // Tabulated values of the standard observer.
        for (nm, xyz) in
            [(450.0, [0.3362, 0.0380, 1.7721]), (555.0, [0.5121, 1.0, 0.0057]), (600.0, [1.0622, 0.6310, 0.0008])]
        {
            for (ours, table) in cie_1931(nm).iter().zip(xyz) {
                assert!((ours - table).abs() < 0.03, "{nm}: {ours} {table}");
            }
        }
        // D65 is white.
        let white = apply(&REC709_FROM_XYZ, &[0.95047, 1.0, 1.08883]);
        assert!(white.iter().all(|v| (v - 1.0).abs() < 5e-4), "{white:?}");
    }
}
