//! Starlight as measured from beyond the interplanetary dust, and its interpolation.
//!
//! Pioneer 10 mapped the sky from more than 2.8 au, where there is no zodiacal light: Leinert et al. 1998, tables 37
//! (440 nm) and 38 (640 nm), after Toller 1981 and Weinberg et al. 1974, within 5 to 8 %. The tables leave out stars
//! brighter than magnitude 6.5, which are drawn as points. They include faint stars, dust lit by stars, and other
//! galaxies. Their directions are 4 to 10 degrees apart, too coarse for the dark lane of the Milky Way. Between them
//! the light follows the disc of [`super::galaxy`], times the mean ratio of measured to modelled light around each
//! direction.

use glam::DVec3;

use super::disc::{disc_s10, equator_to_galactic};
use crate::almanac::celestial::equatorial_direction;

/// Declinations of the tables' columns, degrees. The rows are 10 degrees of right ascension apart.
const DECLINATIONS_DEG: [f64; 25] = [
    -80.0, -70.0, -60.0, -50.0, -40.0, -30.0, -24.0, -20.0, -16.0, -12.0, -8.0, -4.0, 0.0, 4.0, 8.0, 12.0, 16.0, 20.0,
    24.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0,
];
/// Weight of the light at 640 nm in a linear interpolation to 550 nm, the peak of the eye's sensitivity.
const RED_SHARE: f64 = 0.55;
/// Width of the kernel that averages the ratio of measured to modelled light, rad: 5 degrees, half the tables' step.
const NEAR_RAD: f64 = 0.0873;
/// Width of a second, wider kernel, rad. It fills directions in which the tables have no values (towards the sun as
/// seen from the spacecraft).
const FAR_RAD: f64 = 0.35;
/// Weight of the wide kernel relative to the narrow one.
const FAR_WEIGHT: f64 = 1e-3;
/// Entry without a measurement.
const X: u16 = 0;

