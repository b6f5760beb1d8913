//! Friction of the air at rough walls.
//!
//! Along a wall the mean wind grows with the logarithm of the distance y (Prandtl 1925): u = u*/kappa ln(y/z0), with
//! the friction velocity u* and von Karman's constant kappa. Let the air have the speed u at the distance y from a wall
//! of roughness length z0. Each square metre of the wall then takes momentum from the air at the rate u*^2 = (kappa /
//! ln(y/z0))^2 u^2 times the air's density (Schumann 1975, for grids too coarse to resolve the layer at a wall). y is
//! the distance to the middle of the open part of the cell at the wall. The logarithm takes y + z0 in place of y, so
//! that it does not fall below zero in thin cells.

use super::{
    lattice::{Faces, Lattice},
    openings::Openings,
};

/// Von Karman's constant.
const KAPPA: f64 = 0.4;

/// Value beside a wall: its index, and the share of its speed that the wall takes per metre of path, 1/m.
#[derive(Clone, Copy, Debug)]
struct Rubbed {
    /// Position in the list of a component.
    at: u32,
    /// Share of its speed that the wall takes per metre of path, 1/m.
    per_m: f32,
}

/// Values of each component beside walls.
#[derive(Clone, Debug, Default)]
pub(super) struct Walls([Vec<Rubbed>; 3]);

/// Returns (u*/u)^2 for the speed u in the middle of an open width, m. u* is the friction velocity.
fn friction(open_m: f64, roughness_m: f64) -> f64 {
    let ratio = KAPPA / libm::log(1.0 + 0.5 * open_m / roughness_m);
    (ratio * ratio).min(1.0)
}

impl Walls {
    /// Finds the walls of a grid: closed parts of faces, and the floor if `floor` is set. There are none if
    /// `roughness_m` is 0.
    pub(super) fn find(&mut self, lattice: &Lattice, openings: &Openings, roughness_m: f64, floor: bool) {
        self.0.iter_mut().for_each(Vec::clear);
        if roughness_m <= 0.0 {
            return;
        }
        for c in lattice.axes() {
            let open = &openings.open[c];
            let list = &mut self.0[c];
            lattice.each(c, |i, at| {
                let own = open[at];
                if own == 0.0 {
                    return;
                }
                let mut per_m = 0.0;
                for a in lattice.axes().filter(|a| *a != c) {
                    let (s, h) = (lattice.stride[a], f64::from(lattice.h[a]));
                    let below = if i[a] > 0 {
                        open[at - s]
                    } else if a == 2 && floor {
                        0.0
                    } else {
                        1.0
                    };
                    let above = if i[a] + 1 < lattice.n[a] { open[at + s] } else { 1.0 };
                    for beside in [below, above] {
                        // Open share of this face that the neighbouring face does not have: there the air touches a
                        // wall.
                        let wall = f64::from((own - beside).max(0.0));
                        if wall > 0.0 {
                            per_m += friction(f64::from(own) * h, roughness_m) * wall / (f64::from(own) * h);
                        }
                    }
                }
                if per_m > 0.0 {
                    list.push(Rubbed { at: at as u32, per_m: per_m as f32 });
                }
            });
        }
    }

    /// Applies the friction of walls over `dt` seconds at the speeds of `wind`. The step is implicit and stable for any
    /// `dt`.
    pub(super) fn rub(&self, lattice: &Lattice, wind: &Faces, dt: f32, v: &mut Faces) {
        for c in lattice.axes() {
            for Rubbed { at, per_m } in &self.0[c] {
                let at = *at as usize;
                let mut square = wind[c][at] * wind[c][at];
                for a in lattice.axes().filter(|a| *a != c) {
                    let (along, across) = (lattice.stride[a], lattice.stride[c]);
                    let w = &wind[a];
                    let mean = 0.25 * (w[at] + w[at + along] + w[at - across] + w[at + along - across]);
                    square += mean * mean;
                }
                v[c][at] /= 1.0 + dt * per_m * square.sqrt();
            }
        }
    }
}
