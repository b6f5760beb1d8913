//! Wind field: its velocity on the grid, its obstacles, and queries.

use glam::DVec3;

use super::{
    advect::Scheme,
    eddies::GroundMixing,
    lanes::Carrier,
    lattice::{Faces, Lattice},
    obstacles::{FlowObstacles, Shares},
    openings::Openings,
    pressure::{Pressure, Solved},
    settings::{FlowSettings, MAX_SPEED_M_S},
    sides::{Role, Roles, fastest, fill, roles},
    walls::Walls,
};
use crate::error::{Error, Result};

/// Velocity of the air on a staggered grid, advanced through time.
#[derive(Clone, Debug)]
pub struct FlowField {
    /// Settings with which the field was created.
    pub(super) settings: FlowSettings,
    /// Grid of the box.
    pub(super) lattice: Lattice,
    /// Present roles of the sides.
    pub(super) roles: Roles,
    /// Outer wind on and beyond the sides, m/s.
    pub(super) outer: Faces,
    /// Open shares of the faces, bodies of air, and layers of closed faces.
    pub(super) openings: Openings,
    /// Values beside rough walls.
    pub(super) walls: Walls,
    /// Mixing by eddies over the ground.
    pub(super) mixing: GroundMixing,
    /// Pressure equation and its solvers.
    pub(super) pressure: Pressure,
    /// Velocity of the air, m/s.
    pub(super) velocity: Faces,
    /// Scratch memory of steps. The first entry keeps the velocity in the middle of the previous step.
    pub(super) scratch: [Faces; 3],
    /// Length of the previous step, s; 0 if there is none to extrapolate from.
    pub(super) last_dt: f64,
    /// Largest change of a velocity in the last step, m/s.
    pub(super) last_change_m_s: f32,
    /// Scratch memory of MacCormack's scheme: range of the values from which each value was carried.
    pub(super) bounds: [Vec<[f32; 2]>; 3],
    /// Potentials of the first and the second projection of a step, from which those of the next step begin.
    pub(super) potentials: [Vec<f32>; 2],
    /// Divergence of each cell, 1/s; scratch memory of steps.
    pub(super) divergence: Vec<f32>,
    /// Change of the potential in a projection; scratch memory.
    pub(super) correction: Vec<f32>,
    /// Cost and error of the last projection.
    pub(super) solved: Solved,
}

impl FlowField {
    /// Creates a field around `obstacles` and makes its air free of divergence. `wind` returns the wind, m/s (east,
    /// north, up), at a place, m from the box's lowest corner. This wind is also the outer wind at open sides.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for settings outside their ranges, for a wind that is not finite or over
    /// [`MAX_SPEED_M_S`], and for obstacles outside the field or without a finite height.
    pub fn new(settings: &FlowSettings, obstacles: &FlowObstacles, wind: impl Fn(DVec3) -> DVec3) -> Result<Self> {
        settings.check()?;
        let lattice = Lattice::new(settings.cells, settings.cell_m)?;
        let outer = at_faces(&lattice, wind)?;
        let roles = roles(&lattice, &settings.sides, &outer);
        let openings = Openings::new(&lattice, &roles, obstacles.shares(&lattice)?);
        let pressure = Pressure::new(openings.level(&lattice, &roles));
        let count = lattice.n.iter().product();
        let bounds = if settings.scheme == Scheme::MacCormack { lattice.len() } else { 0 };
        let mut field = Self {
            settings: *settings,
            roles,
            velocity: outer.clone(),
            outer,
            openings,
            walls: Walls::default(),
            mixing: GroundMixing::default(),
            pressure,
            scratch: [lattice.zeros(), lattice.zeros(), lattice.zeros()],
            last_dt: 0.0,
            last_change_m_s: 0.0,
            bounds: [0, 1, 2].map(|_| vec![[0.0; 2]; bounds]),
            potentials: [0, 1].map(|_| vec![0.0; count]),
            divergence: vec![0.0; count],
            correction: vec![0.0; count],
            solved: Solved::default(),
            lattice,
        };
        field.find_walls();
        field.begin();
        Ok(field)
    }

    /// Makes the present velocity free of divergence, without using earlier steps.
    pub(super) fn begin(&mut self) {
        let mut v = std::mem::take(&mut self.velocity);
        self.potentials.iter_mut().for_each(|p| p.fill(0.0));
        self.last_dt = 0.0;
        self.fill_all(&mut v);
        self.project(&mut v, 0);
        self.velocity = v;
    }

