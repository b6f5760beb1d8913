//! Series for the position of the moon relative to the Earth's centre.
//!
//! The series follow Meeus, Astronomical Algorithms (2nd ed., 1998), chapter 47, with the leading terms of Chapront's
//! ELP 2000-82. The terms left out add up to less than 0.01 degrees and 60 km. The series have four arguments. D is the
//! moon's mean elongation from the sun. M and M' are the mean anomalies of sun and moon. F is the moon's argument of
//! latitude.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::scene::turn_x;

/// Terms in longitude (1e-6 degrees) and distance (1e-3 km): multiples of D, M, M', F, then the amplitudes.
const LONGITUDE_DISTANCE: [[f64; 6]; 44] = [
    [0.0, 0.0, 1.0, 0.0, 6_288_774.0, -20_905_355.0],
    [2.0, 0.0, -1.0, 0.0, 1_274_027.0, -3_699_111.0],
    [2.0, 0.0, 0.0, 0.0, 658_314.0, -2_955_968.0],
    [0.0, 0.0, 2.0, 0.0, 213_618.0, -569_925.0],
    [0.0, 1.0, 0.0, 0.0, -185_116.0, 48_888.0],
    [0.0, 0.0, 0.0, 2.0, -114_332.0, -3_149.0],
    [2.0, 0.0, -2.0, 0.0, 58_793.0, 246_158.0],
    [2.0, -1.0, -1.0, 0.0, 57_066.0, -152_138.0],
    [2.0, 0.0, 1.0, 0.0, 53_322.0, -170_733.0],
    [2.0, -1.0, 0.0, 0.0, 45_758.0, -204_586.0],
    [0.0, 1.0, -1.0, 0.0, -40_923.0, -129_620.0],
    [1.0, 0.0, 0.0, 0.0, -34_720.0, 108_743.0],
    [0.0, 1.0, 1.0, 0.0, -30_383.0, 104_755.0],
    [2.0, 0.0, 0.0, -2.0, 15_327.0, 10_321.0],
    [0.0, 0.0, 1.0, 2.0, -12_528.0, 0.0],
    [0.0, 0.0, 1.0, -2.0, 10_980.0, 79_661.0],
    [4.0, 0.0, -1.0, 0.0, 10_675.0, -34_782.0],
    [0.0, 0.0, 3.0, 0.0, 10_034.0, -23_210.0],
    [4.0, 0.0, -2.0, 0.0, 8_548.0, -21_636.0],
    [2.0, 1.0, -1.0, 0.0, -7_888.0, 24_208.0],
    [2.0, 1.0, 0.0, 0.0, -6_766.0, 30_824.0],
    [1.0, 0.0, -1.0, 0.0, -5_163.0, -8_379.0],
    [1.0, 1.0, 0.0, 0.0, 4_987.0, -16_675.0],
    [2.0, -1.0, 1.0, 0.0, 4_036.0, -12_831.0],
    [2.0, 0.0, 2.0, 0.0, 3_994.0, -10_445.0],
    [4.0, 0.0, 0.0, 0.0, 3_861.0, -11_650.0],
    [2.0, 0.0, -3.0, 0.0, 3_665.0, 14_403.0],
    [0.0, 1.0, -2.0, 0.0, -2_689.0, -7_003.0],
    [2.0, 0.0, -1.0, 2.0, -2_602.0, 0.0],
    [2.0, -1.0, -2.0, 0.0, 2_390.0, 10_056.0],
    [1.0, 0.0, 1.0, 0.0, -2_348.0, 6_322.0],
    [2.0, -2.0, 0.0, 0.0, 2_236.0, -9_884.0],
    [0.0, 1.0, 2.0, 0.0, -2_120.0, 5_751.0],
    [0.0, 2.0, 0.0, 0.0, -2_069.0, 0.0],
    [2.0, -2.0, -1.0, 0.0, 2_048.0, -4_950.0],
    [2.0, 0.0, 1.0, -2.0, -1_773.0, 4_130.0],
    [2.0, 0.0, 0.0, 2.0, -1_595.0, 0.0],
    [4.0, -1.0, -1.0, 0.0, 1_215.0, -3_958.0],
    [0.0, 0.0, 2.0, 2.0, -1_110.0, 0.0],
    [3.0, 0.0, -1.0, 0.0, -892.0, 3_258.0],
    [2.0, 1.0, 1.0, 0.0, -810.0, 2_616.0],
    [4.0, -1.0, -2.0, 0.0, 759.0, -1_897.0],
    [0.0, 2.0, -1.0, 0.0, -713.0, -2_117.0],
    [2.0, 2.0, -1.0, 0.0, -700.0, 2_354.0],
];

