//! The Milky Way: starlight by galactic longitude and latitude, as a disc of stars with dust in it sends it.

use std::{f64::consts::TAU, sync::OnceLock};

use glam::{DMat3, DVec3};

use super::starlight::Starlight;
use crate::almanac::celestial::equatorial_direction;

/// Light of all stars of the disc over the sun's place, both sides together, solar luminosities (V) a square parsec
/// (Flynn et al. 2006, MNRAS 372, 1149).
const COLUMN_LV_PC2: f64 = 24.3;
/// Tenth-magnitude stars a square degree of one solar luminosity a square parsec: a square degree at 10 pc is 0.030
/// square parsecs, and the sun has magnitude 4.83 there.
const S10_PER_LV_PC2: f64 = 3.563;
/// From the sun to the centre, kpc (GRAVITY Collaboration 2019).
const CENTRE_KPC: f64 = 8.2;
/// Lengths over which the disc's stars and dust thin out by e outwards, kpc (Juric et al. 2008; Drimmel and Spergel
/// 2001).
const STARS_LENGTH_KPC: f64 = 2.6;
const DUST_LENGTH_KPC: f64 = 2.3;
/// Heights over which light and dust fall by e far off the plane, kpc, as sech^2(z / 2h): that of the light lies
/// between those of young (0.1) and old stars (0.3).
const STARS_HEIGHT_KPC: f64 = 0.13;
const DUST_HEIGHT_KPC: f64 = 0.08;
/// Absorption in the plane near the sun, optical depth a kiloparsec: 0.8 magnitudes.
const DUST_PER_KPC: f64 = 0.8 / 1.0857;
/// How far a line of sight is followed, kpc, and in how many steps.
const REACH_KPC: f64 = 15.0;
const STEPS: u32 = 64;

/// From the equator and equinox of J2000.0 to galactic axes: x to the galactic centre, z to the north galactic pole
/// (pole 192.85948, +27.12825; longitude of the celestial pole 122.93192 degrees; ESA 1997, volume 1, section 1.5.3).
pub fn equator_to_galactic() -> DMat3 {
    let pole = equatorial_direction(192.859_48, 27.128_25);
    // On the great circle of the celestial pole, whose galactic longitude is known, the way to the centre follows.
    let toward_celestial_pole = (DVec3::Z - pole * pole.z).normalize();
    let back = DMat3::from_axis_angle(pole, -122.931_92f64.to_radians());
    let centre = back * toward_celestial_pole;
    DMat3::from_cols(centre, pole.cross(centre), pole).transpose()
}

/// Light of all stars along a galactic direction (unit), S10: tenth-magnitude stars a square degree.
///
/// Integrates `j(R, z) exp(-depth)` along the line of sight, `j` and the dust each as exp(-R/length) sech^2(z / 2
/// height). Symmetric in longitude and latitude: clouds of stars and dark clouds, which vary it by half, are not in it,
/// nor is the bulge. What was measured brings them ([`super::starlight`]).
pub fn disc_s10(galactic: DVec3) -> f64 {
    let at_sun = COLUMN_LV_PC2 / (4.0 * STARS_HEIGHT_KPC * 1e3);
    let squared_sech = |x: f64| x.cosh().powi(-2);
    let (mut depth, mut sum) = (0.0f64, 0.0);
    for i in 0..STEPS {
        // Steps grow with distance: near the plane the dust's first kiloparsec counts most.
        let [begin, end] = [i, i + 1].map(|k| REACH_KPC * (f64::from(k) / f64::from(STEPS)).powi(2));
        let (s, ds) = (0.5 * (begin + end), end - begin);
        let p = galactic * s;
        let outwards = (CENTRE_KPC - p.x).hypot(p.y) - CENTRE_KPC;
        let light = at_sun * (-outwards / STARS_LENGTH_KPC).exp() * squared_sech(p.z / (2.0 * STARS_HEIGHT_KPC));
        let dust =
            DUST_PER_KPC * (-outwards / DUST_LENGTH_KPC).exp() * squared_sech(p.z / (2.0 * DUST_HEIGHT_KPC)) * ds;
        // Mean over the step of what its own dust leaves.
        let left = if dust > 1e-6 { (1.0 - (-dust).exp()) / dust } else { 1.0 };
        sum += light * ds * 1e3 * left * (-depth).exp();
        depth += dust;
    }
    sum * S10_PER_LV_PC2
}

/// Light of the stars that are not drawn as points, S10, along a galactic direction (unit): from a table of
/// [`Starlight`], within 4 % of it.
pub fn unresolved_s10(galactic: DVec3) -> f64 {
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let starlight = Starlight::measured();
        let nodes = ROWS * COLUMNS;
        (0..nodes).map(|i| starlight.s10(node(i / COLUMNS, i % COLUMNS))).collect()
    });
    let latitude = galactic.z.clamp(-1.0, 1.0).asin().to_degrees();
    let latitudes: [f64; ROWS] = std::array::from_fn(latitude_deg);
    let row = latitudes.partition_point(|b| *b <= latitude).clamp(1, ROWS - 1) - 1;
    let v = (latitude - latitudes[row]) / (latitudes[row + 1] - latitudes[row]);
    let x = galactic.y.atan2(galactic.x).rem_euclid(TAU) / TAU * COLUMNS as f64;
    let column = (x as usize).min(COLUMNS - 1);
    let u = x - column as f64;
    let along = |row: usize| {
        let [a, b] = [column, (column + 1) % COLUMNS].map(|column| table[row * COLUMNS + column]);
        a + (b - a) * u
    };
    along(row) + (along(row + 1) - along(row)) * v
}

