//! Positions of the planets relative to the sun, by the series of Simon, Bretagnon, Chapront, Chapront-Touze, Francou
//! and Laskar (1994, A&A 282, 663, section 6). The series gives mean elements to the second order in time, and the
//! largest periodic terms of the semi-major axis and the mean longitude.
//!
//! The authors state the largest errors of the longitude between 1800 and 2050: 4" for Mercury, 5" for Venus, 6" for
//! the Earth, 17" for Mars, 71" for Jupiter, 81" for Saturn and 86" for Uranus. Between 1000 and 3000 the errors are
//! 1.5 times as large.

use glam::{DMat3, DVec3};

/// Rate of the common argument of the periodic terms, rad per millennium. Each term has an integer multiple of this
/// argument.
const ARGUMENT_RATE: f64 = 0.359_536_20;
/// Unit of the amplitudes of the periodic terms, au or rad.
const AMPLITUDE: f64 = 1e-7;
/// Obliquity of the ecliptic of J2000.0 (IAU 1976), arc seconds.
const OBLIQUITY_AS: f64 = 84_381.448;

/// Orbital elements of one planet, referred to the mean ecliptic and equinox of J2000.0. Each element is a polynomial
/// in millennia of terrestrial time since J2000.0; its coefficients are listed from the constant upwards.
pub(super) struct Orbit {
    /// Semi-major axis, au.
    axis: [f64; 3],
    /// Mean longitude: the constant in degrees, the other coefficients in arc seconds.
    longitude: [f64; 3],
    eccentricity: [f64; 3],
    /// Longitude of the perihelion, in units as for `longitude`.
    perihelion: [f64; 3],
    /// Inclination, in units as for `longitude`.
    inclination: [f64; 3],
    /// Longitude of the ascending node, in units as for `longitude`.
    node: [f64; 3],
    /// Periodic terms of the semi-major axis, one in each column: multiple of the argument, amplitude of the cosine,
    /// amplitude of the sine, in units of [`AMPLITUDE`]. The last term grows with time.
    axis_terms: [[f64; 9]; 3],
    /// Periodic terms of the mean longitude, in rows as for `axis_terms`. The last two terms grow with time.
    longitude_terms: [[f64; 10]; 3],
}

/// Orbit of the barycentre of Earth and moon, which lies within 4700 km of the Earth's centre.
pub(super) static EARTH: Orbit = Orbit {
    axis: [1.000_001_017_8, 0.0, 0.0],
    longitude: [100.466_456_83, 1_295_977_422.834_29, -2.044_11],
    eccentricity: [0.016_708_634_2, -0.000_420_365_4, -0.000_012_673_4],
    perihelion: [102.937_348_08, 11_612.352_90, 53.275_77],
    inclination: [0.0, 469.972_89, -3.350_53],
    node: [174.873_175_77, -8_679.270_34, 15.341_91],
    axis_terms: [
        [16002.0, 21863.0, 32004.0, 10931.0, 14529.0, 16368.0, 15318.0, 32794.0, 0.0],
        [64.0, -152.0, 62.0, -8.0, 32.0, -41.0, 19.0, -11.0, 0.0],
        [-150.0, -46.0, 68.0, 54.0, 14.0, 24.0, -28.0, 22.0, 0.0],
    ],
    longitude_terms: [
        [10.0, 16002.0, 21863.0, 10931.0, 1473.0, 32004.0, 4387.0, 73.0, 0.0, 0.0],
        [-325.0, -322.0, -79.0, 232.0, -52.0, 97.0, 55.0, -41.0, 0.0, 0.0],
        [-105.0, -137.0, 258.0, 35.0, -116.0, -88.0, -112.0, -80.0, 0.0, 0.0],
    ],
};

