//! Hollows of a terrain as a tree, and the pit to which each cell drains.
//!
//! A pit fills until its water meets that of another pit at a saddle. Above the saddle both are parts of one larger
//! hollow. The larger hollow fills up to the height at which it spills, and so on until the water finds the grid's
//! border. This is the depression hierarchy of Barnes, Callaghan and Wickert (2020); the level at which each hollow
//! spills is that of the priority-flood (Barnes, Lehman and Mulla 2014). Cells are visited from the lowest up, equal
//! heights by cell number, so every cell except pits and cells at the border has a lower neighbour, which was visited
//! before. Run-off takes the steepest of the eight directions. Water leaves at the border.

/// Index that means no hollow: water that drains there leaves the grid.
pub(super) const OUT: u32 = u32::MAX;
/// Mark in [`Rising::owner`] of a cell that has not been visited yet.
const UNSEEN: u32 = u32::MAX - 1;

/// Hollow of a terrain. Its water is counted in millimetres times cells.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Basin {
    /// Larger hollow that this hollow and another one form when both are full; [`OUT`] for none.
    pub parent: u32,
    /// Pit into which the hollow spills when it is full; [`OUT`] if the water leaves the grid.
    pub spills_to: u32,
    /// First part of the hollow; [`OUT`] for none.
    pub first_child: u32,
    /// Next part of the hollow's parent; [`OUT`] for none.
    pub next: u32,
    /// Height at which the hollow begins, mm: its pit, or the saddle where its parts meet.
    birth_mm: f64,
    /// Number of cells in the hollow's parts. All of them are under water while the hollow itself holds water.
    pub below: f64,
    /// Water that the hollow's parts hold when they are full.
    pub base: f64,
    /// Water in the hollow when it spills, including that of its parts.
    pub capacity: f64,
    /// Range in [`Basins::cells`] of the cells that belong to the hollow but to none of its parts, in ascending order
    /// of height.
    own: std::ops::Range<usize>,
}

/// Hollows of a terrain.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Basins {
    /// Hollows; each comes after its parts.
    pub list: Vec<Basin>,
    /// Pit in which the run-off of each cell ends, or [`OUT`].
    pub drains_to: Vec<u32>,
    /// Own cells of the hollows ([`Basin::own`]), hollow by hollow.
    cells: Vec<u32>,
    /// Heights of the cells in `cells`, mm.
    levels_mm: Vec<f64>,
    /// For each cell in `cells`, the water in its hollow when the level is at the cell's height.
    held: Vec<f64>,
}

/// Returns the up to eight neighbours of a cell, and whether each lies diagonally.
fn neighbours(cell: usize, columns: usize, rows: usize) -> impl Iterator<Item = (usize, bool)> {
    // Offsets to the eight neighbours, (east, north).
    const AROUND: [(isize, isize); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
    let (x, y) = ((cell % columns) as isize, (cell / columns) as isize);
    AROUND.into_iter().filter_map(move |(dx, dy)| {
        let (x, y) = (x + dx, y + dy);
        let inside = x >= 0 && y >= 0 && x < columns as isize && y < rows as isize;
        inside.then(|| (y as usize * columns + x as usize, dx != 0 && dy != 0))
    })
}

/// Returns the largest hollow that a hollow is part of so far, or [`OUT`] once it has met the border.
fn whole_of(wholes: &mut [u32], mut basin: u32) -> u32 {
    while basin != OUT && wholes[basin as usize] != basin {
        let above = wholes[basin as usize];
        if above != OUT {
            wholes[basin as usize] = wholes[above as usize];
        }
        basin = above;
    }
    basin
}

/// State of the visit of all cells from the lowest up.
struct Rising<'a> {
    /// Height of each cell, mm, row by row.
    heights_mm: &'a [f64],
    /// Hollows found so far.
    list: Vec<Basin>,
    /// Larger hollow of each hollow so far; the hollow itself while it has none, [`OUT`] once it has met the border.
    wholes: Vec<u32>,
    /// Hollow in which each cell lies; [`OUT`] for ground that drains off the grid.
    owner: Vec<u32>,
    /// Pit in which the run-off of each cell ends, or [`OUT`].
    drains_to: Vec<u32>,
}

