//! Changes of a field while air flows through it: the outer wind, obstacles, and the position of the box.

use glam::{DVec2, DVec3, Vec3};

use super::{
    FlowField, FlowObstacles,
    field::{check_wind, place_m},
    lattice::Faces,
    obstacles::{ColumnRange, Shares, columns_of},
    sides::roles,
};
use crate::error::{Result, check_range};

/// Obstacles of a field at their last evaluation, so that only changes are evaluated again.
pub(super) struct SolidBodies {
    /// Open shares of all faces.
    shares: Shares,
    /// Columns in which something moves.
    moving: Option<ColumnRange>,
}

impl FlowField {
    /// Changes the outer wind, which blows in over open sides from the next step on. The air in the box flows on.
    /// `wind` returns the outer wind, m/s (east, north, up), at a place, m from the box's lowest corner.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a wind that is not finite or over [`super::MAX_SPEED_M_S`]; the field
    /// then stays unchanged.
    pub fn set_wind(&mut self, wind: impl Fn(DVec3) -> DVec3) -> Result<()> {
        // Checks all winds on the sides before it sets any. `shift` uses the wind inside the box too, without a check:
        // the strongest winds of a profile are on the sides.
        for is_checked in [false, true] {
            for c in self.lattice.axes() {
                let (lattice, outer) = (&self.lattice, &mut self.outer[c]);
                let mut fault = Ok(());
                lattice.each_on_sides(c, |i, at| {
                    let v = wind(place_m(lattice, c, i));
                    match (is_checked, &fault) {
                        (true, _) => outer[at] = v[c] as f32,
                        (false, Ok(())) => fault = check_wind(v),
                        _ => {}
                    }
                });
                fault?;
            }
        }
        let roles = roles(&self.lattice, &self.settings.sides, &self.outer);
        if roles != self.roles {
            self.roles = roles;
            self.openings.set_roles(&self.lattice, &roles);
        }
        Ok(())
    }

    /// Sets the mixing by eddies over the ground: kappa u*, m/s, the longest mixing length, m, and the height of the
    /// ground at places of the box, m.
    pub(super) fn set_mixing(&mut self, speed_m_s: f64, most_m: f64, ground_m: impl Fn(DVec2) -> f64) {
        let Self { lattice, mixing, .. } = self;
        (mixing.speed_m_s, mixing.most_m) = (speed_m_s as f32, most_m as f32);
        mixing.ground_m.clear();
        let place = |i: usize, a: usize| (i as f64 + 0.5) * f64::from(lattice.h[a]);
        let columns = (0..lattice.n[1]).flat_map(|j| (0..lattice.n[0]).map(move |i| (i, j)));
        mixing.ground_m.extend(columns.map(|(i, j)| ground_m(DVec2::new(place(i, 0), place(j, 1))) as f32));
    }

    /// Changes the roughness length of walls, m, \[0, 5\].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a length outside this range.
    pub fn set_roughness(&mut self, roughness_m: f64) -> Result<()> {
        check_range("flow.roughness_m", roughness_m, 0.0, 5.0, "m")?;
        if self.settings.roughness_m != roughness_m {
            self.settings.roughness_m = roughness_m;
            self.find_walls();
        }
        Ok(())
    }

    /// Fills the present velocity beyond the sides and inside obstacles.
    pub(super) fn fill_ghosts(&mut self) {
        let mut v = std::mem::take(&mut self.velocity);
        self.fill_all(&mut v);
        self.velocity = v;
    }

    /// Moves the box by whole cells east, north and up. The air stays where it is; air that comes in has the velocity
    /// that `wind` gives at places of the moved box. The caller must set the obstacles next.
    ///
    /// # Errors
    /// Errors of [`FlowField::set_wind`].
    pub fn shift(&mut self, cells: [i64; 3], wind: impl Fn(DVec3) -> DVec3) -> Result<()> {
        self.set_wind(&wind)?;
        let Self { lattice, velocity, scratch, .. } = self;
        let middle = &mut scratch[0];
        for values in [velocity, middle] {
            for c in lattice.axes() {
                lattice.shift(c, &mut values[c], cells, |i| wind(place_m(lattice, c, i))[c] as f32);
            }
        }
        self.potentials.iter_mut().for_each(|p| p.fill(0.0));
        Ok(())
    }