    /// Fills the values of `v` beyond the sides and inside obstacles.
    pub(super) fn fill_all(&self, v: &mut Faces) {
        for c in self.lattice.axes() {
            self.openings.fill_inside(&self.lattice, self.settings.is_slip, c, &mut v[c]);
            fill(&self.lattice, &self.roles, &self.outer, c, &mut v[c]);
        }
    }

    /// Replaces the obstacles; the air flows on around the new ones.
    ///
    /// # Errors
    /// Errors of [`FlowField::new`]; the field then stays unchanged.
    pub fn set_obstacles(&mut self, obstacles: &FlowObstacles) -> Result<()> {
        self.take_shares(obstacles.shares(&self.lattice)?);
        self.begin();
        Ok(())
    }

    /// Replaces the open shares of the faces, and renews the pressure equation and the rough walls, which follow from
    /// them.
    pub(super) fn take_shares(&mut self, shares: Shares) {
        self.openings = Openings::new(&self.lattice, &self.roles, shares);
        self.pressure = Pressure::new(self.openings.level(&self.lattice, &self.roles));
        self.find_walls();
    }

    /// Finds the faces beside rough walls.
    pub(super) fn find_walls(&mut self) {
        let floor = self.roles[2][0] == Role::Slip;
        self.walls.find(&self.lattice, &self.openings, self.settings.roughness_m, floor);
    }

    /// Returns the largest divergence of a cell with air, times the shortest cell size, divided by the largest
    /// component of the velocity; 0 in still air.
    pub fn largest_divergence(&mut self) -> f64 {
        let v = std::mem::take(&mut self.velocity);
        self.find_divergence(&v);
        let cells = self.divergence.iter().enumerate().filter(|(cell, _)| self.pressure.has_air(*cell));
        let most = cells.fold(0.0_f32, |most, (_, d)| most.max(d.abs()));
        let speed = fastest(&self.lattice, &v);
        self.velocity = v;
        if speed > 0.0 { f64::from(most * self.lattice.shortest_m()) / speed } else { 0.0 }
    }

    /// Returns the kinetic energy of all air divided by its density, m5/s2 (m4/s2 per metre along a flat axis).
    pub fn kinetic_energy(&self) -> f64 {
        let mut sum = 0.0;
        for c in self.lattice.axes() {
            let last = self.lattice.n[c];
            let wraps = self.roles[c][0] == Role::Periodic;
            self.lattice.each(c, |i, at| {
                // Faces on sides have the weight of half a cell. Both ends of a periodic axis are one face.
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

    /// Returns the velocity, m/s (east, north, up), at a place, m from the box's lowest corner. It is linear between
    /// faces. Outside the box it is the velocity at the nearest place of the box. Along a periodic axis places wrap
    /// instead.
    pub fn velocity_at(&self, place_m: DVec3) -> DVec3 {
        let carrier = Carrier::new(&self.lattice, &self.velocity, self.range());
        carrier.velocity_near((place_m / self.settings.cell_m).as_vec3().to_array()).as_dvec3()
    }

    /// Returns the largest component of the velocity anywhere, m/s.
    pub fn fastest_m_s(&self) -> f64 {
        fastest(&self.lattice, &self.velocity)
    }

    /// Returns the cost and the error of the last projection.
    pub fn solved(&self) -> Solved {
        self.solved
    }
}

/// Returns the place of a value, m from the box's lowest corner; its indices may be those of a ghost.
pub(super) fn place_m(lattice: &Lattice, c: usize, i: [i64; 3]) -> DVec3 {
    DVec3::from([0, 1, 2].map(|a| {
        let half = if a == c && !lattice.is_flat(a) { 0.0 } else { 0.5 };
        (i[a] as f64 + half) * f64::from(lattice.h[a])
    }))
}

/// Checks that a wind is finite and not too strong for a field.
pub(super) fn check_wind(v: DVec3) -> Result<()> {
    if (0.0..=MAX_SPEED_M_S).contains(&v.length()) {
        return Ok(());
    }
    Err(Error::range("flow.wind", &format!("finite and at most {MAX_SPEED_M_S} m/s"), v))
}

/// Returns a wind at every face and ghost.
fn at_faces(lattice: &Lattice, wind: impl Fn(DVec3) -> DVec3) -> Result<Faces> {
    let mut faces = lattice.zeros();
    for c in lattice.axes() {
        let mut checked = Ok(());
        lattice.each_with_ghosts(c, |i, at| {
            let v = wind(place_m(lattice, c, i));
            if checked.is_ok() {
                checked = check_wind(v);
            }
            faces[c][at] = v[c] as f32;
        });
        checked?;
    }
    Ok(faces)
}
