//! Pressure that makes the flow free of divergence: laplace(phi) = div u, then u - grad phi (Chorin 1968).
//!
//! There are two methods. Successive over-relaxation (Young 1954) in two colours, as on a chessboard, moves each cell's
//! value towards that which its neighbours require, and beyond it by the relaxation factor. With a factor of 2 or more
//! it diverges, so such factors are refused. Multigrid preconditions each step of conjugate gradients with a V-cycle
//! (Hestenes and Stiefel 1952, with the update of Polak and Ribiere, since a V-cycle is not symmetric). Coarse grids
//! blur thin walls and small openings, which costs more cycles, but the method still converges.
//!
//! The residual of the equation is the remaining divergence, and both methods stop by it.

use super::multigrid::{GridLevel, Levels};
use crate::error::{Error, Result, check_range};

/// Method that solves for the pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressureMethod {
    /// Conjugate gradients preconditioned by V-cycles.
    Multigrid {
        /// Largest number of cycles, 1 to 1000.
        max_cycles: u32,
    },
    /// Red-black over-relaxation.
    Sor {
        /// Relaxation factors of the first iteration and of the last possible one, both in (0, 2); between them the
        /// factor changes linearly.
        relaxation: [f32; 2],
        /// Largest number of iterations, 1 to 1,000,000.
        max_iterations: u32,
    },
}

impl PressureMethod {
    /// Method with 5 iterations whose relaxation factor falls from 1.7 to 1.1, as in an older snow simulator.
    pub const FIVE_SWEEPS: Self = Self::Sor { relaxation: [1.7, 1.1], max_iterations: 5 };

    /// Returns the relaxation factor that converges fastest on a grid of `n` cells along its longest axis: 2 / (1 +
    /// sin(pi / n)) (Young 1954).
    pub fn best_relaxation(n: u32) -> f32 {
        (2.0 / (1.0 + libm::sin(std::f64::consts::PI / f64::from(n.max(2))))) as f32
    }

    /// Checks that the numbers of the method are in their ranges.
    pub(super) fn check(&self) -> Result<()> {
        match *self {
            Self::Multigrid { max_cycles } => {
                check_range("flow.pressure.max_cycles", f64::from(max_cycles), 1.0, 1e3, "")
            }
            Self::Sor { relaxation, max_iterations } => {
                for (i, v) in relaxation.into_iter().enumerate() {
                    if !(v > 0.0 && v < 2.0) {
                        return Err(Error::range(&format!("flow.pressure.relaxation[{i}]"), "in (0, 2)", v));
                    }
                }
                check_range("flow.pressure.max_iterations", f64::from(max_iterations), 1.0, 1e6, "")
            }
        }
    }
}

/// Cost and error of a solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solved {
    /// Number of V-cycles or iterations.
    pub iterations: u32,
    /// Work, in sweeps over the finest grid.
    pub work: f64,
    /// Largest residual, in the unit of the right-hand side (1/s: the remaining divergence).
    pub residual: f32,
}

impl Solved {
    /// Returns the sum of the costs of both solutions, with the residual of `next`, the later one.
    pub(super) fn then(self, next: Self) -> Self {
        Self { iterations: self.iterations + next.iterations, work: self.work + next.work, residual: next.residual }
    }
}

/// Pressure equation on all grids, and vectors of its solvers.
#[derive(Clone, Debug)]
pub(super) struct Pressure {
    /// Equation on all grids, finest first.
    levels: Levels,
    /// Residual.
    r: Vec<f32>,
    /// Residual of the iteration before.
    before: Vec<f32>,
    /// Residual preconditioned by a V-cycle.
    z: Vec<f32>,
    /// Direction of search.
    p: Vec<f32>,
    /// Left-hand side of the equation for the direction of search.
    q: Vec<f32>,
}

/// Returns the largest absolute value.
fn largest(v: &[f32]) -> f32 {
    v.iter().fold(0.0, |most, r| most.max(r.abs()))
}

