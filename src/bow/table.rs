//! Tables of the bows over the angle from the antisolar point, as shaders read them (`shaders/between/bow.wgsl`).

use std::{
    f64::consts::PI,
    sync::{LazyLock, OnceLock},
};

use glam::DVec3;

use super::reference::{Pair, Rays, WAVELENGTHS_NM, colour_shares, water_index};

use crate::numerics::smooth;

/// Number of entries of a table.
pub const ENTRIES: usize = 160;
/// Angle between neighbouring entries, rad: 0.4 degrees.
pub const STEP_RAD: f64 = 0.4 * PI / 180.0;
/// Difference that bows make to the phase function of drops, 1/sr per channel, over the angle from the antisolar point.
pub type Table = [[f64; 3]; ENTRIES];

/// Number of angles in one step of a table before smoothing by the disc of the light.
const FINE: usize = 2;
const FINE_ENTRIES: usize = ENTRIES * FINE + 1;
/// Radius of the disc of the sun or the moon, rad.
const DISC_RAD: f64 = 0.00465;
/// Entries over which the bows fade at the end of a table.
const FADE: usize = 24;

/// Drops of nearly one size, as five radii, micrometres, each with its share of the class's extinction. A table is a
/// sum over classes.
#[derive(Clone, Copy, Debug)]
struct Class {
    radii_um: [f64; 5],
    shares: [f64; 5],
}

/// Number of classes: droplets of fog, and five classes of rain by diameter.
pub(super) const CLASSES: usize = 6;
/// Diameters that separate the classes of rain, mm.
pub(super) const RAIN_EDGES_MM: [f64; CLASSES] = [0.1, 0.2, 0.4, 0.8, 1.6, 6.0];

/// Returns the drops of a class. Class 0 is fog: a gamma distribution with a mean diameter of 15 micrometres by
/// extinction and an effective variance of 0.1 (Hansen and Travis 1974). The others are rain, spread evenly over the
/// logarithm of the class's diameters. In the largest class the drops are spread up to 3.2 mm only.
fn class(i: usize) -> Class {
    if i == 0 {
        let radii_um = [4.0, 5.8, 7.5, 9.4, 12.0];
        // n(r) is proportional to r^7 exp(-10 r / 7.5), extinction to r^2 n(r), and dr to r (spacing of the radii).
        let weight = |r: f64| (r / 7.5).powi(9) * (-10.0 * r / 7.5).exp() * r;
        let all: f64 = radii_um.iter().map(|r| weight(*r)).sum();
        return Class { radii_um, shares: radii_um.map(|r| weight(r) / all) };
    }
    let (from, to) = (500.0 * RAIN_EDGES_MM[i - 1], 500.0 * RAIN_EDGES_MM[i].min(3.2));
    Class { radii_um: [0.1, 0.3, 0.5, 0.7, 0.9].map(|x| from * (to / from).powf(x)), shares: [0.2; 5] }
}

/// Rays of both bows at one wavelength, in all directions of a fine table.
struct RayTable {
    wavelength_nm: f64,
    bows: [(Rays, Vec<Option<Pair>>); 2],
}

fn fine_angle(j: usize) -> f64 {
    // The antisolar point itself is left out, because its sine is 0.
    (j as f64).max(0.25) * STEP_RAD / FINE as f64
}

static RAYS: LazyLock<Vec<RayTable>> = LazyLock::new(|| {
    let of = |nm: f64, inside: u32| {
        let rays = Rays { inside, index: water_index(nm) };
        (rays, (0..FINE_ENTRIES).map(|j| rays.pair(fine_angle(j))).collect())
    };
    WAVELENGTHS_NM.iter().map(|nm| RayTable { wavelength_nm: *nm, bows: [of(*nm, 1), of(*nm, 2)] }).collect()
});

