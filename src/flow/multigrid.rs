//! Multigrid for the pressure: the same equation on successively coarser grids.
//!
//! A coarse cell joins two cells along each axis on which cells are not much longer than on the others. Elongated cells
//! thus become cubic first, and then all axes are halved together. The opening of a coarse face is the mean of its fine
//! faces. An odd number of cells leaves a coarse cell that is half closed. Residuals are restricted as means;
//! corrections are interpolated linearly between coarse cells.

use std::mem::take;

/// Number of sweeps before and after the coarser grid.
const SWEEPS: usize = 2;
/// Number of sweeps on the coarsest grid.
const COARSEST_SWEEPS: usize = 24;
/// Number of cells up to which a grid is not coarsened.
const FEW_CELLS: usize = 32;
/// Ratio to the shortest cell side up to which an axis is coarsened.
const LONGER: f32 = 1.5;

/// Equation on one grid: for each cell, the sum over its faces of coefficient times (neighbour - own) equals the
/// right-hand side.
#[derive(Clone, Debug, Default)]
pub(super) struct GridLevel {
    /// Number of cells along each axis.
    pub n: [usize; 3],
    /// Size of a cell along each axis, m.
    h: [f32; 3],
    /// Coefficient of the lower face of each cell along each axis: open share / h^2. The first one of a row connects
    /// the two ends of the row.
    pub lower: [Vec<f32>; 3],
    /// Sum of the coefficients of a cell's faces; 0 for a cell without air.
    pub sum: Vec<f32>,
    /// Unknown: the potential.
    x: Vec<f32>,
    /// Right-hand side.
    b: Vec<f32>,
    /// Residual.
    r: Vec<f32>,
    /// Number of cells that a cell of the next level joins along each axis, 1 or 2.
    join: [usize; 3],
    /// Scratch space of [`GridLevel::add_correction`].
    taps: Vec<CoarseTaps>,
}

/// Two coarse cells along an axis from which a correction comes, as index and weight.
type CoarseTaps = [(usize, f32); 2];

/// Neighbours of a row of cells: start of the row itself, and of the rows before, after, below and above it.
struct RowNeighbours {
    /// Start of the row in the lists.
    own: usize,
    /// Starts of the rows before, after, below and above it.
    beside: [usize; 4],
}

impl GridLevel {
    pub(super) fn new(n: [usize; 3], h: [f32; 3], lower: [Vec<f32>; 3]) -> Self {
        let count = n.iter().product();
        let mut level = Self { n, h, lower, join: [1; 3], ..Self::default() };
        for values in [&mut level.sum, &mut level.x, &mut level.b, &mut level.r] {
            values.resize(count, 0.0);
        }
        let mut sum = take(&mut level.sum);
        level.each_row(|row, _| {
            for i in 0..n[0] {
                let [_, right] = level.across(row, i);
                let at = row.own + i;
                let x = level.lower[0][at] + level.lower[0][right];
                let y = level.lower[1][at] + level.lower[1][row.beside[1] + i];
                sum[at] = x + y + level.lower[2][at] + level.lower[2][row.beside[3] + i];
            }
        });
        level.sum = sum;
        level
    }

    /// Calls `f` for every row along x with its neighbours and a number whose parity is the colour of the row's first
    /// cell.
    fn each_row(&self, mut f: impl FnMut(&RowNeighbours, usize)) {
        let [nx, ny, nz] = self.n;
        for k in 0..nz {
            for j in 0..ny {
                let start = |j: usize, k: usize| (k * ny + j) * nx;
                let (before, after) = (start((j + ny - 1) % ny, k), start((j + 1) % ny, k));
                let (below, above) = (start(j, (k + nz - 1) % nz), start(j, (k + 1) % nz));
                f(&RowNeighbours { own: start(j, k), beside: [before, after, below, above] }, j + k);
            }
        }
    }

    /// Returns the neighbours of the cell `i` of a row, before and after it.
    fn across(&self, row: &RowNeighbours, i: usize) -> [usize; 2] {
        let last = self.n[0] - 1;
        [row.own + if i == 0 { last } else { i - 1 }, row.own + if i == last { 0 } else { i + 1 }]
    }