/// Orbits of Mercury, Venus, Mars, Jupiter, Saturn and Uranus, in this order.
pub(super) static PLANETS: [Orbit; 6] = [
    Orbit {
        axis: [0.387_098_309_8, 0.0, 0.0],
        longitude: [252.250_905_52, 5_381_016_286.889_82, -1.927_89],
        eccentricity: [0.205_631_752_6, 0.000_204_065_3, -28_349e-10],
        perihelion: [77.456_119_04, 5_719.115_90, -4.830_16],
        inclination: [7.004_986_25, -214.256_29, 0.289_77],
        node: [48.330_893_04, -4_515.217_27, -31.798_92],
        axis_terms: [
            [69613.0, 75645.0, 88306.0, 59899.0, 15746.0, 71087.0, 142173.0, 3086.0, 0.0],
            [4.0, -13.0, 11.0, -9.0, -9.0, -3.0, -1.0, 4.0, 0.0],
            [-29.0, -1.0, 9.0, 6.0, -6.0, 5.0, 4.0, 0.0, 0.0],
        ],
        longitude_terms: [
            [3086.0, 15746.0, 69613.0, 59899.0, 75645.0, 88306.0, 12661.0, 2658.0, 0.0, 0.0],
            [21.0, -95.0, -157.0, 41.0, -5.0, 42.0, 23.0, 30.0, 0.0, 0.0],
            [-342.0, 136.0, -23.0, 62.0, 66.0, -52.0, -33.0, 17.0, 0.0, 0.0],
        ],
    },
    Orbit {
        axis: [0.723_329_820_0, 0.0, 0.0],
        longitude: [181.979_800_85, 2_106_641_364.335_48, 0.593_81],
        eccentricity: [0.006_771_916_4, -0.000_477_652_1, 98_127e-10],
        perihelion: [131.563_703_00, 175.486_40, -498.481_84],
        inclination: [3.394_661_89, -30.844_37, -11.678_36],
        node: [76.679_920_19, -10_008.481_54, -51.326_14],
        axis_terms: [
            [21863.0, 32794.0, 26934.0, 10931.0, 26250.0, 43725.0, 53867.0, 28939.0, 0.0],
            [-156.0, 59.0, -42.0, 6.0, 19.0, -20.0, -10.0, -12.0, 0.0],
            [-48.0, -125.0, -26.0, -37.0, 18.0, -13.0, -20.0, -2.0, 0.0],
        ],
        longitude_terms: [
            [21863.0, 32794.0, 10931.0, 73.0, 4387.0, 26934.0, 1473.0, 2157.0, 0.0, 0.0],
            [-160.0, -313.0, -235.0, 60.0, -74.0, -76.0, -27.0, 34.0, 0.0, 0.0],
            [524.0, -149.0, -35.0, 117.0, 151.0, 122.0, -71.0, -62.0, 0.0, 0.0],
        ],
    },
    Orbit {
        axis: [1.523_679_341_9, 3e-10, 0.0],
        longitude: [355.432_999_58, 689_050_774.939_88, 0.942_64],
        eccentricity: [0.093_400_647_7, 0.000_904_843_8, -80_641e-10],
        perihelion: [336.060_233_95, 15_980.459_08, -62.328_00],
        inclination: [1.849_726_48, -293.317_22, -8.118_30],
        node: [49.558_093_21, -10_620.900_88, -230.574_16],
        axis_terms: [
            [6345.0, 7818.0, 15636.0, 7077.0, 8184.0, 14163.0, 1107.0, 4872.0, 0.0],
            [124.0, 621.0, -145.0, 208.0, 54.0, -57.0, 30.0, 15.0, 0.0],
            [-621.0, 532.0, -694.0, -20.0, 192.0, -94.0, 71.0, -73.0, 0.0],
        ],
        longitude_terms: [
            [10.0, 6345.0, 7818.0, 1107.0, 15636.0, 7077.0, 8184.0, 532.0, 10.0, 0.0],
            [2268.0, -979.0, 802.0, 602.0, -668.0, -33.0, 345.0, 201.0, -55.0, 0.0],
            [854.0, -205.0, -936.0, -240.0, 140.0, -341.0, -97.0, -232.0, 536.0, 0.0],
        ],
    },
    Orbit {
        axis: [5.202_603_209_2, 19_132e-10, -39e-10],
        longitude: [34.351_518_74, 109_256_603.779_91, -30.603_78],
        eccentricity: [0.048_497_925_5, 0.001_632_254_2, -0.000_047_136_6],
        perihelion: [14.331_206_87, 7_758.751_63, 259.959_38],
        inclination: [1.303_266_98, -71.558_90, 11.952_97],
        node: [100.464_407_02, 6_362.035_61, 326.521_78],
        axis_terms: [
            [1760.0, 1454.0, 1167.0, 880.0, 287.0, 2640.0, 19.0, 2047.0, 1454.0],
            [-23437.0, -2634.0, 6601.0, 6259.0, -1507.0, -1821.0, 2620.0, -2115.0, -1489.0],
            [-14614.0, -19828.0, -5869.0, 1881.0, -4372.0, -2255.0, 782.0, 930.0, 913.0],
        ],
        longitude_terms: [
            [19.0, 1760.0, 1454.0, 287.0, 1167.0, 880.0, 574.0, 2640.0, 19.0, 1454.0],
            [7610.0, -4997.0, -7689.0, -5841.0, -2617.0, 1115.0, -748.0, -607.0, 6074.0, 354.0],
            [-56980.0, 8016.0, 1012.0, 1448.0, -3024.0, -3710.0, 318.0, 503.0, 3767.0, 577.0],
        ],
    },
    Orbit {
        axis: [9.554_909_191_5, -0.000_021_389_6, 444e-10],
        longitude: [50.077_444_30, 43_996_098.557_32, 75.616_14],
        eccentricity: [0.055_548_142_6, -0.003_466_406_2, -0.000_064_363_9],
        perihelion: [93.057_237_48, 20_395.494_39, 190.259_52],
        inclination: [2.488_878_78, 91.851_95, -17.662_25],
        node: [113.665_502_52, -9_240.199_42, -66.237_43],
        axis_terms: [
            [574.0, 0.0, 880.0, 287.0, 19.0, 1760.0, 1167.0, 306.0, 574.0],
            [62911.0, -119919.0, 79336.0, 17814.0, -24241.0, 12068.0, 8306.0, -4893.0, 8902.0],
            [139737.0, 0.0, 24667.0, 51123.0, -5102.0, 7429.0, -4095.0, -1976.0, -9566.0],
        ],
        longitude_terms: [
            [19.0, 574.0, 287.0, 306.0, 1760.0, 12.0, 31.0, 38.0, 19.0, 574.0],
            [-18549.0, 30125.0, 20012.0, -730.0, 824.0, 23.0, 1289.0, -352.0, -14767.0, -2062.0],
            [138606.0, -13478.0, -4964.0, 1441.0, -1319.0, -1482.0, 427.0, 1236.0, -9167.0, -1918.0],
        ],
    },
    Orbit {
        axis: [19.218_446_061_8, -3_716e-10, 979e-10],
        longitude: [314.055_005_11, 15_424_811.939_33, -1.750_83],
        eccentricity: [0.046_381_222_1, -0.000_272_929_3, 0.000_007_891_3],
        perihelion: [173.005_291_06, 3_215.562_38, -34.092_88],
        inclination: [0.773_196_89, -60.727_23, 1.257_59],
        node: [74.005_957_01, 2_669.150_33, 145.939_64],
        axis_terms: [
            [204.0, 0.0, 177.0, 1265.0, 4.0, 385.0, 200.0, 208.0, 204.0],
            [389061.0, -262125.0, -44088.0, 8387.0, -22976.0, -2093.0, -615.0, -9720.0, 6633.0],
            [-138081.0, 0.0, 37205.0, -49039.0, -41901.0, -33872.0, -27037.0, -12474.0, 18797.0],
        ],
        longitude_terms: [
            [4.0, 204.0, 177.0, 8.0, 31.0, 200.0, 1265.0, 102.0, 4.0, 204.0],
            [-135245.0, -14594.0, 4197.0, -4030.0, -5630.0, -2898.0, 2540.0, -306.0, 2939.0, 1986.0],
            [71234.0, -41116.0, 5334.0, -4935.0, -1848.0, 66.0, 434.0, -1748.0, 3780.0, -701.0],
        ],
    },
];

