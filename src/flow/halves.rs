//! Order of a grid's values for sweeps over one colour of a chessboard: each row has its even cells first, then its odd
//! ones. All cells of one colour in a row thus lie side by side, and so do their neighbours in each direction.
//!
//! The first and the last cell of a row are neighbours. A copy of each lies next to the other, beyond the end of the
//! row, so sweeps need no special case at the ends. The room that is left in a row holds zeros.

use glam::{Vec4, vec4};

/// Number of cells that are computed at once.
pub(super) const LANES: usize = 4;
/// Values of [`LANES`] cells.
pub(super) type Lanes = [f32; LANES];

/// Order of values in rows of halves.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Halves {
    pub n: [usize; 3],
    /// Numbers of even and of odd cells of a row.
    counts: [usize; 2],
    /// Room for the cells of one half: a multiple of [`LANES`].
    room: usize,
    /// Start of the odd half in a row. Before it lie copies of the row's ends.
    odd: usize,
    /// Length of a row.
    pub row: usize,
}

/// Starts of a row of cells and of the four rows beside it: south, north, below, above.
pub(super) struct RowNeighbours {
    pub own: usize,
    pub beside: [usize; 4],
}

/// Returns the values as groups of [`LANES`].
#[inline]
pub(super) fn lanes(values: &[f32]) -> &[Lanes] {
    values.as_chunks().0
}

#[inline]
pub(super) fn vector(v: Lanes) -> Vec4 {
    let [x, y, z, w] = v;
    vec4(x, y, z, w)
}

impl Halves {
    pub(super) fn new(n: [usize; 3]) -> Self {
        let counts = [n[0].div_ceil(2), n[0] / 2];
        let room = counts[0].next_multiple_of(LANES);
        Self { n, counts, room, odd: room + 2, row: 2 * room + 2 }
    }

    /// Returns the number of values of a list in this order.
    pub(super) fn len(&self) -> usize {
        self.row * self.n[1] * self.n[2]
    }

    /// Returns the room for the cells of one half of a row.
    pub(super) fn room(&self) -> usize {
        self.room
    }

    /// Returns the start of a row, by its indices north and up.
    #[inline]
    pub(super) fn start(&self, j: usize, k: usize) -> usize {
        (k * self.n[1] + j) * self.row
    }

    /// Returns the position of a cell in its row.
    #[inline]
    pub(super) fn place(&self, i: usize) -> usize {
        i / 2 + if i.is_multiple_of(2) { 0 } else { self.odd }
    }

