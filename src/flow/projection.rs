//! Projection, which makes the air free of divergence, and the force of its pressure on obstacles.

use glam::DVec3;

use super::{
    advect::Scheme,
    field::FlowField,
    lattice::Faces,
    pressure::Solved,
    sides::{Role, fastest},
};

impl FlowField {
    /// Makes a velocity field, whose ghosts are filled, free of divergence, and fills the ghosts again. `which` is the
    /// index of the projection in its step, 0 or 1.
    ///
    /// The gradient of the previous step's potential is subtracted first, and only the rest is solved for: the
    /// correction is small, and so are its rounding errors. A second solution removes the divergence that rounding
    /// leaves.
    pub(super) fn project(&mut self, v: &mut Faces, which: usize) {
        self.openings.balance(&self.lattice, &self.roles, v);
        let tolerance = self.settings.tolerance as f32 * fastest(&self.lattice, v) as f32 / self.lattice.shortest_m();
        let mut potential = std::mem::take(&mut self.potentials[which]);
        let mut correction = std::mem::take(&mut self.correction);
        self.subtract_gradient(v, &potential);
        self.solved = Solved::default();
        for _ in 0..2 {
            self.find_divergence(v);
            let solved = self.pressure.solve(self.settings.pressure, &mut correction, &self.divergence, tolerance);
            self.subtract_gradient(v, &correction);
            potential.iter_mut().zip(&correction).for_each(|(p, c)| *p += c);
            self.solved = self.solved.then(solved);
            if solved.iterations == 0 || solved.residual > tolerance {
                break;
            }
        }
        self.potentials[which] = potential;
        self.correction = correction;
        self.fill_all(v);
    }

    /// Subtracts the gradient of a potential from the velocities of open faces.
    fn subtract_gradient(&self, v: &mut Faces, potential: &[f32]) {
        let lattice = &self.lattice;
        let [nx, ny, _] = lattice.n;
        let steps = [1, nx, nx * ny];
        for a in lattice.axes() {
            let wraps = self.roles[a][0] == Role::Periodic;
            let (values, open, h) = (&mut v[a], &self.openings.open[a], lattice.h[a]);
            let (round, beyond) = ((lattice.n[a] - 1) * steps[a], lattice.n[a] * lattice.stride[a]);
            lattice.each_cell_row(|j, k, cell, at| {
                // Of the cells of a row, either none, only the first, or all are the first along this axis.
                let firsts = [usize::from(a == 0), if j == 0 { nx } else { 0 }, if k == 0 { nx } else { 0 }][a];
                for i in 0..if wraps { firsts } else { 0 } {
                    if open[at + i] != 0.0 {
                        values[at + i] -= (potential[cell + i] - potential[cell + i + round]) / h;
                        values[at + i + beyond] = values[at + i];
                    }
                }
                if firsts == nx {
                    return;
                }
                let own = &potential[cell + firsts..cell + nx];
                let before = &potential[cell + firsts - steps[a]..cell + nx - steps[a]];
                let faces = values[at + firsts..at + nx].iter_mut().zip(&open[at + firsts..at + nx]);
                for ((value, open), (own, before)) in faces.zip(own.iter().zip(before)) {
                    *value -= if *open == 0.0 { 0.0 } else { (own - before) / h };
                }
            });
        }
    }

    /// Finds the divergence of each cell: the net flux out of it, with the flux that moving obstacles push, divided by
    /// the cell's volume.
    pub(super) fn find_divergence(&mut self, v: &Faces) {
        let (lattice, openings) = (&self.lattice, &self.openings);
        let out = &mut self.divergence;
        let nx = lattice.n[0];
        lattice.each_cell_row(|_, _, cell, at| {
            let out = &mut out[cell..cell + nx];
            out.fill(0.0);
            for a in lattice.axes() {
                let (s, h) = (lattice.stride[a], lattice.h[a]);
                let (open, v) = (&openings.open[a], &v[a]);
                let low = open[at..at + nx].iter().zip(&v[at..at + nx]);
                let high = open[at + s..at + s + nx].iter().zip(&v[at + s..at + s + nx]);
                for (out, (low, high)) in out.iter_mut().zip(low.zip(high)) {
                    *out += (high.0 * high.1 - low.0 * low.1) / h;
                }
                let pushed = &openings.pushed[a];
                if !pushed.is_empty() {
                    let pairs = pushed[at..at + nx].iter().zip(&pushed[at + s..at + s + nx]);
                    out.iter_mut().zip(pairs).for_each(|(out, (low, high))| *out += (high - low) / h);
                }
            }
        });
        if self.openings.pushed.iter().any(|p| !p.is_empty()) {
            // Cells inside obstacles have no flow.
            out.iter_mut().enumerate().filter(|(cell, _)| !self.pressure.has_air(*cell)).for_each(|(_, d)| *d = 0.0);
        }
    }

    /// Returns the force of the air's pressure on obstacles, divided by the air's density, m4/s2, as a mean over the
    /// last step. It includes only the obstacles in the box between the places `low_m` and `high_m`, m from the field's
    /// lowest corner.
    ///
    /// The pressure times the length of the step is the sum of the potentials of the step's projections. In the
    /// reflection scheme it is twice the first plus the second.
    pub fn pressure_force(&self, low_m: DVec3, high_m: DVec3) -> DVec3 {
        let (lattice, open) = (&self.lattice, &self.openings.open);
        let steps = [1, lattice.n[0], lattice.n[0] * lattice.n[1]];
        let h = lattice.h.map(f64::from);
        let times = if self.settings.scheme == Scheme::Reflection { [2.0, 1.0] } else { [1.0, 0.0] };
        let [first, second] = &self.potentials;
        let impulse = |cell: usize| times[0] * f64::from(first[cell]) + times[1] * f64::from(second[cell]);
        let mut force = DVec3::ZERO;
        for a in lattice.axes() {
            let area: f64 = lattice.axes().filter(|o| *o != a).map(|o| h[o]).product();
            lattice.each_cell(|i, cell, at| {
                let place = DVec3::from(lattice.place(a, i).map(f64::from)) * DVec3::from(h);
                if i[a] == 0 || place.cmplt(low_m).any() || place.cmpgt(high_m).any() {
                    return;
                }
                let before = cell - steps[a];
                let pressure = |cell: usize| if self.pressure.has_air(cell) { impulse(cell) } else { 0.0 };
                force[a] += (pressure(before) - pressure(cell)) * area * (1.0 - f64::from(open[a][at]));
            });
        }
        if self.last_dt > 0.0 { force / self.last_dt } else { DVec3::ZERO }
    }
}
