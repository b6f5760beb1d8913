//! The Milky Way: light of the stars that are not drawn as points, as a function of galactic direction.

use std::{f64::consts::TAU, sync::OnceLock};

use glam::DVec3;

pub use super::disc::{disc_s10, equator_to_galactic};
use super::starlight::Starlight;
use crate::almanac::celestial::equatorial_direction;
/// Light of the stars that are not drawn as points, S10, in a galactic direction (unit). It is interpolated in a table,
/// within 4 % of [`Starlight`], from which the first call computes the table.
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

/// Galactic latitudes of the table's rows north of the plane, degrees; rows are dense where the band is steep.
const LATITUDES_DEG: [f64; 29] = [
    0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 12.5, 15.0, 18.0, 21.0, 24.0, 27.0, 30.0, 33.0, 36.0, 40.0, 45.0,
    50.0, 56.0, 61.0, 66.0, 70.0, 75.0, 80.0, 85.0, 90.0,
];
/// Number of rows, from the south galactic pole to the north one.
const ROWS: usize = 2 * LATITUDES_DEG.len() - 1;
/// Number of columns around the full circle of longitude.
const COLUMNS: usize = 144;

/// Returns the galactic latitude of a row of the table, degrees; rows run from south to north.
fn latitude_deg(row: usize) -> f64 {
    let plane = LATITUDES_DEG.len() - 1;
    if row < plane { -LATITUDES_DEG[plane - row] } else { LATITUDES_DEG[row - plane] }
}

/// Galactic direction of an entry of the table.
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
        // Leinert et al. 1998, section 10, and Roach and Megill 1961: about 30 at the poles without the stars that an
        // eye sees, 160 to 640 in the plane, more towards the centre.
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
        // The light is brightest towards the centre, next to the dust of the plane, and faintest in the plane on the
        // other side.
        assert!(unresolved_s10(at(0.0, -4.0)) > 1.2 * unresolved_s10(at(0.0, 1.0)));
        assert!(unresolved_s10(at(0.0, -4.0)) > 2.5 * unresolved_s10(at(180.0, -4.0)));
        // The Large Magellanic Cloud is brighter than its surroundings.
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
