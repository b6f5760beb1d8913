//! Step of the field, and its steady state.

use super::{
    advect::Scheme,
    eddies::{self, Mixing},
    field::FlowField,
    lanes::Carrier,
    lattice::Faces,
    sides::Role,
};
use crate::error::{Result, check_range};

impl FlowField {
    /// Advances the field by `dt` seconds.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time outside \[0, 1000\] s.
    pub fn step(&mut self, dt: f64) -> Result<()> {
        check_range("flow.dt_s", dt, 0.0, 1e3, "s")?;
        if dt == 0.0 {
            return Ok(());
        }
        match self.settings.scheme {
            Scheme::SemiLagrangian | Scheme::MacCormack => self.step_whole(dt),
            Scheme::Reflection => self.step_mirrored(dt),
        }
        Ok(())
    }

    /// Makes a step of the schemes that do not reflect: advection over the whole step, mixing, and one projection.
    fn step_whole(&mut self, dt: f64) {
        let from = std::mem::take(&mut self.velocity);
        let [mut to, mut other, spare] = std::mem::take(&mut self.scratch);
        self.carry(&from, &from, dt, &mut other, &mut to);
        self.mix(&from, dt, &mut other, &mut to);
        self.project(&mut to, 0);
        self.last_change_m_s = largest_of(&to, |c, at| to[c][at] - from[c][at]);
        self.velocity = to;
        self.scratch = [from, other, spare];
        self.last_dt = dt;
    }

    /// Makes a step of the scheme [`Scheme::Reflection`]: half a step of advection, a projection, a reflection, another
    /// half step of advection, and a projection. The air is carried by the wind in the middle of each half,
    /// extrapolated from the two earlier winds. With the wind at the half's beginning, vortices would drift across the
    /// mean wind.
    fn step_mirrored(&mut self, dt: f64) {
        let from = std::mem::take(&mut self.velocity);
        let [mut wind, mut middle, mut to] = std::mem::take(&mut self.scratch);
        // The scratch memory still has the middle of the previous step.
        let ahead = if self.last_dt > 0.0 { (0.5 * dt / self.last_dt).min(1.0) as f32 } else { 0.0 };
        lead_on(&from, &mut wind, ahead);
        self.carry(&from, &wind, dt / 2.0, &mut Faces::default(), &mut middle);
        self.mix(&wind, dt / 2.0, &mut to, &mut middle);
        let mut mirrored = wind;
        self.reflect(&mut middle, &mut mirrored);
        let mut wind = from;
        lead_on(&middle, &mut wind, 0.5);
        self.carry(&mirrored, &wind, dt / 2.0, &mut Faces::default(), &mut to);
        self.mix(&wind, dt / 2.0, &mut mirrored, &mut to);
        self.project(&mut to, 1);
        // `wind` is now middle + (middle - beginning) / 2, so 3 middle - 2 `wind` is the velocity at the beginning of
        // the step.
        self.last_change_m_s = largest_of(&to, |c, at| to[c][at] - (3.0 * middle[c][at] - 2.0 * wind[c][at]));
        self.velocity = to;
        self.scratch = [middle, mirrored, wind];
        self.last_dt = dt;
    }