/// Table at 440 nm, S10 of the sun's colour.
#[rustfmt::skip]
const BLUE_S10: [[u16; 25]; 36] = [
    [53, 49, 44, 38, 36, 32, 28, 30, 25, 34, 34, 33, 36, 43, 39, 41, 41, 49, 51, 67, 93, 166, 234, 112, 96],
    [55, 61, 36, 33, 30, 29, 30, 26, 25, 26, 34, 32, 32, 33, 36, 36, 39, 44, 46, 58, 94, 145, 208, 121, 92],
    [61, 56, 47, 39, 30, 26, 30, 29, 35, 35, 35, 34, 34, 37, 38, 39, 43, 46, 49, 60, 88, 140, 192, 121, 90],
    [62, 42, 47, 42, 32, 27, 34, 28, 33, 34, 32, 39, 37, 37, 43, 40, 45, 46, 54, 64, 85, 153, 202, 98, 88],
    [57, 48, 39, 36, 31, 31, 33, 35, 34, 36, 36, 41, 43, 41, 40, 44, 47, 51, 52, 67, 113, 145, 167, 101, 82],
    [54, 49, 44, 36, 35, 35, 34, 35, 38, 40, 43, 43, 51, 44, 44, 51, 55, 58, 67, 67, 115, 128, 143, 98, 87],
    [58, 59, 42, 42, 38, 40, 41, 46, 40, 49, 53, 54, 60, 59, 58, 71, 64, 73, 82, 83, 96, 136, 122, 96, 92],
    [68, 108, 56, 49, 47, 46, 54, 52, 50, 62, 72, 69, 76, 83, 76, 73, 67, 72, 65, 66, 131, 108, 104, 102, 88],
    [73, 319, 60, 61, 50, 52, 68, 71, 86, 94, 126, 134, 117, 115, 111, 116, 113, 124, 87, 121, 195, 134, 84, 94, 76],
    [75, 204, 77, 94, 76, 84, 96, 112, 119, 114, 125, 126, 132, 139, 167, 200, 192, 185, 196, 184, 143, 116, 82, 82, 68],
    [79, 79, 96, 110, 121, 150, 164, 240, 241, 221, 194, 227, 223, 240, 217, 213, 190, 192, 174, 165, 118, 91, 87, 75, 65],
    [85, 86, 120, 143, 159, 277, 286, 299, 261, 254, 262, 247, 208, 180, 160, 139, 129, 116, 111, 97, 76, 80, 66, 60, 61],
    [94, 124, 161, 233, 239, 320, 290, 245, 206, 170, 144, 146, 145, 143, 131, X, X, X, X, 75, 62, 48, 54, 60, 58],
    [93, 160, 209, 263, 226, 211, 146, 123, 120, X, X, X, X, X, X, X, X, X, X, X, 53, 50, 45, 56, 57],
    [99, 192, 313, 214, 183, 125, 102, 84, 86, 71, 69, X, X, X, X, X, X, X, X, X, X, 45, 40, 51, 57],
    [110, 194, 433, 255, 141, 91, 73, 72, 75, 59, 56, 59, 63, 61, 67, X, X, X, X, X, X, 48, 42, 48, 51],
    [109, 205, 718, 197, 121, 75, 60, 56, 53, 57, 47, 51, 51, 55, 59, 68, 66, 57, 50, 45, 46, 39, 43, 39, 46],
    [108, 226, 573, 176, 102, 65, 63, 56, 44, 46, 46, 45, 52, 55, 53, 49, 50, 44, 40, 36, 36, 33, 44, 40, 50],
    [114, 269, 459, 173, 91, 61, 52, 52, 44, 46, 44, 46, 41, 42, 36, 41, 39, 29, 32, 30, 30, 36, 33, 40, 51],
    [116, 264, 252, 163, 88, 61, 53, 47, 45, 43, 41, 40, 28, 36, 37, 35, 32, 32, 32, 25, 30, 26, 36, 43, 50],
    [115, 286, 385, 184, 101, 58, 56, 51, 53, 56, 48, 39, 34, 37, 31, 29, 34, 31, 26, 27, 31, 28, 33, 39, 46],
    [121, 243, 384, 182, 115, 76, 56, 54, 49, 47, 45, 36, 36, 36, 35, 33, 37, 36, 30, 28, 33, 42, 33, 41, 45],
    [126, 241, 331, 189, 136, 86, 73, 63, 54, 49, 50, 42, 42, 36, 39, 40, 29, 36, 34, 28, 31, 34, 36, 41, 49],
    [122, 245, 321, 295, 161, 88, 83, 70, 71, 60, 51, 48, 49, 43, 42, 42, 39, 34, 40, 31, 36, 35, 42, 43, 50],
    [114, 217, 350, 211, 143, 148, 140, 110, 75, 71, 65, 61, 56, 52, 48, 54, 44, 44, 41, 37, 40, 41, 42, 51, 48],
    [104, 182, 278, 312, 247, 204, 142, 88, 84, 74, 72, 68, 73, 70, 63, 59, 58, 59, 52, 45, 53, 42, 50, 55, 52],
    [95, 140, 216, 321, 291, 248, 145, 180, 165, 98, 76, 65, 78, 84, 88, 82, 81, 71, 68, 63, 58, 56, 53, 62, 57],
    [90, 125, 158, 217, 438, 641, 330, 235, 214, 122, 88, 85, 133, 160, 129, 121, 114, 114, 97, 97, 80, 72, 63, 76, 61],
    [85, 95, 115, 159, 195, 274, 241, 287, 269, 220, 215, 136, 103, 142, 217, 209, 159, 152, 147, 139, 122, 81, 83, 71, 67],
    [81, 91, 89, 100, 102, 143, 164, 192, 187, 171, 166, 147, 184, 199, 190, 145, 143, 136, 186, 270, 194, 134, 94, 77, 76],
    [79, 80, 72, 79, 80, 94, 86, 92, 102, 99, 113, 99, 125, 158, 188, 228, 248, 269, 198, 264, 307, 191, 126, 83, 80],
    [73, 80, 69, 59, 60, 71, 66, 74, 79, 71, 84, 82, 86, 103, 116, 122, 135, 168, 188, 202, 214, 189, 130, 93, 79],
    [70, 63, 56, 55, 46, 55, 58, 56, 59, 63, 63, 61, 66, 74, 78, 78, 93, 91, 104, 141, 212, 213, 151, 116, 82],
    [63, 62, 49, 48, 41, 45, 49, 44, 47, 42, 52, 54, 60, 53, 57, 63, 66, 73, 82, 102, 144, 301, 171, 126, 89],
    [55, 55, 41, 39, 39, 38, 39, 37, 43, 43, 43, 39, 47, 54, 48, 47, 55, 57, 64, 86, 130, 233, 162, 131, 92],
    [55, 46, 44, 32, 34, 32, 38, 35, 38, 39, 37, 42, 40, 43, 42, 38, 52, 54, 61, 67, 95, 169, 174, 114, 95],
];

