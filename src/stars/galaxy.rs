//! The Milky Way: starlight by galactic longitude and latitude, from a disc of stars with dust in it.

use std::sync::OnceLock;

use glam::{DMat3, DVec3};

use crate::almanac::celestial::equatorial_direction;

/// Light of all stars of the disc over the sun's place, both sides together, solar luminosities (V) a square parsec (Flynn et al. 2006,
/// MNRAS 372, 1149).
const COLUMN_LV_PC2: f64 = 24.3;
/// Tenth-magnitude stars a square degree of one solar luminosity a square parsec: a square degree at 10 pc is 0.030 square parsecs, and
/// the sun has magnitude 4.83 there.
const S10_PER_LV_PC2: f64 = 3.563;
/// From the sun to the centre, kpc (GRAVITY Collaboration 2019).
const CENTRE_KPC: f64 = 8.2;
/// Lengths over which the disc's stars and dust thin out by e outwards, kpc (Juric et al. 2008; Drimmel and Spergel 2001).
const STARS_LENGTH_KPC: f64 = 2.6;
const DUST_LENGTH_KPC: f64 = 2.3;
/// Heights over which light and dust fall by e far off the plane, kpc, as sech^2(z / 2h): that of the light lies between those of young
/// (0.1) and old stars (0.3).
const STARS_HEIGHT_KPC: f64 = 0.13;
const DUST_HEIGHT_KPC: f64 = 0.08;
/// Absorption in the plane near the sun, optical depth a kiloparsec: 0.8 magnitudes.
const DUST_PER_KPC: f64 = 0.8 / 1.0857;
/// How far a line of sight is followed, kpc, and in how many steps.
const REACH_KPC: f64 = 15.0;
const STEPS: u32 = 64;

/// From the equator and equinox of J2000.0 to galactic axes: x to the galactic centre, z to the north galactic pole (pole 192.85948,
/// +27.12825; longitude of the celestial pole 122.93192 degrees; ESA 1997, volume 1, section 1.5.3).
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
/// Integrates `j(R, z) exp(-depth)` along the line of sight, `j` and the dust each as exp(-R/length) sech^2(z / 2 height). Symmetric in
/// longitude and latitude: clouds of stars and dark clouds, which vary it by half, are not in it, nor is the bulge.
pub fn starlight_s10(galactic: DVec3) -> f64 {
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

/// Light of the catalogue's stars along a galactic direction, S10, smoothed: a fit to [`super::catalogue::catalogue`] by latitude.
pub fn catalogue_s10(galactic: DVec3) -> f64 {
    let latitude = galactic.z.clamp(-1.0, 1.0).asin().to_degrees();
    14.5 + 24.0 * (-(latitude / 23.0).powi(2)).exp()
}

/// Light of the stars that the catalogue does not have, S10: all less its own, so that drawn stars do not count twice. From a table
/// over one quarter of the sky, as all quarters are alike: within 3 % of the integral.
pub fn unresolved_s10(galactic: DVec3) -> f64 {
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let nodes = LATITUDES_DEG.len() * (LONGITUDES + 1);
        (0..nodes).map(|i| at_node(i / (LONGITUDES + 1), i % (LONGITUDES + 1))).collect()
    });
    let latitude = galactic.z.abs().min(1.0).asin().to_degrees();
    let row = LATITUDES_DEG.partition_point(|b| *b <= latitude).clamp(1, LATITUDES_DEG.len() - 1) - 1;
    let v = (latitude - LATITUDES_DEG[row]) / (LATITUDES_DEG[row + 1] - LATITUDES_DEG[row]);
    let x = galactic.y.atan2(galactic.x).abs() / std::f64::consts::PI * LONGITUDES as f64;
    let column = (x as usize).min(LONGITUDES - 1);
    let u = x - column as f64;
    let along = |row: usize| {
        let at = row * (LONGITUDES + 1) + column;
        table[at] + (table[at + 1] - table[at]) * u
    };
    along(row) + (along(row + 1) - along(row)) * v
}

/// Galactic latitudes of the table's rows, degrees: close where the band is steep.
const LATITUDES_DEG: [f64; 18] =
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 12.5, 15.0, 19.0, 24.0, 30.0, 40.0, 52.0, 68.0, 90.0];
/// Steps of half a turn of longitude.
const LONGITUDES: usize = 36;

