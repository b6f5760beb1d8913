//! Staggered grid (Harlow and Welch 1965): velocity components are stored at the centres of the faces they pass
//! through, pressure at the centres of cells. Around the box lie two layers of ghost values, which the sides fill.

use glam::DVec3;

use crate::error::{Error, Result, check_range};

/// Number of layers of ghost values at each end of an axis, as cubic interpolation needs.
pub(super) const GHOSTS: usize = 2;
/// Largest number of cells of a grid: about 6 GB.
const MAX_CELLS: u64 = 1 << 25;

/// Grid of the box. An axis of one cell is flat: nothing changes along it, and its velocity component stays zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lattice {
    /// Numbers of cells east, north and up.
    pub n: [usize; 3],
    /// Size of a cell, m.
    pub h: [f32; 3],
    /// Stride from one value to the next along each axis.
    pub stride: [usize; 3],
    /// Number of values along each axis including ghosts, the same for each component.
    size: [usize; 3],
    /// Layers of ghosts along each axis; 0 along a flat one.
    ghosts: [usize; 3],
}

/// Values of the three components, each at the centres of its faces.
pub(super) type Faces = [Vec<f32>; 3];

impl Lattice {
    /// Creates a grid with these numbers of cells and this cell size, m.
    pub(super) fn new(cells: [u32; 3], cell_m: DVec3) -> Result<Self> {
        for (i, (n, h)) in cells.into_iter().zip(cell_m.to_array()).enumerate() {
            check_range(&format!("flow.cells[{i}]"), f64::from(n), 1.0, 4096.0, "")?;
            check_range(&format!("flow.cell_m[{i}]"), h, 1e-6, 1e4, "m")?;
        }
        let count: u64 = cells.iter().map(|n| u64::from(*n)).product();
        if count > MAX_CELLS {
            return Err(Error::range("flow.cells", &format!("at most {MAX_CELLS} cells in all"), count));
        }
        if cells.iter().filter(|n| **n > 1).count() < 2 {
            return Err(Error::range("flow.cells", "more than one along two axes at least", format!("{cells:?}")));
        }
        let n = cells.map(|n| n as usize);
        let ghosts = n.map(|n| if n == 1 { 0 } else { GHOSTS });
        let size = [0, 1, 2].map(|a| if n[a] == 1 { 1 } else { n[a] + 1 + 2 * GHOSTS });
        let stride = [1, size[0], size[0] * size[1]];
        Ok(Self { n, h: cell_m.as_vec3().to_array(), stride, size, ghosts })
    }

    /// Whether an axis has one cell, so that nothing changes along it.
    pub(super) fn is_flat(&self, axis: usize) -> bool {
        self.n[axis] == 1
    }

    /// Returns the axes along which something changes.
    pub(super) fn axes(&self) -> impl Iterator<Item = usize> + use<> {
        let n = self.n;
        (0..3).filter(move |a| n[*a] > 1)
    }

    /// Returns the shortest side of a cell, m.
    pub(super) fn shortest_m(&self) -> f32 {
        self.axes().map(|a| self.h[a]).fold(f32::INFINITY, f32::min)
    }

    /// Returns the number of values of a component, including ghosts.
    pub(super) fn len(&self) -> usize {
        self.size.iter().product()
    }

    /// Creates lists of zeros for the three components.
    pub(super) fn zeros(&self) -> Faces {
        [0, 1, 2].map(|_| vec![0.0; self.len()])
    }

    /// Returns the position in the list of the value with these indices. The first face of a component and the first
    /// cell of a row have index 0.
    pub(super) fn at(&self, i: [usize; 3]) -> usize {
        (0..3).map(|a| (i[a] + self.ghosts[a]) * self.stride[a]).sum()
    }

    /// Returns the number of values of a component along an axis, without ghosts.
    pub(super) fn count(&self, component: usize, axis: usize) -> usize {
        self.n[axis] + usize::from(component == axis && !self.is_flat(axis))
    }

    /// Calls `f` for every row of a component, with its indices north and up, the position of its first value in the
    /// list, and the number of its values.
    #[inline]
    pub(super) fn each_row(&self, component: usize, mut f: impl FnMut(usize, usize, usize, usize)) {
        let [nx, ny, nz] = [0, 1, 2].map(|a| self.count(component, a));
        for k in 0..nz {
            for j in 0..ny {
                f(j, k, self.at([0, j, k]), nx);
            }
        }
    }

    /// Calls `f` for every value of a component, with its indices and its position in the list.
    pub(super) fn each(&self, component: usize, mut f: impl FnMut([usize; 3], usize)) {
        let [nx, ny, nz] = [0, 1, 2].map(|a| self.count(component, a));
        for k in 0..nz {
            for j in 0..ny {
                let row = self.at([0, j, k]);
                for i in 0..nx {
                    f([i, j, k], row + i);
                }
            }
        }
    }