/// Table at 640 nm, S10 of the sun's colour.
#[rustfmt::skip]
const RED_S10: [[u16; 25]; 36] = [
    [68, 55, 55, 56, 49, 35, 39, 40, 38, 42, 49, 46, 50, 56, 43, 51, 59, 56, 61, 71, 116, 192, 284, 162, 124],
    [74, 74, 42, 38, 36, 35, 34, 43, 39, 34, 44, 45, 35, 48, 47, 51, 55, 52, 63, 64, 108, 181, 261, 185, 121],
    [78, 67, 51, 44, 40, 31, 36, 40, 39, 39, 43, 38, 32, 53, 45, 40, 56, 58, 67, 79, 99, 158, 250, 176, 106],
    [78, 53, 48, 44, 39, 38, 34, 46, 45, 41, 40, 51, 43, 47, 64, 56, 61, 56, 66, 82, 97, 187, 265, 157, 110],
    [73, 69, 49, 42, 36, 36, 45, 42, 40, 44, 45, 48, 53, 49, 59, 54, 61, 62, 60, 74, 116, 177, 240, 150, 109],
    [72, 63, 56, 41, 48, 50, 44, 41, 44, 51, 49, 56, 60, 59, 61, 70, 74, 79, 78, 85, 141, 168, 205, 140, 111],
    [77, 71, 53, 52, 48, 50, 51, 52, 52, 57, 60, 68, 68, 73, 88, 85, 82, 90, 103, 108, 133, 183, 175, 128, 117],
    [81, 90, 72, 62, 54, 58, 66, 64, 64, 74, 76, 75, 87, 82, 93, 95, 112, 122, 102, 104, 189, 164, 161, 137, 103],
    [81, 341, 64, 72, 64, 63, 80, 84, 98, 115, 134, 131, 136, 135, 135, 125, 146, 143, 130, 179, 214, 184, 125, 115, 85],
    [88, 226, 88, 93, 83, 90, 117, 123, 138, 147, 155, 158, 174, 174, 220, 238, 258, 218, 246, 227, 169, 137, 112, 91, 83],
    [98, 107, 114, 116, 135, 176, 193, 248, 240, 248, 225, 253, 273, 280, 284, 263, 229, 233, 207, 210, 145, 119, 108, 77, 84],
    [102, 111, 141, 182, 218, 315, 331, 321, 297, 312, 295, 267, 225, 206, 182, 184, 165, 135, 138, 105, 108, 93, 81, 73, 77],
    [110, 141, 176, 275, 308, 385, 327, 288, 249, 200, 166, 178, 173, 167, 155, X, X, X, X, 105, 75, 63, 75, 79, 73],
    [113, 142, 224, 337, 278, 274, 201, 156, 137, X, X, X, X, X, X, X, X, X, X, X, 77, 52, 57, 74, 70],
    [119, 206, 372, 294, 239, 175, 114, 116, 126, 109, 101, X, X, X, X, X, X, X, X, X, X, 53, 57, 80, 65],
    [116, 244, 490, 334, 193, 120, 104, 85, 72, 68, 65, 65, 66, 67, 68, X, X, X, X, X, X, 52, 55, 57, 55],
    [116, 265, 846, 250, 156, 100, 75, 74, 62, 65, 57, 68, 71, 71, 65, 62, 59, 60, 58, 55, 52, 46, 52, 46, 49],
    [141, 308, 744, 229, 116, 88, 76, 59, 63, 61, 56, 52, 55, 60, 68, 66, 58, 52, 52, 50, 60, 36, 51, 54, 52],
    [145, 340, 632, 230, 99, 78, 61, 61, 57, 58, 54, 56, 54, 54, 41, 47, 50, 31, 45, 38, 37, 43, 45, 38, 52],
    [137, 335, 450, 214, 120, 72, 67, 59, 63, 54, 51, 42, 43, 55, 45, 41, 41, 36, 41, 33, 37, 35, 42, 50, 51],
    [145, 410, 565, 262, 115, 91, 77, 59, 53, 58, 51, 49, 44, 48, 40, 34, 39, 42, 38, 38, 34, 37, 45, 50, 58],
    [154, 351, 516, 256, 144, 95, 73, 68, 66, 71, 58, 52, 47, 50, 49, 44, 57, 44, 40, 40, 40, 43, 43, 48, 59],
    [153, 337, 559, 284, 173, 102, 87, 81, 80, 77, 54, 53, 58, 48, 53, 47, 42, 47, 54, 38, 35, 44, 40, 54, 61],
    [156, 310, 538, 481, 249, 134, 110, 88, 97, 79, 77, 62, 71, 69, 54, 50, 52, 43, 46, 41, 55, 44, 49, 61, 69],
    [146, 262, 537, 357, 242, 200, 152, 137, 106, 101, 82, 83, 77, 77, 64, 64, 54, 54, 55, 53, 47, 51, 53, 60, 68],
    [128, 213, 373, 571, 485, 366, 217, 145, 141, 145, 108, 110, 101, 89, 87, 79, 75, 68, 67, 59, 57, 59, 56, 65, 71],
    [127, 190, 284, 494, 550, 571, 344, 356, 301, 172, 144, 119, 136, 120, 123, 119, 116, 90, 85, 89, 81, 66, 64, 78, 75],
    [115, 155, 205, 284, 626, 1393, 649, 498, 474, 261, 199, 162, 204, 225, 201, 166, 157, 148, 132, 120, 94, 96, 73, 82, 76],
    [101, 106, 150, 191, 262, 461, 481, 534, 542, 515, 509, 343, 210, 254, 382, 341, 237, 218, 206, 176, 145, 111, 96, 91, 81],
    [103, 113, 129, 135, 141, 183, 211, 246, 272, 274, 260, 257, 331, 366, 374, 271, 283, 250, 327, 387, 228, 168, 117, 90, 89],
    [102, 107, 93, 99, 112, 112, 117, 134, 144, 143, 162, 149, 178, 215, 237, 323, 366, 407, 316, 421, 403, 245, 163, 102, 93],
    [93, 88, 78, 80, 77, 81, 89, 85, 89, 91, 91, 109, 128, 138, 145, 174, 168, 227, 240, 288, 280, 292, 187, 133, 94],
    [87, 81, 72, 65, 64, 73, 70, 73, 72, 77, 100, 75, 85, 93, 109, 107, 131, 119, 153, 192, 279, 286, 225, 136, 105],
    [75, 76, 56, 54, 60, 42, 66, 60, 56, 67, 67, 63, 81, 78, 78, 103, 85, 93, 105, 142, 188, 364, 259, 167, 119],
    [66, 69, 57, 52, 51, 53, 43, 48, 58, 64, 57, 47, 49, 67, 65, 58, 63, 76, 76, 97, 171, 268, 241, 178, 122],
    [64, 66, 59, 43, 46, 56, 48, 49, 43, 50, 44, 47, 62, 48, 55, 59, 61, 69, 72, 84, 104, 203, 256, 166, 119],
];

