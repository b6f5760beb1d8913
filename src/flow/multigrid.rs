//! Multigrid for the pressure: the same equation on successively coarser grids.
//!
//! A coarse cell joins two cells along each axis on which cells are not much longer than on the other axes. Elongated
//! cells thus become cubic first, and then all axes are halved together. The opening of a coarse face is the mean of
//! its fine faces. With an odd number of cells, the last coarse cell has only one fine cell, and its other half counts
//! as closed. Residuals are restricted as means; corrections are interpolated linearly between coarse cells.

use std::mem::{swap, take};

use glam::{Vec3, Vec4};

use super::halves::{Halves, LANES, Lanes, RowNeighbours, lanes, vector};

/// Number of sweeps before and after the coarser grid.
const SWEEPS: usize = 2;
/// Number of sweeps on the coarsest grid.
const COARSEST_SWEEPS: usize = 24;
/// Number of cells up to which a grid is not coarsened.
const FEW_CELLS: u64 = 32;
/// Largest ratio of an axis's cell side to the shortest cell side at which the axis is still coarsened.
const LONGER: f32 = 1.5;

/// Equation on one grid: for each cell, the sum over its faces of coefficient times (neighbour - own) equals the
/// right-hand side. Lists have the order of [`Halves`] unless they say otherwise.
#[derive(Clone, Debug, Default)]
pub(super) struct GridLevel {
    pub halves: Halves,
    h: [f32; 3],
    /// Coefficient of the lower face of each cell along each axis: open share / h^2. The first one of a row connects
    /// the two ends of the row.
    lower: [Vec<f32>; 3],
    /// Sum of the coefficients of a cell's faces; 0 for a cell without air.
    pub sum: Vec<f32>,
    /// Solution of a cycle.
    pub x: Vec<f32>,
    b: Vec<f32>,
    /// Whether cells of one colour touch across the ends of each axis, as on a periodic axis with an odd number of
    /// cells.
    has_odd_ends: [bool; 3],
    /// Number of cells that a cell of the next level joins along each axis, 1 or 2.
    join: [usize; 3],
    /// Scratch space for a row, and for a row in the order of cells.
    line: Vec<f32>,
    cells: Vec<f32>,
    /// Solution and `sum` in the order of cells, for the correction of the finer level. Each row repeats its first and
    /// last value before and after it.
    plain: [Vec<f32>; 2],
}

/// Coefficients of the faces of a row's cells, and the values behind these faces: west, east, south, north, below,
/// above.
struct RowFaces<'a> {
    coefficients: [&'a [Lanes]; 6],
    values: [&'a [Lanes]; 6],
}

impl RowFaces<'_> {
    /// Returns the sum over a cell's faces of coefficient times neighbour.
    #[inline(always)]
    fn sum(&self, i: usize) -> Vec4 {
        let term = |face: usize| vector(self.coefficients[face][i]) * vector(self.values[face][i]);
        term(0) + term(1) + term(2) + term(3) + term(4) + term(5)
    }
}

/// Coarse values that are added to a row of fine ones.
#[derive(Clone, Copy, Default)]
struct CoarseTap<'a> {
    weight: f32,
    values: &'a [Lanes],
    sums: &'a [Lanes],
}

/// Coarse cells from which a correction comes along an axis, with their weights.
type AxisTaps = [(usize, f32); 2];

/// One colour of a row of cells, to be relaxed.
struct RowSweep<'a> {
    faces: RowFaces<'a>,
    x: &'a [Lanes],
    b: &'a [Lanes],
    sums: &'a [Lanes],
    relaxation: f32,
}

impl RowSweep<'_> {
    /// Returns the new values of the group `i` of four cells. Cells without air keep their values.
    #[inline(always)]
    fn relaxed(&self, i: usize) -> Vec4 {
        let (x, sum) = (vector(self.x[i]), vector(self.sums[i]));
        let wanted = (self.faces.sum(i) - vector(self.b[i])) / sum;
        where_air(sum, x + self.relaxation * (wanted - x), x)
    }
}

/// Returns `there` in the lanes of cells with air, whose sum of coefficients is above 0, and `elsewhere` in the others.
#[inline]
fn where_air(sum: Vec4, there: Vec4, elsewhere: Vec4) -> Vec4 {
    Vec4::select(sum.cmpgt(Vec4::ZERO), there, elsewhere)
}