/// Returns the phase function, 1/sr, of the bows of drops with the radius `radius_um`, micrometres, at one wavelength
/// and fine angle `j`, without smoothing by the light's disc. It is relative to the whole extinction, half of which is
/// diffraction.
fn bows_of(rays: &RayTable, radius_um: f64, j: usize) -> f64 {
    let size = 2.0 * PI * radius_um * 1e3 / rays.wavelength_nm;
    let of = |(rays, pairs): &(Rays, Vec<Option<Pair>>)| rays.intensity(size, fine_angle(j), pairs[j].as_ref());
    rays.bows.iter().map(of).sum::<f64>() / (2.0 * PI)
}

/// Smooths a fine table over the disc of the light, weighted by the disc's chords.
fn smoothed(fine: &[DVec3], i: usize) -> DVec3 {
    let step = STEP_RAD / FINE as f64;
    let reach = (DISC_RAD / step).ceil() as isize;
    let (mut sum, mut all) = (DVec3::ZERO, 0.0);
    for k in -reach..=reach {
        let chord = (1.0 - (k as f64 * step / DISC_RAD).powi(2)).max(0.0).sqrt();
        let j = ((i * FINE) as isize + k).unsigned_abs().min(fine.len() - 1);
        sum += fine[j] * chord;
        all += chord;
    }
    sum / all
}

/// Returns the smooth function that is subtracted from the bows, before it is scaled.
fn smooth_at(i: usize) -> f64 {
    (0.5 * PI * i as f64 / ENTRIES as f64).cos().powi(2)
}

fn class_table(i: usize) -> Table {
    let (class, shares) = (class(i), colour_shares());
    let fine: Vec<DVec3> = (0..FINE_ENTRIES)
        .map(|j| {
            let mut sum = DVec3::ZERO;
            for (rays, colour) in RAYS.iter().zip(&shares) {
                let light: f64 =
                    class.radii_um.iter().zip(&class.shares).map(|(r, share)| share * bows_of(rays, *r, j)).sum();
                sum += DVec3::from_array(*colour) * light;
            }
            sum
        })
        .collect();
    let mut table: [DVec3; ENTRIES] = std::array::from_fn(|j| {
        let left = ((ENTRIES - 1 - j) as f64 / FADE as f64).min(1.0);
        smoothed(&fine, j) * smooth(left)
    });
    // Subtract a smooth function with the same sum over the sphere.
    let sine = |j: usize| (j as f64 * STEP_RAD).sin();
    let all: DVec3 = (0..ENTRIES).map(|j| table[j] * sine(j)).sum();
    let smooth: f64 = (0..ENTRIES).map(|j| smooth_at(j) * sine(j)).sum();
    table.iter_mut().enumerate().for_each(|(j, v)| *v -= all / smooth * smooth_at(j));
    table.map(|v| v.to_array())
}

/// Returns the table of drops of all classes, each with its share of the extinction in `shares`.
pub(super) fn mixed(shares: &[f64; CLASSES]) -> Table {
    static TABLES: [OnceLock<Table>; CLASSES] = [const { OnceLock::new() }; CLASSES];
    let mut sum = [[0.0; 3]; ENTRIES];
    for (i, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        let table = TABLES[i].get_or_init(|| class_table(i));
        for (to, from) in sum.iter_mut().zip(table) {
            (0..3).for_each(|c| to[c] += share * from[c]);
        }
    }
    sum
}