    /// Returns the sum over a cell's faces of coefficient times neighbour.
    #[inline]
    fn neighbours(&self, x: &[f32], row: &RowNeighbours, i: usize) -> f32 {
        let [left, right] = self.across(row, i);
        let at = row.own + i;
        let [a, b, c, d] = row.beside.map(|start| start + i);
        let [lx, ly, lz] = &self.lower;
        lx[at] * x[left] + lx[right] * x[right] + ly[at] * x[a] + ly[b] * x[b] + lz[at] * x[c] + lz[d] * x[d]
    }

    /// Relaxes the cells of one colour of a chessboard by successive over-relaxation; a factor of 1 is Gauss-Seidel.
    pub(super) fn relax(&self, x: &mut [f32], b: &[f32], relaxation: f32, colour: usize) {
        self.each_row(|row, parity| {
            let mut i = (parity + colour) % 2;
            while i < self.n[0] {
                let at = row.own + i;
                if self.sum[at] > 0.0 {
                    let wanted = (self.neighbours(x, row, i) - b[at]) / self.sum[at];
                    x[at] += relaxation * (wanted - x[at]);
                }
                i += 2;
            }
        });
    }

    /// Computes the residual of the equation: right-hand side less left-hand side.
    pub(super) fn residual(&self, x: &[f32], b: &[f32], residual: &mut [f32]) {
        self.each_row(|row, _| {
            for i in 0..self.n[0] {
                let at = row.own + i;
                residual[at] = b[at] - (self.neighbours(x, row, i) - self.sum[at] * x[at]);
            }
        });
    }

    /// Computes the left-hand side of the equation.
    pub(super) fn apply(&self, x: &[f32], product: &mut [f32]) {
        self.each_row(|row, _| {
            for i in 0..self.n[0] {
                let at = row.own + i;
                product[at] = self.neighbours(x, row, i) - self.sum[at] * x[at];
            }
        });
    }

    /// Returns the number of cells that the next level joins along each axis, 1 or 2; 1 on all axes if this is the last
    /// level.
    fn joined(&self) -> [usize; 3] {
        let can = |a: &usize| self.n[*a] > 2;
        let shortest = (0..3).filter(can).map(|a| self.h[a]).fold(f32::INFINITY, f32::min);
        [0, 1, 2].map(|a| if can(&a) && self.h[a] <= LONGER * shortest { 2 } else { 1 })
    }

    /// Returns the next coarser level and the numbers of cells that it joins.
    fn coarser(&self) -> Option<([usize; 3], Self)> {
        let join = self.joined();
        if join == [1; 3] || self.n.iter().product::<usize>() <= FEW_CELLS {
            return None;
        }
        let n = [0, 1, 2].map(|a| self.n[a].div_ceil(join[a]));
        let h = [0, 1, 2].map(|a| self.h[a] * join[a] as f32);
        let mut lower = [0, 1, 2].map(|_| vec![0.0; n.iter().product()]);
        let mut at = 0;
        for k in 0..self.n[2] {
            for j in 0..self.n[1] {
                for i in 0..self.n[0] {
                    let place = [i, j, k];
                    let [x, y, z] = [0, 1, 2].map(|a| place[a] / join[a]);
                    for a in (0..3).filter(|a| place[*a] % join[*a] == 0) {
                        let others: usize = (0..3).filter(|o| *o != a).map(|o| join[o]).product();
                        let share = 1.0 / (others * join[a] * join[a]) as f32;
                        lower[a][(z * n[1] + y) * n[0] + x] += share * self.lower[a][at];
                    }
                    at += 1;
                }
            }
        }
        Some((join, Self::new(n, h, lower)))
    }

    /// Restricts the residual to the coarse grid: its mean over the cells that each coarse cell joins.
    fn restrict(&self, coarse: &mut Self) {
        coarse.b.fill(0.0);
        let share = 1.0 / self.join.iter().product::<usize>() as f32;
        let mut at = 0;
        for k in 0..self.n[2] {
            for j in 0..self.n[1] {
                let start = ((k / self.join[2]) * coarse.n[1] + j / self.join[1]) * coarse.n[0];
                for i in 0..self.n[0] {
                    coarse.b[start + i / self.join[0]] += share * self.r[at];
                    at += 1;
                }
            }
        }
    }