impl Rising<'_> {
    /// Returns whether cell `a` lies lower than `b`. Of two equally high cells, the one with the lower index counts as
    /// lower.
    fn lower(&self, a: usize, b: usize) -> bool {
        (self.heights_mm[a], a) < (self.heights_mm[b], b)
    }

    /// Adds a hollow that begins at this height. Returns its index.
    fn begin(&mut self, birth_mm: f64) -> u32 {
        let id = self.list.len() as u32;
        self.list.push(Basin {
            parent: OUT,
            spills_to: OUT,
            first_child: OUT,
            next: OUT,
            birth_mm,
            below: 0.0,
            base: 0.0,
            capacity: 0.0,
            own: 0..0,
        });
        self.wholes.push(id);
        id
    }

    /// Visits the next higher cell: it becomes a pit, a part of a hollow, a saddle, or ground that drains off the grid.
    fn take(&mut self, cell: usize, (columns, rows): (usize, usize)) {
        let mut met = [OUT; 8];
        let mut count = 0;
        let (mut steepest, mut down) = (f64::NEG_INFINITY, OUT);
        for (other, diagonal) in neighbours(cell, columns, rows) {
            if self.owner[other] == UNSEEN {
                continue;
            }
            let slope = (self.heights_mm[cell] - self.heights_mm[other])
                / if diagonal { std::f64::consts::SQRT_2 } else { 1.0 };
            if slope > steepest {
                (steepest, down) = (slope, self.drains_to[other]);
            }
            let whole = whole_of(&mut self.wholes, self.owner[other]);
            if !met[..count].contains(&whole) {
                met[count] = whole;
                count += 1;
            }
        }
        let met = &met[..count];
        let (x, y) = (cell % columns, cell / columns);
        let border = x == 0 || y == 0 || x == columns - 1 || y == rows - 1;
        if border {
            self.owner[cell] = OUT;
            self.drains_to[cell] = OUT;
            met.iter().filter(|b| **b != OUT).for_each(|b| self.close(*b, cell, OUT, OUT));
            return;
        }
        (self.owner[cell], self.drains_to[cell]) = match met {
            [] => {
                let pit = self.begin(self.heights_mm[cell]);
                (pit, pit)
            }
            [one] => (*one, down),
            _ => (self.saddle(cell, met, (columns, rows)), down),
        };
    }

    /// Handles a cell where several hollows meet and returns its owner. If a neighbour drains off the grid, each hollow
    /// ends at the cell. Otherwise the hollows join, two at a time.
    fn saddle(&mut self, cell: usize, met: &[u32], size: (usize, usize)) -> u32 {
        if met.contains(&OUT) {
            let to = self.lowest_of(cell, OUT, size);
            met.iter().filter(|b| **b != OUT).for_each(|b| self.close(*b, cell, OUT, to));
            return OUT;
        }
        met[1..].iter().fold(met[0], |whole, other| {
            let ways = [self.lowest_of(cell, *other, size), self.lowest_of(cell, whole, size)];
            let parent = self.begin(self.heights_mm[cell]);
            self.close(whole, cell, parent, ways[0]);
            self.close(*other, cell, parent, ways[1]);
            parent
        })
    }

    /// Returns the pit that water reaches when it leaves `cell` by the lowest neighbour in `whole`, which is a hollow
    /// or the ground that drains off the grid.
    fn lowest_of(&mut self, cell: usize, whole: u32, size: (usize, usize)) -> u32 {
        let mut lowest: Option<usize> = None;
        for (other, _) in neighbours(cell, size.0, size.1) {
            let there = self.owner[other] != UNSEEN && whole_of(&mut self.wholes, self.owner[other]) == whole;
            if there && lowest.is_none_or(|l| self.lower(other, l)) {
                lowest = Some(other);
            }
        }
        lowest.map_or(OUT, |l| self.drains_to[l])
    }

    /// Ends a hollow at the saddle `cell`, where it becomes part of `parent` and spills into the pit `spills_to`.
    fn close(&mut self, basin: u32, cell: usize, parent: u32, spills_to: u32) {
        self.wholes[basin as usize] = parent;
        let next = match parent {
            OUT => OUT,
            whole => std::mem::replace(&mut self.list[whole as usize].first_child, basin),
        };
        // Stores the saddle's height in `capacity`; [`Basins::lay_out`] replaces it by the volume.
        let capacity = self.heights_mm[cell];
        let ended = &mut self.list[basin as usize];
        *ended = Basin { parent, spills_to, next, capacity, ..ended.clone() };
    }
}

impl Basins {
    /// Finds the hollows of a grid of `heights_m`, m, with this number of columns.
    pub fn new(heights_m: &[f32], columns: usize) -> Self {
        let heights_mm: Vec<f64> = heights_m.iter().map(|h| f64::from(*h) * 1e3).collect();
        let mut order: Vec<u32> = (0..heights_mm.len() as u32).collect();
        order.sort_unstable_by(|a, b| {
            heights_mm[*a as usize].partial_cmp(&heights_mm[*b as usize]).map_or(a.cmp(b), |o| o.then(a.cmp(b)))
        });
        let size = (columns, heights_mm.len() / columns);
        let mut rising = Rising {
            heights_mm: &heights_mm,
            list: Vec::new(),
            wholes: Vec::new(),
            owner: vec![UNSEEN; heights_mm.len()],
            drains_to: vec![OUT; heights_mm.len()],
        };
        order.iter().for_each(|cell| rising.take(*cell as usize, size));
        let Rising { list, owner, drains_to, .. } = rising;
        let mut basins = Self { list, drains_to, cells: Vec::new(), levels_mm: Vec::new(), held: Vec::new() };
        basins.lay_out(&heights_mm, &order, &owner);
        basins
    }

