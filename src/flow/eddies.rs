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

use super::lattice::{Faces, Lattice};

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

/// Finds the eddy viscosity of each cell, m2/s. The ghosts of `v` must be filled.
pub(super) fn viscosity(lattice: &Lattice, v: &Faces, cells: &mut [f32]) {
    let h = lattice.h;
    lattice.each_cell(|_, cell, at| {
        let mut a = [[0.0_f32; 3]; 3];
        for j in lattice.axes() {
            let (u, own) = (&v[j], lattice.stride[j]);
            for i in lattice.axes() {
                let s = lattice.stride[i];
                a[i][j] = if i == j {
                    (u[at + own] - u[at]) / h[i]
                } else {
                    0.25 * (u[at + s] + u[at + s + own] - u[at - s] - u[at - s + own]) / h[i]
                };
            }
        }
        let all: f32 = a.iter().flatten().map(|v| v * v).sum();
        if all < 1e-12 {
            cells[cell] = 0.0;
            return;
        }
        let b = |i: usize, j: usize| (0..3).map(|m| h[m] * h[m] * a[m][i] * a[m][j]).sum::<f32>();
        let [b11, b22, b33] = [b(0, 0), b(1, 1), b(2, 2)];
        let [b12, b13, b23] = [b(0, 1), b(0, 2), b(1, 2)];
        let sum = b11 * b22 - b12 * b12 + b11 * b33 - b13 * b13 + b22 * b33 - b23 * b23;
        cells[cell] = C * (sum.max(0.0) / all).sqrt();
    });
}

/// Mixes a component over `dt` seconds in one explicit step, by the viscosity of the cells plus the uniform viscosity
/// `even`. `old` has the values before the step.
pub(super) fn mix(lattice: &Lattice, cells: &[f32], even: f32, dt: f32, c: usize, (old, v): (&[f32], &mut [f32])) {
    let n = lattice.n;
    let steps = [1, n[0], n[0] * n[1]];
    lattice.each(c, |i, at| {
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
            sum += ((beside(true) + even) * (old[at + s] - old[at]) - (beside(false) + even) * (old[at] - old[at - s]))
                / hh;
        }
        v[at] += dt * sum;
    });
}