/// A direction (galactic) of the table.
fn node(latitude_deg: f64, column: usize) -> DVec3 {
    equatorial_direction(column as f64 / LONGITUDES as f64 * 180.0, latitude_deg)
}

fn at_node(row: usize, column: usize) -> f64 {
    let galactic = node(LATITUDES_DEG[row], column);
    starlight_s10(galactic) - catalogue_s10(galactic)
}

#[cfg(test)]
mod tests {
    use super::super::catalogue::catalogue;
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
    fn the_table_is_within_three_percent_of_the_integral() {
        let mut worst = 0.0f64;
        for i in 0..1000 {
            let galactic = at(137.5 * f64::from(i), (f64::from(i) / 500.0 - 1.0).asin().to_degrees());
            let want = starlight_s10(galactic) - catalogue_s10(galactic);
            worst = worst.max((unresolved_s10(galactic) / want - 1.0).abs());
        }
        println!("table of starlight: {:.2} %", 100.0 * worst);
        assert!(worst < 0.03, "{worst}");
    }

    #[test]
    fn the_catalogues_share_by_latitude_is_what_its_stars_send() {
        let to_galactic = equator_to_galactic();
        // Eight bands of equal area, north and south together.
        let (mut sums, mut fits) = ([0.0; 8], [0.0; 8]);
        for star in catalogue() {
            let sine = (to_galactic * star.direction).z.abs();
            sums[((sine * 8.0) as usize).min(7)] += 10f64.powf(-0.4 * (star.magnitude - 10.0)) / (41_252.96 / 8.0);
        }
        for (i, fit) in fits.iter_mut().enumerate() {
            let sine = (i as f64 + 0.5) / 8.0;
            *fit = catalogue_s10(DVec3::new((1.0 - sine * sine).sqrt(), 0.0, sine));
        }
        for (sum, fit) in sums.iter().zip(&fits) {
            assert!((sum / fit - 1.0).abs() < 0.3, "{sums:.1?} {fits:.1?}");
        }
        let total = |v: &[f64; 8]| v.iter().sum::<f64>();
        assert!((total(&sums) / total(&fits) - 1.0).abs() < 0.03, "{} {}", total(&sums), total(&fits));
    }

    #[test]
    fn starlight_is_as_measured() {
        // Leinert et al. 1998, section 10, and Roach and Megill 1961: some 30 at the poles without the stars of the eye, 160 to 640 in
        // the plane.
        let pole = unresolved_s10(DVec3::Z);
        assert!((22.0..35.0).contains(&pole), "{pole}");
        for l in [0.0, 45.0, 90.0, 180.0] {
            let band = (-8..=8).map(|b| starlight_s10(at(l, f64::from(b)))).fold(0.0, f64::max);
            assert!((150.0..640.0).contains(&band), "{l}: {band}");
            let contrast = band / starlight_s10(DVec3::Z);
            assert!((4.0..16.0).contains(&contrast), "{l}: {contrast}");
        }
        // Brightest towards the centre, beside the dust of the plane itself; faintest in the plane away from it.
        assert!(starlight_s10(at(0.0, 5.0)) > 1.2 * starlight_s10(at(0.0, 0.0)));
        assert!(starlight_s10(at(0.0, 5.0)) > 1.5 * starlight_s10(at(180.0, 5.0)));
    }

    #[test]
    fn starlight_has_no_seams_and_is_never_negative() {
        for l in 0..360 {
            for b in -90..90 {
                let (l, b) = (f64::from(l), f64::from(b));
                let here = unresolved_s10(at(l, b));
                assert!(here > 10.0);
                for (dl, db) in [(1.0, 0.0), (0.0, 1.0)] {
                    let there = unresolved_s10(at(l + dl, b + db));
                    assert!((there / here - 1.0).abs() < 0.2, "{l} {b}: {here} {there}");
                }
                if b < 0.0 && l < 180.0 {
                    assert!((unresolved_s10(at(-l, -b)) / here - 1.0).abs() < 1e-9);
                }
            }
        }
    }
}