impl GridLevel {
    /// Creates the level from coefficients in the order of cells.
    pub(super) fn new(n: [usize; 3], h: [f32; 3], lower: [Vec<f32>; 3]) -> Self {
        let halves = Halves::new(n);
        let mut level = Self { halves, h, join: [1; 3], ..Self::default() };
        let [nx, ny, nz] = n;
        level.line.resize(halves.row, 0.0);
        level.cells.resize(nx, 0.0);
        for (a, (values, cells)) in level.lower.iter_mut().zip(&lower).enumerate() {
            values.resize(halves.len(), 0.0);
            halves.put(cells, values);
            halves.each_row(|row, _| halves.close(values, row.own));
            let is_first = |cell: usize| [cell % nx, cell / nx % ny, cell / (nx * ny)][a] == 0;
            let is_odd = n[a] > 1 && !n[a].is_multiple_of(2);
            level.has_odd_ends[a] = is_odd && (0..nx * ny * nz).any(|cell| is_first(cell) && cells[cell] > 0.0);
        }
        for values in [&mut level.sum, &mut level.x, &mut level.b] {
            values.resize(halves.len(), 0.0);
        }
        let mut sum = take(&mut level.sum);
        halves.each_row(|row, _| {
            let [lx, ly, lz] = &level.lower;
            for half in [0, 1] {
                let at = |values, start| halves.own(values, start, half);
                let [_, east] = halves.across(lx, row.own, half);
                let x = at(lx, row.own).iter().zip(east);
                let y = at(ly, row.own).iter().zip(at(ly, row.beside[1]));
                let z = at(lz, row.own).iter().zip(at(lz, row.beside[3]));
                for (sum, ((x, y), z)) in halves.own_mut(&mut sum, row.own, half).iter_mut().zip(x.zip(y).zip(z)) {
                    let [x, y] = [x, y].map(|(low, high)| vector(*low) + vector(*high));
                    *sum = (x + y + vector(*z.0) + vector(*z.1)).to_array();
                }
            }
            halves.clear_room(&mut sum, row.own);
        });
        level.sum = sum;
        level
    }

    /// Returns whether each cell has air, in the order of cells.
    pub(super) fn air(&self) -> Vec<bool> {
        let mut sums = vec![0.0; self.halves.n.iter().product()];
        self.halves.get(&self.sum, &mut sums);
        sums.into_iter().map(|sum| sum > 0.0).collect()
    }

    #[inline(always)]
    fn faces<'a>(&'a self, x: &'a [f32], row: &RowNeighbours, half: usize) -> RowFaces<'a> {
        let (halves, own) = (&self.halves, row.own);
        let [lx, ly, lz] = &self.lower;
        let at = |values: &'a [f32], start: usize| halves.own(values, start, half);
        let [[_, east], [x_west, x_east]] = [halves.across(lx, own, half), halves.across(x, own, half)];
        let [south, north, below, above] = row.beside;
        RowFaces {
            coefficients: [at(lx, own), east, at(ly, own), at(ly, north), at(lz, own), at(lz, above)],
            values: [x_west, x_east, at(x, south), at(x, north), at(x, below), at(x, above)],
        }
    }

