//! Mixing by eddies smaller than a cell.
//!
//! Vreman's model (2004, Phys. Fluids 16, 3670, eqs. 5 to 8) has the eddy viscosity
//!
//! ```text
//! nu = c sqrt(B / (a_ij a_ij)),  a_ij = du_j / dx_i,
//! B = b11 b22 - b12^2 + b11 b33 - b13^2 + b22 b33 - b23^2,  b_ij = sum over m of h_m^2 a_mi a_mj,
//! ```
//!
//! where h_m is the size of a cell along the axis m, and c = 2.5 C_S^2 = 0.07 with C_S = 0.17 of isotropic turbulence.
//! The viscosity is zero in parallel shear and at walls, and needs neither averages nor the distance from a wall.
//! [`GroundMixing`] maintains the shear over the ground.

use glam::Vec4;

use super::{
    lanes::{LANES, four, larger, lesser},
    lattice::{Faces, Lattice},
};

/// Mixing of the mean wind by eddies over the ground: the viscosity kappa u* z up to a longest mixing length (Prandtl
/// 1925). With the stress of rough walls ([`super::walls`]), the logarithmic profile of the inflow is then in balance.
#[derive(Clone, Debug, Default)]
pub(super) struct GroundMixing {
    /// Product kappa u* of von Karman's constant and the friction velocity, m/s; 0 for no mixing.
    pub speed_m_s: f32,
    /// Longest mixing length, m.
    pub most_m: f32,
    /// Height of the ground in the middle of each column of cells, m.
    pub ground_m: Vec<f32>,
}

impl GroundMixing {
    /// Returns the largest viscosity of this mixing, m2/s.
    pub fn most_m2_s(&self) -> f64 {
        f64::from(self.speed_m_s * self.most_m)
    }

    /// Adds the viscosity of this mixing to `cells`, the viscosity of each cell, m2/s.
    pub fn add(&self, lattice: &Lattice, cells: &mut [f32]) {
        if self.speed_m_s <= 0.0 {
            return;
        }
        let columns = lattice.n[0] * lattice.n[1];
        lattice.each_cell(|i, cell, _| {
            let height_m = (i[2] as f32 + 0.5) * lattice.h[2] - self.ground_m[cell % columns];
            cells[cell] += self.speed_m_s * height_m.clamp(0.0, self.most_m);
        });
    }
}

/// Constant c = 2.5 C_S^2 (Vreman 2004, section II).
const C: f32 = 0.07;

/// Finds the eddy viscosity of each cell, m2/s, limited to `most`. The ghosts of `v` must be filled.
pub(super) fn viscosity(lattice: &Lattice, v: &Faces, most: f32, cells: &mut [f32]) {
    let nx = lattice.n[0];
    lattice.each_cell_row(|_, _, cell, at| {
        for (i, cells) in (0..nx).step_by(LANES).zip(cells[cell..cell + nx].chunks_mut(LANES)) {
            let found = lesser(viscosity_of(lattice, v, at + i), Vec4::splat(most)).to_array();
            cells.copy_from_slice(&found[..cells.len()]);
        }
    });
}

/// Returns the eddy viscosity of four cells, m2/s. `start` is the position of the first cell's lower faces in the
/// lists.
#[inline]
fn viscosity_of(lattice: &Lattice, v: &Faces, start: usize) -> Vec4 {
    let h = lattice.h;
    let mut a = [[Vec4::ZERO; 3]; 3];
    for j in lattice.axes() {
        let own = lattice.stride[j];
        let u = |at: usize| four(&v[j][at..at + LANES]);
        for i in lattice.axes() {
            let s = lattice.stride[i];
            a[i][j] = if i == j {
                (u(start + own) - u(start)) / h[i]
            } else {
                0.25 * (u(start + s) + u(start + s + own) - u(start - s) - u(start - s + own)) / h[i]
            };
        }
    }
    let all = a.iter().flatten().fold(Vec4::ZERO, |sum, v| sum + *v * *v);
    let b = |i: usize, j: usize| {
        let part = |m: usize| h[m] * h[m] * a[m][i] * a[m][j];
        part(0) + part(1) + part(2)
    };
    let [b11, b22, b33] = [b(0, 0), b(1, 1), b(2, 2)];
    let [b12, b13, b23] = [b(0, 1), b(0, 2), b(1, 2)];
    let sum = b11 * b22 - b12 * b12 + b11 * b33 - b13 * b13 + b22 * b33 - b23 * b23;
    let found = C * (larger(sum, Vec4::ZERO) / all).sqrt();
    Vec4::select(all.cmplt(Vec4::splat(1e-12)), Vec4::ZERO, found)
}