    /// Sorts the cells by hollow, and computes the volume of water at each cell's height and at the saddle.
    fn lay_out(&mut self, heights_mm: &[f64], order: &[u32], owner: &[u32]) {
        let mut starts = vec![0usize; self.list.len() + 1];
        owner.iter().filter(|o| **o != OUT).for_each(|o| starts[*o as usize + 1] += 1);
        for i in 0..self.list.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        self.cells = vec![0; starts[self.list.len()]];
        for cell in order.iter().filter(|c| owner[**c as usize] != OUT) {
            let place = &mut next[owner[*cell as usize] as usize];
            self.cells[*place] = *cell;
            *place += 1;
        }
        self.levels_mm = self.cells.iter().map(|c| heights_mm[*c as usize]).collect();
        self.held = vec![0.0; self.cells.len()];
        for id in 0..self.list.len() {
            let own = starts[id]..starts[id + 1];
            let b = &mut self.list[id];
            let (mut under, mut held, mut level) = (b.below, b.base, b.birth_mm);
            for i in own.clone() {
                held += under * (self.levels_mm[i] - level);
                (under, level) = (under + 1.0, self.levels_mm[i]);
                self.held[i] = held;
            }
            held += under * (b.capacity - level);
            (b.capacity, b.own) = (held, own);
            let parent = b.parent;
            if parent != OUT {
                let p = &mut self.list[parent as usize];
                (p.below, p.base) = (p.below + under, p.base + held);
            }
        }
    }

    /// Returns the water level, mm, and the number of cells under water when a hollow holds `held`, which must be at
    /// least the water that its parts hold.
    pub fn level(&self, basin: usize, held: f64) -> (f64, f64) {
        let b = &self.list[basin];
        if b.own.is_empty() {
            return (b.birth_mm, b.below);
        }
        let own = self.held[b.own.clone()].partition_point(|h| *h <= held).max(1);
        let last = b.own.start + own - 1;
        let under = b.below + own as f64;
        (self.levels_mm[last] + (held - self.held[last]) / under, under)
    }

    /// Returns the cells of a hollow that do not belong to its parts, and their heights, mm.
    pub fn own_cells(&self, basin: usize) -> impl Iterator<Item = (usize, f64)> {
        let own = self.list[basin].own.clone();
        self.cells[own.clone()].iter().map(|c| *c as usize).zip(self.levels_mm[own].iter().copied())
    }