    /// Returns the values of one half of a row, beginning `shift` cells after the first cell of the half. `half` is 0
    /// for even cells and 1 for odd ones.
    #[inline]
    fn half<'a>(&self, values: &'a [f32], row: usize, half: usize, shift: isize) -> &'a [Lanes] {
        let start = (row + half * self.odd).wrapping_add_signed(shift);
        lanes(&values[start..start + self.room])
    }

    /// Returns the values of one half of a row.
    #[inline]
    pub(super) fn own<'a>(&self, values: &'a [f32], row: usize, half: usize) -> &'a [Lanes] {
        self.half(values, row, half, 0)
    }

    /// Returns the neighbours before and after the cells of one half of a row.
    #[inline]
    pub(super) fn across<'a>(&self, values: &'a [f32], row: usize, half: usize) -> [&'a [Lanes]; 2] {
        let before = if half == 0 { -1 } else { 0 };
        [self.half(values, row, 1 - half, before), self.half(values, row, 1 - half, before + 1)]
    }

    /// Returns the values of one half of a row, to be changed.
    #[inline]
    pub(super) fn own_mut<'a>(&self, values: &'a mut [f32], row: usize, half: usize) -> &'a mut [Lanes] {
        let start = row + half * self.odd;
        values[start..start + self.room].as_chunks_mut().0
    }

    /// Copies each end of a row to the place where a sweep reads the neighbour of the other end.
    #[inline]
    pub(super) fn close(&self, values: &mut [f32], row: usize) {
        let last = self.place(self.n[0] - 1);
        values[row + self.odd - 1] = values[row + last];
        let beyond = if self.counts[0] == self.counts[1] { self.counts[0] } else { self.odd + self.counts[1] };
        values[row + beyond] = values[row];
    }

    /// Sets the room of a row that no cell needs, within its halves, to 0.
    #[inline]
    pub(super) fn clear_room(&self, values: &mut [f32], row: usize) {
        for (half, count) in self.counts.into_iter().enumerate() {
            values[row + half * self.odd + count..row + half * self.odd + self.room].fill(0.0);
        }
    }

    /// Calls `f` for every row with its start and those of the rows beside it, and the colour of its first cell.
    #[inline]
    pub(super) fn each_row(&self, mut f: impl FnMut(&RowNeighbours, usize)) {
        let [_, ny, nz] = self.n;
        for k in 0..nz {
            for j in 0..ny {
                f(&self.neighbours(j, k), (j + k) % 2);
            }
        }
    }

    /// Returns the starts of a row and of those beside it, by its indices north and up. The last row along an axis is
    /// beside the first.
    #[inline]
    pub(super) fn neighbours(&self, j: usize, k: usize) -> RowNeighbours {
        let [_, ny, nz] = self.n;
        let round = |i: usize, n: usize| [if i == 0 { n - 1 } else { i - 1 }, if i + 1 == n { 0 } else { i + 1 }];
        let ([before, after], [below, above]) = (round(j, ny), round(k, nz));
        let beside = [self.start(before, k), self.start(after, k), self.start(j, below), self.start(j, above)];
        RowNeighbours { own: self.start(j, k), beside }
    }

    /// Puts values in the order of cells into this order, without the copies of the rows' ends.
    pub(super) fn put(&self, cells: &[f32], values: &mut [f32]) {
        for (cells, row) in cells.chunks_exact(self.n[0]).zip(values.chunks_exact_mut(self.row)) {
            self.put_row(cells, row);
        }
    }

    /// Puts the values of a row's cells into one row.
    #[inline]
    pub(super) fn put_row(&self, cells: &[f32], row: &mut [f32]) {
        let (even, odd) = row.split_at_mut(self.odd);
        let pairs = cells.as_chunks::<2>();
        for ((pair, even), odd) in pairs.0.iter().zip(&mut *even).zip(&mut *odd) {
            [*even, *odd] = *pair;
        }
        if let [last] = pairs.1 {
            even[self.counts[1]] = *last;
        }
    }

    /// Gets the values of a row's cells in the order of cells.
    #[inline]
    pub(super) fn get_row(&self, row: &[f32], cells: &mut [f32]) {
        let (even, odd) = row.split_at(self.odd);
        let pairs = cells.as_chunks_mut::<2>();
        for ((pair, even), odd) in pairs.0.iter_mut().zip(even).zip(odd) {
            *pair = [*even, *odd];
        }
        if let [last] = pairs.1 {
            *last = even[self.counts[1]];
        }
    }

    /// Gets all values in the order of cells.
    pub(super) fn get(&self, values: &[f32], cells: &mut [f32]) {
        for (cells, row) in cells.chunks_exact_mut(self.n[0]).zip(values.chunks_exact(self.row)) {
            self.get_row(row, cells);
        }
    }

    /// Adds `share` times the values of a row to the sums of coarse cells. If `is_joined` is set, each coarse cell
    /// joins two cells of the row. Otherwise it has one cell.
    #[inline]
    pub(super) fn add_row(&self, row: &[f32], share: f32, is_joined: bool, sums: &mut [f32]) {
        let (even, odd) = row.split_at(self.odd);
        let last = self.counts[1];
        if is_joined {
            for (sum, (even, odd)) in sums.iter_mut().zip(even.iter().zip(odd)).take(last) {
                *sum = *sum + share * even + share * odd;
            }
        } else {
            for (sums, (even, odd)) in sums.as_chunks_mut::<2>().0.iter_mut().zip(even.iter().zip(odd)) {
                sums[0] += share * even;
                sums[1] += share * odd;
            }
        }
        if self.counts[0] > last
            && let Some(sum) = sums.last_mut()
        {
            *sum += share * even[last];
        }
    }

    /// Adds the products of the cells of the rows `a` and `b` to a sum, in the order of cells.
    #[inline]
    pub(super) fn add_products(&self, a: &[f32], b: &[f32], mut sum: f64) -> f64 {
        let ((ae, ao), (be, bo)) = (a.split_at(self.odd), b.split_at(self.odd));
        let product = |a: f32, b: f32| f64::from(a) * f64::from(b);
        let pairs = ae.iter().zip(ao).zip(be.iter().zip(bo)).take(self.counts[1]);
        for ((ae, ao), (be, bo)) in pairs {
            sum += product(*ae, *be);
            sum += product(*ao, *bo);
        }
        let last = self.counts[1];
        if self.counts[0] > last { sum + product(ae[last], be[last]) } else { sum }
    }
}
