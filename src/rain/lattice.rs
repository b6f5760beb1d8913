//! Places of drops without a state: a lattice of cells that moves with the air. Each drop has a start of its own in its
//! cell and falls through the cell at its own speed.
//!
//! A shell is a cube of side L, filled with drops at random places and repeated in all directions; each drop is drawn
//! at the copy nearest to the camera. Positions are whole numbers of 2^-32 L. Their 32-bit sums wrap as the lattice
//! does, so they are exact at any time and place: place = random(seed, shell, class, index) + displacement of the air -
//! speed x fall phase. The last term applies to the height only. Fall speeds are integer multiples of [`SPEED_UNIT`];
//! the fall phase is the distance fallen at a speed of one unit.
//!
//! The innermost shell holds every drop in its volume from the smallest drawn size up or, above the limit of drawn
//! drops, an equal share of each class. Each further shell is wider by the factor 2^(1/3) and holds the same number of
//! drops, each of which represents twice as many drops as a drop of the next smaller shell does. Where rain is drawn as
//! single drops alone, these weights of 2, 4 and 8 make up for the contrast of all drops too far to be drawn
//! (`docs/lab/README.md`, the chart of rain).

use glam::DVec3;

use super::classes::Classes;
pub use super::shells::{
    CLASSES, HIDDEN_M, Moment, REACH_M, SHELLS, SIDE_M, SPEED_UNIT, hidden_m, shell_share, side_m,
};
pub use crate::falling::{
    lattice::{fraction, nearest, short_seed},
    random3,
};

/// One drop of the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Identity of the drop: shell, class and index.
    pub id: (u32, u32, u32),
    /// Place in the cell, from [`Moment::place`].
    pub place: [u32; 3],
    /// Position of the nearest copy relative to the camera, m.
    pub position_m: DVec3,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Share of the drop that its shell shows at this distance, 0 to 1.
    pub share: f64,
}

/// Returns all drops of `classes` as seen by a camera at `position_m` (east, north and up from a point fixed to the
/// world), after the air has moved by `displacement_m` in `time_s`. Two cameras see the same drop under the same id.
pub fn drops(
    classes: &Classes,
    seed: u64,
    position_m: DVec3,
    displacement_m: DVec3,
    time_s: f64,
) -> impl Iterator<Item = Drop> {
    let seed = short_seed(seed);
    (0..SHELLS).flat_map(move |shell| {
        let side = side_m(shell);
        let moment = Moment::new(shell, displacement_m, time_s);
        let eye = position_m.to_array().map(|x| fraction(x, side));
        (0..CLASSES).flat_map(move |class| {
            let row = classes.table[class];
            let before = if class > 0 { classes.table[class - 1][2] as u32 } else { 0 };
            (0..row[2] as u32 - before).map(move |index| {
                let place = moment.place(seed, shell, class, index, row[1] as u32);
                let position_m = nearest(place, eye, side);
                let share = shell_share(shell, position_m.length());
                let id = (shell as u32, class as u32, index);
                Drop { id, place, position_m, diameter_m: f64::from(row[0]), share }
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drop_falls_at_its_speed_at_any_time_and_neither_a_gust_nor_a_jump_throws_it() {
        let units = 256;
        for shell in 0..SHELLS {
            let side = side_m(shell);
            for t in [0.0, 17.3, 86_400.0, 1e6, 1e9] {
                for dt in [0.0, 1.0 / 60.0, 0.25] {
                    let wind = DVec3::new(12.0, -5.0, 0.0);
                    let far = wind * t;
                    let at = |t: f64, d: DVec3| Moment::new(shell, d, t).place(7, shell, 3, 11, units);
                    let (a, b) = (at(t, far), at(t + dt, far + wind * dt));
                    let moved = nearest(b, a, side);
                    let want = wind * dt - DVec3::Z * (f64::from(units) * SPEED_UNIT * dt);
                    let error = want - moved;
                    let cells = error / side;
                    let wrapped = (cells - cells.round()) * side;
                    assert!(wrapped.length() < 1e-4 * (1.0 + t * 1e-8), "shell {shell} t {t} dt {dt}: {wrapped}");
                }
            }
        }
    }

    #[test]
    fn time_backwards_is_time_forwards_and_places_fill_the_cell_evenly() {
        let at = |t: f64| Moment::new(1, DVec3::new(3.0, 4.0, 0.0), t);
        assert_eq!(at(123.456), at(123.456));
        let n = 8000;
        let mut octants = [0u32; 8];
        for i in 0..n {
            let p = at(50.0).place(1, 1, 5, i, 300);
            octants[p.iter().fold(0, |o, v| o * 2 + (v >> 31) as usize)] += 1;
        }
        // Poisson distribution: 1000 +- 32 each.
        assert!(octants.iter().all(|o| o.abs_diff(1000) < 150), "{octants:?}");
    }

    #[test]
    fn every_camera_sees_the_same_drop_where_their_reach_overlaps() {
        let m = Moment::new(2, DVec3::new(100.3, -70.0, 0.0), 9e5);
        let side = side_m(2);
        let place = m.place(9, 2, 1, 77, 400);
        for (eye, other) in
            [(DVec3::new(5.0, 3.0, 2.0), DVec3::new(7.5, 1.0, 2.5)), (DVec3::splat(1e6), DVec3::splat(1e6 + 3.0))]
        {
            let see = |eye: DVec3| eye + nearest(place, eye.to_array().map(|x| fraction(x, side)), side);
            let (a, b) = (see(eye), see(other));
            let apart = (a - b) / side;
            assert!((apart - apart.round()).length() < 1e-6, "{a} {b}");
        }
    }
}
