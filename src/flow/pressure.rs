//! Pressure that makes the velocity u free of divergence: the potential phi solves laplace(phi) = div u, and u - grad
//! phi is the new velocity (Chorin 1968).
//!
//! There are two methods. Successive over-relaxation (Young 1954) in two colours, as on a chessboard, changes each
//! cell's value by the relaxation factor times its difference from the value that the neighbours require. With a factor
//! of 2 or more it diverges, so such factors are refused. Multigrid preconditions each step of conjugate gradients with
//! a V-cycle (Hestenes and Stiefel 1952, with the update of Polak and Ribiere, since a V-cycle is not symmetric).
//! Coarse grids blur thin walls and small openings, which costs more cycles, but the method still converges.
//!
//! The residual of the equation is the remaining divergence. Both methods stop once it is within the tolerance.

use glam::Vec4;

use super::{
    halves::{Halves, vector},
    multigrid::{GridLevel, Levels},
};
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

impl Default for PressureMethod {
    /// Returns at most 50 V-cycles, which weather never needs.
    fn default() -> Self {
        Self::Multigrid { max_cycles: 50 }
    }
}

impl PressureMethod {
    /// Method with 5 iterations whose relaxation factor falls from 1.7 to 1.1, as in an older snow simulator.
    pub const FIVE_SWEEPS: Self = Self::Sor { relaxation: [1.7, 1.1], max_iterations: 5 };

    /// Returns the relaxation factor that converges fastest on a grid of `n` cells along its longest axis: 2 / (1 +
    /// sin(pi / n)) (Young 1954).
    pub fn best_relaxation(n: u32) -> f32 {
        (2.0 / (1.0 + libm::sin(std::f64::consts::PI / f64::from(n.max(2))))) as f32
    }

    /// Checks that the numbers of the parameter `name` are within their ranges.
    pub(super) fn check(&self, name: &str) -> Result<()> {
        match *self {
            Self::Multigrid { max_cycles } => {
                check_range(&format!("{name}.max_cycles"), f64::from(max_cycles), 1.0, 1e3, "")
            }
            Self::Sor { relaxation, max_iterations } => {
                for (i, v) in relaxation.into_iter().enumerate() {
                    if !(v > 0.0 && v < 2.0) {
                        return Err(Error::range(&format!("{name}.relaxation[{i}]"), "in (0, 2)", v));
                    }
                }
                check_range(&format!("{name}.max_iterations"), f64::from(max_iterations), 1.0, 1e6, "")
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

/// Equation of a grid, and scratch space to solve it. Lists have the order of [`super::halves::Halves`].
#[derive(Clone, Debug)]
pub(super) struct Pressure {
    /// Equation on all grids, finest first.
    levels: Levels,
    /// Whether each cell has air, in the order of cells.
    air: Vec<bool>,
    x: Vec<f32>,
    r: Vec<f32>,
    /// Residual of the previous iteration.
    before: Vec<f32>,
    p: Vec<f32>,
    /// Left-hand side of the equation for the direction of search.
    q: Vec<f32>,
}

/// Returns the largest absolute value.
fn largest(v: &[f32]) -> f32 {
    let (groups, rest) = v.as_chunks();
    let most = groups.iter().fold(Vec4::ZERO, |most, v| vector(*v).abs().max(most)).max_element();
    rest.iter().fold(most, |most, v| v.abs().max(most))
}

impl Pressure {
    /// Creates the equation on all grids from that on the finest one.
    pub(super) fn new(finest: GridLevel) -> Self {
        let [x, r, before, p, q] = [0; 5].map(|_| vec![0.0; finest.sum.len()]);
        Self { air: finest.air(), levels: Levels::new(finest), x, r, before, p, q }
    }

    /// Whether a cell has air.
    pub(super) fn has_air(&self, cell: usize) -> bool {
        self.air[cell]
    }

    /// Solves the equation for `b`, beginning with zeros, until no residual exceeds `tolerance` or the method's limit
    /// is reached. `b` and `x` are in the order of cells.
    pub(super) fn solve(&mut self, method: PressureMethod, x: &mut [f32], b: &[f32], tolerance: f32) -> Solved {
        let Some(halves) = self.levels.0.first().map(|l| l.halves) else { return Solved::default() };
        self.x.fill(0.0);
        halves.put(b, &mut self.r);
        let solved = match method {
            PressureMethod::Multigrid { max_cycles } => self.multigrid(max_cycles, tolerance),
            PressureMethod::Sor { relaxation, max_iterations } => self.sor(relaxation, max_iterations, tolerance),
        };
        halves.get(&self.x, x);
        solved
    }

    fn sor(&mut self, [first, last]: [f32; 2], most: u32, tolerance: f32) -> Solved {
        let Self { levels, x, r: b, before: residual, .. } = self;
        let Some(level) = levels.0.first_mut() else { return Solved::default() };
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
            level.residual(x, b, residual);
            looks += 1;
            let residual = largest(residual);
            if residual <= tolerance || iterations >= most {
                return Solved { iterations, work: f64::from(iterations + looks), residual };
            }
            next = (iterations + (iterations / 8).max(1)).min(most);
        }
    }

    fn multigrid(&mut self, most: u32, tolerance: f32) -> Solved {
        let Self { levels, x, r, before, p, q, .. } = self;
        let mut solved = Solved { iterations: 0, work: 1.0, residual: largest(r) };
        let work = levels.cycle_work() + 1.0;
        let mut along = 0.0;
        while solved.residual > tolerance && solved.iterations < most {
            levels.cycle(r);
            let Some(level) = levels.0.first() else { break };
            let (z, halves) = (&level.x, &level.halves);
            if solved.iterations == 0 {
                p.copy_from_slice(z);
                along = products(halves, [(r, z)])[0];
            } else {
                let [now, turned] = products(halves, [(r, z), (before, z)]);
                let turn = ((now - turned) / along) as f32;
                p.iter_mut().zip(z).for_each(|(p, z)| *p = z + turn * *p);
                along = now;
            }
            // Sums begin with -0, to which any number can be added unchanged.
            let [mut rp, mut pq] = [-0.0; 2];
            halves.each_row(|row, _| {
                let own = row.own..row.own + halves.row;
                level.apply(p, row, &mut q[own.clone()]);
                rp = halves.add_products(&r[own.clone()], &p[own.clone()], rp);
                pq = halves.add_products(&p[own.clone()], &q[own], pq);
            });
            let step = rp / pq;
            if !step.is_finite() {
                break;
            }
            let (ahead, back) = (step as f32, -step as f32);
            for ((x, p), ((r, q), before)) in x.iter_mut().zip(&*p).zip(r.iter_mut().zip(&*q).zip(&mut *before)) {
                *x += ahead * p;
                *before = *r;
                *r += back * q;
            }
            solved.iterations += 1;
            solved.work += work;
            solved.residual = largest(r);
        }
        solved
    }
}

/// Returns the sums of the products of pairs of lists. Each sum adds its products in the order of cells.
fn products<const N: usize>(halves: &Halves, lists: [(&Vec<f32>, &Vec<f32>); N]) -> [f64; N] {
    let mut sums = [-0.0; N];
    for row in (0..halves.len()).step_by(halves.row) {
        let own = row..row + halves.row;
        for (sum, (a, b)) in sums.iter_mut().zip(lists) {
            *sum = halves.add_products(&a[own.clone()], &b[own.clone()], *sum);
        }
    }
    sums
}
