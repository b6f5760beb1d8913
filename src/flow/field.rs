//! The field itself: settings, a step, the steady state, and questions to it.

use glam::{DVec3, Vec3};

use super::{
    advect::{Carrier, Scheme},
    lattice::{Faces, Lattice},
    obstacles::FlowObstacles,
    openings::Openings,
    pressure::{Pressure, PressureMethod, Solved},
    sides::{Role, Roles, Side, fastest, fill, roles},
};
use crate::error::{Error, Result, check_range};

/// Largest speed of the air that a field takes, m/s.
pub const MAX_SPEED_M_S: f64 = 300.0;

/// What a field is made of. Lengths count from the lowest corner of its box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowSettings {
    /// Cells east, north and up, 1 to 4096 each, at most 33,554,432 in all. An axis of one cell is flat: nothing changes along it.
    pub cells: [u32; 3],
    /// Size of a cell, m, \[1e-6, 10,000\].
    pub cell_m: DVec3,
    /// Low and high side of each axis.
    pub sides: [[Side; 2]; 3],
    /// How velocity is carried.
    pub scheme: Scheme,
    /// How the pressure is solved for.
    pub pressure: PressureMethod,
    /// The pressure is good enough where no cell's divergence times cell size exceeds this share of the largest speed, \[1e-7, 1\].
    pub tolerance: f64,
    /// Kinematic viscosity, m2/s, \[0, 1e6\]: 0 for weather, whose walls stop no air by it; tests set it.
    pub viscosity_m2_s: f64,
    /// Air slides along terrain and boxes; otherwise it sticks to them.
    pub is_slip: bool,
}

impl Default for FlowSettings {
    fn default() -> Self {
        Self {
            cells: [128, 128, 32],
            cell_m: DVec3::splat(4.0),
            sides: [[Side::Open; 2], [Side::Open; 2], [Side::Slip; 2]],
            scheme: Scheme::default(),
            pressure: PressureMethod::Multigrid { max_cycles: 50 },
            tolerance: 1e-4,
            viscosity_m2_s: 0.0,
            is_slip: true,
        }
    }
}

/// The air's velocity on a staggered grid, led through time.
#[derive(Clone, Debug)]
pub struct FlowField {
    settings: FlowSettings,
    lattice: Lattice,
    roles: Roles,
    outer: Faces,
    openings: Openings,
    pressure: Pressure,
    velocity: Faces,
    /// What steps are made in.
    scratch: [Faces; 3],
    /// Length of the step before, s; 0: there is none to lead on from.
    last_dt: f64,
    bounds: [Vec<[f32; 2]>; 3],
    /// Potentials of the first and the second projection of a step, from which the next step's begin.
    potentials: [Vec<f32>; 2],
    divergence: Vec<f32>,
    correction: Vec<f32>,
    solved: Solved,
}

fn check(settings: &FlowSettings) -> Result<()> {
    settings.pressure.check()?;
    check_range("flow.tolerance", settings.tolerance, 1e-7, 1.0, "")?;
    check_range("flow.viscosity_m2_s", settings.viscosity_m2_s, 0.0, 1e6, "m2/s")?;
    for (a, [low, high]) in settings.sides.into_iter().enumerate() {
        if (low == Side::Periodic) != (high == Side::Periodic) {
            return Err(Error::invalid(format!("flow.sides[{a}]"), "must be periodic on both sides or on neither"));
        }
        for side in [low, high] {
            if let Side::NoSlip(v) = side {
                check_range(
                    &format!("flow.sides[{a}].velocity"),
                    Vec3::from(v).length().into(),
                    0.0,
                    MAX_SPEED_M_S,
                    "m/s",
                )?;
            }
        }
    }
    Ok(())
}