/// Returns the scalar product of two lists.
fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}

/// Adds `a` times `y` to `x`.
fn add(x: &mut [f32], a: f64, y: &[f32]) {
    let a = a as f32;
    x.iter_mut().zip(y).for_each(|(x, y)| *x += a * y);
}

impl Pressure {
    /// Creates the equation on all grids from that on the finest one.
    pub(super) fn new(finest: GridLevel) -> Self {
        let count = finest.sum.len();
        let [r, before, z, p, q] = [0; 5].map(|_| vec![0.0; count]);
        Self { levels: Levels::new(finest), r, before, z, p, q }
    }

    /// Returns the equation on the finest grid.
    fn finest(&self) -> Option<&GridLevel> {
        self.levels.0.first()
    }

    /// Whether a cell has air.
    pub(super) fn has_air(&self, cell: usize) -> bool {
        self.finest().is_some_and(|l| l.sum[cell] > 0.0)
    }

    /// Solves the equation for `b`, beginning with `x`, until no residual exceeds `tolerance` or the method's limit is
    /// reached.
    pub(super) fn solve(&mut self, method: PressureMethod, x: &mut [f32], b: &[f32], tolerance: f32) -> Solved {
        match method {
            PressureMethod::Multigrid { max_cycles } => self.multigrid(max_cycles, x, b, tolerance),
            PressureMethod::Sor { relaxation, max_iterations } => self.sor(relaxation, max_iterations, x, b, tolerance),
        }
    }

    /// Solves by red-black over-relaxation. `first` and `last` are the relaxation factors, `most` the largest number of
    /// iterations.
    fn sor(&mut self, [first, last]: [f32; 2], most: u32, x: &mut [f32], b: &[f32], tolerance: f32) -> Solved {
        let Some(level) = self.levels.0.first() else { return Solved::default() };
        // The residual costs as much as an iteration, so it is computed only after an eighth more iterations each time.
        let (mut iterations, mut looks, mut next) = (0, 0, most.min(8));
        loop {
            while iterations < next {
                let share = iterations as f32 / (most - 1).max(1) as f32;
                let relaxation = first + (last - first) * share;
                level.relax(x, b, relaxation, 0);
                level.relax(x, b, relaxation, 1);
                iterations += 1;
            }
            level.residual(x, b, &mut self.r);
            looks += 1;
            let residual = largest(&self.r);
            if residual <= tolerance || iterations >= most {
                return Solved { iterations, work: f64::from(iterations + looks), residual };
            }
            next = (iterations + (iterations / 8).max(1)).min(most);
        }
    }

    /// Solves by conjugate gradients preconditioned by V-cycles, in at most `most` cycles.
    fn multigrid(&mut self, most: u32, x: &mut [f32], b: &[f32], tolerance: f32) -> Solved {
        let Self { levels, r, before, z, p, q } = self;
        let Some(level) = levels.0.first() else { return Solved::default() };
        level.residual(x, b, r);
        let mut solved = Solved { iterations: 0, work: 1.0, residual: largest(r) };
        let work = levels.cycle_work() + 1.0;
        let mut along = 0.0;
        while solved.residual > tolerance && solved.iterations < most {
            levels.cycle(r, z);
            if solved.iterations == 0 {
                p.copy_from_slice(z);
                along = dot(r, z);
            } else {
                let now = dot(r, z);
                let turn = (now - dot(before, z)) / along;
                p.iter_mut().zip(z.iter()).for_each(|(p, z)| *p = z + turn as f32 * *p);
                along = now;
            }
            let Some(level) = levels.0.first() else { break };
            level.apply(p, q);
            let step = dot(r, p) / dot(p, q);
            if !step.is_finite() {
                break;
            }
            add(x, step, p);
            before.copy_from_slice(r);
            add(r, -step, q);
            solved.iterations += 1;
            solved.work += work;
            solved.residual = largest(r);
        }
        solved
    }
}