/// Sum of the periodic terms `t` millennia after J2000.0. Terms from index `steady` on are multiplied by `t`.
fn periodic<const N: usize>(terms: &[[f64; N]; 3], t: f64, steady: usize) -> f64 {
    let [multiples, cosines, sines] = terms;
    let term = |k: usize| {
        let (s, c) = (multiples[k] * ARGUMENT_RATE * t).sin_cos();
        (cosines[k] * c + sines[k] * s) * if k < steady { 1.0 } else { t }
    };
    AMPLITUDE * (0..N).map(term).sum::<f64>()
}

/// Eccentric anomaly for a mean anomaly, both in rad: solves Kepler's equation by Newton's method.
fn eccentric_anomaly(mean: f64, eccentricity: f64) -> f64 {
    (0..8).fold(mean + eccentricity * mean.sin(), |e, _| {
        e - (e - eccentricity * e.sin() - mean) / (1.0 - eccentricity * e.cos())
    })
}

impl Orbit {
    /// Position relative to the sun's centre, au, in the mean equator and equinox of J2000.0, at `t` millennia of
    /// terrestrial time since J2000.0.
    pub fn heliocentric(&self, t: f64) -> DVec3 {
        let polynomial = |c: &[f64; 3]| c[0] + t * (c[1] + t * c[2]);
        let angle = |c: &[f64; 3]| (c[0] + t * (c[1] + t * c[2]) / 3600.0).to_radians();
        let axis = polynomial(&self.axis) + periodic(&self.axis_terms, t, 8);
        let longitude = angle(&self.longitude) + periodic(&self.longitude_terms, t, 8);
        let (eccentricity, perihelion) = (polynomial(&self.eccentricity), angle(&self.perihelion));
        let anomaly = eccentric_anomaly(longitude - perihelion, eccentricity);
        // x and y lie in the orbit's plane, x towards the perihelion. Three rotations lead to the ecliptic, one more to
        // the equator.
        let x = axis * (anomaly.cos() - eccentricity);
        let y = axis * (1.0 - eccentricity * eccentricity).sqrt() * anomaly.sin();
        let (inclination, node) = (angle(&self.inclination), angle(&self.node));
        let to_ecliptic = DMat3::from_rotation_z(node)
            * DMat3::from_rotation_x(inclination)
            * DMat3::from_rotation_z(perihelion - node);
        ecliptic_to_equator() * (to_ecliptic * DVec3::new(x, y, 0.0))
    }
}

/// Obliquity of the ecliptic of J2000.0, rad.
fn obliquity() -> f64 {
    (OBLIQUITY_AS / 3600.0).to_radians()
}

/// Rotation from the mean ecliptic to the mean equator, both of J2000.0.
pub(super) fn ecliptic_to_equator() -> DMat3 {
    DMat3::from_rotation_x(obliquity())
}