/// Galactic latitudes of the table's rows north of the plane, degrees: close where the band is steep.
const LATITUDES_DEG: [f64; 29] = [
    0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 12.5, 15.0, 18.0, 21.0, 24.0, 27.0, 30.0, 33.0, 36.0, 40.0, 45.0,
    50.0, 56.0, 61.0, 66.0, 70.0, 75.0, 80.0, 85.0, 90.0,
];
const ROWS: usize = 2 * LATITUDES_DEG.len() - 1;
/// Steps of a turn of longitude.
const COLUMNS: usize = 144;

/// Returns the galactic latitude of a row of the table, degrees; rows run from south to north.
fn latitude_deg(row: usize) -> f64 {
    let plane = LATITUDES_DEG.len() - 1;
    if row < plane { -LATITUDES_DEG[plane - row] } else { LATITUDES_DEG[row - plane] }
}

/// A direction (galactic) of the table.
fn node(row: usize, column: usize) -> DVec3 {
    equatorial_direction(column as f64 * 360.0 / COLUMNS as f64, latitude_deg(row))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(longitude_deg: f64, latitude_deg: f64) -> DVec3 {
        equatorial_direction(longitude_deg, latitude_deg)
    }

    #[test]
    fn galactic_axes_are_those_of_known_places() {
        let m = equator_to_galactic();
        let seen = |ra: f64, dec: f64| {
            let g = m * equatorial_direction(ra, dec);
            [g.y.atan2(g.x).to_degrees().rem_euclid(360.0), g.z.asin().to_degrees()]
        };
        assert!((m.determinant() - 1.0).abs() < 1e-12);
        // Sagittarius A* lies at 359.944, -0.046; the celestial pole at 122.932, 27.128; Vega at 67.448, 19.237.
        for (ra, dec, l, b) in [
            (266.4168, -29.0078, 359.944, -0.046),
            (0.0, 90.0, 122.932, 27.128),
            (279.234_73, 38.783_69, 67.448, 19.237),
        ] {
            let got = seen(ra, dec);
            assert!((got[0] - l).abs() < 0.002 && (got[1] - b).abs() < 0.002, "{got:?}");
        }
    }

    #[test]
    fn the_table_is_within_four_percent_of_the_map() {
        let starlight = Starlight::measured();
        let mut off: Vec<_> = (0..1000)
            .map(|i| {
                let galactic = at(137.5 * f64::from(i), (f64::from(i) / 500.0 - 1.0).asin().to_degrees());
                (unresolved_s10(galactic) / starlight.s10(galactic) - 1.0).abs()
            })
            .collect();
        off.sort_by(f64::total_cmp);
        println!("table of starlight: {:.2} %", 100.0 * off[999]);
        assert!(off[999] < 0.04, "{}", off[999]);
    }

    #[test]
    fn starlight_is_as_measured() {
        // Leinert et al. 1998, section 10, and Roach and Megill 1961: some 30 at the poles without the stars of the
        // eye, 160 to 640 in the plane, more towards the centre.
        for pole in [DVec3::Z, -DVec3::Z] {
            let s10 = unresolved_s10(pole);
            assert!((28.0..38.0).contains(&s10), "{s10}");
        }
        for l in [45.0, 90.0, 180.0, 290.0] {
            let band = (-8..=8).map(|b| unresolved_s10(at(l, f64::from(b)))).fold(0.0, f64::max);
            assert!((150.0..640.0).contains(&band), "{l}: {band}");
            let contrast = band / unresolved_s10(DVec3::Z);
            assert!((4.0..18.0).contains(&contrast), "{l}: {contrast}");
        }
        // Brightest towards the centre, beside the dust of the plane itself; faintest in the plane away from it.
        assert!(unresolved_s10(at(0.0, -4.0)) > 1.2 * unresolved_s10(at(0.0, 1.0)));
        assert!(unresolved_s10(at(0.0, -4.0)) > 2.5 * unresolved_s10(at(180.0, -4.0)));
        // The Large Magellanic Cloud stands out from what lies about it.
        assert!(unresolved_s10(at(280.5, -32.9)) > 1.5 * unresolved_s10(at(310.0, -32.9)));
    }

    #[test]
    fn starlight_has_no_seams() {
        for l in 0..360 {
            for b in -90..90 {
                let (l, b) = (f64::from(l), f64::from(b));
                let here = unresolved_s10(at(l, b));
                assert!(here > 20.0, "{l} {b}: {here}");
                for (dl, db) in [(1.0, 0.0), (0.0, 1.0)] {
                    let there = unresolved_s10(at(l + dl, b + db));
                    assert!((there / here - 1.0).abs() < 0.25, "{l} {b}: {here} {there}");
                }
            }
        }
    }
}
