//! Open shares of faces, and the data that follow from them: the coefficients of the pressure equation, the separate
//! bodies of air, and the layers of closed faces inside obstacles. Closed faces near the air need a velocity: the paths
//! that advection traces back in time may begin beside or inside an obstacle, and the interpolation there reads closed
//! faces.

use super::{
    lattice::{Faces, Lattice},
    multigrid::GridLevel,
    obstacles::Shares,
    sides::{Role, Roles},
};

/// Open share below which a face is closed altogether: the pressure in cells behind such slits would need very many
/// iterations.
const LEAST_OPEN: f32 = 0.03;
/// Number of layers of faces inside obstacles that get the velocity of the air beside them.
const LAYERS: u8 = 4;
/// Layer number of a face that no layer has reached, and of a ghost.
const NO_LAYER: u8 = u8::MAX;
/// Body number of a cell that the flood fill has not visited yet.
const NO_BODY: u32 = u32::MAX;

/// Open faces of a grid.
#[derive(Clone, Debug)]
pub(super) struct Openings {
    /// Open share of each face, [0, 1].
    pub open: Faces,
    /// Velocity of moving obstacles times the share of the face that they close, m/s; empty if no obstacle moves.
    pub pushed: Faces,
    /// Faces of open sides that were closed because the air behind them could not leave: component, position in the
    /// list, open share.
    dead: Vec<(usize, usize, f32)>,
    /// Body of air to which each cell belongs.
    bodies: Vec<u32>,
    /// Number of bodies. A cell without an open face is a body of its own.
    body_count: usize,
    /// Closed faces of each component by layer, from the air into the obstacles. The last entry has all deeper faces.
    inside: [Vec<Vec<usize>>; 3],
    /// Layer number of each face of each component; 0 for an open face.
    layers: [Vec<u8>; 3],
    /// Scratch space of [`Openings::balance`].
    passing: Vec<Passing>,
}

/// Face of an open side.
struct SideFace {
    /// Axis through the face.
    axis: usize,
    /// Position of the face in the lists.
    at: usize,
    /// Body of air behind the face.
    body: usize,
    /// Sign of the outward direction along the axis: 1 or -1.
    outward: f64,
    /// Open area of the face, m2.
    open_m2: f64,
    /// Whether air leaves through the side.
    is_out: bool,
}

/// Flux of the air of one body through the sides, outwards, m3/s, and the area through which it can leave, m2.
#[derive(Clone, Copy, Debug, Default)]
struct Passing {
    /// Flux outwards, m3/s.
    outward: f64,
    /// Area of the outflow faces, m2.
    way_out: f64,
}

impl Openings {
    /// Creates the openings from the open shares of all faces.
    pub(super) fn new(lattice: &Lattice, roles: &Roles, shares: Shares) -> Self {
        let Shares { mut open, mut pushed } = shares;
        for (open, pushed) in open.iter_mut().zip(&mut pushed) {
            for (at, v) in open.iter_mut().enumerate() {
                let kept = if *v < LEAST_OPEN { 0.0 } else { v.min(1.0) };
                if let Some(p) = pushed.get_mut(at).filter(|_| kept == 0.0) {
                    *p /= 1.0 - *v;
                }
                *v = kept;
            }
        }
        for a in lattice.axes().filter(|a| roles[*a][0] == Role::Periodic) {
            let beyond = lattice.n[a] * lattice.stride[a];
            lattice.each_line(a, |first| open[a][first + beyond] = open[a][first]);
        }
        let mut new = Self {
            open,
            pushed,
            dead: Vec::new(),
            bodies: Vec::new(),
            body_count: 0,
            inside: Default::default(),
            layers: Default::default(),
            passing: Vec::new(),
        };
        new.find_bodies(lattice, roles);
        new.close_dead_ends(lattice, roles);
        new.find_layers(lattice);
        new
    }

    /// Returns the pressure equation.
    pub(super) fn level(&self, lattice: &Lattice, roles: &Roles) -> GridLevel {
        let mut lower = [0, 1, 2].map(|_| vec![0.0; lattice.n.iter().product()]);
        for a in lattice.axes() {
            let share = 1.0 / (lattice.h[a] * lattice.h[a]);
            lattice.each_cell(|i, cell, at| {
                if i[a] > 0 || roles[a][0] == Role::Periodic {
                    lower[a][cell] = share * self.open[a][at];
                }
            });
        }
        GridLevel::new(lattice.n, lattice.h, lower)
    }

    /// Numbers the bodies of air by flood fill. A cell without an open face gets a number of its own.
    fn find_bodies(&mut self, lattice: &Lattice, roles: &Roles) {
        let [nx, ny, _] = lattice.n;
        let steps = [1, nx, nx * ny];
        let count: usize = lattice.n.iter().product();
        self.bodies = vec![NO_BODY; count];
        let mut todo = Vec::new();
        for start in 0..count {
            if self.bodies[start] != NO_BODY {
                continue;
            }
            let body = self.body_count as u32;
            self.bodies[start] = body;
            self.body_count += 1;
            todo.push(start);
            while let Some(cell) = todo.pop() {
                let i = [cell % nx, cell / nx % ny, cell / (nx * ny)];
                let at = lattice.at(i);
                for a in lattice.axes() {
                    let (n, stride) = (lattice.n[a], lattice.stride[a]);
                    let wraps = roles[a][0] == Role::Periodic;
                    let ends = [(i[a] == 0, at, (n - 1) as isize), (i[a] == n - 1, at + stride, 1 - n as isize)];
                    for (end, (is_last, face, round)) in ends.into_iter().enumerate() {
                        if self.open[a][face] == 0.0 || (is_last && !wraps) {
                            continue;
                        }
                        let along = if is_last { round } else { [-1, 1][end] };
                        let next = (cell as isize + along * steps[a] as isize) as usize;
                        if self.bodies[next] == NO_BODY {
                            self.bodies[next] = body;
                            todo.push(next);
                        }
                    }
                }
            }
        }
    }