/// Terms in latitude (1e-6 degrees): multiples of D, M, M', F, then the amplitude.
const LATITUDE: [[f64; 5]; 32] = [
    [0.0, 0.0, 0.0, 1.0, 5_128_122.0],
    [0.0, 0.0, 1.0, 1.0, 280_602.0],
    [0.0, 0.0, 1.0, -1.0, 277_693.0],
    [2.0, 0.0, 0.0, -1.0, 173_237.0],
    [2.0, 0.0, -1.0, 1.0, 55_413.0],
    [2.0, 0.0, -1.0, -1.0, 46_271.0],
    [2.0, 0.0, 0.0, 1.0, 32_573.0],
    [0.0, 0.0, 2.0, 1.0, 17_198.0],
    [2.0, 0.0, 1.0, -1.0, 9_266.0],
    [0.0, 0.0, 2.0, -1.0, 8_822.0],
    [2.0, -1.0, 0.0, -1.0, 8_216.0],
    [2.0, 0.0, -2.0, -1.0, 4_324.0],
    [2.0, 0.0, 1.0, 1.0, 4_200.0],
    [2.0, 1.0, 0.0, -1.0, -3_359.0],
    [2.0, -1.0, -1.0, 1.0, 2_463.0],
    [2.0, -1.0, 0.0, 1.0, 2_211.0],
    [2.0, -1.0, -1.0, -1.0, 2_065.0],
    [0.0, 1.0, -1.0, -1.0, -1_870.0],
    [4.0, 0.0, -1.0, -1.0, 1_828.0],
    [0.0, 1.0, 0.0, 1.0, -1_794.0],
    [0.0, 0.0, 0.0, 3.0, -1_749.0],
    [0.0, 1.0, -1.0, 1.0, -1_565.0],
    [1.0, 0.0, 0.0, 1.0, -1_491.0],
    [0.0, 1.0, 1.0, 1.0, -1_475.0],
    [0.0, 1.0, 1.0, -1.0, -1_410.0],
    [0.0, 1.0, 0.0, -1.0, -1_344.0],
    [1.0, 0.0, 0.0, -1.0, -1_335.0],
    [0.0, 0.0, 3.0, 1.0, 1_107.0],
    [4.0, 0.0, 0.0, -1.0, 1_021.0],
    [4.0, 0.0, -1.0, 1.0, 833.0],
    [0.0, 0.0, 1.0, -3.0, 777.0],
    [4.0, 0.0, -2.0, 1.0, 671.0],
];

/// Returns ecliptic longitude and latitude of date (rad, without nutation) and distance (m) from the Earth's centre, at
/// `t` centuries of TT since J2000.
fn geocentric_ecliptic(t: f64) -> (f64, f64, f64) {
    let angle = |c: [f64; 4]| (c[0] + t * (c[1] + t * (c[2] + t * c[3]))).to_radians();
    let l = angle([218.316_447_7, 481_267.881_234_21, -0.001_578_6, 1.0 / 538_841.0]);
    let d = angle([297.850_192_1, 445_267.111_403_4, -0.001_881_9, 1.0 / 545_868.0]);
    let m = angle([357.529_109_2, 35_999.050_290_9, -0.000_153_6, 1.0 / 24_490_000.0]);
    let mp = angle([134.963_396_4, 477_198.867_505_5, 0.008_741_4, 1.0 / 69_699.0]);
    let f = angle([93.272_095_0, 483_202.017_523_3, -0.003_653_9, -1.0 / 3_526_000.0]);
    let [a1, a2, a3] = [(119.75, 131.849), (53.09, 479_264.290), (313.45, 481_266.484)]
        .map(|(a, b): (f64, f64)| (a + b * t).to_radians());
    // Eccentricity of the Earth's orbit, relative to that at J2000. A term with n times M scales with its n-th power.
    let e = 1.0 - 0.002_516 * t - 0.000_007_4 * t * t;
    let argument = |c: &[f64]| c[0] * d + c[1] * m + c[2] * mp + c[3] * f;
    let weight = |c: &[f64]| e.powi(c[1].abs() as i32);
    let mut longitude = 3958.0 * libm::sin(a1) + 1962.0 * libm::sin(l - f) + 318.0 * libm::sin(a2);
    let mut latitude = -2235.0 * libm::sin(l)
        + 382.0 * libm::sin(a3)
        + 175.0 * (libm::sin(a1 - f) + libm::sin(a1 + f))
        + 127.0 * libm::sin(l - mp)
        - 115.0 * libm::sin(l + mp);
    let mut distance = 0.0;
    for c in &LONGITUDE_DISTANCE {
        longitude += c[4] * weight(c) * libm::sin(argument(c));
        distance += c[5] * weight(c) * libm::cos(argument(c));
    }
    for c in &LATITUDE {
        latitude += c[4] * weight(c) * libm::sin(argument(c));
    }
    (
        (l + (longitude * 1e-6).to_radians()).rem_euclid(TAU),
        (latitude * 1e-6).to_radians(),
        (385_000.56 + distance * 1e-3) * 1e3,
    )
}

/// Returns the moon's position relative to the Earth's centre in the true equator and equinox of date, m, at `t`
/// centuries of TT since J2000. `nutation` is the nutation in longitude and `obliquity` the true obliquity, rad.
pub(super) fn geocentric_equatorial(t: f64, nutation: f64, obliquity: f64) -> DVec3 {
    let (longitude, latitude, distance) = geocentric_ecliptic(t);
    let (sb, cb) = libm::sincos(latitude);
    let (sl, cl) = libm::sincos(longitude + nutation);
    turn_x(obliquity) * (DVec3::new(cl * cb, sl * cb, sb) * distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meeus_example_47a() {
        // 1992-04-12 0h TD: longitude 133.162655, latitude -3.229126 degrees, distance 368409.7 km.
        let t = -0.077_221_081_451;
        let (l, b, r) = geocentric_ecliptic(t);
        assert!((l.to_degrees() - 133.162_655).abs() < 0.005, "{}", l.to_degrees());
        assert!((b.to_degrees() + 3.229_126).abs() < 0.005, "{}", b.to_degrees());
        assert!((r / 1e3 - 368_409.7).abs() < 60.0, "{}", r / 1e3);
    }
}