    /// Advances the field until it is steady. It is steady once no velocity changes by more than `rest` times the
    /// largest speed while the fastest air crosses the box's longest side. In a step the fastest air passes `cfl`
    /// cells.
    ///
    /// Returns whether the field is steady. Air that sheds vortices never becomes steady, so the function gives up
    /// after `most` crossings.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for `cfl` outside \[0.01, 64\] and `rest` outside \[1e-6, 1\].
    pub fn settle(&mut self, cfl: f64, rest: f64, most: u32) -> Result<bool> {
        check_range("flow.cfl", cfl, 0.01, 64.0, "")?;
        check_range("flow.rest", rest, 1e-6, 1.0, "")?;
        let h = self.lattice.h.map(f64::from);
        let longest = self.lattice.axes().map(|a| self.lattice.n[a] as f64 * h[a]).fold(0.0, f64::max);
        let steps = (longest / (cfl * f64::from(self.lattice.shortest_m()))).ceil() as u32;
        for _ in 0..most {
            let speed = self.fastest_m_s();
            if speed == 0.0 {
                return Ok(true);
            }
            let before = self.velocity.clone();
            for _ in 0..steps {
                self.step(longest / speed / f64::from(steps))?;
            }
            let mut change = 0.0_f32;
            for c in self.lattice.axes() {
                self.lattice.each(c, |_, at| change = change.max((self.velocity[c][at] - before[c][at]).abs()));
            }
            if f64::from(change) <= rest * speed {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Projects `middle`, and sets `mirrored` to the reflection of `middle` at its projection: 2 x projected -
    /// unprojected.
    fn reflect(&mut self, middle: &mut Faces, mirrored: &mut Faces) {
        for c in self.lattice.axes() {
            mirrored[c].copy_from_slice(&middle[c]);
        }
        self.project(middle, 0);
        for c in self.lattice.axes() {
            mirrored[c].iter_mut().zip(&middle[c]).for_each(|(m, p)| *m = 2.0 * p - *m);
        }
        self.fill_all(mirrored);
    }

    /// Sets `target` to `source` carried by `wind` for `dt` seconds, and fills its ghosts and closed faces. `other` is
    /// scratch memory of MacCormack's scheme.
    fn carry(&mut self, source: &Faces, wind: &Faces, dt: f64, other: &mut Faces, target: &mut Faces) {
        let mut bounds = std::mem::take(&mut self.bounds);
        let carrier = Carrier::new(&self.lattice, wind, self.range());
        let t = dt as f32;
        match self.settings.scheme {
            Scheme::SemiLagrangian => carrier.semi_lagrangian(source, t, target),
            Scheme::MacCormack => {
                carrier.predict(source, t, other, &mut bounds);
                self.fill_all(other);
                carrier.correct(source, other, t, &bounds, target);
            }
            Scheme::Reflection => carrier.cubic(source, t, target),
        }
        self.bounds = bounds;
        self.fill_all(target);
    }

    /// Returns the range of places at which wind may be looked up along each axis, in cells; `None` along a periodic
    /// axis.
    pub(super) fn range(&self) -> [Option<[f32; 2]>; 3] {
        [0, 1, 2].map(|a| {
            let beyond = |role| if matches!(role, Role::In | Role::Out) { 0.5 } else { 0.0 };
            let [low, high] = self.roles[a];
            (low != Role::Periodic).then(|| [-beyond(low), self.lattice.n[a] as f32 + beyond(high)])
        })
    }

    /// Mixes `v` by viscosity and by eddies smaller than a cell, and applies the friction of walls. The mixing takes as
    /// many explicit steps as the viscosity and the mixing over the ground need to be stable. Vreman's eddy viscosity
    /// is limited to what is stable in these steps. `spare` is scratch memory.
    fn mix(&mut self, wind: &Faces, dt: f64, spare: &mut Faces, v: &mut Faces) {
        let even = self.settings.viscosity_m2_s;
        let ground = self.mixing.most_m2_s();
        if even + ground > 0.0 || self.settings.has_eddies {
            let lattice = &self.lattice;
            let inverse: f64 = lattice.axes().map(|a| f64::from(lattice.h[a]).powi(-2)).sum();
            let parts = (2.0 * (even + ground) * dt * inverse / 0.9).ceil().max(1.0);
            let mut cells = std::mem::take(&mut self.divergence);
            cells.fill(0.0);
            if self.settings.has_eddies {
                // Limit of the eddy viscosity for a stable explicit step.
                let most = ((0.45 * parts / (dt * inverse) - even - ground).max(0.0)) as f32;
                eddies::viscosity(lattice, v, most, &mut cells);
            }
            self.mixing.add(lattice, &mut cells);
            for _ in 0..parts as u32 {
                for c in lattice.axes() {
                    spare[c].copy_from_slice(&v[c]);
                    let (even, dt) = (even as f32, (dt / parts) as f32);
                    Mixing { lattice, cells: &cells, even, dt, component: c, old: &spare[c] }.mix(&mut v[c]);
                }
                self.fill_all(v);
            }
            self.divergence = cells;
        }
        if self.settings.roughness_m > 0.0 {
            self.walls.rub(&self.lattice, wind, dt as f32, v);
            self.fill_all(v);
        }
    }

    /// Returns the largest change of a velocity in the last step, divided by the step's length, m/s2.
    pub fn last_change_m_s2(&self) -> f64 {
        if self.last_dt > 0.0 { f64::from(self.last_change_m_s) / self.last_dt } else { 0.0 }
    }
}

/// Returns the largest absolute value of `f` over all values.
fn largest_of(faces: &Faces, f: impl Fn(usize, usize) -> f32) -> f32 {
    let all = faces.iter().enumerate().flat_map(|(c, v)| (0..v.len()).map(move |at| (c, at)));
    all.fold(0.0, |most, (c, at)| most.max(f(c, at).abs()))
}

/// Extrapolates from `earlier` through `now`, by `ahead` times the difference between the two, and stores the result in
/// `earlier`.
fn lead_on(now: &Faces, earlier: &mut Faces, ahead: f32) {
    for (now, earlier) in now.iter().flatten().zip(earlier.iter_mut().flatten()) {
        *earlier = now + ahead * (now - *earlier);
    }
}