/// A measured direction of the tables.
struct Measured {
    /// Unit vector in galactic axes.
    direction: DVec3,
    /// Relative solid angle that the direction represents.
    area: f64,
    /// Logarithm of the ratio of measured to modelled light.
    ratio: f64,
}

/// Relative solid angle that a direction in a column of the tables represents.
fn area(column: usize) -> f64 {
    let height = DECLINATIONS_DEG[(column + 1).min(24)] - DECLINATIONS_DEG[column.saturating_sub(1)];
    height * DECLINATIONS_DEG[column].to_radians().cos()
}

/// Light of the stars that are not drawn as points, as a function of galactic direction.
pub struct Starlight(Vec<Measured>);

impl Starlight {
    /// Creates the starlight from the tables.
    pub fn measured() -> Self {
        let to_galactic = equator_to_galactic();
        let mut all = Vec::new();
        for (i, (blue, red)) in BLUE_S10.iter().zip(&RED_S10).enumerate() {
            for (j, (blue, red)) in blue.iter().zip(red).enumerate() {
                if *blue == X {
                    continue;
                }
                let direction = to_galactic * equatorial_direction(10.0 * i as f64, DECLINATIONS_DEG[j]);
                let s10 = f64::from(*blue) + RED_SHARE * (f64::from(*red) - f64::from(*blue));
                let ratio = (s10 / disc_s10(direction)).ln();
                all.push(Measured { direction, area: area(j), ratio });
            }
        }
        Self(all)
    }