    #[inline(always)]
    fn sweep<'a>(
        &'a self,
        x: &'a [f32],
        b: &'a [f32],
        relaxation: f32,
        row: &RowNeighbours,
        half: usize,
    ) -> RowSweep<'a> {
        let at = |values: &'a [f32]| self.halves.own(values, row.own, half);
        RowSweep { faces: self.faces(x, row, half), x: at(x), b: at(b), sums: at(&self.sum), relaxation }
    }

    /// Relaxes the cells of one colour of a chessboard by successive over-relaxation; a factor of 1 is Gauss-Seidel.
    pub(super) fn relax(&mut self, x: &mut [f32], b: &[f32], relaxation: f32, colour: usize) {
        let mut line = take(&mut self.line);
        let halves = self.halves;
        halves.each_row(|row, parity| {
            let half = (parity + colour) % 2;
            let sweep = self.sweep(x, b, relaxation, row, half);
            let new = line.as_chunks_mut().0;
            let new = &mut new[..sweep.x.len()];
            for (i, new) in new.iter_mut().enumerate() {
                *new = sweep.relaxed(i).to_array();
            }
            let last = row.own + halves.place(halves.n[0] - 1);
            let before = x[last];
            halves.own_mut(x, row.own, half).copy_from_slice(new);
            halves.close(x, row.own);
            if half == 0 && self.has_odd_ends[0] {
                // Across the row's ends the last cell touches the first, which is new.
                let i = (halves.n[0] - 1) / 2;
                x[last] = before;
                x[last] = self.sweep(x, b, relaxation, row, half).relaxed(i / LANES)[i % LANES];
                halves.close(x, row.own);
            }
        });
        self.line = line;
    }

    /// Relaxes the cells of the first colour, beginning with zeros.
    fn relax_zeros(&mut self, x: &mut [f32], b: &[f32]) {
        if self.has_odd_ends.contains(&true) {
            x.fill(0.0);
            self.relax(x, b, 1.0, 0);
            return;
        }
        let halves = self.halves;
        halves.each_row(|row, half| {
            let (b, sums) = (halves.own(b, row.own, half), halves.own(&self.sum, row.own, half));
            for (x, (b, sum)) in halves.own_mut(x, row.own, half).iter_mut().zip(b.iter().zip(sums)) {
                let sum = vector(*sum);
                *x = where_air(sum, Vec4::ZERO + (Vec4::ZERO - vector(*b)) / sum, Vec4::ZERO).to_array();
            }
            halves.own_mut(x, row.own, 1 - half).fill([0.0; LANES]);
            halves.close(x, row.own);
        });
    }

    /// Computes the left-hand side of the equation for a row.
    #[inline]
    pub(super) fn apply(&self, x: &[f32], row: &RowNeighbours, product: &mut [f32]) {
        let halves = &self.halves;
        for half in [0, 1] {
            let faces = self.faces(x, row, half);
            let own = halves.own(x, row.own, half).iter().zip(halves.own(&self.sum, row.own, half));
            for (i, (out, (x, sum))) in halves.own_mut(product, 0, half).iter_mut().zip(own).enumerate() {
                *out = (faces.sum(i) - vector(*sum) * vector(*x)).to_array();
            }
        }
        halves.clear_room(product, 0);
    }

    /// Computes the residual of the equation: right-hand side minus left-hand side.
    pub(super) fn residual(&self, x: &[f32], b: &[f32], residual: &mut [f32]) {
        self.halves.each_row(|row, _| {
            let (out, b) = (&mut residual[row.own..][..self.halves.row], &b[row.own..]);
            self.apply(x, row, out);
            out.iter_mut().zip(b).for_each(|(out, b)| *out = b - *out);
        });
    }

    /// Returns the numbers of cells that the next coarser level joins along each axis, and that level; `None` if there
    /// is no further level.
    fn coarser(&self) -> Option<([usize; 3], Self)> {
        let fine = self.halves.n;
        let join = joined(fine, self.h)?;
        let n = [0, 1, 2].map(|a| fine[a].div_ceil(join[a]));
        let h = [0, 1, 2].map(|a| self.h[a] * join[a] as f32);
        let mut lower = [0, 1, 2].map(|_| vec![0.0; n.iter().product()]);
        for (k, j) in (0..fine[2]).flat_map(|k| (0..fine[1]).map(move |j| (k, j))) {
            let (row, coarse) = (self.halves.start(j, k), ((k / join[2]) * n[1] + j / join[1]) * n[0]);
            for a in 0..3 {
                if (a == 1 && j % join[1] != 0) || (a == 2 && k % join[2] != 0) {
                    continue;
                }
                let others: usize = (0..3).filter(|o| *o != a).map(|o| join[o]).product();
                let share = 1.0 / (others * join[a] * join[a]) as f32;
                for i in (0..fine[0]).step_by(if a == 0 { join[0] } else { 1 }) {
                    lower[a][coarse + i / join[0]] += share * self.lower[a][row + self.halves.place(i)];
                }
            }
        }
        Some((join, Self::new(n, h, lower)))
    }

    /// Restricts the residual to the coarse grid: its mean over the cells that each coarse cell joins.
    fn restrict(&mut self, x: &[f32], b: &[f32], coarse: &mut Self) {
        let (mut line, mut cells) = (take(&mut self.line), take(&mut coarse.cells));
        let (halves, join) = (self.halves, self.join);
        let share = 1.0 / join.iter().product::<usize>() as f32;
        let [_, ny, nz] = coarse.halves.n;
        for (k, j) in (0..nz).flat_map(|k| (0..ny).map(move |j| (k, j))) {
            cells.fill(0.0);
            let fine = |a: usize, i: usize| i * join[a]..((i + 1) * join[a]).min(halves.n[a]);
            for (k, j) in fine(2, k).flat_map(|k| fine(1, j).map(move |j| (k, j))) {
                let row = halves.neighbours(j, k);
                self.apply(x, &row, &mut line);
                line.iter_mut().zip(&b[row.own..]).for_each(|(product, b)| *product = b - *product);
                halves.add_row(&line, share, join[0] == 2, &mut cells);
            }
            let row = coarse.halves.start(j, k);
            coarse.halves.put_row(&cells, &mut coarse.b[row..row + coarse.halves.row]);
        }
        (self.line, coarse.cells) = (line, cells);
    }

    /// Copies the solution, and at the first call `sum`, into `plain` for the correction of the finer level `fine`.
    fn lay_out(&mut self, fine: &Self) {
        let room = fine.halves.room() + 2;
        let [nx, ny, nz] = self.halves.n;
        let [values, sums] = &mut self.plain;
        let is_new = sums.is_empty();
        for (plain, list) in [(values, &self.x), (sums, &self.sum)].into_iter().take(if is_new { 2 } else { 1 }) {
            plain.resize(room * ny * nz, 0.0);
            for (row, plain) in list.chunks_exact(self.halves.row).zip(plain.chunks_exact_mut(room)) {
                self.halves.get_row(row, &mut plain[1..=nx]);
                (plain[0], plain[nx + 1]) = (plain[1], plain[nx]);
            }
        }
    }

    /// Adds the coarse correction, interpolated linearly: on each axis whose cells are joined, 3/4 of the fine cell's
    /// own coarse cell and 1/4 of the next coarse cell on the fine cell's side. Where that next cell lies outside the
    /// grid or has no air, the own one replaces it.
    fn add_correction(&self, x: &mut [f32], coarse: &mut Self) {
        let (halves, join) = (&self.halves, self.join);
        if join[0] == 2 {
            coarse.lay_out(self);
        }
        let taps = |a: usize, i: usize| -> AxisTaps {
            if join[a] == 1 {
                return [(i, 1.0), (i, 0.0)];
            }
            let own = i / 2;
            let last = coarse.halves.n[a] - 1;
            let (other, beyond) =
                if i.is_multiple_of(2) { (own.wrapping_sub(1), own == 0) } else { (own + 1, own == last) };
            [(own, 0.75), (if beyond { own } else { other }, 0.25)]
        };
        for (k, j) in (0..halves.n[2]).flat_map(|k| (0..halves.n[1]).map(move |j| (k, j))) {
            let (tk, tj, row) = (taps(2, k), taps(1, j), halves.start(j, k));
            for half in [0, 1] {
                let mut all = [CoarseTap::default(); 8];
                let mut count = 0;
                for (z, wz) in tk.into_iter().filter(|t| t.1 > 0.0) {
                    for (y, wy) in tj.into_iter().filter(|t| t.1 > 0.0) {
                        for tap in coarse.taps_of_row(halves, y, z, half, wz * wy) {
                            if tap.weight > 0.0 {
                                all[count] = tap;
                                count += 1;
                            }
                        }
                    }
                }
                let (all, own) = (&all[..count], all[0].values);
                let sums = halves.own(&self.sum, row, half);
                for (i, (x, sum)) in halves.own_mut(x, row, half).iter_mut().zip(sums).enumerate() {
                    let (mut value, own) = (Vec4::ZERO, vector(own[i]));
                    for tap in all {
                        value += tap.weight * where_air(vector(tap.sums[i]), vector(tap.values[i]), own);
                    }
                    let before = vector(*x);
                    *x = where_air(vector(*sum), before + value, before).to_array();
                }
            }
            halves.close(x, row);
        }
    }

    /// Returns the values of a coarse row that are added to one half of a fine row, with their weights: first those of
    /// each fine cell's own coarse cell, then those of its neighbour.
    #[inline]
    fn taps_of_row(&self, fine: &Halves, y: usize, z: usize, half: usize, weight: f32) -> [CoarseTap<'_>; 2] {
        if self.plain[0].is_empty() {
            let row = self.halves.start(y, z);
            let [values, sums] = [&self.x, &self.sum].map(|list| self.halves.own(list, row, half));
            return [CoarseTap { weight, values, sums }, CoarseTap::default()];
        }
        let room = fine.room();
        let start = (z * self.halves.n[1] + y) * (room + 2);
        let tap = |shift: usize, share: f32| {
            let [values, sums] = self.plain.each_ref().map(|list| lanes(&list[start + shift..start + shift + room]));
            CoarseTap { weight: weight * share, values, sums }
        };
        [tap(1, 0.75), tap(2 * half, 0.25)]
    }
}