    /// Replaces the obstacles without making the air free of divergence, which the next step does. `moving` holds the
    /// boxes that move. `bodies` is the result of the last call if terrain and fixed obstacles have not changed since,
    /// else `None`.
    ///
    /// # Errors
    /// Errors of [`FlowField::new`]; the field then stays unchanged.
    pub(super) fn follow_obstacles(
        &mut self,
        obstacles: &FlowObstacles,
        moving: &[super::FlowBox],
        bodies: Option<SolidBodies>,
    ) -> Result<SolidBodies> {
        let now = columns_of(&self.lattice, moving);
        let bodies = match bodies {
            None => SolidBodies { shares: obstacles.shares(&self.lattice)?, moving: now },
            Some(mut before) => {
                let both = [before.moving, now].into_iter().flatten();
                let columns = both.reduce(|a, b| [0, 1].map(|i| [a[i][0].min(b[i][0]), a[i][1].max(b[i][1])]));
                if let Some(columns) = columns {
                    obstacles.find(&self.lattice, columns, &mut before.shares)?;
                }
                SolidBodies { moving: now, ..before }
            }
        };
        self.take_shares(bodies.shares.clone());
        Ok(bodies)
    }

    /// Calls `f` for every corner of a cell with its indices and the velocity there, m/s.
    pub(super) fn each_corner(&self, mut f: impl FnMut([usize; 3], Vec3)) {
        let lattice = &self.lattice;
        let [nx, ny, nz] = [0, 1, 2].map(|a| lattice.n[a] + usize::from(!lattice.is_flat(a)));
        let mean = |c: usize, at: usize| {
            let v = &self.velocity[c];
            let back = |a: usize| if a == c || lattice.is_flat(a) { 0 } else { lattice.stride[a] };
            let [x, y, z] = [0, 1, 2].map(back);
            // Along its own axis and along a flat one a value is its own neighbour and counts twice.
            let pair = |at: usize| v[at] + v[at - x];
            let square = |at: usize| pair(at) + pair(at - y);
            0.125 * (square(at) + square(at - z))
        };
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let at = lattice.at([i, j, k]);
                    f([i, j, k], Vec3::from([0, 1, 2].map(|c| if lattice.is_flat(c) { 0.0 } else { mean(c, at) })));
                }
            }
        }
    }

    /// Returns all numbers from which the next step continues: velocities, those in the middle of the last step,
    /// potentials.
    pub(super) fn numbers(&self) -> impl Iterator<Item = &Vec<f32>> {
        let middle = &self.scratch[0];
        self.velocity.iter().chain(middle).chain(&self.potentials)
    }

    /// Returns the length of the last step, s, and the largest change of a velocity in it, m/s.
    pub(super) fn last_step(&self) -> (f64, f32) {
        (self.last_dt, self.last_change_m_s)
    }

    /// Returns the same numbers as [`Self::numbers`], the length of the last step, s, and the largest change in it,
    /// m/s, all to be restored.
    pub(super) fn numbers_mut(&mut self) -> (impl Iterator<Item = &mut Vec<f32>>, &mut f64, &mut f32) {
        let [middle, ..] = &mut self.scratch;
        let numbers = self.velocity.iter_mut().chain(middle).chain(&mut self.potentials);
        (numbers, &mut self.last_dt, &mut self.last_change_m_s)
    }

    /// Sets the velocities by linear interpolation from `coarse`, a field of the same box with cells twice as long, and
    /// makes them free of divergence.
    pub(super) fn take_coarse(&mut self, coarse: &Self) {
        let mut velocity: Faces = std::mem::take(&mut self.velocity);
        for c in self.lattice.axes() {
            let values = &mut velocity[c];
            self.lattice.each(c, |i, at| {
                let place = place_m(&self.lattice, c, i.map(|i| i as i64));
                values[at] = coarse.velocity_at(place)[c] as f32;
            });
        }
        self.velocity = velocity;
        self.begin();
    }
}