impl FlowField {
    /// A field of air round `obstacles` that moves as `wind` says (m/s east, north, up, at a place), made free of divergence. Open
    /// sides keep that wind as the outer one.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for settings outside their ranges, for a wind that is not finite or over
    /// [`MAX_SPEED_M_S`], and for obstacles outside of the field or without a finite height.
    pub fn new(settings: &FlowSettings, obstacles: &FlowObstacles, wind: impl Fn(DVec3) -> DVec3) -> Result<Self> {
        check(settings)?;
        let lattice = Lattice::new(settings.cells, settings.cell_m)?;
        let outer = at_faces(&lattice, wind)?;
        let roles = roles(&lattice, &settings.sides, &outer);
        let openings = Openings::new(&lattice, &roles, obstacles.open(&lattice)?);
        let pressure = Pressure::new(openings.level(&lattice, &roles));
        let count = lattice.n.iter().product();
        let bounds = if settings.scheme == Scheme::MacCormack { lattice.len() } else { 0 };
        let mut field = Self {
            settings: *settings,
            roles,
            velocity: outer.clone(),
            outer,
            openings,
            pressure,
            scratch: [lattice.zeros(), lattice.zeros(), lattice.zeros()],
            last_dt: 0.0,
            bounds: [0, 1, 2].map(|_| vec![[0.0; 2]; bounds]),
            potentials: [0, 1].map(|_| vec![0.0; count]),
            divergence: vec![0.0; count],
            correction: vec![0.0; count],
            solved: Solved::default(),
            lattice,
        };
        field.begin();
        Ok(field)
    }

    /// Projects the velocity as it stands.
    fn begin(&mut self) {
        let mut v = std::mem::take(&mut self.velocity);
        self.potentials.iter_mut().for_each(|p| p.fill(0.0));
        self.last_dt = 0.0;
        self.fill_all(&mut v);
        self.project(&mut v, 0);
        self.velocity = v;
    }

    fn fill_all(&self, v: &mut Faces) {
        for c in self.lattice.axes() {
            self.openings.fill_inside(&self.lattice, self.settings.is_slip, c, &mut v[c]);
            fill(&self.lattice, &self.roles, &self.outer, c, &mut v[c]);
        }
    }

    /// Puts other obstacles into the air, which flows on round them.
    ///
    /// # Errors
    /// As [`FlowField::new`]; the field is as it was then.
    pub fn set_obstacles(&mut self, obstacles: &FlowObstacles) -> Result<()> {
        let open = obstacles.open(&self.lattice)?;
        self.openings = Openings::new(&self.lattice, &self.roles, open);
        self.pressure = Pressure::new(self.openings.level(&self.lattice, &self.roles));
        self.begin();
        Ok(())
    }

    /// Leads the field on by `dt` seconds.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time that is not in \[0, 1000\] s.
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

    /// Carries by the whole step and projects.
    fn step_whole(&mut self, dt: f64) {
        let from = std::mem::take(&mut self.velocity);
        let [mut to, mut other, spare] = std::mem::take(&mut self.scratch);
        self.carry(&from, &from, dt, &mut other, &mut to);
        self.project(&mut to, 0);
        self.velocity = to;
        self.scratch = [from, other, spare];
    }

    /// Carries by half a step, projects, mirrors, carries by half a step and projects. The wind that carries is that of the middle of each
    /// half, led on from the two winds before it: by the wind of the half's beginning, whirls would stray across the mean wind.
    fn step_mirrored(&mut self, dt: f64) {
        let from = std::mem::take(&mut self.velocity);
        let [mut wind, mut middle, mut to] = std::mem::take(&mut self.scratch);
        // The scratch still has the middle of the step before.
        let ahead = if self.last_dt > 0.0 { (0.5 * dt / self.last_dt).min(1.0) as f32 } else { 0.0 };
        lead_on(&from, &mut wind, ahead);
        self.carry(&from, &wind, dt / 2.0, &mut Faces::default(), &mut middle);
        let mut mirrored = wind;
        self.reflect(&mut middle, &mut mirrored);
        let mut wind = from;
        lead_on(&middle, &mut wind, 0.5);
        self.carry(&mirrored, &wind, dt / 2.0, &mut Faces::default(), &mut to);
        self.project(&mut to, 1);
        self.velocity = to;
        self.scratch = [middle, mirrored, wind];
        self.last_dt = dt;
    }

    /// Leads the field on until it rests: until in the time in which the fastest air crosses the box's longest side no velocity
    /// changes by more than `rest` of the largest. Steps have the length in which the fastest air passes `cfl` cells.
    ///
    /// Answers whether it rests; air that sheds whirls never does, and after `most` such times this gives up.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for `cfl` not in \[0.01, 64\] and `rest` not in \[1e-6, 1\].
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