/// Returns how many cells of a level the next coarser level joins along each axis, 1 or 2; `None` if there is no
/// coarser level. The level has `n` cells of the size `h`.
fn joined(n: [usize; 3], h: [f32; 3]) -> Option<[usize; 3]> {
    let can = |a: &usize| n[*a] > 2;
    let shortest = (0..3).filter(can).map(|a| h[a]).fold(f32::INFINITY, f32::min);
    let join = [0, 1, 2].map(|a| if can(&a) && h[a] <= LONGER * shortest { 2 } else { 1 });
    (join != [1; 3] && n.iter().map(|n| *n as u64).product::<u64>() > FEW_CELLS).then_some(join)
}

/// Returns the number of values that the equation on all grids and its solution need.
pub(super) fn values(cells: [u32; 3], cell_m: Vec3) -> u64 {
    let (mut n, mut h) = (cells.map(|n| n as usize), cell_m.to_array());
    // Five lists of the solution; coefficients, their sum, solution and right-hand side of each level, and two lists of
    // all but the finest.
    let list = |n: [usize; 3]| [Halves::new(n).row, n[1], n[2]].map(|n| n as u64).iter().product::<u64>();
    let mut sum = 5 * list(n);
    loop {
        sum += 8 * list(n);
        let Some(join) = joined(n, h) else { return sum };
        n = [0, 1, 2].map(|a| n[a].div_ceil(join[a]));
        h = [0, 1, 2].map(|a| h[a] * join[a] as f32);
    }
}