    /// Returns the parts of a hollow.
    pub fn parts(&self, basin: usize) -> impl Iterator<Item = usize> {
        let first = self.list[basin].first_child;
        std::iter::successors((first != OUT).then_some(first as usize), |b| {
            let next = self.list[*b].next;
            (next != OUT).then_some(next as usize)
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::{cmp::Reverse, collections::BinaryHeap};

    use super::*;

    /// Returns the heights of a rough ground, m, in whole millimetres.
    pub(in super::super) fn rough(columns: usize, rows: usize, seed: u32) -> Vec<f32> {
        let random = |i: usize| crate::falling::random3([i as u32, seed, 5])[0] as f32 / 4_294_967_296.0;
        let smooth = |x: f32, y: f32| (x * 0.37).sin() * (y * 0.29 + 0.4).cos() * 0.3;
        let at = |i: usize| smooth((i % columns) as f32, (i / columns) as f32) + 0.2 * random(i);
        (0..columns * rows).map(|i| (at(i) * 1e3).round() * 1e-3).collect()
    }

    /// Returns the water level in each cell, mm, after endless rain everywhere: the priority-flood.
    pub(in super::super) fn flooded(heights: &[f32], columns: usize) -> Vec<f64> {
        let rows = heights.len() / columns;
        let (mut level, mut queue) = (vec![f64::NAN; heights.len()], BinaryHeap::new());
        let key = |mm: f64, cell: usize| Reverse(((mm * 1e6) as i64, cell));
        for cell in 0..heights.len() {
            let (x, y) = (cell % columns, cell / columns);
            if x == 0 || y == 0 || x == columns - 1 || y == rows - 1 {
                level[cell] = f64::from(heights[cell]) * 1e3;
                queue.push(key(level[cell], cell));
            }
        }
        while let Some(Reverse((_, cell))) = queue.pop() {
            for (other, _) in neighbours(cell, columns, rows) {
                if level[other].is_nan() {
                    level[other] = (f64::from(heights[other]) * 1e3).max(level[cell]);
                    queue.push(key(level[other], other));
                }
            }
        }
        level
    }

    #[test]
    fn hollows_spill_where_a_flood_of_the_whole_ground_would() {
        for seed in 0..4 {
            let (columns, rows) = (41, 29);
            let heights = rough(columns, rows, seed);
            let basins = Basins::new(&heights, columns);
            let mut level: Vec<f64> = heights.iter().map(|h| f64::from(*h) * 1e3).collect();
            let mut spills = vec![0.0; basins.list.len()];
            for id in (0..basins.list.len()).rev() {
                let b = &basins.list[id];
                let whole = b.parent;
                spills[id] = if whole == OUT { basins.level(id, b.capacity).0 } else { spills[whole as usize] };
                basins.own_cells(id).for_each(|(cell, _)| level[cell] = spills[id]);
            }
            let flooded = flooded(&heights, columns);
            let deep = level.iter().zip(&heights).filter(|(l, h)| **l > f64::from(**h) * 1e3 + 1.0).count();
            assert!(deep > 100, "{deep} cells under water");
            for (cell, (got, want)) in level.iter().zip(&flooded).enumerate() {
                assert!((got - want).abs() < 1e-6, "seed {seed}, cell {cell}: {got}, want {want}");
            }
        }
    }

    #[test]
    fn a_box_a_bowl_and_a_cone_hold_what_their_shape_says() {
        let size = 21;
        let made = |f: &dyn Fn(f64, f64) -> f64| {
            let at = |i: usize| f((i % size) as f64 - 10.0, (i / size) as f64 - 10.0) as f32;
            Basins::new(&(0..size * size).map(at).collect::<Vec<_>>(), size)
        };
        // A square trough of 5 x 5 cells, 0.25 m deep, in level ground.
        let trough = made(&|x, y| if x.abs().max(y.abs()) <= 2.0 { -0.25 } else { 0.0 });
        let held: f64 = trough.list.iter().filter(|b| b.parent == OUT).map(|b| b.capacity).sum();
        assert_eq!(held, 25.0 * 250.0);
        let pit = trough.list.iter().position(|b| b.capacity > 0.0).unwrap();
        assert_eq!(trough.level(pit, 25.0 * 100.0), (-150.0, 25.0));
        // Rings of a pyramid: ring k has 8 k cells and is 0.125 m higher than the last. Water up to ring 4 has 8 k (4 -
        // k) 125 mm in each ring, plus the middle.
        let pyramid = made(&|x, y| 0.125 * x.abs().max(y.abs()));
        let to_ring_4: f64 = 4.0 * 125.0 + (1..4).map(|k| f64::from(8 * k) * f64::from(4 - k) * 125.0).sum::<f64>();
        let (level, under) = pyramid.level(0, to_ring_4);
        assert!(level == 500.0 && under == 81.0, "{level} {under}");
        // No water stands on a hill or a slope.
        for dry in [made(&|x, y| -0.1 * (x * x + y * y)), made(&|x, y| 0.3 * x + 0.01 * y), made(&|_, _| 7.0)] {
            assert!(dry.list.iter().all(|b| b.capacity == 0.0) && dry.drains_to.iter().all(|d| *d == OUT));
        }
    }

    #[test]
    fn two_pits_spill_into_each_other_and_then_over_the_rim() {
        // Pits are 0.3 and 0.2 m deep, the saddle between them 0.1 m; the rim is at 0, with a notch at -0.05 m.
        let mut row = vec![0.0f32; 27];
        (row[10], row[11], row[12], row[13], row[14]) = (-0.3, -0.3, -0.1, -0.2, -0.05);
        let heights: Vec<f32> = (0..5).flat_map(|y| if y == 2 { row.clone() } else { vec![0.0; 27] }).collect();
        let basins = Basins::new(&heights, 27);
        let deep: Vec<&Basin> = basins.list.iter().filter(|b| b.capacity > 0.0).collect();
        assert_eq!(deep.len(), 3, "{deep:?}");
        let ids: Vec<usize> = (0..basins.list.len()).filter(|i| basins.list[*i].capacity > 0.0).collect();
        assert_eq!((deep[0].spills_to, deep[1].spills_to, deep[2].spills_to), (ids[1] as u32, ids[0] as u32, OUT));
        let rounded: Vec<f64> = deep.iter().map(|b| b.capacity.round()).collect();
        // At the rim: 300 + 300 + 100 + 200 + 50.
        assert_eq!(rounded, [400.0, 100.0, 950.0]);
        assert_eq!(basins.parts(ids[2]).count(), 2);
        assert_eq!((deep[2].base.round(), deep[2].below), (500.0, 3.0));
    }
}