    /// Projects `middle`, and makes `mirrored` what lies as far beyond the projection as it lay before.
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

    /// `to` becomes what `from` is after the wind has carried it by `dt` and viscosity has mixed it, ghosts filled.
    fn carry(&mut self, from: &Faces, wind: &Faces, dt: f64, other: &mut Faces, to: &mut Faces) {
        let mut bounds = std::mem::take(&mut self.bounds);
        let carrier = Carrier::new(&self.lattice, wind, self.range());
        let t = dt as f32;
        match self.settings.scheme {
            Scheme::SemiLagrangian => carrier.semi_lagrangian(from, t, to),
            Scheme::MacCormack => {
                carrier.predict(from, t, other, &mut bounds);
                self.fill_all(other);
                carrier.correct(from, other, t, &bounds, to);
            }
            Scheme::Reflection => carrier.cubic(from, t, to),
        }
        self.bounds = bounds;
        self.fill_all(to);
        self.diffuse(to, dt);
    }

    fn range(&self) -> [Option<[f32; 2]>; 3] {
        [0, 1, 2].map(|a| {
            let beyond = |role| if matches!(role, Role::In | Role::Out) { 0.5 } else { 0.0 };
            let [low, high] = self.roles[a];
            (low != Role::Periodic).then(|| [-beyond(low), self.lattice.n[a] as f32 + beyond(high)])
        })
    }

    /// Mixes by viscosity, in so many explicit steps that each is stable.
    fn diffuse(&mut self, v: &mut Faces, dt: f64) {
        let lattice = &self.lattice;
        let inverse: f64 = lattice.axes().map(|a| f64::from(lattice.h[a]).powi(-2)).sum();
        let parts = (2.0 * self.settings.viscosity_m2_s * dt * inverse / 0.9).ceil();
        if parts == 0.0 {
            return;
        }
        let amount = (self.settings.viscosity_m2_s * dt / parts) as f32;
        for _ in 0..parts as u32 {
            for c in lattice.axes() {
                let old = v[c].clone();
                lattice.each(c, |_, at| {
                    let curve = |a: usize| {
                        let s = lattice.stride[a];
                        (old[at - s] + old[at + s] - 2.0 * old[at]) / (lattice.h[a] * lattice.h[a])
                    };
                    v[c][at] += amount * lattice.axes().map(curve).sum::<f32>();
                });
            }
            self.fill_all(v);
        }
    }