    /// Whether these indices belong neither to a value nor to a ghost of a component. Along every axis but its own, a
    /// component has one value less than its list has room for. These spare entries stay 0, so that equal fields have
    /// equal numbers.
    fn is_spare(&self, component: usize, i: [i64; 3]) -> bool {
        (0..3).any(|a| a != component && !self.is_flat(a) && i[a] >= (self.n[a] + GHOSTS) as i64)
    }

    /// Calls `f` for every value and every ghost of a component with its indices, which are negative before the first
    /// value.
    pub(super) fn each_with_ghosts(&self, component: usize, mut f: impl FnMut([i64; 3], usize)) {
        let ghosts = self.ghosts.map(|g| g as i64);
        let [x, y, _] = self.size;
        for at in 0..self.len() {
            let i = [at % x, at / x % y, at / (x * y)];
            let i = [0, 1, 2].map(|a| i[a] as i64 - ghosts[a]);
            if !self.is_spare(component, i) {
                f(i, at);
            }
        }
    }

    /// Calls `f` for every cell, with its indices, its number, and the position of its lower faces in the lists.
    pub(super) fn each_cell(&self, mut f: impl FnMut([usize; 3], usize, usize)) {
        let [nx, ny, nz] = self.n;
        let mut cell = 0;
        for k in 0..nz {
            for j in 0..ny {
                let row = self.at([0, j, k]);
                for i in 0..nx {
                    f([i, j, k], cell, row + i);
                    cell += 1;
                }
            }
        }
    }

    /// Calls `f` for every row of cells, with its indices north and up, the number of its first cell, and the position
    /// of that cell's lower faces in the lists.
    #[inline]
    pub(super) fn each_cell_row(&self, mut f: impl FnMut(usize, usize, usize, usize)) {
        let [nx, ny, nz] = self.n;
        for k in 0..nz {
            for j in 0..ny {
                f(j, k, (k * ny + j) * nx, self.at([0, j, k]));
            }
        }
    }

    /// Calls `f` for every cell at the two ends of `axis`, as [`Lattice::each_cell`] would. The axis must not be flat.
    pub(super) fn each_side_cell(&self, axis: usize, mut f: impl FnMut([usize; 3], usize, usize)) {
        let [nx, ny, _] = self.n;
        let along = |a: usize| (0..self.n[a]).step_by(if a == axis { self.n[a] - 1 } else { 1 });
        for k in along(2) {
            for j in along(1) {
                let (first, row) = ((k * ny + j) * nx, self.at([0, j, k]));
                for i in along(0) {
                    f([i, j, k], first + i, row + i);
                }
            }
        }
    }

    /// Calls `f` for the first value (index 0) of every line along `axis`, including lines through ghosts of the other
    /// axes.
    pub(super) fn each_line(&self, axis: usize, mut f: impl FnMut(usize)) {
        let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
        let start = self.ghosts[axis] * self.stride[axis];
        for v in 0..self.size[c] {
            for u in 0..self.size[b] {
                f(start + u * self.stride[b] + v * self.stride[c]);
            }
        }
    }

    /// Calls `f` for every ghost of a component and every face on a side, as [`Lattice::each_with_ghosts`] would.
    pub(super) fn each_on_sides(&self, component: usize, mut f: impl FnMut([i64; 3], usize)) {
        let [x, y, z] = self.size;
        let ghosts = self.ghosts.map(|g| g as i64);
        let is_side = |a: usize, i: i64| {
            let across = i64::from(a == component);
            !self.is_flat(a) && (i < across || i >= self.n[a] as i64)
        };
        for k in 0..z {
            for j in 0..y {
                let (j_g, k_g) = (j as i64 - ghosts[1], k as i64 - ghosts[2]);
                let row = (k * y + j) * x;
                let whole = is_side(1, j_g) || is_side(2, k_g);
                for i in 0..x {
                    let i_g = i as i64 - ghosts[0];
                    if (whole || is_side(0, i_g)) && !self.is_spare(component, [i_g, j_g, k_g]) {
                        f([i_g, j_g, k_g], row + i);
                    }
                }
            }
        }
    }

    /// Shifts the values of a component by whole cells: each place gets the value from `cells` farther along each axis.
    /// A place whose value would come from a ghost or from beyond the ghosts gets `new` of its own indices.
    pub(super) fn shift(&self, component: usize, values: &mut [f32], cells: [i64; 3], new: impl Fn([i64; 3]) -> f32) {
        let before = values.to_vec();
        let has = |i: [i64; 3]| (0..3).all(|a| (0..self.count(component, a) as i64).contains(&i[a]));
        self.each_with_ghosts(component, |i, at| {
            let from: [i64; 3] = std::array::from_fn(|a| i[a].saturating_add(cells[a]));
            values[at] = if has(from) { before[self.at(from.map(|i| i as usize))] } else { new(i) };
        });
    }

    /// Returns the place of a value in cells from the box's lowest corner.
    pub(super) fn place(&self, component: usize, i: [usize; 3]) -> [f32; 3] {
        [0, 1, 2].map(|a| i[a] as f32 + if a == component && !self.is_flat(a) { 0.0 } else { 0.5 })
    }
}