/// One component of the air's velocity, and the viscosities that mix it.
pub(super) struct Mixing<'a> {
    pub lattice: &'a Lattice,
    /// Viscosity of each cell, and a uniform one that is added, m2/s.
    pub cells: &'a [f32],
    pub even: f32,
    /// Length of the step, s.
    pub dt: f32,
    pub component: usize,
    /// Values before the step.
    pub old: &'a [f32],
}

impl Mixing<'_> {
    /// Mixes the component in one explicit step.
    pub fn mix(&self, v: &mut [f32]) {
        let (lattice, c) = (self.lattice, self.component);
        let n = lattice.n;
        lattice.each_row(c, |j, k, at, count| {
            let is_inside = |a: usize, i: usize| i > 0 && i + 1 < n[a];
            // Cells at the sides lack a neighbour.
            let inner = if is_inside(1, j) && is_inside(2, k) { 1..n[0].saturating_sub(1) } else { 0..0 };
            let whole = inner.len() / LANES * LANES;
            for i in inner.clone().step_by(LANES).take(whole / LANES) {
                let mixed = four(&v[at + i..at + i + LANES]) + self.dt * self.inner_change([i, j, k], at + i);
                v[at + i..at + i + LANES].copy_from_slice(&mixed.to_array());
            }
            for i in (0..inner.start.min(count)).chain(inner.start + whole..count) {
                v[at + i] += self.dt * self.change([i, j, k], at + i);
            }
        });
    }

    /// Returns the rate of change of four values whose neighbours all lie inside the grid, m/s2.
    #[inline]
    fn inner_change(&self, i: [usize; 3], first: usize) -> Vec4 {
        let (lattice, c) = (self.lattice, self.component);
        let [nx, ny, _] = lattice.n;
        let steps = [1, nx, nx * ny];
        let above = i[0] + i[1] * steps[1] + i[2] * steps[2];
        let below = above - steps[c];
        let cells = |at: usize| four(&self.cells[at..at + LANES]);
        let old = |at: usize| four(&self.old[at..at + LANES]);
        let own = 0.5 * (cells(above) + cells(below));
        let mut sum = Vec4::ZERO;
        for a in lattice.axes() {
            let (s, step, hh) = (lattice.stride[a], steps[a], lattice.h[a] * lattice.h[a]);
            let [up, down] = if a == c {
                [cells(above), cells(below)]
            } else {
                let up = cells(above + step) + cells(below + step);
                let down = cells(above - step) + cells(below - step);
                [0.25 * up + 0.5 * own, 0.25 * down + 0.5 * own]
            };
            sum += ((up + self.even) * (old(first + s) - old(first))
                - (down + self.even) * (old(first) - old(first - s)))
                / hh;
        }
        sum
    }

    /// Returns the rate of change of a value, m/s2.
    fn change(&self, i: [usize; 3], place: usize) -> f32 {
        let Self { lattice, cells, even, component: c, old, .. } = *self;
        let n = lattice.n;
        let steps = [1, n[0], n[0] * n[1]];
        // The two cells on either side of the face.
        let above = (0..3).map(|a| i[a].min(n[a] - 1) * steps[a]).sum::<usize>();
        let below = if i[c] > 0 && i[c] < n[c] { above - steps[c] } else { above };
        let own = 0.5 * (cells[above] + cells[below]);
        let mut sum = 0.0;
        for a in lattice.axes() {
            let (s, hh) = (lattice.stride[a], lattice.h[a] * lattice.h[a]);
            let beside = |up: bool| {
                let is_in = if up { i[a] + 1 < n[a] } else { i[a] > 0 };
                if !is_in {
                    return own;
                }
                let to = |cell: usize| cells[if up { cell + steps[a] } else { cell - steps[a] }];
                if a == c { cells[if up { above } else { below }] } else { 0.25 * (to(above) + to(below)) + 0.5 * own }
            };
            sum += ((beside(true) + even) * (old[place + s] - old[place])
                - (beside(false) + even) * (old[place] - old[place - s]))
                / hh;
        }
        sum
    }
}