    /// Makes a field, its ghosts filled, free of divergence; fills the ghosts again.
    ///
    /// The potential of the step before is taken off first, and only what is then missing is solved for: the correction is small,
    /// and so are its rounding errors. What rounding still leaves is solved for once more.
    fn project(&mut self, v: &mut Faces, which: usize) {
        self.openings.balance(&self.lattice, &self.roles, v);
        let tolerance = self.settings.tolerance as f32 * fastest(&self.lattice, v) as f32 / self.lattice.shortest_m();
        let mut potential = std::mem::take(&mut self.potentials[which]);
        let mut correction = std::mem::take(&mut self.correction);
        self.subtract_gradient(v, &potential);
        self.solved = Solved::default();
        for _ in 0..2 {
            self.find_divergence(v);
            correction.fill(0.0);
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

    fn subtract_gradient(&self, v: &mut Faces, potential: &[f32]) {
        let lattice = &self.lattice;
        let [nx, ny, _] = lattice.n;
        let steps = [1, nx, nx * ny];
        for a in lattice.axes() {
            let wraps = self.roles[a][0] == Role::Periodic;
            let (values, open) = (&mut v[a], &self.openings.open[a]);
            let (round, beyond) = ((lattice.n[a] - 1) * steps[a], lattice.n[a] * lattice.stride[a]);
            lattice.each_cell(|i, cell, at| {
                if open[at] == 0.0 || (i[a] == 0 && !wraps) {
                    return;
                }
                let before = if i[a] == 0 { cell + round } else { cell - steps[a] };
                values[at] -= (potential[cell] - potential[before]) / lattice.h[a];
                if i[a] == 0 {
                    values[at + beyond] = values[at];
                }
            });
        }
    }

    /// Air that leaves each cell through its open faces, over the cell's volume.
    fn find_divergence(&mut self, v: &Faces) {
        let (lattice, open) = (&self.lattice, &self.openings.open);
        let out = &mut self.divergence;
        out.fill(0.0);
        for a in lattice.axes() {
            let s = lattice.stride[a];
            lattice.each_cell(|_, cell, at| {
                out[cell] += (open[a][at + s] * v[a][at + s] - open[a][at] * v[a][at]) / lattice.h[a];
            });
        }
    }

    /// The largest divergence of a cell with air in it, times the shortest cell size over the largest speed: 0 in still air.
    pub fn largest_divergence(&mut self) -> f64 {
        let v = std::mem::take(&mut self.velocity);
        self.find_divergence(&v);
        let cells = self.divergence.iter().enumerate().filter(|(cell, _)| self.pressure.has_air(*cell));
        let most = cells.fold(0.0_f32, |most, (_, d)| most.max(d.abs()));
        let speed = fastest(&self.lattice, &v);
        self.velocity = v;
        if speed > 0.0 { f64::from(most * self.lattice.shortest_m()) / speed } else { 0.0 }
    }

    /// Kinetic energy of all air over its density, m5/s2 (m4/s2 for each metre along a flat axis).
    pub fn kinetic_energy(&self) -> f64 {
        let mut sum = 0.0;
        for c in self.lattice.axes() {
            let last = self.lattice.n[c];
            let wraps = self.roles[c][0] == Role::Periodic;
            self.lattice.each(c, |i, at| {
                // Faces on sides have half a cell; both ends of a periodic axis are one face.
                let share = if i[c] == 0 || i[c] == last { 0.5 } else { 1.0 };
                let open = f64::from(self.openings.open[c][at]);
                let v = f64::from(self.velocity[c][at]);
                sum += if wraps && i[c] == last {
                    0.0
                } else if wraps {
                    1.0
                } else {
                    share
                } * open
                    * v
                    * v;
            });
        }
        let cell: f64 = self.lattice.axes().map(|a| f64::from(self.lattice.h[a])).product();
        0.5 * sum * cell
    }

    /// The velocity at a place, m/s (east, north, up), linear between faces; outside of the box that of its nearest place.
    pub fn velocity_at(&self, place_m: DVec3) -> DVec3 {
        let carrier = Carrier::new(&self.lattice, &self.velocity, self.range());
        carrier.velocity_near((place_m / self.settings.cell_m).as_vec3().to_array()).as_dvec3()
    }

    /// The largest component of the velocity anywhere, m/s.
    pub fn fastest_m_s(&self) -> f64 {
        fastest(&self.lattice, &self.velocity)
    }

    /// How the last projection went.
    pub fn solved(&self) -> Solved {
        self.solved
    }
}

/// Makes `before` the wind that goes on from it through `now`, `ahead` times as far as from the one to the other.
fn lead_on(now: &Faces, before: &mut Faces, ahead: f32) {
    for (now, before) in now.iter().flatten().zip(before.iter_mut().flatten()) {
        *before = now + ahead * (now - *before);
    }
}

/// A wind at every face and ghost.
fn at_faces(lattice: &Lattice, wind: impl Fn(DVec3) -> DVec3) -> Result<Faces> {
    let mut faces = lattice.zeros();
    for c in lattice.axes() {
        let mut bad = None;
        lattice.each_with_ghosts(|i, at| {
            let place = [0, 1, 2].map(|a| {
                let half = if a == c && !lattice.is_flat(a) { 0.0 } else { 0.5 };
                (i[a] as f64 + half) * f64::from(lattice.h[a])
            });
            let v = wind(DVec3::from(place));
            if !(0.0..=MAX_SPEED_M_S).contains(&v.length()) {
                bad = Some(v);
            }
            faces[c][at] = v[c] as f32;
        });
        if let Some(v) = bad {
            return Err(Error::range("flow.wind", &format!("finite and at most {MAX_SPEED_M_S} m/s"), v));
        }
    }
    Ok(faces)
}