    /// Adds the coarse correction, interpolated linearly: on each axis 3/4 of the own coarse cell and 1/4 of its
    /// nearest neighbour. Where there is no neighbour, the own cell replaces it.
    fn add_correction(&mut self, coarse: &Self) {
        let join = self.join;
        let taps = |a: usize, i: usize| -> CoarseTaps {
            if join[a] == 1 {
                return [(i, 1.0), (i, 0.0)];
            }
            let own = i / 2;
            let last = coarse.n[a] - 1;
            let (other, beyond) =
                if i.is_multiple_of(2) { (own.wrapping_sub(1), own == 0) } else { (own + 1, own == last) };
            [(own, 0.75), (if beyond { own } else { other }, 0.25)]
        };
        let mut rows = take(&mut self.taps);
        rows.clear();
        rows.extend((0..self.n[0]).map(|i| taps(0, i)));
        let mut x = take(&mut self.x);
        let mut at = 0;
        for k in 0..self.n[2] {
            for j in 0..self.n[1] {
                let (tk, tj) = (taps(2, k), taps(1, j));
                for row in &rows {
                    if self.sum[at] > 0.0 {
                        let own = (tk[0].0 * coarse.n[1] + tj[0].0) * coarse.n[0] + row[0].0;
                        let mut value = 0.0;
                        for (z, wz) in tk.into_iter().filter(|t| t.1 > 0.0) {
                            for (y, wy) in tj.into_iter().filter(|t| t.1 > 0.0) {
                                let start = (z * coarse.n[1] + y) * coarse.n[0];
                                for (i, wx) in row.iter().filter(|t| t.1 > 0.0) {
                                    let from = start + i;
                                    let from = if coarse.sum[from] > 0.0 { from } else { own };
                                    value += wz * wy * wx * coarse.x[from];
                                }
                            }
                        }
                        x[at] += value;
                    }
                    at += 1;
                }
            }
        }
        self.x = x;
        self.taps = rows;
    }
}

/// Equation on all grids, finest first.
#[derive(Clone, Debug, Default)]
pub(super) struct Levels(pub Vec<GridLevel>);

impl Levels {
    pub(super) fn new(finest: GridLevel) -> Self {
        let mut levels = vec![finest];
        while let Some((join, next)) = levels.last().and_then(GridLevel::coarser) {
            if let Some(last) = levels.last_mut() {
                last.join = join;
            }
            levels.push(next);
        }
        Self(levels)
    }

    /// Returns the cost of one cycle in sweeps of the finest grid.
    pub(super) fn cycle_work(&self) -> f64 {
        let cells = |l: &GridLevel| l.sum.len() as f64;
        let all: f64 = self.0.iter().map(cells).sum();
        // Sweeps on the way down and up, the residual, and the correction.
        all / self.0.first().map_or(1.0, cells) * (2 * SWEEPS + 2) as f64
    }

    /// Runs one V-cycle from zero, which approximates the solution for the right-hand side `b`.
    pub(super) fn cycle(&mut self, b: &[f32], solution: &mut [f32]) {
        if let Some(finest) = self.0.first_mut() {
            finest.b.copy_from_slice(b);
        }
        v_cycle(&mut self.0);
        if let Some(finest) = self.0.first() {
            solution.copy_from_slice(&finest.x);
        }
    }
}

/// Runs one V-cycle from zero on the grids of `levels`, finest first.
fn v_cycle(levels: &mut [GridLevel]) {
    let Some((fine, coarser)) = levels.split_first_mut() else { return };
    let (mut x, b) = (take(&mut fine.x), take(&mut fine.b));
    x.fill(0.0);
    let sweeps = if coarser.is_empty() { COARSEST_SWEEPS } else { SWEEPS };
    for colour in [0, 1].into_iter().cycle().take(2 * sweeps) {
        fine.relax(&mut x, &b, 1.0, colour);
    }
    let Some(next) = coarser.first_mut() else {
        (fine.x, fine.b) = (x, b);
        return;
    };
    let mut r = take(&mut fine.r);
    fine.residual(&x, &b, &mut r);
    (fine.x, fine.b, fine.r) = (x, b, r);
    fine.restrict(next);
    v_cycle(coarser);
    if let Some(next) = coarser.first() {
        fine.add_correction(next);
    }
    let (mut x, b) = (take(&mut fine.x), take(&mut fine.b));
    for colour in [1, 0].into_iter().cycle().take(2 * SWEEPS) {
        fine.relax(&mut x, &b, 1.0, colour);
    }
    (fine.x, fine.b) = (x, b);
}