    /// Starlight in a galactic direction (unit), S10.
    pub fn s10(&self, galactic: DVec3) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for place in &self.0 {
            // For a small angle a between two directions, 1 - cos a is a^2 / 2.
            let off = 1.0 - galactic.dot(place.direction);
            let of = |width: f64| (-off / (width * width)).exp();
            if off > 0.5 {
                continue;
            }
            let near = if off < 12.0 * NEAR_RAD * NEAR_RAD { of(NEAR_RAD) } else { 0.0 };
            let weight = place.area * (near + FAR_WEIGHT * of(FAR_RAD));
            sum += weight * place.ratio;
            weights += weight;
        }
        disc_s10(galactic) * (sum / weights).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starlight_is_as_pioneer_10_saw_it() {
        let starlight = Starlight::measured();
        let (mut squares, mut areas, mut drawn, mut wanted) = (0.0, 0.0, 0.0, 0.0);
        for place in &starlight.0 {
            let disc = disc_s10(place.direction);
            let [got, measured] = [starlight.s10(place.direction), disc * place.ratio.exp()];
            squares += place.area * (got / measured).ln().powi(2);
            (drawn, wanted) = (drawn + place.area * got, wanted + place.area * measured);
            areas += place.area;
        }
        let [rms, whole] = [100.0 * (squares / areas).sqrt(), drawn / wanted];
        println!(
            "starlight at {} measured places: {rms:.1} % off in the root mean square, the whole {whole:.3}",
            starlight.0.len()
        );
        assert!(rms < 8.0 && (whole - 1.0).abs() < 0.03, "{rms} {whole}");
    }

    /// In directions without a measurement the light agrees with that on the other side of the galactic plane, within
    /// the disc's own error.
    #[test]
    fn where_nothing_was_measured_starlight_goes_on_without_a_hole() {
        let starlight = Starlight::measured();
        let to_galactic = equator_to_galactic();
        for (i, row) in BLUE_S10.iter().enumerate() {
            for (j, _) in row.iter().enumerate().filter(|(_, blue)| **blue == X) {
                let here = to_galactic * equatorial_direction(10.0 * i as f64, DECLINATIONS_DEG[j]);
                let [got, other] = [here, here * DVec3::new(1.0, 1.0, -1.0)].map(|d| starlight.s10(d));
                assert!((0.6..1.7).contains(&(got / other)), "{i} {j}: {got} {other}");
            }
        }
    }

    /// Compares the colour with that of a black body as much redder than the sun as the tables are.
    #[test]
    fn starlight_has_the_tables_colour() {
        let of = |table: &[[u16; 25]; 36]| {
            let light = table.iter().flat_map(|row| row.iter().enumerate().map(|(j, v)| f64::from(*v) * area(j)));
            light.sum::<f64>()
        };
        let redder = of(&RED_S10) / of(&BLUE_S10);
        let planck = |nm: f64, kelvin: f64| 1.0 / ((1.438_777e7 / (nm * kelvin)).exp() - 1.0);
        let over_sun =
            |kelvin: f64| planck(640.0, kelvin) / planck(440.0, kelvin) * planck(440.0, 5772.0) / planck(640.0, 5772.0);
        let modelled = over_sun(crate::stars::glow::STARLIGHT_K);
        assert!((modelled / redder - 1.0).abs() < 0.01, "{modelled} {redder}");
    }
}