/// Returns a table's value in `direction`, with the light at `to_light` (unit vectors), 1/sr per channel; 0 beyond the
/// table.
pub fn phase_in(table: &Table, direction: DVec3, to_light: DVec3) -> DVec3 {
    let angle = 2.0 * (0.5 * (direction + to_light).length()).min(1.0).asin();
    let place = angle / STEP_RAD;
    let i = place.floor() as usize;
    let at = |i: usize| table.get(i).map_or(DVec3::ZERO, |v| DVec3::from_array(*v));
    at(i).lerp(at(i + 1), place - i as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::luminance;

    /// Angle, degrees, of the largest entry of a channel between two angles, degrees.
    fn peak(table: &Table, channel: usize, first: f64, last: f64) -> f64 {
        let degrees = |i: usize| (i as f64 * STEP_RAD).to_degrees();
        let inside = (0..ENTRIES).filter(|i| (first..last).contains(&degrees(*i)));
        degrees(inside.max_by(|a, b| table[*a][channel].total_cmp(&table[*b][channel])).unwrap())
    }

    fn only(i: usize) -> Table {
        mixed(&std::array::from_fn(|k| f64::from(u8::from(k == i))))
    }

    #[test]
    fn the_bows_of_rain_stand_at_42_and_51_degrees_with_their_red_towards_each_other() {
        let rain = only(4);
        let primary = [0, 1, 2].map(|c| peak(&rain, c, 36.0, 46.0));
        let secondary = [0, 1, 2].map(|c| peak(&rain, c, 48.0, 58.0));
        println!("rain: primary {primary:?}, secondary {secondary:?} degrees");
        assert!(primary[0] > primary[2] && (41.2..=42.6).contains(&primary[0]), "{primary:?}");
        assert!(secondary[0] < secondary[2] && (50.0..=52.4).contains(&secondary[0]), "{secondary:?}");
        // Alexander's band is darker than both sides of it.
        let at = |degrees: f64| luminance(&rain[(degrees / STEP_RAD.to_degrees()) as usize]);
        println!(
            "primary {:.4}, inside {:.4}, band {:.4}, secondary {:.4} 1/sr",
            at(41.6),
            at(32.0),
            at(46.4),
            at(51.6)
        );
        assert!(at(46.4) < 0.0 && at(46.4) < at(32.0) && at(46.4) < at(60.0));
        assert!(at(41.6) > 2.0 * at(51.6) && at(51.6) > 0.0);
    }

    #[test]
    fn the_bow_of_fog_is_wide_and_white_and_inside_of_that_of_rain() {
        let spread = |table: &Table| {
            let most = (60..ENTRIES).max_by(|a, b| table[*a][1].total_cmp(&table[*b][1])).unwrap();
            let [r, g, b] = table[most];
            ((r.max(g).max(b) - r.min(g).min(b)) / luminance(&table[most]), most as f64 * STEP_RAD.to_degrees())
        };
        let ((fog, at), (rain, rain_at)) = (spread(&only(0)), spread(&only(4)));
        println!("fogbow at {at:.1} degrees, colour {fog:.2}; rainbow at {rain_at:.1}, {rain:.2}");
        assert!(fog < 0.35 && rain > 0.7, "{fog} {rain}");
        assert!((34.0..40.0).contains(&at) && at < rain_at - 2.0);
        let width = |table: &Table| {
            let most = table.iter().map(|v| v[1]).fold(0.0, f64::max);
            table.iter().skip(60).filter(|v| v[1] > 0.5 * most).count() as f64 * STEP_RAD.to_degrees()
        };
        println!("widths {:.1} and {:.1} degrees", width(&only(0)), width(&only(4)));
        assert!(width(&only(0)) > 3.0 * width(&only(4)));
    }

    #[test]
    fn bows_add_no_light_and_end_smoothly() {
        for i in 0..CLASSES {
            let table = only(i);
            for c in 0..3 {
                let over = |f: &dyn Fn(f64) -> f64| -> f64 {
                    table.iter().enumerate().map(|(j, v)| f(v[c]) * (j as f64 * STEP_RAD).sin()).sum()
                };
                assert!(over(&|v| v).abs() < 1e-9 * over(&f64::abs), "class {i}");
            }
            let most = table.iter().map(|v| v[1]).fold(0.0, f64::max);
            assert!(table[ENTRIES - 1].iter().all(|v| v.abs() < 0.01 * most), "class {i}");
        }
    }
}