    /// Calls `f` for every face of open sides.
    fn each_open_side(&self, lattice: &Lattice, roles: &Roles, mut f: impl FnMut(SideFace)) {
        let size = lattice.h.map(f64::from);
        for a in lattice.axes() {
            let area: f64 = lattice.axes().filter(|o| *o != a).map(|o| size[o]).product();
            lattice.each_side_cell(a, |i, cell, at| {
                let (end, at, outward) = if i[a] == 0 { (0, at, -1.0) } else { (1, at + lattice.stride[a], 1.0) };
                let role = roles[a][end];
                if role == Role::In || role == Role::Out {
                    let open_m2 = f64::from(self.open[a][at]) * area;
                    let body = self.bodies[cell] as usize;
                    f(SideFace { axis: a, at, body, outward, open_m2, is_out: role == Role::Out });
                }
            });
        }
    }

    /// Closes open sides of bodies of air that have no way out.
    fn close_dead_ends(&mut self, lattice: &Lattice, roles: &Roles) {
        let mut way_out = vec![0.0; self.body_count];
        self.each_open_side(lattice, roles, |f| way_out[f.body] += if f.is_out { f.open_m2 } else { 0.0 });
        let mut dead = std::mem::take(&mut self.dead);
        self.each_open_side(lattice, roles, |f| {
            let open = self.open[f.axis][f.at];
            if way_out[f.body] == 0.0 && open > 0.0 {
                dead.push((f.axis, f.at, open));
            }
        });
        for (axis, at, _) in &dead {
            self.open[*axis][*at] = 0.0;
        }
        self.dead = dead;
    }

    /// Updates the openings after an inflow side has become an outflow side, or the reverse.
    pub(super) fn set_roles(&mut self, lattice: &Lattice, roles: &Roles) {
        let had_dead = !self.dead.is_empty();
        for (axis, at, open) in self.dead.drain(..) {
            self.open[axis][at] = open;
        }
        self.close_dead_ends(lattice, roles);
        if had_dead || !self.dead.is_empty() {
            self.find_layers(lattice);
        }
    }

    /// Balances the flux of each body of air: adds the same change of speed to all of its outflow faces.
    pub(super) fn balance(&mut self, lattice: &Lattice, roles: &Roles, velocity: &mut Faces) {
        let mut all = std::mem::take(&mut self.passing);
        all.clear();
        all.resize(self.body_count, Passing::default());
        self.add_pushed(lattice, &mut all);
        self.each_open_side(lattice, roles, |f| {
            all[f.body].outward += f.outward * f.open_m2 * f64::from(velocity[f.axis][f.at]);
            all[f.body].way_out += if f.is_out { f.open_m2 } else { 0.0 };
        });
        self.each_open_side(lattice, roles, |f| {
            if f.is_out && f.open_m2 > 0.0 {
                velocity[f.axis][f.at] -= (f.outward * all[f.body].outward / all[f.body].way_out) as f32;
            }
        });
        self.passing = all;
    }

    /// Adds the air that moving obstacles push into the bodies of air, as if it were inflow.
    fn add_pushed(&self, lattice: &Lattice, all: &mut [Passing]) {
        let size = lattice.h.map(f64::from);
        for a in lattice.axes().filter(|a| !self.pushed[*a].is_empty()) {
            let area: f64 = lattice.axes().filter(|o| *o != a).map(|o| size[o]).product();
            let pushed = &self.pushed[a];
            lattice.each_cell(|_, cell, at| {
                let net = pushed[at + lattice.stride[a]] - pushed[at];
                all[self.bodies[cell] as usize].outward += f64::from(net) * area;
            });
        }
    }

    /// Finds the layers of closed faces, from the air into the obstacles.
    fn find_layers(&mut self, lattice: &Lattice) {
        self.inside = Default::default();
        for c in lattice.axes() {
            let mut layers = vec![NO_LAYER; lattice.len()];
            let mut closed = Vec::new();
            lattice.each(c, |_, at| {
                if self.open[c][at] > 0.0 {
                    layers[at] = 0;
                } else {
                    closed.push(at);
                }
            });
            for layer in 1..=LAYERS {
                let reached = |at: &usize| {
                    lattice.axes().any(|a| {
                        let s = lattice.stride[a];
                        layers[at - s] < layer || layers[at + s] < layer
                    })
                };
                let (now, later): (Vec<_>, Vec<_>) = closed.into_iter().partition(reached);
                now.iter().for_each(|at| layers[*at] = layer);
                self.inside[c].push(now);
                closed = later;
            }
            self.inside[c].push(closed);
            self.layers[c] = layers;
        }
    }

    /// Gives closed faces a velocity. If air slides along obstacles, the velocity is the mean of the neighbours in
    /// layers nearer to the air, down to [`LAYERS`] layers. Otherwise and deeper it is 0.
    pub(super) fn fill_inside(&self, lattice: &Lattice, slides: bool, component: usize, values: &mut [f32]) {
        let layers = &self.layers[component];
        for (depth, faces) in (1..).zip(&self.inside[component]) {
            for &at in faces {
                let (mut sum, mut count) = (0.0, 0.0);
                for s in lattice.axes().map(|a| lattice.stride[a]) {
                    for beside in [at - s, at + s] {
                        if layers[beside] < depth {
                            sum += values[beside];
                            count += 1.0;
                        }
                    }
                }
                values[at] = if slides && depth <= LAYERS && count > 0.0 { sum / count } else { 0.0 };
            }
        }
    }
}