/// Equation on all grids, finest first.
#[derive(Clone, Debug, Default)]
pub(super) struct Levels(pub Vec<GridLevel>);

impl Levels {
    pub(super) fn new(finest: GridLevel) -> Self {
        let mut levels = vec![finest];
        while let Some((join, mut next)) = levels.last().and_then(GridLevel::coarser) {
            if let Some(last) = levels.last_mut() {
                last.join = join;
                if join[0] == 2 {
                    // Allocates the lists now, so that cycles allocate nothing.
                    next.lay_out(last);
                }
            }
            levels.push(next);
        }
        Self(levels)
    }

    /// Returns the cost of one cycle in sweeps of the finest grid.
    pub(super) fn cycle_work(&self) -> f64 {
        let cells = |l: &GridLevel| l.halves.n.iter().product::<usize>() as f64;
        let all: f64 = self.0.iter().map(cells).sum();
        // Sweeps on the way down and up, the residual, and the correction.
        all / self.0.first().map_or(1.0, cells) * (2 * SWEEPS + 2) as f64
    }

    /// Runs one V-cycle from zero. `x` of the finest level then approximates the solution for the right-hand side `b`.
    pub(super) fn cycle(&mut self, b: &mut Vec<f32>) {
        let exchange =
            |levels: &mut Self, b: &mut Vec<f32>| levels.0.iter_mut().take(1).for_each(|l| swap(&mut l.b, b));
        exchange(self, b);
        v_cycle(&mut self.0);
        exchange(self, b);
    }
}

/// Runs one V-cycle from zero on the grids of `levels`, finest first.
fn v_cycle(levels: &mut [GridLevel]) {
    let Some((fine, coarser)) = levels.split_first_mut() else { return };
    let (mut x, b) = (take(&mut fine.x), take(&mut fine.b));
    let sweeps = if coarser.is_empty() { COARSEST_SWEEPS } else { SWEEPS };
    fine.relax_zeros(&mut x, &b);
    for colour in [1, 0].into_iter().cycle().take(2 * sweeps - 1) {
        fine.relax(&mut x, &b, 1.0, colour);
    }
    if let Some(next) = coarser.first_mut() {
        fine.restrict(&x, &b, next);
        v_cycle(coarser);
    }
    if let Some(next) = coarser.first_mut() {
        fine.add_correction(&mut x, next);
        for colour in [1, 0].into_iter().cycle().take(2 * SWEEPS) {
            fine.relax(&mut x, &b, 1.0, colour);
        }
    }
    (fine.x, fine.b) = (x, b);
}
