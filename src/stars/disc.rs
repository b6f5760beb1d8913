//! Model of the Milky Way's disc (light of its stars, dimmed by dust), and the galactic axes.

use glam::{DMat3, DVec3};

use crate::almanac::celestial::equatorial_direction;

/// Light of all stars of the disc above and below the plane at the sun's position, solar luminosities (V) a square
/// parsec of the plane (Flynn et al. 2006, MNRAS 372, 1149).
const COLUMN_LV_PC2: f64 = 24.3;
/// Number of tenth-magnitude stars a square degree that equal one solar luminosity a square parsec. A square degree at
/// 10 pc is 0.030 square parsecs, and the sun has magnitude 4.83 there.
const S10_PER_LV_PC2: f64 = 3.563;
/// Distance from the sun to the galactic centre, kpc (GRAVITY Collaboration 2019).
const CENTRE_KPC: f64 = 8.2;
/// Scale length of the disc's stars, kpc (Juric et al. 2008).
const STARS_LENGTH_KPC: f64 = 2.6;
/// Scale length of the disc's dust, kpc (Drimmel and Spergel 2001).
const DUST_LENGTH_KPC: f64 = 2.3;
/// Scale height h of the stars' light, kpc: between that of young (0.1) and of old stars (0.3). The light follows
/// sech^2(z / (2 h)), which far from the plane falls by a factor of e over each h.
const STARS_HEIGHT_KPC: f64 = 0.13;
/// Scale height of the dust, kpc, in the law of [`STARS_HEIGHT_KPC`].
const DUST_HEIGHT_KPC: f64 = 0.08;
/// Absorption in the plane near the sun, optical depth a kiloparsec; it is 0.8 magnitudes.
const DUST_PER_KPC: f64 = 0.8 / 1.0857;
/// Length over which a line of sight is integrated, kpc.
const REACH_KPC: f64 = 15.0;
/// Number of steps of the integral along a line of sight.
const STEPS: u32 = 64;

/// Rotation from the equator and equinox of J2000.0 to galactic axes: x to the galactic centre, z to the north galactic
/// pole (pole 192.85948, +27.12825; longitude of the celestial pole 122.93192 degrees; ESA 1997, volume 1, section
/// 1.5.3).
pub fn equator_to_galactic() -> DMat3 {
    let pole = equatorial_direction(192.859_48, 27.128_25);
    // The direction to the centre is the direction to the celestial pole, turned back by that pole's galactic
    // longitude.
    let toward_celestial_pole = (DVec3::Z - pole * pole.z).normalize();
    let back = DMat3::from_axis_angle(pole, -122.931_92f64.to_radians());
    let centre = back * toward_celestial_pole;
    DMat3::from_cols(centre, pole.cross(centre), pole).transpose()
}

/// Light of all stars along a galactic direction (unit), S10: tenth-magnitude stars a square degree.
///
/// Integrates `j(R, z) exp(-depth)` along the line of sight. The light `j` and the dust are each exp(-R/length)
/// sech^2(z / (2 height)). The model is symmetric in longitude and latitude. It has no bulge, and no star clouds or
/// dark clouds, which change the light by half. These features come from the measured light ([`super::starlight`]).
pub fn disc_s10(galactic: DVec3) -> f64 {
    let at_sun = COLUMN_LV_PC2 / (4.0 * STARS_HEIGHT_KPC * 1e3);
    let squared_sech = |x: f64| x.cosh().powi(-2);
    let (mut depth, mut sum) = (0.0f64, 0.0);
    for i in 0..STEPS {
        // Steps grow with distance, because near the plane the first kiloparsec of dust matters most.
        let [begin, end] = [i, i + 1].map(|k| REACH_KPC * (f64::from(k) / f64::from(STEPS)).powi(2));
        let (s, ds) = (0.5 * (begin + end), end - begin);
        let p = galactic * s;
        let outwards = (CENTRE_KPC - p.x).hypot(p.y) - CENTRE_KPC;
        let light = at_sun * (-outwards / STARS_LENGTH_KPC).exp() * squared_sech(p.z / (2.0 * STARS_HEIGHT_KPC));
        let dust =
            DUST_PER_KPC * (-outwards / DUST_LENGTH_KPC).exp() * squared_sech(p.z / (2.0 * DUST_HEIGHT_KPC)) * ds;
        // Mean transmittance within the step, whose own dust dims its light.
        let left = if dust > 1e-6 { (1.0 - (-dust).exp()) / dust } else { 1.0 };
        sum += light * ds * 1e3 * left * (-depth).exp();
        depth += dust;
    }
    sum * S10_PER_LV_PC2
}
